//! `membranes export`.

use crate::cli::args::{ExportArguments, Format};
use crate::cli::failure::Failure;
use crate::cli::run::files::{MTX, NPZ, Part, QPS};
use crate::cli::run::folder::{Claim, Folder};
use crate::cli::run::progress::Progress;
use crate::cli::run::setup::Setup;
use crate::cli::run::watch::Watch;
use crate::cli::terminal::print;
use crate::discretization::{Discretization, StackDiscretization};
use crate::qp::{
    QpPart, QpProblem, contact_qp, stack_qp, write_matrix_market, write_npz, write_qps, write_stack_npz,
};

pub(crate) fn run(arguments: &ExportArguments, watch: &Watch) -> Result<(), Failure> {
    let progress = Progress::new(arguments.case.quiet);
    let setup = Setup::new(&arguments.case, &progress)?;
    let problem = Posed::new(&setup, &progress)?;
    let qp = problem.qp();
    let claim = Claim {
        case: &setup.id,
        part: Part::Export,
        settings: format!("the mesh refined {} times", setup.refinements()),
        overwrite: arguments.output.overwrite,
        says: "files that are there are whole",
    };
    let folder = Folder::claim(&arguments.output.folder(&arguments.case.path), &claim, watch)?;
    progress.stage("writing the quadratic program");
    let mut written = Vec::new();
    let mut named = |name: &'static str| {
        written.push(folder.path().join(name).display().to_string());
        name
    };
    match arguments.format {
        Format::Qps => folder.write(named(QPS), |out| write_qps(&qp, out))?,
        Format::Npz => folder.write(named(NPZ), |out| match &problem {
            Posed::Pair(d) => write_npz(d, &qp, out),
            Posed::Stack(d) => write_stack_npz(d, &qp, out),
        })?,
        Format::Mtx => {
            for (part, name) in QpPart::ALL.into_iter().zip(MTX) {
                folder.write(named(name), |out| write_matrix_market(&qp, part, out))?;
            }
        }
    }
    drop(progress);
    if !arguments.case.quiet {
        print(&(written.join("\n") + "\n" + &setup.notes))?;
    }
    Ok(())
}

/// The paper's pair, or another stack, on its mesh.
enum Posed {
    Pair(Box<Discretization>),
    Stack(Box<StackDiscretization>),
}

impl Posed {
    fn new(setup: &Setup, progress: &Progress) -> Result<Self, Failure> {
        Ok(match setup.case.pair() {
            Some(_) => Self::Pair(Box::new(setup.discretize(progress)?.0)),
            None => Self::Stack(Box::new(setup.discretize_stack(progress)?.0)),
        })
    }

    fn qp(&self) -> QpProblem {
        match self {
            Self::Pair(d) => contact_qp(d),
            Self::Stack(d) => stack_qp(d),
        }
    }
}
