"""Whole runs of rows of units: template to report, goes on where it was stopped, linear in the wave height."""

from pathlib import Path

import numpy as np
import pytest
from japanese import compared
from renamed import unmissed

import moyai
from moyai.case.builder import build
from moyai.case.reader import case_of
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.core.store import DatasetStore
from moyai.structures.units.report.page import compose
from moyai.structures.units.run import run

SMALL = (
    ("points_across: 15", "points_across: 5"), ("points_along: 15", "points_along: 5"), ("count: 3,", "count: 2,"),
    ("count: 8}", "count: 5}"), ("panel_size: 2 m", "panel_size: 5 m"), ("duration: 3 h", "duration: 10 min"),
    ("  # time: {realisations: 5, memory_frequencies: 24}", "  time: {realisations: 2, memory_frequencies: 14}"),
)  # fmt: skip


def problem(*changes):
    text = template("units")
    for old, new in (*SMALL, *changes):
        assert old in text, old
        text = text.replace(old, new, 1)
    return build(case_of(parse_yaml(text, "case.yaml"), Path("case.yaml")))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("store")


@pytest.fixture(scope="module")
def result(folder):
    return run(problem(), store=DatasetStore(folder))


@pytest.mark.slow
def test_whatever_is_renamed_is_missed(result):
    # of regular waves in time, and of irregular ones
    assert sorted(unmissed(result)) == ["motion_amplitude", "seed_of_realisation"]


@pytest.mark.slow
def test_the_template_runs_and_its_numbers_stand_on_the_first_page(result):
    assert {item.name for item in result.headlines} >= {
        "connector_force", "connector_utilisation", "connector_moment", "line_tension", "line_utilisation", "offset",
        "roll", "transmission", "berth_wave_height", "freeboard", "metacentric_height",
    }  # fmt: skip
    storm = result.tree["SWL/frequency/storm"].to_dataset()
    assert storm["connector_resultant_largest"].shape == (1,)
    # a pin along x bears no moment about it and lets its ends not part
    assert float(storm["connector_moment_largest"].sel(component="x").max()) < 1e-6 * float(
        storm["connector_moment_largest"].max()
    )
    assert float(storm["relative_motion_largest"].max()) < 1e-9


@pytest.mark.slow
def test_waves_ahead_of_the_row_are_higher_and_behind_it_lower(result):
    data = result.tree["SWL/map/operation"].to_dataset().sel(period=5.0)
    assert float(data["transmission_coefficient"]) < 0.95
    assert float(data["wave_height_ratio"].sel(x=-40.0, method="nearest").max()) > 1.0
    assert float(data["section_transmission"]) == pytest.approx(float(data["transmission_coefficient"]), abs=0.2)


@pytest.mark.slow
def test_the_band_is_what_half_and_twice_the_damping_give(result, folder):
    """Roll and transmission of the frequency domain: a run with half of the damping stands at one end of the band."""
    half = run(
        problem(
            ("fraction_of_critical: 0.1,", "viscous_factor: 0.5, fraction_of_critical: 0.05,"),
            (", time, map]", ", map]"),
        ),
        store=DatasetStore(folder),
    )
    for path, name in (
        ("SWL/frequency/storm", "significant_motion"), ("SWL/map/operation", "transmission_coefficient"),
    ):  # fmt: skip
        given, other = (item.tree[path].to_dataset() for item in (result, half))
        low, high, own = (given[f"{name}{end}"].values for end in ("_low", "_high", ""))
        found = other[name].values
        assert np.all((low <= own) & (own <= high))
        assert np.all(np.fmin(abs(found - low), abs(found - high))[own > 0.0] < 1e-6 * own[own > 0.0])
        assert np.any(found != own)
    shown = next(item for item in result.headlines if item.name == "transmission" and item.shown)
    assert shown.band is not None and shown.band.low < shown.value < shown.band.high
    assert "damping of the units" in shown.band.of


@pytest.mark.slow
def test_the_report_has_map_connectors_and_lines(result, tmp_path):
    document = compose(result)
    keys = [block.key for block in document.blocks() if hasattr(block, "key")]
    for wanted in ("plan", "map-storm", "connectors-storm", "motions-storm", "tensions-storm", "line-behind-storm"):
        assert any(wanted in key for key in keys), (wanted, keys)
    moyai.write_report(result, tmp_path / "report")


@pytest.mark.slow
def test_a_stopped_run_keeps_its_frequencies_and_goes_on(result, folder):
    kept = {path.name: path.stat().st_mtime_ns for path in folder.glob("*.nc")}
    frequencies = 5 + 2
    band = result.tree["SWL/memory"].to_dataset().sizes["omega"]
    assert band > frequencies
    # coefficients of the band of the memory, waves of the map at the frequencies of the seas
    assert len(kept) == band + frequencies
    again = run(problem(), store=DatasetStore(folder))
    assert {path.name: path.stat().st_mtime_ns for path in folder.glob("*.nc")} == kept
    for group in ("SWL/frequency/storm", "SWL/map/operation", "SWL/time/storm"):
        first, second = (item.tree[group].to_dataset() for item in (result, again))
        for name in first:
            assert np.allclose(first[name], second[name], rtol=1e-9, atol=1e-12, equal_nan=True), name

    def stop(what, done, total):
        if what == "coefficients of the row" and done == 2:
            raise KeyboardInterrupt

    stopped = run(problem(("panel_size: 5 m", "panel_size: 4 m")), stop, store=DatasetStore(folder))
    assert stopped.status == "interrupted"
    assert len(list(folder.glob("*.nc"))) == len(kept) + 2


@pytest.mark.slow
def test_linear_waves_move_the_row_in_proportion(folder):
    fixed = ("drift: true", "drift: false")
    linear = ("[statics, frequency, time, map]", "[statics, frequency]")
    no_eddies = ("viscous: computed", "viscous: none")
    low, high = (
        run(problem(fixed, linear, no_eddies, ("height: 0.8 m", f"height: {height} m")), store=DatasetStore(folder))
        for height in (0.2, 0.8)
    )
    for name in ("motion_amplitude", "connector_force_amplitude", "tension_amplitude"):
        first, second = (item.tree["SWL/frequency/operation"].to_dataset()[name].values for item in (low, high))
        assert np.allclose(4.0 * first, second, rtol=1e-9, atol=1e-9 * np.abs(second).max()), name


@pytest.mark.slow
def test_the_time_domain_governs_and_its_realisations_scatter(result):
    numbers = {item.name: item for item in result.headlines}
    time, frequency = (result.tree[f"SWL/{domain}/storm"].to_dataset() for domain in ("time", "frequency"))
    assert numbers["connector_force"].model == "time domain, three dimensions"
    scatter = time["connector_resultant_largest_of_realisation"].values
    assert scatter.shape == (2, 1)
    assert numbers["connector_force"].value == pytest.approx(float(scatter.mean()))
    # the damping of the units is as uncertain as in the frequency domain
    low, own = (float(frequency[f"connector_resultant_largest{end}"].values[0]) for end in ("_low", ""))
    assert numbers["connector_force"].band.low == pytest.approx(float(scatter.min()) * low / own)
    assert low < own
    assert numbers["offset"].bound == ""
    assert len(result.provenance["seeds"]) == 2
    # motions at wave frequencies are those of the frequency domain, slow drift comes on top in sway
    heave, sway = (
        float(time["significant_motion"].sel(unit=1, dof=dof) / frequency["significant_motion"].sel(unit=1, dof=dof))
        for dof in ("heave", "sway")
    )
    assert heave == pytest.approx(1.0, abs=0.1)
    assert sway > 1.0
    regular, other = (result.tree[f"SWL/{domain}/operation"].to_dataset() for domain in ("time", "frequency"))
    for dof in ("sway", "heave", "roll"):
        one, two = (item["motion_amplitude"].sel(dof=dof).values for item in (regular, other))
        assert np.allclose(one, two, rtol=0.05), dof


@pytest.mark.slow
def test_an_irregular_sea_of_one_frequency_is_a_regular_sea(result):
    """Energy at the peak: significant motion of a narrow sea over its height is the operator at the peak."""
    storm = result.tree["SWL/frequency/storm"].to_dataset()
    height = float(storm["significant_height"])
    heave = float(storm["significant_motion"].sel(unit=1, dof="heave")) / height
    assert 0.2 < heave < 2.0


@pytest.mark.slow
def test_the_report_in_japanese_has_no_english_word(result):
    left, count = compared(result)
    assert count > 200
    assert not left, "\n".join(left)
