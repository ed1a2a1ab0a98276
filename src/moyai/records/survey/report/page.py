"""The report of a survey: one page with figures of every block and tables that paste into a spreadsheet."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime
from typing import Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.results import Result
from moyai.core.wording import counted
from moyai.records.survey.report.compass import come_from, heading_figures, with_bearings
from moyai.records.survey.report.lanes import Span, flag_lanes
from moyai.report.document import (
    Abscissa,
    Block,
    Chapter,
    Column,
    Document,
    Figure,
    KeyFigure,
    KeyFigures,
    Mark,
    Panel,
    Series,
    Table,
)
from moyai.report.formatting import format_percent, format_quantity
from moyai.report.general_page import case_listing, closing_section, notice_blocks, provenance, report_title
from moyai.report.reading import root_of
from moyai.series.spectra import height_sampling_error

WAVE_COLUMNS = (
    ("count", "waves"),
    ("maximum_height", "Hmax"),
    ("maximum_period", "T of Hmax"),
    ("tenth_height", "H1/10"),
    ("tenth_period", "T1/10"),
    ("third_height", "H1/3"),
    ("third_period", "T1/3"),
    ("mean_height", "Hmean"),
    ("mean_period", "Tmean"),
    ("spectral_height", "Hm0"),
    ("peak_period", "Tp"),
    ("period_m01", "Tm01"),
    ("period_m02", "Tm02"),
)
TENSION_COLUMNS = (
    ("steady", "steady"),
    ("maximum", "T_max"),
    ("tenth", "T_1/10"),
    ("third", "T_1/3"),
    ("mean", "T_mean"),
    ("waves", "waves"),
    ("snap_count", "snaps"),
    ("lag", "lag"),
)


def compose(result: Result) -> Document:
    """Compose the report of a survey.

    Parameters
    ----------
    result : Result
        Of ``moyai measure records``.

    Returns
    -------
    Document
    """
    tree = result.tree
    clock = _PageClock(tree)
    sections = [
        Chapter(
            "summary", "Summary", (*_key_figures(result, clock), *notice_blocks(result), case_listing(root_of(result)))
        )
    ]
    for key, title, make in (
        ("waves", "Waves", _waves),
        ("spectra", "Spectra", _spectra),
        ("directions", "Directions", _directions),
        ("current", "Currents", _current),
        ("tensions", "Tensions", _tensions),
        ("fits", "Relations", _fits),
        ("responses", "Responses", _responses),
        ("reflection", "Reflection and transmission", _reflection),
        ("whole", "Distribution of heights", _whole),
        ("blocks", "Channels", _channels),
        ("quality", "Quality", _quality),
    ):
        if key in tree.children and (blocks := make(tree, clock)):
            sections.append(Chapter(key, title, tuple(blocks)))
    sections.append(closing_section(result))
    return Document(
        title=report_title(result),
        subtitle="records",
        status=result.status,
        message=result.message,
        sections=tuple(sections),
        provenance=provenance(result),
    )


class _PageClock:
    """Instants of the blocks as a reader wants them: dates for tables, hours or days for figures."""

    def __init__(self, tree: Any) -> None:
        self.dated = bool(tree.attrs.get("dated", 0))
        self.start = np.asarray(tree["blocks"]["time"].values, dtype=float)
        self.length = float(tree.attrs["block_length"])
        span = float(self.start[-1] - self.start[0]) + self.length
        self.unit, divisor = ("d", 86400.0) if span > 3 * 86400.0 else (("h", 3600.0) if span > 7200.0 else ("s", 1.0))
        self.x = (self.start - self.start[0]) / divisor
        # One block is a point in its middle, not a line
        self.alone = self.start.size == 1
        if self.alone:
            self.x = self.x + 0.5 * self.length / divisor
        self.divisor = divisor
        self.label = f"time since {self.text(float(self.start[0]))}" if self.dated else "time"

    def text(self, instant: float) -> str:
        if not math.isfinite(instant):
            return ""
        if not self.dated:
            return f"{instant:.6g}"
        return datetime.fromtimestamp(instant, UTC).strftime("%Y-%m-%d %H:%M:%S")

    def column(self) -> Column:
        """First column of every table of blocks."""
        if self.dated:
            return Column("start of block, UTC", [self.text(float(value)) for value in self.start])
        return Column("start of block", list(self.start), "s", fixed=True)

    def figure(self, key: str, title: str, panels: Sequence[Panel], series: Sequence[Series], **more: Any) -> Figure:
        if self.alone:
            series = [replace(one, style="points") for one in series]
            more["window"] = (0.0, self.length / self.divisor)
        return Figure(key, title, (Abscissa("time", self.label, self.unit),), tuple(panels), tuple(series), **more)


def _values(tree: Any, group: str, name: str) -> Array:
    return np.asarray(tree[group][name].values, dtype=float)


def _counted(counts: Array) -> str:
    return f"{float(np.nansum(counts)):.0f}"


def _left_out(tree: Any, gauge: int, clock: _PageClock) -> str:
    """Return the share of time in no wave of the statistics, where it is more than the ends of blocks explain."""
    counts, periods = (_values(tree, "waves", name)[:, gauge] for name in ("count", "mean_period"))
    share = 1.0 - float(np.nansum(counts * np.nan_to_num(periods))) / (clock.length * clock.start.size)
    # a block begins and ends inside a wave
    ends = float(np.nanmean(periods)) / clock.length if np.isfinite(periods).any() else 0.0
    return f"; {format_percent(share)} of the time is in no wave of the statistics" if share > 2.0 * ends else ""


def _middle(values: Array) -> str:
    """Return the median of the blocks, which the largest of many blocks stands above by chance alone."""
    known = values[np.isfinite(values)]
    return f"; median of {known.size} blocks {format_quantity(float(np.median(known)), 'm')}" if known.size > 1 else ""


def _sampling(tree: Any, gauge: str, row: int, length: float) -> str:
    """Return the sampling error of a block's height, where it has a spectrum."""
    if "spectra" not in tree.children or gauge not in (names := [str(one) for one in tree["spectra"]["gauge"].values]):
        return ""
    column = names.index(gauge)
    density = np.nan_to_num(_values(tree, "spectra", "density")[row, column])
    freedom = float(_values(tree, "spectra", "degrees_of_freedom")[row, column])
    error = height_sampling_error(np.asarray(tree["spectra"]["frequency"].values), density, freedom, length)
    return f"; sampling error of a block {format_percent(error)}" if math.isfinite(error) else ""


def _key_figures(result: Result, clock: _PageClock) -> list[Block]:
    tree: Any = result.tree
    items = [KeyFigure("blocks", str(clock.start.size), f"of {clock.length:g} s")]
    if "waves" in tree.children:
        third = _values(tree, "waves", "third_height")
        if np.isfinite(third).any():
            row, column = np.unravel_index(int(np.nanargmax(third)), third.shape)
            gauge = str(tree["waves"]["gauge"].values[column])
            items.append(
                KeyFigure(
                    "largest H1/3",
                    format_quantity(float(third[row, column]), "m"),
                    f"{gauge}, {clock.text(float(clock.start[row]))}{_middle(third[:, column])}"
                    f"{_sampling(tree, gauge, int(row), clock.length)}",
                )
            )
            highest = _values(tree, "waves", "maximum_height")
            row, column = np.unravel_index(int(np.nanargmax(highest)), highest.shape)
            items.append(
                KeyFigure(
                    "highest wave",
                    format_quantity(float(highest[row, column]), "m"),
                    f"{clock.text(clock.start[row])}, of {_counted(_values(tree, 'waves', 'count')[:, column])} waves"
                    f"{_left_out(tree, int(column), clock)}",
                )
            )
    items += heading_figures(tree, clock.start, clock.text)
    if "tensions" in tree.children:
        above, steady = _values(tree, "tensions", "maximum"), _values(tree, "tensions", "steady")
        largest = above + steady
        if np.isfinite(largest).any():
            row, column = np.unravel_index(int(np.nanargmax(largest)), largest.shape)
            line = str(tree["tensions"]["line"].values[column])
            parts = [format_quantity(float(part[row, column]), "N") for part in (above, steady)]
            detail = (
                f"{line}, {clock.text(float(clock.start[row]))}: {parts[0]} above the steady {parts[1]}; largest of "
                f"{_counted(_values(tree, 'tensions', 'waves')[:, column])} waves of the record, no extreme of a "
                "longer time"
            )
            items.append(KeyFigure("largest tension", format_quantity(float(largest[row, column]), "N"), detail))
    for name, words in (("reflected_height", "reflection"), ("transmitted_height", "transmission")):
        if "reflection" in tree.children and name in tree["reflection"]:
            height, incident = _values(tree, "reflection", name), _values(tree, "reflection", "incident_height")
            known = np.isfinite(height) & (incident > 0.0)
            if known.any():
                # calm blocks have coefficients of noise: energies are added, not coefficients
                ratio = math.sqrt(float(np.sum(height[known] ** 2) / np.sum(incident[known] ** 2)))
                items.append(KeyFigure(words, f"{ratio:.3f}", f"of the energy of {counted(int(known.sum()), 'block')}"))
    shares = [
        _values(tree, "blocks", f"channel_{place}_share")
        for place, _ in enumerate(str(tree["blocks"].attrs.get("channels", "")).split("\n"))
        if f"channel_{place}_share" in tree["blocks"]
    ]
    if shares:
        sound = float(np.nanmean(shares))
        words = format_percent(min(sound, 0.999) if sound < 1.0 else sound, 3)
        items.append(KeyFigure("sound samples", words, "mean of the channels"))
    return [KeyFigures(tuple(items))]


def _block_table(
    tree: Any, clock: _PageClock, group: str, key: str, title: str, columns: Sequence[tuple[str, str]],
    place: int | None,
) -> Table:  # fmt: skip
    """Return a table of blocks; ``place`` chooses the gauge or line."""
    out = [clock.column()]
    for name, label in columns:
        if name not in tree[group]:
            continue
        values = _values(tree, group, name)
        values = values if place is None else values[:, place]
        unit = str(tree[group][name].attrs.get("units", ""))
        if unit == "rad":
            values, unit = np.degrees(values), "deg"
        out.append(Column(label, list(values), unit, digits=4))
    return Table(key, title, tuple(out), collapsed=clock.start.size > 40)


def _waves(tree: Any, clock: _PageClock) -> list[Block]:
    gauges = [str(name) for name in tree["waves"]["gauge"].values]
    series = []
    for tone, gauge in enumerate(gauges):
        suffix = f" {gauge}" if len(gauges) > 1 else ""
        for panel, names in enumerate((("third_height", "maximum_height"), ("third_period", "peak_period"))):
            for number, name in enumerate(names):
                if name in tree["waves"]:
                    words = {
                        "third_height": "H1/3",
                        "maximum_height": "Hmax",
                        "third_period": "T1/3",
                        "peak_period": "Tp",
                    }[name]
                    series.append(
                        Series(
                            words + suffix,
                            {"time": clock.x},
                            _values(tree, "waves", name)[:, tone],
                            panel,
                            tone + 2 * number,
                            "line",
                            "solid" if number == 0 else "dot",
                        )
                    )
    blocks: list[Block] = [
        clock.figure(
            "waves",
            "Heights and periods of the blocks",
            (Panel("height", "m", from_zero=True), Panel("period", "s", from_zero=True)),
            series,
            height=460,
        )
    ]
    for place, gauge in enumerate(gauges):
        title = "Waves of every block" + (f", {gauge}" if len(gauges) > 1 else "")
        blocks.append(_block_table(tree, clock, "waves", f"waves-{place + 1}", title, WAVE_COLUMNS, place))
    return blocks


def _spectra(tree: Any, clock: _PageClock) -> list[Block]:
    group = tree["spectra"]
    frequency = np.asarray(group["frequency"].values, dtype=float)
    density = np.asarray(group["density"].values, dtype=float)
    gauges = [str(name) for name in group["gauge"].values]
    series = []
    energy = np.nansum(density, axis=2)
    for column, gauge in enumerate(gauges):
        if not energy[:, column].any():
            continue
        order = [int(np.argmax(energy[:, column]))]
        sound = density[energy[:, column] > 0.0, column]
        count = np.isfinite(sound).sum(axis=0)
        mean = np.nansum(sound, axis=0) / np.where(count > 0, count, np.nan)  # gauges may differ in their frequencies
        words = clock.text(float(clock.start[order[0]]))
        suffix = f" {gauge}" if len(gauges) > 1 else ""
        series.append(Series(f"block of {words}{suffix}", {"f": frequency}, density[order[0], column], 0, 2 * column))
        if not clock.alone:
            label = f"mean of the blocks{suffix}"
            series.append(Series(label, {"f": frequency}, mean, 0, 2 * column + 1, dash="dash"))
    freedom = np.asarray(group["degrees_of_freedom"].values, dtype=float)
    caption = f"One-sided density; {np.nanmedian(freedom):.3g} degrees of freedom in a block."
    return [
        Figure(
            "spectra",
            "Spectrum of the block with most energy",
            (Abscissa("f", "frequency", "Hz"),),
            (Panel("density", "m2/Hz", from_zero=True),),
            tuple(series),
            caption,
        )
    ]


def _directions(tree: Any, clock: _PageClock) -> list[Block]:
    names = [name for name in ("mean_heading", "peak_heading", "spread", "peak_spread") if name in tree["directions"]]
    bearing = float(tree.attrs.get("x_axis_bearing_deg", math.nan))
    compass = math.isfinite(bearing)
    shown = {
        name: come_from(_values(tree, "directions", name), bearing)
        if compass and "heading" in name
        else np.degrees(_values(tree, "directions", name))
        for name in names
    }
    series = [
        Series(
            name.replace("heading", "direction" if compass else "heading").replace("_", " "),
            {"time": clock.x},
            shown[name],
            1 if "spread" in name else 0,
            tone,
            "points",
        )
        for tone, name in enumerate(names)
    ]
    caption = "Headings are directions of travel: 0 along +x, 90 along +y."
    first = Panel("heading", "deg")
    if compass:
        caption = (
            "Directions that the waves come from, clockwise from north: N 0, E 90, S 180, W 270. Headings of the table "
            f"are directions of travel from +x, which points to the bearing {bearing:g} degrees."
        )
        first = Panel("coming from", "deg", limits=(0.0, 360.0))
    panels = (first, Panel("spread", "deg", from_zero=True))
    columns = [(name, name.replace("_", " ")) for name in names]
    table = _block_table(tree, clock, "directions", "directions", "Directions of every block", columns, None)
    if compass:
        table = with_bearings(table, {name.split("_")[0]: shown[name] for name in names if "heading" in name}, "from")
    return [clock.figure("directions", "Directions of the waves", panels, series, caption=caption), table]


def _current(tree: Any, clock: _PageClock) -> list[Block]:
    names = [name for name in ("current_speed", "current_x", "current_y", "current_normal") if name in tree["current"]]
    words = {
        "current_speed": "speed",
        "current_x": "along x",
        "current_y": "along y",
        "current_normal": "normal to the structure, U_x",
        "current_heading": "heading",
        "current_deviation": "deviation within the block",
    }
    series = [
        Series(words[name], {"time": clock.x}, _values(tree, "current", name), 0, tone)
        for tone, name in enumerate(names)
    ]
    columns = [(name, words[name]) for name in words]
    table = _block_table(tree, clock, "current", "current", "Mean currents of every block", columns, None)
    bearing = float(tree.attrs.get("x_axis_bearing_deg", math.nan))
    if math.isfinite(bearing) and "current_heading" in tree["current"]:
        towards = np.mod(come_from(_values(tree, "current", "current_heading"), bearing) + 180.0, 360.0)
        table = with_bearings(table, {"current": towards}, "towards")
    return [clock.figure("current", "Mean currents", (Panel("current", "m/s"),), series), table]


def _tensions(tree: Any, clock: _PageClock) -> list[Block]:
    lines = [str(name) for name in tree["tensions"]["line"].values]
    series = []
    for tone, line in enumerate(lines):
        for panel, name in enumerate(("steady", "tenth")):
            if name in tree["tensions"]:
                values = _values(tree, "tensions", name)[:, tone] / 1000.0
                series.append(Series(line, {"time": clock.x}, values, panel, tone))
    panels = (Panel("steady tension", "kN"), Panel("T_1/10", "kN", from_zero=True))
    blocks: list[Block] = [clock.figure("tensions", "Tensions of the blocks", panels, series, height=460)]
    if "waves" in tree.children and "tenth" in tree["tensions"]:
        height = _values(tree, "waves", "third_height")[:, 0]
        scatter = [
            Series(line, {"H": height}, _values(tree, "tensions", "tenth")[:, tone] / 1000.0, 0, tone, "points")
            for tone, line in enumerate(lines)
        ]
        blocks.append(
            Figure(
                "tension-height",
                "Wave tension against wave height",
                (Abscissa("H", "H1/3", "m"),),
                (Panel("T_1/10", "kN", from_zero=True),),
                tuple(scatter),
            )
        )
    for place, line in enumerate(lines):
        title = f"Tensions of every block, {line}"
        blocks.append(_block_table(tree, clock, "tensions", f"tensions-{place + 1}", title, TENSION_COLUMNS, place))
    return blocks


def _responses(tree: Any, clock: _PageClock) -> list[Block]:
    group = tree["responses"]
    frequency = np.asarray(group["frequency"].values, dtype=float)
    names = [str(name) for name in group["motion"].values]
    modulus, coherence = (np.asarray(group[name].values, dtype=float) for name in ("modulus", "coherence"))
    error, phase = (np.asarray(group[name].values, dtype=float) for name in ("error", "phase"))
    row = int(np.argmax(np.isfinite(modulus).sum(axis=(1, 2))))
    series = []
    for tone, name in enumerate(names):
        series.append(Series(name, {"f": frequency}, modulus[row, tone], 0, tone, "line+points"))
        series.append(Series(name, {"f": frequency}, coherence[row, tone], 1, tone))
    caption = f"Block of {clock.text(float(clock.start[row]))}; moduli in {group.attrs.get('units_of_modulus', '')}."
    figure = Figure(
        "responses",
        "Response to the waves",
        (Abscissa("f", "frequency", "Hz"),),
        (Panel("modulus", "", from_zero=True), Panel("squared coherence", "", limits=(0.0, 1.0))),
        tuple(series),
        caption,
        height=460,
    )
    shown = np.isfinite(modulus[row]).any(axis=0)
    columns = [Column("frequency", list(frequency[shown]), "Hz", digits=4)]
    for tone, name in enumerate(names):
        for label, values in (
            ("modulus", modulus[row, tone]),
            ("error", error[row, tone]),
            ("phase, deg", np.degrees(phase[row, tone])),
            ("coherence", coherence[row, tone]),
        ):
            columns.append(Column(f"{name} {label}", list(values[shown]), digits=4, uniform=False))
    return [figure, Table("responses", "Response to the waves", tuple(columns), caption)]


def _fits(tree: Any, clock: _PageClock) -> list[Block]:
    group = tree["fits"]
    texts = [(name, [str(value) for value in group[name].values]) for name in ("relation", "of", "parameter")]
    numbers = ("value", "error", "low", "high", "determination", "count")
    columns = [Column(str(group[name].attrs["long_name"]), values) for name, values in texts]
    columns += [
        Column(
            str(group[name].attrs["long_name"]), list(np.asarray(group[name].values, float)), digits=4, uniform=False
        )
        for name in numbers
    ]
    return [Table("fits", "Relations between the blocks", tuple(columns), "In SI units; bounds are those of 95 %.")]


def _reflection(tree: Any, clock: _PageClock) -> list[Block]:
    names = list(tree["reflection"].data_vars)
    words = {name: str(tree["reflection"][name].attrs.get("long_name", name)) for name in names}
    coefficients = [name for name in names if str(name).endswith("coefficient")]
    series = [
        Series(words[name], {"time": clock.x}, _values(tree, "reflection", str(name)), 0, tone, "line+points")
        for tone, name in enumerate(coefficients)
    ]
    columns = [(str(name), words[name]) for name in names]
    table = _block_table(tree, clock, "reflection", "reflection", "Reflection of every block", columns, None)
    panel = Panel("coefficient", "", from_zero=True)
    return [clock.figure("reflection", "Reflection and transmission", (panel,), series), table]


def _whole(tree: Any, clock: _PageClock) -> list[Block]:
    group = tree["whole"]
    ratio = np.asarray(group["ratio"].values, dtype=float)
    gauges = [str(name) for name in group["gauge"].values]
    series = []
    for tone, gauge in enumerate(gauges):
        exceeded = np.asarray(group["exceedance"].values, dtype=float)[tone]
        scale, shape = float(group["weibull_scale"].values[tone]), float(group["weibull_shape"].values[tone])
        shown = np.where(exceeded > 0.0, exceeded, np.nan)
        series.append(Series(f"{gauge}, all waves", {"h": ratio}, np.log10(shown), 0, tone, "points"))
        fitted = -((ratio / scale) ** min(shape, 100.0)) * math.log10(math.e)
        series.append(Series(f"{gauge}, Weibull", {"h": ratio}, fitted, 0, tone))
    rayleigh = -((ratio * 1.41573) ** 2) * math.log10(math.e)
    series.append(Series("Rayleigh", {"h": ratio}, rayleigh, 0, len(gauges), dash="dash"))
    floor = -math.ceil(math.log10(max(float(np.max(group["wave_count"].values)), 10.0)))
    figure = Figure(
        "heights",
        "Exceedance of wave heights over the H1/3 of their block",
        (Abscissa("h", "H over H1/3"),),
        (Panel("log10 of the exceedance", "", limits=(float(floor), 0.0)),),
        tuple(series),
        marks=(Mark("1.8", x=1.8),),
    )
    table = Table(
        "distribution",
        "Fits of the heights",
        (
            Column("gauge", gauges),
            Column("waves", list(np.asarray(group["wave_count"].values, dtype=float))),
            *(
                Column(label, list(np.asarray(group[name].values, dtype=float)), "", digits=4, uniform=False)
                for name, label in (
                    ("weibull_shape", "Weibull shape (2: Rayleigh)"),
                    ("weibull_shape_error", "its standard error"),
                    ("weibull_scale", "Weibull scale"),
                    ("weibull_distance", "distance, Weibull"),
                    ("rayleigh_scale", "Rayleigh scale"),
                    ("rayleigh_distance", "distance, Rayleigh"),
                )
            ),
        ),
        "Heights are over the H1/3 of their block; distances are Kolmogorov's.",
    )
    return [figure, table]


def _channels(tree: Any, clock: _PageClock) -> list[Block]:
    names = str(tree["blocks"].attrs.get("channels", "")).split("\n")
    rows: list[list[Any]] = []
    for place, name in enumerate(names):
        mean = _values(tree, "blocks", f"channel_{place}_mean")
        unit = str(tree["blocks"][f"channel_{place}_mean"].attrs.get("units", ""))
        deviation = _values(tree, "blocks", f"channel_{place}_deviation")
        low, high = (
            _values(tree, "blocks", f"channel_{place}_smallest"),
            _values(tree, "blocks", f"channel_{place}_largest"),
        )
        share = _values(tree, "blocks", f"channel_{place}_share")
        known = np.isfinite(mean)
        if not known.any():
            rows.append([name, unit, math.nan, math.nan, math.nan, math.nan, 0.0])
            continue
        total = math.sqrt(float(np.nanmean(deviation**2)) + float(np.nanvar(mean)))
        rows.append([name, unit, *(float(v) for v in (np.nanmean(mean), total, np.nanmin(low), np.nanmax(high)))])
        rows[-1].append(float(np.nanmean(share)) * 100.0)
    columns = list(zip(*rows, strict=True))
    labels = ("channel", "unit", "mean", "standard deviation", "smallest", "largest", "sound samples, %")
    table = Table(
        "channels",
        "Channels over the whole record",
        tuple(
            Column(label, list(values), "", digits=4, uniform=False)
            for label, values in zip(labels, columns, strict=True)
        ),
        "Missing samples, spikes and values out of range are left out of these figures, flat and clipped ones are not.",
    )
    return [table]


def _quality(tree: Any, clock: _PageClock) -> list[Block]:
    group = tree["quality"]
    count = int(group.sizes.get("finding", 0))
    if count == 0:
        return [Table("quality", "Quality", (Column("finding", ["nothing was found"]),))]
    channel, kind = (np.asarray(group[name].values, dtype=object) for name in ("channel", "kind"))
    samples = np.asarray(group["count"].values, dtype=float)
    pairs = sorted({(str(a), str(b)) for a, b in zip(channel, kind, strict=True)})
    summary = Table(
        "quality-summary",
        "What was found",
        (
            Column("channel", [pair[0] for pair in pairs]),
            Column("kind", [pair[1] for pair in pairs]),
            Column("stretches", [float(np.sum((channel == a) & (kind == b))) for a, b in pairs]),
            Column("samples", [float(np.sum(samples[(channel == a) & (kind == b)])) for a, b in pairs]),
        ),
        "Nothing was changed; a notice says where short gaps were filled for spectra.",
    )
    listing = Table(
        "quality",
        "Every stretch",
        (
            Column("channel", [str(value) for value in channel]),
            Column("kind", [str(value) for value in kind]),
            Column("from", [clock.text(float(value)) for value in group["start"].values]),
            Column("to", [clock.text(float(value)) for value in group["end"].values]),
            Column("samples", list(samples)),
            Column("detail", [str(value) for value in group["detail"].values]),
        ),
        collapsed=True,
    )
    channels = str(tree["blocks"].attrs.get("channels", "")).split("\n")
    ends = zip(channel, kind, group["start"].values, group["end"].values, strict=True)
    spans = [Span(str(name), str(what), float(start), float(end)) for name, what, start, end in ends]
    begin, end = float(clock.start[0]), float(clock.start[-1]) + clock.length
    return [flag_lanes(channels, spans, begin, end, clock.text), summary, listing]
