use std::f64::consts::PI;

use super::*;
use crate::mesh::samples::{ancestry_defect, assorted, irregular, square};
use crate::mesh::{Pattern, disk, rectangle};
use crate::numeric::{Random, largest};

/// Rounding of sums over the triangles of small meshes of size one.
const ROUNDING: f64 = 1e-12;

/// New triangles per marked one, over many steps: 27.3 was the most seen, where one triangle at a point is marked again and
/// again, and all around it have to follow.
const CLOSURE: f64 = 30.0;

/// Some of the triangles, at random.
fn some(random: &mut Random, triangles: usize) -> Vec<usize> {
    (0..1 + triangles / 10).map(|_| random.below(triangles)).collect()
}

/// The triangles that have `point` in them or on their boundary.
fn around(mesh: &Mesh, point: [f64; 2]) -> Vec<usize> {
    let is_in = |t: &usize| {
        let [a, b, c] = mesh.corners(*t);
        [[a, b], [b, c], [c, a]]
            .iter()
            .all(|&[p, q]| crate::geometry::twice_signed_area([p, q, point]) >= 0.0)
    };
    (0..mesh.triangles().len()).filter(is_in).collect()
}

/// Whether the checks of the constructor find nothing, and the same kinds.
fn is_conforming(mesh: &Mesh) -> bool {
    Mesh::new(mesh.points().to_vec(), mesh.triangles().to_vec())
        .is_ok_and(|checked| checked.triangles() == mesh.triangles() && checked.kind() == mesh.kind())
}

/// Steps that mark at random, on any mesh: conforming ones of the same area, whose vertices come from their parents.
fn check_random_steps(mut bisection: Bisection, seed: u64) {
    let mut random = Random::new(seed);
    for _ in 0..6 {
        let before = bisection.mesh().clone();
        let marked = some(&mut random, before.triangles().len());
        let parents = bisection.refine(&marked).unwrap();
        let mesh = bisection.mesh();
        assert!(is_conforming(mesh));
        assert!((mesh.area() - before.area()).abs() < ROUNDING);
        let (old, new) = mesh.points().split_at(before.points().len());
        assert_eq!(old, before.points());
        assert_eq!(mesh.kind()[..old.len()], *before.kind());
        assert_eq!(parents.len(), new.len());
        for (&[a, b], &midpoint) in parents.iter().zip(new) {
            assert_eq!(midpoint, before.midpoint([a, b]));
        }
    }
}

#[test]
fn bisected_meshes_are_conforming() {
    for (seed, mesh) in assorted().into_iter().enumerate() {
        check_random_steps(Bisection::new(mesh), seed as u64);
    }
}

#[test]
fn the_closure_ends_for_any_refinement_edges() {
    for (seed, mesh) in assorted().into_iter().enumerate() {
        let mut random = Random::new(seed as u64);
        let mut bisection = Bisection::new(mesh);
        bisection.refinement_edge.iter_mut().for_each(|edge| *edge = random.below(3) as u8);
        check_random_steps(bisection, seed as u64);
    }
}

#[test]
fn without_the_closure_vertices_hang() {
    let mut bisection = Bisection::new(irregular(4));
    let before = bisection.mesh().clone();
    bisection.refine(&[5]).unwrap();
    let mesh = bisection.mesh();
    let children = |t: usize| bisection.origin().iter().filter(|&&origin| origin == t).count();
    let closed = (0..before.triangles().len()).find(|&t| t != 5 && children(t) > 1).unwrap();
    let kept = (0..mesh.triangles().len()).filter(|&t| bisection.origin()[t] != closed);
    let undone = kept.map(|t| mesh.triangles()[t]).chain([before.triangles()[closed]]).collect();
    assert!(matches!(Mesh::new(mesh.points().to_vec(), undone), Err(MeshError::HangingVertex { .. })));
}

#[test]
fn marked_triangles_become_four_in_their_place() {
    for mesh in assorted() {
        let mut bisection = Bisection::new(mesh.clone());
        let marked = some(&mut Random::new(7), mesh.triangles().len());
        let parents = bisection.refine(&marked).unwrap();
        let children = |t: usize| -> Vec<usize> {
            let of = |child: &usize| bisection.origin()[*child] == t;
            (0..bisection.origin().len()).filter(of).collect()
        };
        let halved = |t: usize| {
            let [a, b, c] = mesh.triangles()[t];
            let sides = [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)]);
            sides.iter().filter(|side| parents.contains(side)).count()
        };
        for t in 0..mesh.triangles().len() {
            let children = children(t);
            assert_eq!(children.len(), 1 + halved(t), "one more for each halved edge");
            let area: f64 = children.iter().map(|&child| bisection.mesh().triangle_area(child)).sum();
            assert!((area - mesh.triangle_area(t)).abs() < ROUNDING);
            if marked.contains(&t) {
                assert_eq!(halved(t), 3);
            }
        }
        assert!(bisection.origin().is_sorted());
        assert!((0..mesh.triangles().len()).any(|t| halved(t) < 3), "not everything is refined");
    }
}

/// The smallest angles before and after steps that mark what is around the first vertex.
fn angles_at_corner(steps: usize, choose: impl Fn(&mut Bisection)) -> [f64; 2] {
    let mut bisection = Bisection::new(irregular(4));
    let before = bisection.mesh().quality().min_angle;
    for _ in 0..steps {
        choose(&mut bisection);
        let marked = around(bisection.mesh(), bisection.mesh().points()[0]);
        bisection.refine(&marked).unwrap();
    }
    [before, bisection.mesh().quality().min_angle]
}

#[test]
fn angles_stay_away_from_zero() {
    let [before, after] = angles_at_corner(30, |_| {});
    assert!(after >= 0.5 * before, "{before} degrees have become {after}");
    // Always the edge opposite to the corner: its angle is halved in every step.
    let [before, after] = angles_at_corner(5, |bisection| {
        for (edge, corners) in bisection.refinement_edge.iter_mut().zip(&bisection.mesh.triangles) {
            if let Some(corner) = corners.iter().position(|&a| a == 0) {
                *edge = (corner as u8 + 1) % 3;
            }
        }
    });
    assert!(after < 0.5 * before, "{before} degrees have become {after}");
}

/// The angles of a triangle in increasing order, rounded: similar triangles have the same.
fn shape(corners: [[f64; 2]; 3]) -> [i64; 3] {
    let mut angles = crate::mesh::check::angles(corners).map(|angle| (1e6 * angle).round() as i64);
    angles.sort_unstable();
    angles
}

#[test]
fn descendants_of_a_triangle_have_four_shapes_at_most() {
    let corners = vec![[0.0, 0.0], [1.0, 0.1], [0.3, 0.7]];
    let shapes = |choose: &mut dyn FnMut(&mut Bisection)| {
        let mut bisection = Bisection::new(Mesh::new(corners.clone(), vec![[0, 1, 2]]).unwrap());
        let mut random = Random::new(3);
        let mut found = Vec::new();
        for _ in 0..8 {
            choose(&mut bisection);
            let mesh = bisection.mesh();
            found.extend((0..mesh.triangles().len()).map(|t| shape(mesh.corners(t))));
            let marked = some(&mut random, mesh.triangles().len());
            bisection.refine(&marked).unwrap();
        }
        found.sort_unstable();
        found.dedup();
        found.len()
    };
    assert_eq!(shapes(&mut |_| {}), 4);
    let mut random = Random::new(1);
    let mut forget = |bisection: &mut Bisection| {
        bisection.refinement_edge.iter_mut().for_each(|edge| *edge = random.below(3) as u8);
    };
    assert!(shapes(&mut forget) > 4, "refinement edges that are not inherited");
}

/// New triangles per marked one over steps that mark what `choose` says, and refine by `refine`.
fn new_per_marked(
    mesh: Mesh,
    steps: usize,
    mut choose: impl FnMut(&Mesh) -> Vec<usize>,
    refine: impl Fn(&mut Bisection, &[usize]),
) -> f64 {
    let mut bisection = Bisection::new(mesh);
    let before = bisection.mesh().triangles().len();
    let mut marked = 0;
    for _ in 0..steps {
        let chosen = choose(bisection.mesh());
        marked += chosen.len();
        refine(&mut bisection, &chosen);
    }
    (bisection.mesh().triangles().len() - before) as f64 / marked.max(1) as f64
}

#[test]
fn the_closure_is_bounded_by_the_marked_triangles() {
    let refine = |bisection: &mut Bisection, marked: &[usize]| {
        bisection.refine(marked).unwrap();
    };
    for (seed, mesh) in assorted().into_iter().enumerate() {
        let mut random = Random::new(seed as u64);
        let at = |point: [f64; 2]| move |mesh: &Mesh| around(mesh, point);
        // One point lies inside a triangle; the other one is a vertex of some meshes.
        let ratios = [
            new_per_marked(mesh.clone(), 30, at([0.3, 0.4]), refine),
            new_per_marked(mesh.clone(), 30, at([0.25, 0.25]), refine),
            new_per_marked(mesh, 300, |mesh| vec![random.below(mesh.triangles().len())], refine),
        ];
        assert!(ratios.iter().all(|&ratio| ratio <= CLOSURE), "{ratios:?} new triangles per marked one");
    }
    let everything = |bisection: &mut Bisection, _: &[usize]| {
        bisection.refine(&(0..bisection.mesh().triangles().len()).collect::<Vec<_>>()).unwrap();
    };
    assert!(new_per_marked(square(2), 5, |_| vec![0], everything) > CLOSURE);
}

#[test]
fn far_away_nothing_changes() {
    let mut bisection = Bisection::new(square(8));
    let before = bisection.mesh().clone();
    for _ in 0..30 {
        let marked = around(bisection.mesh(), [0.0, 0.0]);
        bisection.refine(&marked).unwrap();
    }
    let stays = |t: &usize| bisection.mesh().triangles().contains(&before.triangles()[*t]);
    let is_far = |t: &usize| before.corners(*t).iter().all(|[x, y]| x + y > 0.75);
    let (far, near): (Vec<_>, Vec<_>) = (0..before.triangles().len()).partition(is_far);
    assert!(!far.is_empty() && far.iter().all(stays));
    assert!(!near.iter().all(stays));
}

#[test]
fn everything_marked_is_uniform_refinement() {
    let mut bisection = Bisection::new(square(3));
    let mut uniform = square(3);
    for _ in 0..2 {
        let all: Vec<usize> = (0..bisection.mesh().triangles().len()).collect();
        let before = bisection.clone();
        bisection.refine(&all).unwrap();
        uniform = uniform.refine().unwrap().mesh;
        let counts = |mesh: &Mesh| (mesh.points().len(), mesh.triangles().len());
        assert_eq!(counts(bisection.mesh()), counts(&uniform));
        let found = bisection.mesh().quality();
        assert!((found.min_angle - 45.0).abs() < ROUNDING && (found.max_angle - 90.0).abs() < ROUNDING);
        assert!((found.h_max / uniform.quality().h_max - 1.0).abs() < ROUNDING);
        let mut fewer = before;
        fewer.refine(&all[..1]).unwrap();
        assert_ne!(counts(fewer.mesh()), counts(&uniform));
    }
}

#[test]
fn every_step_adds_a_level_to_the_ancestry() {
    let coarse = irregular(3);
    let mut bisection = Bisection::new(coarse.refine().unwrap().mesh);
    let mut random = Random::new(5);
    for step in 1..6 {
        let marked = some(&mut random, bisection.mesh().triangles().len());
        let parents = bisection.refine(&marked).unwrap();
        let ancestry = bisection.mesh().ancestry();
        assert_eq!(ancestry.len(), 1 + step, "after one of the coarse mesh");
        let new = &ancestry[step].ends()[ancestry[step].coarse_vertices()..];
        assert!(new.iter().zip(&parents).all(|(found, ends)| *found == ends.map(|a| a as u32)));
    }
    assert!(ancestry_defect(bisection.mesh(), coarse.points()) < ROUNDING);
    assert!(ancestry_defect(bisection.mesh(), irregular(7).points()) > 0.1, "another mesh is noticed");
}

#[test]
fn a_disk_stays_round_and_a_polygon_does_not() {
    let (centre, radius) = ([1.0, 2.0], 0.5);
    let coarse = disk(centre, radius, 2).unwrap();
    let mut round = Bisection::of_domain(coarse.clone(), &Domain::Disk { centre, radius });
    let mut straight = Bisection::of_domain(coarse.clone(), &Domain::unit_square());
    let mut random = Random::new(2);
    for _ in 0..8 {
        let marked = some(&mut random, round.mesh().triangles().len());
        let before = round.mesh().clone();
        round.refine(&marked).unwrap();
        straight.refine(&marked).unwrap();
        assert_eq!(round.mesh().triangles(), straight.mesh().triangles());
        assert_eq!(&round.mesh().points()[..before.points().len()], before.points(), "old vertices stay");
        assert!(is_conforming(round.mesh()));
    }
    let off_the_circle = |mesh: &Mesh| {
        let boundary = mesh.points().iter().zip(mesh.kind()).filter(|(_, k)| **k == VertexKind::Boundary);
        largest(boundary.map(|(p, _)| (distance_sq(*p, centre).sqrt() - radius).abs()))
    };
    assert!(off_the_circle(round.mesh()) < ROUNDING);
    assert!(off_the_circle(straight.mesh()) > 1e-3);
    let defect = |mesh: &Mesh| PI * radius * radius - mesh.area();
    assert!(0.0 < defect(round.mesh()) && defect(round.mesh()) < 0.5 * defect(&coarse));
    assert!((straight.mesh().area() - coarse.area()).abs() < ROUNDING);
    assert!(round.mesh().quality().min_angle > 0.5 * coarse.quality().min_angle);
}

#[test]
fn the_same_marks_make_the_same_mesh() {
    let marks = {
        let mut random = Random::new(1);
        let mut bisection = Bisection::new(irregular(3));
        let record = |_| {
            let marked = some(&mut random, bisection.mesh().triangles().len());
            bisection.refine(&marked).unwrap();
            marked
        };
        (0..5).map(record).collect::<Vec<_>>()
    };
    let replay = |marks: &[Vec<usize>]| {
        let mut bisection = Bisection::new(irregular(3));
        marks.iter().for_each(|marked| {
            bisection.refine(marked).unwrap();
        });
        bisection
    };
    let same = |a: &Bisection, b: &Bisection| {
        a.mesh().points() == b.mesh().points()
            && a.mesh().triangles() == b.mesh().triangles()
            && a.mesh().ancestry() == b.mesh().ancestry()
            && a.refinement_edge == b.refinement_edge
    };
    let mut repeated = marks.clone();
    repeated.iter_mut().for_each(|marked| {
        marked.extend(marked.clone());
        marked.reverse();
    });
    assert!(same(&replay(&marks), &replay(&marks)));
    assert!(same(&replay(&marks), &replay(&repeated)), "neither order nor repetitions matter");
    assert!(!same(&replay(&marks), &replay(&marks[..4])));
}

#[test]
fn nothing_marked_changes_nothing() {
    let mut bisection = Bisection::new(irregular(3));
    bisection.refine(&[0]).unwrap();
    let before = bisection.mesh().clone();
    assert!(bisection.refine(&[]).unwrap().is_empty());
    assert_eq!(bisection.mesh().points(), before.points());
    assert_eq!(bisection.mesh().triangles(), before.triangles());
    assert_eq!(bisection.mesh().ancestry().len(), 1);
    assert!(bisection.origin().iter().enumerate().all(|(t, &origin)| t == origin));
    bisection.refine(&[0]).unwrap();
    assert_eq!(bisection.mesh().ancestry().len(), 2, "something marked does");
}

#[test]
#[should_panic(expected = "a marked triangle is one of the mesh")]
fn a_triangle_that_is_not_there_cannot_be_marked() {
    let _ = Bisection::new(square(1)).refine(&[0, 2]);
}

/// Bisects a square at its lower left corner until that is refused.
fn bisected_at_corner(corner: f64) -> (Bisection, usize) {
    let mesh = rectangle([corner; 2], [corner + 1.0; 2], [2; 2], Pattern::Right).unwrap();
    let mut bisection = Bisection::new(mesh);
    for step in 0.. {
        let before = bisection.clone();
        let marked = around(bisection.mesh(), [corner; 2]);
        if let Err(error) = bisection.refine(&marked) {
            assert_eq!(bisection.mesh().points(), before.mesh().points(), "the mesh is as before");
            assert_eq!(bisection.mesh().triangles(), before.mesh().triangles());
            let corners = error.triangle().map(|t| bisection.mesh().triangles()[t]);
            assert!(matches!(error, MeshError::TooSmall { corners: named, .. } if Some(named) == corners));
            return (bisection, step);
        }
    }
    unreachable!("numbers have an end")
}

#[test]
fn triangles_too_small_for_the_checks_are_refused() {
    for (corner, steps) in [(0.0, 30..35), (1.0, 30..35), (1e6, 18..23)] {
        let (mut bisection, made) = bisected_at_corner(corner);
        assert!(steps.contains(&made), "{made} steps at ({corner}, {corner})");
        assert!(is_conforming(bisection.mesh()));
        let far = around(bisection.mesh(), [corner + 1.0; 2]);
        assert!(bisection.refine(&far).is_ok(), "elsewhere they are large enough");

        // Without the limit, vertices come too close for the checks, and triangles lose their areas in the end.
        bisection.smallest.edge = 0.0;
        if corner > 0.0 {
            let mut flatten = || {
                let marked = around(bisection.mesh(), [corner; 2]);
                bisection.refine(&marked)
            };
            assert!((0..40).any(|_| matches!(flatten(), Err(MeshError::TooSmall { .. }))));
            assert!(!is_conforming(bisection.mesh()));
        }
    }
}

#[test]
fn triangles_agree_about_the_longer_edge() {
    // Six equilateral triangles: all edges have the same length, but for rounding.
    let bisection = Bisection::new(disk([0.0, 0.0], 1.0, 1).unwrap());
    // From triangle to triangle over the refinement edge; an end is where both at an edge have chosen it, or the boundary.
    let reaches_an_end = |bisection: &Bisection, start: usize| {
        let edges = Edges::new(bisection.mesh());
        let mut t = start;
        (0..bisection.mesh().triangles().len()).any(|_| {
            let edge = edges.of_triangle(t)[bisection.start(t)];
            let next = edges.triangles(edge).into_iter().find(|&other| other != t).unwrap_or(t);
            let agree = next == t || edges.of_triangle(next)[bisection.start(next)] == edge;
            t = next;
            agree
        })
    };
    assert!((0..6).all(|t| reaches_an_end(&bisection, t)));
    let mut turning = bisection;
    for (edge, corners) in turning.refinement_edge.iter_mut().zip(&turning.mesh.triangles) {
        *edge = corners.iter().position(|&a| a == 0).unwrap() as u8;
    }
    assert!(!reaches_an_end(&turning, 0), "each has chosen the edge on its right");
}
