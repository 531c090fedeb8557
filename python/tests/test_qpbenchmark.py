"""The benchmark problems: their certified solutions, their files, and the test sets of qpbenchmark."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import membrane_contact as mc
from helpers import run_python

pytest.importorskip("scipy")
from membrane_contact import qpbenchmark as bench
from scipy.io import loadmat

try:
    import qpbenchmark
    import qpsolvers
except ImportError:
    qpbenchmark = None

# The least size of a test set.
N = 16

# The membranes of these have the same shape.
EVERYWHERE = ("TOUCH", "BIACTIVE")

# Of the residuals below: certified solutions have 1e-10, relative to other norms of the data.
KKT = 1e-9

# Of the objective of a solver that has been asked for residuals of 1e-9, relative: residuals are absolute, and objectives near 1.
OBJECTIVE = 1e-6

# Neither empty nor everywhere, by far: of the vertices inside.
SHARE_LEAST, SHARE_MOST = 0.1, 0.9

# An error that a benchmark must tell apart, relative to the greatest value.
PERTURBATION = 1e-6

needs_qpbenchmark = pytest.mark.skipif(qpbenchmark is None, reason="qpbenchmark is not installed")


def kkt(data: dict[str, Any], x: Any, y: Any) -> float:
    """The largest residual of ``1/2 x'Px + q'x`` subject to ``Ax >= l``, relative to the data."""
    P, q, A, low = data["P"], data["q"].ravel(), data["A"], data["l"].ravel()
    bounded = low > -bench.INFINITY
    gap = np.where(bounded, A @ x - low, 0)
    length, force = np.abs(x).max(), np.abs(q).max()
    stationarity = np.abs(P @ x + q - A.T @ y).max() / force
    primal, dual = -min(gap.min(), 0) / length, -min(y.min(), 0) / force
    # Nothing pushes at what has no bound.
    unbounded = np.abs(y[~bounded]).max(initial=0) / force
    return float(max(stationarity, primal, dual, unbounded, np.abs(gap * y).max() / (length * force)))


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, Any]]:
    """The exported problems by name."""
    paths = bench.export(tmp_path_factory.mktemp("mat") / "new", N)
    assert [path.name for path in paths] == [f"{name}-{N}.mat" for name in bench.CASES]
    return {name: loadmat(path) for name, path in zip(bench.CASES, paths)}


def test_there_are_a_dozen_problems() -> None:
    assert len({name.upper() for name in bench.CASES}) == len(bench.CASES) >= 12
    assert len({case.about for case in bench.CASES.values()}) == len(bench.CASES)
    # Names of files everywhere, and of problems in fixed columns.
    assert all(re.fullmatch("[A-Z]+", name) for name in bench.CASES)


@pytest.mark.parametrize("name", bench.CASES)
def test_a_part_is_in_contact_where_that_is_meant(name: str) -> None:
    solution = mc.solve(**bench.CASES[name].arguments(N), bound=False)
    for gap in solution.gaps:
        # Not of the boundary, where heights say it.
        inside = np.asarray(solution.mesh.kind) == 0
        share = gap.contact[inside].mean()
        assert share == 1 if name in EVERYWHERE else SHARE_LEAST < share < SHARE_MOST


def test_biactive_rows_have_no_force() -> None:
    # Of 15 columns of 15 vertices inside, the load reaches 7 and, by the triangles to its left, that in the middle.
    for name, pressed in ("TOUCH", 0), ("BIACTIVE", 8 * 15):
        program = mc.qp(**bench.CASES[name].arguments(N))
        x, y, _ = bench.certified(name, N)
        assert np.abs(program.A @ x - program.b).max() <= KKT * np.abs(x).max()
        assert (y > KKT * np.abs(program.q).max()).sum() == pressed


@pytest.mark.parametrize("name", bench.CASES)
def test_the_solution_in_the_file_solves_the_problem_in_the_file(name: str, files: dict[str, dict[str, Any]]) -> None:
    data = files[name]
    x, y = data["x"].ravel(), data["y"].ravel()
    assert kkt(data, x, y) <= KKT
    assert np.all(data["u"] == bench.INFINITY)
    objective = x @ (data["P"] @ x) / 2 + data["q"].ravel() @ x
    assert objective == pytest.approx(data["objective"].item(), rel=1e-12)
    # The objective with its constant is the energy.
    energy = mc.solve(**bench.CASES[name].arguments(N), bound=False).energy
    assert objective + data["r"].item() == pytest.approx(energy, rel=1e-8)


@pytest.mark.parametrize("name", bench.CASES)
def test_a_perturbed_solution_is_told_apart(name: str, files: dict[str, dict[str, Any]]) -> None:
    data = files[name]
    x, y = data["x"].ravel(), data["y"].ravel()
    for wrong in np.argmax(np.abs(x)), len(x) // 2:
        moved = x.copy()
        moved[wrong] += PERTURBATION * np.abs(x).max()
        assert kkt(data, moved, y) > KKT
    # TOUCH has no force: one is made.
    pushed = y.copy()
    pushed[np.argmax(y)] += PERTURBATION * np.abs(data["q"]).max()
    assert kkt(data, x, pushed) > KKT
    assert kkt(data, x, -pushed) > KKT


def test_a_file_is_read_back_to_the_last_bit(files: dict[str, dict[str, Any]]) -> None:
    for name, program, arguments in bench.problems(N):
        data = files[name]
        assert mc.qp(**arguments).constant == program.constant == data["r"].item()
        variables, rows = data["n"].item(), data["m"].item()
        assert data["P"].shape == (variables, variables)
        assert data["A"].shape == (rows, variables)
        # As readers of the Maros-Meszaros files take them: the last rows are the bounds of the variables.
        bounds, low = data["A"].tocsr()[-variables:], data["l"].ravel()
        assert (bounds != np.eye(variables)).sum() == 0
        assert np.all(low[-variables:] == -bench.INFINITY)
        assert (data["A"].tocsr()[:-variables] != program.A).nnz == 0
        assert np.array_equal(low[:-variables], program.b)
        assert (data["P"] != program.P).nnz == 0
        assert np.array_equal(data["q"].ravel(), program.q)
        x, y, objective = bench.certified(name, N)
        assert np.array_equal(data["x"].ravel(), x)
        assert np.array_equal(data["y"].ravel()[:-variables], y)
        assert data["objective"].item() == objective


@pytest.mark.parametrize("name", bench.CASES)
def test_a_larger_problem_is_solved_too(name: str) -> None:
    program = mc.qp(**bench.CASES[name].arguments(bench.SIZES["MembranesMedium"]))
    x, y, _ = bench.certified(name, bench.SIZES["MembranesMedium"])
    assert kkt({"P": program.P, "q": program.q, "A": program.A, "l": program.b}, x, y) <= KKT


def test_unknown_names_are_errors() -> None:
    with pytest.raises(KeyError, match="PEAR"):
        bench.certified("PEAR", N)
    with pytest.raises(AttributeError, match="MembranesHuge"):
        getattr(bench, "MembranesHuge")


def test_the_problems_need_no_qpbenchmark() -> None:
    script = """
import sys
sys.modules["qpbenchmark"] = None
from membrane_contact import qpbenchmark
print(len(list(qpbenchmark.problems(4))))
from membrane_contact.qpbenchmark import MembranesSmall
"""
    ended = run_python(script)
    assert ended.code == 1, ended
    assert ended.output.split() == [str(len(bench.CASES))]
    assert "ImportError: MembranesSmall needs qpbenchmark: pip install qpbenchmark" in ended.errors


@needs_qpbenchmark
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("solver", ["clarabel", "piqp"])
def test_a_solver_agrees_through_the_test_set(solver: str) -> None:
    if solver not in qpsolvers.available_solvers:
        pytest.skip(f"{solver} is not installed")
    settings = {"clarabel": {"tol_gap_abs": 1e-9, "tol_gap_rel": 1e-9, "tol_feas": 1e-9}, "piqp": {"eps_abs": 1e-9}}
    for problem in bench.MembranesSmall():
        answer = qpsolvers.solve_problem(problem, solver=solver, **settings[solver])
        expected = bench.certified(problem.name.removesuffix(f"-{N}"), N).objective
        assert answer.found, problem.name
        objective = answer.x @ (problem.P @ answer.x) / 2 + problem.q @ answer.x
        assert objective == pytest.approx(expected, rel=OBJECTIVE), problem.name


@needs_qpbenchmark
def test_certified_solutions_pass_the_checks_of_qpbenchmark() -> None:
    test_set = bench.MembranesSmall()
    tolerance = test_set.tolerances["high_accuracy"]
    for problem in test_set:
        x, y, objective = bench.certified(problem.name.removesuffix(f"-{N}"), N)
        answer = qpsolvers.Solution(problem, found=True, x=x, z=y, y=np.empty(0), z_box=np.empty(0), obj=objective)
        assert answer.primal_residual() < tolerance.primal
        assert answer.dual_residual() < tolerance.dual
        assert answer.duality_gap() < tolerance.gap
        answer.x = 1.001 * x
        assert answer.dual_residual() > tolerance.dual


@needs_qpbenchmark
def test_qpbenchmark_finds_the_test_sets(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from qpbenchmark.benchmark import load_test_set

    monkeypatch.setattr(sys, "path", list(sys.path))
    for name, n in bench.SIZES.items():
        path = tmp_path / (re.sub("(?<!^)([A-Z])", r"_\1", name).lower() + ".py")
        path.write_text(f"from membrane_contact.qpbenchmark import {name}\n", encoding="utf-8")
        test_set = load_test_set(str(path))
        assert isinstance(test_set, qpbenchmark.TestSet)
        assert type(test_set) is getattr(bench, name)
        assert str(n) in test_set.title
        assert test_set.description
        assert test_set.sparse_only
        assert next(iter(test_set)).name == f"PAIR-{n}"
        monkeypatch.delitem(sys.modules, path.stem)
    small = bench.MembranesSmall()
    assert [problem.name for problem in small] == [f"{case}-{N}" for case in bench.CASES]
    assert small.count_problems() == len(bench.CASES)
