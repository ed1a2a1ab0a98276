"""Runs side by side: no member feels the others, each is the run that it would be by itself."""

from __future__ import annotations

import numpy as np
import pytest
from networks_for_tests import random_network

from moyai.core.errors import InputError
from moyai.flexible import (
    BarType,
    Bed,
    Flow,
    Member,
    Motion,
    Network,
    NetworkBuilder,
    State,
    simulate,
    simulate_together,
    solve_equilibrium,
)
from moyai.flexible.elements import SlowStretch
from moyai.sea.components import WaveComponents
from moyai.sea.dispersion import wave_number
from moyai.sea.water import Water

DEEP, SHALLOW = Water(60.0, 1025.0, 9.81), Water(12.0, 1025.0, 9.81)


def _snap(surge: float) -> Member:
    return Member({"fairlead": Motion.harmonic((surge, 0.0, 0.0), 4.0, duration=9.0, ramp=4.0)})


@pytest.fixture(scope="module")
def rope() -> Network:
    """A rope that goes slack and snaps."""
    builder = NetworkBuilder(DEEP)
    kind = BarType("rope", 9.0, 1e8, 0.04, viscosity=1e4, drag_normal=1.2, added_mass_normal=1.0)
    builder.fixed("anchor", (0.0, 0.0, -12.0))
    builder.driven("fairlead", (43.9425, 0.0, -2.0))
    builder.line("rope", "anchor", "fairlead", kind, length=46.0, segments=20)
    return builder.build()


@pytest.fixture(scope="module")
def buoy() -> tuple[Network, State]:
    """A buoy at the surface on a chain that lies on a rough bed, and its rest."""
    builder = NetworkBuilder(SHALLOW, Bed(-12.0, 3e5, 3e4, friction=0.4))
    chain = BarType(
        "chain", 20.0, 8e6, 0.05, viscosity=3e4, drag_normal=2.0, drag_tangential=0.5, added_mass_normal=1.0
    )
    builder.fixed("anchor", (0.0, 0.0, -12.0))
    builder.free("buoy", (14.0, 0.0, 0.2), mass=300.0, volume=0.9, drag_area=0.8, added_mass=150.0, height=1.2)
    builder.line("chain", "anchor", "buoy", chain, length=20.0, segments=20)
    network = builder.build()
    return network, solve_equilibrium(network).state


def _sea(seed: int, height: float = 0.15, **options: object) -> Member:
    omega = np.linspace(0.5, 2.5, 30)
    number = np.array([float(wave_number(value, 12.0, 9.81)) for value in omega])
    phase = np.random.default_rng(seed).uniform(0.0, 2.0 * np.pi, omega.size)
    amplitude = height * np.exp(-(((omega - 1.1) / 0.4) ** 2))
    waves = WaveComponents(omega, amplitude, phase, np.zeros(omega.size), number, SHALLOW, omega)
    return Member(flow=Flow(waves=waves, ramp=3.0, **options))  # type: ignore[arg-type]


def test_members_do_not_feel_the_company_in_a_sea_on_a_bed(buoy: tuple[Network, State]) -> None:
    network, rest = buoy
    given = {"duration": 8.0, "output_step": 0.1, "start": rest, "interval": 0.05}
    members = [_sea(seed) for seed in range(5)]
    whole = simulate_together(network, members, **given)
    turned = simulate_together(network, members[::-1], **given)
    for number, member in enumerate(members):
        alone = simulate_together(network, [member], **given)
        for one in (alone.position[0], turned.position[4 - number]):
            assert np.array_equal(whole.position[number], one)
        assert np.array_equal(whole.tension_peak[number, 1:], alone.tension_peak[0, 1:])
    # they are not one and the same run
    assert np.ptp(whole.tension_peak[:, 1:].max(axis=(1, 2))) > 50.0


def test_a_member_is_the_run_by_itself(buoy: tuple[Network, State]) -> None:
    # the same scheme with other load intervals: both are of second order in them
    network, rest = buoy
    member = _sea(7)
    found = simulate_together(network, [_sea(3), member], duration=8.0, output_step=0.1, start=rest)
    alone = simulate(network, flow=member.flow, duration=8.0, output_step=0.1, start=rest)
    assert np.abs(found.position[1] - alone.position).max() < 2e-4
    late = alone.time > 2.0
    assert found.tension_peak[1][late].max() == pytest.approx(alone.tension_peak[late].max(), rel=2e-3)


def test_snaps_side_by_side_are_those_of_runs_alone(rope: Network) -> None:
    members = [_snap(surge) for surge in (0.9, 1.0, 1.1)]
    found = simulate_together(rope, members, duration=8.0, output_step=0.02)
    for number, member in enumerate(members):
        alone = simulate(rope, member.motions, duration=8.0, output_step=0.02)
        assert found.tension_peak[number, 1:, -1].max() == pytest.approx(alone.peak_at(19)[1:].max(), rel=1e-3)


def test_seas_of_unequal_length_are_run_too(buoy: tuple[Network, State]) -> None:
    network, rest = buoy
    short = _sea(2)
    assert short.flow.waves is not None
    waves = WaveComponents(
        *(getattr(short.flow.waves, name)[:20] for name in ("omega", "amplitude", "phase", "heading", "wave_number")),
        SHALLOW, short.flow.waves.omega[:20],
    )  # fmt: skip
    members = [_sea(1), Member(flow=Flow(waves=waves, ramp=3.0)), Member(flow=Flow((0.3, 0.0, 0.0)))]
    given = {"duration": 3.0, "output_step": 0.1, "start": rest, "interval": 0.05}
    whole = simulate_together(network, members, **given)
    for number, member in enumerate(members):
        assert np.array_equal(whole.position[number], simulate_together(network, [member], **given).position[0])


def test_a_member_whose_drag_outruns_the_step_is_run_by_itself() -> None:
    builder = NetworkBuilder(DEEP)
    twine = BarType("twine", 0.05, 500.0, 0.02, viscosity=2.0, drag_normal=2.0, added_mass_normal=1.0)
    builder.fixed("top", (0.0, 0.0, -2.0))
    builder.fixed("foot", (0.0, 0.0, -12.0))
    builder.line("twine", "top", "foot", twine, length=10.0, segments=20)
    network = builder.build()
    calm, fast = (Member(flow=Flow((speed, 0.0, 0.0), ramp=0.5)) for speed in (0.1, 12.0))
    given = {"duration": 1.0, "output_step": 0.05}
    found = simulate_together(network, [calm, fast], **given)
    assert found.load_steps[0] > 0
    assert found.load_steps[1] == 0
    assert np.array_equal(found.position[1], simulate(network, flow=fast.flow, **given).position)
    assert np.array_equal(found.position[0], simulate_together(network, [calm], **given).position[0])


def test_faults_are_refused(rope: Network, buoy: tuple[Network, State]) -> None:
    with pytest.raises(InputError, match="follow the motion 'fairlead'"):
        simulate_together(rope, [Member()], duration=1.0, output_step=0.1)
    for wrong in ({"safety": 2.0}, {"step": -1.0}, {"interval": 0.0}, {"load_steps": 0}, {"drag_rate": float("nan")}):
        with pytest.raises(InputError, match=next(iter(wrong))):
            simulate_together(buoy[0], [Member()], duration=1.0, output_step=0.1, **wrong)
    with pytest.raises(InputError, match="without members"):
        simulate_together(buoy[0], [], duration=1.0, output_step=0.1)
    builder = NetworkBuilder(DEEP)
    nylon = BarType("nylon", 1.0, 4e5, 0.04, viscosity=1e3, slow=SlowStretch(2e5, 1e7))
    builder.fixed("top", (0.0, 0.0, -1.0))
    builder.fixed("foot", (0.0, 0.0, -11.0))
    builder.line("nylon", "top", "foot", nylon, length=10.0, segments=4)
    with pytest.raises(InputError, match="not marched side by side"):
        simulate_together(builder.build(), [Member()], duration=1.0, output_step=0.1)


@pytest.mark.parametrize("seed", range(6))
def test_networks_at_random_do_not_feel_the_company(seed: int) -> None:
    # ribs, rope curves, hinges, held components, floats, a rough bed
    rng = np.random.default_rng(seed)
    network = random_network(rng, nodes=int(rng.integers(6, 14)))
    members = [Member(flow=Flow(tuple(rng.uniform(-0.5, 0.5, 3)), ramp=0.1)) for _ in range(4)]
    given = {"duration": 0.2, "output_step": 0.02}
    whole = simulate_together(network, members, **given)
    assert whole.complete.all()
    for number, member in enumerate(members):
        alone = simulate_together(network, [member], **given)
        assert np.array_equal(whole.position[number], alone.position[0])
        assert np.array_equal(whole.tension_peak[number, 1:], alone.tension_peak[0, 1:])
