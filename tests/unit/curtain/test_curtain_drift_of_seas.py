"""Held curtains in the drift of their seas: limits, skirts to the bed, bounds, and anchors that hold both edges."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import moyai
from moyai.case.builder import build
from moyai.core.headline import Headline
from moyai.core.progress import silent
from moyai.sea.water import Water
from moyai.structures.curtain.analyses.dynamic import through
from moyai.structures.curtain.analyses.weaker_currents import currents_of_waves
from moyai.structures.curtain.assembly import LevelCurtain, assemble
from moyai.structures.curtain.dynamic.assembly import build_span
from moyai.structures.curtain.dynamic.model import AnchoredSupport, CurtainSpan, Mesh
from moyai.structures.curtain.dynamic.plans import plans_of
from moyai.structures.curtain.dynamic.span import span_of
from moyai.structures.curtain.hierarchy import STRAIGHT, straight_share

WATER = Water(depth=5.0, density=1025.0, gravity=9.81)
CASE = """\
moyai: 1
title: Held skirt
site: {water_depth: %(water)s m, density: 1025 kg/m3, gravity: 9.81 m/s2%(levels)s}
%(current)s
%(waves)s
structure:
  kind: curtain
  span: 12 m
  length: 13.2 m
  may_lie_on_bed: true
  skirt: {length: %(skirt)s m, submerged_weight: 3 N/m2, stiffness: 500 kN/m, strength: %(sheet)s}
  toe: {kind: held, chain_mass: 10 kg/m}
  cables:
    upper: {catalogue: polyester, diameter: 24 mm}
    lower: {catalogue: polyester, diameter: 24 mm}
  floats: {buoyancy: 1200 N/m, weight: 100 N/m}
  anchors: {line_length: 20 m, axial_stiffness: 3 MN, breaking_load: %(breaking)s, holding_force: %(holding)s}
  drag: {law: constant, coefficient: 1.5, range: [0.8, 1.3]}
analyses: [%(analyses)s]
settings: {waves: {realisations: 4}%(settings)s}
"""

CHORD = ", impact: {chord: 2.99 m}"


def text(**changes: object) -> str:
    filled = {
        "water": 5, "levels": "", "current": "", "waves": "", "skirt": 3, "sheet": "60 kN/m", "breaking": "180 kN",
        "holding": "60 kN", "analyses": "waves", "settings": "",
    } | changes  # fmt: skip
    return CASE % filled


def sea(height: float, period: float) -> str:
    return (
        f"waves: {{name: wind, kind: jonswap, significant_height: {height} m, significant_period: {period} s, "
        "peak_enhancement: 3.3, heading_deg: 0, duration: 15 min, seed: 3}"
    )


def current(speed: float) -> str:
    return f"current: {{speed: {speed} m/s, heading_deg: 0}}"


def run(folder: Path, case: str) -> moyai.report.views.ReportedResult:
    (folder / "case.yaml").write_text(case)
    return moyai.run(folder / "case.yaml")


def unit_of(folder: Path, case: str) -> LevelCurtain:
    (folder / "case.yaml").write_text(case)
    return assemble(build(moyai.load_case(folder / "case.yaml")), "SWL", 0.0)


def headline(result: moyai.report.views.ReportedResult, name: str) -> Headline:
    return next(item for item in result.headlines if item.name == name)


@pytest.mark.parametrize("skirt", [4.999, 5, 5.001])
def test_a_skirt_as_long_as_the_water_is_deep_hangs_straight_and_drifts(tmp_path: Path, skirt: float) -> None:
    """Its stretch of some tenths of a millimetre under the toe had left it without an equilibrium."""
    unit = unit_of(tmp_path, text(skirt=skirt, waves=sea(0.3, 3.0)))
    assert straight_share(unit, unit.drift_speed) > STRAIGHT
    speeds = currents_of_waves(unit)
    assert len(speeds) > 2 and speeds[-1] == pytest.approx(unit.drift_speed, rel=1e-9)


def test_a_skirt_that_stretches_to_the_bed_rests_there_or_is_refused(tmp_path: Path) -> None:
    soft = text(skirt=4.995, waves=sea(0.3, 3.0)).replace("stiffness: 500 kN/m", "stiffness: 30 kN/m")
    assert unit_of(tmp_path, soft).site.statics(unit_of(tmp_path, soft).hanging, 0.05).section.toe_depth <= 5.0 + 1e-9
    with pytest.raises(moyai.core.errors.InputError, match="deeper than the water"):
        unit = unit_of(tmp_path, soft.replace("may_lie_on_bed: true", "may_lie_on_bed: false"))
        unit.site.statics(unit.hanging, 0.05)


@pytest.mark.slow
def test_neighbours_of_a_skirt_to_the_bed_bear_alike(tmp_path: Path) -> None:
    loads = [
        headline(run(tmp_path, text(skirt=skirt, waves=sea(0.3, 4.0))), "anchor_tension").value
        for skirt in (4.98, 5, 5.02)
    ]
    assert min(loads) > 0.7 * max(loads) > 1e4


@pytest.mark.slow
def test_a_long_skirt_without_a_current_has_a_page(tmp_path: Path) -> None:
    """At low water it is 1.5 times as long as the water is deep; its load in no current is none."""
    levels = ", water_levels: {HWL: 1.2 m, LWL: -0.8 m}"
    result = run(tmp_path, text(skirt=6.3, levels=levels, waves=sea(0.3, 2.5), breaking="600 kN", holding="250 kN"))
    assert headline(result, "anchor_tension").value > 1e3


@pytest.mark.slow
def test_a_drift_beyond_the_upright_plate_is_a_bound_on_the_page(tmp_path: Path) -> None:
    case = text(water=7, skirt=6.5, waves=sea(0.9, 4.2), breaking="1.4 MN", holding="650 kN", sheet="160 kN/m")
    for old, new in (("span: 12 m", "span: 18 m"), ("length: 13.2 m", "length: 20 m"), ("24 mm", "40 mm"),
                     ("500 kN/m", "700 kN/m"), ("20 m, axial_stiffness: 3", "28 m, axial_stiffness: 4")):  # fmt: skip
        case = case.replace(old, new)
    result = run(tmp_path, case)
    drifting = [item for item in result.headlines if "0.349 m/s" in item.where]
    assert {"anchor_tension", "cable_tension"} <= {item.name for item in drifting}
    assert all(item.bound == "at most" and item.band is None for item in drifting)
    assert headline(result, "anchor_tension").value < max(
        item.value for item in drifting if item.name == "anchor_tension"
    )
    assert result.verdict.outcome != "does not hold"


@pytest.mark.slow
def test_the_wave_height_that_is_held_is_where_the_page_turns(tmp_path: Path) -> None:
    """Whatever sea the case has, or none: the drift is that of the sea that is tried."""
    asked = "statics, impact"
    limits = []
    for waves, analyses in (("", f"{asked}, limits"), (sea(0.1, 2.0), f"{asked}, waves, limits")):
        found = run(tmp_path, text(current=current(0.05), waves=waves, analyses=analyses, settings=CHORD))
        limits.append(headline(found, "limit_wave_height").value)
    # two digits, rounded down, of other lengths of the seas
    assert limits[0] == pytest.approx(limits[1], rel=0.1)
    period = found.tree["/SWL/limits"].attrs["design_limit_period"]
    for share, outcome in ((0.85, "holds"), (1.25, "does not hold")):
        height, length = share * limits[1], period * share**0.5
        there = text(current=current(0.05), waves=sea(round(height, 3), round(length, 2)),
                     analyses=f"{asked}, waves", settings=CHORD)  # fmt: skip
        assert run(tmp_path, there).verdict.outcome == outcome, height


@pytest.mark.slow
def test_a_whole_span_on_anchors_keeps_its_lower_cable_under_the_upper_one(tmp_path: Path) -> None:
    """The ends of the lower cable had been free to go with the water; between fixed ends nothing of it shows."""
    settings = ", dynamic: {cells_along: 8, cells_down: 4, sensitivity: false%s}"
    case = text(current=current(0.4), analyses="dynamic", settings=settings)
    case = case.replace("submerged_weight: 3 N/m2", "mass_per_area: 0.8 kg/m2, sheet_density: 1380 kg/m3")
    moored = run(tmp_path, case % ", support_mass: 100 kg")
    fixed = run(tmp_path, "".join(line for line in (case % "").splitlines(True) if "anchors:" not in line))
    peaks = []
    for result in (moored, fixed):
        loads = result.tree["/SWL/loads"].to_dataset().sel(component=["upper cable", "lower cable"])
        peaks.append(loads["dynamic_load"].values)
    # lines give way, and a snap goes with the root of the stiffness; free ends had a fifth of the fixed ones
    assert np.all((0.4 * peaks[1] < peaks[0]) & (peaks[0] < 1.1 * peaks[1])), peaks
    frames = next(node for node in moored.tree.subtree if node.path.endswith("/frames")).to_dataset()
    place = frames["node_position"].values[:, : 9 * 5]
    column = np.flatnonzero(place[0, :, 1] < place[0, :, 1].min() + 1e-6)
    column = column[np.argsort(place[0, column, 2])]
    assert np.ptp(place[:, column[[0, -1]], 0], axis=1).max() < 0.2


@pytest.mark.slow
def test_a_steep_line_pulls_as_hard_on_its_anchor_as_its_two_parts(tmp_path: Path) -> None:
    """The part to the toe is flatter than the one to the buoy: their pulls along the bed add up, not their tensions."""
    settings = ", dynamic: {cells_along: 8, cells_down: 4, sensitivity: false, support_mass: 100 kg}"
    case = text(water=5, current=current(0.5), analyses="dynamic", settings=settings)
    case = case.replace("line_length: 20 m", "line_length: 7 m")
    case = case.replace("submerged_weight: 3 N/m2", "mass_per_area: 0.8 kg/m2, sheet_density: 1380 kg/m3")
    unit = unit_of(tmp_path, case)
    problem = build(moyai.load_case(tmp_path / "case.yaml"))
    built = span_of(unit, problem.settings.dynamic)
    (plan,) = plans_of(unit, problem.settings, (), built)
    _, found, _ = through(built, problem.settings.dynamic.mesh, plan, silent, "")
    name, bars, history = found.built.lines[0], found.built.network.bars, found.history
    mine = found.built.bars(name)
    way = history.position[:, bars.end[mine]] - history.position[:, bars.start[mine]]
    level = np.linalg.norm(way[..., :2], axis=2) / np.linalg.norm(way, axis=2)
    pull = 2.0 * (level * history.tension_peak[:, mine]).sum(axis=1)
    assert level[0].max() > 1.1 * level[0].min()
    np.testing.assert_allclose(np.cos(built.support.slope) * found.tension(name), pull, rtol=1e-12)


@pytest.mark.slow
def test_stronger_anchors_keep_the_height_that_weaker_ones_hold(tmp_path: Path) -> None:
    """Where the drift passes the range of the upright plate the height is "at least" the sea that drifts so far."""
    case = text(water=25, skirt=15, current=current(0.05), analyses="statics, impact, limits", sheet="200 kN/m")
    for old, new in (("span: 12 m", "span: 25 m"), ("length: 13.2 m", "length: 28 m"), ("24 mm", "60 mm"),
                     ("500 kN/m", "1500 kN/m"), ("20 m, axial_stiffness: 3", "80 m, axial_stiffness: 20"),
                     ("1200 N/m, weight: 100", "4000 N/m, weight: 300")):  # fmt: skip
        assert old in case, old
        case = case.replace(old, new)
    heights, bounds = [], []
    for holding in ("100 kN", "400 kN", "2 MN"):
        there = case.replace("holding_force: 60 kN", f"holding_force: {holding}").replace("180 kN", "6 MN")
        limit = headline(run(tmp_path, there), "limit_wave_height")
        heights.append(limit.value)
        bounds.append(limit.bound)
    assert np.isfinite(heights).all() and np.all(np.diff(heights) >= 0.0), heights
    assert bounds[0] == "" and bounds[-1] == "at least", bounds


def test_an_anchor_line_is_led_to_both_edges_of_a_held_skirt() -> None:
    support = AnchoredSupport(24.0, 0.3, 4e6, 5e3, 100.0)
    held, free = (
        build_span(
            CurtainSpan(15.0, 16.5, 3.0, 3.0, 2e6, 2e6, 15.0, 17.0, 7e5, 0.8, edges=edges, support=support),
            Mesh(8, 4), WATER,
        )
        for edges in ("risen", "free")
    )  # fmt: skip
    for built, parts in ((held, 2), (free, 1)):
        bars = built.network.bars
        for name in built.lines:
            mine = built.bars(name)
            stiffness = [bars.types[bars.kind[bar]].axial_stiffness for bar in mine]
            assert mine.size == parts and sum(stiffness) == pytest.approx(2e6, rel=1e-12)
    ends = {int(node) for name in held.lines for node in held.network.bars.start[held.bars(name)]}
    assert ends == {int(node) for node in held.grid[[0, -1]][:, [0, -1]].ravel()}
