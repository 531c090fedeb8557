//! `membranes check`: every residual, all solvers, side by side, or of an answer from elsewhere.

use super::answer::{self, Verdict};
use crate::action::{ContactSolution, PairSolution, Rejected, Residuals, certify};
use crate::cli::args::CheckArguments;
use crate::cli::case::{SolverName, SolverSettings};
use crate::cli::failure::Failure;
use crate::cli::run::progress::Progress;
use crate::cli::run::setup::{Setup, options, solver};
use crate::cli::run::watch::Watch;
use crate::cli::terminal::{fixed, print, wrapped};
use crate::discretization::{Discretization, PairDiscretization};
use crate::fem::element_loads;
use crate::flux::{FluxDefects, Reconstruction, Reconstructor};
use crate::mesh::SubTriangulation;
use crate::problem::ContactProblem;
use crate::study::Tolerance;
use crate::text::grouped;

/// The second line above a result that nobody has polished.
const AS_IT_IS: &str = "as it is";

/// One solver's result.
struct Column {
    heading: [String; 2],
    /// The answer as the solver left it is shown for comparison only.
    must_certify: bool,
    result: Result<ContactSolution, Box<Rejected>>,
}

pub(crate) fn run(arguments: &CheckArguments, watch: &Watch) -> Result<(), Failure> {
    let progress = Progress::new(arguments.case.quiet);
    let mut setup = Setup::new(&arguments.case, &progress)?;
    if let Some(tolerance) = arguments.tolerance {
        setup.case.solver.tolerance = Tolerance::Fixed(tolerance);
    }
    if arguments.answer.is_none() {
        for name in solvers() {
            setup.check_memory(setup.solving(name))?;
        }
    }
    let (d, seconds) = setup.discretize(&progress)?;
    let (columns, remedy) = match &arguments.answer {
        None => (columns_of_solvers(&setup, &d, &progress)?, ""),
        Some(file) => {
            progress.stage("judging the answer");
            column_of_answer(answer::judge(&setup, &d, file, arguments, seconds, watch)?)
        }
    };
    let certified = columns.iter().find_map(|column| column.result.as_ref().ok());
    let of_pair = d.as_pair().zip(certified.and_then(ContactSolution::as_pair));
    let fluxes = match of_pair {
        Some((d, solution)) if !arguments.case.quiet => flux_lines(&setup.case.problem, d, solution)
            .map_err(|error| Failure::Input(format!("{}: {error}", setup.name)))?,
        _ => String::new(),
    };
    drop(progress);
    report(&setup, arguments, d.unknowns(), &columns, &fluxes, remedy)
}

fn column_of_answer(Verdict { result, remedy }: Verdict) -> (Vec<Column>, &'static str) {
    let heading = [answer::NAME.into(), AS_IT_IS.into()];
    (vec![Column { heading, must_certify: true, result }], remedy)
}

/// Prints the table; an error when a result that has to certify does not.
fn report(
    setup: &Setup,
    arguments: &CheckArguments,
    unknowns: usize,
    columns: &[Column],
    fluxes: &str,
    remedy: &str,
) -> Result<(), Failure> {
    if !arguments.case.quiet {
        let title = format!(
            "{}: {} unknowns, tolerance {:.0e}",
            setup.case.title,
            grouped(unknowns),
            setup.case.solver.tolerance.or_default()
        );
        print(&(wrapped(&title, 2) + "\n" + &table(columns) + fluxes + &setup.notes))?;
    }
    match columns.iter().filter(|column| column.must_certify).find_map(|column| column.result.as_ref().err())
    {
        None => Ok(()),
        Some(rejected) => Err(Failure::NotCertified(format!("{}: {rejected}{remedy}", setup.name))),
    }
}

/// All of this build; the choice among them is one of them.
fn solvers() -> impl Iterator<Item = SolverName> {
    SolverName::ALL.into_iter().filter(|solver| solver.is_built() && *solver != SolverName::Auto)
}

fn columns_of_solvers(
    setup: &Setup,
    d: &Discretization,
    progress: &Progress,
) -> Result<Vec<Column>, Failure> {
    let mut columns = Vec::new();
    for name in solvers() {
        let ways = if name.is_polished() { [true, false].as_slice() } else { &[true] };
        for &polish in ways {
            let settings = SolverSettings { name, polish, ..setup.case.solver.clone() };
            columns.push(column(&setup.name, d, &settings, progress)?);
        }
    }
    Ok(columns)
}

fn column(
    case: &str,
    d: &Discretization,
    settings: &SolverSettings,
    progress: &Progress,
) -> Result<Column, Failure> {
    let name = settings.name;
    let way = match (name.is_polished(), settings.polish) {
        (false, _) => "",
        (true, true) => "polished",
        (true, false) => AS_IT_IS,
    };
    progress.stage(format!("{} {way}", name.as_str()));
    let candidate = solver(name)
        .solve(d, &options(settings))
        .map_err(|error| Failure::NotCertified(format!("{case}: {error}")))?;
    let result = certify(d, candidate, settings.tolerance.or_default());
    Ok(Column { heading: heading(name, way), must_certify: settings.polish, result })
}

/// Two lines that fit into a column: the names of the others are too long to have a way beside them.
fn heading(name: SolverName, way: &str) -> [String; 2] {
    match name.as_str().split_once('-') {
        Some((first, second)) => [format!("{first}-"), second.into()],
        None => [name.as_str().into(), way.into()],
    }
}

/// The identities of the reconstructed fluxes `t_ih` of both membranes, for each choice: relative defects.
fn flux_lines(
    problem: &ContactProblem,
    d: &PairDiscretization,
    solution: &PairSolution,
) -> Result<String, Box<dyn std::error::Error>> {
    let sub = SubTriangulation::new(d.mesh())?;
    let [f1, f2] = problem.as_pair().expect("a discretization of the pair belongs to one").load();
    let loads = [element_loads(d.mesh(), f1)?, element_loads(d.mesh(), f2)?];
    let reconstructor = Reconstructor::new(d, &sub, loads);
    let mut text = format!("\n  {:22}", "fluxes t_ih");
    for (name, _) in FluxDefects::default().named() {
        text += &format!(" {name:>11}");
    }
    text.push('\n');
    for kind in Reconstruction::ALL {
        let flux = reconstructor.reconstruct(solution.displacement(), kind);
        let defects =
            FluxDefects::new(&reconstructor, solution.displacement(), solution.lambda(), &flux, kind);
        text += &format!("  {:22}", kind.name());
        for (_, defect) in defects.named() {
            text += &format!(" {defect:>11.1e}");
        }
        text.push('\n');
    }
    Ok(text)
}

/// A name that fits before six columns.
fn shortened(name: &str) -> &str {
    if name == "variational_inequality" { "variational_ineq." } else { name }
}

/// A row for each residual, a column for each result.
fn table(columns: &[Column]) -> String {
    let residuals: Vec<Option<&Residuals>> = columns
        .iter()
        .map(|column| match &column.result {
            Ok(solution) => Some(solution.residuals()),
            Err(rejected) => rejected.residuals.as_ref(),
        })
        .collect();
    let row = |name: &str, cell: &dyn Fn(usize) -> String| {
        let cells: String = (0..columns.len()).map(|k| format!(" {:>9}", cell(k))).collect();
        format!("  {:17}{cells}\n", shortened(name))
    };
    let heading = |line: usize| row("", &|k| columns[k].heading[line].clone());
    let solved = |k: usize, value: &dyn Fn(&ContactSolution) -> String| {
        columns[k].result.as_ref().map_or_else(|_| "-".into(), value)
    };
    let mut text = heading(0) + &heading(1);
    for (index, (name, _)) in Residuals::default().named().into_iter().enumerate() {
        text +=
            &row(name, &|k| residuals[k].map_or("-".into(), |r| format!("{:.1e}", r.named()[index].1.value)));
    }
    text += &row("(overlap)", &|k| residuals[k].map_or("-".into(), |r| format!("{:.1e}", r.overlap)));
    text += &row("certified", &|k| if columns[k].result.is_ok() { "yes".into() } else { "no".into() });
    text += &row("energy", &|k| solved(k, &|s| fixed(s.energy(), 6)));
    text += &row("contact vertices", &|k| solved(k, &|s| grouped(contact_vertices(s))));
    text + &row("total force", &|k| solved(k, &|s| fixed(s.total_force(), 6)))
}

/// In all gaps.
fn contact_vertices(solution: &ContactSolution) -> usize {
    solution.gaps().iter().map(|gap| gap.contact.iter().filter(|&&contact| contact).count()).sum()
}
