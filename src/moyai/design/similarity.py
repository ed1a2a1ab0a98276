"""Similarity of models: Froude with the Cauchy number kept, for any quantity of any structure.

Gravity waves fix the scale of time by that of length; if stretch is to be as large as in the prototype, stiffness must
follow the forces: EA by the cube of the length ratio. What a unit is made of gives its scale, so a quantity of a
curtain, a breakwater or a cage is converted by its unit alone.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.units import parse_unit
from moyai.core.validity import Notice
from moyai.sea.water import Water, check_water


@dataclass(frozen=True)
class Scale:
    """Ratios of prototype to model.

    Examples
    --------
    >>> from moyai.design import Scale
    >>> scale = Scale(length=25.0, density=1.025, gravity=1.0)
    >>> scale.ratio("s"), round(scale.ratio("N"), 1)
    (5.0, 16015.6)
    """

    #: S = L_prototype / L_model [-].
    length: float
    #: Of the waters [-]: 1.025 for the sea against a flume of fresh water.
    density: float
    #: [-]; 1 except in a centrifuge.
    gravity: float

    def __post_init__(self) -> None:
        for name in ("length", "density", "gravity"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"{name} ratio is {value:g}", parameter=f"scale.{name}", allowed="greater than 0")

    def ratio(self, unit: str) -> float:
        """Return prototype over model [-] of a quantity in ``unit`` [eq:similarity-ratio].

        Parameters
        ----------
        unit : str
            For instance ``N`` (EA, force), ``N/m`` (spring), ``kg/m``, ``m/s``, ``kg m2``, ``Pa``; empty for a number.

        Raises
        ------
        InputError
            For an unknown unit.
        """
        dimension = parse_unit(unit).dimension if unit else None
        if dimension is None:
            return 1.0
        # one power of S keeps the rounding to one operation
        exponent = dimension.length + 3 * dimension.mass + 0.5 * dimension.time
        return float(self.length**exponent * self.density**dimension.mass * self.gravity ** (-0.5 * dimension.time))

    def to_model(self, value: float, unit: str) -> float:
        """Return the model's value of a prototype's value in ``unit``.

        Parameters
        ----------
        value : float
            Of the prototype, in ``unit``.
        unit : str
            As for :meth:`ratio`.

        Raises
        ------
        InputError
            For an unknown unit.
        """
        return value / self.ratio(unit)

    def to_prototype(self, value: float, unit: str) -> float:
        """Return the prototype's value of a model's value in ``unit``.

        Parameters
        ----------
        value : float
            Of the model, in ``unit``.
        unit : str
            As for :meth:`ratio`.

        Raises
        ------
        InputError
            For an unknown unit.
        """
        return value * self.ratio(unit)


@dataclass(frozen=True)
class ScaledQuantity:
    """A quantity in both sizes."""

    #: What it is.
    name: str
    #: Its unit.
    unit: str
    #: Value of the prototype, in that unit.
    prototype: float
    #: Value of the model, in that unit.
    model: float
    #: Prototype over model [-].
    ratio: float


@checks_words
def scale_quantities(
    quantities: Mapping[str, tuple[float, str]], scale: Scale, *, from_model: bool = False
) -> tuple[ScaledQuantity, ...]:
    """Return quantities in both sizes: a whole breakwater, cage or curtain as a list of names, values and units.

    Parameters
    ----------
    quantities : mapping
        Name to (value, unit).
    scale : Scale
        Ratios.
    from_model : bool
        Whether the values given are those of the model.
    """
    rows = []
    for name, (value, unit) in quantities.items():
        ratio = scale.ratio(unit)
        prototype, model = (value * ratio, value) if from_model else (value, value / ratio)
        rows.append(ScaledQuantity(name, unit, prototype, model, ratio))
    return tuple(rows)


def cauchy_number(axial_stiffness: float, water: Water) -> float:
    """Return C_E = sqrt(EA/rho) / (h sqrt(g h)), the same in both sizes when EA is scaled [eq:similarity-cauchy]."""
    return math.sqrt(axial_stiffness / water.density) / (water.depth * math.sqrt(water.gravity * water.depth))


@dataclass(frozen=True)
class StretchMatch:
    """How to give a model line the stretch of the prototype."""

    #: EA that the model needs [N].
    wanted: float
    #: EA of the line given [N].
    available: float
    #: Available over wanted [-]: the factor on the Cauchy number's square, on tension about its root.
    distortion: float
    #: Stiffness of a spring in series that corrects a line too stiff [N/m]; infinite where none is needed, NaN where a
    #: line is too soft and nothing in series helps.
    series_spring: float


def match_stretch(
    prototype_stiffness: float, model_stiffness: float, model_length: float, scale: Scale
) -> StretchMatch:
    """Return what spring a model line needs to keep the Cauchy number [eq:similarity-spring].

    Parameters
    ----------
    prototype_stiffness, model_stiffness : float
        EA of the prototype's line and of the line that is given for the model [N].
    model_length : float
        Length of the model line [m].
    scale : Scale
        Ratios.
    """
    for name, value in (("prototype_stiffness", prototype_stiffness), ("model_stiffness", model_stiffness)):
        if not value > 0.0:
            raise InputError(f"{name} is {value:g} N", parameter=name, allowed="greater than 0")
    if not (math.isfinite(model_length) and model_length > 0.0):
        raise InputError(f"model length is {model_length:g} m", parameter="model_length", allowed="greater than 0")
    wanted = scale.to_model(prototype_stiffness, "N")
    if model_stiffness > wanted:
        spring = 1.0 / (model_length / wanted - model_length / model_stiffness)
    else:
        spring = math.inf if model_stiffness == wanted else math.nan
    return StretchMatch(wanted, model_stiffness, model_stiffness / wanted, spring)


def mass_to_add(prototype_mass: float, model_mass: float, scale: Scale, unit: str) -> float:
    """Return the mass that the model lacks, negative when it is too heavy.

    Parameters
    ----------
    prototype_mass, model_mass : float
        In ``unit``: ``kg``, ``kg/m`` or ``kg/m2``.
    scale : Scale
        Ratios.
    unit : str
        Unit of both.
    """
    return scale.to_model(prototype_mass, unit) - model_mass


def check_model(scale: Scale, *, period: float, water_depth: float, reynolds: float) -> tuple[Notice, ...]:
    """Tell where a model is too small: capillary waves, shallow water, laminar drag.

    Parameters
    ----------
    scale : Scale
        Ratios.
    period, water_depth : float
        Shortest wave period [s] and depth [m] of the prototype.
    reynolds : float
        Of the model, on the member whose drag matters [-].
    """
    tests = (
        ("period", "wave period", scale.to_model(period, "s"), 0.35, "s", "Hughes (1993): capillarity"),
        ("depth", "water depth", scale.to_model(water_depth, "m"), 0.02, "m", "Hughes (1993): capillarity"),
        ("reynolds", "Reynolds number", reynolds, 1e3, "", "drag of bluff bodies: below it the coefficient rises"),
    )
    return tuple(
        Notice(
            f"similarity-{code}",
            f"{what} of the model is {value:.3g} {unit}".rstrip() + f", below {limit:g} {unit}".rstrip(),
            value,
            limit,
            "warning",
            "choose a larger model",
            source,
        )
        for code, what, value, limit, unit, source in tests
        if value < limit
    )


def scale_water(water: Water, scale: Scale) -> Water:
    """Return the model's water of a prototype's water [eq:similarity-ratio].

    Parameters
    ----------
    water : Water
        Of the prototype: depth [m], density [kg/m3], gravity [m/s2].
    scale : Scale
        Prototype over model.

    Returns
    -------
    Water
        Of the model.

    Examples
    --------
    >>> from moyai.design import Scale, scale_water
    >>> from moyai.sea import Water
    >>> scale = Scale(length=25.0, density=1.025, gravity=1.0)
    >>> model = scale_water(Water(depth=10.0, density=1025.0, gravity=9.81), scale)
    >>> model.depth, round(model.density, 6), model.gravity
    (0.4, 1000.0, 9.81)
    """
    check_water(water)
    return Water(water.depth / scale.length, water.density / scale.density, water.gravity / scale.gravity)
