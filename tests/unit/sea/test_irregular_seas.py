"""Synthesised seas: energy, moments, reproducibility, three ways to sum, responses."""

import hashlib
import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.sea import irregular, spectra, time_sum
from moyai.sea.components import WaveComponents
from moyai.sea.synthesis import uniform_numbers
from moyai.sea.water import Water

WATER = Water(18.0, 1025.0, 9.81)
RNG = np.random.default_rng(41)


@pytest.mark.parametrize("method", ["fft", "equal_energy"])
@pytest.mark.parametrize("case", range(4))
def test_energy_of_the_sea_is_that_of_the_spectrum(method, case):
    height, period = float(RNG.uniform(0.1, 6.0)), float(RNG.uniform(2.0, 15.0))
    spectrum = spectra.jonswap(height, period, float(RNG.uniform(1.0, 7.0)))
    sea = irregular.synthesise(spectrum, WATER, duration=200.0 * period, seed=case, method=method)
    assert sea.variance == pytest.approx(spectrum.variance, rel=1e-12)
    assert sea.significant_height == pytest.approx(height, rel=1e-12)


def test_record_of_a_fourier_sea_has_exactly_its_variance():
    spectrum = spectra.pierson_moskowitz(2.0, 7.0)
    sea = irregular.synthesise(spectrum, WATER, duration=1000.0, time_step=0.25, seed=1)
    steps = round(sea.repeat_period / 0.25)
    assert steps * 0.25 >= 1000.0
    record = sea.elevation(np.arange(steps) * 0.25)
    assert np.var(record) == pytest.approx(spectrum.variance, rel=1e-12)
    np.testing.assert_allclose(sea.elevation(np.arange(20) * 0.25 + sea.repeat_period), record[:20], atol=1e-9)


def test_bins_hold_the_energy_of_the_spectrum_piece_by_piece():
    spectrum = spectra.jonswap(2.0, 9.0, 5.0)
    sea = irregular.synthesise(spectrum, WATER, duration=900.0, seed=1, lower_omega=0.4, upper_omega=2.5)
    share = spectrum.variance / spectrum.moment(0, 0.4, 2.5)
    for low in range(0, len(sea) - 20, 20):
        part = slice(low, low + 20)
        first, last = sea.omega[part][0], sea.omega[part][-1]
        step = sea.frequency_step
        wanted = share * spectrum.moment(0, max(first - 0.5 * step, 0.4), last + 0.5 * step)
        assert 0.5 * np.sum(sea.amplitude[part] ** 2) == pytest.approx(wanted, rel=1e-9)


def test_equal_energy_moments_are_right_on_average():
    spectrum = spectra.jonswap(2.0, 8.0, 3.3)
    band = spectrum.truncated(0.4, 3.0)
    seas = [
        irregular.synthesise(
            spectrum,
            WATER,
            duration=600.0,
            seed=seed,
            method="equal_energy",
            count=60,
            lower_omega=0.4,
            upper_omega=3.0,
        )
        for seed in range(40)
    ]
    for order in (1, 2, -1):
        found = [np.sum(0.5 * sea.amplitude**2 * sea.omega**order) / sea.variance for sea in seas]
        wanted = band.moment(order) / band.moment(0)
        error = np.std(found) / math.sqrt(len(found))
        assert abs(np.mean(found) - wanted) < 4.0 * error + 1e-12
        assert error < 0.01 * wanted


def test_equal_energy_sea_does_not_repeat():
    sea = irregular.synthesise(
        spectra.jonswap(2.0, 8.0, 3.3), WATER, duration=600.0, seed=3, method="equal_energy", count=200
    )
    assert sea.repeat_period == math.inf
    assert np.allclose(sea.amplitude, sea.amplitude[0], rtol=1e-14)
    first = sea.elevation(np.arange(0.0, 100.0, 0.5))
    for later in (600.0, 1200.0, 6000.0):
        other = sea.elevation(np.arange(0.0, 100.0, 0.5) + later)
        assert abs(np.corrcoef(first, other)[0, 1]) < 0.6


def test_same_seed_gives_the_same_sea_bit_for_bit():
    spectrum = spectra.jonswap(2.0, 8.0, 3.3)
    for method in ("fft", "equal_energy"):
        a, b = (irregular.synthesise(spectrum, WATER, duration=600.0, seed=12, method=method) for _ in range(2))
        for name in ("omega", "amplitude", "phase", "heading", "wave_number"):
            assert getattr(a, name).tobytes() == getattr(b, name).tobytes()
        other = irregular.synthesise(spectrum, WATER, duration=600.0, seed=13, method=method)
        assert not np.array_equal(a.phase, other.phase)


def test_random_numbers_are_pinned_across_versions():
    """The raw stream of PCG64 is guaranteed by NumPy; a change of these digests changes every stored sea."""
    digest = hashlib.sha256(
        b"".join(uniform_numbers(7, name, 1000).tobytes() for name in ("phase", "heading"))
    ).hexdigest()
    assert digest[:16] == "1168772011adc27e"
    numbers = uniform_numbers(7, "phase", 200_000)
    assert numbers.min() >= 0.0 and numbers.max() < 1.0
    assert numbers.mean() == pytest.approx(0.5, abs=0.003)
    assert np.corrcoef(numbers[:-1], numbers[1:])[0, 1] == pytest.approx(0.0, abs=0.01)


def test_rayleigh_amplitudes_have_the_spectrum_as_their_mean():
    spectrum = spectra.pierson_moskowitz(2.0, 7.0)
    plain = irregular.synthesise(spectrum, WATER, duration=20000.0, seed=2)
    random = irregular.synthesise(spectrum, WATER, duration=20000.0, seed=2, amplitudes="rayleigh")
    ratio = (random.amplitude / plain.amplitude) ** 2
    assert ratio.mean() == pytest.approx(1.0, abs=4.0 / math.sqrt(ratio.size))
    assert ratio.std() == pytest.approx(1.0, abs=0.06)
    np.testing.assert_array_equal(random.phase, plain.phase)


def test_three_ways_to_sum_agree():
    sea = irregular.synthesise(
        spectra.jonswap(2.0, 8.0, 3.3), WATER, duration=1200.0, time_step=0.2, seed=4, heading=0.4
    )
    time = 37.0 + np.arange(3000) * 0.2
    fourier = sea.elevation(time, 12.0, -5.0)
    apart = WaveComponents(sea.omega, sea.amplitude, sea.phase, sea.heading, sea.wave_number, WATER)
    recurrence = apart.elevation(time, 12.0, -5.0)
    shuffled = time[::-1].copy()
    direct = apart.elevation(shuffled, 12.0, -5.0)[::-1]
    track = apart.elevation_along(time, 12.0, -5.0)
    np.testing.assert_allclose(recurrence, fourier, atol=1e-10)
    np.testing.assert_allclose(direct, fourier, atol=1e-10)
    np.testing.assert_allclose(track, fourier, atol=1e-10)
    assert time_sum.uniform_step(time) == pytest.approx(0.2)
    assert time_sum.uniform_step(shuffled) is None
    assert time_sum.uniform_step(np.concatenate([time, [time[-1] + 0.1]])) is None


def test_shapes_are_times_by_points():
    sea = irregular.synthesise(spectra.jonswap(2.0, 8.0, 3.3), WATER, duration=200.0, seed=4)
    assert np.shape(sea.elevation(1.0)) == ()
    assert sea.elevation(np.zeros((2, 3)), np.zeros(4), 1.0).shape == (2, 3, 4)
    assert sea.velocity(np.zeros(2), np.zeros((4, 1)), np.zeros(5), -1.0).shape == (2, 4, 5, 3)
    assert sea.stokes_drift(np.array([0.0, -3.0])).shape == (2, 2)
    track = sea.elevation_along(np.array([0.0, 1.0]), np.array([0.0, 5.0]), 0.0)
    np.testing.assert_allclose(track[1], sea.elevation(1.0, 5.0), atol=1e-12)


def test_responses_and_envelope():
    sea = irregular.synthesise(spectra.jonswap(2.0, 8.0, 3.3), WATER, duration=600.0, seed=4)
    time = np.linspace(0.0, 90.0, 40)
    delayed = sea.respond(np.exp(1j * sea.omega * 2.5), time)
    np.testing.assert_allclose(delayed, sea.elevation(time - 2.5), atol=1e-10)
    both = sea.respond(np.stack([np.ones(len(sea)), -1j * sea.omega]), time)
    assert both.shape == (40, 2)
    rate = (sea.elevation(time + 1e-4) - sea.elevation(time - 1e-4)) / 2e-4
    np.testing.assert_allclose(both[:, 1], rate, atol=1e-6)
    envelope = sea.envelope(time)
    assert (envelope >= np.abs(sea.elevation(time)) - 1e-12).all()
    alone = WaveComponents(np.array([0.8]), np.array([1.3]), np.array([0.2]), np.zeros(1), np.array([0.07]))
    np.testing.assert_allclose(alone.envelope(time), 1.3, rtol=1e-12)


def test_current_shifts_the_components():
    spectrum = spectra.jonswap(1.0, 8.0, 3.3)
    sea = irregular.synthesise(spectrum, WATER, duration=600.0, seed=1, heading=0.5, current=(0.5, 0.2))
    along = 0.5 * math.cos(0.5) + 0.2 * math.sin(0.5)
    np.testing.assert_allclose(sea.intrinsic_omega, sea.omega - sea.wave_number * along, rtol=1e-12)
    np.testing.assert_allclose(
        sea.intrinsic_omega**2, 9.81 * sea.wave_number * np.tanh(sea.wave_number * 18.0), rtol=1e-11
    )
    with pytest.raises(InputError, match="blocks"):
        irregular.synthesise(spectrum, WATER, duration=600.0, seed=1, current=(-3.0, 0.0))


def test_measured_tables_are_used_whole():
    frequency = np.linspace(0.05, 0.4, 36)
    table = spectra.from_table(frequency, np.exp(-(((frequency - 0.12) / 0.03) ** 2)))
    sea = irregular.synthesise(table, WATER, duration=3600.0, seed=1)
    assert sea.variance == pytest.approx(table.variance, rel=1e-12)
    assert sea.omega.min() >= 2.0 * math.pi * 0.05 - sea.frequency_step
    assert sea.omega.max() <= 2.0 * math.pi * 0.4 + sea.frequency_step


@pytest.mark.parametrize(
    ("change", "name"),
    [
        ({"duration": 0.0}, "duration"),
        ({"duration": 1.0}, "duration"),
        ({"seed": -1}, "seed"),
        ({"seed": 1.5}, "seed"),
        ({"seed": True}, "seed"),
        ({"method": "dft"}, "method"),
        ({"count": 100}, "count"),
        ({"method": "equal_energy", "count": 0}, "count"),
        ({"time_step": 5.0}, "time_step"),
        ({"time_step": -0.1}, "time_step"),
        ({"lower_omega": 2.0, "upper_omega": 1.0}, "upper_omega"),
        ({"lower_omega": 1e-4, "upper_omega": 1e-3}, "upper_omega"),
        ({"summation": "triple"}, "summation"),
        ({"amplitudes": "normal"}, "amplitudes"),
        ({"heading_count": 0}, "heading_count"),
    ],
)
def test_bad_requests_are_named(change, name):
    request = {"duration": 600.0, "seed": 1, **change}
    with pytest.raises(InputError, match=name):
        irregular.synthesise(spectra.jonswap(2.0, 8.0, 3.3), WATER, **request)


def test_bad_components_are_named():
    ones = np.ones(3)
    with pytest.raises(InputError, match="phase"):
        WaveComponents(ones, ones, np.ones(2), ones, ones)
    with pytest.raises(InputError, match="amplitude"):
        WaveComponents(ones, np.array([1.0, np.nan, 1.0]), ones, ones, ones)
    with pytest.raises(InputError, match="omega"):
        WaveComponents(np.empty(0), np.empty(0), np.empty(0), np.empty(0), np.empty(0))
    with pytest.raises(InputError, match="water"):
        WaveComponents(ones, ones, ones, ones, ones).velocity(0.0, 0.0, 0.0, 0.0)
