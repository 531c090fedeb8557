"""A solver of quadratic programs of one's own before the certificate: projected gradients, which are not enough."""

import numpy as np

import membrane_contact as mc


def projected_gradients(P, q, A, b, *, tolerance, max_iterations, time_limit):  # type: ignore[no-untyped-def]
    """For one membrane over a floor: `A` is the identity."""
    step = 1 / abs(P).sum(axis=1).max()
    x = np.maximum(np.zeros_like(q), b)
    for _ in range(max_iterations or 200):
        x = np.maximum(x - step * (P @ x + q), b)
    return x, np.where(x > b, 0, np.maximum(P @ x + q, 0))


mesh = mc.Mesh.rectangle(32)
problem = {"membranes": [mc.Membrane(tension=1, load=-10)], "floor": -0.3}
try:
    mc.solve(mesh, **problem, solver=projected_gradients, polish=False)
except mc.CertificationError as error:
    print(f"no solution yet: stationarity {error.residuals['stationarity']:.1e}")

# A good guess of the contact set is enough for the polish, which makes it exact.
solution = mc.solve(mesh, **problem, solver=projected_gradients, max_iterations=2000)
print(f"with the polish: residual {solution.residual:.1e}, contact area {solution.contact_area:.3f}")

for name in ("clarabel", "osqp", "piqp"):
    solution = mc.solve(mesh, **problem, solver=mc.qpsolvers_backend(name))
    print(f"{name}: residual {solution.residual:.1e}, error at most {solution.error_bound:.3f}")
