"""Model A as the paper marches it, and the iterations of one step."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.structures.curtain.impact.cable import Impact, ImpactPeak, closed_form, moved_mass, peak_by_energy
from moyai.structures.curtain.impact.kernels import march, spring, taut_shape
from moyai.structures.curtain.statics.closed_forms import solve_cable

_MOST_STEPS = 10_000_000


@dataclass(frozen=True, eq=False)
class MarchedImpact:
    """Time series of the paper's marching scheme."""

    #: [s] at the ends of the steps.
    time: Array
    #: [m] at the ends of the steps.
    displacement: Array
    #: [m/s] at the ends of the steps.
    speed: Array
    #: [N/m] at the ends of the steps.
    load: Array
    #: [N] at the ends of the steps.
    tension: Array
    #: omega dt with omega the frequency of the just-taut spring.
    relative_step: float
    #: A warning where the step is too coarse.
    notices: tuple[Notice, ...]

    @property
    def peak(self) -> ImpactPeak:
        """The largest tension of the series."""
        where = int(np.argmax(self.tension))
        return ImpactPeak(float(self.tension[where]), float(self.displacement[where]), float(self.time[where]))


def march_impact(impact: Impact, *, time_step: float, duration: float, mass: float | None = None) -> MarchedImpact:
    """March model A with constant acceleration in every step, as the paper does [eq:impact-march].

    The scheme is of first order and comes from below: a peak is (pi/8) omega dt too low for a linear spring
    [eq:impact-march-error].

    Parameters
    ----------
    impact : Impact
        The span.
    time_step, duration : float
        [s].
    mass : float, optional
        Added mass [kg/m], M0 by default.

    Raises
    ------
    InputError
        When step or duration is not positive.
    """
    for name, value in (("time_step", time_step), ("duration", duration)):
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name} is {value:g} s", parameter=name, allowed="greater than 0")
    moved = moved_mass(impact, mass)
    if duration > _MOST_STEPS * time_step:
        raise InputError(
            f"a step of {time_step:g} s over {duration:.4g} s",
            parameter="time_step",
            allowed=f"at least {duration / _MOST_STEPS:.3g} s: {_MOST_STEPS} steps",
            remedy="the energy form needs no step",
        )
    count = max(1, math.ceil(duration / time_step - 1e-9))
    out = np.empty((count, 5))
    march(impact.span, impact.length, impact.stiffness, impact.speed, moved, time_step, count, out)
    rise = closed_form(impact, moved).time
    relative = 0.5 * math.pi * time_step / (rise if math.isfinite(rise) else peak_by_energy(impact, moved).time)
    notices: tuple[Notice, ...] = ()
    if relative > 0.02:
        notices = (
            Notice(
                "impact-step",
                f"The marching step is omega dt = {relative:.3g}; the peak comes out some "
                f"{100.0 * math.pi / 8.0 * relative:.1f} % too low",
                relative,
                0.02,
                remedy="take a smaller step, or the energy form, which needs none",
                source="first-order error pi/8 omega dt of the scheme",
            ),
        )
    time, place, velocity, load, tension = out.T.copy()
    return MarchedImpact(time, place, velocity, load, tension, relative, notices)


@dataclass(frozen=True)
class IterationResult:
    """How one of the paper's iterations behaved in the first step."""

    #: Whether it met the tolerance.
    converged: bool
    #: Sweeps used.
    sweeps: int
    #: The last displacement increment [m].
    displacement: float


def iterate_first_step(impact: Impact, time_step: float, *, reverse: bool, sweeps: int = 400) -> IterationResult:
    """Iterate the first step as the paper describes it, or in reverse [eq:impact-iteration].

    Forward (displacement, acceleration, load, displacement) contracts only for omega dt > sqrt 2, where the result is
    useless; in reverse (displacement, load, acceleration, displacement) it contracts for omega dt < sqrt 2. The
    frequency is that of the spring as loaded at the end of the step.

    Parameters
    ----------
    impact : Impact
        The span; not l = B.
    time_step : float
        dt [s].
    reverse : bool
        Which direction.
    sweeps : int
        At most so many.
    """
    mass, taut = impact.deep_mass, taut_shape(impact.span_ratio)
    free = impact.speed * time_step
    slack_sag = float(solve_cable(impact.span, impact.length, 1.0).sag) if taut > 0.0 else 0.0
    x = 0.5 * free
    for count in range(1, sweeps + 1):
        if reverse:
            load, _ = spring(x, impact.span, impact.span_ratio, taut, impact.stiffness)
            new = free - 0.5 * load * time_step**2 / mass
        else:
            load = 2.0 * mass * (free - x) / time_step**2
            new = 0.0
            if load > 0.0:
                new = float(solve_cable(impact.span, impact.length, load, impact.stiffness).sag) - slack_sag
        if abs(new - x) <= 1e-10 * free:
            return IterationResult(True, count, new)
        x = new
    return IterationResult(False, sweeps, x)
