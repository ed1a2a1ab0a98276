"""Water against the seaward deck edge, by hand for motions that are given."""

from types import SimpleNamespace

import numpy as np
import pytest

from moyai.structures.breakwater.responses import deck_relative_elevation


@pytest.mark.parametrize(("heading", "side"), [(0.0, -1.0), (np.pi, 1.0)])
def test_doubled_wave_less_the_motion_of_the_edge(heading, side):
    """|2 exp(i k x cos(heading)) - (heave - roll x)| at the edge that meets the waves, half a beam from the middle."""
    beam, centre = 4.0, (0.25, -0.6)
    unit = SimpleNamespace(breakwater=SimpleNamespace(hull=SimpleNamespace(beam=beam)), freeboard=1.1, centre=centre)
    k = np.array([0.0, 0.3, 1.2])
    sway, heave, roll = np.array([9.0, 9.0, 9.0]), np.array([0.4, 0.3j, -0.2]), np.array([0.0, 0.1, 0.05j])
    motions = SimpleNamespace(displacement=np.stack([sway, heave, roll], axis=-1)[:, None, :])
    x = side * 0.5 * beam
    expected = np.abs(2.0 * np.exp(1j * k * x * np.cos(heading)) - (heave - roll * (x - centre[0])))
    assert deck_relative_elevation(unit, motions, k, heading) == pytest.approx(expected, rel=1e-12)
