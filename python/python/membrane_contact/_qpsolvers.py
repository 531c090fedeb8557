"""The solvers of qpsolvers as backends."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def qpsolvers_backend(name: str, **settings: Any) -> Callable[..., tuple[ArrayLike, ArrayLike]]:
    """A solver of qpsolvers as the ``solver`` of `solve`.

    What it returns is judged by the certificate, as that of any other solver.

    Parameters
    ----------
    name : str
        One of ``qpsolvers.available_solvers``.
    **settings
        Handed to the solver as they are, such as ``eps_abs=1e-9``.

    Returns
    -------
    callable
        ``(P, q, A, b, *, tolerance, max_iterations, time_limit) -> (x, y)``.

    Raises
    ------
    ValueError
        There is no such solver.
    """
    import qpsolvers

    if name not in qpsolvers.available_solvers:
        known = ", ".join(qpsolvers.available_solvers)
        raise ValueError(f"qpsolvers has no solver {name!r} here: it has {known}")

    def backend(P: Any, q: Any, A: Any, b: Any, **_: Any) -> tuple[ArrayLike, ArrayLike]:
        from ._core import BackendError

        problem = qpsolvers.Problem(P, q, -A.tocsc(), -b)
        if name not in qpsolvers.sparse_solvers:
            problem = qpsolvers.Problem(P.toarray(), q, -A.toarray(), -b)
        answer = qpsolvers.solve_problem(problem, solver=name, **settings)
        if answer.x is None or answer.z is None:
            raise BackendError(f"{name} returns no answer")
        return answer.x, answer.z

    backend.__name__ = name
    return backend
