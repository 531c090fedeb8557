"""The solvers of qpsolvers, and what each needs to be asked for one tolerance.

At its *default* a solver has no setting at all. At a *tight* setting, one tolerance goes into all of a solver's own
stopping criteria, its limit of iterations is out of the way, and what it has to sharpen an answer is on. The problem
has been scaled to units of size 1 before, so absolute and relative tolerances mean about the same.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

# Iterations that nobody makes within the limit of time.
MANY = 10_000_000

Settings = dict[str, Any]


def _clarabel(tolerance: float) -> Settings:
    return {"tol_gap_abs": tolerance, "tol_gap_rel": tolerance, "tol_feas": tolerance}


def _cvxopt(tolerance: float) -> Settings:
    return {"abstol": tolerance, "reltol": tolerance, "feastol": tolerance}


def _daqp(tolerance: float) -> Settings:
    return {"primal_tol": tolerance, "dual_tol": tolerance, "iter_limit": MANY}


def _highs(tolerance: float) -> Settings:
    # P is positive definite: it needs no regularisation, which would change the solution.
    return {
        "primal_feasibility_tolerance": tolerance,
        "dual_feasibility_tolerance": tolerance,
        "qp_regularization_value": 0.0,
    }


def _osqp(tolerance: float) -> Settings:
    return {"eps_abs": tolerance, "eps_rel": tolerance, "max_iter": MANY, "polishing": True}


def _piqp(tolerance: float) -> Settings:
    # Its defaults are 1e-8 absolute and 1e-9 relative: the same ratio, so that no tight setting is a looser one.
    relative = tolerance / 10.0
    gap = {"eps_duality_gap_abs": tolerance, "eps_duality_gap_rel": relative}
    return {"eps_abs": tolerance, "eps_rel": relative, **gap}


def _proxqp(tolerance: float) -> Settings:
    return {"eps_abs": tolerance, "eps_rel": tolerance, "max_iter": MANY}


def _qpalm(tolerance: float) -> Settings:
    return {"eps_abs": tolerance, "eps_rel": tolerance, "max_iter": MANY}


def _scs(tolerance: float) -> Settings:
    return {"eps_abs": tolerance, "eps_rel": tolerance, "max_iters": MANY}


TIGHT: dict[str, Callable[[float], Settings]] = {
    "clarabel": _clarabel,
    "cvxopt": _cvxopt,
    "osqp": _osqp,
    "piqp": _piqp,
    "scs": _scs,
    "qpalm": _qpalm,
    "proxqp": _proxqp,
    "highs": _highs,
    "daqp": _daqp,
}


def settings(solver: str, tolerance: float | None) -> Settings:
    """The settings of a solver; `None` stands for its defaults."""
    return {} if tolerance is None else TIGHT[solver](tolerance)


def iterations(solver: str, extras: dict[str, Any]) -> int | None:
    """How many iterations it tells of; None where qpsolvers does not hand the number on."""
    if solver == "cvxopt":
        return int(extras["iterations"])
    if solver == "scs":
        return int(extras["iter"])
    count = getattr(extras.get("info"), "iter", None)
    return None if count is None else int(count)


def setup_within_solve(solver: str, extras: dict[str, Any]) -> float:
    """Seconds of set-up that qpsolvers counts as solve, because the solver's one call does both and tells."""
    if solver == "scs":
        return float(extras["setup_time"]) / 1e3
    if solver == "proxqp":
        return float(extras["info"].setup_time) / 1e6
    return 0.0
