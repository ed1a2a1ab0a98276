"""Networks as case files: problems of an established program and exact statics, from the YAML text to the figure."""

from __future__ import annotations

import math
import tempfile
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.validation import ValidationCase

if TYPE_CHECKING:
    from moyai.core.results import Result

_SITE = "moyai: 1\ntitle: Validation\nsite: {water_depth: 60 m, density: 1025 kg/m3, gravity: 9.81 m/s2}\n"

_ROPE = """
      rope: {diameter: 40 mm, mass: 9 kg/m, axial_stiffness: 100 MN, viscosity: 1e4 N s, drag_normal: 1.2,
             drag_tangential: 0.0628318530718, added_mass_normal: 1.0}"""

SNAP = (
    _SITE
    + f"""
structure:
    kind: network
    line_types:{_ROPE}
    motions:
      surge: {{kind: harmonic, amplitude: [1 m, 0, 0], period: 4 s, ramp: 4 s}}
    points:
      anchor: {{kind: fixed, position: [0, 0, -12 m]}}
      fairlead: {{kind: driven, position: [43.9425 m, 0, -2 m], motion: surge}}
    lines:
      rope: {{start: anchor, end: fairlead, type: rope, length: 46 m, segments: 20}}
analyses: [dynamic]
settings: {{duration: 20 s, output_step: 10 ms, skip: 8 s}}
"""
)

ARRESTED_MASS = (
    _SITE
    + f"""
structure:
    kind: network
    line_types:{_ROPE}
      soft: {{diameter: 1 mm, mass: 0.001 kg/m, axial_stiffness: 400 kN, viscosity: 2 kN s, drag_normal: 0,
              drag_tangential: 0, added_mass_normal: 0}}
    motions:
      surge: {{kind: harmonic, amplitude: [3 m, 0, 0], period: 6 s, ramp: 6 s}}
    points:
      anchor: {{kind: fixed, position: [0, 0, -12 m]}}
      mass: {{kind: free, position: [45.9 m, 0, -12 m], mass: 5 t, volume: {5000.0 / 1025.0!r} m3, drag_area: 5 m2}}
      pull: {{kind: driven, position: [66.5 m, 0, -12 m], motion: surge}}
    lines:
      rope: {{start: anchor, end: mass, type: rope, length: 46 m, segments: 20}}
      soft: {{start: mass, end: pull, type: soft, length: 20 m, segments: 1, shape: straight}}
analyses: [dynamic]
settings: {{duration: 30 s, output_step: 10 ms, start: as_built, skip: 12 s}}
"""
)


def net_case(count: int, duration: float) -> tuple[str, str]:
    """Return the case of a towed net of ``count`` x ``count`` knots that heaves, and the table of its motion."""
    time = np.arange(0.0, duration + 0.051, 0.05)
    grown = np.minimum(time / 3.0, 1.0)
    towed = np.where(time < 3.0, time**2 / 6.0, time - 1.5)
    heave = 0.5 * grown * np.sin(2.0 * math.pi * time / 6.0)
    rows = "\n".join(f"{t:.3f}, {-x:.9f}, 0, {z:.9f}" for t, x, z in zip(time, towed, heave, strict=True))
    size = count - 1
    text = (
        _SITE
        + f"""
structure:
    kind: network
    line_types:
      twine: {{diameter: 20 mm, mass: 0.36 kg/m, axial_stiffness: 200 kN, viscosity: 100 N s, drag_normal: 1.2,
               drag_tangential: {0.01 * math.pi!r}, added_mass_normal: 1.0}}
    motions:
      tow: {{kind: table, file: tow.csv}}
    nets:
      net:
        corners: [[0, 0, -1 m], [0, {size} m, -1 m], [0, {size} m, {-1 - size} m], [0, 0, {-1 - size} m]]
        rows: {count}
        columns: {count}
        type: twine
        first_row: driven
        motion: tow
analyses: [dynamic]
settings: {{duration: {duration:g} s, output_step: 20 ms, start: as_built}}
"""
    )
    return text, "time, x, y, z\n" + rows + "\n"


def run_text(text: str, **files: str) -> Result:
    """Run the text of a case file with the files that it names (``tow`` for tow.csv)."""
    from moyai.case.builder import build
    from moyai.case.reader import load_case
    from moyai.structures.network.run import run

    with tempfile.TemporaryDirectory(prefix="moyai-validation-") as name:
        folder = Path(name)
        for key, content in files.items():
            (folder / f"{key}.csv").write_text(content, encoding="utf-8")
        (folder / "case.yaml").write_text(text, encoding="utf-8")
        return run(build(load_case(folder / "case.yaml")))


@cache
def _snap_peak() -> float:
    summary: Any = run_text(SNAP).tree["SWL/dynamic"]
    return float(summary["line_tension_maximum"].values[0, 0])


@cache
def _mass_peaks() -> tuple[float, ...]:
    series = run_text(ARRESTED_MASS).tree["SWL/time/still water"].to_dataset()
    time, record = series["time"].values, series["end_tension"].sel(line="rope").values
    return tuple(float(record[(time > begin) & (time <= begin + 6.0)].max()) for begin in (12.0, 18.0, 24.0))


def net_peak(count: int) -> float:
    """Return the highest tension of the first twine of the first column from 6 to 12 s [N]."""
    text, table = net_case(count, 12.0)
    tree = run_text(text, tow=table).tree
    net, frames = tree["SWL/network"].to_dataset(), tree["SWL/time/still water/frames"].to_dataset()
    place = net["node_position"].values
    start, end = (
        int(np.argmin(np.linalg.norm(place - corner, axis=1))) for corner in ((0.0, 0.0, -1.0), (0.0, 0.0, -2.0))
    )
    bar = int(np.flatnonzero((net["bar_start"].values == start) & (net["bar_end"].values == end))[0])
    late = frames["frame"].values > 6.0
    return float(frames["tension"].values[late, bar].max())


_SOURCE = "MoorDyn-C 2.7.2, RK2 and RK4, converged over mesh and step; an independent prototype agrees to 0.05 %"

CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        "network case: rope that snaps taut", _SOURCE, _snap_peak, 102.36e3, 0.005,
        note="20 bars; a half per cent is what was asked of the peak",
    ),
    ValidationCase(
        "network case: mass arrested by a rope, first cycle", _SOURCE, lambda: _mass_peaks()[0], 76.26e3, 0.005,
        note="20 bars; at the mass, as the source",
    ),
    ValidationCase(
        "network case: mass arrested by a rope, third cycle", _SOURCE, lambda: _mass_peaks()[2], 76.35e3, 0.005,
        note="20 bars",
    ),
    ValidationCase(
        "network case: towed net of 10 x 10 knots", _SOURCE, lambda: net_peak(10), 71.73, 0.005, note="one bar a mesh",
    ),
)  # fmt: skip
