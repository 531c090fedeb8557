"""What PETSc's solver of variational inequalities, SNESVI, makes of the same problem: a row for each size.

    apt-get install python3-petsc4py python3-scipy
    export PYTHONPATH=$(echo /usr/lib/petscdir/*/*-real/lib/python3/dist-packages)
    /usr/bin/python3 benches/peers/petsc_snesvi.py --membranes target/release/membranes --out rows.csv

Form. PETSc gets the decoupled problem, which suits it best (M = mu1 + mu2, m = mu1 mu2 / M):

    K s = F1 + F2                                s = mu1 u1 + mu2 u2, one linear Poisson problem
    m K w - y = (mu2 F1 - mu1 F2) / M            w = u1 - u2 >= 0, y >= 0, w'y = 0: bounds only

On the right triangles of the square, K is the five-point stencil, so that PETSc's own structured grids (DMDA) do all.
On the finest grid the loads are those of the exported program, so that `membranes check --answer` judges the answer;
above `--judge-up-to` cells, and on the coarser grids, which only make the start, they are f(a) h^2.

Options. `vinewtonrsls` is the semismooth Newton method that solves on the inactive vertices only. Each grid starts from
the solution on the coarser one (grid sequencing), without which the steps double with n. Each linear problem is solved
by conjugate gradients with a geometric V-cycle whose coarse matrices are Galerkin products of the restricted matrix,
with one symmetric Gauss-Seidel sweep before and after, which needs no estimate of eigenvalues. The line search takes
the full step, and a linear solve gains three digits: a step has so much set-up that sharper steps pay. Boundary
vertices are held by equal bounds, so that they leave the linear problems as active vertices do. The coarser grids are
solved to 1e-4 only. The finest grid stops at each of `--tolerances`: Euclidean norms of the residuals relative to that
of the load. The certificate takes the greatest residual of all vertices, so 1e-9 here need not pass its 1e-8.

Set-up is grids, coarse matrices and interpolations of the Poisson problem; SNESVI does all of its own within the solve.
K on the finest grid is given. The iterations are Newton steps on the finest grid. Each size runs in a process of its
own, on one thread, and a work unit is what it is in peers.py.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp

import family
import peers
from family import HEIGHT, TENSION, Measurement, Verdict

try:
    import petsc4py

    petsc4py.init(["petsc"])
    from petsc4py import PETSc
except ImportError:
    sys.exit("petsc4py is missing: see the head of this file for how to install it, and for its PYTHONPATH")

# The residual, relative to the load in the Euclidean norm, on the grids that only make a start.
COARSER = 1e-4

# The coarsest grid has at most so many cells along a side: it is solved directly.
COARSEST = 8

# What a Newton method that has not converged would be cut off at.
MOST_STEPS = 100

SMOOTHER = {
    "pc_type": "mg",
    "mg_levels_ksp_type": "richardson",
    "mg_levels_ksp_max_it": 1,
    "mg_levels_ksp_norm_type": "none",
    "mg_levels_pc_type": "sor",
    "mg_coarse_ksp_type": "preonly",
    "mg_coarse_pc_type": "lu",
}
OPTIONS: dict[str, Any] = {
    **{f"sum_{name}": value for name, value in SMOOTHER.items()},
    "sum_ksp_type": "cg",
    "sum_ksp_norm_type": "unpreconditioned",
    **{f"gap_{name}": value for name, value in SMOOTHER.items()},
    "gap_snes_type": "vinewtonrsls",
    "gap_snes_linesearch_type": "basic",
    "gap_snes_vi_zero_tolerance": 1e-12,
    "gap_ksp_type": "cg",
    "gap_ksp_rtol": 1e-3,
    "gap_pc_mg_galerkin": "both",
}

MU1, MU2 = TENSION
M, REDUCED = MU1 + MU2, MU1 * MU2 / (MU1 + MU2)


@dataclass(frozen=True)
class Discrete:
    """The problem on one grid, on all (n+1)^2 vertices.

    `matrix`: K with the boundary values eliminated, 4 on the diagonal there. `inside`: 1 and 0. `boundary`: K_IB g on
    the interior vertices, else 0. `loads`: F1 and F2, 0 on the boundary.
    """

    cells: int
    matrix: sp.csr_matrix
    inside: np.ndarray
    boundary: np.ndarray
    loads: tuple[np.ndarray, np.ndarray]

    @property
    def interior(self) -> sp.csr_matrix:
        """K on the interior vertices."""
        keep = self.inside.nonzero()[0]
        return sp.csr_matrix(self.matrix[keep][:, keep])


def discretise(cells: int) -> Discrete:
    """The problem with nodal loads f(a) h^2."""
    side = np.arange(cells + 1) / cells
    x, y = (values.ravel() for values in np.meshgrid(side, side))
    line = np.ones(cells + 1)
    line[[0, -1]] = 0.0
    inside = np.outer(line, line).ravel()
    second = sp.diags([-1.0, 2.0, -1.0], [-1, 0, 1], (cells + 1, cells + 1))
    stencil = sp.csr_matrix(sp.kronsum(second, second))
    only = sp.diags(inside)
    matrix = sp.csr_matrix(only @ stencil @ only + sp.diags(4.0 * (1.0 - inside)))
    matrix.eliminate_zeros()
    matrix.sort_indices()
    boundary = inside * (stencil @ (HEIGHT * (1.0 - inside)))
    second_load = family.GREATEST_LOAD * np.sin(4 * np.pi * x) * np.sin(3 * np.pi * y)
    return Discrete(
        cells, matrix, inside, boundary, (-10.0 * inside / cells**2, inside * second_load / cells**2)
    )


def with_exported_loads(problem: Discrete, exported: family.Exported) -> Discrete:
    """The problem with the loads of the exported program: q = (mu1 K g - F1, -F2)."""
    keep = problem.inside.nonzero()[0]
    difference = exported.stiffness - problem.interior
    assert abs(difference).max() < 1e-12, "the vertices or the triangles are others than here"
    first, second = np.zeros_like(problem.inside), np.zeros_like(problem.inside)
    first[keep], second[keep] = np.split(-exported.q, 2)
    first += MU1 * problem.boundary
    return Discrete(problem.cells, problem.matrix, problem.inside, problem.boundary, (first, second))


def aij(matrix: sp.csr_matrix) -> PETSc.Mat:
    return PETSc.Mat().createAIJ(matrix.shape, csr=(matrix.indptr, matrix.indices, matrix.data))


def vector(values: np.ndarray) -> PETSc.Vec:
    return PETSc.Vec().createWithArray(values.copy())


class Sequence:
    """All grids, coarsest first, and the two problems on them."""

    def __init__(self, finest: Discrete) -> None:
        halvings = 0
        while finest.cells >> halvings > COARSEST and (finest.cells >> halvings) % 2 == 0:
            halvings += 1
        coarsest = finest.cells >> halvings
        self.problems = [discretise(coarsest << level) for level in range(halvings)] + [finest]
        grid = PETSc.DMDA().create(
            [coarsest + 1] * 2, dof=1, stencil_width=1, stencil_type=PETSc.DMDA.StencilType.STAR
        )
        self.grids = [grid]
        for _ in range(halvings):
            self.grids.append(self.grids[-1].refine())
        self.matrices = [aij(problem.matrix) for problem in self.problems]
        # Up to the grid of the same number. They carry boundary values too; `inner` none.
        self.interpolations = [None] + [
            coarse.createInterpolation(fine)[0] for coarse, fine in zip(self.grids, self.grids[1:])
        ]
        self.inner: list[PETSc.Mat | None] = [None]
        for level in range(1, halvings + 1):
            inner = self.interpolations[level].copy()
            inner.diagonalScale(vector(self.problems[level].inside), vector(self.problems[level - 1].inside))
            self.inner.append(inner)

    def solve(self, finest: float) -> tuple[np.ndarray, np.ndarray, np.ndarray, int, bool]:
        """s, w and y on the finest grid, Newton steps there, and whether both problems met their tolerance."""
        total, gap = None, None
        for level, problem in enumerate(self.problems):
            if level == 0:
                total = vector(np.full_like(problem.inside, MU1 * HEIGHT))
                gap = vector(np.full_like(problem.inside, HEIGHT))
            else:
                total, gap = self.interpolations[level] * total, self.interpolations[level] * gap
            tolerance = finest if level == len(self.problems) - 1 else COARSER
            met = self.solve_sum(level, total, tolerance)
            action, steps, met_too = self.solve_gap(level, gap, tolerance)
        return total.array, gap.array, action, steps, met and met_too

    def solve_sum(self, level: int, total: PETSc.Vec, tolerance: float) -> bool:
        problem = self.problems[level]
        load = problem.loads[0] + problem.loads[1]
        right = load - MU1 * problem.boundary + 4.0 * (1.0 - problem.inside) * MU1 * HEIGHT
        ksp = PETSc.KSP().create()
        ksp.setOptionsPrefix("sum_")
        ksp.setOperators(self.matrices[level])
        ksp.setInitialGuessNonzero(True)
        ksp.setTolerances(rtol=0.0, atol=tolerance * float(np.linalg.norm(load)))
        pc = ksp.getPC()
        if level == 0:
            ksp.setFromOptions()
            pc.setType("lu")
        else:
            pc.setType("mg")
            pc.setMGLevels(level + 1)
            for below in range(level + 1):
                pc.getMGSmoother(below).setOperators(self.matrices[below])
                if below > 0:
                    pc.setMGInterpolation(below, self.inner[below])
            ksp.setFromOptions()
        ksp.solve(vector(right), total)
        return ksp.getConvergedReason() > 0

    def solve_gap(self, level: int, gap: PETSc.Vec, tolerance: float) -> tuple[np.ndarray, int, bool]:
        problem = self.problems[level]
        matrix = self.matrices[level].copy()
        matrix.scale(REDUCED)
        load = (MU2 * problem.loads[0] - MU1 * problem.loads[1]) / M
        # A residual of 1 where both bounds are the height: such a vertex is always active.
        fixed = 1.0 - problem.inside
        right = vector(load - REDUCED * problem.boundary + fixed * (4.0 * REDUCED * HEIGHT - 1.0))

        def residual(_: PETSc.SNES, at: PETSc.Vec, value: PETSc.Vec) -> None:
            matrix.mult(at, value)
            value.axpy(-1.0, right)

        def jacobian(*_: Any) -> None:
            """The matrix stays."""

        snes = PETSc.SNES().create()
        snes.setOptionsPrefix("gap_")
        snes.setDM(self.grids[level])
        value = right.duplicate()
        snes.setFunction(residual, value)
        snes.setJacobian(jacobian, matrix)
        lower, upper = HEIGHT * fixed, np.where(problem.inside > 0.0, PETSc.INFINITY, HEIGHT)
        snes.setVariableBounds(vector(lower), vector(upper))
        least = tolerance * float(np.linalg.norm(load))
        snes.setTolerances(rtol=0.0, atol=least, stol=0.0, max_it=MOST_STEPS)
        snes.setFromOptions()
        if level == 0:
            snes.getKSP().getPC().setType("lu")
        snes.solve(None, gap)
        matrix.mult(gap, value)
        value.axpy(-1.0, right)
        touching = (problem.inside > 0.0) & (gap.array <= 0.0)
        action = np.where(touching, np.maximum(value.array, 0.0), 0.0)
        return action, snes.getIterationNumber(), snes.getConvergedReason() > 0


def work(cells: int, tolerance: float, exported: Path | None, answer: Path, result: Path) -> None:
    """One size, in a process of its own; nodal loads where there is no exported program."""
    options = PETSc.Options()
    for name, value in OPTIONS.items():
        options[name] = value
    finest = discretise(cells)
    if exported is not None:
        finest = with_exported_loads(finest, family.read(exported))
    stiffness = finest.interior
    unit = family.work_unit(stiffness)
    start = time.perf_counter()
    sequence = Sequence(finest)
    ready = time.perf_counter()
    total, gap, action, steps, met = sequence.solve(tolerance)
    first, second = (total + MU2 * gap) / M, (total - MU1 * gap) / M
    end = time.perf_counter()
    unit = min(unit, family.work_unit(stiffness))
    keep = finest.inside.nonzero()[0]
    np.savez(answer, x=np.concatenate([first[keep], second[keep]]), y=action[keep])
    measurement = Measurement("solved" if met else "stopped", steps, ready - start, end - ready, unit)
    result.write_text(json.dumps(asdict(measurement)), encoding="utf-8")


def main() -> None:
    if sys.argv[1:2] == ["--work"]:
        cells, tolerance, exported, answer, result = sys.argv[2:]
        work(int(cells), float(tolerance), Path(exported) if exported else None, Path(answer), Path(result))
        return
    options = arguments()
    table = family.Table(options.out, keep=True)
    with tempfile.TemporaryDirectory() as temporary:
        for cells in sorted(options.sizes):
            folder = Path(temporary, str(cells))
            folder.mkdir()
            judged = cells <= options.judge_up_to
            exported = family.export(options.membranes, cells, folder) if judged else None
            for tolerance in options.tolerances:
                run, verdict = measure(options, folder, cells, tolerance, exported)
                table.add(family.row(cells, f"snesvi ({tolerance})", "petsc", 1, run, verdict))


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--membranes", type=peers.program, required=True, help="the program, built with --release")
    parser.add_argument("--sizes", type=size, nargs="+", default=[64, 128, 256], help="cells along a side")
    parser.add_argument("--tolerances", nargs="+", default=["1e-9", "1e-10"], help="relative residuals to stop at")
    parser.add_argument("--judge-up-to", type=int, default=512, help="cells up to which the answer is judged")
    parser.add_argument("--time-limit", type=float, default=300.0, help="seconds for a run")
    parser.add_argument("--out", type=Path, required=True, help="the CSV file; rows are appended")
    return parser.parse_args()


def size(text: str) -> int:
    """A number of cells that halves down to a grid that is small enough to be solved directly."""
    cells = coarsest = int(text)
    while coarsest > COARSEST and coarsest % 2 == 0:
        coarsest //= 2
    if not 4 <= coarsest <= COARSEST:
        raise argparse.ArgumentTypeError(f"{cells} does not halve down to 4 ... {COARSEST}: take a power of 2")
    return cells


def measure(
    options: argparse.Namespace, folder: Path, cells: int, tolerance: str, exported: Path | None
) -> tuple[Measurement, Verdict]:
    """Runs one size, and has its answer judged where it solves the exported program."""
    answer, result = folder / "answer.npz", folder / "result.json"
    worker = [sys.executable, Path(__file__).resolve(), "--work", str(cells), tolerance, exported or "", answer, result]
    outcome = peers.run_within(worker, options.time_limit, 1)
    if outcome is not None:
        return Measurement(outcome), Verdict()
    run = Measurement(**json.loads(result.read_text(encoding="utf-8")))
    if exported is None:
        return run, Verdict()
    return run, family.judge(options.membranes, folder / "case.toml", answer, folder / "verdict")


if __name__ == "__main__":
    main()
