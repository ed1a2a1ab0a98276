"""What a model needs where it cannot be given the scaled value: a spring in series, mass to add."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

from moyai.core.errors import InputError
from moyai.core.units import parse_unit
from moyai.design.similarity import Scale, ScaledQuantity, mass_to_add, match_stretch


@dataclass(frozen=True)
class Need:
    """What one quantity of a model needs."""

    #: Which quantity.
    name: str
    #: Value by the scale, in ``unit``.
    wanted: float
    #: Value of what is there, in ``unit``.
    at_hand: float
    #: Unit of the scaled quantity.
    unit: str
    #: At hand over wanted [-].
    over: float
    #: What corrects it, with figures.
    remedy: str


def model_need(row: ScaledQuantity, value: float, unit: str, scale: Scale, *, line_length: float | None = None) -> Need:
    """Return what a model needs that has ``value`` of a quantity in place of the scaled one [eq:similarity-spring].

    Parameters
    ----------
    row : ScaledQuantity
        The quantity in both sizes.
    value, unit : float, str
        What is given for the model; any unit of the same dimension.
    scale : Scale
        Ratios.
    line_length : float, optional
        Length of the line in the prototype [m]; needed for a stiffness EA.

    Raises
    ------
    InputError
        Another dimension, values that are not positive, or a line without its length.
    """
    there = parse_unit(row.unit) if row.unit else None
    here = parse_unit(unit) if unit else None
    if here is None or there is None or not here.dimension.same_but_angle(there.dimension):
        raise InputError(
            f"{row.name} is at hand in '{unit}', scaled in '{row.unit}'",
            parameter=row.name,
            remedy="give the same kind",
        )
    available, wanted = here.to_si(Fraction(value)), there.to_si(Fraction(row.model))
    if not (available > 0.0 and wanted > 0.0 and math.isfinite(available)):
        raise InputError(f"{row.name} is not positive", parameter=row.name, allowed="greater than 0")
    dimension = (there.dimension.length, there.dimension.mass, there.dimension.time)
    if dimension == (1, 1, -2):
        remedy = _line(row.name, wanted, available, scale, line_length)
    elif dimension == (0, 1, -2):
        remedy = _spring(wanted, available)
    elif dimension[1] == 1 and dimension[2] == 0:
        symbol = {0: "kg", -1: "kg/m", -2: "kg/m2"}.get(dimension[0], f"kg m{dimension[0]}")
        lacking = mass_to_add(scale.to_prototype(wanted, symbol), available, scale, symbol)
        remedy = f"add {lacking:.5g} {symbol}" if lacking >= 0.0 else f"too heavy by {-lacking:.5g} {symbol}"
    else:
        remedy = "no part in series or parallel to it repairs this"
    return Need(row.name, row.model, there.from_si(available), row.unit, available / wanted, remedy)


def _line(name: str, wanted: float, available: float, scale: Scale, line_length: float | None) -> str:
    if line_length is None:
        raise InputError(
            f"{name} is a stiffness EA: the spring in series depends on the length of the line",
            parameter="line_length",
            remedy="give the length of the line in the prototype",
        )
    length = scale.to_model(line_length, "m")
    match = match_stretch(scale.to_prototype(wanted, "N"), available, length, scale)
    if math.isnan(match.series_spring):
        return "too soft: nothing in series helps, take a stiffer line"
    if math.isinf(match.series_spring):
        return "as wanted"
    # Closed form of the impact: tension goes with the root of EA
    return (
        f"spring of {match.series_spring:.5g} N/m in series with its {length:.5g} m; "
        f"without it impacts are {math.sqrt(match.distortion):.3g} times too large"
    )


def _spring(wanted: float, available: float) -> str:
    if available < wanted:
        return "too soft: nothing in series helps, take a stiffer spring"
    if available == wanted:
        return "as wanted"
    return f"spring of {1.0 / (1.0 / wanted - 1.0 / available):.5g} N/m in series"
