"""Coefficients of a 3-D program in time: excitation, memory, turning with the body."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray as xr
from bodies_for_tests import GRAVITY

from moyai.core.errors import InputError
from moyai.coupled.rigid import RigidBody
from moyai.coupled.wave_loads import DOFS, WaveLoads
from moyai.flexible.flow import Flow
from moyai.sea.components import WaveComponents
from moyai.sea.water import Water

WATER = Water(depth=30.0, density=1000.0, gravity=GRAVITY)


def dataset(headings=(0.0, 90.0, 180.0, 270.0), *, damped=True, seed=0):
    """A made-up body whose memory is known: K(t) = sum of decaying cosines, with what follows from it."""
    random = np.random.default_rng(seed)
    omega = np.concatenate([np.linspace(0.05, 4.0, 60), np.linspace(4.2, 12.0, 30)])
    decay, swing = 0.5, 1.3
    size = np.array([300.0, 250.0, 400.0, 60.0, 70.0, 30.0])
    # K = A (cos(w0 t) - (a/w0) sin(w0 t)) e^(-a t): its integral vanishes, so that B(0) = 0
    response = 0.5 * (
        (1.0 + 1j * -decay / swing * 1j) / (decay - 1j * (omega + swing))
        + (1.0 - 1j * -decay / swing * 1j) / (decay - 1j * (omega - swing))
    )
    time = np.linspace(0.0, 60.0, 60001)
    kernel = (np.cos(swing * time) - decay / swing * np.sin(swing * time)) * np.exp(-decay * time)
    response = np.array([np.trapezoid(kernel * np.exp(1j * w * time), time) for w in omega])
    damping = response.real[:, None, None] * np.diag(size)
    infinite = np.diag([500.0, 450.0, 900.0, 120.0, 110.0, 40.0])
    added = infinite - (response.imag / omega)[:, None, None] * np.diag(size)
    angle = np.radians(headings)
    force = np.zeros((omega.size, angle.size, 6), dtype=complex)
    force[:, :, 0] = 1e3 * np.cos(angle) * (1.0 + 0.2j)
    force[:, :, 1] = 1e3 * np.sin(angle) * (1.0 + 0.2j)
    force[:, :, 2] = 2e3
    force[:, :, 3] = -300.0 * np.sin(angle) * 1j
    force[:, :, 4] = 300.0 * np.cos(angle) * 1j
    stiffness = np.diag([0.0, 0.0, 9000.0, 900.0, 1100.0, 0.0])
    names = list(DOFS)
    pair = ("radiating_dof", "influenced_dof")
    return xr.Dataset(
        {
            "added_mass": (("omega", *pair), added),
            "radiation_damping": (("omega", *pair), damping if damped else 0.0 * damping),
            "infinite_frequency_added_mass": (pair, infinite),
            "excitation_force": (("omega", "wave_direction", "influenced_dof"), force),
            "hydrostatic_stiffness": (pair, stiffness),
        },
        coords={
            "omega": omega, "wave_direction": angle, "radiating_dof": names, "influenced_dof": names,
            "reference_point": ("xyz", [0.0, 0.0, -0.1]),
        },
    ), kernel, time, size, infinite, stiffness, random  # fmt: skip


def loads(data, **options):
    return WaveLoads.from_dataset(data, displaced_volume=1.5, equilibrium_position=(0.0, 0.0, -1.0), **options)


def body(wave_loads, **changes):
    values = {
        "name": "float", "mass": 1500.0, "inertia": (500.0, 600.0, 400.0), "centre_of_gravity": (0.0, 0.0, 0.9),
        "position": (0.0, 0.0, -1.0), "loads": wave_loads, **changes,
    }  # fmt: skip
    return RigidBody(**values)


def run(carrier, duration, step):
    none, rows = np.zeros((2, 0, 3)), []
    for number in range(1, round(duration / step) + 1):
        carrier.try_step(number * step, none)
        carrier.accept()
        rows.append((carrier.time, *carrier.state))
    return np.array(rows)


@pytest.mark.slow
def test_heave_in_a_regular_wave_is_that_of_the_frequency_domain() -> None:
    data, *_, stiffness, _ = dataset()
    omega = 1.7
    wave = WaveComponents([omega], [0.1], [0.3], [0.0], [omega**2 / GRAVITY], WATER)
    carrier = body(loads(data), free=(False, False, True, False, False, False)).carrier(
        WATER, Flow(waves=wave, ramp=10.0)
    )
    rows = run(carrier, 160.0, 0.05)
    added = np.interp(omega, data.omega, data.added_mass.values[:, 2, 2])
    damping = np.interp(omega, data.omega, data.radiation_damping.values[:, 2, 2])
    answer = 2e3 * 0.1 / (stiffness[2, 2] - omega**2 * (1500.0 + added) - 1j * omega * damping)
    keep = rows[:, 0] > 140.0
    exact = np.real(answer * np.exp(1j * (0.3 - omega * rows[keep, 0])))
    assert np.max(np.abs(rows[keep, 3] + 0.1 - exact)) < 6e-3 * abs(answer)


def test_memory_decays_as_the_convolution_does() -> None:
    """Free decay in surge against springs, with the memory integrated step by step."""
    from scipy.integrate import solve_ivp  # noqa: F401

    data, kernel, time, size, infinite, *_ = dataset()
    spring = np.diag([2000.0, 0, 0, 0, 0, 0])
    carrier = body(loads(data), stiffness=spring, free=(True,) + (False,) * 5).carrier(WATER)
    carrier.state[7] = 1.0
    rows = run(carrier, 12.0, 0.02)
    step = 0.005
    count = 2400
    k = size[0] * np.interp(step * np.arange(count + 1), time, kernel)
    mass = 1500.0 + infinite[0, 0]
    x, v = np.zeros(count + 1), np.zeros(count + 1)
    v[0] = 1.0

    def force(n):
        past = 0.0 if n == 0 else np.dot(k[: n + 1][::-1], v[: n + 1]) - 0.5 * (k[n] * v[0] + k[0] * v[n])
        return -2000.0 * x[n] - step * past

    a = force(0) / mass
    for n in range(count):
        x[n + 1] = x[n] + step * v[n] + 0.5 * step**2 * a
        v[n + 1] = v[n] + step * a
        for _ in range(3):
            new = force(n + 1) / mass
            v[n + 1] = v[n] + 0.5 * step * (a + new)
        a = force(n + 1) / mass
    assert np.max(np.abs(rows[:, 1] - np.interp(rows[:, 0], step * np.arange(count + 1), x))) < 5e-3 * np.abs(x).max()


@pytest.mark.slow
def test_a_turned_body_feels_the_wave_from_its_own_heading() -> None:
    """Wave and body turned by the same angle: the same motion, turned."""
    data, *_ = dataset(tuple(np.arange(0.0, 360.0, 30.0)))
    ends = []
    for turn in (0.0, math.radians(60.0)):
        omega = 1.1
        wave = WaveComponents([omega], [0.2], [0.0], [turn + math.radians(30.0)], [omega**2 / GRAVITY], WATER)
        carrier = body(loads(data, equilibrium_yaw=turn), rotation=(0.0, 0.0, turn)).carrier(WATER, Flow(waves=wave))
        rows = run(carrier, 6.0, 0.05)
        c, s = math.cos(turn), math.sin(turn)
        ends.append((c * rows[-1, 1] + s * rows[-1, 2], -s * rows[-1, 1] + c * rows[-1, 2], rows[-1, 3]))
    assert np.allclose(ends[0], ends[1], rtol=0, atol=1e-9)
    assert np.abs(ends[0]).min() > 1e-3


def test_loads_about_another_point_give_the_same_motion() -> None:
    """The same water loads referred to a point a metre higher: only the words change."""
    data, *_ = dataset()
    first = loads(data)
    moved = first.about(np.array([0.0, 0.0, 1.9]), np.zeros(3))
    back = WaveLoads(**moved.__dict__).about(np.array([0.0, 0.0, 0.9]), np.zeros(3))
    assert np.allclose(back.infinite_frequency_added_mass, first.infinite_frequency_added_mass)
    assert np.allclose(back.amplitude, first.about(np.array([0.0, 0.0, 0.9]), np.zeros(3)).amplitude)


@pytest.mark.slow
def test_what_coefficients_lack_is_named() -> None:
    data, *_ = dataset()
    for changed, reported in (
        (data.drop_vars("infinite_frequency_added_mass"), "infinite frequency added mass"),
        (data.drop_vars("hydrostatic_stiffness"), "hydrostatic stiffness"),
        (data.isel(radiating_dof=slice(0, 3), influenced_dof=slice(0, 3)), "Surge, Sway, Heave"),
    ):
        with pytest.raises(InputError) as caught:
            loads(changed)
        assert reported in str(caught.value)
    with pytest.raises(InputError, match="displaced volume"):
        WaveLoads.from_dataset(data, displaced_volume=-1.0, equilibrium_position=(0, 0, 0))
    far = WaveComponents([20.0], [0.1], [0.0], [0.0], [40.0], WATER)
    with pytest.raises(InputError, match="meet coefficients of"):
        body(loads(data)).carrier(WATER, Flow(waves=far))
    lonely, *_ = dataset((0.0,))
    oblique = WaveComponents([1.0], [0.1], [0.0], [1.0], [0.1], WATER)
    carrier = body(loads(lonely)).carrier(WATER, Flow(waves=oblique))
    with pytest.raises(InputError, match="outside the headings"):
        carrier.try_step(0.1, np.zeros((2, 0, 3)))
