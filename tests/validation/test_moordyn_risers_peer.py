"""Risers with a body and clamps of MoorDyn's own decks (BSD-3-Clause), at rest there and here.

MoorDyn starts on catenaries between the places where body and clamps rest here, and swings a little about its own rest.

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

from moyai.coupled.equilibrium import find_coupled_equilibrium
from moyai.interop.moordyn_deck import write_deck
from moyai.interop.moordyn_reader import read_deck
from moyai.interop.moordyn_records import DeckOption
from moyai.interop.moordyn_system import to_system

pytestmark = [pytest.mark.peer, pytest.mark.shared_data, pytest.mark.slow]

SCRIPT = """
import json, sys
import moordyn
import numpy as np
system, place, steps = moordyn.Create(sys.argv[1]), json.loads(sys.argv[2]), int(sys.argv[3])
moordyn.Init_NoIC(system, place, [0.0] * len(place))
lines = [moordyn.GetLine(system, k + 1) for k in range(moordyn.GetNumberLines(system))]
body, out = moordyn.GetBody(system, 1), []
for step in range(steps):
    moordyn.Step(system, place, [0.0] * len(place), 0.05 * step, 0.05)
    pull = [np.linalg.norm(moordyn.GetLineNodeTen(x, max(1, moordyn.GetLineN(x) // 2))) for x in lines]
    out.append([*moordyn.GetBodyState(body)[0], *map(float, pull)])
print("RESULT", json.dumps(out))
"""


def at_rest(deck, found):
    """The deck with its body, its clamps of no length and its free points where they rest here."""
    network, body = found.network, found.bodies["body 1"]
    place = {name: found.state.position[node] for name, node in network.points.items()}
    # a planar rest: the pitch is the same angle in both orders of turning
    assert np.allclose(np.asarray(body.rotation)[[0, 2]], 0.0, atol=1e-6)
    bodies = (
        replace(
            deck.bodies[0], position=tuple(map(float, body.position)),
            angles=(0.0, float(np.degrees(np.asarray(body.rotation)[1])), 0.0),
        ),
    )  # fmt: skip
    rods = tuple(
        rod if rod.segments else replace(rod, start=tuple(map(float, place[f"rod {rod.number}"])),
                                         end=tuple(map(float, place[f"rod {rod.number}"])))
        for rod in deck.rods
    )  # fmt: skip
    points = tuple(
        replace(p, position=tuple(map(float, place[f"point {p.number}"]))) if p.kind == "free" else p
        for p in deck.points
    )
    return replace(deck, bodies=bodies, rods=rods, points=points)


@pytest.mark.parametrize(
    ("name", "step", "duration"), [("riser/riser", 1.2e-4, 16.0), ("local_euler/complex_system", 5e-5, 6.0)]
)
def test_risers_rest_alike(shared_data, tmp_path, name, step, duration):
    python = os.environ.get("MOYAI_PEER_PYTHON") or (sys.executable if importlib.util.find_spec("moordyn") else "")
    if not python:
        pytest.skip("MoorDyn is not installed here and MOYAI_PEER_PYTHON names no interpreter that has it")
    deck = read_deck(shared_data / "moordyn_decks" / f"{name}.txt")
    system = to_system(deck)
    found = find_coupled_equilibrium(system.network, system.bodies)
    assert found.residual < 2e-9
    # its own scheme and step blow up; its start is not wanted
    own = ("fileIC", "cfl", "tScheme", "dtM", "writeLog")
    options = (*(o for o in deck.options if o.key not in own), DeckOption("tScheme", "RK4"), DeckOption("dtM", step))
    path = write_deck(replace(at_rest(deck, found), options=options), tmp_path / "deck.txt")
    place = [x for point in deck.points if point.kind == "coupled" for x in point.position]
    done = subprocess.run(
        [python, "-c", SCRIPT, path.name, json.dumps(place), str(round(duration / 0.05))], cwd=tmp_path,
        capture_output=True, text=True, check=True, timeout=170,
    )  # fmt: skip
    rows = np.array(json.loads(done.stdout.rsplit("RESULT", 1)[1].splitlines()[0]))
    mean, swing = rows[len(rows) // 3 :].mean(axis=0), rows[len(rows) // 3 :].std(axis=0)
    ours = []
    for line in deck.lines:
        strand, m = found.network.strand(f"line {line.number}"), max(1, line.segments // 2)
        unit = np.diff(found.state.position[strand.nodes], axis=0)
        pull = found.tension[strand.bars][:, None] * unit / np.linalg.norm(unit, axis=1)[:, None]
        ours.append(float(np.linalg.norm(0.5 * (pull[m - 1] + pull[m]) if m < line.segments else pull[m - 1])))
    body = found.bodies["body 1"]
    print("body here", np.round([*body.position, body.rotation[1]], 4), "there", np.round(mean[[0, 1, 2, 4]], 4))
    print("tensions here", np.round(ours, 0), "there", np.round(mean[6:], 0), "+-", np.round(swing[6:], 0))
    assert np.abs(mean[:3] - body.position).max() < 0.005
    assert mean[4] == pytest.approx(body.rotation[1], abs=1e-3)
    assert ours == pytest.approx(mean[6:], rel=1e-2)
