"""Planted snaps found again: random sizes, rises, noise, drift, sampling rates."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.series.snap_record import read_snap, sampling_loss


def planted(seed, *, samples_in_rise, noise=0.0, drift=0.0, rise=None):
    """Two cables: held, slow rise, quarter sine, oscillation that dies out on the plateau, let loose at the end."""
    rng = np.random.default_rng([seed, 17])
    peak = 10.0 ** rng.uniform(0, 5)
    rise = 10.0 ** rng.uniform(-1.5, -0.3) if rise is None else rise
    known = {
        "peak": peak,
        "plateau": peak * rng.uniform(0.1, 0.6),
        "release": rng.uniform(1.5, 3.0),
        "rise": rise,
        "share": rng.uniform(0.4, 0.6),
    }
    slow = peak * rng.uniform(0.04, 0.1)
    known["taut"] = known["release"] + rng.uniform(1.0, 3.0)
    known["top"] = known["taut"] + rise
    end = known["top"] + 40.0 * rise + 2.0
    time = np.arange(0.0, end + 2.0, rise / samples_in_rise)
    turn = 0.5 * math.pi * (time - known["top"]) / rise
    tension = np.select(
        [time < known["release"], time < known["taut"], time < known["top"], time < end],
        [
            0.0 * time,
            slow * (time - known["release"]) / (known["taut"] - known["release"]),
            slow + (peak - slow) * np.cos(turn),
            known["plateau"] + (peak - known["plateau"]) * np.exp(-(time - known["top"]) / (3.0 * rise)) * np.cos(turn),
        ],
        0.0,
    )
    both = np.array([known["share"] * tension, (1.0 - known["share"]) * tension])
    both += rng.normal(0.0, 0.3 * peak, (2, 1)) + np.array([[drift * peak], [0.3 * drift * peak]]) * time / time[-1]
    both += noise * peak / math.sqrt(2.0) * rng.standard_normal(both.shape)
    known["unloaded"], known["window"] = [(0.0, 1.4), (end + 0.2, end + 1.9)], (0.0, end)
    return time, both, known


def read(time, both, known, **options):
    return read_snap(time, both, unloaded=known["unloaded"], window=known["window"], **options)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize(
    ("samples", "noise", "tolerance", "instant"),
    # peak, plateau and impact over the peak; taut instant over the rise
    [(10, 0.0, 0.004, 0.02), (60, 0.0, 0.001, 0.01), (60, 0.003, 0.012, 0.02), (200, 0.01, 0.02, 0.02)],
)
def test_planted_snap_is_found(seed, samples, noise, tolerance, instant):
    time, both, known = planted(seed, samples_in_rise=samples, noise=noise, drift=0.1)
    found = read(time, both, known)
    assert found.sum.peak == pytest.approx(known["peak"], rel=tolerance)
    assert found.sum.plateau == pytest.approx(known["plateau"], abs=tolerance * known["peak"])
    assert found.impact == pytest.approx(known["peak"] - known["plateau"], abs=1.5 * tolerance * known["peak"])
    assert found.taut_time == pytest.approx(known["taut"], abs=instant * known["rise"])
    assert found.rise_time == pytest.approx(known["rise"], rel=0.08)
    first, second = found.cables
    part = known["share"] * (known["peak"] - known["plateau"])
    assert first.impact == pytest.approx(part, abs=2.0 * tolerance * known["peak"])
    assert first.impact + second.impact == pytest.approx(found.impact, abs=2.0 * tolerance * known["peak"])
    assert found.peak_lag < 0.15 * known["rise"] + 2.0 * found.sampling_step
    if noise == 0.0:
        assert found.release_time == pytest.approx(known["release"], abs=0.02)
    assert known["top"] < found.plateau_start < known["window"][1]


@pytest.mark.parametrize("seed", range(4))
def test_drift_is_taken_off_and_reported(seed):
    time, both, known = planted(seed, samples_in_rise=60, drift=0.5)
    found = read(time, both, known)
    assert "snap-drift" in {item.code for item in found.notices}
    one = read_snap(time, both, unloaded=known["unloaded"][:1], window=known["window"])
    assert "snap-zero" in {item.code for item in one.notices}
    # without the second interval the drift passes for tension
    assert abs(one.sum.plateau - known["plateau"]) > 5.0 * abs(found.sum.plateau - known["plateau"])


@pytest.mark.parametrize("samples", [1.3, 2.0, 3.0, 4.5])
def test_slow_sampling_is_reported_with_what_it_costs(samples):
    losses = []
    for seed in range(30):
        time, both, known = planted(seed, samples_in_rise=samples)
        losses.append(1.0 - float(read_raw(time, both, known)) / known["peak"])
        if seed == 0:
            found = read(time, both, known)
            reported = {item.code: item for item in found.notices}
            assert "snap-sampling" in reported
            assert "Hz" in reported["snap-sampling"].remedy
    mean, worst = sampling_loss(samples)
    # after the top the tension falls a little slower than a sine
    assert min(losses) >= 0.0
    assert max(losses) < worst + 0.02
    assert np.mean(losses) == pytest.approx(mean, abs=0.5 * mean + 0.005)


def read_raw(time, both, known):
    """Largest sample above the known zero."""
    total = both.sum(axis=0)
    return total.max() - total[time < 1.4].mean()


def test_loss_of_sampling_by_trial():
    rng = np.random.default_rng(6)
    for samples in (1.5, 3.0, 8.0):
        offset = rng.uniform(-0.5, 0.5, 20000) / samples
        values = np.cos(0.5 * math.pi * offset)
        mean, worst = sampling_loss(samples)
        assert 1.0 - values.mean() == pytest.approx(mean, rel=0.03)
        assert 1.0 - values.min() == pytest.approx(worst, rel=1e-3)
    assert sampling_loss(5.0) == pytest.approx((0.0041, 0.0123), abs=1e-4)
    with pytest.raises(InputError):
        sampling_loss(0.0)


def test_one_cable_names_and_trigger():
    time, both, known = planted(2, samples_in_rise=60)
    found = read(time, both[0], known, names=["upper"], release_time=known["release"])
    assert found.release_time == known["release"]
    assert found.cables[0].name == "upper"
    assert found.cables[0].impact == pytest.approx(found.impact)
    assert found.sum.peak == pytest.approx(known["share"] * known["peak"], rel=1e-3)


def test_record_that_stops_early_is_reported():
    time, both, known = planted(3, samples_in_rise=60)
    stop = known["top"] + 6.0 * known["rise"]
    short = read_snap(time, both, unloaded=known["unloaded"], window=(0.0, stop))
    assert {"snap-plateau", "snap-short"} & {item.code for item in short.notices}


def test_noise_hides_the_release_not_the_peak():
    time, both, known = planted(4, samples_in_rise=100, noise=0.06)
    found = read(time, both, known)
    assert math.isnan(found.release_time)
    assert {"snap-noise", "snap-release"} <= {item.code for item in found.notices}
    assert found.sum.peak == pytest.approx(known["peak"], rel=0.06)


@pytest.mark.parametrize(
    ("spoil", "word"),
    [
        (lambda t, b, k: (t, b, {**k, "unloaded": []}), "zero level"),
        (lambda t, b, k: (t, b, {**k, "unloaded": [(900.0, 901.0)]}), "samples"),
        (lambda t, b, k: (t, -b + 2.0 * b[:, :1], k), "noise|sign"),
        (lambda t, b, k: (t, 0.0 * b + np.sin(1e3 * t), k), "noise"),
        (lambda t, b, k: (t**1.01, b, k), "uniform"),
        (lambda t, b, k: (t, np.where(t > 1.0, np.nan, b), k), "no number"),
        (lambda t, b, k: (t[:5], b[:, :5], k), "at least 20"),
        (lambda t, b, k: (t, b, {**k, "window": (0.0, k["top"])}), "end of the record"),
        (lambda t, b, k: (t, b, {**k, "window": (0.0, 0.01)}), "window"),
    ],
)
def test_bad_records_are_refused(spoil, word):
    with pytest.raises(InputError, match=word):
        read(*spoil(*planted(5, samples_in_rise=60)))
    time, both, known = planted(5, samples_in_rise=60)
    with pytest.raises(InputError, match="names"):
        read(time, both, known, names=["upper"])


@pytest.mark.parametrize("drift", [0.0, 0.05])
def test_the_error_of_the_plateau_holds_that_of_the_zero(drift):
    """White noise: medians of plateau and of the unloaded blocks, the line of the drift led on to the plateau."""
    rng = np.random.default_rng(5)
    time = np.arange(0.0, 23.0, 0.005)
    clean = np.where(time < 2.0, 0.0, 5.0 + 15.0 * np.exp(-np.abs(time - 4.0) / 0.3))
    clean[(time > 21.5)] = 0.0
    first, second = (time <= 1.9), (time >= 22.0)
    quiet = [(0.0, 1.9), (22.0, 22.995)] if drift else [(0.0, 1.9)]
    stated, found = [], []
    for _ in range(60):
        record = clean + 0.7 + drift * time + 0.2 * rng.standard_normal(time.size)
        snap = read_snap(time, record, unloaded=quiet, window=(1.0, 21.0))
        stated.append(snap.sum.plateau_error)
        found.append(snap.sum.plateau - 5.0)
    used = time[first | second] if drift else time[first]
    middle = 0.5 * (12.5 + 21.0)
    zero = 1.0 / used.size
    if drift:
        zero += (middle - used.mean()) ** 2 / np.sum((used - used.mean()) ** 2)
    # a median scatters by pi/2 more than a mean
    exact = 0.2 * math.sqrt(0.5 * math.pi * (zero + 1.0 / 1700.0))
    assert math.sqrt(np.mean(np.square(stated))) == pytest.approx(exact, rel=0.15)
    assert np.mean(np.abs(found) <= 2.0 * np.array(stated)) > 0.85


@pytest.mark.parametrize("share", [0.5, 0.9])
def test_a_saturated_load_cell_is_reported(share):
    time, both, known = planted(3, samples_in_rise=200)
    assert "snap-saturated" not in [notice.code for notice in read(time, both, known).notices]
    level = np.median(both[0]) + share * (both[0].max() - np.median(both[0]))
    both[0] = np.minimum(both[0], level)
    found = next(notice for notice in read(time, both, known).notices if notice.code == "snap-saturated")
    assert found.value == np.count_nonzero(both[0] == level) or share == 0.5
    assert f"stand at the highest value, {level:.4g} N" in found.message
