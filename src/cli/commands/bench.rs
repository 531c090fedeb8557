//! `membranes bench`: the solvers side by side.

mod files;
mod table;

use std::path::PathBuf;
use std::sync::Arc;

use crate::cli::args::{BenchArguments, CaseArguments};
use crate::cli::case::{CaseId, SolverName};
use crate::cli::failure::Failure;
use crate::cli::run::clock::Clock;
use crate::cli::run::files::{Part, ROWS, TIMES};
use crate::cli::run::folder::{Claim, Folder};
use crate::cli::run::memory::{Memory, Work};
use crate::cli::run::pictures::Pictures;
use crate::cli::run::progress::Progress;
use crate::cli::run::setup::{Setup, check_refinements, solver};
use crate::cli::run::watch::Watch;
use crate::cli::terminal::print;
use crate::discretization::PairDiscretization;
use crate::mesh::{MAX_VERTICES, Mesh, gmsh_nodes};
use crate::problem::ContactProblem;
use crate::solver::SolverOptions;
use crate::study::comparison::{Comparison, MEMORY, Place, Row, SQUARE, square_mesh, square_problem};
use crate::text::grouped;
use files::{read_rows, write_results, write_rows};

/// Where results go without a case file and without `--out`.
const FAMILY: &str = "bench";

pub(crate) fn run(arguments: &BenchArguments, watch: &Watch) -> Result<(), Failure> {
    let progress = Progress::new(arguments.quiet);
    let mut bench = Bench::new(arguments, &progress, watch)?;
    let folder = match &arguments.case {
        _ if arguments.no_run => bench.run_nothing()?,
        None => bench.run_family(&arguments.sizes)?,
        Some(path) => bench.run_case(path.clone(), arguments)?,
    };
    let Bench { title, rows, measured, notes, .. } = bench;
    let pictures = Pictures::new(&arguments.pictures, Clock::new(None));
    write_results(&folder, &title, &rows, &pictures)?;
    drop(progress);
    if !arguments.quiet {
        let table = table::table(&title, &rows, (folder.path(), &pictures.files(TIMES)));
        print(&(table + &notes))?;
    }
    if arguments.no_run || rows[..measured].iter().any(|row| row.certified) {
        return Ok(());
    }
    let remedy =
        "allow more time by --time-limit, more memory by --memory-limit, or choose others by --solvers";
    Err(Failure::NotCertified(format!("{title}: no solver has a certified solution ({ROWS}); {remedy}")))
}

/// A comparison under way.
struct Bench<'a> {
    title: String,
    solvers: Vec<SolverName>,
    options: SolverOptions,
    arguments: &'a BenchArguments,
    /// Those measured so far, before those of other files.
    rows: Vec<Row>,
    measured: usize,
    memory: Memory,
    /// What is to be told of the mesh file of a case, and Gmsh's numbers of its vertices.
    notes: String,
    node_tags: Vec<u64>,
    progress: &'a Progress,
    watch: &'a Watch,
}

impl<'a> Bench<'a> {
    /// Reads the rows of other files and makes the folder: what can fail does so before anything is measured.
    fn new(arguments: &'a BenchArguments, progress: &'a Progress, watch: &'a Watch) -> Result<Self, Failure> {
        let mut rows = Vec::new();
        let memory = Memory::new(arguments.memory_limit);
        for path in &arguments.merge {
            rows.extend(read_rows(path, memory)?);
        }
        let built = || SolverName::ALL.into_iter().filter(|solver| solver.is_built()).collect();
        let mut solvers = Vec::new();
        for &solver in &arguments.solvers {
            if !solvers.contains(&solver) {
                solvers.push(solver);
            }
        }
        let mut options =
            SolverOptions { time_limit: Some(arguments.time_limit), ..SolverOptions::default() };
        if let Some(tolerance) = arguments.tolerance {
            options.tolerance = tolerance;
        }
        Ok(Self {
            title: "two membranes over the unit square".into(),
            solvers: if solvers.is_empty() { built() } else { solvers },
            options,
            arguments,
            rows,
            measured: 0,
            memory,
            notes: String::new(),
            node_tags: Vec::new(),
            progress,
            watch,
        })
    }

    /// The folder: rows measured in another way stay.
    fn claim(&self, case: &CaseId, meshes: &str) -> Result<Folder, Failure> {
        let names: Vec<&str> = self.solvers.iter().map(|solver| solver.as_str()).collect();
        let seconds = self.arguments.time_limit.seconds();
        let tolerance = self.options.tolerance;
        let measured = if self.arguments.no_run { "nothing" } else { meshes };
        let settings = format!("{measured}; {}; {seconds} s; tolerance {tolerance:e}", names.join(", "));
        let claim = Claim {
            case,
            part: Part::Bench,
            settings,
            overwrite: self.arguments.output.overwrite,
            says: "what was measured so far is in bench.csv",
        };
        let path = self.arguments.output.folder(self.arguments.case.as_deref().unwrap_or(FAMILY.as_ref()));
        Folder::claim(&path, &claim, self.watch)
    }

    fn comparison(&self) -> Comparison {
        let contestant = |&name: &SolverName| (name.as_str().into(), solver(name));
        Comparison::new(self.solvers.iter().map(contestant).collect(), self.options.clone())
    }

    fn run_nothing(&self) -> Result<Folder, Failure> {
        let folder = self.claim(&CaseId::built_in(FAMILY), "")?;
        write_rows(&folder, &self.rows)?;
        Ok(folder)
    }

    /// The built-in family on meshes of these numbers of cells along a side, from the coarsest.
    fn run_family(&mut self, sizes: &[usize]) -> Result<Folder, Failure> {
        let bad_input = |error: &dyn std::fmt::Display| Failure::Input(format!("--sizes: {error}"));
        let mut sizes = sizes.to_vec();
        sizes.sort_unstable();
        sizes.dedup();
        if let Some(n) = sizes.iter().find(|&&n| !((n as f64 + 1.0).powi(2) <= MAX_VERTICES)) {
            let n = grouped(*n);
            let message = format!("{n} x {n} cells have more than {MAX_VERTICES:.0e} vertices: choose fewer");
            return Err(bad_input(&message));
        }
        if let Some(&n) = sizes.last() {
            self.check_memory("--sizes", (n as f64 + 1.0).powi(2))?;
        }
        let problem = square_problem().map_err(|error| bad_input(&error))?;
        let folder = self.claim(&CaseId::built_in(FAMILY), &format!("cells {sizes:?}"))?;
        self.progress.steps(sizes.len() * self.solvers.len());
        let mut comparison = self.comparison();
        for n in sizes {
            let mesh = Arc::new(square_mesh(n).map_err(|error| bad_input(&error))?);
            self.measure(&mut comparison, &folder, SQUARE, n, &problem, &mesh)?;
        }
        Ok(folder)
    }

    /// A case on its mesh and its refinements.
    fn run_case(&mut self, path: PathBuf, bench: &BenchArguments) -> Result<Folder, Failure> {
        let levels = bench.levels;
        let memory_limit = bench.memory_limit;
        let arguments = CaseArguments { path, refine: 0, memory_limit, quiet: false };
        let setup = Setup::new(&arguments, self.progress)?;
        setup.require_pair()?;
        let Setup { name, id, case, mut family, notes, node_tags, .. } = setup;
        let finest = check_refinements(&name, family.mesh().points().len() as f64, levels - 1)?;
        self.check_memory(&name, finest)?;
        (self.notes, self.node_tags) = (notes, node_tags);
        self.title.clone_from(&case.title);
        self.options.tolerance = bench.tolerance.unwrap_or(case.solver.tolerance.or_default());
        let stem = arguments.path.file_stem().unwrap_or(arguments.path.as_os_str());
        let stem = stem.to_string_lossy();
        let folder = self.claim(&id, &format!("{levels} levels"))?;
        self.progress.steps(levels * self.solvers.len());
        let mut comparison = self.comparison();
        for level in 0..levels {
            if level > 0 {
                family.refine().map_err(|error| {
                    let vertices = gmsh_nodes(&error.vertices(), &self.node_tags);
                    Failure::Input(format!("{name}: [mesh]: {error}{vertices}"))
                })?;
            }
            self.measure(&mut comparison, &folder, &stem, level, &case.problem, family.mesh())?;
        }
        Ok(folder)
    }

    /// Refuses meshes of which the finest does not fit into memory, whatever the solver.
    fn check_memory(&self, name: &str, finest: f64) -> Result<(), Failure> {
        // Of all solvers, this one needs the least.
        self.memory.check(name, Work::solving(SolverName::Multigrid), finest)
    }

    /// Runs all solvers on one mesh, but for those that need more memory than there is. After each, all rows are in the file: a long run may be stopped.
    fn measure(
        &mut self,
        comparison: &mut Comparison,
        folder: &Folder,
        name: &str,
        n: usize,
        problem: &ContactProblem,
        mesh: &Arc<Mesh>,
    ) -> Result<(), Failure> {
        let vertices = grouped(mesh.points().len());
        self.progress.stage(format!("assembling on {vertices} vertices"));
        let d = PairDiscretization::new(problem, mesh.clone()).map_err(|error| {
            let vertices: Vec<usize> = error.vertex().into_iter().collect();
            Failure::Input(format!("{name}: {error}{}", gmsh_nodes(&vertices, &self.node_tags)))
        })?;
        let place = Place { problem: name, n, discretization: &d };
        for index in 0..self.solvers.len() {
            self.progress.stage(format!("{} on {vertices} vertices", self.solvers[index].as_str()));
            let row = if self.memory.suffices(Work::solving(self.solvers[index]), mesh.points().len() as f64)
            {
                comparison.row(index, &place)
            } else {
                comparison.left_out(index, &place, MEMORY)
            };
            // A new measurement takes the place of an old one.
            self.rows.retain(|old| !old.repeats(&row));
            self.rows.insert(self.measured, row);
            self.measured += 1;
            write_rows(folder, &self.rows)?;
            self.progress.step();
        }
        Ok(())
    }
}
