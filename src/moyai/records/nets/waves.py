"""Nets in waves, at rest or towed: C_D and C_M by least squares over the record, the frame's share subtracted."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.records.forces.identification import ForceFit, ForceRecord, Identification, Setup, identify
from moyai.records.nets.flow import PanelFlow, settled, wave_flow
from moyai.records.nets.runs import NetRun, Specimen, Tank
from moyai.records.nets.steady import correlated_covariance, zero_error
from moyai.records.nets.vibration import Vibration, remove_band, shaken_mass
from moyai.series.intervals import student_quantile

#: Half width over coefficient above which a coefficient is not given
UNKNOWN_SHARE = 0.5
#: Rounds of model and filter
_ROUNDS = 4


@dataclass(frozen=True, eq=False)
class WaveFit:
    """A record in waves with its fit."""

    run: NetRun
    #: Over the samples that the fit used.
    flow: PanelFlow
    #: Measured, without the vibration [N].
    force: Array
    #: As measured [N].
    raw: Array
    #: Of the whole force, frame included, on the areas of the net.
    found: Identification
    #: Mass whose inertia force was subtracted [kg]; NaN where the band was stopped.
    mass: float
    notices: tuple[Notice, ...]

    @property
    def fit(self) -> ForceFit:
        """Least-squares fit."""
        return self.found.fit("least_squares")


@dataclass(frozen=True, eq=False)
class WaveCoefficients:
    """What a net's record in waves gave."""

    run: str
    net: str
    kind: str
    #: Largest speed times d / nu [-].
    reynolds: float
    #: Amplitude of the wave's velocity times its period over d [-].
    keulegan_carpenter: float
    #: Amplitude of the velocity [m/s].
    velocity_amplitude: float
    #: Mean velocity [m/s].
    mean_velocity: float
    #: As met [s].
    period: float
    #: C_D on the area of the twines [-].
    drag: float
    #: C_M on the volume of the twines [-].
    inertia: float
    #: Half of the interval of the drag coefficient [-].
    drag_half_width: float
    #: Half of the interval of the inertia coefficient [-].
    inertia_half_width: float
    #: Standard error of the drag coefficient [-].
    drag_error: float
    #: Standard error of the inertia coefficient [-].
    inertia_error: float
    #: Correlation of both coefficients [-].
    correlation: float
    #: Whether the interval of the drag coefficient is narrower than half of it.
    drag_known: bool
    #: The same of the inertia coefficient.
    inertia_known: bool
    #: C_D A and C_M V of the frame that were subtracted [m2].
    frame_drag_area: float
    #: C_D A and C_M V of the frame that were subtracted [m3].
    frame_inertia_volume: float
    #: Share of the variance of the whole force that the fit explains.
    explained: float
    #: C_L by the root mean square of lift and of u^2 [-]; NaN without lift.
    lift_amplitude: float
    #: Root mean square of the lift over that of the drag force [-]; NaN without lift.
    lift_share: float
    #: Instants of the record [s].
    time: Array
    #: Velocity of the record [m/s].
    velocity: Array
    #: Force of the record with that of the frame taken off [N].
    force: Array
    #: Force by the fit [N].
    modelled: Array
    #: Force as measured [N].
    raw: Array


def fit_waves(
    run: NetRun,
    tank: Tank,
    area: float,
    volume: float,
    vibration: Vibration | None,
    *,
    confidence: float,
    phase_error: float,
    bootstrap: int,
    seed: int,
) -> WaveFit:
    """Return the least-squares fit of the whole force, frame included, on given areas [eq:net-wave-fit].

    Parameters
    ----------
    run : NetRun
    tank : Tank
    area, volume : float
        Areas that C_D and C_M refer to [m2], [m3].
    vibration : Vibration or None
        Taken out of the force without shifting phases or harmonics.
    confidence : float
    phase_error : float
        Standard error of the phase between force and velocity [rad].
    bootstrap, seed : int
        Of the intervals.
    """
    run = settled(run)
    part = run.part(run.window)
    flow, notices = wave_flow(run, tank, part)
    raw = run.zeroed()[part]
    clean, mass = raw, math.nan
    setup = Setup(
        density=tank.density,
        area=volume,
        widths=(area,),
        period=flow.encounter,
        regular=run.regular,
        methods=("least_squares",),
        # under way the mean force is part of the drag; at rest it is the zero of the gauge
        mean=run.kind == "waves",
        phase_error=phase_error,
        confidence=confidence,
        bootstrap=bootstrap,
        seed=seed,
    )

    def identified(force: Array) -> Identification:
        record = ForceRecord(flow.time, force, flow.velocity, flow.acceleration)
        try:
            return identify(record, setup)
        except InputError as error:
            raise InputError(
                f"run {run.name}: {error.fault.message}", parameter=error.fault.path, remedy=error.fault.remedy
            ) from None

    if vibration is not None and run.acceleration is not None:
        shaken = run.acceleration[part]
        mass = shaken_mass(run.step, raw, shaken, vibration).mass
        clean = raw - mass * (shaken - shaken.mean())
    found = identified(clean)
    if vibration is not None and run.acceleration is None:
        clean = _without_band(run.step, raw, found, vibration)
        found = identified(clean)
    size = found.record.time.size
    cut = PanelFlow(flow.time[:size], flow.velocity[:size], flow.acceleration[:size], flow.encounter)
    return WaveFit(run, cut, clean[:size], raw[:size], found, mass, tuple(notices))


def _without_band(step: float, raw: Array, found: Identification, vibration: Vibration) -> Array:
    """Return a force without a vibration, what drag and inertia explain left whole.

    Model and filter take turns: the model keeps its part of the band, its third harmonic above all, and only the rest
    is filtered. The fixed point is the least-squares fit on all frequencies but those of the band.
    """
    size, setup = found.record.time.size, found.setup
    u, a = found.record.velocity[:, 0], found.acceleration[:, 0]
    columns = [setup.density * setup.area * a, 0.5 * setup.density * setup.widths[0] * u * np.abs(u)]
    if setup.mean:
        columns.append(np.ones(size))
    scale = np.array([float(np.linalg.norm(column)) or 1.0 for column in columns])
    design = np.column_stack(columns) / scale
    inverse = np.linalg.pinv(design)
    modelled = found.fit("least_squares").force
    clean = raw[:size]
    for _ in range(_ROUNDS):
        clean = modelled + remove_band(step, raw[:size] - modelled, vibration)
        modelled = design @ (inverse @ clean)
    return np.concatenate([clean, raw[size:]])


def wave_coefficients(
    whole: WaveFit, frame: WaveFit | None, specimen: Specimen, tank: Tank, confidence: float, calibration: float
) -> tuple[WaveCoefficients, tuple[Notice, ...]]:
    """Return the coefficients of the net: those of the whole less those of the frame on the same areas.

    Parameters
    ----------
    whole, frame : WaveFit
        Of net and frame, and of the bare frame in the same waves, both on the areas of the specimen.
    specimen : Specimen
    tank : Tank
    confidence, calibration : float
        Of the intervals; relative standard error of the gauge [-].
    """
    fit = whole.fit
    value = np.array([fit.inertia.value, fit.drag.value])
    covariance, freedom = _covariance(whole)
    carried = np.zeros(2)
    phase = np.array([fit.inertia.phase_half_width, fit.drag.phase_half_width])
    if frame is not None:
        other = frame.fit
        carried = np.array([other.inertia.value, other.drag.value])
        covariance = covariance + _covariance(frame)[0]
    value = value - carried
    covariance = covariance + np.outer(value, value) * calibration**2
    error = np.sqrt(np.diagonal(covariance))
    half = np.hypot(student_quantile(confidence, freedom) * error, phase)
    u, a = whole.flow.velocity, whole.flow.acceleration
    inertia_column = tank.density * specimen.volume * a
    drag_column = 0.5 * tank.density * specimen.projected_area * u * np.abs(u)
    other_terms = fit.force - fit.inertia.value * inertia_column - fit.drag.value * drag_column
    net_force = whole.force - other_terms - carried[0] * inertia_column - carried[1] * drag_column
    mean = float(u.mean())
    amplitude = float(whole.found.velocity_amplitude[0])
    period = whole.found.period
    known = half < UNKNOWN_SHARE * np.abs(value)
    lift_amplitude = lift_share = math.nan
    if whole.run.lift is not None:
        part = whole.run.part(whole.run.window)
        lift = whole.run.lift[part][: u.size]
        lift = lift - lift.mean()
        scale = 0.5 * tank.density * specimen.projected_area * float(np.sqrt(np.mean(u**4)))
        lift_amplitude = float(lift.std()) / scale
        lift_share = float(lift.std()) / max(float(np.std(drag_column * value[1])), 1e-300)
    coefficients = WaveCoefficients(
        run=whole.run.name,
        net=specimen.name,
        kind=whole.run.kind,
        reynolds=float(np.abs(u).max()) * specimen.net.twine_diameter / tank.viscosity,
        keulegan_carpenter=amplitude * period / specimen.net.twine_diameter,
        velocity_amplitude=amplitude,
        mean_velocity=mean,
        period=period,
        drag=float(value[1]),
        inertia=float(value[0]),
        drag_half_width=float(half[1]),
        inertia_half_width=float(half[0]),
        drag_error=float(error[1]),
        inertia_error=float(error[0]),
        correlation=float(covariance[0, 1] / (error[0] * error[1])) if (error > 0.0).all() else 0.0,
        drag_known=bool(known[1]),
        inertia_known=bool(known[0]),
        frame_drag_area=float(carried[1]) * specimen.projected_area,
        frame_inertia_volume=float(carried[0]) * specimen.volume,
        explained=fit.explained,
        lift_amplitude=lift_amplitude,
        lift_share=lift_share,
        time=whole.flow.time,
        velocity=u,
        force=net_force,
        modelled=value[0] * inertia_column + value[1] * drag_column,
        raw=whole.raw,
    )
    return coefficients, (*whole.notices, *_notices(whole, coefficients, tank))


def _covariance(fitted: WaveFit) -> tuple[Array, float]:
    """Return the covariance of C_M and C_D and its degrees of freedom.

    The bootstrap over periods takes them as independent. Slow noise is not: the autocorrelation of the residual over
    several periods is followed too, and the larger variance counts.
    """
    fit, setup = fitted.fit, fitted.found.setup
    blocks = np.asarray(fit.covariance)
    u, a = fitted.flow.velocity, fitted.flow.acceleration
    columns = [setup.density * setup.area * a, 0.5 * setup.density * setup.widths[0] * u * np.abs(u)]
    if setup.mean:
        columns.append(np.ones_like(u))
    size = np.array([float(np.linalg.norm(column)) or 1.0 for column in columns])
    gain = (np.linalg.pinv(np.column_stack(columns) / size) / size[:, None])[:2]
    steps = 4.0 * fitted.found.period / (fitted.flow.time[1] - fitted.flow.time[0])
    followed, followed_freedom = correlated_covariance(gain, fit.residual, steps)
    own, other = np.diagonal(blocks), np.diagonal(followed)
    rise = np.sqrt(np.maximum(other, own) / np.maximum(own, 1e-300))
    if fitted.run.zero is not None and not setup.mean:
        # the reading at rest shifts the whole record
        shift = zero_error(fit.residual, int(fitted.run.part(fitted.run.zero).sum())) * gain.sum(axis=1)
        blocks = blocks + np.outer(shift, shift) / np.outer(rise, rise)
    freedom = max(2.0, min(fitted.found.blocks - 1.0, followed_freedom))
    return np.asarray(blocks * np.outer(rise, rise)), freedom


def _notices(whole: WaveFit, found: WaveCoefficients, tank: Tank) -> list[Notice]:
    notices = []
    for symbol, known, value, half, remedy in (
        ("C_M", found.inertia_known, found.inertia, found.inertia_half_width, "a smaller Keulegan-Carpenter number"),
        ("C_D", found.drag_known, found.drag, found.drag_half_width, "a larger Keulegan-Carpenter number"),
    ):
        if known:
            continue
        share = half / abs(value) if value else math.inf
        notices.append(
            Notice(
                "net-coefficient-unknown",
                f"run {found.run}: {symbol} of net {found.net} cannot be known from this record, its uncertainty is "
                f"{100.0 * share:.0f} % of it"
                + (" (KC = " + f"{found.keulegan_carpenter:.0f}, drag rules the force)" if symbol == "C_M" else ""),
                share,
                UNKNOWN_SHARE,
                "information" if symbol == "C_M" else "warning",
                f"use a longer record or {remedy}",
            )
        )
    for symbol, known, value in (("C_M", found.inertia_known, found.inertia), ("C_D", found.drag_known, found.drag)):
        if known and value < 0.0:
            notices.append(
                Notice(
                    "net-coefficient-negative",
                    f"run {found.run}: {symbol} of net {found.net} is {value:.3g}: the force is against the flow",
                    value,
                    0.0,
                    "warning",
                    "check the signs of force and velocity (reverse_force), the frame's run and the phase",
                )
            )
    fastest = math.sqrt(tank.gravity * tank.water_depth)
    if whole.run.kind == "waves":
        fastest = min(fastest, tank.gravity * found.period / (2.0 * math.pi))
    if found.velocity_amplitude > fastest:
        notices.append(
            Notice(
                "net-velocity",
                f"run {found.run}: the velocity of {found.velocity_amplitude:.3g} m/s is faster than the wave, whose "
                f"crest moves at {fastest:.3g} m/s at most",
                found.velocity_amplitude,
                fastest,
                "warning",
                "check the unit in the heading of the velocity, and the water depth",
            )
        )
    kept = {"few-periods", "identification-aperiodic-velocity", "identification-collinear"}
    return notices + [
        dataclasses.replace(notice, message=f"run {found.run}: {notice.message}")
        for notice in whole.found.notices
        if notice.code in kept
    ]
