//! The physical groups of a Gmsh file as the named parts of its mesh.

#[cfg(test)]
mod tests;

use std::fmt::Write as _;

use crate::formats::gmsh::{GroupMembers, PhysicalGroup};
use crate::mesh::Mesh;
use crate::mesh::groups::{Family, Groups, Names};

/// Regions are the groups of surfaces, curves those of curves; groups that are called alike are one.
pub(super) fn named_parts(mesh: &Mesh, groups: &[PhysicalGroup], mut members: GroupMembers) -> Groups {
    let triangles = std::mem::take(&mut members.triangles);
    let edges = edges_among(std::mem::take(&mut members.lines), mesh);
    Groups::new(family(2, groups, &members, triangles), family(1, groups, &members, edges))
}

/// The names of the groups of a dimension, and what carries them.
fn family<M: Copy + Ord>(
    dimension: u8,
    groups: &[PhysicalGroup],
    members: &GroupMembers,
    with_parts: Vec<(M, u32)>,
) -> Family<M> {
    // Groups are in the order of their dimensions; parts without one of this dimension have no members here.
    let first = groups.partition_point(|group| group.dimension < dimension);
    let end = groups.partition_point(|group| group.dimension <= dimension);
    let (names, number) = distinct(names(&groups[first..end]));
    let carried = |part: &[u32]| -> Vec<u32> {
        let here = part.iter().filter(|&&group| (first..end).contains(&(group as usize)));
        here.map(|&group| number[group as usize - first]).collect()
    };
    Family::new(names, members.parts().map(carried), with_parts)
}

/// The names, with not a byte of memory more than they need.
fn names(groups: &[PhysicalGroup]) -> Names {
    let mut names = Names::with_capacity(groups.len(), groups.iter().map(PhysicalGroup::name_length).sum());
    let mut name = String::new();
    for group in groups {
        name.clear();
        // Writing to a text cannot fail.
        let _ = write!(name, "{group}");
        names.push(&name);
    }
    names
}

/// Each name once, where it comes first, and for each name that was given its number among them.
fn distinct(names: Names) -> (Names, Vec<u32>) {
    let mut order: Vec<u32> = (0..names.len() as u32).collect();
    let name = |k: u32| names.get(k as usize);
    order.sort_unstable_by(|&j, &k| name(j).cmp(name(k)).then(j.cmp(&k)));
    // First for each name the place of the first that is like it; then, in the order of the names, its number.
    let mut number = vec![0; names.len()];
    for alike in order.chunk_by(|&j, &k| name(j) == name(k)) {
        alike.iter().for_each(|&k| number[k as usize] = alike[0]);
    }
    drop(order);
    if (0..).zip(&number).all(|(k, &first)| k == first) {
        return (names, number);
    }
    let mut kept = Names::default();
    for k in 0..names.len() {
        let first = number[k] as usize;
        if first == k {
            number[k] = kept.len() as u32;
            kept.push(names.get(k));
        } else {
            number[k] = number[first];
        }
    }
    (kept, number)
}

/// Those of the lines that are edges of the mesh, by their ends, the lower one first.
fn edges_among(mut lines: Vec<([u32; 2], u32)>, mesh: &Mesh) -> Vec<([u32; 2], u32)> {
    let mut at_line = vec![false; mesh.points().len()];
    for (ends, _) in &mut lines {
        ends.sort_unstable();
        ends.iter().for_each(|&a| at_line[a as usize] = true);
    }
    lines.sort_unstable();
    let mut is_edge = vec![false; lines.len()];
    let sides = mesh.triangles().iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    for [a, b] in sides.filter(|ends| ends.iter().all(|&a| at_line[a])) {
        let ends = [a.min(b), a.max(b)].map(|a| a as u32);
        let start = lines.partition_point(|(other, _)| *other < ends);
        let same = lines[start..].iter().take_while(|(other, _)| *other == ends).count();
        is_edge[start..start + same].fill(true);
    }
    let mut is_edge = is_edge.into_iter();
    lines.retain(|_| is_edge.next() == Some(true));
    lines
}
