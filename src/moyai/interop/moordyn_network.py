"""MoorDyn decks as flexible networks, and networks as decks.

What differs between the two models, and how it is met:

- MoorDyn's axial drag acts on the circumference, ours on the diameter: C = pi CdAx.
- A negative BA is minus the part of the critical damping of the fastest motion of a segment, whose two ends swing
  against each other at 2/l sqrt(EA/m): BA = zeta l sqrt(EA m). It belongs to the mesh and is turned into N s line by
  line.
- MoorDyn's volume is that of its diameter. A type whose volume differs is written with the diameter of its volume and
  a drag coefficient that keeps the product; the bed is then made stiffer in the ratio of the diameters.
- MoorDyn lets the viscous force act on slack segments too; ours ends with the tension.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from moyai.core.errors import CaseError, Fault, InputError
from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import DRIVEN, FIXED, BarType, RopeCurve, SlowStretch
from moyai.flexible.flow import Flow
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network
from moyai.flexible.result import State
from moyai.flexible.worn_law import WornRope
from moyai.interop.moordyn_currents import read_current_field
from moyai.interop.moordyn_deck import (
    DeckLine,
    DeckLineType,
    DeckPoint,
    MoorDynDeck,
    PointKind,
)
from moyai.interop.moordyn_records import DeckOption, DeckSlowStretch, StiffnessTable
from moyai.interop.moordyn_syrope import law_of
from moyai.interop.moordyn_waves import wave_components
from moyai.sea.current import table as current_table
from moyai.sea.water import Water

#: Part of the stable step of the explicit scheme here that MoorDyn is given, and the longest step at all [s].
SAFE_SHARE, LONGEST_STEP = 0.25, 0.05
#: Density [kg/m3] and gravity [m/s2] that stand for none at all.
TRACE, TRACE_OF_GRAVITY = 1e-3, 1e-6


def point_name(number: int) -> str:
    """Return the name of a deck's point in the network, which is also the name of its motion."""
    return f"point {number}"


def line_name(number: int) -> str:
    """Return the name of a deck's line in the network."""
    return f"line {number}"


def water_of(deck: MoorDynDeck) -> Water:
    """Return the water that the options of a deck describe.

    Raises
    ------
    InputError
        When the deck gives no depth (a deck of OpenFAST takes it from there), or no gravity.
    """
    depth = deck.depth
    if depth is None:
        raise InputError(
            f"{deck.source or 'the deck'} gives no water depth",
            path="WtrDpth",
            remedy="give it: --depth of moyai run and moyai convert, in_depth of the deck, or water of to_network",
        )
    density, gravity = deck.number("WtrDnsty"), deck.number("g")
    # a deck without water is run in a trace of it
    thin = TRACE if density == 0.0 else density
    pull = TRACE_OF_GRAVITY if gravity == 0.0 else gravity
    return Water(depth, thin if thin is not None else math.nan, pull if pull is not None else math.nan)


def flow_of(deck: MoorDynDeck, water: Water | None = None) -> Flow:
    """Return current and waves of a deck; still water when it has none.

    Waves of MoorDyn do not feel the current and end at still water: no stretching, no Doppler shift.

    Parameters
    ----------
    deck : MoorDynDeck
    water : Water, optional
        Instead of the deck's own.
    """
    waves = None if deck.waves is None else wave_components(deck.waves, water or water_of(deck))
    field = None
    if deck.current_field is not None:
        given = deck.current_field
        field = read_current_field(Path(given.folder) / given.file, given.form)
    if deck.current is None:
        return Flow(waves=waves, stretching="constant", field=field)
    z, velocity = np.array(deck.current.z), np.array(deck.current.velocity)
    wet = z <= 0.0
    if not wet.all() and wet.any() and z[wet][-1] < 0.0:
        # the profile of the engine ends at still water
        at_surface = [np.interp(0.0, z, velocity[:, k]) for k in range(2)]
        z, velocity = np.append(z[wet], 0.0), np.vstack([velocity[wet], at_surface])
    else:
        z, velocity = z[wet], velocity[wet]
    profile = current_table(z, np.hypot(*velocity.T), np.arctan2(velocity[:, 1], velocity[:, 0]))
    return Flow(current=profile, waves=waves, stretching="constant")


def damping_of(kind: DeckLineType, segment_length: float, axial_stiffness: float) -> float:
    """Return the viscosity BA [N s] of a line type on segments of a length [m]."""
    if kind.damping >= 0.0:
        return kind.damping
    return -kind.damping * segment_length * math.sqrt(axial_stiffness * kind.mass_per_length)


def bar_type(kind: DeckLineType, segment_length: float) -> BarType:
    """Return the material of a line type on segments of a length [m]."""
    curve, stiffness = None, 0.0
    slow: SlowStretch | WornRope | None = None
    if kind.slow is not None:
        slow = SlowStretch(kind.slow.stiffness, kind.slow.damping, kind.slow.growth)
    if kind.syrope is not None and kind.syrope.original is not None:
        slow, stiffness = law_of(kind.syrope.original, kind.syrope), kind.syrope.alpha
    elif isinstance(kind.stiffness, StiffnessTable):
        curve = RopeCurve(np.array(kind.stiffness.strain), np.array(kind.stiffness.tension))
        stiffness = float(curve.stiffness[0])
    else:
        stiffness = kind.stiffness
    return BarType(
        kind.name,
        kind.mass_per_length,
        stiffness,
        kind.diameter,
        viscosity=damping_of(kind, segment_length, stiffness),
        drag_normal=kind.drag_normal,
        drag_tangential=math.pi * kind.drag_axial,
        added_mass_normal=kind.added_mass_normal,
        added_mass_tangential=kind.added_mass_axial,
        bending_stiffness=kind.bending_stiffness,
        curve=curve,
        slow=slow,
    )


def to_network(deck: MoorDynDeck, *, water: Water | None = None, segments: int | None = None) -> Network:
    """Return the network that a deck describes.

    Points are named ``point 1`` ..., lines ``line 1`` ...; a coupled point follows the motion of its own name.

    Parameters
    ----------
    deck : MoorDynDeck
        From :func:`moyai.interop.moordyn_reader.read_deck`.
    water : Water, optional
        Instead of the deck's own: needed where the deck gives no depth.
    segments : int, optional
        Segments of every line instead of the deck's own. A negative BA keeps the value that the deck's own mesh gives.

    Returns
    -------
    Network
        Its start lies on catenaries; :func:`moyai.flexible.statics.solve_equilibrium` finds it at rest.

    Raises
    ------
    InputError
        No depth; a network that :class:`moyai.flexible.network.Network` refuses.
    """
    if deck.bodies or deck.rods:
        raise InputError(
            f"{deck.source or 'the deck'} has bodies or rods, which are more than a network",
            path="bodies" if deck.bodies else "rods", remedy="to_system of moyai.interop.moordyn_system gives both",
        )  # fmt: skip
    site = water or water_of(deck)
    builder = builder_of(deck, site)
    for point in deck.points:
        add_point(builder, point, site)
    add_lines(builder, deck, segments)
    return builder.build()


def builder_of(deck: MoorDynDeck, site: Water) -> NetworkBuilder:
    """Return the builder of the network of a deck, with its bed."""
    stiffness, damping, friction = (deck.number(key) or 0.0 for key in ("kBot", "cBot", "FrictionCoefficient"))
    bed = Bed(-site.depth, stiffness, damping, friction) if math.isfinite(site.depth) else None
    ground = None if deck.seafloor is None else deck.seafloor.ground
    if ground is not None:
        bed = Bed.on(ground, stiffness, damping, friction)
    return NetworkBuilder(site, bed)


def add_point(builder: NetworkBuilder, point: DeckPoint, site: Water) -> None:
    """Add a point of a deck that no body carries."""
    name = point_name(point.number)
    if point.kind == "fixed":
        builder.fixed(name, point.position)
    elif point.kind == "coupled":
        builder.driven(name, point.position)
    else:
        builder.free(
            name, point.position, mass=point.mass, volume=point.volume, drag_area=point.drag_area,
            added_mass=point.added_mass_coefficient * site.density * point.volume,
        )  # fmt: skip


def add_lines(
    builder: NetworkBuilder,
    deck: MoorDynDeck,
    segments: int | None,
    name_of: Callable[[int | str], str] = lambda end: point_name(int(end)),
) -> None:
    """Add the lines of a deck; ``name_of`` gives the point of the network at an end of a line."""
    made: dict[tuple[str, float], BarType] = {}
    for line in deck.lines:
        own = line.length / line.segments
        if (line.line_type, own) not in made:
            made[line.line_type, own] = bar_type(deck.line_type(line.line_type), own)
        builder.line(
            line_name(line.number), name_of(line.start), name_of(line.end), made[line.line_type, own],
            length=line.length, segments=segments or line.segments,
        )  # fmt: skip


def to_deck(network: Network, *, title: str = "", floating: bool = False) -> MoorDynDeck:
    """Return a network as a deck: every run of equal bars between named points, branches or loads is a line.

    Parameters
    ----------
    network : Network
        The network.
    title : str
        Line that describes it.
    floating : bool
        Keep points that come out of the water with their height, for programs that know it; MoorDyn does not.

    Raises
    ------
    CaseError
        All that MoorDyn cannot express: floats that are partly immersed, held components, wakes, bars that carry
        compression, a bed above or below the depth, diameters of contact in different ratios to the volume. Contact of
        points with the bed is left out, with a note where they are heavy.
    """
    equivalent = [math.sqrt(4.0 * kind.volume_per_length / math.pi) for kind in network.bars.types]
    faults = _inexpressible(network, equivalent, floating)
    if faults:
        raise CaseError(faults)
    water, bed = network.water, network.bed
    runs = _runs(network)
    number = {node: k + 1 for k, node in enumerate(_ends_in_order(network, runs))}
    points = tuple(_point(network, node, number[node]) for node in number)
    # one ratio for all types, or the deck would have been refused
    ratio = network.bars.types[0].diameter / equivalent[0] if equivalent else 1.0
    kinds = deck_line_types(network.bars.types)
    lines = tuple(
        DeckLine(k + 1, kinds[kind].name, number[first], number[last], total, count)
        for k, (first, last, kind, total, count) in enumerate(runs)
    )
    options = [
        DeckOption("WtrDpth", water.depth),
        DeckOption("WtrDnsty", water.density),
        DeckOption("g", water.gravity),
    ]
    if bed is not None:
        options += [
            DeckOption("kBot", bed.stiffness * ratio),
            DeckOption("cBot", bed.damping * ratio),
            DeckOption("FrictionCoefficient", bed.friction),
        ]
    # the default step of MoorDyn diverges on stiff lines, and its default scheme lets undamped waves grow
    options += [DeckOption("tScheme", "RK4"), DeckOption("dtM", safe_step(network))]
    nodes, names = network.nodes, {node: name for name, node in network.points.items()}
    heavy = (nodes.contact_area > 0.0) & (nodes.mass > water.density * nodes.volume)
    resting = [names.get(node, f"node {node}") for node in map(int, np.flatnonzero(heavy))]
    left_out = f"the bed does not carry {', '.join(resting)} there, but for the area of the lines next to it"
    return MoorDynDeck(kinds, points, lines, tuple(options), title=title, notes=(left_out,) if resting else ())


def safe_step(network: Network) -> float:
    """Return a step [s] with which MoorDyn's scheme RK4 stays stable on a network, two digits of it.

    The fourth-order scheme of Runge and Kutta is stable to 2.8 over the highest frequency of a motion without damping,
    and as much over the rate of one that only fades; the explicit scheme here to 2.
    """
    from moyai.flexible.explicit import LOAD_STEPS, ExplicitRun

    still = {name: Motion(0.0, 1.0, np.zeros((2, 3)), np.zeros((2, 3))) for name in network.motion_names}
    run = ExplicitRun(network, still, Flow(), State.at_rest(network), safety=None, load_steps=LOAD_STEPS)
    step = min(SAFE_SHARE * run.limit()[0], LONGEST_STEP)
    digits = 10.0 ** (math.floor(math.log10(step)) - 1)
    return float(f"{math.floor(step / digits) * digits:.2g}")


def _inexpressible(network: Network, equivalent: list[float], floating: bool) -> list[Fault]:
    """Return all that a deck cannot say; ``equivalent`` holds the diameter of the volume of every type."""
    faults: list[Fault] = []
    nodes, bars, water = network.nodes, network.bars, network.water
    names = {node: name for name, node in network.points.items()}

    def refuse(what: str, where: object) -> None:
        faults.append(Fault(f"{where}: {what} cannot be written into a deck of MoorDyn", "network"))

    free = (nodes.kind != FIXED) & (nodes.kind != DRIVEN)
    for node in range(len(nodes)):
        label = names.get(node, f"node {node}")
        if nodes.height[node] > 0.0 and not floating:
            refuse("partial immersion", label)
        if free[node] and nodes.held[node].any():
            refuse("a component that is held", label)
        if nodes.added_mass[node] > 0.0 and nodes.volume[node] <= 0.0:
            refuse("added mass without volume", label)
    if np.any(bars.flow_factor != 1.0):
        refuse("a wake", "bars")
    ratios = []
    for kind, diameter in zip(bars.types, equivalent, strict=True):
        if not kind.tension_only:
            refuse("a bar that carries compression", kind.name)
        if diameter <= 0.0:
            refuse("a line without volume", kind.name)
        else:
            ratios.append(kind.diameter / diameter)
    bed = network.bed
    if bed is not None and ratios and max(ratios) - min(ratios) > 1e-9 * max(ratios):
        refuse("a bed under types whose diameter and volume differ in different ratios", "bed")
    if bed is not None and bed.ground is not None:
        refuse("a bed that varies", "bed")
    elif bed is not None and abs(bed.level + water.depth) > 1e-9 * water.depth:
        refuse(f"a bed at {bed.level:g} m in {water.depth:g} m of water", "bed")
    if math.isinf(water.depth):
        refuse("infinite depth", "water")
    return faults


_Run = tuple[int, int, int, float, int]


def _runs(network: Network) -> list[_Run]:
    """Return first node, last node, type, length and number of the bars of every piece that is one line of a deck."""
    nodes, bars = network.nodes, network.bars
    meeting = np.bincount(np.concatenate([bars.start, bars.end]), minlength=len(nodes))
    loaded = (nodes.mass > 0.0) | (nodes.volume > 0.0) | (nodes.drag_area > 0.0)
    cut = (meeting != 2) | (nodes.kind != 0) | loaded
    cut[list(network.points.values())] = True
    found: list[_Run] = []
    seen = np.zeros(len(bars), dtype=bool)

    def walk(nodes_of: list[int], bars_of: list[int]) -> None:
        first, start = 0, nodes_of[0]
        for place, bar in enumerate(bars_of):
            seen[bar] = True
            after = bars_of[place + 1] if place + 1 < len(bars_of) else -1
            ends = after < 0 or cut[nodes_of[place + 1]] or bars.kind[after] != bars.kind[bar]
            if ends or abs(bars.length[after] - bars.length[bar]) > 1e-12 * bars.length[bar]:
                count = place + 1 - first
                # the sum of equal lengths, without the rounding of a sum
                found.append((start, nodes_of[place + 1], int(bars.kind[bar]), float(bars.length[bar]) * count, count))
                first, start = place + 1, nodes_of[place + 1]

    for strand in network.strands:
        walk([int(n) for n in strand.nodes], [int(b) for b in strand.bars])
    for bar in np.flatnonzero(~seen):
        walk([int(bars.start[bar]), int(bars.end[bar])], [int(bar)])
    return found


def _ends_in_order(network: Network, runs: list[_Run]) -> list[int]:
    ends = [node for run in runs for node in run[:2]]
    return list(dict.fromkeys([*network.points.values(), *ends]))


def _point(network: Network, node: int, number: int) -> DeckPoint:
    nodes = network.nodes
    kinds: dict[int, PointKind] = {FIXED: "fixed", DRIVEN: "coupled"}
    volume = float(nodes.volume[node])
    x, y, z = (float(value) for value in nodes.position[node])
    added = float(nodes.added_mass[node]) / (network.water.density * volume) if volume > 0.0 else 0.0
    return DeckPoint(
        number, kinds.get(int(nodes.kind[node]), "free"), (x, y, z), float(nodes.mass[node]), volume,
        float(nodes.drag_area[node]), added, height=float(nodes.height[node]),
    )  # fmt: skip


def deck_line_types(kinds: Sequence[BarType]) -> tuple[DeckLineType, ...]:
    """Return line types of a deck in the order of their materials, with names that hold no blank and differ.

    Parameters
    ----------
    kinds : sequence of BarType
    """
    found: list[DeckLineType] = []
    names: list[str] = []
    for kind in kinds:
        diameter = math.sqrt(4.0 * kind.volume_per_length / math.pi)
        base = "_".join(kind.name.replace("#", "_").replace("!", "_").split()) or "line"
        name, count = base, 1
        while name in names:
            count += 1
            name = f"{base}_{count}"
        names.append(name)
        stiffness: float | StiffnessTable = kind.axial_stiffness
        if kind.curve is not None:
            stiffness = StiffnessTable(
                tuple(map(float, kind.curve.strain)), tuple(map(float, kind.curve.tension)), f"{name}_stiffness.txt"
            )
        if isinstance(kind.slow, WornRope):
            raise InputError(
                f"the line type {kind.name!r} depends on its highest mean tension (Syrope), which is not written into "
                "decks",
                path="line types", allowed="EA, a curve, or slow stretch",
            )  # fmt: skip
        made = DeckLineType(
            name, diameter, kind.mass_per_length, stiffness, kind.viscosity, kind.bending_stiffness, kind.drag_normal,
            kind.added_mass_normal, kind.drag_tangential / math.pi, kind.added_mass_tangential,
            slow=None if kind.slow is None
            else DeckSlowStretch(kind.slow.static_stiffness, kind.slow.viscosity, kind.slow.growth),
        )  # fmt: skip
        ratio = kind.diameter / diameter
        if abs(ratio - 1.0) > 1e-12:
            made = replace(made, drag_normal=made.drag_normal * ratio, drag_axial=made.drag_axial * ratio)
        found.append(made)
    return tuple(found)
