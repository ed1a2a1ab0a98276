"""Case files of members: examples and template are sound, each slip gives one clear message with its place."""

from pathlib import Path

import pytest

from moyai.case.reader import case_of, derived_numbers, load_case
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import CaseError

ROOT = Path(__file__).resolve().parents[3]
BASE = template("member")


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


CIRCLE = "{shape: circle, diameter: 1 m}"
SETTINGS = "# settings: {strips: 40, stretching: wheeler, realisations: 5}"
CURRENT = "# current: {speed: 0.5 m/s, heading_deg: 0, profile: {power_law: 0.143}}"
SLIPS = {
    "misspelt key": (("kinematic_viscosity:", "viscosity:"), "did you mean 'kinematic_viscosity'?"),
    "negative diameter": ((CIRCLE, "{shape: circle, diameter: -1 m}"), "out of range"),
    "unknown shape": ((CIRCLE, "{shape: triangle}"), "triangle"),
    "radius of a circle": ((CIRCLE, "{shape: circle, radius: 1 m}"), "diameter"),
    "corner radius": (
        (CIRCLE, "{shape: rounded_rectangle, width: 1 m, height: 1 m, corner_radius: 0.6 m}"),
        "corner_radius is 0.6 m; allowed: less than 0.5 m",
    ),
    "bow tie": ((CIRCLE, "{shape: polygon, points: [[0, 0], [1, 1], [1, 0], [0, 1.2]]}"), "intersects itself"),
    "law of circles": ((CIRCLE, "{shape: square, width: 1 m}"), "is for circles"),
    "above the surface": (("start: {y: -10 m, z: -5 m}", "start: {y: -10 m, z: 0.5 m}"), None),
    "both ends above": (
        ("start: {y: -10 m, z: -5 m}              # ends of the axis; x and y are 0 when absent, z from datum\n"
         "  end: {y: 10 m, z: -5 m}", "start: {y: -10 m, z: 2 m}\n  end: {y: 10 m, z: 2 m}"),
        "above the still water",
    ),
    "below the bed": (("start: {y: -10 m, z: -5 m}", "start: {y: -10 m, z: -50 m}"), "below the bed"),
    "no length": (("start: {y: -10 m, z: -5 m}", "start: {y: 10 m, z: -5 m}"), "both ends of the member coincide"),
    "strength": (("# strength: arai ", "strength: arrai\n    # "), "arrai"),
    "strength beyond the ceiling": (("# strength: arai ", "strength: 7\n    # "), "laminar ceiling"),
    "purpose": (("purpose: extreme", "purpose: design"), "design"),
    "table falls": (("# table: [[2, 0.8], [3, 1.0], [4, 0.6]]", "table: [[3, 0.8], [2, 1.0]]"), "does not rise"),
    "breaking wave": (("heights: [0.2 m, 0.5 m, 1.0 m]", "heights: [0.2 m, 20 m]"), "break"),
    "two heights": (("heights: [0.2 m, 0.5 m, 1.0 m]", "heights: [0.2 m, 0.2 m]"), "is given twice"),
    "height and heights": (("heights: [0.2 m", "height: 1 m\n    heights: [0.2 m"), "exclude each other"),
    "no waves": (("analyses: [sweep, forces, surface]", "analyses: [forces, statics]"), "statics"),
    "drag law": (("{law: dnv_c205, roughness: 1 mm}", "{law: dnv}"), "dnv"),
    "table of one row": (("{law: dnv_c205, roughness: 1 mm}", "{table: [[1, 2]]}"), "drag.table"),
    "table out of order": (("{law: dnv_c205, roughness: 1 mm}", "{table: [[2, 1], [1, 2]]}"), "does not rise"),
    "row of four": (("{law: dnv_c205, roughness: 1 mm}", "{table: [[1, 1], [2, 2, 2, 2]]}"), "drag.table"),
    "negative drag": (("{law: dnv_c205, roughness: 1 mm}", "-1"), "out of range"),
    "motion without period": (("# motion: {x: 0.1 m, phase_x_deg: 90}", "motion: {x: 0.1 m}"), "no single period"),
    "water level": ((SETTINGS, "settings: {water_levels: [HWL]}"), "no water level 'HWL'"),
    "strips": ((SETTINGS, "settings: {strips: 0}"), "strips"),
    "roughness of a member's size": (("roughness: 1 mm", "roughness: 1 m"), "roughness: 1 m is no roughness"),
    "no unit": (("1.19e-6 m2/s", "1.19e-6 m/s"), "kinematic viscosity"),
}  # fmt: skip


@pytest.mark.parametrize("name", SLIPS)
def test_each_slip_gives_one_message_with_its_place(name):
    change, words = SLIPS[name]
    if words is None:
        # an end above the surface alone is a member that pierces it
        assert case(change).warnings == ()
        return
    found = faults(change)
    assert any(words in fault for fault in found), found
    assert all(fault.startswith("case.yaml:") for fault in found)
    assert len(found) <= 2, found


def test_waves_beyond_the_law_are_reported_at_once():
    found = case(("purpose: extreme", "purpose: response"), ("1.0 m]", "2.0 m]")).warnings
    assert sum("beyond the law's 2" in str(fault) for fault in found) == 2
    quiet = case(("purpose: extreme", "purpose: response\n    table: [[1.5, 0.4], [6, 0.1]]")).warnings
    assert not any("beyond the law" in str(fault) for fault in quiet)


def test_tables_that_leave_no_inertia_and_odd_viscosities_are_warned_about():
    found = case(("purpose: extreme", "purpose: response\n    table: [[1, 2.5], [6, 3]]")).warnings
    assert sum("more than the inertia coefficient 2" in str(fault) for fault in found) == 2
    found = case(("1.19e-6 m2/s", "1.19 m2/s")).warnings
    assert any("not the kinematic viscosity of water" in str(fault) for fault in found)


def test_power_law_currents_stand_at_every_water_level():
    changes = (
        ("# water_levels: {HWL: 1.5 m, LWL: 0 m}", "water_levels: {HWL: 1.5 m, LWL: -1 m}"),
        (CURRENT, "current: {speed: 0.5 m/s, heading_deg: 0, profile: {power_law: 0.143}}"),
    )
    assert case(*changes).warnings == ()


def test_current_with_a_counted_circulation_is_warned_about():
    changes = (("purpose: extreme", "purpose: response"), (CURRENT, "current: {speed: 1, heading_deg: 0}"))
    found = case(*changes).warnings
    assert any("no measurement shows how a current" in str(fault) for fault in found)


@pytest.mark.parametrize("file", sorted((ROOT / "examples/member").glob("*.yaml")), ids=lambda file: file.stem)
def test_examples_are_sound_and_have_derived_numbers(file):
    numbers = derived_numbers(load_case(file))
    labels = {number.label for number in numbers}
    assert {"length", "inertia coefficient, first axis", "largest KC, about"} <= labels


def test_tables_over_kc_are_read_for_one_or_both_axes():
    from moyai.case.builder import build

    found = build(
        case(
            ("{law: dnv_c205, roughness: 1 mm}", "{table: [[1, 2], [3, 1, 4]]}"),
            ("ideal  ", "{table: [[0, 2], [9, 1]]} "),
        )
    )
    assert found.rule.drag.rows == ((1.0, 2.0, 2.0), (3.0, 1.0, 4.0))
    assert found.rule.inertia.rows[1] == (9.0, 1.0, 1.0)


def test_derived_numbers_of_a_turned_rectangle_show_the_principal_axes():
    change = (CIRCLE, "{shape: rectangle, width: 2 m, height: 1 m}\n  section_angle_deg: 30")
    numbers = {n.label: n for n in derived_numbers(case(change, ("drag: {law: dnv_c205, roughness: 1 mm}", "drag: 2")))}
    assert numbers["inertia coefficient, smallest"].text == "1.6658"
    assert numbers["inertia coefficient, largest"].text == "3.1421"
    assert numbers["direction of the smallest"].text == "30"


def test_upright_members_in_long_crests_are_not_warned_about_a_law_of_orbits():
    upright = (
        "start: {y: -10 m, z: -5 m}              # ends of the axis; x and y are 0 when absent, z from datum\n"
        "  end: {y: 10 m, z: -5 m}",
        "start: {z: -20 m}\n  end: {z: 4 m}",
    )
    response = ("purpose: extreme", "purpose: response")
    assert not any("beyond the law" in str(fault) for fault in case(response, upright, ("1.0 m]", "2.0 m]")).warnings)
