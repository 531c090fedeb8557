//! The vertices of a mesh and those of coarser meshes from which they come, in one numbering.
//!
//! Bisections refine a part of a mesh at a time. A level for each of them would have nearly as many vertices as the next one, and
//! the levels together any multiple of the finest. So levels do not follow the steps in time: each leaves out all vertices that
//! are nobody's parent any more, wherever they are. On uniform refinements these are the coarser meshes; where a mesh is refined
//! here and there, every part of it becomes coarser at once (compare Chen, Zhang, J. Comput. Math. 28 (2010) 767).

use crate::mesh::{Mesh, Parents};

/// In place of a parent that is not there.
pub(super) const NONE: u32 = u32::MAX;

/// For each vertex of a mesh the vertices of coarser ones whose mean it is.
pub(crate) struct Genealogy {
    /// At most three; [`NONE`] behind them. A vertex of the coarsest mesh known has none.
    parents: Vec<[u32; 3]>,
    /// How many generations of descendants a vertex has.
    height: Vec<u16>,
    /// The vertices of the coarsest mesh known, in its numbering.
    coarsest: Vec<u32>,
}

impl Genealogy {
    /// Of a mesh of which no coarser one is known.
    pub(crate) fn unknown(vertices: usize) -> Self {
        let coarsest = (0..vertices as u32).collect();
        Self { parents: vec![[NONE; 3]; vertices], height: vec![0; vertices], coarsest }
    }

    /// Of a mesh with its ancestry.
    pub(crate) fn of(mesh: &Mesh) -> Self {
        let mut genealogy = Self::unknown(mesh.points().len());
        mesh.ancestry().iter().rev().for_each(|parents| genealogy.go_back(parents));
        genealogy
    }

    /// The coarsest mesh known is a refinement of one that is coarser still.
    fn go_back(&mut self, parents: &Parents) {
        let of_vertex = |&[a, b]: &[u32; 2]| if a == b { [a, NONE, NONE] } else { [a, b, NONE] };
        self.go_back_by(parents.coarse_vertices(), parents.ends().iter().map(of_vertex));
    }

    /// Likewise, from the one to three vertices whose mean each is, in the numbering of the coarser mesh.
    pub(crate) fn go_back_by(
        &mut self,
        coarse_vertices: usize,
        means: impl Iterator<Item = [u32; 3]> + Clone,
    ) {
        let mut coarser = vec![NONE; coarse_vertices];
        let is_kept = |[_, second, _]: [u32; 3]| second == NONE;
        for (&a, mean) in self.coarsest.iter().zip(means.clone()) {
            if is_kept(mean) {
                coarser[mean[0] as usize] = a;
            }
        }
        for (&a, mean) in self.coarsest.iter().zip(means) {
            if is_kept(mean) {
                continue;
            }
            let parents = mean.map(|c| if c == NONE { NONE } else { coarser[c as usize] });
            let height = self.height[a as usize] + 1;
            for parent in parents.into_iter().filter(|&parent| parent != NONE) {
                let of_parent = &mut self.height[parent as usize];
                *of_parent = height.max(*of_parent);
            }
            self.parents[a as usize] = parents;
        }
        self.coarsest = coarser;
    }

    /// The parents of a vertex, [`NONE`] behind them.
    pub(super) fn parents(&self, a: u32) -> [u32; 3] {
        self.parents[a as usize]
    }

    /// Whether a vertex is one of the coarsest mesh known.
    pub(super) fn is_root(&self, a: u32) -> bool {
        self.parents[a as usize][0] == NONE
    }

    /// Whether a vertex belongs to the level that is so many generations below the finest one.
    pub(super) fn is_on_level(&self, a: u32, generations: usize) -> bool {
        usize::from(self.height[a as usize]) >= generations || self.is_root(a)
    }

    /// The vertices of the coarsest mesh known.
    pub(super) fn roots(&self) -> &[u32] {
        &self.coarsest
    }

    /// All vertices, parents before their children.
    pub(super) fn eldest_first(&self) -> Vec<u32> {
        let eldest = self.height.iter().copied().max().unwrap_or(0);
        let mut order: Vec<u32> = Vec::with_capacity(self.height.len());
        let mut start = vec![0usize; usize::from(eldest) + 2];
        self.height.iter().for_each(|&height| start[usize::from(eldest - height) + 1] += 1);
        for k in 0..=usize::from(eldest) {
            start[k + 1] += start[k];
        }
        order.resize(self.height.len(), 0);
        for (a, &height) in self.height.iter().enumerate() {
            let at = &mut start[usize::from(eldest - height)];
            order[*at] = a as u32;
            *at += 1;
        }
        order
    }
}
