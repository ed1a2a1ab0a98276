"""The impact when the curtain becomes taut: start speed, all models side by side, marching, the snap over time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.errors import InputError
from moyai.core.validity import IdentityCheck, Notice
from moyai.curtain.added_mass import flat_skirt_mass
from moyai.curtain.assembly import LevelCurtain
from moyai.curtain.closed_forms import arc_half_angle
from moyai.curtain.impact import EdgeImpact, Impact, closed_form, edge_impact, impact_numbers, peak_by_energy
from moyai.curtain.impact_compare import Comparison, compare_models
from moyai.curtain.impact_kernels import spring, taut_shape
from moyai.curtain.impact_march import iterate_first_step, march_impact
from moyai.curtain.impact_release import Snap, slack_phase, snap_in_current
from moyai.curtain.impact_skirt import Skirt as BulgingSkirt
from moyai.curtain.impact_waves import slack_sag
from moyai.curtain.model import ImpactSettings
from moyai.curtain.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

_MARCH_STEPS = (1, 4, 16, 64, 256, 1024)
_AUTO_STEP = 0.01  # omega dt
_MOST_POINTS = 600
_FRAMES = (40, 70, 30)  # pictures of slack phase, spike and plateau
_PLAN_POINTS, _SECTION_POINTS = 41, 11
_NO_CABLE = 1e-6
#: A skirt reaches at most so much of the depth in the impact models, whose plate ends above the bed
_DEEPEST = 0.98


@dataclass(frozen=True, eq=False)
class ImpactAnswer:
    """What the impact analysis of a level found.

    Parameters
    ----------
    impact : Impact
        The span, with its start speed.
    comparison : Comparison
        All models.
    edges : EdgeImpact
        Model A2, for the shares of the cables.
    design_model : str
        Whose tension the load table takes.
    design_tension : float
        Of both cables together [N].
    half_angle : float
        Of the just-taut arc of the skirt [rad]; NaN where no chord is known.
    """

    impact: Impact
    comparison: Comparison
    edges: EdgeImpact
    design_model: str
    design_tension: float
    half_angle: float

    @property
    def shares(self) -> tuple[float, float]:
        """Peaks of the upper and of the lower cable over that of their sum [-]."""
        whole = self.edges.simultaneous_peak
        return self.edges.upper_peak / whole, self.edges.lower_peak / whole


def impact_of(unit: LevelCurtain, settings: ImpactSettings, speed: float) -> Impact:
    """Return the span of a level for the impact models.

    Parameters
    ----------
    unit : LevelCurtain
    settings : ImpactSettings
    speed : float
        Of the curtain when it becomes taut [m/s].

    Raises
    ------
    InputError
        As :class:`moyai.curtain.impact.Impact`.
    """
    curtain = unit.curtain
    upper = curtain.upper_stiffness
    lower = curtain.lower_stiffness if curtain.lower_stiffness > 0.0 else _NO_CABLE * upper
    share = 0.5 if settings.cables == "one" else 1.0
    draught = settings.draught
    if draught is None:
        draught = min(curtain.skirt.length, _DEEPEST * unit.water.depth)
    return Impact(
        curtain.span,
        curtain.length,
        draught,
        share * upper,
        share * lower,
        speed,
        unit.water,
    )


def drag_coefficient(unit: LevelCurtain, draught: float) -> float:
    """Return C_D of the flat plate that stands for the skirt [-]."""
    blockage = 0.0 if math.isinf(unit.water.depth) else draught / unit.water.depth
    return unit.hanging.drag.coefficient(blockage)


def start_speed(unit: LevelCurtain, settings: ImpactSettings) -> tuple[float, str]:
    """Return the speed at the taut instant [m/s] and where it comes from.

    Raises
    ------
    InputError
        Without a current, or when a release never makes the curtain taut.
    """
    if settings.start_speed is not None:
        return settings.start_speed, "given"
    current = unit.normal_speed
    if not current > 0.0:
        raise InputError(
            "the start speed of the impact needs a current along the normal",
            path="settings.impact.start",
            remedy="give 'current', or 'settings.impact.start_speed'",
        )
    if settings.start == "current":
        return current, "current, mean over the skirt"
    impact = impact_of(unit, settings, current)
    phase = slack_phase(
        impact,
        drag_coefficient=drag_coefficient(unit, impact.draught),
        current=current,
        position=settings.release_position,
        speed=0.0,
    )
    return abs(phase.speed), f"drift from release, {100.0 * phase.share:.3g} % of the current"


def bulging_skirt(unit: LevelCurtain, settings: ImpactSettings) -> BulgingSkirt | None:
    """Return the arc of the skirt for models B and AB, or None where the data do not give one.

    Raises
    ------
    InputError
        When a given chord leaves no arc.
    """
    skirt = unit.curtain.skirt
    if math.isinf(skirt.stiffness):
        return None
    if settings.chord is not None:
        return BulgingSkirt(skirt.length, settings.chord, skirt.stiffness)
    if unit.curtain.toe != "held" or unit.surface_speed == 0.0 or unit.site.on_bed:
        return None
    section = unit.statics.section
    try:
        return BulgingSkirt(skirt.length, math.hypot(section.effective_depth, section.flare), skirt.stiffness)
    except InputError:
        return None


def solve_impact(unit: LevelCurtain, settings: ImpactSettings, speed: float | None = None) -> ImpactAnswer:
    """Solve all models of the impact at a level.

    Parameters
    ----------
    unit : LevelCurtain
    settings : ImpactSettings
    speed : float, optional
        At the taut instant [m/s]; by the settings when not given.

    Raises
    ------
    InputError
        When the curtain is shorter than its span, or a number is out of range.
    """
    taken = start_speed(unit, settings)[0] if speed is None else speed
    impact = impact_of(unit, settings, taken)
    skirt = bulging_skirt(unit, settings)
    comparison = compare_models(impact, skirt)
    fit = [item for item in comparison.models if counts(item.model) and math.isfinite(item.tension)]
    design = max(fit, key=lambda item: item.tension)
    angle = math.nan if skirt is None else float(arc_half_angle(skirt.chord / skirt.length))
    return ImpactAnswer(impact, comparison, edge_impact(impact), design.model, design.tension, angle)


def counts(model: str) -> bool:
    """Whether a model counts in the load table.

    Model B leaves out that cables stretch, the closed form is for small strain and the marching has its time step:
    they are shown beside the models that they approximate.
    """
    return not model.startswith("B ") and "closed form" not in model and "marched" not in model


def skirt_tension(answer: ImpactAnswer, tension: float) -> float:
    """Return the tension of the skirt per width [N/m] that goes with a sum of cable tensions [N].

    Each cable bears half of the load on the section, sigma d0/2, and the skirt is an arc: T_s = F_c / sin(alpha)
    [eq:curtain-edge-load].
    """
    if math.isnan(answer.half_angle):
        return math.nan
    return 0.5 * line_load(answer, tension) / math.sin(answer.half_angle)


def line_load(answer: ImpactAnswer, tension: float) -> float:
    """Return the load per length of curtain [N/m] that goes with a sum of cable tensions [N], T/a just taut."""
    impact = answer.impact
    b = taut_shape(impact.span_ratio)
    return 2.0 * b * tension / impact.span


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
    snap = find_snap(unit, settings, answer.impact)
    if snap is not None:
        groups["impact/snap"] = _snap(snap, answer.impact)
        groups["impact"]["plateau_tension"] = ((), snap.plateau_tension)
        groups["impact"] = labelled(groups["impact"])
    return groups


def find_snap(unit: LevelCurtain, settings: ImpactSettings, impact: Impact) -> Snap | None:
    """Return the snap from release to plateau in the current of the case, None without a current."""
    current = unit.normal_speed
    if not current > 0.0:
        return None
    position = settings.release_position
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
        "plateau_tension": math.nan,
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
                "impact_tension": ("impact_model", [item.tension for item in models]),
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


def _snap(snap: Snap, impact: Impact) -> xr.Dataset:
    """Return the snap with its pictures: a slack curtain is drawn as the taut one made flatter."""
    import xarray as xr

    from moyai.curtain.frames import frame_times, plan_frames

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
        "peak_tension": snap.peak_tension,
        "plateau_tension": snap.plateau_tension,
        "impact_tension": snap.impact_tension,
    }
    return labelled(xr.Dataset(data, coords={"time": motion.time[keep]}, attrs=attrs))


def _around_spike(time: Array, taut: float, peak: float) -> NDArray[np.int64]:
    """Return indices that keep every step about the spike and thin out the rest."""
    near = (time > taut - 0.5 * (peak - taut)) & (time < taut + 8.0 * (peak - taut))
    every = np.arange(0, time.size, max(1, time.size // _MOST_POINTS))
    inside = np.flatnonzero(near)
    inside = inside[:: max(1, inside.size // _MOST_POINTS)]
    return np.unique(np.concatenate([every, inside]))


def impact_notices(unit: LevelCurtain, settings: ImpactSettings, answer: ImpactAnswer) -> tuple[Notice, ...]:
    """Return where the models leave their range, and what was left out for want of data."""
    notices = [*answer.comparison.notices]
    if settings.time_step is not None:
        rise = peak_by_energy(answer.impact).time
        notices += march_impact(answer.impact, time_step=settings.time_step, duration=1.6 * rise).notices
    if unit.curtain.lower_stiffness == 0.0:
        notices.append(
            Notice(
                "impact-no-lower-cable",
                "there is no lower cable: the rigid skirt of model A hangs on the upper cable alone, the lower edge of "
                "model A2 swings free",
                severity="information",
                source="model A2",
            )
        )
    if math.isnan(answer.half_angle):
        notices.append(
            Notice(
                "impact-no-arc",
                "models B and AB and the tension of the skirt need 'settings.impact.chord' and a skirt that stretches",
                severity="information",
                remedy="give the straight distance of the skirt's edges when it becomes taut, and its stiffness",
            )
        )
    if settings.draught is None and unit.curtain.skirt.length > _DEEPEST * unit.water.depth:
        notices.append(
            Notice(
                "impact-on-bed",
                f"the impact models end the skirt {(1.0 - _DEEPEST) * unit.water.depth:.3g} m above the bed",
                severity="information",
            )
        )
    return tuple(notices)


def impact_checks(unit: LevelCurtain, answer: ImpactAnswer) -> tuple[IdentityCheck, ...]:
    """Return the identities of the impact: energy of model A and of A2, share of the plate's mass."""
    impact = answer.impact
    peak = peak_by_energy(impact)
    work = _work(impact, peak.displacement)
    kinetic = 0.5 * impact.deep_mass * impact.speed**2
    fine = march_impact(impact, time_step=peak.time / 2000.0, duration=1.2 * peak.time).peak.tension
    coarse = march_impact(impact, time_step=peak.time / 1000.0, duration=1.2 * peak.time).peak.tension
    return (
        IdentityCheck(
            f"{unit.name}: energy of model A", abs(work / kinetic - 1.0), 1e-8, "work of the cables = m U^2/2"
        ),
        IdentityCheck(
            f"{unit.name}: energy of model A2", answer.edges.energy_error, 1e-6, "kinetic energy + work = m U^2/2"
        ),
        IdentityCheck(
            f"{unit.name}: marching without a step is model A",
            abs((2.0 * fine - coarse) / peak.tension - 1.0),
            1e-4,
            "first-order extrapolation of the marched peak = energy form",
        ),
    )


def _work(impact: Impact, displacement: float) -> float:
    """Integrate the load of the cables over a displacement [N], by itself, not by the solver's own sum."""
    taut = taut_shape(impact.span_ratio)
    nodes, weights = np.polynomial.legendre.leggauss(80)
    places = 0.5 * displacement * (nodes + 1.0)

    def load(x: float) -> float:
        return spring(x, impact.span, impact.span_ratio, taut, impact.stiffness)[0]

    return float(0.5 * displacement * sum(w * load(x) for x, w in zip(places, weights)))
