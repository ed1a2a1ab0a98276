"""The numbers of the first page that the anchors of a row give: holding capacity, horizontal pull, uplift."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from moyai.core.headline import Band, Headline
from moyai.design.anchor_needs import anchor_need, judged_end, sinker_weight
from moyai.structures.units.anchors import loads_at
from moyai.structures.units.doubts import not_known
from moyai.structures.units.largest import Largest, each_of
from moyai.structures.units.line_headlines import line_band, line_model, of_line, unknown_line, with_unknown
from moyai.structures.units.unjudged import Seas

#: Weights of sinkers that are the same.
_ALIKE = 1.005
_PULL, _UPLIFT, _LIES = "anchor_horizontal_tension_maximum", "anchor_vertical_tension_maximum", "least_grounded_length"


_LEAVES = "the line leaves the bed within its band"


def anchor_headlines(seas: Seas) -> Iterator[Headline]:
    """Return what an anchor must hold: of the line that pulls hardest, and the uplift wherever it is highest."""
    pulls = each_of(seas, _PULL)
    if not pulls:
        return
    items = [_load(found, "anchor_horizontal_tension", "Horizontal pull on an anchor") for found in pulls]
    asked = [_asked_by(pull) for pull in pulls]
    yield from with_unknown(pulls, [_capacity(found, item, asked) for found, item in zip(pulls, items, strict=True)])
    yield from with_unknown(pulls, items)
    lifts = each_of(seas, _UPLIFT)
    lifted = [_load(found, "anchor_vertical_tension", "Uplift at an anchor") for found in lifts]
    # before a sea that is known to lift nothing
    ranked = [
        replace(found, value=1e-300) if math.isnan(item.value) and found.value == 0.0 else found
        for found, item in zip(lifts, lifted, strict=True)
    ]
    yield from (_with_bed(item, seas) for item in with_unknown(ranked, lifted))


def _load(found: Largest, name: str, label: str) -> Headline:
    """Return a load of an anchor, known as far as the tension of its line is."""
    tension = _of_same_run(found, "line_tension_maximum")
    mean = float(found.data["line_tension_mean"].values[found.index])
    item = Headline(
        name, label, found.value, "N", found.where, line_model(tension), band=_band(found), digits=found.digits
    )
    if why := unknown_line(tension, mean):
        return not_known(item, why)
    bound, words = of_line(tension, mean)
    if bound == "at least" and found.value == 0.0:
        return not_known(item, words[2:])
    return replace(item, bound=bound, detail=words[2:] * (bound == "at least"))


def _band(found: Largest) -> Band | None:
    """Return the band of a load; that of an uplift reaches to the tension at which its line is judged."""
    band = found.spread(found.chance())
    band = band if band is not None and band.high > 0.0 else None
    if found.name != _UPLIFT or "anchor_curve_tension" not in found.data:
        return band
    tension, tensions = _of_same_run(found, "line_tension_maximum"), np.zeros(found.data.sizes["line"])
    tensions[found.index[-1]] = judged_end(tension.value, line_band(tension))
    end = float(loads_at(tensions, found.data)[1, found.index[-1]])
    if end <= judged_end(found.value, band):
        return band
    # means of what is cut off at nothing say less than the tension does
    low = found.value if band is None else band.low
    return Band(low, end, "at the end of its tension at which the line is judged")


def _of_same_run(found: Largest, name: str) -> Largest:
    """Return another number of the same line in the same sea."""
    return replace(found, name=name, value=float(found.data[name].values[found.index]))


def _capacity(found: Largest, pull: Headline, asked: list[_Asked]) -> Headline:
    item = replace(pull, name="anchor_capacity_required", label="Horizontal holding capacity that an anchor needs")
    if math.isnan(pull.value):
        return item
    uplift, grounded = _of_same_run(found, _UPLIFT), _of_same_run(found, _LIES)
    lifted = judged_end(uplift.value, _band(uplift))
    heaviest = max(asked, key=lambda one: one.sinker)
    # lines that lie alike ask for the same one
    alike = heaviest.sinker <= _ALIKE * sinker_weight(judged_end(found.value, _band(found)), lifted)
    need = anchor_need(lifted, grounded.value, heaviest.sinker, "" if alike else heaviest.line)
    band = None if item.band is None else item.band.scaled(need.factor)
    words = need.words
    if pull.bound == "at least" and lifted == 0.0:
        words = f"{words.split('; ')[0]}, if it holds a line that stays on the bed, which is not known"
    raised = max((one for one in asked if one.uplift > 0.0), key=lambda one: one.uplift, default=None)
    if raised is not None and lifted == 0.0:
        words += f"; no drag anchor holds line {raised.line}, which lifts it"
    # another line may stand next to it, of an anchor of another kind
    where = f"{item.where}, {need.factor:g} times its pull"
    return replace(item, value=need.factor * found.value, band=band, detail=words, where=where)


class _Asked(NamedTuple):
    """What the anchor of a line requires in a sea: the weight of a sinker, the uplift at which it is judged [N]."""

    line: str
    sinker: float
    uplift: float


def _asked_by(pull: Largest) -> _Asked:
    lifted = judged_end((uplift := _of_same_run(pull, _UPLIFT)).value, _band(uplift))
    weight = sinker_weight(judged_end(pull.value, _band(pull)), lifted)
    return _Asked(str(pull.data["line"].values[pull.index[-1]]), weight, lifted)


def _with_bed(item: Headline, seas: Seas) -> Headline:
    """Return an uplift; where there is none, with what lies on the bed at the least."""
    if item.value != 0.0:
        return item
    ends = (_LIES, f"{_LIES}_high", f"{_LIES}_of_realisation")
    least = min(float(np.nanmin(data[end].values)) for _, data in seas for end in ends if end in data)
    kept = f"{least:.3g} m of line stays on the bed" if least > 0.0 and item.band is None else _LEAVES
    return replace(item, text="none", detail=kept)


__all__ = ["anchor_headlines"]
