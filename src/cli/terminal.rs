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

/// Lines of a name and a value, aligned.
pub(crate) fn fields(rows: &[(&str, String)]) -> String {
    let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    rows.iter().map(|(name, value)| format!("  {name:width$}  {value}\n")).collect()
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
    }
}
