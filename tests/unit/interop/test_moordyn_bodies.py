"""Bodies and rods of MoorDyn decks: read, written, made into rigid bodies; what is wrong with them is reported."""

import numpy as np
import pytest

from moyai.core.errors import CaseError, InputError
from moyai.interop.moordyn_case import case_text
from moyai.interop.moordyn_deck import write_deck
from moyai.interop.moordyn_network import to_network
from moyai.interop.moordyn_reader import read_deck
from moyai.interop.moordyn_system import to_system
from moyai.mooring.rotations import rotation_matrix

DECK = """--------------------- MoorDyn Input File ----------
bodies and rods
---------------------- LINE TYPES -----------------
TypeName Diam  Mass/m  EA      BA/-zeta EI  Cd  Ca  CdAx CaAx
(name)   (m)   (kg/m)  (N)     (N-s/-)  (-) (-) (-) (-)  (-)
rope     0.09  7.7     3.8E6   -0.3     0   1.6 1.0 0.1  0.0
---------------------- ROD TYPES ------------------
TypeName Diam  Mass/m  Cd   Ca   CdEnd CaEnd
(name)   (m)   (kg/m)  (-)  (-)  (-)   (-)
can      0.5   300.0   1.6  1.0  1.2   0.7
---------------------- BODIES ---------------------
ID  Attachment X0  Y0  Z0  r0 p0 y0 Mass  CG*         I*          Volume CdA*    Ca*
(#) (-)        (m) (m) (m) (-) (-) (-) (kg) (m)       (kg-m^2)    (m^3)  (m^2)   (-)
1   Free       0   0   -20 20 30 40 1000  0.1|0.2|0.3 100|200|250 0.5    1|2|3|4|5|6 0.5|0.6|0.7
2   Vessel     50  0   -20 0  0  90 1000  0.5         100         0.5    1|2     0.5
---------------------- RODS -----------------------
ID  RodType Attachment Xa  Ya  Za  Xb  Yb  Zb  NumSegs RodOutputs
(#) (name)  (#/key)    (m) (m) (m) (m) (m) (m) (-)     (-)
1   can     Free       -10 0   -30 -7  4   -18 6       -
2   can     Body1      0   0   2   0   0   6   3       -
3   can     Pinned     5   5   -9  6   5   -9  2       p
4   can     Free       3   3   -9  3   3   -9  0       -
---------------------- POINTS ---------------------
ID  Type   X   Y   Z   Mass Volume CdA Ca
(#) (-)    (m) (m) (m) (kg) (m^3)  (-) (-)
1   Fixed  -50 0   -40 0    0      0   0
2   Body1  1   2   3   7    0.1    0.2 0.5
3   Body2  1   0   0   0    0      0   0
---------------------- LINES ----------------------
ID  LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (name)   (#)     (#)     (m)      (-)     (-)
1   rope     1       R1A     60       10      -
2   rope     R1B     2       40       10      -
3   rope     R2B     R4A     30       6       -
4   rope     R4B     3       60       6       -
5   rope     R3B     1       90       6       -
---------------------- OPTIONS --------------------
150   WtrDpth
1000  WtrDnsty
9.81  g
--------------------- need this line --------------
"""


def deck_of(tmp_path, text=DECK):
    path = tmp_path / "deck.txt"
    path.write_text(text)
    return read_deck(path)


def test_comes_back_from_its_file_the_same(tmp_path):
    deck = deck_of(tmp_path)
    assert read_deck(write_deck(deck, tmp_path / "again.txt")) == deck
    body = deck.bodies[0]
    assert (body.angles, body.centre, body.drag_area) == ((20.0, 30.0, 40.0), (0.1, 0.2, 0.3), (1, 2, 3, 4, 5, 6))
    assert deck.bodies[1].drag_area == (1, 1, 1, 2, 2, 2)
    assert deck.lines[2].start == "R2B"
    assert [rod.kind for rod in deck.rods] == ["free", "body", "pinned", "free"]


def test_parts_make_one_body_as_in_moordyn(tmp_path):
    """Places of point 2 and of rod 2, added mass and buoyancy are those that MoorDyn 2.7.2 reports for these rows."""
    system = to_system(deck_of(tmp_path))
    body = system.bodies["body 1"]
    assert system.network.nodes.position[system.network.point("point 2")] == pytest.approx(
        [1.0500731497, 1.0662760009, -16.5706557667], abs=1e-9
    )
    assert body.mass == pytest.approx(1000.0 + 1200.0 + 7.0)
    moment = 1000.0 * np.array([0.1, 0.2, 0.3]) + 1200.0 * np.array([0, 0, 4.0]) + 7.0 * np.array([1, 2, 3.0])
    assert body.mass * np.asarray(body.centre_of_gravity) == pytest.approx(moment)
    volume = 0.25 * np.pi * 0.25 * 4.0
    assert body.lumps.volume.sum() == pytest.approx(0.5 + volume + 0.1)
    # rod 2: 1985.4 kg across and 1245.8 kg along with its own mass; body 250, 300, 350; point 50
    across, along = 1000.0 * volume, 2 * 0.7 * 1000.0 * 2.0 / 3.0 * np.pi * 0.25**3
    assert body.lumps.added_mass.sum(axis=0) == pytest.approx([250 + across + 50, 300 + across + 50, 350 + along + 50])
    rod = system.bodies["rod 1"]
    assert rod.points_at_start["rod 1 A"] == pytest.approx([-10.0, 0.0, -30.0])
    assert rod.points_at_start["rod 1 B"] == pytest.approx([-7.0, 4.0, -18.0])
    assert rotation_matrix(rod.rotation)[:, 2] == pytest.approx(np.array([3.0, 4.0, 12.0]) / 13.0)
    # the coupled body stands with its yaw of a quarter turn, the rod of no length joins its lines
    assert list(system.bodies) == ["body 1", "rod 1", "rod 3"]
    assert system.network.nodes.position[system.network.point("point 3")] == pytest.approx([50.0, 1.0, -20.0])
    assert system.network.strand("line 3").nodes[-1] == system.network.strand("line 4").nodes[0]
    assert any("rod 4 has no length" in note for note in system.notes)
    assert np.asarray(system.bodies["rod 3"].pin) == pytest.approx([0.0, 0.0, 0.0])


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        ("1   Free       0   0 ", "1   Pinned     0   0 ", 14, ("attachment of body is 'Pinned'", "CoupledPinned")),
        ("0.1|0.2|0.3", "0.1|0.2", 14, ("centre is '0.1|0.2'", "1 or 3 numbers")),
        ("1|2|3|4|5|6", "1|2|3|4", 14, ("drag area is", "1 or 2 or 3 or 6")),
        ("100|200|250", "-1", 14, ("inertia is '-1'", "0 or more")),
        ("2   Vessel ", "1   Vessel ", 15, ("two bodies have the ID 1",)),
        ("can      0.5 ", "can      0 ", 10, ("diameter is 0", "greater than 0")),
        ("2   can     Body1 ", "2   can     Body3 ", 20, ("body 3, which is not there", "1, 2")),
        ("2   can     Body1 ", "2   con     Body1 ", 20, ("no rod type 'con'", "can")),
        ("2   can     Body1 ", "2   can     Hung ", 20, ("attachment of rod is 'Hung'",)),
        ("3   3   -9  0 ", "3   3   -9  2 ", 22, ("2 segments and no length",)),
        ("3   rope     R2B ", "3   rope     R7B ", 34, ("rod 7, which is not there",)),
        ("2   Body1  1 ", "2   Body8  1 ", 27, ("body 8, which is not there",)),
    ],
)  # fmt: skip
def test_one_mistake_is_reported_with_its_line(tmp_path, old, new, line, words):
    assert old in DECK
    with pytest.raises(CaseError) as caught:
        deck_of(tmp_path, DECK.replace(old, new, 1))
    at_line = [str(fault) for fault in caught.value.faults if fault.line == line]
    assert any(all(word in text for word in words) for text in at_line), "\n".join(map(str, caught.value.faults))


def test_what_is_not_run_is_named_with_its_line(tmp_path):
    hinged = deck_of(tmp_path, DECK.replace("2   can     Body1 ", "2   can     Body1Pinned "))
    with pytest.raises(CaseError, match=r"deck.txt:20.*hinged to body 1"):
        to_system(hinged)
    leaning = deck_of(tmp_path, DECK.replace("Body1      0   0   2   0 ", "Body1      0   0   2   1 "))
    with pytest.raises(CaseError, match=r"deck.txt:20.*leans from the axes of body 1"):
        to_system(leaning)
    for wrong in (hinged, leaning):
        with pytest.raises(CaseError, match=r"deck.txt:20"):
            case_text(wrong)
    with pytest.raises(InputError, match=r"bodies or rods.*to_system"):
        to_network(deck_of(tmp_path))


def test_a_rod_of_no_segments_stands_at_its_end_a(tmp_path):
    """As MoorDyn's documentation writes clamps: the two ends only say where they point to."""
    plain = deck_of(tmp_path)
    clamp = deck_of(tmp_path, DECK.replace("3   3   -9  3   3   -9  0 ", "3   3   -9  4   3   -8  0 ", 1))
    assert clamp.rods == plain.rods
    assert any("rod 4 has 0 segments: it is at its end A" in note for note in clamp.notes)
