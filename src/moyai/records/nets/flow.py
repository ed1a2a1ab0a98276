"""Motion of the water past a net in waves: by a meter on the carriage, or by linear theory from a gauge on it."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.records.forces.record import acceleration_of, period_of
from moyai.records.forces.waves import orbital_motion
from moyai.records.nets.runs import NetRun, Tank
from moyai.records.nets.steady import steady_window
from moyai.sea.dispersion import wave_number

#: Gap between the encounter period seen and that of the dispersion relation that is reported, relative
_PERIOD_GAP = 0.03


@dataclass(frozen=True, eq=False)
class PanelFlow:
    """Motion of the water past the panel over the part of the record that is used."""

    #: [s].
    time: Array
    #: [m/s].
    velocity: Array
    #: Of the water itself [m/s2].
    acceleration: Array
    #: Period at which the panel meets regular waves [s].
    encounter: float | None


def wave_flow(run: NetRun, tank: Tank, part: NDArray[np.bool_]) -> tuple[PanelFlow, tuple[Notice, ...]]:
    """Return the motion of the water past the panel, by the meter or by linear theory from the gauge [eq:net-flow].

    Under way the panel meets waves of the period T at 2 pi / T + k U (head) or | 2 pi / T - k U | (following); orbital
    velocities and accelerations are those of the wave at rest.

    Parameters
    ----------
    run : NetRun
    tank : Tank
    part : ndarray of bool
        Samples to use.
    """
    time = run.time[part]
    channel = run.velocity if run.velocity is not None else run.elevation
    assert channel is not None
    signal = channel[part]
    towed = run.kind == "towing_waves"
    if not run.regular:
        if towed and run.velocity is None:
            raise InputError(
                f"run {run.name}: irregular waves under way need the current meter", parameter="columns.velocity"
            )
        return _irregular(run, tank, time, signal), ()
    met = run.period if run.period is not None and not towed else period_of(time, signal[:, None])
    notices: list[Notice] = []
    slower = 1.0
    if towed and run.period is not None:
        expected = encounter_period(run.period, _speed(run), tank, run.following)
        if abs(met / expected - 1.0) > _PERIOD_GAP:
            notices.append(
                Notice(
                    "net-encounter-period",
                    f"run {run.name}: waves are met every {met:.4g} s, by their period, the speed and the dispersion "
                    f"relation every {expected:.4g} s",
                    met / expected - 1.0,
                    _PERIOD_GAP,
                    "warning",
                    "check period, speed, 'following' and the clock",
                )
            )
        slower = (-1.0 if run.following and _overtakes(run, tank) else 1.0) * met / run.period
    if run.velocity is not None:
        # mean and harmonics of the meter; the water's own acceleration is that of the wave at rest
        velocity, rate = _harmonic(time, signal, met)
        return PanelFlow(time, velocity, slower * rate, met), tuple(notices)
    wave, rate = _orbital(run, tank, time, signal, met)
    sense = -1.0 if run.following and towed else 1.0
    return PanelFlow(time, _speed(run) + sense * wave, sense * rate, met), tuple(notices)


def _speed(run: NetRun) -> float:
    return run.speed if run.kind == "towing_waves" else 0.0


def encounter_period(period: float, speed: float, tank: Tank, following: bool) -> float:
    """Return the period at which a carriage meets waves [s] [eq:net-encounter]."""
    omega = 2.0 * math.pi / period
    shift = float(wave_number(omega, tank.water_depth, tank.gravity)) * speed
    met = abs(omega - shift) if following else omega + shift
    if met < 1e-3 * omega:
        raise InputError("the carriage runs as fast as the waves", parameter="speed", remedy="they are never met")
    return 2.0 * math.pi / met


def settled(run: NetRun) -> NetRun:
    """Return a run under way with its steady window and its mean speed there, where the carriage's speed is known."""
    if run.kind != "towing_waves" or run.speed_record is None:
        return run
    window = run.window
    if window is None:
        window = steady_window(run.time, run.speed_record, is_speed=True)
    return dataclasses.replace(run, window=window, speed=float(run.speed_record[run.part(window)].mean()))


def _harmonic(time: Array, values: Array, period: float, orders: int = 3) -> tuple[Array, Array]:
    omega = 2.0 * math.pi / period
    count = int(min(orders, max(1, math.floor(0.4 * period / (time[1] - time[0])))))
    order = omega * np.arange(1, count + 1)
    angle = (time - time.mean())[:, None] * order
    design = np.column_stack([np.ones_like(time), np.cos(angle), np.sin(angle)])
    fit, *_ = np.linalg.lstsq(design, values, rcond=None)
    slope = np.column_stack([np.zeros_like(time), -order * np.sin(angle), order * np.cos(angle)])
    return np.asarray(design @ fit), np.asarray(slope @ fit)


def _orbital(run: NetRun, tank: Tank, time: Array, elevation: Array, met: float) -> tuple[Array, Array]:
    """Return velocity and acceleration along the waves from a gauge that moves with the panel."""
    at_rest = met if run.kind != "towing_waves" or run.period is None else run.period
    # the same phases at another pace: the record in units of its own period is that of the wave at rest
    stretched = time.mean() + (time - time.mean()) * (at_rest / met)
    if run.kind == "towing_waves" and run.following and run.period is not None and _overtakes(run, tank):
        stretched = 2.0 * time.mean() - stretched
    velocity, rate = orbital_motion(
        stretched,
        elevation,
        water_depth=tank.water_depth,
        gravity=tank.gravity,
        height=tank.panel_z,
        distance=run.distance,
        period=at_rest,
    )
    return velocity[:, 0], rate[:, 0]


def _overtakes(run: NetRun, tank: Tank) -> bool:
    """Whether the carriage is faster than the crests, so that it sees them backwards."""
    assert run.period is not None
    omega = 2.0 * math.pi / run.period
    return run.speed > omega / float(wave_number(omega, tank.water_depth, tank.gravity))


def _irregular(run: NetRun, tank: Tank, time: Array, signal: Array) -> PanelFlow:
    if run.velocity is not None:
        rate = acceleration_of(signal[:, None], float(time[1] - time[0]))[:, 0]
        return PanelFlow(time, signal, rate, None)
    velocity, rate = orbital_motion(
        time,
        signal,
        water_depth=tank.water_depth,
        gravity=tank.gravity,
        height=tank.panel_z,
        distance=run.distance,
        period=None,
    )
    return PanelFlow(time, velocity[:, 0], rate[:, 0], None)
