"""Validation of the analysis of records on synthetic records with known content."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.validation import ValidationCase
from moyai.records.calibration import Parameter, calibrate
from moyai.records.reading.sensors import Sensor
from moyai.records.survey.directional import fourier_directions
from moyai.records.survey.motions import rigid_motion
from moyai.records.survey.reflection import separate_waves
from moyai.records.survey.tides import CONSTITUENTS, fit_tide
from moyai.sea.water import Water
from moyai.series.detrend import Detrend, slow_response
from moyai.series.harmonics import fit_harmonics
from moyai.series.spectra import WelchOptions, cross_spectra, spectrum_of
from moyai.series.wave_statistics import fit_weibull
from moyai.series.zero_crossing import WaveOptions, find_waves


def _three_gauges() -> complex:
    """Return the reflection coefficient of a planted pair of waves at gauges 4.95, 5.20 and 5.50 m from the paddle."""
    k, reflection = 2.76, 0.62 * np.exp(0.9j)
    x = np.array([4.95, 5.20, 5.50]) - 7.0
    gauges = 0.012 * (np.exp(1j * k * x) + reflection * np.exp(-1j * k * x))
    return complex(separate_waves(x, gauges, k).reflection_coefficient[0])


def _whole_periods() -> float:
    """Return the first harmonic of a record whose period is no multiple of its step, with mean and second harmonic."""
    period = 1.158
    omega = 2.0 * math.pi / period
    time = 1234.5 + np.arange(2000) * 0.005
    values = 0.3 + 2.5 * np.cos(omega * time - 0.4) + 0.7 * np.cos(2.0 * omega * time + 1.0)
    return float(np.abs(fit_harmonics(time, values, omega, count=2).first))


def _hundred_waves(figure: str) -> float:
    """Return a figure of a hundred whole sine waves of height 1 to 100 cm in random order."""
    heights = np.random.default_rng(0).permutation(np.arange(1, 101)) / 100.0
    cycle = np.arange(64) / 64.0 + 1e-6
    values = np.concatenate([[-1e-3], *[0.5 * h * np.sin(2.0 * math.pi * cycle) for h in heights], [1e-3]])
    options = WaveOptions(detrend=Detrend("none"), crest="sample")
    return find_waves(np.arange(values.size) / 8.0, values, options).statistics()[figure]


def _two_lines(figure: str) -> float:
    """Return a figure of the spectrum of two cosines on lines of the transform."""
    time = np.arange(1000) * 0.1
    values = 2.0 * np.cos(2.0 * math.pi * 0.1 * time) + np.cos(2.0 * math.pi * 0.25 * time + 0.3)
    return spectrum_of(0.1, values, WelchOptions(window="rectangular", detrend="none")).figures()[figure]


def _heading() -> float:
    """Return the heading [deg] of long-crested waves seen by a pressure gauge with a current meter."""
    water, heading = Water(depth=12.0, density=1025.0, gravity=9.81), 0.7
    time = np.arange(4096) * 0.5
    omega = 2.0 * math.pi * np.array([0.1, 0.125, 0.15])
    sensors = (Sensor("pressure", z=-10.0), Sensor("velocity_x", z=-10.0), Sensor("velocity_y", z=-10.0))
    from moyai.sea.dispersion import wave_number

    k = np.asarray(wave_number(omega, water.depth, water.gravity))
    turn = np.exp(-1j * np.outer(time, omega)) * np.array([1.0, 0.7j, 0.4])
    seen = [(turn @ sensor.response(omega, k, np.array([heading]), water)[:, 0]).real for sensor in sensors]
    found = fourier_directions(cross_spectra(0.5, np.column_stack(seen), WelchOptions(segment=256.0)), sensors, water)
    return math.degrees(found.figures(0.08, 0.17)["mean_heading"])


def _ellipse() -> float:
    """Return the semi-minor axis of a planted clockwise M2 ellipse."""
    time = np.arange(0.0, 30 * 86400.0, 900.0)
    angle = math.radians(CONSTITUENTS["M2"]) / 3600.0 * time - 1.1
    w = np.exp(0.4j) * (0.7 * np.cos(angle) - 0.3j * np.sin(angle))
    return fit_tide(time, w.real, w.imag, names=["M2"]).ellipses[0].minor


def _roll() -> float:
    """Return the roll [rad] of four markers turned by 0.35 rad about another point."""
    reference = np.array([[-0.2, 0.0], [0.2, 0.05], [0.1, 0.3], [-0.15, 0.2]])
    c, s = math.cos(0.35), math.sin(0.35)
    moved = np.column_stack([c * reference[:, 0] + s * reference[:, 1], -s * reference[:, 0] + c * reference[:, 1]])
    return float(rigid_motion(moved[None], reference, centre=(0.0, 0.1)).roll[0])


def _weibull() -> float:
    """Return the shape fitted to exact quantiles of a Weibull distribution of shape 1.7."""
    share = (np.arange(20_000) + 0.5) / 20_000
    return fit_weibull(2.0 * (-np.log(share)) ** (1.0 / 1.7)).shape


def _product() -> float:
    """Return a planted M m_B [kg] out of 1200 tensions with 15 % scatter and known errors."""
    random = np.random.default_rng(4)
    speed = random.uniform(0.5, 5.0, 1200)
    law = np.sqrt(103.6 * 890e3) * speed
    observed = law * (1.0 + 0.15 * random.normal(size=1200))
    names = [Parameter("M m_B", 50.0, 1.0, 5000.0)]
    return float(calibrate(lambda p: np.sqrt(p[0] * 890e3) * speed, observed, names, error=0.15 * law).values[0])


_LINES = "two cosines on lines of the transform: moments by hand"

CASES: tuple[ValidationCase, ...] = (
    ValidationCase("records: H1/3 of a hundred known waves [m]", "mean of 68 to 100 cm by hand",
                   lambda: _hundred_waves("third_height"), 0.84, 1e-4, note="crests fall between samples"),
    ValidationCase("records: H1/10 of a hundred known waves [m]", "mean of 91 to 100 cm by hand",
                   lambda: _hundred_waves("tenth_height"), 0.955, 1e-4, note="crests fall between samples"),
    ValidationCase("records: spectral height of two cosines [m]", _LINES, lambda: _two_lines("spectral_height"),
                   4.0 * math.sqrt(2.5), 1e-9, note="rounding"),
    ValidationCase("records: Tm02 of two cosines [s]", _LINES, lambda: _two_lines("period_m02"),
                   math.sqrt(2.5 / (2.0 * 0.01 + 0.5 * 0.0625)), 1e-9, note="rounding"),
    ValidationCase("records: response of the slow part at its cut-off", "stated: one half",
                   lambda: float(slow_response(1.0)[0]), 0.5, 1e-9, note="rounding"),
    ValidationCase("records: heading from pressure and velocities [deg]", "planted long-crested waves",
                   _heading, math.degrees(0.7), 2e-3, note="taper over 256 s"),
    ValidationCase("records: minor axis of a tidal ellipse [m/s]", "planted ellipse, turning clockwise", _ellipse,
                   -0.3, 1e-6, note="rounding"),
    ValidationCase("records: roll of four markers [rad]", "planted rotation", _roll, 0.35, 1e-12, note="rounding"),
    ValidationCase("records: Weibull shape", "exact quantiles", _weibull, 1.7, 2e-3, note="20000 quantiles"),
    ValidationCase("records: M m_B out of scattered tensions [kg]", "planted, 15 % scatter", _product, 103.6, 0.02,
                   note="two standard errors of 1200 observations"),
    ValidationCase(
        name="records: reflection from three gauges",
        source="planted waves; Mansard and Funke (1980)",
        compute=lambda: abs(_three_gauges()),
        reference=0.62,
        tolerance=1e-10,
        note="rounding",
    ),
    ValidationCase(
        name="records: phase of the reflection from three gauges",
        source="planted waves; Mansard and Funke (1980)",
        compute=lambda: float(np.angle(_three_gauges())),
        reference=0.9,
        tolerance=1e-10,
        note="rounding",
    ),
    ValidationCase(
        name="records: first harmonic over whole periods",
        source="planted harmonics",
        compute=_whole_periods,
        reference=2.5,
        tolerance=1e-9,
        note="rounding of the phase at a clock of 1234 s",
    ),
)  # fmt: skip
