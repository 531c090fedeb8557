"""An obstacle problem in ten lines: a loaded membrane over a floor."""

import membrane_contact as mc

mesh = mc.Mesh.rectangle(64)
solution = mc.solve(mesh, membranes=[mc.Membrane(tension=1, load=-10)], floor=-0.3)
print(solution)
print(f"it lies on the floor over an area of {solution.contact_area:.3f}")
solution.plot("u1").figure.savefig("obstacle.png", dpi=150)
