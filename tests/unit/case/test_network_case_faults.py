"""Mistakes in network cases: each reported once, with its place, what is allowed and how to mend it."""

from pathlib import Path

import pytest

from moyai.case.reader import load_case
from moyai.core.errors import CaseError

GOOD = """moyai: 1
title: Test
site: {water_depth: 30 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
structure:
  kind: network
  bed: {stiffness: 3e5 Pa/m, damping: 3e4 Pa s/m, friction: 0.5}
  line_types:
    rope: {diameter: 40 mm, mass: 9 kg/m, axial_stiffness: 20 MN, viscosity: 20 kN s, drag_normal: 1.2,
           drag_tangential: 0.06, added_mass_normal: 1}
  motions:
    surge: {kind: harmonic, amplitude: [1 m, 0, 0], period: 4 s, ramp: 4 s}
  points:
    anchor: {kind: fixed, position: [0, 0, bed]}
    fairlead: {kind: driven, position: [43 m, 0, -2 m], motion: surge}
  lines:
    rope: {start: anchor, end: fairlead, type: rope, length: 56 m, segments: 12}
analyses: [statics, dynamic]
settings: {duration: 8 s}
"""

MISTAKES = [
    ("kind: driven", "kind: drivn", "kind", "driven"),
    ("motion: surge", "motion: surg", "no motion 'surg'", "did you mean 'surge'"),
    ("start: anchor", "start: ancor", "no point 'ancor'", "did you mean 'anchor'"),
    ("type: rope", "type: rop", "no line type 'rop'", "did you mean 'rope'"),
    ("segments: 12", "segments: 0", "segments", "1"),
    ("length: 56 m", "length: -56 m", "out of range", "greater than 0"),
    ("length: 56 m", "length: 0", "out of range", "greater than 0"),
    ("mass: 9 kg/m", "mass: -9 kg/m", "out of range", "greater than 0"),
    ("viscosity: 20 kN s", "viscosity: -1", "out of range", "at least 0"),
    ("viscosity: 20 kN s,", "", "viscosity' or 'damping_ratio' is missing", ""),
    ("viscosity: 20 kN s", "viscosity: 20 kN s, damping_ratio: 0.1", "exclude each other", "keep one"),
    ("axial_stiffness: 20 MN", "axial_stiffnes: 20 MN", "unknown key 'axial_stiffnes'", "axial_stiffness"),
    ("period: 4 s", "period: 4 m", "period", "a time"),
    ("[43 m, 0, -2 m]", "[43 m, 0, -32 m]", "under the bed", "at least -30 m"),
    ("[43 m, 0, -2 m]", "[43 m, 0]", "position", ""),
    ("end: fairlead", "end: anchor", "starts and ends at 'anchor'", ""),
    ("amplitude: [1 m, 0, 0]", "amplitude: [1 m, 0, 29 m]", "drives 'fairlead' down to z = -31 m", "at least -30 m"),
    ("{duration: 8 s}", "{duration: 8 s, output_step: 9 s}", "leave nothing of the run", "at most 8 s"),
    ("{duration: 8 s}", "{duration: 1e9 s}", "never ends", "at most 172800 s"),
    ("lines:\n    rope:", "lines:\n    'a,b':", "bracket or comma", ""),
    ("{kind: harmonic, amplitude: [1 m, 0, 0], period: 4 s, ramp: 4 s}",
     "{kind: table, rows: [[0, 0, 0, 0], [5 s, 1, 0, 0]]}", "covers 0 to 5 s, the run 0 to 8 s", "lengthen the table"),
    ("{kind: harmonic, amplitude: [1 m, 0, 0], period: 4 s, ramp: 4 s}",
     "{kind: table, rows: [[0, 0, 0, 0], [5 s, 1, 0, 0], [4 s, 0, 0, 0]]}", "times do not rise", "rising times"),
    ("{kind: harmonic, amplitude: [1 m, 0, 0], period: 4 s, ramp: 4 s}", "{kind: table, file: no.csv}",
     "there is no file 'no.csv'", "paths count from the case file"),
    ("settings: {duration: 8 s}", "settings: {duration: 8 s, skip: 9 s}", "leave nothing of the run", "less than 8 s"),
    ("settings: {duration: 8 s}", "settings: {duration: 8 s, wave_front: true, method: tr_bdf2}", "explicit steps", ""),
    ("settings: {duration: 8 s}", "settings: {duration: 8 s, start: rest_in_current}", "no current to rest in", ""),
    ("settings: {duration: 8 s}", "settings: {duration: 8 s, resume: no.nc}", "there is no file 'no.nc'", ""),
    ("water_depth: 30 m", "water_depth: infinite", "finite water depth", ""),
    ("fairlead: {kind", "lost: {kind: fixed, position: [1, 2, -3]}\n    fairlead: {kind",
     "no line meets the point 'lost'",
     "join a line"),
    ("type: rope, length: 56 m", "type: rope", "'length' is missing", "number of segments"),
    ("axial_stiffness: 20 MN", "curve: {table: [[0, 1 kN], [0.1, 2 kN]]}", "[0, 0]", "begin with [0, 0]"),
    ("axial_stiffness: 20 MN", "curve: {table: [[0, 0], [0.1, 2 kN], [0.05, 3 kN]]}", "follows", "both rise"),
]  # fmt: skip


def faults_of(text, folder):
    path = folder / "case.yaml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        load_case(path)
    return caught.value.faults


def test_the_case_that_the_mistakes_start_from_is_sound(tmp_path):
    (tmp_path / "case.yaml").write_text(GOOD, encoding="utf-8")
    case = load_case(tmp_path / "case.yaml")
    assert case.warnings == ()


@pytest.mark.parametrize(("good", "bad", "said", "helps"), MISTAKES, ids=[f"{n}" for n in range(len(MISTAKES))])
def test_a_mistake_is_reported_once_with_its_place(tmp_path, good, bad, said, helps):
    assert good in GOOD
    faults = faults_of(GOOD.replace(good, bad, 1), tmp_path)
    texts = [str(fault) for fault in faults]
    assert any(said in text and helps in text for text in texts), texts
    assert len(faults) == 1, texts
    assert faults[0].line > 1


def test_parts_that_nothing_holds_are_named(tmp_path):
    text = GOOD.replace(
        "  lines:\n",
        "    a: {kind: free, position: [0, 9, -5], mass: 1}\n    b: {kind: free, position: [5, 9, -5], mass: 1}\n"
        "  lines:\n    loose: {start: a, end: b, type: rope, length: 6 m, segments: 3}\n",
    )
    faults = faults_of(text, tmp_path)
    assert len(faults) == 1
    assert "nothing holds" in faults[0].message
    assert faults[0].remedy


def test_a_table_names_the_line_of_its_fault(tmp_path):
    (tmp_path / "move.csv").write_text("time, x, y, z\n0, 0, 0, 0\n1, 0.1, 0\n", encoding="utf-8")
    text = GOOD.replace(
        "{kind: harmonic, amplitude: [1 m, 0, 0], period: 4 s, ramp: 4 s}", "{kind: table, file: move.csv}"
    )
    faults = faults_of(text, tmp_path)
    assert len(faults) == 1
    assert "move.csv, line 3: 3 numbers" in faults[0].message
    assert "4 finite numbers" in faults[0].allowed


def test_a_circular_motion_goes_round(tmp_path):
    import numpy as np

    from moyai.case.builder import build

    text = GOOD.replace(
        "{kind: harmonic, amplitude: [1 m, 0, 0], period: 4 s, ramp: 4 s}",
        "{kind: circular, radius: 0.7 m, period: 5 s, plane: xz}",
    )
    (tmp_path / "case.yaml").write_text(text, encoding="utf-8")
    motion = build(load_case(tmp_path / "case.yaml")).motions["surge"].over(10.0)
    place, velocity = motion.at(np.linspace(0.0, 10.0, 57))
    assert np.allclose(np.hypot(place[:, 0], place[:, 2]), 0.7, atol=1e-6)
    assert np.allclose(np.linalg.norm(velocity, axis=1), 0.7 * 2.0 * np.pi / 5.0, atol=1e-5)
    # with waves towards +x: forward at the top
    assert velocity[0, 0] > 0.0 and place[0, 2] > 0.69


EXAMPLES = sorted((Path(__file__).resolve().parents[3] / "examples" / "network").glob("*.yaml"))


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_examples_are_sound(example):
    reported = [item.message for item in load_case(example).warnings]
    # the waves of that flume are as steep as they were
    known = {"flume_box": ["linear theory neglects harmonics"]}.get(example.stem, [])
    assert len(reported) == len(known)
    assert all(words in message for words, message in zip(known, reported, strict=True))


def test_there_is_an_example_of_every_part():
    text = "".join(path.read_text(encoding="utf-8") for path in EXAMPLES)
    for part in (
        "lines:",
        "nets:",
        "sheets:",
        "bodies:",
        "motions:",
        "clump:",
        "along:",
        "kind: sphere",
        "current:",
        "coefficients_file:",
    ):
        assert part in text, part
