//! `$Nodes` and `$Elements` of MSH 4, one block for each entity of the geometry.

use super::elements::{Elements, Kind, Label, Shape};
use super::error::GmshError;
use super::nodes::{Nodes, read_point};
use super::scanner::Scanner;

/// The two layouts of MSH 4.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Layout {
    /// MSH 4.0: each node on one line with its tag, and the tag of an entity before its dimension.
    V40,
    /// MSH 4.1: in a block all tags come first.
    V41,
}

/// Reads the nodes. They may carry parameters behind `z`.
pub(super) fn nodes(scanner: &mut Scanner, layout: Layout) -> Result<Nodes, GmshError> {
    let (mut tags, mut points, mut heights) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..read_head(scanner, layout)? {
        let (dimension, _) = read_entity(scanner, layout)?;
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
        if layout == Layout::V41 {
            for _ in 0..length {
                tags.push(scanner.size("a node tag")?);
                scanner.end_record()?;
            }
        }
        for k in first..first + length {
            if layout == Layout::V40 {
                tags.push(scanner.size("a node tag")?);
            }
            read_point(scanner, tags[k], &mut points, &mut heights)?;
            for _ in 0..parameters {
                scanner.double("a parameter of a node")?;
            }
            scanner.end_record()?;
        }
    }
    Nodes::new(tags, points, heights)
}

/// Reads the elements. A block holds elements of one kind.
pub(super) fn elements(scanner: &mut Scanner, layout: Layout, nodes: &Nodes) -> Result<Elements, GmshError> {
    let mut elements = Elements::default();
    for _ in 0..read_head(scanner, layout)? {
        let (dimension, entity) = read_entity(scanner, layout)?;
        let kind = Kind::read(scanner)?;
        let shape = kind.shape;
        // Groups have members of their own dimension.
        let label = (dimension == i32::from(shape.dimension())).then_some(entity as Label);
        let length = read_count(scanner, "elements of a block")?;
        scanner.end_record()?;
        for _ in 0..length {
            let element = scanner.size("an element tag")?;
            let mut corners = [0; 4];
            for corner in &mut corners[..shape.corners()] {
                *corner = scanner.size("the node tag of an element")?;
            }
            for _ in 0..kind.between() {
                let node = scanner.size("the node tag of an element")?;
                elements.add_between(nodes, node);
            }
            elements.curved += usize::from(kind.between() > 0);
            if matches!(shape, Shape::Triangle | Shape::Quadrangle) {
                elements.add_cell(scanner, nodes, element, &corners[..shape.corners()])?;
                label.into_iter().for_each(|label| elements.label_cell(label));
            } else {
                elements.others += 1;
            }
            if let (Shape::Line, Some(label), [a, b, ..]) = (shape, label, corners) {
                elements.add_line(scanner, nodes, element, [a, b], label);
            }
            scanner.end_record()?;
        }
    }
    Ok(elements)
}

fn read_count(scanner: &mut Scanner, of: &'static str) -> Result<usize, GmshError> {
    let declared = scanner.size("a count")?;
    scanner.count(declared, of)
}

/// Reads the first record of a section; the number of blocks. As for Gmsh, the number of records in all of them and the range
/// of tags behind it mean nothing: the blocks say it again.
fn read_head(scanner: &mut Scanner, layout: Layout) -> Result<usize, GmshError> {
    let blocks = read_count(scanner, "blocks")?;
    scanner.size("a count")?;
    if layout == Layout::V41 {
        scanner.size("the smallest tag")?;
        scanner.size("the largest tag")?;
    }
    scanner.end_record()?;
    Ok(blocks)
}

/// Reads which entity a block belongs to: its dimension and its tag.
fn read_entity(scanner: &mut Scanner, layout: Layout) -> Result<(i32, i32), GmshError> {
    if layout == Layout::V40 {
        let tag = scanner.int("the tag of an entity")?;
        return Ok((scanner.int("the dimension of an entity")?, tag));
    }
    Ok((scanner.int("the dimension of an entity")?, scanner.int("the tag of an entity")?))
}
