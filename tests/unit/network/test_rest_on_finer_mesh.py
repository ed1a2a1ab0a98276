"""A run from rest whose mesh is halved starts from the rest of the finer mesh, without a jolt."""

import pytest

import moyai

CASE = """
moyai: 1
title: Chain that nothing moves
site: {water_depth: 50 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
structure:
  kind: network
  bed: {stiffness: 3e6 Pa/m, damping: 3e5 Pa s/m}
  line_types:
    chain: {diameter: 0.1 m, mass: 50 kg/m, axial_stiffness: 1e8 N, damping_ratio: 0.8, drag_normal: 2,
            drag_tangential: 0.8, added_mass_normal: 0.8}
  points:
    anchor: {kind: fixed, position: [60 m, 0, bed]}
    top: {kind: fixed, position: [5 m, 0, -40 m]}
  lines:
    mooring: {start: anchor, end: top, type: chain, length: 58 m, segments: 15}
analyses: [statics, dynamic]
settings: {start: rest, duration: 2 s, output_step: 0.1 s, SETTING}
"""


def _tension_at_rest(folder, segments):
    text = CASE.replace("segments: 15", f"segments: {segments}").replace("[statics, dynamic]", "[statics]")
    (folder / "rest.yaml").write_text(text[: text.index("settings:")])
    statics = moyai.run(folder / "rest.yaml").tree["SWL/statics"].to_dataset()
    return float(statics["line_tension_maximum"][0, 0])


@pytest.mark.parametrize("setting", ["mesh_check: auto", "sensitivity: true"])
def test_the_peak_of_a_chain_at_rest_is_that_of_statics_on_every_mesh(tmp_path, setting):
    (tmp_path / "case.yaml").write_text(CASE.replace("SETTING", setting))
    result = moyai.run(tmp_path / "case.yaml")
    found = result.tree["SWL/dynamic"].to_dataset()
    assert float(found["sensitivity_peak"][0]) == pytest.approx(_tension_at_rest(tmp_path, 15), rel=1e-3)
    assert float(found["double_mesh"][0]) == pytest.approx(_tension_at_rest(tmp_path, 30), rel=1e-3)
    assert result.status == "converged", result.message
