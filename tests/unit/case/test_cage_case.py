# ruff: noqa: E501 - lines of the template are quoted as they stand
"""Case files of rigid cages: examples and template are sound, each slip gives one clear message with its place."""

import math
from pathlib import Path

import numpy as np
import pytest

from moyai.case.builder import build
from moyai.case.reader import case_of, derived_numbers, load_case
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import CaseError
from moyai.core.results import read_result
from moyai.structures.cage.run import run

ROOT = Path(__file__).resolve().parents[3]
BASE = template("rigid_cage")


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


MESH = "aperture: 2.09 mm                     # or mesh_pitch (twine to twine), or solidity"
FLOATS = "floats: {diameter: 4.01 cm, mass: 6.04 g, per_side: 3}"
PULL = "pull_down: 10 mm"
WEIGHT = "weight: {mass: 291 g, floats_included: false}"
FRAME = "    # density: 7850 kg/m3                 # or mass"
HEADING = "heading_deg: 0                        # 0 or 180"
SLIPS = {
    "misspelt key": (("kinematic_viscosity:", "viscosity:"), "did you mean 'kinematic_viscosity'?"),
    "model": (("model: rigid", "model: ridgid"), "ridgid"),
    "solidity above one": ((MESH, "solidity: 1.2"), "less than 1"),
    "solidity in per cent": (("solidity_listed: 0.355", "solidity_listed: 35.5"), "less than 1"),
    "no solidity": ((MESH, "solidity: 0"), "greater than 0"),
    "two meshes": ((MESH, "aperture: 2 mm\n    solidity: 0.3"), "exclude each other"),
    "closed mesh": ((MESH, "mesh_pitch: 0.4 mm"), "close meshes"),
    "law": (("law: matsubara", "law: matsubra"), "did you mean 'matsubara'?"),
    "law option": (("{law: matsubara}", "{law: loland, solidity: listed}"), "is for one solidity"),
    "sinks": ((FLOATS, "floats: {diameter: 2 cm, mass: 6.04 g, per_side: 3}"), "does not float"),
    "too few floats": ((FLOATS, "floats: {diameter: 4.01 cm, mass: 6.04 g, per_side: 2}"), "it takes 10 such floats"),
    "floats of a ring": (("per_side: 3}", "count: 12}"), "floats of a box are counted by side"),
    "weight with floats": ((WEIGHT, "weight: {mass: 72.5 g, floats_included: true}"), "parts weigh"),
    "weight of the floats": (
        (WEIGHT, "weight: {mass: 72.5 g, floats_included: false}"),
        "72.5 g is the mass of the floats alone",
    ),
    "contradictory weight": (
        (FRAME, "    density: 7850 kg/m3                 # or mass"),
        (WEIGHT, "weight: {mass: 291 g, floats_included: true}"),
        "set 'floats_included: false'",
    ),
    "other contradiction": (
        (FRAME, "    density: 7850 kg/m3                 # or mass"),
        (WEIGHT, "weight: {mass: 363 g, floats_included: false}"),
        "set 'floats_included: true'",
    ),
    "no frame mass": ((WEIGHT, "# "), "the mass of the frame is not known"),
    "short line": ((PULL, "length: 20 cm"), "cannot reach"),
    "pretension": ((PULL, "pretension: 200 gf"), "the buoyancy of its floats"),
    "two settings": ((PULL, "pull_down: 10 mm\n    slack: 1 cm"), "exclude each other"),
    "no setting": ((PULL, "# "), "is missing"),
    "stretchy line": (("stiffness: 2 kN/m ", "stiffness: 0.1 N/m "), "stretches by more"),
    "anchor above water": (("pull_down: 10 mm", "anchor_above_bed: 60 cm\n    pull_down: 10 mm"), "over the surface"),
    "oblique waves": ((HEADING, "heading_deg: 30                        # 0 or 180"), "plane of the waves"),
    "breaking wave": (("height: 3 cm  ", "height: 30 cm "), "breaking height"),
    "steep sea": (("height: 3 cm  ", "height: -3 cm "), "out of range"),
    "infinite depth": (("water_depth: 45 cm", "water_depth: infinite"), "need a bed"),
    "shallow": (("water_depth: 45 cm", "water_depth: 15 cm"), "under the bed"),
    "analysis": (("analyses: [statics, time,", "analyses: [statics, tme,"), "tme"),
    "too few periods": (
        ("# settings:\n#   rigid: {periods: 40, settled_periods: 20,", "settings:\n  rigid: {periods: 10, settled_periods: 20,"),
        "exceed the 10 periods",
    ),
    "one stiffness": (("# settings:\n#   rigid: {", "settings:\n  rigid: {stiffnesses: [1 kN/m]} # {"), "at least 2"),
    "oblique current": (("# current: {speed: 0.05 m/s, heading_deg: 0}", "current: {speed: 0.05 m/s, heading_deg: 90}"), "along x"),
}  # fmt: skip


def test_a_misspelt_mooring_is_not_also_called_missing():
    found = faults(("kind: crossed_top", "kind: crossed_bottom"))
    assert len(found) == 1 and "crossed_bottom" in found[0]


def test_reynolds_number_counts_the_current():
    """Twine of 5 mm: Re = 413 by the waves alone, 1900 with a current of 0.34 m/s; 1800 is the largest that was towed."""
    net = (("twine_diameter: 0.45 mm", "twine_diameter: 5 mm"), (MESH, "mesh_pitch: 44 mm"), (PULL, "length: 3 m"))
    assert not any("above 1800" in str(fault) for fault in case(*net).warnings)
    flow = ("# current: {speed: 0.05 m/s, heading_deg: 0}", "current: {speed: 0.34 m/s, heading_deg: 0}")
    found = case(*net, flow)
    assert any("above 1800" in str(fault) for fault in found.warnings), found.warnings


@pytest.mark.parametrize("slip", SLIPS)
def test_each_slip_gives_its_message(slip):
    *changes, wanted = SLIPS[slip]
    found = faults(*changes)
    assert any(wanted in fault for fault in found), found
    assert len(found) <= 2
    assert all("case.yaml:" in fault for fault in found)


def test_examples_and_template_are_sound():
    for name in ("taut", "slack"):
        loaded = load_case(ROOT / "src" / "moyai" / "reproduce" / "cases" / "matsubara" / f"{name}.yaml")
        assert {number.label for number in derived_numbers(loaded)} >= {"mass in air", "natural period 1"}
    numbers = {number.label: number.value for number in derived_numbers(case())}
    assert numbers["middle of the cage, floating freely"] == pytest.approx(-0.109, abs=1e-3)
    assert numbers["floats in water, floating freely"] == pytest.approx(80.6, abs=0.5)


def test_reynolds_outside_the_law_and_odd_viscosity_warn_with_the_number():
    found = case(("1.14e-6 m2/s", "1.14e-5 m2/s"))
    words = [str(fault) for fault in found.warnings]
    assert any("below 84" in word for word in words)
    assert any("is not the kinematic viscosity of water" in word for word in words)
    drowned = case((PULL, "pull_down: 20 mm"))
    assert any("wholly under water" in str(fault) for fault in drowned.warnings)


@pytest.mark.parametrize("shape", [pytest.param(s, marks=pytest.mark.slow) for s in ("box", "cylinder")])
def test_other_shapes_lines_seas_and_levels_run(shape, tmp_path):
    """Own lines with weight, a sinker, a current, an irregular sea, two levels, Wheeler, another law."""
    changes = [
        ("# water_levels: {HWL: 5 cm, LWL: 0 m} ", "water_levels: {HWL: 1 cm, LWL: 0 m} "),
        ("periods: [1.0, 1.2, 1.5] ", "periods: [1.2] "),
        (
            "  # - {name: sea, kind: jonswap, significant_height: 2 cm, peak_period: 1.2 s, peak_enhancement: 3.3, heading_deg: 0,\n"
            "  #    duration: 2 min, seed: 1}",
            "  - {name: sea, kind: jonswap, significant_height: 2 cm, peak_period: 1.2 s, peak_enhancement: 3.3, heading_deg: 0,\n"
            "     duration: 4 s, seed: 1}",
        ),
        ("# current: {speed: 0.05 m/s", "current: {speed: 0.02 m/s"),
        ("law: matsubara", "law: kristiansen_faltinsen"),
        ("# sinkers: [{z: -10 cm, mass: 50 g, volume: 6.4 cm3}]", "sinkers: {z: -10 cm, mass: 30 g, volume: 4 cm3}"),
        ("  mooring:\n    kind: crossed_top                     # or outward_bottom, outward_middle, outward_top, lines (your own)\n"
         "    anchor_distance: 30 cm\n    pull_down: 10 mm                      # or pretension: 60 gf, slack: 3 cm, length: 59 cm\n"
         "    stiffness: 2 kN/m                     # or axial_stiffness: EA with gauge_stiffness\n",
         "  mooring:\n    kind: lines\n    lines:\n"
         "      - {name: west, attachment: {x: -10 cm, z: 10 cm}, anchor: {x: -60 cm}, slack: 5 mm, axial_stiffness: 1 kN, gauge_stiffness: 5 kN/m, submerged_weight: 0.01 N/m, breaking_load: 40 N}\n"
         "      - {name: east, attachment: {x: 10 cm, z: 10 cm}, anchor: {x: 60 cm}, slack: 5 mm, stiffness: 1 kN/m, damping: 1 N s/m}\n"),
        ("# settings:\n#   rigid: {periods: 40, settled_periods: 20, stretching: wheeler, stiffnesses: [1 kN/m, 3 kN/m, 10 kN/m]}",
         "settings:\n  rigid: {periods: 8, settled_periods: 3, stretching: wheeler, patches: 2, tolerance: 1e-4, stiffness_factors: [1, 3]}"),
    ]  # fmt: skip
    if shape == "cylinder":
        changes += [
            ("shape: {kind: box, length: 20 cm, width: 20 cm, height: 20 cm}   # or {kind: cylinder, diameter: , height: }",
             "shape: {kind: cylinder, diameter: 20 cm, height: 20 cm}"),
            ("per_side: 3}", "count: 14}"),
            ("weight: {mass: 291 g", "weight: {mass: 260 g"),
        ]  # fmt: skip
    problem = build(case(*changes))
    result = run(problem)
    assert result.status == "converged", result.message
    assert all(check.passed for check in result.checks)
    level = result.tree["LWL"]
    sea = level["waves/sea"].to_dataset()
    assert float(sea["deviation"].sel(mode="heave")[0]) == pytest.approx(0.005, rel=0.5)
    # in a random sea ranges are four deviations over the significant height
    assert float(sea["range_ratio"].sel(translation="heave")[0]) == pytest.approx(
        4.0 * float(sea["deviation"].sel(mode="heave")[0]) / 0.02, rel=1e-12
    )
    assert float(sea["range_ratio"].sel(translation="heave")[0]) > 0.5
    run_of = level["time/regular/wave 1"].to_dataset()
    pull = run_of["tension"].sel(line="west")
    taut = pull.sel(end="cage") > 0.05
    gap = (pull.sel(end="cage") - pull.sel(end="anchor")).values[taut.values]
    assert taut.any() and np.all(gap > 0.002) and np.all(gap < 0.006)
    assert "varied_stiffness" in level["sensitivity/regular"].to_dataset().coords
    # the tide lifts the cage on lines of the same length
    statics = [result.tree[f"{name}/statics"].to_dataset() for name in ("LWL", "HWL")]
    assert float(statics[1]["tension_at_rest"].sum()) > float(statics[0]["tension_at_rest"].sum())
    kept = read_result(result.write(tmp_path / "r.nc"))
    assert kept.tree.attrs["cage_model"] == "rigid"
    from moyai.report.writer import write_report

    files = write_report(kept, tmp_path / "report")
    assert files[0].stat().st_size > 1e5


def test_without_lines_or_waves_the_cage_floats():
    text = BASE[: BASE.index("  mooring:")] + "analyses: [statics, time]\n"
    text = text.replace("periods: [1.0, 1.2, 1.5] ", "periods: [1.5] ")
    text += "settings: {rigid: {periods: 10, settled_periods: 4}}\n"
    result = run(build(case_of(parse_yaml(text, "case.yaml"), Path("case.yaml"))))
    ranges = result.tree["SWL/waves/regular"].to_dataset()["range_ratio"].values[0]
    assert ranges[1] == pytest.approx(1.0, abs=0.05) and 1.0 < ranges[0] < 1.35
    only = (
        text[: text.index("\nwaves:")] + "\n" + text[text.index("# current") :].replace("[statics, time]", "[statics]")
    )
    rest = run(build(case_of(parse_yaml(only, "case.yaml"), Path("case.yaml"))))
    assert set(rest.tree["SWL"].children) == {"cage", "statics"}
    assert math.isinf(float(rest.tree["SWL/statics"].to_dataset()["natural_period"].max()))


def test_literal_equations_run_with_a_warning():
    changed = case(
        ("# equations: literal ", "equations: literal "),
        ("periods: [1.0, 1.2, 1.5] ", "periods: [1.2] "),
        ("analyses: [statics, time, sensitivity]", "analyses: [time]"),
        ("# settings:\n#   rigid: {periods: 40, settled_periods: 20,", "settings:\n  rigid: {periods: 8, settled_periods: 2, tolerance: 1e-5,"),
    )  # fmt: skip
    result = run(build(changed))
    assert any(notice.code == "literal-equations" for notice in result.notices)
