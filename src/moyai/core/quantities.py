"""Quantities: a number in SI or a text such as ``"1.05 m"``, checked against the kind that is expected.

>>> to_si("380 mm", LENGTH)
0.38
>>> to_si(0.38, LENGTH)
0.38
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from typing import Any

from moyai.core.errors import InputError
from moyai.core.units import Dimension, Unit, parse_unit, plain_text, suggest_unit, unit_table

_NUMBER = re.compile(r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?")
_NOT_FINITE = re.compile(r"[+-]?\.?(?:inf(?:inity)?|nan)\b", re.IGNORECASE)


@dataclass(frozen=True)
class QuantityKind:
    """A kind of quantity: what is expected where."""

    #: With its article, as it stands in a message: ``a length``.
    name: str
    #: Unit of plain numbers, SI symbol (or ``deg`` for keys that end in ``_deg``).
    unit: str
    #: That unit in words: ``metres``.
    plain: str
    #: A quantity as a user would write it.
    example: str
    #: Whether rad, deg and Hz must be distinguished from plain numbers and 1/s (angles and frequencies).
    angle_matters: bool = False

    @property
    def dimension(self) -> Dimension:
        """Dimension of the kind."""
        return parse_unit(self.unit).dimension if self.unit else Dimension()

    def expectation(self) -> str:
        """Return the sentence that says what is expected."""
        if not self.unit:
            return f"expected {self.name}, for instance {self.example}"
        return f"expected {self.name}, for instance '{self.example}' or a number in {self.plain}"


LENGTH = QuantityKind("a length", "m", "metres", "1.05 m")
AREA = QuantityKind("an area", "m2", "square metres", "30 m2")
VOLUME = QuantityKind("a volume", "m3", "cubic metres", "0.25 m3")
MASS = QuantityKind("a mass", "kg", "kilograms", "618.6 t")
TIME = QuantityKind("a time", "s", "seconds", "5 s")
HOURS = QuantityKind("a time", "h", "hours", "3 h")
ANGLE = QuantityKind("an angle", "rad", "radians", "12 deg", angle_matters=True)
ANGLE_DEGREES = QuantityKind("an angle", "deg", "degrees", "12 deg", angle_matters=True)
ANGULAR_FREQUENCY = QuantityKind("an angular frequency", "rad/s", "radians per second", "1.2 rad/s", angle_matters=True)
FREQUENCY = QuantityKind("a frequency", "Hz", "hertz", "0.2 Hz", angle_matters=True)
ANGULAR_VELOCITY = QuantityKind("an angular velocity", "rad/s", "radians per second", "3 deg/s", angle_matters=True)
SPEED = QuantityKind("a speed", "m/s", "metres per second", "0.3 m/s")
ACCELERATION = QuantityKind("an acceleration", "m/s2", "metres per second squared", "9.81 m/s2")
DENSITY = QuantityKind("a density", "kg/m3", "kilograms per cubic metre", "1025 kg/m3")
VISCOSITY = QuantityKind("a kinematic viscosity", "m2/s", "square metres per second", "1.14e-6 m2/s")
FORCE = QuantityKind("a force", "N", "newtons", "3.4 MN")
MOMENT = QuantityKind("a moment", "N m", "newton metres", "12 kN*m")
FORCE_PER_LENGTH = QuantityKind("a force per length", "N/m", "newtons per metre", "777 N/m")
MASS_PER_LENGTH = QuantityKind("a mass per length", "kg/m", "kilograms per metre", "79.2 kg/m")
MASS_PER_AREA = QuantityKind("a mass per area", "kg/m2", "kilograms per square metre", "0.98 kg/m2")
STIFFNESS = QuantityKind("a stiffness", "N/m", "newtons per metre", "30 N/m")
ROTATIONAL_STIFFNESS = QuantityKind("a rotational stiffness", "N m/rad", "newton metres per radian", "32 N m/rad")
BENDING_STIFFNESS = QuantityKind("a bending stiffness", "N m2", "newton metres squared", "1.2e5 N m2")
PRESSURE = QuantityKind("a pressure or modulus", "Pa", "pascals", "2.1 GPa")
INERTIA = QuantityKind("a moment of inertia", "kg m2", "kilogram metres squared", "4.41e3 t m2")
DAMPING = QuantityKind("a damping coefficient", "N s/m", "newton seconds per metre", "8.7 N s/m")
ROTATIONAL_DAMPING = QuantityKind("a rotational damping coefficient", "N m s", "newton metre seconds", "2.5 kN*m*s")
ROTATIONAL_QUADRATIC_DAMPING = QuantityKind(
    "a quadratic rotational damping coefficient", "N m s2", "newton metre seconds squared", "40 kN m s2"
)
NUMBER = QuantityKind("a number", "", "", "0.15")


@dataclass(frozen=True)
class Quantity:
    """A number with its unit; ``si`` is the value in SI units."""

    number: Fraction
    unit: Unit

    @property
    def si(self) -> float:
        """Value in SI units (radians for angles)."""
        return self.unit.to_si(self.number)


def parse_quantity(text: str) -> Quantity:
    """Return the number and the unit of a text such as ``"79.2 kg/m"``.

    Parameters
    ----------
    text : str
        Number, optional space, optional unit. Full-width forms are understood.

    Returns
    -------
    Quantity

    Raises
    ------
    InputError
        When there is no number, when it is not finite, or when the unit is unknown.
    """
    plain = plain_text(text)
    shown = _shorten(text)
    if _NOT_FINITE.match(plain):
        raise InputError(f"'{shown}' is not a finite number")
    match = _NUMBER.match(plain)
    if match is None:
        raise InputError(f"'{shown}' does not begin with a number")
    rest = plain[match.end() :]
    if re.match(r",\d", rest):
        raise InputError(f"'{shown}' has a comma inside the number", remedy=_without_commas(plain))
    number = exact_number(match[0], shown)
    if not rest.strip():
        return Quantity(number, Unit("", Fraction(1), 0, Dimension()))
    if rest[0] in "0123456789_.:+-,'\"":
        raise InputError(f"'{shown}' is not a number with a unit")
    return Quantity(number, parse_unit(rest))


def _without_commas(text: str) -> str:
    """Return how to write a number with commas: as thousands, with a decimal point, or both where both are possible."""
    number = re.match(r"[+-]?\d+(?:,\d+)+(?:\.\d+)?", text)
    written = text if number is None else number[0]
    whole, point = written.replace(",", ""), written.replace(",", ".")
    thousands = re.fullmatch(r"[+-]?[1-9]\d{0,2}(?:,\d{3})+(?:\.\d+)?", written) is not None
    decimal = written.count(",") == 1 and "." not in written
    if thousands and decimal:
        return f"write {whole} if the comma parts thousands, {point} if it is the decimal point"
    if thousands:
        return f"write {whole}"
    return f"write {point}" if decimal else "write digits with one decimal point and no commas"


def exact_number(text: str, shown: str = "") -> Fraction:
    """Return the decimal ``text`` as an exact fraction; refuse what does not fit a double."""
    rounded = float(text)
    if not math.isfinite(rounded):
        raise InputError(f"'{shown or _shorten(text)}' is too large for a number")
    if rounded == 0.0:
        # A magnitude below the smallest double counts as zero; its exact fraction could fill the memory
        return Fraction(0)
    if len(text) > 400:
        return Fraction(rounded)
    return Fraction(Decimal(text))


def to_si(value: Any, kind: QuantityKind, path: str = "") -> float:
    """Return ``value`` in the unit of ``kind``, SI unless the kind is in degrees.

    Parameters
    ----------
    value : float, int or str
        A plain number in the unit of ``kind``, or a text with a unit.
    kind : Kind
        What is expected.
    path : str
        Name for messages.

    Returns
    -------
    float

    Raises
    ------
    InputError
        Not a number, not finite, unknown unit, or a unit of another kind.
    """
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise InputError(f"{kind.expectation()}; got {_describe(value)}", path=path)
    if not isinstance(value, str):
        return _finite(value, kind, path)
    try:
        quantity = parse_quantity(value)
    except InputError as error:
        fault = error.fault
        raise InputError(
            f"{kind.expectation()}; {fault.message}", path=path, allowed=fault.allowed, remedy=fault.remedy
        ) from None
    found = quantity.unit.dimension
    wanted = kind.dimension
    if not quantity.unit.symbol:
        # A quoted number without unit counts like a plain number
        return _finite(float(quantity.number), kind, path)
    matches = (
        found == wanted if kind.angle_matters else found.same_but_angle(wanted) and found.angle in (0, wanted.angle)
    )
    if not matches:
        remedy = _case_slip(quantity.unit.symbol, kind)
        raise InputError(f"{kind.expectation()}; got '{_shorten(value)}'", path=path, remedy=remedy)
    si = quantity.si
    if not math.isfinite(si):
        raise InputError(f"{kind.expectation()}; '{_shorten(value)}' is too large for a number", path=path)
    plain = parse_unit(kind.unit) if kind.unit else None
    if plain is None or (plain.factor == 1 and plain.pi_power == 0):
        return si
    if plain.pi_power == quantity.unit.pi_power:
        # Degrees to degrees and hertz to hertz stay exact
        return float(quantity.number * quantity.unit.factor / plain.factor)
    return plain.from_si(si)


def check_unit(unit: Unit, kinds: Sequence[QuantityKind], place: str, path: str) -> None:
    """Refuse the unit of a column that is of none of the kinds.

    Parameters
    ----------
    unit : Unit
        As the heading of the column or the configuration states it.
    kinds : sequence of QuantityKind
        What the column may be; empty for anything.
    place : str
        File and column, for the message.
    path : str
        Key or parameter, for the message.

    Raises
    ------
    InputError
        With the units that are allowed; for a mass in place of a force with the unit that is meant.
    """
    if not kinds or any(unit.dimension == kind.dimension for kind in kinds):
        return
    symbol = unit.symbol or "1"
    if unit.dimension == MASS.dimension and any(kind.dimension == FORCE.dimension for kind in kinds):
        remedy = f"'{symbol}' is a mass: write 'kgf' or 'tf' for the weight of a kilogram or a tonne"
    else:
        remedy = next((slip for slip in (_case_slip(symbol, kind) for kind in kinds) if slip), "")
    raise InputError(
        f"{place}: '{symbol}' is no unit of {' or '.join(kind.name for kind in kinds)}",
        path=path,
        allowed=f"for instance {', '.join(kind.unit for kind in kinds)}",
        remedy=remedy,
    )


def from_si(value: float, unit: str) -> float:
    """Return the SI ``value`` counted in ``unit``: ``from_si(0.38, "mm")`` is 380."""
    return parse_unit(unit).from_si(value)


def _finite(value: float, kind: QuantityKind, path: str) -> float:
    try:
        number = float(value)
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise InputError(f"{kind.expectation()}; got {number}, which is not a finite number", path=path)
    return number


def _case_slip(symbol: str, kind: QuantityKind) -> str:
    """Return a remedy where a rate lacks its angle, or where a unit fits in another case of letters (3 kn for 3 kN)."""
    if kind in (FREQUENCY, ANGULAR_FREQUENCY) and parse_unit(symbol).dimension == Dimension(time=-1):
        return "state which rate is meant: 'Hz' (cycles per second) or 'rad/s'"
    for candidate, unit in unit_table().items():
        if candidate != symbol and candidate.lower() == symbol.lower() and unit.dimension == kind.dimension:
            return f"did you mean '{candidate}'?"
    meant = suggest_unit(symbol) if symbol not in unit_table() else ""
    return f"did you mean '{meant}'?" if meant and parse_unit(meant).dimension == kind.dimension else ""


def _shorten(text: str, limit: int = 60) -> str:
    flat = " ".join(str(text).split())
    return flat if len(flat) <= limit else flat[: limit - 3] + "..."


def _describe(value: Any) -> str:
    if value is None:
        return "nothing"
    if isinstance(value, bool):
        return f"the truth value {str(value).lower()}"
    if isinstance(value, dict):
        return "a block of keys"
    if isinstance(value, (list, tuple)):
        return "a list"
    return f"a {type(value).__name__}"
