"""The unit in time on lines that are in motion: run, tensions at both ends, slack and snap, the accuracy of a peak."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.progress import Progress, silent
from moyai.core.validity import IdentityCheck, Notice
from moyai.coupled.bodies import BodyHistory
from moyai.coupled.planar import PlanarBody, PlanarCarrier
from moyai.coupled.simulate import CoupledHistory, simulate_coupled
from moyai.flexible.sea_table import sea_of_lines
from moyai.floating.damping import QuadraticDamping
from moyai.floating.forcing import Forcing
from moyai.floating.lines import PlanarMooring
from moyai.floating.time import CumminsModel, Simulation, choose_time_step
from moyai.series.snaps import SnapRecord, find_snaps
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.frequency.model import FrequencyModel
from moyai.structures.breakwater.lines.drag import line_drag_rows
from moyai.structures.breakwater.lines.network import LineNetwork, line_network, static_check
from moyai.structures.breakwater.model import MooringLine
from moyai.structures.breakwater.settings import LineDynamics
from moyai.structures.breakwater.viscous_damping import unit_drag_rows

if TYPE_CHECKING:
    import xarray as xr

    from moyai.flexible.flow import Current
    from moyai.sea.components import WaveComponents


#: Shapes of the lines are kept over this many periods around the governing peak, so many a period.
KEPT_PERIODS, SHAPES_PER_PERIOD = 12.0, 40


@dataclass(frozen=True, eq=False)
class LinesInMotion:
    """What lines in motion add to a simulation; columns follow the lines of the unit, NaN for lines at rest."""

    #: Highest tension at the fairlead since the row before, taken at every step of the network [N]; shape (n, lines).
    peak: Array
    #: Tension of the bar at the anchor [N]; shape (n, lines).
    anchor: Array
    #: Its vertical component, upward on the anchor [N]; shape (n, lines).
    uplift: Array
    #: Length whose nodes touch the bed [m]; shape (n, lines).
    grounded: Array
    #: Slack intervals, contacts and snaps of each line in motion.
    snaps: dict[str, SnapRecord]
    #: Nodes of all lines in motion around the governing peak [m]; shape (k, nodes, 3).
    position: Array
    #: [s]; shape (k,).
    shape_time: Array
    #: Nodes of each line from anchor to fairlead.
    nodes: dict[str, NDArray[np.int64]]
    #: Change of the largest tension over it, by variation; shape (lines,).
    sensitivity: dict[str, Array]
    #: Step of the network [s].
    network_step: float
    #: Step of the body [s].
    body_step: float
    #: Runs of the network per step of the body.
    passes: float
    nodes_in_all: int
    checks: tuple[IdentityCheck, ...] = ()
    notices: tuple[Notice, ...] = ()

    def variables(self, unit: FloatingUnit, every: int) -> dict[str, Any]:
        """Return what goes into the time series of the run."""
        out: dict[str, Any] = {
            "line_tension_peak_since_row": (("time", "line"), _thinned_peaks(self.peak, every)),
            "anchor_tension": (("time", "line"), self.anchor[::every]),
            "anchor_vertical_tension": (("time", "line"), self.uplift[::every]),
            "grounded_length_history": (("time", "line"), self.grounded[::every]),
        }
        names = [line.name for line in unit.lines]
        longest = max(nodes.size for nodes in self.nodes.values())
        shapes = np.full((2, self.shape_time.size, len(names), longest), np.nan)
        for name, nodes in self.nodes.items():
            column = names.index(name)
            shapes[0, :, column, : nodes.size] = self.position[:, nodes, 0]
            shapes[1, :, column, : nodes.size] = self.position[:, nodes, 2]
        out["moving_line_x"] = (("shape_time", "line", "line_node"), shapes[0])
        out["moving_line_z"] = (("shape_time", "line", "line_node"), shapes[1])
        return out

    def statistics(self, unit: FloatingUnit, begin: float) -> dict[str, Array]:
        """Return slack and snap of every line from ``begin`` [s] on."""
        names = [line.name for line in unit.lines]
        out = {
            name: np.full(len(names), np.nan)
            for name in (
                "slack_time",
                "longest_slack",
                "contact_count",
                "snap_count",
                "largest_snap",
                "shortest_rise_time",
            )
        }
        for name, record in self.snaps.items():
            column = names.index(name)
            slack = record.slack[record.slack[:, 1] > begin] if record.slack.size else np.zeros((0, 2))
            length = slack[:, 1] - np.maximum(slack[:, 0], begin)
            contacts = [contact for contact in record.contacts if contact.time >= begin]
            snaps = [contact for contact in contacts if contact.is_snap]
            out["slack_time"][column] = float(length.sum())
            out["longest_slack"][column] = float(length.max(initial=0.0))
            out["contact_count"][column], out["snap_count"][column] = len(contacts), len(snaps)
            if snaps:
                out["largest_snap"][column] = max(contact.peak for contact in snaps)
                out["shortest_rise_time"][column] = min(contact.rise_time for contact in snaps)
        return out

    def snap_table(self, unit: FloatingUnit) -> xr.Dataset:
        """Return every contact of every line as a table."""
        import xarray as xr

        names = [line.name for line in unit.lines]
        rows = [
            (names.index(name), contact.time, contact.slack_before, contact.peak, contact.peak_time, contact.rise_time,
             float(contact.is_snap))
            for name, record in self.snaps.items()
            for contact in record.contacts
        ]  # fmt: skip
        table = np.array(rows).reshape(-1, 7)
        keys = ("line_number", "contact_time", "slack_before", "contact_peak", "peak_time", "rise_time", "is_snap")
        return xr.Dataset({key: ("contact", table[:, column]) for column, key in enumerate(keys)})


@dataclass(frozen=True, eq=False)
class BodyStart:
    """Motion of the unit that a run starts from."""

    #: Position relative to rest; shape (3,).
    position: Array
    #: Velocity; shape (3,).
    velocity: Array
    #: States of the memory of the water; shape (poles,).
    memory: NDArray[np.complex128]


def _thinned_peaks(peak: Array, every: int) -> Array:
    """Return the highest values since the kept row before."""
    if every == 1:
        return peak
    rows = np.arange(0, len(peak), every)
    return np.stack([peak[max(0, row - every + 1) : row + 1].max(axis=0) for row in rows])


def has_dynamic_lines(unit: FloatingUnit) -> bool:
    """Whether any line of the unit is in motion in time."""
    return any(isinstance(line, MooringLine) and line.dynamic for line in unit.breakwater.lines)


def run_on_lines(
    model: FrequencyModel,
    cummins: CumminsModel,
    forcing: Forcing,
    expected: Array,
    dynamics: LineDynamics,
    *,
    static_lines: PlanarMooring | None,
    waves: WaveComponents | None,
    current: Current | None,
    ramp: float,
    duration: float,
    time_step: float | None,
    begin: float,
    period: float,
    progress: Progress = silent,
    start: BodyStart | None = None,
    lines: LineNetwork | None = None,
) -> tuple[Simulation, LinesInMotion]:
    """Simulate the unit on lines in motion.

    Parameters
    ----------
    model : FrequencyModel
    cummins : CumminsModel
        Without lines.
    forcing : Forcing
    expected : ndarray (3,)
        Motions for the choice of the step.
    dynamics : LineDynamics
    static_lines : PlanarMooring or None
        Lines of the unit that stay at rest at every instant, springs among them.
    waves, current, ramp
        Water around the lines.
    duration : float
        [s].
    time_step : float or None
    begin : float
        Where statistics begin [s].
    period : float
        Of the waves [s].
    progress : Progress
    start : BodyStart or None
        Motion to start from, the lines at rest in its place; all at rest when left out.
    lines : LineNetwork, optional
        What :func:`moyai.structures.breakwater.lines.network.line_network` gives; built when left out.
    """
    unit = model.unit
    lines = line_network(unit, dynamics) if lines is None else lines
    assert lines is not None
    body = replace(cummins, mooring=static_lines, quadratic=without_line_drag(model, cummins))
    step = time_step
    notices: list[Notice] = []
    if step is None:
        # the exact lines tell the stiffness for which the step is chosen
        whole = replace(cummins, mooring=_all_lines(unit))
        step, notice = choose_time_step(whole, forcing, expected)
        # half of it: the sea around the lines is joined linearly between steps, and snaps are short
        step *= 0.5
        reported = f"time step {step:.4g} s on lines in motion, half of that on lines at rest"
        notices.append(replace(notice, value=step, message=reported))
    step = forcing.fitted_step(step)
    rows = math.ceil(duration / step - 1e-9)
    history, carrier = _run(unit, lines, body, forcing, waves, current, ramp, step, rows, None, progress, start)
    simulation = _simulation(unit, lines, history, carrier, static_lines, tuple(notices))
    found = _lines_in_motion(unit, lines, history, simulation, dynamics, begin, period)
    if dynamics.sensitivity and simulation.status == "converged":
        found = replace(
            found,
            sensitivity=_sensitivity(
                model,
                body,
                forcing,
                dynamics,
                waves,
                current,
                ramp,
                step,
                rows,
                history,
                found,
                begin,
                progress,
                start,
            ),
        )
    return simulation, found


def _all_lines(unit: FloatingUnit) -> PlanarMooring:
    return PlanarMooring.of(unit.mooring.planar.system, rest=(0.0, 0.0, 0.0), centre=(0.0, 0.0))


def without_line_drag(model: FrequencyModel, cummins: CumminsModel) -> QuadraticDamping | None:
    """Return the quadratic damping without that of lines in motion, which bring their own drag."""
    if cummins.quadratic is None:
        return None
    rows, coefficients = line_drag_rows(model.unit, of_moving=False)
    own_rows, own_coefficients = unit_drag_rows(model.unit)
    coefficients = np.append(coefficients, own_coefficients)
    return QuadraticDamping(np.vstack([rows, own_rows]), coefficients) if len(coefficients) else None


def _run(
    unit: FloatingUnit,
    lines: LineNetwork,
    model: CumminsModel,
    forcing: Forcing,
    waves: WaveComponents | None,
    current: Current | None,
    ramp: float,
    step: float,
    rows: int,
    network_step: float | None,
    progress: Progress,
    start: BodyStart | None = None,
) -> tuple[CoupledHistory, PlanarCarrier]:
    names, copies = lines.names, {line.name: line.count for line in lines.lines}
    points = {line.name: np.asarray(line.fairlead, dtype=float) for line in lines.lines}
    rest = np.zeros(3)
    for line, pull in zip(lines.lines, lines.pulls, strict=True):
        x, _, z = line.fairlead
        rest += line.count * np.array([pull[0], pull[2], z * pull[0] - x * pull[2]])
    planar = PlanarBody(
        unit.name, model, forcing, duration=(rows + 2) * step, points=points, copies=copies,
        centre_at_rest=(unit.centre[0], 0.0, unit.centre[1]), reaction_at_rest=rest,
    )  # fmt: skip
    state = lines.rest.state
    if start is not None:
        planar = replace(
            planar, initial_position=start.position, initial_velocity=start.velocity, initial_memory=start.memory
        )
        state = lines.carried_along(planar.points_at_start)
    carrier = planar.carrier(unit.water)
    flow = sea_of_lines(waves, current, ramp, lines.rest.state.position, (rows + 1) * step, step)
    history = simulate_coupled(
        lines.network, {unit.name: planar}, duration=rows * step, output_step=step, flow=flow, start=state,
        body_step=step, step=network_step, carriers={unit.name: carrier}, progress=progress,
    )  # fmt: skip
    assert set(names) == set(planar.points)
    return history, carrier


def _simulation(
    unit: FloatingUnit,
    lines: LineNetwork,
    history: CoupledHistory,
    carrier: PlanarCarrier,
    static_lines: PlanarMooring | None,
    notices: tuple[Notice, ...],
) -> Simulation:
    """Return the run as those of lines at rest are returned."""
    body: BodyHistory = history.bodies[unit.name]
    count = history.time.size
    rest = np.array([unit.centre[0], unit.centre[1]])
    angle = np.unwrap(np.arctan2(body.rotation[:, 0, 2], body.rotation[:, 0, 0]))
    position = np.column_stack([body.position[:, [0, 2]] - rest, angle])
    velocity = body.velocity[:, [0, 2, 4]]
    pull = body.point_force_at_rows * carrier.copies[:, None]
    arms = np.einsum("kij,pj->kpi", body.rotation, carrier.arms)
    force = np.column_stack(
        [pull[..., 0].sum(axis=1), pull[..., 2].sum(axis=1), np.cross(arms, pull)[..., 1].sum(axis=1)]
    )
    tension = np.full((count, len(unit.lines)), np.nan)
    if static_lines is not None:
        steady, found = static_lines.force_and_tension(position)
        force += steady
        for column, name in enumerate(static_lines.names):
            tension[:, [line.name for line in unit.lines].index(name)] = found[:, column]
    for number, name in zip(lines.index, lines.names, strict=True):
        record = history.network
        tension[:, number] = lines.end_tensions(name, record.position[:count], record.tension[:count])[0]
    status = {"converged": "converged", "not_converged": "diverged", "interrupted": "interrupted"}[history.status]
    return Simulation(
        history.time, position, velocity, force, tension, carrier.elevation(history.time), history.body_step,
        status, history.message, (*notices, *history.notices),  # type: ignore[arg-type]
    )  # fmt: skip


def _lines_in_motion(
    unit: FloatingUnit,
    lines: LineNetwork,
    history: CoupledHistory,
    simulation: Simulation,
    dynamics: LineDynamics,
    begin: float,
    period: float,
) -> LinesInMotion:
    network, count, kinds = history.network, history.time.size, len(unit.lines)
    peak, anchor = simulation.tension.copy(), np.full((count, kinds), np.nan)
    uplift, grounded = np.full((count, kinds), np.nan), np.full((count, kinds), np.nan)
    snaps, rest = {}, lines.tension_at_rest()
    bed = -math.inf if lines.network.bed is None else lines.network.bed.level
    lengths = lines.network.bars.length
    for column, name, at_rest in zip(lines.index, lines.names, rest, strict=True):
        strand = lines.strand(name)
        # a chain in motion may carry more at its anchor than at the fairlead
        ends = lines.end_tensions(name, network.position[:count], network.tension_peak[:count])
        peak[:, column] = np.maximum(np.maximum(ends[0], ends[1]), simulation.tension[:, column])
        anchor[:, column] = lines.end_tensions(name, network.position[:count], network.tension[:count])[1]
        along = network.position[:count, strand.nodes[1]] - network.position[:count, strand.nodes[0]]
        uplift[:, column] = anchor[:, column] * along[:, 2] / np.maximum(np.linalg.norm(along, axis=1), 1e-300)
        weight = np.zeros(strand.nodes.size)
        weight[:-1] += 0.5 * lengths[strand.bars]
        weight[1:] += 0.5 * lengths[strand.bars]
        touching = network.position[:count, strand.nodes, 2] <= bed + 1e-6 * max(abs(bed), 1.0)
        touching[:, 0] = touching[:, 1]  # the node at the anchor touches always: it counts with the line next to it
        grounded[:, column] = touching @ weight
        if count > 1:
            snaps[name] = find_snaps(
                history.time, simulation.tension[:, column], slack_level=dynamics.slack_fraction * float(at_rest),
                threshold=dynamics.snap_fraction * float(at_rest), peaks=peak[:, column],
            )  # fmt: skip
    keep = _window(history.time, peak[:, list(lines.index)], begin, period)
    checks = (static_check(unit, lines), *(replace(c, name=f"{unit.name}: {c.name}") for c in history.checks))
    return LinesInMotion(
        peak, anchor, uplift, grounded, snaps, network.position[keep], history.time[keep],
        {name: np.asarray(lines.strand(name).nodes) for name in lines.names}, {}, history.network_step,
        history.body_step, history.passes, len(lines.network.nodes), checks, (),
    )  # fmt: skip


def _window(time: Array, peak: Array, begin: float, period: float) -> NDArray[np.int64]:
    """Return the rows around the governing peak whose shapes are kept."""
    after = np.flatnonzero(time >= begin)
    after = after if after.size else np.arange(time.size)
    at = time[after[int(np.argmax(np.max(peak[after], axis=1)))]]
    rows = np.flatnonzero(np.abs(time - at) <= 0.5 * KEPT_PERIODS * period)
    step = float(time[1] - time[0]) if time.size > 1 else period
    every = max(1, round(period / SHAPES_PER_PERIOD / step))
    return np.asarray(rows[::every], dtype=np.int64)


def _sensitivity(
    model: FrequencyModel,
    body: CumminsModel,
    forcing: Forcing,
    dynamics: LineDynamics,
    waves: WaveComponents | None,
    current: Current | None,
    ramp: float,
    step: float,
    rows: int,
    history: CoupledHistory,
    found: LinesInMotion,
    begin: float,
    progress: Progress,
    start: BodyStart | None = None,
) -> dict[str, Array]:
    """Repeat the run with twice the bars, half the step and twice the internal damping; return what the peak does."""
    unit = model.unit
    after = history.time >= begin
    variations = {
        "twice the bars": (dynamics.changed(bars=2 * dynamics.bars), None),
        "half the step": (dynamics, 0.5 * history.network_step),
        "twice the internal damping": (dynamics.changed(damping_ratio=2.0 * dynamics.damping_ratio), None),
    }
    out = {}
    for name, (changed, network_step) in variations.items():
        lines = line_network(unit, changed)
        assert lines is not None
        # the internal damping is one of the material: more bars keep it
        if changed.bars != dynamics.bars:
            lines = line_network(unit, changed.changed(damping_ratio=2.0 * dynamics.damping_ratio))
            assert lines is not None
        other, _ = _run(unit, lines, body, forcing, waves, current, ramp, step, rows, network_step, progress, start)
        change = np.full(len(unit.lines), np.nan)
        for column, line in zip(lines.index, lines.names, strict=True):
            record, size = other.network, other.time.size
            series = lines.end_tensions(line, record.position[:size], record.tension_peak[:size])[0]
            largest = float(np.max(found.peak[after, column]))
            if other.status == "converged" and largest > 0.0:
                change[column] = float(np.max(series[after[: series.size]])) / largest - 1.0
        out[name] = change
    return out
