"""Cases for the tests of studies: a stand-in for the analysis that costs nothing and is known exactly."""

import math
import os
import signal
import time

import numpy as np
import xarray as xr

from moyai.core.errors import InputError
from moyai.core.results import Result
from moyai.structures.breakwater.variables import labelled

BASE = """\
moyai: 1
title: base
site: {water_depth: 10 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
waves:
  - {name: storm, kind: jonswap, significant_height: 1.0 m, peak_period: 5 s, peak_enhancement: 3.3, heading_deg: 0,
     duration: 600 s, seed: 1}
structure:
  kind: breakwater
  length: 20 m
  section: {shape: rectangle, beam: 10 m, height: 4.5 m}
  draught: 3 m
  centre_of_gravity_above_keel: 2.29 m
  roll_gyradius: 2.67 m
lines:
  - name: seaward
    count: 2
    fairlead: {x: -5 m, above_keel: 0 m}
    anchor: {x: -57.5 m}
    segments:
      - {catalogue: studless_chain_R3, diameter: 68 mm, length: 54.5 m}
  - name: shoreward
    fairlead: {x: 5 m, above_keel: 0 m}
    anchor: {x: 57.5 m}
    segments:
      - {catalogue: studless_chain_R3, diameter: 68 mm, length: 54.5 m}
analyses: [statics]
"""


def write_base(folder):
    path = folder / "base.yaml"
    path.write_text(BASE, encoding="utf-8")
    return path


def write_text(folder, variations, **further):
    write_base(folder)
    lines = ["moyai: 1", "study:", "  title: test", "  base: base.yaml"]
    lines += [f"  {key}: {value}" for key, value in further.items()]
    lines += ["  variations:", *("    " + line for line in variations.strip().splitlines())]
    path = folder / "study.yaml"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def write_study(folder, heights, seeds, **further):
    values = ", ".join(f"{0.2 + 0.05 * index:.2f} m" for index in range(heights))
    return write_text(
        folder,
        f"- grid: {{'waves[storm].significant_height': [{values}]}}\n"
        f"- seeds: {{path: 'waves[storm].seed', count: {seeds}}}",
        **further,
    )


def response(height, period, seed):
    return math.sin(height * 7.0 + seed) * period / 3.0


def fast_case(case, progress):
    sea = case.model.waves[0]
    value = response(sea.significant_height, sea.peak_period, sea.seed)
    names = [line.name for line in case.model.lines]
    data = {
        "response": ((), value, {"units": "m", "long_name": "response"}),
        "tension": (("line",), [value * (1 + number) for number in range(len(names))], {"units": "N"}),
        "count": (("line",), [float(line.count) for line in case.model.lines], {"units": "1"}),
        "series": (("time",), [value, 2 * value, 3 * value], {"units": "N", "long_name": "series"}),
    }
    dataset = xr.Dataset(data, coords={"line": names, "time": [0.0, 1.0, 2.0]})
    return Result(xr.DataTree.from_dict({"/": xr.Dataset(), "/SWL": dataset}))


def slow_case(case, progress):
    for step in range(4):
        time.sleep(0.05)
        progress("step", step, 4)
    return fast_case(case, progress)


def long_case(case, progress):
    for step in range(600):
        time.sleep(0.05)
        progress("step", step, 600)
    return fast_case(case, progress)


def failing_case(case, progress):
    if case.model.waves[0].seed == 2:
        raise InputError("the float sinks", path="structure.draught", remedy="make it lighter")
    if case.model.waves[0].seed == 3:
        raise ZeroDivisionError("a fault of the program")
    return fast_case(case, progress)


def deadly_case(case, progress):
    if case.model.waves[0].seed == 2:
        os.kill(os.getpid(), signal.SIGKILL)
    return fast_case(case, progress)


def once_deadly_case(case, progress):
    mark = os.environ["MOYAI_TEST_MARK"]
    if case.model.waves[0].seed == 2 and not os.path.exists(mark):
        with open(mark, "w", encoding="utf-8"):
            pass
        os.kill(os.getpid(), signal.SIGKILL)
    return fast_case(case, progress)


def linear_case(case, progress):
    """Tension that grows with the square of the height and falls with the length of the line."""
    sea = case.model.waves[0]
    length = case.model.lines[0].segments[0].length
    tension = 1000.0 * sea.significant_height**2 * sea.peak_period / 5.0 * (55.0 / length) ** 4
    names = [line.name for line in case.model.lines]
    data = {
        "tension": (("line",), [tension, 0.9 * tension][: len(names)], {"units": "N", "long_name": "tension"}),
        "cost": ((), length, {"units": "1", "long_name": "cost"}),
    }
    return Result(xr.DataTree.from_dict({"/": xr.Dataset(), "/SWL": xr.Dataset(data, coords={"line": names})}))


def gumbel_case(case, progress):
    """Maxima drawn from a known Gumbel distribution: mode 100 kN per metre of height, scale a tenth of it."""
    sea = case.model.waves[0]
    uniform = np.random.default_rng([sea.seed, round(1000 * sea.significant_height)]).random()
    mode = 1e5 * sea.significant_height
    largest = mode - 0.1 * mode * math.log(-math.log(uniform))
    names = [line.name for line in case.model.lines]
    count = len(names)
    tensions = {
        "line_tension_maximum": (("line",), [largest] * count),
        "line_tension_mean": (("line",), [0.3 * largest] * count),
        "anchor_vertical_tension_maximum": (("line",), [0.1 * largest] * count),
        "worst": ((), largest, {"units": "N", "long_name": "worst tension"}),
    }
    groups = {
        "/": xr.Dataset(),
        "/SWL/time/storm": labelled(xr.Dataset(tensions, coords={"line": names})),
        "/SWL/statics": labelled(xr.Dataset({"breaking_load": ("line", [1e6] * count)}, coords={"line": names})),
    }
    return Result(xr.DataTree.from_dict(groups))


def sine_case(case, progress):
    """Tension that swings with the height of the sea: its rainflow count is known."""
    sea = case.model.waves[0]
    time_axis = np.arange(0.0, 1000.25, 0.05)
    names = [line.name for line in case.model.lines]
    series = 2e5 + 5e4 * sea.significant_height * np.sin(2 * math.pi * time_axis / 5.0)
    data = {"tension": (("time", "line"), np.stack([series, 2 * series], axis=1))}
    groups = {
        "/": xr.Dataset(),
        "/SWL/time/storm/run": labelled(xr.Dataset(data, coords={"time": time_axis, "line": names})),
        "/SWL/statics": labelled(xr.Dataset({"breaking_load": ("line", [1e6, 1e6])}, coords={"line": names})),
    }
    return Result(xr.DataTree.from_dict(groups))


def peaky_case(case, progress):
    """Tension with peaks of known laws: Weibull ones of exponent 1.6, and in higher seas snaps that follow on slack."""
    sea = case.model.waves[0]
    generator = np.random.default_rng([7, sea.seed])
    count = 150
    peaks = 1e5 + 2e4 * generator.weibull(1.6, count)
    troughs = np.full(count, 8e4)
    if sea.significant_height > 0.9:
        snaps = generator.random(count) < 0.25
        troughs[snaps] = 0.0
        peaks[snaps] = 1.5e5 + 4e4 * generator.exponential(1.0, snaps.sum())
    series = np.empty(4 * count)
    # From the trough through the mean of the calm line to the peak
    series[0::4], series[1::4], series[2::4], series[3::4] = troughs, 9e4, peaks, 9e4
    names = [line.name for line in case.model.lines]
    data = {"tension": (("time", "line"), np.stack([series] * len(names), axis=1), {"units": "N"})}
    time_axis = np.arange(series.size) * 1.25
    groups = {"/": xr.Dataset(), "/SWL/time/storm": xr.Dataset(data, coords={"time": time_axis, "line": names})}
    return Result(xr.DataTree.from_dict(groups))


def any_case(case, progress):
    """Nothing but a number, whatever the sea."""
    progress("step", 1, 1)
    return Result(xr.DataTree.from_dict({"/": xr.Dataset(), "/SWL": xr.Dataset({"x": ((), 1.0, {"units": "1"})})}))


def nested_case(case, progress):
    """Series in a group below maxima of the same lines, whose labels they inherit."""
    import dataclasses

    result = peaky_case(case, progress)
    series = result.tree["/SWL/time/storm"].to_dataset(inherit=False)
    names = series["line"].values
    maxima = xr.Dataset({"worst": (("line",), [1.0, 2.0], {"units": "N"})}, coords={"line": names})
    groups = {"/": xr.Dataset(), "/SWL/time/storm": maxima, "/SWL/time/storm/realisation": series}
    return dataclasses.replace(result, tree=xr.DataTree.from_dict(groups))
