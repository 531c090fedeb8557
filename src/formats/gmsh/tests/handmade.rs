//! Small files written here: what Gmsh allows but does not write by itself, and errors one at a time.

use super::super::scanner::ByteOrder;
use super::super::{GmshTriangulation, GroupMembers, nodes::Nodes};
use super::{read, refused};

/// A point, a line and a triangle in MSH 4.1.
pub(super) const MSH41: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n\
    $Nodes\n2 4 1 40\n0 1 0 1\n1\n0 0 0\n2 1 0 3\n20\n30\n40\n1 0 0\n0 1 0\n5 5 0\n$EndNodes\n\
    $Elements\n3 3 1 3\n0 1 15 1\n1 1\n1 1 1 1\n2 1 20\n2 1 2 1\n3 1 20 30\n$EndElements\n";

/// The same in MSH 4.0; the nodes of the triangle have a parameter each.
const MSH40: &str = "$MeshFormat\n4.0 0 8\n$EndMeshFormat\n\
    $Nodes\n2 4\n1 0 0 1\n1 0 0 0\n1 1 1 3\n20 1 0 0 0.5\n30 0 1 0 0.5\n40 5 5 0 0.5\n$EndNodes\n\
    $Elements\n3 3\n1 0 15 1\n1 1\n1 1 1 1\n2 1 20\n1 2 2 1\n3 1 20 30\n$EndElements\n";

/// The same in MSH 2.2.
pub(super) const MSH22: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n\
    $Nodes\n4\n1 0 0 0\n20 1 0 0\n30 0 1 0\n40 5 5 0\n$EndNodes\n\
    $Elements\n3\n1 15 2 0 1 1\n2 1 2 0 1 1 20\n3 2 2 0 1 1 20 30\n$EndElements\n";

fn triangle() -> GmshTriangulation {
    GmshTriangulation {
        points: vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [5.0, 5.0]],
        triangles: vec![[0, 1, 2]],
        node_tags: vec![1, 20, 30, 40],
        element_tags: vec![3],
        groups: vec![],
        members: GroupMembers::default(),
        views: vec![],
        notes: vec![],
    }
}

/// Exchanges a passage that must be there.
pub(super) fn edit(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from:?} is not in the file");
    text.replacen(from, to, 1)
}

#[test]
fn every_version_is_read() {
    assert_eq!(read(MSH41.as_bytes()), triangle());
    assert_eq!(read(MSH40.as_bytes()), triangle());
    assert_eq!(read(MSH22.as_bytes()), triangle());
    for version in ["2.20", "2.1", "2.0", "2"] {
        assert_eq!(read(edit(MSH22, "2.2 0", &format!("{version} 0")).as_bytes()), triangle());
    }
    assert_ne!(read(edit(MSH22, "1 20 30\n$", "1 30 20\n$").as_bytes()), triangle());
}

#[test]
fn unknown_sections_are_skipped_wherever_they_are() {
    let comment = "$Comments\n $EndComments\n$EndComment\n$Nodes\n7 $EndComments\n$EndComments\n";
    for before in ["$Nodes", "$Elements"] {
        assert_eq!(read(edit(MSH41, before, &format!("{comment}{before}")).as_bytes()), triangle());
    }
    assert_eq!(read(format!("\n{MSH41}{comment}$Empty\n$EndEmpty").as_bytes()), triangle());
    for text in [MSH41, MSH40, MSH22] {
        let commented = format!(
            "a comment\n$\n{comment}# another one\n{}rubbish\n\0\n",
            edit(text, "$Elements", "  text\n$ text\n$Elements")
        );
        assert_eq!(read(commented.as_bytes()), triangle());
    }
    let unclosed = refused(format!("{MSH41}$Comments\n$EndComment\n").as_bytes());
    assert!(unclosed.contains("line 28, $Comments: expected `$EndComments`, found the end"), "{unclosed}");
}

#[test]
fn blocks_count_and_totals_and_ranges_do_not() {
    for total in ["0", "3", "5", "9223372036854775808"] {
        assert_eq!(read(edit(MSH41, "2 4 1 40", &format!("2 {total} 7 6")).as_bytes()), triangle());
        assert_eq!(read(edit(MSH41, "3 3 1 3", &format!("3 {total} 7 6")).as_bytes()), triangle());
        assert_eq!(read(edit(MSH40, "$Nodes\n2 4", &format!("$Nodes\n2 {total}")).as_bytes()), triangle());
    }
}

#[test]
fn groups_are_those_of_the_elements_and_of_the_names() {
    let found = |text: &str| -> Vec<String> {
        let groups = read(text.as_bytes()).groups;
        groups.iter().map(|group| format!("{} {} {group}", group.dimension, group.tag)).collect()
    };
    let names = |names: &str| {
        let labelled = edit(MSH22, "3 2 2 0 1", "3 2 2 -7 1");
        edit(&labelled, "$Nodes", &format!("$PhysicalNames\n{names}$EndPhysicalNames\n$Nodes"))
    };
    assert_eq!(found(MSH22), [""; 0]);
    assert_eq!(found(&names("0\n")), ["2 7 surfaces 7"]);
    // A name may hold blanks; one without marks, or for a group of another dimension, is none of it.
    assert_eq!(found(&names("1\n2 7 \"soft rubber\"\n")), ["2 7 soft rubber"]);
    assert_eq!(found(&names("2\n2 7 rubber\n1 7 \"edge\"\n")), ["1 7 edge", "2 7 surfaces 7"]);
    let without_dimensions = edit(&names("2\n7 \"rubber\"\n8 \"edge\"\n"), "2.2 0", "2 0");
    assert_eq!(found(&without_dimensions), ["2 7 rubber"]);
    // MSH 4: a surface in two groups, a curve in one, a point in none; lines mean nothing.
    let entities =
        "$Entities\n1 1 1 0\n1 0 0 0 0\n1 0 0 0 1 1 0 1 -4 2 1 -1\n1 0 0 0\n1 1 0 2\n5 6 0\n$EndEntities\n";
    assert_eq!(
        found(&edit(MSH41, "$Nodes", &format!("{entities}$Nodes"))),
        ["1 4 curves 4", "2 5 surfaces 5", "2 6 surfaces 6"]
    );
    let refusals = [
        (names("1\n4 7 \"a\"\n"), "line 6, $PhysicalNames: expected a dimension from 0 to 3, found `4`"),
        (
            names("2\n2 7 \"a\"\n"),
            "line 7, $PhysicalNames: expected a dimension from 0 to 3, found `$EndPhysicalNames`",
        ),
        (names("9999\n"), "9999 names are declared"),
        (
            edit(MSH41, "$Nodes", &format!("{}$Nodes", edit(entities, "1 1 1 0", "1 1 2 0"))),
            "$Entities: expected the tag of an entity",
        ),
        (
            edit(MSH41, "$Nodes", &format!("{}$Nodes", edit(entities, "0 2\n", "0 999\n"))),
            "999 physical groups of an entity are declared",
        ),
    ];
    for (text, message) in refusals {
        let found = refused(text.as_bytes());
        assert!(found.contains(message), "{found}");
    }
}

#[test]
fn each_error_in_msh_41_has_its_message() {
    let table = [
        ("4.1 0 8", "4.2 0 8", "MSH version 4.2 is not read"),
        ("4.1 0 8", "4.1 2 8", "line 2, $MeshFormat: expected the type of the file, 0 or 1, found `2`"),
        ("4.1 0 8", "4.1 1 4", "numbers of 4 bytes are not read"),
        ("4.1 0 8", "4.0 1 8", "binary MSH 4.0 is not read"),
        ("4.1 0 8", "4.1 0", "line 2, $MeshFormat: expected the size of a number, found the end of the line"),
        ("4.1 0 8", "4.1 1 8", "$MeshFormat: bytes [36, 69, 110, 100] where"),
        (
            "$EndMeshFormat",
            "$EndFormat",
            "line 3, $MeshFormat: expected `$EndMeshFormat`, found `$EndFormat`",
        ),
        ("2 4 1 40", "18446744073709551615 4 1 40", "18446744073709551615 blocks are declared, but"),
        ("2 4 1 40", "2 99999999999999999999 1 40", "expected a count, found `99999999999999999999`"),
        ("2 4 1 40", "3 4 1 40", "line 16, $Nodes: expected the dimension of an entity, found `$EndNodes`"),
        ("2 4 1 40", "1 4 1 40", "line 9, $Nodes: expected `$EndNodes`, found `2`"),
        ("2 1 0 3", "2 1 0 -3", "expected a count, found `-3`"),
        ("2 1 0 3", "2 1 0 4", "expected the end of the line, found `0`"),
        ("2 1 0 3", "2 1 2 3", "line 9, $Nodes: expected a dimension from 0 to 3 and parametric 0 or 1"),
        ("2 1 0 3", "2 1 1 3", "line 13, $Nodes: expected a parameter of a node, found the end of the line"),
        ("0 1 0 1\n1", "0 1 0 1\n20", "nodes number 1 and 2 both have the tag 20"),
        ("\n30\n", "\n1\n", "nodes number 1 and 3 both have the tag 1"),
        ("0 1 0\n5", "0 1 0 7\n5", "line 14, $Nodes: expected the end of the line, found `7`"),
        ("0 1 0\n5", "0 1,0 0\n5", "line 14, $Nodes: expected the y of a node, found `1,0`"),
        ("0 1 0\n5", "0 nan 0\n5", "node 30 has a coordinate NaN"),
        ("5 5 0", "5 -inf 0", "node 40 has a coordinate -inf"),
        ("5 5 0", "5 5 1e999", "node 40 has a coordinate inf"),
        ("3 1 20 30", "3 1 20 31", "line 24, $Elements: triangle 3 names the node 31"),
        ("3 1 20 30", "3 1 0 30", "triangle 3 names the node 0"),
        ("3 1 20 30", "3 1 18446744073709551615 30", "triangle 3 names the node 18446744073709551615"),
        ("3 1 20 30", "3 1 20", "line 24, $Elements: expected the node tag of an element, found the end of"),
        ("2 1 2 1", "2 1 3 1", "line 24, $Elements: expected the node tag of an element, found the end"),
        ("2 1 2 1", "2 1 9 1", "line 24, $Elements: expected the node tag of an element, found the end"),
        ("2 1 2 1\n3 1 20 30", "2 1 3 1\n3 1 20 30 31", "line 24, $Elements: quadrangle 3 names the node 31"),
        ("2 1 2 1\n3 1 20 30", "2 1 3 1\n3 1 40 20 30", "quadrangle 3 cannot be cut in two triangles"),
        ("2 1 2 1", "2 1 34 1", "such elements (element type 34) are not read; mesh a plane surface"),
        ("2 1 2 1", "2 1 5 1", "volume elements (element type 5)"),
        ("2 1 2 1", "2 1 -7 1", "such elements (element type -7)"),
        ("3 3 1 3", "2 2 1 3", "line 23, $Elements: expected `$EndElements`, found `2`"),
        (
            "3 3 1 3\n0 1 15 1\n1 1\n1 1 1 1\n2 1 20\n2 1 2 1\n3 1 20 30",
            "0 0 0 0",
            "no triangle or quadrangle among",
        ),
        ("$Elements", "$Nodes", "line 17: a second section $Nodes"),
        ("$EndElements", "$EndElements\n$EndElements", "found `$EndElements`"),
    ];
    for (from, to, message) in table {
        let found = refused(edit(MSH41, from, to).as_bytes());
        assert!(found.contains(message), "{from:?} -> {to:?}: {found}");
    }
}

#[test]
fn each_error_in_msh_22_has_its_message() {
    let table = [
        ("$Nodes\n4", "$Nodes\n9223372036854775808", "9223372036854775808 nodes are declared, but"),
        ("$Nodes\n4", "$Nodes\n3", "line 9, $Nodes: expected `$EndNodes`, found `40`"),
        ("$Nodes\n4", "$Nodes\n5", "line 10, $Nodes: expected a node tag, found `$EndNodes`"),
        ("$Nodes\n4", "$Nodes\n-4", "expected a number of records, found `-4`"),
        ("20 1 0 0", "-20 1 0 0", "expected a node tag, found `-20`"),
        ("20 1 0 0", "20 1 0", "line 7, $Nodes: expected the z of a node, found the end of the line"),
        ("20 1 0 0", "1 1 0 0", "nodes number 1 and 2 both have the tag 1"),
        ("3 2 2 0 1 1 20 30", "3 2 2 0 1 1 20 30 40", "line 15, $Elements: expected the end of the line"),
        ("3 2 2 0 1 1 20 30", "3 2 2 0 1 1 20 50", "line 15, $Elements: triangle 3 names the node 50"),
        ("3 2 2 0 1 1 20 30", "3 2 -2 0 1 1 20 30", "-2 labels of an element are declared, but"),
        ("3 2 2 0 1 1 20 30", "3 2 2147483647 0", "2147483647 labels of an element are declared, but"),
        ("3 2 2 0 1 1 20 30", "3 3 2 0 1 1 20 30", "line 15, $Elements: expected the node tag of an element"),
        ("3 2 2 0 1 1 20 30", "3 3 2 0 1 1 30 20 40", "quadrangle 3 cannot be cut in two triangles"),
        (
            "3 2 2 0 1 1 20 30",
            "3 9 2 0 1 1 20 30 1 20 -30",
            "expected the node tag of an element, found `-30`",
        ),
        (
            "$Nodes",
            "$ParametricNodes",
            "line 6, $ParametricNodes: expected the dimension of an entity, found the end",
        ),
        ("$Nodes", "$Elements", "there is no section $Nodes before $Elements"),
    ];
    for (from, to, message) in table {
        let found = refused(edit(MSH22, from, to).as_bytes());
        assert!(found.contains(message), "{from:?} -> {to:?}: {found}");
    }
    let (front, _) = MSH22.split_once("$Elements").expect("a section");
    assert!(refused(front.as_bytes()).contains("there is no section $Elements"));
    let (front, _) = MSH22.split_once("$Nodes").expect("a section");
    assert!(refused(front.as_bytes()).contains("there is no section $Nodes"));
}

#[test]
fn what_is_no_gmsh_file_is_called_so() {
    for bytes in [
        &b""[..],
        b"\n\n",
        b"$",
        b"$Mesh",
        b"$Mesh\n$EndMesh\n",
        b"$Nodes\n1\n",
        b"PK\x03\x04",
        b"Point(1) = {0, 0, 0};",
        b"\xff\xfe$\0M\0",
    ] {
        assert!(refused(bytes).starts_with("not a Gmsh mesh"));
    }
    assert!(refused(b"$NOD\n1\n").starts_with("MSH version 1"));
}

/// Writes binary numbers.
pub(super) struct Writer(pub(super) Vec<u8>, pub(super) ByteOrder);

impl Writer {
    pub(super) fn text(&mut self, text: &str) -> &mut Self {
        self.0.extend(text.as_bytes());
        self
    }

    fn number<const N: usize>(&mut self, mut little: [u8; N]) {
        if self.1 == ByteOrder::Big {
            little.reverse();
        }
        self.0.extend(little);
    }

    pub(super) fn ints(&mut self, values: &[i32]) -> &mut Self {
        values.iter().for_each(|value| self.number(value.to_le_bytes()));
        self
    }

    fn sizes(&mut self, values: &[u64]) -> &mut Self {
        values.iter().for_each(|value| self.number(value.to_le_bytes()));
        self
    }

    pub(super) fn doubles(&mut self, values: &[f64]) -> &mut Self {
        values.iter().for_each(|value| self.number(value.to_le_bytes()));
        self
    }
}

const COORDINATES: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [5.0, 5.0, 0.0]];

pub(super) fn binary_41(order: ByteOrder) -> Vec<u8> {
    let mut file = Writer(Vec::new(), order);
    file.text("$MeshFormat\n4.1 1 8\n").ints(&[1]).text("\n$EndMeshFormat\n$Nodes\n");
    file.sizes(&[1, 4, 1, 40])
        .ints(&[2, 1, 0])
        .sizes(&[4, 1, 20, 30, 40])
        .doubles(COORDINATES.as_flattened());
    file.text("\n$EndNodes\n$Elements\n")
        .sizes(&[2, 3, 1, 3])
        .ints(&[1, 1, 1])
        .sizes(&[2, 1, 1, 20, 2, 20, 30]);
    file.ints(&[2, 1, 2]).sizes(&[1, 3, 1, 20, 30]).text("\n$EndElements\n");
    file.0
}

pub(super) fn binary_22(order: ByteOrder, run: i32) -> Vec<u8> {
    let mut file = Writer(Vec::new(), order);
    file.text("$MeshFormat\n2.2 1 8\n").ints(&[1]).text("\n$EndMeshFormat\n$Nodes\n4\n");
    for (tag, point) in [1, 20, 30, 40].into_iter().zip(&COORDINATES) {
        file.ints(&[tag]).doubles(point);
    }
    file.text("\n$EndNodes\n$Elements\n3\n").ints(&[1, run, 2, 1, 0, 1, 1, 20, 2, 0, 1, 20, 30]);
    file.ints(&[2, 1, 3, 3, 0, 1, -2, 1, 20, 30]).text("\n$EndElements\n");
    file.0
}

#[test]
fn both_byte_orders_are_read() {
    for order in [ByteOrder::Little, ByteOrder::Big] {
        assert_eq!(read(&binary_41(order)), triangle());
        assert_eq!(read(&binary_22(order, 2)), triangle());
        // The length of the run is at the bytes 188 to 191.
        for run in [-1, 0, 4, i32::MAX] {
            let message = refused(&binary_22(order, run));
            let expected = format!("the number of elements of a run, from 1 to 3, found `{run}`");
            assert!(message.contains("byte 192,") && message.contains(&expected), "{message}");
        }
    }
    let mut wrong = binary_41(ByteOrder::Little);
    wrong[20..24].copy_from_slice(&2i32.to_le_bytes());
    assert!(refused(&wrong).contains("bytes [2, 0, 0, 0] where a binary file has the integer 1"));
}

#[test]
fn nodes_are_found_by_any_set_of_tags() {
    for tags in [vec![], vec![5], (10..20).collect(), vec![u64::MAX, 0, 7, 9, 8, 1 << 40], vec![3, 1, 2, 9]] {
        let nodes =
            Nodes::new(tags.clone(), vec![[0.0; 2]; tags.len()], vec![0.0; tags.len()]).expect("distinct");
        let near = tags.iter().flat_map(|&tag| [tag, tag.wrapping_add(1), tag.wrapping_sub(1)]);
        for tag in near.chain([0, 1, u64::MAX]) {
            assert_eq!(nodes.index(tag), tags.iter().position(|&other| other == tag), "{tag} in {tags:?}");
        }
    }
}
