"""Validation of flexible networks: struck string, catenary, modes, pendulum, and peaks that two programs agree on."""

from __future__ import annotations

import math
from functools import partial
from typing import Literal

import numpy as np

from moyai.core.validation import ValidationCase
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType
from moyai.flexible.modes import natural_modes
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network
from moyai.flexible.result import State
from moyai.flexible.simulation import simulate
from moyai.flexible.statics import solve_equilibrium
from moyai.mooring.catenary import solve_catenary
from moyai.sea.water import Water

_STILL = Water(math.inf, 1000.0, 1e-12)
_EARTH = Water(math.inf, 1000.0, 9.81)
_DEEP = -500.0
_MOORDYN = "MoorDyn RK2 and RK4 converged over mesh and step, and an independent prototype (within 0.05 %)"


def _struck_string(ratio: float) -> float:
    """Return the peak at the fixed end over V sqrt(EA m) of a string whose end mass, ``ratio`` m L, gets speed V."""
    span, stiffness, mass, segments = 50.0, 2e7, 3.0, 250
    builder = NetworkBuilder(_STILL)
    builder.fixed("wall", (0.0, 0.0, _DEEP))
    builder.free("mass", (span, 0.0, _DEEP), mass=ratio * mass * span)
    builder.line("string", "wall", "mass", BarType("string", mass, stiffness, 1e-9), length=span, segments=segments)
    network = builder.build()
    velocity = np.zeros((len(network.nodes), 3))
    velocity[network.point("mass"), 0] = 1.0
    travel = span / math.sqrt(stiffness / mass)
    start = State(0.0, np.array(network.nodes.position), velocity)
    history = simulate(network, duration=5.0 * travel, output_step=travel, safety=1.0, start=start, keep_bars=[0])
    return float(history.tension_peak.max()) / math.sqrt(stiffness * mass)


def _rope() -> BarType:
    return BarType(
        "steel rope",
        9.0,
        1e8,
        0.04,
        viscosity=1e4,
        drag_normal=1.2,
        drag_tangential=0.02 * math.pi,
        added_mass_normal=1.0,
    )


def _snap() -> float:
    """Return the mean peak [kN] of the rope that goes slack and taut, cycles after 8 s."""
    builder = NetworkBuilder(Water(60.0, 1025.0, 9.81))
    builder.fixed("anchor", (0.0, 0.0, -12.0))
    builder.driven("fairlead", (43.9425, 0.0, -2.0))
    builder.line("rope", "anchor", "fairlead", _rope(), length=46.0, segments=20)
    motion = {"fairlead": Motion.harmonic((1.0, 0.0, 0.0), 4.0, duration=17.0, ramp=4.0)}
    history = simulate(builder.build(), motion, duration=16.0, output_step=0.02, keep_nodes=[0], keep_bars=[19])
    return (
        float(
            np.mean([history.tension_peak[(history.time > a) & (history.time <= a + 4.0)].max() for a in (8.0, 12.0)])
        )
        / 1e3
    )


def _snapmass(cycle: int) -> float:
    """Return the peak [kN] of one cycle of the rope that stops a mass of 5 t."""
    builder = NetworkBuilder(Water(60.0, 1025.0, 9.81))
    builder.fixed("anchor", (0.0, 0.0, -12.0))
    builder.free("mass", (45.9, 0.0, -12.0), mass=5000.0, volume=5000.0 / 1025.0, drag_area=5.0)
    builder.driven("end", (66.5, 0.0, -12.0))
    builder.line("rope", "anchor", "mass", _rope(), length=46.0, segments=20)
    builder.line("spring", "mass", "end", BarType("spring", 1e-3, 4e5, 1e-3, viscosity=2e3), length=20.0, segments=1)
    motion = {"end": Motion.harmonic((3.0, 0.0, 0.0), 6.0, duration=31.0, ramp=6.0)}
    history = simulate(builder.build(), motion, duration=30.0, output_step=0.02, keep_nodes=[0], keep_bars=[19])
    begin = 12.0 + 6.0 * cycle
    return float(history.tension_peak[(history.time > begin) & (history.time <= begin + 6.0)].max()) / 1e3


def _net(knots: int) -> float:
    """Return the highest tension [N] of the first vertical twine of a towed, heaving net, 6 to 12 s."""
    builder = NetworkBuilder(Water(60.0, 1025.0, 9.81))
    twine = BarType(
        "twine",
        0.36,
        2e5,
        0.02,
        viscosity=100.0,
        drag_normal=1.2,
        drag_tangential=0.01 * math.pi,
        added_mass_normal=1.0,
    )
    grid = np.zeros((knots, knots, 3))
    grid[..., 1], grid[..., 2] = np.arange(knots)[None, :], -1.0 - np.arange(knots)[:, None]
    builder.net("net", grid, twine, lengths=(1.0, 1.0))

    def tow(time: np.ndarray) -> np.ndarray:
        place = np.zeros((time.size, 3))
        place[:, 0] = -np.where(time < 3.0, np.maximum(time, 0.0) ** 2 / 6.0, time - 1.5)
        place[:, 2] = 0.5 * np.clip(time / 3.0, 0.0, 1.0) * np.sin(2.0 * math.pi / 6.0 * time)
        return place

    network = builder.build()
    bar = int(network.strand("net column 0").bars[0])
    motion = {"net": Motion.from_function(tow, duration=13.0, step=0.01)}
    history = simulate(network, motion, duration=12.0, output_step=0.02, keep_nodes=[0], keep_bars=[bar])
    return float(history.tension_peak[history.time > 6.0].max())


def _catenary() -> float:
    """Return the fairlead tension [kN] of a hanging line of 400 bars over that of the exact catenary."""
    water, kind = Water(200.0, 1025.0, 9.81), BarType("chain", 100.0, 1e8, 0.1)
    builder = NetworkBuilder(water)
    builder.fixed("anchor", (0.0, 0.0, -100.0))
    builder.fixed("fairlead", (90.0, 0.0, -40.0))
    builder.line("line", "anchor", "fairlead", kind, length=130.0, segments=400)
    network = builder.build()
    rest = solve_equilibrium(network)
    along = rest.state.position[-1] - rest.state.position[-2]
    weight = kind.submerged_weight_per_length(water)
    pull = rest.tension[-1] * along / np.linalg.norm(along) + np.array([0.0, 0.0, 0.5 * weight * 130.0 / 400.0])
    exact = solve_catenary(90.0, 60.0, 130.0, 1e8, weight, bed=False).tension_fairlead
    return float(np.linalg.norm(pull) / exact)


def _hanging(network: Network, mode: int) -> float:
    return float(natural_modes(network, solve_equilibrium(network).state, count=2 * mode).omega[-1])


def _chain_mode(mode: int) -> float:
    """Return a frequency of a hanging chain over sqrt(g / L)."""
    builder = NetworkBuilder(_EARTH)
    builder.fixed("top", (0.0, 0.0, _DEEP))
    builder.free("end", (0.0, 0.0, _DEEP - 10.0))
    builder.line("chain", "top", "end", BarType("chain", 4.0, 1e9, 1e-9), length=10.0, segments=150, shape="straight")
    return _hanging(builder.build(), mode) / math.sqrt(0.981)


def _pendulum() -> float:
    """Return the period of a pendulum released at one radian over that of small swings."""
    builder = NetworkBuilder(_EARTH)
    builder.fixed("pivot", (0.0, 0.0, _DEEP))
    builder.free("bob", (2.0 * math.sin(1.0), 0.0, _DEEP - 2.0 * math.cos(1.0)), mass=3.0)
    builder.line("rod", "pivot", "bob", BarType("rod", 1e-9, 1e6, 1e-9), length=2.0, segments=1)
    history = simulate(builder.build(), duration=10.0, output_step=0.01, keep_nodes=[1])
    x = history.position[:, 0, 0]
    falls = np.flatnonzero((x[:-1] > 0.0) & (x[1:] <= 0.0))
    when = history.time[falls] + 0.01 * x[falls] / (x[falls] - x[falls + 1])
    return float(np.mean(np.diff(when))) / (2.0 * math.pi * math.sqrt(2.0 / 9.81))


def _boom() -> float:
    """Return the height [mm] at which a slack floating line of 40 bars lies, 0.6 of the water's density."""
    builder = NetworkBuilder(Water(50.0, 1025.0, 9.81))
    builder.fixed("one", (0.0, 0.0, 0.0))
    builder.fixed("two", (18.0, 0.0, 0.0))
    kind = BarType("boom", 0.6 * 1025.0 * math.pi / 4.0 * 0.1**2, 1e6, 0.1)
    builder.line("boom", "one", "two", kind, length=20.0, segments=40, shape="straight")
    return 1e3 * float(np.median(solve_equilibrium(builder.build()).state.position[2:-2, 2]))


def _thrown(method: Literal["tr_bdf2", "esdirk4"]) -> float:
    """Return the highest tension [N] of a massless rope that a thrown mass takes from slack to taut and back."""
    builder = NetworkBuilder(_STILL)
    builder.fixed("wall", (0.0, 0.0, _DEEP))
    builder.free("mass", (1.8, 0.0, _DEEP), mass=40.0)
    builder.line("rope", "wall", "mass", BarType("rope", 1e-9, 2e5, 1e-9), length=2.0, segments=1)
    network = builder.build()
    start = State(0.0, np.array(network.nodes.position), np.array([[0.0, 0.0, 0.0], [1.5, 0.0, 0.0]]))
    history = simulate(network, duration=0.3, output_step=0.05, start=start, method=method, tolerance=1e-4)
    return float(history.tension_peak.max())


CASES: tuple[ValidationCase, ...] = (
    *(
        ValidationCase(
            f"flexible: string struck by its end mass, M/mL = {ratio:g}",
            "Saint-Venant's closed form 2 (1 + exp(-2 m L / M))",
            partial(_struck_string, ratio),
            2.0 * (1.0 + math.exp(-2.0 / ratio)),
            0.01,
            note="250 bars at Courant number 1; first order in the mesh, because a bar averages over its length",
        )
        for ratio in (1.0, 2.0, 5.0)
    ),
    ValidationCase("flexible: hanging line at rest", "exact elastic catenary", _catenary, 1.0, 1e-4, note="400 bars"),
    ValidationCase(
        "flexible: first mode of a hanging chain",
        "Bernoulli: zero of J0 over 2",
        partial(_chain_mode, 1),
        2.404825557695773 / 2.0,
        1e-4,
    ),
    ValidationCase(
        "flexible: third mode of a hanging chain",
        "Bernoulli: zero of J0 over 2",
        partial(_chain_mode, 3),
        8.653727912911013 / 2.0,
        1e-3,
        note="second order in the mesh of 150 bars",
    ),
    ValidationCase(
        "flexible: period of a pendulum at one radian",
        "complete elliptic integral, 2 K(sin 0.5) / pi",
        _pendulum,
        1.066334245579963,
        2e-4,
        note="the rod stretches by 1e-4",
    ),
    ValidationCase(
        "flexible: height of a slack floating line [mm]",
        "(1/2 - density ratio) x diameter",
        _boom,
        -10.0,
        0.05,
        note="the fixed ends bend the line nearby",
    ),
    *(
        ValidationCase(
            f"flexible: mass thrown into a slack rope, {method} [N]",
            "V sqrt(k m)",
            partial(_thrown, method),
            1.5 * math.sqrt(1e5 * 40.0),
            2e-4,
        )
        for method in ("tr_bdf2", "esdirk4")
    ),
    ValidationCase("flexible: snap load of a rope [kN]", _MOORDYN, _snap, 102.36, 5e-3, note="20 bars"),
    *(
        ValidationCase(
            f"flexible: rope stops 5 t, cycle {cycle + 1} [kN]",
            _MOORDYN,
            partial(_snapmass, cycle),
            value,
            5e-3,
        )
        for cycle, value in enumerate((76.26, 76.23, 76.35))
    ),
    *(
        ValidationCase(
            f"flexible: towed net of {knots} x {knots} knots [N]",
            _MOORDYN,
            partial(_net, knots),
            value,
            5e-3,
            note="the reference is the force at the lower knot, which lacks the weight of half a twine",
        )
        for knots, value in ((10, 71.73), (20, 120.0))
    ),
)
