//! Membranes that nothing holds but the neighbours that they are pressed against.

use std::ops::Range;

use super::error::StackError;
use super::membrane::MembraneData;
use crate::mesh::{Mesh, VertexKind};

/// The forces on membranes add up to nothing where they are no more than this fraction of their sizes: rounding.
const ROUNDING: f64 = 1e-12;

/// Membranes that rest on what is below them, or are held up against what is above, on a connected part of the mesh.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Rest {
    /// The vertex that stands for the part.
    pub(super) part: usize,
    /// The gaps that are closed somewhere, whatever else happens.
    pub(super) gaps: Range<usize>,
}

/// On a connected part of the mesh, what each membrane has there.
struct Part {
    root: usize,
    /// A vertex of it, to name it by.
    point: [f64; 2],
    is_held: Vec<bool>,
    /// The sum of the forces on each membrane, and of their sizes.
    force: Vec<[f64; 2]>,
}

/// Finds the membranes that neither a height nor a foundation holds on a connected part of the mesh. The others have a solution
/// that is theirs alone iff they are pressed against something that is held: of those over a support, all upper ones
/// together have to be pushed down, whichever are counted; of those under one, all lower ones up.
///
/// # Errors
/// Where one of them is not meant to be pressed, or is not.
pub(super) fn rests(
    mesh: &Mesh,
    membranes: &[MembraneData],
    may_be_pressed: &[bool],
    has_obstacles: [bool; 2],
    parts: &[usize],
) -> Result<Vec<Rest>, StackError> {
    let loose = |membrane: &MembraneData| !membrane.is_held_everywhere(mesh, parts);
    if !membranes.iter().any(loose) {
        return Ok(Vec::new());
    }
    let mut rests = Vec::new();
    for part in parts_of(mesh, membranes, parts) {
        let mut first = 1;
        while first <= membranes.len() {
            if part.is_held[first - 1] {
                first += 1;
                continue;
            }
            let behind = (first..=membranes.len()).find(|&i| part.is_held[i - 1]);
            let last = behind.map_or(membranes.len(), |behind| behind - 1);
            rests.push(part.rest(first..last + 1, may_be_pressed, has_obstacles)?);
            first = last + 1;
        }
    }
    Ok(rests)
}

/// All connected parts of a mesh. Linear time.
fn parts_of(mesh: &Mesh, membranes: &[MembraneData], parts: &[usize]) -> Vec<Part> {
    let used = || (0..parts.len()).filter(|&a| mesh.kind()[a] != VertexKind::Unused);
    let mut number = vec![usize::MAX; parts.len()];
    let mut found: Vec<Part> = Vec::new();
    for a in used().filter(|&a| parts[a] == a) {
        number[a] = found.len();
        found.push(Part {
            root: a,
            point: mesh.points()[a],
            is_held: vec![false; membranes.len()],
            force: vec![[0.0; 2]; membranes.len()],
        });
    }
    for a in used() {
        let part = &mut found[number[parts[a]]];
        for (k, membrane) in membranes.iter().enumerate() {
            part.is_held[k] |= membrane.is_held_at(a);
            part.force[k][0] += membrane.load[a];
            part.force[k][1] += membrane.load[a].abs();
        }
    }
    found
}

impl Part {
    /// Where the membranes `group`, which are held by nothing, rest.
    fn rest(
        &self,
        group: Range<usize>,
        may_be_pressed: &[bool],
        [ceiling, floor]: [bool; 2],
    ) -> Result<Rest, StackError> {
        let point = self.point;
        if let Some(membrane) = group.clone().find(|&i| !may_be_pressed[i - 1]) {
            return Err(StackError::Unsupported { membrane, point });
        }
        let has_support = [group.start > 1 || ceiling, group.end <= self.is_held.len() || floor];
        // The sign of the sum of the forces on some membranes, beyond rounding.
        let pushes = |some: Range<usize>, sign: f64| {
            let [sum, size] = some.map(|i| self.force[i - 1]).fold([0.0; 2], |[s, z], [f, g]| [s + f, z + g]);
            sign * sum > ROUNDING * size
        };
        let down = || group.clone().all(|i| pushes(group.start..i + 1, -1.0));
        let up = || group.clone().all(|i| pushes(i..group.end, 1.0));
        if has_support[1] && down() {
            Ok(Rest { part: self.root, gaps: group })
        } else if has_support[0] && up() {
            Ok(Rest { part: self.root, gaps: group.start - 1..group.end - 1 })
        } else {
            Err(StackError::NotPressed { membrane: group.start, point })
        }
    }
}
