"""The package and the program have the same numbers, to the last bit; and the package has the program."""

from __future__ import annotations

import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import membrane_contact as mc
from helpers import PLATE, Program, environment, interrupt, package_program, read_json, same_bits, start_python, write_gmsh
from helpers import TIMEOUT_SECONDS

# What is told of both pieces of work, in `summary.json` and as attributes of `Solution`.
SAME = {
    "backend": "solver",
    "status": "status",
    "choice": "choice",
    "tolerance": "tolerance",
    "iterations": "iterations",
    "energy": "energy",
    "error_bound": "error_bound",
    "error_parts": "error_parts",
    "energy_norm": "energy_norm",
    "warnings": "warnings",
    "residual_beyond_rounding": "residual",
}

# The waters on both sides of a dam.
DAM = {"left": "(24 - y)^2/2", "right": "max(0, 4 - y)^2/2", "bottom": "288 - 17.5*x"}


def square_pair() -> mc.Solution:
    return mc.solve(mc.Mesh.rectangle(20), tension=(1, 3), load=(-15, "10*sin(pi*x)"), height="0.1 + 0.05*x")


def crossed_rectangle_pair() -> mc.Solution:
    mesh = mc.Mesh.rectangle(12, 6, lower=(-1, 0), upper=(1, 1), pattern="crossed")
    return mc.solve(mesh, tension=(2, 1), load=("-8 - x", 3), height=0.05)


def disk_pair() -> mc.Solution:
    return mc.solve(mc.Mesh.disk(6).refined(1), tension=(1, 2), load=(-6, "4*x"), height=0.1)


def l_shape_pair() -> mc.Solution:
    mesh = mc.Mesh.l_shape(10, half_width=0.75)
    return mc.solve(mesh, tension=(1, 3), load=("-15*exp(-x^2)", 2), height="0.02 + abs(x*y)")


def polygon_floor() -> mc.Solution:
    mesh = mc.Mesh.polygon([[0, 0], [3, 0], [3, 2], [0, 2]], [[[1, 0.5], [1.5, 1.5], [2, 0.5]]], size=0.15)
    membrane = mc.Membrane(tension="1 + 0.5*x", load=-7, height={"hole 1": 0.1}, foundation=0.5)
    return mc.solve(mesh, membranes=[membrane], floor="-0.2 + 0.05*y")


def ceiling() -> mc.Solution:
    membrane = mc.Membrane(tension=1, load=5)
    mesh = mc.Mesh.rectangle(21)
    return mc.solve(mesh, membranes=[membrane], ceiling="min(min(x, 1 - x), min(y, 1 - y))", integration="vertices")


def stack_of_three() -> mc.Solution:
    membranes = [
        mc.Membrane(tension=1, load="-9 - 8*x", height=0.12),
        mc.Membrane(tension=2, load="-6 + 30*sin(2*pi*x)*sin(pi*y)", height=0.06),
        mc.Membrane(tension=1.5, load="-7 + 14*x"),
    ]
    return mc.solve(mc.Mesh.rectangle(24), membranes=membranes, floor="-0.12 + 0.06*x", ceiling=0.5)


def free_edges() -> mc.Solution:
    upper = mc.Membrane(tension=1, load=-2, height={"right": "free", "top": "free"}, traction={"right": -1, "top": "0.5*x"})
    lower = mc.Membrane(tension=1, load=2)
    return mc.solve(mc.Mesh.rectangle(16), membranes=[upper, lower])


def pressed() -> mc.Solution:
    upper = mc.Membrane(tension=1, load="-1 - x", height="free", pressed=True)
    return mc.solve(mc.Mesh.rectangle(10), membranes=[upper], floor="0.1*x")


def plate_regions() -> mc.Solution:
    membrane = mc.Membrane(tension={"plate": "40 + x"}, load=-600, height={"opening": "free", "bolt holes": 0.1})
    return mc.solve(mc.Mesh.read(PLATE), membranes=[membrane], floor={"plate": -0.5})


def dam() -> mc.Solution:
    mesh = mc.Mesh.rectangle(16, 16, upper=(16, 24))
    membrane = mc.Membrane(tension=1, load=-1, height=DAM)
    return mc.solve(mesh, membranes=[membrane], floor=0, integration="vertices")


def automatic_tolerance() -> mc.Solution:
    mesh = mc.Mesh.rectangle(48)
    return mc.solve(mesh, tension=(1, 3), load=(-15, 10), height=0.1, tolerance="auto", solver="multigrid")


def clarabel_without_polish() -> mc.Solution:
    mesh = mc.Mesh.rectangle(10)
    return mc.solve(mesh, tension=(1, 3), load=(-15, 10), height=0.1, solver="clarabel", polish=False, tolerance=1e-6)


CASES: list[tuple[Callable[[], mc.Solution], str]] = [
    (
        square_pair,
        """
        membranes = { tension = [1.0, 3.0], load = [-15.0, "10*sin(pi*x)"], height = "0.1 + 0.05*x" }
        domain = { shape = "square" }
        mesh = { cells = 20 }
        """,
    ),
    (
        crossed_rectangle_pair,
        """
        membranes = { tension = [2, 1], load = ["-8 - x", 3], height = 0.05 }
        domain = { shape = "rectangle", lower = [-1, 0], upper = [1, 1] }
        mesh = { cells = [12, 6], pattern = "crossed" }
        """,
    ),
    (
        disk_pair,
        """
        membranes = { tension = [1, 2], load = [-6, "4*x"], height = 0.1 }
        domain = { shape = "disk" }
        mesh = { cells = 6, refine = 1 }
        """,
    ),
    (
        l_shape_pair,
        """
        membranes = { tension = [1, 3], load = ["-15*exp(-x^2)", 2], height = "0.02 + abs(x*y)" }
        domain = { shape = "l-shape", half_width = 0.75 }
        mesh = { cells = 10 }
        """,
    ),
    (
        polygon_floor,
        """
        membrane = [{ tension = "1 + 0.5*x", load = -7, height = { "hole 1" = 0.1 }, foundation = 0.5 }]
        obstacle = { floor = "-0.2 + 0.05*y" }
        domain = { shape = "polygon", vertices = [[0, 0], [3, 0], [3, 2], [0, 2]], holes = [[[1, 0.5], [1.5, 1.5], [2, 0.5]]] }
        mesh = { size = 0.15 }
        """,
    ),
    (
        ceiling,
        """
        integration = "vertices"
        membrane = [{ tension = 1, load = 5 }]
        obstacle = { ceiling = "min(min(x, 1 - x), min(y, 1 - y))" }
        domain = { shape = "square" }
        mesh = { cells = 21 }
        """,
    ),
    (
        stack_of_three,
        """
        domain = { shape = "square" }
        mesh = { cells = 24 }
        obstacle = { floor = "-0.12 + 0.06*x", ceiling = 0.5 }
        [[membrane]]
        tension = 1
        load = "-9 - 8*x"
        height = 0.12
        [[membrane]]
        tension = 2
        load = "-6 + 30*sin(2*pi*x)*sin(pi*y)"
        height = 0.06
        [[membrane]]
        tension = 1.5
        load = "-7 + 14*x"
        """,
    ),
    (
        free_edges,
        """
        domain = { shape = "square" }
        mesh = { cells = 16 }
        [[membrane]]
        tension = 1
        load = -2
        height = { right = "free", top = "free" }
        traction = { right = -1, top = "0.5*x" }
        [[membrane]]
        tension = 1
        load = 2
        """,
    ),
    (
        pressed,
        """
        membrane = [{ tension = 1, load = "-1 - x", height = "free", pressed = true }]
        obstacle = { floor = "0.1*x" }
        domain = { shape = "square" }
        mesh = { cells = 10 }
        """,
    ),
    (
        plate_regions,
        f"""
        domain = {{ mesh = '{PLATE}' }}
        obstacle = {{ floor = {{ plate = -0.5 }} }}
        [[membrane]]
        tension = {{ plate = "40 + x" }}
        load = -600
        height = {{ opening = "free", "bolt holes" = 0.1 }}
        """,
    ),
    (
        dam,
        f"""
        integration = "vertices"
        domain = {{ shape = "rectangle", upper = [16, 24] }}
        mesh = {{ cells = [16, 16] }}
        obstacle = {{ floor = 0 }}
        [[membrane]]
        tension = 1
        load = -1
        height = {{ left = "{DAM["left"]}", right = "{DAM["right"]}", bottom = "{DAM["bottom"]}" }}
        """,
    ),
    (
        automatic_tolerance,
        """
        membranes = { tension = [1, 3], load = [-15, 10], height = 0.1 }
        domain = { shape = "square" }
        mesh = { cells = 48 }
        solver = { tolerance = "auto", backend = "multigrid" }
        """,
    ),
    (
        clarabel_without_polish,
        """
        membranes = { tension = [1, 3], load = [-15, 10], height = 0.1 }
        domain = { shape = "square" }
        mesh = { cells = 10 }
        solver = { backend = "clarabel", polish = false, tolerance = 1e-6 }
        """,
    ),
]


def assert_same_numbers(solution: mc.Solution, folder: Path) -> None:
    """What the program has written is what `solve` has returned."""
    meshio = pytest.importorskip("meshio")
    vtu = meshio.read(folder / "solution.vtu")
    assert same_bits(solution.mesh.points, vtu.points[:, :2])
    assert np.array_equal(solution.mesh.triangles, vtu.cells_dict["triangle"])
    expected = {f"u{i}": u for i, u in enumerate(solution.u, start=1)}
    for gap in solution.gaps:
        number = f"_{gap.number}" if len(solution.gaps) > 1 else ""
        expected |= {f"gap{number}": gap.gap, f"lambda{number}": gap.action, f"contact{number}": gap.contact.astype("u1")}
        if f"force{number}" in vtu.point_data:
            expected[f"force{number}"] = gap.force
    for name, values in expected.items():
        written = vtu.point_data[name]
        assert same_bits(values, written.astype("u1") if name.startswith("contact") else written), name
    if solution.indicators is not None:
        # The file has the square roots.
        assert same_bits(np.sqrt(solution.indicators), vtu.cell_data["error_indicator"][0])

    summary = read_json(folder / "summary.json")
    for key, attribute in SAME.items():
        assert getattr(solution, attribute) == summary[key], key
    # That of the program has one more, which is not part of the certificate.
    assert solution.residuals.items() <= summary["residuals"].items()
    assert solution.no_error_bound == summary.get("no_error_bound")
    assert solution.mesh.h == summary["h"]
    assert len(solution.u[0]) == summary["vertices"]
    contacts = summary.get("contacts")
    if contacts is None:
        assert solution.contact_area == summary["contact_area"]
        assert solution.total_force == summary["total_force"]
        return
    told = [(gap.number, gap.contact_area, gap.total_force) for gap in solution.gaps]
    assert told == [(gap["gap"], gap["contact_area"], gap["total_force"]) for gap in contacts]


@pytest.mark.parametrize(("solve", "case"), CASES, ids=[solve.__name__ for solve, _ in CASES])
def test_same_numbers_as_the_program(solve: Callable[[], mc.Solution], case: str, program: Program) -> None:
    assert_same_numbers(solve(), program.solve(case))


def test_same_numbers_with_regions_and_views_of_a_file(program: Program, tmp_path: Path) -> None:
    square = mc.Mesh.rectangle(10)
    x, y = square.points.T
    west = np.flatnonzero(square.points[square.triangles][:, :, 0].mean(axis=1) < 0.5)
    regions = {"rubber": west, "steel": np.setdiff1d(np.arange(len(square.triangles)), west)}
    path = tmp_path / "two.msh"
    views = {"pressure": -20 * np.sin(3 * x) - y, "ground": -0.1 - 0.02 * x * y}
    write_gmsh(path, square, regions, views, {"stiffness": 1.0 + np.arange(len(square.triangles)) % 3})
    load = {"rubber": {"view": "pressure"}, "elsewhere": -8}
    membrane = mc.Membrane(tension={"view": "stiffness"}, load=load, foundation={"rubber": 2, "steel": 0})
    solution = mc.solve(mc.Mesh.read(path).refined(), membranes=[membrane], floor={"view": "ground"})
    assert solution.contact.any()
    assert not solution.contact.all()
    case = f"""
    domain = {{ mesh = '{path}' }}
    mesh = {{ refine = 1 }}
    obstacle = {{ floor = {{ view = "ground" }} }}
    [[membrane]]
    tension = {{ view = "stiffness" }}
    load = {{ rubber = {{ view = "pressure" }}, elsewhere = -8 }}
    foundation = {{ rubber = 2, steel = 0 }}
    """
    assert_same_numbers(solution, program.solve(case))


def test_the_comparison_sees_one_bit(program: Program) -> None:
    folder = program.solve(CASES[0][1])
    load = (np.nextafter(-15, 0), "10*sin(pi*x)")
    other = mc.solve(mc.Mesh.rectangle(20), tension=(1, 3), load=load, height="0.1 + 0.05*x")
    with pytest.raises(AssertionError):
        assert_same_numbers(other, folder)


def of_package(*arguments: str) -> subprocess.CompletedProcess[str]:
    """The program of the package."""
    command = [*package_program(), *arguments]
    return subprocess.run(
        command, capture_output=True, text=True, timeout=TIMEOUT_SECONDS, env=environment(), stdin=subprocess.DEVNULL
    )


def test_module_shows_the_same_help(program: Program) -> None:
    ended = of_package("--help")
    assert ended.returncode == 0
    assert ended.stdout == program.run("--help").stdout
    assert "Usage: membranes" in ended.stdout
    assert ended.stderr == ""


@pytest.mark.parametrize("arguments", [("solve", "nowhere.toml"), ("no-such-command",), (), ("solve", "--no-such-option")])
def test_module_ends_with_2_for_bad_input(arguments: tuple[str, ...]) -> None:
    ended = of_package(*arguments)
    assert ended.returncode == 2
    assert ended.stderr.startswith("error: ")
    assert "Traceback" not in ended.stderr


def test_module_ends_with_1_when_nothing_certifies(program: Program) -> None:
    case = program.write(CASES[-1][1].replace("polish = false", "polish = false, max_iterations = 1"))
    ended = of_package("solve", str(case), "--out", str(case.parent / "out"), "--no-picture")
    assert ended.returncode == 1
    assert read_json(case.parent / "out" / "summary.json")["certified"] is False


def test_module_writes_the_same_bytes(program: Program) -> None:
    case = program.write(CASES[6][1])
    program.run("solve", str(case), "--out", str(case.parent / "a"), "--no-picture", "--quiet")
    assert of_package("solve", str(case), "--out", str(case.parent / "b"), "--no-picture", "--quiet").returncode == 0
    for name in "solution.vtu", "rim.vtp":
        assert (case.parent / "a" / name).read_bytes() == (case.parent / "b" / name).read_bytes(), name


def test_module_ends_with_130_after_an_interrupt(tmp_path: Path) -> None:
    # Some ten seconds of work.
    (tmp_path / "case.toml").write_text(CASES[0][1].replace("cells = 20", "cells = 1000"), encoding="utf-8")
    script = f"""
import sys
from membrane_contact.__main__ import main
sys.argv[1:] = ["solve", {str(tmp_path / "case.toml")!r}, "--out", {str(tmp_path / "out")!r}]
print("ready", flush=True)
sys.exit(main())
"""
    process = start_python(script)
    assert process.stdout is not None
    process.stdout.readline()
    time.sleep(0.5)
    interrupt(process)
    _, errors = process.communicate(timeout=TIMEOUT_SECONDS)
    assert process.returncode == 130, errors
    assert "Traceback" not in errors


def test_main_runs_twice_in_one_process() -> None:
    script = "from membrane_contact._core import run\nassert run(['membranes', 'cases']) == 0 == run(['membranes', 'cases'])"
    ended = subprocess.run(
        [*package_program()[:1], "-c", script], capture_output=True, text=True, timeout=TIMEOUT_SECONDS, env=environment()
    )
    assert ended.returncode == 0, ended.stderr
