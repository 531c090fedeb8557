//! `$Entities` and `$PartitionedEntities` of MSH 4: the parts of the geometry, and the physical groups they belong to.

use super::error::GmshError;
use super::groups::Groups;
use super::scanner::Scanner;
use super::v4::Layout;

/// Reads the points, curves, surfaces and volumes of the geometry, and keeps what groups they belong to.
pub(super) fn entities(scanner: &mut Scanner, layout: Layout, groups: &mut Groups) -> Result<(), GmshError> {
    Reader { scanner, layout, groups, partitioned: false }.read()
}

/// The like for the parts that a partition has made of them.
pub(super) fn partitioned_entities(
    scanner: &mut Scanner,
    layout: Layout,
    groups: &mut Groups,
) -> Result<(), GmshError> {
    scanner.skip_blank();
    scanner.size("the number of partitions")?;
    let ghosts = read_count(scanner, "ghost entities")?;
    for _ in 0..ghosts {
        read_int(scanner, "the tag of a ghost entity")?;
        read_int(scanner, "the partition of a ghost entity")?;
    }
    Reader { scanner, layout, groups, partitioned: true }.read()
}

/// Reads one of the sections. As for Gmsh, lines mean nothing in it.
struct Reader<'s, 'a> {
    scanner: &'s mut Scanner<'a>,
    layout: Layout,
    groups: &'s mut Groups,
    partitioned: bool,
}

impl Reader<'_, '_> {
    fn read(&mut self) -> Result<(), GmshError> {
        let mut numbers = [0; 4];
        for number in &mut numbers {
            *number = read_count(self.scanner, "entities")?;
        }
        for (dimension, number) in (0..).zip(numbers) {
            for _ in 0..number {
                self.entity(dimension)?;
            }
        }
        Ok(())
    }

    /// `tag box number-of-groups groups`, but for a point `number-of-boundary-entities boundary-entities`; for a part,
    /// `dimension tag number-of-partitions partitions` behind its tag.
    fn entity(&mut self, dimension: u8) -> Result<(), GmshError> {
        let entity = read_int(self.scanner, "the tag of an entity")?;
        if self.partitioned {
            read_int(self.scanner, "the dimension of a parent")?;
            read_int(self.scanner, "the tag of a parent")?;
            self.list("partitions of an entity", |_| {})?;
        }
        // Since MSH 4.1 the box around a point is the point.
        let bounds = if dimension == 0 && self.layout == Layout::V41 { 3 } else { 6 };
        for _ in 0..bounds {
            self.scanner.skip_blank();
            self.scanner.double("a coordinate of an entity")?;
        }
        let mut tags = Vec::new();
        self.list("physical groups of an entity", |tag| tags.push(tag))?;
        self.groups.add_entity(dimension, entity, &tags);
        if dimension > 0 {
            self.list("entities at the boundary of one", |_| {})?;
        }
        Ok(())
    }

    /// Reads how many numbers follow, and these.
    fn list(&mut self, of: &'static str, mut each: impl FnMut(i32)) -> Result<(), GmshError> {
        for _ in 0..read_count(self.scanner, of)? {
            each(read_int(self.scanner, of)?);
        }
        Ok(())
    }
}

fn read_int(scanner: &mut Scanner, expected: &str) -> Result<i32, GmshError> {
    scanner.skip_blank();
    scanner.int(expected)
}

fn read_count(scanner: &mut Scanner, of: &'static str) -> Result<usize, GmshError> {
    scanner.skip_blank();
    let declared = scanner.size("a count")?;
    scanner.count(declared, of)
}
