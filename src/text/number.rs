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
}
