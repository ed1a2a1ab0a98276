"""Realisations of an irregular sea: each is the run of its seed, and the first page shows their mean."""

from __future__ import annotations

import re

import numpy as np
import pytest
import xarray as xr

from moyai import run
from moyai.core.headline import Headline
from moyai.core.results import Result
from moyai.sea.irregular import realisation_seed
from moyai.series.intervals import reach_of_mean

CASE = """
moyai: 1
title: Float on two ropes
site: {water_depth: 15 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
waves:
  - {name: storm, kind: jonswap, significant_height: 1.0 m, peak_period: 5 s, peak_enhancement: 3.3, heading_deg: 0,
     duration: 30 s, seed: 4}
  - {name: swell, kind: regular, height: 0.5 m, period: 5 s, heading_deg: 0}
structure:
  kind: network
  line_types:
    rope: {diameter: 24 mm, mass: 0.4 kg/m, axial_stiffness: 60 kN, damping_ratio: 0.3, drag_normal: 1.2,
           drag_tangential: 0.05, added_mass_normal: 1.0, breaking_load: 100 kN}
  points:
    west: {kind: fixed, position: [-12 m, 0, bed]}
    east: {kind: fixed, position: [12 m, 0, bed]}
    float: {kind: sphere, position: [0, 0, -1.5 m], diameter: 1.2 m, mass: 200 kg, drag_coefficient: 0.5,
            added_mass_coefficient: 0.5}
  lines:
    west line: {start: west, end: float, type: rope, length: 17.5 m, segments: 6}
    east line: {start: east, end: float, type: rope, length: 17.5 m, segments: 6}
analyses: [statics, dynamic]
settings: {skip: 8 s, duration: 20 s, mesh_check: off, realisations: 4}
"""


@pytest.fixture(scope="module")
def found() -> Result:
    return run(CASE)


def _storm(result: Result, run_name: str = "storm") -> xr.Dataset:
    dynamic = next(group for group in result.tree.subtree if group.path.endswith("/dynamic"))
    return dynamic.to_dataset().sel(run=run_name)


def _headline(result: Result, name: str) -> Headline:
    return next(item for item in result.headlines if item.name == name)


@pytest.mark.slow
def test_each_realisation_is_the_run_of_its_seed(found: Result) -> None:
    dynamic = _storm(found)
    seeds = [realisation_seed(4, number) for number in range(4)]
    assert dynamic["seed_of_realisation"].values.tolist() == seeds
    tension = dynamic["line_tension_maximum_of_realisation"]
    assert np.array_equal(tension.isel(member=0).values, dynamic["line_tension_maximum"].values)
    again = re.sub("seed: 4", f"seed: {seeds[2]}", CASE).replace("realisations: 4", "realisations: 1")
    alone = _storm(run(again))
    assert "line_tension_maximum_of_realisation" not in alone
    np.testing.assert_allclose(tension.isel(member=2).values, alone["line_tension_maximum"].values, rtol=2e-3)
    load = dynamic["point_load_maximum_of_realisation"].isel(member=2).sel(measure="size").values
    np.testing.assert_allclose(load, alone["point_load_maximum"].values, rtol=2e-3)
    excursion = dynamic["point_excursion_of_realisation"].isel(member=2).values
    np.testing.assert_allclose(excursion, alone["point_excursion"].values, rtol=1e-3, atol=1e-9)


@pytest.mark.slow
def test_the_first_page_shows_the_mean_and_judges_its_end(found: Result) -> None:
    dynamic = _storm(found)
    tension = _headline(found, "line_tension")
    line = max(("west line", "east line"), key=lambda name: float(
        dynamic["line_tension_maximum_of_realisation"].sel(line=name).mean()))  # fmt: skip
    values = dynamic["line_tension_maximum_of_realisation"].sel(line=line).values
    assert tension.value == pytest.approx(values.mean())
    assert tension.where == f"{line}, storm"
    band = tension.band
    assert band is not None and band.judged is not None
    assert (band.low, band.high) == pytest.approx((values.min(), values.max()))
    assert band.judged[1] == pytest.approx(values.mean() + reach_of_mean(values))
    assert not band.decides and band.more == "settings.realisations"
    # 22 s count, four periods: the mean of four such records is no storm's
    assert tension.bound == "at least" and "4 records of 22 s, less than 24 periods" in tension.detail
    use = _headline(found, "line_utilisation").band
    assert use is not None and use.judged is not None
    assert use.judged[1] == pytest.approx(band.judged[1] / 100e3)


@pytest.mark.slow
def test_a_regular_wave_has_none(found: Result) -> None:
    values = _storm(found, "swell")["line_tension_maximum_of_realisation"].values
    assert np.isnan(values).all()


@pytest.mark.slow
def test_they_are_run_without_being_asked_for_where_they_take_little_time() -> None:
    result = run(CASE.replace(", realisations: 4", ""))
    tension = _headline(result, "line_tension").band
    assert tension is not None and tension.realisations >= 4


@pytest.mark.slow
def test_realisations_that_are_not_run_are_said() -> None:
    result = run(CASE.replace("realisations: 4", "realisations: 4, method: tr_bdf2").replace("30 s,", "12 s,"))
    assert any(notice.code == "realisations-left-out" for notice in result.notices)


NET = """
moyai: 1
title: Net hung in a sea
site: {water_depth: 8 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
waves: {kind: jonswap, name: storm, significant_height: 0.5 m, peak_period: 4 s, peak_enhancement: 3.3, heading_deg: 0,
        duration: 6 s, seed: 1}
structure:
  kind: network
  nets:
    wall:
      corners: [[0, 0, -0.5 m], [0, 3 m, -0.5 m], [0, 3 m, -2.5 m], [0, 0, -2.5 m]]
      rows: 3
      columns: 4
      twine: {diameter: 3 mm, mesh_pitch: 30 mm, density: 1140 kg/m3, modulus: 12 MPa, damping_ratio: 0.2,
              drag_normal: 1.2, drag_tangential: 0.02}
      first_row: fixed
      ballast: 6 kg/m
analyses: [statics, dynamic]
settings: {realisations: 2, mesh_check: off}
criteria: {greatest_tension: 150 N}
"""


def test_a_net_without_points_has_realisations_of_its_tension() -> None:
    dynamic = _storm(run(NET))
    assert dynamic["net_tension_maximum_of_realisation"].sel(net="wall").size == 2
    assert "point_load_maximum_of_realisation" not in dynamic


@pytest.mark.slow
@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_a_record_of_a_few_rows_shows_no_way_and_no_warning_of_numpy() -> None:
    result = run(CASE.replace("realisations: 4", "realisations: 2, output_step: 8 s"))
    assert _headline(result, "offset").value > 0.0
    assert not any(notice.code == "still-drifting" for notice in result.notices)


DRIFTING = """
moyai: 1
title: Buoy that drifts in a sea without a current
site: {water_depth: 18 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
waves: {kind: jonswap, name: storm, significant_height: 0.8 m, peak_period: 4.5 s, peak_enhancement: 3.3,
        heading_deg: 0, seed: 5, duration: 150 s}
structure:
  kind: network
  line_types:
    rope: {diameter: 36 mm, mass: 0.8 kg/m, axial_stiffness: 600 kN, damping_ratio: 0.3, drag_normal: 1.2,
           drag_tangential: 0.02, added_mass_normal: 1.0, breaking_load: 150 kN}
  points:
    anchor: {kind: fixed, position: [0, 0, bed]}
    buoy: {kind: sphere, position: [2 m, 0, 0], diameter: 1.6 m, mass: 600 kg, drag_coefficient: 0.6,
           added_mass_coefficient: 0.5}
  lines:
    rode: {start: anchor, end: buoy, type: rope, length: 30 m, segments: 16}
analyses: [dynamic]
settings: {mesh_check: off, realisations: 20}
criteria: {greatest_offset: 15 m}
"""


@pytest.mark.slow
def test_a_buoy_on_its_way_in_a_sea_without_a_current_is_not_judged() -> None:
    """In ten minutes it goes 17 to 20 m; the first realisation of 150 s goes to and fro and hides it."""
    result = run(DRIFTING)
    assert any(notice.code == "still-drifting" for notice in result.notices)
    offset = _headline(result, "offset")
    assert offset.bound == "at least" and offset.value < 15.0
    assert result.verdict.outcome == "not judged"
