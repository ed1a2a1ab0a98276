"""Mistakes that once passed `moyai check` in silence, or with words on another key: each is reported at its place."""
# ruff: noqa: E501  (one slip a line reads best)

from pathlib import Path

import pytest
from case_files import CASE

from moyai.case.reader import case_of
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import CaseError

ROPE = "{diameter: 40 mm, mass: 2 kg/m, axial_stiffness: 2 MN, damping_ratio: 0.1, drag_normal: 1.2, drag_tangential: 0.05, added_mass_normal: 1}"
HUNG = f"""moyai: 1
title: Weight under a barge
site: {{water_depth: 40 m, density: 1025 kg/m3, gravity: 9.81 m/s2}}
structure:
  kind: network
  motions: {{barge: {{kind: harmonic, amplitude: [0, 0, 1 m], period: 5 s, ramp: 5 s}}}}
  line_types: {{wire: {ROPE}}}
  points:
    top: {{kind: driven, motion: barge, position: [0, 0, 2 m]}}
    block: {{kind: free, position: [0, 0, -23 m], mass: 3 t, volume: 1.25 m3, drag_area: 1.9 m2, added_mass_coefficient: 1}}
  lines: {{wire: {{start: top, end: block, type: wire, length: 25 m, segments: 10}}}}
analyses: [statics, dynamic]
settings: {{start: rest, skip: 15 s, duration: 60 s}}
"""
BASES = {
    "pontoon": CASE,
    "hung": HUNG,
    **{kind: template(kind) for kind in ("breakwater", "curtain", "cage", "member", "units", "network")},
}
END = "\nanalyses:"

# base, old text, new text, path of the message, words of it
FAULTS = {
    "effective depth of more than the skirt": ("curtain", "  least_effective_depth: 4 m", "criteria: {least_effective_depth: 7 m}", "criteria.least_effective_depth", "is 1.17 (criteria.least_effective_depth 7 m, structure.skirt.length 6 m), which is impossible; allowed: at most 1"),
    "short skirt": ("curtain", "    length: 6 m", "    length: 0.6 m", "structure.skirt.length", "is 6.67 (settings.least_effective_depth 4 m, structure.skirt.length 0.6 m), which is impossible"),
    "curtain of two spans and a half": ("curtain", "length: 22.5 m", "length: 50 m", "structure.length", "is 2.5 (structure.length 50 m, structure.span 20 m), which is impossible; allowed: at most 2, usually 0.9 to 1.4"),
    "floats in kN": ("curtain", "buoyancy: 980 N/m", "buoyancy: 980 kN/m", "structure.floats.buoyancy", "is 9.8e+05 N/m, which is impossible; allowed: at most 2e+05 N/m"),
    "strength in N": ("curtain", "strength: 160 kN/m", "strength: 160 N/m", "structure.skirt.strength", "(structure.skirt.stiffness 900 kN/m, structure.skirt.strength 160 N/m), which is impossible"),
    "sinkers that float": ("cage", "density: 7850 kg/m3", "density: 785 kg/m3", "structure.sinkers.density", "sinkers of 785 kg/m3 float in water of 1025 kg/m3; allowed: more than 1025 kg/m3"),
    "named point in a hull": ("units", "x: 40 m, y: 35 m", "x: 1 m, y: 25 m", "map.points[1]", "'berth 2' at x = 1 m, y = 25 m lies inside of unit 3"),
    "beam of 100 m": ("pontoon", "beam: 10 m", "beam: 100 m", "structure.section.beam", "structure.section.beam 100 m"),
    "pin of 300 N": ("units", "breaking_load: 3 MN", "breaking_load: 300", "structure.connectors[0].breaking_load", "which is impossible; allowed: 0.0005 to 1e+04"),
    "buoy in the air": ("network", "position: [16 m, 0, 0]", "position: [16 m, 0, 10 m]", "structure.points.buoy.position", "starts 9.3 m over the highest water and falls: no line holds it from above; allowed: z of at most 2.1 m"),
    "wave that breaks in a network": ("network", "water_depth: 12 m", "water_depth: 12 mm", "waves.height", "exceeds the breaking height"),
    "start-up as long as the run": ("network", "skip: 30 s", "skip: 130 s", "settings.skip", "130 s leave nothing of the run 'design wave' of 120 s; allowed: less than 120 s"),
    "volume without unit": ("hung", "volume: 1.25 m3", "volume: 1250", "structure.points.block.mass", "is 2.4 (structure.points.block.mass 3 t, structure.points.block.volume 1250), which is impossible; allowed: 3 to"),
    "period of a ripple": ("hung", "period: 5 s", "period: 0.05 s", "structure.motions.barge.period", "is 0.05 s, which is impossible; allowed: 0.1 to"),
    "fairlead over the deck": ("pontoon", "fairlead: {x: -5 m, above_keel: 0 m}", "fairlead: {x: -5 m, above_keel: 9 m}", "lines[0].fairlead", "its fairlead at x = -5 m, 9 m above the keel, lies outside the hull; tension"),
    "key of another form": ("pontoon", "anchor: {x: -57.5 m}", "anchor: {x: -57.5 m, z: 3 m}", "lines[0].anchor.z", "allowed: x, y, above_bed; 'z' is for 'kind: spring'"),
    "file of coefficients": ("member", "{law: dnv_c205, roughness: 1 mm}", "{file: drag.csv}", "structure.drag.file", "another form of 'structure.drag' has 'table'"),
}  # fmt: skip
WARNINGS = {
    "heading in radians": ("pontoon", "heading_deg: 10", "heading_deg: 0.7854", "waves[1].heading_deg", "0.7854 degrees, which are the digits of 45 degrees in radians; allowed: degrees; write 45, or '0.7854 rad'"),
    "normal in radians": ("curtain", "  span: 20 m", "  normal_deg: -0.1745\n  span: 20 m", "structure.normal_deg", "write -10"),
    "sea of 15 h": ("breakwater", "duration: 3 h", "duration: 15 h", "waves[1].duration", "is 5.4e+04 s, which is unusual; allowed: usually at most 2.16e+04 s (source: ISO 19901-1"),
    "offset in kilometres": ("pontoon", END, "\ncriteria: {greatest_offset: 3000 m}\nanalyses:", "criteria.greatest_offset", "is 300 (criteria.greatest_offset 3000 m, structure.section.beam 10 m)"),
    "freeboard of 2 cm": ("pontoon", "draught: 3 m", "draught: 4.48 m", "structure.draught", "is 0.996 (structure.draught 4.48 m, structure.section.height 4.5 m), which is unusual; allowed: usually 0.05 to 0.95"),
    "beam of 80 m": ("pontoon", "beam: 10 m, height: 4.5 m", "beam: 80 m, height: 3.3 m", "structure.section.beam", "structure.section.beam 80 m), which is unusual"),
    "centre of gravity under the keel": ("pontoon", "keel: 2.29 m", "keel: -0.4 m", "structure.centre_of_gravity_above_keel", "-0.4 m above the keel, lies outside the section; allowed: 0 to 4.5 m"),
    "waves along a breakwater": ("pontoon", "heading_deg: 10", "heading_deg: 85", "waves[1].heading_deg", "85 degrees from the normal of the structure, nearly along it: 8.7 % of the horizontal velocity acts across; allowed: usually at most 75 degrees"),
    "current along a curtain": ("curtain", "heading_deg: 10", "heading_deg: 85", "current.heading_deg", "85 degrees from the normal of the curtain"),
    "waves along a curtain": ("curtain", "heading_deg: 20", "heading_deg: 90", "waves[1].heading_deg", "90 degrees from the normal of the curtain, nearly along it: 0.0 %"),
    "float of 500 t": ("curtain", "float_mass: 500 kg", "float_mass: 500 t", "settings.anchor_loads.float_mass", "is 5e+05 kg, which is unusual; allowed: usually 0.01 to 2e+04 kg"),
    "drag of a curtain": ("curtain", "coefficient: 1.5", "coefficient: 15", "structure.drag.coefficient", "is 15, which is unusual; allowed: usually 0.3 to 5"),
    "anchors out of reach": ("cage", "anchor_distance: 150 m", "anchor_distance: 160 m", "structure.mooring.anchor_distance", "farther than their lines of 157.5 m reach: 166.2 m from frame to anchor at SWL, a stretch of 5.53 % before any load; allowed: usually a way of at most 160.7 m"),
    "waves along a member": ("member", "heading_deg: 0\n    duration", "heading_deg: 90\n    duration", "waves[1].heading_deg", "90 degrees from the normal of the member"),
    "current along a member": ("member", "\nstructure:", "\ncurrent: {speed: 0.5 m/s, heading_deg: -88}\nstructure:", "current.heading_deg", "88 degrees from the normal of the member"),
    "lost sign of a height": ("member", "end: {y: 10 m, z: -5 m}", "end: {y: 10 m, z: 5 m}", "structure.end.z", "one end is 5 m above still water and the other 5 m below it, in a member inclined by 26.6 degrees: 50 % of it is dry"),
    "drag of a cage without unit": ("cage", END, "\ncriteria: {greatest_drag: 50}\nanalyses:", "criteria.greatest_drag", "is 7.69e-05 (criteria.greatest_drag 50"),
    "moment in N m": ("member", END, "\ncriteria: {greatest_bending_moment: 250}\nanalyses:", "criteria.greatest_bending_moment", "wave moment"),
    "line of transmission before the row": ("units", "start: [30 m, -30 m], end: [30 m, 30 m]", "start: [-30 m, -30 m], end: [-30 m, 30 m]", "map.line", "'operation' meets it 30 to 30 m before the first unit"),
    "short line": ("network", "length: 24 m", "length: 18.4 m", "structure.lines.mooring.length", "is 0.92 (structure.lines.mooring.length 18.4 m, chord 20), which is unusual; allowed: usually 0.95 to 1.9"),
    "line of one bar": ("network", "segments: 48", "segments: 1", "structure.lines.mooring.segments", "the line 'mooring' of 24 m is one straight bar"),
}  # fmt: skip


def read(base, old, new):
    text = BASES[base]
    assert old in text, old
    return case_of(parse_yaml(text.replace(old, new, 1), "case.yaml"), Path("case.yaml"))


@pytest.mark.parametrize("name", FAULTS)
def test_what_cannot_be_is_refused_at_its_place(name):
    *change, path, words = FAULTS[name]
    with pytest.raises(CaseError) as caught:
        read(*change)
    found = [str(fault) for fault in caught.value.faults]
    assert any(f": {path}: " in fault and words in fault for fault in found), "\n".join(found)
    assert len(found) <= 2, "\n".join(found)


@pytest.mark.parametrize("name", WARNINGS)
def test_what_is_odd_is_warned_of_with_its_limit(name):
    *change, path, words = WARNINGS[name]
    found = [str(warning) for warning in read(*change).warnings]
    assert any(f": {path}: " in warning and words in warning for warning in found), "\n".join(found)


# What is near to a mistake and is none: what is read, and the path that must not be spoken of
SOUND = {
    "heading of one decimal": ("pontoon", "heading_deg: 10", "heading_deg: 3.1", "heading_deg"),
    "heading of a compass": ("pontoon", "heading_deg: 10", "heading_deg: 22.5", "heading_deg"),
    "heading in radians with its unit": ("pontoon", "heading_deg: 10", "heading_deg: 0.7854 rad", "heading_deg"),
    "oblique waves": ("pontoon", "heading_deg: 10", "heading_deg: 70", "heading_deg"),
    "pretension of two per cent": ("cage", "anchor_distance: 150 m", "anchor_distance: 154 m", "anchor_distance"),
    "buoy that just floats high": ("network", "position: [16 m, 0, 0]", "position: [16 m, 0, 1 m]", "position"),
    "point in the gap": ("units", "x: 40 m, y: 35 m", "x: 0 m, y: 10.5 m", "map.points"),
    "brace through the surface": ("member", "end: {y: 10 m, z: -5 m}", "end: {y: 5 m, z: 5 m}", "structure.end"),
    "waves along a pile": ("member", "end: {y: 10 m, z: -5 m}", "end: {y: -10 m, z: -15 m}", "heading_deg"),
    "moment of that size": ("member", END, "\ncriteria: {greatest_bending_moment: 250 kN m}\nanalyses:", "criteria"),
}  # fmt: skip


@pytest.mark.parametrize("name", SOUND)
def test_what_is_near_to_a_mistake_is_left_alone(name):
    *change, path = SOUND[name]
    assert not [str(warning) for warning in read(*change).warnings if path in warning.path]


def test_numbers_without_their_unit_are_named_not_the_size_that_they_share():
    text = BASES["curtain"].replace("holding_force: 150 kN", "holding_force: 15")
    text = text.replace("joints: {distance: 10 m, strength: 180 kN}", "joints: {distance: 10 m, strength: 180}")
    found = case_of(parse_yaml(text, "case.yaml"), Path("case.yaml")).warnings
    assert {"structure.anchors.holding_force", "structure.joints.strength"} <= {warning.path for warning in found}
    assert "structure.skirt.length" not in {warning.path for warning in found}


def test_the_same_slip_in_two_lines_is_no_slip_in_the_depth():
    with pytest.raises(CaseError) as caught:
        case_of(parse_yaml(CASE.replace("length: 54.0 m", "length: 5.4 m"), "case.yaml"), Path("case.yaml"))
    assert all(fault.path.startswith("lines[") for fault in caught.value.faults), caught.value
