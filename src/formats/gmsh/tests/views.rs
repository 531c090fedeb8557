//! Data views, by hand: what they say, and what is wrong with them.

use super::super::scanner::ByteOrder;
use super::super::{GmshNote, GmshView, ViewData, ViewFault, ViewPlace};
use super::handmade::{MSH22, MSH41, Writer, binary_22, binary_41, edit};
use super::{read, refused};

/// A view in a section of this name at a time step, with the number of components before the records.
fn section(section: &str, name: &str, step: i32, components: i32, records: &[&str]) -> String {
    let (count, records) = (records.len(), records.join("\n"));
    format!(
        "${section}\n1\n\"{name}\"\n1\n0.5\n4\n{step}\n{components}\n{count}\n0\n{records}\n$End{section}\n"
    )
}

fn nodes(name: &str, records: &[&str]) -> String {
    section("NodeData", name, 0, 1, records)
}

fn elements(name: &str, records: &[&str]) -> String {
    section("ElementData", name, 0, 1, records)
}

/// The views of the triangle with nodes 1, 20, 30 (and 40 beside it), element 3, in both versions.
fn views(sections: &str) -> Vec<GmshView> {
    let [old, new] = [MSH22, MSH41].map(|mesh| read((mesh.to_owned() + sections).as_bytes()).views);
    // A NaN is not equal to itself, but is shown alike.
    assert_eq!(format!("{old:?}"), format!("{new:?}"));
    // They may stand before the mesh.
    let before = edit(MSH41, "$Nodes", &format!("{sections}$Nodes"));
    assert_eq!(format!("{:?}", read(before.as_bytes()).views), format!("{new:?}"));
    new
}

fn the_view(sections: &str) -> Result<ViewData, ViewFault> {
    let [GmshView { name, data }] = &views(sections)[..] else { panic!("one view") };
    assert_eq!(name, "soft p");
    data.clone()
}

fn at(place: ViewPlace, values: &[(u32, f64)], left_out: usize) -> Result<ViewData, ViewFault> {
    Ok(ViewData { place, values: values.to_vec(), left_out })
}

#[test]
fn values_come_to_the_vertices_and_triangles_of_their_tags() {
    use ViewPlace::{Triangles, Vertices};
    let records = ["30 -2.5", "1 1e-3", "20 7"];
    assert_eq!(the_view(&nodes("soft p", &records)), at(Vertices, &[(0, 1e-3), (1, 7.0), (2, -2.5)], 0));
    assert_eq!(the_view(&elements("soft p", &["3 4.5"])), at(Triangles, &[(0, 4.5)], 0));
    // Parts of one view; what the mesh does not have, also the line, is counted; the same value may be said twice.
    let parts = nodes("soft p", &["30 3", "20 2", "77 1"]) + &nodes("soft p", &["20 2", "1 1"]);
    assert_eq!(the_view(&parts), at(Vertices, &[(0, 1.0), (1, 2.0), (2, 3.0)], 1));
    assert_eq!(the_view(&elements("soft p", &["1 1", "2 2", "3 3"])), at(Triangles, &[(0, 3.0)], 2));
    assert_eq!(the_view(&nodes("soft p", &[])), at(Vertices, &[], 0));
    // MSH 2 of Gmsh has the tag 0 for all that it does not save; what is left out may be anything.
    assert_eq!(the_view(&elements("soft p", &["0 1", "3 5", "0 2", "0 nan"])), at(Triangles, &[(0, 5.0)], 3));
    let notes = read((MSH22.to_owned() + &elements("p", &["1 1", "2 2", "3 3"])).as_bytes()).notes;
    assert_eq!(notes, [GmshNote::ValuesLeftOut { view: "p".into(), values: 2 }]);
    // More texts than the name, fewer whole numbers, several on a line.
    let head = nodes("soft p", &["1 1"]).replace("$NodeData\n1\n", "$NodeData\n2\n");
    let head = head.replace("\"\n1\n0.5\n4\n0\n1\n1\n0\n", "\"\n\"a scheme\"\n0\n3 0 1 1\n");
    assert_eq!(the_view(&head), at(Vertices, &[(0, 1.0)], 0));
    let names: Vec<String> =
        views(&(nodes("b", &[]) + &elements("a", &[]))).into_iter().map(|view| view.name).collect();
    assert_eq!(names, ["a", "b"]);
}

#[test]
fn a_view_that_is_no_datum_says_why_and_does_no_harm_else() {
    let node =
        |name: &str, step, components, record: &str| section("NodeData", name, step, components, &[record]);
    let table = [
        (node("soft p", 0, 3, "1 1 2 3"), "has 3 components"),
        (node("soft p", 0, 0, "1"), "has 0 components"),
        (
            node("soft p", 0, 1, "1 1") + &node("soft p", 7, 1, "1 1"),
            "has several time steps, 0 and 7 among them",
        ),
        (nodes("soft p", &["1 1"]) + &elements("soft p", &["3 1"]), "is given at nodes and on elements"),
        (
            section("ElementNodeData", "soft p", 0, 1, &["3 3 1 2 3"]),
            "($ElementNodeData): save it as $NodeData",
        ),
        (
            nodes("soft p", &["1 1"]) + &section("ElementNodeData", "soft p", 0, 1, &[]),
            "for each corner of each element",
        ),
        (nodes("soft p", &["1 nan"]), "is NaN at Gmsh's number 1"),
        (elements("soft p", &["3 -1e999"]), "is -inf at Gmsh's number 3"),
        (nodes("soft p", &["1 1", "20 2", "1 3"]), "is 1 and 3 at Gmsh's number 1"),
        (elements("soft p", &["3 1", "3 2"]), "is 1 and 2 at Gmsh's number 3"),
    ];
    for (sections, words) in table {
        let why = the_view(&sections).unwrap_err().to_string();
        assert!(why.contains(words) && !why.contains('\n'), "{why}");
        assert_eq!(read((MSH22.to_owned() + &sections).as_bytes()).triangles.len(), 1);
    }
}

#[test]
fn elements_of_quadrangles_and_of_two_groups_have_one_value() {
    let quadrangle = edit(MSH22, "3 2 2 0 1 1 20 30", "3 3 2 0 1 1 20 40 30") + &elements("p", &["3 5"]);
    let found = read(quadrangle.as_bytes());
    assert_eq!(found.triangles.len(), 2);
    assert_eq!(found.views[0].data, at(ViewPlace::Triangles, &[(0, 5.0), (1, 5.0)], 0));
    // MSH 2 has a triangle of two groups twice, with a tag each.
    let twice = edit(MSH22, "$Elements\n3\n", "$Elements\n4\n")
        .replace("3 2 2 0 1 1 20 30\n", "3 2 2 4 1 1 20 30\n9 2 2 5 1 1 20 30\n");
    let of =
        |records: &[&str]| read((twice.clone() + &elements("p", records)).as_bytes()).views[0].data.clone();
    for records in [&["3 5"][..], &["9 5"], &["3 5", "9 5"]] {
        assert_eq!(of(records), at(ViewPlace::Triangles, &[(0, 5.0)], 0));
    }
    assert_eq!(of(&["3 5", "9 6"]), Err(ViewFault::Contradiction { tag: 3, values: [5.0, 6.0] }));
}

#[test]
fn binary_values_are_read_in_both_byte_orders() {
    for order in [ByteOrder::Little, ByteOrder::Big] {
        for mesh in [binary_41(order), binary_22(order, 2)] {
            let mut file = Writer(mesh, order);
            file.text("$NodeData\n1\n\"p\"\n1\n0\n3\n0\n1\n2\n");
            // A blank in a number is no blank: the first tag is 32 = ' '.
            file.ints(&[32]).doubles(&[1.5]).ints(&[20]).doubles(&[-2.0]).text("\n$EndNodeData\n");
            let views = read(&file.0).views;
            assert_eq!(views[0].data, at(ViewPlace::Vertices, &[(1, -2.0)], 1));
            let mut negative = Writer(file.0.clone(), order);
            negative
                .text("$NodeData\n1\n\"q\"\n1\n0\n3\n0\n1\n1\n")
                .ints(&[-1])
                .doubles(&[0.0])
                .text("\n$EndNodeData\n");
            assert!(refused(&negative.0).contains("$NodeData: expected the tag of a value, found `-1`"));
        }
    }
}

#[test]
fn a_broken_section_of_data_is_refused() {
    let whole = MSH22.to_owned() + &nodes("p", &["1 1", "20 2"]);
    let table = [
        (
            "\n2\n0\n1 1",
            "\n3\n0\n1 1",
            "line 29, $NodeData: expected the tag of a value, found `$EndNodeData`",
        ),
        ("\n2\n0\n1 1", "\n1\n0\n1 1", "line 28, $NodeData: expected `$EndNodeData`, found `20`"),
        ("\n2\n0\n1 1", "\n-2\n0\n1 1", "-2 values of a view are declared"),
        ("\n2\n0\n1 1", "\n9223372036854775807\n0\n1 1", "9223372036854775807 values of a view are declared"),
        ("4\n0\n1\n2\n0\n", "2\n0\n1\n", "expected three whole numbers of a view: time step, number of"),
        ("1\n0.5\n", "1\nhalf\n", "expected a real number of a view, found `half`"),
        ("1\n0.5\n", "9999\n0.5\n", "9999 real numbers of a view are declared"),
        ("$NodeData\n1\n", "$NodeData\n9999\n", "9999 texts of a view are declared"),
        ("20 2\n", "20\n", "expected a value of a view, found the end of the line"),
        ("20 2\n", "20 2 3\n", "expected the end of the line, found `3`"),
        ("20 2\n", "20 two\n", "expected a value of a view, found `two`"),
    ];
    for (from, to, message) in table {
        let found = refused(edit(&whole, from, to).as_bytes());
        assert!(found.contains(message), "{from:?} -> {to:?}: {found}");
    }
}

/// So Gmsh appends a view to a file: with the whole mesh before it.
#[test]
fn the_mesh_may_be_repeated_before_a_view_and_no_other_mesh() {
    for mesh in [MSH22, MSH41] {
        let file = format!("{mesh}{}{mesh}{}", nodes("p", &["1 1"]), elements("q", &["3 3"]));
        let found = read(file.as_bytes());
        assert_eq!(found.views.iter().map(|view| view.name.as_str()).collect::<Vec<_>>(), ["p", "q"]);
        assert_eq!(found.triangles.len(), 1);
        let (once, again) = file.split_at(mesh.len());
        let moved = edit(again, "5 5 0\n", "5 6 0\n");
        assert!(refused((once.to_owned() + &moved).as_bytes()).contains("a second section $Nodes"));
        let turned = edit(again, "1 20 30\n$", "1 30 20\n$");
        assert!(refused((once.to_owned() + &turned).as_bytes()).contains("a second section $Elements"));
    }
}
