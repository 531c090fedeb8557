//! How far displacements and multipliers of a stack are from solving its discrete problem.

use super::forces::forces;
use crate::action::recovery::ROUNDINGS;
use crate::action::residuals::{Residual, Residuals, hat_integrals};
use crate::discretization::StackDiscretization;
use crate::parallel::BLOCK;
use crate::parallel::prelude::*;

/// Recomputes all checks, from `K_i`, `F_i`, heights and obstacles.
pub(super) fn residuals(d: &StackDiscretization, u: &[Vec<f64>], multiplier: &[f64]) -> Residuals {
    let (force, length) = (d.scales().force_density, d.scales().displacement);
    let area = d.dual_area();
    let of_force = |a: usize, defect: f64, rounding: f64| {
        Residual::new(defect / (area[a] * force), rounding / (area[a] * force))
    };
    let of_length = |defect: f64| Residual::new(defect / length, 0.0);
    let mut all = Residuals::default();
    let mut add = |residuals: Residuals| all = all.larger(residuals);

    let y = |gap: usize, a: usize| d.row(gap, a).map_or(0.0, |row| multiplier[row]);
    for i in 1..=d.membranes() {
        let u = &u[i - 1];
        let at = |&a: &usize| {
            let [imbalance, terms] = d.imbalance(i, a, u);
            let defect = (imbalance - (y(i, a) - y(i - 1, a))).abs();
            of_force(a, defect, ROUNDINGS * f64::EPSILON * terms)
        };
        let of_block = |block: &[usize]| block.iter().map(at).fold(Residual::default(), Residual::larger);
        let blocks: Vec<Residual> = d.free_vertices(i).par_chunks(BLOCK).map(of_block).collect();
        let stationarity = blocks.into_iter().fold(Residual::default(), Residual::larger);
        add(Residuals { stationarity, ..Residuals::default() });
        for a in (0..area.len()).filter(|&a| d.unknown(i, a).is_none()) {
            let primal = of_length((u[a] - d.height(i, a).unwrap_or(0.0)).abs());
            add(Residuals { primal, ..Residuals::default() });
        }
    }

    // All that a multiplier ties together belongs to one chain, also where an answer leaves a gap.
    let gaps: Vec<f64> = d.rows().iter().map(|row| d.gap(u, row)).collect();
    let tied: Vec<bool> = gaps.iter().zip(multiplier).map(|(&gap, &y)| gap <= 0.0 || y != 0.0).collect();
    let forces = forces(d, u, &tied, Some(multiplier));
    let integrals = hat_integrals(d.mesh());
    let [mut work, mut work_rounding, mut work_area] = [0.0; 3];
    for (k, row) in d.rows().iter().enumerate() {
        let (a, action, rounding) = (row.vertex, forces.action[k], forces.rounding[k]);
        let relative_gap = (gaps[k] / length).abs();
        let dual_mismatch = (multiplier[k] / area[a] - action / integrals[a]).abs() * area[a];
        add(Residuals {
            primal: of_length(-gaps[k]),
            dual_sign: of_force(a, -multiplier[k], 0.0).larger(of_force(a, -action, rounding)),
            complementarity: of_force(a, action.abs() * relative_gap, rounding * relative_gap)
                .larger(of_force(a, multiplier[k].abs() * relative_gap, rounding * relative_gap)),
            dual_mismatch: of_force(a, dual_mismatch, rounding),
            overlap: Residual::new((action / (area[a] * force)).min(gaps[k] / length), 0.0).value,
            ..Residuals::default()
        });
        work += action * gaps[k];
        work_rounding += rounding * gaps[k].abs();
        work_area += area[a];
    }
    for &(a, left, rounding) in &forces.balance {
        let action_mismatch = of_force(a, left.abs(), rounding);
        add(Residuals { action_mismatch, ..Residuals::default() });
    }
    if work_area > 0.0 {
        let unit = force * length * work_area;
        let variational_inequality =
            Residual::new(work.abs() / unit, work_rounding / unit).larger(Residual::default());
        add(Residuals { variational_inequality, ..Residuals::default() });
    }
    all
}
