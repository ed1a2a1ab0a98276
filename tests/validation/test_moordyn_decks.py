"""Decks written for MoorDyn, read, run and held against the results stored with them and against exact solutions.

Sources: FloatingArrayDesign/MoorDyn, tests/Mooring (BSD-3-Clause); SMI-Lab-Inha/CableDyn, validation/bodies/cases/V-S1m
(Apache-2.0); MHKiT-Python, examples/data/mooring (BSD-3-Clause). Figures: docs/validation/moordyn_decks.md.
"""

import shutil
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipk

from moyai.core.errors import CaseError
from moyai.flexible.motion import Motion
from moyai.flexible.result import State
from moyai.flexible.simulation import simulate
from moyai.flexible.statics import solve_equilibrium
from moyai.interop.moordyn_deck import write_deck
from moyai.interop.moordyn_network import to_network, water_of
from moyai.interop.moordyn_output import read_output
from moyai.interop.moordyn_reader import read_deck
from moyai.interop.moordyn_waves import wave_components
from moyai.mooring.catenary import solve_catenary

pytestmark = pytest.mark.shared_data


@pytest.fixture(scope="module")
def decks(shared_data):
    return shared_data / "moordyn_decks"


def end_force(network, position, tension, last=True):
    """Force of line 1 on the point at one of its ends, weight of the last half segment included [N]."""
    strand = network.strand("line 1")
    bar = strand.bars[-1 if last else 0]
    node, other = strand.nodes[[-1, -2]] if last else strand.nodes[[0, 1]]
    along = position[..., other, :] - position[..., node, :]
    along /= np.linalg.norm(along, axis=-1)[..., None]
    kind = network.bars.types[network.bars.kind[bar]]
    force = tension[..., bar, None] * along
    force[..., 2] -= 0.5 * kind.submerged_weight_per_length(network.water) * network.bars.length[bar]
    return force


def end_tension(network, history, last=True):
    return np.linalg.norm(end_force(network, history.position, history.tension, last), axis=-1)


RUNS_HERE = (
    "BeamSimplySupported.txt", "BodiesAndRods.dat", "body_tests/bodyDrag.txt", "body_tests/pinnedBody.txt",
    "cabledyn_shared_anchor/moordyn.txt", "lines.txt", "local_euler/complex_system.txt",
    "lowe_and_langley_2006/line.txt", "openfast_output/TestInput.MD.dat", "pendulum.txt", "polyester/simple.txt",
    "polyester/visco.txt",
    "riser/riser.txt", "RodHanging.txt", "RodPinnedFloating.txt", "tripod.txt", "wavekin_current_1.txt",
    "wavekin_wave_1.txt", "WD0050_Chain.txt", "WD0200_Chain.txt",
)  # fmt: skip
REFUSED = {
    "3D_seafloor/hanging_lines.txt": ((55, "no wave_elevation.txt"),),
    "viv/viv.txt": ((6, "vortex-induced"),),
}  # fmt: skip


@pytest.mark.parametrize("name", RUNS_HERE)
def test_reads_and_comes_back_the_same(decks, tmp_path, name):
    deck = read_deck(decks / name)
    assert read_deck(write_deck(deck, tmp_path / "again.txt")) == deck


def test_waves_of_a_record_come_back_the_same(decks, tmp_path):
    """A sine of 1 m and 15 s; the deck calls it WaveKin 2, MoorDyn 2.7.2 3; it is written wave by wave."""
    deck = read_deck(decks / "wavekin_2/wavekin_2.txt")
    assert deck.waves is not None
    assert any("wave_elevation.txt is read" in note for note in deck.notes)
    sea = wave_components(deck.waves, water_of(deck))
    assert sea.omega == pytest.approx([2.0 * np.pi / 15.0])
    assert sea.amplitude == pytest.approx([1.0], abs=1e-9)
    again = read_deck(write_deck(deck, tmp_path / "again.txt"))
    assert again.waves == deck.waves
    assert again.number("WaveKin") == 7.0
    time = np.linspace(0.0, 14.9, 40)
    assert sea.elevation(time) == pytest.approx(np.sin(2.0 * np.pi * time / 15.0), abs=1e-9)


@pytest.mark.parametrize("name", sorted(REFUSED))
def test_what_is_not_read_is_named_with_its_line(decks, name):
    with pytest.raises(CaseError) as caught:
        read_deck(decks / name)
    for line, word in REFUSED[name]:
        assert any(fault.line == line and word in str(fault) for fault in caught.value.faults), (line, word)


def test_a_rope_that_has_borne_more_rests_at_the_mean_tension_of_its_deck(decks):
    """The deck places the end where its own working curve gives its Tmean0 (0.05 of the breaking load)."""
    deck = read_deck(decks / "syrope/quadratic_wc/line.txt")
    rest = solve_equilibrium(to_network(deck))
    assert rest.tension == pytest.approx([4.339e5], rel=1e-3)


@pytest.mark.slow
def test_a_pendulum_falls_on_a_bed_that_slopes(decks):
    """The grid is the plane z = x / 5 - 30 m; the ball starts on it, swings and comes down again."""
    deck = read_deck(decks / "seafloor.txt")
    network = to_network(deck)
    ball = network.points["point 2"]
    assert (deck.depth, deck.bed_under((25.0, 0.0))) == (500.0, pytest.approx(-25.0, abs=1e-9))
    history = simulate(network, duration=20.0, output_step=0.05, start=State.at_rest(network))
    over = history.position[:, ball, 2] - (0.2 * history.position[:, ball, 0] - 30.0)
    assert history.status == "converged"
    # the push that stops a ball of 10 kg sinks it by less than a millimetre
    assert -1e-3 < over.min() < 0.0
    assert over.max() > 1.0


def test_lines_hang_over_a_bed_that_slopes(decks, tmp_path):
    """The deck without its waves, whose record is not at hand: each line hangs by its own weight."""
    text = "\n".join(
        line
        for line in (decks / "3D_seafloor/hanging_lines.txt").read_text().splitlines()
        if "WaveKin" not in line and "dtWave" not in line
    )
    (tmp_path / "deck.txt").write_text(text)
    shutil.copy(decks / "3D_seafloor/seafloor_profile_3d.txt", tmp_path)
    network = to_network(read_deck(tmp_path / "deck.txt"))
    rest, kind = solve_equilibrium(network), network.bars.types[0]
    weight = kind.submerged_weight_per_length(network.water)
    for strand in network.strands:
        place = rest.state.position[strand.nodes]
        free = place[:, 2] > network.bed.level_at(place) + 0.1
        hung = weight * 10.0 * (1.0 - (np.arange(strand.bars.size) + 0.5) / strand.bars.size)
        if free.all():
            assert rest.tension[strand.bars] == pytest.approx(hung, rel=1e-6)
    assert network.bed.level_at([[45.0, 0.0]])[0] == pytest.approx(-21.0, abs=1e-9)


@pytest.mark.parametrize(
    ("name", "stored_fairlead", "stored_anchor"), [("WD0050", 991.6e3, 826.2e3), ("WD0200", 2065.4e3, 1402.2e3)]
)
def test_chains_at_rest(decks, name, stored_fairlead, stored_anchor):
    """The soft bed of these decks (0.13 m under the chain) is met by a catenary over a bed that much lower."""
    deck = read_deck(decks / f"{name}_Chain.txt")
    network = to_network(deck)
    rest = solve_equilibrium(network)
    kind, far, line = network.bars.types[0], deck.point(1).position, deck.lines[0]
    weight = kind.submerged_weight_per_length(network.water)
    sunk = weight / (network.bed.stiffness * kind.diameter)
    exact = solve_catenary(far[0], -far[2] + sunk, line.length, kind.axial_stiffness, weight)
    ends = [np.linalg.norm(end_force(network, rest.state.position, rest.tension, last)) for last in (True, False)]
    assert ends[0] == pytest.approx(float(exact.tension_fairlead), rel=4e-3)
    assert ends[1] == pytest.approx(float(exact.tension_anchor), rel=4e-3)
    assert ends == pytest.approx([stored_fairlead, stored_anchor], rel=0.02)


def test_bed_as_hard_as_can_be_gives_the_catenary(decks):
    deck = read_deck(decks / "WD0050_Chain.txt")
    hard = replace(deck, options=tuple(replace(o, value=1e9) if o.key == "kBot" else o for o in deck.options))
    network = to_network(hard, segments=328)
    rest = solve_equilibrium(network)
    force = end_force(network, rest.state.position, rest.tension)
    # exact elastic catenary on a rigid bed
    assert np.linalg.norm(force) == pytest.approx(1001.665e3, rel=1e-3)


def test_three_chains_to_one_anchor(decks):
    network = to_network(read_deck(decks / "cabledyn_shared_anchor/moordyn.txt"))
    rest = solve_equilibrium(network)
    stored = np.genfromtxt(decks / "cabledyn_shared_anchor/moordyn_c_static.csv", delimiter=",", names=True)
    expected = [float(stored[f"Point1F{axis}"]) for axis in "xyz"]
    assert end_force(network, rest.state.position, rest.tension, last=False) == pytest.approx(expected, rel=5e-5)


def test_beam_between_two_supports(decks):
    """Deflection of a beam whose ends cannot come closer, with the tension that follows from its own length."""
    deck = read_deck(decks / "BeamSimplySupported.txt")
    network = to_network(deck, segments=80)
    rest = solve_equilibrium(network)
    load, bending, stretching, span = 100.0 * 9.80665, 1e7, 1.5e9, 10.0
    x = np.linspace(0.0, span, 20001)

    def shape(tension):
        k = np.sqrt(tension / bending)
        bowl = np.cosh(k * (x - span / 2.0)) / np.cosh(k * span / 2.0) - 1.0
        return load / tension * (bending / tension * bowl + x * (span - x) / 2.0)

    def excess(tension):
        return 0.5 * np.trapezoid(np.gradient(shape(tension), x) ** 2, x) - tension * span / stretching

    tension = brentq(excess, 100.0, 1e5)
    assert 10.0 - rest.state.position[:, 2].min() == pytest.approx(shape(tension).max(), rel=1e-3)
    assert rest.tension[40] == pytest.approx(tension, rel=5e-3)


def test_pendulum(decks):
    """Exact period of a large swing, with the stretch and the inertia of the line."""
    deck = read_deck(decks / "pendulum.txt")
    network = to_network(deck)
    history = simulate(network, duration=100.0, output_step=0.02, start=State.at_rest(network))
    assert history.status == "converged"
    x = history.position[:, network.point("point 2"), 0]
    cut = np.flatnonzero(x[:-1] * x[1:] < 0.0)
    times = history.time[cut] - x[cut] * 0.02 / (x[cut + 1] - x[cut])
    kind, mass, gravity = network.bars.types[0], 1e5, 9.80665
    length = 100.5 * (1.0 + mass * gravity / kind.axial_stiffness)
    inertia = (mass + kind.mass_per_length * 100.5 / 3.0) * length**2
    swing = np.arctan2(10.0, 100.0)
    period = 4.0 * np.sqrt(inertia / (mass * gravity * length)) * ellipk(np.sin(swing / 2.0) ** 2)
    assert 2.0 * np.diff(times).mean() == pytest.approx(period, rel=2e-4)


@pytest.mark.slow
def test_lowe_and_langley_case_1(decks):
    """A flexible jumper whose top moves by 10 sin(2 pi t / 27) m, against the tension stored with the deck."""
    network = to_network(read_deck(decks / "lowe_and_langley_2006/line.txt"))
    rest = solve_equilibrium(network)
    # horizontal force ten bars below the top, where the bending of the end has died out: nothing pulls sideways between
    bar = len(network.bars) - 10
    step = rest.state.position[network.bars.end[bar]] - rest.state.position[network.bars.start[bar]]
    horizontal = rest.tension[bar] * step[0] / np.linalg.norm(step)
    vertical = -end_force(network, rest.state.position, rest.tension)[2]
    assert [horizontal, vertical] == pytest.approx([11.40e3, 45.71e3], rel=2e-3)
    stored = np.loadtxt(decks / "lowe_and_langley_2006/Case 1.csv", delimiter=",")
    motion = Motion.harmonic((10.0, 0.0, 0.0), 27.0, duration=82.0)
    history = simulate(
        network, {"point 2": motion}, duration=81.0, output_step=0.05, start=rest.state, method="tr_bdf2"
    )
    assert history.status == "converged"
    late = stored[:, 0] > 27.0
    found = np.interp(stored[late, 0], history.time, end_tension(network, history)) / 1e3
    assert found == pytest.approx(stored[late, 1], rel=0.015)
    assert np.corrcoef(found, stored[late, 1])[0, 1] > 0.999


@pytest.mark.parametrize(("name", "tolerance"), [("WD0050", 0.035), ("WD0200", 0.02)])
def test_chains_with_a_heaving_fairlead(decks, name, tolerance):
    """2 m of heave in 10 s; the swing at the anchor lies between that of Coulomb friction and that of a smooth bed."""
    deck = read_deck(decks / f"{name}_Chain.txt")
    given = np.loadtxt(decks / "QuasiStatic/ZZP1_A1.txt")
    stored = np.loadtxt(decks / f"QuasiStatic/{name}_Chain_ZZP1_A1.txt")
    grown = np.clip((given[:, 0] - given[0, 0]) / 5.0, 0.0, 1.0)
    motion = Motion.from_table(given[:, 0] - given[0, 0], given[:, 1:4] * (grown**2 * (3.0 - 2.0 * grown))[:, None])
    swing = []
    for friction in (0.5, 0.0):
        options = tuple(replace(o, value=friction) if o.key == "FrictionCoefficient" else o for o in deck.options)
        network = to_network(replace(deck, options=options))
        start = solve_equilibrium(network).state
        history = simulate(network, {"point 2": motion}, duration=30.0, output_step=0.1, start=start)
        assert history.status == "converged"
        # the stored rows start ten seconds after the motion; one more period to forget the start
        fairlead = end_tension(network, history)[200:]
        assert fairlead == pytest.approx(1e3 * stored[100:, 3], rel=tolerance)
        swing.append(np.ptp(end_tension(network, history, last=False)[200:]))
    assert swing[0] < 1e3 * np.ptp(stored[100:, 4]) < swing[1]


def test_output_of_moordyn_in_openfast(decks):
    output = read_output(decks / "openfast_output/Test.MD.out")
    assert (output.time.size, output.time[-1]) == (4801, 60.0)
    assert list(output.channels) == [f"{end}TEN{k}" for end in ("FAIR", "ANCH") for k in (1, 2, 3)]
    assert output.channel("FairTen2").max() == 1.603e6
