//! Nested iteration: the contact set of a level, found from that of the next coarser one.

use sprs::CsMat;

use super::obstacle::{Limits, Obstacle};
use crate::discretization::Discretization;
use crate::solver::cholesky::NotFactored;
use crate::solver::decoupled::Decoupled;
use crate::solver::hierarchy::{Hierarchy, Level};

/// A guess of the contact set over the unknowns, and the factorisations on each of the coarser levels.
///
/// Slight gaps below zero are overlooked there: the next level decides on them anew. A vertex is guessed to touch when all of
/// its parents do: a guess that is rather too small is repaired in fewer steps.
pub(super) fn guess_from_coarser_levels(
    d: &Discretization,
    limits: &Limits,
) -> Result<(Vec<bool>, Vec<usize>), NotFactored> {
    let hierarchy = Hierarchy::new(d);
    let decoupled = Decoupled::new(d);
    let load = hierarchy.to_rows(|a| decoupled.gap_load(a));
    let (loads, _) = hierarchy.lifted(load, hierarchy.to_rows(|a| d.height()[a]));
    let mut factorizations = Vec::new();
    let mut touches = vec![false; hierarchy.levels()[1].pattern.rows()];
    for (l, load) in loads.iter().enumerate().take(hierarchy.finest()).skip(1) {
        let level = &hierarchy.levels()[l];
        let (k, rows) = free_part(level);
        let b: Vec<f64> = rows.iter().map(|&i| load[i]).collect();
        let active = rows.iter().map(|&i| touches[i]).collect();
        let mut half = Obstacle::new(&k, b.clone(), b, d.scales().displacement)?;
        let (gap, _, repairs) = half.settle_roughly(active, limits)?;
        factorizations.push(repairs + 1);
        let mut on_level = vec![false; touches.len()];
        for (&i, y) in rows.iter().zip(&gap.y) {
            on_level[i] = *y > 0.0;
        }
        let finer = &hierarchy.levels()[l + 1].transfer;
        let finer_rows = hierarchy.levels()[l + 1].pattern.rows();
        let all_touch = |i: usize| {
            let mut all = true;
            finer.for_each_parent(i, |a, _| all &= on_level[a]);
            all
        };
        touches = (0..finer_rows).map(all_touch).collect();
    }
    let mut over_vertices = vec![false; hierarchy.vertex().len()];
    for (&a, &touches) in hierarchy.vertex().iter().zip(&touches) {
        over_vertices[a as usize] = touches;
    }
    Ok((d.interior().iter().map(|&a| over_vertices[a]).collect(), factorizations))
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
