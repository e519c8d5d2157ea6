"""What the evaluations say of the parameters.

Each measure is a Gaussian process of the parameters, scaled to 0 .. 1, with the scatter of the seeds as noise (scikit-learn). With
the targets t and the matrix V of their errors the parameters have, uniform in their ranges, the density

    p ~ exp(-(f - t) . V^-1 (f - t) / 2) / sqrt(det V),    V_jk = e_j e_k R_jk + s_j^2 (j = k),

where f and s are the mean and the standard deviation of the process, and e the standard errors. Errors that are the scatter of the
seeds are correlated, because one packing has all of its measures: R is the correlation of the residuals. Others are independent.
The density is sampled at Sobol points of a box that shrinks to where it is.
"""
from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from scipy.stats import qmc
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel

from .problem import Problem

SAMPLES = 1 << 13
BOXES = 8  # at most
DRAWS, MEMBERS = 256, 8  # sets of lengths, size and noise
WIDTH = 0.7  # of their logarithms, about the most likely ones
SHRINK = 0.9  # of the correlations: those of few residuals could be 1
NEGLIGIBLE = 15.0  # the logarithm of a density below the largest one


class Process:
    """A Gaussian process whose lengths, size and noise are as uncertain as the evaluations leave them: MEMBERS of their density, with a
    prior under which a measure changes over some 0.7 of a range. The most likely set alone may follow the scatter."""

    def __init__(self, x: np.ndarray, y: np.ndarray):
        self.mean, self.size = y.mean(), y.std() or 1.0
        kernel = (ConstantKernel(1.0, (1e-2, 1e3)) * RBF(np.full(x.shape[1], 0.5), (0.15, 20.0))
                  + WhiteKernel(0.1, (1e-8, 1.0)))
        likely = GaussianProcessRegressor(kernel, n_restarts_optimizer=3, random_state=0)
        scaled = (y - self.mean) / self.size
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            likely.fit(x, scaled)
        middle, bounds = likely.kernel_.theta, likely.kernel_.bounds
        random = np.random.default_rng(0)
        step = random.standard_normal((DRAWS, len(middle)))
        step[0] = 0
        theta = np.clip(middle + WIDTH * step, bounds[:, 0], bounds[:, 1])
        log = np.array([likely.log_marginal_likelihood(t, clone_kernel=True) for t in theta])
        log += 0.5 * (step ** 2).sum(1)  # of what they are drawn from
        log -= 0.5 * (((theta[:, 1:-1] - np.log(0.7)) / 0.7) ** 2).sum(1) + 0.5 * (theta[:, 0] / 2) ** 2
        weight = np.exp(log - log.max())
        sums = np.cumsum(weight / weight.sum())
        self.members = []
        for t in theta[np.minimum(np.searchsorted(sums, (np.arange(MEMBERS) + 0.5) / MEMBERS), DRAWS - 1)]:
            member = GaussianProcessRegressor(likely.kernel_.clone_with_theta(t), optimizer=None)
            self.members.append((member.fit(x, scaled), float(np.exp(t[-1]))))
        self.scatter = float(np.sqrt(np.mean([noise for _, noise in self.members])) * self.size)

    def predict(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mean and standard deviation, without the noise"""
        mean, square = np.zeros(len(x)), np.zeros(len(x))
        for member, noise in self.members:
            m, s = member.predict(x, return_std=True)
            mean += m / MEMBERS
            square += (m * m + np.maximum(s * s - noise, 0)) / MEMBERS
        return self.mean + self.size * mean, self.size * np.sqrt(np.maximum(square - mean * mean, 0))


class Surrogate:
    def __init__(self, problem: Problem, x: np.ndarray, measures: np.ndarray):
        """x [n][d] from 0 to 1, measures [n][targets]"""
        self.targets = problem.targets
        self.process = [Process(x, measures[:, k]) for k in range(len(problem.targets))]
        self.scatter = [process.scatter for process in self.process]
        self.related = self._related(measures - self.predict(x)[0])

    def error_of(self, k: int) -> float:
        """Of target k: its own standard error, or where it has none, the scatter of the seeds."""
        return self.targets[k].error or max(self.scatter[k], 1e-12 * abs(self.targets[k].value), 1e-300)

    def _related(self, residuals: np.ndarray) -> np.ndarray:
        """Correlations of the errors of the targets"""
        own = np.array([t.error is not None for t in self.targets])
        with np.errstate(all="ignore"):
            r = SHRINK * np.atleast_2d(np.corrcoef(residuals, rowvar=False))
        r[~np.isfinite(r)] = 0  # a measure without scatter
        r[own, :], r[:, own] = 0, 0
        np.fill_diagonal(r, 1)
        return r

    def predict(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Means and standard deviations of the measures, without the scatter of the seeds [n][targets]"""
        each = [process.predict(x) for process in self.process]
        return np.array([m for m, _ in each]).T, np.array([s for _, s in each]).T

    def _terms(self, measures: np.ndarray, deviation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(f - t) . V^-1 (f - t), and the logarithm of det V, in units of the errors [n]"""
        error = np.array([self.error_of(k) for k in range(len(self.targets))])
        far = (measures - np.array([t.value for t in self.targets])) / error
        v = self.related + (deviation / error)[:, :, None] ** 2 * np.eye(len(error))
        return (far * np.linalg.solve(v, far[:, :, None])[:, :, 0]).sum(1), np.linalg.slogdet(v)[1]

    def misfit(self, measures: np.ndarray) -> np.ndarray:
        """(f - t) . V^-1 (f - t) of the errors alone: without correlations the sum of ((measure - value)/error)^2"""
        return self._terms(measures, np.zeros_like(measures))[0]

    def log_density(self, x: np.ndarray) -> np.ndarray:
        squares, log_det = self._terms(*self.predict(x))
        return -0.5 * (squares + log_det)


@dataclass
class Posterior:
    x: np.ndarray  # [n][d] from 0 to 1
    weight: np.ndarray  # [n], sum 1
    misfit: np.ndarray  # [n], of the means
    spread: np.ndarray  # [n], of the densities' deviations over the errors, the largest of the targets

    def quantile(self, j: int, share: float) -> float:
        order = np.argsort(self.x[:, j])
        sums = np.cumsum(self.weight[order])
        return float(np.interp(share, sums - 0.5 * self.weight[order], self.x[order, j]))

    def interval(self, j: int) -> tuple[float, float]:
        """That has 90 %."""
        return self.quantile(j, 0.05), self.quantile(j, 0.95)

    def best(self) -> int:
        """Of the samples that fit as well as any within the errors, the one nearest to the mean: the least misfit itself follows noise"""
        mean = np.average(self.x, axis=0, weights=self.weight)
        width = np.sqrt(np.average((self.x - mean) ** 2, axis=0, weights=self.weight)) + 1e-12
        far = (((self.x - mean) / width) ** 2).sum(1)
        return int(np.argmin(np.where(self.misfit <= self.misfit.min() + 1, far, np.inf)))


def sobol(d: int, n: int, seed: int) -> np.ndarray:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return qmc.Sobol(d, seed=seed).random(n)


def posterior(model: Surrogate, d: int) -> Posterior:
    low, high = np.zeros(d), np.ones(d)
    for k in range(BOXES):
        x = low + (high - low) * sobol(d, SAMPLES, k)
        log = model.log_density(x)
        near = x[log > log.max() - NEGLIGIBLE]
        margin = 0.1 * (near.max(0) - near.min(0)) + 1e-4
        inner_low, inner_high = np.maximum(near.min(0) - margin, 0), np.minimum(near.max(0) + margin, 1)
        if np.prod(inner_high - inner_low) > 0.7 * np.prod(high - low):
            break
        low, high = inner_low, inner_high
    weight = np.exp(log - log.max())
    mean, deviation = model.predict(x)
    error = np.array([model.error_of(k) for k in range(len(model.targets))])
    return Posterior(x, weight / weight.sum(), model.misfit(mean), (deviation / error).max(1))


def next_points(p: Posterior, known: np.ndarray, n: int, seed: int) -> np.ndarray:
    """Points to evaluate: of a sample of the density those that are far from what is known and from each other, by the widths of
    the density."""
    random = np.random.default_rng(seed)
    candidates = p.x[random.choice(len(p.x), size=16 * n, p=p.weight)]
    width = np.array([max(b - a, 1e-6) for a, b in map(p.interval, range(p.x.shape[1]))])
    chosen: list[np.ndarray] = []
    distance = np.min(np.linalg.norm((candidates[:, None, :] - known[None, :, :]) / width, axis=2), axis=1)
    for _ in range(n):
        k = int(np.argmax(distance))
        chosen.append(candidates[k])
        distance = np.minimum(distance, np.linalg.norm((candidates - candidates[k]) / width, axis=1))
    return np.array(chosen)
