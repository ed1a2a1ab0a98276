"""Memory functions and their states: causality, exact ends, free decay against the frequency integral."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from moyai.core.validation import ValidationCase
from moyai.potential.damping_tail import wall_sided_tails
from moyai.potential.free_decay import decay_by_convolution, decay_by_frequency, decay_by_states
from moyai.potential.memory import MemoryFunctions, memory_functions, pair_measure, steady_damping
from moyai.potential.memory_plan import recommend_frequencies
from moyai.potential.multipole_circle import half_immersed_circle
from moyai.potential.rectangle import solve_rectangle
from moyai.potential.state_space import StateSpace, fit_memory
from moyai.sea.water import Water

WATER = Water(depth=0.38, density=1000.0, gravity=9.81)
BEAM, DRAUGHT, CENTRE_Z, GYRADIUS = 0.38, 0.113, -0.027, 0.101
_FIT = "tolerance of the state-space fit, 1e-3 of the largest response"


@lru_cache(maxsize=1)
def model_memory() -> MemoryFunctions:
    """Return the memory of the model's box; D(0) is left to the data."""
    plan = recommend_frequencies(WATER, breadth=BEAM, wall_height=DRAUGHT)
    solution = solve_rectangle(BEAM, DRAUGHT, WATER, plan.omega, centre=(0.0, CENTRE_Z))
    return memory_functions(
        solution.omega,
        solution.radiation_damping,
        solution.infinite_frequency_added_mass,
        np.linspace(0.0, 12.0, 1201),
        start="even",
        tail_theory=wall_sided_tails(WATER, CENTRE_Z),
        added_mass=solution.added_mass,
    )


@lru_cache(maxsize=1)
def model_states() -> StateSpace:
    """Return its states."""
    return fit_memory(model_memory())


def identity(name: str) -> float:
    """Return one of the identities of the memory."""
    return {check.name: check.value for check in model_memory().checks}[name]


def prototype_kernel_difference() -> float:
    """Return |lambda - integral of K| over the largest lambda."""
    return identity("lambda is the integral of K")


def ogilvie_at(period: float) -> float:
    """Return the infinite-frequency sway added mass from A and K at one period alone."""
    memory = model_memory()
    omega = 2.0 * math.pi / period
    solution = solve_rectangle(BEAM, DRAUGHT, WATER, omega, centre=(0.0, CENTRE_Z))
    return float(solution.added_mass[0, 0, 0] - memory.model.added_mass_excess(omega)[0, 0, 0])


def _body() -> tuple[np.ndarray, np.ndarray]:
    mass = 1000.0 * BEAM * DRAUGHT * np.diag([1.0, 1.0, GYRADIUS**2])
    stiffness = np.diag([300.0, 1000.0 * 9.81 * BEAM, 33.0])
    stiffness[0, 2] = stiffness[2, 0] = -10.0
    return mass, stiffness


def decay_difference(offset: tuple[float, float, float], way: str) -> float:
    """Return the largest difference over the first 12 s between one way and the frequency integral."""
    memory, (mass, stiffness) = model_memory(), _body()
    infinite = memory.infinite_frequency_added_mass
    time = np.linspace(0.0, 12.0, 121)
    exact = decay_by_frequency(time, offset, mass, stiffness, memory.model, infinite)
    if way == "states":
        other = decay_by_states(time, offset, mass, stiffness, model_states(), infinite)
    else:
        step, every = 0.0025, 40
        kernel = memory.model.velocity_kernel(step * np.arange(1600))
        other = decay_by_convolution(step, 4800, offset, mass, stiffness, kernel, infinite)[::every]
    return float(np.abs(other - exact).max())


def circle_tail_difference() -> float:
    """Return the late difference of states and frequency integral for a half circle in infinite depth, relative."""
    plan = recommend_frequencies(Water(math.inf, 1000.0, 9.81), breadth=2.0, wall_height=0.7)
    values = [half_immersed_circle(w * w / 9.81, "heave", multipoles=32) for w in plan.omega]
    unit = 1000.0 * np.pi / 2.0
    damping = unit * np.array([v.radiation_damping for v in values])[:, None, None] * plan.omega[:, None, None]
    model = memory_functions(plan.omega, damping, [[unit]], [0.0, 1.0], start="zero").model
    mass, stiffness = np.array([[unit]]), np.array([[2.0 * 1000.0 * 9.81]])
    time = np.linspace(15.0, 30.0, 60)
    exact = decay_by_frequency(time, [1.0], mass, stiffness, model, [[unit]])
    states = decay_by_states(time, [1.0], mass, stiffness, fit_memory(model), [[unit]])
    return float(np.abs(states - exact).max() / np.abs(exact).max())


def cliff_ratio() -> float:
    """Return the sway damping at K d = 12 times omega^3 over 4 rho g^2, thin box."""
    water, draught = Water(6.0, 1000.0, 9.81), 2.0
    omega = math.sqrt(12.0 * 9.81 / draught)
    solution = solve_rectangle(0.05, draught, water, omega, centre=(0.0, 0.0))
    return float(solution.radiation_damping[0, 0, 0]) * omega**3 / (4.0 * 1000.0 * 9.81**2)


def kernel_share_at_six_seconds() -> float:
    """Return the largest |K| after 6 s over the largest K of its modes."""
    memory = model_memory()
    share = np.abs(memory.velocity_kernel) / pair_measure(memory.velocity_kernel)
    return float(share[memory.time >= 6.0].max())


CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        "memory: lambda is the integral of K", "two quadratures", prototype_kernel_difference, 0.0, 3e-5, relative=False
    ),
    ValidationCase(
        "memory: Kramers-Kronig",
        "added mass of the solver",
        lambda: identity("Kramers-Kronig"),
        0.0,
        1e-4,
        relative=False,
    ),
    ValidationCase(
        "memory: Ogilvie", "phi = 0 problem of the solver", lambda: identity("Ogilvie"), 0.0, 1e-3, relative=False
    ),
    ValidationCase(
        "memory: sway m* from T = 0.95 s alone",
        "phi = 0 problem: 10.16548",
        lambda: ogilvie_at(0.95),
        10.16547564,
        2e-4,
    ),
    ValidationCase(
        "memory: D(0) of heave from the data",
        "long waves, rho b^2 sqrt(g/h)/2",
        lambda: float(model_memory().steady_dashpot[1, 1]),
        float(steady_damping([0.0, BEAM, 0.0], WATER)[1, 1]),
        1e-6,
    ),
    ValidationCase(
        "memory: lambda of heave at 12 s",
        "D(0): lambda does not tend to zero",
        lambda: float(model_memory().acceleration_kernel[-1, 1, 1]),
        float(steady_damping([0.0, BEAM, 0.0], WATER)[1, 1]),
        1e-4,
    ),
    ValidationCase("memory: sway tail of a plate", "reflection by a cliff, 4 rho g^2/omega^3", cliff_ratio, 1.0, 1e-3),
    ValidationCase(
        "memory: |K| after 6 s", "prototype: below 1e-3 of K(0)", kernel_share_at_six_seconds, 0.0, 1e-3, relative=False
    ),
    ValidationCase(
        "memory: error of the states", "response of the memory", lambda: model_states().error, 0.0, 1e-3, relative=False
    ),
    ValidationCase(
        "memory: least damping of the states",
        "passive: not negative at any frequency",
        lambda: min(model_states().least_damping, 0.0),
        0.0,
        1e-10,
        relative=False,
    ),
    ValidationCase(
        "memory: heave decay, states",
        "frequency integral of A and B",
        lambda: decay_difference((0.0, 1.0, 0.0), "states"),
        0.0,
        1e-3,
        relative=False,
        note=_FIT,
    ),
    ValidationCase(
        "memory: sway-roll decay, states",
        "frequency integral of A and B",
        lambda: decay_difference((0.3, 0.0, 1.0), "states"),
        0.0,
        1e-3,
        relative=False,
        note=_FIT,
    ),
    ValidationCase(
        "memory: heave decay, convolution",
        "frequency integral of A and B",
        lambda: decay_difference((0.0, 1.0, 0.0), "convolution"),
        0.0,
        2e-4,
        relative=False,
        note="second order, step 2.5 ms",
    ),
    ValidationCase(
        "memory: late heave of a half circle, infinite depth",
        "frequency integral over Ursell's coefficients",
        circle_tail_difference,
        0.0,
        0.02,
        relative=False,
        note="share of a motion that has fallen to 1e-3 and decays algebraically",
    ),
)
