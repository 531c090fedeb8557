"""QP solvers written in Python: whatever they say, only what is certified is a solution."""

from __future__ import annotations

import threading
import time
from functools import partial
from typing import Any

import numpy as np
import pytest

import membrane_contact as mc
from helpers import OBSTACLE, PAIR, STACK, is_same, same_bits, zero_backend

try:
    import qpsolvers
except ImportError:
    qpsolvers = None

pytest.importorskip("scipy")

MESH = mc.Mesh.rectangle(8)

PROBLEMS = {"pair": PAIR, "obstacle": OBSTACLE, "stack": STACK}

# What a solution certified within 1e-8 may differ from the exact one on such a small mesh: the residuals are relative to the data.
NEAR = 1e-6

#: Those which are accurate, and how.
GOOD: dict[str, dict[str, Any]] = {
    "clarabel": {},
    "osqp": {"eps_abs": 1e-9, "eps_rel": 1e-9, "max_iter": 100_000},
    "piqp": {"eps_abs": 1e-9, "eps_rel": 1e-9},
}

INSTALLED = () if qpsolvers is None else tuple(qpsolvers.available_solvers)

needs_qpsolvers = pytest.mark.skipif(qpsolvers is None, reason="qpsolvers is not installed")


@needs_qpsolvers
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("problem", PROBLEMS)
@pytest.mark.parametrize("name", GOOD)
def test_good_solvers_certify_without_polish(name: str, problem: str) -> None:
    if name not in INSTALLED:
        pytest.skip(f"{name} is not installed")
    solver = mc.qpsolvers_backend(name, **GOOD[name])
    solution = mc.solve(MESH, **PROBLEMS[problem], solver=solver, polish=False)
    assert solution.solver == name
    assert solution.residual <= solution.tolerance == 1e-8
    assert np.abs(solution.u1 - mc.solve(MESH, **PROBLEMS[problem]).u1).max() < NEAR


@needs_qpsolvers
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", INSTALLED)
def test_every_installed_solver_with_polish(name: str) -> None:
    solution = mc.solve(MESH, **PAIR, solver=mc.qpsolvers_backend(name))
    assert is_same(solution.u1, mc.solve(MESH, **PAIR).u1)


@needs_qpsolvers
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("problem", PROBLEMS)
@pytest.mark.parametrize("name", INSTALLED)
def test_every_installed_solver_is_right_or_rejected(name: str, problem: str) -> None:
    try:
        solution = mc.solve(MESH, **PROBLEMS[problem], solver=mc.qpsolvers_backend(name), polish=False)
    except mc.CertificationError as error:
        assert max(error.residuals.values()) > 1e-8
    except mc.BackendError as error:
        assert name in str(error)
    else:
        assert np.abs(solution.u1 - mc.solve(MESH, **PROBLEMS[problem]).u1).max() < NEAR


@needs_qpsolvers
@pytest.mark.filterwarnings("ignore")
def test_settings_reach_the_solver() -> None:
    if "osqp" not in INSTALLED:
        pytest.skip("osqp is not installed")
    with pytest.raises((mc.CertificationError, mc.BackendError)):
        mc.solve(MESH, **PAIR, solver=mc.qpsolvers_backend("osqp", max_iter=1), polish=False)


@needs_qpsolvers
def test_an_unknown_solver_is_refused_at_once() -> None:
    with pytest.raises(ValueError, match="clarabel") as caught:
        mc.qpsolvers_backend("no_such_solver")
    assert "no_such_solver" in str(caught.value)


def test_zeros_are_rejected_with_residuals() -> None:
    with pytest.raises(mc.CertificationError, match="zero_backend") as caught:
        mc.solve(MESH, **PAIR, solver=zero_backend, polish=False)
    error = caught.value
    assert isinstance(error, mc.ContactError)
    assert isinstance(error, RuntimeError)
    assert isinstance(error.status, str)
    assert set(error.residuals) == set(mc.solve(MESH, **PAIR).residuals)
    assert all(type(residual) is float for residual in error.residuals.values())
    assert max(error.residuals.values()) > 0.1


def test_zeros_with_the_polish_are_solved_all_the_same() -> None:
    for problem in PROBLEMS.values():
        assert is_same(mc.solve(MESH, **problem, solver=zero_backend).u1, mc.solve(MESH, **problem).u1)


def projected_gradients(P: Any, q: Any, A: Any, b: Any, **_: Any) -> tuple[Any, Any]:
    """A solver of few lines: of the dual, where P is so small that it can be inverted."""
    inverse = np.linalg.inv(P.toarray())
    hessian, gradient = A @ (inverse @ A.T), A @ (inverse @ q) + b
    step, y = 1 / np.linalg.norm(hessian, 2), np.zeros(len(b))
    for _ in range(2000):
        y = np.maximum(0, y - step * (hessian @ y - gradient))
    return inverse @ (A.T @ y - q), y


@pytest.mark.parametrize("problem", PROBLEMS)
def test_a_right_answer_is_certified(problem: str) -> None:
    mesh = mc.Mesh.rectangle(4)
    solution = mc.solve(mesh, **PROBLEMS[problem], solver=projected_gradients, polish=False)
    assert np.abs(solution.u1 - mc.solve(mesh, **PROBLEMS[problem]).u1).max() < NEAR


@pytest.mark.parametrize(
    ("of_x", "of_y", "is_right"), [(1, 1, True), (1, -1, False), (1, 1.0001, False), (1.0001, 1, False), (1, 0, False)]
)
def test_an_answer_that_is_almost_right_is_rejected(of_x: float, of_y: float, is_right: bool) -> None:
    def almost(*program: Any, **_: Any) -> tuple[Any, Any]:
        x, y = projected_gradients(*program)
        return of_x * x, of_y * y

    mesh = mc.Mesh.rectangle(4)
    if is_right:
        mc.solve(mesh, **PAIR, solver=almost, polish=False)
        return
    with pytest.raises(mc.CertificationError):
        mc.solve(mesh, **PAIR, solver=almost, polish=False)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e308])
@pytest.mark.parametrize("polish", [False, True])
def test_numbers_that_are_none_are_not_believed(value: float, polish: bool) -> None:
    def backend(P: Any, q: Any, A: Any, b: Any, **_: Any) -> tuple[Any, Any]:
        return np.full(len(q), value), np.full(len(b), value)

    try:
        solution = mc.solve(MESH, **PAIR, solver=backend, polish=polish)
    except (mc.CertificationError, mc.BackendError):
        return
    assert polish
    assert is_same(solution.u1, mc.solve(MESH, **PAIR).u1)


ANSWERS: dict[str, Any] = {
    "lists": lambda q, b: ((0 * q).tolist(), (0 * b).tolist()),
    "singles": lambda q, b: (np.float32(0 * q), np.float32(0 * b)),
    "integers": lambda q, b: (np.zeros(len(q), int), np.zeros(len(b), int)),
    "read-only": lambda q, b: (np.broadcast_to(0.0, q.shape), np.broadcast_to(0.0, b.shape)),
    "reversed": lambda q, b: (0 * q[::-1], 0 * b[::-1]),
    "its own arguments": lambda q, b: (q, b),
}


@pytest.mark.parametrize("answer", ANSWERS.values(), ids=ANSWERS)
def test_answers_in_every_form(answer: Any) -> None:
    solution = mc.solve(MESH, **PAIR, solver=lambda P, q, A, b, **_: answer(q, b))
    assert is_same(solution.u1, mc.solve(MESH, **PAIR).u1)


BAD_ANSWERS: dict[str, Any] = {
    "x too short": lambda q, b: (q[1:], b),
    "y too long": lambda q, b: (q, np.append(b, 0)),
    "both empty": lambda q, b: ([], []),
    "rows": lambda q, b: (q[:, None], b),
    "numbers": lambda q, b: (1.0, 2.0),
    "complex": lambda q, b: (q + 1j, b),
    "strings": lambda q, b: (q.astype(str), b),
    "nothing found": lambda q, b: (None, None),
    "None": lambda q, b: None,
    "one array": lambda q, b: q,
    "three": lambda q, b: (q, b, b),
    "a string": lambda q, b: "xy",
    "an object": lambda q, b: object(),
}


@pytest.mark.parametrize("answer", BAD_ANSWERS.values(), ids=BAD_ANSWERS)
def test_bad_answers_are_refused_in_words(answer: Any) -> None:
    def solver_of_mine(P: Any, q: Any, A: Any, b: Any, **_: Any) -> Any:
        return answer(q, b)

    with pytest.raises((mc.BackendError, ValueError, TypeError)) as caught:
        mc.solve(MESH, **PAIR, solver=solver_of_mine)
    # Which solver, or what is wrong with x or y.
    assert any(word in str(caught.value) for word in ("solver_of_mine", "x ", "y ", "(x, y)"))


def test_a_backend_error_of_a_backend_passes_through() -> None:
    error = mc.BackendError("no licence")

    def backend(*_: Any, **__: Any) -> Any:
        raise error

    with pytest.raises(mc.BackendError) as caught:
        mc.solve(MESH, **PAIR, solver=backend)
    assert caught.value is error


def test_what_a_backend_gets() -> None:
    from scipy.sparse import csc_matrix

    seen: list[tuple[Any, ...]] = []

    def backend(P: Any, q: Any, A: Any, b: Any, *, tolerance: Any, max_iterations: Any, time_limit: Any) -> tuple[Any, Any]:
        seen.append((P, q, A, b, tolerance, max_iterations, time_limit))
        return 0 * q, 0 * b

    mc.solve(MESH, **PAIR, solver=backend, tolerance=1e-6, max_iterations=7, time_limit=60)
    mc.solve(MESH, **PAIR, solver=backend)
    (P, q, A, b, tolerance, max_iterations, time_limit), defaults = seen
    n, m = 2 * 49, 49
    for matrix, shape in (P, (n, n)), (A, (m, n)):
        assert isinstance(matrix, csc_matrix)
        assert matrix.shape == shape
        assert matrix.dtype == np.float64
        matrix.check_format()
        assert matrix.has_sorted_indices
    assert abs(P - P.T).nnz == 0
    assert np.linalg.eigvalsh(P.toarray()).min() > 0
    assert q.shape == (n,)
    assert b.shape == (m,)
    assert (tolerance, max_iterations) == (1e-6, 7)
    assert 0 < time_limit <= 60
    assert defaults[4:] == (1e-8, None, None)


@pytest.mark.parametrize("problem", PROBLEMS)
def test_the_program_of_a_backend_is_that_of_qp_in_other_units(problem: str) -> None:
    seen: list[tuple[Any, ...]] = []

    def backend(P: Any, q: Any, A: Any, b: Any, **_: Any) -> tuple[Any, Any]:
        seen.append((P, q, A, b))
        return 0 * q, 0 * b

    mc.solve(MESH, **PROBLEMS[problem], solver=backend)
    P, q, A, b = seen[0]
    program = mc.qp(MESH, **PROBLEMS[problem])

    def ratio(of: Any, to: Any) -> float:
        of, to = (np.asarray(values.toarray() if hasattr(values, "toarray") else values) for values in (of, to))
        there = np.abs(to) > 1e-12 * np.abs(to).max()
        ratios = of[there] / to[there]
        assert np.ptp(ratios) <= 1e-12 * abs(ratios[0])
        return float(ratios[0])

    # With x = length * x': the same program in other units.
    length = ratio(q, program.q) / ratio(P, program.P)
    assert ratio(A, program.A) == 1
    if program.b.any():
        assert ratio(b, program.b) == pytest.approx(length, rel=1e-12)
    else:
        assert not b.any()


def test_callables_of_every_kind() -> None:
    class Solver:
        def __call__(self, *arguments: Any, **keywords: Any) -> tuple[Any, Any]:
            return zero_backend(*arguments, **keywords)

        def method(self, *arguments: Any, **keywords: Any) -> tuple[Any, Any]:
            return zero_backend(*arguments, **keywords)

    expected = mc.solve(MESH, **PAIR).u1
    for solver in Solver(), Solver().method, partial(zero_backend), lambda *a, **k: zero_backend(*a, **k):
        solution = mc.solve(MESH, **PAIR, solver=solver)
        assert is_same(solution.u1, expected)
        assert solution.solver


def test_a_solver_without_the_keywords_is_told_so() -> None:
    with pytest.raises(TypeError, match="tolerance|max_iterations|time_limit"):
        mc.solve(MESH, **PAIR, solver=lambda P, q, A, b: (q, b))


def test_a_time_limit_holds_after_a_slow_backend() -> None:
    def slow(P: Any, q: Any, A: Any, b: Any, **_: Any) -> tuple[Any, Any]:
        time.sleep(0.3)
        return 0 * q, 0 * b

    # Whatever the polish has no time for: a solution or none, but no hang.
    try:
        solution = mc.solve(MESH, **PAIR, solver=slow, time_limit=0.1)
    except mc.ContactError:
        return
    assert is_same(solution.u1, mc.solve(MESH, **PAIR).u1)


def test_two_problems_at_once() -> None:
    meeting = threading.Barrier(2, timeout=10)

    def backend(P: Any, q: Any, A: Any, b: Any, **_: Any) -> tuple[Any, Any]:
        # Neither goes on before both are here.
        meeting.wait()
        return 0 * q, 0 * b

    found: dict[str, Any] = {}

    def solve(name: str) -> None:
        try:
            found[name] = mc.solve(MESH, **PROBLEMS[name], solver=backend)
        except BaseException as error:
            found[name] = error

    threads = [threading.Thread(target=solve, args=(name,), daemon=True) for name in ("pair", "stack")]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(20)
    for name in "pair", "stack":
        assert isinstance(found.get(name), mc.Solution), found.get(name, "it hangs")
        assert same_bits(found[name].u1, mc.solve(MESH, **PROBLEMS[name], solver=zero_backend).u1)


def test_a_backend_may_solve_another_problem() -> None:
    inner = []

    def backend(P: Any, q: Any, A: Any, b: Any, **_: Any) -> tuple[Any, Any]:
        inner.append(mc.solve(MESH, **STACK, solver=zero_backend).energy)
        return 0 * q, 0 * b

    assert is_same(mc.solve(MESH, **PAIR, solver=backend).u1, mc.solve(MESH, **PAIR).u1)
    assert inner == [mc.solve(MESH, **STACK, solver=zero_backend).energy]


def test_errors_can_be_pickled() -> None:
    import pickle

    with pytest.raises(mc.CertificationError) as caught:
        mc.solve(MESH, **PAIR, solver=zero_backend, polish=False)
    again = pickle.loads(pickle.dumps(caught.value))
    assert type(again) is mc.CertificationError
    assert again.residuals == caught.value.residuals
    assert again.status == caught.value.status
    assert str(again) == str(caught.value)


@pytest.mark.parametrize("solver", ["auto", "multigrid", "active-set", "clarabel"])
@pytest.mark.parametrize("problem", PROBLEMS)
def test_solvers_with_names(solver: str, problem: str) -> None:
    solution = mc.solve(MESH, **PROBLEMS[problem], solver=solver)
    assert solution.residual <= 1e-8
    assert np.abs(solution.u1 - mc.solve(MESH, **PROBLEMS[problem]).u1).max() < NEAR
    assert (solution.choice is not None) == (solver == "auto")


def test_too_few_iterations_are_no_solution() -> None:
    with pytest.raises(mc.CertificationError) as caught:
        mc.solve(mc.Mesh.rectangle(64), **PAIR, solver="multigrid", max_iterations=1, tolerance=1e-11)
    assert caught.value.status
    assert max(caught.value.residuals.values()) > 1e-11


def test_too_little_time_is_no_solution() -> None:
    with pytest.raises(mc.ContactError):
        mc.solve(mc.Mesh.rectangle(200), **PAIR, solver="multigrid", time_limit=1e-6, tolerance=1e-11)
