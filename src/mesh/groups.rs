//! Named parts of a mesh.

mod family;
mod names;
#[cfg(test)]
mod tests;

use std::ops::Range;

pub(in crate::mesh) use family::Family;
pub use names::Names;

/// The named parts of a [`Mesh`](crate::mesh::Mesh): *regions* are sets of triangles, *curves* sets of edges, on the boundary
/// or inside.
///
/// They may overlap. Refinements inherit them: the children of a triangle are in its regions, the halves of an edge in its
/// curves. A region and a curve may be called alike, two regions or two curves not.
#[derive(Debug, Clone, Default)]
pub struct Groups {
    regions: Family<u32>,
    /// Edges by their ends, the lower one first.
    curves: Family<[u32; 2]>,
}

impl Groups {
    /// Whether nothing has a name.
    pub fn is_empty(&self) -> bool {
        self.regions().is_empty() && self.curves().is_empty()
    }

    /// The names of the regions, each once: in the order of a file, or in which they were given.
    pub fn regions(&self) -> &Names {
        self.regions.names()
    }

    /// The names of the curves, likewise.
    pub fn curves(&self) -> &Names {
        self.curves.names()
    }

    /// The triangles of a region, each once, in increasing order; `None` when no region is called `name`. Takes time
    /// proportional to the number of triangles of all regions.
    pub fn region<'g>(&'g self, name: &str) -> Option<impl Iterator<Item = usize> + use<'g>> {
        Some(self.regions.members(name)?.map(|t| t as usize))
    }

    /// The edges of a curve by their ends, the lower one first, each once, in increasing order; `None` when no curve is
    /// called `name`. Takes time proportional to the number of edges of all curves.
    pub fn curve<'g>(&'g self, name: &str) -> Option<impl Iterator<Item = [usize; 2]> + use<'g>> {
        Some(self.curves.members(name)?.map(|ends| ends.map(|a| a as usize)))
    }

    /// The names of the regions in which triangle `t` lies.
    pub fn regions_of(&self, t: usize) -> Vec<&str> {
        self.regions.names_of(number(t))
    }

    /// The names of the curves in which the edge between two vertices lies.
    pub fn curves_of(&self, ends: [usize; 2]) -> Vec<&str> {
        self.curves.names_of(edge(ends))
    }
}

/// Triangles and vertices are counted in 32 bits: more would take hundreds of gigabytes.
fn number(n: usize) -> u32 {
    u32::try_from(n).expect("a mesh has less than 2^32 triangles and vertices")
}

fn edge([a, b]: [usize; 2]) -> [u32; 2] {
    [number(a.min(b)), number(a.max(b))]
}

impl Groups {
    pub(in crate::mesh) fn new(regions: Family<u32>, curves: Family<[u32; 2]>) -> Self {
        Self { regions, curves }
    }

    /// Curves that do not overlap, with their edges by their ends in any order.
    pub(in crate::mesh) fn of_curves<'n>(
        curves: impl IntoIterator<Item = (&'n str, Vec<[usize; 2]>)>,
    ) -> Self {
        let add =
            |groups: Self, (name, edges): (&str, Vec<[usize; 2]>)| groups.with_curve(name.into(), edges);
        curves.into_iter().fold(Self::default(), add)
    }

    /// Curves that overlap: their names, for each part of them the numbers of the names that it carries, and edges with their
    /// parts.
    pub(in crate::mesh) fn of_overlapping_curves(
        names: Names,
        parts: impl IntoIterator<Item = Vec<usize>>,
        edges: impl IntoIterator<Item = ([usize; 2], usize)>,
    ) -> Self {
        let parts = parts.into_iter().map(|names| names.into_iter().map(number));
        let edges = edges.into_iter().map(|(ends, part)| (edge(ends), number(part))).collect();
        Self { curves: Family::new(names, parts, edges), ..Self::default() }
    }

    /// The same with a further region; no other one is called like it.
    pub(in crate::mesh) fn with_region(
        self,
        name: String,
        triangles: impl IntoIterator<Item = usize>,
    ) -> Self {
        Self { regions: self.regions.with(name, triangles.into_iter().map(number)), ..self }
    }

    /// The same with a further curve; no other one is called like it.
    pub(in crate::mesh) fn with_curve(
        self,
        name: String,
        edges: impl IntoIterator<Item = [usize; 2]>,
    ) -> Self {
        Self { curves: self.curves.with(name, edges.into_iter().map(edge)), ..self }
    }

    /// Those of a refinement.
    ///
    /// `children` are the numbers of the triangles that a triangle becomes; it is asked in increasing order. `halved` are the ends of the edges that are halved,
    /// the lower one first, in increasing order; their midpoints are the vertices behind the `vertices` that there were.
    pub(in crate::mesh) fn inherited(
        &self,
        mut children: impl FnMut(usize) -> Range<usize>,
        vertices: usize,
        halved: &[[usize; 2]],
    ) -> Self {
        let halves = |[a, b]: [u32; 2]| match halved.binary_search(&[a as usize, b as usize]) {
            Ok(k) => [Some([a, number(vertices + k)]), Some([b, number(vertices + k)])],
            Err(_) => [Some([a, b]), None],
        };
        Self {
            regions: self.regions.inherited(|t| children(t as usize).map(number)),
            curves: self.curves.inherited(|ends| halves(ends).into_iter().flatten()),
        }
    }
}
