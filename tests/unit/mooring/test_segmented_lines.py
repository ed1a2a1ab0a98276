"""Lines of several segments: one material equals the fast kernel, random lines never fail, clumps, buoys."""

from __future__ import annotations

import numpy as np
import pytest

from moyai.mooring import kernels, segments
from moyai.mooring.catenary import solve_catenary
from moyai.mooring.lines import Clump, Line, LineType, Segment


def solve(
    x: object, z: object, rows: np.ndarray, clearance: float = 0.0, friction: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    x, z = np.atleast_1d(np.asarray(x, float)), np.atleast_1d(np.asarray(z, float))
    out, regime = np.empty((x.size, 11)), np.empty(x.size, dtype=np.int64)
    segments.solve_segments_batch(x, z, rows, clearance, friction, np.zeros(x.size), out, regime)
    return out, regime


@pytest.mark.parametrize(
    ("clearance", "friction", "sign"), [(0.0, 0.0, 1), (0.0, 0.8, 1), (-1.0, 0.0, 1), (-1.0, 0.0, -1)]
)
def test_one_material_in_pieces_equals_the_uniform_line(clearance: float, friction: float, sign: int) -> None:
    rng = np.random.default_rng(1)
    for k in range(800):
        chord, angle = 10.0 ** rng.uniform(-1, 3), rng.uniform(0, np.pi / 2)
        length, weight = chord * rng.uniform(0.5, 3.0), 10.0 ** rng.uniform(-2, 3)
        axial = weight * length * 10.0 ** rng.uniform(0, 7)
        x = 0.0 if k % 40 == 0 else chord * np.cos(angle)
        z = chord * np.sin(angle) * (1.0 if clearance == 0.0 else rng.choice([-1.0, 1.0]))
        pieces = np.diff(np.r_[0.0, np.sort(rng.uniform(0, 1, 2)), 1.0]) * length
        out, regime = solve(
            x, z, np.array([[piece, axial, sign * weight, 0.0] for piece in pieces]), clearance, friction
        )
        exact = solve_catenary(x, z, length, axial, sign * weight, bed=clearance == 0.0, bed_friction=friction)
        scale = exact.tension_fairlead + 1e-9 * weight * length
        assert regime[0] < kernels.NOT_CONVERGED and out[0, 9] < 1e-10
        assert abs(out[0, 0] - exact.horizontal_tension) < 1e-8 * scale
        assert abs(out[0, 1] - exact.vertical_tension_fairlead) < 1e-8 * scale
        assert abs(out[0, 2] - exact.horizontal_tension_anchor) < 1e-8 * scale
        assert abs(out[0, 4] - exact.grounded_length) < 1e-8 * length
        assert np.abs(out[0, 5:9] - exact.stiffness.ravel()).max() < 1e-7 * np.abs(exact.stiffness).max()


def random_rows(rng: np.random.Generator, length: float, buoyant: bool) -> np.ndarray:
    count = int(rng.integers(2, 6))
    pieces = rng.dirichlet(np.ones(count)) * length
    weight = 10.0 ** rng.uniform(-2, 3) * 10.0 ** rng.uniform(-1, 1, count)
    clump = np.where(rng.random(count) < 0.5, weight * length * 10.0 ** rng.uniform(-2, 0.5, count), 0.0)
    if buoyant:
        clump *= rng.choice([-1, 1], count)
        weight = weight * np.where(rng.random(count) < 0.3, -1.0, 1.0)
    return np.column_stack([pieces, np.abs(weight) * length * 10.0 ** rng.uniform(0, 7, count), weight, clump])


@pytest.mark.parametrize(
    ("clearance", "friction", "buoyant"), [(0.0, 0.0, False), (0.0, 0.7, False), (-1.0, 0.0, True)]
)
def test_random_lines_of_random_segments_never_fail(clearance: float, friction: float, buoyant: bool) -> None:
    rng = np.random.default_rng(7)
    errors = []
    for k in range(3000):
        chord, angle = 10.0 ** rng.uniform(-1, 3), rng.uniform(0, np.pi / 2)
        rows = random_rows(rng, chord * rng.uniform(0.5, 3.0), buoyant)
        x, z = (0.0 if k % 50 == 0 else chord * np.cos(angle)), chord * np.sin(angle)
        out, regime = solve(x, z, rows, clearance, friction)
        assert regime[0] < kernels.NOT_CONVERGED
        assert out[0, 9] < 1e-10 and np.all(np.isfinite(out))
        step = 1e-6 * chord
        if x > step and z > step:
            ends, _ = solve([x + step, x - step, x, x], [z, z, z + step, z - step], rows, clearance, friction)
            numeric = np.array(
                [ends[0, 0] - ends[1, 0], ends[2, 0] - ends[3, 0], ends[0, 1] - ends[1, 1], ends[2, 1] - ends[3, 1]]
            ) / (2.0 * step)
            errors.append(np.abs(numeric - out[0, 5:9]).max() / np.abs(out[0, 5:9]).max())
    assert np.quantile(errors, 0.99) < 1e-6


def test_neutrally_buoyant_segments() -> None:
    """A taut rope without weight between two chains is straight: force directions at its ends agree."""
    chain, rope = LineType("chain", 400.0, 1e8), LineType("rope", 0.0, 1e6)
    line = Line("l", (0, 0, -20), (0, 0, 0), (Segment(chain, 30.0), Segment(rope, 20.0), Segment(chain, 5.0)))
    out, regime = line.solve_plane(np.array([50.0]), np.array([18.0]), 20.0)
    assert regime[0] < kernels.NOT_CONVERGED and out[0, 9] < 1e-10
    # with next to no weight instead of none the answer is the same
    nearly = Line(
        "l",
        (0, 0, -20),
        (0, 0, 0),
        (Segment(chain, 30.0), Segment(LineType("r", 1e-7, 1e6), 20.0), Segment(chain, 5.0)),
    )
    other, _ = nearly.solve_plane(np.array([50.0]), np.array([18.0]), 20.0)
    assert np.allclose(out[0, :9], other[0, :9], rtol=1e-6)


def test_clump_resting_on_the_bed_carries_part_of_the_pull() -> None:
    chain = LineType("chain", 100.0, 1e9)
    clump = 5000.0
    line = Line("l", (0, 0, -10), (0, 0, 0), (Segment(chain, 60.0), Segment(chain, 12.0)), (Clump(0, clump),))
    reach = np.array([66.0, 68.0, 69.5])
    out, _ = line.solve_plane(reach, np.full(3, 10.0), 10.0)
    hanging = 12.0 * 100.0
    on_bed = out[:, 4] >= 60.0 - 1e-9
    assert on_bed[0]
    lifted = out[on_bed, 1] - hanging
    assert np.all((lifted > 0.0) & (lifted < clump))


def test_clump_weight_raises_the_tension_and_a_buoy_lifts_the_line() -> None:
    chain = LineType("chain", 100.0, 1e9)
    parts = (Segment(chain, 40.0), Segment(chain, 20.0))
    tensions = []
    for clump in (-1500.0, 0.0, 1500.0):
        line = Line("l", (0, 0, -15), (0, 0, 0), parts, (Clump(0, clump),))
        out, regime = line.solve_plane(np.array([56.0]), np.array([15.0]), 15.0)
        assert regime[0] < kernels.NOT_CONVERGED
        tensions.append(out[0, 1])
    assert tensions[0] < tensions[1] < tensions[2]


def test_second_contact_with_the_bed_is_named_not_guessed() -> None:
    """A strong buoy near the anchor of a slack line: chain beyond the buoy would sink under the bed."""
    chain = LineType("chain", 300.0, 1e8)
    parts = (Segment(chain, 10.0), Segment(chain, 60.0))
    line = Line("l", (0, 0, -20), (0, 0, 0), parts, (Clump(0, -2500.0),))
    _, regime = line.solve_plane(np.array([50.0]), np.array([20.0]), 20.0)
    assert regime[0] == kernels.TOUCHES_BETWEEN
