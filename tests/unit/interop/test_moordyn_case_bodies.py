"""Bodies and rods of decks as case files: the same bodies as from Python, at the same places, run from the command."""

import numpy as np
import pytest
from typer.testing import CliRunner

from moyai.case.builder import build
from moyai.case.reader import load_case
from moyai.cli.main import app
from moyai.core.errors import CaseError, InputError
from moyai.interop.moordyn_case import case_text, is_deck
from moyai.interop.moordyn_reader import read_deck
from moyai.interop.moordyn_system import to_system
from moyai.structures.network.assembly import assemble

HEAD = """a deck made at random
--- LINE TYPES ---
TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx
(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
rope 0.05 10 1e6 1e3 0 1.1 1.0 0.1 0
--- ROD TYPES ---
TypeName Diam Mass/m Cd Ca CdEnd CaEnd
(name) (m) (kg/m) (-) (-) (-) (-)
can 0.5 150 0.7 1.1 0.9 0.8
"""
TAIL = """--- OPTIONS ---
60 WtrDpth
0 TmaxIC
--- need this line ---
"""


def random_deck(seed):
    """A free body with two rods and a point, a pinned rod, a coupled body; every one on a rope."""
    rng = np.random.default_rng(seed)
    f = [f"{value:.6g}" for value in rng.uniform(0.5, 2.0, 24)]
    turn = " ".join(f"{a:.5g}" for a in rng.uniform(-60.0, 60.0, 3))
    return (
        HEAD
        + "--- BODIES ---\nID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG* I* Volume CdA* Ca*\n(#) (-)\n"
        + f"1 Free {f[0]} {f[1]} -{f[2]}e1 {turn} 2e3 {f[3]}|{f[4]}|{f[5]} 1e3|2e3|2.5e3 {f[6]} {f[7]}|{f[8]} 1|.5|2\n"
        + f"2 Coupled 20 {f[9]} -3 {turn} 0 0 0 0 0 0\n"
        + "--- RODS ---\nID RodType Attachment Xa Ya Za Xb Yb Zb NumSegs RodOutputs\n(#) (-)\n"
        + f"1 can Body1 0 0 -{f[10]} 0 0 {f[11]} 4 -\n2 can Body1 -{f[12]} {f[13]} 1 {f[14]} {f[13]} 1 30 -\n"
        + f"3 can Pinned -30 {f[15]} -20 -{f[16]}e1 {f[17]} -1{f[18]} 6 -\n4 can Free 0 30 -9 0 30 -9 0 -\n"
        + "--- POINTS ---\nID Type X Y Z Mass Volume CdA Ca\n(#) (-)\n"
        + f"1 Fixed 0 0 -60 0 0 0 0\n2 Body1 {f[19]} {f[20]} {f[21]} 30 0.02 0.4 0.6\n"
        + f"3 Body2 {f[22]} 0 {f[23]} 0 0 0 0\n"
        + "--- LINES ---\nID LineType AttachA AttachB UnstrLen NumSegs LineOutputs\n(#) (-)\n"
        + "1 rope 1 2 70 4 -\n2 rope 2 3 30 3 -\n3 rope R3B 3 90 3 -\n4 rope R1B R4A 60 3 -\n5 rope R4B 3 60 3 -\n"
        + TAIL
    )


@pytest.mark.parametrize("seed", range(6))
def test_a_case_holds_the_bodies_of_its_deck(tmp_path, seed):
    file = tmp_path / "deck.txt"
    file.write_text(random_deck(seed))
    deck = read_deck(file)
    wanted = to_system(deck)
    (tmp_path / "case.yaml").write_text(case_text(deck))
    problem = build(load_case(tmp_path / "case.yaml"))
    found = {plan.name: plan.body(wanted.network.water) for plan in problem.bodies}
    assert list(found) == list(wanted.bodies) == ["body 1", "rod 3"]
    for name, ours in found.items():
        theirs = wanted.bodies[name]
        for key in ("mass", "inertia", "centre_of_gravity", "position", "quadratic_damping"):
            np.testing.assert_allclose(getattr(ours, key), getattr(theirs, key), rtol=1e-9, atol=1e-9, err_msg=key)
        np.testing.assert_allclose(ours.start_rotation, theirs.start_rotation, atol=1e-9)
        assert (ours.pin is None) == (theirs.pin is None)
        for key in ("place", "volume", "length", "drag_area", "added_mass"):
            np.testing.assert_allclose(getattr(ours.lumps, key), getattr(theirs.lumps, key), rtol=1e-9, atol=1e-9)
    network = assemble(problem, 0.0).network
    assert set(network.points) == set(wanted.network.points)
    for name, node in network.points.items():
        there = wanted.network.nodes.position[wanted.network.points[name]]
        np.testing.assert_allclose(network.nodes.position[node], there, atol=1e-8, err_msg=name)


def test_coupled_bodies_follow_motions_and_pins_do_not(tmp_path):
    file = tmp_path / "deck.txt"
    file.write_text(random_deck(1).replace("3 can Pinned", "3 can CoupledPinned"))
    deck, surge = read_deck(file), tmp_path / "surge.csv"
    text = case_text(deck, motions={"body 2": surge}, duration=10.0)
    assert "point 3: {kind: driven" in text and text.count("motion: body 2") == 1
    assert "start: as_built" in text
    with pytest.raises(InputError, match=r"rod 3 is not coupled.*body 2.*pins of coupled"):
        case_text(deck, motions={"rod 3": surge})
    with pytest.raises(InputError, match=r"body 1 is not coupled"):
        case_text(deck, motions={"body 1": surge})


@pytest.mark.slow
def test_a_deck_of_rods_alone_runs_from_the_command(tmp_path):
    file = tmp_path / "deck.txt"
    rod = "--- RODS ---\nID RodType Attachment Xa Ya Za Xb Yb Zb NumSegs\n(#)\n1 can Pinned 0 0 -5 1 0 -5 2\n"
    file.write_text("rods\n" + HEAD.split("--- LINE TYPES")[0] + "--- ROD" + HEAD.split("--- ROD")[1] + rod + TAIL)
    assert is_deck(file)
    done = CliRunner().invoke(app, ["run", str(file), "--duration", "0.2", "-o", str(tmp_path / "out"), "--quiet"])
    assert done.exit_code == 0, done.output
    page = (tmp_path / "out" / "report.html").read_text()
    assert "Motion of rod 1" in page


def test_points_under_the_bed_are_reported_with_the_line_of_the_deck(tmp_path):
    file = tmp_path / "deck.txt"
    text = random_deck(2).replace("1 Fixed 0 0 -60", "1 Fixed 0 0 -61")
    file.write_text(text)
    line = next(number for number, row in enumerate(text.splitlines(), start=1) if row.startswith("1 Fixed"))
    with pytest.raises(
        CaseError, match=rf"deck.txt:{line}:1: .*point 1 at z = -61 m lies under the bed.*-60 m or more"
    ):
        case_text(read_deck(file))


def test_files_of_motions_that_are_not_there_are_reported(tmp_path):
    file = tmp_path / "deck.txt"
    file.write_text(random_deck(2))
    arguments = ["run", str(file), "--motion", f"body2={tmp_path / 'none.csv'}", "-o", str(tmp_path / "out")]
    done = CliRunner().invoke(app, arguments)
    assert done.exit_code == 2
    assert "none.csv', which body 2 follows" in done.output
