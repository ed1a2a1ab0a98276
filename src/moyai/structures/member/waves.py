"""From the seas of a case to flows: one flow, time grid and period for every wave."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from moyai.core.arrays import Array
from moyai.morison.flow import LinearFlow, NonlinearFlow, PointFlow
from moyai.sea.components import WaveComponents
from moyai.sea.current import CurrentProfile
from moyai.sea.dispersion import wave_number_in_current
from moyai.sea.irregular import synthesise
from moyai.sea.nonlinear import nonlinear_wave
from moyai.sea.permanent_wave import NonlinearWave
from moyai.sea.regular_theory import regular_wave
from moyai.sea.states import IrregularSea
from moyai.sea.water import Water
from moyai.structures.member.model import MemberProblem, MemberWaves

#: Name of the sea, and of what drives the member, where a current runs without waves
CURRENT_ALONE, STEADY = "current", "steady current"


@dataclass(frozen=True, eq=False)
class MemberWave:
    """One wave or irregular sea, ready to be run; a current alone is a regular wave of no height and no period."""

    #: Of its run.
    name: str
    flow: PointFlow
    #: H and T, or significant height and peak period [m].
    height: float
    #: H and T, or significant height and peak period [s].
    period: float
    #: Of that period [1/m].
    wave_number: float
    #: [rad].
    heading: float
    #: Uniform grid [s]; one whole period for regular waves (the last point repeats the first).
    time: Array
    regular: bool
    #: That of the case at the water level of the wave.
    current: CurrentProfile | None = None
    #: In words.
    theory: str = "linear waves"

    @property
    def steady(self) -> bool:
        """Whether it is a current without waves."""
        return self.theory == STEADY


def current_alone(problem: MemberProblem, water: Water) -> MemberWave:
    """Return the current of a case without waves; its two steps of time are alike."""
    current = problem.environment.current
    assert current is not None
    none = np.zeros(1)
    flow = LinearFlow(WaveComponents(np.ones(1), none, none, none, np.ones(1), water), problem.settings.stretching)
    heading = float(np.arctan2(*current.velocity(0.0)[1::-1]))
    return MemberWave(
        CURRENT_ALONE, flow, math.nan, math.nan, math.nan, heading, np.linspace(0.0, 1.0, 3), True,
        current.in_depth(water.depth), STEADY,
    )  # fmt: skip


def waves_of(problem: MemberProblem, sea: MemberWaves | IrregularSea, water: Water) -> tuple[MemberWave, ...]:
    """Return every wave of a sea state at a water depth."""
    current = problem.environment.mean_current(water)
    profile = None if problem.environment.current is None else problem.environment.current.in_depth(water.depth)
    if isinstance(sea, IrregularSea):
        period = float(sea.spectrum.peak_period)
        step = period / problem.settings.irregular_steps
        parts = synthesise(
            sea.spectrum,
            water,
            duration=sea.duration,
            seed=sea.seed,
            heading=sea.heading,
            spreading=sea.spreading,
            time_step=step,
            current=current,
        )
        count = max(2, math.floor(parts.repeat_period / step + 0.5))
        time = np.arange(count + 1) * (parts.repeat_period / count)
        keep = time <= sea.duration * (1.0 + 1e-9)
        flow = LinearFlow(parts, problem.settings.stretching)
        number = _wave_number(period, water, current, sea.heading)
        height = float(sea.spectrum.significant_height)
        grid = np.asarray(time[keep], dtype=np.float64)
        return (MemberWave("sea", flow, height, period, number, sea.heading, grid, False, profile),)
    waves = (_regular(problem, sea, height, period, water, current) for height, period in sea.waves())
    return tuple(replace(wave, current=profile) for wave in waves)


def _wave_number(period: float, water: Water, current: tuple[float, float], heading: float) -> float:
    along = current[0] * math.cos(heading) + current[1] * math.sin(heading)
    return float(wave_number_in_current(2.0 * math.pi / period, water.depth, water.gravity, along))


def _regular(
    problem: MemberProblem, sea: MemberWaves, height: float, period: float, water: Water, current: tuple[float, float]
) -> MemberWave:
    along = current[0] * math.cos(sea.heading) + current[1] * math.sin(sea.heading)
    time: Array = np.linspace(0.0, period, problem.settings.steps_per_period + 1)
    name = f"H {height:.4g} m, T {period:.4g} s"
    if sea.theory == "stokes":
        steep: NonlinearWave | None = nonlinear_wave(
            "stokes", height=height, water=water, period=period, heading=sea.heading, current_along_wave=along
        )
    else:
        parts, steep = regular_wave(sea.theory, height, period, sea.heading, water, along)
    if steep is not None:
        words = {"stokes": "Stokes waves of fifth order", "stream_function": "stream function"}[steep.theory]
        flow: PointFlow = NonlinearFlow(steep)
        return MemberWave(name, flow, height, period, steep.wave_number, sea.heading, time, True, theory=words)
    flow = LinearFlow(parts, problem.settings.stretching)
    return MemberWave(name, flow, height, period, float(parts.wave_number[0]), sea.heading, time, True)
