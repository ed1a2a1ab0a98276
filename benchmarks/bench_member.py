"""Members: inertia coefficients of polygons, a three-hour sea past a brace, identification of a long record.

    python benchmarks/bench_member.py

One thread, warm; prints JSON lines, each with its time and the error or ratio found in the same run.
"""

from __future__ import annotations

import json
import math
import time

import numpy as np

from moyai.morison import sections
from moyai.morison.circulation import CirculationLaw
from moyai.morison.coefficients import CoefficientRule
from moyai.morison.members import StraightMember
from moyai.records.forces.identification import ForceRecord, Setup, identify
from moyai.sea import spectra
from moyai.sea.environment import Environment
from moyai.sea.states import IrregularSea
from moyai.sea.water import Water
from moyai.structures.member.march import march
from moyai.structures.member.model import MemberProblem, MemberSettings, MemberWaves
from moyai.structures.member.waves import waves_of


def inertia() -> dict[str, float]:
    """Time the square and a random polygon of eight corners; error of the square against its conformal map."""
    rng = np.random.default_rng(1)
    angle = 2.0 * math.pi * np.arange(8) / 8
    points = rng.uniform(0.7, 1.3, 8)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    start = time.perf_counter()
    square = sections.rectangle(1.0, 1.0).inertia.tensor[0, 0]
    middle = time.perf_counter()
    found = sections.polygon(points).inertia
    end = time.perf_counter()
    return {
        "square_seconds": middle - start,
        "square_error": abs(square / 2.1884396152264767 - 1.0),
        "octagon_seconds": end - middle,
        "octagon_asymmetry": found.checks[0].value,
    }


def brace() -> dict[str, float]:
    """Time a three-hour sea with Wheeler's stretching past forty strips, and its ratio to real time."""
    water = Water(30.0, 1025.0, 9.81)
    member = StraightMember((-10, -3, -22), (5, 2, 5), sections.circle(1.2))
    sea = IrregularSea("storm", spectra.jonswap(4.0, 9.0, 3.3), 0.3, None, 10800.0, 1)
    problem = MemberProblem(
        "brace", member, CoefficientRule("dnv_c205", "dnv_c205"), 1.19e-6, Environment(water), (sea,),
        CirculationLaw(purpose="response"), settings=MemberSettings(("forces",), 40),
    )  # fmt: skip
    (wave,) = waves_of(problem, sea, water)
    start = time.perf_counter()
    found = march(problem, member, wave)
    seconds = time.perf_counter() - start
    return {"seconds": seconds, "times_real_time": 10800.0 / seconds, "samples": float(found.time.size)}


def convergence() -> dict[str, float]:
    """Order of the strip rule on an inclined member: error of 10 over that of 20 strips."""
    water = Water(20.0, 1025.0, 9.81)
    member = StraightMember((-4, -2, -15), (3, 1, -2), sections.circle(0.7))
    seas = (MemberWaves("a", (3.0,), (7.0,), 0.5),)
    sums = {}
    for count in (10, 20, 640):
        problem = MemberProblem(
            "m",
            member,
            CoefficientRule((1.0, 1.0)),
            1e-6,
            Environment(water),
            seas,
            settings=MemberSettings(("forces",), count),
        )
        (wave,) = waves_of(problem, seas[0], water)
        sums[count] = march(problem, member, wave).force.sum(axis=0)
    errors = [float(np.abs(sums[count] - sums[640]).max()) for count in (10, 20)]
    return {"error_ratio": errors[0] / errors[1], "order": math.log2(errors[0] / errors[1])}


def identification() -> dict[str, float]:
    """Time all methods on a hundred thousand samples; worst error of a clean record."""
    clock = 0.02 * np.arange(100_000)
    velocity = 0.3 * np.cos(2.0 * clock)
    force = 1000.0 * 0.2 * 1.8 * -0.6 * np.sin(2.0 * clock) + 500.0 * 0.5 * 1.1 * velocity * np.abs(velocity)
    setup = Setup(1000.0, 0.2, (0.5,), period=math.pi)
    start = time.perf_counter()
    found = identify(ForceRecord(clock, force, velocity), setup)
    worst = max(max(abs(f.inertia.value / 1.8 - 1.0), abs(f.drag.value / 1.1 - 1.0)) for f in found.fits)
    return {"seconds": time.perf_counter() - start, "worst_error": worst}


if __name__ == "__main__":
    inertia()
    for name, run in (
        ("inertia coefficients", inertia),
        ("three-hour sea past a brace", brace),
        ("order of the strip rule", convergence),
        ("identification, four methods", identification),
    ):
        print(json.dumps({"what": name, **run()}))
