//! `$Nodes` and `$Elements` of MSH 2, where every record stands for itself and every whole number is an `int`. The versions 2.0,
//! 2.1 and 2.2 differ in labels that are not read.

use super::elements::{Elements, Kind, Shape};
use super::error::GmshError;
use super::groups::Groups;
use super::nodes::{Nodes, read_point};
use super::scanner::{Encoding, Scanner};

/// Reads the nodes: their number, then `tag x y z` for each; in `$ParametricNodes` with `dimension entity parameters` behind.
pub(super) fn nodes(scanner: &mut Scanner, parametric: bool) -> Result<Nodes, GmshError> {
    let declared = head(scanner, "nodes")?;
    let (mut tags, mut points, mut heights) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..declared {
        let tag = read_tag(scanner, "a node tag")?;
        read_point(scanner, tag, &mut points, &mut heights)?;
        if parametric {
            skip_parameters(scanner)?;
        }
        scanner.end_record()?;
        tags.push(tag);
    }
    Nodes::new(tags, points, heights)
}

/// A node in a curve has one parameter, in a surface two.
fn skip_parameters(scanner: &mut Scanner) -> Result<(), GmshError> {
    let dimension = scanner.int("the dimension of an entity")?;
    scanner.int("the tag of an entity")?;
    let parameters = if matches!(dimension, 1 | 2) { dimension } else { 0 };
    for _ in 0..parameters {
        scanner.double("a parameter of a node")?;
    }
    Ok(())
}

/// Reads the elements: their number, then one by one (ASCII) or in runs of one kind (binary).
pub(super) fn elements(
    scanner: &mut Scanner,
    nodes: &Nodes,
    groups: &mut Groups,
) -> Result<Elements, GmshError> {
    let declared = head(scanner, "elements")?;
    let mut reader = Reader { scanner, nodes, groups, elements: Elements::default() };
    match reader.scanner.encoding() {
        Encoding::Ascii => {
            for _ in 0..declared {
                reader.ascii_element()?;
            }
        }
        Encoding::Binary(_) => {
            let mut left = declared;
            while left > 0 {
                left -= reader.binary_run(left)?;
            }
        }
    }
    reader.groups.label_elements();
    Ok(reader.elements)
}

/// Reads the line with the number of records, which is text in binary files too.
fn head(scanner: &mut Scanner, of: &'static str) -> Result<usize, GmshError> {
    let declared: u64 = scanner.text_number("a number of records")?;
    let declared = scanner.count(declared, of)?;
    scanner.end_line()?;
    Ok(declared)
}

fn read_tag(scanner: &mut Scanner, expected: &str) -> Result<u64, GmshError> {
    let tag = scanner.int(expected)?;
    u64::try_from(tag).map_err(|_| scanner.unexpected(expected, &tag.to_string()))
}

/// Reads elements one after the other.
struct Reader<'s, 'a> {
    scanner: &'s mut Scanner<'a>,
    nodes: &'s Nodes,
    groups: &'s mut Groups,
    elements: Elements,
}

impl Reader<'_, '_> {
    /// `tag type number-of-labels labels nodes`.
    fn ascii_element(&mut self) -> Result<(), GmshError> {
        let element = read_tag(self.scanner, "an element tag")?;
        let kind = Kind::read(self.scanner)?;
        let labels = self.label_count()?;
        self.labels_and_nodes(element, kind, labels)?;
        self.scanner.end_line()
    }

    /// `type number-of-elements number-of-labels`, then `tag labels nodes` for each element; returns their number.
    fn binary_run(&mut self, left: usize) -> Result<usize, GmshError> {
        let kind = Kind::read(self.scanner)?;
        let length = self.scanner.int("the number of elements of a run")?;
        let Some(length) = usize::try_from(length).ok().filter(|length| (1..=left).contains(length)) else {
            let expected = format!("the number of elements of a run, from 1 to {left}");
            return Err(self.scanner.unexpected(&expected, &length.to_string()));
        };
        let labels = self.label_count()?;
        for _ in 0..length {
            let element = read_tag(self.scanner, "an element tag")?;
            self.labels_and_nodes(element, kind, labels)?;
        }
        Ok(length)
    }

    fn label_count(&mut self) -> Result<usize, GmshError> {
        let declared = self.scanner.int("the number of labels of an element")?;
        self.scanner.count(declared, "labels of an element")
    }

    /// Takes the first label, the physical group (0 is none, and the sign tells an orientation), skips the others (surface,
    /// partitions) and takes the nodes.
    fn labels_and_nodes(&mut self, element: u64, kind: Kind, labels: usize) -> Result<(), GmshError> {
        let shape = kind.shape;
        let mut group = 0;
        for label in 0..labels {
            let value = self.scanner.int("a label of an element")?;
            if label == 0 {
                self.groups.add(shape.dimension(), value);
                group = value.unsigned_abs();
            }
        }
        let mut corners = [0; 4];
        for corner in &mut corners[..shape.corners()] {
            *corner = self.node_tag()?;
        }
        for _ in 0..kind.between() {
            let node = self.node_tag()?;
            self.elements.add_between(self.nodes, node);
        }
        self.elements.curved += usize::from(kind.between() > 0);
        if matches!(shape, Shape::Triangle | Shape::Quadrangle) {
            let corners = &corners[..shape.corners()];
            self.elements.add_cell(self.scanner, self.nodes, element, corners)?;
            self.elements.drop_repetition();
            if group != 0 {
                self.elements.label_cell(group);
            }
            return Ok(());
        }
        self.elements.others += 1;
        if let (Shape::Line, [a, b, ..]) = (shape, corners)
            && group != 0
        {
            self.elements.add_line(self.scanner, self.nodes, element, [a, b], group);
        }
        Ok(())
    }

    fn node_tag(&mut self) -> Result<u64, GmshError> {
        read_tag(self.scanner, "the node tag of an element")
    }
}
