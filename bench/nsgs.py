#!/usr/bin/python3
"""nsgs.py SWEEPS FILE: what a contact costs in a sweep of Siconos' NSGS, ns of CPU, with the cheapest
of its local solvers: an FCLIB problem, SWEEPS sweeps from r = 0. Wants Debian's python3-siconos, -h5py and
-scipy; ends with 69 where they are not there."""
import sys
import time
import warnings

warnings.simplefilter("ignore")  # of conversions, which are not timed

try:
    import siconos.numerics as sn
    import h5py
    import numpy as np
    import scipy.sparse as sparse
except ImportError:
    sys.exit(69)


def read(path):
    """W, q, mu of a local problem; W by rows, as libfclib's fields say."""
    with h5py.File(path) as file:
        problem = file["fclib_local"]
        w = problem["W"]
        m, nz = int(w["m"][()].item()), int(w["nz"][()].item())
        p, i, x = (w[name][()].ravel() for name in "pix")
        if nz == -2:
            matrix = sparse.csr_matrix((x[: p[m]], i[: p[m]], p[: m + 1]), (m, m))
        elif nz == -1:
            matrix = sparse.csc_matrix((x[: p[m]], i[: p[m]], p[: m + 1]), (m, m))
        else:
            matrix = sparse.coo_matrix((x[:nz], (i[:nz], p[:nz])), (m, m))
        return matrix.tocsr(), problem["vectors/q"][()].ravel(), problem["vectors/mu"][()].ravel()


def nsgs(blocks, q, mu, sweeps, local):
    """CPU seconds and the number of sweeps made."""
    n = len(mu)
    options = sn.SolverOptions(sn.SICONOS_FRICTION_3D_NSGS)
    options.iparam[sn.SICONOS_IPARAM_MAX_ITER] = sweeps
    options.dparam[sn.SICONOS_DPARAM_TOL] = 1e-300
    options.iparam[sn.SICONOS_FRICTION_3D_IPARAM_ERROR_EVALUATION] = (
        sn.SICONOS_FRICTION_3D_NSGS_ERROR_EVALUATION_LIGHT
    )
    options.iparam[sn.SICONOS_FRICTION_3D_IPARAM_ERROR_EVALUATION_FREQUENCY] = sweeps
    sn.solver_options_update_internal(options, 0, local)
    problem = sn.FrictionContactProblem(3, n, blocks, q.copy(), mu.copy())
    r, u = np.zeros(3 * n), np.zeros(3 * n)
    start = time.process_time()
    sn.fc3d_nsgs(problem, r, u, options)
    return time.process_time() - start, options.iparam[sn.SICONOS_IPARAM_ITER_DONE]


def main():
    sweeps, path = int(sys.argv[1]), sys.argv[2]
    w, q, mu = read(path)
    scale = 1 / np.mean(w.diagonal())  # its errors are not scale-free
    n = len(mu)
    blocks = sn.SBM_from_csparse(3, (w * scale).tocsc())[1]  # its fastest storage
    best = None
    for name in ("ProjectionOnCone", "ProjectionOnConeWithDiagonalization", "ProjectionOnConeWithLocalIteration"):
        # a few sweeps measure what it takes to begin
        few = nsgs(blocks, q, mu, 10, getattr(sn, "SICONOS_FRICTION_3D_ONECONTACT_" + name))
        many = nsgs(blocks, q, mu, sweeps, getattr(sn, "SICONOS_FRICTION_3D_ONECONTACT_" + name))
        if many[1] <= few[1]:
            continue
        ns = 1e9 * (many[0] - few[0]) / (many[1] - few[1]) / n
        print(f"{name}\t{ns:.1f}\t{many[1]}", file=sys.stderr)
        best = ns if best is None else min(best, ns)
    print(f"{best:.1f}")


main()
