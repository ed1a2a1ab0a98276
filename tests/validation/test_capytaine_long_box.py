"""Capytaine, three-dimensional, on long boxes: the section is approached per metre as the box grows (mid band).

Set MOYAI_PEER_PYTHON to an interpreter with Capytaine, or install the extra ``peers``. Lengths of 60 and 120 m; the
ends make a difference of order 1/length, most of which one step of extrapolation removes. Differences are over the
largest value of a coefficient from 0.5 to 2.5 rad/s: near its zero the ends are all that is left of heave damping.
"""

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from moyai.potential import shapes
from moyai.potential.modes import rigid_modes
from moyai.potential.solver import solve
from moyai.sea.water import Water

pytestmark = [pytest.mark.peer, pytest.mark.slow]
SCRIPT = Path(__file__).resolve().parents[2] / "benchmarks" / "peer_capytaine.py"


def interpreter():
    candidate = os.environ.get("MOYAI_PEER_PYTHON")
    if candidate:
        probe = subprocess.run([candidate, "-c", "import capytaine"], capture_output=True, check=False)
        if probe.returncode == 0:
            return candidate
    return sys.executable if importlib.util.find_spec("capytaine") else None


@pytest.mark.skipif(interpreter() is None, reason="Capytaine is not installed and MOYAI_PEER_PYTHON does not name one")
def test_long_box_in_the_middle_of_the_band():
    omega = np.array([1.2, 1.8])
    case = {"beam": 10.0, "draught": 3.0, "depth": 10.0, "lid": True, "density": 1000.0, "omega": omega.tolist()}
    boxes = {}
    for length, panels in ((60.0, 800), (120.0, 1600)):
        done = subprocess.run(
            [interpreter(), str(SCRIPT)],
            input=json.dumps({**case, "length": length, "panels": panels}),
            capture_output=True,
            text=True,
            check=True,
            env={**os.environ, "OMP_NUM_THREADS": "1"},
        )
        boxes[length] = json.loads(done.stdout[done.stdout.index("{") :])
    section, water, modes = (
        shapes.rectangle(10.0, 4.5).immersed(3.0),
        Water(10.0, 1000.0, 9.81),
        rigid_modes((0.0, 0.0)),
    )
    found, band = (solve(section, water, items, modes=modes) for items in (omega, np.linspace(0.5, 2.5, 21)))
    for index, mode in enumerate(("sway", "heave")):
        for name in ("added_mass", "radiation_damping"):
            ours = getattr(found, name)[:, index, index]
            short, long = (np.array(boxes[length][name][mode]) for length in (60.0, 120.0))
            endless = 2.0 * long - short
            largest = np.abs(getattr(band, name)[:, index, index]).max()
            assert np.abs(endless - ours).max() < 0.04 * largest, (mode, name)
