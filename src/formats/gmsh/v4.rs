//! `$Nodes` and `$Elements` of MSH 4.1, one block for each entity of the geometry.

use super::elements::{Elements, Kind};
use super::error::GmshError;
use super::nodes::{Nodes, read_point};
use super::scanner::Scanner;

/// Reads the nodes. A block holds all its tags, then all its points, which may carry parameters behind `z`.
pub(super) fn nodes(scanner: &mut Scanner) -> Result<Nodes, GmshError> {
    let head = Head::read(scanner, "nodes")?;
    let (mut tags, mut points, mut heights) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..head.blocks {
        let dimension = scanner.int("the dimension of an entity")?;
        scanner.int("the tag of an entity")?;
        let parametric = scanner.int("0, or 1 for nodes with parameters")?;
        let parameters = match (parametric, dimension) {
            (0, _) => 0,
            (1, 0..=3) => dimension,
            _ => {
                let found = format!("{dimension} and {parametric}");
                return Err(scanner.unexpected("a dimension from 0 to 3 and parametric 0 or 1", &found));
            }
        };
        let length = read_count(scanner, "nodes of a block")?;
        scanner.end_record()?;
        let first = tags.len();
        for _ in 0..length {
            tags.push(scanner.size("a node tag")?);
            scanner.end_record()?;
        }
        for &tag in &tags[first..] {
            read_point(scanner, tag, &mut points, &mut heights)?;
            for _ in 0..parameters {
                scanner.double("a parameter of a node")?;
            }
            scanner.end_record()?;
        }
    }
    head.check(scanner, tags.len())?;
    Nodes::new(tags, points, heights)
}

/// Reads the elements. A block holds elements of one kind.
pub(super) fn elements(scanner: &mut Scanner, nodes: &Nodes) -> Result<Elements, GmshError> {
    let head = Head::read(scanner, "elements")?;
    let mut elements = Elements::default();
    let mut found = 0;
    for _ in 0..head.blocks {
        scanner.int("the dimension of an entity")?;
        scanner.int("the tag of an entity")?;
        let kind = Kind::read(scanner)?;
        let length = read_count(scanner, "elements of a block")?;
        scanner.end_record()?;
        for _ in 0..length {
            let element = scanner.size("an element tag")?;
            let mut vertices = [0; 3];
            for vertex in &mut vertices[..kind.nodes()] {
                *vertex = scanner.size("the node tag of an element")?;
            }
            if kind == Kind::Triangle {
                elements.add(scanner, nodes, element, vertices)?;
            } else {
                elements.others += 1;
            }
            scanner.end_record()?;
        }
        found += length;
    }
    head.check(scanner, found)?;
    Ok(elements)
}

fn read_count(scanner: &mut Scanner, of: &'static str) -> Result<usize, GmshError> {
    let declared = scanner.size("a count")?;
    scanner.count(declared, of)
}

/// The first record of a section: numbers of blocks and of records, smallest and largest tag.
struct Head {
    of: &'static str,
    blocks: usize,
    records: usize,
}

impl Head {
    fn read(scanner: &mut Scanner, of: &'static str) -> Result<Self, GmshError> {
        let blocks = read_count(scanner, "blocks")?;
        let records = read_count(scanner, of)?;
        scanner.size("the smallest tag")?;
        scanner.size("the largest tag")?;
        scanner.end_record()?;
        Ok(Self { of, blocks, records })
    }

    /// Demands that the blocks held as many records as declared.
    fn check(&self, scanner: &Scanner, found: usize) -> Result<(), GmshError> {
        if found == self.records { Ok(()) } else { Err(scanner.wrong_total(self.of, self.records, found)) }
    }
}
