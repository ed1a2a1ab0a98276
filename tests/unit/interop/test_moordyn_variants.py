"""Decks as people write them: each variant of a small deck is read as the deck itself; guesses are noted."""

from pathlib import Path

import numpy as np
import pytest

from moyai.core.errors import CaseError
from moyai.interop.moordyn_case import case_text, is_deck
from moyai.interop.moordyn_reader import read_deck

DECK = """\
--------------------- MoorDyn Input File ------------------------------------
one chain and a clump weight
----------------------- LINE TYPES ------------------------------------------
TypeName   Diam    Mass/m     EA         BA/-zeta    EI         Cd     Ca     CdAx    CaAx
(name)     (m)     (kg/m)     (N)        (N-s/-)     (N-m^2)    (-)    (-)    (-)     (-)
chain      0.08    126.0      5.1e8      -0.8        0          1.6    1.0    0.1     0.5
---------------------- POINTS --------------------------------
ID    Type      X       Y       Z       Mass   Volume  CdA    Ca
(#)   (-)       (m)     (m)     (m)     (kg)   (m^3)   (m^2)  (-)
1     Fixed     90.0    1.5     -40.0   0      0       0      0
2     Coupled   0.0     0.0     -2.0    0      0       0      0
7     Free      60.0    1.0     -35.0   500    0.1     0.4    0.5
---------------------- LINES ----------------------------------------
ID   LineType   AttachA  AttachB  UnstrLen  NumSegs  LineOutputs
(#)   (name)     (#)      (#)       (m)       (-)     (-)
1     chain      1        7         35.0      7       p
2     chain      7        2         70.0      14      -
---------------------- OPTIONS -----------------------------------------
40            WtrDpth       water depth (m)
1.0e5         kBot          bottom stiffness
0.4           FrictionCoefficient
--------------------- OUTPUTS -------------------------------------------
FairTen1 FairTen2
END
------------------------- need this line --------------------------------------
"""
BODY = """\
--- MoorDyn ---
a body with a rod, a line on the end of the rod
--- LINE TYPES ---
TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx
(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
chain 0.08 126.0 5.1e8 -0.8 0 1.6 1.0 0.1 0.5
--- ROD TYPES ---
TypeName Diam Mass/m Cd Ca CdEnd CaEnd
(name) (m) (kg/m) (-) (-) (-) (-)
can 1.0 300 0.6 1.0 1.2 1.0
--- BODIES ---
ID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG* I* Volume CdA* Ca*
(#) (-) (m) (m) (m) (deg) (deg) (deg) (kg) (m) (kg-m^2) (m^3) (m^2) (-)
1 Coupled 0 0 -5 0 0 0 2e3 0 1e4 2 1 0.5
--- RODS ---
ID RodType Attachment Xa Ya Za Xb Yb Zb NumSegs RodOutputs
(#) (name) (#/key) (m) (m) (m) (m) (m) (m) (-) (-)
3 can Body1 0 0 -2 0 0 2 4 p
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Fixed 90 0 -40 0 0 0 0
2 Body1 0.5 0 0 0 0 0 0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (name) (#) (#) (m) (-) (-)
1 chain 1 R3A 105 21 p
2 chain 1 2 106 21 p
--- OPTIONS ---
40 WtrDpth
--- need this line ---
"""


def read(folder: Path, text: str):
    path = folder / "deck.txt"
    path.write_text(text, encoding="utf-8")
    return read_deck(path)


VARIANTS = {
    "text after the title": (("- LINE TYPES -", "- LINE TYPES of the whole array -"),),
    "title in small letters": (("LINE TYPES", "Line Types"), ("- POINTS -", "- Points -")),
    "dictionary, node properties": (
        ("LINE TYPES", "LINE DICTIONARY"), ("- POINTS -", "- NODE PROPERTIES -"), ("- LINES -", "- LINE PROPERTIES -"),
        ("- OPTIONS -", "- SOLVER OPTIONS -"),
    ),
    "connection properties": (("- POINTS -", "- CONNECTION PROPERTIES -"),),
    "title in words": (("- LINE TYPES -", "- DEFINITION OF LINE TYPES -"),),
    "ends called EndA, EndB": (("AttachA  AttachB", "EndA EndB"),),
    "ends called AttachAnch, AttachFair": (("AttachA  AttachB", "AttachAnch AttachFair"),),
    "ends of a name of their own": (("AttachA  AttachB", "From To"),),
    "points by place": (("ID    Type      X       Y       Z", "Nr   Kind  Easting Northing Height"),),
    "line types by place": (("TypeName   Diam    Mass/m     EA  ", "Kind  Thickness  Weight  Axial"),),
    "no units under the points": (("(#)   (-)       (m)     (m)     (m)     (kg)   (m^3)   (m^2)  (-)\n", ""),),
    "no units under the lines": (("(#)   (name)     (#)      (#)       (m)       (-)     (-)\n", ""),),
    "units without brackets": (("(#)   (name)     (#)      (#)       (m)       (-)     (-)", "- - - - m - -"),),
    "tabs": (("  ", "\t"),),
    "remarks and empty lines": (
        ("1     Fixed", "# the anchor\n\n1     Fixed"),
        ("-35.0   500    0.1     0.4    0.5", "-35.0 500 0.1 0.4 0.5 ! clump"),
    ),
    "other words for kinds": (
        ("Coupled   0.0", "Vessel    0.0"), ("1     Fixed", "1     Fix"), ("7     Free", "7     Connect"),
    ),
    "numbered vessel": (("Coupled   0.0", "Vessel1   0.0"),),
    "numbered coupling": (("Coupled   0.0", "Coupled1  0.0"),),
    "anchor": (("1     Fixed", "1     Anchor"),),
    "key before its value": (("40            WtrDpth ", "WtrDpth       40 "),),
    "equals": (("40            WtrDpth ", "WtrDpth = 40 "),),
    "options not known": (("0.4           Fric", "2 visualLevel how much\nhello greeting\n0.4           Fric"),),
    "options of the start": (("0.4           Fric", "0.01 ICthresh\n2 ICDfac\nTrue Echo\n0.4           Fric"),),
    "default": (("0.4           Fric", "DEFAULT g\n0.4           Fric"),),
    "segments with a point": (("35.0      7 ", "35.0      7.0 "),),
    "exponent of Fortran": (("5.1e8", "5.1D+08"),),
    "no flags": (("35.0      7       p", "35.0      7"), ("70.0      14      -", "70.0      14")),
    "other order of sections": "swap",
    "outputs with commas": (("FairTen1 FairTen2", "FairTen1, FairTen2"),),
    "no end of outputs": (("\nEND\n", "\n"),),
    "last rule missing": (("------------------------- need this line --------------------------------------\n", ""),),
    "more words in the last rule": (("need this line", "end of the file, need this line"),),
}  # fmt: skip


@pytest.mark.parametrize("variant", list(VARIANTS))
def test_variants_are_read_as_the_deck(tmp_path, variant):
    changes = VARIANTS[variant]
    text = DECK
    if changes == "swap":
        a, b, c = text.index("---------------------- POINTS"), text.index("---------------------- LINES"), text.index(
            "---------------------- OPTIONS"
        )  # fmt: skip
        text = text[:a] + text[b:c] + text[a:b] + text[c:]
    else:
        for old, new in changes:
            assert old in text, old
            text = text.replace(old, new) if variant == "tabs" else text.replace(old, new, 1)
    wanted, found = read(tmp_path, DECK), read(tmp_path, text)
    assert found.line_types == wanted.line_types
    assert found.points == wanted.points
    flags = [(line.number, line.line_type, line.start, line.end, line.length, line.segments) for line in found.lines]
    assert flags == [
        (line.number, line.line_type, line.start, line.end, line.length, line.segments) for line in wanted.lines
    ]
    for key in ("WtrDpth", "kBot", "FrictionCoefficient", "g", "WtrDnsty"):
        assert found.number(key) == wanted.number(key)
    assert found.outputs == wanted.outputs
    assert is_deck(tmp_path / "deck.txt")
    # what MoorDyn itself would not take so, or passes over, is said
    reported = {"ends of a name of their own": "by their place", "points by place": "by their place",
            "no units under the points": "would skip this row", "key before its value": "before its value",
            "options not known": "visualLevel (line 21), greeting (line 22)"}  # fmt: skip
    if variant in reported:
        assert any(reported[variant] in note for note in found.notes), found.notes


BODY_VARIANTS = {
    "rod called Rod3A": (("R3A", "Rod3A"),),
    "small letters": (("R3A", "r3a"),),
    "vessel": (("1 Coupled 0 0 -5", "1 Vessel 0 0 -5"),),
    "numbered vessel": (("1 Coupled 0 0 -5", "1 Coupled1 0 0 -5"),),
    "body of a point in small letters": (("2 Body1 0.5", "2 body1 0.5"),),
    "rods by place": (("ID RodType Attachment Xa Ya Za", "ID Kind On X Y Z"),),
    "bodies without units": (("(#) (-) (m) (m) (m) (deg) (deg) (deg) (kg) (m) (kg-m^2) (m^3) (m^2) (-)\n", ""),),
    "dictionary and lists": (
        ("ROD TYPES", "ROD DICTIONARY"), ("- BODIES -", "- BODY LIST -"), ("- RODS -", "- ROD LIST -"),
    ),
}  # fmt: skip


@pytest.mark.parametrize("variant", list(BODY_VARIANTS))
def test_variants_of_bodies_and_rods(tmp_path, variant):
    text = BODY
    for old, new in BODY_VARIANTS[variant]:
        assert old in text, old
        text = text.replace(old, new, 1)
    wanted, found = read(tmp_path, BODY), read(tmp_path, text)
    assert (found.bodies, found.rods, found.lines) == (wanted.bodies, wanted.rods, wanted.lines)
    own, other = ([row for row in case_text(deck).splitlines() if not row.startswith("#")] for deck in (found, wanted))
    assert own == other


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("2     Coupled", "2     Turbine1", "type of point is 'Turbine1'"),
        ("40            WtrDpth", "40            WtrDepht", "did you mean 'WtrDpth'"),
        ("- LINES -", "- LINS -", "did you mean 'LINES'"),
        ("AttachA  AttachB  UnstrLen", "UnstrLen Von Bis", "unknown column 'Von'"),
    ],
)
def test_what_could_mean_two_things_stays_a_fault(tmp_path, old, new, words):
    with pytest.raises(CaseError) as caught:
        read(tmp_path, DECK.replace(old, new, 1))
    assert any(words in str(fault) for fault in caught.value.faults), caught.value


def test_a_depth_from_elsewhere(tmp_path):
    deck = read(tmp_path, DECK.replace("40            WtrDpth       water depth (m)\n", ""))
    with pytest.raises(Exception, match="--depth of moyai run"):
        case_text(deck)
    assert "water_depth: 55" in case_text(deck.in_depth(55.0))
    assert deck.in_depth(None) is deck


def test_the_command_takes_the_depth(tmp_path):
    from typer.testing import CliRunner

    from moyai.cli.main import app

    path = tmp_path / "deck.dat"
    path.write_text(DECK.replace("40            WtrDpth       water depth (m)\n", ""), encoding="utf-8")
    ran = CliRunner().invoke(app, ["convert", str(path), "--depth", "55", "-o", str(tmp_path / "case.yaml")])
    assert ran.exit_code == 0, ran.output
    assert "water_depth: 55" in (tmp_path / "case.yaml").read_text(encoding="utf-8")
    ran = CliRunner().invoke(app, ["run", str(tmp_path / "case.yaml"), "--depth", "55"])
    assert ran.exit_code == 2


def test_a_file_of_depths_in_place_of_the_depth_and_from_another_folder(tmp_path):
    (tmp_path / "beds").mkdir()
    (tmp_path / "beds" / "flat.txt").write_text("2 2\n0 100\n-5 5\n0 -5 -40\n0 5 -40\n100 -5 -40\n100 5 -40\n")
    for option in ('"beds/flat.txt"  WtrDpth', "Mooring/beds/flat.txt SeafloorFile"):
        deck = read(tmp_path, DECK.replace("40            WtrDpth", option))
        assert deck.seafloor_depth == 40.0


def test_a_deck_without_water_falls_as_in_air(tmp_path):
    deck = read(tmp_path, DECK.replace("0.4           Fric", "0 WtrDnsty\n0.4           Fric"))
    from moyai.interop.moordyn_network import water_of

    assert 0.0 < water_of(deck).density <= 1e-3 * (1.0 + np.finfo(float).eps)
