"""Case files in another size: the whole of a run is the same in both, to rounding, and the text stays what it was."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from moyai.case.builder import build
from moyai.case.criteria import criteria_of
from moyai.case.reader import case_of, load_case
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import InputError
from moyai.core.progress import silent
from moyai.core.quantities import parse_quantity
from moyai.design.model_needs import model_need
from moyai.design.model_numbers import WaterMotion, check_numbers, model_numbers
from moyai.design.similarity import Scale, scale_quantities, scale_water
from moyai.sea.water import Water
from moyai.structures.cage.case.build_flexible import rope_of
from moyai.structures.curtain.impact.cable import Impact, impact_numbers, peak_by_energy
from moyai.structures.network.case.build import bar_type_of
from moyai.study.scaled_case import scale_case
from moyai.study.scaled_files import scaled_files
from moyai.study.scaled_motion import motions_of
from moyai.study.scaled_text import written_in
from moyai.tables.waters import water_of_density, water_properties

SHORT = (
    template("breakwater")
    .replace("analyses: [statics, mooring, frequency, time]", "analyses: [statics, mooring, frequency]")
    .replace("water_levels: {HWL: 1.5 m, LWL: 0 m} ", "water_levels: {MSL: 0.5 m} ")
    .replace("count: 11}", "count: 2}")
    .replace("frequencies: auto", "frequencies: [0.9, 1.3]")
)


def read(text, tmp_path, name="unit.yaml"):
    path = tmp_path / name
    path.write_text(text, encoding="utf-8")
    return load_case(path)


@pytest.mark.slow
@pytest.mark.parametrize(
    "length", [pytest.param(26.0, marks=pytest.mark.slow), float(np.random.default_rng(11).uniform(5, 60))]
)
def test_whole_breakwater_is_the_same_in_both_sizes(length, tmp_path):
    """Every variable of every group, sway and heave where there are motions: ratio of its unit, to rounding."""
    from moyai.cli.runner import run

    case = read(SHORT, tmp_path)
    scaled = scale_case(case, Scale(length, 1.025, 1.0), digits=17)
    large, small = (run(item, silent) for item in (case, scaled.case))
    compared = 0
    for group in large.tree.subtree:
        for name, variable in group.data_vars.items():
            if variable.dtype.kind not in "fc":
                continue
            mate = small.tree[group.path][name]
            for dim in [dim for dim in variable.dims if str(dim).endswith("dof")]:
                kept = [label for label in variable[dim].values if label != "roll"]
                variable, mate = variable.sel({dim: kept}), mate.sel({dim: kept})
            if "mode_shape" in name:
                continue  # metres and radians in one vector
            unit = str(variable.attrs.get("units", ""))
            ratio = scaled.scale.ratio("" if unit in ("1", "-") else unit)
            values, others = np.asarray(variable.values), np.asarray(mate.values) * ratio
            known = np.isfinite(values)
            assert np.array_equal(known, np.isfinite(others)), (group.path, name)
            if known.any():
                # coefficients of the longest wave (kB = 0.03) lose digits to cancellation
                tolerance = 1e-5 if "hydrodynamics" in group.path else 1e-9
                size = np.abs(values[known]).max()
                assert np.abs(values[known] - others[known]).max() <= tolerance * size, (group.path, name)
                compared += 1
    assert compared > 60


def test_impact_scales_to_rounding():
    """S^3 on the tension and the same numbers of the paper at random flumes."""
    rng = np.random.default_rng(12)
    for _ in range(40):
        scale = Scale(10.0 ** rng.uniform(0.2, 2), rng.uniform(0.97, 1.03), 1.0)
        span, draught, depth = rng.uniform(5, 30), rng.uniform(1, 6), rng.uniform(8, 20)
        sea = Water(depth, 1025.0, 9.81)
        figures = {
            "span": (span, "m"),
            "length": (span * rng.uniform(1.02, 1.5), "m"),
            "draught": (draught, "m"),
            "upper_stiffness": (rng.uniform(1e5, 1e7), "N"),
            "lower_stiffness": (rng.uniform(1e5, 1e7), "N"),
            "speed": (rng.uniform(0.1, 1.0), "m/s"),
        }
        rows = scale_quantities(figures, scale)
        large = Impact(water=sea, **{row.name: row.prototype for row in rows})
        small = Impact(water=scale_water(sea, scale), **{row.name: row.model for row in rows})
        peak, little = peak_by_energy(large), peak_by_energy(small)
        assert scale.to_prototype(little.tension, "N") == pytest.approx(peak.tension, rel=1e-9)
        assert scale.to_prototype(little.time, "s") == pytest.approx(peak.time, rel=1e-8)
        one, two = impact_numbers(large, peak.tension), impact_numbers(small, little.tension)
        assert two.tension_coefficient == pytest.approx(one.tension_coefficient, rel=1e-9)
        assert two.cauchy_number == pytest.approx(one.cauchy_number, rel=1e-12)
        assert two.froude_number == pytest.approx(one.froude_number, rel=1e-12)


def test_there_and_back_gives_the_case_given(tmp_path):
    case = read(SHORT, tmp_path)
    rng = np.random.default_rng(13)
    for _ in range(3):
        length, density = float(rng.uniform(2, 80)), float(rng.uniform(0.97, 1.03))
        there = scale_case(case, Scale(length, density, 1.0), digits=17)
        back = scale_case(there.case, Scale(length, density, 1.0), from_model=True, digits=17)
        before, after = dict(numbers_of(case.model)), dict(numbers_of(back.case.model))
        shared = [path for path in before if path in after and "segments" not in path]
        assert len(shared) > 25
        for path in shared:
            assert after[path] == pytest.approx(before[path], rel=1e-13), path
        assert back.text.count("made by 'moyai scale'") == 1
        assert not any("]  [" in line for line in back.text.splitlines())


def numbers_of(value, path=""):
    dump = value.model_dump() if hasattr(value, "model_dump") else value
    if isinstance(dump, dict):
        for key, inner in dump.items():
            yield from numbers_of(inner, f"{path}.{key}")
    elif isinstance(dump, (list, tuple)):
        for index, inner in enumerate(dump):
            yield from numbers_of(inner, f"{path}[{index}]")
    elif isinstance(dump, float) and np.isfinite(dump):
        yield path, dump


def test_text_keeps_order_units_and_comments(tmp_path):
    scaled = scale_case(read(SHORT, tmp_path), Scale(26.0, 1.025, 1.0))
    text = scaled.text
    assert "  gravity: 9.81 m/s2\n" in text and "heading_deg: 0" in text and "peak_enhancement: 3.3" in text
    assert "# at datum; or: infinite  [10 m (1/26)]" in text
    assert "section: {shape: rectangle, beam: 0.3846154 m, height: 0.1730769 m}  # 10 m (1/26); 4.5 m (1/26)" in text
    assert "catalogue: studless" not in text.replace("  # other", "")
    assert scaled.case.title == "Floating breakwater (model 1:26)"
    assert [line for line in text.splitlines() if line.startswith("analyses")] == [
        line for line in SHORT.splitlines() if line.startswith("analyses")
    ]


def test_defaults_with_a_dimension_are_written_out(tmp_path):
    text = SHORT.replace("    duration: 3 h                         # of the time-domain run\n", "")
    assert text != SHORT
    scaled = scale_case(read(text, tmp_path), Scale(25.0, 1.0, 1.0))
    assert scaled.case.model.waves[1].duration == pytest.approx(10800.0 / 5.0)
    assert "left to its default" in scaled.text


def test_forms_of_a_file(tmp_path):
    """Plain numbers, quotes, words, tables, one sea state without its list, springs, block-style segments."""
    text = SHORT.split("waves:")[0] + (
        "waves: {kind: regular, height: 1.0, periods: [4, '5 s'], heading_deg: 0}\n"
        "current: {heading_deg: 0, profile: {table: [[-10 m, 0.1], [0, 0.4 m/s]]}}\n"
        + "structure:"
        + SHORT.split("structure:")[1].split("lines:")[0]
        + "lines:\n"
        "  - {name: s, kind: spring, fairlead: {x: 1 m, above_keel: 0}, anchor: {x: 30, z: -3},"
        " stiffness: 30 kN/m, pretension: 10 kN}\n"
        "  - name: own\n    fairlead: {x: -5 m, above_keel: 0 m}\n    anchor: {x: -57.5 m}\n    segments:\n"
        "      - length: 54 m\n        submerged_weight: 777 N/m\n        axial_stiffness: inextensible\n"
        "      - catalogue: studless_chain_R3\n        diameter: 68 mm\n        length: 5 m\n"
        "analyses: [statics]\n"
    )
    scaled = scale_case(read(text, tmp_path), Scale(100.0, 1.0, 1.0), digits=12)
    model = scaled.case.model
    assert model.waves[0].periods == pytest.approx((0.4, 0.5))
    assert model.current.profile.table == pytest.approx(np.array([[-0.1, 0.01], [0.0, 0.04]]))
    assert model.lines[0].stiffness == pytest.approx(3.0)
    assert model.lines[0].pretension == pytest.approx(0.01)
    assert model.lines[1].segments[0].axial_stiffness == np.inf
    assert model.lines[1].segments[1].diameter == pytest.approx(0.00068)
    assert model.lines[1].segments[1].length == pytest.approx(0.05)


def test_infinite_depth_stays(tmp_path):
    text = SHORT.replace("water_depth: 10 m", "water_depth: infinite")
    text = text.split("lines:")[0] + "analyses: [statics]\n"
    scaled = scale_case(read(text.replace("current:", "# current:"), tmp_path), Scale(30.0, 1.0, 1.0))
    assert scaled.case.model.site.water_depth == np.inf


def test_measured_points_and_spectra_are_scaled(tmp_path):
    """Columns by the unit of their heading; a spectrum keeps its significant height and peak over the scale."""
    points = "# flume\nperiod [s];transmission_coefficient;sway [mm]\n4;0.5;120\n5;;80\n"
    (tmp_path / "points.csv").write_text(points, encoding="utf-8")
    rng = np.random.default_rng(17)
    frequency = np.linspace(0.05, 0.6, 60)
    density = 2.0 * np.exp(-(((frequency - 0.2) / 0.04) ** 2)) + 0.01 * rng.random(60)
    rows = "\n".join(f"{d} {f}" for f, d in zip(frequency, density, strict=True))
    (tmp_path / "sea.txt").write_text(f"S f\n{rows}\n", encoding="utf-8")
    columns = "frequency_column: f, density_column: S"
    extra = f"  - {{name: own, kind: spectrum_file, file: sea.txt, {columns}, heading_deg: 0}}\n\nwind:"
    text = SHORT.replace("\nwind:", extra, 1) + "measured: {file: points.csv}\n"
    case = read(text, tmp_path)
    scale = Scale(25.0, 1.0, 1.0)
    scaled = scale_case(case, scale, digits=17)
    files = dict(scaled.files)
    assert set(files) == {"model_points.csv", "model_sea.csv"}
    assert files["model_points.csv"].splitlines() == [
        "# flume", "period [s];transmission_coefficient;sway [mm]", "0.8;0.5;4.8", "1.0;;3.2",
    ]  # fmt: skip
    table = np.array([[float(v) for v in row.split(",")] for row in files["model_sea.csv"].splitlines()[2:]])
    assert table[:, 0] == pytest.approx(5.0 * frequency)
    assert np.trapezoid(table[:, 1], table[:, 0]) * 625.0 == pytest.approx(np.trapezoid(density, frequency), rel=1e-12)
    own = scaled.case.model.waves[2]
    assert (own.file, own.frequency_column, own.density_column) == ("model_sea.csv", 1, 2)
    for name, content in scaled.files:
        (tmp_path / name).write_text(content, encoding="utf-8")
    back = scale_case(read(scaled.text, tmp_path, "m.yaml"), scale, from_model=True, digits=17)
    assert dict(back.files)["prototype_model_points.csv"].splitlines()[2] == "4.0;0.5;120.0"


def test_files_of_other_programs_are_refused(tmp_path):
    case = read(SHORT, tmp_path)
    data = {**case.document.data, "structure": {"coefficients_file": {"path": "box.nc"}}}
    other = replace(case, document=replace(case.document, data=data))
    with pytest.raises(InputError, match=r"box\.nc") as caught:
        scaled_files(other, Scale(26.0, 1.0, 1.0), False)
    assert caught.value.fault.path == "structure.coefficients_file.path"


def test_one_figure_for_two_kinds_is_refused(tmp_path):
    text = SHORT.replace("water_depth: 10 m", "water_depth: &ten 10").replace("speed: 25 m/s", "speed: *ten")
    with pytest.raises(InputError, match="alias"):
        scale_case(read(text, tmp_path), Scale(26.0, 1.0, 1.0))
    shared = SHORT.replace("water_depth: 10 m", "water_depth: &ten 10").replace("beam: 10 m", "beam: *ten")
    same = scale_case(read(shared, tmp_path), Scale(20.0, 1.0, 1.0))
    assert same.case.model.structure.section.beam == pytest.approx(0.5)


def test_values_are_written_readably():
    assert written_in(0.0031, "t") == "3.1 kg"
    assert written_in(0.5, "m") == "0.5 m"
    assert written_in(0.0026, "m") == "2.6 mm"
    assert written_in(12345.0, "N") == "12.345 kN"
    assert written_in(1500.0, "mm") == "1.5 m"
    assert written_in(0.04, "") == "0.04"
    rng = np.random.default_rng(14)
    for unit in ("t", "kN/m", "MPa", "h", "mm", "kg m2", "kn"):
        for value in 10.0 ** rng.uniform(-6, 6, 20):
            written = parse_quantity(written_in(float(value), unit, 17)).si
            assert written == pytest.approx(parse_quantity(f"{float(value)!r} {unit}").si, rel=1e-14)


def test_numbers_kept_and_not_kept():
    rng = np.random.default_rng(15)
    sea, fresh = water_properties("sea"), water_properties("fresh")
    assert water_of_density(1025.0) == sea and water_of_density(1000.0) == fresh
    for _ in range(30):
        scale = Scale(10.0 ** rng.uniform(0.3, 2), 1.025, 1.0)
        motion = WaterMotion(rng.uniform(0.1, 2), rng.uniform(0.01, 5), rng.uniform(3, 9), rng.uniform(5, 30))
        found = {
            number.name: number for number in model_numbers(scale, motion, gravity=9.81, prototype=sea, model=fresh)
        }
        for name in ("Froude (size)", "Froude (depth)", "Keulegan-Carpenter"):
            assert found[name].kept and found[name].model == pytest.approx(found[name].prototype, rel=1e-13)
        ratio = found["Reynolds"].prototype / found["Reynolds"].model
        assert ratio == pytest.approx(scale.length**1.5 * fresh.viscosity / sea.viscosity, rel=1e-12)
        weber = found["Weber"].prototype / found["Weber"].model
        assert weber == pytest.approx(
            scale.density * scale.length**2 * fresh.surface_tension / sea.surface_tension, rel=1e-12
        )
        assert not found["Reynolds"].kept and found["density of one material"].model == 1.025
    small = Scale(100.0, 1.025, 1.0)
    motion = WaterMotion(0.3, 0.05, 2.0, 8.0)
    numbers = model_numbers(small, motion, gravity=9.81, prototype=sea, model=fresh)
    codes = {n.code for n in check_numbers(small, motion, numbers, gravity=9.81, prototype=sea, model=fresh)}
    assert codes == {"similarity-period", "similarity-reynolds", "similarity-capillary"}


def test_needs_of_a_model():
    scale = Scale(20.0, 1.025, 1.0)
    figures = {"EA": (890.0, "kN"), "K": (890.0, "kN/m"), "m": (4.55, "kg/m"), "U": (0.5, "m/s")}
    ea, spring, mass, speed = scale_quantities(figures, scale)
    stiff = model_need(ea, 2.0, "kN", scale, line_length=46.0)
    series = float(stiff.remedy.split()[2])
    together = 2.3 / (2.3 / 2000.0 + 1.0 / series)
    assert together == pytest.approx(890e3 / 1.025 / 8000.0, rel=1e-4)
    assert stiff.over == pytest.approx(2000.0 / (890e3 / 1.025 / 8000.0))
    found = model_need(spring, 5.0, "kN/m", scale)
    assert 1.0 / (1.0 / 5000.0 + 1.0 / float(found.remedy.split()[2])) == pytest.approx(890e3 / 1.025 / 400, rel=1e-4)
    assert model_need(mass, 5.0, "g/m", scale).remedy.startswith("add 0.00609")
    assert "too soft" in model_need(ea, 1.0, "N", scale, line_length=46.0).remedy
    assert "too soft" in model_need(spring, 1.0, "N/m", scale).remedy
    for call, words in (
        (lambda: model_need(ea, 2.0, "kN", scale), "length of the line"),
        (lambda: model_need(ea, 2.0, "kg", scale, line_length=1.0), "same kind"),
        (lambda: model_need(ea, -2.0, "kN", scale, line_length=1.0), "not positive"),
    ):
        with pytest.raises(InputError) as caught:
            call()
        assert words in str(caught.value.fault)
    assert model_need(speed, 0.2, "m/s", scale).remedy.startswith("no part")


def test_motion_of_a_case(tmp_path):
    """Speed of the largest regular or irregular wave at the surface and the current together."""
    case = read(SHORT, tmp_path)
    scaled = scale_case(case, Scale(26.0, 1.025, 1.0))
    found = motions_of(scaled, case)
    assert set(found) == {"structure", "thinnest member"}
    assert found["thinnest member"].across == pytest.approx(0.068)
    assert found["structure"].period == 3.0
    assert found["structure"].speed == pytest.approx(0.3 + np.pi * 0.8 / 3.0, rel=2e-2)
    # in the wave that is steepest at its period the speed is that of linear theory
    back = scale_case(scaled.case, Scale(26.0, 1.025, 1.0), from_model=True)
    again = motions_of(back, scaled.case)
    assert again["structure"].speed == pytest.approx(found["structure"].speed, rel=1e-5)


def test_a_case_out_of_range_is_refused(tmp_path):
    case = read(SHORT, tmp_path)
    with pytest.raises(InputError, match="digits"):
        scale_case(case, Scale(26.0, 1.0, 1.0), digits=2)
    assert case_of(parse_yaml(case.text), case.path).case_hash == case.case_hash


def curtain_case(tmp_path, **changes):
    text = template("curtain").replace("water_levels: {HWL: 1.5 m, LWL: 0 m} ", "water_levels: {MSL: 0.5 m} ")
    for old, new in changes.items():
        text = text.replace(old, new)
    return read(text, tmp_path, "curtain.yaml")


def test_makes_of_a_curtain_become_figures(tmp_path):
    """Wire of the catalogue, chain and film: EA with the cube, weights with the square of the scale and the water."""
    from moyai.structures.curtain.case.build import curtain_of

    rng = np.random.default_rng(16)
    path = tmp_path / "film.yaml"
    text = template("curtain").replace(
        "    stiffness: 900 kN/m ", "    film: {material: polyethylene_film, thickness: 1 mm} "
    )
    text = text.replace("    submerged_weight: 4 N/m2 ", "    # weight of the film ")
    path.write_text(text, encoding="utf-8")
    chain = "    chain_mass: 20 kg/m "
    toes = [
        curtain_case(tmp_path, **{chain: toe})
        for toe in ("    weight: 170 N/m ", f"    chain_density: 7000 kg/m3\n{chain}")
    ]
    for case in (curtain_case(tmp_path), load_case(path), *toes):
        scale = Scale(float(rng.uniform(3, 40)), 1.025, 1.0)
        scaled = scale_case(case, scale, digits=17)
        sites = [item.model.site for item in (case, scaled.case)]
        large, small = (
            curtain_of(item.model, Water(site.water_depth, site.density, site.gravity))
            for item, site in zip((case, scaled.case), sites, strict=True)
        )
        for name, unit in (("upper_stiffness", "N"), ("lower_stiffness", "N"), ("span", "m")):
            assert scale.to_prototype(getattr(small, name), unit) == pytest.approx(getattr(large, name), rel=1e-12)
        for name, unit in (("toe_load", "N/m"), ("submerged_weight", "N/m2"), ("stiffness", "N/m"), ("length", "m")):
            value = scale.to_prototype(getattr(small.skirt, name), unit)
            assert value == pytest.approx(getattr(large.skirt, name), rel=1e-12, abs=1e-12), name
        strengths = [item.strengths.lower_cable.capacity for item in (large, small)]
        assert scale.to_prototype(strengths[1], "N") == pytest.approx(strengths[0], rel=1e-12)
        assert "wire_6x19" not in scaled.text.replace("figures of wire_6x19", "")


@pytest.mark.slow
def test_whole_curtain_is_the_same_in_both_sizes(tmp_path):
    """Statics, impact models and anchor loads of a case file in both sizes: every variable to rounding."""
    from moyai.cli.runner import run

    case = curtain_case(
        tmp_path, **{"[statics, impact, waves, anchor_loads, limits]": "[statics, impact, anchor_loads]"}
    )
    scaled = scale_case(case, Scale(20.0, 1.025, 1.0), digits=17)
    large, small = (run(item, silent) for item in (case, scaled.case))
    compared = 0
    for group in large.tree.subtree:
        for name, variable in group.data_vars.items():
            # planning formulas know one water only, also among the loads compared; loads of mixed units follow below
            if (
                variable.dtype.kind not in "fc"
                or name.startswith(("planning", "compared"))
                or group.path.endswith("/loads")
            ):
                continue
            unit = str(variable.attrs.get("units", ""))
            ratio = scaled.scale.ratio("" if unit in ("1", "-") else unit)
            values = np.asarray(variable.values)
            others = np.asarray(small.tree[group.path][name].values) * ratio
            known = np.isfinite(values)
            assert np.array_equal(known, np.isfinite(others)), (group.path, name)
            if known.any():
                # a held toe has no flare: what rounding leaves of it is nothing against any length here
                size = max(np.abs(values[known]).max(), 1e-3)
                assert np.abs(values[known] - others[known]).max() <= 1e-9 * size, (group.path, name)
                compared += 1
    assert compared > 110
    loads = [item.tree["/MSL/loads"] for item in (large, small)]
    for row, unit in enumerate(loads[0]["load_unit"].values):
        for name in ("steady_load", "wave_load", "impact_load", "governing_load", "capacity"):
            one, two = (float(group[name].values[row]) for group in loads)
            assert scaled.scale.to_prototype(two, str(unit)) == pytest.approx(one, rel=1e-9, nan_ok=True)
    assert loads[1]["factored_utilisation"].values == pytest.approx(
        loads[0]["factored_utilisation"].values, rel=1e-9, nan_ok=True
    )


def test_viscosity_stays_that_of_the_water(tmp_path):
    """A net cage in another size swims in the same water: its kinematic viscosity is no quantity to scale."""
    given = case_of(parse_yaml(template("rigid_cage"), "cage.yaml"), tmp_path / "cage.yaml")
    scaled = scale_case(given, Scale(25.0, 1.0, 1.0), from_model=True)
    assert scaled.case.model.structure.kinematic_viscosity == given.model.structure.kinematic_viscosity
    assert not any("viscosity" in row.name for row in scaled.rows)
    assert not any("not the kinematic viscosity" in str(warning) for warning in scaled.case.warnings)


def test_line_of_a_network_keeps_weight_stretch_and_strength(tmp_path):
    """Mass and volume with the square of the length, EA and breaking load with its cube, coefficients as they were."""
    case = read(template("network"), tmp_path, "network.yaml")
    scaled = scale_case(case, Scale(25.0, 1.0, 1.0), digits=17)
    length = 0.5
    large, strong = bar_type_of("chain", case.model.structure.line_types["chain"], tmp_path, length)
    small, weak = bar_type_of("chain", scaled.case.model.structure.line_types["chain"], tmp_path, length / 25.0)
    powers = {
        "mass_per_length": 2, "volume_per_length": 2, "diameter": 1, "axial_stiffness": 3, "drag_normal": 0,
        "drag_tangential": 0, "added_mass_normal": 0, "added_mass_tangential": 0, "viscosity": 3.5,
    }  # fmt: skip
    for name, power in powers.items():
        assert getattr(large, name) == pytest.approx(25.0**power * getattr(small, name), rel=1e-12), name
    assert strong == pytest.approx(25.0**3 * weak, rel=1e-12)
    assert small.tension_only
    back = scale_case(scaled.case, Scale(25.0, 1.0, 1.0), from_model=True, digits=17)
    again, _ = bar_type_of("chain", back.case.model.structure.line_types["chain"], tmp_path, length)
    assert again.axial_stiffness == pytest.approx(large.axial_stiffness, rel=1e-12)


def test_ropes_of_a_cage_keep_weight_stretch_and_strength(tmp_path):
    case = read(template("cage"), tmp_path, "cage.yaml")
    scaled = scale_case(case, Scale(25.0, 1.0, 1.0), digits=17)
    ropes = [
        [rope_of(entry, "rope") for entry in (mooring.frame_rope, mooring.bridle, *mooring.anchor_line)]
        for mooring in (case.model.structure.mooring, scaled.case.model.structure.mooring)
    ]
    powers = {
        "mass_per_length": 2, "volume_per_length": 2, "axial_stiffness": 3, "breaking_load": 3, "drag_normal": 0,
        "drag_tangential": 0, "added_mass_normal": 0, "added_mass_tangential": 0,
    }  # fmt: skip
    for large, small in zip(*ropes, strict=True):
        for name, power in powers.items():
            assert getattr(large, name) == pytest.approx(25.0**power * getattr(small, name), rel=1e-12), name


def test_lines_of_a_breakwater_move_as_those_they_stand_for(tmp_path):
    """A line of the catalogue may be set in motion, and so may what takes its place."""
    case = read(template("breakwater"), tmp_path)
    scaled = scale_case(case, Scale(25.0, 1.0, 1.0), digits=17)
    large, small = (build(one).breakwater.lines for one in (case, scaled.case))
    assert all(line.can_move for line in (*large, *small))
    for one, other in zip(large, small, strict=True):
        for prototype, model in zip(one.bar_types, other.bar_types, strict=True):
            for name, power in {
                "mass_per_length": 2, "volume_per_length": 2, "axial_stiffness": 3, "diameter": 1, "drag_normal": 0,
                "drag_tangential": 0, "added_mass_normal": 0, "added_mass_tangential": 0,
            }.items():  # fmt: skip
                expected = 25.0**power * getattr(model, name)
                assert getattr(prototype, name) == pytest.approx(expected, rel=1e-12), name


@pytest.mark.parametrize("kind", ["breakwater", "network", "cage", "units"])
def test_factors_of_a_code_stay_those_of_chain_and_rope(kind, tmp_path):
    text = template(kind) + ("" if "\ncriteria:" in template(kind) else "\ncriteria: {code: NS 9415}\n")
    case = read(text, tmp_path, f"{kind}.yaml")
    scaled = scale_case(case, Scale(25.0, 1.0, 1.0), digits=17)
    before, after = (
        [one.limit for one in criteria_of(item.model) if one.headline == "line_utilisation"]
        for item in (case, scaled.case)
    )
    assert before and after == pytest.approx(before)


def test_hours_of_the_largest_snap_follow_the_time(tmp_path):
    case = read(template("curtain"), tmp_path, "curtain.yaml")
    scaled = scale_case(case, Scale(25.0, 1.0, 1.0), digits=17).case
    assert case.model.settings.waves.hours == 3.0
    assert scaled.model.settings.waves.hours == pytest.approx(0.6)
