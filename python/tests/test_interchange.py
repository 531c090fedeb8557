"""Meshes from other packages, solutions to other packages, and what an import costs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import membrane_contact as mc
from helpers import OBSTACLE, PAIR, PLATE, STACK, Program, is_same, read_json, run_python, same_bits

# What numpy does not cost already, milliseconds. It is a few; a busy machine may take longer, so that the best of some counts.
IMPORT_MILLISECONDS = 50
IMPORTS = 5


def counts(of: dict[str, np.ndarray]) -> dict[str, int]:
    """How many triangles or edges have each name."""
    return {name: len(members) for name, members in of.items()}


def edges(of: np.ndarray) -> set[tuple[int, ...]]:
    """Edges as sets of ends, for comparisons."""
    return {tuple(sorted(ends)) for ends in of.tolist()}


# Anything.


def test_a_mesh_is_itself(mesh: mc.Mesh) -> None:
    assert mc.Mesh.of(mesh) is mesh


@pytest.mark.parametrize("kind", [tuple, list])
def test_points_and_triangles(mesh: mc.Mesh, kind: Any) -> None:
    again = mc.Mesh.of(kind((mesh.points, mesh.triangles)))
    assert same_bits(again.points, mesh.points)
    assert same_bits(again.triangles, mesh.triangles)


@pytest.mark.parametrize("kind", [str, Path])
def test_paths(kind: Any) -> None:
    mesh, read = mc.Mesh.of(kind(PLATE)), mc.Mesh.read(PLATE)
    assert same_bits(mesh.points, read.points)
    assert counts(mesh.regions) == {"plate": 4500}
    assert set(mesh.curves) == {"outer boundary", "opening", "bolt holes"}


@pytest.mark.parametrize("junk", [None, 3, object(), {}, [], (1, 2, 3), np.zeros((3, 2)), mc, mc.Mesh, b"plate.msh", 1.5])
def test_junk_is_refused_with_a_list_of_what_may_be(junk: Any) -> None:
    with pytest.raises(TypeError, match="skfem, meshio or pyvista") as caught:
        mc.Mesh.of(junk)
    assert type(junk).__name__ in str(caught.value)


def test_pairs_that_are_no_mesh_are_refused() -> None:
    with pytest.raises(mc.DataError, match="points"):
        mc.Mesh.of((1, 2))


def test_files_that_are_not_there(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match=r"nowhere\.msh"):
        mc.Mesh.read(tmp_path / "nowhere.msh")


def test_files_that_are_no_meshes(tmp_path: Path) -> None:
    path = tmp_path / "text.msh"
    path.write_text("not a mesh", encoding="utf-8")
    with pytest.raises(ValueError, match=r"text\.msh"):
        mc.Mesh.read(path)
    with pytest.raises(OSError, match="folder|directory"):
        mc.Mesh.read(tmp_path)


# scikit-fem.


def test_meshes_of_skfem() -> None:
    skfem = pytest.importorskip("skfem")
    given = skfem.MeshTri.init_lshaped().refined(2)
    mesh = mc.Mesh.of(given)
    assert same_bits(mesh.points, given.p.T)
    assert np.array_equal(np.sort(mesh.triangles, axis=1), np.sort(given.t.T, axis=1))
    assert mesh.regions == mesh.curves == {}


def test_names_of_skfem() -> None:
    skfem = pytest.importorskip("skfem")
    given = (
        skfem.MeshTri()
        .refined(3)
        .with_subdomains({"west": lambda x: x[0] < 0.5, "south": lambda x: x[1] < 0.25})
        .with_boundaries({"left": lambda x: x[0] == 0, "top": lambda x: x[1] == 1})
    )
    mesh = mc.Mesh.of(given)
    for name in "west", "south":
        assert mesh.regions[name].tolist() == sorted(given.subdomains[name].tolist())
    for name in "left", "top":
        assert edges(mesh.curves[name]) == edges(given.facets[:, given.boundaries[name]].T)


def test_curves_of_skfem_inside_and_with_orientation() -> None:
    skfem = pytest.importorskip("skfem")
    given = skfem.MeshTri().refined(3).with_subdomains({"west": lambda x: x[0] < 0.5})
    given = given.with_boundaries({"around": given.facets_around("west"), "middle": given.facets_satisfying(lambda x: x[0] == 0.5)})
    assert counts(mc.Mesh.of(given).curves) == {"around": 24, "middle": 8}


def test_names_of_skfem_that_nothing_has_do_no_harm() -> None:
    skfem = pytest.importorskip("skfem")
    given = skfem.MeshTri().refined(2).with_subdomains({"nothing": np.array([], dtype=int), "first": np.array([0])})
    given = given.with_boundaries({"nowhere": np.array([], dtype=int), "left": lambda x: x[0] == 0})
    mesh = mc.Mesh.of(given)
    assert counts(mesh.regions) == {"first": 1}
    assert counts(mesh.curves) == {"left": 4}


def test_the_same_problem_on_a_mesh_of_skfem(mesh: mc.Mesh) -> None:
    skfem = pytest.importorskip("skfem")
    given = skfem.MeshTri(np.array(mesh.points.T), np.array(mesh.triangles.T, dtype=int))
    assert is_same(mc.solve(mc.Mesh.of(given), **PAIR).u1, mc.solve(mesh, **PAIR).u1)


@pytest.mark.parametrize("kind", ["MeshQuad", "MeshTet", "MeshLine"])
def test_other_meshes_of_skfem_are_refused(kind: str) -> None:
    skfem = pytest.importorskip("skfem")
    with pytest.raises(ValueError, match="triangles"):
        mc.Mesh.of(getattr(skfem, kind)())


# meshio.


def test_a_file_of_gmsh_by_meshio_is_the_file() -> None:
    meshio = pytest.importorskip("meshio")
    mesh, read = mc.Mesh.of(meshio.read(PLATE)), mc.Mesh.read(PLATE)
    assert same_bits(mesh.points, read.points)
    assert same_bits(mesh.triangles, read.triangles)
    assert mesh.regions.keys() == read.regions.keys()
    assert mesh.curves.keys() == read.curves.keys()
    for name in read.regions:
        assert same_bits(mesh.regions[name], read.regions[name])
    for name in read.curves:
        assert edges(mesh.curves[name]) == edges(read.curves[name])


def blocks(*cells: Any, **further: Any) -> Any:
    """A square of meshio, and a triangle at its side."""
    meshio = pytest.importorskip("meshio")
    points = [[0, 0, 2], [1, 0, 2], [1, 1, 2], [0, 1, 2], [2, 0, 2.0]]
    return meshio.Mesh(points, list(cells), **further)


def test_cell_sets_over_several_blocks() -> None:
    some, none = np.array([0]), np.array([], dtype=int)
    given = blocks(
        ("triangle", [[0, 1, 2]]),
        ("line", [[0, 1], [2, 3]]),
        ("triangle", [[0, 2, 3]]),
        cell_sets={"lower": [some, none, none], "upper": [none, none, some], "rim": [none, np.array([0, 1]), none]},
    )
    mesh = mc.Mesh.of(given)
    assert {name: members.tolist() for name, members in mesh.regions.items()} == {"lower": [0], "upper": [1]}
    assert {name: edges(members) for name, members in mesh.curves.items()} == {"rim": {(0, 1), (2, 3)}}


def test_a_plane_of_space_is_flat() -> None:
    assert mc.Mesh.of(blocks(("triangle", [[0, 1, 2]]))).points.tolist()[4] == [2.0, 0.0]


def test_no_cell_is_lost() -> None:
    """Quadrangles are part of the domain: they are cut, as in files of Gmsh, or refused."""
    given = blocks(("triangle", [[1, 4, 2]]), ("quad", [[0, 1, 2, 3]]))
    try:
        mesh = mc.Mesh.of(given)
    except ValueError:
        return
    assert len(mesh.triangles) == 3


@pytest.mark.parametrize("cells", [("quad", [[0, 1, 2, 3]]), ("line", [[0, 1]]), ("vertex", [[0]]), ("tetra", [[0, 1, 2, 3]])])
def test_meshes_of_meshio_without_triangles_are_refused(cells: Any) -> None:
    with pytest.raises(ValueError, match="triangles"):
        mc.Mesh.of(blocks(cells))


@pytest.mark.parametrize("height", [1.0, np.nan])
def test_meshes_that_are_not_plane_are_refused(height: float) -> None:
    given = blocks(("triangle", [[0, 1, 2]]))
    given.points[2, 2] = height
    with pytest.raises(ValueError, match="plane|finite"):
        mc.Mesh.of(given)


# pyvista.


def test_meshes_of_pyvista() -> None:
    pyvista = pytest.importorskip("pyvista")
    plane = pyvista.Plane(i_resolution=4, j_resolution=3).triangulate()
    mesh = mc.Mesh.of(plane)
    assert np.array_equal(mesh.points, plane.points[:, :2])
    assert len(mesh.triangles) == plane.n_cells == 24


def test_unstructured_grids_of_pyvista() -> None:
    pyvista = pytest.importorskip("pyvista")
    grid = pyvista.Plane(i_resolution=4, j_resolution=3).triangulate().cast_to_unstructured_grid()
    mesh = mc.Mesh.of(grid)
    assert np.array_equal(mesh.points, grid.points[:, :2])
    assert len(mesh.triangles) == grid.n_cells == 24


def test_no_cell_of_pyvista_is_lost() -> None:
    pyvista = pytest.importorskip("pyvista")
    points = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0.0]]
    mixed = pyvista.PolyData(points, faces=[3, 1, 4, 2, 4, 0, 1, 2, 3])
    try:
        mesh = mc.Mesh.of(mixed)
    except ValueError:
        return
    assert len(mesh.triangles) == 3


@pytest.mark.parametrize("make", ["Plane", "Sphere"])
def test_other_data_sets_of_pyvista_are_refused(make: str) -> None:
    pyvista = pytest.importorskip("pyvista")
    with pytest.raises(ValueError, match=r"triangulate\(\)|plane"):
        mc.Mesh.of(getattr(pyvista, make)())


# Solutions.

SOLVED = {"pair": PAIR, "obstacle": OBSTACLE, "stack": STACK, "alone": {"membranes": [mc.Membrane(tension=1, load=-1)]}}


@pytest.fixture(params=SOLVED)
def solved(request: pytest.FixtureRequest, mesh: mc.Mesh) -> mc.Solution:
    """A solution with one gap, with several, with none."""
    return mc.solve(mesh, **SOLVED[request.param])


def assert_has_its_fields(data: Any, solution: mc.Solution) -> None:
    for i, u in enumerate(solution.u, start=1):
        assert same_bits(data[f"u{i}"], u)
    for gap in solution.gaps:
        number = f"_{gap.number}" if len(solution.gaps) > 1 else ""
        assert same_bits(data[f"gap{number}"], gap.gap)
        assert same_bits(data[f"lambda{number}"], gap.action)
        assert np.array_equal(data[f"contact{number}"], gap.contact)


def test_to_meshio(solved: mc.Solution) -> None:
    pytest.importorskip("meshio")
    made = solved.to_meshio()
    assert same_bits(made.points[:, :2], solved.mesh.points)
    assert np.array_equal(made.cells_dict["triangle"], solved.mesh.triangles)
    assert_has_its_fields(made.point_data, solved)


def test_to_meshio_and_a_file(solution: mc.Solution, tmp_path: Path) -> None:
    meshio = pytest.importorskip("meshio")
    solution.to_meshio().write(tmp_path / "solution.vtu")
    assert_has_its_fields(meshio.read(tmp_path / "solution.vtu").point_data, solution)


def test_to_pyvista(solved: mc.Solution) -> None:
    pytest.importorskip("pyvista")
    made = solved.to_pyvista()
    assert made.n_cells == len(solved.mesh.triangles)
    assert np.array_equal(made.points[:, :2], solved.mesh.points)
    assert made.area == pytest.approx(1.0)
    assert_has_its_fields(made.point_data, solved)


@pytest.mark.parametrize("package", ["meshio", "pyvista"])
def test_there_and_back(package: str, solution: mc.Solution) -> None:
    pytest.importorskip(package)
    again = mc.Mesh.of(getattr(solution, f"to_{package}")())
    assert same_bits(again.points, solution.mesh.points)
    assert same_bits(again.triangles, solution.mesh.triangles)


@pytest.mark.parametrize(
    ("arguments", "case"),
    [
        (PAIR, 'membranes = { tension = [1, 3], load = [-15, "10*sin(pi*x)"], height = 0.1 }'),
        (OBSTACLE, "membrane = [{ tension = 1, load = -10 }]\nobstacle = { floor = -0.3 }"),
        (
            STACK,
            'membrane = [{ tension = 1, load = "-9 - 8*x", height = 0.12 }, '
            '{ tension = 2, load = "-6 + 30*sin(2*pi*x)*sin(pi*y)" }]\nobstacle = { floor = -0.12 }',
        ),
    ],
    ids=["pair", "obstacle", "stack"],
)
def test_arrays_are_those_of_the_file_of_the_program(
    arguments: dict[str, Any], case: str, mesh: mc.Mesh, program: Program
) -> None:
    meshio = pytest.importorskip("meshio")
    folder = program.solve(f'{case}\ndomain = {{ shape = "square" }}\nmesh = {{ cells = 8 }}')
    written, made = meshio.read(folder / "solution.vtu"), mc.solve(mesh, **arguments).to_meshio()
    for name, values in made.point_data.items():
        assert np.array_equal(values, written.point_data[name]), name
    assert set(made.point_data) == set(written.point_data)


# Pictures and notebooks.


@pytest.mark.parametrize("field", ["u1", "u2", "gap", "action", "contact"])
def test_plots(field: str, solution: mc.Solution) -> None:
    pyplot = pytest.importorskip("matplotlib.pyplot")
    axes = solution.plot(field)
    axes.figure.canvas.draw()
    (drawn,) = axes.collections
    values = np.asarray(getattr(solution, field), float)
    if field != "contact":
        assert same_bits(np.asarray(drawn.get_array(), float).ravel(), values)
    else:
        assert drawn.get_array().max() == 1
    assert axes.get_xlabel() == "x"
    assert axes.get_ylabel() == "y"
    assert axes.get_aspect() in (1, "equal")
    pyplot.close("all")


def test_plots_go_into_the_axes_that_are_given(solution: mc.Solution) -> None:
    pyplot = pytest.importorskip("matplotlib.pyplot")
    figure, (left, right) = pyplot.subplots(1, 2)
    assert solution.plot("u1", ax=right) is right
    assert not left.collections
    assert pyplot.get_fignums() == [figure.number]
    pyplot.close("all")


def test_the_default_plot_is_the_gap(solution: mc.Solution) -> None:
    pyplot = pytest.importorskip("matplotlib.pyplot")
    (drawn,) = solution.plot().collections
    assert same_bits(np.asarray(drawn.get_array(), float).ravel(), np.asarray(solution.gap))
    pyplot.close("all")


def test_plots_of_several_gaps_have_numbers(mesh: mc.Mesh) -> None:
    pyplot = pytest.importorskip("matplotlib.pyplot")
    stack = mc.solve(mesh, **STACK)
    with pytest.raises(ValueError, match="there is no field 'gap'") as caught:
        stack.plot("gap")
    # The message says what there is.
    names = [name.strip() for name in str(caught.value).rpartition("are ")[2].split(",")]
    assert len(names) == 2 + 2 * 3
    for name in names:
        stack.plot(name)
    pyplot.close("all")


@pytest.mark.parametrize("field", ["u3", "", "nothing", "u0", "u"])
def test_unknown_fields_are_refused(field: str, solution: mc.Solution) -> None:
    pyplot = pytest.importorskip("matplotlib.pyplot")
    with pytest.raises(ValueError, match="u1, u2, gap, action, contact"):
        solution.plot(field)
    # Nor is there an empty picture.
    assert pyplot.get_fignums() == []


def test_html_is_one_well_formed_table(solved: mc.Solution) -> None:
    from xml.etree import ElementTree

    table = ElementTree.fromstring(solved._repr_html_())
    assert table.tag == "table"
    rows = {row[0].text: row[1].text for row in table}
    assert rows["vertices"] == "81"
    assert float(rows["energy"]) == pytest.approx(solved.energy, rel=1e-8)
    assert float(rows["total force"]) == pytest.approx(solved.total_force, rel=1e-8)
    assert "in the energy norm" in rows["error"]


def test_html_escapes_names_and_says_why_there_is_no_bound(mesh: mc.Mesh) -> None:
    backend = lambda P, q, A, b, **_: (0 * q, 0 * b)  # noqa: E731
    backend.__name__ = "<b>&"
    html = mc.solve(mesh, **PAIR, solver=backend, bound=False)._repr_html_()
    assert "<b>" not in html
    assert "&lt;b&gt;&amp;" in html
    assert "bound=True" in html


def test_representations(solution: mc.Solution, mesh: mc.Mesh) -> None:
    assert repr(mesh) == "<Mesh: 81 vertices, 128 triangles>"
    assert repr(solution).startswith("<Solution: 81 vertices, contact area 0.")
    assert repr(solution.gaps[0]).startswith("<Gap 1: contact area 0.")
    pytest.importorskip("scipy")
    assert repr(mc.qp(mesh, **PAIR)) == "<Qp: 98 variables, 49 constraints>"


def test_numbers_go_into_json(solution: mc.Solution, program: Program) -> None:
    told = {
        name: getattr(solution, name)
        for name in ("energy", "contact_area", "total_force", "error_bound", "error_parts", "residuals", "seconds", "warnings")
    }
    assert json.loads(json.dumps(told)) == told
    folder = program.solve(
        """
        membranes = { tension = [1, 3], load = [-15, "10*sin(pi*x)"], height = 0.1 }
        domain = { shape = "square" }
        mesh = { cells = 8 }
        """
    )
    assert read_json(folder / "summary.json")["error_parts"] == told["error_parts"]


# Imports.

IMPORT = """
import time
import numpy
start = time.perf_counter()
import membrane_contact
print(1000 * (time.perf_counter() - start))
"""


def test_an_import_costs_little_beyond_that_of_numpy() -> None:
    assert min(float(run_python(IMPORT).output) for _ in range(IMPORTS)) < IMPORT_MILLISECONDS


def test_an_import_says_nothing_and_brings_nothing_heavy() -> None:
    script = """
import sys
import membrane_contact
heavy = {"scipy", "matplotlib", "meshio", "pyvista", "skfem", "qpsolvers"} & set(sys.modules)
sys.exit(", ".join(heavy) if heavy else 0)
"""
    ended = run_python(script, "-W", "error")
    assert (ended.code, ended.output, ended.errors) == (0, "", "")


def test_solving_needs_numpy_alone() -> None:
    script = """
import sys
for name in "scipy", "matplotlib", "meshio", "pyvista", "skfem", "qpsolvers":
    sys.modules[name] = None
import membrane_contact as mc
solution = mc.solve(mc.Mesh.rectangle(8), tension=(1, 3), load=(-15, lambda x, y: 10 * x), height=0.1)
print(solution.contact.any(), len(solution._repr_html_()) > 0)
for use in solution.to_meshio, solution.to_pyvista, solution.plot:
    try:
        use()
    except ImportError as error:
        print(error.name)
"""
    ended = run_python(script)
    assert ended.output.splitlines()[0] == "True True", str(ended)
    assert [name.partition(".")[0] for name in ended.output.splitlines()[1:]] == ["meshio", "pyvista", "matplotlib"]


def test_all_names_are_there() -> None:
    assert set(mc.__all__) <= set(dir(mc))
    assert mc.__version__.count(".") == 2
    for name in mc.__all__:
        assert getattr(mc, name).__doc__ is not None, name
    for error in mc.ContactError, mc.BackendError, mc.CertificationError, mc.MeshError, mc.DataError:
        assert error.__module__ == "membrane_contact"


def test_the_example_of_the_package() -> None:
    import doctest

    failed, attempted = doctest.testmod(mc)
    assert attempted >= 3
    assert failed == 0


# Copies, and what was taken silently once.


def test_copies_are_the_same_object(solution: mc.Solution) -> None:
    import copy

    for original in solution, solution.mesh:
        assert copy.copy(original) is original
        assert copy.deepcopy([original])[0] is original


@pytest.mark.parametrize("membranes", [1, 3])
def test_stacks_are_drawn_without_a_name(membranes: int) -> None:
    pytest.importorskip("matplotlib")
    sheets = [mc.Membrane(tension=1, load=-1)] * membranes
    axes = mc.solve(mc.Mesh.rectangle(4), membranes=sheets).plot()
    assert axes.figure.axes[1].get_ylabel() == "u1"
