"""Calibration and comparison: planted parameters inside stated errors, coverage counted, identities of the figures."""

import math

import numpy as np
import pytest
from scipy import stats

from moyai.core.errors import InputError
from moyai.records.calibration import Parameter, calibrate, profile
from moyai.records.comparison.model import agreement, agreement_by_state, overlay


def test_linear_problems_are_the_normal_equations():
    random = np.random.default_rng(0)
    for _ in range(5):
        design = random.normal(size=(40, 3))
        truth = random.normal(size=3) * 10.0 ** random.integers(-3, 4, 3)
        error = random.uniform(0.1, 2.0, 40)
        observed = design @ truth + error * random.normal(size=40)
        found = calibrate(lambda p, d=design: d @ p, observed, [Parameter(n, 1.0) for n in "abc"], error=error)
        weighted = design / error[:, None]
        exact = np.linalg.lstsq(weighted, observed / error, rcond=None)[0]
        np.testing.assert_allclose(found.values, exact, rtol=1e-5, atol=1e-6)
        np.testing.assert_allclose(found.covariance, np.linalg.inv(weighted.T @ weighted), rtol=1e-3)


@pytest.mark.slow
def test_errors_cover_the_truth_as_often_as_they_say():
    """Anchor law c sqrt(p) with 8 % scatter, 120 times: 95 % intervals hold the truth 90 to 99 times in 100."""
    random = np.random.default_rng(3)
    inside = 0
    for _ in range(120):
        speed = random.uniform(0.5, 5.0, 60)
        truth = 60.0
        observed = speed * math.sqrt(truth) * (1.0 + 0.08 * random.normal(size=60))
        found = calibrate(
            lambda p, u=speed: u * math.sqrt(p[0]),
            observed,
            [Parameter("product", 10.0, 1e-3, 1e4)],
            error=0.08 * speed * math.sqrt(truth),
        )
        inside += abs(found.values[0] - truth) < 1.96 * found.errors[0]
    assert 106 <= inside <= 119


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_bootstrap_leave_one_out_and_bounds(seed):
    random = np.random.default_rng(seed)
    x = np.linspace(0.1, 3.0, 90)
    groups = [f"storm {i % 9}" for i in range(90)]
    observed = 2.0 * x**1.5 + 0.1 * random.normal(size=90)
    names = [Parameter("scale", 1.0, 0.0, 10.0), Parameter("power", 1.0, 0.2, 4.0)]
    found = calibrate(lambda p: p[0] * x ** p[1], observed, names, groups=groups, bootstrap=60, seed=seed)
    assert found.values == pytest.approx([2.0, 1.5], abs=0.06)
    assert np.std(found.samples, axis=0) == pytest.approx(found.errors, rel=0.6)
    assert len(found.left_out) == 9 and sum(left.count for left in found.left_out) == 90
    for left in found.left_out:  # its own fit, done again by hand
        kept = np.array([group != left.group for group in groups])
        own = calibrate(lambda p, kept=kept: p[0] * x[kept] ** p[1], observed[kept], names)
        np.testing.assert_allclose(left.values, own.values, rtol=1e-4)
    held = calibrate(lambda p: p[0] * x ** p[1], observed, [names[0], Parameter("power", 1.2, 0.2, 1.3)])
    assert held.values[1] == pytest.approx(1.3) and held.notices[0].code == "parameter-bound"


def test_a_product_is_not_distinguished():
    """Only M times m_B is identifiable: the warning says so, the profile is flat, the product is still right."""
    random = np.random.default_rng(2)
    u = random.uniform(0.5, 5.0, 50)
    observed = u * math.sqrt(0.2 * 300.0) * (1.0 + 0.02 * random.normal(size=50))
    names = [Parameter("M", 0.5, 1e-3, 10.0), Parameter("m_B", 100.0, 1.0, 1e4)]

    def model(p):
        return u * math.sqrt(p[0] * p[1])

    found = calibrate(model, observed, names)
    assert found.values[0] * found.values[1] == pytest.approx(60.0, rel=0.03)
    assert found.notices[0].code == "identifiability" and "M" in found.notices[0].message
    flat = profile(model, observed, found, "M", [0.1, 0.2, 0.4])
    assert np.ptp(flat.squares) < 1e-3 * flat.squares.mean() and flat.interval == (-math.inf, math.inf)
    alone = calibrate(lambda p: u * math.sqrt(p[0]), observed, [Parameter("product", 10.0, 1e-3, 1e5)])
    assert not alone.notices
    sharp = profile(lambda p: u * math.sqrt(p[0]), observed, alone, "product", np.linspace(55.0, 65.0, 21))
    assert sharp.interval[0] < 60.0 < sharp.interval[1] and math.isfinite(sum(sharp.interval))
    useless = calibrate(lambda p: u * p[0] + 0.0 * p[1], observed, [Parameter("a", 1.0), Parameter("b", 1.0)])
    assert useless.condition == math.inf and not math.isfinite(useless.errors[1])


def test_calibration_faults():
    with pytest.raises(InputError, match="observations for"):
        calibrate(lambda p: [1.0], [1.0], [Parameter("a", 1.0), Parameter("b", 1.0)])
    with pytest.raises(InputError, match="predictions for"):
        calibrate(lambda p: [1.0], [1.0, 2.0], [Parameter("a", 1.0)])
    with pytest.raises(InputError, match="no number"):
        calibrate(lambda p: [math.nan, 1.0], [1.0, 2.0], [Parameter("a", 1.0)])
    with pytest.raises(InputError, match="first guess"):
        Parameter("a", 5.0, 0.0, 1.0)
    with pytest.raises(InputError, match="bounds"):
        Parameter("a", 5.0, 2.0, 1.0)


@pytest.mark.parametrize("seed", range(5))
def test_figures_of_agreement(seed):
    random = np.random.default_rng(seed)
    observed = random.normal(3.0, 1.0, 200)
    perfect = agreement(observed, observed)
    assert (perfect.bias, perfect.rms, perfect.skill, perfect.index_of_agreement) == (0.0, 0.0, 1.0, 1.0)
    assert perfect.slope == pytest.approx(1.0) and perfect.correlation == pytest.approx(1.0)
    model = 1.3 * observed
    found = agreement(model, observed)
    assert found.slope == pytest.approx(1.3)
    assert found.paper_error == pytest.approx(0.3 / 1.3) and found.paper_error_spread == pytest.approx(0.3 / 1.3)
    mean = agreement(np.full(200, observed.mean()), observed)
    assert mean.skill == pytest.approx(0.0, abs=1e-12)
    noisy = observed + random.normal(0.4, 0.2, 200)
    noisy[3] = np.nan
    some = agreement(noisy, observed)
    assert some.count == 199
    assert some.rms**2 == pytest.approx(some.bias**2 + np.nanvar(noisy - observed), rel=1e-9)
    shuffled = agreement(observed, noisy)
    assert shuffled.bias == pytest.approx(-some.bias) and shuffled.slope == pytest.approx(1.0 / some.slope)
    classes = agreement_by_state(noisy, observed, observed, [0.0, 3.0, 4.0, 90.0])
    assert sum(entry.count for entry in classes) == np.count_nonzero((observed >= 0.0) & np.isfinite(noisy))
    with pytest.raises(InputError, match="pairs"):
        agreement([math.nan, 1.0], [1.0, 1.0])


@pytest.mark.parametrize("lag", [0.0, 0.37, -1.2])
def test_overlay_finds_the_lag_and_keeps_gaps(lag):
    random = np.random.default_rng(1)
    time = np.arange(0.0, 300.0, 0.1)
    phase, omega = random.uniform(0, 6.28, 40), random.uniform(0.4, 1.6, 40)

    def wave(t):
        return np.cos(np.outer(t, omega) + phase).sum(axis=1)

    other = np.arange(20.0, 280.0, 0.17)
    observed = wave(other - lag)
    observed[100:150] = np.nan
    found = overlay(time, wave(time), other, observed, largest_lag=3.0)
    assert found.lag == pytest.approx(lag, abs=0.01)
    assert found.agreement.skill > 0.99
    assert np.isnan(found.observed).sum() == 50
    with pytest.raises(InputError, match="share no time"):
        overlay(time, wave(time), other + 1e4, observed)


def in_groups(rng, count, number, shift):
    """Return a function of two parameters, observations with a share of each group in common, and the groups."""
    x = rng.uniform(0.2, 1.5, count)
    of_group = np.arange(count) % number
    observed = 2.0 * x**1.8 * (1.0 + shift * rng.standard_normal(number)[of_group]) + 0.05 * rng.standard_normal(count)
    return (lambda p: p[0] * x ** p[1]), observed, [f"storm {n}" for n in of_group]


def test_errors_hold_what_observations_of_a_group_have_in_common():
    """Of 150 sets without a bootstrap, intervals of 95 %; independent observations would give 77 to 85 %."""
    rng = np.random.default_rng(4)
    names = [Parameter("a", 1.0, 0.1, 10.0), Parameter("b", 1.5, 0.5, 4.0)]
    held = np.zeros(2)
    for _ in range(150):
        model, observed, groups = in_groups(rng, 40, 10, 0.08)
        found = calibrate(model, observed, names, groups=groups)
        held += (found.interval[:, 0] <= (2.0, 1.8)) & (found.interval[:, 1] >= (2.0, 1.8))
    assert np.all(held >= 0.90 * 150)


def test_errors_of_groups_are_those_of_the_mean_of_their_means():
    """One constant: the fits that leave a group out give the scatter of equal groups' means exactly."""
    rng = np.random.default_rng(5)
    observed = 3.0 + np.repeat(rng.standard_normal(9), 4) + 0.1 * rng.standard_normal(36)
    groups = [f"g{n // 4}" for n in range(36)]
    found = calibrate(lambda p: np.full(36, p[0]), observed, [Parameter("mean", 1.0)], groups=groups)
    means = observed.reshape(9, 4).mean(axis=1)
    assert found.errors[0] == pytest.approx(stats.sem(means), rel=1e-5)
    reach = stats.t.ppf(0.975, 8) * stats.sem(means)
    assert found.interval[0] == pytest.approx([means.mean() - reach, means.mean() + reach], rel=1e-5)


def test_few_groups_that_differ_and_observations_without_scatter_are_noticed():
    rng = np.random.default_rng(6)
    names = [Parameter("a", 1.0, 0.1, 10.0), Parameter("b", 1.5, 0.5, 4.0)]
    codes = []
    for shift in (0.3, 0.0):
        model, observed, groups = in_groups(rng, 40, 5, shift)
        codes.append({notice.code for notice in calibrate(model, observed, names, groups=groups).notices})
    assert "calibration-groups" in codes[0] and "calibration-groups" not in codes[1]
    one = calibrate(lambda p: [p[0]], [2.0], [Parameter("a", 1.0)])
    assert {notice.code for notice in one.notices} == {"calibration-error"} and math.isnan(one.errors[0])
    known = calibrate(lambda p: [p[0]], [2.0], [Parameter("a", 1.0)], error=0.1)
    assert known.errors[0] == pytest.approx(0.1, rel=1e-6)
