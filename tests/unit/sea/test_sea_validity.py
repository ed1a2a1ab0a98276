"""Notices carry the number and the limit; breaking is an error and can be made to raise."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.sea import breaking, spectra, validity
from moyai.sea.nonlinear import nonlinear_wave
from moyai.sea.water import Water

WATER = Water(20.0, 1025.0, 9.81)


def codes(notices):
    return [notice.code for notice in notices]


def test_breaking_limits_by_depth():
    deep = breaking.breaking_limit(5.0, Water(math.inf, 1025.0, 9.81))
    assert deep.height == pytest.approx(0.142 * 9.81 * 25.0 / (2.0 * math.pi), rel=1e-12)
    assert "deep" in deep.criterion
    shallow = breaking.breaking_limit(30.0, Water(2.0, 1025.0, 9.81))
    assert shallow.height == pytest.approx(1.56) and "McCowan" in shallow.criterion
    middle = breaking.breaking_limit(7.0, WATER)
    length = breaking.linear_wavelength(7.0, WATER)
    assert middle.height == pytest.approx(0.142 * length * math.tanh(40.0 * math.pi / length), rel=1e-12)
    assert "Miche" in middle.criterion


def test_highest_steady_wave_limits():
    assert breaking.highest_steady_wave(50.0, math.inf) == pytest.approx(0.141063 * 50.0)
    assert breaking.highest_steady_wave(50.0, 1e7) == pytest.approx(0.141063 * 50.0, rel=1e-5)
    assert breaking.highest_steady_wave(1e7, 2.0) == pytest.approx(2.0 * 0.83322, rel=1e-4)


def test_a_wave_higher_than_breaking_is_an_error():
    rng = np.random.default_rng(81)
    for _ in range(20):
        water = Water(float(rng.uniform(1.0, 60.0)), 1025.0, 9.81)
        period = float(rng.uniform(2.0, 15.0))
        limit = breaking.breaking_limit(period, water).height
        found = [n for n in validity.check_wave(1.01 * limit, period, water) if n.code == "wave-breaking"]
        assert found[0].severity == "error"
        assert found[0].value == pytest.approx(1.01 * limit) and found[0].limit == pytest.approx(limit)
        assert f"{limit:.4g}" in found[0].message
        near = validity.check_wave(0.9 * limit, period, water)
        assert "wave-near-breaking" in codes(near) and "wave-breaking" not in codes(near)


def test_neglected_harmonics_are_those_of_the_exact_wave():
    for depth, length in ((20.0, 60.0), (math.inf, 60.0), (6.0, 40.0)):
        water = Water(depth, 1025.0, 9.81)
        height = 0.05 * breaking.highest_steady_wave(length, depth)
        wave = nonlinear_wave("stream_function", height=height, wavelength=length, water=water, order=14)
        advice = validity.recommended_theory(height, wave.period, water)
        exact = wave.elevation_harmonics[1:5] / wave.elevation_harmonics[0]
        np.testing.assert_allclose(advice.neglected, exact, rtol=0.02)


def test_recommended_theory_climbs_with_the_height():
    water = Water(math.inf, 1025.0, 9.81)
    seen = [validity.recommended_theory(h, 8.0, water).name for h in np.linspace(0.01, 13.0, 200)]
    order = ["linear theory", "Stokes order 2", "Stokes order 3", "Stokes order 4", "Stokes order 5", "stream function"]
    ranks = [order.index(name) for name in seen]
    assert ranks == sorted(ranks)
    assert {0, 1, 2, 3, 5} <= set(ranks)
    # boundaries of Le Mehaute's chart in deep water: H/(g T^2) of 0.001 and 0.008
    g_t2 = 9.81 * 64.0
    assert seen[0] == "linear theory"
    assert validity.recommended_theory(0.0009 * g_t2, 8.0, water).order == 1
    assert validity.recommended_theory(0.0012 * g_t2, 8.0, water).order == 2
    assert validity.recommended_theory(0.0075 * g_t2, 8.0, water).order == 2
    assert validity.recommended_theory(0.0095 * g_t2, 8.0, water).order == 3


def test_long_waves_need_the_stream_function():
    advice = validity.recommended_theory(1.0, 12.0, Water(2.0, 1025.0, 9.81))
    assert advice.theory == "stream_function" and advice.ursell_number > 26.0
    notices = validity.check_wave(1.0, 12.0, Water(2.0, 1025.0, 9.81), theory="stokes", order=5)
    assert "ursell-number" in codes(notices)


def test_theory_notices_have_two_levels():
    gentle = [n for n in validity.check_wave(1.0, 7.0, WATER) if n.code == "wave-theory"]
    assert gentle[0].severity == "information"
    steep = [n for n in validity.check_wave(5.0, 7.0, WATER) if n.code == "wave-theory"]
    assert steep[0].severity == "warning" and steep[0].value > steep[0].limit == 0.1
    assert not validity.check_wave(5.0, 7.0, WATER, theory="stream_function")
    assert not validity.check_wave(0.1, 7.0, WATER)
    assert not validity.check_wave(0.0, 7.0, WATER)


def test_spectrum_notices():
    whole = spectra.jonswap(2.0, 6.0, 3.3)
    assert validity.check_spectrum(whole, WATER) == ()
    cut = validity.check_spectrum(whole, upper_omega=2.0)
    assert codes(cut) == ["spectrum-truncated"]
    assert cut[0].value == pytest.approx(1.0 - whole.moment(0, 0.0, 2.0) / whole.moment(0))
    assert "peak-enhancement" in codes(validity.check_spectrum(spectra.jonswap(2.0, 6.0, 7.5)))
    assert "jonswap-range" in codes(validity.check_spectrum(spectra.jonswap(1.0, 14.0, 3.3)))
    shallow = spectra.tma(0.4, 14.0, 3.3, Water(2.0, 1025.0, 9.81))
    assert "tma-range" in codes(validity.check_spectrum(shallow))
    assert "tma-range" not in codes(validity.check_spectrum(spectra.tma(2.0, 8.0, 3.3, WATER)))
    table = spectra.from_table([0.1, 0.12, 0.14], [0.1, 1.0, 0.5])
    assert codes(validity.check_spectrum(table)) == ["spectrum-table-cut"]


def test_sea_state_notices():
    shallow = Water(3.0, 1025.0, 9.81)
    error = validity.check_sea_state(2.5, 12.0, shallow)
    assert codes(error) == ["significant-height-depth"] and error[0].severity == "error"
    assert validity.check_sea_state(2.0, 12.0, shallow)[0].severity == "warning"
    steep = validity.check_sea_state(5.0, 6.0, WATER)
    assert codes(steep) == ["sea-steepness"]
    assert steep[0].limit == pytest.approx(1.0 / 15.0) and steep[0].severity == "warning"
    broken = validity.check_sea_state(1.01 * breaking.breaking_limit(6.0, WATER).height, 6.0, WATER)
    assert broken[0].severity == "error" and "breaking height" in broken[0].message
    assert validity.check_sea_state(1.0, 6.0, WATER) == ()


def test_bad_heights_are_refused():
    with pytest.raises(InputError, match="height"):
        validity.check_wave(-1.0, 7.0, WATER)
    with pytest.raises(InputError, match="period"):
        validity.check_wave(1.0, math.nan, WATER)
