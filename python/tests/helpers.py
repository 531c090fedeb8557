"""Tools of the tests: problems, other processes, the program."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

import membrane_contact as mc

REPOSITORY = Path(__file__).resolve().parents[2]

#: A mesh of Gmsh with the region `plate` and the curves `outer boundary`, `opening`, `bolt holes`.
PLATE = REPOSITORY / "examples" / "plate.msh"

#: The pair of the README; about half of the square is in contact.
PAIR: dict[str, Any] = {"tension": (1, 3), "load": (-15, "10*sin(pi*x)"), "height": 0.1}

#: A membrane over a floor.
OBSTACLE: dict[str, Any] = {"membranes": [mc.Membrane(tension=1, load=-10)], "floor": -0.3}

#: Two coupled membranes over a floor.
STACK: dict[str, Any] = {
    "membranes": [
        mc.Membrane(tension=1, load="-9 - 8*x", height=0.12),
        mc.Membrane(tension=2, load="-6 + 30*sin(2*pi*x)*sin(pi*y)"),
    ],
    "floor": -0.12,
}

# Numbers that two ways of integration round differently, relative to the greatest value. The solvers are exact to rounding here.
ROUNDING = 1e-11

# Far beyond the second that a subprocess takes: what hangs ends a test, and does not block it.
TIMEOUT_SECONDS = 30


def zero_backend(P: Any, q: Any, A: Any, b: Any, **_: Any) -> tuple[Any, Any]:
    """A QP solver that solves nothing: with the polish the answer is right all the same."""
    return 0 * q, 0 * b


def is_same(a: Any, b: Any) -> bool:
    """The same to rounding."""
    a, b = np.asarray(a), np.asarray(b)
    return a.shape == b.shape and bool(np.abs(a - b).max() <= ROUNDING * max(np.abs(b).max(), 1e-300))


def same_bits(a: Any, b: Any) -> bool:
    """The same numbers to the last bit, the sign of zero included."""
    a, b = np.ascontiguousarray(a), np.ascontiguousarray(b)
    return a.shape == b.shape and a.dtype == b.dtype and a.tobytes() == b.tobytes()


def environment() -> dict[str, str]:
    """That of this process, in which others find the same package, wherever they run."""
    package = str(Path(mc.__file__).resolve().parents[1])
    paths = [package, *filter(None, [os.environ.get("PYTHONPATH")])]
    return {**os.environ, "PYTHONPATH": os.pathsep.join(paths), "MPLBACKEND": "Agg"}


def start_python(script: str, *options: str, **variables: str) -> subprocess.Popen[str]:
    """Starts Python on a script."""
    return subprocess.Popen(
        [sys.executable, *options, "-c", script],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        stdin=subprocess.DEVNULL,
        text=True,
        env={**environment(), **variables},
    )


@dataclass(frozen=True)
class Ended:
    """How a process has ended: -9 where it was ended here, because it would not by itself."""

    code: int
    output: str
    errors: str
    seconds: float

    def __str__(self) -> str:
        return f"exit code {self.code} after {self.seconds:.1f} s\n{self.output}\n{self.errors}"


def run_python(script: str, *options: str, timeout: float = TIMEOUT_SECONDS, **variables: str) -> Ended:
    """Runs a script in another process, which is killed after `timeout` seconds."""
    start = time.monotonic()
    process = start_python(script, *options, **variables)
    try:
        output, errors = process.communicate(timeout=timeout)
    except subprocess.TimeoutExpired:
        process.kill()
        output, errors = process.communicate()
    return Ended(process.returncode, output, errors, time.monotonic() - start)


def find_program() -> list[str]:
    """The command that runs the program."""
    named = os.environ.get("MEMBRANES")
    if named is not None:
        return [named]
    built = REPOSITORY / "target" / "debug" / ("membranes.exe" if os.name == "nt" else "membranes")
    return [str(built)] if os.access(built, os.X_OK) else package_program()


def package_program() -> list[str]:
    """The command that runs the program of the package."""
    return [sys.executable, "-m", "membrane_contact"]


@dataclass(frozen=True)
class Program:
    """The program, and where its results go."""

    command: list[str]
    workspace: Path
    number: list[int] = field(default_factory=lambda: [0])

    def run(self, *arguments: str, expected: int = 0) -> subprocess.CompletedProcess[str]:
        """Runs it."""
        ended = subprocess.run(
            [*self.command, *arguments],
            capture_output=True,
            text=True,
            timeout=TIMEOUT_SECONDS,
            env=environment(),
            stdin=subprocess.DEVNULL,
        )
        assert ended.returncode == expected, f"{arguments} ended with {ended.returncode}: {ended.stderr}"
        return ended

    def write(self, case: str) -> Path:
        """A case file in a folder of its own."""
        self.number[0] += 1
        folder = self.workspace / str(self.number[0])
        folder.mkdir()
        path = folder / "case.toml"
        path.write_text(case, encoding="utf-8")
        return path

    def solve(self, case: str) -> Path:
        """The folder with the results of a case."""
        path = self.write(case)
        out = path.parent / "out"
        self.run("solve", str(path), "--out", str(out), "--no-picture", "--quiet")
        return out


def read_json(path: Path) -> Any:
    """A file of JSON."""
    return json.loads(path.read_text(encoding="utf-8"))


def write_gmsh(
    path: Path,
    mesh: mc.Mesh,
    regions: dict[str, Any],
    node_data: dict[str, Any] | None = None,
    element_data: dict[str, Any] | None = None,
) -> None:
    """A file of Gmsh, MSH 2.2, with regions that cover the mesh, and data views."""
    names = list(regions)
    tags = np.zeros(len(mesh.triangles), dtype=int)
    for tag, name in enumerate(names, start=1):
        tags[regions[name]] = tag
    assert tags.all(), "the regions cover the mesh"
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(names))]
    lines += [f'2 {tag} "{name}"' for tag, name in enumerate(names, start=1)]
    lines += ["$EndPhysicalNames", "$Nodes", str(len(mesh.points))]
    lines += [f"{a} {x!r} {y!r} 0" for a, (x, y) in enumerate(mesh.points.tolist(), start=1)]
    lines += ["$EndNodes", "$Elements", str(len(mesh.triangles))]
    corners = (mesh.triangles.astype(int) + 1).tolist()
    lines += [f"{t} 2 2 {tag} {tag} {a} {b} {c}" for t, (tag, (a, b, c)) in enumerate(zip(tags, corners), start=1)]
    lines.append("$EndElements")
    for section, views in ("NodeData", node_data or {}), ("ElementData", element_data or {}):
        for name, values in views.items():
            lines += [f"${section}", "1", f'"{name}"', "1", "0.0", "3", "0", "1", str(len(values))]
            lines += [f"{k} {value!r}" for k, value in enumerate(np.asarray(values, float).tolist(), start=1)]
            lines.append(f"$End{section}")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def interrupt(process: subprocess.Popen[str]) -> None:
    """Ctrl-C."""
    process.send_signal(signal.SIGINT)
