//! Inputs that are made to break a reader: deep, long, or declaring what they do not hold.

use std::io::{Cursor, Write};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// Levels of what is nested.
const DEEP: usize = 100_000;

/// Length of what is long, bytes.
const LONG: usize = 1 << 20;

/// The inputs for a target, by what they are.
pub fn of(target: &str) -> Vec<(String, Vec<u8>)> {
    let bombs: Vec<(&str, Vec<u8>)> = match target {
        "expression" => expressions().into_iter().map(|(name, text)| (name, text.into_bytes())).collect(),
        "case_file" => case_files().into_iter().map(|(name, text)| (name, text.into_bytes())).collect(),
        "gmsh" => gmsh_files(),
        "checkpoint" => checkpoints(),
        "answer" => answers(),
        "rows" => vec![
            ("many curves", curves()),
            ("one long cell", vec![b'x'; LONG]),
            ("cells", b",".repeat(LONG)),
            ("rows", b"\n1".repeat(LONG / 2)),
        ],
        _ => Vec::new(),
    };
    bombs.into_iter().map(|(name, bytes)| (name.to_owned(), bytes)).collect()
}

fn expressions() -> Vec<(&'static str, String)> {
    let nested = |open: &str, close: &str| format!("{}x{}", open.repeat(DEEP), close.repeat(DEEP));
    let short = |open: &str, close: &str| format!("{}x{}", open.repeat(9_000), close.repeat(9_000));
    vec![
        ("parentheses", nested("(", ")")),
        ("parentheses within the limit of bytes", short("(", ")")),
        ("sums in parentheses within the limit of bytes", short("(1+", ")")),
        ("calls", nested("sin(", ")")),
        ("signs", nested("-", "")),
        ("negations", nested("not ", "")),
        ("powers", nested("x^", "")),
        ("open parentheses", "(".repeat(60_000)),
        ("a name", "a".repeat(60_000)),
        ("a number", "9".repeat(60_000)),
        ("an exponent", "1e999999999999999999999".into()),
        ("a negative exponent", "1e-999999999999999999999".into()),
    ]
}

/// What a case file is without its load.
const CASE: &str = "[membranes]\ntension = [1, 3]\nload = ";

fn case_files() -> Vec<(&'static str, String)> {
    let in_case = |value: &str| format!("{CASE}{value}\n[domain]\nshape = \"square\"\n");
    let deep = |open: &str, close: &str| format!("{}{}", open.repeat(DEEP), close.repeat(DEEP));
    let many = |line: &dyn Fn(usize) -> String| (0..LONG / 16).map(line).collect::<String>();
    vec![
        ("a deep array", in_case(&deep("[", "]"))),
        ("a deep table", in_case(&format!("{}1{}", "{a = ".repeat(DEEP), "}".repeat(DEEP)))),
        ("a deep key", format!("{}a = 1", "a.".repeat(DEEP))),
        ("a deep heading", format!("[{}a]", "a.".repeat(DEEP))),
        ("a deep expression", in_case(&format!("[1, \"{}\"]", deep("(", ")")))),
        ("a long expression", in_case(&format!("[1, \"{}\"]", "x+".repeat(LONG)))),
        ("a long key", format!("{} = 1", "a".repeat(LONG))),
        ("a long key beside others", format!("{} = 1\n{}", "a".repeat(LONG), in_case("[1, 2]"))),
        ("a long unknown case", format!("case = \"{}\"", "\u{1f980}".repeat(LONG / 4))),
        ("many keys", many(&|k| format!("k{k} = 1\n"))),
        ("many dotted keys", many(&|k| format!("k{k}.a = 1\n"))),
        ("many tables", many(&|k| format!("[k{k}]\na = 1\n"))),
        ("many arrays of tables", many(&|_| "[[a]]\nb.c = 1\n".into())),
        ("many empty arrays", in_case(&format!("[{}]", "[],".repeat(LONG / 3)))),
        ("many inline tables", in_case(&format!("[{}]", "{a.b=1},".repeat(LONG / 8)))),
        ("a polygon of many corners", polygon()),
        ("huge numbers", "[membranes]\ntension = [1e999, 1]\nload = [99999999999999999999999, 1]".into()),
        ("a count of 2^63", format!("{}[mesh]\ncells = 9223372036854775808\n", in_case("[1, 2]"))),
        (
            "the largest count",
            format!(
                "{}[mesh]\ncells = 9223372036854775807\nrefine = 9223372036854775807\n",
                in_case("[1, 2]")
            ),
        ),
    ]
}

/// Rows that have nothing in common.
fn curves() -> Vec<u8> {
    let columns = "problem,n,vertices,solver,origin,threads,status,certified,residual,iterations,setup_seconds,\
                   solve_seconds,certify_seconds,total_seconds,work_unit_seconds,work_units,contact_vertices\n";
    let rows: String = (0..LONG / 32).map(|k| format!("{k},,{k},,,,,true,,,,,,1,,,\n")).collect();
    (columns.to_owned() + &rows).into_bytes()
}

fn polygon() -> String {
    let corners: String = (0..LONG / 16).map(|k| format!("[{k}, {}], ", k * k)).collect();
    format!("{CASE}[1, 2]\n[domain]\nshape = \"polygon\"\nvertices = [{corners}]\n[mesh]\nsize = 1\n")
}

fn gmsh_files() -> Vec<(&'static str, Vec<u8>)> {
    const V2: &str = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
    const V40: &str = "$MeshFormat\n4 0 8\n$EndMeshFormat\n";
    const V4: &str = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
    let binary = |version: &str, nodes: &[&[u8]]| {
        let head = format!("$MeshFormat\n{version} 1 8\n");
        [head.as_bytes(), &1i32.to_le_bytes(), b"\n$EndMeshFormat\n$Nodes\n", &nodes.concat()].concat()
    };
    let count = (1u64 << 63).to_le_bytes();
    let one = 1u64.to_le_bytes();
    let text = |text: String| text.into_bytes();
    // As many as there are bytes left are accepted where each takes a byte at least.
    let zeros = vec![b'0'; LONG];
    [
        ("2^63 nodes, 2.2", text(format!("{V2}$Nodes\n9223372036854775808\n1 0 0 0\n$EndNodes\n"))),
        (
            "2^63 nodes, 4.1",
            text(format!("{V4}$Nodes\n1 9223372036854775808 1 9\n2 1 0 9223372036854775808\n")),
        ),
        (
            "2^63 nodes, 4.0",
            text(format!("{V40}$Nodes\n1 9223372036854775808\n1 2 0 9223372036854775808\n1 0 0 0\n")),
        ),
        ("as many nodes as bytes, 4.0", [V40.as_bytes(), b"$Nodes\n1 1\n1 2 0 1048576\n", &zeros].concat()),
        ("2^63 names", text(format!("{V4}$PhysicalNames\n9223372036854775808\n"))),
        ("names", text(format!("{V4}$PhysicalNames\n{}\n{}$EndPhysicalNames\n", LONG / 8, names(LONG / 8)))),
        ("2^63 entities", text(format!("{V4}$Entities\n0 9223372036854775808 0 0\n"))),
        ("groups of an entity", {
            let groups: String = (1..LONG / 8).map(|k| format!("{k} ")).collect();
            text(format!("{V4}$Entities\n1 0 0 0\n1 0 0 0 {} {groups}\n$EndEntities\n", LONG / 8 - 1))
        }),
        ("groups of elements", {
            let points: String = (1..LONG / 16).map(|k| format!("1 15 1 {k} 1\n")).collect();
            text(format!(
                "{V2}$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n{}\n{points}$EndElements\n",
                LONG / 16 - 1
            ))
        }),
        ("comments", [&b"#\n".repeat(LONG / 2), V2.as_bytes(), &b"$\n$ \n".repeat(LONG / 5)].concat()),
        ("2^63 blocks, 4.1", text(format!("{V4}$Nodes\n9223372036854775808 1 1 1\n"))),
        ("2^64 nodes", text(format!("{V2}$Nodes\n18446744073709551616\n"))),
        ("2^63 nodes, 2.2 binary", binary("2.2", &[b"9223372036854775808\n"])),
        ("2^63 nodes, 4.1 binary", binary("4.1", &[&one, &count, &one, &count, &[0; 12], &count])),
        ("as many nodes as bytes", [V2.as_bytes(), b"$Nodes\n1048576\n", &zeros].concat()),
        ("as many nodes as bytes, 4.1 binary", {
            let length = (LONG as u64).to_le_bytes();
            binary("4.1", &[&one, &length, &one, &length, &[0; 12], &length, &zeros])
        }),
        ("empty blocks", {
            let blocks = (LONG as u64 / 20).to_le_bytes();
            binary("4.1", &[&blocks, &[0; 24], &vec![0; LONG]])
        }),
        (
            "labels",
            [
                V2.as_bytes(),
                b"$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 2 1048576 ",
                &b"0 ".repeat(LONG),
            ]
            .concat(),
        ),
        ("a long section", [V2.as_bytes(), b"$", &zeros, b"\n$End"].concat()),
        ("sections that do not end", [V2.as_bytes(), b"$A\n", &b"\n$EndB".repeat(LONG / 6)].concat()),
        ("many sections", [V2.as_bytes(), &b"$A\n$EndA\n".repeat(LONG / 9)].concat()),
        ("a fan", text(fan(20_000))),
        ("values", text(fan(3) + &view("NodeData", LONG / 4, 1, &"1 0\n".repeat(LONG / 4)))),
        (
            "values that grow",
            text(
                fan(3)
                    + &(1..LONG / 16)
                        .map(|k| view("NodeData", 1, 1, &format!("{k} 0\n")))
                        .collect::<String>(),
            ),
        ),
        (
            "values that are not there",
            text(fan(3) + &view("ElementData", LONG, 1, &"1 0\n".repeat(LONG / 8)) + &" ".repeat(LONG)),
        ),
        ("2^31 components", text(fan(3) + &view("NodeData", 1, i32::MAX, &"1 ".repeat(LONG / 2)))),
        (
            "views",
            text(
                fan(3)
                    + &(0..LONG / 64)
                        .map(|k| {
                            view(
                                &format!("NodeData\n1\n\"{k}\"\n0\n3\n0\n1\n0\n$EndNodeData\n$ElementData"),
                                0,
                                1,
                                "",
                            )
                        })
                        .collect::<String>(),
            ),
        ),
        ("the mesh again and again", text((fan(2_000) + &view("NodeData", 0, 1, "")).repeat(20))),
        ("the same triangle", text(same_triangle(20_000))),
    ]
    .into_iter()
    .chain(grouped_meshes().into_iter().map(|(name, mesh)| (name, text(mesh))))
    .collect()
}

/// Meshes with many physical groups, or many members of them.
fn grouped_meshes() -> Vec<(&'static str, String)> {
    const NODES: [&str; 2] =
        ["3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n", "1 3 1 3\n2 1 0 3\n1\n2\n3\n0 0 0\n1 0 0\n0 1 0\n"];
    let v2 = |n: usize, elements: String| {
        let nodes = NODES[0];
        format!(
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{nodes}$EndNodes\n$Elements\n{}\n{elements}1 2 0 1 2 3\n$EndElements\n",
            n + 1
        )
    };
    let v4 = |entities: String, n: usize, blocks: String| {
        let nodes = NODES[1];
        format!(
            "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n{entities}$EndEntities\n$Nodes\n{nodes}$EndNodes\n$Elements\n{} 0 0 0\n{blocks}2 1 2 1\n1 1 2 3\n$EndElements\n",
            n + 1
        )
    };
    let list = |groups: std::ops::Range<usize>| groups.map(|k| format!("{k} ")).collect::<String>();
    let n = LONG / 16;
    // So many lines lie in pairs of so many curves, each in so many groups.
    let (curves, groups) = (200, 500);
    let pairs = (0..curves).flat_map(|j| (0..j).map(move |k| [j, k]));
    let pairs: Vec<[usize; 2]> = pairs.collect();
    let in_both =
        pairs.iter().map(|[j, k]| format!("1 {} 1 1\n1 1 2\n1 {} 1 1\n1 1 2\n", j + 1, k + 1)).collect();
    let all = list(1..groups + 1);
    let curve = |k: usize| format!("{k} 0 0 0 0 0 0 {groups} {all}0\n");
    vec![
        ("a group for each line", v2(n, (1..=n).map(|k| format!("1 1 1 {k} 1 2\n")).collect())),
        ("a triangle in many groups", v2(n, (1..=n).map(|k| format!("1 2 1 {k} 1 2 3\n")).collect())),
        ("a line in one group again and again", v2(n, "1 1 1 1 1 2\n".repeat(n))),
        (
            "many groups of a surface",
            v4(format!("0 0 1 0\n1 0 0 0 0 0 0 {n} {}0\n", list(1..n + 1)), 0, String::new()),
        ),
        (
            "a line in many curves of many groups",
            v4(
                format!("0 {curves} 0 0\n{}", (1..=curves).map(curve).collect::<String>()),
                2 * pairs.len(),
                in_both,
            ),
        ),
        (
            "curves of one line, which has a node that is not there",
            v4("0 0 0 0\n".into(), n, (1..=n).map(|k| format!("1 {} 1 1\n1 9 9\n", k % 2)).collect()),
        ),
        ("a thousand groups of a thousand triangles and edges", thousands(1000)),
        (
            "quadrangles",
            v2(n, (1..=n).map(|k| format!("{k} 3 0 1 2 4 {}\n", [3, 5][k % 2])).collect())
                .replace("3\n1 0 0 0", "5\n4 1 1 0\n5 -1 1 0\n1 0 0 0"),
        ),
        ("a node between corners again and again", v2(n, "1 8 0 1 2 3\n".repeat(n))),
    ]
}

/// A fan of `n` triangles in `n` groups, its boundary in as many.
fn thousands(n: usize) -> String {
    let groups: String = (1..=n).map(|k| format!("{k} ")).collect();
    let names: String =
        [1, 2].iter().flat_map(|d| (1..=n).map(move |k| format!("{d} {k} \"group {k}\"\n"))).collect();
    let mut text = format!(
        "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n{}\n{names}$EndPhysicalNames\n$Entities\n0 1 1 0\n1 0 0 0 0 0 0 {n} {groups}0\n1 0 0 0 0 0 0 {n} {groups}0\n$EndEntities\n$Nodes\n1 {} 1 {}\n2 1 0 {}\n",
        2 * n,
        n + 1,
        n + 1,
        n + 1
    );
    (1..=n + 1).for_each(|k| text += &format!("{k}\n"));
    for k in 0..n {
        let angle = std::f64::consts::TAU * k as f64 / n as f64;
        text += &format!("{} {} 0\n", angle.cos(), angle.sin());
    }
    text += &format!("0 0 0\n$EndNodes\n$Elements\n2 {} 1 {}\n1 1 1 {n}\n", 2 * n, 2 * n);
    (0..n).for_each(|k| text += &format!("{} {} {}\n", k + 1, k + 1, (k + 1) % n + 1));
    text += &format!("2 1 2 {n}\n");
    (0..n).for_each(|k| text += &format!("{} {} {} {}\n", n + k + 1, n + 1, k + 1, (k + 1) % n + 1));
    text + "$EndElements\n"
}

/// Names of one letter, each of a group of its own.
fn names(n: usize) -> String {
    (1..=n).map(|k| format!("1 {k} \"a\"\n")).collect()
}

/// A section of data of so many values.
fn view(section: &str, values: usize, components: i32, records: &str) -> String {
    let end = section.lines().last().unwrap_or(section).trim_start_matches('$');
    format!("${section}\n1\n\"p\"\n0\n3\n0\n{components}\n{values}\n{records}$End{end}\n")
}

/// Nodes of a circle, triangles from its centre.
fn fan(n: usize) -> String {
    let mut text = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n{} 0 0 0\n", n + 1, n + 1);
    for k in 0..n {
        let angle = std::f64::consts::TAU * k as f64 / n as f64;
        text += &format!("{} {} {} 0\n", k + 1, angle.cos(), angle.sin());
    }
    text += &format!("$EndNodes\n$Elements\n{n}\n");
    for k in 0..n {
        text += &format!("{} 2 2 1 1 {} {} {}\n", k + 1, n + 1, k + 1, (k + 1) % n + 1);
    }
    text + "$EndElements\n"
}

/// One triangle again and again, with another one between two of them.
fn same_triangle(n: usize) -> String {
    let nodes = "4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 1 1 0\n";
    let triangles = |k: usize| format!("{k} 2 2 1 1 {} 2 3\n", if k.is_multiple_of(2) { 1 } else { 4 });
    let triangles: String = (1..=n).map(triangles).collect();
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{nodes}$EndNodes\n$Elements\n{n}\n{triangles}$EndElements\n"
    )
}

/// An array of `length` numbers by its header, with `data` behind it.
fn array(kind: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    with_header(&format!("{{'descr': '{kind}', 'fortran_order': False, 'shape': {shape}, }}\n"), data)
}

fn with_header(header: &str, data: &[u8]) -> Vec<u8> {
    let length = (header.len() as u32).to_le_bytes();
    [b"\x93NUMPY\x02\x00".as_slice(), &length, header.as_bytes(), data].concat()
}

/// An archive, compressed.
fn deflated(arrays: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, array) in arrays {
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
        zip.start_file(format!("{name}.npy"), options).expect("the name is new");
        zip.write_all(array).expect("memory takes everything");
    }
    zip.finish().expect("memory takes everything").into_inner()
}

/// Headers that no archive should be believed.
fn hostile_arrays() -> Vec<(&'static str, Vec<u8>)> {
    let nested = |open: &str, close: &str, n: usize| format!("{}{}", open.repeat(n), close.repeat(n));
    vec![
        ("2^60 numbers", array("<f8", "(1152921504606846976,)", &[0; 64])),
        ("lengths whose product overflows", array("<f8", "(4294967296, 4294967296)", &[0; 64])),
        (
            "hexadecimal lengths whose product overflows",
            array("<f8", "(0xFFFFFFFFFF, 0xFFFFFFFFFF)", &[0; 64]),
        ),
        ("a header of 4 GiB", b"\x93NUMPY\x02\x00\xff\xff\xff\xff{".to_vec()),
        ("a deep header", with_header(&nested("(", ")", 4_000), &[])),
        ("a very deep header", with_header(&nested("[", "]", DEEP), &[])),
        ("braces in braces", with_header(&nested("{", "}", 30), &[])),
        ("tuples in tuples", with_header(&nested("(", ",)", 60), &[])),
        ("signs", with_header(&"-".repeat(9_000), &[])),
        ("a long number", with_header(&"9".repeat(9_000), &[])),
        ("numbers of any size", array("|S999999999999", "(4,)", &[0; 64])),
        ("numbers of no size", array("|V0", "(999999999999,)", &[0; 64])),
    ]
}

fn checkpoints() -> Vec<(&'static str, Vec<u8>)> {
    let zeros = |n: usize| array("<f8", &format!("({n},)"), &vec![0; 8 * n]);
    let marks = |n: usize| array("<i8", &format!("({n},)"), &vec![0; 8 * n]);
    let ones = |n: usize| array("<i8", &format!("({n},)"), &1i64.to_le_bytes().repeat(n));
    let n = LONG / 8;
    let bomb = ["u1", "u2", "lambda", "tolerance"].map(|name| (name, zeros(n)));
    let bomb = [vec![("marked_counts", marks(n)), ("marked", marks(n))], bomb.to_vec()].concat();
    let levels = |counts: Vec<u8>| [counts, marks(n), zeros(n), zeros(n), zeros(n), zeros(1)].concat();
    let mut all = hostile_arrays();
    all.extend([
        ("a bomb of zeros", deflated(&bomb)),
        ("levels without marks", levels(marks(n))),
        ("levels with one mark each", levels(ones(n))),
        ("a thousand levels with one mark each", levels(ones(1000))),
        ("the same triangle marked again and again", levels(array("<i8", "(1,)", &(n as i64).to_le_bytes()))),
    ]);
    all
}

fn answers() -> Vec<(&'static str, Vec<u8>)> {
    let zeros = array("<f8", &format!("({LONG},)"), &vec![0; 8 * LONG]);
    let mut all = hostile_arrays();
    all.extend([
        ("a bomb of zeros", deflated(&[("x", zeros.clone()), ("y", zeros)])),
        ("a compressed header of many bytes", deflated(&[("x", with_header(&" ".repeat(LONG), &[]))])),
        (
            "ends of archives",
            [
                b"PK\x03\x04".as_slice(),
                &b"PK\x05\x06\0\0\0\0\xff\xff\xff\xff\xff\xff\xff\xff\0\0\0\0\0\0".repeat(LONG / 22),
            ]
            .concat(),
        ),
    ]);
    all
}
