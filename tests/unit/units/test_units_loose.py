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
from moyai.structures.units.headlines import _connectors, _gaps, _motions
from moyai.structures.units.line_headlines import line_headlines


def _sea(joins: int, joined: int, force: float, mean: float = 2.0) -> xr.Dataset:
    dims = ("connector", "component")
    return xr.Dataset(
        {
            "significant_motion": ("dof", [0.1]),
            "connector_resultant_largest": ("connector", [force]),
            "connector_moment_largest": (dims, np.zeros((1, 3))),
            "relative_motion_largest": (dims, [[0.0, 0.0245, 0.0]]),
            "connector_joins": ("connector", [joins]),
            "gap_joined": ("gap", [joined]),
            "gap_closing_largest": ("gap", [0.036]),
            "line_tension_maximum": ("line", [mean]),
            "line_tension_mean": ("line", [mean]),
        },
        coords={"connector": ["f"], "component": list("xyz"), "gap": ["gap 1-2"], "line": ["a"]},
    )


@pytest.mark.parametrize(("joins", "joined", "bound"), [(0, 0, "at least"), (1, 1, "")])
def test_what_a_connector_does_not_hold_is_at_least_what_is_shown(joins: int, joined: int, bound: str) -> None:
    """A fender with clearance and a slack chain bear nothing in the linear answer: that is no factor of safety."""
    statics = xr.Dataset(
        {"connector_breaking_load": ("connector", [1e5]), "gap_width": ("gap", [1.0])}, coords={"connector": ["f"]}
    )
    seas = [("/SWL/frequency/storm", _sea(joins, joined, 1e4))]
    groups = {"/SWL/statics": statics, **dict(seas)}
    found = {item.name: item for item in [*_connectors(groups, seas), *_gaps(groups, seas)]}
    for name in ("connector_force", "connector_utilisation", "gap_motion", "gap_closing"):
        assert found[name].bound == bound, name
        assert ("slow drift" in found[name].detail) is (joins == 0 and name != "connector_utilisation"), name


def test_at_least_nothing_is_not_known() -> None:
    """A slack chain bears nothing in the linear answer: its load in a sea is not known, and no limit holds."""
    statics = xr.Dataset({"connector_breaking_load": ("connector", [1e5])}, coords={"connector": ["f"]})
    seas = [("/SWL/frequency/storm", _sea(0, 0, 0.0))]
    found = {item.name: item for item in _connectors({"/SWL/statics": statics, **dict(seas)}, seas)}
    for name in ("connector_force", "connector_utilisation"):
        item = found[name]
        assert item.text == "not known" and np.isnan(item.value) and not item.bound, name
        assert "slow drift" in item.detail
    limit = Criterion("u", "connector_utilisation", 0.5, "at most", "source")
    assert judge(found.values(), [limit], computed=True).outcome == "not judged"


def test_impacts_of_units_that_drift_apart_go_through_the_row() -> None:
    """The hinge of one gap bears 8 kN and holds; the fender of the next bears little, until its units meet."""
    dims = ("connector", "component")
    held = _sea(1, 1, 8e3)
    both = xr.Dataset(
        {
            "significant_motion": ("dof", [0.1]),
            "connector_resultant_largest": ("connector", [8e3, 7e2]),
            "connector_moment_largest": (dims, np.zeros((2, 3))),
            "relative_motion_largest": (dims, [[0.0, 0.05, 0.0], [0.0, 0.02, 0.0]]),
            "connector_joins": ("connector", [1, 0]),
            "gap_joined": ("gap", [1, 0]),
            "gap_closing_largest": ("gap", [0.3, 0.2]),
            "line_tension_maximum": held["line_tension_maximum"],
            "line_tension_mean": held["line_tension_mean"],
        },
        coords={"connector": ["h", "f"], "component": list("xyz"), "gap": ["gap 1-2", "gap 2-3"]},
    )
    statics = xr.Dataset({"connector_breaking_load": ("connector", [1e5, 1e4]), "gap_width": ("gap", [0.5, 0.5])})
    seas = [("/SWL/frequency/storm", both)]
    groups = {"/SWL/statics": statics, **dict(seas)}
    found = [*_connectors(groups, seas), *_gaps(groups, seas)]
    for name, most in (
        ("connector_force", 8e3), ("connector_utilisation", 0.08), ("gap_motion", 0.05), ("gap_closing", 0.6),
    ):  # fmt: skip
        shown = [(round(item.value, 9), item.bound) for item in found if item.name == name]
        assert shown == [(most, "at least")], name
    assert "drift apart and meet" in next(item.detail for item in found if item.name == "connector_force")


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
    sea = _sea(1, 1, 5e-11)
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
        seas = [("/SWL/frequency/storm", _sea(1, 1, 1e4).assign_attrs(drift=drift))]
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
