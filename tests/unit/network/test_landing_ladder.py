"""The event of a peak that lands, cut down to links, gives what whole runs on such meshes give."""

from __future__ import annotations

from pathlib import Path

import pytest

import moyai

CASE = """
moyai: 1
title: Buoy on a slack chain
site: {water_depth: 14 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
waves: {kind: regular, name: swell, height: 1.4 m, period: 5 s, heading_deg: 0}
current: {speed: 0.7 m/s, heading_deg: 0}
structure:
  kind: network
  bed: {stiffness: 3e5 Pa/m, damping: 3e4 Pa s/m, friction: 0.5}
  line_types:
    chain: {catalogue: studless_chain_U3, diameter: 26 mm, damping_ratio: 0.1}
  points:
    anchor: {kind: fixed, position: [0, 0, bed]}
    buoy: {kind: cylinder, position: [20 m, 0, 0], diameter: 1.8 m, height: 1.4 m, mass: 900 kg, drag_coefficient: 0.8,
           added_mass_coefficient: 0.6}
  lines:
    mooring: {start: anchor, end: buoy, type: chain, length: 30 m, segments: SEGMENTS}
analyses: [statics, dynamic]
settings: {start: rest_in_current, duration: 45 s, skip: 20 s, mesh_check: 'CHECK'}
"""


def _run(folder: Path, segments: int, check: str) -> moyai.Result:
    path = folder / f"{segments}.yaml"
    path.write_text(CASE.replace("SEGMENTS", str(segments)).replace("CHECK", check), encoding="utf-8")
    return moyai.run(path)


@pytest.mark.slow
def test_the_event_on_short_bars_gives_the_peak_of_whole_runs_on_them(tmp_path: Path) -> None:
    """15 segments give 12 % more than 60, and the status says so with the peak of 60 segments."""
    coarse, fine = _run(tmp_path, 15, "auto"), _run(tmp_path, 60, "off")
    own, other = (run.tree["SWL/dynamic"].to_dataset() for run in (coarse, fine))
    peak, truth = float(own["line_tension_maximum"][0, 0]), float(other["line_tension_maximum"][0, 0])
    assert peak > 1.08 * truth
    assert float(own["finest"][0]) == pytest.approx(truth, rel=0.02)
    assert coarse.status == "not_converged" and "60 segments give" in coarse.message
    band = next(number.band for number in coarse.headlines if number.name == "line_tension")
    assert band is not None and band.low < truth < band.high
