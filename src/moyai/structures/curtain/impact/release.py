"""Release of a held curtain: how fast it drifts when it becomes taut, and the whole snap from release to plateau."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from moyai.core.curves import crossing
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.structures.curtain.impact.cable import Impact
from moyai.structures.curtain.impact.cycles import SlackTautMotion, rise_time, simulate_in_flow, slack_sag
from moyai.structures.curtain.statics.closed_forms import solve_cable


@dataclass(frozen=True)
class SlackPhase:
    """Drift of a slack curtain from its release until it is taut."""

    #: Where mid-span was let go, downstream of the line between the supports [m].
    position: float
    #: How fast mid-span was let go [m/s].
    speed_at_release: float
    #: From release to the taut instant [s].
    duration: float
    #: Of mid-span when it becomes taut, positive downstream [m/s].
    speed: float
    #: 1 when it becomes taut downstream, -1 upstream.
    side: int
    #: Speed over that of the water [-]; infinite in water at rest.
    share: float

    def started(self, impact: Impact) -> Impact:
        """Return the span with the speed that the slack phase gave it."""
        return replace(impact, speed=abs(self.speed))


def slack_phase(
    impact: Impact, *, drag_coefficient: float, current: float, position: float, speed: float, mass: float | None = None
) -> SlackPhase:
    """Return how a curtain let go in a steady current becomes taut [eq:impact-slack-phase].

    Parameters
    ----------
    impact : Impact
        The span; its speed does not enter.
    drag_coefficient : float
        C_D of the skirt, on d per metre of span; 0 keeps the speed of the release.
    current : float
        U [m/s], depth mean over the skirt, along the normal of the span.
    position, speed : float
        Mid-span at the release [m], [m/s].
    mass : float, optional
        Added mass [kg/m], M0 of the paper by default.

    Raises
    ------
    InputError
        When a number is out of range, the curtain is taut when it is let go, or it never becomes taut.
    """
    sag = slack_sag(impact)
    moved = impact.deep_mass if mass is None else float(mass)
    for name, value in {"current": current, "position": position, "speed": speed, "mass": moved}.items():
        if not math.isfinite(value):
            raise InputError(f"{name} is {value:g}", parameter=name, allowed="finite")
    if not (math.isfinite(drag_coefficient) and drag_coefficient >= 0.0):
        raise InputError(f"drag_coefficient is {drag_coefficient:g}", parameter="drag_coefficient", allowed="0 or more")
    if sag == 0.0:
        raise InputError(
            "the cable is as long as its span: it is taut from the start",
            parameter="length",
            allowed=f"above {impact.span:g} m",
            remedy="give the speed at the taut instant",
        )
    if abs(position) >= sag:
        raise InputError(
            f"the curtain is released {position:g} m from the line between the supports; it is taut there",
            parameter="position",
            allowed=f"between {-sag:.4g} and {sag:.4g} m",
            remedy="release it nearer, or give the speed at the taut instant",
        )
    decay = 0.5 * impact.water.density * drag_coefficient * impact.draught / moved
    lag = current - speed

    def slip(time: float) -> float:
        return lag / (1.0 + decay * abs(lag) * time)

    def place(time: float) -> float:
        if decay * abs(lag) * time < 1e-12:
            return position + speed * time
        return position + current * time - math.copysign(math.log1p(decay * abs(lag) * time) / decay, lag)

    # The speed current - slip goes one way only, so mid-span turns back once at most
    turn = 0.0
    if current != 0.0 and lag / current > 1.0 and decay > 0.0:
        turn = (lag / current - 1.0) / (decay * abs(lag))
        time = _reach(place, 0.0, turn, sag)
        if time is not None:
            return _phase(time, current - slip(time), position, speed, current)
    ahead = max(turn, sag / max(abs(current), abs(speed), 1e-300))
    for _ in range(200):
        time = _reach(place, turn, ahead, sag)
        if time is not None:
            return _phase(time, current - slip(time), position, speed, current)
        ahead *= 2.0
        if not math.isfinite(ahead) or (current == 0.0 and abs(place(ahead)) < sag and ahead > 1e12):
            break
    raise InputError(
        "the curtain never becomes taut: neither current nor release moves it that far",
        parameter="current",
        allowed="not 0, or a release fast enough",
        remedy="give a current, or the speed at the taut instant",
    )


def _reach(place, low: float, high: float, sag: float) -> float | None:  # type: ignore[no-untyped-def]
    """Return when |place| reaches the sag within times between which it goes one way, or None."""
    if high <= low or abs(place(high)) < sag:
        return None
    side = math.copysign(1.0, place(high))
    return crossing(lambda time: side * place(time) - sag, low, high, tolerance=1e-14 * high)


def _phase(time: float, found: float, position: float, speed: float, current: float) -> SlackPhase:
    share = found / current if current != 0.0 else math.inf
    return SlackPhase(position, speed, time, found, 1 if found > 0.0 else -1, share)


@dataclass(frozen=True, eq=False)
class Snap:
    """A snap from release to plateau."""

    #: Series with drag.
    motion: SlackTautMotion
    #: When the cable becomes taut [s].
    taut_time: float
    #: When the tension is largest [s].
    peak_time: float
    #: At the taut instant [m/s].
    start_speed: float
    #: Largest tension, sum of both cables [N].
    peak_tension: float
    #: Tension of the steady current, sum of both cables [N].
    plateau_tension: float
    #: A warning where the series ends before the plateau.
    notices: tuple[Notice, ...]

    @property
    def impact_tension(self) -> float:
        """Peak above the plateau [N]."""
        return self.peak_tension - self.plateau_tension


def snap_in_current(
    impact: Impact,
    *,
    drag_coefficient: float,
    current: float,
    position: float,
    speed: float,
    duration: float | None = None,
    time_step: float | None = None,
    mass: float | None = None,
) -> Snap:
    """Return the snap of a curtain let go in a steady current: slack, spike, plateau [eq:impact-slack-taut].

    Parameters
    ----------
    impact, drag_coefficient, current, position, speed, mass
        As in :func:`slack_phase`; the current must carry the curtain to one side.
    duration : float, optional
        Of the series [s]; by default the slack phase and forty rises.
    time_step : float, optional
        Of the series [s]; a 25th of the rise of model A by default.
    """
    phase = slack_phase(
        impact, drag_coefficient=drag_coefficient, current=current, position=position, speed=speed, mass=mass
    )
    if not (current != 0.0 and drag_coefficient > 0.0):
        raise InputError(
            "a plateau needs current and drag", parameter="current", allowed="not 0, with drag_coefficient > 0"
        )
    rise = rise_time(phase.started(impact))
    step = 0.04 * rise if time_step is None else time_step
    last = phase.duration + 40.0 * rise if duration is None else duration
    for name, value in {"duration": last, "time_step": step}.items():
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name} is {value:g} s", parameter=name, allowed="greater than 0")
    count = max(1, math.ceil(last / step - 1e-9))
    flow = np.zeros((count + 1, 2))
    flow[:, 0] = current
    motion = simulate_in_flow(impact, drag_coefficient, flow, step, (position, speed), mass=mass)
    if not motion.contacts:
        raise InputError(
            f"the series of {last:g} s ends before the cable is taut at {phase.duration:.4g} s",
            parameter="duration",
            allowed=f"above {phase.duration:.4g} s",
        )
    load = 0.5 * impact.water.density * drag_coefficient * impact.draught * current**2
    plateau = float(solve_cable(impact.span, impact.length, load, impact.stiffness).tension)
    largest = max(motion.contacts, key=lambda contact: contact.tension)
    notices: tuple[Notice, ...] = ()
    tail = motion.tension[-max(2, len(motion.tension) // 10) :]
    swing = float(np.abs(tail / plateau - 1.0).max())
    if swing > 0.05:
        notices = (
            Notice(
                "impact-no-plateau",
                f"at the end of the series the tension is still {100.0 * swing:.3g} % off the plateau",
                swing,
                0.05,
                severity="information",
                remedy="give a longer duration",
                source="tension of the steady current",
            ),
        )
    return Snap(motion, motion.contacts[0].time, largest.peak_time, phase.speed, largest.tension, plateau, notices)
