"""The first page of the report of a curtain: what governs, and up to which current and wave height it holds."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.results import Result
from moyai.report.curtain_reading import (
    Component,
    CurtainLevel,
    components,
    governing_component,
    words,
)
from moyai.report.curtain_tables import counted_spread
from moyai.report.document import Block, Column, KeyFigure, KeyFigures, Paragraph, Table
from moyai.report.formatting import DASH, display_unit, format_number, format_percent, format_quantity
from moyai.report.general_page import notice_blocks

MOST_KEY_FIGURES = 10
MOST_NOTICES = 4


def summary_blocks(result: Result, levels: tuple[CurtainLevel, ...]) -> tuple[Block, ...]:
    """Return the governing sentence, warnings, key figures, and the components of every water level.

    Parameters
    ----------
    result : Result
    levels : tuple of CurtainLevel

    Returns
    -------
    tuple of Block
    """
    worst = governing_component(levels)
    notices = notice_blocks(result)
    many = sum(notice.severity != "information" for notice in result.notices) > MOST_NOTICES
    sentence = " ".join(filter(None, (_governing_sentence(worst, len(levels)), _beyond_current(levels))))
    blocks: list[Block] = [Paragraph(sentence)] if sentence else []
    blocks += () if many else notices
    items = [
        *(_utilisation_figure(worst) if levels else ()),
        *_limit_figures(levels),
        *_depth_figures(levels),
        *_tension_figures(levels),
        *_impact_figures(levels),
        *_float_figures(levels),
        *_dynamic_figures(levels),
    ]
    if items:
        blocks.append(KeyFigures(tuple(items[:MOST_KEY_FIGURES])))
    else:
        blocks.append(Paragraph("The result holds no governing numbers."))
    table = _components_table(levels, worst)
    if table is not None:
        blocks.append(table)
    # a long list of warnings would push the numbers off the first page
    blocks += notices if many else ()
    return tuple(blocks)


def _governing_sentence(worst: tuple[CurtainLevel, Component] | None, count: int) -> str:
    if worst is None:
        return ""
    level, entry = worst
    load = format_quantity(entry.loads["governing"], entry.unit)
    where = f" at {level.name}" if count > 1 else ""
    how = f" under {entry.governing} load" if entry.governing else ""
    verdict = "beyond its limit" if entry.utilisation > 1.0 else "within its limit"
    factor = f", safety factor {format_number(entry.safety_factor)} included" if entry.safety_factor > 1.0 else ""
    return (
        f"The {entry.name} governs{where}: {load}{how}, {format_percent(entry.utilisation, 3)} of its capacity"
        f"{factor}, {verdict}."
    )


def _beyond_current(levels: tuple[CurtainLevel, ...]) -> str:
    """Say where the current alone is more than the curtain holds: a required depth or reserve is no component."""
    found = _least(levels, "limits", "speed_limit")
    if found is None:
        return ""
    limit, level = found
    own = _own_speed(level)
    if not (math.isfinite(own) and own > limit):
        return ""
    what = str(level.part("limits").attributes.get("speed_limit_governing", "")) or "a limit"
    return (
        f"At {level.name} the current of {format_quantity(own, 'm/s')} is beyond the {format_quantity(limit, 'm/s')} "
        f"that it holds without waves ({what})."
    )


def _utilisation_figure(worst: tuple[CurtainLevel, Component] | None) -> list[KeyFigure]:
    if worst is None:
        return [KeyFigure("Utilisation", DASH, "nothing that was computed has a strength in the case")]
    level, entry = worst
    return [
        KeyFigure(
            "Largest utilisation",
            format_percent(entry.utilisation, 3),
            f"{entry.name}, {entry.governing or 'load'}: {level.name}",
            entry.utilisation,
            "bad" if entry.utilisation > 1.0 else ("caution" if entry.utilisation > 0.8 else ""),
        )
    ]


def _least(levels: tuple[CurtainLevel, ...], part: str, name: str) -> tuple[float, CurtainLevel] | None:
    known = [(level.part(part).value(name), level) for level in levels]
    known = [(value, level) for value, level in known if not math.isnan(value)]
    return min(known, key=lambda entry: entry[0]) if known else None


def _own_speed(level: CurtainLevel) -> float:
    """Return the surface speed of the case's current [m/s]; NaN without a current."""
    found = level.part("statics").value("surface_speed")
    if math.isfinite(found):
        return found
    found = level.part("limits").value("surface_speed")
    return found if found > 0.0 else math.nan


def _limit_figures(levels: tuple[CurtainLevel, ...]) -> list[KeyFigure]:
    """Return the largest current without waves, and the height held at the current of the case."""
    items = []
    found = _least(levels, "limits", "speed_limit")
    if found is not None:
        value, level = found
        what = str(level.part("limits").attributes.get("speed_limit_governing", "")) or "limit"
        own = _own_speed(level)
        beyond = math.isfinite(own) and own > value
        open_ended = math.isinf(value) or what == "not reached"
        text = "not reached" if math.isinf(value) else format_quantity(value, "m/s")
        detail = (
            f"no limit up to there: {level.name}, no waves" if open_ended else f"{what} governs: {level.name}, no waves"
        )
        if math.isfinite(own):
            detail += f"; current of the case {format_quantity(own, 'm/s')}"
        items.append(KeyFigure("Holds up to a current of", text, detail, judgement="bad" if beyond else ""))
    held = _height_held(levels)
    if held is not None:
        height, speed, level, what = held
        text = format_quantity(height, "m") if height > 0.0 else "none"
        why = "no limit up to there" if what == "not reached" else f"{what} governs"
        items.append(
            KeyFigure(
                "Holds up to a wave height of",
                text,
                f"significant, at {format_quantity(speed, 'm/s')}, {why}: {level.name}",
                judgement="" if height > 0.0 else "bad",
            )
        )
    return items


def _height_held(levels: tuple[CurtainLevel, ...]) -> tuple[float, float, CurtainLevel, str] | None:
    """Return the wave height held in the current of the case, the least over the water levels, and what sets it.

    Between two currents of the table the height is interpolated; the nearer current says what sets it.
    """
    best: tuple[float, float, CurtainLevel, str] | None = None
    for level in levels:
        group = level.part("limits")
        speed, limit = group.real("speed", "speed"), group.real("limit_height", "speed")
        own = _own_speed(level)
        if speed is None or limit is None or not math.isfinite(own) or not np.isfinite(limit).any():
            continue
        known = np.isfinite(limit)
        if not speed[known].min() <= own <= speed[known].max():
            continue
        height = float(np.interp(own, speed[known], limit[known]))
        if best is None or height < best[0]:
            nearest = int(np.nanargmin(np.where(known, np.abs(speed - own), np.nan)))
            what = words(group, "limit_governing", "speed", speed.size)[nearest] or "a limit"
            best = (height, own, level, what)
    return best


def _depth_figures(levels: tuple[CurtainLevel, ...]) -> list[KeyFigure]:
    known = [level for level in levels if math.isfinite(level.given("effective_depth"))]
    if not known:
        return []
    level = min(known, key=lambda entry: entry.given("effective_depth"))
    low, high = level.spread("effective_depth")
    length = level.part("statics").value("skirt_length")
    share = f"{format_percent(level.given('effective_depth') / length)} of the skirt, " if length > 0.0 else ""
    items = [
        KeyFigure(
            "Effective depth",
            format_quantity(level.given("effective_depth"), "m"),
            f"{share}{format_number(low)} to {format_quantity(high, 'm')} over the drag range: {level.name}",
        )
    ]
    shallow = [entry for entry in levels if math.isfinite(entry.given("toe_gap"))]
    if shallow:
        # the least gap need not be where the skirt reaches least deep
        level = min(shallow, key=lambda entry: entry.given("toe_gap"))
        gap, speed = level.given("toe_gap"), level.given("toe_speed")
        ratio = level.given("toe_speed_ratio")
        under = f"{format_quantity(speed, 'm/s')} under the toe" if math.isfinite(speed) else "toe to bed"
        if math.isfinite(ratio):
            under += f", {format_number(ratio)} times the current"
        text = format_quantity(gap, "m") if gap > 0.0 else "none"
        items.append(KeyFigure("Toe gap", text, f"{under}: {level.name}"))
    return items


def _dynamic_figures(levels: tuple[CurtainLevel, ...]) -> list[KeyFigure]:
    """Return the highest tensions of the whole span through time."""
    found = []
    for name, words_, unit in (
        ("both_peak", "peak of both cables, whole span", "N"),
        ("skirt_peak", "peak of the skirt", "N/m"),
        ("anchor_peak", "peak of an anchor line", "N"),
    ):
        best = -math.inf
        where = ""
        for level in levels:
            group = level.part("dynamic")
            values = group.real(name, "run")
            if values is None or not np.isfinite(values).any():
                continue
            row = int(np.nanargmax(values))
            if values[row] > best:
                best, where = float(values[row]), f"{group.labels('run')[row]}, {level.name}"
        if math.isfinite(best):
            found.append(KeyFigure(words_, format_quantity(best, unit), where))
    return found


def _tension_figures(levels: tuple[CurtainLevel, ...]) -> list[KeyFigure]:
    items = []
    for name, label in (("anchor line", "Anchor line"), ("upper cable", "Upper cable")):
        known = [
            (entry.loads["governing"], level, entry)
            for level in levels
            for entry in components(level)
            if entry.name == name and math.isfinite(entry.loads["governing"])
        ]
        if known:
            load, level, entry = max(known, key=lambda found: found[0])
            steady = entry.loads["steady"]
            beside = f", steady {format_quantity(steady, entry.unit)}" if math.isfinite(steady) else ""
            items.append(
                KeyFigure(
                    f"Largest load, {label.lower()}",
                    format_quantity(load, entry.unit),
                    f"{entry.governing or 'load'}{beside}: {level.name}",
                )
            )
    return items


def _impact_figures(levels: tuple[CurtainLevel, ...]) -> list[KeyFigure]:
    known = [
        (level.part("impact").value("design_tension"), level)
        for level in levels
        if math.isfinite(level.part("impact").value("design_tension"))
    ]
    if not known:
        return []
    tension, level = max(known, key=lambda entry: entry[0])
    group = level.part("impact")
    model = str(group.attributes.get("design_model", ""))
    parts = [f"model {model}" if model else "", f"taut at {format_quantity(group.value('start_speed'), 'm/s')}"]
    spread = counted_spread(level)
    if math.isfinite(spread):
        parts.append(f"models spread by a factor of {format_number(spread)}")
    words = ", ".join(part for part in parts if part)
    return [KeyFigure("Snap, both cables", format_quantity(tension, "N"), f"{words}: {level.name}")]


def _float_figures(levels: tuple[CurtainLevel, ...]) -> list[KeyFigure]:
    known = [level for level in levels if math.isfinite(level.given("float_reserve_ratio"))]
    if not known:
        return []
    level = min(known, key=lambda entry: entry.given("float_reserve_ratio"))
    ratio = level.given("float_reserve_ratio")
    drowning = level.part("statics").value("drowning_speed")
    words = f"drown at {format_quantity(drowning, 'm/s')}" if math.isfinite(drowning) else "no current drowns them"
    judged = "bad" if ratio <= 0.0 else ""
    return [
        KeyFigure(
            "Reserve of the floats",
            format_percent(ratio),
            f"of their buoyancy, {words}: {level.name}",
            judgement=judged,  # type: ignore[arg-type]
        )
    ]


def _components_table(levels: tuple[CurtainLevel, ...], worst: tuple[CurtainLevel, Component] | None) -> Table | None:
    """Return the utilisation of every component at every water level."""
    rows = [(level, entry) for level in levels for entry in components(level)]
    if not rows:
        return None
    emphasised = tuple(
        number
        for number, (level, entry) in enumerate(rows)
        if worst is not None and level.name == worst[0].name and entry.name == worst[1].name
    )
    shown = [display_unit(entry.unit, entry.loads["governing"]) for _, entry in rows]
    paired = list(zip(rows, shown, strict=True))
    return Table(
        "governing-loads",
        "Components at every water level",
        (
            Column("Water level", [level.name for level, _ in rows]),
            Column("Component", [entry.name for _, entry in rows]),
            Column("Unit", [unit.name for unit in shown]),
            Column("Governing load", [e.loads["governing"] * u.factor for (_, e), u in paired], uniform=False),
            Column("Governed by", [entry.governing for _, entry in rows]),
            Column("Capacity", [entry.capacity * unit.factor for (_, entry), unit in paired], uniform=False),
            Column("Safety factor", [entry.safety_factor for _, entry in rows]),
            Column("Utilisation", [entry.utilisation for _, entry in rows]),
        ),
        emphasised=emphasised,
        failed=tuple(number for number, (_, entry) in enumerate(rows) if entry.utilisation > 1.0),
        collapsed=len(rows) > 16,
    )
