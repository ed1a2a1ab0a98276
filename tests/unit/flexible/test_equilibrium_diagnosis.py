"""Statics that leads by dynamic relaxation, and why a network has no equilibrium."""

from __future__ import annotations

import math

import numpy as np
import pytest

from moyai.core.errors import ConvergenceError
from moyai.core.wording import spoken
from moyai.flexible import statics
from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import FREE, Bars, BarType, Nodes
from moyai.flexible.equilibrium_diagnosis import advice
from moyai.flexible.flow import Flow
from moyai.flexible.network import Network
from moyai.flexible.statics import solve_equilibrium
from moyai.sea.water import Water

WATER = Water(30.0, 1025.0, 9.81)
CHAIN = BarType("chain", 20.0, 1e7, 0.04, drag_normal=1.2, drag_tangential=0.2)


def net(seed: int) -> tuple[Network, Flow]:
    """A random net, flat or upright, slack by up to a half, held at corners or edges, in a current or not."""
    rng = np.random.default_rng(seed)
    count, size = int(rng.integers(4, 9)), rng.uniform(0.2, 1.0)
    grid = np.arange(count**2).reshape(count, count)
    one, two = (size * values.ravel() for values in np.meshgrid(np.arange(count), np.arange(count), indexing="ij"))
    tilt = rng.choice([0.0, 0.5 * math.pi])
    place = np.stack([one, two * math.cos(tilt), two * math.sin(tilt) - 15.0], axis=1)
    pairs = np.concatenate([np.stack([grid[:, :-1].ravel(), grid[:, 1:].ravel()], axis=1),
                            np.stack([grid[:-1].ravel(), grid[1:].ravel()], axis=1)])  # fmt: skip
    kind = np.full(count**2, FREE)
    kind[grid[[0, 0, -1, -1], [0, -1, 0, -1]] if rng.random() < 0.5 else grid[:, -1]] = 1
    twine = BarType("twine", 1140.0 * math.pi / 4.0 * 1e-4, 1e4, 0.01, drag_normal=1.2, drag_tangential=0.02)
    bars = Bars(pairs[:, 0], pairs[:, 1], np.full(len(pairs), size * rng.uniform(1.0, 1.5)), np.zeros(len(pairs), int),
                (twine,))  # fmt: skip
    flow = Flow(velocity=(rng.choice([0.0, 0.5]), rng.choice([0.0, 0.3]), 0.0))
    return Network(Nodes(place, kind), bars, WATER), flow


@pytest.mark.parametrize("seed", range(5))
def test_dynamic_relaxation_leads_where_all_else_fails(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Newton's ways barred one and all: the fallback alone comes to a rest of the same energy or lower."""
    network, flow = net(seed)
    usual = solve_equilibrium(network, flow=flow)
    monkeypatch.setattr(statics, "_CALM", ())
    monkeypatch.setattr(statics, "_MOVING", ())
    monkeypatch.setattr(statics, "_CURRENTS", ())
    led = solve_equilibrium(network, flow=flow)
    assert led.found == "dynamic relaxation"
    assert max(usual.residual, led.residual) < 1e-7
    # slack nets may lie in more ways than one; what they pull on is nearly the same
    assert led.tension.max() == pytest.approx(usual.tension.max(), rel=0.1)


def loose(kind: BarType, bed: Bed | None = None, **end: float) -> Network:
    builder = NetworkBuilder(WATER, bed=bed)
    builder.free("one", (0.0, 0.0, -10.0), **end)
    builder.free("two", (10.0, 0.0, -10.0))
    builder.line("line", "one", "two", kind, length=10.0, segments=5, shape="straight")
    return builder.build()


@pytest.mark.parametrize("volume", [0.0, 0.01, 0.17])
def test_what_sinks_for_ever_is_reported_at_once(volume: float) -> None:
    weight = 9.81 * (200.0 - 1025.0 * (volume + 10.0 * math.pi / 4.0 * 0.04**2))
    with pytest.raises(
        ConvergenceError, match=f"weigh {spoken(weight, 'N')} more than their buoyancy and sink without end"
    ):
        solve_equilibrium(loose(CHAIN, volume=volume, height=0.5))


def test_a_float_that_lifts_everything_is_reported_at_once() -> None:
    lift = 9.81 * (1025.0 * 0.5 - 200.0)
    with pytest.raises(
        ConvergenceError, match=rf"point 'one'\) lifts all 6 nodes attached to it by {spoken(lift, 'N')}"
    ):
        solve_equilibrium(loose(CHAIN, Bed(-30.0, 1e5), volume=0.5))
    # with a height it floats
    assert solve_equilibrium(loose(CHAIN, Bed(-30.0, 1e5), volume=0.5, height=0.8)).residual < 1e-6


@pytest.mark.slow
def test_what_a_current_carries_away_is_reported() -> None:
    with pytest.raises(ConvergenceError, match="along x and y: the current moves them away"):
        solve_equilibrium(loose(CHAIN, Bed(-30.0, 1e5)), flow=Flow((0.3, 1.0, 0.0)))
    assert solve_equilibrium(loose(CHAIN, Bed(-30.0, 1e5))).residual < 1e-9


@pytest.mark.slow
def test_rounding_far_away_is_no_rest() -> None:
    """A chain held in height alone drifts off: 1e10 m away its drag is below the rounding of places there."""
    builder = NetworkBuilder(WATER)
    builder.free("top", (0.0, 0.0, 0.0), held=(False, False, True))
    builder.free("low", (10.0, 0.0, -10.0))
    builder.line("line", "top", "low", BarType("chain", 20.0, 1e7, 0.04, drag_normal=1.2), length=20.0, segments=10)
    with pytest.raises(ConvergenceError, match="moves them away"):
        solve_equilibrium(builder.build(), flow=Flow((0.5, 0.2, 0.0)))


@pytest.mark.parametrize("volume", [0.0, 0.01])
def test_a_mechanism_is_named(volume: float) -> None:
    """A neutral mass on two slack ropes meets no force anywhere; a heavy one stretches them."""
    builder = NetworkBuilder(WATER)
    builder.fixed("left", (0.0, 0.0, -10.0))
    builder.free("middle", (5.0, 0.0, -10.0 if volume else -13.31662), mass=10.25, volume=volume)
    builder.fixed("right", (10.0, 0.0, -10.0))
    thin = BarType("thin", 1e-6, 1e5, 1e-5, volume_per_length=1e-6 / 1025.0)
    builder.line("one", "left", "middle", thin, length=6.0, segments=1)
    builder.line("two", "middle", "right", thin, length=6.0, segments=1)
    network = builder.build()
    place = solve_equilibrium(network).state.position
    reported = advice(network, place, Flow())
    assert ("a mechanism: nothing resists a motion that is largest at node 1 (point 'middle')" in reported) == (
        volume > 0.0
    )
