"""Independent proof: the differential equations of the extensible cable, integrated numerically, end at the fairlead.

dx/ds = H (1/T + 1/EA), dz/ds = V (1/T + 1/EA), dV/ds = w over the unstretched arc s; on the bed dx/ds = 1 + T/EA with
dT/ds = mu w. The forces come from the solver, the positions from scipy.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from moyai.mooring.catenary import solve_catenary
from moyai.mooring.lines import Clump, Line, LineType, Segment
from moyai.mooring.shape import line_shape


def integrate_hanging(h: float, v: float, weight: float, axial: float, length: float) -> np.ndarray:
    def slope(s: float, y: np.ndarray) -> list[float]:
        vertical = v + weight * s
        rate = 1.0 / np.hypot(h, vertical) + 1.0 / axial
        return [h * rate, vertical * rate]

    return solve_ivp(slope, (0.0, length), [0.0, 0.0], method="DOP853", rtol=1e-12, atol=1e-13 * length).y[:, -1]


def integrate_bed(h: float, weight: float, axial: float, length: float, friction: float) -> float:
    """Walk from the touchdown towards the anchor."""

    def slope(s: float, y: np.ndarray) -> list[float]:
        return [1.0 + max(h - friction * weight * s, 0.0) / axial]

    stop = min(length, h / (friction * weight)) if friction > 0.0 else length
    first = solve_ivp(slope, (0.0, stop), [0.0], method="DOP853", rtol=1e-12, atol=1e-14 * length).y[0, -1]
    return float(first + (length - stop))


@pytest.mark.parametrize("seed", range(60))
def test_uniform_line_ends_at_its_fairlead(seed: int) -> None:
    rng = np.random.default_rng(seed)
    chord, angle = 10.0 ** rng.uniform(-1, 3), rng.uniform(0.02, 1.5)
    # up to the length that lies in a heap
    length = chord * rng.uniform(0.6, 0.97 * (np.cos(angle) + np.sin(angle)))
    weight = 10.0 ** rng.uniform(-2, 3)
    axial = weight * length * 10.0 ** rng.uniform(0, 6)
    friction = float(rng.choice([0.0, rng.uniform(0, 1.2)]))
    bed = bool(seed % 3)
    x, z = chord * np.cos(angle), chord * np.sin(angle)
    line = solve_catenary(x, z, length, axial, weight, bed=bed, bed_friction=friction)
    h, ground = float(line.horizontal_tension), float(line.grounded_length)
    assert h > 0.0
    start = 0.0 if ground > 0.0 else float(line.vertical_tension_anchor)
    end = integrate_hanging(h, start, weight, axial, length - ground)
    reach = end[0] + (integrate_bed(h, weight, axial, ground, friction) if ground > 0.0 else 0.0)
    assert reach == pytest.approx(x, abs=1e-9 * length)
    assert end[1] == pytest.approx(z, abs=1e-9 * length)


@pytest.mark.parametrize("seed", range(25))
def test_segmented_line_ends_at_its_fairlead(seed: int) -> None:
    rng = np.random.default_rng(1000 + seed)
    count = int(rng.integers(2, 5))
    chord, angle = rng.uniform(5.0, 200.0), rng.uniform(0.05, 1.4)
    lengths = rng.dirichlet(np.ones(count)) * chord * rng.uniform(0.9, 0.97 * (np.cos(angle) + np.sin(angle)))
    weights = 10.0 ** rng.uniform(1, 3, count)
    stiffness = weights * chord * 10.0 ** rng.uniform(1, 5, count)
    clumps = [
        Clump(i, float(rng.uniform(0, 2) * weights[i] * lengths[i])) for i in range(count - 1) if rng.random() < 0.6
    ]
    friction = float(rng.choice([0.0, 0.7]))
    segments = [Segment(LineType(f"t{i}", weights[i], stiffness[i]), lengths[i]) for i in range(count)]
    line = Line("line", (0.0, 0.0, -300.0), (0.0, 0.0, 0.0), tuple(segments), tuple(clumps), friction)
    x, z = chord * np.cos(angle), chord * np.sin(angle)
    out, _ = line.solve_plane(np.array([x]), np.array([z]), 300.0)
    h, v, ground = out[0, 0], out[0, 1], out[0, 4]
    assert h > 0.0
    jumps = {clump.after_segment: clump.submerged_weight for clump in clumps}
    reach = height = 0.0
    left = lengths.sum()
    tension, on_bed = h, False
    for i in reversed(range(count)):  # from the fairlead down to the anchor
        free = min(lengths[i], max(left - ground, 0.0))
        if abs(left - free - ground) < 1e-9 * lengths.sum():
            free = left - ground if left - ground < lengths[i] else lengths[i]
        if free > 1e-12 * lengths[i]:
            v -= weights[i] * free
            step = integrate_hanging(h, v, weights[i], stiffness[i], free)
            reach, height = reach + step[0], height + step[1]
        if free < lengths[i] * (1 - 1e-12):
            on_bed = True
            reach += (
                integrate_bed(tension, weights[i], stiffness[i], lengths[i] - free, friction)
                if tension > 0
                else lengths[i]
            )
            tension = max(tension - friction * weights[i] * (lengths[i] - free), 0.0)
        left -= lengths[i]
        if i > 0 and i - 1 in jumps:
            lifted = (
                0.0
                if on_bed
                else (min(v, jumps[i - 1]) if ground >= left * (1 - 1e-12) and ground > 0 else jumps[i - 1])
            )
            v -= lifted
            if ground >= left * (1 - 1e-12) and ground > 0:
                tension = max(tension - friction * (jumps[i - 1] - lifted), 0.0)
    assert reach == pytest.approx(x, abs=1e-8 * chord)
    assert height == pytest.approx(z, abs=1e-8 * chord)


@pytest.mark.parametrize("seed", range(20))
def test_force_is_the_gradient_of_the_energy(seed: int) -> None:
    """U = integral of T^2/2EA + w z over the drawn line (Simpson); dU/dX = H and dU/dZ = V at the fairlead."""
    rng = np.random.default_rng(2000 + seed)
    length, weight = rng.uniform(5.0, 50.0), rng.uniform(5.0, 50.0)
    axial = weight * length * 10.0 ** rng.uniform(0, 2)
    depth = 40.0
    angle = rng.uniform(0.2, 1.2)
    chord = length / rng.uniform(0.8, 1.35)
    line = Line("line", (0.0, 0.0, -depth), (0.0, 0.0, 0.0), (Segment(LineType("t", weight, axial), length),))
    point = np.array([chord * np.cos(angle), 0.0, -depth + chord * np.sin(angle)])

    def energy(position: np.ndarray) -> float:
        shape = line_shape(line, position, depth, points=4001)
        density = shape.tension**2 / (2.0 * axial) + weight * shape.height
        ground = float(line.solve(position[None, :], depth).grounded_length[0])
        total = 0.0
        for part in (shape.arc_length <= ground + 1e-12 * length, shape.arc_length >= ground - 1e-12 * length):
            s, f = shape.arc_length[part], density[part]
            if len(s) > 1:
                total += _simpson(s, f)
        return total

    state = line.solve(point[None, :], depth)
    for axis, expected in ((0, state.horizontal_tension[0]), (2, state.vertical_tension_fairlead[0])):
        step = np.zeros(3)
        step[axis] = 1e-4 * length
        slope = (energy(point + step) - energy(point - step)) / (2.0 * step[axis])
        assert slope == pytest.approx(expected, rel=2e-5, abs=2e-6 * state.tension_fairlead[0])


def _simpson(s: np.ndarray, f: np.ndarray) -> float:
    from scipy.integrate import simpson

    return float(simpson(f, x=s))
