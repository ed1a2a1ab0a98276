"""Flexible cages: elastic rings, panels by their law, grouped twines, straight and yielding cages."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from moyai.core.validation import ValidationCase
from moyai.flexible.bed import Bed
from moyai.flexible.mesh_groups import group_meshes
from moyai.flexible.panels import NetPanels, PanelLaw, forces_on_panels
from moyai.flexible.ring_kernel import ring_forces
from moyai.flexible.rings import Ring, RingArrays
from moyai.morison.net_law_names import Net, net_law
from moyai.morison.net_wake import WakeName
from moyai.sea.current import uniform
from moyai.sea.water import Water
from moyai.structures.cage.flexible.build import build_cage
from moyai.structures.cage.flexible.collar import Collar, Pipe
from moyai.structures.cage.flexible.design import CageDesign, CageNet, Sinkers
from moyai.structures.cage.flexible.equilibrium import horizontal_balance, solve_cage_equilibrium
from moyai.structures.cage.flexible.model import CageMesh, FixedCollar, FlexibleCage

_VISCOSITY = 1.14e-6


def _circle(count: int, radius: float) -> np.ndarray:
    angle = 2.0 * math.pi * np.arange(count) / count
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), 0.0 * angle], axis=1)


def _out_of_plane(count: int) -> float:
    """Return omega^2 m R^4 / EI of the second mode out of the plane, EI / GJ = 1.42."""
    ring = Ring("ring", np.arange(count), _circle(count, 3.0), 50.0, 50.0 / 1.42)
    angle = 2.0 * math.pi * np.arange(count) / count
    place = np.array(ring.rest)
    small = 1e-4
    place[:, 2] += small * np.cos(2.0 * angle)
    force = np.zeros_like(place)
    ring_forces(place, RingArrays.of((ring,)).system, force)
    per_length = -force[0, 2] / (2.0 * math.pi * 3.0 / count) / small
    return float(per_length * 3.0**4 / 50.0)


def _ring_mode() -> float:
    return (4.0 * _out_of_plane(96) - _out_of_plane(48)) / 3.0


def _panel_drag(law: str, solidity: float) -> float:
    """Return the drag coefficient of a square panel across the flow, by the force on its knots."""
    found = net_law(law)
    net = Net.from_solidity(0.002, solidity)
    table = PanelLaw.tabulate(law, lambda angle, speed: found.coefficients(angle, speed, net, _VISCOSITY))
    points = np.array([[0.0, 0.0, -2.0], [0.0, 0.0, -3.0], [0.0, 1.0, -3.0], [0.0, 1.0, -2.0]])
    water = np.zeros((7, 4))
    water[0] = 0.5
    _, each = forces_on_panels(NetPanels(np.array([[0, 1, 2, 3]]), (table,)), points, np.zeros((4, 3)), water, 1000.0)
    return float(each[0, 0] / (0.5 * 1000.0 * 0.25))


def _twine() -> float:
    """Return the length of twine of a grouped net of 7 by 5 panels over twice its area by the pitch."""
    rng = np.random.default_rng(7)
    grid = np.stack(np.meshgrid(np.cumsum(rng.uniform(0.5, 2.0, 6)), np.cumsum(rng.uniform(0.5, 2.0, 8))), -1)
    places = np.concatenate([grid, np.zeros((8, 6, 1))], axis=2).reshape(-1, 3)
    index = np.arange(48).reshape(8, 6)
    corners = np.stack([index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]], -1).reshape(-1, 4)
    area = float(np.prod(np.ptp(places[:, :2], axis=0)))
    return float(group_meshes(corners, places, 0.02).twine_length.sum() * 0.02 / (2.0 * area))


@lru_cache(maxsize=4)
def _towed(speed: float, weight: float, wake: WakeName) -> tuple[float, float, float]:
    """Return drag and pull along the current and volume share of a flume cage of 1.435 m, solidity 0.225."""
    net = Net.from_solidity(0.0018, 0.225)
    design = CageDesign(
        "circular", 1.435, Collar(Pipe(0.1, 0.01, 950.0, 1e9, 0.4, 1.0, 0.1, 1.0), rigid=True),
        CageNet(net, net_law("loland"), wake, 1.44, "none", 1140.0, 2e8), Sinkers(16, weight / 9.81, 0.0),
    )  # fmt: skip
    model = FlexibleCage(
        design, FixedCollar(), Water(2.7, 1000.0, 9.81), Bed(-2.7, 1e5, 1e4, 0.5), CageMesh(32, 6, 3, 0.5), _VISCOSITY
    )
    rest = solve_cage_equilibrium(model, build_cage(model), uniform(speed, 0.0))
    cage = rest.built.cages[0]
    split, pull = horizontal_balance(rest)
    return float(split.sum(axis=0)[0]), float(pull[0]), float(cage.volume(rest.state.position)) / cage.rest_volume


def _stiff() -> float:
    """Return the drag of a straight cage over the integral of the law around it, without shelter."""
    speed = 0.05
    drag, _, _ = _towed(speed, 60.0, "none")
    front, _ = net_law("loland").coefficients(0.0, speed, Net.from_solidity(0.0018, 0.225), _VISCOSITY)
    # C_D = 0.04 + (C_D0 - 0.04) cos, all around a circle
    around = 4.0 * 0.5 * 1.435 * 1.44 * (0.04 * math.pi / 2.0 + (float(front) - 0.04))
    return drag / (0.5 * 1000.0 * speed**2 * around)


def _balance() -> float:
    drag, pull, _ = _towed(0.4, 3.92, "loland")
    return pull / drag


CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        "cage: second mode of a ring out of its plane",
        "Love: n^2 (n^2-1)^2 / (n^2 + EI/GJ), n = 2, EI/GJ = 1.42",
        _ring_mode,
        36.0 / 5.42,
        2e-3,
        note="extrapolated from 48 and 96 nodes",
    ),
    ValidationCase(
        "cage: drag of a panel by its knots, Loland, solidity 0.20",
        "law of the panel, as tabulated in the literature",
        lambda: _panel_drag("loland", 0.20),
        0.2886,
        1e-3,
    ),
    ValidationCase(
        "cage: drag of a panel by its knots, Aarsnes, solidity 0.25",
        "law of the panel, as tabulated in the literature",
        lambda: _panel_drag("aarsnes", 0.25),
        0.3866,
        1e-3,
    ),
    ValidationCase("cage: twine of grouped meshes", "twice the area over the pitch", _twine, 1.0, 1e-9),
    ValidationCase(
        "cage: drag of a cage that hangs straight over the law's own",
        "Loland's C_D integrated around a circle",
        _stiff,
        1.0,
        0.01,
        note="32 flat panels around; heavy weights, slow current",
    ),
    ValidationCase(
        "cage: pull on the collar over drag on the net, 0.4 m/s",
        "equilibrium of a flexible net",
        _balance,
        1.0,
        5e-3,
    ),
)
