//! The vertices of a mesh and those of coarser meshes from which they come, in one numbering.
//!
//! Bisections refine a part of a mesh at a time. A level for each of them would have nearly as many vertices as the next one, and
//! the levels together any multiple of the finest. So levels do not follow the steps in time: each leaves out all vertices that
//! are nobody's parent any more, wherever they are. On uniform refinements these are the coarser meshes; where a mesh is refined
//! here and there, every part of it becomes coarser at once (compare Chen, Zhang, J. Comput. Math. 28 (2010) 767).

use std::sync::Arc;

use crate::mesh::{Mesh, Parents};

/// In place of a vertex that is not there.
pub(super) const NONE: u32 = u32::MAX;

/// One to three vertices, of whose values another one takes the mean; [`NONE`] behind them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Mean([u32; 3]);

impl Mean {
    pub(crate) fn of_one(a: u32) -> Self {
        Self([a, NONE, NONE])
    }

    pub(crate) fn of_two(a: usize, b: usize) -> Self {
        Self([a as u32, b as u32, NONE])
    }

    pub(crate) fn of_three(corners: [usize; 3]) -> Self {
        Self(corners.map(|a| a as u32))
    }

    /// Of no vertex: that of a mesh of which no coarser one is known.
    const fn of_none() -> Self {
        Self([NONE; 3])
    }

    /// The vertices.
    pub(super) fn vertices(&self) -> &[u32] {
        &self.0[..self.0.iter().take_while(|&&a| a != NONE).count()]
    }

    /// The same by other numbers.
    pub(super) fn renumbered(&self, number: &[u32]) -> Self {
        Self(self.0.map(|a| if a == NONE { NONE } else { number[a as usize] }))
    }
}

/// For each vertex of a mesh the vertices of coarser ones whose mean it is.
pub(crate) struct Genealogy {
    /// A vertex of the coarsest mesh known has no parents.
    parents: Vec<Mean>,
    /// How many generations of descendants a vertex has.
    height: Vec<u16>,
    /// The vertices of the coarsest mesh known, in its numbering.
    coarsest: Vec<u32>,
}

impl Genealogy {
    /// Of a mesh of which no coarser one is known.
    pub(crate) fn unknown(vertices: usize) -> Self {
        let coarsest = (0..vertices as u32).collect();
        Self { parents: vec![Mean::of_none(); vertices], height: vec![0; vertices], coarsest }
    }

    /// Of a mesh with its ancestry.
    pub(crate) fn of(mesh: &Mesh) -> Self {
        let mut genealogy = Self::unknown(mesh.points().len());
        genealogy.follow(mesh.ancestry());
        genealogy
    }

    /// The coarsest mesh known has this ancestry.
    pub(crate) fn follow(&mut self, ancestry: &[Arc<Parents>]) {
        let mean = |&[a, b]: &[u32; 2]| if a == b { Mean::of_one(a) } else { Mean([a, b, NONE]) };
        for parents in ancestry.iter().rev() {
            self.go_back(parents.coarse_vertices(), parents.ends().iter().map(mean));
        }
    }

    /// The coarsest mesh known has the vertices of a coarser one first, and then the means of such vertices.
    pub(crate) fn refines(&mut self, coarse_vertices: usize, means: &[Mean]) {
        let kept = (0..coarse_vertices as u32).map(Mean::of_one);
        self.go_back(coarse_vertices, kept.chain(means.iter().copied()));
    }

    /// The vertices of the coarsest mesh known come from those of a coarser one, in whose numbering the means are.
    fn go_back(&mut self, coarse_vertices: usize, means: impl Iterator<Item = Mean> + Clone) {
        let mut coarser = vec![NONE; coarse_vertices];
        for (&a, mean) in self.coarsest.iter().zip(means.clone()) {
            if let [same] = mean.vertices() {
                coarser[*same as usize] = a;
            }
        }
        for (&a, mean) in self.coarsest.iter().zip(means).filter(|(_, mean)| mean.vertices().len() > 1) {
            let parents = mean.renumbered(&coarser);
            let height = self.height[a as usize] + 1;
            for &parent in parents.vertices() {
                let of_parent = &mut self.height[parent as usize];
                *of_parent = height.max(*of_parent);
            }
            self.parents[a as usize] = parents;
        }
        self.coarsest = coarser;
    }

    /// The parents of a vertex.
    pub(super) fn parents(&self, a: u32) -> Mean {
        self.parents[a as usize]
    }

    /// Whether a vertex is one of the coarsest mesh known.
    pub(super) fn is_root(&self, a: u32) -> bool {
        self.parents[a as usize] == Mean::of_none()
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
