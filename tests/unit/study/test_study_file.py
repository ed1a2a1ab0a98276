"""Reading a study file: every kind of variation, and one clear message for every slip."""

import math
from pathlib import Path

import numpy as np
import pytest
import study_cases
from scipy.stats import norm

from moyai.case.paths import resolve, value_of
from moyai.case.reader import load_case
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import CaseError, InputError
from moyai.study.axes import StudyBase
from moyai.study.lost_lines import lines_lost
from moyai.study.plan import case_at, load_study
from moyai.study.scatter import read_scatter
from moyai.study.schema import Distribution
from moyai.study.variations import _draw


def faults(tmp_path, variations, **further):
    with pytest.raises(CaseError) as caught:
        load_study(study_cases.write_text(tmp_path, variations, **further))
    return "\n".join(str(fault) for fault in caught.value.faults)


@pytest.mark.parametrize(
    ("path", "places"),
    [
        ("site.water_depth", [("site", "water_depth")]),
        ("waves[storm].seed", [("waves", 0, "seed")]),
        ("waves.storm.seed", [("waves", 0, "seed")]),
        ("waves[0].seed", [("waves", 0, "seed")]),
        ("lines[*].segments[0].length", [("lines", 0, "segments", 0, "length"), ("lines", 1, "segments", 0, "length")]),
        ("lines[shoreward].count", [("lines", 1, "count")]),
        ("site.water_levels", [("site", "water_levels")]),
    ],
)
def test_paths_find_their_places(path, places):
    data = parse_yaml(study_cases.BASE).data
    assert list(resolve(data, path)) == places


def test_a_block_in_place_of_a_list_of_one_is_found_by_number_and_name():
    data = parse_yaml("waves: {name: storm, seed: 3}").data
    for path in ("waves[0].seed", "waves.seed", "waves[storm].seed", "waves[*].seed"):
        (place,) = resolve(data, path)
        assert value_of(data, place) == 3


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("waves[strom].seed", ["no entry 'strom'", "did you mean 'storm'"]),
        ("waves[3].seed", ["1 entry", "no [3]"]),
        ("sight.water_depth", ["no key 'sight'", "site"]),
        ("site.water_depth.x", ["nothing below 'site.water_depth'"]),
        ("site..water_depth", ["no path"]),
        ("", ["empty"]),
        ("lines[0", ["no path"]),
    ],
)
def test_paths_that_lead_nowhere_say_where_they_end(path, words):
    with pytest.raises(InputError) as caught:
        resolve(parse_yaml(study_cases.BASE).data, path)
    for word in words:
        assert word in str(caught.value)


def test_a_misspelt_last_key_is_reported_by_the_schema_of_the_case(tmp_path):
    reported = faults(tmp_path, "- grid: {'waves[storm].significant_hight': [1 m]}")
    assert "unknown key 'significant_hight'" in reported and "case 1 of 1" in reported


def test_all_wrong_paths_of_a_study_are_reported_at_once(tmp_path):
    variations = """
- grid:
    waves[storm].significant_hight: [1 m, 2 m]
    structur.draught: [3 m]
- seeds: {path: 'waves[strom].seed', count: 2}
"""
    reported = faults(tmp_path, variations)
    for word in ("unknown key 'significant_hight'", "no key 'structur'", "no entry 'strom'"):
        assert reported.count(word) == 1, reported
    assert [f"study.yaml:{line}:" in reported for line in (7, 8, 9)] == [True] * 3, reported


@pytest.mark.parametrize("search", ["limit", "optimise"])
def test_a_misspelt_last_key_of_a_search_is_reported(tmp_path, search):
    study_cases.write_base(tmp_path)
    path = "waves[storm].significant_hight"
    blocks = {
        "limit": f"{{path: '{path}', from: 1 m, to: 2 m, conditions: [{{response: SWL/x, at_most: 1}}]}}",
        "optimise": f"{{variables: {{'{path}': [1 m, 2 m]}}, minimise: SWL/x}}",
    }
    file = tmp_path / "study.yaml"
    head = "moyai: 1\nstudy:\n  title: t\n  base: base.yaml\n"
    file.write_text(head + f"  {search}: {blocks[search]}\n", encoding="utf-8")
    with pytest.raises(CaseError, match="unknown key 'significant_hight'"):
        load_study(file)
    file.write_text(file.read_text(encoding="utf-8").replace("hight", "height"), encoding="utf-8")
    assert load_study(file).search is not None


def test_a_path_that_does_not_exist_is_reported_with_its_line(tmp_path):
    reported = faults(tmp_path, "- grid: {'waves[strom].seed': [1, 2]}")
    assert "study.yaml:6" in reported and "did you mean 'storm'" in reported


def test_a_grid_runs_every_value_with_every_other_the_last_fastest(tmp_path):
    study = load_study(
        study_cases.write_text(
            tmp_path,
            "- grid:\n    'waves[storm].significant_height': [0.5 m, 60 cm]\n"
            "    'waves[storm].peak_period': {from: 4 s, to: 5 s, count: 3}",
        )
    )
    assert study.shape == (2, 3)
    seas = [case_at(study, case).model.waves[0] for case in study.cases]
    assert [sea.significant_height for sea in seas] == [0.5] * 3 + [0.6] * 3
    assert [sea.peak_period for sea in seas] == [4.0, 4.5, 5.0] * 2
    assert study.axes[0].coordinates() == {"waves[storm].significant_height": ([0.5, 0.6], "m")}


def test_whole_numbers_between_whole_ends_stay_whole(tmp_path):
    study = load_study(
        study_cases.write_text(
            tmp_path,
            "- grid: {'waves[storm].seed': {from: 3, to: 11, count: 5},"
            " 'structure.damping.fraction_of_critical': {from: 0, to: 1, count: 3}}",
            set="{structure.damping: {fraction_of_critical: 0.1, modes: [roll]}}",
        )
    )
    seeds = [point.assignments[0][1] for point in study.axes[0].points]
    assert seeds == [3, 5, 7, 9, 11] and all(isinstance(seed, int) for seed in seeds)
    assert [point.assignments[0][1] for point in study.axes[1].points] == [0.0, 0.5, 1.0]


def test_a_list_sets_several_values_and_leaves_out_others(tmp_path):
    study = load_study(
        study_cases.write_text(
            tmp_path,
            "- list:\n    name: layout\n    cases:\n"
            "      - {label: long, set: {'lines[*].segments[0].length': 55 m, 'structure.draught': 2.9 m}}\n"
            "      - {label: one-sided, remove: ['lines[shoreward]']}",
        )
    )
    long, one_sided = (case_at(study, case).model for case in study.cases)
    assert [line.segments[0].length for line in long.lines] == [55.0, 55.0]
    assert long.structure.draught == 2.9
    assert [line.name for line in one_sided.lines] == ["seaward"]


def test_a_table_gives_a_case_a_row(tmp_path):
    (tmp_path / "seas.csv").write_text("Hs;Tp;note\n0.5;4;calm\n0.8;5,5;x\n".replace("5,5", "5.5"), encoding="utf-8")
    study = load_study(
        study_cases.write_text(
            tmp_path,
            "- table:\n    file: seas.csv\n    units: {Hs: m}\n"
            "    columns: {Hs: 'waves[storm].significant_height', Tp: 'waves[0].peak_period'}",
        )
    )
    seas = [case_at(study, case).model.waves[0] for case in study.cases]
    assert [(sea.significant_height, sea.peak_period) for sea in seas] == [(0.5, 4.0), (0.8, 5.5)]


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("", "empty"),
        ("Hs,Tp\n", "no rows"),
        ("Hs,Tp\n1,\n", "row 2: column 'Tp' is empty"),
        ("a,b\n1,2\n", "no column"),
    ],
)
def test_bad_tables_are_reported_by_row_and_column(tmp_path, text, word):
    (tmp_path / "seas.csv").write_text(text, encoding="utf-8")
    reported = faults(
        tmp_path,
        "- table: {file: seas.csv, columns: {Hs: 'waves[0].significant_height', Tp: 'waves[0].peak_period'}}",
    )
    assert word in reported


def test_return_periods_pair_the_rarest_waves_with_the_next_rarer_current_and_the_reverse(tmp_path):
    study = load_study(
        study_cases.write_text(
            tmp_path,
            "- return_periods:\n"
            "    waves: {1 yr: {'waves[0].significant_height': 0.5 m}, 10 yr: {'waves[0].significant_height': 0.8 m},"
            " 50 yr: {'waves[0].significant_height': 1 m}}\n"
            "    current: {1 yr: {current: {speed: 0.1 m/s, heading_deg: 0}},"
            " 10 yr: {current: {speed: 0.3 m/s, heading_deg: 0}}, 50 yr: {current: {speed: 0.4 m/s, heading_deg: 0}}}",
            set="{structure.current_drag_coefficient: 1.5}",
        )
    )
    assert [case.labels for case in study.cases] == [("waves 50 yr, current 10 yr",), ("waves 10 yr, current 50 yr",)]
    first = case_at(study, study.cases[0]).model
    assert first.waves[0].significant_height == 1.0 and first.current.speed == 0.3


def test_scatter_diagrams_carry_their_probabilities(tmp_path):
    (tmp_path / "scatter.csv").write_text("Hs\\Tp,4,5,6\n0.5,10,20,0\n0.8,,5,5\n", encoding="utf-8")
    study = load_study(
        study_cases.write_text(
            tmp_path,
            "- scatter: {file: scatter.csv, significant_height: 'waves[0].significant_height',"
            " period: 'waves[0].peak_period', counts: true}",
        )
    )
    points = study.axes[0].points
    assert len(points) == 4
    assert math.isclose(sum(point.probability for point in points), 1.0)
    assert [round(point.probability, 3) for point in points] == [0.25, 0.5, 0.125, 0.125]


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("Hs,4,5\n0.5,0,0\n", "empty"),
        ("", "empty"),
        ("Hs,4,5\n0.5,0.3,0.3\n", "sum to 0.6"),
        ("Hs,4,5\n0.5,x,0.3\n", "row 2, column 2"),
        ("Hs,4,5\n0.5,-1,0.3\n", "row 2, column 2"),
        ("significant_height,peak_period,probability\n0.5,4\n", "three columns"),
    ],
)
def test_bad_scatter_diagrams_are_reported(tmp_path, text, word):
    file = tmp_path / "scatter.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=word):
        read_scatter(file)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["sobol", pytest.param("latin_hypercube", marks=pytest.mark.slow)])
def test_samples_follow_their_distributions_and_their_seed(tmp_path, method):
    text = (
        f"- sample:\n    method: {method}\n    count: 64\n    seed: 4\n    variables:\n"
        "      'waves[0].significant_height': {uniform: [50 cm, 1 m]}\n"
        "      'structure.draught': {normal: [3 m, 10 cm]}\n"
        "      'waves[0].peak_period': {lognormal: [5 s, 0.5 s]}\n"
    )
    few = text.replace("count: 64", "count: 4")
    keys = [load_study(study_cases.write_text(tmp_path, few.replace("seed: 4", f"seed: {n}"))).key for n in (4, 4, 5)]
    assert keys[0] == keys[1] != keys[2]
    coordinates = load_study(study_cases.write_text(tmp_path, text)).axes[0].coordinates()
    height = np.array(coordinates["waves[0].significant_height"][0])
    draught = np.array(coordinates["structure.draught"][0])
    period = np.array(coordinates["waves[0].peak_period"][0])
    assert height.min() >= 0.5 and height.max() <= 1.0 and abs(height.mean() - 0.75) < 1e-2
    assert abs(draught.mean() - 3.0) < 1e-2 and abs(draught.std() - 0.1) < 1e-2
    assert abs(period.mean() - 5.0) < 5e-2 and abs(period.std() - 0.5) < 6e-2
    # ln of a lognormal value has the mean ln m - ln(1 + (s / m)^2) / 2
    assert abs(np.log(period).mean() - (np.log(5.0) - 0.5 * np.log1p(0.01))) < 3e-3


def test_drawn_values_have_the_mean_and_deviation_that_are_given():
    quantile = (np.arange(20_000) + 0.5) / 20_000
    for kind in ("normal", "lognormal"):
        drawn = [float(item.split()[0]) for item in _draw(Distribution(**{kind: ["5 s", "0.5 s"]}), quantile, "period")]
        assert np.mean(drawn) == pytest.approx(5.0, rel=1e-4) and np.std(drawn) == pytest.approx(0.5, rel=2e-3)
    assert np.log(drawn).std() == pytest.approx(math.sqrt(math.log(1.01)), rel=2e-3)


def test_faults_of_cases_are_reported_once_with_the_first_case_that_shows_them(tmp_path):
    reported = faults(tmp_path, "- grid: {'structure.draught': [3 m, -1 m], 'waves[0].peak_period': [4 s, 5 s]}")
    assert "draught -1 m" in reported and "and 1 more cases" in reported and reported.count("structure.draught") == 1


@pytest.mark.parametrize(
    ("variations", "word"),
    [
        ("- grid: {'waves[0].seed': []}", "waves[0].seed"),
        ("- gird: {'waves[0].seed': [1]}", "did you mean 'grid'"),
        ("- {grid: {'waves[0].seed': [1]}, lines_lost: true}", "exclude each other"),
        ("- grid: {'waves[0].seed': [1]}\n- seeds: {path: 'waves[0].seed', count: 2}", "two axes"),
        ("- grid: {'waves[0].seed': [1]}\n- seeds: {name: n, path: 'waves[0].seed', count: 2}", "varied by both"),
        ("- sample: {count: 4, seed: 1, variables: {'structure.draught': {uniform: [3 m, 2 m]}}}", "empty"),
        ("- sample: {count: 4, seed: 1, variables: {'structure.draught': {uniform: [3 m, 2 s]}}}", "one kind"),
        ("- seeds: {path: 'waves[0].seed', count: 0}", "count"),
        ("- table: {file: none.csv, columns: {a: 'waves[0].seed'}}", "no such file"),
        (
            "- seeds: {path: 'waves[0].seed', count: 1000}\n- lines_lost: true\n"
            "- grid: {'structure.draught': {from: 2 m, to: 3 m, count: 400}}",
            "1200000 cases",
        ),
    ],
)
def test_slips_of_a_study_file_are_reported(tmp_path, variations, word):
    assert word in faults(tmp_path, variations)


def test_a_base_case_that_is_not_there_is_reported(tmp_path):
    path = study_cases.write_text(tmp_path, "- lines_lost: true")
    (tmp_path / "base.yaml").unlink()
    with pytest.raises(CaseError, match="no such file"):
        load_study(path)


def test_shared_changes_reach_every_case(tmp_path):
    study = load_study(
        study_cases.write_text(tmp_path, "- seeds: {path: 'waves[0].seed', count: 2}", set="{structure.draught: 2.8 m}")
    )
    assert [case_at(study, case).model.structure.draught for case in study.cases] == [2.8, 2.8]


def test_spectra_of_a_file_replace_a_sea_state_and_keep_its_seed(tmp_path):
    rows = "".join(f"2020 01 0{day} 00 00 9 " + f"{0.1 * day} (0.100) 0.3 (0.200) 0.1 (0.300)\n" for day in (2, 1))
    (tmp_path / "buoy.data_spec").write_text("#YY MM DD hh mm Sep\n" + rows, encoding="utf-8")
    study = load_study(study_cases.write_text(tmp_path, "- spectra: {file: buoy.data_spec, sea: 'waves[storm]'}"))
    assert [case.labels for case in study.cases] == [("2020-01-01T00:00",), ("2020-01-02T00:00",)]
    sea = case_at(study, study.cases[1]).model.waves[0]
    assert (sea.kind, sea.record, sea.seed, sea.name) == ("spectrum_file", 1, 1, "storm")
    reported = faults(tmp_path, "- spectra: {file: buoy.data_spec, sea: 'waves[storm]', direction: true}")
    assert "gives no direction" in reported
    assert "0 to 1" in faults(tmp_path, "- spectra: {file: buoy.data_spec, sea: 'waves[storm]', records: [5]}")


def test_a_study_of_spectra_that_was_moved_with_its_files_is_the_same_study(tmp_path):
    text = "#YY MM DD hh mm Sep\n2020 01 01 00 00 9 0.1 (0.100) 0.3 (0.200) 0.1 (0.300)\n"
    keys = []
    for name, content in (("here", text), ("there", text), ("changed", text.replace("0.3 (", "0.4 ("))):
        folder = tmp_path / name
        (folder / "seas").mkdir(parents=True)
        (folder / "seas" / "buoy.data_spec").write_text(content, encoding="utf-8")
        path = study_cases.write_text(folder, "- spectra: {file: seas/buoy.data_spec, sea: 'waves[storm]'}")
        study = load_study(path)
        assert case_at(study, study.cases[0]).model.waves[0].file == "seas/buoy.data_spec"
        keys.append(study.key)
    assert keys[0] == keys[1] != keys[2]


@pytest.mark.parametrize(("word", "reported"), [("structure", "moyai run"), ("fit", "moyai fit")])
def test_a_file_of_another_kind_is_reported_in_one_sentence(tmp_path, word, reported):
    path = tmp_path / "other.yaml"
    path.write_text(f"moyai: 1\ntitle: t\n{word}: {{}}\n", encoding="utf-8")
    with pytest.raises(CaseError, match=reported) as caught:
        load_study(path)
    assert len(caught.value.faults) == 1


def test_a_study_that_is_run_as_a_case_is_reported_its_command(tmp_path):
    with pytest.raises(CaseError, match="moyai study FILE"):
        load_case(study_cases.write_text(tmp_path, "- lines_lost: true"))


def test_the_template_of_a_study_runs_on_the_template_of_a_breakwater(tmp_path):
    for kind in ("breakwater", "study"):
        (tmp_path / f"{kind}.yaml").write_text(template(kind), encoding="utf-8")
    study = load_study(tmp_path / "study.yaml")
    assert len(study.cases) == 2 * 3


CONTOUR = """- contour:
    years: 50
    duration: 3 h
    count: 40
    joint: {location: 0.1, scale: 0.4, shape: 1.3, mean_log: [1.0, 0.5, 0.4], deviation_log: [0.05, 0.2, -0.8]}
    significant_height: 'waves[storm].significant_height'
    period: 'waves[storm].peak_period'
    least_height: 0.5
"""


def test_a_contour_holds_the_marginal_return_height_and_stays_on_the_circle(tmp_path):
    study = load_study(study_cases.write_text(tmp_path, CONTOUR))
    points = np.array([[value for _, value in point.assignments] for point in study.axes[0].points])
    states = 50 * 365.25 * 8
    top = 0.1 + 0.4 * np.log(states) ** (1 / 1.3)
    assert points[:, 0].max() == pytest.approx(top, rel=1e-9) and points[:, 0].min() >= 0.5
    # Back to the standard normal space: every point lies on the circle of the return period
    first = norm.isf(np.exp(-(((points[:, 0] - 0.1) / 0.4) ** 1.3)))
    mean = 1.0 + 0.5 * points[:, 0] ** 0.4
    second = (np.log(points[:, 1]) - mean) / (0.05 + 0.2 * np.exp(-0.8 * points[:, 0]))
    assert np.allclose(np.hypot(first, second), norm.isf(1 / states), rtol=1e-6)


@pytest.mark.parametrize(
    ("old", "new", "word"),
    [
        ("least_height: 0.5", "least_height: 50", "no sea state of the contour"),
        ("years: 50", "years: 1e-5", "sea states"),
        ("scale: 0.4", "scale: -1", "scale"),
    ],
)
def test_bad_contours_are_reported(tmp_path, old, new, word):
    assert word in faults(tmp_path, CONTOUR.replace(old, new))


def test_a_contour_from_pairs_needs_enough_of_them(tmp_path):
    (tmp_path / "seas.csv").write_text("hs,tp\n1,5\n2,6\n", encoding="utf-8")
    text = CONTOUR.replace(
        CONTOUR.splitlines()[4], "    pairs: {file: seas.csv, significant_height: hs, period: tp, location: 0}"
    )
    assert "at least 360" in faults(tmp_path, text)
    assert "no column 'te'" in faults(tmp_path, text.replace("period: tp", "period: te"))


def test_lines_that_stand_below_the_structure_by_name_are_lost_too():
    data = {
        "site": {"water_depth": "5 m"},
        "structure": {"kind": "network", "lines": {"north": {"length": "3 m"}, "south": {"count": 3}, "west east": {}}},
    }
    (axis,) = lines_lost(True, StudyBase(data, Path(), Path()))
    assert [point.label for point in axis.points] == ["intact", "north", "one of south", "west east"]
    assert axis.points[1].removals == ("structure.lines.north",) and axis.lost_line
    assert axis.points[2].assignments == (("structure.lines.south.count", 2),)
    for point in axis.points:
        for path in (*point.removals, *dict(point.assignments)):
            resolve(data, path)
    with pytest.raises(InputError, match="the only line"):
        lines_lost(True, StudyBase({"lines": {"name": "a", "length": "1 m"}}, Path(), Path()))
    with pytest.raises(InputError, match="the only line"):
        lines_lost(True, StudyBase({"lines": {"a": {"length": "1 m"}}}, Path(), Path()))


@pytest.mark.parametrize(("first", "last", "count"), [(0.16, 1.6, 10), ("0.04 m", "1 m", 9), (0.08, 0.8, 10)])
def test_spread_values_are_the_ones_a_person_would_write(first, last, count):
    """0.64 and not 0.6400000000000001 stands on axes and in tables."""
    from moyai.study import schema
    from moyai.study.variations import _spread

    given = _spread(schema.Spread(**{"from": first, "to": last, "count": count}), "x")
    numbers = [float(str(one).split()[0]) for one in given]
    ends = [float(str(one).split()[0]) for one in (first, last)]
    np.testing.assert_allclose(numbers, np.linspace(*ends, count), rtol=1e-11)
    assert not any("00000" in str(one) or "99999" in str(one) for one in given)


def test_a_range_of_two_units_is_judged_by_its_size():
    """'40 cm' stands behind '1 m' as text."""
    from moyai.study import schema
    from moyai.study.variations import _spread

    rising = _spread(schema.Spread(**{"from": "40 cm", "to": "1 m", "count": 3}), "x")
    assert rising == ("40.0 cm", "70.0 cm", "100.0 cm")
    with pytest.raises(InputError, match="runs backwards"):
        _spread(schema.Spread(**{"from": "1 m", "to": "40 cm", "count": 3}), "x")


def test_the_first_entry_of_a_range_is_no_place_and_a_lone_block_is_its_own_entry():
    data = {"waves": {"name": "w", "periods": {"from": "3 s", "to": "8 s", "count": 6}}}
    with pytest.raises(InputError, match="which has no entries") as caught:
        resolve(data, "waves[w].periods[0]")
    assert "replace it as a whole: 'waves.periods'" in caught.value.fault.remedy
    assert resolve(data, "waves[0]") == (("waves",),) and resolve(data, "waves[w].name") == (("waves", "name"),)
