"""Lines with a pretension on both sides, curtains without a current, and limits of which a snap is left out."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.special import iv, kv

import moyai
from moyai.case.builder import build
from moyai.sea.spectra import jonswap
from moyai.sea.states import IrregularSea, RegularSea
from moyai.sea.water import Water
from moyai.structures.curtain.analyses import limits
from moyai.structures.curtain.assembly import assemble
from moyai.structures.curtain.hierarchy import STRAIGHT, straight_share
from moyai.structures.curtain.model import CurtainSettings
from moyai.structures.curtain.seas.drift import drift_speed, mean_drift_force, reflected_energy
from moyai.structures.curtain.statics.hanging import tight_line

LEVEL = ("SWL", 0.0)
WATER = Water(depth=math.inf, density=1025.0, gravity=9.81)
CASE = """\
moyai: 1
title: Curtain
site: {water_depth: 9 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
%(current)s
%(waves)s
structure:
  kind: curtain
  span: 20 m
  length: 23 m
  skirt: {length: 5 m, mass_per_area: 0.9 kg/m2, sheet_density: 1380 kg/m3, stiffness: 900 kN/m, strength: 160 kN/m}
  toe: {kind: %(toe)s, chain_mass: 20 kg/m}
  cables:
    upper: {catalogue: polyester_8_strand, diameter: 36 mm}
    lower: {catalogue: polyester_8_strand, diameter: 36 mm}
  floats: {buoyancy: 980 N/m, weight: 100 N/m}
  anchors: {line_length: 40 m, axial_stiffness: 5 MN, breaking_load: 300 kN, holding_force: %(holding)s,
            pretension: %(pretension)s}
  drag: {law: constant, coefficient: 1.5, range: [0.8, 1.3]}
analyses: [%(analyses)s]
"""
CURRENT = "current: {speed: 0.3 m/s, heading_deg: 0}"
WAVES = "waves: {name: daily, kind: regular, height: 0.4 m, periods: [3.5 s], heading_deg: 0}"


def run(folder: Path, analyses: str, **changes: str) -> moyai.report.views.ReportedResult:
    filled = {"current": "", "waves": "", "toe": "held", "holding": "120 kN", "pretension": "0 kN"} | changes
    (folder / "case.yaml").write_text(CASE % (filled | {"analyses": analyses}))
    return moyai.run(folder / "case.yaml")


def headline(result: moyai.report.views.ReportedResult, name: str):
    return next(item for item in result.headlines if item.name == name)


@pytest.mark.parametrize("force", [0.0, 3.0, 15.9, 16.1, 40.0])
def test_the_tight_line_is_that_of_two_springs(force: float) -> None:
    """Springs of 2 kN/m with 8 kN each, of which one cannot push."""
    stiffness, pretension = 2.0, 8.0
    moved = force / (2.0 * stiffness)
    if pretension < stiffness * moved:
        moved = (force - pretension) / stiffness
    assert tight_line(force, pretension) == pytest.approx(pretension + stiffness * moved, rel=1e-12)


def test_lines_with_a_pretension_share_the_current_and_pull_the_floats_down(tmp_path: Path) -> None:
    plain = run(tmp_path, "statics", current=CURRENT, toe="free")
    pulled = run(tmp_path, "statics", current=CURRENT, toe="free", pretension="8 kN")
    force = headline(plain, "anchor_tension").value
    assert 0.0 < force < 16e3
    assert headline(pulled, "anchor_tension").value == pytest.approx(8e3 + 0.5 * force, rel=1e-6)
    band = headline(pulled, "anchor_tension").band
    assert 8e3 < band.low < headline(pulled, "anchor_tension").value < band.high
    # both lines at slack water, 9 m over 40 m
    more = 16e3 * 9.0 / 40.0 / 20.0 / 980.0
    assert headline(plain, "float_reserve").value - headline(pulled, "float_reserve").value == pytest.approx(more)


def test_sunk_floats_do_not_hold(tmp_path: Path) -> None:
    """The skirt flares in the current, so that they float there, and hangs with all its weight at slack water."""
    fast = CURRENT.replace("0.3 m/s", "0.6 m/s")
    found = run(tmp_path, "statics", current=fast, toe="free", pretension="31.5 kN", holding="200 kN")
    assert headline(found, "float_reserve").value < 0.0
    assert found.verdict.outcome == "does not hold"
    assert "reserve of the floats" in found.verdict.message


def test_a_barrier_reflects_as_ursell_found() -> None:
    draught = np.array([1e-3, 0.3, 1.0, 2.5, 40.0])
    inner, outer = math.pi * iv(1, draught[1:4]), kv(1, draught[1:4])
    found = reflected_energy(draught / 3.0, 3.0, math.inf)
    np.testing.assert_allclose(found[1:4], inner**2 / (inner**2 + outer**2), rtol=1e-12)
    assert found[0] < 1e-10 and found[-1] == pytest.approx(1.0)


def test_a_barrier_near_the_bed_holds_long_waves_back() -> None:
    """All of them without a gap, none through a wide one; a thin gap lets less through than a wide one."""
    k = np.array([0.01, 0.05])
    np.testing.assert_allclose(reflected_energy(k, 7.0, 7.0), 1.0)
    narrow, wide = reflected_energy(k, 6.9, 7.0), reflected_energy(k, 3.5, 7.0)
    assert (narrow > 3.0 * wide).all() and (narrow < 1.0).all()
    # an orifice in a channel: R^2 = (k l/2)^2 where that is small, l = 4 h/pi ln(1/sin(pi g/2h))
    length = 28.0 / math.pi * math.log(1.0 / math.sin(math.pi * 0.1 / 14.0))
    assert narrow[0] == pytest.approx((0.005 * length) ** 2, rel=0.05)


def test_short_waves_push_with_all_of_their_momentum() -> None:
    """A wall feels rho g H_s^2 / 16 of a sea and rho g H^2 / 8 of regular waves, and oblique ones less."""
    spectrum = jonswap(0.6, 1.2, 3.3)
    wall = 1025.0 * 9.81 * 0.6**2 / 16.0
    sea = IrregularSea("sea", spectrum, 0.0, duration=600.0, seed=1)
    assert mean_drift_force(sea, 0.0, 20.0, WATER) == pytest.approx(wall, rel=2e-3)
    waves = RegularSea("waves", 0.6, (1.2,), heading=math.radians(60.0))
    assert mean_drift_force(waves, 0.0, 20.0, WATER) == pytest.approx(0.5 * 1025.0 * 9.81 * 0.6**2 / 8.0, rel=1e-6)
    speed = drift_speed((sea,), 0.0, 20.0, 1.5, WATER)
    assert 0.5 * 1025.0 * 1.5 * 20.0 * speed**2 == pytest.approx(wall, rel=2e-3)


@pytest.mark.slow
def test_a_held_curtain_without_a_current_snaps_as_it_drifts(tmp_path: Path) -> None:
    """What a small current does to it, its waves do as well; still water alone never draws it taut."""
    still = run(tmp_path, "waves", waves=WAVES)
    table = next(group for group in still.tree.subtree if group.path.endswith("weaker_currents"))
    speeds = table["weaker_current"].values
    assert speeds.min() > 0.0 and len(speeds) > 1
    alone = headline(still, "anchor_tension").value
    end = headline(still, "anchor_tension").band.high
    for speed in (0.01, speeds[0]):
        moving = run(tmp_path, "statics, waves", waves=WAVES, current=CURRENT.replace("0.3 m/s", f"{speed:.17g} m/s"))
        # a current weaker than the drift changes nothing but its own steady part
        assert headline(moving, "anchor_tension").value == pytest.approx(alone, rel=0.02)
        assert headline(moving, "anchor_tension").band.high == pytest.approx(end, rel=0.05)
    own = next(group for group in moving.tree.subtree if group.path.endswith("waves/daily"))
    assert float(table["both_cables_tension_maximum"][0, 0]) == pytest.approx(
        float(own["both_cables_tension_maximum"].max()), rel=1e-9
    )


@pytest.mark.slow
def test_a_limit_of_a_free_toe_by_a_plate_is_no_ceiling(tmp_path: Path) -> None:
    """A plate bounds the load of a free toe from above: the current that it allows is held at least."""
    found = run(tmp_path, "statics, impact, limits", current=CURRENT, toe="free", holding="40 kN")
    limit = headline(found, "limit_current")
    assert limit.bound != "at most"


def test_limits_count_the_impact_next_to_a_run_of_the_whole_span(monkeypatch: pytest.MonkeyPatch) -> None:
    """The span is run in the state of the case alone: the limit in other currents is that of the plate."""
    asked = []

    def roles(unit: object, settings: CurtainSettings, *, speed: float) -> tuple[()]:
        asked.append(settings.analyses)
        return ()

    monkeypatch.setattr(limits, "hierarchy", roles)
    settings = replace(CurtainSettings(), analyses=("statics", "impact", "dynamic"))
    limits.CountedLimits(None, settings, None).role(0.3)  # type: ignore[arg-type]
    assert asked == [("statics", "impact")]


@pytest.mark.slow
def test_a_drift_in_which_the_plate_is_a_bound_is_at_most(tmp_path: Path) -> None:
    """A light held skirt bulges in the drift of high waves: its load there is known from above alone."""
    high = WAVES.replace("height: 0.4 m, periods: [3.5 s]", "height: 0.9 m, periods: [4 s]")
    found = run(tmp_path, "waves", waves=high)
    table = next(group for group in found.tree.subtree if group.path.endswith("weaker_currents"))
    drift = float(table["weaker_current"].max())
    unit = assemble(build(moyai.load_case(tmp_path / "case.yaml")), *LEVEL)
    assert drift == pytest.approx(unit.drift_speed)
    loads = next(group for group in found.tree.subtree if group.path.endswith("/loads")).to_dataset()
    row = loads.sel(component="anchor line")
    bounded = straight_share(unit, drift) < STRAIGHT
    assert (str(row["load_bound"].values) == "at most") == bounded
    assert bounded


@pytest.mark.slow
def test_floats_are_judged_where_no_statics_are_asked_for(tmp_path: Path) -> None:
    heavy = {"pretension": "34 kN", "holding": "200 kN"}
    for analyses, more in (("waves", {"waves": WAVES}), ("impact", {"current": CURRENT.replace("0.3 m/s", "0.6 m/s")})):
        found = run(tmp_path, analyses, toe="free", **heavy, **more)
        assert headline(found, "float_reserve").value < 0.0
        assert "reserve of the floats" in found.verdict.message


@pytest.mark.slow
def test_limits_without_snaps_are_at_most(tmp_path: Path) -> None:
    found = run(tmp_path, "statics, limits", current=CURRENT)
    for name in ("limit_current", "limit_wave_height"):
        limit = headline(found, name)
        assert limit.bound == "at most" or limit.text == "not known"
        assert "is counted" in limit.detail
    counted = headline(run(tmp_path, "statics, impact, limits", current=CURRENT), "limit_current")
    assert counted.bound != "at most" and counted.value <= headline(found, "limit_current").value


@pytest.mark.slow
def test_limits_with_a_sheet_that_is_not_known_are_at_most(tmp_path: Path) -> None:
    """Where part of the skirt lies on the bed, its load in a snap is not known."""
    text = CASE.replace("skirt: {length: 5 m,", "may_lie_on_bed: true\n  skirt: {length: 9.5 m,")
    filled = {"current": CURRENT, "waves": "", "toe": "held", "holding": "120 kN", "pretension": "0 kN"}
    (tmp_path / "case.yaml").write_text(text % (filled | {"analyses": "statics, impact, limits"}))
    limit = headline(moyai.run(tmp_path / "case.yaml"), "limit_current")
    assert limit.bound == "at most" and "sheet" in limit.detail
