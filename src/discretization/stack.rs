//! A stack of membranes between obstacles on a mesh: everything that its discrete problem is made of.

mod chain;
mod data;
mod error;
mod fields;
mod membrane;
mod obstacles;
mod pressed;
mod samples;
mod scales;
mod supports;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use super::areas::dual_areas;
use super::scales::Scales;
use crate::fem::{StiffnessMatrix, row_of, weighted_stiffness};
use crate::mesh::Mesh;
use crate::problem::{ContactProblem, Field};

pub(crate) use chain::Segment;
use chain::{Layer, segments};
pub use error::StackError;
pub use fields::IntegrationRule;
use fields::{POSITIVE, borders, means};
use membrane::{MembraneData, connected_parts, profile};
use obstacles::{check_order, obstacle};
use pressed::{Rest, rests};
pub(crate) use samples::{Samples, at_samples};

/// Displacements over vertices, one for each membrane from the top.
pub type Displacements = Vec<Vec<f64>>;

/// The discrete problem of a stack: the energy of each membrane, and a row for each gap and vertex.
///
/// From the top, layer 0 is the ceiling, `1 ..= N` are the membranes, `N + 1` is the floor; gap `k` lies between layers `k` and
/// `k + 1`. Unknown are the displacements at all vertices where a membrane is not fixed. On a triangle the tension is its mean;
/// the foundation is lumped with its mean: `C_i = diag(sum_K c_K |K| / 3)`, and belongs to `K_i`.
///
/// ```
/// use membrane_contact::prelude::*;
///
/// let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [16, 16], Pattern::Right)?;
/// let values: Vec<f64> = mesh.points().iter().map(|&[x, y]| -10.0 * x * y).collect();
/// let sheet = Membrane::new(1.0).load(Field::PerVertex(values.into()));
/// let d = Discretization::new(&ContactProblem::obstacle(sheet, -0.05)?, mesh)?;
/// let solution = certify(&d, Auto.solve(&d, &SolverOptions::default())?, 1e-8)?;
/// assert!(solution.gap(1).is_some_and(|gap| gap.total_force > 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct StackDiscretization {
    problem: ContactProblem,
    rule: IntegrationRule,
    mesh: Arc<Mesh>,
    membranes: Vec<MembraneData>,
    /// Tensions up to a factor, over triangles: membranes whose tensions are in proportion share one.
    profiles: Vec<Vec<f64>>,
    /// Their stiffness matrices, on all vertices.
    stiffness: Vec<StiffnessMatrix>,
    /// Ceiling and floor over vertices.
    obstacles: [Option<Vec<f64>>; 2],
    /// The edges between the regions by which they are given.
    obstacle_lines: [Vec<[usize; 2]>; 2],
    rows: Vec<GapRow>,
    /// Where the rows of gap `k` begin, and where the last ones end.
    row_start: Vec<usize>,
    unknowns: usize,
    /// The rows in which membranes that nothing else holds are pressed together, before anybody knows more.
    resting: Vec<usize>,
    dual_area: Vec<f64>,
    scales: Scales,
}

/// Gap `gap` at a vertex, where at least one side is free: `u_upper - u_lower >= bound`; a side that is known is in the bound.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GapRow {
    /// Between layers `gap` and `gap + 1`.
    pub gap: usize,
    /// The vertex.
    pub vertex: usize,
    /// The unknown of the upper layer, if it is one.
    pub upper: Option<usize>,
    /// The unknown of the lower layer, if it is one.
    pub lower: Option<usize>,
    /// Unit: length.
    pub bound: f64,
}

impl GapRow {
    /// Those of the two layers that are free membranes.
    pub(crate) fn free_layers(&self) -> impl Iterator<Item = usize> + use<> {
        let Self { gap, upper, lower, .. } = *self;
        [upper.map(|_| gap), lower.map(|_| gap + 1)].into_iter().flatten()
    }
}

impl StackDiscretization {
    /// Assembles the discrete problem. Linear time and memory.
    ///
    /// # Errors
    /// [`StackError`].
    pub fn new(problem: &ContactProblem, mesh: impl Into<Arc<Mesh>>) -> Result<Self, StackError> {
        Self::by_rule(problem, mesh, IntegrationRule::default())
    }

    /// Likewise, with tensions, loads and foundations integrated by another rule.
    ///
    /// # Errors
    /// [`StackError`].
    pub fn by_rule(
        problem: &ContactProblem,
        mesh: impl Into<Arc<Mesh>>,
        rule: IntegrationRule,
    ) -> Result<Self, StackError> {
        let shared: Arc<Mesh> = mesh.into();
        let mesh = &*shared;
        let dual_area = dual_areas(mesh);
        let parts = connected_parts(mesh);
        let mut profiles: Vec<Vec<f64>> = Vec::new();
        let (mut membranes, mut unknowns) = (Vec::new(), 0);
        let mut tensions = Vec::new();
        for (k, membrane) in problem.membranes().iter().enumerate() {
            let name = k + 1;
            let tension = means(mesh, &membrane.tension, &format!("tension mu{name}"), rule, POSITIVE)?;
            let (factor, profile) = profile(&mut profiles, &tension);
            let data = MembraneData::new(mesh, membrane, name, rule, (factor, profile), unknowns)?;
            unknowns += data.vertices.len();
            membranes.push(data);
            tensions.push(tension);
        }
        let stiffness: Vec<StiffnessMatrix> =
            profiles.iter().map(|mu| weighted_stiffness(mesh, |t| mu[t])).collect();
        let mut obstacles = [
            obstacle(mesh, problem.ceiling(), "the ceiling", f64::min)?,
            obstacle(mesh, problem.floor(), "the floor", f64::max)?,
        ];
        let lines = |field: Option<&Field>, name: &str| {
            field.map_or(Ok(Vec::new()), |field| borders(mesh, field, name))
        };
        let obstacle_lines = [lines(problem.ceiling(), "the ceiling")?, lines(problem.floor(), "the floor")?];
        let scales = scales::scales(mesh, &membranes, &tensions, &obstacles, &dual_area);
        scales::check_range(&scales, &tensions)?;
        check_order(mesh, &membranes, &mut obstacles, scales.displacement)?;
        let may_be_pressed: Vec<bool> = problem.membranes().iter().map(|membrane| membrane.pressed).collect();
        let has_obstacles = [obstacles[0].is_some(), obstacles[1].is_some()];
        let rests = rests(mesh, &membranes, &may_be_pressed, has_obstacles, &parts)?;
        let mut stack = Self {
            problem: problem.clone(),
            rule,
            membranes,
            profiles,
            stiffness,
            obstacles,
            obstacle_lines,
            rows: Vec::new(),
            row_start: vec![0],
            unknowns,
            resting: Vec::new(),
            dual_area,
            scales,
            mesh: shared,
        };
        for gap in 0..=stack.membranes.len() {
            let rows = (0..stack.dual_area.len()).filter_map(|a| stack.row_at(gap, a)).collect::<Vec<_>>();
            stack.rows.extend(rows);
            stack.row_start.push(stack.rows.len());
        }
        for Rest { part, gaps } in rests {
            let in_part = |row: &usize| {
                let GapRow { gap, vertex, .. } = stack.rows[*row];
                gaps.contains(&gap) && parts[vertex] == part
            };
            let resting: Vec<usize> = (0..stack.rows.len()).filter(in_part).collect();
            stack.resting.extend(resting);
        }
        Ok(stack)
    }

    /// The mesh.
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }

    /// How many membranes there are, `N`.
    pub fn membranes(&self) -> usize {
        self.membranes.len()
    }

    /// Whether there is a ceiling, and a floor.
    pub fn has_obstacles(&self) -> [bool; 2] {
        [0, 1].map(|k| self.obstacles[k].is_some())
    }

    /// Whether it is one membrane with at most one obstacle, which does not hold it up alone.
    pub fn is_obstacle_problem(&self) -> bool {
        self.membranes() == 1 && self.has_obstacles() != [true; 2] && self.resting.is_empty()
    }

    /// A first guess of the rows that touch: those by which membranes are held that nothing else holds.
    pub(crate) fn resting(&self) -> Vec<bool> {
        let mut rests = vec![false; self.rows.len()];
        self.resting.iter().for_each(|&row| rests[row] = true);
        rests
    }

    /// Whether all membranes are held by heights and foundations.
    pub(crate) fn is_held(&self) -> bool {
        self.resting.is_empty()
    }

    /// The heights of ceiling and floor over vertices.
    pub fn obstacles(&self) -> [Option<&[f64]>; 2] {
        [0, 1].map(|k| self.obstacles[k].as_deref())
    }

    /// The gaps `k` between two layers that there are, in increasing order.
    pub fn gaps(&self) -> Vec<usize> {
        let last = self.membranes.len();
        let [ceiling, floor] = self.has_obstacles();
        (0..=last).filter(|&k| (k > 0 || ceiling) && (k < last || floor)).collect()
    }

    /// The rows, by gap and then by vertex.
    pub fn rows(&self) -> &[GapRow] {
        &self.rows
    }

    /// The rows of a gap.
    pub(crate) fn rows_of(&self, gap: usize) -> std::ops::Range<usize> {
        self.row_start[gap]..self.row_start[gap + 1]
    }

    /// The row of gap `k` at vertex `a`, where there is one.
    pub(crate) fn row(&self, k: usize, a: usize) -> Option<usize> {
        let of_gap = self.rows_of(k);
        let found = self.rows[of_gap.clone()].binary_search_by_key(&a, |row| row.vertex).ok()?;
        Some(of_gap.start + found)
    }

    /// The segments at vertex `a`, from the top, where the layers of the `closed` rows touch; `layers` is memory.
    pub(crate) fn segments<'l>(
        &'l self,
        a: usize,
        closed: &'l [bool],
        layers: &'l mut Vec<Layer>,
    ) -> impl Iterator<Item = Segment> + 'l {
        layers.clear();
        layers.extend((0..=self.membranes.len() + 1).map(|layer| self.layer(layer, a)));
        segments(layers, move |gap| self.row(gap, a).is_some_and(|row| closed[row]))
    }

    /// How many unknowns there are in all membranes.
    pub fn unknowns(&self) -> usize {
        self.unknowns
    }

    /// The vertices at which membrane `i` (from 1) is free, in the order of its unknowns.
    pub fn free_vertices(&self, i: usize) -> &[usize] {
        &self.membranes[i - 1].vertices
    }

    /// The load vector `F_i` of membrane `i` (from 1) over vertices. Unit: force.
    pub fn load(&self, i: usize) -> &[f64] {
        &self.membranes[i - 1].load
    }

    /// `|D_a| = |Delta_a| / 3`, over vertices; zero at unused ones.
    pub fn dual_area(&self) -> &[f64] {
        &self.dual_area
    }

    /// The sizes that residuals are measured against.
    pub fn scales(&self) -> Scales {
        self.scales
    }

    /// Where the first unknown of membrane `i` (from 1) is.
    pub(crate) fn first_unknown(&self, i: usize) -> usize {
        self.membranes[i - 1].first
    }

    /// The number of the unknown of membrane `i` (from 1) at a vertex; `None` where it is held.
    pub fn unknown(&self, i: usize, a: usize) -> Option<usize> {
        self.membranes[i - 1].number[a].map(|number| number as usize)
    }

    /// The height at which membrane `i` (from 1) is fixed at a vertex.
    pub(crate) fn height(&self, i: usize, a: usize) -> Option<f64> {
        self.membranes[i - 1].held.height[a]
    }

    /// Layer `layer` at vertex `a`.
    pub(crate) fn layer(&self, layer: usize, a: usize) -> Layer {
        let last = self.membranes.len() + 1;
        if layer == 0 || layer == last {
            let obstacle = &self.obstacles[usize::from(layer == last)];
            return obstacle.as_ref().map_or(Layer::Absent, |heights| Layer::Known(heights[a]));
        }
        let membrane = &self.membranes[layer - 1];
        match (membrane.number[a], membrane.held.height[a]) {
            (Some(number), _) => Layer::Unknown(number as usize),
            (None, Some(height)) => Layer::Known(height),
            (None, None) => Layer::Absent,
        }
    }

    /// The height of layer `layer` at vertex `a`, where there is one.
    pub(crate) fn height_of_layer(&self, u: &[Vec<f64>], layer: usize, a: usize) -> Option<f64> {
        match self.layer(layer, a) {
            Layer::Absent => None,
            Layer::Known(height) => Some(height),
            Layer::Unknown(_) => Some(u[layer - 1][a]),
        }
    }

    /// `u_k - u_(k+1)` at the vertex of a row.
    pub(crate) fn gap(&self, u: &[Vec<f64>], row: &GapRow) -> f64 {
        let [upper, lower] = [row.gap, row.gap + 1].map(|layer| self.height_of_layer(u, layer, row.vertex));
        upper.zip(lower).map_or(f64::NAN, |(upper, lower)| upper - lower)
    }

    /// `K_i` on all vertices, with the foundation.
    pub(crate) fn matrix(&self, i: usize) -> StiffnessMatrix {
        let MembraneData { factor, profile, foundation, .. } = &self.membranes[i - 1];
        let mut matrix = self.stiffness[*profile].map(|k| factor * k);
        for (a, c) in foundation.iter().flatten().enumerate() {
            if let Some(diagonal) = matrix.get_mut(a, a) {
                *diagonal += c;
            }
        }
        matrix
    }

    /// The columns and entries of row `a` of `K_i`, without the foundation.
    pub(crate) fn stiffness_row(&self, i: usize, a: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let MembraneData { factor, profile, .. } = &self.membranes[i - 1];
        row_of(&self.stiffness[*profile], a).map(move |(b, k)| (b, factor * k))
    }

    /// `c_i |D_a|`, the entry that the foundation adds to the diagonal.
    pub(crate) fn foundation(&self, i: usize, a: usize) -> f64 {
        self.membranes[i - 1].foundation.as_ref().map_or(0.0, |foundation| foundation[a])
    }

    /// `(K_i)_aa`, with the foundation.
    pub(crate) fn diagonal(&self, i: usize, a: usize) -> f64 {
        self.stiffness_row(i, a).find(|&(b, _)| b == a).map_or(0.0, |(_, k)| k) + self.foundation(i, a)
    }

    /// `(K_i u)_a` for membrane `i` (from 1), and the size of the terms that cancel in it.
    pub(crate) fn stiffness_times(&self, i: usize, a: usize, u: &[f64]) -> [f64; 2] {
        let MembraneData { factor, profile, foundation, .. } = &self.membranes[i - 1];
        let [mut sum, mut terms] = [0.0; 2];
        for (b, k) in row_of(&self.stiffness[*profile], a) {
            sum += k * u[b];
            terms += (k * u[b]).abs();
        }
        let on_foundation = foundation.as_ref().map_or(0.0, |foundation| foundation[a] * u[a]);
        [factor * sum + on_foundation, factor * terms + on_foundation.abs()]
    }

    /// `(K_i u - F_i)_a`, likewise.
    pub(crate) fn imbalance(&self, i: usize, a: usize, u: &[f64]) -> [f64; 2] {
        let load = self.membranes[i - 1].load[a];
        let [force, terms] = self.stiffness_times(i, a, u);
        [force - load, terms + load.abs()]
    }

    /// Displacements over vertices from the values of the unknowns; heights where they are fixed.
    pub(crate) fn extend(&self, x: &[f64]) -> Displacements {
        let extended = |membrane: &MembraneData| {
            let value = |(number, height): (&Option<u32>, &Option<f64>)| match number {
                Some(number) => x[*number as usize],
                None => height.unwrap_or(0.0),
            };
            membrane.number.iter().zip(&membrane.held.height).map(value).collect()
        };
        self.membranes.iter().map(extended).collect()
    }

    /// The values of the unknowns of displacements over vertices.
    pub(crate) fn restrict(&self, u: &[Vec<f64>]) -> Vec<f64> {
        let of = |(membrane, u): (&MembraneData, &Vec<f64>)| -> Vec<f64> {
            membrane.vertices.iter().map(|&a| u[a]).collect()
        };
        self.membranes.iter().zip(u).flat_map(of).collect()
    }

    fn row_at(&self, gap: usize, a: usize) -> Option<GapRow> {
        let (upper, lower, bound) = match [gap, gap + 1].map(|layer| self.layer(layer, a)) {
            [Layer::Unknown(upper), Layer::Unknown(lower)] => (Some(upper), Some(lower), 0.0),
            [Layer::Unknown(upper), Layer::Known(height)] => (Some(upper), None, height),
            [Layer::Known(height), Layer::Unknown(lower)] => (None, Some(lower), -height),
            _ => return None,
        };
        Some(GapRow { gap, vertex: a, upper, lower, bound })
    }
}
