"""MoorDyn (BSD-3-Clause) is driven with the motion of the box of Wu et al. and feels the same tensions.

Needs MoorDyn in this environment or in the interpreter named by MOYAI_PEER_PYTHON.
"""

import importlib.util
import json
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from moyai.coupled.equilibrium import find_coupled_equilibrium
from moyai.coupled.simulate import simulate_coupled
from moyai.flexible.flow import Flow
from moyai.interop.moordyn_deck import write_deck
from moyai.interop.moordyn_network import to_deck
from moyai.interop.moordyn_records import DeckOption

pytestmark = pytest.mark.peer

SCRIPT = """
import json, sys
import moordyn
import numpy as np
motion = np.load(sys.argv[2])
place, speed, step = motion["place"], motion["speed"], float(motion["step"])
system = moordyn.Create(sys.argv[1])
moordyn.Init(system, place[0].tolist(), speed[0].tolist())
out = np.zeros((len(place) - 1, 4))
for row in range(len(place) - 1):
    moordyn.Step(system, place[row].tolist(), speed[row].tolist(), step * row, step)
    for number in range(4):
        line = moordyn.GetLine(system, number + 1)
        out[row, number] = np.linalg.norm(moordyn.GetLineNodeTen(line, moordyn.GetLineN(line)))
print("RESULT", json.dumps(out.tolist()))
"""


@pytest.fixture(scope="module")
def example():
    path = Path(__file__).parents[2] / "examples/coupled/moored_box.py"
    spec = importlib.util.spec_from_file_location("moored_box", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_moordyn_feels_the_same_tensions_under_the_motion_of_the_box(tmp_path, example):
    python = os.environ.get("MOYAI_PEER_PYTHON") or (sys.executable if importlib.util.find_spec("moordyn") else "")
    if not python:
        pytest.skip("MoorDyn is not installed here and MOYAI_PEER_PYTHON names no interpreter that has it")
    network, points = example.chains(20)
    body = example.box("morison", points)
    rest = find_coupled_equilibrium(network, {"box": body})
    body = rest.bodies["box"]
    # the box in waves, its chains in still water, as MoorDyn is given none
    # MoorDyn goes straight on from the place and velocity at the start of each call: short calls
    step = 0.003125
    carrier = body.carrier(example.WATER, example.sea())
    history = simulate_coupled(
        rest.network, {"box": body}, duration=12.0, output_step=step, flow=Flow(), start=rest.state,
        carriers={"box": carrier},
    )  # fmt: skip
    box, names = history.bodies["box"], list(points)
    arms = np.array([points[name] for name in names]) - body.centre_of_gravity
    turned = np.einsum("kij,pj->kpi", box.rotation, arms)
    centre = box.position + box.rotation @ body.centre_of_gravity
    place = centre[:, None] + turned
    speed = box.velocity[:, None, :3] + np.cross(box.velocity[:, None, 3:], turned)
    deck = to_deck(rest.network)
    own = {"cfl": 0.1, "threshIC": 1e-7, "TmaxIC": 40.0, "dtIC": 0.5, "CdScaleIC": 4.0, "writeLog": 0.0}
    have = {option.key for option in deck.options}
    deck = replace(deck, options=(*deck.options, *(DeckOption(k, v) for k, v in own.items() if k not in have)))
    path = write_deck(deck, tmp_path / "deck.txt")
    coupled = [np.array(point.position) for point in deck.points if point.kind == "coupled"]
    order = [int(np.argmin(np.linalg.norm(place[0] - there, axis=1))) for there in coupled]
    np.savez(
        tmp_path / "motion.npz", place=place[:, order].reshape(len(place), -1),
        speed=speed[:, order].reshape(len(place), -1), step=step,
    )  # fmt: skip
    done = subprocess.run(
        [python, "-c", SCRIPT, path.name, "motion.npz"], cwd=tmp_path, capture_output=True, text=True, check=True,
        timeout=110,
    )  # fmt: skip
    theirs = np.array(json.loads(done.stdout.rsplit("RESULT", 1)[1].splitlines()[0]))
    # MoorDyn's tension at an end is the force on the point: the bar's pull and the weight of half of it
    ours = []
    for strand in rest.network.strands:
        along = history.network.position[1:, strand.nodes[-2]] - history.network.position[1:, strand.nodes[-1]]
        pull = history.network.tension[1:, strand.bars[-1], None] * along / np.linalg.norm(along, axis=1)[:, None]
        kind = rest.network.bars.types[0]
        half = 0.5 * float(rest.network.bars.length[strand.bars[-1]])
        pull[:, 2] -= half * kind.submerged_weight_per_length(example.WATER)
        ours.append(np.linalg.norm(pull, axis=1))
    ours = np.array(ours).T
    keep = history.time[1:] > 4.0
    error = np.sqrt(np.mean((ours[keep] - theirs[keep]) ** 2)) / np.ptp(theirs[keep])
    peaks = ours[keep].max(axis=0) / theirs[keep].max(axis=0) - 1.0
    print(f"rms over range {error:.5f}, peaks {np.array2string(100.0 * peaks, precision=3)} %")
    assert np.abs(peaks).max() < 0.005
    assert error < 0.01
