"""Directional spreading: how the energy of one frequency is shared among headings.

Offsets are measured from the mean heading, in (-pi, pi]. Every function integrates to one over all headings exactly
[eq:sea-spreading], and each has its distribution function and inverse, from which headings are drawn.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError

#: s_max of Goda and Suzuki (1975) for design in deep water where no measurement gives better.
GODA_MAXIMUM_EXPONENTS: dict[str, float] = {"wind sea": 10.0, "young swell": 25.0, "old swell": 75.0}


def wrapped(angle: ArrayLike) -> Array:
    """Return angles [rad] brought into [-pi, pi]."""
    value = np.asarray(angle, dtype=np.float64)
    turned = np.remainder(value + math.pi, 2.0 * math.pi) - math.pi
    # an angle that already lies inside is handed back untouched
    return np.where(np.abs(value) <= math.pi, value, turned)


class Spreading(ABC):
    """A directional spreading function G(offset; omega) [1/rad]."""

    @abstractmethod
    def density(self, offset: ArrayLike, omega: ArrayLike) -> Array:
        """Return G [1/rad] at offsets [rad] from the mean heading, for frequencies [rad/s] (broadcast).

        Parameters
        ----------
        offset : array_like (...)
            From the mean heading [rad].
        omega : array_like (...)
            [rad/s].
        """

    @abstractmethod
    def cumulative(self, offset: ArrayLike, omega: ArrayLike) -> Array:
        """Return the fraction of the energy between -pi and ``offset`` [rad] in [-pi, pi].

        Parameters
        ----------
        offset : array_like (...)
            From the mean heading [rad].
        omega : array_like (...)
            [rad/s].
        """

    @abstractmethod
    def quantile(self, fraction: ArrayLike, omega: ArrayLike) -> Array:
        """Return the offset [rad] below which ``fraction`` of the energy lies.

        Parameters
        ----------
        fraction : array_like (...)
            0 to 1 [-].
        omega : array_like (...)
            [rad/s].
        """

    @abstractmethod
    def resultant(self, omega: ArrayLike) -> Array:
        """Return the first circular moment, the energy mean of cos(offset) [-].

        Parameters
        ----------
        omega : array_like (...)
            [rad/s].
        """

    def spread(self, omega: ArrayLike) -> Array:
        """Return the circular standard deviation sqrt(2 (1 - resultant)) of Kuik et al. (1988) [rad].

        Parameters
        ----------
        omega : array_like (...)
            [rad/s].
        """
        return np.asarray(np.sqrt(2.0 * (1.0 - self.resultant(omega))))


def _check_exponent(name: str, value: float) -> None:
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(f"{name} is {value:g}", parameter=name, allowed="greater than 0")


class _HalfAngle(Spreading):
    """cos^2s(offset / 2) with an exponent that may depend on the frequency."""

    @abstractmethod
    def exponent_at(self, omega: ArrayLike) -> Array:
        """Return s [-].

        Parameters
        ----------
        omega : array_like (...)
            [rad/s].
        """

    def density(self, offset: ArrayLike, omega: ArrayLike) -> Array:
        """Return G [1/rad] at offsets from the mean heading, for frequencies (broadcast).

        Parameters
        ----------
        offset : array_like (...)
            From the mean heading [rad].
        omega : array_like (...)
            [rad/s].
        """
        s, angle = self.exponent_at(omega), wrapped(offset)
        scale = np.exp(scipy.special.gammaln(s + 1.0) - scipy.special.gammaln(s + 0.5)) / (2.0 * math.sqrt(math.pi))
        return np.asarray(scale * np.abs(np.cos(0.5 * angle)) ** (2.0 * s))

    def cumulative(self, offset: ArrayLike, omega: ArrayLike) -> Array:
        """Return the fraction of the energy up to ``offset`` [-].

        Parameters
        ----------
        offset : array_like (...)
            From the mean heading [rad].
        omega : array_like (...)
            [rad/s].
        """
        s, angle = self.exponent_at(omega), wrapped(offset)
        half = 0.5 * scipy.special.betainc(0.5, s + 0.5, np.sin(0.5 * angle) ** 2)
        return np.asarray(0.5 + np.sign(angle) * half)

    def quantile(self, fraction: ArrayLike, omega: ArrayLike) -> Array:
        """Return the offset [rad] below which ``fraction`` of the energy lies.

        Parameters
        ----------
        fraction : array_like (...)
            0 to 1 [-].
        omega : array_like (...)
            [rad/s].
        """
        side = 2.0 * np.asarray(fraction, dtype=np.float64) - 1.0
        root = np.sqrt(scipy.special.betaincinv(0.5, self.exponent_at(omega) + 0.5, np.abs(side)))
        return np.asarray(np.sign(side) * 2.0 * np.arcsin(root))

    def resultant(self, omega: ArrayLike) -> Array:
        """Return the energy mean of cos(offset), s / (s + 1) [-].

        Parameters
        ----------
        omega : array_like (...)
            [rad/s].
        """
        s = self.exponent_at(omega)
        return np.asarray(s / (s + 1.0))


@dataclass(frozen=True)
class CosineTwoS(_HalfAngle):
    """cos^2s(offset/2) of Longuet-Higgins et al. (1963) with one exponent for all frequencies.

    Examples
    --------
    >>> from moyai.sea import CosineTwoS
    >>> round(float(CosineTwoS(10.0).cumulative(0.0, 1.0)), 6)           # half of the energy to either side
    0.5
    """

    #: s [-], greater than 0.
    exponent: float

    def __post_init__(self) -> None:
        _check_exponent("exponent", self.exponent)

    def exponent_at(self, omega: ArrayLike) -> Array:
        """Return s [-], the same at every frequency.

        Parameters
        ----------
        omega : array_like (...)
            [rad/s]; only its shape counts.
        """
        return np.full(np.shape(omega), self.exponent)


@dataclass(frozen=True)
class Mitsuyasu(_HalfAngle):
    """cos^2s(offset/2) with the frequency-dependent exponent of Mitsuyasu et al. (1975) [eq:sea-mitsuyasu].

    s = s_max (f/f_p)^5 below and s_max (f/f_p)^-2.5 above the peak frequency.

    Examples
    --------
    >>> from moyai.sea import Mitsuyasu
    >>> spreading = Mitsuyasu(maximum_exponent=10.0, peak_omega=1.0)
    >>> float(spreading.exponent_at(1.0))                                # at the peak
    10.0
    """

    #: s_max [-]; :data:`GODA_MAXIMUM_EXPONENTS` holds the usual choices.
    maximum_exponent: float
    #: Peak frequency [rad/s].
    peak_omega: float

    def __post_init__(self) -> None:
        _check_exponent("maximum_exponent", self.maximum_exponent)
        _check_exponent("peak_omega", self.peak_omega)

    def exponent_at(self, omega: ArrayLike) -> Array:
        """Return s [-] at ``omega`` [rad/s].

        Parameters
        ----------
        omega : array_like (...)
            [rad/s].
        """
        relative = np.asarray(omega, dtype=np.float64) / self.peak_omega
        with np.errstate(divide="ignore"):
            factor = np.where(relative <= 1.0, relative**5, relative**-2.5)
        return np.asarray(self.maximum_exponent * factor)


@dataclass(frozen=True)
class CosinePower(Spreading):
    """cos^n(offset) within 90 degrees of the mean heading, zero beyond.

    Examples
    --------
    >>> import math
    >>> from moyai.sea import CosinePower
    >>> round(float(CosinePower(2.0).density(0.0, 1.0)) * math.pi, 6)    # 2 / pi at the mean heading [1/rad]
    2.0
    """

    #: n [-], greater than 0.
    exponent: float

    def __post_init__(self) -> None:
        _check_exponent("exponent", self.exponent)

    def density(self, offset: ArrayLike, omega: ArrayLike) -> Array:
        """Return G [1/rad]; the frequency does not matter.

        Parameters
        ----------
        offset : array_like (...)
            From the mean heading [rad].
        omega : array_like (...)
            [rad/s]; only its shape counts.
        """
        angle, n = wrapped(offset), self.exponent
        scale = math.exp(
            float(scipy.special.gammaln(0.5 * n + 1.0) - scipy.special.gammaln(0.5 * n + 0.5))
        ) / math.sqrt(math.pi)
        value = scale * np.maximum(np.cos(angle), 0.0) ** n
        return np.asarray(np.broadcast_arrays(value, np.asarray(omega, float))[0])

    def cumulative(self, offset: ArrayLike, omega: ArrayLike) -> Array:
        """Return the fraction of the energy up to ``offset`` [rad].

        Parameters
        ----------
        offset : array_like (...)
            From the mean heading [rad].
        omega : array_like (...)
            [rad/s]; only its shape counts.
        """
        angle = np.clip(wrapped(offset), -0.5 * math.pi, 0.5 * math.pi)
        half = 0.5 * scipy.special.betainc(0.5, 0.5 * (self.exponent + 1.0), np.sin(angle) ** 2)
        return np.asarray(np.broadcast_arrays(0.5 + np.sign(angle) * half, np.asarray(omega, float))[0])

    def quantile(self, fraction: ArrayLike, omega: ArrayLike) -> Array:
        """Return the offset [rad] below which ``fraction`` of the energy lies.

        Parameters
        ----------
        fraction : array_like (...)
            0 to 1 [-].
        omega : array_like (...)
            [rad/s]; only its shape counts.
        """
        side = 2.0 * np.asarray(fraction, dtype=np.float64) - 1.0
        root = np.sqrt(scipy.special.betaincinv(0.5, 0.5 * (self.exponent + 1.0), np.abs(side)))
        return np.asarray(np.broadcast_arrays(np.sign(side) * np.arcsin(root), np.asarray(omega, float))[0])

    def resultant(self, omega: ArrayLike) -> Array:
        """Return the energy mean of cos(offset) [-].

        Parameters
        ----------
        omega : array_like (...)
            [rad/s]; only its shape counts.
        """
        n = self.exponent
        ratio = (
            2.0 * scipy.special.gammaln(0.5 * n + 1.0)
            - scipy.special.gammaln(0.5 * n + 0.5)
            - scipy.special.gammaln(0.5 * n + 1.5)
        )
        return np.full(np.shape(omega), math.exp(float(ratio)))


@dataclass(frozen=True)
class WrappedNormal(Spreading):
    """The normal distribution wrapped around the circle.

    Examples
    --------
    >>> import math
    >>> from moyai.sea import WrappedNormal
    >>> spreading = WrappedNormal(standard_deviation=math.radians(20.0))
    >>> round(float(spreading.cumulative(math.radians(20.0), 1.0)), 3)   # one standard deviation
    0.841
    """

    #: Of the unwrapped normal [rad], greater than 0.
    standard_deviation: float

    def __post_init__(self) -> None:
        _check_exponent("standard_deviation", self.standard_deviation)

    def _turns(self) -> Array:
        reach = math.ceil((9.0 * self.standard_deviation + math.pi) / (2.0 * math.pi))
        return np.asarray(2.0 * math.pi * np.arange(-reach, reach + 1), dtype=np.float64)

    def density(self, offset: ArrayLike, omega: ArrayLike) -> Array:
        """Return G [1/rad]; the frequency does not matter.

        Parameters
        ----------
        offset : array_like (...)
            From the mean heading [rad].
        omega : array_like (...)
            [rad/s]; only its shape counts.
        """
        deviation = (wrapped(offset)[..., None] + self._turns()) / self.standard_deviation
        value = np.exp(-0.5 * deviation**2).sum(axis=-1) / (math.sqrt(2.0 * math.pi) * self.standard_deviation)
        return np.asarray(np.broadcast_arrays(value, np.asarray(omega, float))[0])

    def cumulative(self, offset: ArrayLike, omega: ArrayLike) -> Array:
        """Return the fraction of the energy up to ``offset`` [rad].

        Parameters
        ----------
        offset : array_like (...)
            From the mean heading [rad].
        omega : array_like (...)
            [rad/s]; only its shape counts.
        """
        turns = self._turns()
        upto = scipy.special.ndtr((wrapped(offset)[..., None] + turns) / self.standard_deviation)
        value = (upto - scipy.special.ndtr((turns - math.pi) / self.standard_deviation)).sum(axis=-1)
        return np.asarray(np.broadcast_arrays(value, np.asarray(omega, float))[0])

    def quantile(self, fraction: ArrayLike, omega: ArrayLike) -> Array:
        """Return the offset [rad] below which ``fraction`` of the energy lies (bisection to rounding).

        Parameters
        ----------
        fraction : array_like (...)
            0 to 1 [-].
        omega : array_like (...)
            [rad/s]; only its shape counts.
        """
        wanted = np.broadcast_arrays(np.asarray(fraction, float), np.asarray(omega, float))[0]
        low, high = np.full(wanted.shape, -math.pi), np.full(wanted.shape, math.pi)
        for _ in range(55):
            middle = 0.5 * (low + high)
            above = self.cumulative(middle, 0.0) > wanted
            low, high = np.where(above, low, middle), np.where(above, middle, high)
        return np.asarray(0.5 * (low + high))

    def resultant(self, omega: ArrayLike) -> Array:
        """Return exp(-sigma^2 / 2) [-].

        Parameters
        ----------
        omega : array_like (...)
            [rad/s]; only its shape counts.
        """
        return np.full(np.shape(omega), math.exp(-0.5 * self.standard_deviation**2))
