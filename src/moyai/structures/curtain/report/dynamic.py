"""The whole span of a curtain through time: moving 3-D view, tensions, peaks with their uncertainty, snaps."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from moyai.core.arrays import Array
from moyai.report.animation_3d import animation_3d
from moyai.report.decimate import focus_indices, window_around
from moyai.report.document import (
    Abscissa,
    Animation,
    Block,
    Choice,
    Column,
    Figure,
    Option,
    Panel,
    Series,
    Table,
    in_one_unit,
)
from moyai.report.formatting import format_quantity
from moyai.report.reading import Group, common_scale
from moyai.report.scene_3d import Faces, Marker, Scene3D, Trace, Waves3D, frame_rows
from moyai.structures.curtain.report.reading import CurtainLevel, key

_BINS, _PERIODS_SHOWN, _WHOLE = 900, 4.0, 6.0
#: Columns of the table of the uncertainty of peaks: heading, name in the table of runs, name of each line in its run.
_TRIALS = (
    ("As run", "both_cables_tension_maximum", "line_tension_maximum"),
    ("Half the step", "half_step_peak", "line_half_step"),
    ("Half the cells", "half_mesh_peak", "line_half_mesh"),
    ("Extrapolated", "extrapolated_peak", "line_extrapolated"),
    ("Twice the viscosity", "double_viscosity_peak", "line_double_viscosity"),
    ("Held normals", "held_normals_peak", "line_held_normals"),
)


def dynamic_blocks(level: CurtainLevel) -> Sequence[Block | None]:
    """Return what the report shows of the dynamic analysis of a level."""
    group = level.part("dynamic")
    if not group.exists:
        return ()
    runs = [run for run in group.children() if run.exists]
    options = []
    for run in runs:
        inside = (
            span_animation(level, run), tension_figure(level, run), energy_figure(level, run), snap_table(level, run)
        )  # fmt: skip
        blocks = tuple(block for block in inside if block is not None)
        if blocks:
            options.append(Option(run.name, blocks))
    choice = Choice("dynamic-run", "Run", tuple(options), print_all=False) if options else None
    return peak_table(level), sample_table(level), uncertainty_table(level), choice


def _rows(group: Group, columns: tuple[tuple[str, str, str], ...]) -> list[Column]:
    return [
        Column(label, [float(value) for value in values], unit)
        for name, label, unit in columns
        if (values := group.real(name, "run")) is not None and np.isfinite(values).any()
    ]


def peak_table(level: CurtainLevel) -> Table | None:
    """Return the peaks of all runs, and those of the models of the impact."""
    group = level.part("dynamic")
    names = group.labels("run")
    columns = _rows(
        group,
        (
            ("both_cables_tension_maximum", "Both cables", "N"),
            ("upper_peak", "Upper cable", "N"),
            ("lower_peak", "Lower cable", "N"),
            ("anchor_line_tension_maximum", "Anchor line", "N"),
            ("skirt_peak", "Skirt", "N/m"),
            ("both_cables_peak_time", "At time", "s"),
        ),
    )
    if not names or not columns:
        return None
    values = group.real("dynamic_model_tension", "dynamic_model")
    note = "Highest tensions over the span; both cables: their largest sum."
    if values is not None:
        pairs = zip(group.labels("dynamic_model"), values, strict=True)
        said = ", ".join(f"{name} {format_quantity(float(value), 'N')}" for name, value in pairs)
        note += f" Models of the snap with a rigid skirt, at the speed of the current, for comparison: {said}."
        note += " The tension is less where the toe yields or the skirt bulges first."
    return Table(
        key(level, "dynamic-peaks"),
        "Peaks of the whole span",
        (Column("Run", list(names)), *in_one_unit(columns)),
        note,
    )


def sample_table(level: CurtainLevel) -> Table | None:
    """Return the highest tensions of every run of events that were run on two meshes or with several realisations."""
    group = level.part("dynamic")
    peaks = group.real("sample_peak", "sample", "span_component")
    if peaks is None:
        return None
    seeds = group.real("sample_seed", "sample")
    names = group.labels("span_component")
    tensions = [
        Column(name[0].upper() + name[1:], [float(value) for value in column], "N/m" if name == "skirt" else "N")
        for name, column in zip(names, peaks.T, strict=True)
        if np.any(column > 0.0)
    ]
    return Table(
        key(level, "dynamic-samples"),
        "Highest tensions of every realisation and mesh",
        (
            Column("Event", _words(group, "sample_event", "sample")),
            Column("Cells", _words(group, "sample_cells", "sample")),
            Column("Seed", ["-" if seed == 0 else f"{seed:.0f}" for seed in (() if seeds is None else seeds)]),
            *in_one_unit(tensions),
        ),
        "The larger of the means on the meshes is used; of three the coarsest is left out where the finer two are "
        "nearer to each other. Where the finer mesh gives more than a fifth above the coarser one with the same "
        "realisations, the number is a bound from below.",
    )


def uncertainty_table(level: CurtainLevel) -> Table | None:
    """Return what the peaks of each cable and line become with another step, mesh, viscosity, and held normals."""
    group = level.part("dynamic")
    names: list[str] = []
    lines: list[str] = []
    values: dict[str, list[float]] = {heading: [] for heading, _, _ in _TRIALS}
    for number, name in enumerate(group.labels("run")):
        run = group.child(name)
        half = group.real("half_step_peak", "run")
        if not run.exists or half is None or not np.isfinite(half[number]):
            continue
        for row, line in enumerate(("both cables", *run.labels("line"))):
            names.append(name)
            lines.append(line)
            for heading, whole, one in _TRIALS:
                found = group.real(whole, "run") if row == 0 else run.real(one, "line")
                values[heading].append(math.nan if found is None else float(found[number if row == 0 else row - 1]))
    if not names:
        return None
    columns = [Column(heading, column, "N") for heading, column in values.items() if np.isfinite(column).any()]
    note = (
        "Extrapolated: the value that both meshes point to, if the error falls with the size of the cells; none where "
        "they are more than a fifth apart. The spread of a row is the accuracy of the number."
    )
    if "Held normals" in [column.label for column in columns]:
        note += " Held normals: sections of added mass keep the directions of the just-taut span."
    run_column = (Column("Run", names),) if len(set(names)) > 1 else ()
    return Table(
        key(level, "dynamic-uncertainty"),
        "Uncertainty of the peaks",
        (*run_column, Column("Line", lines), *in_one_unit(columns)),
        note,
    )


def snap_table(level: CurtainLevel, run: Group) -> Table | None:
    """Return peaks, slack times and snaps of each cable and anchor line."""
    names = run.labels("line")
    if not names:
        return None
    columns = [
        Column(label, [float(value) for value in values], unit)
        for name, label, unit in (
            ("line_tension_maximum", "Peak", "N"),
            ("line_peak_time", "At time", "s"),
            ("slack_share", "Slack share of time", ""),
            ("contact_count", "Times taut again", ""),
            ("snap_count", "Snaps", ""),
            ("snap_threshold", "Snap threshold", "N"),
            ("median_rise_time", "Rise", "s"),
        )
        if (values := run.real(name, "line")) is not None and np.isfinite(values).any()
    ]
    return Table(
        key(level, run.name, "dynamic-snaps"),
        "Slack and snaps",
        (Column("Line", list(names)), *in_one_unit(columns)),
        f"Counted from t = {run.number('counted_from'):.3g} s, cables at their support; a snap exceeds the "
        "threshold, its rise goes from a tenth to nine tenths.",
    )


def tension_figure(level: CurtainLevel, run: Group) -> Figure | None:
    """Return the tensions of cables and anchor lines over time, opened at the peak."""
    time, both = run.real("time", "time"), run.real("both_cables_tension_peak_since_row", "time")
    if time is None or both is None or time.size < 3 or not np.isfinite(both).any():
        return None
    lines = {name: run.real("line_tension_peak_since_row", "time", line=name) for name in run.labels("line")}
    known = {name: values for name, values in lines.items() if values is not None}
    factor, unit = common_scale("N", both, *known.values())
    late = np.nan_to_num(both) * (time >= run.number("counted_from") - 1e-9)
    peak = int(np.argmax(late if late.any() else np.nan_to_num(both)))
    first, last = window_around(time, float(time[peak]), _length(time, run.number("period")))
    place = run.real("mid_span_x", "time")
    toe = run.real("mid_toe_x", "time")
    keep = focus_indices(np.column_stack([both, *known.values()]), (first, last), _BINS)
    x = {"time": time[keep]}
    series = [Series("both cables", x, both[keep] * factor, tone=0)]
    for tone, (name, values) in enumerate(known.items(), start=1):
        series.append(Series(name, x, values[keep] * factor, tone=tone))
    panels = [Panel("tension", unit, from_zero=True)]
    if place is not None and toe is not None:
        panels.append(Panel("mid-span, downstream", "m"))
        series.append(Series("upper edge", x, place[keep], panel=1, tone=4))
        series.append(Series("toe", x, toe[keep], panel=1, tone=5))
    return Figure(
        key(level, run.name, "dynamic-tension"),
        "Tensions over time",
        (Abscissa("time", "time", "s"),),
        tuple(panels),
        tuple(series),
        f"Highest over the span and since the row before; {format_quantity(float(both[peak]), 'N')} in both cables at "
        f"t = {time[peak]:.3g} s.",
        window=(float(time[first]), float(time[last - 1])),
        slider=True,
        height=430,
    )


def energy_figure(level: CurtainLevel, run: Group) -> Figure | None:
    """Return the energies of the span over time."""
    time = run.real("time", "time")
    found = {
        words: run.real(name, "time")
        for words, name in (
            ("moving, with its water", "kinetic_energy"),
            ("stretched", "elastic_energy"),
            ("balance: minus what viscosity took", "energy_balance"),
        )
    }
    known = {words: values for words, values in found.items() if values is not None}
    if time is None or len(known) < 3 or time.size < 3:
        return None
    factor, unit = common_scale("J", *known.values())
    keep = focus_indices(np.column_stack(list(known.values())), (0, time.size), _BINS)
    series = tuple(
        Series(words, {"time": time[keep]}, values[keep] * factor, tone=tone)
        for tone, (words, values) in enumerate(known.items())
    )
    return Figure(
        key(level, run.name, "dynamic-energy"),
        "Energy",
        (Abscissa("time", "time", "s"),),
        (Panel("energy", unit),),
        series,
        "Cables, skirt and the water that they set in motion. A balance that rises would be a numerical error.",
        height=260,
    )


def _length(time: Array, period: float) -> float:
    return min(_PERIODS_SHOWN * period if period > 0.0 else math.inf, float(np.ptp(time)))


def span_animation(level: CurtainLevel, run: Group) -> Animation | None:
    """Return the moving view of the span."""
    frames = run.child("frames")
    time, position = frames.real("frame_time", "frame"), frames.real("node_position", "frame", "node", "axis")
    tension, skirt = frames.real("bar_tension", "frame", "bar"), frames.real("triangle_tension", "frame", "triangle")
    bars, triangles = frames.array("bar_nodes", "bar", "end"), frames.array("triangle_nodes", "triangle", "corner")
    if time is None or position is None or tension is None or bars is None or triangles is None or time.size < 2:
        return None
    moment = frames.number("peak_time")
    length = float(np.ptp(time)) if np.ptp(time) < _WHOLE else _length(time, run.number("period"))
    begin = min(max(moment - 0.6 * length, float(time[0])), float(time[-1]) - length)
    window = (begin, begin + length)
    rows = frame_rows(time, nodes=position.shape[1], bars=len(bars), window=window, moments=(moment,))
    names = tuple(frames.labels("bar_line")) or tuple(_words(frames, "bar_line", "bar"))
    markers = []
    for number, name in enumerate(names):
        if name.startswith("anchor line"):
            markers.append(Marker(int(bars[number][1]), "anchor", "anchor"))
            markers.append(Marker(int(bars[number][0]), "support", "float"))
    record, traces = run.real("time", "time"), []
    for name in run.labels("line"):
        values = run.real("line_tension_peak_since_row", "time", line=name)
        if record is not None and values is not None:
            traces.append(Trace(name, record, np.nan_to_num(values), names.index(name) if name in names else -1))
    depth = level.depth
    scene = Scene3D(
        time[rows], position[rows], np.asarray(bars, dtype=np.int64), tension[rows],
        faces=(Faces(np.asarray(triangles, dtype=np.int64), "skirt", load=None if skirt is None else skirt[rows]),),
        markers=tuple(markers), traces=tuple(traces), waves=_waves(frames),
        bed=-depth if math.isfinite(depth) else None, window=window, maximum=moment, names=names,
    )  # fmt: skip
    return animation_3d(
        key(level, run.name, "dynamic-view"),
        f"The span in motion: {run.name}",
        scene,
        "To scale, axes of the span: x downstream, y along it. The skirt is coloured by its higher principal tension, "
        f"the cables by theirs; opened at the highest tension, t = {moment:.3g} s.",
    )


def _words(group: Group, name: str, dim: str) -> list[str]:
    # words, which the readers of numbers leave out
    node = group.node
    if node is None or name not in node.variables or node.variables[name].dims != (dim,):
        return []
    return [str(value) for value in node.variables[name].values]


def _waves(frames: Group) -> Waves3D | None:
    parts = [
        frames.array(f"wave_{name}", "component") for name in ("amplitude", "omega", "wave_number", "heading", "phase")
    ]
    if any(part is None for part in parts):
        return None
    ramp = frames.number("wave_ramp")
    amplitude, omega, number, heading, phase = (np.asarray(part, dtype=np.float64) for part in parts)
    return Waves3D(amplitude, omega, number, heading, phase, ramp if math.isfinite(ramp) else 0.0)


__all__ = [
    "dynamic_blocks",
    "energy_figure",
    "peak_table",
    "snap_table",
    "span_animation",
    "tension_figure",
    "uncertainty_table",
]
