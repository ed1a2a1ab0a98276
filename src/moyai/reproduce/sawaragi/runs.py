"""Runs of the paper: release records, added masses, and sweeps of the impact tension over its four numbers."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.signal import find_peaks

from moyai.core.arrays import Array
from moyai.core.at_once import each_counted
from moyai.core.progress import Progress, silent
from moyai.flexible.flow import Flow
from moyai.potential.modes import Modes, Rigid
from moyai.potential.solver import solve
from moyai.potential.thin_plate import Plate, hanging_arc, horizontal_motion, solve_plate_limit
from moyai.potential.thin_plate_waves import plate_section
from moyai.reproduce.inputs import problem_of
from moyai.sea.water import Water
from moyai.structures.curtain.analyses.impact import impact_of
from moyai.structures.curtain.assembly import assemble
from moyai.structures.curtain.dynamic.model import CurtainSpan, Mesh
from moyai.structures.curtain.dynamic.runs import run_span
from moyai.structures.curtain.impact.cable import Impact, edge_impact, impact_numbers, peak_by_energy
from moyai.structures.curtain.impact.cycles import SlackTautMotion, slack_taut_motion
from moyai.structures.curtain.model import CurtainProblem

LINE, STEEL = 150.0, 39000.0
DRAG = 1.2
RELATIVE_DEPTH = 3.0
#: Mass of the lower edge [kg/m] and of the sheet [kg/m2], filled in; duration of a run of the whole span [s].
TOE_MASS, SHEET_MASS, RELEASE = 0.467, 0.1, 4.5


@dataclass(frozen=True)
class Release:
    """A release: held on the line between the supports, let go, taut, steady."""

    motion: SlackTautMotion
    #: Taut instant [s].
    taut: float
    #: Time from the taut instant to the spike [s].
    rise: float
    #: Spike of the sum of both cables [N].
    spike: float
    #: Plateau of the sum of both cables [N].
    plateau: float


@dataclass(frozen=True, eq=False)
class SpanRecord:
    """A release of the whole span: slack and gathered between the supports, picked up, steady."""

    #: [s] from release.
    time: Array
    #: Sum of both cables at a support [N].
    tension: Array
    #: Mean of the last tenth [N].
    plateau: float

    @property
    def spike(self) -> float:
        """Largest tension [N]."""
        return float(self.tension.max())

    @property
    def spike_time(self) -> float:
        """When it is reached [s]."""
        return float(self.time[self.tension.argmax()])

    def before_spike(self, parts: int = 4) -> Array:
        """Return the mean tensions of equal parts of the time from release to the spike [N]."""
        edges = np.linspace(0.0, self.spike_time, parts + 1)
        return np.array(
            [
                self.tension[(self.time >= start) & (self.time < end)].mean()
                for start, end in itertools.pairwise(edges.tolist())
            ]
        )

    def spikes(self, share: float = 0.5) -> int:
        """Return how many peaks rise by this share of the highest tension over the valleys that part them from others.

        Their prominence: a level that the record passes would count the ripple of the pick-up where it lies at that
        level, and the steady level of this record is itself about half of the highest.
        """
        return int(find_peaks(self.tension, prominence=share * self.spike)[0].size)


@dataclass(frozen=True)
class SawaragiRuns:
    """The span of the flume and what the figures and statements ask of it."""

    #: With cables of fishing line.
    span: Impact
    case: CurtainProblem
    #: Points on a curve.
    points: int
    #: Of the whole span, along and down.
    cells: tuple[int, int] = (24, 8)

    def with_stiffness(self, total: float) -> Impact:
        """Return the span with EA shared by both cables [N]."""
        return replace(self.span, upper_stiffness=0.5 * total, lower_stiffness=0.5 * total)

    def coefficients(self, spans: Iterable[Impact]) -> Array:
        """Return C_T of spans by model A."""
        return np.array([impact_numbers(span, peak_by_energy(span).tension).tension_coefficient for span in spans])

    def over(self, name: str, total: float) -> tuple[Array, Array]:
        """Return one of the numbers ``froude``, ``span_ratio``, ``depth_ratio`` and C_T over it."""
        span, water = self.with_stiffness(total), self.span.water
        if name == "froude":
            x = np.linspace(0.04, 0.26, self.points)
            root = math.sqrt(water.gravity * water.depth)
            return x, self.coefficients(replace(span, speed=float(value) * root) for value in x)
        if name == "span_ratio":
            x = np.linspace(0.5, 0.99, self.points)
            return x, self.coefficients(replace(span, length=span.span / float(value)) for value in x)
        x = np.linspace(0.2, 0.55, self.points)
        return x, self.coefficients(replace(span, draught=water.depth * float(value)) for value in x)

    def over_stiffness(self) -> tuple[Array, Array]:
        """Return C_E and C_T."""
        spans = [self.with_stiffness(float(value)) for value in np.geomspace(20.0, 60000.0, self.points)]
        return np.array([impact_numbers(span, 1.0).cauchy_number for span in spans]), self.coefficients(spans)

    def released(self, total: float) -> Release:
        """Return the record of a release in the current of the span."""
        duration = 60.0
        motion = slack_taut_motion(
            self.with_stiffness(total), drag_coefficient=DRAG, current=self.span.speed, velocity_amplitude=0.0,
            period=duration, duration=duration,
        )  # fmt: skip
        first = motion.contacts[0]
        end = int(np.searchsorted(motion.time, first.time + 1.0))
        top = int(np.argmax(motion.tension[:end]))
        late = motion.tension[motion.time > 0.9 * duration]
        rise = float(motion.time[top]) - first.time
        return Release(motion, first.time, rise, float(motion.tension[top]), float(late.mean()))

    @cached_property
    def line(self) -> Release:
        """The release with fishing line."""
        return self.released(LINE)

    @cached_property
    def steel(self) -> Release:
        """The release with steel wire."""
        return self.released(STEEL)

    @cached_property
    def peaks(self) -> tuple[Array, Array]:
        """Peak of model A over currents, and that of a release less its steady level, both cables of line [N]."""
        found = []
        for speed in np.linspace(0.1, 0.5, 9).tolist():
            other = replace(self, span=replace(self.span, speed=speed))
            record = other.released(LINE)
            found.append((peak_by_energy(other.with_stiffness(LINE)).tension, record.spike - record.plateau))
        computed, released = np.array(found).T
        return computed, released

    def span_released(
        self, total: float, cells: tuple[int, int], share: float = 0.0, duration: float = RELEASE, heavier: float = 1.0
    ) -> SpanRecord:
        """Return the record of the whole span released slack and at rest in the current, edges held in height.

        Parameters
        ----------
        total : float
            EA of both cables [N].
        cells : (int, int)
        share : float
            Of the way from the line between the supports to the just-taut shape where it is let go.
        duration : float
            [s].
        heavier : float
            Factor on the masses of sheet and lower edge.
        """
        span, skirt, g = self.with_stiffness(total), self.case.curtain.skirt, self.span.water.gravity
        whole = CurtainSpan(
            span=span.span, length=span.length, skirt_length=span.draught, chord=span.draught,
            upper_stiffness=span.upper_stiffness, lower_stiffness=span.lower_stiffness,
            upper_mass=self.case.curtain.floats.weight / g, lower_mass=heavier * TOE_MASS,
            sheet_stiffness=skirt.stiffness, sheet_mass=heavier * SHEET_MASS, drag_coefficient=DRAG,
        )  # fmt: skip
        run = run_span(
            whole, Mesh(*cells), span.water, flow=Flow(velocity=(span.speed, 0.0, 0.0)), duration=duration,
            output_step=RELEASE / 1000.0, weight=False, deep=True, release=share,
        )  # fmt: skip
        time, tension = np.asarray(run.history.time), run.support_tension
        return SpanRecord(time, tension, float(tension[time > 0.9 * duration].mean()))

    @cached_property
    def whole_line(self) -> SpanRecord:
        """The release of the whole span with fishing line."""
        return self.span_released(LINE, self.cells)

    def edges(self, total: float) -> tuple[float, float, float, float]:
        """Return the largest tension of the upper and lower cable [N] and when they occur [s]."""
        found = edge_impact(self.with_stiffness(total))
        times = [float(found.time[np.argmax(tension)]) for tension in (found.upper_tension, found.lower_tension)]
        return found.upper_peak, found.lower_peak, times[0], times[1]

    @cached_property
    def over_frequency(self) -> tuple[Array, Array, Array]:
        """Kd, M/M0 and N/(omega M0) of the flat plate."""
        draught = self.span.draught
        water = Water(RELATIVE_DEPTH * draught, self.span.water.density, self.span.water.gravity)
        number = np.geomspace(0.1, 60.0, 2 * self.points)
        omega = np.sqrt(number * water.gravity / draught)
        plate = plate_section(Plate((0.0, 0.0), (0.0, -draught)))
        found = solve(plate, water, omega, modes=Modes(("sway",), (Rigid("sway"),)))
        mass = 2.0 * water.density * draught**2 / math.pi
        return number, found.added_mass[:, 0, 0] / mass, found.radiation_damping[:, 0, 0] / (omega * mass)

    @cached_property
    def over_curvature(self) -> tuple[Array, Array, Array]:
        """s/d; M_xx, M_xc, M_cc (3, n) over M0 of the chord; arc over chord."""
        draught = self.span.draught
        water = Water(math.inf, self.span.water.density, self.span.water.gravity)
        flat = 2.0 * water.density * draught**2 / math.pi
        distance = np.concatenate([[0.0], np.linspace(0.05, 2.0, self.points)])
        values, lengths = np.empty((3, distance.size)), np.empty(distance.size)
        for column, ratio in enumerate(distance):
            arc = hanging_arc(draught, float(ratio) * draught)
            radius = draught * math.hypot(float(ratio), 0.5)

            def stretch(points: Array, _normals: Array, radius: float = radius) -> Array:
                return np.asarray(points[:, 0] / radius)

            mass = solve_plate_limit(arc, water, (horizontal_motion, stretch)).added_mass / flat
            values[:, column] = mass[0, 0], mass[0, 1], mass[1, 1]
            lengths[column] = arc.length / draught
        return distance, values, lengths


def span_of(case: CurtainProblem) -> Impact:
    """Return the span of a case with the speed of its current."""
    unit = assemble(case, "SWL", 0.0)
    return impact_of(unit, case.settings.impact, unit.surface_speed)


def run(quick: bool = False, progress: Progress = silent) -> SawaragiRuns:
    """Run everything.

    Parameters
    ----------
    quick : bool
        Fewer points on the curves.
    progress : Progress
    """
    case: CurtainProblem = problem_of("sawaragi", "flume")
    runs = SawaragiRuns(span_of(case), case, 21 if quick else 45, (24, 4) if quick else (24, 8))
    steps = ("line", "steel", "whole_line", "over_frequency", "over_curvature")
    each_counted("parts of the paper", lambda name, _: getattr(runs, name), steps, progress)
    return runs
