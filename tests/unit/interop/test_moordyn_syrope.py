"""Syrope ropes of decks: working curves by their definition, history of each line, what is refused."""

import math
import re

import numpy as np
import pytest

from moyai.case.builder import build
from moyai.case.reader import case_of
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import CaseError, InputError
from moyai.flexible.statics import solve_equilibrium
from moyai.flexible.worn_law import WornRope
from moyai.interop.moordyn_case import case_text
from moyai.interop.moordyn_deck import write_deck
from moyai.interop.moordyn_network import to_network
from moyai.interop.moordyn_reader import read_deck
from moyai.interop.moordyn_records import StiffnessTable
from moyai.interop.moordyn_syrope import working_curve

NEW = StiffnessTable((0.0, 0.01, 0.03, 0.06), (0.0, 4e5, 1.2e6, 3e6), "owc.dat")
DECK = """----- MoorDyn Input File -----
ropes
----- LINE TYPES -----
TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx
(-) (-) (-) (-) (-) (-) (-) (-) (-) (-)
poly 0.2 32.2 SYROPE:law.dat|1.5e8|20 5e10|1e5 0 1 1 0 0
----- POINTS -----
ID Type X Y Z M V CdA Ca
(-) (-) (-) (-) (-) (-) (-) (-) (-)
1 Fixed 0 0 -30 0 0 0 0
2 Fixed 101.8 0 -30 0 0 0 0
3 Fixed 0 101.8 -30 0 0 0 0
----- LINES -----
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
(-) (-) (-) (-) (-) (-) (-)
1 poly 1 2 100 4 -
2 poly 1 3 100 4 -
----- SYROPE IC -----
Line(s) Tmax0 Tmean0
(-) (N) (N)
1 1.2e6 5e5
----- OPTIONS -----
40 WtrDpth
9.81 g
"""


def written(folder, deck=DECK, form="QUADRATIC", k1="0.25", k2="1.0"):
    (folder / "owc.dat").write_text("Strain Tension\n(-) (N)\n0 0\n0.01 4e5\n0.03 1.2e6\n0.06 3e6\n")
    (folder / "law.dat").write_text(f"owc.dat OWC table\n{form} WCType\n{k1} k1\n{k2} k2\n")
    (folder / "deck.txt").write_text(deck)
    return folder / "deck.txt"


@pytest.mark.parametrize(
    ("form", "k1", "k2", "left", "share"),
    [
        ("LINEAR", 0.25, 0.0, 0.0075, 0.5),
        ("LINEAR", 8e7, 0.0, 0.015, 0.5),
        ("QUADRATIC", 0.25, 1.0, 0.0075, 0.25),
        ("EXP", 0.25, 1.5, 0.0075, (math.exp(0.75) - 1.0) / (math.exp(1.5) - 1.0)),
    ],
)
def test_working_curves_by_their_definition(form, k1, k2, left, share):
    """From the strain that is left at no tension to the original curve at the highest one, 1.2 MN at 3 %."""
    worn = working_curve(NEW, form, k1, k2, 1.2e6)

    def pull(strain):
        return float(np.interp(strain, worn.strain, worn.tension))

    assert pull(left) == pytest.approx(1.2, abs=1e-9)
    assert pull(0.5 * (left + 0.03)) == pytest.approx(share * 1.2e6, rel=1e-3)
    assert (pull(0.03), pull(0.045), pull(0.06)) == pytest.approx((1.2e6, 2.1e6, 3e6))
    assert np.all(np.diff(worn.strain) > 0.0)
    assert np.all(np.diff(worn.tension) > 0.0)
    assert working_curve(NEW, form, k1, k2, 0.0) == NEW


def test_lines_follow_the_curve_of_what_they_have_borne(tmp_path):
    deck = read_deck(written(tmp_path))
    assert [line.line_type for line in deck.lines] == ["poly after 1.2e+06 N", "poly"]
    law = deck.line_type("poly after 1.2e+06 N").syrope
    assert law is not None
    assert (law.highest, law.mean, law.alpha, law.beta, law.damping) == (1.2e6, 5e5, 1.5e8, 20.0, 5e10)
    network = to_network(deck)
    rest = solve_equilibrium(network)
    # 1.8 % of the new rope: 0.72 MN; of the worn one the square of 7/15 of 1.2 MN, next to no weight
    by_hand = {"line 1": 1.2e6 * ((0.018 - 0.0075) / 0.0225) ** 2, "line 2": 7.2e5}
    for strand in network.strands:
        assert rest.tension[strand.bars].mean() == pytest.approx(by_hand[strand.name], rel=1e-3)
    assert any("runs begin at rest after 1.2e+06 N" in note for note in deck.notes)


def test_a_case_of_the_deck_has_the_law_of_each_line(tmp_path):
    """The curve of the new rope and what it has borne; at rest and through time it is the network of the deck."""
    deck = read_deck(written(tmp_path))
    text = case_text(deck, duration=10.0)
    found = build(case_of(parse_yaml(text, "deck.yaml"), tmp_path / "deck.yaml"))
    worn, new = (line.parts[0].bar_type.slow for line in found.lines)
    assert isinstance(worn, WornRope)
    assert (worn.form, worn.k1, worn.k2) == ("quadratic", 0.25, 1.0)
    assert (worn.stiffness, worn.growth, worn.viscosity, worn.highest) == (1.5e8, 20.0, 5e10, 1.2e6)
    assert np.array_equal(worn.new_tension, NEW.tension)
    assert new.highest == 0.0
    slow = [kind.slow for kind in to_network(deck).bars.types]
    assert sorted(law.highest for law in slow) == [0.0, 1.2e6]
    with pytest.raises(CaseError, match="a worn rope has no curve"):
        without = re.sub(r"curve: \{.*?\]\]\}", "axial_stiffness: 1e8", text)
        case_of(parse_yaml(without, "deck.yaml"), tmp_path / "deck.yaml")


def test_what_is_not_run_is_refused_by_name(tmp_path):
    deck = read_deck(written(tmp_path))
    assert "after 1.2e+06 N" in case_text(deck)
    with pytest.raises(InputError, match="files are not written"):
        write_deck(deck, tmp_path / "again.txt")
    for changes, said in (
        ({"k2": "0.5"}, "quadratic with k2 = 0.5"),
        ({"k1": "1.25"}, "quadratic with k1 = 1.25"),
        ({"form": "CUBIC"}, "WCType 'CUBIC'"),
        ({"deck": DECK.replace("1.2e6 5e5", "3.2e6 5e5")}, "highest mean tension of 3.2e"),
        ({"deck": DECK.replace("1.2e6 5e5", "1.2e6 5e6")}, "Tmean0 of 5e"),
        ({"deck": DECK.replace("1 1.2e6", "7 1.2e6")}, "line '7' is none of a Syrope rope"),
        ({"deck": DECK.replace("|1.5e8|20", "|1.5e8")}, "SYROPE:law.dat"),
        ({"deck": DECK.replace("law.dat", "other.dat")}, "no file other.dat"),
    ):
        with pytest.raises(CaseError) as caught:
            read_deck(written(tmp_path, **changes))
        assert said in str(caught.value)
