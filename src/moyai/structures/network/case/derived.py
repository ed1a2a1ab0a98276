"""Numbers that follow from a network case before it is run."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from moyai.case.derived import Number

if TYPE_CHECKING:
    from moyai.case.reader import Case

#: Node-steps per second of the explicit scheme on an ordinary machine, for the expected time of a run.
_NODE_STEPS_PER_SECOND = 6e6
#: Time of a run side by side with others over that of one alone.
_SIDE_BY_SIDE = 0.4


def derived_numbers(case: Case) -> tuple[Number, ...]:
    """Return counts, weights, wave speeds, the stable step and the expected time of a run, at every water level."""
    from moyai.case.builder import build
    from moyai.flexible.ensemble import members_together
    from moyai.flexible.explicit import LOAD_STEPS, ExplicitRun
    from moyai.flexible.flow import Flow
    from moyai.flexible.motion import Motion
    from moyai.flexible.result import State
    from moyai.sea.dispersion import wave_number
    from moyai.structures.network import realisations
    from moyai.structures.network.assembly import assemble
    from moyai.structures.network.refinement import DOUBTFUL_WORK, LADDER_WORK
    from moyai.structures.network.runs import run_plans

    problem = build(case)
    numbers: list[Number] = []
    for name, level in problem.environment.water_levels:
        water = problem.environment.water_at(level)
        assembly = assemble(problem, level)
        network = assembly.network

        def add(group: str, label: str, value: float, unit: str = "", digits: int = 4, *, column: str = name) -> None:
            numbers.append(Number(group, column, label, float(value), unit, digits))

        weight = float(np.sum(network.node_mass - water.density * network.node_volume)) * water.gravity
        add("network", "nodes", len(network.nodes))
        add("network", "bars", len(network.bars))
        add("network", "mass", float(network.node_mass.sum()), "kg")
        add("network", "weight in water, all wet", weight, "kN")
        per_length = np.array([kind.submerged_weight_per_length(water) for kind in network.bars.types])
        for line in problem.lines:
            strand = assembly.lines[line.name]
            bars = network.bars
            own = per_length[bars.kind[strand.bars]] * bars.length[strand.bars]
            speed = np.sqrt(bars.of_type("axial_stiffness") / bars.of_type("mass_per_length"))[strand.bars]
            add(line.name, "length", line.length, "m")
            add(line.name, "weight in water", own.sum(), "kN")
            add(line.name, "speed of elastic waves", speed.min(), "m/s")
            add(line.name, "time of an elastic wave along it", float(np.sum(bars.length[strand.bars] / speed)), "s")
            if math.isfinite(line.breaking_load):
                add(line.name, "breaking load", line.breaking_load, "kN")
        if "dynamic" not in problem.settings.analyses:
            continue
        still = {key: Motion(0.0, 1.0, np.zeros((2, 3)), np.zeros((2, 3))) for key in network.motion_names}
        explicit = ExplicitRun(network, still, Flow(), State.at_rest(network), safety=None, load_steps=LOAD_STEPS)
        step = problem.settings.step or min(explicit.limit()[0] * explicit.safety, 1e9)
        add("run", "stable step of the explicit scheme", explicit.limit()[0], "s")
        for plan in run_plans(problem, water):
            cost = plan.duration / step * len(network.nodes) / _NODE_STEPS_PER_SECOND
            components = 0 if plan.waves is None else len(plan.waves)
            cost += plan.duration / plan.flow.update_interval * len(network.nodes) * components * 6e-8
            group = f"run '{plan.name}'"
            add(group, "duration", plan.duration, "s")
            add(group, "time between rows", plan.output_step, "s")
            if problem.settings.method in ("auto", "explicit"):
                add(
                    group,
                    "expected time of computing, about",
                    cost * (5 if problem.settings.sensitivity else 1),
                    "s",
                    2,
                )
                if problem.settings.mesh_check == "auto" and not (problem.settings.sensitivity or problem.bodies):
                    further = min(10.0 * cost, (DOUBTFUL_WORK + LADDER_WORK) / _NODE_STEPS_PER_SECOND)
                    add(group, "with the checks of mesh and step, at most about", cost + further, "s", 2)
                if plan.seed >= 0 and not (problem.bodies or problem.failures) and members_together(network):
                    asked = problem.settings.realisations
                    further = _SIDE_BY_SIDE * cost * ((asked or realisations.MOST) - 1)
                    if asked is None:
                        further = min(further, _SIDE_BY_SIDE * realisations.DOUBTFUL_WORK / _NODE_STEPS_PER_SECOND)
                    add(group, "further realisations of the sea, at most about", further, "s", 2)
            if plan.waves is not None:
                length = 2.0 * math.pi / wave_number(2.0 * math.pi / plan.period, water.depth, water.gravity)
                add(group, "wave length", length, "m")
    return tuple(numbers)
