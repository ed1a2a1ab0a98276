"""Validity notices of floating bodies: they speak when they must and are silent when not."""

from __future__ import annotations

from moyai.floating.checks import check_statics
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
