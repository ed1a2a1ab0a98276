"""Bodies and network at rest together."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.coupled.bodies import Body
from moyai.coupled.rigid import RigidBody, RigidCarrier
from moyai.flexible.elements import Nodes
from moyai.flexible.flow import Flow
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network, check_network
from moyai.flexible.result import Equilibrium, State
from moyai.flexible.statics import solve_equilibrium
from moyai.flexible.stepping import SteppedNetwork, carried_nodes
from moyai.mooring.rotations import roll_pitch_yaw

#: Force left over the largest force at work.
TOLERANCE = 1e-8
MOST_ROUNDS = 60
#: Part of the stable step of the network over which its pull at rest is taken.
INSTANT = 1e-3
#: Stiffness over the largest one below which it counts as none; pushes off a balance that would tip over.
SLACK, MOST_TIPS = 1e-6, 3
#: Change of force that the slope did not foresee over the one it did, up to which it is updated and not taken anew.
GOOD = 0.5


@dataclass(frozen=True, eq=False)
class CoupledEquilibrium:
    """Bodies and network at rest."""

    #: With its carried points where the bodies rest.
    network: Network
    #: Of the network.
    state: State
    #: The same bodies, starting from rest.
    bodies: dict[str, RigidBody]
    #: [N]; shape (m,).
    tension: Array
    #: Force left on the bodies over the largest weight or pull.
    residual: float
    #: Solves of the network.
    rounds: int


def moved_network(network: Network, places: Mapping[str, Array]) -> Network:
    """Return the network with driven points at other places [m]."""
    nodes = carried_nodes(network, list(places))
    position = np.array(network.nodes.position)
    for node, place in zip(nodes, places.values(), strict=True):
        position[node] = place
    names = (
        "kind", "held", "motion", "mass", "volume", "drag_area", "added_mass", "contact_area", "height", "form",
    )  # fmt: skip
    moved = Nodes(position, *(getattr(network.nodes, name) for name in names))
    return replace(network, nodes=moved)


def point_pulls(network: Network, state: State, names: list[str], calm: Flow) -> Array:
    """Return the force of a network at rest on its carried points: bars, half bars with weight, water and bed.

    It is what the run through time feels there: the scheme of the run itself, over an instant in which nothing moves.
    """
    if not names:
        return np.zeros((0, 3))
    carried = {network.motion_names[network.nodes.motion[node]] for node in carried_nodes(network, names)}
    still = Motion(0.0, 1.0, np.zeros((2, 3)), np.zeros((2, 3)))
    stepped = SteppedNetwork(
        network, names, motions={name: still for name in network.motion_names if name not in carried}, flow=calm,
        start=state, keep_nodes=[0], keep_bars=[0],
    )  # fmt: skip
    places = state.position[carried_nodes(network, names)]
    instant = INSTANT * min(stepped.run.limit()[0], 1.0)
    return np.asarray(stepped.try_step(instant, places, np.zeros_like(places))[0])


def find_coupled_equilibrium(
    network: Network,
    bodies: Mapping[str, Body],
    *,
    flow: Flow | None = None,
    tolerance: float = TOLERANCE,
) -> CoupledEquilibrium:
    """Find the poses in which bodies and network are in equilibrium [eq:coupled-newton-euler].

    Weight, buoyancy, pulls and steady current act. Newton's method on the poses, the network in equilibrium for each,
    and down the energy where it is no bowl, so that a balance on a tip is left; a body alone that nothing holds in a
    direction stays where it is in that direction.

    Parameters
    ----------
    network : Network
        Carried points at the places that the bodies give them.
    bodies : mapping of str to RigidBody
        By the names that results give them.
    flow : Flow, optional
        Its steady current acts, waves are left out.
    tolerance : float
        Force left over the largest force at work.

    Returns
    -------
    CoupledEquilibrium
        The bodies and the network in equilibrium, tensions [N], shape (m,), and what is left of the balance.

    Raises
    ------
    InputError
        For a planar body, whose equilibrium is known already.
    ConvergenceError
        When no equilibrium is found; names the body and what is left.

    Examples
    --------
    >>> from moyai.coupled import RigidBody, box_hull, find_coupled_equilibrium
    >>> from moyai.flexible import BarType, NetworkBuilder
    >>> from moyai.sea import Water
    >>> hull = box_hull((4.0, 4.0, 2.0), bottom=-1.0, columns=(2, 2))
    >>> eye = {"eye": (0.0, 0.0, -1.0)}
    >>> body = RigidBody("float", 16400.0, (3e4, 3e4, 5e4), (0.0, 0.0, -0.3), points=eye, lumps=hull)
    >>> builder = NetworkBuilder(Water(depth=10.0, density=1025.0, gravity=9.81))
    >>> builder.fixed("anchor", (0.0, 0.0, -10.0))
    >>> builder.driven("eye", body.points_at_start["eye"])
    >>> rope = BarType("rope", mass_per_length=1.0, axial_stiffness=1e6, diameter=0.03)
    >>> builder.line("line", "anchor", "eye", rope, length=8.9, segments=4)
    >>> found = find_coupled_equilibrium(builder.build(), {"float": body})
    >>> found.residual < 1e-6, round(float(found.tension.max()) / 1000.0, 1)   # [kN]
    (True, 6.6)
    """
    check_network(network)
    for name, body in bodies.items():
        if not isinstance(body, RigidBody):
            raise InputError(
                f"body {name!r} is planar: its equilibrium is known", parameter=f"bodies.{name}", allowed="rigid bodies"
            )
    calm = Flow() if flow is None else Flow(flow.velocity, flow.current)
    search = _NewtonSearch(network, {name: body for name, body in bodies.items() if isinstance(body, RigidBody)}, calm)
    return search.run(tolerance)


class _NewtonSearch:
    """Newton's method with a line search; sizes and signs in one place."""

    def __init__(self, network: Network, bodies: dict[str, RigidBody], calm: Flow) -> None:
        self.network, self.bodies, self.calm = network, bodies, calm
        self.carriers = {name: body.carrier(network.water, Flow()) for name, body in bodies.items()}
        self.names = [point for carrier in self.carriers.values() for point in carrier.points]
        self.state: State | None = None
        self.solves = 0
        self.scale = max(
            [body.mass * network.water.gravity for body in bodies.values()]
            + [float(np.max(np.abs(np.asarray(body.force)[:3]))) for body in bodies.values()]
        )
        arms = [float(np.max(np.abs(c.arms), initial=0.0)) for c in self.carriers.values()]
        lumps = [float(np.max(np.abs(c.lumps[0]), initial=0.0)) for c in self.carriers.values()]
        self.size = max(*arms, *lumps, 1e-3)
        self.last: tuple[Network, Equilibrium] | None = None

    def imbalance(self) -> Array:
        """Return forces [N] and moments over the size of the body [N] left on all bodies."""
        places = {}
        for carrier in self.carriers.values():
            places.update(dict(zip(carrier.points, carrier.place_and_velocity()[0], strict=True)))
        self.above_the_bed(places)
        network = moved_network(self.network, places) if places else self.network
        rest = solve_equilibrium(network, flow=self.calm, start=self._start(network))
        self.solves += 1
        self.last = (network, rest)
        self.state = rest.state
        pulls = point_pulls(network, rest.state, self.names, self.calm)
        self.scale = max(self.scale, float(np.max(np.abs(pulls), initial=0.0)))
        out, first = [], 0
        for carrier in self.carriers.values():
            count = len(carrier.points)
            force = carrier.imbalance(pulls[first : first + count], math.inf, self.calm)
            force[3:] /= self.size
            out.append(force)
            first += count
        return np.concatenate(out) if out else np.zeros(0)

    def _start(self, network: Network) -> State | None:
        if self.state is None:
            return None
        position = self.state.position.copy()
        fixed = network.nodes.kind != 0
        position[fixed] = network.nodes.position[fixed]
        return State(0.0, position, np.zeros_like(position))

    def move(self, change: Array) -> None:
        for row, carrier in enumerate(self.carriers.values()):
            # what is held stays: along the axes of the site, about those of the body
            free, turn = carrier.free, carrier.rotation
            part = np.array(change[6 * row : 6 * row + 6])
            part[:3] *= free[:3]
            part[3:] = turn @ (free[3:] * (turn.T @ part[3:])) / self.size
            for axis in range(6):
                if part[axis] != 0.0:
                    carrier.displace(axis, float(part[axis]))

    def keep(self) -> list[Array]:
        return [carrier.state.copy() for carrier in self.carriers.values()]

    def back(self, kept: list[Array]) -> None:
        for carrier, state in zip(self.carriers.values(), kept, strict=True):
            carrier.state[:] = state

    def above_the_bed(self, places: Mapping[str, Array]) -> None:
        """Stop where a body is on its way through the bed, which carries lines and no bodies."""
        bed = self.network.bed
        if bed is None:
            return
        for name, carrier in self.carriers.items():
            own = np.array([carrier.position, *(places[point] for point in carrier.points)])
            level = bed.level_at(own)
            worst = int(np.argmin(own[:, 2] - level))
            if own[worst, 2] < level[worst] - max(1e-9, bed.tolerance):
                raise ConvergenceError(
                    f"no equilibrium found: body {name!r} sinks through the bed at z = {level[worst]:.4g} m, where "
                    "no equilibrium of bodies is sought",
                    remedy="check its mass and its volume; only lines from above can hold a body that is heavier than "
                    "water",
                )

    def jacobian(self, base: Array) -> Array:
        count, step = base.size, 1e-5 * self.size
        out, kept, state = np.zeros((count, count)), self.keep(), self.state
        for column in range(count):
            change = np.zeros(count)
            change[column] = step
            ends = []
            for sign in (1.0, -1.0):
                self.move(sign * change)
                ends.append(self.imbalance())
                self.back(kept)
                self.state = state
            out[:, column] = (ends[0] - ends[1]) / (2.0 * step)
        return out

    def run(self, tolerance: float) -> CoupledEquilibrium:
        force = self.imbalance()
        longest = 0.25 * max(self.size, 0.02 * float(np.max(np.ptp(self.network.nodes.position, axis=0))))
        tips = 0
        slope, exact = self.jacobian(force), True
        for _ in range(MOST_ROUNDS):
            settled = float(np.max(np.abs(force), initial=0.0)) <= tolerance * self.scale
            if settled and tips == MOST_TIPS:
                break
            values, shapes, none, loose = self._stiffness(slope, force, tolerance)
            if not exact and (settled or loose):
                # stability is judged by a slope of this very place
                slope, exact = self.jacobian(force), True
                values, shapes, none, loose = self._stiffness(slope, force, tolerance)
            if loose:
                if settled:
                    # balanced on a tip: a push along the way it falls
                    tips += 1
                    self.move(0.1 * longest * shapes[:, 0])
                    force = self.imbalance()
                force = self._down(force, values, shapes, none, longest)
                slope, exact = self.jacobian(force), True
                continue
            if settled:
                break
            # what nothing holds has no stiffness: the least step that balances the rest
            change = -np.linalg.lstsq(slope, force, rcond=1e-9)[0]
            change *= min(1.0, longest / max(float(np.max(np.abs(change))), 1e-300))
            kept, state, part = self.keep(), self.state, 1.0
            while True:
                self.move(np.asarray(part * change, dtype=np.float64))
                new = self.imbalance()
                if float(np.linalg.norm(new)) < float(np.linalg.norm(force)) * (1.0 - 1e-4 * part) or part < 1e-3:
                    break
                self.back(kept)
                self.state, part = state, 0.5 * part
            step = part * change
            missed = new - force - slope @ step
            if float(np.linalg.norm(missed)) <= GOOD * float(np.linalg.norm(slope @ step)):
                # Broyden's update: a slope costs twelve solves of the network a body
                slope, exact = slope + np.outer(missed, step) / float(step @ step), False
            else:
                slope, exact = self.jacobian(new), True
            force = new
        # the slope was taken next to the rest: network and bodies are put back together
        force = self.imbalance()
        left = float(np.max(np.abs(force), initial=0.0)) / self.scale
        if not left <= max(tolerance, 1e-6):
            worst = list(self.bodies)[int(np.argmax(np.abs(force))) // 6]
            raise ConvergenceError(
                f"no equilibrium found: {left * self.scale:.3g} N are left on body {worst!r}",
                remedy="start nearer to equilibrium, or check weight, buoyancy and lines of the body",
            )
        network, rest = self.last if self.last is not None else (self.network, None)
        if rest is None:
            raise ConvergenceError("no body to find the equilibrium of")
        bodies = {name: self._rested(self.bodies[name], carrier) for name, carrier in self.carriers.items()}
        state = State(0.0, rest.state.position, np.zeros_like(rest.state.position))
        return CoupledEquilibrium(network, state, bodies, rest.tension, left, self.solves)

    def _stiffness(self, slope: Array, force: Array, tolerance: float) -> tuple[Array, Array, float, bool]:
        """Return stiffnesses with their shapes, the one below which there is none, and whether there is no bowl."""
        values, shapes = np.linalg.eigh(-0.5 * (slope + slope.T))
        none = SLACK * max(float(np.max(np.abs(values), initial=0.0)), self.scale / self.size)
        pushed = (values <= none) & (np.abs(shapes.T @ force) > tolerance * self.scale)
        return values, shapes, none, bool(np.any(pushed) or np.any(values < -none))

    def _down(self, force: Array, values: Array, shapes: Array, none: float, longest: float) -> Array:
        """Move down the energy where it is no bowl, by Newton's step with all stiffness positive; return the force."""
        push = shapes.T @ force
        push[(np.abs(values) <= none) & (np.abs(push) <= TOLERANCE * self.scale)] = 0.0
        change = shapes @ (push / np.maximum(np.abs(values), none))
        change *= min(1.0, longest / max(float(np.max(np.abs(change))), 1e-300))
        kept, state, part = self.keep(), self.state, 1.0
        while True:
            self.move(np.asarray(part * change, dtype=np.float64))
            new = self.imbalance()
            # the force along the way may fade and turn a little, not push back as hard
            if float(new @ change) > -0.5 * float(force @ change) or part < 1e-3:
                return new
            self.back(kept)
            self.state, part = state, 0.5 * part

    @staticmethod
    def _rested(body: RigidBody, carrier: RigidCarrier) -> RigidBody:
        """Return the body at its rest; springs and coefficients keep the pose that they were given for."""
        return replace(
            body,
            position=carrier.position,
            rotation=roll_pitch_yaw(carrier.rotation),
            equilibrium=body.equilibrium_pose,
        )
