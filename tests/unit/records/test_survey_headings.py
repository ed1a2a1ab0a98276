"""The first page of a survey says where its largest waves travel and its strongest current."""

from __future__ import annotations

import numpy as np
import xarray as xr

from moyai.records.survey.report.compass import heading_figures

START = np.array([0.0, 1800.0])


def _tree(bearing: float) -> xr.DataTree:
    groups = {
        "/": xr.Dataset(attrs={"x_axis_bearing_deg": bearing}),
        "/waves": xr.Dataset({"third_height": (("block", "gauge"), [[0.5], [0.8]])}),
        "/directions": xr.Dataset(
            {"mean_heading": ("block", np.radians([10.0, 60.0])), "spread": ("block", np.radians([9.0, 15.0]))}
        ),
        "/current": xr.Dataset(
            {"current_speed": ("block", [0.3, 0.2]), "current_heading": ("block", np.radians([90.0, 0.0]))}
        ),
    }
    return xr.DataTree.from_dict(groups)


def test_the_block_with_the_largest_waves_and_that_with_the_strongest_current_are_named() -> None:
    """+x points east: a heading of 60 degrees is 30 east of north, one of 90 degrees due north."""
    waves, current = heading_figures(_tree(90.0), START, lambda instant: f"{instant:g} s")
    assert waves.text == "60 deg" and waves.detail == "from +x, bearing 30 deg (NNE); spread 15 deg; 1800 s"
    assert current.text == "0.300 m/s" and current.detail == "towards 90 deg from +x, bearing 0 deg (N); 0 s"


def test_without_a_bearing_headings_are_those_of_the_axes() -> None:
    waves, _ = heading_figures(_tree(np.nan), START, str)
    assert waves.detail.startswith("from +x; spread")
