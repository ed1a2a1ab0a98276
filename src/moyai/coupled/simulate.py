"""Bodies and a network through time: every step of the bodies is many steps of the network, until both agree."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.attachment import PointCarrier
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.options import checks_words
from moyai.core.progress import Progress, silent
from moyai.core.validity import IdentityCheck, Notice
from moyai.coupled.bodies import Body, BodyHistory, BodyLog, BodyState, check_points
from moyai.coupled.joint import Joint
from moyai.coupled.pace import choose_body_step, steps_at_the_pace
from moyai.coupled.planar_march import PlanarMarch
from moyai.coupled.rigid import RigidCarrier
from moyai.flexible.explicit import LOAD_STEPS
from moyai.flexible.flow import Flow
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network, check_network
from moyai.flexible.result import State
from moyai.flexible.simulation import ENERGY_STOP, ENERGY_TOLERANCE
from moyai.flexible.stepping import SteppedNetwork, StepRecord

Status = Literal["converged", "not_converged", "interrupted"]

#: Disagreement of the reaction that is left to the next step, over the largest reaction so far.
TOLERANCE = 1e-4


@checks_words
@dataclass(frozen=True, eq=False)
class CoupledHistory:
    """Bodies and their network through time; rows are the same for both."""

    #: [s]; shape (k,).
    time: Array
    bodies: Mapping[str, BodyHistory]
    #: Positions, tensions and peaks.
    network: StepRecord
    #: Largest step of the bodies [s].
    body_step: float
    #: Smallest step of the network [s].
    network_step: float
    #: Runs of the network per step of the bodies, on average.
    passes: float
    #: Of the network at the last row.
    final: State
    #: Of the rigid bodies at the last row.
    final_bodies: Mapping[str, BodyState]
    status: Status
    message: str
    checks: tuple[IdentityCheck, ...] = ()
    notices: tuple[Notice, ...] = ()
    #: Accepted steps of the network.
    network_steps: int = 0


def simulate_coupled(
    network: Network,
    bodies: Mapping[str, Body],
    *,
    duration: float,
    output_step: float,
    flow: Flow | None = None,
    motions: Mapping[str, Motion] | None = None,
    start: State | None = None,
    body_step: float | None = None,
    step: float | None = None,
    safety: float | None = None,
    load_steps: int = LOAD_STEPS,
    tolerance: float = TOLERANCE,
    keep_nodes: ArrayLike | None = None,
    keep_bars: ArrayLike | None = None,
    carriers: Mapping[str, PointCarrier] | None = None,
    progress: Progress = silent,
) -> CoupledHistory:
    """Run bodies on a network through time [eq:coupled-newton-euler].

    Parameters
    ----------
    network : Network
        Its points that bodies carry are driven points of the same names, at the places that the bodies give them.
    bodies : mapping of str to RigidBody or PlanarBody
        By the names that results give them.
    duration, output_step : float
        Length of the run and spacing of its rows [s]; peaks of tension are taken at every small step all the same.
    flow : Flow, optional
        Current and waves, around the network and around the bodies; still water when left out.
    motions : mapping of str to Motion, optional
        Of driven points that no body carries.
    start : State, optional
        Of the network, for instance from :func:`moyai.coupled.find_coupled_equilibrium`; as built when left out.
    body_step : float, optional
        Longest step of the bodies [s]; chosen from waves, restoring and lines when left out.
    step, safety, load_steps
        Of the network, as in :func:`moyai.flexible.simulation.simulate`.
    tolerance : float
        Disagreement of the reaction at which a step is accepted, over the largest reaction so far. What is left is
        handed on to the next step, so that no impulse is lost [eq:coupled-carry].
    keep_nodes, keep_bars : array_like of int, optional
        What the record of the network holds.
    carriers : mapping of str to PointCarrier, optional
        Bodies that move already (a run that continues, a velocity at the start), in place of fresh ones.
    progress : Progress
        Called with the simulated time.

    Returns
    -------
    CoupledHistory
        With status ``not_converged`` and all rows up to there when the run had to stop.

    Raises
    ------
    InputError
        For points that do not fit, motions that are missing, and numbers out of range.

    Examples
    --------
    >>> from moyai.coupled import RigidBody, simulate_coupled
    >>> from moyai.flexible import BarType, NetworkBuilder
    >>> from moyai.sea import Water
    >>> eye = {"eye": (0.0, 0.0, 0.0)}
    >>> body = RigidBody("weight", 500.0, (50.0, 50.0, 50.0), position=(0.0, 0.0, -5.0), points=eye)
    >>> builder = NetworkBuilder(Water(depth=10.0, density=1025.0, gravity=9.81))
    >>> builder.fixed("top", (0.0, 0.0, 0.0))
    >>> builder.driven("eye", body.points_at_start["eye"])
    >>> rope = BarType("rope", mass_per_length=1.0, axial_stiffness=1e6, diameter=0.03)
    >>> builder.line("line", "top", "eye", rope, length=5.0, segments=4)
    >>> found = simulate_coupled(builder.build(), {"weight": body}, duration=0.2, output_step=0.05)
    >>> found.status, found.bodies["weight"].position.shape              # rows, axes [m]
    ('converged', (5, 3))
    """
    check_network(network)
    for name, value in (("duration", duration), ("output_step", output_step)):
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name.replace('_', ' ')} is {value:g} s", parameter=name, allowed="greater than 0")
    if body_step is not None and not body_step > 0.0:
        raise InputError(f"step of the bodies is {body_step:g} s", parameter="body_step", allowed="greater than 0")
    if not 0.0 < tolerance < 1.0:
        raise InputError(f"tolerance is {tolerance:g}", parameter="tolerance", allowed="above 0, below 1")
    if any(kind.slow is not None for kind in network.bars.types):
        raise InputError(
            "ropes with creep are not run together with bodies", parameter="bodies",
            remedy="leave the slow stretch out: the quick stiffness holds in waves, the static one for slow offsets",
        )  # fmt: skip
    flow, start = flow or Flow(), start or State.at_rest(network)
    check_points(network, bodies, carriers or {}, start)
    moving = {
        name: (carriers or {}).get(name) or body.carrier(network.water, flow, start.time)
        for name, body in bodies.items()
    }
    rows = max(1, round(duration / output_step))
    interval = duration / rows
    notices: list[Notice] = []
    if body_step is None:
        body_step, notice = choose_body_step(network, bodies, moving, flow)
        notices.append(notice)
    per_row = max(1, math.ceil(interval / body_step * (1.0 - 1e-9)))
    names = [point for carrier in moving.values() for point in carrier.points]
    velocity = np.concatenate([np.zeros((0, 3)), *(carrier.place_and_velocity()[1] for carrier in moving.values())])
    stepped = SteppedNetwork(
        network, names, motions=motions, flow=flow, start=start, velocity=velocity, step=step, safety=safety,
        load_steps=load_steps, keep_nodes=keep_nodes, keep_bars=keep_bars,
    )  # fmt: skip
    if safety == 1.0 and step is None:
        per_row, reported = steps_at_the_pace(interval, per_row, stepped.run.limit()[0])
        notices.extend(reported)
    joint = Joint(list(moving.values()), stepped, tolerance, least=1e-3 * _least_weight(moving, network))
    logs = {name: BodyLog(bodies[name], moving[name]) for name in bodies}
    ending = _drive(joint, stepped, logs, start.time, interval, rows, per_row, network, progress)
    return _history(joint, stepped, logs, interval / per_row, ending, tuple(notices))


@dataclass
class _Ending:
    """How a run ended, and the last row that it may go on from."""

    state: State
    bodies: dict[str, BodyState]
    status: Status = "converged"
    message: str = ""

    @classmethod
    def at(cls, stepped: SteppedNetwork, logs: Mapping[str, BodyLog]) -> _Ending:
        moving = {name: log.carrier for name, log in logs.items()}
        return cls(
            stepped.state(),
            {name: BodyState.of(carrier) for name, carrier in moving.items() if isinstance(carrier, RigidCarrier)},
        )


def _drive(
    joint: Joint,
    stepped: SteppedNetwork,
    logs: Mapping[str, BodyLog],
    begin: float,
    interval: float,
    rows: int,
    per_row: int,
    network: Network,
    progress: Progress,
) -> _Ending:
    """Take all steps; return how it ended."""
    start, ending = stepped.energy, _Ending.at(stepped, logs)
    throughput = 1e-12 * float(np.sum(network.bars.of_type("axial_stiffness") * network.bars.length)) + 1e-12
    for log in logs.values():
        log.keep(joint)
    march = PlanarMarch.where_possible(joint, stepped, [*logs.values()], interval, rows) if per_row == 1 else None
    row = 0
    try:
        while row < rows:
            taken = march.advance(row) if march is not None else 0
            if taken == 0:
                for part in range(1, per_row + 1):
                    joint.advance(begin + row * interval + part * interval / per_row)
                stepped.keep_row()
                for log in logs.values():
                    log.keep(joint)
            row += max(taken, 1)
            energy = stepped.energy
            kinetic = sum(log.kinetic_energy for log in logs.values())
            throughput = max(throughput, energy[0] + energy[1], abs(energy[2]), joint.work, kinetic)
            gain = (energy[0] + energy[1]) - (start[0] + start[1]) - (energy[2] - start[2])
            if not gain <= ENERGY_STOP * throughput:
                ending.status = "not_converged"
                ending.message = (
                    f"stopped at t = {begin + row * interval:g} s: energy balance error of {gain:.3g} J in the "
                    "network; more viscosity of the bars or a smaller step calms it"
                )
                break
            if march is None:
                # bodies and network of one instant, whatever interrupts the next step
                ending = _Ending.at(stepped, logs)
            progress("bodies and network", row * interval, rows * interval)
    except KeyboardInterrupt:
        time = ending.state.time if march is None else stepped.time
        ending.status, ending.message = "interrupted", f"interrupted at t = {time:g} s"
    except ConvergenceError as error:
        ending.status = "not_converged"
        ending.message = f"stopped at t = {stepped.time:g} s: {error.fault.message}"
        if error.fault.remedy:
            ending.message += f"; {error.fault.remedy}"
    if march is not None:
        # a planar body has no state to go on from: that of the network is made once
        ending.state = stepped.state()
    return ending


def _least_weight(carriers: Mapping[str, PointCarrier], network: Network) -> float:
    """Return the weight of the lightest body [N]."""
    masses = [float(carrier.body_mass) for carrier in carriers.values() if hasattr(carrier, "body_mass")]
    return min(masses, default=0.0) * network.water.gravity


def _history(
    joint: Joint,
    stepped: SteppedNetwork,
    logs: Mapping[str, BodyLog],
    body_step: float,
    ending: _Ending,
    notices: tuple[Notice, ...],
) -> CoupledHistory:
    record = stepped.record()
    total = record.kinetic_energy + record.elastic_energy
    gain = float(np.max(total - total[0] - (record.work - record.work[0])))
    through = max(float(np.max(total)), float(np.max(np.abs(record.work))), joint.work, 1e-12)
    checks = (
        IdentityCheck(
            "energy balance error of the network", max(gain, 0.0) / through, ENERGY_TOLERANCE,
            "rise of kinetic and elastic energy beyond the work done, over the energy that went through",
        ),
        IdentityCheck(
            "impulse between bodies and network", joint.lost_impulse, 10.0 * joint.tolerance,
            "difference of the impulses given and taken, over the largest reaction times a step",
        ),
        IdentityCheck(
            "work between bodies and network", joint.lost_work, 1e-2,
            "difference of the work given and taken at the points, over the work exchanged",
        ),
    )  # fmt: skip
    size = min(log.count for log in logs.values()) if logs else record.time.size
    return CoupledHistory(
        record.time[:size],
        {name: log.history(size) for name, log in logs.items()},
        record,
        body_step,
        stepped.smallest,
        joint.passes / max(joint.steps, 1),
        ending.state,
        ending.bodies,
        ending.status,
        ending.message,
        checks,
        (*notices, *stepped.notices(record, checks[0], ending.status == "converged")),
        stepped.steps,
    )


__all__: Sequence[str] = ("CoupledHistory", "simulate_coupled")
