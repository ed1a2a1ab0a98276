"""A rigid body alone: rotations, conservation, buoyancy, added mass, waves."""

from __future__ import annotations

import math

import numpy as np
import pytest
from bodies_for_tests import GRAVITY, SEA, VACUUM, random_inertia

from moyai.core.errors import InputError
from moyai.coupled import rigid_kernel
from moyai.coupled.hulls import Lumps, box_hull, cylinder_hull, volume_lump
from moyai.coupled.rigid import RigidBody, about, quaternion_of
from moyai.flexible.flow import Flow
from moyai.mooring.rotations import rotation_from_vector, rotation_matrix
from moyai.sea.components import WaveComponents
from moyai.sea.water import Water


def free_flight(body, water, duration, step, *, velocity=(0.0,) * 6, flow=None):
    carrier = body.carrier(water, flow)
    carrier.place_body(body.position, body.start_rotation, velocity)
    none, states = np.zeros((2, len(body.points), 3)), [carrier.state.copy()]
    for number in range(1, round(duration / step) + 1):
        carrier.try_step(number * step, none)
        carrier.accept()
        states.append(carrier.state.copy())
    return carrier, np.array(states)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_a_spinning_body_keeps_momentum_and_energy_and_meets_the_exact_motion(seed: int) -> None:
    """Torque-free top of random inertia: momentum in site axes and energy stay; errors fall with the fourth power."""
    random = np.random.default_rng(seed)
    inertia = random_inertia(random, 3.0, 0.5)
    body = RigidBody("top", 3.0, inertia, rotation=random.normal(size=3), force=(0, 0, 3.0 * GRAVITY, 0, 0, 0))
    spin = 2.0 * random.normal(size=3)
    ends = []
    for step in (0.02, 0.01, 0.005, 0.00125):
        carrier, _ = free_flight(body, VACUUM, 2.0, step, velocity=(*np.zeros(3), *spin))
        turn = carrier.rotation
        momentum = turn @ inertia @ carrier.state[10:13]
        first = body.start_rotation @ inertia @ body.start_rotation.T @ spin
        ends.append(turn)
        assert np.allclose(momentum, first, rtol=0, atol=2e-3 * np.linalg.norm(first) * (step / 0.01) ** 4 + 1e-9)
        energy = 0.5 * carrier.state[10:13] @ inertia @ carrier.state[10:13]
        whole = body.start_rotation.T @ spin
        assert math.isclose(energy, 0.5 * whole @ inertia @ whole, rel_tol=1e-3 * (step / 0.01) ** 4 + 1e-9)
        assert np.allclose(turn @ turn.T, np.eye(3), atol=1e-13)
    errors = [np.abs(end - ends[-1]).max() for end in ends[:-1]]
    assert errors[0] / errors[1] > 11.0 and errors[1] / errors[2] > 11.0


@pytest.mark.parametrize("seed", range(4))
def test_quaternion_and_matrix_are_the_same_rotation(seed: int) -> None:
    random = np.random.default_rng(seed)
    angles = random.uniform(-np.pi, np.pi, size=3)
    matrix = rotation_from_vector(angles)
    body = RigidBody("x", 1.0, (1.0, 1.0, 1.0))
    carrier = body.carrier(VACUUM)
    carrier.place_body((1.0, 2.0, 3.0), matrix)
    assert np.allclose(carrier.rotation, matrix, atol=1e-14)
    assert math.isclose(np.linalg.norm(quaternion_of(matrix)), 1.0, rel_tol=1e-14)


def test_mass_about_another_point_keeps_the_kinetic_energy() -> None:
    random = np.random.default_rng(3)
    matrix, offset, motion = random.normal(size=(6, 6)), random.normal(size=3), random.normal(size=6)
    matrix = matrix @ matrix.T
    old = motion.copy()
    old[:3] += np.cross(motion[3:], -offset)
    assert math.isclose(old @ matrix @ old, motion @ about(matrix, offset) @ motion, rel_tol=1e-12)


@pytest.mark.parametrize("seed", range(3))
def test_added_mass_keeps_energy_and_impulse_in_still_water(seed: int) -> None:
    """Kirchhoff's equations: energy of body and water, and the impulse of both in site axes, stay."""
    random = np.random.default_rng(20 + seed)
    added = np.zeros((6, 6))
    half = random.normal(size=(6, 6))
    added += half @ half.T
    body = RigidBody(
        "swimmer", 2.0, random_inertia(random, 2.0, 0.7), added_mass=added, force=(0, 0, 2.0 * GRAVITY, 0, 0, 0)
    )
    carrier, states = free_flight(body, SEA, 3.0, 0.005, velocity=0.3 * random.normal(size=6))
    whole = carrier._body[0] + carrier._body[1]

    def energy_and_impulse(state):
        turn = np.empty((3, 3))
        from moyai.coupled.rigid_kernel import rotation_of

        rotation_of(state[3:7], turn)
        nu = np.concatenate([turn.T @ state[7:10], state[10:13]])
        return 0.5 * nu @ whole @ nu, turn @ (whole @ nu)[:3]

    first, last = energy_and_impulse(states[0]), energy_and_impulse(states[-1])
    assert math.isclose(first[0], last[0], rel_tol=1e-7)
    assert np.allclose(first[1], last[1], rtol=0, atol=1e-7 * np.abs(first[1]).max())


@pytest.mark.parametrize("seed", range(3))
def test_box_floats_with_the_exact_periods_of_heave_and_pitch(seed: int) -> None:
    """Small decay of a box of random size: heave rho g A, pitch with metacentre; two columns a side are enough."""
    random = np.random.default_rng(40 + seed)
    size = random.uniform([0.6, 0.8, 0.3], [1.5, 1.6, 0.5])
    draught = random.uniform(0.3, 0.7) * size[2]
    mass = SEA.density * size[0] * size[1] * draught
    centre = 0.35 * size[2]
    hull = box_hull(size, bottom=0.0, columns=(2, 2))
    inertia = (
        mass / 12.0 * np.array([size[1] ** 2 + size[2] ** 2, size[0] ** 2 + size[2] ** 2, size[0] ** 2 + size[1] ** 2])
    )
    body = RigidBody("box", mass, inertia, (0, 0, centre), (0, 0, -draught), lumps=hull)
    buoyancy, radius = 0.5 * draught, size[0] ** 2 / (12.0 * draught)
    height = buoyancy + radius - centre
    heave = math.sqrt(SEA.density * GRAVITY * size[0] * size[1] / mass)
    pitch = math.sqrt(mass * GRAVITY * height / inertia[1])
    carrier = body.carrier(SEA)
    carrier.place_body(body.position + np.array([0, 0, 0.002]), rotation_matrix((0.0, 0.002, 0.0)))
    start = carrier.state[2]
    step = 2.0 * math.pi / max(heave, pitch) / 200.0
    none = np.zeros((2, 0, 3))
    time, height_of, angle = [], [], []
    for number in range(1, 601):
        carrier.try_step(number * step, none)
        carrier.accept()
        time.append(number * step)
        height_of.append(carrier.state[2])
        angle.append(math.atan2(-carrier.rotation[2, 0], carrier.rotation[0, 0]))
    rest = centre - draught
    assert np.allclose(height_of, rest + (start - rest) * np.cos(heave * np.array(time)), atol=2e-5)
    assert np.allclose(angle, 0.002 * np.cos(pitch * np.array(time)), atol=3e-5)


def test_buoyancy_of_a_sunk_and_of_an_upturned_hull_is_whole_and_upwards() -> None:
    hull = box_hull((1.0, 1.0, 0.5), bottom=0.0) + cylinder_hull(0.4, 1.0, bottom=0.5)
    volume = 0.5 + math.pi * 0.04
    for angles in ((0.0, 0.0, 0.0), (math.pi, 0.0, 1.0), (1.2, 0.3, 2.0)):
        body = RigidBody("sunk", 100.0, (1, 1, 1), position=(0, 0, -10.0), rotation=angles, lumps=hull)
        force = body.carrier(SEA).imbalance(np.zeros((0, 3)), 0.0, Flow())
        assert math.isclose(force[2], (SEA.density * volume - 100.0) * GRAVITY, rel_tol=1e-9)
        assert np.allclose(force[:2], 0.0, atol=1e-6)


def test_heeled_box_has_the_righting_moment_of_the_exact_section() -> None:
    """A box heeled by 15 degrees, its deck dry: Scribanti's formula of the wall-sided body."""
    size, draught = np.array([2.0, 3.0, 1.0]), 0.5
    hull = box_hull(size, bottom=0.0, columns=(8, 2))
    mass, heel = SEA.density * size[0] * size[1] * draught, math.radians(15.0)
    body = RigidBody("box", mass, (1e3, 1e3, 1e3), (0, 0, draught), (0, 0, -draught), lumps=hull)
    carrier = body.carrier(SEA)
    carrier.state[2] = 0.0
    carrier.displace(4, heel)
    # the centre of gravity at the middle of the water line keeps the displacement of a wall-sided body
    force = carrier.imbalance(np.zeros((0, 3)), 0.0, Flow())
    radius = size[0] ** 2 / (12.0 * draught)
    arm = math.sin(heel) * (radius * (1.0 + 0.5 * math.tan(heel) ** 2) - 0.5 * draught)
    assert abs(force[2]) < 2e-3 * mass * GRAVITY
    assert math.isclose(-force[4], mass * GRAVITY * arm, rel_tol=0.02)


def test_a_body_moves_like_the_water_particle_when_it_is_neutral_and_small() -> None:
    """A small neutral sphere without drag follows the orbit, with added mass too: its density is that of water."""
    wave = WaveComponents([1.2], [0.3], [0.4], [0.0], [1.2**2 / GRAVITY], SEA)
    flow = Flow(waves=wave)
    volume = 1e-3
    body = RigidBody(
        "drop", 1.0, (1e-4,) * 3, position=(0, 0, -5.0),
        lumps=volume_lump((0, 0, 0), volume, added_mass=(0.5, 0.5, 0.5)), free=(True,) * 3 + (False,) * 3,
    )  # fmt: skip
    water = Water(depth=50.0, density=1000.0, gravity=GRAVITY)
    speed = flow.at(0.0, np.array([[0.0], [0.0], [-5.0]]))[:3, 0]
    _, states = free_flight(body, water, 10.0, 0.05, velocity=(*speed, 0, 0, 0), flow=flow)
    there = np.array([flow.at(0.05 * n, state[:3, None].copy())[:3, 0] for n, state in enumerate(states)])
    assert np.max(np.abs(states[:, 7:10] - there)) < 0.03 * np.max(np.abs(there))


def test_drag_brings_a_body_to_its_terminal_speed() -> None:
    body = RigidBody(
        "stone", 50.0, (1, 1, 1), position=(0, 0, -5), lumps=volume_lump((0, 0, 0), 0.02, drag_area=(1, 1, 0.3))
    )
    _, states = free_flight(body, SEA, 20.0, 0.05)
    assert math.isclose(-states[-1, 9], math.sqrt(30.0 * GRAVITY / (0.5 * 1000.0 * 0.3)), rel_tol=1e-6)


@pytest.mark.parametrize(
    ("changes", "reported"),
    [
        ({"mass": -1.0}, "mass of body 'b' is -1"),
        ({"inertia": (1.0, 1.0, 3.0)}, "none above the sum"),
        ({"inertia": np.zeros((2, 2))}, "inertia has shape"),
        ({"quadratic_damping": (0, 0, 0, 0, 0, -1.0)}, "quadratic damping of body 'b' is -1"),
        ({"added_mass": -np.eye(6)}, "negative eigenvalue"),
        ({"points": {"a": (0.0, 1.0)}}, "points.a"),
        ({"position": (0.0, 0.0, math.nan)}, "finite"),
        ({"free": (True,) * 5}, "six"),
    ],
)
def test_impossible_bodies_are_refused_with_one_message(changes, reported) -> None:
    values = {"name": "b", "mass": 1.0, "inertia": (1.0, 1.0, 1.0), **changes}
    with pytest.raises(InputError) as caught:
        RigidBody(**values)
    assert reported in str(caught.value)


@pytest.mark.parametrize(
    "make",
    [
        lambda: box_hull((1.0, 0.0, 1.0), bottom=0.0),
        lambda: box_hull((1.0, 1.0, 1.0), bottom=0.0, added_mass=(1, 1, 1)),
        lambda: box_hull((1.0, 1.0, 1.0), bottom=0.0, columns=(0, 2)),
        lambda: cylinder_hull(-1.0, 1.0, bottom=0.0),
        lambda: cylinder_hull(1.0, 1.0, bottom=0.0, spokes=2),
        lambda: Lumps(np.zeros((2, 3)), np.array([1.0, -1.0]), np.zeros(2), np.zeros((2, 3)), np.zeros((2, 3))),
        lambda: Lumps(np.zeros((2, 3)), np.zeros(3), np.zeros(2), np.zeros((2, 3)), np.zeros((2, 3))),
    ],
)
def test_impossible_hulls_are_refused(make) -> None:
    with pytest.raises(InputError):
        make()


def test_linear_restoring_depends_on_the_distance_from_its_rest_alone():
    """Moved together, body and rest feel the same; along the yawed axes the force is the stiffness times the offset."""
    rng = np.random.default_rng(21)
    half = rng.normal(size=(6, 6))
    stiffness, rest, offset = half @ half.T, rng.normal(size=6), 0.3 * rng.normal(size=3)
    rest[3:] = 0.0
    yaw = 0.7
    turn = np.array([[np.cos(yaw), -np.sin(yaw), 0.0], [np.sin(yaw), np.cos(yaw), 0.0], [0.0, 0.0, 1.0]])
    forces = []
    for shift in (np.zeros(3), np.array([40.0, -7.0, 3.0])):
        moved = rest.copy()
        moved[:3] += shift
        state, force = np.zeros(13), np.zeros(6)
        state[:3] = moved[:3] + offset
        rigid_kernel._restoring(state, turn, stiffness, moved, force)
        forces.append(force)
    assert np.allclose(forces[0], forces[1], atol=1e-9)
    along = np.concatenate([turn.T @ offset, [0.0, 0.0, yaw]])
    assert np.allclose(forces[0], -stiffness @ along, atol=1e-9)


@pytest.mark.parametrize(("rest", "yaw", "turned"), [(3.0, -3.0, 2.0 * np.pi - 6.0), (-2.5, 2.5, 5.0 - 2.0 * np.pi)])
def test_linear_restoring_in_yaw_turns_back_the_shorter_way(rest, yaw, turned):
    stiffness = np.diag([0.0, 0.0, 0.0, 0.0, 0.0, 7.0])
    turn = np.array([[np.cos(yaw), -np.sin(yaw), 0.0], [np.sin(yaw), np.cos(yaw), 0.0], [0.0, 0.0, 1.0]])
    force = np.zeros(6)
    rigid_kernel._restoring(np.zeros(13), turn, stiffness, np.array([0.0, 0.0, 0.0, rest, 0.0, 0.0]), force)
    assert force[5] == pytest.approx(-7.0 * turned)
