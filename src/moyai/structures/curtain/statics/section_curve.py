"""Sections of a skirt in currents of one shape, as functions of the pressure alone.

A current of one direction loads a skirt by the square of its component along the normal, whatever its speed and angle
are, and a drag coefficient multiplies that. So the load per pressure, the height of the toe and the hold of a held toe
are functions of one number, the pressure C_D rho/2 u|u| where the current is strongest: interpolated here by Chebyshev
polynomials in pieces, each found when it is first asked for [eq:curtain-section-curve].
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property, lru_cache
from typing import Literal

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.core.options import checks_words
from moyai.sea.current import CurrentProfile, PowerLawCurrent, TabulatedCurrent, UniformCurrent
from moyai.structures.curtain.statics.drag import DragLaw
from moyai.structures.curtain.statics.section import (
    HangingSkirt,
    LoadLaw,
    Pressure,
    SectionStart,
    Skirt,
    overturned,
    sampled,
)

_ORDER = 16
_ANGLES = (np.arange(_ORDER) + 0.5) * (math.pi / _ORDER)
# from values at the roots, rising, to coefficients
_TO_COEFFICIENTS = np.cos(np.outer(np.arange(_ORDER), _ANGLES[::-1])) * (2.0 / _ORDER)
_TO_COEFFICIENTS[0] *= 0.5
#: Last three coefficients over the largest value up to which a piece counts as resolved [-]
_RESOLVED = 5e-10
#: Halvings of a piece that is not
_DEEPEST = 2
#: Largest pressure over that which bends the skirt, as a power of two
_MOST = 40
#: Share of the largest speed up to which a current crosswise counts as none [-]
_CROSSWISE = 1e-12
_CROSSINGS = 80


@dataclass(frozen=True)
class CurrentShape:
    """A current of one direction without its speed and direction."""

    #: Velocity (x, y) where it is strongest [m/s].
    velocity: tuple[float, float]
    #: Along heading 0 with 1 m/s there.
    unit: CurrentProfile
    #: What distinguishes its shape from others.
    mark: tuple[object, ...]

    def speeds(self, headings: Array) -> Array:
        """Return the largest component along headings [rad] [m/s]."""
        return self.velocity[0] * np.cos(headings) + self.velocity[1] * np.sin(headings)


def current_shape(current: CurrentProfile) -> CurrentShape | None:
    """Return the shape of a current; None where it turns over the depth or stands still."""
    if isinstance(current, UniformCurrent):
        speed, heading = current.current_speed, current.heading
        unit: CurrentProfile = UniformCurrent(1.0, 0.0)
        mark: tuple[object, ...] = ("uniform",)
    elif isinstance(current, PowerLawCurrent):
        speed, heading = current.surface_speed, current.heading
        unit = PowerLawCurrent(1.0, current.exponent, 0.0, current.water_depth)
        mark = ("power law", current.exponent, current.water_depth)
    elif isinstance(current, TabulatedCurrent):
        strongest = current.components[int(np.argmax(np.hypot(*current.components.T)))]
        speed, heading = float(np.hypot(*strongest)), math.atan2(strongest[1], strongest[0])
        if speed == 0.0:
            return None
        along = current.components @ strongest / speed**2
        across = current.components @ np.array([-strongest[1], strongest[0]]) / speed**2
        if np.max(np.abs(across)) > _CROSSWISE:
            return None
        # digits that scaling and turning do not keep would tell equal shapes from each other
        along = np.round(along, 13) + 0.0
        unit = TabulatedCurrent(current.z, np.stack([along, np.zeros_like(along)], axis=-1))
        mark = ("table", current.z.tobytes(), along.tobytes())
    else:
        return None
    if speed == 0.0:
        return None
    return CurrentShape((speed * math.cos(heading), speed * math.sin(heading)), unit, mark)


@checks_words
@dataclass(frozen=True)
class SectionKind:
    """What a curve holds for: everything but the pressure."""

    skirt: Skirt
    law: LoadLaw
    toe: Literal["free", "held"]
    #: Of the top below still water [m].
    top_depth: float
    #: Of the water [m].
    depth: float
    #: Coefficient along the sheet over that across it [-].
    friction_ratio: float
    #: Of the current.
    mark: tuple[object, ...]
    #: Current of this mark, 1 m/s along heading 0 where it is strongest.
    unit: CurrentProfile = field(compare=False)


class SectionCurve:
    """Sections of one kind against the pressure.

    Parameters
    ----------
    kind : SectionKind

    Notes
    -----
    A piece reaches from one power of two of 1 + qL/W to the next, q the pressure, L the length, W the toe load; it is
    halved where its polynomial does not resolve it, and left to the direct solution where that does not help or there
    is no section. What a piece holds does not depend on what was asked for before.
    """

    def __init__(self, kind: SectionKind) -> None:
        self.kind = kind
        #: Of the current of 1 m/s in water of 1 kg/m3, twice: the pressure is 1 N/m2 where the current is strongest.
        self._pressure = sampled(kind.skirt, kind.unit, 0.0, kind.depth, 2.0, kind.top_depth)
        self._left, self._right = np.empty(0), np.empty(0)
        self._table = np.empty((0, 3, _ORDER))
        self._found = 0

    def scaled_pressure(self, factor: float) -> Pressure:
        """Return the pressure of the current times a factor [N/m2]."""
        unit = self._pressure
        return Pressure(unit.low, unit.step, factor * unit.values)

    def at(self, pressure: Array) -> Array:
        """Return load per pressure [m], depth reached [m] and share of the hold of a straight sheet [-], shape (n, 3).

        Parameters
        ----------
        pressure : ndarray
            C_D rho/2 u|u| where the current is strongest [N/m2]; a current from behind loads alike.

        Returns
        -------
        ndarray
            NaN where the direct solution has to be asked.
        """
        ratio = self.kind.skirt.length / self.kind.skirt.toe_load
        place = np.log2(1.0 + ratio * np.abs(pressure))
        if np.isnan(place).any():
            found = np.full((pressure.size, 3), math.nan)
            known = ~np.isnan(place)
            found[known] = self.at(pressure[known])
            return found
        most = float(np.max(place, initial=0.0))
        if not most < _MOST:
            return np.full((pressure.size, 3), math.nan)
        while self._found <= most:
            self._add(float(self._found), float(self._found + 1), 0)
            self._found += 1
        row: IntArray = np.searchsorted(self._left, place, side="right") - 1
        left, right = self._left[row], self._right[row]
        along = np.clip((2.0 * place - left - right) / (right - left), -1.0, 1.0)
        waves = np.cos(np.arccos(along)[:, None] * np.arange(_ORDER))
        values: Array = np.einsum("nij,nj->ni", self._table[row], waves)
        return values

    def _add(self, left: float, right: float, halved: int) -> None:
        skirt = self.kind.skirt
        roots = 0.5 * (left + right) - 0.5 * (right - left) * np.cos(_ANGLES)
        values = self._solved(np.expm1(math.log(2.0) * roots) * skirt.toe_load / skirt.length)
        table = np.full((3, _ORDER), math.nan) if values is None else values.T @ _TO_COEFFICIENTS.T
        largest = np.max(np.abs(table), axis=1, keepdims=True)
        if values is None or np.any(np.abs(table[:, -3:]) > _RESOLVED * np.maximum(largest, 1e-300)):
            if halved < _DEEPEST:
                middle = 0.5 * (left + right)
                self._add(left, middle, halved + 1)
                self._add(middle, right, halved + 1)
                return
            table[:] = math.nan
        self._left, self._right = np.append(self._left, left), np.append(self._right, right)
        self._table = np.concatenate([self._table, table[None]])

    def _solved(self, pressures: Array) -> Array | None:
        """Return the rows of :meth:`at` by direct solution; None where one has no section."""
        kind = self.kind
        hanging = _OneMesh(kind.skirt, self._pressure, kind.law, kind.top_depth, 0.0)
        hanging.finest = float(pressures[-1])
        rows = np.empty((pressures.size, 3))
        # the last one first: where the load overturns the skirt it does so there
        for place in (-1, *range(pressures.size - 1)):
            drag = float(pressures[place])
            hanging.friction = kind.friction_ratio * drag
            path, miss, hold = hanging.held(drag) if kind.toe == "held" else (*hanging.free(drag), 0.0)
            if overturned(path, miss) or abs(miss) > 1e-11 * kind.skirt.length:
                return None
            load = hold - path[-1, 2] if kind.toe == "held" else -path[-1, 2]
            rows[place] = load / drag, path[-1, 1] - path[0, 1], hanging.share if kind.toe == "held" else 0.0
        return rows


class _OneMesh(HangingSkirt):
    """Solutions on the steps of the largest pressure of a piece: fewer ones would come and go within it."""

    finest = 0.0

    @cached_property
    def _steps(self) -> Array:
        return super().nodes(self.finest)

    def nodes(self, drag: float) -> Array:
        return self._steps


@lru_cache(maxsize=64)
def _curve(kind: SectionKind) -> SectionCurve:
    return SectionCurve(kind)


@dataclass(frozen=True)
class SectionFamily:
    """A skirt in one current from all sides, by its curve."""

    curve: SectionCurve
    shape: CurrentShape
    drag: DragLaw
    #: Of the water [kg/m3].
    density: float

    def pressures(self, headings: Array) -> Array:
        """Return rho/2 u|u| of the components along headings [rad] where they are largest [N/m2]."""
        speeds = self.shape.speeds(headings)
        found: Array = 0.5 * self.density * speeds * np.abs(speeds)
        return found

    def loads(self, headings: Array, deepest: float) -> Array:
        """Return the horizontal load per span [N/m] on sections whose normals have headings [rad].

        NaN where the direct solution has to be asked: always so where the skirt reaches deeper than ``deepest`` [m].
        """
        pressures = self.pressures(headings)
        pressed = self._coefficients(pressures) * pressures
        per_pressure, depth, _ = self.curve.at(pressed).T
        return np.where(depth <= deepest, per_pressure * pressed, math.nan)

    def start(self, heading: float) -> SectionStart:
        """Return where the search for a section begins whose normal has a heading [rad]."""
        pressures = self.pressures(np.array([heading]))
        _, reach, share = self.curve.at(self._coefficients(pressures) * pressures)[0]
        return SectionStart(-self.curve.kind.top_depth - reach, share, self.curve.scaled_pressure(float(pressures[0])))

    def _coefficients(self, pressures: Array) -> Array:
        """Return the drag coefficient with the blockage of the deflected skirt."""
        kind, drag = self.curve.kind, self.drag
        if len(drag.blockage) == 1 or math.isinf(kind.depth):
            return np.full(pressures.size, drag.coefficient(kind.skirt.length / kind.depth))
        low, high = np.zeros(pressures.size), np.full(pressures.size, kind.skirt.length / kind.depth)

        def surplus(blockage: Array) -> Array:
            coefficients = np.interp(blockage, drag.blockage, drag.coefficients)
            depth = self.curve.at(coefficients * pressures)[:, 1]
            # so blocked the load may be too much for any section: then less of it is sought
            return blockage - np.where(np.isnan(depth), 0.0, depth) / kind.depth

        # a deeper curtain is loaded more and reaches less deep: one crossing, by regula falsi of the Illinois kind
        below, above = surplus(low), surplus(high)
        place, found, side = high, above, np.zeros(pressures.size)
        # by its stretch a skirt may reach deeper than its length: the blockage counts up to that
        beyond = above <= 0.0
        for _ in range(_CROSSINGS):
            if not np.any(~beyond & (np.abs(found) > 1e-14) & (high - low > 1e-14)):
                break
            with np.errstate(invalid="ignore", divide="ignore"):
                place = np.clip(low - below * (high - low) / (above - below), low, high)
            place = np.where(np.isnan(place), low, place)
            found = surplus(place)
            more = found > 0.0
            high, low = np.where(more, place, high), np.where(more, low, place)
            below = np.where(more, np.where(side > 0.0, 0.5 * below, below), found)
            above = np.where(more, found, np.where(side < 0.0, 0.5 * above, above))
            side = np.where(more, 1.0, -1.0)
        place = np.where(beyond, kind.skirt.length / kind.depth, place)
        coefficients: Array = np.interp(place, drag.blockage, drag.coefficients)
        # where sections end, and not at a crossing, the surplus jumps
        return np.where(beyond | (np.abs(found) <= 1e-9), coefficients, math.nan)


@checks_words
def section_family(
    skirt: Skirt,
    current: CurrentProfile,
    water_depth: float,
    density: float,
    drag: DragLaw,
    *,
    law: LoadLaw,
    toe: Literal["free", "held"],
    top_depth: float,
    friction: float,
) -> SectionFamily | None:
    """Return the sections of a skirt by their curve; None where none serves: the current turns, or friction and drag
    do not keep their ratio.

    Arguments as :func:`moyai.structures.curtain.statics.section.solve_section`.
    """
    shape = current_shape(current)
    if shape is None or (friction != 0.0 and len(drag.blockage) > 1):
        return None
    ratio = friction / drag.coefficients[0]
    kind = SectionKind(skirt, law, toe, top_depth, water_depth, ratio, shape.mark, shape.unit)
    return SectionFamily(_curve(kind), shape, drag, density)
