"""A single value comes back as a float, not as a scalar or an empty array of numpy."""

import numpy as np
import pytest

from moyai.core.single import plain
from moyai.core.validity import IdentityCheck
from moyai.design import EnduranceCurve
from moyai.floating import response_statistics
from moyai.mooring import solve_catenary
from moyai.sea import Water, current, group_velocity, nonlinear_wave, spectra, synthesise, wave_number
from moyai.series import fit, fit_harmonics


@pytest.mark.parametrize("value", [2.0, np.float64(2.0), np.array(2.0), np.int64(2)])
def test_plain(value):
    assert type(plain(value)) is float and plain(value) == 2.0
    assert plain([value]).shape == (1,)


def test_a_line_gives_floats_and_many_lines_arrays():
    names = ["horizontal_tension", "vertical_tension_fairlead", "vertical_tension_anchor", "grounded_length"]
    names += ["horizontal_tension_anchor", "residual", "tension_fairlead", "tension_anchor", "anchor_uplift_angle"]
    one, many = (solve_catenary(x, 10.0, 55.0, 5e8, 1000.0) for x in (50.0, [50.0]))
    for name in names:
        assert type(getattr(one, name)) is float
        assert getattr(many, name).shape == (1,) and getattr(many, name)[0] == getattr(one, name)


def test_other_numbers_are_floats():
    profile = current.uniform(0.5, 0.0)
    assert type(profile.speed(-1.0)) is float and type(profile.component(-1.0, 0.3)) is float
    assert profile.speed([-1.0, -2.0]).shape == (2,)
    assert type(IdentityCheck("any", np.float64(1.0), 1.0).value) is float
    fitted = fit(np.random.default_rng(1).gumbel(100.0, 10.0, 50), "gumbel")
    assert {type(getattr(fitted, name)) for name in ("location", "scale", "shape", "log_likelihood")} == {float}


def test_one_response_and_one_channel_give_floats():
    names = ["standard_deviation", "significant", "mean_zero_crossing_period"]
    omega = np.linspace(0.2, 3.0, 141)
    one, many = (response_statistics(omega, np.full(shape, 2.0), np.exp(-omega)) for shape in ((141,), (141, 1)))
    assert {type(getattr(one, name)) for name in names} == {type(one.most_probable_maximum(600.0))} == {float}
    for name in names:
        assert getattr(many, name).tolist() == [getattr(one, name)]
    assert many.most_probable_maximum(600.0).tolist() == [one.most_probable_maximum(600.0)]
    time = np.arange(0.0, 20.0, 0.05)
    alone, row = (fit_harmonics(time, np.cos(time).reshape(shape), 1.0, count=1) for shape in ((-1,), (-1, 1)))
    assert type(alone.mean) is type(alone.residual) is float
    assert row.mean.tolist() == [alone.mean] and row.residual.tolist() == [alone.residual]


WATER = Water(10.0, 1025.0, 9.81)
SPECTRUM = spectra.jonswap(significant_height=2.0, peak_period=7.0, peak_enhancement=3.3)
CURVE = EnduranceCurve("own", exponent=3.0, capacity=1000.0, unit="1", confirmed=True, source="own tests")
WAVE = nonlinear_wave("stream_function", height=2.0, water=WATER, period=6.0)
SEA = synthesise(SPECTRUM, WATER, duration=600.0, seed=1)
CALLS = {
    "elevation of a nonlinear wave": lambda value: WAVE.elevation(value, 0.0),
    "elevation of a sea": lambda value: SEA.elevation(value, 0.0, 0.0),
    "energy of a spectrum": SPECTRUM.energy_below,
    "quantile of a spectrum": SPECTRUM.quantile,
    "density of a spectrum": SPECTRUM.density_at,
    "depth function": lambda value: spectra.depth_function(value, 10.0, 9.81),
    "depth function in deep water": lambda value: spectra.depth_function(value, np.inf, 9.81),
    "wave number": lambda value: wave_number(value, 10.0, 9.81),
    "group velocity": lambda value: group_velocity(value, 10.0, 9.81),
    "cycles to failure": CURVE.cycles_to_failure,
}


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
@pytest.mark.parametrize("value", [0.5, np.float64(0.5), np.array(0.5)])
def test_a_call_gives_a_float_for_one_value(call, value):
    assert type(call(value)) is float
    assert call([0.5]).shape == (1,) and call([0.5])[0] == pytest.approx(call(value), rel=1e-12)


def test_the_regime_of_one_line_is_a_whole_number():
    assert type(solve_catenary(50.0, 10.0, 55.0, 5e8, 1000.0).regime) is int
    assert solve_catenary([50.0], 10.0, 55.0, 5e8, 1000.0).regime.shape == (1,)
