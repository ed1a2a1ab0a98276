"""A net of twines is judged per metre of width and against a net of twice the knots, never by what its grid makes."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest

import moyai
from moyai.case.builder import build
from moyai.case.reader import case_of
from moyai.case.yaml_reader import parse_yaml
from moyai.core.headline import Headline
from moyai.core.results import Result
from moyai.flexible import BarType, NetworkBuilder
from moyai.flexible.fronts import Front, front_notices
from moyai.sea import Water
from moyai.structures.network.assembly import assemble
from moyai.structures.network.finer import finer_problem
from moyai.structures.network.mesh_band import mesh_and_step

CASE = """
moyai: 1
title: Net panel in a current
site: {water_depth: 12 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
current: {speed: 0.6 m/s, heading_deg: 0}
structure:
  kind: network
  nets:
    net:
      corners: [[0, 0, -1 m], [0, 8 m, -1 m], [0, 8 m, -7 m], [0, 0, -7 m]]
      rows: ROWS
      columns: COLUMNS
      twine: {diameter: 2.5 mm, mesh_pitch: 25 mm, density: 1140 kg/m3, modulus: 20 MPa, damping_ratio: 0.3,
              drag_normal: 1.2, drag_tangential: 0.02}
      first_row: fixed
      ballast: 8 kg/m
analyses: [statics, dynamic]
settings: {duration: 4 s, output_step: 0.1 s, mesh_check: 'CHECK'}
criteria: {CRITERIA}
"""


@cache
def _result(rows: int, columns: int, check: str = "auto", criteria: str = "greatest_net_tension: 390 N/m") -> Result:
    text = CASE.replace("ROWS", str(rows)).replace("COLUMNS", str(columns)).replace("CHECK", check)
    return moyai.run(text.replace("CRITERIA", criteria))


def _number(result: Result, name: str) -> Headline:
    return next(item for item in result.headlines if item.name == name and item.shown)


@pytest.mark.slow
def test_the_band_of_a_net_holds_what_finer_nets_give() -> None:
    coarse = _result(4, 5)
    for name in ("net_tension", "held_row_load"):
        own = _number(coarse, name)
        assert own.band is not None and own.bound == "", name
        values = [_number(_result(rows, columns, "off"), name).value for rows, columns in ((7, 9), (13, 17))]
        # a half cell at the held row bears nothing: finer nets give more, one after the other
        assert own.value < values[0] < values[1] < own.band.high, name
        assert own.band.high < 1.1 * values[1], name
    assert _number(coarse, "net_tension").unit == "N/m" and "strip of 2 m" in _number(coarse, "net_tension").detail


def test_a_limit_in_newton_does_not_judge_a_strip() -> None:
    """One bar of 4 x 5 knots bears twice what one of 7 x 9 does: neither keeps a limit of the twine."""
    result = _result(4, 5, "off", "greatest_tension: 100 kN")
    assert result.verdict.outcome == "not judged" and "greatest_net_tension" in result.verdict.message


def test_a_net_whose_mesh_was_not_checked_keeps_no_limit() -> None:
    result = _result(4, 5, "off", "greatest_net_tension: 100 kN/m")
    assert result.verdict.outcome == "not judged" and "mesh and step not checked" in result.verdict.message
    pull = _number(result, "held_row_load")
    assert pull.bound == "at least" and "mesh of the net not checked" in pull.detail


def test_the_change_of_a_net_is_continued_further_than_that_of_a_line() -> None:
    """345, 370, 385, 393 N/m of 4 x 5 to 25 x 33 knots."""
    nan = float("nan")
    band = mesh_and_step(345.0, [345.0, 345.0, 370.0, nan, nan], nets=True)
    assert band.low == 345.0 and 393.0 < band.high < 415.0


def test_rounding_of_slack_bars_is_no_front() -> None:
    network = _network()
    strand = 0
    noise = Front(strand, 1.3e-10, 1.3e-10, 1e-4, 1e-2, 0.0)
    assert not front_notices(network, [noise])
    assert front_notices(network, [Front(strand, 100.0, 100.0, 1e-4, 1e-2, 0.0)])


def _network():
    builder = NetworkBuilder(Water(depth=10.0, density=1025.0, gravity=9.81))
    builder.fixed("a", (0.0, 0.0, -2.0))
    builder.fixed("b", (2.0, 0.0, -2.0))
    rope = BarType("rope", mass_per_length=1.0, axial_stiffness=1e5, diameter=0.01)
    builder.line("span", "a", "b", rope, length=2.1, segments=4)
    return builder.build()


def test_a_finer_net_is_the_same_netting() -> None:
    text = CASE.replace("ROWS", "4").replace("COLUMNS", "5").replace("CHECK", "auto").replace("CRITERIA", "")
    problem = build(case_of(parse_yaml(text, "case.yaml"), Path("case.yaml")))
    own, finer = (assemble(one, 0.0) for one in (problem, finer_problem(problem)))
    for mesh, rows in ((own, 4), (finer, 7)):
        bars = mesh.network.bars
        area = float((bars.length * bars.of_type("diameter")).sum())
        assert mesh.nets["net"].shape[0] == rows
        assert area == pytest.approx(2.0 * 8.0 * 6.0 / 0.025 * 0.0025, rel=1e-9)
