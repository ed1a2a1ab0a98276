"""Slips of a designer: units, decimal points, full-width signs, what cannot be. Each is stopped or warned of."""
# ruff: noqa: E501  (one slip a line reads best)

import time

import pytest
import slips
from case_files import CASE, changed, faults, read

from moyai.case.plausibility_page import renew
from moyai.case.reader import case_of
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import CaseError, InputError
from moyai.tables.plausible_ranges import all_ranges, kind_bounds, range_sources

SECTION = "{shape: rectangle, beam: 10 m, height: 4.5 m}"
SPIKES = ", ".join(f"[{-5 + 0.05 * i:.6g}, {1 + i % 2}]" for i in range(201))
COMB = "{shape: polygon, points: [" + SPIKES + ", [5, 4.5], [-5, 4.5], [-5, 0], [-5.01, 0], [-5.01, 1]]}"
PLATE = "{shape: rectangle, beam: 10 m, height: 4.5 m, plates: [{points: [[-5 m, 0 m], [-5 m, -0.00001 m]]}]}"

# What stands in the case, what a slip makes of it, and words of the message
STOPPED = {
    "peak period of 50 s": ("peak_period: 5 s", "peak_period: 50 s", "waves[1].peak_period: the peak period of a wind sea is 50 s, which is impossible; allowed: 0.05 to 35 s, usually 0.25 to 25 s (source: Munk"),
    "sea of 3 s": ("peak_period: 5 s", "peak_period: 5 s\n    duration: 3 s", "waves[1].duration: the duration of the sea state in wave periods is 0.6 (waves.duration 3 s, waves.peak_period 5 s"),
    "periods backwards": ("[4, 5, 6]", "{from: 8 s, to: 3 s, count: 5}", "waves[0].periods: the range runs backwards: 'from' 8 is not below 'to' 3; allowed: 'from' below 'to'; write from: 3, to: 8"),
    "list backwards": ("[4, 5, 6]", "[6, 5, 4]", "waves[0].periods: the list runs backwards, from 6 to 4; allowed: short periods first; write [4, 5, 6]"),
    "frequencies backwards": ("analyses:", "settings: {frequencies: {from: 3, to: 0.3, count: 5}}\nanalyses:", "settings.frequencies: the range runs backwards"),
    "gyradius of another drawing": ("2.67 m", "62 m", "structure.roll_gyradius: the roll gyradius over the diagonal of the section is 5.65 (structure.roll_gyradius 62 m, diagonal 10.97, structure.section.beam 10 m, structure.section.height 4.5 m), which is impossible; allowed: 0.03 to 0.6"),
    "centre of gravity ten times too high": ("2.29 m", "22.9 m", "structure.centre_of_gravity_above_keel: the centre of gravity above the keel over the height of the section is 5.09"),
    "unit that capsizes": ("2.29 m", "4.4 m", "structure.centre_of_gravity_above_keel: HWL: the metacentric height is -0.122 m; the unit capsizes unless the lines hold it; allowed: a metacentric height above 0 m; lower the centre of gravity or widen the section; where lines hold it upright on purpose, give 'allow_unstable: true'"),
    "chain of 60 m": ("68 mm", "60", "lines[0].segments[0].diameter: diameter is 60 m: the strength formula of studless_chain_R3 falls beyond its maximum; allowed: 0.034 to 0.162 m; a number without unit is read in m: give the unit; did you mean '60 mm'?"),
    "tonnes for kilograms": ("1025 kg/m3", "1.025", "site.density: the density of the water is 1.02 kg/m3, which is impossible; allowed: 900 to 1250 kg/m3, usually 985 to 1060 kg/m3 (source: Equation of state of sea water (TEOS-10): 1000 to 1030 kg/m3 at the surface; brines to 1240 kg/m3 (Dead Sea)); a number without unit is read in kg/m3: give the unit; did you mean 1025?"),
    "mps": ("25 m/s", "25 mps", "wind.speed: expected a speed, for instance '0.3 m/s' or a number in metres per second; unknown unit 'mps'; did you mean 'm/s'?"),
    "decimal comma in braces": ("height: 4.5 m", "height: 4,5 m", "structure.section.height: the comma of '4,5 m' ends the value '4' in braces; write a decimal point: 4.5 m"),
    "full-width colon": ("draught: 3 m", "draught：3 m", "a full-width colon '：' is used where YAML needs a plain one; write a plain ':' and a space"),
    "full-width colon in braces": ("beam: 10 m", "beam： 10 m", "a full-width colon '：' is used where YAML needs a plain one"),
    "full-width space": ("draught: 3 m", "draught:　3 m", "a full-width space '　' is used where YAML needs a plain one; write a plain space behind ':'"),
    "full-width indentation": ("  draught: 3 m", "　draught: 3 m", "a full-width space '　' is used where YAML needs a plain one; indent with plain spaces"),
    "full-width comma": ("beam: 10 m, h", "beam: 10 m，h", "a full-width sign '，' is used where YAML needs a plain one; write ',' in braces and brackets"),
    "full-width count": ("count: 2", "count: ２", "lines[0].count: expected a whole number; got '２'; write 2, without quotes and with half-width digits"),
    "beam of 10 km": ("beam: 10 m", "beam: 10 km", "structure.section.beam: the beam is 1e+04 m, which is impossible; allowed: 0.02 to 400 m"),
    "draught of 0.1 mm": ("draught: 3 m", "draught: 0.1 mm", "structure.draught: the draught over beam is 1e-05 (structure.draught 0.1 mm, structure.section.beam 10 m), which is impossible"),
    "gravity of 1e18": ("9.81 m/s2", "1e18", "site.gravity: 1e+18 m/s2 is no acceleration that a structure in water can have; allowed: 1 to 30 m/s2"),
    "length of 1e150 m": ("length: 21 m", "length: 1e150 m", "structure.length: 1e150 m is no length that a structure in water can have; allowed: 1e-09 to 200000 m"),
    "damping of 1e308": ("fraction_of_critical: 0.15", "fraction_of_critical: 1e308", "structure.damping.fraction_of_critical: 1e+308 is no number"),
    "centimetres of wind drag": ("wind_drag_coefficient: 1.2", "wind_drag_coefficient: 1200", "structure.wind_drag_coefficient: the drag coefficient in wind is 1.2e+03, which is impossible"),
}  # fmt: skip
WARNED = {
    "current of 8 m/s": ("speed: 0.3 m/s", "speed: 8 m/s", "current.speed: the current speed is 8 m/s, which is unusual; allowed: usually 0.005 to 4.5 m/s (source: Tidal streams"),
    "sea of 30 waves": ("peak_period: 5 s", "peak_period: 5 s\n    duration: 150 s", "waves[1].duration: the duration of the sea state in wave periods is 30"),
    "no chain on the bed": ("54.0 m", "53.0 m", "lines[0].segments: line 'seaward': no chain lies on the bed at rest (water level HWL); it pulls its anchor upwards with 200 kN before any wave; allowed: some chain on the bed, unless the anchor resists uplift; 53.39 m of line would just touch down at rest"),
    "waves of 1 mm": ("height: 0.6 m", "height: 0.6 mm", "waves[0].height: the wave height over the length of the shortest wave in deep water is 2.4e-05"),
    "gyradius of a thin body": ("2.67 m", "1.2 m", "structure.roll_gyradius: the roll gyradius over the diagonal of the section is 0.109"),
    "wind of 25 mm/s": ("speed: 25 m/s", "speed: 25 mm/s", "wind.speed: the wind speed is 0.025 m/s, which is unusual; allowed: usually 0.5 to 60 m/s"),
    "capsizing on purpose": ("centre_of_gravity_above_keel: 2.29 m", "centre_of_gravity_above_keel: 4.4 m\n  allow_unstable: true", "the metacentric height is -0.122 m"),
}  # fmt: skip


@pytest.mark.parametrize("name", STOPPED)
def test_what_cannot_be_is_stopped_with_one_message(name):
    old, new, words = STOPPED[name]
    found = faults(changed((old, new)))
    assert len(found) == 1, "\n".join(found)
    assert words in found[0]
    line = CASE[: CASE.index(old)].count("\n") + 1
    assert found[0].startswith("case.yaml:")
    assert abs(int(found[0].split(":")[1]) - line) <= 1


@pytest.mark.parametrize("name", WARNED)
def test_what_is_unusual_is_warned_of(name):
    old, new, words = WARNED[name]
    found = [str(fault) for fault in read(changed((old, new))).warnings]
    assert any(words in text for text in found), found


@pytest.mark.slow
def test_a_sound_case_is_not_spoken_of():
    assert not [str(fault) for fault in read(CASE).warnings if "usual" in fault.allowed]
    for name, text, folder in [*slips.sources(), *slips.designs()]:
        found = case_of(parse_yaml(text, name), folder / "case.yaml").warnings
        assert not [str(fault) for fault in found if "usual" in fault.allowed], name


def test_full_width_signs_may_stand_in_titles_quotes_and_comments():
    text = changed(
        ("title: Test pontoon", "title: 浮消波堤：試験、その１　Ａ"),
        ("name: storm", 'name: "暴風：{Ｈ，１}"  # 備考：{x， y}'),
        ("draught: 3 m", "draught: ３ m"),
    )
    case = read(text)
    assert case.model.structure.draught == 3.0
    assert case.title == "浮消波堤：試験、その１　Ａ"


def test_panels_are_counted_before_they_are_built():
    from moyai.potential.mesh import MOST_PANELS, Resolution, lay_out
    from moyai.potential.shapes import rectangle

    section = rectangle(100.0, 1.0).immersed(1e-3)
    with pytest.raises(InputError, match=f"more than {MOST_PANELS} panels"):
        lay_out(section, 10.0, (0.01, 1e4), Resolution())
    lay_out(rectangle(10.0, 4.5).immersed(3.0), 10.0, (0.01, 5.0), Resolution())


@pytest.mark.parametrize("section", [COMB, PLATE])
def test_odd_sections_end_soon_with_at_most_one_message(section):
    faults(CASE)  # compiled kernels are loaded
    start = time.process_time()
    found = faults(changed((SECTION, section)))
    assert time.process_time() - start < 2.0
    assert len(found) <= 1, found


def test_bounds_of_kinds_hold_wherever_a_quantity_stands():
    for kind in ("a length", "a mass", "a force", "a time", "a speed", "a density", "a number"):
        assert kind in kind_bounds()
    for row in all_ranges():
        assert row.possible[0] <= row.usual[0] <= row.usual[1] <= row.possible[1], row
        assert row.source in range_sources(), row
        assert row.what and row.quantity


def test_the_page_of_ranges_is_up_to_date(request):
    page = (request.config.rootpath / "docs" / "answer" / "plausibility.md").read_text(encoding="utf-8")
    assert renew(page) == page, "run: python -m moyai.case.plausibility_page docs/answer/plausibility.md"


@pytest.mark.slow
def test_every_fifth_slip_of_a_thousand_in_the_templates_is_reported():
    """A sample of the measure of ``slips.py``; the number of the first one is drawn from the file's own length."""
    found: list[slips.Slip] = []
    for kind in slips.TEMPLATES:
        text = template(kind)
        found += slips.slips(f"template {kind}", text, slips.ROOT, every=5, first=len(text) % 5)
    print(slips.table(found))
    assert {slip.outcome for slip in found} <= {"stopped", "warned", "silent"}
    for structure in {slip.structure for slip in found}:
        group = [slip for slip in found if slip.structure == structure]
        assert sum(slip.reported for slip in group) >= 0.8 * len(group), slips.table(found)


@pytest.mark.slow
def test_slips_in_designs_that_the_ranges_did_not_see_are_reported():
    found = [slip for name, text, folder in slips.designs() for slip in slips.slips(name, text, folder)]
    assert {slip.outcome for slip in found} <= {"stopped", "warned", "silent"}
    assert sum(slip.reported for slip in found) >= 0.8 * len(found), slips.table(found)


@pytest.mark.slow
def test_four_of_five_slips_of_five_hundred_are_reported():
    found = [slip for name, text, folder in slips.sources() for slip in slips.slips(name, text, folder, every=4)]
    print(slips.table(found))
    assert {slip.outcome for slip in found} <= {"stopped", "warned", "silent"}
    for structure in {slip.structure for slip in found}:
        group = [slip for slip in found if slip.structure == structure]
        assert sum(slip.reported for slip in group) >= 0.8 * len(group), slips.table(found)


def test_an_extreme_is_one_message_never_a_traceback():
    """Each number of the breakwater's template as 1e150 and -1e-150 in its own unit."""
    text = template("breakwater")
    document = parse_yaml(text, "template")
    for path, value in slips.numbers(document.data):
        for extreme in (1e150, -1e-150):
            unit = value[slips._NUMBER.match(value).end() :] if isinstance(value, str) else ""
            odd = slips.with_value(document, path, f"{extreme:g}{unit}" if unit else extreme)
            with pytest.raises(CaseError):
                case_of(odd, slips.ROOT / "case.yaml")
