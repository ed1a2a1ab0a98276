"""States against the frequency response, against convolution, and in free decay against the frequency integral."""

import math
from functools import cache

import numpy as np
import pytest

from moyai.core.errors import ConvergenceError, InputError
from moyai.potential.damping_tail import wall_sided_tails
from moyai.potential.free_decay import decay_by_convolution, decay_by_frequency, decay_by_states
from moyai.potential.memory import memory_functions, pair_measure, steady_damping
from moyai.potential.memory_plan import recommend_frequencies
from moyai.potential.multipole_circle import half_immersed_circle
from moyai.potential.rectangle import solve_rectangle
from moyai.potential.state_space import fit_memory, fit_state_space
from moyai.potential.vector_fitting import LeastSquares
from moyai.sea.water import Water

G = 9.81


@cache
def rectangle_memory(seed):
    rng = np.random.default_rng(seed)
    draught = 10.0 ** rng.uniform(-0.5, 0.7)
    beam = draught * 10.0 ** rng.uniform(-0.3, 0.9)
    water = Water(draught * (1.0 + 10.0 ** rng.uniform(-0.6, 1.0)), 1000.0, G)
    centre = -draught * rng.uniform(0.0, 1.0)
    plan = recommend_frequencies(water, breadth=beam, wall_height=draught)
    s = solve_rectangle(beam, draught, water, plan.omega, centre=(0.0, centre))
    time = np.linspace(0.0, 40.0 * math.sqrt(max(water.depth, beam) / G), 400)
    memory = memory_functions(
        s.omega,
        s.radiation_damping,
        s.infinite_frequency_added_mass,
        time,
        start="even",
        steady_damping=steady_damping([0.0, beam, 0.0], water),
        tail_theory=wall_sided_tails(water, centre),
    )
    mass = 1000.0 * beam * draught * np.diag([1.0, 1.0, (0.3 * beam) ** 2])
    inertia = (mass + s.infinite_frequency_added_mass).diagonal()
    natural = math.sqrt(G / draught) * np.array([0.25, 0.0, 0.6])
    stiffness = np.diag(inertia * natural**2)
    stiffness[1, 1] = 1000.0 * G * beam
    stiffness[0, 2] = stiffness[2, 0] = -0.1 * math.sqrt(stiffness[0, 0] * stiffness[2, 2])
    return memory, mass, stiffness


@pytest.mark.slow
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3])
@pytest.mark.parametrize("seed", [0, 1, 4])  # narrow, wide over a shallow gap, in deep water
def test_fit_is_accurate_stable_passive_and_right_at_zero_frequency(seed, tolerance):
    memory, _, _ = rectangle_memory(seed)
    states = fit_memory(memory, tolerance=tolerance)
    for check in states.checks:
        assert check.passed, check
    assert (states.poles.real < 0.0).all()
    omega = np.concatenate([[1e-9], np.geomspace(0.01, 300.0, 700)])
    scale = np.sqrt(pair_measure(memory.model.damping(omega)).diagonal())
    response = states.response(omega)
    damping = response.real / np.outer(scale, scale)
    assert np.linalg.eigvalsh(damping).min() > -1e-10
    assert np.allclose(response[0].real, memory.steady_dashpot, rtol=1e-9, atol=1e-9 * scale.max() ** 2)
    error = np.abs(response[1:] - memory.model.response(omega[1:])) / pair_measure(np.abs(response))
    assert error.max() < 1.5 * tolerance
    kernel = states.velocity_kernel(memory.time) - memory.velocity_kernel
    assert (np.abs(kernel) / pair_measure(memory.velocity_kernel)).max() < 12.0 * tolerance
    assert states.order <= 32
    # heave of a symmetric section is not coupled
    assert np.all(states.response(1.0)[0][1, [0, 2]] == 0.0)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 2])
def test_three_coupled_modes_with_a_steady_dashpot_of_rank_one(seed):
    rng = np.random.default_rng(seed)
    beam, draught, water = rng.uniform(2.0, 8.0), rng.uniform(0.5, 2.0), Water(5.0, 1000.0, G)
    centre = (rng.uniform(0.05, 0.4) * beam, -0.3)
    plan = recommend_frequencies(water, breadth=beam, wall_height=draught)
    s = solve_rectangle(beam, draught, water, plan.omega, centre=centre)
    arguments = (s.omega, s.radiation_damping, s.infinite_frequency_added_mass, [0.0, 1.0])
    memory = memory_functions(*arguments, start="even", added_mass=s.added_mass)
    # heave pushes water out, and so does roll about a point next to the middle
    steady = steady_damping([0.0, beam, beam * centre[0]], water)
    assert np.allclose(memory.steady_dashpot, steady, atol=1e-4 * np.abs(steady).max())
    states = fit_memory(memory)
    for check in states.checks:
        assert check.passed, check


@pytest.mark.slow
def test_real_form_is_the_modal_form():
    memory, _, _ = rectangle_memory(1)
    states = fit_memory(memory)
    a, b, c = states.a, states.b, states.c
    assert a.shape == (states.order, states.order) and not states.feedthrough.any()
    for omega in (0.3, 1.7):
        real = c @ np.linalg.solve(-1j * omega * np.eye(len(a)) - a, b)
        assert np.allclose(real, states.response(omega)[0], rtol=1e-9)
    # block diagonal: nothing beyond the neighbour
    assert not np.triu(a, 2).any() and not np.tril(a, -2).any()


def force_history(states, velocity, step):
    """Force of the states from water at rest, exact for velocities that are straight within a step."""
    decay = np.exp(states.poles * step)
    one = (decay - 1.0) / (states.poles * step)
    two = (one - 1.0) / (states.poles * step)
    old, new = (step * weight[:, None] * states.inputs for weight in (one - two, two))
    z, force = np.zeros(len(decay), complex), np.zeros(velocity.shape)
    for row in range(1, len(velocity)):
        z = decay * z + old @ velocity[row - 1] + new @ velocity[row]
        force[row] = -(states.outputs @ z).real
    return force


@pytest.mark.slow
def test_states_give_the_force_of_the_convolution():
    memory, _, _ = rectangle_memory(1)
    states = fit_memory(memory, tolerance=1e-4, highest_order=40)
    step, count = 0.01, 3000
    time = step * np.arange(count)
    velocity = np.stack([np.sin(1.1 * time), np.cos(0.8 * time) - 1.0, 0.3 * np.sin(2.0 * time)], axis=1)
    force = force_history(states, velocity, step)
    kernel = memory.model.velocity_kernel(time)
    for row in (50, 700, 2999):
        pieces = np.einsum("kij,kj->ki", kernel[: row + 1], velocity[row::-1])
        direct = -step * (pieces.sum(axis=0) - 0.5 * (pieces[0] + pieces[-1]))
        assert np.allclose(force[row], direct, atol=1e-3 * np.abs(force).max(axis=0))


@pytest.mark.slow
def test_slow_steady_motion_meets_the_steady_dashpot():
    memory, _, _ = rectangle_memory(1)
    force = force_history(fit_memory(memory), np.tile([0.0, 1.0, 0.0], (4000, 1)), 0.5)
    assert -force[-1, 1] == pytest.approx(memory.steady_dashpot[1, 1], rel=1e-6)
    assert memory.steady_dashpot[1, 1] > 0.0


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 2])  # narrow in deep water, wide over a shallow gap
def test_free_decay_of_coupled_modes_is_that_of_the_frequency_integral(seed):
    memory, mass, stiffness = rectangle_memory(10 + seed)
    infinite = memory.infinite_frequency_added_mass
    offset = np.array([0.3, 1.0, 0.2])
    time = np.linspace(0.0, memory.time[-1], 160)
    exact = decay_by_frequency(time, offset, mass, stiffness, memory.model, infinite)
    assert np.allclose(exact[0], offset, atol=1e-6)
    coarse, fine = (
        np.abs(
            decay_by_states(time, offset, mass, stiffness, fit_memory(memory, tolerance=t, highest_order=40), infinite)
            - exact
        ).max()
        for t in (1e-3, 2e-4)
    )
    assert coarse < 1e-3
    assert fine < 6e-4


@pytest.mark.slow
def test_slow_heave_decay_shows_the_steady_dashpot():
    # overdamped return: a soft spring in shallow water; the memory is almost its steady dashpot
    memory, mass, _ = rectangle_memory(12)
    infinite = memory.infinite_frequency_added_mass
    steady = memory.steady_dashpot[1, 1]
    inertia = float(mass[1, 1] + infinite[1, 1])
    soft = np.array([[0.02 * steady**2 / inertia]])
    heave = np.ix_([1], [1])
    model = memory_functions(
        memory.model.knots[1:],
        memory.model.damping(memory.model.knots[1:])[:, 1:2, 1:2],
        infinite[heave],
        memory.time,
        start="even",
        steady_damping=memory.steady_dashpot[heave],
    ).model
    rate = soft[0, 0] / steady
    time = np.linspace(0.0, 5.0 / rate, 60)
    exact = decay_by_frequency(time, [1.0], mass[heave], soft, model, infinite[heave])
    states = decay_by_states(time, [1.0], mass[heave], soft, fit_memory(model), infinite[heave])
    assert np.abs(states - exact).max() < 1e-3
    # far out the return is that of dashpot and spring: the logarithmic slope is close to -soft / D(0)
    late = time > 2.0 / rate
    slope = np.polyfit(time[late], np.log(exact[late, 0]), 1)[0]
    assert -slope == pytest.approx(rate, rel=0.05)
    # without D(0) (its kernel cut at a quarter of the memory and nothing put in place) the answer would be another
    step = memory.time[-1] / 2000.0
    kernel = model.velocity_kernel(step * np.arange(12))
    count = int(time[-1] / step)
    cut = decay_by_convolution(step, count, [1.0], mass[heave], soft, kernel, infinite[heave])
    assert np.abs(np.interp(time, step * np.arange(count + 1), cut[:, 0]) - exact[:, 0]).max() > 0.1


@pytest.mark.slow
def test_convolution_converges_at_second_order_to_the_frequency_integral():
    memory, mass, stiffness = rectangle_memory(12)
    infinite = memory.infinite_frequency_added_mass
    offset, end = np.array([0.3, 1.0, 0.2]), 6.0
    errors = []
    for count in (150, 300, 600):
        step = end / count
        kernel = memory.model.velocity_kernel(step * np.arange(count + 1))
        motion = decay_by_convolution(step, count, offset, mass, stiffness, kernel, infinite)
        time = step * np.arange(count + 1)
        exact = decay_by_frequency(time[:: count // 50], offset, mass, stiffness, memory.model, infinite)
        errors.append(np.abs(motion[:: count // 50] - exact).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all((orders > 1.8) & (orders < 2.2)), errors


@pytest.mark.slow
def test_heave_decay_of_the_half_circle_in_infinite_depth():
    # Ursell's coefficients; the long algebraic tail of the motion included
    plan = recommend_frequencies(Water(math.inf, 1000.0, G), breadth=2.0, wall_height=0.7)
    values = [half_immersed_circle(w * w / G, "heave", multipoles=32) for w in plan.omega]
    unit = 1000.0 * np.pi / 2.0
    damping = unit * np.array([v.radiation_damping for v in values])[:, None, None] * plan.omega[:, None, None]
    added = unit * np.array([v.added_mass for v in values])[:, None, None]
    time = np.linspace(0.0, 30.0, 200)
    memory = memory_functions(plan.omega, damping, [[unit]], time, start="zero", added_mass=added)
    assert {check.name: check.value for check in memory.checks}["Kramers-Kronig"] < 1e-3
    assert memory.steady_dashpot[0, 0] == 0.0
    mass, stiffness = np.array([[unit]]), np.array([[1000.0 * G * 2.0]])
    exact = decay_by_frequency(time, [1.0], mass, stiffness, memory.model, [[unit]])
    states = decay_by_states(time, [1.0], mass, stiffness, fit_memory(memory), [[unit]])
    assert np.abs(states - exact).max() < 1e-3
    late = time > 20.0
    assert np.abs(states - exact)[late].max() < 0.05 * np.abs(exact)[late].max()


def test_rational_response_is_found_again():
    poles = np.array([-0.4 + 1.1j, -1.2 + 0.3j])
    outputs = np.array([1.0 - 0.3j, 0.8 + 0.2j])
    omega = np.geomspace(0.05, 60.0, 90)
    response = 0.5 * sum(
        (o / (-1j * omega - p) + o.conjugate() / (-1j * omega - p.conjugate()))
        for o, p in zip(outputs, poles, strict=True)
    )
    steady = -np.sum(outputs / poles).real
    states = fit_state_space(omega, response[:, None, None], steady_dashpot=[[steady]], tolerance=1e-5)
    assert states.order == 4
    assert np.allclose(np.sort_complex(states.poles), np.sort_complex(poles), rtol=1e-5)


def test_least_squares_under_conditions():
    rng = np.random.default_rng(4)
    matrix, right = rng.normal(size=(30, 5)), rng.normal(size=30)
    e, f = rng.normal(size=(1, 5)), np.array([0.7])
    g, h = rng.normal(size=(4, 5)), rng.normal(size=4)
    x = LeastSquares.of(matrix, right, (e, f)).solution((g, h))
    assert np.allclose(e @ x, f) and np.all(g @ x >= h - 1e-9)
    best = np.linalg.norm(matrix @ x - right)
    null = np.linalg.svd(e)[2][1:].T
    for _ in range(300):
        other = x + null @ (0.05 * rng.normal(size=4))
        if np.all(g @ other >= h):
            assert np.linalg.norm(matrix @ other - right) >= best - 1e-10


def test_failures_say_what_to_do():
    memory, _, _ = rectangle_memory(4)
    with pytest.raises(ConvergenceError, match="raise the tolerance"):
        fit_memory(memory, tolerance=1e-5, highest_order=4)
    omega = np.linspace(0.1, 3.0, 20)
    response = np.ones((20, 1, 1), complex)
    for changed in (
        {"omega": omega[::-1]},
        {"response": response[:, 0]},
        {"steady_dashpot": [1.0]},
        {"tolerance": 0.0},
    ):
        arguments = {"omega": omega, "response": response, "steady_dashpot": [[1.0]], "tolerance": 1e-3} | changed
        with pytest.raises(InputError):
            fit_state_space(**arguments)
