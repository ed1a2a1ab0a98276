"""Line systems: forces, moments, stiffness against finite differences, equilibrium, planar view, springs, copies."""

from __future__ import annotations

import numpy as np
import pytest

from moyai.core.errors import ConvergenceError, InputError
from moyai.mooring.lines import Clump, Line, LineType, Segment, SpringLine
from moyai.mooring.rotations import (
    cross_matrix,
    roll_pitch_yaw,
    rotation_from_vector,
    rotation_matrix,
    spin_of_angle_rates,
)
from moyai.mooring.system import LineSystem

CHAIN = LineType("chain", 400.0, 1e8)
ROPE = LineType("rope", 5.0, 5e6)


def random_system(seed: int, friction: float = 0.0) -> LineSystem:
    rng = np.random.default_rng(seed)
    lines: list[Line | SpringLine] = []
    for i in range(int(rng.integers(3, 7))):
        azimuth = rng.uniform(0, 2 * np.pi)
        anchor = (30 * np.cos(azimuth), 30 * np.sin(azimuth), -10.0)
        fairlead = (5 * np.cos(azimuth), 3 * np.sin(azimuth), rng.uniform(-3, -1))
        parts: tuple[Segment, ...] = (Segment(CHAIN, rng.uniform(26.5, 30)),)
        clumps: tuple[Clump, ...] = ()
        if i % 3 == 2:
            parts, clumps = (Segment(CHAIN, 15.0), Segment(ROPE, 12.0)), (Clump(0, rng.uniform(0, 3000)),)
        lines.append(Line(f"line {i}", anchor, fairlead, parts, clumps, friction, count=1 + i % 2))
    lines.append(SpringLine("spring", (20.0, 3.0, 0.0), (2.0, 2.0, 1.0), 1e3, 2e3))
    return LineSystem(tuple(lines), 10.0)


def moved(system: LineSystem, position: np.ndarray, about: tuple[float, ...], step: np.ndarray) -> np.ndarray:
    """Force after a displacement of ``about`` and a rotation by a vector, both in site axes."""
    rotation = rotation_matrix(position[3:])
    turned = rotation_from_vector(step[3:]) @ rotation
    origin = position[:3] + rotation @ np.array(about) + step[:3] - turned @ np.array(about)
    return system.forces(np.r_[origin, roll_pitch_yaw(turned)], about)


@pytest.mark.parametrize("friction", [0.0, 0.6])
@pytest.mark.parametrize("seed", range(6))
def test_tangent_stiffness_against_finite_differences(seed: int, friction: float) -> None:
    rng = np.random.default_rng(100 + seed)
    system = random_system(seed, friction)
    position = rng.normal(size=6) * [0.5, 0.5, 0.3, 0.2, 0.2, 0.3]
    about = tuple(rng.normal(size=3))
    analytic = system.stiffness(position, about)
    numeric = np.empty((6, 6))
    for j, unit in enumerate(np.eye(6)):
        h = 1e-6
        numeric[:, j] = -(moved(system, position, about, h * unit) - moved(system, position, about, -h * unit)) / (
            2 * h
        )
    assert np.abs(numeric - analytic).max() < 1e-6 * np.abs(analytic).max()


@pytest.mark.parametrize("seed", range(5))
def test_stiffness_is_symmetric_at_equilibrium_of_conservative_lines(seed: int) -> None:
    system = random_system(seed)
    found = system.equilibrium(np.array([0, 0, 3e4, 0, 0, 0.0]), np.diag([0, 0, 1e5, 1e6, 1e6, 0.0]))
    stiffness = system.stiffness(found.position)
    moment = system.forces(found.position)[3:]
    # the antisymmetric part of the rotations is half the cross matrix of the moment left
    part = 0.5 * (stiffness - stiffness.T)
    assert np.abs(part[:3, :3]).max() < 1e-9 * np.abs(stiffness).max()
    expected = 0.5 * np.abs(cross_matrix(moment)).max()
    assert np.abs(part[3:, 3:]).max() == pytest.approx(expected, rel=1e-6, abs=1e-7 * np.abs(stiffness).max())


@pytest.mark.parametrize("seed", range(5))
def test_work_around_a_closed_path_vanishes(seed: int) -> None:
    """Conservative lines: the power integral over a closed planar loop is zero."""
    view = random_system(seed).planar()
    t = np.linspace(0.0, 2 * np.pi, 401)[:-1]
    path = np.column_stack([0.4 * np.sin(t), 0.2 * np.cos(t), 0.1 * np.sin(2 * t + 1)])
    rate = np.column_stack([0.4 * np.cos(t), -0.2 * np.sin(t), 0.2 * np.cos(2 * t + 1)])
    power = np.einsum("ij,ij->i", view.forces(path), rate)
    assert abs(power.mean()) < 1e-6 * np.abs(power).mean()


@pytest.mark.parametrize("seed", range(5))
def test_planar_stiffness_is_symmetric_everywhere_and_exact(seed: int) -> None:
    rng = np.random.default_rng(200 + seed)
    view = random_system(seed).planar()
    position = rng.normal(size=3) * [0.5, 0.3, 0.2]
    stiffness = view.stiffness(position)
    assert np.abs(stiffness - stiffness.T).max() < 1e-9 * np.abs(stiffness).max()
    for j, unit in enumerate(np.eye(3)):
        column = -(view.forces(position + 1e-6 * unit) - view.forces(position - 1e-6 * unit)) / 2e-6
        assert np.abs(column - stiffness[:, j]).max() < 1e-6 * np.abs(stiffness).max()


def test_planar_roll_sign() -> None:
    """Positive roll moves a point by theta (z, -x): a fairlead under the origin goes to -x."""
    spring = SpringLine("s", (10.0, 0.0, -2.0), (0.0, 0.0, -2.0), 100.0, 50.0)
    view = LineSystem((spring,), 20.0).planar()
    theta = 1e-3
    force = view.forces([0.0, 0.0, theta])
    assert force[0] == pytest.approx(50.0 + 100.0 * 2.0 * theta, rel=1e-4)
    # moment = z Fx - x Fz about the origin
    assert force[2] == pytest.approx(-2.0 * force[0], rel=1e-3)
    about = view.forces([0.0, 0.0, 0.0], about=(0.0, -2.0))
    assert about[2] == pytest.approx(0.0, abs=1e-12)


def test_two_pretensioned_springs_of_a_flume_test() -> None:
    springs = (
        SpringLine("up", (-3.0, 0.0, 0.05), (-0.2, 0.0, 0.05), 30.0, 15.0),
        SpringLine("down", (3.0, 0.0, 0.05), (0.2, 0.0, 0.05), 30.0, 15.0),
    )
    view = LineSystem(springs, 1.0).planar()
    stiffness = view.stiffness([0.0, 0.0, 0.0])
    assert stiffness[0, 0] == pytest.approx(60.0)
    assert stiffness[1, 1] == pytest.approx(2 * 15.0 / 2.8)  # pretension over length
    assert view.forces([0.01, 0.0, 0.0])[0] == pytest.approx(-0.6)
    assert view.tensions([0.01, 0.0, 0.0]) == pytest.approx([15.3, 14.7])


def test_tension_only_spring_goes_slack() -> None:
    view = LineSystem((SpringLine("s", (5.0, 0, 0), (0.0, 0, 0), 10.0, 1.0, tension_only=True),), 5.0).planar()
    assert view.forces([0.2, 0, 0])[0] == 0.0
    assert view.forces([0.05, 0, 0])[0] == pytest.approx(0.5)


def test_copies_multiply_forces_and_stiffness_not_tensions() -> None:
    one = Line("l", (30.0, 0, -10.0), (5.0, 0, -2.0), (Segment(CHAIN, 28.0),))
    many = Line("l", (30.0, 0, -10.0), (5.0, 0, -2.0), (Segment(CHAIN, 28.0),), count=3)
    a, b = LineSystem((one,), 10.0), LineSystem((many,), 10.0)
    assert np.allclose(3 * a.forces(np.zeros(6)), b.forces(np.zeros(6)))
    assert np.allclose(3 * a.stiffness(np.zeros(6)), b.stiffness(np.zeros(6)))
    assert np.allclose(a.tensions(np.zeros(6)), b.tensions(np.zeros(6)))


def test_turning_the_site_turns_the_forces() -> None:
    system = random_system(3)
    angle = 0.7
    turn = rotation_matrix([0.0, 0.0, angle])
    lines = [
        Line(f"l{i}", tuple(turn @ line.anchor), tuple(turn @ line.fairlead), line.segments, line.clumps)
        for i, line in enumerate(system.lines)
        if isinstance(line, Line)
    ]
    straight = [
        Line(f"l{i}", line.anchor, line.fairlead, line.segments, line.clumps)
        for i, line in enumerate(system.lines)
        if isinstance(line, Line)
    ]
    position = np.array([0.3, -0.2, 0.1, 0.0, 0.0, 0.0])
    turned = np.r_[turn @ position[:3], 0, 0, 0]
    a = LineSystem(tuple(straight), 10.0).forces(position)
    b = LineSystem(tuple(lines), 10.0).forces(turned)
    assert np.allclose(np.r_[turn @ a[:3], turn @ a[3:]], b, rtol=1e-9, atol=1e-6)


@pytest.mark.parametrize("seed", range(8))
def test_equilibrium_balances_load_lines_and_hydrostatics(seed: int) -> None:
    rng = np.random.default_rng(300 + seed)
    system = random_system(seed)
    hydrostatic = np.diag([0, 0, 1e6, 1e7, 1e7, 0.0])
    load = rng.normal(size=6) * [3e4, 3e4, 3e4, 3e4, 3e4, 2e4]
    found = system.equilibrium(load, hydrostatic, subtract_equilibrium_force=True)
    imbalance = system.forces(found.position) - system.forces(np.zeros(6)) + load - hydrostatic @ found.position
    assert np.abs(imbalance).max() < 1e-6 * np.abs(load).max()
    assert found.iterations < 40


def test_equilibrium_from_slack_lines() -> None:
    """All lines slack at the start: no stiffness there, the search still finds the balance."""
    lines = (
        Line("a", (-30.0, 0, -10.0), (-5.0, 0, -2.0), (Segment(CHAIN, 34.0),)),
        Line("b", (30.0, 0, -10.0), (5.0, 0, -2.0), (Segment(CHAIN, 34.0),)),
    )
    view = LineSystem(lines, 10.0).planar()
    found = view.equilibrium([5e3, 0.0, 0.0], np.diag([0.0, 1e6, 1e7]), start=[0.5, 0, 0])
    assert found.line_force[0] == pytest.approx(-5e3, rel=1e-8)


@pytest.mark.slow
def test_equilibrium_that_does_not_exist() -> None:
    view = LineSystem((SpringLine("s", (-5.0, 0, 0), (0.0, 0, 0), 10.0, 1.0, tension_only=True),), 5.0).planar()
    with pytest.raises(ConvergenceError):
        view.equilibrium([-50.0, 5.0, 3.0])


def test_restoring_curve_hardens_and_matches_its_stiffness() -> None:
    system = random_system(2)
    curve = system.restoring_curve("surge", np.linspace(-0.5, 0.5, 201))
    slope = np.gradient(curve.force[:, 0], curve.offsets)
    assert np.allclose(-slope[5:-5], curve.stiffness[5:-5, 0, 0], rtol=2e-3)
    with pytest.raises(InputError, match="unknown direction"):
        system.restoring_curve("sideways", [0.0])


@pytest.mark.parametrize("seed", range(5))
def test_rotations(seed: int) -> None:
    rng = np.random.default_rng(seed)
    angles = rng.uniform(-1.2, 1.2, 3)
    r = rotation_matrix(angles)
    assert np.allclose(r @ r.T, np.eye(3)) and np.linalg.det(r) == pytest.approx(1.0)
    assert np.allclose(roll_pitch_yaw(r), angles)
    change = 1e-7 * rng.normal(size=3)
    turned = rotation_from_vector(spin_of_angle_rates(angles) @ change) @ r
    assert np.allclose(turned, rotation_matrix(angles + change), atol=1e-12)
    # roll, then pitch, then yaw about site axes
    steps = [rotation_from_vector(a * e) for a, e in zip(angles, np.eye(3))]
    assert np.allclose(steps[2] @ steps[1] @ steps[0], r)


@pytest.mark.parametrize(
    "build",
    [
        lambda: LineSystem((Line("l", (30, 0, -11), (5, 0, -2), (Segment(CHAIN, 28.0),)),), 10.0),
        lambda: LineSystem((SpringLine("a", (1, 0, 0), (0, 0, 0), 1.0, 0.0),) * 2, 10.0),
        lambda: LineSystem((), -3.0),
        lambda: Line("l", (30, 0), (5, 0, -2), (Segment(CHAIN, 28.0),)),
        lambda: Line("l", (30, 0, float("nan")), (5, 0, -2), (Segment(CHAIN, 28.0),)),
        lambda: Line("l", (30, 0, -10), (5, 0, -2), ()),
        lambda: Line("l", (30, 0, -10), (5, 0, -2), (Segment(CHAIN, 28.0),), (Clump(0, 5.0),)),
        lambda: Segment(CHAIN, 0.0),
        lambda: LineType("x", 1.0, 0.0),
        lambda: SpringLine("s", (1, 0, 0), (1, 0, 0), 10.0, 1.0),
        lambda: random_system(0).forces(np.zeros(5)),
        lambda: random_system(0).forces(np.full(6, np.nan)),
    ],
)
def test_bad_input_has_a_message(build: object) -> None:
    with pytest.raises(InputError):
        build()  # type: ignore[operator]
