"""A peak whose mesh was not checked keeps no limit, and finer runs that lower a peak leave it safe."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import pytest
import xarray as xr

from moyai.core.collected import Collected
from moyai.core.headline import Criterion, Headline, judge
from moyai.core.validity import IdentityCheck
from moyai.core.vocabulary import Vocabulary
from moyai.flexible.sensitivity import PeakSensitivity
from moyai.structures.network import headlines
from moyai.structures.network.headlines import DYNAMIC, _band, _Peak, _utilisation
from moyai.structures.network.mesh_band import REMEDY, doubt_of
from moyai.structures.network.model import LinePlan
from moyai.structures.network.refinement import LANDING, lowered


def _of_strengths(**loads: float) -> SimpleNamespace:
    """Return of a problem what its lines bear."""
    lines = [LinePlan(name, "a", "b", (), breaking_load=load) for name, load in loads.items()]
    return SimpleNamespace(lines=lines, strengths=loads)


@pytest.mark.parametrize("doubt", [LANDING, f"a slack line snaps taut; {LANDING}", "a slack line snaps taut", ""])
def test_a_peak_whose_mesh_was_not_checked_is_at_least(doubt: str) -> None:
    """Finer segments of a line with a clump that land gave 12.9 kN where the page said "at most 10.2"."""
    runs = xr.Dataset({"tension": ("run", [9e3])}, coords={"run": ["storm"]}, attrs={"doubt storm": doubt})
    peak = _Peak(9e3, "chain", "SWL", "storm", 12.0, DYNAMIC)
    band, words, found = _band({"/SWL/dynamic": runs}, peak)
    assert band is None and found == "at least" and REMEDY in words
    assert any(word.startswith("mesh and step not checked") and word.endswith(doubt) for word in words)
    assert not any("give less" in word for word in words)


def test_finer_runs_that_give_less_leave_a_peak_on_the_safe_side() -> None:
    def peak(half_step: float, double_mesh: float, damped: float = math.nan) -> PeakSensitivity:
        return PeakSensitivity(10.0, half_step, double_mesh, math.nan, math.nan, 1e-3, damped)

    assert lowered(peak(9.0, 4.0), 0.05) and lowered(peak(10.4, 4.0, 3.0), 0.05)
    assert not lowered(peak(9.0, 10.6), 0.05) and not lowered(peak(9.0, 4.0, 11.0), 0.05)


def test_a_design_is_judged_on_the_safe_side_alone() -> None:
    """Not converged on the safe side: judged. A further failure or a broken identity: not judged."""
    number = Headline("pull", "Pull", 1.0, "N")
    limit = Criterion("greatest_pull", "pull", 2.0, "at most", "case file", unit="N")

    def close(*failures: str, broken: bool = False) -> str:
        collected = Collected()
        collected.failures, collected.on_the_safe_side = list(failures), ["peak"]
        collected.checks = [IdentityCheck("energy", 1.0 if broken else 0.0, 0.1, "")]
        attributes = {"title": "", "case_hash": "", "structure": "network"}
        result = collected.close(Vocabulary("network", {}), attributes, headlines=[number], criteria=[limit])
        assert result.status == "not_converged"
        return result.verdict.outcome

    assert close("peak") == "holds"
    assert close("peak", "another") == "not judged"
    assert close("peak", broken=True) == "not judged"


def test_one_seed_too_short_stays_open_behind_a_higher_regular_wave(monkeypatch: pytest.MonkeyPatch) -> None:
    peaks = [_Peak(value, "chain", "SWL", run, 12.0, DYNAMIC) for value, run in ((9e3, "wave"), (6e3, "sea"))]
    problem = _of_strengths(chain=30e3)
    monkeypatch.setattr(headlines, "_place", lambda groups, level, *words: ", ".join(words))
    limit = Criterion("factor", "line_utilisation", 0.5, "at most", "case")
    outcomes = []
    for bound in ("", "at least"):
        monkeypatch.setattr(headlines, "_band", lambda groups, peak, of=bound: (None, [], of * (peak.run == "sea")))
        found = _utilisation(problem, {}, peaks)
        assert [item.where for item in found if item.shown] == ["chain, wave"]
        outcomes.append(judge(found, [limit], computed=True).outcome)
    assert outcomes == ["holds", "not judged"]


@pytest.mark.parametrize(
    ("doubt", "few", "bound"), [(LANDING, False, "at least"), ("", False, ""), ("", True, "at least")]
)
def test_a_line_whose_event_was_not_run_again_is_marked(doubt: str, few: bool, bound: str) -> None:
    """The rope governs and changes by a tenth on finer meshes; the chain bears its highest tension at another time."""
    again = [[[10e3, 10e3, 11e3, math.nan, math.nan], [math.nan] * 5]]
    attrs = {"governing storm": "rope", "doubt storm": doubt} | ({"few chain": "'chain' has 4 segments"} if few else {})
    runs = xr.Dataset(
        {"line_tension_of_check": (("run", "line", "check"), again)},
        coords={"run": ["storm"], "line": ["rope", "chain"]}, attrs=attrs,
    )  # fmt: skip
    band, words, found = _band({"/SWL/dynamic": runs}, _Peak(5e3, "chain", "SWL", "storm", 12.0, DYNAMIC))
    assert found == bound and any("mesh and step not checked" in word for word in words)
    if doubt:
        assert band is None
    else:
        assert band is not None and (band.low, band.high) == pytest.approx((5e3, 6e3)) and "of rope" in band.of
    own, words, found = _band({"/SWL/dynamic": runs}, _Peak(10e3, "rope", "SWL", "storm", 12.0, DYNAMIC))
    assert (
        own is not None
        and own.high == pytest.approx(12e3)
        and found == ""
        and not any("not checked" in w for w in words)
    )


def test_a_snap_whose_mesh_was_not_checked_keeps_no_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """547 N of a snap were 1052 with half the step: 10 kN prove that 4 kN are broken, not that 20 are kept."""
    monkeypatch.setattr(headlines, "_place", lambda groups, level, *words: ", ".join(words))
    problem = _of_strengths(rope=40e3)
    peaks = [_Peak(10e3, "rope", "SWL", "storm", 12.0, DYNAMIC)]
    for doubt, outcomes in (
        ("", ["not judged", "does not hold"]),
        ("a slack line snaps taut", ["not judged", "does not hold"]),
    ):
        attrs = {"governing storm": "rope", "doubt storm": doubt}
        runs = xr.Dataset({"tension": ("run", [10e3])}, coords={"run": ["storm"]}, attrs=attrs)
        found = _utilisation(problem, {"/SWL/dynamic": runs}, peaks)
        limits = [Criterion("factor", "line_utilisation", limit, "at most", "case") for limit in (0.5, 0.1)]
        rows = judge(found, limits, computed=True).judgements
        assert [item.outcome for item in rows] == outcomes
        if doubt:
            assert f"mesh and step not checked: a slack line snaps taut; {REMEDY}" in rows[0].reason
            assert "mesh and step not checked: a slack line snaps taut" in found[0].detail


def test_a_snap_is_the_doubt_of_every_line_and_few_segments_are_that_of_their_own() -> None:
    runs = xr.Dataset(attrs={"governing storm": "rope", "doubt storm": "a slack line snaps taut", "few chain": "few"})
    assert {doubt_of(runs, "storm", line) for line in ("rope", "wire", "chain")} == {"a slack line snaps taut"}
    runs = xr.Dataset(attrs={"governing storm": "rope", "doubt storm": "3 segments", "few rope": "3 segments"})
    assert [doubt_of(runs, "storm", line) for line in ("rope", "wire")] == ["3 segments", ""]


def test_the_worst_sea_of_a_line_that_fails_stands_behind_the_line_that_governs(monkeypatch) -> None:
    """Hoist and leash snap in short waves: the leash fails too, and its light load in long waves is no row."""
    monkeypatch.setattr(headlines, "_place", lambda groups, level, *words: ", ".join(words))
    monkeypatch.setattr(headlines, "_band", lambda groups, peak: (None, [], ""))
    monkeypatch.setattr(headlines, "_mean", lambda groups, peak, load: 0.2 * peak.value / load)
    problem = _of_strengths(hoist=120e3, leash=120e3)
    values = {("hoist", "short"): 55e3, ("leash", "short"): 48e3, ("hoist", "long"): 17e3, ("leash", "long"): 9.6e3}
    peaks = [_Peak(value, line, "SWL", run, 12.0, DYNAMIC) for (line, run), value in values.items()]
    found = _utilisation(problem, {}, peaks)
    assert [item.where for item in found if item.shown] == ["hoist, short"]
    limit = Criterion("factor", "line_utilisation", 1.0 / 3.0, "at most", "case", as_factor=True)
    rows = judge(found, [limit], computed=True).judgements
    assert [(item.reason, item.outcome) for item in rows] == [
        ("hoist, short", "does not hold"), ("leash, short", "does not hold"),
    ]  # fmt: skip
    assert [item.reason for item in judge(found, [replace(limit, limit=0.5)], computed=True).judgements] == [
        "hoist, short"
    ]
