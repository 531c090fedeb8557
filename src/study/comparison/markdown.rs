//! A comparison as Markdown.

use super::{Row, curves, slope};
use crate::text::grouped;

/// The rows as a table, and the exponents of the times as another one.
pub fn markdown(rows: &[Row]) -> String {
    let mut text = String::from(
        "| problem | n | vertices | solver | origin | threads | status | certified | residual | iterations \
         | seconds | work units | contact vertices |\n\
         |---|---:|---:|---|---|---:|---|---|---:|---:|---:|---:|---:|\n",
    );
    let count = |value: Option<usize>| value.map_or_else(String::new, grouped);
    let number =
        |value: Option<f64>, digits: usize| value.map_or_else(String::new, |value| rounded(value, digits));
    for row in rows {
        let cells = [
            row.problem.clone(),
            count(row.n),
            grouped(row.vertices),
            row.solver.clone(),
            row.origin.clone(),
            count(row.threads),
            row.status.clone(),
            if row.certified { "yes" } else { "no" }.into(),
            row.residual.map_or_else(String::new, |residual| format!("{residual:.1e}")),
            count(row.iterations),
            number(row.total_seconds, 3),
            number(row.work_units, 2),
            count(row.contact_vertices),
        ];
        text += &format!("| {} |\n", cells.map(|cell| in_one_cell(&cell)).join(" | "));
    }
    text += "\nExponents `p` of `seconds ~ vertices^p`, fitted to the certified rows:\n\n";
    text += "| problem | solver | origin | p |\n|---|---|---|---:|\n";
    for curve in curves(rows) {
        let exponent = slope(rows, curve).map_or_else(String::new, |slope| format!("{slope:.2}"));
        let names = [curve.problem, curve.solver, curve.origin].map(in_one_cell).join(" | ");
        text += &format!("| {names} | {exponent} |\n");
    }
    text
}

/// A positive number with so many digits at least, without a power of ten.
fn rounded(value: f64, digits: usize) -> String {
    let before_the_point =
        if value > 0.0 && value.is_finite() { value.log10().floor() as i32 + 1 } else { 1 };
    let decimals = (digits as i32 - before_the_point).clamp(0, 9) as usize;
    let is_whole = decimals == 0 && (0.0..1e15).contains(&value);
    if is_whole { grouped(value.round() as usize) } else { format!("{value:.decimals$}") }
}

fn in_one_cell(text: &str) -> String {
    text.replace('|', "\\|").replace(['\n', '\r'], " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_digits() {
        let cases = [
            (0.0123456, "0.0123"),
            (1.23456, "1.23"),
            (123.456, "123"),
            (12345.6, "12,346"),
            (0.0, "0.00"),
            (f64::INFINITY, "inf"),
        ];
        for (value, expected) in cases {
            assert_eq!(rounded(value, 3), expected);
        }
        assert_ne!(rounded(0.0123456, 4), "0.0123");
    }

    #[test]
    fn the_table_has_a_row_for_each_row_and_cells_stay_cells() {
        let row = Row { solver: "a|b".into(), status: "error: two\nlines".into(), ..Row::default() };
        let text = markdown(&[row.clone(), row]);
        let table: Vec<&str> = text.lines().take_while(|line| !line.is_empty()).collect();
        assert_eq!(table.len(), 2 + 2);
        let columns = |line: &str| line.replace("\\|", "").matches('|').count();
        assert!(table.iter().all(|line| columns(line) == columns(table[0])), "{text}");
        assert!(text.ends_with("|  | a\\|b |  |  |\n"), "no time, no exponent: {text}");
    }
}
