"""Which runs through time a case requires: seas, durations, steps of the results, the water of each."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.flexible.flow import Flow
from moyai.flexible.motion import Motion
from moyai.sea.components import WaveComponents
from moyai.sea.current import CurrentProfile
from moyai.sea.dispersion import wave_number_in_current
from moyai.sea.irregular import components_of_run
from moyai.sea.permanent_wave import NonlinearWave
from moyai.sea.regular_theory import linear_limit, regular_wave
from moyai.sea.states import ComponentSea, IrregularSea, RegularSea
from moyai.sea.water import Water
from moyai.structures.network.model import STILL, NetworkProblem
from moyai.structures.network.start_up import start_up

#: Periods of a run whose length is left to the program, rows in its shortest period, most components of a sea.
PERIODS, ROWS_PER_PERIOD, COMPONENTS = 20, 100, 150


@dataclass(frozen=True, eq=False)
class RunPlan:
    """One run through time."""

    #: Of its group in the results.
    name: str
    flow: Flow
    #: Duration of the run [s].
    duration: float
    #: Step of the output [s].
    output_step: float
    #: That the eye follows: of the waves, else of the motions; NaN without either [s].
    period: float
    waves: WaveComponents | None = None
    #: Of a regular wave, in words.
    theory: str = "linear waves"
    #: H or significant height [m], NaN without waves.
    wave_height: float = math.nan
    #: Of the waves [rad].
    heading: float = math.nan
    irregular: bool = False
    #: -1 without one.
    seed: int = -1
    #: Beginning that peaks and statistics leave out [s].
    skip: float = 0.0
    #: Why so much; empty where all counts.
    skip_rule: str = ""
    #: In which the network is at rest where the run starts; ``None`` as built.
    equilibrium_flow: Flow | None = None
    #: Time over which waves, current and motions grow from nothing [s].
    growth: float = 0.0


@dataclass(frozen=True, eq=False)
class _CurrentAtAnyHeight:
    """A current asked at any height: nodes sink a little into the bed, and profiles end there."""

    profile: CurrentProfile
    depth: float

    def velocity(self, z: ArrayLike) -> NDArray[np.float64]:
        """Return the velocity (..., 2) at heights z, of the nearest end beyond the ends."""
        return np.asarray(self.profile.velocity(np.clip(z, -self.depth, 0.0)))

    @property
    def everywhere(self) -> NDArray[np.float64] | None:
        """The velocity (x, y) that holds at every height [m/s], ``None`` where it varies."""
        return self.profile.everywhere


def steady_flow(problem: NetworkProblem, water: Water) -> Flow:
    """Return the current alone."""
    current = problem.environment.current
    return Flow() if current is None else Flow(current=_CurrentAtAnyHeight(current.in_depth(water.depth), water.depth))


def run_plans(problem: NetworkProblem, water: Water) -> tuple[RunPlan, ...]:
    """Return every run of a water level.

    Raises
    ------
    InputError
        When nothing determines how long a run should be.
    """
    found, start = [], problem.start
    rest = None if start == "as_built" else steady_flow(problem, water) if start == "rest_in_current" else Flow()
    for plan in _plans(problem, water):
        used = [problem.motions[name] for name in _used_motions(problem) if name]
        waves = plan.period if plan.waves is not None else math.nan
        skip, rule = start_up(problem.settings.skip, used, plan.duration, waves)
        grown = [plan.flow.ramp, plan.flow.wave_ramp, *(motion.growth(plan.duration) for motion in used)]
        found.append(replace(plan, skip=skip, skip_rule=rule, equilibrium_flow=rest, growth=max(grown)))
    return tuple(found)


def _plans(problem: NetworkProblem, water: Water) -> tuple[RunPlan, ...]:
    plans: list[RunPlan] = []
    for sea in problem.environment.sea_states:
        if isinstance(sea, RegularSea):
            many = len(sea.periods) > 1
            for period in sea.periods:
                name = f"{sea.name} {period:.4g} s" if many else sea.name
                plans.append(_regular(problem, sea, period, name, water))
        elif isinstance(sea, ComponentSea):
            plans.append(_components(problem, sea, water))
        else:
            plans.append(_irregular(problem, sea, water))
    if plans:
        return tuple(plans)
    periods = [motion.period for motion in problem.motions.values() if math.isfinite(motion.period)]
    ends = [motion.end for motion in problem.motions.values() if math.isfinite(motion.end)]
    duration = problem.settings.duration
    if duration is None:
        if periods:
            duration = min([PERIODS * max(periods), *ends])
        elif ends:
            duration = min(ends)
        elif problem.current_field is not None and problem.current_field.time[-1] > 0.0:
            duration = float(problem.current_field.time[-1])
        else:
            raise InputError(
                "the duration of the run cannot be derived: no waves, no motion with a period",
                parameter="settings.duration",
                remedy="give a duration",
            )
    period = min(periods, default=math.nan)
    moving = problem.environment.current is not None or problem.current_field is not None
    name = "current" if moving else "still water"
    flow = _flow(problem, water, None, period)
    step = _output_step(problem, period, duration)
    return (RunPlan(name, flow, duration, step, period),)


def _flow(
    problem: NetworkProblem, water: Water, waves: WaveComponents | None, period: float,
    steep: NonlinearWave | None = None,
) -> Flow:  # fmt: skip
    ramp = problem.settings.ramp
    if ramp is None:
        ramp = period if waves is not None else 0.0
    flow = replace(
        steady_flow(problem, water), waves=waves, stretching=problem.settings.stretching, steep=steep,
        field=problem.current_field,
    )  # fmt: skip
    if problem.start == "rest_in_current" and waves is not None:
        return replace(flow, wave_ramp=ramp)
    return flow if problem.start == "rest_in_current" else replace(flow, ramp=ramp)


def _output_step(problem: NetworkProblem, period: float, duration: float) -> float:
    if problem.settings.output_step is not None:
        return problem.settings.output_step
    shortest = min(
        [period, *(m.period for m in problem.motions.values())], key=lambda value: value if value > 0.0 else math.inf
    )
    return shortest / ROWS_PER_PERIOD if math.isfinite(shortest) else duration / 1000.0


def _regular(problem: NetworkProblem, sea: RegularSea, period: float, name: str, water: Water) -> RunPlan:
    current = problem.environment.mean_current(water)
    along = current[0] * math.cos(sea.heading) + current[1] * math.sin(sea.heading)
    waves, steep = regular_wave(sea.theory, sea.height, period, sea.heading, water, along)
    duration = problem.settings.duration or PERIODS * period
    return RunPlan(
        name, _flow(problem, water, waves, period, steep), duration, _output_step(problem, period, duration), period,
        waves, "linear waves" if steep is None else "stream function", sea.height, sea.heading,
    )  # fmt: skip


def theory_limit(problem: NetworkProblem, plan: RunPlan) -> list[Notice]:
    """Say when regular waves are run as linear ones beyond the range of that theory."""
    if plan.flow.steep is not None:
        return list(plan.flow.steep.notices())
    if plan.waves is None or plan.irregular:
        return []
    if problem.linear_waves_only:
        # diffraction and radiation are for no steeper waves: as for a breakwater the range is reported
        remedy = "the coefficients of a body answer linear waves: compare with a lower or longer wave"
        return [replace(one, severity="warning") for one in linear_limit(plan.name, plan.waves, remedy)]
    return linear_limit(plan.name, plan.waves, "use 'theory: automatic', which takes the stream function here")


def _irregular(problem: NetworkProblem, sea: IrregularSea, water: Water) -> RunPlan:
    period = float(sea.spectrum.peak_period)
    waves = components_of_run(sea, water, problem.environment.mean_current(water), COMPONENTS)
    # two rows in the shortest wave that counts would miss crests
    step = problem.settings.output_step or _output_step(problem, 0.5 * period, sea.duration)
    return RunPlan(
        sea.name, _flow(problem, water, waves, period), sea.duration, step, period, waves,
        "linear waves", float(sea.spectrum.significant_height), sea.heading, True, sea.seed,
    )  # fmt: skip


def flow_of_seed(problem: NetworkProblem, plan: RunPlan, water: Water, seed: int) -> Flow:
    """Return the water of a run with the same sea from another seed."""
    sea = next(sea for sea in problem.environment.sea_states if sea.name == plan.name)
    if not isinstance(sea, IrregularSea):
        raise TypeError(f"sea {plan.name!r} has no seed")
    waves = components_of_run(replace(sea, seed=seed), water, problem.environment.mean_current(water), COMPONENTS)
    return replace(plan.flow, waves=waves)


def _components(problem: NetworkProblem, sea: ComponentSea, water: Water) -> RunPlan:
    current = problem.environment.mean_current(water)
    along = current[0] * np.cos(sea.headings) + current[1] * np.sin(sea.headings)
    number = np.array(
        [
            float(wave_number_in_current(omega, water.depth, water.gravity, float(drift)))
            for omega, drift in zip(sea.omega, along, strict=True)
        ]
    )
    waves = WaveComponents(sea.omega, sea.amplitude, sea.phase, sea.headings, number, water, sea.omega - number * along)
    period, single = sea.peak_period, sea.omega.size == 1
    duration = problem.settings.duration or sea.duration or PERIODS * period
    step = _output_step(problem, period if single else 0.5 * period, duration)
    return RunPlan(
        sea.name, _flow(problem, water, waves, period), duration, step, period, waves, "linear waves", sea.height,
        sea.heading, not single,
    )  # fmt: skip


def motions_of(problem: NetworkProblem, duration: float) -> dict[str, Motion]:
    """Return the motions of the driven points over a run.

    Raises
    ------
    InputError
        When a table ends before the run does.
    """
    used = _used_motions(problem)
    found = {name: problem.motions[name].over(duration) for name in used if name}
    if "" in used:
        found[STILL] = Motion(0.0, duration, np.zeros((2, 3)), np.zeros((2, 3)))
    return found


def _used_motions(problem: NetworkProblem) -> set[str]:
    """Return the names of the motions that something follows; an empty one for what is held still."""
    used = {point.motion for point in problem.points if point.kind == "driven"}
    used |= {net.motion for net in problem.nets if net.first_row == "driven"}
    return used | {sheet.motion for sheet in problem.sheets if sheet.first_row == "driven"}
