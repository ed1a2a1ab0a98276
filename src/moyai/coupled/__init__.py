"""Bodies hung in flexible networks: floating, moored and towed bodies on lines that have mass, drag and snap."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.coupled.equilibrium import CoupledEquilibrium as CoupledEquilibrium
    from moyai.coupled.equilibrium import find_coupled_equilibrium as find_coupled_equilibrium
    from moyai.coupled.hulls import Lumps as Lumps
    from moyai.coupled.hulls import box_hull as box_hull
    from moyai.coupled.hulls import cylinder_hull as cylinder_hull
    from moyai.coupled.planar import PlanarBody as PlanarBody
    from moyai.coupled.rigid import RigidBody as RigidBody
    from moyai.coupled.simulate import CoupledHistory as CoupledHistory
    from moyai.coupled.simulate import simulate_coupled as simulate_coupled
    from moyai.coupled.wave_loads import Excitation as Excitation
    from moyai.coupled.wave_loads import WaveLoads as WaveLoads
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "equilibrium": "CoupledEquilibrium find_coupled_equilibrium",
            "hulls": "Lumps box_hull cylinder_hull",
            "planar": "PlanarBody",
            "rigid": "RigidBody",
            "simulate": "CoupledHistory simulate_coupled",
            "wave_loads": "Excitation WaveLoads",
        },
    )
