"""Light lines let go from a strain: drag comes up within a few steps and damps faster than the step of the start."""

import math
from dataclasses import replace

import numpy as np
import pytest

from moyai.coupled.rigid import RigidBody
from moyai.coupled.simulate import simulate_coupled
from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType, RopeCurve
from moyai.flexible.flow import Flow
from moyai.flexible.motion import Motion
from moyai.flexible.simulation import simulate
from moyai.sea.water import Water

DEPTH = 30.0


def _kind(random, name, length, segments):
    kind = BarType(
        name, 10.0 ** random.uniform(-0.5, 0.5), 10.0 ** random.uniform(4.5, 7.5), random.uniform(0.05, 0.1),
        drag_normal=random.uniform(0.5, 2.0), drag_tangential=random.uniform(0.02, 0.2), added_mass_normal=1.0,
        added_mass_tangential=0.0,
    )  # fmt: skip
    critical = length / segments * math.sqrt(kind.axial_stiffness * kind.mass_per_length)
    return replace(kind, viscosity=random.uniform(0.1, 1.0) * critical)


def _strained(seed):
    """Two light ropes drawn out by up to a quarter, a weight between them, the upper end in motion."""
    random = np.random.default_rng(seed)
    builder = NetworkBuilder(Water(DEPTH, 1025.0, 9.81), Bed(-DEPTH, 1e5, 1e4, 0.3))
    places = {"a": (60.0, 0.0, -DEPTH), "m": (35.0, random.uniform(-5, 5), -0.5 * DEPTH), "f": (0.0, 0.0, -0.2)}
    builder.fixed("a", places["a"])
    builder.driven("f", places["f"])
    builder.free("m", places["m"], mass=random.uniform(50.0, 300.0))
    for name, (one, two) in {"l1": ("a", "m"), "l2": ("m", "f")}.items():
        away, segments = math.dist(places[one], places[two]), int(random.integers(3, 12))
        builder.line(
            name, one, two, _kind(random, name, away, segments), length=away * random.uniform(0.8, 0.97),
            segments=segments,
        )  # fmt: skip
    motion = {"f": Motion.harmonic((0.5, 0.0, 0.5), 4.0, duration=4.0, ramp=4.0)}
    return builder.build(), motion, Flow((random.uniform(-1, 1), random.uniform(-1, 1), 0.0))


def _peaks(history):
    strands = history.network.strands
    return np.array([np.nanmax(history.tension_peak[:, strand.bars]) for strand in strands])


@pytest.mark.parametrize("seed", range(10))
def test_ropes_let_go_from_a_strain_bear_what_an_implicit_scheme_says(seed):
    """Whatever the rows: drag outruns the step of the start within them."""
    network, motion, flow = _strained(seed)
    options = {"duration": 3.0, "flow": flow}
    exact = _peaks(simulate(network, motion, output_step=0.1, method="tr_bdf2", tolerance=1e-4, **options))
    for output_step in (0.05, 1.0):
        history = simulate(network, motion, output_step=output_step, **options)
        assert history.status == "converged" and history.time[-1] == pytest.approx(3.0, rel=1e-12)
        assert np.diff(history.time) == pytest.approx(output_step, rel=1e-9)
        assert _peaks(history) == pytest.approx(exact, rel=0.02)


def test_the_number_of_steps_counts_those_of_every_length():
    network, motion, flow = _strained(3)
    history = simulate(network, motion, duration=3.0, output_step=0.1, flow=flow)
    assert 3.0 / history.steps > history.step
    given = simulate(network, motion, duration=3.0, output_step=0.1, flow=flow, step=history.step, load_steps=1)
    assert given.steps >= round(3.0 / history.step) and given.steps > history.steps


def test_a_step_by_hand_that_drag_outruns_within_a_row_is_reported():
    network, motion, flow = _strained(0)
    usual = simulate(network, motion, duration=1.0, output_step=1.0, flow=flow)
    coarse = 1.0 / usual.steps * 3.0
    reported = simulate(network, motion, duration=1.0, output_step=1.0, flow=flow, step=coarse)
    assert "step-not-stable" in [notice.code for notice in reported.notices]


def _hung(stiffness, rows, alone):
    """A weight thrown against a straight rope: as a driven point that stops, or as a body."""
    curve = RopeCurve((0.0, 1e-4), (0.0, 1e-4 * stiffness))
    kind = BarType("cord", 1.0, stiffness, 0.01, viscosity=0.0, tension_only=False, curve=curve)
    builder = NetworkBuilder(Water(math.inf, 1e-9, 1e-9), None)
    builder.fixed("wall", (0, 0, 0))
    builder.driven("hook", (10.0, 0, 0))
    builder.line("line", "wall", "hook", kind, length=10.0, segments=40, shape="straight")
    network = builder.build()
    travel = 10.0 / math.sqrt(stiffness)
    if alone:
        motion = {
            "hook": Motion(0.0, 10 * travel, np.array([[0, 0, 0], [10 * travel, 0, 0]]), np.tile([1, 0, 0], (2, 1)))
        }
        return simulate(network, motion, duration=3 * travel, output_step=rows * travel, method=alone)
    body = RigidBody("body", 5.0, (5.0,) * 3, position=(10.0, 0, 0), points={"hook": (0, 0, 0)})
    carrier = body.carrier(network.water)
    carrier.place_body((10.0, 0, 0), np.eye(3), [1.0, 0, 0, 0, 0, 0])
    return simulate_coupled(
        network, {"body": body}, duration=3 * travel, output_step=rows * travel, carriers={"body": carrier}
    )


@pytest.mark.parametrize("how", ["explicit", "tr_bdf2", "esdirk4", ""])
@pytest.mark.parametrize("rows", [0.05, 3.0])
def test_every_kind_of_run_tells_of_fronts_and_of_ropes_beyond_their_curves(how, rows):
    codes = [notice.code for notice in _hung(1e4, rows, how).notices]
    assert "wave-front" in codes and "beyond-rope-curve" in codes and "landing-front" not in codes


@pytest.mark.parametrize("seed", range(3))
def test_ropes_on_a_falling_body_bear_what_they_bear_on_a_point_that_falls(seed):
    """Rows are broken off within the steps of the body too; what is tried again starts from what was seen before."""
    network, _, flow = _strained(seed)
    place = network.nodes.position[network.points["f"]]
    body = RigidBody("body", 1e9, (1e9,) * 3, position=tuple(place), points={"f": (0.0, 0.0, 0.0)})
    held = simulate_coupled(network, {"body": body}, duration=2.0, output_step=0.1, flow=flow)
    time = np.arange(301) * 0.01
    still = np.zeros_like(time)
    fall = Motion(
        0.0,
        0.01,
        np.stack([still, still, -0.5 * 9.81 * time**2], axis=1),
        np.stack([still, still, -9.81 * time], axis=1),
    )
    driven = simulate(network, {"f": fall}, duration=2.0, output_step=0.1, flow=flow)
    peaks = [held.network.tension_peak[:, strand.bars].max() for strand in network.strands]
    assert held.status == "converged" and peaks == pytest.approx(_peaks(driven), rel=2e-3)
    codes = {notice.code for notice in held.notices}
    assert codes - {"body-step"} == {notice.code for notice in driven.notices}
