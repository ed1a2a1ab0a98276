"""A motion that begins with speed: both families of schemes give the same tensions once the start is past."""

import numpy as np

from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType
from moyai.flexible.motion import Motion
from moyai.flexible.simulation import simulate
from moyai.flexible.statics import solve_equilibrium
from moyai.sea.water import Water


def test_a_start_with_speed_is_forgotten():
    builder = NetworkBuilder(Water(100.0, 1000.0, 9.81))
    builder.fixed("anchor", (-100.0, 0.0, -55.0))
    builder.driven("fairlead", (0.0, 0.0, -5.0))
    kind = BarType("jumper", 165.0, 5e8, 0.396, viscosity=3.6e5, drag_normal=1.0, added_mass_normal=1.0)
    builder.line("line", "anchor", "fairlead", kind, length=170.0, segments=34)
    network = builder.build()
    start = solve_equilibrium(network).state
    motion = {"fairlead": Motion.harmonic((10.0, 0.0, 0.0), 27.0, duration=82.0)}
    explicit, implicit = (
        simulate(network, motion, duration=81.0, output_step=0.1, start=start, method=method).tension[-270:, -1]
        for method in ("explicit", "tr_bdf2")
    )
    np.testing.assert_allclose(explicit, implicit, rtol=0.02)
