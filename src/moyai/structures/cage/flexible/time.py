"""A flexible cage in waves and current through time."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.progress import Progress, silent
from moyai.flexible.flow import Flow
from moyai.flexible.result import History
from moyai.flexible.simulation import Enough, simulate
from moyai.series.block_maxima import LEAST_BLOCKS, PERIODS
from moyai.series.snaps import find_snaps
from moyai.structures.cage.flexible.equilibrium import CageEquilibrium, collar_forces, ring_shape
from moyai.structures.cage.flexible.loads import PARTS, drag_split
from moyai.structures.cage.flexible.model import FlexibleCage
from moyai.structures.cage.flexible.problem import FlexibleSettings
from moyai.structures.cage.flexible.variables import described
from moyai.structures.cage.rigid.waves import RigidCageWave
from moyai.structures.cage.settling import (
    BLOCKS,
    ENOUGH,
    LAW_BLOCK,
    by_period,
    change_per_period,
    is_settled,
    may_reach,
    scatters,
    still_to_come,
)

if TYPE_CHECKING:
    import xarray as xr


#: Rows at which the split of the drag is given and pictures kept in a wave period, at least; rows of the drag in all.
_ROWS_PER_PERIOD, _DRAG_ROWS = 12, 200


@dataclass(frozen=True, eq=False)
class CageRun:
    """A run through time."""

    wave: RigidCageWave
    #: Where it started.
    rest: CageEquilibrium
    flow: Flow
    #: Until which the waves grew [s].
    ramp: float
    history: History


def run_cage(
    model: FlexibleCage,
    rest: CageEquilibrium,
    wave: RigidCageWave,
    settings: FlexibleSettings,
    *,
    step: float | None = None,
    enough: Enough | None = None,
    progress: Progress = silent,
) -> CageRun:
    """Run a cage from its rest in the current through waves that grow.

    Parameters
    ----------
    model : FlexibleCage
    rest : CageRest
    wave : Wave
    settings : FlexibleSettings
    step : float, optional
        Time step, at most [s].
    enough : callable, optional
        Ends regular waves, which go on as long as the settings allow; :class:`Settling`: until their periods repeat.
    progress : Progress
    """
    ramp = settings.ramp_periods * wave.period
    if not wave.regular:
        enough = None
    if enough is not None:
        wave = replace(wave, duration=max(wave.duration, settings.most_periods * wave.period))
    flow = Flow(
        current=rest.current, waves=wave.components, stretching=settings.stretching, wave_ramp=ramp, steep=wave.steep
    )
    history = simulate(
        rest.network,
        duration=ramp + wave.duration,
        output_step=wave.period / settings.rows_per_period,
        flow=flow,
        start=rest.state,
        step=step,
        counted_from=ramp,
        enough=enough,
        progress=progress,
    )
    if enough is not None:
        wave = replace(wave, duration=float(history.time[-1]) - ramp)
    return CageRun(wave, rest, flow, ramp, history)


def go_on(rest: CageEquilibrium, before: CageRun, settings: FlexibleSettings, progress: Progress = silent) -> CageRun:
    """Run the wave of another run with a cage that differs a little, of the same mesh, under another law for instance.

    Regular waves go on from the end of that run for six periods, a sea begins again.

    Parameters
    ----------
    rest : CageRest
        Of the other cage.
    before : CageRun
    settings : FlexibleSettings
    progress : Progress
    """
    wave, period = before.wave, before.wave.period
    if not wave.regular:
        flow, start = replace(before.flow, current=rest.current), rest.state
        duration = before.ramp + wave.duration
    else:
        flow, start = replace(before.flow, current=rest.current), before.history.final
        duration = LAW_BLOCK * BLOCKS * period
    history = simulate(
        rest.network, duration=duration, output_step=period / settings.rows_per_period, flow=flow, start=start,
        progress=progress,
    )  # fmt: skip
    return CageRun(wave, rest, flow, before.ramp, history)


class Settling:
    """Whether no number of the first page will rise any more in a run through regular waves."""

    def __init__(self, rest: CageEquilibrium, wave: RigidCageWave, settings: FlexibleSettings) -> None:
        built, ramp = rest.built, settings.ramp_periods * wave.period
        self._built, self._ramp = built, ramp
        self._period, self._least = wave.period, ramp + wave.duration
        self._strands = [rest.network.strands[part.strand].bars for part in built.lines]
        self._broken = np.array([part.breaking_load for part in built.lines])
        self._anchors = np.array([part.kind == "anchor" for part in built.lines], dtype=bool)
        self._calm = built.network.nodes.position
        self._highest: list[Array] = []

    def __call__(self, time: Array, position: Array, peak: Array) -> bool:
        done = int((float(time[-1]) - self._ramp) / self._period + 1e-6)
        if done <= len(self._highest):
            return False
        for number in range(len(self._highest), done):
            begin = self._ramp + number * self._period
            rows = (time > begin - 1e-9) & (time < begin + self._period - 1e-9)
            self._highest.append(self._numbers(position[rows], peak[rows]))
        return bool(time[-1] >= self._least - 1e-9) and self._repeats()

    def _numbers(self, position: Array, peak: Array) -> Array:
        """Return the largest of one period: volume lost, offset, tension of the net, of each line."""
        cages = self._built.cages
        least = min(float((cage.volume(position) / cage.rest_volume).min()) for cage in cages)
        moved = max(
            float(np.linalg.norm((position[:, own] - self._calm[own]).mean(axis=1)[:, :2], axis=1).max())
            for own in (cage.collar[0] for cage in cages)
        )
        net = float(self._built.net_tension(peak).max())
        return np.array([-least, moved, net, *(float(peak[:, own].max()) for own in self._strands)])

    def _repeats(self) -> bool:
        """Return whether volume, offset, net, anchors and lines have settled, lines against the most loaded one."""
        table = np.array(self._highest)
        columns = [table[:, 0], table[:, 1], table[:, 2]]
        # an offset within a hundredth of the cage is that of a held collar
        size = float(np.ptp(self._calm[self._built.cages[0].collar[0], 0]))
        scales = [abs(table[-1, 0]), max(table[-1, 1], 0.01 * size), table[-1, 2]]
        lines = table[:, 3:]
        if lines.shape[1]:
            most = float((lines[-1] / self._broken).max()) * self._broken
            for line, scale in zip(lines.T, most, strict=True):
                # no length of run settles what never repeats: it counts where it may carry most
                if not scatters(line, scale) or may_reach(line, scale):
                    columns.append(line)
                    scales.append(scale)
            if self._anchors.any():
                columns.append(lines[:, self._anchors].max(axis=1))
                scales.append(float(columns[-1][-1]))
        left = [still_to_come(column) for column in columns]
        return all(
            more <= ENOUGH * scale and not scatters(column, scale)
            for more, scale, column in zip(left, scales, columns, strict=True)
        )


def unsettled(run: xr.Dataset) -> dict[str, float]:
    """Return what of a cage in regular waves still moves to the worse at the end of its run, by its change in a period.

    Parameters
    ----------
    run : xarray.Dataset
        As :func:`time_dataset` gives it.

    Returns
    -------
    dict of str to float
        By name: part of the number itself.
    """
    if not int(run.attrs["regular"]):
        return {}
    time, ramp, period = run["time"].values, float(run.attrs["ramp"]), float(run.attrs["period"])
    volume = run["volume_share"].values.min(axis=1)
    found = {"volume left": (-volume, float(volume[-1]), time)}
    drag = np.linalg.norm(run["drag"].values.sum(axis=1), axis=1)
    found["drag"] = (drag, float(drag.max()), run["drag_time"].values)
    if "utilisation" in run:
        line = int(np.argmax(run["utilisation"].values))
        tension = run["line_tension_peak_since_row"].values[:, line]
        found["tension of the governing line"] = (tension, float(tension.max()), time)
    out = {}
    for name, (series, scale, when) in found.items():
        values = by_period(when, series, period, ramp)
        # one that never repeats is a chance, if its record is long enough to show it
        known = scatters(values, scale) and values.size >= PERIODS * LEAST_BLOCKS
        if not is_settled(values, scale) and not known:
            out[name] = change_per_period(values) / max(scale, 1e-300)
    return out


def drag_rows(run: CageRun, rows: NDArray[np.int64]) -> Array:
    """Return the split of the drag at some rows, (rows, parts, 2) [N]."""
    history = run.history
    last = len(history.time) - 1
    out = np.empty((rows.size, len(PARTS), 2))
    for k, row in enumerate(rows):
        a, b = max(int(row) - 1, 0), min(int(row) + 1, last)
        velocity = (history.position[b] - history.position[a]) / max(history.time[b] - history.time[a], 1e-300)
        place = history.position[row]
        water = run.flow.at(float(history.time[row]), place.T)
        out[k] = drag_split(run.rest.built, run.rest.network, place, velocity, water)[:, :2]
    return out


def time_dataset(model: FlexibleCage, run: CageRun, settings: FlexibleSettings) -> xr.Dataset:
    """Return the run of a cage as a dataset."""
    import xarray as xr

    history, built = run.history, run.rest.built
    time = history.time
    steady = time >= run.ramp - 1e-9
    if steady.sum() < 4:
        steady = np.ones_like(steady)
    shapes = np.array(
        [
            [ring_shape(cage, place, built.network.nodes.position)[0] for cage in built.cages]
            for place in history.position
        ]
    )
    volume = np.stack([cage.volume(history.position) / cage.rest_volume for cage in built.cages], axis=1)
    stride = max(1, min(settings.rows_per_period // _ROWS_PER_PERIOD, int(steady.sum()) // _DRAG_ROWS))
    rows = np.arange(int(np.argmax(steady)), len(time), stride)
    drag = drag_rows(run, rows)
    lines = _line_series(run, settings, steady)
    governing = _governing_row(lines, volume, steady)
    kept = picture_rows(len(time), governing, settings.frames, settings.rows_per_period)
    middle = np.array([[0.0], [0.0], [0.0]])
    surface = np.array([float(run.flow.at(float(now), middle)[6, 0]) for now in time])
    size = np.linalg.norm(drag, axis=2)
    variables = {
        "volume_share": (("time", "cage"), volume),
        "volume_mean": ("cage", volume[steady].mean(axis=0)),
        "volume_minimum": ("cage", volume[steady].min(axis=0)),
        "collar_place": (("time", "cage", "axis"), shapes),
        "collar_range": (("cage", "axis"), np.ptp(shapes[steady], axis=0)),
        "net_tension_peak_since_row": (("time", "cage"), built.net_tension(history.tension_peak)),
        "wave_elevation": ("time", surface),
        "drag": (("drag_time", "part", "horizontal"), drag),
        "drag_mean": (("part", "horizontal"), drag.mean(axis=0)),
        "drag_largest": ("part", size.max(axis=0)),
        "position": (("frame", "node", "axis"), history.position[kept]),
        "tension": (("frame", "bar"), history.tension[kept]),
        **lines,
    }
    if built.cages[0].collar_bars and not model.design.collar.rigid:
        stress = np.array(
            [
                [max(ring["stress"].max() for ring in rings) for rings in collar_forces(model, run.rest, place, pull)]
                for place, pull in zip(history.position, history.tension, strict=True)
            ]
        )
        worst = int(np.argmax(np.where(steady, stress.max(axis=1), -1.0)))
        there = collar_forces(model, run.rest, history.position[worst], history.tension[worst])
        variables["collar_stress_largest"] = (("time", "cage"), stress)
        variables["collar_stress"] = (
            ("cage", "ring", "around"), np.array([[ring["stress"] for ring in rings] for rings in there])
        )  # fmt: skip
    return described(
        xr.Dataset(
            variables,
            coords={
                "time": ("time", time, {"units": "s", "long_name": "time"}),
                "drag_time": ("drag_time", time[rows], {"units": "s", "long_name": "time"}),
                "frame_time": ("frame", time[kept], {"units": "s", "long_name": "time"}),
                "part": list(PARTS), "axis": ["x", "y", "z"], "horizontal": ["x", "y"],
                "cage": [cage.name for cage in built.cages], "line": [part.name for part in built.lines],
                **({"anchor": built.anchor_names} if built.anchors.size else {}),
            },
            attrs={
                "wave": run.wave.name, "theory": run.wave.theory, "wave_height": run.wave.height,
                "period": run.wave.period,
                "wavelength": run.wave.wavelength, "ramp": run.ramp, "step": history.step, "steps": history.steps,
                "governing_time": float(time[governing]), "status": history.status, "regular": int(run.wave.regular),
                "realised_height": 4.0 * float(surface[steady].std()), **wave_attributes(run.wave),
                **({} if run.wave.seed is None else {"seed": run.wave.seed}),
            },
        )
    )  # fmt: skip


def picture_rows(rows: int, governing: int, count: int, rows_per_period: int) -> NDArray[np.int64]:
    """Return the rows of which pictures are kept: the whole run where that gives enough, else about the governing one.

    Parameters
    ----------
    rows : int
        Rows of the run.
    governing : int
        Row of the governing moment, always among the pictures.
    count : int
        Pictures at most.
    rows_per_period : int
        Rows in a wave period; a period gets at least twelve pictures, or every row.
    """
    stride = max(rows_per_period // _ROWS_PER_PERIOD, 1)
    behind = governing % stride + stride * np.arange((rows - 1 - governing % stride) // stride + 1)
    first = int(np.clip(governing // stride - count // 2, 0, max(behind.size - count, 0)))
    return behind[first : first + count].astype(np.int64)


def _governing_row(lines: dict[str, tuple[object, Array]], volume: Array, steady: NDArray[np.bool_]) -> int:
    """Return the row of the largest use of a line after the ramp; without lines, that of the least volume."""
    measure = volume.min(axis=1)
    if lines:
        line = int(np.argmax(lines["utilisation"][1]))
        measure = -lines["line_tension_peak_since_row"][1][:, line]
    return int(np.argmin(np.where(steady, measure, np.inf)))


def wave_attributes(wave: RigidCageWave) -> dict[str, Array]:
    """Return the components of a sea as attributes, so that a report can draw its surface."""
    parts = wave.components
    return {
        "component_omega": np.asarray(parts.omega), "component_amplitude": np.asarray(parts.amplitude),
        "component_phase": np.asarray(parts.phase), "component_heading": np.asarray(parts.heading),
        "component_wave_number": np.asarray(parts.wave_number),
    }  # fmt: skip


def _line_series(
    run: CageRun, settings: FlexibleSettings, steady: NDArray[np.bool_]
) -> dict[str, tuple[object, Array]]:
    """Return tensions of the lines over time, their extremes, and their snaps."""
    history, built = run.history, run.rest.built
    if not built.lines:
        return {}
    bars = [run.rest.network.strands[part.strand].bars for part in built.lines]
    upper = np.stack([history.tension[:, own[-1]] for own in bars], axis=1)
    lower = np.stack([history.tension[:, own[0]] for own in bars], axis=1)
    nodes = run.rest.network.bars
    first = [own[0] for own in bars]
    along = history.position[:, nodes.end[first]] - history.position[:, nodes.start[first]]
    # anchor lines run upwards from the anchor: what pulls it up is the upward part of the tension of their first bar
    uplift = np.maximum(along[..., 2] / np.maximum(np.linalg.norm(along, axis=2), 1e-300) * lower, 0.0)
    lower_peak = np.stack([history.tension_peak[:, own[0]] for own in bars], axis=1)
    peak = np.stack([history.tension_peak[:, own].max(axis=1) for own in bars], axis=1)
    mean = upper[steady].mean(axis=0)
    slack, count, highest = [], [], []
    for k in range(len(bars)):
        record = find_snaps(
            history.time[steady], np.maximum(upper[steady, k], 0.0),
            slack_level=settings.slack_share * max(mean[k], 0.0), threshold=settings.snap_factor * max(mean[k], 0.0),
            peaks=peak[steady, k],
        )  # fmt: skip
        slack.append(record.slack_time / max(float(np.ptp(history.time[steady])), 1e-300))
        count.append(len(record.snaps))
        highest.append(max((snap.peak for snap in record.snaps), default=0.0))
    broken = np.array([part.breaking_load for part in built.lines])
    anchors = [number for number, part in enumerate(built.lines) if part.kind == "anchor"]
    largest = peak[steady].max(axis=0)
    return {
        "line_tension": (("time", "line"), upper),
        "lower_end_tension": (("time", "line"), lower),
        "line_tension_peak_since_row": (("time", "line"), peak),
        "lower_end_tension_maximum": ("line", lower_peak[steady].max(axis=0)),
        "anchor_tension": (("time", "anchor"), lower[:, anchors]),
        "anchor_tension_maximum": ("anchor", lower_peak[steady][:, anchors].max(axis=0)),
        "anchor_vertical_tension_maximum": ("anchor", uplift[steady][:, anchors].max(axis=0)),
        "line_tension_mean": ("line", mean),
        "line_tension_minimum": ("line", upper[steady].min(axis=0)),
        "line_tension_maximum": ("line", largest),
        "utilisation": ("line", largest / broken),
        "slack_share": ("line", np.array(slack)),
        "snap_count": ("line", np.array(count)),
        "largest_snap": ("line", np.array(highest)),
    }
