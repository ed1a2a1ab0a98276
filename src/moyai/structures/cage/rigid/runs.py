"""One run of a rigid cage: from a wave to motion, tensions at both ends and their numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.progress import Progress, silent
from moyai.sea.water import Water
from moyai.structures.cage.rigid.lines import CageLine
from moyai.structures.cage.rigid.literal import literal_pack
from moyai.structures.cage.rigid.model import RigidCageProblem
from moyai.structures.cage.rigid.numbers import Numbers, numbers_of
from moyai.structures.cage.rigid.pack import pack
from moyai.structures.cage.rigid.statics import RigidCageEquilibrium, size_of
from moyai.structures.cage.rigid.time import March, march, march_fixed
from moyai.structures.cage.rigid.waves import RigidCageWave


@dataclass(frozen=True, eq=False)
class RigidCageRun:
    """A run with its numbers; ``ends`` is the tension (rows, lines, 2) at the cage and at the anchor [N]."""

    wave: RigidCageWave
    march: March
    ends: Array
    peak_at_ends: Array
    numbers: Numbers
    elevation: Array
    rest: RigidCageEquilibrium


def realised_height(problem: RigidCageProblem, run: RigidCageRun) -> float:
    """Return four standard deviations of the surface after the waves have grown [m]."""
    time = run.march.time
    grown = min(problem.settings.ramp_periods * run.wave.period, float(time[-1]))
    return 4.0 * float(run.elevation[time >= grown].std())


def end_tensions(lines: tuple[CageLine, ...], attachment_z: Array, tension: Array) -> Array:
    """Return the tension at cage and anchor of straight lines; the weight in water parts them [eq:cage-ends].

    Parameters
    ----------
    lines : tuple of CageLine
    attachment_z : ndarray, shape (rows, lines)
        Height of the attachments [m].
    tension : ndarray, shape (rows, lines)
        At the cage [N].
    """
    out = np.repeat(tension[:, :, None], 2, axis=2)
    for n, line in enumerate(lines):
        if line.submerged_weight != 0.0:
            lower = tension[:, n] - line.submerged_weight * (attachment_z[:, n] - line.anchor[1])
            out[:, n, 1] = np.where(tension[:, n] > 0.0, np.maximum(lower, 0.0), 0.0)
    return out


def attachments(lines: tuple[CageLine, ...], state: Array, centre: tuple[float, float]) -> Array:
    """Return x, z of the attachments over time, shape (rows, lines, 2) [m]."""
    out = np.empty((len(state), len(lines), 2))
    cosine, sine = np.cos(state[:, 2]), np.sin(state[:, 2])
    for n, line in enumerate(lines):
        rx, rz = line.attachment[0] - centre[0], line.attachment[1] - centre[1]
        out[:, n, 0] = state[:, 0] + cosine * rx + sine * rz
        out[:, n, 1] = state[:, 1] - sine * rx + cosine * rz
    return out


def run_wave(
    problem: RigidCageProblem,
    lines: tuple[CageLine, ...],
    rest: RigidCageEquilibrium,
    water: Water,
    wave: RigidCageWave,
    *,
    progress: Progress = silent,
) -> RigidCageRun:
    """March the cage of a problem through one wave from its rest.

    Parameters
    ----------
    problem : RigidCageProblem
    lines : tuple of CageLine
        At this water level.
    rest : Rest
    water : Water
    wave : Wave
    progress : Progress
    """
    settings, cage = problem.settings, problem.cage
    packed = pack(
        cage,
        lines,
        water,
        problem.kinematic_viscosity,
        waves=wave.components,
        current=problem.environment.current,
        ramp=settings.ramp_periods * wave.period,
        stretching=settings.stretching,
    )
    if problem.equations == "literal":
        packed = literal_pack(packed, cage, water)
    start = np.concatenate([rest.place, np.zeros(3)])
    spacing = wave.period / settings.samples_per_period
    if settings.fixed_step is None:
        found = march(
            packed,
            start,
            duration=wave.duration,
            spacing=spacing,
            size=size_of(cage),
            period=wave.period,
            tolerance=settings.tolerance,
            progress=progress,
            label=f"time, {wave.name}",
        )
    else:
        every = max(1, math.ceil(spacing / settings.fixed_step - 1e-9))
        found = march_fixed(
            packed, start, duration=wave.duration, step=spacing / every, every=every, progress=progress,
            label=f"time, {wave.name}",
        )  # fmt: skip
    places = attachments(lines, found.state, cage.centre)
    ends = end_tensions(lines, places[:, :, 1], found.tension)
    peaks = end_tensions(lines, places[:, :, 1], found.tension_peak)
    if wave.regular:
        skip = max(0.0, wave.duration - settings.settled_periods * wave.period)
    else:
        skip = min(settings.ramp_periods * wave.period, 0.5 * wave.duration)
    skip = min(skip, float(found.time[-1]) * 0.5) if found.status != "converged" else skip
    numbers = numbers_of(found, rest.place, ends, peaks, wave.period, skip)
    elevation = np.asarray(wave.components.elevation(found.time))
    return RigidCageRun(wave, found, ends, peaks, numbers, elevation, rest)
