//! Every form of the problem, and each of its refusals.

use std::path::Path;

use crate::cli::case::CaseFile;
use crate::problem::{ContactProblem, Field};

/// A message that is longer than this is no message.
const LONGEST_MESSAGE: usize = 300;

/// What every refusal is compared with.
const STACK: &str = r#"
[[membrane]]
tension = { rubber = 1.0, steel = "2 + x", elsewhere = 3 }
load = "-15"
height = { "hole 1" = 0.1, rim = "free", elsewhere = "0.2*x" }
traction = { rim = 2.5 }

[[membrane]]
tension = 4.0
foundation = 7
height = "free"
traction = { rim = "y", elsewhere = 1.0 }

[obstacle]
floor = { rubber = -0.3, elsewhere = "-0.3 + 0.1*x" }
ceiling = 0.5

[domain]
shape = "square"
"#;

fn read(text: &str) -> Result<ContactProblem, String> {
    let file = CaseFile::parse("case.toml", text, Path::new("case.toml"));
    file.map(|file| file.problem).map_err(|failure| failure.to_string())
}

/// The problem of these tables before a domain.
fn posed(tables: &str) -> Result<ContactProblem, String> {
    read(&format!("{tables}\n[domain]\nshape = \"square\"\n"))
}

#[test]
fn each_datum_of_a_stack_comes_to_its_place() {
    let problem = read(STACK).unwrap();
    let debug = format!("{problem:?}");
    let [upper, lower] = problem.membranes() else { panic!("two membranes") };
    let shown = [
        ("tension", format!("{:?}", upper.tension)),
        ("load", format!("{:?}", upper.load)),
        ("supports", format!("{:?} and {:?}", upper.parts, upper.elsewhere)),
        ("foundation", format!("{:?}", lower.foundation)),
        ("supports below", format!("{:?} and {:?}", lower.parts, lower.elsewhere)),
        ("floor", format!("{:?}", problem.floor().unwrap())),
        ("ceiling", format!("{:?}", problem.ceiling().unwrap())),
    ];
    let everywhere = |value: &str| format!("Everywhere({value})");
    let by_region = |parts: &[(&str, &str)], elsewhere: &str| {
        let parts: Vec<String> =
            parts.iter().map(|(name, value)| format!("({name:?}, {})", everywhere(value))).collect();
        format!("ByRegion {{ parts: [{}], elsewhere: Some({}) }}", parts.join(", "), everywhere(elsewhere))
    };
    let free = |traction: &str| format!("Free {{ traction: {traction} }}");
    let fixed = |height: &str| format!("Fixed({})", everywhere(height));
    let wanted = [
        by_region(&[("rubber", "1"), ("steel", "2 + x")], "3"),
        everywhere("-15"),
        format!("[(\"hole 1\", {}), (\"rim\", {})] and {}", fixed("0.1"), free("2.5"), fixed("0.2*x")),
        everywhere("7"),
        format!("[(\"rim\", {})] and {}", free("y"), free("1")),
        by_region(&[("rubber", "-0.3")], "-0.3 + 0.1*x"),
        everywhere("0.5"),
    ];
    for ((name, shown), wanted) in shown.iter().zip(wanted) {
        assert_eq!(*shown, wanted, "{name} of {debug}");
    }
    assert_eq!((problem.regions(), problem.curves()), (vec!["rubber", "steel"], vec!["hole 1", "rim"]));
}

#[test]
fn what_is_not_said_is_as_the_documentation_has_it() {
    let problem = posed("[[membrane]]\ntension = 2").unwrap();
    let [sheet] = problem.membranes() else { panic!("one membrane") };
    assert_eq!(
        format!("{sheet:?}"),
        format!("{:?}", crate::problem::Membrane::new(2.0)),
        "no load, no foundation, at height zero"
    );
    assert!(problem.floor().is_none() && problem.ceiling().is_none() && problem.as_pair().is_none());
}

#[test]
fn ways_to_write_the_same_are_the_same() {
    let plain = "tension = 2\nload = 3\nheight = 0.5";
    let free = "tension = 2\nheight = { rim = \"free\" }";
    for [one, other] in [
        [plain, "tension = \"1 + 1\"\nload = { elsewhere = 3.0 }\nheight = { elsewhere = 0.5 }"],
        [plain, "load.elsewhere = \"3\"\ntension = 2.0\nfoundation = 0\nheight = 0.5"],
        [free, "tension = 2\nheight.rim = \"free\"\nheight.elsewhere = 0"],
        [free, "tension = 2\ntraction = 0\n[membrane.height]\nrim = \"free\""],
        [free, "tension = 2\nheight = { rim = \"free\" }\ntraction = { rim = 0 }"],
        ["tension = 2\nheight = \"free\"", "tension = 2\nheight = { elsewhere = \"free\" }"],
    ] {
        let [one, other] = [one, other].map(|keys| posed(&format!("[[membrane]]\n{keys}")).unwrap());
        assert_eq!(format!("{one:?}"), format!("{other:?}"));
    }
}

#[test]
fn two_membranes_with_the_data_of_the_pair_are_the_pair() {
    let old = "[membranes]\ntension = [1.0, 3.0]\nload = [-15, \"10*sin(pi*x)\"]\nheight = 0.1";
    let new = "[[membrane]]\ntension = 1\nload = \"-15\"\nheight = 0.1\n[[membrane]]\ntension = 3\nload = \"10*sin(pi*x)\"";
    let [old, problem] = [old, new].map(|text| posed(text).unwrap());
    assert!(problem.as_pair().is_some());
    assert_eq!(format!("{problem:?}"), format!("{old:?}"));
    let others = [
        ("tension = 3", "tension = { steel = 3, elsewhere = 3 }"),
        ("height = 0.1", "height = { rim = \"free\" }"),
        ("tension = 3", "tension = 3\nheight = 0.05"),
        ("tension = 3", "tension = 3\nfoundation = 1"),
        ("[[membrane]]\ntension = 3", "[obstacle]\nfloor = -1\n[[membrane]]\ntension = 3"),
    ];
    for (from, to) in others {
        assert_eq!(new.matches(from).count(), 1, "{from}");
        assert!(posed(&new.replace(from, to)).unwrap().as_pair().is_none(), "{to}");
    }
}

/// What replaces what in [`STACK`], and what the message has to say.
const REFUSED: &[(&str, &str, &[&str])] = &[
    // The forms.
    ("[obstacle]", "case = \"disk\"\n[obstacle]", &["`membrane[2].case`", "known here are tension, load"]),
    (
        "[domain]",
        "[membranes]\ntension = [1, 2]\n[domain]",
        &["`membrane` contradicts `membranes`", "remove"],
    ),
    ("[obstacle]", "[obstakle]", &["`obstakle`", "nearest is `obstacle`"]),
    ("[obstacle]", "[[obstacle]]", &["`obstacle` must be a table", "[obstacle]"]),
    // The keys.
    ("tension = 4.0", "tensoin = 4.0", &["`membrane[2].tensoin`", "nearest is `tension`"]),
    ("tension = 4.0", "", &["`membrane[2].tension` is missing", "add `tension"]),
    ("foundation = 7", "fundation = 7", &["`membrane[2].fundation`", "nearest is `foundation`"]),
    ("load = \"-15\"", "loads = 1", &["`membrane[1].loads`", "nearest is `load`"]),
    ("load = \"-15\"", "gap = 1", &["`membrane[1].gap` has no place here", "foundation, height, traction"]),
    ("ceiling = 0.5", "cieling = 0.5", &["`obstacle.cieling`", "nearest is `ceiling`"]),
    // The values.
    ("4.0", "[1.0, 3.0]", &["`membrane[2].tension` is a list", "one for each region"]),
    ("4.0", "true", &["`membrane[2].tension` must be a number"]),
    ("4.0", "{}", &["`membrane[2].tension` is empty", "one for each region"]),
    ("4.0", "\"free\"", &["`membrane[2].tension` is no expression", "unknown name `free`"]),
    ("4.0", "\"2 x\"", &["`membrane[2].tension` is no expression", "write `2*x`"]),
    ("\"2 + x\"", "\"2 + z\"", &["`membrane[1].tension.steel`", "unknown name `z`"]),
    ("\"2 + x\"", "{ rubber = 1 }", &["`membrane[1].tension.steel` must be a number"]),
    ("elsewhere = 3", "elsewhere = [3]", &["`membrane[1].tension.elsewhere` must be a number"]),
    ("rubber = -0.3", "\"a\\nb\" = true", &["`obstacle.floor.a\\nb` must be a number"]),
    ("ceiling = 0.5", "ceiling = \"free\"", &["`obstacle.ceiling` is no expression"]),
    // The views of a mesh file.
    (
        "\"-15\"",
        "{ view = \"pressure\" }",
        &["the data view `pressure` has to be in a mesh file", "`domain.mesh`"],
    ),
    ("\"-15\"", "{ view = 3 }", &["`membrane[1].load` must name a data view", "{ view = \"name\" }"]),
    ("\"2 + x\"", "{ view = [] }", &["`membrane[1].tension.steel` must name a data view"]),
    ("\"2 + x\"", "{ view = \"mu\", more = 1 }", &["`membrane[1].tension.steel` must be a number"]),
    ("height = \"free\"", "height = { view = 1 }", &["`membrane[2].height` must name a data view"]),
    (
        "rim = 2.5",
        "rim = { view = \"t\" }",
        &["`membrane[1].traction.rim` cannot be a data view", "give a number"],
    ),
    ("{ rim = 2.5 }", "{ view = \"t\" }", &["`membrane[1].traction` cannot be a data view"]),
    // The numbers.
    ("4.0", "0", &["membrane[2]: tension mu2 is 0", "positive"]),
    ("rubber = 1.0", "rubber = -1.0", &["membrane[1]: tension mu1 is -1", "positive"]),
    ("4.0", "\"1/0\"", &["membrane[2]: tension mu2 is inf", "finite"]),
    ("foundation = 7", "foundation = -7", &["membrane[2]: foundation c2 is -7", ">= 0"]),
    ("\"-15\"", "nan", &["membrane[1]: load f1 is NaN", "finite"]),
    ("\"hole 1\" = 0.1", "\"hole 1\" = inf", &["membrane[1]: height g1 is inf", "finite"]),
    ("rim = 2.5", "rim = inf", &["membrane[1]: line load t1 is inf", "finite"]),
    ("rubber = -0.3", "rubber = nan", &["[obstacle]: the floor is NaN", "finite"]),
    // The boundary.
    ("\"hole 1\" = 0.1", "\"hole 1\" = true", &["`membrane[1].height.hole 1`", "or \"free\""]),
    ("rim = \"free\"", "rim = \"fre\"", &["`membrane[1].height.rim` = \"fre\"", "write \"free\""]),
    ("height = \"free\"", "height = \"Free\"", &["`membrane[2].height` = \"Free\"", "write \"free\""]),
    ("height = \"free\"", "height = \"fixed\"", &["`membrane[2].height` is no expression", "`fixed`"]),
    ("height = \"free\"", "height = []", &["`membrane[2].height` is a list", "each curve"]),
    ("rim = 2.5", "rim = \"free\"", &["`membrane[1].traction.rim` is no expression", "`free`"]),
    ("rim = 2.5", "rmi = 2.5", &["`membrane[1].traction.rmi`", "held", "`height = { rmi = \"free\" }`"]),
    (
        "{ rim = 2.5 }",
        "{ \"hole 1\" = 2.5 }",
        &["`membrane[1].traction.hole 1`", "held", "`height = { \"hole 1\" = \"free\" }`"],
    ),
    ("rim = 2.5", "rim = 2.5, elsewhere = 1", &["`membrane[1].traction`", "no further free curve", "remove"]),
    ("height = \"free\"\n", "", &["`membrane[2].traction`", "no further free curve", "free one by"]),
];

#[test]
fn every_fault_of_a_stack_is_refused_in_one_line_with_the_remedy() {
    assert!(read(STACK).is_ok());
    for &(from, to, says) in REFUSED {
        assert_eq!(STACK.matches(from).count(), 1, "{from:?} is there once");
        check_refusal(&STACK.replace(from, to), says);
    }
}

/// Files of another kind than [`STACK`].
const OTHERS: &[(&str, &[&str])] = &[
    ("", &["there is no problem", "[[membrane]]"]),
    ("[[membran]]\ntension = 1", &["`membran`", "nearest is `membrane`"]),
    ("[membrane]\ntension = 1", &["`membrane` must be a list of tables", "[[membrane]]", "[membranes]"]),
    ("membrane = [1, 2]", &["`membrane` must be a list of tables", "[[membrane]]"]),
    ("[[membrane]]\ntension = 1\ntraction = 1", &["`membrane[1].traction` finds no free curve", "`height"]),
    ("membrane = []", &["[[membrane]]: there is no membrane", "add"]),
    ("[[membranes]]\ntension = 1", &["`membranes`", "[[membrane]]"]),
    ("[obstacle]\nfloor = 1", &["`obstacle`", "add [[membrane]]"]),
    ("[[membran]]\ntension = 1\n[obstacle]\nfloor = 1", &["`membran`", "nearest is `membrane`"]),
    ("[[membrane]]\ntension = 1\n[obstacle]", &["`obstacle` is empty", "floor"]),
    ("[[membrane]]\ntension = 1\n[obstacle]\nflor = 1", &["`obstacle.flor`", "nearest is `floor`"]),
    (
        "[membranes]\ntension = [1, 2]\nload = [0, 0]\n[obstacle]\nfloor = 1",
        &["`obstacle` does not go with `membranes`", "as [[membrane]]"],
    ),
    ("case = \"disk\"\n[[membrane]]\ntension = 1", &["`membrane` contradicts `case`", "remove"]),
    ("case = \"disk\"\n[obstacle]\nfloor = 1", &["`obstacle` contradicts `case`", "remove"]),
];

#[test]
fn every_other_fault_is_refused_as_well() {
    for (tables, says) in OTHERS {
        check_refusal(&format!("{tables}\n[domain]\nshape = \"square\"\n"), says);
    }
}

fn check_refusal(text: &str, says: &[&str]) {
    let message = match read(text) {
        Err(message) => message,
        Ok(problem) => panic!("accepted: {text}\n{problem:?}"),
    };
    assert!(message.lines().count() == 1 && message.len() <= LONGEST_MESSAGE, "{message}");
    assert!(message.starts_with("case.toml: "), "{message}");
    for word in says {
        assert!(message.contains(word), "{message}: it does not say {word}");
    }
}

#[test]
fn a_data_view_may_stand_for_every_field() {
    let text = STACK
        .replace("shape = \"square\"", "mesh = \"plate.msh\"")
        .replace("\"2 + x\"", "{ view = \"stiff\" }")
        .replace("\"-15\"", "{ view = \"pressure\" }")
        .replace("foundation = 7", "foundation.view = \"soil\"")
        .replace("\"hole 1\" = 0.1", "\"hole 1\" = { view = \"rig\" }")
        .replace("\"-0.3 + 0.1*x\"", "{ view = \"ground\" }")
        .replace("ceiling = 0.5", "ceiling = { view = \"top\" }");
    let problem = read(&text).unwrap();
    assert_eq!(problem.views(), ["stiff", "pressure", "rig", "soil", "top", "ground"]);
    assert!(matches!(&problem.membranes()[0].load, Field::View(name) if name == "pressure"));
    assert_eq!(problem.regions(), ["rubber", "steel"]);
    const PAIR: &str =
        "[membranes]\ntension = [1, 2]\nload = [1, 2]\nheight = 1\n[domain]\nmesh = \"a.msh\"\n";
    assert!(read(PAIR).is_ok());
    for (key, from, to) in [
        ("load[1]", "load = [1, 2]", "load = [{ view = \"p\" }, 2]"),
        ("height", "height = 1", "height.view = \"p\""),
    ] {
        let pair = PAIR.replace(from, to);
        let message = read(&pair).unwrap_err();
        assert!(
            message.contains(&format!("`membranes.{key}")) && message.contains("write [[membrane]]"),
            "{message}"
        );
    }
}
