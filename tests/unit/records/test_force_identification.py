"""Identification of C_M and C_D: exact on clean records, honest on noisy ones, one message for each bad record."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats
from scipy.signal import butter, sosfiltfilt

from moyai.core.errors import InputError
from moyai.records.forces.fit import _bootstrap, _gain, _shares, fit_component
from moyai.records.forces.identification import METHODS, ForceRecord, Setup, identify
from moyai.records.forces.motion import irregular_motion
from moyai.records.forces.record import NoiseCut, acceleration_of, without_noise
from moyai.records.forces.result import identification_result
from moyai.records.forces.waves import orbital_motion
from moyai.sea.components import WaveComponents
from moyai.sea.dispersion import wave_number
from moyai.sea.irregular import synthesise
from moyai.sea.spectra import jonswap
from moyai.sea.water import Water

DIAMETER = 0.045
AREA = math.pi * DIAMETER**2 / 4.0


def synthetic(
    rng, *, inertia=1.7, drag=1.3, number=1.5, period=1.05, per_period=60.0, periods=10.0, noise=0.0, colour=0.0,
    harmonics=0.0, start=0.0,
):  # fmt: skip
    """Return a record and its set-up: planar harmonic flow, noise and harmonics as shares of the inertia force."""
    omega, step = 2.0 * math.pi / period, period / per_period
    time = start + step * np.arange(round(per_period * periods))
    peak, lag = number * DIAMETER / period, rng.uniform(0, 2 * math.pi)
    velocity = peak * np.cos(omega * time - lag)
    rate = -peak * omega * np.sin(omega * time - lag)
    force = 1000.0 * AREA * inertia * rate + 500.0 * DIAMETER * drag * velocity * np.abs(velocity)
    error = rng.standard_normal(time.size)
    for n in range(1, time.size if colour else 0):
        error[n] = colour * error[n - 1] + math.sqrt(1.0 - colour**2) * error[n]
    size = 1000.0 * AREA * inertia * peak * omega
    phases = rng.uniform(0, 2 * math.pi, 2)
    together = np.cos(2 * omega * time + phases[0]) + 0.5 * np.cos(3 * omega * time + phases[1])
    record = ForceRecord(time, force + size * (noise * error + harmonics * together), velocity)
    return record, Setup(1000.0, AREA, (DIAMETER,), period=period, bootstrap=100)


def test_the_spread_of_a_bootstrap_is_that_of_the_shares_of_its_blocks():
    rng = np.random.default_rng(11)
    gain, residual = rng.normal(size=(2, 40)), rng.normal(size=40)
    blocks = [(0, 10), (10, 20), (20, 30), (30, 40)]
    shares = np.array([gain[:, a:b] @ residual[a:b] for a, b in blocks])
    setup = Setup(1000.0, AREA, (DIAMETER,), bootstrap=4000)
    alike = np.full((4, 2), 0.25)
    samples, covariance = _bootstrap(_shares(gain, residual, blocks), alike, np.zeros(2), setup, rng)
    # the sum of four shares, each with the variance of a sample of four
    assert covariance == pytest.approx(4.0 * np.cov(shares.T), rel=1e-12)
    assert np.cov(samples.T) == pytest.approx(covariance, rel=0.1, abs=0.1 * covariance.max())


@pytest.mark.parametrize("seed", range(6))
def test_clean_records_give_the_coefficients_to_nine_digits(seed):
    """Any coefficients, KC, sampling and start of the clock, by every method, period given or found."""
    rng = np.random.default_rng(seed)
    inertia, drag = rng.uniform(0.3, 3.0), rng.uniform(0.3, 3.0)
    record, setup = synthetic(
        rng, inertia=inertia, drag=drag, number=rng.uniform(0.5, 25), per_period=rng.uniform(20, 200),
        periods=rng.uniform(2.1, 9), start=rng.uniform(0, 1e4), period=rng.uniform(0.5, 12),
    )  # fmt: skip
    found = identify(record, setup)
    for method in METHODS:
        fit = found.fit(method)
        assert fit.inertia.value == pytest.approx(inertia, rel=1e-9), method
        assert fit.drag.value == pytest.approx(drag, rel=1e-9), method
        assert fit.explained > 1.0 - 1e-9
    free = identify(record, replace(setup, period=None, methods=("least_squares",)))
    assert free.period == pytest.approx(setup.period, rel=1e-6)


@pytest.mark.parametrize("seed", range(3))
def test_irregular_and_two_component_records(seed):
    """Many frequencies, vector drag, given accelerations: linear in the record, so exact."""
    rng = np.random.default_rng(seed)
    time = 0.1 * np.arange(3000)
    omega, size = rng.uniform(0.5, 1.6, 25), rng.uniform(0.05, 0.2, 25)
    phase = omega * time[:, None] + rng.uniform(0, 6.28, 25)
    velocity = np.column_stack([np.cos(phase) @ size, -np.sin(phase) @ (0.8 * size)])
    rate = np.column_stack([-np.sin(phase) @ (omega * size), -np.cos(phase) @ (0.8 * omega * size)])
    speed = np.linalg.norm(velocity, axis=1)
    inertia, drag = rng.uniform(1, 3, 2), rng.uniform(0.5, 2, 2)
    force = 1000 * 0.2 * inertia * rate + 500 * 0.5 * drag * velocity * speed[:, None]
    setup = Setup(
        1000.0, 0.2, (0.5, 0.5), regular=False, form="vector", methods=("least_squares", "force_weighted", "robust")
    )
    exact = identify(ForceRecord(time, force, velocity, rate), setup)
    by_spline = identify(ForceRecord(time, force, velocity), setup)
    for component in range(2):
        for method in setup.methods:
            fit = exact.fit(method, component)
            assert (fit.inertia.value, fit.drag.value) == pytest.approx((inertia[component], drag[component]), rel=1e-9)
        assert by_spline.fit("least_squares", component).inertia.value == pytest.approx(inertia[component], rel=1e-4)


def test_vector_and_component_drag_of_a_circular_orbit_differ_by_the_speed_factor():
    angle = 2 * math.pi * np.arange(600) / 60.0
    time, velocity = angle / 6.0, 0.5 * np.column_stack([np.cos(angle), -np.sin(angle)])
    rate = 3.0 * np.column_stack([-np.sin(angle), -np.cos(angle)])
    force = 1000 * 0.1 * 1.8 * rate + 500 * 0.3 * 1.0 * velocity * 0.5
    setup = Setup(1000.0, 0.1, (0.3, 0.3), period=2 * math.pi / 6.0, methods=("fourier",))
    component = identify(ForceRecord(time, force, velocity), setup).fit("fourier")
    vector = identify(ForceRecord(time, force, velocity), replace(setup, form="vector")).fit("fourier")
    assert vector.drag.value == pytest.approx(1.0, rel=1e-9)
    assert vector.drag.value / component.drag.value == pytest.approx(8 / (3 * math.pi), rel=2e-3)


def test_a_flow_that_turns_asks_for_the_vector_form_and_not_for_harmonics():
    angle = 2 * math.pi * np.arange(600) / 60.0
    time, velocity = angle / 6.0, 0.5 * np.column_stack([np.cos(angle), -0.5 * np.sin(angle)])
    rate = 3.0 * np.column_stack([-np.sin(angle), -0.5 * np.cos(angle)])
    force = 180.0 * rate + 150.0 * velocity * np.linalg.norm(velocity, axis=1)[:, np.newaxis]
    setup = Setup(1000.0, 0.1, (0.3, 0.3), period=2 * math.pi / 6.0, methods=("least_squares",))
    record = ForceRecord(time, force, velocity)
    (notice,) = identify(record, setup).notices
    assert notice.code == "identification-drag-form" and notice.value == pytest.approx(0.5)
    assert "drag_form: vector" in notice.remedy
    assert identify(record, replace(setup, form="vector")).notices == ()
    # a flow to and fro has nothing to turn
    flat = ForceRecord(time, force, velocity * np.array([1.0, 0.1]))
    assert "identification-drag-form" not in {notice.code for notice in identify(flat, setup).notices}


def test_harmonics_bias_least_squares_unless_they_are_fitted_next_to_it():
    record, setup = synthetic(np.random.default_rng(3), harmonics=0.05)
    plain = identify(record, replace(setup, methods=("fourier", "least_squares")))
    together = identify(record, replace(setup, methods=("least_squares",), harmonics=(2, 3)))
    assert plain.fit("fourier").drag.value == pytest.approx(1.3, rel=1e-6)
    assert abs(plain.fit("least_squares").drag.value - 1.3) > 0.001
    assert "identification-harmonics" in {notice.code for notice in plain.notices}
    assert together.notices == ()
    assert together.fit("least_squares").drag.value == pytest.approx(1.3, rel=1e-6)


def test_one_degree_of_phase_matters_for_drag_and_not_for_inertia():
    """At KC 1.5, C_M/C_D about 1: 0.2 % of C_M and 16 % of C_D in the literature's example."""
    record, setup = synthetic(np.random.default_rng(1), inertia=1.2, drag=1.0, number=1.5)
    fit = identify(record, replace(setup, methods=("fourier",))).fit("fourier")
    ratio = math.pi**2 * 1.2 / (1.0 * 1.5)
    degree = math.radians(1.0)
    # drag turns into inertia over the ratio of their first harmonics, pi^3 C_M / (KC C_D) over 8/(3 pi) pi
    first = ratio / (8.0 / (3.0 * math.pi))
    assert abs(fit.inertia.phase_sensitivity) * degree / 1.2 == pytest.approx(degree / first, rel=0.02)
    assert abs(fit.drag.phase_sensitivity) * degree / 1.0 == pytest.approx(degree * first, rel=0.02)
    assert 0.12 < abs(fit.drag.phase_sensitivity) * degree < 0.18
    turned = ForceRecord(record.time, np.interp(record.time - 0.0, record.time, record.force[:, 0]), record.velocity)
    assert identify(turned, setup).fit("fourier").drag.value == pytest.approx(1.0, rel=1e-9)


def test_phase_sensitivity_is_the_change_under_a_real_shift():
    record, setup = synthetic(np.random.default_rng(2), number=8.0)
    omega, shift = 2 * math.pi / setup.period, math.radians(0.1)
    base = identify(record, setup).fit("least_squares")
    later, _ = synthetic(np.random.default_rng(2), number=8.0, start=shift / omega)
    moved = identify(ForceRecord(record.time, later.force, record.velocity), setup).fit("least_squares")
    for name in ("inertia", "drag"):
        change = (getattr(moved, name).value - getattr(base, name).value) / shift
        assert change == pytest.approx(getattr(base, name).phase_sensitivity, rel=0.01, abs=0.01)


def test_drag_at_small_and_inertia_at_large_kc_are_refused_not_printed():
    rng = np.random.default_rng(4)
    record, setup = synthetic(rng, number=0.1, noise=0.02)
    low = identify(record, replace(setup, phase_error=math.radians(0.5)))
    record, setup = synthetic(rng, number=400.0, noise=4.0)
    high = identify(record, setup)
    for method in METHODS:
        assert low.fit(method).inertia.known
        assert not low.fit(method).drag.known
        assert "not determined" in low.fit(method).drag.text
        assert high.fit(method).drag.known
        assert not high.fit(method).inertia.known
    assert {notice.code for notice in low.notices} == {"identification-unknown"}


def test_only_known_digits_are_printed():
    record, setup = synthetic(np.random.default_rng(5), number=10.0, noise=0.1)
    fit = identify(record, setup).fit("least_squares")
    value, half = fit.drag.text.split(" +- ")
    assert len(value.split(".")[1]) == len(half.split(".")[1])
    # one digit of the uncertainty
    assert len(half.replace(".", "").lstrip("0")) == 1


def test_more_noise_and_shorter_records_widen_the_intervals():
    widths = {}
    for label, options in {"base": {}, "noise": {"noise": 0.2}, "short": {"periods": 10.0}}.items():
        record, setup = synthetic(np.random.default_rng(6), **{"noise": 0.05, "periods": 40.0, **options})
        widths[label] = identify(record, setup).fit("least_squares").inertia.half_width
    assert 2.0 < widths["noise"] / widths["base"] < 8.0
    assert 1.3 < widths["short"] / widths["base"] < 4.0


def test_robust_fit_bears_spikes():
    record, setup = synthetic(np.random.default_rng(7), noise=0.01)
    force = record.force[:, 0].copy()
    where = np.random.default_rng(8).choice(force.size, 12, replace=False)
    force[where] += 8.0 * force.max()
    found = identify(ForceRecord(record.time, force, record.velocity), setup)
    assert abs(found.fit("robust").inertia.value - 1.7) < 0.1 * abs(found.fit("least_squares").inertia.value - 1.7)


def test_reduction_and_the_gamma_it_stands_for():
    """Planted circulation: the fall of C_M gives its gamma back."""
    period, gamma = 1.05, 0.95
    omega, time = 2 * math.pi / period, period / 80 * np.arange(800)
    first, second = 0.05, 0.046
    velocity = np.column_stack([first * np.cos(omega * time), -second * np.sin(omega * time)])
    rate = omega * np.column_stack([-first * np.sin(omega * time), -second * np.cos(omega * time)])
    gained = gamma * first * second * period
    force = 1000 * AREA * 2.0 * rate + 1000 * gained * np.column_stack([-velocity[:, 1], velocity[:, 0]])
    setup = Setup(1000.0, AREA, (DIAMETER,) * 2, period=period, ideal_inertia=(2.0, 2.0), methods=("fourier",))
    result = identification_result(identify(ForceRecord(time, force, velocity), setup), title="t")
    data = result.tree["/coefficients"]
    assert data["equivalent_gamma"].values[0] == pytest.approx([gamma, gamma], rel=1e-3)
    assert result.status == "converged"
    assert all(check.passed for check in result.checks)


@pytest.mark.parametrize("seed", range(3))
def test_orbital_motion_from_a_gauge_is_that_of_the_sea(seed):
    """Linear waves of the package itself, at a member up- or downstream of the gauge."""
    rng = np.random.default_rng(seed)
    water, distance, height = Water(rng.uniform(3, 30), 1000.0, 9.81), rng.uniform(-8, 8), -rng.uniform(0.5, 2.5)
    period = rng.uniform(3, 9)
    omega = 2 * math.pi / period
    k = float(wave_number(omega, water.depth, 9.81))
    sea = WaveComponents(*(np.array([v]) for v in (omega, 0.3, 0.7, 0.0, k)), water=water)
    time = period / 37.3 * np.arange(200)
    at = {"water_depth": water.depth, "gravity": 9.81, "height": height, "distance": distance}
    found = orbital_motion(time, 0.2 + sea.elevation(time), period=period, **at)
    point = (np.array([distance]), np.zeros(1), np.array([height]))
    for values, wanted in zip(found, (sea.velocity(time, *point), sea.acceleration(time, *point))):
        assert values == pytest.approx(wanted[:, 0, ::2], abs=1e-9)
    irregular = synthesise(jonswap(1.0, 6.0, 3.3), water, duration=400.0, seed=seed, time_step=0.25)
    clock = 0.25 * np.arange(round(irregular.repeat_period / 0.25))
    velocity, rate = orbital_motion(clock, irregular.elevation(clock), **at)
    assert velocity == pytest.approx(irregular.velocity(clock, *point)[:, 0, ::2], abs=1e-9)
    assert rate == pytest.approx(irregular.acceleration(clock, *point)[:, 0, ::2], abs=1e-9)


def test_gauges_with_gaps_and_members_out_of_the_water_are_refused():
    time = 0.1 * np.arange(100)
    water = {"water_depth": 5.0, "gravity": 9.81}
    with pytest.raises(InputError, match="sample 8"):
        orbital_motion(time, np.where(np.arange(100) == 7, np.nan, np.sin(time)), height=-1.0, **water)
    with pytest.raises(InputError, match="z = 1 m"):
        orbital_motion(time, np.sin(time), height=1.0, **water)


def sound():
    record, setup = synthetic(np.random.default_rng(9), noise=0.01, periods=6.0)
    return record.time.copy(), record.force[:, 0].copy(), record.velocity[:, 0].copy(), setup


def bad_nan(t, f, u):
    f[17] = np.nan
    return t, f, u


def bad_step(t, f, u):
    keep = np.arange(t.size) != 40
    return t[keep], f[keep], u[keep]


def bad_order(t, f, u):
    t[10] = t[9]
    return t, f, u


def bad_clip(t, f, u):
    return t, np.minimum(f, 0.8 * f.max()), u


def bad_clip_below(t, f, u):
    return t, f, np.maximum(u, 0.7 * u.min())


def bad_flat(t, f, u):
    return t, f, np.zeros_like(u)


def bad_length(t, f, u):
    return t, f[:-1], u


def bad_short(t, f, u):
    return t[:8], f[:8], u[:8]


FAULTS = {
    bad_nan: "force is not a number in 1 of 360 samples, first in sample 18",
    bad_step: "not evenly sampled: the step to sample 41",
    bad_order: "time does not rise at sample 11",
    bad_clip: "force 1 is clipped: it stays at its top",
    bad_clip_below: "velocity 1 is clipped: it stays at its bottom",
    bad_flat: "velocity 1 does not change",
    bad_length: "force has 359 rows, time 360",
    bad_short: "the record holds 8 samples",
}


@pytest.mark.parametrize("spoil", FAULTS, ids=lambda item: item.__name__)
def test_each_bad_record_gives_one_clear_message(spoil):
    time, force, velocity, _ = sound()
    with pytest.raises(InputError, match=FAULTS[spoil]):
        ForceRecord(*spoil(time, force, velocity))


def test_quantised_crests_are_not_called_clipped():
    time, force, velocity, _ = sound()
    quantum = 0.02 * np.ptp(velocity)
    assert ForceRecord(time, force, np.round(velocity / quantum) * quantum).components == 1


def test_records_shorter_than_a_period_or_too_coarse_are_refused():
    time, force, velocity, setup = sound()
    with pytest.raises(InputError, match="shorter than one period"):
        identify(ForceRecord(time[:40], force[:40], velocity[:40]), setup)
    with pytest.raises(InputError, match="less than two periods"):
        identify(ForceRecord(time[:70], force[:70], velocity[:70]), replace(setup, period=None))
    with pytest.raises(InputError, match="too few for u"):
        identify(ForceRecord(time[::8], force[::8], velocity[::8]), setup)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"density": -1.0}, "density"),
        ({"widths": (0.0,)}, "widths"),
        ({"period": 0.0}, "period"),
        ({"methods": ("morison",)}, "not a known word"),
        ({"methods": ("fourier",), "regular": False}, "periodic record"),
        ({"harmonics": (1,)}, "2 and above"),
        ({"confidence": 1.0}, "confidence"),
        ({"bootstrap": 3}, "bootstrap"),
        ({"phase_error": -0.1}, "phase_error"),
        ({"form": "both"}, "form"),
    ],
)
def test_impossible_setups_are_refused(options, words):
    with pytest.raises(InputError, match=words):
        Setup(**{"density": 1000.0, "area": 1.0, "widths": (1.0,), **options})


def test_wrong_number_of_widths_and_vector_form_of_one_component():
    time, force, velocity, setup = sound()
    with pytest.raises(InputError, match="2 widths for 1 components"):
        identify(ForceRecord(time, force, velocity), replace(setup, widths=(1.0, 1.0)))
    with pytest.raises(InputError, match="needs two components"):
        identify(ForceRecord(time, force, velocity), replace(setup, form="vector"))


@pytest.mark.slow
@pytest.mark.parametrize(
    "kind",
    [
        {"noise": 0.05, "colour": 0.8, "harmonics": 0.05},
        {"noise": 0.3, "number": 8.0},
    ],
)
def test_intervals_cover_and_nothing_is_biased(kind):
    """400 random records: 95 % intervals cover 92 to 98 %, means within 3.5 standard errors of the truth."""
    rng = np.random.default_rng(11)
    hits: dict = {}
    errors: dict = {}
    for _ in range(400):
        inertia, drag = rng.uniform(0.8, 2.5), rng.uniform(0.5, 2.0)
        record, setup = synthetic(rng, inertia=inertia, drag=drag, periods=12.4, per_period=40.0, **kind)
        setup = replace(setup, bootstrap=50, harmonics=(2, 3) if "harmonics" in kind else ())
        found = identify(record, setup)
        for method in METHODS:
            fit = found.fit(method)
            for name, item, true in (("m", fit.inertia, inertia), ("d", fit.drag, drag)):
                hits.setdefault((method, name), []).append(abs(item.value - true) <= item.half_width)
                errors.setdefault((method, name), []).append((item.value - true) / item.half_width)
    for key, values in hits.items():
        assert 0.92 < np.mean(values) < 0.98, (key, np.mean(values))
        assert abs(np.mean(errors[key])) < 3.5 * np.std(errors[key]) / math.sqrt(400), key


@pytest.mark.parametrize("level", [0.6, 0.9])
def test_clipping_is_seen_where_samples_repeat_in_every_period(level):
    """A whole number of samples a period leaves few different values: their spacing is not the step of the gauge."""
    angle = 2 * math.pi * np.arange(1200) / 60 + 0.7
    force = np.clip(np.cos(angle), -level, level)
    with pytest.raises(InputError, match="clipped"):
        ForceRecord(angle / 6.0, force, np.sin(angle))
    assert ForceRecord(angle / 6.0, np.cos(angle), np.sin(angle)).components == 1


def two_components(rng, *, ratio=0.9, gamma=0.936, noise=0.0):
    """Return an elliptic orbit with Morison's force of a C_M that a circulation lowered, and the set-up."""
    period, speed = 1.05, 0.06
    omega = 2 * math.pi / period
    angle = 2 * math.pi * np.arange(1200) / 60 + rng.uniform(0, 6)
    velocity = speed * np.column_stack([np.cos(angle), -ratio * np.sin(angle)])
    rate = -speed * omega * np.column_stack([np.sin(angle), ratio * np.cos(angle)])
    fall = gamma * speed**2 * period / (omega * AREA) * np.array([ratio**2, 1.0])
    force = 1000 * AREA * (2.0 - fall) * rate + 500 * DIAMETER * 1.2 * velocity * np.abs(velocity)
    force += noise * force.std() * rng.standard_normal(force.shape)
    setup = Setup(1000.0, AREA, (DIAMETER, DIAMETER), period=period, bootstrap=100, ideal_inertia=(2.0, 2.0))
    return ForceRecord(angle / omega, force, velocity), setup


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(("rate_of_samples", "corner"), [(50.0, None), (16.0, None), (50.0, 5.0)], ids=str)
def test_noise_of_a_current_meter_does_not_lower_the_inertia_of_irregular_waves(seed, rate_of_samples, corner):
    """Noise of 3 to 8 % of the velocity, white or filtered by the meter: without the cut C_M loses its share."""
    step = 1.0 / rate_of_samples
    water = Water(2.0, 1000.0, 9.81)
    sea = synthesise(jonswap(0.2, 1.6, 3.3), water, duration=300.0, seed=seed, time_step=step)
    clock = step * np.arange(round(sea.repeat_period / step))
    velocity = sea.velocity(clock, 0.0, 0.0, -0.5)[:, 0]
    rate = sea.acceleration(clock, 0.0, 0.0, -0.5)[:, 0]
    force = 1000.0 * AREA * 1.9 * rate + 500.0 * DIAMETER * 1.2 * velocity * np.abs(velocity)
    rng = np.random.default_rng(seed)
    noise = rng.standard_normal(clock.size)
    if corner is not None:
        noise = sosfiltfilt(butter(2, corner, fs=rate_of_samples, output="sos"), noise)
    # 3 % is a fifth of the derivative at 50 Hz; more where frequencies are too low for it to count
    noise *= (
        {(50.0, None): 0.03, (16.0, None): 0.08, (50.0, 5.0): 0.05}[rate_of_samples, corner]
        * velocity.std()
        / noise.std()
    )
    setup = Setup(1000.0, AREA, (DIAMETER,), regular=False, methods=("least_squares",), bootstrap=50)
    exact, found = (identify(ForceRecord(clock, force, given), setup) for given in (velocity, velocity + noise))
    (reported,) = [notice for notice in found.notices if notice.code == "velocity-noise"]
    assert reported.severity == "information" and not any(item.code == "velocity-noise" for item in exact.notices)
    assert exact.fits[0].inertia.value == pytest.approx(1.9, rel=1e-3)
    assert found.fits[0].inertia.value == pytest.approx(1.9, rel=0.01)
    assert found.fits[0].drag.value == pytest.approx(1.2, rel=0.01)
    assert found.period == pytest.approx(exact.period, rel=0.03)
    raw = acceleration_of((velocity + noise)[:, None], step)[:, 0]
    assert (rate @ raw) / (raw @ raw) < 0.98


def test_wrong_periods_and_irregular_records_are_refused_or_reported():
    record, setup = two_components(np.random.default_rng(1))
    with pytest.raises(InputError, match=r"does not repeat itself every 0\.93 s"):
        identify(record, replace(setup, period=0.93))
    near = identify(record, replace(setup, period=1.05 * 1.01))
    assert "identification-aperiodic-velocity" in {notice.code for notice in near.notices}
    assert identify(record, setup).notices == ()
    rng = np.random.default_rng(2)
    time = 0.02 * np.arange(4000)
    waves = np.cos(rng.uniform(4, 9, 30) * time[:, None] + rng.uniform(0, 6, 30)).sum(axis=1)
    with pytest.raises(InputError, match="regular: false"):
        identify(ForceRecord(time, waves, waves), Setup(1000.0, AREA, (DIAMETER,)))


def test_exchanged_columns_and_signs_are_called_implausible():
    record, setup = two_components(np.random.default_rng(3), noise=0.01)
    for force, velocity in ((record.velocity, record.force), (-record.force, record.velocity)):
        codes = [notice.code for notice in identify(ForceRecord(record.time, force, velocity), setup).notices]
        assert "identification-implausible" in codes
    whole = identify(ForceRecord(record.time, 79.0 * record.force, record.velocity), setup)
    assert "identification-implausible" in {notice.code for notice in whole.notices}


def test_one_message_a_coefficient_not_one_a_method():
    record, setup = two_components(np.random.default_rng(4), noise=1.0)
    found = identify(record, replace(setup, phase_error=0.2))
    unknown = [notice.message for notice in found.notices if notice.code == "identification-unknown"]
    assert len(unknown) == 2 and all("C_D" in message for message in unknown)


def test_noise_of_the_velocity_does_not_enter_kc_and_gamma():
    """Extremes of a noisy record lie outside the orbit; mean and harmonics do not."""
    rng = np.random.default_rng(5)
    record, setup = two_components(rng, noise=0.02)
    rough = ForceRecord(record.time, record.force, record.velocity + 0.004 * rng.standard_normal((1200, 2)))
    found = identify(rough, replace(setup, methods=("fourier",)))
    assert found.keulegan_carpenter == pytest.approx((1.4, 1.26), rel=0.01)
    tree = identification_result(found, title="t").tree["coefficients"]
    gamma, spread = tree["equivalent_gamma"].values[0], tree["equivalent_gamma_half_width"].values[0]
    assert gamma == pytest.approx(0.936, abs=0.03)
    # noise of the force, and of the amplitude that C_M is divided by: standard errors of a sine, and Student's quantile
    omega, speed = 2 * math.pi / 1.05, np.array([0.06, 0.054])
    inertia = 2.0 - 0.936 * 0.06**2 * 1.05 / (omega * AREA) * np.array([0.81, 1.0])
    share = math.sqrt(2.0 / 1200) * np.array(
        [0.02 * record.force.std() / (1000 * AREA * omega * speed), 0.004 * inertia / speed]
    )
    scale = omega * AREA / (speed[::-1] / speed * speed.prod() * 1.05)
    expected = stats.t.ppf(0.975, 19) * np.hypot(*share) * scale
    assert spread == pytest.approx(expected, rel=0.35)


@pytest.mark.parametrize("regular", [True, False])
def test_a_straight_drift_of_the_force_changes_no_coefficient(regular):
    rng = np.random.default_rng(1)
    record, setup = synthetic(rng, periods=20.4, number=8.0)
    setup = replace(setup, regular=regular, methods=METHODS if regular else METHODS[1:])
    drift = 0.8 * np.ptp(record.force) * record.time / record.time[-1]
    record = replace(record, force=record.force + drift[:, None])
    found = identify(record, setup)
    for fit in found.fits:
        assert (fit.inertia.value, fit.drag.value) == pytest.approx((1.7, 1.3), rel=1e-9 if regular else 1e-4)
        assert fit.residual == pytest.approx(0.0, abs=(1e-9 if regular else 1e-3) * np.ptp(record.force))
    (notice,) = [one for one in found.notices if one.code == "identification-drift"]
    assert notice.value == pytest.approx(np.ptp(drift) / np.ptp(record.force), rel=0.05)


def test_a_force_is_compared_below_the_frequency_at_which_its_velocity_is_cut():
    """The cut takes a fifth of the acceleration away: from the force as well, so that C_M stays."""
    rng = np.random.default_rng(2)
    time = 0.02 * np.arange(8000)
    frequency, phase = rng.uniform(0.3, 1.2, 40), rng.uniform(0, 6.28, 40)
    turn = 2 * math.pi * frequency
    angle = turn * time[:, None] + phase
    velocity, rate = 0.02 * np.cos(angle).sum(axis=1), -0.02 * np.sin(angle) @ turn
    force = 1000.0 * AREA * 1.9 * rate + 500.0 * DIAMETER * 1.2 * velocity * np.abs(velocity)
    setup = Setup(1000.0, AREA, (DIAMETER,), regular=False, bootstrap=50, methods=("least_squares",))
    for measured in (None, rate):
        record = ForceRecord(time, force, velocity, measured)
        motion = irregular_motion(record, (NoiseCut(1.0, 0.0, 0.0),))
        blocks = [(n, n + 200) for n in range(0, 8000, 200)]
        fit = fit_component(record, motion, setup, 0, "least_squares", 5.0, blocks, rng)
        assert fit.inertia.value == pytest.approx(1.9, rel=1e-3)
        assert fit.drag.value == pytest.approx(1.2, rel=5e-3)
    cut = without_noise(rate, 0.02, 1.0)
    assert (rate @ cut) / (cut @ cut) > 1.05


def test_white_noise_that_a_cut_leaves_is_taken_off_the_inertia():
    """A column with a share of noise lowers its coefficient by that share; the planted one comes back."""
    rng = np.random.default_rng(3)
    column, other = rng.standard_normal((2, 200000))
    noise = math.sqrt(0.02 / 0.98) * rng.standard_normal(column.size)
    seen = np.column_stack([column + noise, other])
    force = 1.9 * column + 1.2 * other
    nothing, weight = np.zeros((column.size, 0)), rng.uniform(0.2, 1.0, column.size)
    plain, found = (_gain(seen, nothing, weight, share) @ force for share in (0.0, 0.02))
    assert plain[0] == pytest.approx(1.9 * 0.98, rel=2e-3)
    # to first order: the square of the share is left
    assert found == pytest.approx([1.9, 1.2], rel=2e-3)


def in_waves(rng, regular, noise):
    """Return forces of a planted 1.7 and 1.2 with noise of 5 %, noise of the velocity, and the set-up."""
    time = 0.02 * np.arange(3000 if regular else 6000)
    frequency = np.array([0.5]) if regular else np.linspace(0.2, 1.2, 60) + rng.uniform(-0.008, 0.008, 60)
    size = np.sqrt(np.exp(-1.25 * (0.5 / frequency) ** 4) * frequency**-5.0)
    size *= 0.5 / np.linalg.norm(size)
    angle = 2 * math.pi * frequency * time[:, None] + rng.uniform(0, 6.28, frequency.size)
    velocity, rate = np.cos(angle) @ size, -np.sin(angle) @ (2 * math.pi * frequency * size)
    force = 1000.0 * 0.00785 * 1.7 * rate + 500.0 * 0.1 * 1.2 * velocity * np.abs(velocity)
    force += 0.05 * force.std() * rng.standard_normal(time.size)
    velocity = velocity + noise * velocity.std() * rng.standard_normal(time.size)
    methods = ("least_squares", "force_weighted")
    return ForceRecord(time, force, velocity), Setup(1000.0, 0.00785, (0.1,), regular=regular, methods=methods)


@pytest.mark.slow
@pytest.mark.parametrize(("regular", "noise"), [(True, 0.05), (True, 0.09), (False, 0.02), (False, 0.05), (False, 0.1)])
def test_intervals_hold_the_coefficients_under_noise_of_the_velocity(regular, noise):
    """Of 120 records with 95 %: a binomial share falls below 0.88 once in a thousand."""
    rng = np.random.default_rng(17)
    held, errors = [], []
    for _ in range(120):
        record, setup = in_waves(rng, regular, noise)
        found = identify(record, replace(setup, bootstrap=50))
        pairs = [(item, true) for fit in found.fits for item, true in ((fit.inertia, 1.7), (fit.drag, 1.2))]
        held.append([abs(item.value - true) <= item.half_width for item, true in pairs])
        errors.append([item.value / true - 1.0 for item, true in pairs])
    assert np.all(np.mean(held, axis=0) >= 0.88), np.mean(held, axis=0)
    # of white noise of the velocity up to 3 Hz of 25 Hz is left in u|u|, which lowers C_D by 5/3 of its share
    limit = 0.0015 + (0.0 if regular else 5.0 / 3.0 * noise**2 * 3.0 / 25.0)
    assert np.all(np.abs(np.mean(errors, axis=0)) < limit), np.mean(errors, axis=0)


@pytest.mark.parametrize("regular", [True, False])
def test_noise_of_a_current_meter_biases_no_coefficient(regular):
    """Means of twelve records: noise of 5 % shifted C_D by 0.7 % of regular waves, C_M by 0.35 % of irregular ones."""
    rng = np.random.default_rng(19)
    values = []
    for _ in range(12):
        record, setup = in_waves(rng, regular, 0.05)
        fit = identify(record, replace(setup, bootstrap=50, methods=("least_squares",))).fits[0]
        values.append([fit.inertia.value / 1.7 - 1.0, fit.drag.value / 1.2 - 1.0])
    assert np.all(np.abs(np.mean(values, axis=0)) < 0.002), np.mean(values, axis=0)
