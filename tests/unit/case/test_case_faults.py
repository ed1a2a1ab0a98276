"""Every bad input gets one clear message with its place; all of them are reported at once."""
# ruff: noqa: E501  (one fault a line reads best)

import pytest
from case_files import CASE, changed, faults, place, read
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import CaseError


def test_the_case_that_the_tests_vary_is_sound():
    assert faults(CASE) == []


# (change, where the fault is placed, dotted path, words of the message)
SINGLE = {
    "misspelt key": ("draught: 3 m", "draugth: 3 m", "draugth", "structure.draugth", "did you mean 'draught'?"),
    "misspelt key with a unit in it": ("heading_deg: 10", "heading: 10", "heading: 10", "waves[1].heading", "did you mean 'heading_deg'?"),
    "word of another trade": ("draught: 3 m", "draft: 3 m", "draft", "structure.draft", "did you mean 'draught'?"),
    "unknown key": ("  length: 21 m", "  colour: red\n  length: 21 m", "colour", "structure.colour", "unknown key 'colour'; allowed: kind, length, section"),
    "key of another block": ("draught: 3 m", "draught: 3 m\n  beam: 3 m", "beam: 3", "structure.beam", "'beam' belongs under 'structure.section'"),
    "unknown key at the root": ("analyses:", "author: me\nanalyses:", "author", "author", "unknown key 'author'"),
    "wrong unit": ("draught: 3 m", "draught: 3 kg", "3 kg", "structure.draught", "expected a length, for instance '1.05 m' or a number in metres; got '3 kg'"),
    "misspelt unit": ("draught: 3 m", "draught: 3 metre", "3 metre", "structure.draught", "unknown unit 'metre'; did you mean 'm'?"),
    "negative depth": ("water_depth: 10 m", "water_depth: -10 m", "-10 m", "site.water_depth", "-10 m is out of range; allowed: greater than 0 m or 'infinite'"),
    "zero depth": ("water_depth: 10 m", "water_depth: 0", "0\n", "site.water_depth", "0 m is out of range; allowed: greater than 0 m"),
    "water level under the bed": ("HWL: 1.5 m", "HWL: -11 m", "-11 m", "site.water_levels.HWL", "the water level -11 m leaves no water over the bed; allowed: above -10 m"),
    "body deeper than the water": ("water_depth: 10 m", "water_depth: 2.5 m", "3 m\n  centre", "structure.draught", "the body is 3 m deep in 2.5 m of water at LWL; allowed: a draught below 2.5 m"),
    "draught above the deck": ("draught: 3 m", "draught: 4.5 m", "4.5 m\n  centre", "structure.draught", "the draught of 4.5 m is not less than the height of the section, 4.5 m"),
    "body heavier than its displacement": ("draught: 3 m", "mass: 1200 t", "1200 t", "structure.mass", "the body of 1.2e+06 kg is heavier than the 968625 kg it displaces when wholly under water"),
    "anchor inside the body": ("anchor: {x: -57.5 m}", "anchor: {x: -2 m, above_bed: 8 m}", "{x: -2 m", "lines[0].anchor", "the anchor of 'seaward' at x = -2 m, z = -2 m lies inside the body"),
    "anchor on the wrong side": ("anchor: {x: -57.5 m}", "anchor: {x: 57.5 m}", "{x: 57.5 m", "lines[0].anchor", "line 'seaward': its fairlead is at x = -5 m and its anchor at x = 57.5 m, on the other side of the hull, so that it runs under the keel; tension"),
    "line that breaks at rest": ("length: 54.0 m", "length: 40 m", "- {catalogue", "lines[0].segments", "exceeds its breaking load"),
    "line in a heap": ("length: 54.0 m", "length: 80 m", "- {catalogue", "lines[0].segments", "80 m of line lie folded"),
    "regular wave beyond breaking": ("height: 0.6 m", "height: 9 m", "9 m", "waves[0].height", "wave height 9 m exceeds the breaking height"),
    "sea beyond the depth": ("significant_height: 1.0 m", "significant_height: 12 m", "12 m", "waves[1].significant_height", "significant height 12 m exceeds 0.78 of the depth"),
    "nan": ("height: 0.6 m", "height: .nan", ".nan", "waves[0].height", "got nan, which is not a finite number"),
    "nan in a text": ("speed: 25 m/s", "speed: nan m/s", "nan", "wind.speed", "'nan m/s' is not a finite number"),
    "infinite": ("length: 21 m", "length: 1e400", "1e400", "structure.length", "got inf, which is not a finite number"),
    "infinite mass": ("draught: 3 m", "mass: .inf", ".inf", "structure.mass", "got inf, which is not a finite number"),
    "nan in a list": ("periods: [4, 5, 6]", "periods: [4, .nan, 6]", ".nan", "waves[0].periods[1]", "got nan, which is not a finite number"),
    "empty list of periods": ("periods: [4, 5, 6]", "periods: []", "[]", "waves[0].periods", "the list is empty; allowed: at least 1 entry"),
    "period of zero": ("periods: [4, 5, 6]", "periods: [4, 0, 6]", "0, 6]", "waves[0].periods[1]", "0 s is out of range; allowed: greater than 0 s"),
    "period twice": ("periods: [4, 5, 6]", "periods: [4, 5, 4]", "[4, 5, 4]", "waves[0].periods", "4 is given twice in the list"),
    "range of one value": ("periods: [4, 5, 6]", "periods: {from: 4 s, to: 4 s, count: 3}", "{from", "waves[0].periods", "'from' and 'to' are equal"),
    "period and periods": ("periods: [4, 5, 6]", "periods: [4, 5, 6]\n    period: 5 s", "period: 5 s", "waves[0].period", "'period' and 'periods' exclude each other"),
    "heading and bearing": ("heading_deg: 10", "heading_deg: 10\n    from_bearing_deg: 70", "from_bearing_deg", "waves[1].from_bearing_deg", "'heading_deg' and 'from_bearing_deg' exclude each other"),
    "no direction": ("    heading_deg: 10\n", "", "name: storm", "waves[1]", "'heading_deg' or 'from_bearing_deg' is missing; give one of them"),
    "bearing without the axis": ("heading_deg: 10", "from_bearing_deg: 70", "70", "waves[1].from_bearing_deg", "needs 'site.x_axis_bearing_deg'"),
    "empty current table": ("current: {speed: 0.3 m/s,", "current: {profile: {table: []},", "[]", "current.profile.table", "the list is empty; allowed: at least 2 entries"),
    "current table out of order": ("current: {speed: 0.3 m/s,", "current: {profile: {table: [[-8, 0.1], [-9, 0.2]]},", "[[-8", "current.profile.table", "the heights do not rise: -9 m follows -8 m"),
    "current table with a short row": ("current: {speed: 0.3 m/s,", "current: {profile: {table: [[-8], [0, 0.2]]},", "[-8]", "current.profile.table[0]", "the list has 1 value(s); allowed: at least 2"),
    "current table above water": ("current: {speed: 0.3 m/s,", "current: {profile: {table: [[-8, 0.1], [1, 0.2]]},", "[1, 0.2]", "current.profile.table[1]", "the height 1 m is above still water"),
    "current table under the bed": ("current: {speed: 0.3 m/s,", "current: {profile: {table: [[-12, 0.1], [0, 0.2]]},", "[-12, 0.1]", "current.profile.table[0]", "the height -12 m is under the bed"),
    "current without speed": ("current: {speed: 0.3 m/s,", "current: {", "{ heading", "current", "'speed' is missing"),
    "misspelt kind of sea": ("kind: jonswap", "kind: jonswop", "jonswop", "waves[1].kind", "'jonswop' is not known here; allowed: regular, jonswap, pierson_moskowitz, bretschneider_mitsuyasu, tma, spectrum_file; did you mean 'jonswap'?"),
    "kind of sea missing": ("    kind: jonswap\n", "", "name: storm", "waves[1].kind", "the key 'kind' is missing; allowed: regular, jonswap"),
    "misspelt shape": ("shape: rectangle", "shape: rectangel", "rectangel", "structure.section.shape", "did you mean 'rectangle'?"),
    "misspelt structure": ("kind: breakwater", "kind: breakwatr", "breakwatr", "structure.kind", "'breakwatr' is not a known structure; allowed: breakwater"),
    "no structure": ("structure:", "structur:", "structur", "structur", "unknown key 'structur'; did you mean 'structure'?"),
    "structure without kind": ("  kind: breakwater\n", "", "structure", "structure.kind", "the key 'kind' is missing; allowed: breakwater"),
    "required key missing": ("  density: 1025 kg/m3\n", "", "site:", "site.density", "the key 'density' is missing; give it: Density of the water, for instance '1025 kg/m3'"),
    "key without value": ("draught: 3 m", "draught:", "draught", "structure.draught", "there is no value; give one, or remove the key"),
    "neither draught nor mass": ("  draught: 3 m\n", "", "structure", "structure", "'draught' or 'mass' is missing"),
    "version": ("moyai: 1", "moyai: 2", "2", "moyai", "'2' is not known here; allowed: 1"),
    "text for a truth value": ("analyses:", "settings: {drift: no}\nanalyses:", "no}", "settings.drift", "expected true or false; got 'no'; did you mean 'false'?"),
    "sexagesimal time": ("analyses:", "settings: {time: {duration: 1:30}}\nanalyses:", "1:30", "settings.time.duration", "'1:30' is not a number with a unit"),
    "block for a list": ("    segments:\n      - {", "    segments:\n      {", "{catalogue", "lines[0].segments", "expected a list; got a block of keys"),
    "number for a block": ("wind: {speed: 25 m/s, heading_deg: 0, density: 1.225 kg/m3}", "wind: 25", "25\n", "wind", "expected a block of keys; got '25'"),
    "unknown mode": ("modes: [sway, heave, roll]", "modes: [sway, pitch]", "pitch", "structure.damping.modes[1]", "'pitch' is not known here; allowed: sway, heave, roll"),
    "mode twice": ("modes: [sway, heave, roll]", "modes: [sway, sway]", "[sway, sway]", "structure.damping.modes", "'sway' is given twice"),
    "two seas of one name": ("name: storm", "name: operation", "operation\n    kind: jonswap", "waves[1].name", "two sea states are called 'operation'"),
    "two lines of one name": ("name: shoreward", "name: seaward", "seaward\n    count: 2\n    fairlead: {x: 5", "lines[1].name", "two lines are called 'seaward'"),
    "name with a slash": ("name: storm", "name: a/b", "a/b", "waves[1].name", "'a/b' is not a name"),
    "unknown line type": ("studless_chain_R3", "studles_chain_R3", "studles_chain_R3", "lines[0].segments[0].catalogue", "did you mean 'studless_chain_R3'?"),
    "misspelt catalogue": ("{catalogue: stud", "{catalog: stud", "catalog: stud", "lines[0].segments[0].catalog", "unknown key 'catalog'; did you mean 'catalogue'?"),
    "misspelt kind of line": ("  - name: shoreward", "  - name: shoreward\n    kind: sprng", "sprng", "lines[1].kind", "'sprng' is not known here; allowed: catenary, spring; did you mean 'spring'?"),
    "misspelt table": ("current: {speed: 0.3 m/s,", "current: {profile: {tabel: [[-8, 0.1], [0, 0.2]]},", "tabel", "current.profile.tabel", "unknown key 'tabel'; did you mean 'table'?"),
    "unknown water level": ("analyses:", "settings: {water_levels: [MWL]}\nanalyses:", "MWL", "settings.water_levels[0]", "there is no water level 'MWL'; allowed: HWL, LWL"),
    "wind without its coefficient": ("  wind_drag_coefficient: 1.2\n", "", "{speed: 25", "wind", "'wind' needs 'structure.wind_drag_coefficient'"),
    "current without its coefficient": ("  current_drag_coefficient: 1.5\n", "", "{speed: 0.3", "current", "'current' needs 'structure.current_drag_coefficient'"),
    "inertia without mass": ("roll_gyradius: 2.67 m", "roll_inertia: 4.4e3 t m2", "4.4e3", "structure.roll_inertia", "'roll_inertia' needs 'mass'"),
    "no file": ("kind: jonswap\n    significant_height: 1.0 m\n    peak_period: 5 s\n    peak_enhancement: 3.3", "kind: spectrum_file\n    file: sea.csv", "sea.csv", "waves[1].file", "there is no file 'sea.csv'"),
    "count that is not whole": ("count: 2", "count: 2.5", "2.5", "lines[0].count", "expected a whole number; got '2.5'"),
    "count of zero": ("count: 2", "count: 0", "0\n    fair", "lines[0].count", "'0' is out of range; allowed: at least 1"),
    "clump at the end": ("- {catalogue: studless_chain_R3, diameter: 68 mm, length: 54.0 m}", "- {catalogue: studless_chain_R3, diameter: 68 mm, length: 54.0 m}\n      - {clump: {mass: 1 t, volume: 0.4 m3}}", "- {catalogue", "lines[0].segments", "a clump is at the end of the line"),
    "section that crosses itself": ("{shape: rectangle, beam: 10 m, height: 4.5 m}", "{shape: polygon, points: [[-5, 0], [5, 4.5], [5, 0], [-5, 4.5]]}", "[[-5", "structure.section.points", ""),
    "section not counted from the keel": ("{shape: rectangle, beam: 10 m, height: 4.5 m}", "{shape: polygon, points: [[-5, -3], [5, -3], [5, 1.5], [-5, 1.5]]}", "{shape", "structure.section", "the lowest point of the section is at z = -3 m; allowed: 0 m: z is measured from the keel"),
    "bilge larger than the box": ("{shape: rectangle, beam: 10 m, height: 4.5 m}", "{shape: rounded_rectangle, beam: 10 m, height: 4.5 m, bilge_radius: 6 m}", "6 m}", "structure.section.bilge_radius", "allowed: at most 4.5 m"),
    "tma in infinite depth": ("  water_depth: 10 m\n  water_levels: {HWL: 1.5 m, LWL: 0 m}", "  water_depth: infinite", "{x: -57.5 m}", "lines[0].anchor", "line 'seaward' goes to a bed that is infinitely deep"),
    "time without waves": (CASE[CASE.index("waves:") : CASE.index("wind:")], "", "[statics", "analyses", "the analysis 'time' needs 'waves'"),
}  # fmt: skip


@pytest.mark.parametrize("name", SINGLE)
def test_one_fault_is_reported_with_its_place_and_reason(name):
    old, new, needle, path, words = SINGLE[name]
    text = changed((old, new))
    found = faults(text)
    start = f"case.yaml:{place(text, needle)}: {path}: "
    if name == "no structure":
        # The kind cannot be known, so nothing else can be judged
        assert len(found) == 1
    assert any(fault.startswith(start) and words in fault for fault in found), "\n".join([start, *found])
    if name not in ("line that breaks at rest", "tma in infinite depth", "regular wave beyond breaking"):
        assert len(found) == 1, "\n".join(found)


def test_all_faults_are_reported_at_once_in_the_order_of_the_file():
    text = changed(
        ("water_depth: 10 m", "water_depth: -10 m"),
        ("periods: [4, 5, 6]", "periodes: [4, 5, 6]"),
        ("peak_enhancement: 3.3", "peak_enhancement: 33"),
        ("shape: rectangle", "shape: rectangel"),
        ("diameter: 68 mm", "diameter: 68 t"),
        ("analyses: [statics", "analyses: [statik"),
    )
    found = faults(text)
    paths = [fault.split(": ")[1] for fault in found]
    assert paths == [
        "site.water_depth",
        "waves[0].periodes",
        "waves[1].peak_enhancement",
        "structure.section.shape",
        "lines[0].segments[0].diameter",
        "analyses[0]",
    ]


def test_checks_between_keys_still_run_next_to_misspelt_keys_and_bad_options():
    """A misspelt key is read as what it most likely means, so that the physics behind it is judged in the same go."""
    text = changed(
        ("draught: 3 m", "draugth: 12 m"),
        ("kind: regular", "kind: regular\n    theory: cnoidal"),
        ("heading_deg: 10", "from_bearing_deg: 10"),
    )
    found = "\n".join(faults(text))
    assert "unknown key 'draugth'; did you mean 'draught'?" in found
    assert "'cnoidal' is not known here; allowed: linear" in found
    assert "the draught of 12 m is not less than the height of the section" in found
    assert "needs 'site.x_axis_bearing_deg'" in found
    assert len(found.split("\n")) == 4


def test_physics_of_sound_parts_is_judged_next_to_faults_of_others():
    text = changed(
        ("height: 0.6 m", "height: 9 m"),
        ("significant_height: 1.0 m", "significant_height: 12 m"),
        ("draught: 3 m", "draught: 4.5 m"),
        ("  wind_drag_coefficient: 1.2\n", ""),
    )
    found = faults(text)
    assert [fault.split(": ")[1] for fault in found[:2]] == ["waves[0].height", "waves[1].significant_height"]
    assert any("'wind' needs" in fault for fault in found)
    assert any("the draught of 4.5 m is not less" in fault for fault in found)


def test_a_single_sea_state_needs_no_list_and_its_faults_no_index():
    start = CASE.index("waves:")
    end = CASE.index("wind:")
    text = CASE[:start] + "waves: {kind: regular, height: 30 m, period: 5 s, heading_deg: 0}\n" + CASE[end:]
    (fault,) = faults(text)
    assert fault.startswith(f"case.yaml:{place(text, '30 m')}: waves.height: wave height 30 m exceeds the breaking")
    assert "waves.heigth: unknown key" in faults(text.replace("height: 30", "heigth: 30"))[0]


def test_empty_list_of_seas():
    start, end = CASE.index("waves:"), CASE.index("wind:")
    fault = faults(CASE[:start] + "waves: []\n" + CASE[end:])[0]
    assert fault.startswith(f"case.yaml:{CASE[:start].count(chr(10)) + 1}:8: waves: the list of sea states is empty")


def test_a_line_shorter_than_its_chord_is_pretension_not_a_fault():
    text = CASE.replace("length: 54.0 m", "length: 52.91 m").replace("{HWL: 1.5 m, LWL: 0 m}", "{SWL: 0 m}")
    chord = (52.5**2 + 7.0**2) ** 0.5
    assert chord > 52.91
    assert faults(text) == []


def test_warnings_do_not_stop_a_case():
    text = changed(("fairlead: {x: -5 m, above_keel: 0 m}", "fairlead: {x: -5.5 m, above_keel: 0 m}"))
    case = read(text)
    assert any(
        "line 'seaward': its fairlead at x = -5.5 m, 0 m above the keel, lies outside the hull" in str(warning)
        for warning in case.warnings
    )
    assert all(warning.line > 0 for warning in case.warnings)


def test_imbalance_of_mass_and_draught_is_warned_of_above_one_per_cent():
    pull = 8
    balanced = 1.025 * 10 * 3 * 21 - pull
    near = read(changed(("draught: 3 m", f"draught: 3 m\n  mass: {balanced:.3f} t")))
    far = read(changed(("draught: 3 m", f"draught: 3 m\n  mass: {balanced * 1.05:.3f} t")))
    assert not any("differ by" in str(warning) for warning in near.warnings)
    assert any("structure.mass" in str(warning) and "differ by" in str(warning) for warning in far.warnings)


_TOKENS = st.sampled_from(
    [
        "0",
        "-1",
        "nan",
        ".inf",
        "1e400",
        "3 kg",
        "[]",
        "{}",
        "[1, 2]",
        "{x: 1}",
        "true",
        "infinite",
        "''",
        "~",
        "draugth",
        "5 m",
    ]
)


@pytest.mark.slow
@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.integers(0, CASE.count(": ") - 1), _TOKENS)
def test_any_value_anywhere_gives_a_case_or_faults_with_places(index, token):
    """One value of the case replaced by rubbish: never an exception of another kind, never a fault without its line."""
    pieces = CASE.split(": ")
    head, tail = ": ".join(pieces[: index + 1]), ": ".join(pieces[index + 1 :])
    cut = min((tail.index(mark) for mark in ("\n", ",", "}", "]") if mark in tail), default=len(tail))
    text = f"{head}: {token}{tail[cut:]}"
    try:
        document = parse_yaml(text, "case.yaml")
    except CaseError:
        return
    assert document.text == text
    for fault in faults(text):
        assert fault.startswith("case.yaml:")
        assert int(fault.split(":")[1]) >= 1


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(st.integers(0, len(CASE.splitlines()) - 1), min_size=1, max_size=6))
def test_lines_left_out_give_a_case_or_faults(dropped):
    text = "\n".join(line for index, line in enumerate(CASE.splitlines()) if index not in dropped) + "\n"
    for fault in faults(text):
        assert fault.startswith("case.yaml")
