"""The compiled march of a planar body on lines: the same run as the joint of body and network takes it."""

from __future__ import annotations

import numpy as np
import pytest
from bodies_for_tests import light
from test_planar_body import model_of

from moyai.coupled import simulate as coupled
from moyai.coupled.planar import PlanarBody
from moyai.coupled.planar_march import PlanarMarch
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.flow import Flow
from moyai.floating.forcing import RegularForcing
from moyai.sea.components import WaveComponents
from moyai.sea.current import power_law, uniform
from moyai.sea.water import Water

WATER = Water(depth=5.0, density=1025.0, gravity=9.81)


def run(monkeypatch: pytest.MonkeyPatch, flow: Flow, *, compiled: bool, stiffness: float) -> coupled.CoupledHistory:
    """A body on two stretched lines, run in one of both ways until body and network agree closely."""
    builder = NetworkBuilder(WATER)
    line = light(stiffness, mass=0.8)
    points = {"left": (-1.5, 0.0, -0.2), "right": (1.5, 0.0, -0.2)}
    for name, (x, _, _) in points.items():
        builder.fixed(f"{name} anchor", (4.0 * x, 0.0, -4.0))
        builder.driven(name, points[name])
        builder.line(name, f"{name} anchor", name, line, length=5.6, segments=4, shape="straight")
    forcing = RegularForcing(
        omega=1.4, wave_amplitude=0.06, excitation_force=np.array([1900.0 + 300j, 1500.0 - 200j, 450.0j]),
        mean_drift=np.array([20.0, 0.0, 0.0]), steady=np.zeros(3), ramp=4.0,
    )  # fmt: skip
    body = PlanarBody(
        "unit", model_of(np.random.default_rng(3)), forcing, duration=12.0, points=points, copies={"left": 2}
    )
    if not compiled:
        monkeypatch.setattr(PlanarMarch, "where_possible", lambda *_: None)
    return coupled.simulate_coupled(
        builder.build(),
        {"unit": body},
        duration=10.0,
        output_step=0.05,
        body_step=0.05,
        flow=flow,
        tolerance=1e-8,
    )


_SLOW = [(sea, stiffness) for sea in ("still", "regular", "sheared") for stiffness in (5e3, 4e4)]
_SLOW.remove(("regular", 4e4))


@pytest.mark.parametrize(
    ("sea", "stiffness"), [("regular", 4e4), *(pytest.param(*pair, marks=pytest.mark.slow) for pair in _SLOW)]
)
def test_the_march_takes_the_steps_of_the_joint(monkeypatch: pytest.MonkeyPatch, sea: str, stiffness: float) -> None:
    """Both agree within 1e-8 a step: over 200 steps of snaps 1e-5; the march holds a sheared current for four steps."""
    flow = {
        "still": Flow(),
        "regular": Flow(
            waves=WaveComponents([1.57, 2.1], [0.2, 0.05], [0.3, 2.0], [0.2, -1.0], [0.27, 0.46], WATER),
            ramp=2.0, current=uniform(0.4, 0.0),
        ),
        "sheared": Flow(current=power_law(0.6, 1.0 / 7.0, 0.0, WATER), ramp=2.0),
    }[sea]  # fmt: skip
    marched, joined = (run(monkeypatch, flow, compiled=way, stiffness=stiffness) for way in (True, False))
    assert marched.status == joined.status == "converged"
    assert marched.passes == pytest.approx(joined.passes, rel=0.1)
    assert np.ptp(joined.network.tension_peak) > 0.2 * np.max(joined.network.tension_peak)
    tolerance = 2e-3 if sea == "sheared" else 1e-5
    for name in ("tension_peak", "tension", "position", "work"):
        one, other = getattr(marched.network, name), getattr(joined.network, name)
        assert np.max(np.abs(one - other)) < tolerance * np.max(np.abs(other)), name
    for name in ("position", "rotation", "velocity", "reaction", "point_force", "kinetic_energy"):
        one, other = getattr(marched.bodies["unit"], name), getattr(joined.bodies["unit"], name)
        assert one.shape == other.shape
        assert np.max(np.abs(one - other)) < tolerance * np.max(np.abs(other)), name
    for one, other in zip(marched.checks, joined.checks, strict=True):
        assert one.passed
        assert one.value == pytest.approx(other.value, rel=1e-2, abs=1e-5)
