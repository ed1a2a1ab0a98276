"""Numbers and units as an engineer reads them: display units, significant digits, a dash for what is not known."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.report.systems import in_tonnes_force

DASH = "–"  # an unknown number; a true minus is used for negative ones
MINUS = "\N{MINUS SIGN}"

_DEGREES = 180.0 / math.pi
# (unit in SI, smallest largest-value for which the unit is used, unit shown, factor from SI to the unit shown)
_DISPLAY: dict[str, tuple[tuple[float, str, float], ...]] = {
    "rad": ((0.0, "deg", _DEGREES),),
    "rad/m": ((0.0, "deg/m", _DEGREES),),
    "N": ((0.0, "N", 1.0), (1e3, "kN", 1e-3), (1e8, "MN", 1e-6)),
    "N/m": ((0.0, "N/m", 1.0), (1e4, "kN/m", 1e-3), (1e8, "MN/m", 1e-6)),
    "N m": ((0.0, "N m", 1.0), (1e4, "kN m", 1e-3), (1e8, "MN m", 1e-6)),
    "N/rad": ((0.0, "N/rad", 1.0), (1e4, "kN/rad", 1e-3), (1e8, "MN/rad", 1e-6)),
    "N m/rad": ((0.0, "N m/rad", 1.0), (1e4, "kN m/rad", 1e-3), (1e8, "MN m/rad", 1e-6)),
    "Pa": ((0.0, "Pa", 1.0), (1e4, "kPa", 1e-3), (1e6, "MPa", 1e-6), (1e10, "GPa", 1e-9)),
    "kg": ((0.0, "kg", 1.0), (1e4, "t", 1e-3)),
    "kg m": ((0.0, "kg m", 1.0), (1e4, "t m", 1e-3)),
    "kg m2": ((0.0, "kg m2", 1.0), (1e5, "t m2", 1e-3)),
    "kg/m": ((0.0, "kg/m", 1.0), (1e4, "t/m", 1e-3)),
    "N s/m": ((0.0, "N s/m", 1.0), (1e4, "kN s/m", 1e-3)),
    "N m s": ((0.0, "N m s", 1.0), (1e4, "kN m s", 1e-3)),
}
_NO_UNIT = {"", "1", "-"}
_QUANTITY = re.compile(
    rf"([-{MINUS}]?(?:\d+(?:\.\d+)?(?:e[-+]?\d+|×10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+))?|∞))"
    r"(?:(°)| ((?:1/)?[^\W\d_][^\s,;:()]*(?: per [^\s,;:()]+)?|%|°[^\s,;:()]*))?"
)
_SUPERSCRIPTS = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")
_LOWERED = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-")


@dataclass(frozen=True)
class DisplayUnit:
    """Unit in which a quantity is shown."""

    #: The unit shown, plain text (``kN m``); empty for a pure number.
    name: str
    #: Multiply a value in the stored unit by it.
    factor: float = 1.0

    @property
    def pretty(self) -> str:
        """The unit with raised exponents and middle dots, for reading."""
        return pretty_unit(self.name)


def pretty_unit(name: str) -> str:
    """Return ``kg/m3`` as ``kg/m³`` and ``N m`` as ``N·m``.

    Parameters
    ----------
    name : str
        Unit in plain text.

    Returns
    -------
    str
    """
    if name in _NO_UNIT:
        return ""
    if " per " in name:
        return " per ".join(pretty_unit(part) for part in name.split(" per "))
    name = re.sub(r"\bdeg", "°", name)
    raised = re.sub(r"(?<=[A-Za-z°])(-?\d+)", lambda match: match.group(1).translate(_SUPERSCRIPTS), name)
    return raised.replace(" ", "·")


def display_unit(unit: str, values: ArrayLike | None = None) -> DisplayUnit:
    """Choose the unit in which ``values`` are shown.

    Parameters
    ----------
    unit : str
        Unit of the stored values, SI and radians.
    values : array_like, optional
        The values; the largest magnitude among the finite ones chooses between N, kN and MN.

    Returns
    -------
    DisplayUnit
    """
    unit = unit.strip()
    if unit in _NO_UNIT:
        return DisplayUnit("")
    largest = largest_magnitude(values) if values is not None else 0.0
    if (heavy := in_tonnes_force(unit, largest)) is not None:
        return DisplayUnit(*heavy)
    if unit not in _DISPLAY:
        return DisplayUnit(unit)
    chosen = _DISPLAY[unit][0]
    for step in _DISPLAY[unit]:
        if largest >= step[0]:
            chosen = step
    return DisplayUnit(chosen[1], chosen[2])


def largest_magnitude(values: ArrayLike) -> float:
    """Return the largest finite magnitude, 0 where there is none."""
    array = np.abs(np.atleast_1d(np.asarray(values, dtype=float)))
    finite = array[np.isfinite(array)]
    return float(finite.max()) if finite.size else 0.0


def format_number(value: float, digits: int = 3) -> str:
    """Format a number with ``digits`` significant digits for reading.

    Integers up to 10**6 keep all their digits; NaN becomes a dash; very large and very small numbers are given with a
    power of ten.

    Parameters
    ----------
    value : float
        The number in the unit shown.
    digits : int
        Significant digits.

    Returns
    -------
    str

    Examples
    --------
    >>> format_number(0.33519), format_number(1852.31), format_number(float("nan"))
    ('0.335', '1852', '–')
    """
    number = float(value)
    if math.isnan(number):
        return DASH
    if math.isinf(number):
        return "∞" if number > 0 else f"{MINUS}∞"
    if number == 0.0:
        return "0"
    sign = MINUS if number < 0 else ""
    magnitude = float(f"{abs(number):.{digits - 1}e}")
    exponent = math.floor(math.log10(magnitude))
    if exponent < -3 or exponent >= 6:
        mantissa = magnitude / 10.0**exponent
        return f"{sign}{mantissa:.{digits - 1}f}×10{str(exponent).translate(_SUPERSCRIPTS)}"
    if exponent >= digits:
        return f"{sign}{abs(number):.0f}"
    return f"{sign}{magnitude:.{max(digits - 1 - exponent, 0)}f}"


def format_fixed(value: float, decimals: int) -> str:
    """Format a number with fixed decimals, so that the numbers of a column stand under each other."""
    number = float(value)
    if not math.isfinite(number) or abs(number) >= 1e6:
        return format_number(number)
    text = f"{number:.{decimals}f}"
    return (text[1:] if float(text) == 0.0 else MINUS + text[1:]) if text.startswith("-") else text


def column_decimals(values: ArrayLike, digits: int) -> int | None:
    """Return the decimals that give the largest of ``values`` its significant digits.

    Parameters
    ----------
    values : array_like
        Numbers in the unit shown.
    digits : int
        Significant digits of the largest.

    Returns
    -------
    int or None
        ``None`` where no number of decimals suits (all unknown or zero, very large or very small numbers).
    """
    array = finite(values)
    if array.size and (array == np.rint(array)).all() and largest_magnitude(array) < 1e4:
        return 0
    largest = largest_magnitude(array)
    if largest == 0.0 or not 1e-4 <= largest < 1e6:
        return None
    return max(digits - 1 - math.floor(math.log10(float(f"{largest:.{digits - 1}e}"))), 0)


def trimmed(text: str) -> str:
    """Drop trailing zeros behind the decimal point: an input echo shows 4.5 as it was given."""
    return text.rstrip("0").rstrip(".") if "." in text and "×" not in text else text


def subscripted(text: str) -> str:
    """Write symbols such as K_T with a lowered letter of Unicode, for media without markup."""
    lowered = {"T": "ₜ", "R": "ᵣ"}
    return re.sub(r"\bK_([TR])(?![A-Za-z])", lambda match: "K" + lowered[match.group(1)], text)


def format_quantity(value: float, unit: str, digits: int = 3) -> str:
    """Format a stored value with its display unit, ``3.46 kN``.

    Parameters
    ----------
    value : float
        Value in ``unit`` (SI, radians).
    unit : str
        Stored unit.
    digits : int
        Significant digits.

    Returns
    -------
    str
        A dash alone where the value is not known.
    """
    shown = display_unit(unit, value)
    text = format_number(value * shown.factor, digits)
    if text == DASH or not shown.name:
        return text
    return f"{text}{shown.pretty}" if shown.name == "deg" else f"{text} {shown.pretty}"


def read_quantity(text: str) -> tuple[float, str] | None:
    """Return number and unit of what :func:`format_quantity` and its kin write, ``None`` of any other text.

    Parameters
    ----------
    text : str
        One number with its unit in one word; a dash alone is an unknown number.

    Examples
    --------
    >>> read_quantity("3.46 kN"), read_quantity("4.57°"), read_quantity("2 of 3 runs")
    ((3.46, 'kN'), (4.57, '°'), None)
    """
    if text == DASH:
        return math.nan, ""
    match = _QUANTITY.fullmatch(text)
    if match is None:
        return None
    number, power, degrees, unit = match.groups()
    plain = number.replace(MINUS, "-").replace("∞", "inf")
    if power:
        plain = f"{plain.partition('×')[0]}e{power.translate(_LOWERED)}"
    return float(plain), degrees or unit or ""


def format_percent(fraction: float, digits: int = 2) -> str:
    """Format a fraction as per cent, a dash where it is not known."""
    text = format_number(100.0 * fraction, digits)
    return text if text == DASH else f"{text} %"


def plain_number(value: float) -> str:
    """Format a number for CSV: ASCII, seven significant digits, empty where not known."""
    if not math.isfinite(value):
        return "" if math.isnan(value) else ("inf" if value > 0 else "-inf")
    return f"{float(value):.7g}"


def axis_label(label: str, unit: str) -> str:
    """Return ``label [unit]`` with the unit in plain text, without brackets where there is no unit."""
    return label if unit in _NO_UNIT else f"{label} [{unit}]"


def finite(values: ArrayLike) -> NDArray[np.float64]:
    """Return the finite entries, flattened."""
    array = np.asarray(values, dtype=float).ravel()
    sound: NDArray[np.float64] = array[np.isfinite(array)]
    return sound
