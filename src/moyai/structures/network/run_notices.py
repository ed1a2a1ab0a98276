"""What a run of a network has to say of its own figures."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.validity import Notice
from moyai.core.wording import spoken
from moyai.flexible.network import Network
from moyai.flexible.result import History
from moyai.sea.validity import check_realised_height
from moyai.series.snaps import SnapRecord
from moyai.structures.network.assembly import Assembly
from moyai.structures.network.bodies import lean_of
from moyai.structures.network.model import NetworkProblem
from moyai.structures.network.runs import RunPlan

if TYPE_CHECKING:
    import xarray as xr

#: Highest tension over that at the ends of its line, from which a run says that it stands inside.
INSIDE = 1.2
#: Part of the water of sheets that still moves with what is across them, below which a run says that they turned.
ACROSS = 0.5
#: Lean from which a body counts as turned over [rad].
OVER = math.radians(60.0)


def wet_in_air(network: Network, position: Array, said: str = "") -> list[Notice]:
    """Return what stands above still water with all of its buoyancy, since it has a height of nought.

    Parameters
    ----------
    network : Network
    position : ndarray, shape (n, 3)
        Of the nodes at rest [m].
    said : str
        In front of the message.
    """
    nodes = network.nodes
    over = np.flatnonzero((nodes.volume > 0.0) & (nodes.height == 0.0) & (position[:, 2] > 1e-3))
    if not over.size:
        return []
    node = int(over[np.argmax(position[over, 2])])
    name = next((name for name, place in network.points.items() if place == node), f"node {node}")
    return [
        Notice(
            "wet-in-air",
            f"{said}{over.size} bodies with volume and 'height: 0' are above still water with all of their buoyancy, "
            f"'{name}' the highest: tensions are not those of floats at the surface",
            float(position[node, 2]), 0.0, "error", "leave 'height' out, or give the height of the body",
        )
    ]  # fmt: skip


def _counted_periods(plan: RunPlan) -> list[Notice]:
    """Say when waves have not stood at their height for a whole period of what counts."""
    ramp = max(plan.flow.ramp, plan.flow.wave_ramp)
    left = plan.duration - max(ramp, plan.skip)
    if plan.waves is None or not math.isfinite(plan.period) or left >= plan.period * (1.0 - 1e-9):
        return []
    return [
        Notice(
            "waves-not-counted",
            f"{plan.name}: of {plan.duration:g} s, with waves that grow for {ramp:g} s and {plan.skip:g} s skipped, "
            f"{max(left, 0.0):g} s count at their height, less than one period",
            max(left, 0.0), plan.period, "error", "a longer duration, or a shorter ramp and skip",
        )
    ]  # fmt: skip


def run_notices(
    problem: NetworkProblem, history: History, plan: RunPlan, snaps: Mapping[str, SnapRecord]
) -> list[Notice]:
    notices = []
    rise = min((contact.rise_time for record in snaps.values() for contact in record.snaps), default=math.inf)
    if rise < 3.0 * plan.output_step:
        notices.append(
            Notice("rows-too-far-apart", "slack, contacts and rise times are found at the rows, too far apart for "
                   "the shortest rise; peaks are taken at every step", plan.output_step, rise / 3.0, "warning",
                   "shorten the output step")
        )  # fmt: skip
    if history.nodes.size < len(history.network.nodes):
        notices.append(
            Notice(
                "nodes-left-out",
                f"{history.nodes.size} of {len(history.network.nodes)} nodes were kept; the view draws those",
                severity="information",
                remedy="a shorter run or a longer output step keeps all",
            )
        )
    notices += _counted_periods(plan)
    if plan.skip >= plan.duration:
        notices.append(
            Notice("nothing-counted", f"a skip of {plan.skip:g} s leaves nothing of the run",
                   plan.skip, plan.duration, "warning", "skip less")
        )  # fmt: skip
    for sheet in problem.sheets:
        if "added_mass_per_area" not in sheet.properties:
            notices.append(
                Notice(
                    "sheet-without-water",
                    f"the sheet {sheet.name!r} takes no water along: wet cloth moves across itself "
                    "as quickly as it does in air",
                    severity="warning",
                    remedy=f"give the sheet {sheet.name!r} an added mass (0 where it stays dry)",
                )
            )
    return [*notices, *_turned_cloth(history)]


def _turned_cloth(history: History) -> list[Notice]:
    """Say when sheets turned far from how they were built: the water that they take along did not turn with them.

    Normals are means around the nodes, so that folds of the mesh do not count.
    """
    sheets, count = history.network.sheets, len(history.network.nodes)
    if sheets is None or not np.any(sheets.added_mass_per_area) or history.nodes.size < count:
        return []
    weight, triangles = sheets.area * np.asarray(sheets.added_mass_per_area), sheets.triangles

    def across(place: np.ndarray) -> np.ndarray:
        sides = (place[triangles[:, k]] - place[triangles[:, 0]] for k in (1, 2))
        faces, around = np.cross(*sides), np.zeros((count, 3))
        for corner in range(3):
            np.add.at(around, triangles[:, corner], faces)
        smooth = around[triangles].sum(axis=1)
        values: NDArray[Any] = smooth / np.maximum(np.linalg.norm(smooth, axis=1), 1e-300)[:, None]
        return values

    built = across(history.network.nodes.position)
    rows = history.position[:: max(1, len(history.position) // 50)]
    share = float(np.mean([np.average(np.sum(across(x) * built, axis=1) ** 2, weights=weight) for x in rows]))
    if share >= ACROSS:
        return []
    return [
        Notice(
            "sheet-turned",
            "sheets lie far from how they were built: the water that they take along acts across them as built, "
            f"only {100.0 * share:.2g} % of it across them as they lie",
            share,
            ACROSS,
            "warning",
            "build the sheets near the shape in which they work, or leave out their added mass and compare",
        )
    ]


def peak_inside(assembly: Assembly, series: xr.Dataset, name: str, bar: int) -> list[Notice]:
    """Say when the highest tension stands inside a line whose ends carry much less."""
    if name not in assembly.lines or bar < 0:
        return []
    time = series["time"].values
    own = series.sel(line=name).isel(time=time >= time[0] + series.attrs["skip"])
    peak = float(np.nanmax(own["line_tension_peak_since_row"]))
    ends = [float(np.nanmax(own[key])) for key in ("start_highest", "end_highest")]
    if not peak > INSIDE * max(ends):
        return []
    strand = assembly.lines[name]
    lengths = assembly.network.bars.length[strand.bars]
    row = int(np.flatnonzero(strand.bars == bar)[0])
    place = float(np.sum(lengths[:row]) + 0.5 * lengths[row])
    return [
        Notice(
            "peak-inside", f"the highest tension of '{name}' is {place:.4g} m from its start, where a slack part "
            f"is pulled straight or falls on the bed: {spoken(peak, 'N')} there, "
            f"{spoken(ends[0], 'N', like=peak)} at its start and {spoken(ends[1], 'N', like=peak)} at its end",
            peak, INSIDE * max(ends), "warning",
            "take the tension at the ends for anchors and fairleads; so short an impact depends on the internal "
            "damping: do a sensitivity run",
        )
    ]  # fmt: skip


def realised_low(series: xr.Dataset) -> list[Notice]:
    """Say when the record of an irregular sea is clearly lower than what was asked, over the part that counts."""
    if "surface_elevation" not in series or not int(series.attrs.get("irregular", 0)):
        return []
    time = series["time"].values
    counted = series["surface_elevation"].values[time >= time[0] + series.attrs["skip"]]
    if counted.size < 2:
        return []
    # the run puts its name before it
    return [
        replace(one, message=one.message.removeprefix(": "))
        for one in check_realised_height("", 4.0 * float(counted.std()), float(series.attrs["wave_height"]))
    ]


def capsized(series: xr.Dataset) -> list[Notice]:
    """Say when a body turns over."""
    found = []
    for name, lean in zip(series["solid"].values, lean_of(series["solid_angle"].values).max(axis=0), strict=True):
        if lean > OVER:
            found.append(overturned(str(name), float(lean), "leans"))
    return found


def overturned(name: str, lean: float, does: str) -> Notice:
    """Return the notice of a body that lies on its side or beyond."""
    return Notice(
        "body-turned-over", f"body '{name}' {does} {math.degrees(lean):.0f} degrees from upright", lean, OVER,
        "warning", "check its centre of gravity, its mass, and where its lines pull", unit="rad",
    )  # fmt: skip
