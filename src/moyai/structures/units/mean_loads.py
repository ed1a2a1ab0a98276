"""Mean loads in the connectors, and which of them the drift of the waves goes through.

Where the units of a row do not share the lines alike, the mean drift of one passes through connectors to the lines of
another. Slow drift, that force several times over, takes the same way, and the frequency domain has none of it.
"""

from __future__ import annotations

import numpy as np

from moyai.core.arrays import Array
from moyai.structures.units.assembly import RowAtLevel, RowPosition, steady_position
from moyai.structures.units.contact import Flags
from moyai.structures.units.gaps import largest_closing
from moyai.structures.units.links import Work
from moyai.structures.units.seas import SeaAnswer

#: Share of mean drift in a load or a closing from which slow drift, five times the mean, may add a tenth.
_FELT = 0.02
#: Forces, moments and closings that are rounding [N, N m, m].
_NOTHING = 1e-6


def mean_loads(at: RowAtLevel, rest: RowPosition, work: Work) -> Array:
    """Return the mean loads (joints, 6) in the connectors [N, N m]."""
    position, held = rest.position, rest.held_load
    out = np.zeros((len(at.joints), 6))
    first = 0
    for number, joint in enumerate(at.joints):
        connector = joint.connector
        if len(joint.held):
            out[number] += held[first : first + len(joint.held)] @ joint.held
            first += len(joint.held)
        if connector.stiffness is not None:
            out[number] += connector.stiffness @ (joint.relative @ position)
    for link in at.links:
        force = link.bears(position, work)[0]
        out[link.joint, :3] += force * link.direction(position)
    return out


def drift_felt(at: RowAtLevel, answer: SeaAnswer, force: Array, moment: Array, closing: Array) -> dict[str, Flags]:
    """Return which connectors and gaps mean drift adds more to than a fiftieth of their largest values.

    Parameters
    ----------
    at : RowAtLevel
    answer : SeaAnswer
        To an irregular sea.
    force, moment, closing : ndarray (joints,), (joints,), (gaps,)
        Largest values of the sea [N, N m, m].
    """
    still = steady_position(at, answer.rest.load - answer.pushed, answer.work)
    own = mean_loads(at, answer.rest, answer.work) - mean_loads(at, still, answer.work)
    by_drift = np.linalg.norm(own.reshape(-1, 2, 3), axis=2)
    # a moment next to which the force on half a beam is small is none
    moments = np.maximum(moment, 0.5 * at.row.hull.beam * force)

    def closed(position: Array) -> Array:
        return largest_closing(at, position, lambda corners: np.zeros(len(corners)))

    moved = closed(answer.rest.position) - closed(still.position)
    return {
        "connector_feels_drift": np.any(_FELT * np.stack([force, moments]) + _NOTHING < by_drift.T, axis=0),
        "gap_feels_drift": moved > _FELT * closing + _NOTHING,
    }


__all__ = ["drift_felt", "mean_loads"]
