"""Numbers in sentences for people."""

from __future__ import annotations

import math

_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""))


def spoken(value: float, unit: str, digits: int = 4, *, like: float | None = None) -> str:
    """Return a number with its unit as an engineer writes it: ``49.21 kN``, never ``4.921e+04 N``.

    Parameters
    ----------
    value : float
        In the unit named.
    unit : str
        A unit that takes prefixes, for instance ``N``; prefixes enlarge only (millinewtons interest nobody).
    digits : int
        Significant digits.
    like : float, optional
        Take the prefix that this value would get, so that the numbers of a sentence compare at sight.
    """
    if not math.isfinite(value):
        return f"{value} {unit}"
    size = abs(float(f"{value if like is None else like:.{digits}g}"))
    factor, prefix = next((entry for entry in _PREFIXES if size >= entry[0]), (1.0, ""))
    return f"{value / factor:.{digits}g} {prefix}{unit}"


def kilonewton(force: float) -> str:
    """Return a force in kilonewtons to the kilonewton from 100 kN on, to three digits below, in newtons below 1 kN."""
    if abs(force) < 1e3:
        return f"{force:.3g} N"
    return f"{1e-3 * force:.0f} kN" if abs(force) >= 1e5 else f"{1e-3 * force:.3g} kN"


def counted(number: int, word: str) -> str:
    """Return how many there are of something: ``1 case``, ``2 cases``.

    Parameters
    ----------
    number : int
    word : str
        For one of them; several take an s.
    """
    return f"{number} {word}" if number == 1 else f"{number} {word}s"


def spoken_time(seconds: float) -> str:
    """Return a length of time as people say it: ``40 s``, ``4.6 min``, ``3 h``."""
    size, unit = (1.0, "s") if seconds < 120.0 else (60.0, "min") if seconds < 7200.0 else (3600.0, "h")
    return f"{seconds / size:.3g} {unit}"
