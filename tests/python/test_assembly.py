"""The exported QP against a second assembly from the mesh and the case file.

Solvers that agree prove nothing about the QP that they share: a flipped sign in the boundary lift fools all
of them. It is seen here.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import scipy.sparse as sp

import assembly
from case_file import case_named, read_case
from problem import Vector
from program import Program

# Sums of a few dozen terms, each with a few roundings.
ROUNDING = 1e-13

# Quadrature of the program on a load that is no polynomial, relative to the greatest force: the rule of
# degree 4 leaves less than this for sin(pi x) on triangles of size 1/20, a wrong load or sign far more.
QUADRATURE = 1e-5

# Cases with a height whose lift acts on the interior.
LIFTED = ("partial-contact", "polynomial", "no-contact", "unstructured")


def relative_difference(one: Vector, other: Vector) -> float:
    """The greatest difference, over the greatest component of `other`."""
    return float(np.max(np.abs(one - other)) / np.max(np.abs(other)))


def linear_term(program: Program, case: Path, lift_sign: float = 1.0) -> Vector:
    """q = (mu1 K_IB g_B - F_1, -F_2) on the interior vertices, assembled here."""
    problem, data = program.problem(case), read_case(case)
    first, second = assembly.loads(problem, data)
    lift = lift_sign * assembly.boundary_lift(problem, data)
    return np.concatenate((lift - first[problem.interior], -second[problem.interior]))


def test_assembly_of_the_reference_triangle() -> None:
    """By hand: K = 1/2 [[2, -1, -1], [-1, 1, 0], [-1, 0, 1]] and int x y phi_1 = 2!/5! (phi_1 = x)."""
    points, triangles = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), np.array([[0, 1, 2]])
    expected = 0.5 * np.array([[2.0, -1.0, -1.0], [-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]])
    assert np.array_equal(assembly.stiffness(points, triangles).toarray(), expected)
    load = assembly.load_vector(points, triangles, lambda x, y: x * y)
    assert np.allclose(load, [1.0 / 120.0, 2.0 / 120.0, 2.0 / 120.0], rtol=ROUNDING, atol=0.0)
    assert np.allclose(assembly.dual_areas(points, triangles), 1.0 / 6.0, rtol=ROUNDING, atol=0.0)


def test_triangles_are_counter_clockwise_and_interior_is_the_complement_of_the_boundary(
    program: Program, case: Path
) -> None:
    problem = program.problem(case)
    assert np.all(assembly.areas(problem.points, problem.triangles) > 0.0)
    boundary = assembly.boundary_vertices(problem.triangles)
    complement = np.setdiff1d(problem.triangles, boundary)
    assert np.array_equal(np.sort(problem.interior), complement)


def test_hessian_is_the_stiffness_of_each_membrane(program: Program, case: Path) -> None:
    problem, (mu1, mu2) = program.problem(case), read_case(case).tension
    interior = problem.interior
    stiffness = assembly.stiffness(problem.points, problem.triangles)[interior][:, interior]
    expected = sp.block_diag((mu1 * stiffness, mu2 * stiffness), format="csc")
    assert abs(problem.qp.P - expected).max() <= ROUNDING * abs(expected).max()
    swapped = sp.block_diag((mu2 * stiffness, mu1 * stiffness), format="csc")
    assert abs(problem.qp.P - swapped).max() > ROUNDING * abs(expected).max()


def test_constraints_are_the_gap(program: Program, case: Path) -> None:
    problem = program.problem(case)
    n = problem.interior.size
    gap = sp.hstack((sp.eye_array(n), -sp.eye_array(n)), format="csc")
    assert abs(problem.qp.A - gap).max() == 0.0
    assert abs(-problem.qp.A - gap).max() == 2.0
    assert not problem.qp.b.any()


def test_dual_areas_are_thirds_of_triangles(program: Program, case: Path) -> None:
    problem = program.problem(case)
    expected = assembly.dual_areas(problem.points, problem.triangles)
    assert relative_difference(problem.dual_area, expected[problem.interior]) <= ROUNDING
    assert relative_difference(problem.dual_area, 3.0 * expected[problem.interior]) > ROUNDING


def test_linear_term(program: Program, case: Path) -> None:
    """Polynomial loads of degree 3 and less are integrated exactly on both sides."""
    tolerance = ROUNDING if read_case(case).polynomial_loads else QUADRATURE
    assert relative_difference(program.problem(case).qp.q, linear_term(program, case)) <= tolerance


@pytest.mark.parametrize("stem", LIFTED)
def test_linear_term_sees_a_flipped_boundary_lift(program: Program, stem: str) -> None:
    case = case_named(stem)
    flipped = linear_term(program, case, lift_sign=-1.0)
    assert relative_difference(program.problem(case).qp.q, flipped) > QUADRATURE
