"""The four problems that the time-domain line programs are held against; one place for their numbers.

``chain``: 100 m of studless chain on a bed, fairlead surging 1 m / 6 s. ``snap``: 46 m of steel rope going slack and
taut.
``snapmass``: the same rope stops 5 t pulled by a soft spring. ``net``: n x n knots towed at 1 m/s, top row heaving
0.5 m / 6 s.
"""

from __future__ import annotations

import math

import numpy as np

from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network
from moyai.sea.water import Water

DENSITY, GRAVITY = 1025.0, 9.81
Deck = tuple[Network, dict[str, Motion]]

ROPE = BarType(
    "steel rope", 9.0, 1e8, 0.04, viscosity=1e4, drag_normal=1.2, drag_tangential=0.02 * math.pi, added_mass_normal=1.0
)


def snap(segments: int, duration: float) -> Deck:
    """Return the rope between an anchor and a fairlead that surges 1 m / 4 s."""
    builder = NetworkBuilder(Water(60.0, DENSITY, GRAVITY))
    builder.fixed("anchor", (0.0, 0.0, -12.0))
    builder.driven("fairlead", (43.9425, 0.0, -2.0))
    builder.line("rope", "anchor", "fairlead", ROPE, length=46.0, segments=segments)
    return builder.build(), {"fairlead": Motion.harmonic((1.0, 0.0, 0.0), 4.0, duration=duration, ramp=4.0)}


def snapmass(segments: int, duration: float) -> Deck:
    """Return the rope, the neutrally buoyant mass, and the soft spring that surges 3 m / 6 s."""
    builder = NetworkBuilder(Water(60.0, DENSITY, GRAVITY))
    builder.fixed("anchor", (0.0, 0.0, -12.0))
    builder.free("mass", (45.9, 0.0, -12.0), mass=5000.0, volume=5000.0 / DENSITY, drag_area=5.0)
    builder.driven("spring end", (66.5, 0.0, -12.0))
    spring = BarType("soft spring", 1e-3, 2e4 * 20.0, 1e-3, viscosity=2e3)
    builder.line("rope", "anchor", "mass", ROPE, length=46.0, segments=segments)
    builder.line("spring", "mass", "spring end", spring, length=20.0, segments=1)
    return builder.build(), {"spring end": Motion.harmonic((3.0, 0.0, 0.0), 6.0, duration=duration, ramp=6.0)}


def chain(segments: int, duration: float) -> Deck:
    """Return the chain; its viscosity is the one that belongs to the peer's ``BA = -1`` on this mesh."""
    builder = NetworkBuilder(Water(10.0, DENSITY, GRAVITY), Bed(-10.0, 3e5, 3e4))
    builder.fixed("anchor", (0.0, 0.0, -10.0))
    builder.driven("fairlead", (97.5, 0.0, 0.0))
    viscosity = 100.0 / segments * math.sqrt(2.135e8 * 49.8)
    kind = BarType(
        "chain", 49.8, 2.135e8, 0.09, viscosity=viscosity, drag_normal=2.4, drag_tangential=1.15, added_mass_normal=1.0,
        added_mass_tangential=0.5,
    )  # fmt: skip
    builder.line("chain", "anchor", "fairlead", kind, length=100.0, segments=segments)
    return builder.build(), {"fairlead": Motion.harmonic((1.0, 0.0, 0.0), 6.0, duration=duration, ramp=6.0)}


def _tow(time: np.ndarray) -> np.ndarray:
    """A current of 1 m/s as a tow against still water, grown over 3 s, and the heave of the top row."""
    place = np.zeros((time.size, 3))
    place[:, 0] = -np.where(time < 3.0, np.maximum(time, 0.0) ** 2 / 6.0, time - 1.5)
    place[:, 2] = 0.5 * np.clip(time / 3.0, 0.0, 1.0) * np.sin(2.0 * math.pi / 6.0 * time)
    return place


def net(knots: int, duration: float) -> Deck:
    """Return the net of ``knots`` x ``knots`` points, one bar a twine."""
    builder = NetworkBuilder(Water(60.0, DENSITY, GRAVITY))
    twine = BarType(
        "twine",
        0.36,
        2e5,
        0.02,
        viscosity=100.0,
        drag_normal=1.2,
        drag_tangential=0.01 * math.pi,
        added_mass_normal=1.0,
    )
    grid = np.zeros((knots, knots, 3))
    grid[..., 1], grid[..., 2] = np.arange(knots)[None, :], -1.0 - np.arange(knots)[:, None]
    builder.net("net", grid, twine, lengths=(1.0, 1.0))
    return builder.build(), {"net": Motion.from_function(_tow, duration=duration, step=0.01)}
