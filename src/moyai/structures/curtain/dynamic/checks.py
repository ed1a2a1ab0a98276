"""Energy checks of a run of a span, and what is reported of it: where it left its range, what it did not reach."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.validity import IdentityCheck, Notice
from moyai.core.wording import spoken
from moyai.structures.curtain.dynamic.runs import DynamicRun

#: Part of the energy of a span that viscosity may take in a period: a snap loses some per cent, crumpling much more.
MOST_VISCOUS = 0.3
#: Part of the skirt's depth that is left below which a risen toe is reported; change of the peaks of two periods beyond
#: which a motion has not settled.
_RISEN, _UNSETTLED = 0.8, 0.1
#: Share of a run after which its highest tension may still be exceeded.
_LATER = 0.5
#: The same below which the added mass of the whole depth is far too large; peak of the first half of what is counted
#: of an irregular sea over that of the second, from which it is taken for that of the start.
_FLAT, _STARTED = 0.5, 1.5
#: Elastic over kinetic energy of a start that is said to be just taut; strain beyond which no rope works.
_STRAINED, _STRETCHED = 0.05, 0.25


def run_checks(run: DynamicRun, place: str) -> tuple[IdentityCheck, ...]:
    """Return the energy checks of a run: its spurious energy, and what viscosity had to take.

    The second finds cloth that crumples in the mesh: turning sections then feed it and viscosity eats it, so that the
    sum balances while the peaks are those of the mesh.
    """
    history = run.history
    total = history.kinetic_energy + history.elastic_energy
    stored = max(float(total.max()), 1e-300)
    through = max(stored, float(np.max(np.abs(history.work))))
    gained = float(np.max(history.energy_balance))
    # in every period of waves as much as the span ever holds may pass
    waves = run.flow.waves
    length = float(history.time[-1] - history.time[0])
    passes = 1.0 if waves is None else max(1.0, length * float(np.max(waves.omega)) / (2.0 * math.pi))
    return (
        IdentityCheck(
            f"{place}: energy of the span",
            max(gained, 0.0) / through,
            0.01,
            "energy beyond the work done, over the energy that went through; viscosity can only take",
        ),
        IdentityCheck(
            f"{place}: energy that viscosity took",
            max(-float(np.min(history.energy_balance)), 0.0) / (stored * passes),
            MOST_VISCOUS,
            "over the highest energy of the span and the periods run; more is cloth that crumples in the mesh",
        ),
    )


def crumples(run: DynamicRun) -> bool:
    """Return whether a run stopped, or went on with energy that turning sections fed and viscosity ate."""
    if run.history.status == "not_converged":
        return True
    return run.history.status == "converged" and not all(check.passed for check in run_checks(run, ""))


def run_notices(run: DynamicRun, place: str, period: float, regular: bool) -> tuple[Notice, ...]:
    """Tell what limits the peaks of a run.

    Parameters
    ----------
    run : DynamicRun
    place : str
        What the run is called.
    period : float
        Of the waves; the rise of model A without waves [s].
    regular : bool
        Whether the waves are regular.
    """
    found = [_risen(run, place), _strained(run, place), _stretched(run, place)]
    if run.flow.waves is None:
        found.append(_short(run, place, period))
    else:
        found.append(_before(run, place))
        if regular:
            found.append(_unsettled(run, place, period))
        else:
            found.append(_started(run, place, period))
    return tuple(notice for notice in found if notice is not None)


def plain(value: float) -> str:
    """Return a number with four digits and without powers of ten."""
    return f"{float(f'{value:.4g}'):.0f}" if abs(value) >= 1000.0 else f"{value:.4g}"


def still_rises(run: DynamicRun) -> bool:
    """Return whether the highest tension is in the second half of the run, where a higher one may still follow.

    A skirt with a free toe has a first snap while it is upright and a higher one where its swing ends, several rises
    of model A later; a run that ends between both shows the first one as its peak.
    """
    time = run.history.time
    middle = float(time[0]) + _LATER * float(time[-1] - time[0])
    return any(run.peak(name)[1] > middle for name in ("both", *run.names) if _leads(run, name))


def _leads(run: DynamicRun, name: str) -> bool:
    """Return whether a line carries enough for its peak to matter."""
    return run.peak(name)[0] > 0.5 * max(run.peak(other)[0] for other in run.names)


def _risen(run: DynamicRun, place: str) -> Notice | None:
    history, grid = run.history, run.built.grid
    first = history.position[0, grid[:, 0], 2] - history.position[0, grid[:, -1], 2]
    reach = history.position[:, grid[:, 0], 2] - history.position[:, grid[:, -1], 2]
    left = float(np.min(reach / first[None, :]))
    if left >= _RISEN:
        return None
    way = f"until {100.0 * left:.0f} % of the skirt's depth are left" if left > 0.0 else "as high as the upper edge"
    return Notice(
        "dynamic-risen-toe",
        f"{place}: the toe rises {way}; the added mass is that of the whole depth",
        left, _RISEN, "information" if left > _FLAT else "warning", "take more ballast, or read the peak as high",
        "sections of added mass are those of the skirt that hangs",
    )  # fmt: skip


def _strained(run: DynamicRun, place: str) -> Notice | None:
    """Tell a start that is strained already: a bulging skirt that is stiff along the span does not fit its cables."""
    stored, moving = float(run.history.elastic_energy[0]), float(run.history.kinetic_energy[0])
    span = run.built.span
    if span.span_stiffness == 0.0 or span.chord >= span.skirt_length or stored <= _STRAINED * moving:
        return None
    return Notice(
        "dynamic-strained-start",
        f"{place}: a bulging skirt that is stiff along the span holds {stored:.3g} J at the start, its motion "
        f"{moving:.3g} J: the peak is the release of that, and grows with the mesh",
        stored / moving if moving > 0.0 else math.inf, _STRAINED, "error", "give a chord as long as the skirt",
        "elastic energy of the start",
    )  # fmt: skip


def _stretched(run: DynamicRun, place: str) -> Notice | None:
    """Tell cables and lines that stretch as no rope does: more often a wrong unit of EA than a rope."""
    span = run.built.span
    lines = 0.0 if span.support is None else span.support.stiffness
    known = {"upper cable": span.upper_stiffness, "lower cable": span.lower_stiffness}
    strains = {name: run.peak(name)[0] / known.get(name, lines) for name in run.names}
    name = max(strains, key=lambda one: strains[one])
    if run.history.status == "not_converged" or strains[name] <= _STRETCHED:
        return None
    return Notice(
        "dynamic-stretched",
        f"{place}: {name} is stretched by {100.0 * strains[name]:.0f} %, which ropes and chains are not: its EA is "
        f"{plain(known.get(name, lines))} N",
        strains[name], _STRETCHED, "warning", "see whether the stiffness is given in the unit that is meant",
        "highest tension over EA",
    )  # fmt: skip


def _short(run: DynamicRun, place: str, rise: float) -> Notice | None:
    length = float(run.history.time[-1])
    if run.history.status != "converged":
        return None
    if length < rise:
        return Notice(
            "dynamic-short",
            f"{place}: the run of {length:.3g} s is shorter than the rise of the snap by model A, {rise:.3g} s: its "
            "highest tension is no peak",
            length, rise, "warning", "give a longer duration of the dynamic run, or leave it out",
            "time of the peak of model A",
        )  # fmt: skip
    if still_rises(run):
        return Notice(
            "dynamic-short",
            f"{place}: the highest tension is in the second half of the run of {length:.3g} s: a higher one may "
            "follow",
            length, length, "warning", "give a longer duration of the dynamic run", "time of the highest tension",
        )  # fmt: skip
    return None


def _before(run: DynamicRun, place: str) -> Notice | None:
    """Tell a tension that is higher before counting begins, while the waves grow and the motion settles."""
    both, counted = run.both, run.counted
    peak, before = float(both[counted].max()), both[~counted]
    if before.size == 0 or float(before.max()) <= (1.0 + _UNSETTLED) * peak:
        return None
    high, when = float(before.max()), float(run.history.time[~counted][int(np.argmax(before))])
    return Notice(
        "dynamic-before",
        f"{place}: before {run.from_time:.4g} s, where statistics begin, both cables carry {plain(high)} N (at "
        f"{when:.4g} s), after it {plain(peak)} N",
        high / peak, 1.0 + _UNSETTLED, "information", "a sea that comes up this quickly is rare; judge by which one is "
        "asked for", "highest tension of the settling time",
    )  # fmt: skip


def _started(run: DynamicRun, place: str, period: float) -> Notice | None:
    """Tell a peak of an irregular sea that belongs to the start, while current and waves come up."""
    if run.history.status != "converged":
        return None
    # the highest crest of the sea stands at three fifths of the run
    time, both = run.history.time, run.both
    late = time > 0.5 * float(time[-1])
    peak, when = run.peak("both")
    after = float(both[late].max())
    if bool(late[int(np.argmin(np.abs(time - when)))]) or peak <= _STARTED * after:
        return None
    return Notice(
        "dynamic-start",
        f"{place}: the highest tension of both cables, {plain(peak)} N, is at {when:.4g} s, {when / period:.2g} "
        "peak periods after the start from rest; in the second half of the run, with its highest crest, they carry "
        f"at most {plain(after)} N: the peaks are those of a current and waves that come up within one period",
        peak / after if after > 0.0 else math.inf, _STARTED, "warning",
        "give more settled periods with a larger count of waves to leave the start out",
        "tensions of both halves of the run",
    )  # fmt: skip


def _unsettled(run: DynamicRun, place: str, period: float) -> Notice | None:
    """Tell regular waves whose periods still have different peaks."""
    time, both = run.history.time[run.counted], run.both[run.counted]
    count = int((time[-1] - time[0]) / period + 1e-6)
    if run.history.status != "converged" or count < 2:
        return None
    number = np.minimum(((time - time[0]) / period).astype(np.int64), count - 1)
    peaks = [float(both[number == one].max()) for one in range(count)]
    if max(peaks) <= (1.0 + _UNSETTLED) * min(peaks):
        return None
    return Notice(
        "dynamic-unsettled",
        f"{place}: the highest tension of both cables in a period lies between {spoken(min(peaks), 'N', 3)} and "
        f"{spoken(max(peaks), 'N', 3)} over {count} periods: the motion has not settled, and the highest is that of "
        "these periods only",
        max(peaks) / min(peaks) if min(peaks) > 0.0 else math.inf, 1.0 + _UNSETTLED, "warning",
        "give more settled and analysed periods; snaps in regular waves may never settle",
        "peaks of each period",
    )  # fmt: skip


__all__ = ["MOST_VISCOUS", "plain", "run_checks", "run_notices", "still_rises"]
