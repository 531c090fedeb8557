"""The KKT test itself, on QPs solved by hand, and what it is needed for."""

from __future__ import annotations

import numpy as np
import pytest
import qpsolvers
import scipy.sparse as sp

from kkt import kkt_residuals
from problem import QuadraticProgram, Vector

# The hand-made QPs have exact solutions in binary fractions up to a few roundings.
ROUNDING = 1e-14

# Tensions 1 and 3, two interior vertices with stiffness 4 each and no coupling. Vertex 0, pressed together by
# F = (-4, 12): u1 = u2 = 8/16, y = 4 u1 + 4 = 6. Vertex 1, pulled apart by F = (4, 0): u1 = 1, u2 = 0, y = 0.
TWO_VERTICES = QuadraticProgram(
    P=sp.csc_matrix(np.diag([4.0, 4.0, 12.0, 12.0])),
    q=np.array([4.0, -4.0, -12.0, 0.0]),
    A=sp.csc_matrix(np.array([[1.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, -1.0]])),
    b=np.zeros(2),
)
X, Y = np.array([0.5, 1.0, 0.5, 0.0]), np.array([6.0, 0.0])

# min x^2/2 - 2x, -1 <= x <= 1: the solution is x = 1, pressed against the upper bound by y = (1, 0).
INTERVAL = QuadraticProgram(
    P=sp.csc_matrix([[1.0]]), q=np.array([-2.0]), A=sp.csc_matrix([[-1.0], [1.0]]), b=np.array([-1.0, -1.0])
)


def rejected_by(qp: QuadraticProgram, x: Vector, y: Vector) -> set[str]:
    """The names of the conditions that the point violates."""
    residuals = vars(kkt_residuals(qp, x, y))
    return {name for name, residual in residuals.items() if not residual <= ROUNDING}


def test_accepts_the_solution() -> None:
    assert kkt_residuals(TWO_VERTICES, X, Y).satisfied(ROUNDING)
    assert kkt_residuals(INTERVAL, np.array([1.0]), np.array([1.0, 0.0])).satisfied(ROUNDING)


def test_accepts_the_solution_of_a_qp_without_forces() -> None:
    free = QuadraticProgram(TWO_VERTICES.P, np.zeros(4), TWO_VERTICES.A, np.zeros(2))
    assert kkt_residuals(free, np.zeros(4), np.zeros(2)).satisfied(0.0)


@pytest.mark.parametrize(
    ("condition", "x", "y"),
    [
        # Vertex 1 moved without a force that would hold it there.
        ("stationarity", [0.5, 1.1, 0.5, 0.0], [6.0, 0.0]),
        # Vertex 0 released: each membrane follows its own load through the other.
        ("primal", [-1.0, 1.0, 1.0, 0.0], [0.0, 0.0]),
        # Vertex 1 glued: u1 = u2 = 4/16 takes a pull y = 4/4 - 4.
        ("dual_sign", [0.5, 0.25, 0.5, 0.25], [6.0, -3.0]),
        # Vertex 1 pushed apart by y = 1 across a gap of 5/4 + 1/12.
        ("complementarity", [0.5, 1.25, 0.5, -1.0 / 12.0], [6.0, 1.0]),
    ],
)
def test_each_condition_rejects_what_the_others_accept(
    condition: str, x: list[float], y: list[float]
) -> None:
    assert rejected_by(TWO_VERTICES, np.array(x), np.array(y)) == {condition}


def test_rejects_a_flipped_dual() -> None:
    assert rejected_by(TWO_VERTICES, X, -Y) == {"stationarity", "dual_sign"}


def test_rejects_what_solves_the_qp_without_a_row() -> None:
    x, y = np.array([-1.0, 1.0, 1.0, 0.0]), np.zeros(2)
    assert kkt_residuals(TWO_VERTICES.without_row(0), x, y[1:]).satisfied(ROUNDING)
    assert rejected_by(TWO_VERTICES, x, y) == {"primal"}
    with pytest.raises(ValueError, match="do not fit"):
        kkt_residuals(TWO_VERTICES, x, y[1:])


@pytest.mark.parametrize("place", range(4))
def test_nan_never_passes(place: int) -> None:
    x, y, q = X.copy(), Y.copy(), TWO_VERTICES.q.copy()
    x[place] = np.nan
    assert not kkt_residuals(TWO_VERTICES, x, Y).satisfied(np.inf)
    y[place % 2] = np.nan
    assert not kkt_residuals(TWO_VERTICES, X, y).satisfied(np.inf)
    q[place] = np.nan
    poisoned = QuadraticProgram(TWO_VERTICES.P, q, TWO_VERTICES.A, TWO_VERTICES.b)
    assert not kkt_residuals(poisoned, X, Y).satisfied(np.inf)


def test_rejects_a_point_that_qpsolvers_calls_optimal() -> None:
    """Why ours exists: the gap in `Solution.is_optimal` cancels, and it never looks at the sign of z."""
    x, z = np.array([0.0]), np.array([1.0, -1.0])
    solution = qpsolvers.Solution(qpsolvers.Problem(INTERVAL.P, INTERVAL.q, -INTERVAL.A, -INTERVAL.b))
    solution.found, solution.x, solution.z = True, x, z
    solution.y, solution.z_box = np.zeros(0), np.zeros(0)
    assert solution.is_optimal(eps_abs=ROUNDING)
    assert rejected_by(INTERVAL, x, z) == {"dual_sign", "complementarity"}
