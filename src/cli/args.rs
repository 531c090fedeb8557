//! The command line.

use std::path::{Path, PathBuf};

use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, CommandFactory, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;

use super::case::SolverName;
use crate::qp::TimeLimit;
use crate::study::Tolerance;
use crate::text::grouped;

/// Where results go when no folder is named: a folder of this one, called like the case file.
const OUTPUT: &str = "out";

/// What `--backend` may be in this build.
const SOLVERS: &str = match (cfg!(feature = "clarabel"), cfg!(feature = "osqp")) {
    (true, true) => "Solver: auto, multigrid, active-set, clarabel, osqp",
    (true, false) => "Solver: auto, multigrid, active-set, clarabel",
    (false, true) => "Solver: auto, multigrid, active-set, osqp",
    (false, false) => "Solver: auto, multigrid, active-set",
};

#[derive(Debug, Parser)]
#[command(
    name = "membranes",
    version,
    about = "Unilateral contact between two elastic membranes, by certified finite elements",
    arg_required_else_help = false,
    after_help = "\
A first run:
  membranes cases strip > strip.toml     a complete case file, with its formulas
  membranes solve strip.toml             writes three files into out/strip

Open solution.vtu in ParaView (or meshio, PyVista), membranes.png anywhere.
Exit codes: 0 certified; 1 ran, but not certified; 2 bad input or usage."
)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Solve a case: solution.vtu, rim.vtp, summary.json, membranes.png
    Solve(SolveArguments),
    /// Show all residuals, of every solver or of a given answer
    Check(CheckArguments),
    /// Measure errors and rates on finer meshes, for a built-in case
    Converge(ConvergeArguments),
    /// Refine where the error is, until its bound is small enough
    Adapt(AdaptArguments),
    /// Time the solvers side by side, on a built-in family or a case
    Bench(BenchArguments),
    /// Write the quadratic program of a case for other solvers
    Export(ExportArguments),
    /// List the built-in exact cases, or print one as a case file
    Cases(CasesArguments),
    /// Print completions for a shell
    Completions(CompletionsArguments),
    /// Print the manual page, or write those of all commands
    Man(ManArguments),
}

#[derive(Debug, Args)]
#[command(after_help = "\
The time limit covers reading, meshing, assembly, solving and pictures. What is
certified by then is written: pictures that would take longer are left out.
time_limit in the case file is that of the solver alone.")]
pub(crate) struct SolveArguments {
    #[command(flatten)]
    pub(crate) case: CaseArguments,
    #[arg(long, value_name = "NAME", help = SOLVERS)]
    pub(crate) backend: Option<SolverName>,
    #[command(flatten)]
    pub(crate) output: OutputArguments,
    #[command(flatten)]
    pub(crate) pictures: PictureArguments,
    /// Time limit of this run in seconds, see below
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) time_limit: Option<TimeLimit>,
    /// Largest relative residual, or auto
    #[arg(long, value_name = "T", value_parser = tolerance_or_auto, allow_negative_numbers = true)]
    pub(crate) tolerance: Option<Tolerance>,
    /// Do not polish the answer of a backend
    #[arg(long)]
    pub(crate) no_polish: bool,
    /// Also write dual.vtu, flux.vtu, mesh.png
    #[arg(long)]
    pub(crate) dual: bool,
}

#[derive(Debug, Args)]
pub(crate) struct CheckArguments {
    #[command(flatten)]
    pub(crate) case: CaseArguments,
    /// Judge this answer (x, y) to the exported QP instead
    #[arg(long, value_name = "FILE")]
    pub(crate) answer: Option<PathBuf>,
    /// Folder for the summary.json of the answer
    #[arg(long, value_name = "DIR", requires = "answer")]
    pub(crate) out: Option<PathBuf>,
    /// Replace results of another case
    #[arg(long, requires = "out")]
    pub(crate) overwrite: bool,
    /// Largest relative residual [default: the case file's]
    #[arg(long, value_name = "T", value_parser = tolerance, allow_negative_numbers = true)]
    pub(crate) tolerance: Option<f64>,
}

#[derive(Debug, Args)]
pub(crate) struct ConvergeArguments {
    #[command(flatten)]
    pub(crate) case: CaseArguments,
    /// Number of meshes, from coarse to fine
    #[arg(long, value_name = "N", default_value = "5", value_parser = at_least(1), allow_negative_numbers = true)]
    pub(crate) levels: usize,
    /// Time limit of this run in seconds
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) time_limit: Option<TimeLimit>,
    #[arg(long, value_name = "NAME", help = SOLVERS)]
    pub(crate) backend: Option<SolverName>,
    #[command(flatten)]
    pub(crate) output: OutputArguments,
    #[command(flatten)]
    pub(crate) pictures: PictureArguments,
}

#[derive(Debug, Args)]
#[command(after_help = "\
The bound of the error in the energy norm is guaranteed up to the quadrature of
the loads. --tolerance is relative to the energy norm of the exact solution; how
accurately each level is solved, the case file says.
The same command goes on where a run has stopped.")]
pub(crate) struct AdaptArguments {
    #[command(flatten)]
    pub(crate) case: CaseArguments,
    /// Relative error bound to reach
    #[arg(long, value_name = "T", default_value = "0.01", value_parser = tolerance, allow_negative_numbers = true)]
    pub(crate) tolerance: f64,
    /// Largest number of vertices
    #[arg(long, value_name = "N", default_value = "1,000,000", value_parser = at_least(3))]
    pub(crate) max_vertices: usize,
    /// Time limit of this run in seconds
    #[arg(long, value_name = "S", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) time_limit: Option<TimeLimit>,
    #[arg(long, value_name = "NAME", help = SOLVERS)]
    pub(crate) backend: Option<SolverName>,
    #[command(flatten)]
    pub(crate) output: OutputArguments,
    #[command(flatten)]
    pub(crate) pictures: PictureArguments,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Without a case file, results go into out/bench. Where a solver needs more memory
than there is, its row says memory_limit in place of a time.")]
pub(crate) struct BenchArguments {
    /// A case, refined level by level [default: a family on the square]
    #[arg(value_name = "CASE.toml", conflicts_with = "sizes")]
    pub(crate) case: Option<PathBuf>,
    /// Meshes of N x N cells
    #[arg(long, value_name = "N,...", value_delimiter = ',', default_value = "64,128,256", value_parser = at_least(2))]
    pub(crate) sizes: Vec<usize>,
    /// Number of meshes, from coarse to fine
    #[arg(long, value_name = "N", default_value = "4", value_parser = at_least(1), requires = "case")]
    pub(crate) levels: usize,
    /// Solvers to compare [default: all of this build]
    #[arg(long, value_name = "NAME,...", value_delimiter = ',')]
    pub(crate) solvers: Vec<SolverName>,
    /// Time limit of each solve in seconds
    #[arg(long, value_name = "S", default_value = "60", value_parser = seconds, allow_negative_numbers = true)]
    pub(crate) time_limit: TimeLimit,
    /// Largest relative residual [default: the case file's]
    #[arg(long, value_name = "T", value_parser = tolerance, allow_negative_numbers = true)]
    pub(crate) tolerance: Option<f64>,
    /// Also show the rows of this bench.csv; repeatable
    #[arg(long, value_name = "FILE.csv")]
    pub(crate) merge: Vec<PathBuf>,
    /// Measure nothing, show the rows of --merge
    #[arg(long, requires = "merge")]
    pub(crate) no_run: bool,
    /// Memory limit in GiB [default: all that is free]
    #[arg(long, value_name = "GIB", value_parser = positive, allow_negative_numbers = true)]
    pub(crate) memory_limit: Option<f64>,
    #[command(flatten)]
    pub(crate) output: OutputArguments,
    #[command(flatten)]
    pub(crate) pictures: PictureArguments,
    /// Print nothing but errors
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

#[derive(Debug, Args)]
pub(crate) struct ExportArguments {
    #[command(flatten)]
    pub(crate) case: CaseArguments,
    /// File format
    #[arg(long, value_enum)]
    pub(crate) format: Format,
    #[command(flatten)]
    pub(crate) output: OutputArguments,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// problem.qps, for Gurobi, CPLEX (for HiGHS, rename it to .mps)
    Qps,
    /// problem.npz, for numpy and scipy
    Npz,
    /// MatrixMarket: problem_P.mtx, and likewise for A, q and b
    Mtx,
}

#[derive(Debug, Args)]
pub(crate) struct CasesArguments {
    /// Print this case as a complete case file
    #[arg(value_name = "NAME")]
    pub(crate) name: Option<String>,
}

#[derive(Debug, Args)]
pub(crate) struct OutputArguments {
    /// Folder for the results [default: out/CASE]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Replace results of another case or other settings
    #[arg(long)]
    pub(crate) overwrite: bool,
}

#[derive(Debug, Args)]
pub(crate) struct PictureArguments {
    /// Write no pictures
    #[arg(long)]
    pub(crate) no_picture: bool,
    /// Picture formats: png, svg, pdf
    #[arg(
        long = "pictures",
        value_name = "F,...",
        value_delimiter = ',',
        default_value = "png",
        value_parser = picture_format(),
        hide_possible_values = true,
        conflicts_with = "no_picture"
    )]
    pub(crate) picture_format: Vec<crate::pictures::Format>,
}

impl OutputArguments {
    /// The folder: the one named, else `out/` and the name of `case` without its ending.
    pub(crate) fn folder(&self, case: &Path) -> PathBuf {
        let stem = case.file_stem().unwrap_or(case.as_os_str());
        self.out.clone().unwrap_or_else(|| PathBuf::from(OUTPUT).join(stem))
    }
}

#[derive(Debug, Args)]
#[command(after_help = "\
For bash, in ~/.bashrc:  source <(membranes completions bash)
For zsh, in a folder of $fpath:  membranes completions zsh > _membranes
For fish, in its configuration:  membranes completions fish | source")]
pub(crate) struct CompletionsArguments {
    /// The shell
    #[arg(value_enum)]
    pub(crate) shell: Shell,
}

#[derive(Debug, Args)]
pub(crate) struct ManArguments {
    /// Write membranes.1, membranes-solve.1, ... into this folder
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct CaseArguments {
    /// The case file (TOML)
    #[arg(value_name = "CASE.toml")]
    pub(crate) path: PathBuf,
    /// Further uniform refinements of the mesh
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = refinements, allow_negative_numbers = true)]
    pub(crate) refine: u32,
    /// Memory limit in GiB [default: all that is free]
    #[arg(long, value_name = "GIB", value_parser = positive, allow_negative_numbers = true)]
    pub(crate) memory_limit: Option<f64>,
    /// Print nothing but errors
    #[arg(long, short)]
    pub(crate) quiet: bool,
}

/// The formats of pictures by their names, which completions know.
fn picture_format() -> impl TypedValueParser<Value = crate::pictures::Format> {
    use crate::pictures::Format;
    PossibleValuesParser::new(["png", "svg", "pdf"]).map(|name| match name.as_str() {
        "svg" => Format::Svg,
        "pdf" => Format::Pdf,
        _ => Format::Png,
    })
}

fn tolerance_or_auto(text: &str) -> Result<Tolerance, String> {
    match text {
        "auto" => Ok(Tolerance::Auto),
        _ => tolerance(text).map(Tolerance::Fixed).map_err(|error| error + ", or auto"),
    }
}

fn tolerance(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|&value| value > 0.0 && value < 1.0);
    value.ok_or("choose a number between 0 and 1".into())
}

fn refinements(text: &str) -> Result<u32, String> {
    text.parse().map_err(|_| "choose a whole number, at least 0".into())
}

fn at_least(least: usize) -> impl Fn(&str) -> Result<usize, String> + Clone + Send + Sync + 'static {
    move |text| {
        let value = count(text.trim()).filter(|&value| value >= least);
        value.ok_or_else(|| format!("choose a whole number, at least {least}"))
    }
}

/// A whole number, also in groups of three digits as the program prints it.
fn count(text: &str) -> Option<usize> {
    let in_groups = || text.replace(',', "").parse().ok().filter(|&value| grouped(value) == text);
    text.parse().ok().or_else(in_groups)
}

fn seconds(text: &str) -> Result<TimeLimit, String> {
    let seconds: f64 = text.parse().map_err(|_| "choose seconds above 0, such as 60")?;
    TimeLimit::from_seconds(seconds).map_err(|error| error.to_string())
}

fn positive(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|&value: &f64| value > 0.0 && value.is_finite());
    value.ok_or_else(|| "choose a number above 0".into())
}

/// What clap has to say, without its paragraphs on usage and on arguments that begin with a hyphen.
/// `command` is the first argument, which may be a command: then its help says more.
pub(crate) fn one_line(error: &clap::Error, command: Option<&str>) -> String {
    let text = error.to_string();
    let of_use = |paragraph: &&str| {
        let asides = ["Usage:", "For more information", "tip: to pass"];
        !asides.into_iter().any(|aside| paragraph.trim_start().starts_with(aside))
    };
    let words = |paragraph: &str| paragraph.split_whitespace().collect::<Vec<_>>().join(" ");
    let message = text.split("\n\n").filter(of_use).map(words).collect::<Vec<_>>().join("; ");
    let message = message.strip_prefix("error: ").unwrap_or(&message);
    let known = |name: &&str| Arguments::command().find_subcommand(name).is_some();
    let command = command.filter(known).map_or_else(String::new, |name| format!("{name} "));
    format!("{message}; see `membranes {command}--help`")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_read_as_they_are_printed() {
        assert_eq!(
            ["0", "1000000", "1,000,000", "12,345"].map(count),
            [0, 1_000_000, 1_000_000, 12_345].map(Some)
        );
        assert_eq!(["1,5", "1,0000", ",100", "1,000,", "-1", "1.5", "", ","].map(count), [None; 8]);
        assert_eq!(at_least(3)("1,000"), Ok(1000));
        assert_eq!(at_least(3)("2"), Err("choose a whole number, at least 3".into()));
    }
}
