//! Bad input: exit code 2, one line that says what is wrong, where, and the remedy, and nothing is written.
//!
//! A fault is a replacement in input that is accepted: that input is what every refusal is compared with.

use std::fs;
use std::path::Path;

use tempfile::{TempDir, tempdir};

use super::program::{files, run};

/// What replaces what, and what the message has to say beside the name of the file.
type Fault = (&'static str, &'static str, &'static [&'static str]);

/// A message that is longer than this is no message.
const LONGEST_MESSAGE: usize = 300;

/// A problem of its own on a generated mesh.
const SQUARE: &str = r#"
title = "two plates"

[membranes]
tension = [1.0, 3.0]
load = [-15.0, "10*sin(pi*x)"]
height = "0.1 + 0.05*x"

[domain]
shape = "square"

[mesh]
cells = 4
refine = 0

[solver]
backend = "clarabel"
tolerance = 1e-8
polish = true
"#;

/// A built-in case.
const DISK: &str = r#"
case = "disk"

[parameters]
q = 10.0

[mesh]
cells = 4
"#;

/// A polygon with a hole.
const POLYGON: &str = r#"
[membranes]
tension = [1.0, 3.0]
load = [-15, 10]

[domain]
shape = "polygon"
vertices = [[0, 0], [2, 0], [2, 2], [0, 2]]
holes = [[[0.5, 0.5], [1, 0.5], [1, 1], [0.5, 1]]]

[mesh]
size = 0.5
min_angle = 25
"#;

/// The same problem as the first, with a table for each membrane.
const TABLES: &str = r#"
[[membrane]]
tension = 1.0
load = -15
height = "0.1 + 0.05*x"

[[membrane]]
tension = 3.0
load = "10*sin(pi*x)"

[domain]
shape = "square"

[mesh]
cells = 4
"#;

/// A mesh from a file.
const GMSH: &str = r#"
[membranes]
tension = [1.0, 3.0]
load = [-15, 10]

[domain]
mesh = "plate.msh"

[mesh]
refine = 0
"#;

/// That file: the unit square in six triangles. Node 7 is in none, and lies where node 2 is.
pub const MESH: &str = "\
$MeshFormat
2.2 0 8
$EndMeshFormat
$Nodes
7
1 0 0 0
2 1 0 0
3 1 1 0
4 0 1 0
5 0.5 0.5 0
6 0.25 0.25 0
7 1 0 0
$EndNodes
$Elements
6
1 2 2 0 1 1 2 6
2 2 2 0 1 6 2 5
3 2 2 0 1 2 3 5
4 2 2 0 1 3 4 5
5 2 2 0 1 4 1 6
6 2 2 0 1 4 6 5
$EndElements
";

const BAD_SYNTAX: &[Fault] = &[
    (SQUARE, "", &["there is no problem", "add a table [membranes]"]),
    ("[membranes]", "[membranes", &["line 4, column 11", "unclosed table"]),
    ("\"two plates\"", "two plates", &["line 2, column 9", "must be quoted"]),
    ("polish = true", "polish = True", &["line 19, column 10", "`true`"]),
    ("refine = 0", "cells = 5", &["line 14, column 1", "duplicate key"]),
    ("[domain]", "[[domain]]", &["`domain` must be a table", "[domain]"]),
    ("two plates\"", "two plates\"\nsolver = 3", &["duplicate key"]),
];

const BAD_KEYS: &[Fault] = &[
    ("title", "tilte", &["`tilte`", "nearest is `title`"]),
    ("title", "\"ti\\ntle\"", &["`ti\\ntle`", "nearest is `title`"]),
    ("[membranes]", "[membrane]", &["`membrane` must be a list of tables", "[membranes] for a pair"]),
    ("[membranes]", "[membrnaes]", &["`membrnaes`", "nearest is `membranes`"]),
    ("tension", "tensoin", &["`membranes.tensoin`", "nearest is `tension`"]),
    ("height", "hieght", &["`membranes.hieght`", "nearest is `height`"]),
    ("[domain]", "[domian]", &["`domian`", "nearest is `domain`"]),
    ("shape", "shpae", &["`domain.shpae`", "nearest is `shape`"]),
    ("[mesh]", "[mehs]", &["`mehs`", "nearest is `mesh`"]),
    ("cells", "cels", &["`mesh.cels`", "nearest is `cells`"]),
    ("[solver]", "[slover]", &["`slover`", "nearest is `solver`"]),
    ("height", "obstacle", &["`membranes.obstacle`", "known here are tension, load, height"]),
    ("polish", "polihs", &["`solver.polihs`", "nearest is `polish`"]),
    ("tension = [1.0, 3.0]", "", &["`membranes.tension` is missing", "add `tension"]),
    ("load = [-15.0, \"10*sin(pi*x)\"]", "", &["`membranes.load` is missing", "add `load"]),
    ("shape = \"square\"", "", &["there is no domain", "add a table [domain]"]),
    (
        "shape = \"square\"",
        "shape = \"square\"\nradius = 1",
        &["`domain.radius`", "known here are mesh, shape, lower, side"],
    ),
    ("title = \"two plates\"", "[parameters]\nq = 1", &["`parameters`", "add `case"]),
    ("title = \"two plates\"", "case = \"disk\"", &["`membranes` contradicts `case`", "remove one"]),
];

const BAD_MEMBRANES: &[Fault] = &[
    ("[1.0, 3.0]", "1.0", &["`membranes.tension`", "[first, second]"]),
    ("[1.0, 3.0]", "[1.0, 3.0, 5.0]", &["`membranes.tension`", "two entries"]),
    ("[1.0, 3.0]", "[\"1.0\", 3.0]", &["`membranes.tension[1]` must be a number"]),
    ("[1.0, 3.0]", "[0, 3.0]", &["mu1 is 0", "positive"]),
    ("[1.0, 3.0]", "[1.0, -1]", &["mu2 is -1", "positive"]),
    ("[1.0, 3.0]", "[nan, 3.0]", &["mu1 is NaN", "positive"]),
    ("[1.0, 3.0]", "[1.0, inf]", &["mu2 is inf", "finite"]),
    ("[1.0, 3.0]", "[1e-310, 3.0]", &["1e-310", "other units"]),
    ("-15.0", "nan", &["f1 is NaN", "finite"]),
    ("-15.0", "-inf", &["f1 is -inf", "finite"]),
    ("-15.0", "true", &["`membranes.load[1]`", "number or an expression"]),
    ("\"0.1 + 0.05*x\"", "-0.1", &["g is -0.1", ">= 0"]),
    ("\"0.1 + 0.05*x\"", "nan", &["g is NaN", ">= 0"]),
    ("\"0.1 + 0.05*x\"", "[0, 0]", &["`membranes.height`", "number or an expression"]),
    ("0.1 + 0.05*x", "if(x == 1 and y == 1, -1, 0.1)", &["g is -1", "(1, 1)", ">= 0"]),
    ("0.1 + 0.05*x", "ln(x - 2)", &["g is NaN", ">= 0"]),
    ("10*sin(pi*x)", "10*sni(pi*x)", &["`membranes.load[2]`", "`sni` at column 4", "`sin`?"]),
    ("10*sin(pi*x)", "10*sin(pi*x", &["column 7 is not closed", "add `)`"]),
    ("10*sin(pi*x)", "", &["the expression is empty", "write a formula"]),
    ("10*sin(pi*x)", "10 x", &["operator is missing", "write `10*x`"]),
    ("10*sin(pi*x)", "0 < x < 1", &["comparison at column 7", "`and`"]),
    ("10*sin(pi*x)", "x**2", &["`**` at column 2", "write `^`"]),
    ("10*sin(pi*x)", "1,5", &["comma at column 2", "`.`"]),
    ("10*sin(pi*x)", "atan2(x)", &["`atan2`", "give it 2"]),
    ("10*sin(pi*x)", "|x|", &["`|` at column 1", "`abs(...)`"]),
    ("10*sin(pi*x)", "sgn(x)", &["unknown name `sgn`", "`if(a > 0, 1, if(a < 0, -1, 0))`"]),
    ("10*sin(pi*x)", "z", &["unknown name `z`", "`x` and `y`"]),
    ("10*sin(pi*x)", "1/(x - x)", &["f2", "inf at the point (", "finite"]),
    ("10*sin(pi*x)", "ln(x - 0.5)", &["f2", "NaN at the point (", "finite"]),
];

const BAD_TABLES: &[Fault] = &[
    ("[domain]", "[obstacle]\n[domain]", &["`obstacle` is empty", "add `floor"]),
    ("tension = 3.0", "tensoin = 3.0", &["`membrane[2].tensoin`", "nearest is `tension`"]),
    ("1.0", "{ steel = true }", &["`membrane[1].tension.steel`", "number or an expression"]),
    ("tension = 3.0", "tension = 3.0\ntraction = 1", &["`membrane[2].traction`", "no free curve"]),
    ("3.0", "-3.0", &["membrane[2]: tension mu2 is -3", "positive"]),
    ("0.1 + 0.05*x", "-0.1", &["g is -0.1", ">= 0"]),
    ("3.0", "\"x - 3\"", &["tension mu2 is -", "positive"]),
    ("tension = 3.0", "tension = 3.0\nheight = \"free\"", &["nothing holds membrane 2", "foundation"]),
    ("tension = 3.0", "tension = 3.0\nheight = { lft = 0 }", &["the curve `lft`", "its curves are `left`"]),
    ("tension = 3.0", "tension = { steel = 3 }", &["the region `steel`", "no named regions"]),
    ("[domain]", "[obstacle]\nfloor = 1\n[domain]", &["the floor above it at 1", "put them in order"]),
];

const FOR_A_PAIR: &[&str] = &["is for a pair", "two membranes of constant tension"];

const BAD_SOLVER: &[Fault] = &[
    ("1e-8", "0", &["`solver.tolerance` = 0", "between 0 and 1"]),
    ("1e-8", "1", &["`solver.tolerance` = 1", "between 0 and 1"]),
    ("1e-8", "nan", &["`solver.tolerance` = NaN", "between 0 and 1"]),
    ("1e-8", "\"small\"", &["`solver.tolerance` must be a number"]),
    (
        "\"clarabel\"",
        "\"claarbel\"",
        &["`solver.backend`", "`claarbel`", "one of auto, multigrid, active-set, clarabel, osqp"],
    ),
    ("\"clarabel\"", "3", &["`solver.backend` must be a text"]),
    #[cfg(not(feature = "osqp"))]
    ("\"clarabel\"", "\"osqp\"", &["`solver.backend`", "not in this build", "--features osqp"]),
    ("polish = true", "polish = \"yes\"", &["`solver.polish` must be true or false"]),
    ("polish = true", "max_iterations = 0", &["`solver.max_iterations`", "at least 1"]),
    ("polish = true", "time_limit = 0", &["`solver.time_limit` = 0", "above 0"]),
    ("polish = true", "time_limit = -1", &["`solver.time_limit` = -1", "above 0"]),
    ("polish = true", "time_limit = nan", &["`solver.time_limit` = NaN", "above 0"]),
    ("polish = true", "time_limit = inf", &["`solver.time_limit` = inf", "leave it out for no limit"]),
    ("polish = true", "time_limit = 1e300", &["`solver.time_limit` = 1e300", "leave it out for no limit"]),
];

const BAD_MESH: &[Fault] = &[
    ("cells = 4", "cells = 0", &["`mesh.cells`", "at least 1"]),
    ("cells = 4", "cells = -3", &["`mesh.cells`", "at least 1"]),
    ("cells = 4", "cells = 1.5", &["`mesh.cells`", "whole number"]),
    ("cells = 4", "cells = 1000000000", &["1.0e18 vertices", "coarser"]),
    ("cells = 4", "size = 0", &["size is 0", "positive"]),
    ("cells = 4", "size = nan", &["size is NaN", "positive"]),
    ("cells = 4", "size = 1e-9", &["vertices", "coarser"]),
    ("cells = 4", "size = 0.2\nmin_angle = 50", &["min_angle is 50", "between 0 and 30"]),
    ("cells = 4", "cells = 4\nsize = 0.1", &["`mesh.size` contradicts `mesh.cells`", "remove one"]),
    ("cells = 4", "min_angle = 20", &["`mesh.min_angle`", "give `size`"]),
    ("cells = 4", "size = 0.2\npattern = \"right\"", &["`mesh.pattern`", "give `cells`"]),
    ("cells = 4", "pattern = \"left\"", &["`mesh.pattern`", "right or crossed"]),
    ("refine = 0", "refine = -1", &["`mesh.refine`", "at least 0"]),
    ("refine = 0", "refine = 30", &["30 refinements", "refine less"]),
    ("\"square\"", "\"sqare\"", &["`domain.shape`", "\"sqare\"", "one of square"]),
    ("\"square\"", "\"square\"\nmesh = \"plate.msh\"", &["contradicts `domain.mesh`", "remove one"]),
    ("\"square\"", "\"square\"\nside = 0", &["width 0", "positive"]),
    ("\"square\"", "\"square\"\nside = 1e200", &["rounding", "scale the domain"]),
    ("\"square\"", "\"square\"\nlower = [0]", &["`domain.lower`", "[x, y]"]),
    ("\"square\"", "\"rectangle\"", &["`domain.upper` is missing", "add `upper"]),
    ("\"square\"", "\"rectangle\"\nupper = [-1, 1]", &["width -1", "positive"]),
    ("\"square\"", "\"disk\"\nradius = nan", &["radius NaN", "positive"]),
    ("\"square\"", "\"disk\"\ncentre = [1e17, 0]", &["rounding", "nearer to the origin"]),
    ("\"square\"", "\"polygon\"\nvertices = [[0, 0], [1, 0], [0, 1]]", &["give `size`"]),
];

const BAD_CASE: &[Fault] = &[
    ("\"disk\"", "\"dsik\"", &["`dsik`", "nearest is `disk`"]),
    ("\"disk\"", "3", &["`case` must be a text"]),
    ("case = \"disk\"", "", &["`parameters`", "add `case"]),
    ("q = 10.0", "qq = 10.0", &["`qq`", "nearest is `q`"]),
    ("q = 10.0", "q = 0.0", &["`q = 0`", "choose q > 0"]),
    ("q = 10.0", "mu1 = inf", &["`mu1 = inf`", "choose mu1 > 0"]),
    ("q = 10.0", "q = \"10\"", &["`parameters.q` must be a number"]),
    ("[mesh]", "[membranes]\ntension = [1, 2]\n[mesh]", &["`membranes` contradicts `case`"]),
    ("[mesh]", "[domain]\nshape = \"square\"\n[mesh]", &["`domain.shape`", "remove it"]),
    ("cells = 4", "refine = 30", &["30 refinements", "refine less"]),
];

const BAD_POLYGON: &[Fault] = &[
    ("size = 0.5\nmin_angle = 25", "", &["`mesh.size` is missing", "add `size"]),
    ("min_angle = 25", "min_angle = 50", &["min_angle is 50", "between 0 and 30"]),
    ("vertices = [[0, 0], [2, 0], [2, 2], [0, 2]]", "", &["`domain.vertices` is missing", "add `vert"]),
    ("[2, 2], [0, 2]", "[2]", &["`domain.vertices` must be a list of points"]),
    (", [2, 2], [0, 2]", "", &["fewer than three vertices", "give the corners"]),
    ("[2, 2], [0, 2]", "[4, 0]", &["no area", "give the corners"]),
    ("[2, 2], [0, 2]", "[nan, 2], [0, 2]", &["not finite", "give the corners"]),
    ("[2, 2], [0, 2]", "[0, 2], [3, 2]", &["cross"]),
    ("[0.5, 1]", "[0.5, 3]", &["cross", "(0.5, 3)"]),
    ("[0.5, 1]", "[0.5, 1], [1, 0.5]", &["same vertex twice", "give the corners"]),
    (
        "[0.5, 0.5], [1, 0.5], [1, 1], [0.5, 1]",
        "[5, 5], [6, 5], [6, 6]",
        &["hole lies outside", "keep them apart"],
    ),
    ("[[0.5, 0.5], [1, 0.5], [1, 1], [0.5, 1]]", "[1, 1]", &["`domain.holes` must be a list of lists"]),
];

const BAD_MESH_KEYS: &[Fault] = &[
    ("plate.msh", "palte.msh", &["`domain.mesh`", "palte.msh", "relative to the case file"]),
    ("plate.msh", "case.toml", &["not a Gmsh mesh", "make a mesh with `gmsh"]),
    ("\"plate.msh\"", "3", &["`domain.mesh` must be a text"]),
    ("refine = 0", "cells = 4", &["`domain.mesh` is a file", "keep `refine` only"]),
];

const BAD_MESH_FILE: &[Fault] = &[
    (MESH, "", &["not a Gmsh mesh", "make a mesh with `gmsh"]),
    (MESH, include_str!("../data/gmsh/only_curves_41.msh"), &["no triangle", "mesh the surface"]),
    ("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes", "$NOD", &["MSH version 1", "convert the file"]),
    ("2.2 0 8", "3.0 0 8", &["MSH version 3.0", "convert the file"]),
    ("2.2 0 8", "2.2 1 8", &["byte", "write it again with Gmsh"]),
    ("$EndElements\n", "", &["line 22", "cut short", "write it again"]),
    ("4 6 5\n$EndElements\n", "4", &["cut short", "write it again"]),
    (
        "6 2 2 0 1 4 6 5",
        "6 3 2 0 1 4 6 4 6",
        &["quadrangle 6 cannot be cut in two", "mesh the surface again"],
    ),
    ("6 2 2 0 1 4 6 5", "6 4 2 0 1 4 6 5 3", &["line 21", "volume elements", "gmsh -2"]),
    ("6 2 2 0 1 4 6 5", "6 9 2 0 1 4 6 5 1 2", &["line 21", "expected the node tag of an element"]),
    ("6 2 2 0 1 4 6 5", "6 2 2 0 1 4 9 5", &["triangle 6 names the node 9", "write the file again"]),
    ("5 0.5 0.5 0", "5 nan 0.5 0", &["line 10", "node 5", "finite"]),
    ("5 0.5 0.5 0", "5 0.5 0.5 0.1", &["not flat: node 5", "plane"]),
    ("5 0.5 0.5 0", "5 0.25 0.25 0", &["degenerate", "Gmsh's element 2", "remove it"]),
    ("5 0.5 0.5 0", "5 0.5 0.1 0", &["overlap", "Gmsh's elements 2, 3"]),
    ("2 2 2 0 1 6 2 5", "2 2 2 0 1 6 2 3", &["overlap", "one triangle on each side"]),
    ("6 2 2 0 1 4 6 5", "6 2 2 0 1 6 2 5", &["are the same", "remove one"]),
    ("1 4 1 6\n6 2 2 0 1 4 6 5", "1 4 1 5\n6 15 2 0 1 1", &["inside the edge", "split that triangle"]),
    ("3 2 2 0 1 2 3 5", "3 2 2 0 1 7 3 5", &["coincide", "merge them"]),
];

/// Arguments that are refused, what the message has to say, and the arguments with the remedy taken.
const BAD_ARGUMENTS: &[(&str, &[&str], &str)] = &[
    (
        "",
        &["requires a subcommand", "solve, check, converge, adapt, bench, export, cases, completions, man"],
        "--help",
    ),
    ("frobnicate case.toml", &["'frobnicate'", "membranes --help"], "check case.toml"),
    ("sovle case.toml", &["'sovle'", "'solve'"], "solve case.toml"),
    ("solve", &["<CASE.toml>", "not provided", "see `membranes solve --help`"], "solve case.toml"),
    ("check case.toml --quite", &["'--quite'", "'--quiet'"], "check case.toml --quiet"),
    ("check case.toml case.toml", &["unexpected argument 'case.toml'"], "check case.toml"),
    ("check cas.toml", &["cas.toml", "name an existing file", "membranes cases"], "check case.toml"),
    ("check folder", &["folder", "name a readable file"], "check case.toml"),
    ("check endless.toml", &["endless.toml", "GiB of memory", "meshed by Gmsh"], "check case.toml"),
    ("check latin1.toml", &["latin1.toml", "save it as UTF-8"], "check case.toml"),
    ("check deep.toml", &["`membranes.load[1]`", "too deeply", "simplify"], "check case.toml"),
    ("check case.toml --refine -1", &["'--refine <N>'", "at least 0"], "check case.toml --refine 1"),
    ("check case.toml --refine 30", &["30 refinements", "refine less"], "check case.toml --refine 1"),
    ("export case.toml", &["--format"], "export case.toml --format qps"),
    ("bench floor.toml --levels 1", FOR_A_PAIR, "bench disk.toml --levels 1"),
    ("converge floor.toml --levels 1", &["a known solution", "`case"], "converge disk.toml --levels 1"),
    ("export case.toml --format qpx", &["'qpx'", "qps, npz, mtx"], "export case.toml --format qps"),
    (
        "export case.toml --format qps --out file",
        &["file", "--out"],
        "export case.toml --format qps --out new",
    ),
    (
        "solve case.toml --tolerance 1",
        &["'1'", "between 0 and 1", "membranes solve --help"],
        "solve case.toml --tolerance 1e-6",
    ),
    ("solve case.toml --tolerance -1", &["'-1'", "between 0 and 1"], "solve case.toml --tolerance 1e-6"),
    ("solve case.toml --tolerance nan", &["'nan'", "between 0 and 1"], "solve case.toml --tolerance 1e-6"),
    (
        "solve case.toml --backend calrabel",
        &["one of auto, multigrid, active-set, clarabel, osqp"],
        "solve case.toml --backend clarabel",
    ),
    #[cfg(not(feature = "osqp"))]
    ("solve case.toml --backend osqp", &["--features osqp"], "solve case.toml --backend clarabel"),
    ("solve case.toml --out file", &["file", "another folder with --out"], "solve case.toml --out new"),
    (
        "solve case.toml --out file/new",
        &["file/new", "another folder with --out"],
        "solve case.toml --out new",
    ),
    (
        "solve case.toml --time-limit 0",
        &["--time-limit", "0 is out of range"],
        "solve case.toml --time-limit 60",
    ),
    (
        "solve case.toml --time-limit nan",
        &["--time-limit", "NaN is out"],
        "solve case.toml --time-limit 1e19",
    ),
    (
        "solve case.toml --time-limit 1e300",
        &["--time-limit", "1e300 is out"],
        "solve case.toml --time-limit 60",
    ),
    (
        "solve case.toml --time-limit soon",
        &["--time-limit", "choose seconds"],
        "solve case.toml --time-limit 60",
    ),
    ("converge disk.toml --levels 0", &["--levels", "at least 1"], "converge disk.toml --levels 1"),
    ("converge disk.toml --levels 30", &["29 refinements", "refine less"], "converge disk.toml --levels 2"),
    ("converge disk.toml --levels -1", &["--levels", "at least 1"], "converge disk.toml --levels 1"),
    ("bench disk.toml --levels 0", &["--levels", "at least 1"], "bench disk.toml --levels 1"),
    (
        "adapt disk.toml --max-vertices 3",
        &["first mesh has 61 vertices", "--max-vertices 3"],
        "adapt disk.toml --max-vertices 100 --tolerance 0.9",
    ),
    ("cases stirp", &["`stirp`", "nearest is `strip`"], "cases strip"),
];

/// A folder with a case file and its mesh.
fn folder_with(case: &str, mesh: &str) -> TempDir {
    let folder = tempdir().expect("a temporary folder");
    for (name, text) in [("case.toml", case), ("plate.msh", mesh)] {
        fs::write(folder.path().join(name), text).expect("it is writable");
    }
    folder
}

/// Runs the program on bad input; what is wrong with the way in which it refuses.
fn complaints(folder: &Path, arguments: &str, says: &[&str]) -> Vec<String> {
    let before = files(folder);
    let run = run(folder, arguments);
    let mut complaints = Vec::new();
    let mut demand = |met: bool, what: &str| {
        if !met {
            complaints.push(format!("{what}: {run:?}"));
        }
    };
    demand(run.code == Some(2), "exit code 2");
    demand(run.stdout.is_empty(), "nothing on standard output");
    demand(run.stderr.starts_with("error: "), "it begins with `error: `");
    demand(run.stderr.lines().count() == 1 && run.stderr.ends_with('\n'), "one line");
    demand(run.stderr.len() <= LONGEST_MESSAGE, "a short line");
    for word in says {
        demand(run.stderr.contains(word), &format!("it says {word:?}"));
    }
    demand(files(folder) == before, "nothing written");
    complaints
}

/// Puts each fault into the file `edited`, one at a time.
fn complaints_about(case: &str, edited: &str, faults: &[Fault]) -> Vec<String> {
    let mut found = Vec::new();
    for &(from, to, says) in faults {
        let with_fault = |name: &str, text: &str| {
            if name != edited {
                return text.to_owned();
            }
            assert_eq!(text.matches(from).count(), 1, "{from:?} is in {name}, once");
            text.replace(from, to)
        };
        let folder = folder_with(&with_fault("case.toml", case), &with_fault("plate.msh", MESH));
        let says = [says, &[edited]].concat();
        let complaints = complaints(folder.path(), "solve case.toml --out results", &says);
        found.extend(complaints.into_iter().map(|complaint| format!("{from:?} -> {to:?}: {complaint}")));
    }
    found
}

#[test]
fn every_fault_in_a_file_is_refused_in_one_line_and_without_it_the_file_is_accepted() {
    let groups = [
        (SQUARE, "case.toml", BAD_SYNTAX),
        (SQUARE, "case.toml", BAD_KEYS),
        (SQUARE, "case.toml", BAD_MEMBRANES),
        (TABLES, "case.toml", BAD_TABLES),
        (SQUARE, "case.toml", BAD_SOLVER),
        (SQUARE, "case.toml", BAD_MESH),
        (DISK, "case.toml", BAD_CASE),
        (POLYGON, "case.toml", BAD_POLYGON),
        (GMSH, "case.toml", BAD_MESH_KEYS),
        (GMSH, "plate.msh", BAD_MESH_FILE),
    ];
    let complaints = groups.map(|(case, edited, faults)| complaints_about(case, edited, faults)).concat();
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));

    for case in [SQUARE, TABLES, DISK, POLYGON, GMSH] {
        let folder = folder_with(case, MESH);
        let run = run(folder.path(), "solve case.toml --out results");
        assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""), "{case}");
    }
}

#[test]
fn bad_arguments_are_refused_in_one_line_and_corrected_ones_accepted() {
    let folder = folder_with(SQUARE, MESH);
    let write = |name: &str, bytes: &[u8]| fs::write(folder.path().join(name), bytes).unwrap();
    write("file", b"not a folder");
    write("disk.toml", DISK.as_bytes());
    write("floor.toml", TABLES.replace("[domain]", "[obstacle]\nfloor = -1\n[domain]").as_bytes());
    write("latin1.toml", b"title = \"Stra\xdfe\"");
    let deep = format!("{}x{}", "(1 + ".repeat(1000), ")".repeat(1000));
    write("deep.toml", SQUARE.replace("-15.0", &format!("{deep:?}")).as_bytes());
    // Sparse: it takes no space.
    let endless = fs::File::create(folder.path().join("endless.toml")).unwrap();
    endless.set_len(1 << 30).unwrap();
    fs::create_dir(folder.path().join("folder")).unwrap();
    assert!(!complaints(folder.path(), "cases", &[]).is_empty(), "to be accepted is no refusal");
    for (bad, says, fixed) in BAD_ARGUMENTS {
        let complaints = complaints(folder.path(), bad, says);
        assert!(complaints.is_empty(), "{bad}: {}", complaints.join("\n"));
        let run = run(folder.path(), fixed);
        assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""), "{fixed}");
    }
}
