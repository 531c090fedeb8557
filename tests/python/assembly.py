"""The discrete problem assembled a second time, from the mesh and the case file alone.

P1 elements: the membranes are affine on each triangle, the unknowns are their values at the vertices, `g` is
interpolated at the boundary vertices. Nothing here shares code or quadrature with the program.
"""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from case_file import CaseData, Function
from problem import ExportedProblem, Indices, Vector

# Gauss points in each of the two directions of a triangle: exact for polynomials up to degree 8.
GAUSS_POINTS = 5


def areas(points: Vector, triangles: Indices) -> Vector:
    """The signed areas of the triangles, shape (triangles,)."""
    origin, first, second = (points[triangles[:, corner]] for corner in range(3))
    along, across = first - origin, second - origin
    return 0.5 * (along[:, 0] * across[:, 1] - along[:, 1] * across[:, 0])


def dual_areas(points: Vector, triangles: Indices) -> Vector:
    """|D_a|, a third of the area of the triangles that share vertex a, shape (vertices,)."""
    third = np.repeat(np.abs(areas(points, triangles)) / 3.0, 3)
    return np.bincount(triangles.ravel(), weights=third, minlength=len(points))


def stiffness(points: Vector, triangles: Indices, tension: Vector | float = 1.0) -> sp.csc_matrix:
    """The P1 stiffness matrix, shape (vertices, vertices), of a tension for each triangle.

    On a triangle of area |T|, with e_a the edge opposite to vertex a, it is mu (e_a . e_b) / (4 |T|).
    """
    edges = points[np.roll(triangles, -2, axis=1)] - points[np.roll(triangles, -1, axis=1)]
    local = np.einsum("tad,tbd,t->tab", edges, edges, 0.25 * tension / np.abs(areas(points, triangles)))
    rows, columns = np.repeat(triangles, 3, axis=1).ravel(), np.tile(triangles, 3).ravel()
    return sp.csc_matrix((local.ravel(), (rows, columns)), shape=(len(points), len(points)))


def load_vector(points: Vector, triangles: Indices, load: Function) -> Vector:
    """The integrals of `load` times each hat function, shape (vertices,).

    The unit square (s, t) is folded onto the triangle by the barycentric coordinates (1-s, s(1-t), st), whose
    Jacobian is 2 |T| s, and each direction takes Gauss-Legendre points.
    """
    nodes, weights = np.polynomial.legendre.leggauss(GAUSS_POINTS)
    nodes, weights = 0.5 * (nodes + 1.0), 0.5 * weights
    area, corners = np.abs(areas(points, triangles)), points[triangles]
    result = np.zeros(len(points))
    for s, weight_s in zip(nodes, weights, strict=True):
        for t, weight_t in zip(nodes, weights, strict=True):
            hats = np.array([1.0 - s, s * (1.0 - t), s * t])
            values = np.array([load(*place) for place in hats @ corners])
            local = np.outer(2.0 * s * weight_s * weight_t * area * values, hats)
            result += np.bincount(triangles.ravel(), weights=local.ravel(), minlength=len(points))
    return result


def boundary_vertices(triangles: Indices) -> Indices:
    """The ends of the edges that belong to one triangle only, in increasing order."""
    edges = np.sort(
        np.concatenate((triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]])), axis=1
    )
    unique, count = np.unique(edges, axis=0, return_counts=True)
    return np.unique(unique[count == 1])


def boundary_height(points: Vector, triangles: Indices, height: Function) -> Vector:
    """The values of g at the boundary vertices and 0 elsewhere, shape (vertices,)."""
    values = np.zeros(len(points))
    boundary = boundary_vertices(triangles)
    values[boundary] = [height(*place) for place in points[boundary]]
    return values


def loads(problem: ExportedProblem, case: CaseData) -> tuple[Vector, Vector]:
    """The load vectors F_1 and F_2, each of shape (vertices,)."""
    first, second = (load_vector(problem.points, problem.triangles, load) for load in case.loads)
    return first, second


def load_scale(problem: ExportedProblem, case: CaseData) -> float:
    """The greatest load at a vertex, force per area."""
    return max(abs(load(*place)) for load in case.loads for place in problem.points)


def boundary_lift(problem: ExportedProblem, case: CaseData) -> Vector:
    """mu1 K_IB g_B, the force of the lifted boundary on membrane 1, shape (n,)."""
    g = boundary_height(problem.points, problem.triangles, case.height)
    return case.tension[0] * (stiffness(problem.points, problem.triangles) @ g)[problem.interior]
