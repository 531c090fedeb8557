"""Data: every way to write one gives the same, errors name the datum, and exceptions of callables pass through."""

from __future__ import annotations

import os
import threading
from collections import OrderedDict, deque
from collections.abc import Callable, Mapping
from fractions import Fraction
from types import MappingProxyType
from typing import Any

import numpy as np
import pytest

import membrane_contact as mc
from helpers import OBSTACLE, PAIR, STACK, is_same, same_bits, zero_backend

SQUARE = mc.Mesh.rectangle(8)
X, Y = np.array(SQUARE.points).T
BARYCENTRES = np.array(SQUARE.points)[SQUARE.triangles].mean(axis=1)
WEST = BARYCENTRES[:, 0] < 0.5
VERTICES, TRIANGLES = len(X), len(BARYCENTRES)

#: Two regions, three views, and a curve more than it is made with.
MESH = (
    SQUARE.with_region("west", WEST)
    .with_region("east", np.flatnonzero(~WEST))
    .with_curve("lower left", lambda x, y: (x < 1e-9) & (y < 0.5 + 1e-9))
    .with_view("tilted", -12 - 3 * X)
    .with_view("stripes", np.where(WEST, -9.0, -18.0), on="triangles")
    .with_view("seven", np.full(VERTICES, 7.0))
)


class HalfNumber:
    """Not a float, but it knows one."""

    def __float__(self) -> float:
        return -15.0


class Affine:
    """A callable object."""

    def __call__(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return -12 - 3 * x

    def method(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return -12 - 3 * x


def with_load(load: Any, mesh: mc.Mesh = MESH, **further: Any) -> mc.Solution:
    return mc.solve(mesh, tension=(1, 3), load=(load, 5), height=0.1, **further)


CONSTANT = with_load(-15)

CONSTANTS: dict[str, Any] = {
    "float": -15.0,
    "numpy float": np.float64(-15),
    "single": np.float32(-15),
    "numpy int": np.int16(-15),
    "fraction": Fraction(-15),
    "with __float__": HalfNumber(),
    "array without dimensions": np.array(-15.0),
    "formula": "-15",
    "longer formula": "-15 + 0*x",
    "numpy str": np.str_("-15"),
    "callable": lambda x, y: np.full(len(x), -15.0),
    "callable to a number": lambda x, y: -15,
    "callable to a numpy number": lambda x, y: np.float32(-15),
    "callable to integers": lambda x, y: np.full(len(x), -15),
    "callable to a list": lambda x, y: [-15] * len(x),
    "callable to a tuple": lambda x, y: (-15.0,) * len(x),
    "callable to singles": lambda x, y: np.full(len(x), -15, dtype=np.float32),
    "callable to big endian": lambda x, y: np.full(len(x), -15, dtype=">f8"),
    "callable to a broadcast": lambda x, y: np.broadcast_to(-15.0, x.shape),
    "callable to a slice": lambda x, y: np.full(2 * len(x), -15.0)[::2],
    "elsewhere alone": {"elsewhere": -15},
    "regions": {"west": -15, "east": "-15"},
    "region and elsewhere": {"west": -15, "elsewhere": lambda x, y: 0 * x - 15},
    "mapping": MappingProxyType({"west": -15, "elsewhere": -15}),
    "ordered": OrderedDict(east=-15, west=-15),
}

ARRAYS: dict[str, Any] = {
    "at vertices": np.full(VERTICES, -15.0),
    "on triangles": np.full(TRIANGLES, -15.0),
    "list at vertices": [-15] * VERTICES,
    "in a region": {"west": np.full(VERTICES, -15.0), "elsewhere": np.full(TRIANGLES, -15)},
}


@pytest.mark.parametrize("load", CONSTANTS.values(), ids=CONSTANTS)
def test_constants_in_every_form(load: Any) -> None:
    assert is_same(with_load(load).u1, CONSTANT.u1)


@pytest.mark.parametrize("load", ARRAYS.values(), ids=ARRAYS)
def test_constant_arrays(load: Any) -> None:
    assert is_same(with_load(load).u1, CONSTANT.u1)


AFFINE: dict[str, Any] = {
    "callable": lambda x, y: -12 - 3 * x,
    "callable object": Affine(),
    "method": Affine().method,
    "in place": lambda x, y: np.subtract(np.multiply(x, -3, out=x), 12, out=x),
    "at vertices": -12 - 3 * X,
    "view": {"view": "tilted"},
    "view in a region": {"west": {"view": "tilted"}, "elsewhere": "-12 - 3*x"},
    "regions": {"west": "-12 - 3*x", "east": -12 - 3 * X},
}


@pytest.mark.parametrize("load", AFFINE.values(), ids=AFFINE)
def test_affine_loads_in_every_form(load: Any) -> None:
    expected = with_load("-12 - 3*x")
    assert not is_same(CONSTANT.u1, expected.u1)
    assert is_same(with_load(load).u1, expected.u1)


STRIPES: dict[str, Any] = {
    "formula": "if(x < 0.5, -9, -18)",
    "callable": lambda x, y: np.where(x < 0.5, -9.0, -18.0),
    "on triangles": np.where(WEST, -9, -18),
    "view": {"view": "stripes"},
    "regions": {"west": -9, "east": -18},
    "elsewhere": {"west": -9, "elsewhere": -18},
}


@pytest.mark.parametrize("load", STRIPES.values(), ids=STRIPES)
def test_loads_by_triangle_in_every_form(load: Any) -> None:
    assert is_same(with_load(load).u1, with_load({"east": -18, "west": -9}).u1)


@pytest.mark.parametrize("load", STRIPES.values(), ids=STRIPES)
def test_data_on_a_refined_mesh(load: Any) -> None:
    fine = MESH.refined()
    if isinstance(load, np.ndarray):
        with pytest.raises(mc.DataError, match="128 values"):
            with_load(load, fine)
        load = np.repeat(load, 4)
    assert is_same(with_load(load, fine).u1, with_load({"east": -18, "west": -9}, fine).u1)


def test_a_callable_has_the_bits_of_the_formula() -> None:
    # Sums and products alone are the same everywhere.
    by_formula = with_load("-12 - 3*x*y")
    by_callable = with_load(lambda x, y: -12 - 3 * x * y)
    assert same_bits(by_callable.u1, by_formula.u1)
    assert by_callable.error_bound == by_formula.error_bound


@pytest.mark.parametrize("key", ["tension", "foundation", "height", "traction", "floor", "ceiling"])
@pytest.mark.parametrize("form", ["formula", "callable", "array", "view"])
def test_every_datum_in_every_form(key: str, form: str) -> None:
    if key == "traction" and form in ("array", "view"):
        pytest.skip("a traction is a number, a formula or a callable")
    constant = {"tension": 2.0, "foundation": 0.5, "height": 0.125, "traction": 4.0, "floor": -0.125, "ceiling": 0.1875}[key]
    mesh = SQUARE.with_view("constant", np.full(VERTICES, constant))
    forms = {
        "formula": f"{constant} + 0*x*y",
        "callable": lambda x, y: constant + 0 * x * y,
        "array": np.full(VERTICES, constant),
        "view": {"view": "constant"},
    }

    def solve(value: Any) -> mc.Solution:
        data = {"tension": 1, "load": "-30*cos(2*pi*x)", "height": {"elsewhere": 0, "left": "free"}, "floor": -0.25, "ceiling": 0.25}
        if key == "height":
            data["height"] = value
        else:
            data |= {key: value}
        floor, above = data.pop("floor"), data.pop("ceiling")
        return mc.solve(mesh, membranes=[data], floor=floor, ceiling=above)

    expected = solve(constant)
    assert is_same(solve(forms[form]).u1, expected.u1)
    assert not is_same(solve(0.75 * constant).u1, expected.u1)


def test_heights_and_tractions_by_curve() -> None:
    by_name = {"left": 0.1, "right": "free", "elsewhere": "0.1*(1 - x)"}
    upper = mc.Membrane(tension=1, load=-9, height=by_name, traction={"right": -1})
    expected = mc.solve(MESH, membranes=[upper], floor=-0.4)
    other = {**by_name, "elsewhere": lambda x, y: 0.1 * (1 - x), "left": np.full(VERTICES, 0.1)}
    for traction in -1, "-1", lambda x, y: -1 + 0 * x, {"right": lambda x, y: -1}, {"elsewhere": -1}:
        upper = mc.Membrane(tension=1, load=-9, height=other, traction=traction)
        assert is_same(mc.solve(MESH, membranes=[upper], floor=-0.4).u1, expected.u1)
    upper.pop("traction")
    assert not is_same(mc.solve(MESH, membranes=[upper], floor=-0.4).u1, expected.u1)


def test_a_curve_by_edges_is_the_curve_by_a_callable() -> None:
    edges = [[9 * i, 9 * i + 9] for i in range(4)]
    assert MESH.curves["lower left"].tolist() == edges
    by_edges = SQUARE.with_curve("lower left", edges)

    def solve(mesh: mc.Mesh) -> mc.Solution:
        return mc.solve(mesh, membranes=[mc.Membrane(tension=1, load=-9, height={"lower left": "free"})], floor=-0.2)

    assert same_bits(solve(MESH).u1, solve(by_edges).u1)
    assert not is_same(solve(MESH).u1, mc.solve(MESH, membranes=[mc.Membrane(tension=1, load=-9)], floor=-0.2).u1)


@pytest.mark.parametrize(
    "west",
    [
        WEST,
        WEST.tolist(),
        np.flatnonzero(WEST),
        np.flatnonzero(WEST)[::-1].astype(">i2"),
        np.flatnonzero(WEST).tolist(),
        lambda x, y: x < 0.5,
        lambda x, y: np.flatnonzero(x < 0.5),
        lambda x, y: (x < 0.5).tolist(),
    ],
)
def test_regions_in_every_form(west: Any) -> None:
    mesh = SQUARE.with_region("west", west)
    assert mesh.regions["west"].tolist() == np.flatnonzero(WEST).tolist()
    assert SQUARE.regions == {}


@pytest.mark.parametrize("predicate", [lambda x, y: x < 1e-9, lambda x, y: bool(x[0] < 1e-9), lambda x, y: [x[0] < 1e-9]])
def test_curves_by_what_callables_return(predicate: Callable[..., Any]) -> None:
    assert SQUARE.with_curve("a", predicate).curves["a"].tolist() == SQUARE.curves["left"].tolist()


@pytest.mark.parametrize(
    "bad",
    [[-1], [128], [0.5], [], "a", None, {1, 2}, np.ones(127, bool), True, np.ones((2, 2)), lambda x, y: None, lambda x, y: x],
)
def test_bad_regions_are_refused(bad: Any) -> None:
    with pytest.raises(ValueError) as caught:
        SQUARE.with_region("a", bad)
    assert "18446744073709551615" not in str(caught.value)


@pytest.mark.parametrize("bad", [[[0, -1]], [[0, 81]], [[0, 80]], [[0, 0]], [], [0, 1], [[0, 1, 2]], "a", None, lambda x, y: x < -1])
def test_bad_curves_are_refused(bad: Any) -> None:
    with pytest.raises(ValueError) as caught:
        SQUARE.with_curve("a", bad)
    assert "18446744073709551615" not in str(caught.value)
    # That is Rust.
    assert ".abs()" not in str(caught.value)


@pytest.mark.parametrize(
    ("values", "on"),
    [(np.zeros(80), "vertices"), (np.zeros(81), "triangles"), (np.zeros(81), "edges"), (np.full(81, np.nan), "vertices"), (1.0, "vertices")],
)
def test_bad_views_are_refused(values: Any, on: Any) -> None:
    with pytest.raises(ValueError):
        SQUARE.with_view("a", values, on=on)


@pytest.mark.parametrize(
    "again",
    [
        lambda: MESH.with_region("west", [0]),
        lambda: MESH.with_curve("left", [[0, 1]]),
        lambda: MESH.with_view("seven", np.zeros(VERTICES)),
    ],
)
def test_names_are_given_once(again: Callable[[], mc.Mesh]) -> None:
    with pytest.raises(ValueError, match="west|left|seven"):
        again()


def membranes(**data: Any) -> dict[str, Any]:
    return {"membranes": [{"tension": 1, "load": -9}, {"tension": 1, "load": 9, **data}]}


WRONG: dict[str, tuple[dict[str, Any], str]] = {
    "load": ({**PAIR, "load": ("x +", 0)}, "load[0]"),
    "second load": ({**PAIR, "load": (0, [1, 2])}, "load[1]"),
    "loads": ({**PAIR, "load": (1, 2, 3)}, "load"),
    "one load": ({**PAIR, "load": 3}, "load"),
    "loads in a string": ({**PAIR, "load": "12"}, "load"),
    "loads by region": ({**PAIR, "load": {"west": -3, "east": 4}}, "load"),
    "tension": ({**PAIR, "tension": ("", 1)}, "tension[0]"),
    "tensions": ({**PAIR, "tension": (1,)}, "tension"),
    "tensions in a dictionary": ({**PAIR, "tension": {1: 1, 3: 2}}, "tension"),
    "tensions in a set": ({**PAIR, "tension": {1, 3}}, "tension"),
    "height": ({**PAIR, "height": "sin("}, "height"),
    "floor": ({**OBSTACLE, "floor": np.zeros(5)}, "floor"),
    "ceiling": ({**OBSTACLE, "ceiling": {}}, "ceiling"),
    "floor of a region": ({**OBSTACLE, "floor": {"west": "zzz", "east": 0}}, 'floor["west"]'),
    "tension of a membrane": (membranes(tension="a"), "membranes[1].tension"),
    "foundation": (membranes(foundation=None), "membranes[1].foundation"),
    "load of a region": (membranes(load={"west": "a b"}), 'membranes[1].load["west"]'),
    "region without a name": (membranes(load={3: 1}), "membranes[1].load"),
    "view without a name": (membranes(load={"view": 3}), "membranes[1].load"),
    "height of a curve": (membranes(height={"left": "fre"}), 'membranes[1].height["left"]'),
    "traction": (membranes(traction=1), "membranes[1].traction"),
    "traction of a curve": (membranes(height={"left": "free"}, traction={"left": "1 +"}), 'membranes[1].traction["left"]'),
    "traction on a held curve": (membranes(height={"left": "free"}, traction={"top": 1}), "membranes[1].traction"),
    "unknown key": (membranes(tensoin=1), "membranes[1]"),
    "no tension": ({"membranes": [{"load": 1}]}, "membranes[0]"),
    "no membrane": ({"membranes": []}, "membranes"),
    "negative tension": ({**PAIR, "tension": (-1, 1)}, "tension[0]"),
    "load that is not finite": ({**PAIR, "load": (0, np.nan)}, "load[1]"),
    "callable that is not finite": ({**PAIR, "load": (lambda x, y: x / 0, 1)}, "load[0]"),
    "callable to too few": ({**PAIR, "load": (lambda x, y: x[1:], 1)}, "load[0]"),
    "callable to one": ({**PAIR, "load": (lambda x, y: x[:1], 1)}, "load[0]"),
    "callable to rows": ({**PAIR, "load": (lambda x, y: x[:, None], 1)}, "load[0]"),
    "callable to None": ({**PAIR, "load": (lambda x, y: None, 1)}, "load[0]"),
    "callable to a string": ({**PAIR, "load": (lambda x, y: "x", 1)}, "load[0]"),
    "callable to complex": ({**PAIR, "height": lambda x, y: x + 1j}, "height"),
    "view that is not there": ({**PAIR, "load": ({"view": "none"}, 1)}, "load[0]"),
    "region that is not there": ({**PAIR, "load": ({"none": 1}, 1)}, "load[0]"),
    "regions that leave some out": ({**PAIR, "load": ({"west": 1}, 1)}, "load[0]"),
    "curve that is not there": (membranes(height={"lfet": "free"}), "membranes[1].height"),
    "negative height": ({**PAIR, "height": -0.1}, "height"),
    "floor by triangle": ({**OBSTACLE, "floor": np.zeros(TRIANGLES)}, "floor"),
    "integration": ({**PAIR, "integration": "gauss"}, "integration"),
    "solver": ({**PAIR, "solver": "gurobi"}, "solver"),
}


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize(("arguments", "key"), WRONG.values(), ids=WRONG)
def test_errors_are_data_errors(arguments: dict[str, Any], key: str) -> None:
    with pytest.raises(mc.DataError) as caught:
        mc.solve(MESH, **arguments)
    assert isinstance(caught.value, ValueError)
    assert hasattr(caught.value, "vertex")


# Those which are found by the core, and not where data are read, name the datum in the message alone.
NAMED_IN_THE_MESSAGE = {
    "no membrane",
    "negative tension",
    "load that is not finite",
    "callable that is not finite",
    "view that is not there",
    "region that is not there",
    "regions that leave some out",
    "curve that is not there",
    "negative height",
    "floor by triangle",
}


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("name", [name for name in WRONG if name not in NAMED_IN_THE_MESSAGE])
def test_errors_name_the_key(name: str) -> None:
    arguments, key = WRONG[name]
    with pytest.raises(mc.DataError) as caught:
        mc.solve(MESH, **arguments)
    assert caught.value.key is not None
    assert caught.value.key.removesuffix("(x, y)") == key
    assert key in str(caught.value)


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("name", sorted(NAMED_IN_THE_MESSAGE))
def test_errors_of_the_core_name_the_key_or_none(name: str) -> None:
    arguments, key = WRONG[name]
    with pytest.raises(mc.DataError) as caught:
        mc.solve(MESH, **arguments)
    assert caught.value.key in (None, key)


def test_errors_at_a_vertex_name_it() -> None:
    heights = np.full(VERTICES, 0.1)
    heights[4] = -0.2
    with pytest.raises(mc.DataError, match="vertex 4 ") as caught:
        mc.solve(MESH, tension=(1, 3), height=heights)
    assert caught.value.vertex == 4
    floor = np.full(VERTICES, -1.0)
    floor[3] = 0.5
    with pytest.raises(mc.DataError, match="vertex 3 ") as caught:
        mc.solve(MESH, membranes=[mc.Membrane(tension=1)], floor=floor)
    assert caught.value.vertex == 3


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({}, "tension"),
        ({"load": (1, 2)}, "tension"),
        ({"tension": (1, 2), "membranes": []}, "tension"),
        ({"height": 1, "membranes": []}, "height"),
        ({"membranes": [3]}, r"membranes\[0\]"),
        ({"membranes": 3}, "iterable|membranes"),
        ({**PAIR, "solver": 3}, "solver"),
        ({**PAIR, "tolerance": "small"}, "tolerance"),
        ({**PAIR, "warm_start": 3}, "Solution"),
        ({**PAIR, "polish": "yes"}, "polish|bool"),
        ({**PAIR, "no_such_argument": 1}, "no_such_argument"),
        (membranes(height={"left": "free"}, traction={"left": np.zeros(VERTICES)}), "traction"),
        (membranes(pressed="no"), "bool|pressed"),
    ],
)
def test_wrong_types(arguments: dict[str, Any], message: str) -> None:
    with pytest.raises(TypeError, match=message):
        mc.solve(MESH, **arguments)


@pytest.mark.parametrize("tolerance", [0, -1, 2, np.nan, np.inf])
def test_tolerances_are_between_0_and_1(tolerance: float) -> None:
    with pytest.raises(ValueError, match="tolerance"):
        mc.solve(MESH, **PAIR, tolerance=tolerance)


@pytest.mark.parametrize("time_limit", [0, -1, np.nan, np.inf])
def test_time_limits_are_positive(time_limit: float) -> None:
    with pytest.raises(ValueError, match="seconds"):
        mc.solve(MESH, **PAIR, time_limit=time_limit)


def test_mesh_must_be_a_mesh() -> None:
    with pytest.raises(TypeError, match="Mesh"):
        mc.solve((SQUARE.points, SQUARE.triangles), **PAIR)


class Custom(Exception):
    """An exception of the user."""


class CustomBase(BaseException):
    """One that `except Exception` does not catch."""


class WithArguments(Exception):
    """One that cannot be made again from its message."""

    def __init__(self, first: object, *, second: object) -> None:
        super().__init__(first)
        self.second = second


EXCEPTIONS: list[BaseException] = [
    Custom("of the user"),
    CustomBase("of the user"),
    WithArguments(object(), second=[1]),
    KeyboardInterrupt(),
    KeyboardInterrupt("with a text"),
    SystemExit(3),
    GeneratorExit(),
    StopIteration(4),
    MemoryError("none left"),
    ZeroDivisionError("one"),
    mc.DataError("as ours"),
    mc.CertificationError("as ours"),
    UnicodeDecodeError("utf-8", b"\xff", 0, 1, "bad"),
]


def raising(error: BaseException, after: int = 0, value: float = 0.0) -> Callable[..., Any]:
    """A callable that raises the error, after so many calls that return the value."""
    calls = [0]

    def planned(x: np.ndarray, y: np.ndarray, *_: Any, **__: Any) -> np.ndarray:
        calls[0] += 1
        if calls[0] > after:
            raise error
        return value + 0 * x

    return planned


PLACES: dict[str, Callable[[Callable[..., Any]], Any]] = {
    "load": lambda f: mc.solve(MESH, tension=(1, 3), load=(f, 1)),
    "tension": lambda f: mc.solve(MESH, tension=(1, f), load=(-1, 1)),
    "height": lambda f: mc.solve(MESH, tension=(1, 3), height=f),
    "floor": lambda f: mc.solve(MESH, membranes=[{"tension": 1}], floor=f),
    "ceiling": lambda f: mc.solve(MESH, membranes=[{"tension": 1}], ceiling=f),
    "foundation": lambda f: mc.solve(MESH, membranes=[{"tension": 1, "foundation": {"west": f, "east": 1}}], floor=-1),
    "height of a curve": lambda f: mc.solve(MESH, membranes=[{"tension": 1, "height": {"left": f}}], floor=-1),
    "traction": lambda f: mc.solve(MESH, membranes=[{"tension": 1, "height": {"left": "free"}, "traction": f}], floor=-1),
    "qp": lambda f: mc.qp(MESH, tension=(1, 3), load=(1, f)),
    "at vertices": lambda f: mc.solve(MESH, tension=(1, 3), load=(f, 1), integration="vertices"),
    "with a backend": lambda f: mc.solve(MESH, tension=(1, 3), load=(f, 1), solver=zero_backend),
    "backend": lambda f: mc.solve(MESH, **PAIR, solver=f),
    "region": lambda f: MESH.with_region("a", f),
    "curve": lambda f: MESH.with_curve("a", f),
}


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("error", EXCEPTIONS, ids=lambda error: type(error).__name__)
def test_exceptions_of_callables_pass_through(error: BaseException, place: str) -> None:
    error.__traceback__ = None
    with pytest.raises(type(error)) as caught:
        PLACES[place](raising(error))
    assert caught.value is error
    names = [entry.name for entry in caught.traceback]
    assert "planned" in names, "the traceback leads into the callable"


LATE: dict[str, tuple[float, Callable[..., Any]]] = {
    "load": (-9.0, lambda f, **options: mc.solve(MESH, tension=(1, 3), load=(f, 1), **options)),
    "tension": (1.5, lambda f, **options: mc.solve(MESH, tension=(f, 3), load=(-9, 1), **options)),
    "floor": (-0.2, lambda f, **options: mc.solve(MESH, membranes=[{"tension": 1, "load": -9}], floor=f, **options)),
    "ceiling": (0.2, lambda f, **options: mc.solve(MESH, membranes=[{"tension": 1, "load": 9}], ceiling=f, **options)),
    "foundation": (2.0, lambda f, **options: mc.solve(MESH, membranes=[{"tension": 1, "load": 9, "foundation": f}], ceiling=0.2, **options)),
}


@pytest.mark.parametrize("solver", [None, zero_backend], ids=["auto", "backend"])
@pytest.mark.parametrize("place", LATE)
def test_exceptions_pass_through_whenever_they_are_raised(place: str, solver: Any) -> None:
    """Also of the last call, for the bound of the error, where the solution is there already."""
    value, solve = LATE[place]
    calls = []
    solve(lambda x, y: calls.append(len(x)) or value + 0 * x, solver=solver)
    for after in {0, 1, 2, len(calls) // 2, len(calls) - 1}:
        error = Custom(after)
        if after < len(calls):
            with pytest.raises(Custom) as caught:
                solve(raising(error, after, value), solver=solver)
            assert caught.value is error


def test_nothing_is_called_after_an_exception() -> None:
    for place, attempt in PLACES.items():
        calls = []

        def count(x: np.ndarray, y: np.ndarray, *_: Any, **__: Any) -> np.ndarray:
            calls.append(place)
            raise Custom

        with pytest.raises(Custom):
            attempt(count)
        assert len(calls) == 1, f"{place}: {len(calls)} calls"


@pytest.mark.parametrize("after", [0, 1, 2, 10])
def test_a_height_is_not_called_after_an_exception(after: int) -> None:
    """Neither for the problem, with the first call, nor for the bound of the error; also if it would not raise again."""
    calls = []

    def height(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        calls.append(len(x))
        if len(calls) == after + 1:
            raise Custom
        return 0.1 + 0 * x

    with pytest.raises(Custom):
        mc.solve(mc.Mesh.rectangle(60), tension=(1, 3), height=height)
    # Other threads may have asked before.
    assert len(calls) <= after + 1 + (os.cpu_count() or 1)


def test_callables_get_arrays_of_their_own() -> None:
    kept = []

    def greedy(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        assert x.dtype == y.dtype == np.float64
        assert x.shape == y.shape
        assert x.ndim == 1
        kept.append((x, x.copy()))
        return -15 + 0 * x

    with_load(greedy)
    for x, copied in kept:
        assert same_bits(x, copied)
        x[:] = np.nan
    assert is_same(with_load(greedy).u1, CONSTANT.u1)


def test_callables_of_loads_are_called_a_few_times_with_many_points() -> None:
    calls = []
    with_load(lambda x, y: calls.append(len(x)) or -15)
    assert len(calls) < 10


def test_a_callable_may_solve_another_problem() -> None:
    inner = []

    def nested(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        inner.append(mc.solve(SQUARE, **STACK).energy)
        return -15 + 0 * x

    found: list[mc.Solution] = []
    thread = threading.Thread(target=lambda: found.append(with_load(nested)), daemon=True)
    thread.start()
    thread.join(10)
    assert found, "it hangs"
    assert is_same(found[0].u1, CONSTANT.u1)
    assert set(inner) == {mc.solve(SQUARE, **STACK).energy}


def test_tension_may_be_any_sequence_of_two() -> None:
    expected = mc.solve(MESH, **PAIR).u1
    for tension in [1, 3], (1.0, 3.0), np.array([1, 3]), range(1, 4, 2), deque([1, "3"]):
        assert same_bits(mc.solve(MESH, **{**PAIR, "tension": tension}).u1, expected)


def test_membranes_may_be_any_mapping() -> None:
    class Lazy(Mapping[str, Any]):
        def __getitem__(self, key: str) -> Any:
            return {"tension": 1, "load": -9}[key]

        def __iter__(self) -> Any:
            return iter(["tension", "load"])

        def __len__(self) -> int:
            return 2

    expected = mc.solve(MESH, membranes=[{"tension": 1, "load": -9}], floor=-0.1).u1
    for membrane in mc.Membrane(tension=1, load=-9), Lazy(), MappingProxyType({"tension": 1, "load": -9}):
        assert same_bits(mc.solve(MESH, membranes=(membrane,), floor=-0.1).u1, expected)
        assert same_bits(mc.solve(MESH, membranes=iter([membrane]), floor=-0.1).u1, expected)


@pytest.mark.parametrize("pressed", [True, np.bool_(True)])
def test_pressed(pressed: Any) -> None:
    free = {"tension": 1, "load": -1, "height": "free"}
    with pytest.raises(mc.DataError, match="holds"):
        mc.solve(MESH, membranes=[free], floor=0)
    assert mc.solve(MESH, membranes=[{**free, "pressed": pressed}], floor=0).contact.all()


def test_a_warm_start_leads_to_the_same() -> None:
    cold = mc.solve(MESH, **PAIR)
    warm = mc.solve(MESH, **PAIR, warm_start=cold)
    assert is_same(warm.u1, cold.u1)
    assert warm.iterations <= cold.iterations


@pytest.mark.parametrize("other", [mc.solve(mc.Mesh.rectangle(3), **PAIR), mc.solve(SQUARE, **STACK), mc.solve(SQUARE, **OBSTACLE)])
def test_a_warm_start_from_elsewhere_does_no_harm(other: mc.Solution) -> None:
    try:
        found = mc.solve(MESH, **PAIR, warm_start=other).u1
    except ValueError:
        return
    assert is_same(found, mc.solve(MESH, **PAIR).u1)


def test_without_a_bound() -> None:
    solution = mc.solve(MESH, **PAIR, bound=False)
    assert solution.error_bound is None
    assert solution.error_parts is None
    assert solution.indicators is None
    assert "bound=True" in str(solution.no_error_bound)
    assert same_bits(solution.u1, mc.solve(MESH, **PAIR).u1)


def test_the_qp_has_the_solution_as_its_optimum() -> None:
    pytest.importorskip("scipy")
    for arguments in PAIR, STACK:
        program, solution = mc.qp(MESH, **arguments), mc.solve(MESH, **arguments)
        x, y = solution.x, solution.y
        assert (abs(program.P - program.P.T)).nnz == 0
        scale = abs(program.q).max()
        assert np.abs(program.P @ x + program.q - program.A.T @ y).max() < 1e-11 * scale
        assert (program.A @ x - program.b).min() > -1e-12
        assert y.min() >= 0
        energy = 0.5 * x @ (program.P @ x) + program.q @ x + program.constant
        assert energy == pytest.approx(solution.energy, rel=1e-12)


def test_a_solution_has_one_gap_or_says_how_many() -> None:
    several = mc.solve(MESH, **STACK)
    assert [gap.number for gap in several.gaps] == [1, 2]
    for name in "gap", "action", "contact":
        with pytest.raises(AttributeError, match="2 gaps"):
            getattr(several, name)
    alone = mc.solve(MESH, membranes=[{"tension": 1, "load": -1}])
    assert alone.gaps == ()
    with pytest.raises(AttributeError, match="no gap"):
        _ = alone.gap
    with pytest.raises(AttributeError, match="one membrane"):
        _ = alone.u2
    # Not -0.
    assert str(alone.contact_area) == "0.0"
    assert str(alone.total_force) == "0.0"


def test_a_start_is_of_the_same_mesh_and_membranes() -> None:
    coarse = mc.solve(mc.Mesh.rectangle(4), **PAIR)
    with pytest.raises(mc.DataError, match="no solution on this mesh") as caught:
        mc.solve(MESH, **PAIR, warm_start=coarse)
    assert caught.value.key == "warm_start"
    with pytest.raises(mc.DataError, match="no solution on this mesh"):
        mc.solve(MESH, **STACK, warm_start=mc.solve(MESH, **PAIR))
    again = mc.solve(MESH, **PAIR, warm_start=mc.solve(MESH, **PAIR))
    assert again.residual <= 1e-8


def test_there_is_an_iteration_at_least() -> None:
    with pytest.raises(mc.DataError, match="max_iterations must be positive"):
        mc.solve(MESH, **PAIR, max_iterations=0)
