"""Bodies on lines: natural periods, pendulum, momentum, energy, a monolithic solution, order of accuracy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from bodies_for_tests import GRAVITY, SEA, SPACE, VACUUM, hung, light, random_inertia

from moyai.core.errors import InputError
from moyai.coupled.equilibrium import find_coupled_equilibrium
from moyai.coupled.hulls import box_hull
from moyai.coupled.rigid import RigidBody
from moyai.coupled.simulate import simulate_coupled
from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType
from moyai.flexible.motion import Motion
from moyai.mooring.rotations import rotation_from_vector, rotation_matrix


def frame_of_springs(random):
    """A body of random inertia held by seven taut light lines in random directions."""
    mass = random.uniform(1.0, 3.0)
    inertia = random_inertia(random, mass, 0.4)
    points = {f"p{n}": 0.4 * random.normal(size=3) for n in range(7)}
    lines, pull = [], []
    for name, place in points.items():
        direction = random.normal(size=3)
        direction /= np.linalg.norm(direction)
        length, stiffness = random.uniform(2.0, 3.0), random.uniform(200.0, 600.0)
        # unstretched by a tenth: always taut
        lines.append((name, tuple(np.asarray(place) + 1.1 * length * direction), light(stiffness), length))
        pull.append(0.1 * stiffness * direction)
    total = np.sum(pull, axis=0)
    moment = sum(np.cross(points[name], force) for name, force in zip(points, pull, strict=True))
    # a constant force balances the pretension
    force = (*(-total), *(-moment))
    return RigidBody("body", mass, inertia, points=points, force=force), lines


def stiffness_of(body, lines):
    """Exact stiffness of prestressed springs about the centre of gravity (symmetrised by rotation vectors of both)."""

    def force(change):
        turn = rotation_from_vector(change[3:])
        out = np.zeros(6)
        for point, place, material, length in lines:
            arm = turn @ np.asarray(body.points[point])
            along = np.asarray(place) - change[:3] - arm
            size = np.linalg.norm(along)
            pull = material.axial_stiffness * (size / length - 1.0) * along / size
            out[:3] += pull
            out[3:] += np.cross(arm, pull)
        return out + np.asarray(body.force)

    step = 1e-5
    return np.stack([-(force(step * e) - force(-step * e)) / (2 * step) for e in np.eye(6)], axis=1), force


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_body_on_random_springs_has_the_exact_natural_motion(seed: int) -> None:
    """Started along a mode of the six coupled ones, it stays in it with the exact frequency."""
    random = np.random.default_rng(seed)
    body, lines = frame_of_springs(random)
    stiffness, force = stiffness_of(body, lines)
    assert np.abs(force(np.zeros(6))).max() < 1e-10
    mass = np.zeros((6, 6))
    mass[:3, :3], mass[3:, 3:] = body.mass * np.eye(3), body.inertia
    values, shapes = np.linalg.eig(np.linalg.solve(mass, stiffness))
    order = np.argsort(values.real)
    chosen = order[random.integers(6)]
    omega, shape = math.sqrt(values[chosen].real), shapes[:, chosen].real
    shape *= 1e-4 / np.abs(shape).max()
    network = hung(body, lines, water=SPACE)
    carrier = body.carrier(SPACE)
    carrier.place_body(np.zeros(3), np.eye(3), omega * shape)
    history = simulate_coupled(
        network, {"body": body}, duration=6.0 * math.pi / omega, output_step=math.pi / 40.0 / omega,
        carriers={"body": carrier}, tolerance=1e-8,
    )  # fmt: skip
    assert history.status == "converged"
    found = history.bodies["body"].position
    exact = np.sin(omega * history.time)[:, None] * shape[:3]
    assert np.max(np.abs(found - exact)) < 6e-3 * np.abs(shape).max()
    assert all(check.passed for check in history.checks)


def pendulum(random, segments=1, mass_of_line=1e-5):
    """A body on one long light line, its centre of gravity below the hook: a double pendulum."""
    body = RigidBody(
        "bob", 2.0, (0.02, 0.02, 0.02), (0.0, 0.0, 0.0), (0.0, 0.0, -2.0), points={"hook": (0.0, 0.0, 0.3)}
    )
    material = light(4e4, mass=mass_of_line)
    return body, hung(body, [("hook", (0.0, 0.0, 0.0), material, 1.7 / (1.0 + 2.0 * GRAVITY / 4e4))], segments)


@pytest.mark.slow
def test_double_pendulum_of_a_line_and_a_body_has_both_exact_periods() -> None:
    body, network = pendulum(None)
    length, arm, radius = 1.7, 0.3, 0.1
    # small motions x of the body and angles of line and body: K and M of the double pendulum about the hook
    mass = np.array([[length**2, length * arm], [length * arm, arm**2 + radius**2]])
    slope = np.diag([length * GRAVITY, arm * GRAVITY])
    values, shapes = np.linalg.eig(np.linalg.solve(mass, slope))
    for omega, shape in zip(np.sqrt(values), shapes.T, strict=True):
        shape = 1e-3 * shape / np.abs(shape).max()
        carrier = body.carrier(VACUUM)
        speed = -(length * shape[0] + arm * shape[1]) * omega
        # angles turn about +y: the lower end goes to -x
        carrier.place_body(body.position, np.eye(3), (speed, 0, 0, 0, omega * shape[1], 0))
        history = simulate_coupled(
            network, {"bob": body}, duration=4.0 * math.pi / omega, output_step=math.pi / 50.0 / omega,
            carriers={"bob": carrier}, body_step=math.pi / 200.0 / omega,
        )  # fmt: skip
        angle = history.bodies["bob"].angles[:, 1]
        assert np.max(np.abs(angle - shape[1] * np.sin(omega * history.time))) < 4e-3 * abs(shape).max()


@pytest.mark.slow
def test_large_swing_keeps_energy_over_many_periods() -> None:
    """A body swings by 60 degrees on a line without damping: energy within a thousandth over eleven periods."""
    body, _ = pendulum(None)
    turn = rotation_matrix((0.0, 1.0, 0.0))
    start = turn @ np.array([0.0, 0.0, -2.0])
    body = RigidBody(
        "bob", 2.0, (0.02, 0.02, 0.02), position=start, rotation=(0.0, 1.0, 0.0), points={"hook": (0.0, 0.0, 0.3)}
    )
    network = hung(body, [("hook", (0.0, 0.0, 0.0), light(4e3), 1.7)])
    history = simulate_coupled(network, {"bob": body}, duration=30.0, output_step=0.1, body_step=0.01)
    assert history.status == "converged"
    bob = history.bodies["bob"]
    energy = bob.kinetic_energy + 2.0 * GRAVITY * bob.position[:, 2]
    energy = energy + history.network.elastic_energy + history.network.kinetic_energy
    swing = np.ptp(2.0 * GRAVITY * bob.position[:, 2])
    assert np.max(np.abs(energy - energy[0])) < 1e-3 * swing


@pytest.mark.slow
def test_two_bodies_on_one_elastic_line_keep_their_momentum() -> None:
    """Nothing else acts: linear and angular momentum of bodies and line stay although the line snaps."""
    random = np.random.default_rng(5)
    material = BarType("cord", 0.3, 2e3, 0.01, volume_per_length=0.0, viscosity=5.0)
    bodies = {
        name: RigidBody(
            name, mass, random_inertia(random, mass, 0.3), position=place, points={f"{name} hook": hook}
        )
        for name, mass, place, hook in (("a", 2.0, (0, 0, 0), (0.2, 0.1, 0)), ("b", 0.7, (2.5, 0, 0), (-0.2, 0, 0.1)))
    }  # fmt: skip
    builder = NetworkBuilder(SPACE)
    for body in bodies.values():
        for name, place in body.points_at_start.items():
            builder.driven(name, place)
    builder.line("cord", "a hook", "b hook", material, length=2.3, segments=12, shape="straight")
    network = builder.build()
    carriers = {name: body.carrier(SPACE) for name, body in bodies.items()}
    carriers["a"].place_body((0, 0, 0), np.eye(3), (-0.5, 0.2, 0.1, 0.3, 0.5, -0.2))
    carriers["b"].place_body((2.5, 0, 0), np.eye(3), (1.0, 0.4, -0.3, -0.5, 0.2, 0.4))
    first = {name: carrier.velocity.copy() for name, carrier in carriers.items()}
    history = simulate_coupled(
        network, bodies, duration=6.0, output_step=0.05, body_step=0.01, carriers=carriers, tolerance=1e-6
    )
    assert history.status == "converged"
    assert history.network.tension_peak.max() > 20.0
    node_mass = network.node_mass
    hooks = [network.points["a hook"], network.points["b hook"]]

    def momentum(velocities, places, turns, line_speed, line_place):
        linear = sum(bodies[n].mass * velocities[n][:3] for n in bodies) + node_mass @ line_speed
        spin = sum(
            bodies[n].mass * np.cross(places[n], velocities[n][:3])
            + turns[n] @ bodies[n].inertia @ turns[n].T @ velocities[n][3:]
            for n in bodies
        )
        return linear, spin + np.sum(node_mass[:, None] * np.cross(line_place, line_speed), axis=0)

    start_speed = np.zeros((len(network.nodes), 3))
    for name, hook in zip(bodies, hooks, strict=True):
        arm = np.asarray(next(iter(bodies[name].points.values())))
        start_speed[hook] = first[name][:3] + np.cross(first[name][3:], arm)
    before = momentum(
        first, {"a": np.zeros(3), "b": np.array([2.5, 0, 0])}, dict.fromkeys(bodies, np.eye(3)), start_speed,
        network.nodes.position,
    )  # fmt: skip
    end_speed = history.final.velocity.copy()
    for name, hook in zip(bodies, hooks, strict=True):
        end_speed[hook] = carriers[name].place_and_velocity()[1][0]
    after = momentum(
        {n: carriers[n].velocity for n in bodies}, {n: carriers[n].centre for n in bodies},
        {n: carriers[n].rotation for n in bodies}, end_speed, history.final.position,
    )  # fmt: skip
    assert np.allclose(after[0], before[0], rtol=0, atol=2e-4 * np.abs(before[0]).max())
    assert np.allclose(after[1], before[1], rtol=0, atol=3e-3 * np.abs(before[1]).max())


@pytest.mark.slow
def test_body_and_line_equal_the_monolithic_solution() -> None:
    """A body of finite inertia on a heavy, slack line of four bars, against one system of equations."""
    from scipy.integrate import solve_ivp

    material = BarType("rope", 0.4, 900.0, 0.01, volume_per_length=0.0, tension_only=False)
    body = RigidBody(
        "load", 1.5, (0.03, 0.05, 0.04), (0.02, 0.0, -0.05), (0.3, 0.0, -1.9), points={"eye": (0.1, 0.05, 0.2)}
    )
    network = hung(body, [("eye", (0.0, 0.0, 0.0), material, 2.0)], segments=4)
    rest = network.bars.length
    masses = network.node_mass
    eye, top = network.points["eye"], network.points["fixed 0"]
    inner = [n for n in range(len(network.nodes)) if n not in (eye, top)]
    arm = np.array([0.1, 0.05, 0.2]) - np.array([0.02, 0.0, -0.05])
    inertia = np.diag([0.03, 0.05, 0.04])

    def skew(v):
        return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])

    def rates(_, y):
        place, q, speed, spin = y[:3], y[3:7] / np.linalg.norm(y[3:7]), y[7:10], y[10:13]
        w, x, yy, z = q
        turn = np.array([
            [1 - 2 * (yy * yy + z * z), 2 * (x * yy - w * z), 2 * (x * z + w * yy)],
            [2 * (x * yy + w * z), 1 - 2 * (x * x + z * z), 2 * (yy * z - w * x)],
            [2 * (x * z - w * yy), 2 * (yy * z + w * x), 1 - 2 * (x * x + yy * yy)],
        ])  # fmt: skip
        nodes, speeds = np.zeros((len(masses), 3)), np.zeros((len(masses), 3))
        nodes[inner] = y[13 : 13 + 3 * len(inner)].reshape(-1, 3)
        speeds[inner] = y[13 + 3 * len(inner) :].reshape(-1, 3)
        nodes[eye], speeds[eye] = place + turn @ arm, speed + turn @ np.cross(spin, arm)
        force = np.zeros_like(nodes)
        for k, (a, b) in enumerate(zip(network.bars.start, network.bars.end, strict=True)):
            along = nodes[b] - nodes[a]
            size = np.linalg.norm(along)
            pull = 900.0 * (size - rest[k]) / rest[k] * along / size
            force[a] += pull
            force[b] -= pull
        force[:, 2] -= masses * GRAVITY
        # the mass of the last node rides on the body
        point = masses[eye]
        matrix = np.zeros((6, 6))
        arm_site = turn @ arm
        matrix[:3, :3] = (1.5 + point) * np.eye(3)
        matrix[:3, 3:] = -point * skew(arm_site) @ turn
        matrix[3:, :3] = matrix[:3, 3:].T
        matrix[3:, 3:] = inertia - point * turn.T @ skew(arm_site) @ skew(arm_site) @ turn
        drift = turn @ np.cross(spin, np.cross(spin, arm))
        load = np.zeros(6)
        load[:3] = force[eye] - [0, 0, 1.5 * GRAVITY] - point * drift
        load[3:] = turn.T @ np.cross(arm_site, force[eye] - point * drift) - np.cross(spin, inertia @ spin)
        gain = np.linalg.solve(matrix, load)
        p, r, s = 0.5 * spin
        turned = np.array(
            [-x * p - yy * r - z * s, w * p + yy * s - z * r, w * r + z * p - x * s, w * s + x * r - yy * p]
        )
        return np.concatenate(
            [speed, turned, gain[:3], gain[3:], speeds[inner].ravel(), (force[inner] / masses[inner, None]).ravel()]
        )

    start = np.concatenate([
        body.position + body.centre_of_gravity, [1, 0, 0, 0], np.zeros(6), network.nodes.position[inner].ravel(),
        np.zeros(3 * len(inner)),
    ])  # fmt: skip
    exact = solve_ivp(rates, (0.0, 1.0), start, method="DOP853", rtol=1e-8, atol=1e-9, t_eval=[1.0]).y[:, -1]
    errors = []
    for body_step, step in ((0.02, 2e-4), (0.01, 2e-4)):
        history = simulate_coupled(
            network, {"load": body}, duration=1.0, output_step=0.1, body_step=body_step, step=step, tolerance=1e-7
        )
        there = history.bodies["load"].position[-1] + history.bodies["load"].rotation[-1] @ body.centre_of_gravity
        errors.append(float(np.linalg.norm(there - exact[:3])))
    # the joint is of more than the third order in the step of the body
    assert errors[-1] < 2e-4
    assert errors[0] / errors[-1] > 8.0


@pytest.mark.slow
def test_a_light_body_on_a_heavy_line_converges() -> None:
    """The mass lumped at the point is thrice that of the body: plain repetition would diverge."""
    material = BarType("chain", 5.0, 5e4, 0.02, volume_per_length=0.0, viscosity=200.0)
    body = RigidBody("ring", 0.4, (0.01, 0.01, 0.01), position=(1.0, 0.0, -0.2), points={"ring": (0, 0, 0)})
    network = hung(
        body, [("ring", (0.0, 0.0, 0.0), material, 1.5), ("ring", (2.2, 0.0, 0.0), material, 1.5)], segments=3
    )
    assert network.node_mass[network.points["ring"]] > 1.2
    history = simulate_coupled(network, {"ring": body}, duration=0.4, output_step=0.02)
    assert history.status == "converged"
    assert history.passes < 8.0


def test_rest_of_a_moored_box_is_where_it_stays() -> None:
    """The pose that the search finds does not move in time, and forces balance there."""
    size, draught = (1.2, 0.9, 0.6), 0.3
    mass = 0.92 * SEA.density * size[0] * size[1] * draught
    water = type(SEA)(depth=4.0, density=SEA.density, gravity=GRAVITY)
    builder = NetworkBuilder(water, Bed(-4.0, 1e5, 1e4))
    points = {}
    chain = BarType("chain", 4.0, 1e5, 0.02, viscosity=50.0, drag_normal=1.0, added_mass_normal=1.0)
    for name, sx, sy in (("a", 1, 1), ("b", -1, 1), ("c", -1, -1), ("d", 1, -1)):
        points[name] = (0.6 * sx, 0.45 * sy, 0.0)
        builder.fixed(f"anchor {name}", (6.0 * sx, 5.0 * sy + 0.7, -4.0))
        builder.driven(name, (0.6 * sx, 0.45 * sy, -draught))
        builder.line(name, f"anchor {name}", name, chain, length=9.2, segments=16)
    body = RigidBody(
        "box", mass, mass * np.array([0.15, 0.2, 0.25]), (0.05, 0.0, 0.2), (0, 0, -draught), points=points,
        lumps=box_hull(size, bottom=0.0), linear_damping=(300.0,) * 6,
    )  # fmt: skip
    network = builder.build()
    rest = find_coupled_equilibrium(network, {"box": body})
    assert rest.residual < 1e-7
    history = simulate_coupled(rest.network, rest.bodies, duration=3.0, output_step=0.5, start=rest.state)
    box = history.bodies["box"]
    assert np.max(np.abs(box.position - box.position[0])) < 2e-5
    assert np.max(np.abs(box.angles - box.angles[0])) < 2e-5
    assert abs(box.angles[0, 1]) > 1e-3


def test_points_and_bodies_that_do_not_fit_are_named() -> None:
    body, network = pendulum(None)
    other = RigidBody("bob", 2.0, (0.02,) * 3, position=(0, 0, -2.1), points={"hook": (0, 0, 0.3)})
    for bodies, reported in (
        ({"bob": other}, "the point 'hook' of body 'bob' is at"),
        (
            {"bob": RigidBody("bob", 2.0, (0.02,) * 3, points={"hock": (0, 0, 0)})},
            "'hock', which the network does not have",
        ),
        ({"bob": RigidBody("bob", 2.0, (0.02,) * 3, points={"fixed 0": (0, 0, 0)})}, "is not a driven point"),
        ({}, "belongs to no body, and no motion is given"),
    ):
        with pytest.raises(InputError) as caught:
            simulate_coupled(network, bodies, duration=1.0, output_step=0.1)
        assert reported in str(caught.value)
    still = Motion(0.0, 1.0, np.zeros((3, 3)), np.zeros((3, 3)))
    with pytest.raises(InputError, match="carried by a body and driven by a motion"):
        simulate_coupled(network, {"bob": body}, duration=1.0, output_step=0.1, motions={"hook": still})
    for keys in ({"duration": -1.0}, {"output_step": 0.0}, {"body_step": -0.1}, {"tolerance": 2.0}):
        with pytest.raises(InputError):
            simulate_coupled(network, {"bob": body}, **{"duration": 1.0, "output_step": 0.1, **keys})
