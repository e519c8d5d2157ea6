#!/usr/bin/python3
"""A contact solver of your own as a filter, here projected Gauss-Seidel in Python: it reads a packing with its contact problem, as
nsd-detect --fclib=local writes it, and writes the packing with reactions r and velocities u = W r + q. nsd-err judges them, and
nsd-move makes the step by them:

    nsd-detect --fclib=local packing.h5 | docs/examples/solver.py > solved.h5
    nsd-err solved.h5 | jq .natural
    nsd-move solved.h5 > next.h5

In another language the same steps: take the HDF5 file behind the header of 512 bytes, read W, q and mu, write three datasets."""
import io
import sys

import h5py
import numpy as np
import scipy.sparse as sparse

SWEEPS = 500
document = io.BytesIO(sys.stdin.buffer.read()[512:])
with h5py.File(document, "r+") as f:
    problem = f["fclib_local"]
    csr = int(problem["W/nz"][()].item()) == -2  # -1: compressed columns, -2: compressed rows; W is symmetric
    shape = (int(problem["W/m"][()].item()), int(problem["W/n"][()].item()))
    W = (sparse.csr_matrix if csr else sparse.csc_matrix)((problem["W/x"][()], problem["W/i"][()], problem["W/p"][()]), shape=shape).tocsr()
    q, mu = problem["vectors/q"][()].ravel(), problem["vectors/mu"][()].ravel()
    d = int(problem["spacedim"][()].item())
    r = np.zeros(len(q))
    rows = [slice(d * c, d * c + d) for c in range(len(mu))]
    rho = [1 / np.linalg.eigvalsh(W[k, k].toarray())[-1] for k in rows]
    for _ in range(SWEEPS):
        for c, k in enumerate(rows):
            u = W[k] @ r + q[k]
            u[0] += mu[c] * np.linalg.norm(u[1:])
            tau = r[k] - rho[c] * u
            n, t = tau[0], np.linalg.norm(tau[1:])
            if mu[c] * t <= -n:
                tau[:] = 0
            elif t > mu[c] * n:  # onto the cone
                tau[0] = (n + mu[c] * t) / (1 + mu[c] ** 2)
                tau[1:] *= mu[c] * tau[0] / t
            r[k] = tau
    u = W @ r + q
    n, t = r.reshape(-1, d)[:, 0], np.linalg.norm(r.reshape(-1, d)[:, 1:], axis=1)
    padded = [np.zeros((len(mu), 3)) for _ in range(2)]
    for to, values in zip(padded, (r, u)):
        to[:, :d] = values.reshape(-1, d)
    del f["fclib_local"]
    f["contacts/reaction"], f["contacts/velocity"] = padded
    f["contacts/status"] = np.where(n <= 0, 0, np.where(t < mu * n * (1 - 1e-9), 1, 2)).astype("i1")
sys.stdout.buffer.write(document.getvalue())
