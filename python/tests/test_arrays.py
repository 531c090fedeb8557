"""Arrays from numpy, whatever they look like, and arrays to numpy: right or refused, never a crash, and views without copies."""

from __future__ import annotations

import gc
import sys
import warnings
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

import membrane_contact as mc
from helpers import PAIR, STACK, is_same, same_bits, zero_backend

# Examples take milliseconds, but the machine may be busy; with the same examples each time.
FEW = settings(max_examples=60, deadline=None, derandomize=True, database=None, suppress_health_check=list(HealthCheck))

#: What may be said of bad input. A panic of Rust is a `BaseException`, and none of these.
REFUSED = (ValueError, TypeError, OverflowError)

SQUARE = mc.Mesh.rectangle(3)
POINTS = np.array(SQUARE.points)
TRIANGLES = np.array(SQUARE.triangles).astype(np.int64)

#: Where all coordinates are numbers that even 16 bits have.
DYADIC = mc.Mesh.rectangle(4)

FLOATS = ["f8", ">f8", "f4", ">f4", "f2", "longdouble"]
INTEGERS = ["i8", ">i8", "i4", ">i4", "u4", "u8", ">u8", "i2", "u1"]

LAYOUTS = ["C", "F", "strided", "reversed", "readonly", "unaligned", "list", "tuples", "subclass"]


class Labelled(np.ndarray):
    """An array of another class."""


def laid_out(array: np.ndarray, layout: str) -> Any:
    """The same numbers in another layout."""
    if layout == "F":
        return np.asfortranarray(array)
    if layout == "strided":
        wide = np.zeros((3 * array.shape[0], *(2 * n for n in array.shape[1:])), array.dtype)
        inside = (slice(1, None, 3), *(slice(None, None, 2) for _ in array.shape[1:]))
        wide[inside] = array
        return wide[inside]
    if layout == "reversed":
        return np.ascontiguousarray(array[::-1])[::-1]
    if layout == "readonly":
        array = array.copy()
        array.flags.writeable = False
        return array
    if layout == "unaligned":
        raw = np.zeros(array.nbytes + 1, np.uint8)[1:]
        raw[:] = np.frombuffer(array.tobytes(), np.uint8)
        return raw.view(array.dtype).reshape(array.shape)
    if layout == "list":
        return array.tolist()
    if layout == "tuples":
        return tuple(map(tuple, array.tolist())) if array.ndim == 2 else tuple(array.tolist())
    if layout == "subclass":
        return array.view(Labelled)
    return array


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("dtype", FLOATS)
def test_points_of_any_dtype_and_layout(dtype: str, layout: str) -> None:
    points = laid_out(np.array(DYADIC.points).astype(dtype), layout)
    assert same_bits(mc.Mesh(points, DYADIC.triangles).points, DYADIC.points)


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("dtype", INTEGERS)
def test_triangles_of_any_dtype_and_layout(dtype: str, layout: str) -> None:
    triangles = laid_out(TRIANGLES.astype(dtype), layout)
    assert np.array_equal(mc.Mesh(POINTS, triangles).triangles, TRIANGLES)


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("dtype", FLOATS + ["i4", ">i2"])
def test_loads_of_any_dtype_and_layout(dtype: str, layout: str) -> None:
    values = -np.arange(len(POINTS)).astype(dtype)
    expected = mc.solve(SQUARE, tension=(1, 3), load=(-np.arange(len(POINTS), dtype=float), 5)).u1
    assert same_bits(mc.solve(SQUARE, tension=(1, 3), load=(laid_out(values, layout), 5)).u1, expected)


@FEW
@given(data=st.data())
def test_points_and_triangles_in_any_order(data: st.DataObject) -> None:
    vertices = np.array(data.draw(st.permutations(range(len(POINTS)))))
    rows = np.array(data.draw(st.permutations(range(len(TRIANGLES)))))
    turns = np.array(data.draw(st.lists(st.integers(0, 5), min_size=len(rows), max_size=len(rows))))
    corners = np.array([[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]])[turns]
    triangles = np.take_along_axis(np.argsort(vertices)[TRIANGLES][rows], corners, axis=1)
    mesh = mc.Mesh(POINTS[vertices], triangles)
    assert same_bits(mesh.points, POINTS[vertices])
    assert np.array_equal(np.sort(mesh.triangles, axis=1), np.sort(triangles, axis=1))
    assert np.array_equal(mesh.kind, np.asarray(SQUARE.kind)[vertices])
    solution = mc.solve(mesh, **PAIR)
    expected = mc.solve(SQUARE, **PAIR)
    assert is_same(solution.u1, expected.u1[vertices])
    assert np.array_equal(solution.contact, expected.contact[vertices])


ANY_ARRAY = hnp.arrays(
    dtype=st.one_of(
        hnp.floating_dtypes(endianness="?"),
        hnp.integer_dtypes(endianness="?"),
        hnp.unsigned_integer_dtypes(endianness="?"),
        hnp.boolean_dtypes(),
        hnp.complex_number_dtypes(endianness="?"),
        hnp.unicode_string_dtypes(max_len=3),
        hnp.byte_string_dtypes(max_len=3),
        hnp.datetime64_dtypes(),
        hnp.timedelta64_dtypes(),
    ),
    shape=hnp.array_shapes(min_dims=0, max_dims=3, min_side=0, max_side=4),
)

ANYTHING = st.one_of(
    ANY_ARRAY,
    st.none(),
    st.booleans(),
    st.integers(-(10**25), 10**25),
    st.floats(),
    st.complex_numbers(),
    st.text(max_size=4),
    st.binary(max_size=4),
    st.lists(st.one_of(st.integers(-3, 3), st.floats(), st.text(max_size=2), st.lists(st.integers(-1, 3), max_size=3)), max_size=4),
    st.dictionaries(st.one_of(st.text(max_size=5), st.integers()), st.one_of(st.floats(), st.text(max_size=3)), max_size=2),
    st.just(object()),
    st.just(np.ma.masked_all(3)),
    st.just(np.array([{}, None])),
    st.just(range(3)),
    st.just({1, 2}),
    st.just(float),
    st.just(np.float64),
)


def right_or_refused(call: Any, *refused: type[BaseException]) -> None:
    """It returns or says why not."""
    with warnings.catch_warnings():
        # That numpy has something to say is no crash.
        warnings.simplefilter("ignore")
        try:
            call()
        except (*REFUSED, *refused) as error:
            assert str(error)


@FEW
@given(points=ANYTHING, triangles=ANYTHING)
def test_a_mesh_of_anything(points: Any, triangles: Any) -> None:
    right_or_refused(lambda: mc.Mesh(points, triangles))
    right_or_refused(lambda: mc.Mesh(points, TRIANGLES))
    right_or_refused(lambda: mc.Mesh(POINTS, triangles))


@FEW
@given(
    triangles=hnp.arrays(
        hnp.integer_dtypes(endianness="?"),
        st.tuples(st.integers(0, 6), st.just(3)),
        elements=st.one_of(st.integers(-2, 17), st.integers(-(2**7), 2**7 - 1)),
    )
)
def test_a_mesh_of_any_numbers_of_vertices(triangles: np.ndarray) -> None:
    right_or_refused(lambda: mc.Mesh(POINTS, triangles))


@FEW
@given(points=hnp.arrays("f8", (len(POINTS), 2)))
def test_a_mesh_of_any_points(points: np.ndarray) -> None:
    right_or_refused(lambda: mc.solve(mc.Mesh(points, TRIANGLES), **PAIR), mc.ContactError)


@FEW
@given(anything=ANYTHING)
def test_parts_of_a_mesh_of_anything(anything: Any) -> None:
    right_or_refused(lambda: SQUARE.with_region("a", anything))
    right_or_refused(lambda: SQUARE.with_view("a", anything))
    right_or_refused(lambda: SQUARE.with_view("a", anything, on="triangles"))
    right_or_refused(lambda: SQUARE.with_curve("a", anything), AttributeError)
    right_or_refused(lambda: mc.Mesh.of(anything), OSError)
    right_or_refused(lambda: mc.Mesh.polygon(anything, size=0.5))


@FEW
@given(anything=ANYTHING)
def test_data_of_anything(anything: Any) -> None:
    right_or_refused(lambda: mc.solve(SQUARE, tension=(anything, 1), load=(-1, 1)), mc.ContactError)
    right_or_refused(lambda: mc.solve(SQUARE, tension=(1, 1), load=(anything, 1)), mc.ContactError)
    right_or_refused(lambda: mc.solve(SQUARE, tension=(1, 1), height=anything), mc.ContactError)
    right_or_refused(lambda: mc.solve(SQUARE, tension=anything, load=anything), mc.ContactError)
    right_or_refused(lambda: mc.solve(SQUARE, membranes=anything), mc.ContactError)
    membrane = {"tension": 1, "load": -9, "height": {"left": "free"}, "traction": anything, "foundation": anything}
    right_or_refused(lambda: mc.solve(SQUARE, membranes=[membrane], floor=anything), mc.ContactError)
    right_or_refused(lambda: mc.solve(SQUARE, **PAIR, tolerance=anything), mc.ContactError)
    right_or_refused(lambda: mc.solve(SQUARE, **PAIR, solver=anything), mc.ContactError)
    right_or_refused(lambda: mc.solve(SQUARE, **PAIR, time_limit=anything), mc.ContactError)
    right_or_refused(lambda: mc.solve(SQUARE, **PAIR, max_iterations=anything), mc.ContactError)
    right_or_refused(lambda: mc.solve(SQUARE, **PAIR, warm_start=anything), mc.ContactError)


@FEW
@given(x=ANYTHING, y=ANYTHING)
def test_answers_of_a_backend_of_anything(x: Any, y: Any) -> None:
    right_or_refused(lambda: mc.solve(SQUARE, **PAIR, solver=lambda *_, **__: x), mc.ContactError)
    right_or_refused(lambda: mc.solve(SQUARE, **PAIR, solver=lambda *_, **__: (x, y), polish=False), mc.ContactError)


@FEW
@given(
    x=hnp.arrays("f8", 8),
    y=hnp.arrays("f8", 4),
    polish=st.booleans(),
)
def test_numbers_of_a_backend_are_never_believed(x: np.ndarray, y: np.ndarray, polish: bool) -> None:
    expected = mc.solve(SQUARE, **PAIR).u1
    try:
        found = mc.solve(SQUARE, **PAIR, solver=lambda *_, **__: (x, y), polish=polish).u1
    except mc.ContactError:
        return
    # What is certified at 1e-8 is as near as that times the condition of so few unknowns.
    assert np.abs(found - expected).max() < 1e-6


@pytest.mark.parametrize(
    ("vertex", "triangle"), [(-1, 0), (16, 0), (2**40, 0), (-(2**63), 5), (2**63 - 1, 17)]
)
def test_a_vertex_that_is_not_there_is_named(vertex: int, triangle: int) -> None:
    triangles = TRIANGLES.copy()
    triangles[triangle, 1] = vertex
    with pytest.raises(mc.MeshError) as caught:
        mc.Mesh(POINTS, triangles)
    assert caught.value.triangle == triangle
    assert caught.value.vertices == [vertex]
    assert f"vertex {vertex}" in str(caught.value)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e300])
def test_a_point_that_is_no_point_is_named(value: float) -> None:
    points = POINTS.copy()
    points[7, 1] = value
    with pytest.raises(mc.MeshError) as caught:
        mc.Mesh(points, TRIANGLES)
    assert caught.value.triangle is None
    assert caught.value.vertices == [7]


@pytest.mark.parametrize(
    ("points", "triangles", "key"),
    [
        (POINTS[:, :1], TRIANGLES, "points"),
        (POINTS[:, 0], TRIANGLES, "points"),
        (POINTS[None], TRIANGLES, "points"),
        (np.column_stack([POINTS, POINTS[:, 0]]), TRIANGLES, "points"),
        (POINTS + 1j, TRIANGLES, "points"),
        (POINTS.astype(str), TRIANGLES, "points"),
        (POINTS.astype("m8[s]"), TRIANGLES, "points"),
        ([[0, 0], [1]], TRIANGLES, "points"),
        (None, TRIANGLES, "points"),
        (POINTS, TRIANGLES[:, :2], "triangles"),
        (POINTS, TRIANGLES.ravel(), "triangles"),
        (POINTS, TRIANGLES.astype(float), "triangles"),
        (POINTS, TRIANGLES + 0.5, "triangles"),
        (POINTS, TRIANGLES.astype(str), "triangles"),
        (POINTS, [[0, 1, 10**30]], "triangles"),
        (POINTS, "012", "triangles"),
    ],
)
def test_wrong_shapes_and_dtypes_name_the_array(points: Any, triangles: Any, key: str) -> None:
    with pytest.raises(mc.DataError, match=key) as caught:
        mc.Mesh(points, triangles)
    assert caught.value.key == key


@pytest.mark.parametrize("points", [[], np.zeros((0, 2)), POINTS])
@pytest.mark.parametrize("triangles", [[], np.zeros((0, 3)), np.zeros((0, 3), int)])
def test_an_empty_mesh_is_refused(points: Any, triangles: Any) -> None:
    with pytest.raises((mc.MeshError, mc.DataError)):
        mc.Mesh(points, triangles)


@pytest.mark.parametrize(
    ("triangles", "triangle"),
    [([[0, 1, 4], [0, 1, 1]], 1), ([[0, 1, 4], [1, 5, 4], [0, 1, 2]], 2), ([[0, 1, 4], [4, 0, 1]], 0)],
)
def test_bad_triangles_are_numbered(triangles: list[list[int]], triangle: int) -> None:
    with pytest.raises(mc.MeshError) as caught:
        mc.Mesh(POINTS, triangles)
    assert caught.value.triangle == triangle


def test_what_is_given_is_copied() -> None:
    points, triangles = POINTS.copy(), TRIANGLES.copy()
    mesh = mc.Mesh(points, triangles)
    points[:] = np.nan
    triangles[:] = -1
    assert same_bits(mesh.points, POINTS)
    assert np.array_equal(mesh.triangles, TRIANGLES)


@pytest.mark.parametrize(
    "load",
    [
        np.zeros(len(POINTS) - 1),
        np.zeros(len(POINTS) + 1),
        np.zeros((len(POINTS), 1)),
        np.zeros(len(POINTS)) + 1j,
        np.zeros(len(POINTS), dtype=object),
        np.full(len(POINTS), "1"),
        np.full(len(POINTS), b"1"),
        ["-15"] * len(POINTS),
        [-15, "x"],
        [],
        [[-15]],
        None,
        b"-15",
        1j,
        np.complex128(-15 + 1j),
        np.array(-15 + 1j),
        10**400,
        object(),
    ],
    ids=lambda value: f"{type(value).__name__}-{getattr(value, 'dtype', '')}-{np.shape(value)}",
)
@pytest.mark.filterwarnings("ignore::numpy.exceptions.ComplexWarning" if hasattr(np, "exceptions") else "ignore")
def test_wrong_loads_are_refused_by_name(load: Any) -> None:
    with pytest.raises(mc.DataError) as caught:
        mc.solve(SQUARE, tension=(1, 3), load=(load, 5))
    assert caught.value.key == "load[0]"
    assert "load[0]" in str(caught.value)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("as_array", [False, True])
def test_loads_that_are_not_finite_are_refused(value: float, as_array: bool) -> None:
    load = np.where(np.arange(len(POINTS)) == 7, value, 1.0) if as_array else value
    with pytest.raises(mc.DataError, match="load f1 is (NaN|inf|-inf)"):
        mc.solve(SQUARE, tension=(1, 3), load=(load, 5))


def test_arrays_of_as_many_vertices_as_triangles_are_ambiguous() -> None:
    # A ring without interior vertices.
    points = [[0, 0], [4, 0], [0, 4], [1, 1], [1.5, 1], [1, 1.5]]
    ring = mc.Mesh(points, [[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]])
    count = len(ring.points)
    assert count == len(ring.triangles)
    with pytest.raises(mc.DataError, match="with_view"):
        mc.solve(ring, tension=(1, 3), load=(np.zeros(count), 0))


VIEWS = {
    "mesh.points": lambda solution: solution.mesh.points,
    "mesh.triangles": lambda solution: solution.mesh.triangles,
    "mesh.kind": lambda solution: solution.mesh.kind,
    "u1": lambda solution: solution.u1,
    "u2": lambda solution: solution.u2,
    "u": lambda solution: solution.u[1],
    "gap": lambda solution: solution.gap,
    "action": lambda solution: solution.action,
    "contact": lambda solution: solution.contact,
    "indicators": lambda solution: solution.indicators,
    "gaps[0].gap": lambda solution: solution.gaps[0].gap,
    "gaps[0].action": lambda solution: solution.gaps[0].action,
    "gaps[0].contact": lambda solution: solution.gaps[0].contact,
}


def pair() -> mc.Solution:
    return mc.solve(mc.Mesh.rectangle(8), **PAIR)


def pair_of_a_stack() -> mc.Solution:
    """The same attributes, kept elsewhere."""
    free = mc.Membrane(tension=1, load=-15, height={"left": "free", "elsewhere": 0.1})
    return mc.solve(mc.Mesh.rectangle(8), membranes=[free, mc.Membrane(tension=3, load=5)])


@pytest.mark.parametrize("solve", [pair, pair_of_a_stack])
@pytest.mark.parametrize("name", VIEWS)
def test_views_are_read_only_and_no_copies(name: str, solve: Any) -> None:
    solution, get = solve(), VIEWS[name]
    view = get(solution)
    assert not view.flags.writeable
    assert not view.flags.owndata
    with pytest.raises(ValueError, match="read-only|WRITEABLE"):
        view[0] = view[-1]
    with pytest.raises(ValueError):
        view.flags.writeable = True
    assert np.shares_memory(view, get(solution))


@pytest.mark.parametrize("solve", [pair, pair_of_a_stack])
@pytest.mark.parametrize("name", VIEWS)
def test_views_outlive_their_owner(name: str, solve: Any) -> None:
    solution = solve()
    view = VIEWS[name](solution)
    part = view[3:]
    kept = np.array(view)
    del solution, view
    gc.collect()
    # What is freed is used again.
    _ = [solve() for _ in range(5)]
    assert same_bits(part, kept[3:])


def test_views_let_go_of_their_owner() -> None:
    solution = pair()
    before = sys.getrefcount(solution)
    views = [VIEWS[name](solution) for name in VIEWS]
    assert sys.getrefcount(solution) > before
    del views
    gc.collect()
    assert sys.getrefcount(solution) == before


def test_force_of_a_gap_is_read_only_for_pairs_and_stacks() -> None:
    for solution in pair(), pair_of_a_stack():
        assert not solution.gaps[0].force.flags.writeable


def test_parts_of_a_mesh_are_copies() -> None:
    mesh = SQUARE.with_region("a", [0, 1])
    mesh.regions["a"][:] = 5
    mesh.curves["left"][:] = 5
    assert mesh.regions["a"].tolist() == [0, 1]
    assert mesh.curves["left"].tolist() == [[0, 4], [4, 8], [8, 12]]


def test_answers_are_copies() -> None:
    solution = pair()
    solution.x[:] = 7
    solution.y[:] = 7
    assert solution.x.max() < 1
    assert (solution.y >= 0).all()
    assert solution.u1.max() < 1


def test_views_of_a_solution_go_back_in_as_data() -> None:
    first = pair()
    mesh = first.mesh
    again = mc.solve(mesh, membranes=[mc.Membrane(tension=1, load=-15, height=first.u1)], floor=first.u2)
    # The upper membrane over what the lower one is, held where it is held.
    assert is_same(again.u1, first.u1)


def test_views_of_one_solution_from_many_threads() -> None:
    from concurrent.futures import ThreadPoolExecutor

    solution = mc.solve(mc.Mesh.rectangle(8), **STACK)

    def look(_: int) -> float:
        return sum(float(gap.gap.sum() + gap.action.sum()) for gap in solution.gaps) + float(solution.u1.sum())

    with ThreadPoolExecutor(8) as pool:
        assert len(set(pool.map(look, range(400)))) == 1


def test_a_view_that_a_backend_answers_with() -> None:
    kept = []

    def backend(P: Any, q: Any, A: Any, b: Any, **_: Any) -> tuple[Any, Any]:
        kept[:] = [q, b]
        return zero_backend(P, q, A, b)

    pair_solved = mc.solve(SQUARE, **PAIR, solver=backend)
    q = kept[0].copy()
    gc.collect()
    assert same_bits(kept[0], q)
    assert pair_solved.solver == "backend"


def test_masked_values_are_no_numbers() -> None:
    values = np.ma.masked_less(np.arange(81.0), 3)
    with pytest.raises(mc.DataError, match="masked") as caught:
        mc.solve(mc.Mesh.rectangle(8), tension=(1, 3), load=(values, 0))
    assert caught.value.key == "load[0]"
    # Nothing is hidden here.
    whole = np.ma.masked_less(np.full(81, -15.0), -20)
    mc.solve(mc.Mesh.rectangle(8), tension=(1, 3), load=(whole, 0))


def test_numbers_of_vertices_are_signed() -> None:
    mesh = mc.Mesh.rectangle(2)
    for numbers in mesh.triangles, mesh.curves["left"]:
        assert (numbers - numbers.max() - 1).max() == -1
    assert not mesh.triangles.flags.writeable
