"""Ropes that remember their highest mean tension: quick stiffness, what a load that stays ends at, what is left."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.flexible import BarType, NetworkBuilder, simulate, solve_equilibrium
from moyai.flexible.motion import Motion
from moyai.flexible.worn_law import WornRope
from moyai.sea.water import Water

STRAIN = np.linspace(0.0, 0.06, 31)
NEW = (STRAIN, 6e7 * STRAIN + 2e8 * STRAIN**2)
ALPHA, BETA, HIGHEST, SLOW, LENGTH = 1.5e8, 23.0, 1.2e6, 1e8, 10.0


def law(form="quadratic", k1=0.25, k2=1.0, highest=HIGHEST):
    return WornRope(*NEW, form, k1, k2, ALPHA, BETA, SLOW, highest)


def pulled(kind, strain):
    builder = NetworkBuilder(Water(100.0, 1e-3, 9.81))
    builder.fixed("left", (0.0, 0.0, 50.0))
    builder.driven("right", (LENGTH * (1.0 + strain[0]), 0.0, 50.0))
    bar = BarType("rope", 1.0, ALPHA, 0.0, volume_per_length=0.0, viscosity=1e5, slow=kind)
    builder.line("rope", "left", "right", bar, length=LENGTH, segments=2)
    return builder.build()


def run(kind, strain, step, method):
    network = pulled(kind, strain)
    place = np.zeros((len(strain), 3))
    place[:, 0] = LENGTH * (np.asarray(strain) - strain[0])
    motion = Motion(0.0, step, place, np.gradient(place, step, axis=0))
    return simulate(
        network, {"right": motion}, duration=step * (len(strain) - 1), output_step=step, method=method,
        start=solve_equilibrium(network).state,
    )  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("method", ["explicit", "tr_bdf2"])
def test_a_step_is_met_by_the_quick_stiffness_and_ends_on_the_working_curve(method):
    kind = law()
    rest = float(np.interp(0.013, *kind.curve_at_rest()))
    strain = np.full(101, 0.0135)
    strain[0] = 0.013
    history = run(kind, strain, 0.1, method)
    assert history.status == "converged"
    tension = history.tension[:, 0]
    assert tension[0] == pytest.approx(rest, rel=1e-3)
    # it fades over SLOW times the slow compliance, 1.1 s: a little of it in the first 0.1 s
    quick = rest + 0.0005 * (ALPHA + BETA * rest)
    assert 0.92 * quick < tension[1] < quick
    assert tension[-1] == pytest.approx(float(np.interp(0.0135, *kind.curve_at_rest())), rel=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("method", ["explicit", "tr_bdf2"])
def test_a_new_highest_tension_is_remembered(method):
    """Pulled along the curve of the new rope to 3 %, then let go to 2 %: on the working curve of what it bore there."""
    up, down = np.linspace(0.013, 0.03, 31), np.linspace(0.03, 0.02, 31)
    strain = np.concatenate([up, np.full(70, 0.03), down, np.full(80, 0.02)])
    history = run(law(), strain, 0.1, method)
    tension = history.tension[:, 0]
    highest = float(np.interp(0.03, *NEW))
    assert tension[100] == pytest.approx(highest, rel=1e-3)
    assert tension[-1] == pytest.approx(float(np.interp(0.02, *law(highest=highest).curve_at_rest())), rel=5e-3)
    assert tension[-1] < 0.6 * float(np.interp(0.02, *law().curve_at_rest()))


@pytest.mark.parametrize("form", ["linear", "quadratic", "exponential"])
def test_the_law_agrees_with_its_curve_and_the_area_under_it(form):
    kind = law(form, k2=1.0 if form == "quadratic" else 1.7)
    strain, tension = kind.curve_at_rest()
    worn = (tension > 0.02 * HIGHEST) & (tension <= HIGHEST)
    assert np.allclose(kind.strain(tension[worn], np.full(worn.sum(), HIGHEST)), strain[worn], atol=1e-12)
    fine = np.linspace(0.0, 0.7 * HIGHEST, 200_001)
    places = kind.strain(fine, np.full(fine.shape, HIGHEST))
    area = float(np.sum(0.5 * (fine[1:] + fine[:-1]) * np.diff(places)))
    assert float(kind.energy(fine[-1:], np.array([HIGHEST]))[0]) == pytest.approx(area, rel=1e-4)


@pytest.mark.slow
def test_cycles_lose_energy_and_never_gain_it():
    """The work of the end over whole cycles on one working curve is what the dashpot takes."""
    time = 0.05 * np.arange(321)
    strain = 0.012 + 0.002 * np.sin(2.0 * math.pi * time / 4.0) * np.clip(time / 4.0, 0.0, 1.0)
    history = run(law(), strain, 0.05, "tr_bdf2")
    late = slice(160, 321)
    loop = float(np.trapezoid(history.tension[late, 1], LENGTH * strain[late]))
    assert loop > 0.0
    assert np.all(history.tension[:, 1] <= HIGHEST)
    swing = np.ptp(history.tension[late, 1])
    assert loop / 2.0 < math.pi / 4.0 * swing * 0.004 * LENGTH


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"highest": 1e9}, "highest mean tension of 1e"),
        ({"k1": 1.2}, "quadratic with k1 = 1.2"),
        ({"k2": 0.7}, "quadratic with k2 = 0.7"),
        ({"form": "exponential", "k2": 0.0}, "exponential with k1 = 0.25 and k2 = 0"),
    ],
)
def test_what_cannot_be_is_refused(change, words):
    with pytest.raises(InputError, match=words):
        law(**change)
