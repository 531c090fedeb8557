"""A componentwise test of the Karush-Kuhn-Tucker conditions of a quadratic program.

For a convex QP the four conditions together prove that x is the minimiser and y its multiplier. A duality gap
is a sum, in which an error of one sign hides one of the other, and it says nothing of the sign of y: here
every component counts by itself, complementarity is a product for each constraint, and NaN never passes.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass

import numpy as np

from problem import QuadraticProgram, Vector


@dataclass(frozen=True)
class KktResiduals:
    """The four residuals, dimensionless: 0 at the solution, NaN where the data or the point hold a NaN.

    They are maxima over the components, divided by the greatest force F (of |q|, |Px|, |A'y|) for the
    stationarity and the sign, by the greatest length L (of |b|, |A||x|) for the feasibility, and by F L for
    the complementarity.
    """

    stationarity: float
    primal: float
    dual_sign: float
    complementarity: float

    def satisfied(self, tolerance: float) -> bool:
        """Whether each residual is at most `tolerance`; false where one is NaN."""
        return all(residual <= tolerance for residual in astuple(self))


def kkt_residuals(qp: QuadraticProgram, x: Vector, y: Vector) -> KktResiduals:
    """The residuals of `qp` at the point `x`, shape (N,), with the multiplier `y`, shape (m,).

    Raises ValueError when `x` or `y` is of another shape.
    """
    if x.shape != qp.q.shape or y.shape != qp.b.shape:
        raise ValueError(f"x {x.shape} and y {y.shape} do not fit q {qp.q.shape} and b {qp.b.shape}")
    elastic, contact = qp.P @ x, qp.A.T @ y
    slack = qp.A @ x - qp.b
    force = max(_greatest(qp.q), _greatest(elastic), _greatest(contact))
    length = max(_greatest(qp.b), _greatest(abs(qp.A) @ abs(x)))
    return KktResiduals(
        stationarity=_ratio(_greatest(elastic + qp.q - contact), force),
        primal=_ratio(_greatest(np.minimum(slack, 0.0)), length),
        dual_sign=_ratio(_greatest(np.minimum(y, 0.0)), force),
        complementarity=_ratio(_greatest(y * slack), force * length),
    )


def _greatest(values: Vector) -> float:
    """The greatest absolute value: 0 of an empty vector, NaN as soon as one component is NaN."""
    return float(np.max(np.abs(values), initial=0.0))


def _ratio(residual: float, scale: float) -> float:
    """The residual over its scale, and 0 for a residual of exactly 0, whose scale may vanish too."""
    if residual == 0.0:
        return 0.0
    return residual / scale if scale != 0.0 else float("inf")
