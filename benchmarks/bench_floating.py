"""Cost of three hours of an irregular sea on a pontoon with four nonlinear chains, and where it goes.

Prints one JSON line a run. The same run times a bare fourth-order Runge-Kutta integration of the body without lines
and memory (the least that three hours can cost with this method), so that ratios hold on any machine.

    OMP_NUM_THREADS=1 python benchmarks/bench_floating.py
"""

from __future__ import annotations

import json
import time

import numpy as np

from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import LinearDamping
from moyai.floating.far_field import drift_force_per_amplitude_squared, far_field
from moyai.floating.forcing import IrregularForcing
from moyai.floating.frequency import solve_motions
from moyai.floating.lines import PlanarMooring
from moyai.floating.memory import StateSpaceMemory
from moyai.floating.statics import hydrostatics, inertia_matrix
from moyai.floating.time import CumminsModel, simulate
from moyai.mooring.lines import Line, LineType, Segment
from moyai.mooring.system import LineSystem
from moyai.potential import shapes
from moyai.potential.rectangle import solve_rectangle
from moyai.sea.irregular import synthesise
from moyai.sea.spectra import jonswap
from moyai.sea.water import Water

BEAM, DRAUGHT, LENGTH, CENTRE_Z = 10.0, 3.0, 21.0, -0.71
WATER = Water(depth=10.0, density=1025.0, gravity=9.81)


def lines(count: int) -> LineSystem:
    """Return chains of the prototype, each solved for itself so that four cost four."""
    chain = LineType("68 mm chain", submerged_weight=79.2 * 9.81, axial_stiffness=3.9e8)
    return LineSystem(
        tuple(
            Line(
                f"chain {number}",
                anchor=((-1.0) ** number * 55.6, 5.0 * (number // 2), -10.0),
                fairlead=((-1.0) ** number * 5.0, 5.0 * (number // 2), 0.0),
                segments=(Segment(chain, 51.97),),
            )
            for number in range(count)
        ),
        WATER.depth,
    )


def memory_of(hydro_per_metre: Hydrodynamics) -> StateSpaceMemory:
    """Return the memory of the unit by the rational fit of its damping."""
    from moyai.potential.damping_model import fit_damping
    from moyai.potential.memory import steady_damping
    from moyai.potential.state_space import fit_memory

    steady = LENGTH * steady_damping([0.0, BEAM, 0.0], WATER)
    damping = hydro_per_metre.radiation_damping * LENGTH
    return StateSpaceMemory.of(
        fit_memory(fit_damping(hydro_per_metre.omega, damping, start="even", steady_damping=steady))
    )


def main() -> None:
    """Set the body up, run three hours with and without tables, print the cost."""
    section = shapes.rectangle(BEAM, 4.5).immersed(DRAUGHT)
    mass = 0.985 * 1025.0 * section.area * LENGTH
    statics = hydrostatics(
        section, mass=mass, centre_of_gravity=(0.0, CENTRE_Z), length=LENGTH, density=1025.0, gravity=9.81
    )
    inertia = inertia_matrix(mass, 2.67)
    omega = np.concatenate([np.linspace(0.1, 4.0, 80), np.linspace(4.1, 12.0, 40)])
    solution = solve_rectangle(BEAM, DRAUGHT, WATER, omega, centre=(0.0, CENTRE_Z))
    per_metre = Hydrodynamics.from_dataset(solution.dataset)
    hydro = per_metre.scaled_to(LENGTH)
    memory = memory_of(per_metre)
    rest, centre = (0.0, CENTRE_Z, 0.0), (0.0, DRAUGHT + CENTRE_Z)
    started = time.process_time()
    tabulated = PlanarMooring.of(lines(4), rest=rest, centre=centre, motion_range=(1.5, 1.5, 0.3), tolerance=1e-4)
    tabulation = time.process_time() - started
    exact = PlanarMooring.of(lines(4), rest=rest, centre=centre)
    stiffness = statics.stiffness + exact.stiffness(np.zeros(3))
    linear = LinearDamping.of_modes(critical_fraction=[0.15] * 3)
    motions = solve_motions(hydro, inertia, stiffness, damping=linear)
    drift = drift_force_per_amplitude_squared(
        far_field(hydro, motions.displacement), hydro.omega, hydro.heading, WATER, LENGTH
    )[:, 0]
    started = time.process_time()
    sea = synthesise(jonswap(1.0, 4.8, 3.3), WATER, duration=10800.0, seed=1)
    forcing = IrregularForcing.of_sea(sea, hydro, drift_per_amplitude_squared=drift, ramp=60.0)
    synthesis = time.process_time() - started
    infinite = hydro.infinite_frequency_added_mass
    assert infinite is not None
    damping = linear.at(inertia, infinite, stiffness)
    bare = CumminsModel(inertia + infinite, stiffness, damping, StateSpaceMemory.none(3))
    results = []
    for name, mooring in (("tables", tabulated), ("exact lines", exact), ("bare body", None)):
        model = (
            bare if mooring is None else CumminsModel(inertia + infinite, statics.stiffness, damping, memory, mooring)
        )
        simulate(model, forcing, duration=70.0)
        started = time.process_time()
        run = simulate(model, forcing, duration=10860.0, expected_motion=(1.0, 0.6, 0.15))
        total = time.process_time() - started
        results.append((name, total, run))
    floor = results[-1][2].cost["kernel"]
    for name, total, run in results:
        record = {
            "benchmark": "three hours of irregular sea, four chains",
            "lines": name,
            "status": run.status,
            "time_step_s": round(run.time_step, 4),
            "steps": int(run.cost["steps"]),
            "memory_poles": 0 if name == "bare body" else len(memory.poles),
            "cpu_s": round(total, 3),
            "excitation_s": round(run.cost["excitation"], 3),
            "kernel_s": round(run.cost["kernel"], 3),
            "kernel_over_bare_body": round(run.cost["kernel"] / floor, 2),
            "sea_synthesis_s": round(synthesis, 3),
            "tabulation_s": round(tabulation if name == "tables" else 0.0, 3),
            "largest_tension_kN": round(float(run.tension.max()) / 1e3, 2) if run.tension.size else None,
            "table_error": tabulated.compiled.measured_error if name == "tables" else None,
        }
        print(json.dumps(record))
    started = time.process_time()
    states = exact.states(results[0][2].position)
    print(
        json.dumps(
            {
                "benchmark": "exact tensions at both ends of every instant",
                "instants": len(results[0][2].time),
                "cpu_s": round(time.process_time() - started, 3),
                "largest_anchor_tension_kN": round(
                    max(float(s.tension_anchor.max()) for s in states.values()) / 1e3, 2
                ),
            }
        )
    )
    difference = np.max(np.abs(results[0][2].position - results[1][2].position), axis=0)
    print(
        json.dumps(
            {"benchmark": "tables against exact lines, largest difference of motion", "value": difference.tolist()}
        )
    )


if __name__ == "__main__":
    main()
