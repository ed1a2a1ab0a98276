"""The design state of a flexible cage under the laws of nets that were measured on nets like its own."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.at_once import each_counted
from moyai.core.progress import Progress, silent
from moyai.morison.net_law_base import NetLaw
from moyai.morison.net_law_choice import METAL, LawChoice, law_choice
from moyai.structures.cage.flexible.build import build_cage
from moyai.structures.cage.flexible.equilibrium import (
    CageEquilibrium,
    collar_forces,
    horizontal_balance,
    ring_shape,
    solve_cage_equilibrium,
)
from moyai.structures.cage.flexible.loads import pull_on_anchors
from moyai.structures.cage.flexible.model import FlexibleCage
from moyai.structures.cage.flexible.variables import described

if TYPE_CHECKING:
    import xarray as xr


def choice_of(model: FlexibleCage, speed: float) -> LawChoice:
    """Return the laws that were measured on nets like that of a cage, at a speed [m/s]."""
    net = model.design.net
    return law_choice(net.law, net.net, speed, model.kinematic_viscosity, metal=net.density > METAL)


def laws_dataset(
    model: FlexibleCage,
    rest: CageEquilibrium,
    calm: CageEquilibrium,
    speed: float,
    heading: float,
    progress: Progress = silent,
) -> xr.Dataset:
    """Return the equilibrium in the current of the site under the law of the case and under every other valid one.

    Parameters
    ----------
    model : FlexibleCage
    rest : CageRest
        In the current of the site, under the law of the case.
    calm : CageRest
        In the slowest current, from which offsets count.
    speed, heading : float
        Of the current at the surface [m/s], [rad].
    progress : Progress
    """
    import xarray as xr

    choice = choice_of(model, speed)
    laws: tuple[NetLaw, ...] = (choice.chosen, *choice.others)

    def at_rest(law: NetLaw, heard: Progress) -> CageEquilibrium:
        other = replace(model, design=replace(model.design, net=replace(model.design.net, law=law)))
        return solve_cage_equilibrium(other, build_cage(other), rest.current, start=rest.state, progress=heard)

    found = [rest, *each_counted("laws of nets", at_rest, choice.others, progress)]
    lines = [_line_tensions(one) for one in found]
    rows = [_numbers(model, one, calm, heading, own) for one, own in zip(found, lines, strict=True)]
    coefficients = [
        float(law.coefficients(0.0, speed, model.design.net.net, model.kinematic_viscosity)[0]) for law in laws
    ]
    return described(
        xr.Dataset(
            {
                "normal_drag_coefficient": ("law", np.array(coefficients)),
                "law_line_tension": (("law", "line"), np.array(lines)),
                **{f"law_{name}": ("law", np.array([row[name] for row in rows])) for name in rows[0]},
            },
            coords={"law": [law.name for law in laws], "line": [part.name for part in rest.built.lines]},
            attrs={"speed": speed, "valid": choice.named, "reynolds": choice.reynolds},
        )
    )


def _line_tensions(rest: CageEquilibrium) -> list[float]:
    """Return the largest tension of each line [N]."""
    strands = rest.built.network.strands
    return [float(rest.tension[strands[part.strand].bars].max()) for part in rest.built.lines]


def _numbers(
    model: FlexibleCage, rest: CageEquilibrium, calm: CageEquilibrium, heading: float, lines: list[float]
) -> dict[str, float]:
    """Return what the first page shows of one rest."""
    built, position = rest.built, rest.state.position
    along = np.array([math.cos(heading), math.sin(heading), 0.0])
    split, _ = horizontal_balance(rest)
    places = [
        ring_shape(cage, place, built.network.nodes.position)[0]
        for place in (position, calm.state.position) for cage in built.cages
    ]  # fmt: skip
    half = len(built.cages)
    offset = max(float(np.linalg.norm((now - before)[:2])) for now, before in zip(places[:half], places[half:]))
    pulls = pull_on_anchors(built, rest.network, position, rest.tension)
    return {
        "volume_share": min(float(cage.volume(position)) / cage.rest_volume for cage in built.cages),
        "drag": float(split.sum(axis=0) @ along),
        "line_tension_maximum": max(lines, default=math.nan),
        "largest_offset": offset,
        "anchor_tension_maximum": float(np.linalg.norm(pulls, axis=1).max()) if built.anchors.size else math.nan,
        "net_tension": float(built.net_tension(rest.tension).max()),
        "collar_stress": _collar_stress(model, rest),
        "residual": rest.residual,
    }


def _collar_stress(model: FlexibleCage, rest: CageEquilibrium) -> float:
    """Return the largest stress of the collars [Pa]; NaN for a collar that is rigid or a plain frame."""
    if not rest.built.cages[0].collar_bars or model.design.collar.rigid:
        return math.nan
    forces = collar_forces(model, rest, rest.state.position, rest.tension)
    return max(float(ring["stress"].max()) for rings in forces for ring in rings)
