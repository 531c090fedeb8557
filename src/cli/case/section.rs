//! A table of a case file, read key by key: what nobody has asked for is unknown.

use toml::{Table, Value};

use crate::cli::failure::Failure;
use crate::text::{excerpt, meant, nearest};

/// Letters that may be wrong, missing, surplus or exchanged in a misspelt key.
const MAX_SLIPS: usize = 2;

/// The tables of a case file, each read once by its keys; [`finish`](Section::finish) refuses the others.
pub(crate) struct Section {
    /// The case file, for messages.
    file: String,
    /// The table's name with a dot, or nothing at the top.
    prefix: String,
    table: Table,
    known: Vec<&'static str>,
}

impl Section {
    pub(crate) fn top(file: &str, text: &str) -> Result<Self, Failure> {
        let table = text.parse::<Table>().map_err(|error| {
            let place = error.span().map_or_else(String::new, |span| place(text, span.start));
            Failure::Input(format!("{file}{place}: {}", error.message().replace('\n', "; ")))
        })?;
        Ok(Self { file: file.into(), prefix: String::new(), table, known: Vec::new() })
    }

    /// A table in this one; an empty one when it is missing.
    pub(crate) fn section(&mut self, key: &'static str) -> Result<Self, Failure> {
        Ok(self.optional_section(key)?.unwrap_or_else(|| self.below(key, Table::new())))
    }

    /// A table in this one, if it is there.
    pub(crate) fn optional_section(&mut self, key: &'static str) -> Result<Option<Self>, Failure> {
        match self.take(key) {
            None => Ok(None),
            Some(Value::Table(table)) => Ok(Some(self.below(key, table))),
            Some(_) => Err(self.error(key, format!("must be a table: write [{key}] on a line of its own"))),
        }
    }

    /// The tables of a list in this one, `[[key]]`, if it is there. The remedy is for what is no such list.
    pub(crate) fn sections(&mut self, key: &'static str, remedy: &str) -> Result<Option<Vec<Self>>, Failure> {
        let Some(value) = self.take(key) else { return Ok(None) };
        let must = || self.error(key, format!("must be a list of tables: {remedy}"));
        let Value::Array(values) = value else { return Err(must()) };
        let section = |(k, value)| match value {
            Value::Table(table) => Ok(self.below(&format!("{key}[{}]", k + 1), table)),
            _ => Err(must()),
        };
        values.into_iter().enumerate().map(section).collect::<Result<_, _>>().map(Some)
    }

    fn below(&self, key: &str, table: Table) -> Self {
        let prefix = format!("{}{key}.", self.prefix);
        Self { file: self.file.clone(), prefix, table, known: Vec::new() }
    }

    /// Whether the value of a key that is still to be read is a list.
    pub(crate) fn is_list(&self, key: &str) -> bool {
        self.table.get(key).is_some_and(Value::is_array)
    }

    /// The value of a key that this table may have.
    pub(crate) fn take(&mut self, key: &'static str) -> Option<Value> {
        self.known.push(key);
        self.table.remove(key)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.table.is_empty()
    }

    /// All remaining keys as numbers, whatever they are called.
    pub(crate) fn all_numbers(&mut self) -> Result<Vec<(String, f64)>, Failure> {
        std::mem::take(&mut self.table)
            .into_iter()
            .map(|(key, value)| match as_number(&value) {
                Some(number) => Ok((key, number)),
                None => Err(self.error(&key, "must be a number")),
            })
            .collect()
    }

    pub(crate) fn number(&mut self, key: &'static str) -> Result<Option<f64>, Failure> {
        self.take(key)
            .map(|value| as_number(&value).ok_or_else(|| self.error(key, "must be a number")))
            .transpose()
    }

    /// A whole number of at least `least`.
    pub(crate) fn count(&mut self, key: &'static str, least: usize) -> Result<Option<usize>, Failure> {
        let must = format!("must be a whole number, at least {least}");
        self.take(key)
            .map(|value| {
                let count = value.as_integer().and_then(|count| usize::try_from(count).ok());
                count.filter(|&count| count >= least).ok_or_else(|| self.error(key, must))
            })
            .transpose()
    }

    pub(crate) fn flag(&mut self, key: &'static str) -> Result<Option<bool>, Failure> {
        self.take(key)
            .map(|value| value.as_bool().ok_or_else(|| self.error(key, "must be true or false")))
            .transpose()
    }

    pub(crate) fn text(&mut self, key: &'static str) -> Result<Option<String>, Failure> {
        self.take(key)
            .map(|value| match value {
                Value::String(text) => Ok(text),
                _ => Err(self.error(key, "must be a text in quotes")),
            })
            .transpose()
    }

    /// A point, `[x, y]`.
    pub(crate) fn point(&mut self, key: &'static str) -> Result<Option<[f64; 2]>, Failure> {
        self.take(key)
            .map(|value| point(&value).ok_or_else(|| self.error(key, "must be a point [x, y]")))
            .transpose()
    }

    /// A list of points.
    pub(crate) fn points(&mut self, key: &'static str) -> Result<Option<Vec<[f64; 2]>>, Failure> {
        self.take(key)
            .map(|value| {
                points(&value).ok_or_else(|| self.error(key, "must be a list of points [[x, y], ...]"))
            })
            .transpose()
    }

    /// A list of lists of points.
    pub(crate) fn point_lists(&mut self, key: &'static str) -> Result<Option<Vec<Vec<[f64; 2]>>>, Failure> {
        let lists = |value: &Value| value.as_array()?.iter().map(points).collect::<Option<Vec<_>>>();
        let must = "must be a list of lists of points [[[x, y], ...], ...]";
        self.take(key).map(|value| lists(&value).ok_or_else(|| self.error(key, must))).transpose()
    }

    /// Refuses keys that nobody has asked for.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        match self.table.keys().next() {
            None => Ok(()),
            Some(key) => Err(match meant(key, self.known.iter().copied()) {
                Some(known) => self.unknown(key, known),
                None => {
                    self.error(key, format!("has no place here: known here are {}", self.known.join(", ")))
                }
            }),
        }
    }

    /// The error for a key that has to be there.
    pub(crate) fn missing(&self, key: &'static str, remedy: &str) -> Failure {
        self.misspelt(&[key]).unwrap_or_else(|| self.error(key, format!("is missing: {remedy}")))
    }

    /// The error for a key that is almost one of `wanted`, none of which is there: to say that they are missing would
    /// send the reader the wrong way.
    pub(crate) fn misspelt(&self, wanted: &[&str]) -> Option<Failure> {
        self.table.keys().find_map(|key| match nearest(key, wanted.iter().copied()) {
            Some((meant, slips)) if slips <= MAX_SLIPS => Some(self.unknown(key, meant)),
            _ => None,
        })
    }

    fn unknown(&self, key: &str, nearest: &str) -> Failure {
        self.error(key, format!("is no key of a case file; the nearest is `{nearest}`"))
    }

    /// An error about a key of this table.
    pub(crate) fn error(&self, key: &str, problem: impl std::fmt::Display) -> Failure {
        Failure::Input(format!("{}: `{}{}` {problem}", self.file, self.prefix, excerpt(key)))
    }

    /// An error about the table as a whole.
    pub(crate) fn table_error(&self, problem: impl std::fmt::Display) -> Failure {
        Failure::Input(format!("{}: {problem}", self.file))
    }
}

pub(crate) fn as_number(value: &Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|integer| integer as f64))
}

fn point(value: &Value) -> Option<[f64; 2]> {
    match value.as_array()?.as_slice() {
        [x, y] => Some([as_number(x)?, as_number(y)?]),
        _ => None,
    }
}

fn points(value: &Value) -> Option<Vec<[f64; 2]>> {
    value.as_array()?.iter().map(point).collect()
}

/// ` line L, column C` of a byte of the text.
fn place(text: &str, byte: usize) -> String {
    let before = text.get(..byte).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().map_or(0, |last| last.chars().count()) + 1;
    format!(" line {line}, column {column}")
}
