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
)
from moyai.records.forces.motion import irregular_motion, regular_motion
from moyai.records.forces.notices import (
    collinear_notices,
    drag_form_notices,
    drift_notices,
    harmonic_notices,
    implausible_notices,
    periodicity_notices,
    unknown_notices,
)
from moyai.records.forces.record import ForceRecord, NoiseCut, noise_cut, period_of

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
    notices: list[Notice] = []
    if not setup.regular:
        cut = _cuts(record, notices)
        motion = irregular_motion(record, cut)
        record = replace(
            record,
            velocity=np.column_stack(
                [motion.filtered(record.velocity[:, component], component) for component in range(record.components)]
            ),
        )
    if setup.period is not None:
        period = setup.period
    else:
        period = period_of(record.time, record.velocity) if setup.regular else _mean_period(record)
    used = _whole_periods(record, period, setup.regular)
    omega = 2.0 * math.pi / period
    per_period = period / used.step
    orders = int(min(6, max(1, (per_period - 1) // 2)))
    blocks = _blocks(used, period, setup.regular)
    if setup.regular:
        notices += periodicity_notices(used, period, orders)
        motion = regular_motion(used, omega, orders, blocks)
    rng = np.random.default_rng(setup.seed)
    fits: list[ForceFit] = []
    for component in range(used.components):
        for method in setup.methods:
            fit = fit_component(used, motion, setup, component, method, omega, blocks, rng)
            fits.append(fit)
            notices.extend(collinear_notices(fit))
            if setup.regular and method != "fourier":
                notices.extend(harmonic_notices(fit, used, omega))
    notices += unknown_notices(fits) + implausible_notices(fits, setup) + drift_notices(fits)
    if turning := drag_form_notices(used, motion, setup):
        # the harmonics that this leaves over are no fault of the record
        notices = [*turning, *(notice for notice in notices if notice.code != "identification-harmonics")]
    # of regular waves half of the way between the extremes, of irregular ones the harmonic motion of equal variance
    speeds = 0.5 * np.ptp(motion.velocity, axis=0) if setup.regular else math.sqrt(2.0) * used.velocity.std(axis=0)
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
    return Identification(
        used, setup, period, motion.rate, speeds, numbers, tuple(fits), len(blocks), tuple(unique.values())
    )


def _cuts(record: ForceRecord, notices: list[Notice]) -> tuple[NoiseCut | None, ...]:
    """Return where noise is cut off the velocities of irregular waves, and add what there is to say."""
    cuts: list[NoiseCut | None] = []
    for component in range(record.components):
        cut = noise_cut(record.velocity[:, component], record.force[:, component], record.step)
        cuts.append(cut if cut is not None and cut.share >= NOISE_REPORTED else None)
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
        elif cut.share >= NOISE_REPORTED and record.acceleration is None:
            grave = cut.share_left > NOISE_LEFT
            notices.append(
                Notice(
                    "velocity-noise",
                    f"velocity {component + 1}: above {cut.frequency:.3g} Hz it has nothing in common with the force; "
                    f"{100.0 * cut.share:.2g} % of the variance of its derivative is noise, which is cut off there, "
                    f"{100.0 * cut.share_left:.2g} % are left",
                    value=cut.share_left, limit=NOISE_LEFT, severity="warning" if grave else "information",
                    remedy="C_M is raised by that share, as white noise lowers it; give a measured 'acceleration', or "
                    "a quieter gauge",
                )
            )  # fmt: skip
    return tuple(cuts)


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
