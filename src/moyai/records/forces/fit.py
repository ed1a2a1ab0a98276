"""One fit of force coefficients: the linear map from the force to C_M and C_D, its bootstrap, what can be known.

All methods are linear in the force, so that one matrix gives the coefficients, their covariance, the bootstrap and the
sensitivity to a phase error [eq:identification-gain].
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.records.forces.motion import CleanMotion
from moyai.records.forces.record import ForceRecord
from moyai.series.intervals import student_quantile

Method = Literal["fourier", "least_squares", "force_weighted", "robust"]
Form = Literal["component", "vector"]
METHODS: tuple[Method, ...] = ("fourier", "least_squares", "force_weighted", "robust")
COEFFICIENTS = ("inertia", "drag")

#: Half width of an interval over its coefficient above which the coefficient is called unknown
UNKNOWN_SHARE = 0.5
_HUBER = 1.345


@checks_words
@dataclass(frozen=True)
class Setup:
    """What the record was taken on and how it is read.

    Examples
    --------
    >>> from moyai.records import Setup
    >>> setup = Setup(density=1000.0, area=0.0079, widths=(0.1,), period=2.0)
    >>> setup.form, setup.confidence
    ('component', 0.95)
    """

    #: Of the water [kg/m3].
    density: float
    #: Of the section [m2].
    area: float
    #: Width across the flow for every component [m]: H for x, B for z.
    widths: tuple[float, ...]
    #: Of regular waves [s]; ``None`` finds it from the velocity.
    period: float | None = None
    #: Whether the record is periodic; ``fourier`` needs it.
    regular: bool = True
    #: Drag u|u| or u|U| with the speed of all components; one of "component", "vector".
    form: Form = "component"
    methods: tuple[Method, ...] = METHODS
    #: Harmonics of the force (2, 3, ...) that Morison's equation is not asked to explain: fitted next to it.
    harmonics: tuple[int, ...] = ()
    #: Whether the mean force is fitted next to it too.
    mean: bool = True
    #: Standard error of the phase between force and velocity [rad].
    phase_error: float = 0.0
    #: Probability that the intervals cover.
    confidence: float = 0.95
    #: Number of bootstrap samples.
    bootstrap: int = 400
    seed: int = 1
    #: Ideal inertia coefficients: gives the reduction and the circulation that it stands for.
    ideal_inertia: tuple[float, ...] | None = None

    def __post_init__(self) -> None:
        for name in ("density", "area"):
            if not (math.isfinite(getattr(self, name)) and getattr(self, name) > 0.0):
                raise InputError(f"{name} is {getattr(self, name):g}", parameter=name, allowed="greater than 0")
        if not self.widths or not all(math.isfinite(width) and width > 0.0 for width in self.widths):
            raise InputError(f"widths are {self.widths}", parameter="widths", allowed="greater than 0, one a component")
        if self.period is not None and not (math.isfinite(self.period) and self.period > 0.0):
            raise InputError(f"period is {self.period:g} s", parameter="period", allowed="greater than 0 s")
        if not self.methods:
            raise InputError("no method is named", parameter="methods", allowed=", ".join(METHODS))
        if not self.regular and "fourier" in self.methods:
            raise InputError(
                "the method 'fourier' needs a periodic record",
                parameter="methods",
                remedy="take it out for irregular waves",
            )
        if not self.regular and self.harmonics:
            raise InputError("an irregular record has no harmonics", parameter="harmonics", remedy="leave them out")
        if any(order < 2 for order in self.harmonics):
            raise InputError(f"harmonics are {self.harmonics}", parameter="harmonics", allowed="2 and above")
        if not 0.5 <= self.confidence < 1.0:
            raise InputError(f"confidence is {self.confidence:g}", parameter="confidence", allowed="0.5 to below 1")
        if not 50 <= self.bootstrap <= 100_000:
            raise InputError(f"{self.bootstrap} bootstrap samples", parameter="bootstrap", allowed="50 to 100000")
        if not 0.0 <= self.phase_error < 0.5:
            raise InputError(
                f"phase_error is {self.phase_error:g} rad", parameter="phase_error", allowed="0 to 0.5 rad"
            )


@dataclass(frozen=True)
class Coefficient:
    """One coefficient and what is known of it."""

    value: float
    #: Of the interval by the bootstrap over blocks, at the confidence asked for.
    half_width: float
    #: What the phase error adds, at the same confidence.
    phase_half_width: float
    #: Change per radian of phase error.
    phase_sensitivity: float
    #: Error by the rounding of the record's own numbers.
    rounding: float

    @property
    def uncertainty(self) -> float:
        """Half width with every source [-]."""
        return math.hypot(self.half_width, self.phase_half_width) + self.rounding

    @property
    def known(self) -> bool:
        """Whether the coefficient is determined: its uncertainty below half of it."""
        return math.isfinite(self.uncertainty) and self.uncertainty < UNKNOWN_SHARE * abs(self.value)

    @property
    def text(self) -> str:
        """The value with the digits that it has, and its uncertainty; a word where it has none."""
        if not math.isfinite(self.uncertainty):
            return "not determined"
        if not self.known:
            bound = abs(self.value) + self.uncertainty
            return f"not determined (size below about {bound:.1g})"
        # up to the first digit of the uncertainty, nine places at most
        place = -math.floor(math.log10(max(self.uncertainty, 1e-15 * abs(self.value))))
        if place > 9:
            return f"{self.value:.9f} +- {self.uncertainty:.0e}"
        place = max(place, 0)
        return f"{self.value:.{place}f} +- {self.uncertainty:.{place}f}"


@checks_words
@dataclass(frozen=True, eq=False)
class ForceFit:
    """One component by one method."""

    method: Method
    component: int
    inertia: Coefficient
    drag: Coefficient
    #: Of C_M and C_D, by the bootstrap; shape (2, 2).
    covariance: Array
    #: Between both.
    correlation: float
    #: Condition number of the two columns, scaled to unit length.
    condition: float
    #: Bootstrap samples; shape (bootstrap, 2).
    samples: Array
    #: Morison's force by the fit, with mean and harmonics [N/m]; shape (samples,).
    force: Array
    #: What the fit leaves of the force [N/m]; shape (samples,).
    residual: Array
    #: Rise over the record of the straight line that was fitted with it [N/m].
    drift: float
    #: Share of the variance of the force that is explained.
    explained: float
    #: Amplitude of the drag over that of the inertia force.
    drag_share: float


def force_columns(motion: CleanMotion, setup: Setup, component: int) -> Array:
    """Return rho A a and rho b u|u| / 2 of a component [eq:identification-columns]."""
    u, rate = motion.velocity[:, component], motion.rate[:, component]
    speed = np.abs(u) if setup.form == "component" else np.linalg.norm(motion.velocity, axis=1)
    return np.column_stack(
        [setup.density * setup.area * rate, 0.5 * setup.density * setup.widths[component] * u * speed]
    )


def other_columns(
    record: ForceRecord, orders: Sequence[int], mean: bool, omega: float, *, drift: bool = False
) -> Array:
    """Return what is fitted together with Morison's equation: mean, harmonics and, last, a straight line."""
    centred = record.time - record.time.mean()
    angle = omega * centred
    parts = [np.ones_like(angle)] if mean else []
    for order in orders:
        parts += [np.cos(order * angle), np.sin(order * angle)]
    parts += [centred / record.duration] if drift else []
    return np.column_stack(parts) if parts else np.zeros((angle.size, 0))


@checks_words
def fit_component(
    record: ForceRecord,
    motion: CleanMotion,
    setup: Setup,
    component: int,
    method: Method,
    omega: float,
    blocks: list[tuple[int, int]],
    rng: np.random.Generator,
) -> ForceFit:
    columns = force_columns(motion, setup, component)
    # one period cannot be told from a straight line
    drift = setup.mean and len(blocks) > 1
    others = other_columns(record, setup.harmonics, setup.mean, omega, drift=drift)
    force, known, beside = _seen(record, motion, columns, others, component)
    scale = np.linalg.norm(columns, axis=0)
    condition = float(np.linalg.cond(columns / scale)) if (scale > 0.0).all() else math.inf
    stretch = 1.0
    if method == "fourier":
        gain = _fourier_gain(record, columns, omega, drift)
        extra, *_ = np.linalg.lstsq(others, force - columns @ (gain @ force), rcond=None)
    else:
        weight = np.ones(force.size)
        design = np.hstack([known, others])
        noise = motion.noise_left(component)
        whole = _gain(known, others, weight, noise)
        for _ in range(0 if method == "least_squares" else 60):
            modelled = design @ (whole @ force)
            previous, weight = weight, _weights(method, modelled, force - modelled)
            whole = _gain(known, beside, weight, noise)
            if np.abs(weight - previous).max() < 1e-12:
                break
        gain, extra = whole[:2], whole[2:] @ force
        if method == "robust":
            # Huber's estimate answers a change of the record through the samples that are not cut off
            stretch = float(weight.mean() / np.mean(weight >= 1.0))
    found = gain @ force
    shares = _shares(stretch * gain, force - known @ found - beside @ extra, blocks)
    shares -= _shares_of_motion(gain, found, motion, setup, component)
    leverage = np.array([np.sum(gain[:, a:b] * known[a:b].T, axis=1) for a, b in blocks])
    samples, covariance = _bootstrap(shares, leverage, found, setup, rng)
    freedom = _freedom(gain, blocks)
    coefficients = _coefficients(gain, found, covariance, force, known, record.step, omega, freedom, setup)
    spread = np.sqrt(np.diagonal(covariance))
    both = float(spread[0] * spread[1])
    parts = [abs(found[k]) * 0.5 * float(np.ptp(columns[:, k])) for k in range(2)]
    modelled = columns @ found + others @ extra
    residual = record.force[:, component] - modelled
    total = float(np.var(record.force[:, component]))
    return ForceFit(
        method=method,
        component=component,
        inertia=coefficients[0],
        drag=coefficients[1],
        covariance=covariance,
        correlation=float(covariance[0, 1]) / both if both > 0.0 else 0.0,
        condition=condition,
        samples=samples,
        force=modelled,
        residual=residual,
        drift=float(extra[-1]) if drift else 0.0,
        explained=1.0 - float(np.var(residual)) / total if total > 0.0 else math.nan,
        drag_share=float(parts[1] / parts[0]) if parts[0] > 0.0 else math.inf,
    )


def _seen(
    record: ForceRecord, motion: CleanMotion, columns: Array, others: Array, component: int
) -> tuple[Array, Array, Array]:
    """Return force and columns as the fit compares them: all cut at the frequency of the velocity's noise.

    A velocity without what lies above a frequency explains a force without it [eq:identification-filtered]. The
    derivative of such a velocity is cut already.
    """
    known = motion.filtered(columns, component)
    if motion.derived:
        known = np.column_stack([columns[:, 0], known[:, 1]])
    return motion.filtered(record.force[:, component], component), known, motion.filtered(others, component)


def _gain(columns: Array, others: Array, weight: Array, noise: float) -> Array:
    """Return the matrix that takes the force to all coefficients by weighted least squares; C_M and C_D come first.

    ``noise`` is the share of noise in the first column, whose lowering is taken off [eq:identification-attenuation].
    """
    design = np.hstack([columns, others])
    size = np.linalg.norm(design, axis=0)
    root = np.sqrt(weight)[:, None]
    safe = np.where(size > 0.0, size, 1.0)
    scaled = root * design / safe
    inverse = np.linalg.pinv(scaled, rcond=1e-13)
    if noise > 0.0:
        # the normal equations without what noise adds to the square of the first column, to first order
        square = float(scaled[:, 0] @ scaled[:, 0])
        inverse = inverse + np.outer(noise * square * (inverse @ inverse[0]), inverse[0])
    return np.asarray((inverse / safe[:, None]) * root[:, 0])


def _fourier_gain(record: ForceRecord, columns: Array, omega: float, drift: bool) -> Array:
    """Return the same matrix for the first harmonics over whole periods [eq:identification-fourier].

    Both columns are analysed on the samples of the force, so that u|u| brings its own equal-work factor; it is
    8/(3 pi) of a sine.
    """
    orders = range(1, 1 + int(min(6, max(1, 2.0 * math.pi / (omega * record.step) // 2 - 1))))
    design = other_columns(record, orders, True, omega, drift=drift)
    inverse = np.linalg.pinv(design)[1:3]
    harmonic = inverse @ columns
    size = np.linalg.norm(harmonic, axis=0)
    safe = np.where(size > 0.0, size, 1.0)
    return np.asarray((np.linalg.pinv(harmonic / safe, rcond=1e-13) / safe[:, None]) @ inverse)


def _weights(method: Method, modelled: Array, residual: Array) -> Array:
    """Return weights in [0, 1]: the modelled force squared, or Huber's."""
    if method == "force_weighted":
        # the modelled, not the measured force: weights that follow the noise would bias the fit
        square = modelled**2
        return np.asarray(square / max(float(square.max()), 1e-300))
    scale = 1.4826 * float(np.median(np.abs(residual - np.median(residual))))
    if scale <= 1e-13 * float(np.abs(modelled).max()):
        return np.ones_like(residual)
    return np.asarray(np.minimum(1.0, _HUBER * scale / np.maximum(np.abs(residual), 1e-300)))


def _shares(gain: Array, residual: Array, blocks: list[tuple[int, int]]) -> Array:
    """Return what each block of the residual contributes to the coefficients; shape (blocks, 2)."""
    return np.array([gain[:, a:b] @ residual[a:b] for a, b in blocks])


def _shares_of_motion(gain: Array, found: Array, motion: CleanMotion, setup: Setup, component: int) -> Array:
    """Return what the error of the motion in each block takes from them [eq:identification-motion]."""
    velocity, measured = motion.errors
    if velocity.shape[0] == 0:
        return np.zeros(2)
    inertia = found[0] * setup.density * setup.area
    drag = found[1] * 0.5 * setup.density * setup.widths[component]
    u = motion.velocity
    if setup.form == "component":
        weight = np.zeros_like(u)
        weight[:, component] = 2.0 * np.abs(u[:, component])
    else:
        speed = np.maximum(np.linalg.norm(u, axis=1), 1e-300)
        weight = u[:, [component]] * u / speed[:, None]
        weight[:, component] += speed
    shares = np.zeros((len(velocity), 2))
    for other in range(u.shape[1]):
        change = drag * weight[:, [other]] * motion.shape
        if other == component and motion.derived:
            change = change + inertia * motion.slope
        shares += velocity[:, :, other] @ (gain @ change).T
    return np.asarray(shares + measured[:, :, component] @ (gain @ (inertia * motion.shape)).T)


def _freedom(gain: Array, blocks: list[tuple[int, int]]) -> Array:
    """Return the degrees of freedom of both intervals: fewer where few blocks decide [eq:identification-freedom]."""
    decided = np.array([np.sum(gain[:, a:b] ** 2, axis=1) for a, b in blocks])
    return np.asarray(decided.sum(axis=0) ** 2 / np.maximum(np.sum(decided**2, axis=0), 1e-300) - 1.0)


def _bootstrap(
    shares: Array, leverage: Array, found: Array, setup: Setup, rng: np.random.Generator
) -> tuple[Array, Array]:
    """Return bootstrap samples (count, 2) and the covariance [eq:identification-bootstrap].

    What each block contributes to the coefficients is resampled with random signs: blocks keep the correlation within
    them, and the places in the record keep their weight.
    """
    count = len(shares)
    if count < 2:
        nothing = np.full((setup.bootstrap, 2), np.nan)
        return nothing, np.full((2, 2), np.nan)
    # the shares sum to nothing by construction of the fit, which follows a block the more it decides
    parts = (shares - shares.mean(axis=0)) / np.sqrt(1.0 - np.clip(leverage, 0.0, 0.9))
    signs = rng.choice(np.array([-1.0, 1.0]), size=(setup.bootstrap, count))
    samples = found + signs @ parts
    return samples, np.asarray(parts.T @ parts)


def _coefficients(
    gain: Array,
    found: Array,
    covariance: Array,
    force: Array,
    columns: Array,
    step: float,
    omega: float,
    freedom: Array,
    setup: Setup,
) -> list[Coefficient]:
    from scipy.special import ndtri

    chance = 0.5 * (1.0 + setup.confidence)
    quantile = [student_quantile(setup.confidence, float(one)) for one in freedom]
    normal = float(ndtri(chance))
    # a phase error shifts the force in time: per radian by 1/omega [eq:identification-phase]
    slope = np.gradient(columns @ found, step) / omega
    sensitivity = gain @ slope
    rounding = 4.0 * np.finfo(float).eps * np.sqrt(np.sum(gain**2, axis=1)) * float(np.linalg.norm(force))
    return [
        Coefficient(
            value=float(found[k]),
            half_width=quantile[k] * math.sqrt(covariance[k, k]) if math.isfinite(covariance[k, k]) else math.inf,
            phase_half_width=normal * setup.phase_error * abs(float(sensitivity[k])),
            phase_sensitivity=float(sensitivity[k]),
            rounding=float(rounding[k]),
        )
        for k in range(2)
    ]
