"""Waves of decks: frequencies as MoorDyn 2.7.2 takes them, records, decks to cases and back."""

import numpy as np
import pytest

from moyai.case.builder import build
from moyai.case.reader import load_case
from moyai.core.errors import CaseError, InputError
from moyai.interop.moordyn_case import case_text
from moyai.interop.moordyn_deck import write_deck
from moyai.interop.moordyn_network import flow_of, water_of
from moyai.interop.moordyn_reader import read_deck
from moyai.interop.moordyn_waves import wave_components
from moyai.structures.network.case.line_deck import deck_of_case
from moyai.structures.network.runs import run_plans

DECK = """--- LINE TYPES ---
TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx
(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
rope 0.05 10 1e6 1e3 0 1.1 1.0 0.1 0
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
(#) (-)
1 Fixed 0 0 -60 0 0 0 0
2 Coupled 40 0 0 0 0 0 0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (-)
1 rope 1 2 75 10 -
--- OPTIONS ---
60 WtrDpth
9.81 g
%s WaveKin
--- need this line ---
"""


def deck_of(folder, kind, files):
    for name, text in files.items():
        (folder / name).write_text(text)
    (folder / "deck.txt").write_text(DECK % kind)
    return read_deck(folder / "deck.txt")


def table(rows):
    return "\n".join(" ".join(repr(float(value)) for value in row) for row in rows)


@pytest.mark.parametrize("seed", range(4))
def test_frequencies_are_taken_as_moordyn_takes_them(tmp_path, seed):
    """Wave by wave Im(A e^{iwt}); on even frequencies Re(A e^{iwt})."""
    rng = np.random.default_rng(seed)
    omega = 0.1 * np.sort(rng.choice(np.arange(2, 30), 6, replace=False))
    rows = np.column_stack([omega, rng.normal(0.0, 1.0, (6, 2)), rng.uniform(-3.0, 3.0, 6)])
    deck = deck_of(tmp_path, "7", {"wave_frequencies.txt": table(rows)})
    sea = wave_components(deck.waves, water_of(deck))
    time, amplitude = rng.uniform(0.0, 100.0, 30), rows[:, 1] + 1j * rows[:, 2]
    np.testing.assert_allclose(sea.elevation(time), np.imag(np.exp(1j * np.outer(time, omega)) @ amplitude), atol=1e-9)
    np.testing.assert_allclose(sea.heading, rows[:, 3])
    # the deck comes back the same, and so does its case
    assert read_deck(write_deck(deck, tmp_path / "again.txt")) == deck
    (tmp_path / "case.yaml").write_text(case_text(deck, duration=30.0))
    plan = run_plans(build(load_case(tmp_path / "case.yaml")), water_of(deck))[0]
    assert plan.duration == 30.0
    np.testing.assert_allclose(plan.waves.elevation(time), sea.elevation(time), atol=1e-9)
    np.testing.assert_allclose(plan.waves.wave_number, sea.wave_number, rtol=1e-9)

    even = np.zeros((31, 3))
    even[:, 0] = 0.1 * np.arange(31)
    even[np.round(omega / 0.1).astype(int), 1:] = rows[:, 1:3]
    deck = deck_of(tmp_path, "2", {"wave_frequencies.txt": table(even)})
    sea = wave_components(deck.waves, water_of(deck))
    np.testing.assert_allclose(sea.elevation(time), np.real(np.exp(1j * np.outer(time, omega)) @ amplitude), atol=1e-9)


def test_gaps_of_the_even_frequencies_are_filled_by_straight_lines(tmp_path):
    deck = deck_of(tmp_path, "2", {"wave_frequencies.txt": "0 0 0\n0.2 1 0\n0.6 0 2\n"})
    found = dict(zip(np.round(deck.waves.omega, 9), wave_components(deck.waves, water_of(deck)).amplitude, strict=True))
    assert found == pytest.approx({0.2: 1.0, 0.4: np.hypot(0.5, 1.0), 0.6: 2.0})


def test_a_record_becomes_a_sea_of_the_case(tmp_path):
    time = np.arange(0.0, 90.0, 0.5)
    eta = 0.8 * np.cos(2.0 * np.pi * time / 9.0) - 0.3 * np.sin(2.0 * np.pi * time / 6.0)
    deck = deck_of(tmp_path, "3", {"wave_elevation.txt": table(np.column_stack([time, eta]))})
    case = tmp_path / "case.yaml"
    case.write_text(case_text(deck, folder=tmp_path))
    assert "kind: elevation_record" in case.read_text()
    plan = run_plans(build(load_case(case)), water_of(deck))[0]
    assert plan.duration == 90.0
    np.testing.assert_allclose(plan.waves.elevation(time), eta, atol=1e-9)
    np.testing.assert_allclose(flow_of(deck).waves.elevation(time), eta, atol=1e-9)


@pytest.mark.parametrize(
    ("kind", "files", "words"),
    [
        ("3", {}, ("deck.txt:17", "no wave_elevation.txt")),
        ("7", {}, ("deck.txt:17", "no wave_frequencies.txt")),
        ("3", {"wave_elevation.txt": "0 0\n1 1\n2 zero\n3 1\n"}, ("wave_elevation.txt:3", "time and elevation")),
        ("3", {"wave_elevation.txt": "0 0\n1 1\n1 0\n3 1\n"}, ("wave_elevation.txt", "1 s follows 1 s")),
        ("3", {"wave_elevation.txt": "0 0\n1 1\n"}, ("wave_elevation.txt", "2 rows")),
        ("7", {"wave_frequencies.txt": "0 0 0\n0.5 1\n"}, ("wave_frequencies.txt:2", "real and imaginary")),
        ("7", {"wave_frequencies.txt": "-0.5 1 0\n"}, ("wave_frequencies.txt", "-0.5 rad/s")),
        ("7", {"wave_frequencies.txt": "0 1 0\n0.5 0 0\n"}, ("no frequency has an amplitude",)),
        ("2", {"wave_frequencies.txt": "0.1 0 0\n0.2 1 0\n"}, ("do not rise from 0",)),
        ("2", {"wave_frequencies.txt": "0 0 0\n1e-6 1 0\n3 1 0\n"}, ("3000001 frequencies",)),
        ("5", {}, ("deck.txt:17", "kinematics at the nodes", "7: wave_frequencies.txt")),
    ],
)  # fmt: skip
def test_mistakes_are_reported_with_their_place(tmp_path, kind, files, words):
    with pytest.raises(CaseError) as caught:
        deck_of(tmp_path, kind, files)
    said = "\n".join(map(str, caught.value.faults))
    assert len(caught.value.faults) == 1
    assert all(word in said for word in words), said


CASE = """moyai: 1
title: a chain in a sea
site: {{water_depth: 60, density: 1025, gravity: 9.81}}
waves: {waves}
current: {{heading_deg: 40, profile: {{table: [[-60, 0.1], [-20, 0.5], [0, 1.2]]}}}}
structure:
  kind: network
  line_types:
    rope: {{diameter: 0.05, mass: 10, axial_stiffness: 1e6, viscosity: 1e3, drag_normal: 1.1, drag_tangential: 0.1,
           added_mass_normal: 1}}
  points:
    anchor: {{kind: fixed, position: [0, 0, -60]}}
    top: {{kind: driven, position: [40, 0, 0]}}
  lines:
    rope: {{start: anchor, end: top, type: rope, length: 75, segments: 10}}
analyses: [statics, dynamic]
settings: {{duration: 20}}
"""


def deck_from(tmp_path, waves):
    (tmp_path / "case.yaml").write_text(CASE.format(waves=waves))
    return deck_of_case(load_case(tmp_path / "case.yaml"))


def test_a_case_is_written_with_its_current_and_its_sea(tmp_path):
    deck = deck_from(tmp_path, "{kind: jonswap, significant_height: 3, peak_period: 9, peak_enhancement: 3.3, "
                               "heading_deg: 25, duration: 60}")  # fmt: skip
    again = read_deck(write_deck(deck, tmp_path / "deck.txt"))
    assert again == deck and again.number("WaveKin") == 7.0
    plan = run_plans(build(load_case(tmp_path / "case.yaml")), water_of(deck))[0]
    time, flow = np.linspace(0.0, 60.0, 50), flow_of(again)
    np.testing.assert_allclose(flow.waves.elevation(time), plan.waves.elevation(time), atol=1e-9)
    np.testing.assert_allclose(flow.waves.heading, np.radians(25.0))
    z = np.array([-60.0, -31.0, -10.0, 0.0])
    heading = np.radians(40.0)
    speed = np.interp(z, [-60.0, -20.0, 0.0], [0.1, 0.5, 1.2])
    found = flow.current.velocity(z)
    np.testing.assert_allclose(found, speed[:, None] * [np.cos(heading), np.sin(heading)], atol=0.01)
    assert any("current_profile.txt" in note for note in deck.notes)


def test_several_seas_are_not_written_and_reported(tmp_path):
    deck = deck_from(tmp_path, "{kind: regular, height: 2, periods: [6, 8], heading_deg: 0}")
    assert deck.waves is None
    assert any("2 seas, a deck one" in note for note in deck.notes)


def test_bodies_of_a_case_are_not_lost_in_a_deck(tmp_path):
    text = CASE.format(waves="{kind: regular, height: 2, period: 6, heading_deg: 0}")
    body = """  bodies:
    buoy: {shape: box, mass: 1000, inertia: [100, 100, 100], position: [40, 0, 0], size: [2, 2, 1], drag: [1, 1, 1],
           added_mass: [0.5, 0.5, 0.5], points: {top: [0, 0, -0.5]}}
"""
    text = text.replace("    top: {kind: driven, position: [40, 0, 0]}\n", "").replace("  lines:", body + "  lines:")
    (tmp_path / "case.yaml").write_text(text)
    with pytest.raises(InputError, match="the body 'buoy' cannot be written"):
        deck_of_case(load_case(tmp_path / "case.yaml"))
