"""The case files on which the program is checked, and their expressions evaluated by Python itself."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
PLATE = HERE.parents[1] / "examples" / "plate.toml"
CASES = sorted((HERE / "cases").glob("*.toml")) + ([PLATE] if PLATE.exists() else [])

Function = Callable[[float, float], float]


def case_named(stem: str) -> Path:
    """The case file `cases/<stem>.toml`."""
    return HERE / "cases" / f"{stem}.toml"


@dataclass(frozen=True)
class CaseData:
    """Tensions, loads and boundary height of a case file, as functions of (x, y) where they may vary."""

    tension: tuple[float, float]
    loads: tuple[Function, Function]
    height: Function
    polynomial_loads: bool


def read_case(path: Path) -> CaseData:
    """The data of the case file at `path`, which must have a table `[membranes]`."""
    membranes = tomllib.loads(path.read_text(encoding="utf-8"))["membranes"]
    return CaseData(
        tension=tuple(membranes["tension"]),
        loads=tuple(function(load) for load in membranes["load"]),
        height=function(membranes.get("height", 0.0)),
        polynomial_loads=all(_is_polynomial(load) for load in membranes["load"]),
    )


FUNCTIONS = ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp", "sqrt")
NAMES = {name: getattr(math, name) for name in ("pi", *FUNCTIONS)}
NAMES |= {"ln": math.log, "abs": abs, "min": min, "max": max}
NAMES |= {"choose": lambda condition, if_true, if_false: if_true if condition else if_false}


def function(expression: float | str) -> Function:
    """The function of (x, y) that a number or an expression of a case file stands for."""
    text = re.sub(r"\bif\s*\(", "choose(", str(expression)).replace("^", "**")
    code = compile(text, "<case file>", "eval")
    return lambda x, y: float(eval(code, {"__builtins__": {}}, NAMES | {"x": x, "y": y}))


def _is_polynomial(expression: float | str) -> bool:
    """Whether an expression has no other name than x and y and no division."""
    return isinstance(expression, (int, float)) or re.fullmatch(r"[\d\s.xy+*^()-]*", expression) is not None
