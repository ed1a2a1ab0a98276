"""The dynamic cable: model A without its static cable, nodes that move the water across the cable."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from moyai.core.errors import ConvergenceError, InputError
from moyai.core.options import checks_words
from moyai.flexible.elements import FIXED, Bars, BarType, Nodes, Strand
from moyai.flexible.mass_blocks import MassBlocks
from moyai.flexible.network import Network
from moyai.flexible.result import State
from moyai.flexible.simulation import simulate
from moyai.sea.water import Water
from moyai.structures.curtain.impact.cable import Impact, moved_mass, peak_by_energy
from moyai.structures.curtain.impact.kernels import taut_shape


@dataclass(frozen=True)
class CablePeak:
    """Peak of the dynamic cable, which stands for both."""

    #: Highest anywhere along the cable [N].
    tension: float
    #: When [s].
    time: float
    #: Largest change of kinetic and elastic energy over that of the start [-]; viscosity takes its part.
    energy_drift: float


@checks_words
def dynamic_cable(
    impact: Impact,
    *,
    own_mass: float,
    mass: float | None = None,
    segments: int = 80,
    start: Literal["sag", "uniform"] = "sag",
    damping: float = 0.02,
    convective: bool = True,
    rises: float = 1.6,
) -> CablePeak:
    """Run the cable from its just-taut shape [eq:flexible-block-force].

    Parameters
    ----------
    impact : Impact
        The span; both cables act as one with the sum of their EA.
    own_mass : float
        Of both cables and the skirt per length [kg/m].
    mass : float, optional
        Added mass across the cable per length [kg/m]; M0 of the paper when left out.
    segments : int
    start : {"sag", "uniform"}
        Start speed shaped like the sag, as model A takes it, or the same along the span.
    damping : float
        Viscosity as a part of what would be critical on the mesh [-].
    convective : bool
        Whether the turning and stretching cable keeps the energy of the water; off: the equation as published.
    rises : float
        Length of the run over the rise of model A.

    Raises
    ------
    InputError
        For a cable as long as its span, less than four segments, or a mass that is not positive.
    ConvergenceError
        When the run had to stop.
    """
    shape = taut_shape(impact.span_ratio)
    if shape == 0.0:
        raise InputError(
            "the cable is as long as its span: it has no sag", parameter="length", allowed="more than the span"
        )
    if segments < 4:
        raise InputError(f"{segments} segments", parameter="segments", allowed="4 or more")
    if not (math.isfinite(own_mass) and own_mass > 0.0):
        raise InputError(f"own mass is {own_mass:g} kg/m", parameter="own_mass", allowed="greater than 0")
    moved = moved_mass(impact, mass)
    scale, cell = 0.5 * impact.span / shape, impact.length / segments
    arc = np.linspace(-0.5 * impact.length, 0.5 * impact.length, segments + 1)
    y = scale * np.arcsinh(arc / scale)
    x = scale * (math.cosh(shape) - np.cosh(y / scale))
    place = np.stack([x, y, np.zeros_like(x)], axis=1)
    kind = np.zeros(segments + 1, dtype=np.int64)
    kind[[0, -1]] = FIXED
    held = np.zeros((segments + 1, 3), dtype=np.bool_)
    held[:, 2] = True
    stiffness = impact.stiffness
    viscosity = damping * cell * math.sqrt(stiffness * own_mass)
    rope = BarType("cables", own_mass, stiffness, 0.0, volume_per_length=0.0, viscosity=viscosity)
    number, inner = np.arange(segments), np.arange(1, segments)
    added = np.zeros((segments - 1, 2, 2))
    added[:, 0, 0] = moved * cell
    guides = np.stack([inner - 1, inner + 1], axis=1)[:, None, :]
    length = np.linalg.norm(np.diff(place, axis=0), axis=1)
    network = Network(
        Nodes(place, kind, held), Bars(number, number + 1, length, np.zeros(segments, dtype=np.int64), (rope,)),
        Water(math.inf, impact.water.density, 1e-9), strands=(Strand("cables", np.arange(segments + 1), number),),
        blocks=MassBlocks(inner[:, None], guides, added, convective),
    )  # fmt: skip
    speed = np.zeros_like(place)
    speed[1:-1, 0] = impact.speed * (x[1:-1] / x.max() if start == "sag" else 1.0)
    rise = peak_by_energy(impact, moved).time
    history = simulate(network, duration=rises * rise, output_step=rise / 200.0, start=State(0.0, place, speed))
    if history.status == "interrupted":
        raise KeyboardInterrupt
    if history.status != "converged":
        raise ConvergenceError(history.message, parameter="dynamic_cable")
    highest = history.tension_peak.max(axis=1)
    total = history.kinetic_energy + history.elastic_energy
    drift = float(np.max(np.abs(total / total[0] - 1.0)))
    return CablePeak(float(highest.max()), float(history.time[int(highest.argmax())]), drift)


__all__ = ["CablePeak", "dynamic_cable"]
