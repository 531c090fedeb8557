//! The case file: problem, mesh and solver from TOML.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use super::mesh::{MeshSource, mesh};
use super::problem::{exact_case, problem};
use super::section::Section;
use super::solver::{SolverSettings, solver};
use crate::cli::failure::Failure;
use crate::discretization::IntegrationRule;
use crate::formats::open_regular;
use crate::problem::{ContactProblem, Domain, Exact, Pair};
use crate::text::excerpt;

/// Longest case file, bytes: a polygon of half a million corners. Its tables take a few hundred times as much memory.
const MAX_BYTES: u64 = 1 << 24;

/// A case file, read and checked.
#[derive(Debug, Clone)]
pub struct CaseFile {
    /// Its title, else its name.
    pub title: String,
    /// The problem.
    pub problem: ContactProblem,
    /// How its data are integrated.
    pub integration: IntegrationRule,
    /// The exact solution, for a built-in case.
    pub exact: Option<Exact>,
    /// Where the mesh comes from.
    pub mesh: MeshSource,
    /// Uniform refinements on top.
    pub refine: usize,
    /// How to solve.
    pub solver: SolverSettings,
}

impl CaseFile {
    /// Reads a case file. The paths in it are relative to it.
    ///
    /// # Errors
    /// One line that names the file, the key and the remedy.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        Self::parse(&path.display().to_string(), &Self::read_text(open_regular(path), path)?, path)
    }

    /// Reads the text of a case file that was opened at `path`.
    pub(crate) fn read_text(opened: io::Result<File>, path: &Path) -> Result<String, Failure> {
        let read = || {
            let mut text = String::new();
            opened?.take(MAX_BYTES + 1).read_to_string(&mut text)?;
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
        let integration = integration(&mut top)?;
        let exact = exact_case(&mut top)?;
        if exact.is_some() && integration != IntegrationRule::default() {
            return Err(top.error("integration", "is given by the case already: remove it"));
        }
        let problem = problem(&mut top, exact.as_ref())?;
        let (mesh, refine) = mesh(&mut top, exact.as_ref(), path)?;
        if let (MeshSource::Generator { .. }, [view, ..]) = (&mesh, problem.views().as_slice()) {
            let view = excerpt(view);
            let remedy = "name the file by `domain.mesh`, or give a formula";
            return Err(top.table_error(format!(
                "the data view `{view}` has to be in a mesh file, but there is none: {remedy}"
            )));
        }
        let solver = solver(&mut top)?;
        top.finish()?;
        Ok(Self { title, problem, integration, exact, mesh, refine, solver })
    }

    /// The paper's pair, if it is one, and is to be integrated as such.
    pub(crate) fn pair(&self) -> Option<&Pair> {
        self.problem.as_pair().filter(|_| self.integration == IntegrationRule::default())
    }

    /// The domain, where it is not given by a mesh file.
    pub(crate) fn domain(&self) -> Option<&Domain> {
        match &self.mesh {
            MeshSource::File(_) => None,
            MeshSource::Generator { domain, .. } => Some(domain),
        }
    }
}

/// `integration = "quadrature"` or `"vertices"`.
fn integration(top: &mut Section) -> Result<IntegrationRule, Failure> {
    match top.text("integration")?.as_deref() {
        None | Some("quadrature") => Ok(IntegrationRule::Quadrature),
        Some("vertices") => Ok(IntegrationRule::Vertices),
        Some(other) => {
            let known = "choose quadrature or vertices";
            Err(top.error("integration", format!("= \"{}\" is unknown: {known}", excerpt(other))))
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
