//! `membranes export`.

use crate::cli::args::{ExportArguments, Format};
use crate::cli::failure::Failure;
use crate::cli::run::progress::Progress;
use crate::cli::run::setup::{Setup, make_folder, write_file};
use crate::cli::run::watch::Watch;
use crate::cli::terminal::print;
use crate::qp::{QpPart, contact_qp, write_matrix_market, write_npz, write_qps};

pub(crate) fn run(arguments: &ExportArguments, watch: &Watch) -> Result<(), Failure> {
    let progress = Progress::new(arguments.case.quiet);
    let setup = Setup::new(&arguments.case, &progress)?;
    let (d, _) = setup.discretize(&progress)?;
    let qp = contact_qp(&d);
    let folder = arguments.case.output_folder(arguments.out.as_ref());
    make_folder(&folder, watch, "files that are there are whole")?;
    progress.stage("writing the quadratic program");
    let mut written = Vec::new();
    let mut path = |name: String| {
        let path = folder.join(name);
        written.push(path.display().to_string());
        path
    };
    match arguments.format {
        Format::Qps => write_file(&path("problem.qps".into()), |out| write_qps(&qp, out))?,
        Format::Npz => write_file(&path("problem.npz".into()), |out| write_npz(&d, &qp, out))?,
        Format::Mtx => {
            for part in QpPart::ALL {
                let name = format!("problem_{}.mtx", part.letter());
                write_file(&path(name), |out| write_matrix_market(&qp, part, out))?;
            }
        }
    }
    drop(progress);
    if !arguments.case.quiet {
        print(&(written.join("\n") + "\n"))?;
    }
    Ok(())
}
