"""Every anchor and line of a flexible cage is judged at its own band: chance of the seed, mesh of its kind."""

import numpy as np
import pytest
import xarray as xr

import moyai
from moyai.case.builder import build
from moyai.case.templates import template
from moyai.core.headline import Criterion, judge, unfavourable
from moyai.structures.cage.flexible import run as flexible_run
from moyai.structures.cage.flexible.sensitivity import tension_of
from moyai.structures.cage.headlines import _anchor, _State, _tension, flexible_headlines
from moyai.structures.cage.rigid.headlines import _rigid_rest

TIME = np.arange(0.0, 400.0, 0.5)


def sea(peaks, names, regular):
    most = peaks.max(axis=0)
    data = {
        "line_tension_peak_since_row": (("time", "line"), peaks),
        **dict.fromkeys(("line_tension_maximum", "line_tension_maximum_lower"), ("line", most)),
        **dict.fromkeys(("line_uplift_lower", "slack_share"), ("line", 0.0 * most)),
        "snaps": ("line", np.zeros(most.size, dtype=int)), "utilisation": ("line", most / 1e6),
    }  # fmt: skip
    attrs = {"regular": regular, "ramp": 0.0, "period": 5.0, "theory": "linear", "seed": 1, "wave": "H"}
    run = xr.Dataset(data, coords={"time": TIME, "line": names}, attrs=attrs)
    return [(_State("SWL", 0.5, -1, xr.Dataset(), xr.Dataset(), None), "storm, SWL", run)]


def test_an_anchor_of_a_smaller_pull_and_a_wider_band_is_judged():
    """One bears 100 kN in every wave, the other now and then 96 kN: of other seeds it may bear far more."""
    steady, rare = np.full(TIME.size, 100e3), np.full(TIME.size, 30e3)
    rare[np.linspace(5, TIME.size - 5, 14).astype(int)] = np.linspace(35e3, 96e3, 14)
    for order in (slice(None), slice(None, None, -1)):
        peaks, names = np.stack([steady, rare], axis=1)[:, order], ["anchor 1", "anchor 2"][order]
        found = _anchor([], sea(peaks, names, 0))
        assert found[0].value == pytest.approx(100e3) and "anchor 1" in found[0].where
        worst = max(found, key=unfavourable)
        assert "anchor 2" in worst.where and unfavourable(worst) > 110e3
        limit = Criterion("limit", "anchor_load", 105e3, "at most", "case", unit="N")
        assert judge(found, [limit], computed=True).outcome == "does not hold"


def test_the_mesh_of_its_kind_of_line_is_counted_before_the_worst_is_chosen():
    """Anchor line 0.300 within 1 %, bridle 0.290 within 30 %: the bridle breaks a limit of a third."""
    peaks = np.stack([np.full(TIME.size, 300e3), np.full(TIME.size, 290e3)], axis=1)
    factors = {tension_of("anchor"): (0.99, 1.01), tension_of("bridle"): (0.7, 1.3)}
    limit = Criterion("limit", "line_utilisation", 1.0 / 3.0, "at most", "case")
    outcomes = []
    for given in ({}, factors):
        _, used = _tension([], sea(peaks, ["anchor 1", "bridle 1a"], 1), given)
        outcomes.append(judge(used, [limit], computed=True).outcome)
    assert outcomes == ["holds", "does not hold"]


def test_numbers_of_a_sea_carry_the_laws_of_nets_where_the_current_alone_was_not_asked_for():
    """Under another valid law an anchor bears 4 kN more at rest: 61 kN in the wave break a limit of 64 kN."""
    ((_, _, run),) = sea(np.full((TIME.size, 1), 61e3), ["anchor 1"], 1)
    still = {"net_tension_peak_since_row": (("time", "cage"), np.ones((TIME.size, 1))),
             "volume_share": (("time", "cage"), np.ones((TIME.size, 1))),
             "drag": (("time", "part", "horizontal"), np.ones((TIME.size, 1, 2))),
             "surface_elevation": ("time", np.sin(TIME)), "drag_time": ("time", TIME)}  # fmt: skip
    run = run.assign(still)
    names = ("volume_share", "drag", "line_tension_maximum", "anchor_pull", "net_tension")
    laws = xr.Dataset(
        {
            **{f"law_{name}": ("law", [1.0, 1.0]) for name in names},
            "law_anchor_pull": ("law", [40e3, 44e3]),
            "law_line_tension": (("law", "line"), [[40e3], [44e3]]),
        },
        coords={"law": ["loland", "milne"], "line": ["anchor 1"]},
        attrs={"valid": "milne"},
    )
    level = xr.Dataset(attrs={"current": 0.5})
    limit = Criterion("limit", "anchor_load", 64e3, "at most", "case", unit="N")
    outcomes = []
    for given in ({}, {"/SWL/laws": laws}):
        groups = {"/SWL": level, "/SWL/cage": xr.Dataset(), **given, "/SWL/time/storm/wave 1": run}
        items = flexible_headlines(None, groups)
        outcomes.append(judge(items, [limit], computed=True).outcome)
    assert outcomes == ["holds", "does not hold"]


def test_a_cage_run_through_a_sea_alone_is_found_under_every_valid_law(monkeypatch):
    text = template("cage").replace("{around: 32, down: 6, bottom: 4}", "{around: 16, down: 3, bottom: 2}")
    text = text.replace("analyses: [statics, time]", "analyses: [time]").replace(
        "current_speeds: [0.25 m/s, 0.75 m/s]", "current_speeds: []"
    )
    monkeypatch.setattr(flexible_run, "_sea_steps", lambda *given: iter(()))
    laws = moyai.run(moyai.load_case(text)).tree["SWL/laws"].to_dataset()
    assert laws.sizes["law"] > 1 and laws["law"].values[0] == "loland"
    assert np.isfinite(laws["law_offset"].values).all() and float(laws["law_offset"].values[0]) > 0.0


def test_without_a_current_a_warning_says_that_the_laws_are_in_no_band():
    text = template("cage")
    codes = []
    for given in (
        text,
        text.replace("current: {speed: 0.5 m/s, heading_deg: 0}", "").replace(
            "current_speeds: [0.25 m/s, 0.75 m/s], ", ""
        ),
    ):
        problem = build(moyai.load_case(given))
        codes.append([notice.code for notice in flexible_run.problem_notices(problem)])
    assert "net-laws-not-varied" not in codes[0] and "net-laws-not-varied" in codes[1]


def test_a_rigid_cage_takes_the_largest_tension_at_rest_of_all_water_levels():
    groups = {}
    for level, tension, share in (("LWL", 30.0, 0.4), ("HWL", 80.0, 0.9), ("MWL", 50.0, 0.6)):
        groups[f"/{level}/statics"] = xr.Dataset(
            {"tension_at_rest": ("line", [0.9 * tension, tension]), "immersion": ("situation", [0.3, share])},
            coords={"situation": ["floating freely", "moored"]},
        )
    found = {item.name: (item.value, item.where) for item in _rigid_rest(groups)}
    assert found == {"tension_at_rest": (80.0, "HWL"), "floats_immersed": (0.9, "HWL")}
