"""One solver on one exported problem, in a process of its own: `peers.py` starts it, and ends it when it is too slow.

    python solve_one.py problem.npz CELLS SOLVER TOLERANCE answer.npz result.json

TOLERANCE is a number or `default`. The answer is in the units of the exported problem.
"""

from __future__ import annotations

import json
import sys
import warnings
from dataclasses import asdict
from pathlib import Path

import numpy as np
import qpsolvers

import family
import solvers


def main(problem: str, cells: str, solver: str, tolerance: str, answer: str, result: str) -> None:
    exported = family.read(Path(problem))
    length, force = exported.displacement_scale, exported.force_scale
    # x = length z, y = force v: (z, v) is optimal for the program in which z and P z + q have the size 1. Its A x >= b
    # is qpsolvers' G x <= h with the signs changed, and its y is their z.
    program = qpsolvers.Problem(
        exported.P * (length / force), exported.q / force, -exported.A, -exported.b / length
    )
    asked = solvers.settings(solver, None if tolerance == "default" else float(tolerance))
    warnings.simplefilter("ignore")
    unit = family.work_unit(exported.stiffness)
    solution = qpsolvers.solve_problem(program, solver=solver, **asked)
    unit = min(unit, family.work_unit(exported.stiffness))

    if solution.x is not None and solution.z is not None and solution.z.size == exported.b.size:
        x, y = np.asarray(solution.x, float).ravel(), np.asarray(solution.z, float).ravel()
        np.savez(answer, x=length * x, y=force * y)
    within = solvers.setup_within_solve(solver, solution.extras)
    measurement = family.Measurement(
        status="solved" if solution.found else "stopped",
        iterations=solvers.iterations(solver, solution.extras),
        setup_seconds=solution.build_time + within,
        solve_seconds=solution.solve_time - within,
        work_unit_seconds=unit,
    )
    Path(result).write_text(json.dumps(asdict(measurement)), encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
