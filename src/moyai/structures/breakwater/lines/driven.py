"""Lines whose fairleads are led along a harmonic motion of the unit: mean and first harmonic of their force on it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.flexible.flow import Current
from moyai.flexible.sea_table import sea_of_lines
from moyai.flexible.stepping import SteppedNetwork
from moyai.mooring.system import PlanarLineSystem
from moyai.sea.components import WaveComponents
from moyai.sea.dispersion import wave_number
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.lines.network import LineNetwork, line_network, resolved
from moyai.structures.breakwater.model import MooringLine
from moyai.structures.breakwater.settings import LineDynamics

#: Instants of a period at which the force is taken.
INSTANTS = 64
#: Periods that lead over from one motion to the next, and after that until the force is taken.
BLEND, SETTLE = 1, 1


def wave_around(unit: FloatingUnit, omega: float, height: float, heading: float) -> WaveComponents:
    """Return a regular wave around lines, crest at the origin at t = 0.

    Parameters
    ----------
    unit : FloatingUnit
    omega : float
        [rad/s].
    height : float
        [m].
    heading : float
        [rad].
    """
    number = wave_number(np.array([omega]), unit.water.depth, unit.water.gravity)
    return WaveComponents(
        np.array([omega]), np.array([0.5 * height]), np.zeros(1), np.array([heading]), number, unit.water
    )


@dataclass(frozen=True, eq=False)
class LinesOfUnit:
    """Lines of a unit as they are led: those in motion as a network, the others at rest at every instant."""

    unit: FloatingUnit
    moving: LineNetwork | None
    still: PlanarLineSystem
    current: Current | None

    @classmethod
    def of(cls, unit: FloatingUnit, dynamics: LineDynamics, current: Current | None) -> LinesOfUnit:
        """Cut the lines that are in motion in time, as finely as they are there."""
        system = unit.mooring.planar.system
        kept = tuple(
            line
            for line, given in zip(unit.lines, unit.breakwater.lines, strict=True)
            if not (isinstance(given, MooringLine) and given.dynamic)
        )
        return cls(
            unit, line_network(unit, resolved(unit, dynamics)), PlanarLineSystem(replace(system, lines=kept)), current
        )


class DrivenLines:
    """Lines of a unit led along one harmonic motion after another, without coming to rest between them.

    What is left of the motion before fades while the motions draw nearer to each other.

    Parameters
    ----------
    lines : LinesOfUnit
    omega : float
        Angular frequency [rad/s].
    height, heading : float
        Of the wave around lines in motion [m, rad].
    """

    def __init__(self, lines: LinesOfUnit, omega: float, height: float, heading: float) -> None:
        unit, self.omega, self._still = lines.unit, omega, lines.still
        self._step, self._taken = 2.0 * math.pi / omega / INSTANTS, 0
        self._offset, self._motion = np.zeros(3), np.zeros(3, dtype=complex)
        self._rest = lines.still.forces(np.zeros(3)) if lines.still.names else np.zeros(3)
        self._moving = lines.moving
        if lines.moving is None:
            return
        network = lines.moving
        self._copies = np.array([float(line.count) for line in network.lines])
        self._arms = np.array([[line.fairlead[0], line.fairlead[2]] for line in network.lines], dtype=float)
        self._centre = np.array([unit.centre[0], unit.centre[1]])
        flow = sea_of_lines(
            wave_around(unit, omega, height, heading), lines.current, 2.0 * math.pi / omega,
            network.rest.state.position, 0.0, self._step,
        )  # fmt: skip
        self._network = SteppedNetwork(
            network.network, network.names, flow=flow, start=network.rest.state, keep_nodes=[0], keep_bars=[0]
        )
        self._rest = self._rest + self._on_unit(network.pulls, self._arms)

    def harmonics(self, offset: Array, motion: ComplexArray) -> tuple[Array, ComplexArray]:
        """Return mean and first harmonic (3,) of the force beyond that at rest, of Re(F exp(-i omega t)) [N, N, N m].

        Parameters
        ----------
        offset : ndarray (3,)
            Mean position relative to rest [m, m, rad].
        motion : ndarray (3,)
            Complex amplitude about it.

        Raises
        ------
        ConvergenceError
            When the lines in motion blow up.
        """
        step, omega = self._step, self.omega
        middle = step * (self._taken + np.arange(INSTANTS) + 0.5)
        if self._moving is not None:
            begin, lead = (self._offset, self._motion), (BLEND + SETTLE) * INSTANTS
            taken = [
                self._force(begin, (offset, motion), min(part / (BLEND * INSTANTS), 1.0))
                for part in range(1, lead + INSTANTS + 1)
            ]
            force = np.array(taken[lead:])
            middle = middle + step * lead
            self._offset, self._motion = np.array(offset), np.array(motion)
        else:
            force = np.zeros((INSTANTS, 3))
        # lines at rest answer at once; those in motion by their mean over a step
        mean, first = force.mean(axis=0), 2.0 * np.mean(force * np.exp(1j * omega * middle)[:, None], axis=0)
        first = first / np.sinc(1.0 / INSTANTS)
        if self._still.names:
            turn = np.exp(-2j * math.pi * np.arange(INSTANTS) / INSTANTS)
            quick = self._still.forces(offset + (turn[:, None] * motion).real)
            mean, first = mean + quick.mean(axis=0), first + 2.0 * np.mean(quick * turn.conj()[:, None], axis=0)
        return mean - self._rest, first

    def _force(self, before: tuple[Array, ComplexArray], after: tuple[Array, ComplexArray], part: float) -> Array:
        """Lead the fairleads on by a step, ``part`` of the way from one motion to another; return the mean force."""
        time = self._step * (self._taken + 1)
        share = 0.5 * (1.0 - math.cos(math.pi * part))
        rate = 0.5 * math.pi / (BLEND * INSTANTS * self._step) * math.sin(math.pi * part)
        offset, motion = (old + share * (new - old) for old, new in zip(before, after))
        turn = np.exp(-1j * self.omega * time)
        place = offset + (motion * turn).real
        speed = (-1j * self.omega * motion * turn).real
        speed = speed + rate * (after[0] - before[0] + ((after[1] - before[1]) * turn).real)
        arms = self._turned(place[2])
        points, velocity = np.zeros((len(arms), 3)), np.zeros((len(arms), 3))
        points[:, [0, 2]] = self._centre + place[:2] + arms
        velocity[:, [0, 2]] = speed[:2] + speed[2] * np.column_stack([arms[:, 1], -arms[:, 0]])
        pull = self._network.try_step(time, points, velocity)[0]
        self._network.accept()
        self._taken += 1
        half = offset + (motion * turn * np.exp(0.5j * self.omega * self._step)).real
        return self._on_unit(pull, self._turned(half[2]))

    def _turned(self, roll: float) -> Array:
        x, z = self._arms.T
        return np.column_stack([x * math.cos(roll) + z * math.sin(roll), z * math.cos(roll) - x * math.sin(roll)])

    def _on_unit(self, pull: Array, arms: Array) -> Array:
        """Return force and moment of all copies from the pull of one copy of each line (lines, 3)."""
        x, z = self._copies * pull[:, 0], self._copies * pull[:, 2]
        return np.array([x.sum(), z.sum(), float(np.sum(arms[:, 1] * x - arms[:, 0] * z))])
