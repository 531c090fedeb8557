//! The direction of the arrows: a room uses only those before it, files of one room use each other in no circle, and no
//! floor is so crowded that a stranger gets lost.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use syn::visit::{self, Visit};
use syn::{Attribute, Item, UseTree, Visibility};

/// The way of the data.
const LAYERS: [&str; 19] = [
    "text",
    "numeric",
    "parallel",
    "geometry",
    "problem",
    "formats",
    "mesh",
    "fem",
    "discretization",
    "qp",
    "multigrid",
    "solver",
    "action",
    "flux",
    "estimate",
    "study",
    "output",
    "pictures",
    "cli",
];

/// Files on one floor of a room, at most.
const CROWDED: usize = 12;

/// The file that opens a room, as a name beside those of the files in it.
const DOOR: &str = "(door)";

/// The place of a module in the tree: `["mesh", "check"]`; empty for the crate's root.
type Place = Vec<String>;

/// What one file says of others.
#[derive(Default)]
struct Module {
    /// Names that it passes on, and the paths that they stand for.
    passed_on: BTreeMap<String, Place>,
    /// Paths that its code names, from the crate's root.
    named: BTreeSet<Place>,
}

/// The modules of a crate.
struct House(BTreeMap<Place, Module>);

impl House {
    /// Reads sources, each with its place.
    fn new(sources: impl IntoIterator<Item = (Place, String)>) -> Self {
        let sources: Vec<(Place, String)> = sources.into_iter().collect();
        let places: BTreeSet<Place> = sources.iter().map(|(place, _)| place.clone()).collect();
        let read = |(place, text): (Place, String)| {
            let file = syn::parse_file(&text).unwrap_or_else(|error| panic!("{place:?}: {error}"));
            let mut reader = Reader {
                place: &place,
                places: &places,
                module: Module::default(),
                mentioned: BTreeSet::new(),
            };
            reader.visit_file(&file);
            let Reader { mut module, mentioned, .. } = reader;
            // What is passed on and used here as well is used.
            let used = module.passed_on.iter().filter(|(name, _)| mentioned.contains(*name));
            module.named.extend(used.map(|(_, path)| path.clone()));
            (place, module)
        };
        Self(sources.into_iter().map(read).collect())
    }

    /// The module that defines what a path names.
    fn definition(&self, path: &[String]) -> Place {
        let mut place = Place::new();
        for (k, name) in path.iter().enumerate() {
            let deeper = [place.as_slice(), std::slice::from_ref(name)].concat();
            if self.0.contains_key(&deeper) {
                place = deeper;
            } else if let Some(target) = self.0.get(&place).and_then(|module| module.passed_on.get(name)) {
                return self.definition(&[target.as_slice(), &path[k + 1..]].concat());
            } else {
                break;
            }
        }
        place
    }

    /// For each floor who uses whom there: modules that lie deeper stand for the ones on this floor that hold them.
    fn floors(&self) -> BTreeMap<Place, BTreeMap<String, BTreeSet<String>>> {
        let mut floors: BTreeMap<Place, BTreeMap<String, BTreeSet<String>>> = BTreeMap::new();
        for (user, module) in &self.0 {
            for used in module.named.iter().map(|path| self.definition(path)).filter(|used| used != user) {
                let common = user.iter().zip(&used).take_while(|(a, b)| a == b).count();
                let on_floor = |place: &Place| place.get(common).map_or(DOOR, String::as_str).to_string();
                let arrows = floors.entry(user[..common].to_vec()).or_default();
                arrows.entry(on_floor(user)).or_default().insert(on_floor(&used));
            }
        }
        floors
    }

    /// The arrows between rooms that run back.
    fn backward_arrows(&self, layers: &[&str]) -> Vec<String> {
        let rank = |room: &str| layers.iter().position(|layer| *layer == room);
        let floors = self.floors();
        let between_rooms = floors.get(&Place::new()).into_iter().flatten();
        let arrows = between_rooms.flat_map(|(user, used)| used.iter().map(move |used| (user, used)));
        arrows
            .filter(|(user, used)| *user != DOOR && *used != DOOR && rank(used) >= rank(user))
            .map(|(user, used)| format!("{user} -> {used}"))
            .collect()
    }

    /// One circle on each floor that has any.
    fn circles(&self) -> Vec<String> {
        let circle = |(floor, arrows): (Place, BTreeMap<String, BTreeSet<String>>)| {
            let found = arrows.keys().find_map(|start| way(&arrows, start, start))?;
            Some(format!("{}: {}", floor.join("/"), found.join(" -> ")))
        };
        self.floors().into_iter().filter(|(floor, _)| !floor.is_empty()).filter_map(circle).collect()
    }

    /// The floors with more than `most` files.
    fn crowded(&self, most: usize) -> Vec<String> {
        let mut files: BTreeMap<&[String], usize> = BTreeMap::new();
        for place in self.0.keys().filter(|place| place.len() > 1) {
            *files.entry(&place[..place.len() - 1]).or_default() += 1;
        }
        let crowded = files.into_iter().filter(|&(_, count)| count > most);
        crowded.map(|(floor, count)| format!("{}: {count} files", floor.join("/"))).collect()
    }
}

/// A way along arrows from a file to another one, by fewest steps.
fn way(arrows: &BTreeMap<String, BTreeSet<String>>, from: &str, to: &str) -> Option<Vec<String>> {
    let mut ways = vec![vec![from.to_string()]];
    let mut seen = BTreeSet::new();
    let mut next = 0;
    while next < ways.len() {
        let way = ways[next].clone();
        for used in arrows.get(&way[way.len() - 1]).into_iter().flatten() {
            let longer = [way.as_slice(), std::slice::from_ref(used)].concat();
            if used == to {
                return Some(longer);
            }
            if seen.insert(used.clone()) {
                ways.push(longer);
            }
        }
        next += 1;
    }
    None
}

/// Reads one file.
struct Reader<'a> {
    place: &'a Place,
    places: &'a BTreeSet<Place>,
    module: Module,
    /// The first names of all paths in the code.
    mentioned: BTreeSet<String>,
}

impl Reader<'_> {
    /// A path from the crate's root; `None` for one that leads out of it.
    fn absolute(&self, path: &[String]) -> Option<Place> {
        let child = |name: &String| {
            self.places.contains(&[self.place.as_slice(), std::slice::from_ref(name)].concat())
        };
        let supers = path.iter().take_while(|name| *name == "super").count();
        let base: &[String] = match path.first()?.as_str() {
            "crate" => return Some(path[1..].to_vec()),
            "self" => return Some([self.place.as_slice(), &path[1..]].concat()),
            "super" => &self.place[..self.place.len().checked_sub(supers)?],
            _ if child(&path[0]) => self.place,
            _ => return None,
        };
        Some([base, &path[supers..]].concat())
    }

    fn read_use(&mut self, tree: &UseTree, mut path: Vec<String>, passes_on: bool) {
        let (name, last) = match tree {
            UseTree::Group(group) => {
                return group.items.iter().for_each(|tree| self.read_use(tree, path.clone(), passes_on));
            }
            UseTree::Path(step) => {
                path.push(step.ident.to_string());
                return self.read_use(&step.tree, path, passes_on);
            }
            UseTree::Name(name) => (name.ident.to_string(), Some(name.ident.to_string())),
            UseTree::Rename(rename) => (rename.rename.to_string(), Some(rename.ident.to_string())),
            UseTree::Glob(_) => ("*".to_string(), None),
        };
        path.extend(last.filter(|last| last != "self"));
        match self.absolute(&path) {
            Some(path) if passes_on => _ = self.module.passed_on.insert(name, path),
            Some(path) => _ = self.module.named.insert(path),
            None => {}
        }
    }
}

impl<'ast> Visit<'ast> for Reader<'_> {
    fn visit_item(&mut self, item: &'ast Item) {
        let attributes: &[Attribute] = match item {
            Item::Use(item) => &item.attrs,
            Item::Mod(item) => &item.attrs,
            Item::Fn(item) => &item.attrs,
            Item::Impl(item) => &item.attrs,
            _ => &[],
        };
        if !attributes.iter().any(is_test_only) {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        self.read_use(&item.tree, Vec::new(), !matches!(item.vis, Visibility::Inherited));
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        let names: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        self.mentioned.insert(names[0].clone());
        self.module.named.extend(self.absolute(&names).filter(|_| names.len() > 1));
        visit::visit_path(self, path);
    }
}

/// `cfg(test)`, also among other conditions.
fn is_test_only(attribute: &Attribute) -> bool {
    let Ok(list) = attribute.meta.require_list() else { return false };
    let condition = list.tokens.to_string();
    list.path.is_ident("cfg") && condition.split(|c: char| !c.is_alphanumeric()).any(|word| word == "test")
}

fn source_files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("the folder is there");
    let paths = entries.map(|entry| entry.expect("readable").path());
    paths.flat_map(|path| if path.is_dir() { source_files(&path) } else { vec![path] }).collect()
}

/// The library, without its tests and what serves them.
fn our_house() -> House {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let with_place = |path: PathBuf| {
        let relative = path.strip_prefix(&source).expect("below src").with_extension("");
        let names: Place = relative.iter().map(|name| name.to_string_lossy().into_owned()).collect();
        let serves_tests = names.iter().any(|name| name == "tests" || name == "samples");
        let text = std::fs::read_to_string(&path).expect("readable");
        let place = if names == ["lib"] { Place::new() } else { names.clone() };
        (!serves_tests && names != ["main"]).then_some((place, text))
    };
    House::new(source_files(&source).into_iter().filter_map(with_place))
}

fn house(files: &[(&str, &str)]) -> House {
    let place = |path: &str| path.split('/').filter(|name| !name.is_empty()).map(str::to_string).collect();
    House::new(files.iter().map(|(path, text)| (place(path), text.to_string())))
}

#[test]
fn no_arrow_runs_back() {
    let house = our_house();
    assert!(house.0.len() > 100, "the test has read {} files", house.0.len());
    let rooms: BTreeSet<&String> = house.0.keys().filter_map(|place| place.first()).collect();
    assert_eq!(rooms, LAYERS.map(String::from).iter().collect(), "a room, but no layer: add it to the list");
    let arrows = house.backward_arrows(&LAYERS);
    assert!(arrows.is_empty(), "these arrows run back: {arrows:#?}");
}

#[test]
fn files_of_a_room_use_each_other_in_no_circle() {
    let circles = our_house().circles();
    assert!(circles.is_empty(), "{circles:#?}");
}

#[test]
fn no_floor_is_crowded() {
    let crowded = our_house().crowded(CROWDED);
    assert!(crowded.is_empty(), "{crowded:#?}");
}

#[test]
fn an_arrow_that_runs_back_is_seen() {
    let text = "use crate::mesh::Mesh;\n// crate::cli\nfn f() { crate::solver::g() }";
    let files = [("fem", text), ("mesh", ""), ("solver", ""), ("cli", "")];
    assert_eq!(house(&files).backward_arrows(&LAYERS), ["fem -> solver"]);
    let files = [("cli", text), ("mesh", ""), ("solver", "")];
    assert!(house(&files).backward_arrows(&LAYERS).is_empty());
    let in_tests = "#[cfg(test)]\nmod tests { use crate::cli::run; }";
    assert!(house(&[("fem", in_tests), ("cli", "")]).backward_arrows(&LAYERS).is_empty());
}

#[test]
fn circles_of_every_kind_are_seen() {
    let circles = |files: &[(&str, &str)]| house(files).circles();
    let door = "mod a;\nmod b;\npub use a::A;\npub use b::B;";
    let straight = [("r", door), ("r/a", "pub struct A;"), ("r/b", "use super::A;\npub struct B(A);")];
    assert!(circles(&straight).is_empty(), "a name that the door passes on belongs to who defines it");

    let two = [("r", door), ("r/a", "use super::b::B;"), ("r/b", "use crate::r::A;")];
    assert_eq!(circles(&two), ["r: a -> b -> a"]);
    let by_a_path = [("r", door), ("r/a", "fn f() { super::b::g() }"), ("r/b", "use super::A;")];
    assert_eq!(circles(&by_a_path), ["r: a -> b -> a"]);
    let through_the_door =
        [("r", "mod a;\npub use a::A;\npub struct B(A);"), ("r/a", "use super::B;\npub struct A;")];
    assert_eq!(circles(&through_the_door), ["r: (door) -> a -> (door)"]);
    let from_below = [
        ("r", "mod a;\nmod b;"),
        ("r/a", "mod c;"),
        ("r/a/c", "use crate::r::b::B;"),
        ("r/b", "use super::a::c;"),
    ];
    assert_eq!(circles(&from_below), ["r: a -> b -> a"]);
}

#[test]
fn a_crowded_floor_is_seen() {
    let files = [("r", ""), ("r/a", ""), ("r/b", ""), ("r/b/c", "")];
    assert_eq!(house(&files).crowded(1), ["r: 2 files"]);
    assert!(house(&files).crowded(2).is_empty());
}
