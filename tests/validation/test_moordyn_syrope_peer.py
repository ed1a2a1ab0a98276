"""A Syrope rope through time against MoorDyn 2.7.2: relaxation, cycles, a new highest tension."""

import math
import os
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from moyai.flexible import BarType, NetworkBuilder, simulate, solve_equilibrium
from moyai.flexible.motion import Motion
from moyai.flexible.worn_law import WornRope
from moyai.sea.water import Water

pytestmark = pytest.mark.peer
SHARED = Path(os.environ.get("MOYAI_SHARED_DATA", Path(__file__).parents[3].parent / "shared" / "data"))
POINTS = np.linspace(0.0, 0.06, 25)  # MoorDyn takes no more than thirty
CURVE = np.array([POINTS, 6e7 * POINTS + 2e8 * POINTS**2])
HIGHEST, ALPHA, BETA, SLOW, QUICK, START = 1.2e6, 1.5e8, 23.0, 5e9, 1e5, 0.013
DECK = """\
one segment without weight
----- LINE TYPES -----
LineType Diam MassDenInAir EA BA/-zeta EI Can Cat Cdn Cdt
(-) (m) (kg/m) (-) (Pa-s/-) (n-m^2) (-) (-) (-) (-)
poly 0.203 40 SYROPE:law.dat|{alpha}|{beta} {slow}|{quick} 0.0 0.0 0.0 0.0 0.0
----- POINTS -----
Node Type X Y Z M V CdA CA
(-) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Fixed 0.0 0 -5.0 0 0 0 0
2 Coupled {length} 0 -5.0 0 0 0 0
----- LINES -----
Line LineType NodeA NodeB UnstrLen NumSegs Flags/Outputs
(-) (-) (-) (-) (m) (-) (-)
1 poly 2 1 1.0 1 -
----- SYROPE IC -----
Line(s) Tmax0 Tmean0
(-) (N) (N)
1 {highest} {mean}
----- SOLVER OPTIONS -----
0 writeLog
0 g
1025 rho
0.02 dtM
70 WtrDpth
1.0 TmaxIC
0.01 dtIC
----- need this line -----
"""


def of_moordyn(folder, form, k1, k2, strain, step, mean):
    """Return the tension after every step of a strain history."""
    moordyn = pytest.importorskip("moordyn")
    # MoorDyn passes over three lines of a curve
    rows = "\n".join(f"{e:.6e} {t:.6e}" for e, t in CURVE.T)
    (folder / "owc.dat").write_text(f"curve\nStrain Tension\n(-) (N)\n{rows}")
    (folder / "law.dat").write_text(f"owc.dat OWC\n{form} WCType\n{k1} k1\n{k2} k2\n")
    (folder / "deck.txt").write_text(
        DECK.format(alpha=ALPHA, beta=BETA, slow=SLOW, quick=QUICK, length=1.0 + strain[0], highest=HIGHEST, mean=mean)
    )
    system = moordyn.Create(str(folder / "deck.txt"))
    moordyn.Init(system, [1.0 + strain[0], 0.0, -5.0], [0.0, 0.0, 0.0])
    found = []
    for number, (now, then) in enumerate(pairwise(strain)):
        force = moordyn.Step(system, [1.0 + now, 0.0, -5.0], [(then - now) / step, 0.0, 0.0], number * step, step)
        found.append(float(np.linalg.norm(force)))
    moordyn.Close(system)
    return np.array(found)


@pytest.mark.parametrize(
    ("form", "kind", "k1", "k2"),
    [("LINEAR", "linear", 0.25, 1.0), ("QUADRATIC", "quadratic", 0.25, 1.0), ("EXP", "exponential", 0.25, 1.5)],
)
def test_strain_histories(tmp_path, form, kind, k1, k2):
    """Cycles of 200 s about a strain that stays, then one that rises beyond all that was borne before."""
    law = WornRope(*CURVE, kind, k1, k2, ALPHA, BETA, SLOW, HIGHEST)
    step = 2.0
    time = step * np.arange(301)
    wave = 0.0015 * np.sin(2.0 * math.pi * time / 200.0) * np.clip(time / 100.0, 0.0, 1.0)
    strain = START + wave + 0.014 * np.clip((time - 350.0) / 250.0, 0.0, 1.0)
    rest = float(np.interp(START, *law.curve_at_rest()))
    theirs = of_moordyn(tmp_path, form, k1, k2, strain, step, rest)
    builder = NetworkBuilder(Water(100.0, 1e-3, 9.81))
    builder.fixed("left", (0.0, 0.0, 50.0))
    builder.driven("right", (1.0 + START, 0.0, 50.0))
    bar = BarType("rope", 40.0, ALPHA, 0.0, volume_per_length=0.0, viscosity=QUICK, slow=law)
    builder.line("rope", "left", "right", bar, length=1.0, segments=1)
    network = builder.build()
    place = np.zeros((len(time), 3))
    place[:, 0] = strain - START
    speed = np.gradient(place, step, axis=0)
    history = simulate(
        network, {"right": Motion(0.0, step, place, speed)}, duration=float(time[-1]), output_step=step,
        start=solve_equilibrium(network).state, method="tr_bdf2", tolerance=1e-6,
    )  # fmt: skip
    assert history.status == "converged"
    ours = history.tension[1:, 0]
    assert rest == pytest.approx(ours[0], rel=0.05)
    assert ours.max() > 1.3 * HIGHEST
    assert np.abs(ours - theirs).max() < 0.012 * theirs.max()
