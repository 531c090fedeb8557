//! Data as case files have them: a number, a formula, or one of these for each part of the mesh that has a name.

use std::collections::BTreeMap;

use toml::{Table, Value};

use crate::cli::case::section::{Section, as_number};
use crate::cli::failure::Failure;
use crate::problem::{Expression, Field, Function};

/// What stands among names for all that is not named.
const ELSEWHERE: &str = "elsewhere";

/// The only key of a table that names data of the mesh file.
const VIEW: &str = "view";

/// One value for each named part of the mesh, and one for the rest; without names, one for all.
pub(super) struct ByName<T> {
    pub(super) parts: BTreeMap<String, T>,
    pub(super) elsewhere: Option<T>,
}

impl<T> ByName<T> {
    /// The value of a key: one for all, or a table with one for each name. The names are those of each `part` ("region") of
    /// the mesh, which is not known here.
    pub(super) fn read(
        section: &mut Section,
        key: &'static str,
        part: &str,
        convert: &dyn Fn(&Value) -> Result<T, String>,
    ) -> Result<Option<Self>, Failure> {
        let Some(value) = section.take(key) else { return Ok(None) };
        let convert =
            |key: &str, value: &Value| convert(value).map_err(|problem| section.error(key, problem));
        let one_of = format!("give one value, or one for each {part} in a table {{ name = ... }}");
        match value {
            Value::Array(_) => Err(section.error(key, format!("is a list: {one_of}"))),
            Value::Table(table) if table.is_empty() => Err(section.error(key, format!("is empty: {one_of}"))),
            Value::Table(table) if !is_view(&table) => {
                let part = |(name, value): (String, Value)| {
                    convert(&format!("{key}.{name}"), &value).map(|value| (name, value))
                };
                let mut parts = table.into_iter().map(part).collect::<Result<BTreeMap<_, _>, _>>()?;
                let elsewhere = parts.remove(ELSEWHERE);
                Ok(Some(Self { parts, elsewhere }))
            }
            value => Ok(Some(Self { parts: BTreeMap::new(), elsewhere: Some(convert(key, &value)?) })),
        }
    }
}

/// `{ view = ... }`
fn is_view(table: &Table) -> bool {
    table.keys().eq([VIEW])
}

/// Whether a value names a data view of the mesh file.
pub(super) fn names_view(value: &Value) -> bool {
    value.as_table().is_some_and(is_view)
}

/// A number, a formula, a data view, or one of these for each region.
pub(super) fn field(section: &mut Section, key: &'static str) -> Result<Option<Field>, Failure> {
    let values = ByName::read(section, key, "region", &datum)?;
    Ok(values.map(|ByName { parts, elsewhere }| match elsewhere {
        Some(everywhere) if parts.is_empty() => everywhere,
        Some(elsewhere) => Field::by_region(parts).elsewhere(elsewhere),
        None => Field::by_region(parts),
    }))
}

/// A number, an expression, or a data view of the mesh file.
pub(super) fn datum(value: &Value) -> Result<Field, String> {
    if !names_view(value) {
        return function(value).map(Field::from);
    }
    let name = value.get(VIEW).and_then(Value::as_str);
    name.map(Field::view).ok_or("must name a data view of the mesh file: { view = \"name\" }".into())
}

/// A number or an expression.
pub(super) fn function(value: &Value) -> Result<Function, String> {
    match value {
        Value::String(source) => Expression::parse(source)
            .map(Function::from)
            .map_err(|error| format!("is no expression: {error}")),
        _ if names_view(value) => {
            Err("cannot be a data view: give a number or an expression in quotes".into())
        }
        _ => as_number(value)
            .map(Function::Constant)
            .ok_or("must be a number or an expression in quotes".into()),
    }
}
