//! The figures of a convergence study and their rates.

use super::exponent;
use crate::text::grouped;

/// One level: a mesh and the errors of the solution on it. Written as a row of `summary.csv`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub struct LevelErrors {
    /// The number of the level, from 0.
    pub level: usize,
    /// Vertices of the mesh.
    pub vertices: usize,
    /// Triangles of the mesh.
    pub triangles: usize,
    /// The longest edge.
    pub h: f64,
    /// The shortest edge.
    pub h_min: f64,
    /// `sqrt(sum_i |u_i - u_ih|_{H1}^2)`.
    pub h1: f64,
    /// `sqrt(sum_i ||u_i - u_ih||_{L2}^2)`.
    pub l2: f64,
    /// `sqrt(sum_i mu_i |u_i - u_ih|_{H1}^2)`, of a stack with the foundations.
    pub energy: f64,
    /// The bound of `energy`, guaranteed up to the quadrature of the loads; `None` for a stack, of which there is none yet.
    pub bound: Option<f64>,
    /// The largest error of both displacements at a vertex.
    pub nodal: f64,
    /// `||lambda - lambda_h||_{L2}`; of a stack `sqrt(sum_k ||lambda_k - lambda_kh||^2)`, away from line actions.
    pub lambda_l2: f64,
    /// `||lambda - lambda_h||_{H^-1}`, of a pair.
    pub lambda_dual: Option<f64>,
    /// An estimate of what is missing in it, by one more refinement of the lift.
    pub lambda_dual_estimate: Option<f64>,
    /// The error of the contact area.
    pub contact_area: f64,
    /// The relative quadrature error of the norms.
    pub quadrature: f64,
    /// Iterations of the solver.
    pub iterations: usize,
    /// Seconds for mesh, assembly and solution.
    pub solve_seconds: f64,
    /// Seconds for the norms.
    pub norm_seconds: f64,
    /// The Hausdorff distance of the rim of the contact set from the exact one, where that is a curve; of a stack the largest
    /// of all gaps.
    pub rim_distance: Option<f64>,
    /// The Jaccard index of the contact set and the exact one, likewise; of a stack the least of all gaps.
    pub jaccard: Option<f64>,
}

impl LevelErrors {
    /// The bound over the energy error, where there is an error.
    pub fn effectivity(&self) -> Option<f64> {
        Some(self.bound? / self.energy).filter(|index| index.is_finite())
    }
}

/// An error whose rate is of interest.
#[derive(Debug, Clone, Copy)]
pub struct Measure {
    /// The heading in tables and pictures.
    pub name: &'static str,
    /// Its value on a level, where it is known.
    pub of: fn(&LevelErrors) -> Option<f64>,
}

/// The errors of the tables, in their order: of functions, and of the contact set.
pub const MEASURES: [Measure; 8] = [
    Measure { name: "u in H1", of: |level| Some(level.h1) },
    Measure { name: "u in L2", of: |level| Some(level.l2) },
    Measure { name: "u at nodes", of: |level| Some(level.nodal) },
    Measure { name: "lambda in L2", of: |level| Some(level.lambda_l2) },
    Measure { name: "lambda in H^-1", of: |level| level.lambda_dual },
    Measure { name: "contact area", of: |level| Some(level.contact_area) },
    Measure { name: "rim, Hausdorff", of: |level| level.rim_distance },
    Measure { name: "1 - Jaccard", of: |level| level.jaccard.map(|index| (1.0 - index).max(0.0)) },
];

/// Those of the [`MEASURES`] that are known on one of the levels.
pub fn measures(levels: &[LevelErrors]) -> Vec<Measure> {
    let is_known = |measure: &Measure| levels.iter().any(|level| (measure.of)(level).is_some());
    MEASURES.into_iter().filter(is_known).collect()
}

/// The order of an error between two levels, `ln(e_0 / e_1) / ln(h_0 / h_1)`; `None` when one of them is zero or not known.
pub fn rate(measure: Measure, coarse: &LevelErrors, fine: &LevelErrors) -> Option<f64> {
    let ratio = (measure.of)(coarse)? / (measure.of)(fine)?;
    let rate = ratio.ln() / (coarse.h / fine.h).ln();
    rate.is_finite().then_some(rate)
}

/// The order of an error over all levels: the slope of the line through `(ln h, ln error)` by least squares; `None` with
/// fewer than two levels, or when an error is zero or not known.
pub fn fitted_rate(measure: Measure, levels: &[LevelErrors]) -> Option<f64> {
    exponent(levels.iter().map(|level| [level.h, (measure.of)(level).unwrap_or(f64::NAN)]))
}

/// The levels as a Markdown table: each error that is known with its rate from the level before, and over all levels; the
/// effectivity of the bound, where there is one.
pub fn markdown(levels: &[LevelErrors]) -> String {
    let measures = measures(levels);
    let bounded = levels.iter().any(|level| level.bound.is_some());
    let last = |text: String| if bounded { format!(" {text} |\n") } else { "\n".into() };
    let rate_text = |rate: Option<f64>| rate.map_or_else(String::new, |rate| format!("{rate:.2}"));
    let mut text = String::from("| vertices | h |");
    for measure in &measures {
        text += &format!(" {} | rate |", measure.name);
    }
    text += &last("effectivity".into());
    text += "|---:|---:|";
    text += &"---:|---:|".repeat(measures.len());
    text += if bounded { "---:|\n" } else { "\n" };
    for (k, level) in levels.iter().enumerate() {
        text += &format!("| {} | {:.2e} |", grouped(level.vertices), level.h);
        for measure in &measures {
            let rate = k.checked_sub(1).and_then(|before| rate(*measure, &levels[before], level));
            let error = (measure.of)(level).map_or_else(String::new, |error| format!("{error:.2e}"));
            text += &format!(" {error} | {} |", rate_text(rate));
        }
        text += &last(rate_text(level.effectivity()));
    }
    text += "| all levels | |";
    for measure in &measures {
        text += &format!(" | {} |", rate_text(fitted_rate(*measure, levels)));
    }
    text + if bounded { " |\n" } else { "\n" }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(level: usize, h: f64, error: f64) -> LevelErrors {
        LevelErrors {
            level,
            vertices: 10,
            triangles: 20,
            h,
            h_min: h,
            h1: error,
            l2: error,
            energy: error,
            bound: Some(1.25 * error),
            nodal: error,
            lambda_l2: error,
            lambda_dual: Some(error),
            lambda_dual_estimate: Some(0.0),
            contact_area: 0.0,
            quadrature: 0.0,
            iterations: 1,
            solve_seconds: 0.0,
            norm_seconds: 0.0,
            rim_distance: None,
            jaccard: None,
        }
    }

    #[test]
    fn rates_are_the_powers_of_the_mesh_size() {
        let coarse = level(0, 0.5, 0.25);
        assert_eq!(rate(MEASURES[0], &coarse, &level(1, 0.25, 0.0625)), Some(2.0));
        assert_eq!(rate(MEASURES[0], &coarse, &level(1, 0.25, 0.25)), Some(0.0));
        assert_eq!(rate(MEASURES[5], &coarse, &level(1, 0.25, 0.0625)), None, "zero errors have no rate");
    }

    #[test]
    fn the_fitted_rate_is_the_slope_of_a_power_and_the_mean_of_erratic_ones() {
        let power: Vec<LevelErrors> = [0.5, 0.25, 0.125].iter().map(|&h| level(0, h, 3.0 * h * h)).collect();
        assert!((fitted_rate(MEASURES[0], &power).unwrap() - 2.0).abs() < 1e-12);
        let erratic = [level(0, 0.5, 0.5), level(1, 0.25, 0.4), level(2, 0.125, 0.125)];
        assert!((fitted_rate(MEASURES[0], &erratic).unwrap() - 1.0).abs() < 1e-12);
        assert_eq!(fitted_rate(MEASURES[0], &power[..1]), None);
        assert_eq!(fitted_rate(MEASURES[5], &power), None, "zero errors have no rate");
    }

    #[test]
    fn the_table_has_a_row_for_each_level_and_the_rates_between_them() {
        let text = markdown(&[level(0, 0.5, 0.25), level(1, 0.25, 0.0625)]);
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 5);
        assert!(lines[2].starts_with("| 10 | 5.00e-1 | 2.50e-1 |  |"));
        assert!(lines[3].starts_with("| 10 | 2.50e-1 | 6.25e-2 | 2.00 |"));
        assert!(lines[3].ends_with("| 1.25 |"));
        assert!(lines[4].starts_with("| all levels | | | 2.00 |"));
        let columns: Vec<usize> = lines.iter().map(|line| line.matches('|').count()).collect();
        assert!(columns.iter().all(|&n| n == columns[0]), "{columns:?}");
    }
    #[test]
    fn what_is_not_known_has_no_column() {
        let pair = level(0, 0.5, 0.25);
        let stack = LevelErrors {
            bound: None,
            lambda_dual: None,
            rim_distance: Some(0.1),
            jaccard: Some(0.9),
            ..pair
        };
        let names = |level: LevelErrors| measures(&[level]).iter().map(|m| m.name).collect::<Vec<_>>();
        assert_eq!(names(pair).last(), Some(&"contact area"));
        assert!(!names(stack).contains(&"lambda in H^-1") && names(stack).contains(&"1 - Jaccard"));
        let table = markdown(&[stack]);
        assert!(!table.contains("H^-1") && !table.contains("effectivity"), "{table}");
        assert!(table.contains("| 1.00e-1 |  | 1.00e-1 |  |\n"), "{table}");
        let columns: Vec<usize> = table.lines().map(|line| line.matches('|').count()).collect();
        assert!(columns.iter().all(|&n| n == columns[0]), "{columns:?}");
    }
}
