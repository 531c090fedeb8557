"""An L-shaped pair to 5 %: the mesh follows the corner and the rim of the contact. tqdm, or anything else, may show how far it is."""

from typing import Any

import matplotlib.pyplot as plt

import membrane_contact as mc


def show(level: dict[str, Any]) -> None:
    bound = level["relative_bound"]
    print(f"{level['vertices']:7,} vertices: " + ("unknown" if bound is None else f"{100 * bound:.1f} %"))


solution = mc.adapt(
    mc.Mesh.l_shape(8), tension=(1, 3), load=(-5, "4*x"), height=0.05, relative_error=0.05, callback=show
)
x, y = solution.mesh.points.T
figure, axes = plt.subplots(figsize=(6, 6))
axes.triplot(x, y, solution.mesh.triangles, linewidth=0.3, color="black")
axes.set_aspect("equal")
figure.savefig("adaptive.png", dpi=150)
