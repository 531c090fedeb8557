"""The quadratic program (QP) that `membranes export` writes, read by numpy, scipy and HiGHS.

    minimise 1/2 x'Px + q'x + constant   subject to   A x >= b

with the multiplier y >= 0 of the constraints and the stationarity P x + q = A'y. The unknowns are
x = (u1, u2) on the n interior vertices.
"""

from __future__ import annotations

import shutil
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import highspy
import numpy as np
import scipy.io
import scipy.sparse as sp
from numpy.typing import NDArray

Vector = NDArray[np.float64]
Indices = NDArray[np.int64]


@dataclass(frozen=True)
class QuadraticProgram:
    """Minimise 1/2 x'Px + q'x + constant subject to A x >= b.

    Shapes: `P` (N, N), the full symmetric matrix; `q` (N,); `A` (m, N); `b` (m,).
    """

    P: sp.csc_matrix
    q: Vector
    A: sp.csc_matrix
    b: Vector
    constant: float = 0.0

    def energy(self, x: Vector) -> float:
        """The objective 1/2 x'Px + q'x + constant at `x`, shape (N,)."""
        return float(0.5 * x @ (self.P @ x) + self.q @ x + self.constant)

    def without_row(self, row: int) -> QuadraticProgram:
        """The same QP without one of its m constraints."""
        kept = np.delete(np.arange(self.b.size), row)
        return replace(self, A=self.A[kept], b=self.b[kept])


@dataclass(frozen=True)
class ExportedProblem:
    """The QP together with the mesh it comes from.

    Shapes: `interior` (n,), the mesh vertex of each interior unknown; `dual_area` (n,), the areas |D_a|, so
    that y_a = lambda_a |D_a|; `points` (vertices, 2); `triangles` (triangles, 3).
    """

    qp: QuadraticProgram
    interior: Indices
    dual_area: Vector
    points: Vector
    triangles: Indices


def read_npz(directory: Path) -> ExportedProblem:
    """The problem in `directory/problem.npz`."""
    with np.load(directory / "problem.npz") as arrays:
        names = ("interior", "dual_area", "points", "triangles")
        return ExportedProblem(read_program(arrays), *(arrays[name] for name in names))


def read_program(arrays: np.lib.npyio.NpzFile) -> QuadraticProgram:
    """The QP in the arrays of an exported file."""
    matrices = _matrix(arrays, "P"), arrays["q"], _matrix(arrays, "A")
    return QuadraticProgram(*matrices, arrays["b"], float(arrays["constant"]))


def _matrix(arrays: np.lib.npyio.NpzFile, name: str) -> sp.csc_matrix:
    parts = tuple(arrays[f"{name}_{part}"] for part in ("data", "indices", "indptr"))
    return sp.csc_matrix(parts, shape=tuple(arrays[f"{name}_shape"]))


def read_mtx(directory: Path) -> QuadraticProgram:
    """The QP in the five MatrixMarket files `directory/problem_{P,A,q,b,c}.mtx`."""
    matrices = {name: sp.csc_matrix(scipy.io.mmread(directory / f"problem_{name}.mtx")) for name in "PA"}
    vectors = {name: np.ravel(scipy.io.mmread(directory / f"problem_{name}.mtx")) for name in "qb"}
    constant = scipy.io.mmread(directory / "problem_c.mtx").item()
    return QuadraticProgram(**matrices, **vectors, constant=constant)


def read_qps(directory: Path) -> QuadraticProgram:
    """The QP in `directory/problem.qps`, read by HiGHS.

    Raises ValueError when HiGHS cannot read it or when it is not of the form above: bounded unknowns, rows
    with an upper bound, or a maximisation.
    """
    model = _read_by_highs(directory / "problem.qps")
    lp = model.lp_
    if not (np.all(np.isneginf(lp.col_lower_)) and np.all(np.isposinf(lp.col_upper_))):
        raise ValueError("problem.qps bounds an unknown: each of them has to be declared free (FR)")
    if not np.all(np.isposinf(lp.row_upper_)):
        raise ValueError("problem.qps bounds a row from above: each row has to be of type G")
    if lp.sense_ != highspy.ObjSense.kMinimize:
        raise ValueError("problem.qps maximises its objective")
    vectors = np.array(lp.col_cost_), _constraints(lp), np.array(lp.row_lower_)
    return QuadraticProgram(_hessian(model.hessian_), *vectors, lp.offset_)


# The least value that HiGHS accepts for its threshold: it drops entries of a matrix that are smaller.
HIGHS_DROPS_BELOW = 1e-12


def _read_by_highs(path: Path) -> highspy.HighsModel:
    """The model in a QPS file, which HiGHS accepts only under a name that ends in `.mps`."""
    reader = highspy.Highs()
    reader.setOptionValue("output_flag", False)
    reader.setOptionValue("small_matrix_value", HIGHS_DROPS_BELOW)
    with TemporaryDirectory() as temporary:
        status = reader.readModel(shutil.copy(path, Path(temporary, "problem.mps")).as_posix())
    if status == highspy.HighsStatus.kError:
        raise ValueError(f"HiGHS cannot read {path}")
    return reader.getModel()


def _hessian(hessian: highspy.HighsHessian) -> sp.csc_matrix:
    """The full symmetric matrix of the lower triangle that HiGHS keeps."""
    if hessian.format_ != highspy.HessianFormat.kTriangular:
        raise ValueError("HiGHS keeps the Hessian as a full matrix, where its lower triangle was expected")
    size = hessian.dim_
    triangle = sp.csc_matrix((hessian.value_, hessian.index_, hessian.start_), shape=(size, size))
    return sp.csc_matrix(triangle + triangle.T - sp.diags_array(triangle.diagonal()))


def _constraints(lp: highspy.HighsLp) -> sp.csc_matrix:
    matrix = lp.a_matrix_
    layout = sp.csc_matrix if matrix.format_ == highspy.MatrixFormat.kColwise else sp.csr_matrix
    shape = (lp.num_row_, lp.num_col_)
    return sp.csc_matrix(layout((matrix.value_, matrix.index_, matrix.start_), shape=shape))
