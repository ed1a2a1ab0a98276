"""Bodies and rods of MoorDyn's own decks (BSD-3-Clause), run by MoorDyn and here.

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
from moyai.coupled.simulate import simulate_coupled
from moyai.interop.moordyn_deck import write_deck
from moyai.interop.moordyn_reader import read_deck
from moyai.interop.moordyn_system import to_system

pytestmark = [pytest.mark.peer, pytest.mark.shared_data]

SCRIPT = """
import json, sys
import moordyn
import numpy as np
system, place = moordyn.Create(sys.argv[1]), json.loads(sys.argv[2])
steps, dt = int(sys.argv[3]), float(sys.argv[4])
moordyn.Init_NoIC(system, place, [0.0] * len(place))
rods = [moordyn.GetRod(system, k + 1) for k in range(moordyn.GetNumberRods(system))]
bodies = [moordyn.GetBody(system, k + 1) for k in range(moordyn.GetNumberBodies(system))]
lines = [moordyn.GetLine(system, k + 1) for k in range(moordyn.GetNumberLines(system))]
out = {"rods": [], "bodies": [], "lines": []}
for step in range(steps):
    moordyn.Step(system, place, [0.0] * len(place), dt * step, dt)
    out["rods"].append([[list(moordyn.GetRodNodePos(r, n)) for n in (0, moordyn.GetRodN(r))] for r in rods])
    out["bodies"].append([list(moordyn.GetBodyState(b)[0]) for b in bodies])
    out["lines"].append([float(np.linalg.norm(moordyn.GetLineNodeTen(x, moordyn.GetLineN(x)))) for x in lines])
print("RESULT", json.dumps(out))
"""


def run_in_moordyn(path, duration, dt, place=()):
    python = os.environ.get("MOYAI_PEER_PYTHON") or (sys.executable if importlib.util.find_spec("moordyn") else "")
    if not python:
        pytest.skip("MoorDyn is not installed here and MOYAI_PEER_PYTHON names no interpreter that has it")
    done = subprocess.run(
        [python, "-c", SCRIPT, path.name, json.dumps(list(place)), str(round(duration / dt)), str(dt)],
        cwd=path.parent, capture_output=True, text=True, check=True, timeout=110,
    )  # fmt: skip
    found = json.loads(done.stdout.rsplit("RESULT", 1)[1].splitlines()[0])
    return {key: np.array(rows) for key, rows in found.items()}


@pytest.fixture
def decks(shared_data):
    return shared_data / "moordyn_decks"


def test_pinned_rods_float_up_alike(decks, tmp_path):
    """A large swing of buoyant rods about their lower ends."""
    deck = read_deck(decks / "RodPinnedFloating.txt")
    theirs = run_in_moordyn(write_deck(deck, tmp_path / "deck.txt"), 1.0, 0.01)["rods"]
    system = to_system(deck)
    history = simulate_coupled(system.network, system.bodies, duration=1.0, output_step=0.01)
    for number in (1, 2):
        rod = history.bodies[f"rod {number}"]
        end = rod.position + rod.rotation @ np.array([0.0, 0.0, 1.0])
        off = np.abs(end[1:] - theirs[:, number - 1, 1]).max()
        print(f"rod {number}: {off:.2g} m")
        assert off < 1e-5


def test_rod_hangs_alike_from_two_ropes(decks, tmp_path):
    """MoorDyn starts on straight ropes and swings; its last forty of sixty seconds swing about our rest."""
    deck = read_deck(decks / "RodHanging.txt")
    theirs = run_in_moordyn(write_deck(deck, tmp_path / "deck.txt"), 60.0, 0.1)
    system = to_system(deck)
    rest = find_coupled_equilibrium(system.network, system.bodies)
    height = rest.bodies["rod 1"].position[2]
    tension = rest.tension[rest.network.strand("line 1").bars[-1]]
    mean = theirs["rods"][200:, 0, 0, 2].mean()
    pull = theirs["lines"][200:, 0].mean()
    print(f"z {height:.3f} m, there {mean:.3f} m; tension {tension:.0f} N, there {pull:.0f} N")
    assert height == pytest.approx(mean, abs=0.01)
    assert tension == pytest.approx(pull, rel=1e-4)


def test_body_sinks_alike_where_no_rope_is_pushed(decks, tmp_path):
    """MoorDyn's viscosity pushes with slack ropes; without it the body sinks alike, with it more slowly there."""
    given = read_deck(decks / "body_tests/bodyDrag.txt")
    speeds = []
    for damping in (0.0, given.line_types[0].damping):
        deck = replace(given, line_types=(replace(given.line_types[0], damping=damping),))
        theirs = run_in_moordyn(write_deck(deck, tmp_path / "deck.txt"), 3.0, 0.02)["bodies"][:, 0, 2]
        system = to_system(deck)
        history = simulate_coupled(system.network, system.bodies, duration=3.0, output_step=0.02)
        ours = history.bodies["body 1"].position[1:, 2]
        speeds.append([-(z[-1] - z[-51]) for z in (ours, theirs)])
    print("speed here and there, without and with viscosity", np.round(speeds, 4))
    assert speeds[0][0] == pytest.approx(speeds[0][1], rel=1e-3)
    # there a slack rope of the length l pushes with BA v / l: weight of body and half the rope less that is drag
    rope = given.line_types[0]
    viscosity = -rope.damping * np.sqrt(rope.stiffness * rope.mass_per_length)
    wet = rope.mass_per_length - 1025.0 * np.pi / 4.0 * rope.diameter**2
    weight, drag = 9.81 * (10.0 + 2.25 * wet), 0.5 * 1025.0 * 0.1
    slow = (np.sqrt(viscosity**2 + 4.0 * drag * weight) - viscosity) / (2.0 * drag)
    assert speeds[1][1] == pytest.approx(slow, rel=5e-3)


def test_pinned_body_swings_alike(decks, tmp_path):
    given = read_deck(decks / "body_tests/pinnedBody.txt")
    deck = replace(given, bodies=(replace(given.bodies[0], angles=(0.0, 40.0, 0.0)),))
    place = (*given.bodies[0].position, 0.0, np.radians(40.0), 0.0)
    theirs = run_in_moordyn(write_deck(deck, tmp_path / "deck.txt"), 10.0, 0.02, place)["rods"][:, 0, 1]
    system = to_system(deck)
    history = simulate_coupled(system.network, system.bodies, duration=10.0, output_step=0.02)
    body = history.bodies["body 1"]
    end = (body.position + body.rotation @ np.array([0.0, 0.0, -15.0]))[1:]
    print(f"end of the rod: {np.abs(end - theirs).max():.2g} m over {np.ptp(end[:, 0]):.3g} m")
    assert end == pytest.approx(theirs, abs=1e-4)
