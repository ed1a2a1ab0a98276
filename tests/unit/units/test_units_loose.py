"""Units that no connector holds together drift against each other, which the frequency domain does not know."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from moyai.case.criteria import criteria_of
from moyai.case.reader import case_of
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.core.headline import Band, Bound, Criterion, Headline, Judgement, judge
from moyai.report.first_page import limit_and_found
from moyai.report.headlines import _figure, band_text
from moyai.structures.units.doubts import push_notices
from moyai.structures.units.headlines import _connectors, _gaps, _motions, governing_seas
from moyai.structures.units.line_headlines import line_headlines


def _sea(force: float, *, irregular: bool = True) -> xr.Dataset:
    dims = ("connector", "component")
    return xr.Dataset(
        {
            "significant_motion" if irregular else "motion_amplitude": ("dof", [0.1]),
            "connector_resultant_largest": ("connector", [force]),
            "connector_moment_largest": (dims, np.zeros((1, 3))),
            "relative_motion_largest": (dims, [[0.0, 0.0245, 0.0]]),
            "gap_closing_largest": ("gap", [0.036]),
            "line_tension_maximum": ("line", [2.0]),
            "line_tension_mean": ("line", [2.0]),
        },
        coords={"connector": ["f"], "component": list("xyz"), "gap": ["gap 1-2"], "line": ["a"]},
    )


@pytest.mark.parametrize(
    ("domain", "irregular", "bound"),
    [("frequency", True, "at least"), ("frequency", False, ""), ("time", True, "")],
)
def test_slow_drift_leaves_connectors_and_gaps_of_an_irregular_sea_open(
    domain: str, irregular: bool, bound: str
) -> None:
    """Groups of waves move units against each other through pins and balls too; the frequency domain has none of it."""
    statics = xr.Dataset(
        {"connector_breaking_load": ("connector", [1e5]), "gap_width": ("gap", [1.0])}, coords={"connector": ["f"]}
    )
    seas = [(f"/SWL/{domain}/storm", _sea(1e4, irregular=irregular))]
    groups = {"/SWL/statics": statics, **dict(seas)}
    found = {item.name: item for item in [*_connectors(groups, seas), *_gaps(groups, seas)]}
    for name in ("connector_force", "connector_utilisation", "gap_motion", "gap_closing"):
        assert found[name].bound == bound, name
        assert ("slow drift" in found[name].detail) is (bool(bound) and name != "connector_utilisation"), name


def test_at_least_nothing_is_not_known() -> None:
    """A slack chain bears nothing in the linear answer: its load in a sea is not known, and no limit holds."""
    statics = xr.Dataset({"connector_breaking_load": ("connector", [1e5])}, coords={"connector": ["f"]})
    seas = [("/SWL/frequency/storm", _sea(0.0))]
    found = {item.name: item for item in _connectors({"/SWL/statics": statics, **dict(seas)}, seas)}
    for name in ("connector_force", "connector_utilisation"):
        item = found[name]
        assert item.text == "not known" and np.isnan(item.value) and not item.bound, name
        assert "slow drift" in item.detail
    limit = Criterion("u", "connector_utilisation", 0.5, "at most", "source")
    assert judge(found.values(), [limit], computed=True).outcome == "not judged"


def test_hulls_must_not_touch_however_the_units_are_placed() -> None:
    """By count, or by places in a straight row; beyond the corner of a unit there is no gap."""

    def judged(units: str) -> set[str]:
        text = template("units").replace("units: {count: 3, length: 20 m, gap: 1 m}", units, 1)
        model = case_of(parse_yaml(text, "case.yaml"), Path("case.yaml")).model
        return {item.headline for item in criteria_of(model)}

    straight = "units: {length: 20 m, places: [{y: -10.5 m}, {y: 10.5 m}]}"
    corner = "units: {length: 20 m, places: [{y: -10.5 m}, {x: 16 m, y: 6 m, heading_deg: 90}]}"
    assert "gap_closing" in judged("units: {count: 3, length: 20 m, gap: 1 m}")
    assert "gap_closing" in judged(straight)
    assert "gap_closing" not in judged(corner)
    # an end before a side closes a gap as well
    assert "gap_closing" in judged(corner.replace("y: 6 m", "y: -6 m"))


def test_rounding_is_no_load_and_no_closing() -> None:
    """A connector without load has differences of large forces left, and a rigid one moves by less than an atom."""
    sea = _sea(5e-11, irregular=False)
    sea["gap_closing_largest"][0] = 3.7e-16
    for name in ("connector_resultant_largest", "gap_closing_largest"):
        sea = sea.assign({f"{name}_low": 0.9 * sea[name], f"{name}_high": 1.1 * sea[name]})
    statics = xr.Dataset(
        {"connector_breaking_load": ("connector", [1e5]), "gap_width": ("gap", [1.0])}, coords={"connector": ["f"]}
    )
    seas = [("/SWL/frequency/storm", sea)]
    groups = {"/SWL/statics": statics, **dict(seas)}
    found = {item.name: item for item in [*_connectors(groups, seas), *_gaps(groups, seas)]}
    for name in ("connector_force", "connector_utilisation", "gap_closing"):
        assert found[name].value == 0.0 and found[name].band is None, name


@pytest.mark.parametrize(("bound", "found", "words"), [("", "no load", "no load"), ("at least", "–", "not known")])
def test_no_load_is_no_factor_of_safety(bound: Bound, found: str, words: str) -> None:
    """One over nothing is not printed as a factor."""
    criterion = Criterion("u", "u", 0.5, "at most", "source", "factor of safety", as_factor=True)
    item = Judgement(criterion, 0.0, "not judged" if bound else "holds", bound=bound)
    assert limit_and_found(item) == ("at least 2.00", found)
    headline = Headline("u", "Use", 0.0, "1", "SWL", "linear", bound=bound)
    assert words in _figure(headline, [item], {}).detail and "∞" not in _figure(headline, [item], {}).detail


def test_closings_and_connectors_without_drift_are_bounds() -> None:
    statics = xr.Dataset(
        {"connector_breaking_load": ("connector", [1e5]), "gap_width": ("gap", [1.0])}, coords={"connector": ["f"]}
    )
    for drift, bound in (("none", "at least"), ("mean", "")):
        seas = [("/SWL/frequency/storm", _sea(1e4, irregular=False).assign_attrs(drift=drift))]
        groups = {"/SWL/statics": statics, **dict(seas)}
        found = {item.name: item for item in [*_connectors(groups, seas), *_gaps(groups, seas)]}
        for name in ("connector_force", "connector_utilisation", "gap_closing"):
            assert found[name].bound == bound, name
        assert ("left out" in found["gap_closing"].detail) == bool(bound)


@pytest.mark.parametrize(("drift", "bound"), [("none", "at least"), ("mean", "")])
def test_drift_that_is_left_out_makes_offsets_and_tensions_bounds(drift: str, bound: str) -> None:
    """In regular waves and in time too: what the waves push the row by is missing."""
    sea = xr.Dataset(
        {"largest_offset": (("period", "unit"), [[0.3]]), "line_tension_maximum": (("period", "line"), [[3e3]]),
         "line_tension_mean": (("period", "line"), [[2e3]]),
         "motion_amplitude": (("period", "unit", "dof"), [[[0.1] * 2]])},
        coords={"period": [4.0], "unit": [1], "line": ["a"], "dof": ["roll", "pitch"]}, attrs={"drift": drift},
    )  # fmt: skip
    seas = [("/SWL/time/daily", sea)]
    groups = {"/SWL/statics": xr.Dataset({"breaking_load": ("line", [1e6])})}
    found = {item.name: item for item in [*_motions(seas), *line_headlines(groups, seas)]}
    for name in ("offset", "line_tension", "line_utilisation"):
        assert found[name].bound == bound, name
        assert ("left out" in found[name].detail) == bool(bound and name != "line_utilisation")


def test_ends_of_a_band_that_print_alike_are_not_printed_twice() -> None:
    alike = Headline("g", "Closing", 0.10912, "1", "SWL", "linear", band=Band(0.10911, 0.10914, "damping"))
    assert band_text(alike) == "the same to 3 digits (damping)"
    assert band_text(replace(alike, band=Band(0.1091, 0.12, "damping"))) == "0.109 to 0.120 (damping)"


def test_the_largest_of_a_storm_is_judged_at_the_mean_of_such_storms() -> None:
    """Gumbel's law about the mode of 3.5 deviations, on what varies about the mean force of 0.2e4."""
    motion = {"significant_motion": ("dof", [0.4]), "most_probable_maximum_motion": ("dof", [0.35])}
    sea = _sea(2e4).assign(**motion, connector_force_mean=(("connector", "component"), [[0.0, 2e3, 0.0]]))
    statics = xr.Dataset({"connector_breaking_load": ("connector", [1e6])}, coords={"connector": ["f"]})
    groups = {"/SWL/statics": statics, "/SWL/frequency/storm": sea}
    force = next(item for item in _connectors(groups, governing_seas(groups)) if item.name == "connector_force")
    assert force.band is not None and force.band.judged is not None
    assert force.band.judged[1] == pytest.approx(2e3 + 1.8e4 * (1.0 + np.euler_gamma / 3.5**2))
    assert not force.band.decides


@pytest.mark.parametrize(("least", "said"), [(-5.2e3, True), (10.0, False)])
def test_springs_that_push_are_said(least: float, said: bool) -> None:
    rest = xr.Dataset(
        {"anchor_curve_tension": (("line", "p"), [[np.nan] * 2, [0.0, 1.0]])}, coords={"line": ["s", "c"]}
    )
    sea = xr.Dataset({"line_tension_mean": ("line", [9e2] * 2), "line_tension_minimum": ("line", [least, -1.0])})
    found = list(push_notices({"/SWL/statics": rest}, [("/SWL/time/storm", sea)]))
    words = "SWL, storm: the spring 's' pushes with up to 5.2 kN, as a rope does not"
    assert [notice.message for notice in found] == [words] * said
