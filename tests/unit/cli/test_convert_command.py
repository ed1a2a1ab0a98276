"""``moyai convert`` and ``moyai run`` with decks of MoorDyn."""

import json
import math
from pathlib import Path

import pytest
from typer.testing import CliRunner

from moyai.cli.main import app
from moyai.core.results import read_result
from moyai.interop.moordyn_case import case_text
from moyai.interop.moordyn_reader import read_deck

EXAMPLES = Path(__file__).resolve().parents[3] / "examples" / "network"
DECK = """--------------------- MoorDyn Input File ------------------------------------
a rope: that "snaps"
---------------------- LINE TYPES --------------------------------------------
TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx
(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
rope 0.04 9 1.0e8 -0.2 0 1.2 1.0 0.02 0.1
idle 0.05 9 1.0e8 1e4 0 1.2 1.0 0.02 0.0
---------------------- POINTS -------------------------------------------------
ID Type X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Fixed 0 0 -12 0 0 0 0
2 Free 22 0 -9 120 0.02 0.5 1.0
7 Coupled 43.9425 0 -2 0 0 0 0
---------------------- LINES --------------------------------------------------
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (name) (#) (#) (m) (-) (-)
1 rope 1 2 23 6 -
2 rope 2 7 23 6 -
---------------------- OPTIONS ------------------------------------------------
60 WtrDpth
1025 WtrDnsty
9.81 g
3e5 kBot
3e4 cBot
0.4 FrictionCoefficient
---------------------- need this line -----------------------------------------
"""


def invoke(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.fixture
def deck(tmp_path):
    path = tmp_path / "lines.txt"
    path.write_text(DECK, encoding="utf-8")
    return path


def test_a_deck_becomes_a_case_that_comes_to_the_same_rest(deck, tmp_path):
    from moyai.flexible.statics import solve_equilibrium
    from moyai.interop.moordyn_network import to_network

    assert invoke("convert", deck).exit_code == 0
    case = tmp_path / "lines.yaml"
    assert invoke("check", case).exit_code == 0
    assert invoke("run", case, "-o", tmp_path / "out", "-q", "--no-report").exit_code == 0
    rest = read_result(tmp_path / "out" / "results.nc").tree["SWL/statics"].to_dataset()
    network = to_network(read_deck(deck))
    direct = solve_equilibrium(network)
    for line in ("line 1", "line 2"):
        bars = network.strand(line).bars
        assert float(rest["line_tension_maximum"].sel(line=line)[0]) == pytest.approx(
            direct.tension[bars].max(), rel=1e-6
        )


def test_what_a_deck_says_in_other_measures_is_turned(deck):
    text = case_text(read_deck(deck))
    assert f"drag_tangential: {0.02 * math.pi!r}" in text
    assert "damping_ratio: 0.2" in text
    assert "# idle: no line is made of it" in text
    assert 'title: "a rope: that \\"snaps\\""' in text
    assert "friction: 0.4" in text
    assert "added_mass_coefficient: 1" in text


@pytest.mark.slow
def test_a_deck_runs_with_the_motion_of_a_coupled_point(deck, tmp_path):
    rows = "\n".join(f"{0.05 * k}, {0.3 * math.sin(0.05 * k)}, 0, 0" for k in range(161))
    (tmp_path / "surge.csv").write_text("time, x, y, z\n" + rows, encoding="utf-8")
    done = invoke("run", deck, "--motion", f"7={tmp_path / 'surge.csv'}", "-o", tmp_path / "out", "--json")
    record = json.loads(done.stdout)
    # the motion begins at 0.3 m/s out of rest: that jerk is distinguished, and the peak after it carries its band
    assert record["status"] == "converged", done.output
    highest, start = record["key_figures"][:2]
    assert "twice the segments" in highest["detail"]
    assert start["label"] == "Tension while the run starts"
    assert "it begins at 0.3 m/s" in start["detail"]
    assert (tmp_path / "out" / "case.yaml").is_file()
    assert (tmp_path / "out" / "report.html").is_file()
    tree = read_result(tmp_path / "out" / "results.nc").tree
    assert float(tree["SWL/time/still water"]["time"][-1]) == pytest.approx(8.0)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--motion", "1=a.csv"), "point 1 is not coupled"),
        (("--motion", "a.csv"), "no motion of a point"),
        (("--duration", "-3"), "--duration"),
    ],
)
def test_motions_that_fit_no_point_are_refused(deck, tmp_path, arguments, said):
    done = invoke("run", deck, *arguments, "-o", tmp_path / "out")
    assert done.exit_code == 2
    assert said in done.output


def test_faults_of_a_deck_come_with_their_lines(deck, tmp_path):
    deck.write_text(DECK.replace("WtrDpth", "WaterDpth").replace("7 Coupled", "7 Cupled"), encoding="utf-8")
    done = invoke("run", deck, "-o", tmp_path / "out")
    assert done.exit_code == 2
    assert "lines.txt:13" in done.output
    assert "lines.txt:20" in done.output
    assert not (tmp_path / "out" / "case.yaml").exists()


def test_a_case_becomes_a_deck_that_says_the_same(tmp_path):
    target = tmp_path / "snap.txt"
    assert invoke("convert", EXAMPLES / "snap.yaml", "-o", target).exit_code == 0
    read = read_deck(target)
    assert [point.kind for point in read.points] == ["fixed", "coupled"]
    assert read.lines[0].length == 46.0
    assert read.lines[0].segments == 20
    assert read.line_types[0].damping == 1e4
    assert read.line_types[0].drag_axial == pytest.approx(0.02, rel=1e-12)
    # what is there is not overwritten
    assert invoke("convert", EXAMPLES / "snap.yaml", "-o", target).exit_code == 2
    assert invoke("convert", EXAMPLES / "snap.yaml", "-o", target, "--force").exit_code == 0


def test_what_a_deck_cannot_say_is_named(tmp_path):
    done = invoke("convert", EXAMPLES / "buoy.yaml", "-o", tmp_path / "buoy.txt")
    assert done.exit_code == 2
    assert "partial immersion" in done.output
    assert not (tmp_path / "buoy.txt").exists()


def test_a_case_of_another_kind_has_no_deck(tmp_path):
    done = invoke("convert", EXAMPLES.parent / "pontoon.yaml", "-o", tmp_path / "a.txt")
    assert done.exit_code == 2
    assert "no deck" in done.output


def test_options_of_decks_are_refused_with_cases(tmp_path):
    done = invoke("run", EXAMPLES / "snap.yaml", "--duration", "5", "-o", tmp_path / "out")
    assert done.exit_code == 2
    assert "in itself" in done.output
