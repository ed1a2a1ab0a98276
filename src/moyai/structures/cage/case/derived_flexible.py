"""Derived numbers of a flexible cage case: volume, net, weights, collar, mesh."""

from __future__ import annotations

import numpy as np

from moyai.case.builder import build
from moyai.case.derived import Number
from moyai.case.reader import Case
from moyai.structures.cage.flexible.afloat import floating_balance
from moyai.structures.cage.flexible.build import build_cage
from moyai.structures.cage.flexible.problem import FlexibleCageProblem


def derived_numbers(case: Case) -> tuple[Number, ...]:
    """Return the derived numbers of a flexible cage case."""
    problem: FlexibleCageProblem = build(case)
    numbers: list[Number] = []
    for name, level in problem.environment.water_levels:
        model = problem.at_level(level)
        built = build_cage(model)
        design, net = model.design, model.design.net
        panels = built.network.panels
        assert panels is not None
        first = built.cages[0]
        area = float(panels.area[np.concatenate([first.wall_panels, first.bottom_panels])].sum())
        weight, spare = floating_balance(model.design, model.water)
        numbers.extend(
            [
                Number("Cage", name, "volume inside the net", first.rest_volume, "m3"),
                Number("Cage", name, "outline area of the net", area, "m2"),
                Number("Cage", name, "solidity of the net, geometric", net.net.solidity, ""),
                Number("Cage", name, "mass of the net in air", area * net.mass_per_area, "kg"),
                Number("Cage", name, "weight of net and weights in water", weight, "N"),
            ]
        )
        if built.anchors.size:
            pipe = design.collar.pipe
            numbers.extend(
                [
                    Number("Collar", name, "buoyancy, wholly immersed", spare, "N"),
                    Number("Collar", name, "EA of a ring", pipe.axial_stiffness, "N"),
                    Number("Collar", name, "EI of a ring", design.collar.bending_stiffness, "N m2"),
                ]
            )
        numbers.extend(
            [
                Number("Mesh", name, "knots", float(len(built.network.nodes)), ""),
                Number("Mesh", name, "bars", float(len(built.network.bars)), ""),
                Number("Mesh", name, "panels", float(len(panels)), ""),
            ]
        )
    return tuple(numbers)
