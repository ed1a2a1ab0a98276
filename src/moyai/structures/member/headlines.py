"""The numbers of a member's first page: the largest force with its causes and band, and where its KC stands.

How the answer is made: docs/answer/member.md.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import product
from typing import TYPE_CHECKING, Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.headline import Band, Bound, Headline, all_judged
from moyai.core.validity import Notice
from moyai.core.wording import spoken, spoken_time
from moyai.morison.coefficient_ranges import CIRCULATION, DRAG_RANGES, MeasuredRange, drag_range, inertia_range
from moyai.morison.coefficients import (
    API_ROUGH,
    DNV_CREST,
    DNV_CURRENT,
    DNV_NEAR_CURRENT,
    POST_CRITICAL,
    amplified_drag,
    dnv_added_mass,
    dnv_drag,
    dnv_steady_drag,
    share_below_crisis,
)
from moyai.series.block_maxima import LEAST_PERIODS, too_short
from moyai.series.intervals import reach_of_mean
from moyai.series.realisations import ALONE, alone
from moyai.structures.member.model import MemberProblem
from moyai.structures.member.supports import held_at
from moyai.structures.member.waves import STEADY
from moyai.tables.member_drag import api_circle, steady_circle

if TYPE_CHECKING:
    import xarray as xr


#: Share of the largest force above which a cause counts as one that decides.
DECIDES = 0.1
#: Share of the largest force of all above which the coefficients of another sea count too.
NEAR = 0.7
_CAUSES = ("inertia", "drag", "lift")
_NOT_JUDGED = Headline(
    "not_judged", "Not judged", math.nan, "1",
    text="strength and fatigue of the section, slamming and run-up, vibration by vortices, scour", condition=True,
)  # fmt: skip
#: Drag and inertia are read at the KC of waves and current together, the circulation at that of the waves
_COEFFICIENTS, _CIRCULATION = "coefficient_keulegan_carpenter", "keulegan_carpenter"
_Kind = Literal["force", "end_force", "bending_moment"]


@dataclass(frozen=True, eq=False)
class _Largest:
    """The wave with the largest force or moment of all: its place in the result, causes over time (causes, times, k).

    ``value`` is the mean over the realisations of an irregular sea, the causes are those of the record nearest to it;
    ``scatter`` is the value of each realisation, one in a regular wave.
    """

    where: str
    causes: Array
    row: int
    value: float
    sea: xr.Dataset
    wave: int
    scatter: Array
    theory: str
    #: Of its record [s].
    time: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def steady(self) -> bool:
        """Whether it is of a current without waves."""
        return self.theory == STEADY

    def number(self, name: str) -> float:
        """Return a number of the wave, at the strip of the largest KC."""
        return float(self.sea.variables[name].values[self.wave])


def headlines_of(problem: MemberProblem, groups: Mapping[str, xr.Dataset]) -> tuple[Headline, ...]:
    """Return the first page's numbers of a member.

    Parameters
    ----------
    problem : MemberProblem
    groups : mapping of str to xarray.Dataset
        What was run, by its place in the result.
    """
    found = _largest(groups, "force")
    if found is None:
        return ()
    shares = _shares(found)
    ranges = _ranges(problem, found)
    laws = [found.theory, *(item.name for item in (ranges[:1] if found.steady else ranges[1::-1]))]
    model = ", ".join(["Morison's equation", *laws])
    if problem.circulation.counted and not found.steady:
        model += f", {CIRCULATION.name}"
    force = Headline(
        "peak_force", "largest force on the member", found.value, "N", found.where, model,
        _band(found, ranges), bound=_bound(found),
        detail=_causes_text(shares) + _chance_text(found) + _crest_text(problem, found),
    )  # fmt: skip
    items = _with_the_others(problem, groups, "force", force)
    number, of_waves, reynolds = (found.number(key) for key in (_COEFFICIENTS, _CIRCULATION, "reynolds"))
    reported = [_range_text(item, found.number(_number_of(item)), reynolds) for item in ranges]
    if found.steady:
        items.append(
            Headline("reynolds", "Reynolds number", reynolds, "1", found.where, detail=reported[0], condition=True)
        )
    else:
        if number != of_waves:
            reported.append(f"with the current, of the waves alone {of_waves:.3g}")
        items.append(
            Headline(
                "keulegan_carpenter", _number_label(found), number, "1", found.where,
                detail="; ".join([*reported, f"Re = {reynolds:.2g}"]), condition=True,
            )
        )  # fmt: skip
    ends, bending = _largest(groups, "end_force"), _largest(groups, "bending_moment")
    held = held_at(problem.support)
    # a fixed end carries the whole force, which stands above
    if ends is not None and problem.support == "both_ends":
        end = Headline(
            "end_force", "largest force at an end", ends.value, "N", ends.where, model,
            _band(ends, _ranges(problem, ends)), bound=_bound(ends), detail=held + _ends_text(ends),
        )  # fmt: skip
        items += _with_the_others(problem, groups, "end_force", end)
    if bending is not None:
        along = bending.sea.variables["maximum_bending_moment_along"].values[bending.wave]
        place = float(bending.sea.variables["station"].values[int(np.argmax(along))])
        where = f"{place:.3g} m from its start"
        cause = "of the current alone" if bending.steady else "of waves and current alone"
        if problem.support != "both_ends" and int(np.argmax(along)) in (0, along.size - 1):
            where = "at the fixed end"
        moment = Headline(
            "bending_moment", "largest bending moment", bending.value, "N m", bending.where, model,
            _band(bending, _ranges(problem, bending)), bound=_bound(bending),
            detail=f"{held}, {where}; {cause}{_ends_text(bending)}",
        )  # fmt: skip
        items += _with_the_others(problem, groups, "bending_moment", moment)
    return (*items, _NOT_JUDGED)


def _number_label(found: _Largest) -> str:
    regular = found.sea.attrs.get("kind") == "regular"
    return "Keulegan-Carpenter number" + ("" if regular else " of the regular motion of equal variance")


def range_notices(problem: MemberProblem, groups: Mapping[str, xr.Dataset]) -> tuple[Notice, ...]:
    """Warn where a cause that decides a largest force has coefficients outside their measured range of KC.

    Of each cause the sea with the largest force is named; a sea counts that reaches :data:`NEAR` of the largest.
    """
    found = list(_all(groups, "force"))
    most = max((item.value for item in found), default=0.0)
    notices: dict[str, Notice] = {}
    for item in sorted(found, key=lambda one: -one.value):
        if item.value < NEAR * most:
            break
        for notice in _range_notices(problem, item):
            notices.setdefault(notice.message.split(": ", 1)[1].split(" was ")[0], notice)
    return tuple(notices.values())


def _range_notices(problem: MemberProblem, found: _Largest) -> Iterator[Notice]:
    shares = dict(zip(_CAUSES, _shares(found), strict=True))
    for cause, measured in zip(("drag", "inertia", "lift"), _ranges(problem, found), strict=False):
        if found.steady:
            continue  # a law of steady flow is for Reynolds numbers, and says so where it is read
        low, high = measured.keulegan_carpenter
        number = found.number(_number_of(measured))
        if abs(shares[cause]) < DECIDES or low <= number <= high:
            continue
        limit = low if number < low else high
        yield Notice(
            "coefficients-outside-measurement",
            f"{found.where}: {measured.name} was measured at KC {'above' if number < low else 'below'} {limit:g}, "
            f"here KC = {number:.3g}; {cause} makes {100.0 * shares[cause]:.0f} % of the largest force",
            number, limit, "warning", "give coefficients measured at this KC", measured.source,
        )  # fmt: skip


def _ranges(problem: MemberProblem, found: _Largest) -> tuple[MeasuredRange, ...]:
    """Return the ranges of drag, inertia and, where it is counted, the circulation.

    Where the drag of DNV-RP-C205 keeps the crest of its amplification, the steady drag is its lower end. Where a
    current nears the speed from which its laws are those of steady flow, the upper ends go towards theirs. Below the
    Reynolds numbers of post-critical flow the upper end of drag holds that of a circle before the drag crisis.
    """
    drag, inertia, crest = drag_range(problem.rule), inertia_range(problem.rule), _crest(problem, found)
    if crest > 1.0:
        drag = replace(drag, below=1.0 - (1.0 - drag.below) / crest)
    drag, inertia = _towards_steady_flow(problem, found, (drag, inertia))
    drag = _below_crisis(problem, found, drag)
    return (drag, inertia, CIRCULATION) if problem.circulation.counted else (drag, inertia)


def _towards_steady_flow(
    problem: MemberProblem, found: _Largest, ranges: tuple[MeasuredRange, MeasuredRange]
) -> tuple[MeasuredRange, MeasuredRange]:
    """Return the ranges of drag and inertia with upper ends near those of steady flow [eq:morison-near-current].

    The laws of DNV-RP-C205 jump where a current comes to :data:`DNV_CURRENT` of the orbital speed. From
    :data:`DNV_NEAR_CURRENT` on the upper ends go in proportion from those in waves to those beyond, so that the force
    that is judged does not jump.
    """
    if found.steady:
        return ranges
    number, of_waves = found.number(_COEFFICIENTS), found.number(_CIRCULATION)
    ratio = number / of_waves - 1.0 if of_waves > 0.0 else math.inf
    if not DNV_NEAR_CURRENT < ratio < DNV_CURRENT:
        return ranges
    part = (ratio - DNV_NEAR_CURRENT) / (DNV_CURRENT - DNV_NEAR_CURRENT)
    roughness = problem.roughness / problem.member.placed_section.breadth
    most = [1.0, 1.0]
    if problem.rule.drag == "dnv_c205":
        most[0] = max(dnv_steady_drag(roughness) / dnv_drag(number, roughness), 1.0)
    if problem.rule.inertia == "dnv_c205":
        most[1] = (1.0 + dnv_added_mass(of_waves, roughness)) / (1.0 + dnv_added_mass(number, roughness))
    note = f"upper ends towards steady flow, as the current is {ratio:.2g} times the orbital speed"
    drag, inertia = (
        replace(one, above=(1.0 + one.above) * (1.0 + part * (more - 1.0)) - 1.0, note=note) if more > 1.0 else one
        for one, more in zip(ranges, most, strict=True)
    )
    return drag, inertia


def _below_crisis(problem: MemberProblem, found: _Largest, drag: MeasuredRange) -> MeasuredRange:
    """Return the range of drag with an upper end that holds the drag of a circle before the drag crisis.

    Laws of post-critical flow say 0.65 of a smooth circle in steady flow, where one before the crisis has 1.2; in waves
    both are amplified alike, and the allowance of the law comes on top [eq:morison-crisis].
    """
    laws = ("dnv_c205", "api")
    reynolds = found.number("reynolds")
    if problem.rule.drag not in laws or not problem.member.placed_section.is_circle or not reynolds < POST_CRITICAL:
        return drag
    roughness = problem.roughness / problem.member.placed_section.breadth
    share = share_below_crisis(reynolds, roughness)
    number, of_waves, ratio = math.inf, 0.0, math.inf
    if not found.steady:
        number, of_waves = found.number(_COEFFICIENTS), found.number(_CIRCULATION)
        ratio = number / of_waves - 1.0 if of_waves > 0.0 else math.inf
    before = steady_circle().drag
    in_waves, in_current = amplified_drag(before, number), amplified_drag(before, number, DNV_CURRENT)
    near = min(max((ratio - DNV_NEAR_CURRENT) / (DNV_CURRENT - DNV_NEAR_CURRENT), 0.0), 1.0)
    most = in_waves + near * (in_current - in_waves)
    own = dnv_drag(number, roughness, ratio)
    if problem.rule.drag == "api":
        own = api_circle(rough=roughness >= API_ROUGH).drag
    more = (1.0 + DRAG_RANGES[str(problem.rule.drag)].above) * most / own - 1.0 - drag.above
    if not share * more > 0.0:
        return drag
    note = f"upper end towards C_D = {most:.2g} before the drag crisis, as Re is below {POST_CRITICAL:.0e}"
    return replace(drag, above=drag.above + share * more, note="; ".join(filter(None, (drag.note, note))))


def _crest(problem: MemberProblem, found: _Largest) -> float:
    """Return the amplification of the drag that is kept at its crest beyond KC = 12, 1 where none is."""
    if problem.rule.drag != "dnv_c205" or found.steady or not found.number(_COEFFICIENTS) > DNV_CREST:
        return 1.0
    roughness = problem.roughness / problem.member.placed_section.breadth
    return dnv_drag(DNV_CREST, roughness) / dnv_steady_drag(roughness)


def _bound(found: _Largest) -> Bound:
    """Return what realisations of a random sea prove: one proves no limit kept, and several of a few waves do not."""
    return "at least" if _few_waves(found) else "" if _regular(found) else alone(found.scatter)


def _regular(found: _Largest) -> bool:
    return found.sea.attrs.get("kind") == "regular"


def _few_waves(found: _Largest) -> bool:
    """Whether the records of a random sea are so short that their largest values are those of a few waves."""
    return not _regular(found) and found.time.size > 1 and too_short(found.time, found.number("period"))


def _crest_text(problem: MemberProblem, found: _Largest) -> str:
    crest = _crest(problem, found)
    if crest <= 1.0:
        return ""
    return (
        f"; drag keeps the crest of its amplification, {crest:.2f} at KC = {DNV_CREST:g}, steady drag is the lower end"
    )


def _number_of(item: MeasuredRange) -> str:
    return _CIRCULATION if item is CIRCULATION else _COEFFICIENTS


def _runs(groups: Mapping[str, xr.Dataset]) -> Iterator[tuple[str, str, int, xr.Dataset, xr.Dataset]]:
    """Yield level, sea, wave, numbers of the sea and series of every run."""
    for path, sea in groups.items():
        parts = path.strip("/").split("/")
        if len(parts) != 3 or parts[1] != "waves":
            continue
        level, _, name = parts
        for wave in range(sea.sizes["wave"]):
            label = f"wave {wave + 1}" if sea.attrs["kind"] == "regular" else "sea"
            series = groups.get(f"/{level}/time/{name}/{label}")
            if series is not None:
                yield level, name, wave, sea, series


def _all(groups: Mapping[str, xr.Dataset], kind: _Kind) -> Iterator[_Largest]:
    """Yield the largest force or moment of every wave and sea."""
    name = "maximum_total_force" if kind == "force" else f"maximum_{kind}"
    for level, sea_name, wave, sea, series in _runs(groups):
        value = float(np.max(sea.variables[name].values[wave]))
        causes = np.stack([series.variables[f"{cause}_{kind}"].values for cause in ("inertia", "drag", "magnus")])
        size = np.linalg.norm(causes.sum(axis=0), axis=1)
        if sea.attrs["kind"] == "regular":
            # the last row of a wave that takes time to settle: the first from the end that reaches the value
            row = len(size) - 1 - int(np.argmin(np.abs(size[::-1] - value)))
        else:
            row = int(np.argmax(size))
        label = str(sea.variables["wave"].values[wave])
        where = ", ".join(part for part in (sea_name, "" if label in ("sea", sea_name) else label, level) if part)
        each = f"{name}_of_realisation"
        scatter = np.asarray(sea.variables[each].values, dtype=float) if each in sea else np.array([value])
        time = np.asarray(series["time"].values, dtype=float)
        yield _Largest(where, causes, row, value, sea, wave, scatter, str(series.attrs["theory"]), time)


def _largest(groups: Mapping[str, xr.Dataset], kind: _Kind) -> _Largest | None:
    return max(_all(groups, kind), key=lambda item: item.value, default=None)


def _with_the_others(
    problem: MemberProblem, groups: Mapping[str, xr.Dataset], kind: _Kind, shown: Headline
) -> list[Headline]:
    """Return a number with that of the sea whose unfavourable end is the highest, where that is another: both count."""
    others = [
        replace(
            shown,
            value=item.value,
            where=item.where,
            band=_band(item, _ranges(problem, item)),
            bound=_bound(item),
            detail="",
        )
        for item in _all(groups, kind)
        if item.where != shown.where
    ]
    return all_judged([shown, *others])


def _shares(found: _Largest) -> tuple[float, float, float]:
    """Return what inertia, drag and lift add along the largest force at its instant, over it: they add up to one."""
    parts = found.causes[:, found.row]
    total = parts.sum(axis=0)
    square = float(total @ total)
    if square == 0.0:
        return (0.0, 0.0, 0.0)
    return tuple(float(part @ total) / square for part in parts)  # type: ignore[return-value]


def _causes_text(shares: tuple[float, float, float]) -> str:
    words = ", ".join(f"{name} {100.0 * share:.0f} %" for name, share in zip(_CAUSES, shares, strict=True))
    return f"{_CAUSES[int(np.argmax(shares))]} decides: {words}"


def _chance_text(found: _Largest) -> str:
    """Say how uncertain the number is as one of the largest values of a random sea."""
    if _regular(found):
        return ""
    scatter = found.scatter
    if scatter.size < 2:
        return f"; largest of {_length_text(found)}; {ALONE}"
    deviation = spoken(float(scatter.std(ddof=1)), "N", 2, like=found.value)
    return (
        f"; mean of the largest of {scatter.size} realisations, their standard deviation {deviation}; each of "
        f"{_length_text(found)}"
    )


def _length_text(found: _Largest) -> str:
    """Say how long the records are, and when they are too short for the largest value of a storm."""
    few = f", less than {LEAST_PERIODS:g} periods: a longer sea gives more" if _few_waves(found) else ""
    return f"{spoken_time(float(np.ptp(found.time)))}{few}"


def _ends_text(found: _Largest) -> str:
    count = found.scatter.size
    return f"; mean of {count} realisations; each of {_length_text(found)}" if count > 1 else ""


def _band(found: _Largest, ranges: tuple[MeasuredRange, ...]) -> Band:
    """Return the smallest and largest peak with every coefficient at either end of its allowance.

    Forces are proportional to their coefficients [eq:morison-strip], so the series of the causes give every
    combination without a further run. In an irregular sea both ends are moved in proportion by the smallest and the
    largest realisation, or by the end of the one-sided 95 % interval of their mean, with which criteria are judged.
    """
    ends = [(1.0 - item.below, 1.0 + item.above) for item in ranges]
    order = (1, 0, 2)
    factors = [ends[k] if k < len(ends) else (1.0,) for k in order]
    peaks = [
        float(np.linalg.norm(np.tensordot(np.array(chosen), found.causes, axes=(0, 0)), axis=1).max())
        for chosen in product(*factors)
    ]
    words = [f"C_D -{100 * ranges[0].below:.0f} to +{100 * ranges[0].above:.0f} %"]
    if not found.steady:
        words.append(f"C_M -{100 * ranges[1].below:.0f} to +{100 * ranges[1].above:.0f} %")
    if len(ranges) > 2:
        words.append(f"circulation ±{100 * ranges[2].above:.0f} %")
    words += dict.fromkeys(item.note for item in ranges if item.note)
    own = float(np.linalg.norm(found.causes.sum(axis=0), axis=1)[found.row])
    scatter = found.scatter
    if scatter.size < 2 or own == 0.0:
        return Band(min([found.value, *peaks]), max([found.value, *peaks]), ", ".join(words))
    low, high = min([own, *peaks]) / own, max([own, *peaks]) / own
    reach = reach_of_mean(scatter)
    words.append(f"{scatter.size} realisations; judged at the 95 % end of their mean")
    most = max(float(scatter.max()), found.value + reach)
    return Band(
        low * float(scatter.min()), high * most, ", ".join(words), decides=False,
        judged=(low * (found.value - reach), high * (found.value + reach)),
        realisations=scatter.size, more="settings.realisations", settled=high * found.value,
    )  # fmt: skip


def _range_text(item: MeasuredRange, number: float, reynolds: float) -> str:
    def words(symbol: str, limits: tuple[float, float]) -> str:
        low, high = limits
        if low <= 0.0 and math.isinf(high):
            return ""
        if math.isinf(high):
            return f"{symbol} above {low:g}"
        return f"{symbol} {low:g} to {high:g}"

    reported = " and ".join(
        text for text in (words("KC", item.keulegan_carpenter), words("Re", item.reynolds)) if text
    ) or "no range stated"  # fmt: skip
    outside = "" if item.holds(number, reynolds) else " (outside)"
    return f"{item.name}: {reported}{outside}"


__all__ = ["DECIDES", "headlines_of", "range_notices"]
