"""Case files of flexible cages: examples are sound and run, each slip gives one clear message with its place."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from moyai.case.builder import build
from moyai.case.reader import case_of, derived_numbers, load_case
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import CaseError
from moyai.core.results import read_result
from moyai.report.writer import write_report
from moyai.structures.cage.report.page import compose
from moyai.structures.cage.run import run

ROOT = Path(__file__).resolve().parents[3]
BASE = """
moyai: 1
title: Small cage
site: {water_depth: 30 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
current: {speed: 0.4 m/s, heading_deg: 0}
waves: {kind: regular, height: 1 m, period: 5 s, heading_deg: 20}
structure:
  kind: cage
  model: flexible
  kinematic_viscosity: 1.3e-6 m2/s
  shape: circular
  size: 20 m
  collar:
    pipe: {diameter: 350 mm, wall_thickness: 20 mm, density: 955 kg/m3, youngs_modulus: 0.9 GPa, extra_mass: 5 kg/m}
  net:
    twine_diameter: 2.5 mm
    mesh_pitch: 22.5 mm
    density: 1140 kg/m3
    youngs_modulus: 1 GPa
    wall_depth: 8 m
    bottom: flat
    law: loland
    wake: loland
  sinkers: {count: 8, mass: 120 kg, density: 7850 kg/m3}
  mooring:
    kind: grid
    bay: 34 m
    frame_depth: 5 m
    frame_rope: {catalogue: polyester, diameter: 52 mm}
    buoys: {diameter: 1.2 m, mass: 100 kg}
    bridle: {catalogue: nylon, diameter: 48 mm}
    anchor_line:
      - {catalogue: polyester, diameter: 52 mm, length: 70 m}
      - {catalogue: studless_chain_U3, diameter: 36 mm, length: 20 m}
    anchor_distance: 85 m
  mesh: {around: 16, down: 3, bottom: 2}
analyses: [statics, time]
settings:
  flexible: {current_speeds: [0.2 m/s], periods: 2, ramp_periods: 1}
"""


def case(*changes):
    text = BASE
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new, 1)
    return case_of(parse_yaml(text, "case.yaml"), Path("case.yaml"))


def faults(*changes):
    with pytest.raises(CaseError) as caught:
        case(*changes)
    return [str(fault) for fault in caught.value.faults]


PIPE = "diameter: 350 mm, wall_thickness: 20 mm"
SLIPS = {
    "solidity above one": (("mesh_pitch: 22.5 mm", "solidity: 1.2"), "less than 1"),
    "closed meshes": (("mesh_pitch: 22.5 mm", "mesh_pitch: 2 mm"), "close meshes"),
    "law": (("law: loland", "law: lolland"), "did you mean 'loland'?"),
    "wake": (("wake: loland", "wake: loeland"), "none, loland, cheng"),
    "misspelt key": (("wall_depth:", "wall_hight:"), "wall_depth"),
    "does not float": (("count: 8, mass: 120 kg", "count: 8, mass: 4 t"), "does not float"),
    "heavy collar": (("extra_mass: 5 kg/m", "extra_mass: 200 kg/m"), "weigh"),
    "thick wall": ((PIPE, "diameter: 350 mm, wall_thickness: 200 mm"), "does not fit"),
    "no density of sinkers": ((", density: 7850 kg/m3", ""), "density"),
    "narrow bay": (("bay: 34 m", "bay: 19 m"), "bay of 19 m"),
    "deep frame": (("frame_depth: 5 m", "frame_depth: 31 m"), "frame lies 31 m deep"),
    "lines that cannot reach": (("anchor_distance: 85 m", "anchor_distance: 140 m"), "cannot reach"),
    "slack lines": (("anchor_distance: 85 m", "anchor_distance: 50 m"), "slack"),
    "short bridles": (("    bridle: {", "    bridle_length: 2 m\n    bridle: {"), "bridles of 2 m cannot reach"),
    "unknown rope": (("{catalogue: nylon", "{catalogue: nylonn"), "nylon"),
    "rope without mass": (("{catalogue: nylon, diameter: 48 mm}", "{diameter: 48 mm, axial_stiffness: 1 MN}"), "mass"),
    "cone without depth": (("bottom: flat", "bottom: cone"), "cone_depth"),
    "deep net": (("wall_depth: 8 m", "wall_depth: 35 m"), "water of 30 m"),
    "odd mesh": (("around: 16", "around: 18"), "multiple of 4"),
    "growth that closes": (("wake: loland", "wake: loland\n    growth: {diameter_factor: 20}"), "closes the meshes"),
    "time without waves": (("waves: {kind: regular, height: 1 m, period: 5 s, heading_deg: 20}\n", ""), "needs waves"),
    "speeds without current": (("current: {speed: 0.4 m/s, heading_deg: 0}\n", ""), "current"),
    "floating without collar": (("  collar:\n    pipe: {" + PIPE, "  xcollar:\n    pipe: {" + PIPE), "collar"),
}  # fmt: skip


@pytest.mark.parametrize("name", SLIPS)
def test_each_slip_gives_one_clear_message(name):
    change, words = SLIPS[name]
    found = faults(change)
    assert any(words in fault for fault in found), found
    assert len(found) <= 2, found


@pytest.mark.parametrize("rope", ("bridle", "frame_rope"))
def test_a_rope_is_found_by_its_own_key(rope):
    """A mistake in a rope is reported at that rope, whatever the catalogue calls it."""
    start = BASE.index(f"    {rope}: {{catalogue: ") + len(f"    {rope}: {{catalogue: ")
    known = BASE[start : BASE.index(",", start)]
    (fault,) = faults((f"{rope}: {{catalogue: {known}", f"{rope}: {{catalogue: {known}x"))
    assert f"structure.mooring.{rope}.catalogue" in fault


def test_weights_of_one_mass_are_alike_however_they_are_reported():
    """A mass in air and its weight in water give the same sinkers, with the water that they drag along."""
    reported = build(case()).cage.design.sinkers
    submerged = (reported.mass - 1025.0 * reported.volume) * 9.81
    same = build(case(("mass: 120 kg", f"submerged_weight: {submerged!r} N"))).cage.design.sinkers
    for key in ("mass", "volume", "added_mass"):
        assert getattr(same, key) == pytest.approx(getattr(reported, key), rel=1e-12)
    assert reported.added_mass > 0.0


def test_an_infinite_depth_is_refused():
    assert any("bed" in fault for fault in faults(("water_depth: 30 m", "water_depth: infinite")))


def test_examples_are_sound():
    for name in ("circular_50m", "grid_2x2", "flume_cage"):
        loaded = load_case(ROOT / "examples" / "cage" / f"{name}.yaml")
        problem = build(loaded)
        assert problem.model == "flexible"
        numbers = {(number.group, number.label) for number in derived_numbers(loaded)}
        assert ("Cage", "volume inside the net") in numbers
    assert len(build(load_case(ROOT / "examples" / "cage" / "grid_2x2.yaml")).cage.centres) == 4


def test_growth_and_own_ropes_reach_the_model():
    fouled = case(("wake: loland", "wake: loland\n    growth: {standard: ns9415}"))
    assert [item.path for item in fouled.warnings if "was not read in its source" in item.message]
    model = build(fouled).cage
    net = model.design.net
    assert net.net.twine_diameter == pytest.approx(1.5 * 0.0025) and net.clean_diameter == 0.0025
    own = "{diameter: 48 mm, axial_stiffness: 1 MN, mass: 1.4 kg/m, breaking_load: 400 kN}"
    rope = build(case(("{catalogue: nylon, diameter: 48 mm}", own))).cage.mooring.bridle_rope
    assert rope.axial_stiffness == 1e6 and rope.breaking_load == 4e5


@pytest.mark.slow
def test_a_case_runs_to_its_report(tmp_path):
    result = run(build(case()))
    assert result.status == "converged", result.message
    statics = result.tree["SWL/statics"].ds
    assert statics["current_speed"].values.tolist() == [0.0, 0.2, 0.4]
    share = statics["volume_share"].values[:, 0]
    assert share[0] == pytest.approx(1.0, abs=0.1) and share[0] > share[1] > share[2] > 0.5
    assert float(statics["total_drag"][2]) > 3.0 * float(statics["total_drag"][1])
    # the worst of all currents stands over labels alone: a study keeps it
    for name, key in (
        ("line_tension_maximum", "line_tension_maximum"),
        ("anchor_tension", "anchor_tension"),
        ("collar_stress", "collar_stress_largest"),
    ):
        worst = statics[f"worst_{name}"]
        assert "current" not in worst.dims and worst.dims[0] in statics.coords
        assert np.array_equal(worst.values, statics[key].values.max(axis=0))
    assert float(statics["worst_volume_share"][0]) == share.min()
    assert float(statics["worst_drag"]) == float(statics["total_drag"].max())
    sea = result.tree["SWL/time/regular/wave 1"].ds
    assert np.isfinite(sea["line_tension"].values).all() and float(sea["line_tension_maximum"].max()) > 1e3
    for group in (statics, sea, result.tree["SWL/cage"].ds):
        for name in group.data_vars:
            assert "units" in group[name].attrs or name.endswith("_node"), name
    path = result.write(tmp_path / "results.nc")
    document = compose(read_result(path))
    titles = {section.title for section in document.sections}
    assert {"Summary", "Shape at rest", "Drag and loads at rest", "Collar", "In waves", "The cage"} <= titles
    page = write_report(read_result(path), tmp_path / "page")
    text = Path(page if isinstance(page, (str, Path)) else page[0]).read_text(encoding="utf-8")
    assert re.search("Remaining volume against current", text)


@pytest.mark.slow
def test_sensitivity_gives_the_uncertainty_of_peaks():
    found = run(build(case(("analyses: [statics, time]", "analyses: [sensitivity]"), ("periods: 2", "periods: 1"))))
    table = found.tree["SWL/sensitivity/regular"].ds
    values = table["value"].values
    assert values.shape[0] == 4 and np.isfinite(values).all()
    anchor = list(table["quantity"].values).index("highest tension, anchor [N]")
    # half the step hardly matters
    assert values[1, anchor] == pytest.approx(values[0, anchor], rel=0.02)


def test_the_template_is_sound():
    loaded = case_of(parse_yaml(template("cage"), "case.yaml"), Path("case.yaml"))
    assert build(loaded).model == "flexible"
