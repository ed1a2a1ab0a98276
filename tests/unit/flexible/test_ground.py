"""A bed that varies: its surface, its contact against closed forms and turned axes, lines on it at rest."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import fsolve
from scipy.spatial.transform import Rotation

from moyai.core.errors import InputError
from moyai.flexible import force_kernel
from moyai.flexible.arrays import kernel_arrays
from moyai.flexible.bed import Bed, Ground, plane_ground
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType
from moyai.flexible.explicit import ExplicitRun
from moyai.flexible.explicit_motion import kick_on_ground_and_drift, kick_with_friction_and_drift
from moyai.flexible.explicit_rows import FX, TX, X
from moyai.flexible.flow import Flow
from moyai.flexible.ground_kernel import ground_shape
from moyai.flexible.relaxation import kernel_system
from moyai.flexible.result import State
from moyai.flexible.simulation import simulate
from moyai.flexible.statics import solve_equilibrium
from moyai.sea.water import Water

#: Next to no water.
AIR = Water(depth=100.0, density=1e-9, gravity=9.81)
CHAIN = BarType("chain", 50.0, 1e9, 0.1, viscosity=1e5)
ROPE = BarType("rope", 50.0, 2e5, 0.1)


def random_ground(seed: int = 3) -> Ground:
    rng = np.random.default_rng(seed)
    return Ground(
        np.cumsum(rng.uniform(1.0, 4.0, 6)), np.cumsum(rng.uniform(1.0, 4.0, 5)), rng.uniform(-20.0, -17.0, (6, 5))
    )


def test_levels_are_bilinear_between_grid_lines_and_flat_outside():
    from scipy.interpolate import RegularGridInterpolator

    ground = random_ground()
    bed, exact = Bed.on(ground, 1e5), RegularGridInterpolator((ground.x, ground.y), ground.level)
    # middles of the cells, where no slope turns, and far outside
    x, y = 0.5 * (ground.x[1:] + ground.x[:-1]), 0.5 * (ground.y[1:] + ground.y[:-1])
    places = np.stack(np.meshgrid(x + 0.3, y - 0.2, indexing="ij"), axis=-1)
    np.testing.assert_allclose(bed.level_at(places), exact(places), rtol=1e-14)
    np.testing.assert_allclose(bed.level_at([[-50.0, 100.0], [90.0, -7.0]]), ground.level[[0, -1], [-1, 0]], rtol=1e-14)
    # at a line the turn of the slope moves the level by the change of slope times a quarter of its half width
    steps = np.diff(ground.level[:, 2]) / np.diff(ground.x)
    half = 0.02 * np.minimum(np.diff(ground.x)[:-1], np.diff(ground.x)[1:])
    place = np.stack([ground.x[1:-1], np.full(4, 0.5 * (ground.y[2] + ground.y[3]))], axis=-1)
    one = bed.level_at(place) - exact(place)
    two = 0.5 * sum(np.diff(np.diff(ground.level[:, k]) / np.diff(ground.x)) * half / 4.0 for k in (2, 3))
    np.testing.assert_allclose(one, two, atol=1e-13)
    assert steps.size == 5
    crossings = np.stack(np.meshgrid(ground.x, ground.y, indexing="ij"), axis=-1)
    moved = np.abs(bed.level_at(crossings) - ground.level).max()
    assert 0.3 * ground.rounding < moved <= ground.rounding * (1.0 + 1e-9)


@pytest.mark.parametrize("where", [(3.0, 4.0), (7.02, 6.9), (-3.0, 5.0), (0.0, 0.0)])
def test_slopes_and_curvatures_are_the_derivatives_of_the_level(where):
    ground = random_ground()
    if where == (0.0, 0.0):
        # on two grid lines at once
        where = (ground.x[2] + 0.01, ground.y[3] - 0.005)
    bed, h = Bed.on(ground, 1e5).numbers(), 1e-6
    here = np.array(ground_shape(bed, *where))
    for axis, rows in ((0, (1, 3, 4)), (1, (2, 4, 5))):
        step = h * np.eye(2)[axis]
        change = np.subtract(ground_shape(bed, *(where + step)), ground_shape(bed, *(where - step))) / (2.0 * h)
        np.testing.assert_allclose(here[list(rows)], change[:3], atol=1e-8)


def test_a_plane_is_kept_exactly_and_a_bad_grid_is_refused():
    bed = Bed.on(plane_ground(-20.0, (0.1, -0.05), 500.0), 1e5)
    places = np.random.default_rng(1).uniform(-400.0, 400.0, (50, 2))
    np.testing.assert_allclose(bed.level_at(places), -20.0 + places @ [0.1, -0.05], rtol=1e-13)
    found = bed.contact_at(np.column_stack([places, bed.level_at(places) - 0.3]))
    up = 1.0 / math.sqrt(1.0 + 0.1**2 + 0.05**2)
    np.testing.assert_allclose(found, np.tile([0.3 * up, -0.1 * up, 0.05 * up, up], (50, 1)), rtol=1e-11)
    with pytest.raises(InputError, match="do not grow"):
        Ground([0.0, 0.0], [0.0, 1.0], np.zeros((2, 2)))
    with pytest.raises(InputError, match="on a grid of 2 by 2"):
        Ground([0.0, 1.0], [0.0, 1.0], np.zeros((2, 3)))


def test_steps_on_a_plane_are_those_on_a_flat_bed_in_turned_axes():
    """Contact, dashpot and friction of both kernels, with forces in any direction; the flat kernels are the older."""
    slope, rng = 0.4, np.random.default_rng(5)
    turn = Rotation.from_euler("y", -math.atan(slope))
    builders = {}
    for name, bed in (
        ("flat", Bed(0.0, 2e5, 3e3, 0.4)),
        ("plane", Bed.on(plane_ground(0.0, (slope, 0.0), 100.0), 2e5, 3e3, 0.4)),
    ):
        builder = NetworkBuilder(Water(depth=50.0, density=1e-9, gravity=1e-9), bed)
        for k in range(40):
            builder.free(f"p{k}", (float(k), 0.0, 20.0), mass=10.0, contact_area=1.0)
        for k in range(39):
            builder.line(f"l{k}", f"p{k}", f"p{k + 1}", CHAIN, length=1.0, segments=1, shape="straight")
        builders[name] = builder.build()
    place = rng.uniform(-3.0, 3.0, (40, 3)) * [1.0, 1.0, 0.02]
    speed, force = rng.normal(size=(40, 3)), 1e4 * rng.normal(size=(40, 3))
    ended = {}
    for name, network in builders.items():
        own = turn.apply if name == "plane" else np.asarray
        run = ExplicitRun(network, {}, Flow(), State(0.0, own(place), own(speed)), safety=None, load_steps=1)
        memory, packed = run.packed.memory, run.packed
        packed.node_rows(FX, 3)[:] = 0.0
        packed.node_rows(TX, 3)[:] = own(force).T
        if name == "plane":
            kick_on_ground_and_drift(memory, 40, run.bed, 0.4, 0.003, 0.003)
            back = turn.inv().apply
        else:
            kick_with_friction_and_drift(memory, 40, 0.0, 0.4, 0.003, 0.003)
            back = np.asarray
        left, tension, mass = np.zeros((40, 3)), np.zeros(39), np.zeros((40, 6))
        x, v = np.ascontiguousarray(own(place)), np.ascontiguousarray(own(speed))
        force_kernel.forces(
            x, v, np.zeros((7, 40)), kernel_system(kernel_arrays(network)), np.array([1e-9, 0.0, 0.0]), run.bed, left,
            tension, mass,
        )  # fmt: skip
        weight = kernel_arrays(network).node("weight")[:, None] * [0.0, 0.0, -1.0]
        ended[name] = back(packed.node_rows(X, 3).T), back(run.speed.T), back(left - weight)
    for flat, plane in zip(ended["flat"], ended["plane"], strict=True):
        np.testing.assert_allclose(plane, flat, rtol=1e-9, atol=1e-9 * np.abs(flat).max())
    assert (place[:, 2] < 0.0).sum() > 10


def test_the_tangent_of_a_curved_bed_is_the_derivative_of_its_push():
    """Along the normal the stiffness, in the plane of the bed the push times the curvature, at a bend of the grid."""
    ground, stiffness = random_ground(), 1e6
    builder = NetworkBuilder(Water(depth=50.0, density=1e-9, gravity=1e-9), Bed.on(ground, stiffness))
    at = np.array([ground.x[2] + 0.003, ground.y[3] - 0.005])
    place = np.array([[*at, float(builder.bed.level_at(at)) - 1e-4], [*at, 5.0]])
    n = builder.bed.contact_at(place[0])[0, 1:]
    builder.free("low", place[0], mass=1.0, contact_area=1.0)
    builder.free("high", place[1], mass=1.0)
    builder.line(
        "thread", "low", "high", BarType("thread", 1e-9, 1e-9, 1e-9), length=90.0, segments=1, shape="straight"
    )
    arrays = kernel_arrays(builder.build())
    bed, system, fluid = builder.bed.numbers(), kernel_system(arrays), np.array([1e-9, 0.0, 0.0])
    still, water, mass = np.zeros((2, 3)), np.zeros((7, 2)), np.zeros((2, 6))

    def push(x):
        force = np.zeros((2, 3))
        force_kernel.forces(x, still, water, system, fluid, bed, force, np.zeros(1), mass)
        return force[0]

    bar_law, node_law = np.zeros((2, 1)), np.zeros((4, 2))
    force_kernel.laws(place, still, system, fluid, bed, 0.0, 1.0, bar_law, node_law)
    block = np.zeros((2, 3, 3))
    force_kernel.blocks(
        place, still, water, system, fluid, bed, mass, bar_law, node_law, 0.0, 0.0, 1.0, True, block,
        np.zeros((1, 2, 3, 3)),
    )  # fmt: skip
    h, change = 1e-7, np.empty((3, 3))
    for axis in range(3):
        step = h * np.eye(3)[axis] * np.array([[1.0], [0.0]])
        change[:, axis] = (push(place - step) - push(place + step)) / (2.0 * h)
    flat = np.eye(3) - np.outer(n, n)
    assert n @ block[0] @ n == pytest.approx(stiffness, rel=1e-7)
    assert n @ change @ n == pytest.approx(stiffness, rel=1e-3)
    curved = flat @ block[0] @ flat
    assert np.abs(curved).max() > 10.0
    np.testing.assert_allclose(flat @ change @ flat, curved, atol=0.01 * np.abs(curved).max())


def sliding(friction: float, method: str, slope: float = 0.2):
    bed = Bed.on(plane_ground(-20.0, (slope, 0.0), 500.0), 1e5, 1e3, friction)
    builder = NetworkBuilder(AIR, bed)
    nx, _, nz = bed.contact_at([[0.0, 0.0, 0.0]])[0, 1:]
    # as deep as its weight presses it
    deep = 10.0 * 9.81 * nz / 1e5
    for k in range(2):
        place = np.array([0.0, 3.0 * k, -20.0]) - deep * np.array([nx, 0.0, nz])
        builder.free(f"ball {k}", place, mass=10.0, contact_area=1.0)
    # a slack thread between the two: it has next to no weight
    thread = BarType("thread", 1e-9, 1.0, 1e-9)
    builder.line("thread", "ball 0", "ball 1", thread, length=3.1, segments=1, shape="straight")
    step = 1e-4 if method == "explicit" else None
    return simulate(builder.build(), duration=2.0, output_step=0.5, method=method, step=step, tolerance=1e-5)


@pytest.mark.parametrize("method", ["explicit", "tr_bdf2"])
def test_balls_slide_by_their_weight_along_the_slope_less_friction(method):
    angle = math.atan(0.2)
    for friction in (0.0, 0.1):
        history = sliding(friction, method)
        pace = 9.81 * (math.sin(angle) - friction * math.cos(angle))
        way = np.linalg.norm(history.position[:, 0] - history.position[0, 0], axis=1)
        np.testing.assert_allclose(way, 0.5 * pace * history.time**2, rtol=1e-5, atol=1e-5 + friction * 1e-2)
        # a ball that slides without friction keeps its energy
        if friction == 0.0:
            fall = history.position[0, 0, 2] - history.position[-1, 0, 2]
            kinetic = 0.5 * np.sum(history.final.velocity[0] ** 2)
            assert kinetic == pytest.approx(9.81 * fall, rel=1e-5)


def test_friction_over_the_slope_holds_the_balls():
    history = sliding(0.25, "explicit")
    assert np.abs(history.position[-1] - history.position[0]).max() < 1e-6


def test_a_line_on_a_slope_is_the_catenary_that_meets_it_at_its_angle():
    slope, length, across, high, weight = 0.15, 120.0, 100.0, 45.0, 50.0 * 9.81
    angle = math.atan(slope)

    def misses(unknown):
        pull, lifted = unknown
        up = pull * slope
        along = pull / weight * (math.asinh((up + weight * lifted) / pull) - math.asinh(up / pull))
        rise = (math.hypot(pull, up + weight * lifted) - math.hypot(pull, up)) / weight
        lying = length - lifted
        return along + lying * math.cos(angle) - across, rise + lying * math.sin(angle) - high

    pull, lifted = fsolve(misses, (2e4, 70.0), xtol=1e-12)
    assert 10.0 < length - lifted < 90.0
    # tensions in the middle of the outer bars: half of their weight hangs on the ends
    top, steep = math.hypot(pull, pull * slope + weight * lifted), (pull * slope + weight * lifted) / pull
    anchor = pull / math.cos(angle) - weight * (length - lifted) * math.sin(angle)
    errors = []
    for segments in (60, 120):
        builder = NetworkBuilder(AIR, Bed.on(plane_ground(-60.0, (slope, 0.0), 500.0), 1e7))
        builder.fixed("anchor", (0.0, 0.0, -60.0))
        builder.fixed("top", (across, 0.0, -60.0 + high))
        builder.line("line", "anchor", "top", CHAIN, length=length, segments=segments)
        rest = solve_equilibrium(builder.build())
        assert rest.residual < 1e-6
        half = 0.5 * weight * length / segments
        up, down = half * steep / math.hypot(1.0, steep), half * math.sin(angle)
        errors.append([rest.tension[-1] / (top - up) - 1.0, rest.tension[0] / (anchor + down) - 1.0])
    assert np.abs(errors[1]).max() < 0.01
    assert np.abs(errors[1]).max() < 0.6 * np.abs(errors[0]).max()


@pytest.mark.parametrize(("friction", "turn"), [(0.0, 0.0), (0.1, 0.7), (0.1, 2.0), (0.5, 4.0)])
def test_friction_holds_what_lies_on_a_slope_as_far_as_it_reaches(friction, turn):
    """A chain that hangs down the slope from its upper end: w L (sin a - mu cos a) there, nothing on gentler slopes."""
    slope, length, segments = 0.2, 40.0, 20
    way = np.array([math.cos(turn), math.sin(turn)])
    builder = NetworkBuilder(AIR, Bed.on(plane_ground(-20.0, tuple(slope * way), 500.0), 1e7, 0.0, friction))
    angle, weight = math.atan(slope), 50.0 * 9.81
    down = -length * math.cos(angle) * way
    builder.fixed("top", (0.0, 0.0, -20.0))
    builder.free("low", (*down, -20.0 - length * math.sin(angle)))
    builder.line("line", "top", "low", CHAIN, length=length, segments=segments)
    rest = solve_equilibrium(builder.build())
    pull = weight * length * (1.0 - 0.5 / segments) * (math.sin(angle) - min(friction, slope) * math.cos(angle))
    assert rest.residual < 1e-6
    assert rest.tension[0] == pytest.approx(pull, rel=2e-3, abs=1e-3 * weight * length)


@pytest.mark.parametrize("turn", [0.0, 90.0, 180.0, 217.0])
def test_a_slack_chain_hangs_from_its_upper_end_whichever_way_the_bed_rises(turn):
    """Longer than its way: what hangs is as long as its upper end is high over the bed, the rest lies where it is."""
    way = np.array([math.cos(math.radians(turn)), math.sin(math.radians(turn))])
    bed = Bed.on(plane_ground(-30.0, tuple(0.2 * way), 500.0), 3e5, 0.0, 0.4)
    builder = NetworkBuilder(AIR, bed)
    builder.fixed("anchor", (0.0, 0.0, -30.0))
    builder.fixed("top", (40.0, 0.0, -1.0))
    chain = BarType("chain", 50.0, 1.3e8, 0.1, viscosity=1e5)
    builder.line("line", "anchor", "top", chain, length=80.0, segments=80)
    rest = solve_equilibrium(builder.build())
    assert rest.residual < 1e-6
    hanging = 29.0 - 0.2 * 40.0 * way[0]
    assert rest.tension[-1] == pytest.approx(50.0 * 9.81 * (hanging - 0.5), abs=1.0 * 50.0 * 9.81)


def hump(x):
    return -30.0 + 6.0 * np.exp(-((x - 20.0) ** 2) / 80.0)


def over_the_hump(lines: int, segments: int = 80):
    """Return a line of 45 m over a hump of 6 m, its anchor at the foot and its pulled end on the far flank."""
    x = np.linspace(-20.0, 60.0, lines)
    builder = NetworkBuilder(AIR, Bed.on(Ground(x, [-5.0, 5.0], np.tile(hump(x)[:, None], (1, 2))), 1e7))
    builder.fixed("anchor", (0.0, 0.0, float(hump(0.0))))
    builder.fixed("end", (42.0, 0.0, float(hump(42.0))))
    fine = np.linspace(0.0, 42.0, 20001)
    arc = float(np.sum(np.hypot(np.diff(fine), np.diff(hump(fine)))))
    builder.line("line", "anchor", "end", ROPE, length=0.96 * arc, segments=segments)
    return builder.build()


def test_tensions_over_a_hump_settle_with_the_grid():
    tops = [solve_equilibrium(over_the_hump(lines)).tension.max() for lines in (11, 21, 41, 81)]
    away = np.abs(np.array(tops[:-1]) - tops[-1])
    assert away[1] < 0.5 * away[0]
    assert away[2] < 0.5 * away[1]


def test_friction_takes_nothing_off_a_taut_line_over_a_hump():
    """It would act on what the line presses onto the hump, and its sign is that of a way that statics do not know."""
    network = over_the_hump(21, 40)
    rough = replace(network, bed=replace(network.bed, friction=0.5))
    assert np.array_equal(solve_equilibrium(rough).tension, solve_equilibrium(network).tension)


def test_tension_and_strain_energy_over_a_hump_follow_the_height():
    """Exact for a thread without friction, wherever the bed carries it: T + T^2 / 2 EA rises by weight times height."""
    misses = []
    for lines, segments in ((41, 80), (81, 160), (161, 320)):
        network = over_the_hump(lines, segments)
        rest, strand = solve_equilibrium(network), network.strands[0]
        assert rest.residual < 1e-6
        middles = 0.5 * (rest.state.position[strand.nodes[1:]] + rest.state.position[strand.nodes[:-1]])
        head = rest.tension[strand.bars] + rest.tension[strand.bars] ** 2 / (2.0 * ROPE.axial_stiffness)
        misses.append(np.abs(head - head[0] - 50.0 * 9.81 * (middles[:, 2] - middles[0, 2])).max())
    assert misses[1] < 0.5 * misses[0]
    assert misses[2] < 0.5 * misses[1]
    assert misses[2] < 0.01 * 50.0 * 9.81 * 6.0


@pytest.mark.parametrize("method", ["explicit", "tr_bdf2"])
def test_both_schemes_hold_the_rest_that_statics_finds(method):
    network = over_the_hump(21, 40)
    rest = solve_equilibrium(network)
    history = simulate(network, duration=2.0, output_step=0.5, start=rest.state, method=method)
    assert history.status == "converged"
    np.testing.assert_allclose(history.tension[-1], rest.tension, atol=1e-3 * rest.tension.max())
