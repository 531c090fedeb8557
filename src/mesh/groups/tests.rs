use proptest::prelude::*;

use crate::geometry::distance_sq;
use crate::mesh::samples::{irregular, renumbered, square};
use crate::mesh::{Bisection, GroupError, Mesh, MeshFamily, MeshSize, Pattern, generate, l_shape, polygon};
use crate::numeric::Random;
use crate::problem::Domain;

/// Rounding of sums over the triangles and edges of small meshes of size one.
const ROUNDING: f64 = 1e-12;

/// The length of a curve.
fn length(mesh: &Mesh, name: &str) -> f64 {
    let edges = mesh.groups().curve(name).unwrap_or_else(|| panic!("no curve {name}"));
    edges.map(|ends| distance_sq(mesh.points()[ends[0]], mesh.points()[ends[1]]).sqrt()).sum()
}

/// The area of a region.
fn area(mesh: &Mesh, name: &str) -> f64 {
    mesh.groups().region(name).expect("a region").map(|t| mesh.triangle_area(t)).sum()
}

/// Two regions that overlap and two curves that do, on the unit square.
fn named(mesh: Mesh) -> Mesh {
    mesh.with_region("west", |[x, _]| x < 0.5)
        .and_then(|mesh| mesh.with_region("south", |[_, y]| y < 0.5))
        .and_then(|mesh| mesh.with_curve("shore", |[_, y]| y < 1e-9))
        .and_then(|mesh| mesh.with_curve("western shore", |[x, y]| y < 1e-9 && x < 0.5 + 1e-9))
        .expect("names for parts that are there")
}

#[test]
fn regions_and_curves_overlap() {
    let mesh = named(square(4));
    let groups = mesh.groups();
    assert_eq!(groups.regions(), ["west", "south"]);
    assert!(groups.curves().iter().skip(4).eq(["shore", "western shore"]), "behind the sides");
    let lies = |t: usize, axis: usize| mesh.corners(t).iter().all(|corner| corner[axis] <= 0.5);
    for t in 0..mesh.triangles().len() {
        let expected: Vec<&str> = [("west", lies(t, 0)), ("south", lies(t, 1))]
            .iter()
            .filter(|(_, lies)| *lies)
            .map(|(n, _)| *n)
            .collect();
        assert_eq!(groups.regions_of(t), expected);
    }
    let west: Vec<usize> = groups.region("west").unwrap().collect();
    assert_eq!(west, (0..32).filter(|&t| lies(t, 0)).collect::<Vec<_>>());
    assert_eq!(groups.curve("western shore").unwrap().collect::<Vec<_>>(), [[0, 1], [1, 2]]);
    assert_eq!(groups.curves_of([1, 0]), ["bottom", "shore", "western shore"]);
    assert_eq!(groups.curves_of([3, 4]), ["bottom", "shore"]);
    assert!(
        groups.curves_of([0, 6]).is_empty()
            && groups.curve("shores").is_none()
            && groups.region("shore").is_none()
    );
}

#[test]
fn parts_are_named_by_their_numbers_too() {
    let by_place = named(square(4));
    let west: Vec<usize> = by_place.groups().region("west").unwrap().collect();
    // Ends in any order; the last edge lies inside.
    let mesh = square(4).with_region_of("west", west.iter().rev().copied().collect()).unwrap();
    let mesh = mesh.with_curve_of("shore", vec![[1, 0], [1, 2], [12, 6]]).unwrap();
    assert_eq!(mesh.groups().region("west").unwrap().collect::<Vec<_>>(), west);
    assert_eq!(mesh.groups().curve("shore").unwrap().collect::<Vec<_>>(), [[0, 1], [1, 2], [6, 12]]);

    let says = |named: Result<Mesh, GroupError>| named.unwrap_err().to_string();
    let beyond = says(square(1).with_region_of("a", vec![0, 2]));
    assert_eq!(beyond, "the region `a` names triangle 2, of 2: count from 0");
    assert!(square(1).with_region_of("a", vec![]).is_err() && square(1).with_curve_of("a", vec![]).is_err());
    for ends in [[1, 2], [0, 0], [0, 4], [4, 0]] {
        let no_edge = says(square(1).with_curve_of("a", vec![[0, 1], ends]));
        let [a, b] = ends;
        let expected = format!(
            "the curve `a` names an edge from vertex {a} to {b}, which no triangle has: give its two ends"
        );
        assert_eq!(no_edge, expected);
    }
}

#[test]
fn what_cannot_be_named_is_refused_with_the_remedy() {
    let mesh = || named(square(4));
    let nowhere = |_: [f64; 2]| false;
    let refused = |result: Result<Mesh, GroupError>| result.expect_err("refused").to_string();
    let table = [
        (mesh().with_region("west", |_| true), "there is a region `west` already: choose another name"),
        (mesh().with_curve("left", |_| true), "there is a curve `left` already: choose another name"),
        (
            mesh().with_region("a\nb", nowhere),
            "no triangle has its barycentre in the region `a\\nb`: refine the mesh, or make the region larger",
        ),
        (
            mesh().with_curve("crack", |[x, _]| x == 0.5),
            "no edge of the boundary lies on the curve `crack` with both ends and its midpoint: allow for rounding, as in |x| < 1e-9, or refine the mesh",
        ),
    ];
    for (result, message) in table {
        assert_eq!(refused(result), message);
    }
    // A region and a curve may be called alike; ends on a curve do not make an edge of it.
    assert!(
        mesh().with_curve("west", |[x, _]| x == 0.0).is_ok() && mesh().with_region("left", |_| true).is_ok()
    );
    assert!(square(1).with_curve("diagonal", |[x, y]| x == y).is_err());
    assert!(square(1).with_curve("corners", |[x, _]| x == 0.0 || x == 1.0).is_ok());
    let corners = |[x, y]: [f64; 2]| [x, y].iter().all(|&x| x == 0.0 || x == 1.0);
    assert!(square(1).with_curve("corners", corners).is_err());
}

#[test]
fn a_mesh_made_of_triangles_has_no_names() {
    let mesh = square(2);
    assert!(!mesh.groups().is_empty());
    let bare = Mesh::new(mesh.points().to_vec(), mesh.triangles().to_vec()).unwrap();
    assert!(bare.groups().is_empty() && bare.groups().curve("left").is_none());
    assert!(bare.refine().unwrap().mesh.groups().is_empty());
}

/// Domains, and the names and lengths of their sides.
fn domains() -> Vec<(Domain, Vec<(String, f64)>)> {
    let sides =
        |sides: &[(&str, f64)]| sides.iter().map(|&(name, length)| (name.to_string(), length)).collect();
    let vertices = vec![[0.0, 0.0], [0.0, 2.0], [1.0, 2.0], [3.0, 0.0]];
    let hole = vec![[0.5, 0.5], [1.0, 0.5], [0.5, 1.0]];
    let polygon = [
        ("outer", 6.0 + 8f64.sqrt()),
        ("side 1", 2.0),
        ("side 2", 1.0),
        ("side 3", 8f64.sqrt()),
        ("side 4", 3.0),
        ("hole 1", 1.0 + 0.5f64.sqrt()),
    ];
    vec![
        (
            Domain::Rectangle { lower: [-1.0, 2.0], upper: [1.0, 3.0] },
            sides(&[("left", 1.0), ("right", 1.0), ("bottom", 2.0), ("top", 2.0)]),
        ),
        (
            Domain::LShape { half_width: 1.5 },
            sides(&[("left", 3.0), ("right", 1.5), ("bottom", 1.5), ("top", 3.0), ("corner", 3.0)]),
        ),
        (Domain::Disk { centre: [1.0, 2.0], radius: 0.5 }, vec![("rim".to_string(), f64::NAN)]),
        (Domain::Polygon { vertices, holes: vec![hole] }, sides(&polygon)),
    ]
}

fn sizes(domain: &Domain) -> Vec<MeshSize> {
    let cells = [Pattern::Right, Pattern::Crossed].map(|pattern| MeshSize::Cells { cells: 4, pattern });
    let edges = MeshSize::EdgeLength { size: 0.3, min_angle: 25.0 };
    if matches!(domain, Domain::Polygon { .. }) { vec![edges] } else { [cells.as_slice(), &[edges]].concat() }
}

/// Every edge of the boundary has a name, and the sides have their lengths.
#[track_caller]
fn check_sides(mesh: &Mesh, domain: &Domain, sides: &[(String, f64)]) {
    let mut names: Vec<&str> = mesh.groups().curves().iter().collect();
    let mut expected: Vec<&str> = sides.iter().map(|(name, _)| name.as_str()).collect();
    names.sort_unstable();
    expected.sort_unstable();
    assert_eq!(names, expected);
    let boundary = crate::mesh::topology::boundary_edges(mesh);
    assert!(boundary.iter().all(|&ends| !mesh.groups().curves_of(ends).is_empty()));
    for (name, expected) in sides {
        let found = length(mesh, name);
        if let Domain::Disk { .. } = domain {
            assert_eq!(mesh.groups().curve(name).unwrap().count(), boundary.len());
        } else {
            assert!((found - expected).abs() < ROUNDING * expected, "{domain:?}, {name}: {found}");
        }
    }
}

#[test]
fn generators_name_their_sides() {
    for (domain, sides) in domains() {
        for size in sizes(&domain) {
            check_sides(&generate(&domain, size).unwrap(), &domain, &sides);
        }
    }
    // The sides lie where they are said to be.
    let mesh = l_shape(1.0, 3, Pattern::Crossed).unwrap();
    let on = |name: &str, is_on: &dyn Fn([f64; 2]) -> bool| {
        mesh.groups().curve(name).unwrap().flatten().all(|a| is_on(mesh.points()[a]))
    };
    assert!(on("left", &|[x, _]| x == -1.0) && on("right", &|[x, y]| x == 1.0 && y >= 0.0));
    assert!(on("top", &|[_, y]| y == 1.0) && on("bottom", &|[x, y]| y == -1.0 && x <= 0.0));
    assert!(on("corner", &|[x, y]| x == 0.0 && y <= 0.0 || y == 0.0 && x >= 0.0));
    assert!(!on("corner", &|[x, _]| x == 0.0));
}

#[test]
fn sides_of_polygons_follow_the_vertices_as_they_are_given() {
    let vertices = vec![[0.0, 0.0], [0.5, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]];
    let hole = vec![[0.2, 0.2], [0.4, 0.2], [0.3, 0.4]];
    let lengths = [0.5, 1.5, 1.0, 2.0, 1.0];
    let reversed = |ring: &[[f64; 2]]| ring.iter().rev().copied().collect::<Vec<_>>();
    for turned in [false, true] {
        let ring = if turned { reversed(&vertices) } else { vertices.clone() };
        let far = hole.iter().map(|[x, y]| [x + 1.0, *y]).collect::<Vec<_>>();
        let holes = [hole.clone(), if turned { reversed(&far) } else { far }];
        let mesh = polygon(&ring, &holes, 0.2, 25.0).unwrap();
        for k in 0..5 {
            // Reversed, the first side is the one before the last vertex.
            let expected = lengths[if turned { (8 - k) % 5 } else { k }];
            assert!(
                (length(&mesh, &format!("side {}", k + 1)) - expected).abs() < ROUNDING,
                "side {}",
                k + 1
            );
        }
        let is_far = |name: &str| {
            let points = mesh.groups().curve(name).unwrap().flatten().map(|a| mesh.points()[a][0] > 1.0);
            points.collect::<Vec<_>>()
        };
        assert!(is_far("hole 1").iter().all(|far| !far) && is_far("hole 2").iter().all(|far| *far));
        assert!((length(&mesh, "outer") - 6.0).abs() < ROUNDING);
    }
}

#[test]
fn rings_that_touch_at_a_point_keep_their_names() {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    // One hole has a corner on the boundary, and both a common one.
    let holes = [vec![[0.5, 0.0], [0.7, 0.3], [0.4, 0.3]], vec![[0.7, 0.3], [0.8, 0.6], [0.6, 0.6]]];
    let mesh = polygon(&square, &holes[..1], 0.1, 20.0).unwrap();
    let ring = |ring: &[[f64; 2]]| {
        let corner = |k: usize| ring[k % ring.len()];
        (0..ring.len()).map(|k| distance_sq(corner(k), corner(k + 1)).sqrt()).sum::<f64>()
    };
    assert!(
        (length(&mesh, "side 1") - 1.0).abs() < ROUNDING && (length(&mesh, "outer") - 4.0).abs() < ROUNDING
    );
    assert!((length(&mesh, "hole 1") - ring(&holes[0])).abs() < ROUNDING);
    // A side that runs back on itself is none.
    let spike = [[0.0, 0.0], [2.0, 0.0], [1.0, 0.0], [1.0, 1.0]];
    assert!(polygon(&spike, &[], 0.2, 0.0).unwrap_err().to_string().contains("a ring touches itself"));
}

/// The names of a mesh with the lengths and areas of what they stand for.
fn measures(mesh: &Mesh) -> Vec<(String, f64)> {
    let curves = mesh.groups().curves().iter().map(|name| (format!("curve {name}"), length(mesh, name)));
    let regions = mesh.groups().regions().iter().map(|name| (format!("region {name}"), area(mesh, name)));
    curves.chain(regions).collect()
}

fn same(one: &[(String, f64)], other: &[(String, f64)]) -> bool {
    let close = |(a, b): (&(String, f64), &(String, f64))| a.0 == b.0 && (a.1 - b.1).abs() < ROUNDING * a.1;
    one.len() == other.len() && one.iter().zip(other).all(close)
}

/// Some of the triangles, at random.
fn some(random: &mut Random, triangles: usize) -> Vec<usize> {
    (0..1 + triangles / 10).map(|_| random.below(triangles)).collect()
}

#[test]
fn every_refinement_of_every_generator_keeps_lengths_and_areas() {
    let mut random = Random::new(1);
    for (domain, _) in domains() {
        for size in sizes(&domain) {
            let mesh = generate(&domain, size).unwrap();
            let ([x0, y0], [x1, y1]) = mesh.bounding_box();
            let mesh = mesh
                .with_region("west", |[x, _]| x < 0.5 * (x0 + x1))
                .and_then(|mesh| mesh.with_region("south", |[_, y]| y < 0.5 * (y0 + y1)))
                .and_then(|mesh| mesh.with_curve("west", |[x, _]| x < 0.5 * (x0 + x1)))
                .unwrap();
            let before = measures(&mesh);
            let mut polygonal = MeshFamily::polygonal(mesh.clone());
            let mut bisection = Bisection::new(mesh);
            for _ in 0..3 {
                polygonal.refine().unwrap();
                let marked = some(&mut random, bisection.mesh().triangles().len());
                bisection.refine(&marked).unwrap();
                for refined in [polygonal.mesh(), bisection.mesh()] {
                    assert!(same(&before, &measures(refined)), "{:?}: {before:?}", measures(refined));
                }
            }
            let longer = before.iter().map(|(name, size)| (name.clone(), 1.001 * size)).collect::<Vec<_>>();
            assert!(!same(&longer, &measures(bisection.mesh())), "a thousandth is seen");
        }
    }
}

#[test]
fn a_disk_that_stays_round_has_all_of_its_rim() {
    let (centre, radius) = ([1.0, 2.0], 0.5);
    let domain = Domain::Disk { centre, radius };
    for size in sizes(&domain) {
        let mesh = generate(&domain, size).unwrap().with_region("east", |[x, _]| x > 1.0).unwrap();
        let mut family = MeshFamily::of_domain(mesh.clone(), &domain);
        let mut bisection = Bisection::of_domain(mesh, &domain);
        for _ in 0..3 {
            family.refine().unwrap();
            bisection.refine(&(0..bisection.mesh().triangles().len()).collect::<Vec<_>>()).unwrap();
        }
        for mesh in [family.mesh(), bisection.mesh()] {
            check_sides(mesh, &domain, &[("rim".into(), f64::NAN)]);
            let missing = |found: f64, exact: f64| 1.0 - found / exact;
            let rim = missing(length(mesh, "rim"), std::f64::consts::TAU * radius);
            assert!((0.0..1e-3).contains(&rim), "{rim} of the rim are missing");
            assert!((area(mesh, "east") / mesh.area() - 0.5).abs() < 0.1);
            assert_eq!(mesh.groups().regions(), ["east"]);
        }
    }
}

#[test]
fn a_graded_mesh_is_named_as_the_uniform_one() {
    let uniform = l_shape(1.0, 4, Pattern::Right).unwrap().with_region("upper", |[_, y]| y > 0.0).unwrap();
    let before = measures(&uniform);
    let mut family = MeshFamily::graded(uniform, [0.0, 0.0], 2.0).unwrap();
    for _ in 0..2 {
        assert!(same(&before, &measures(family.mesh())), "{:?}", measures(family.mesh()));
        family.refine().unwrap();
    }
    assert!(same(&before, &measures(family.mesh())));
}

/// What carries the names, as points, in an order that does not depend on the numbering.
fn as_points(mesh: &Mesh) -> Vec<(String, Vec<Vec<[u64; 2]>>)> {
    let sorted = |corners: &[usize]| {
        let mut points: Vec<[u64; 2]> = corners.iter().map(|&a| mesh.points()[a].map(f64::to_bits)).collect();
        points.sort_unstable();
        points
    };
    let groups = mesh.groups();
    let of_region = |name: &str| groups.region(name).unwrap().map(|t| sorted(&mesh.triangles()[t])).collect();
    let of_curve = |name: &str| groups.curve(name).unwrap().map(|ends| sorted(&ends)).collect();
    let regions = groups.regions().iter().map(|name| (format!("region {name}"), of_region(name)));
    let curves = groups.curves().iter().map(|name| (format!("curve {name}"), of_curve(name)));
    let mut all: Vec<(String, Vec<Vec<[u64; 2]>>)> = regions.chain(curves).collect();
    all.iter_mut().for_each(|(_, members)| members.sort_unstable());
    all
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn inheritance_commutes_with_renumbering(cells in 2..6usize, seed: u64, cut in 0.3..0.7f64) {
        let mesh = irregular(cells);
        let (other, _) = renumbered(&mesh, seed);
        let name = |mesh: Mesh| {
            named(mesh)
                .with_region("slanted", |[x, y]| x + 0.3 * y < cut)
                .and_then(|mesh| mesh.with_curve("sides", |[x, _]| !(1e-9..1.0 - 1e-9).contains(&x)))
                .unwrap()
        };
        let refined = |mesh: Mesh| mesh.refine().unwrap().mesh.refine().unwrap().mesh;
        let fine = as_points(&refined(name(mesh)));
        prop_assert!(fine == as_points(&refined(name(other.clone()))));
        prop_assert!(fine != as_points(&name(other.refine().unwrap().mesh)), "one refinement less");
    }

    /// The children of a triangle lie in it, the halves of an edge on it, whatever is marked.
    #[test]
    fn bisection_commutes_with_naming(cells in 1..4usize, seed: u64) {
        let mut random = Random::new(seed);
        let mut before = Bisection::new(named(square(2 * cells)));
        let mut after = Bisection::new(square(2 * cells));
        for _ in 0..5 {
            let marked = some(&mut random, before.mesh().triangles().len());
            before.refine(&marked).unwrap();
            after.refine(&marked).unwrap();
        }
        let (before, after) = (before.mesh(), named(Mesh::clone(after.mesh())));
        prop_assert!(as_points(before) == as_points(&after));
    }
}
