"""What a fit of force coefficients says of itself: what cannot be known, what may bias it, what cannot be true."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.records.forces.fit import UNKNOWN_SHARE, Coefficient, ForceFit, Setup, force_columns, other_columns
from moyai.records.forces.motion import CleanMotion
from moyai.records.forces.record import ForceRecord

#: Condition number of the scaled equations above which inertia and drag cannot be distinguished
LARGEST_CONDITION = 1e7
#: Share of the variance of a velocity outside its harmonics that is reported, and above which it is not periodic
TOLD_SHARE, APERIODIC_SHARE = 0.01, 0.5
#: Drift of a force over its range that is reported
TOLD_DRIFT = 0.05
#: Speed across over that along from which the form of drag matters [-]
TURNING_FLOW = 0.2
#: C_M over its ideal value within which measurements lie
PLAUSIBLE_INERTIA = (0.2, 3.0)


def collinear_notices(fit: ForceFit) -> list[Notice]:
    """Tell where inertia and drag cannot be distinguished."""
    if fit.condition <= LARGEST_CONDITION:
        return []
    return [
        Notice(
            "identification-collinear",
            f"{_place(fit)}: inertia and drag cannot be distinguished, condition number {fit.condition:.2g}",
            value=fit.condition,
            limit=LARGEST_CONDITION,
            severity="error",
        )
    ]


def unknown_notices(fits: Sequence[ForceFit]) -> list[Notice]:
    """Tell which coefficients cannot be known, one message for every coefficient of a component."""
    notices = []
    for component in sorted({fit.component for fit in fits}):
        own = [fit for fit in fits if fit.component == component]
        for name, key, other in (("C_M", "inertia", "smaller"), ("C_D", "drag", "larger")):
            shares = {fit.method: _share(getattr(fit, key)) for fit in own if not getattr(fit, key).known}
            if not shares:
                continue
            least = min(shares.values())
            size = f"at least {100.0 * least:.0f} % of it" if least < 10.0 else "more than ten times as large"
            by = "" if len(shares) == len(own) else " by " + ", ".join(method.replace("_", " ") for method in shares)
            notices.append(
                Notice(
                    "identification-unknown",
                    f"component {component + 1}: {name} cannot be known from this record{by}, its uncertainty is "
                    f"{size}",
                    value=least,
                    limit=UNKNOWN_SHARE,
                    remedy=f"use a longer record, a {other} Keulegan-Carpenter number, or a smaller phase error",
                )
            )
    return notices


def implausible_notices(fits: Sequence[ForceFit], setup: Setup) -> list[Notice]:
    """Tell of coefficients that no member shows: columns exchanged, a wrong sign, unit or length."""
    notices: dict[tuple[int, str], Notice] = {}
    remedy = "check columns, signs and units, and whether the force is per length"
    for fit in fits:
        if fit.drag.known and fit.drag.value < 0.0:
            text = f"component {fit.component + 1}: C_D = {fit.drag.value:.2g} is negative: the drag drives the flow"
            notices.setdefault(
                (fit.component, "drag"),
                Notice("identification-implausible", text, value=fit.drag.value, limit=0.0, remedy=remedy),
            )
        ideal = 2.0 if setup.ideal_inertia is None else setup.ideal_inertia[fit.component]
        low, high = (limit * ideal for limit in PLAUSIBLE_INERTIA)
        if fit.inertia.known and not low <= fit.inertia.value <= high:
            text = (
                f"component {fit.component + 1}: C_M = {fit.inertia.value:.2g} lies far from the ideal {ideal:.3g} "
                "of the section"
            )
            limit = low if fit.inertia.value < low else high
            notices.setdefault(
                (fit.component, "inertia"),
                Notice("identification-implausible", text, value=fit.inertia.value, limit=limit, remedy=remedy),
            )
    return list(notices.values())


def periodicity_notices(record: ForceRecord, period: float, orders: int) -> list[Notice]:
    """Compare the velocity with mean and harmonics of the period.

    Raises
    ------
    InputError
        When half of the variance lies outside: the record does not repeat itself with this period.
    """
    design = other_columns(record, range(1, orders + 1), True, 2.0 * math.pi / period)
    fit, *_ = np.linalg.lstsq(design, record.velocity, rcond=None)
    variance = np.var(record.velocity, axis=0)
    outside = np.var(record.velocity - design @ fit, axis=0) / variance
    notices = []
    for component, share in enumerate(outside):
        # a component that hardly moves may be nothing but noise
        if share > APERIODIC_SHARE and variance[component] > APERIODIC_SHARE * variance.max():
            raise InputError(
                f"velocity {component + 1} does not repeat itself every {period:.4g} s: {100.0 * share:.0f} % of its "
                "variance lies outside mean and harmonics",
                parameter="period",
                remedy="check the period, or give 'regular: false' for irregular waves",
            )
        if share > TOLD_SHARE:
            notices.append(
                Notice(
                    "identification-aperiodic-velocity",
                    f"{100.0 * share:.2g} % of the variance of velocity {component + 1} lies outside mean and "
                    f"harmonics of {period:.4g} s: noise, which is left out, or a wrong period or irregular waves, "
                    "which bias C_D",
                    value=float(share),
                    limit=TOLD_SHARE,
                    remedy="check the period",
                )
            )
    return notices


def drift_notices(fits: Sequence[ForceFit]) -> list[Notice]:
    """Report the straight line that was fitted with the mean, where it is not small against the force."""
    notices = []
    for fit in fits:
        share = abs(fit.drift) / max(float(np.ptp(fit.force)), 1e-300)
        if share < TOLD_DRIFT or fit.method != fits[0].method:
            continue
        notices.append(
            Notice(
                "identification-drift",
                f"force {fit.component + 1} drifts by {fit.drift:.3g} N/m over the record, {100.0 * share:.2g} % of "
                "its range; a straight line is fitted with the mean",
                value=share,
                limit=TOLD_DRIFT,
                severity="information",
                remedy="check the gauge; a drift that is not straight is in the intervals only as noise",
            )
        )
    return notices


def drag_form_notices(record: ForceRecord, motion: CleanMotion, setup: Setup) -> list[Notice]:
    """Report a flow that turns, fitted by each axis with its own speed alone, where the common speed explains more.

    In a circular orbit the common speed is steady, and the drag of one axis is 3 pi/8 of that with its own speed.
    """
    if setup.form != "component" or record.components < 2:
        return []
    spread = motion.velocity.std(axis=0)
    ratio = float(spread.min()) / max(float(spread.max()), 1e-300)
    if ratio < TURNING_FLOW:
        return []
    own, common = (_unexplained(record, motion, replace(setup, form=form)) for form in ("component", "vector"))
    if common >= own:
        return []
    return [
        Notice(
            "identification-drag-form",
            f"the flow turns, its speed across is {ratio:.2g} of that along; drag u|u| of each axis leaves the common "
            "speed out, and C_D comes out up to 18 % high",
            value=ratio,
            limit=TURNING_FLOW,
            remedy="give 'drag_form: vector'",
            source="8/(3 pi) of a circular orbit",
        )
    ]


def _unexplained(record: ForceRecord, motion: CleanMotion, setup: Setup) -> float:
    """Return the variance that inertia, drag and a mean leave of the forces, over theirs, summed over components."""
    left = 0.0
    for component in range(record.components):
        columns = np.column_stack([force_columns(motion, setup, component), np.ones(record.time.size)])
        force = record.force[:, component]
        answer, *_ = np.linalg.lstsq(columns, force, rcond=None)
        left += float(np.var(force - columns @ answer)) / max(float(np.var(force)), 1e-300)
    return left


def harmonic_notices(fit: ForceFit, record: ForceRecord, omega: float) -> list[Notice]:
    """Tell of harmonics in the residual: they repeat in every period, so that no interval shows what they do."""
    orders = (2, 3)
    design = other_columns(record, orders, False, omega)
    part, *_ = np.linalg.lstsq(design, fit.residual, rcond=None)
    share = float(np.var(design @ part)) / max(float(np.var(fit.residual)), 1e-300)
    size = float(np.std(design @ part)) / max(float(np.std(fit.force)), 1e-300)
    # noise alone leaves a share of about twice the number of fitted terms over that of samples
    if share < max(0.1, 8.0 * design.shape[1] / len(design)) or size < 1e-6:
        return []
    return [
        Notice(
            "identification-harmonics",
            f"{_place(fit)}: second and third harmonic make {100.0 * share:.0f} % of the residual; they may shift the "
            "coefficients beyond their intervals",
            value=share,
            limit=0.1,
            remedy="give 'harmonics: [2, 3]', or use the Fourier method",
        )
    ]


def _place(fit: ForceFit) -> str:
    return f"component {fit.component + 1}, {fit.method.replace('_', ' ')}"


def _share(coefficient: Coefficient) -> float:
    return coefficient.uncertainty / abs(coefficient.value) if coefficient.value else math.inf
