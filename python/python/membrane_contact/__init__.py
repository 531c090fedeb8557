"""Contact of membranes, and obstacle problems: certified P1 finite element solutions with a bound of their error.

>>> import membrane_contact as mc
>>> mesh = mc.Mesh.rectangle(32)
>>> solution = mc.solve(mesh, tension=(1, 3), load=(-15, "10*sin(pi*x)"), height=0.1)
>>> round(solution.contact_area, 3), round(solution.error_bound, 3)
(0.64, 0.119)
"""

from ._core import (
    BackendError,
    CertificationError,
    ContactError,
    DataError,
    Gap,
    Mesh,
    MeshError,
    Qp,
    Solution,
    __version__,
    adapt,
    qp,
    solve,
)
from ._data import Datum, Field, Membrane
from ._qpsolvers import qpsolvers_backend

__all__ = [
    "BackendError",
    "CertificationError",
    "ContactError",
    "DataError",
    "Datum",
    "Field",
    "Gap",
    "Membrane",
    "Mesh",
    "MeshError",
    "Qp",
    "Solution",
    "__version__",
    "adapt",
    "qp",
    "qpsolvers_backend",
    "solve",
]
