//! Numbers in messages.

use std::fmt;

/// A number in a message, in the shorter of its two spellings: `0.1`, but `1e300` in place of 301 digits.
pub(crate) struct Number(pub(crate) f64);

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [plain, scientific] = [format!("{}", self.0), format!("{:e}", self.0)];
        f.write_str(if scientific.len() < plain.len() { &scientific } else { &plain })
    }
}

/// How many there are of something, its digits in groups of three: `60,003`.
pub(crate) fn grouped(n: usize) -> String {
    grouped_by(",", n)
}

/// The like with another separator.
pub(crate) fn grouped_by(separator: &str, n: usize) -> String {
    let digits = n.to_string();
    let mut text = String::new();
    for (k, digit) in digits.chars().enumerate() {
        if k > 0 && (digits.len() - k).is_multiple_of(3) {
            text.push_str(separator);
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shorter_spelling_is_taken() {
        let spelled = [0.0, -1.0, 0.1, 1e300, -1e-300, 1.0 / 3.0, f64::NAN, f64::INFINITY]
            .map(|x| Number(x).to_string());
        let expected = ["0", "-1", "0.1", "1e300", "-1e-300", "0.3333333333333333", "NaN", "inf"];
        assert_eq!(spelled, expected);
        for (x, spelled) in [(1e300, "1e300"), (1.0 / 3.0, "0.3333333333333333")] {
            assert_eq!(spelled.parse(), Ok(x), "it is the number itself");
        }
    }

    #[test]
    fn digits_are_grouped_from_the_right() {
        let texts: Vec<String> = [0, 999, 1000, 65_536, 1_050_625].into_iter().map(grouped).collect();
        assert_eq!(texts, ["0", "999", "1,000", "65,536", "1,050,625"]);
    }
}
