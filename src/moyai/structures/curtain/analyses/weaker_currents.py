"""Impact and waves in weaker currents than that of the case, which come with every stronger one, twice a tide.

A skirt that is held at both edges hangs straighter in a weaker current, and a straighter sheet carries more of the same
snap. Where the current of the case leaves an upright plate as a bound alone, its load in a weaker current in which it
stays upright is a value all the same [eq:curtain-hierarchy].
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

from moyai.core.progress import Progress
from moyai.sea.states import SeaState
from moyai.structures.curtain.analyses.impact import ImpactAnswer
from moyai.structures.curtain.analyses.waves import sea_cycles, still_flows, strong_tension
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.hierarchy import STRAIGHT, held_at_both, straight_share, upright_in
from moyai.structures.curtain.limits.loads import impact_load
from moyai.structures.curtain.limits.utilisation import AddedLoads
from moyai.structures.curtain.model import CurtainSettings
from moyai.structures.curtain.seas.loads import increase, steady_loads
from moyai.structures.curtain.snaps.flow import SkirtFlow
from moyai.structures.curtain.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

#: Parts of the strongest current in which an upright plate governs, at which the impact is compared with its own.
_OF_IMPACT = (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
#: Step of the currents in which the waves are run, over the speed of a long wave over the skirt's depth [-]: that of a
#: stronger current holds those of a weaker one.
_STEP_OF_WAVES = 0.008


@dataclass(frozen=True)
class WeakerLoads:
    """What adds to the steady loads of a curtain in a weaker current, with its lower and upper end."""

    #: The curtain in that current.
    unit: LevelCurtain
    #: Where it is from.
    source: str
    #: What it adds.
    value: AddedLoads
    #: Lower end of what it adds.
    low: AddedLoads
    #: Upper end of what it adds.
    high: AddedLoads
    #: Whether the load of the sheet is known.
    sheet: bool
    #: Whether the skirt hangs so straight there that the plate governs; else it is a bound.
    upright: bool = True

    @cached_property
    def still(self) -> AddedLoads:
        """The loads at rest in that current."""
        return steady_loads(self.unit.statics) if self.unit.surface_speed > 0.0 else AddedLoads()


def currents_of_waves(unit: LevelCurtain) -> tuple[float, ...]:
    """Return the weaker currents in which the waves are run [m/s], slack water the first.

    Those up to the one that is as strong as the drift of the waves are among them, also where the case has a weaker
    one, or none; of a skirt that hangs straight in no current, the drift alone, in which the plate is a bound.
    """
    own, drift = unit.surface_speed, unit.drift_speed
    if unit.nominal or not held_at_both(unit.curtain):
        return ()
    top = upright_in(unit, max(own, drift))
    if not top > 0.0:
        return (drift,) if drift > own else ()
    step = step_of_waves(unit)
    speeds = {number * step for number in range(int(top / step) + 1)} | ({drift} if drift > own else set())
    return tuple(sorted(speed for speed in speeds if abs(speed - own) > 1e-6 * top))


def step_of_waves(unit: LevelCurtain) -> float:
    """Return the step of the currents in which waves are run [m/s]."""
    return _STEP_OF_WAVES * math.sqrt(unit.water.gravity * unit.depth)


def _said(speed: float, own: float) -> str:
    """Say in which current the load is, next to that of the case [m/s]."""
    if speed > own:
        return f"in a drift with the waves, as in a current of {speed:.3g} m/s"
    return f"in a weaker current of {speed:.3g} m/s" if speed > 0.0 else "at slack water"


def weaker_impacts(unit: LevelCurtain, settings: CurtainSettings, answer: ImpactAnswer) -> Iterator[WeakerLoads]:
    """Yield the impact in weaker currents."""
    load = impact_load(unit, answer, settings)
    low, high = answer.uncertainty
    top = 0.0 if unit.nominal else upright_in(unit, unit.surface_speed)
    for part in _OF_IMPACT:
        if not 0.0 < part * top < unit.surface_speed:
            continue
        there = replace(unit, surface_speed=part * top)
        struck = load.at(unit.unit_normal_speed * there.surface_speed)
        source = f"impact, model {answer.design_model}, {_said(there.surface_speed, unit.surface_speed)}"
        yield WeakerLoads(there, source, struck, struck.times(low), struck.times(high), load.skirt is not None)


def weaker_waves(
    unit: LevelCurtain,
    settings: CurtainSettings,
    seas: Sequence[SeaState],
    progress: Progress,
    strong_drag: Mapping[str, float] | None = None,
    flows: Mapping[str, Sequence[SkirtFlow]] | None = None,
) -> xr.Dataset | None:
    """Return slack and taut cycles of the seas in weaker currents, ``None`` where no upright plate governs there.

    Parameters
    ----------
    unit : LevelCurtain
    settings : CurtainSettings
    seas : sequence of SeaState
    progress : Progress
        Called after every current.
    strong_drag : mapping, optional
        What the upper end of the drag coefficient makes of the judged tension of a sea, in the current of the case.
    flows : mapping, optional
        What :func:`moyai.structures.curtain.analyses.waves.still_flows` gives for the seas by name.
    """
    import xarray as xr

    speeds = currents_of_waves(unit)
    if not speeds or not seas:
        return None
    slower = [replace(unit, surface_speed=speed) for speed in speeds]
    rows: dict[str, list[list[float]]] = {
        "both_cables_tension_maximum": [],
        "both_cables_tension_maximum_low": [],
        "judged_tension": [],
    }
    for sea in seas:
        found = []
        still = still_flows(unit, settings.waves, sea) if flows is None else flows[sea.name]
        strong = 1.0 if strong_drag is None else strong_drag.get(sea.name, 1.0)
        for number, there in enumerate(slower):
            progress(f"weaker currents, {sea.name}", number, len(slower))
            found.append(sea_cycles(there, settings, sea, still))
        drifting = strong
        if slower[-1].surface_speed > unit.surface_speed and found[-1].judged > 0.0:
            # what a current weaker than the drift makes of the coefficient says little of it
            drifting = max(strong_tension(slower[-1], settings, sea, found[-1], still) / found[-1].judged, 1.0)
        factors = [drifting if there.surface_speed > unit.surface_speed else strong for there in slower]
        rows["both_cables_tension_maximum"].append([one.top for one in found])
        rows["both_cables_tension_maximum_low"].append([one.low for one in found])
        rows["judged_tension"].append([factor * one.judged for factor, one in zip(factors, found, strict=True)])
    coords = {"sea": [sea.name for sea in seas], "weaker_current": list(speeds)}
    return labelled(xr.Dataset({name: (tuple(coords), values) for name, values in rows.items()}, coords=coords))


def weaker_cycles(
    unit: LevelCurtain, settings: CurtainSettings, proportions: ImpactAnswer, table: xr.Dataset
) -> Iterator[WeakerLoads]:
    """Yield what slack and taut cycles add in weaker currents, by the table of :func:`weaker_waves`."""
    load = impact_load(unit, proportions, settings)
    for number, speed in enumerate(table["weaker_current"].values):
        there, column = replace(unit, surface_speed=float(speed)), table.isel(weaker_current=number)
        for sea in column["sea"].values:
            ends = []
            for name in ("both_cables_tension_maximum", "both_cables_tension_maximum_low", "judged_tension"):
                tension = float(column[name].sel(sea=sea))
                whole = load.of_tension(tension, unit.unit_normal_speed * there.surface_speed)
                ends.append(increase(whole, there.statics) if there.surface_speed > 0.0 else whole)
            source = f"slack and taut cycles, {sea}, {_said(there.surface_speed, unit.surface_speed)}"
            upright = straight_share(unit, there.surface_speed) >= STRAIGHT
            yield WeakerLoads(there, source, ends[0], ends[1], ends[2], load.skirt is not None, upright)


__all__ = ["WeakerLoads", "currents_of_waves", "step_of_waves", "weaker_cycles", "weaker_impacts", "weaker_waves"]
