//! `membranes export`.

use super::Failure;
use super::args::{ExportArguments, Format};
use super::progress::Progress;
use super::setup::{Setup, make_folder, unused_groups, write_file};
use super::terminal::print;
use super::watch::Watch;
use crate::qp::{QpPart, contact_qp, write_matrix_market, write_npz, write_qps};

pub(super) fn run(arguments: &ExportArguments, watch: &Watch) -> Result<(), Failure> {
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
        print(&(written.join("\n") + "\n" + &unused_groups(&setup.groups)))?;
    }
    Ok(())
}
