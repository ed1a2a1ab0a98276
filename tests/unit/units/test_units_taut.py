"""Lines of the frequency domain that come taut in an irregular sea, against catenaries by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from moyai.core.arrays import Array, ComplexArray
from moyai.floating.irregular import response_statistics
from moyai.mooring import Line, LineType, Segment
from moyai.sea.spectra import jonswap
from moyai.sea.states import IrregularSea
from moyai.structures.units.assembly import RowPosition
from moyai.structures.units.datasets import irregular_dataset, statics_dataset
from moyai.structures.units.line_headlines import line_headlines
from moyai.structures.units.links import Work
from moyai.structures.units.model import UnitLine
from moyai.structures.units.response import FarWaves, RowResponse
from moyai.structures.units.row_lines import RowLines
from moyai.structures.units.seas import SeaAnswer
from moyai.structures.units.taut import largest_at_rest
from moyai.validation.units import at_rest, row

DEPTH, LENGTH, STIFFNESS, WEIGHT = 10.0, 49.0, 165e6, 330.0
OMEGA, DURATION = np.linspace(0.7, 1.6, 61), 1800.0
DENSITY = np.exp(-(((OMEGA - 1.05) / 0.2) ** 2))[:, None]


def chain(stiffness: float = STIFFNESS, name: str = "seaward", side: float = -1.0) -> Line:
    """From a fairlead 1.5 m under water, 47.41 m from its anchor on the bed and in the plane of sway and heave."""
    segment = Segment(LineType("chain", WEIGHT, stiffness), LENGTH)
    anchor, fairlead = (side * 50.41, 0.0, -DEPTH), (side * 3.0, 0.0, -1.5)
    return Line(name, anchor, fairlead, segments=(segment,))


def swaying(largest: float, unit: int = 0, units: int = 1) -> ComplexArray:
    """Transfer functions (n, 1, m) of sway alone, its most probable largest value as given [m]."""
    shape = np.exp(1j * OMEGA) / OMEGA
    now = response_statistics(OMEGA, shape, DENSITY[:, 0]).most_probable_maximum(DURATION)
    motion = np.zeros((len(OMEGA), 1, 6 * units), dtype=complex)
    motion[:, 0, 6 * unit] = shape * largest / now
    return motion


def found(lines: RowLines, motion: ComplexArray, rest: Array | None = None) -> Array:
    return largest_at_rest(
        lines, np.zeros(motion.shape[-1]) if rest is None else rest, OMEGA, motion, DENSITY, DURATION
    )


def linear(lines: RowLines, motion: ComplexArray) -> Array:
    at = lines.at(np.zeros(motion.shape[-1]))
    transfer = motion @ at.tension_gradient.T
    return np.asarray(
        at.tension + response_statistics(OMEGA, transfer, DENSITY).most_probable_maximum(DURATION), dtype=float
    )


def test_a_chain_that_is_pulled_straight_has_the_tension_of_its_stretch() -> None:
    """48.68 m across and 8.5 m up are 49.42 m on 49.0 m of chain: 0.85 % of 165 MN, where the tangent gives 1/30."""
    lines = RowLines(((chain(),),), DEPTH)
    (tension,) = found(lines, swaying(1.27))
    strain = math.hypot(47.41 + 1.27, 8.5) / LENGTH - 1.0
    assert tension == pytest.approx(STIFFNESS * strain, rel=0.01) and tension > 1.38e6
    assert linear(lines, swaying(1.27))[0] < 0.1e6


def test_it_is_the_catenary_at_the_mean_and_the_largest_sway() -> None:
    lines, rest = RowLines(((chain(),),), DEPTH), np.array([0.31, 0.0, 0.05, 0.0, 0.0, 0.0])
    state = chain().solve(np.array([[-3.0 + 0.31 + 0.74, 0.0, -1.45]]), DEPTH)
    assert found(lines, swaying(0.74), rest)[0] == pytest.approx(float(state.tension_fairlead[0]), rel=1e-9)


@pytest.mark.parametrize("height", [0.02, 0.1])
def test_small_seas_give_the_linear_tension_to_first_order(height: float) -> None:
    """The difference falls with the square of the height, in all motions of two units together."""
    rng = np.random.default_rng(4)
    motion = rng.normal(size=(len(OMEGA), 1, 12)) + 1j * rng.normal(size=(len(OMEGA), 1, 12))
    motion *= height * np.tile([0.3, 0.2, 0.2, 0.02, 0.02, 0.02], 2)
    oblique = replace(chain(), anchor=(-45.0, 20.0, -DEPTH), fairlead=(-3.0, 8.0, -1.5))
    lines = RowLines(((chain(), chain(name="lee", side=1.0)), (oblique,)), DEPTH)
    whole, half = (found(lines, m) - linear(lines, m) for m in (motion, 0.5 * motion))
    gained = linear(lines, motion) - lines.at(np.zeros(12)).tension
    assert np.all(whole > 0.0) and np.all(whole < 0.2 * gained)
    assert half / whole == pytest.approx(np.full(3, 0.25), rel=0.1)


@pytest.mark.slow
def test_it_is_what_random_records_of_the_row_give() -> None:
    """The catenary at every instant of thirty records of sway, heave and roll, 30 minutes each.

    A most probable largest value is passed in 63 % of records of independent waves; waves in groups pass it less often,
    47 % of 400 such records did. Thirty of them scatter by 9 %.
    """
    phase = np.exp(1j * np.array([0.3, 1.4, -0.8, 0.0]))
    motion = swaying(0.9)
    motion[:, 0, [0, 2, 4]] = motion[:, 0, [0]] * np.array([1.0, 0.8, 0.05]) * phase[:3]
    lines, rng = RowLines(((chain(),),), DEPTH), np.random.default_rng(11)
    time, step = np.arange(0.0, DURATION, 0.25), OMEGA[1] - OMEGA[0]
    omega = OMEGA[:, None] + step * rng.uniform(-0.5, 0.5, size=(len(OMEGA), 30))
    size = np.sqrt(DENSITY * step) * (rng.normal(size=omega.shape) + 1j * rng.normal(size=omega.shape))
    largest = []
    for record in range(30):
        waves = np.exp(-1j * np.outer(time, omega[:, record])) * size[:, record]
        largest.append(lines.tensions_of((waves @ motion[:, 0]).real[:, None, :]).max())
    passed = np.mean(np.array(largest) > found(lines, motion)[0])
    assert 0.47 - 0.18 < passed < 0.63 + 0.18


def test_a_line_is_asked_at_the_motion_of_its_own_unit() -> None:
    lines = RowLines(((chain(),), (chain(name="other"),)), DEPTH)
    still, moved = found(lines, swaying(1.0, unit=1, units=2))
    assert still == pytest.approx(lines.at(np.zeros(12)).tension[0])
    assert moved == pytest.approx(found(RowLines(((chain(),),), DEPTH), swaying(1.0))[0])


def test_the_distance_counts_where_the_tangent_pulls_another_way() -> None:
    """A slack chain is lifted by heave and hardly pulled by sway, which then pulls it straight."""
    motion, rest = swaying(3.27), np.array([-2.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    motion[:, 0, 2] = 1j * motion[:, 0, 0]
    lines = RowLines(((chain(),),), DEPTH)
    across, up = lines.at(rest).tension_gradient[0, [0, 2]]
    lifted = 3.27 * np.array([across, up]) / math.hypot(across, up)
    (at_largest_tangent,) = lines.tensions_of(rest + np.array([[[lifted[0], 0.0, lifted[1], 0.0, 0.0, 0.0]]]))[0]
    away = lines.spans(rest)[1][0, [0, 2]] * 3.27
    (farthest,) = lines.tensions_of(rest + np.array([[[away[0], 0.0, away[1], 0.0, 0.0, 0.0]]]))[0]
    assert farthest > 2.0 * at_largest_tangent
    assert found(lines, motion, rest)[0] == pytest.approx(farthest, rel=1e-6)


def test_an_inextensible_line_that_cannot_reach_has_no_bound() -> None:
    assert found(RowLines(((chain(math.inf),),), DEPTH), swaying(1.27))[0] == math.inf
    assert found(RowLines(((),), DEPTH), swaying(1.27)).shape == (0,)


def test_the_tension_of_a_sea_is_the_larger_of_tangent_and_line_at_rest() -> None:
    """Two boxes on chains that sway by their own answer to a sea: numbers of the frequency domain."""
    segment = Segment(LineType("chain", WEIGHT, STIFFNESS), LENGTH)
    line = UnitLine("chain", 1, (0, 1), (-3.0, 0.0, 1.5), (-50.41, 0.0, 0.0), segments=(segment,))
    at = at_rest(replace(row(), lines=(line,)))
    sea = IrregularSea("storm", jonswap(1.0, 6.0, 3.3), duration=DURATION)
    motion = swaying(1.27, units=2) + 0.1 * swaying(1.27, unit=1, units=2)
    rest = RowPosition(np.zeros(12), np.zeros(12), np.zeros(0))
    nothing = np.zeros((len(OMEGA), 1, 0, 6), dtype=complex)
    tension = motion @ at.tension_gradient(rest.position).T
    fine = RowResponse(OMEGA, motion, nothing, nothing, tension, np.zeros((len(OMEGA), 1)))
    waves: ComplexArray = np.zeros((len(OMEGA), 1, 0), dtype=complex)
    far = FarWaves(waves, waves[..., 0:0], np.zeros((len(OMEGA), 1, 3)), np.zeros((len(OMEGA), 1)))
    answer = SeaAnswer(
        rest, np.zeros(3), np.zeros(12), np.zeros((0, 0, 12)), fine, far, fine, DENSITY, np.zeros(1), np.zeros(0),
        Work(at.rounding), True,
    )  # fmt: skip
    data = irregular_dataset(at, sea, answer)
    taut, slack = data["line_tension_maximum"].values
    tangent = linear(at.row_lines, motion)
    assert taut == pytest.approx(found(at.row_lines, motion)[0]) and taut > 10.0 * tangent[0]
    assert slack == pytest.approx(tangent[1], rel=0.05) and slack >= tangent[1]
    strained = line_headlines(
        {"/SWL/statics": statics_dataset(at, np.zeros(12), np.zeros(12))}, [("/SWL/frequency/storm", data)]
    )
    assert next(iter(strained)).text == "not known"
