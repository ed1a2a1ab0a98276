"""Records of towed nets with coefficients that are known: noise, drift, a shaking carriage and a frame in them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.records.nets.runs import NetRun, RunKind, Specimen, Tank


@dataclass(frozen=True)
class Rig:
    """A carriage with its gauge and frame."""

    #: Samples per second [Hz].
    rate: float = 50.0
    #: C_D A of the bare frame [m2].
    frame_drag_area: float = 4e-3
    #: C_M V of the bare frame [m3].
    frame_volume: float = 2e-5
    #: [Hz].
    vibration_frequency: float = 3.0
    #: Share of critical [-].
    vibration_damping: float = 0.02
    #: Root mean square of the force it makes in the gauge [N].
    vibration_force: float = 0.15
    #: Mass on the gauge [kg]: the carriage's acceleration is the vibration's force over it.
    shaken_mass: float = 1.2
    #: Root mean square of white noise [N].
    white_noise: float = 0.02
    #: Root mean square of slow noise [N].
    slow_noise: float = 0.02
    #: Correlation time of the slow noise [s].
    slow_time: float = 1.5
    #: Lift over drag [-].
    lift_share: float = 0.0
    #: Reading of the gauge at rest [N].
    zero: float = 0.0

    def shaking(self, size: int, rng: np.random.Generator) -> Array:
        """Return the force of a lightly damped carriage that is driven by noise [N], steady from its first sample."""
        if self.vibration_force == 0.0:
            return np.zeros(size)
        step = 1.0 / self.rate
        omega = 2.0 * math.pi * self.vibration_frequency
        decay = math.exp(-self.vibration_damping * omega * step)
        turn = omega * math.sqrt(1.0 - self.vibration_damping**2) * step
        lead = int(5.0 / (self.vibration_damping * omega * step)) + 1
        drive = rng.normal(size=size + lead)
        out = np.zeros(size + lead)
        for k in range(2, out.size):
            out[k] = 2.0 * decay * math.cos(turn) * out[k - 1] - decay**2 * out[k - 2] + drive[k]
        out = out[lead:]
        return np.asarray(out * self.vibration_force / max(float(out.std()), 1e-300))

    def noise(self, size: int, rng: np.random.Generator) -> Array:
        """Return white and slow noise [N]."""
        keep = math.exp(-1.0 / (self.rate * self.slow_time))
        slow = np.empty(size)
        slow[0] = rng.normal()
        steps = rng.normal(size=size) * math.sqrt(1.0 - keep**2)
        for k in range(1, size):
            slow[k] = keep * slow[k - 1] + steps[k]
        return np.asarray(self.white_noise * rng.normal(size=size) + self.slow_noise * slow)


def towed_run(
    rig: Rig,
    tank: Tank,
    specimen: Specimen | None,
    drag: Callable[[float], float] | float,
    speed: float,
    *,
    name: str,
    rng: np.random.Generator,
    duration: float = 25.0,
    ramp: float = 3.0,
    accelerometer: bool = False,
) -> NetRun:
    """Return a run through still water: start, steady part, stop.

    Parameters
    ----------
    rig : Rig
    tank : Tank
    specimen : Specimen or None
        None tows the bare frame.
    drag : callable or float
        C_D on the twines, by Re or one number.
    speed : float
        [m/s].
    name : str
    rng : numpy Generator
    duration, ramp : float
        Of the record and of each ramp [s].
    accelerometer : bool
        Record the carriage's acceleration.
    """
    time = np.arange(round(duration * rig.rate)) / rig.rate
    course = speed * np.clip(np.minimum(time / ramp, (duration - time) / ramp), 0.0, 1.0)
    area = rig.frame_drag_area
    if specimen is not None:
        number = speed * specimen.net.twine_diameter / tank.viscosity
        area += (drag(number) if callable(drag) else drag) * specimen.projected_area
    force = 0.5 * tank.density * area * course**2
    shaken = rig.shaking(time.size, rng)
    return NetRun(
        name=name,
        net="" if specimen is None else specimen.name,
        kind="still_water",
        time=time,
        force=force + rig.zero + rig.noise(time.size, rng) + shaken,
        lift=rig.lift_share * force + rig.noise(time.size, rng),
        speed=speed,
        speed_record=course * (1.0 + 0.003 * rng.normal(size=time.size)),
        acceleration=shaken / rig.shaken_mass if accelerometer else None,
    )


def wave_run(
    rig: Rig,
    tank: Tank,
    specimen: Specimen | None,
    drag: float,
    inertia: float,
    *,
    name: str,
    height: float,
    period: float,
    rng: np.random.Generator,
    speed: float = 0.0,
    following: bool = False,
    duration: float = 30.0,
    meter: bool = True,
    accelerometer: bool = False,
    meter_noise: float = 0.0,
) -> NetRun:
    """Return a run in regular waves, at rest or under way.

    Parameters
    ----------
    rig, tank, specimen : Rig, Tank, Specimen or None
        As in :func:`towed_run`.
    drag, inertia : float
        C_D and C_M of the net [-].
    name : str
    height, period : float
        Of the waves at rest [m], [s].
    rng : numpy Generator
    speed : float
        Of towing [m/s]; 0 leaves waves alone.
    following : bool
        Waves run with the carriage.
    duration : float
        [s].
    meter : bool
        Record the velocity on the carriage; otherwise the surface.
    accelerometer : bool
        Record the carriage's acceleration.
    meter_noise : float
        Root mean square of the meter's noise [m/s].
    """
    from moyai.sea.dispersion import wave_number
    from moyai.sea.kinematics import depth_functions

    time = np.arange(round(duration * rig.rate)) / rig.rate
    omega = 2.0 * math.pi / period
    k = float(wave_number(omega, tank.water_depth, tank.gravity))
    # phase at a panel that moves against the waves (head) or with them
    place = (1.0 if following else -1.0) * speed * time
    phase = k * place - omega * time + rng.uniform(0.0, 2.0 * math.pi)
    horizontal, _, _ = depth_functions(np.array([k]), tank.water_depth, tank.panel_z)
    amplitude = 0.5 * height * omega * float(horizontal[0])
    sense = -1.0 if following else 1.0
    velocity = speed + sense * amplitude * np.cos(phase)
    # of the water, at a fixed place: omega whatever the speed of towing
    rate = sense * amplitude * omega * np.sin(phase)
    area, volume = rig.frame_drag_area, rig.frame_volume
    if specimen is not None:
        area += drag * specimen.projected_area
        volume += inertia * specimen.volume
    force = tank.density * volume * rate + 0.5 * tank.density * area * velocity * np.abs(velocity)
    shaken = rig.shaking(time.size, rng)
    kind: RunKind = "towing_waves" if speed > 0.0 else "waves"
    return NetRun(
        name=name,
        net="" if specimen is None else specimen.name,
        kind=kind,
        time=time,
        force=force + rig.zero + rig.noise(time.size, rng) + shaken,
        lift=rig.lift_share * force + rig.noise(time.size, rng),
        speed=speed,
        velocity=velocity + meter_noise * rng.normal(size=time.size) if meter else None,
        elevation=None if meter else 0.5 * height * np.cos(phase),
        acceleration=shaken / rig.shaken_mass if accelerometer else None,
        period=period,
        following=following,
    )
