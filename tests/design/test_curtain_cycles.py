"""Slack and taut cycles of a held toe: a further sea, a further analysis and a higher wave take no load away."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

import moyai
from moyai.core.headline import unfavourable
from moyai.structures.curtain.seas.cycles_of_sea import SeaCycles

CASE = """moyai: 1
title: Held toe with a heavy chain
site: {{water_depth: 7 m, density: 1025 kg/m3, gravity: 9.81 m/s2}}
current: {{speed: 0.15 m/s, heading_deg: 0}}
waves:
{waves}
structure:
  kind: curtain
  span: 15 m
  length: 17 m
  skirt: {{length: 4 m, mass_per_area: 0.8 kg/m2, sheet_density: 1380 kg/m3, stiffness: 900 kN/m, strength: 160 kN/m}}
  toe: {{kind: held, chain_mass: 20 kg/m}}
  cables: {{upper: {{catalogue: polyester_8_strand, diameter: 32 mm}},
           lower: {{catalogue: polyester_8_strand, diameter: 32 mm}}}}
  floats: {{buoyancy: 980 N/m, weight: 80 N/m}}
  anchors: {{line_length: 30 m, axial_stiffness: 3 MN, breaking_load: 250 kN, holding_force: 80 kN}}
  drag: {{law: constant, coefficient: 1.5, range: [0.8, 1.3]}}
  passing_fraction: 0.5
analyses: [{analyses}]
settings: {{dynamic: {{support_mass: 500 kg}}}}
"""
STORM = "  - {name: storm, kind: jonswap, significant_height: 0.5 m, peak_period: 3.5 s, peak_enhancement: 3.3, " \
        "heading_deg: 0, duration: 5 min, seed: 1}"  # fmt: skip


def daily(height: float) -> str:
    return f"  - {{name: daily, kind: regular, height: {height} m, periods: [4 s], heading_deg: 0}}"


@pytest.fixture(scope="module")
def judged(tmp_path_factory: pytest.TempPathFactory):
    """Return what gives the end at which the load on the anchors is judged in some seas and analyses."""
    folder, known = tmp_path_factory.mktemp("cycles"), {}

    def end(*waves: str, analyses: str = "statics, waves") -> float:
        if (waves, analyses) not in known:
            path: Path = folder / f"case{len(known)}.yaml"
            text = CASE.format(waves="\n".join(waves), analyses=analyses)
            # contacts are located between the steps of the flow, whatever their length
            text = text.replace("500 kg}", "500 kg}, waves: {time_step: 0.05 s}")
            path.write_text(text, encoding="utf-8")
            result = moyai.run(moyai.load_case(path))
            known[waves, analyses] = max(unfavourable(one) for one in result.headlines if one.name == "anchor_tension")
        return known[waves, analyses]

    return end


@pytest.mark.slow
def test_a_daily_wave_next_to_the_storm_takes_nothing_away(judged):
    assert judged(STORM, daily(0.4)) >= judged(STORM) * (1.0 - 1e-9)
    assert judged(STORM, daily(0.4)) >= judged(daily(0.4)) * (1.0 - 1e-9)


@pytest.mark.slow
def test_the_impact_next_to_the_storm_takes_nothing_away(judged):
    assert judged(STORM, analyses="statics, impact, waves") >= judged(STORM) * (1.0 - 1e-9)


@pytest.mark.slow
def test_a_higher_wave_is_no_gentler_than_the_lower_ones_of_its_train(judged):
    """At 0.45 m and 4 s snaps lock into 6.9 kN, at 0.40 m nothing repeats: 24 kN of both cables."""
    low, high = judged(daily(0.4)), judged(daily(0.45))
    # means of chaotic maxima of other heights: they scatter, six blocks of a hundred periods
    assert high > 0.85 * low


@pytest.mark.slow
def test_the_sheet_in_the_storm_is_judged_in_weaker_currents_too(tmp_path: Path) -> None:
    """A skirt that hangs straighter bears more of the same snap; the half of a current comes with all of it."""
    found = {}
    for speed in (0.3, 0.15):
        text = CASE.format(waves=STORM, analyses="statics, waves").replace("speed: 0.15", f"speed: {speed}")
        (tmp_path / "case.yaml").write_text(text, encoding="utf-8")
        result = moyai.run(moyai.load_case(tmp_path / "case.yaml"))
        row = result.tree["SWL/loads"].to_dataset(inherit=False).sel(component="skirt")
        sheet = [one for one in result.headlines if one.name == "fabric_utilisation"]
        ends = max(one.value for one in sheet), max(unfavourable(one) for one in sheet)
        found[speed] = (*ends, float(row["steady_load"] + row["wave_load"]) / 160e3)
    # in the full current the storm itself takes less of the sheet than in half of it
    assert found[0.3][2] < 0.8 * found[0.15][2]
    # 2 % for the steps of the currents
    assert found[0.3][0] > 0.98 * max(found[0.15][0], found[0.15][2]) and found[0.3][1] > 0.98 * found[0.15][1]


def test_cycles_are_judged_at_the_end_of_their_mean():
    sea = xr.Dataset(
        {
            "both_cables_tension_maximum": 10.0,
            "both_cables_tension_maximum_low": 8.0,
            "both_cables_tension_maximum_high": 13.0,
        }
    )
    found = SeaCycles.of(sea.assign(realisation_tension=("seed", [8.0, 9.0, 13.0])))
    # Johnson's interval of three skewed values, one-sided 95 %: 4.899 standard errors
    assert found.judged == pytest.approx(10.0 + 4.8994 * np.std([8.0, 9.0, 13.0], ddof=1) / np.sqrt(3.0), rel=1e-4)
    names = ("both_cables_tension_maximum", "both_cables_tension_maximum_low", "both_cables_tension_maximum_high")
    train = xr.Dataset({name: ("period", [7.0, 6.0]) for name in names})
    assert SeaCycles.of(train).judged == 7.0
    lower = {"lower_wave_tension": [24.0, 3.0], "lower_wave_height": [0.4, 0.2], "judged_tension": [26.0, 6.0]}
    found = SeaCycles.of(train.assign({name: ("period", values) for name, values in lower.items()}))
    assert (found.top, found.judged, found.low) == (24.0, 26.0, 7.0) and "0.4 m" in found.words
