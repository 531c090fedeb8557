"""The program's own solution: its KKT residuals, recomputed here, and its values where they are known."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import scipy.sparse.linalg as spla

import assembly
from case_file import case_named, read_case
from kkt import kkt_residuals
from problem import QuadraticProgram, Vector
from program import Program

# The active set ends with one direct solve; the files carry every digit.
ROUNDING = 1e-11

# lambda_a is a force, good to rounding, divided by the small |D_a|: as a fraction of the greatest load.
ACTION_ROUNDING = 1e-9

# A disturbance that every check of this file has to see, relative to the greatest value.
DISTURBANCE = 1e-6

Point = tuple[QuadraticProgram, Vector, Vector]


def flip_the_dual(qp: QuadraticProgram, x: Vector, y: Vector) -> Point:
    """Action and reaction exchanged."""
    return qp, x, -y


def move_one_vertex(qp: QuadraticProgram, x: Vector, y: Vector) -> Point:
    """One displacement off by a millionth of the greatest."""
    moved = x.copy()
    moved[x.size // 4] += DISTURBANCE * np.max(np.abs(x))
    return qp, moved, y


def poison_one_vertex(qp: QuadraticProgram, x: Vector, y: Vector) -> Point:
    """A displacement that is not a number."""
    poisoned = x.copy()
    poisoned[0] = np.nan
    return qp, poisoned, y


def poison_one_force(qp: QuadraticProgram, x: Vector, y: Vector) -> Point:
    """A force that is not a number."""
    poisoned = y.copy()
    poisoned[-1] = np.nan
    return qp, x, poisoned


def drop_the_strongest_contact(qp: QuadraticProgram, x: Vector, y: Vector) -> Point:
    """The constraint with the greatest multiplier taken away."""
    strongest = int(np.argmax(y))
    return qp.without_row(strongest), x, np.delete(y, strongest)


def test_satisfies_the_kkt_conditions(program: Program, case: Path) -> None:
    problem = program.problem(case)
    residuals = kkt_residuals(problem.qp, *program.solve(case).unknowns(problem))
    assert residuals.satisfied(ROUNDING), residuals


@pytest.mark.parametrize(
    "disturb",
    [flip_the_dual, move_one_vertex, poison_one_vertex, poison_one_force, drop_the_strongest_contact],
)
def test_kkt_conditions_see_a_disturbance(program: Program, disturb: Callable[..., Point]) -> None:
    case = case_named("partial-contact")
    problem = program.problem(case)
    disturbed = disturb(problem.qp, *program.solve(case).unknowns(problem))
    assert not kkt_residuals(*disturbed).satisfied(ROUNDING)


def test_vertices_keep_the_order_of_the_mesh(program: Program, case: Path) -> None:
    assert np.array_equal(program.solve(case).points, program.problem(case).points)


def test_boundary_values(program: Program, case: Path) -> None:
    problem, solution, data = program.problem(case), program.solve(case), read_case(case)
    boundary = assembly.boundary_vertices(problem.triangles)
    height = assembly.boundary_height(problem.points, problem.triangles, data.height)[boundary]
    assert np.allclose(solution.u1[boundary], height, rtol=ROUNDING, atol=0.0)
    assert not solution.u2[boundary].any() and not solution.action[boundary].any()


def test_gap_and_contact_belong_to_the_displacements(program: Program, case: Path) -> None:
    problem, solution = program.problem(case), program.solve(case)
    length = np.max(np.abs(solution.u1))
    assert np.max(np.abs(solution.gap - (solution.u1 - solution.u2))) <= ROUNDING * length
    assert np.all(np.isin(solution.contact, (0, 1)))
    contact = solution.contact[problem.interior] == 1
    assert np.all(np.abs(solution.gap[problem.interior][contact]) <= ROUNDING * length)
    noise = ACTION_ROUNDING * assembly.load_scale(problem, read_case(case))
    assert np.all(solution.action[problem.interior] >= -noise)
    assert np.all(solution.action[problem.interior][~contact] <= noise)


def test_summary_agrees_with_the_fields(program: Program, case: Path) -> None:
    problem, solution = program.problem(case), program.solve(case)
    summary, (_, y) = solution.summary, solution.unknowns(problem)
    greatest_force = assembly.load_scale(problem, read_case(case)) * problem.dual_area.sum()
    assert summary["certified"] is True
    assert (summary["vertices"], summary["triangles"]) == (len(problem.points), len(problem.triangles))
    assert summary["contact_vertices"] == np.count_nonzero(solution.contact)
    assert summary["total_force"] == pytest.approx(y.sum(), rel=0.0, abs=ACTION_ROUNDING * greatest_force)


def test_energy_of_the_summary(program: Program) -> None:
    """J(u) = sum_i mu_i/2 |u_i|_1^2 - (f_i, u_i), boundary values included."""
    case = case_named("polynomial")
    problem, solution, data = program.problem(case), program.solve(case), read_case(case)
    stiffness = assembly.stiffness(problem.points, problem.triangles)
    energy = sum(
        0.5 * mu * u @ (stiffness @ u) - load @ u
        for mu, u, load in zip(
            data.tension, (solution.u1, solution.u2), assembly.loads(problem, data), strict=True
        )
    )
    assert solution.summary["energy"] == pytest.approx(energy, rel=ROUNDING, abs=0.0)


def test_full_contact_shares_the_loads(program: Program) -> None:
    """Glued everywhere with g = 0: M K u = F_1 + F_2 and y = (mu1 F_2 - mu2 F_1) / M."""
    case = case_named("full-contact")
    problem, solution, data = program.problem(case), program.solve(case), read_case(case)
    first, second = (load[problem.interior] for load in assembly.loads(problem, data))
    mu1, mu2 = data.tension
    action = (mu1 * second - mu2 * first) / (mu1 + mu2) / problem.dual_area
    found = solution.action[problem.interior]
    assert np.allclose(found, action, rtol=ACTION_ROUNDING, atol=0.0)
    swapped = (mu2 * second - mu1 * first) / (mu1 + mu2) / problem.dual_area
    assert not np.allclose(found, swapped, rtol=ACTION_ROUNDING, atol=0.0)


def test_without_contact_each_membrane_obeys_its_own_load(program: Program) -> None:
    """mu_i K u_i = F_i, with g lifted into membrane 1."""
    case = case_named("no-contact")
    problem, solution, data = program.problem(case), program.solve(case), read_case(case)
    interior = problem.interior
    stiffness = assembly.stiffness(problem.points, problem.triangles)[interior][:, interior]
    first, second = (load[interior] for load in assembly.loads(problem, data))
    u1 = spla.spsolve(data.tension[0] * stiffness, first - assembly.boundary_lift(problem, data))
    u2 = spla.spsolve(data.tension[1] * stiffness, second)
    assert np.allclose(solution.u1[interior], u1, rtol=ROUNDING, atol=0.0)
    assert np.allclose(solution.u2[interior], u2, rtol=ROUNDING, atol=0.0)
    assert not np.allclose(solution.u1[interior], u2, rtol=ROUNDING, atol=0.0)
    assert np.max(np.abs(solution.action)) <= ACTION_ROUNDING * assembly.load_scale(problem, data)
