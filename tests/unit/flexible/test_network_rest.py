"""Networks of every kind find rest; what has none is reported; the last good state of a run is on disk."""

import math

import numpy as np
import pytest
from random_lines import random_line, random_net

from moyai.core.errors import ConvergenceError, InputError
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import FIXED, Bars, BarType, Nodes
from moyai.flexible.flow import Flow
from moyai.flexible.modes import natural_modes
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network
from moyai.flexible.recovery import read_state, write_state
from moyai.flexible.result import State
from moyai.flexible.sheets import Sheets, sheet_grid
from moyai.flexible.simulation import simulate
from moyai.flexible.statics import solve_equilibrium
from moyai.sea.water import Water

WATER = Water(50.0, 1025.0, 9.81)


def leftover(network, flow, rest):
    """Return the largest force on what is free by the kernels of the explicit scheme [N]."""
    from moyai.flexible import explicit_forces, explicit_rows
    from moyai.flexible.explicit import ExplicitRun

    motions = {name: Motion(0.0, 10.0, np.zeros((2, 3)), np.zeros((2, 3))) for name in network.motion_names}
    run = ExplicitRun(network, motions, flow or Flow(), rest.state, safety=0.9, load_steps=1)
    memory, sizes = run.packed.memory, run.packed.sizes
    for axis in range(3):
        source = (explicit_rows.QX + axis * explicit_rows.ROW, explicit_rows.TX + axis * explicit_rows.ROW)
        memory[source[1] : source[1] + sizes[0]] = memory[source[0] : source[0] + sizes[0]]
    explicit_forces.spine_forces(memory, sizes[1])
    explicit_forces.rib_forces(memory, run.packed.runs, run.arrays.curves)
    explicit_forces.bending_forces(memory, run.arrays.hinges, run.arrays.bending)
    force = run.packed.node_rows(explicit_rows.TX, 3).T.copy()
    own = run.packed.node_rows(explicit_rows.FX, 3).T
    force += own
    force[1:] -= own[:-1]
    if network.bed is not None:
        force[:, 2] += run.arrays.node("bed_stiffness") * np.maximum(network.bed.level - rest.state.position[:, 2], 0.0)
    return np.abs(force * run.arrays.nodes[9:12].T).max()


def check(network, flow):
    rest = solve_equilibrium(network, flow=flow)
    assert rest.residual < 1e-6
    weight = float(np.max(network.node_mass)) * network.water.gravity
    work = max(weight, float(rest.tension.max()))
    noise = 1e-14 * float((network.bars.of_type("axial_stiffness") / network.bars.length).max())
    extent = float(np.abs(rest.state.position).max())
    assert leftover(network, flow, rest) < 1e-6 * work + noise * extent


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(40))
def test_lines_of_every_kind_find_rest(seed):
    check(*random_line(np.random.default_rng(10_000 + seed)))


@pytest.mark.parametrize("seed", range(25))
def test_nets_in_any_current_find_rest(seed):
    check(*random_net(np.random.default_rng(10_000 + seed)))


@pytest.mark.slow
def test_a_hundred_and_fifty_more_find_rest():
    """A hundredth may need the true motion to lead; none may be refused."""
    led = 0
    for make, count in ((random_line, 90), (random_net, 60)):
        for seed in range(count):
            network, flow = make(np.random.default_rng(20_000 + seed))
            rest = solve_equilibrium(network, flow=flow)
            assert rest.residual < 1e-5, (make.__name__, seed)
            led += rest.found == "true motion"
    assert led <= 2


@pytest.mark.parametrize("gravity", [0.3, 0.6, 0.95])
@pytest.mark.parametrize("bars", [10, 40])
def test_a_slack_boom_floats_level(gravity, bars):
    """A thin floating line between two points at the surface lies there at the draught of its density."""
    builder, diameter = NetworkBuilder(WATER), 0.1
    builder.fixed("one", (0.0, 0.0, 0.0))
    builder.fixed("two", (18.0, 0.0, 0.0))
    kind = BarType("boom", gravity * 1025.0 * math.pi / 4.0 * diameter**2, 1e6, diameter, drag_normal=1.2)
    builder.line("boom", "one", "two", kind, length=20.0, segments=bars, shape="straight")
    rest = solve_equilibrium(builder.build())
    middle = rest.state.position[2:-2, 2] if bars > 10 else rest.state.position[4:-4, 2]
    # the immersed part of a level bar is 1/2 - z / d
    assert np.median(middle) == pytest.approx((0.5 - gravity) * diameter, abs=2e-3)


@pytest.mark.parametrize("seed", range(4))
def test_forces_of_a_sheet_at_rest_balance(seed):
    """A curtain of cloth between two walls, ballast below, in a current: what it takes reaches the walls."""
    rng = np.random.default_rng(seed)
    p, q, span, height = (
        int(rng.integers(4, 12)),
        int(rng.integers(2, 6)),
        rng.uniform(4.0, 12.0),
        rng.uniform(1.0, 4.0),
    )
    place = np.zeros((p, q, 3))
    place[..., 1], place[..., 2] = np.linspace(0.0, span, p)[:, None], -1.0 - np.linspace(0.0, height, q)[None, :]
    number, kind = np.arange(p * q).reshape(p, q), np.zeros((p, q), dtype=int)
    kind[[0, -1]] = FIXED
    slack = rng.uniform(1.01, 1.1)
    triangles, unstretched = sheet_grid(number, np.linspace(0.0, slack * span, p), np.linspace(0.0, height, q))
    sheets = Sheets(
        triangles, unstretched, warp_stiffness=10.0 ** rng.uniform(4, 6), weft_stiffness=10.0 ** rng.uniform(4, 6),
        shear_stiffness=1e4, mass_per_area=1.5, volume_per_area=1e-3, drag_normal=1.2, drag_tangential=0.01,
        tension_field=bool(seed % 2),
    )  # fmt: skip
    start, end = number[:-1, [0, -1]].T.ravel(), number[1:, [0, -1]].T.ravel()
    types = (BarType("cable", 2.0, 1e6, 0.02), BarType("ballast", 20.0, 1e6, 0.05))
    bars = Bars(start, end, np.full(start.size, slack * span / (p - 1)), np.repeat([0, 1], p - 1), types)
    network = Network(Nodes(place.reshape(-1, 3), kind.ravel()), bars, WATER, sheets=sheets)
    rest = solve_equilibrium(network, flow=Flow((rng.uniform(0.2, 1.5), 0.0, 0.0)))
    assert rest.residual < 1e-8
    assert rest.state.position[:, 0].max() > 0.05 * span


def test_a_failure_keeps_the_nearest_state(tmp_path):
    builder = NetworkBuilder(WATER)
    builder.free("top", (0.0, 0.0, 0.0), held=(False, False, True))
    builder.free("low", (10.0, 0.0, -10.0), mass=10.0)
    builder.line("tie", "top", "low", BarType("tie", 20.0, 1e7, 0.04, drag_normal=1.2), length=20.0, segments=4)
    network = builder.build()
    with pytest.raises(ConvergenceError, match="nearest state in") as reported:
        solve_equilibrium(network, flow=Flow((0.5, 0.2, 0.0)), most_steps=40, state_file=tmp_path / "rest.npz")
    assert "along x and y: the current moves them away" in str(reported.value)
    assert read_state(tmp_path / "rest.npz", network).position.shape == (5, 3)


def snapping(viscosity=0.0):
    builder = NetworkBuilder(WATER)
    builder.fixed("wall", (0.0, 0.0, -10.0))
    builder.driven("end", (9.0, 0.0, -10.0))
    kind = BarType("rope", 1.0, 1e6, 0.02, viscosity=viscosity, drag_normal=1.2)
    builder.line("rope", "wall", "end", kind, length=10.0, segments=12)
    network = builder.build()
    return network, {"end": Motion.harmonic((2.0, 0.0, 0.0), 2.0, duration=20.0, ramp=1.0)}


def test_an_implicit_step_that_fails_tells_time_node_and_force_and_can_go_on(tmp_path):
    """A fixed step far too long: Newton's method gives up, the state before it is on disk, a shorter step goes on."""
    network, motions = snapping()
    kept = tmp_path / "deep" / "state.npz"
    history = simulate(network, motions, duration=6.0, output_step=0.5, method="esdirk4", step=0.5, state_file=kept)
    assert history.status == "not_converged"
    for word in ("stopped at t = ", " N are left at ", "node", str(kept)):
        assert word in history.message
    state = read_state(kept, network)
    assert state.time == history.final.time < 6.0
    assert state.position == pytest.approx(history.final.position)
    on = simulate(network, motions, duration=1.0, output_step=0.1, method="tr_bdf2", tolerance=1e-2, start=state)
    assert on.status == "converged"
    assert on.time[0] == state.time


def test_a_blow_up_keeps_the_state_before_it(tmp_path):
    network, motions = snapping(50.0)
    kept = tmp_path / "state.npz"
    history = simulate(network, motions, duration=10.0, output_step=0.05, step=0.05, state_file=kept)
    assert history.status == "not_converged"
    state = read_state(kept, network)
    assert np.isfinite(state.position).all()
    assert np.abs(state.position - network.nodes.position).max() < 20.0
    assert simulate(network, motions, duration=0.5, output_step=0.05, start=state).status == "converged"


def test_files_that_are_no_state_are_refused(tmp_path):
    network, _ = snapping()
    with pytest.raises(InputError, match="no file"):
        read_state(tmp_path / "absent.npz")
    (tmp_path / "text.npz").write_text("hello")
    with pytest.raises(InputError, match="damaged"):
        read_state(tmp_path / "text.npz")
    np.savez(tmp_path / "other.npz", time=1.0)
    with pytest.raises(InputError, match="holds no state"):
        read_state(tmp_path / "other.npz")
    write_state(tmp_path / "small.npz", State(0.0, np.zeros((2, 3)), np.zeros((2, 3))))
    with pytest.raises(InputError, match="2 nodes, the network 13"):
        read_state(tmp_path / "small.npz", network)
    with pytest.raises(InputError, match="cannot write"):
        write_state(tmp_path / "text.npz" / "below.npz", State(0.0, np.zeros((2, 3)), np.zeros((2, 3))))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("method", ["tr_bdf2", "esdirk4"])
def test_the_error_estimate_resolves_slack_and_taut(method, seed):
    """A mass thrown from a slack rope and back, again and again: contacts and peaks of the exact motion.

    Free flight over the slack, half a sine on the rope, sqrt(k m) V of tension: the place at the end, in lengths of the
    bar, is within twice the tolerance of one step.
    """
    rng = np.random.default_rng(seed)
    mass, speed, slack, spring = 10.0 ** rng.uniform(0, 3), rng.uniform(0.5, 3.0), rng.uniform(0.05, 0.5), 1e5
    builder = NetworkBuilder(Water(math.inf, 1000.0, 1e-12))
    builder.fixed("wall", (0.0, 0.0, -500.0))
    builder.free("mass", (2.0 - slack, 0.0, -500.0), mass=mass)
    builder.line("rope", "wall", "mass", BarType("rope", 1e-9, 2.0 * spring, 1e-9), length=2.0, segments=1)
    network = builder.build()
    moving = np.zeros((2, 3))
    moving[1, 0] = speed
    pulled, flight = math.pi * math.sqrt(mass / spring), slack / speed
    duration = 2.0 * flight + pulled
    errors, peaks = [], []
    for tolerance in (1e-2, 1e-3, 1e-4):
        begin = State(0.0, np.array(network.nodes.position), moving)
        history = simulate(
            network, duration=duration, output_step=duration / 4.0, start=begin, method=method, tolerance=tolerance
        )
        errors.append(float(np.abs(history.final.position[1, 0] - (2.0 - slack)) / 2.0))
        peaks.append(float(history.tension_peak.max()) / (speed * math.sqrt(spring * mass)))
    assert np.all(np.array(errors) < [2e-2, 2e-3, 2e-4])
    assert peaks == pytest.approx([1.0, 1.0, 1.0], abs=2e-4)


def test_modes_of_a_large_network_by_shift_and_inversion():
    """A taut string of 400 bars, far from the size of the dense solver: n pi c / L in both directions across."""
    builder = NetworkBuilder(Water(math.inf, 1000.0, 1e-12))
    builder.fixed("one", (0.0, 0.0, -500.0))
    builder.fixed("two", (40.0, 0.0, -500.0))
    kind = BarType("string", 2.0, 1e6, 1e-9)
    builder.line("string", "one", "two", kind, length=39.6, segments=400, shape="straight")
    network = builder.build()
    rest = solve_equilibrium(network)
    pull = 1e6 * (40.0 / 39.6 - 1.0)
    assert rest.tension == pytest.approx(pull, rel=1e-9)
    speed = math.sqrt(pull / (2.0 * 39.6 / 40.0))
    modes = natural_modes(network, rest.state, count=6)
    assert modes.omega == pytest.approx(np.array([1, 1, 2, 2, 3, 3]) * math.pi * speed / 40.0, rel=1e-4)
