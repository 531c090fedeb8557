"""A mesh of scikit-fem in, a basis of scikit-fem out: its vertices and P1 degrees of freedom have the same numbers."""

from typing import Any

import numpy as np
import skfem

import membrane_contact as mc

disk = skfem.MeshTri.init_circle(5)
solution = mc.solve(mc.Mesh.of(disk), tension=(1, 3), load=(-15, lambda x, y: 10 * np.exp(-(x**2) - y**2)), height=0.1)

basis = skfem.Basis(disk, skfem.ElementTriP1())


@skfem.Functional
def gradient(w: Any) -> Any:
    return w["u"].grad[0] ** 2 + w["u"].grad[1] ** 2


energies = [gradient.assemble(basis, u=basis.interpolate(np.array(u))) / 2 for u in solution.u]
print(f"{energies[0]:.6f} and {3 * energies[1]:.6f} are in the stretched membranes")
