"""Viscoelastic ropes of decks: read, written again, at rest with the static stiffness, run from the command."""

import math

import numpy as np
import pytest
from typer.testing import CliRunner

from moyai.cli.main import app
from moyai.core.errors import CaseError
from moyai.core.results import read_result
from moyai.flexible import solve_equilibrium
from moyai.interop.moordyn_deck import write_deck
from moyai.interop.moordyn_network import to_deck, to_network
from moyai.interop.moordyn_reader import read_deck

DECK = """\
--- MoorDyn ---
a rope of polyester
--- LINE TYPES ---
TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx
(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
rope 0.1438 22.42 1.424e8|1.586e8|0.4 4E9|11E6 0 1.2 1.0 0.0 0.0
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Fixed 0 0 -50 0 0 0 0
2 Coupled 101 0 -50 0 0 0 0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (name) (#) (#) (m) (-) (-)
1 rope 1 2 100 10 p
--- OPTIONS ---
200 WtrDpth
--- need this line ---
"""


@pytest.mark.slow
def test_it_is_read_written_and_rests_on_its_static_stiffness(tmp_path):
    (tmp_path / "deck.txt").write_text(DECK)
    deck = read_deck(tmp_path / "deck.txt")
    kind = deck.line_types[0]
    assert (kind.stiffness, kind.damping) == (1.586e8, 11e6)
    assert kind.slow is not None
    assert (kind.slow.stiffness, kind.slow.damping, kind.slow.growth) == (1.424e8, 4e9, 0.4)
    assert read_deck(write_deck(deck, tmp_path / "again.txt")).line_types == deck.line_types
    network = to_network(deck)
    assert float(solve_equilibrium(network).tension.mean()) == pytest.approx(1.424e8 * 0.01, rel=1e-3)
    assert to_deck(network).line_types[0].slow == kind.slow
    time = np.arange(0.0, 31.0, 0.05)
    shift = 0.25 * (1.0 - np.cos(math.pi * np.clip(time, 0.0, 1.0)))
    (tmp_path / "motion.csv").write_text("\n".join(f"{t:.3f},{x:.9f},0,0" for t, x in zip(time, shift)))
    command = ["run", str(tmp_path / "deck.txt"), "--motion", f"2={tmp_path / 'motion.csv'}", "--duration", "20"]
    ran = CliRunner().invoke(app, [*command, "-o", str(tmp_path / "out"), "--no-report"])
    assert ran.exit_code == 0, ran.output
    tree = read_result(tmp_path / "out" / "results.nc").tree
    pull = tree["SWL/time/still water"].to_dataset()["point_load"].sel(point="point 2").values[:, 0]
    # quick: the dynamic stiffness at the tension of rest; it then gives way over DAMPING / SLOW = 2.4 s
    fast = 1.586e8 + 0.4 * 1.424e6
    assert abs(pull).max() > 1.424e6 + 0.85 * fast * 0.005
    assert abs(pull[-1]) == pytest.approx(1.424e8 * 0.015, rel=0.01)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("1.424e8|1.586e8|0.4", "1.7e8|1.586e8", "above the static one"),
        ("4E9|11E6", "4E9", "BA_s|BA_d"),
        ("1.424e8|1.586e8|0.4", "1.4e8|a", "EA_s|EA_d"),
        ("1.424e8|1.586e8|0.4", "SYROPE:a.dat|1e8|2", "no file a.dat next to the deck"),
    ],
)
def test_slips_are_reported(tmp_path, old, new, words):
    (tmp_path / "deck.txt").write_text(DECK.replace(old, new))
    with pytest.raises(CaseError) as caught:
        read_deck(tmp_path / "deck.txt")
    assert [fault for fault in caught.value.faults if words in str(fault) and fault.line == 6], caught.value.faults


def test_the_slow_dashpot_may_be_a_part_of_critical(tmp_path):
    """Three tenths of l sqrt(EA_s m) of a segment of 10 m."""
    (tmp_path / "deck.txt").write_text(DECK.replace("4E9|11E6", "-0.3|11E6"))
    deck = read_deck(tmp_path / "deck.txt")
    slow = deck.line_types[0].slow
    assert slow is not None
    assert slow.damping == pytest.approx(0.3 * 10.0 * math.sqrt(1.424e8 * 22.42), rel=1e-12)
    assert any("BA_s is 0.3 of critical" in note for note in deck.notes)
    for wrong in ("4E9|-0.3", "0|11E6"):
        (tmp_path / "deck.txt").write_text(DECK.replace("4E9|11E6", wrong))
        with pytest.raises(CaseError, match="BA_s"):
            read_deck(tmp_path / "deck.txt")
