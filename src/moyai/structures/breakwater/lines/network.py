"""The lines of a unit that are in motion, as a flexible network around the body at rest."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.validity import IdentityCheck
from moyai.coupled.rest import point_pulls
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.flow import Flow
from moyai.flexible.network import BarType, Bed, Network, Strand
from moyai.flexible.result import State
from moyai.flexible.statics import Equilibrium, solve_equilibrium
from moyai.mooring.lines import Line
from moyai.mooring.shape import line_shape
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.model import MooringLine
from moyai.structures.breakwater.settings import LineDynamics

#: Depth to which a line sinks into the bed at rest, over its diameter, where no stiffness is given.
SINKING = 0.02
#: Tension at rest of the network against the exact line.
STATIC_TOLERANCE = 0.02


@dataclass(frozen=True, eq=False)
class LineNetwork:
    """Lines in motion."""

    #: In site axes; every fairlead is a driven point with the name of its line.
    network: Network
    #: With the body at rest.
    rest: Equilibrium
    #: The exact lines, about the centre of gravity.
    lines: tuple[Line, ...]
    #: Which lines of the unit these are.
    index: tuple[int, ...]
    #: Force of one copy on the body at rest [N]; shape (lines, 3).
    pulls: Array

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the lines."""
        return tuple(line.name for line in self.lines)

    def strand(self, name: str) -> Strand:
        """Return the bars of a line from its anchor to its fairlead."""
        return self.network.strand(name)

    def end_tensions(self, name: str, position: Array, tension: Array) -> tuple[Array, Array]:
        """Return the tensions at fairlead and anchor of a line over rows of states [N].

        A bar knows its tension in its middle; the ends differ by the weight of half a bar, T - w z being constant along
        a line.

        Parameters
        ----------
        name : str
        position : ndarray (k, nodes, 3)
        tension : ndarray (k, bars)
        """
        strand = self.strand(name)
        bars, water = self.network.bars, self.network.water
        ends = []
        for bar, low, high, sign in (
            (strand.bars[-1], strand.nodes[-2], strand.nodes[-1], 1.0),
            (strand.bars[0], strand.nodes[0], strand.nodes[1], -1.0),
        ):
            weight = bars.types[bars.kind[bar]].submerged_weight_per_length(water)
            rise = 0.5 * (position[:, high, 2] - position[:, low, 2])
            ends.append(np.maximum(tension[:, bar] + sign * weight * rise, 0.0))
        return ends[0], ends[1]

    def carried_along(self, places: Mapping[str, Array]) -> State:
        """Return the lines at rest with their fairleads moved to other places.

        Parameters
        ----------
        places : mapping of str to ndarray (3,)
            Of the fairleads, in site axes [m].

        Raises
        ------
        InputError
            When the lines find no rest there.
        """
        nodes, position = self.network.nodes, np.array(self.network.nodes.position)
        guess = np.array(self.rest.state.position)
        for name, place in places.items():
            strand = self.strand(name)
            shift = np.asarray(place, dtype=float) - position[strand.nodes[-1]]
            # first guess: the line follows its fairlead in proportion to the way from its anchor
            guess[strand.nodes] += np.linspace(0.0, 1.0, strand.nodes.size)[:, None] * shift
            position[strand.nodes[-1]] = place
        moved = replace(self.network, nodes=replace(nodes, position=position))
        try:
            found = solve_equilibrium(moved, start=State(0.0, guess, np.zeros_like(guess)))
        except ConvergenceError as error:
            raise InputError(
                f"the lines in motion find no rest: {error.fault.message}", parameter="lines", remedy=error.fault.remedy
            ) from error
        return State(0.0, found.state.position, np.zeros_like(guess))

    def tension_at_rest(self) -> Array:
        """Return the tension at the fairlead of each line at rest [N]."""
        place, pull = self.rest.state.position[None], self.rest.tension[None]
        return np.array([self.end_tensions(name, place, pull)[0][0] for name in self.names])


def bars_of(line: MooringLine, bars: int) -> list[int]:
    """Return how many bars each segment gets, one at least."""
    length = sum(segment.length for segment in line.segments)
    return [max(1, round(bars * segment.length / length)) for segment in line.segments]


def with_damping(given: BarType, length: float, ratio: float) -> BarType:
    """Return the material with the internal damping of a bar of this length."""
    return replace(given, viscosity=ratio * length * math.sqrt(given.axial_stiffness * given.mass_per_length))


def bed_of(unit: FloatingUnit, lines: list[MooringLine], dynamics: LineDynamics) -> Bed:
    """Return the bed under the lines; where no stiffness is given the heaviest line sinks a fiftieth of its diameter.

    Raises
    ------
    InputError
        When lines have different friction on the one bed.
    """
    frictions = {line.bed_friction for line in lines}
    if len(frictions) > 1:
        raise InputError(
            f"lines in motion have a friction of {', '.join(f'{value:g}' for value in sorted(frictions))} on the bed",
            parameter="lines.bed_friction",
            allowed="one value for all lines in motion",
        )
    kinds = [kind for line in lines for kind in line.bar_types]
    weights = [abs(kind.submerged_weight_per_length(unit.water)) for kind in kinds]
    stiffness = dynamics.bed_stiffness
    if stiffness is None:
        stiffness = max(w / (SINKING * kind.diameter**2) for w, kind in zip(weights, kinds, strict=True))
    damping = dynamics.bed_damping
    if damping is None:
        # half of critical for a piece of the heaviest line on its bed
        damping = max(math.sqrt(stiffness * kind.mass_per_length / kind.diameter) for kind in kinds)
    return Bed(-unit.water.depth, stiffness, damping, frictions.pop() if frictions else 0.0)


def line_network(unit: FloatingUnit, dynamics: LineDynamics) -> LineNetwork | None:
    """Build the lines of a unit that are in motion and bring them to rest; ``None`` when there are none.

    Raises
    ------
    InputError
        For lines whose rest cannot be found.
    """
    chosen = [
        (number, line, given)
        for number, (line, given) in enumerate(zip(unit.lines, unit.breakwater.lines, strict=True))
        if isinstance(given, MooringLine) and given.dynamic and isinstance(line, Line)
    ]
    if not chosen:
        return None
    centre = np.array([unit.centre[0], 0.0, unit.centre[1]])
    builder = NetworkBuilder(unit.water, bed_of(unit, [given for _, _, given in chosen], dynamics))
    for _, line, given in chosen:
        _add_line(builder, line, given, centre, unit, dynamics)
    network = _joined(builder.build(), [line.name for _, line, _ in chosen])
    try:
        rest = solve_equilibrium(network)
    except ConvergenceError as error:
        raise InputError(
            f"the lines in motion find no rest: {error.fault.message}", parameter="lines", remedy=error.fault.remedy
        ) from error
    names = [line.name for _, line, _ in chosen]
    return LineNetwork(
        network,
        rest,
        tuple(line for _, line, _ in chosen),
        tuple(number for number, _, _ in chosen),
        point_pulls(network, rest.state, names, Flow()),
    )


def _add_line(
    builder: NetworkBuilder, line: Line, given: MooringLine, centre: Array, unit: FloatingUnit, dynamics: LineDynamics
) -> None:
    """Add anchor, fairlead, clumps and the bars between them, on the exact shape at rest."""
    fairlead = np.asarray(line.fairlead, dtype=float)
    counts = bars_of(given, dynamics.bars)
    shape = line_shape(line, fairlead, unit.water.depth + unit.centre[1], points=max(200, 4 * sum(counts)))
    builder.fixed(f"{line.name} anchor", np.asarray(line.anchor) + centre)
    builder.driven(line.name, fairlead + centre)
    bed = -unit.water.depth

    def at(length: Array) -> Array:
        points = np.stack([np.interp(length, shape.arc_length, shape.points[:, axis]) for axis in range(3)], axis=-1)
        points = points + centre
        points[..., 2] = np.maximum(points[..., 2], bed)
        return points

    clumps = {clump.after_segment: number for number, clump in enumerate(given.clumps)}
    start, gone = f"{line.name} anchor", 0.0
    for number, (segment, count, kind) in enumerate(zip(given.segments, counts, given.bar_types, strict=True)):
        last = number == len(given.segments) - 1
        end = line.name if last else f"{line.name} joint {number + 1}"
        if not last:
            mass, volume = given.clump_bodies[clumps[number]] if number in clumps else (0.0, 0.0)
            # a clump sinks into the bed as far as the line does
            load = max(mass - unit.water.density * volume, 0.0) * unit.water.gravity
            area = 0.0 if builder.bed is None else load / (builder.bed.stiffness * SINKING * kind.diameter)
            builder.free(end, at(np.array(gone + segment.length)), mass=mass, volume=volume, contact_area=area)
        inner = gone + segment.length * np.arange(1, count) / count
        material = with_damping(kind, segment.length / count, dynamics.damping_ratio)
        builder.line(
            f"{line.name}/{number}", start, end, material, length=segment.length, segments=count, shape=at(inner)
        )
        start, gone = end, gone + segment.length


def _joined(network: Network, names: list[str]) -> Network:
    """Return the network with the segments of each line as one strand."""
    strands = []
    for name in names:
        parts = [strand for strand in network.strands if strand.name.rsplit("/", 1)[0] == name]
        nodes = np.concatenate([parts[0].nodes[:1], *(part.nodes[1:] for part in parts)])
        strands.append(Strand(name, nodes, np.concatenate([part.bars for part in parts])))
    return replace(network, strands=tuple(strands))


def static_check(unit: FloatingUnit, lines: LineNetwork) -> IdentityCheck:
    """Hold the tensions of the network at rest against the exact lines."""
    exact = unit.mooring.planar.tensions(np.zeros(3))[list(lines.index)]
    error = float(np.max(np.abs(lines.tension_at_rest() - exact) / exact))
    return IdentityCheck(
        f"{unit.name}: lines in motion at rest against the exact lines", error, STATIC_TOLERANCE,
        "tension at the fairlead against the exact catenary; the difference falls with the bar length squared",
    )  # fmt: skip


def resolved(unit: FloatingUnit, dynamics: LineDynamics) -> LineDynamics:
    """Return the cutting of the lines with as many bars as bring their rest to the exact lines, four times at most.

    A slack chain hangs on few of its bars; the rest of it lies on the bed.

    Parameters
    ----------
    unit : FloatingUnit
        Whose lines are in motion.
    dynamics : LineDynamics
    """
    for factor in (1, 2, 4):
        finer = dynamics.changed(bars=factor * dynamics.bars)
        lines = line_network(unit, finer)
        if lines is None or static_check(unit, lines).passed:
            break
    return finer
