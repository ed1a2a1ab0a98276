"""The problem in SI units and radians, and its statics."""

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.errors import ConvergenceError
from moyai.core.headline import Criterion
from moyai.mooring import Line, LineSystem, Segment
from moyai.sea import CurrentProfile, Water


@dataclass(frozen=True)
class SparProblem:
    """A spar that stays upright, its chain and its site: sizes [m], mass [kg], heading of the current [rad]."""

    diameter: float
    height: float
    mass: float
    drag_coefficient: float
    chain: Segment
    water: Water
    water_levels: tuple[tuple[str, float], ...]
    current: CurrentProfile
    heading: float
    criteria: tuple[Criterion, ...]
    attributes: dict[str, str]

    @property
    def free_draught(self) -> float:
        """Draught without the chain [m], of Archimedes."""
        return self.mass / (self.water.density * 0.25 * math.pi * self.diameter**2)


@dataclass(frozen=True)
class SparState:
    """Equilibrium in the current: lengths [m], forces [N], residual of the vertical ones over the weight."""

    draught: float
    offset: float
    drag: float
    tension: float
    residual: float


def equilibrium(problem: SparProblem, level: float) -> SparState:
    """Return where drag, weight, buoyancy and chain balance: Morison drag over the draught, elastic catenary."""
    water, depth, free = problem.water, problem.water.depth + level, problem.free_draught
    lines = LineSystem((Line("chain", (0.0, 0.0, -depth), (0.0, 0.0, -free), (problem.chain,)),), depth)
    heave_stiffness = problem.mass * water.gravity / free
    stiffness = np.diag([0.0, 0.0, heave_stiffness, 0.0, 0.0, 0.0])
    position, draught = np.array([0.5 * problem.chain.length, 0.0, 0.0, 0.0, 0.0, 0.0]), free
    for _ in range(100):  # the weight of the chain deepens the spar, which adds to the drag
        mean_square = problem.current.in_depth(depth).depth_mean_drag(-draught, 0.0, problem.heading)
        drag = 0.5 * water.density * problem.drag_coefficient * problem.diameter * draught * mean_square
        found = lines.equilibrium([drag, 0.0, 0.0, 0.0, 0.0, 0.0], stiffness, start=position, free=(0, 2))
        position, before, draught = found.position, draught, free - float(found.position[2])
        if abs(draught - before) < 1e-9 * draught:
            hanging = problem.chain.length - float(lines.states(position)["chain"].grounded_length[0])
            carried = problem.mass * water.gravity + problem.chain.line_type.submerged_weight * hanging
            residual = abs(heave_stiffness * draught / carried - 1.0)
            return SparState(draught, float(position[0]), drag, float(found.tension[0]), residual)
    raise ConvergenceError("the draught of the spar does not settle: the current pulls it under")
