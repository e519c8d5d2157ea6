#!/usr/bin/python3
"""solvers.py LIMIT DIR FILE [SOLVER ...]: an FCLIB problem by the solvers of Siconos, to 1e-4, 1e-8 and
1e-12 of the scale-free natural map |r - P(r - rho_a u^)| / |r|, u = W r + q, rho_a = 1/lambda_max(W_aa).

A solver stops by an error of its own, so that it is asked for another until the natural map is at the
tolerance and little below it; what counts is the cheapest run that met it. Each is given the problem as it
stands and, beside it, scaled (W to a mean diagonal of 1, q to norm 1), and the better of the two counts. A
run is a process of its own that ends after LIMIT seconds of CPU; only the solver's call is timed, the
median of 3 below 0.1 s. The solver of a problem that failed at a tolerance is not asked for the next.

Leaves DIR/PROBLEM.SOLVER.tsv (tolerance, solved, seconds, error, iterations, how) and the reactions of
each solution, DIR/PROBLEM.SOLVER.TOLERANCE.h5: the problem and /solution/r, for nsd-err. Solvers whose
TSV is there are left out. Wants Debian's python3-siconos, -h5py and -scipy; ends with 69 without them."""
import os
import pickle
import select
import shutil
import signal
import statistics
import sys
import time
import warnings

os.environ["OMP_NUM_THREADS"] = os.environ["OPENBLAS_NUM_THREADS"] = "1"
warnings.simplefilter("ignore")  # of conversions, which are not timed

try:
    import siconos.numerics as sn
    import h5py
    import numpy as np
    import scipy.sparse as sparse
    import scipy.sparse.linalg
except ImportError:
    sys.exit(69)

TOLERANCES = (1e-4, 1e-8, 1e-12)
DENSE = 3000  # rows: what is solved with a dense W has no more
FEW = 10  # contacts: what goes through all combinations has no more


# ---- the problem ----


def matrix(group):
    """By libfclib's fields; in every real file with triplets p holds the column."""
    shape = int(group["m"][()].item()), int(group["n"][()].item())
    nz = int(group["nz"][()].item())
    p, i, x = (group[name][()].ravel() for name in "pix")
    if nz == -2:
        n = p[shape[0]]
        return sparse.csr_matrix((x[:n], i[:n], p[: shape[0] + 1]), shape)
    if nz == -1:
        n = p[shape[1]]
        return sparse.csc_matrix((x[:n], i[:n], p[: shape[1] + 1]), shape).tocsr()
    return sparse.coo_matrix((x[:nz], (i[:nz], p[:nz])), shape).tocsr()


def read(path):
    """W, q, mu, dim; of a global problem W = H^T M^-1 H and q = H^T M^-1 f + w."""
    with h5py.File(path) as file:
        local = "fclib_local" in file
        g = file["fclib_local" if local else "fclib_global"]
        dim = int(g["spacedim"][()].item())
        vector = {name: g["vectors"][name][()].ravel() for name in g["vectors"]}
        if local:
            return matrix(g["W"]), vector["q"], vector["mu"], dim
        H, M = matrix(g["H"]).tocsc(), matrix(g["M"]).tocsc()
        solve = scipy.sparse.linalg.splu(M).solve
        W = sparse.csr_matrix(H.T @ solve(H.toarray()))
        return W, H.T @ solve(vector["f"]) + vector["w"], vector["mu"], dim


def natural(W, q, mu, dim, r):
    """|r - P(r - rho_a u^)| / |r|, as nsd-err has it."""
    n = len(mu)
    B = sparse.bsr_matrix(W, blocksize=(dim, dim))
    diagonal = np.zeros((n, dim, dim))
    row = np.repeat(np.arange(n), np.diff(B.indptr))
    at = row == B.indices
    diagonal[row[at]] = B.data[at]
    rho = 1 / np.linalg.eigvalsh((diagonal + diagonal.transpose(0, 2, 1)) / 2)[:, -1]
    u = (W @ r + q).reshape(n, dim)
    u[:, 0] += mu * np.linalg.norm(u[:, 1:], axis=1)
    r = r.reshape(n, dim)
    x = r - rho[:, None] * u
    N, T = x[:, 0], np.linalg.norm(x[:, 1:], axis=1)
    P = x.copy()
    P[mu * T <= -N] = 0
    out = (mu * T > -N) & (T > mu * N)
    s = (N[out] + mu[out] * T[out]) / (1 + mu[out] ** 2)
    P[out, 0] = s
    P[out, 1:] *= (mu[out] * s / T[out])[:, None]
    size = np.linalg.norm(r)
    error = np.linalg.norm(r - P)
    return error / size if size > 0 else error and np.inf


def with_tangent(W, q, n):
    """A 2D problem for the 3D solvers: a second tangent, as heavy as the first, that nothing moves."""
    keep = (3 * np.arange(n)[:, None] + [0, 1]).ravel()
    wide = sparse.csr_matrix((np.ones(2 * n), (keep, np.arange(2 * n))), (3 * n, 2 * n))
    idle = np.zeros(3 * n)
    idle[2::3] = W.diagonal()[1::2]
    return (wide @ W @ wide.T + sparse.diags(idle)).tocsr(), wide @ q, keep


# ---- the solvers ----


def of(name):
    return getattr(sn, "SICONOS_FRICTION_" + name)


def nsgs(local):
    def setup():
        options = sn.SolverOptions(of("3D_NSGS"))
        options.iparam[of("3D_IPARAM_ERROR_EVALUATION")] = of("3D_NSGS_ERROR_EVALUATION_LIGHT_WITH_FULL_FINAL")
        options.iparam[sn.SICONOS_IPARAM_MAX_ITER] = 10**8
        sn.solver_options_update_internal(options, 0, of("3D_ONECONTACT_" + local))
        return options

    return setup, "blocks", sn.fc3d_driver


def plain(name, steps=10**8, storage="sparse", **iparam):
    def setup():
        options = sn.SolverOptions(of(name))
        options.iparam[sn.SICONOS_IPARAM_MAX_ITER] = steps
        for key, value in iparam.items():
            options.iparam[of("3D_" + key)] = of("3D_" + value) if isinstance(value, str) else value
        return options

    return setup, storage, sn.fc3d_driver if name[0] == "3" else sn.fc2d_driver


NEWTON = 2000  # steps: more is no Newton
# Blocks are the faster storage for products with W; the Newton methods assemble a sparse matrix
SOLVERS = {
    "nsgs": nsgs("NSN_GP_HYBRID"),
    "nsgs-projection": nsgs("ProjectionOnConeWithLocalIteration"),
    "nsn-ac": plain("3D_NSN_AC", NEWTON),
    "nsn-jm": plain("3D_NSN_AC", NEWTON, NSN_FORMULATION="NSN_FORMULATION_JEANMOREAU_STD"),
    "nsn-hybrid": plain("3D_NSN_AC", NEWTON, NSN_HYBRID_STRATEGY="NSN_HYBRID_STRATEGY_VI_EG_NSN"),
    "nsn-fb": plain("3D_NSN_FB", NEWTON),
    "prox": plain("3D_PROX", 10**5, storage="blocks"),
    "admm": plain("3D_ADMM", storage="blocks"),
    "eg": plain("3D_EG", storage="blocks"),
    "vi-eg": plain("3D_VI_EG", storage="blocks"),
    "vi-fpp": plain("3D_VI_FPP", storage="blocks"),
    "aclm": plain("3D_ACLMFP", 10**5, storage="blocks"),
    "2d-nsgs": plain("2D_NSGS", storage="blocks"),
    "2d-cpg": plain("2D_CPG", storage="dense"),
    "2d-lemke": plain("2D_LEMKE", storage="dense"),
    "2d-enum": plain("2D_ENUM", storage="dense"),
}

# Whose steps go with the scale of W: killed scaled, the other is not tried
EQUIVARIANT = "nsgs", "nsgs-projection", "eg", "vi-eg", "vi-fpp", "2d-nsgs"


class Problem:
    def __init__(self, path):
        self.path = path
        self.W, self.q, self.mu, self.dim = read(path)
        size = np.linalg.norm(self.q) or 1
        scale = 1 / np.mean(self.W.diagonal())
        self.variants = {"scaled": (scale, 1 / size), "plain": (1, 1)}

    def natural(self, r):
        return natural(self.W, self.q, self.mu, self.dim, r)

    def stored(self, dim, variant, storage):
        """The variant's W in that storage, q, and the rows of the problem's own r."""
        scale, size = self.variants[variant]
        W, q, keep = self.W * scale, self.q * size, slice(None)
        if dim > self.dim:
            W, q, keep = with_tangent(W, q, len(self.mu))
        if storage == "dense":
            W = np.asfortranarray(W.toarray())
        elif storage == "blocks":
            W = sn.SBM_from_csparse(dim, W.tocsc())[1]
        else:
            W = W.tocsc()
        return W, q, keep


def run(problem, solver, variant, own, limit):
    """Once, in a process of its own: seconds, natural map, iterations, what it returned, r; None when it
    was killed or fell."""
    setup, storage, driver = SOLVERS[solver]
    dim = 2 if driver is sn.fc2d_driver else 3
    W, q, keep = problem.stored(dim, variant, storage)
    end, start = os.pipe()
    child = os.fork()
    if not child:
        os.close(end)
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, 1)
        os.dup2(null, 2)
        seconds = []
        while not seconds or (seconds[0] < 0.1 and len(seconds) < 3):
            options = setup()
            options.dparam[sn.SICONOS_DPARAM_TOL] = own
            stated = sn.FrictionContactProblem(dim, len(problem.mu), W, q.copy(), problem.mu.copy())
            r, u = np.zeros(len(q)), np.zeros(len(q))
            signal.setitimer(signal.ITIMER_PROF, limit)  # of CPU; its signal ends the process
            begin = time.thread_time()  # that of the process goes by ticks under such a timer
            info = driver(stated, r, u, options)
            seconds.append(time.thread_time() - begin)
            signal.setitimer(signal.ITIMER_PROF, 0)
        scale, size = problem.variants[variant]
        r = r[keep] * (scale / size)
        done = int(options.iparam[sn.SICONOS_IPARAM_ITER_DONE])
        with os.fdopen(start, "wb") as pipe:
            pickle.dump((statistics.median(seconds), problem.natural(r), done, int(info), r), pipe)
        os._exit(0)
    os.close(start)
    with os.fdopen(end, "rb") as pipe:
        if not select.select([pipe], [], [], 4 * limit + 5)[0]:
            os.kill(child, signal.SIGKILL)
        said = pipe.read()
    os.waitpid(child, 0)
    return pickle.loads(said) if said else None


def cheapest(problem, solver, variant, tolerance, own, limit):
    """The cheapest run that meets the tolerance, and the solver's own tolerance that does it; or the last
    run, with None."""
    best, last, end = None, None, time.process_time() + os.times().children_user + 2 * limit
    for _ in range(5):
        if os.times().children_user + time.process_time() > end:
            break
        done = run(problem, solver, variant, own, limit)
        if not done:
            break
        seconds, error, _, info, _ = last = done
        met = error <= tolerance
        if met and (not best or seconds < best[0][0]):
            best, limit = (done, own), min(limit, max(seconds, 0.01))
        step = 0.5 * tolerance / error if error > 0 else 1e4
        if (met and (error > tolerance / 5 or seconds < 1e-3)) or (not met and (info or not np.isfinite(error))):
            break
        own *= min(step, 1e4) if met else max(min(step, 0.1), 1e-6)
        if not 1e-18 < own < 1 or (best and not met):
            break
    return best or (last, None)


def solve(problem, solver, limit):
    """A tolerance, the run that was the cheapest or failed, and how it was asked; for each tolerance."""
    asked = {variant: TOLERANCES[0] for variant in problem.variants}
    for tolerance in TOLERANCES:
        best, failed, budget = None, None, limit
        for variant, own in list(asked.items()):
            done, own = cheapest(problem, solver, variant, tolerance, own, budget)
            if own is None:
                failed = done or failed
                del asked[variant]
                if not done and not best and solver in EQUIVARIANT:
                    asked.clear()
                    break
                continue
            asked[variant] = own * 1e-4
            if not best or done[0] < best[0][0]:
                best, budget = (done, f"{variant} {own:.0e}"), min(limit, max(2 * done[0], 0.01))
        yield tolerance, *(best or (failed, None))


def can(solver, problem):
    """Whether it is for such a problem: in 2D, and small for some."""
    _, storage, driver = SOLVERS[solver]
    if driver is not sn.fc2d_driver:
        return True
    if problem.dim != 2 or solver == "2d-enum" and len(problem.mu) > FEW:
        return False
    return storage != "dense" or len(problem.q) <= DENSE


def keep(problem, r, path):
    shutil.copyfile(problem.path, path)
    with h5py.File(path, "r+") as file:
        if "solution" in file:
            del file["solution"]
        file["solution/r"] = r


def main():
    limit, folder, path = float(sys.argv[1]), sys.argv[2], sys.argv[3]
    name = os.path.splitext(os.path.basename(path))[0]
    problem = None
    for solver in sys.argv[4:] or SOLVERS:
        stem = os.path.join(folder, f"{name}.{solver}")
        if os.path.exists(stem + ".tsv"):
            continue
        problem = problem or Problem(path)
        if not can(solver, problem):
            continue
        with open(stem + ".part", "w", encoding="ascii") as out:
            for tolerance, done, how in solve(problem, solver, limit):
                seconds, error, steps, _, r = done or (np.nan, np.nan, 0, 0, None)
                if how:
                    keep(problem, r, f"{stem}.{tolerance:.0e}.h5".replace("e-0", "e-"))
                print(f"{tolerance:.0e}".replace("e-0", "e-"), int(bool(how)), f"{seconds:.3g}", f"{error:.2e}",
                      steps, how or "-", sep="\t", file=out, flush=True)  # fmt: skip
        os.replace(stem + ".part", stem + ".tsv")


main()
