"""Runs of a whole span through a snap, waves and current: tensions over time, snaps, and what the peaks are worth."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress, silent
from moyai.core.validity import IdentityCheck, Notice
from moyai.curtain.dynamic_model import MESH_DAMPING, CurtainNetwork, CurtainSpan, Mesh, build_span
from moyai.flexible.flow import Flow
from moyai.flexible.result import History
from moyai.flexible.sheets import sheet_stress
from moyai.flexible.simulate import simulate
from moyai.flexible.snap import SnapRecord, find_snaps
from moyai.sea.water import Water

Array = NDArray[np.float64]

#: Rows of a result, at most.
MOST_ROWS = 20000
#: Part of the energy of a span that viscosity may take in a period: a snap loses some per cent, crumpling much more.
MOST_VISCOUS = 0.3
#: Slack level and threshold of a snap where none is given, over the highest tension and the mean of what is taut.
_SLACK_SHARE, _SNAP_FACTOR = 0.01, 2.0


@dataclass(frozen=True)
class DynamicSettings:
    """How the dynamic analysis of a case is run.

    Parameters
    ----------
    mesh : Mesh
    sheet_mass : float or None
        Mass per area of the sheet [kg/m2]; None: as the case gives it elsewhere.
    sheet_volume : float
        Displaced volume per area [m]; NaN: from mass and weight in water.
    span_stiffness, shear_stiffness : float
        Of the sheet along the span and in shear [N/m].
    ballast_density : float
        Of lower cable and ballast [kg/m3].
    float_height : float or None
        [m]; None: of a round float with the buoyancy given.
    support_mass : float or None
        Of a buoy at a support with its added mass [kg]; needed with anchors.
    profile : {"uniform", "sag"}
        Speed of a drifting start over the span.
    settled_periods, analysed_periods : int
        Of regular waves.
    wave_count : int
        Peak periods run around the highest crest of an irregular sea.
    duration : float or None
        Of the run in a current alone [s]; None: four rises of model A.
    start : {"auto", "at_rest", "drifting"}
        Curtain at rest in water that begins to move, or drifting and just taut; auto: at rest in waves.
    sensitivity : bool
        Whether runs with half the step, a mesh of half as many cells and twice the viscosity follow.
    slack_level, threshold : float or None
        Of the snap statistics [N]; None: 1 % of the highest tension, twice the mean of the taut times.
    """

    mesh: Mesh
    sheet_mass: float | None = None
    sheet_volume: float = math.nan
    span_stiffness: float = 0.0
    shear_stiffness: float = 0.0
    ballast_density: float = 7850.0
    float_height: float | None = None
    support_mass: float | None = None
    profile: Literal["uniform", "sag"] = "uniform"
    settled_periods: int = 1
    analysed_periods: int = 3
    wave_count: int = 8
    duration: float | None = None
    start: Literal["auto", "at_rest", "drifting"] = "auto"
    sensitivity: bool = True
    slack_level: float | None = None
    threshold: float | None = None


@dataclass(frozen=True, eq=False)
class DynamicRun:
    """One run of a span.

    Parameters
    ----------
    built : CurtainNetwork
    history : History
    flow : Flow
    from_time : float
        Peaks before this are not counted [s].
    """

    built: CurtainNetwork
    history: History
    flow: Flow
    from_time: float = 0.0

    @property
    def counted(self) -> NDArray[np.bool_]:
        """Rows that count."""
        late = np.asarray(self.history.time >= self.from_time - 1e-12)
        # a run that stopped early counts whole, so that what it found can be seen
        return late if np.count_nonzero(late) > 2 else np.ones_like(late)

    def tension(self, name: str) -> Array:
        """Return the highest tension of a cable over the span, or of an anchor line, since the row before [N].

        Anchor lines carry two spans by halves: what is returned is that of the whole line.
        """
        bars = self.built.bars(name)
        if bars.size == 0:
            return np.zeros(self.history.time.size)
        factor = 2.0 if name.startswith("anchor line") else 1.0
        return np.asarray(factor * self.history.tension_peak[:, bars].max(axis=1))

    @property
    def both(self) -> Array:
        """Sum of the highest tensions of both cables [N]."""
        return self.tension("upper cable") + self.tension("lower cable")

    def peak(self, name: str) -> tuple[float, float]:
        """Return the highest tension that counts [N] and when [s]; ``both`` for the sum of the cables."""
        values = np.where(self.counted, self.both if name == "both" else self.tension(name), -1.0)
        row = int(np.argmax(values))
        return float(values[row]), float(self.history.time[row])

    def skirt_tension(self, rows: NDArray[np.int64] | None = None) -> Array:
        """Return the highest principal tension of the skirt at rows [N/m]."""
        sheets = self.built.network.sheets
        assert sheets is not None
        chosen = np.arange(self.history.time.size) if rows is None else rows
        return np.array([float(sheet_stress(sheets, self.history.position[row]).first.max()) for row in chosen])

    def snaps(self, name: str, slack_level: float | None, threshold: float | None) -> SnapRecord:
        """Return slack times and snaps of a cable or line at its support."""
        bars = self.built.bars(name)
        factor = 2.0 if name.startswith("anchor line") else 1.0
        rows = self.counted
        pull = factor * self.history.tension[rows][:, bars[0]]
        peaks = factor * self.history.tension_peak[rows][:, bars[0]]
        level = _SLACK_SHARE * float(peaks.max()) if slack_level is None else slack_level
        taut = pull[pull > level]
        limit = _SNAP_FACTOR * float(taut.mean()) if threshold is None and taut.size else threshold or level
        return find_snaps(self.history.time[rows], pull, slack_level=level, threshold=max(limit, level), peaks=peaks)


@dataclass(frozen=True)
class Sensitivity:
    """What the peak of both cables together becomes with another step, mesh or viscosity [N].

    Parameters
    ----------
    peak : float
        Of the run itself.
    half_step, half_mesh, double_viscosity : float
        With half the step, half as many cells both ways, twice the viscosity of cables and skirt.
    """

    peak: float
    half_step: float
    half_mesh: float
    double_viscosity: float

    @property
    def extrapolated(self) -> float:
        """Value that the two meshes point to when the error falls with the size of the cells [N]."""
        return 2.0 * self.peak - self.half_mesh

    @property
    def mesh_error(self) -> float:
        """Change from the mesh used to the extrapolated value, over the peak [-]."""
        return abs(self.extrapolated / self.peak - 1.0)

    def notices(self, place: str, limit: float = 0.05) -> tuple[Notice, ...]:
        """Tell when a peak is worth less than it looks."""
        worst = max(self.mesh_error, abs(self.half_step / self.peak - 1.0))
        if worst <= limit:
            return ()
        return (
            Notice(
                "dynamic-peak-mesh",
                f"{place}: the peak of both cables, {self.peak:.4g} N, moves by {100.0 * worst:.1f} % "
                "with step and mesh",
                worst,
                limit,
                "warning",
                "take more cells (settings.dynamic.cells_along, cells_down)",
                "runs with half the step and with half as many cells",
            ),
        )


def run_span(
    span: CurtainSpan,
    mesh: Mesh,
    water: Water,
    *,
    flow: Flow | None = None,
    duration: float,
    output_step: float,
    speed: float = 0.0,
    profile: Literal["uniform", "sag"] = "uniform",
    weight: bool = True,
    deep: bool = False,
    from_time: float = 0.0,
    step: float | None = None,
    progress: Progress = silent,
) -> DynamicRun:
    """Run a span through time.

    Parameters
    ----------
    span, mesh, water
        As :func:`moyai.curtain.dynamic_model.build_span`, with ``speed``, ``profile``, ``weight`` and ``deep``.
    flow : Flow, optional
        Motion of the water in the axes of the span; still water when left out.
    duration, output_step : float
        [s].
    from_time : float
        Peaks before this are not counted [s].
    step : float, optional
        Time step [s]; chosen by the program when left out.

    Returns
    -------
    DynamicRun
        Its history has the status ``not_converged`` where the run had to stop.
    """
    built = build_span(span, mesh, water, speed=speed, profile=profile, weight=weight, deep=deep)
    chosen = flow or Flow()
    rows = min(MOST_ROWS, max(2, round(duration / output_step)))
    history = simulate(
        built.network, duration=duration, output_step=duration / rows, flow=chosen, start=built.state, step=step,
        progress=progress,
    )  # fmt: skip
    return DynamicRun(built, history, chosen, from_time)


def span_sensitivity(run: DynamicRun, **arguments: object) -> Sensitivity:
    """Run a span again with half the step, half the cells and twice the viscosity.

    Parameters
    ----------
    run : DynamicRun
        The run itself.
    **arguments
        ``water`` and the further arguments of :func:`run_span` with which it was made.

    Raises
    ------
    ConvergenceError
        When one of the runs had to stop.
    KeyboardInterrupt
        When the user stopped one.
    """
    built, history = run.built, run.history
    mesh = built.mesh
    cable, sheets = built.network.bars.types[0].viscosity, built.network.sheets
    assert sheets is not None
    skirt = float(np.max(sheets.damping_time))
    # the same viscosity on every mesh: it belongs to the material, not to the cells
    same = replace(mesh, cable_viscosity=cable, skirt_damping_time=skirt)

    def peak(which: str, trial: Mesh, step: float | None = None) -> float:
        found = run_span(built.span, trial, **{**arguments, "step": step})  # type: ignore[arg-type]
        if found.history.status == "interrupted":
            raise KeyboardInterrupt
        if found.history.status != "converged":
            raise ConvergenceError(f"run with {which}: {found.history.message}", path="sensitivity")
        return found.peak("both")[0]

    coarse = replace(same, along=max(4, mesh.along // 2), down=max(2, mesh.down // 2))
    viscous = replace(mesh, cable_viscosity=2.0 * cable, skirt_damping_time=2.0 * skirt)
    return Sensitivity(
        run.peak("both")[0],
        peak("half the step", mesh, 0.5 * history.step),
        peak("half the cells", coarse),
        peak("twice the viscosity", viscous),
    )


def run_checks(run: DynamicRun, place: str) -> tuple[IdentityCheck, ...]:
    """Return the energy checks of a run: what came from nowhere, and what viscosity had to take.

    The second finds cloth that crumples in the mesh: turning sections then feed it and viscosity eats it, so that the
    sum balances while the peaks are those of the mesh.
    """
    history = run.history
    total = history.kinetic_energy + history.elastic_energy
    stored = max(float(total.max()), 1e-300)
    through = max(stored, float(np.max(np.abs(history.work))))
    gained = float(np.max(history.energy_balance))
    # in every period of waves as much as the span ever holds may pass
    waves = run.flow.waves
    length = float(history.time[-1] - history.time[0])
    passes = 1.0 if waves is None else max(1.0, length * float(np.max(waves.omega)) / (2.0 * math.pi))
    return (
        IdentityCheck(
            f"{place}: energy of the span",
            max(gained, 0.0) / through,
            0.01,
            "energy beyond the work done, over the energy that went through; viscosity can only take",
        ),
        IdentityCheck(
            f"{place}: energy that viscosity took",
            max(-float(np.min(history.energy_balance)), 0.0) / (stored * passes),
            MOST_VISCOUS,
            "over the highest energy of the span and the periods run; more is cloth that crumples in the mesh",
        ),
    )


def require_mesh(along: int, down: int) -> None:
    """Raise InputError for a mesh that the sensitivity runs could not halve."""
    if along < 8 or down < 4:
        raise InputError(
            f"{along} x {down} cells",
            path="settings.dynamic.cells_along",
            allowed="at least 8 along the span and 4 over the skirt",
        )


__all__ = [
    "MESH_DAMPING",
    "DynamicRun",
    "DynamicSettings",
    "Sensitivity",
    "require_mesh",
    "run_checks",
    "run_span",
    "span_sensitivity",
]
