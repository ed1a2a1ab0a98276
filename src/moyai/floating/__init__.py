"""Rigid floating bodies: statics, frequency domain, time domain with memory."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.floating.coefficients import Hydrodynamics as Hydrodynamics
    from moyai.floating.damping import LinearDamping as LinearDamping
    from moyai.floating.damping import QuadraticDamping as QuadraticDamping
    from moyai.floating.decay import Decay as Decay
    from moyai.floating.decay import fit_decay as fit_decay
    from moyai.floating.forcing import Forcing as Forcing
    from moyai.floating.forcing import IrregularForcing as IrregularForcing
    from moyai.floating.forcing import RegularForcing as RegularForcing
    from moyai.floating.frequency import Motions as Motions
    from moyai.floating.frequency import solve_motions as solve_motions
    from moyai.floating.irregular import ResponseStatistics as ResponseStatistics
    from moyai.floating.irregular import SeaMotions as SeaMotions
    from moyai.floating.irregular import energy_transmission as energy_transmission
    from moyai.floating.irregular import linearised_in_sea as linearised_in_sea
    from moyai.floating.irregular import response_statistics as response_statistics
    from moyai.floating.memory import StateSpaceMemory as StateSpaceMemory
    from moyai.floating.modes import NaturalModes as NaturalModes
    from moyai.floating.modes import natural_modes as natural_modes
    from moyai.floating.offset import LinearMooring as LinearMooring
    from moyai.floating.offset import MeanOffset as MeanOffset
    from moyai.floating.offset import Mooring as Mooring
    from moyai.floating.offset import mean_offset as mean_offset
    from moyai.floating.statics import FloatingEquilibrium as FloatingEquilibrium
    from moyai.floating.statics import HullLike as HullLike
    from moyai.floating.statics import Hydrostatics as Hydrostatics
    from moyai.floating.statics import RightingCurve as RightingCurve
    from moyai.floating.statics import SectionLike as SectionLike
    from moyai.floating.statics import find_equilibrium as find_equilibrium
    from moyai.floating.statics import hydrostatics as hydrostatics
    from moyai.floating.statics import inertia_matrix as inertia_matrix
    from moyai.floating.statics import righting_curve as righting_curve
    from moyai.floating.time import CumminsModel as CumminsModel
    from moyai.floating.time import Simulation as Simulation
    from moyai.floating.time import choose_time_step as choose_time_step
    from moyai.floating.time import simulate as simulate
    from moyai.floating.together import simulate_together as simulate_together
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "coefficients": "Hydrodynamics",
            "damping": "LinearDamping QuadraticDamping",
            "decay": "Decay fit_decay",
            "forcing": "Forcing IrregularForcing RegularForcing",
            "frequency": "Motions solve_motions",
            "irregular": "ResponseStatistics SeaMotions energy_transmission linearised_in_sea response_statistics",
            "memory": "StateSpaceMemory",
            "modes": "NaturalModes natural_modes",
            "offset": "LinearMooring MeanOffset Mooring mean_offset",
            "statics": "FloatingEquilibrium HullLike Hydrostatics RightingCurve SectionLike "
            "find_equilibrium hydrostatics inertia_matrix righting_curve",
            "time": "CumminsModel Simulation choose_time_step simulate",
            "together": "simulate_together",
        },
    )
