//! Meshes.

use std::cell::RefCell;
use std::fmt::Display;
use std::io;
use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use membrane_contact::mesh::{
    self, GmshMesh, MeshFamily, MeshSize, Pattern, VertexKind, ViewPlace, generate,
};
use membrane_contact::problem::Domain;
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{counted, rows, vector, view, view_rows};
use crate::errors::{data_error, mesh_error, negative_vertex, value_error};
use crate::worker::wait_for;

/// A triangulation. It never changes: what would change it returns another one.
///
/// Parameters
/// ----------
/// points : array_like, shape (vertices, 2)
///     Coordinates.
/// triangles : array_like of int, shape (triangles, 3)
///     The vertices of each triangle, counted from 0, in either orientation.
///
/// Raises
/// ------
/// MeshError
///     They are no conforming triangulation; ``triangle`` and ``vertices`` say where.
///
/// Notes
/// -----
/// Arrays are read-only views. Vertices keep their numbers in every refinement, where those of midpoints follow.
#[pyclass(frozen, module = "membrane_contact")]
pub(crate) struct Mesh {
    family: MeshFamily,
    domain: Option<Domain>,
    kind: OnceLock<Vec<u8>>,
    notes: Vec<String>,
}

impl Mesh {
    /// A mesh that stands for a domain, or for the polygon that it covers.
    pub(crate) fn over(mesh: mesh::Mesh, domain: Option<Domain>) -> Self {
        let family = match &domain {
            Some(domain) => MeshFamily::of_domain(mesh, domain),
            None => MeshFamily::polygonal(mesh),
        };
        Self { family, domain, kind: OnceLock::new(), notes: Vec::new() }
    }

    pub(crate) fn core(&self) -> &Arc<mesh::Mesh> {
        self.family.mesh()
    }

    pub(crate) fn domain(&self) -> Option<&Domain> {
        self.domain.as_ref()
    }

    fn generated(py: Python<'_>, domain: Domain, size: MeshSize) -> PyResult<Self> {
        let made = wait_for(py, move || generate(&domain, size).map(|mesh| Self::over(mesh, Some(domain))))?;
        made.map_err(value_error)
    }

    /// The same with its parts named anew.
    fn renamed<E: Display + Send + 'static>(
        &self,
        py: Python<'_>,
        rename: impl FnOnce(mesh::Mesh) -> Result<mesh::Mesh, E> + Send + 'static,
    ) -> PyResult<Self> {
        let mesh = mesh::Mesh::clone(self.core());
        let mesh = wait_for(py, move || rename(mesh))?.map_err(value_error)?;
        Ok(Self::over(mesh, self.domain.clone()))
    }
}

/// `cells`, or `size` with `min_angle`.
fn mesh_size(
    py: Python<'_>,
    cells: Option<Bound<'_, PyAny>>,
    size: Option<f64>,
    min_angle: f64,
    pattern: &str,
) -> PyResult<MeshSize> {
    let pattern = match pattern {
        "right" => Pattern::Right,
        "crossed" => Pattern::Crossed,
        other => {
            return Err(data_error(
                py,
                "pattern",
                format!("is {other:?}: it may be \"right\" or \"crossed\""),
            ));
        }
    };
    match (cells, size) {
        (Some(cells), None) => match cells.extract::<[usize; 2]>() {
            Ok(cells) => Ok(MeshSize::Grid { cells, pattern }),
            Err(_) => Ok(MeshSize::Cells { cells: cells.extract()?, pattern }),
        },
        (None, Some(size)) => Ok(MeshSize::EdgeLength { size, min_angle }),
        _ => Err(PyValueError::new_err("give cells or size, and not both")),
    }
}

#[pymethods]
impl Mesh {
    #[new]
    #[pyo3(signature = (points, triangles))]
    fn new(py: Python<'_>, points: &Bound<'_, PyAny>, triangles: &Bound<'_, PyAny>) -> PyResult<Self> {
        let points: Vec<[f64; 2]> = rows(points, "float64", "points")?;
        let triangles: Vec<[i64; 3]> = rows(triangles, "int64", "triangles")?;
        let negative = (0..).zip(&triangles).find_map(|(t, k)| Some((t, *k.iter().find(|a| **a < 0)?)));
        if let Some((t, a)) = negative {
            return Err(negative_vertex(py, t, a));
        }
        let triangles = triangles.into_iter().map(|corners| corners.map(|a| a as usize)).collect();
        let mesh = wait_for(py, || mesh::Mesh::new(points, triangles))?;
        let mesh = mesh.map_err(|error| mesh_error(py, &error))?;
        Ok(Self::over(mesh, None))
    }

    /// The mesh of another package.
    ///
    /// Parameters
    /// ----------
    /// mesh : skfem.MeshTri, meshio.Mesh, pyvista.DataSet, path, or tuple (points, triangles)
    ///     Subdomains and boundaries of skfem, cell sets and physical groups of meshio become regions and curves.
    ///
    /// Returns
    /// -------
    /// Mesh
    #[staticmethod]
    fn of(mesh: &Bound<'_, PyAny>) -> PyResult<Py<Self>> {
        let py = mesh.py();
        py.import("membrane_contact._interchange")?
            .getattr("mesh_of")?
            .call1((mesh,))?
            .extract()
            .map_err(PyErr::from)
    }

    /// A mesh from a Gmsh file (MSH 2.0 to 4.1); its physical groups are regions and curves. `notes` says what was done to it.
    ///
    /// Raises
    /// ------
    /// OSError, MeshError, ValueError
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let of_file = path.clone();
        let read =
            wait_for(py, move || GmshMesh::read(&of_file, u64::MAX))?.map_err(|error| match error {
                mesh::ReadError::Io(error) => {
                    io::Error::new(error.kind(), format!("{}: {error}", path.display())).into()
                }
                mesh::ReadError::Mesh { source, .. } => mesh_error(py, &source),
                error => value_error(format!("{}: {error}", path.display())),
            })?;
        let notes = read.notes.iter().map(ToString::to_string).collect();
        Ok(Self { notes, ..Self::over(read.mesh, None) })
    }

    /// A rectangle of ``nx`` by ``ny`` cells, with the curves ``left``, ``right``, ``bottom`` and ``top``.
    ///
    /// Parameters
    /// ----------
    /// nx, ny : int
    ///     Cells along x and y; ``ny`` as ``nx`` where it is left out. Even numbers make coarser meshes known, which multigrid likes.
    /// lower, upper : tuple of float
    ///     Corners.
    /// pattern : {"right", "crossed"}
    ///     Two triangles a cell, or four.
    #[staticmethod]
    #[pyo3(signature = (nx, ny=None, *, lower=[0.0, 0.0], upper=[1.0, 1.0], pattern="right"))]
    fn rectangle(
        py: Python<'_>,
        nx: usize,
        ny: Option<usize>,
        lower: [f64; 2],
        upper: [f64; 2],
        pattern: &str,
    ) -> PyResult<Self> {
        let cells = Some([nx, ny.unwrap_or(nx)].into_pyobject(py)?.into_any());
        Self::generated(py, Domain::Rectangle { lower, upper }, mesh_size(py, cells, None, 0.0, pattern)?)
    }

    /// A disk, whose rim is the curve ``rim``; its refinements stay round.
    ///
    /// Parameters
    /// ----------
    /// cells : int
    ///     Rings, in a structured mesh; else give ``size``.
    /// size : float
    ///     Length of edges in an unstructured mesh.
    /// centre : tuple of float
    /// radius : float
    /// min_angle : float
    ///     Least angle of an unstructured mesh, degrees, at most 30.
    #[staticmethod]
    #[pyo3(signature = (cells=None, *, size=None, centre=[0.0, 0.0], radius=1.0, min_angle=25.0))]
    fn disk(
        py: Python<'_>,
        cells: Option<Bound<'_, PyAny>>,
        size: Option<f64>,
        centre: [f64; 2],
        radius: f64,
        min_angle: f64,
    ) -> PyResult<Self> {
        Self::generated(py, Domain::Disk { centre, radius }, mesh_size(py, cells, size, min_angle, "right")?)
    }

    /// ``(-a, a)^2`` without its lower right quarter, where ``a`` is ``half_width``, with the re-entrant ``corner`` among its curves.
    ///
    /// Parameters
    /// ----------
    /// cells : int
    ///     Cells along ``a``; else give ``size``.
    /// size : float
    ///     Length of edges in an unstructured mesh.
    /// half_width, min_angle, pattern
    ///     As for `rectangle` and `disk`.
    #[staticmethod]
    #[pyo3(signature = (cells=None, *, size=None, half_width=1.0, min_angle=25.0, pattern="right"))]
    fn l_shape(
        py: Python<'_>,
        cells: Option<Bound<'_, PyAny>>,
        size: Option<f64>,
        half_width: f64,
        min_angle: f64,
        pattern: &str,
    ) -> PyResult<Self> {
        Self::generated(py, Domain::LShape { half_width }, mesh_size(py, cells, size, min_angle, pattern)?)
    }

    /// A polygon with holes, unstructured, with the curves ``outer``, ``side 1`` ... and ``hole 1`` ...
    ///
    /// Parameters
    /// ----------
    /// vertices : array_like, shape (corners, 2)
    /// holes : list of array_like, shape (corners, 2)
    /// size : float
    ///     Length of edges.
    /// min_angle : float
    ///     Degrees, at most 30.
    #[staticmethod]
    #[pyo3(signature = (vertices, holes=Vec::new(), *, size, min_angle=25.0))]
    fn polygon(
        py: Python<'_>,
        vertices: &Bound<'_, PyAny>,
        holes: Vec<Bound<'_, PyAny>>,
        size: f64,
        min_angle: f64,
    ) -> PyResult<Self> {
        let vertices = rows(vertices, "float64", "vertices")?;
        let holes = holes.iter().map(|hole| rows(hole, "float64", "holes")).collect::<PyResult<_>>()?;
        Self::generated(py, Domain::Polygon { vertices, holes }, MeshSize::EdgeLength { size, min_angle })
    }

    /// The mesh with each triangle divided into four, ``times`` times. Names and data views are inherited.
    #[pyo3(signature = (times=1))]
    fn refined(&self, py: Python<'_>, times: usize) -> PyResult<Self> {
        let mut family = self.family.clone();
        for _ in 0..times {
            let refined = wait_for(py, move || family.refine().map(|_| family))?;
            family = refined.map_err(|error| mesh_error(py, &error))?;
        }
        Ok(Self { family, domain: self.domain.clone(), kind: OnceLock::new(), notes: Vec::new() })
    }

    /// The mesh with some triangles called ``name``: a region.
    ///
    /// Parameters
    /// ----------
    /// name : str
    /// triangles : array_like of int, mask, or callable
    ///     Numbers of triangles; a mask of all; or ``f(x, y)`` of the arrays of all barycentres that returns one of these.
    fn with_region(&self, py: Python<'_>, name: String, triangles: &Bound<'_, PyAny>) -> PyResult<Self> {
        let mesh = self.core();
        let barycentre = |corners: &[usize; 3], axis: usize| {
            corners.iter().map(|&a| mesh.points()[a][axis]).sum::<f64>() / 3.0
        };
        let coordinate = |axis: usize| mesh.triangles().iter().map(|k| barycentre(k, axis)).collect();
        let triangles = chosen(triangles, "triangles", [coordinate(0), coordinate(1)])?;
        self.renamed(py, move |mesh| mesh.with_region_of(name, triangles))
    }

    /// The mesh with some edges called ``name``: a curve.
    ///
    /// Parameters
    /// ----------
    /// name : str
    /// edges : array_like of int, shape (edges, 2), or callable
    ///     The ends of each, on the boundary or inside; or ``f(x, y)``, which says whether points lie on the curve: edges of the boundary are
    ///     taken whose ends and midpoints do. Allow for rounding.
    fn with_curve(&self, py: Python<'_>, name: String, edges: &Bound<'_, PyAny>) -> PyResult<Self> {
        if !edges.is_callable() {
            let edges = counted::<2>(edges, "edges")?;
            return self.renamed(py, move |mesh| mesh.with_curve_of(name, edges));
        }
        // Asked for one point at a time: boundaries have few.
        let raised = RefCell::new(None);
        let is_on = |[x, y]: [f64; 2]| {
            if raised.borrow().is_some() {
                return Ok(false);
            }
            let at = |value: f64| PyArray1::from_slice(py, &[value]);
            py.import("numpy")?.call_method1("all", (edges.call1((at(x), at(y)))?,))?.is_truthy()
        };
        let on = |point: [f64; 2]| {
            is_on(point).unwrap_or_else(|error| {
                raised.borrow_mut().get_or_insert(error);
                false
            })
        };
        let named = mesh::Mesh::clone(self.core()).with_curve(name, on);
        match raised.into_inner() {
            Some(error) => Err(error),
            None => self.renamed(py, move |_| named),
        }
    }

    /// The mesh with values that data can name, ``{"view": name}``, and that its refinements inherit.
    ///
    /// Parameters
    /// ----------
    /// name : str
    /// values : array_like
    ///     One for each vertex, affine between them, or for each triangle.
    /// on : {"vertices", "triangles"}
    #[pyo3(signature = (name, values, *, on="vertices"))]
    fn with_view(&self, py: Python<'_>, name: String, values: &Bound<'_, PyAny>, on: &str) -> PyResult<Self> {
        let place = match on {
            "vertices" => ViewPlace::Vertices,
            "triangles" => ViewPlace::Triangles,
            other => {
                let problem = format!("is {other:?}: it may be \"vertices\" or \"triangles\"");
                return Err(data_error(py, "on", problem));
            }
        };
        let values = vector(values, "values")?;
        self.renamed(py, move |mesh| mesh.with_view(name, place, values))
    }

    /// Coordinates. Shape: (vertices, 2).
    #[getter]
    fn points<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray2<f64>> {
        view_rows(slf, |mesh| mesh.core().points())
    }

    /// The vertices of each triangle, counterclockwise. Shape: (triangles, 3).
    #[getter]
    fn triangles<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        // Signed, so that differences are what they seem.
        view_rows(slf, |mesh| mesh.core().triangles()).call_method1("view", ("int64",))
    }

    /// What each vertex is: 0 inside, 1 on the boundary, 2 of no triangle.
    #[getter]
    fn kind<'py>(slf: &Bound<'py, Self>) -> Bound<'py, PyArray1<u8>> {
        let code = |kind: &VertexKind| match kind {
            VertexKind::Interior => 0,
            VertexKind::Boundary => 1,
            VertexKind::Unused => 2,
        };
        view(slf, |mesh| mesh.kind.get_or_init(|| mesh.core().kind().iter().map(code).collect()))
    }

    /// The triangles of each region, by name.
    #[getter]
    fn regions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let groups = self.core().groups();
        let by_name = PyDict::new(py);
        for name in groups.regions().iter() {
            let triangles: Vec<i64> = groups.region(name).into_iter().flatten().map(|t| t as i64).collect();
            by_name.set_item(name, PyArray1::from_vec(py, triangles))?;
        }
        Ok(by_name)
    }

    /// The edges of each curve, by name. Shape of each: (edges, 2).
    #[getter]
    fn curves<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let groups = self.core().groups();
        let by_name = PyDict::new(py);
        for name in groups.curves().iter() {
            let edges = groups.curve(name).into_iter().flatten();
            let edges: Vec<Vec<i64>> = edges.map(|ends| ends.map(|a| a as i64).to_vec()).collect();
            let edges = PyArray2::from_vec2(py, &edges).map_err(value_error)?;
            by_name.set_item(name, edges)?;
        }
        Ok(by_name)
    }

    /// What was done to what was read to make it a mesh of plane triangles.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// How many refinements are known to have made the mesh.
    #[getter]
    fn refinements(&self) -> usize {
        self.core().ancestry().len()
    }

    /// The longest edge.
    #[getter]
    fn h(&self, py: Python<'_>) -> PyResult<f64> {
        let mesh = Arc::clone(self.core());
        wait_for(py, move || mesh.quality().h_max)
    }

    /// It never changes.
    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    fn __repr__(&self) -> String {
        let [vertices, triangles] = [self.core().points().len(), self.core().triangles().len()];
        format!("<Mesh: {vertices} vertices, {triangles} triangles>")
    }
}

/// The numbers that are given, or those where a mask is true, or a callable `f(x, y)` of the arrays of all points.
fn chosen(given: &Bound<'_, PyAny>, key: &str, [x, y]: [Vec<f64>; 2]) -> PyResult<Vec<usize>> {
    let py = given.py();
    let all = x.len();
    let given = if given.is_callable() {
        given.call1((PyArray1::from_vec(py, x), PyArray1::from_vec(py, y)))?
    } else {
        given.clone()
    };
    let numpy = py.import("numpy")?;
    let array = numpy.call_method1("asarray", (given,))?;
    let is_mask: bool = array.getattr("dtype")?.getattr("kind")?.eq("b")?;
    let numbers = if is_mask {
        let length: usize = array.getattr("size")?.extract()?;
        if length != all {
            return Err(data_error(py, key, format!("is a mask of {length} values, and there are {all}")));
        }
        numpy.call_method1("flatnonzero", (array,))?
    } else {
        array
    };
    let numbers = counted(&numbers.call_method1("reshape", ((-1, 1),))?, key)?;
    Ok(numbers.into_iter().map(|[number]| number).collect())
}
