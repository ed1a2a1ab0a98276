"""Fatigue against closed forms and against Gaussian records counted cycle by cycle."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.design.fatigue import (
    EnduranceCurve,
    damage,
    dirlik_damage,
    equivalent_range,
    life,
)
from moyai.series.rainflow import count_cycles


def curve(exponent=3.0, capacity=1000.0):
    return EnduranceCurve("test", exponent, capacity, "1", True, "")


def record(frequency, density, duration, seed, step):
    """A Gaussian record of a one-sided spectrum [unit2/Hz]."""
    rng = np.random.default_rng(seed)
    n = int(duration / step)
    f = np.fft.rfftfreq(n, step)
    s = np.interp(f, frequency, density, left=0.0, right=0.0)
    amplitude = 0.5 * np.sqrt(s / duration) * (rng.standard_normal(f.size) + 1j * rng.standard_normal(f.size))
    return np.fft.irfft(amplitude * n, n)


def moments(frequency, density):
    return [float(np.trapezoid(frequency**k * density, frequency)) for k in range(5)]


def narrow_band_damage(moments, duration, curve):
    """Damage of ranges that follow Rayleigh, from m0 and m2 of their spectrum."""
    mean_power = (8.0 * moments[0]) ** (0.5 * curve.exponent) * math.gamma(1.0 + 0.5 * curve.exponent)
    return math.sqrt(moments[2] / moments[0]) * duration * mean_power / curve.capacity


def test_a_sine_does_the_damage_of_its_range():
    time = np.arange(0.0, 1000.0, 0.02)
    ranges, _, counts = count_cycles(0.1 * np.sin(2 * math.pi * time / 10.0))
    assert damage(ranges, counts, curve()) == pytest.approx(100.0 * 0.2**3 / 1000.0, rel=0.01)
    assert equivalent_range(ranges, counts, 3.0, 100.0) == pytest.approx(0.2, rel=0.005)


@pytest.mark.parametrize("exponent", [3.0, 4.09, pytest.param(5.05, marks=pytest.mark.slow)])
def test_narrow_band_damage_is_that_of_the_counted_record(exponent):
    frequency = np.linspace(0.095, 0.105, 201)
    density = np.full(201, 1.0)
    m = moments(frequency, density)
    series = record(frequency, density, 200_000.0, 4, 0.5)
    ranges, _, counts = count_cycles(series)
    counted = damage(ranges, counts, curve(exponent))
    expected = narrow_band_damage(m, 200_000.0, curve(exponent))
    # The record holds 20 000 cycles, and slowly varying amplitudes: its own scatter is 3 % to 8 %
    assert counted == pytest.approx(expected, rel=0.1)


@pytest.mark.parametrize(("low", "high", "second"), [(0.05, 0.3, 0.0), (0.02, 0.15, 0.25), (0.05, 0.12, 0.6)])
def test_dirlik_is_close_to_counted_records_where_the_narrow_band_is_far(low, high, second):
    frequency = np.linspace(0.005, 0.8, 1600)
    density = np.where((frequency > low) & (frequency < high), 1.0, 0.0)
    if second:
        density = density + np.where((frequency > second) & (frequency < second + 0.05), 0.4, 0.0)
    m = moments(frequency, density)
    ranges, _, counts = count_cycles(record(frequency, density, 100_000.0, 5, 0.2))
    counted = damage(ranges, counts, curve())
    assert dirlik_damage(m, 100_000.0, curve()) == pytest.approx(counted, rel=0.12)
    assert narrow_band_damage(m, 100_000.0, curve()) > 0.98 * counted


def test_life_is_the_inverse_of_the_mean_damage():
    years = life([1e-4, 1e-6], [0.1, 0.9], 10800.0)
    assert years == pytest.approx(10800.0 / (0.1 * 1e-4 + 0.9 * 1e-6) / (365.25 * 86400.0))
    assert life([0.0], [1.0], 10800.0) == math.inf


def test_bad_input_is_reported():
    with pytest.raises(InputError, match="finite"):
        count_cycles([1.0, math.nan, 2.0, 3.0])
    with pytest.raises(InputError, match="zero or more"):
        damage([-1.0], [1.0], curve())
    with pytest.raises(InputError, match="sum to"):
        life([1.0], [0.5], 10.0)
