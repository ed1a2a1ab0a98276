"""Nets towed through still water: C_D and C_L of the twines with what is known of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.records.nets.runs import NetRun, Specimen, Tank
from moyai.records.nets.steady import Mean, correlated_mean, steady_window, zero_error
from moyai.records.nets.vibration import Vibration, low_pass, remove_band, shaken_mass
from moyai.series.intervals import student_quantile

#: Frequency of the low-pass filter of steady tows [Hz]
LOW_PASS = 1.0
#: Speeds that differ by less are those of one condition
SAME_SPEED = 0.05


@dataclass(frozen=True, eq=False)
class Tow:
    """The steady part of one still-water run."""

    run: NetRun
    #: Steady part [s].
    window: tuple[float, float]
    #: [m/s].
    speed: Mean
    #: Mean force [N].
    force: Mean
    #: Mean lift [N]; None where it was not measured.
    lift: Mean | None
    #: Force over the whole record, without the vibration [N].
    clean: Array
    #: Its low-passed course [N].
    slow: Array
    #: Mass whose inertia force was subtracted [kg]; NaN where the band was stopped instead.
    mass: float = math.nan


@dataclass(frozen=True)
class TowCoefficients:
    """What a net's run gave."""

    run: str
    net: str
    #: [m/s].
    speed: float
    #: U d / nu [-].
    reynolds: float
    #: Subtracted [N].
    frame_force: float
    #: C_D on the twines [-].
    drag: float
    #: Half of the interval of C_D [-].
    drag_half_width: float
    #: Standard error of C_D [-].
    drag_error: float
    #: Effective degrees of freedom.
    freedom: float
    #: C_L on the same area [-]; NaN where it was not measured.
    lift: float
    #: Half of the interval of C_L [-]; NaN where it was not measured.
    lift_half_width: float


def clean_force(run: NetRun, values: Array, vibration: Vibration | None) -> tuple[Array, float]:
    """Return a force without the vibration, and the mass that was subtracted with the acceleration (NaN without)."""
    if vibration is None:
        return values, math.nan
    if run.acceleration is not None:
        found = shaken_mass(run.step, values, run.acceleration, vibration)
        shaken = run.acceleration - run.acceleration.mean()
        return np.asarray(values - found.mass * shaken), found.mass
    return remove_band(run.step, values, vibration), math.nan


def measure_tow(run: NetRun, vibration: Vibration | None, confidence: float) -> Tow:
    """Return the steady means of a still-water run.

    Parameters
    ----------
    run : NetRun
    vibration : Vibration or None
        Taken out first.
    confidence : float

    Raises
    ------
    InputError
        When no stretch is steady.
    """
    force = run.zeroed()
    clean, mass = clean_force(run, force, vibration)
    slow = low_pass(run.step, clean, LOW_PASS)
    window = run.window
    if window is None:
        by_speed = run.speed_record is not None
        signal = run.speed_record if run.speed_record is not None else slow
        try:
            window = steady_window(run.time, signal, is_speed=by_speed)
        except InputError as error:
            raise InputError(
                f"run {run.name}: {error.fault.message}", parameter="window", remedy=error.fault.remedy
            ) from None
    part = run.part(window)
    if int(part.sum()) < 16:
        raise InputError(
            f"run {run.name}: {int(part.sum())} samples in the steady window", parameter="window", allowed="at least 16"
        )
    if run.speed_record is not None:
        speed = correlated_mean(run.speed_record[part], confidence)
    else:
        speed = Mean(run.speed, 0.0, math.inf, 0.0)
    lift = None if run.lift is None else correlated_mean(low_pass(run.step, run.lift, LOW_PASS)[part], confidence)
    mean = correlated_mean(slow[part], confidence)
    if run.zero is not None:
        # the reading at rest carries the same noise as the force
        spread = math.hypot(mean.error, zero_error(clean[part], int(run.part(run.zero).sum())))
        mean = Mean(mean.value, spread, mean.freedom, student_quantile(confidence, mean.freedom) * spread)
    return Tow(run, window, speed, mean, lift, clean, slow, mass)


@dataclass(frozen=True)
class FrameLaw:
    """Force on the bare frame by its speed [eq:net-frame]."""

    #: Of its runs, speed rising [m/s].
    speeds: tuple[float, ...]
    #: Mean forces of its runs, speed rising [N].
    forces: tuple[float, ...]
    #: Their standard errors [N].
    errors: tuple[float, ...]
    names: tuple[str, ...]

    def at(self, speed: float, name: str = "") -> tuple[float, float, float]:
        """Return force, standard error [N] and how far the nearest run's speed lies away, relative.

        A run named, or of about the same speed, is scaled by the square of the speeds; between two runs the force over
        the square of the speed is interpolated, beyond them that of the last is kept.
        """
        quadratic = np.array(self.forces) / np.square(self.speeds)
        spread = np.array(self.errors) / np.square(self.speeds)
        known = np.array(self.speeds)
        if name in self.names:
            k = self.names.index(name)
            return float(quadratic[k] * speed**2), float(spread[k] * speed**2), abs(known[k] / speed - 1.0)
        away = np.abs(known / speed - 1.0)
        near = away <= SAME_SPEED
        if near.any():
            mean = float(quadratic[near].mean())
            error = float(np.sqrt(np.sum(spread[near] ** 2))) / int(near.sum())
            return mean * speed**2, error * speed**2, float(away.min())
        logs = np.log(known)
        mean = float(np.interp(math.log(speed), logs, quadratic))
        error = float(np.interp(math.log(speed), logs, spread))
        return mean * speed**2, error * speed**2, float(away.min())


def frame_law(tows: Sequence[Tow]) -> FrameLaw | None:
    """Return the law of the bare frame's force, ``None`` without runs of it."""
    if not tows:
        return None
    ordered = sorted(tows, key=lambda tow: tow.speed.value)
    return FrameLaw(
        tuple(tow.speed.value for tow in ordered),
        tuple(tow.force.value for tow in ordered),
        tuple(tow.force.error for tow in ordered),
        tuple(tow.run.name for tow in ordered),
    )


def tow_coefficients(
    tow: Tow, specimen: Specimen, tank: Tank, frame: FrameLaw | None, confidence: float, calibration: float
) -> tuple[TowCoefficients, tuple[Notice, ...]]:
    """Return C_D = 2 (F - F_frame) / (rho A U^2) and its interval [eq:net-tow-drag].

    Parameters
    ----------
    tow : Tow
    specimen : Specimen
    tank : Tank
    frame : FrameLaw or None
    confidence : float
    calibration : float
        Relative standard error of the gauge, common to all runs [-].
    """
    speed, notices = tow.speed.value, []
    carried, carried_error, away = (0.0, 0.0, 0.0) if frame is None else frame.at(speed, tow.run.frame)
    if frame is not None and away > SAME_SPEED:
        notices.append(
            Notice(
                "net-frame-speed",
                f"run {tow.run.name}: no run of the bare frame within {100 * SAME_SPEED:.0f} % of {speed:.3g} m/s; its "
                "force is interpolated by the square of the speed",
                away,
                SAME_SPEED,
                "information",
                "tow the bare frame at this speed",
            )
        )
    force = tow.force.value - carried
    head = 0.5 * tank.density * specimen.projected_area * speed**2
    error = math.hypot(tow.force.error, carried_error)
    # speed and calibration enter in proportion
    share = math.hypot(2.0 * tow.speed.error / speed, calibration)
    total = math.hypot(error / head, share * force / head)
    freedom = tow.force.freedom
    drag = force / head
    lift = lift_half = math.nan
    if tow.lift is not None:
        lift, lift_half = tow.lift.value / head, tow.lift.half_width / head
    if drag <= 0.0:
        against = tow.force.value < 0.0 and carried <= 0.0
        notices.append(
            Notice(
                "net-drag-against",
                f"run {tow.run.name}: the force, {tow.force.value:.3g} N, points against the water",
                tow.force.value,
                0.0,
                "error",
                "give 'reverse_force: true' where the gauge has the opposite sign",
            )
            if against
            else Notice(
                "net-drag-negative",
                f"run {tow.run.name}: the force on net and frame, {tow.force.value:.3g} N, does not exceed that on the "
                f"bare frame, {carried:.3g} N",
                drag,
                0.0,
                "warning",
                "check signs, zero reading and the frame's run",
            )
        )
    coefficients = TowCoefficients(
        run=tow.run.name,
        net=specimen.name,
        speed=speed,
        reynolds=speed * specimen.net.twine_diameter / tank.viscosity,
        frame_force=carried,
        drag=drag,
        drag_half_width=student_quantile(confidence, freedom) * total,
        drag_error=total,
        freedom=freedom,
        lift=lift,
        lift_half_width=lift_half,
    )
    return coefficients, tuple(notices)
