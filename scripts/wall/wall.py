#!/usr/bin/python3
"""wall.py COMMAND ...: what holds up the solvers on large piles (make wall; nsd-convergence(7)).

  follow G S...          the iterates S of the problem G, one after the other: a line of JSON each
  spectrum G S COUNT     the COUNT eigenvalues nearest to -1e-4 of the law made linear at S: a line of JSON
  steps G S SIGMA COUNT  proximal steps from S, with Coulomb's law, and with the radii of its discs
                         held: a line of JSON for each step

G is a document of nsd-detect --fclib=global, S one of nsd-solve with the same contacts. All of it is
independent of nsd's solvers: it reads M, H, f, w, mu and the reactions, and computes the rest with
numpy and scipy.
"""
import json
import sys

import h5py
import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, bicgstab, eigs, splu

FALL = 9.81e-4  # m/s: g dt, the unit of velocities


class Problem:
    """M v = H r + f, u = H' v + w, in space; rho = 1/lambda_max(W_cc) for each contact (balls)."""

    def __init__(self, name):
        with h5py.File(name) as file:
            g = file["fclib_global"]
            self.m = matrix(g["M"]).diagonal()
            self.H = matrix(g["H"]).tocsr()
            self.f, self.w, self.mu = (g["vectors"][k][:] for k in ("f", "w", "mu"))
        self.HT = self.H.T.tocsr()
        self.n = len(self.mu)
        self.rho = 1 / (self.HT.multiply(self.HT) @ (1 / self.m)).reshape(-1, 3).max(1)

    def velocity(self, r):
        return (self.f + self.H @ r.ravel()) / self.m

    def at_contacts(self, v):
        return (self.HT @ v + self.w).reshape(-1, 3)

    def norm(self, v):
        """Root mean square of the velocities v, weighted by mass, over g dt"""
        return np.sqrt((self.m * v * v).sum() / self.m.sum()) / FALL

    def natural(self, r):
        u = self.at_contacts(self.velocity(r))
        u[:, 0] += self.mu * length(u[:, 1:])
        return np.linalg.norm(r - on_cone(self.mu, r - self.rho[:, None] * u)) / np.linalg.norm(r)


def matrix(g):
    form = {-1: sp.csc_matrix, -2: sp.csr_matrix}[int(g["nz"][0])]
    return form((g["x"][:], g["i"][:], g["p"][:]), shape=(int(g["m"][0]), int(g["n"][0])))


def length(x):
    return np.sqrt((x * x).sum(1))


def direction(x):
    return x / np.where(length(x) > 0, length(x), 1)[:, None]


def on_cone(mu, tau):
    t = length(tau[:, 1:])
    n = np.where(t <= mu * tau[:, 0], tau[:, 0], np.maximum(0, tau[:, 0] + mu * t) / (1 + mu**2))
    return np.column_stack([n, np.minimum(t, mu * n)[:, None] * direction(tau[:, 1:])])


def reactions(name):
    with h5py.File(name) as file:
        return file["contacts/reaction"][:].reshape(-1, 3)


def status(P, r):
    """Contacts that bear a load, and those of them that slide"""
    load = r[:, 0] > 1e-7 * np.median(r[r[:, 0] > 0, 0])
    return load, load & (length(r[:, 1:]) >= P.mu * r[:, 0] * (1 - 1e-8))


def held_within(share):
    """How many of the shares make up nine tenths of their sum"""
    s = np.sort(share)[::-1]
    return int(np.searchsorted(np.cumsum(s), 0.9 * s.sum())) + 1


def follow(G, *names):
    P, before = Problem(G), None
    for name in names:
        r = reactions(name)
        v, (load, slide) = P.velocity(r), status(P, r)
        Wr = P.at_contacts(P.H @ r.ravel() / P.m) - P.w.reshape(-1, 3)
        line = {"file": name, "contacts": P.n, "natural": P.natural(r), "r": np.linalg.norm(r),
                "load": int(load.sum()), "slide": int(slide.sum()),
                "self_stress": np.linalg.norm(P.rho[:, None] * Wr) / np.linalg.norm(r)}
        if before:
            r0, v0, load0, slide0 = before
            change = (P.m * (v - v0)**2).reshape(-1, 6).sum(1)
            line |= {"dv": P.norm(v - v0), "dr": np.linalg.norm(r - r0) / np.linalg.norm(r),
                     "bodies": held_within(change), "of": len(change),
                     "flips": int(((load != load0) | (slide != slide0)).sum())}
        before = r, v, load, slide
        print(json.dumps(line), flush=True)


def linear(P, r):
    """
    The law made linear at r, where no status changes. Reactions that may change are the columns of C:
    all three where a contact sticks; where it slides one along n + mu e, e the direction of r_t, and
    one across, which turns r_t and is given by d(u_across) = -|u_t|/(mu r_n) d(r_across). What has to
    vanish of u are the rows R: all three, or u_n and the part across. Returns R W C with that turning
    on its diagonal, each contact in units in which W_cc is 1.
    """
    load, slide = status(P, r)
    u, e = P.at_contacts(P.velocity(r)), direction(r[:, 1:])
    row, col, x, y, turn = [], [], [], [], []
    k = 0
    for c in np.flatnonzero(load):
        s = np.sqrt(P.rho[c])
        if not slide[c]:
            for i in range(3):
                row.append(k), col.append(3 * c + i), x.append(s), y.append(s)
                turn.append(0.0)
                k += 1
            continue
        stiff = length(u[c:c + 1, 1:])[0] / (P.mu[c] * r[c, 0])
        for right, left, t in (([1, *(P.mu[c] * e[c])], [1, 0, 0], 0),
                               ([0, -e[c, 1], e[c, 0]], [0, -e[c, 1], e[c, 0]], stiff * P.rho[c])):
            for i in range(3):
                row.append(k), col.append(3 * c + i), x.append(s * left[i]), y.append(s * right[i])
            turn.append(t)
            k += 1
    R = sp.csr_matrix((x, (row, col)), shape=(k, 3 * P.n))
    C = sp.csr_matrix((y, (row, col)), shape=(k, 3 * P.n)).T
    return ((R @ P.HT) @ sp.diags(1 / P.m) @ (P.H @ C) + sp.diags(turn)).tocsc()


def spectrum(G, S, count):
    """
    By Arnoldi with the inverse shifted by 1e-4. An eigenvalue below 1e-6 in size counts as 0: of those
    near 1e-9 rounding gives some, one for each body that nothing but a contact without load touches.
    """
    P, r, shift = Problem(G), reactions(S), -1e-4
    A = linear(P, r)
    lu = splu(A - shift * sp.identity(A.shape[0], format="csc"), permc_spec="MMD_AT_PLUS_A",
              options={"SymmetricMode": True}, diag_pivot_thresh=1e-3)
    start = np.cos(np.arange(A.shape[0]))
    w, X = eigs(LinearOperator(A.shape, matvec=lu.solve, dtype=float), k=int(count), v0=start,
                ncv=int(2.2 * int(count)), tol=1e-6, maxiter=100)
    w = shift + 1 / w
    order = np.argsort(w.real)
    w, X = w[order], abs(X[:, order])**2
    bad = w.real < -1e-6
    share = 1 / ((X / X.sum(0))**2).sum(0)
    load, slide = status(P, r)
    print(json.dumps({
        "contacts": P.n, "natural": P.natural(r), "load": int(load.sum()), "slide": int(slide.sum()),
        "size": A.shape[0], "zero": int((abs(w) < 1e-6).sum()), "unstable": int(bad.sum()),
        "least": w.real.min(), "spread": [int(s) for s in share[bad]],
        "smallest": float(abs(w[abs(w) >= 1e-6]).min()),
        "eigenvalues": [[float(z.real), float(z.imag)] for z in w[abs(w) >= 1e-6]]}))


def law(P, r0, v, sigma, held):
    """r = proj(r0 - sigma rho u, disc) and -dr/du; held: the radii, else mu r_n"""
    k = sigma * P.rho
    tau = r0 - k[:, None] * P.at_contacts(v)
    n, t, e = np.maximum(0, tau[:, 0]), length(tau[:, 1:]), direction(tau[:, 1:])
    radius = P.mu * n if held is None else held
    stick = t <= radius
    q = np.where(stick, 1, radius / np.where(t > 0, t, 1))
    D = np.zeros((P.n, 3, 3))
    D[:, 0, 0] = k * (n > 0)
    across = np.eye(2) - np.where(stick, 0, 1)[:, None, None] * e[:, :, None] * e[:, None, :]
    D[:, 1:, 1:] = (k * q)[:, None, None] * across
    if held is None:
        D[:, 1:, 0] = (P.mu * k * (n > 0) * ~stick)[:, None] * e
    return np.column_stack([n, q[:, None] * tau[:, 1:]]), D


def proximal(P, r0, v, sigma, held):
    """The solution of r = law(r0, v), M v = f + H r by Newton's method with a line search; how exact"""
    s = 1 / np.sqrt(P.m)

    def off(x):
        r, D = law(P, r0, x, sigma, held)
        F = s * (P.m * x - P.f - P.H @ r.ravel())
        return r, D, F, np.linalg.norm(F)

    r, D, F, size = off(v)
    first = size
    for _ in range(40):
        if size <= 1e-5 * first:
            break

        def product(y, D=D):
            u = (P.HT @ (s * y)).reshape(-1, 3)
            return y + s * (P.H @ np.einsum("cij,cj->ci", D, u).ravel())

        A = LinearOperator((len(F), len(F)), matvec=product, dtype=float)
        dv = -s * bicgstab(A, F, tol=1e-3, atol=0, maxiter=2000)[0]
        for halvings in range(10):
            trial = off(v + 0.5**halvings * dv)
            if trial[3] < (1 - 0.1 * 0.5**halvings) * size:
                break
        else:
            break
        v = v + 0.5**halvings * dv
        r, D, F, size = trial
    return r, size / first


def steps(G, S, sigma, count):
    P = Problem(G)
    for held in None, P.mu * reactions(S)[:, 0]:
        r, before = reactions(S), None
        for k in range(int(count)):
            new, exact = proximal(P, r, P.velocity(r), float(sigma), held)
            change = np.sqrt(((new - r)**2 / P.rho[:, None]).sum())
            print(json.dumps({"law": "Coulomb" if held is None else "held", "step": k + 1,
                              "length": change / np.sqrt((new**2 / P.rho[:, None]).sum()),
                              "ratio": change / before if before else None, "exact": exact,
                              "natural": P.natural(new)}), flush=True)
            r, before = new, change


commands = {"follow": follow, "spectrum": spectrum, "steps": steps}
if len(sys.argv) < 4 or sys.argv[1] not in commands:
    sys.exit(__doc__)
commands[sys.argv[1]](*sys.argv[2:])
