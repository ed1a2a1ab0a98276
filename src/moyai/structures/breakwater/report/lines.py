"""Lines in motion in the report of a breakwater: next to lines at rest, slack and snap, their moving shapes."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array
from moyai.report.decimate import focus_indices
from moyai.report.document import Abscissa, Block, Column, Figure, Panel, Paragraph, Series, Table
from moyai.report.formatting import format_quantity
from moyai.report.reading import Group, common_scale
from moyai.structures.breakwater.report.figures import key
from moyai.structures.breakwater.report.reading import BreakwaterLevel, Sea

BINS = 300

#: Columns of the table: variable, words, unit.
COLUMNS = (
    ("line_tension_maximum", "Largest tension", "N"),
    ("line_tension_maximum_lines_at_rest", "The same, lines at rest", "N"),
    ("line_tension_mean", "Mean", "N"),
    ("line_tension_minimum", "Smallest", "N"),
    ("anchor_vertical_tension_maximum_lines_in_motion", "Uplift at anchor", "N"),
    ("least_grounded_length", "Least length on bed", "m"),
    ("slack_time", "Time slack", "s"),
    ("contact_count", "Contacts", ""),
    ("snap_count", "Snaps", ""),
    ("largest_snap", "Largest snap", "N"),
    ("shortest_rise_time", "Shortest rise", "s"),
    ("peak_change_twice_the_bars", "Twice the bars", "%"),
    ("peak_change_half_the_step", "Half the step", "%"),
    ("peak_change_twice_the_damping", "Twice the damping", "%"),
)


def in_motion(run: Group) -> bool:
    """Whether the lines of a run are in motion."""
    return run.variable("moving_line_x") is not None


def line_blocks(
    level: BreakwaterLevel, sea: Sea, run: Group, window: tuple[float, float], line: int
) -> tuple[Block, ...]:
    """Return what lines in motion add to a run: their table and the record next to that of lines at rest.

    Parameters
    ----------
    level, sea, run
        Where the numbers stand.
    window : (float, float)
        Start and end of the window about the maximum [s].
    line : int
        The governing line.
    """
    if not in_motion(run):
        return ()
    blocks: list[Block] = []
    table = _table(level, sea, run)
    if table is not None:
        blocks.append(table)
        blocks.append(Paragraph(_words(run), quiet=True))
    figure = _figure(level, sea, run, window, max(line, 0))
    if figure is not None:
        blocks.append(figure)
    return tuple(blocks)


def _summary(sea: Sea, run: Group, name: str) -> Array | None:
    """Return a variable of the summary for this run, one number a line."""
    group = sea.domain("time")
    if group.variable(name) is None:
        return None
    if group.variable("period") is None:
        return group.real(name, "line")
    found, period = group.real(name, "period", "line"), group.real("period", "period")
    wanted = run.attributes.get("period")
    if found is None or period is None or wanted is None:
        return None
    row = int(np.argmin(np.abs(period - float(wanted))))
    return np.asarray(found[row])


def _table(level: BreakwaterLevel, sea: Sea, run: Group) -> Table | None:
    names = sea.domain("time").labels("line")
    columns = [Column("Line", names)]
    for name, words, unit in COLUMNS:
        found = _summary(sea, run, name)
        if found is None or not np.isfinite(found).any():
            continue
        if unit == "%":
            found = 100.0 * found
        whole = name.endswith("_count")
        values = [int(value) if whole and math.isfinite(value) else float(value) for value in found]
        columns.append(Column(words, values, unit, digits=4 if unit == "N" else 3))
    if len(columns) < 3:
        return None
    note = (
        "Tensions of one line at its fairlead. A contact is a slack line that comes taut, a snap a contact whose peak "
        "passes the threshold of the case."
    )
    if any(column.unit == "%" for column in columns):
        note += " Percentages: what the largest tension becomes with a finer mesh, a shorter step, more damping."
    return Table(
        key(level, sea.name, run.name, "lines-in-motion"),
        "Lines in motion and lines at rest",
        tuple(columns),
        note=note,
    )


def _words(run: Group) -> str:
    nodes, step = run.attributes.get("network_nodes"), run.attributes.get("network_step")
    body = run.attributes.get("time_step")
    parts = []
    if nodes is not None and step is not None and body is not None:
        parts.append(
            f"{int(nodes)} nodes; steps of {format_quantity(float(step), 's')} for the lines and "
            f"{format_quantity(float(body), 's')} for the unit."
        )
    parts.append("Lines at rest: the same sea with every line on its catenary at every instant.")
    return " ".join(parts)


def _figure(level: BreakwaterLevel, sea: Sea, run: Group, window: tuple[float, float], line: int) -> Figure | None:
    time = run.real("time", "time")
    moving, still = (
        run.real("line_tension_peak_since_row", "time", "line"),
        run.real("tension_lines_at_rest", "time", "line"),
    )
    if time is None or moving is None or still is None:
        return None
    names = run.labels("line")
    uplift = run.real("anchor_vertical_tension", "time", "line")
    grounded = run.real("grounded_length_history", "time", "line")
    pose, other = run.real("position", "time", "dof"), run.real("position_lines_at_rest", "time", "dof")
    # a line at rest at every instant has neither uplift nor length on the bed here
    chosen = line if np.isfinite(moving[:, line]).any() else 0
    first, last = np.searchsorted(time, list(window))
    stack = np.nan_to_num(np.column_stack([moving[:, chosen], still[:, chosen]]))
    keep = focus_indices(stack, (int(first), int(last) + 1), BINS)
    x = {"time": time[keep]}
    factor, shown = common_scale("N", moving[:, chosen])
    panels = [Panel(f"tension {names[chosen]}", shown, from_zero=True)]
    series = [
        Series("lines at rest", x, still[keep, chosen] * factor, 0, 1, dash="dash"),
        Series("lines in motion", x, moving[keep, chosen] * factor, 0, 3 + chosen),
    ]
    for values, words, unit in ((uplift, "uplift at anchor", "N"), (grounded, "length on bed", "m")):
        if values is not None and np.isfinite(values[:, chosen]).any():
            scale, unit_shown = common_scale(unit, values[:, chosen])
            panels.append(Panel(words, unit_shown))
            series.append(Series(words, x, values[keep, chosen] * scale, len(panels) - 1, 3 + chosen))
    if pose is not None and other is not None:
        scale, unit_shown = common_scale("m", pose[:, 0])
        panels.append(Panel("sway", unit_shown))
        at = len(panels) - 1
        series.append(Series("sway, lines at rest", x, other[keep, 0] * scale, at, 1, dash="dash"))
        series.append(Series("sway, lines in motion", x, pose[keep, 0] * scale, at, 0))
    return Figure(
        key(level, sea.name, run.name, "lines-in-motion-record"),
        "Lines in motion compared with lines at rest",
        (Abscissa("time", "time", "s"),),
        tuple(panels),
        tuple(series),
        "Window about the governing maximum. What parts the curves is the drag, the inertia and the slack of the line.",
        window=window,
        slider=True,
        height=110 + 105 * len(panels),
    )


def moving_paths(run: Group, names: tuple[str, ...], times: Array) -> dict[str, Array]:
    """Return x and z of lines in motion at the times of frames (frames, nodes, 2), as far as they are kept."""
    kept = run.real("shape_time", "shape_time")
    x = run.real("moving_line_x", "shape_time", "line", "line_node")
    z = run.real("moving_line_z", "shape_time", "line", "line_node")
    if kept is None or x is None or z is None or kept.size < 2:
        return {}
    if times[0] < kept[0] - 1e-6 * np.ptp(kept) - 1e-9 or times[-1] > kept[-1] + 1e-6 * np.ptp(kept) + 1e-9:
        times = np.clip(times, kept[0], kept[-1])
    right = np.clip(np.searchsorted(kept, times), 1, kept.size - 1)
    part = ((times - kept[right - 1]) / (kept[right] - kept[right - 1]))[:, None]
    out = {}
    for number, name in enumerate(names):
        nodes = np.isfinite(x[0, number])
        if not nodes.any():
            continue
        both = []
        for values in (x[:, number][:, nodes], z[:, number][:, nodes]):
            both.append((1.0 - part) * values[right - 1] + part * values[right])
        out[name] = np.stack(both, axis=-1)
    return out
