"""Forces, tangents and schemes of flexible networks held against identities at random inputs."""

import math
from dataclasses import replace

import numpy as np
import pytest
from networks_for_tests import NO_GRAVITY, random_network, rope, still

from moyai.flexible import explicit_forces, explicit_motion, explicit_rows, force_kernel, front_kernel
from moyai.flexible.arrays import kernel_arrays, kernel_bed
from moyai.flexible.elements import Bars, BarType, Nodes
from moyai.flexible.explicit import ExplicitRun
from moyai.flexible.flow import Flow
from moyai.flexible.implicit import ImplicitRun
from moyai.flexible.network import Network
from moyai.flexible.refine import with_viscosity
from moyai.flexible.relaxation import kernel_system, plan_of
from moyai.flexible.result import State
from moyai.flexible.simulation import simulate
from moyai.flexible.sparse import make_plan
from moyai.sea.irregular import WaveComponents
from moyai.sea.water import Water


def evaluate(network, place, speed, water):
    arrays = kernel_arrays(network)
    count = len(network.nodes)
    force, mass, tension = np.zeros((count, 3)), np.zeros((count, 6)), np.zeros(len(network.bars))
    fluid = np.array([network.water.density, network.water.gravity, 0.0])
    force_kernel.forces(place, speed, water, kernel_system(arrays), fluid, kernel_bed(network), force, tension, mass)
    return force, mass, tension


@pytest.mark.parametrize("seed", range(6))
def test_elastic_forces_are_the_gradient_of_the_energy(seed):
    rng = np.random.default_rng(seed)
    network = random_network(rng, bed=False)
    place, still_water = np.array(network.nodes.position), np.zeros((7, len(network.nodes)))
    # far below the surface weight and buoyancy are constant: subtract them by evaluating without stretch
    arrays = kernel_arrays(network)
    system, mass = kernel_system(arrays), np.zeros((len(place), 6))
    force, _, _ = evaluate(network, place, np.zeros_like(place), still_water)
    constant = np.zeros_like(place)
    constant[:, 2] = -arrays.node("weight") + network.water.density * network.water.gravity * network.node_volume

    def energy(x):
        return force_kernel.energies(x, np.zeros_like(x), mass, system)[1]

    step = 1e-6
    scale = np.max(np.abs(force - constant))
    for node in range(len(place)):
        for axis in range(3):
            up, down = place.copy(), place.copy()
            up[node, axis] += step
            down[node, axis] -= step
            slope = (energy(up) - energy(down)) / (2.0 * step)
            assert force[node, axis] - constant[node, axis] == pytest.approx(-slope, abs=2e-5 * scale)


@pytest.mark.parametrize("seed", range(6))
def test_tangent_is_the_derivative_of_the_forces(seed):
    rng = np.random.default_rng(100 + seed)
    network = random_network(rng)
    if seed % 2:
        # through the surface, where the immersed parts change as well
        up = np.array([0.0, 0.0, -network.nodes.position[:, 2].mean()])
        network = replace(network, nodes=replace(network.nodes, position=network.nodes.position + up))
        network = with_viscosity(network, 0.0)
    count = len(network.nodes)
    # the pull of viscosity changes as the bar turns, which the tangent leaves out: fast bodies have none here
    place, speed = np.array(network.nodes.position), rng.normal(0.0, 0.3 if seed % 2 else 1e-3, (count, 3))
    arrays = kernel_arrays(network)
    water, place_part, rate_part = np.zeros((7, count)), rng.uniform(0.1, 1.0), rng.uniform(0.1, 1.0)
    water[:3] = rng.normal(0.0, 0.5, (3, 1))
    system, bed = kernel_system(arrays), kernel_bed(network)
    # rounded, so that the difference quotient does not cross the kink of a bar coming taut
    fluid = np.array([network.water.density, network.water.gravity, 20.0])
    force, mass, tension = np.zeros((count, 3)), np.zeros((count, 6)), np.zeros(len(network.bars))

    def left(x, v):
        force_kernel.forces(x, v, water, system, fluid, bed, force, tension, mass)
        return force * arrays.nodes[9:12].T

    left(place, speed)
    bar_law, node_law = np.zeros((2, len(network.bars))), np.zeros((4, count))
    node_block, bar_block = np.zeros((count, 3, 3)), np.zeros((len(network.bars), 2, 3, 3))
    force_kernel.laws(place, speed, system, fluid, bed, rate_part, place_part, bar_law, node_law)
    force_kernel.blocks(
        place, speed, water, system, fluid, bed, mass, bar_law, node_law, 0.0, rate_part, place_part, True, node_block,
        bar_block,
    )  # fmt: skip
    plan = plan_of(network, arrays)
    numbers = np.zeros(plan.size)
    front_kernel.to_fronts(node_block, bar_block, system, place_part, plan.own, plan.pairs[0], plan.pairs[1], numbers)
    matrix = dense(plan, numbers)
    free = arrays.nodes[9:12].T > 0.0
    direction = rng.normal(0.0, 1.0, (count, 3)) * free
    step = 1e-7
    change = -(
        left(place + place_part * step * direction, speed + rate_part * step * direction).copy()
        - left(place - place_part * step * direction, speed - rate_part * step * direction)
    ) / (2.0 * step)
    found = (matrix @ direction.ravel()).reshape(count, 3)
    assert found[free] == pytest.approx(change[free], rel=1e-4, abs=1e-4 * np.max(np.abs(change)))


def dense(plan, numbers):
    """Spread the fronts of a plan over one matrix."""
    matrix = np.zeros((3 * len(plan.order), 3 * len(plan.order)))
    for first, own, later, begin, at, _ in plan.fronts:
        nodes = plan.order[np.concatenate([np.arange(first, first + own), plan.later[begin : begin + later]])]
        index = (3 * nodes[:, None] + np.arange(3)).ravel()
        matrix[np.ix_(index, index)] += numbers[at : at + index.size**2].reshape(index.size, index.size)
    return matrix


@pytest.mark.parametrize("seed", range(6))
def test_the_sparse_solver_is_gauss_elimination(seed):
    """Random graphs, from trees to nets with chords: the fronts hold the matrix and solve with it."""
    rng = np.random.default_rng(900 + seed)
    count = int(rng.integers(2, 60))
    bars = np.stack([np.arange(1, count), rng.integers(0, np.arange(1, count))], axis=1)
    more = rng.integers(0, count, (int(rng.integers(0, count)), 3))
    more = more[(more[:, 0] != more[:, 1]) & (more[:, 1] != more[:, 2]) & (more[:, 0] != more[:, 2])]
    plan = make_plan(rng.normal(size=(count, 3)), [bars, more.reshape(-1, 3)])
    numbers, matrix = np.zeros(plan.size), np.zeros((3 * count, 3 * count))
    for members, pairs in zip((bars, more), plan.pairs, strict=True):
        blocks = rng.normal(size=(len(members), members.shape[1], members.shape[1], 3, 3))
        front_kernel.add_elements(blocks, members, pairs, np.ones((3, count)), 1.0, numbers)
        for element, nodes in zip(blocks, members, strict=True):
            for i, a in enumerate(nodes):
                for j, b in enumerate(nodes):
                    matrix[3 * a : 3 * a + 3, 3 * b : 3 * b + 3] += element[i, j]
    assert dense(plan, numbers) == pytest.approx(matrix)
    weight = 2.0 * np.abs(matrix).sum(axis=1).max()
    for node in range(count):
        for axis in range(3):
            numbers[plan.own[node, 0] + axis * (plan.own[node, 1] + 1)] += weight
    right = rng.normal(size=(count, 3))
    exact = np.linalg.solve(matrix + weight * np.eye(3 * count), right.ravel())
    assert front_kernel.factor_fronts(numbers, plan.fronts, plan.target, True)
    front_kernel.solve_fronts(numbers, plan.fronts, plan.later, plan.order, right)
    assert right.ravel() == pytest.approx(exact, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("seed", range(8))
def test_both_families_of_schemes_see_the_same_forces(seed):
    """The vectorised kernels and the plain ones: same acceleration in waves and current, partly out of the water."""
    rng = np.random.default_rng(200 + seed)
    network = random_network(rng, bed=False)
    lift = -network.nodes.position[:, 2].mean()
    nodes = network.nodes
    raised = np.array(nodes.position) + np.array([0.0, 0.0, lift])
    network = Network(
        Nodes(
            raised,
            nodes.kind,
            nodes.held,
            nodes.motion,
            nodes.mass,
            nodes.volume,
            nodes.drag_area,
            nodes.added_mass,
            nodes.contact_area,
            nodes.height,
            nodes.form,
        ),
        network.bars,
        network.water,
        None,
        network.strands,
    )
    sea = WaveComponents([1.0, 1.7], [0.5, 0.2], [0.3, 2.0], [0.2, -1.0], [0.12, 0.3], Water(30.0, 1025.0, 9.81))
    flow = Flow((0.4, -0.3, 0.0), waves=sea)
    state = State(0.7, raised, rng.normal(0.0, 0.5, raised.shape))
    one = ExplicitRun(network, {}, flow, state, safety=0.9, load_steps=4)
    two = ImplicitRun(network, {}, flow, state, method="tr_bdf2", tolerance=1e-3)
    memory, sizes = one.packed.memory, one.packed.sizes
    for axis in range(3):
        source = (explicit_rows.QX + axis * explicit_rows.ROW, explicit_rows.TX + axis * explicit_rows.ROW)
        memory[source[1] : source[1] + sizes[0]] = memory[source[0] : source[0] + sizes[0]]
    explicit_forces.spine_forces(memory, sizes[1])
    explicit_forces.rib_forces(memory, one.packed.runs, one.arrays.curves)
    explicit_forces.bending_forces(memory, one.arrays.hinges, one.arrays.bending)
    before = one.speed.copy()
    explicit_motion.kick_and_drift(memory, sizes[0], 1.0, 0.0)
    found = (one.speed - before).T
    assert found == pytest.approx(two.acceleration, rel=1e-9, abs=1e-9 * np.max(np.abs(two.acceleration)))
    assert one.packed.bar_row(explicit_rows.PULL) == pytest.approx(two.tension, rel=1e-9, abs=1e-6)


def test_nodes_on_a_smooth_bed_fulfil_the_implicit_law_of_spring_and_dashpot():
    """Random inverse masses, forces and speeds: the impulse of the bed is that of where and how fast the node ends."""
    rng = np.random.default_rng(77)
    count, level, time = 40, -5.0, 0.01
    row = explicit_rows
    memory = np.zeros(row.TOTAL_ROWS * row.ROW)

    def own(name):
        first = getattr(row, name)
        return memory[first : first + count]

    half = rng.normal(size=(count, 3, 3))
    inverse = half @ half.transpose(0, 2, 1) + 0.2 * np.eye(3)
    for name, (i, j) in {
        "IXX": (0, 0),
        "IXY": (0, 1),
        "IXZ": (0, 2),
        "IYY": (1, 1),
        "IYZ": (1, 2),
        "IZZ": (2, 2),
    }.items():
        own(name)[:] = inverse[:, i, j]
    load, pull, speed = (rng.normal(size=(3, count)) for _ in range(3))
    for axis, name in enumerate("XYZ"):
        own(f"T{name}")[:], own(f"F{name}")[:] = load[axis], pull[axis]
        own("UVW"[axis])[:] = speed[axis]
    own("Z")[:] = level + rng.normal(0.0, 0.02, count)
    own("STIFF")[:], own("DAMP")[:] = rng.uniform(1.0, 1e3, count), rng.uniform(0.0, 30.0, count)
    depth = level - own("Z")
    force = load + np.diff(pull, axis=1, prepend=0.0)
    free = speed + time * np.einsum("kij,jk->ik", inverse, force)
    explicit_motion.kick_contact_and_drift(memory, count, level, time, 0.0)
    end = np.array([own(name) for name in "UVW"])
    impulse = (end[2] - free[2]) / inverse[:, 2, 2]
    law = time * (own("STIFF") * (depth - time * end[2]) - own("DAMP") * end[2])
    pushed = impulse > 1e-9
    assert 10 < pushed.sum() < 35
    assert np.allclose(impulse[pushed], law[pushed], rtol=1e-9)
    assert np.allclose(end, free + inverse[:, :, 2].T * np.where(pushed, impulse, 0.0), rtol=1e-9, atol=1e-9)
    # the others end above the bed, or are held back by their damping alone
    assert np.all((law[~pushed] < 1e-9) | (depth[~pushed] <= time * free[2][~pushed]))


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("method", ["explicit", "esdirk4"])
def test_momentum_of_a_loose_network_changes_with_its_weight_alone(seed, method):
    rng = np.random.default_rng(300 + seed)
    source = random_network(rng, bed=False, held=False)
    types = tuple(
        BarType(
            kind.name,
            kind.mass_per_length,
            kind.axial_stiffness,
            1e-9,
            viscosity=kind.viscosity,
            bending_stiffness=50.0,
        )
        for kind in source.bars.types
    )
    bars = Bars(source.bars.start, source.bars.end, source.bars.length, source.bars.kind, types)
    loose = Network(
        Nodes(source.nodes.position, np.zeros(len(source.nodes)), mass=source.nodes.mass),
        bars,
        Water(math.inf, 1000.0, 9.81),
        None,
        source.strands,
    )
    begin = State(0.0, np.array(loose.nodes.position), rng.normal(0.0, 2.0, loose.nodes.position.shape))
    duration = 0.5
    history = simulate(loose, duration=duration, output_step=0.05, start=begin, method=method)
    assert history.status == "converged"
    mass = loose.node_mass
    gain = mass @ (history.final.velocity - begin.velocity)
    size = float(mass @ np.linalg.norm(begin.velocity, axis=1))
    assert gain[:2] == pytest.approx(0.0, abs=1e-7 * size)
    assert gain[2] == pytest.approx(-mass.sum() * 9.81 * duration, rel=1e-7)

    def turn(state):
        arm = state.position - mass @ state.position / mass.sum()
        return np.sum(mass[:, None] * np.cross(arm, state.velocity), axis=0)

    if method == "explicit":
        assert turn(history.final) == pytest.approx(turn(begin), rel=2e-3, abs=2e-3 * np.max(np.abs(turn(begin))))


def test_a_blow_up_is_stopped_and_reported():
    network = rope(segments=10, span=(41.0, 0.0, 0.0))
    limit = ExplicitRun(network, {"end": still()}, Flow(), State.at_rest(network), safety=1.0, load_steps=1).limit()[0]
    begin = State.at_rest(network)
    begin.velocity[5, 1] = 0.1
    history = simulate(network, {"end": still()}, duration=10.0, output_step=0.05, start=begin, step=1.2 * limit)
    assert history.status == "not_converged"
    assert "stable below" in history.message and "t = " in history.message
    assert len(history.time) < 201


@pytest.mark.parametrize("seed", range(4))
def test_stable_step_bounds_the_highest_frequency_closely_from_below(seed):
    """Against the eigenvalues of the whole matrix, on lines and nets at random."""
    from scipy.linalg import eigh

    from moyai.flexible.modes import natural_modes

    rng = np.random.default_rng(400 + seed)
    network = random_network(rng, bed=False, bending=False, curve=False, held=False, tension_only=True)
    stretched = Bars(
        network.bars.start,
        network.bars.end,
        0.9
        * np.linalg.norm(network.nodes.position[network.bars.end] - network.nodes.position[network.bars.start], axis=1),
        network.bars.kind,
        tuple(
            BarType(k.name, k.mass_per_length, k.axial_stiffness, k.diameter, added_mass_normal=1.0)
            for k in network.bars.types
        ),
    )
    network = Network(network.nodes, stretched, network.water, None, network.strands)
    state = State.at_rest(network)
    run = ExplicitRun(network, {}, Flow(), state, safety=1.0, load_steps=1)
    modes = natural_modes(network, state, count=1000)
    assert eigh  # the modes come from the dense eigenproblem
    exact = 2.0 / modes.omega[-1]
    assert 0.4 * exact < run.limit()[0] < 1.08 * exact


def test_water_without_gravity_does_not_move_a_rope_at_rest():
    network = rope(segments=6)
    history = simulate(network, {"end": still()}, duration=1.0, output_step=0.1)
    assert NO_GRAVITY.gravity < 1e-9
    assert np.ptp(history.position, axis=0) == pytest.approx(0.0, abs=1e-9)
