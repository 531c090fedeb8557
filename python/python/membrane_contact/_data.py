"""What data may be; the types are in ``_data.pyi``."""

from typing import Any, TypedDict

#: A number; a formula in ``x`` and ``y``; values at the vertices or on the triangles of the mesh; ``f(x, y)`` of arrays; or a data view of
#: the mesh, ``{"view": name}``.
Datum = Any

#: A datum, or one for each region of the mesh: ``{"rubber": 1.0, "elsewhere": "2 + x"}``.
Field = Any


class Membrane(TypedDict, total=False):
    """A membrane of a stack, with the keys of a case file: ``Membrane(tension=1, load=-10)`` is a dictionary.

    ``-div(tension grad u) + foundation u = load`` and what its neighbours do to it.

    Parameters
    ----------
    tension : Field
        Force per length, positive.
    load : Field, optional
        Force per area, positive upwards.
    foundation : Field, optional
        Stiffness of an elastic foundation at height 0, force per volume, not negative.
    height : Datum or mapping of curves, optional
        Where it is held on the boundary, or ``"free"``; or one of these for each curve of the mesh. Default 0.
    traction : float, str, callable or mapping of curves, optional
        Force per length on free curves, positive upwards.
    pressed : bool, optional
        Whether its neighbours alone may hold it.
    """

    tension: Any
    load: Any
    foundation: Any
    height: Any
    traction: Any
    pressed: bool
