"""MoorDyn (BSD-3-Clause) itself reads the decks that are written here and swings about the same tensions.

Its start leaves the lines in a slow swing that only drag ends, so the mean over eighty seconds is compared.

Needs MoorDyn in this environment or in the interpreter named by MOYAI_PEER_PYTHON.
"""

import importlib.util
import json
import os
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

from moyai.flexible.statics import solve_equilibrium
from moyai.interop.moordyn_deck import DeckLine, DeckLineType, DeckPoint, MoorDynDeck, write_deck
from moyai.interop.moordyn_network import line_name, to_deck, to_network
from moyai.interop.moordyn_records import DeckOption

pytestmark = pytest.mark.peer

SCRIPT = """
import json, sys
import moordyn
import numpy as np
path, place, lines = sys.argv[1], json.loads(sys.argv[2]), int(sys.argv[3])
system = moordyn.Create(path)
moordyn.Init(system, place, [0.0] * len(place))
out = np.zeros((lines, 2))
for step in range(1000):
    moordyn.Step(system, place, [0.0] * len(place), 0.1 * step, 0.1)
    if step < 200:
        continue
    for number in range(lines):
        line = moordyn.GetLine(system, number + 1)
        for end, node in enumerate((0, moordyn.GetLineN(line))):
            out[number, end] += np.linalg.norm(moordyn.GetLineNodeTen(line, node)) / 800
print("RESULT", json.dumps(out.tolist()))
"""


def tensions_in_moordyn(path, place, lines):
    python = os.environ.get("MOYAI_PEER_PYTHON") or (sys.executable if importlib.util.find_spec("moordyn") else "")
    if not python:
        pytest.skip("MoorDyn is not installed here and MOYAI_PEER_PYTHON names no interpreter that has it")
    done = subprocess.run(
        [python, "-c", SCRIPT, path.name, json.dumps(place), str(lines)], cwd=path.parent, capture_output=True,
        text=True, check=True, timeout=110,
    )  # fmt: skip
    # MoorDyn prints its own progress without ending the line
    return np.array(json.loads(done.stdout.rsplit("RESULT", 1)[1].splitlines()[0]))


def random_deck(seed):
    """Two chains of random make, one to an anchor on the bed, one up from a clump weight."""
    draw = np.random.default_rng(seed)
    depth = draw.uniform(20.0, 80.0)
    kinds = tuple(
        DeckLineType(
            name, draw.uniform(0.05, 0.1), draw.uniform(80.0, 150.0), draw.uniform(2e7, 1e8),
            -0.8, 0.0, 1.6, 1.0, 0.1, 0.5
        )
        for name in ("lower", "upper")
    )  # fmt: skip
    points = (
        DeckPoint(1, "fixed", (2.0 * depth, 0.0, -depth), 0.0, 0.0, 0.0, 0.0),
        DeckPoint(2, "free", (depth, 0.0, -0.6 * depth), 500.0, draw.uniform(0.01, 0.08), 0.6, 0.5),
        DeckPoint(3, "coupled", (0.0, 0.3 * depth, -3.0), 0.0, 0.0, 0.0, 0.0),
    )
    lines = (DeckLine(1, "lower", 1, 2, 1.1 * depth, 20), DeckLine(2, "upper", 2, 3, 1.25 * depth, 20))
    values = {
        "WtrDpth": depth, "WtrDnsty": draw.uniform(1000.0, 1030.0), "g": 9.81, "kBot": 1e6, "cBot": 1e5, "cfl": 0.05,
        "threshIC": 1e-6, "TmaxIC": 200.0, "dtIC": 1.0, "writeLog": 0.0,
    }  # fmt: skip
    return MoorDynDeck(kinds, points, lines, tuple(DeckOption(k, v) for k, v in values.items()))


@pytest.mark.parametrize("seed", range(3))
def test_moordyn_reads_our_decks_and_rests_alike(tmp_path, seed):
    deck = random_deck(seed)
    network = to_network(deck)
    # through the network and back, so that the exporter is held too; the options of MoorDyn's own start are added
    exported = to_deck(network)
    own = [o for o in deck.options if exported.number(o.key) is None]
    path = write_deck(replace(exported, options=(*exported.options, *own)), tmp_path / "deck.txt")
    place = list(deck.point(3).position)
    found = tensions_in_moordyn(path, place, 2)
    rest = solve_equilibrium(network)
    ours = [[rest.tension[network.strand(line_name(k)).bars[end]] for end in (0, -1)] for k in (1, 2)]
    assert found == pytest.approx(np.array(ours), rel=2e-3)
