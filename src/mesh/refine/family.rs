//! A coarse mesh and the finer ones that follow its domain.

use std::sync::Arc;

use super::circle::Circle;
use crate::mesh::{Mesh, MeshError, Refinement};
use crate::problem::Domain;

/// A mesh that can be refined again and again, the finer ones following a curved boundary or a grading.
#[derive(Debug, Clone)]
pub struct MeshFamily {
    mesh: Arc<Mesh>,
    shape: Shape,
}

/// What refinements follow.
#[derive(Debug, Clone)]
enum Shape {
    /// The polygon that the coarse mesh covers.
    Polygon,
    /// A circle.
    Disk(Circle),
    /// A grading towards a point, laid over a mesh that is refined uniformly: see [`Mesh::graded`].
    Graded { uniform: Box<Mesh>, point: [f64; 2], exponent: f64 },
}

impl MeshFamily {
    /// Refinements that keep the polygon that `mesh` covers.
    pub fn polygonal(mesh: Mesh) -> Self {
        Self { mesh: Arc::new(mesh), shape: Shape::Polygon }
    }

    /// Refinements of a mesh of `domain`: those of a disk follow its circle.
    pub fn of_domain(mesh: Mesh, domain: &Domain) -> Self {
        let shape = Circle::of_domain(domain).map_or(Shape::Polygon, Shape::Disk);
        Self { mesh: Arc::new(mesh), shape }
    }

    /// Refinements graded towards `point`, as the coarse mesh: see [`Mesh::graded`].
    ///
    /// # Errors
    /// As [`Mesh::graded`].
    pub fn graded(uniform: Mesh, point: [f64; 2], exponent: f64) -> Result<Self, MeshError> {
        let mesh = Arc::new(uniform.graded(point, exponent)?);
        Ok(Self { mesh, shape: Shape::Graded { uniform: Box::new(uniform), point, exponent } })
    }

    /// The current mesh.
    pub fn mesh(&self) -> &Arc<Mesh> {
        &self.mesh
    }

    /// Divides every triangle into four; returns the parents of the new vertices, see [`Refinement`].
    ///
    /// # Errors
    /// [`MeshError`] when triangles become too small to be represented.
    pub fn refine(&mut self) -> Result<Vec<[usize; 2]>, MeshError> {
        let (parents, mesh) = match &mut self.shape {
            Shape::Polygon => {
                let Refinement { mesh, parents } = self.mesh.refine()?;
                (parents, mesh)
            }
            Shape::Disk(circle) => {
                let Refinement { mut mesh, parents } = self.mesh.refine()?;
                circle.attract(&mut mesh.points, &mesh.kind);
                self.mesh.check_parts(&mesh)?;
                (parents, mesh.checked()?)
            }
            Shape::Graded { uniform, point, exponent } => {
                let Refinement { mesh, parents } = uniform.refine()?;
                let graded = mesh.graded(*point, *exponent)?;
                **uniform = mesh;
                (parents, graded)
            }
        };
        self.mesh = Arc::new(mesh);
        Ok(parents)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::mesh::{Pattern, SubTriangulation, disk, l_shape, rectangle};

    #[test]
    fn a_disk_stays_round_and_a_polygon_does_not() {
        let domain = Domain::Disk { centre: [1.0, 2.0], radius: 0.5 };
        let coarse = disk([1.0, 2.0], 0.5, 2).unwrap();
        let mut round = MeshFamily::of_domain(coarse.clone(), &domain);
        let mut straight = MeshFamily::polygonal(coarse.clone());
        let mut defects = vec![0.25 * PI - coarse.area()];
        for _ in 0..3 {
            round.refine().unwrap();
            straight.refine().unwrap();
            defects.push(0.25 * PI - round.mesh().area());
        }
        for pair in defects.windows(2) {
            assert!((pair[0] / pair[1] - 4.0).abs() < 0.2, "second order: {defects:?}");
        }
        assert!((straight.mesh().area() - coarse.area()).abs() < 1e-12);
        assert!(round.mesh().quality().min_angle > 30.0);
    }

    /// Whether a mesh would be accepted from a file.
    fn is_valid(mesh: &Mesh) -> bool {
        Mesh::new(mesh.points().to_vec(), mesh.triangles().to_vec()).is_ok()
    }

    /// Small domains far from the origin: edges of 1e-4 at coordinates of 1e6 have 20 bits, of which a mesh needs 12.
    #[test]
    fn refinement_ends_where_coordinates_have_no_digits_left_and_meshes_are_valid_until_then() {
        let (far, side) = ([1e6; 2], 1e-4);
        let square = || rectangle(far, far.map(|x| x + side), [2; 2], Pattern::Right).unwrap();
        let circle = Domain::Disk { centre: far, radius: side };
        let families = [
            MeshFamily::polygonal(square()),
            MeshFamily::of_domain(disk(far, side, 2).unwrap(), &circle),
            MeshFamily::graded(square(), far.map(|x| x + 0.5 * side), 1.5).unwrap(),
        ];
        for mut family in families {
            let mut refinements = 0;
            let error = loop {
                assert!(is_valid(family.mesh()), "{family:?}");
                assert!(SubTriangulation::new(family.mesh()).is_ok(), "{family:?}");
                match family.refine() {
                    Ok(_) => refinements += 1,
                    Err(error) => break error,
                }
            };
            assert!((4..8).contains(&refinements), "{refinements} refinements: {family:?}");
            assert!(matches!(error, MeshError::TooSmall { .. }), "{error}");
        }
        // Without the limit, the next mesh but three would be none.
        let edge = 2f64.powi(-15) * side;
        assert!(rectangle(far, far.map(|x| x + edge), [1; 2], Pattern::Right).is_err());
    }

    #[test]
    fn refinements_of_a_graded_mesh_are_graded() {
        let corner = l_shape(1.0, 4, Pattern::Right).unwrap();
        let mut family = MeshFamily::graded(corner.clone(), [0.0, 0.0], 2.0).unwrap();
        let coarse = family.mesh().quality().h_min;
        let parents = family.refine().unwrap();
        assert!((coarse / family.mesh().quality().h_min - 4.0).abs() < 1e-9, "h_min ~ h^2");
        assert_eq!(family.mesh().points().len(), corner.points().len() + parents.len());
    }
}
