"""The guaranteed error bound: its parts of the files, recomputed, and the bound against a much finer solution."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from case_file import read_case
from problem import Vector
from program import Program, ProgramSolution

# Sums of some thousand squares.
ROUNDING = 1e-10

# Refinements of the finer solution: what it misses itself is an eighth of the error.
FINER = 3


def slopes(solution: ProgramSolution, values: Vector) -> Vector:
    """The gradients of a P1 function, shape (triangles, 2)."""
    corners, at = solution.points[solution.triangles], values[solution.triangles]
    sides = corners[:, 1:] - corners[:, :1]
    return np.linalg.solve(sides, (at[:, 1:] - at[:, :1])[..., np.newaxis])[..., 0]


def areas(solution: ProgramSolution) -> Vector:
    corners = solution.points[solution.triangles]
    sides = corners[:, 1:] - corners[:, :1]
    return 0.5 * np.linalg.det(sides)


def energy_distance(tension: tuple[float, float], finer: ProgramSolution, coarse: ProgramSolution) -> float:
    """Of two solutions on nested meshes, where the parts of a triangle stand together, in the order of the triangles."""
    parts = len(finer.triangles) // len(coarse.triangles)
    total = 0.0
    for mu, one, other in zip(tension, (finer.u1, finer.u2), (coarse.u1, coarse.u2), strict=True):
        difference = slopes(finer, one) - np.repeat(slopes(coarse, other), parts, axis=0)
        total += mu * np.sum(areas(finer) * np.sum(difference**2, axis=1))
    return float(np.sqrt(total))


def test_indicators_add_up_and_the_norm_is_that_of_the_solution(program: Program, case: Path) -> None:
    solution = program.solve(case)
    bound, norm = solution.summary["error_bound"], solution.summary["energy_norm"]
    assert np.sum(solution.indicator**2) == pytest.approx(bound**2, rel=1e-6)
    assert np.sum(solution.indicator[1:] ** 2) < bound**2
    tension = read_case(case).tension
    squares = (
        mu * np.sum(areas(solution) * np.sum(slopes(solution, u) ** 2, axis=1))
        for mu, u in zip(tension, (solution.u1, solution.u2), strict=True)
    )
    assert norm == pytest.approx(np.sqrt(sum(squares)), rel=ROUNDING)
    relative = solution.summary["relative_error_bound"]
    if relative is not None:
        assert relative == pytest.approx(bound / (norm - bound), rel=ROUNDING)


def test_the_bound_is_above_the_distance_to_a_much_finer_solution(program: Program, case: Path) -> None:
    coarse, finer = program.solve(case), program.solve(case, refine=FINER)
    tension = read_case(case).tension
    bound, distance = coarse.summary["error_bound"], energy_distance(tension, finer, coarse)
    assert bound >= distance
    # The negative test: with an error twice as large, it would be below.
    assert bound < 2.0 * distance
