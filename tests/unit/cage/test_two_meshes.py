"""A flexible cage in regular waves on two meshes at once: the same on one core, and stopped at any moment."""

from pathlib import Path

import pytest
import xarray as xr

import moyai

CASE = """
moyai: 1
title: Small cage
site: {water_depth: 20 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
current: {speed: 0.3 m/s, heading_deg: 0}
waves: {name: swell, kind: regular, height: 1 m, period: 5 s, heading_deg: 0}
structure:
  kind: cage
  model: flexible
  kinematic_viscosity: 1.3e-6 m2/s
  shape: circular
  size: 12 m
  collar:
    pipe: {diameter: 250 mm, wall_thickness: 14.8 mm, density: 955 kg/m3, youngs_modulus: 0.9 GPa, extra_mass: 5 kg/m}
  net:
    twine_diameter: 2 mm
    mesh_pitch: 25 mm
    density: 1140 kg/m3
    youngs_modulus: 1 GPa
    wall_depth: 6 m
    bottom: flat
    law: loland
    wake: loland
  sinkers: {count: 8, mass: 60 kg, density: 7850 kg/m3, drag_area: 0.05 m2}
  mooring:
    kind: grid
    bay: 20 m
    frame_depth: 3 m
    frame_rope: {catalogue: polyester_8_strand, diameter: 40 mm}
    buoys: {diameter: 1 m, mass: 60 kg}
    bridle: {catalogue: nylon_8_strand, diameter: 40 mm}
    bridles_per_corner: 2
    anchor_line:
      - {catalogue: polyester_8_strand, diameter: 48 mm, length: 60 m}
    anchor_distance: 55 m
  mesh: {around: 12, down: 2, bottom: 2, rope_length: 10 m}
analyses: [statics, time]
settings:
  flexible: {periods: 2, most_periods: 3, ramp_periods: 2}
"""


@pytest.mark.slow
def test_one_core_gives_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    found = []
    for cores in ("2", "1"):
        monkeypatch.setenv("MOYAI_THREADS", cores)
        found.append(moyai.run(moyai.load_case(CASE)).tree)
    for place in ("/SWL/time/swell/wave 1", "/SWL/sensitivity/swell"):
        one, other = (tree[place].to_dataset() for tree in found)
        xr.testing.assert_identical(one, other)
    changed = found[0]["/SWL/sensitivity/swell"].to_dataset()["value"]
    assert (changed[0] != changed[1]).any()


@pytest.mark.parametrize(
    ("stage", "share", "cores"), [("network", 0.05, "2"), ("network", 0.7, "1"), ("coarser mesh", 0.5, "2")]
)
def test_a_run_that_is_stopped_is_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, stage: str, share: float, cores: str
) -> None:
    """While the waves grow, later, and in the coarser mesh: what there is has a first page and a report."""
    monkeypatch.setenv("MOYAI_THREADS", cores)

    def stop(what: str, done: float, total: float) -> None:
        if what == stage and done > share * total:
            raise KeyboardInterrupt

    result = moyai.run(moyai.load_case(CASE), progress=stop)
    assert result.status == "interrupted"
    series = result.tree["/SWL/time/swell/wave 1"].to_dataset()
    assert series.sizes["time"] > 2 and "/SWL/sensitivity/swell" not in result.tree.groups
    assert {"volume_left"} <= {item.name for item in result.headlines}
    assert all(file.exists() for file in moyai.write_report(result, tmp_path / "report.html"))
