"""What the first page says of lines: nothing out of its range is under "holds", and what is chance is said."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from moyai.core.headline import Criterion, judge
from moyai.structures.breakwater import responses
from moyai.structures.breakwater.lines.headlines import (
    AT_REST,
    IN_MOTION,
    LinePeak,
    anchor_headlines,
    line_headlines,
    line_peaks,
)
from moyai.structures.breakwater.report import reading as breakwater_reading
from moyai.structures.breakwater.report.tables import range_words, sway_words

SCATTER = np.array([300e3, 400e3, 500e3, 450e3, 350e3])
GOVERNS = LinePeak(
    "HWL", "storm", "seaward", np.nan, 400e3, 50e3, 4e6, -1.0, 390e3, 5.0, IN_MOTION, True, SCATTER, -SCATTER,
    0.97 * SCATTER, SCATTER,
)  # fmt: skip
OTHER = replace(
    GOVERNS, line="shoreward", tension=200e3, mean=30e3, horizontal=190e3, model=AT_REST, known=False,
    scatter=0.5 * SCATTER, bound=0.5 * SCATTER,
)  # fmt: skip
FACTOR = Criterion("factor", "line_utilisation", 0.5, "at most", "case", as_factor=True)
UPLIFT = Criterion("uplift", "anchor_vertical_tension", 0.0, "at most", "case", unit="N")


def page(*peaks):
    return [*line_headlines(list(peaks)), *anchor_headlines({}, [], list(peaks))]


def headline(numbers, name):
    return next(item for item in numbers if item.name == name and item.shown)


def test_a_line_out_of_range_that_does_not_govern_keeps_the_design_from_holding():
    assert judge(page(GOVERNS), (FACTOR, UPLIFT), computed=True).outcome == "holds"
    numbers = page(GOVERNS, OTHER)
    # the governing number stays on the page
    assert headline(numbers, "line_tension").value == 400e3
    verdict = judge(numbers, (FACTOR, UPLIFT), computed=True)
    assert verdict.outcome == "not judged"
    assert "line shoreward: not known" in verdict.message and "6.7 times the mean" in verdict.message


def test_what_the_reruns_leave_open_is_judged():
    opened = replace(GOVERNS, bound=SCATTER + 2e6)
    found = headline(line_headlines([opened]), "line_utilisation")
    closed = headline(line_headlines([GOVERNS]), "line_utilisation")
    assert found.value == closed.value and found.band.judged[1] == pytest.approx(closed.band.judged[1] + 0.5)
    assert "could raise the mean to 2400 kN" in headline(line_headlines([opened]), "line_tension").detail
    assert judge([closed], (FACTOR,), computed=True).outcome == "holds"
    assert judge([found], (FACTOR,), computed=True).outcome == "does not hold"


def test_what_is_beyond_its_range_in_one_realisation_alone_says_so():
    """A mean of 3 times the mean tension is no reason; the realisation that passes five times is."""
    peaks = np.array([60e3, 70e3, 80e3, 90e3, 150e3])
    one = replace(OTHER, tension=90e3, mean=30e3, scatter=peaks, bound=peaks)
    detail = headline(line_headlines([one]), "line_tension").detail
    assert "3.0 times the mean, in one realisation 5.0 times, beyond their range of 5" in detail
    assert "in one realisation" not in headline(line_headlines([OTHER]), "line_tension").detail


def test_a_level_within_the_scatter_is_not_distinguished():
    lower = replace(GOVERNS, level="LWL", tension=380e3, scatter=SCATTER - 20e3)
    assert "not distinguished from LWL (380 kN)" in headline(line_headlines([GOVERNS, lower]), "line_tension").detail
    # Student's 2.13 times the standard error of 35 kN, of both: 107 kN
    lower = replace(GOVERNS, level="LWL", tension=280e3, scatter=SCATTER - 120e3)
    assert "distinguished" not in headline(line_headlines([GOVERNS, lower]), "line_tension").detail


def test_the_highest_of_each_analysis_is_judged_by_its_own_factor():
    still = replace(OTHER, known=True)
    analyses = [item.analysis for item in line_headlines([GOVERNS, still]) if item.name == "line_utilisation"]
    assert analyses == ["dynamic", "quasi_static"]


def test_rows_of_tables_say_what_they_hold():
    assert breakwater_reading.SNAP_RATIO == responses.SNAP_RATIO
    assert range_words(np.nan) == "" and range_words(7.0) == "OUT OF RANGE: 7.0 times the mean"
    assert sway_words("time", False) == "waves and slow drift" and sway_words("frequency", False) == "waves alone"


def test_without_uplift_the_line_that_leaves_least_on_the_bed_is_named():
    calm = replace(GOVERNS, level="LWL", sea="operation", vertical=-0.5, grounded=40.0)
    uplift = headline(anchor_headlines({}, [], [calm, GOVERNS]), "anchor_vertical_tension")
    assert uplift.where == GOVERNS.where and uplift.detail.startswith("5 m of line stays on the bed")


def test_one_realisation_proves_that_a_limit_is_broken_and_nothing_else():
    one = replace(
        GOVERNS, tension=300e3, scatter=SCATTER[:1], bound=SCATTER[:1], vertical_scatter=-SCATTER[:1],
        horizontal_scatter=0.97 * SCATTER[:1],
    )  # fmt: skip
    numbers = page(one)
    tension = headline(numbers, "line_tension")
    assert tension.bound == "at least" and "one realisation: others may give more" in tension.detail
    assert judge(numbers, (FACTOR,), computed=True).outcome == "not judged"
    strict = replace(FACTOR, limit=0.05)
    assert judge(numbers, (strict,), computed=True).outcome == "does not hold"
    # a regular wave has no chance in it
    regular = replace(one, scatter=np.zeros(0), bound=np.zeros(0))
    assert judge(line_headlines([regular]), (FACTOR,), computed=True).outcome == "holds"


def test_a_sea_without_its_slow_drift_proves_no_strength():
    numbers = page(replace(GOVERNS, without_drift=True))
    tension = headline(numbers, "line_tension")
    assert tension.bound == "at least" and "slow drift of the sea is not in it" in tension.detail
    assert judge(numbers, (FACTOR,), computed=True).outcome == "not judged"
    assert judge(numbers, (UPLIFT,), computed=True).outcome == "not judged"
    assert judge(numbers, (replace(FACTOR, limit=0.05),), computed=True).outcome == "does not hold"


def test_every_regular_wave_is_judged_by_a_code_that_weighs_the_mean():
    """13.8 kN of which 12.2 stand at 3 s keep a limit of 1.1 mean + 1.5 varying part that 13.1 of 7.3 at 10 s break."""
    coords = {"period": [3.0, 10.0], "line": ["seaward"]}
    data = xr.Dataset(
        {
            "line_tension_maximum": (("period", "line"), [[13.80e3], [13.12e3]]),
            "line_tension_mean": (("period", "line"), [[12.22e3], [7.28e3]]),
        },
        coords=coords, attrs={"status": "converged"},
    )  # fmt: skip
    statics = xr.Dataset({"breaking_load": ("line", [17.1e3]), "unstretched_length": ("line", [60.0])})
    weighed = Criterion("factor", "line_utilisation", 0.95 / 1.5, "at most", "code", mean_weight=1.1 / 1.5)
    outcomes = []
    for part in (data.isel(period=[0]), data):
        peaks = line_peaks({"/SWL/statics": statics, "/SWL/time/daily": part}, "SWL")
        outcomes.append(judge(line_headlines(peaks), (weighed,), computed=True).outcome)
    assert outcomes == ["holds", "does not hold"]


def test_a_line_without_a_strength_next_to_one_that_has_it_is_not_judged():
    bare = replace(GOVERNS, line="bare", breaking_load=np.nan)
    verdict = judge(line_headlines([GOVERNS, bare]), (FACTOR,), computed=True)
    assert verdict.outcome == "not judged" and "breaking load not given of bare" in verdict.message
    # a spring has none
    spring = replace(bare, chain=False)
    assert judge(line_headlines([GOVERNS, spring]), (FACTOR,), computed=True).outcome == "holds"


def test_capacity_and_tension_are_the_largest_of_unlike_lines():
    """The weaker rope has the higher utilisation, the chain the larger tension and pull, with its own factor."""
    rope = replace(GOVERNS, line="rope", breaking_load=1e6)
    chain = replace(
        GOVERNS, line="chain", tension=500e3, horizontal=480e3, vertical=10e3, grounded=0.0, scatter=SCATTER + 100e3,
        horizontal_scatter=SCATTER + 80e3, vertical_scatter=0.0 * SCATTER + 10e3, bound=SCATTER + 100e3,
    )  # fmt: skip
    numbers = page(rope, chain)
    assert headline(numbers, "line_utilisation").value == pytest.approx(0.4)
    assert headline(numbers, "line_tension").value == 500e3
    capacity = headline(numbers, "anchor_capacity_required")
    assert capacity.value == pytest.approx(1.6 * 480e3) and "line chain, 1.6 times its pull" in capacity.where


def test_a_known_failure_wins_over_a_highest_line_that_is_not_known():
    """The line of the highest tension is beyond its range; another one breaks the limits of use, pull and uplift."""
    highest = replace(OTHER, tension=600e3, mean=40e3, horizontal=590e3, scatter=2.0 * SCATTER, bound=2.0 * SCATTER)
    weak = replace(
        GOVERNS, breaking_load=700e3, horizontal=350e3, vertical=20e3, vertical_scatter=20e3 + 0.0 * SCATTER,
    )  # fmt: skip
    highest = replace(highest, breaking_load=500e3)
    pull = Criterion("pull", "anchor_horizontal_tension", 300e3, "at most", "case", unit="N")
    for criterion in (FACTOR, UPLIFT, pull):
        alone = judge(page(highest), (criterion,), computed=True)
        assert alone.outcome == "not judged"
        verdict = judge(page(weak, highest), (criterion,), computed=True)
        assert verdict.outcome == "does not hold", criterion.name
        # what is known keeps a wider limit, what is not leaves it open
        wide = replace(criterion, limit=10e6)
        assert judge(page(weak, highest), (wide,), computed=True).outcome == "not judged"
    numbers = page(weak, highest)
    assert (
        headline(numbers, "line_utilisation").text == headline(numbers, "anchor_vertical_tension").text == "not known"
    )


def test_a_bound_behind_a_larger_known_number_leaves_its_limit_open():
    """A sea without its slow drift pulls less than a regular wave: with it, it may pull more."""
    known = replace(GOVERNS, vertical=50e3, vertical_scatter=0.1 * SCATTER)
    less = replace(
        known, sea="swell", tension=200e3, horizontal=190e3, scatter=0.5 * SCATTER, bound=0.5 * SCATTER, vertical=5e3,
        horizontal_scatter=0.48 * SCATTER, vertical_scatter=0.01 * SCATTER, without_drift=True,
    )  # fmt: skip
    lying = replace(less, vertical=-5e3, vertical_scatter=-SCATTER)
    pull = Criterion("pull", "anchor_horizontal_tension", 600e3, "at most", "case", unit="N")
    for criterion in (FACTOR, replace(UPLIFT, limit=100e3), pull):
        assert judge(page(known), (criterion,), computed=True).outcome == "holds"
        for other in (less, lying):
            numbers = page(known, other)
            assert judge(numbers, (criterion,), computed=True).outcome == "not judged", criterion.name
            assert [item.where for item in numbers if item.name == criterion.headline and item.shown] == [known.where]
            (shown,) = (item for item in numbers if item.name == "line_tension" and item.shown)
            assert "more is possible at" in shown.detail and "swell" in shown.detail
            assert "more is possible" not in headline(page(known), "line_tension").detail


def test_an_anchor_that_is_lifted_where_its_line_is_judged_does_not_hold():
    """Most probably it lies still; at the mean of the largest of storms alike it is lifted."""
    alone, nothing = replace(GOVERNS, vertical=0.0, factor=3.7), np.zeros(0)
    alone = replace(alone, scatter=nothing, vertical_scatter=nothing, horizontal_scatter=nothing, bound=nothing)
    ends = np.array([380e3, 410e3, 450e3])
    lifted = replace(alone, vertical_of_storms=np.array([-1.0, 40.0, 300.0]), horizontal_of_storms=ends)
    lies = replace(lifted, vertical_of_storms=np.array([-3.0, -2.0, -1.0]))
    uplift = headline(anchor_headlines({}, [], [lifted]), "anchor_vertical_tension")
    assert uplift.value == 0.0 and uplift.band.judged == (0.0, 40.0) and uplift.text == ""
    assert judge(page(lifted), (UPLIFT,), computed=True).outcome == "does not hold"
    assert headline(anchor_headlines({}, [], [lies]), "anchor_vertical_tension").text == "none"
    assert judge(page(lies), (UPLIFT,), computed=True).outcome == "holds"
    needs = [headline(anchor_headlines({}, [], [peak]), "anchor_capacity_required") for peak in (lies, lifted)]
    assert "line left on the bed" in needs[1].detail and needs[0].value < needs[1].value
    pull = headline(anchor_headlines({}, [], [lies]), "anchor_horizontal_tension")
    assert pull.band.judged == (390e3, 410e3) and pull.band.high == 450e3


def test_lines_that_snap_have_the_change_of_shorter_bars_in_their_band():
    plain, finer, coarser = (replace(GOVERNS, finer=change) for change in (np.nan, 0.1, -0.1))
    bands = [headline(line_headlines([peak]), "line_tension").band for peak in (plain, finer, coarser)]
    assert bands[1].high == pytest.approx(1.2 * bands[0].high) and bands[1].low == bands[0].low
    assert bands[1].judged[1] == pytest.approx(1.2 * bands[0].judged[1])
    assert bands[2].low == pytest.approx(0.8 * bands[0].low) and bands[2].judged[1] == bands[0].judged[1]
    assert "twice the bars change it by +10 %" in bands[1].of
    pull = headline(anchor_headlines({}, [], [finer]), "anchor_horizontal_tension").band
    assert pull.high == pytest.approx(1.2 * 0.97 * 500e3)
    # one that limits are kept by no longer
    limit = Criterion("factor", "line_tension", 1.1 * bands[0].judged[1], "at most", "case", unit="N")
    outcomes = [judge(line_headlines([peak]), (limit,), computed=True).outcome for peak in (plain, finer)]
    assert outcomes == ["holds", "does not hold"]


def test_a_tension_of_a_regular_wave_has_the_change_of_shorter_bars_too():
    """Where the variations are asked for: there are no realisations, the number itself is led on."""
    nothing = np.zeros(0)
    wave = replace(GOVERNS, scatter=nothing, vertical_scatter=nothing, horizontal_scatter=nothing, bound=nothing)
    found = replace(wave, finer=0.05)
    tension = headline(line_headlines([found]), "line_tension")
    pull = headline(anchor_headlines({}, [], [found]), "anchor_horizontal_tension")
    assert tension.band.judged[1] == pytest.approx(1.1 * 400e3) and pull.band.judged[1] == pytest.approx(1.1 * 390e3)
    assert headline(line_headlines([wave]), "line_tension").band is None
