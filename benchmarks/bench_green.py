"""Influence of all panels of a box on each other: the Green function of moyai against Capytaine's, in the same run.

    python benchmarks/bench_green.py

Prints JSON lines: processor time of both for one frequency, per pair of panels, and their ratio; what differs, the
median over the largest. 1/r and its mirrors, which moyai finds once for all frequencies, are listed apart.
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from capytaine.green_functions.delhommeau import Delhommeau

from moyai.potential import shapes
from moyai.sea.dispersion import wave_number
from moyai.sea.water import Water
from moyai.structures.units.bem import MeshPanels, panels_of
from moyai.structures.units.mesh import unit_mesh
from moyai.structures.units.wave_green import WaveGreen
from moyai.validation._capytaine import capytaine_mesh, closer_green_function

WATERS = ((10.0, 12.0), (10.0, 6.0), (10.0, 3.0), (math.inf, 4.0))
REPEATS = 3


def least(work: Callable[..., Any], *arguments: Any) -> tuple[float, Any]:
    """Return the least processor time [s] of some repeats, and what came out."""
    times = []
    for _ in range(REPEATS):
        begin = time.process_time()
        found = work(*arguments)
        times.append(time.process_time() - begin)
    return min(times), found


def own_layers(panels: MeshPanels, water: Water, omega: float) -> Any:
    """Return the layers of the waves, their tables made anew."""
    centre = panels.mesh.centre
    return WaveGreen.of(water, omega, panels.reach(centre), panels.lowest).layers(centre, panels.wave_panels)


def other_layers(mesh: Any, depth: float, k: float) -> Any:
    """Return all of the layers by Capytaine."""
    engine = Delhommeau() if math.isinf(depth) else closer_green_function()
    return engine.evaluate(
        mesh, mesh, free_surface=0.0, water_depth=depth, wavenumber=k, adjoint_double_layer=False,
        diagonal_term_in_double_layer=False,
    )  # fmt: skip


def main() -> None:
    """Time both in waters of several depths."""
    mesh = unit_mesh(shapes.rectangle(10.0, 4.5).immersed(3.0), 20.0, 2.0, lid=True)
    panels = replace(panels_of(mesh, np.zeros((1, 3))), even=True)
    other, pairs = capytaine_mesh(mesh.corners), mesh.count**2
    panels.even_rankine(mesh.centre, 10.0)
    steady = least(panels.even_rankine, mesh.centre, 10.0)[0]
    print(json.dumps({"what": "1/r and its mirrors, once", "nanoseconds a pair": round(1e9 * steady / pairs, 1)}))
    for depth, period in WATERS:
        water, omega = Water(depth=depth, density=1025.0, gravity=9.81), 2.0 * math.pi / period
        k = float(wave_number(omega, depth, 9.81))
        other_layers(other, depth, k)
        own, layers = least(own_layers, panels, water, omega)
        theirs, found = least(other_layers, other, depth, k)
        even = panels.even_rankine(mesh.centre, depth)
        apart = [
            float(np.median(np.abs(one + part - two)) / np.abs(two).max())
            for one, part, two in zip(layers, even, found, strict=True)
        ]
        row = {
            "water depth": depth, "period": period, "nanoseconds a pair": round(1e9 * own / pairs, 1),
            "of Capytaine": round(1e9 * theirs / pairs, 1), "ratio": round(theirs / own, 1),
            "single layer apart": float(f"{apart[0]:.1g}"), "double layer apart": float(f"{apart[1]:.1g}"),
        }  # fmt: skip
        print(json.dumps(row), flush=True)


if __name__ == "__main__":
    main()
