"""Rigid bodies hung in a network: their plans, their rest, their runs through time."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from moyai.core.errors import ConvergenceError, InputError
from moyai.core.options import checks_words
from moyai.core.progress import Progress
from moyai.coupled.assembly import BodyAssembly, RodPart, VolumePart
from moyai.coupled.bodies import BodyHistory, BodyState
from moyai.coupled.equilibrium import CoupledEquilibrium, find_coupled_equilibrium
from moyai.coupled.hulls import box_hull, cylinder_hull
from moyai.coupled.rigid import RigidBody
from moyai.coupled.simulate import CoupledHistory, simulate_coupled
from moyai.coupled.wave_loads import WaveLoads
from moyai.flexible.flow import Flow
from moyai.flexible.network import Network
from moyai.flexible.refine import more_viscous, with_viscosity
from moyai.flexible.result import History, State
from moyai.flexible.sensitivity import PeakSensitivity, refined_start
from moyai.mooring.rotations import rotation_matrix
from moyai.sea.water import Water
from moyai.structures.network.coefficients import BodyCoefficients

if TYPE_CHECKING:
    from moyai.structures.network.model import NetworkProblem

Triple = tuple[float, float, float]


@checks_words
@dataclass(frozen=True)
class BodyPlan:
    """A box, an upright cylinder (their axes start at the middle), or an assembly of rods and volumes in its axes."""

    name: str
    shape: Literal["box", "cylinder", "assembly"]
    #: Along its axes; of a cylinder diameter, diameter, height [m].
    size: Triple
    #: Of an assembly without its parts [kg].
    mass: float
    #: About the centre of gravity, roll, pitch, yaw [kg m2].
    inertia: Triple
    #: From the middle [m].
    centre_of_gravity: Triple
    #: Of the middle at the start, z above still water [m].
    position: Triple
    #: Roll, pitch, yaw at the start [rad].
    rotation: Triple
    #: Points that lines meet, from the middle [m].
    points: Mapping[str, Triple]
    #: Coefficients along its axes [-].
    drag: Triple
    #: Coefficients along its axes [-].
    added_mass: Triple
    #: Along and about its axes [N s/m, N m s].
    linear_damping: tuple[float, ...] = (0.0,) * 6
    #: Surge, sway, heave, roll, pitch, yaw.
    free: tuple[bool, ...] = (True,) * 6
    #: Of an assembly.
    parts: tuple[RodPart | VolumePart, ...] = ()
    #: Place in its axes that stays where it is at the start [m].
    pin: Triple | None = None
    #: Drag coefficient times area times arm squared about its axes [m5].
    turning_drag: Triple = (0.0, 0.0, 0.0)
    #: File with the loads of the waves on it in place of ``added_mass``.
    coefficients: BodyCoefficients | None = None
    #: What was read from there.
    loads: WaveLoads | None = None

    def body(self, water: Water) -> RigidBody:
        """Return the body of :mod:`moyai.coupled`.

        Raises
        ------
        InputError
            For an assembly without mass or inertia, and for rods that lean from its axes.
        """
        if self.shape == "assembly":
            return self._assembled(water)
        bottom = -0.5 * self.size[2]
        if self.shape == "box":
            lumps = box_hull(
                self.size, bottom=bottom, drag=self.drag, added_mass=self.added_mass, density=water.density
            )
        else:
            lumps = cylinder_hull(
                self.size[0], self.size[2], bottom=bottom, drag=(self.drag[0], self.drag[2]),
                added_mass=(self.added_mass[0], self.added_mass[2]), density=water.density,
            )  # fmt: skip
        if self.loads is not None:
            # buoyancy and inertia of the water come with the coefficients; drag stays
            lumps = replace(lumps, volume=np.zeros(len(lumps)), added_mass=np.zeros((len(lumps), 3)))
        return RigidBody(
            self.name, self.mass, np.array(self.inertia), np.array(self.centre_of_gravity), np.array(self.position),
            np.array(self.rotation), dict(self.points), lumps, linear_damping=np.array(self.linear_damping),
            loads=self.loads, free=self.free, pin=self.pin,
        )  # fmt: skip

    def _assembled(self, water: Water) -> RigidBody:
        made = BodyAssembly(water.density)
        made.add_mass(self.mass, self.centre_of_gravity, np.diag(self.inertia))
        for part in self.parts:
            made.add(part, self.name)
        turning = 0.5 * water.density * np.array(self.turning_drag)
        return made.body(
            self.name, self.position, rotation_matrix(self.rotation),
            {name: np.array(place) for name, place in self.points.items()},
            linear_damping=np.array(self.linear_damping), quadratic_damping=np.concatenate([np.zeros(3), turning]),
            free=self.free, pin=self.pin,
        )  # fmt: skip


def drawn_parts(bodies: Sequence[BodyPlan]) -> dict[str, tuple[Any, ...]]:
    """Return rods and volumes of assembled bodies as cylinders from end to end, for drawing."""
    rows: list[tuple[int, list[float], list[float], float]] = []
    for number, body in enumerate(bodies):
        for part in body.parts:
            if isinstance(part, RodPart):
                rows.append((number, list(part.start), list(part.end), part.diameter))
            elif part.volume > 0.0:
                # a volume as the cylinder that is as high as it is broad
                x, y, z = part.place
                broad = (4.0 * part.volume / math.pi) ** (1.0 / 3.0)
                rows.append((number, [x, y, z - 0.5 * broad], [x, y, z + 0.5 * broad], broad))
    if not rows:
        return {}
    owner, start, end, diameter = zip(*rows, strict=True)
    return {
        "solid_part_solid": ("solid_part", np.array(owner), {"units": "1", "long_name": "body of the part"}),
        "solid_part_start": (
            ("solid_part", "axis"), np.array(start), {"units": "m", "long_name": "one end, in axes of the body"}
        ),
        "solid_part_end": (
            ("solid_part", "axis"), np.array(end), {"units": "m", "long_name": "other end, in axes of the body"}
        ),
        "solid_part_diameter": ("solid_part", np.array(diameter), {"units": "m", "long_name": "diameter of the part"}),
    }  # fmt: skip


def rest_of(problem: NetworkProblem, network: Network, flow: Flow) -> CoupledEquilibrium:
    """Return network and bodies at rest.

    Raises
    ------
    ConvergenceError
        When there is no rest.
    """
    bodies = {plan.name: plan.body(network.water) for plan in problem.bodies}
    return find_coupled_equilibrium(network, bodies, flow=flow)


@dataclass(frozen=True, eq=False)
class CoupledRun:
    """A run of bodies and network."""

    #: Of the network, as that of any network.
    history: History
    bodies: Mapping[str, BodyHistory]
    #: Where the bodies end.
    ends: Mapping[str, BodyState]
    #: Of the bodies [s].
    step: float


def _start(
    problem: NetworkProblem, network: Network, rest: CoupledEquilibrium | None
) -> tuple[dict[str, RigidBody], State, Network]:
    if rest is None:
        bodies = {plan.name: plan.body(network.water) for plan in problem.bodies}
        return bodies, State.at_rest(network), network
    return dict(rest.bodies), rest.state, rest.network


def run_coupled(
    problem: NetworkProblem,
    network: Network,
    rest: CoupledEquilibrium | None,
    progress: Progress,
    left: tuple[State, Mapping[str, BodyState]] | None = None,
    **options: Any,
) -> CoupledRun:
    """Run bodies and network through time, from rest or from where an earlier run left them.

    ``options`` are those of :func:`moyai.coupled.simulate.simulate_coupled`.

    Raises
    ------
    InputError
        When the earlier run had other bodies.
    """
    bodies, start, placed = _start(problem, network, rest)
    if left is not None:
        start, states = left
        if set(states) != set(bodies):
            raise InputError(
                f"the earlier result has the bodies {', '.join(states) or 'none'}, this network "
                f"{', '.join(bodies)}", parameter="settings.resume", allowed="a result of the same network",
            )  # fmt: skip
        flow = options.get("flow") or Flow()
        options["carriers"] = {
            name: state.carrier(bodies[name], placed.water, flow, start.time) for name, state in states.items()
        }
    found = simulate_coupled(placed, bodies, start=start, progress=progress, **options)
    return CoupledRun(_as_history(placed, found), found.bodies, found.final_bodies, found.body_step)


def _as_history(network: Network, found: CoupledHistory) -> History:
    record, rows = found.network, found.time.size
    return History(
        network, found.time, record.nodes, record.bars, record.position[:rows], record.tension[:rows],
        record.tension_peak[:rows], record.kinetic_energy[:rows], record.elastic_energy[:rows], record.work[:rows],
        found.final, "explicit, with bodies", found.network_step, found.network_steps,
        found.status, found.message, found.checks, found.notices,
    )  # fmt: skip


def coupled_sensitivity(
    problem: NetworkProblem,
    network: Network,
    rest: CoupledEquilibrium | None,
    bar: int,
    after: float,
    peak: float,
    steps: tuple[float, float],
    progress: Progress,
    rest_flow: Flow | None,
    **options: Any,
) -> PeakSensitivity:
    """Run bodies and network with half of both steps, half the bars, half and twice the viscosity.

    ``steps`` are those of the run, of network and bodies [s], ``rest_flow`` that in which the start is at rest;
    ``options`` are those of :func:`moyai.coupled.simulate.simulate_coupled`.

    Raises
    ------
    ConvergenceError
        When one of the runs had to stop.
    """
    bodies, start, placed = _start(problem, network, rest)
    last = any(strand.bars[-1] == bar and strand.bars.size > 1 for strand in placed.strands)
    finer, state = refined_start(placed, 2, start, rest_flow)
    # a step given by hand is as long as the given mesh bears at most
    shorter = {} if options.get("step") is None else {"step": 0.5 * options["step"]}
    cases: tuple[tuple[str, Network, State, int, dict[str, Any]], ...] = (
        ("half the step", placed, start, bar, {"step": 0.5 * steps[0], "body_step": 0.5 * steps[1]}),
        ("half the mesh", finer, state, 2 * bar + (1 if last else 0), shorter),
        ("half the viscosity", with_viscosity(placed, 0.5), start, bar, {}),
        ("twice the viscosity", more_viscous(placed), start, bar, {}),
    )
    peaks = []
    for number, (which, mesh, begin, chosen, changed) in enumerate(cases):
        progress("sensitivity", number + 1, 5)
        found = simulate_coupled(
            mesh, bodies, start=begin, keep_nodes=[0], keep_bars=[chosen], **{**options, **changed}
        )
        if found.status == "interrupted":
            raise KeyboardInterrupt
        if found.status != "converged":
            raise ConvergenceError(f"run with {which}: {found.message}", parameter="sensitivity")
        late = found.time >= found.time[0] + after
        peaks.append(float(np.max(found.network.tension_peak[: found.time.size][late, 0])))
    progress("sensitivity", 5, 5)
    half, mesh_peak, less, more = peaks
    return PeakSensitivity(peak, half, mesh_peak, less, more, steps[0])
