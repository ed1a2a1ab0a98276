"""Runs of the paper: three members in waves, and particles followed through the flow around the circle."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.progress import Progress, silent
from moyai.morison.circulation import STRENGTHS, settled_circulation
from moyai.records.streaks.contour_circulation import extrapolate_stokes
from moyai.records.streaks.drift_velocity import StreakChain, close_period_cubic
from moyai.records.streaks.flow import OrbitalFlow, SectionMap, circle_map, rectangle_map, track_particles
from moyai.reproduce.inputs import problem_of, run_problem
from moyai.structures.member.model import MemberProblem

if TYPE_CHECKING:
    import xarray as xr

    from moyai.core.results import Result

SECTIONS = ("circle", "square", "rectangle")
FREQUENCY, BREADTH, MODEL_LENGTH, DENSITY = 0.95, 0.045, 0.79, 1000.0
PERIOD, OMEGA = 1.0 / FREQUENCY, 2.0 * math.pi * FREQUENCY
PRINTED = {"circle": 0.19, "square": 0.15, "rectangle": 0.28}
CONTOURS = (1.2, 1.4, 1.6, 2.0, 2.5, 3.0)
STROBE = 9.6  # flashes in a wave period


HEIGHTS = {"square": BREADTH, "rectangle": 0.024}
MAPS: dict[str, Callable[[], SectionMap]] = {
    "circle": lambda: circle_map(BREADTH),
    "square": lambda: rectangle_map(BREADTH, HEIGHTS["square"]),
    "rectangle": lambda: rectangle_map(BREADTH, HEIGHTS["rectangle"]),
}


def speed(number: float) -> float:
    """Return the velocity amplitude [m/s] at a Keulegan-Carpenter number."""
    return number * BREADTH * FREQUENCY


@dataclass(frozen=True)
class AraiRuns:
    """The runs that the figures and statements read."""

    #: By section.
    members: dict[str, Result]
    cases: dict[str, MemberProblem]
    #: Particles on a ring.
    particles: int

    def sweep(self, section: str) -> xr.Dataset:
        """Return the coefficients over KC in circular orbits."""
        data: xr.Dataset = self.members[section].tree["SWL/sweep"].to_dataset()
        return data

    def waves(self, section: str) -> xr.Dataset:
        """Return what the waves of the tank do to a section."""
        data: xr.Dataset = self.members[section].tree["SWL/waves/regular"].to_dataset()
        return data

    def ideal(self, section: str) -> Array:
        """Return the inertia coefficients in ideal fluid, horizontal and vertical."""
        tensor = self.members[section].tree["SWL/member"].to_dataset().ideal_inertia_coefficient.values
        return np.asarray(np.diagonal(tensor))

    def paths(
        self, number: float, ratio: float, count: int, periods: float = 1.0, section: str = "circle"
    ) -> tuple[Array, Array]:
        """Return instants and paths of particles from a ring about a section, with the paper's circulation."""
        v = speed(number)
        circulation = float(settled_circulation(STRENGTHS["arai"], v, v, PERIOD))
        flow = OrbitalFlow(MAPS[section](), PERIOD, v, v, circulation)
        angle = 2.0 * math.pi * np.arange(count) / count
        start = 0.5 * BREADTH * ratio * np.column_stack([np.cos(angle), np.sin(angle)])
        time = np.linspace(0.0, periods * PERIOD, round(200 * periods) + 1)
        return time, track_particles(flow, start, time)

    def contour(self, number: float, ratio: float, section: str = "circle") -> float:
        """Return the circulation [m2/s] of the particles' drift on a ring, clockwise positive."""
        time, path = self.paths(number, ratio, self.particles, section=section)
        middle = np.asarray(np.trapezoid(path, time, axis=1)) / PERIOD
        drift = (path[:, -1] - path[:, 0]) / PERIOD
        return float(2.0 * math.pi * np.mean(drift[:, 0] * middle[:, 1] - drift[:, 1] * middle[:, 0]))

    @cached_property
    def contours(self) -> dict[float, Array]:
        """Circulation [m2/s] over :data:`CONTOURS` by KC."""
        return {number: np.array([self.contour(number, ratio) for ratio in CONTOURS]) for number in (1.0, 1.5)}

    def extrapolated(self, number: float) -> float:
        """Return the circulation [m2/s] found from the contours, the Stokes drift fitted apart."""
        return float(extrapolate_stokes(np.array(CONTOURS), self.contours[number])[0])

    @cached_property
    def interpolation_error(self) -> Array:
        """Miss of the place after a period by the paper's interpolation between flashes [m], by KC 1 and 1.5."""
        worst = []
        for number in (1.0, 1.5):
            time, path = self.paths(number, 2.0, 12, 1.4)
            lit = 0.5 * PERIOD / STROBE
            start = np.asarray(PERIOD / STROBE * np.arange(12), dtype=np.float64)
            end = np.asarray(start + lit, dtype=np.float64)
            misses = []
            for one in path:
                ends = [
                    np.column_stack([np.interp(when, time, one[:, axis]) for axis in (0, 1)]) for when in (start, end)
                ]
                chain = StreakChain(start, end, ends[0], ends[1])
                found = close_period_cubic(chain, PERIOD).velocity
                middle = 0.5 * lit
                true = [
                    np.interp(middle + PERIOD, time, one[:, axis]) - np.interp(middle, time, one[:, axis])
                    for axis in (0, 1)
                ]
                misses.append(float(np.hypot(*(np.asarray(found) * PERIOD - np.array(true)))))
            worst.append(float(np.median(misses)))
        return np.array(worst)


def run(quick: bool = False, progress: Progress = silent) -> AraiRuns:
    """Run everything.

    Parameters
    ----------
    quick : bool
        Fewer particles on a ring.
    progress : Progress
    """
    cases: dict[str, MemberProblem] = {name: problem_of("arai", name) for name in SECTIONS}
    members = {}
    for index, (name, problem) in enumerate(cases.items()):
        progress("sections of the paper", index, len(cases))
        members[name] = run_problem("member", problem, progress)
    progress("sections of the paper", len(cases), len(cases))
    return AraiRuns(members, cases, 24 if quick else 96)
