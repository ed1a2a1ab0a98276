"""The storm that came out several times too low without slow drift: defaults, switches, and lines out of range."""

from dataclasses import replace

import pytest
from breakwater_designs import DESIGNS

from moyai.case.builder import build
from moyai.case.reader import load_case
from moyai.structures.breakwater.run import run

STORM = DESIGNS[-1]


def result_of(folder, design=STORM, **options):
    return run(build(load_case(design.write(folder, **options))))


def headline(result, name):
    return next(item for item in result.headlines if item.name == name)


def codes(result):
    return {notice.code: notice for notice in result.notices}


def test_slow_drift_is_on_and_switching_it_off_is_told(tmp_path):
    quick = "realisations: 1, lines: {mode: quasi_static}"
    with_drift = result_of(tmp_path, duration=300.0, settings=f"settings: {{time: {{{quick}}}}}")
    without = result_of(tmp_path, duration=300.0, settings=f"settings: {{time: {{drift: ramped, {quick}}}}}")
    sea = with_drift.tree["SWL/frequency/storm"].to_dataset()
    assert with_drift.tree["SWL/time/storm"].attrs["drift"] == "newman"
    assert "slow-drift-off" not in codes(with_drift)
    told = codes(without)["slow-drift-off"]
    assert told.severity == "warning" and told.value == pytest.approx(float(sea.slow_motion_deviation[0]))
    # 300 s hold a dozen natural periods of sway
    few = codes(with_drift)["few-slow-cycles"]
    assert few.value == pytest.approx(300.0 / float(sea.slow_sway_period)) and few.limit == 25.0
    offsets = [headline(result, "offset").value for result in (with_drift, without)]
    assert offsets[0] > offsets[1] + float(sea.slow_motion_deviation[0])


def test_a_peak_out_of_range_is_not_known_and_never_the_headline(tmp_path):
    # No line on the bed at high water: chains of 61.5 m to 61.3 m of chord, at rest at every instant by the case's wish
    design = replace(STORM, chain=60, line=61.5)
    settings = "settings: {time: {realisations: 1, lines: {mode: quasi_static}}}"
    result = result_of(tmp_path, design, duration=300.0, settings=settings)
    time = result.tree["SWL/time/storm"].to_dataset()
    assert float((time.maximum_tension / time.mean_tension).max()) > 5.0
    for name in ("line_tension", "line_utilisation", "anchor_uplift"):
        assert headline(result, name).text == "not known"
    assert "quasi-static-snap" in codes(result)
    assert result.status == "converged"


def test_a_light_line_is_a_judgement_of_the_design_not_of_the_computation(tmp_path):
    design = replace(STORM, chain=60, line=61.5)
    result = result_of(tmp_path, design, analyses="statics, frequency")
    assert result.status == "converged"
    assert float(result.tree["SWL/frequency/storm"].to_dataset().maximum_utilisation.max()) > 0.5


@pytest.mark.slow  # five realisations and five windows with lines in motion: half a minute
def test_the_storm_with_all_defaults(tmp_path):
    result = result_of(tmp_path, duration=900.0)
    ramped = result_of(tmp_path, duration=900.0, settings="settings: {time: {drift: ramped}}")
    tension, still = (headline(item, "line_tension") for item in (result, ramped))
    assert tension.model == "time domain, lines in motion"
    # The slow excursions take up the slack of the chains: more than twice the tension, in the mean of five
    assert tension.value > 2.0 * still.value
    time = result.tree["SWL/time/storm"].to_dataset()
    assert tension.value < float(time.maximum_tension_lines_at_rest.max())
    assert headline(result, "anchor_uplift").value > 0.0
    assert {"realisation", "event"} <= set(result.tree["SWL/time/storm"].children)
