"""The storm that came out several times too low without slow drift: defaults, switches, and lines out of range."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from breakwater_designs import DESIGNS
from kept_runs import kept_run

from moyai.case.builder import build
from moyai.case.reader import load_case
from moyai.structures.breakwater.report.reading import all_numbers, water_levels
from moyai.structures.breakwater.report.tables import governing_tables
from moyai.structures.breakwater.run import run
from moyai.tables.lines import line_type

STORM = DESIGNS[-1]


def result_of(folder, design=STORM, **options):
    return run(build(load_case(design.write(folder, **options))))


def headline(result, name):
    return next(item for item in result.headlines if item.name == name)


def codes(result):
    return {notice.code: notice for notice in result.notices}


@pytest.mark.slow
def test_slow_drift_is_on_and_switching_it_off_is_reported(tmp_path):
    quick = "realisations: 1, lines: {mode: quasi_static}"
    with_drift = result_of(tmp_path, duration=300.0, settings=f"settings: {{time: {{{quick}}}}}")
    without = result_of(tmp_path, duration=300.0, settings=f"settings: {{time: {{drift: ramped, {quick}}}}}")
    sea = with_drift.tree["SWL/frequency/storm"].to_dataset()
    assert with_drift.tree["SWL/time/storm"].attrs["drift"] == "newman"
    assert "slow-drift-off" not in codes(with_drift)
    reported = codes(without)["slow-drift-off"]
    assert reported.severity == "warning" and reported.value == pytest.approx(float(sea.slow_motion_deviation[0]))
    # 300 s hold a dozen natural periods of sway
    few = codes(with_drift)["few-slow-cycles"]
    assert few.value == pytest.approx(300.0 / float(sea.slow_sway_period)) and few.limit == 25.0
    offsets = [headline(result, "offset").value for result in (with_drift, without)]
    assert offsets[0] > offsets[1] + float(sea.slow_motion_deviation[0])


@pytest.mark.slow
def test_a_peak_out_of_range_is_not_known_and_never_the_headline(tmp_path):
    # No line on the bed at high water: chains of 61.5 m to 61.3 m of chord, at rest at every instant by the case's wish
    design = replace(STORM, chain=60, line=61.5)
    settings = "settings: {time: {realisations: 1, lines: {mode: quasi_static}}}"
    result = result_of(tmp_path, design, duration=300.0, settings=settings)
    time = result.tree["SWL/time/storm"].to_dataset()
    assert float((time.line_tension_maximum / time.line_tension_mean).max()) > 5.0
    for name in ("line_tension", "line_utilisation", "anchor_vertical_tension"):
        assert headline(result, name).text == "not known"
    assert "quasi-static-snap" in codes(result)
    assert result.status == "converged"


def test_a_light_line_is_a_judgement_of_the_design_not_of_the_computation(tmp_path):
    design = replace(STORM, chain=60, line=61.5)
    result = result_of(tmp_path, design, analyses="statics, frequency")
    assert result.status == "converged"
    assert float(result.tree["SWL/frequency/storm"].to_dataset().maximum_utilisation.max()) > 0.5
    # lines at rest are far out of their range here: the row says so, the headline is not known, nothing holds
    (row,) = all_numbers(water_levels(result))
    ratio = result.tree["SWL/frequency/storm"].to_dataset()
    assert row.beyond_range == pytest.approx(float((ratio.line_tension_maximum / ratio.line_tension_mean).max()))
    (loads, _) = governing_tables((row,), None)
    marks = next(column for column in loads.columns if column.label == "Range of the line model")
    assert marks.values[0].startswith("OUT OF RANGE")
    assert headline(result, "line_utilisation").text == "not known" and result.verdict.outcome != "holds"


@pytest.mark.slow  # five realisations and five windows with lines in motion: half a minute
def test_the_storm_with_all_defaults(tmp_path):
    result = result_of(tmp_path, duration=450.0)
    ramped = result_of(tmp_path, duration=450.0, settings="settings: {time: {drift: ramped}}")
    tension, still = (headline(item, "line_tension") for item in (result, ramped))
    assert tension.model == "time domain, lines in motion"
    # The slow excursions take up the slack of the chains: more than twice the tension, in the mean of five
    assert tension.value > 2.0 * still.value
    time = result.tree["SWL/time/storm"].to_dataset()
    assert tension.value < float(time.line_tension_maximum_lines_at_rest.max())
    assert headline(result, "anchor_vertical_tension").value > 0.0
    # every event whose tension with lines at rest passes the largest in motion was rerun, or bounds what is judged
    assert float(time.events_in_motion.max()) >= 1.0
    line = int(time.line_tension_maximum.values.argmax())
    bound = time.line_tension_bound_of_realisation.values[:, line]
    assert np.all(bound >= time.line_tension_maximum_of_realisation.values[:, line])
    # the factor is that of dynamic analysis
    factors = {item.criterion.analysis: item for item in result.verdict.judgements if item.criterion.as_factor}
    assert 1.0 / factors["dynamic"].criterion.limit == pytest.approx(1.67)
    assert {"realisation", "event"} <= set(result.tree["SWL/time/storm"].children)


@pytest.mark.slow  # three hours of sea at two levels: two minutes
def test_the_first_example_holds():
    result = kept_run(Path(__file__).parents[2] / "examples" / "pontoon.yaml")
    assert result.status == "converged" and result.verdict.outcome == "holds"
    assert headline(result, "anchor_vertical_tension").text == "none"
    # by hand: the chain that lifts off under the largest pull of a realisation, sqrt(h^2 + 2 h H/w), is shorter than it
    time = result.tree["LWL/time/design storm"].to_dataset()
    statics = result.tree["LWL/statics"].to_dataset()
    pull = float(time.anchor_horizontal_tension_maximum_of_realisation.max())
    given = line_type("studless_chain_R3", 0.068)
    weight = 9.81 * (given.mass_per_length - 1025.0 * given.volume_per_length)
    # the chain goes slack for an instant: twice the bars have been tried, and change next to nothing
    assert float(time.slack_time[0]) > 0.0 and abs(float(time.peak_change_twice_the_bars[0])) < 0.02
    assert "twice the bars" in headline(result, "line_tension").band.of
    drop = 10.0 - float(statics.draught)
    assert np.sqrt(drop**2 + 2.0 * drop * pull / weight) < 95.0


def test_steady_load_and_its_parts_by_hand(tmp_path):
    result = result_of(tmp_path, analyses="statics, frequency")
    load = headline(result, "steady_load")
    wind = 0.5 * 1.225 * 1.2 * STORM.length * (STORM.hull - STORM.draught) * STORM.wind**2
    current = 0.5 * 1025.0 * 1.5 * STORM.length * STORM.draught * STORM.current**2
    drift = float(result.tree["SWL/frequency/storm"].to_dataset().mean_drift_force)
    assert load.value == pytest.approx(wind + current + drift, rel=1e-6)
    assert load.detail.startswith(f"wind {wind / 1e3:.3g} kN, current {current / 1e3:.3g} kN, mean drift")
    assert "one line lost" in headline(result, "not_judged").text


MARINA = """
moyai: 1
title: Marina pontoon 30 x 5 m
site:
  water_depth: 15 m
  water_levels: {HWL: 2 m}
  density: 1025 kg/m3
  gravity: 9.81 m/s2
waves:
  - name: design
    kind: jonswap
    significant_height: 0.9 m
    peak_period: 3.6 s
    peak_enhancement: 3.3
    heading_deg: 20
    duration: 6 min
    seed: 7
wind: {speed: 22 m/s, heading_deg: 0, density: 1.225 kg/m3}
current: {speed: 0.4 m/s, heading_deg: 0}
structure:
  kind: breakwater
  length: 30 m
  section: {shape: rectangle, beam: 5 m, height: 1.8 m}
  draught: 1.2 m
  centre_of_gravity_above_keel: 0.85 m
  roll_gyradius: 1.6 m
  wind_drag_coefficient: 1.2
  current_drag_coefficient: 1.5
lines:
  - name: seaward
    count: 3
    fairlead: {x: -2.5 m, above_keel: 0.2 m}
    anchor: {x: -62 m}
    segments:
      - {catalogue: studless_chain_R3, diameter: 36 mm, length: 66 m}
  - name: shoreward
    count: 3
    fairlead: {x: 2.5 m, above_keel: 0.2 m}
    anchor: {x: 62 m}
    segments:
      - {catalogue: studless_chain_R3, diameter: 36 mm, length: 66 m}
analyses: [statics, mooring, frequency, time]
criteria:
  greatest_transmission: {design: 0.5}
  greatest_offset: 3 m
  least_freeboard: 0.5 m
"""


@pytest.mark.slow  # six minutes of sea with lines in motion all along
def test_events_in_motion_stand_for_the_whole_sea_in_motion(tmp_path):
    """A slack chain, within the range of lines at rest, whose drag adds a fourth to the tension of the waves.

    The number of the first page comes from reruns of the largest events; the whole sea with lines in motion from the
    start is the check.
    """
    from moyai.case.reader import case_of
    from moyai.case.yaml_reader import parse_yaml

    def tension(mode):
        text = f"{MARINA}settings: {{time: {{realisations: 2, lines: {{mode: {mode}}}}}}}\n"
        return headline(run(build(case_of(parse_yaml(text, "marina.yaml"), tmp_path / "marina.yaml"))), "line_tension")

    found, dynamic, rest = (tension(mode) for mode in ("auto", "dynamic", "quasi_static"))
    assert found.model == dynamic.model == "time domain, lines in motion"
    # 10 %: the slow sway before an event is that of lines at rest
    assert found.value == pytest.approx(dynamic.value, rel=0.1)
    assert dynamic.value > 1.15 * rest.value and found.value > 1.1 * rest.value
