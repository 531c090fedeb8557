//! A comparison for the eye.

use std::path::Path;

use super::files::solver_name;
use crate::cli::run::files::{ROWS, ROWS_TABLE};
use crate::cli::terminal::{note, wrapped};
use crate::study::comparison::{Row, curves, slope};
use crate::text::grouped;

/// Letters of a solver's name, and of a status.
const NAME: usize = 20;
const STATUS: usize = 17;

/// The rows mesh by mesh, and the fitted slopes.
pub(super) fn table(title: &str, rows: &[Row], (folder, pictures): (&Path, &[&str])) -> String {
    let mut text = wrapped(title, 2) + "\n";
    let mut meshes: Vec<(&str, usize)> = Vec::new();
    for row in rows {
        if !meshes.contains(&mesh(row)) {
            meshes.push(mesh(row));
        }
    }
    meshes.sort_by_key(|&(problem, vertices)| (first_of(rows, problem), vertices));
    for &of in &meshes {
        let on_mesh = || rows.iter().filter(|row| mesh(row) == of);
        let n = on_mesh().find_map(|row| row.n).map_or_else(String::new, |n| format!(", n = {}", grouped(n)));
        text += "\n";
        text += &note(&format!("{}{n}: {} vertices", of.0, grouped(of.1)));
        text +=
            &line(&["solver", "seconds", "work units", "residual", "iter.", "certified"].map(String::from));
        for row in on_mesh() {
            text += &line(&cells(row));
        }
    }
    text += "\n  work unit: the time of one product K x with the stiffness matrix of that mesh\n";
    text += "  seconds ~ vertices^p, certified rows\n";
    let several = meshes.iter().any(|mesh| mesh.0 != meshes[0].0);
    for curve in curves(rows) {
        let problem = if several { format!("  {}", curve.problem) } else { String::new() };
        let exponent = slope(rows, curve).map_or_else(|| "-".into(), |slope| format!("{slope:.2}"));
        text += &format!("  {:NAME$} {exponent:>9}{problem}\n", cut(&solver_name(&curve), NAME));
    }
    let files = [&[ROWS, ROWS_TABLE], pictures].concat().join(", ");
    text + &note(&format!("files: {}/{{{files}}}", folder.display()))
}

/// What tells meshes apart; other programs need not know `n`.
fn mesh(row: &Row) -> (&str, usize) {
    (&row.problem, row.vertices)
}

/// The place of a problem among the rows.
fn first_of(rows: &[Row], problem: &str) -> usize {
    rows.iter().position(|row| row.problem == problem).unwrap_or(rows.len())
}

fn cells(row: &Row) -> [String; 6] {
    let shown = |value: Option<f64>, show: fn(f64) -> String| value.map_or_else(|| "-".into(), show);
    [
        cut(&solver_name(&row.curve()), NAME),
        shown(row.total_seconds, |seconds| format!("{seconds:.4}")),
        shown(row.work_units, |units| grouped(units.round() as usize)),
        shown(row.residual, |residual| format!("{residual:.1e}")),
        row.iterations.map_or_else(|| "-".into(), grouped),
        if row.certified { "yes".into() } else { cut(&format!("no: {}", row.status), STATUS) },
    ]
}

/// At most 80 letters.
fn line([solver, seconds, units, residual, iterations, certified]: &[String; 6]) -> String {
    format!("  {solver:NAME$} {seconds:>9} {units:>11} {residual:>8} {iterations:>7}  {certified}\n")
}

/// A text on one line, ended by an ellipsis if it is longer than `width` letters.
fn cut(text: &str, width: usize) -> String {
    let letters: Vec<char> = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    if letters.len() <= width {
        return letters.into_iter().collect();
    }
    letters[..width - 1].iter().collect::<String>() + "…"
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns of a terminal that nobody has made wider.
    const COLUMNS: usize = 80;

    #[test]
    fn the_table_fits_the_terminal_and_says_who_did_not_certify() {
        let row = Row { problem: "square".into(), n: Some(1024), vertices: 1_050_625, ..Row::default() };
        let slow = Row {
            solver: "a-solver-of-a-long-name".into(),
            origin: "elsewhere".into(),
            status: "error: the stiffness matrix cannot be factored: memory is short".into(),
            total_seconds: Some(599.12345),
            work_units: Some(123_456.7),
            residual: Some(1.25e-300),
            iterations: Some(20_000),
            ..row.clone()
        };
        let quick = Row { solver: "quick".into(), certified: true, status: "solved".into(), ..row };
        let text = table("a title", &[slow, quick], (Path::new("out/bench"), &["bench.png"]));
        assert!(text.lines().all(|line| line.chars().count() <= COLUMNS), "{text}");
        let of = |name: &str| text.lines().find(|line| line.trim_start().starts_with(name)).unwrap();
        assert!(
            of("a-solver").contains("123,457") && of("a-solver").ends_with("  no: error: the s…"),
            "{text}"
        );
        assert!(of("quick").ends_with("  yes"), "{text}");
    }

    #[test]
    fn meshes_stand_in_order_whoever_ran_on_them() {
        let row = |n, origin: &str| Row {
            problem: "square".into(),
            n: Some(n),
            vertices: (n + 1) * (n + 1),
            solver: "it".into(),
            origin: origin.into(),
            ..Row::default()
        };
        let text = table(
            "",
            &[row(8, "rust"), row(16, "rust"), row(4, "other"), Row { n: None, ..row(8, "other") }],
            (Path::new(""), &[]),
        );
        let headings: Vec<&str> = text.lines().filter(|line| line.contains("square")).collect();
        let expected = [(4, 25), (8, 81), (16, 289)];
        assert_eq!(headings, expected.map(|(n, v)| format!("  square, n = {n}: {v} vertices")));
    }
}
