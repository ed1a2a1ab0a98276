"""Curtain cases: faults with their place and remedy, all at once; from the file to the problem; derived numbers."""
# ruff: noqa: E501  (one fault a line reads best)

from __future__ import annotations

import math
from pathlib import Path

import pytest

from moyai.case.builder import build
from moyai.case.reader import derived_numbers, load_case
from moyai.case.templates import template
from moyai.core.errors import CaseError
from moyai.structures.curtain.impact.cable import closed_form

BASE = """moyai: 1
title: Test curtain
site: {water_depth: 8 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
current: {speed: 0.2 m/s, heading_deg: 10}
waves: {kind: regular, height: 0.5 m, period: 4 s, heading_deg: 20}
structure:
  kind: curtain
  span: 12 m
  length: 13.5 m
  skirt: {length: 4 m, submerged_weight: 3 N/m2, stiffness: 500 kN/m, strength: 100 kN/m}
  toe: {kind: held, weight: 180 N/m}
  cables:
    upper: {axial_stiffness: 400 kN, breaking_load: 90 kN}
    lower: {axial_stiffness: 300 kN}
  floats: {buoyancy: 900 N/m, weight: 90 N/m}
  anchors: {line_length: 25 m, axial_stiffness: 2 MN, holding_force: 80 kN}
  drag: {law: constant, coefficient: 1.3, range: [0.8, 1.4]}
analyses: [statics, impact, waves, anchor_loads, limits]
settings:
  anchor_loads: {energy_factor: 0.2, float_mass: 300 kg}
  safety_factors: {cable: 3, sheet: 4, anchor: 1.5}
"""

# name: (old text, new text, path of the fault, what its message, allowed range or remedy must say)
FAULTS = {
    "shorter than the span": ("length: 13.5 m", "length: 11 m", "structure.length", "takes a shorter curtain as pretension"),
    "skirt longer than the water": ("{length: 4 m, sub", "{length: 8.5 m, sub", "structure.skirt.length", "'may_lie_on_bed: true'"),
    "no stiffness of the skirt": ("stiffness: 500 kN/m", "stiffness: 0 kN/m", "structure.skirt.stiffness", "greater than 0 N/m"),
    "no stiffness of a cable": ("upper: {axial_stiffness: 400 kN", "upper: {axial_stiffness: 0 N", "structure.cables.upper.axial_stiffness", "greater than 0 N"),
    "negative stiffness": ("lower: {axial_stiffness: 300 kN", "lower: {axial_stiffness: -3 N", "structure.cables.lower.axial_stiffness", "greater than 0 N"),
    "inextensible cable in an impact": ("upper: {axial_stiffness: 400 kN", "upper: {axial_stiffness: inextensible", "structure.cables.upper.axial_stiffness", "has no impact tension"),
    "current submerges the floats": ("speed: 0.2 m/s", "speed: 2.5 m/s", "current.speed", "less than"),
    "floats sink in still water": ("buoyancy: 900 N/m", "buoyancy: 250 N/m", "structure.floats.buoyancy", "sinks in still water"),
    "squared velocity of a breaking wave": ("height: 0.5 m, period: 4 s", "height: 0.5 m, period: 1.2 s", "waves.height", "breaking"),
    "no period": ("period: 4 s", "period: 0 s", "waves.period", "greater than 0 s"),
    "no float mass": (", float_mass: 300 kg", "", "settings.anchor_loads.float_mass", "no value follows from the paper"),
    "no anchor loads": ("  anchor_loads: {energy_factor: 0.2, float_mass: 300 kg}\n", "", "analyses", "'float_mass'"),
    "no anchors": ("  anchors: {line_length: 25 m, axial_stiffness: 2 MN, holding_force: 80 kN}\n", "", "analyses", "needs 'structure.anchors'"),
    "waves from behind": ("period: 4 s, heading_deg: 20", "period: 4 s, heading_deg: 120", "waves.heading_deg", "from the other side of the curtain"),
    "angle of the limits": ("settings:\n", "settings:\n  limits: {wave_angle_deg: 100}\n", "settings.limits.wave_angle_deg", "-90 to 90 degrees"),
    "current along the curtain": ("heading_deg: 10", "heading_deg: 90", "current.heading_deg", "less than 90 degrees"),
    "current from behind": ("heading_deg: 10", "heading_deg: 190", "current.heading_deg", "downstream side"),
    "anchor line too short": ("line_length: 25 m", "line_length: 6 m", "structure.anchors.line_length", "more than 8 m"),
    "held toe without cable": ("    lower: {axial_stiffness: 300 kN}\n", "", "structure.toe.kind", "needs 'structure.cables.lower'"),
    "factor below one": ("cable: 3", "cable: 0.5", "settings.safety_factors.cable", "at least 1"),
    "misspelt key": ("coefficient: 1.3", "coeficient: 1.3", "structure.drag.coeficient", "did you mean 'coefficient'?"),
    "misspelt law": ("law: constant", "law: constnat", "structure.drag.law", "did you mean 'constant'?"),
    "misspelt analysis": ("statics, impact, waves", "statics, impacts, waves", "analyses[1]", "did you mean 'impact'?"),
    "analysis twice": ("[statics, impact, waves", "[statics, impact, statics", "analyses", "is given twice"),
    "wrong unit": ("weight: 180 N/m", "weight: 180 N", "structure.toe.weight", "force per length"),
    "both ends of the toe's weight": ("weight: 180 N/m", "weight: 180 N/m, chain_mass: 20 kg/m", "structure.toe.chain_mass", "exclude each other"),
    "density of no chain": ("weight: 180 N/m", "weight: 180 N/m, chain_density: 7000 kg/m3", "structure.toe.chain_density", "'chain_mass' in place of 'weight'"),
    "toe chain that floats": ("weight: 180 N/m", "chain_mass: 20 kg/m, chain_density: 1000 kg/m3", "structure.toe.chain_density", "more than 1025 kg/m3"),
    "range of the drag": ("range: [0.8, 1.4]", "range: [1.2, 1.4]", "structure.drag.range[0]", "at most 1"),
    "skirt that floats": ("submerged_weight: 3 N/m2", "submerged_weight: -60 N/m2", "structure.toe.weight", "the skirt floats"),
    "no weight of the skirt": ("submerged_weight: 3 N/m2, ", "", "structure.skirt", "the weight of the skirt is missing"),
    "mass without density": ("submerged_weight: 3 N/m2", "mass_per_area: 0.9 kg/m2", "structure.skirt.mass_per_area", "'sheet_density'"),
    "unknown catalogue": ("upper: {axial_stiffness: 400 kN", "upper: {catalogue: polyster, diameter: 20 mm", "structure.cables.upper.catalogue", "polyester"),
    "catalogue without diameter": ("upper: {axial_stiffness: 400 kN", "upper: {catalogue: polyester", "structure.cables.upper.catalogue", "diameter"),
    "unknown film": ("stiffness: 500 kN/m", "film: {material: nylon_film, thickness: 1 mm}", "structure.skirt.film.material", "polyethylene_film"),
    "unknown class": ("  drag:", "  curtain_class: E\n  drag:", "structure.curtain_class", "A, B, C, D"),
    "table of drag": ("{law: constant, coefficient: 1.3,", "{law: table, points: [[0.5, 1.4], [0.2, 2]],", "structure.drag.points", "increasing"),
    "blockage of more than all": ("range: [0.8, 1.4]", "blockage: 1.2", "structure.drag.blockage", "less than 1"),
    "statics without current": ("current: {speed: 0.2 m/s, heading_deg: 10}\n", "", "analyses", "'statics' needs 'current'"),
    "current that stands still": ("speed: 0.2 m/s", "speed: 0 m/s", "current", "is zero over"),
    "chord beyond the skirt": ("settings:\n", "settings:\n  impact: {chord: 4.5 m}\n", "settings.impact.chord", "the skirt must bulge"),
    "chord of a balloon": ("settings:\n", "settings:\n  impact: {chord: 2 m}\n", "settings.impact.chord", "less than a half circle"),
    "draught deeper than the water": ("settings:\n", "settings:\n  impact: {draught: 9 m}\n", "settings.impact.draught", "less than 8 m"),
    "two start speeds": ("settings:\n", "settings:\n  impact: {start: current, start_speed: 0.1 m/s}\n", "settings.impact.start_speed", "exclude each other"),
    "release where it is taut": ("settings:\n", "settings:\n  impact: {start: slack_phase, release_position: 5 m}\n", "settings.impact.release_position", "it is taut there"),
    "speeds upside down": ("settings:\n", "settings:\n  limits: {speeds: [0.3, 0.2]}\n", "settings.limits.speeds", "do not rise"),
    "range upside down": ("settings:\n", "settings:\n  limits: {heights: {from: 2 m, to: 1 m, count: 3}}\n", "settings.limits.heights", "not below"),
    "level that is not there": ("settings:\n", "settings:\n  water_levels: [HWL]\n", "settings.water_levels[0]", "there is no water level 'HWL'"),
    "flooded floats lift more": ("weight: 90 N/m", "weight: 90 N/m, flooded_buoyancy: 1000 N/m", "structure.floats.flooded_buoyancy", "flooded <= buoyancy"),
    "pull without a number": ("weight: 180 N/m", "weight: .nan", "structure.toe.weight", "not a finite number"),
    "empty value": ("span: 12 m", "span:", "structure.span", "there is no value"),
}  # fmt: skip


def written(tmp_path: Path, text: str) -> Path:
    file = tmp_path / "curtain.yaml"
    file.write_text(text, encoding="utf-8")
    return file


@pytest.mark.parametrize("name", FAULTS)
def test_fault_is_reported_with_its_place_and_reason(tmp_path, name):
    old, new, path, said = FAULTS[name]
    assert BASE.count(old) == 1, old
    text = BASE.replace(old, new)
    with pytest.raises(CaseError) as error:
        load_case(written(tmp_path, text))
    found = [fault for fault in error.value.faults if fault.path == path]
    assert found, [str(fault) for fault in error.value.faults]
    assert any(said in f"{fault.message} {fault.allowed} {fault.remedy}" for fault in found), [str(f) for f in found]
    key = path.split(".")[-1].split("[")[0]
    line = text.splitlines()[found[0].line - 1] if found[0].line else ""
    # a missing key is reported at its block
    assert key in line or key == "float_mass" or "is missing" in found[0].message, (line, str(found[0]))


def test_all_faults_are_reported_at_once(tmp_path):
    text = (
        BASE.replace("length: 13.5 m", "length: 11 m")
        .replace("{length: 4 m, sub", "{length: 9 m, sub")
        .replace(", float_mass: 300 kg", "")
        .replace("heading_deg: 20", "heading_deg: 130")
        .replace("cable: 3", "cabel: 3")
        .replace("kind: held", "kind: hold")
    )
    with pytest.raises(CaseError) as error:
        load_case(written(tmp_path, text))
    paths = {fault.path for fault in error.value.faults}
    assert {"settings.safety_factors.cabel", "structure.toe.kind"} <= paths
    lines = [fault.line for fault in error.value.faults]
    assert lines == sorted(lines) and all(lines)
    repaired = text.replace("cabel", "cable").replace("kind: hold", "kind: held")
    with pytest.raises(CaseError) as error:
        load_case(written(tmp_path, repaired))
    paths = {fault.path for fault in error.value.faults}
    assert {
        "structure.length",
        "structure.skirt.length",
        "settings.anchor_loads.float_mass",
        "waves.heading_deg",
    } <= paths


def test_drowning_current_says_at_which_speed(tmp_path):
    """The speed that the message allows is the one at which the reserve is nothing, the drag of the floats counted."""
    with pytest.raises(CaseError) as error:
        load_case(written(tmp_path, BASE.replace("speed: 0.2 m/s", "speed: 2.5 m/s")))
    (fault,) = [fault for fault in error.value.faults if fault.path == "current.speed"]
    speed = float(fault.allowed.split("less than ")[1].split(" ")[0])
    from moyai.structures.curtain.assembly import assemble

    for share, drowns in ((0.999, False), (1.001, True)):
        problem = build(load_case(written(tmp_path, BASE)))
        unit = assemble(problem, "SWL", 0.0)
        afloat = unit.site.with_floats(unit.site.statics(unit.hanging, share * speed), share * speed)
        assert (afloat.quantity("float_reserve_ratio") < 0.0) is drowns


def test_a_shorter_curtain_is_pretension_for_the_statics(tmp_path):
    text = BASE.replace("length: 13.5 m", "length: 11.9 m").replace("toe: {kind: held", "toe: {kind: free")
    case = load_case(written(tmp_path, text.replace("statics, impact, waves, anchor_loads, limits", "statics")))
    from moyai.structures.curtain.run import run

    result = run(build(case))
    assert result.status == "converged", result.message
    statics = result.tree["SWL/statics"]
    # the strain of 12 m of 11.9 m alone pulls with EA (12/11.9 - 1), EA of the upper cable where the toe is free
    assert float(statics["cable_tension"].sel(drag_case="given")) > 400e3 * (12.0 / 11.9 - 1.0)


def test_a_long_skirt_may_lie_on_the_bed(tmp_path):
    text = BASE.replace("{length: 4 m, sub", "{length: 8.5 m, sub").replace(
        "  drag:", "  may_lie_on_bed: true\n  drag:"
    )
    case = load_case(written(tmp_path, text))
    assert any("lies on the bed" in fault.message for fault in case.warnings)
    assert build(case).curtain.may_lie_on_bed


def test_a_level_at_which_the_skirt_lies_on_the_bed_may_be_left_out_of_the_dynamic_run(tmp_path):
    text = BASE.replace("{water_depth: 8 m", "{water_depth: 8 m, water_levels: {HW: 0 m, LW: -4.2 m}")
    text = text.replace("  drag:", "  may_lie_on_bed: true\n  drag:").replace(
        "[statics, impact", "[dynamic, statics, impact"
    )
    text = text.replace("settings:\n", "settings:\n  dynamic: {sheet_mass: 1 kg/m2}\n")
    with pytest.raises(CaseError) as caught:
        load_case(written(tmp_path, text))
    assert ["reaches the bed at LW, 3.8 m deep" in fault.message for fault in caught.value.faults] == [True]
    load_case(written(tmp_path, text.replace("settings:\n", "settings:\n  water_levels: [HW]\n")))


def test_units_degrees_and_catalogues_become_numbers(tmp_path):
    text = (
        BASE.replace("weight: 180 N/m", "chain_mass: 20 kg/m")
        .replace("upper: {axial_stiffness: 400 kN", "upper: {catalogue: steel_wire, diameter: 0.5 mm")
        .replace("lower: {axial_stiffness: 300 kN}", "lower: {catalogue: polyester, diameter: 20 mm}")
        .replace(
            "submerged_weight: 3 N/m2, stiffness: 500 kN/m", "film: {material: polyethylene_film, thickness: 0.1 mm}"
        )
        .replace("axial_stiffness: 2 MN, holding", "line_stiffness: 890 kN/m, slope_deg: 30, holding")
        .replace("kind: curtain", "kind: curtain\n  normal_deg: 15")
    )
    curtain = build(load_case(written(tmp_path, text))).curtain
    assert curtain.skirt.toe_load == pytest.approx(20.0 * 9.81 * (1.0 - 1025.0 / 7850.0))
    assert curtain.toe_chain == 20.0
    denser = build(
        load_case(
            written(tmp_path, text.replace("chain_mass: 20 kg/m", "chain_mass: 20 kg/m, chain_density: 7000 kg/m3"))
        )
    )
    assert denser.curtain.skirt.toe_load == pytest.approx(20.0 * 9.81 * (1.0 - 1025.0 / 7000.0))
    assert curtain.upper_stiffness == pytest.approx(2e11 * math.pi / 4 * 0.5e-3**2)
    assert curtain.lower_stiffness > 0.0 and math.isfinite(curtain.strengths.lower_cable.capacity)
    assert curtain.skirt.stiffness == pytest.approx(0.5 * (2e8 + 1e9) * 1e-4)
    assert curtain.skirt.submerged_weight == pytest.approx((930.0 - 1025.0) * 9.81 * 1e-4)
    assert curtain.normal == pytest.approx(math.radians(15.0))
    assert curtain.anchors is not None and curtain.anchors.stiffness == 890e3
    assert curtain.anchors.slope_in(8.0) == pytest.approx(math.radians(30.0))


def test_a_given_blockage_spreads_the_coefficient(tmp_path):
    text = BASE.replace(
        "{law: constant, coefficient: 1.3, range: [0.8, 1.4]}",
        "{law: gap_speed, coefficient: 1.3, range: [0.9, 1.2], blockage: [0.2, 0.3, 0.5]}",
    )
    drag = build(load_case(written(tmp_path, text))).curtain.drag
    assert drag.coefficient(0.7) == pytest.approx(1.3 / 0.7**2, rel=1e-4)
    assert drag.range[0] == pytest.approx(0.9 * 0.7**2 / 0.8**2, rel=1e-4)
    assert drag.range[1] == pytest.approx(1.2 * 0.7**2 / 0.5**2, rel=1e-4)


def test_derived_numbers(tmp_path):
    case = load_case(written(tmp_path, BASE.replace("settings:\n", "settings:\n  impact: {time_step: 2 ms}\n")))
    numbers = {number.label: number.value for number in derived_numbers(case)}
    problem = build(case)
    from moyai.structures.curtain.analyses.impact import impact_of
    from moyai.structures.curtain.assembly import assemble

    unit = assemble(problem, "SWL", 0.0)
    assert numbers["span ratio R = B/l"] == pytest.approx(12.0 / 13.5)
    assert numbers["depth ratio h/d"] == 2.0
    assert numbers["speed along the normal, mean over the skirt"] == pytest.approx(0.2 * math.cos(math.radians(10.0)))
    impact = impact_of(unit, problem.settings.impact, unit.normal_speed)
    assert numbers["marching step omega dt"] == pytest.approx(0.5 * math.pi * 2e-3 / closed_form(impact).time)
    assert numbers["Cauchy number C_E"] == pytest.approx(math.sqrt(700e3 / 1025.0) / (8.0 * math.sqrt(9.81 * 8.0)))
    assert numbers["added mass 2 rho d^2/pi"] == pytest.approx(2.0 * 1025.0 * 16.0 / math.pi)
    assert numbers["Froude number U/sqrt(gh)"] == pytest.approx(unit.normal_speed / math.sqrt(9.81 * 8.0))


def test_template_and_examples_are_sound(tmp_path):
    case = load_case(written(tmp_path, template("curtain")))
    assert case.kind == "curtain"
    root = Path(__file__).parents[3]
    files = sorted((root / "examples" / "curtain").glob("*.yaml"))
    files += [root / "src/moyai/reproduce/cases" / name for name in ("sawaragi/flume.yaml", "tabata/kansai.yaml")]
    assert len(files) == 4
    for file in files:
        assert load_case(file).kind == "curtain"


def test_figures_that_change_nothing_are_reported(tmp_path):
    text = BASE.replace("range: [0.8, 1.4]}", "range: [0.8, 1.4], blockage: [0.2, 0.3, 0.5]}")
    text = text.replace(
        "upper: {axial_stiffness: 400 kN, breaking_load: 90 kN}", "upper: {catalogue: polyester, diameter: 20 mm}"
    )
    text = text.replace("{cable: 3, sheet: 4, anchor: 1.5}", "{sheet: 4, anchor: 1.5}")
    (tmp_path / "case.yaml").write_text(text, encoding="utf-8")
    reported = {fault.path: fault for fault in load_case(tmp_path / "case.yaml").warnings}
    assert "change nothing" in reported["structure.drag.blockage"].message


def test_a_strength_without_a_factor_is_judged_by_the_default_which_is_said(tmp_path):
    text = BASE.replace("{cable: 3, sheet: 4, anchor: 1.5}", "{cable: 2, anchor: 1.5}")
    (tmp_path / "case.yaml").write_text(text, encoding="utf-8")
    problem = build(load_case(tmp_path / "case.yaml"))
    by_name = {criterion.name: criterion for criterion in problem.criteria}
    assert problem.curtain.strengths.sheet.safety_factor == 4.0
    assert by_name["fabric_safety_factor"].assumed and "default" in by_name["fabric_safety_factor"].source
    assert by_name["cable_safety_factor"].limit == 0.5 and by_name["cable_safety_factor"].source == "case file"


@pytest.mark.parametrize(
    ("header", "words"),
    [
        ("time [s],upper [m],lower [N]", "'upper': 'm' is no unit of a force"),
        ("time [s],upper [N],lower [kg]", "'lower': 'kg' is no unit of a force"),
        ("time [m],upper [N],lower [N]", "'time': 'm' is no unit of a time"),
    ],
)
def test_record_in_units_of_something_else(tmp_path, header, words):
    rows = "\n".join(f"{0.05 * n:.2f},0,0" for n in range(100))
    (tmp_path / "snap.csv").write_text(f"{header}\n{rows}\n", encoding="utf-8")
    text = BASE + "record: {file: snap.csv, lower: lower, unloaded: [[0 s, 1 s]]}\n"
    (tmp_path / "case.yaml").write_text(text, encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        load_case(tmp_path / "case.yaml")
    assert words in str(caught.value)


def test_record_with_one_column_twice(tmp_path):
    (tmp_path / "snap.csv").write_text("time,upper\n0,0\n", encoding="utf-8")
    text = BASE + "record: {file: snap.csv, lower: upper, unloaded: [[0 s, 1 s]]}\n"
    (tmp_path / "case.yaml").write_text(text, encoding="utf-8")
    with pytest.raises(CaseError, match="named twice"):
        load_case(tmp_path / "case.yaml")
