from collections.abc import Callable, Mapping
from typing import TypeAlias, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Required

Datum: TypeAlias = (
    float | str | ArrayLike | Callable[[NDArray[np.float64], NDArray[np.float64]], ArrayLike] | Mapping[str, str]
)
Field: TypeAlias = Datum | Mapping[str, Datum]

class Membrane(TypedDict, total=False):
    tension: Required[Field]
    load: Field
    foundation: Field
    height: Field
    traction: Field
    pressed: bool
