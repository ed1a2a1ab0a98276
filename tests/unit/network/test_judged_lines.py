"""Every line that is judged has its own check of mesh and step; one without a strength leaves the design open."""

from __future__ import annotations

import math

import pytest

import moyai
from moyai.core.results import Result

CASE = """
moyai: 1
title: Hoist and hanging cable
site: {water_depth: 60 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
structure:
  kind: network
  line_types:
    wire: {diameter: 20 mm, mass: 1.5 kg/m, axial_stiffness: 1.5 MN, damping_ratio: 0.2, drag_normal: 1.2,
           drag_tangential: 0.02, added_mass_normal: 1.0, breaking_load: 8.55 kN}
    cable: {diameter: 40 mm, mass: 9 kg/m, axial_stiffness: 1 MN, damping_ratio: 0.2, drag_normal: 1.2,
            drag_tangential: 0.02, added_mass_normal: 1.0STRENGTH}
  motions:
    head: {kind: harmonic, amplitude: [0, 0, 0.2 m], period: 8 s, ramp: 8 s}
  points:
    top: {kind: driven, position: [0, 0, 0], motion: head}
    load: {kind: free, position: [0, 0, -20.0 m], mass: 1000 kg, volume: 0.6 m3, drag_area: 1.5,
           added_mass_coefficient: 0.6}
    left: {kind: fixed, position: [0, 5 m, -10 m]}
    right: {kind: driven, position: [40 m, 5 m, -10 m], motion: head}
  lines:
    hoist: {start: top, end: load, type: wire, length: 20 m, segments: 12}
    sag: {start: left, end: right, type: cable, length: 44 m, segments: 4}
analyses: [statics, dynamic]
criteria: {line_safety_factor: 2}
settings: {duration: 24 s, skip: 10 s}
"""


def _run(strength: str, *changes: tuple[str, str]) -> Result:
    text = CASE.replace("STRENGTH", strength)
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return moyai.run(text)


@pytest.fixture(scope="module")
def combined() -> Result:
    return _run(", breaking_load: 4.85 kN")


def test_the_mesh_of_a_line_counts_next_to_another_that_governs(combined: Result) -> None:
    """The cable of four segments has the lower utilisation and the wider band: it is judged as it is alone."""
    hoist = "    hoist: {start: top, end: load, type: wire, length: 20 m, segments: 12}\n"
    load = CASE[CASE.index("    top: {kind: driven") : CASE.index("    left: {kind")]
    alone = _run(", breaking_load: 4.85 kN", (hoist, ""), (load, ""))
    (own,) = [item for item in alone.headlines if item.name == "line_utilisation"]
    found = {item.where: item for item in combined.headlines if item.name == "line_utilisation"}
    assert found["hoist, still water"].shown and not found["sag, still water"].shown
    band = found["sag, still water"].band
    assert own.band is not None and band is not None and own.band.high > 1.05 * own.value
    assert band.high == pytest.approx(own.band.high, rel=1e-3)
    assert combined.verdict.outcome == alone.verdict.outcome == "does not hold"
    assert combined.status == alone.status == "not_converged" and "'sag'" in combined.message


def test_each_line_is_found_in_the_runs_that_check_the_mesh(combined: Result) -> None:
    again = combined.tree["SWL/dynamic"].to_dataset()["line_tension_of_check"].isel(run=0)
    hoist, sag = (again.sel(line=name) for name in ("hoist", "sag"))
    for line in (hoist, sag):
        assert line.sel(check="half_step") == pytest.approx(float(line.sel(check="the run itself")), rel=1e-3)
    assert hoist.sel(check="double_mesh") == pytest.approx(float(hoist.sel(check="the run itself")), rel=0.01)
    assert float(sag.sel(check="double_mesh")) > 1.05 * float(sag.sel(check="the run itself"))


def test_a_line_without_a_breaking_load_leaves_the_design_open() -> None:
    result = _run("", ("segments: 4", "segments: 12"))
    assert result.verdict.outcome == "not judged" and "breaking load not given of sag" in result.verdict.message
    (shown,) = [item for item in result.headlines if item.name == "line_utilisation" and item.shown]
    assert shown.where == "hoist, still water" and "breaking load not given of sag" in shown.detail
    (open_one,) = [item for item in result.headlines if item.name == "line_utilisation" and not item.shown]
    assert math.isnan(open_one.value)
    # a broken limit stays broken
    assert _run("", ("breaking_load: 8.55 kN", "breaking_load: 5 kN")).verdict.outcome == "does not hold"


def test_each_line_that_fails_a_limit_of_tension_has_a_row() -> None:
    """Not the one with the highest tension alone: who strengthens it meets the other."""
    result = _run("", ("line_safety_factor: 2", "line_safety_factor: not_judged, greatest_tension: 1 kN"))
    rows = [item for item in result.verdict.judgements if item.criterion.name == "greatest_tension"]
    assert {item.outcome for item in rows} == {"does not hold"}
    assert {item.reason.split(",")[0] for item in rows} == {"hoist", "sag"}
