"""From the seas of a case to wave components along the plane of motion."""

from __future__ import annotations

import math
from dataclasses import dataclass

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.validity import Notice
from moyai.sea.components import WaveComponents
from moyai.sea.dispersion import wave_number_in_current
from moyai.sea.irregular import components_of_run
from moyai.sea.permanent_wave import NonlinearWave
from moyai.sea.regular_theory import RegularTheory, linear_limit, regular_wave
from moyai.sea.water import Water
from moyai.structures.cage.rigid.model import CageSea, RigidCageProblem, RigidCageWaves

#: Components of equal energy that stand for an irregular sea; it never repeats itself
COMPONENTS = 200


@dataclass(frozen=True, eq=False)
class RigidCageWave:
    """One wave or irregular sea, ready to be run."""

    name: str
    components: WaveComponents
    #: H and T, or significant height and peak period [m].
    height: float
    #: H and T, or significant height and peak period [s].
    period: float
    #: Of that period [m].
    wavelength: float
    #: [s].
    duration: float
    regular: bool
    #: Of the phases of an irregular sea.
    seed: int | None = None
    #: Motion of the water where a regular wave is not linear; the components are then its elevation.
    steep: NonlinearWave | None = None

    @property
    def theory(self) -> str:
        """In words."""
        return "linear waves" if self.steep is None else "stream function"


def current_along(problem: RigidCageProblem, water: Water) -> float:
    """Return the current along x averaged over the depth (at the surface of infinite depth) [m/s]."""
    if problem.environment.current is None:
        return 0.0
    profile = problem.environment.current.in_depth(water.depth)
    found = profile.velocity(0.0) if math.isinf(water.depth) else profile.depth_mean(-water.depth, 0.0)
    if abs(float(found[1])) > 1e-9 * max(abs(float(found[0])), 1e-300):
        raise InputError(
            "the current does not flow along x",
            parameter="current.heading",
            allowed="0 or 180 degrees: the rigid cage moves in one plane",
            remedy="turn the x axis, or use 'model: flexible'",
        )
    return float(found[0])


def waves_of(problem: RigidCageProblem, sea: CageSea, water: Water) -> tuple[RigidCageWave, ...]:
    """Return every wave of a sea state at a water depth."""
    flow = current_along(problem, water)
    sense = 1.0 if math.cos(sea.heading) > 0.0 else -1.0
    if isinstance(sea, RigidCageWaves):
        return tuple(
            wave_of("linear", height, period, sea.heading, water, flow * sense, problem.settings.periods)
            for height, period in sea.waves()
        )
    period = float(sea.spectrum.peak_period)
    parts = components_of_run(sea, water, (flow, 0.0), COMPONENTS)
    number = float(wave_number_in_current(2.0 * math.pi / period, water.depth, water.gravity, flow * sense))
    height = float(sea.spectrum.significant_height)
    return (RigidCageWave("sea", parts, height, period, 2.0 * math.pi / number, sea.duration, False, sea.seed),)


@checks_words
def wave_of(
    theory: RegularTheory,
    height: float,
    period: float,
    heading: float,
    water: Water,
    current_along_wave: float,
    periods: int,
) -> RigidCageWave:
    """Return a regular wave whose crest passes the middle of the cage at t = 0."""
    parts, steep = regular_wave(theory, height, period, heading, water, current_along_wave)
    name, length = f"H {height:.4g} m, T {period:.4g} s", 2.0 * math.pi / float(parts.wave_number[0])
    return RigidCageWave(name, parts, height, period, length, periods * period, True, steep=steep)


def theory_limit(wave: RigidCageWave, remedy: str) -> list[Notice]:
    """Say when a regular wave is run as a linear one beyond the range of that theory."""
    if wave.steep is not None:
        return list(wave.steep.notices())
    if not wave.regular:
        return []
    return linear_limit(wave.name, wave.components, remedy)
