//! Nested iteration: the contact set of a level, found from that of the next coarser one.

use sprs::CsMat;

use super::obstacle::Obstacle;
use crate::discretization::PairDiscretization;
use crate::multigrid::cholesky::NotFactored;
use crate::multigrid::hierarchy::{Hierarchy, Level};
use crate::qp::Limits;
use crate::solver::pair::decoupled::Decoupled;

/// Projected Gauss-Seidel sweeps over a gap that comes from the next coarser level. They save a factorisation or two on each level
/// where membranes part with a jump of the action.
const SWEEPS: usize = 8;

/// A guess of the contact set over the unknowns, and the factorisations on each of the coarser levels.
///
/// Slight gaps below zero are overlooked there: the next level decides on them anew.
pub(super) fn guess_from_coarser_levels(
    d: &PairDiscretization,
    limits: &Limits,
) -> Result<(Vec<bool>, Vec<usize>), NotFactored> {
    let hierarchy = Hierarchy::new(d);
    let decoupled = Decoupled::new(d);
    let load = hierarchy.to_rows(|a| decoupled.gap_load(a));
    let (loads, heights) = hierarchy.lifted(load, hierarchy.to_rows(|a| d.height()[a]));
    let mut factorizations = Vec::new();
    let mut touches = vec![false; hierarchy.levels()[1].pattern.rows()];
    for l in 1..hierarchy.finest() {
        let (level, finer) = (&hierarchy.levels()[l], &hierarchy.levels()[l + 1]);
        let (k, rows) = free_part(level);
        let b: Vec<f64> = rows.iter().map(|&i| loads[l][i]).collect();
        let active = rows.iter().map(|&i| touches[i]).collect();
        let mut half = Obstacle::new(k, b.clone(), b, d.scales().displacement)?;
        let (gap, _, repairs) = half.settle_roughly(active, limits)?;
        factorizations.push(repairs + 1);
        let mut w = heights[l].clone();
        let mut on_level = vec![false; w.len()];
        for (k, &i) in rows.iter().enumerate() {
            w[i] = gap.w[k].max(0.0);
            on_level[i] = gap.y[k] > 0.0;
        }
        touches = touching(finer, &w, &on_level, &loads[l + 1]);
    }
    let mut over_vertices = vec![false; hierarchy.vertex().len()];
    for (&a, &touches) in hierarchy.vertex().iter().zip(&touches) {
        over_vertices[a as usize] = touches;
    }
    Ok((d.interior().iter().map(|&a| over_vertices[a]).collect(), factorizations))
}

/// Where the membranes touch, as far as the level below can tell by its gap and contact set: where all parents do; between
/// parents that touch and others that do not, where a few sweeps on this level leave no gap. (Elsewhere the sweeps are not asked:
/// on sets where membranes touch without a force, what they leave is noise, which costs a factorisation for each layer.)
fn touching(level: &Level, coarse_gap: &[f64], coarse_touches: &[bool], b: &[f64]) -> Vec<bool> {
    let Level { pattern, values, transfer, .. } = level;
    let free = || (0..pattern.rows()).filter(|&i| !level.is_held(i));
    let mut w = vec![0.0; pattern.rows()];
    free().for_each(|i| w[i] = transfer.prolong(i, coarse_gap));
    for _ in 0..SWEEPS {
        for i in free() {
            w[i] = f64::max(0.0, (b[i] - values.off_diagonal_product(pattern, i, &w)) * values.inverse[i]);
        }
    }
    let touches = |i: usize| {
        let (mut any, mut all) = (false, true);
        transfer.for_each_parent(i, |a, _| {
            any |= coarse_touches[a];
            all &= coarse_touches[a];
        });
        all || any && w[i] == 0.0
    };
    (0..w.len()).map(touches).collect()
}

/// The matrix of a level at the vertices that are not held, and their rows.
fn free_part(level: &Level) -> (CsMat<f64>, Vec<usize>) {
    let rows: Vec<usize> = (0..level.pattern.rows()).filter(|&i| !level.is_held(i)).collect();
    let mut number = vec![usize::MAX; level.pattern.rows()];
    for (k, &i) in rows.iter().enumerate() {
        number[i] = k;
    }
    let (mut start, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
    for (k, &i) in rows.iter().enumerate() {
        let off = level.pattern.row(i).iter().zip(&level.values.off_diagonal[level.pattern.range(i)]);
        let free = off.filter(|&(&j, _)| !level.is_held(j as usize));
        let mut row: Vec<(usize, f64)> = free.map(|(&j, &a)| (number[j as usize], a)).collect();
        row.push((k, level.values.diagonal[i]));
        row.sort_unstable_by_key(|&(j, _)| j);
        columns.extend(row.iter().map(|&(j, _)| j));
        values.extend(row.iter().map(|&(_, a)| a));
        start.push(columns.len());
    }
    (CsMat::new((rows.len(), rows.len()), start, columns, values), rows)
}
