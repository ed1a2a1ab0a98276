"""Decks with failing lines: read, written again, and the line is gone after its time."""

import pytest
from typer.testing import CliRunner

from moyai.cli.main import app
from moyai.core.errors import CaseError
from moyai.core.results import read_result
from moyai.interop.moordyn_case import case_text
from moyai.interop.moordyn_deck import write_deck
from moyai.interop.moordyn_reader import read_deck

DECK = """\
--- MoorDyn ---
a clump on two ropes
--- LINE TYPES ---
TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx
(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
rope 0.05 3 2e6 -0.8 0 1.2 1.0 0.0 0.0
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Fixed -20 0 -10 0 0 0 0
2 Fixed 20 0 -10 0 0 0 0
3 Free 0 0 -30 2000 0.2 0.5 1
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (name) (#) (#) (m) (-) (-)
1 rope 1 3 28 10 p
2 rope 3 2 28 10 p
--- FAILURE ---
FailureID Point Line(s) FailTime FailTen
() () (,) (s or 0) (N or 0)
1 3 2 4 0
2 1 1 0 9e9
--- OPTIONS ---
100 WtrDpth
--- need this line ---
"""


@pytest.mark.slow
def test_it_is_read_written_and_run(tmp_path):
    (tmp_path / "deck.txt").write_text(DECK)
    deck = read_deck(tmp_path / "deck.txt")
    assert [(f.point, f.line_number, f.time, f.tension) for f in deck.failures] == [(3, 2, 4.0, 0.0), (1, 1, 0.0, 9e9)]
    assert read_deck(write_deck(deck, tmp_path / "again.txt")).failures == deck.failures
    text = case_text(deck)
    assert "- {line: line 2, at: start, time: 4}" in text
    assert "- {line: line 1, at: start, tension: 9000000000}" in text
    command = ["run", str(tmp_path / "deck.txt"), "--duration", "30", "-o", str(tmp_path / "out"), "--no-report"]
    ran = CliRunner().invoke(app, command)
    assert ran.exit_code == 0, ran.output
    series = read_result(tmp_path / "out" / "results.nc").tree["SWL/time/still water"].to_dataset()
    pull = series["point_load"].sel(point="point 2").values
    time = series["time"].values
    assert abs(pull[time < 3.9, 0]).min() > 5e3
    # the rest of line 2 hangs on its anchor by its own weight; the clump hangs on line 1 alone
    weight = (3.0 - 1025.0 * 0.25 * 3.14159265 * 0.05**2) * 9.80665 * 28.0
    assert abs(pull[-1]).max() < 2.0 * weight
    other = abs(series["point_load"].sel(point="point 1").values[-1, 2])
    assert other == pytest.approx((2000.0 - 205.0) * 9.80665 + weight, rel=0.2)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("1 3 2 4 0", "1 2 1 4 0", "line 1 is not attached to 2"),
        ("1 3 2 4 0", "1 3 1,2 4 0", "part together"),
        ("1 3 2 4 0", "1 3 2 -4 0", "time is -4"),
        ("1 3 2 4 0", "1 3 9 4 0", "line 9 is not attached"),
    ],
)
def test_slips_are_reported(tmp_path, old, new, words):
    (tmp_path / "deck.txt").write_text(DECK.replace(old, new))
    with pytest.raises(CaseError) as caught:
        read_deck(tmp_path / "deck.txt")
    assert [fault for fault in caught.value.faults if words in str(fault) and fault.line == 21], caught.value.faults


def test_a_row_without_time_and_tension_never_parts(tmp_path):
    (tmp_path / "deck.txt").write_text(DECK.replace("1 3 2 4 0", "1 3 2 0 0"))
    assert [failure.number for failure in read_deck(tmp_path / "deck.txt").failures] == [2]
