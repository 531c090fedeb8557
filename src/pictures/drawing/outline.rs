//! The outline of a mesh.

/// The edges that belong to one triangle only, in increasing order of their lower and upper ends. Linear time.
pub(crate) fn boundary_edges(vertices: usize, triangles: &[[usize; 3]]) -> Vec<[usize; 2]> {
    let sides = || triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    // The upper ends of all sides, those with one lower end together: counted, then filled in.
    let mut start = vec![0; vertices + 1];
    sides().for_each(|[a, b]| start[a.min(b)] += 1);
    let mut end = 0;
    for row in &mut start {
        end += std::mem::replace(row, end);
    }
    let mut uppers = vec![0; end];
    let mut next = start.clone();
    for [a, b] in sides() {
        let next = &mut next[a.min(b)];
        uppers[*next] = a.max(b);
        *next += 1;
    }
    let mut alone = Vec::new();
    for (lower, row) in start.windows(2).enumerate() {
        let row = &mut uppers[row[0]..row[1]];
        row.sort_unstable();
        let once = row.chunk_by(|a, b| a == b).filter(|same| same.len() == 1);
        alone.extend(once.map(|same| [lower, same[0]]));
    }
    alone
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::samples::{irregular, renumbered};

    #[test]
    fn they_are_the_edges_of_one_triangle_whichever_way_it_turns() {
        for (seed, cells) in [(1, 1), (2, 5), (3, 9)] {
            let (mesh, _) = renumbered(&irregular(cells), seed);
            let expected: Vec<[usize; 2]> =
                crate::mesh::boundary_edges(&mesh).into_iter().map(|[a, b]| [a.min(b), a.max(b)]).collect();
            let turned = mesh.triangles().iter().enumerate();
            let turned: Vec<[usize; 3]> =
                turned.map(|(t, &[a, b, c])| if t % 2 == 0 { [a, b, c] } else { [a, c, b] }).collect();
            // A vertex in no triangle has no edge.
            assert_eq!(boundary_edges(mesh.points().len() + 1, &turned), expected);
            assert_ne!(boundary_edges(mesh.points().len(), &turned[1..]), expected);
        }
    }
}
