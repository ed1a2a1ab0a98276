"""Drawn lines end where they must, never dip under the bed, and carry the tensions of the solver."""

from __future__ import annotations

import numpy as np
import pytest

from moyai.mooring import kernels
from moyai.mooring.lines import Clump, Line, LineType, Segment, SpringLine
from moyai.mooring.shape import element_shape, line_shape


def faults_of_a_random_line(seed: int) -> list[str]:
    """Draw one line of one to four segments; return what of it does not hold."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 5))
    chord, angle, azimuth = rng.uniform(1.0, 50.0), rng.uniform(0.0, np.pi / 2), rng.uniform(0.0, 2 * np.pi)
    length = chord * rng.uniform(0.7, 2.5)
    depth = 60.0
    raised = rng.uniform(0.0, 3.0) if count == 1 and seed % 3 == 0 else 0.0
    weight = rng.uniform(5.0, 500.0)
    parts = []
    for share in rng.dirichlet(np.ones(count)):
        heavy = weight * (rng.uniform(0.3, 3.0) if count > 1 else 1.0)
        parts.append(Segment(LineType("t", heavy, weight * length * 10.0 ** rng.uniform(0, 6)), share * length))
    clumps = [Clump(i, rng.uniform(0.0, weight * length)) for i in range(count - 1) if rng.random() < 0.5]
    friction = float(rng.choice([0.0, rng.uniform(0.0, 1.0)])) if raised == 0.0 else 0.0
    line = Line("l", (3.0, 4.0, raised - depth), (0, 0, 0), tuple(parts), tuple(clumps), friction)
    offset = chord * np.array([np.cos(angle) * np.cos(azimuth), np.cos(angle) * np.sin(azimuth), np.sin(angle)])
    point = np.asarray(line.anchor) + offset
    shape = line_shape(line, point, depth)
    state = line.solve(point[None, :], depth)
    tension = state.tension_fairlead[0]
    holds = {
        "ends at the fairlead": np.abs(shape.points[-1] - point).max() < 1e-9 * length,
        "starts at the anchor": np.allclose(shape.points[0], line.anchor),
        "tension at the fairlead": shape.tension[-1] == pytest.approx(tension, rel=1e-9),
        "tension at the anchor": shape.tension[0]
        == pytest.approx(state.tension_anchor[0], rel=1e-9, abs=1e-9 * tension),
        "whole length": shape.arc_length[-1] == pytest.approx(length),
        "arc grows": np.all(np.diff(shape.arc_length) > 0.0),
        "above the bed": shape.points[:, 2].min() > -depth - 1e-9 * length,
    }
    if state.regime[0] not in (kernels.SLACK_ON_BED,):
        # the polygon of a line is shorter than the stretched line itself and near to it
        drawn = np.linalg.norm(np.diff(shape.points, axis=0), axis=1).sum()
        mean = 0.5 * (shape.tension[1:] + shape.tension[:-1]) * np.diff(shape.arc_length)
        stretch = sum(mean) / min(part.line_type.axial_stiffness for part in parts)
        holds["length drawn"] = 0.98 * length < drawn < length + stretch * (1 + 1e-6) + 1e-9 * length
    return [f"line {seed}: {what}" for what, held in holds.items() if not held]


def test_random_lines_are_drawn_from_anchor_to_fairlead() -> None:
    wrong = [fault for seed in range(300) for fault in faults_of_a_random_line(seed)]
    assert not wrong, "\n".join(wrong)


def test_springs_are_straight() -> None:
    shape = element_shape(SpringLine("s", (5.0, 0, 0), (0.0, 0, 0), 10.0, 1.0), [0.0, 0.0, 1.0], 10.0)
    assert np.allclose(shape.points, [[5.0, 0, 0], [0, 0, 1.0]])
    assert shape.tension[0] == pytest.approx(1.0 + 10.0 * (np.sqrt(26.0) - 5.0))
