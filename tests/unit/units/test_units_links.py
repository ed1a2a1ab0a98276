"""Chains and rubber between their ends in space: lengths by hand, balance, energy, an integrator of its own."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from moyai.sea.environment import Environment
from moyai.structures.units.assembly import RowAtLevel, assemble, steady_position
from moyai.structures.units.connectors import stretch
from moyai.structures.units.datasets import along_the_path
from moyai.structures.units.links import PULLS, PUSHES, SHORTEST, Work, displacement, part_of
from moyai.structures.units.model import Connector, Curve, Placement, UnitLine
from moyai.structures.units.time.kernel import _draw
from moyai.structures.units.time.memory import RowMemory
from moyai.structures.units.time.model import RowInTime
from moyai.validation.units import WATER, row

SLACK, STIFFNESS = 0.05, 2e6
#: Next to the centre line and below the deck, so that every motion draws it
CHAIN = Connector(
    "c", "chain", ((0, 1),), 3.0, 1.0, (0.0, 1.0, 0.0), end_to_end=True,
    curve=Curve((SLACK - 1.0, SLACK, SLACK + 1.0), (0.0, 0.0, STIFFNESS)),
)  # fmt: skip
RUBBER = replace(CHAIN, kind="rubber", curve=Curve((-0.2, 0.0, 0.3), (-3e5, 0.0, 3e5)))


def at_rest(*connectors: Connector, springs: float = 2e4, turned: float = 0.0) -> RowAtLevel:
    """Return two boxes held by soft springs both ways; the second one may be turned."""
    lines = [
        UnitLine(name, 1, (0, 1), (0.0, y, 2.29), (x, end, -0.71), stiffness=springs, pretension=0.0)
        for name, x, y, end in (("near", -60.0, -8.0, -8.0), ("far", -60.0, 8.0, 8.0), ("along", 0.0, 0.0, 60.0))
    ]
    given = replace(row(tuple(connectors)), lines=tuple(lines))
    if turned:
        place = given.placements[1]
        given = replace(given, placements=(given.placements[0], Placement(place.x + 1.0, place.y + 1.0, turned)))
    return assemble(given, Environment(WATER), "SWL", 0.0)


def distance(at: RowAtLevel, position: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return both ends (2, 3) of the chain, each carried by its unit, and how they move with its six motions (2, 6, 3).

    The turn is that of a rotation vector, to second order.
    """
    ends, moved = [], []
    for number, along in ((0, 10.0), (1, -10.0)):
        place = at.row.placements[number]
        arm = place.rotation @ np.array([3.0, along, 1.0 - at.draught - at.centres[number, 2]])
        move = position[6 * number : 6 * number + 6]
        first = np.cross(move[3:], arm)
        ends.append(at.centres[number] + arm + move[:3] + first + 0.5 * np.cross(move[3:], first))
        turns = [
            np.cross(axis, arm) + 0.5 * (np.cross(axis, first) + np.cross(move[3:], np.cross(axis, arm)))
            for axis in np.eye(3)
        ]
        moved.append([*np.eye(3), *turns])
    return np.array(ends), np.array(moved)


def pull_of(at: RowAtLevel, position: np.ndarray) -> tuple[np.ndarray, float]:
    """Return the forces (m,) of the chain on both units, and its tension."""
    ends, moved = distance(at, position)
    rest, _ = distance(at, np.zeros(12))
    apart = ends[1] - ends[0]
    length = float(np.linalg.norm(apart))
    tension = STIFFNESS * max(length - float(np.linalg.norm(rest[1] - rest[0])) - SLACK, 0.0)
    force = tension * apart / length
    return np.concatenate([moved[0] @ force, moved[1] @ -force]), tension


def test_a_line_of_half_a_metre_that_is_drawn_across() -> None:
    """Pythagoras: 0.5 m along and 1.2 m across are 1.3 m; a line that keeps its direction is not drawn by it."""
    moved, axis = np.array([1.2, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
    assert stretch(moved, axis, 0.5) == pytest.approx(0.8, rel=1e-14)
    assert stretch(moved, axis, 0.0) == 0.0
    # a small motion of a long line keeps its digits
    assert stretch(np.array([0.0, 1e-9, 0.0]), axis, 100.0) == pytest.approx(1e-9, rel=1e-12)


@pytest.mark.parametrize("turned", [0.0, 0.4])
def test_length_and_force_are_those_of_two_ends_in_space(turned: float) -> None:
    at = at_rest(CHAIN, turned=turned)
    (link,) = at.links
    generator = np.random.default_rng(2)
    rest, _ = distance(at, np.zeros(12))
    for _ in range(20):
        position = generator.normal(size=12) * np.tile([0.5, 0.3, 0.3, 0.02, 0.05, 0.03], 2)
        ends, _ = distance(at, position)
        expected = np.linalg.norm(ends[1] - ends[0]) - np.linalg.norm(rest[1] - rest[0])
        assert float(link.elongation(position)) == pytest.approx(expected, abs=1e-12)
        force, tension = pull_of(at, position)
        assert np.allclose(-tension * link.along(position), force, rtol=1e-10, atol=1e-6)
        # the joint reports the force on the unit before it, which lies along y, in axes turned half as far as the other
        x, y, up = force[:3]
        c, s = np.cos(0.5 * turned), np.sin(0.5 * turned)
        own = [c * x + s * y, c * y - s * x, up]
        assert np.allclose(tension * link.direction(position), own, rtol=1e-10, atol=1e-6)


def test_a_unit_that_pitches_draws_its_ends_in() -> None:
    """By (1 - cos t) of the half length, against the rotation itself to its third order."""
    arm, turn = np.array([0.0, 7.0, 0.9]), np.array([0.1, 0.0, 0.0])
    found = displacement(np.concatenate([np.zeros(3), turn]), arm)
    c, s = np.cos(0.1), np.sin(0.1)
    exact = np.array([0.0, 7.0 * (c - 1.0) - 0.9 * s, 7.0 * s + 0.9 * (c - 1.0)])
    assert np.abs(found - exact).max() < 7.0 * 0.1**3 / 5.0
    assert found[1] + 0.9 * 0.1 == pytest.approx(-7.0 * 0.1**2 / 2.0)


def test_its_stiffness_is_the_derivative_of_its_force() -> None:
    at = at_rest(CHAIN)
    position = np.zeros(12)
    position[[6, 7, 8, 10]] = 0.8, 0.2, 0.3, 0.05
    step, width = 1e-6, Work(1e-4)
    found = at.links[0].stiffness(position, width)
    for n in range(12):
        moved = step * np.eye(12)[n]
        change = at.curve_force(position + moved, width) - at.curve_force(position - moved, width)
        assert np.allclose(-change / (2.0 * step), found[:, n], rtol=1e-5, atol=1e-6 * np.abs(found).max())


def test_a_unit_pushed_across_hangs_on_its_chain() -> None:
    """The forces on each unit are in balance, and the chain points along its pull."""
    at = at_rest(CHAIN, springs=2e5)
    load = np.zeros(12)
    load[6], load[0] = 4e5, -4e5
    found = steady_position(at, load).position
    force, tension = pull_of(at, found)
    # the corners of the curve are rounded over a tenth of a millimetre per metre of length
    assert tension > 5e4
    lines = at.line_force(found) - at.line_force(np.zeros(12))
    left = load + force + lines - at.hydrostatic @ found
    assert np.abs(left[[0, 1, 6, 7]]).max() < 0.01 * 4e5
    straight = steady_position(at_rest(replace(CHAIN, end_to_end=False), springs=2e5), load).position
    assert straight[6] - straight[0] > 1.2 * (found[6] - found[0])


def memory_of(size: int) -> RowMemory:
    """Return a memory of two passive poles and plain added masses."""
    generator = np.random.default_rng(5)
    scale = np.tile([1.0, 1.0, 1.0, 6.0, 4.0, 6.0], size // 6)
    poles, residues = [], []
    for pole in (-0.4 + 0.9j, -0.6 + 1.5j):
        along = generator.normal(size=size) * scale
        residues.append(4e4 * 2.0 * pole / (2j * pole.imag) * np.outer(along, along))
        poles.append(pole)
    added = np.diag(np.tile([3e5, 1e5, 6e5, 2e7, 8e6, 1e7], size // 6))
    return RowMemory(np.array(poles), np.array(residues), added, 0.0, 0.0, 0.0)


@pytest.mark.slow
def test_two_units_on_a_chain_against_an_integrator_of_its_own() -> None:
    """Surge, sway, heave and turns, slack and taut; the chain from its ends, the steps by Runge and Kutta."""
    at = at_rest(CHAIN)
    memory = memory_of(12)
    model = RowInTime(at, memory, np.zeros(12), 1.1)
    step, count = 0.01, 3001
    time = step * np.arange(count)
    amplitude = np.array([3e5, 2e4, 3e5, 3e5, 2e5, 3e5, 3e5, -3e4, 2e5, -2e5, -2e5, 1e5])

    def load_at(t: float) -> np.ndarray:
        return min(t / 10.0, 1.0) * amplitude * np.sin(1.1 * t + 0.4 * np.arange(12))

    run = model.run(np.array([load_at(t) for t in time]), step)
    mass, balanced, rest = np.linalg.inv(model.mass), model.balanced, at.line_force(np.zeros(12))

    def rate(t: float, state: np.ndarray) -> np.ndarray:
        q, v = state[:12], state[12:24]
        z = state[24:48].reshape(2, 12) + 1j * state[48:].reshape(2, 12)
        history = np.einsum("kij,kj->i", memory.residues, z).real
        force = load_at(t) - history - model.damping @ v - at.hydrostatic @ q + at.line_force(q) - balanced
        grown = memory.poles[:, None] * z + v
        return np.concatenate([v, mass @ (force + pull_of(at, q)[0]), grown.real.ravel(), grown.imag.ravel()])

    # the corner of the curve is met by short steps
    found = solve_ivp(rate, (0.0, time[-1]), np.zeros(72), rtol=1e-6, atol=1e-8, max_step=0.1, t_eval=time)
    exact = found.y[:12].T
    pull = np.array([pull_of(at, q)[1] for q in exact])
    assert np.abs(rest[[0, 1]]).max() < 1.0
    assert pull.max() > 1e5 and (pull == 0.0).mean() > 0.3
    # the ends pass each other by more than the gap
    assert np.ptp(exact[:, 6] - exact[:, 0]) > 0.8
    assert np.abs(run.position - exact).max() < 0.01 * np.abs(exact).max()
    assert run.link_force.max() == pytest.approx(pull.max(), rel=0.01)
    loads = run.joint_loads[:, 0]
    assert np.allclose(np.linalg.norm(loads[:, :3], axis=1), run.link_force[:, 0], rtol=1e-9, atol=1e-6)
    sideways = np.array([pull_of(at, q)[0][0] for q in exact])
    assert np.abs(sideways).max() > 0.3 * pull.max()
    assert np.abs(loads[:, 0]).max() == pytest.approx(np.abs(sideways).max(), rel=0.02)


@pytest.mark.slow
def test_a_row_that_is_let_go_never_has_more_energy_than_at_first() -> None:
    at = at_rest(CHAIN)
    model = RowInTime(at, memory_of(12), np.zeros(12), 1.1)
    start = np.zeros(12)
    start[[0, 2, 4, 6, 7]] = -0.7, 0.3, 0.05, 0.7, 0.2
    run = model.run(np.zeros((6000, 12)), 0.01, start=start)
    stretched = run.link_force[:, 0] / STIFFNESS
    springs = np.array(
        [0.5 * one.tensions(run.position[:, 6 * n : 6 * n + 6]) ** 2 / 2e4 for n, one in enumerate(at.systems)]
    )
    total = 0.5 * np.einsum("ti,ij,tj->t", run.velocity, model.mass, run.velocity)
    total += 0.5 * np.einsum("ti,ij,tj->t", run.position, at.hydrostatic, run.position)
    total += 0.5 * STIFFNESS * stretched**2 + springs.sum(axis=(0, 2))
    assert stretched[0] > 0.05
    assert total.max() <= total[0] * (1.0 + 2e-3)
    assert total[-1] < 0.6 * total[0]


@pytest.mark.parametrize(
    "curve",
    [
        Curve((-0.2, 0.0, 0.3), (-3e5, 0.0, 3e5)),
        Curve((-0.2, 0.3), (-1e5, 3e5)),
        Curve((0.1, 0.3), (1e5, 3e5)),
        Curve((-0.3, -0.1), (-3e5, -1e5)),
        Curve((0.1, 0.3, 0.5), (1e5, 3e5, 1e5)),
    ],
)
def test_the_parts_that_pull_and_push_are_the_curve(curve: Curve) -> None:
    e = np.linspace(-1.0, 0.95, 400)
    pull, push = part_of(curve, PULLS).at(e), part_of(curve, PUSHES).at(e)
    assert pull.min() >= 0.0 and push.max() <= 0.0
    assert np.allclose(pull + push, curve.at(e), rtol=1e-12, atol=1e-6)


def test_rubber_is_drawn_in_space_and_pressed_along_the_row() -> None:
    at = at_rest(RUBBER)
    across = np.zeros(12)
    across[6] = 0.5
    drawn, pressed = at.links
    length = float(np.hypot(1.0, 0.5)) - 1.0
    assert float(drawn.curve.at(drawn.elongation(across))) == pytest.approx(1e6 * length)
    assert float(pressed.curve.at(pressed.elongation(across))) == 0.0
    closed = np.zeros(12)
    closed[[6, 7]] = 0.1, -0.1
    assert float(drawn.curve.at(drawn.elongation(closed))) == 0.0
    assert np.allclose(at.curve_force(closed, Work(1e-9))[[0, 1]], [0.0, -1.5e5], atol=1.0)


@pytest.mark.parametrize("regular", [True, False])
def test_the_mean_force_of_a_worked_curve_is_that_of_its_law(regular: bool) -> None:
    """By quadrature over a period, or over the Gaussian law; a chain at its corner pulls sigma K over root 2 pi."""
    curve = Curve((-0.4, -0.1, 0.05, 0.3), (-2e5, -1e4, 0.0, 5e5))
    angle = (np.arange(20000) + 0.5) * np.pi / 20000
    z = np.linspace(-8.0, 8.0, 40001)
    weight = np.exp(-0.5 * z**2)
    for mean, size in ((0.0, 0.11), (0.21, 0.3), (-0.5, 0.02), (0.04, 1.0)):
        moved = mean + size * (np.cos(angle) if regular else z)
        law = np.full(angle.size, 1.0 / angle.size) if regular else weight / weight.sum()
        force, slope = curve.worked(mean, size, regular)
        assert force == pytest.approx(float(law @ curve.at(moved)), rel=1e-5, abs=1.0)
        step = 1e-5
        above, below = (curve.worked(mean + change, size, regular)[0] for change in (step, -step))
        assert slope == pytest.approx((above - below) / (2.0 * step), rel=1e-5)
    chain = Curve((SLACK - 1.0, SLACK, SLACK + 1.0), (0.0, 0.0, STIFFNESS))
    assert chain.worked(SLACK, 0.01, False)[0] == pytest.approx(0.01 * STIFFNESS / np.sqrt(2.0 * np.pi), rel=1e-12)


def test_a_chain_that_is_worked_rests_in_its_slack() -> None:
    """The mean force of the worked chain is the load, so that its mean elongation falls as the motion grows."""
    at = at_rest(CHAIN, springs=2e5)
    load = np.zeros(12)
    load[7], load[1] = 2e5, -2e5
    found = []
    for size in (0.0, 0.05, 0.2):
        work = Work(at.rounding, np.array([size]))
        rest = steady_position(at, load, work)
        (link,) = at.links
        found.append(float(link.elongation(rest.position)))
        pull = link.bears(rest.position, work)[0] * link.along(rest.position)
        lines = at.line_force(rest.position) - at.line_force(np.zeros(12))
        assert np.abs((load - pull + lines - at.hydrostatic @ rest.position)[[1, 7]]).max() < 200.0
    assert found[0] > found[1] > found[2] and found[0] > SLACK


def test_lines_at_rest_along_the_motion_see_what_the_tangent_does_not() -> None:
    """A level spring of 60 m whose end heaves by 3 m is drawn by the hypotenuse; its tangent knows nothing of heave."""
    at = at_rest(springs=2e4)
    motion = np.zeros((1, 1, 12), dtype=complex)
    motion[0, 0, 2] = motion[0, 0, 8] = 2.0 * np.exp(0.7j)
    answer = SimpleNamespace(rest=SimpleNamespace(position=np.zeros(12)), fine=SimpleNamespace(motion=motion))
    found = along_the_path(at, [answer], 1.5)
    assert found.shape == (1, 6)
    assert found[0] == pytest.approx(2e4 * (np.hypot(60.0, 3.0) - 60.0), rel=0.01)
    assert np.abs(at.tension_gradient(np.zeros(12))[:, [2, 8]]).max() < 1.0


@pytest.mark.parametrize("connector", [CHAIN, RUBBER])
def test_where_both_ends_meet_it_bears_nothing(connector: Connector) -> None:
    """A line without length has no direction: no force, a stiffness that is finite, also just next to that place."""
    at = at_rest(connector)
    link = at.links[0]
    # waves work a chain about a slack mean: it pulls in the mean
    work = Work(1e-4, np.full(len(at.links), 1.0))
    met = np.zeros(12)
    met[6:9] = -link.span * link.axis
    assert link.bears(met, work)[0] > 0.0
    for aside in (0.0, 1e-12, 1e-3):
        position = met.copy()
        position[6] += aside
        assert np.all(np.isfinite(link.stiffness(position, work))), aside
        mean = link.bears(position, work)[0]
        assert np.linalg.norm(mean * link.along(position)[6:9]) <= 1.01 * mean / (SHORTEST * link.span) * aside, aside
    assert float(link.elongation(met)) == pytest.approx(-link.span, rel=1e-12)


def test_the_compiled_step_draws_a_line_whose_ends_meet_as_the_row_at_rest_does() -> None:
    at = at_rest(CHAIN)
    link = at.links[0]
    pairs, arms, bends, axes, spans, *_ = RowInTime._joints(SimpleNamespace(at=at))
    for aside in (0.0, 1e-3, 0.5):
        position = np.zeros(12)
        position[6:9] = -link.span * link.axis
        position[6] += aside
        drawn, along = np.zeros(1), np.zeros((1, 12))
        _draw(position, np.eye(12), pairs, arms, bends, axes, spans, np.empty((5, 3)), drawn, along)
        assert drawn[0] == pytest.approx(float(link.elongation(position)), abs=1e-12)
        assert np.allclose(along[0], link.along(position), rtol=1e-12, atol=1e-12)
