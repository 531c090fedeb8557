//! From a plane in space to coordinates in it.

use super::Nodes;
use crate::formats::gmsh::error::GmshError;
use crate::formats::gmsh::note::GmshNote;

/// Largest distance of a node from the plane of the mesh, relative to the largest side of the box around the mesh.
///
/// It is the relative accuracy at which Gmsh itself takes two points for one (`Geometry.Tolerance`).
pub const FLATNESS: f64 = 1e-8;

/// A plane is upright when its normal rises by less than this: then `y` is the height.
const UPRIGHT: f64 = 1e-6;

/// The plane faces along the x axis when less than this is left of the axis in it: then the y axis takes its place.
const FACING: f64 = 1e-3;

type Vector = [f64; 3];

fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn minus(a: Vector, b: Vector) -> Vector {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn times(factor: f64, a: Vector) -> Vector {
    a.map(|x| factor * x)
}

fn unit(a: Vector) -> Vector {
    times(1.0 / dot(a, a).sqrt(), a)
}

impl Nodes {
    fn at(&self, k: usize) -> Vector {
        let [x, y] = self.points[k];
        [x, y, self.heights[k]]
    }
}

/// Gives all nodes their coordinates in the plane of the `used` ones, of which there is one at least; tells how, where that is more than to leave out
/// `z = 0`. In a plane `z = constant`, `x` and `y` are kept; in another one see [`axes`].
///
/// # Errors
/// [`GmshError::NotFlat`]: they lie in no plane, up to [`FLATNESS`].
pub(crate) fn flatten<I: Iterator<Item = usize>>(
    nodes: &mut Nodes,
    used: impl Fn() -> I,
) -> Result<Option<GmshNote>, GmshError> {
    // Scaled before the difference, which could overflow.
    let side = |axis: usize| {
        let bounds = used().map(|k| nodes.at(k)[axis]);
        let (low, high) =
            bounds.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        FLATNESS * high - FLATNESS * low
    };
    let [x, y, z] = [0, 1, 2].map(side);
    let level = nodes.heights[used().next().expect("there are nodes in use")];
    let all_near = |height: f64| used().all(|k| (nodes.heights[k] - height).abs() <= x.max(y));
    if all_near(level) {
        return Ok((!all_near(0.0)).then_some(GmshNote::Level { z: level }));
    }
    let plane = Plane::of(nodes, &used);
    let tolerance = x.max(y).max(z);
    // A comparison that fails for what is no number.
    if let Some((node, distance)) =
        used().map(|k| (k, plane.distance(nodes.at(k)))).find(|&(_, distance)| !(distance <= tolerance))
    {
        let through = plane.through.map(|k| nodes.tags[k]);
        return Err(GmshError::NotFlat { node: nodes.tags[node], distance, through });
    }
    let axes = axes(plane.normal);
    let points = (0..nodes.points.len()).map(|k| axes.map(|axis| dot(axis, nodes.at(k)))).collect();
    nodes.points = points;
    Ok(Some(GmshNote::Plane { axes }))
}

/// A plane through three nodes.
struct Plane {
    through: [usize; 3],
    origin: Vector,
    normal: Vector,
}

impl Plane {
    /// Through the first node, the one farthest from it, and the one farthest from the line through these.
    fn of<I: Iterator<Item = usize>>(nodes: &Nodes, used: &impl Fn() -> I) -> Self {
        let first = used().next().expect("there are nodes in use");
        let origin = nodes.at(first);
        let from_origin = |k: usize| minus(nodes.at(k), origin);
        let farthest = |size: &dyn Fn(usize) -> f64| {
            used()
                .map(|k| (k, size(k)))
                .fold((first, 0.0), |best, new| if new.1 > best.1 { new } else { best })
                .0
        };
        let second = farthest(&|k| {
            let [x, y, z] = from_origin(k);
            x.hypot(y).hypot(z)
        });
        let along = {
            let [x, y, z] = from_origin(second);
            times(1.0 / x.hypot(y).hypot(z), [x, y, z])
        };
        let third = farthest(&|k| {
            let [x, y, z] = cross(along, from_origin(k));
            x.hypot(y).hypot(z)
        });
        let across = from_origin(third);
        let across = unit(minus(across, times(dot(across, along), along)));
        Self { through: [first, second, third], origin, normal: unit(cross(along, across)) }
    }

    fn distance(&self, point: Vector) -> f64 {
        dot(self.normal, minus(point, self.origin)).abs()
    }
}

/// Orthonormal axes of the plane with this normal. The first one is the direction of the x axis as seen in the plane (of the y
/// axis, where the plane faces along the x axis), the second one a quarter turn from it, counterclockwise as seen from above; in
/// an upright plane it points upwards.
fn axes(normal: Vector) -> [Vector; 2] {
    let seen = |axis: Vector| minus(axis, times(dot(axis, normal), normal));
    let along_x = seen([1.0, 0.0, 0.0]);
    let first = unit(if dot(along_x, along_x).sqrt() > FACING { along_x } else { seen([0.0, 1.0, 0.0]) });
    let second = cross(normal, first);
    let is_upright = normal[2].abs() < UPRIGHT;
    let is_turned = if is_upright { second[2] < 0.0 } else { normal[2] < 0.0 };
    // No negative zeros, which a message would show.
    let tidy = |axis: Vector| axis.map(|x| x + 0.0);
    [tidy(first), tidy(if is_turned { times(-1.0, second) } else { second })]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rounding of coordinates of order one.
    const ROUNDING: f64 = 1e-15;

    fn nodes(points: &[Vector]) -> Nodes {
        let tags = (1..=points.len() as u64).collect();
        let flat = points.iter().map(|&[x, y, _]| [x, y]).collect();
        Nodes::new(tags, flat, points.iter().map(|p| p[2]).collect()).unwrap()
    }

    const SQUARE: [[f64; 2]; 5] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.25, 0.5]];

    /// The square on these axes, at an origin.
    fn square(origin: Vector, axes: [Vector; 2]) -> Nodes {
        let at = |p: [f64; 2]| std::array::from_fn(|k| origin[k] + p[0] * axes[0][k] + p[1] * axes[1][k]);
        nodes(&SQUARE.map(at))
    }

    fn flattened(mut nodes: Nodes) -> Result<(Vec<[f64; 2]>, Option<GmshNote>), GmshError> {
        let n = nodes.points.len();
        let note = flatten(&mut nodes, || 0..n)?;
        Ok((nodes.points, note))
    }

    #[test]
    fn planes_along_the_axes_keep_their_coordinates() {
        let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert_eq!(flattened(square([0.0; 3], [x, y])).unwrap(), (SQUARE.to_vec(), None));
        assert_eq!(
            flattened(square([0.0, 0.0, 7.5], [x, y])).unwrap(),
            (SQUARE.to_vec(), Some(GmshNote::Level { z: 7.5 }))
        );
        for axes in [[x, z], [y, z]] {
            let found = flattened(square([0.0; 3], axes)).unwrap();
            assert_eq!(found, (SQUARE.to_vec(), Some(GmshNote::Plane { axes })));
        }
    }

    #[test]
    fn lengths_and_sides_are_kept_in_any_plane() {
        // Slopes up to the vertical and beyond it; they change by and by from the level plane on.
        for tilt in [1e-6, 0.1, 0.5, 1.0, 1.5, 1.6, 2.5_f64] {
            for turn in [0.0, 0.7, 2.0, 4.0_f64] {
                let first = [turn.cos(), turn.sin(), 0.0];
                let second = [-turn.sin() * tilt.cos(), turn.cos() * tilt.cos(), tilt.sin()];
                let (points, note) = flattened(square([0.3, -2.0, 0.1], [first, second])).unwrap();
                assert!(matches!(note, Some(GmshNote::Plane { .. })));
                for (p, a) in points.iter().zip(SQUARE) {
                    for (q, b) in points.iter().zip(SQUARE) {
                        let [found, expected] =
                            [[*p, *q], [a, b]].map(|[p, q]| (p[0] - q[0]).hypot(p[1] - q[1]));
                        assert!(
                            (found - expected).abs() < 8.0 * ROUNDING,
                            "{tilt} {turn}: {found} {expected}"
                        );
                    }
                }
                if tilt < 1e-5 {
                    let turned = |[x, y]: [f64; 2]| {
                        [0.3 + x * turn.cos() - y * turn.sin(), -2.0 + x * turn.sin() + y * turn.cos()]
                    };
                    let close = points
                        .iter()
                        .zip(SQUARE.map(turned))
                        .all(|(p, q)| (p[0] - q[0]).hypot(p[1] - q[1]) < 2.0 * tilt);
                    assert!(close, "almost level: almost x and y: {points:?}");
                }
            }
        }
    }

    #[test]
    fn what_lies_in_no_plane_is_refused_with_its_distance() {
        let mut bent = SQUARE.map(|[x, y]| [x, y, x]);
        assert!(flattened(nodes(&bent)).is_ok());
        bent[4][2] += 0.9 * FLATNESS;
        assert!(flattened(nodes(&bent)).is_ok());
        bent[4][2] += 1.0;
        let Err(GmshError::NotFlat { node: 5, distance, through }) = flattened(nodes(&bent)) else {
            panic!("{:?}", flattened(nodes(&bent)))
        };
        // The last node is the farthest: the plane goes through it.
        assert!(distance > 0.0 && through.contains(&1), "{distance} {through:?}");
    }

    #[test]
    fn no_size_is_too_large_or_too_small_and_a_line_is_no_plane() {
        for size in [1e-100, 1e100] {
            let axes = [[0.6, 0.0, 0.8], [0.0, 1.0, 0.0]].map(|axis| times(size, axis));
            let (points, _) = flattened(square([0.0; 3], axes)).unwrap();
            assert!(
                points
                    .iter()
                    .flatten()
                    .zip(SQUARE.as_flattened())
                    .all(|(x, y)| (x / size - y).abs() < 8.0 * ROUNDING)
            );
        }
        for line in [[[0.0; 3], [1.0; 3], [2.0; 3]], [[1.0; 3]; 3]] {
            assert!(
                flattened(nodes(&line))
                    .map_or(true, |(points, _)| points.iter().flatten().all(|x| x.is_finite()))
            );
        }
    }
}
