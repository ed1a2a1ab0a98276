"""Four decks of dynamic lines whose peaks a second program and a second prototype agree on (MoorDyn RK2/RK4,
converged).

References: snap 102.36 kN; snapmass, cycles that start at 12, 18, 24 s: 76.26, 76.23, 76.35 kN; net 10x10 and 20x20,
second line,
6 to 12 s: 71.73 and 120.0 N. The chain differs by its bed and by the law of a bar coming taut:
docs/validation/flexible.md.
"""

import sys
from pathlib import Path

import numpy as np
import pytest

from moyai.flexible.simulation import simulate

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))
import flexible_decks as decks


def cycle_peaks(history, bar, period, first):
    peak = history.peak_at(bar)
    starts = np.arange(first, history.time[-1] - period + 1e-6, period)
    return np.array([peak[(history.time > a) & (history.time <= a + period)].max() for a in starts])


@pytest.mark.parametrize(("segments", "tolerance"), [(10, 5e-3), (20, 5e-3), (40, 5e-3)])
def test_snap(segments, tolerance):
    network, motion = decks.snap(segments, 21.0)
    history = simulate(network, motion, duration=20.0, output_step=0.02, keep_nodes=[0])
    assert history.status == "converged"
    assert cycle_peaks(history, segments - 1, 4.0, 8.0) == pytest.approx(102.36e3, rel=tolerance)


def test_snap_needs_no_small_step():
    """Half and a quarter of the step move the peak by less than a ten-thousandth."""
    network, motion = decks.snap(20, 13.0)
    peaks = [
        cycle_peaks(simulate(network, motion, duration=12.0, output_step=0.02, safety=s, keep_nodes=[0]), 19, 4.0, 8.0)[
            0
        ]
        for s in (0.95, 0.47, 0.24)
    ]
    assert np.array(peaks[:2]) == pytest.approx(peaks[2], rel=1e-4)


def test_snapmass():
    network, motion = decks.snapmass(20, 31.0)
    history = simulate(network, motion, duration=30.0, output_step=0.02, keep_nodes=[0])
    found = cycle_peaks(history, 19, 6.0, 12.0)
    assert found == pytest.approx([76.26e3, 76.23e3, 76.35e3], rel=5e-3)


@pytest.mark.parametrize(("knots", "reference"), [(10, 71.73), (20, 120.0)])
def test_net(knots, reference):
    network, motion = decks.net(knots, 13.0)
    column = network.strand("net column 0")
    history = simulate(network, motion, duration=12.0, output_step=0.01, keep_nodes=[0], keep_bars=[column.bars[0]])
    late = history.time > 6.0
    # the reference is the force at the lower knot, which lacks the weight of half the twine
    assert history.tension_peak[late].max() == pytest.approx(reference, rel=2e-3)


@pytest.mark.parametrize("segments", [50, 100])
def test_chain_peak_is_converged_and_near_the_peer(segments):
    network, motion = decks.chain(segments, 25.0)
    history = simulate(network, motion, duration=24.0, output_step=0.05, keep_nodes=[0])
    found = cycle_peaks(history, segments - 1, 6.0, 12.0)
    assert found == pytest.approx(49.03e3, rel=5e-3)
    assert found == pytest.approx(50.07e3, rel=0.03)
