//! From a case file to a mesh, a discrete problem, and a solver.

use std::io::{self, Read};
use std::path::Path;
use std::time::Instant;

use super::args::CaseArguments;
use super::case_file::{BackendName, CaseFile, MeshSource};
use super::input::{self, Input};
use super::memory::Memory;
use super::progress::Progress;
use super::terminal::grouped;
use super::watch::Watch;
use super::{Failure, SolverSettings};
use crate::discretization::Discretization;
use crate::formats::gmsh::{PhysicalGroup, parse};
use crate::mesh::{GmshMesh, MAX_VERTICES, MeshFamily, ReadError, estimated_vertices, generate, gmsh_nodes};
use crate::output::{FileSet, Seconds, WriteSeek, prepare_folder, write_atomically};
use crate::qp::Clarabel;
use crate::solver::{ActiveSet, Auto, ContactSolver, Multigrid, QpSolver, SolverOptions};
use crate::text::excerpt;

/// The case and its meshes.
pub(super) struct Setup {
    pub(super) name: String,
    /// The text of the case file.
    pub(super) text: String,
    pub(super) case: CaseFile,
    pub(super) family: MeshFamily,
    /// Gmsh's numbers of the vertices of the coarse mesh; none of a mesh that was generated.
    pub(super) node_tags: Vec<u64>,
    /// The physical groups of the mesh file.
    pub(super) groups: Vec<PhysicalGroup>,
    pub(super) seconds: Seconds,
    pub(super) memory: Memory,
}

impl Setup {
    /// Reads the case file and makes its mesh.
    pub(super) fn new(arguments: &CaseArguments, progress: &Progress) -> Result<Self, Failure> {
        let name = arguments.path.display().to_string();
        let memory = Memory::new(arguments.memory_limit);
        let text = CaseFile::read_text(&arguments.path, memory)?;
        let case = CaseFile::parse(&name, &text, &arguments.path)?;
        progress.stage("making the mesh");
        let start = Instant::now();
        let Meshes { family, node_tags, groups } =
            make_mesh(&name, &case, arguments.refine as usize, memory)?;
        let seconds = Seconds { mesh: start.elapsed().as_secs_f64(), ..Seconds::default() };
        Ok(Self { name, text, case, family, node_tags, groups, seconds, memory })
    }

    /// Refuses a solver that needs more memory on this mesh than there is.
    pub(super) fn check_memory(&self, backend: BackendName) -> Result<(), Failure> {
        self.memory.check(&self.name, backend, self.family.mesh().points().len() as f64)
    }

    /// Assembles the discrete problem, and says how long it took.
    pub(super) fn discretize(&self, progress: &Progress) -> Result<(Discretization, Seconds), Failure> {
        progress.stage(format!("assembling on {} vertices", grouped(self.family.mesh().points().len())));
        let start = Instant::now();
        let d = Discretization::new(&self.case.problem, self.family.mesh().clone()).map_err(|error| {
            let vertices: Vec<usize> = error.vertex().into_iter().collect();
            Failure::Input(format!("{}: {error}{}", self.name, gmsh_nodes(&vertices, &self.node_tags)))
        })?;
        Ok((d, Seconds { assembly: start.elapsed().as_secs_f64(), ..self.seconds }))
    }
}

/// The groups that a run does not use, in one line for the terminal; nothing where there are none.
pub(super) fn unused_groups(groups: &[PhysicalGroup]) -> String {
    /// Names are left out where the line would become wider than 80 columns.
    const WIDEST: usize = 80 - ", and 1000 more".len();
    let mut line = String::from("  physical groups not used:");
    for (k, group) in groups.iter().enumerate() {
        let name = excerpt(&group.to_string());
        if k > 0 && line.chars().count() + 2 + name.chars().count() > WIDEST {
            return format!("{line}, and {} more\n", groups.len() - k);
        }
        line += if k > 0 { ", " } else { " " };
        line += &name;
    }
    if groups.is_empty() { String::new() } else { line + "\n" }
}

/// The meshes of a case, and what its mesh file calls their parts.
struct Meshes {
    family: MeshFamily,
    node_tags: Vec<u64>,
    groups: Vec<PhysicalGroup>,
}

/// Reads a mesh within the memory that there is.
fn read_mesh(
    name: &str,
    path: &Path,
    memory: Memory,
    check: impl Fn(f64) -> Result<(), Failure>,
) -> Result<GmshMesh, Failure> {
    let refused = |error: ReadError| cannot_read(name, path, &error);
    let read = || {
        let mut bytes = Vec::new();
        let file = input::open(path, Input::Mesh, memory)?;
        // A file that grows is not followed.
        let length = file.metadata()?.len();
        file.take(length).read_to_end(&mut bytes)?;
        Ok(parse(&bytes)?)
    };
    let triangulation = read().map_err(refused)?;
    check(triangulation.points.len() as f64)?;
    GmshMesh::new(triangulation).map_err(refused)
}

/// The coarse mesh of the case and its refinements.
fn make_mesh(name: &str, case: &CaseFile, further: usize, memory: Memory) -> Result<Meshes, Failure> {
    let bad_mesh =
        |error: &dyn std::fmt::Display| Failure::Input(format!("{name}: [mesh], [domain]: {error}"));
    let refinements = case.refine.saturating_add(further);
    // Of all solvers, this one needs the least.
    let check = |vertices: f64| {
        let finest = check_refinements(name, vertices, refinements)?;
        memory.check(name, BackendName::Multigrid, finest)
    };
    let (mut node_tags, mut groups) = (Vec::new(), Vec::new());
    let mut family = match &case.mesh {
        MeshSource::File(path) => {
            let read = read_mesh(name, path, memory, check)?;
            (node_tags, groups) = (read.node_tags, read.groups);
            MeshFamily::polygonal(read.mesh)
        }
        MeshSource::Generator { domain, size, grading } => {
            let vertices = estimated_vertices(domain, *size);
            // What is no mesh at all, the generator refuses.
            if vertices <= MAX_VERTICES {
                check(vertices)?;
            }
            let mesh = generate(domain, *size).map_err(|error| bad_mesh(&error))?;
            match *grading {
                Some((point, exponent)) => {
                    MeshFamily::graded(mesh, point, exponent).map_err(|error| bad_mesh(&error))?
                }
                None => MeshFamily::of_domain(mesh, domain),
            }
        }
    };
    check(family.mesh().points().len() as f64)?;
    for _ in 0..refinements {
        family
            .refine()
            .map_err(|error| bad_mesh(&format!("{error}{}", gmsh_nodes(&error.vertices(), &node_tags))))?;
    }
    Ok(Meshes { family, node_tags, groups })
}

/// The vertices after so many refinements; refuses such that lead beyond what can be stored.
pub(super) fn check_refinements(name: &str, vertices: f64, refinements: usize) -> Result<f64, Failure> {
    // Each refinement makes four times as many.
    let finest = vertices * 4f64.powf(refinements as f64);
    if finest <= MAX_VERTICES {
        return Ok(finest);
    }
    Err(Failure::Input(format!(
        "{name}: {refinements} refinements lead beyond {MAX_VERTICES:.0e} vertices: refine less"
    )))
}

fn cannot_read(case: &str, mesh: &Path, error: &ReadError) -> Failure {
    let mesh = mesh.display();
    Failure::Input(match error {
        // It says what to do.
        ReadError::Io(error) if error.kind() == io::ErrorKind::OutOfMemory => format!("{mesh}: {error}"),
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

/// Makes the folder for results: that nothing can be written there is said before anything is computed. `says` is what an
/// interrupted run has to say of it.
pub(super) fn make_folder(folder: &Path, watch: &Watch, says: &'static str) -> Result<(), Failure> {
    prepare_folder(folder).map_err(|error| cannot_write(folder, &error))?;
    watch.folder(folder, says);
    Ok(())
}

/// The files of a result, which appear together, the summary last.
pub(super) struct Results<'f> {
    folder: &'f Path,
    files: FileSet,
}

impl<'f> Results<'f> {
    pub(super) fn new(folder: &'f Path) -> Self {
        Self { folder, files: FileSet::new(folder) }
    }

    pub(super) fn write(
        &mut self,
        name: &str,
        write: impl FnOnce(&mut (dyn WriteSeek + '_)) -> std::io::Result<()>,
    ) -> Result<(), Failure> {
        self.files
            .write(Path::new(name), write)
            .map_err(|error| cannot_write(&self.folder.join(name), &error))
    }

    pub(super) fn publish(self) -> Result<(), Failure> {
        self.files.publish().map_err(|error| cannot_write(self.folder, &error))
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_that_are_not_used_are_one_line_of_80_columns() {
        let group =
            |tag: u64| PhysicalGroup { dimension: 1, tag, name: (tag < 3).then(|| "an\nedge".into()) };
        let line = |tags: std::ops::Range<u64>| unused_groups(&tags.map(group).collect::<Vec<_>>());
        assert_eq!(line(0..0), "");
        assert_eq!(line(2..4), "  physical groups not used: an\\nedge, curves 3\n");
        let many = line(3..1003);
        assert_eq!(many, "  physical groups not used: curves 3, curves 4, curves 5, and 997 more\n");
        assert!(many.len() <= 81);
    }
}
