"""Lines of one bar: no wave runs along them, but a snap within few steps makes their peak a matter of the step."""

import math

import numpy as np
import pytest

from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType
from moyai.flexible.motion import Motion
from moyai.flexible.simulation import simulate
from moyai.sea.water import Water


def _hung(random, viscosity):
    """A weight on a line of one bar that nothing else moves."""
    stiffness, mass = 10.0 ** random.uniform(5, 6), random.uniform(20.0, 100.0)
    kind = BarType("rope", 1.0, stiffness, 0.02, viscosity=viscosity * math.sqrt(stiffness * mass))
    builder = NetworkBuilder(Water(math.inf, 1e-9, 9.81), None)
    builder.driven("top", (0.0, 0.0, 0.0))
    length = random.uniform(3.0, 10.0)
    stretched = length * (1.0 + (mass + 0.5 * length) * 9.81 / stiffness)
    return builder, kind, length, stretched, mass


def test_snaps_of_one_bar_are_reported_because_they_hang_on_the_step():
    """A light end falls into a slack line of one bar: only few steps see the snap."""
    errors = []
    for seed in range(8):
        random = np.random.default_rng(seed)
        builder, kind, length, _, _ = _hung(random, 0.02)
        builder.free("end", (0.0, 0.0, -0.8 * length))
        builder.line("line", "top", "end", kind, length=length, segments=1, shape="straight")
        still = {"top": Motion(0.0, 10.0, np.zeros((2, 3)), np.zeros((2, 3)))}
        usual = simulate(builder.build(), still, duration=2.0, output_step=0.1)
        fine = simulate(builder.build(), still, duration=2.0, output_step=0.1, step=usual.step / 20.0)
        reported = [notice for notice in usual.notices if notice.code == "wave-front"]
        assert len(reported) == 1 and "few steps" in reported[0].message and "shorter step" in reported[0].remedy
        errors.append(abs(usual.tension_peak.max() / fine.tension_peak.max() - 1.0))
    assert max(errors) > 0.02


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("method", ["explicit", "tr_bdf2"])
def test_a_bar_that_is_pulled_slowly_is_not_reported(seed, method):
    random = np.random.default_rng(seed)
    builder, kind, length, stretched, mass = _hung(random, 0.2)
    builder.free("end", (0.0, 0.0, -stretched), mass=mass)
    builder.line("line", "top", "end", kind, length=length, segments=1, shape="straight")
    swing = {"top": Motion.harmonic((0.0, 0.0, 0.5), 3.0, duration=6.0, ramp=3.0)}
    history = simulate(builder.build(), swing, duration=6.0, output_step=0.1, method=method)
    assert history.status == "converged" and history.notices == ()
    # the end goes with the top: m (g + a) within the ripple of the line
    highest = (mass + 0.5 * length) * (9.81 + 0.5 * (2.0 * math.pi / 3.0) ** 2)
    assert history.tension_peak.max() == pytest.approx(highest, rel=0.05)
