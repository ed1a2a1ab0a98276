"""Ten units in a row, hinged, on forty chains: coefficients, a sea state in frequency, and ten minutes in time.

    OMP_NUM_THREADS=2 python benchmarks/bench_units.py --store folder    # all forty frequencies, some ten minutes
    OMP_NUM_THREADS=1 python benchmarks/bench_units.py --store folder    # again, with the coefficients at hand
    python benchmarks/bench_units.py --frequencies 8                     # coefficients of forty follow from eight

Prints JSON lines: what was measured, its limit, and the ratio of the two. Coefficients are timed by the clock, on all
cores that OMP_NUM_THREADS leaves them; the rest by the processor, where two threads count twice.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from moyai.case.builder import build
from moyai.case.reader import case_of
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.core.store import DatasetStore
from moyai.sea.spectra import jonswap
from moyai.structures.units.assembly import assemble, steady_load
from moyai.structures.units.hydrodynamics import solve_row
from moyai.structures.units.run import row_panels
from moyai.structures.units.seas import irregular_answer
from moyai.structures.units.time.analysis import _carried, water_in_time
from moyai.structures.units.time.lines import AROUND, LEAD, events_of, moving_line, rerun
from moyai.structures.units.time.seas import irregular_run

#: What the speeds are held against: coefficients [s], a sea state [s], and real time over time
COEFFICIENTS, SEA_STATE, REAL_TIME = 600.0, 0.05, 5.0
WHOLE = 40
CHANGES = (
    ("count: 3,", "count: 10,"), ("panel_size: 2 m", "panel_size: 2.4 m"), ("duration: 3 h", "duration: 10 min"),
    ("    heading_deg: 0\n", "    heading_deg: 30\n"),
)  # fmt: skip


def case(frequencies: int, *changes: tuple[str, str]) -> Any:
    """Return the template of units as a row of ten."""
    text = template("units")
    band = ("{from: 0.7, to: 2.0, count: 8}", f"{{from: 0.6, to: 2.2, count: {frequencies}}}")
    for old, new in (*CHANGES, band, *changes):
        assert old in text, old
        text = text.replace(old, new, 1)
    return build(case_of(parse_yaml(text, "case.yaml"), Path("case.yaml")))


def reported(name: str, value: float, limit: float, **more: Any) -> None:
    """Print a figure with its limit."""
    shown = {"what": name, "value": float(f"{value:.4g}"), "limit": limit, "ratio": float(f"{value / limit:.3g}")}
    print(json.dumps({**shown, **more}), flush=True)


def main() -> None:
    """Measure all."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--frequencies", type=int, default=WHOLE)
    parser.add_argument("--store", type=Path)
    given = parser.parse_args()
    folder = given.store or Path(tempfile.mkdtemp())
    at_hand = folder.is_dir() and any(folder.iterdir())
    store = DatasetStore(folder)
    problem = case(given.frequencies)
    row, environment, settings = problem.row, problem.environment, problem.settings
    sea = next(item for item in environment.sea_states if item.name == "storm")
    omega, headings = np.array(settings.frequencies), np.array([sea.heading])
    at = assemble(row, environment, *environment.water_levels[0])
    panels = row_panels(at, settings, float(omega.max()))
    begin = time.perf_counter()
    hydro = solve_row(panels, at.water, at.centres, omega, headings, store=store)
    took = (time.perf_counter() - begin) * WHOLE / len(omega)
    if not at_hand:
        reported("coefficients of 40 frequencies [s]", took, COEFFICIENTS, panels=panels.mesh.count, solved=len(omega))
    wind, current = steady_load(at, environment)
    steady = wind + current
    each, answer = [], None
    for height in np.linspace(0.6, 1.4, 2 + 2 * at.free.shape[1]):
        state = replace(sea, spectrum=jonswap(height, 6.0, 3.3))
        before = time.process_time()
        answer = irregular_answer(at, hydro, state, steady, settings)
        each.append(time.process_time() - before)
    assert answer is not None and answer.converged
    reported("first sea state [s]", each[0], SEA_STATE)
    reported("sea state, median of the last ten [s]", float(np.median(each[-10:])), SEA_STATE, states=len(each))
    water = water_in_time(at, hydro, steady, settings, store=store, progress=lambda *_: None)[0]
    before = time.process_time()
    run = irregular_run(water, sea, 0, answer)
    spent = time.process_time() - before
    carried = next(_carried(part) for part in run.parts)
    simulated = float(run.run.time[-1])
    moving = [moving_line(at, line) for line in range(len(at.line_names))]
    before = time.process_time()
    for line, one in enumerate(moving):
        rerun(at, one, carried, events_of(carried, line)[0][0])
    lines = time.process_time() - before
    reported("real time over time, lines at rest at every instant", simulated / spent, REAL_TIME, at_least=True)
    window = (LEAD + AROUND) * carried.period
    reported("real time over time, with 40 lines in motion", 1.0 / (spent / simulated + lines / window), REAL_TIME,
         at_least=True)  # fmt: skip


if __name__ == "__main__":
    main()
