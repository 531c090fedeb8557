"""Meshes and matrices of other packages."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ._core import Mesh

VTK_TRIANGLE = 5


def mesh_of(given: Any) -> Mesh:
    """The mesh of another package, of a Gmsh file, or of ``(points, triangles)``; see `Mesh.of`."""
    from ._core import Mesh

    if isinstance(given, Mesh):
        return given
    if isinstance(given, (str, os.PathLike)):
        return Mesh.read(given)
    if hasattr(given, "p") and hasattr(given, "t"):
        return _of_skfem(given)
    # A grid of pyvista has what a mesh of meshio has, too.
    if hasattr(given, "points") and hasattr(given, "cast_to_unstructured_grid"):
        return _of_pyvista(given)
    if hasattr(given, "cells_dict") and hasattr(given, "points"):
        return _of_meshio(given)
    if isinstance(given, (tuple, list)) and len(given) == 2:
        return Mesh(given[0], given[1])
    kind = type(given).__name__
    raise TypeError(f"no mesh can be made of {kind}: give one of skfem, meshio or pyvista, a path, or (points, triangles)")


def _of_skfem(given: Any) -> Mesh:
    """Of ``skfem.MeshTri``: vertices keep their numbers, so do its subdomains and boundaries their names."""
    from ._core import Mesh

    if given.t.shape[0] != 3:
        raise ValueError("the mesh of skfem is not one of triangles: make it one by to_meshtri()")
    mesh = Mesh(given.p.T, given.t.T.astype(np.int64))
    for name, triangles in (given.subdomains or {}).items():
        if len(triangles) > 0:
            mesh = mesh.with_region(name, np.asarray(triangles, dtype=np.int64))
    for name, facets in (given.boundaries or {}).items():
        if len(facets) > 0:
            mesh = mesh.with_curve(name, given.facets[:, np.asarray(facets)].T.astype(np.int64))
    return mesh


def _of_meshio(given: Any) -> Mesh:
    """Of ``meshio.Mesh``: its triangles, its cell sets and Gmsh's physical groups as regions and curves."""
    from ._core import Mesh

    others = set(given.cells_dict) - {"triangle", "line", "vertex"}
    if others or "triangle" not in given.cells_dict:
        kinds = ", ".join(given.cells_dict) or "nothing"
        raise ValueError(f"the mesh of meshio is not one of triangles alone: it has {kinds}; for files of Gmsh, give the path")
    triangles = np.asarray(given.cells_dict["triangle"], dtype=np.int64)
    mesh = Mesh(_plane(given.points), triangles)
    for name, members in _meshio_sets(given, "triangle"):
        mesh = mesh.with_region(name, members)
    lines = given.cells_dict.get("line")
    if lines is not None:
        for name, members in _meshio_sets(given, "line"):
            mesh = mesh.with_curve(name, np.asarray(lines, dtype=np.int64)[members])
    return mesh


def _meshio_sets(given: Any, kind: str) -> list[tuple[str, NDArray[np.int64]]]:
    """The named sets of cells of a kind, numbered as in ``cells_dict``."""
    sets: dict[str, NDArray[np.int64]] = {}
    dimension = {"triangle": 2, "line": 1}[kind]
    tags = given.cell_data_dict.get("gmsh:physical", {}).get(kind)
    for name, (tag, of_dimension) in (given.field_data or {}).items():
        if tags is not None and of_dimension == dimension:
            sets[name] = np.flatnonzero(tags == tag)
    for name, by_kind in (given.cell_sets_dict or {}).items():
        # Gmsh's own, which are the tags once more.
        if kind in by_kind and not name.startswith("gmsh:"):
            sets.setdefault(name, np.asarray(by_kind[kind], dtype=np.int64))
    return [(name, members) for name, members in sets.items() if len(members) > 0]


def _of_pyvista(given: Any) -> Mesh:
    """Of a data set of pyvista: its triangles."""
    from ._core import Mesh

    grid = given.cast_to_unstructured_grid()
    if set(grid.celltypes) != {VTK_TRIANGLE}:
        raise ValueError("the data set of pyvista is not one of triangles alone: call triangulate()")
    triangles = grid.cells_dict[VTK_TRIANGLE]
    return Mesh(_plane(grid.points), triangles.astype(np.int64))


def _plane(points: Any) -> NDArray[np.float64]:
    """The first two coordinates, if that is all."""
    points = np.asarray(points, dtype=np.float64)
    if points.shape[1] > 2 and not np.all(points[:, 2] == points[0, 2]):
        raise ValueError("the mesh is not in a plane z = constant: turn it into one")
    plane: NDArray[np.float64] = points[:, :2]
    return plane


def sparse(parts: tuple[Any, Any, Any], shape: tuple[int, int]) -> Any:
    """``scipy.sparse.csc_matrix`` of ``(data, indices, indptr)``."""
    from scipy.sparse import csc_matrix

    return csc_matrix(parts, shape=shape)


def symmetric(upper: Any) -> Any:
    """The symmetric matrix with this upper triangle."""
    from scipy.sparse import triu

    return (upper + triu(upper, 1).T).tocsc()
