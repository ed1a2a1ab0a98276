"""Motion of the water that enters Morison's equation: cleared of noise, and what noise leaves unknown of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.records.forces.record import ForceRecord, NoiseCut, acceleration_of, without_noise


@dataclass(frozen=True, eq=False)
class CleanMotion:
    """Velocity and acceleration of the water, component by component."""

    #: [m/s]; shape (samples, components).
    velocity: Array
    #: [m/s2].
    rate: Array
    #: Where an irregular acceleration was cut, of every component; None where it was not.
    cut: tuple[NoiseCut | None, ...]
    #: Time step [s].
    step: float
    #: Whether the acceleration is the derivative of the velocity.
    derived: bool
    #: Mean and harmonics of regular waves and their derivatives; shape (samples, terms), no terms of irregular ones.
    shape: Array
    slope: Array
    #: What each block adds to the errors of their amplitudes, of velocity and of measured acceleration; shape (2,
    #: blocks, terms, components).
    errors: Array

    def filtered(self, columns: Array, component: int) -> Array:
        """Return columns without what lies above the cut of the velocity of a component [eq:identification-filtered].

        They are mirrored at their ends, as the derivative is of a velocity that is turned about its ends.

        Parameters
        ----------
        columns : ndarray, shape (samples, ...)
            Evenly spaced as the record is.
        component : int
            Whose cut.
        """
        cut = self.cut[component]
        return columns if cut is None else without_noise(columns, self.step, cut.frequency, ends="even")

    def noise_left(self, component: int) -> float:
        """Return the share of noise in the variance of the acceleration of a component."""
        cut = self.cut[component]
        return 0.0 if cut is None or not self.derived else cut.share_left


def irregular_motion(record: ForceRecord, cut: tuple[NoiseCut | None, ...]) -> CleanMotion:
    """Return the motion of irregular waves without noise, the acceleration by a spline where none was measured.

    The velocity keeps twice the frequencies of the acceleration: noise counts less in it than in a derivative, and
    u|u| needs the whole velocity.

    Parameters
    ----------
    record : ForceRecord
        As it was measured.
    cut : tuple of NoiseCut or None
        Of every component.
    """
    velocity, slow = record.velocity.copy(), record.velocity.copy()
    for component, one in enumerate(cut):
        if one is None:
            continue
        slow[:, component] = without_noise(velocity[:, component], record.step, one.frequency)
        if 2.0 * one.frequency < 0.49 / record.step:
            velocity[:, component] = without_noise(velocity[:, component], record.step, 2.0 * one.frequency)
    derived = record.acceleration is None
    rate = acceleration_of(slow, record.step) if record.acceleration is None else record.acceleration
    nothing = np.zeros((record.time.size, 0))
    errors = np.zeros((2, 0, 0, record.components))
    return CleanMotion(velocity, rate, cut, record.step, derived, nothing, nothing, errors)


def regular_motion(record: ForceRecord, omega: float, orders: int, blocks: Sequence[tuple[int, int]]) -> CleanMotion:
    """Return mean and harmonics of the motion of regular waves [eq:identification-motion].

    Noise that does not repeat itself is left out of them but for what each block adds to the error of an amplitude,
    which is kept.

    Parameters
    ----------
    record : ForceRecord
        Whole periods.
    omega : float
        [rad/s].
    orders : int
        Number of harmonics.
    blocks : sequence of (int, int)
        Ranges of samples that stand for independent pieces.
    """
    angle = omega * (record.time - record.time.mean())[:, None] * np.arange(1, orders + 1)
    rise = omega * np.arange(1, orders + 1)
    shape = np.column_stack([np.ones(len(angle)), np.cos(angle), np.sin(angle)])
    slope = np.column_stack([np.zeros(len(angle)), -rise * np.sin(angle), rise * np.cos(angle)])
    inverse = np.linalg.pinv(shape)

    def fitted(values: Array) -> tuple[Array, Array]:
        amplitude = inverse @ values
        left = values - shape @ amplitude
        return amplitude, np.array([inverse[:, a:b] @ left[a:b] for a, b in blocks])

    amplitude, error = fitted(record.velocity)
    rate, apart = slope @ amplitude, np.zeros_like(error)
    if record.acceleration is not None:
        measured, apart = fitted(record.acceleration)
        rate = shape @ measured
    cut, derived = (None,) * record.components, record.acceleration is None
    return CleanMotion(shape @ amplitude, rate, cut, record.step, derived, shape, slope, np.array([error, apart]))
