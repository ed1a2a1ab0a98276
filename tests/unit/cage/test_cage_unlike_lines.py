"""Every anchor and line of a flexible cage is judged at its own band: chance of the seed, mesh of its kind."""

import numpy as np
import pytest
import xarray as xr

import moyai
from moyai.case.templates import template
from moyai.core.headline import Criterion, Headline, judge, unfavourable
from moyai.structures.cage.bands import LevelState
from moyai.structures.cage.flexible import run as flexible_run
from moyai.structures.cage.flexible.law_runs import line_quantity
from moyai.structures.cage.flexible.sensitivity import NET_TENSION, tension_of
from moyai.structures.cage.headlines import DYNAMIC, _anchor, _tension, flexible_headlines, judged_seas

TIME = np.arange(0.0, 400.0, 0.5)


def sea(peaks, names, regular):
    most = peaks.max(axis=0)
    anchors = [number for number, name in enumerate(names) if name.startswith("anchor")]
    data = {
        "line_tension_peak_since_row": (("time", "line"), peaks),
        "line_tension_maximum": ("line", most), "slack_share": ("line", 0.0 * most),
        "anchor_tension_maximum": ("anchor", most[anchors]),
        "anchor_vertical_tension_maximum": ("anchor", 0.0 * most[anchors]),
        "snap_count": ("line", np.zeros(most.size, dtype=int)), "utilisation": ("line", most / 1e6),
    }  # fmt: skip
    attrs = {"regular": regular, "ramp": 0.0, "period": 5.0, "theory": "linear", "seed": 1, "wave": "H"}
    run = xr.Dataset(data, coords={"time": TIME, "line": names, "anchor": [names[k] for k in anchors]}, attrs=attrs)
    return [(LevelState("SWL", 0.5, -1, xr.Dataset(), xr.Dataset(), None), "storm, SWL", run)]


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
        limit = Criterion("limit", "anchor_tension", 105e3, "at most", "case", unit="N")
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
    names = ("volume_share", "drag", "line_tension_maximum", "anchor_tension", "net_tension")
    laws = xr.Dataset(
        {
            **{f"law_{name}": ("law", [1.0, 1.0]) for name in names},
            "law_anchor_tension_maximum": ("law", [40e3, 44e3]),
            "law_line_tension": (("law", "line"), [[40e3], [44e3]]),
        },
        coords={"law": ["loland", "milne"], "line": ["anchor 1"]},
        attrs={"valid": "milne"},
    )
    level = xr.Dataset(attrs={"current": 0.5})
    limit = Criterion("limit", "anchor_tension", 64e3, "at most", "case", unit="N")
    outcomes = []
    for given in ({}, {"/SWL/laws": laws}):
        groups = {"/SWL": level, "/SWL/cage": xr.Dataset(), **given, "/SWL/time/storm/wave 1": run}
        items = flexible_headlines(None, groups)
        outcomes.append(judge(items, [limit], computed=True).outcome)
    assert outcomes == ["holds", "does not hold"]


@pytest.mark.slow
def test_a_cage_run_through_a_sea_alone_is_found_under_every_valid_law(monkeypatch):
    text = template("cage").replace("{around: 32, down: 6, bottom: 4}", "{around: 16, down: 3, bottom: 2}")
    text = text.replace("analyses: [statics, time]", "analyses: [time]").replace(
        "current_speeds: [0.25 m/s, 0.75 m/s]", "current_speeds: []"
    )
    monkeypatch.setattr(flexible_run, "_sea_steps", lambda *given: iter(()))
    laws = moyai.run(moyai.load_case(text)).tree["SWL/laws"].to_dataset()
    assert laws.sizes["law"] > 1 and laws["law"].values[0] == "loland"
    assert np.isfinite(laws["law_largest_offset"].values).all() and float(laws["law_largest_offset"].values[0]) > 0.0


def law_runs(anchor, missing="", regular=1):
    """Return the runs of a wave under two laws by the tension of its anchor."""
    return xr.Dataset(
        {"value": (("law", "quantity"), np.array([anchor]).T)},
        coords={"law": ["balash", "milne"][: len(anchor)], "quantity": [line_quantity("anchor 1")]},
        attrs={"regular": regular, "missing": missing, "valid": "balash, milne", "wave": "H", "reynolds": 1e3},
    )


def in_waves(groups, limit):
    """Return the pull on the anchor at a limit [N] where the current is none."""
    level, cage = xr.Dataset(attrs={"current": 0.0}), xr.Dataset(coords={"line": ["anchor 1"]})
    given = {"/SWL": level, "/SWL/cage": cage, **groups}
    runs = flexible_headlines(
        None, {**given, **{f"/SWL/time/{name}/wave 1": waves(61e3) for name in ("storm", "swell")}}
    )
    asked = Criterion("greatest_anchor_load", "anchor_tension", limit, "at most", "case", unit="N")
    pulls = [item for item in runs if item.name == "anchor_tension"]
    return pulls, judge(pulls, [asked], computed=True)


def waves(pull):
    ((_, _, run),) = sea(np.full((TIME.size, 1), pull), ["anchor 1"], 1)
    more = {"net_tension_peak_since_row": (("time", "cage"), np.ones((TIME.size, 1))),
            "volume_share": (("time", "cage"), np.ones((TIME.size, 1))),
            "drag": (("drag_time", "part", "horizontal"), np.ones((TIME.size, 1, 2)))}  # fmt: skip
    return run.assign(more).assign_coords(drag_time=TIME)


def test_the_laws_are_in_the_band_by_runs_through_the_governing_wave():
    """By the law of the case 61 kN hold 65 kN, by another one the wave gives a tenth more: no current is needed."""
    groups = {"/SWL/laws_in_waves/storm/wave 1": law_runs([40e3, 44e3])}
    pulls, verdict = in_waves({}, 65e3)
    assert verdict.outcome == "holds"
    pulls, verdict = in_waves(groups, 65e3)
    assert verdict.outcome == "does not hold"
    assert pulls[0].band.high == pytest.approx(1.1 * 61e3) and pulls[0].band.low == pytest.approx(61e3)
    assert pulls[0].band.of == "net laws run in this wave: milne"
    # the upward part is that of one run: no bound
    assert "without a band" in pulls[0].detail and "at most" not in pulls[0].detail


def test_a_wave_that_was_not_run_under_the_laws_takes_their_largest_ratio():
    groups = {"/SWL/laws_in_waves/other/wave 1": law_runs([40e3, 44e3]),
              "/SWL/laws_in_waves/third/wave 2": law_runs([40e3, 30e3])}  # fmt: skip
    pulls, _ = in_waves(groups, 65e3)
    assert pulls[0].band.high == pytest.approx(1.1 * 61e3) and pulls[0].band.low == pytest.approx(0.75 * 61e3)
    assert pulls[0].band.of == "net laws run in the governing waves, by their ratio: milne"


def test_a_law_whose_run_fails_leaves_a_bound():
    pulls, verdict = in_waves({"/SWL/laws_in_waves/storm/wave 1": law_runs([40e3], "milne")}, 65e3)
    assert verdict.outcome == "not judged" and any(item.bound == "at least" for item in pulls)


@pytest.mark.parametrize(("coarser", "bound"), [(0.9, ""), (0.75, "at least")])
def test_a_net_tension_that_grows_with_the_mesh_is_known_from_below(coarser, bound):
    """At a knot with a weight it goes with one over the width of the mesh: no band of two meshes holds it."""
    item = Headline("net_tension", "largest tension of the net", 1000.0, "N/m", "", DYNAMIC)
    change = 1.0 - coarser
    (found,) = judged_seas([item], factors={NET_TENSION: (1.0 - change, 1.0 + change)})
    assert found.bound == bound
    assert found.band.high == pytest.approx(1000.0 * (1.0 + change))
