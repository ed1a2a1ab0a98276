"""Units: what a symbol such as ``kg/m3`` or ``kN*m*s`` is in SI, and of which dimension it is.

Factors are exact rational numbers (times a power of pi for angles), so that a conversion is rounded once.
"""

from __future__ import annotations

import difflib
import math
import re
import unicodedata
from dataclasses import dataclass
from fractions import Fraction
from functools import cache

from moyai.core.errors import InputError

_LARGEST_EXPONENT = 9


@dataclass(frozen=True)
class Dimension:
    """Exponents of metre, kilogram and second; the angle is carried as a label so that Hz and rad/s do not mix."""

    length: int = 0
    mass: int = 0
    time: int = 0
    angle: int = 0

    def __mul__(self, other: Dimension) -> Dimension:
        return Dimension(
            self.length + other.length, self.mass + other.mass, self.time + other.time, self.angle + other.angle
        )

    def __pow__(self, exponent: int) -> Dimension:
        return Dimension(self.length * exponent, self.mass * exponent, self.time * exponent, self.angle * exponent)

    def same_but_angle(self, other: Dimension) -> bool:
        """Whether both agree in metre, kilogram and second."""
        return (self.length, self.mass, self.time) == (other.length, other.mass, other.time)


@dataclass(frozen=True)
class Unit:
    """A unit: ``value_SI = value * factor * pi**pi_power``."""

    #: As the user wrote it.
    symbol: str
    #: Exact rational part of the factor to SI.
    factor: Fraction
    #: Power of pi in the factor (degrees have 1).
    pi_power: int
    dimension: Dimension

    def __mul__(self, other: Unit) -> Unit:
        return Unit(
            f"{self.symbol} {other.symbol}".strip(),
            self.factor * other.factor,
            self.pi_power + other.pi_power,
            self.dimension * other.dimension,
        )

    def __pow__(self, exponent: int) -> Unit:
        return Unit(self.symbol, self.factor**exponent, self.pi_power * exponent, self.dimension**exponent)

    @property
    def is_si(self) -> bool:
        """Whether a number of this unit is the same number in SI."""
        return self.factor == 1 and self.pi_power == 0

    def to_si(self, number: Fraction) -> float:
        """Return ``number`` of this unit in SI, rounded once (twice where pi enters); infinite beyond a double."""
        try:
            rational = float(number * self.factor)
        except OverflowError:
            return math.copysign(math.inf, number)
        return rational * math.pi**self.pi_power

    def from_si(self, value: float) -> float:
        """Return the SI ``value`` counted in this unit."""
        return float(Fraction(value / math.pi**self.pi_power) / self.factor)


DIMENSIONLESS = Unit("", Fraction(1), 0, Dimension())

_LENGTH = Dimension(length=1)
_MASS = Dimension(mass=1)
_TIME = Dimension(time=1)
_ANGLE = Dimension(angle=1)
_FORCE = Dimension(1, 1, -2)
_PRESSURE = Dimension(-1, 1, -2)
_ENERGY = Dimension(2, 1, -2)
_POWER = Dimension(2, 1, -3)
_GRAVITY = Fraction("9.80665")  # standard acceleration, defines the kilogram-force
_POUND = Fraction("0.45359237")
_FOOT = Fraction("0.3048")

_PREFIXES = {
    "n": Fraction(1, 10**9),
    "μ": Fraction(1, 10**6),
    "u": Fraction(1, 10**6),
    "m": Fraction(1, 1000),
    "c": Fraction(1, 100),
    "d": Fraction(1, 10),
    "h": Fraction(100),
    "k": Fraction(1000),
    "M": Fraction(10**6),
    "G": Fraction(10**9),
}


@cache
def unit_table() -> dict[str, Unit]:
    """Return every simple unit by its symbol."""
    table: dict[str, Unit] = {}

    def add(symbols: str, factor: Fraction | int | str, dimension: Dimension, prefixes: str = "", pi: int = 0) -> None:
        for symbol in symbols.split():
            table[symbol] = Unit(symbol, Fraction(factor), pi, dimension)
            for prefix in prefixes:
                name = prefix + symbol
                table[name] = Unit(name, Fraction(factor) * _PREFIXES[prefix], pi, dimension)

    add("m", 1, _LENGTH, "nμumcdk")
    add("ft", _FOOT, _LENGTH)
    add("in", _FOOT / 12, _LENGTH)
    add("nmi", 1852, _LENGTH)
    add("g", Fraction(1, 1000), _MASS, "μumkM")
    add("t", 1000, _MASS)
    add("lb", _POUND, _MASS)
    add("s", 1, _TIME, "nμum")
    add("min", 60, _TIME)
    add("h", 3600, _TIME)
    add("d", 86400, _TIME)
    add("rad", 1, _ANGLE, "μum")
    add("deg °", Fraction(1, 180), _ANGLE, pi=1)
    add("rev", 2, _ANGLE, pi=1)
    add("Hz", 2, Dimension(time=-1, angle=1), "mk", pi=1)
    add("rpm", Fraction(1, 30), Dimension(time=-1, angle=1), pi=1)
    add("kn", Fraction(1852, 3600), Dimension(1, 0, -1))
    add("N", 1, _FORCE, "mkMG")
    add("gf", _GRAVITY / 1000, _FORCE, "k")
    add("tf", _GRAVITY * 1000, _FORCE)
    add("lbf", _POUND * _GRAVITY, _FORCE)
    add("kip", 1000 * _POUND * _GRAVITY, _FORCE)
    add("Pa", 1, _PRESSURE, "mhkMG")
    add("bar", 10**5, _PRESSURE, "md")
    add("psi", _POUND * _GRAVITY / (_FOOT / 12) ** 2, _PRESSURE)
    add("J", 1, _ENERGY, "mkMG")
    add("W", 1, _POWER, "mkMG")
    add("L l", Fraction(1, 1000), Dimension(length=3), "m")
    add("%", Fraction(1, 100), Dimension())
    add("‰", Fraction(1, 1000), Dimension())
    return table


# What people write and what they mean; similar spelling alone would not find these
_MEANT = {
    "sec": "s", "secs": "s", "second": "s", "seconds": "s", "sek": "s", "S": "s",
    "meter": "m", "meters": "m", "metre": "m", "metres": "m", "mtr": "m", "mts": "m",
    "centimetre": "cm", "centimeter": "cm", "millimetre": "mm", "millimeter": "mm",
    "degree": "deg", "degrees": "deg", "degs": "deg", "radian": "rad", "radians": "rad",
    "kilogram": "kg", "kilograms": "kg", "Kg": "kg", "KG": "kg", "kgs": "kg", "gram": "g", "grams": "g", "gr": "g",
    "ton": "t", "tons": "t", "tonne": "t", "tonnes": "t", "T": "t", "kt": "kn", "kts": "kn", "knot": "kn",
    "knots": "kn", "KN": "kN", "Kn": "kN", "n": "N", "newton": "N", "Newton": "N", "newtons": "N", "kgw": "kgf",
    "hz": "Hz", "HZ": "Hz", "pa": "Pa", "kpa": "kPa", "mpa": "MPa", "gpa": "GPa", "Gpa": "GPa", "Mpa": "MPa",
    "hour": "h", "hours": "h", "hr": "h", "hrs": "h", "minute": "min", "minutes": "min", "mins": "min",
    "day": "d", "days": "d", "feet": "ft", "foot": "ft", "inch": "in", "inches": "in", "lbs": "lb", "pound": "lb",
    "M": "m", "CM": "cm", "MM": "mm", "KM": "km", "percent": "%", "pct": "%",
    "mps": "m/s", "MPS": "m/s", "cmps": "cm/s", "mmps": "mm/s", "fps": "ft/s", "kmh": "km/h", "kph": "km/h",
    "Kmh": "km/h", "cms": "cm/s",
}  # fmt: skip


def suggest_unit(symbol: str) -> str:
    """Return the unit that a misspelt ``symbol`` most likely means, or an empty string."""
    if symbol in _MEANT:
        return _MEANT[symbol]
    table = unit_table()
    same_letters = [candidate for candidate in table if candidate.lower() == symbol.lower()]
    if same_letters:
        return max(same_letters, key=lambda candidate: sum(a == b for a, b in zip(candidate, symbol)))
    close = difflib.get_close_matches(symbol, [*table, *_MEANT], n=1, cutoff=0.6)
    return _MEANT.get(close[0], close[0]) if close else ""


def plain_text(text: str) -> str:
    """Return ``text`` with full-width forms, superscripts and look-alike signs made plain."""
    folded = unicodedata.normalize("NFKC", text)
    for odd, plain in (("−", "-"), ("–", "-"), ("·", "*"), ("⋅", "*"), ("×", "*"), ("µ", "μ"), ("º", "°"), ("⁻", "-")):
        folded = folded.replace(odd, plain)
    return folded.strip()


# `*` and `.` multiply; an exponent follows its unit with or without `^`
_TOKEN = re.compile(
    r"\s*(?:(?P<name>[^\W\d_]+|%|‰|°|1(?=\s*/))(?:(?:\^|\*\*)?(?P<exponent>[+-]?\d+))?|(?P<sign>[*./()]))"
)


@cache
def parse_unit(text: str) -> Unit:
    """Return the unit that ``text`` names, for instance ``kg/m3``, ``N s/m``, ``kN*m*s`` or ``1/s``.

    Parameters
    ----------
    text : str
        Product of units; at most one ``/``, whose right side may stand in parentheses.

    Returns
    -------
    Unit

    Raises
    ------
    InputError
        When a symbol is unknown (with the one that was probably meant) or the form is ambiguous.
    """
    plain = plain_text(text)
    parts = plain.split("/")
    if len(parts) == 1:
        return _rename(_product(plain), text)
    if len(parts) > 2 and "(" not in plain:
        # kg/m/s is clear: everything behind the first solidus divides
        divisors = parts[1:]
    else:
        divisors = ["/".join(parts[1:])]
    unit = DIMENSIONLESS if parts[0].strip() in ("", "1") else _product(parts[0])
    for divisor in divisors:
        inner = divisor.strip()
        if inner.startswith("(") and inner.endswith(")"):
            inner = inner[1:-1]
        elif len(divisors) == 1 and _count_factors(inner) > 1:
            first, *rest = re.split(r"[\s*.]+", inner)
            raise InputError(
                f"the unit '{plain}' can be read in two ways",
                remedy=f"write '{parts[0].strip()}/({inner})' or '{parts[0].strip()} {' '.join(rest)}/{first}'",
            )
        unit = unit * _product(inner) ** -1
    return _rename(unit, text)


def _rename(unit: Unit, text: str) -> Unit:
    return Unit(text.strip(), unit.factor, unit.pi_power, unit.dimension)


def _count_factors(text: str) -> int:
    return len([part for part in re.split(r"[\s*.]+", text.replace("**", "^").strip()) if part])


def _product(text: str) -> Unit:
    unit = DIMENSIONLESS
    position = 0
    stripped = text.strip()
    if not stripped:
        raise InputError(f"'{text}' is not a unit")
    if stripped.startswith("(") and stripped.endswith(")") and stripped.count("(") == 1:
        stripped = stripped[1:-1].strip()
    while position < len(stripped):
        match = _TOKEN.match(stripped, position)
        if match is None or match["sign"] in ("(", ")", "/"):
            raise InputError(
                f"'{text.strip()}' is not a unit", allowed="a product of units such as 'kN*m*s' or 'N s/m'"
            )
        position = match.end()
        if match["name"] is None:
            continue
        exponent = int(match["exponent"] or 1)
        if not -_LARGEST_EXPONENT <= exponent <= _LARGEST_EXPONENT:
            raise InputError(f"exponent {exponent} of '{match['name']}'", allowed="at most 9")
        unit = unit * _simple(match["name"]) ** exponent
    return unit


def _simple(name: str) -> Unit:
    found = unit_table().get(name)
    if found is not None:
        return found
    meant = suggest_unit(name)
    raise InputError(f"unknown unit '{name}'", remedy=f"did you mean '{meant}'?" if meant else "")
