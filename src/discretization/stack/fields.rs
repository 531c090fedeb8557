//! Data over the domain on a mesh: integrals against hat functions, means on triangles, values at vertices.

use super::error::{StackError, known};
use crate::fem::{LoadMoments, SeenLoad, moments_on};
use crate::mesh::{HalfEdge, HalfEdges, Mesh, VertexKind, View, ViewPlace};
use crate::problem::{Field, Function};

/// How data are integrated over a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum IntegrationRule {
    /// Functions by quadrature of degree 4, as the loads of the paper's pair; values at vertices exactly.
    #[default]
    Quadrature,
    /// From the values at the three corners: the mean is theirs, and the load vector is `f(a) |D_a|`. Published values of test
    /// problems rest on this rule.
    Vertices,
}

/// What a coefficient may be, and that in words.
pub(super) type Allowed = (fn(f64) -> bool, &'static str);

pub(super) const POSITIVE: Allowed = (|mu| mu > 0.0, "positive and finite");
pub(super) const NOT_NEGATIVE: Allowed = (|c| c >= 0.0, "a finite number >= 0");

/// A field that knows no regions, and the triangles on which it is the datum.
pub(super) struct Piece<'f> {
    pub(super) field: &'f Field,
    pub(super) triangles: Vec<usize>,
}

/// Which field is the datum on which triangles.
pub(super) fn pieces<'f>(mesh: &Mesh, field: &'f Field, datum: &str) -> Result<Vec<Piece<'f>>, StackError> {
    let mut pieces = Vec::new();
    divide(mesh, field, (0..mesh.triangles().len()).collect(), datum, &mut pieces)?;
    Ok(pieces)
}

/// Divides the triangles on which `field` is the datum among its parts.
fn divide<'f>(
    mesh: &Mesh,
    field: &'f Field,
    triangles: Vec<usize>,
    datum: &str,
    pieces: &mut Vec<Piece<'f>>,
) -> Result<(), StackError> {
    let Field::ByRegion { parts, elsewhere } = field else {
        pieces.push(Piece { field, triangles });
        return Ok(());
    };
    const NOBODY: usize = usize::MAX;
    let groups = mesh.groups();
    let mut part_of = vec![NOBODY; mesh.triangles().len()];
    for (k, (name, _)) in parts.iter().enumerate() {
        let region = groups.region(name).ok_or_else(|| StackError::UnknownRegion {
            datum: datum.into(),
            name: name.clone(),
            known: known(groups.regions().iter(), "region"),
        })?;
        for t in region {
            if part_of[t] != NOBODY {
                let names = [parts[part_of[t]].0.clone(), name.clone()];
                return Err(StackError::Overlap { datum: datum.into(), names, point: barycentre(mesh, t) });
            }
            part_of[t] = k;
        }
    }
    let of_part = |k: usize| triangles.iter().copied().filter(|&t| part_of[t] == k).collect::<Vec<_>>();
    for (k, (_, field)) in parts.iter().enumerate() {
        divide(mesh, field, of_part(k), datum, pieces)?;
    }
    match (elsewhere, of_part(NOBODY)) {
        (_, rest) if rest.is_empty() => Ok(()),
        (Some(field), rest) => divide(mesh, field, rest, datum, pieces),
        (None, rest) => Err(StackError::NotCovered { datum: datum.into(), point: barycentre(mesh, rest[0]) }),
    }
}

/// The edges between triangles on which a field is given by different parts of it, the lower end first.
pub(super) fn borders(mesh: &Mesh, field: &Field, datum: &str) -> Result<Vec<[usize; 2]>, StackError> {
    if field.names().next().is_none() {
        return Ok(Vec::new());
    }
    let mut piece_of = vec![usize::MAX; mesh.triangles().len()];
    for (k, piece) in pieces(mesh, field, datum)?.iter().enumerate() {
        piece.triangles.iter().for_each(|&t| piece_of[t] = k);
    }
    let half_edges = HalfEdges::new(mesh.points().len(), mesh.triangles());
    let is_border = |sides: &[HalfEdge]| {
        sides.windows(2).any(|pair| piece_of[pair[0].triangle()] != piece_of[pair[1].triangle()])
    };
    let edges = half_edges.edges().filter(|(_, _, sides)| is_border(sides));
    Ok(edges.map(|(lower, upper, _)| [lower, upper]).collect())
}

fn barycentre(mesh: &Mesh, t: usize) -> [f64; 2] {
    let [a, b, c] = mesh.corners(t);
    [0, 1].map(|axis| (a[axis] + b[axis] + c[axis]) / 3.0)
}

fn check_length(datum: &str, found: usize, expected: usize, of: &'static str) -> Result<(), StackError> {
    if found == expected {
        return Ok(());
    }
    Err(StackError::Length { datum: datum.into(), found, expected, of })
}

/// The data view of this name.
fn view<'m>(mesh: &'m Mesh, name: &str, datum: &str) -> Result<&'m View, StackError> {
    let (datum, views) = (datum.to_owned(), mesh.views());
    match views.get(name) {
        Some(Ok(view)) => Ok(view),
        Some(Err(why)) => Err(StackError::UselessView { datum, name: name.into(), why: why.into() }),
        None => Err(StackError::UnknownView {
            datum,
            name: name.into(),
            known: known(views.names(), "data view"),
        }),
    }
}

/// The values of a view at vertices, or on triangles.
fn values_of(
    mesh: &Mesh,
    view: &View,
    places: &[usize],
    [name, datum]: [&str; 2],
) -> Result<Vec<f64>, StackError> {
    let missing = |k: usize| {
        let (place, vertex, point) = match view.place() {
            ViewPlace::Vertices => (format!("vertex {k}"), Some(k), mesh.points()[k]),
            ViewPlace::Triangles => (format!("triangle {k}"), None, barycentre(mesh, k)),
        };
        StackError::NoValue { datum: datum.into(), name: name.into(), place, vertex, point }
    };
    places.iter().map(|&k| view.value(k).ok_or_else(|| missing(k))).collect()
}

/// A field on the triangles of a piece.
pub(super) enum OnTriangles {
    /// One value each.
    Values(Vec<f64>),
    /// What the quadrature sees.
    Seen(SeenLoad),
}

impl Piece<'_> {
    pub(super) fn on_triangles(
        &self,
        mesh: &Mesh,
        datum: &str,
        rule: IntegrationRule,
    ) -> Result<OnTriangles, StackError> {
        let Self { field, triangles } = self;
        let third = |t: usize| mesh.triangle_area(t) / 3.0;
        if let Field::View(name) = field {
            let view = view(mesh, name, datum)?;
            if view.place() == ViewPlace::Triangles {
                return Ok(OnTriangles::Values(values_of(mesh, view, triangles, [name, datum])?));
            }
        }
        Ok(match (*field, rule) {
            (Field::Everywhere(Function::Constant(value)), _) => {
                OnTriangles::Values(vec![*value; triangles.len()])
            }
            (Field::PerTriangle(values), _) => {
                check_length(datum, values.len(), mesh.triangles().len(), "triangles")?;
                OnTriangles::Values(triangles.iter().map(|&t| values[t]).collect())
            }
            (Field::Everywhere(function), IntegrationRule::Quadrature) => {
                let seen = moments_on(mesh, triangles, function);
                OnTriangles::Seen(
                    seen.map_err(|source| StackError::Evaluation { datum: datum.into(), source })?,
                )
            }
            (Field::PerVertex(_) | Field::View(_), IntegrationRule::Quadrature) => {
                let corners = self.at_corners(mesh, datum)?;
                let integrals = |(&t, at): (&usize, [f64; 3])| {
                    let sum = at.iter().sum::<f64>();
                    at.map(|value| third(t) * 0.25 * (value + sum))
                };
                OnTriangles::Seen(SeenLoad::affine(triangles.iter().zip(corners).map(integrals)))
            }
            (_, IntegrationRule::Vertices) => {
                let corners = self.at_corners(mesh, datum)?;
                let integrals = |(&t, at): (&usize, [f64; 3])| at.map(|value| third(t) * value);
                OnTriangles::Seen(SeenLoad::affine(triangles.iter().zip(corners).map(integrals)))
            }
            (Field::ByRegion { .. }, _) => unreachable!("pieces know no regions"),
        })
    }

    /// The values at the corners of the triangles.
    pub(super) fn at_corners(&self, mesh: &Mesh, datum: &str) -> Result<Vec<[f64; 3]>, StackError> {
        let mut around: Vec<usize> = self.triangles.iter().flat_map(|&t| mesh.triangles()[t]).collect();
        around.sort_unstable();
        around.dedup();
        let mut at_vertex = vec![0.0; mesh.points().len()];
        let values = at_vertices(mesh, self.field, &around, datum, f64::max)?;
        around.iter().zip(values).for_each(|(&a, value)| at_vertex[a] = value);
        Ok(self.triangles.iter().map(|&t| mesh.triangles()[t].map(|a| at_vertex[a])).collect())
    }
}

/// The moments of a load.
pub(super) fn moments(
    mesh: &Mesh,
    field: &Field,
    datum: &str,
    rule: IntegrationRule,
) -> Result<LoadMoments, StackError> {
    if let Some(value) = field.constant() {
        return Ok(LoadMoments::Constant(value));
    }
    let mut parts = Vec::new();
    for piece in pieces(mesh, field, datum)? {
        let seen = match piece.on_triangles(mesh, datum, rule)? {
            OnTriangles::Seen(seen) => seen,
            // As the constant load of the paper's pair, to the last bit.
            OnTriangles::Values(values) => SeenLoad::affine(
                piece
                    .triangles
                    .iter()
                    .zip(values)
                    .map(|(&t, value)| [value * mesh.triangle_area(t) / 3.0; 3]),
            ),
        };
        parts.push((piece.triangles, seen));
    }
    Ok(LoadMoments::of_parts(mesh, parts))
}

/// The means on the triangles, of what `is_allowed`; a number is itself. Shape: `triangles`.
pub(super) fn means(
    mesh: &Mesh,
    field: &Field,
    datum: &str,
    rule: IntegrationRule,
    (is_allowed, must): Allowed,
) -> Result<Vec<f64>, StackError> {
    let mut means = vec![0.0; mesh.triangles().len()];
    for piece in pieces(mesh, field, datum)? {
        match piece.on_triangles(mesh, datum, rule)? {
            OnTriangles::Values(values) => {
                piece.triangles.iter().zip(values).for_each(|(&t, value)| means[t] = value);
            }
            OnTriangles::Seen(seen) => {
                for (&t, moments) in piece.triangles.iter().zip(seen.moments) {
                    means[t] = moments.integrals.iter().sum::<f64>() / mesh.triangle_area(t);
                }
            }
        }
        if let Some(&t) = piece.triangles.iter().find(|&&t| !(is_allowed(means[t]) && means[t].is_finite())) {
            return Err(StackError::Coefficient {
                datum: datum.into(),
                value: means[t],
                point: barycentre(mesh, t),
                must,
            });
        }
    }
    Ok(means)
}

/// The values at the given vertices; where regions meet that have values of their own, the `stricter` of them.
pub(super) fn at_vertices(
    mesh: &Mesh,
    field: &Field,
    vertices: &[usize],
    datum: &str,
    stricter: fn(f64, f64) -> f64,
) -> Result<Vec<f64>, StackError> {
    match field {
        Field::Everywhere(function) => {
            let [x, y] =
                [0, 1].map(|axis| vertices.iter().map(|&a| mesh.points()[a][axis]).collect::<Vec<f64>>());
            let mut values = vec![0.0; vertices.len()];
            function
                .eval_many(&x, &y, &mut values)
                .map_err(|source| StackError::Evaluation { datum: datum.into(), source })?;
            Ok(values)
        }
        Field::PerVertex(values) => {
            check_length(datum, values.len(), mesh.points().len(), "vertices")?;
            Ok(vertices.iter().map(|&a| values[a]).collect())
        }
        Field::PerTriangle(_) => Err(StackError::NotAtVertices { datum: datum.into() }),
        Field::View(name) => {
            let view = view(mesh, name, datum)?;
            if view.place() == ViewPlace::Triangles {
                return Err(StackError::NotAtVertices { datum: datum.into() });
            }
            values_of(mesh, view, vertices, [name, datum])
        }
        Field::ByRegion { .. } => {
            let mut strictest = vec![None::<f64>; mesh.points().len()];
            let mut is_wanted = vec![false; mesh.points().len()];
            vertices.iter().for_each(|&a| is_wanted[a] = true);
            for Piece { field, triangles } in pieces(mesh, field, datum)? {
                let mut around: Vec<usize> = triangles
                    .iter()
                    .flat_map(|&t| mesh.triangles()[t])
                    .filter(|&a| is_wanted[a] && mesh.kind()[a] != VertexKind::Unused)
                    .collect();
                around.sort_unstable();
                around.dedup();
                for (&a, value) in around.iter().zip(at_vertices(mesh, field, &around, datum, stricter)?) {
                    strictest[a] = Some(strictest[a].map_or(value, |other| stricter(other, value)));
                }
            }
            Ok(vertices.iter().map(|&a| strictest[a].unwrap_or(0.0)).collect())
        }
    }
}
