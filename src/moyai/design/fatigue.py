"""Fatigue of lines: cycles counted, curves of endurance, damage.

Theory in docs/theory/fatigue.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.single import plain


@checks_words
@dataclass(frozen=True)
class EnduranceCurve:
    """Cycles to failure ``N = capacity / range^exponent``.

    Examples
    --------
    >>> from moyai.design import EnduranceCurve
    >>> curve = EnduranceCurve("own", exponent=3.0, capacity=1000.0, unit="1", confirmed=True, source="own tests")
    >>> round(curve.cycles_to_failure(0.1))                              # range over the breaking load [-]
    1000000
    """

    name: str
    #: Inverse slope m.
    exponent: float
    #: Number of cycles at a range of one (ratio to the breaking load, or stress in ``unit``).
    capacity: float
    #: ``1`` where ranges are ratios to the breaking load (T-N), ``MPa`` where they are stresses (S-N), ``N`` where they
    #: are forces.
    unit: Literal["1", "MPa", "N"]
    #: Whether the values were compared with the standard itself.
    confirmed: bool
    source: str

    def cycles_to_failure(self, ranges: ArrayLike) -> Any:
        """Return the number of cycles to failure; infinite at zero range [eq:fatigue-curve].

        Parameters
        ----------
        ranges : array_like (...)
            In the unit of the curve.

        Returns
        -------
        float or ndarray (...)
            [-].
        """
        r = np.asarray(ranges, dtype=float)
        with np.errstate(divide="ignore"):
            return plain(self.capacity / r**self.exponent)


def damage(ranges: ArrayLike, counts: ArrayLike, curve: EnduranceCurve) -> float:
    """Return the Palmgren-Miner sum of counted cycles [eq:fatigue-miner].

    Parameters
    ----------
    ranges : array_like (n,)
        In the unit of the curve.
    counts : array_like (n,)
        Numbers of cycles.
    curve : EnduranceCurve
        Cycles to failure against range.

    Returns
    -------
    float
        Share of the life that is used; 1 is failure.

    Raises
    ------
    InputError
        When a range or a number of cycles is negative.

    Examples
    --------
    >>> from moyai.design import EnduranceCurve, damage
    >>> curve = EnduranceCurve("own", exponent=3.0, capacity=1000.0, unit="1", confirmed=True, source="own tests")
    >>> round(damage([0.1, 0.2], [1e4, 1e3], curve), 3)
    0.018
    """
    r, n = np.asarray(ranges, dtype=float), np.asarray(counts, dtype=float)
    if np.any(r < 0.0) or np.any(n < 0.0):
        raise InputError("ranges and numbers of cycles are zero or more", parameter="ranges")
    return float(np.sum(n * r**curve.exponent) / curve.capacity)


def equivalent_range(ranges: ArrayLike, counts: ArrayLike, exponent: float, cycles: float) -> float:
    """Return the constant range that does the same damage in a number of cycles [eq:fatigue-equivalent].

    Parameters
    ----------
    ranges : array_like (n,)
        Any unit.
    counts : array_like (n,)
        Cycles of each range.
    exponent : float
        Of the endurance curve.
    cycles : float
        Number of equal cycles, above 0.

    Returns
    -------
    float
        In the unit of ``ranges``.

    Raises
    ------
    InputError
        For cycles that are not above zero.

    Examples
    --------
    >>> from moyai.design import equivalent_range
    >>> round(equivalent_range([1.0, 2.0], [7.0, 1.0], exponent=3.0, cycles=15.0), 6)   # (7 + 8) / 15
    1.0
    """
    if not cycles > 0.0:
        raise InputError(f"{cycles:g} cycles", parameter="cycles", allowed="above 0")
    r, n = np.asarray(ranges, dtype=float), np.asarray(counts, dtype=float)
    return float((np.sum(n * r**exponent) / cycles) ** (1.0 / exponent))


def dirlik_damage(moments: ArrayLike, duration: float, curve: EnduranceCurve) -> float:
    """Return the damage of a Gaussian response by Dirlik's formula [eq:fatigue-dirlik].

    Parameters
    ----------
    moments : array_like (5,)
        Spectral moments m0 to m4 in frequency [unit^2 Hz^n], unit that of the curve; m3 is not used.
    duration : float
        [s].
    curve : EnduranceCurve
        Cycles to failure against range.

    Returns
    -------
    float
        Sum of Palmgren and Miner [-].

    Raises
    ------
    InputError
        For moments that are not above zero.

    Notes
    -----
    Dirlik (1985); fitted to spectra with irregularity between 0.16 and 0.99. The ranges of a narrow-banded response
    follow Rayleigh's law, with the damage [eq:fatigue-narrow], which is an upper bound for wide bands.

    References
    ----------
    T. Dirlik (1985), Application of computers in fatigue analysis, PhD thesis, University of Warwick.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.design import EnduranceCurve, dirlik_damage
    >>> curve = EnduranceCurve("own", exponent=3.0, capacity=1000.0, unit="1", confirmed=True, source="own tests")
    >>> frequency = np.linspace(0.05, 0.5, 200)                          # [Hz]
    >>> density = np.exp(-(((frequency - 0.15) / 0.05) ** 2)) * 1e-2     # of the tension over the breaking load [1/Hz]
    >>> moments = [float(np.sum(frequency**n * density) * (frequency[1] - frequency[0])) for n in range(5)]
    >>> one, two = (dirlik_damage(moments, hours * 3600.0, curve) for hours in (3.0, 6.0))
    >>> round(two / one, 6), one > 0.0                                   # twice the time, twice the damage
    (2.0, True)
    """
    m0, m1, m2, _, m4 = np.asarray(moments, dtype=float)
    if min(m0, m1, m2, m4) <= 0.0:
        raise InputError("spectral moments are above zero", parameter="moments")
    peaks = math.sqrt(m4 / m2)
    irregularity = m2 / math.sqrt(m0 * m4)
    mean_frequency = m1 / m0 * math.sqrt(m2 / m4)
    d1 = 2.0 * (mean_frequency - irregularity**2) / (1.0 + irregularity**2)
    r = (irregularity - mean_frequency - d1**2) / (1.0 - irregularity - d1 + d1**2)
    d2 = (1.0 - irregularity - d1 + d1**2) / (1.0 - r)
    d3 = 1.0 - d1 - d2
    q = 1.25 * (irregularity - d3 - d2 * r) / d1
    m = curve.exponent
    power = (2.0 * math.sqrt(m0)) ** m * (
        d1 * q**m * math.gamma(1.0 + m) + math.sqrt(2.0) ** m * math.gamma(1.0 + m / 2.0) * (d2 * abs(r) ** m + d3)
    )
    return float(peaks * duration * power / curve.capacity)


def life(damage_of_states: ArrayLike, probability: ArrayLike, duration: float) -> float:
    """Return the fatigue life over a scatter diagram [eq:fatigue-miner].

    Parameters
    ----------
    damage_of_states : array_like (n,)
        Damage of every sea state in ``duration``.
    probability : array_like (n,)
        Share of the time of every sea state; sums to one.
    duration : float
        Of a sea state [s].

    Returns
    -------
    float
        Years until the sum of Palmgren and Miner reaches one, infinite without damage; divide by the safety factor of
        the code.

    Raises
    ------
    InputError
        When the probabilities do not sum to one.

    Examples
    --------
    >>> from moyai.design import life
    >>> round(life([1e-6, 1e-4], [0.9, 0.1], duration=3600.0), 2)        # 1 / 1.09e-5 hours, in years
    10.47
    """
    share = np.asarray(probability, dtype=float)
    if abs(share.sum() - 1.0) > 1e-3:
        raise InputError(f"the probabilities sum to {share.sum():.6g}, not to 1", parameter="probability")
    rate = float(np.sum(share * np.asarray(damage_of_states, dtype=float))) / duration
    return math.inf if rate == 0.0 else 1.0 / (rate * 365.25 * 86400.0)
