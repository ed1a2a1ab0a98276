"""Extremes of peaks in a study, by family, against the laws that the peaks were drawn from; fatigue by line."""

import math

import numpy as np
import pytest
import study_cases

from moyai.core.errors import CaseError
from moyai.design.long_term import YEAR
from moyai.report.html import render_html
from moyai.study.assess import assess
from moyai.study.execute import run_study
from moyai.study.extremes_over_seeds import _far_beyond, _of_maxima
from moyai.study.plan import load_study
from moyai.study.query import StudyTable
from moyai.study.report.page import compose
from moyai.study.schema import ExtremesOfSeeds

SEEDS = "- seeds: {path: 'waves[storm].seed', count: 12}"
HEIGHTS = "- grid: {'waves[storm].significant_height': [0.5 m, 1 m]}\n"


CALM = "{'waves[storm].significant_height': 0.5 m}"


def assessed(tmp_path, variations, assessment, case=study_cases.peaky_case, **further):
    study = load_study(study_cases.write_text(tmp_path, variations, assess=assessment, **further))
    result = run_study(study, tmp_path / "out", case, workers=1)
    return study, assess(study, result, study.assessment)


def exact(probability, snaps):
    """Level of the maximum of the 149 peaks between 150 up-crossings, by the laws that they are drawn from."""
    level = np.linspace(1e5, 1e6, 400_001)
    calm = np.exp(-(((level - 1e5) / 2e4) ** 1.6))
    hard = np.exp(-np.maximum(level - 1.5e5, 0.0) / 4e4)
    share = 0.25 if snaps else 0.0
    # A number of each kind that is itself drawn
    below = (1.0 - (1.0 - share) * calm - share * hard) ** 149
    return float(np.interp(probability, below, level))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("settings", "tolerance"),
    [
        ("family: weibull, share: 0.5", 0.06),
        ("family: generalised_pareto, share: 0.2", 0.06),
        # Three deviations of 2.6 % of this estimate from 12 x 149 peaks (60 samples); that of the Weibull is less
        ("family: acer, order: 1", 0.08),
        ("family: acer, order: 3", 0.08),
    ],
)
def test_every_family_finds_the_maximum_of_peaks_of_a_known_law(tmp_path, settings, tolerance):
    _, result = assessed(
        tmp_path, SEEDS, f"{{extremes: {{response: 'SWL/time/storm/tension[line=seaward]', {settings}}}}}", set=CALM
    )
    found = result.tree["assessment/extremes 1"]
    truth = exact(0.9, snaps=False)
    value, lower, upper = (float(found[name]) for name in ("design_value", "lower", "upper"))
    assert value == pytest.approx(truth, rel=tolerance) and lower < value < upper
    assert lower * 0.97 < truth < upper * 1.03
    # The mode of the maximum is passed by one peak of the 149
    mode = 1e5 + 2e4 * math.log(149.0) ** (1 / 1.6)
    assert float(found["most_probable_maximum"]) == pytest.approx(mode, rel=tolerance)
    assert "line" not in found.dims and settings.split()[1].strip(",") in found.attrs["family"]


@pytest.mark.slow
def test_snaps_are_fitted_apart_and_the_maximum_is_that_of_both_kinds(tmp_path):
    _, result = assessed(
        tmp_path,
        HEIGHTS + SEEDS,
        "{extremes: [{response: SWL/time/storm/tension, family: generalised_pareto, share: 1, snaps_apart: true},"
        " {response: SWL/time/storm/tension, family: weibull}]}",
    )
    apart, together = (result.tree[f"assessment/extremes {number}"] for number in (1, 2))
    assert apart["design_value"].dims == ("significant_height", "line")
    for number, snaps in enumerate((False, True)):
        assert apart["design_value"].values[number] == pytest.approx(exact(0.9, snaps), rel=0.12)
    # A quarter of the peaks follows on slack, and only in the higher sea
    snapping = np.isfinite(result.tree["SWL/time/storm"]["tension_snap_peaks"].values).sum(axis=-1)
    assert (snapping[0] == 0).all() and abs(snapping[1].mean() / 149 - 0.25) < 0.04
    reported = [notice.message for notice in result.notices if notice.code == "extremes-distance"]
    assert any("weibull" in message for message in reported), "one law for both kinds is far from them"
    assert abs(together["design_value"].values[1, 0] - exact(0.9, True)) > 0.05 * exact(0.9, True)
    assert "snaps apart" in str(apart.attrs["family"])
    assert "Generalised Pareto fits of snap peaks" in render_html(compose(result))


@pytest.mark.slow
def test_longer_times_ask_for_more_peaks_of_the_same_law(tmp_path):
    _, result = assessed(
        tmp_path,
        SEEDS,
        "{extremes: [{response: SWL/time/storm/tension, family: weibull, share: 0.5, times: 10, confidence: 0.5}]}",
        set=CALM,
    )
    found = result.tree["assessment/extremes 1"]["design_value"].values[0]
    assert found == pytest.approx(1e5 + 2e4 * math.log(1490 / -math.log(0.9)) ** (1 / 1.6), rel=0.06)


def test_the_most_probable_maximum_of_longer_times_is_the_mode_of_the_largest_of_so_many():
    drawn = np.random.default_rng(6).gumbel(300.0, 40.0, size=60)
    wanted = ExtremesOfSeeds(response="SWL/time/storm/tension", over="seed", family="gumbel", times=20.0)
    found = _of_maxima(drawn, wanted)
    level = np.linspace(found.location, found.location + 10.0 * found.scale, 100_001)
    below = np.exp(-np.exp(-(level - found.location) / found.scale)) ** 20
    mode = level[np.argmax(np.gradient(below, level))]
    assert found.most_probable_maximum == pytest.approx(mode, rel=1e-3)


@pytest.mark.parametrize(
    ("settings", "word"),
    [
        ("family: gumbel, share: 0.2", "'share' has no meaning"),
        ("family: acer, snaps_apart: true", "snaps_apart"),
        ("family: normal", "gumbel"),
        ("family: weibull, share: 1.5", "share"),
        ("family: acer, order: 0", "order"),
    ],
)
def test_settings_without_sense_are_reported_before_anything_runs(tmp_path, settings, word):
    path = study_cases.write_text(tmp_path, SEEDS, assess=f"{{extremes: {{response: SWL/x, {settings}}}}}")
    with pytest.raises(CaseError) as caught:
        load_study(path)
    assert word in str(caught.value)


def test_fatigue_takes_the_curve_of_every_line(tmp_path):
    (tmp_path / "scatter.csv").write_text(
        "significant_height,period,probability\n0.5,5,0.75\n1.0,5,0.25\n", encoding="utf-8"
    )
    variation = (
        "- scatter: {file: scatter.csv, significant_height: 'waves[0].significant_height',"
        " period: 'waves[0].peak_period'}"
    )
    assessment = (
        "{fatigue: {response: SWL/time/storm/run/tension, equivalent_cycles: 1e6,"
        " curve: {seaward: connecting_link, '*': stranded_rope_stress}, diameter: {shoreward: 40 mm}}}"
    )
    _, result = assessed(tmp_path, variation, assessment, study_cases.sine_case)
    found = result.tree["assessment/fatigue 1"]
    # A cycle of 0.05 (0.1) of the breaking load every 5 s seaward; twice that over the area of the rope shoreward
    rate = (0.75 * 0.05**3 + 0.25 * 0.1**3) / 178.0 / 5.0
    assert found["life"].sel(line="seaward").item() == pytest.approx(1.0 / (rate * YEAR), rel=0.01)
    stress = np.array([1e5, 2e5]) / (math.pi / 4 * 0.04**2) / 1e6
    rate = (0.75 * stress[0] ** 4 + 0.25 * stress[1] ** 4) / 3.4e14 / 5.0
    assert found["life"].sel(line="shoreward").item() == pytest.approx(1.0 / (rate * YEAR), rel=0.01)
    cycles = YEAR / 5.0
    same = ((0.75 * 5e4**3 + 0.25 * 1e5**3) * cycles / 1e6) ** (1 / 3)
    assert found["equivalent_range"].sel(line="seaward").item() == pytest.approx(same, rel=0.01)
    assert found["equivalent_range"].attrs["units"] == "N"
    assert "connecting_link, stranded_rope_stress" in found["life"].attrs["long_name"]


@pytest.mark.parametrize(
    ("curve", "word"),
    [
        ("chain", "endurance"),
        ("stranded_rope_stress", "diameter"),
        ("{}", "curve"),
    ],
)
def test_curves_that_cannot_be_used_are_reported_before_anything_runs(tmp_path, curve, word):
    path = study_cases.write_text(tmp_path, SEEDS, assess=f"{{fatigue: {{response: SWL/x, curve: {curve}}}}}")
    with pytest.raises(CaseError) as caught:
        load_study(path)
    assert word in str(caught.value)


def test_labels_that_a_group_inherits_are_labels_too(tmp_path):
    _, result = assessed(
        tmp_path,
        "- seeds: {path: 'waves[storm].seed', count: 3}",
        "{extremes: {response: 'SWL/time/storm/realisation/tension[line=shoreward]', family: weibull}}",
        study_cases.nested_case,
    )
    assert np.isfinite(float(result.tree["assessment/extremes 1"]["design_value"]))
    table = StudyTable(result.tree)
    assert table.column("tension_mean_in_time[line=seaward]").values.shape == (3,)


def test_an_answer_far_beyond_the_peaks_that_were_found_is_noticed():
    (notice,) = _far_beyond(2000.0, 300)
    assert notice.code == "extremes-far" and notice.value == pytest.approx(2000.0 / 300.0)
    assert _far_beyond(600.0, 300) == ()
