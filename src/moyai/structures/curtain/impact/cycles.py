"""Slack and taut cycles of a curtain in waves with a current, and the contacts found in them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.structures.curtain.impact.cable import Impact, closed_form, peak_by_energy, sweep_peaks
from moyai.structures.curtain.impact.kernels import load_table, sag_ratio, slack_taut, taut_shape
from moyai.structures.curtain.snaps.flow import check_samples

# Taut, a step is at most this share of the rise of model A
_TAUT_SHARE = 0.04
_TABLE_ROWS = 3000


@dataclass(frozen=True)
class CableContact:
    """One time that the cable is taut."""

    #: When it becomes taut [s].
    time: float
    #: Speed of mid-span at that instant [m/s].
    speed: float
    #: Largest tension until it is slack again, both cables together [N].
    tension: float
    #: 1 on the downstream side, -1 upstream.
    side: int
    #: Whether it is the first on its side since the other side was taut or the water turned towards this one (about its
    #: mean speed); later ones are bounces.
    first: bool
    #: When the tension is largest [s]; NaN where the series stops before.
    peak_time: float
    #: When the cable is slack again [s]; NaN where the series stops before.
    end: float

    @property
    def rise_time(self) -> float:
        """From taut to the largest tension [s]."""
        return self.peak_time - self.time


@dataclass(frozen=True, eq=False)
class SlackTautMotion:
    """Time series of the oscillator."""

    #: [s].
    time: Array
    #: Position of mid-span downstream of the line between the supports [m].
    position: Array
    #: [m/s].
    speed: Array
    #: Sum of both cables [N].
    tension: Array
    #: In the order of time; one that has begun before the series is left out.
    contacts: tuple[CableContact, ...]


def slack_sag(impact: Impact) -> float:
    """Return the sag of the just-taut cable [m]: nothing is taut while mid-span is nearer than this."""
    return float(0.5 * impact.span * sag_ratio(taut_shape(impact.span_ratio)))


def rise_time(impact: Impact) -> float:
    """Return the rise of model A at small strain [s], at the span's speed where the cable is as long as its span."""
    rise = closed_form(impact).time
    return rise if math.isfinite(rise) else peak_by_energy(impact).time


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
    mass: float | None = None,
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
        Of the series [s]; by default a 400th of the period and a 25th of the rise of model A.
    mass : float, optional
        Added mass [kg/m], M0 of the paper by default.

    Raises
    ------
    InputError
        When a number is out of range.
    """
    numbers = {"period": period, "duration": duration, "time_step": 1.0 if time_step is None else time_step}
    for name, value in numbers.items():
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name} is {value:g} s", parameter=name, allowed="greater than 0")
    if not (math.isfinite(velocity_amplitude) and velocity_amplitude >= 0.0):
        raise InputError(
            f"velocity_amplitude is {velocity_amplitude:g}", parameter="velocity_amplitude", allowed="0 or more"
        )
    if not math.isfinite(current):
        raise InputError("current is not finite", parameter="current", allowed="a number")
    step = min(period / 400.0, _TAUT_SHARE * rise_time(impact)) if time_step is None else time_step
    check_samples(duration, step)
    omega = 2.0 * math.pi / period
    phase = omega * step * np.arange(max(1, math.ceil(duration / step - 1e-9)) + 1)
    flow = np.stack([current + velocity_amplitude * np.sin(phase), velocity_amplitude * omega * np.cos(phase)], axis=1)
    return simulate_in_flow(impact, drag_coefficient, flow, step, start, mass=mass, mean_speed=current)


def simulate_in_flow(
    impact: Impact,
    drag_coefficient: float,
    flow: ArrayLike,
    time_step: float,
    start: tuple[float, float],
    *,
    mass: float | None = None,
    mean_speed: float | None = None,
    taut_step: float | None = None,
) -> SlackTautMotion:
    """Solve the slack and taut curtain in any flow given on a uniform grid [eq:impact-slack-taut].

    Contacts are located in time, so that the steps of the flow need not resolve them; while the cable is taut the
    flow's steps are divided.

    Parameters
    ----------
    impact, drag_coefficient, start
        As in :func:`slack_taut_motion`.
    flow : array_like, shape (n + 1, 2)
        Velocity [m/s] and acceleration [m/s2] of the water along the normal of the span.
    time_step : float
        Of the flow [s].
    mass : float, optional
        Added mass [kg/m], M0 of the paper by default.
    mean_speed : float, optional
        Speed about which the water turns, for telling first contacts from bounces [m/s]; the mean of the flow by
        default.
    taut_step : float, optional
        Longest step while taut [s]; a 25th of the rise of model A by default.

    Raises
    ------
    InputError
        When the flow has another shape or is not finite, or a number is out of range.
    """
    given = np.ascontiguousarray(flow, dtype=float)
    if given.ndim != 2 or given.shape[1:] != (2,) or len(given) < 2 or not np.isfinite(given).all():
        raise InputError(
            f"flow has shape {given.shape} or is not finite", parameter="flow", allowed="(n + 1, 2), finite"
        )
    longest = _TAUT_SHARE * rise_time(impact) if taut_step is None else taut_step
    moved = impact.deep_mass if mass is None else float(mass)
    for name, value in {"time_step": time_step, "taut_step": longest, "mass": moved}.items():
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name} is {value:g}", parameter=name, allowed="greater than 0")
    if not (math.isfinite(drag_coefficient) and drag_coefficient >= 0.0):
        raise InputError(f"drag_coefficient is {drag_coefficient:g}", parameter="drag_coefficient", allowed="0 or more")
    if not (math.isfinite(start[0]) and math.isfinite(start[1])):
        raise InputError("start is not finite", parameter="start", allowed="position [m] and speed [m/s]")
    taut = taut_shape(impact.span_ratio)
    drag = 0.5 * impact.water.density * drag_coefficient * impact.draught / moved
    # as far as model A goes at the largest speed that the water and the start give, and once more
    fastest = max(float(np.abs(given[:, 0]).max()), abs(start[1]), 1e-9)
    reach = 2.0 * float(sweep_peaks(impact.span, impact.length, impact.stiffness, fastest, moved)[1])
    # powers of two, so that runs of one span share their table
    reach = 2.0 ** math.ceil(math.log2(reach))
    table = _table(impact.span, impact.span_ratio, taut, impact.stiffness, reach)
    cable = np.array(
        [impact.span, impact.span_ratio, taut, impact.stiffness, slack_sag(impact), reach, 1.0 / moved, 1.0 / reach]
    )
    out = np.zeros((len(given), 3))
    room = 1000
    while True:
        out[0, :2] = start
        rows = np.zeros((room, 6))
        count = slack_taut(cable, table, drag, given, time_step, longest, out, rows)
        if count <= room:
            break
        room = count
    time = time_step * np.arange(len(out), dtype=np.float64)
    position, speed, tension = out.T.copy()
    level = float(given[:, 0].mean()) if mean_speed is None else mean_speed
    return SlackTautMotion(time, position, speed, tension, _contacts(rows[:count], time, given[:, 0] - level))


@lru_cache(maxsize=16)
def _table(span: float, span_ratio: float, taut: float, stiffness: float, reach: float) -> Array:
    table = np.zeros((_TABLE_ROWS, 9))
    load_table(span, span_ratio, taut, stiffness, reach, table)
    return table


def _contacts(table: Array, time: Array, wave: Array) -> tuple[CableContact, ...]:
    """Turn rows of the kernel into contacts; ``wave`` is the speed of the water about its mean."""
    above = wave > 0.0
    crossings = np.flatnonzero(above[:-1] != above[1:])
    step = time[1] - time[0]
    when = time[crossings] + step * wave[crossings] / (wave[crossings] - wave[crossings + 1])
    begin, side = table[:, 0], table[:, 5].astype(np.int64)
    turned = np.full(len(table), -math.inf)
    for toward, turns in ((1, when[~above[crossings]]), (-1, when[above[crossings]])):
        place = np.searchsorted(turns, begin) - 1
        known = (side == toward) & (place >= 0)
        turned[known] = turns[place[known]]
    first = np.ones(len(table), dtype=bool)
    first[1:] = (side[1:] != side[:-1]) | (turned[1:] > begin[:-1])
    return tuple(
        CableContact(start, speed, tension, int(number), fresh, top, end)
        for (start, speed, end, top, tension, number), fresh in zip(table.tolist(), first.tolist(), strict=True)
    )
