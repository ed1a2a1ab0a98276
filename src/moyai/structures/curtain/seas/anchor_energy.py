"""Energy model of anchor loads (Tabata et al.), forward and backward: tension from waves, and the factor from records.

The model lends the kinetic energy of a float, times an energy factor M, to the spring of its anchor rope. M = 0.2 in
the field and 0.5 in the flume: it transfers energy and is no added mass. Only the product M m_B K shows in tensions.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.validity import Notice
from moyai.sea.water import Water
from moyai.series.intervals import student_quantile
from moyai.structures.curtain.seas.squared_velocity import surface_speed

FittingRule = Literal["mean_zero", "least_relative_error", "least_squares"]
FITTING_RULES: tuple[FittingRule, ...] = ("mean_zero", "least_relative_error", "least_squares")

_SOURCE = "Tabata et al., equations (3) to (5)"


#: Energy factors that fitted the measured anchor lines of the field and of the flume [-]
ENERGY_FACTORS = (0.2, 0.5)


@dataclass(frozen=True)
class EnergyModel:
    """Float on an anchor rope that turns its speed into stretch."""

    #: M [-]: 0.2 fitted the field, 0.5 the flume.
    energy_factor: float
    #: m_B per anchor rope [kg]; the paper does not give it.
    float_mass: float
    #: K = EA/L [N/m].
    rope_stiffness: float
    #: alpha [-] on the wave's velocity; 2 in the paper.
    orbital_factor: float
    #: Tension of the member over that of the rope [-]: 1 for the anchor rope, 0.6 for the tension wire.
    line_factor: float
    #: Over the tension of the type that M was fitted to [-]: 1 for the same, 0.7 from conventional to new type.
    type_factor: float

    def __post_init__(self) -> None:
        for name in (
            "energy_factor",
            "float_mass",
            "rope_stiffness",
            "orbital_factor",
            "line_factor",
            "type_factor",
        ):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                remedy = "give the float's mass per anchor rope; no value follows from the paper"
                raise InputError(
                    f"{name} is {value:g}",
                    parameter=f"energy_model.{name}",
                    allowed="greater than 0",
                    remedy=remedy if name == "float_mass" else "",
                )

    @property
    def product(self) -> float:
        """M m_B K [kg N/m], the only product that tensions determine."""
        return self.energy_factor * self.float_mass * self.rope_stiffness

    @property
    def response_time(self) -> float:
        """2 pi sqrt(M m_B/K) [s]; the model needs it to be short against the wave period."""
        return 2.0 * math.pi * math.sqrt(self.energy_factor * self.float_mass / self.rope_stiffness)

    def float_speed(self, height: ArrayLike, period: ArrayLike, current: ArrayLike, water: Water) -> Array:
        """Return U_max = alpha u_max + U [m/s], waves already reduced for their direction [eq:curtain-float-speed]."""
        values: Array = self.orbital_factor * surface_speed(height, period, water) + np.asarray(current)
        return values

    def fluctuating_tension(self, float_speed: ArrayLike, pretension: ArrayLike) -> Array:
        """Return the wave part of the tension [N] for float speeds [m/s] [eq:curtain-energy].

        Parameters
        ----------
        float_speed : array_like
            U_max [m/s]; a float that moves against the load (negative) gives none.
        pretension : array_like
            Steady tension of the rope [N]; 0 is the paper's formula.
        """
        steady = np.asarray(pretension, dtype=np.float64)
        if not np.all(steady >= 0.0):
            raise InputError(f"pretension is {np.min(steady):g} N", parameter="pretension", allowed="at least 0")
        speed = np.maximum(np.asarray(float_speed, dtype=np.float64), 0.0)
        energy = self.product * speed**2
        # sqrt(T^2 + e) - T without cancellation
        rise = energy / np.where(energy > 0.0, np.hypot(steady, np.sqrt(energy)) + steady, 1.0)
        return self.line_factor * self.type_factor * rise

    def tension(self, float_speed: ArrayLike, pretension: ArrayLike) -> Array:
        """Return the greatest tension, steady part included [N]."""
        return np.asarray(pretension) + self.fluctuating_tension(float_speed, pretension)


def product_needed(tension: ArrayLike, float_speed: ArrayLike, pretension: ArrayLike) -> Array:
    """Return M m_B K [kg N/m] that gives a fluctuating rope tension [N] at a float speed [m/s].

    With a steady tension the same rise takes more energy, T_e (T_e + 2 T) [eq:curtain-energy].
    """
    rise = np.asarray(tension, dtype=np.float64)
    values: Array = rise * (rise + 2.0 * np.asarray(pretension)) / np.asarray(float_speed) ** 2
    return values


@checks_words
@dataclass(frozen=True, eq=False)
class EnergyCalibration:
    """M m_B K from observed tensions, by one rule."""

    #: ``mean_zero``, ``least_relative_error`` or ``least_squares``.
    rule: FittingRule
    #: M m_B K [kg N/m].
    product: float
    #: Of the product [kg N/m], by leaving out one observation at a time.
    standard_error: float
    #: Bounds of 95 % [kg N/m], Student's t on the root of the product.
    interval: tuple[float, float]
    #: Calculated amplitudes sqrt(T_e (T_e + 2 T)) of the rope, T_e where there is no pretension [N].
    calculated: Array
    #: Observed amplitudes of the rope [N].
    observed: Array

    @property
    def residual(self) -> Array:
        """The paper's error (calculated - observed)/calculated [-]."""
        return (self.calculated - self.observed) / self.calculated

    @property
    def mean_error(self) -> float:
        """Mean of the residuals [-]."""
        return float(np.mean(self.residual))

    @property
    def error_deviation(self) -> float:
        """Root mean square of the residuals [-]."""
        return float(np.sqrt(np.mean(self.residual**2)))

    def energy_factor(self, float_mass: float, rope_stiffness: float) -> float:
        """Return M [-] for a float mass [kg] and a rope stiffness [N/m]."""
        return self.product / (float_mass * rope_stiffness)


def _root(rule: FittingRule, observed: Array, speed: Array) -> float:
    """Return sqrt(M m_B K) by a rule [eq:curtain-calibration]."""
    ratio = observed / speed
    if rule == "mean_zero":
        return float(np.mean(ratio))
    if rule == "least_relative_error":
        return float(np.mean(ratio**2) / np.mean(ratio))
    return float(np.sum(observed * speed) / np.sum(speed**2))


@checks_words
def calibrate(
    observed: ArrayLike,
    float_speed: ArrayLike,
    pretension: ArrayLike,
    *,
    line_factor: float,
    rule: FittingRule = "mean_zero",
) -> EnergyCalibration:
    """Find M m_B K from observed fluctuating tensions.

    Parameters
    ----------
    observed : array_like
        Fluctuating tensions of the member [N], greater than 0.
    float_speed : array_like
        U_max of each observation [m/s], greater than 0.
    pretension : array_like
        Steady tension of the rope in each observation [N]; 0 is the paper's formula.
    line_factor : float
        Tension of the member over that of the rope [-].
    rule : {"mean_zero", "least_relative_error", "least_squares"}
        ``mean_zero``: the paper's error has no mean, unbiased for a scatter in proportion (default).
        ``least_relative_error``: its mean square is least; too high by (1 + CV^2)^2 in M.
        ``least_squares``: ordinary, in newtons, governed by the largest tensions.

    Raises
    ------
    InputError
        For fewer than three observations, or numbers that are not positive.
    """
    if rule not in FITTING_RULES:
        raise InputError(f"unknown rule {rule!r}", parameter="rule", allowed=", ".join(FITTING_RULES))
    rise, speed, steady = np.broadcast_arrays(
        np.asarray(observed, dtype=np.float64) / line_factor,
        np.asarray(float_speed, dtype=np.float64),
        np.asarray(pretension, dtype=np.float64),
    )
    if rise.ndim != 1 or rise.size < 3:
        raise InputError(f"{rise.size} observations", parameter="observed", allowed="at least 3, in one list")
    for name, values, lowest in (("observed", rise, 0.0), ("float_speed", speed, 0.0), ("pretension", steady, -1e-300)):
        bad = ~(np.isfinite(values) & (values > lowest))
        if np.any(bad):
            row = int(np.argmax(bad)) + 1
            raise InputError(f"row {row}: {name} is {values[row - 1]:g}", parameter=name, allowed="positive numbers")
    amplitude = np.sqrt(rise * (rise + 2.0 * steady))
    root = _root(rule, amplitude, speed)
    count = rise.size
    keep = ~np.eye(count, dtype=bool)
    without = np.array([_root(rule, amplitude[row], speed[row]) for row in keep])
    error = math.sqrt((count - 1) / count * float(np.sum((without - without.mean()) ** 2)))
    reach = student_quantile(0.95, count - 1) * error
    bounds = (max(root - reach, 0.0) ** 2, (root + reach) ** 2)
    return EnergyCalibration(rule, root**2, 2.0 * root * error, bounds, root * speed, amplitude)


@checks_words
def calibration_bounds(
    observed: ArrayLike,
    float_speed: ArrayLike,
    pretension: ArrayLike,
    *,
    line_factor: float,
    rule: FittingRule = "mean_zero",
    resamples: int = 500,
    seed: int = 0,
    confidence: float = 0.95,
) -> tuple[float, float]:
    """Return bounds of M m_B K [kg N/m] by drawing the observations again and fitting each draw.

    They need no law of the scatter, and stand next to :attr:`EnergyCalibration.interval`, which rests on the variance
    of the root of the product.

    Parameters
    ----------
    observed, float_speed, pretension, line_factor, rule
        As in :func:`calibrate`.
    resamples, seed : int
        Draws and their seed.
    confidence : float
        Of the bounds.

    Raises
    ------
    InputError
        As :func:`calibrate`, and for fewer than fifty draws.
    """
    fit = calibrate(observed, float_speed, pretension, line_factor=line_factor, rule=rule)
    if resamples < 50 or not 0.0 < confidence < 1.0:
        raise InputError(f"{resamples} draws at {confidence:g}", parameter="resamples", allowed="at least 50, 0 to 1")
    speed = np.broadcast_to(np.asarray(float_speed, dtype=np.float64), fit.observed.shape)
    rng = np.random.default_rng(seed)
    rows = rng.integers(0, fit.observed.size, (resamples, fit.observed.size))
    roots = np.array([_root(rule, fit.observed[row], speed[row]) for row in rows])
    low, high = np.percentile(roots**2, [50.0 * (1.0 - confidence), 50.0 * (1.0 + confidence)])
    return float(low), float(high)


def error_against_product(observed: ArrayLike, float_speed: ArrayLike, product: ArrayLike) -> tuple[Array, Array]:
    """Return mean and root mean square of the paper's error for each M m_B K, the curves that a fit reads."""
    calculated = np.sqrt(np.asarray(product, dtype=np.float64))[:, None] * np.asarray(float_speed)
    error = 1.0 - np.asarray(observed) / calculated
    return error.mean(axis=1), np.sqrt(np.mean(error**2, axis=1))


def check_energy_model(model: EnergyModel, period: float) -> tuple[Notice, ...]:
    """Tell where the energy model leaves its range: a response that is not short, a factor beyond 1."""
    notices = []
    ratio = model.response_time / period
    if ratio > 0.1:
        notices.append(
            Notice(
                "curtain-energy-response",
                f"the rope answers in {model.response_time:.3g} s, {ratio:.2g} wave periods: not an impulse",
                ratio,
                0.1,
                "warning",
                "use the slack-taut oscillator",
                _SOURCE,
            )
        )
    if model.energy_factor > 1.0:
        notices.append(
            Notice(
                "curtain-energy-factor",
                f"energy factor M = {model.energy_factor:.3g}: more than the float's own energy goes into the rope",
                model.energy_factor,
                1.0,
                "warning",
                "0.2 (field) to 0.5 (flume) were fitted",
                _SOURCE,
            )
        )
    return tuple(notices)
