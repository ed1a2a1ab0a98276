"""A member in a current without waves: forces by hand, the steady drag of each law, what cannot be asked for."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest

import moyai
from moyai.core.errors import CaseError
from moyai.morison import sections
from moyai.morison.coefficients import CoefficientRule, Conditions, dnv_drag, dnv_steady_drag

CASE = """\
moyai: 1
title: Pile in a river
site: {water_depth: 8 m, density: 1000 kg/m3, gravity: 9.81 m/s2}
current: {speed: 2 m/s, heading_deg: 30}
structure:
  kind: member
  section: {shape: circle, diameter: 0.8 m}
  start: {z: -8 m}
  end: {z: 2 m}
  support: start
  drag: {law: dnv_c205, roughness: 3 mm}
  kinematic_viscosity: 1.1e-6 m2/s
analyses: [forces]
"""


def run(tmp_path: Path, *changes: tuple[str, str]) -> moyai.core.results.Result:
    text = CASE
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (tmp_path / "case.yaml").write_text(text, encoding="utf-8")
    return moyai.run(moyai.load_case(tmp_path / "case.yaml"))


def numbers(result: moyai.core.results.Result) -> dict[str, float]:
    return {item.name: item.value for item in result.headlines}


def test_force_and_moment_of_an_even_current_by_hand(tmp_path: Path) -> None:
    """1/2 rho C_DS D U^2 over the eight wet metres, at half the depth; C_DS of k/D without the factor of waves."""
    steady = (29.0 + 4.0 * math.log10(3e-3 / 0.8)) / 20.0
    force = 0.5 * 1000.0 * steady * 0.8 * 2.0**2 * 8.0
    result = run(tmp_path)
    found = numbers(result)
    assert found["peak_force"] == pytest.approx(force, rel=1e-9)
    assert found["bending_moment"] == pytest.approx(force * 4.0, rel=2e-3)
    assert found["reynolds"] == pytest.approx(2.0 * 0.8 / 1.1e-6)
    assert "keulegan_carpenter" not in found
    (peak,) = [item for item in result.headlines if item.name == "peak_force"]
    assert peak.band is not None and peak.band.low == pytest.approx(0.75 * force)
    assert "C_M" not in peak.band.of and "crest" not in peak.detail
    sea = result.tree["/SWL/waves/current"]
    assert sea["mean_force"].values[0] == pytest.approx(
        [force * math.cos(math.pi / 6.0), force * math.sin(math.pi / 6.0), 0.0], rel=1e-9, abs=1e-6
    )


def test_a_sheared_current_by_quadrature(tmp_path: Path) -> None:
    """U = 2 (1 + z/h)^(1/7): the force is that of the even one over 1 + 2/7, the fastest strip the uppermost."""
    sheared = ("heading_deg: 30}", "heading_deg: 30, profile: {power_law: 0.142857142857}}")
    even, found = numbers(run(tmp_path)), numbers(run(tmp_path, sheared))
    assert found["peak_force"] == pytest.approx(even["peak_force"] / (1.0 + 2.0 / 7.0), rel=5e-3)
    assert found["reynolds"] == pytest.approx(even["reynolds"], rel=5e-3)


def test_steady_drag_is_the_limit_of_the_law_without_its_crest() -> None:
    assert dnv_drag(math.inf, 1e-3) == dnv_steady_drag(1e-3) < dnv_drag(1e3, 1e-3)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("current: {speed: 2 m/s, heading_deg: 30}\n", ""), "neither waves nor a current"),
        (("{law: dnv_c205, roughness: 3 mm}", "{law: stokes_wang}"), "steady"),
        (("analyses: [forces]", "analyses: [sweep]"), "forces"),
        (("  support: start\n", "  support: start\n  motion: {x: 0.1 m, period: 5 s}\n"), "there are none"),
        (
            ("current:", "waves: {name: w, kind: regular, height: 1 m, period: 6 s, heading_deg: 0}\ncurrent:"),
            "circulation",
        ),
    ],
)
def test_what_a_current_alone_cannot_be_asked(tmp_path: Path, change: tuple[str, str], said: str) -> None:
    with pytest.raises(CaseError, match=said):
        run(tmp_path, change)


RIPPLE = "waves: {name: ripple, kind: regular, height: H, period: 5 s, heading_deg: 30}\ncurrent:"


def test_a_ripple_takes_nothing_from_the_drag_of_a_current(tmp_path: Path) -> None:
    """KC of both together is below 8, where waves alone have less than steady drag."""
    deep = (
        "start: {z: -8 m}\n  end: {z: 2 m}\n  support: start",
        "start: {y: -3 m, z: -5 m}\n  end: {y: 3 m, z: -5 m}",
    )
    wide = [deep, ("diameter: 0.8 m", "diameter: 2 m"), ("speed: 2 m/s", "speed: 1.2 m/s")]
    alone = numbers(run(tmp_path, *wide))["peak_force"]
    waves = [
        ("current:", RIPPLE.replace("H", "0.02 m")),
        ("  kinematic", "  circulation: {purpose: extreme}\n  kinematic"),
    ]
    result = run(tmp_path, *wide, *waves)
    found = numbers(result)
    assert found["keulegan_carpenter"] < 4.0
    assert 1.0 < found["peak_force"] / alone < 1.1
    assert any(notice.code == "drag-current-governs" for notice in result.notices)


@pytest.mark.parametrize("share", [0.4, 1.0, 30.0])
def test_from_four_tenths_of_the_orbital_speed_a_current_has_its_steady_drag(share: float) -> None:
    steady = dnv_steady_drag(1e-3)
    assert dnv_drag(3.0, 1e-3, share) == steady > dnv_drag(3.0, 1e-3, 0.39) == dnv_drag(3.0, 1e-3)
    # above KC of about 8 waves have more: the current takes nothing from it
    assert dnv_drag(10.0, 1e-3, share) == dnv_drag(10.0, 1e-3) > steady


def test_added_mass_in_a_current_is_that_of_the_waves() -> None:
    circle = sections.circle(1.0)
    rule = CoefficientRule("dnv_c205", "dnv_c205")
    flow = Conditions(20.0, 2e6, 1e5, 1e-3, current_ratio=5.0, wave_keulegan_carpenter=1.0)
    assert rule.at(circle, flow).inertia[0, 0] == 2.0
    assert rule.at(circle, replace(flow, current_ratio=0.1)).inertia[0, 0] < 1.6


def test_a_current_that_nearly_governs_is_warned_of() -> None:
    flow = Conditions(4.0, 2e6, 1e5, 1e-3, current_ratio=0.3, wave_keulegan_carpenter=3.0)
    (notice,) = CoefficientRule("dnv_c205").at(sections.circle(1.0), flow).notices
    assert notice.code == "drag-current-near" and notice.severity == "warning"
    assert f"{dnv_steady_drag(1e-3) / dnv_drag(4.0, 1e-3):.2g} times" in notice.message
