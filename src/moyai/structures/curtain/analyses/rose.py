"""What heights a curtain permits over the direction of waves and its own orientation, and its best orientation.

The curtain is turned on its place; water, current and waves keep their headings. Every orientation has its own steady
loads, its own snaps and its own angle to the waves; the limit is that of :mod:`.limits` [eq:curtain-limit-rose].
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress
from moyai.sea.states import SeaState
from moyai.structures.curtain.analyses.impact import ImpactAnswer, solve_impact
from moyai.structures.curtain.analyses.limits import CountedLimits, fastest_water, sea_loads
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.model import CurtainSettings
from moyai.structures.curtain.seas.loads import DragCurve, drag_curve
from moyai.structures.curtain.seas.states import longest_sea, significant_height
from moyai.structures.curtain.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

#: Shares of the current of the case that count: every weaker one comes with it
_SHARES = (0.5, 1.0)
# A current along the curtain leaves it without a shape: it is turned by one degree from there
_OFF = math.radians(1.0)
# Limits within a thousandth are alike
_ALIKE = 1e-3
_SLOWEST = 1e-3


@dataclass(frozen=True)
class Held:
    """What a curtain permits: significant height [m], what sets it, and whether it is a bound of the limit."""

    height: float
    governing: str
    bound: str


def folded(angle: float) -> float:
    """Return the angle between a direction and the normal, 0 to pi/2: from behind counts as from the front."""
    return math.acos(min(1.0, abs(math.cos(angle))))


def turned_to(unit: LevelCurtain, normal: float) -> LevelCurtain:
    """Return the curtain with its normal to another heading [rad], current and water as they are."""
    return replace(unit, curtain=replace(unit.curtain, normal=normal), site=replace(unit.site, chord_normal=normal))


@dataclass(frozen=True, eq=False)
class RoseLimits:
    """Limits of a curtain in any orientation and waves of any heading; what is alike is solved once."""

    #: As it lies.
    unit: LevelCurtain
    settings: CurtainSettings
    #: Loads at rest over the speed of the water along the normal.
    curve: DragCurve
    #: Of the seas that snaps are looked for in [s]; see :func:`sea_loads`.
    duration: float | None = None
    _units: dict[float, tuple[LevelCurtain, ImpactAnswer | None]] = field(default_factory=dict, repr=False)
    _found: dict[tuple[float, float], Held] = field(default_factory=dict, repr=False)

    def held(self, normal: float, heading: float) -> Held:
        """Return what the curtain permits with its normal to a heading, waves travelling to another [rad]."""
        place = (round(math.remainder(normal, math.pi), 9), min(round(folded(heading - normal), 9), 0.5 * math.pi))
        if place not in self._found:
            try:
                self._found[place] = self._search(*place)
            except (InputError, ConvergenceError) as error:
                self._found[place] = Held(math.nan, f"no answer: {error}", "")
        return self._found[place]

    def _search(self, normal: float, angle: float) -> Held:
        unit, answer = self._turned(normal)
        settings = replace(self.settings, limits=replace(self.settings.limits, wave_angle=angle))
        counted = CountedLimits(unit, settings, sea_loads(unit, settings, answer, self.curve, self.duration))
        found = []
        for share in _SHARES:
            limit, bound = counted.height(max(share * unit.surface_speed, _SLOWEST))
            found.append(Held(limit.value, limit.governing, bound))
        return min(found, key=lambda item: item.height)

    def _turned(self, normal: float) -> tuple[LevelCurtain, ImpactAnswer | None]:
        if normal not in self._units:
            # the side of the normal to which the current goes: the curtain has none of its own
            off = math.remainder(self.unit.site.flow_heading - normal, math.pi)
            most = 0.5 * math.pi - _OFF
            off = min(max(off, -most), most)
            unit = turned_to(self.unit, self.unit.site.flow_heading - off)
            analyses, given = self.settings.analyses, self.settings.impact
            answer = None
            if "impact" in analyses:
                answer = solve_impact(unit, given)
            elif "waves" in analyses:
                answer = solve_impact(unit, given, unit.normal_speed or 1.0)
            self._units[normal] = unit, answer
        return self._units[normal]


def best_orientation(ratio: Array) -> int | None:
    """Return the place of the largest value; where several are alike, the middle of their longest run.

    ``None`` where all are alike or none is known.

    Orientations go round: the last is a neighbour of the first, half a turn further.
    """
    if not np.isfinite(ratio).any():
        return None
    known = np.where(np.isfinite(ratio), ratio, -math.inf)
    alike = known >= known.max() * (1.0 - _ALIKE)
    if alike.all():
        return None
    count = alike.size
    start = int(np.argmin(alike))
    best, length, run = 0, 0, 0
    for step in range(1, count + 1):
        place = (start + step) % count
        run = run + 1 if alike[place] else 0
        if run > length:
            length, best = run, (place - run // 2) % count
    return best


def rose_dataset(
    unit: LevelCurtain, settings: CurtainSettings, seas: Sequence[SeaState], progress: Progress
) -> xr.Dataset:
    """Return the group ``rose``: the height held over orientation and wave heading, and in the seas of the case.

    Parameters
    ----------
    unit : LevelCurtain
    settings : Settings
        With ``limits.rose_step``.
    seas : sequence of SeaState
        Each has its heading and height; without any there is no best orientation.
    progress : Progress
        An interrupt is handed on.
    """
    import xarray as xr

    step = settings.limits.rose_step
    assert step is not None
    half = round(math.pi / step)
    own = unit.curtain.normal
    normals = own + step * np.arange(half)
    headings = own + step * np.arange(2 * half)
    square = turned_to(unit, unit.site.flow_heading)
    facing = replace(settings, limits=replace(settings.limits, wave_angle=0.0))
    curve = drag_curve(square, fastest_water(square, facing, ()))
    rose = RoseLimits(unit, settings, curve, longest_sea(seas))
    rows, in_seas = [], []
    for count, normal in enumerate(normals):
        progress(f"limit rose, {unit.name}", count, half)
        rows.append([rose.held(float(normal), float(heading)) for heading in headings])
        in_seas.append([rose.held(float(normal), sea.heading) for sea in seas])
    progress(f"limit rose, {unit.name}", half, half)
    dims, at_sea = ("orientation", "wave_heading"), ("orientation", "sea")
    data: dict[str, Any] = {
        "rose_height": (dims, np.array([[item.height for item in row] for row in rows])),
        "rose_governing": (dims, np.array([[item.governing for item in row] for row in rows], dtype=object)),
        "rose_bound": (dims, np.array([[item.bound for item in row] for row in rows], dtype=object)),
    }
    coords = {"orientation": normals, "wave_heading": headings}
    attributes = {"own_orientation": own, "highest_height": settings.limits.highest_height}
    if seas:
        heights = np.array([significant_height(sea) for sea in seas])
        held = np.array([[item.height for item in row] for row in in_seas])
        ratio = (held / heights).min(axis=1)
        data |= {
            "sea_rose_height": (at_sea, held),
            "sea_rose_governing": (
                at_sea, np.array([[item.governing for item in row] for row in in_seas], dtype=object)
            ),
            "sea_heading": (("sea",), np.array([sea.heading for sea in seas])),
            "sea_height": (("sea",), heights),
            "held_ratio": (("orientation",), ratio),
        }  # fmt: skip
        coords["sea"] = np.array([sea.name for sea in seas], dtype=object)
        best = best_orientation(ratio)
        if best is not None:
            attributes["best_orientation"] = float(normals[best])
    return labelled(xr.Dataset(data, coords=coords, attrs=attributes))
