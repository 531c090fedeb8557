"""The exported QP solved by the solvers of qpsolvers, against the solution that the program found.

qpsolvers minimises 1/2 x'Px + q'x subject to G x <= h, with P x + q + G'z = 0 and z >= 0: hence G = -A,
h = -b, z = y.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import qpsolvers

import assembly
from case_file import read_case
from kkt import kkt_residuals
from problem import QuadraticProgram, Vector
from program import Program

# Each solver asked for nearly all that double precision gives.
SOLVERS: dict[str, dict[str, float]] = {
    "clarabel": {"tol_gap_abs": 1e-13, "tol_gap_rel": 1e-13, "tol_feas": 1e-13},
    "cvxopt": {"abstol": 1e-13, "reltol": 1e-13, "feastol": 1e-12},
    "osqp": {"eps_abs": 1e-10, "eps_rel": 1e-10, "max_iter": 100_000, "polishing": True},
    "piqp": {"eps_abs": 1e-12, "eps_rel": 1e-12, "eps_duality_gap_abs": 1e-12, "eps_duality_gap_rel": 1e-12},
    "qpalm": {"eps_abs": 1e-11, "eps_rel": 1e-11, "max_iter": 10_000},
    "scs": {"eps_abs": 1e-11, "eps_rel": 1e-11, "max_iters": 100_000},
}

# The residual that each of them reaches with these settings, with room for another order of the unknowns.
KKT_TOLERANCE = 1e-9

# An interior-point solver stops with products y w of 1e-12 or so, but where both are small, by the free
# boundary, each may be off by the square root of that. Primal as a fraction of the range of u; lambda, a
# force per area, as a fraction of the greatest load.
PRIMAL_TOLERANCE = 1e-6
LAMBDA_TOLERANCE = 1e-4

# The energy is stationary at the solution: its error is the square of the primal one, so rounding and the
# infeasibility times the multiplier remain.
ENERGY_TOLERANCE = 1e-9

pytestmark = pytest.mark.filterwarnings("ignore:The default value of raise_error:PendingDeprecationWarning")


def solve(qp: QuadraticProgram, solver: str, **settings: float) -> tuple[Vector, Vector]:
    """The point x, shape (N,), and the multiplier y, shape (m,), at which `solver` calls itself done."""
    solution = qpsolvers.solve_problem(qpsolvers.Problem(qp.P, qp.q, -qp.A, -qp.b), solver=solver, **settings)
    assert solution.found, f"{solver} found no solution"
    return solution.x, solution.z


@pytest.mark.parametrize("solver", SOLVERS)
def test_solver_agrees_with_the_program(program: Program, case: Path, solver: str) -> None:
    problem, found = program.problem(case), program.solve(case)
    x, y = solve(problem.qp, solver, **SOLVERS[solver])
    residuals = kkt_residuals(problem.qp, x, y)
    assert residuals.satisfied(KKT_TOLERANCE), residuals

    own_x, own_y = found.unknowns(problem)
    assert np.max(np.abs(x - own_x)) <= PRIMAL_TOLERANCE * np.ptp(own_x)
    action_error = np.max(np.abs(y - own_y) / problem.dual_area)
    assert action_error <= LAMBDA_TOLERANCE * assembly.load_scale(problem, read_case(case))
    # With the constant, every solver's optimum is the energy of the summary.
    own_energy = found.summary["energy"]
    assert abs(problem.qp.energy(x) - own_energy) <= ENERGY_TOLERANCE * abs(own_energy)


def test_a_loose_answer_is_found_but_not_accepted(program: Program, case: Path) -> None:
    """The negative test: OSQP at its default tolerance reports success all the same."""
    qp = program.problem(case).qp
    x, y = solve(qp, "osqp", eps_abs=1e-3, eps_rel=1e-3, polishing=False)
    assert not kkt_residuals(qp, x, y).satisfied(KKT_TOLERANCE)
