"""The dynamic analysis of a curtain case: every sea state, or the snap in the current alone, on the whole span."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress
from moyai.core.validity import IdentityCheck, Notice
from moyai.curtain.analysis_impact import drag_coefficient, impact_of
from moyai.curtain.assembly import LevelCurtain
from moyai.curtain.dynamic import DynamicRun, DynamicSettings, Sensitivity, run_checks, run_span, span_sensitivity
from moyai.curtain.dynamic_model import AnchoredSupport, CurtainSpan, Mesh
from moyai.curtain.impact import Impact, edge_impact, peak_by_energy
from moyai.curtain.model import Settings
from moyai.curtain.variables import labelled
from moyai.flexible.flow import Flow
from moyai.flexible.sheets import sheet_stress
from moyai.sea.components import WaveComponents
from moyai.sea.current import CurrentProfile
from moyai.sea.dispersion import wave_number_in_current
from moyai.sea.states import IrregularSea, RegularSea, SeaState

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

#: Rows in a period and in the rise of model A, frames kept for the moving picture, components of an irregular sea.
_ROWS_OF_A_PERIOD, _ROWS_OF_A_RISE, _FRAMES, _COMPONENTS = 400, 150, 240, 120
_RISES = 4.0
#: Over the skirt's length, to either side of a section: what waves fold more finely than this turns no added mass.
_NORMAL_REACH = 1.0 / 3.0


@dataclass(frozen=True)
class DynamicAnswer:
    """Groups of one run, what must be told, its checks, and whether the user stopped it."""

    groups: dict[str, xr.Dataset]
    checks: tuple[IdentityCheck, ...]
    notices: tuple[Notice, ...]
    interrupted: bool = False


@dataclass(frozen=True, eq=False)
class _Across:
    """A current in the axes of the span, asked at any height."""

    profile: CurrentProfile
    normal: float
    depth: float

    def velocity(self, z: ArrayLike) -> Array:
        """Return the velocity (..., 2) downstream and along the span."""
        given = np.asarray(self.profile.velocity(np.clip(z, -self.depth, 0.0)))
        c, s = math.cos(self.normal), math.sin(self.normal)
        return np.stack([c * given[..., 0] + s * given[..., 1], c * given[..., 1] - s * given[..., 0]], axis=-1)


@dataclass(frozen=True)
class _Plan:
    name: str
    arguments: dict[str, Any]
    period: float


def span_of(unit: LevelCurtain, settings: DynamicSettings) -> CurtainSpan:
    """Return the span of a level for dynamics.

    Raises
    ------
    InputError
        For what the case does not say: the stretch of skirt or cables, masses, the buoys of anchored supports.
    """
    curtain, water = unit.curtain, unit.water
    skirt, g = curtain.skirt, water.gravity
    if math.isinf(skirt.stiffness):
        raise InputError(
            "the skirt does not stretch: dynamics needs its stiffness",
            path="structure.skirt.stiffness",
            allowed="a stiffness",
        )
    if settings.sheet_mass is None:
        raise InputError(
            "the mass of the sheet is not known",
            path="settings.dynamic.sheet_mass",
            remedy="give it, or 'mass_per_area' with 'sheet_density' or 'film' in 'structure.skirt'",
        )
    volume = settings.sheet_volume
    if math.isnan(volume):
        volume = (settings.sheet_mass - skirt.submerged_weight / g) / water.density
    if volume < 0.0:
        raise InputError(
            f"a sheet of {settings.sheet_mass:g} kg/m2 cannot weigh {skirt.submerged_weight:g} N/m2 under water",
            path="settings.dynamic.sheet_mass",
            allowed=f"at least {skirt.submerged_weight / g:.4g} kg/m2",
        )
    if not settings.ballast_density > water.density:
        raise InputError(
            f"ballast of {settings.ballast_density:g} kg/m3 floats",
            path="settings.dynamic.ballast_density",
            allowed=f"more than {water.density:g} kg/m3",
        )
    ballast = skirt.toe_load / g / (1.0 - water.density / settings.ballast_density)
    lift = curtain.floats.buoyancy / (water.density * g)
    height = settings.float_height if settings.float_height is not None else math.sqrt(4.0 * lift / math.pi)
    if curtain.floats.weight <= 0.0:
        raise InputError(
            "floats and top cable have no weight: dynamics needs their mass",
            path="structure.floats.weight",
            allowed="greater than 0",
        )
    held = curtain.toe == "held"
    return CurtainSpan(
        span=curtain.span,
        length=curtain.length,
        skirt_length=skirt.length,
        chord=skirt.length,
        upper_stiffness=curtain.upper_stiffness,
        lower_stiffness=curtain.lower_stiffness,
        upper_mass=curtain.floats.weight / g,
        lower_mass=ballast,
        sheet_stiffness=skirt.stiffness,
        sheet_mass=settings.sheet_mass,
        lower_volume=ballast / settings.ballast_density,
        span_stiffness=settings.span_stiffness,
        shear_stiffness=settings.shear_stiffness,
        sheet_volume=volume,
        drag_coefficient=drag_coefficient(unit, unit.depth),
        float_volume=lift,
        float_height=height,
        edges="risen" if held else "free",
        support=_support(unit, settings),
    )


def _support(unit: LevelCurtain, settings: DynamicSettings) -> AnchoredSupport | None:
    anchors = unit.curtain.anchors
    if anchors is None:
        return None
    if settings.support_mass is None:
        raise InputError(
            "the buoys of anchored supports need their mass",
            path="settings.dynamic.support_mass",
            remedy="give the mass of one buoy with its added mass, or leave 'structure.anchors' out for fixed supports",
        )
    if not math.isfinite(anchors.stiffness):
        raise InputError(
            "the stiffness of the anchor lines is not known", path="structure.anchors", remedy="give 'axial_stiffness'"
        )
    pretension = anchors.pretension
    return AnchoredSupport(
        anchors.length,
        anchors.slope_in(unit.water.depth),
        anchors.stiffness * anchors.length,
        0.0 if pretension is None else pretension,
        settings.support_mass,
    )


def dynamic_answer(
    unit: LevelCurtain, settings: Settings, seas: tuple[SeaState, ...], progress: Progress
) -> DynamicAnswer:
    """Run the span of a level through every sea state, or through the snap in its current.

    Raises
    ------
    InputError
        As :func:`span_of`, and where there is neither a sea nor a current.
    """
    import xarray as xr

    given = settings.dynamic
    assert given is not None
    span = span_of(unit, given)
    groups: dict[str, xr.Dataset] = {}
    checks: list[IdentityCheck] = []
    notices: list[Notice] = []
    rows: list[dict[str, float]] = []
    plans = _plans(unit, settings, seas, span)
    interrupted = False
    for number, plan in enumerate(plans):
        progress(f"dynamic, {plan.name}", number, len(plans))
        place = f"dynamic, {plan.name}"
        run, told = _through(span, given.mesh, plan, bool(seas), progress, place)
        notices.extend(told)
        worth: Sensitivity | None = None
        interrupted = run.history.status == "interrupted"
        if run.history.status == "not_converged":
            notices.append(
                Notice("dynamic-stopped", f"{place}: {run.history.message}", math.nan, math.nan, "error",
                       "take a finer mesh or more viscosity", "guard on the energy of the run")
            )  # fmt: skip
        elif given.sensitivity and not interrupted:
            try:
                worth = span_sensitivity(run, progress=progress, **plan.arguments)
                notices.extend(worth.notices(place))
            except ConvergenceError as error:
                notices.append(Notice("dynamic-sensitivity", f"{place}: {error}", math.nan, math.nan, "warning"))
            except KeyboardInterrupt:
                interrupted = True
        checks.extend(run_checks(run, place))
        data, row = _dataset(run, given, worth, plan)
        groups[plan.name] = data
        groups[f"{plan.name}/frames"] = _frames(run, plan)
        rows.append(row)
        notices.extend(_notices(run, place, unit))
        if interrupted:
            end = float(run.history.time[-1])
            notices.append(
                Notice("dynamic-interrupted", f"{place}: stopped by the user, the run reaches {end:.4g} s of "
                       f"{float(plan.arguments['duration']):.4g} s", math.nan, math.nan, "warning")
            )  # fmt: skip
            break
    else:
        progress("dynamic", len(plans), len(plans))
    table = {key: ("run", [row[key] for row in rows]) for key in rows[0]}
    groups[""] = labelled(xr.Dataset(table, coords={"run": [plan.name for plan in plans[: len(rows)]]}))
    models = _models(unit, settings)
    if models is not None:
        groups[""] = groups[""].merge(models)
    return DynamicAnswer(groups, tuple(checks), tuple(notices), interrupted)


def _through(
    span: CurtainSpan, mesh: Mesh, plan: _Plan, waves: bool, progress: Progress, place: str
) -> tuple[DynamicRun, tuple[Notice, ...]]:
    """Run a plan; in waves with normals that folds of the cloth do not turn, should that fail on added mass alone."""
    if not waves:
        return run_span(span, mesh, progress=progress, **plan.arguments), ()
    smooth = replace(mesh, normal_reach=mesh.normal_reach or _NORMAL_REACH * span.skirt_length)
    run = run_span(span, smooth, progress=progress, **plan.arguments)
    if run.history.status != "not_converged" or not smooth.convective:
        return run, ()
    plain = run_span(span, replace(smooth, convective=False), progress=progress, **plan.arguments)
    if plain.history.status == "not_converged":
        return run, ()
    told = Notice(
        "dynamic-turning",
        f"{place}: with all forces of turning sections the run {run.history.message}; they are left out, which changed "
        "peaks by up to a sixth where both ran",
        math.nan, math.nan, "warning", "take a finer mesh", "guard on the energy of the run",
    )  # fmt: skip
    return plain, (told,)


def _models(unit: LevelCurtain, settings: Settings) -> xr.Dataset | None:
    """Return the peaks of models A and A2 at the start speed, to hold the dynamic peak against."""
    import xarray as xr

    speed = settings.impact.start_speed or unit.normal_speed
    if not speed > 0.0 or unit.curtain.length <= unit.curtain.span:
        return None
    impact = impact_of(unit, settings.impact, speed)
    names = ["A", "A2"]
    peaks = [peak_by_energy(impact).tension, edge_impact(impact, finite_depth=True).simultaneous_peak]
    return labelled(xr.Dataset({"dynamic_model_tension": ("dynamic_model", peaks)}, coords={"dynamic_model": names}))


def _plans(unit: LevelCurtain, settings: Settings, seas: tuple[SeaState, ...], span: CurtainSpan) -> list[_Plan]:
    given = settings.dynamic
    assert given is not None
    profile = unit.site.current(unit.surface_speed) if unit.surface_speed > 0.0 else None
    current = None if profile is None else _Across(profile, unit.curtain.normal, float(unit.water.depth))
    common = {"water": unit.water, "profile": given.profile}
    if not seas:
        return [_snap_plan(unit, settings, span, current, common)]
    found: list[_Plan] = []
    for sea in seas:
        if isinstance(sea, RegularSea):
            many = len(sea.periods) > 1
            for period in sea.periods:
                name = f"{sea.name}, T {period:g} s" if many else sea.name
                waves = _regular(unit, sea, period)
                last = (1 + given.settled_periods + given.analysed_periods) * period
                found.append(_wave_plan(name, waves, current, period, last, given, unit, common))
        else:
            period = float(sea.spectrum.peak_period)
            waves = _window(unit, sea, given.wave_count * period)
            last = given.wave_count * period + period
            found.append(_wave_plan(sea.name, waves, current, period, last, given, unit, common))
    return found


def _snap_plan(
    unit: LevelCurtain, settings: Settings, span: CurtainSpan, current: _Across | None, common: dict[str, Any]
) -> _Plan:
    """Return the run of the snap alone: just taut at the start speed, in the current where there is one."""
    given = settings.dynamic
    assert given is not None
    speed = settings.impact.start_speed or unit.normal_speed
    if not speed > 0.0:
        raise InputError(
            "the analysis 'dynamic' needs waves, a current along the normal, or a start speed",
            path="analyses",
            remedy="give 'waves', 'current', or 'settings.impact.start_speed'",
        )
    lower = span.lower_stiffness if span.lower_stiffness > 0.0 else 1e-6 * span.upper_stiffness
    draught = min(span.skirt_length, 0.98 * unit.water.depth)
    rise = peak_by_energy(Impact(span.span, span.length, draught, span.upper_stiffness, lower, speed, unit.water)).time
    duration = _RISES * rise if given.duration is None else given.duration
    start = 0.0 if given.start == "at_rest" else speed
    return _Plan(
        "snap in the current" if current is not None else "snap",
        {
            **common, "flow": Flow(current=current), "duration": duration, "output_step": rise / _ROWS_OF_A_RISE,
            "speed": start,
        },
        rise,
    )  # fmt: skip


def _wave_plan(
    name: str, waves: WaveComponents, current: _Across | None, period: float, last: float, given: DynamicSettings,
    unit: LevelCurtain, common: dict[str, Any],
) -> _Plan:  # fmt: skip
    drifting = given.start == "drifting"
    flow = Flow(current=current, waves=waves, ramp=0.0 if drifting else period, wave_ramp=period if drifting else 0.0)
    return _Plan(
        name,
        {
            **common, "flow": flow, "duration": last, "output_step": period / _ROWS_OF_A_PERIOD,
            "speed": unit.normal_speed if drifting else 0.0,
            "from_time": min(1 + given.settled_periods, last / period - 1.0) * period,
        },
        period,
    )  # fmt: skip


def _carried(unit: LevelCurtain) -> tuple[float, float]:
    if unit.surface_speed <= 0.0:
        return 0.0, 0.0
    profile = unit.site.current(unit.surface_speed)
    found = profile.velocity(0.0) if math.isinf(unit.water.depth) else profile.depth_mean(-unit.water.depth, 0.0)
    return float(found[0]), float(found[1])


def _regular(unit: LevelCurtain, sea: RegularSea, period: float) -> WaveComponents:
    omega, water = 2.0 * math.pi / period, unit.water
    u, v = _carried(unit)
    along = u * math.cos(sea.heading) + v * math.sin(sea.heading)
    number = float(wave_number_in_current(omega, water.depth, water.gravity, along))
    return WaveComponents(
        np.array([omega]), np.array([0.5 * sea.height]), np.zeros(1), np.array([sea.heading - unit.curtain.normal]),
        np.array([number]), water, np.array([omega - number * along]),
    )  # fmt: skip


def _window(unit: LevelCurtain, sea: IrregularSea, length: float) -> WaveComponents:
    """Return the sea with its clock set so that the highest crest stands in the middle of a window [s]."""
    from moyai.sea.irregular import synthesise

    waves = synthesise(
        sea.spectrum, unit.water, duration=sea.duration, seed=sea.seed, method="equal_energy", count=_COMPONENTS,
        heading=sea.heading, spreading=sea.spreading, current=_carried(unit),
    )  # fmt: skip
    time = np.arange(0.0, sea.duration, float(sea.spectrum.peak_period) / 40.0)
    crest = float(time[int(np.argmax(waves.elevation(time)))])
    begin = crest - 0.6 * length
    return replace(
        waves,
        phase=np.asarray(waves.phase) - np.asarray(waves.omega) * begin,
        heading=np.asarray(waves.heading) - unit.curtain.normal,
        frequency_step=None,
    )


def _dataset(
    run: DynamicRun, settings: DynamicSettings, worth: Sensitivity | None, plan: _Plan
) -> tuple[xr.Dataset, dict[str, float]]:
    import xarray as xr

    history = run.history
    names = [n for n in ("upper cable", "lower cable", *run.built.lines) if run.built.bars(n).size]
    peaks = np.stack([run.tension(name) for name in names])
    data: dict[str, Any] = {
        "tension_peak": (("line", "time"), peaks),
        "both_tension": ("time", run.both),
        "kinetic_energy": ("time", history.kinetic_energy),
        "elastic_energy": ("time", history.elastic_energy),
        "energy_balance": ("time", history.energy_balance),
    }
    middle = run.built.grid[run.built.mesh.along // 2]
    data["mid_span_x"] = ("time", history.position[:, middle[0], 0])
    data["mid_toe_x"] = ("time", history.position[:, middle[-1], 0])
    data["mid_toe_z"] = ("time", history.position[:, middle[-1], 2])
    highest = [run.peak(name) for name in names]
    data["line_peak"] = ("line", [value for value, _ in highest])
    data["line_peak_time"] = ("line", [when for _, when in highest])
    stats = [run.snaps(name, settings.slack_level, settings.threshold) for name in names]
    length = max(float(history.time[-1] - run.from_time), 1e-300)
    data["slack_share"] = ("line", [record.slack_time / length for record in stats])
    data["line_contacts"] = ("line", [len(record.contacts) for record in stats])
    data["line_snaps"] = ("line", [len(record.snaps) for record in stats])
    data["slack_level"] = ("line", [record.slack_level for record in stats])
    data["snap_threshold"] = ("line", [record.threshold for record in stats])
    rises = [[c.rise_time for c in record.snaps] for record in stats]
    data["snap_rise_time"] = ("line", [float(np.median(r)) if r else math.nan for r in rises])
    both, when = run.peak("both")
    row = int(np.argmin(np.abs(history.time - when)))
    near = np.arange(max(0, row - 100), min(history.time.size, row + 101))
    rows = np.unique(np.concatenate([near, np.linspace(0, history.time.size - 1, 200).astype(int)]))
    skirt = float(np.max(run.skirt_tension(rows)))
    summary = {
        "both_peak": both, "both_peak_time": when, "upper_peak": highest[0][0],
        "lower_peak": run.peak("lower cable")[0] if "lower cable" in names else 0.0,
        "anchor_peak": max(
            (value for (value, _), name in zip(highest, names, strict=True) if name.startswith("anchor")),
            default=math.nan,
        ),
        "skirt_peak": skirt,
        "half_step_peak": worth.half_step if worth else math.nan,
        "half_mesh_peak": worth.half_mesh if worth else math.nan,
        "double_viscosity_peak": worth.double_viscosity if worth else math.nan,
        "extrapolated_peak": worth.extrapolated if worth else math.nan,
    }  # fmt: skip
    attributes = {
        "status": history.status, "time_step": history.step, "steps": history.steps, "counted_from": run.from_time,
        "period": plan.period, "cells_along": run.built.mesh.along, "cells_down": run.built.mesh.down,
    }  # fmt: skip
    return labelled(xr.Dataset(data, coords={"time": history.time, "line": names}, attrs=attributes)), summary


def _frames(run: DynamicRun, plan: _Plan) -> xr.Dataset:
    """Return what a moving picture needs: places, tensions and skirt stresses at a few hundred moments."""
    import xarray as xr

    history, network = run.history, run.built.network
    size = history.time.size
    when = run.peak("both")[1]
    rows = np.unique(np.concatenate([np.linspace(0, size - 1, _FRAMES).astype(int),
                                     [int(np.argmin(np.abs(history.time - when)))]]))  # fmt: skip
    sheets = network.sheets
    assert sheets is not None
    # what keeps columns of the skirt in order belongs to no cable and is not shown
    shown = np.concatenate([strand.bars for strand in network.strands])
    stress = np.stack([sheet_stress(sheets, history.position[row]).first for row in rows])
    data: dict[str, Any] = {
        "node_position": (("frame", "node", "axis"), history.position[rows].astype(np.float32)),
        "bar_tension": (("frame", "bar"), history.tension[rows][:, shown].astype(np.float32)),
        "triangle_tension": (("frame", "triangle"), stress.astype(np.float32)),
        "bar_nodes": (("bar", "end"), np.stack([network.bars.start, network.bars.end], axis=1)[shown]),
        "triangle_nodes": (("triangle", "corner"), sheets.triangles),
    }
    waves = run.flow.waves
    if waves is not None:
        for key in ("amplitude", "omega", "wave_number", "heading", "phase"):
            data[f"wave_{key}"] = ("component", np.asarray(getattr(waves, key)))
    names = [strand.name for strand in network.strands for _ in strand.bars]
    coords = {"frame_time": ("frame", history.time[rows]), "bar_line": ("bar", names)}
    attributes = {"wave_ramp": max(run.flow.ramp, run.flow.wave_ramp), "peak_time": when}
    return labelled(xr.Dataset(data, coords=coords, attrs=attributes))


def _notices(run: DynamicRun, place: str, unit: LevelCurtain) -> tuple[Notice, ...]:
    """Tell where the model leaves its range: a risen toe, waves made in a slow rise."""
    history, grid = run.history, run.built.grid
    found: list[Notice] = []
    first = history.position[0, grid[:, 0], 2] - history.position[0, grid[:, -1], 2]
    reach = history.position[:, grid[:, 0], 2] - history.position[:, grid[:, -1], 2]
    left = float(np.min(reach / first[None, :]))
    if left < 0.8:
        found.append(
            Notice(
                "dynamic-risen-toe",
                f"{place}: the toe rises until {100.0 * left:.0f} % of the skirt's depth are left; its added mass is "
                "that of the whole depth",
                left,
                0.8,
                "information",
                "take more ballast, or read the peak as high",
                "sections of added mass are those of the skirt that hangs",
            )
        )
    return tuple(found)


__all__ = ["DynamicAnswer", "dynamic_answer", "span_of"]
