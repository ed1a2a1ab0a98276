"""Mooring lines as parts of a network: cut into bars on their exact shape, driven at the fairlead, on a bed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType, Strand
from moyai.flexible.network import Network
from moyai.flexible.result import State
from moyai.flexible.statics import solve_equilibrium
from moyai.mooring.lines import Line, Segment
from moyai.mooring.shape import line_shape
from moyai.sea.water import Water

#: Depth to which a line sinks into the bed at rest, over its diameter, where no stiffness is given.
SINKING = 0.02


class Segmented(Protocol):
    """A line of segments."""

    @property
    def segments(self) -> tuple[Segment, ...]:
        """From the anchor to the fairlead."""


def bars_of(line: Segmented, bars: int) -> list[int]:
    """Return how many bars each segment gets, one at least."""
    length = sum(segment.length for segment in line.segments)
    return [max(1, round(bars * segment.length / length)) for segment in line.segments]


def with_damping(given: BarType, length: float, ratio: float) -> BarType:
    """Return the material with the internal damping of a bar of this length."""
    return replace(given, viscosity=ratio * length * math.sqrt(given.axial_stiffness * given.mass_per_length))


def bed_under(
    kinds: Sequence[BarType], water: Water, friction: float, stiffness: float | None, damping: float | None
) -> Bed:
    """Return the bed under lines of some materials.

    Parameters
    ----------
    kinds : sequence of BarType
    water : Water
    friction : float
    stiffness, damping : float or None
        Per contact area [Pa/m], [Pa s/m]; ``None``: the heaviest line sinks a fiftieth of its diameter; half of
        critical for a piece of it.
    """
    weights = [abs(kind.submerged_weight_per_length(water)) for kind in kinds]
    if stiffness is None:
        stiffness = max(w / (SINKING * kind.diameter**2) for w, kind in zip(weights, kinds, strict=True))
    if damping is None:
        damping = max(math.sqrt(stiffness * kind.mass_per_length / kind.diameter) for kind in kinds)
    return Bed(-water.depth, stiffness, damping, friction)


def add_mooring_line(
    builder: NetworkBuilder,
    line: Line,
    kinds: Sequence[BarType],
    clump_bodies: Sequence[tuple[float, float]],
    centre: Array,
    water: Water,
    bars: int,
    damping_ratio: float,
) -> None:
    """Add anchor, fairlead, clumps and the bars between them, on the exact shape at rest.

    Parameters
    ----------
    builder : NetworkBuilder
    line : Line
        About the origin of its body.
    kinds : sequence of BarType
        Of every segment.
    clump_bodies : sequence of (float, float)
        Mass [kg] and volume [m3] of every clump.
    centre : ndarray (3,)
        Origin of the body in site axes [m].
    water : Water
    bars : int
        Of the whole line.
    damping_ratio : float
        Internal damping of a bar, BA = ratio times bar length times sqrt(EA m).
    """
    fairlead = np.asarray(line.fairlead, dtype=float)
    counts = bars_of(line, bars)
    shape = line_shape(line, fairlead, water.depth + float(centre[2]), points=max(200, 4 * sum(counts)))
    builder.fixed(f"{line.name} anchor", np.asarray(line.anchor) + centre)
    builder.driven(line.name, fairlead + centre)
    bed = -water.depth

    def at(length: Array) -> Array:
        points = np.stack([np.interp(length, shape.arc_length, shape.points[:, axis]) for axis in range(3)], axis=-1)
        points = points + centre
        points[..., 2] = np.maximum(points[..., 2], bed)
        return points

    clumps = {clump.after_segment: number for number, clump in enumerate(line.clumps)}
    start, gone = f"{line.name} anchor", 0.0
    for number, (segment, count, kind) in enumerate(zip(line.segments, counts, kinds, strict=True)):
        last = number == len(line.segments) - 1
        end = line.name if last else f"{line.name} joint {number + 1}"
        if not last:
            mass, volume = clump_bodies[clumps[number]] if number in clumps else (0.0, 0.0)
            # a clump sinks into the bed as far as the line does
            load = max(mass - water.density * volume, 0.0) * water.gravity
            area = 0.0 if builder.bed is None else load / (builder.bed.stiffness * SINKING * kind.diameter)
            builder.free(end, at(np.array(gone + segment.length)), mass=mass, volume=volume, contact_area=area)
        inner = gone + segment.length * np.arange(1, count) / count
        material = with_damping(kind, segment.length / count, damping_ratio)
        builder.line(
            f"{line.name}/{number}", start, end, material, length=segment.length, segments=count, shape=at(inner)
        )
        start, gone = end, gone + segment.length


def joined(network: Network, names: Sequence[str]) -> Network:
    """Return the network with the segments of each line as one strand."""
    strands = []
    for name in names:
        parts = [strand for strand in network.strands if strand.name.rsplit("/", 1)[0] == name]
        nodes = np.concatenate([parts[0].nodes[:1], *(part.nodes[1:] for part in parts)])
        strands.append(Strand(name, nodes, np.concatenate([part.bars for part in parts])))
    return replace(network, strands=tuple(strands))


def end_tensions(network: Network, name: str, position: Array, tension: Array) -> tuple[Array, Array]:
    """Return the tensions at fairlead and anchor of a line over rows of states [N].

    A bar knows its tension in its middle; the ends differ by the weight of half a bar, T - w z being constant along
    a line.

    Parameters
    ----------
    network : Network
    name : str
    position : ndarray (k, nodes, 3)
    tension : ndarray (k, bars)
    """
    strand = network.strand(name)
    bars, water = network.bars, network.water
    ends = []
    for bar, low, high, sign in (
        (strand.bars[-1], strand.nodes[-2], strand.nodes[-1], 1.0),
        (strand.bars[0], strand.nodes[0], strand.nodes[1], -1.0),
    ):
        weight = bars.types[bars.kind[bar]].submerged_weight_per_length(water)
        rise = 0.5 * (position[:, high, 2] - position[:, low, 2])
        ends.append(np.maximum(tension[:, bar] + sign * weight * rise, 0.0))
    return ends[0], ends[1]


def carried_along(network: Network, rest: State, places: Mapping[str, Array]) -> State:
    """Return lines at rest with their fairleads moved to other places.

    Parameters
    ----------
    network : Network
    rest : State
        With the fairleads where the network has them.
    places : mapping of str to ndarray (3,)
        Of the fairleads, in site axes [m].

    Raises
    ------
    InputError
        When the lines find no equilibrium there.
    """
    nodes, position = network.nodes, np.array(network.nodes.position)
    guess = np.array(rest.position)
    for name, place in places.items():
        strand = network.strand(name)
        shift = np.asarray(place, dtype=float) - position[strand.nodes[-1]]
        # first guess: the line follows its fairlead in proportion to the way from its anchor
        guess[strand.nodes] += np.linspace(0.0, 1.0, strand.nodes.size)[:, None] * shift
        position[strand.nodes[-1]] = place
    moved = replace(network, nodes=replace(nodes, position=position))
    try:
        found = solve_equilibrium(moved, start=State(0.0, guess, np.zeros_like(guess)))
    except ConvergenceError as error:
        raise InputError(
            f"the lines in motion find no equilibrium: {error.fault.message}",
            parameter="lines",
            remedy=error.fault.remedy,
        ) from error
    return State(0.0, found.state.position, np.zeros_like(guess))
