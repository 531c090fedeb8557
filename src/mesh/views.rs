//! Data views of a mesh: numbers at its vertices or on its triangles, under a name.

use std::collections::BTreeMap;
use std::sync::Arc;

use thiserror::Error;

pub use crate::formats::gmsh::ViewPlace;
use crate::formats::gmsh::{GmshView, ViewData};
use crate::text::excerpt;

/// Numbers at vertices, or on triangles, of a mesh; not necessarily at all of them.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    place: ViewPlace,
    /// Vertices or triangles, in increasing order, with their values.
    values: Vec<(u32, f64)>,
}

impl View {
    /// Whether the values are at vertices or on triangles.
    pub fn place(&self) -> ViewPlace {
        self.place
    }

    /// The value at a vertex or on a triangle, if there is one. Takes time logarithmic in their number.
    pub fn value(&self, k: usize) -> Option<f64> {
        let found = self.values.binary_search_by_key(&k, |&(other, _)| other as usize).ok()?;
        Some(self.values[found].1)
    }

    /// Vertices or triangles, in increasing order, and their values.
    pub fn values(&self) -> impl Iterator<Item = (usize, f64)> {
        self.values.iter().map(|&(k, value)| (k as usize, value))
    }
}

/// The data views of a [`Mesh`](crate::mesh::Mesh): the fields `Field::View` of a problem name them.
///
/// Refinements inherit them: the midpoint of an edge has the mean of its ends, where both have a value, and the children of a
/// triangle have its value.
#[derive(Debug, Clone, Default)]
pub struct Views {
    views: BTreeMap<String, Result<Arc<View>, Arc<str>>>,
}

impl Views {
    /// The names, in alphabetical order, also of those that are of no use.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.views.keys().map(String::as_str)
    }

    /// The view of this name, if there is one; an error says why it is of no use as a datum, as one with several components.
    pub fn get(&self, name: &str) -> Option<Result<&View, &str>> {
        self.views.get(name).map(|view| match view {
            Ok(view) => Ok(&**view),
            Err(why) => Err(&**why),
        })
    }
}

/// Why a mesh cannot have a view.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ViewError {
    /// There is a view of this name.
    #[error("there is a view `{}` already: choose another name", excerpt(name))]
    Taken {
        /// The name.
        name: String,
    },
    /// Not one value for each vertex or triangle.
    #[error(
        "the view `{}` has {found} values, but the mesh has {expected} {of}: give one for each",
        excerpt(name)
    )]
    Length {
        /// The name.
        name: String,
        /// How many there are.
        found: usize,
        /// How many there must be.
        expected: usize,
        /// Vertices or triangles.
        of: &'static str,
    },
    /// A value that is infinite or no number.
    #[error("the view `{}` has the value {value} in place {index}: give finite ones", excerpt(name))]
    NotFinite {
        /// The name.
        name: String,
        /// Number of the vertex or triangle.
        index: usize,
        /// The value.
        value: f64,
    },
}

impl Views {
    /// Adds a view with a value for each of `expected` vertices or triangles.
    pub(in crate::mesh) fn add(
        &mut self,
        name: String,
        place: ViewPlace,
        values: impl IntoIterator<Item = f64>,
        expected: usize,
    ) -> Result<(), ViewError> {
        if self.views.contains_key(&name) {
            return Err(ViewError::Taken { name });
        }
        let values: Vec<(u32, f64)> = (0..).zip(values).collect();
        let of = match place {
            ViewPlace::Vertices => "vertices",
            ViewPlace::Triangles => "triangles",
        };
        if values.len() != expected {
            return Err(ViewError::Length { name, found: values.len(), expected, of });
        }
        if let Some(&(index, value)) = values.iter().find(|(_, value)| !value.is_finite()) {
            return Err(ViewError::NotFinite { name, index: index as usize, value });
        }
        self.views.insert(name, Ok(Arc::new(View { place, values })));
        Ok(())
    }

    /// Those of a file, on the mesh that was made from it.
    pub(in crate::mesh) fn of_file(views: Vec<GmshView>) -> Self {
        let view = |GmshView { name, data }| {
            let view = data.map(|ViewData { place, values, .. }| Arc::new(View { place, values }));
            (name, view.map_err(|fault| fault.to_string().into()))
        };
        Self { views: views.into_iter().map(view).collect() }
    }

    /// The same without the values of those that nobody asks for: refinements have nothing to inherit.
    #[cfg(feature = "cli")]
    pub(in crate::mesh) fn keep(&mut self, is_wanted: impl Fn(&str) -> bool) {
        self.views.retain(|name, _| is_wanted(name));
    }

    /// Those of a refinement, whose triangles lie in `origins` in increasing order, and whose new vertices, behind the `vertices`
    /// that there were, are the midpoints between their `parents`.
    pub(in crate::mesh) fn inherited(
        &self,
        origins: impl Iterator<Item = usize> + Clone,
        vertices: usize,
        parents: &[[usize; 2]],
    ) -> Self {
        let inherit = |view: &View| View {
            place: view.place,
            values: match view.place {
                ViewPlace::Vertices => at_midpoints(view, vertices, parents),
                ViewPlace::Triangles => on_children(view, origins.clone()),
            },
        };
        let inherit = |(name, view): (&String, &Result<Arc<View>, Arc<str>>)| {
            (name.clone(), view.as_ref().map(|view| Arc::new(inherit(view))).map_err(Arc::clone))
        };
        Self { views: self.views.iter().map(inherit).collect() }
    }
}

/// The mean of the ends, where both have a value.
fn at_midpoints(view: &View, vertices: usize, parents: &[[usize; 2]]) -> Vec<(u32, f64)> {
    let mean = |&[a, b]: &[usize; 2]| Some(0.5 * view.value(a)? + 0.5 * view.value(b)?);
    let midpoints = (vertices as u32..).zip(parents).filter_map(|(k, ends)| Some((k, mean(ends)?)));
    view.values.iter().copied().chain(midpoints).collect()
}

/// The value of the triangle in which each lies.
fn on_children(view: &View, origins: impl Iterator<Item = usize>) -> Vec<(u32, f64)> {
    let mut parents = view.values().peekable();
    let mut values = Vec::new();
    for (child, origin) in (0..).zip(origins) {
        while parents.next_if(|&(parent, _)| parent < origin).is_some() {}
        if let Some(&(parent, value)) = parents.peek()
            && parent == origin
        {
            values.push((child, value));
        }
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::samples::irregular;
    use crate::mesh::{Bisection, Mesh, MeshFamily};

    /// Coordinates of size one, halved a few times, are rounded.
    const ROUNDING: f64 = 1e-15;

    fn linear([x, y]: [f64; 2]) -> f64 {
        3.0 * x - 2.0 * y + 1.0
    }

    fn barycentre(mesh: &Mesh, t: usize) -> [f64; 2] {
        let corners = mesh.corners(t);
        [0, 1].map(|axis| corners.iter().map(|p| p[axis]).sum::<f64>() / 3.0)
    }

    /// The square with a linear function at its vertices, and whether triangles lie on the left.
    fn mesh() -> Mesh {
        let mesh = irregular(4);
        let linear: Vec<f64> = mesh.points().iter().map(|&p| linear(p)).collect();
        let numbers: Vec<f64> = (0..mesh.triangles().len()).map(|t| t as f64).collect();
        let mesh = mesh.with_view("linear", ViewPlace::Vertices, linear).unwrap();
        mesh.with_view("number", ViewPlace::Triangles, numbers).unwrap()
    }

    fn view<'m>(mesh: &'m Mesh, name: &str) -> &'m View {
        mesh.views().get(name).unwrap().unwrap()
    }

    /// Whether a refinement has the function, and the numbers of the triangles of `coarse` in which its own lie.
    fn check(coarse: &Mesh, fine: &Mesh) {
        let at_vertices = view(fine, "linear");
        assert_eq!(at_vertices.values().count(), fine.points().len());
        for (value, point) in at_vertices.values().zip(fine.points()) {
            assert!((value.1 - linear(*point)).abs() <= 8.0 * ROUNDING, "{value:?} {point:?}");
        }
        let numbers = view(fine, "number");
        assert_eq!(numbers.values().count(), fine.triangles().len());
        for (t, number) in numbers.values() {
            let p = barycentre(fine, t);
            let corners = coarse.corners(number as usize);
            let inside = (0..3).all(|i| {
                let [a, b] = [corners[i], corners[(i + 1) % 3]];
                (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0.0
            });
            assert!(inside, "triangle {t} lies in {number}");
        }
    }

    #[test]
    fn refinements_and_bisections_inherit_views() {
        let coarse = mesh();
        check(&coarse, &coarse);
        let mut family = MeshFamily::polygonal(coarse.clone());
        let mut bisection = Bisection::new(coarse.clone());
        for step in 0..3 {
            family.refine().unwrap();
            check(&coarse, family.mesh());
            let marked: Vec<usize> = (step..bisection.mesh().triangles().len()).step_by(5).collect();
            bisection.refine(&marked).unwrap();
            check(&coarse, bisection.mesh());
        }
    }

    #[test]
    fn where_a_view_says_nothing_its_refinement_says_nothing() {
        let mut coarse = mesh();
        let partial = |place, values: Vec<(u32, f64)>| GmshView {
            name: format!("{place:?}"),
            data: Ok(ViewData { place, values, left_out: 0 }),
        };
        let [a, b, _] = coarse.triangles()[0];
        let mut ends = vec![(a as u32, 2.0), (b as u32, 4.0)];
        ends.sort_unstable_by_key(|end| end.0);
        coarse.views = Views::of_file(vec![
            partial(ViewPlace::Vertices, ends),
            partial(ViewPlace::Triangles, vec![(1, 7.0), (3, 8.0)]),
        ]);
        let fine = coarse.refine().unwrap().mesh;
        let mut values: Vec<f64> = view(&fine, "Vertices").values().map(|value| value.1).collect();
        values.sort_unstable_by(f64::total_cmp);
        assert_eq!(values, [2.0, 3.0, 4.0], "the ends and their midpoint");
        let on = |k: usize| view(&fine, "Triangles").value(k);
        assert_eq!(
            [3, 4, 7, 8, 12, 15, 16].map(on),
            [None, Some(7.0), Some(7.0), None, Some(8.0), Some(8.0), None]
        );
    }

    #[test]
    fn a_view_has_a_name_of_its_own_and_a_finite_value_everywhere() {
        let refused = |name: &str, place, values: Vec<f64>| {
            mesh().with_view(name, place, values).unwrap_err().to_string()
        };
        let (vertices, triangles) = (mesh().points().len(), mesh().triangles().len());
        assert!(mesh().with_view("new", ViewPlace::Vertices, vec![1.0; vertices]).is_ok());
        assert_eq!(
            refused("linear", ViewPlace::Vertices, vec![1.0; vertices]),
            "there is a view `linear` already: choose another name"
        );
        assert!(
            refused("new", ViewPlace::Vertices, vec![1.0; triangles])
                .contains("has 32 values, but the mesh has 25 vertices")
        );
        assert!(
            refused("new", ViewPlace::Triangles, vec![f64::NAN; triangles])
                .contains("has the value NaN in place 0")
        );
    }
}
