"""Results of two small cases, each run once for all tests; what a test needs otherwise, it changes in them."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import xarray as xr
from kept_runs import kept_run

from moyai.core.results import Result

PONTOON = """# Pontoon, first estimate (浮防波堤)
moyai: 1
title: Pontoon at the harbour mouth (港口の浮防波堤)
site: {water_depth: 10 m, water_levels: {HWL: 1.2 m, LWL: 0 m}, density: 1025 kg/m3, gravity: 9.81 m/s2}
waves:
  - {name: design waves, kind: regular, height: 0.8 m, periods: [3.6 s, 4.6 s, 6.2 s], heading_deg: 0}
  - {name: storm, kind: jonswap, significant_height: 0.5 m, peak_period: 5 s, peak_enhancement: 3.3, heading_deg: 0,
     duration: 1 min, seed: 1}
structure:
  kind: breakwater
  length: 21 m
  section: {shape: rectangle, beam: 10 m, height: 4.5 m}
  draught: 3 m
  centre_of_gravity_above_keel: 2.29 m
  roll_gyradius: 2.67 m
  damping: {fraction_of_critical: 0.15, modes: [sway, heave, roll]}
lines:
  - {name: offshore, count: 2, fairlead: {x: -5 m, above_keel: 0 m}, anchor: {x: -107.8 m},
     segments: [{catalogue: studless_chain_R3, diameter: 68 mm, length: 105 m}]}
  - {name: shore, count: 2, fairlead: {x: 5 m, above_keel: 0 m}, anchor: {x: 107.8 m},
     segments: [{catalogue: studless_chain_R3, diameter: 68 mm, length: 105 m}]}
analyses: [statics, mooring, frequency, time]
settings:
  frequencies: {from: 0.6, to: 3, count: 12}
  time: {realisations: 1, lines: {mode: quasi_static}}
  sensitivity: {damping_fractions: [0, 0.15]}
measured: {file: points.csv}
"""
POINTS = "period [s],transmission_coefficient,roll [deg]\n3.6,0.2,6\n4.7,0.42,11\n5.5,0.6,9\n"
CURTAIN = """# Curtain at the outfall (汚濁防止膜)
moyai: 1
title: Curtain at the outfall
site: {water_depth: 8 m, water_levels: {HWL: 1.2 m, LWL: 0 m}, density: 1025 kg/m3, gravity: 9.81 m/s2}
current: {speed: 0.25 m/s, heading_deg: 10}
waves:
  - {name: swell, kind: regular, height: 0.5 m, period: 4 s, heading_deg: 0}
  - {name: storm, kind: jonswap, significant_height: 0.7 m, significant_period: 4 s, peak_enhancement: 3.3,
     heading_deg: 20, duration: 90 s, seed: 1}
structure:
  kind: curtain
  span: 20 m
  length: 22 m
  skirt: {length: 5 m, submerged_weight: 4 N/m2, stiffness: 900 kN/m, strength: 160 kN/m}
  toe: {kind: free, weight: 180 N/m}
  cables:
    upper: {axial_stiffness: 400 kN, breaking_load: 180 kN}
    lower: {axial_stiffness: 400 kN, breaking_load: 120 kN}
  floats: {buoyancy: 980 N/m, weight: 100 N/m}
  joints: {distance: 10 m}
  anchors: {line_length: 25 m, axial_stiffness: 10 MN, breaking_load: 270 kN, holding_force: 60 kN}
  drag: {law: constant, coefficient: 1.3, range: [0.8, 1.3]}
  curtain_class: C
analyses: [statics, impact, waves, anchor_loads, limits]
settings:
  impact: {start: slack_phase, chord: 4.8 m}
  waves: {settled_periods: 4, analysed_periods: 10, realisations: 1}
  anchor_loads: {energy_factor: 0.2, float_mass: 518 kg}
  limits: {speeds: [0.25 m/s, 0.5 m/s], highest_speed: 1 m/s, highest_height: 2 m}
  safety_factors: {cable: 3, sheet: 4, joint: 3, anchor_line: 3, anchor: 1.5}
"""


@cache
def pontoon() -> Result:
    """Return a floating breakwater at two levels in regular waves and a storm, in frequency and in time."""
    with TemporaryDirectory() as folder:
        file = Path(folder, "pontoon.yaml")
        file.write_text(PONTOON, encoding="utf-8")
        file.with_name("points.csv").write_text(POINTS, encoding="utf-8")
        return kept_run(file)


@cache
def curtain() -> Result:
    """Return a silt curtain with a free toe at two levels, with all its analyses but the whole span through time."""
    return kept_run(CURTAIN)


def groups_of(result: Result) -> dict[str, xr.Dataset]:
    """Return the groups of a result by their path."""
    return {node.path: node.to_dataset(inherit=False) for node in result.tree.subtree}


def with_groups(result: Result, groups: dict[str, xr.Dataset]) -> Result:
    """Return a result with other groups."""
    return replace(result, tree=xr.DataTree.from_dict(groups))


def without(result: Result, *parts: str) -> Result:
    """Return a result without the groups in whose path one of the parts stands."""
    kept = {path: group for path, group in groups_of(result).items() if not any(part in path for part in parts)}
    return with_groups(result, kept)


def entitled(result: Result, title: str, level: str) -> Result:
    """Return the upper water level of a result alone, under another name, and with another title."""
    groups = groups_of(without(result, "/LWL"))
    groups["/"] = groups["/"].assign_attrs(title=title)
    named = {path.replace("/HWL", f"/{level}", 1): group for path, group in groups.items()}
    return replace(with_groups(result, named), provenance={**result.provenance, "title": title})
