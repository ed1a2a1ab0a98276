"""Currents: vector means, profiles and tidal ellipses that were planted."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.records.survey.currents import (
    block_means,
    components,
    heading_of_bearing,
    mean_profile,
    principal_axis,
)
from moyai.records.survey.tides import CONSTITUENTS, fit_tide


@pytest.mark.parametrize("seed", range(4))
def test_block_means_against_a_loop(seed):
    random = np.random.default_rng(seed)
    time = 1e9 + np.cumsum(random.uniform(0.1, 5.0, 3000))
    x, y = random.normal(size=3000), random.normal(size=3000) + 0.3
    x[random.random(3000) < 0.1] = np.nan
    found = block_means(time, x, y, length=300.0, origin=1e9, least=5)
    heading = random.uniform(-3.0, 3.0)
    for i, start in enumerate(found.start):
        chosen = (time >= start) & (time < start + 300.0) & np.isfinite(x)
        if chosen.sum() >= 5:
            assert found.x[i] == pytest.approx(x[chosen].mean(), abs=1e-12)
            normal = np.mean(x[chosen] * math.cos(heading) + y[chosen] * math.sin(heading))
            assert found.normal(heading)[i] == pytest.approx(normal, abs=1e-12)
            spread = math.sqrt(np.mean((x[chosen] - x[chosen].mean()) ** 2 + (y[chosen] - y[chosen].mean()) ** 2))
            assert found.deviation[i] == pytest.approx(spread, rel=1e-9)
        else:
            assert math.isnan(found.x[i])


def test_bearings():
    """Waves from the south-west, +x towards 240 degrees: they travel towards 45, that is 195 to the left of +x."""
    heading = heading_of_bearing(math.radians(225.0), math.radians(240.0), coming_from=True)
    assert math.degrees(heading) % 360.0 == pytest.approx(195.0)
    towards = heading_of_bearing(math.radians(240.0), math.radians(240.0), coming_from=False)
    assert towards == pytest.approx(0.0, abs=1e-12)
    x, y = components(2.0, math.radians(30.0))
    assert (x, y) == pytest.approx((math.sqrt(3.0), 1.0))


@pytest.mark.parametrize("seed", range(6))
def test_planted_ellipses(seed):
    """M2, S2 and O1 with random ellipses, gaps and noise over 40 days."""
    random = np.random.default_rng(seed)
    time = 1.5e9 + np.arange(0.0, 40 * 86400.0, 600.0)
    time = time[random.random(time.size) > 0.3]
    w = 0.05 + 0.02j + np.zeros(time.size, complex)
    truth = {}
    for name in ("M2", "S2", "O1"):
        major = random.uniform(0.2, 1.0)
        minor, heading, phase = random.uniform(-0.8, 0.8) * major, random.uniform(-1.5, 1.5), random.uniform(-3.0, 3.0)
        angle = math.radians(CONSTITUENTS[name]) / 3600.0 * (time - 1.5e9) - phase
        w += np.exp(1j * heading) * (major * np.cos(angle) + 1j * minor * np.sin(angle))
        truth[name] = (major, minor, heading)
    noise = 0.05
    x, y = w.real + noise * random.normal(size=time.size), w.imag + noise * random.normal(size=time.size)
    x[7] = np.nan
    fit = fit_tide(time, x, y)
    assert fit.mean == pytest.approx((0.05, 0.02), abs=5e-3)
    expected_error = noise * math.sqrt(2.0 / time.size)
    for ellipse in fit.ellipses:
        if ellipse.name in truth:
            major, minor, heading = truth[ellipse.name]
            assert ellipse.major == pytest.approx(major, abs=0.01)
            assert ellipse.minor == pytest.approx(minor, abs=0.01)
            assert abs(math.remainder(ellipse.heading - heading, math.pi)) < 0.08
            assert ellipse.error == pytest.approx(expected_error, rel=0.9)
        else:
            assert ellipse.major < 0.02
    px, py = fit.predict(time)
    assert np.nanstd(px - w.real) < 0.01 and np.nanstd(py - w.imag) < 0.01
    assert "K2" in fit.left_out  # needs half a year next to S2


def test_phase_of_an_ellipse_is_its_largest_current():
    time = np.arange(0.0, 30 * 86400.0, 900.0)
    angle = math.radians(CONSTITUENTS["M2"]) / 3600.0 * time - 1.1
    w = np.exp(0.4j) * (0.7 * np.cos(angle) - 0.3j * np.sin(angle))
    fit = fit_tide(time, w.real, w.imag, names=["M2"])
    ellipse = fit.ellipses[0]
    instant = fit.reference + ellipse.phase / (2.0 * math.pi) * ellipse.period
    x, y = fit.predict(np.array([instant]))
    assert math.hypot(x[0], y[0]) == pytest.approx(0.7, rel=1e-6)
    assert x[0] * math.cos(ellipse.heading) + y[0] * math.sin(ellipse.heading) == pytest.approx(0.7, rel=1e-6)
    assert ellipse.minor == pytest.approx(-0.3, rel=1e-6)
    level = fit_tide(time, 0.8 * np.cos(angle), names=["M2"])
    assert level.ellipses[0].major == pytest.approx(0.8, rel=1e-9)
    assert level.explained == pytest.approx(1.0)


@pytest.mark.parametrize("seed", range(4))
def test_profile_and_power_law(seed):
    random = np.random.default_rng(seed)
    exponent, heading = random.uniform(0.08, 0.3), random.uniform(-3.0, 3.0)
    z = np.arange(0.75, 16.0, 0.5)
    speed = 0.6 * (z / 12.0) ** exponent
    x = speed[:, None] * math.cos(heading) + 0.02 * random.normal(size=(z.size, 200))
    y = speed[:, None] * math.sin(heading) + 0.02 * random.normal(size=(z.size, 200))
    x[z > 12.0] += 3.0  # what the instrument reports above the surface
    x[4, :150] = np.nan
    found = mean_profile(z, x, y, top=12.0)
    assert found.exponent == pytest.approx(exponent, abs=max(4.0 * found.exponent_error, 2e-3))
    assert found.surface_speed == pytest.approx(0.6, rel=0.01)
    assert math.isnan(found.x[4]) and np.isnan(found.x[z > 12.0]).all()


def test_principal_axis_and_faults():
    random = np.random.default_rng(0)
    along, across = 0.5 * random.normal(size=20000), 0.1 * random.normal(size=20000)
    w = (along + 1j * across) * np.exp(1j * 1.2)
    axis = principal_axis(w.real, w.imag)
    assert axis.heading == pytest.approx(1.2, abs=0.01)
    assert (axis.major, axis.minor) == pytest.approx((0.5, 0.1), rel=0.03)
    with pytest.raises(InputError, match="unknown constituent"):
        fit_tide(np.arange(100.0), np.arange(100.0), names=["M22"])
    with pytest.raises(InputError, match="no constituent"):
        fit_tide(np.arange(100.0), np.arange(100.0))
    with pytest.raises(InputError, match="bin"):
        mean_profile([1.0, 2.0], np.full((2, 4), np.nan), np.full((2, 4), np.nan), top=5.0)


def planted_tide(hours):
    return sum(a * np.cos(np.radians(CONSTITUENTS[name]) * hours - p) for name, a, p in PLANTED)


PLANTED = (("M2", 1.0, 0.3), ("S2", 0.4, 1.0))
SAMPLINGS = {
    "even": np.arange(30 * 24.0),
    "two days a month apart": np.concatenate([np.arange(24.0), np.arange(28 * 24.0, 29 * 24.0)]),
    "three days and one sample": np.append(np.arange(72.0), 720.0),
    "daylight": np.array([24.0 * day + hour for day in range(30) for hour in range(8, 18)]),
}


@pytest.mark.parametrize("current", [False, True])
@pytest.mark.parametrize("case", SAMPLINGS)
def test_the_error_of_a_constituent_covers_the_truth(case, current):
    """Monte Carlo: the standard error is the scatter over records, and 1.96 of it hold the truth in 90 to 98 %."""
    hours, rng = SAMPLINGS[case], np.random.default_rng(5)
    found, stated = [], []
    for _ in range(300):
        level = planted_tide(hours) + 0.05 * rng.standard_normal(hours.size)
        across = 0.05 * rng.standard_normal(hours.size) if current else None
        fit = fit_tide(3600.0 * hours, level, across, names=["M2", "S2"])
        assert [ellipse.name for ellipse in fit.ellipses] == ["M2", "S2"]
        found.append([ellipse.major for ellipse in fit.ellipses])
        stated.append([ellipse.error for ellipse in fit.ellipses])
    np.testing.assert_allclose(np.sqrt(np.mean(np.square(stated), axis=0)), np.std(found, axis=0), rtol=0.12)
    covered = np.mean(np.abs(np.array(found) - [1.0, 0.4]) < 1.96 * np.array(stated), axis=0)
    assert (covered > 0.90).all() and (covered < 0.985).all()
    if case == "even":  # sigma sqrt(2/n) in white noise without gaps, of a level as of a current
        np.testing.assert_allclose(np.mean(stated, axis=0), 0.05 * np.sqrt(2.0 / hours.size), rtol=0.03)
    gaps = [notice for notice in fit.notices if notice.code == "tide-gaps"]
    assert bool(gaps) == (case in ("two days a month apart", "three days and one sample"))


def test_constituents_that_the_sampling_folds_together_are_left_out():
    # every 12 h S2 stands still; 12.5 h is so near to M2 that it turns once in 81 days
    hours = 12.0 * np.arange(60.0)
    fit = fit_tide(3600.0 * hours, planted_tide(hours), names=["M2", "S2"])
    assert fit.left_out == ("S2",) and [notice.code for notice in fit.notices] == ["tide-sampling"]
    assert "the 12 h between samples" in fit.notices[0].message
    assert fit.ellipses[0].major == pytest.approx(1.0, rel=1e-6)
    hours = 12.5 * np.arange(40.0)
    with pytest.raises(InputError, match="make M2 look like larger neighbours or like the mean"):
        fit_tide(3600.0 * hours, planted_tide(hours), names=["M2"])


def test_a_gauge_that_stands_still_has_no_tide():
    with pytest.raises(InputError, match="all 100 samples are 1"):
        fit_tide(np.arange(100.0) * 3600.0, np.ones(100), names=["M2"])
