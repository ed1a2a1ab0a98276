"""What is held stays where it is while bodies and lines come to rest: pins, and single motions."""

import numpy as np
import pytest

from moyai.core.errors import ConvergenceError
from moyai.coupled.assembly import BodyAssembly, RodPart, VolumePart
from moyai.coupled.equilibrium import find_coupled_equilibrium
from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType
from moyai.mooring.rotations import rotation_matrix
from moyai.sea.water import Water

WATER = Water(20.0, 1025.0, 9.81)


def column(seed, **options):
    """A buoyant column on a rope of random weight and length, from its head to an anchor."""
    draw = np.random.default_rng(seed)
    made = BodyAssembly(WATER.density)
    made.add(RodPart((0.0, 0.0, 0.0), (0.0, 0.0, 17.0), draw.uniform(0.5, 0.8), 90.0, 1.0, 1.0, 0.8, 0.8))
    made.add(VolumePart((0.0, 0.0, 15.0), 300.0, 1.5, (1.5, 1.5, 1.5), (0.5, 0.5, 0.5)))
    body = made.body("column", (0.0, 0.0, -19.0), rotation_matrix((0.0, 0.0, 0.0)),
                     {"head": np.array([0.0, 0.0, 17.0])}, **options)  # fmt: skip
    builder = NetworkBuilder(WATER, Bed(-20.0, 1e6, 1e5, 0.0))
    builder.fixed("anchor", (25.0, draw.uniform(-10.0, 10.0), -20.0))
    builder.driven("head", body.points_at_start["head"])
    rope = BarType("rope", draw.uniform(0.8, 3.0), 4e5, 0.04, viscosity=2e3, drag_normal=1.2, drag_tangential=0.1,
                   added_mass_normal=1.0, added_mass_tangential=0.0)  # fmt: skip
    builder.line("rope", "anchor", "head", rope, length=draw.uniform(0.97, 1.1) * 31.0, segments=20)
    return builder.build(), body


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_a_pin_stays_where_it_is(seed):
    network, body = column(seed, pin=np.zeros(3))
    rest = find_coupled_equilibrium(network, {"column": body})
    found = rest.bodies["column"]
    np.testing.assert_allclose(found.position, [0.0, 0.0, -19.0], atol=1e-9)
    # moments about the pin balance: the rope against weight and buoyancy of the column
    place, turn = found.points_at_start["head"] - np.asarray(found.position), found.start_rotation
    last = network.strand("rope").bars[-1]
    ends = rest.state.position[[network.bars.start[last], network.bars.end[last]]]
    along = ends[0] - ends[1]
    kind = network.bars.types[0]
    pull = rest.tension[last] * along / np.linalg.norm(along)
    pull[2] -= 0.5 * kind.submerged_weight_per_length(WATER) * network.bars.length[last]
    lumps = found.lumps
    arms = lumps.place @ turn.T
    # all of it under water
    assert (np.asarray(found.position) + arms)[:, 2].max() < -0.5
    up = 1025.0 * 9.81 * lumps.volume
    moment = np.cross(place, pull) + np.cross(arms, up[:, None] * [0.0, 0.0, 1.0]).sum(axis=0)
    moment += np.cross(turn @ np.asarray(found.centre_of_gravity), [0.0, 0.0, -9.81 * found.mass])
    assert np.abs(moment).max() < 1e-5 * 17.0 * up.sum()


@pytest.mark.slow
@pytest.mark.parametrize("held", [pytest.param((0, 1), marks=pytest.mark.slow), (3, 4)])
def test_motions_that_are_held_stay(held):
    free = np.ones(6, dtype=bool)
    free[list(np.atleast_1d(held))] = False
    network, body = column(7, free=tuple(bool(item) for item in free))
    rest = find_coupled_equilibrium(network, {"column": body})
    found = rest.bodies["column"]
    change = np.concatenate([np.asarray(found.position) - body.position, np.asarray(found.rotation) - body.rotation])
    centre = np.asarray(body.centre_of_gravity)
    moved = np.asarray(found.position) + found.start_rotation @ centre - np.asarray(body.position) - centre
    change[:3] = moved
    assert np.abs(change[~free]).max() < 1e-8
    assert np.abs(change[free]).max() > 1e-3
    assert rest.residual < 1e-6


@pytest.mark.slow
def test_a_body_that_sinks_is_reported_at_once():
    made = BodyAssembly(WATER.density)
    made.add(RodPart((0.0, 0.0, -1.0), (0.0, 0.0, 1.0), 2.7, 25e3, 1.0, 1.0, 0.8, 0.8))
    body = made.body("block", (0.0, 0.0, -5.0), rotation_matrix((0.0, 0.0, 0.0)), {"eye": np.array([0.0, 0.0, -1.0])})
    builder = NetworkBuilder(WATER, Bed(-20.0, 1e6, 1e5, 0.0))
    builder.fixed("anchor", (25.0, 0.0, -20.0))
    builder.driven("eye", body.points_at_start["eye"])
    builder.line("chain", "anchor", "eye", BarType("chain", 72.0, 3e8, 0.06), length=32.0, segments=4)
    with pytest.raises(ConvergenceError, match="'block' sinks through the bed at z = -20 m"):
        find_coupled_equilibrium(builder.build(), {"block": body})
