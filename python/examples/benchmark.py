"""Solvers of quadratic programs on the problems of membrane_contact.qpbenchmark: which of their answers are certified, without the polish."""

import sys
import warnings
from typing import Any

import membrane_contact as mc
from membrane_contact.qpbenchmark import problems

SETTINGS: dict[str, dict[str, Any]] = {
    "clarabel": {},
    "highs": {"log_to_console": False, "output_flag": False},
    "osqp": {"eps_abs": 1e-9, "eps_rel": 1e-9, "max_iter": 100_000},
    "piqp": {"eps_abs": 1e-9, "eps_rel": 1e-9},
    "scs": {"eps_abs": 1e-9, "eps_rel": 1e-9},
}


def verdict(arguments: dict[str, Any], name: str) -> str:
    """Whether the answer of a solver is certified within 1e-8, and its largest residual."""
    solver = mc.qpsolvers_backend(name, **SETTINGS[name])
    try:
        solution = mc.solve(**arguments, solver=solver, polish=False, bound=False)
    except mc.CertificationError as error:
        worst = max(error.residuals.values()) if error.residuals else float("nan")
        return f"no, {worst:.0e}"
    except mc.BackendError:
        return "no answer"
    return f"yes, {solution.residual:.0e}"


# What a solver says of its answer decides nothing.
warnings.simplefilter("ignore")
n = int(sys.argv[1]) if len(sys.argv) > 1 else 8
print("| problem | " + " | ".join(SETTINGS) + " |")
print("|---|" + "---|" * len(SETTINGS))
for problem, _, arguments in problems(n):
    print(f"| {problem} | " + " | ".join(verdict(arguments, name) for name in SETTINGS) + " |")
