"""The sea: dispersion, kinematics, waves of finite height, spectra, synthesis, currents, wave_statistics."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.validation import ValidationCase
from moyai.sea import current, directional, dispersion, irregular, spectra
from moyai.sea.breaking import highest_steady_wave
from moyai.sea.nonlinear import nonlinear_wave
from moyai.sea.regular import RegularWave
from moyai.sea.water import Water
from moyai.series import wave_statistics

GRAVITY = 9.81
FOURIER = "J. D. Fenton's program FOURIER, printed solution of 8 terms, kd = 0.6441, kH = 0.2415"
ROUNDED_INPUT = "inputs of the printed solution are rounded to four digits"


def _worst_dispersion_residual() -> float:
    y = np.geomspace(1e-12, 1e4, 2001)
    omega = np.sqrt(y * np.tanh(y) * GRAVITY / 7.0)
    return float(np.max(np.abs(dispersion.wave_number(omega, 7.0, GRAVITY) * 7.0 / y - 1.0)))


def _worst_evanescent_residual() -> float:
    worst = 0.0
    for x in (1e-9, 1e-3, 1.0, 30.0, 1e6):
        omega = math.sqrt(GRAVITY / 3.0 * x)
        delta = dispersion.evanescent_deficits(omega, 3.0, GRAVITY, 3000)
        y = np.arange(1, 3001) * math.pi - delta
        worst = max(worst, float(np.max(np.abs(np.arctan2(omega**2 * 3.0 / GRAVITY, y) / delta - 1.0))))
    return worst


def _curtain_mean_square() -> float:
    points, weights = np.polynomial.legendre.leggauss(30)
    sea = RegularWave(5.508, 7.0, 0.0, Water(20.0, 1025.0, GRAVITY)).components()
    crest = sea.velocity(0.0, 0.0, 0.0, 2.5 * (points - 1.0))[:, 0] + 0.2
    return float(0.5 * weights @ crest**2)


def _fourier_wave() -> tuple[float, float, float, float]:
    water = Water(0.6441, 1000.0, 1.0)
    wave = nonlinear_wave("stream_function", height=0.2415, wavelength=2.0 * math.pi, water=water, order=8)
    ratio = math.cosh(0.6441) / math.cosh(0.6441 + wave.crest)
    return wave.period, wave.celerity, float(wave.elevation_harmonics[1]), float(wave.crest_velocities[0]) * ratio


def _raschii_difference() -> float:
    own, other = (
        nonlinear_wave(
            "stream_function",
            height=4.0,
            wavelength=90.0,
            water=Water(15.0, 1025.0, GRAVITY),
            order=14,
            solver="newton" if own else "raschii",
        )
        for own in (True, False)
    )
    return float(np.max(np.abs(own.elevation_harmonics - other.elevation_harmonics))) / 4.0


def _surface_residual() -> float:
    wave = nonlinear_wave("stream_function", height=5.0, period=8.0, water=Water(10.0, 1025.0, GRAVITY))
    return max(wave.surface_residuals(97))


def _synthesis_variance(method: str) -> float:
    sea = irregular.synthesise(
        spectra.jonswap(2.0, 8.0, 3.3),
        Water(15.0, 1025.0, GRAVITY),
        duration=3600.0,
        seed=11,
        method="fft" if method == "fft" else "equal_energy",
        spreading=directional.CosineTwoS(10.0),
    )
    return sea.significant_height


def _record_variance() -> float:
    sea = irregular.synthesise(
        spectra.jonswap(2.0, 8.0, 3.3), Water(15.0, 1025.0, GRAVITY), duration=3600.0, seed=11, time_step=0.25
    )
    record = sea.elevation(np.arange(round(sea.repeat_period / 0.25)) * 0.25, 40.0)
    return 4.0 * float(np.std(record))


def _power_law_square() -> float:
    return current.power_law(1.0, 1.0 / 7.0, 0.0, Water(20.0, 1025.0, GRAVITY)).depth_mean_squared(-20.0, 0.0)


def _pierson_moskowitz(what: str) -> float:
    spectrum = spectra.pierson_moskowitz(2.0, 1.0)
    return {
        "mean": spectrum.mean_period,
        "zero": spectrum.zero_crossing_period,
        "energy": spectrum.energy_period,
    }[what]


CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        "sea: wave number of 7 s in 20 m",
        "silt-curtain field study, recomputed by an independent prototype",
        lambda: dispersion.wave_number(2.0 * math.pi / 7.0, 20.0, GRAVITY),
        0.08729,
        6e-5,
        note="printed to four digits",
    ),
    ValidationCase(
        "sea: dispersion, kh from 1e-12 to 1e4",
        "exact: omega^2 = g k tanh kh",
        _worst_dispersion_residual,
        0.0,
        3e-15,
        relative=False,
        note="a few units in the last place, those of the test's own frequency included",
    ),
    ValidationCase(
        "sea: 3000 evanescent roots, omega^2 h/g from 1e-9 to 1e6",
        "exact: omega^2 = -g k tan kh",
        _worst_evanescent_residual,
        0.0,
        3e-15,
        relative=False,
        note="relative error of n pi - k h, not of k h itself",
    ),
    ValidationCase(
        "sea: wave number against a current, infinite depth",
        "exact: 4 omega^2 / (g (1 + sqrt(1 + 4 U omega / g))^2)",
        lambda: dispersion.wave_number_in_current(1.1, 4000.0, GRAVITY, -0.9),
        4.0 * 1.1**2 / (GRAVITY * (1.0 + math.sqrt(1.0 - 4.0 * 0.9 * 1.1 / GRAVITY)) ** 2),
        1e-12,
    ),
    ValidationCase(
        "sea: mean square of crest velocity and current over a curtain",
        "silt-curtain field study, closed form recomputed by an independent prototype",
        _curtain_mean_square,
        5.6471736,
        1e-8,
        note="printed to eight digits",
    ),
    ValidationCase(
        "sea: stream function, period", FOURIER, lambda: _fourier_wave()[0], 7.9487, 5e-5, note=ROUNDED_INPUT
    ),
    ValidationCase(
        "sea: stream function, celerity", FOURIER, lambda: _fourier_wave()[1], 0.7905, 1e-4, note=ROUNDED_INPUT
    ),
    ValidationCase(
        "sea: stream function, second harmonic of the elevation",
        FOURIER,
        lambda: _fourier_wave()[2],
        3.8999027e-2,
        4e-4,
        note=ROUNDED_INPUT,
    ),
    ValidationCase(
        "sea: stream function, first coefficient",
        FOURIER,
        lambda: _fourier_wave()[3],
        0.13540388,
        4e-4,
        note=ROUNDED_INPUT,
    ),
    ValidationCase(
        "sea: stream function against raschii",
        "raschii, same order, kd = 1.05, 40 % of the highest wave",
        _raschii_difference,
        0.0,
        1e-6,
        relative=False,
        note="largest difference of the elevation harmonics over the height; raschii stops at 1e-8 of the depth",
    ),
    ValidationCase(
        "sea: free surface of a steep wave between the nodes",
        "exact: constant stream function and Bernoulli head",
        _surface_residual,
        0.0,
        1e-5,
        relative=False,
        note="order raised until it holds",
    ),
    ValidationCase(
        "sea: highest wave of L/d = 9.755",
        "header of the same printed solution, H/d = 0.707",
        lambda: highest_steady_wave(2.0 * math.pi, 0.6441) / 0.6441,
        0.707,
        8e-4,
        note="printed to three digits",
    ),
    ValidationCase(
        "sea: JONSWAP significant height",
        "definition 4 sqrt(m0)",
        lambda: spectra.jonswap(2.0, 8.0, 3.3).significant_height,
        2.0,
        1e-13,
    ),
    ValidationCase(
        "sea: Pierson-Moskowitz T_m01 / T_p",
        "closed form with the gamma function",
        lambda: _pierson_moskowitz("mean"),
        1.25**-0.25 / math.gamma(0.75),
        1e-13,
    ),
    ValidationCase(
        "sea: Pierson-Moskowitz T_m02 / T_p",
        "closed form",
        lambda: _pierson_moskowitz("zero"),
        (1.25 * math.pi) ** -0.25,
        1e-13,
    ),
    ValidationCase(
        "sea: Pierson-Moskowitz T_e / T_p",
        "closed form with the gamma function",
        lambda: _pierson_moskowitz("energy"),
        1.25**-0.25 * math.gamma(1.25),
        1e-13,
    ),
    ValidationCase(
        "sea: peakedness of Pierson-Moskowitz",
        "closed form",
        lambda: spectra.pierson_moskowitz(1.0, 7.0).peakedness,
        2.0,
        1e-12,
    ),
    ValidationCase(
        "sea: Bretschneider-Mitsuyasu T_p / T_1/3",
        "printed form of Mitsuyasu (1970): (0.8 x 1.03)^-1/4",
        lambda: spectra.bretschneider_mitsuyasu(2.0, 1.0).peak_period,
        0.824**-0.25,
        1e-12,
    ),
    ValidationCase(
        "sea: height of a synthesised directional sea, Fourier",
        "identity",
        lambda: _synthesis_variance("fft"),
        2.0,
        1e-12,
    ),
    ValidationCase(
        "sea: height of a synthesised directional sea, equal energy",
        "identity",
        lambda: _synthesis_variance("equal energy"),
        2.0,
        1e-12,
    ),
    ValidationCase(
        "sea: height of a record of that sea away from the origin", "identity", _record_variance, 2.0, 1e-10
    ),
    ValidationCase("sea: mean square of a 1/7 current profile", "exact: 7/9", _power_law_square, 7.0 / 9.0, 1e-13),
    ValidationCase(
        "sea: Rayleigh H_1/3 / H_rms",
        "exact, recomputed independently",
        lambda: wave_statistics.rayleigh_significant(1.0 / 3.0),
        1.41573,
        4e-6,
        note="printed to six digits",
    ),
    ValidationCase(
        "sea: expected highest of 1000 Rayleigh waves over H_1/3",
        "exact, recomputed independently",
        lambda: wave_statistics.rayleigh_expected_maximum(1000),
        1.9259,
        3e-5,
        note="printed to five digits",
    ),
)
