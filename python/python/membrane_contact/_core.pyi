from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import Any, Final, Literal, TypeAlias, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._data import Datum, Field, Membrane

_Pattern: TypeAlias = Literal["right", "crossed"]
_Solver: TypeAlias = Literal["auto", "multigrid", "active-set", "clarabel"] | Callable[..., tuple[ArrayLike, ArrayLike]]
_OnPoints: TypeAlias = Callable[[NDArray[np.float64], NDArray[np.float64]], ArrayLike]

__all__ = [
    "BackendError",
    "CertificationError",
    "ContactError",
    "DataError",
    "Gap",
    "Mesh",
    "MeshError",
    "Qp",
    "Solution",
    "__version__",
    "adapt",
    "qp",
    "run",
    "solve",
]

__version__: Final[str]

class ContactError(RuntimeError): ...
class BackendError(ContactError): ...

class CertificationError(ContactError):
    residuals: dict[str, float] | None
    status: str

class MeshError(ValueError):
    triangle: int | None
    vertices: list[int]

class DataError(ValueError):
    key: str | None
    vertex: int | None

@final
class Mesh:
    def __new__(cls, points: ArrayLike, triangles: ArrayLike) -> Mesh: ...
    @staticmethod
    def of(mesh: Any) -> Mesh: ...
    @staticmethod
    def read(path: str | PathLike[str]) -> Mesh: ...
    @staticmethod
    def rectangle(
        nx: int,
        ny: int | None = None,
        *,
        lower: Sequence[float] = ...,
        upper: Sequence[float] = ...,
        pattern: _Pattern = "right",
    ) -> Mesh: ...
    @staticmethod
    def disk(
        cells: int | None = None,
        *,
        size: float | None = None,
        centre: Sequence[float] = ...,
        radius: float = 1.0,
        min_angle: float = 25.0,
    ) -> Mesh: ...
    @staticmethod
    def l_shape(
        cells: int | None = None,
        *,
        size: float | None = None,
        half_width: float = 1.0,
        min_angle: float = 25.0,
        pattern: _Pattern = "right",
    ) -> Mesh: ...
    @staticmethod
    def polygon(
        vertices: ArrayLike, holes: Sequence[ArrayLike] = ..., *, size: float, min_angle: float = 25.0
    ) -> Mesh: ...
    def refined(self, times: int = 1) -> Mesh: ...
    def with_region(self, name: str, triangles: ArrayLike | _OnPoints) -> Mesh: ...
    def with_curve(self, name: str, edges: ArrayLike | _OnPoints) -> Mesh: ...
    def with_view(self, name: str, values: ArrayLike, *, on: Literal["vertices", "triangles"] = "vertices") -> Mesh: ...
    @property
    def points(self) -> NDArray[np.float64]: ...
    @property
    def triangles(self) -> NDArray[np.int64]: ...
    @property
    def kind(self) -> NDArray[np.uint8]: ...
    @property
    def regions(self) -> dict[str, NDArray[np.int64]]: ...
    @property
    def curves(self) -> dict[str, NDArray[np.int64]]: ...
    @property
    def notes(self) -> list[str]: ...
    @property
    def refinements(self) -> int: ...
    @property
    def h(self) -> float: ...
    def __copy__(self) -> Mesh: ...
    def __deepcopy__(self, _memo: Any) -> Mesh: ...

@final
class Solution:
    @property
    def mesh(self) -> Mesh: ...
    @property
    def u(self) -> tuple[NDArray[np.float64], ...]: ...
    @property
    def u1(self) -> NDArray[np.float64]: ...
    @property
    def u2(self) -> NDArray[np.float64]: ...
    @property
    def is_pair(self) -> bool: ...
    @property
    def ceiling(self) -> NDArray[np.float64] | None: ...
    @property
    def floor(self) -> NDArray[np.float64] | None: ...
    @property
    def gaps(self) -> tuple[Gap, ...]: ...
    @property
    def gap(self) -> NDArray[np.float64]: ...
    @property
    def action(self) -> NDArray[np.float64]: ...
    @property
    def contact(self) -> NDArray[np.bool_]: ...
    @property
    def energy(self) -> float: ...
    @property
    def contact_area(self) -> float: ...
    @property
    def total_force(self) -> float: ...
    @property
    def residual(self) -> float: ...
    @property
    def residuals(self) -> dict[str, float]: ...
    @property
    def tolerance(self) -> float: ...
    @property
    def error_bound(self) -> float | None: ...
    @property
    def relative_error_bound(self) -> float | None: ...
    @property
    def no_error_bound(self) -> str | None: ...
    @property
    def error_parts(self) -> dict[str, float] | None: ...
    @property
    def energy_norm(self) -> float | None: ...
    @property
    def indicators(self) -> NDArray[np.float64] | None: ...
    @property
    def warnings(self) -> list[str]: ...
    @property
    def solver(self) -> str: ...
    @property
    def status(self) -> str: ...
    @property
    def choice(self) -> str | None: ...
    @property
    def iterations(self) -> int: ...
    @property
    def seconds(self) -> dict[str, float]: ...
    @property
    def x(self) -> NDArray[np.float64]: ...
    @property
    def y(self) -> NDArray[np.float64]: ...
    def __copy__(self) -> Solution: ...
    def __deepcopy__(self, _memo: Any) -> Solution: ...
    def to_meshio(self) -> Any: ...
    def to_pyvista(self) -> Any: ...
    def plot(self, field: str | None = None, ax: Any = None) -> Any: ...
    def _repr_html_(self) -> str: ...

@final
class Gap:
    @property
    def number(self) -> int: ...
    @property
    def gap(self) -> NDArray[np.float64]: ...
    @property
    def action(self) -> NDArray[np.float64]: ...
    @property
    def contact(self) -> NDArray[np.bool_]: ...
    @property
    def force(self) -> NDArray[np.float64]: ...
    @property
    def line_density(self) -> NDArray[np.float64]: ...
    @property
    def contact_area(self) -> float: ...
    @property
    def total_force(self) -> float: ...

@final
class Qp:
    @property
    def P(self) -> Any: ...
    @property
    def q(self) -> NDArray[np.float64]: ...
    @property
    def A(self) -> Any: ...
    @property
    def b(self) -> NDArray[np.float64]: ...
    @property
    def constant(self) -> float: ...

def qp(
    mesh: Mesh,
    *,
    tension: Sequence[Field] | None = None,
    load: Sequence[Field] | None = None,
    height: Datum | None = None,
    membranes: Sequence[Membrane | Mapping[str, Any]] | None = None,
    floor: Field | None = None,
    ceiling: Field | None = None,
    integration: Literal["quadrature", "vertices"] = "quadrature",
) -> Qp: ...
def solve(
    mesh: Mesh,
    *,
    tension: Sequence[Field] | None = None,
    load: Sequence[Field] | None = None,
    height: Datum | None = None,
    membranes: Sequence[Membrane | Mapping[str, Any]] | None = None,
    floor: Field | None = None,
    ceiling: Field | None = None,
    integration: Literal["quadrature", "vertices"] = "quadrature",
    solver: _Solver | None = None,
    tolerance: float | Literal["auto"] | None = None,
    max_iterations: int | None = None,
    time_limit: float | None = None,
    polish: bool = True,
    warm_start: Solution | None = None,
    bound: bool = True,
) -> Solution: ...
def adapt(
    mesh: Mesh,
    *,
    tension: Sequence[Field] | None = None,
    load: Sequence[Field] | None = None,
    height: Datum | None = None,
    membranes: Sequence[Membrane | Mapping[str, Any]] | None = None,
    floor: Field | None = None,
    ceiling: Field | None = None,
    relative_error: float = 0.01,
    max_vertices: int = 1000000,
    solver: _Solver | None = None,
    tolerance: float | Literal["auto"] | None = None,
    polish: bool = True,
    time_limit: float | None = None,
    callback: Callable[[dict[str, Any]], object] | None = None,
) -> Solution: ...
def run(arguments: Sequence[str]) -> int: ...
