"""The three formats of `membranes export`: what the npz file promises, and the same QP in each of them."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest
import scipy.io
import scipy.sparse as sp

from case_file import case_named
from problem import HIGHS_DROPS_BELOW, QuadraticProgram, read_mtx, read_qps
from program import Program

ARRAYS = {
    **{f"{matrix}_{part}": np.int64 for matrix in "PA" for part in ("indices", "indptr", "shape")},
    **dict.fromkeys(("P_data", "A_data", "q", "b", "dual_area", "points"), np.float64),
    **dict.fromkeys(("constant", "displacement_scale", "force_scale"), np.float64),
    **dict.fromkeys(("interior", "triangles"), np.int64),
}

# Text with 17 digits gives back each f64, but only one half of P is written, and HiGHS drops the least
# entries.
TEXT_TOLERANCE = {"mtx": 1e-15, "qps": HIGHS_DROPS_BELOW}
READERS = {"mtx": read_mtx, "qps": read_qps}


# Both halves of the matrix are the same sums of a few terms, perhaps in another order.
SYMMETRY_ROUNDING = 1e-15


def asymmetry(matrix: sp.csc_matrix) -> float:
    """The greatest difference between an entry and its mirror image, over the greatest entry."""
    return float(abs(matrix - matrix.T).max() / abs(matrix).max())


def difference(one: QuadraticProgram, other: QuadraticProgram) -> float:
    """The greatest difference of coefficients, over the greatest of P; infinite when the shapes differ."""
    if (one.P.shape, one.A.shape) != (other.P.shape, other.A.shape):
        return float("inf")
    matrices = [abs(one.P - other.P).max(), abs(one.A - other.A).max()]
    vectors = [np.max(np.abs(one.q - other.q)), np.max(np.abs(one.b - other.b))]
    constants = [abs(one.constant - other.constant)]
    return float(np.max(matrices + vectors + constants) / abs(one.P).max())


def test_npz_holds_the_promised_arrays(program: Program, case: Path) -> None:
    with np.load(program.export(case, "npz") / "problem.npz") as arrays:
        assert {name: arrays[name].dtype for name in arrays.files} == ARRAYS
        n, vertices = arrays["interior"].size, len(arrays["points"])
        assert arrays["P_shape"].tolist() == [2 * n, 2 * n] and arrays["A_shape"].tolist() == [n, 2 * n]
        assert arrays["q"].shape == (2 * n,) and arrays["b"].shape == arrays["dual_area"].shape == (n,)
        assert all(arrays[name].shape == () for name in ("constant", "displacement_scale", "force_scale"))
        assert arrays["points"].shape == (vertices, 2) and arrays["triangles"].shape[1:] == (3,)


def test_npz_matrices_are_canonical_and_p_is_symmetric(program: Program, case: Path) -> None:
    qp = program.problem(case).qp
    for matrix in (qp.P, qp.A):
        matrix.check_format()
        assert matrix.has_canonical_format
    assert asymmetry(qp.P) <= SYMMETRY_ROUNDING < asymmetry(sp.triu(qp.P))


@pytest.mark.parametrize("form", READERS)
def test_text_formats_hold_the_same_qp(program: Program, case: Path, form: str) -> None:
    qp = program.problem(case).qp
    read = READERS[form](program.export(case, form))
    assert difference(qp, read) <= TEXT_TOLERANCE[form]


def test_mtx_stores_p_as_symmetric(program: Program, case: Path) -> None:
    directory = program.export(case, "mtx")
    assert scipy.io.mminfo(directory / "problem_P.mtx")[5] == "symmetric"
    assert scipy.io.mminfo(directory / "problem_A.mtx")[5] == "general"


def test_difference_sees_each_coefficient(program: Program, case: Path) -> None:
    """The negative test: a flipped force, a halved Hessian, a moved bound, another constant, a missing row."""
    qp = program.problem(case).qp
    wrong = [
        replace(qp, q=-qp.q),
        replace(qp, P=sp.csc_matrix(sp.triu(qp.P))),
        replace(qp, A=-qp.A),
        replace(qp, b=qp.b + 1e-9),
        replace(qp, constant=qp.constant + 1e-9),
        qp.without_row(0),
    ]
    assert all(difference(qp, other) > max(TEXT_TOLERANCE.values()) for other in wrong)


@pytest.mark.parametrize(
    ("line", "wrong_line", "message"),
    [
        (r"^(\s+)FR\b", r"\1PL", "declared free"),
        (r"^(\s+)G\b", r"\1E", "of type G"),
        ("^ROWS", "ROUGH", "cannot read"),
    ],
)
def test_a_qps_file_of_another_form_is_refused(
    program: Program, tmp_path: Path, line: str, wrong_line: str, message: str
) -> None:
    text = (program.export(case_named("full-contact"), "qps") / "problem.qps").read_text(encoding="utf-8")
    wrong = re.sub(line, wrong_line, text, count=1, flags=re.MULTILINE)
    (tmp_path / "problem.qps").write_text(wrong, encoding="utf-8")
    with pytest.raises(ValueError, match=message):
        read_qps(tmp_path)


def test_scalars_of_vtu_files_have_one_axis(program: Program, case: Path) -> None:
    """With a second axis of length one, the difference of two fields would be a matrix."""
    directory = program.dual(case)
    for name, vectors in (("solution.vtu", set()), ("dual.vtu", set()), ("flux.vtu", {"t1", "t2"})):
        mesh = meshio.read(directory / name)
        arrays = dict(mesh.point_data)
        arrays |= {key: np.concatenate(blocks) for key, blocks in mesh.cell_data.items()}
        assert {key for key, array in arrays.items() if array.ndim > 1} == vectors, name
        assert all(arrays[key].shape[1] == 3 for key in vectors)


def test_the_areas_of_dual_cells_integrate_the_action(program: Program, case: Path) -> None:
    mesh = meshio.read(program.dual(case) / "dual.vtu")
    area, action, vertex = (np.concatenate(mesh.cell_data[key]) for key in ("area", "lambda", "vertex"))
    problem, found = program.problem(case), program.solve(case)
    order = np.argsort(vertex)
    assert vertex[order].tolist() == problem.interior.tolist()
    # Sums of a few rounded terms, but those of the library in another order.
    assert np.allclose(area[order], problem.dual_area, rtol=1e-12)
    total = found.summary["total_force"]
    assert abs(area @ action - total) <= 1e-9 * max(abs(total), 1.0)
    assert total == 0.0 or abs(area @ action - 1.01 * total) > 1e-3 * total


def test_pyvista_reads_the_areas(program: Program) -> None:
    pyvista = pytest.importorskip("pyvista")
    grid = pyvista.read(program.dual(case_named("unstructured")) / "dual.vtu")
    assert grid.cell_data["area"].shape == (grid.n_cells,)
    # The cells cover all but half a cell along the boundary.
    assert 0.5 < np.sum(grid.cell_data["area"]) / ((grid.bounds[1] - grid.bounds[0]) ** 2) < 1.5
