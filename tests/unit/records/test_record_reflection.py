"""Irregular incident and reflected waves: planted seas come back from two, three and five gauges."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.records.survey.blocks import _above_one
from moyai.records.survey.irregular_reflection import separate_irregular, transmission, wave_series
from moyai.sea.dispersion import wave_number
from moyai.sea.irregular import synthesise
from moyai.sea.spectra import jonswap
from moyai.sea.water import Water
from moyai.series.spectra import WelchOptions

STEP = 0.05
TIME = np.arange(12000) * STEP
WATER = Water(depth=0.8, density=1000.0, gravity=9.81)
OPTIONS = WelchOptions(segment=25.6)
BAND = {"lowest": 0.4, "highest": 1.1}


def flume(seed, reflection, lag, positions, noise=0.0):
    """Incident JONSWAP, reflected by ``reflection`` with a travel distance; returns gauges, incident and reflected."""
    random = np.random.default_rng(seed)
    sea = synthesise(jonswap(0.08, 1.6, 3.3), WATER, duration=600.0, seed=seed, time_step=STEP)
    amplitude = sea.complex_amplitude
    back = reflection * amplitude * np.exp(1j * sea.wave_number * lag)
    transfer = [
        np.exp(1j * sea.wave_number * x) + reflection * np.exp(1j * sea.wave_number * (lag - x)) for x in positions
    ]
    gauges = sea.respond(np.array(transfer), TIME)
    return gauges + noise * random.normal(size=gauges.shape), sea, back


@pytest.mark.parametrize(
    "positions", [(0.0, 0.45), (0.0, 0.3, 0.75), (0.0, 0.25, 0.6, 0.8, 1.3)], ids=["two", "three", "five"]
)
@pytest.mark.parametrize("seed", range(3))
def test_planted_reflection(positions, seed):
    reflection = np.random.default_rng(seed).uniform(0.1, 0.9)
    gauges, sea, _ = flume(seed, reflection, 4.0, positions)
    found = separate_irregular(STEP, gauges, positions, WATER, OPTIONS, **BAND)
    assert found.reflection == pytest.approx(reflection, abs=max(4.0 * found.reflection_error, 0.02))
    inside = (sea.omega > 2 * math.pi * 0.39) & (sea.omega < 2 * math.pi * 1.11)
    height = 4.0 * math.sqrt(0.5 * np.sum(sea.amplitude[inside] ** 2))
    assert found.incident_height == pytest.approx(height, rel=0.06)
    assert found.reflected_height == pytest.approx(height * reflection, rel=0.08)


@pytest.mark.parametrize("seed", range(3))
def test_noise_is_taken_off(seed):
    gauges, _, _ = flume(seed, 0.2, 3.0, (0.0, 0.3, 0.75), noise=0.004)
    clean = separate_irregular(STEP, gauges, (0.0, 0.3, 0.75), WATER, OPTIONS, **BAND)
    raw = separate_irregular(STEP, gauges, (0.0, 0.3, 0.75), WATER, OPTIONS, subtract_noise=False, **BAND)
    assert raw.reflection > clean.reflection
    assert clean.reflection == pytest.approx(0.2, abs=0.02)
    # Segments of finite length leave a rest of their own, which adds to that of the noise
    quiet, _, _ = flume(seed, 0.2, 3.0, (0.0, 0.3, 0.75))
    rest = separate_irregular(STEP, quiet, (0.0, 0.3, 0.75), WATER, OPTIONS, **BAND)
    assert np.nanmean(clean.noise) - np.nanmean(rest.noise) == pytest.approx(0.004**2 * 2.0 * STEP, rel=0.2)


@pytest.mark.parametrize("seed", range(2))
def test_series_of_incident_and_reflected_waves(seed):
    positions = (0.0, 0.3, 0.75)
    gauges, sea, back = flume(seed, 0.5, 4.0, positions)
    incident, reflected = wave_series(STEP, gauges, positions, WATER, at=0.2, **BAND)
    inside = (sea.omega >= 2 * math.pi * BAND["lowest"]) & (sea.omega <= 2 * math.pi * BAND["highest"])
    turn = np.exp(-1j * np.outer(TIME, sea.omega[inside]))
    k = sea.wave_number[inside]
    truth_in = (turn @ (sea.complex_amplitude[inside] * np.exp(1j * k * 0.2))).real
    truth_back = (turn @ (back[inside] * np.exp(-1j * k * 0.2))).real
    inner = slice(400, -400)
    assert np.std(incident[inner] - truth_in[inner]) < 0.01 * truth_in.std()
    assert np.std(reflected[inner] - truth_back[inner]) < 0.02 * truth_back.std()


def goda_suzuki(positions, amplitudes, k):
    """Incident and reflected amplitudes at x = 0 of two gauges in closed form."""
    (x1, x2), (first, second) = positions, np.moveaxis(amplitudes, -1, 0)
    denominator = 2j * np.sin(k * (x2 - x1))
    incident = (second * np.exp(-1j * k * x1) - first * np.exp(-1j * k * x2)) / denominator
    return incident, (first * np.exp(1j * k * x2) - second * np.exp(1j * k * x1)) / denominator


def test_two_gauges_are_goda_and_suzuki():
    """At every frequency of one segment the energies are those of the closed form."""
    gauges, _, _ = flume(7, 0.4, 2.0, (0.0, 0.45))
    options = WelchOptions(window="rectangular", overlap=0.0)
    found = separate_irregular(STEP, gauges, (0.0, 0.45), WATER, options, **BAND)
    centred = gauges - gauges.mean(axis=0)
    ramp = np.arange(TIME.size) - 0.5 * (TIME.size - 1)
    centred -= ramp[:, None] * (ramp @ centred / (ramp @ ramp))
    frequency = np.fft.rfftfreq(TIME.size, STEP)
    chosen = np.isin(frequency, found.frequency)
    amplitudes = np.conj(np.fft.rfft(centred, axis=0))[chosen] * 2.0 / TIME.size
    k = wave_number(2.0 * math.pi * found.frequency, WATER.depth, WATER.gravity)
    incident, reflected = goda_suzuki((0.0, 0.45), amplitudes, k)
    df = frequency[1]
    np.testing.assert_allclose(found.incident[found.used], (np.abs(incident) ** 2 / (2 * df))[found.used], rtol=1e-9)
    np.testing.assert_allclose(found.reflected[found.used], (np.abs(reflected) ** 2 / (2 * df))[found.used], rtol=1e-9)


@pytest.mark.parametrize("rear", [1, 2])
def test_transmission_with_and_without_a_beach(rear):
    positions = (0.0, 0.3, 0.75)
    gauges, sea, _ = flume(3, 0.5, 4.0, positions)
    front = separate_irregular(STEP, gauges, positions, WATER, OPTIONS, **BAND)
    behind = (6.0, 6.35)[:rear]
    beach = 0.0 if rear == 1 else 0.15
    transfer = [
        0.6 * (np.exp(1j * sea.wave_number * x) + beach * np.exp(1j * sea.wave_number * (20.0 - x))) for x in behind
    ]
    records = sea.respond(np.array(transfer), TIME)
    found = transmission(STEP, front, records, behind, WATER, OPTIONS, **BAND)
    assert found.coefficient == pytest.approx(0.6, abs=0.03)
    assert 0.0 < found.error < 0.06
    if rear == 2:
        assert found.beach_reflection == pytest.approx(0.15, abs=0.03)


def test_badly_placed_gauges_and_faults():
    gauges, _, _ = flume(1, 0.5, 4.0, (0.0, 2.0))
    found = separate_irregular(STEP, gauges, (0.0, 2.0), WATER, OPTIONS, **BAND)
    assert found.notices[0].code == "gauge-spacing" and not found.used.all()
    assert np.isnan(found.incident[~found.used]).all()
    with pytest.raises(InputError, match="two or more different"):
        separate_irregular(STEP, gauges, (1.0, 1.0), WATER, OPTIONS, **BAND)
    with pytest.raises(InputError, match="well placed"):
        separate_irregular(STEP, gauges, (0.0, 0.001), WATER, OPTIONS, **BAND)
    gauges[5, 1] = np.nan
    with pytest.raises(InputError, match="gauge 2 lacks sample 6"):
        separate_irregular(STEP, gauges, (0.0, 2.0), WATER, OPTIONS, **BAND)


def test_more_than_comes_in_is_a_fault_of_the_gauges():
    """Gauges listed along the wrong axis exchange both waves: 1 / 0.35 goes back."""
    gauges, _, _ = flume(1, 0.35, 4.0, (0.0, 0.5, 0.9))
    turned = separate_irregular(STEP, gauges, (0.9, 0.4, 0.0), WATER, OPTIONS, **BAND)
    (notice,) = _above_one("reflection", turned.reflection, turned.reflection_error)
    assert notice.severity == "error" and notice.value > 2.0 and "places of the gauges" in notice.remedy
    right = separate_irregular(STEP, gauges, (0.0, 0.5, 0.9), WATER, OPTIONS, **BAND)
    assert _above_one("reflection", right.reflection, right.reflection_error) == []
    assert _above_one("reflection", 1.02, 0.05) == [] and _above_one("reflection", 1.02, math.nan)
