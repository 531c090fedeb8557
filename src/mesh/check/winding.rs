//! How often closed curves wind round points, for many curves and many points.

use super::boundary::BoundaryEdge;
use crate::geometry::twice_signed_area;

/// A point, and how often all edges wind round it: those that cross the half-line from it to the right upwards, less those
/// that cross it downwards.
#[derive(Debug, Clone, Copy)]
pub(super) struct Winding {
    pub(super) point: [f64; 2],
    pub(super) turns: i32,
}

/// Counts the turns of the edges, which must not cross each other, round the points, which must lie in increasing order of
/// `y` and begin with no turns. Returns how many edges were looked at: no more than about `(n + m) log m log n` for `n` edges
/// and `m` points, wherever they lie.
///
/// Edges that pass by all points, from below to above, are in order from left to right: each point has a place among them. The
/// others pass by some of the points: halves of the points are looked at in turn.
pub(super) fn wind(points: &[[f64; 2]], edges: &[BoundaryEdge], windings: &mut [Winding]) -> usize {
    let ([first, ..], [.., last]) = (&*windings, &*windings) else { return 0 };
    let (lowest, highest) = (first.point[1], last.point[1]);
    let heights = |edge: &BoundaryEdge| edge.ends.map(|a| points[a][1]);
    // As in `is_right_of`, an edge has its lower end, not its upper one.
    let meets = |edge: &&BoundaryEdge| {
        let [y, z] = heights(edge);
        y.min(z) <= highest && y.max(z) > lowest
    };
    let passes = |edge: &BoundaryEdge| {
        let [y, z] = heights(edge);
        y.min(z) <= lowest && y.max(z) > highest
    };
    let (mut passing, others): (Vec<BoundaryEdge>, Vec<BoundaryEdge>) =
        edges.iter().filter(meets).partition(|edge| passes(edge));
    let mut looks = edges.len();

    let middle = 0.5 * lowest + 0.5 * highest;
    passing.sort_by(|one, other| abscissa(points, one, middle).total_cmp(&abscissa(points, other, middle)));
    // turns[k]: those of the edges from the k-th on.
    let mut turns = vec![0; passing.len() + 1];
    for (k, edge) in passing.iter().enumerate().rev() {
        let [y, z] = heights(edge);
        turns[k] = turns[k + 1] + if y < z { 1 } else { -1 };
    }
    for winding in &mut *windings {
        let left = passing.partition_point(|edge| {
            looks += 1;
            !is_right_of(points, edge, winding.point)
        });
        winding.turns += turns[left];
    }

    if !others.is_empty() {
        let (below, above) = windings.split_at_mut(windings.len() / 2);
        looks += wind(points, &others, below) + wind(points, &others, above);
    }
    looks
}

/// Where an edge that is not horizontal passes the height `y`.
fn abscissa(points: &[[f64; 2]], edge: &BoundaryEdge, y: f64) -> f64 {
    let [p, q] = edge.ends.map(|a| points[a]);
    let t = (y - p[1]) / (q[1] - p[1]);
    (1.0 - t) * p[0] + t * q[0]
}

/// Whether a point lies to the left of an edge that passes its height: neither behind it nor on it.
fn is_right_of(points: &[[f64; 2]], edge: &BoundaryEdge, point: [f64; 2]) -> bool {
    let [from, to] = edge.ends.map(|a| points[a]);
    let side = twice_signed_area([from, to, point]);
    if from[1] < to[1] { side > 0.0 } else { side < 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::Random;

    /// The edge from each point to the next one of its square.
    fn squares(corners: &[[f64; 2]]) -> Vec<BoundaryEdge> {
        let edge = |k: usize| BoundaryEdge { ends: [k, k / 4 * 4 + (k + 1) % 4], triangle: k / 4 };
        (0..corners.len()).map(edge).collect()
    }

    fn square([x, y]: [f64; 2], side: f64) -> [[f64; 2]; 4] {
        [[x, y], [x + side, y], [x + side, y + side], [x, y + side]]
    }

    #[test]
    fn turns_are_those_of_the_squares_around_a_point() {
        // Squares in squares, side by side, some of them clockwise: turns cancel.
        let mut random = Random::new(3);
        let mut corners = Vec::new();
        let mut signs = Vec::new();
        for i in 0..8 {
            for depth in 0..5 {
                let inset = 0.1 * f64::from(depth);
                let mut ring =
                    square([f64::from(i) + inset, inset + 0.3 * f64::from(i)], 1.0 - 2.0 * inset - 0.05);
                let clockwise = random.below(2) == 0;
                if clockwise {
                    ring.reverse();
                }
                signs.push(if clockwise { -1 } else { 1 });
                corners.extend(ring);
            }
        }
        let edges = squares(&corners);
        let mut windings: Vec<Winding> = (0..500)
            .map(|_| Winding { point: [random.between(-1.0, 9.0), random.between(-1.0, 4.0)], turns: 0 })
            .collect();
        windings.sort_by(|p, q| p.point[1].total_cmp(&q.point[1]));
        wind(&corners, &edges, &mut windings);
        let mut inside = 0;
        for Winding { point: [x, y], turns } in windings {
            let contains = |ring: &[[f64; 2]]| {
                let bounds = |axis: usize| ring.iter().map(move |corner| corner[axis]);
                let within = |x: f64, axis: usize| {
                    bounds(axis).any(|bound| bound < x) && bounds(axis).any(|bound| bound > x)
                };
                within(x, 0) && within(y, 1)
            };
            let rings = corners.chunks(4).zip(&signs).filter(|(ring, _)| contains(ring));
            assert_eq!(turns, rings.map(|(_, sign)| sign).sum::<i32>(), "({x}, {y})");
            inside += i32::from(turns != 0);
        }
        assert!((50..450).contains(&inside), "both occur: {inside}");
    }

    #[test]
    fn a_point_on_an_edge_is_not_left_of_it() {
        let corners = square([0.0, 0.0], 1.0);
        let at = |point: [f64; 2]| {
            let mut winding = [Winding { point, turns: 0 }];
            wind(&corners, &squares(&corners), &mut winding);
            winding[0].turns
        };
        assert_eq!([at([1.0, 0.0]), at([1.0, 0.5]), at([1.0, 1.0]), at([0.5, 0.5])], [0, 0, 0, 1]);
    }
}
