//! Meshes that are made plane triangles: quadrangles, elements of higher order, planes in space, by hand.

use super::super::{FLATNESS, GmshNote};
use super::handmade::edit;
use super::{read, refused};

/// A square of two triangles, in which the height of node 40 is to be filled in; node 50 is in no triangle.
const TWO: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n\
    $Nodes\n5\n1 0 0 0\n20 1 0 0\n30 1 1 0\n40 0 1 Z\n50 0.3 0.4 77\n$EndNodes\n\
    $Elements\n2\n1 2 0 1 20 30\n2 2 0 1 30 40\n$EndElements\n";

#[test]
fn only_the_triangles_have_to_be_flat_up_to_a_tolerance() {
    let lift = |z: f64| edit(TWO, "Z", &format!("{z:e}"));
    let flat = read(lift(0.9 * FLATNESS).as_bytes());
    assert_eq!((flat.points[3..].to_vec(), flat.notes), (vec![[0.0, 1.0], [0.3, 0.4]], vec![]));
    // The plane through three of the corners is tilted along the diagonal.
    let message = refused(lift(4.0 * FLATNESS).as_bytes());
    assert!(
        message.starts_with(
            "the mesh is not flat: node 20 is 4.000e-8 away from the plane through the nodes 1, 30 and 40;"
        ),
        "{message}"
    );
    // The tolerance is relative to the size, here that of a mesh a thousand times larger.
    let large = lift(900.0 * FLATNESS).replace("\n20 1 0 0\n30 1 1 0", "\n20 1000 0 0\n30 1000 1 0");
    assert_eq!(read(large.as_bytes()).points[1], [1000.0, 0.0]);
    let huge = edit(&lift(1e300), "20 1 0 0", "20 1e308 0 0").replace("\n1 0 0 0", "\n1 -1e308 0 0");
    assert!(refused(huge.replace("1e300", "1.1e301").as_bytes()).contains("not flat"));
    assert_eq!(read(huge.as_bytes()).points[0], [-1e308, 0.0]);
}

#[test]
fn a_mesh_in_a_plane_of_space_gets_coordinates_there() {
    let level =
        TWO.replace(" 0\n20", " 3\n20").replace("20 1 0 0", "20 1 0 3").replace("30 1 1 0", "30 1 1 3");
    let found = read(edit(&level, "Z", "3").as_bytes());
    assert_eq!(found.points[..4], [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    assert_eq!(found.notes, [GmshNote::Level { z: 3.0 }]);
    // The plane z = 0.75 y of a mesh that is 0.8 wide there.
    let sloping = edit(TWO, "20 1 0 0\n30 1 1 0\n40 0 1 Z", "20 1 0 0\n30 1 0.8 0.6\n40 0 0.8 0.6");
    let found = read(sloping.as_bytes());
    let close = |p: [f64; 2], q: [f64; 2]| p.iter().zip(q).all(|(x, y)| (x - y).abs() < 1e-15);
    assert!(close(found.points[2], [1.0, 1.0]) && close(found.points[3], [0.0, 1.0]), "{:?}", found.points);
    let [GmshNote::Plane { .. }] = found.notes[..] else { panic!("{:?}", found.notes) };
    assert!(found.notes[0].to_string().ends_with("x is now x, y is now 0.8 y + 0.6 z"), "{}", found.notes[0]);
}

#[test]
fn quadrangles_are_cut_and_elements_of_higher_order_taken_by_their_corners() {
    let mixed = |version: &str| {
        // A quadrangle of nine nodes and a triangle of six on the rectangle [0, 3] x [0, 1], all lines on one side in a group.
        let nodes = "16\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 2 1 0\n5 1 1 0\n6 0 1 0\n7 3 0 0\n8 2.5 0 0\n9 2.5 0.5 0\n10 2 0.5 0\n11 0 0.5 0\n12 1 0.5 0\n13 9 9 0\n14 0.5 0 0\n15 0.5 1 0\n16 0.5 0.5 0\n";
        let elements = "1 8 2 5 1 1 2 14\n2 10 2 7 1 1 2 5 6 14 12 15 11 16\n3 3 2 7 1 2 3 4 5\n4 9 2 8 2 3 7 4 8 9 10\n";
        format!(
            "$MeshFormat\n{version} 0 8\n$EndMeshFormat\n$Nodes\n{nodes}$EndNodes\n$Elements\n4\n{elements}$EndElements\n"
        )
    };
    let found = read(mixed("2.2").as_bytes());
    assert_eq!(
        found.node_tags,
        [1, 2, 3, 4, 5, 6, 7, 13],
        "13 is in no element, and the others between corners"
    );
    assert_eq!(found.points[6..], [[3.0, 0.0], [9.0, 9.0]]);
    assert_eq!(found.triangles, [[0, 1, 4], [0, 4, 5], [1, 2, 3], [1, 3, 4], [2, 6, 3]]);
    assert_eq!(found.element_tags, [2, 2, 3, 3, 4]);
    assert_eq!(found.members.triangles, [(0, 1), (1, 1), (2, 1), (3, 1), (4, 2)]);
    assert_eq!(found.members.lines, [([0, 1], 0)]);
    assert_eq!(
        found.notes,
        [GmshNote::HigherOrder { elements: 3 }, GmshNote::Quadrangles { quadrangles: 2 }]
    );

    // The same in MSH 4.1, and a surface in two groups in MSH 2: cells that are repeated, one of them reversed.
    let v41 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 1 0\n1 0 0 0 3 1 0 1 7 0\n$EndEntities\n\
        $Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n$EndNodes\n\
        $Elements\n1 1 1 1\n2 1 3 1\n7 1 2 3 4\n$EndElements\n";
    let found = read(v41.as_bytes());
    assert_eq!((found.triangles, found.element_tags), (vec![[0, 1, 2], [0, 2, 3]], vec![7, 7]));
    assert_eq!(
        (found.members.triangles, found.notes),
        (vec![(0, 0), (1, 0)], vec![GmshNote::Quadrangles { quadrangles: 1 }])
    );
    let twice = edit(&mixed("2.2"), "4\n1 8", "5\n1 8");
    let twice =
        read(edit(&twice, "3 3 2 7 1 2 3 4 5\n", "3 3 2 7 1 2 3 4 5\n9 3 2 -8 1 3 2 5 4\n").as_bytes());
    assert_eq!(twice.triangles.len(), 5);
    assert_eq!(twice.members.triangles[2..], [(2, 1), (3, 1), (2, 2), (3, 2), (4, 2)]);
}
