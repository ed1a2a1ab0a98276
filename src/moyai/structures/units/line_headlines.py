"""The numbers of the first page that the lines of a row give: largest tension, its share of the breaking load."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.headline import Band, Bound, Headline, all_judged
from moyai.core.wording import spoken
from moyai.series.realisations import ALONE
from moyai.structures.units import doubts
from moyai.structures.units.largest import Largest, damping_band, each_of
from moyai.structures.units.model import SNAP_RATIO
from moyai.structures.units.unjudged import Seas

if TYPE_CHECKING:
    import xarray as xr

AT_REST = "linear, lines at rest at every instant"
TIME_AT_REST = "time domain, lines at rest at every instant"
IN_MOTION = "time domain, lines in motion around events"
#: What is said of a line without a breaking load next to lines that have one.
NO_STRENGTH = "breaking load not given of"


#: Groups of waves move a row on chains slowly and far about its mean place; a single unit with it has several times the
#: tension. Without it tensions and offsets of an irregular sea prove no strength.
_WITHOUT_DRIFT = "; slow drift about the mean is not computed and adds to it, on chains several times over"
_SNAPS = f"; pulled beyond {SNAP_RATIO:g} times its mean, where a line at rest at every instant says too little"
_SNAPS_WITH_DAMPING = f"; with damping at the end of its band{_SNAPS[1:]}"


def line_headlines(groups: Mapping[str, xr.Dataset], seas: Seas) -> Iterator[Headline]:
    each = each_of(seas, "line_tension_maximum")
    if not each:
        return
    yield from with_unknown(each, [_line_tension(found) for found in each])
    load = np.asarray(groups[f"/{each[0].path.split('/')[1]}/statics"]["breaking_load"].values, dtype=float)
    if not np.isfinite(load).any():
        return
    statics = groups[f"/{each[0].path.split('/')[1]}/statics"]
    # springs have no strength
    chains = (
        np.isfinite(statics["anchor_curve_tension"].values).all(axis=1) if "anchor_curve_tension" in statics else load
    )
    bare = ", ".join(str(each[0].data["line"].values[row]) for row in np.flatnonzero(np.isnan(load) & (chains > 0)))
    if bare:
        yield Headline(
            "line_utilisation", "Tension over breaking load of a line", math.nan, "1", text=f"{NO_STRENGTH} {bare}",
            shown=False,
        )  # fmt: skip
    shares = each_of(seas, "line_tension_maximum", load)
    yield from with_unknown(shares, [_utilisation(share, True) for share in shares])
    if any(_moved(share) for share in shares):
        # codes ask another factor of lines at rest: the highest of them is judged too
        still = [(path, _at_rest(data)) for path, data in seas]
        yield from (_utilisation(share, False) for share in each_of(still, "line_tension_maximum", load))


def with_unknown(each: list[Largest], items: list[Headline]) -> list[Headline]:
    """Return what governs, with the highest number that is not known: it stands first where none is higher."""
    pairs = list(zip(each, items, strict=True))
    unknown = [(found.value, item) for found, item in pairs if math.isnan(item.value)]
    known = [(found.value, item) for found, item in pairs if not math.isnan(item.value)]
    rest = all_judged([item for _, item in known]) if known else []
    if not unknown:
        return rest
    value, worst = max(unknown, key=lambda pair: pair[0])
    if any(other >= value for other, _ in known):
        return [*rest, replace(worst, shown=False, sea="")]
    return [worst, *(replace(item, shown=False, sea="") for item in rest)]


def unknown_line(found: Largest, mean: float) -> str:
    """Return why a line is not known: hulls that meet, or a linear motion that does not feel how tight it comes."""
    if doubts.meets(found.data):
        return doubts.MEET
    tension, damping = found.value * found.scale, damping_band(found.data, found.name, found.index)
    highest = tension if damping is None else max(tension, damping.high)
    if found.timed or highest <= SNAP_RATIO * mean:
        return ""
    if math.isinf(highest):
        return "a line at rest does not reach so far; run the time domain with lines in motion"
    ratio, given = highest / mean if mean > 0.0 else math.inf, spoken(tension, "N", 3)
    if tension <= SNAP_RATIO * mean:
        return (
            f"lines at rest give {given}, with damping at the end of its band {spoken(highest, 'N', 3)}, {ratio:.1f} "
            f"times the mean, beyond their range of {SNAP_RATIO:g}; run the time domain with lines in motion"
        )
    return (
        f"lines at rest give {given}, {ratio:.1f} times the mean, beyond their range of {SNAP_RATIO:g}; run the time "
        "domain with lines in motion"
    )


def _line_tension(found: Largest) -> Headline:
    mean = float(found.data["line_tension_mean"].values[found.index])
    if why := unknown_line(found, mean):
        return Headline(
            "line_tension", "Largest tension of a line", math.nan, "N", found.where, AT_REST, detail=why,
            text="not known", analysis="quasi_static",
        )  # fmt: skip
    bound, words = of_line(found, mean)
    return Headline(
        "line_tension", "Largest tension of a line", found.value, "N", found.where, line_model(found), mean=mean,
        bound=bound, band=line_band(found), detail=f"mean {spoken(mean, 'N', 3)}{words}", analysis=analysis_of(found),
        digits=found.digits,
    )  # fmt: skip


def _utilisation(share: Largest, shown: bool) -> Headline:
    own = float(share.data["line_tension_mean"].values[share.index])
    if why := unknown_line(share, own):
        return Headline(
            "line_utilisation", "Tension over breaking load of a line", math.nan, "1", share.where, AT_REST, detail=why,
            text="not known", analysis="quasi_static", shown=shown,
        )  # fmt: skip
    return Headline(
        "line_utilisation", "Tension over breaking load of a line", share.value, "1", share.where, line_model(share),
        mean=own / share.scale, bound=of_line(share, own)[0], band=line_band(share), analysis=analysis_of(share),
        shown=shown, digits=share.digits,
    )  # fmt: skip


def _at_rest(data: xr.Dataset) -> xr.Dataset:
    """Return a sea without the lines in motion, and without those that were found to stay under them."""
    if "lines_in_motion" not in data:
        return data
    tension, mean = data["line_tension_maximum"].values, data["line_tension_mean"].values
    kept = (data["lines_in_motion"].values == 0) & (tension <= SNAP_RATIO * mean)
    return data.assign(line_tension_maximum=(data["line_tension_maximum"].dims, np.where(kept, tension, np.nan)))


def _moved(found: Largest) -> bool:
    return "lines_in_motion" in found.data and bool(found.data["lines_in_motion"].values[found.index])


def line_band(found: Largest) -> Band | None:
    """Return the band of realisations, judged at what events that were not rerun leave open."""
    if not _moved(found):
        return found.band
    return found.spread(found.chance(found.members("line_tension_bound")))


def line_model(found: Largest) -> str:
    return IN_MOTION if _moved(found) else TIME_AT_REST if found.timed else AT_REST


def analysis_of(found: Largest) -> str:
    return "dynamic" if _moved(found) else "quasi_static"


def of_line(found: Largest, mean: float) -> tuple[Bound, str]:
    """Return the bound of a tension and its reason: slow drift left out, or snaps that lines at rest do not see."""
    if found.without_drift or found.lets_go:
        return "at least", left_out(found) + f"; {doubts.LETS_GO}" * found.lets_go
    if found.bound:
        return found.bound, f"; {ALONE}"
    if found.strained:
        return "at least", f"; {doubts.STRAINED}, run the time domain"
    if most := doubts.stretched(found.data):
        return (
            "at least",
            f"; motion across would stretch a connector by {most:.3g} m, not counted",
        )
    if _moved(found):
        still = float(found.data["line_tension_maximum_lines_at_rest"].values[found.index])
        return "", f"; {spoken(still, 'N', 3)} with lines at rest at every instant"
    if found.value * found.scale > SNAP_RATIO * mean:
        return "at least", _SNAPS
    damping = damping_band(found.data, found.name, found.index)
    if damping is not None and damping.high > SNAP_RATIO * mean:
        return "at least", _SNAPS_WITH_DAMPING
    return "", ""


def left_out(found: Largest) -> str:
    """Say which drift a number is without."""
    if found.drift_left_out:
        return "; the drift of the waves is left out and adds to it"
    return _WITHOUT_DRIFT if found.without_drift else ""
