"""Compose the report of a network: the governing tension first, then what it rests on."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from moyai.core.results import Result
from moyai.report import network_figures as figures
from moyai.report import network_tables as tables
from moyai.report.document import Block, Choice, Document, KeyFigure, KeyFigures, Option, Paragraph, Section
from moyai.report.formatting import format_percent, format_quantity
from moyai.report.general_page import case_listing, closing_section, notice_blocks, provenance, report_title
from moyai.report.network_reading import Governing, NetworkLevel, attribute, governing_of, levels_of, texts
from moyai.report.network_scene import mode_animations, rest_animation, run_animation
from moyai.report.reading import Group

MOST_VIEWS = 8


def compose(result: Result) -> Document:
    """Compose the report of a network.

    Parameters
    ----------
    result : Result
        With the layout of ``docs/result_layout.md``; whatever is absent is left out.

    Returns
    -------
    Document
    """
    root, levels = Group("", result.tree), levels_of(result)
    governing = governing_of(levels)
    default = next((n for n, level in enumerate(levels) if governing and level.name == governing.level.name), 0)

    def at_each_level(compose_level: Callable[[NetworkLevel], Sequence[Block | None]]) -> tuple[Block, ...]:
        options = []
        for level in levels:
            blocks = tuple(block for block in compose_level(level) if block is not None)
            options.append(Option(level.name, blocks or (Paragraph("Not run at this water level.", quiet=True),)))
        if not any(not isinstance(option.blocks[0], Paragraph) for option in options):
            return ()
        return (Choice("water-level", "Water level", tuple(options), default),)

    def runs(level: NetworkLevel) -> Sequence[Block | None]:
        return _of_runs(level, governing)

    sections = [
        Section("summary", "Summary", (*_summary(result, levels, governing), *notice_blocks(result))),
        Section("view", "In motion", at_each_level(lambda level: [_views(level, governing)])),
        Section("runs", "Runs through time", at_each_level(runs)),
        Section("rest", "At rest", at_each_level(_at_rest)),
        Section(
            "modes", "Natural modes",
            at_each_level(lambda level: [tables.mode_table(level), mode_animations(level)]),
        ),
        Section("input", "Input", (case_listing(root), *at_each_level(lambda level: [tables.line_table(level)]))),
    ]  # fmt: skip
    return Document(
        title=report_title(result),
        subtitle=_subtitle(levels),
        status=result.status,
        message=result.message,
        sections=(*(section for section in sections if section.blocks), closing_section(result)),
        provenance=provenance(result),
    )


def _subtitle(levels: tuple[NetworkLevel, ...]) -> str:
    if not levels:
        return "Network"
    net = levels[0].network
    count = len(net.labels("line"))
    parts = ["Network", f"{count} line{'s' if count != 1 else ''}" if count else ""]
    nodes = 0 if net.node is None else int(net.node.sizes.get("node", 0))
    parts.append(f"{nodes} nodes")
    depth = attribute(levels[0].group, "water_depth")
    parts.append(f"water depth {format_quantity(depth, 'm')}" if math.isfinite(depth) else "deep water")
    if len(levels) > 1:
        parts.append("water levels " + ", ".join(level.name for level in levels))
    return " · ".join(part for part in parts if part)


#: Highest tension over that at the ends of the line, from which the report tells both.
INSIDE = 1.2


def _summary(result: Result, levels: tuple[NetworkLevel, ...], governing: Governing | None) -> tuple[Block, ...]:
    if governing is None:
        return _rest_summary(levels)
    level, run = governing.level, governing.run
    dynamic = level.part("dynamic")
    where = f"{governing.line}, {run.name}, t = {governing.time:.2f} s"
    if len(levels) > 1:
        where += f", {level.name}"
    error, effect = (dynamic.value(key, run=run.name) for key in ("discretisation_error", "viscosity_effect"))
    failed = any(notice.code in ("sensitivity-failed", "sensitivity-left-out") for notice in result.notices)
    items = [
        KeyFigure("highest tension", format_quantity(governing.peak, "N", 4), where),
        _worth(error, effect, failed),
    ]
    ends = [dynamic.value(key, run=run.name, line=governing.line) for key in ("start_peak", "end_peak")]
    if governing.peak > INSIDE * max(ends):
        at = "start" if ends[0] >= ends[1] else "end"
        items.append(
            KeyFigure("highest at its ends", format_quantity(max(ends), "N", 4),
                      f"at its {at}; the highest tension stands inside the line", judgement="caution")
        )  # fmt: skip
    use = dynamic.value("utilisation", run=run.name, line=governing.line)
    if math.isfinite(use):
        judgement = "bad" if use > 1.0 else "caution" if use > 0.6 else "good"
        items.append(
            KeyFigure("of the breaking load", format_percent(use), governing.line, use, judgement)  # type: ignore[arg-type]
        )
    loads = _largest_load(level, run)
    if loads is not None:
        words = f"{loads[0]}, {run.name}"
        items.append(KeyFigure("largest pull on a fixed point", format_quantity(loads[1], "N"), words))
    items += _motions(level, run)
    snaps = [dynamic.value("snaps", run=run.name, line=line) for line in dynamic.labels("line")]
    known = [value for value in snaps if math.isfinite(value)]
    if known:
        slack = max(dynamic.value("slack_share", run=run.name, line=line) for line in dynamic.labels("line"))
        items.append(
            KeyFigure("snaps", f"{sum(known):.0f}", f"slack for up to {format_percent(slack)} of the time",
                      judgement="caution" if sum(known) else "")
        )  # fmt: skip
    mode = level.part("modes").real("mode_period", "mode")
    if mode is not None and mode.size and math.isfinite(mode[0]):
        items.append(KeyFigure("longest natural period", format_quantity(float(mode[0]), "s"), "added mass counted"))
    blocks: list[Block | None] = [KeyFigures(tuple(items)), tables.worth_table(level)]
    if not (math.isfinite(error) or failed):
        blocks.append(
            Paragraph("How far the peak hangs on step, mesh and viscosity was not asked for: settings.sensitivity: "
                      "true runs it again and tells.", quiet=True)
        )  # fmt: skip
    return tuple(block for block in blocks if block is not None)


def _motions(level: NetworkLevel, run: Group) -> list[KeyFigure]:
    """Return the largest offset and lean of the bodies in the run of the highest tension."""
    dynamic, items = level.part("dynamic"), []
    for key, label, unit in (("offset", "largest offset of a body", "m"), ("highest_lean", "largest lean", "rad")):
        found = {name: dynamic.value(key, run=run.name, solid=name) for name in dynamic.labels("solid")}
        known = {name: value for name, value in found.items() if math.isfinite(value)}
        if known:
            worst = max(known, key=lambda name: known[name])
            items.append(KeyFigure(label, format_quantity(known[worst], unit), f"{worst}, {run.name}"))
    return items


def _worth(error: float, effect: float, failed: bool) -> KeyFigure:
    if not math.isfinite(error) and failed:
        return KeyFigure("worth of the peak", "not found", "a notice below says why", judgement="caution")
    if not math.isfinite(error):
        return KeyFigure("worth of the peak", "not asked for", "settings.sensitivity: true")
    # a peak that hangs on a viscosity nobody knows is worth no more than one that hangs on the mesh
    doubt = max(error, 0.2 * effect) if math.isfinite(effect) else error
    judgement = "good" if doubt <= 0.02 else "caution" if doubt <= 0.1 else "bad"
    return KeyFigure(
        "worth of the peak", f"± {format_percent(error)}",
        f"half the step and half the bars; viscosity halved or doubled moves it by {format_percent(effect)}",
        judgement=judgement,  # type: ignore[arg-type]
    )  # fmt: skip


def _largest_load(level: NetworkLevel, run: Group) -> tuple[str, float] | None:
    dynamic = level.part("dynamic")
    kinds = texts(level.network, "point_kind")
    best: tuple[str, float] | None = None
    for name, kind in zip(dynamic.labels("point"), kinds, strict=False):
        value = dynamic.value("load_peak", run=run.name, point=name)
        if kind == "fixed" and math.isfinite(value) and (best is None or value > best[1]):
            best = (name, value)
    return best


def _rest_summary(levels: tuple[NetworkLevel, ...]) -> tuple[Block, ...]:
    """Return the governing numbers of a network that was only asked for its rest."""
    best: tuple[float, str] | None = None
    for level in levels:
        rest = level.part("statics")
        for condition in rest.labels("condition"):
            for line in rest.labels("line"):
                value = rest.value("line_tension", condition=condition, line=line)
                if math.isfinite(value) and (best is None or value > best[0]):
                    best = (value, f"{line}, {condition}, {level.name}")
    items = [] if best is None else [KeyFigure("highest tension at rest", format_quantity(best[0], "N", 4), best[1])]
    mode = levels[0].part("modes").real("mode_period", "mode") if levels else None
    if mode is not None and mode.size and math.isfinite(mode[0]):
        items.append(KeyFigure("longest natural period", format_quantity(float(mode[0]), "s"), "added mass counted"))
    return (KeyFigures(tuple(items)),) if items else (Paragraph("The result holds no tensions."),)


def _views(level: NetworkLevel, governing: Governing | None) -> Block | None:
    runs = level.runs()[:MOST_VIEWS]
    if governing is not None and governing.level.name == level.name:
        names = [run.name for run in runs]
        if governing.run.name not in names:
            runs = (*runs[:-1], governing.run)
    options = [(run, run_animation(level, run)) for run in runs]
    known = [Option(run.name, (view,)) for run, view in options if view is not None]
    if not known:
        return None
    names = [option.label for option in known]
    default = names.index(governing.run.name) if governing is not None and governing.run.name in names else 0
    return Choice(f"run-{level.name}", "Run", tuple(known), default, print_all=False)


def _of_runs(level: NetworkLevel, governing: Governing | None) -> Sequence[Block | None]:
    options = []
    for run in level.runs():
        found = (
            figures.tension_figure(level, run),
            figures.places_figure(level, run),
            *figures.body_figures(level, run),
            tables.bodies_table(level, run),
            tables.peaks_table(level, run),
            tables.points_table(level, run),
            figures.exceedance_figure(level, run),
            tables.contact_table(level, run),
            figures.energy_figure(level, run),
        )
        blocks = tuple(block for block in found if block is not None)
        if blocks:
            options.append(Option(run.name, blocks))
    if not options:
        return ()
    names = [option.label for option in options]
    default = names.index(governing.run.name) if governing is not None and governing.run.name in names else 0
    return (tables.run_table(level), Choice(f"run-{level.name}", "Run", tuple(options), default, print_all=False))


def _at_rest(level: NetworkLevel) -> Sequence[Block | None]:
    return (rest_animation(level), *tables.rest_tables(level))
