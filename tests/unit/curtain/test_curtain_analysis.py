"""Curtain runs from case to result: figures of the sources come out of the groups, loads and limits agree."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from renamed import unmissed

from moyai.case.builder import build
from moyai.case.reader import load_case
from moyai.core.errors import InputError
from moyai.series.snap_statistics import fit_snaps
from moyai.structures.curtain import headlines
from moyai.structures.curtain.analyses import loads
from moyai.structures.curtain.analyses.dynamic import SpanLoad
from moyai.structures.curtain.analyses.impact import solve_impact
from moyai.structures.curtain.analyses.limits import fastest_water, sea_loads
from moyai.structures.curtain.analyses.loads import loads_dataset
from moyai.structures.curtain.analyses.waves import _maximum
from moyai.structures.curtain.assembly import assemble
from moyai.structures.curtain.governing import WEAKER
from moyai.structures.curtain.hierarchy import CYCLES, IMPACT, ModelRole
from moyai.structures.curtain.limits.loads import impact_load
from moyai.structures.curtain.limits.utilisation import utilisation
from moyai.structures.curtain.model import COMPONENTS
from moyai.structures.curtain.run import run
from moyai.structures.curtain.seas.cycles_of_sea import SeaCycles
from moyai.structures.curtain.seas.loads import drag_curve
from moyai.structures.curtain.statics.steady_load import QUANTITIES
from moyai.structures.curtain.variables import VOCABULARY

PAPERS = Path(__file__).parents[3] / "src" / "moyai" / "reproduce" / "cases"
SMALL = """moyai: 1
title: Small curtain
site: {water_depth: 8 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
current: {speed: 0.2 m/s, heading_deg: 0}
waves: {kind: regular, height: 0.6 m, period: 4 s, heading_deg: 0}
structure:
  kind: curtain
  span: 12 m
  length: 13.5 m
  skirt: {length: 4 m, submerged_weight: 3 N/m2, stiffness: 500 kN/m, strength: 100 kN/m}
  toe: {kind: free, weight: 180 N/m}
  cables: {upper: {axial_stiffness: 60 kN, breaking_load: 60 kN}}
  floats: {buoyancy: 900 N/m, weight: 90 N/m}
  joints: {distance: 6 m, strength: 40 kN}
  anchors: {line_length: 25 m, axial_stiffness: 2 MN, breaking_load: 100 kN, holding_force: 60 kN}
  drag: {law: constant, coefficient: 1.3, range: [0.8, 1.4]}
analyses: [statics, impact, waves, anchor_loads, limits]
settings:
  impact: {start_speed: 0.05 m/s}
  anchor_loads: {energy_factor: 0.2, float_mass: 300 kg}
  safety_factors: {cable: 3, sheet: 4, joint: 3, anchor_line: 3, anchor: 1.5}
  limits: {highest_speed: 1 m/s, highest_height: 2 m}
"""


def problem_of(folder: Path, text: str):
    file = folder / "case.yaml"
    file.write_text(text, encoding="utf-8")
    return build(load_case(file))


@pytest.fixture(scope="module")
def small(tmp_path_factory):
    few = SMALL.replace("  limits: {", "  waves: {realisations: 2}\n  limits: {speeds: [0.2 m/s, 0.7 m/s, 0.9 m/s], ")
    problem = problem_of(tmp_path_factory.mktemp("small"), few)
    return problem, run(problem)


def test_whatever_a_run_writes_is_missed_where_it_is_absent(small):
    """A draft leaves the upper end of the drag out: it alone may be absent."""
    assert unmissed(small[1]) == {"strong_drag_tension"}


def test_layout_page_names_what_is_written(small):
    page = (Path(__file__).parents[3] / "docs" / "result_layout.md").read_text(encoding="utf-8")
    page = page[page.index("## Curtain") :]
    _, result = small
    spoken = {"most_probable_maximum_low", "most_probable_maximum_high"}
    # the page says "..._low and ..._high of each"
    spoken |= {f"steady_{name}_{end}" for name, _, _ in QUANTITIES for end in ("low", "high")}
    for node in result.tree.subtree:
        dataset = node.to_dataset(inherit=False)
        for name in (*dataset.data_vars, *dataset.dims):
            assert f"`{name}`" in page or str(name) in spoken or f"{name}" in page, (node.path, name)
        for name in dataset.data_vars:
            if dataset[name].dtype.kind == "f":
                assert name in VOCABULARY, (node.path, name)


def test_statics_group_is_the_library_at_both_ends_of_the_drag(small):
    problem, result = small
    unit = assemble(problem, "SWL", 0.0)
    data = result.tree["SWL/statics"]
    assert data["drag_coefficient"].values == pytest.approx([0.8 * 1.3, 1.3, 1.4 * 1.3])
    for name in ("cable_tension", "section_load", "flare", "anchor_horizontal_tension"):
        assert np.all(np.diff(data[name].values) > 0.0), name
    assert np.all(np.diff(data["effective_depth"].values) < 0.0)
    given = data.to_dataset().sel(drag_case="given")
    assert float(given["cable_tension"]) == pytest.approx(unit.statics.plan.tension, rel=1e-12)
    # continuity: what the curtain holds up goes under the toe
    held = 0.2 * float(given["toe_depth"])
    below = 8.0 - float(given["toe_depth"])
    assert float(given["toe_speed"]) == pytest.approx(0.2 + held / below, rel=1e-9)
    paper = result.tree["SWL/statics_paper"]
    assert float(paper["paper_cable_tension"]) < float(paper["paper_cable_tension_inextensible"])
    laws = result.tree["SWL/statics_laws"]
    assert laws["section_law"].values.tolist() == ["catenary", "circular", "rigid", "elastic"]
    # drawn shapes end where the laws say, and are as long as the skirt
    x, z = laws["law_section_x"].values, laws["law_section_z"].values
    assert x[:, -1] - x[:, 0] == pytest.approx(laws["law_flare"].values, abs=1e-9)
    assert z[:, 0] - z[:, -1] == pytest.approx(laws["law_effective_depth"].values, abs=1e-9)
    arc = np.sum(np.hypot(np.diff(x, axis=1), np.diff(z, axis=1)), axis=1)
    assert arc == pytest.approx(np.array([4.0, 4.0, 4.0, 4.0 * (1.0 + 180.0 / 500e3)]), rel=1e-3)
    down = laws["law_plan_x"].values
    assert np.max(down, axis=1) == pytest.approx(laws["law_sag"].values, abs=1e-9)
    lengths = np.sum(np.hypot(np.diff(down, axis=1), np.diff(laws["law_plan_y"].values, axis=1)), axis=1)
    assert lengths[:2] == pytest.approx([13.5, 13.5], rel=1e-3)


def test_load_table_adds_up(small):
    _, result = small
    table = result.tree["SWL/loads"].to_dataset()
    steady, wave = table["steady_load"].values, table["wave_load"].values
    hit, governing = table["impact_load"].values, table["governing_load"].values
    judged = [str(name) for name in table["component"].values if name not in ("float", "lower cable")]
    for name in judged:
        row = table.sel(component=name)
        # a bound stands at the upper end of its parts
        end = "high" if str(row["load_bound"].values) == "at most" else "load"
        more = np.nanmax([0.0, float(row["wave_load"]), float(row["impact_load"])])
        if str(row["governing"].values) == "steady and impact":
            more = float(row[f"impact_{end}"])
        assert float(row["governing_load"]) == pytest.approx(float(row[f"steady_{end}"]) + more, rel=1e-12)
        expected = float(row["governing_load"]) * float(row["safety_factor"]) / float(row["capacity"])
        assert float(row["factored_utilisation"]) == pytest.approx(expected, rel=1e-12)
    assert math.isnan(float(table.sel(component="lower cable")["steady_load"]))
    assert np.nanmax(np.abs(steady)) > 0.0 and np.nanmax(wave) > 0.0 and np.nanmax(hit) > 0.0
    worst = str(table["component"].values[int(np.nanargmax(table["factored_utilisation"].values))])
    assert table.attrs["governing_component"] == worst
    assert np.isfinite(governing[0])


@pytest.mark.slow
def test_impact_governs_where_it_is_the_largest(tmp_path):
    text = SMALL.replace("start_speed: 0.05 m/s", "start: current")
    text = text.replace("[statics, impact, waves, anchor_loads, limits]", "[statics, impact]")
    table = run(problem_of(tmp_path, text)).tree["SWL/loads"].to_dataset()
    assert str(table.sel(component="upper cable")["governing"].values) == "steady and impact"
    assert float(table.sel(component="anchor")["impact_load"]) > float(table.sel(component="anchor")["wave_load"])


@pytest.mark.slow
def test_limit_height_is_where_a_component_is_used_up(small):
    """At the height of the table the largest utilisation is 1, a little above it exceeds 1 or the wave breaks."""
    problem, result = small
    unit = assemble(problem, "SWL", 0.0)
    limits = result.tree["SWL/limits"].to_dataset()
    from moyai.structures.curtain.analyses.impact import solve_impact

    answer = solve_impact(unit, problem.settings.impact)
    curve = drag_curve(unit, fastest_water(unit, problem.settings, ()))
    loads = sea_loads(unit, problem.settings, answer, curve)
    judged = 0
    for speed, height, name in zip(
        limits["speed"].values, limits["limit_height"].values, limits["limit_governing"].values
    ):
        if name in ("breaking", "not reached", "no equilibrium") or height == 0.0:
            continue
        judged += 1
        statics = unit.site.statics(unit.hanging, float(speed))
        for share, below in ((1.0 - 1e-6, True), (1.0 + 1e-3, False)):
            added = loads.added(statics, share * float(height), float(speed), unit.water)
            state = unit.site.with_floats(statics, float(speed))
            parts = utilisation(state, unit.requirements, 0.0, added)
            assert (max(parts.values()) <= 1.0) is below, (speed, height, name)
            if below:
                assert max(parts, key=lambda key: parts[key]) == name
    assert judged >= 1
    assert float(limits["speed_limit"]) > 0.0
    # more current, less wave
    assert np.all(np.diff(limits["limit_height"].values) <= 1e-6)
    grid = limits["limit_factored_utilisation"].values
    assert np.all(np.diff(grid, axis=1)[np.isfinite(grid[:, 1:])] >= -1e-9)


@pytest.mark.slow
def test_impact_tightens_the_limits(tmp_path):
    hard = SMALL.replace("start_speed: 0.05 m/s", "start: current")
    hard = hard.replace("[statics, impact, waves, anchor_loads, limits]", "[impact, limits]")
    hard = hard.replace("highest_height: 2 m}", "highest_height: 2 m, speeds: [0.1 m/s, 0.3 m/s]}")
    without = hard.replace("highest_height: 2 m,", "highest_height: 2 m, impact: false,")
    limits = [run(problem_of(tmp_path, text)).tree["SWL/limits"] for text in (hard, without)]
    assert float(limits[0]["speed_limit"]) < float(limits[1]["speed_limit"])
    assert limits[0].attrs["with_impact"] == 1 and limits[1].attrs["with_impact"] == 0


def test_drag_curve_is_the_statics_between_its_points(small):
    problem, _ = small
    unit = assemble(problem, "SWL", 0.0)
    curve = drag_curve(unit, 2.0)
    rng = np.random.default_rng(11)
    for speed in rng.uniform(0.1, 2.0, 6):
        statics = unit.site.statics(unit.hanging, float(speed) / unit.unit_normal_speed)
        found = curve.at(float(speed))
        assert found.upper_cable == pytest.approx(statics.upper_tension, rel=3e-3)
        assert found.line_load == pytest.approx(statics.section.load, rel=3e-3)
        assert found.anchor_line == pytest.approx(statics.anchor_tension, rel=3e-3)


def test_waves_along_the_normal_load_a_curtain_in_an_oblique_current_by_their_own_direction(tmp_path):
    """The drag curve of an oblique current is that of the current's normal component alone."""
    units = []
    for angle, speed in ((65.0, 0.2), (0.0, 0.2 * math.cos(math.radians(65.0)))):
        text = SMALL.replace("speed: 0.2 m/s, heading_deg: 0", f"speed: {speed!r}, heading_deg: {angle}")
        units.append(assemble(problem_of(tmp_path, text), "SWL", 0.0))
    oblique, square = (drag_curve(unit, 1.5) for unit in units)
    rng = np.random.default_rng(17)
    for speed in rng.uniform(0.05, 1.5, 6):
        one, other = oblique.at(float(speed)), square.at(float(speed))
        assert one.upper_cable == pytest.approx(other.upper_cable, rel=1e-9)
        assert one.anchor_line == pytest.approx(other.anchor_line, rel=1e-9)


@pytest.mark.slow
def test_notices_name_their_water_level_where_it_matters(tmp_path):
    text = SMALL.replace("water_depth: 8 m,", "water_depth: 8 m, water_levels: {HWL: 2 m, LWL: -1.5 m},")
    text = text.replace("[statics, impact, waves, anchor_loads, limits]", "[statics, impact]")
    messages = [notice.message for notice in run(problem_of(tmp_path, text)).notices]
    blocked = [message for message in messages if "blockage d/h" in message]
    assert [message.split(":")[0] for message in blocked] == ["HWL", "LWL"]
    # what holds at all levels is reported once
    assert sum("models B and AB" in message for message in messages) == 1
    assert not any(message.startswith(("HWL: models B", "LWL: models B")) for message in messages)


def test_notices_of_snaps_name_their_sea_and_endless_seas_are_refused(tmp_path):
    sea = "waves: {name: winter, kind: jonswap, significant_height: 0.6 m, significant_period: 4 s, peak_enhancement: 2, heading_deg: 0, duration: DURATION, seed: 2}"  # noqa: E501
    text = SMALL.replace("waves: {kind: regular, height: 0.6 m, period: 4 s, heading_deg: 0}", sea)
    text = text.replace("[statics, impact, waves, anchor_loads, limits]", "[waves]")
    messages = [notice.message for notice in run(problem_of(tmp_path, text.replace("DURATION", "5 min"))).notices]
    rises = [message for message in messages if "snaps have a rise time" in message]
    assert rises and all(message.startswith("winter: ") for message in rises)
    with pytest.raises(InputError, match="million samples"):
        run(problem_of(tmp_path, text.replace("DURATION", "1000 h")))


def test_run_without_identities_does_not_claim_that_they_hold(tmp_path):
    text = SMALL.replace("[statics, impact, waves, anchor_loads, limits]", "[limits]")
    result = run(problem_of(tmp_path, text))
    assert result.status == "converged" and not result.checks
    assert "no identity" in result.message
    assert float(result.tree["SWL/limits"]["surface_speed"]) == 0.2


def test_snap_table_is_the_sea_run_as_a_case(small):
    """At a height that was run the table is that sea with its realisations, and it never falls with the height."""
    from moyai.core.progress import silent
    from moyai.sea.spectra import goda_peak_period, jonswap
    from moyai.sea.states import IrregularSea
    from moyai.series.intervals import reach_of_mean, scatter_of_end
    from moyai.structures.curtain.analyses.impact import solve_impact
    from moyai.structures.curtain.analyses.waves import wave_answer
    from moyai.structures.curtain.limits.loads import _snaps
    from moyai.structures.curtain.seas.squared_velocity import effective_height

    problem, _ = small
    unit = assemble(problem, "SWL", 0.0)
    settings = problem.settings
    answer = solve_impact(unit, settings.impact)
    height = settings.limits.highest_height * (6.0 / 10.0) ** 1.5
    period = goda_peak_period(settings.limits.period_of(height), 3.3)
    table = _snaps(unit, settings, answer, 200.0 * period)
    acting = float(effective_height(height, 0.0, settings.direction[0], 1.0))
    sea = IrregularSea("sea", jonswap(acting, period, 3.3), unit.curtain.normal, duration=200.0 * period, seed=1)
    there = replace(unit, surface_speed=0.3)
    found = wave_answer(there, settings, sea, silent).groups[""]
    tops = found["realisation_tension"].values
    assert tops.size == settings.waves.realisations and tops.min() > 0.0
    series = [table.tension(0.3, float(h)) for h in np.linspace(0.0, height, 20)]
    assert np.all(np.diff(series) >= 0.0) and series[0] == 0.0
    # a lower sea that pulls harder counts at the higher one too
    assert series[-1] >= tops.mean() * (1.0 - 1e-12)
    own, judged, others = table._known[0.3, 6]
    assert own == pytest.approx(tops.mean(), rel=1e-12)
    assert judged == pytest.approx(tops.mean() + reach_of_mean(tops), rel=1e-12)
    assert others == pytest.approx(judged + scatter_of_end(tops), rel=1e-12)
    assert table.tension(0.3, height, judged=True, other_seeds=True) >= others * (1.0 - 1e-12)
    # what was not run is not run for a map: at least what is known
    beyond = table.tension(0.3, settings.limits.highest_height, known=True)
    assert beyond == pytest.approx(table.tension(0.3, height), rel=1e-12)
    assert table.tension(0.7, height, known=True) == 0.0


def test_anchor_loads_of_the_field_paper(tmp_path):
    """Worked example, T = 7 s, 60 degrees: 14.5 kN; squared velocity 5.6471736 m2/s2 of a wave of 5.508 m."""
    text = (PAPERS / "tabata" / "kansai.yaml").read_text(encoding="utf-8")
    start, end = text.index("waves:"), text.index("structure:")
    waves = """waves:
  - {name: worked, kind: bretschneider_mitsuyasu, significant_height: 3.06 m, significant_period: 7 s, heading_deg: 60}
  - {name: highest, kind: regular, height: 5.508 m, period: 7 s, heading_deg: 0}
"""
    text = text[:start] + waves + text[end:]
    text = text.replace("[statics, waves, anchor_loads, limits]", "[anchor_loads]")
    problem = problem_of(tmp_path, text)
    result = run(problem)
    assert result.status == "converged", result.message
    loads = result.tree["SWL/anchor_loads"].to_dataset()
    assert float(loads["effective_height"][0]) == pytest.approx(1.377, abs=5e-4)
    assert float(loads["float_speed"][0]) == pytest.approx(1.514, abs=5e-4)
    assert float(loads["rope_tension"][0]) / 1e3 == pytest.approx(14.5, abs=0.05)
    assert float(loads["squared_velocity"][1]) == pytest.approx(5.6471736, abs=5e-8)
    assert float(loads["mean_squared_velocity"][1]) == pytest.approx(2.4109, abs=5e-5)
    # pretension takes energy: T^2 = T0^2 + M m_B K U^2
    rise, steady = loads["rope_tension_pretensioned"].values, 13.7e3
    assert np.hypot(steady, loads["rope_tension"].values) - steady == pytest.approx(rise, rel=1e-9)
    assert loads["wire_tension"].values == pytest.approx(0.6 * rise)
    assert loads["conventional_tension"].values == pytest.approx(rise / 0.7)
    rules = loads["rule_height"].values[0]
    assert rules == pytest.approx([5.508 * 0.25, 5.508 * 0.5, 5.508])
    table = result.tree["SWL/loads"].to_dataset().sel(component="anchor line")
    # lines on both sides: the tight one bears half of the current
    force = assemble(problem, "SWL", 0.0).statics.anchor_tension
    assert float(table["steady_load"]) == pytest.approx(13.7e3 + 0.5 * force, rel=1e-3)


@pytest.mark.slow
def test_irregular_sea_has_snaps_and_a_law(tmp_path):
    text = SMALL.replace(
        "waves: {kind: regular, height: 0.6 m, period: 4 s, heading_deg: 0}",
        "waves: {name: storm, kind: jonswap, significant_height: 1.2 m, significant_period: 5 s, "
        "peak_enhancement: 3.3, heading_deg: 10, duration: 30 min, seed: 4}",
    ).replace("statics, impact, waves, anchor_loads, limits", "waves")
    result = run(
        problem_of(tmp_path, text.replace("length: 13.5 m", "length: 12.05 m").replace("speed: 0.2", "speed: 0.05"))
    )
    sea = result.tree["SWL/waves/storm"].to_dataset()
    peaks, share = sea["contact_tension_sorted"].values, sea["exceedance"].values
    assert peaks.size > 30 and np.all(np.diff(peaks) <= 0.0) and np.all(np.diff(share) > 0.0)
    tops = sea["realisation_tension"].values
    assert tops.size == 5 and peaks[0] == pytest.approx(tops.max(), rel=1e-6)
    assert float(sea["both_cables_tension_maximum"]) == pytest.approx(tops.mean(), rel=1e-12)
    assert (
        float(sea["both_cables_tension_maximum_low"])
        == tops.min()
        < tops.max()
        == float(sea["both_cables_tension_maximum_high"])
    )
    fitted = sea["fitted_exceedance"].values
    above = peaks > float(sea["weibull_threshold"])
    assert np.max(np.abs(fitted[above] - share[above] / share[above][-1])) < 0.15
    assert float(sea["most_probable_maximum_low"]) < float(sea["most_probable_maximum"])
    largest = result.tree["SWL/waves/storm/largest"]
    # shown is the realisation whose largest tension is nearest to the number that counts
    nearest = tops[np.argmin(np.abs(tops - tops.mean()))]
    assert float(largest["tension"].max()) == pytest.approx(nearest, rel=0.02)
    assert unmissed(result) == {"strong_drag_tension"}


@pytest.mark.slow
def test_skirt_on_the_bed_says_what_is_assumed(tmp_path):
    text = (
        SMALL.replace("{length: 4 m, sub", "{length: 8.6 m, sub")
        .replace("  drag:", "  may_lie_on_bed: true\n  drag:")
        .replace("speed: 0.2 m/s", "speed: 0.1 m/s")
        .replace("statics, impact, waves, anchor_loads, limits", "statics, impact")
    )
    result = run(problem_of(tmp_path, text))
    assert result.status == "converged", result.message
    assert result.tree["SWL"].attrs["toe"] == "on the bed"
    statics = result.tree["SWL/statics"].to_dataset().sel(drag_case="given")
    assert float(statics["toe_gap"]) == 0.0 and float(statics["toe_depth"]) == pytest.approx(8.0, abs=1e-9)
    assert float(statics["hanging_length"]) < 8.6
    # the cables carry the top's share only: twice the tension's downstream part is that share over the span
    assert float(statics["anchor_horizontal_tension"]) < 1.02 * float(statics["top_load"]) * 12.0
    assert any(notice.code == "curtain-on-bed" for notice in result.notices)
    text = text.replace("[statics, impact]", "[statics]")
    faster = run(problem_of(tmp_path, text.replace("speed: 0.1 m/s", "speed: 0.4 m/s")))
    assert faster.tree["SWL"].attrs["toe"] == "free"
    assert float(faster.tree["SWL/statics"]["toe_gap"].sel(drag_case="given")) > 0.0


def test_interrupt_hands_back_what_is_there(small):
    problem, _ = small

    def listener(what: str, done: float, total: float) -> None:
        if what.startswith("slack and taut"):
            raise KeyboardInterrupt

    result = run(problem, listener)
    assert result.status == "interrupted"
    names = {node.path for node in result.tree.subtree}
    assert "/SWL/impact" in names and "/SWL/limits" not in names


@pytest.mark.slow
def test_every_water_level_has_its_groups(tmp_path):
    text = SMALL.replace("water_depth: 8 m,", "water_depth: 8 m, water_levels: {high: 1 m, low: -1 m},").replace(
        "statics, impact, waves, anchor_loads, limits", "statics"
    )
    result = run(problem_of(tmp_path, text))
    depths = {name: result.tree[name].attrs["water_depth"] for name in ("high", "low")}
    assert depths == {"high": 9.0, "low": 7.0}
    gaps = [float(result.tree[f"{name}/statics"]["toe_gap"].sel(drag_case="given")) for name in ("high", "low")]
    assert gaps[0] - gaps[1] == pytest.approx(2.0, abs=1e-6)


@pytest.mark.slow
def test_site_axes_turn_with_the_curtain(tmp_path):
    """A curtain, its current and waves turned together give the same loads."""
    text = SMALL.replace("statics, impact, waves, anchor_loads, limits", "statics, waves, anchor_loads")
    turned = (
        text.replace("kind: curtain", "kind: curtain\n  normal_deg: 130")
        .replace("speed: 0.2 m/s, heading_deg: 0", "speed: 0.2 m/s, heading_deg: 130")
        .replace("period: 4 s, heading_deg: 0", "period: 4 s, heading_deg: 130")
    )
    first, second = (run(problem_of(tmp_path, case)).tree["SWL/loads"] for case in (text, turned))
    for name in ("steady_load", "wave_load"):
        assert first[name].values == pytest.approx(second[name].values, rel=1e-9, nan_ok=True)


def test_a_joint_is_bounded_by_its_cable_at_the_end_at_which_the_cable_is_judged(small):
    problem, _ = small
    unit = assemble(problem, "SWL", 0.0)
    unit = replace(unit, curtain=replace(unit.curtain, joint_distance=1e3))
    settings = replace(problem.settings, analyses=("statics", "waves"))
    curve = drag_curve(unit, 2.0)
    moved = {"upper cable": SpanLoad(9e3, "sea", False, 12e3)}
    table, _ = loads_dataset(unit, settings, (), (), None, None, curve, moved)
    cable, joint = (table.sel(component=name) for name in ("upper cable", "joint"))
    assert float(cable["governing_load"]) == pytest.approx(9e3) and float(cable["governing_high"]) == pytest.approx(
        12e3
    )
    assert float(joint["governing_load"]) == pytest.approx(12e3) and str(joint["load_bound"].values) == "at most"


@pytest.mark.slow
def test_a_case_with_seas_holds_only_where_snaps_in_them_are_run(tmp_path: Path) -> None:
    """The impact is one in the current: it says nothing of snaps in the seas."""
    text = SMALL.replace("analyses: [statics, impact, waves, anchor_loads, limits]", "analyses: [statics, impact]")
    text = (
        text.replace("  impact: {start_speed: 0.05 m/s}\n", "")
        .replace("kind: free", "kind: held")
        .replace(
            "breaking_load: 60 kN}}", "breaking_load: 60 kN}, lower: {axial_stiffness: 60 kN, breaking_load: 60 kN}}"
        )
    )
    seas = "waves: {kind: regular, height: 0.6 m, period: 4 s, heading_deg: 0}\n"
    without = run(problem_of(tmp_path, text.replace(seas, "")))
    assert without.verdict.outcome == "holds", without.verdict.message
    with_seas = run(problem_of(tmp_path, text))
    assert with_seas.verdict.outcome == "not judged"
    assert "snaps in the seas of the case were not run" in with_seas.verdict.message


@pytest.mark.parametrize("speed", ["0.2", "0.05"])
def test_reserve_of_the_floats_at_slack_water_has_the_band_of_the_toe(tmp_path: Path, speed: str) -> None:
    """Without a current the floats bear toe and sheet: (900 - 90 - 1.4 x 180 - 4 x 3)/900 with the heaviest toe."""
    text = SMALL.replace("weight: 180 N/m}", "weight: 180 N/m, range: [0.8, 1.4]}").replace(
        "speed: 0.2", f"speed: {speed}"
    )
    text = text.replace("analyses: [statics, impact, waves, anchor_loads, limits]", "analyses: [statics]")
    text = text.replace("  anchors: {line_length: 25 m, axial_stiffness: 2 MN, breaking_load: 100 kN, "
                        "holding_force: 60 kN}\n", "")  # fmt: skip
    result = run(problem_of(tmp_path, text))
    found = next(item for item in result.headlines if item.name == "float_reserve")
    ends = [(900.0 - 90.0 - factor * 180.0 - 12.0) / 900.0 for factor in (1.4, 1.0, 0.8)]
    assert found.band is not None and "weight of the toe" in found.band.of
    assert [found.band.low, found.value, found.band.high] == pytest.approx(ends, abs=2e-3)
    assert found.band.low == pytest.approx(ends[0], rel=1e-9)
    # the table of loads has the same
    row = result.tree["SWL/loads"].to_dataset(inherit=False).sel(component="float")
    loads_at = [float(row[name]) for name in ("steady_high", "steady_load", "steady_low")]
    assert [1.0 - load / 900.0 for load in loads_at] == pytest.approx(ends, abs=2e-3)


def test_waves_keep_their_load_where_an_impact_in_a_weaker_current_leads(small):
    """The impact leads by its value; the cycles may be judged at a higher end, which needs their load and their sea."""
    problem, _ = small
    unit = assemble(problem, "SWL", 0.0)
    roles = (ModelRole(IMPACT, "governs", "", ""), ModelRole(CYCLES, "governs", "", ""))
    unknown = (math.nan,) * 3
    rows = [loads._row(unit, name, unknown, math.nan, unknown, "", "") for name in COMPONENTS if name != "skirt"]
    here = loads._row(unit, "skirt", (100.0, 90.0, 110.0), 50.0, (20.0,) * 3, "slack and taut cycles, storm", "impact")
    rows.insert(COMPONENTS.index("skirt"), here)
    weaker = loads._row(unit, "skirt", (40.0,) * 3, 0.0, (120.0, 120.0, 140.0), "", "impact, in a weaker current")
    skirt = loads._table(unit, rows, {}, roles, {"skirt": [weaker]}).sel(component="skirt")
    assert float(skirt["governing_load"]) == pytest.approx(160.0)
    assert float(skirt["steady_load"] + skirt["wave_load"]) == pytest.approx(150.0)
    assert float(skirt["steady_high"] + skirt["wave_load"]) == pytest.approx(160.0)
    assert str(skirt["wave_source"].values) == "slack and taut cycles, storm"


@pytest.mark.parametrize(("value", "other"), [(60.6e3, 62.2e3), (62.2e3, 60.6e3)])
def test_every_model_of_waves_is_judged_at_its_own_end(value, other):
    """The energy model and the cycles of a held curtain: whichever leads, both loads are there to be judged."""
    row = xr.Dataset(
        {
            "steady_load": 10e3, "steady_high": 12e3, "wave_load": value - 10e3, "second_wave_load": other - 10e3,
            "governing_load": value, "governing": "steady and wave", "wave_source": "energy model, storm",
            "second_wave_source": "slack and taut cycles, storm", "factored_utilisation": value / 200e3,
            "load_bound": "",
            "capacity": 200e3,
        }
    )  # fmt: skip
    (found,) = headlines._other_waves(headlines._Load("SWL", "anchor line", row, None))
    assert found.value == pytest.approx(other) and found.used == pytest.approx(other / 200e3)
    assert found.words("wave_source") == "slack and taut cycles, storm" and not found.bound
    assert found.number("governing_high") == pytest.approx(other + 2e3)
    # where an impact leads, both are
    struck = row.assign(governing="steady and impact", impact_load=60e3, governing_load=70e3)
    both = list(headlines._other_waves(headlines._Load("SWL", "anchor line", struck, None)))
    assert [one.value for one in both] == pytest.approx([value, other])
    assert both[0].words("wave_source") == "energy model, storm"
    bound = headlines._Load("SWL", "anchor line", row.assign(load_bound="at most"), None)
    assert not list(headlines._other_waves(bound))


def test_a_skirt_that_is_held_hangs_straight_without_a_current(small):
    """Nothing can be straighter: the share of the sheet in a snap is known, and no less than with a bulge."""
    problem, _ = small
    held = replace(problem.curtain, toe="held", lower_stiffness=60e3)
    problem = replace(problem, curtain=held)
    unit = assemble(problem, "SWL", 0.0)
    still = replace(unit, surface_speed=0.0)
    answer = solve_impact(still, problem.settings.impact, 0.3)
    assert answer.skirt is None
    load = impact_load(still, answer, problem.settings)
    bulged = impact_load(unit, solve_impact(unit, problem.settings.impact, 0.3), problem.settings)
    tension = 5e3
    assert load.of_tension(tension).sheet > bulged.of_tension(tension).sheet > 0.0
    # a straight sheet that stretches: T^3 = EA p^2 d^2 / 24
    pressure = load.of_tension(tension).line_load / unit.curtain.skirt.length
    length, stiffness = unit.curtain.skirt.length, unit.curtain.skirt.stiffness
    by_hand = (stiffness * (pressure * length) ** 2 / 24.0) ** (1.0 / 3.0)
    assert load.of_tension(tension).sheet == pytest.approx(by_hand, rel=0.05)


def test_the_impact_keeps_its_end_where_waves_in_a_weaker_current_lead(small):
    problem, _ = small
    unit = assemble(problem, "SWL", 0.0)
    roles = (ModelRole(IMPACT, "governs", "", ""), ModelRole(CYCLES, "governs", "", ""))
    unknown, waves = (math.nan,) * 3, "slack and taut cycles, s"
    rows = [loads._row(unit, name, unknown, math.nan, unknown, "", "") for name in COMPONENTS if name != "skirt"]
    here = loads._row(
        unit, "skirt", (20.0, 15.0, 25.0), 50.0, (100.0, 80.0, 180.0), "slack and taut cycles, s", "impact"
    )
    rows.insert(COMPONENTS.index("skirt"), here)
    weaker = loads._row(unit, "skirt", (10.0,) * 3, 0.0, (120.0, 110.0, 130.0), "", f"{waves}, in a weaker current")
    table = loads._table(unit, rows, {}, roles, {"skirt": [weaker]})
    skirt = table.sel(component="skirt")
    assert float(skirt["governing_load"]) == pytest.approx(130.0) and str(skirt["governing"].values) == WEAKER
    assert float(skirt["case_load"]) == pytest.approx(120.0) and float(skirt["case_high"]) == pytest.approx(205.0)
    found = list(headlines._loads_of({"/SWL/loads": table}, "SWL"))
    assert {one.value for one in found} >= {130.0, 120.0}
    assert max(one.number("governing_high") for one in found) == pytest.approx(205.0)


def test_a_chord_that_is_given_bends_no_skirt_in_a_weaker_current(small):
    problem, _ = small
    skirt = replace(problem.curtain.skirt, stiffness=500e3)
    held = replace(problem.curtain, toe="held", lower_stiffness=60e3, skirt=skirt)
    unit = assemble(replace(problem, curtain=held), "SWL", 0.0)
    given = replace(problem.settings, impact=replace(problem.settings.impact, chord=0.97 * skirt.length))
    found = {}
    for settings in (problem.settings, given):
        load = impact_load(unit, solve_impact(unit, settings.impact, 0.3), settings)
        found[settings.impact.chord] = [load.skirt_at(part * unit.normal_speed).chord for part in (1.0, 0.5, 0.0)]
    own, with_chord = found.values()
    assert with_chord[0] == pytest.approx(0.97 * skirt.length)
    assert all(mine >= free - 1e-12 for mine, free in zip(with_chord[1:], own[1:], strict=True))
    assert with_chord[2] == pytest.approx(skirt.length, rel=1e-6)


def test_cycles_are_judged_at_the_upper_end_of_the_drag_too():
    names = ("both_cables_tension_maximum", "both_cables_tension_maximum_low", "both_cables_tension_maximum_high")
    sea = xr.Dataset({name: ("period", [7.0, 6.0]) for name in names})
    found = SeaCycles.of(sea.assign(strong_drag_tension=8.4))
    assert (found.top, found.judged) == (7.0, 8.4) and found.of_strong_drag == pytest.approx(1.2)
    assert SeaCycles.of(sea.assign(strong_drag_tension=6.0)).judged == 7.0


def test_a_largest_tension_that_there_is_not_is_said_so():
    fit = fit_snaps(np.random.default_rng(1).weibull(1.3, 30), 30.0, threshold=0.0, resamples=50)
    numbers, notices = _maximum("curtain, sea", fit, 0.1)
    assert all(math.isnan(number) for number in numbers.values())
    (notice,) = notices
    assert notice.code == "snap-no-maximum" and "curtain, sea" in notice.message and "0.1 peaks" in notice.message
    numbers, notices = _maximum("curtain, sea", fit, 30.0)
    assert notices == () and numbers["most_probable_maximum"] == fit.most_probable_maximum(30.0).value
