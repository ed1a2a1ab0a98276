"""The lines of a unit that are in motion, as a flexible network around the body at rest."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.validity import IdentityCheck
from moyai.coupled.equilibrium import point_pulls
from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import Strand
from moyai.flexible.flow import Flow
from moyai.flexible.mooring_line import add_mooring_line, bed_under, carried_along, end_tensions, joined
from moyai.flexible.network import Network
from moyai.flexible.result import Equilibrium, State
from moyai.flexible.statics import solve_equilibrium
from moyai.mooring.lines import Line
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.model import MooringLine
from moyai.structures.breakwater.settings import LineDynamics

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
        return end_tensions(self.network, name, position, tension)

    def carried_along(self, places: Mapping[str, Array]) -> State:
        """Return the lines at rest with their fairleads moved to other places.

        Parameters
        ----------
        places : mapping of str to ndarray (3,)
            Of the fairleads, in site axes [m].

        Raises
        ------
        InputError
            When the lines find no equilibrium there.
        """
        return carried_along(self.network, self.rest.state, places)

    def tension_at_rest(self) -> Array:
        """Return the tension at the fairlead of each line at rest [N]."""
        place, pull = self.rest.state.position[None], self.rest.tension[None]
        return np.array([self.end_tensions(name, place, pull)[0][0] for name in self.names])


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
    friction = frictions.pop() if frictions else 0.0
    return bed_under(kinds, unit.water, friction, dynamics.bed_stiffness, dynamics.bed_damping)


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
        add_mooring_line(
            builder, line, given.bar_types, given.clump_bodies, centre, unit.water, dynamics.bars,
            dynamics.damping_ratio,
        )  # fmt: skip
    network = joined(builder.build(), [line.name for _, line, _ in chosen])
    try:
        rest = solve_equilibrium(network)
    except ConvergenceError as error:
        raise InputError(
            f"the lines in motion find no equilibrium: {error.fault.message}",
            parameter="lines",
            remedy=error.fault.remedy,
        ) from error
    names = [line.name for _, line, _ in chosen]
    return LineNetwork(
        network,
        rest,
        tuple(line for _, line, _ in chosen),
        tuple(number for number, _, _ in chosen),
        point_pulls(network, rest.state, names, Flow()),
    )


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
