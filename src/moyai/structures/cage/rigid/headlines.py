"""The numbers of a rigid cage's first page: tensions with the band of seed and net law, motions, rest."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.headline import Band, Headline
from moyai.series.block_maxima import too_short
from moyai.series.realisations import seeds
from moyai.structures.cage.bands import FEW_WAVES, NO_LAWS, alone, chance, laws_text
from moyai.structures.cage.conditions import condition_headlines, sea_words
from moyai.structures.cage.headlines import NOT_JUDGED, Groups, judged_seas
from moyai.structures.cage.rigid.laws import IN_WAVES
from moyai.structures.cage.rigid.realisations import MORE

if TYPE_CHECKING:
    import xarray as xr

RIGID = "rigid cage, run through time"
#: Largest values of the realisations of a sea.
_TENSIONS, _OFFSETS = "line_tension_maximum_of_realisation", "largest_offset_of_realisation"


def rigid_headlines(groups: Groups) -> tuple[Headline, ...]:
    """Return the first page's numbers of a rigid cage.

    Parameters
    ----------
    groups : mapping of str to xarray.Dataset
        What was run, by its place in the result.
    """
    seas = [
        (parts[0], parts[2], group)
        for path, group in groups.items()
        if len(parts := path.strip("/").split("/")) == 3 and parts[1] == "waves"
    ]
    items = (
        *_rigid_tension(seas, groups),
        *_rigid_anchor(seas, groups),
        *_rigid_offset(seas, groups),
        *_rigid_motions(seas, groups),
        *_rigid_rest(groups),
    )
    return (*map(alone, items), *condition_headlines(groups), *([NOT_JUDGED] if seas else []))


Seas = list[tuple[str, str, "xr.Dataset"]]


def _rigid_tension(seas: Seas, groups: Groups) -> list[Headline]:
    """Return the highest tension of all seas and the utilisations that decide, with the band of seed and net law."""
    tensions, utilisations = [], []
    bare: dict[str, None] = {}
    for level, name, sea in seas:
        breaking = groups[f"/{level}/statics"]["breaking_load"].values if sea.sizes["line"] else np.zeros(0)
        for wave, line in np.ndindex(sea.sizes["wave"], sea.sizes["line"]):
            item = _tension_of(level, name, sea, wave, line, groups)
            # a tension is judged as it is, the share of the breaking load by its parts too
            tensions.append(replace(item, mean=None))
            strength = float(breaking[line])
            if not math.isfinite(strength):
                bare[str(sea["line"].values[line])] = None
                continue
            band = item.band
            utilisations.append(
                replace(
                    item, name="line_utilisation", label="Tension over breaking load", value=item.value / strength,
                    unit="1", band=None if band is None else band.scaled(1.0 / strength),
                    mean=None if item.mean is None else item.mean / strength,
                    detail=f"breaking load {strength / 1e3:.4g} kN, without a safety factor",
                )
            )  # fmt: skip
    if bare and utilisations:
        # next to lines that have a strength
        text = f"breaking load not given of {', '.join(bare)}"
        open_one = Headline("line_utilisation", "tension over breaking load", math.nan, "1", text=text, shown=False)
        return [*judged_seas(tensions), *judged_seas(utilisations), open_one]
    return [*judged_seas(tensions), *judged_seas(utilisations)]


def _tension_of(level: str, name: str, sea: xr.Dataset, wave: int, line: int, groups: Groups) -> Headline:
    """Return the highest tension of a line in a wave, the mean over realisations, with band and mean at that end."""
    each = tensions_of_each(sea, wave)[:, line]
    end = int(np.argmax(each.mean(axis=0)))
    value, run = float(each[:, end].mean()), _run_of(level, name, sea, wave, groups)
    laws = _laws_of(level, name, sea, wave, groups)
    series = run["line_tension_peak_since_row"].values[:, line]
    band, said = _rigid_band(laws, run, each[:, end], series, line)
    where = f"{sea['line'].values[line]}, {_rigid_where(level, name, sea, wave, groups, realisations=len(each))}"
    return Headline(
        "line_tension", "highest line tension", value, "N", where, f"{RIGID}, {run.attrs['theory']}", band, detail=said,
        mean=float(sea["line_tension_mean"].values[wave, line, end]),
    )  # fmt: skip


def _rigid_anchor(seas: Seas, groups: Groups) -> list[Headline]:
    """Return the largest pull on an anchor: the highest tension at the lower end of a line."""
    found = []
    for level, name, sea in seas:
        if not sea.sizes["line"]:
            continue
        for wave, line in np.ndindex(sea.sizes["wave"], sea.sizes["line"]):
            each = tensions_of_each(sea, wave)[:, line]
            pulls = each[:, list(sea["end"].values).index("anchor")]
            title, value = sea["line"].values[line], float(pulls.mean())
            run = _run_of(level, name, sea, wave, groups)
            # the lower end has no series of its peaks: the chance is that of the line's largest tension
            share = pulls[0] / max(float(each[0].max()), 1e-300)
            laws = _laws_of(level, name, sea, wave, groups)
            band, _ = _rigid_band(laws, run, pulls, share * run["line_tension_peak_since_row"].values[:, line], line)
            place = _rigid_where(level, name, sea, wave, groups, realisations=len(each))
            where = f"lower end of {title}, {place}"
            model = f"{RIGID}, {run.attrs['theory']}"
            found.append(Headline("anchor_tension", "largest pull on an anchor", value, "N", where, model, band))
    return judged_seas(found)


def rigid_offsets(statics: xr.Dataset, sea: xr.Dataset) -> tuple[float, Array]:
    """Return place of rest and largest way of the cage in each wave, from where it floats freely [m]."""
    places = statics["rest_x"]
    at_rest = float(places.sel(situation="moored") - places.sel(situation="floating freely"))
    ends = np.array([sea[key].sel(mode="sway").values for key in ("minimum", "maximum")])
    return at_rest, np.abs(at_rest + ends).max(axis=0)


def _rigid_offset(seas: Seas, groups: Groups) -> list[Headline]:
    """Return the largest way of the cage from where it floats freely, the current's part in it."""
    found = []
    for level, name, sea in seas:
        if not sea.sizes["line"]:
            continue
        at_rest, offsets = rigid_offsets(groups[f"/{level}/statics"], sea)
        for wave, own in enumerate(offsets):
            each = offsets_of_each(sea, float(own))
            value = float(each.mean())
            run = _run_of(level, name, sea, wave, groups)
            laws = _laws_of(level, name, sea, wave, groups)
            band, said = _rigid_band(laws, run, each, np.abs(at_rest + run["sway"].values))
            where = _rigid_where(level, name, sea, wave, groups, realisations=each.size)
            found.append(
                Headline(
                    "offset", "largest offset from where it floats freely", value, "m", where,
                    f"{RIGID}, {run.attrs['theory']}", band, detail=said,
                )
            )  # fmt: skip
    return judged_seas(found)


def _laws_of(level: str, name: str, sea: xr.Dataset, wave: int, groups: Groups) -> list[xr.Dataset]:
    """Return the runs of a wave under the valid laws; where it was not run so those of every wave of its level."""
    own = groups.get(f"/{level}/{IN_WAVES}/{name}/{_label(sea, wave)}")
    if own is not None:
        return [own]
    return [group for path, group in groups.items() if path.startswith(f"/{level}/{IN_WAVES}/")]


def tensions_of_each(sea: xr.Dataset, wave: int) -> Array:
    """Return the highest tension of every realisation, one of a regular wave; (realisations, lines, ends) [N]."""
    if _TENSIONS in sea:
        return np.asarray(sea[_TENSIONS].values)
    return np.asarray(sea["line_tension_maximum"].values[wave : wave + 1])


def offsets_of_each(sea: xr.Dataset, own: float) -> Array:
    """Return the largest offset of every realisation, ``own`` where there is one [m]."""
    return np.asarray(sea[_OFFSETS].values) if _OFFSETS in sea else np.array([own])


def _rigid_band(
    laws: list[xr.Dataset], run: xr.Dataset, each: Array, series: Array, line: int | None = None
) -> tuple[Band | None, str]:
    """Return what other seeds and the laws valid for this net make of a number, and what is to be said of it.

    The number is the tension of a line where one is named, else the offset; ``each`` holds that of every realisation
    and ``series`` what the first is the largest value of.
    """
    least, most, words, said = _laws_of_band(laws, line)
    several = seeds(each, more=MORE)
    if several is None:
        value = float(each[0])
        low, high, seed = chance(run, value, series)
        words = ([seed] if seed else []) + words
        return (Band(low * least, high * most, "; ".join(words)) if words else None), said
    time = run["time"].values
    short = too_short(time[time >= float(run.attrs["ramp"])], float(run.attrs["period"]))
    few = [FEW_WAVES] if short else []
    deviation = 100.0 * float(each.std(ddof=1)) / max(abs(float(each.mean())), 1e-300)
    scatter = f"mean of the largest of {each.size} realisations, their standard deviation {deviation:.2g} %"
    said = "; ".join(filter(None, (scatter, said)))
    if any(one.sizes["law"] > 1 for one in laws):
        words.append("the change by the laws is that of the first seed")
    return replace(several.scaled(least, most), of="; ".join([several.of, *few, *words])), said


def _laws_of_band(laws: list[xr.Dataset], line: int | None) -> tuple[float, float, list[str], str]:
    """Return by which factors the laws move a number, with words for the band and for the number."""
    words: list[str] = []
    several = [one for one in laws if one.sizes["law"] > 1]
    least, most, said = 1.0, 1.0, ""
    for one in several:
        values = one["law_largest_offset"].values if line is None else one["law_line_tension"].values[:, line]
        if values[0] > 0.0:
            least, most = min(least, float(values.min() / values[0])), max(most, float(values.max() / values[0]))
    if several:
        words.append(laws_text(several[0]))
    elif laws and not any(one.attrs["missing"] for one in laws):
        said = "no second net law is valid for this net"
    if any(one.attrs["missing"] for one in laws):
        words.append(NO_LAWS)
    return least, most, words, said


def _label(sea: xr.Dataset, wave: int) -> str:
    return f"wave {wave + 1}" if sea.attrs["kind"] == "regular" else "sea"


def _run_of(level: str, name: str, sea: xr.Dataset, wave: int, groups: Groups) -> xr.Dataset:
    """Return the series of one wave, or of the sea."""
    return groups[f"/{level}/time/{name}/{_label(sea, wave)}"]


def _rigid_where(level: str, name: str, sea: xr.Dataset, wave: int, groups: Groups, *, realisations: int = 1) -> str:
    """Return sea, wave or seed, current and level of a number of a rigid cage."""
    run = _run_of(level, name, sea, wave, groups)
    return f"{sea_words(name, run, float(groups[f'/{level}'].attrs['current']), realisations)}, {level}"


def _rigid_motions(seas: Seas, groups: Groups) -> list[Headline]:
    best: dict[str, tuple[float, str, str, str]] = {}
    for level, name, sea in seas:
        regular = sea.attrs["kind"] == "regular"
        for number, mode in enumerate(("sway", "heave")):
            values = sea["range_ratio"].values[:, number]
            at = int(np.argmax(values))
            words = f"{mode} range over wave height" if regular else f"{mode}: 4 standard deviations over Hs"
            entry = (float(values[at]), _rigid_where(level, name, sea, at, groups), "1", words)
            best[words] = max(best.get(words, entry), entry)
        turned = 0.5 * sea["range"].values[:, 2]
        at = int(np.argmax(turned))
        entry = (float(turned[at]), _rigid_where(level, name, sea, at, groups), "rad", "rotation, half its range")
        best["rotation"] = max(best.get("rotation", entry), entry)
    return [
        Headline(f"{words.split()[0].strip(':,')}_range", words, value, unit, where, RIGID)
        for value, where, unit, words in best.values()
    ]


def _rigid_rest(groups: Groups) -> list[Headline]:
    """Return the largest tension at rest and the largest share of the floats in water, of all water levels."""
    tensions, immersed = [], []
    for path, statics in groups.items():
        parts = path.strip("/").split("/")
        if len(parts) != 2 or parts[1] != "statics":
            continue
        tension = statics["tension_at_rest"].values
        if tension.size:
            tensions.append(Headline("tension_at_rest", "tension at rest", float(tension.max()), "N", parts[0], "rest"))
        share = float(statics["immersion"].sel(situation="moored"))
        immersed.append(
            Headline(
                "floats_immersed", "floats in water at rest", share, "1", parts[0], "rest", text=f"{100 * share:.3g} %"
            )
        )
    return [max(items, key=lambda item: item.value) for items in (tensions, immersed) if items]
