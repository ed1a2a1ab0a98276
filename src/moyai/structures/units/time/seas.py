"""Seas over the row in time: forces on it, runs, and the numbers of each run."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.progress import Progress, silent
from moyai.floating.forcing import IrregularForcing, cosine_ramp
from moyai.floating.sums import real_sum
from moyai.sea.components import WaveComponents
from moyai.sea.dispersion import wave_number
from moyai.sea.irregular import realisation_seed, synthesise
from moyai.sea.states import IrregularSea, RegularSea
from moyai.sea.synthesis import choose_band
from moyai.structures.units.assembly import RowAtLevel
from moyai.structures.units.hydrodynamics import RowHydrodynamics
from moyai.structures.units.model import UnitSettings, UnitTimeSettings
from moyai.structures.units.seas import SeaAnswer, columns_of
from moyai.structures.units.time.memory import RowMemory
from moyai.structures.units.time.model import STEPS_OF_WAVE, RowInTime, RowRun

#: Periods of the ramp, and of the whole run in regular waves: of one whose motion does not repeat by then, and of one
#: that still grows
RAMP, PERIODS, MOST_PERIODS, GROWING_PERIODS = 10.0, 50.0, 300.0, 1000.0
#: Change of the motion from one period to the next, over its size, up to which it repeats
REPEATING = 0.05
#: Periods after which a motion may repeat, and its change by then, over its size: chaos comes as near now and then.
MOST_REPEAT, EXACTLY = 16, 0.002
#: Such change below which its growth is that of rounding or leads nowhere in the longest run.
LEAST_CHANGE = 1e-6
#: Parts of the last two thirds of a motion that never repeats, whose largest values are averaged; least periods of each
PARTS, LEAST_OF_PART = 5, 4
#: Stretches of a long record over which a change has to grow
_STRETCHES = 5
#: Share of the step of the waves that a contact may ask for
_LEAST_STEP = 0.1
#: Share of the energy of a sea in waves that the step resolves
_RESOLVED = 0.99


@dataclass(frozen=True, eq=False)
class Water3D:
    """The water around the row in time."""

    at: RowAtLevel
    #: Over the band of the memory.
    hydro: RowHydrodynamics
    memory: RowMemory
    #: Wind and current; shape (m,).
    steady: Array
    settings: UnitSettings

    @property
    def time(self) -> UnitTimeSettings:
        """Settings of the time domain."""
        return self.settings.time


@dataclass(frozen=True, eq=False)
class SeaRun:
    """One run with its waves."""

    run: RowRun
    #: Incident waves.
    waves: WaveComponents
    #: Theirs at the origin of the row [m]; shape (n,).
    elevation: Array
    #: Length of their ramp [s].
    ramp: float
    #: Of the analysis [s].
    begin: float
    #: Of regular waves [rad/s]; of an irregular sea that of its peak.
    omega: float
    #: Of an irregular sea; -1 of regular waves.
    seed: int = -1
    #: Whether the step resolves the contacts of stiff connectors.
    contacts: bool = True
    #: Of the analysis [s].
    end: float = math.inf
    #: Of a regular motion from one period to the next, over its size; by when it repeats, where it does later.
    change: float = 0.0
    #: Of that change a period, 0 where it falls: a combination resonance of the lines begins small.
    growth: float = 0.0
    #: Periods after which it repeats.
    every: int = 1

    @property
    def kept(self) -> slice:
        """Rows that are analysed."""
        low, high = np.searchsorted(self.run.time, (self.begin - 1e-9, self.end + 1e-9))
        # of a run that ended before, its last row
        return slice(min(int(low), int(high) - 1), int(high))

    @property
    def period(self) -> float:
        """Of the waves, or of their peak [s]."""
        return 2.0 * math.pi / self.omega

    @property
    def parts(self) -> tuple[SeaRun, ...]:
        """Stretches of whole periods of a regular motion that does not repeat, else the run alone."""
        last = float(self.run.time[-1])
        periods = math.floor((last - max(self.ramp, last / 3.0)) / self.period / PARTS)
        if self.change <= REPEATING or periods < LEAST_OF_PART:
            return (self,)
        edges = last - periods * self.period * np.arange(PARTS, -1, -1)
        return tuple(replace(self, begin=float(low), end=float(high)) for low, high in itertools.pairwise(edges))

    @property
    def complete(self) -> bool:
        """Whether the run came to its end."""
        return self.run.status == "converged"


def time_step(wanted: float | None, shortest: float, model: RowInTime) -> tuple[float, bool]:
    """Return the step [s], and whether it resolves contacts of connectors."""
    if wanted is not None:
        return wanted, wanted <= 2.0 * model.contact_step()
    waves, contact = shortest / STEPS_OF_WAVE, model.contact_step()
    step = min(waves, max(contact, _LEAST_STEP * waves))
    return step, step <= 2.0 * contact


def repeating_run(
    water: Water3D, sea: RegularSea, period: float, answer: SeaAnswer, progress: Progress = silent
) -> SeaRun:
    """Run the row in regular waves until its motion repeats, or long enough for the statistics of one that never does.

    One whose change from period to period is small and grows does not repeat yet.

    A given duration is kept.
    """
    found = regular_run(water, sea, period, answer, PERIODS, progress)
    if water.time.duration is not None:
        return found
    for least in (MOST_PERIODS, GROWING_PERIODS):
        settled = found.change <= REPEATING or least == GROWING_PERIODS
        if not found.complete or (settled and not found.growth):
            break
        found = regular_run(water, sea, period, answer, least, progress)
    return found


def regular_run(
    water: Water3D,
    sea: RegularSea,
    period: float,
    answer: SeaAnswer,
    least: float = PERIODS,
    progress: Progress = silent,
) -> SeaRun:
    """Run the row in regular waves, from its mean position of the frequency domain [eq:units-cummins].

    ``least`` is how many periods are run where no duration is given.
    """
    settings, at = water.time, water.at
    omega = 2.0 * math.pi / period
    model = RowInTime(at, water.memory, answer.rest.position, omega)
    step, resolved = time_step(settings.time_step, period, model)
    per_period = math.ceil(period / step - 1e-9)
    step = period / per_period
    ramp = RAMP * period if settings.ramp is None else settings.ramp
    analysed = settings.analysed_periods * period
    duration = settings.duration or max(least * period, ramp + 20.0 * period + analysed)
    periods = max(math.ceil(duration / period - 1e-9), settings.analysed_periods + 1)
    count = periods * per_period + 1
    k = np.array([float(wave_number(omega, at.water.depth, at.water.gravity))])
    column = columns_of(water.hydro, np.array([sea.heading]))[0]
    excitation = water.hydro.at(np.array([omega]), k)[2][0, column]
    time = step * np.arange(count)
    wave = cosine_ramp(time, ramp) * 0.5 * sea.height * np.exp(-1j * omega * time)
    load = (wave[:, None] * excitation).real + water.steady + answer.pushed
    water_motion = None
    if model.eddies is not None:
        moving = model.eddies.water_motion(np.array(omega), np.array(sea.heading), at.water.depth, at.water.gravity)
        water_motion = (wave[:, None] * moving).real
    words = f", {at.name}, {sea.name}, {period:.3g} s"
    run = model.run(load, step, water=water_motion, progress=progress, name=words)
    one = WaveComponents(
        np.array([omega]), np.array([0.5 * sea.height]), np.zeros(1), np.array([sea.heading]), k, at.water
    )
    every, change = _repetition(run.position, per_period, settings.analysed_periods)
    begin = float(time[-1]) - math.ceil(settings.analysed_periods / every) * every * period
    return SeaRun(
        run, one, wave.real[: len(run.time)], ramp, begin, omega, contacts=resolved, change=change,
        growth=_growth(run.position, per_period, settings.analysed_periods), every=every,
    )  # fmt: skip


def _repetition(position: Array, per_period: int, periods: int) -> tuple[int, float]:
    """Return after how many periods motions (n, m) repeat, and their change by then; from one period to the next where
    they do not."""
    change = _change(position, per_period, periods)
    if change > REPEATING:
        for every in range(2, MOST_REPEAT + 1):
            # two rounds that are alike, beyond what the first half of the run may still have of its beginning
            rounds = max(periods, 2 * every)
            if len(position) > 2 * (rounds + every) * per_period:
                later = _change(position, per_period, rounds, every)
                if later <= EXACTLY:
                    return every, later
    return 1, change


def _change(position: Array, per_period: int, periods: int, every: int = 1) -> float:
    """Return how motions (n, m) of the last periods differ from those ``every`` periods before, over their size.

    Translations and turns by themselves; 0 of a run that is too short.
    """
    rows, lag = periods * per_period, every * per_period
    if len(position) <= rows + lag:
        return 0.0
    last, before = position[-rows:], position[-rows - lag : -lag]
    units = (rows, -1, 2, 3)
    moved = np.linalg.norm((last - before).reshape(units).std(axis=0), axis=(0, 2))
    size = np.linalg.norm(last.reshape(units).std(axis=0), axis=(0, 2))
    return float(np.max(moved / np.maximum(size, 1e-12)))


def _growth(position: Array, per_period: int, periods: int) -> float:
    """Return by how much the change from period to period grows a period, 0 where it falls or is that of rounding.

    A long record has to show it over several stretches: the change of a motion that never repeats goes up and down.
    """
    rows = periods * per_period
    stretches = _STRETCHES if len(position) > 3 * _STRETCHES * rows else 2
    changes = [_change(position[: len(position) - k * rows], per_period, periods) for k in range(stretches)]
    rising = all(late > early > 0.0 for late, early in itertools.pairwise(changes))
    if not rising or changes[0] < LEAST_CHANGE:
        return 0.0
    return math.log(changes[0] / changes[-1]) / (periods * (stretches - 1))


def irregular_run(
    water: Water3D, sea: IrregularSea, number: int, answer: SeaAnswer, progress: Progress = silent
) -> SeaRun:
    """Run one realisation of an irregular sea with slow drift after Newman [eq:units-slow-drift]."""
    settings, at = water.time, water.at
    peak = float(sea.spectrum.peak_omega)
    model = RowInTime(at, water.memory, answer.rest.position, peak)
    ramp = RAMP * 2.0 * math.pi / peak if settings.ramp is None else settings.ramp
    duration = sea.duration + ramp
    seed = realisation_seed(sea.seed, number)
    waves, forcing = forcing_of(water, sea, answer, seed, ramp, duration)
    step, resolved = time_step(settings.time_step, forcing.shortest_period, model)
    step = forcing.fitted_step(step)
    count = math.ceil(duration / step) + 1
    load, elevation = forcing.sample(step, count)
    mean = forcing.mean_drift()
    shape = cosine_ramp(step * np.arange(count), ramp)
    load += water.steady + (1.0 - shape)[:, None] * mean
    water_motion = None
    if model.eddies is not None:
        moving = model.eddies.water_motion(waves.omega, waves.heading, at.water.depth, at.water.gravity)
        water_motion = real_sum(waves.omega, forcing.amplitude[:, None] * moving, step, count)
        water_motion *= shape[:, None]
    words = f", {at.name}, {sea.name}, seed {seed}"
    run = model.run(load, step, water=water_motion, progress=progress, name=words)
    return SeaRun(run, waves, elevation[: len(run.time)], ramp, ramp, peak, seed, resolved)


def forcing_of(
    water: Water3D, sea: IrregularSea, answer: SeaAnswer, seed: int, ramp: float, duration: float
) -> tuple[WaveComponents, IrregularForcing]:
    """Return the waves of a realisation and their forces; a component travels along the nearest heading solved."""
    at, hydro = water.at, water.hydro
    low, high = choose_band(sea.spectrum, None, None)
    components: WaveComponents = synthesise(
        sea.spectrum, at.water, duration=duration, seed=seed, heading=sea.heading, spreading=sea.spreading,
        lower_omega=max(low, float(hydro.omega[0])), upper_omega=min(high, float(hydro.omega[-1])),
    )  # fmt: skip
    apart = np.abs(np.angle(np.exp(1j * (components.heading[:, None] - answer.headings[None, :]))))
    own = apart.argmin(axis=1)
    components = replace(components, heading=answer.headings[own])
    column = columns_of(hydro, answer.headings)[own]
    every = hydro.at(components.omega, components.wave_number)[2]
    excitation = every[np.arange(len(column)), column]
    drift: Array | None = None
    law: Literal["newman", "none"] = "none"
    if water.settings.drift:
        law = "newman"
        coarse = answer.coarse.omega
        table = answer.unit_drift
        drift = np.empty((len(own), at.size))
        for heading in range(table.shape[1]):
            mine = own == heading
            for part in range(at.size):
                drift[mine, part] = np.interp(components.omega[mine], coarse, table[:, heading, part])
    return components, IrregularForcing(
        omega=components.omega, amplitude=components.complex_amplitude, excitation_force=excitation, drift=drift,
        steady=np.zeros(at.size), drift_law=law, ramp=ramp,
    )  # fmt: skip
