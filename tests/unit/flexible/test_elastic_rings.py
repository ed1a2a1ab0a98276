"""Elastic rings against exact solutions: gradients, turns, modes in and out of the plane, opposite loads, buckling."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType
from moyai.flexible.result import State
from moyai.flexible.ring_kernel import ring_forces
from moyai.flexible.rings import Ring, RingArrays, ring_moments
from moyai.flexible.simulation import simulate
from moyai.sea.water import Water


def circle(count: int, radius: float) -> np.ndarray:
    angle = 2.0 * math.pi * np.arange(count) / count
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), 0.0 * angle], axis=1)


def square(side: float, count: int) -> np.ndarray:
    s = np.arange(count) / count
    edges = [(s, 0 * s), (1 + 0 * s, s), (1 - s, 1 + 0 * s), (0 * s, 1 - s)]
    return side * np.concatenate([np.stack([a, b, 0 * a], axis=1) for a, b in edges])


def stiffness(ring: Ring) -> np.ndarray:
    """Return the Hessian of the energy at rest by central differences of the forces."""
    system, rest = RingArrays.of((ring,)).system, np.array(ring.rest)
    size, width = rest.size, 1e-6 * float(np.ptp(rest))
    out = np.empty((size, size))
    for k in range(size):
        ends = []
        for sign in (1.0, -1.0):
            moved = rest.ravel().copy()
            moved[k] += sign * width
            force = np.zeros_like(rest)
            ring_forces(moved.reshape(-1, 3), system, force)
            ends.append(force.ravel())
        out[:, k] = (ends[1] - ends[0]) / (2.0 * width)
    return out


def with_bars(ring: Ring, matrix: np.ndarray, spring: float) -> np.ndarray:
    """Add stiff bars between neighbours."""
    out, count = matrix.copy(), len(ring.rest)
    for i in range(count):
        j = (i + 1) % count
        t = ring.rest[j] - ring.rest[i]
        block = spring * np.outer(t, t) / float(t @ t)
        for a, b, sign in ((i, i, 1), (j, j, 1), (i, j, -1), (j, i, -1)):
            out[3 * a : 3 * a + 3, 3 * b : 3 * b + 3] += sign * block
    return out


@pytest.mark.parametrize("seed", range(4))
def test_forces_are_the_gradient_and_carry_no_thrust_or_turn(seed: int) -> None:
    from scipy.spatial.transform import Rotation

    rng = np.random.default_rng(seed)
    shape = circle(20, rng.uniform(0.5, 30.0)) if seed % 2 else square(rng.uniform(1.0, 40.0), 5)
    scale = float(np.ptp(shape))
    ring = Ring("ring", np.arange(20), shape, rng.uniform(1.0, 1e6), rng.uniform(1.0, 1e6))
    system = RingArrays.of((ring,)).system
    place = shape @ Rotation.random(random_state=seed).as_matrix().T + 0.02 * scale * rng.normal(size=shape.shape)
    force = np.zeros_like(place)
    energy = ring_forces(place, system, force)
    for _ in range(10):
        way = rng.normal(size=place.shape)
        width = 1e-5 * scale
        up, down = (ring_forces(place + sign * width * way, system, np.zeros_like(place)) for sign in (1.0, -1.0))
        assert -(up - down) / (2.0 * width) == pytest.approx(float(np.sum(force * way)), rel=1e-5, abs=1e-6 * energy)
    size = np.abs(force).max()
    assert np.abs(force.sum(axis=0)).max() < 1e-10 * size
    assert np.abs(np.cross(place, force).sum(axis=0)).max() < 1e-9 * size * scale
    turned = place @ Rotation.random(random_state=seed + 9).as_matrix().T + [3.0, -2.0, 7.0]
    assert ring_forces(turned, system, np.zeros_like(place)) == pytest.approx(energy, rel=1e-9)
    assert ring_forces(np.array(shape), system, np.zeros_like(place)) < 1e-18 * energy


@pytest.mark.parametrize("seed", range(2))
def test_modes_out_of_the_plane_are_loves(seed: int) -> None:
    rng = np.random.default_rng(seed)
    radius, bending, torsion = rng.uniform(1.0, 30.0), rng.uniform(10.0, 1e6), 0.0
    torsion = bending * rng.uniform(0.3, 1.5)
    errors = []
    for count in (24, 48):
        ring = Ring("ring", np.arange(count), circle(count, radius), bending, torsion)
        share = 2.0 * math.pi * radius / count
        found = np.linalg.eigvalsh(stiffness(ring)[2::3, 2::3]) / share
        exact = [bending * n**2 * (n**2 - 1) ** 2 / (radius**4 * (n**2 + bending / torsion)) for n in (2, 3)]
        # three rigid motions, then pairs
        assert np.abs(found[:3]).max() < 1e-5 * exact[0]
        errors.append([abs(found[2 * n - 1] / exact[n - 2] - 1.0) for n in (2, 3)])
    # second order in the mesh
    assert np.all(np.array(errors[1]) < 0.3 * np.array(errors[0])) and max(errors[1]) < 0.04


def test_modes_in_the_plane_are_hoppes() -> None:
    radius, bending = 7.0, 4e3
    found = {}
    for count in (32, 64):
        ring = Ring("ring", np.arange(count), circle(count, radius), bending, bending)
        matrix = with_bars(ring, stiffness(ring), 1e5 * bending)
        plane = np.delete(np.arange(3 * count), np.s_[2::3])
        values = np.linalg.eigvalsh(matrix[np.ix_(plane, plane)]) / (2.0 * math.pi * radius / count)
        found[count] = [values[2 * n - 1] * radius**4 / bending / (n**2 * (n**2 - 1) ** 2 / (n**2 + 1)) for n in (2, 3)]
    assert np.allclose(found[64], 1.0, atol=0.02)
    extrapolated = (4.0 * np.array(found[64]) - np.array(found[32])) / 3.0
    assert np.allclose(extrapolated, 1.0, atol=1e-3)


def test_opposite_loads_bring_the_sides_together() -> None:
    # change of the loaded diameter P R^3 / EI (pi/4 - 2/pi), of the other one (2/pi - 1/2)
    radius, bending, pull = 2.0, 900.0, 0.1
    found = []
    for count in (32, 64):
        ring = Ring("ring", np.arange(count), circle(count, radius), bending, bending)
        matrix = with_bars(ring, stiffness(ring), 1e6 * bending)
        load = np.zeros(3 * count)
        load[0], load[3 * count // 2] = pull, -pull
        moved = np.linalg.lstsq(matrix, load, rcond=1e-12)[0].reshape(-1, 3)
        half, quarter = count // 2, count // 4
        found.append((moved[0, 0] - moved[half, 0], moved[3 * quarter, 1] - moved[quarter, 1]))
    one, two = (4.0 * np.array(found[1]) - np.array(found[0])) / 3.0
    unit = pull * radius**3 / bending
    assert one == pytest.approx(unit * (math.pi / 4.0 - 2.0 / math.pi), rel=2e-3)
    assert two == pytest.approx(unit * (2.0 / math.pi - 0.5), rel=2e-3)


def test_moments_of_a_ring_pressed_together() -> None:
    # a ring forced to the ellipse r + e cos 2t has the bending moment 3 EI e / R^2 cos 2t (to first order)
    radius, bending, small = 5.0, 2e4, 1e-3
    count = 96
    ring = Ring("ring", np.arange(count), circle(count, radius), bending, bending)
    angle = 2.0 * math.pi * np.arange(count) / count
    # inextensional: tangential part -e/2 sin 2t
    out, along = small * np.cos(2.0 * angle), -0.5 * small * np.sin(2.0 * angle)
    place = np.array(ring.rest)
    place[:, 0] += out * np.cos(angle) - along * np.sin(angle)
    place[:, 1] += out * np.sin(angle) + along * np.cos(angle)
    moments = ring_moments((ring,), place)[0]
    assert np.allclose(moments[:, 0], 3.0 * bending * small / radius**2 * np.cos(2.0 * angle), atol=0.01 * 2.4)
    assert np.abs(moments[:, 1:]).max() < 1e-9 * bending


def test_a_ring_swings_with_its_mode_and_keeps_its_energy() -> None:
    water = Water(100.0, 1e-9, 1e-9)
    count, radius, bending, mass = 32, 3.0, 500.0, 2.0
    builder = NetworkBuilder(water)
    rest = circle(count, radius)
    for k in range(count):
        builder.free(f"{k}", rest[k])
    length = float(np.linalg.norm(rest[1] - rest[0]))
    pipe = BarType("pipe", mass, 1e5, 0.0, 0.0, tension_only=False)
    for k in range(count):
        builder.line(f"bar {k}", f"{k}", f"{(k + 1) % count}", pipe, length=length, segments=1)
    network = builder.build()
    nodes = np.array([network.point(f"{k}") for k in range(count)])
    network = replace(network, rings=(Ring("ring", nodes, rest, bending, 0.7 * bending),))
    angle = 2.0 * math.pi * np.arange(count) / count
    place = np.array(network.nodes.position)
    place[nodes, 2] += 0.02 * np.cos(2.0 * angle)
    ratio = 1.0 / 0.7
    omega = math.sqrt(bending / (mass * radius**4) * 36.0 / (4.0 + ratio))
    period = 2.0 * math.pi / omega
    start = State(0.0, place, np.zeros_like(place))
    history = simulate(network, duration=4.0 * period, output_step=period / 50.0, start=start)
    swing = history.position[:, nodes[0], 2]
    # back at its crest after four periods
    last = len(swing) - 1 - 25 + int(np.argmax(swing[-26:]))
    assert history.time[last] == pytest.approx(4.0 * period, rel=0.02)
    total = history.kinetic_energy + history.elastic_energy
    assert np.ptp(total) < 2e-3 * total[0]


def test_a_ring_buckles_where_levy_says() -> None:
    # uniform pressure that follows the ring: q R^3 / EI = 3
    radius, bending, count = 2.0, 100.0, 48
    ring = Ring("ring", np.arange(count), circle(count, radius), bending, bending)
    matrix = with_bars(ring, stiffness(ring), 1e6 * bending)
    rest = np.array(ring.rest)

    def follower(place: np.ndarray) -> np.ndarray:
        chord = 0.5 * (np.roll(place, -1, axis=0) - np.roll(place, 1, axis=0))
        return np.stack([-chord[:, 1], chord[:, 0], 0.0 * chord[:, 0]], axis=1)

    load = np.empty((3 * count, 3 * count))
    for k in range(3 * count):
        moved = rest.ravel().copy()
        moved[k] += 1e-5
        load[:, k] = (follower(moved.reshape(-1, 3)) - follower(rest)).ravel() / 1e-5
    length = float(np.linalg.norm(rest[1] - rest[0]))
    # hoop force of q = 1 softens the bars sideways
    thrust = float(np.linalg.norm(follower(rest)[0])) / (2.0 * math.sin(math.pi / count))
    side = np.zeros_like(matrix)
    for i in range(count):
        j = (i + 1) % count
        t = (rest[j] - rest[i]) / length
        block = -thrust / length * (np.eye(3) - np.outer(t, t))
        for a, b, sign in ((i, i, 1), (j, j, 1), (i, j, -1), (j, i, -1)):
            side[3 * a : 3 * a + 3, 3 * b : 3 * b + 3] += sign * block
    plane = np.delete(np.arange(3 * count), np.s_[2::3])
    keep = np.ix_(plane, plane)
    lowest = []
    for q in (2.7, 3.2):
        pressure = q * bending / radius**3
        whole = (matrix + pressure * (side - load))[keep]
        lowest.append(np.sort(np.linalg.eigvals(whole).real)[:6])
    # below: three zeros and positive; above: an unstable pair
    scale = bending / radius**3
    assert lowest[0][0] > -1e-3 * scale and lowest[1][0] < -5e-3 * scale


def test_faults_of_rings_are_reported() -> None:
    rest = circle(8, 1.0)
    with pytest.raises(InputError, match="node"):
        Ring("r", np.array([0, 1, 2]), rest[:3], 1.0, 1.0)
    with pytest.raises(InputError, match="bending_stiffness"):
        Ring("r", np.arange(8), rest, 0.0, 1.0)
    bent = rest.copy()
    bent[2, 2] += 0.5
    with pytest.raises(InputError, match="plane"):
        Ring("r", np.arange(8), bent, 1.0, 1.0)


def oval(angles: np.ndarray, height: float) -> np.ndarray:
    return np.stack([np.cos(angles), height * np.sin(angles), 0.0 * angles], axis=1)


@pytest.mark.parametrize(
    ("angles", "height", "torsion"),
    [
        (np.arange(24) * math.pi / 12.0, 1.0, 0.77),
        (np.arange(5) * 0.4 * math.pi, 0.73, 555.0),
        (np.arange(4) * 0.5 * math.pi, 0.85, 0.05),
        (np.array([0.0, 0.9, 1.3, 2.9, 3.6, 4.4, 5.5]), 0.6, 30.0),
    ],
)
def test_the_step_of_rings_bounds_the_dense_matrix(angles: np.ndarray, height: float, torsion: float) -> None:
    """Coarse rings that are far stiffer in torsion than in bending were given twice the step that they bear."""
    from moyai.flexible.arrays import kernel_arrays
    from moyai.flexible.elements import Bars, Nodes
    from moyai.flexible.network import Network
    from moyai.flexible.stability import step_limit

    shape, count = oval(angles, height), angles.size
    ring = Ring("ring", np.arange(count), shape, 50.0, 50.0 * torsion)
    soft = BarType("soft", 1.0, 0.05, 0.0, volume_per_length=0.0, tension_only=False)
    own = np.arange(count)
    bars = Bars(own, (own + 1) % count, ring.lengths, np.zeros(count, dtype=int), (soft,))
    network = Network(Nodes(shape, np.zeros(count, dtype=int)), bars, Water(20.0, 1.0, 9.81), rings=(ring,))
    mass = np.repeat(network.node_mass, 3)
    fastest = math.sqrt(np.max(np.linalg.eigvals(stiffness(ring) / mass[:, None]).real))
    inverse = np.zeros((6, count))
    inverse[[0, 3, 5]] = 1.0 / network.node_mass
    limit, _ = step_limit(kernel_arrays(network), shape.T.copy(), inverse, RingArrays.of((ring,)).hinges)
    assert 0.5 < limit / (2.0 / fastest) <= 1.0
