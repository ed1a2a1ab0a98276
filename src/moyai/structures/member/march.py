"""One wave past one member: kinematics, coefficients, circulation and forces of every strip, summed over the length."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from moyai.core.arrays import Array
from moyai.core.validity import Notice
from moyai.morison.circulation import relaxed, target_circulation
from moyai.morison.coefficients import Conditions
from moyai.morison.forces import strip_forces
from moyai.morison.members import StraightMember, Strips
from moyai.morison.orbits import mean_frequency, orbit_amplitudes
from moyai.structures.member.model import MemberProblem
from moyai.structures.member.supports import influence
from moyai.structures.member.waves import MemberWave

CAUSES = ("inertia", "drag", "magnus")
#: Values of one array that are held at a time; longer records are taken in blocks of strips.
_BLOCK = 100_000


@dataclass(frozen=True, eq=False)
class WaveForces:
    """Forces of one wave."""

    #: [s]; shape (times,).
    time: Array
    #: Surface above the middle of the member [m]; shape (times,).
    elevation: Array
    #: Whole member by cause, along x, y, z [N]; shape (causes, times, 3).
    force: Array
    #: Of all forces about the middle of the member [N m]; shape (times, 3).
    moment: Array
    #: Forces at start and end [N] and bending moments at the stations [N m], by cause, along the axes of the section;
    #: shape (causes, times, 2 + stations, 2).
    held: Array
    #: At the governing strip [m2/s]; shape (times,).
    circulation: Array
    #: ``velocity_first``, ``velocity_second`` [m/s], ``keulegan_carpenter`` of the waves and, with the current,
    #: ``coefficient_keulegan_carpenter``, ``reynolds``, ``beta``, ``frequency`` [rad/s], ``orbit_ratio`` smaller over
    #: larger axis of the orbit, ``inertia``, ``effective_inertia`` and, without the circulation, ``plain_inertia``
    #: (strips, 2), ``drag`` (strips, 2), ``force`` (strips, 2) largest force per length along both axes [N/m], ``wet``
    #: mean wetted share, ``circulation`` and ``settled_circulation`` mean [m2/s]; shape (strips, ...).
    strip: dict[str, Array]
    #: Strip of the largest Keulegan-Carpenter number among those that are wet; in a current alone of the fastest flow.
    governing: int
    notices: tuple[Notice, ...]


@dataclass(frozen=True, eq=False)
class _Block:
    """Water and body across the member at a block of strips, in axes of the section; shape (times, strips, 2)."""

    orbital: Array
    acceleration: Array
    steady: Array
    body_velocity: Array
    body_acceleration: Array
    elevation: Array
    wet: Array


def march(problem: MemberProblem, member: StraightMember, wave: MemberWave) -> WaveForces:
    """Run one wave past the member.

    Parameters
    ----------
    problem : MemberProblem
    member : StraightMember
        With z above still water.
    wave : Wave
    """
    strips = member.strips(problem.settings.strips)
    count = len(strips.centres)
    size = max(1, min(count, _BLOCK // max(1, wave.time.size)))
    axes = member.axes[:2]
    time = _shown_time(problem, wave)
    force = np.zeros((len(CAUSES), time.size, 3))
    moment = np.zeros((time.size, 3))
    rows = influence(problem.support, count, member.length) * strips.length
    held = np.zeros((len(CAUSES), time.size, len(rows), 2))
    found: list[dict[str, Array]] = []
    circulations: list[Array] = []
    elevations: list[Array] = []
    notices: dict[str, Notice] = {}
    middle = 0.5 * (np.asarray(member.start) + np.asarray(member.end))
    for first in range(0, count, size):
        part = replace(strips, centres=strips.centres[first : first + size])
        block = _sample(problem, member, wave, part)
        gammas, per_length, numbers, reported = _block_forces(problem, member, wave, block, time)
        for notice in reported:
            notices.setdefault(notice.code, notice)
        for cause in range(len(CAUSES)):
            force[cause] += per_length[cause].sum(axis=1) @ axes * strips.length
            held[cause] += rows[:, first : first + len(part.centres)] @ per_length[cause]
        whole = per_length.sum(axis=0) @ axes * strips.length
        moment += np.sum(np.cross(part.centres - middle, whole), axis=1)
        found.append(numbers)
        circulations.append(gammas)
        elevations.append(_repeated(block.elevation, time, wave))
    strip = {name: np.concatenate([numbers[name] for numbers in found]) for name in found[0]}
    exposed = strip["reynolds" if wave.steady else "keulegan_carpenter"]
    governing = int(np.argmax(np.where(strip["wet"] > 0.0, exposed, -1.0)))
    centre = count // 2
    return WaveForces(
        time=time,
        elevation=np.concatenate(elevations, axis=1)[:, centre],
        force=force,
        moment=moment,
        held=held,
        circulation=np.concatenate(circulations, axis=1)[:, governing],
        strip=strip,
        governing=governing,
        notices=tuple(notices.values()),
    )


def _shown_time(problem: MemberProblem, wave: MemberWave) -> Array:
    """Return the times shown: the grid of an irregular sea, whole periods of a regular wave."""
    if not wave.regular or wave.steady:
        return wave.time
    law = problem.circulation
    periods = problem.settings.periods
    if periods is None:
        calm = law.counted and law.start == "calm"
        periods = max(1, math.ceil(8.0 * law.relaxation_periods)) if calm else 1
    steps = wave.time.size - 1
    values: Array = np.arange(periods * steps + 1) * (wave.time[1] - wave.time[0])
    return values


def _repeated(values: Array, time: Array, wave: MemberWave) -> Array:
    """Repeat one period of a regular wave along the shown times."""
    if values.shape[0] in (1, time.size):
        return values
    return values[np.arange(time.size) % (wave.time.size - 1)]


def _sample(problem: MemberProblem, member: StraightMember, wave: MemberWave, part: Strips) -> _Block:
    axes = member.axes[:2]
    flow = wave.flow.sample(wave.time, part.centres)
    current = wave.current
    steady = np.zeros((1, len(part.centres), 2))
    if current is not None:
        level = np.minimum(part.centres[:, 2], 0.0)
        steady = (current.velocity(level) @ axes[:, :2].T)[None]
    still = np.zeros((1, 1, 2))
    body_velocity = body_acceleration = still
    if problem.motion is not None:
        omega = 2.0 * math.pi / (problem.motion.period or wave.period)
        velocity, acceleration = problem.motion.derivatives(wave.time, omega)
        body_velocity, body_acceleration = (velocity @ axes.T)[:, None, :], (acceleration @ axes.T)[:, None, :]
    return _Block(
        orbital=flow.velocity @ axes.T,
        acceleration=flow.acceleration @ axes.T,
        steady=steady,
        body_velocity=body_velocity,
        body_acceleration=body_acceleration,
        elevation=flow.elevation,
        wet=part.wet_share(flow.elevation),
    )


def _block_forces(
    problem: MemberProblem, member: StraightMember, wave: MemberWave, block: _Block, time: Array
) -> tuple[Array, Array, dict[str, Array], list[Notice]]:
    """Return circulation (times, strips), forces per length (causes, times, strips, 2), numbers of the strips."""
    section = member.placed_section
    relative = block.orbital - block.body_velocity
    rate = block.acceleration - block.body_acceleration
    if wave.steady:
        omega = np.full(relative.shape[1], math.nan)
    elif wave.regular:
        omega = np.full(relative.shape[1], 2.0 * math.pi / wave.period)
        rate = _local_rate(relative, wave.period)
    else:
        omega = np.maximum(mean_frequency(relative, rate), 1e-9)
    numbers, drag, inertia, reported = _coefficients(
        problem, member, relative, rate, block, omega, wave.regular, wave.steady
    )
    law = problem.circulation
    gamma_now = np.zeros(relative.shape[:2])
    settled = np.zeros(relative.shape[:2])
    for number in range(0 if wave.steady else relative.shape[1]):
        settled[:, number] = target_circulation(
            law,
            relative[:, number],
            rate[:, number],
            omega[number],
            breadth=section.breadth,
            area=section.area,
            gamma=law.gamma(float(numbers["beta"][number])),
        )
    if law.counted and not wave.steady:
        # where the member is dry there is nothing to turn
        gamma_now = _state(problem, wave, settled * (block.wet > 0.0), omega)
    forces = strip_forces(
        block.orbital + block.steady,
        block.acceleration,
        density=problem.environment.water.density,
        area=section.area,
        inertia=inertia,
        drag=drag,
        drag_widths=section.drag_widths,
        body_velocity=block.body_velocity,
        body_acceleration=block.body_acceleration,
        form=problem.form,
    )
    lift = _repeated(relative + block.steady, time, wave)
    gammas = gamma_now if len(gamma_now) == time.size else _repeated(gamma_now, time, wave)
    magnus = problem.environment.water.density * gammas[..., None] * np.stack([-lift[..., 1], lift[..., 0]], axis=-1)
    wet = _repeated(block.wet, time, wave)[..., None]
    per_length = np.stack(
        [_repeated(forces.inertia, time, wave) * wet, _repeated(forces.drag, time, wave) * wet, magnus * wet]
    )
    numbers["circulation"] = gammas[-wave.time.size :].mean(axis=0)
    numbers["settled_circulation"] = settled.mean(axis=0)
    total = per_length.sum(axis=0)[-wave.time.size :]
    numbers["force"] = np.abs(total).max(axis=0)
    numbers["wet"] = block.wet.mean(axis=0)
    numbers["inertia"] = np.stack([np.diagonal(inertia[n]) for n in range(len(inertia))])
    numbers["drag"] = drag
    numbers["effective_inertia"] = _effective(problem, section.area, block, forces.inertia, magnus, wave)
    numbers["plain_inertia"] = _effective(problem, section.area, block, forces.inertia, np.zeros_like(magnus), wave)
    return gammas, per_length, numbers, reported


def _local_rate(velocity: Array, period: float) -> Array:
    """Return the derivative of a periodic velocity at the member, by Fourier; the last sample repeats the first.

    The orbit that the member sees turns with the frequency of the fixed frame, also where a current carries the waves
    past it; the acceleration of the water particles does not.
    """
    steps = len(velocity) - 1
    turn = 2.0j * math.pi / period * np.fft.rfftfreq(steps, 1.0 / steps)
    if steps % 2 == 0:
        turn[-1] = 0.0
    rate = np.fft.irfft(np.fft.rfft(velocity[:-1], axis=0) * turn[:, None, None], steps, axis=0)
    return np.concatenate([rate, rate[:1]])


def _state(problem: MemberProblem, wave: MemberWave, target: Array, omega: Array) -> Array:
    """Return the circulation over the shown times [eq:circulation-state]."""
    law = problem.circulation
    step = float(wave.time[1] - wave.time[0])
    relaxation = law.relaxation_periods * 2.0 * math.pi / omega
    if not wave.regular:
        start = target.mean(axis=0) if law.start == "settled" else np.zeros(target.shape[1])
        return relaxed(target, step, relaxation, start)
    if law.start == "settled":
        # the start that repeats itself after a period
        last = relaxed(target, step, relaxation, np.zeros(target.shape[1]))[-1]
        return relaxed(target, step, relaxation, last / -np.expm1(-wave.period / relaxation))
    time = _shown_time(problem, wave)
    return relaxed(_repeated(target, time, wave), step, relaxation, np.zeros(target.shape[1]))


def _effective(
    problem: MemberProblem, area: float, block: _Block, inertial: Array, magnus: Array, wave: MemberWave
) -> Array:
    """Return the inertia coefficient along each axis that inertia and Magnus's force show together.

    By projection on the acceleration, the definition that also serves irregular seas [eq:morison-effective-inertia].
    """
    steps = wave.time.size - 1 if wave.regular else wave.time.size
    rate = (block.acceleration - block.body_acceleration)[:steps]
    both = (np.broadcast_to(inertial, block.acceleration.shape)[:steps]) + magnus[-wave.time.size :][:steps]
    power = np.sum(rate**2, axis=0)
    scale = problem.environment.water.density * area * power
    shared = np.sum((both - problem.environment.water.density * area * block.body_acceleration[:steps]) * rate, axis=0)
    usable = power > 1e-12 * np.maximum(power.max(), 1e-300)
    return np.where(usable, shared / np.where(usable, scale, 1.0), np.nan)


def _coefficients(
    problem: MemberProblem,
    member: StraightMember,
    relative: Array,
    rate: Array,
    block: _Block,
    omega: Array,
    regular: bool,
    steady: bool,
) -> tuple[dict[str, Array], Array, Array, list[Notice]]:
    """Return numbers, drag (strips, 2), inertia (strips, 2, 2) and notices of a block of strips."""
    section = member.placed_section
    width = section.breadth
    fluctuation = relative - relative.mean(axis=0)
    if regular:
        first, second = (0.5 * np.ptp(fluctuation[..., axis], axis=0) for axis in (0, 1))
        axes = orbit_amplitudes(relative, rate, omega)
        # the largest velocity of the wave while the strip is in water: of a harmonic orbit its larger axis, of a steep
        # crest more; the acceleration over the frequency would count its harmonics twice
        speeds = np.linalg.norm(relative, axis=-1)
        submerged = block.wet > 0.0
        major = np.where(submerged.any(axis=0), np.where(submerged, speeds, 0.0).max(axis=0), speeds.max(axis=0))
    else:
        first, second = (math.sqrt(2.0) * fluctuation[..., axis].std(axis=0) for axis in (0, 1))
        axes = orbit_amplitudes(fluctuation, rate, omega)
        major = np.sqrt(np.mean(axes[0] ** 2, axis=0))
    large, small = (np.sqrt(np.mean(part**2, axis=0)) for part in axes)
    drift = np.linalg.norm(block.steady[0], axis=-1)
    speed = major + drift
    ratio = np.divide(drift, major, out=np.where(drift > 0.0, math.inf, 0.0), where=major > 0.0)
    number = major * 2.0 * math.pi / omega / width
    # drag laws of steady and wave flow take the largest velocity in KC
    whole_number = speed * 2.0 * math.pi / omega / width
    reynolds = speed * width / problem.kinematic_viscosity
    beta = width**2 * omega / (2.0 * math.pi * problem.kinematic_viscosity)
    if steady:
        # nothing goes to and fro: no orbit, and a flow that never turns back
        whole_number = np.full_like(speed, math.inf)
    count = relative.shape[1]
    drag, inertia = np.empty((count, 2)), np.empty((count, 2, 2))
    reported: dict[str, Notice] = {}
    wet = block.wet.max(axis=0) > 0.0
    for strip in range(count):
        flow = Conditions(
            float(whole_number[strip]), float(reynolds[strip]), float(beta[strip]), problem.roughness / width,
            float(ratio[strip]), float(number[strip]),
        )  # fmt: skip
        found = problem.rule.at(section, flow)
        drag[strip], inertia[strip] = found.drag, found.inertia
        for notice in found.notices if wet[strip] else ():
            known = reported.get(notice.code)
            if known is None or abs(notice.value - notice.limit) > abs(known.value - known.limit):
                reported[notice.code] = notice
    numbers = {
        "velocity_first": first,
        "velocity_second": second,
        "orbit_ratio": np.divide(small, large, out=np.full_like(large, math.nan), where=large > 0.0),
        "keulegan_carpenter": number,
        "coefficient_keulegan_carpenter": whole_number,
        "reynolds": reynolds,
        "beta": beta,
        "frequency": omega,
    }
    return numbers, drag, inertia, list(reported.values())
