//! `membranes export`.

use crate::cli::args::{ExportArguments, Format};
use crate::cli::failure::Failure;
use crate::cli::run::files::{MTX, NPZ, Part, QPS};
use crate::cli::run::folder::{Claim, Folder};
use crate::cli::run::progress::Progress;
use crate::cli::run::setup::Setup;
use crate::cli::run::watch::Watch;
use crate::cli::terminal::print;
use crate::discretization::Discretization;
use crate::qp::{QpPart, qp_of, write_matrix_market, write_npz, write_qps, write_stack_npz};

pub(crate) fn run(arguments: &ExportArguments, watch: &Watch) -> Result<(), Failure> {
    let progress = Progress::new(arguments.case.quiet);
    let setup = Setup::new(&arguments.case, &progress)?;
    let (d, _) = setup.discretize(&progress)?;
    let qp = qp_of(&d);
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
        Format::Npz => folder.write(named(NPZ), |out| match &d {
            Discretization::Pair(d) => write_npz(d, &qp, out),
            Discretization::Stack(d) => write_stack_npz(d, &qp, out),
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
