"""Slack and taut cycles of a curtain in regular waves with a current, and the contacts found in them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.errors import InputError
from moyai.curtain.impact import Impact, closed_form, peak_by_energy
from moyai.curtain.impact_kernels import slack_taut

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Contact:
    """One time that the cable is taut.

    Parameters
    ----------
    time : float
        When it becomes taut [s].
    speed : float
        Speed of mid-span at that instant [m/s].
    tension : float
        Largest tension until it is slack again, both cables together [N].
    side : int
        1 on the downstream side, -1 upstream.
    first : bool
        Whether it is the first on its side since the other side; later ones are bounces.
    """

    time: float
    speed: float
    tension: float
    side: int
    first: bool


@dataclass(frozen=True, eq=False)
class SlackTautMotion:
    """Time series of the oscillator.

    Parameters
    ----------
    time, position, speed, tension : ndarray
        [s], position of mid-span downstream of the line between the supports [m], [m/s], sum of both cables [N].
    contacts : tuple of Contact
        In the order of time; one that has begun before the series is left out.
    """

    time: Array
    position: Array
    speed: Array
    tension: Array
    contacts: tuple[Contact, ...]


def slack_taut_motion(
    impact: Impact,
    *,
    drag_coefficient: float,
    current: float,
    velocity_amplitude: float,
    period: float,
    duration: float,
    start: tuple[float, float] = (0.0, 0.0),
    time_step: float | None = None,
) -> SlackTautMotion:
    """Solve the slack and taut curtain in u = U + u_a sin(2 pi t / T) [eq:impact-slack-taut].

    Parameters
    ----------
    impact : Impact
        The span; its speed does not enter.
    drag_coefficient : float
        C_D of the skirt, on d per metre of span.
    current, velocity_amplitude : float
        U and u_a [m/s], normal to the span.
    period, duration : float
        T and length of the series [s].
    start : (float, float)
        Position [m] and speed [m/s] of mid-span.
    time_step : float, optional
        [s]; by default a 400th of the period and a hundredth of the period of the just-taut spring.

    Raises
    ------
    InputError
        When a number is out of range.
    """
    numbers = {"period": period, "duration": duration, "time_step": 1.0 if time_step is None else time_step}
    for name, value in numbers.items():
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name} is {value:g} s", path=name, allowed="greater than 0")
    for name, value in {"drag_coefficient": drag_coefficient, "velocity_amplitude": velocity_amplitude}.items():
        if not (math.isfinite(value) and value >= 0.0):
            raise InputError(f"{name} is {value:g}", path=name, allowed="0 or more")
    if not math.isfinite(current):
        raise InputError("current is not finite", path="current")
    rise = closed_form(impact).time
    if not math.isfinite(rise):
        rise = peak_by_energy(impact).time
    step = min(period / 400.0, 0.04 * rise) if time_step is None else time_step
    count = math.ceil(duration / step - 1e-9)
    half = 0.5 * step * np.arange(2 * count + 1)
    omega = 2.0 * math.pi / period
    flow = np.stack(
        [current + velocity_amplitude * np.sin(omega * half), velocity_amplitude * omega * np.cos(omega * half)], axis=1
    )
    return slack_taut_in_flow(impact, drag_coefficient, flow, step, start)


def slack_taut_in_flow(
    impact: Impact, drag_coefficient: float, flow: ArrayLike, time_step: float, start: tuple[float, float]
) -> SlackTautMotion:
    """Solve the same in any flow, for instance of irregular waves.

    Parameters
    ----------
    impact, drag_coefficient, start
        As in :func:`slack_taut_motion`.
    flow : array_like, shape (2 n + 1, 2)
        Velocity [m/s] and acceleration [m/s2] of the water at every half step.
    time_step : float
        [s].

    Raises
    ------
    InputError
        When the flow has another shape or is not finite.
    """
    given = np.ascontiguousarray(flow, dtype=float)
    if given.ndim != 2 or given.shape[1] != 2 or len(given) % 2 == 0 or not np.isfinite(given).all():
        raise InputError(
            f"flow has shape {given.shape} or is not finite", path="flow", allowed="(2 n + 1, 2): every half step"
        )
    out = np.zeros(((len(given) + 1) // 2, 3))
    out[0, :2] = start
    drag = 0.5 * impact.water.density * drag_coefficient * impact.draught
    slack_taut(impact.span, impact.length, impact.stiffness, impact.deep_mass, drag, given, time_step, out)
    time = time_step * np.arange(len(out), dtype=np.float64)
    position, speed, tension = out.T.copy()
    return SlackTautMotion(time, position, speed, tension, _contacts(time, position, speed, tension))


def _contacts(time: Array, position: Array, speed: Array, tension: Array) -> tuple[Contact, ...]:
    taut = tension > 0.0
    begins = np.flatnonzero(~taut[:-1] & taut[1:]) + 1
    found: list[Contact] = []
    for begin in begins:
        slack = np.flatnonzero(~taut[begin:])
        end = begin + int(slack[0]) if slack.size else len(time)
        side = 1 if position[begin] > 0.0 else -1
        first = not found or found[-1].side != side
        found.append(Contact(float(time[begin]), float(speed[begin]), float(tension[begin:end].max()), side, first))
    return tuple(found)
