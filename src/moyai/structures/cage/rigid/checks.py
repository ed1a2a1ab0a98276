"""Checks of a rigid cage: identities of its rest and runs, and the ranges of what it rests on."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array
from moyai.core.validity import IdentityCheck, Notice
from moyai.sea.water import Water
from moyai.structures.cage.rigid.lines import CageLine
from moyai.structures.cage.rigid.literal import FAULTS
from moyai.structures.cage.rigid.model import RigidCageProblem
from moyai.structures.cage.rigid.parts import RigidCage
from moyai.structures.cage.rigid.runs import RigidCageRun
from moyai.structures.cage.rigid.setup import drowning_depth
from moyai.structures.cage.rigid.statics import RigidCageEquilibrium, reserve_buoyancy
from moyai.structures.cage.rigid.waves import current_along, theory_limit

#: Size of the cage over the wavelength above which its net and floats no longer leave the wave as it is
LARGEST_CAGE = 0.5


def mass_checks(cage: RigidCage) -> tuple[IdentityCheck, ...]:
    """Compare the mass of the parts with the whole."""
    parts = (
        cage.floats.mass * len(cage.floats.points)
        + cage.net_mass * cage.patches.area
        + sum(rod.mass for rod in cage.rods)
        + sum(weight.mass for weight in cage.weights)
    )
    return (
        IdentityCheck(
            "mass of the parts", abs(parts / cage.mass - 1.0), 1e-12, "floats + net + frame + weights = cage"
        ),
    )


def rest_checks(
    name: str,
    problem: RigidCageProblem,
    lines: tuple[CageLine, ...],
    water: Water,
    free: RigidCageEquilibrium,
    rest: RigidCageEquilibrium,
) -> tuple[IdentityCheck, ...]:
    """Compare the rest with Archimedes' law, written without the code that found it."""
    found = [IdentityCheck(f"{name}: forces at rest", rest.residual, 1e-8, "weight, buoyancy and lines balance")]
    if problem.environment.current is None and _wholly_wet(problem, rest):
        cage = problem.cage
        lift = reserve_buoyancy(cage, water) - water.gravity * water.density * cage.float_volume * (
            1.0 - rest.immersion
        )
        down = 0.0
        for line, tension in zip(lines, rest.tension):
            px, pz = line.place(rest.place, cage.centre)
            down += float(tension) * (pz - line.anchor[1]) / math.hypot(px - line.anchor[0], pz - line.anchor[1])
        scale = water.gravity * cage.mass
        found.append(
            IdentityCheck(
                f"{name}: Archimedes", abs(lift - down) / scale, 1e-8, "buoyancy - weight = pull of the lines down"
            )
        )
    return tuple(found)


def _wholly_wet(problem: RigidCageProblem, rest: RigidCageEquilibrium) -> bool:
    """Whether net and frame are wholly under water at rest."""
    cage = problem.cage
    top = 0.5 * cage.extent[2] + 0.5 * max((rod.diameter for rod in cage.rods), default=0.0)
    return rest.middle_z + top * math.cos(rest.theta) + 0.5 * cage.extent[0] * abs(math.sin(rest.theta)) <= 0.0


def cage_notices(problem: RigidCageProblem) -> tuple[Notice, ...]:
    """Say what the model leaves out, and where literal equations fail."""
    found = []
    if problem.equations == "literal":
        found.append(
            Notice(
                "literal-equations",
                f"the equations are those in print, with their {len(FAULTS)} errors: no result to design by",
                value=float(len(FAULTS)),
                limit=0.0,
                remedy="use 'equations: sound'",
                source="Matsubara, Noda and Nishihira, equations 3 to 5",
            )
        )
    if not problem.cage.law.confirmed:
        found.append(
            Notice(
                "net-law-unconfirmed",
                f"the net law '{problem.cage.law.name}' was taken from works that use it",
                severity="information",
                remedy="hold it against its source before design use",
                source=problem.cage.law.source,
            )
        )
    return tuple(found)


def level_notices(
    name: str,
    problem: RigidCageProblem,
    lines: tuple[CageLine, ...],
    water: Water,
    free: RigidCageEquilibrium,
    rest: RigidCageEquilibrium,
) -> tuple[Notice, ...]:
    """Tell of drowned floats, a cage near the bed, slack lines at rest, a current that would carry it away."""
    cage = problem.cage
    found = []
    low = rest.middle_z - 0.5 * cage.extent[2]
    if low < -water.depth:
        found.append(
            Notice(
                "cage-on-bed",
                f"{name}: the bottom of the cage at rest is at z = {low:.4g} m, under the bed",
                value=low,
                limit=-water.depth,
                severity="error",
                remedy="a lower cage, or deeper water",
            )
        )
    if rest.immersion > 1.0 - 1e-9 and lines:
        found.append(
            Notice(
                "floats-drowned",
                f"{name}: the lines hold the floats wholly under water at rest; {drowning_depth(cage, free) * 1e3:.3g} "
                "mm are enough for that",
                value=rest.immersion,
                limit=1.0,
                remedy="a smaller pull, or larger floats",
            )
        )
    if not lines and problem.environment.current is not None:
        found.append(
            Notice("cage-drifts", f"{name}: the cage has no lines and drifts with the current", severity="information")
        )
    return tuple(found)


def run_checks(
    name: str, problem: RigidCageProblem, run: RigidCageRun, lines: tuple[CageLine, ...]
) -> tuple[IdentityCheck, ...]:
    """Compare the tensions with the length of the lines, found from the motion without the code that marched it."""
    label = f"{name}, {run.wave.name}"
    state = run.march.state
    found = [IdentityCheck(f"{label}: finite motion", 0.0 if np.isfinite(state).all() else math.nan, 0.5)]
    worst, largest = 0.0, 1e-300
    for n, line in enumerate(lines):
        for row in range(0, len(state), max(1, len(state) // 300)):
            y = state[row]
            span = line.span(y[:3], problem.cage.centre)
            # rate of the span by moving the cage on for an instant
            on = y[:3] + 1e-6 * y[3:]
            rate = (line.span(on, problem.cage.centre) - span) / 1e-6
            stretch = span - line.length
            pull = line.stiffness * stretch + line.damping * rate
            wanted = max(0.0, pull) if stretch > 0.0 else 0.0
            worst = max(worst, abs(wanted - float(run.march.tension[row, n])))
            largest = max(largest, float(run.march.tension[row, n]))
    if lines and largest > 1e-9:
        found.append(
            IdentityCheck(
                f"{label}: law of the lines", worst / largest, 1e-3, "T = max(0, k e + c de/dt) from the motion"
            )
        )
    return tuple(found)


def run_notices(problem: RigidCageProblem, run: RigidCageRun, lines: tuple[CageLine, ...] = ()) -> tuple[Notice, ...]:
    """Compare a run with the range of its net law, the size of the cage, the bed, and breaking loads."""
    cage, wave = problem.cage, run.wave
    found = list(_law_notices(problem, run))
    found += theory_limit(wave, "lower or lengthen the wave, or use 'model: flexible', which covers steep waves")
    size = max(cage.extent)
    if size > LARGEST_CAGE * wave.wavelength:
        found.append(
            Notice(
                "cage-large",
                f"{wave.name}: the cage is {size / wave.wavelength:.2g} of a wavelength large",
                value=size / wave.wavelength,
                limit=LARGEST_CAGE,
                remedy="the motion is computed from water speeds at every part, but the wave is taken as undisturbed",
            )
        )
    roll = float(np.abs(run.march.state[:, 2]).max())
    return (*found, *limit_notices(wave.name, run.numbers.line_tension_maximum, roll, lines))


def limit_notices(name: str, tension: Array, roll: float, lines: tuple[CageLine, ...]) -> tuple[Notice, ...]:
    """Compare highest tensions (lines, ends) [N] with breaking loads, and the largest rotation [rad] with overturning.

    Parameters
    ----------
    name : str
        Of the wave, or the realisation.
    tension : ndarray, shape (lines, ends)
    roll : float
    lines : tuple of CageLine
    """
    found = []
    for n, line in enumerate(lines):
        highest = float(np.max(tension[n]))
        if line.breaking_load is not None and highest > line.breaking_load:
            found.append(
                Notice(
                    "cage-line-breaks",
                    f"{name}: {line.name!r} reaches {highest:.4g} N, its breaking load is "
                    f"{line.breaking_load:.4g} N",
                    highest, line.breaking_load, "warning", "a stronger line or a softer mooring",
                )
            )  # fmt: skip
    if roll > math.radians(60.0):
        found.append(
            Notice(
                "cage-overturns",
                f"{name}: the cage turns by {math.degrees(roll):.3g} degrees",
                value=roll,
                limit=math.radians(60.0),
                severity="error",
                remedy="check centre of gravity and moorings",
                unit="rad",
            )
        )
    return tuple(found)


def _law_notices(problem: RigidCageProblem, run: RigidCageRun) -> tuple[Notice, ...]:
    """Compare the speeds of water past the net with the law: the relative speed at the middle of the cage."""
    state, wave = run.march.state, run.wave
    water = wave.components.water
    assert water is not None
    tail = state[len(state) // 2 :]
    times = run.march.time[len(state) // 2 :]
    step = max(1, len(times) // 400)
    _, velocity, _ = zip(
        *(
            wave.components.kinematics(float(t), np.array([y[0]]), np.zeros(1), np.array([min(y[1], 0.0)]), "constant")
            for t, y in zip(times[::step], tail[::step])
        )
    )
    flow = np.array([item[0] for item in velocity])
    across = flow[:, 0] + current_along(problem, water) - tail[::step, 3]
    upward = flow[:, 2] - tail[::step, 4]
    speed = np.hypot(across, upward)
    fast = float(speed.max())
    typical = float(np.sqrt(np.mean(speed**2)))
    return problem.cage.law.check(problem.cage.net, (typical, fast), problem.kinematic_viscosity)
