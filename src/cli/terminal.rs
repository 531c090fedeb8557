//! What goes to the terminal.

use std::io::{self, Write};

use super::failure::Failure;

/// Prints to standard output. A reader that has gone away (`| head`) is no error.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::Input(format!(
            "cannot write to the standard output: {error}; redirect it elsewhere"
        ))),
        _ => Ok(()),
    }
}

/// Columns of a terminal that nobody has made wider.
pub(crate) const COLUMNS: usize = 80;

/// A text in lines of at most 80 columns, broken between words; all lines but the first begin with so many spaces. A word that is
/// too long for a line, such as a path, stays whole: it can be copied.
pub(crate) fn wrapped(text: &str, indent: usize) -> String {
    let mut lines = String::new();
    let mut column = 0;
    let mut words = text.split_inclusive(' ').peekable();
    while let Some(word) = words.next() {
        // A number keeps its percent sign.
        let sign = if words.peek().is_some_and(|next| next.starts_with('%')) { 2 } else { 0 };
        let letters = word.trim_end().chars().count() + sign;
        if column > indent && column + letters > COLUMNS {
            lines.truncate(lines.trim_end().len());
            lines += "\n";
            lines.extend(std::iter::repeat_n(' ', indent));
            column = indent;
        }
        lines += word;
        column += word.chars().count();
    }
    lines
}

/// Lines of a name and a value, aligned; values that are longer than a line go on below themselves. Each line of a value has the
/// name before it, and a value that is empty has no line.
pub(crate) fn fields(rows: &[(&str, String)]) -> String {
    let width =
        rows.iter().filter(|(_, value)| !value.is_empty()).map(|(name, _)| name.len()).max().unwrap_or(0);
    let lines = rows.iter().flat_map(|(name, value)| value.lines().map(move |line| (name, line)));
    lines.map(|(name, line)| wrapped(&format!("  {name:width$}  {line}"), width + 4) + "\n").collect()
}

/// A line below a table, indented; what is longer than 80 columns goes on indented further.
pub(crate) fn note(text: &str) -> String {
    wrapped(&format!("  {text}"), 4) + "\n"
}

/// A number with so many decimals (at least four), or in powers of ten where they would be none or many.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    let moderate = value == 0.0 || (1e-4..1e9).contains(&value.abs());
    // Exponents take up to four places.
    if moderate { format!("{value:.decimals$}") } else { format!("{value:.0$e}", decimals - 4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_all_sizes_show_digits() {
        let texts = [0.0, -1.5, 1e-4, 9.9e-5, -104_446_972_117.7, 8.4e-300].map(|value| fixed(value, 6));
        assert_eq!(texts, ["0.000000", "-1.500000", "0.000100", "9.90e-5", "-1.04e11", "8.40e-300"]);
    }

    #[test]
    fn fields_are_aligned() {
        assert_eq!(fields(&[("a", "1".into()), ("long", "2".into())]), "  a     1\n  long  2\n");
        assert_eq!(fields(&[("a", "1\n2".into()), ("none", String::new())]), "  a  1\n  a  2\n");
        let value = "seven letters ".repeat(6);
        let expected = format!("  a  {}seven\n     letters\n", "seven letters ".repeat(5));
        assert_eq!(fields(&[("a", value.trim_end().into())]), expected);
    }

    #[test]
    fn lines_are_broken_between_words_only() {
        let text = "four ".repeat(40);
        let lines = wrapped(text.trim_end(), 3);
        assert!(
            lines.lines().all(|line| line.chars().count() <= COLUMNS && line == line.trim_end()),
            "{lines}"
        );
        assert_eq!(lines.lines().count(), 3);
        assert!(lines.lines().skip(1).all(|line| line.starts_with("   four")), "{lines}");
        assert_eq!(lines.split_whitespace().collect::<Vec<_>>(), ["four"; 40], "every word is there, whole");
        let exact = format!("{} {}", "a".repeat(39), "b".repeat(40));
        assert_eq!(wrapped(&exact, 0), exact);
        assert_eq!(wrapped(&format!("{exact}c"), 0), exact.replace(' ', "\n") + "c");
        let path = "p".repeat(100);
        assert_eq!(wrapped(&path, 2), path);
        assert_eq!(wrapped(&format!("files: {path} x"), 2), format!("files:\n  {path}\n  x"));
        let percent = |letters: usize| wrapped(&format!("{} 0.1 %: x", "a".repeat(letters)), 0);
        assert_eq!(percent(73), format!("{} 0.1 %:\nx", "a".repeat(73)));
        assert_eq!(percent(76), format!("{}\n0.1 %: x", "a".repeat(76)));
        assert_eq!(note("a"), "  a\n");
    }
}
