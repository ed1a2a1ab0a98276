"""Compose the report of a study: what governs first, then the matrix of cases and what it rests on."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.results import Result
from moyai.report.document import (
    Abscissa,
    Block,
    Chapter,
    Choice,
    Column,
    Document,
    Figure,
    KeyFigure,
    KeyFigures,
    Option,
    Panel,
    Paragraph,
    Series,
    Table,
)
from moyai.report.formatting import display_unit, format_number, format_quantity
from moyai.report.general_page import case_listing, notice_blocks, page_of
from moyai.report.reading import root_of
from moyai.study.found import Found, found_by_search
from moyai.study.report.drawings import heat_map, parallel_coordinates, rose
from moyai.study.report.reading import StudyPages, read_study

_FITTED = {
    "gumbel": "Gumbel fit of the maxima by maximum likelihood, parametric bootstrap",
    "weibull": "Weibull fit of the peaks by maximum likelihood, parametric bootstrap",
    "generalised_pareto": "Generalised Pareto fit of the largest peaks by maximum likelihood, parametric bootstrap",
    "weibull, snaps apart": "Weibull fits of snap peaks and of the others, parametric bootstrap",
    "generalised_pareto, snaps apart": "Generalised Pareto fits of snap peaks and of the others, parametric bootstrap",
    "acer": "Average conditional exceedance of the peaks, tail fitted by least squares",
}
_MOST_ROWS, _MOST_CARDS = 500, 5
_ROUNDING = 1e-12  # of the largest value with the same unit
_WORDS = {
    "converged": "run",
    "outside_validity": "run with doubts",
    "failed": "failed",
    "refused": "refused",
    "not run": "not run",
}


def compose(result: Result) -> Document:
    """Compose the report of a study.

    Parameters
    ----------
    result : Result
        As the study command writes it; whatever is absent is left out.

    Returns
    -------
    Document
    """
    pages = read_study(result)
    names = interesting(pages)
    sections = [
        Chapter("summary", "Summary", _summary(pages)),
        Chapter("found", "What the search found", _found(pages)),
        Chapter("governing", "Governing cases", _governing(pages)),
        Chapter("maps", "Over the axes", _maps(pages, names)),
        Chapter("long-run", "Extremes", _extremes(pages)),
        Chapter("matrix", "Load-case matrix", _matrix(pages, names)),
        Chapter("input", "Base case", (case_listing(root_of(result)),)),
    ]
    axes = " x ".join(f"{len(axis.labels)} {axis.words}" for axis in pages.axes)
    return page_of(result, f"Study of {len(pages.status)} cases: {axes}", sections)


def interesting(pages: StudyPages, most: int = 6) -> tuple[str, ...]:
    """Return the responses that the figures show: the watched one, limits and optima, then those that vary most."""
    tree = pages.result.tree
    dims = {axis.name for axis in pages.axes}
    found: list[tuple[int, str, float, float, str]] = []
    units: dict[str, str] = {}
    sizes: dict[str, float] = {}  # of each unit: a moment of 1e-11 N m next to those of 1e4 is rounding
    wanted = ("utilisation", "maximum", "transmission", "significant", "limit", "objective")
    for node in tree.subtree:
        for name, variable in node.data_vars.items():
            if variable.dtype.kind != "f" or not dims <= set(map(str, variable.dims)) or name == "probability":
                continue
            full = f"{node.path.strip('/')}/{name}".strip("/")
            # What the figures show: the largest entry of every case
            shown = pages.response(full)
            known = shown[0][np.isfinite(shown[0])] if shown is not None else np.empty(0)
            if known.size == 0:
                continue
            spread = float(np.ptp(known) / (np.abs(known).max() or 1.0))
            rank = next((number for number, word in enumerate(wanted) if word in str(name)), len(wanted))
            unit = str(variable.attrs.get("units", ""))
            sizes[unit] = max(sizes.get(unit, 0.0), float(np.abs(known).max()))
            if spread > 1e-9 or rank < 1:
                found.append((rank, str(name), spread, float(known.max()), full))
                units[full] = unit
    found = [one for one in found if abs(one[3]) >= _ROUNDING * sizes[units[one[4]]]]
    varies = {name: max(one[2] for one in found if one[1] == name) for _, name, *_ in found}
    # of like responses of several levels and seas that of the largest value comes first
    found.sort(key=lambda one: (one[0] - 0.5 * min(varies[one[1]], 1.0), one[1], -one[3], one[4]))
    listed = [one[-1] for one in found]
    first = [pages.watch] if pages.watch and pages.response(pages.watch) is not None else []
    return tuple(dict.fromkeys([*first, *listed]))[:most]


def _summary(pages: StudyPages) -> tuple[Block, ...]:
    counts = {word: int(np.sum(pages.status == status)) for status, word in _WORDS.items()}
    run = counts["run"] + counts["run with doubts"]
    detail = ", ".join(f"{count} {word}" for word, count in counts.items() if count and word != "run")
    judgement: Any = "good" if run == len(pages.status) and not counts["run with doubts"] else "caution"
    items = [KeyFigure("Cases", f"{run} of {len(pages.status)} cases", detail or "all ran", judgement=judgement)]
    items += [_found_card(pages, one) for one in found_by_search(pages.result)[:_MOST_CARDS]]
    utilised = pages.result.tree.attrs.get("governing_kind", "") == "utilisation"
    # of a search its answers stand in their place
    for one in pages.governing[:_MOST_CARDS] if len(items) == 1 else ():
        words = pages.case_words(one.index)
        if utilised:
            verdict: Any = "good" if one.value <= 0.8 else "caution" if one.value <= 1.0 else "bad"
            text = f"{format_number(one.value, 3)}"
            items.append(KeyFigure(f"Utilisation, {one.component}", text, words, one.value, verdict))
        else:
            found = pages.response(one.component)
            unit = found[1] if found is not None else "1"
            label = found[2] if found is not None else one.component
            said_so = label.startswith(("largest", "highest", "most probable largest"))
            title = label if said_so else f"{label}: largest of all cases"
            title = title[:1].upper() + title[1:]
            items.append(KeyFigure(title, format_quantity(one.value, unit), words))
    for group in _groups(pages, "long term"):
        level = group["return_level"]
        flat = level.values.reshape(-1, level.sizes["return_period"])
        years = level.coords["return_period"].values
        if np.isfinite(flat[:, -1]).any():
            text = format_quantity(float(np.nanmax(flat[:, -1])), str(level.attrs.get("units", "1")))
            items.append(KeyFigure(f"Level of {years[-1]:g} years", text, str(group.attrs["response"])))
    return (*notice_blocks(pages.result), KeyFigures(tuple(items)))


def _found_card(pages: StudyPages, one: Found) -> KeyFigure:
    """Return the card of the answer of a case: the least objective or the largest value, and what governs."""
    where, by = pages.case_words(one.index), f"governed by {' and '.join(one.governing)}" if one.governing else ""
    values = ", ".join(f"{path} = {format_quantity(value, unit, 4)}" for path, value, unit in one.values)
    if one.objective is not None:
        name, least, unit = one.objective
        text = "; ".join(part for part in (f"at {values}", by or "no limit governs", one.remark, where) if part)
        return KeyFigure(f"Least {_words(name)}", format_quantity(least, unit), text)
    (path, value, unit), *_ = one.values
    shown = format_quantity(value, unit) if math.isfinite(value) else "none holds"
    return KeyFigure(f"Largest {path} that holds", shown, "; ".join(part for part in (by, where) if part))


def _words(response: str) -> str:
    """Return a response in words, with the group that it is from."""
    group, _, name = response.rpartition("/")
    return f"{name.replace('_', ' ')} ({group})" if group else name.replace("_", " ")


def _found(pages: StudyPages) -> tuple[Block, ...]:
    """Return the answer of every case as a table."""
    found = found_by_search(pages.result)
    if not found:
        return ()
    columns = [Column("Case", [str(one.index) for one in found])]
    columns += [
        Column(axis.head, [pages.labels(one.index)[n] for one in found], quantities=True)
        for n, axis in enumerate(pages.axes)
    ]
    if found[0].objective is not None:
        name, _, unit = found[0].objective
        least = [one.objective[1] if one.objective else math.nan for one in found]
        columns.append(Column(f"Least {_words(name)}", least, unit))
    for n, (path, _, unit) in enumerate(found[0].values):
        columns.append(Column(path, [one.values[n][1] for one in found], unit, digits=4))
    columns.append(Column("Governed by", [" and ".join(one.governing) or "nothing" for one in found]))
    return (Table("found", "Answer of the search of each case", tuple(columns)),)


def _groups(pages: StudyPages, word: str) -> list[Any]:
    try:
        parent: Any = pages.result.tree["/assessment"]
    except KeyError:
        return []
    return [node.to_dataset(inherit=False) for name, node in parent.children.items() if word in name]


def _governing(pages: StudyPages) -> tuple[Block, ...]:
    blocks: list[Block] = []
    if pages.governing and not found_by_search(pages.result):
        links = [f"{one.folder}/report.html" if one.folder else "" for one in pages.governing]
        utilised = pages.result.tree.attrs.get("governing_kind", "") == "utilisation"
        columns = [
            Column("Component", [one.component for one in pages.governing]),
            Column("Utilisation", [one.value for one in pages.governing], fixed=True)
            if utilised
            else Column("Value", _governing_values(pages), quantities=True),
            Column("Case", [str(one.index) for one in pages.governing]),
            *(
                Column(
                    axis.head,
                    [pages.labels(one.index)[n] for one in pages.governing],
                    quantities=True,
                )
                for n, axis in enumerate(pages.axes)
            ),
            Column("Replay", ["open" if link else "not run again" for link in links], links=links),
        ]
        failed = tuple(n for n, one in enumerate(pages.governing) if utilised and one.value > 1.0)
        note = "The replay is the full report of the case, with its animation." if any(links) else ""
        blocks.append(Table("governing", "Governing case of each component", tuple(columns), note, failed=failed))
    try:
        lines: Any = pages.result.tree["/assessment/lines"]
    except KeyError:
        return tuple(blocks)
    used = lines["factored_utilisation"]
    rows = []
    for code in used.coords["code"].values:
        for line in used.coords["line"].values:
            values = used.sel(code=code, line=line).values
            worst = float(np.nanmax(values)) if np.isfinite(values).any() else math.nan
            rows.append((str(code), str(line), worst))
    confirmed = {str(code): bool(value) for code, value in zip(used.coords["code"].values, lines["confirmed"].values)}
    blocks.append(
        Table(
            "codes",
            "Lines under the codes",
            (
                Column("Code", [row[0] for row in rows]),
                Column("Line", [row[1] for row in rows]),
                Column("Largest utilisation", [row[2] for row in rows]),
                Column(
                    "Verdict",
                    ["holds" if row[2] <= 1.0 else "unknown" if math.isnan(row[2]) else "fails" for row in rows],
                ),
                Column(
                    "Values confirmed",
                    ["yes" if confirmed[row[0]] else "no, see the standard" for row in rows],
                ),
            ),
            failed=tuple(n for n, row in enumerate(rows) if not row[2] <= 1.0),
        )
    )
    return tuple(blocks)


def _governing_values(pages: StudyPages) -> list[str]:
    """Return the governing values with their units, which differ from row to row."""
    found = [pages.response(one.component) for one in pages.governing]
    units = [one[1] if one is not None else "1" for one in found]
    return [format_quantity(one.value, unit) for one, unit in zip(pages.governing, units, strict=True)]


def _verdict(utilisation: float) -> str:
    return "unknown" if math.isnan(utilisation) else "holds" if utilisation <= 1.0 else "fails"


def _maps(pages: StudyPages, names: tuple[str, ...]) -> tuple[Block, ...]:
    blocks: list[Block] = []
    options = []
    several = [axis for axis in pages.axes if len(axis.labels) > 1]
    for name in names:
        inner: list[Block] = []
        if len(several) >= 2:
            drawn = heat_map(pages, name, several[0], several[1])
            if drawn is not None:
                inner.append(drawn)
            if len(several) >= 3:
                further = heat_map(pages, name, several[0], several[2])
                inner.extend([further] if further is not None else [])
        elif several:
            figure = _along(pages, name)
            inner.extend([figure] if figure is not None else [])
        for axis in several:
            if any(word in axis.name for word in ("heading", "bearing")):
                turned = rose(pages, name, axis)
                inner.extend([turned] if turned is not None else [])
        exceeded = _exceedance(pages, name)
        inner.extend([exceeded] if exceeded is not None else [])
        if inner:
            options.append(Option(name, tuple(inner)))
    if options:
        blocks.append(Choice("response", "Response", tuple(options)))
    drawn = parallel_coordinates(pages, names[:3])
    if drawn is not None:
        blocks.append(drawn)
    return tuple(blocks)


def _along(pages: StudyPages, name: str) -> Figure | None:
    """Return a response along the only axis that has several points."""
    found = pages.response(name)
    if found is None:
        return None
    flat, unit, label = found
    axis = next(axis for axis in pages.axes if len(axis.labels) > 1)
    shown = display_unit(unit, flat)
    short = _short(label)
    key = f"along-{name}".replace("/", "-").replace(" ", "-")
    if axis.values is None or len(set(axis.values)) < len(axis.values):
        series = Series(label, {}, flat * shown.factor, style="bar")
        if len(flat) > 40:
            return None
        return Figure(key, label, (), (Panel(short, shown.name, from_zero=True),), (series,), categories=axis.labels)
    order = np.argsort(axis.values)
    series = Series(label, {"axis": axis.values[order]}, flat[order] * shown.factor, style="line+points")
    abscissa = Abscissa("axis", axis.words, axis.sign or ("" if axis.unit == "1" else axis.unit))
    return Figure(key, label, (abscissa,), (Panel(short, shown.name),), (series,))


def _short(label: str) -> str:
    """Return words that fit next to an axis, below a title that says the whole."""
    return label if len(label) <= 40 else "value"


def _exceedance(pages: StudyPages, name: str) -> Figure | None:
    """Return the share of the time (or of the cases) in which a response is exceeded."""
    found = pages.response(name)
    if found is None:
        return None
    flat, unit, label = found
    known = np.isfinite(flat)
    if known.sum() < 5:
        return None
    root: Any = pages.result.tree.to_dataset(inherit=False)
    weighted = "probability" in root
    weight = root["probability"].values.reshape(-1)[known] if weighted else np.full(int(known.sum()), 1.0)
    order = np.argsort(flat[known])[::-1]
    values, share = flat[known][order], np.cumsum(weight[order]) / weight.sum()
    shown = display_unit(unit, values)
    what = "share of the time exceeded" if weighted else "share of the cases exceeded"
    series = Series(label, {"share": share}, values * shown.factor, style="line+points")
    key = f"exceedance-{name}".replace("/", "-").replace(" ", "-")
    return Figure(
        key,
        f"Exceedance: {label}",
        (Abscissa("share", what, "", True),),
        (Panel(_short(label), shown.name),),
        (series,),
    )


def _extremes(pages: StudyPages) -> tuple[Block, ...]:
    blocks: list[Block] = []
    for number, group in enumerate(_groups(pages, "extremes")):
        value = group["design_value"]
        family = str(group.attrs.get("family", "gumbel"))
        units = str(value.attrs.get("units", "1"))
        places = list(np.ndindex(*value.shape))
        columns = [
            Column(str(dim), [_label(pages, str(dim), value, place[n]) for place in places], quantities=True)
            for n, dim in enumerate(value.dims)
        ]
        for name, label in (
            ("design_value", "Design value"),
            ("lower", "Lower"),
            ("upper", "Upper"),
            ("most_probable_maximum", "Most probable maximum"),
        ):
            columns.append(Column(label, [float(group[name].values[place]) for place in places], units))
        blocks.append(
            Table(
                f"extremes-{number}", f"Extremes of {group.attrs['response']} over {group.attrs['over']}",
                tuple(columns), f"{value.attrs['long_name']}. {_FITTED.get(family, family)}.",
            )
        )  # fmt: skip
    for number, group in enumerate(_groups(pages, "fatigue")):
        life = group["life"]
        places = list(np.ndindex(*life.shape))
        columns = [
            Column(str(dim), [_label(pages, str(dim), life, place[n]) for place in places], quantities=True)
            for n, dim in enumerate(life.dims)
        ]
        columns.append(Column("Life [years]", [float(life.values[place]) for place in places]))
        if "equivalent_range" in group:
            ranges = group["equivalent_range"]
            values = [float(ranges.values[place]) for place in places]
            columns.append(Column("Equivalent range", values, str(ranges.attrs["units"])))
        title = f"Fatigue life from {group.attrs['response']}"
        blocks.append(Table(f"fatigue-{number}", title, tuple(columns), str(life.attrs["long_name"])))
    for number, group in enumerate(_groups(pages, "long term")):
        level = group["return_level"]
        units = str(level.attrs.get("units", "1"))
        places = list(np.ndindex(*level.shape[:-1]))
        columns = [
            Column(str(dim), [_label(pages, str(dim), level, place[n]) for place in places], quantities=True)
            for n, dim in enumerate(level.dims[:-1])
        ]
        for at, years in enumerate(level.coords["return_period"].values):
            columns.append(Column(f"{years:g} years", [float(level.values[(*place, at)]) for place in places], units))
        title = f"Return levels of {group.attrs['response']}"
        blocks.append(Table(f"long-term-{number}", title, tuple(columns)))
    return tuple(blocks)


def _label(pages: StudyPages, dim: str, array: Any, at: int) -> str:
    for axis in pages.axes:
        if axis.name == dim:
            return axis.labels[at]
    return str(array.coords[dim].values[at]) if dim in array.coords else str(at)


def _matrix(pages: StudyPages, names: tuple[str, ...]) -> tuple[Block, ...]:
    count = len(pages.status)
    responses = [(name, found) for name in names if (found := pages.response(name)) is not None]
    chosen = np.arange(count)
    blocks: list[Block] = []
    if count > _MOST_ROWS:
        # Failures always, then the largest of the first response
        failed = np.flatnonzero(np.isin(pages.status, ("failed", "refused")))[: _MOST_ROWS // 2]
        rank = np.argsort(-np.nan_to_num(responses[0][1][0], nan=-np.inf)) if responses else chosen
        chosen = np.unique(np.concatenate([failed, rank[: _MOST_ROWS - len(failed)]]))
        blocks.append(Paragraph(f"{len(chosen)} of {count} cases: failures and the largest. All are in study.csv."))
    columns = [Column("Case", [str(index) for index in chosen])]
    for n, axis in enumerate(pages.axes):
        columns.append(Column(axis.head, [pages.labels(int(index))[n] for index in chosen], quantities=True))
    columns.append(
        Column("Status", [_WORDS.get(str(pages.status[index]), str(pages.status[index])) for index in chosen])
    )
    for _, (flat, unit, label) in responses:
        columns.append(Column(label, [float(flat[index]) for index in chosen], unit))
    failures = tuple(n for n, index in enumerate(chosen) if pages.status[index] in ("failed", "refused"))
    governs = tuple(n for n, index in enumerate(chosen) if int(index) in {one.index for one in pages.governing})
    blocks.append(Table("matrix", "Cases", tuple(columns), emphasised=governs, failed=failures, collapsed=count > 60))
    if failures:
        reported = [int(chosen[n]) for n in failures]
        blocks.append(
            Table(
                "failures",
                "Cases that failed or were refused",
                (
                    Column("Case", [str(index) for index in reported]),
                    Column("Where", [pages.case_words(index) for index in reported]),
                    Column("Why", [str(pages.message[index]) for index in reported]),
                ),
            )
        )
    return tuple(blocks)
