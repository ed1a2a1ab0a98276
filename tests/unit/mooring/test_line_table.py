"""Tables for time integration: wanted accuracy reached, C1, exact outside, planar force equal to the line system."""

from __future__ import annotations

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.mooring.lines import Clump, Line, LineType, Segment, SpringLine
from moyai.mooring.system import LineSystem
from moyai.mooring.table import compile_lines, tabulate_line

LIGHT = LineType("model chain", 1.122, 2.14e4)
CHAIN = LineType("chain", 400.0, 1e8)
ROPE = LineType("rope", 5.0, 5e6)


def random_line(seed: int) -> tuple[Line, tuple[float, float], tuple[float, float], float]:
    rng = np.random.default_rng(seed)
    depth = rng.uniform(5.0, 40.0)
    height = depth * rng.uniform(0.6, 0.95)
    scope = rng.uniform(1.5, 6.0)
    length = height * scope
    reach = np.sqrt(length**2 - height**2) * rng.uniform(0.93, 0.999)
    parts: tuple[Segment, ...] = (Segment(CHAIN, length),)
    if seed % 3 == 2:
        parts = (Segment(CHAIN, 0.6 * length), Segment(ROPE, 0.4 * length))
    line = Line("l", (reach, 0.0, -depth), (0.0, 0.0, height - depth), parts)
    return line, (reach - 0.05 * height, reach + 0.04 * height), (0.9 * height, 1.1 * height), depth


@pytest.mark.parametrize("tolerance", [1e-3, 1e-5])
@pytest.mark.parametrize("seed", [*range(2), *(pytest.param(s, marks=pytest.mark.slow) for s in range(2, 8))])
def test_table_meets_its_tolerance_at_points_of_our_own(seed: int, tolerance: float) -> None:
    line, horizontal, vertical, depth = random_line(seed)
    table = tabulate_line(line, depth, horizontal, vertical, tolerance)
    rng = np.random.default_rng(999 + seed)
    x, z = rng.uniform(*horizontal, 5000), rng.uniform(*vertical, 5000)
    h, v = table.evaluate(x, z)
    exact, _ = line.solve_plane(x, z, depth)
    error = np.hypot(h - exact[:, 0], v - exact[:, 1]) / np.hypot(exact[:, 0], exact[:, 1])
    assert not np.isnan(error).any()
    assert table.measured_error < 1.2 * tolerance
    assert error.max() < 1.5 * tolerance


def test_table_is_continuous_with_its_slope() -> None:
    line, horizontal, vertical, depth = random_line(0)
    table = tabulate_line(line, depth, horizontal, vertical, 1e-3)
    count_xi, count_z = table.shape
    xi = table.nodes[:count_xi]
    z_nodes = table.nodes[count_xi : count_xi + count_z]
    reference = table.nodes[count_xi + count_z : count_xi + 2 * count_z]
    z = 0.5 * (z_nodes[1] + z_nodes[2])
    step = 1e-7
    across = []
    for edge in xi[1:-1]:
        # one-sided slopes left and right of a grid line between two height nodes
        x0 = edge + np.interp(z, z_nodes, reference)
        x = x0 + step * np.array([-2.0, -1.0, 1.0, 2.0]) * 50
        h, _ = table.evaluate(x, np.full(4, z))
        if not np.isnan(h).any():
            across.append(abs((h[1] - h[0]) - (h[3] - h[2])) / abs(h[3] - h[0]))
    assert across and max(across) < 1e-4
    x = 0.5 * (horizontal[0] + horizontal[1])
    for edge in z_nodes[1:-1]:
        h, v = table.evaluate(np.full(4, x), edge + step * np.array([-2.0, -1.0, 1.0, 2.0]) * 50)
        assert abs((v[1] - v[0]) - (v[3] - v[2])) < 1e-4 * abs(v[3] - v[0])


def test_compiled_planar_force_equals_the_line_system() -> None:
    rng = np.random.default_rng(3)
    lines = (
        Line("shore", (2.115, 0.3, -0.38), (0.19, 0.1, -0.113), (Segment(LIGHT, 2.0),), count=2),
        Line(
            "sea",
            (-2.115, 0.0, -0.38),
            (-0.19, 0.0, -0.113),
            (Segment(LIGHT, 1.0), Segment(LineType("r", 0.3, 5e3), 0.975)),
        ),
        SpringLine("spring", (1.0, 0.2, 0.1), (0.2, 0.0, 0.05), 30.0, 5.0),
        SpringLine("slack", (-1.0, 0.0, 0.1), (-0.2, 0.0, 0.05), 30.0, 0.1, tension_only=True),
    )
    system = LineSystem(lines, 0.38)
    motion = ((-0.02, 0.02), (-0.02, 0.02), (-0.1, 0.1))
    # half of the positions lie outside the window: the exact solver takes over there
    positions = rng.uniform(-1, 1, (400, 3)) * [0.03, 0.03, 0.2]
    exact = system.planar().forces(positions)
    tensions = system.planar().tensions(positions)
    scale = np.abs(exact).max(axis=0)
    force, tension = compile_lines(system).forces(positions)
    assert np.all(np.abs(force - exact) < 1e-9 * scale)
    assert np.allclose(tension, tensions, rtol=1e-9)
    compiled = compile_lines(system, motion, 1e-4)
    assert 0.0 < compiled.measured_error < 1.2e-4
    force, tension = compiled.forces(positions)
    assert np.all(np.abs(force - exact) < 3e-4 * tensions.sum(axis=1).max())
    assert np.allclose(tension, tensions, rtol=2e-4, atol=1e-12)


@pytest.mark.slow
def test_a_force_with_a_sharp_bend_stays_exact() -> None:
    """A clump that lifts off the bed bends the force law; the table cannot follow and the exact solver is kept."""
    parts = (Segment(CHAIN, 60.0), Segment(ROPE, 40.0))
    line = Line("l", (88.3, 0.0, -30.0), (0.0, 0.0, -2.0), parts, (Clump(0, 2000.0),))
    system = LineSystem((line,), 30.0)
    compiled = compile_lines(system, ((-1.0, 1.0), (-0.5, 0.5), (-0.01, 0.01)), 1e-5)
    assert compiled.tables == (None,)
    positions = np.random.default_rng(0).uniform(-1, 1, (50, 3)) * [1.0, 0.5, 0.01]
    exact = system.planar().forces(positions)
    assert np.allclose(compiled.forces(positions)[0], exact, rtol=1e-8, atol=1e-6 * np.abs(exact).max())


def test_bad_windows() -> None:
    line, horizontal, vertical, depth = random_line(0)
    for arguments in (
        (horizontal[::-1], vertical, 1e-3),
        (horizontal, (vertical[0], vertical[0]), 1e-3),
        (horizontal, vertical, 0.0),
        (horizontal, (-1.0, 5.0), 1e-3),
    ):
        with pytest.raises(InputError):
            tabulate_line(line, depth, *arguments)
    with pytest.raises(InputError):
        compile_lines(LineSystem((line,), depth), tolerance=1e-3)
