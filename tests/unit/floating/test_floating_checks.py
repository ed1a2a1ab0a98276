"""Validity notices of floating bodies: they speak when they must and are silent when not."""

from __future__ import annotations

import numpy as np

from moyai.floating.checks import check_motion, check_statics
from moyai.floating.statics import hydrostatics
from moyai.potential import shapes


def _statics(mass: float, height: float):  # type: ignore[no-untyped-def]
    section = shapes.rectangle(4.0, 3.0).immersed(1.5)
    return hydrostatics(section, mass=mass, centre_of_gravity=(0.0, height), length=10.0, density=1000.0, gravity=9.81)


def test_statics() -> None:
    assert check_statics(_statics(59000.0, -0.5), vertical_pull=1000.0 * 9.81, gravity=9.81) == ()
    codes = [notice.code for notice in check_statics(_statics(57000.0, 2.0), vertical_pull=0.0, gravity=9.81)]
    assert codes == ["imbalance", "unstable"]
    notice = check_statics(_statics(57000.0, -0.5), vertical_pull=0.0, gravity=9.81)[0]
    assert abs(notice.value - 5.0) < 1e-9 and notice.limit == 1.0


def test_motion() -> None:
    assert check_motion(np.array([3.0, 0.5, 0.1]), draught=1.5, freeboard=1.5) == ()
    codes = [n.code for n in check_motion(np.array([[0.0, 0.9, 0.0], [0, 0, 0.3]]), draught=1.5, freeboard=1.5)]
    assert codes == ["large-roll", "large-heave"]
    assert [n.code for n in check_motion(np.array([0.0, np.nan, 0.0]), draught=1.0, freeboard=1.0)] == [
        "motion-not-finite"
    ]
