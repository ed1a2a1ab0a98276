"""Prescribed motion of driven points, tabulated on a uniform grid and smooth between its points."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError


def _three(values: ArrayLike, path: str) -> Array:
    """Return three finite numbers; one stands for all."""
    given = np.asarray(values, dtype=np.float64)
    if given.shape not in ((), (3,)) or not np.isfinite(given).all():
        raise InputError(f"{path} is {values!r}", parameter=path, allowed="three finite numbers, or one for all")
    return np.asarray(np.broadcast_to(given, (3,)), dtype=np.float64)


#: Speed at the begin of a run over the largest, and distance from the place of rest over the range, that are a jerk.
JERK = 0.05


@dataclass(frozen=True)
class Beginning:
    """How a motion begins: distance from the place of rest [m], speed [m/s], mean period where that is a jerk [s].

    The period is NaN where the motion begins smoothly, or does not swing.
    """

    away: float
    speed: float
    period: float


@dataclass(frozen=True, eq=False)
class Motion:
    """Displacement of a driven point over time: a cubic through displacement and velocity at each grid time.

    Raises
    ------
    InputError
        For less than two times, a step that is not positive, or values that are not finite.

    Examples
    --------
    >>> from moyai.flexible import Motion
    >>> motion = Motion.harmonic(amplitude=(0.5, 0.0, 0.0), period=8.0, duration=80.0)
    >>> motion.end                                                       # [s]
    80.0
    >>> place, velocity = motion.at(2.0)
    >>> place.round(3).tolist()                                          # [m]
    [0.5, 0.0, 0.0]
    """

    #: First time of the grid [s].
    start: float
    #: Spacing of the grid [s].
    step: float
    #: Relative to the node's position in the network [m]; shape (k, 3).
    displacement: Array
    #: Its rate [m/s]; shape (k, 3).
    velocity: Array

    def __post_init__(self) -> None:
        for name in ("displacement", "velocity"):
            array = np.array(getattr(self, name), dtype=np.float64)
            if array.ndim != 2 or array.shape[1] != 3 or array.shape[0] < 2 or not np.isfinite(array).all():
                raise InputError(
                    f"{name} of a motion has shape {array.shape}",
                    parameter=f"motion.{name}",
                    allowed="(2 or more, 3), finite",
                )
            array.setflags(write=False)
            object.__setattr__(self, name, array)
        if self.displacement.shape != self.velocity.shape:
            raise InputError(
                "displacement and velocity differ in length",
                parameter="motion.velocity",
                allowed=str(self.displacement.shape),
            )
        if not (self.step > 0.0 and math.isfinite(self.step) and math.isfinite(self.start)):
            raise InputError(f"step of a motion is {self.step:g} s", parameter="motion.step", allowed="greater than 0")

    @property
    def end(self) -> float:
        """Last time of the table [s]."""
        return self.start + self.step * (len(self.displacement) - 1)

    @classmethod
    def from_function(
        cls, displacement: Callable[[Array], ArrayLike], *, duration: float, step: float, start: float = 0.0
    ) -> Motion:
        """Tabulate a function of time (array in, shape (k, 3) out); its rate is taken by fourth-order differences.

        Parameters
        ----------
        displacement : callable
            Takes times (k,) [s], returns displacements (k, 3) [m]; it is also asked two steps before and after the
            range.
        duration, step, start : float
            Range and spacing [s]; about a two-hundredth of the shortest period keeps the table exact to 1e-8.

        Raises
        ------
        InputError
            For a duration or step that is not positive, or a function that returns another shape.
        """
        if not (0.0 < duration < math.inf and 0.0 < step < math.inf):
            raise InputError(
                f"a motion over {duration:g} s in steps of {step:g} s",
                parameter="motion.duration",
                allowed="greater than 0",
            )
        count = math.ceil(duration / step - 1e-9) + 1
        time: Array = np.asarray(start + step * np.arange(-2, count + 2), dtype=np.float64)
        values = np.asarray(displacement(time), dtype=np.float64)
        if values.shape != (count + 4, 3):
            raise InputError(
                f"the function of a motion returns shape {values.shape} for {count + 4} times",
                parameter="motion.displacement",
                allowed=f"({count + 4}, 3)",
            )
        rate = (8.0 * (values[3:-1] - values[1:-3]) - (values[4:] - values[:-4])) / (12.0 * step)
        return cls(start, step, values[2:-2], rate)

    @classmethod
    def harmonic(
        cls,
        amplitude: ArrayLike,
        period: float,
        *,
        duration: float,
        ramp: float = 0.0,
        phase: ArrayLike = 0.0,
        start: float = 0.0,
    ) -> Motion:
        """Return amplitude * r(t) * sin(2 pi t / period + phase), r a smooth start over ``ramp`` seconds (half a
        cosine).

        Parameters
        ----------
        amplitude, phase : array_like (3,)
            Of each component [m, rad].
        period, duration, ramp, start : float
            [s].

        Raises
        ------
        InputError
            For a period or duration that is not positive, a negative ramp, or an amplitude or phase that is not three
            numbers.
        """
        if not (0.0 < period < math.inf and 0.0 < duration < math.inf and 0.0 <= ramp < math.inf):
            raise InputError(
                f"a harmonic motion of period {period:g} s over {duration:g} s with a ramp of {ramp:g} s",
                parameter="motion.period",
                allowed="greater than 0",
            )
        size, turn = _three(amplitude, "motion.amplitude"), _three(phase, "motion.phase")
        omega = 2.0 * math.pi / period
        step = min(period / 200.0, duration / 4.0)
        time = start + step * np.arange(math.ceil(duration / step - 1e-9) + 1)
        grown, rate = np.ones_like(time), np.zeros_like(time)
        if ramp > 0.0:
            inside = time - start < ramp
            angle = math.pi * (time - start) / ramp
            grown = np.where(inside, 0.5 * (1.0 - np.cos(angle)), 1.0)
            rate = np.where(inside, 0.5 * math.pi / ramp * np.sin(angle), 0.0)
        sine, cosine = np.sin(omega * time[:, None] + turn), np.cos(omega * time[:, None] + turn)
        return cls(
            start, step, size * grown[:, None] * sine, size * (rate[:, None] * sine + omega * grown[:, None] * cosine)
        )

    @classmethod
    def from_table(cls, time: ArrayLike, displacement: ArrayLike, *, step: float | None = None) -> Motion:
        """Return the natural cubic spline through a record of displacements.

        Parameters
        ----------
        time : array_like, shape (k,)
            Rising [s].
        displacement : array_like, shape (k, 3)
            [m].
        step : float, optional
            Grid of the table; the shortest interval of the record when left out (then a uniform record keeps its
            points).

        Raises
        ------
        InputError
            For times that do not rise, displacements of another shape or not finite, or a step that is not positive.
        """
        from scipy.interpolate import CubicSpline

        given, values = np.asarray(time, dtype=np.float64), np.asarray(displacement, dtype=np.float64)
        rising = given.ndim == 1 and given.size >= 2 and bool(np.all(np.diff(given) > 0.0))
        if not rising or values.shape != (given.size, 3) or not np.isfinite(given).all():
            raise InputError(
                "a table of motion needs rising times and three displacements each",
                parameter="motion.time",
                allowed="rising",
            )
        if not np.isfinite(values).all():
            row = int(np.flatnonzero(~np.isfinite(values).all(axis=1))[0])
            raise InputError(
                f"displacement at t = {given[row]:g} s is not finite",
                parameter="motion.displacement",
                allowed="finite numbers",
            )
        if step is not None and not 0.0 < step < math.inf:
            raise InputError(f"step of a motion is {step:g} s", parameter="motion.step", allowed="greater than 0")
        wanted = float(np.min(np.diff(given))) if step is None else step
        count = max(1, round((given[-1] - given[0]) / wanted))
        wanted = (given[-1] - given[0]) / count
        grid = np.clip(given[0] + wanted * np.arange(count + 1), given[0], given[-1])
        spline = CubicSpline(given, values, bc_type="natural") if given.size > 2 else None
        if spline is None:
            slope = (values[1] - values[0]) / (given[1] - given[0])
            return cls(
                float(given[0]), wanted, values[0] + (grid - given[0])[:, None] * slope, np.tile(slope, (count + 1, 1))
            )
        return cls(float(given[0]), wanted, spline(grid), spline(grid, 1))

    def beginning(self, duration: float) -> Beginning:
        """Return how a run over ``duration`` seconds from 0 s begins, with the mean period of the widest component.

        Parameters
        ----------
        duration : float
            [s].

        Raises
        ------
        InputError
            When the run is not within the motion.
        """
        time = np.linspace(0.0, duration, max(round(duration / self.step), 2) + 1)
        place, velocity = self.at(time)
        speed = np.linalg.norm(velocity, axis=1)
        wide = np.ptp(place, axis=0)
        swing = place[:, int(np.argmax(wide))]
        away, begin = float(np.linalg.norm(place[0])), float(speed[0])
        about = swing - 0.5 * (swing.max() + swing.min())
        (before,) = np.nonzero(np.diff(about > 0.0))
        crossings = time[before] - about[before] * time[1] / (about[before + 1] - about[before])
        smooth = begin <= JERK * speed.max() and away <= JERK * wide.max()
        swings = crossings.size > 1 and not smooth
        return Beginning(away, begin, 2.0 * float(np.mean(np.diff(crossings))) if swings else math.nan)

    def grown(self, ramp: float) -> Motion:
        """Return the motion that grows from nothing at 0 s to all of it at ``ramp``, by half a cosine.

        Parameters
        ----------
        ramp : float
            Greater than 0 [s].
        """
        time = self.start + self.step * np.arange(len(self.displacement))
        angle = math.pi * np.clip(time / ramp, 0.0, 1.0)[:, None]
        share, rate = 0.5 * (1.0 - np.cos(angle)), 0.5 * math.pi / ramp * np.sin(angle)
        return Motion(
            self.start, self.step, share * self.displacement, rate * self.displacement + share * self.velocity
        )

    def at(self, time: ArrayLike) -> tuple[Array, Array]:
        """Return displacement and velocity at any times of the range, shape (..., 3).

        Parameters
        ----------
        time : array_like (...)
            [s].

        Returns
        -------
        tuple of ndarray (..., 3)
            Displacement [m] and velocity [m/s].

        Raises
        ------
        InputError
            Outside the range.
        """
        t = np.asarray(time, dtype=np.float64)
        slack = 1e-9 * max(1.0, abs(self.end))
        if t.size and not (t.min() >= self.start - slack and t.max() <= self.end + slack):
            raise InputError(
                f"motion asked at {t.min():g} to {t.max():g} s",
                parameter="motion",
                allowed=f"{self.start:g} to {self.end:g} s",
                remedy="give a longer motion or a shorter run",
            )
        place = np.clip((t - self.start) / self.step, 0.0, len(self.displacement) - 1)
        row = np.minimum(place.astype(np.int64), len(self.displacement) - 2)
        s = (place - row)[..., None]
        x0, x1 = self.displacement[row], self.displacement[row + 1]
        v0, v1 = self.velocity[row] * self.step, self.velocity[row + 1] * self.step
        d = x1 - x0
        value = x0 + s * (v0 + s * (3.0 * d - 2.0 * v0 - v1 + s * (v0 + v1 - 2.0 * d)))
        rate = (v0 + s * (2.0 * (3.0 * d - 2.0 * v0 - v1) + 3.0 * s * (v0 + v1 - 2.0 * d))) / self.step
        return value, rate
