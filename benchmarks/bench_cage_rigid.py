"""Rigid cage: a thousand wave periods, against fixed steps of 0.5 ms in the same run; an irregular sea.

    python benchmarks/bench_cage_rigid.py

One thread, warm, seconds of the processor; prints JSON lines, each with its time, the ratio to the fixed steps and the
difference from them.
"""

from __future__ import annotations

import json
import time
from dataclasses import replace

import numpy as np

from moyai.sea.environment import Environment
from moyai.sea.spectra import jonswap
from moyai.sea.states import IrregularSea
from moyai.structures.cage.rigid.matsubara import VISCOSITY, WATER, model_cage, taut_lines
from moyai.structures.cage.rigid.model import RigidCageProblem, RigidCageSettings
from moyai.structures.cage.rigid.pack import pack
from moyai.structures.cage.rigid.realisations import further_realisations
from moyai.structures.cage.rigid.runs import run_wave
from moyai.structures.cage.rigid.statics import equilibrium_with_lines
from moyai.structures.cage.rigid.time import march, march_fixed
from moyai.structures.cage.rigid.waves import wave_of, waves_of

PERIOD, HEIGHT, STEP = 1.1, 0.03, 5e-4


def numbers(state: np.ndarray, peak: np.ndarray) -> np.ndarray:
    """Return ranges of sway and heave over H, rotation [deg], largest peak [N] of the last half."""
    half = len(state) // 2
    ranges = np.ptp(state[half:, :3], axis=0)
    return np.array([ranges[0] / HEIGHT, ranges[1] / HEIGHT, np.degrees(0.5 * ranges[2]), peak[half:].max()])


def regular(stiffness: float, tolerance: float) -> dict[str, object]:
    """Time 1000 periods adaptively and 50 with fixed steps; compare their numbers over the first 50."""
    cage = model_cage()
    lines = taut_lines(cage, stiffness=stiffness)
    start = np.concatenate([equilibrium_with_lines(cage, lines, WATER, VISCOSITY).place, np.zeros(3)])
    wave = wave_of("linear", HEIGHT, PERIOD, 0.0, WATER, 0.0, 1000)
    packed = pack(cage, lines, WATER, VISCOSITY, waves=wave.components, ramp=5.0 * PERIOD)
    options = {"spacing": PERIOD / 50.0, "size": 0.2, "period": PERIOD, "tolerance": tolerance}
    march(packed, start, duration=2.0 * PERIOD, **options)
    begin = time.process_time()
    long = march(packed, start, duration=1000.0 * PERIOD, **options)
    seconds = time.process_time() - begin
    march_fixed(packed, start, duration=PERIOD, step=STEP, every=44)
    begin = time.process_time()
    fixed = march_fixed(packed, start, duration=50.0 * PERIOD, step=STEP, every=44)
    reference = 20.0 * (time.process_time() - begin)
    short = march(packed, start, duration=50.0 * PERIOD, **options)
    mine, theirs = numbers(short.state, short.tension_peak), numbers(fixed.state, fixed.tension_peak)
    return {
        "case": f"crossed lines, {stiffness:g} N/m, tolerance {tolerance:g}",
        "seconds_for_1000_periods": round(seconds, 2),
        "steps_per_period": round(long.steps / 1000.0, 1),
        "events_per_period": round(long.events / 1000.0, 1),
        "fixed_0.5ms_seconds_for_1000_periods": round(reference, 1),
        "speed_ratio": round(reference / seconds, 1),
        "largest_relative_difference": float(f"{np.abs(mine / theirs - 1.0).max():.2e}"),
        "last_half_of_1000_periods": [float(f"{value:.5g}") for value in numbers(long.state, long.tension_peak)],
        "same_from_50_periods": [float(f"{value:.5g}") for value in mine],
    }


def irregular(periods: int) -> dict[str, object]:
    """Time an irregular sea of 200 waves summed into a series; difference from a sum at every part over 5 periods."""
    cage = model_cage()
    lines = taut_lines(cage)
    sea = IrregularSea("sea", jonswap(0.02, 1.2, 3.3), duration=periods * 1.2, seed=1)
    problem = RigidCageProblem("", cage, (), VISCOSITY, Environment(WATER), settings=RigidCageSettings())
    (wave,) = waves_of(problem, sea, WATER)
    packed = pack(cage, lines, WATER, VISCOSITY, waves=wave.components, ramp=6.0)
    direct = packed._replace(summed=np.zeros((16, 10, 0)))
    start = np.concatenate([equilibrium_with_lines(cage, lines, WATER, VISCOSITY).place, np.zeros(3)])
    options = {"spacing": 0.024, "size": 0.2, "period": 1.2, "tolerance": 1e-6}
    march(packed, start, duration=1.2, **options)
    begin = time.process_time()
    march(packed, start, duration=wave.duration, **options)
    seconds = time.process_time() - begin
    begin = time.process_time()
    summed = march(direct, start, duration=6.0, **options)
    reference = (time.process_time() - begin) * wave.duration / 6.0
    short = march(packed, start, duration=6.0, **options)
    gap = np.abs(short.state[:, :3] - summed.state[:, :3]).max(axis=0) / np.abs(
        summed.state[:, :3] - summed.state[0, :3]
    ).max(axis=0)
    return {
        "case": "irregular sea of 200 waves, crossed lines",
        "periods": periods,
        "seconds": round(seconds, 2),
        "seconds_for_1000_periods": round(seconds * 1000.0 / periods, 1),
        "ratio_to_a_sum_at_every_part": round(reference / seconds, 1),
        "largest_relative_difference": float(f"{gap.max():.2e}"),
    }


def company(count: int, periods: int) -> dict[str, object]:
    """Time one realisation alone and so many on all cores, elapsed; their numbers must not depend on the company."""
    cage = model_cage()
    lines = taut_lines(cage)
    sea = IrregularSea("sea", jonswap(0.02, 1.2, 3.3), duration=periods * 1.2, seed=1)
    settings = RigidCageSettings(realisations=count + 1)
    problem = RigidCageProblem("", cage, (), VISCOSITY, Environment(WATER), settings=settings)
    rest = equilibrium_with_lines(cage, lines, WATER, VISCOSITY)
    begin = time.perf_counter()
    found = list(further_realisations(problem, lines, rest, WATER, sea))
    together = time.perf_counter() - begin
    seed = found[0].seed
    (wave,) = waves_of(problem, replace(sea, seed=seed), WATER)
    begin = time.perf_counter()
    alone = run_wave(problem, lines, rest, WATER, wave).numbers
    single = time.perf_counter() - begin
    return {
        "case": f"{count} realisations of {periods} waves on all cores",
        "seconds": round(together, 2),
        "seconds_of_one_alone": round(single, 2),
        "ratio_to_one_after_the_other": round(count * single / together, 2),
        "same_numbers": bool(np.array_equal(alone.line_tension_maximum, found[0].numbers.line_tension_maximum)),
    }


def patches() -> dict[str, object]:
    """Return how the numbers change with the patches along an edge."""
    found = {}
    for count in (2, 3, 5, 8, 16):
        cage = model_cage(patches=count)
        lines = taut_lines(cage)
        start = np.concatenate([equilibrium_with_lines(cage, lines, WATER, VISCOSITY).place, np.zeros(3)])
        wave = wave_of("linear", HEIGHT, PERIOD, 0.0, WATER, 0.0, 24)
        packed = pack(cage, lines, WATER, VISCOSITY, waves=wave.components, ramp=5.0 * PERIOD)
        run = march(packed, start, duration=26.4, spacing=0.022, size=0.2, period=PERIOD, tolerance=1e-6)
        found[str(count)] = [float(f"{value:.4g}") for value in numbers(run.state, run.tension_peak)]
    return {"case": "patches along an edge", **found}


if __name__ == "__main__":
    for case in (
        lambda: regular(2000.0, 1e-6),
        lambda: regular(2000.0, 1e-5),
        lambda: regular(30000.0, 1e-5),
        lambda: irregular(60),
        lambda: company(8, 500),
        patches,
    ):
        print(json.dumps(case()), flush=True)
