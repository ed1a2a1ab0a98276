"""The groups of an impact: table of the models, marching, series, and the snap with its pictures."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.structures.curtain.analyses.impact import ImpactAnswer, counts, drag_coefficient, skirt_tension, start_speed
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.frames import frame_times, plan_frames
from moyai.structures.curtain.impact.added_mass import flat_skirt_mass
from moyai.structures.curtain.impact.cable import Impact, closed_form, impact_numbers, peak_by_energy
from moyai.structures.curtain.impact.cycles import slack_sag
from moyai.structures.curtain.impact.kernels import taut_shape
from moyai.structures.curtain.impact.march import iterate_first_step, march_impact
from moyai.structures.curtain.impact.memory import impact_with_memory
from moyai.structures.curtain.impact.release import Snap, snap_in_current
from moyai.structures.curtain.model import ImpactSettings
from moyai.structures.curtain.variables import labelled

if TYPE_CHECKING:
    import xarray as xr


_MARCH_STEPS = (1, 4, 16, 64, 256, 1024)
_AUTO_STEP = 0.01  # omega dt
_MOST_POINTS = 600
_FRAMES = (40, 70, 30)  # pictures of slack phase, spike and plateau
_PLAN_POINTS, _SECTION_POINTS = 41, 11


def impact_groups(unit: LevelCurtain, settings: ImpactSettings, answer: ImpactAnswer) -> dict[str, xr.Dataset]:
    """Return the group ``impact`` and its series.

    Parameters
    ----------
    unit : LevelCurtain
    settings : ImpactSettings
    answer : ImpactAnswer
        From :func:`solve_impact`.
    """
    groups = {"impact": _table(unit, settings, answer)}
    groups["impact/A"] = _marched(answer, settings)
    groups["impact/A2"] = _edges(answer)
    if any("memory" in item.model for item in answer.comparison.models):
        groups["impact/memory"] = _memory(answer)
    snap = find_snap(unit, settings, answer.impact)
    if snap is not None:
        groups["impact/snap"] = _snap(snap, answer.impact)
        groups["impact"]["both_cables_plateau_tension"] = ((), snap.plateau_tension)
        groups["impact"] = labelled(groups["impact"])
    return groups


def find_snap(unit: LevelCurtain, settings: ImpactSettings, impact: Impact) -> Snap | None:
    """Return the snap from release to plateau in the current of the case, None without a current."""
    current = unit.normal_speed
    if not current > 0.0:
        return None
    position = settings.release_position or 0.0
    if abs(position) >= slack_sag(impact):
        return None
    return snap_in_current(
        impact,
        drag_coefficient=drag_coefficient(unit, impact.draught),
        current=current,
        position=position,
        speed=0.0,
    )


def _table(unit: LevelCurtain, settings: ImpactSettings, answer: ImpactAnswer) -> xr.Dataset:
    import xarray as xr

    impact, water, edges = answer.impact, unit.water, answer.edges
    models = answer.comparison.models
    exact = peak_by_energy(impact)
    upper = [edges.upper_peak if item.model == "A2" else math.nan for item in models]
    lower = [edges.lower_peak if item.model == "A2" else math.nan for item in models]
    sheet = [
        float(getattr(item, "skirt_tension", math.nan))
        if math.isfinite(getattr(item, "skirt_tension", math.nan))
        else skirt_tension(answer, item.tension)
        for item in models
    ]
    b = taut_shape(impact.span_ratio)
    step = settings.time_step if settings.time_step is not None else _auto_step(impact)
    relative = 0.5 * math.pi * step / _rise(impact)
    numbers = None if math.isinf(water.depth) else impact_numbers(impact, exact.tension)
    speed, source = start_speed(unit, settings)
    scalars: dict[str, float] = {
        "start_speed": speed,
        "draught": impact.draught,
        "added_mass": impact.deep_mass,
        "added_mass_in_depth": flat_skirt_mass(impact.draught, water).total,
        "taut_sag": slack_sag(impact),
        "shape_number": b,
        "cable_stiffness": impact.stiffness,
        "tension_coefficient": math.nan if numbers is None else numbers.tension_coefficient,
        "cauchy_number": math.nan if numbers is None else numbers.cauchy_number,
        "froude_number": 0.0 if numbers is None else numbers.froude_number,
        "rise_ratio": exact.time / math.sqrt(impact.draught / water.gravity),
        "relative_step": relative,
        "time_step": step,
        "both_cables_plateau_tension": math.nan,
        "spread": answer.comparison.spread,
        "design_tension": answer.design_tension,
    }
    march = [_march_row(impact, count, exact.tension) for count in _MARCH_STEPS]
    names = (
        "march_tension",
        "march_error",
        "march_predicted_error",
        "forward_iteration_converges",
        "reverse_iteration_converges",
    )
    return labelled(
        xr.Dataset(
            {
                "both_cables_impact_tension": ("impact_model", [item.tension for item in models]),
                "impact_time": ("impact_model", [item.time for item in models]),
                "impact_upper_tension": ("impact_model", upper),
                "impact_lower_tension": ("impact_model", lower),
                "impact_skirt_tension": ("impact_model", sheet),
                "impact_ratio": ("impact_model", [item.tension / exact.tension for item in models]),
                "assumption": ("impact_model", [item.assumption for item in models]),
                "counts": ("impact_model", [float(counts(item.model)) for item in models]),
                **{name: ((), value) for name, value in scalars.items()},
                "steps_to_peak": ("march_step", np.array(_MARCH_STEPS, dtype=float)),
                **{name: ("march_step", [row[k] for row in march]) for k, name in enumerate(names)},
            },
            coords={"impact_model": [item.model for item in models]},
            attrs={"design_model": answer.design_model, "start_speed_source": source},
        )
    )


def _rise(impact: Impact) -> float:
    """Return the rise at small strain [s], of the exact peak where the cable is as long as its span."""
    time = closed_form(impact).time
    return time if math.isfinite(time) else peak_by_energy(impact).time


def _auto_step(impact: Impact) -> float:
    """Return the step whose omega dt is 0.01: the marching is then 0.4 % low."""
    return _AUTO_STEP * _rise(impact) / (0.5 * math.pi)


def _march_row(impact: Impact, count: int, exact: float) -> tuple[float, float, float, float, float]:
    """March with a number of steps to the peak, and try both iterations of its first step."""
    rise = peak_by_energy(impact).time
    step = rise / count
    found = march_impact(impact, time_step=step, duration=1.6 * rise)
    forward = reverse = math.nan
    if impact.length > impact.span:
        forward = float(iterate_first_step(impact, step, reverse=False).converged)
        reverse = float(iterate_first_step(impact, step, reverse=True).converged)
    predicted = -math.pi / 8.0 * found.relative_step
    return found.peak.tension, found.peak.tension / exact - 1.0, predicted, forward, reverse


def _marched(answer: ImpactAnswer, settings: ImpactSettings) -> xr.Dataset:
    import xarray as xr

    impact = answer.impact
    step = settings.time_step if settings.time_step is not None else _auto_step(impact)
    found = march_impact(impact, time_step=step, duration=max(1.6 * peak_by_energy(impact).time, step))
    every = max(1, math.ceil(found.time.size / _MOST_POINTS))
    keep = np.unique(np.append(np.arange(0, found.time.size, every), int(np.argmax(found.tension))))
    data = {name: ("time", getattr(found, name)[keep]) for name in ("displacement", "speed", "tension")}
    return labelled(xr.Dataset(data, coords={"time": found.time[keep]}, attrs={"time_step": step}))


def _edges(answer: ImpactAnswer) -> xr.Dataset:
    import xarray as xr

    found = answer.edges
    every = max(1, found.time.size // _MOST_POINTS)
    keep = np.arange(0, found.time.size, every)
    data = {
        "tension": ("time", (found.upper_tension + found.lower_tension)[keep]),
        "upper_tension": ("time", found.upper_tension[keep]),
        "lower_tension": ("time", found.lower_tension[keep]),
    }
    return labelled(xr.Dataset(data, coords={"time": found.time[keep]}))


def _memory(answer: ImpactAnswer) -> xr.Dataset:
    import xarray as xr

    found = impact_with_memory(answer.impact)
    keep = np.arange(0, found.time.size, max(1, found.time.size // _MOST_POINTS))
    names = ("displacement", "speed", "tension", "memory_force")
    data = {name: ("time", getattr(found, name)[keep]) for name in names}
    return labelled(xr.Dataset(data, coords={"time": found.time[keep]}, attrs={"ratio": found.ratio}))


def _snap(snap: Snap, impact: Impact) -> xr.Dataset:
    """Return the snap with its pictures: a slack curtain is drawn as the taut one made flatter."""
    import xarray as xr

    motion = snap.motion
    keep = _around_spike(motion.time, snap.taut_time, snap.peak_time)
    when = frame_times(snap.taut_time, snap.peak_time, float(motion.time[-1]), _FRAMES)
    place = np.interp(when, motion.time, motion.position)
    x, y = plan_frames(impact.span, place, slack_sag(impact), taut_shape(impact.span_ratio), _PLAN_POINTS)
    z = np.linspace(0.0, -impact.draught, _SECTION_POINTS)
    data: dict[str, Any] = {
        **{name: ("time", getattr(motion, name)[keep]) for name in ("position", "speed", "tension")},
        "frame_time": ("frame", when),
        "frame_position": ("frame", place),
        "frame_tension": ("frame", np.interp(when, motion.time, motion.tension)),
        "frame_plan_x": (("frame", "plan_point"), x),
        "frame_plan_y": (("frame", "plan_point"), y),
        "frame_section_x": (("frame", "section_point"), np.repeat(place[:, None], z.size, axis=1)),
        "frame_section_z": (("frame", "section_point"), np.repeat(z[None, :], when.size, axis=0)),
    }
    attrs = {
        "taut_time": snap.taut_time,
        "peak_time": snap.peak_time,
        "start_speed": snap.start_speed,
        "both_cables_peak_tension": snap.peak_tension,
        "both_cables_plateau_tension": snap.plateau_tension,
        "both_cables_impact_tension": snap.impact_tension,
    }
    return labelled(xr.Dataset(data, coords={"time": motion.time[keep]}, attrs=attrs))


def _around_spike(time: Array, taut: float, peak: float) -> NDArray[np.int64]:
    """Return indices that keep every step about the spike and thin out the rest."""
    near = (time > taut - 0.5 * (peak - taut)) & (time < taut + 8.0 * (peak - taut))
    every = np.arange(0, time.size, max(1, time.size // _MOST_POINTS))
    inside = np.flatnonzero(near)
    inside = inside[:: max(1, inside.size // _MOST_POINTS)]
    return np.unique(np.concatenate([every, inside]))
