"""Coefficients of Morison's equation from records of force and velocity, with what can be known of them."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass, field, replace

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.records.forces.fit import (
    METHODS,
    Coefficient,
    ForceFit,
    Setup,
    fit_component,
    force_columns,
    other_columns,
)
from moyai.records.forces.notices import (
    collinear_notices,
    drag_form_notices,
    harmonic_notices,
    implausible_notices,
    periodicity_notices,
    unknown_notices,
)
from moyai.records.forces.record import ForceRecord, acceleration_of, noise_cut, period_of, without_noise

#: Share of noise in the variance of a derivative from which it is cut off, and that may be left
NOISE_REPORTED, NOISE_LEFT = 0.01, 0.02


@dataclass(frozen=True, eq=False)
class Identification:
    """Everything that a record gave."""

    #: The part that was used: whole periods of a regular record.
    record: ForceRecord
    setup: Setup
    #: Period, or mean period of an irregular record [s].
    period: float
    #: [m/s2].
    acceleration: Array
    #: [m/s]; shape (components,).
    velocity_amplitude: Array
    #: u T / b of every component, b its width.
    keulegan_carpenter: tuple[float, ...]
    fits: tuple[ForceFit, ...]
    #: Independent blocks behind the intervals.
    blocks: int
    notices: tuple[Notice, ...] = field(default=())

    def fit(self, method: str, component: int = 0) -> ForceFit:
        """Return the fit by one method of one component.

        Parameters
        ----------
        method : str
            Its name.
        component : int
            Number of the component of the force.

        Raises
        ------
        InputError
            When there is none.
        """
        for entry in self.fits:
            if entry.method == method and entry.component == component:
                return entry
        raise InputError(f"no fit by '{method}' of component {component}", parameter="method")


def identify(record: ForceRecord, setup: Setup) -> Identification:
    """Find C_M and C_D of every component by every method asked for.

    Parameters
    ----------
    record : ForceRecord
        Force and velocity at equal times.
    setup : Setup
        Water, section, widths and methods.

    Returns
    -------
    Identification
        Coefficients with their intervals by method and component.

    Raises
    ------
    InputError
        When the record is shorter than a period, too coarse or does not repeat itself with its period, or the widths
        do not match its components.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.records import ForceRecord, Setup, identify
    >>> time, omega = np.arange(0.0, 10.0, 0.02), 2.0 * np.pi
    >>> velocity, rate = 0.1 * np.cos(omega * time), -0.1 * omega * np.sin(omega * time)
    >>> force = 1000.0 * 0.0016 * 1.7 * rate + 500.0 * 0.045 * 1.3 * velocity * abs(velocity)
    >>> setup = Setup(density=1000.0, area=0.0016, widths=(0.045,), period=1.0, methods=("least_squares",))
    >>> found = identify(ForceRecord(time, force, velocity, rate), setup).fit("least_squares")
    >>> round(found.inertia.value, 3), round(found.drag.value, 3)
    (1.7, 1.3)
    """
    if len(setup.widths) != record.components:
        raise InputError(
            f"{len(setup.widths)} widths for {record.components} components",
            parameter="widths",
            allowed="one a component",
        )
    if setup.form == "vector" and record.components < 2:
        raise InputError("the vector form needs two components", parameter="form", allowed="component")
    record, notices = (record, []) if setup.regular else _clean(record)
    if setup.period is not None:
        period = setup.period
    else:
        period = period_of(record.time, record.velocity) if setup.regular else _mean_period(record)
    used = _whole_periods(record, period, setup.regular)
    omega = 2.0 * math.pi / period
    per_period = period / used.step
    rate = used.acceleration
    orders = int(min(6, max(1, (per_period - 1) // 2)))
    notices += periodicity_notices(used, period, orders) if setup.regular else []
    if rate is None:
        rate = acceleration_of(used.velocity, used.step, omega if setup.regular else None, orders)
    blocks = _blocks(used, period, setup.regular)
    rng = np.random.default_rng(setup.seed)
    fits: list[ForceFit] = []
    for component in range(used.components):
        columns = force_columns(used, rate, setup, component)
        for method in setup.methods:
            fit = fit_component(used, columns, rate, setup, component, method, omega, blocks, rng)
            fits.append(fit)
            notices.extend(collinear_notices(fit))
            if setup.regular and method != "fourier":
                notices.extend(harmonic_notices(fit, used, omega))
    notices += unknown_notices(fits) + implausible_notices(fits, setup)
    if turning := drag_form_notices(used, rate, setup):
        # the harmonics that this leaves over are no fault of the record
        notices = [*turning, *(notice for notice in notices if notice.code != "identification-harmonics")]
    speeds = velocity_amplitudes(used, period, orders if setup.regular else None)
    numbers = tuple(float(speed * period / width) for speed, width in zip(speeds, setup.widths))
    if len(blocks) < 8:
        notices.append(
            Notice(
                "few-periods",
                f"the record holds {len(blocks)} independent blocks; intervals from so few are wide and rough",
                value=len(blocks),
                limit=8,
                remedy="use a longer record",
            )
        )
    unique = {notice.message: notice for notice in notices}
    return Identification(used, setup, period, rate, speeds, numbers, tuple(fits), len(blocks), tuple(unique.values()))


def _clean(record: ForceRecord) -> tuple[ForceRecord, list[Notice]]:
    """Return a record of irregular waves with the noise of its velocity cut off, and what there is to say."""
    velocity = record.velocity.copy()
    notices: list[Notice] = []
    for component in range(record.components):
        cut = noise_cut(velocity[:, component], record.force[:, component], record.step)
        if cut is None:
            notices.append(
                Notice(
                    "velocity-noise",
                    f"velocity {component + 1}: the record is too short to separate waves from noise, which would "
                    "lower "
                    "C_M by its share of the derivative",
                    remedy="use a record of 20 waves and more",
                )
            )
        elif cut.share >= NOISE_REPORTED:
            velocity[:, component] = without_noise(velocity[:, component], record.step, cut.frequency)
            if record.acceleration is not None:
                continue
            grave = cut.share_left > NOISE_LEFT
            notices.append(
                Notice(
                    "velocity-noise",
                    f"velocity {component + 1}: above {cut.frequency:.3g} Hz it has nothing in common with the force; "
                    f"{100.0 * cut.share:.2g} % of the variance of its derivative is noise, which is cut off there, "
                    f"{100.0 * cut.share_left:.2g} % are left",
                    value=cut.share_left, limit=NOISE_LEFT, severity="warning" if grave else "information",
                    remedy="C_M comes out lower by that share; give a measured 'acceleration', or a quieter gauge",
                )
            )  # fmt: skip
    return replace(record, velocity=velocity), notices


def velocity_amplitudes(record: ForceRecord, period: float, orders: int | None) -> Array:
    """Return the amplitude of every velocity component [m/s], shape (components,).

    Parameters
    ----------
    record : ForceRecord
    period : float
        [s].
    orders : int or None
        Harmonics of a periodic record: half of the way between the extremes of its mean and harmonics, so that noise
        does not add to it. None: that of the harmonic motion of equal variance.
    """
    if orders is None:
        return np.asarray(math.sqrt(2.0) * record.velocity.std(axis=0))
    design = other_columns(record, range(1, orders + 1), True, 2.0 * math.pi / period)
    fit, *_ = np.linalg.lstsq(design, record.velocity, rcond=None)
    return np.asarray(0.5 * np.ptp(design @ fit, axis=0))


def _mean_period(record: ForceRecord) -> float:
    """Return the mean zero-up-crossing period of the largest velocity component [s]."""
    values = record.velocity - record.velocity.mean(axis=0)
    values = values[:, int(np.argmax(values.std(axis=0)))]
    ups = np.flatnonzero((values[:-1] < 0.0) & (values[1:] >= 0.0))
    if ups.size < 2:
        raise InputError(
            "the record holds less than one period", parameter="time", remedy="use a longer record or give the period"
        )
    return float((ups[-1] - ups[0]) * record.step / (ups.size - 1))


def _whole_periods(record: ForceRecord, period: float, regular: bool) -> ForceRecord:
    if record.duration < period * (1.0 - 1e-6):
        raise InputError(
            f"the record of {record.duration:.4g} s is shorter than one period of {period:.4g} s",
            parameter="time",
            remedy="use a longer record or check the period",
        )
    if period / record.step < 12.0:
        raise InputError(
            f"{period / record.step:.3g} samples a period are too few for u|u|",
            parameter="time",
            allowed="at least 12",
            remedy="sample faster",
        )
    if not regular:
        return record
    count = math.floor(record.duration / period + 1e-6)
    return record.part(0, min(record.time.size, round(count * period / record.step)))


def _blocks(record: ForceRecord, period: float, regular: bool) -> list[tuple[int, int]]:
    """Return sample ranges that stand for independent pieces: periods, or two mean periods of irregular waves."""
    length = period if regular else 2.0 * period
    count = max(1, round(record.duration / length))
    edges = np.round(np.linspace(0, record.time.size, count + 1)).astype(int)
    return [(int(a), int(b)) for a, b in itertools.pairwise(edges)]


__all__ = [
    "METHODS",
    "Coefficient",
    "ForceFit",
    "ForceRecord",
    "Identification",
    "Setup",
    "identify",
]
