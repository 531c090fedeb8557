//! The case file: problem, mesh and solver from TOML.

use std::collections::BTreeMap;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::str::FromStr;

use toml::Value;

use super::Failure;
use super::input::{self, Input};
use super::memory::Memory;
use super::section::{Section, as_number};
use crate::mesh::{MeshSize, Pattern};
use crate::problem::{Case, ContactProblem, Domain, ExactSolution, Expression, Function};
use crate::study::Tolerance;
use crate::text::{Number, excerpt};

/// Cells of a structured mesh when the case file does not say.
const DEFAULT_CELLS: usize = 64;

/// Least angle of an unstructured mesh when the case file does not say, degrees.
const DEFAULT_MIN_ANGLE: f64 = 25.0;

/// Longest case file, bytes: a polygon of half a million corners. Its tables take a few hundred times as much memory.
const MAX_BYTES: u64 = 1 << 24;

/// A case file, read and checked.
#[derive(Debug, Clone)]
pub struct CaseFile {
    /// Its title, else its name.
    pub title: String,
    /// The problem.
    pub problem: ContactProblem,
    /// The exact solution, for a built-in case.
    pub exact: Option<ExactSolution>,
    /// Where the mesh comes from.
    pub mesh: MeshSource,
    /// Uniform refinements on top.
    pub refine: usize,
    /// How to solve.
    pub solver: SolverSettings,
}

/// Where a mesh comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum MeshSource {
    /// A Gmsh file.
    File(PathBuf),
    /// A generator.
    Generator {
        /// The domain.
        domain: Domain,
        /// How fine.
        size: MeshSize,
        /// A point towards which the mesh is graded, and the exponent: see [`Mesh::graded`](crate::mesh::Mesh::graded).
        grading: Option<([f64; 2], f64)>,
    },
}

/// The table `[solver]`.
#[derive(Debug, Clone, PartialEq)]
pub struct SolverSettings {
    /// Which solver.
    pub backend: BackendName,
    /// Largest relative residual, or one that follows the error bound.
    pub tolerance: Tolerance,
    /// Whether to polish.
    pub polish: bool,
    /// Limit of iterations.
    pub max_iterations: Option<usize>,
    /// Limit of time, seconds.
    pub time_limit: Option<f64>,
}

/// A solver, by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BackendName {
    /// The interior-point solver Clarabel.
    Clarabel,
    /// The operator-splitting solver OSQP.
    Osqp,
    /// The active set method on the decoupled problem.
    ActiveSet,
    /// Multigrid on the decoupled problem.
    Multigrid,
    /// Whichever of our own suits the mesh.
    Auto,
}

impl BackendName {
    /// Every name.
    pub const ALL: [Self; 5] = [Self::Auto, Self::Multigrid, Self::ActiveSet, Self::Clarabel, Self::Osqp];

    /// The name in case files.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Clarabel => "clarabel",
            Self::Osqp => "osqp",
            Self::ActiveSet => "active-set",
            Self::Multigrid => "multigrid",
            Self::Auto => "auto",
        }
    }

    /// Whether its answers are polished; the others know their contact set.
    pub fn is_polished(self) -> bool {
        matches!(self, Self::Clarabel | Self::Osqp)
    }

    /// Whether this build contains it.
    pub fn is_built(self) -> bool {
        self != Self::Osqp || cfg!(feature = "osqp")
    }
}

impl FromStr for BackendName {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let known = Self::ALL.into_iter().find(|backend| backend.as_str() == name);
        match known {
            Some(backend) if backend.is_built() => Ok(backend),
            Some(_) => {
                Err(format!("`{name}` is not in this build: build with `cargo build --features {name}`"))
            }
            None => Err(format!(
                "there is no solver `{}`: choose one of {}",
                excerpt(name),
                Self::ALL.map(Self::as_str).join(", ")
            )),
        }
    }
}

impl CaseFile {
    /// Reads a case file. The paths in it are relative to it.
    ///
    /// # Errors
    /// One line that names the file, the key and the remedy.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let text = Self::read_text(path, Memory::new(None))?;
        Self::parse(&path.display().to_string(), &text, path)
    }

    /// Reads the text of a case file, which takes its place in the memory when it is parsed.
    pub(super) fn read_text(path: &Path, memory: Memory) -> Result<String, Failure> {
        let read = || {
            let mut text = String::new();
            input::open(path, Input::CaseFile, memory)?.take(MAX_BYTES + 1).read_to_string(&mut text)?;
            if text.len() as u64 > MAX_BYTES { Err(io::ErrorKind::FileTooLarge.into()) } else { Ok(text) }
        };
        read().map_err(|error| Failure::Input(format!("{}: {}", path.display(), unreadable(&error))))
    }

    /// Reads the text of a case file that lies at `path`; `name` stands in messages.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn parse(name: &str, text: &str, path: &Path) -> Result<Self, Failure> {
        let mut top = Section::top(name, text)?;
        let stem = path.file_stem().map_or_else(|| name.into(), |stem| stem.to_string_lossy().into_owned());
        let title = top.text("title")?.unwrap_or(stem);
        let exact = exact_case(&mut top)?;
        let problem = problem(&mut top, exact.as_ref())?;
        let (mesh, refine) = mesh(&mut top, exact.as_ref(), path)?;
        let solver = solver(&mut top)?;
        top.finish()?;
        Ok(Self { title, problem, exact, mesh, refine, solver })
    }
}

impl CaseFile {
    /// The domain, where it is not given by a mesh file.
    pub(super) fn domain(&self) -> Option<&Domain> {
        match &self.mesh {
            MeshSource::File(_) => None,
            MeshSource::Generator { domain, .. } => Some(domain),
        }
    }
}

fn unreadable(error: &io::Error) -> String {
    let remedy = match error.kind() {
        io::ErrorKind::OutOfMemory => return format!("cannot read the case file: {error}"),
        io::ErrorKind::FileTooLarge => {
            "have a polygon of so many corners meshed by Gmsh, and name the mesh file"
        }
        io::ErrorKind::NotFound => "name an existing file, or make one with `membranes cases strip`",
        io::ErrorKind::InvalidData => "save it as UTF-8",
        _ => "name a readable file",
    };
    format!("cannot read the case file: {error}; {remedy}")
}

/// `case = "..."` and `[parameters]`.
fn exact_case(top: &mut Section) -> Result<Option<ExactSolution>, Failure> {
    let name = top.text("case")?;
    let mut section = top.section("parameters")?;
    let Some(name) = name else {
        if !section.is_empty() {
            return Err(
                top.error("parameters", "belongs to a built-in case: add `case = \"...\"` or remove it")
            );
        }
        return Ok(None);
    };
    let case = Case::from_name(&name)
        .map_err(|error| top.error("case", format!("= \"{}\": {error}", excerpt(&name))))?;
    let parameters: BTreeMap<String, f64> = section.all_numbers()?.into_iter().collect();
    case.solution(&parameters).map(Some).map_err(|error| top.table_error(format!("[parameters]: {error}")))
}

/// `[membranes]`, or the problem of the built-in case.
fn problem(top: &mut Section, exact: Option<&ExactSolution>) -> Result<ContactProblem, Failure> {
    let mut section = top.section("membranes")?;
    if let Some(exact) = exact {
        if !section.is_empty() {
            return Err(top.error("membranes", "contradicts `case`: remove one of the two"));
        }
        return exact.problem().map_err(|error| top.table_error(format!("[parameters]: {error}")));
    }
    if section.is_empty() {
        let remedy = "add a table [membranes] with tension, load, height, or `case = \"...\"`";
        return Err(top
            .misspelt(&["membranes", "case"])
            .unwrap_or_else(|| top.table_error(format!("there is no problem: {remedy}"))));
    }
    let [mu1, mu2] =
        pair(&mut section, "tension", &|value| as_number(value).ok_or("must be a number".into()))?
            .ok_or_else(|| section.missing("tension", "add `tension = [mu1, mu2]`"))?;
    let [f1, f2] = pair(&mut section, "load", &function)?
        .ok_or_else(|| section.missing("load", "add `load = [f1, f2]`, numbers or expressions in x and y"))?;
    let height = section
        .take("height")
        .map(|value| function(&value).map_err(|problem| section.error("height", problem)))
        .transpose()?
        .unwrap_or(Function::Constant(0.0));
    let problem = ContactProblem::builder().tension(mu1, mu2).load(f1, f2).height(height).build();
    let problem = problem.map_err(|error| section.table_error(format!("[membranes]: {error}")))?;
    section.finish()?;
    Ok(problem)
}

/// Two values, one for each membrane.
fn pair<T>(
    section: &mut Section,
    key: &'static str,
    convert: &dyn Fn(&Value) -> Result<T, String>,
) -> Result<Option<[T; 2]>, Failure> {
    let Some(value) = section.take(key) else { return Ok(None) };
    let Some([first, second]) = value.as_array().map(Vec::as_slice) else {
        return Err(section.error(key, "must have two entries, one for each membrane: [first, second]"));
    };
    let convert = |k: usize, value: &Value| {
        convert(value).map_err(|problem| section.error(&format!("{key}[{k}]"), problem))
    };
    Ok(Some([convert(1, first)?, convert(2, second)?]))
}

/// A number or an expression.
fn function(value: &Value) -> Result<Function, String> {
    match value {
        Value::String(source) => Expression::parse(source)
            .map(Function::from)
            .map_err(|error| format!("is no expression: {error}")),
        _ => as_number(value)
            .map(Function::Constant)
            .ok_or("must be a number or an expression in quotes".into()),
    }
}

/// `[domain]` and `[mesh]`.
fn mesh(
    top: &mut Section,
    exact: Option<&ExactSolution>,
    path: &Path,
) -> Result<(MeshSource, usize), Failure> {
    let mut place = top.section("domain")?;
    let mut fineness = top.section("mesh")?;
    let refine = fineness.count("refine", 0)?.unwrap_or(0);
    let file = place.text("mesh")?;
    let shape = place.text("shape")?;
    let source = match (file, shape, exact) {
        (Some(_), Some(_), _) => {
            return Err(place.error("shape", "contradicts `domain.mesh`: remove one of the two"));
        }
        (_, Some(_), Some(_)) => return Err(place.error("shape", "is given by the case already: remove it")),
        (Some(_), None, _) if !fineness.is_empty() => {
            return Err(top.error(
                "mesh",
                "describes a mesh to generate, but `domain.mesh` is a file: keep `refine` only",
            ));
        }
        (Some(file), None, _) => MeshSource::File(path.parent().unwrap_or(Path::new("")).join(file)),
        (None, Some(shape), None) => generator(&mut fineness, domain(&mut place, &shape)?)?,
        (None, None, Some(exact)) => generator(&mut fineness, exact.domain())?,
        (None, None, None) => {
            let remedy = "add a table [domain] with `shape = \"square\"` or `mesh = \"file.msh\"`";
            return Err(place
                .misspelt(&["shape", "mesh"])
                .or_else(|| top.misspelt(&["domain"]))
                .unwrap_or_else(|| top.table_error(format!("there is no domain: {remedy}"))));
        }
    };
    place.finish()?;
    fineness.finish()?;
    Ok((source, refine))
}

fn generator(section: &mut Section, domain: Domain) -> Result<MeshSource, Failure> {
    let grading = section.number("grading")?.map(|exponent| match domain {
        Domain::Rectangle { lower, upper } => {
            Ok(([0, 1].map(|axis| 0.5 * (lower[axis] + upper[axis])), exponent))
        }
        Domain::LShape { .. } => Ok(([0.0, 0.0], exponent)),
        _ => Err(section
            .error("grading", "is for a square (to its centre) or an L-shape (to its corner): remove it")),
    });
    let grading = grading.transpose()?;
    let size = mesh_size(section, &domain)?;
    Ok(MeshSource::Generator { domain, size, grading })
}

fn domain(section: &mut Section, shape: &str) -> Result<Domain, Failure> {
    const SHAPES: [&str; 5] = ["square", "rectangle", "l-shape", "disk", "polygon"];
    Ok(match shape {
        "square" => {
            let [x, y] = section.point("lower")?.unwrap_or([0.0, 0.0]);
            let side = section.number("side")?.unwrap_or(1.0);
            Domain::Rectangle { lower: [x, y], upper: [x + side, y + side] }
        }
        "rectangle" => {
            let lower = section.point("lower")?.unwrap_or([0.0, 0.0]);
            let upper = section.point("upper")?;
            let missing = || section.missing("upper", "add `upper = [x, y]`, the upper right corner");
            Domain::Rectangle { lower, upper: upper.ok_or_else(missing)? }
        }
        "l-shape" => Domain::LShape { half_width: section.number("half_width")?.unwrap_or(1.0) },
        "disk" => {
            let centre = section.point("centre")?.unwrap_or([0.0, 0.0]);
            Domain::Disk { centre, radius: section.number("radius")?.unwrap_or(1.0) }
        }
        "polygon" => {
            let vertices = section.points("vertices")?;
            let holes = section.point_lists("holes")?.unwrap_or_default();
            let missing = || section.missing("vertices", "add `vertices = [[x, y], ...]`");
            Domain::Polygon { vertices: vertices.ok_or_else(missing)?, holes }
        }
        _ => {
            return Err(section.error(
                "shape",
                format!("= \"{}\" is unknown: choose one of {}", excerpt(shape), SHAPES.join(", ")),
            ));
        }
    })
}

fn mesh_size(section: &mut Section, domain: &Domain) -> Result<MeshSize, Failure> {
    let cells = section.count("cells", 1)?;
    let size = section.number("size")?;
    let pattern = section.text("pattern")?;
    let min_angle = section.number("min_angle")?;
    match (cells, size) {
        (Some(_), Some(_)) => Err(section.error("size", "contradicts `mesh.cells`: remove one of the two")),
        (None, Some(size)) => {
            if pattern.is_some() {
                return Err(
                    section.error("pattern", "belongs to a structured mesh: give `cells` in place of `size`")
                );
            }
            Ok(MeshSize::EdgeLength { size, min_angle: min_angle.unwrap_or(DEFAULT_MIN_ANGLE) })
        }
        (None, None) if matches!(domain, Domain::Polygon { .. }) => {
            Err(section.missing("size", "add `size = ...`, the target edge length"))
        }
        (cells, None) => {
            if min_angle.is_some() {
                return Err(section
                    .error("min_angle", "belongs to an unstructured mesh: give `size` in place of `cells`"));
            }
            let pattern = match pattern.as_deref() {
                None | Some("right") => Pattern::Right,
                Some("crossed") => Pattern::Crossed,
                Some(other) => {
                    return Err(section.error(
                        "pattern",
                        format!("= \"{}\" is unknown: choose right or crossed", excerpt(other)),
                    ));
                }
            };
            Ok(MeshSize::Cells { cells: cells.unwrap_or(DEFAULT_CELLS), pattern })
        }
    }
}

/// `[solver]`.
fn solver(top: &mut Section) -> Result<SolverSettings, Failure> {
    let mut section = top.section("solver")?;
    let backend = match section.text("backend")? {
        None => BackendName::Auto,
        Some(name) => name.parse().map_err(|problem: String| {
            section.error("backend", format!("= \"{}\": {problem}", excerpt(&name)))
        })?,
    };
    let tolerance = match section.take("tolerance") {
        None => Tolerance::Fixed(1e-8),
        Some(value) => tolerance(&value).map_err(|problem| section.error("tolerance", problem))?,
    };
    let time_limit = section.number("time_limit")?;
    if let Some(seconds) = time_limit
        && !(seconds > 0.0 && seconds.is_finite())
    {
        return Err(
            section.error("time_limit", format!("= {seconds} is out of range: choose seconds above 0"))
        );
    }
    let settings = SolverSettings {
        backend,
        tolerance,
        polish: section.flag("polish")?.unwrap_or(true),
        max_iterations: section.count("max_iterations", 1)?,
        time_limit,
    };
    section.finish()?;
    Ok(settings)
}

/// A number, or "auto".
fn tolerance(value: &Value) -> Result<Tolerance, String> {
    if value.as_str() == Some("auto") {
        return Ok(Tolerance::Auto);
    }
    let number = as_number(value).ok_or("must be a number or \"auto\"")?;
    if number > 0.0 && number < 1.0 {
        Ok(Tolerance::Fixed(number))
    } else {
        Err(format!("= {} is out of range: choose between 0 and 1", Number(number)))
    }
}
