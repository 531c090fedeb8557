"""Contact problems as a benchmark of solvers of quadratic programs.

``minimise 1/2 x'Px + q'x subject to Ax >= b``, where ``A`` has at most two entries in a row. The problems are there

- as data: `problems`, and `certified` for what their solutions are;
- as files ``.mat`` like those of the Maros-Meszaros problems of OSQP: `export`;
- as the test sets ``MembranesSmall``, ``MembranesMedium`` and ``MembranesLarge`` of qpbenchmark. It wants a file of the name of the class,
  ``membranes_small.py`` with the line::

      from membrane_contact.qpbenchmark import MembranesSmall

  and then ``qpbenchmark --results-path results.csv membranes_small.py run``.

They need scipy, the test sets also qpbenchmark.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import membrane_contact as mc

if TYPE_CHECKING:
    from os import PathLike

    import numpy as np
    from numpy.typing import NDArray

#: The cells along a side of the mesh, of each test set. The classes are made when they are asked for.
SIZES = {"MembranesSmall": 16, "MembranesMedium": 48, "MembranesLarge": 128}

#: What stands for infinity in the files of the Maros-Meszaros problems.
INFINITY = 1e20

#: The largest residual of a certified solution, relative to the data.
TOLERANCE = 1e-10


@dataclass(frozen=True)
class Case:
    """A problem on meshes of any size.

    Parameters
    ----------
    about : str
    mesh : callable
        The mesh of ``n`` cells along a side.
    data : mapping
        The other arguments of `qp` and `solve`.
    """

    about: str
    mesh: Callable[[int], mc.Mesh]
    data: Mapping[str, Any]

    def arguments(self, n: int) -> dict[str, Any]:
        """All arguments of `qp` and `solve`, the mesh included."""
        return {"mesh": self.mesh(n), **self.data}


class Certified(NamedTuple):
    """A solution ``x``, its multipliers ``y >= 0`` with ``Px + q = A'y``, and ``1/2 x'Px + q'x``."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    objective: float


def _disk(n: int) -> mc.Mesh:
    """The unit disk, with ``n`` cells across."""
    return mc.Mesh.disk(n // 2)


def _l_shape(n: int) -> mc.Mesh:
    """The L-shape, with ``n`` cells along its long sides."""
    return mc.Mesh.l_shape(n // 2)


def _half_stiff(n: int) -> mc.Mesh:
    """The square, the left half of which is the region ``stiff``."""
    return mc.Mesh.rectangle(n).with_region("stiff", lambda x, y: x < 0.5)


#: The problems by name. On the boundary of the domain everything is held, where it is not said to be free.
CASES: dict[str, Case] = {
    "PAIR": Case(
        "two membranes, pressed together by constant loads",
        mc.Mesh.rectangle,
        {"tension": (1, 3), "load": (-15, 0), "height": 0.1},
    ),
    "WAVE": Case(
        "two membranes, the lower one under a load that changes its sign",
        mc.Mesh.rectangle,
        {"tension": (1, 3), "load": (-10, "60*sin(2*pi*x)*sin(2*pi*y)"), "height": 0.05},
    ),
    "FLOOR": Case(
        "a membrane over a floor: the obstacle problem",
        mc.Mesh.rectangle,
        {"membranes": [mc.Membrane(tension=1, load=-10)], "floor": -0.3},
    ),
    "TORSION": Case(
        "elastic-plastic torsion of a bar: a ceiling with ridges",
        mc.Mesh.rectangle,
        {"membranes": [mc.Membrane(tension=1, load=5)], "ceiling": "min(min(x, 1 - x), min(y, 1 - y))"},
    ),
    "CHANNEL": Case(
        "a membrane between a floor and a ceiling, in contact with both",
        mc.Mesh.rectangle,
        {"membranes": [mc.Membrane(tension=1, load="40*sin(2*pi*x)")], "floor": -0.2, "ceiling": 0.3},
    ),
    "STACK": Case(
        "three membranes, pressed together from above and below",
        mc.Mesh.rectangle,
        {
            "membranes": [
                mc.Membrane(tension=1, load=-20, height=0.2),
                mc.Membrane(tension=2, load=4, height=0.1),
                mc.Membrane(tension=3, load=24),
            ],
        },
    ),
    "PILE": Case(
        "three membranes over a sloping floor",
        mc.Mesh.rectangle,
        {
            "membranes": [
                mc.Membrane(tension=1, load="-9 - 8*x", height=0.12),
                mc.Membrane(tension=2, load="-6 + 30*sin(2*pi*x)*sin(pi*y)", height=0.06),
                mc.Membrane(tension=1, load=-4),
            ],
            "floor": "-0.12 - 0.05*x",
        },
    ),
    "TOUCH": Case(
        "two membranes of the same shape: they touch everywhere, and no force is between them",
        mc.Mesh.rectangle,
        {"tension": (1, 2), "load": (-5, -10)},
    ),
    "BIACTIVE": Case(
        "two membranes that touch everywhere: pressed together on the left half, without any force on the right one",
        mc.Mesh.rectangle,
        {"tension": (1, 2), "load": ("-5 - 20*max(0, 0.5 - x)", "-10 + 40*max(0, 0.5 - x)")},
    ),
    "JUMP": Case(
        "two membranes, the upper one forty times as stiff on one half",
        _half_stiff,
        {"tension": ({"stiff": 40, "elsewhere": 1}, 3), "load": (-15, "10*sin(pi*x)"), "height": 0.05},
    ),
    "FREE": Case(
        "two membranes, the upper one with a free edge that a line load pulls down",
        mc.Mesh.rectangle,
        {
            "membranes": [
                mc.Membrane(tension=1, load=-2, height={"right": "free", "elsewhere": 0.1}, traction={"right": -1}),
                mc.Membrane(tension=1, load=2),
            ],
        },
    ),
    "FOUNDATION": Case(
        "a membrane on an elastic foundation, free all around, over a floor",
        mc.Mesh.rectangle,
        {"membranes": [mc.Membrane(tension=1, load="-10*(x + y)", foundation=30, height="free")], "floor": -0.4},
    ),
    "CORNER": Case(
        "a membrane over a floor, on an L-shape: its gradient is infinite at the corner",
        _l_shape,
        {"membranes": [mc.Membrane(tension=1, load=-10)], "floor": -0.4},
    ),
    "DISK": Case(
        "two membranes on a disk: elements of many shapes",
        _disk,
        {"tension": (1, 2), "load": (-6, 2), "height": 0.2},
    ),
}


def problems(n: int) -> Iterator[tuple[str, mc.Qp, dict[str, Any]]]:
    """The problems one by one.

    Parameters
    ----------
    n : int
        The cells along a side of the mesh, an even number.

    Yields
    ------
    name : str
    program : Qp
    arguments : dict
        What makes it: ``qp(**arguments)``, and ``solve(**arguments)``.
    """
    for name, case in CASES.items():
        arguments = case.arguments(n)
        yield name, mc.qp(**arguments), arguments


def certified(name: str, n: int) -> Certified:
    """The solution of a problem, to compare the answer of a solver with.

    Parameters
    ----------
    name : str
        One of `CASES`.
    n : int
        The cells along a side of the mesh, an even number.

    Returns
    -------
    Certified
    """
    arguments = CASES[name].arguments(n)
    program = mc.qp(**arguments)
    solution = mc.solve(**arguments, tolerance=TOLERANCE, bound=False)
    x = solution.x
    return Certified(x, solution.y, float(x @ (program.P @ x) / 2 + program.q @ x))


def export(folder: str | PathLike[str], n: int) -> list[Path]:
    """Writes each problem with its solution as ``NAME-n.mat``.

    Parameters
    ----------
    folder : path
        It is made where it is missing.
    n : int
        The cells along a side of the mesh, an even number.

    Returns
    -------
    list of Path

    Notes
    -----
    ``minimise 1/2 x'Px + q'x + r subject to l <= Ax <= u`` with ``n`` variables and ``m`` rows, both halves of ``P``, and 1e20 for
    infinity. As in the Maros-Meszaros files, the last ``n`` rows are the bounds of the variables: readers take them off. Here these have
    none. ``x`` and ``y`` are the certified solution, with ``Px + q = A'y``, and ``objective`` is its ``1/2 x'Px + q'x``.
    """
    import numpy as np
    from scipy.io import savemat
    from scipy.sparse import identity, vstack

    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    files = []
    for name, program, _ in problems(n):
        solution = certified(name, n)
        rows, variables = program.A.shape
        data = {
            "n": variables,
            "m": rows + variables,
            "P": program.P,
            "q": program.q,
            "r": program.constant,
            "A": vstack([program.A, identity(variables)], format="csc"),
            "l": np.concatenate([program.b, np.full(variables, -INFINITY)]),
            "u": np.full(rows + variables, INFINITY),
            "x": solution.x,
            "y": np.concatenate([solution.y, np.zeros(variables)]),
            "objective": solution.objective,
        }
        files.append(folder / f"{name}-{n}.mat")
        savemat(files[-1], data, do_compression=True, oned_as="column")
    return files


def _test_set(class_name: str) -> Any:
    """The class of a test set. It is made here because qpbenchmark need not be installed."""
    try:
        from qpbenchmark import Problem, TestSet  # type: ignore[import-not-found, import-untyped, unused-ignore]
    except ImportError as error:
        raise ImportError(f"{class_name} needs qpbenchmark: pip install qpbenchmark") from error

    n = SIZES[class_name]

    def each(self: Any) -> Iterator[Any]:
        for name, program, _ in problems(n):
            parts = dict(P=program.P, q=program.q, G=-program.A, h=-program.b, A=None, b=None, lb=None, ub=None)
            yield Problem(**parts, name=f"{name}-{n}")

    members = {
        "__doc__": f"The problems with {n} cells along a side.",
        "__module__": __name__,
        "title": f"Contact of membranes, {n} cells along a side",
        "description": "Contact of membranes, discretised by finite elements.",
        "sparse_only": True,
        "__iter__": each,
    }
    return type(class_name, (TestSet,), members)


def __getattr__(name: str) -> Any:
    if name not in SIZES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    # From now on it is found without this function: the same class each time.
    globals()[name] = made = _test_set(name)
    return made
