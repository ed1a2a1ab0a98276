"""A current near the limit from which drag and inertia are those of steady flow: the judged force does not jump."""

from __future__ import annotations

import pytest

import moyai
from moyai.core.headline import Headline

CASE = """
moyai: 1
title: Pipe, current along its waves
site: {water_depth: 12 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
waves: [{kind: regular, name: design, height: 1.2 m, period: 9 s, heading_deg: 0, theory: linear}]
current: {speed: SPEED, heading_deg: 0}
structure:
  kind: member
  section: {shape: circle, diameter: 1.0 m}
  start: {y: -6 m, z: -6 m}
  end: {y: 6 m, z: -6 m}
  inertia: INERTIA
  drag: {law: dnv_c205, roughness: 3 mm}
  kinematic_viscosity: 1.19e-6 m2/s
  circulation: {purpose: extreme}
analyses: [forces]
settings: {strips: 4}
"""


def _force(inertia: str, ratio: float, orbital: float = 1.0) -> tuple[Headline, float]:
    """Return the largest force, and the orbital speed, in a current of a part of it."""
    result = moyai.run(CASE.replace("INERTIA", inertia).replace("SPEED", f"{ratio * orbital:.6f} m/s"))
    number = {key: float(result.tree["SWL/waves/design"][key].values[0]) for key in (
        "keulegan_carpenter", "coefficient_keulegan_carpenter")}  # fmt: skip
    found = ratio * orbital / (number["coefficient_keulegan_carpenter"] / number["keulegan_carpenter"] - 1.0)
    return next(item for item in result.headlines if item.name == "peak_force"), found


@pytest.mark.slow
@pytest.mark.parametrize("inertia", ["ideal", "dnv_c205"])
def test_the_judged_force_does_not_jump_at_the_limit_of_the_law(inertia: str) -> None:
    """A thousandth of the current to either side: the value steps by per cents, its upper end by a thousandth."""
    found, orbital = {}, 0.5
    for near, ratios in ((0.2, (0.1998, 0.2002)), (0.3, (0.3,)), (0.4, (0.3996, 0.4004))):
        for _ in range(3):
            _, orbital = _force(inertia, near, orbital)
        found |= {ratio: _force(inertia, ratio, orbital)[0] for ratio in ratios}
    ends = {ratio: item.band.high for ratio, item in found.items() if item.band is not None}
    assert found[0.4004].value > 1.015 * found[0.3996].value
    assert ends[0.4004] == pytest.approx(ends[0.3996], rel=2e-3)
    assert ends[0.2002] == pytest.approx(ends[0.1998], rel=2e-3)
    # in between the end rises with the current
    assert ends[0.2002] < ends[0.3] < ends[0.3996]
    for ratio, item in found.items():
        assert ("towards steady flow" in item.band.of) is (0.2 < ratio < 0.4), ratio
