"""A breakwater on light taut lines in motion, in small waves, against its linear motions with the lines' stiffness."""

import math
import textwrap

import numpy as np
import pytest

import moyai

CASE = """
moyai: 1
title: box on elastic lines in small waves
site: {{water_depth: 38 cm, density: 1000 kg/m3, gravity: 9.81 m/s2}}
waves: {{kind: regular, name: one, height: 1 mm, periods: [{period}], heading_deg: 0}}
structure:
  kind: breakwater
  length: 98.6 cm
  section: {{shape: rectangle, beam: 38 cm, height: 17 cm}}
  draught: 11.3 cm
  centre_of_gravity_above_keel: 8.6 cm
  roll_gyradius: 10.1 cm
  damping: {{fraction_of_critical: 0.15, modes: [sway, heave, roll]}}
lines:
  - {{name: seaward, count: 2, dynamic: true, fairlead: {{x: -19 cm, above_keel: 0 m}}, anchor: {{x: -211.5 cm}},
     segments: [{rope}]}}
  - {{name: shoreward, count: 2, dynamic: true, fairlead: {{x: 19 cm, above_keel: 0 m}}, anchor: {{x: 211.5 cm}},
     segments: [{rope}]}}
analyses: [frequency, time]
settings:
  drift: false
  time: {{lines: {{bars: 8}}, analysed_periods: 3, duration: {duration}, ramp: {ramp}}}
"""
ROPE = (
    "{{length: 193.5 cm, submerged_mass: 0.0004 kg/m, mass: 0.0052 kg/m, axial_stiffness: {stiffness} N, "
    "diameter: 2.3 mm, drag_normal: 1.2, drag_tangential: 0.02, added_mass_normal: 1.0}}"
)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_small_waves_give_the_linear_motions_with_their_phase(tmp_path, seed) -> None:
    """Amplitude and phase of sway, heave and roll at a random period with lines of random stiffness.

    The lines are light (40 g in all, the body 42 kg) so that their own inertia is small, and stiff enough to matter:
    without them sway differs by a tenth and more in the longer waves.
    """
    random = np.random.default_rng(seed)
    period, stiffness = random.uniform(0.9, 2.2), random.uniform(30.0, 90.0)
    path = tmp_path / "case.yaml"
    text = textwrap.dedent(CASE).format(
        period=f"{period:.4f}", rope=ROPE.format(stiffness=f"{stiffness:.3f}"), duration=f"{30 * period:.3f} s",
        ramp=f"{4 * period:.3f} s",
    )  # fmt: skip
    path.write_text(text, encoding="utf-8")
    result = moyai.run(moyai.load_case(path))
    assert result.status == "converged", result.message
    exact = result.tree["/SWL/frequency/one"]["rao"].values.reshape(-1)
    run = next(name for name in result.tree.groups if name.startswith("/SWL/time/one/T") and name.count("/") == 4)
    series = result.tree[run].to_dataset()
    assert float(series["tension"].min()) > 0.0
    time = series["time"].values
    late, omega = time > time[-1] - 8.0 * period, 2.0 * math.pi / round(period, 4)
    basis = np.column_stack([np.cos(omega * time[late]), np.sin(omega * time[late]), np.ones(late.sum())])
    cosine, sine, _ = np.linalg.lstsq(basis, series["position"].values[late], rcond=None)[0]
    found = (cosine + 1j * sine) / 0.5e-3
    assert np.all(np.abs(found - exact) < 0.01 * np.abs(exact))
