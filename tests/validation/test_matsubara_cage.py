"""The model cage of Matsubara, Noda and Nishihira: statics, slack and taut moorings, line stiffness, faults in print.

Most numbers of the paper stood in figures that are lost. What its text says is held as ranges; the numbers of an
independent prototype of the same mechanics, which varied the missing anchors, stand in ``data/matsubara_cage.txt``.
Nothing here was fitted to them.
"""

import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from moyai.case.builder import build
from moyai.case.reader import load_case
from moyai.morison.net_law_names import net_law
from moyai.structures.cage.rigid.literal import FAULTS, literal_pack
from moyai.structures.cage.rigid.pack import pack
from moyai.structures.cage.rigid.runs import run_wave
from moyai.structures.cage.rigid.setup import resolve
from moyai.structures.cage.rigid.statics import equilibrium_with_lines, free_floating, reserve_buoyancy
from moyai.structures.cage.rigid.time import march
from moyai.structures.cage.rigid.waves import wave_of

ROOT = Path(__file__).parents[2]
GRAM = 9.81e-3  # N in a gram-force
ROWS = [
    [item.strip() for item in line.split(",")]
    for line in (Path(__file__).parent / "data" / "matsubara_cage.txt").read_text(encoding="utf-8").splitlines()
    if line and not line.startswith("#")
]


@cache
def problem():
    return build(load_case(ROOT / "src" / "moyai" / "reproduce" / "cases" / "matsubara" / "taut.yaml"))


@cache
def lines(kind, reach, stiffness, pull=0.011):
    """Return taut lines: crossed from the top corners, or outward from the bottom ones."""
    case = problem()
    plans = []
    for plan in case.plans:
        side = math.copysign(1.0, plan.attachment[0])
        crossed = kind == "crossed"
        plans.append(
            replace(
                plan,
                attachment=(0.1 * side, 0.1 if crossed else -0.1),
                anchor_x=-side * reach if crossed else side * reach,
                stiffness=stiffness,
                value=pull,
            )
        )
    return resolve(case.cage, tuple(plans), case.environment.water, case.kinematic_viscosity)


@cache
def numbers(kind, period, height, reach=0.3, stiffness=2000.0, pull=0.011, drag=True):
    """Return ranges over H, rotation [deg], peak tension [gf] of the offshore and shore line, phase x after z."""
    case = problem()
    cage = case.cage
    if not drag:
        law = net_law("matsubara", cap=1e-12)
        cage = replace(cage, law=law, rod_drag=0.0, floats=replace(cage.floats, drag=0.0))
        case = replace(case, cage=cage)
    water, viscosity = case.environment.water, case.kinematic_viscosity
    moored = () if kind == "slack" else lines(kind, reach, stiffness, pull)
    rest = equilibrium_with_lines(cage, moored, water, viscosity) if moored else free_floating(cage, water, viscosity)
    settings = replace(case.settings, tolerance=1e-5, settled_periods=10)
    wave = wave_of("linear", height, period, 0.0, water, 0.0, 30)
    found = run_wave(replace(case, settings=settings), moored, rest, water, wave).numbers
    turn = math.degrees(np.angle(np.exp(1j * (found.first_phase[0] - found.first_phase[1]))))
    peaks = found.line_tension_maximum[:, 0] / GRAM if moored else np.zeros(2)
    return {
        "sway": found.range[0] / height,
        "heave": found.range[1] / height,
        "rotation": math.degrees(0.5 * found.range[2]),
        "offshore": float(peaks[0]),
        "shore": float(peaks[1]),
        "phase": turn,
        "least": float(found.line_tension_minimum.min()) if moored else 0.0,
    }


def test_the_cage_at_rest_is_that_of_the_derivation():
    """81 % immersed, middle at -10.9 cm, G 0.9 cm above it, I = 4.72e-3, solid volume 37.1 cm3, reserve 75 gf."""
    case = problem()
    cage, water = case.cage, case.environment.water
    free = free_floating(cage, water, case.kinematic_viscosity)
    assert cage.mass_without_floats == pytest.approx(0.29105, rel=1e-6)
    assert cage.mass == pytest.approx(0.3635, abs=1e-4)
    assert cage.floats.volume == pytest.approx(33.76e-6, rel=1e-3)
    assert 1e6 * cage.solid_volume == pytest.approx(37.1, abs=0.4)
    assert cage.centre[1] == pytest.approx(0.009, abs=2e-4)
    assert cage.inertia == pytest.approx(4.72e-3, rel=0.01)
    assert free.immersion == pytest.approx(0.81, abs=0.01)
    assert free.middle_z == pytest.approx(-0.109, abs=5e-4)
    # 402 gf of listed floats leave 75; their volume by the diameter makes 405
    listed = reserve_buoyancy(cage, water) / GRAM - (cage.float_volume * 1e6 - 402.0)
    assert listed == pytest.approx(75.0, abs=1.0)


@pytest.mark.slow
@pytest.mark.parametrize("row", ROWS, ids=lambda row: " ".join(row[:4]))
def test_motions_of_the_prototype(row):
    """Within 8 % of its range: it marched a grid of twine panels with a step of 0.5 ms, this with other quadratures.

    Slack rotation at 1.6 s is held to 15 %: there the prototype's two digits do not fall with the period (2.2, 2.2).
    """
    kind, period, height, quantity, low, high = (
        row[0],
        float(row[1]),
        0.01 * float(row[2]),
        row[3],
        *map(float, row[4:6]),
    )
    if kind == "crossed":
        found = [numbers(kind, period, height, reach)[quantity] for reach in ((0.30, 0.35) if low < high else (0.30,))]
    elif kind == "outward":
        found = [numbers(kind, period, height, reach)[quantity] for reach in (0.45, 0.50)]
    else:
        found = [numbers(kind, period, height)[quantity]]
    slip = 0.15 if (kind, period, quantity) in (("slack", 1.6, "rotation"), ("slack", 1.4, "rotation")) else 0.08
    slip = max(slip, 0.013 / max(low, 1e-9))  # two digits in print
    if kind == "crossed" and quantity == "sway" and low < high:
        slip = 0.2  # anchors and pull of the lower end are not stated
    for value in found:
        assert low * (1.0 - slip) <= value <= high * (1.0 + slip)


@pytest.mark.slow
def test_statements_of_the_paper():
    """Taut: about a quarter of H both ways, +-6 degrees, shore line varies more; slack: about H, +-2 degrees."""
    taut = numbers("crossed", 1.1, 0.03)
    assert 0.15 <= taut["sway"] <= 0.40 and 0.15 <= taut["heave"] <= 0.40
    assert 4.5 <= taut["rotation"] <= 7.0
    assert taut["shore"] > 3.0 * taut["offshore"]
    for period in (1.0, 1.2, 1.4, 1.5):
        slack = numbers("slack", period, 0.03)
        assert 0.8 <= slack["sway"] <= 1.3 and 0.8 <= slack["heave"] <= 1.3
        assert 1.5 <= slack["rotation"] <= 4.5
        assert numbers("crossed", period, 0.03)["rotation"] / slack["rotation"] >= 1.5 - 0.05
        # the orbit is nearly a circle: quadrature but for the drag
        assert 65.0 <= abs(slack["phase"]) <= 100.0


def test_tension_swings_of_shore_and_offshore_line():
    """The line attached at the shore side 0 to 433 gf, at the offshore side 0 to 67 gf (prototype), T = 1.1 s."""
    for reach in (0.30, 0.35):
        found = numbers("crossed", 1.1, 0.03, reach)
        assert found["shore"] == pytest.approx(433.0, rel=0.12)
        assert found["offshore"] == pytest.approx(67.0, rel=0.45)
        assert found["least"] == 0.0


@pytest.mark.slow
def test_peaks_grow_with_the_root_of_the_stiffness():
    """230, 367, 646, 1097 gf at 1, 3, 10, 30 kN/m (prototype, outward): anchors at 0.5 m, 12 mm, 1.1 s give them."""
    wanted = {1e3: 230.0, 3e3: 367.0, 1e4: 646.0, 3e4: 1097.0}
    found = {k: numbers("outward", 1.1, 0.03, 0.5, k, 0.012) for k in wanted}
    for stiffness, peak in wanted.items():
        assert max(found[stiffness]["offshore"], found[stiffness]["shore"]) == pytest.approx(peak, rel=0.08)
    growth = math.log(max(found[3e4]["offshore"], 0.0) / found[1e3]["offshore"]) / math.log(30.0)
    assert growth == pytest.approx(0.5, abs=0.03)
    for quantity in ("sway", "rotation"):
        values = [item[quantity] for item in found.values()]
        assert max(values) / min(values) < 1.10
    # heave falls by a fifth, unlike the prototype's statement: soft lines give by millimetres that count at 12 mm
    assert 0.7 < found[3e4]["heave"] / found[1e3]["heave"] < 0.9


def test_without_drag_the_slack_cage_follows_the_orbit():
    """Its mass is that of the water it displaces, so that it moves with it; 2.0 H (prototype) is not reproduced."""
    for period in (1.2, 1.5, 2.0):
        water = problem().environment.water
        wave = wave_of("linear", 0.03, period, 0.0, water, 0.0, 1)
        orbit = 1.0 / math.tanh(2.0 * math.pi / wave.wavelength * water.depth)
        assert numbers("slack", period, 0.03, drag=False)["sway"] == pytest.approx(orbit, rel=0.05)


@pytest.mark.slow
def test_what_the_paper_says_and_this_does_not_find():
    """A taut orbit near a circle; heave that falls with growing H; rotation three times that of the slack cage."""
    taut = numbers("crossed", 1.1, 0.03)
    assert abs(taut["phase"]) < 40.0
    low, high = numbers("crossed", 1.1, 0.022), numbers("crossed", 1.1, 0.033)
    assert high["heave"] > low["heave"]
    assert taut["rotation"] / numbers("slack", 1.1, 0.03)["rotation"] < 2.5


@pytest.mark.parametrize("fault", [*FAULTS, "all"])
def test_printed_equations_fail_as_stated(fault):
    """One fault at a time on the sound equations, and all of them, at T = 1.1 s, H = 3 cm."""
    case = problem()
    cage, water = case.cage, case.environment.water
    kind = "outward" if fault == "line_signs" else "crossed"
    moored = lines(kind, 0.3 if kind == "crossed" else 0.475, 2000.0)
    rest = equilibrium_with_lines(cage, moored, water, case.kinematic_viscosity)
    wave = wave_of("linear", 0.03, 1.1, 0.0, water, 0.0, 20)
    sound = pack(cage, moored, water, case.kinematic_viscosity, waves=wave.components, ramp=5.5)
    chosen = tuple(FAULTS) if fault == "all" else (fault,)
    broken = literal_pack(sound, cage, water, chosen)
    start = np.concatenate([rest.place, np.zeros(3)])
    found = march(broken, start, duration=22.0, spacing=0.011, size=0.2, period=1.1, tolerance=1e-5)
    tail = found.state[found.time >= 11.0]
    if fault in ("line_signs", "all"):
        # lines that push: outward the cage is thrown out; crossed, the other faults together throw it
        assert found.status == "not_converged" or np.ptp(tail[:, 0]) > 5.0 * 0.03
        return
    assert found.status == "converged"
    sway, heave = np.ptp(tail[:, 0]) / 0.03, np.ptp(tail[:, 1]) / 0.03
    turn = math.degrees(0.5 * np.ptp(tail[:, 2]))
    if fault == "enclosed_volume":
        assert heave > 1.2 and found.tension_peak.max() / GRAM > 1700.0
    elif fault == "moment":
        assert turn > 20.0
    elif fault == "constant_buoyancy":
        # the rest of the floats is no spring any more: the cage turns over its lines
        assert abs(tail[:, 2].mean()) > 1.0
    elif fault == "single_force":
        assert turn > 1.15 * numbers("crossed", 1.1, 0.03)["rotation"]
    elif fault == "relative_acceleration":
        assert sway > 1.4 * numbers("crossed", 1.1, 0.03)["sway"]
    else:
        assert fault == "submerged_mass" and abs(turn - numbers("crossed", 1.1, 0.03)["rotation"]) > 0.05
