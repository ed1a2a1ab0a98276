"""Networks that several tests share."""

import math

import numpy as np

from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import Bars, BarType, Nodes, RopeCurve
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network
from moyai.sea.water import Water

NO_GRAVITY = Water(math.inf, 1000.0, 1e-12)
DEEP = -500.0


def random_network(rng, *, bed=True, bending=True, curve=True, held=True, tension_only=True, buoyant=True, nodes=9):
    """Nodes at random places, joined by a path and random further bars of random types."""
    water = Water(30.0, rng.uniform(900, 1100), 9.81)
    types = tuple(
        BarType(
            f"type {i}",
            rng.uniform(0.5, 20.0),
            10.0 ** rng.uniform(3, 6),
            rng.uniform(0.01, 0.2 if buoyant else 0.02),
            viscosity=10.0 ** rng.uniform(0, 3),
            drag_normal=rng.uniform(0.5, 2.0),
            drag_tangential=rng.uniform(0.0, 0.5),
            added_mass_normal=rng.uniform(0.0, 1.5),
            added_mass_tangential=rng.uniform(0.0, 0.5),
            bending_stiffness=10.0 ** rng.uniform(1, 3) if bending else 0.0,
            tension_only=tension_only,
            curve=RopeCurve([0.0, 0.01, 0.03], [0.0, 2e3, 1.5e4]) if curve and i == 2 else None,
        )
        for i in range(3)
    )
    position = rng.uniform(-5.0, 5.0, (nodes, 3)) + np.array([0.0, 0.0, -24.0 if bed else -15.0])
    start = np.concatenate([np.arange(nodes - 1), rng.integers(0, nodes - 3, 5)])
    end = np.concatenate([np.arange(1, nodes), nodes - 1 - rng.integers(0, 2, 5)])
    length = np.linalg.norm(position[end] - position[start], axis=1) * rng.uniform(0.97, 1.03, start.size)
    kind = np.zeros(nodes, dtype=int)
    kind[0] = 1
    holds = np.zeros((nodes, 3), dtype=bool)
    if held:
        holds[3, 1] = True
    network_nodes = Nodes(
        position,
        kind,
        holds,
        mass=rng.uniform(0.0, 30.0, nodes) * (rng.random(nodes) < 0.5),
        volume=rng.uniform(0.0, 0.05, nodes) * (rng.random(nodes) < 0.5) * buoyant,
        drag_area=rng.uniform(0.0, 1.0, nodes) * (rng.random(nodes) < 0.5),
        added_mass=rng.uniform(0.0, 30.0, nodes) * (rng.random(nodes) < 0.5),
        height=rng.uniform(0.1, 1.0, nodes),
        form=rng.integers(0, 2, nodes),
    )
    from moyai.flexible.elements import Strand

    strand = Strand("path", np.arange(nodes), np.arange(nodes - 1))
    return Network(
        network_nodes,
        Bars(start, end, length, rng.integers(0, 3, start.size), types, rng.uniform(0.5, 1.0, start.size)),
        water,
        Bed(-30.0, 1e4, 1e3, 0.3) if bed else None,
        (strand,),
    )


def rope(
    *,
    segments,
    span=(40.0, 0.0, 0.0),
    length=40.0,
    stiffness=1e6,
    mass=2.0,
    diameter=1e-9,
    water=NO_GRAVITY,
    top=None,
    **more,
):
    """A single line from a fixed point to a driven one, deep under the surface."""
    builder = NetworkBuilder(water)
    low = np.array([0.0, 0.0, DEEP])
    builder.fixed("anchor", low)
    builder.driven("end", low + np.array(span))
    kind = BarType("rope", mass, stiffness, diameter, **more)
    builder.line("rope", "anchor", "end", kind, length=length, segments=segments, shape="straight")
    return builder.build()


def still(duration=1e4):
    """A motion that stays at zero."""
    return Motion(0.0, duration, np.zeros((2, 3)), np.zeros((2, 3)))
