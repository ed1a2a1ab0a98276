# ruff: noqa: E501  (one fault a line reads best)
"""Case files of rows of units: template and example are sound, each slip gives one clear message with its place."""

from pathlib import Path

import numpy as np
import pytest

from moyai.case.builder import build
from moyai.case.reader import case_of, derived_numbers, load_case
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import CaseError

ROOT = Path(__file__).resolve().parents[3]
BASE = template("units")
UNITS = "units: {count: 3, length: 20 m, gap: 1 m}"
ANALYSES = "analyses: [statics, frequency, time, map]"
PIN = "- {name: pin, kind: hinge, axis: x, above_keel: 3 m, breaking_load: 3 MN}"


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


SLIPS = {
    "units overlap": (
        (UNITS, "units: {length: 20 m, places: [{y: 0 m}, {y: 19 m}]}"), "units 1 and 2 overlap by 1 m", "structure.units",
    ),
    "units cross": (
        (UNITS, "units: {length: 20 m, places: [{y: 0 m}, {x: 8 m, y: 8 m, heading_deg: -60}]}"),
        "units 1 and 2 overlap", "structure.units",
    ),
    "gap under a tenth of a panel": (("gap: 1 m", "gap: 0.1 m"), "under a tenth of a panel (2 m)", "structure.units"),
    "count and places": ((UNITS, "units: {count: 2, length: 20 m, places: [{y: 0 m}]}"), "exclude each other", ""),
    "draught below the bed": (("water_depth: 10 m", "water_depth: 2 m"), "2.4 m deep in 2 m of water", "structure.draught"),
    "draught over the deck": (("draught: 2.4 m", "draught: 3.6 m"), "not less than the height", "structure.draught"),
    "panels too coarse": (("panel_size: 2 m", "panel_size: 6 m"), "panels long", "settings.panel_size"),
    "panels without number": (("panel_size: 2 m", "panel_size: 0.1 m"), "would be about", "settings.panel_size"),
    "two pins": ((PIN, PIN + "\n    " + PIN.replace("name: pin", "name: second")),
                 "connector 'second 1-2' holds", "structure.connectors"),
    "no such unit": ((PIN, PIN.replace("kind: hinge", "between: [[1, 4]], kind: hinge")), "there is no unit 4", "between"),
    "joined to itself": ((PIN, PIN.replace("kind: hinge", "between: [[2, 2]], kind: hinge")), "joined to itself", ""),
    "a unit between": (
        (PIN, PIN.replace("kind: hinge", "between: [[1, 3]], kind: hinge")), "unit 2 lies between them", "between",
    ),
    "units apart": (
        (UNITS, "units: {length: 20 m, places: [{y: 0 m}, {y: 45 m}]}"), "are 25 m apart", "between",
    ),
    "line of no unit": (("# units: [1, 3]", "units: [1, 5]   #"), "there is no unit 5", "lines[0].units"),
    "line in motion": (("# units: [1, 3]", "dynamic: true   #"), "at rest at every instant", "lines[0].dynamic"),
    "drag of a line": (("# units: [1, 3]", "drag_width: 0.1 m   #"), "is not counted", "lines[0].drag_width"),
    "time without frequency": ((ANALYSES, "analyses: [statics, time]"), "needs 'frequency'", "analyses"),
    "map without motions": ((ANALYSES, "analyses: [statics, map]"), "needs 'frequency'", ""),
    "no realisation": (("# time: {realisations: 5,", "time: {realisations: 0} #"), "realisations", "settings.time"),
    "a step as long as a wave": (("# time: {realisations: 5,", "time: {time_step: 2 s} #"), "more than a tenth", "time_step"),
    "endurance without range": ((PIN, PIN.replace("axis: x", "axis: x, endurance: {cycles: 10, exponent: 3}")), "range", ""),
    "map runs backwards": (("x: [-40 m, 100 m]", "x: [100 m, -40 m]"), "the smaller one first", "map.x"),
    "wind without coefficient": (
        ("# wind: {speed: 25 m/s", "wind: {speed: 25 m/s"), "needs 'structure.wind_drag_coefficient'", "wind",
    ),
    "curve falls": (
        (PIN, "- {name: r, kind: rubber, above_keel: 3 m, curve: [[0 m, 0 N], [-0.1 m, -5 kN]]}"), "does not rise", "curve",
    ),
    "direction without length": ((PIN, PIN.replace("axis: x", "axis: [0, 0, 0]")), "has no length", "axis"),
    "a plate": (
        ("section: {shape: rectangle, beam: 8 m, height: 3.5 m}",
         "section: {shape: rectangle, beam: 8 m, height: 3.5 m, plates: [{points: [[-4 m, 0 m], [-4 m, -1 m]]}]}"),
        "thin plates are not computed", "structure.section.plates",
    ),
    "a section that heels": (
        ("section: {shape: rectangle, beam: 8 m, height: 3.5 m}",
         "section: {shape: polygon, points: [[-4, 0], [4, 0], [4, 3.5], [-3, 3.5]]}"),
        "would heel", "structure.section",
    ),
    "capsizes": (("centre_of_gravity_above_keel: 1.8 m", "centre_of_gravity_above_keel: 3.49 m"), "metacentric", ""),
}  # fmt: skip


def test_template_and_example_are_sound():
    assert build(case()).row.count == 3
    example = build(load_case(ROOT / "examples" / "units" / "two_pontoons.yaml"))
    assert [connector.kind for connector in example.row.connectors] == ["chain", "chain", "fender", "spring"]


@pytest.mark.parametrize("slip", list(SLIPS))
def test_each_slip_gives_one_clear_message(slip):
    change, words, path = SLIPS[slip]
    found = faults(change)
    assert len(found) == 1, found
    assert words in found[0], found[0]
    assert path in found[0], found[0]


def test_unused_units_of_length_zero_gap_are_read_as_a_bent_row():
    found = build(case((UNITS, "units: {length: 20 m, places: [{y: 0 m}, {x: 12 m, y: 20 m, heading_deg: -50}]}"),
                       (PIN, PIN.replace("kind: hinge", "between: [[1, 2]], kind: hinge"))))  # fmt: skip
    assert found.row.placements[1].heading == pytest.approx(np.radians(-50.0))
    assert found.row.connectors[0].pairs == ((0, 1),)


def test_check_tells_panels_and_cost():
    names = {number.label: number.value for number in derived_numbers(case())}
    assert names["panels"] > 500
    assert names["panels a shortest wave"] == pytest.approx(names["shortest wave"] / names["longest side of a panel"])
    assert names["motions that connectors leave"] == 18 - 2 * 5
    assert names["processor time, about"] > 1.0
    # 8 of the list and 2 of regular waves; those of the memory fill the band beyond
    assert names["frequencies"] == 10
    assert 10 < names["frequencies with those of the memory"] <= 10 + 24


def test_automatic_panels_resolve_the_shortest_wave():
    names = {n.label: n.value for n in derived_numbers(case(("panel_size: 2 m", "panel_size: auto")))}
    assert names["panels a shortest wave"] >= 8.0 * 0.99


@pytest.mark.parametrize(
    ("damping", "factor"),
    [
        ("", 1.0),
        ("damping: {viscous_factor: 2}", 2.0),
        ("damping: {fraction_of_critical: 0.1, modes: [sway, surge, yaw]}", 1.0),
        ("damping: {fraction_of_critical: 0.1, modes: [heave, roll]}", 0.0),
        ("damping: {viscous: computed, fraction_of_critical: 0.1, modes: [roll]}", 1.0),
        ("damping: {viscous: none}", 0.0),
    ],
)
def test_a_fraction_stands_for_eddies_where_it_holds_for_roll(damping, factor):
    line = next(line for line in BASE.splitlines() if line.startswith("  damping:"))
    assert build(case((line, f"  {damping}"))).row.viscous_factor == factor


def test_chain_that_leaves_nothing_on_the_bed_is_warned_of_before_the_run():
    assert not any("lies on the bed" in str(warning) for warning in case().warnings)
    short = [("length: 60 m}]", "length: 57 m}]")] * 4
    found = [str(warning) for warning in case(*short, (ANALYSES, "analyses: [statics]")).warnings]
    assert sum("no chain lies on the bed at rest" in warning for warning in found) == 4
    assert "of line would just touch down" in found[0]


def test_connectors_at_corners_and_faces_without_one_are_said():
    """A block of two by two, listed row by row: the second and third unit meet at a corner alone."""
    block = "units: {length: 20 m, places: [{x: -6 m, y: -11 m}, {x: -6 m, y: 11 m}, {x: 6 m, y: -11 m}, {x: 6 m, y: 11 m}]}"
    found = [str(warning) for warning in case((UNITS, block), (ANALYSES, "analyses: [statics]")).warnings]
    assert any("units 2 and 3 have no facing sides" in warning and "x = 0 m, y = 0 m" in warning for warning in found)
    assert any("1 and 3, 2 and 4 face each other and get none" in warning for warning in found)
    assert not any("face each other" in str(warning) for warning in case((ANALYSES, "analyses: [statics]")).warnings)
