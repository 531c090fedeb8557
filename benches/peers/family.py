"""The family of problems, the work unit, the judge and the table: what every comparison shares.

The problem `square`: unit square in n x n cells of two right triangles, mu = (1, 1), f1 = -10,
f2 = 30 sin(4 pi x) sin(3 pi y), g = 0.05. `membranes export` makes the quadratic program of it, and
`membranes check --answer` judges every answer, whoever found it. It runs with numpy 1.24 and scipy 1.10, too.
"""

from __future__ import annotations

import csv
import json
import subprocess
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np
import scipy.sparse as sp

TENSION = (1.0, 1.0)
HEIGHT = 0.05
GREATEST_LOAD = 30.0

# The residual that is certified, relative to the data: the default of the program.
TOLERANCE = 1e-8

# Seconds and repetitions over which the least time of a product is taken: the noise of a busy machine only
# ever adds.
WORK_UNIT_SECONDS, WORK_UNIT_LEAST_REPEATS = 0.2, 7

CASE = """\
title = "square, {cells} x {cells} cells"

[membranes]
tension = [1.0, 1.0]
load = [-10.0, "30*sin(4*pi*x)*sin(3*pi*y)"]
height = 0.05

[domain]
shape = "square"

[mesh]
cells = {cells}
"""


@dataclass(frozen=True)
class Exported:
    """The exported QP, minimise 1/2 x'Px + q'x subject to A x >= b, in numbers of its own size.

    Shapes: `P` (2m, 2m), full; `q` (2m,); `A` (m, 2m); `b` (m,), for m = (n-1)^2 interior vertices. The scales are the
    sizes of x and of P x + q.
    """

    P: sp.csc_matrix
    q: np.ndarray
    A: sp.csc_matrix
    b: np.ndarray
    displacement_scale: float
    force_scale: float

    @property
    def stiffness(self) -> sp.csr_matrix:
        """`K` on the interior vertices, shape (m, m), float64 with int32 indices."""
        count = self.b.size
        return sp.csr_matrix(self.P[:count, :count] / TENSION[0])


def export(membranes: Path, cells: int, folder: Path) -> Path:
    """Writes the case file `case.toml` and its QP `problem.npz` into `folder`, and returns the latter's path."""
    folder.mkdir(parents=True, exist_ok=True)
    case = folder / "case.toml"
    case.write_text(CASE.format(cells=cells), encoding="utf-8")
    command = [membranes, "export", case, "--format", "npz", "--out", folder, "--quiet"]
    subprocess.run(command, check=True)
    return folder / "problem.npz"


def read(path: Path) -> Exported:
    """The QP in an exported file."""
    with np.load(path) as arrays:

        def matrix(name: str) -> sp.csc_matrix:
            indices, start = (arrays[f"{name}_{part}"].astype(np.int32) for part in ("indices", "indptr"))
            return sp.csc_matrix((arrays[f"{name}_data"], indices, start), tuple(arrays[f"{name}_shape"]))

        scales = (float(arrays[name]) for name in ("displacement_scale", "force_scale"))
        return Exported(matrix("P"), arrays["q"], matrix("A"), arrays["b"], *scales)


def work_unit(stiffness: sp.csr_matrix) -> float:
    """Seconds of one product with `K` on the interior vertices by scipy: the least of several."""
    assert stiffness.indices.dtype == np.int32
    vector = np.linspace(-1.0, 1.0, stiffness.shape[1])
    spent: list[float] = []
    while len(spent) < WORK_UNIT_LEAST_REPEATS or sum(spent) < WORK_UNIT_SECONDS:
        start = time.perf_counter()
        stiffness @ vector
        spent.append(time.perf_counter() - start)
    return min(spent)


@dataclass(frozen=True)
class Measurement:
    """What one run says of itself; None where it does not say."""

    status: str
    iterations: int | None = None
    setup_seconds: float | None = None
    solve_seconds: float | None = None
    work_unit_seconds: float | None = None


@dataclass(frozen=True)
class Verdict:
    """What the certificate says of an answer; None where there is none to look at."""

    certified: bool | None = None
    residual: float | None = None
    contact_vertices: int | None = None


def judge(membranes: Path, case: Path, answer: Path, folder: Path) -> Verdict:
    """Has the arrays x and y in `answer` certified at TOLERANCE; the summary goes into `folder`.

    The residual is the largest of those that make the certificate, as it is: the certificate itself also allows
    each vertex the rounding of the terms that cancel there. An answer that is not finite is not certified.
    """
    command = [membranes, "check", case, "--answer", answer, "--tolerance", str(TOLERANCE)]
    run = subprocess.run([*command, "--out", folder, "--quiet"], capture_output=True, text=True)
    if run.returncode == 2 and "must be finite" in run.stderr:
        return Verdict(certified=False)
    if run.returncode not in (0, 1):
        raise RuntimeError(f"the answer {answer} cannot be judged: {run.stderr.strip()}")
    summary = json.loads((folder / "summary.json").read_text(encoding="utf-8"))
    residuals = {name: value for name, value in summary["residuals"].items() if name != "overlap"}
    # JSON has no infinity: null.
    residual = None if None in residuals.values() else max(residuals.values())
    return Verdict(summary["certified"], residual, summary["contact_vertices"])


@dataclass(frozen=True)
class Row:
    """A row of the table; None is an empty cell."""

    problem: str
    n: int
    vertices: int
    solver: str
    origin: str
    threads: int
    status: str
    certified: bool | None
    residual: float | None
    iterations: int | None
    setup_seconds: float | None
    solve_seconds: float | None
    certify_seconds: float | None
    total_seconds: float | None
    work_unit_seconds: float | None
    work_units: float | None
    contact_vertices: int | None


def row(cells: int, solver: str, origin: str, threads: int, run: Measurement, verdict: Verdict) -> Row:
    """The row of one run. The total is set-up and solve: their side only, without our certificate."""
    known = [seconds for seconds in (run.setup_seconds, run.solve_seconds) if seconds is not None]
    total = sum(known) if run.solve_seconds is not None else None
    units = None if total is None or run.work_unit_seconds is None else total / run.work_unit_seconds
    return Row(
        problem="square",
        n=cells,
        vertices=(cells + 1) ** 2,
        solver=solver,
        origin=origin,
        threads=threads,
        certify_seconds=None,
        total_seconds=total,
        work_units=units,
        **asdict(run),
        **asdict(verdict),
    )


class Table:
    """A CSV file that grows row by row, so that what is measured is kept when a run is broken off."""

    def __init__(self, path: Path, log: Callable[[str], None] = print, keep: bool = False) -> None:
        """Begins the file anew, or, with `keep`, goes on where one with the same columns ends."""
        self._path, self._log = path, log
        path.parent.mkdir(parents=True, exist_ok=True)
        names = [field.name for field in fields(Row)]
        if not (keep and path.exists()):
            self._write(names, "w")
        elif path.read_text(encoding="utf-8").partition("\n")[0] != ",".join(names):
            raise SystemExit(f"{path} has other columns: name another file by --out")

    def add(self, entry: Row) -> None:
        """Appends a row and tells of it in one line."""
        self._write([_cell(value) for value in asdict(entry).values()], "a")
        seconds = "" if entry.total_seconds is None else f"{entry.total_seconds:.3g} s"
        units = "" if entry.work_units is None else f"{entry.work_units:.0f} work units"
        residual = "" if entry.residual is None else f"residual {entry.residual:.1e}"
        certified = {True: "certified", False: "not certified", None: ""}[entry.certified]
        parts = (entry.status, seconds, units, residual, certified)
        self._log(f"n = {entry.n}, {entry.solver}: {', '.join(part for part in parts if part)}")

    def _write(self, cells: list[str], mode: str) -> None:
        with self._path.open(mode, encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerow(cells)


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    return f"{value:.6g}" if isinstance(value, float) else str(value)
