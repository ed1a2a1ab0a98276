"""Radiation damping as a function of every frequency: spline, exact tail, exact start; its Hilbert partner."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.curves import Spline, in_pieces
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.potential.damping_tail import Tail, TailTheory, choose_tail
from moyai.potential.oscillatory import fourier_integral

Start = Literal["even", "zero"]

_FEWEST = 8
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_ASYMPTOTIC = 1e4  # times the last frequency: beyond it only the leading power of the tail counts


@dataclass(frozen=True)
class DampingModel:
    """Radiation damping between 0 and infinity."""

    #: Frequencies from 0 to the last one given [rad/s]; shape (n + 1,).
    knots: Array
    #: Local powers of the damping on every interval, lowest first; shape (6, n, m, m).
    coefficients: Array
    #: The same of (damping - steady)/omega; shape (6, n, m, m).
    over_frequency: Array
    #: Damping at zero frequency, D(0); shape (m, m).
    steady: Array
    #: Beyond the last frequency.
    tails: tuple[tuple[Tail, ...], ...]

    @property
    def size(self) -> int:
        """Number of modes."""
        return int(self.steady.shape[0])

    def damping(self, omega: ArrayLike) -> Array:
        """Return the damping (k, m, m) at any frequencies [rad/s].

        Parameters
        ----------
        omega : array_like (k,)
            Frequencies [rad/s]; the sign does not matter.
        """
        x = np.abs(np.atleast_1d(np.asarray(omega, dtype=float)))
        inside = np.minimum(x, self.knots[-1])
        out: Array = in_pieces(self.knots, self.coefficients, inside)
        beyond = x > self.knots[-1]
        if beyond.any():
            for i, row in enumerate(self.tails):
                for j, tail in enumerate(row):
                    out[beyond, i, j] = tail.damping(x[beyond])
        return out

    def velocity_kernel(self, time: ArrayLike) -> Array:
        """Return K(t) = (2/pi) integral of B cos(omega t), (t, m, m), [eq:memory-velocity-kernel].

        Parameters
        ----------
        time : array_like (t,)
            Times, 0 or later [s].

        Raises
        ------
        InputError
            For times that are negative or not finite.
        """
        t = _times(time)
        out = fourier_integral(self.knots, self.coefficients, t).real
        for i, row in enumerate(self.tails):
            for j, tail in enumerate(row):
                out[:, i, j] += tail.cosine(t)
        return 2.0 / np.pi * out

    def acceleration_kernel(self, time: ArrayLike) -> Array:
        """Return lambda(t) = (2/pi) integral of B/omega sin(omega t), (t, m, m), [eq:memory-acceleration-kernel].

        Parameters
        ----------
        time : array_like (t,)
            Times, 0 or later [s].

        Raises
        ------
        InputError
            For times that are negative or not finite.
        """
        from scipy.special import sici

        t = _times(time)
        out = fourier_integral(self.knots, self.over_frequency, t).imag
        out += sici(self.knots[-1] * t)[0][:, None, None] * self.steady
        for i, row in enumerate(self.tails):
            for j, tail in enumerate(row):
                out[:, i, j] += tail.sine_over_frequency(t)
        return 2.0 / np.pi * out

    def added_mass_excess(self, omega: ArrayLike) -> Array:
        """Return A(omega) - A(infinity), (k, m, m), from the damping alone, [eq:memory-kramers-kronig].

        The principal value is taken by subtracting B(omega), whose own principal value is zero.

        Parameters
        ----------
        omega : array_like (k,)
            Frequencies, greater than 0 [rad/s].

        Raises
        ------
        InputError
            For a frequency that is not positive.
        """
        w = np.atleast_1d(np.asarray(omega, dtype=float))
        if (w <= 0.0).any():
            raise InputError("a frequency is not positive", parameter="omega", allowed="greater than 0")
        last = self.knots[-1]
        edges = np.concatenate([self.knots, last * np.geomspace(1.0, _ASYMPTOTIC, 48)[1:]])
        half = 0.5 * np.diff(edges)
        x = (edges[:-1, None] + half[:, None] * (_POINTS + 1.0)).ravel()
        weight = (half[:, None] * _WEIGHTS).ravel()
        values = self.damping(x).reshape(len(x), -1)
        own = self.damping(w).reshape(len(w), -1)
        # A node that falls on a frequency would divide nothing by nothing; the next number does
        points = np.where(np.isin(x, w), np.nextafter(x, np.inf), x)
        kernel = weight / ((points - w[:, None]) * (points + w[:, None]))
        out = kernel @ values - kernel.sum(axis=1)[:, None] * own
        end = edges[-1]
        out -= own * (np.arctanh(w / end) / w)[:, None]
        found: Array = (2.0 / np.pi * out).reshape(len(w), self.size, self.size)
        return found

    def response(self, omega: ArrayLike) -> ComplexArray:
        """Return the transform of K, integral of K exp(i omega t) = B - i omega (A - A_inf), (k, m, m).

        Parameters
        ----------
        omega : array_like (k,)
            Frequencies, greater than 0 [rad/s].

        Raises
        ------
        InputError
            For a frequency that is not positive.
        """
        w = np.atleast_1d(np.asarray(omega, dtype=float))
        return np.asarray(self.damping(w) - 1j * w[:, None, None] * self.added_mass_excess(w), dtype=complex)

    def second_derivative(self) -> Array:
        """Return -(2/pi) integral of B omega^2 up to the last frequency, (m, m): the curvature of K at its start."""
        half = 0.5 * np.diff(self.knots)
        x = (self.knots[:-1, None] + half[:, None] * (_POINTS + 1.0)).ravel()
        weight = (half[:, None] * _WEIGHTS).ravel()
        values: Array = -2.0 / np.pi * np.einsum("k,kij->ij", weight * x**2, self.damping(x))
        return values


def _times(time: ArrayLike) -> Array:
    t = np.atleast_1d(np.asarray(time, dtype=float))
    if t.ndim != 1 or not np.isfinite(t).all() or (t < 0.0).any():
        raise InputError("time has entries that are negative or not finite", parameter="time", allowed="at least 0")
    return t


@checks_words
def fit_damping(
    omega: ArrayLike,
    radiation_damping: ArrayLike,
    *,
    start: Start,
    steady_damping: ArrayLike | None = None,
    tail_theory: Sequence[TailTheory] = (),
) -> DampingModel:
    """Pass a spline of fifth degree through the damping and close it at both ends.

    Parameters
    ----------
    omega : array_like (n,)
        Increasing, greater than 0 [rad/s].
    radiation_damping : array_like (n, m, m)
        B; [frequency, influenced, radiating].
    start : {"even", "zero"}
        ``even``: water of finite depth in two dimensions, where B is an even function of omega and may start with a
        value; ``zero``: infinite depth or a body of finite length, where B(0) = 0.
    steady_damping : array_like (m, m), optional
        B(0) where theory gives it (:func:`moyai.potential.memory.steady_damping`); taken from the even
        extension of the data otherwise.
    tail_theory : sequence of TailTheory
        Exact leading terms at high frequency.

    Raises
    ------
    InputError
        When there are too few frequencies or something is not finite.
    """
    w = np.asarray(omega, dtype=float)
    b = np.asarray(radiation_damping, dtype=float)
    if w.ndim != 1 or len(w) < _FEWEST:
        raise InputError(f"{w.size} frequencies", parameter="omega", allowed=f"at least {_FEWEST}, in one dimension")
    if not np.isfinite(w).all() or w[0] <= 0.0 or (np.diff(w) <= 0.0).any():
        raise InputError("omega is not finite, positive and increasing", parameter="omega")
    if b.ndim != 3 or b.shape[0] != len(w) or b.shape[1] != b.shape[2] or not np.isfinite(b).all():
        raise InputError(
            f"radiation damping has the shape {b.shape} or is not finite",
            parameter="radiation_damping",
            allowed=f"({len(w)}, m, m)",
        )
    steady = None if steady_damping is None else np.asarray(steady_damping, dtype=float)
    if start == "zero":
        steady = np.zeros(b.shape[1:])
    knots = np.concatenate([[0.0], w])
    spline = _spline(w, b, steady, even=start == "even", sign=1.0)
    if steady is None:
        steady = spline(0.0)
    quotient = _spline(w, (b - steady) / w[:, None, None], np.zeros_like(steady), even=start == "even", sign=-1.0)
    if start == "zero":
        quotient = _spline(w, b / w[:, None, None], None, even=False, sign=1.0)
    slope = spline(w[-1], 1)
    top = np.abs(b).max(axis=0)
    measure = np.maximum(np.sqrt(np.outer(np.diag(top), np.diag(top))), top)
    theory = {item.entry: item for item in tail_theory}
    tails = tuple(
        tuple(
            choose_tail(w, b[:, i, j], float(slope[i, j]), float(measure[i, j]), theory.get((i, j)))
            for j in range(b.shape[2])
        )
        for i in range(b.shape[1])
    )
    return DampingModel(knots, _pieces(spline, knots), _pieces(quotient, knots), steady, tails)


def _spline(w: Array, values: Array, at_zero: Array | None, *, even: bool, sign: float) -> Spline:
    """Interpolate; ``even`` mirrors the data with a sign about zero frequency, so that the start is exact."""
    if even:
        middle = [] if at_zero is None else [at_zero[None]]
        x = np.concatenate([-w[::-1], np.zeros(len(middle)), w])
        y = np.concatenate([sign * values[::-1], *middle, values])
    elif at_zero is not None:
        x, y = np.concatenate([[0.0], w]), np.concatenate([at_zero[None], values])
    else:
        x, y = w, values
    return Spline(x, y, 5)


def _pieces(spline: Spline, knots: Array) -> Array:
    """Local powers of a spline on every interval; its own knots lie among them or where it is smooth."""
    out = np.empty((6, len(knots) - 1, *spline.powers.shape[2:]))
    factor = 1.0
    # From inside each interval, since not-a-knot ends let the first intervals share one polynomial
    for power in range(6):
        factor *= max(power, 1)
        # the fifth derivative jumps at the knots: the middle of the interval is the safe place for it
        at = 0.5 * (knots[:-1] + knots[1:]) if power == 5 else knots[:-1]
        out[power] = spline(at, power) / factor
    return out
