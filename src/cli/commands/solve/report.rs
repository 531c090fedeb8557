//! What a solve says of itself, of a pair and of any other stack.

use crate::output::Summary;
use crate::solver::PolishReport;
use crate::text::grouped;

/// What the mesh is.
pub(super) fn mesh_line(summary: &Summary) -> String {
    format!(
        "{} vertices, {} triangles, least angle {:.1} degrees",
        grouped(summary.vertices),
        grouped(summary.triangles),
        summary.min_angle
    )
}

/// That it is certified, and how well.
pub(super) fn certified_line(summary: &Summary) -> String {
    let worst = worst(summary);
    format!("largest residual {worst:.1e}{} (tolerance {:.0e})", beyond(summary, worst), summary.tolerance)
}

/// The largest residual of the certificate.
fn worst(summary: &Summary) -> f64 {
    summary.residuals.as_ref().map_or(f64::NAN, |r| {
        [r.stationarity, r.primal, r.dual_sign, r.complementarity, r.action_mismatch, r.dual_mismatch]
            .into_iter()
            .fold(r.variational_inequality, f64::max)
    })
}

/// What of a residual that is larger than the tolerance is more than rounding.
fn beyond(summary: &Summary, worst: f64) -> String {
    match summary.residual_beyond_rounding {
        Some(beyond) if worst > summary.tolerance => format!(", {beyond:.1e} beyond rounding"),
        _ => String::new(),
    }
}

/// Who has solved it, and in how many steps.
pub(super) fn solver_line(summary: &Summary) -> String {
    let Summary { backend, status, iterations, level_iterations, .. } = summary;
    let levels = level_iterations.len();
    let on_levels = if levels > 1 { format!(" on the finest of {levels} levels") } else { String::new() };
    let plural = if *iterations == 1 { "" } else { "s" };
    format!("{backend}: {status} in {} iteration{plural}{on_levels}", grouped(*iterations))
}

/// What the polish has done.
pub(super) fn polish_line(polish: PolishReport) -> String {
    let PolishReport { kept, repairs, residual_before, residual_after, .. } = polish;
    let verdict = if kept { "kept" } else { "not kept" };
    let repairs = if repairs == 1 { "1 contact repair".into() } else { format!("{repairs} contact repairs") };
    format!("{verdict}, {repairs}, residual {residual_before:.1e} -> {residual_after:.1e}")
}
