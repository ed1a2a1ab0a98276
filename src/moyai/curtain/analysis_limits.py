"""Up to which current and wave height a curtain holds, and what governs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress
from moyai.curtain.analysis_anchor import rope_model
from moyai.curtain.analysis_impact import ImpactAnswer, drag_coefficient
from moyai.curtain.assembly import LevelCurtain
from moyai.curtain.cycle_table import CycleTable
from moyai.curtain.impact import peak_by_energy
from moyai.curtain.limits import height_limit, speed_limit, utilisation
from moyai.curtain.model import Settings
from moyai.curtain.sea_loads import DragCurve, ImpactLoad, SeaLoads
from moyai.curtain.sea_states import DesignWave
from moyai.curtain.squared_velocity import effective_height, squared_velocity
from moyai.curtain.statics import CurtainStatics
from moyai.curtain.variables import labelled
from moyai.sea.breaking import breaking_limit

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]
PARTS = ("upper cable", "lower cable", "sheet", "joint", "anchor line", "anchor", "floats", "effective depth")
_SPEED_COUNT, _HEIGHT_COUNT = 9, 11
#: Without impact at a standstill the start speed keeps this ratio to the water's [-]
_PAPER_RATIO = 1.0


def impact_load(unit: LevelCurtain, answer: ImpactAnswer, settings: Settings) -> ImpactLoad:
    """Return the impact at any speed of the water, in the proportions of the case."""
    given = settings.impact
    ratio = _PAPER_RATIO
    if unit.normal_speed > 0.0 and (given.start_speed is not None or given.start == "slack_phase"):
        ratio = answer.impact.speed / unit.normal_speed
    return ImpactLoad(
        answer.impact,
        answer.design_tension / peak_by_energy(answer.impact).tension,
        answer.shares,
        ratio,
        answer.half_angle,
        unit.hanging.anchor_slope,
    )


def fastest_water(unit: LevelCurtain, settings: Settings, waves: tuple[DesignWave, ...]) -> float:
    """Return the largest root of the squared velocity [m/s] that load table and operating limits ask for.

    Parameters
    ----------
    unit : LevelCurtain
    settings : Settings
    waves : tuple of DesignWave
        Of the case.
    """
    limits = settings.limits
    rule, ratio = settings.direction
    water, speeds = unit.water, [unit.normal_speed]

    def root(height: float, period: float, current: float) -> float:
        return math.sqrt(float(squared_velocity(height, period, current, unit.depth, water)))

    speeds += [root(wave.effective_height(rule, ratio), wave.period, unit.normal_speed) for wave in waves]
    if "limits" in settings.analyses:
        current = unit.unit_normal_speed * limits.highest_speed
        for height in np.linspace(0.0, limits.highest_height, 30)[1:]:
            period = limits.period_of(float(height))
            acting = float(effective_height(height, limits.wave_angle, rule, ratio))
            if acting <= breaking_limit(period, water).height:
                speeds.append(root(acting, period, current))
        speeds.append(current)
    return 1.0001 * max(speeds)


def sea_loads(unit: LevelCurtain, settings: Settings, answer: ImpactAnswer | None, curve: DragCurve) -> SeaLoads:
    """Return what any sea adds to the steady loads.

    Parameters
    ----------
    unit : LevelCurtain
    settings : Settings
    answer : ImpactAnswer or None
        None where neither impact nor slack and taut cycles were asked for.
    curve : DragCurve
        Loads at rest, up to :func:`fastest_water`.
    """
    limits, anchor = settings.limits, settings.anchor_loads
    asked = "impact" in settings.analyses
    lines = unit.curtain.anchors
    with_lines = anchor is not None and lines is not None and "anchor_loads" in settings.analyses
    return SeaLoads(
        period=limits.period_of,
        angle=limits.wave_angle,
        rule=settings.direction[0],
        height_ratio=settings.direction[1],
        depth=unit.depth,
        normal_ratio=unit.unit_normal_speed,
        drag=curve,
        energy=rope_model(unit, anchor) if with_lines and anchor is not None else None,
        pretension=_pretension(unit, settings),
        steady=0.0 if lines is None or lines.pretension is None else lines.pretension,
        impact=impact_load(unit, answer, settings) if answer is not None and asked and limits.impact else None,
        snaps=None if answer is None else (_cycles(unit, settings, answer), impact_load(unit, answer, settings)),
    )


def _cycles(unit: LevelCurtain, settings: Settings, answer: ImpactAnswer) -> CycleTable:
    rule, ratio = settings.direction
    limits = settings.limits

    def acting(height: float) -> float:
        return float(effective_height(height, limits.wave_angle, rule, ratio))

    at_unit = unit.site.current(1.0).depth_mean(-unit.depth, 0.0)
    normal = unit.curtain.normal
    return CycleTable(
        answer.impact,
        drag_coefficient(unit, answer.impact.draught),
        unit.depth,
        float(at_unit @ np.array([math.cos(normal), math.sin(normal)])),
        acting,
        limits.period_of,
        limits.highest_height,
    )


def _pretension(unit: LevelCurtain, settings: Settings) -> float | None:
    """Return the steady tension that the energy model takes [N]; None: that of the statics at each speed."""
    anchor, lines = settings.anchor_loads, unit.curtain.anchors
    if anchor is not None and not anchor.pretension:
        return 0.0
    return None if lines is None else lines.pretension


def limits_dataset(
    unit: LevelCurtain,
    settings: Settings,
    answer: ImpactAnswer | None,
    curve: DragCurve,
    progress: Progress,
) -> xr.Dataset:
    """Return the group ``limits``: largest height for each current, and the utilisation over both.

    Parameters
    ----------
    unit : LevelCurtain
    settings : Settings
    answer : ImpactAnswer or None
        None where the impact was not asked for.
    curve : DragCurve
        Loads at rest, up to :func:`fastest_water`.
    progress : Progress
        An interrupt is handed on.
    """
    import xarray as xr

    limits = settings.limits
    loads = sea_loads(unit, settings, answer, curve)
    required = unit.requirements
    most = speed_limit(unit.hanging, unit.site, required, highest=limits.highest_speed, waves=loads)
    speeds = _speeds(unit, settings, most.value)
    rows = []
    for count, speed in enumerate(speeds):
        progress(f"operating limits, {unit.name}", count, len(speeds))
        rows.append(height_limit(unit.hanging, unit.site, required, loads, speed=speed, highest=limits.highest_height))
    progress(f"operating limits, {unit.name}", len(speeds), len(speeds))
    heights = _heights(settings, max((row.value for row in rows), default=0.0))
    parts = _grid(unit, loads, speeds, heights)
    worst = np.nanmax(parts, axis=2)
    names = _governing(parts)
    data: dict[str, Any] = {
        "limit_height": ("speed", [row.value for row in rows]),
        "limit_governing": ("speed", [row.governing for row in rows]),
        "limit_utilisation": (("speed", "height"), worst),
        "limit_component": (("speed", "height"), names),
        "component_utilisation": (("speed", "height", "component"), parts),
        "surface_speed": ((), unit.surface_speed),
        "speed_limit": ((), most.value),
        "drowning_speed": ((), unit.drowning_speed),
    }
    return labelled(
        xr.Dataset(
            data,
            coords={
                "speed": ("speed", np.asarray(speeds), {"units": "m/s", "long_name": "surface speed of the current"}),
                "height": heights,
                "component": list(PARTS),
            },
            attrs={
                "speed_limit_governing": most.governing,
                "wave_angle": limits.wave_angle,
                "with_impact": int(loads.impact is not None),
                "with_snaps": int(loads.snaps is not None),
                "with_energy_model": int(loads.energy is not None),
            },
        )
    )


def _speeds(unit: LevelCurtain, settings: Settings, limit: float) -> tuple[float, ...]:
    """Return the speeds of the table: as given, or up to the limit, with the current of the case."""
    if settings.limits.speeds is not None:
        # a table begins at a current: without one there is no shape to speak of
        return tuple(max(speed, 1e-3) for speed in settings.limits.speeds)
    top = max(1.2 * limit, unit.surface_speed, 0.1)
    top = min(top, settings.limits.highest_speed)
    even = np.linspace(0.0, _round_up(top), _SPEED_COUNT)[1:]
    values = [float(value) for value in even]
    if unit.surface_speed > 0.0 and min(abs(unit.surface_speed - value) for value in values) > 1e-9:
        values.append(unit.surface_speed)
    return tuple(sorted(values))


def _heights(settings: Settings, limit: float) -> Array:
    if settings.limits.heights is not None:
        return np.array(settings.limits.heights)
    top = min(max(1.3 * limit, 0.5), settings.limits.highest_height)
    return np.linspace(0.0, _round_up(top), _HEIGHT_COUNT)


def _round_up(value: float) -> float:
    size = 10.0 ** math.floor(math.log10(value))
    return float(
        next(step * size for step in (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 8.0, 10.0) if step * size >= value * 0.999)
    )


def _grid(unit: LevelCurtain, loads: SeaLoads, speeds: tuple[float, ...], heights: Array) -> Array:
    """Return the utilisation of each part at each speed and height; infinite beyond equilibrium or breaking."""
    required = unit.requirements
    out = np.full((len(speeds), heights.size, len(PARTS)), math.nan)
    for i, speed in enumerate(speeds):
        statics = _statics(unit, speed)
        for j, height in enumerate(heights):
            if statics is None or _breaks(unit, loads, float(height)):
                out[i, j] = math.inf
                continue
            try:
                more = loads.added(statics, float(height), speed, unit.water)
            except InputError:
                out[i, j] = math.inf
                continue
            parts = utilisation(statics, required, 0.0, more)
            out[i, j] = [parts.get(name, math.nan) for name in PARTS]
    return out


def _statics(unit: LevelCurtain, speed: float) -> CurtainStatics | None:
    try:
        return unit.site.statics(unit.hanging, speed)
    except (InputError, ConvergenceError):
        return None


def _breaks(unit: LevelCurtain, loads: SeaLoads, height: float) -> bool:
    if height <= 0.0:
        return False
    return loads.height_ratio * height > breaking_limit(loads.period(height), unit.water).height


def _governing(parts: Array) -> NDArray[Any]:
    out = np.empty(parts.shape[:2], dtype=object)
    for place in np.ndindex(out.shape):
        row = parts[place]
        if np.isinf(row).all():
            out[place] = "no equilibrium or breaking"
        else:
            out[place] = PARTS[int(np.nanargmax(row))]
    return out
