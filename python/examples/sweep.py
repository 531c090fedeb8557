"""How the contact area of a pair grows with the load, each solve started from the one before."""

import matplotlib.pyplot as plt
import numpy as np

import membrane_contact as mc

mesh = mc.Mesh.disk(size=0.04)
loads = np.linspace(0, 2, 21)
areas = []
solution = None
for load in loads:
    solution = mc.solve(mesh, tension=(1, 3), load=(-load, 0), height=0.1, warm_start=solution, bound=False)
    areas.append(solution.contact_area)

plt.plot(loads, areas, "o-")
plt.xlabel("load on the upper membrane")
plt.ylabel("contact area")
plt.savefig("sweep.png", dpi=150)
first = np.flatnonzero(areas)[0]
print(f"contact begins between the loads {loads[first - 1]:.1f} and {loads[first]:.1f}; by theory at 0.4")
