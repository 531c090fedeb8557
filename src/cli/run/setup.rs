//! From a case file to a mesh, a discrete problem, and a solver.

use std::io::{self, Read};
use std::path::Path;
use std::time::Instant;

use super::input::{self, Input};
use super::memory::{Memory, Work};
use super::notes::FileNotes;
use super::progress::Progress;
use crate::cli::args::CaseArguments;
use crate::cli::case::{CaseFile, CaseId, MeshSource, SolverName, SolverSettings};
use crate::cli::failure::Failure;
use crate::discretization::Discretization;
use crate::formats::gmsh::{PhysicalGroup, parse};
use crate::mesh::{
    GmshMesh, MAX_VERTICES, Mesh, MeshFamily, ReadError, estimated_vertices, generate, gmsh_nodes,
};
use crate::output::Seconds;
use crate::problem::{ContactProblem, Exact};
#[cfg(any(feature = "clarabel", feature = "osqp"))]
use crate::solver::QpSolver;
use crate::solver::{ActiveSet, Auto, ContactSolver, Multigrid, SolverOptions};
use crate::text::grouped;

/// The case and its meshes.
pub(crate) struct Setup {
    pub(crate) name: String,
    pub(crate) id: CaseId,
    pub(crate) case: CaseFile,
    /// Refinements beside those of the case file.
    further: usize,
    pub(crate) family: MeshFamily,
    /// Gmsh's numbers of the vertices of the coarse mesh; none of a mesh that was generated.
    pub(crate) node_tags: Vec<u64>,
    /// The physical groups of the mesh file that no datum mentions.
    pub(crate) groups: Vec<PhysicalGroup>,
    /// What is to be told of the mesh file, in lines for the terminal.
    pub(crate) notes: String,
    pub(crate) seconds: Seconds,
    pub(crate) memory: Memory,
}

impl Setup {
    /// Reads the case file and makes its mesh.
    pub(crate) fn new(arguments: &CaseArguments, progress: &Progress) -> Result<Self, Failure> {
        let name = arguments.path.display().to_string();
        let memory = Memory::new(arguments.memory_limit);
        let text =
            CaseFile::read_text(input::open(&arguments.path, Input::CaseFile, memory), &arguments.path)?;
        let case = CaseFile::parse(&name, &text, &arguments.path)?;
        progress.stage("making the mesh");
        let start = Instant::now();
        let Meshes { family, node_tags, groups, notes } =
            make_mesh(&name, &case, arguments.refine as usize, memory)?;
        let id = CaseId::new(&name, &text, &case.mesh);
        let seconds = Seconds { mesh: start.elapsed().as_secs_f64(), ..Seconds::default() };
        let further = arguments.refine as usize;
        Ok(Self { name, id, case, further, family, node_tags, groups, notes, seconds, memory })
    }

    /// How often the mesh was refined, by the case file and further.
    pub(crate) fn refinements(&self) -> usize {
        self.case.refine + self.further
    }

    /// Refuses another stack than the paper's pair.
    pub(crate) fn require_pair(&self) -> Result<(), Failure> {
        if self.case.pair().is_some() {
            return Ok(());
        }
        let pair = "two membranes of constant tension, held all around, the lower one at 0, without foundation or obstacle, integrated by quadrature";
        Err(Failure::Input(format!(
            "{}: so far, this command is for a pair: pose {pair}, or solve the stack as it is (`membranes solve`)",
            self.name
        )))
    }

    /// A solution by this solver, its bound and its files.
    pub(crate) fn solving(&self, solver: SolverName) -> Work {
        let membranes = if self.case.pair().is_some() { 1 } else { self.case.problem.membranes().len() };
        Work { membranes, ..Work::solving(solver) }
    }

    /// Refuses what needs more memory on this mesh than there is.
    pub(crate) fn check_memory(&self, work: Work) -> Result<(), Failure> {
        self.memory.check(&self.name, work, self.family.mesh().points().len() as f64)
    }

    /// Assembles the discrete problem, and says how long it took.
    pub(crate) fn discretize(&self, progress: &Progress) -> Result<(Discretization, Seconds), Failure> {
        progress.stage(format!("assembling on {} vertices", grouped(self.family.mesh().points().len())));
        let start = Instant::now();
        let mesh = self.family.mesh().clone();
        let d =
            Discretization::by_rule(&self.case.problem, mesh, self.case.integration).map_err(|error| {
                let vertices: Vec<usize> = error.vertex().into_iter().collect();
                Failure::Input(format!("{}: {error}{}", self.name, gmsh_nodes(&vertices, &self.node_tags)))
            })?;
        Ok((d, Seconds { assembly: start.elapsed().as_secs_f64(), ..self.seconds }))
    }
}

/// The meshes of a case, and what its mesh file calls their parts.
struct Meshes {
    family: MeshFamily,
    node_tags: Vec<u64>,
    /// Those that no datum mentions.
    groups: Vec<PhysicalGroup>,
    notes: String,
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
        memory.check(name, Work::solving(SolverName::Multigrid), finest)
    };
    let (mut node_tags, mut groups, mut notes) = (Vec::new(), Vec::new(), String::new());
    let mut family = match &case.mesh {
        MeshSource::File(path) => {
            let read = read_mesh(name, path, memory, check)?;
            let told = FileNotes::new(read.groups, read.mesh.views(), read.notes, &case.problem);
            (node_tags, notes, groups) = (read.node_tags, told.to_string(), told.unused_groups);
            MeshFamily::polygonal(with_views(read.mesh, &case.problem))
        }
        MeshSource::Generator { domain, size, grading } => {
            let vertices = estimated_vertices(domain, *size);
            // What is no mesh at all, the generator refuses.
            if vertices <= MAX_VERTICES {
                check(vertices)?;
            }
            let mut mesh = generate(domain, *size).map_err(|error| bad_mesh(&error))?;
            for (name, curve) in case.exact.iter().flat_map(Exact::regions) {
                mesh = mesh
                    .with_region(name, |[x, y]| curve.signed_distance(x, y) > 0.0)
                    .map_err(|error| bad_mesh(&error))?;
            }
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
    Ok(Meshes { family, node_tags, groups, notes })
}

/// The mesh without the views that no datum asks for. Where one is asked for that is not there, a message will name all.
fn with_views(mesh: Mesh, problem: &ContactProblem) -> Mesh {
    let wanted = problem.views();
    let are_there = wanted.iter().all(|name| mesh.views().get(name).is_some());
    if are_there { mesh.keeping_views(|name| wanted.contains(&name)) } else { mesh }
}

/// What to do when the time is over before a mesh is there.
pub(crate) fn too_early(case: &Path) -> impl Fn() -> Failure + Send + Sync + 'static {
    let name = case.display().to_string();
    move || {
        let why = "the time limit has passed before the first solve, and nothing was written";
        Failure::NotCertified(format!(
            "{name}: {why}; allow more time (--time-limit), or take a coarser mesh"
        ))
    }
}

/// The vertices after so many refinements; refuses such that lead beyond what can be stored.
pub(crate) fn check_refinements(name: &str, vertices: f64, refinements: usize) -> Result<f64, Failure> {
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
pub(crate) fn solver(name: SolverName) -> Box<dyn ContactSolver> {
    match name {
        SolverName::ActiveSet => Box::new(ActiveSet),
        SolverName::Multigrid => Box::new(Multigrid),
        SolverName::Auto => Box::new(Auto),
        #[cfg(feature = "clarabel")]
        SolverName::Clarabel => Box::new(QpSolver::new(crate::qp::Clarabel)),
        #[cfg(feature = "osqp")]
        SolverName::Osqp => Box::new(QpSolver::new(crate::qp::Osqp)),
        #[allow(unreachable_patterns, reason = "with both features there is no other")]
        _ => unreachable!("the name is refused where it is parsed"),
    }
}

/// What the settings ask of a solver.
pub(crate) fn options(settings: &SolverSettings) -> SolverOptions {
    SolverOptions {
        tolerance: settings.tolerance.or_default(),
        max_iterations: settings.max_iterations,
        time_limit: settings.time_limit,
        // Ctrl-C ends the program, which keeps what is complete.
        interrupt: None,
        polish: settings.polish,
        warm_start: None,
    }
}
