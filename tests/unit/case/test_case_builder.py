"""From case files to problems: units, directions, defaults, hashes."""
# ruff: noqa: E501  (one variation a line reads best)

import math

import numpy as np
import pytest
from case_files import CASE, changed, faults, read
from hypothesis import given
from hypothesis import strategies as st

from moyai.case.builder import build
from moyai.case.headings import heading_of
from moyai.case.reader import load_case
from moyai.case.schema_environment import SiteCurrentKeys, WindKeys
from moyai.core.errors import InputError
from moyai.structures.breakwater.model import IrregularSea, MooringLine, MooringSpring, RegularSea
from moyai.tables.lines import line_type


def problem(*changes):
    return build(read(changed(*changes)))


def test_the_whole_case_arrives_in_si_units():
    found = problem()
    unit, environment = found.breakwater, found.environment
    assert (unit.length, unit.draught, unit.mass, unit.roll_gyradius) == (21.0, 3.0, None, 2.67)
    assert unit.centre_of_gravity == (0.0, 2.29)
    assert (unit.hull.beam, unit.hull.height) == (10.0, 4.5)
    assert unit.damping.fraction_of_critical == 0.15
    assert environment.water_levels == (("HWL", 1.5), ("LWL", 0.0))
    assert (environment.water.depth, environment.water.density, environment.water.gravity) == (10.0, 1025.0, 9.81)
    regular, storm = environment.sea_states
    assert regular == RegularSea("operation", 0.6, (4.0, 5.0, 6.0), 0.0)
    assert isinstance(storm, IrregularSea)
    assert storm.heading == pytest.approx(math.radians(10.0), rel=1e-15)
    assert storm.spectrum.significant_height == pytest.approx(1.0, rel=1e-3)
    assert storm.spectrum.peak_period == pytest.approx(5.0, rel=1e-3)
    assert (storm.duration, storm.seed) == (10800.0, 1)
    assert environment.current.speed(-3.0) == pytest.approx(0.3)
    line = unit.lines[0]
    assert isinstance(line, MooringLine)
    assert (line.fairlead, line.anchor) == ((-5.0, 0.0, 0.0), (-57.5, 0.0, 0.0))
    chain = line_type("studless_chain_R3", 0.068)
    assert line.segments[0].line_type.submerged_weight == chain.submerged_weight_per_length(1025.0, 9.81)
    assert line.segments[0].line_type.breaking_load == chain.breaking_load
    assert found.analyses == ("statics", "mooring", "frequency", "time")
    assert found.case_text == CASE


def test_one_problem_whatever_the_units():
    """The same case in other units gives the same numbers and the same hash."""
    other = changed(
        ("water_depth: 10 m", "water_depth: 1000 cm"),
        ("1025 kg/m3", "1.025 t/m^3"),
        ("peak_period: 5 s", "peak_period: 5000 ms"),
        ("length: 21 m", "length: 0.021 km"),
        ("heading_deg: 10", "heading_deg: 10 deg"),
        ("title: Test pontoon", "# a remark\ntitle: 'Test pontoon'"),
        ("diameter: 68 mm", "diameter: 0.068"),
    )
    first, second = read(CASE), read(other)
    assert first.case_hash == second.case_hash
    assert build(first).environment.water == build(second).environment.water
    assert first.case_hash != read(changed(("draught: 3 m", "draught: 3.001 m"))).case_hash


def test_order_of_keys_does_not_change_the_hash():
    moved = CASE.replace("  length: 21 m\n", "").replace("  draught: 3 m\n", "  draught: 3 m\n  length: 21 m\n")
    assert read(moved).case_hash == read(CASE).case_hash


def test_the_hash_knows_the_files_that_a_case_names(tmp_path):
    text = changed(
        ("kind: jonswap\n    significant_height: 1.0 m\n    peak_period: 5 s\n    peak_enhancement: 3.3",
         "kind: spectrum_file\n    file: sea.csv")
    )  # fmt: skip
    path = tmp_path / "case.yaml"
    path.write_text(text, encoding="utf-8")
    (tmp_path / "sea.csv").write_text("frequency,density\n0.1,0.1\n0.2,0.9\n0.3,0.2\n")
    first = load_case(path)
    spectrum = build(first).environment.sea_states[1].spectrum
    assert spectrum.omega == pytest.approx(2.0 * math.pi * np.array([0.1, 0.2, 0.3]))
    (tmp_path / "sea.csv").write_text("frequency,density\n0.1,0.1\n0.2,0.8\n0.3,0.2\n")
    assert load_case(path).case_hash != first.case_hash


def test_a_faulty_spectrum_file_is_reported_with_its_row(tmp_path):
    text = changed(
        ("kind: jonswap\n    significant_height: 1.0 m\n    peak_period: 5 s\n    peak_enhancement: 3.3",
         "kind: spectrum_file\n    file: sea.csv")
    )  # fmt: skip
    (tmp_path / "sea.csv").write_text("frequency,density\n0.1,0.1\n0.3,0.9\n0.2,0.2\n")
    (fault,) = faults(text, tmp_path)
    assert "case.yaml:16:11: waves[1].file: sea.csv: " in fault
    assert "4" in fault


@pytest.mark.parametrize(
    ("axis", "bearing", "heading"),
    [
        # +x points south-west (240): a wave from 60 (ENE) travels along +x, one from 330 (NW) to 150
        (240.0, 60.0, 0.0),
        (240.0, 150.0, -90.0),
        (240.0, 330.0, 90.0),
        (240.0, 240.0, 180.0),
        # +x points east, +y north: waves from the south travel towards +y
        (90.0, 180.0, 90.0),
        (90.0, 270.0, 0.0),
        (0.0, 180.0, 0.0),
    ],
)
def test_bearings_become_headings(axis, bearing, heading):
    wind = WindKeys.model_validate({"speed": 1.0, "density": 1.2, "from_bearing_deg": bearing})
    assert math.degrees(heading_of(wind, axis, "wind")) == pytest.approx(heading, abs=1e-12)
    towards = SiteCurrentKeys.model_validate({"speed": 1.0, "to_bearing_deg": (bearing + 180.0) % 360.0})
    assert math.degrees(heading_of(towards, axis, "current")) == pytest.approx(heading, abs=1e-12)


@given(st.floats(-360.0, 360.0), st.floats(-360.0, 360.0))
def test_a_heading_points_where_the_compass_says(axis, bearing):
    """The direction of travel as a vector in east and north, once by the bearing and once by axes and heading."""
    wind = WindKeys.model_validate({"speed": 1.0, "density": 1.2, "from_bearing_deg": bearing})
    heading = heading_of(wind, axis, "wind")
    assert -math.pi < heading <= math.pi
    turn = math.radians(axis)
    x_axis = np.array([math.sin(turn), math.cos(turn)])
    y_axis = np.array([-x_axis[1], x_axis[0]])
    travel = math.cos(heading) * x_axis + math.sin(heading) * y_axis
    comes_from = np.array([math.sin(math.radians(bearing)), math.cos(math.radians(bearing))])
    assert travel == pytest.approx(-comes_from, abs=1e-12)


def test_a_bearing_needs_the_axis():
    wind = WindKeys.model_validate({"speed": 1.0, "density": 1.2, "from_bearing_deg": 10.0})
    with pytest.raises(InputError, match="x_axis_bearing_deg"):
        heading_of(wind, None, "wind")


def test_springs_clumps_and_own_segments():
    found = problem(
        ("- {catalogue: studless_chain_R3, diameter: 68 mm, length: 54.0 m}",
         "- {length: 40 m, submerged_mass: 79.2 kg/m, axial_stiffness: 390 MN, breaking_load: 3.4 MN}\n"
         "      - {clump: {mass: 2 t, volume: 0.8 m3}}\n"
         "      - {length: 14 m, submerged_weight: 777 N/m, axial_stiffness: inextensible}"),
        ("  - name: shoreward\n    count: 2", "  - name: shoreward\n    kind: spring\n    count: 3"),
        ("    anchor: {x: 57.5 m}\n    segments:\n      - {catalogue: studless_chain_R3, diameter: 68 mm, length: 54.0 m}",
         "    anchor: {x: 57.5 m, z: -2 m}\n    stiffness: 30 kN/m\n    pretension: 50 kN"),
    )  # fmt: skip
    line, spring = found.breakwater.lines
    assert [segment.length for segment in line.segments] == [40.0, 14.0]
    assert line.segments[0].line_type.submerged_weight == pytest.approx(79.2 * 9.81)
    assert line.segments[0].line_type.axial_stiffness == 390e6
    assert math.isinf(line.segments[1].line_type.axial_stiffness)
    assert line.clumps[0].after_segment == 0
    assert line.clumps[0].submerged_weight == pytest.approx((2000.0 - 1025.0 * 0.8) * 9.81)
    assert isinstance(spring, MooringSpring)
    assert (spring.count, spring.anchor, spring.stiffness, spring.pretension) == (3, (57.5, 0.0, -2.0), 30e3, 50e3)


def test_inertia_and_damping_forms():
    found = problem(
        ("draught: 3 m", "mass: 618.6 t"),
        ("roll_gyradius: 2.67 m", "roll_inertia: 4.41e3 t m2"),
        ("  wind_drag", "  roll_damping: {linear: 2 kN m s, quadratic: 3 kN m s2}\n"
         "  additional_damping: {sway: 8.7 N s/m, roll: 1 kN m s}\n  additional_mass: {sway: 303 g}\n  wind_drag"),
    )  # fmt: skip
    unit = found.breakwater
    assert unit.roll_gyradius == pytest.approx(math.sqrt(4.41e6 / 618600.0))
    assert unit.damping.linear == (8.7, 0.0, 3000.0)
    assert unit.damping.roll_quadratic == 3000.0
    assert unit.additional_mass == (0.303, 0.0, 0.0)


def test_settings_reach_the_problem():
    found = problem(
        ("analyses:", "settings:\n  drift: false\n  frequencies: {from: 0.1 Hz, to: 0.2 Hz, count: 3}\n"
         "  restoring_offsets: [-1, 0, 1]\n  water_levels: [LWL]\n"
         "  time: {duration: 5 min, time_step: 20 ms, ramp: auto, drift: newman, memory: convolution}\n"
         "  sensitivity: {damping_fractions: [0, 5 %], line_slacks: [3 cm], line_counts: [2, 4]}\nanalyses:"),
    )  # fmt: skip
    settings = found.settings
    assert settings.drift is False
    assert settings.angular_frequencies() == pytest.approx(2.0 * math.pi * np.array([0.1, 0.15, 0.2]))
    assert settings.offsets() == pytest.approx([-1.0, 0.0, 1.0])
    assert found.environment.water_levels == (("LWL", 0.0),)
    assert (settings.time.duration, settings.time.time_step, settings.time.ramp) == (300.0, 0.02, None)
    assert (settings.time.drift, settings.time.memory) == ("newman", "convolution")
    assert settings.sensitivity.damping_fractions == (0.0, 0.05)
    assert settings.sensitivity.line_counts == (2, 4)


@pytest.mark.parametrize(
    ("wave", "peak"),
    [
        ("kind: jonswap, significant_height: 1 m, significant_period: 5 s, peak_enhancement: 3.3", 5.0 / (1 - 0.132 * 3.5**-0.559)),
        ("kind: pierson_moskowitz, significant_height: 1 m, peak_period: 5 s", 5.0),
        ("kind: bretschneider_mitsuyasu, significant_height: 1 m, significant_period: 5 s", 5.0 * 1.0496),
        ("kind: tma, significant_height: 1 m, peak_period: 5 s, peak_enhancement: 3.3", None),
    ],
)  # fmt: skip
def test_every_spectrum(wave, peak):
    start, end = CASE.index("waves:"), CASE.index("wind:")
    spread = "spreading: {kind: mitsuyasu, maximum_exponent: 10}"
    text = CASE[:start] + f"waves: {{{wave}, heading_deg: 0, {spread}, seed: 7}}\n" + CASE[end:]
    (sea,) = build(read(text)).environment.sea_states
    assert sea.name == wave.split(",")[0].removeprefix("kind: ")
    assert sea.seed == 7
    assert sea.spectrum.significant_height == pytest.approx(1.0, rel=5e-3)
    if peak is not None:
        assert sea.spectrum.peak_period == pytest.approx(peak, rel=2e-3)
    assert sea.spreading.maximum_exponent == 10.0


def test_current_profiles():
    table = problem(("current: {speed: 0.3 m/s,", "current: {profile: {table: [[-10, 0.1], [0, 0.4]]},"))
    assert table.environment.current.speed(np.array([-10.0, -5.0, 0.0])) == pytest.approx([0.1, 0.25, 0.4])
    power = problem(("current: {speed: 0.3 m/s,", "current: {speed: 0.3 m/s, profile: {power_law: 0.5},"))
    assert float(power.environment.current.speed(-7.5)) == pytest.approx(0.3 * 0.5)


def test_polygons_may_run_either_way():
    text = "{{shape: polygon, points: {}}}"
    one = problem(
        ("{shape: rectangle, beam: 10 m, height: 4.5 m}", text.format("[[-5, 0], [5, 0], [4, 4.5], [-4, 4.5]]"))
    )
    two = problem(
        ("{shape: rectangle, beam: 10 m, height: 4.5 m}", text.format("[[-4, 4.5], [4, 4.5], [5, 0], [-5, 0]]"))
    )
    assert one.breakwater.hull.immersed(3.0).area == pytest.approx(two.breakwater.hull.immersed(3.0).area, rel=1e-14)
    assert one.breakwater.hull.immersed(3.0).area == pytest.approx(3.0 * 0.5 * (10.0 + 10.0 - 2.0 * 3.0 / 4.5))


def test_coefficients_file_options(tmp_path):
    (tmp_path / "box.1").write_text("")
    text = changed(
        ("  wind_drag", "  coefficients_file: {program: wamit, path: box.1, sea: beam, origin: [1, 2], length_scale: 1 m}\n  wind_drag")
    )  # fmt: skip
    given_file = build(read(text, tmp_path)).breakwater.coefficients_file
    assert given_file.program == "wamit"
    assert given_file.path == tmp_path / "box.1"
    assert given_file.options == {
        "sea": "beam", "origin": (1.0, 2.0), "density": 1025.0, "gravity": 9.81, "length_scale": 1.0,
    }  # fmt: skip
