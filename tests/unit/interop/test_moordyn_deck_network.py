"""Decks become networks and come back the same."""

import math
from dataclasses import replace

import numpy as np
import pytest

from moyai.core.errors import CaseError, InputError
from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import DRIVEN, FIXED, FREE, BarType, RopeCurve
from moyai.flexible.statics import solve_equilibrium
from moyai.interop.moordyn_deck import DeckLine, DeckLineType, DeckPoint, MoorDynDeck, write_deck
from moyai.interop.moordyn_network import flow_of, line_name, point_name, to_deck, to_network, water_of
from moyai.interop.moordyn_reader import read_deck
from moyai.interop.moordyn_records import DeckCurrent, DeckOption, StiffnessTable
from moyai.mooring.catenary import solve_catenary
from moyai.sea.water import Water


def random_deck(seed):
    """A chain, a clump weight and a rope up to a moving fairlead, all numbers random."""
    draw = np.random.default_rng(seed)
    depth = draw.uniform(10.0, 80.0)
    kinds = tuple(
        DeckLineType(
            name, draw.uniform(0.02, 0.2), draw.uniform(60.0, 200.0), draw.uniform(1e7, 1e9), damping,
            float(draw.uniform(0.0, 1e3)), *map(float, draw.uniform(0.0, 2.0, 4)),
        )
        for name, damping in (("chain", -draw.uniform(0.1, 1.0)), ("rope", draw.uniform(0.0, 1e5)))
    )  # fmt: skip
    points = (
        DeckPoint(3, "fixed", (draw.uniform(1.8, 2.2) * depth, draw.uniform(-1.0, 1.0), -depth), 0.0, 0.0, 0.0, 0.0),
        DeckPoint(
            8, "free", (draw.uniform(0.9, 1.1) * depth, 0.0, -0.8 * depth),
            *map(float, draw.uniform([100.0, 0.01, 0.0, 0.0], [900.0, 0.08, 1.0, 1.0])),
        ),
        DeckPoint(1, "coupled", (0.0, 0.0, draw.uniform(-5.0, -1.0)), 0.0, 0.0, 0.0, 0.0),
    )  # fmt: skip
    lines = (DeckLine(1, "chain", 3, 8, 1.05 * depth, 9, "p"), DeckLine(2, "rope", 8, 1, 1.3 * depth, 11))
    options = (
        DeckOption("WtrDpth", depth), DeckOption("WtrDnsty", draw.uniform(990.0, 1030.0)), DeckOption("g", 9.81),
        DeckOption("kBot", draw.uniform(1e5, 1e7)), DeckOption("cBot", draw.uniform(0.0, 1e5)),
        DeckOption("FrictionCoefficient", draw.uniform(0.0, 0.9)), DeckOption("tScheme", "RK4"),
    )  # fmt: skip
    return MoorDynDeck(kinds, points, lines, options, ("FairTen1",))


@pytest.mark.parametrize("seed", range(5))
def test_file_keeps_every_digit(tmp_path, seed):
    deck = random_deck(seed)
    assert read_deck(write_deck(deck, tmp_path / "deck.txt")) == deck


def test_file_keeps_tables_and_current(tmp_path):
    deck = random_deck(1)
    rope = StiffnessTable((0.0, 0.011, 0.1 / 3.0), (0.0, 1.1e5, 5e5 / 7.0 * 3.0), "rope.txt")
    kinds = (deck.line_types[0], DeckLineType("rope", 0.1, 20.0, rope, 1e3, 0.0, 1.0, 1.0, 0.0, 0.0))
    current = DeckCurrent((-90.0, -1.0 / 3.0, 2.0), ((0.1, 0.0), (0.7, -0.1), (0.9, 0.2)))
    options = (*deck.options, DeckOption("Currents", 1.0))
    full = MoorDynDeck(kinds, deck.points, deck.lines, options, current=current)
    again = read_deck(write_deck(full, tmp_path / "deck.txt"))
    assert again == full
    velocity = flow_of(again).current.velocity(np.array([-40.0, -0.2, 0.0]))
    expected = [
        [np.interp(z, current.z, [v[k] for v in current.velocity]) for k in range(2)] for z in (-40.0, -0.2, 0.0)
    ]
    assert velocity == pytest.approx(np.array(expected), abs=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_network_means_what_the_deck_says(seed):
    deck = random_deck(seed)
    network = to_network(deck)
    assert network.motion_names == (point_name(1),)
    assert [network.nodes.kind[network.point(point_name(k))] for k in (3, 8, 1)] == [FIXED, FREE, DRIVEN]
    for line in deck.lines:
        strand, kind = network.strand(line_name(line.number)), deck.line_type(line.line_type)
        bar = network.bars.types[network.bars.kind[strand.bars[0]]]
        length = line.length / line.segments
        assert network.bars.length[strand.bars].sum() == pytest.approx(line.length, rel=1e-14)
        assert (strand.nodes[0], strand.nodes[-1]) == tuple(
            network.point(point_name(k)) for k in (line.start, line.end)
        )
        assert bar.drag_tangential == pytest.approx(math.pi * kind.drag_axial)
        assert bar.volume_per_length == pytest.approx(math.pi / 4.0 * kind.diameter**2)
        if kind.damping < 0.0:
            # fastest motion of a segment between two masses m l: stiffness 4 EA/l on each, damping 4 BA/l
            stiffness, mass, damping = (
                4.0 * bar.axial_stiffness / length,
                bar.mass_per_length * length,
                4.0 * bar.viscosity / length,
            )
            assert damping / (2.0 * math.sqrt(stiffness * mass)) == pytest.approx(-kind.damping, rel=1e-12)
        else:
            assert bar.viscosity == kind.damping
    clump, node = deck.point(8), network.point(point_name(8))
    assert network.nodes.added_mass[node] == pytest.approx(
        clump.added_mass_coefficient * network.water.density * clump.volume
    )
    assert network.bed.level == -network.water.depth == -deck.number("WtrDpth")


@pytest.mark.parametrize("seed", range(5))
def test_network_deck_network(tmp_path, seed):
    network = to_network(random_deck(seed))
    again = to_network(read_deck(write_deck(to_deck(network), tmp_path / "deck.txt")))
    assert again.bars.length == pytest.approx(network.bars.length, rel=1e-14)
    for name in ("mass", "volume", "drag_area", "added_mass", "kind"):
        assert getattr(again.nodes, name) == pytest.approx(getattr(network.nodes, name), rel=1e-12)
    for name in (
        "diameter", "mass_per_length", "axial_stiffness", "viscosity", "drag_normal", "drag_tangential",
        "added_mass_normal", "added_mass_tangential", "bending_stiffness", "volume_per_length",
    ):  # fmt: skip
        assert again.bars.of_type(name) == pytest.approx(network.bars.of_type(name), rel=1e-12)
    assert solve_equilibrium(again).tension == pytest.approx(solve_equilibrium(network).tension, rel=1e-7)


def test_net_and_curve_survive(tmp_path):
    builder = NetworkBuilder(Water(20.0, 1025.0, 9.81))
    twine = BarType("twine of nylon", 0.02, 1.0, 0.004, curve=RopeCurve([0.0, 0.05, 0.2], [0.0, 40.0, 400.0]))
    x, z = np.meshgrid(np.arange(4) * 0.5, -np.arange(3) * 0.5)
    builder.net("net", np.stack([x, 0 * x, z], axis=-1), twine, lengths=(0.5, 0.5), top="fixed")
    network = builder.build()
    again = to_network(read_deck(write_deck(to_deck(network), tmp_path / "net.txt")))
    assert (len(again.nodes), len(again.bars)) == (len(network.nodes), len(network.bars))
    assert again.bars.types[0].curve.tension == pytest.approx(twine.curve.tension)
    lowest = [solve_equilibrium(n).state.position[:, 2].min() for n in (network, again)]
    assert lowest[0] == pytest.approx(lowest[1], rel=1e-7)


def test_volume_unlike_the_diameter_keeps_weight_drag_and_bed(tmp_path):
    """A chain whose drag diameter is not that of its volume."""
    builder = NetworkBuilder(Water(30.0, 1025.0, 9.81), Bed(-30.0, 2e5, 1e3, 0.3))
    kind = BarType("chain", 100.0, 5e8, 0.05, volume_per_length=100.0 / 7800.0, drag_normal=2.5, drag_tangential=0.5)
    builder.fixed("anchor", (0.0, 0.0, -30.0))
    builder.driven("fairlead", (70.0, 0.0, -2.0))
    builder.line("chain", "anchor", "fairlead", kind, length=80.0, segments=40)
    network = builder.build()
    again = to_network(read_deck(write_deck(to_deck(network), tmp_path / "deck.txt")))
    back = again.bars.types[0]
    assert back.volume_per_length == pytest.approx(kind.volume_per_length, rel=1e-12)
    assert back.drag_normal * back.diameter == pytest.approx(2.5 * 0.05, rel=1e-12)
    assert back.drag_tangential * back.diameter == pytest.approx(0.5 * 0.05, rel=1e-12)
    assert again.bed.stiffness * again.node_contact_area == pytest.approx(2e5 * network.node_contact_area, rel=1e-12)
    assert solve_equilibrium(again).tension == pytest.approx(solve_equilibrium(network).tension, rel=1e-7)


def test_all_that_a_deck_cannot_say_is_named_at_once():
    builder = NetworkBuilder(Water(30.0, 1025.0, 9.81), Bed(-29.0, 2e5))
    beam = BarType("beam", 100.0, 5e8, 0.05, tension_only=False)
    builder.fixed("anchor", (0.0, 0.0, -29.0))
    builder.float_sphere(
        "float", (20.0, 0.0, 0.0), diameter=1.0, mass=100.0, drag_coefficient=0.5, added_mass_coefficient=0.5
    )
    builder.line("line", "anchor", "float", beam, length=36.0, segments=4)
    with pytest.raises(CaseError) as caught:
        to_deck(builder.build())
    text = str(caught.value)
    assert all(
        word in text for word in ("float: partial immersion", "beam: a bar that carries compression", "bed at -29 m")
    )


def test_finer_mesh_meets_the_catenary():
    deck = random_deck(2)
    kinds = tuple(DeckLineType(t.name, 0.05, 120.0, 4e8, -0.5, 0.0, 1.0, 1.0, 0.1, 0.0) for t in deck.line_types)
    points = (
        DeckPoint(1, "fixed", (0.0, 0.0, -40.0), 0.0, 0.0, 0.0, 0.0),
        DeckPoint(2, "coupled", (75.0, 0.0, -3.0), 0.0, 0.0, 0.0, 0.0),
    )
    options = (DeckOption("WtrDpth", 40.0), DeckOption("WtrDnsty", 1000.0), DeckOption("kBot", 1e9))
    chain = MoorDynDeck(kinds, points, (DeckLine(1, "rope", 1, 2, 90.0, 10),), options)
    network = to_network(chain, segments=400)
    assert network.bars.types[0].viscosity == to_network(chain).bars.types[0].viscosity
    weight = network.bars.types[0].submerged_weight_per_length(network.water)
    exact = solve_catenary(75.0, 37.0, 90.0, 4e8, weight)
    rest = solve_equilibrium(network)
    # the bar at the top ends half its length below
    assert rest.tension[-1] + 0.5 * 90.0 / 400 * weight == pytest.approx(float(exact.tension_fairlead), rel=3e-4)


def test_depth_from_elsewhere():
    deck = random_deck(0)
    bare = MoorDynDeck(deck.line_types, deck.points, deck.lines)
    with pytest.raises(InputError, match="no water depth"):
        water_of(bare)
    water = Water(deck.number("WtrDpth"), 1000.0, 9.81)
    assert to_network(bare, water=water).water == water


def test_no_folder_no_deck(tmp_path):
    with pytest.raises(InputError, match="no such folder"):
        write_deck(random_deck(0), tmp_path / "absent" / "deck.txt")


def test_numbers_of_numpy_are_written_as_numbers(tmp_path):
    deck = random_deck(0)
    kinds = tuple(
        replace(kind, diameter=np.float64(kind.diameter), drag_normal=np.int64(1)) for kind in deck.line_types
    )
    again = read_deck(write_deck(replace(deck, line_types=kinds), tmp_path / "deck.txt"))
    assert again.line_types == kinds
