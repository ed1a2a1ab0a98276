"""Directional spectra and transfer functions: seas synthesised by another room come back from their sensors."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.records.reading.sensors import Sensor, surface_elevation
from moyai.records.survey.directional import directional_spectrum, fourier_directions
from moyai.sea.directional import CosineTwoS
from moyai.sea.irregular import synthesise
from moyai.sea.spectra import jonswap
from moyai.sea.water import Water
from moyai.series.spectra import WelchOptions, cross_spectra

STEP = 0.5
TIME = np.arange(14400) * STEP
WATER = Water(depth=12.0, density=1025.0, gravity=9.81)


def sea_of(seed, heading, exponent, height=2.0, period=7.0):
    return synthesise(
        jonswap(height, period, 3.3), WATER, duration=7200.0, seed=seed, heading=heading,
        spreading=CosineTwoS(exponent), time_step=STEP,
    )  # fmt: skip


def seen(sea, sensor):
    """The sensor's record by the kinematics of the sea itself."""
    kind = sensor.quantity
    if kind == "elevation":
        return sea.elevation(TIME, sensor.x, sensor.y)
    if kind == "pressure":
        return sea.dynamic_pressure(TIME, sensor.x, sensor.y, sensor.z)
    if kind.startswith("velocity"):
        return sea.velocity(TIME, sensor.x, sensor.y, sensor.z)[..., "xyz".index(kind[-1])]
    amplitude = {"displacement": 1j / np.tanh(sea.wave_number * WATER.depth), "slope": 1j * sea.wave_number}
    turn = np.cos(sea.heading) if kind.endswith("x") else np.sin(sea.heading)
    return sea.respond(amplitude[kind.split("_")[0]] * turn, TIME)


def spectra_of(sea, sensors):
    return cross_spectra(STEP, np.column_stack([seen(sea, sensor) for sensor in sensors]), WelchOptions(segment=128.0))


PUV = (Sensor("pressure", z=-10.0), Sensor("velocity_x", z=-10.0), Sensor("velocity_y", z=-10.0))
BUOY = (Sensor("elevation"), Sensor("displacement_x"), Sensor("displacement_y"))
SLOPES = (Sensor("elevation"), Sensor("slope_x"), Sensor("slope_y"))
STAR = tuple(
    Sensor("elevation", x=9.0 * math.cos(a), y=9.0 * math.sin(a)) for a in np.radians([0.0, 72.0, 144.0, 216.0, 288.0])
)


@pytest.mark.slow
@pytest.mark.parametrize("sensors", [PUV, BUOY, SLOPES, STAR], ids=["puv", "buoy", "slopes", "array"])
@pytest.mark.parametrize("seed", range(3))
def test_random_seas_come_back(sensors, seed):
    random = np.random.default_rng(10 * seed + len(sensors))
    heading, exponent = random.uniform(-math.pi, math.pi), random.choice([4.0, 10.0, 30.0])
    sea = sea_of(seed, heading, exponent)
    spectra = spectra_of(sea, sensors)
    found = directional_spectrum(spectra, sensors, WATER, lowest=0.09, highest=0.25)
    figures = found.figures()
    truth = math.sqrt(2.0 / (exponent + 1.0))
    assert abs(math.remainder(figures["mean_heading"] - heading, 2.0 * math.pi)) < math.radians(4.0)
    assert figures["spread"] == pytest.approx(truth, abs=math.radians(5.0))
    inside = (sea.omega > 2 * math.pi * 0.088) & (sea.omega < 2 * math.pi * 0.252)
    energy = 4.0 * math.sqrt(0.5 * np.sum(sea.amplitude[inside] ** 2))
    assert figures["spectral_height"] == pytest.approx(energy, rel=0.06)
    assert not found.notices
    if len(sensors) == 3:
        quick = fourier_directions(spectra, sensors, WATER).figures(0.09, 0.25)
        assert abs(math.remainder(quick["mean_heading"] - heading, 2.0 * math.pi)) < math.radians(3.0)
        assert quick["spread"] == pytest.approx(truth, abs=math.radians(3.5))


def test_two_crossing_seas_are_distinguished():
    """An array sees both; the mean heading alone would lie between them."""
    one, two = sea_of(1, 0.0, 40.0), sea_of(2, 2.0, 40.0, height=1.6)
    records = np.column_stack([seen(one, sensor) + seen(two, sensor) for sensor in STAR])
    found = directional_spectrum(
        cross_spectra(STEP, records, WelchOptions(segment=128.0)), STAR, WATER, lowest=0.11, highest=0.2
    )
    whole = found.density.sum(axis=0)
    tops = [i for i in range(len(whole)) if whole[i] > whole[i - 1] and whole[i] > whole[(i + 1) % len(whole)]]
    tops = sorted(sorted(tops, key=lambda i: -whole[i])[:2], key=lambda i: found.heading[i])
    assert found.heading[tops] == pytest.approx([0.0, 2.0], abs=math.radians(8.0))


def test_a_wrong_sign_is_reported():
    sea = sea_of(3, 0.6, 10.0)
    records = np.column_stack([seen(sea, sensor) for sensor in PUV])
    records[:, 2] *= 4.0
    found = directional_spectrum(
        cross_spectra(STEP, records, WelchOptions(segment=64.0)), PUV, WATER, lowest=0.1, highest=0.2
    )
    assert found.notices[0].code == "directional-misfit"


@pytest.mark.parametrize("quantity", ["pressure", "velocity_z"])
@pytest.mark.parametrize("z", [-3.0, -8.0])
def test_surface_from_below(quantity, z):
    sea = sea_of(5, 0.3, 10.0)
    sensor = Sensor(quantity, z=z)
    found = surface_elevation(STEP, seen(sea, sensor), sensor, WATER, lowest=0.05, highest=0.22)
    frequency = np.fft.rfftfreq(TIME.size, STEP)
    band = np.fft.rfft(sea.elevation(TIME))
    band[(frequency < 0.05) | (frequency > 0.22)] = 0.0
    truth = np.fft.irfft(band)
    inner = slice(200, -200)
    assert np.std(found.elevation[inner] - truth[inner]) < 0.01 * truth.std()


def test_a_drift_of_the_sensor_is_no_wave():
    """A straight line under the record, ten times as high as its waves, changes nothing."""
    sensor = Sensor("pressure", z=-6.0)
    record = seen(sea_of(6, 0.3, 10.0), sensor)
    drift = 10.0 * record.std() * np.linspace(-1.0, 1.0, record.size)
    limits = {"lowest": 0.05, "highest": 0.22}
    still, drifting = (surface_elevation(STEP, values, sensor, WATER, **limits) for values in (record, record + drift))
    assert np.allclose(drifting.elevation, still.elevation, atol=1e-9 * still.elevation.std())


def test_limits_and_faults():
    sea = sea_of(5, 0.3, 10.0)
    deep = Sensor("pressure", z=-11.0)
    record = seen(sea, deep)
    found = surface_elevation(STEP, record, deep, WATER, lowest=0.05, highest=0.45)
    assert found.highest < 0.3 and found.notices[0].code == "depth-attenuation"
    with pytest.raises(InputError, match="heading"):
        surface_elevation(STEP, record, Sensor("velocity_x"), WATER, lowest=0.05, highest=0.3)
    with pytest.raises(InputError, match="the bed"):
        surface_elevation(STEP, record, Sensor("pressure", z=-13.0), WATER, lowest=0.05, highest=0.3)
    three = np.column_stack([record] * 3)
    spectra = cross_spectra(STEP, three, WelchOptions(segment=128.0))
    with pytest.raises(InputError, match="cannot resolve directions"):
        directional_spectrum(spectra, (deep, deep, deep), WATER, lowest=0.1, highest=0.2)
    with pytest.raises(InputError, match="no triplet"):
        fourier_directions(spectra, (deep, deep, deep), WATER)
    with pytest.raises(InputError, match="three or more"):
        directional_spectrum(spectra, (deep, deep), WATER, lowest=0.1, highest=0.2)
