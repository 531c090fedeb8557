"""What general QP solvers make of the same problem: a row for each solver, setting and size.

    pip install -r benches/peers/requirements.txt
    python benches/peers/peers.py --membranes target/release/membranes --sizes 64 128 256 --out rows.csv

For each size, `membranes export` writes the quadratic program. Each solver gets it in a process of its own, scaled to
units in which x and P x + q have the size 1, as `QpProblem::nondimensional` does for the Rust backends: q ~ h^2, so
that without it one tolerance would mean another thing on every mesh, and default settings would look worse than they
are. It runs at its default settings and at tight ones (see solvers.py), and `membranes check --answer` judges what it
returns, at the tolerance 1e-8.

Set-up seconds are what qpsolvers counts as building, and what SCS and ProxQP tell of theirs; CVXOPT, HiGHS and DAQP do
all within the solve. A work unit is one product of scipy with K on the interior vertices (float64, int32 indices),
measured in the same process right before and after. The limit of time holds for the whole process, reading included;
a solver that has met it, or has failed, is not tried at larger sizes with the same settings.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import family
import solvers
from family import Measurement, Verdict

HERE = Path(__file__).resolve().parent

# Variables that tell the libraries below the solvers how many threads to take.
THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS")

# After these, larger sizes are not tried.
HOPELESS = ("time limit", "failed")


def main() -> None:
    options = arguments()
    table = family.Table(options.out)
    hopeless: set[tuple[str, str]] = set()
    with tempfile.TemporaryDirectory() as temporary:
        for cells in sorted(options.sizes):
            folder = Path(temporary, str(cells))
            family.export(options.membranes, cells, folder)
            for solver in options.solvers:
                for setting in ("default", *options.tight):
                    name = f"{solver} ({setting})"
                    if (solver, setting) in hopeless:
                        run, verdict = Measurement("skipped"), Verdict()
                    else:
                        run, verdict = measure(options, folder, cells, solver, setting)
                    if run.status in HOPELESS:
                        hopeless.add((solver, setting))
                    table.add(family.row(cells, name, "qpsolvers", options.threads, run, verdict))


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--membranes", type=program, required=True, help="the program, built with --release")
    parser.add_argument("--sizes", type=int, nargs="+", default=[64, 128, 256], help="cells along a side")
    parser.add_argument("--solvers", nargs="+", default=list(solvers.TIGHT), choices=list(solvers.TIGHT))
    parser.add_argument("--tight", nargs="*", default=["1e-10"], help="tolerances beside the defaults")
    parser.add_argument("--time-limit", type=float, default=300.0, help="seconds for a run")
    parser.add_argument("--threads", type=int, default=1, help="threads that a solver may take")
    parser.add_argument("--out", type=Path, required=True, help="the CSV file")
    return parser.parse_args()


def program(path: str) -> Path:
    """The absolute path of an executable."""
    found = Path(path).resolve()
    if not (found.is_file() and os.access(found, os.X_OK)):
        raise argparse.ArgumentTypeError(f"{path} is no program: build it by `cargo build --release`")
    return found


def measure(
    options: argparse.Namespace, folder: Path, cells: int, solver: str, setting: str
) -> tuple[Measurement, Verdict]:
    """Runs a solver on the problem in `folder`, and has its answer judged."""
    answer, result = folder / "answer.npz", folder / "result.json"
    for path in (answer, result):
        path.unlink(missing_ok=True)
    worker = [sys.executable, HERE / "solve_one.py", folder / "problem.npz", str(cells), solver, setting]
    outcome = run_within([*worker, answer, result], options.time_limit, options.threads)
    if outcome is not None:
        return Measurement(outcome), Verdict()
    run = Measurement(**json.loads(result.read_text(encoding="utf-8")))
    if not answer.exists():
        return run, Verdict(certified=False)
    return run, family.judge(options.membranes, folder / "case.toml", answer, folder / "verdict")


def run_within(command: list[str | Path], limit: float, threads: int) -> str | None:
    """Runs a command; None when it has ended well, else how it has ended."""
    environment = os.environ | dict.fromkeys(THREAD_VARIABLES, str(threads))
    with subprocess.Popen(
        command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as process:
        try:
            _, complaint = process.communicate(timeout=limit)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            return "time limit"
    if process.returncode == 0:
        return None
    print(complaint.strip().rpartition("\n")[2] or f"ended with {process.returncode}", file=sys.stderr)
    return "failed"


if __name__ == "__main__":
    main()
