"""Meshes that are refined where the error is."""

from __future__ import annotations

import threading
import warnings
from typing import Any

import numpy as np
import pytest

import membrane_contact as mc

PAIR: dict[str, Any] = {"tension": (1, 3), "load": (-5, "4*x"), "height": 0.05}


def test_the_accuracy_is_reached_and_the_callback_sees_it_come() -> None:
    levels: list[dict[str, Any]] = []
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        solution = mc.adapt(mc.Mesh.l_shape(4), **PAIR, relative_error=0.1, callback=levels.append)
    assert solution.relative_error_bound is not None and solution.relative_error_bound <= 0.1
    assert levels[-1]["bound"] == solution.error_bound and levels[-1]["vertices"] == len(solution.mesh.points)
    assert [level["level"] for level in levels] == list(range(len(levels))) and len(levels) > 3
    assert all(not level["relative_bound"] or level["relative_bound"] > 0.1 for level in levels[:-1])
    # The corner is where the error is: the triangles there are smaller than the others.
    areas = mesh_areas(solution.mesh)
    at_corner = np.linalg.norm(solution.mesh.points[solution.mesh.triangles].mean(axis=1), axis=1) < 0.1
    assert areas[at_corner].max() <= areas.max() / 8


def mesh_areas(mesh: mc.Mesh) -> Any:
    a, b, c = (mesh.points[mesh.triangles[:, k]] for k in range(3))
    (x, y), (z, w) = (b - a).T, (c - a).T
    return (x * w - y * z) / 2


def test_the_same_solution_comes_from_its_mesh() -> None:
    adapted = mc.adapt(mc.Mesh.disk(8), membranes=[mc.Membrane(tension=1, load=-2)], floor=-0.3, relative_error=0.1)
    again = mc.solve(adapted.mesh, membranes=[mc.Membrane(tension=1, load=-2)], floor=-0.3, tolerance=1e-10)
    assert adapted.error_bound == pytest.approx(again.error_bound, rel=0.05), "what the solver leaves is a fiftieth"
    assert np.abs(adapted.u1 - again.u1).max() < 1e-2 * np.abs(again.u1).max()


def test_a_limit_that_comes_first_is_told() -> None:
    with pytest.warns(RuntimeWarning, match="more than max_vertices"):
        solution = mc.adapt(mc.Mesh.l_shape(4), **PAIR, relative_error=1e-3, max_vertices=500)
    assert len(solution.mesh.points) <= 500 and solution.error_bound is not None


def test_what_cannot_be_is_refused() -> None:
    mesh = mc.Mesh.rectangle(4)
    with pytest.raises(mc.DataError, match="relative_error must be positive"):
        mc.adapt(mesh, **PAIR, relative_error=0.0)
    with pytest.raises(mc.DataError, match="max_vertices is 3, and the first mesh has 25"):
        mc.adapt(mesh, **PAIR, max_vertices=3)
    # Values at vertices do not follow the mesh.
    with pytest.raises(mc.DataError):
        mc.adapt(mesh, membranes=[mc.Membrane(tension=1, load=np.full(25, -10.0))], floor=-0.3)


def test_exceptions_of_the_callback_pass_through() -> None:
    def refuse(level: dict[str, Any]) -> None:
        assert threading.current_thread() is threading.main_thread()
        raise LookupError(level["vertices"])

    with pytest.raises(LookupError, match="25"):
        mc.adapt(mc.Mesh.rectangle(4), **PAIR, callback=refuse)
