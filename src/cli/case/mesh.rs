//! `[domain]` and `[mesh]`: where the mesh comes from.

use std::path::{Path, PathBuf};

use toml::Value;

use super::section::Section;
use crate::cli::failure::Failure;
use crate::mesh::{MeshSize, Pattern};
use crate::problem::{Domain, Exact};
use crate::text::excerpt;

/// Cells of a structured mesh when the case file does not say.
const DEFAULT_CELLS: usize = 64;

/// Least angle of an unstructured mesh when the case file does not say, degrees.
const DEFAULT_MIN_ANGLE: f64 = 25.0;

/// Where a mesh comes from.
#[derive(Debug, Clone, PartialEq)]
pub enum MeshSource {
    /// A Gmsh file.
    File(PathBuf),
    /// A generator.
    Generator {
        /// The domain.
        domain: Domain,
        /// How fine.
        size: MeshSize,
        /// A point towards which the mesh is graded, and the exponent: see [`Mesh::graded`](crate::mesh::Mesh::graded).
        grading: Option<([f64; 2], f64)>,
    },
}

/// `[domain]` and `[mesh]`.
pub(super) fn mesh(
    top: &mut Section,
    exact: Option<&Exact>,
    path: &Path,
) -> Result<(MeshSource, usize), Failure> {
    let mut place = top.section("domain")?;
    let mut fineness = top.section("mesh")?;
    let refine = fineness.count("refine", 0)?.unwrap_or(0);
    let file = place.text("mesh")?;
    let shape = place.text("shape")?;
    let source = match (file, shape, exact) {
        (Some(_), Some(_), _) => {
            return Err(place.error("shape", "contradicts `domain.mesh`: remove one of the two"));
        }
        (_, Some(_), Some(_)) => return Err(place.error("shape", "is given by the case already: remove it")),
        (Some(_), None, _) if !fineness.is_empty() => {
            return Err(top.error(
                "mesh",
                "describes a mesh to generate, but `domain.mesh` is a file: keep `refine` only",
            ));
        }
        (Some(file), None, _) => MeshSource::File(path.parent().unwrap_or(Path::new("")).join(file)),
        (None, Some(shape), None) => generator(&mut fineness, domain(&mut place, &shape)?)?,
        (None, None, Some(exact)) => generator(&mut fineness, exact.domain())?,
        (None, None, None) => {
            let remedy = "add a table [domain] with `shape = \"square\"` or `mesh = \"file.msh\"`";
            return Err(place
                .misspelt(&["shape", "mesh"])
                .or_else(|| top.misspelt(&["domain"]))
                .unwrap_or_else(|| top.table_error(format!("there is no domain: {remedy}"))));
        }
    };
    place.finish()?;
    fineness.finish()?;
    Ok((source, refine))
}

fn generator(section: &mut Section, domain: Domain) -> Result<MeshSource, Failure> {
    let grading = section.number("grading")?.map(|exponent| match domain {
        Domain::Rectangle { lower, upper } => {
            Ok(([0, 1].map(|axis| 0.5 * (lower[axis] + upper[axis])), exponent))
        }
        Domain::LShape { .. } => Ok(([0.0, 0.0], exponent)),
        _ => Err(section
            .error("grading", "is for a square (to its centre) or an L-shape (to its corner): remove it")),
    });
    let grading = grading.transpose()?;
    let size = mesh_size(section, &domain)?;
    Ok(MeshSource::Generator { domain, size, grading })
}

fn domain(section: &mut Section, shape: &str) -> Result<Domain, Failure> {
    const SHAPES: [&str; 5] = ["square", "rectangle", "l-shape", "disk", "polygon"];
    Ok(match shape {
        "square" => {
            let [x, y] = section.point("lower")?.unwrap_or([0.0, 0.0]);
            let side = section.number("side")?.unwrap_or(1.0);
            Domain::Rectangle { lower: [x, y], upper: [x + side, y + side] }
        }
        "rectangle" => {
            let lower = section.point("lower")?.unwrap_or([0.0, 0.0]);
            let upper = section.point("upper")?;
            let missing = || section.missing("upper", "add `upper = [x, y]`, the upper right corner");
            Domain::Rectangle { lower, upper: upper.ok_or_else(missing)? }
        }
        "l-shape" => Domain::LShape { half_width: section.number("half_width")?.unwrap_or(1.0) },
        "disk" => {
            let centre = section.point("centre")?.unwrap_or([0.0, 0.0]);
            Domain::Disk { centre, radius: section.number("radius")?.unwrap_or(1.0) }
        }
        "polygon" => {
            let vertices = section.points("vertices")?;
            let holes = section.point_lists("holes")?.unwrap_or_default();
            let missing = || section.missing("vertices", "add `vertices = [[x, y], ...]`");
            Domain::Polygon { vertices: vertices.ok_or_else(missing)?, holes }
        }
        _ => {
            return Err(section.error(
                "shape",
                format!("= \"{}\" is unknown: choose one of {}", excerpt(shape), SHAPES.join(", ")),
            ));
        }
    })
}

/// Cells of a structured mesh.
enum Cells {
    /// Along the shorter side.
    Across(usize),
    /// Along `x` and `y`.
    Along([usize; 2]),
}

/// `cells = 64` or `cells = [64, 32]`.
fn cells(section: &mut Section) -> Result<Option<Cells>, Failure> {
    let Some(value) = section.take("cells") else { return Ok(None) };
    let count = |value: &Value| value.as_integer().and_then(|n| usize::try_from(n).ok()).filter(|&n| n > 0);
    let cells = match value.as_array().map(Vec::as_slice) {
        Some([x, y]) => count(x).zip(count(y)).map(|(x, y)| Cells::Along([x, y])),
        Some(_) => None,
        None => count(&value).map(Cells::Across),
    };
    let must = "must be a whole number, at least 1, or two of them for a rectangle: [along x, along y]";
    cells.map(Some).ok_or_else(|| section.error("cells", must))
}

fn mesh_size(section: &mut Section, domain: &Domain) -> Result<MeshSize, Failure> {
    let cells = cells(section)?;
    let size = section.number("size")?;
    let pattern = section.text("pattern")?;
    let min_angle = section.number("min_angle")?;
    match (cells, size) {
        (Some(_), Some(_)) => Err(section.error("size", "contradicts `mesh.cells`: remove one of the two")),
        (None, Some(size)) => {
            if pattern.is_some() {
                return Err(
                    section.error("pattern", "belongs to a structured mesh: give `cells` in place of `size`")
                );
            }
            Ok(MeshSize::EdgeLength { size, min_angle: min_angle.unwrap_or(DEFAULT_MIN_ANGLE) })
        }
        (None, None) if matches!(domain, Domain::Polygon { .. }) => {
            Err(section.missing("size", "add `size = ...`, the target edge length"))
        }
        (cells, None) => {
            if min_angle.is_some() {
                return Err(section
                    .error("min_angle", "belongs to an unstructured mesh: give `size` in place of `cells`"));
            }
            let pattern = match pattern.as_deref() {
                None | Some("right") => Pattern::Right,
                Some("crossed") => Pattern::Crossed,
                Some(other) => {
                    return Err(section.error(
                        "pattern",
                        format!("= \"{}\" is unknown: choose right or crossed", excerpt(other)),
                    ));
                }
            };
            Ok(match cells.unwrap_or(Cells::Across(DEFAULT_CELLS)) {
                Cells::Across(cells) => MeshSize::Cells { cells, pattern },
                Cells::Along(cells) => MeshSize::Grid { cells, pattern },
            })
        }
    }
}
