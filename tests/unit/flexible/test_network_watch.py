"""What the engine looks at next to its result, what it refuses instead of cutting, energy of random chains."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from networks_for_tests import DEEP, random_network, rope, still

from moyai.core.errors import InputError
from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import Bars, BarType, Nodes, Strand
from moyai.flexible.explicit import ExplicitRun
from moyai.flexible.flow import Flow
from moyai.flexible.modes import natural_modes
from moyai.flexible.motion import Motion
from moyai.flexible.refine import more_viscous, refined
from moyai.flexible.result import State
from moyai.flexible.sensitivity import PeakSensitivity, peak_sensitivity
from moyai.flexible.simulation import simulate
from moyai.flexible.statics import solve_equilibrium
from moyai.sea.water import Water
from moyai.series.snaps import find_snaps

TIME, PULL = np.arange(5.0), np.array([0.0, 1.0, 2.0, 1.0, 0.0])
KIND = BarType("rope", 2.0, 1e6, 0.02)


def _builder():
    builder = NetworkBuilder(Water(50.0, 1025.0, 9.81))
    builder.fixed("a", (0.0, 0.0, -10.0))
    builder.fixed("b", (3.0, 0.0, -10.0))
    return builder


def _line(**more):
    return _builder().line("x", "a", "b", KIND, **{"length": 3.1, "segments": 4, **more})


def _run(**more):
    return simulate(rope(segments=4), {"end": still()}, **{"duration": 0.1, "output_step": 0.05, **more})


def _peak(**more):
    options = {"bar": 1, "duration": 0.1, "output_step": 0.05, **more}
    return peak_sensitivity(rope(segments=4, viscosity=10.0), {"end": still()}, **options)


SILENT = {
    "fraction of a bar": (lambda: _run(keep_bars=[1.7]), "keep_bars holds 1.7"),
    "no bar": (lambda: _run(keep_bars=[float("nan")]), "keep_bars holds nan"),
    "mask of bars": (lambda: _run(keep_bars=[True, False, True, True]), "true and false"),
    "name of a bar": (lambda: _run(keep_bars=["top"]), "no number"),
    "table of bars": (lambda: _run(keep_bars=[[0, 1]]), "shape"),
    "negative node": (lambda: _run(keep_nodes=[-1, 2]), "names -1 of 5"),
    "fraction of a load step": (lambda: _run(load_steps=1.5), "load_steps holds 1.5"),
    "endless step": (lambda: _run(step=math.inf), "step is inf"),
    "start at no time": (
        lambda: _run(start=State(math.nan, rope(segments=4).nodes.position, np.zeros((5, 3)))), "time of the start",
    ),
    "fraction of a segment": (lambda: _line(segments=2.5), "2.5 segments"),
    "true segment": (lambda: _line(segments=True), "True segments"),
    "misspelt shape": (lambda: _line(shape="streight"), "shape of line 'x' is 'streight'"),
    "places turned over": (lambda: _line(shape=np.zeros((3, 3)).T[:2].T), r"shape \(3, 2\)"),
    "places in a row": (lambda: _line(shape=np.arange(9.0)), r"shape \(9,\)"),
    "misspelt top of a net": (
        lambda: _builder().net("n", np.zeros((2, 2, 3)), KIND, lengths=(1.0, 1.0), top="fix"), "top: .*fixed",
    ),
    "three lengths of a net": (
        lambda: _builder().net("n", np.zeros((2, 2, 3)), KIND, lengths=(1.0, 1.0, 2.0)), "lengths of net",
    ),
    "misspelt row of a sheet": (
        lambda: _builder().sheet("s", np.zeros((2, 2, 3)), warp=[0, 1], weft=[0, 1], first_row="fix"), "row: .*fixed",
    ),
    "two held components": (lambda: _builder().free("c", (0, 0, -1), mass=1.0, held=(True, True)), "held of 'c'"),
    "half a form": (lambda: _builder().free("c", (0, 0, -1), mass=1.0, form=0.5), "form of 'c' is 0.5"),
    "fraction of a node": (lambda: Bars([0.6], [1], [1.0], [0], (KIND,)), "bars.start holds 0.6"),
    "bar between true and false": (lambda: Bars([True], [False], [1.0], [0], (KIND,)), "true and false"),
    "kind of a node": (lambda: Nodes(np.zeros((1, 3)), [0.5]), "nodes.kind holds 0.5"),
    "held by halves": (lambda: Nodes(np.zeros((1, 3)), [0], held=[[0.5, 0, 0]]), "neither true nor false"),
    "fraction in a strand": (lambda: Strand("s", [0, 1.2], [0]), "strand.nodes holds 1.2"),
    "strand of absent bars": (
        lambda: replace(rope(segments=2), strands=(Strand("s", [0, 1], [7]),)), "bar that does not exist",
    ),
    "strand of few nodes": (lambda: replace(rope(segments=2), strands=(Strand("s", [0], [0]),)), "1 nodes and 1 bars"),
    "point of no node": (lambda: replace(rope(segments=2), points={"top": 9}), "point 'top' is node 9"),
    "two amplitudes": (lambda: Motion.harmonic((1.0, 2.0), 3.0, duration=4.0), "motion.amplitude"),
    "phase of no number": (lambda: Motion.harmonic(1.0, 3.0, duration=4.0, phase=math.nan), "motion.phase"),
    "endless ramp": (lambda: Motion.harmonic(1.0, 3.0, duration=4.0, ramp=math.inf), "ramp of inf"),
    "motion at no time": (lambda: still().at([0.0, math.nan]), "motion asked at"),
    "mesh refined by halves": (lambda: refined(rope(segments=2), 1.5), "factor holds 1.5"),
    "fraction of a watched bar": (lambda: _peak(bar=1.5), "bar holds 1.5"),
    "peaks after the end": (lambda: _peak(after=3.0), "after 3 s of a run of 0.1 s"),
    "a gap in a record": (
        lambda: find_snaps(TIME, np.where(TIME == 2, np.nan, PULL), slack_level=0.5, threshold=1.0),
        "tension is nan in row 2",
    ),
    "a gap in its peaks": (
        lambda: find_snaps(TIME, PULL, slack_level=0.5, threshold=1.0, peaks=np.where(TIME == 1, np.nan, PULL)),
        "peaks is nan in row 1",
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", SILENT)
def test_nothing_is_cut_or_taken_for_something_else(case):
    call, words = SILENT[case]
    with pytest.raises(InputError, match=words):
        call()


def test_whole_numbers_of_any_kind_are_taken():
    for kept in ([1.0, 3.0], np.array([1, 3], dtype=np.uint8), (1, 3)):
        assert _run(keep_bars=kept).bars.tolist() == [1, 3]
    assert _run(keep_bars=[]).tension.shape == (3, 0)
    assert _run(keep_bars=2).bars.tolist() == [2]


@pytest.mark.parametrize("seed", range(8))
def test_the_compiled_survey_is_what_it_says(seed):
    """The rate that bounds the interval of loads, and inverse masses of what may fall dry, against plain numpy."""
    rng = np.random.default_rng(seed)
    network = random_network(rng)
    lift = rng.uniform(15.0, 35.0)
    bed = network.bed
    nodes = replace(network.nodes, position=network.nodes.position + np.array([0.0, 0.0, lift]))
    network = replace(network, nodes=nodes, bed=bed)
    start = State(0.0, np.array(nodes.position), rng.normal(0.0, 2.0, nodes.position.shape))
    run = ExplicitRun(network, {}, Flow((rng.normal(), 0.0, 0.0)), start, safety=0.9, load_steps=4)
    rate, near, inverse = run._survey(0.5)
    arrays, place, speed = run.arrays, run.place, run.speed
    own = {name: arrays.node(name) for name in ("mass", "drag", "added_mass", "volume", "height")}
    flow = np.linalg.norm(run.water[:3] - speed, axis=0)
    sizes = [2.0 * own["drag"] * flow / (own["mass"] + own["added_mass"])]
    sizes.append(3.0 * np.sqrt(1.5 * network.water.density * 9.81 * own["volume"] / own["height"] / own["mass"]))
    ends = place[2, arrays.start], place[2, arrays.end]
    radius = arrays.bar("radius")
    top = place[2].max() + radius.max()
    if top > -1.0:
        flat = radius / (radius + 0.5 * np.abs(ends[0] - ends[1]))
        bob = 3.0 * np.sqrt(arrays.bar("buoyancy") / radius * arrays.bar("per_mass") * flat)
        sizes.append(np.where(np.maximum(*ends) > -1.0, bob, 0.0))
    from moyai.flexible import explicit_rows as kernel

    sizes.append(run.packed.bar_row(kernel.RATE))
    assert rate == pytest.approx(max(values.max() for values in sizes), rel=1e-12)
    assert near == (top > -1.0 - 0.5 * (2.0 * np.abs(speed[2]).max() + 5.0))
    dry = place[2] > -1.0
    assert inverse[:, ~dry] == pytest.approx(run.packed.node_rows(kernel.IXX, 6)[:, ~dry])
    free = arrays.nodes[9:12]
    assert inverse[[0, 3, 5]][:, dry] == pytest.approx((free / own["mass"])[:, dry])


def _laid(segments, amplitude=1.0):
    """A chain whose fairlead heaves, so that it is laid on the bed and lifted again."""
    builder = NetworkBuilder(Water(30.0, 1025.0, 9.81), Bed(-30.0, 1e6, 0.0, 0.3))
    builder.fixed("anchor", (0.0, 0.0, -30.0))
    builder.driven("fairlead", (80.0, 0.0, 0.0))
    chain = BarType(
        "chain", 49.8, 2.135e8, 0.09, viscosity=3e4, drag_normal=2.4, drag_tangential=1.15, added_mass_normal=1.0,
        added_mass_tangential=0.5,
    )  # fmt: skip
    builder.line("chain", "anchor", "fairlead", chain, length=100.0, segments=segments)
    network = builder.build()
    motion = {"fairlead": Motion.harmonic((0.0, 0.0, amplitude), 8.0, duration=22.0, ramp=8.0)}
    start = solve_equilibrium(network).state
    return simulate(network, motion, duration=21.0, output_step=0.5, start=start, keep_nodes=[0])


def test_fronts_of_landing_lumps_are_reported_and_gone_on_a_finer_mesh():
    coarse, fine, finer = (_laid(segments) for segments in (20, 80, 160))
    (notice,) = coarse.notices
    assert notice.code == "landing-front" and notice.severity == "warning" and "on the bed" in notice.message
    assert not fine.notices and not finer.notices
    tops = [float(history.tension_peak[history.time > 8.0, -1].max()) for history in (coarse, fine, finer)]
    assert tops[1] == pytest.approx(tops[2], rel=0.02)
    assert tops[0] > 1.5 * tops[2]


def test_a_peak_that_hangs_on_the_step_is_reported_in_numbers():
    (notice,) = PeakSensitivity(1000.0, 900.0, 980.0, 1010.0, 950.0, 1e-3).notices()
    for words in ("1 kN is 0.9 kN with half the step", "0.98 kN with bars of half", "12.0 %", "1.01 kN and 0.95 kN"):
        assert words in notice.message
    assert "viscosity" in notice.remedy
    (notice,) = PeakSensitivity(1000.0, 999.0, 900.0, 1010.0, 950.0, 1e-3).notices()
    assert "segments" in notice.remedy
    assert not PeakSensitivity(1000.0, 999.0, 990.0, 500.0, 1500.0, 1e-3).notices()


def test_twice_no_viscosity_is_some():
    network = rope(segments=5, stiffness=1e6, mass=4.0)
    assert more_viscous(network).bars.types[0].viscosity == pytest.approx(0.05 * 8.0 * 2000.0)
    assert more_viscous(rope(segments=5, viscosity=30.0)).bars.types[0].viscosity == 60.0


@pytest.mark.parametrize("seed", range(4))
def test_energy_of_random_hanging_chains_over_a_hundred_periods(seed):
    """Chains of random size with a weight at their end swing without damping, taut throughout."""
    rng = np.random.default_rng(seed)
    length, mass, segments = rng.uniform(1.0, 20.0), 10.0 ** rng.uniform(-1, 2), int(rng.integers(3, 13))
    builder = NetworkBuilder(Water(math.inf, 1000.0, 9.81))
    builder.fixed("top", (0.0, 0.0, DEEP))
    builder.free("weight", (0.0, 0.0, DEEP - length), mass=mass * length * rng.uniform(0.1, 3.0))
    kind = BarType("chain", mass, mass * length * 9.81 * 10.0 ** rng.uniform(2.5, 4.0), 1e-9)
    builder.line("chain", "top", "weight", kind, length=length, segments=segments, shape="straight")
    network = builder.build()
    rest = solve_equilibrium(network).state
    modes = natural_modes(network, rest, count=4)
    period = 2.0 * math.pi / modes.omega[0]
    # pushed along two modes at once, in both directions
    speed = np.zeros_like(rest.position)
    along = (rest.position[0, 2] - rest.position[:, 2]) / length
    speed[:, 0] = 0.2 * length / period * along
    speed[:, 1] = 0.1 * length / period * np.sin(math.pi * along)
    history = simulate(
        network, duration=100.0 * period, output_step=0.25 * period, start=State(0.0, rest.position, speed)
    )
    kinetic = 0.5 * float(network.node_mass @ np.sum(speed**2, axis=1))
    assert history.status == "converged" and history.tension.min() > 0.0
    assert np.max(np.abs(history.energy_balance)) < 1e-3 * kinetic
    assert np.ptp(history.position[:, -1, 0]) > 0.05 * length


@pytest.mark.parametrize("seed", range(6))
def test_drag_in_still_water_only_takes_energy(seed):
    """Light ropes and nets let go from a strain of some per cent fly so fast that drag outruns what it was at rest."""
    rng = np.random.default_rng(seed)
    builder = NetworkBuilder(Water(math.inf, 1025.0, 1e-12))
    stiffness, length = 10.0 ** rng.uniform(4.5, 6.0), rng.uniform(0.5, 3.0)
    kind = BarType(
        "twine", rng.uniform(0.2, 1.0), stiffness, rng.uniform(0.01, 0.04),
        viscosity=rng.uniform(0.0, 0.002) * stiffness, drag_normal=1.2, drag_tangential=rng.uniform(0.0, 0.1),
        added_mass_normal=1.0,
    )  # fmt: skip
    rows, columns = (int(rng.integers(3, 7)) for _ in range(2))
    grid = np.zeros((rows, columns, 3))
    grid[..., 1], grid[..., 2] = np.arange(columns) * length, DEEP - np.arange(rows)[:, None] * length
    builder.net("net", grid, kind, lengths=(0.8 * length, rng.uniform(0.75, 0.95) * length), top="fixed")
    network = builder.build()
    usual, often = (simulate(network, duration=1.0, output_step=0.02, load_steps=steps) for steps in (12, 1))
    assert usual.status == often.status == "converged"
    stored = usual.elastic_energy[0]
    # next to drag the added mass that turns with its bars takes and gives
    assert np.diff(usual.work).max() < 0.05 * stored
    assert np.all(usual.kinetic_energy + usual.elastic_energy <= 1.001 * stored)
    assert usual.tension_peak.max() == pytest.approx(often.tension_peak.max(), rel=0.03)


def test_loads_are_continued_at_second_order():
    """A bob with drag on a soft band in a current: the error falls with the square of the interval of the loads."""
    builder = NetworkBuilder(Water(math.inf, 1000.0, 9.81))
    builder.fixed("pivot", (0.0, 0.0, DEEP))
    builder.free("bob", (1.2, 0.0, DEEP - 1.8), mass=3.0, drag_area=3e-3, added_mass=0.5)
    builder.line("band", "pivot", "bob", BarType("band", 1e-9, 300.0, 1e-9), length=2.0, segments=1)
    network, flow = builder.build(), Flow((0.8, 0.5, 0.0))

    def end(load_steps):
        history = simulate(
            network, duration=1.6, output_step=0.4, step=1e-4, load_steps=load_steps, flow=flow, keep_bars=[0]
        )
        return history.final.position[1]

    errors = [float(np.linalg.norm(end(load_steps) - end(1))) for load_steps in (25, 50, 100)]
    assert errors[1] / errors[0] == pytest.approx(4.0, rel=0.15)
    assert errors[2] / errors[1] == pytest.approx(4.0, rel=0.15)


@pytest.mark.parametrize("seed", range(4))
def test_the_ledger_keeps_the_energy_of_linear_motion_at_any_step(seed):
    """Random masses on random springs in a row, at steps near the bound: leapfrog's own energy is constant."""
    rng = np.random.default_rng(seed)
    builder = NetworkBuilder(Water(math.inf, 1000.0, 1e-12))
    builder.fixed("wall", (0.0, 0.0, DEEP))
    count = int(rng.integers(1, 6))
    names = ["wall", *(f"mass {i}" for i in range(count))]
    for i, name in enumerate(names[1:]):
        builder.free(name, (i + 1.0, 0.0, DEEP), mass=rng.uniform(1.0, 5.0))
    for i, (one, two) in enumerate(pairwise(names)):
        spring = BarType("spring", 1e-9, 10.0 ** rng.uniform(2, 4), 1e-9, tension_only=False)
        builder.line(f"spring {i}", one, two, spring, length=1.0, segments=1, shape="straight")
    network = builder.build()
    speed = np.zeros((count + 1, 3))
    speed[1:, 0] = rng.normal(0.0, 1e-3, count)
    start = State(0.0, np.array(network.nodes.position), speed)
    history = simulate(network, duration=20.0, output_step=0.37, start=start, safety=rng.uniform(0.5, 0.97))
    kinetic = 0.5 * float(network.node_mass @ np.sum(speed**2, axis=1))
    total = history.kinetic_energy + history.elastic_energy
    # the first row, at rest in between two steps, has the plain energy
    assert np.ptp(total[1:]) < 1e-5 * kinetic
    assert total[1:].mean() == pytest.approx(kinetic, rel=1e-5)


def test_fronts_of_the_start_are_not_those_that_count():
    """A sudden pull makes a front at the start; after it the end stands still and the rope is calm."""
    pull = 0.02
    motion = Motion.from_function(
        lambda time: np.outer(pull * (1.0 - np.exp(-((time / 0.005) ** 2))), [1.0, 0.0, 0.0]), duration=4.0, step=5e-4
    )
    network = rope(segments=20, viscosity=2e4)
    codes = {}
    for counted_from in (0.0, 2.0):
        run = simulate(network, {"end": motion}, duration=4.0, output_step=0.1, counted_from=counted_from)
        codes[counted_from] = {notice.code for notice in run.notices}
    assert "wave-front" in codes[0.0] and "wave-front" not in codes[2.0]
