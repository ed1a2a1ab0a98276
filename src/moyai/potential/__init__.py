"""Two-dimensional linear potential theory: sections, boundary integrals, radiation, diffraction, memory, drift."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.potential import shapes as shapes
    from moyai.potential.damping_model import DampingModel as DampingModel
    from moyai.potential.damping_tail import TailTheory as TailTheory
    from moyai.potential.damping_tail import wall_sided_tails as wall_sided_tails
    from moyai.potential.drift import FarFieldDrift as FarFieldDrift
    from moyai.potential.drift import NearFieldDrift as NearFieldDrift
    from moyai.potential.drift import mean_drift_far_field as mean_drift_far_field
    from moyai.potential.drift import mean_drift_near_field as mean_drift_near_field
    from moyai.potential.field import surface_elevation as surface_elevation
    from moyai.potential.memory import MemoryFunctions as MemoryFunctions
    from moyai.potential.memory import memory_functions as memory_functions
    from moyai.potential.memory_plan import FrequencyPlan as FrequencyPlan
    from moyai.potential.memory_plan import MemoryPlan as MemoryPlan
    from moyai.potential.memory_plan import recommend_frequencies as recommend_frequencies
    from moyai.potential.memory_plan import recommend_memory as recommend_memory
    from moyai.potential.modes import Modes as Modes
    from moyai.potential.modes import Rigid as Rigid
    from moyai.potential.modes import rigid_modes as rigid_modes
    from moyai.potential.plates import PlateLine as PlateLine
    from moyai.potential.rectangle import RectangleSolution as RectangleSolution
    from moyai.potential.rectangle import solve_rectangle as solve_rectangle
    from moyai.potential.sections import Hull as Hull
    from moyai.potential.sections import Section as Section
    from moyai.potential.solution import RadiationDiffraction as RadiationDiffraction
    from moyai.potential.solver import solve as solve
    from moyai.potential.state_space import StateSpace as StateSpace
    from moyai.potential.state_space import fit_memory as fit_memory
    from moyai.potential.thin_plate import Plate as Plate
    from moyai.potential.thin_plate import PlateLimit as PlateLimit
    from moyai.potential.thin_plate import solve_plate_limit as solve_plate_limit
    from moyai.potential.thin_plate_waves import PlateWaves as PlateWaves
    from moyai.potential.thin_plate_waves import solve_plate_waves as solve_plate_waves
    from moyai.potential.vertical_barrier import VerticalBarrier as VerticalBarrier
    from moyai.potential.vertical_barrier import solve_vertical_barrier as solve_vertical_barrier
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "": "shapes",
            "damping_model": "DampingModel",
            "damping_tail": "TailTheory wall_sided_tails",
            "drift": "FarFieldDrift NearFieldDrift mean_drift_far_field mean_drift_near_field",
            "field": "surface_elevation",
            "memory": "MemoryFunctions memory_functions",
            "memory_plan": "FrequencyPlan MemoryPlan recommend_frequencies recommend_memory",
            "modes": "Modes Rigid rigid_modes",
            "plates": "PlateLine",
            "rectangle": "RectangleSolution solve_rectangle",
            "sections": "Hull Section",
            "solution": "RadiationDiffraction",
            "solver": "solve",
            "state_space": "StateSpace fit_memory",
            "thin_plate": "Plate PlateLimit solve_plate_limit",
            "thin_plate_waves": "PlateWaves solve_plate_waves",
            "vertical_barrier": "VerticalBarrier solve_vertical_barrier",
        },
    )
