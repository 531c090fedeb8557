//! Loads between the points of the quadrature: the bound does not hold then, and a warning says so.

use membrane_contact::discretization::Discretization;
use membrane_contact::estimate::{DataWarning, ErrorBound};
use membrane_contact::mesh::{Pattern, rectangle};
use membrane_contact::problem::{ContactProblem, Expression};
use membrane_contact::solver::{ActiveSet, SolverOptions};
use membrane_contact::study::{Tolerance, solve_bounded};

fn bound(f1: &str, f2: &str, cells: usize) -> ErrorBound {
    let [f1, f2] = [f1, f2].map(|formula| formula.parse::<Expression>().unwrap());
    let problem = ContactProblem::builder().tension(1.0, 3.0).load(f1, f2).height(0.1).build().unwrap();
    let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [cells, cells], Pattern::Right).unwrap();
    let d = Discretization::new(&problem, mesh).unwrap();
    let options = SolverOptions::default();
    let bounded = solve_bounded(&problem, None, &d, &mut ActiveSet, &options, Tolerance::Fixed(1e-8));
    bounded.unwrap().bound.unwrap()
}

/// The error is above 1.39, the bound a hundredth of that.
#[test]
fn a_load_that_the_quadrature_misses_is_named() {
    let blind = "-1-1000000*exp(-((x-0.53)^2+(y-0.52)^2)/0.000001)";
    for (f1, f2, named) in [(blind, "0", 1), ("0", blind, 2)] {
        let bound = bound(f1, f2, 32);
        let [DataWarning::Unresolved { membrane, difference, bound: total }] = bound.warnings[..] else {
            panic!("{:?}", bound.warnings)
        };
        assert_eq!((membrane, total), (named, bound.total));
        assert!(difference > 1.39, "{difference}");
        assert!(
            bound.warnings[0].to_string().starts_with(&format!("load f{named}: two quadrature rules differ"))
        );
    }
    // Wide enough to be met, it is no matter for a warning.
    let wide = "-1-1000*exp(-((x-0.53)^2+(y-0.52)^2)/0.001)";
    assert_eq!(bound(wide, "0", 32).warnings, []);
}

/// The quadrature moves a jump that a formula does not announce; it is at most half of the bound.
#[test]
fn jumps_are_below_the_bound() {
    for formula in ["if(x < 0.4321, 10, -10)", "if((x-0.3)^2 + (y-0.4)^2 < 0.01, -100, 0)", "10*sin(9*pi*x)"]
    {
        for cells in [8, 32, 128] {
            let bound = bound(formula, "1", cells);
            let part = bound.quadrature_difference[0] / bound.total;
            assert!(part > 0.0 && part < 0.6 && bound.warnings.is_empty(), "{formula}, {cells}: {part}");
        }
    }
}

#[test]
fn a_load_that_is_zero_at_all_points_is_told_from_none() {
    let vanishing = bound("-1", "if(x > 2, 1, 0)", 8);
    assert_eq!(vanishing.warnings, [DataWarning::Vanishing { membrane: 2 }]);
    assert_eq!(bound("-1", "1", 8).warnings, []);
}
