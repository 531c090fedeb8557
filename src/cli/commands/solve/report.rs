//! What a solve says of itself.

use std::path::Path;

use crate::cli::commands::solution::left_out_line;
use crate::cli::terminal::{fields, fixed, wrapped};
use crate::output::{ContactSummary, Summary};
use crate::solver::PolishReport;
use crate::text::grouped;

/// The summary for the eye.
pub(super) fn table(
    summary: &Summary,
    polish: Option<PolishReport>,
    unloaded: bool,
    folder: &Path,
    mut files: Vec<&str>,
) -> String {
    let number = |value: Option<f64>| value.map_or_else(String::new, |value| fixed(value, 8));
    let seconds = &summary.seconds;
    files.retain(|name| !summary.left_out.contains(name));
    let files = files.join(", ");
    let membranes = summary
        .membranes
        .map_or_else(String::new, |membranes| format!("{membranes}, {} unknowns", grouped(summary.unknowns)));
    let reactions: Vec<String> =
        summary.reactions.iter().flatten().map(|&reaction| fixed(reaction, 6)).collect();
    let rows = [
        ("mesh", mesh_line(summary)),
        ("membranes", membranes),
        ("solver", solver_line(summary)),
        ("chosen", summary.choice.clone().unwrap_or_default()),
        ("polish", polish.map_or_else(String::new, polish_line)),
        ("certified", certified_line(summary)),
        ("error", error_line(summary, unloaded)),
        ("guaranteed", guarantee(summary)),
        ("warning", summary.warnings.join("\n")),
        ("energy", number(summary.energy)),
        ("contact", contact_lines(summary)),
        ("total force", number(summary.total_force_extended)),
        ("supports", reactions.join(", ")),
        (
            "all forces",
            summary.force_imbalance.map_or_else(String::new, |left| format!("balanced up to {left:.1e}")),
        ),
        (
            "seconds",
            format!(
                "mesh {:.2}, assembly {:.2}, solve {:.2}, bound {:.2}, output {:.2}",
                seconds.mesh,
                seconds.assembly,
                seconds.setup + seconds.solve,
                seconds.bound,
                seconds.output
            ),
        ),
        ("left out", left_out_line(&summary.left_out)),
        ("files", format!("{}/{{{files}}}", folder.display())),
    ];
    format!("{}\n{}", wrapped(&summary.title, 2), fields(&rows))
}

/// Where the membranes touch, gap by gap.
fn contact_lines(summary: &Summary) -> String {
    let Some(contacts) = &summary.contacts else {
        return format!(
            "{} of {} interior vertices, area {}",
            grouped(summary.contact_vertices.unwrap_or(0)),
            grouped(summary.unknowns / 2),
            fixed(summary.contact_area_extended.unwrap_or(0.0), 6)
        );
    };
    let several = contacts.len() > 1;
    let of_gap = |contact: &ContactSummary| {
        let gap = if several { format!("gap {}: ", contact.gap) } else { String::new() };
        format!(
            "{gap}{} vertices, area {}, total force {}",
            grouped(contact.contact_vertices),
            fixed(contact.contact_area, 6),
            fixed(contact.total_force, 8)
        )
    };
    contacts.iter().map(of_gap).collect::<Vec<_>>().join("\n")
}

/// What the bound rests on.
fn guarantee(summary: &Summary) -> String {
    let text = match summary.error_bound {
        None => "",
        Some(_) if summary.warnings.is_empty() && summary.membranes.is_none() => {
            "up to the quadrature of the loads"
        }
        Some(_) if summary.warnings.is_empty() => {
            "up to the quadrature of the data, on the polygon of the mesh"
        }
        Some(_) if summary.membranes.is_none() => "if the loads are as the quadrature sees them",
        Some(_) => "if the data are as the mesh sees them",
    };
    text.into()
}

/// Where nothing is loaded, membranes at rest have no energy to compare the bound with.
fn error_line(summary: &Summary, unloaded: bool) -> String {
    let Some(bound) = summary.error_bound else {
        let reason = summary.no_error_bound.as_deref();
        return reason.map_or_else(String::new, |reason| format!("no bound: {reason}"));
    };
    let relative = match summary.relative_error_bound {
        Some(relative) => format!("{:.2} %", 100.0 * relative),
        None if unloaded => "no load: rounding".into(),
        None => "no relative bound: refine".into(),
    };
    format!("at most {bound:.3e} in the energy norm ({relative})")
}

/// What the mesh is.
fn mesh_line(summary: &Summary) -> String {
    format!(
        "{} vertices, {} triangles, least angle {:.1} degrees",
        grouped(summary.vertices),
        grouped(summary.triangles),
        summary.min_angle
    )
}

/// That it is certified, and how well.
fn certified_line(summary: &Summary) -> String {
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
fn solver_line(summary: &Summary) -> String {
    let Summary { backend, status, iterations, level_iterations, .. } = summary;
    let levels = level_iterations.len();
    let on_levels = if levels > 1 { format!(" on the finest of {levels} levels") } else { String::new() };
    let plural = if *iterations == 1 { "" } else { "s" };
    format!("{backend}: {status} in {} iteration{plural}{on_levels}", grouped(*iterations))
}

/// What the polish has done.
fn polish_line(polish: PolishReport) -> String {
    let PolishReport { kept, repairs, residual_before, residual_after, .. } = polish;
    let verdict = if kept { "kept" } else { "not kept" };
    let repairs = if repairs == 1 { "1 contact repair".into() } else { format!("{repairs} contact repairs") };
    format!("{verdict}, {repairs}, residual {residual_before:.1e} -> {residual_after:.1e}")
}
