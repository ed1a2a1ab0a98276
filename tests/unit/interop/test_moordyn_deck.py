"""Reading MoorDyn decks: what a right one gives, and what each mistake says."""

import pytest

from moyai.core.errors import CaseError, InputError
from moyai.interop.moordyn_output import read_output
from moyai.interop.moordyn_reader import read_deck
from moyai.interop.moordyn_records import StiffnessTable

VERSION_2 = """\
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
2     Coupled   0.0     0.0     -2.0    0      0       0      0   # the fairlead
7     Free      60.0    1.0     -35.0   500    0.1     0.4    0.5
---------------------- LINES ----------------------------------------
ID   LineType   AttachA  AttachB  UnstrLen  NumSegs  LineOutputs
(#)   (name)     (#)      (#)       (m)       (-)     (-)
1     chain      1        7         35.0      7       p
2     chain      7        2         70.0      14      -
---------------------- OPTIONS -----------------------------------------
0.001         dtM           time step
40            WtrDpth       water depth (m)
1.0e5         kBot          bottom stiffness
0.4           FrictionCoefficient
--------------------- OUTPUTS -------------------------------------------
FairTen1 FairTen2
END
------------------------- need this line --------------------------------------
"""

VERSION_1 = """\
MoorDyn v1 input
--- LINE DICTIONARY ---
LineType  Diam  MassDenInAir  EA     BA/-zeta  Can  Cat  Cdn  Cdt
(-)       (m)   (kg/m)        (N)    (Pa-s/-)  (-)  (-)  (-)  (-)
chain     0.08  126.0         5.1e8  2.0e5     1.0  0.5  1.6  0.1
--- NODE PROPERTIES ---
Node Type     X     Y    Z     M    V    FX  FY  FZ  CdA  CA
(-)  (-)     (m)   (m)  (m)   (kg) (m^3) (kN) (kN) (kN) (m^2) (-)
1    Fix     90.0  1.5  -40.0  0    0    0   0   0   0    0
2    Vessel  0.0   0.0  -2.0   0    0    0   0   0   0    0
--- LINE PROPERTIES ---
Line LineType UnstrLen NumSegs NodeAnch NodeFair Flags/Outputs
(-)  (-)      (m)      (-)     (-)      (-)      (-)
1    chain    105.0    21      1        2        p
--- SOLVER OPTIONS ---
1e-3  dtM    - time step
1030  rhoW   - water density
3.0e4 kb     - bottom stiffness
2.0e3 cb     - bottom damping
40    WtrDpth
--- need this line ---
"""


def written(folder, text, name="deck.txt"):
    path = folder / name
    path.write_bytes(text.encode("latin-1"))
    return path


def faults_of(folder, text):
    with pytest.raises(CaseError) as caught:
        read_deck(written(folder, text))
    return caught.value.faults


def test_version_2(tmp_path):
    deck = read_deck(written(tmp_path, VERSION_2))
    kind = deck.line_type("chain")
    assert (kind.diameter, kind.mass_per_length, kind.stiffness, kind.damping) == (0.08, 126.0, 5.1e8, -0.8)
    assert (kind.drag_normal, kind.added_mass_normal, kind.drag_axial, kind.added_mass_axial) == (1.6, 1.0, 0.1, 0.5)
    assert [(p.number, p.kind, p.line) for p in deck.points] == [(1, "fixed", 10), (2, "coupled", 11), (7, "free", 12)]
    assert deck.point(7).added_mass_coefficient == 0.5
    assert [(n.start, n.end, n.length, n.segments, n.line) for n in deck.lines] == [
        (1, 7, 35.0, 7, 16),
        (7, 2, 70.0, 14, 17),
    ]
    assert deck.outputs == ("FairTen1", "FairTen2")
    assert (deck.number("WtrDpth"), deck.number("kBot"), deck.number("cBot"), deck.number("WtrDnsty")) == (
        40.0,
        1e5,
        3e5,
        1025.0,
    )
    assert deck.title == "one chain and a clump weight"
    assert [option.line for option in deck.options] == [19, 20, 21, 22]


def test_version_1_by_its_own_columns(tmp_path):
    deck = read_deck(written(tmp_path, VERSION_1))
    kind = deck.line_types[0]
    assert (kind.drag_normal, kind.added_mass_normal, kind.drag_axial, kind.added_mass_axial) == (1.6, 1.0, 0.1, 0.5)
    assert kind.bending_stiffness == 0.0 and kind.damping == 2e5
    assert deck.points[1].kind == "coupled"
    assert (deck.lines[0].length, deck.lines[0].segments, deck.lines[0].start, deck.lines[0].end) == (105.0, 21, 1, 2)
    assert (deck.number("WtrDnsty"), deck.number("kBot"), deck.number("cBot")) == (1030.0, 3e4, 2e3)
    assert any("another order" in note for note in deck.notes)


def test_line_ends_and_foreign_letters(tmp_path):
    text = VERSION_2.replace("(m^3)", "(m\xb3)").replace("\n", "\r\n")
    assert read_deck(written(tmp_path, text)) == read_deck(written(tmp_path, VERSION_2, "plain.txt"))


@pytest.mark.parametrize(
    ("old", "new", "line", "words"),
    [
        ("40            WtrDpth ", "40            WtrDpht ", 20, ("unknown option 'WtrDpht'", "'WtrDpth'")),
        ("40            WtrDpth ", "bed.txt       WtrDpth ", 20, ("'bed.txt'", "no number")),
        ("40            WtrDpth ", "-40           WtrDpth ", 20, ("WtrDpth is -40", "greater than 0")),
        ("1.0e5         kBot ", "kBot\n", 21, ("has no key",)),
        ("1.0e5         kBot ", "6     WaveKin", 21, ("kinematics on a grid", "7: wave_frequencies.txt")),
        ("1.0e5         kBot ", "1     Currents", 21, ("no current_profile.txt",)),
        ("2     chain      7 ", "2     chian      7 ", 17, ("no line type 'chian'", "did you mean 'chain'")),
        ("2     chain      7        2 ", "2     chain      7        5 ", 17, ("point 5", "1, 2, 7")),
        ("2     chain      7        2 ", "2     chain      7        7 ", 17, ("starts and ends at point 7",)),
        ("2     chain      7        2 ", "1     chain      7        2 ", 17, ("two lines have the ID 1",)),
        ("2     chain      7        2 ", "2     chain      R1A      2 ", 17, ("rod 1, which is not there",)),
        ("70.0      14 ", "-70.0     14 ", 17, ("length is -70", "greater than 0")),
        ("70.0      14 ", "70.0      0 ", 17, ("segments is '0'",)),
        ("70.0      14 ", "70.0      1.5 ", 17, ("segments is '1.5'",)),
        ("70.0      14      -", "70.0      14      -   9", 17, ("8 columns", "7: ID LineType")),
        ("7     Free ", "2     Free ", 12, ("two points have the ID 2",)),
        ("7     Free ", "7     Fre ", 12, ("type of point is 'Fre'", "did you mean 'free'")),
        ("7     Free ", "7     Body1 ", 12, ("on body 1, which is not there",)),
        ("1.0     -35.0   500 ", "1.0     -45.0   500 ", 12, ("under the bed",)),
        ("500    0.1 ", "-500   0.1 ", 12, ("mass is -500", "0 or more")),
        ("500    0.1     0.4    0.5", "500    0.1     0.4", 12, ("8 columns", "9: ID Type")),
        ("5.1e8 ", "-5.1e8 ", 6, ("stiffness is -5.1e+08",)),
        ("5.1e8 ", "1e8|2e8|0.4 ", 6, ("EA_s|EA_d",)),
        ("5.1e8 ", "rope.txt ", 6, ("'rope.txt'", "neither a number nor a file")),
        ("0.08    126.0 ", "0.08    heavy ", 6, ("mass per length is 'heavy'",)),
        ("0.08    126.0 ", "nan     126.0 ", 6, ("diameter is 'nan'",)),
        ("Ca     CdAx    CaAx", "CdAx   CuAx    CaAx", 4, ("unknown column 'CuAx'",)),
        ("(name)     (m)     (kg/m)", "chain2     0.1     100.0", 5, ("holds no units",)),
        ("--- OUTPUTS ---", "--- OUTPUUTS ---", 23, ("unknown section 'OUTPUUTS'", "OUTPUTS")),
        ("--- OUTPUTS ---", "--- CONTROL ---\nID Line\n(#) (#)\n1 1\n--- OUTPUTS ---", 23, ("CONTROL", "not read")),
        ("--- POINTS ---", "--- LINE TYPES ---", 7, ("a second time",)),
    ],
)  # fmt: skip
def test_one_mistake_is_reported_with_its_line(tmp_path, old, new, line, words):
    assert old in VERSION_2
    faults = faults_of(tmp_path, VERSION_2.replace(old, new, 1))
    at_line = [str(fault) for fault in faults if fault.line == line and fault.file == "deck.txt"]
    assert any(all(word in text for word in words) for text in at_line), "\n".join(map(str, faults))


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be", "utf-8-sig"])
def test_other_encodings_are_read(tmp_path, encoding):
    path = tmp_path / "wide.txt"
    path.write_bytes(VERSION_2.encode(encoding))
    assert read_deck(path) == read_deck(written(tmp_path, VERSION_2, "plain.txt"))


def test_tabs_are_blanks(tmp_path):
    text = VERSION_2.replace("  ", "\t")
    assert read_deck(written(tmp_path, text)) == read_deck(written(tmp_path, VERSION_2, "plain.txt"))


def test_bytes_that_are_no_text_are_reported(tmp_path):
    (tmp_path / "deck.txt").write_bytes(b"--- LINES ---\n\x00\x01\x02")
    with pytest.raises(InputError, match="no text file"):
        read_deck(tmp_path / "deck.txt")


@pytest.mark.parametrize(
    ("old", "new", "line", "word"),
    [
        ("LINE TYPES", "LINE TPYES", 3, "did you mean 'LINE TYPES'"),
        ("- POINTS -", "- PIONTS -", 7, "did you mean 'POINTS'"),
        ("- LINES -", "- LINS -", 13, "did you mean 'LINES'"),
        ("- OPTIONS -", "- OPTION -", 18, "did you mean 'OPTIONS'"),
        ("CdAx    CaAx", "CdAx", 4, "no column for added mass axial"),
        ("X       Y       Z", "X       Y", 8, "no column for z"),
        ("AttachB  UnstrLen", "UnstrLen AttachC", 14, "unknown column 'AttachC'"),
    ],
)
def test_one_slip_is_reported_once(tmp_path, old, new, line, word):
    """What follows from it, names and points that are not there, is not stated as well."""
    assert old in VERSION_2
    faults = faults_of(tmp_path, VERSION_2.replace(old, new, 1))
    said = "\n".join(map(str, faults))
    assert {fault.line for fault in faults} == {line}, said
    assert word in said


@pytest.mark.parametrize("section", ["LINE TYPES", "POINTS", "LINES"])
def test_missing_section(tmp_path, section):
    top = VERSION_2.index(f"--- {section} ---")
    bottom = VERSION_2.index("\n---", top)
    text = VERSION_2[: VERSION_2.rindex("\n", 0, top)] + VERSION_2[bottom:]
    assert any(f"section {section} is missing" in str(fault) for fault in faults_of(tmp_path, text))


def test_all_mistakes_at_once_in_the_order_of_the_file(tmp_path):
    text = VERSION_2.replace("5.1e8 ", "-1 ").replace("500    0.1 ", "x    0.1 ").replace("kBot ", "kBott ")
    faults = faults_of(tmp_path, text)
    assert [fault.line for fault in faults] == [6, 12, 21]


def test_empty_and_absent_files(tmp_path):
    with pytest.raises(InputError, match="empty"):
        read_deck(written(tmp_path, "  \n"))
    with pytest.raises(InputError, match="no such file"):
        read_deck(tmp_path / "nowhere.txt")


def test_stiffness_from_a_table(tmp_path):
    written(tmp_path, "Strain Tension\n(-) (N)\n0.0 0.0\n0.01 1.0e5\n0.03 4.0e5\n", "rope.txt")
    deck = read_deck(written(tmp_path, VERSION_2.replace("5.1e8 ", "rope.txt ")))
    assert deck.line_types[0].stiffness == StiffnessTable((0.0, 0.01, 0.03), (0.0, 1e5, 4e5), "rope.txt")
    written(tmp_path, "Strain Tension\n(-) (N)\n0.0 0.0\n0.01 1.0e5\n0.03 0.5e5\n", "rope.txt")
    assert "do not rise" in str(faults_of(tmp_path, VERSION_2.replace("5.1e8 ", "rope.txt "))[0])
    written(tmp_path, "Strain Tension\n(-) (N)\n0.0 0.0\n0.01 1.0e5 7\n", "rope.txt")
    fault = faults_of(tmp_path, VERSION_2.replace("5.1e8 ", "rope.txt "))[0]
    assert (fault.file, fault.line) == ("rope.txt", 4)


def test_flat_grid_of_depths(tmp_path):
    grid = "2 2\n-100 100\n-10 10\n-100 -10 -45.0\n-100 10 -45.0\n100 -10 -45.0\n100 10 {}\n"
    text = VERSION_2.replace("40            WtrDpth ", "far/away/grid.txt SeafloorFile ").replace("-40.0 ", "-45.0 ")
    written(tmp_path, grid.format(-45.0), "grid.txt")
    assert read_deck(written(tmp_path, text)).seafloor_depth == 45.0
    written(tmp_path, grid.format(-44.0), "grid.txt")
    sloped = read_deck(written(tmp_path, text.replace("-45.0 ", "-44.0 ")))
    assert sloped.seafloor_depth is None and sloped.depth == 45.0
    assert sloped.bed_under((50.0, 5.0)) == pytest.approx(-45.0 + 0.75 * 0.75, abs=1e-12)
    written(tmp_path, grid.format(-44.0).replace("100 -10 -45.0\n100", "-100 10 -45.0\n100"), "grid.txt")
    assert "is given twice in a grid of 2 by 2" in str(faults_of(tmp_path, text)[0])


def test_current_profile(tmp_path):
    text = VERSION_2.replace("1.0e5         kBot ", "1  Currents ")
    head = "--- MoorDyn steady currents File ---\ncurrents\nz (m), ux (m/s), uy (m/s), uz (m/s)\n"
    written(tmp_path, f"{head}-40 0.1 0 0\n0 0.5 0.2 0\n", "current_profile.txt")
    current = read_deck(written(tmp_path, text)).current
    assert current is not None and current.z == (-40.0, 0.0) and current.velocity == ((0.1, 0.0), (0.5, 0.2))
    written(tmp_path, f"{head}-40 0.1 0 0\n0 0.5 0.2 0.3\n", "current_profile.txt")
    fault = faults_of(tmp_path, text)[0]
    assert (fault.file, fault.line) == ("current_profile.txt", 5) and "vertical current" in fault.message


def test_output_in_si_units(tmp_path):
    output = read_output(
        written(tmp_path, "Time FairTen1 Point2px Rod1Roll\n(s) (kN) (m) (deg)\n0.0 1.5 2.0 180\n0.5 2.5 2.1 90\n")
    )
    assert list(output.time) == [0.0, 0.5]
    assert list(output.channel("fairten1")) == [1500.0, 2500.0]
    assert output.channel("Rod1Roll")[0] == pytest.approx(3.141592653589793)
    with pytest.raises(InputError, match="FairTen1, Point2px"):
        output.channel("FairTen2")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("Time A\n(s) (N)\n0 1\n1\n", ":4: 1 columns"),
        ("Time A\n(s) (N)\n0 1\n1 x\n", ":4: 2 columns, 1 of them"),
        ("Time A A\n(s) (N) (N)\n0 1 2\n", "is given twice"),
        ("Time A\n(s) (stone)\n0 1\n", "unit 'stone'"),
        ("0 1\n1 2\n", "starts with Time"),
        ("Time A\n(s) (N)\n", "no rows"),
    ],
)
def test_faulty_output(tmp_path, text, words):
    with pytest.raises(InputError, match=words):
        read_output(written(tmp_path, text))
