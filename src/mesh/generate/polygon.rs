//! Unstructured meshes of polygons with holes, by Delaunay refinement (Ruppert's algorithm, in the crate `spade`).

mod rings;

use std::collections::HashSet;

use spade::{AngleLimit, ConstrainedDelaunayTriangulation, Point2, RefinementParameters, Triangulation};

use super::error::{GenerateError, MAX_MIN_ANGLE, check_vertex_estimate};
use crate::geometry::ring_area;
use crate::mesh::{Groups, Mesh};
use rings::{SideEdge, edges_of_sides};

/// So many vertices may always be added: a coarse mesh need not be as coarse as `size` allows.
const LEEWAY: usize = 10_000;

/// The mesh's area may differ from the polygon's by rounding only, this fraction of it; a hole outside of the polygon
/// or across another one makes a larger difference.
const AREA_TOLERANCE: f64 = 1e-9;

/// The polygon `vertices` without the polygons `holes`, in triangles with edges of about `size` and angles of at least
/// `min_angle` degrees (but for smaller angles of the polygon itself). Deterministic.
///
/// Each ring is given in either orientation; its last vertex may repeat the first, as in GeoJSON. The outer ring is the curve
/// `outer`; its sides, from each vertex to the next one, are `side 1`, `side 2` ...; the rings of the holes are `hole 1`,
/// `hole 2` ...
///
/// # Errors
/// [`GenerateError`] for a `size` that is not positive or makes too many triangles, a `min_angle` outside of `0..=30`,
/// rings with fewer than three vertices, rings that cross, holes that leave the polygon, and a polygon so narrow that its
/// triangles take many more vertices than `size` asks for.
pub fn polygon(
    vertices: &[[f64; 2]],
    holes: &[Vec<[f64; 2]>],
    size: f64,
    min_angle: f64,
) -> Result<Mesh, GenerateError> {
    let (mesh, edges) = with_sides(vertices, holes, size, min_angle)?;
    let sides = open_ring(vertices).len();
    let numbered = |what: &'static str, n: usize| (1..=n).map(move |k| format!("{what} {k}"));
    let names =
        std::iter::once("outer".into()).chain(numbered("side", sides)).chain(numbered("hole", holes.len()));
    // A side belongs to two curves: the first one, and its own. Rings of holes are numbered from 1.
    let parts =
        (0..sides + holes.len()).map(|part| if part < sides { vec![0, part + 1] } else { vec![part + 1] });
    let part = |edge: &SideEdge| if edge.ring == 0 { edge.side } else { sides + edge.ring - 1 };
    let members = edges.iter().map(|edge| (edge.ends, part(edge)));
    Ok(mesh.with_groups(Groups::of_overlapping_curves(names.collect(), parts, members)))
}

/// The mesh of [`polygon`] without holes, with other names: the side from corner `k` to the next one belongs to the curve
/// `name_of_side[k]`, or all of them to the only one.
pub(super) fn polygon_with_names(
    vertices: &[[f64; 2]],
    name_of_side: &[&str],
    size: f64,
    min_angle: f64,
) -> Result<Mesh, GenerateError> {
    let (mesh, edges) = with_sides(vertices, &[], size, min_angle)?;
    let mut names: Vec<&str> = Vec::new();
    for name in name_of_side {
        if !names.contains(name) {
            names.push(name);
        }
    }
    let of_side = |side: usize| name_of_side[side % name_of_side.len()];
    let curve =
        |name| (name, edges.iter().filter(|edge| of_side(edge.side) == name).map(|edge| edge.ends).collect());
    Ok(mesh.with_groups(Groups::of_curves(names.into_iter().map(curve))))
}

/// A mesh without names, and which edge of its boundary is on which side of which ring.
fn with_sides(
    vertices: &[[f64; 2]],
    holes: &[Vec<[f64; 2]>],
    size: f64,
    min_angle: f64,
) -> Result<(Mesh, Vec<SideEdge>), GenerateError> {
    if !(size > 0.0 && size.is_finite()) {
        return Err(GenerateError::Size { size });
    }
    if !(0.0..=MAX_MIN_ANGLE).contains(&min_angle) {
        return Err(GenerateError::MinAngle { min_angle });
    }
    let vertices = open_ring(vertices);
    let holes: Vec<&[[f64; 2]]> = holes.iter().map(|hole| open_ring(hole)).collect();
    let area = check_rings(vertices, &holes)?;
    let max_area = largest_triangle(size);
    // Two triangles a vertex, of half that area.
    let expected = check_vertex_estimate(area / max_area)?;

    let mut cdt = triangulate_rings(vertices, &holes)?;
    let boundary = vertices.len() + holes.iter().map(|hole| hole.len()).sum::<usize>();
    let most = LEEWAY + 100 * boundary + 10 * expected;
    let parameters = RefinementParameters::new()
        .exclude_outer_faces(true)
        .with_angle_limit(AngleLimit::from_deg(min_angle))
        .with_max_allowed_area(max_area)
        .with_max_additional_vertices(most);
    let refinement = cdt.refine(parameters);
    if !refinement.refinement_complete {
        return Err(GenerateError::TooNarrow { min_angle, vertices: most, expected });
    }

    let excluded: HashSet<_> = refinement.excluded_faces.into_iter().collect();
    let mut number = vec![usize::MAX; cdt.num_vertices()];
    let mut points = Vec::new();
    let mut triangles = Vec::new();
    for face in cdt.inner_faces().filter(|face| !excluded.contains(&face.fix())) {
        triangles.push(face.vertices().map(|vertex| {
            let number = &mut number[vertex.fix().index()];
            if *number == usize::MAX {
                *number = points.len();
                points.push([vertex.position().x, vertex.position().y]);
            }
            *number
        }));
    }
    // A hole that touches the boundary can take everything with it.
    if triangles.is_empty() {
        return Err(GenerateError::Holes);
    }
    let mesh = Mesh::new(points, triangles).map_err(|_| GenerateError::Rounding)?;
    if !((mesh.area() - area).abs() <= AREA_TOLERANCE * area) {
        return Err(GenerateError::Holes);
    }
    // The corners come first in the triangulation, in the order in which they were given.
    let rings = std::iter::once(vertices).chain(holes.iter().copied());
    let edges = edges_of_sides(&mesh, rings, &number[..boundary]).ok_or(GenerateError::Holes)?;
    Ok((mesh, edges))
}

/// The area of an equilateral triangle of this edge length.
pub(in crate::mesh) fn largest_triangle(size: f64) -> f64 {
    0.25 * 3f64.sqrt() * size * size
}

/// A ring without its last vertex, if that repeats the first.
fn open_ring(ring: &[[f64; 2]]) -> &[[f64; 2]] {
    match ring {
        [first, open @ .., last] if first == last => &ring[..=open.len()],
        _ => ring,
    }
}

/// Checks the rings one by one; the area of the outer one less those of the holes.
fn check_rings(vertices: &[[f64; 2]], holes: &[&[[f64; 2]]]) -> Result<f64, GenerateError> {
    let mut area = checked_area("vertices", vertices)?;
    for (k, hole) in holes.iter().enumerate() {
        area -= checked_area(&format!("hole {}", k + 1), hole)?;
    }
    if !(area > 0.0) {
        return Err(GenerateError::Holes);
    }
    Ok(area)
}

fn checked_area(name: &str, ring: &[[f64; 2]]) -> Result<f64, GenerateError> {
    if ring.len() < 3 {
        return Err(GenerateError::Ring { ring: name.into(), problem: "has fewer than three vertices" });
    }
    if !ring.iter().flatten().all(|x| x.is_finite()) {
        return Err(GenerateError::Ring { ring: name.into(), problem: "has a vertex that is not finite" });
    }
    let area = ring_area(ring);
    if !(area > 0.0) {
        return Err(GenerateError::Ring { ring: name.into(), problem: "encloses no area" });
    }
    Ok(area)
}

/// Whether a ring passes through a point twice.
fn has_twins(ring: &[[f64; 2]]) -> bool {
    let mut points = ring.to_vec();
    points.sort_by(|p, q| p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])));
    points.windows(2).any(|pair| pair[0] == pair[1])
}

/// The constrained Delaunay triangulation of all rings, before refinement.
fn triangulate_rings(
    vertices: &[[f64; 2]],
    holes: &[&[[f64; 2]]],
) -> Result<ConstrainedDelaunayTriangulation<Point2<f64>>, GenerateError> {
    let mut points = Vec::new();
    let mut edges = Vec::new();
    for ring in std::iter::once(vertices).chain(holes.iter().copied()) {
        let first = points.len();
        points.extend(ring.iter().map(|&[x, y]| Point2::new(x, y)));
        edges.extend((0..ring.len()).map(|k| [first + k, first + (k + 1) % ring.len()]));
    }
    let given = points.len();
    let mut crossing = None;
    let cdt = ConstrainedDelaunayTriangulation::try_bulk_load_cdt(points.clone(), edges, |[a, b]| {
        crossing = Some([a, b]);
    })
    .map_err(|error| GenerateError::Coordinates { reason: error.to_string() })?;
    if cdt.num_vertices() < given {
        let mut rings = std::iter::once(vertices).chain(holes.iter().copied());
        return Err(match rings.any(has_twins) {
            true => GenerateError::Ring { ring: "the polygon".into(), problem: "has the same vertex twice" },
            false => GenerateError::Holes,
        });
    }
    match crossing {
        Some([a, b]) => {
            Err(GenerateError::Crossing { from: [points[a].x, points[a].y], to: [points[b].x, points[b].y] })
        }
        None => Ok(cdt),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(x: f64, y: f64, side: f64) -> Vec<[f64; 2]> {
        vec![[x, y], [x + side, y], [x + side, y + side], [x, y + side]]
    }

    #[test]
    fn square_with_a_hole_meets_size_and_angle() {
        let (size, min_angle) = (0.05, 25.0);
        let mesh = polygon(&square(0.0, 0.0, 1.0), &[square(0.4, 0.3, 0.2)], size, min_angle).unwrap();
        assert!((mesh.area() - 0.96).abs() < AREA_TOLERANCE);
        let quality = mesh.quality();
        assert!(quality.min_angle >= min_angle);
        assert!(quality.h_max < 2.0 * size, "no edge is much longer than asked for: {quality:?}");
        // The angle is met because it was asked for: without the demand, a small hole in large triangles spoils it.
        let with_small_hole =
            |min_angle| polygon(&square(0.0, 0.0, 1.0), &[square(0.5, 0.5, 0.02)], 1.0, min_angle);
        assert!(with_small_hole(min_angle).unwrap().quality().min_angle >= min_angle);
        assert!(with_small_hole(0.0).unwrap().quality().min_angle < min_angle);
    }

    #[test]
    fn a_ring_may_be_closed_by_its_first_vertex() {
        let closed = |ring: Vec<[f64; 2]>| [ring.as_slice(), &ring[..1]].concat();
        let (outer, hole) = (square(0.0, 0.0, 1.0), square(0.4, 0.3, 0.2));
        let open = polygon(&outer, std::slice::from_ref(&hole), 0.2, 25.0).unwrap();
        let mesh = polygon(&closed(outer.clone()), &[closed(hole)], 0.2, 25.0).unwrap();
        assert_eq!((mesh.points(), mesh.triangles()), (open.points(), open.triangles()));
        // Closed twice, it passes through that vertex twice; two vertices are none the more a polygon for being closed.
        let message = |ring: &[[f64; 2]]| polygon(ring, &[], 0.2, 25.0).unwrap_err().to_string();
        assert!(message(&closed(closed(outer.clone()))).contains("twice"));
        assert!(message(&closed(outer[..2].to_vec())).contains("fewer than three"));
        assert!(
            message(&[[0.0, 0.0]]).contains("fewer than three") && message(&[]).contains("fewer than three")
        );
    }

    #[test]
    fn what_is_too_narrow_says_so_and_both_remedies_help() {
        let strip = [[0.0, 0.0], [100.0, 0.0], [100.0, 0.01], [0.0, 0.01]];
        let message = polygon(&strip, &[], 0.5, 25.0).unwrap_err().to_string();
        assert_eq!(
            message,
            "triangles with angles of 25 degrees take more than 10,500 vertices here, where `size` alone asks for about 10: the polygon has parts much narrower than `size`; give `min_angle = 0`, or a `size` as small as they are"
        );
        for (size, min_angle) in [(0.5, 0.0), (0.01, 25.0)] {
            assert!(polygon(&strip, &[], size, min_angle).unwrap().quality().min_angle >= min_angle);
        }
    }

    #[test]
    fn bad_polygons_are_refused_in_words() {
        let outer = square(0.0, 0.0, 1.0);
        let bow_tie = vec![[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 2.0]];
        let refused = [
            (polygon(&outer, &[], 0.0, 25.0), "size"),
            (polygon(&outer, &[], f64::NAN, 25.0), "size"),
            (polygon(&outer, &[], 1e-9, 25.0), "vertices"),
            (polygon(&outer, &[], 0.1, 40.0), "min_angle"),
            (polygon(&outer[..2], &[], 0.1, 25.0), "fewer than three"),
            (polygon(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]], &[], 0.1, 25.0), "no area"),
            (polygon(&[[0.0, 0.0], [1.0, f64::NAN], [2.0, 0.0]], &[], 0.1, 25.0), "not finite"),
            (polygon(&bow_tie, &[], 0.1, 25.0), "cross"),
            (polygon(&outer, &[square(0.9, 0.4, 0.2)], 0.1, 25.0), "cross"),
            (polygon(&outer, &[square(2.0, 2.0, 0.2)], 0.1, 25.0), "hole"),
            (polygon(&[outer.clone(), outer.clone()].concat(), &[], 0.1, 25.0), "twice"),
            (polygon(&outer, &[square(0.0, 0.0, 0.5)], 0.1, 25.0), "touches"),
            (polygon(&outer, &[square(0.2, 0.2, 0.2), square(0.4, 0.4, 0.2)], 0.1, 25.0), "touches"),
            (polygon(&outer, &[square(0.0, 0.25, 0.5)], 0.1, 25.0), "hole"),
            (polygon(&[[1e6 + 1.0, 1e6], [1e6, 1e6], [1e6, 1e6 + 1e-9]], &[], 1.0, 0.0), "rounding"),
        ];
        for (k, (result, word)) in refused.into_iter().enumerate() {
            let message = result.expect_err(&format!("entry {k}")).to_string();
            assert!(message.contains(word), "entry {k}: {message}");
        }
    }
}
