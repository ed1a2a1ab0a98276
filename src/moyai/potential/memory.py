"""Memory functions of the water in both forms, with exact ends, and the identities that they obey.

The radiation force is -A_inf x'' - integral of K(t - s) x'(s) ds, or with lambda on the acceleration; mixing the kernel
of one form with the derivative of the other is the classic error, so both carry their form in their name. See
docs/theory/memory.md.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.validity import IdentityCheck
from moyai.potential.damping_model import DampingModel, Start, fit_damping
from moyai.potential.damping_tail import TailTheory
from moyai.potential.oscillatory import fourier_integral
from moyai.sea.water import Water

_KERNEL_TOLERANCE = 1e-3
_RELATION_TOLERANCE = 5e-3
#: Instants of a check that makes its own grid of time.
_MOST_INSTANTS = 4000


@dataclass(frozen=True)
class MemoryFunctions:
    """Both memory functions on a time grid."""

    #: [s]; shape (t,).
    time: Array
    #: K: the force is -integral of K(t - s) velocity(s) ds; shape (t, m, m).
    velocity_kernel: Array
    #: lambda = integral of K: the force is -integral of lambda(t - s) acceleration(s) ds. It tends to
    #: ``steady_dashpot``, not to zero. Shape (t, m, m).
    acceleration_kernel: Array
    #: D(0). ``acceleration_kernel - steady_dashpot`` is what decays. Shape (m, m).
    steady_dashpot: Array
    #: The added mass that goes with both forms; shape (m, m).
    infinite_frequency_added_mass: Array
    #: Damping at every frequency, with the tails and why they were chosen.
    model: DampingModel
    #: Integral of K against lambda, Kramers-Kronig and Ogilvie relations, resolution of the frequencies.
    checks: tuple[IdentityCheck, ...]


@checks_words
def memory_functions(
    omega: ArrayLike,
    radiation_damping: ArrayLike,
    infinite_frequency_added_mass: ArrayLike,
    time: ArrayLike,
    *,
    start: Start,
    steady_damping: ArrayLike | None = None,
    tail_theory: Sequence[TailTheory] = (),
    added_mass: ArrayLike | None = None,
) -> MemoryFunctions:
    """Return both memory functions of a body [eq:memory-velocity-kernel] [eq:memory-acceleration-kernel].

    Parameters
    ----------
    omega : array_like (n,)
        Increasing, greater than 0 [rad/s]; see :func:`recommend_frequencies`.
    radiation_damping : array_like (n, m, m)
        B [kg/s, kg m/s, kg m2/s], or the same per metre.
    infinite_frequency_added_mass : array_like (m, m)
        A_inf of the problem with phi = 0 on the surface [kg, kg m, kg m2], or the same per metre.
    time : array_like (t,)
        Increasing from 0 [s].
    start : {"even", "zero"}
        Low-frequency form of the damping: ``even`` in two dimensions and finite depth, else ``zero``.
    steady_damping : array_like (m, m), optional
        B(0) where theory gives it.
    tail_theory : sequence of TailTheory
        Exact high-frequency terms, for instance :func:`moyai.potential.damping_tail.wall_sided_tails`.
    added_mass : array_like (n, m, m), optional
        A(omega) of the same solution: enables the Ogilvie and Kramers-Kronig checks.

    Returns
    -------
    MemoryFunctions
        Kernels of velocity and acceleration at ``time``, shape (t, m, m), the damping model behind them and the checks.

    Raises
    ------
    InputError
        When shapes disagree, or something is not finite or not increasing.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.potential import memory_functions
    >>> omega = np.linspace(0.05, 20.0, 200)
    >>> damping = (omega**2 * np.exp(-omega)).reshape(-1, 1, 1)
    >>> memory = memory_functions(omega, damping, [[1.0]], np.linspace(0.0, 10.0, 201), start="zero")
    >>> memory.velocity_kernel.shape
    (201, 1, 1)
    >>> round(float(memory.velocity_kernel[0, 0, 0]), 2)                 # 4 / pi in theory [kg/s2]
    1.27
    """
    model = fit_damping(omega, radiation_damping, start=start, steady_damping=steady_damping, tail_theory=tail_theory)
    infinite = np.asarray(infinite_frequency_added_mass, dtype=float)
    if infinite.shape != model.steady.shape or not np.isfinite(infinite).all():
        raise InputError(
            f"infinite-frequency added mass has the shape {infinite.shape} or is not finite",
            parameter="infinite_frequency_added_mass",
            allowed=f"{model.steady.shape}",
        )
    t = np.asarray(time, dtype=float)
    if t.ndim != 1 or len(t) < 2 or t[0] != 0.0 or (np.diff(t) <= 0.0).any():
        raise InputError("time does not increase from 0", parameter="time")
    kernel = model.velocity_kernel(t)
    integral = model.acceleration_kernel(t)
    w = np.asarray(omega, dtype=float)
    checks = [_integral_check(model, t, kernel, integral), _resolution_check(w, np.asarray(radiation_damping), start)]
    if added_mass is not None:
        mass = np.asarray(added_mass, dtype=float)
        if mass.shape != (len(w), *infinite.shape):
            raise InputError(f"added mass has the shape {mass.shape}", parameter="added_mass")
        checks.append(kramers_kronig_check(model, w, mass, infinite))
        checks.append(_ogilvie_check(model, w, mass, infinite, t, kernel))
    return MemoryFunctions(t, kernel, integral, model.steady, infinite, model, tuple(checks))


def steady_damping(volume_rate: ArrayLike, water: Water) -> Array:
    """Return D(0) per metre in two dimensions, rho sqrt(g/h) q_i q_j / 2, [eq:memory-steady] [kg/(m s)].

    A slow motion that displaces volume pushes it out to both sides as long waves, whose power does not vanish.

    Parameters
    ----------
    volume_rate : array_like (m,)
        q, volume per metre and second pushed out when a mode moves inwards with unit velocity: the breadth b at the
        waterline for heave, 0 for sway, -b (x_w - x_c) for roll about x_c of waterlines centred at x_w; 0 for bodies
        wholly under water [m, m2].
    water : Water
        Infinite depth gives 0.
    """
    q = np.atleast_1d(np.asarray(volume_rate, dtype=float))
    return 0.5 * water.density * math.sqrt(water.gravity / water.depth) * np.outer(q, q)


def pair_measure(values: Array) -> Array:
    """Return the largest magnitudes (m, m) that errors of the entries (n, m, m) are measured against.

    An entry (i, j) is measured against the geometric mean of (i, i) and (j, j) where that is larger: a coupling that
    vanishes by symmetry is no relative error.
    """
    top = np.abs(values).max(axis=0)
    own = np.sqrt(np.outer(np.diag(top), np.diag(top)))
    measure = np.maximum(top, own)
    return np.where(measure > 0.0, measure, 1.0)


def _integral_check(model: DampingModel, t: Array, kernel: Array, integral: Array) -> IdentityCheck:
    """Lambda against the integral of K, both quadratures independent, on Gauss points of the time steps."""
    node, weight = np.polynomial.legendre.leggauss(6)
    chosen = np.unique(np.linspace(0, len(t) - 1, min(len(t), 40)).astype(int))
    # K varies over pi / last frequency; long steps of the chosen instants are cut into such pieces
    longest = 3.0 / model.knots[-1]
    edges = [t[0]]
    for left, right in zip(t[chosen[:-1]], t[chosen[1:]], strict=True):
        count = max(1, min(_MOST_INSTANTS, math.ceil((right - left) / longest)))
        edges.extend(left + (right - left) * np.arange(1, count + 1) / count)
    edge = np.array(edges)
    half = 0.5 * np.diff(edge)
    points = (edge[:-1, None] + half[:, None] * (node + 1.0)).ravel()
    pieces = model.velocity_kernel(points).reshape(len(half), len(node), *kernel.shape[1:])
    sums = np.concatenate(
        [
            np.zeros((1, *kernel.shape[1:])),
            np.cumsum(np.einsum("k,kq...->k...", half, pieces * weight[:, None, None]), 0),
        ]
    )
    at = np.searchsorted(edge, t[chosen] * (1.0 - 1e-12))
    # Output that misses the first swing of lambda would measure an error by what is left of it
    largest = integral if float(np.max(np.diff(t))) <= longest else sums
    error = np.abs(sums[at] - integral[chosen]) / pair_measure(largest)
    return IdentityCheck(
        "lambda is the integral of K", float(error.max()), _KERNEL_TOLERANCE, "lambda(t) = int_0^t K, two quadratures"
    )


def _resolution_check(w: Array, damping: Array, start: Start) -> IdentityCheck:
    """Damping at every other frequency from the spline through the rest."""
    return IdentityCheck(
        "frequencies resolve the damping",
        float(np.max(local_errors(w, damping, start=start))),
        _RELATION_TOLERANCE,
        "spline through all frequencies against those through every other one, extrapolated to the full grid",
    )


@checks_words
def local_errors(omega: Array, damping: Array, *, start: Start) -> Array:
    """Return an estimate (n,) of the interpolation error around each frequency, over the largest damping.

    Each frequency is left out in turn with every second neighbour; the error of the full grid is some 2^5 smaller.
    """
    out = np.zeros(len(omega))
    measure = pair_measure(damping)
    for parity in (0, 1):
        keep = np.arange(len(omega)) % 2 == parity
        keep[[0, -1]] = True
        if keep.sum() < 8:
            return np.full(len(omega), np.inf)
        model = fit_damping(omega[keep], damping[keep], start=start)
        left = ~keep
        out[left] = (np.abs(model.damping(omega[left]) - damping[left]) / measure).max(axis=(1, 2)) / 2.0**5
    return out


def kramers_kronig_check(model: DampingModel, omega: Array, added_mass: Array, infinite: Array) -> IdentityCheck:
    """Hold A(omega) against A_inf and the Hilbert transform of the damping, [eq:memory-kramers-kronig]."""
    error = np.abs(added_mass - infinite - model.added_mass_excess(omega)) / pair_measure(added_mass)
    return IdentityCheck(
        "Kramers-Kronig", float(error.max()), _RELATION_TOLERANCE, "A - A_inf = (2/pi) PV int B/(x^2 - omega^2) dx"
    )


def _ogilvie_check(
    model: DampingModel,
    omega: Array,
    added_mass: Array,
    infinite: Array,
    t: Array,
    kernel: Array,
) -> IdentityCheck:
    """Hold A_inf against A + (1/omega) int K sin, [eq:memory-ogilvie], from K on a grid of time.

    The grid is that of the output where it resolves K and is long enough for half of the frequencies to turn within
    it; else one of its own.
    """
    from scipy.interpolate import CubicSpline

    needed = 12.0 * math.pi / float(np.median(omega))
    if float(np.max(np.diff(t))) > 1.0 / model.knots[-1] or t[-1] < 0.5 * needed:
        step = 0.25 / model.knots[-1]
        t = step * np.arange(min(math.ceil(max(needed, t[-1]) / step), _MOST_INSTANTS) + 1)
        kernel = model.velocity_kernel(t)
    spline = CubicSpline(t, kernel, axis=0)
    transform = fourier_integral(t, spline.c[::-1], omega).imag
    # Frequencies that the time grid resolves and that turn within it
    step, length = float(np.max(np.diff(t))), float(t[-1])
    fit = (omega * step < 1.0) & (omega * length > 6.0 * math.pi)
    error = np.abs(added_mass + transform / omega[:, None, None] - infinite)[fit] / pair_measure(added_mass)
    return IdentityCheck(
        "Ogilvie", float(error.max()), _RELATION_TOLERANCE, "A_inf = A + (1/omega) int K sin(omega t) dt at every omega"
    )
