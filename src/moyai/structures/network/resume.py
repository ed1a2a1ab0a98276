"""Go on with runs that were interrupted, from the last state that their results keep."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.errors import InputError
from moyai.core.results import Result, read_result
from moyai.coupled.bodies import BodyState
from moyai.flexible.result import History, State

if TYPE_CHECKING:
    import xarray as xr


#: Sizes of the network that a node may be away from where it was built, in a state that should be kept.
FAR = 20.0


@dataclass(frozen=True, eq=False)
class Earlier:
    """What an earlier result holds of a run."""

    #: Its last good state.
    state: State
    #: Series of the earlier run.
    series: xr.Dataset
    #: Frames of the earlier run.
    frames: xr.Dataset
    #: Where its bodies were then.
    bodies: Mapping[str, BodyState] = field(default_factory=dict)


def last_good_state(history: History) -> State:
    """Return the state at the end of a run, or, where that is no longer finite, the last row that is.

    Rows hold places only; velocities are then the difference of the last two good rows.
    """
    final, built = history.final, history.network.nodes.position
    # what has flown far away is no state to go on from, finite or not
    reach = FAR * max(float(np.max(np.ptp(built, axis=0))), 1e-9)
    if np.isfinite(final.velocity).all() and float(np.max(np.abs(final.position - built))) <= reach:
        return final
    count = len(history.network.nodes)
    away = np.abs(history.position - built[history.nodes]).max(axis=(1, 2))
    good = np.flatnonzero(away <= reach)
    if history.nodes.size != count or good.size == 0:
        return State.at_rest(history.network, float(history.time[0]))
    last = int(good[-1])
    velocity = np.zeros((count, 3))
    if last > 0:
        velocity = (history.position[last] - history.position[last - 1]) / (history.time[last] - history.time[last - 1])
    return State(float(history.time[last]), np.array(history.position[last]), np.asarray(velocity))


def read_earlier(path: Path) -> Result:
    """Return an earlier result of a network.

    Raises
    ------
    InputError
        When the file is absent or holds no network.
    """
    try:
        result = read_result(path)
    except InputError as error:
        raise InputError(
            error.fault.message, parameter="settings.resume", remedy="name results.nc of an earlier run"
        ) from None
    if result.tree.attrs.get("structure") != "network":
        raise InputError(f"{path} holds no network", parameter="settings.resume", allowed="results.nc of a network")
    return result


def earlier_run(result: Result, level: str, run: str, nodes: int) -> Earlier | None:
    """Return what an earlier result holds of a run, ``None`` where it was not begun.

    Raises
    ------
    InputError
        When it belongs to another network.
    """
    path = f"/{level}/time/{run}"
    if path not in result.tree.groups or f"{path}/frames" not in result.tree.groups:
        return None
    tree: Any = result.tree
    series, frames = tree[path].to_dataset(inherit=False), tree[f"{path}/frames"].to_dataset(inherit=False)
    if "point_load_peak_since_row" not in series:
        raise InputError(
            f"the run '{run}' of the earlier result lacks what runs hold today", parameter="settings.resume",
            remedy="run it from its start",
        )  # fmt: skip
    position, velocity = frames["final_position"].values, frames["final_velocity"].values
    if position.shape != (nodes, 3):
        raise InputError(
            f"the run '{run}' of the earlier result has {position.shape[0]} nodes, this network {nodes}",
            parameter="settings.resume",
            allowed="a result of the same network",
        )
    if not (np.isfinite(position).all() and np.isfinite(velocity).all()):
        raise InputError(
            f"the last state of the run '{run}' is not finite",
            parameter="settings.resume",
            remedy="run it from its start",
        )
    bodies = bodies_of(frames)
    if not all(np.isfinite(left.motion).all() and np.isfinite(left.memory).all() for left in bodies.values()):
        raise InputError(
            f"the last state of the bodies of the run '{run}' is not finite", parameter="settings.resume",
            remedy="run it from its start",
        )  # fmt: skip
    return Earlier(State(float(frames.attrs["final_time"]), position, velocity), series, frames, bodies)


def with_ends(frames: xr.Dataset, ends: Mapping[str, BodyState]) -> xr.Dataset:
    """Return frames that keep where the bodies were at the end; states of radiation side by side, the rest 0."""
    names, most = list(ends), max((left.memory.size for left in ends.values()), default=0)
    memory = np.zeros((len(names), most, 2))
    for row, left in enumerate(ends.values()):
        memory[row, : left.memory.size] = np.stack([left.memory.real, left.memory.imag], axis=1)
    return frames.assign(
        {
            "final_motion": (
                ("left", "component"), np.array([left.motion for left in ends.values()]),
                {"units": "m, 1, m/s, rad/s", "long_name": "last state of the body: place of its centre of gravity, "
                 "quaternion, velocity, spin"},
            ),
            "final_memory": (
                ("left", "pole", "part"), memory, {"units": "1", "long_name": "last state of the radiation of the body"}
            ),
            "final_poles": (
                "left", np.array([left.memory.size for left in ends.values()]),
                {"units": "1", "long_name": "states of the radiation of the body"},
            ),
        }
    ).assign_coords(left=names)  # fmt: skip


def bodies_of(frames: xr.Dataset) -> dict[str, BodyState]:
    """Return where the bodies were at the end of the rows."""
    if "final_motion" not in frames:
        return {}
    found = {}
    for row, name in enumerate(frames["left"].values):
        parts = frames["final_memory"].values[row, : int(frames["final_poles"].values[row])]
        found[str(name)] = BodyState(np.array(frames["final_motion"].values[row]), parts[:, 0] + 1j * parts[:, 1])
    return found


def joined(before: xr.Dataset, after: xr.Dataset, dim: str) -> xr.Dataset:
    """Return the rows of both along ``dim``; rows of the earlier one beyond the start of the later are dropped."""
    import xarray as xr

    begin = float(after[dim].values[0])
    kept = before.isel({dim: np.flatnonzero(before[dim].values < begin - 1e-9)})
    along = [name for name in after.data_vars if dim in after[name].dims]
    once = after.drop_dims(dim)
    # what an earlier version did not write is not a number there
    both = xr.concat([kept[[name for name in along if name in kept]], after[along]], dim=dim, combine_attrs="override")
    out = xr.merge([both, once], combine_attrs="override")
    for name in out.variables:
        if name in after.variables:
            out[name].attrs = dict(after[name].attrs)
    out.attrs = dict(after.attrs)
    return out
