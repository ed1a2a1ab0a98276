"""Flexible networks: lines, nets and all that hangs, floats and snaps, from equilibrium to the peak of a snap load."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.flexible.bed import Bed as Bed
    from moyai.flexible.build import NetworkBuilder as NetworkBuilder
    from moyai.flexible.elements import BarType as BarType
    from moyai.flexible.elements import RopeCurve as RopeCurve
    from moyai.flexible.elements import SlowStretch as SlowStretch
    from moyai.flexible.ensemble import Ensemble as Ensemble
    from moyai.flexible.ensemble import Member as Member
    from moyai.flexible.ensemble import simulate_together as simulate_together
    from moyai.flexible.failures import LineFailure as LineFailure
    from moyai.flexible.flow import Current as Current
    from moyai.flexible.flow import Flow as Flow
    from moyai.flexible.modes import NetworkModes as NetworkModes
    from moyai.flexible.modes import natural_modes as natural_modes
    from moyai.flexible.motion import Motion as Motion
    from moyai.flexible.network import Network as Network
    from moyai.flexible.refine import refined as refined
    from moyai.flexible.result import Equilibrium as Equilibrium
    from moyai.flexible.result import History as History
    from moyai.flexible.result import State as State
    from moyai.flexible.sensitivity import PeakSensitivity as PeakSensitivity
    from moyai.flexible.sensitivity import peak_sensitivity as peak_sensitivity
    from moyai.flexible.simulation import simulate as simulate
    from moyai.flexible.statics import solve_equilibrium as solve_equilibrium
    from moyai.flexible.worn_law import WornRope as WornRope
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "bed": "Bed",
            "build": "NetworkBuilder",
            "elements": "BarType RopeCurve SlowStretch",
            "ensemble": "Ensemble Member simulate_together",
            "failures": "LineFailure",
            "flow": "Current Flow",
            "modes": "NetworkModes natural_modes",
            "motion": "Motion",
            "network": "Network",
            "refine": "refined",
            "result": "Equilibrium History State",
            "sensitivity": "PeakSensitivity peak_sensitivity",
            "simulation": "simulate",
            "statics": "solve_equilibrium",
            "worn_law": "WornRope",
        },
    )
