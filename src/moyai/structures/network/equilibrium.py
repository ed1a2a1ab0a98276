"""A network at rest: shapes, tensions, loads on its points, stiffness at driven points, natural modes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.flexible.elements import DRIVEN, FREE
from moyai.flexible.flow import Flow
from moyai.flexible.modes import natural_modes
from moyai.flexible.network import Network
from moyai.flexible.refine import refined
from moyai.flexible.result import Equilibrium, History, State
from moyai.flexible.statics import solve_equilibrium
from moyai.structures.network.assembly import Assembly
from moyai.structures.network.noise import without_noise
from moyai.structures.network.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

    from moyai.coupled.equilibrium import CoupledEquilibrium

AXES = ["x", "y", "z"]
TURNS = ["roll", "pitch", "yaw"]
MEASURES = ["size", "horizontal", "upwards", "downwards"]


def named_points(assembly: Assembly) -> tuple[list[str], NDArray[np.int64]]:
    """Return the points of the case, without knots of nets and joints of lines, and their nodes."""
    network = assembly.network
    inner = {f"{name}[" for name in (*assembly.nets, *assembly.sheets)}
    joints = {f"{name} joint " for name in assembly.lines}
    names = [
        name
        for name in network.points
        if not any(name.startswith(start) for start in inner) and not any(name.startswith(start) for start in joints)
    ]
    return names, np.array([network.points[name] for name in names], dtype=np.int64)


def pulls(network: Network, nodes: NDArray[np.int64], position: Array, tension: Array) -> Array:
    """Return the pull of the bars on some nodes, shape (rows, nodes, 3) [N].

    Parameters
    ----------
    network : Network
    nodes : ndarray of int
    position : ndarray, shape (rows, n, 3)
        All nodes [m].
    tension : ndarray, shape (rows, m)
        All bars [N].
    """
    bars = network.bars
    out = np.zeros((position.shape[0], nodes.size, 3))
    for column, node in enumerate(nodes):
        for meets, away in ((bars.start, bars.end), (bars.end, bars.start)):
            own = np.flatnonzero(meets == node)
            if own.size == 0:
                continue
            reach = position[:, away[own]] - position[:, [node]]
            size = np.maximum(np.linalg.norm(reach, axis=2, keepdims=True), 1e-12)
            out[:, column] += np.sum(tension[:, own, None] * reach / size, axis=1)
    return out


def highest_pulls(network: Network, nodes: NDArray[np.int64], position: Array, tension: Array, highest: Array) -> Array:
    """Return what pulls most at some nodes since the row before, shape (rows, nodes, 4) [N].

    One bar after the other is given its highest tension since the row before, while the others pull as at the row:
    exact where one bar meets the node.

    Parameters
    ----------
    network, nodes, position, tension
        As in :func:`pulls`.
    highest : ndarray, shape (rows, m)
        Highest tension of every bar since the row before [N].

    Returns
    -------
    ndarray
        Size, horizontal, upward and downward part, each at its own highest.
    """
    bars = network.bars
    at_row = pulls(network, nodes, position, tension)
    out = _measures(at_row)
    for column, node in enumerate(nodes):
        for meets, away in ((bars.start, bars.end), (bars.end, bars.start)):
            for bar in np.flatnonzero(meets == node):
                reach = position[:, away[bar]] - position[:, node]
                unit = reach / np.maximum(np.linalg.norm(reach, axis=1, keepdims=True), 1e-12)
                more = np.maximum(highest[:, bar] - tension[:, bar], 0.0)
                out[:, column] = np.fmax(out[:, column], _measures(at_row[:, column] + more[:, None] * unit))
    return out


def highest_of_run(
    history: History, points: Mapping[str, int], after: float, before: float = math.inf
) -> dict[str, float]:
    """Return the highest pull [N] of a run on some nodes, by their names, between two times since its start [s].

    Nodes whose neighbours or bars were not kept are left out.
    """
    network, since = history.network, history.time - history.time[0]
    counted = (since >= after) & (since < before)
    place = np.full((int(counted.sum()), len(network.nodes), 3), np.nan)
    place[:, history.nodes] = history.position[counted]
    at_row, highest = (np.full((place.shape[0], len(network.bars)), np.nan) for _ in range(2))
    at_row[:, history.bars] = history.tension[counted]
    highest[:, history.bars] = np.fmax(history.tension, history.tension_peak)[counted]
    nodes = np.array(list(points.values()), dtype=np.int64)
    if not nodes.size or not counted.any():
        return {}
    found = highest_pulls(network, nodes, place, at_row, highest)[..., 0]
    whole = np.isfinite(found.sum(axis=0))
    return {name: float(found[:, k].max()) for k, name in enumerate(points) if whole[k]}


def around(network: Network, points: Mapping[str, int]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return the nodes and bars that a run has to keep for the pull on some nodes."""
    bars, nodes = network.bars, np.array(list(points.values()), dtype=np.int64)
    own = np.flatnonzero(np.isin(bars.start, nodes) | np.isin(bars.end, nodes))
    return np.unique(np.concatenate([nodes, bars.start[own], bars.end[own]])), own


def _measures(load: Array) -> Array:
    up = load[..., 2]
    return np.stack(
        [
            np.linalg.norm(load, axis=-1), np.linalg.norm(load[..., :2], axis=-1), np.maximum(up, 0.0),
            np.maximum(-up, 0.0),
        ],
        axis=-1,
    )  # fmt: skip


def line_numbers(assembly: Assembly, tension: Array) -> dict[str, Array]:
    """Return highest, lowest, first and last tension of every line, shape (rows, lines) [N]."""
    strands = list(assembly.lines.values())
    return (
        {
            "line_tension_maximum": np.stack([tension[:, s.bars].max(axis=1) for s in strands], axis=1),
            "line_tension_minimum": np.stack([tension[:, s.bars].min(axis=1) for s in strands], axis=1),
            "start_tension": np.stack([tension[:, s.bars[0]] for s in strands], axis=1),
            "end_tension": np.stack([tension[:, s.bars[-1]] for s in strands], axis=1),
        }
        if strands
        else {}
    )


def rest_dataset(assembly: Assembly, found: dict[str, Equilibrium], stiffness: Array | None) -> xr.Dataset:
    """Return the networks at rest of every condition (still water, current)."""
    import xarray as xr

    network = assembly.network
    position = np.stack([rest.state.position for rest in found.values()])
    tension = np.stack([rest.tension for rest in found.values()])
    names, nodes = named_points(assembly)
    load = pulls(network, nodes, position, tension)
    size = float(np.max(np.ptp(position, axis=1), initial=0.0))
    data: dict[str, object] = {
        "position": (("condition", "node", "axis"), position),
        "tension": (("condition", "bar"), tension),
        "residual": ("condition", np.array([rest.residual for rest in found.values()])),
        "point_position": (("condition", "point", "axis"), without_noise(position[:, nodes], size)),
        "point_load": (("condition", "point", "axis"), without_noise(load, float(np.max(np.abs(load), initial=0.0)))),
    }
    for key, values in line_numbers(assembly, tension).items():
        data[key] = (("condition", "line"), values)
    if assembly.parts:
        own = [tension[:, strand.bars].max(axis=1) for strand in assembly.parts.values()]
        data["part_tension_maximum"] = (("condition", "part"), np.stack(own, axis=1))
    if network.bed is not None and network.bed.ground is not None:
        data["bed_level"] = (("condition", "node"), network.bed.level_at(position))
    if stiffness is not None:
        data["stiffness"] = (("driven", "axis", "direction"), stiffness)
    coords: dict[str, object] = {"condition": list(found), "axis": AXES, "point": names, "line": list(assembly.lines)}
    if assembly.parts:
        coords["part"] = list(assembly.parts)
    if stiffness is not None:
        coords |= {"direction": AXES, "driven": driven_names(assembly)}
    return labelled(xr.Dataset(data, coords=coords))


def bodies_at_rest(dataset: xr.Dataset, found: dict[str, CoupledEquilibrium]) -> xr.Dataset:
    """Return the dataset with the places and angles of the bodies at rest."""
    if not found:
        return dataset
    names = list(next(iter(found.values())).bodies)
    place = np.array([[rest.bodies[name].position for name in names] for rest in found.values()])
    angle = np.array([[rest.bodies[name].rotation for name in names] for rest in found.values()])
    size = float(np.ptp(dataset["position"].values, axis=1).max())
    place, angle = without_noise(place, size), without_noise(angle, 1.0)
    return labelled(
        dataset.assign(
            {"solid_position": (("condition", "solid", "axis"), place),
             "solid_angle": (("condition", "solid", "turn"), angle)}
        ).assign_coords(solid=names, turn=TURNS)
    )  # fmt: skip


def driven_names(assembly: Assembly) -> list[str]:
    """Return the names of driven points, knots of nets left out."""
    names, nodes = named_points(assembly)
    return [name for name, node in zip(names, nodes, strict=True) if assembly.network.nodes.kind[node] == DRIVEN]


def stiffness_at_driven(assembly: Assembly, rest: Equilibrium, flow: Flow, step: float | None) -> Array | None:
    """Return the stiffness of every driven point by equilibria on both sides of its place, shape (points, 3, 3) [N/m].

    Parameters
    ----------
    assembly : Assembly
    rest : Equilibrium
        Where it is taken.
    flow : Flow
        The current of that equilibrium.
    step : float or None
        Displacement [m]; a thousandth of a hundredth of the size when left out, within 1 mm and 1 cm.

    Raises
    ------
    ConvergenceError
        When a displaced network finds no equilibrium.
    """
    network, names = assembly.network, driven_names(assembly)
    if not names:
        return None
    extent = float(np.max(np.ptp(network.nodes.position, axis=0)))
    shift = step or float(np.clip(1e-4 * extent, 1e-3, 1e-2))
    out = np.zeros((len(names), 3, 3))
    for row, name in enumerate(names):
        node = np.array([network.points[name]])
        for direction in range(3):
            held = []
            for sign in (1.0, -1.0):
                place = np.array(network.nodes.position)
                place[node[0], direction] += sign * shift
                # the deep bed under a point that stands on it is no fault of a virtual displacement
                moved = replace(network, nodes=replace(network.nodes, position=place))
                begin = State(0.0, np.array(rest.state.position), np.zeros_like(place))
                begin.position[node[0], direction] += sign * shift
                found = solve_equilibrium(moved, flow=flow, start=begin)
                held.append(-pulls(moved, node, found.state.position[None], found.tension[None])[0, 0])
            out[row, :, direction] = (held[0] - held[1]) / (2.0 * shift)
    return out


def _longest_of_finer_mesh(assembly: Assembly, rest: Equilibrium, flow: Flow) -> float:
    """Return the longest natural period on twice the bars [s]; NaN where that is not found or has no period."""
    nodes = assembly.network.nodes
    # points of bodies stay where the bodies rest, not where they were drawn
    place = np.where((nodes.kind == FREE)[:, None], nodes.position, rest.state.position)
    try:
        held = replace(assembly.network, nodes=replace(nodes, position=place))
        network, begin = refined(held, 2, rest.state)
        finer = solve_equilibrium(network, flow=flow, start=begin)
        omega = natural_modes(network, finer.state, count=1, flow=flow).omega
    except (ConvergenceError, InputError):
        return math.nan
    return 2.0 * math.pi / float(omega[0]) if omega.size and omega[0] > 0.0 else math.nan


def modes_dataset(assembly: Assembly, rest: Equilibrium, flow: Flow, count: int) -> xr.Dataset:
    """Return the lowest natural modes about a network at rest."""
    import xarray as xr

    modes = natural_modes(assembly.network, rest.state, count=count, flow=flow)
    with np.errstate(divide="ignore"):
        period = np.where(modes.omega > 0.0, 2.0 * np.pi / modes.omega, np.inf)
    return labelled(
        xr.Dataset(
            {
                "mode_frequency": ("mode", modes.omega),
                "mode_period": ("mode", period),
                "longest_period_double_mesh": ((), _longest_of_finer_mesh(assembly, rest, flow)),
                "mode_shape": (("mode", "node", "axis"), modes.shape),
            },
            coords={"mode": np.arange(1, modes.omega.size + 1), "axis": AXES},
        )
    )
