"""C_D of nets as a power of Re, each net for itself and all together with solidity and diameter.

All together: ln C_D = a0 + a1 ln Re + a2 S + a3 S ln Re + a4 ln d with a random level for every net. The coefficients
of solidity and diameter are drawn towards zero by a prior whose width the data choose (restricted likelihood), which is
a ridge regression with its own penalty: with few nets it falls back on one common power law instead of inventing
slopes.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.series.intervals import student_quantile

#: Names of the coefficients in their order
TERMS = ("a0", "a1", "a2", "a3", "a4")
_LEAST_NETS = 3


@dataclass(frozen=True, eq=False)
class NetPowerLaw:
    """C_D = A Re^-B of one net."""

    net: str
    #: Factor A of C_D = A Re^-B.
    factor: float
    #: Exponent B of the same law.
    exponent: float
    #: Interval of the factor at the confidence asked for.
    factor_interval: tuple[float, float]
    #: Interval of the exponent at that confidence.
    exponent_interval: tuple[float, float]
    #: Standard deviation of ln C_D beyond the errors of the runs.
    scatter: float
    #: Of ln A and B; shape (2, 2).
    covariance: Array
    reynolds_range: tuple[float, float]
    #: Number of runs.
    count: int

    @property
    def text(self) -> str:
        """The law as a case file takes it, ``11.4 Re^-0.401 from 123 to 1105``."""
        low, high = self.reynolds_range
        return f"{self.factor:.4g} Re^-{self.exponent:.3f} from {math.floor(low)} to {math.ceil(high)}"

    def at(self, reynolds: ArrayLike) -> Array:
        """Return C_D."""
        return np.asarray(self.factor * np.asarray(reynolds, dtype=float) ** -self.exponent)


def fit_power_law(
    net: str, reynolds: ArrayLike, drag: ArrayLike, error: ArrayLike, confidence: float = 0.95
) -> NetPowerLaw:
    """Fit ln C_D = ln A - B ln Re with weights of the runs' errors and a scatter of its own [eq:net-power-law].

    Parameters
    ----------
    net : str
    reynolds, drag, error : array_like
        Of the runs; standard errors of C_D.
    confidence : float

    Raises
    ------
    InputError
        For fewer than three runs with positive C_D, or one Reynolds number only.
    """
    number, value, spread = (np.asarray(item, dtype=float) for item in (reynolds, drag, error))
    good = (value > 0.0) & (number > 0.0) & np.isfinite(value)
    number, value, spread = number[good], value[good], spread[good]
    if number.size < 3:
        raise InputError(
            f"net {net}: {number.size} runs with a positive C_D", parameter="runs", allowed="at least 3 for A Re^-B"
        )
    x, y = np.log(number), np.log(value)
    if float(np.ptp(x)) < 0.1:
        raise InputError(
            f"net {net}: the Reynolds numbers {number.min():.4g} to {number.max():.4g} hardly differ",
            parameter="runs",
            remedy="tow at several speeds",
        )
    noise = np.square(spread / value)
    centre = float(x.mean())
    design = np.column_stack([np.ones_like(x), -(x - centre)])
    extra = 0.0
    for _ in range(200):
        weight = 1.0 / np.maximum(noise + extra, 1e-30)
        inverse = np.linalg.inv(design.T @ (weight[:, None] * design))
        beta = inverse @ (design.T @ (weight * y))
        residual = y - design @ beta
        # the scatter at which the weighted residuals are as large as their freedom
        excess = float(np.sum(weight * residual**2)) - (number.size - 2)
        slope = float(np.sum(weight**2 * residual**2))
        following = max(0.0, extra + excess / max(slope, 1e-300))
        if abs(following - extra) < 1e-12 + 1e-9 * extra:
            break
        extra = following
    turn = np.array([[1.0, centre], [0.0, 1.0]])
    beta, covariance = turn @ beta, turn @ inverse @ turn.T
    reach = student_quantile(confidence, number.size - 2.0) * np.sqrt(np.diagonal(covariance))
    return NetPowerLaw(
        net=net,
        factor=math.exp(beta[0]),
        exponent=float(beta[1]),
        factor_interval=(math.exp(beta[0] - reach[0]), math.exp(beta[0] + reach[0])),
        exponent_interval=(float(beta[1] - reach[1]), float(beta[1] + reach[1])),
        scatter=math.sqrt(extra),
        covariance=covariance,
        reynolds_range=(float(number.min()), float(number.max())),
        count=int(number.size),
    )


@dataclass(frozen=True, eq=False)
class JointLaw:
    """The law of all nets together [eq:net-joint-law]."""

    #: a0 to a4; a4 is 0 without the diameter; shape (5,).
    coefficients: Array
    #: Shape (5, 5).
    covariance: Array
    #: Standard deviation of ln C_D within a net, beyond the errors of the runs.
    scatter: float
    #: Standard deviation of the levels of the nets about the law.
    between: float
    #: Width of the prior of the standardised slopes of solidity and diameter: 0 leaves one power law for all.
    prior: float
    #: Reynolds numbers that the law was fitted to.
    reynolds_range: tuple[float, float]
    #: Solidities that the law was fitted to.
    solidity_range: tuple[float, float]
    #: Twine diameters that the law was fitted to [m].
    diameter_range: tuple[float, float]
    #: Number of runs.
    count: int
    #: Number of nets.
    nets: int
    #: Root mean square error of ln C_D predicted by this law for nets left out.
    left_out_error: float
    #: Root mean square error of ln C_D predicted for nets left out by one power law for all.
    pooled_error: float
    confidence: float

    def factor(self, solidity: float, diameter: float) -> float:
        """Return A of C_D = A Re^-B for a solidity [-] and a twine diameter [m]."""
        a = self.coefficients
        return math.exp(float(a[0] + a[2] * solidity + a[4] * math.log(diameter)))

    def exponent(self, solidity: float) -> float:
        """Return B for a solidity [-]."""
        return -float(self.coefficients[1] + self.coefficients[3] * solidity)

    def at(self, reynolds: ArrayLike, solidity: ArrayLike, diameter: ArrayLike) -> Array:
        """Return C_D by the law."""
        return np.asarray(np.exp(_columns(reynolds, solidity, diameter) @ self.coefficients))

    def interval(self, reynolds: ArrayLike, solidity: ArrayLike, diameter: ArrayLike) -> tuple[Array, Array]:
        """Return the interval of C_D of another net, the spread between nets included."""
        rows = _columns(reynolds, solidity, diameter)
        middle = rows @ self.coefficients
        variance = np.einsum("...i,ij,...j->...", rows, self.covariance, rows) + self.between**2 + self.scatter**2
        reach = student_quantile(self.confidence, max(1.0, self.nets - 2.0)) * np.sqrt(variance)
        return np.asarray(np.exp(middle - reach)), np.asarray(np.exp(middle + reach))


def _columns(reynolds: ArrayLike, solidity: ArrayLike, diameter: ArrayLike) -> Array:
    x, s, d = np.broadcast_arrays(
        np.log(np.asarray(reynolds, dtype=float)), np.asarray(solidity, dtype=float), np.log(np.asarray(diameter))
    )
    return np.stack([np.ones_like(x), x, s, s * x, d], axis=-1)


@dataclass(frozen=True, eq=False)
class _Data:
    y: Array
    common: Array
    slopes: Array
    noise: Array
    net: NDArray[np.intp]
    back: Array


def _prepared(
    net: NDArray[np.intp], x: Array, s: Array, d: Array, y: Array, noise: Array, with_diameter: bool
) -> _Data:
    """Centre and scale the columns; ``back`` turns the coefficients into those of the plain columns."""
    cx, cs, cd = x.mean(), s.mean(), d.mean()
    ws, wd = max(float(s.std()), 1e-12), max(float(d.std()), 1e-12)
    wx = max(float(x.std()), 1e-12)
    slopes = [(s - cs) / ws, (s - cs) / ws * (x - cx) / wx]
    if with_diameter:
        slopes.append((d - cd) / wd)
    # rows: a0, a1, a2, a3, a4; columns: level, slope, solidity, interaction, diameter
    back = np.zeros((5, 5))
    back[:, 0] = [1.0, 0.0, 0.0, 0.0, 0.0]
    back[:, 1] = [-cx, 1.0, 0.0, 0.0, 0.0]
    back[:, 2] = [-cs / ws, 0.0, 1.0 / ws, 0.0, 0.0]
    back[:, 3] = np.array([cs * cx, -cs, -cx, 1.0, 0.0]) / (ws * wx)
    back[:, 4] = [-cd / wd, 0.0, 0.0, 0.0, 1.0 / wd]
    return _Data(y, np.column_stack([np.ones_like(x), x - cx]), np.column_stack(slopes), noise, net, back)


def _solve(data: _Data, scatter: float, between: float, prior: float) -> tuple[Array, Array, float]:
    """Return standardised coefficients, their covariance and the restricted log likelihood."""
    same = (data.net[:, None] == data.net[None, :]).astype(float)
    cover = np.diag(data.noise + scatter**2) + between**2 * same
    design = np.hstack([data.common, data.slopes])
    inverse = np.linalg.inv(cover + prior**2 * data.slopes @ data.slopes.T)
    inner = data.common.T @ inverse @ data.common
    level = np.linalg.solve(inner, data.common.T @ inverse @ data.y)
    rest = data.y - data.common @ level
    likelihood = -0.5 * (float(rest @ inverse @ rest) - np.linalg.slogdet(inverse)[1] + np.linalg.slogdet(inner)[1])
    clean = np.linalg.inv(cover)
    penalty = np.zeros(design.shape[1])
    penalty[2:] = 1.0 / max(prior, 1e-9) ** 2
    covariance = np.linalg.inv(design.T @ clean @ design + np.diag(penalty))
    beta = np.asarray(covariance @ (design.T @ clean @ data.y), dtype=np.float64)
    return beta, np.asarray(covariance, dtype=np.float64), float(likelihood)


def _estimate(data: _Data) -> tuple[Array, Array, tuple[float, float, float]]:
    from scipy.optimize import minimize

    # weak priors keep the widths inside what ln C_D can show: a few thousandths to a few units
    def cost(logs: Array) -> float:
        widths = np.exp(np.clip(logs, -7.0, 3.0))
        beyond = float(np.sum(np.square(logs - np.clip(logs, -7.0, 3.0))))
        return -_solve(data, *widths)[2] + 1e-3 * float(np.sum(np.square(logs + 2.0))) + beyond

    best, least = np.log([0.05, 0.1, 0.3]), math.inf
    for start in (best, np.log([0.02, 0.02, 0.02])):
        found = minimize(cost, start, method="Nelder-Mead", tol=1e-4)
        if float(found.fun) < least:
            best, least = np.asarray(found.x), float(found.fun)
    scatter, between, prior = (float(value) for value in np.exp(np.clip(best, -7.0, 3.0)))
    beta, covariance, _ = _solve(data, scatter, between, prior)
    return beta, covariance, (scatter, between, prior)


def fit_joint_law(
    nets: Sequence[str],
    reynolds: ArrayLike,
    drag: ArrayLike,
    error: ArrayLike,
    solidity: ArrayLike,
    diameter: ArrayLike,
    *,
    confidence: float = 0.95,
) -> JointLaw:
    """Fit A and B as functions of solidity and diameter [eq:net-joint-law].

    Parameters
    ----------
    nets : sequence of str
        Net of every run.
    reynolds, drag, error : array_like
        Of the runs; standard errors of C_D.
    solidity, diameter : array_like
        Of the net of every run [-], [m].
    confidence : float

    Raises
    ------
    InputError
        For fewer than three nets, or nets of one solidity.
    """
    number, value, spread, share, twine = (
        np.asarray(item, dtype=float) for item in (reynolds, drag, error, solidity, diameter)
    )
    good = (value > 0.0) & np.isfinite(value) & (number > 0.0)
    names = sorted({name for name, keep in zip(nets, good) if keep})
    index = np.array([names.index(name) for name, keep in zip(nets, good) if keep], dtype=np.intp)
    if len(names) < _LEAST_NETS:
        raise InputError(
            f"{len(names)} net{'s are' if len(names) > 1 else ' is'} too few for A and B as functions of solidity",
            parameter="nets",
            allowed=f"at least {_LEAST_NETS}",
        )
    number, value, spread, share, twine = (item[good] for item in (number, value, spread, share, twine))
    if float(np.ptp(share)) < 0.01:
        raise InputError("all nets have one solidity", parameter="nets", remedy="tow nets of different solidity")
    x, y, d = np.log(number), np.log(value), np.log(twine)
    if float(np.ptp(x)) < 0.1:
        raise InputError(
            "the Reynolds numbers of the runs hardly differ", parameter="runs", remedy="tow at several speeds"
        )
    noise = np.square(spread / value)
    # a diameter that solidity already gives, or too few nets, leaves nothing to learn from it
    per_net = np.array([[share[index == k][0], d[index == k][0]] for k in range(len(names))])
    distinct = float(np.ptp(d)) > 0.1 and len(names) > _LEAST_NETS
    with_diameter = distinct and abs(float(np.corrcoef(per_net.T)[0, 1])) < 0.98
    data = _prepared(index, x, share, d, y, noise, with_diameter)
    beta, covariance, (scatter, between, prior) = _estimate(data)
    used = beta.size
    turn = data.back[:, :used]
    left, pooled = _left_out(index, x, share, d, y, noise, with_diameter, (scatter, between, prior))
    return JointLaw(
        coefficients=turn @ beta,
        covariance=turn @ covariance @ turn.T,
        scatter=scatter,
        between=between,
        prior=prior,
        reynolds_range=(float(number.min()), float(number.max())),
        solidity_range=(float(share.min()), float(share.max())),
        diameter_range=(float(twine.min()), float(twine.max())),
        count=int(number.size),
        nets=len(names),
        left_out_error=left,
        pooled_error=pooled,
        confidence=confidence,
    )


def _left_out(
    net: NDArray[np.intp],
    x: Array,
    s: Array,
    d: Array,
    y: Array,
    noise: Array,
    with_diameter: bool,
    widths: tuple[float, float, float],
) -> tuple[float, float]:
    """Return the errors of prediction of nets left out one by one, by the law and by one power law for all."""
    law: list[float] = []
    pooled: list[float] = []
    for k in range(int(net.max()) + 1):
        rest, out = net != k, net == k
        if float(np.ptp(s[rest])) < 1e-6 or float(np.ptp(x[rest])) < 1e-6:
            continue
        data = _prepared(net[rest], x[rest], s[rest], d[rest], y[rest], noise[rest], with_diameter)
        for errors, prior in ((law, widths[2]), (pooled, 1e-6)):
            beta, _, _ = _solve(data, widths[0], widths[1], prior)
            found = data.back[:, : beta.size] @ beta
            rows = np.stack([np.ones_like(x), x, s, s * x, d], axis=-1)[out]
            errors.append(float(np.mean(np.square(y[out] - rows @ found))))
    if not law:
        return math.nan, math.nan
    return math.sqrt(float(np.mean(law))), math.sqrt(float(np.mean(pooled)))
