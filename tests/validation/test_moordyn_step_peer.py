"""Decks that are written here hold a step with which MoorDyn (BSD-3-Clause) runs them and finds the same peaks.

Needs MoorDyn in this environment or in the interpreter named by MOYAI_PEER_PYTHON.
"""

import importlib.util
import json
import os
import subprocess
import sys

import numpy as np
import pytest

from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType
from moyai.flexible.motion import Motion
from moyai.flexible.simulation import simulate
from moyai.flexible.statics import solve_equilibrium
from moyai.interop.moordyn_deck import write_deck
from moyai.interop.moordyn_network import to_deck
from moyai.sea.water import Water

pytestmark = [pytest.mark.peer, pytest.mark.slow]

SCRIPT = """
import json, sys
import moordyn
import numpy as np
path, place, table = sys.argv[1], json.loads(sys.argv[2]), json.load(sys.stdin)
system = moordyn.Create(path)
moordyn.Init(system, place, [0.0] * 3)
lines = [moordyn.GetLine(system, k + 1) for k in range(moordyn.GetNumberLines(system))]
peak = np.zeros(len(lines))
for step in range(len(table) - 1):
    (x, z), (x_next, z_next) = table[step][:2], table[step + 1][:2]
    x, v = [place[0] + x, place[1], place[2] + z], [(x_next - x) / 0.01, 0.0, (z_next - z) / 0.01]
    moordyn.Step(system, x, v, 0.01 * step, 0.01)
    if step > 600:
        now = [np.linalg.norm(moordyn.GetLineNodeTen(x, moordyn.GetLineN(x))) for x in lines]
        peak = np.where(np.isnan(now), np.nan, np.maximum(peak, now))
print("RESULT", json.dumps(peak.tolist()))
"""
DURATION = 16.0


def network_of(seed):
    """A line up to a moving point by way of a clump weight: chains, wires and soft ropes of random make."""
    draw = np.random.default_rng(seed)
    depth, segments = draw.uniform(20.0, 60.0), int(draw.integers(8, 40))
    mass, stiffness = [(120.0, 3e8), (15.0, 5e7), (8.0, 4e5), (40.0, 2e6)][seed % 4]
    length = 1.02 * depth
    viscosity = draw.uniform(0.05, 0.8) * length / segments * np.sqrt(stiffness * mass)
    # EI in the last one
    kind = BarType(
        "line", mass, stiffness, draw.uniform(0.04, 0.09), viscosity=viscosity, drag_normal=1.4, drag_tangential=0.2,
        added_mass_normal=1.0, added_mass_tangential=0.0, bending_stiffness=2e4 if seed == 3 else 0.0,
    )  # fmt: skip
    place = (0.8 * depth, 0.0, -0.5 * depth)
    for _ in range(2):
        builder = NetworkBuilder(Water(depth, 1025.0, 9.81), Bed(-depth, 1e6, 1e5, 0.0))
        builder.fixed("anchor", (1.6 * depth, 0.0, -depth))
        builder.free("clump", place, mass=500.0, volume=0.1)
        builder.driven("top", (0.0, 0.0, -2.0))
        builder.line("lower", "anchor", "clump", kind, length=length, segments=segments)
        builder.line("upper", "clump", "top", kind, length=length, segments=segments)
        network = builder.build()
        # MoorDyn begins on catenaries: with the clump where it rests there is little left to swing
        rest = solve_equilibrium(network).state.position[network.points["clump"]]
        place = (float(rest[0]), float(rest[1]), float(rest[2]))
    return network


@pytest.mark.parametrize("seed", range(4))
def test_moordyn_runs_what_is_written_and_finds_the_peaks(tmp_path, seed):
    python = os.environ.get("MOYAI_PEER_PYTHON") or (sys.executable if importlib.util.find_spec("moordyn") else "")
    if not python:
        pytest.skip("MoorDyn is not installed here and MOYAI_PEER_PYTHON names no interpreter that has it")
    network = network_of(seed)
    path = write_deck(to_deck(network), tmp_path / "deck.txt")
    time = 0.01 * np.arange(round(DURATION / 0.01) + 1)
    omega = 2.0 * np.pi / 5.0
    grown = np.where(time < 5.0, 0.5 * (1.0 - np.cos(np.pi * time / 5.0)), 1.0)
    rate = np.where(time < 5.0, 0.5 * np.pi / 5.0 * np.sin(np.pi * time / 5.0), 0.0)
    x, z = 0.8 * np.sin(omega * time), 0.6 * np.cos(omega * time)
    u, w = 0.8 * omega * np.cos(omega * time), -0.6 * omega * np.sin(omega * time)
    moved, speed = np.stack([grown * x, grown * z]), np.stack([grown * u + rate * x, grown * w + rate * z])
    zero = np.zeros(time.size)
    motion = Motion(0.0, 0.01, np.stack([moved[0], zero, moved[1]], 1), np.stack([speed[0], zero, speed[1]], 1))
    table = np.concatenate([moved, speed]).T.tolist()
    done = subprocess.run(
        [python, "-c", SCRIPT, path.name, json.dumps([0.0, 0.0, -2.0])], cwd=path.parent,
        input=json.dumps(table),
        capture_output=True, text=True, check=True, timeout=110,
    )  # fmt: skip
    theirs = json.loads(done.stdout.rsplit("RESULT", 1)[1].splitlines()[0])
    start = solve_equilibrium(network).state
    found = simulate(network, {"top": motion}, duration=DURATION, output_step=0.01, start=start)
    assert found.status == "converged"
    late = found.time > 6.0
    for line, peak in zip(("lower", "upper"), theirs, strict=True):
        ours = float(found.tension_peak[late][:, network.strand(line).bars[-1]].max())
        print(f"{line}: {ours:.1f} N, there {peak:.1f} N, {100.0 * (ours / peak - 1.0):+.2f} %")
        assert ours == pytest.approx(peak, rel=0.02)
