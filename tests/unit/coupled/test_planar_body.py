"""The planar body of the breakwater on lines of a network: the same motion as in its own time domain."""

from __future__ import annotations

import math

import numpy as np
import pytest
from bodies_for_tests import SPACE, light

from moyai.core.errors import InputError
from moyai.coupled.planar import PlanarBody
from moyai.coupled.simulate import simulate_coupled
from moyai.flexible.build import NetworkBuilder
from moyai.floating.forcing import RegularForcing
from moyai.floating.lines import PlanarMooring
from moyai.floating.memory import ConvolutionMemory, StateSpaceMemory
from moyai.floating.time import CumminsModel, simulate
from moyai.mooring.lines import SpringLine
from moyai.mooring.system import LineSystem


def model_of(random, mooring=None, memory=None):
    half = random.normal(size=(3, 3))
    inertia = np.diag([900.0, 1400.0, 300.0]) + 20.0 * half @ half.T
    if memory is None:
        poles = np.array([-0.6 + 1.1j, -0.4 + 0.0j])
        inputs = random.normal(size=(2, 3)).astype(complex)
        memory = StateSpaceMemory(poles, inputs, 60.0 * inputs.T.conj(), np.diag([20.0, 30.0, 8.0]))
    return CumminsModel(inertia, np.diag([0.0, 9000.0, 900.0]), np.diag([30.0, 40.0, 10.0]), memory, mooring)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("seed", "kept"), [(0, 0), (1, 1), *(pytest.param(*pair, marks=pytest.mark.slow) for pair in ((0, 1), (1, 0)))]
)
def test_body_on_springs_moves_as_in_the_time_domain_of_the_breakwater(seed: int, kept: int) -> None:
    """Random memory, forcing and springs; ``kept`` springs stay quasi-static next to the network."""
    random = np.random.default_rng(seed)
    springs = [
        SpringLine(
            f"s{n}", (side * random.uniform(5, 8), random.uniform(-1, 1), -random.uniform(2, 4)),
            (side * 1.5, 0.0, random.uniform(-0.5, 0.2)), stiffness=random.uniform(150, 400),
            pretension=random.uniform(200, 500), count=1 + n % 2,
        )
        for n, side in enumerate((-1, 1, -1, 1))
    ]  # fmt: skip

    def mooring(lines):
        system = LineSystem(tuple(lines), 20.0)
        return PlanarMooring.of(system, rest=(0.0, 0.0, 0.0), centre=(0.0, 0.0))

    forcing = RegularForcing(
        omega=1.4, wave_amplitude=0.06, excitation_force=np.array([900.0 + 300j, 1500.0 - 200j, 250.0j]),
        mean_drift=np.array([20.0, 0.0, 0.0]), steady=np.zeros(3), ramp=8.0,
    )  # fmt: skip
    rng = np.random.default_rng(seed + 10)
    exact = simulate(model_of(rng, mooring(springs)), forcing, duration=40.0, time_step=0.02)
    builder = NetworkBuilder(SPACE)
    own, networked = springs[:kept], springs[kept:]
    rest = np.zeros(3)
    for line in networked:
        length = np.linalg.norm(np.subtract(line.anchor, line.fairlead))
        natural = length - line.pretension / line.stiffness
        builder.fixed(f"{line.name} anchor", line.anchor)
        builder.driven(line.name, line.fairlead)
        builder.line(
            line.name, f"{line.name} anchor", line.name, light(line.stiffness * natural, mass=1e-6), length=natural,
            segments=1, shape="straight",
        )  # fmt: skip
        pull = line.count * line.pretension * np.subtract(line.anchor, line.fairlead) / length
        x, _, z = line.fairlead
        rest += [pull[0], pull[2], z * pull[0] - x * pull[2]]
    rng = np.random.default_rng(seed + 10)
    body = PlanarBody(
        "unit", model_of(rng, mooring(own) if own else None), forcing, duration=42.0,
        points={line.name: line.fairlead for line in networked},
        copies={line.name: line.count for line in networked}, reaction_at_rest=rest,
    )  # fmt: skip
    history = simulate_coupled(
        builder.build(), {"unit": body}, duration=40.0, output_step=0.1, body_step=0.05, tolerance=1e-6
    )
    assert history.status == "converged"
    unit = history.bodies["unit"]
    angle = np.arctan2(unit.rotation[:, 0, 2], unit.rotation[:, 0, 0])
    found = np.column_stack([unit.position[:, [0, 2]], angle])
    wanted = np.array([np.interp(history.time, exact.time, column) for column in exact.position.T]).T
    assert np.max(np.abs(exact.position), axis=0).min() > 0.005
    assert np.max(np.abs(found - wanted) / np.max(np.abs(wanted), axis=0)) < 6e-4


def test_memory_as_a_convolution_is_refused_with_its_remedy() -> None:
    memory = ConvolutionMemory(np.linspace(0, 1, 5), np.zeros((5, 3, 3)), np.zeros((3, 3)))
    forcing = RegularForcing(1.0, 0.1, np.zeros(3, complex), np.zeros(3), np.zeros(3))
    with pytest.raises(InputError, match="as states") as caught:
        PlanarBody("unit", model_of(np.random.default_rng(1), memory=memory), forcing, duration=1.0, points={})
    assert "state_space" in caught.value.fault.allowed
    assert math.isfinite(len(caught.value.fault.remedy))
