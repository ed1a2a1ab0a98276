"""A deck of MoorDyn's own (BSD-3-Clause) with waves of a record and a current, run by MoorDyn and here.

Needs MoorDyn in this environment or in the interpreter named by MOYAI_PEER_PYTHON.
"""

import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from moyai.flexible.flow import Flow
from moyai.flexible.simulation import simulate
from moyai.flexible.statics import solve_equilibrium
from moyai.interop.moordyn_deck import write_deck
from moyai.interop.moordyn_network import flow_of, to_network
from moyai.interop.moordyn_reader import read_deck

pytestmark = [pytest.mark.peer, pytest.mark.shared_data, pytest.mark.slow]

SCRIPT = """
import json, sys
import moordyn
system = moordyn.Create(sys.argv[1])
moordyn.Init(system, [], [])
line, out = moordyn.GetLine(system, 1), []
for step in range(600):
    moordyn.Step(system, [], [], 0.1 * step, 0.1)
    out.append([list(moordyn.GetLineNodeTen(line, 80)), list(moordyn.GetLineNodePos(line, 60))])
print("RESULT", json.dumps(out))
"""


def run_in_moordyn(path):
    python = os.environ.get("MOYAI_PEER_PYTHON") or (sys.executable if importlib.util.find_spec("moordyn") else "")
    if not python:
        pytest.skip("MoorDyn is not installed here and MOYAI_PEER_PYTHON names no interpreter that has it")
    done = subprocess.run(
        [python, "-c", SCRIPT, path.name], cwd=path.parent, capture_output=True, text=True, check=True, timeout=110
    )
    rows = json.loads(done.stdout.rsplit("RESULT", 1)[1].splitlines()[0])
    return np.linalg.norm([row[0] for row in rows], axis=1), np.array([row[1] for row in rows])


def folder_of(shared_data, tmp_path, kind):
    """A copy of the deck with WaveKin 3, as MoorDyn 2.7.2 calls what the deck means."""
    for file in (shared_data / "moordyn_decks/wavekin_2").iterdir():
        shutil.copyfile(file, tmp_path / file.name)
    path = tmp_path / "wavekin_2.txt"
    text = re.sub(r"^2( +WaveKin)", rf"{kind}\1", path.read_text(encoding="latin-1"), flags=re.MULTILINE)
    # an even step of the record that MoorDyn's grid holds
    path.write_text(text.replace("1             Currents", "0.05 dtWave\n1             Currents"), encoding="latin-1")
    # its grid of 900 x 5 x 56 places, every fifth of them
    lines = (tmp_path / "water_grid.txt").read_text().splitlines()
    lines[4] = " ".join(lines[4].split()[::5])
    (tmp_path / "water_grid.txt").write_text("\n".join([*lines, ""]))
    return path


@pytest.mark.parametrize("written", [False, True], ids=["its_grid", "written_here"])
def test_waves_of_a_record_pull_alike(shared_data, tmp_path, written):
    path = folder_of(shared_data, tmp_path, 3)
    given = read_deck(path)
    # MoorDyn's friction grows with the speed from nothing: at rest it holds nothing
    options = tuple(replace(o, value=0.0) if o.key == "FrictionCoefficient" else o for o in given.options)
    deck = replace(given, options=options)
    if written:
        again = tmp_path / "again"
        again.mkdir()
        path = write_deck(deck, again / "deck.txt")
        assert read_deck(path).waves == deck.waves
    tension, place = run_in_moordyn(path)
    network, flow = to_network(deck), flow_of(deck)
    start = solve_equilibrium(network, flow=Flow(current=flow.current)).state
    found = simulate(network, {}, duration=60.0, output_step=0.1, start=start, flow=flow)
    strand = network.strand("line 1")
    # the tension at an inner node there is the mean of the two bars that meet in it
    ends = found.position[:, strand.nodes[79:82]]
    along = np.diff(ends, axis=1)
    along /= np.linalg.norm(along, axis=2)[:, :, None]
    mean = 0.5 * np.sum(found.tension[:, strand.bars[79:81], None] * along, axis=1)
    ours, node = np.linalg.norm(mean, axis=1)[1:], found.position[1:, strand.nodes[60]]
    late = slice(300, None)
    swing, off = np.ptp(tension[late]), ours[late] - tension[late]
    print(
        f"range here {ours[late].min():.0f} to {ours[late].max():.0f} N, there {tension[late].min():.0f} to "
        f"{tension[late].max():.0f} N; rms of the difference {100.0 * np.std(off) / swing:.2f} % of the swing, "
        f"mean {np.mean(off):.0f} N; off by {np.abs(node[late] - place[late]).max():.4f} m"
    )
    assert np.std(off) < 0.03 * swing
    assert abs(np.mean(off)) < 1e-3 * np.mean(tension[late])
