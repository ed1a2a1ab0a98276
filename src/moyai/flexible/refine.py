"""The same network on a finer mesh, or with another viscosity."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np

from moyai.core.errors import InputError
from moyai.flexible.elements import Bars, Nodes, Strand
from moyai.flexible.network import Network, check_network
from moyai.flexible.numbers import whole_number
from moyai.flexible.refine_sheets import Edge, cut_in_four, edge_of, held_middles, sheet_edges
from moyai.flexible.result import State


def refined(network: Network, factor: int, state: State | None = None) -> tuple[Network, State]:
    """Cut every bar into ``factor`` equal bars; return the finer network and the state at its nodes.

    Triangles of sheets are cut in four for every factor of two; a bar along their edge keeps its nodes in common with
    them. Middles of a border whose ends both stay, or follow the same motion, do so too. Nodes are numbered anew, along
    the bars; named points and strands keep their names, attached masses their nodes.

    Parameters
    ----------
    network : Network
        Of bars and sheets.
    factor : int
        Bars in place of one; with sheets 1, 2, 4, 8 ...
    state : State, optional
        As built, without speed, when left out.

    Returns
    -------
    network : Network
        The finer one.
    state : State
        At its nodes: position [m] and velocity [m/s] in site axes.

    Raises
    ------
    InputError
        For a factor below 1, or with sheets one that is no power of two, and for a network with net panels, rings or
        sections of added mass, which a builder has to mesh.

    Examples
    --------
    >>> from moyai.flexible import BarType, NetworkBuilder, refined
    >>> from moyai.sea import Water
    >>> builder = NetworkBuilder(Water(depth=10.0, density=1025.0, gravity=9.81))
    >>> rope = BarType("rope", mass_per_length=10.0, axial_stiffness=1e7, diameter=0.05)
    >>> builder.fixed("left", (0.0, 0.0, -2.0))
    >>> builder.fixed("right", (20.0, 0.0, -2.0))
    >>> builder.line("span", "left", "right", rope, length=21.0, segments=10)
    >>> finer, state = refined(builder.build(), 2)
    >>> len(finer.bars), state.position.shape                            # bars; nodes, axes
    (20, (21, 3))
    """
    check_network(network)
    factor = whole_number(factor, "factor", least=1)
    if network.blocks is not None or network.panels is not None or network.rings:
        raise InputError(
            "net panels, rings and sections of added mass are not refined here",
            parameter="network",
            allowed="bars and sheets",
            remedy="build the network again with twice the cells",
        )
    if network.sheets is not None and factor != 2:
        if factor & (factor - 1):
            raise InputError(f"sheets refined {factor} times", parameter="factor", allowed="1, 2, 4, 8 ...")
        if factor == 1:
            return network, state or State.at_rest(network)
        return refined(*_halved(network, factor, state))
    edges = sheet_edges(network.sheets)
    middle: dict[Edge, int] = {}
    old, bars = network.nodes, network.bars
    now = state or State.at_rest(network)
    number = np.full(len(old), -1, dtype=np.int64)
    source: list[tuple[int, int, float]] = []
    chains = np.empty((len(bars), factor + 1), dtype=np.int64)

    def place(node: int) -> int:
        if number[node] < 0:
            number[node] = len(source)
            source.append((node, node, 0.0))
        return int(number[node])

    def halve(edge: Edge) -> int:
        if edge not in middle:
            middle[edge] = len(source)
            source.append((*edge, 0.5))
        return middle[edge]

    for k in range(len(bars)):
        a, b = int(bars.start[k]), int(bars.end[k])
        chains[k, 0] = place(a)
        for part in range(1, factor):
            edge = edge_of(a, b)
            if edge in edges:
                chains[k, part] = halve(edge)
                continue
            chains[k, part] = len(source)
            source.append((a, b, part / factor))
        chains[k, factor] = place(b)
    for edge in edges:
        halve(edge)
    for node in range(len(old)):
        place(node)
    first, second = (np.array([entry[i] for entry in source], dtype=np.int64) for i in (0, 1))
    share = np.array([entry[2] for entry in source])[:, None]
    own = first == second
    values = {}
    for entry in fields(Nodes):
        given = getattr(old, entry.name)
        if entry.name == "position":
            values[entry.name] = (1.0 - share) * given[first] + share * given[second]
        elif entry.name == "motion":
            values[entry.name] = np.where(own, given[first], -1)
        else:
            values[entry.name] = np.where(own if given.ndim == 1 else own[:, None], given[first], 0)
    sheets = None
    if network.sheets is not None:
        sheets = cut_in_four(network.sheets, place, middle)
        at = np.array(list(middle.values()))
        border = np.array([edges[edge] == 1 for edge in middle])
        values["kind"][at], values["held"][at], values["motion"][at] = held_middles(old, first[at], second[at], border)
    strands = []
    for strand in network.strands:
        nodes: list[int] = []
        numbers: list[int] = []
        for k in strand.bars:
            chain = list(chains[k])
            piece = list(range(int(k) * factor, (int(k) + 1) * factor))
            # a strand may run through a bar against its direction
            if nodes and nodes[-1] == chain[-1]:
                chain, piece = chain[::-1], piece[::-1]
            nodes.extend(chain if not nodes else chain[1:])
            numbers.extend(piece)
        strands.append(Strand(strand.name, np.array(nodes), np.array(numbers)))
    finer = Network(
        Nodes(**values),
        Bars(
            chains[:, :-1].ravel(), chains[:, 1:].ravel(), np.repeat(bars.length / factor, factor),
            np.repeat(bars.kind, factor), bars.types, np.repeat(bars.flow_factor, factor),
        ),
        network.water, network.bed, tuple(strands), {name: int(number[node]) for name, node in network.points.items()},
        network.motion_names, sheets,
    )  # fmt: skip
    place_now = (1.0 - share) * now.position[first] + share * now.position[second]
    speed_now = (1.0 - share) * now.velocity[first] + share * now.velocity[second]
    return finer, State(now.time, place_now, speed_now)


def _halved(network: Network, factor: int, state: State | None) -> tuple[Network, int, State]:
    """Return a network refined once, what is left of the factor, and its state."""
    finer, now = refined(network, 2, state)
    return finer, factor // 2, now


def with_viscosity(network: Network, factor: float) -> Network:
    """Return the network with all viscosities, of bars and sheets, multiplied by ``factor``.

    Raises
    ------
    InputError
        For a negative factor.
    """
    if not factor >= 0.0:
        raise InputError(f"viscosity times {factor:g}", parameter="factor", allowed="0 or more")
    types = tuple(replace(kind, viscosity=factor * kind.viscosity) for kind in network.bars.types)
    sheets = network.sheets
    if sheets is not None:
        sheets = replace(sheets, damping_time=factor * np.asarray(sheets.damping_time))
    return replace(network, bars=replace(network.bars, types=types), sheets=sheets)


def more_viscous(network: Network) -> Network:
    """Return the network with twice its viscosity, or, when it has none at all, with some that shows what it would do.

    That is a twentieth of critical damping on the mesh, 0.05 l sqrt(EA m) of the longest bar of each type; a double of
    nothing would show a peak that is not attached to viscosity.
    """
    bars, sheets = network.bars, network.sheets
    damped = sheets is not None and bool(np.any(np.asarray(sheets.damping_time) > 0.0))
    if not len(bars) or damped or np.any(bars.of_type("viscosity") > 0.0):
        return with_viscosity(network, 2.0)
    longest = [float(np.max(bars.length[bars.kind == kind], initial=0.0)) for kind in range(len(bars.types))]
    types = tuple(
        replace(kind, viscosity=0.05 * length * kind.impedance)
        for kind, length in zip(bars.types, longest, strict=True)
    )
    return replace(network, bars=replace(bars, types=types))
