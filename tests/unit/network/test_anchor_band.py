"""The pull on a fixed point has a band of its own: its peaks on other meshes, its own chance of seeds."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import moyai
from moyai.series.block_maxima import maximum_of
from moyai.structures.network.headlines import DYNAMIC, _band, _band_of_pull, _Peak

CASE = """
moyai: 1
title: Buoy on a rope
site: {water_depth: 8 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
waves: {kind: regular, name: swell, height: 0.8 m, period: 4 s, heading_deg: 0}
current: {speed: 0.6 m/s, heading_deg: 0}
structure:
  kind: network
  line_types:
    rope: {catalogue: nylon_8_strand, diameter: 24 mm, damping_ratio: 0.1}
  points:
    anchor: {kind: fixed, position: [0, 0, bed]}
    buoy: {kind: sphere, position: [10 m, 0, 0], diameter: 0.9 m, mass: 120 kg, drag_coefficient: 0.6,
           added_mass_coefficient: 0.5}
  lines:
    mooring: {start: anchor, end: buoy, type: rope, length: 14 m, segments: SEGMENTS}
analyses: [statics, dynamic]
settings: {start: rest_in_current, duration: 24 s, skip: 8 s, mesh_check: 'CHECK'}
"""


def _run(folder: Path, segments: int, check: str) -> moyai.Result:
    path = folder / f"{segments}{check}.yaml"
    path.write_text(CASE.replace("SEGMENTS", str(segments)).replace("CHECK", check), encoding="utf-8")
    return moyai.run(path)


@pytest.mark.slow
def test_the_pull_of_the_finer_mesh_is_that_of_a_run_on_it(tmp_path: Path) -> None:
    own, finer = (_run(tmp_path, *how) for how in ((8, "auto"), (16, "off")))
    summary, other = (found.tree["SWL/dynamic"].to_dataset().sel(point="anchor") for found in (own, finer))
    assert float(summary["point_load_double_mesh"][0]) == pytest.approx(float(other["point_load_maximum"][0]), rel=5e-3)
    # a line of one end at the anchor pulls there as its first bar does
    assert float(summary["point_load_half_step"][0]) == pytest.approx(float(summary["point_load_maximum"][0]), rel=1e-2)
    (pull,) = [number for number in own.headlines if number.name == "point_load" and number.shown]
    ends = [
        float(summary[name][0]) for name in ("point_load_maximum", "point_load_half_step", "point_load_double_mesh")
    ]
    ends.append(2.0 * ends[2] - ends[0])
    assert pull.band is not None
    # eight segments are few: the band reaches as far as that of the tension too
    assert pull.band.low <= min(ends) * (1.0 + 1e-9) and 0.9999 * max(ends) <= pull.band.high < 1.02 * max(ends)
    assert "segments are few" in pull.band.of


@pytest.mark.parametrize("motion", ["repeats", "never repeats", "irregular"])
def test_the_chance_of_a_record_is_that_of_the_pull(motion: str) -> None:
    """Of a seed, and of regular waves in which a line snaps and no period is like another."""
    time, irregular = np.linspace(0.0, 600.0, 6001), motion == "irregular"
    load = np.abs(np.random.default_rng(4).normal(5.0, 1.0, time.size))
    if motion == "repeats":
        load = 5.0 + 3.5 * np.sin(2.0 * np.pi * time / 4.0)
    series = xr.Dataset(
        {
            "point_load_peak_since_row": (("time", "point", "measure"), load[:, None, None]),
            "line_tension_peak_since_row": (("time", "line"), 8.0 * load[:, None]),
        },
        coords={"time": time, "point": ["anchor"], "measure": ["size"], "line": ["rope"]},
        attrs={"skip": 0.0, "period": 4.0, "irregular": int(irregular)},
    )
    pulls = {
        "point_load_half_step": 9.0,
        "point_load_double_mesh": 8.0,
        "point_load_damped": np.nan,
        "point_load_finest": np.nan,
    }
    summary = xr.Dataset(
        {name: (("run", "point"), [[value]]) for name, value in pulls.items()},
        coords={"run": ["storm"], "point": ["anchor"], "line": ["rope"]},
    )
    groups = {"/SWL/dynamic": summary, "/SWL/time/storm": series}
    peak = _Peak(40.0, "rope", "SWL", "storm", 12.0, DYNAMIC)
    band, bound = _band_of_pull(groups, ("SWL", "storm", "anchor"), 8.5, peak)
    assert band is not None and bound == ""
    if motion == "repeats":
        assert (band.low, band.high) == pytest.approx((7.5, 9.0))
        return
    # blocks of four periods of a sea, of one period of regular waves
    found = maximum_of(time, load, 4.0 if irregular else 1.0)
    assert found is not None and found.range[1] > 9.0
    assert (band.low, band.high) == pytest.approx((min(7.5, found.range[0]), found.range[1]))
    assert ("seeds" in band.of) is irregular and ("does not repeat" in band.of) is not irregular
    # the tension by its own record
    (tension, _, _) = _band(groups, peak)
    assert tension is not None and tension.high == pytest.approx(max(40.0, 8.0 * found.range[1]))


@pytest.mark.parametrize("irregular", [0, 1])
def test_the_pull_of_a_snap_whose_mesh_was_not_checked_is_at_least(irregular: int) -> None:
    """The chance of a record says nothing of the mesh; a check of the mesh of the pull itself does."""
    time = np.linspace(0.0, 600.0, 6001)
    load = np.abs(np.random.default_rng(4).normal(5.0, 1.0, time.size))
    series = xr.Dataset(
        {
            "point_load_peak_since_row": (("time", "point", "measure"), load[:, None, None]),
            "line_tension_peak_since_row": (("time", "line"), 8.0 * load[:, None]),
        },
        coords={"time": time, "point": ["anchor"], "measure": ["size"], "line": ["rope"]},
        attrs={"skip": 0.0, "period": 4.0, "irregular": irregular},
    )
    for doubt, checked, bound in (("a slack line snaps taut", False, "at least"), ("", False, "at least"),
                                  ("a slack line snaps taut", True, "")):  # fmt: skip
        summary = xr.Dataset(
            {
                name: (("run", "point"), [[8.6]])
                for name in ("point_load_half_step", "point_load_double_mesh")
                if checked
            },
            coords={"run": ["storm"], "point": ["anchor"], "line": ["rope"]},
            attrs={"governing storm": "rope", "doubt storm": doubt},
        )
        groups = {"/SWL/dynamic": summary, "/SWL/time/storm": series}
        band, found = _band_of_pull(
            groups, ("SWL", "storm", "anchor"), 8.5, _Peak(40.0, "rope", "SWL", "storm", 12.0, DYNAMIC)
        )
        assert band is not None and found == bound
