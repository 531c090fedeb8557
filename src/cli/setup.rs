//! From a case file to a mesh, a discrete problem, and a solver.

use std::path::Path;
use std::time::Instant;

use super::args::CaseArguments;
use super::case_file::{BackendName, CaseFile, MeshSource};
use super::progress::Progress;
use super::terminal::grouped;
use super::{Failure, SolverSettings};
use crate::discretization::Discretization;
use crate::mesh::{MAX_VERTICES, Mesh, MeshFamily, ReadError, generate};
use crate::output::{Seconds, WriteSeek, write_atomically};
use crate::qp::Clarabel;
use crate::solver::{ActiveSet, Auto, ContactSolver, Multigrid, QpSolver, SolverOptions};

/// The case and its meshes.
pub(super) struct Setup {
    pub(super) name: String,
    /// The text of the case file.
    pub(super) text: String,
    pub(super) case: CaseFile,
    pub(super) family: MeshFamily,
    pub(super) seconds: Seconds,
}

impl Setup {
    /// Reads the case file and makes its mesh.
    pub(super) fn new(arguments: &CaseArguments, progress: &Progress) -> Result<Self, Failure> {
        let name = arguments.path.display().to_string();
        let text = CaseFile::read_text(&arguments.path)?;
        let case = CaseFile::parse(&name, &text, &arguments.path)?;
        progress.stage("making the mesh");
        let start = Instant::now();
        let family = make_mesh(&name, &case, arguments.refine as usize)?;
        let seconds = Seconds { mesh: start.elapsed().as_secs_f64(), ..Seconds::default() };
        Ok(Self { name, text, case, family, seconds })
    }

    /// Assembles the discrete problem, and says how long it took.
    pub(super) fn discretize(&self, progress: &Progress) -> Result<(Discretization<'_>, Seconds), Failure> {
        progress.stage(format!("assembling on {} vertices", grouped(self.family.mesh().points().len())));
        let start = Instant::now();
        let d = Discretization::new(&self.case.problem, self.family.mesh())
            .map_err(|error| Failure::Input(format!("{}: {error}", self.name)))?;
        Ok((d, Seconds { assembly: start.elapsed().as_secs_f64(), ..self.seconds }))
    }
}

/// The coarse mesh of the case and its refinements.
fn make_mesh(name: &str, case: &CaseFile, further: usize) -> Result<MeshFamily, Failure> {
    let bad_mesh =
        |error: &dyn std::fmt::Display| Failure::Input(format!("{name}: [mesh], [domain]: {error}"));
    let mut family = match &case.mesh {
        MeshSource::File(path) => {
            MeshFamily::polygonal(Mesh::read_gmsh(path).map_err(|error| cannot_read(name, path, &error))?)
        }
        MeshSource::Generator { domain, size, grading } => {
            let mesh = generate(domain, *size).map_err(|error| bad_mesh(&error))?;
            match *grading {
                Some((point, exponent)) => {
                    MeshFamily::graded(mesh, point, exponent).map_err(|error| bad_mesh(&error))?
                }
                None => MeshFamily::of_domain(mesh, domain),
            }
        }
    };
    let refinements = case.refine.saturating_add(further);
    check_refinements(name, &family, refinements)?;
    for _ in 0..refinements {
        family.refine().map_err(|error| bad_mesh(&error))?;
    }
    Ok(family)
}

/// Refuses refinements that lead beyond what can be stored.
pub(super) fn check_refinements(name: &str, family: &MeshFamily, refinements: usize) -> Result<(), Failure> {
    // Each refinement makes four times as many.
    if family.mesh().points().len() as f64 * 4f64.powf(refinements as f64) <= MAX_VERTICES {
        return Ok(());
    }
    Err(Failure::Input(format!(
        "{name}: {refinements} refinements lead beyond {MAX_VERTICES:.0e} vertices: refine less"
    )))
}

fn cannot_read(case: &str, mesh: &Path, error: &ReadError) -> Failure {
    let mesh = mesh.display();
    Failure::Input(match error {
        ReadError::Io(_) => {
            format!("{case}: `domain.mesh`: {mesh}: {error}; name a file, relative to the case file")
        }
        _ => format!("{mesh}: {error}"),
    })
}

/// The solver of this name.
pub(super) fn solver(name: BackendName) -> Box<dyn ContactSolver> {
    match name {
        BackendName::Clarabel => Box::new(QpSolver::new(Clarabel)),
        BackendName::ActiveSet => Box::new(ActiveSet),
        BackendName::Multigrid => Box::new(Multigrid),
        BackendName::Auto => Box::new(Auto),
        #[cfg(feature = "osqp")]
        BackendName::Osqp => Box::new(QpSolver::new(crate::qp::Osqp)),
        #[cfg(not(feature = "osqp"))]
        BackendName::Osqp => unreachable!("the name is refused where it is parsed"),
    }
}

/// What the settings ask of a solver.
pub(super) fn options(settings: &SolverSettings) -> SolverOptions {
    SolverOptions {
        tolerance: settings.tolerance.or_default(),
        max_iterations: settings.max_iterations,
        time_limit: settings.time_limit,
        polish: settings.polish,
        warm_start: None,
    }
}

/// Makes the folder for results.
pub(super) fn make_folder(folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|error| cannot_write(folder, &error))
}

/// Writes a result, whole or not at all.
pub(super) fn write_file(
    path: &Path,
    write: impl FnOnce(&mut (dyn WriteSeek + '_)) -> std::io::Result<()>,
) -> Result<(), Failure> {
    write_atomically(path, write).map_err(|error| cannot_write(path, &error))
}

fn cannot_write(path: &Path, error: &std::io::Error) -> Failure {
    Failure::Input(format!("{}: cannot write: {error}; name another folder with --out", path.display()))
}
