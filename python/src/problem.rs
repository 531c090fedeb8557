//! The problem from the arguments of `solve` and `qp`.

use membrane_contact::discretization::IntegrationRule;
use membrane_contact::problem::{ByCurve, ContactProblem, Field, Membrane, Support};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyFrozenSet, PySet, PyString};

use crate::errors::{data_error, problem_error};
use crate::field::{ELSEWHERE, Reader, mapping, names};

/// The keys of a membrane, as in a case file.
const KEYS: [&str; 6] = ["tension", "load", "foundation", "height", "traction", "pressed"];

/// The height where nothing holds a membrane.
const FREE: &str = "free";

/// What `solve` and `qp` are told of the problem.
pub(crate) struct Arguments<'py> {
    pub(crate) tension: Option<Bound<'py, PyAny>>,
    pub(crate) load: Option<Bound<'py, PyAny>>,
    pub(crate) height: Option<Bound<'py, PyAny>>,
    pub(crate) membranes: Option<Bound<'py, PyAny>>,
    pub(crate) floor: Option<Bound<'py, PyAny>>,
    pub(crate) ceiling: Option<Bound<'py, PyAny>>,
}

impl<'py> Arguments<'py> {
    pub(crate) fn problem(&self, py: Python<'py>, read: Reader) -> PyResult<ContactProblem> {
        let Self { tension, load, height, membranes, floor, ceiling } = self;
        let mut stack = ContactProblem::stack();
        match membranes {
            None => {
                let Some(tension) = tension else {
                    return Err(PyTypeError::new_err(
                        "give tension=(mu1, mu2) of a pair, or membranes=[...]",
                    ));
                };
                for membrane in pair(read, tension, load.as_ref(), height.as_ref())? {
                    stack = stack.membrane(membrane);
                }
            }
            Some(membranes) => {
                let of_pair = [("tension", tension), ("load", load), ("height", height)];
                if let Some((key, _)) = of_pair.into_iter().find(|(_, datum)| datum.is_some()) {
                    return Err(PyTypeError::new_err(format!(
                        "{key} is for a pair: with membranes, write it there"
                    )));
                }
                for (i, one) in membranes.try_iter()?.enumerate() {
                    stack = stack.membrane(membrane(read, &one?, &format!("membranes[{i}]"))?);
                }
            }
        }
        if let Some(floor) = floor {
            stack = stack.floor(read.field(floor, "floor")?);
        }
        if let Some(ceiling) = ceiling {
            stack = stack.ceiling(read.field(ceiling, "ceiling")?);
        }
        stack.build().map_err(|error| problem_error(py, &error))
    }
}

/// How data are integrated.
pub(crate) fn integration_rule(py: Python<'_>, integration: &str) -> PyResult<IntegrationRule> {
    match integration {
        "quadrature" => Ok(IntegrationRule::Quadrature),
        "vertices" => Ok(IntegrationRule::Vertices),
        other => {
            let problem = format!("is {other:?}: it may be \"quadrature\" or \"vertices\"");
            Err(data_error(py, "integration", problem))
        }
    }
}

/// The paper's pair, or two membranes whose data vary.
fn pair(
    read: Reader,
    tension: &Bound<'_, PyAny>,
    load: Option<&Bound<'_, PyAny>>,
    height: Option<&Bound<'_, PyAny>>,
) -> PyResult<[Membrane; 2]> {
    let [upper, lower] = both(read, tension, "tension")?.map(Membrane::new);
    let [mut upper, mut lower] = [upper, lower];
    if let Some(load) = load {
        let [f1, f2] = both(read, load, "load")?;
        (upper, lower) = (upper.load(f1), lower.load(f2));
    }
    if let Some(height) = height {
        upper = upper.height(read.datum(height, "height")?);
    }
    Ok([upper, lower])
}

/// A datum of each membrane of a pair.
fn both(read: Reader, data: &Bound<'_, PyAny>, key: &str) -> PyResult<[Field; 2]> {
    let two = || data_error(data.py(), key, "must have two entries, one for each membrane");
    // The letters of a formula, or the names of a dictionary, are no two data; a set has no order.
    let has_no_order = data.is_instance_of::<PySet>() || data.is_instance_of::<PyFrozenSet>();
    if has_no_order || data.is_instance_of::<PyString>() || mapping(data).is_some() {
        return Err(two());
    }
    let entries: Vec<_> = data.try_iter().map_err(|_| two())?.collect::<PyResult<_>>()?;
    let [first, second] = entries.as_slice() else { return Err(two()) };
    Ok([read.field(first, &format!("{key}[0]"))?, read.field(second, &format!("{key}[1]"))?])
}

/// One membrane, with the keys of a case file.
fn membrane(read: Reader, given: &Bound<'_, PyAny>, place: &str) -> PyResult<Membrane> {
    let py = given.py();
    let Some(given) = mapping(given) else {
        let kind = given.get_type();
        return Err(PyTypeError::new_err(format!(
            "{place} must be a Membrane, or another dictionary, not {kind}"
        )));
    };
    for key in given.keys()? {
        if !key.extract::<String>().is_ok_and(|key| KEYS.contains(&key.as_str())) {
            let problem = format!("has the key {}: it may have {}", key.repr()?, KEYS.join(", "));
            return Err(data_error(py, place, problem));
        }
    }
    let get =
        |key: &str| if given.contains(key)? { given.get_item(key).map(Some) } else { PyResult::Ok(None) };
    let at = |key: &str| format!("{place}.{key}");
    let Some(tension) = get("tension")? else { return Err(data_error(py, place, "has no tension")) };
    let mut membrane = Membrane::new(read.field(&tension, &at("tension"))?);
    if let Some(load) = get("load")? {
        membrane = membrane.load(read.field(&load, &at("load"))?);
    }
    if let Some(foundation) = get("foundation")? {
        membrane = membrane.foundation(read.field(&foundation, &at("foundation"))?);
    }
    membrane = held(read, membrane, [get("height")?, get("traction")?], [&at("height"), &at("traction")])?;
    let is_pressed = |pressed: Bound<'_, PyAny>| {
        let must = || PyTypeError::new_err(format!("{} must be True or False", at("pressed")));
        pressed.extract().map_err(|_| must())
    };
    let pressed = get("pressed")?.map_or(Ok(false), is_pressed)?;
    Ok(if pressed { membrane.pressed() } else { membrane })
}

/// The membrane as `height` and `traction` say that it is held.
fn held(
    read: Reader,
    membrane: Membrane,
    [height, traction]: [Option<Bound<'_, PyAny>>; 2],
    [height_key, traction_key]: [&str; 2],
) -> PyResult<Membrane> {
    let support = |height: &Bound<'_, PyAny>, key: &str| {
        if height.extract::<String>().is_ok_and(|height| height == FREE) {
            return Ok(Support::Free { traction: 0.0.into() });
        }
        read.datum(height, key).map(Support::Fixed)
    };
    let py = [&height, &traction].into_iter().flatten().next().map(|datum| datum.py());
    let supports = by_curve(height, height_key, support)?;
    let tractions = by_curve(traction, traction_key, |traction, key| read.function(traction, key))?;
    membrane.held(supports, tractions).map_err(|error| {
        let remedy = format!("free it by height={{name: \"{FREE}\"}}");
        data_error(py.expect("a line load is given"), traction_key, format!("{error}: {remedy}"))
    })
}

/// One value for each curve that is named, and one for all that are not.
fn by_curve<'py, T>(
    data: Option<Bound<'py, PyAny>>,
    key: &str,
    convert: impl Fn(&Bound<'py, PyAny>, &str) -> PyResult<T>,
) -> PyResult<ByCurve<T>> {
    let mut by_curve = ByCurve::default();
    let Some(data) = data else { return Ok(by_curve) };
    let Some(values) = names(&data, key)? else {
        return Ok(ByCurve { elsewhere: Some(convert(&data, key)?), ..by_curve });
    };
    for (curve, value) in values {
        let value = convert(&value, &format!("{key}[{curve:?}]"))?;
        if curve == ELSEWHERE {
            by_curve.elsewhere = Some(value);
        } else {
            by_curve.parts.push((curve, value));
        }
    }
    Ok(by_curve)
}
