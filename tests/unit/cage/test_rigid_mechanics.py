"""The mechanics of rigid cages against energy, exact periods, limits and symmetries, at geometries drawn at random."""

import math
from dataclasses import replace

import numpy as np
import pytest

from moyai.morison.net_law_names import Net, net_law, panel_force
from moyai.sea.components import WaveComponents
from moyai.sea.current import uniform
from moyai.sea.dispersion import wave_number
from moyai.sea.water import Water
from moyai.structures.cage.rigid import load_kernel, water_kernel
from moyai.structures.cage.rigid.lines import CageLine
from moyai.structures.cage.rigid.modes import mass_matrix, natural_modes
from moyai.structures.cage.rigid.pack import pack
from moyai.structures.cage.rigid.parts import Floats, PointWeight, RigidCage
from moyai.structures.cage.rigid.shapes import (
    box_floats,
    box_patches,
    box_rods,
    cylinder_patches,
    cylinder_rods,
    ring_floats,
)
from moyai.structures.cage.rigid.statics import (
    equilibrium_with_lines,
    force_at,
    free_floating,
    immersion,
    size_of,
    stiffness_at,
)
from moyai.structures.cage.rigid.time import march, march_fixed

NU = 1.14e-6
SEEDS = (1, 2, 3)


def random_cage(rng, *, drag=True, shape="box"):
    """Return a cage that floats with its net wholly under water, of 0.1 to 10 m."""
    size = 10.0 ** rng.uniform(-1.0, 1.0)
    length, width, height = size * rng.uniform(0.6, 1.4, 3)
    law = net_law("loland") if drag else net_law("matsubara", cap=1e-12)
    rod = 0.012 * size
    if shape == "box":
        patches = box_patches(length, width, height, ("sides", "bottom"), 3)
        rods = box_rods(length, width, height, rod)
        points = box_floats(length, width, 0.5 * height + 0.12 * size, 2)
    else:
        width = length
        patches = cylinder_patches(length, height, ("sides", "bottom"), 3)
        rods = cylinder_rods(length, height, rod)
        points = ring_floats(length, 0.5 * height + 0.12 * size, 8)
    density = rng.uniform(2000.0, 4000.0)
    rods = tuple(replace(item, mass=density * item.volume) for item in rods)
    thickness = 1.5e-4 * size
    weight = PointWeight(
        "w", (0.0, 0.0, -0.4 * height), 0.4 * size**3 * 1e-2, 0.4e-3 * size**3 * 1e-2, 0.6 if drag else 0.0, 0.5
    )
    heavy = sum(item.mass - 1000.0 * item.volume for item in rods) + thickness * patches.area * 6850.0 + weight.mass
    diameter = (6.0 / math.pi * heavy / (600.0 * len(points))) ** (1.0 / 3.0)
    floats = Floats(points, diameter, 50.0 * math.pi / 6.0 * diameter**3, 0.6 if drag else 0.0, 0.5)
    return RigidCage(
        floats,
        patches,
        Net(0.02 * size, 0.13 * size, 0.28),
        law,
        7850.0 * thickness,
        thickness,
        1.0,
        rods,
        1.2 if drag else 0.0,
        1.0,
        (length, width, height),
        (weight,),
        shape,
    )


def energy(cage, lines, packed, water, state):
    """Return kinetic and potential energy of cage, water that goes along, floats' buoyancy and lines."""
    rates = state[3:]
    moving = 0.5 * rates @ mass_matrix(packed, state[:3]) @ rates
    x, z = cage.centre
    arm = cage.floats.points[:, [0, 2]] - np.array([x, z])
    level = state[1] - math.sin(state[2]) * arm[:, 0] + math.cos(state[2]) * arm[:, 1]
    radius = 0.5 * cage.floats.diameter
    high = np.clip(radius - level, 0.0, 2.0 * radius)
    # integral of the volume of the cap over its depth, and of the whole sphere below
    below = math.pi * (radius * high**3 / 3.0 - high**4 / 12.0)
    deeper = np.maximum(radius - level - 2.0 * radius, 0.0) * cage.floats.volume
    floats = -water.density * water.gravity * float(np.sum(-below - deeper))
    weight = water.gravity * cage.mass * state[1]
    lift = 0.0
    parts = [(p[0], p[2], cage.net_volume * a) for p, a in zip(cage.patches.points, cage.patches.areas)]
    parts += [(0.5 * (rod.start[0] + rod.end[0]), 0.5 * (rod.start[2] + rod.end[2]), rod.volume) for rod in cage.rods]
    parts += [(item.point[0], item.point[2], item.volume) for item in cage.weights]
    for px, pz, volume in parts:
        height = state[1] - math.sin(state[2]) * (px - x) + math.cos(state[2]) * (pz - z)
        lift -= water.density * water.gravity * volume * height
    springs = 0.0
    for line in lines:
        stretch = line.span(state[:3], cage.centre) - line.length
        springs += 0.5 * line.stiffness * max(stretch, 0.0) ** 2
    return moving, floats + weight + lift + springs


def swell(height, period, water, heading=0.0):
    number = float(wave_number(2.0 * math.pi / period, water.depth, water.gravity))
    return WaveComponents(
        np.array([2.0 * math.pi / period]),
        np.array([0.5 * height]),
        np.zeros(1),
        np.array([heading]),
        np.array([number]),
        water,
    )


def pair(cage, free, water, kind="crossed", reach=1.5, stiffness=None, pull=0.3):
    """Return two mirrored lines that pull the floats about ``pull`` of their diameter under."""
    k = stiffness or 200.0 * cage.mass * water.gravity / size_of(cage)
    lines = []
    for side in (-1.0, 1.0):
        at = cage.attachment("top" if kind == "crossed" else "bottom", side)
        anchor = (side * reach * size_of(cage) * (-1.0 if kind == "crossed" else 1.0), -water.depth)
        line = CageLine("a" if side < 0 else "b", at, anchor, 1.0, k)
        span = line.span(free.place, cage.centre)
        lines.append(replace(line, length=span - 0.5 * pull * cage.floats.diameter))
    return tuple(lines)


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("shape", ["box", "cylinder"])
def test_energy_is_kept_without_drag(seed, shape):
    """Heave, sway, rotation, floats that pierce the surface, lines that go taut and slack: no drag, no loss."""
    rng = np.random.default_rng(seed)
    cage = random_cage(rng, drag=False, shape=shape)
    water = Water(6.0 * size_of(cage), 1000.0, 9.81)
    free = free_floating(cage, water, NU)
    lines = pair(cage, free, water, pull=0.0)
    packed = pack(cage, lines, water, NU)
    start = np.concatenate([free.place, np.zeros(3)])
    speed = math.sqrt(9.81 * cage.floats.diameter)
    start[3:] = 0.25 * speed * np.array([1.0, 0.8, 0.5 / size_of(cage)])
    period = 2.0 * math.pi * math.sqrt(cage.floats.diameter / 9.81)
    found = march(
        packed, start, duration=6 * period, spacing=0.02 * period, size=size_of(cage), period=period, tolerance=1e-10
    )
    assert found.events > 0
    levels = [energy(cage, lines, packed, water, row) for row in found.state]
    total = np.array([a + b for a, b in levels])
    assert np.ptp(total) < 2e-6 * levels[0][0]
    assert np.ptp([a for a, _ in levels]) > 0.2 * levels[0][0]


@pytest.mark.parametrize("seed", SEEDS)
def test_period_of_small_heave_is_exact(seed):
    """2 pi sqrt((M + added mass) / (rho g A)) from the formulas of a sphere's cap, against the march."""
    rng = np.random.default_rng(seed)
    cage = random_cage(rng, drag=False)
    water = Water(10.0 * size_of(cage), 1025.0, 9.81)
    free = free_floating(cage, water, NU)
    packed = pack(cage, (), water, NU)
    radius = 0.5 * cage.floats.diameter
    level = free.z + cage.floats.points[0, 2] - cage.centre[1]
    high = radius - level
    area = len(cage.floats.points) * math.pi * high * (2.0 * radius - high)
    added = 0.5 * water.density * len(cage.floats.points) * math.pi * high**2 * (radius - high / 3.0)
    added += 0.5 * water.density * sum(item.volume for item in cage.weights)
    level_rods = [rod for rod in cage.rods if abs(rod.start[2] - rod.end[2]) < 1e-12]
    added += water.density * sum(rod.volume for rod in level_rods)
    flat = np.abs(cage.patches.normals[:, 2])
    added += water.density * cage.net_volume * float(np.sum(cage.patches.areas * (0.5 + 0.5 * flat)))
    period = 2.0 * math.pi * math.sqrt((cage.mass + added) / (water.density * water.gravity * area))
    start = np.concatenate([free.place, np.zeros(3)])
    start[1] += 1e-5 * radius
    found = march(
        packed, start, duration=3 * period, spacing=period / 400, size=size_of(cage), period=period, tolerance=1e-11
    )
    heave = found.state[:, 1] - free.z
    down = np.flatnonzero((heave[:-1] > 0.0) & (heave[1:] <= 0.0))
    times = found.time[down] + heave[down] / (heave[down] - heave[down + 1]) * (found.time[1] - found.time[0])
    assert np.diff(times).mean() == pytest.approx(period, rel=1e-4)
    modes, _ = natural_modes(packed, free, size_of(cage))
    assert np.min(np.abs(modes / period - 1.0)) < 1e-4


@pytest.mark.parametrize("seed", SEEDS)
def test_waves_of_no_height_give_no_motion(seed):
    rng = np.random.default_rng(seed)
    cage = random_cage(rng)
    water = Water(5.0 * size_of(cage), 1000.0, 9.81)
    free = free_floating(cage, water, NU)
    lines = pair(cage, free, water)
    rest = equilibrium_with_lines(cage, lines, water, NU)
    packed = pack(cage, lines, water, NU, waves=swell(0.0, 3.0, water), ramp=1.0)
    found = march(
        packed, np.concatenate([rest.place, np.zeros(3)]), duration=20.0, spacing=0.5, size=size_of(cage), period=3.0
    )
    assert np.abs(found.state - found.state[0]).max() < 1e-5 * size_of(cage)


@pytest.mark.parametrize("seed", SEEDS)
def test_waves_and_current_reversed_mirror_the_motion(seed):
    rng = np.random.default_rng(seed)
    cage = random_cage(rng)
    water = Water(5.0 * size_of(cage), 1000.0, 9.81)
    free = free_floating(cage, water, NU)
    lines = pair(cage, free, water, "outward")
    period = 4.0 * math.sqrt(size_of(cage))
    runs = []
    for heading in (0.0, math.pi):
        current = uniform(0.05 * math.sqrt(9.81 * size_of(cage)), heading)
        waves = swell(0.2 * size_of(cage), period, water, heading)
        packed = pack(cage, lines, water, NU, waves=waves, current=current, ramp=period)
        rest = equilibrium_with_lines(cage, lines, water, NU, current)
        start = np.concatenate([rest.place, np.zeros(3)])
        runs.append(
            march(
                packed,
                start,
                duration=4 * period,
                spacing=0.05 * period,
                size=size_of(cage),
                period=period,
                tolerance=1e-9,
            )
        )
    sign = np.array([-1.0, 1.0, -1.0, -1.0, 1.0, -1.0])
    scale = np.abs(runs[0].state - runs[0].state[0]).max(axis=0)
    # a bounce amplifies rounding: the start must agree to it, the rest nearly
    gap = np.abs(runs[1].state * sign - runs[0].state) / scale
    assert gap[:20].max() < 1e-5
    assert gap.max() < 1e-2
    assert runs[0].state[0, 0] > 1e-4 * size_of(cage)
    assert np.abs(runs[1].tension[:20, ::-1] - runs[0].tension[:20]).max() < 1e-4 * runs[0].tension.max()


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("kind", ["crossed", "outward"])
def test_stiff_lines_leave_one_freedom_about_the_crossing_of_their_axes(seed, kind):
    """The four-bar linkage: the softest mode turns about the point where the axes of both lines meet."""
    rng = np.random.default_rng(seed)
    cage = random_cage(rng, drag=False)
    water = Water(4.0 * size_of(cage), 1000.0, 9.81)
    free = free_floating(cage, water, NU)
    weight = cage.mass * 9.81
    lines = pair(cage, free, water, kind, rng.uniform(0.9, 2.0), 1e7 * weight / size_of(cage), pull=1e-6)
    rest = equilibrium_with_lines(cage, lines, water, NU)
    packed = pack(cage, lines, water, NU)
    periods, shapes = natural_modes(packed, rest, size_of(cage))
    soft = shapes[0] * np.array([size_of(cage), size_of(cage), 1.0])
    # point of the body that does not move: velocity (vx + w rz, vz - w rx) = 0
    pole = np.array([rest.x, rest.z]) + np.array([soft[1], -soft[0]]) / soft[2]
    ends = [np.array(line.place(rest.place, cage.centre)) for line in lines]
    ways = [np.array(line.anchor) - end for line, end in zip(lines, ends)]
    share = np.linalg.solve(np.column_stack([ways[0], -ways[1]]), ends[1] - ends[0])
    crossing = ends[0] + share[0] * ways[0]
    assert np.abs(pole - crossing).max() < 1e-3 * size_of(cage)
    assert periods[1] < 0.01 * periods[0]


@pytest.mark.parametrize("seed", SEEDS)
def test_small_free_cage_without_drag_follows_the_orbit(seed):
    """Long waves: what floats has the mass of the water it displaces, and moves with it; coth kh : 1."""
    rng = np.random.default_rng(seed)
    cage = random_cage(rng, drag=False)
    water = Water(rng.uniform(25.0, 40.0) * size_of(cage), 1000.0, 9.81)
    period = rng.uniform(2.5, 4.0) * 2.0 * math.pi * math.sqrt(water.depth / 9.81)
    free = free_floating(cage, water, NU)
    height = 1e-3 * size_of(cage)
    packed = pack(cage, (), water, NU, waves=swell(height, period, water), ramp=4 * period)
    found = march(
        packed,
        np.concatenate([free.place, np.zeros(3)]),
        duration=7 * period,
        spacing=period / 100,
        size=size_of(cage),
        period=period,
        tolerance=1e-9,
    )
    tail = found.state[-101:]
    number = float(wave_number(2.0 * math.pi / period, water.depth, 9.81))
    sway = np.ptp(tail[:, 0] - np.linspace(0.0, tail[-1, 0] - tail[0, 0], 101))
    assert sway / height == pytest.approx(1.0 / math.tanh(number * water.depth), rel=0.02)
    assert np.ptp(tail[:, 1]) / height == pytest.approx(1.0, rel=0.02)


@pytest.mark.parametrize("seed", SEEDS)
def test_motion_is_linear_in_small_waves_without_drag(seed):
    rng = np.random.default_rng(seed)
    cage = random_cage(rng, drag=False)
    water = Water(5.0 * size_of(cage), 1000.0, 9.81)
    period = 5.0 * math.sqrt(size_of(cage))
    free = free_floating(cage, water, NU)
    motions = []
    for height in (2e-5 * size_of(cage), 1e-5 * size_of(cage)):
        packed = pack(cage, (), water, NU, waves=swell(height, period, water), ramp=2 * period)
        start = np.concatenate([free.place, np.zeros(3)])
        run = march(
            packed, start, duration=4 * period, spacing=period / 20, size=size_of(cage), period=period, tolerance=1e-12
        )
        motions.append((run.state[:, :3] - free.place) / height)
    assert np.abs(motions[0] - motions[1]).max() < 1e-3 * np.abs(motions[0]).max()


@pytest.mark.slow
def test_fixed_steps_converge_with_fourth_order_and_adaptive_ones_to_them():
    """In a smooth motion; with lines the adaptive marcher meets the limit of small fixed steps."""
    rng = np.random.default_rng(5)
    cage = random_cage(rng)
    water = Water(5.0 * size_of(cage), 1000.0, 9.81)
    period = 5.0 * math.sqrt(size_of(cage))
    free = free_floating(cage, water, NU)
    start = np.concatenate([free.place, np.zeros(3)])
    # without drag, whose table bends between its points, and without lines the forces are smooth
    smooth = pack(
        random_cage(np.random.default_rng(5), drag=False),
        (),
        water,
        NU,
        waves=swell(1e-3 * size_of(cage), period, water),
    )
    ends = [march_fixed(smooth, start, duration=period, step=period / n, every=n).state[-1] for n in (320, 640, 2560)]
    errors = [float(np.linalg.norm(end - ends[-1])) for end in ends[:-1]]
    assert math.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.2)
    lines = pair(cage, free, water, pull=0.2)
    rest = equilibrium_with_lines(cage, lines, water, NU)
    packed = pack(cage, lines, water, NU, waves=swell(0.12 * size_of(cage), period, water), ramp=period)
    start = np.concatenate([rest.place, np.zeros(3)])
    fine = march_fixed(packed, start, duration=3 * period, step=period / 12000, every=120)
    looks = []

    def stop_at_the_third_look(*said):
        looks.append(said)
        if len(looks) == 3:
            raise KeyboardInterrupt

    stopped = march_fixed(
        packed, start, duration=3 * period, step=period / 12000, every=120, progress=stop_at_the_third_look
    )
    assert (fine.status, stopped.status) == ("converged", "interrupted")
    assert 50 < len(stopped.time) < 100 < len(fine.time) == 301
    rows = slice(0, len(stopped.time))
    assert np.array_equal(stopped.state, fine.state[rows]) and np.array_equal(stopped.tension, fine.tension[rows])
    found = [
        march(
            packed,
            start,
            duration=3 * period,
            spacing=period / 100,
            size=size_of(cage),
            period=period,
            tolerance=tolerance,
        )
        for tolerance in (1e-5, 1e-8)
    ]
    gaps = [np.abs(item.state[:, :3] - fine.state[:, :3]).max() / size_of(cage) for item in found]
    assert found[1].events > 2
    assert gaps[1] < 1e-5 and gaps[0] < 1e-3 and gaps[1] < gaps[0]


@pytest.mark.parametrize("seed", SEEDS)
def test_water_in_the_kernel_is_that_of_the_sea(seed):
    rng = np.random.default_rng(seed)
    water = Water(10.0 ** rng.uniform(-1, 2), 1000.0, 9.81)
    omega = np.sort(rng.uniform(0.5, 4.0, 7)) * math.sqrt(9.81 / water.depth)
    waves = WaveComponents(
        omega,
        rng.uniform(0.0, 0.01, 7) * water.depth,
        rng.uniform(0, 6, 7),
        np.full(7, math.pi if seed == 2 else 0.0),
        np.asarray(wave_number(omega, water.depth, 9.81)),
        water,
    )
    cage = random_cage(rng)
    for stretching in ("constant", "wheeler"):
        packed = pack(cage, (), water, NU, waves=waves, stretching=stretching)
        for _ in range(20):
            x, z = rng.normal() * water.depth, -water.depth * rng.uniform(-0.02, 1.0)
            time, work = rng.uniform(0, 100), np.empty(6)
            water_kernel.water_at(packed, time, x, z, work)
            eta, velocity, acceleration = waves.kinematics(time, x, 0.0, z, stretching)
            wanted = np.array([eta, velocity[0], velocity[2], acceleration[0], acceleration[2]])
            assert work[:5] == pytest.approx(wanted, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize(("shortest", "terms"), [(3.0, 6), (9.0, 45)])
def test_irregular_seas_from_their_series_are_those_summed_at_every_part(shortest, terms):
    """Forces on a cage in 200 waves, from the series about it, against a sum at every float, patch and rod."""
    rng = np.random.default_rng(8)
    cage = random_cage(rng)
    size = size_of(cage)
    for depth in (4.0 * size, math.inf):
        water = Water(depth, 1000.0, 9.81)
        peak = 0.5 * math.sqrt(9.81 / size)
        omega = peak * rng.uniform(0.6, shortest, 200)
        amplitude = 0.01 * size * (peak / omega) ** 2.5
        number = np.asarray(wave_number(omega, depth, 9.81))
        heading = np.full(200, math.pi if math.isinf(depth) else 0.0)
        waves = WaveComponents(omega, amplitude, rng.uniform(0, 6, 200), heading, number, water)
        free = free_floating(cage, water, NU)
        for stretching in ("constant", "wheeler"):
            packed = pack(cage, (), water, NU, waves=waves, stretching=stretching)
            assert packed.summed.shape[2] >= terms
            direct = packed._replace(summed=np.zeros((16, 10, 0)))
            gaps, sizes = [], []
            for _ in range(30):
                state = np.concatenate([free.place, np.zeros(3)])
                state[:3] += rng.normal(size=3) * np.array([2.0 * size, 0.05 * size, 0.1])
                state[3:] += rng.normal(size=3) * np.array([0.1, 0.1, 0.1 / size]) * math.sqrt(9.81 * size)
                time = rng.uniform(0.0, 1000.0)
                values = []
                for item in (packed, direct):
                    force, mass, work = np.empty(3), np.empty((3, 3)), np.empty(6)
                    load_kernel.loads(item, time, state, np.zeros(0), force, mass, work)
                    values.append(force / np.array([1.0, 1.0, size]))
                gaps.append(np.abs(values[0] - values[1]).max())
                sizes.append(np.abs(values[1]).max())
            assert max(gaps) < 2e-3 * np.median(sizes)


@pytest.mark.parametrize("name", ["matsubara", "loland", "aarsnes", "kristiansen_faltinsen", "choo"])
def test_net_is_loaded_by_its_law(name):
    """A still cage of one tilted face in a uniform current, against the force of the law itself."""
    rng = np.random.default_rng(11)
    from moyai.morison.net_law_names import available_net_laws

    full = next((item for item in available_net_laws() if item.startswith(name)), name)
    cage = replace(random_cage(rng), law=net_law(full))
    water = Water(50.0 * size_of(cage), 1000.0, 9.81)
    speed = rng.uniform(0.2, 0.6)
    place = np.array([0.0, -20.0 * size_of(cage), 0.3])
    still = force_at(pack(cage, (), water, NU), place)
    flowing = force_at(pack(replace(cage, rods=(), weights=()), (), water, NU, current=uniform(speed, 0.0)), place)
    bare = force_at(pack(replace(cage, rods=(), weights=()), (), water, NU), place)
    cosine, sine = math.cos(0.3), math.sin(0.3)
    wanted = np.zeros(3)
    total = 0.5 * 1000.0 * 0.6 * math.pi / 4.0 * cage.floats.diameter**2 * len(cage.floats.points) * speed**2
    wanted[0] += total
    for normal, area in zip(cage.patches.normals, cage.patches.areas):
        turned = np.array([cosine * normal[0] + sine * normal[2], normal[1], -sine * normal[0] + cosine * normal[2]])
        wanted += panel_force(
            cage.law, cage.net, turned, (speed, 0.0, 0.0), area=float(area), density=1000.0, viscosity=NU
        )
    found = flowing - bare
    assert found[0] == pytest.approx(wanted[0], rel=2e-3)
    assert found[1] == pytest.approx(wanted[2], rel=2e-3, abs=2e-3 * abs(wanted[0]))
    assert still[1] != 0.0


@pytest.mark.parametrize(("across", "up"), [(0.7, -0.45), (-0.3, 0.8)])
def test_a_lumped_net_is_loaded_on_each_axis_by_the_square_of_its_speed(across, up):
    """The lump of a whole net in the equations as printed: rho C_n(|u|) A u |u| / 2 along x and along z, at its arm."""
    rng = np.random.default_rng(13)
    cage = random_cage(rng)
    packed = pack(cage, (), Water(50.0 * size_of(cage), 1000.0, 9.81), NU)
    arm, areas, volume, added = (0.4, -0.9), (1.7, 2.3), 0.02, 0.6
    lump = np.array([[*arm, volume, 1.0 + added, added, *areas]])
    turn, spin = 0.3, 0.4
    state = np.array([0.0, -20.0 * size_of(cage), turn, -across, -up, spin])

    def loaded(blocks):
        force, mass, work = np.empty(3), np.empty((3, 3)), np.empty(6)
        load_kernel.loads(packed._replace(blocks=blocks), 0.0, state, np.zeros(0), force, mass, work)
        return force, mass

    (force, mass), (bare, without) = loaded(lump), loaded(lump[:0])
    rx, rz = math.cos(turn) * arm[0] + math.sin(turn) * arm[1], -math.sin(turn) * arm[0] + math.cos(turn) * arm[1]
    # the water passes the lump at minus its own velocity
    u, w = across - spin * rz, up + spin * rx
    extra = 1000.0 * volume * added
    pushes = []
    for speed, area, reach in ((u, areas[0], rx), (w, areas[1], rz)):
        drag, _ = cage.law.coefficients(0.0, abs(speed), cage.net, NU)
        # the arm turns: its end is drawn to the middle, and the added mass with it
        pushes.append(0.5 * 1000.0 * area * float(drag) * speed * abs(speed) + extra * spin**2 * reach)
    assert (force - bare)[:2] == pytest.approx(pushes, rel=2e-3)
    assert (force - bare)[2] == pytest.approx(pushes[0] * rz - pushes[1] * rx, rel=2e-3)
    held = np.array([[1.0, 0.0, rz], [0.0, 1.0, -rx], [rz, -rx, rx**2 + rz**2]])
    assert mass - without == pytest.approx(extra * held, rel=1e-12, abs=1e-12)


def test_masses_of_box_and_cylinder_are_those_of_the_formulas():
    rng = np.random.default_rng(3)
    for shape in ("box", "cylinder"):
        a, b = rng.uniform(1.0, 3.0, 2)
        patches = (
            box_patches(a, a, b, ("sides", "bottom"), 4)
            if shape == "box"
            else cylinder_patches(a, b, ("sides", "bottom"), 4)
        )
        floats = Floats(np.zeros((1, 3)), 1.0, 0.0, 0.0, 0.5)
        cage = RigidCage(
            floats, patches, Net(0.01, 0.1), net_law("loland"), 1.0, 1e-4, 1.0, (), 0.0, 0.0, (a, a, b), (), shape
        )
        if shape == "box":
            area, bottom = 4 * a * b + a * a, a * a
            about = (
                2 * a * b * (a * a / 4 + b * b / 12)
                + 2 * a * b * (a * a + b * b) / 12
                + bottom * (a * a / 12 + b * b / 4)
            )
        else:
            r = a / 2
            area, bottom = math.pi * a * b + math.pi * r * r, math.pi * r * r
            about = math.pi * a * b * (r * r / 2 + b * b / 12) + bottom * (r * r / 4 + b * b / 4)
        assert cage.mass == pytest.approx(area, rel=1e-9)
        centre = -0.5 * b * bottom / area
        assert cage.centre[1] == pytest.approx(centre, rel=1e-9)
        assert cage.inertia == pytest.approx(about - area * centre**2, rel=1e-9)


@pytest.mark.parametrize("seed", SEEDS)
def test_rest_obeys_archimedes(seed):
    rng = np.random.default_rng(seed)
    cage = random_cage(rng, shape="cylinder" if seed == 2 else "box")
    water = Water(4.0 * size_of(cage), 1025.0, 9.81)
    free = free_floating(cage, water, NU)
    displaced = cage.solid_volume + cage.float_volume * immersion(cage, free.place)
    assert displaced * water.density == pytest.approx(cage.mass, rel=1e-9)
    lines = pair(cage, free, water, pull=0.2)
    rest = equilibrium_with_lines(cage, lines, water, NU)
    assert rest.tension[0] == pytest.approx(rest.tension[1], rel=1e-6)
    steep = [
        (line.place(rest.place, cage.centre)[1] - line.anchor[1]) / line.span(rest.place, cage.centre) for line in lines
    ]
    lift = water.density * 9.81 * (cage.solid_volume + cage.float_volume * rest.immersion) - cage.mass * 9.81
    assert float(rest.tension @ np.array(steep)) == pytest.approx(lift, rel=1e-7)
    # symmetric stiffness at rest: forces of still water and lines have a potential
    matrix = stiffness_at(pack(cage, lines, water, NU), rest.place, size_of(cage))
    assert np.abs(matrix - matrix.T).max() < 1e-5 * np.abs(matrix).max()


def test_net_behind_the_upstream_wall_misses_part_of_the_current():
    """Drag of a still box in a current: upstream wall, sheltered wall and walls along the flow, each by hand."""
    rng = np.random.default_rng(23)
    length, width, height = rng.uniform(0.5, 2.0, 3)
    law = net_law("matsubara")
    base = replace(
        random_cage(rng),
        patches=box_patches(length, width, height, ("sides",), 4),
        law=law,
        rods=(),
        weights=(),
        extent=(length, width, height),
        outline="box",
    )
    water = Water(20.0, 1000.0, 9.81)

    def drag(angle, speed):
        return 500.0 * speed**2 * float(law.coefficients(angle, speed, base.net, NU)[0])

    wall, half_side, across, along = width * height, length * height, 0.0, 0.5 * math.pi
    for sense in (1.0, -1.0):
        speed = rng.uniform(0.3, 0.8)
        behind = speed * (1.0 - 0.46 * float(law.coefficients(0.0, speed, base.net, NU)[0]))
        found = []
        for wake in ("none", "loland"):
            packed = pack(
                replace(base, wake=wake), (), water, NU, current=uniform(speed, 0.0 if sense > 0 else math.pi)
            )
            packed = packed._replace(spheres=packed.spheres[:0].copy())
            force, mass, work = np.empty(3), np.empty((3, 3)), np.empty(6)
            load_kernel.loads(packed, 0.0, np.array([0.0, -10.0, 0, 0, 0, 0]), np.zeros(0), force, mass, work)
            found.append(sense * force[0])
        assert found[0] == pytest.approx(2.0 * (wall * drag(across, speed) + half_side * drag(along, speed)), rel=2e-3)
        sheltered = wall * drag(across, behind) + half_side * drag(along, behind)
        assert found[1] == pytest.approx(0.5 * found[0] + sheltered, rel=2e-3)
        assert found[1] < 0.95 * found[0]
