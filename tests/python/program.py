"""The program `membranes` under test, and what it writes."""

from __future__ import annotations

import json
import subprocess
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import meshio
import numpy as np

from problem import ExportedProblem, Vector, read_npz

# Far beyond the seconds that these small cases take: a hanging program ends the test instead of blocking it.
TIME_LIMIT_SECONDS = 120


@dataclass(frozen=True)
class ProgramSolution:
    """What `membranes solve` found: mesh, cell data (triangles,) and point data (vertices,) of `solution.vtu`, and
    `summary.json`."""

    points: Vector
    triangles: Vector
    indicator: Vector
    u1: Vector
    u2: Vector
    gap: Vector
    action: Vector
    contact: Vector
    summary: dict[str, Any]

    def unknowns(self, problem: ExportedProblem) -> tuple[Vector, Vector]:
        """x = (u1, u2), shape (2n,), and y = lambda |D_a|, shape (n,), on the interior vertices."""
        interior = problem.interior
        x = np.concatenate((self.u1[interior], self.u2[interior]))
        return x, self.action[interior] * problem.dual_area


@dataclass(frozen=True)
class Program:
    """The executable and the directory below which its results go; a case is run once."""

    executable: Path
    workspace: Path

    @cache
    def export(self, case: Path, form: str) -> Path:
        """The directory with the QP of `case` in the given format, `npz`, `qps` or `mtx`."""
        directory = self.workspace / case.stem / form
        self._run("export", str(case), "--format", form, "--out", str(directory))
        return directory

    def problem(self, case: Path) -> ExportedProblem:
        """The QP of `case` with its mesh."""
        return read_npz(self.export(case, "npz"))

    @cache
    def solve(self, case: Path, refine: int = 0) -> ProgramSolution:
        """The program's own solution of `case`, on its mesh refined so many times."""
        directory = self.workspace / case.stem / f"solve-{refine}"
        self._run("solve", str(case), "--refine", str(refine), "--out", str(directory))
        mesh = meshio.read(directory / "solution.vtu")
        fields = {name: mesh.point_data[name] for name in ("u1", "u2", "gap", "lambda", "contact")}
        summary = json.loads((directory / "summary.json").read_text(encoding="utf-8"))
        triangles, indicator = mesh.cells_dict["triangle"], mesh.cell_data["error_indicator"][0]
        return ProgramSolution(mesh.points[:, :2], triangles, indicator, *fields.values(), summary)

    @cache
    def dual(self, case: Path) -> Path:
        """The directory with the files of `solve --dual`."""
        directory = self.workspace / case.stem / "dual"
        self._run("solve", str(case), "--dual", "--out", str(directory))
        return directory

    def _run(self, *arguments: str) -> None:
        command = [str(self.executable), *arguments]
        run = subprocess.run(command, capture_output=True, text=True, timeout=TIME_LIMIT_SECONDS)
        assert run.returncode == 0, (
            f"{' '.join(command)} ended with {run.returncode}: {run.stderr or run.stdout}"
        )
