"""Builder, motions, snap detection, refinement, sensitivity and the faults that a network tells."""

import math

import numpy as np
import pytest
from networks_for_tests import NO_GRAVITY, rope

from moyai.core.errors import InputError
from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import Bars, BarType, Nodes, RopeCurve
from moyai.flexible.flow import Flow
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network
from moyai.flexible.refine import refined, with_viscosity
from moyai.flexible.sensitivity import PeakSensitivity, peak_sensitivity
from moyai.flexible.simulation import simulate
from moyai.flexible.statics import solve_equilibrium
from moyai.sea.water import Water
from moyai.tables.lines import line_type

WATER = Water(50.0, 1025.0, 9.81)
ROPE = BarType("rope", 5.0, 1e6, 0.03, viscosity=500.0)


def test_builder_numbers_lines_in_one_run():
    builder = NetworkBuilder(WATER)
    builder.fixed("a", (0.0, 0.0, -40.0))
    builder.fixed("b", (50.0, 0.0, -10.0))
    builder.free("joint", (25.0, 0.0, -20.0), mass=10.0)
    builder.line("lower", "a", "joint", ROPE, length=33.0, segments=6)
    builder.line("upper", "joint", "b", ROPE, length=28.0, segments=5)
    network = builder.build()
    assert np.all(network.bars.end - network.bars.start == 1)
    assert network.strand("upper").nodes[0] == network.point("joint") == network.strand("lower").nodes[-1]
    assert network.node_mass.sum() == pytest.approx(10.0 + 5.0 * 61.0)
    assert network.node_volume.sum() == pytest.approx(math.pi / 4.0 * 0.03**2 * 61.0)


def test_type_from_the_catalogue():
    chain = BarType.from_properties(line_type("studless_chain_R3", 0.05), viscosity=1e4)
    assert chain.wave_speed == pytest.approx(math.sqrt(chain.axial_stiffness / chain.mass_per_length))
    assert chain.impedance == pytest.approx(chain.wave_speed * chain.mass_per_length)
    assert chain.submerged_weight_per_length(WATER) > 0.0


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda b: b.line("x", "a", "nowhere", ROPE, length=1.0, segments=1), "no point 'nowhere'"),
        (lambda b: b.line("x", "a", "a", ROPE, length=1.0, segments=1), "starts and ends"),
        (lambda b: b.line("x", "a", "b", ROPE, length=-1.0, segments=1), "length -1"),
        (lambda b: b.line("x", "a", "b", ROPE, length=1.0, segments=0), "0 segments"),
        (lambda b: b.line("line", "a", "b", ROPE, length=1.0, segments=1), "two lines"),
        (lambda b: b.fixed("a", (0.0, 0.0, 0.0)), "two points"),
        (lambda b: b.fixed("c", (0.0, float("nan"), 0.0)), "three finite numbers"),
        (lambda b: b.free("c", (0.0, 0.0, 0.0), mass=-1.0), "mass of 'c' is -1"),
        (lambda b: b.free("alone", (0.0, 0.0, 0.0)), "has no mass"),
        (lambda b: b.free("alone", (0.0, 0.0, 0.0), mass=1.0), "nothing holds"),
        (lambda b: b.net("n", np.zeros((1, 2, 3)), ROPE, lengths=(1.0, 1.0)), "two or more each"),
    ],
)
def test_faults_of_a_model_are_reported(spoil, words):
    builder = NetworkBuilder(WATER)
    builder.fixed("a", (0.0, 0.0, -10.0))
    builder.fixed("b", (1.0, 0.0, -10.0))
    builder.line("line", "a", "b", ROPE, length=1.1, segments=3)
    with pytest.raises(InputError, match=words):
        spoil(builder)
        builder.build()


def test_faults_of_arrays_are_reported():
    place = np.array([[0.0, 0.0, -1.0], [1.0, 0.0, -1.0]])
    with pytest.raises(InputError, match="length 0 m"):
        Bars([0], [1], [0.0], [0], (ROPE,))
    with pytest.raises(InputError, match="does not exist"):
        Network(Nodes(place, [1, 1]), Bars([0], [2], [1.0], [0], (ROPE,)), WATER)
    with pytest.raises(InputError, match="names no motion"):
        Network(Nodes(place, [1, 2]), Bars([0], [1], [1.0], [0], (ROPE,)), WATER)
    with pytest.raises(InputError, match="under the bed"):
        Network(Nodes(place - [0.0, 0.0, 60.0], [1, 0]), Bars([0], [1], [1.0], [0], (ROPE,)), WATER, Bed(-50.0, 1e5))
    for wrong in ({"axial_stiffness": 0.0}, {"mass_per_length": -1.0}, {"viscosity": -1.0}):
        with pytest.raises(InputError):
            BarType(**{"name": "x", "mass_per_length": 1.0, "axial_stiffness": 1.0, "diameter": 0.1, **wrong})
    with pytest.raises(InputError, match="does not rise"):
        RopeCurve([0.0, 0.1, 0.2], [0.0, 5.0, 4.0])
    with pytest.raises(InputError):
        Bed(-10.0, 0.0)
    with pytest.raises(InputError):
        Flow((float("nan"), 0.0, 0.0))


@pytest.mark.parametrize("seed", range(4))
def test_motion_follows_what_it_was_made_from(seed):
    rng = np.random.default_rng(seed)
    size, phase, period = rng.normal(0, 2, 3), rng.uniform(0, 6, 3), rng.uniform(1.0, 10.0)
    motion = Motion.harmonic(size, period, duration=40.0, ramp=period, phase=phase)
    time = np.sort(rng.uniform(0.0, 40.0, 200))
    grown = np.where(time < period, 0.5 * (1.0 - np.cos(np.pi * time / period)), 1.0)[:, None]
    exact = size * grown * np.sin(2.0 * np.pi / period * time[:, None] + phase)
    place, speed = motion.at(time)
    assert place == pytest.approx(exact, abs=2e-7)
    ahead, behind = motion.at(np.clip(time + 1e-5, 0, 40))[0], motion.at(np.clip(time - 1e-5, 0, 40))[0]
    inside = (time > 1e-4) & (time < 39.999)
    assert speed[inside] == pytest.approx((ahead - behind)[inside] / 2e-5, abs=1e-5)
    record = Motion.from_table(np.linspace(0.0, 40.0, 401), motion.at(np.linspace(0.0, 40.0, 401))[0])
    assert record.at(time)[0] == pytest.approx(exact, abs=5e-3 * np.max(np.abs(size)) + 1e-4)
    with pytest.raises(InputError):
        motion.at(41.0)


def test_refined_network_is_the_same_network():
    builder = NetworkBuilder(WATER, Bed(-50.0, 1e6))
    builder.fixed("a", (0.0, 0.0, -50.0))
    builder.fixed("b", (60.0, 0.0, -5.0))
    builder.line("line", "a", "b", ROPE, length=80.0, segments=40)
    network = builder.build()
    finer, state = refined(network, 3)
    assert finer.node_mass.sum() == pytest.approx(network.node_mass.sum())
    assert len(finer.bars) == 120 and finer.strand("line").nodes.size == 121
    assert state.position[finer.point("b")] == pytest.approx((60.0, 0.0, -5.0))
    one, two = solve_equilibrium(network), solve_equilibrium(finer, start=state)
    assert two.tension[-1] == pytest.approx(one.tension[-1], rel=0.01)
    assert with_viscosity(network, 3.0).bars.types[0].viscosity == 1500.0
    with pytest.raises(InputError):
        refined(network, 0)


def test_sensitivity_gives_the_uncertainty_of_a_peak():
    network = rope(segments=8, span=(39.5, 0.0, 0.0), stiffness=1e6, mass=3.0, viscosity=2e3, water=NO_GRAVITY)
    motion = {"end": Motion.harmonic((1.0, 0.0, 0.0), 3.0, duration=8.0, ramp=1.5)}
    found = peak_sensitivity(network, motion, bar=7, duration=6.0, output_step=0.02)
    assert isinstance(found, PeakSensitivity)
    assert found.half_step == pytest.approx(found.peak, rel=0.01)
    assert found.viscosity_effect > 0.0
    assert (found.discretisation_error > 1e-9) == bool(found.notices(limit=1e-9))
    with pytest.raises(InputError):
        peak_sensitivity(network, motion, bar=99, duration=1.0, output_step=0.1)


def test_rope_curve_pulls_as_tabulated():
    curve = RopeCurve([0.0, 0.02, 0.05], [0.0, 1e4, 7e4])
    for stretch, tension in ((0.01, 5e3), (0.03, 3e4), (0.08, 1.3e5)):
        builder = NetworkBuilder(NO_GRAVITY)
        builder.fixed("a", (0.0, 0.0, -9.0))
        builder.fixed("b", (10.0 * (1.0 + stretch), 0.0, -9.0))
        kind = BarType("nylon", 2.0, 1.0, 1e-9, curve=curve)
        builder.line("line", "a", "b", kind, length=10.0, segments=4, shape="straight")
        network = builder.build()
        history = simulate(network, duration=0.1, output_step=0.05)
        assert history.tension[-1] == pytest.approx(tension, rel=1e-9)
        # energy is the area under the curve
        area = np.interp(np.linspace(0, stretch, 20001), [0, 0.02, 0.05, 0.08], [0, 1e4, 7e4, 1.3e5]).mean() * stretch
        assert history.elastic_energy[0] == pytest.approx(10.0 * area, rel=1e-4)
