"""The last good state of a run on disk, from which another run can go on."""

from __future__ import annotations

import os
import zipfile
from pathlib import Path

import numpy as np

from moyai.core.errors import InputError
from moyai.core.files import partial_file
from moyai.flexible.network import Network
from moyai.flexible.result import State

#: Mark of the file, so that any other one is refused.
_KIND = "moyai network state 1"


def write_state(path: str | os.PathLike[str], state: State) -> Path:
    """Write a state; a file under the final name is always complete.

    Parameters
    ----------
    path : path
        File, ``.npz`` by custom; its folder is made when it is not there.
    state : State
        Time, positions and velocities of all nodes.

    Returns
    -------
    Path
        Where it is.

    Raises
    ------
    InputError
        When the folder cannot be written.
    """
    target = Path(path)
    size = state.position.nbytes + state.velocity.nbytes
    with (
        partial_file(target, size=size, remedy="name a folder that you own", named="state_file") as partial,
        partial.open("wb") as file,
    ):
        np.savez(file, kind=_KIND, time=state.time, position=state.position, velocity=state.velocity)
    return target


def read_state(path: str | os.PathLike[str], network: Network | None = None) -> State:
    """Read a state that :func:`write_state` kept.

    Parameters
    ----------
    path : path
        The file.
    network : Network, optional
        The network that it must fit.

    Raises
    ------
    InputError
        When there is no such file, it is no state, or it belongs to a network of another size.
    """
    target = Path(path)
    try:
        with np.load(target, allow_pickle=False) as stored:
            if "kind" not in stored or str(stored["kind"]) != _KIND:
                raise InputError(f"{target} holds no state of a network", parameter="state_file", allowed=_KIND)
            state = State(float(stored["time"]), np.array(stored["position"]), np.array(stored["velocity"]))
    except FileNotFoundError as error:
        raise InputError(f"no file {target}", parameter="state_file", allowed="a file that a run wrote") from error
    except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
        if isinstance(error, InputError):
            raise
        raise InputError(
            f"{target} is damaged or no state of a network", parameter="state_file", allowed=_KIND
        ) from error
    shape = state.position.shape
    if len(shape) != 2 or shape[1] != 3 or state.velocity.shape != shape:
        raise InputError(f"{target} holds positions of shape {shape}", parameter="state_file", allowed="(nodes, 3)")
    if network is not None and len(network.nodes) != shape[0]:
        raise InputError(
            f"{target} holds {shape[0]} nodes, the network {len(network.nodes)}",
            parameter="state_file",
            allowed="a state of the same network",
        )
    if not (np.isfinite(state.position).all() and np.isfinite(state.velocity).all()):
        raise InputError(f"{target} holds values that are not finite", parameter="state_file", allowed="finite numbers")
    return state
