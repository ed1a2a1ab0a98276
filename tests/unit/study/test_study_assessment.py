"""Codes, anchors, extremes and return levels of a study whose maxima follow a known distribution."""

import json
import math

import numpy as np
import pytest
import study_cases
from japanese import compared

from moyai.core.errors import InputError
from moyai.design.long_term import YEAR
from moyai.report.html import render_html
from moyai.study.assess import assess, governing, utilised
from moyai.study.execute import run_study
from moyai.study.plan import load_study
from moyai.study.report import drawings as study_drawings
from moyai.study.report.page import compose, interesting
from moyai.study.report.reading import read_study


def assessed(tmp_path, variations, assessment):
    study = load_study(study_cases.write_text(tmp_path, variations, assess=assessment))
    result = run_study(study, tmp_path / "out", study_cases.gumbel_case, workers=1)
    return study, assess(study, result, study.assessment)


GRID = "- grid: {'waves[storm].significant_height': [0.5 m, 1 m]}\n"


def test_lines_are_held_against_intact_and_damaged_factors(tmp_path):
    study, result = assessed(
        tmp_path, GRID + "- lines_lost: true", "{lines: {codes: {name: API RP 2SK, analysis: dynamic}}}"
    )
    used = result.tree["assessment/lines"]["factored_utilisation"].squeeze("code").squeeze("sea")
    tension = result.tree["SWL/time/storm"]["line_tension_maximum"]
    factor = np.array([1.67, 1.25, 1.25])[None, :, None]
    expected = tension.transpose("significant_height", "lost_line", "line").values * factor / 1e6
    assert np.allclose(
        used.transpose("significant_height", "lost_line", "line").values, expected, equal_nan=True, rtol=1e-12
    )
    assert any("not compared with the standard" in notice.message for notice in result.notices)
    component, index, value = governing(study, result, 3)[0]
    assert component.startswith("line ") and value == pytest.approx(np.nanmax(expected))
    assert study.cases[index].labels[0] == "1 m"


def test_lines_of_any_structure_are_reported_by_their_responses(tmp_path):
    study, result = assessed(
        tmp_path,
        GRID,
        "{tensions: {rope: {maximum: SWL/time/storm/worst, mean: 'SWL/time/storm/line_tension_mean[line=seaward]',"
        " uplift: SWL/time/storm/anchor_vertical_tension_maximum, breaking_load: 400 kN}},"
        " lines: {codes: {name: DNV-OS-E301, analysis: dynamic, consequence: '2'}},"
        " anchors: {rope: {kind: sinker, weight: 900 kN, coefficient: 0.6, safety_factor: 1.2}}}",
    )
    worst = result.tree["SWL/time/storm"]["worst"].values
    used = result.tree["assessment/lines"]["factored_utilisation"].sel(line="rope").values.ravel()
    assert np.allclose(used, (1.4 * 0.3 + 2.1 * 0.7) * worst / (0.95 * 4e5), rtol=1e-12)
    pull, up = worst * math.sqrt(0.99), 0.1 * worst
    anchor = result.tree["assessment/anchors"]["factored_utilisation"].values.ravel()
    assert np.allclose(anchor, 1.2 * pull / (0.6 * (9e5 - 1.2 * up)), rtol=1e-12)
    assert governing(study, result, 3)[0][0] in ("line rope", "anchor of rope")


def test_the_long_term_of_rayleigh_peaks_is_exact(tmp_path):
    (tmp_path / "scatter.csv").write_text(
        "significant_height,period,probability\n0.1,5,0.97\n1.0,5,0.03\n", encoding="utf-8"
    )
    _, result = assessed(
        tmp_path,
        "- scatter: {file: scatter.csv, significant_height: 'waves[0].significant_height',"
        " period: 'waves[0].peak_period'}",
        "{long_term: {response: SWL/time/storm/worst, duration: 3 h, years: [1, 100], waves: 2200}}",
    )
    mode = float(result.tree["SWL/time/storm"]["worst"].values[1])
    level = result.tree["assessment/long term 1"]["return_level"].values
    states = 0.03 * np.array([1.0, 100.0]) * YEAR / 10800.0
    # The calm sea adds nothing; one in 2200 peaks of each of the storms exceeds the mode
    assert np.allclose(level, mode * np.sqrt(np.log(2200 * states) / math.log(2200)), rtol=1e-6)
    assert any("2200 waves" in notice.message for notice in result.notices)


def test_own_factors_and_corrosion(tmp_path):
    _, result = assessed(
        tmp_path,
        GRID,
        "{lines: {codes: {name: house, analysis: dynamic, safety_factor_intact: 3}, corrosion_rate: 0.4, life: 20,"
        " diameter: {seaward: 68 mm, shoreward: 80 mm}}}",
    )
    used = result.tree["assessment/lines"]["factored_utilisation"].squeeze()
    tension = result.tree["SWL/time/storm"]["line_tension_maximum"]
    for line, diameter in (("seaward", 0.068), ("shoreward", 0.080)):
        expected = tension.sel(line=line).values * 3.0 / (1e6 * (1 - 0.008 / diameter) ** 2)
        assert np.allclose(used.sel(line=line).values, expected, rtol=1e-12)
    assert not result.notices


def test_anchors_that_fail_lower_the_status(tmp_path):
    _, result = assessed(
        tmp_path,
        GRID,
        "{anchors: {seaward: {kind: sinker, weight: 100 kN, coefficient: 0.5, safety_factor: 1.2},"
        " shoreward: {kind: drag_anchor, weight: 10 kN, name: danforth, bed: sand, safety_factor: 1.5}}}",
    )
    assert result.status == "outside_validity"
    used = result.tree["assessment/anchors"]["factored_utilisation"]
    pull = result.tree["SWL/time/storm"]["line_tension_maximum"].sel(line="seaward").values
    up = 0.1 * pull
    side = np.sqrt(pull**2 - up**2)
    slide = 1.2 * side / (0.5 * (1e5 - 1.2 * up))
    assert np.allclose(used.sel(line="seaward").values, slide[None, :], rtol=1e-9)
    assert np.isinf(used.sel(line="shoreward").values).all()
    reported = " ".join(notice.message for notice in result.notices)
    assert "upwards" in reported and "danforth on sand" in reported


@pytest.mark.slow
def test_the_most_probable_maximum_of_many_times_is_the_mode_of_their_law(tmp_path):
    """Gumbel: the largest of n has the mode u + b ln n."""
    _, result = assessed(
        tmp_path,
        GRID + "- seeds: {path: 'waves[storm].seed', count: 12}",
        "{extremes: {response: SWL/time/storm/worst, times: 20}}",
    )
    found = result.tree["assessment/extremes 1"]
    mode = found["location"].values + found["scale"].values * math.log(20.0)
    assert found["most_probable_maximum"].values == pytest.approx(mode, rel=1e-9)
    assert (found["scale"].values > 0.0).all()


@pytest.mark.slow
def test_extremes_over_seeds_find_the_known_distribution(tmp_path):
    _, result = assessed(
        tmp_path,
        GRID + "- seeds: {path: 'waves[storm].seed', count: 60}",
        "{extremes: {response: SWL/time/storm/worst, probability: 0.9}}",
    )
    found = result.tree["assessment/extremes 1"]
    for number, height in enumerate((0.5, 1.0)):
        truth = 1e5 * height * (1.0 - 0.1 * math.log(-math.log(0.9)))
        assert found["lower"].values[number] <= truth <= found["upper"].values[number]
        assert found["design_value"].values[number] == pytest.approx(truth, rel=0.05)


@pytest.mark.slow
def test_return_levels_over_a_scatter_diagram(tmp_path):
    (tmp_path / "scatter.csv").write_text(
        "significant_height,period,probability\n0.5,5,0.9\n1.0,5,0.1\n", encoding="utf-8"
    )
    _, result = assessed(
        tmp_path,
        "- scatter: {file: scatter.csv, significant_height: 'waves[0].significant_height',"
        " period: 'waves[0].peak_period'}\n"
        "- seeds: {path: 'waves[storm].seed', count: 80}",
        "{long_term: {response: SWL/time/storm/worst, seeds: seed, duration: 3 h, years: [1, 50]}}",
    )
    level = result.tree["assessment/long term 1"]["return_level"].values
    for years, found in zip((1.0, 50.0), level):
        # The larger sea alone: a tenth of the sea states, Gumbel of mode 1e5 and scale 1e4
        states = 0.1 * years * YEAR / 10800.0
        assert found == pytest.approx(1e5 + 1e4 * math.log(states), rel=0.06)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("assessment", "word"),
    [
        ("{extremes: {response: SWL/time/storm/none}}", "no response"),
        ("{extremes: {response: SWL/time/storm/worst}}", "no axis 'seed'"),
        ("{lines: {codes: {name: none, analysis: dynamic}}}", "API RP 2SK"),
        ("{extremes: {response: 'SWL/time/storm/line_tension_mean[line=east]'}}", "no line 'east'"),
        (
            "{tensions: {rope: {maximum: SWL/none, breaking_load: 1 kN}}, lines: {codes: {name: API RP 2SK,"
            " analysis: dynamic}}}",
            "no response 'SWL/none'",
        ),
        ("{lines: {codes: {name: DNV-OS-E301, analysis: dynamic}}}", "class"),
        ("{lines: {codes: {name: OCIMF, analysis: dynamic}}}", "rope"),
        ("{lines: {codes: {name: API RP 2SK, analysis: dynamic}, component: {east: rope}}}", "no line 'east'"),
        (
            "{long_term: {response: SWL/time/storm/worst, over: significant_height, duration: 3 h, years: [1]}}",
            "scatter",
        ),
    ],
)
def test_what_cannot_be_assessed_is_reported_and_the_cases_are_kept(tmp_path, assessment, word):
    _, result = assessed(tmp_path, GRID, assessment)
    reported = " ".join(f"{notice.message} {notice.remedy}" for notice in result.notices)
    assert word in reported
    assert np.isfinite(result.tree["SWL/time/storm"]["worst"].values).all()


def test_the_report_names_the_governing_case_and_leads_to_its_replay(tmp_path):
    study, result = assessed(
        tmp_path, GRID + "- lines_lost: true", "{lines: {codes: {name: API RP 2SK, analysis: dynamic}}}"
    )
    reported = [[*item, f"governing/case {item[1]}"] for item in governing(study, result, 3)]
    result.tree.attrs.update({"governing": json.dumps(reported), "governing_kind": "utilisation"})
    page = render_html(compose(result))
    assert f'href="governing/case {reported[0][1]}/report.html"' in page
    assert "no, see the standard" in page and "lost line" in page
    left, count = compared(result)
    assert count > 50
    assert not left, "\n".join(left)


def test_the_report_of_failures_and_of_a_single_axis_is_written(tmp_path):
    study = load_study(study_cases.write_study(tmp_path, heights=1, seeds=5))
    result = run_study(study, tmp_path / "out", study_cases.failing_case, workers=1)
    page = render_html(compose(result))
    assert "the float sinks" in page and "Cases that failed" in page


def test_fatigue_life_over_a_scatter_diagram_is_that_of_its_sines(tmp_path):
    (tmp_path / "scatter.csv").write_text(
        "significant_height,period,probability\n0.5,5,0.9\n1.0,5,0.1\n", encoding="utf-8"
    )
    variation = (
        "- scatter: {file: scatter.csv, significant_height: 'waves[0].significant_height',"
        " period: 'waves[0].peak_period'}"
    )
    assessment = "{fatigue: {response: SWL/time/storm/run/tension, curve: studless_chain, safety_factor: 8}}"
    study = load_study(study_cases.write_text(tmp_path, variation, assess=assessment))
    result = assess(study, run_study(study, tmp_path / "out", study_cases.sine_case, workers=1), study.assessment)
    life = result.tree["assessment/fatigue 1"]["life"]
    # A cycle of range 0.05 (0.1) of the breaking load every 5 s; K = 316, m = 3
    rate = (0.9 * 0.05**3 + 0.1 * 0.1**3) / 316.0 / 5.0
    assert life.sel(line="seaward").item() == pytest.approx(1.0 / (rate * YEAR * 8.0), rel=0.01)
    assert life.sel(line="shoreward").item() == pytest.approx(life.sel(line="seaward").item() / 8.0, rel=1e-9)
    assert any("endurance curve" in notice.message for notice in result.notices)
    assert "Fatigue life" in render_html(compose(result))


def test_the_watched_response_governs_label_by_label_where_nothing_is_held_against_a_code(tmp_path):
    path = study_cases.write_text(tmp_path, GRID, watch="SWL/tension")
    study = load_study(path)
    result = run_study(study, tmp_path / "out", study_cases.linear_case, workers=1)
    assert not utilised(result)
    tension = result.tree["SWL"]["tension"].values
    assert governing(study, result, 3) == [
        ("SWL/tension[line=seaward]", 1, pytest.approx(tension[1, 0])),
        ("SWL/tension[line=shoreward]", 1, pytest.approx(tension[1, 1])),
    ]


def test_figures_show_first_what_varies_from_case_to_case(tmp_path):
    study = load_study(study_cases.write_text(tmp_path, "- grid: {'waves[storm].peak_period': [4 s, 5 s]}"))
    result = run_study(study, tmp_path / "out", study_cases.gumbel_case, workers=1)
    # Its tensions hang on height and seed alone
    assert interesting(read_study(result)) == ()


@pytest.mark.parametrize(
    ("degrees", "order", "closed"),
    [
        ([0.0, 90.0, 180.0, 270.0], [90.0, 180.0, 270.0, 0.0], True),
        ([0.0, 45.0, 90.0, 315.0, 330.0], [315.0, 330.0, 0.0, 45.0, 90.0], False),
        ([-45.0, 45.0, 0.0], [-45.0, 0.0, 45.0], False),
    ],
)
def test_a_rose_bridges_no_wide_gap_between_headings(degrees, order, closed):
    found, shut = study_drawings._round(np.array(degrees))
    assert [degrees[at] for at in found] == order and shut is closed


def test_a_watched_response_that_no_case_keeps_stops_the_study_at_its_first_case(tmp_path):
    ran = []

    def counted(case, progress):
        ran.append(case)
        return study_cases.fast_case(case, progress)

    misspelt = load_study(study_cases.write_text(tmp_path, GRID, watch="SWL/tensoin"))
    with pytest.raises(InputError) as found:
        run_study(misspelt, tmp_path / "out", counted, workers=1)
    assert len(ran) == 1
    assert found.value.fault.path == "study.watch"
    assert "SWL/tension" in found.value.fault.allowed
    with pytest.raises(InputError):
        run_study(misspelt, tmp_path / "out", counted, workers=1)
    assert len(ran) == 1
    study = load_study(study_cases.write_text(tmp_path, GRID, watch="SWL/tension"))
    result = assess(study, run_study(study, tmp_path / "out", counted, workers=1), None)
    assert len(ran) == len(study.cases)
    assert not [notice for notice in result.notices if notice.code.startswith("watch")]
