"""Decks with currents that change with time: read, run, and they push as hard as their speed says."""

import numpy as np
import pytest

from moyai.core.errors import CaseError, InputError
from moyai.interop.moordyn_case import case_text
from moyai.interop.moordyn_currents import read_current_field
from moyai.interop.moordyn_network import flow_of
from moyai.interop.moordyn_reader import read_deck

DECK = """\
--- MoorDyn ---
a taut wire across the current
--- LINE TYPES ---
TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx
(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
wire 0.1 8.05033119835 1e7 -0.8 0 1.2 1.0 0.0 0.0
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Fixed 0 -5 -10 0 0 0 0
2 Fixed 0 5 -10 0 0 0 0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (name) (#) (#) (m) (-) (-)
1 wire 1 2 9.99 10 p
--- OPTIONS ---
30 WtrDpth
1025 rho
KIND Currents
--- need this line ---
"""
PROFILE = """\
--------------------- MoorDyn dynamic currents File ----------------------------------
Tabulated file with the water currents components


 -20.0 -10.0 0.0

0.0   0.0 0.0 0.0
20.0  0.5 1.0 2.0
40.0  0.5 1.0 2.0
"""


def grid():
    rows = ["2 1 2 3", "-100 100", "0", "-20 0", "0 20 40"]
    for time in (0.0, 20.0, 40.0):
        for x in (-100, 100):
            for z in (-20, 0):
                rows.append(f"{x} 0 {z} {time} {min(time, 20.0) / 20.0 * (2.0 if z == 0 else 0.0)} 0 0")
    return "\n".join(rows)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kind", "name", "text"),
    [
        (2, "current_profile_dynamic.txt", PROFILE),
        pytest.param(5, "current_profile_4d.txt", grid(), marks=pytest.mark.slow),
    ],
)
def test_a_deck_runs_with_it_and_is_pushed_by_it(tmp_path, kind, name, text):
    (tmp_path / "deck.txt").write_text(DECK.replace("KIND", str(kind)), encoding="utf-8")
    (tmp_path / name).write_text(text, encoding="utf-8")
    deck = read_deck(tmp_path / "deck.txt")
    middle = np.array([[0.0], [0.0], [-10.0]])
    flow = flow_of(deck)
    assert flow.at(10.0, middle)[0, 0] == pytest.approx(0.5)
    assert flow.at(10.0, middle)[3, 0] == pytest.approx(0.05)
    assert flow.at(400.0, middle)[0, 0] == pytest.approx(1.0)
    assert "current_field" in case_text(deck)
    from typer.testing import CliRunner

    from moyai.cli.main import app
    from moyai.core.results import read_result

    ran = CliRunner().invoke(app, ["run", str(tmp_path / "deck.txt"), "-o", str(tmp_path / "out"), "--no-report"])
    assert ran.exit_code == 0, ran.output
    tree = read_result(tmp_path / "out" / "results.nc").tree
    series = tree["SWL/time/current"].to_dataset()
    assert float(series["time"][-1]) == pytest.approx(40.0)
    load = series["point_load"].sel(point=["point 1", "point 2"]).isel(time=-1).values[:, 0].sum()
    # the drag of the wire at 1 m/s, less half a segment at either end
    assert abs(load) == pytest.approx(0.5 * 1025.0 * 1.2 * 0.1 * 9.0 * 1.0**2, rel=0.12)
    early = series["point_load"].sel(point=["point 1", "point 2"]).sel(time=10.0, method="nearest").values[:, 0].sum()
    assert 0.2 < abs(early / load) < 0.4  # a quarter by the square of the speed, and the inertia of a rising current


FAULTS = {
    "another number of velocities": ("20.0  0.5 1.0 2.0", "20.0  0.5 1.0", "profile_dynamic.txt:8: 3 numbers"),
    "no number": ("20.0  0.5 1.0 2.0", "20.0  0.5 fast 2.0", ":8: a row is not all numbers"),
    "times that fall": ("40.0  0.5", "10.0  0.5", "do not rise"),
    "heights that fall": (" -20.0 -10.0 0.0", " -20.0 -30.0 0.0", "do not rise"),
}


@pytest.mark.parametrize("slip", list(FAULTS))
def test_slips_of_a_profile_are_reported_with_their_line(tmp_path, slip):
    old, new, words = FAULTS[slip]
    (tmp_path / "deck.txt").write_text(DECK.replace("KIND", "2"), encoding="utf-8")
    (tmp_path / "current_profile_dynamic.txt").write_text(PROFILE.replace(old, new), encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        read_deck(tmp_path / "deck.txt")
    assert [fault for fault in caught.value.faults if words in str(fault) and fault.line == 19], caught.value.faults


def test_slips_of_a_grid(tmp_path):
    path = tmp_path / "current_profile_4d.txt"
    for old, new, words in (
        ("2 1 2 3", "2 1 2", "four numbers of points"),
        ("-20 0\n", "-20\n", "expected 2 rising"),
        ("100 0 -20 20.0", "90 0 -20 20.0", "is at no point"),
        ("\n100 0 -20 20.0 0.0 0 0", "", "points of the grid have no velocity"),
    ):
        assert old in grid(), old
        path.write_text(grid().replace(old, new, 1), encoding="utf-8")
        with pytest.raises(InputError, match=words):
            read_current_field(path, "grid")


def test_no_file_and_what_moordyn_has_not_either(tmp_path):
    for kind, words in (
        (2, "no current_profile_dynamic.txt"),
        (5, "no current_profile_4d.txt"),
        (3, "MoorDyn has not"),
    ):
        (tmp_path / "deck.txt").write_text(DECK.replace("KIND", str(kind)), encoding="utf-8")
        with pytest.raises(CaseError) as caught:
            read_deck(tmp_path / "deck.txt")
        assert any(words in str(fault) for fault in caught.value.faults)
