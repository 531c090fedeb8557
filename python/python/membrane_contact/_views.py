"""Solutions for the eye and for other packages."""

from __future__ import annotations

import html as markup
from typing import TYPE_CHECKING, Any

import numpy as np

from ._interchange import VTK_TRIANGLE

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ._core import Gap, Solution

#: Colours that differ in lightness, too.
COLOURS = {"gap": "viridis", "action": "inferno", "contact": "cividis"}


def point_data(solution: Solution) -> dict[str, NDArray[Any]]:
    """The arrays of `solution.vtu`, by their names there."""
    data: dict[str, NDArray[Any]] = {f"u{i}": u for i, u in enumerate(solution.u, start=1)}
    for name, height in (("ceiling", solution.ceiling), ("floor", solution.floor)):
        if height is not None:
            data[name] = height
    for gap in solution.gaps:
        number = _number(solution, gap)
        data[f"gap{number}"] = gap.gap
        data[f"lambda{number}"] = gap.action
        if not solution.is_pair:
            data[f"force{number}"] = gap.force
            data[f"line_density{number}"] = gap.line_density
        data[f"contact{number}"] = gap.contact.astype(np.uint8)
    return data


def _number(solution: Solution, gap: Gap) -> str:
    """What stands behind the names of the fields of a gap."""
    return f"_{gap.number}" if len(solution.gaps) > 1 else ""


def _points(solution: Solution) -> NDArray[np.float64]:
    """In space, with z = 0."""
    points = solution.mesh.points
    return np.column_stack([points, np.zeros(len(points))])


def to_meshio(solution: Solution) -> Any:
    """The solution as a ``meshio.Mesh``."""
    import meshio

    cells = [("triangle", solution.mesh.triangles.astype(np.int64))]
    return meshio.Mesh(_points(solution), cells, point_data=point_data(solution))


def to_pyvista(solution: Solution) -> Any:
    """The solution as a ``pyvista.UnstructuredGrid``."""
    import pyvista

    triangles = solution.mesh.triangles.astype(np.int64)
    grid = pyvista.UnstructuredGrid({VTK_TRIANGLE: triangles}, _points(solution))
    for name, values in point_data(solution).items():
        grid.point_data[name] = values
    return grid


def plot(solution: Solution, *, field: str | None, ax: Any) -> Any:
    """A field of the solution, drawn with matplotlib; see `Solution.plot`."""
    import matplotlib.pyplot as plt

    if field is None:
        field = "gap" if len(solution.gaps) == 1 else "u1"
    values = _field(solution, field)
    if ax is None:
        _, ax = plt.subplots()
    mesh = solution.mesh
    x, y = mesh.points.T
    shading = {"shading": "flat" if values.dtype == bool else "gouraud"}
    colours = COLOURS.get(field.rstrip("_0123456789"), "viridis")
    drawn = ax.tripcolor(x, y, mesh.triangles, values.astype(float), cmap=colours, **shading)
    ax.figure.colorbar(drawn, ax=ax, label=field)
    ax.set_aspect("equal")
    ax.set_xlabel("x")
    ax.set_ylabel("y")
    return ax


def _field(solution: Solution, field: str) -> NDArray[Any]:
    """A field by its name: ``u1`` ..., ``gap``, ``action``, ``contact``, with the number of the gap where there are several."""
    fields: dict[str, NDArray[Any]] = {f"u{i}": u for i, u in enumerate(solution.u, start=1)}
    for gap in solution.gaps:
        number = _number(solution, gap)
        fields |= {f"gap{number}": gap.gap, f"action{number}": gap.action, f"contact{number}": gap.contact}
    if field not in fields:
        raise ValueError(f"there is no field {field!r}: there are {', '.join(fields)}")
    return fields[field]


def html(solution: Solution) -> str:
    """A table for notebooks."""
    rows = [
        ("vertices", f"{len(solution.mesh.points):,}"),
        ("solver", f"{solution.solver}, {solution.iterations} iterations"),
        ("certified", f"largest residual {solution.residual:.1e} (tolerance {solution.tolerance:g})"),
        ("error", _error(solution)),
        ("energy", f"{solution.energy:.9g}"),
        ("contact area", f"{solution.contact_area:.6g}"),
        ("total force", f"{solution.total_force:.9g}"),
    ]
    cells = (f"<tr><th>{name}</th><td>{markup.escape(value)}</td></tr>" for name, value in rows)
    return f"<table>{''.join(cells)}</table>"


def _error(solution: Solution) -> str:
    bound = solution.error_bound
    if bound is None:
        return f"not bounded: {solution.no_error_bound}"
    return f"at most {bound:.3e} in the energy norm, guaranteed up to the quadrature of the loads"
