"""Decay, response functions and marker tracks against motions that were integrated or placed."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from moyai.core.errors import InputError
from moyai.records.survey.motions import fit_decay_record, response_function, rigid_motion
from moyai.series.spectra import WelchOptions


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(6))
def test_decay_of_an_integrated_oscillator(seed):
    """x'' + 2 zeta w x' + b |x'| x' + w^2 x = 0 from random coefficients, with noise and an offset."""
    random = np.random.default_rng(seed)
    period, zeta = random.uniform(1.0, 12.0), random.uniform(0.005, 0.05)
    omega, amplitude = 2.0 * math.pi / period, random.uniform(0.05, 1.0)
    b = random.uniform(0.1, 0.6) * zeta * 3.0 * math.pi / (4.0 * amplitude)

    def slope(_, state):
        return state[1], -2.0 * zeta * omega * state[1] - b * abs(state[1]) * state[1] - omega**2 * state[0]

    time = np.arange(0.0, 14.0 * period, period / 60.0)
    motion = solve_ivp(slope, (0.0, time[-1]), (amplitude, 0.0), t_eval=time, rtol=1e-9, atol=1e-12).y[0]
    record = 0.3 + motion + 1e-4 * amplitude * random.normal(size=time.size)
    found = fit_decay_record(time, record, equilibrium=0.3)
    assert found.decay.period == pytest.approx(period, rel=2e-3)
    assert found.decay.damping_ratio == pytest.approx(zeta, rel=0.06)
    assert found.decay.quadratic_over_inertia == pytest.approx(b, rel=0.12)
    assert found.period_error < 0.01 * period
    guessed = fit_decay_record(time, record)
    assert guessed.equilibrium == pytest.approx(0.3, abs=0.1 * amplitude)
    linear = fit_decay_record(time, record, equilibrium=0.3, quadratic=False)
    assert linear.decay.damping_ratio > zeta


def test_decay_faults():
    time = np.arange(0.0, 20.0, 0.05)
    gappy = np.exp(-0.05 * time) * np.cos(2.0 * time)
    gappy[50] = np.nan
    with pytest.raises(InputError, match="gaps"):
        fit_decay_record(time, gappy)
    with pytest.raises(InputError, match="extremes"):
        fit_decay_record(time, np.exp(-time))
    growing = fit_decay_record(time, np.exp(0.02 * time) * np.cos(2.0 * time), start=0.0, equilibrium=0.0)
    assert {notice.code for notice in growing.notices} == {"decay-damping"}


@pytest.mark.parametrize("seed", range(4))
def test_response_function_of_an_oscillator_in_noise(seed):
    """A known filter driven by a random sea, its output with noise: modulus and phase within their own errors."""
    random = np.random.default_rng(seed)
    size, step = 60000, 0.1
    natural, damping = random.uniform(0.15, 0.3), random.uniform(0.08, 0.3)
    frequency = np.fft.rfftfreq(size, step)

    def filter_of(f):
        return 1.0 / (1.0 - (f / natural) ** 2 - 2j * damping * f / natural)  # exp(-i omega t)

    spectrum = np.fft.rfft(random.normal(size=size)) * np.exp(-((frequency - 0.22) ** 2) / 0.01)
    wave = np.fft.irfft(spectrum, size)
    motion = np.fft.irfft(spectrum * np.conj(filter_of(frequency)), size)
    motion += 0.3 * motion.std() * random.normal(size=size)
    found = response_function(step, wave, motion, WelchOptions(segment=300.0), lowest=0.1, highest=0.35)
    truth = filter_of(found.frequency)
    use = found.coherent
    assert use.sum() >= 12
    assert np.sqrt(np.mean((np.abs(found.modulus - np.abs(truth)) / found.error)[use] ** 2)) < 2.0
    phase = np.angle(found.response[use] / truth[use])
    assert np.sqrt(np.mean((phase / found.phase_error[use]) ** 2)) < 2.0
    k = (2.0 * math.pi * found.frequency) ** 2 / 9.81
    moved = found.moved(7.0, k)
    np.testing.assert_allclose(np.abs(moved.response[use]), found.modulus[use])
    noise = response_function(
        step, wave, random.normal(size=size), WelchOptions(segment=60.0), lowest=0.1, highest=0.35
    )
    assert np.isnan(noise.modulus[(noise.frequency > 0.1) & (noise.frequency < 0.35)]).mean() > 0.7
    assert noise.notices[0].code == "coherence"
    with pytest.raises(InputError, match="one segment"):
        response_function(step, wave, motion, WelchOptions(), lowest=0.1, highest=0.3)


@pytest.mark.parametrize("seed", range(6))
def test_markers_give_the_motion_back(seed):
    random = np.random.default_rng(seed)
    reference = random.uniform(-1.0, 1.0, (int(random.integers(2, 6)), 2))
    centre = tuple(random.uniform(-0.5, 0.5, 2))
    size = 300
    sway, heave = np.cumsum(random.normal(size=(2, size)), axis=1) * 0.02
    roll = np.cumsum(random.normal(size=size)) * 0.1  # passes half a turn now and then
    roll -= roll[0]
    arm = reference - centre
    c, s = np.cos(roll)[:, None], np.sin(roll)[:, None]
    tracks = np.stack(
        [
            centre[0] + sway[:, None] + c * arm[:, 0] + s * arm[:, 1],
            centre[1] + heave[:, None] - s * arm[:, 0] + c * arm[:, 1],
        ],
        axis=-1,
    )
    found = rigid_motion(tracks, reference, centre=centre)
    np.testing.assert_allclose(found.sway, sway, atol=1e-12)
    np.testing.assert_allclose(found.heave, heave, atol=1e-12)
    np.testing.assert_allclose(found.roll, roll, atol=1e-12)
    if len(reference) > 2:
        hidden = tracks.copy()
        hidden[40:60, 0] = np.nan
        again = rigid_motion(hidden, reference, centre=centre)
        np.testing.assert_allclose(again.roll, roll, atol=1e-12)
        hidden[50, 1:] = np.nan
        lost = rigid_motion(hidden, reference, centre=centre)
        assert np.isnan(lost.sway[50]) and lost.notices[0].code == "markers-hidden"
        np.testing.assert_allclose(np.delete(lost.sway, 50), np.delete(sway, 50), atol=1e-12)


def test_one_marker_is_refused():
    with pytest.raises(InputError, match="markers"):
        rigid_motion(np.zeros((5, 1, 2)), np.zeros((1, 2)), centre=(0.0, 0.0))
