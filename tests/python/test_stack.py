"""The QP of a stack of membranes against a second assembly, and its solution against that of qpsolvers.

Three membranes over a floor: one whose tension is affine, one on an elastic foundation, one that is free on the
right, where a line load pulls it.
"""

from __future__ import annotations

import json
import subprocess
from dataclasses import dataclass
from pathlib import Path

import meshio
import numpy as np
import pytest
import scipy.sparse as sp

import assembly
from kkt import kkt_residuals
from problem import Indices, QuadraticProgram, Vector, read_program
from program import Program
from test_qpsolvers import ENERGY_TOLERANCE, KKT_TOLERANCE, PRIMAL_TOLERANCE, SOLVERS, solve

# At 1e-13, Clarabel calls this problem almost solved.
SETTINGS = SOLVERS | {"clarabel": {"tol_gap_abs": 1e-11, "tol_gap_rel": 1e-11, "tol_feas": 1e-11}}

pytestmark = pytest.mark.filterwarnings("ignore:The default value of raise_error:PendingDeprecationWarning")

# Sums of a few dozen terms, each with a few roundings.
ROUNDING = 1e-13

HEIGHTS = (0.04, 0.02, 0.0)
FOUNDATION = 5.0
TRACTION = -1.5

CASE = f"""
domain = {{ shape = "square" }}
mesh = {{ cells = 12 }}
[obstacle]
floor = "-0.1 + 0.05*x"
[[membrane]]
tension = "1 + x"
load = "-20*x*y"
height = {HEIGHTS[0]}
[[membrane]]
tension = 2
load = -30
foundation = {FOUNDATION}
height = {HEIGHTS[1]}
[[membrane]]
tension = 3
load = "-4 - 8*y"
height = {{ right = "free" }}
traction = {{ right = {TRACTION} }}
"""


def tension(points: Vector) -> tuple[Vector, float, float]:
    """mu_1 at points, shape (points,); mu_2 and mu_3."""
    return 1.0 + points[:, 0], 2.0, 3.0


def floor(points: Vector) -> Vector:
    """psi at points, shape (points,)."""
    return -0.1 + 0.05 * points[:, 0]


@dataclass(frozen=True)
class Stack:
    """The QP with its mesh.

    Shapes, for N variables and m rows: `variable_membrane`, `variable_vertex` (N,), counted from 1 and from 0; `row_gap`,
    `row_vertex`, `row_dual_area` (m,).
    """

    directory: Path
    qp: QuadraticProgram
    points: Vector
    triangles: Indices
    variable_membrane: Indices
    variable_vertex: Indices
    row_gap: Indices
    row_vertex: Indices
    row_dual_area: Vector


@pytest.fixture(scope="module")
def stack(program: Program, tmp_path_factory: pytest.TempPathFactory) -> Stack:
    directory = tmp_path_factory.mktemp("stack")
    (directory / "case.toml").write_text(CASE, encoding="utf-8")
    for command in (["solve", "--out", "solution"], ["export", "--format", "npz", "--out", "qp"]):
        run(program, directory, command[0], "case.toml", *command[1:])
    with np.load(directory / "qp" / "problem.npz") as arrays:
        names = list(Stack.__dataclass_fields__)[2:]
        return Stack(directory, read_program(arrays), *(arrays[name] for name in names))


def run(program: Program, directory: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = [str(program.executable), *arguments]
    found = subprocess.run(command, cwd=directory, capture_output=True, text=True, timeout=120)
    assert found.returncode == 0, found.stderr
    return found


def free_vertices(stack: Stack, membrane: int) -> Indices:
    """The vertices at which a membrane is not fixed: those inside, and for the third also those on the right."""
    boundary = assembly.boundary_vertices(stack.triangles)
    inside = np.setdiff1d(np.arange(len(stack.points)), boundary)
    x, y = stack.points[boundary].T
    on_the_right = boundary[(x == 1.0) & (y > 0.0) & (y < 1.0)]
    return np.union1d(inside, on_the_right) if membrane == 3 else inside


def matrix(stack: Stack, membrane: int) -> sp.csc_matrix:
    """K_i with the lumped foundation."""
    barycentres = stack.points[stack.triangles].mean(axis=1)
    of_membrane = tension(barycentres)[membrane - 1]
    k = assembly.stiffness(stack.points, stack.triangles, of_membrane)
    if membrane == 2:
        k = k + FOUNDATION * sp.diags_array(assembly.dual_areas(stack.points, stack.triangles))
    return sp.csc_matrix(k)


def force(stack: Stack, membrane: int, traction: float = TRACTION) -> Vector:
    """F_i, the line load on the right side included: half of it at each end of an edge."""
    loads = (lambda x, y: -20.0 * x * y, lambda x, y: -30.0, lambda x, y: -4.0 - 8.0 * y)
    result = assembly.load_vector(stack.points, stack.triangles, loads[membrane - 1])
    if membrane == 3:
        right = np.flatnonzero(stack.points[:, 0] == 1.0)
        right = right[np.argsort(stack.points[right, 1])]
        half = 0.5 * traction * np.diff(stack.points[right, 1])
        np.add.at(result, right[:-1], half)
        np.add.at(result, right[1:], half)
    return result


def linear_term(stack: Stack, traction: float = TRACTION) -> Vector:
    """q_i = K_i,IB g_i - F_i."""
    parts = []
    for membrane in (1, 2, 3):
        free = free_vertices(stack, membrane)
        lift = np.full(len(stack.points), HEIGHTS[membrane - 1])
        lift[free] = 0.0
        parts.append((matrix(stack, membrane) @ lift - force(stack, membrane, traction))[free])
    return np.concatenate(parts)


def test_the_program_is_that_of_a_second_assembly(stack: Stack) -> None:
    free = {membrane: free_vertices(stack, membrane) for membrane in (1, 2, 3)}
    numbers = np.concatenate([np.full(len(free[membrane]), membrane) for membrane in free])
    assert np.array_equal(stack.variable_membrane, numbers)
    assert np.array_equal(stack.variable_vertex, np.concatenate(list(free.values())))

    blocks = [matrix(stack, membrane)[free[membrane]][:, free[membrane]] for membrane in free]
    p = sp.block_diag(blocks)
    assert abs(stack.qp.P - p).max() <= ROUNDING * abs(p).max()
    q = linear_term(stack)
    assert np.max(np.abs(stack.qp.q - q)) <= ROUNDING * np.max(np.abs(q))
    # The negative test: without the line load, the linear term is another one.
    assert np.max(np.abs(stack.qp.q - linear_term(stack, 0.0))) > 1e-3


def test_the_rows_are_the_gaps_where_a_side_is_free(stack: Stack) -> None:
    number = {
        (membrane, vertex): k
        for k, (membrane, vertex) in enumerate(zip(stack.variable_membrane, stack.variable_vertex, strict=True))
    }
    below = floor(stack.points)
    expected = []
    for gap in (1, 2, 3):
        for vertex in range(len(stack.points)):
            upper, lower = number.get((gap, vertex)), number.get((gap + 1, vertex))
            known = HEIGHTS[gap] if gap < 3 else below[vertex]
            if upper is not None and lower is not None:
                expected.append((gap, vertex, {upper: 1.0, lower: -1.0}, 0.0))
            elif upper is not None:
                expected.append((gap, vertex, {upper: 1.0}, known))
            elif lower is not None:
                expected.append((gap, vertex, {lower: -1.0}, -HEIGHTS[gap - 1]))
    rows = sp.csr_array(stack.qp.A)
    assert len(expected) == rows.shape[0]
    for k, (gap, vertex, entries, bound) in enumerate(expected):
        assert (stack.row_gap[k], stack.row_vertex[k]) == (gap, vertex)
        start, end = rows.indptr[k], rows.indptr[k + 1]
        assert dict(zip(rows.indices[start:end], rows.data[start:end], strict=True)) == entries
        assert abs(stack.qp.b[k] - bound) <= ROUNDING
    areas = assembly.dual_areas(stack.points, stack.triangles)[stack.row_vertex]
    assert np.allclose(stack.row_dual_area, areas, rtol=ROUNDING, atol=0.0)


@pytest.mark.parametrize("solver", SOLVERS)
def test_solvers_agree_with_the_program(program: Program, stack: Stack, solver: str) -> None:
    x, y = solve(stack.qp, solver, **SETTINGS[solver])
    assert kkt_residuals(stack.qp, x, y).satisfied(KKT_TOLERANCE)
    mesh = meshio.read(stack.directory / "solution" / "solution.vtu")
    own = np.concatenate([mesh.point_data[f"u{i}"][free_vertices(stack, i)] for i in (1, 2, 3)])
    assert np.max(np.abs(x - own)) <= PRIMAL_TOLERANCE * np.ptp(own)
    summary = json.loads((stack.directory / "solution" / "summary.json").read_text(encoding="utf-8"))
    assert abs(stack.qp.energy(x) - summary["energy"]) <= ENERGY_TOLERANCE * abs(summary["energy"])
    # The nodal forces are the multipliers; something touches in every gap.
    for contact in summary["contacts"]:
        total = y[stack.row_gap == contact["gap"]].sum()
        assert contact["contact_vertices"] > 0
        assert abs(total - contact["total_force"]) <= 1e-5 * abs(total)


def test_the_program_certifies_an_answer_and_sees_a_wrong_one(program: Program, stack: Stack) -> None:
    x, y = solve(stack.qp, "clarabel", **SETTINGS["clarabel"])
    np.savez(stack.directory / "answer.npz", x=x, y=y)
    checked = run(program, stack.directory, "check", "case.toml", "--answer", "answer.npz")
    assert "yes" in checked.stdout
    np.savez(stack.directory / "wrong.npz", x=x, y=-y)
    command = [str(program.executable), "check", "case.toml", "--answer", "wrong.npz"]
    wrong = subprocess.run(command, cwd=stack.directory, capture_output=True, text=True, timeout=120)
    assert wrong.returncode == 1 and "other sign" in wrong.stderr, wrong.stderr
