//! The parameters of the exact cases: names, defaults, ranges, and the errors of choosing them.

use std::collections::BTreeMap;

use crate::text::{Number, excerpt, nearest};

/// Why there is no such exact solution.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CaseError {
    /// No case has this name.
    #[error("there is no case `{name}`; the nearest is `{nearest}`, and `membranes cases` lists all")]
    UnknownCase {
        /// The name asked for.
        name: String,
        /// The known name that is most like it.
        nearest: &'static str,
        /// All known names, separated by commas.
        known: String,
    },
    /// The case has no parameter of this name.
    #[error("the case `{case}` has no parameter `{name}`; the nearest is `{nearest}` (known: {known})")]
    UnknownParameter {
        /// The case.
        case: &'static str,
        /// The name asked for.
        name: String,
        /// The known name that is most like it.
        nearest: &'static str,
        /// All known names, separated by commas.
        known: String,
    },
    /// The value is outside the range in which the formulas hold.
    #[error("`{name} = {}` is out of range in the case `{case}`; choose {range}", Number(*value))]
    OutOfRange {
        /// The case.
        case: &'static str,
        /// The parameter.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The values allowed.
        range: String,
    },
}

/// A number that can be chosen in a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// The key in a case file.
    pub name: &'static str,
    /// The value when nothing is chosen.
    pub default: f64,
    /// What it is, in a few words.
    pub meaning: &'static str,
    /// The values allowed.
    pub range: Range,
}

/// The tension of membrane 1, a parameter of every case.
pub(super) const MU1: Parameter = Parameter::positive("mu1", 1.0, "tension of membrane 1");
/// The tension of membrane 2, a parameter of every case.
pub(super) const MU2: Parameter = Parameter::positive("mu2", 3.0, "tension of membrane 2");

impl Parameter {
    pub(super) const fn any(name: &'static str, default: f64, meaning: &'static str) -> Self {
        Self { name, default, meaning, range: Range::Any }
    }

    pub(super) const fn positive(name: &'static str, default: f64, meaning: &'static str) -> Self {
        Self { name, default, meaning, range: Range::Positive }
    }

    pub(super) const fn non_negative(name: &'static str, default: f64, meaning: &'static str) -> Self {
        Self { name, default, meaning, range: Range::NonNegative }
    }

    pub(super) const fn between(
        name: &'static str,
        [lower, default, upper]: [f64; 3],
        meaning: &'static str,
    ) -> Self {
        Self { name, default, meaning, range: Range::Between(lower, upper) }
    }

    pub(super) const fn whole(
        name: &'static str,
        [lower, default, upper]: [u32; 3],
        meaning: &'static str,
    ) -> Self {
        Self { name, default: default as f64, meaning, range: Range::Whole(lower, upper) }
    }

    /// The range as a condition, for instance `0 < R < 0.5`.
    pub fn condition(&self) -> String {
        let name = self.name;
        match self.range {
            Range::Any => format!("any finite {name}"),
            Range::Positive => format!("{name} > 0"),
            Range::NonNegative => format!("{name} >= 0"),
            Range::Between(lower, upper) => format!("{lower} < {name} < {upper}"),
            Range::Whole(lower, upper) => format!("{name} a whole number, {lower} to {upper}"),
        }
    }
}

/// The finite values that a parameter may take.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Range {
    /// Every finite number.
    Any,
    /// Above zero.
    Positive,
    /// Zero or above.
    NonNegative,
    /// Strictly between the two bounds.
    Between(f64, f64),
    /// A whole number between the two bounds, or one of them.
    Whole(u32, u32),
}

impl Range {
    /// Whether `value` is allowed; NaN and the infinities never are.
    pub fn contains(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Self::Any => true,
                Self::Positive => value > 0.0,
                Self::NonNegative => value >= 0.0,
                Self::Between(lower, upper) => lower < value && value < upper,
                Self::Whole(lower, upper) => {
                    value.fract() == 0.0 && f64::from(lower) <= value && value <= f64::from(upper)
                }
            }
    }
}

/// A checked value for each parameter of a case.
pub(super) struct Values {
    case: &'static str,
    values: BTreeMap<&'static str, f64>,
}

impl Values {
    /// The defaults of the parameters `known`, replaced by what is `chosen`.
    pub(super) fn new(
        case: &'static str,
        known: &'static [Parameter],
        chosen: &BTreeMap<String, f64>,
    ) -> Result<Self, CaseError> {
        let mut values: BTreeMap<_, _> = known.iter().map(|p| (p.name, p.default)).collect();
        for (name, &value) in chosen {
            let Some(parameter) = known.iter().find(|p| p.name == name) else {
                return Err(CaseError::UnknownParameter {
                    case,
                    name: excerpt(name),
                    nearest: nearest(name, known.iter().map(|p| p.name)).map_or("", |(known, _)| known),
                    known: listed(known.iter().map(|p| p.name)),
                });
            };
            if !parameter.range.contains(value) {
                let range = parameter.condition();
                return Err(CaseError::OutOfRange { case, name: parameter.name, value, range });
            }
            values.insert(parameter.name, value);
        }
        Ok(Self { case, values })
    }

    /// The value of a parameter of this case.
    pub(super) fn get(&self, name: &str) -> f64 {
        *self.values.get(name).expect("a case asks only for its own parameters")
    }

    /// The values of several parameters.
    pub(super) fn all<const N: usize>(&self, names: [&str; N]) -> [f64; N] {
        names.map(|name| self.get(name))
    }

    /// The value of a parameter that is a whole number.
    pub(super) fn count(&self, name: &str) -> usize {
        self.get(name) as usize
    }

    /// `[mu1, mu2]`.
    pub(super) fn tension(&self) -> [f64; 2] {
        [self.get("mu1"), self.get("mu2")]
    }

    /// `m = mu1 mu2 / (mu1 + mu2)`, the tension that acts on the gap.
    pub(super) fn reduced_tension(&self) -> f64 {
        let [mu1, mu2] = self.tension();
        mu1 * (mu2 / (mu1 + mu2))
    }

    /// The error for a value that contradicts another parameter; `range` says what is allowed.
    pub(super) fn out_of_range(&self, name: &'static str, range: String) -> CaseError {
        CaseError::OutOfRange { case: self.case, name, value: self.get(name), range }
    }
}

/// The known names, separated by commas.
pub(super) fn listed(known: impl Iterator<Item = &'static str>) -> String {
    known.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    const KNOWN: [Parameter; 3] = [MU1, MU2, Parameter::between("R", [0.0, 0.3, 0.5], "radius")];

    fn values(chosen: &[(&str, f64)]) -> Result<Values, CaseError> {
        let chosen = chosen.iter().map(|&(name, value)| (name.to_owned(), value)).collect();
        Values::new("circle", &KNOWN, &chosen)
    }

    #[test]
    fn what_is_not_chosen_has_its_default() {
        let values = values(&[("mu2", 5.0)]).expect("5 is in the range of mu2");
        assert_eq!((values.tension(), values.get("R")), ([1.0, 5.0], 0.3));
        assert_eq!(values.reduced_tension(), 5.0 / 6.0);
    }

    #[test]
    fn unknown_parameters_are_errors_that_name_the_nearest() {
        let message = |name| values(&[(name, 1.0)]).err().expect("unknown").to_string();
        assert!(message("mu3").contains("`mu1`") && message("mu3").contains("(known: mu1, mu2, R)"));
        assert!(message("r").contains("the nearest is `R`"), "{}", message("r"));
        assert!(message("nu2").contains("the nearest is `mu2`"), "{}", message("nu2"));
    }

    #[test]
    fn ranges_are_open_and_reject_nan_and_infinity() {
        for bad in [0.0, 0.5, -1.0, f64::NAN, f64::INFINITY] {
            let message = values(&[("R", bad)]).err().expect("out of range").to_string();
            assert!(message.ends_with("choose 0 < R < 0.5") && !message.contains('\n'), "{message}");
        }
        let inside = [f64::MIN_POSITIVE, 0.4999];
        assert!(inside.into_iter().all(|good| values(&[("R", good)]).is_ok()));
        let cases = [
            (Range::Any, f64::NAN, -1.0),
            (Range::Any, f64::NEG_INFINITY, 0.0),
            (Range::Positive, 0.0, 1e-9),
            (Range::NonNegative, -1e-9, 0.0),
            (Range::Whole(1, 3), 1.5, 3.0),
            (Range::Whole(1, 3), 4.0, 1.0),
            (Range::Whole(1, 3), 0.0, 2.0),
        ];
        for (range, bad, good) in cases {
            assert!(!range.contains(bad) && range.contains(good), "{range:?}");
        }
    }
}
