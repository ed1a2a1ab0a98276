"""Validation of bodies in networks: exact motions of bodies on light lines, and a body on a heavy one."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from moyai.core.validation import ValidationCase
from moyai.coupled.hulls import box_hull
from moyai.coupled.rigid import RigidBody
from moyai.coupled.simulate import simulate_coupled
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType
from moyai.flexible.flow import Flow
from moyai.mooring.rotations import rotation_matrix
from moyai.sea.water import Water

_AIR = Water(1e3, 1e-9, 9.81)
_SEA = Water(50.0, 1000.0, 9.81)


def _period(time: np.ndarray, motion: np.ndarray) -> float:
    """Return the mean time between up-crossings of the mean [s]."""
    moved = motion - 0.5 * (motion.max() + motion.min())
    rows = np.flatnonzero((moved[:-1] < 0.0) & (moved[1:] >= 0.0))
    cross = time[rows] - moved[rows] * (time[rows + 1] - time[rows]) / (moved[rows + 1] - moved[rows])
    return float(np.mean(np.diff(cross)))


def _hung_period() -> float:
    """Return the period of a body that bobs on a light elastic line over 2 pi sqrt(m / k)."""
    mass, length, stiffness, start = 2.0, 2.0, 400.0, 0.03
    rest = -length * (1.0 + mass * 9.81 / stiffness)
    builder = NetworkBuilder(_AIR)
    builder.fixed("top", (0.0, 0.0, 0.0))
    builder.driven("hook", (0.0, 0.0, rest - start))
    material = BarType("line", 1e-6, stiffness, 1e-3, volume_per_length=0.0)
    builder.line("line", "top", "hook", material, length=length, segments=1, shape="straight")
    body = RigidBody("body", mass, (0.1, 0.1, 0.1), position=(0.0, 0.0, rest - start), points={"hook": (0, 0, 0)})
    history = simulate_coupled(builder.build(), {"body": body}, duration=5.0, output_step=0.01)
    found = _period(history.time, history.bodies["body"].position[:, 2])
    return found / (2.0 * math.pi * math.sqrt(mass * length / stiffness))


def _double_pendulum(mode: int) -> float:
    """Return the period of one mode of a body that hangs on a light line by a point above its centre [s]."""
    length, arm, radius, mass, stiffness = 1.7, 0.3, 0.1, 2.0, 4e4
    inertia = np.array([[length**2, length * arm], [length * arm, arm**2 + radius**2]])
    values, shapes = np.linalg.eig(np.linalg.solve(inertia, np.diag([length, arm]) * 9.81))
    row = int(np.argsort(values)[mode])
    omega, shape = math.sqrt(values[row]), 1e-3 * shapes[:, row] / np.abs(shapes[:, row]).max()
    builder = NetworkBuilder(_AIR)
    builder.fixed("top", (0.0, 0.0, 0.0))
    builder.driven("hook", (0.0, 0.0, -length))
    material = BarType("line", 1e-6, stiffness, 1e-3, volume_per_length=0.0)
    rest = length / (1.0 + mass * 9.81 / stiffness)
    builder.line("line", "top", "hook", material, length=rest, segments=1, shape="straight")
    body = RigidBody(
        "bob", mass, (mass * radius**2,) * 3, position=(0.0, 0.0, -length - arm), points={"hook": (0.0, 0.0, arm)}
    )
    carrier = body.carrier(_AIR)
    speed = -(length * shape[0] + arm * shape[1]) * omega
    carrier.place_body(body.position, np.eye(3), (speed, 0.0, 0.0, 0.0, omega * shape[1], 0.0))
    history = simulate_coupled(
        builder.build(), {"bob": body}, duration=6.0 * math.pi / omega, output_step=math.pi / 50.0 / omega,
        carriers={"bob": carrier}, body_step=math.pi / 100.0 / omega, tolerance=1e-6,
    )  # fmt: skip
    return _period(history.time, history.bodies["bob"].angles[:, 1])


def _double_pendulum_exact(mode: int) -> float:
    length, arm, radius = 1.7, 0.3, 0.1
    inertia = np.array([[length**2, length * arm], [length * arm, arm**2 + radius**2]])
    values = np.linalg.eigvals(np.linalg.solve(inertia, np.diag([length, arm]) * 9.81))
    return 2.0 * math.pi / math.sqrt(float(np.sort(values)[mode]))


def _righting_arm() -> float:
    """Return the righting arm of a box heeled by 12 degrees over that of the wall-sided formula."""
    size, draught, heel = np.array([2.0, 3.0, 1.2]), 0.6, math.radians(12.0)
    mass = 1000.0 * size[0] * size[1] * draught
    body = RigidBody(
        "box", mass, (1e3, 1e3, 1e3), (0.0, 0.0, draught), (0.0, 0.0, -draught),
        lumps=box_hull(size, bottom=0.0, columns=(8, 2)),
    )  # fmt: skip
    carrier = body.carrier(_SEA)
    carrier.displace(4, heel)
    moment = -carrier.imbalance(np.zeros((0, 3)), 0.0, Flow())[4]
    radius = size[0] ** 2 / (12.0 * draught)
    return float(moment / (mass * 9.81 * math.sin(heel) * (radius * (1.0 + 0.5 * math.tan(heel) ** 2) - 0.5 * draught)))


def _spinning_top() -> float:
    """Return the spin momentum of a torque-free top after three turns over that at the start."""
    inertia = np.diag([0.4, 0.9, 1.2])
    body = RigidBody("top", 1.0, inertia, force=(0.0, 0.0, 9.81, 0.0, 0.0, 0.0))
    carrier = body.carrier(_AIR)
    carrier.place_body((0, 0, 0), rotation_matrix((0.3, -0.2, 0.5)), (0, 0, 0, 2.0, 1.5, -1.0))
    first = carrier.rotation @ inertia @ carrier.state[10:13]
    for number in range(1, 1001):
        carrier.try_step(0.01 * number, np.zeros((2, 0, 3)))
        carrier.accept()
    return float(np.linalg.norm(carrier.rotation @ inertia @ carrier.state[10:13] - first) / np.linalg.norm(first))


CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        "coupled: body on an elastic line", "exact: period 2 pi sqrt(m/k)", _hung_period, 1.0, 1e-3,
        note="straight crossings between rows",
    ),
    *(
        ValidationCase(
            f"coupled: double pendulum, {name} mode", "eigenvalues of the double pendulum",
            partial(_double_pendulum, mode), _double_pendulum_exact(mode), 1e-3,
            note="amplitude of a thousandth of a radian; the line stretches",
        )
        for mode, name in enumerate(("slow", "quick"))
    ),
    ValidationCase(
        "coupled: righting arm of a box at 12 degrees", "Scribanti, wall-sided body", _righting_arm, 1.0, 0.01,
        note="eight columns across",
    ),
    ValidationCase(
        "coupled: momentum of a spinning top", "torque-free motion keeps it", _spinning_top, 0.0, 1e-5, relative=False,
        note="ten seconds, a thousand steps of fourth order",
    ),
)  # fmt: skip
