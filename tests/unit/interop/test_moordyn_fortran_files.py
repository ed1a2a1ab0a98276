"""What the documentation of MoorDyn's Fortran version names: depths by WtrDpth, WaterKin, friction of its own names."""

import math

import numpy as np
import pytest

from moyai.case.reader import case_of
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import CaseError, InputError
from moyai.interop.moordyn_case import case_text
from moyai.interop.moordyn_network import flow_of
from moyai.interop.moordyn_reader import read_deck

DECK = """\
--- MoorDyn ---
a chain
--- LINE TYPES ---
TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx Cl dF cF
(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-) (-) (-) (-)
chain 0.1 50 1e8 -0.8 0 1.2 1.0 0.1 0.0 0.0 0.08 0.18
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Fixed 250 0 -48 0 0 0 0
2 Coupled 0 0 -5 0 0 0 0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (name) (#) (#) (m) (-) (-)
1 chain 1 2 258 20 p
--- OPTIONS ---
50 WtrDpth
1025 rho
EXTRA
--- need this line ---
"""
WATER = """\
MoorDyn Waves and Currents input file
...any notes here...
--------------------------- WAVES -------------------------------------
1                    WaveKinMod  - type of wave input
"sub/eta.txt"        WaveKinFile - file containing wave elevation time series at 0,0,0
0.5                  dtWave      - time step to use in setting up wave kinematics grid (s)
30                   WaveDir     - wave heading (deg)
2                                - X wave input type
-800, 10, 101                    - X wave grid point data
--------------------------- CURRENT -------------------------------------
1                    CurrentMod  - type of current input
 z-depth     x-current      y-current
 (m)           (m/s)         (m/s)
 0.0             0.9          0.0
 20              0.5          0.0
 100             0.25         0.0
--------------------- need this line ------------------
"""


def deck_of(folder, option="", water="", **files):
    for name, text in {"water.dat": water or WATER, **files}.items():
        (folder / name).write_text(text)
    (folder / "sub").mkdir(exist_ok=True)
    time = np.arange(0.0, 60.0, 0.5)
    rows = np.column_stack([time, 0.3 * np.sin(2.0 * math.pi * time / 6.0)])
    (folder / "sub" / "eta.txt").write_text("\n".join(f"{t:.2f} {eta:.9f}" for t, eta in rows))
    (folder / "deck.txt").write_text(DECK.replace("EXTRA", option))
    return read_deck(folder / "deck.txt")


def case_is_sound(folder, deck):
    return case_of(parse_yaml(case_text(deck, duration=5.0, folder=folder), "deck"), folder / "case.yaml")


def test_waves_and_current_of_waterkin(tmp_path):
    """A sine of 0.3 m and 6 s that travels to 30 degrees, a current between the rows of its table."""
    deck = deck_of(tmp_path, '"Mooring/water.dat" WaterKin')
    assert deck.current is not None
    assert deck.current.z == (-100.0, -20.0, 0.0)
    assert deck.current.velocity == ((0.25, 0.0), (0.5, 0.0), (0.9, 0.0))
    assert deck.waves is not None
    assert set(deck.waves.direction) == {math.radians(30.0)}
    size = np.hypot(deck.waves.real, deck.waves.imaginary)
    top = int(np.argmax(size))
    assert size[top] == pytest.approx(0.3, rel=1e-6)
    assert deck.waves.omega[top] == pytest.approx(2.0 * math.pi / 6.0, rel=1e-9)
    assert np.delete(size, top).sum() < 1e-6
    flow = flow_of(deck)
    assert flow.waves is not None
    (sea,) = case_is_sound(tmp_path, deck).model.waves
    assert sea.heading_deg == pytest.approx(30.0)


@pytest.mark.parametrize("option", ['"" WaterKin', '"water.dat" WaterKin'])
def test_still_water(tmp_path, option):
    still = WATER.replace("1                    WaveKinMod", "0 WaveKinMod").replace(
        "1                    Curr", "0 Curr"
    )
    deck = deck_of(tmp_path, option, still)
    assert deck.waves is None and deck.current is None


@pytest.mark.parametrize(
    ("option", "water", "words"),
    [
        ("SEASTATE WaterKin", "", "WaterKin is 'SEASTATE': the waves of SeaState in OpenFAST are not read"),
        ('"other.dat" WaterKin', "", "WaterKin is 'other.dat': no file of that name"),
        ('"water.dat" WaterKin', WATER.replace("1                    WaveKinMod", "2 WaveKinMod"), "WaveKinMod is 2"),
        ('"water.dat" WaterKin', WATER.replace("1                    Curr", "2 Curr"), "CurrentMod is 2"),
        ('"water.dat" WaterKin', WATER.replace("sub/eta.txt", "eta.dat"), "there is no file WaveKinFile"),
        ('"water.dat" WaterKin', WATER.replace(" 20              0.5", " 20              x"), "water.dat:15"),
        ('"water.dat" WaterKin', WATER[: WATER.index(" 0.0             0.9")], "no row of current"),
    ],
)
def test_what_of_waterkin_is_not_read_is_named(tmp_path, option, water, words):
    with pytest.raises(CaseError) as caught:
        deck_of(tmp_path, option, water)
    assert words in str(caught.value)
    assert len(caught.value.faults) == 1


def test_depths_of_the_fortran_form(tmp_path):
    depths = "--- Bathymetry ---\nnGridX 2\nnGridY 3\n -300 300\n-50 47 51\n0 48 52\n60 48 53\n"
    (tmp_path / "depths.txt").write_text(depths)
    path = tmp_path / "deck.txt"
    path.write_text(DECK.replace("50 WtrDpth", '"depths.txt" WtrDpth').replace("EXTRA\n", ""))
    deck = read_deck(path)
    assert deck.seafloor is not None
    assert set(deck.seafloor.rows) == {
        (-300.0, -50.0, -47.0), (300.0, -50.0, -51.0), (-300.0, 0.0, -48.0), (300.0, 0.0, -52.0),
        (-300.0, 60.0, -48.0), (300.0, 60.0, -53.0),
    }  # fmt: skip
    case_is_sound(tmp_path, deck)
    (tmp_path / "depths.txt").write_text(depths.replace("0 48 52", "0 48"))
    with pytest.raises(CaseError, match=r"line 6 of depths\.txt: a row is not y and a depth at every x"):
        read_deck(path)


def test_friction_along_the_line_counts_and_vibration_without_lift_does_not(tmp_path):
    deck = deck_of(tmp_path, "0.3 mu_kT\n0.5 mu_kA\n1.0 mc\n200 cv")
    assert deck.number("FrictionCoefficient") == 0.5
    assert any("mu_kA replaces FrictionCoefficient" in note for note in deck.notes)
    with pytest.raises(CaseError, match="vortex-induced vibration"):
        (tmp_path / "deck.txt").write_text(DECK.replace("EXTRA\n", "").replace("0.0 0.08 0.18", "0.8 0.08 0.18"))
        read_deck(tmp_path / "deck.txt")


def test_a_steady_current_that_turns_is_run_through_time(tmp_path):
    profile = "title\nrows\nz ux uy uz\n-50 0.1 0 0\n-10 0.5 0.1 0\n0 0.8 0.2 0\n"
    deck = deck_of(tmp_path, "1 Currents", **{"current_profile.txt": profile})
    case = case_is_sound(tmp_path, deck)
    from moyai.case.builder import build

    velocity, _ = build(case).current_field.at(3.0, np.array([[0.0, 5.0], [0.0, 7.0], [-30.0, -5.0]]))
    assert np.allclose(velocity, [[0.3, 0.65], [0.05, 0.15], [0.0, 0.0]])
    with pytest.raises(InputError, match="varies with depth"):
        case_text(deck)
