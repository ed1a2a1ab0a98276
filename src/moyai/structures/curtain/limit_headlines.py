"""The first page's limits of a curtain: up to which current and which wave height it holds."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

from moyai.core.headline import Band, Criterion, Headline
from moyai.structures.curtain.hierarchy import OF_UPRIGHT, SPAN
from moyai.structures.curtain.steady_headlines import Groups, at_rest, statics_band

if TYPE_CHECKING:
    import xarray as xr

REMEDY = "add 'dynamic' to 'analyses', with the mass of the sheet, for the value"

#: Parts that an impact loads
_STRUCK = ("upper cable", "lower cable", "sheet", "joint", "anchor line", "anchor")
#: Angle of a sea from the normal up to which it stands for one along it [rad].
FACING = math.radians(10.0)


def _deep_enough(groups: Groups, level: str) -> bool:
    """Return whether the skirt keeps the depth that is asked for, at the lower end of its band."""
    limits, statics = groups.get(f"/{level}/limits"), groups.get(f"/{level}/statics")
    if limits is None or statics is None:
        return True
    band = statics_band(statics, "effective_depth")
    depth = at_rest(statics, "effective_depth") if band is None else band.low
    return not depth < float(limits.attrs.get("least_effective_depth", 0.0))


def limit_headlines(groups: Groups, levels: Sequence[str], span_holds: Callable[[str], bool]) -> Iterator[Headline]:
    """Return up to which current without waves, and up to which wave height in its own current, a curtain holds.

    Where the plate is only a bound, the state of the case is the limit from below if the whole span holds in it.

    Parameters
    ----------
    groups : mapping
        Datasets of the run by their path.
    levels : sequence of str
        Water levels.
    span_holds : callable
        Whether the whole span was run at a level and holds there.
    """
    for name, label, unit, where, value, key in (
        ("limit_current", "Holds up to a current of", "m/s", "no waves", "speed_limit", "speed_limit"),
        (
            "limit_wave_height", "Holds up to a wave height of", "m", "significant, in currents up to that of the case",
            "design_limit_height", "design_limit",
        ),
    ):  # fmt: skip
        found = [
            (float(table[value]), level, table)
            for level in levels
            if (table := groups.get(f"/{level}/limits")) is not None
            and value in table
            and math.isfinite(float(table[value]))
        ]
        if not found:
            continue
        limit, level, table = min(found, key=partial(_held, groups, key, span_holds))
        if key == "design_limit" and table.attrs.get("with_drift", 0):
            where = "significant, in currents up to the drift of such waves"
        governing = str(table.attrs.get(f"{key}_governing", ""))
        said = str(table.attrs.get("speed_limit_text" if key == "speed_limit" else "design_limit_note", ""))
        bound = str(table.attrs.get(f"{key}_bound", ""))
        proven = _proven(groups, key, span_holds, level)
        waves = key == "design_limit"
        if bound == "at least" and (proven > limit or (waves and math.isfinite(proven))):
            more = f"an upright plate, a bound, allows {limit:.3g} {unit}; " if limit > 0.0 and not waves else ""
            detail = f"the whole span holds in the state of the case; {more}the span is run in that state alone"
            yield Headline(
                name,
                label,
                proven,
                unit,
                where=f"{where}: {level}",
                model=SPAN,
                bound="at least",
                detail=detail,
                without_waves=not waves,
            )
            continue
        details = [said or f"{governing} sets it"]
        if limit > 0.0 and governing != "not reached" and said:
            details.insert(0, f"{governing} sets it")
        if key == "speed_limit" and table.attrs.get("with_impact") and governing in _STRUCK:
            details.append("with the impact when the current draws the curtain taut")
        if bound == "at most":
            details.append(_left_out(table, waves))
        found_at = limit
        if key != "speed_limit" and table.attrs.get("with_snaps"):
            lasting = float(table.attrs.get("sea_duration", math.nan)) / 60.0
            angle = math.degrees(float(table.attrs.get("wave_angle", 0.0)))
            along = "along the normal" if abs(angle) < 0.05 else f"at {angle:.3g} deg from the normal"
            details.append(f"snaps by realisations of JONSWAP seas of {lasting:.3g} min {along}")
        if governing != "effective depth" and float(table.attrs.get("least_effective_depth", 1.0)) == 0.0:
            details.append("no depth is asked for: 'least_effective_depth' of 'criteria' has no default")
        if jump := str(table.attrs.get("limit_jump", "")) if key == "design_limit" else "":
            details.append(jump)
        if bound == "at most" and governing == "not reached":
            yield Headline(name, label, math.nan, unit, where=f"{where}: {level}", detail="; ".join(details),
                           text="not known", without_waves=not waves)  # fmt: skip
            continue
        band = _band(table, key, limit)
        if key != "speed_limit" and limit > 0.0 and not _deep_enough(groups, level):
            limit, details = (
                0.0,
                ["the depth that is asked for is not kept in the current of the case, at its lower end"],
            )
        if bound == "at least" and (limit <= 0.0 or (waves and governing != OF_UPRIGHT)):
            # a bound that fails proves nothing about the curtain, and in waves it bounds neither sheet nor anchors
            words = f"the load of an upright plate, a bound, is already too much for the {governing} without waves"
            if limit > 0.0:
                words = "an upright plate, a bound, bounds neither the sheet nor the anchors in waves"
            run = groups.get(f"/{level}/dynamic")
            more = REMEDY if run is None else "the whole span is run in the seas of the case alone, to be run in others"
            if waves and run is not None and (oblique := _all_oblique(groups, level)):
                more = oblique
            detail = f"{words}; {more}"
            yield Headline(name, label, math.nan, unit, where=f"{where}: {level}", detail=detail, text="not known",
                           without_waves=not waves)  # fmt: skip
            continue
        if band is not None and band.low < limit:
            # what is held is what holds at the unfavourable end
            details.insert(0, f"{limit:.3g} {unit} at nominal values; {band.of}")
            limit = band.low
        if waves and table.attrs.get("with_snaps"):
            # realisations of a sea do not give a third digit
            limit = _two_digits(limit)
            details += _of_other_seeds(table, limit)
        period = float(table.attrs.get("design_limit_period", math.nan))
        if key != "speed_limit" and math.isfinite(period) and limit > 0.0:
            # the period of the height that is printed, not of the one at nominal values
            period *= math.sqrt(limit / found_at) if table.attrs.get("period_follows_height", 1) else 1.0
            details.append(f"in waves of {period:.3g} s, as the limits take the period with the height")
        own = _number(table, "surface_speed")
        if key == "speed_limit" and own > 0.0 and not said:
            details.append(f"{limit / own:.2f} of the current of the case, {own:.3g} m/s")
        yield Headline(
            name, label, limit, unit, where=f"{where}: {level}",
            bound="at least" if governing == "not reached" and not bound else bound,  # type: ignore[arg-type]
            detail="; ".join(details),
            text="" if limit > 0.0 else "none", without_waves=not waves,
        )  # fmt: skip


def _left_out(table: xr.Dataset, waves: bool) -> str:
    """Say why a limit can only be lower."""
    if table.attrs.get("with_snaps" if waves else "with_impact"):
        return "the load of a snap on the sheet, or that of snaps in another current, is not known"
    if waves:
        return "no snap is counted: add 'waves' or 'dynamic' to 'analyses'"
    return "no impact is counted: add 'impact' to 'analyses', which takes a current"


def _of_other_seeds(table: xr.Dataset, limit: float) -> list[str]:
    """Say how far a height hangs on the seeds of the seas that prove it, where that is more than its two digits."""
    scatter, count = _number(table, "design_limit_scatter"), int(table.attrs.get("realisations", 0))
    if not (limit > 0.0 and scatter > 0.01 * limit and count):
        return []
    return [
        f"other seeds may give {scatter:.2g} m less or more (one standard deviation with {count} realisations): "
        "run more realisations"
    ]


def _proven(groups: Groups, key: str, span_holds: Callable[[str], bool], level: str) -> float:
    """Return the state of the case where the whole span was run at a level and holds in it; else NaN."""
    return _in_the_case(groups, level, key) if span_holds(level) and _deep_enough(groups, level) else math.nan


def _held(groups: Groups, key: str, span_holds: Callable[[str], bool], item: tuple[float, str, xr.Dataset]) -> float:
    """Return what a level is known to hold: its limit, or the state of the case where the limit is but a bound."""
    limit, level, table = item
    proven = _proven(groups, key, span_holds, level)
    if str(table.attrs.get(f"{key}_bound", "")) == "at least":
        if proven > limit:
            return proven
        if key == "design_limit" and table.attrs.get("design_limit_governing") != OF_UPRIGHT:
            return proven if math.isfinite(proven) else -math.inf
    return _lowest(table, key, limit)


def weaker_currents(groups: Groups, found: Sequence[Headline]) -> tuple[Criterion, ...]:
    """Return the criterion that fails where the curtain gives way in a current weaker than that of the case.

    Weaker currents come with every stronger one, twice a tide. Nothing is asked where the limit is a bound or holds.
    """
    limit = next((item for item in found if item.name == "limit_current"), None)
    if limit is None or limit.bound == "at least" or not math.isfinite(limit.value):
        return ()
    level = limit.where.rpartition(": ")[2]
    own = _in_the_case(groups, level, "speed_limit")
    if not limit.value < own * (1.0 - 1e-6):
        return ()
    source = "default of moyai: weaker currents come with every stronger one"
    label = "largest current held without waves"
    return (Criterion("weaker_currents", "limit_current", own, "at least", source, label, "m/s", assumed=True),)


def _in_the_case(groups: Groups, level: str, key: str) -> float:
    """Return the current of the case, or the largest significant height of its irregular seas along the normal; or NaN.

    The height that a curtain holds is that of a sea along the normal: an oblique sea proves nothing of it.
    """
    if key == "speed_limit":
        return _number(groups[f"/{level}/limits"], "surface_speed")
    seas = [data for path, data in groups.items() if path.startswith(f"/{level}/waves/") and "realisations" in data]
    facing = [data for data in seas if float(data.attrs.get("angle_from_normal", 0.0)) <= FACING]
    return max((float(data["significant_height"]) for data in facing), default=math.nan)


def _all_oblique(groups: Groups, level: str) -> str:
    """Say that no irregular sea of the case travels near the normal, where there are any; else nothing."""
    seas = [data for path, data in groups.items() if path.startswith(f"/{level}/waves/") and "realisations" in data]
    nearest = min((float(data.attrs.get("angle_from_normal", 0.0)) for data in seas), default=0.0)
    if nearest <= FACING:
        return ""
    return (
        f"the seas of the case travel at {math.degrees(nearest):.0f} degrees to the normal and more: one within "
        f"{math.degrees(FACING):.0f} degrees of it, in which the whole span holds, gives a height"
    )


def _number(table: xr.Dataset, name: str) -> float:
    return float(table[name]) if name in table else math.nan


def _two_digits(value: float) -> float:
    """Return a positive number with two digits, rounded down."""
    if not value > 0.0:
        return value
    step = 10.0 ** (math.floor(math.log10(value)) - 1)
    return math.floor(value / step + 1e-9) * step


def _band(table: xr.Dataset, key: str, value: float) -> Band | None:
    return _limit_band(table, value) if key == "speed_limit" else _height_band(table, value)


def _lowest(table: xr.Dataset, key: str, value: float) -> float:
    """Return the lower end of a limit."""
    band = _band(table, key, value)
    return value if band is None else min(value, band.low)


def _limit_band(table: xr.Dataset, value: float) -> Band | None:
    """Return the band of the largest current over the drag coefficient or over the impact, and over the depth kept."""
    low, high = _number(table, "speed_limit_low"), _number(table, "speed_limit_high")
    band = Band(low, high, str(table.attrs.get("speed_limit_band_of", ""))) if low < high else None
    least = float(table.attrs.get("speed_limit_of_least_depth", math.nan))
    if not least < (value if band is None else band.low):
        return band
    of = "; ".join(filter(None, ("" if band is None else band.of, "depth at the lower end of its band")))
    return Band(least, value if band is None else band.high, of)


def _height_band(table: xr.Dataset, value: float) -> Band | None:
    """Return the band of the largest height: impact, snaps and depth at their unfavourable ends."""
    low = _number(table, "design_limit_low")
    return Band(low, value, "impact, snaps, steady part and depth at their unfavourable ends") if low < value else None
