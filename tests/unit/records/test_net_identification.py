"""Coefficients of nets come back from records in which they were planted."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.morison.nets import Net
from moyai.records.nets.campaign import NetCampaign, measure_nets
from moyai.records.nets.flow import encounter_period
from moyai.records.nets.regression import fit_joint_law, fit_power_law
from moyai.records.nets.runs import NetRun, Specimen, Tank
from moyai.records.nets.synthesis import Rig, towed_run, wave_run
from moyai.records.nets.tensions import CageRecord, EndRecord, measure_tensions
from moyai.records.nets.vibration import Vibration
from moyai.records.nets.waves import fit_waves, wave_coefficients

TANK = Tank(1000.0, 1.14e-6, 9.81, 0.45, -0.2)
QUIET = Rig(vibration_force=0.0, white_noise=0.0, slow_noise=0.0)
LINE = Vibration(3.0, 2.4, 3.8)


def specimen(diameter: float = 1.4e-3, solidity: float = 0.22, name: str = "A") -> Specimen:
    net = Net.from_solidity(diameter, solidity)
    return Specimen(name, net, 0.066, 0.066 * net.listed)


def coefficients(whole, frame, net, line=None, tank=TANK, **options):
    settings = {"confidence": 0.95, "phase_error": 0.0, "bootstrap": 60, "seed": 1, **options}
    fits = [fit_waves(run, tank, net.projected_area, net.volume, line, **settings) for run in (whole, frame)]
    return wave_coefficients(fits[0], fits[1], net, tank, 0.95, 0.0)


# --- exact recovery --------------------------------------------------------------------------------------------------


def test_towing_without_noise_is_exact():
    rng = np.random.default_rng(1)
    for _ in range(6):
        net = specimen(rng.uniform(2e-4, 3e-3), rng.uniform(0.1, 0.5))
        drag, speed = rng.uniform(0.4, 3.0), rng.uniform(0.05, 1.2)
        tank = Tank(rng.uniform(998, 1030), 1.2e-6, 9.81, 2.0, -1.0)
        runs = (
            towed_run(QUIET, tank, None, 0.0, speed, name="frame", rng=rng),
            towed_run(QUIET, tank, net, drag, speed, name="net", rng=rng),
        )
        runs = tuple(dataclasses.replace(run, speed_record=None) for run in runs)
        found = measure_nets(NetCampaign("t", tank, (net,), runs, vibration="none"))
        assert found.towing[0].drag == pytest.approx(drag, rel=2e-4)
        assert found.towing[0].reynolds == pytest.approx(speed * net.net.twine_diameter / 1.2e-6)
        assert found.towing[0].frame_force == pytest.approx(0.5 * tank.density * 4e-3 * speed**2, rel=2e-4)


@pytest.mark.parametrize("meter", [True, False])
@pytest.mark.parametrize(("speed", "following"), [(0.0, False), (0.4, False), (0.25, True), (3.5, True)])
def test_waves_without_noise_are_exact(meter, speed, following):
    """At rest, against waves, with them, and faster than their crests; random nets, depths and periods."""
    rng = np.random.default_rng(int(10 * speed) + meter)
    for _ in range(3):
        net = specimen(rng.uniform(3e-4, 2e-3), rng.uniform(0.15, 0.4))
        tank = Tank(1000.0, 1.1e-6, 9.81, rng.uniform(0.4, 3.0), -rng.uniform(0.1, 0.3))
        drag, inertia, period = rng.uniform(0.6, 2.5), rng.uniform(1.0, 2.5), rng.uniform(0.9, 1.8)
        pair = [
            wave_run(
                QUIET, tank, item, drag, inertia, name=name, height=rng.uniform(0.03, 0.09), period=period, rng=rng,
                speed=speed, following=following, meter=meter,
            )
            for name, item in (("net", net), ("frame", None))
        ]  # fmt: skip
        found, _ = coefficients(*pair, net, tank=tank)
        assert found.drag == pytest.approx(drag, rel=1e-6)
        # the inertia force is small, and the period is found from the record
        assert found.inertia == pytest.approx(inertia, rel=1e-4)
        assert found.frame_drag_area == pytest.approx(4e-3, rel=1e-6)
        assert found.explained == pytest.approx(1.0, abs=1e-9)
        if speed == 0.0:
            assert found.keulegan_carpenter == pytest.approx(
                found.velocity_amplitude * period / net.net.twine_diameter, rel=1e-6
            )


def test_reading_at_rest_is_taken_off():
    rng = np.random.default_rng(2)
    net, rig = specimen(), dataclasses.replace(QUIET, zero=0.37)
    runs = [
        dataclasses.replace(
            towed_run(rig, TANK, item, 1.3, 0.4, name=name, rng=rng, ramp=5.0), zero=(0.0, 0.05), speed_record=None
        )
        for name, item in (("frame", None), ("net", net))
    ]
    found = measure_nets(NetCampaign("t", TANK, (net,), tuple(runs), vibration="none"))
    assert found.towing[0].drag == pytest.approx(1.3, rel=1e-3)


def test_encounter_period_against_the_dispersion_relation():
    k = 2.0 * math.pi / 1.5613  # deep water, T = 1 s: L = g T^2 / 2 pi
    deep = Tank(1000.0, 1e-6, 9.81, math.inf, -0.2)
    assert encounter_period(1.0, 0.5, deep, False) == pytest.approx(1.0 / (1.0 + 0.5 * k / (2 * math.pi)), rel=1e-4)
    assert encounter_period(1.0, 0.5, deep, True) == pytest.approx(1.0 / (1.0 - 0.5 * k / (2 * math.pi)), rel=1e-4)
    with pytest.raises(InputError, match="as fast as the waves"):
        encounter_period(1.0, 9.81 / (2.0 * math.pi), deep, True)


def test_third_harmonic_in_the_band_survives():
    """Waves of 1 s on a carriage that shakes at 3 Hz: the band holds the third harmonic of u|u|."""
    net = specimen()
    drags, plain = [], []
    for seed in range(10):
        rng = np.random.default_rng(100 + seed)
        rig = Rig(vibration_force=0.3, slow_noise=0.0)
        pair = [wave_run(rig, TANK, item, 1.4, 2.0, name="w", height=0.08, period=1.0, rng=rng) for item in (net, None)]
        found, _ = coefficients(*pair, net, LINE)
        drags.append(found.drag)
        plain.append(coefficients(*pair, net, None)[0].drag)
    assert np.mean(drags) == pytest.approx(1.4, abs=3.0 * np.std(drags) / math.sqrt(10.0))
    # the fitted force keeps the third harmonic that a stop band would have deleted
    omega = 2.0 * math.pi / found.period
    third = [abs(np.mean(values * np.exp(1j * 3.0 * omega * found.time))) for values in (found.force, found.modelled)]
    assert third[0] == pytest.approx(third[1], rel=0.3)
    # the vibration left in spoils the coefficient more
    assert np.std(drags) < 0.8 * np.std(plain)


@pytest.mark.slow
@pytest.mark.parametrize("accelerometer", [False, True])
def test_intervals_cover_what_was_planted(accelerometer):
    rng = np.random.default_rng(21 + accelerometer)
    drag_hits = inertia_hits = count = 0
    for _ in range(20):
        net = specimen(rng.uniform(8e-4, 2.5e-3), rng.uniform(0.2, 0.4))
        drag, inertia = rng.uniform(1.0, 2.0), rng.uniform(1.5, 2.2)
        rig = Rig(vibration_frequency=3.0, slow_time=rng.uniform(0.3, 1.0))
        pair = [
            wave_run(rig, TANK, item, drag, inertia, name="w", height=rng.uniform(0.06, 0.1),
                     period=rng.uniform(1.05, 1.6), rng=rng, meter=bool(rng.integers(2)), accelerometer=accelerometer)
            for item in (net, None)
        ]  # fmt: skip
        found, _ = coefficients(*pair, net, LINE)
        drag_hits += abs(found.drag - drag) < found.drag_half_width
        inertia_hits += abs(found.inertia - inertia) < found.inertia_half_width
        count += 1
    assert drag_hits >= count - 4
    assert inertia_hits >= count - 4


@pytest.mark.slow
def test_coverage_over_many_records():
    rng = np.random.default_rng(77)
    net, hits, total = specimen(), np.zeros(3), 80
    for _ in range(total):
        speed = rng.uniform(0.15, 0.8)
        pair = [
            wave_run(Rig(), TANK, item, 1.3, 2.0, name="w", height=0.08, period=1.25, rng=rng, speed=speed)
            for item in (net, None)
        ]
        found, _ = coefficients(*pair, net, LINE)
        hits[0] += abs(found.drag - 1.3) < found.drag_half_width
        hits[1] += abs(found.inertia - 2.0) < found.inertia_half_width
        runs = tuple(
            towed_run(Rig(), TANK, item, 1.3, speed, name=name, rng=rng) for name, item in (("f", None), ("n", net))
        )
        tow = measure_nets(NetCampaign("t", TANK, (net,), runs, vibration=LINE)).towing[0]
        hits[2] += abs(tow.drag - 1.3) < tow.drag_half_width
    # 95 % meant; slow noise of a few correlation times a record leaves it a little below
    assert (hits >= 0.86 * total).all(), hits / total


# --- what cannot be known ---------------------------------------------------------------------------------------------


def test_inertia_that_drag_hides_is_refused():
    rng = np.random.default_rng(31)
    net = specimen(4e-4, 0.3)
    pair = [wave_run(Rig(), TANK, item, 1.3, 2.0, name="w", height=0.08, period=1.4, rng=rng) for item in (net, None)]
    found, notices = coefficients(*pair, net, LINE)
    assert not found.inertia_known
    assert found.drag_known
    (notice,) = [item for item in notices if item.code == "net-coefficient-unknown"]
    assert "C_M" in notice.message
    assert f"KC = {found.keulegan_carpenter:.0f}" in notice.message
    assert notice.value > notice.limit == 0.5


def test_wrong_speed_or_period_is_reported():
    rng = np.random.default_rng(33)
    net = specimen()
    run = wave_run(QUIET, TANK, net, 1.3, 2.0, name="w", height=0.08, period=1.25, rng=rng, speed=0.4)
    frame = wave_run(QUIET, TANK, None, 1.3, 2.0, name="f", height=0.08, period=1.25, rng=rng, speed=0.4)
    _, notices = coefficients(run, frame, net)
    assert not [item for item in notices if item.code == "net-encounter-period"]
    for change in ({"following": True}, {"speed": 1.0}, {"period": 1.6}):
        _, notices = coefficients(dataclasses.replace(run, **change), frame, net)
        assert [item for item in notices if item.code == "net-encounter-period"], change


def test_lift_is_reported():
    rng = np.random.default_rng(35)
    net = specimen()
    for share, reported in ((0.0, False), (0.2, True)):
        rig = dataclasses.replace(QUIET, lift_share=share)
        runs = tuple(towed_run(rig, TANK, i, 1.5, 0.5, name=n, rng=rng) for n, i in (("f", None), ("n", net)))
        found = measure_nets(NetCampaign("t", TANK, (net,), runs, vibration="none"))
        whole = 1.5 + 4e-3 / net.projected_area
        assert found.towing[0].lift == pytest.approx(share * whole, abs=2e-3)
        assert any(item.code == "net-lift" for item in found.notices) == reported


# --- the frame --------------------------------------------------------------------------------------------------------


def test_frame_of_another_speed_is_scaled_and_reported():
    rng = np.random.default_rng(41)
    net = specimen()
    runs = [towed_run(QUIET, TANK, None, 0.0, u, name=f"f{u}", rng=rng) for u in (0.2, 0.8)]
    runs.append(towed_run(QUIET, TANK, net, 1.1, 0.5, name="n", rng=rng))
    found = measure_nets(NetCampaign("t", TANK, (net,), tuple(runs), vibration="none"))
    assert found.towing[0].drag == pytest.approx(1.1, rel=5e-3)
    assert any(item.code == "net-frame-speed" for item in found.notices)
    alone = measure_nets(NetCampaign("t", TANK, (net,), (runs[-1],), vibration="none"))
    assert any(item.code == "net-no-frame" for item in alone.notices)
    assert alone.towing[0].drag == pytest.approx(1.1 + 4e-3 / net.projected_area, rel=5e-3)


def test_frame_in_the_same_waves_is_chosen():
    rng = np.random.default_rng(43)
    net = specimen()
    runs = []
    for period, area in ((1.1, 4e-3), (1.4, 9e-3)):
        rig = dataclasses.replace(QUIET, frame_drag_area=area)
        for name, item in ((f"f{period}", None), (f"n{period}", net)):
            runs.append(wave_run(rig, TANK, item, 1.2, 2.0, name=name, height=0.07, period=period, rng=rng))
    found = measure_nets(NetCampaign("t", TANK, (net,), tuple(runs), vibration="none"))
    assert [item.drag for item in found.waves] == pytest.approx([1.2, 1.2], rel=1e-6)
    named = [dataclasses.replace(run, frame="f1.4") if run.name == "n1.1" else run for run in runs]
    other = measure_nets(NetCampaign("t", TANK, (net,), tuple(named), vibration="none"))
    assert other.waves[0].frame_drag_area == pytest.approx(9e-3, rel=1e-6)


# --- laws -------------------------------------------------------------------------------------------------------------


def nets_of(rng, count, level, slope, share, cross, thick, between, noise=0.02):
    rows = []
    for k in range(count):
        s, d = rng.uniform(0.18, 0.55), math.exp(rng.uniform(math.log(2e-4), math.log(2e-3)))
        own = between * rng.normal()
        for speed in np.linspace(0.08, 0.9, 7):
            number = speed * d / 1.14e-6
            log = level - slope * math.log(number) + share * s + cross * s * math.log(number) + thick * math.log(d)
            drag = math.exp(log + own)
            rows.append((f"n{k}", number, drag * (1.0 + noise * rng.normal()), noise * drag, s, d))
    return [list(column) for column in zip(*rows)]


def test_power_law_of_one_net():
    rng = np.random.default_rng(51)
    hits = 0
    for _ in range(40):
        factor, exponent = rng.uniform(4.0, 15.0), rng.uniform(0.1, 0.5)
        number = np.geomspace(rng.uniform(20, 100), rng.uniform(400, 2000), 7)
        drag = factor * number**-exponent
        found = fit_power_law("x", number, drag * (1.0 + 0.03 * rng.normal(size=7)), 0.03 * drag)
        hits += found.exponent_interval[0] < exponent < found.exponent_interval[1]
        hits += found.factor_interval[0] < factor < found.factor_interval[1]
    assert hits >= 72
    exact = fit_power_law("x", number, drag, 0.01 * drag)
    assert (exact.factor, exact.exponent) == (pytest.approx(factor), pytest.approx(exponent))
    assert exact.at(number) == pytest.approx(drag)


def test_joint_law_finds_what_was_planted():
    rng = np.random.default_rng(53)
    true = np.array([1.2, -0.2, 2.5, -0.35, 0.1])
    columns = nets_of(rng, 12, 1.2, 0.2, 2.5, -0.35, 0.1, 0.02)
    law = fit_joint_law(*columns)
    spread = np.sqrt(np.diagonal(law.covariance))
    assert (np.abs(law.coefficients - true) < 4.0 * spread + 0.02).all()
    assert law.left_out_error < 0.5 * law.pooled_error
    for _ in range(5):
        number, s, d = rng.uniform(60, 800), rng.uniform(0.2, 0.5), rng.uniform(3e-4, 1.8e-3)
        value = math.exp(true @ [1.0, math.log(number), s, s * math.log(number), math.log(d)])
        assert float(law.at(number, s, d)) == pytest.approx(value, rel=0.08)
        assert law.factor(s, d) * number ** -law.exponent(s) == pytest.approx(float(law.at(number, s, d)))
        low, high = law.interval(number, s, d)
        assert float(low) < value < float(high)


def test_joint_law_falls_back_on_one_power_law():
    """Without an effect of solidity and with few nets, no slope is invented."""
    rng = np.random.default_rng(55)
    law = fit_joint_law(*nets_of(rng, 5, math.log(9.84), 0.36, 0.0, 0.0, 0.0, 0.0))
    for s in (0.2, 0.5):
        assert float(law.at(300.0, s, 1e-3)) == pytest.approx(9.84 * 300.0**-0.36, rel=0.05)
        assert law.exponent(s) == pytest.approx(0.36, abs=0.03)


def test_laws_that_cannot_be_fitted():
    columns = nets_of(np.random.default_rng(57), 2, 2.0, 0.3, 0.0, 0.0, 0.0, 0.0)
    with pytest.raises(InputError, match="2 nets are too few"):
        fit_joint_law(*columns)
    columns = nets_of(np.random.default_rng(57), 4, 2.0, 0.3, 0.0, 0.0, 0.0, 0.0)
    with pytest.raises(InputError, match="one solidity"):
        fit_joint_law(*columns[:4], [0.3] * len(columns[0]), columns[5])
    with pytest.raises(InputError, match="at least 3"):
        fit_power_law("x", [100.0, 200.0], [1.0, 0.9], [0.1, 0.1])
    with pytest.raises(InputError, match="hardly differ"):
        fit_power_law("x", [100.0, 101.0, 102.0], [1.0, 1.0, 1.0], [0.1, 0.1, 0.1])


# --- tensions ---------------------------------------------------------------------------------------------------------


def test_tensions_of_a_cosine_and_of_a_slack_line():
    time = np.arange(0.0, 40.0, 0.01)
    wave = np.cos(2.0 * math.pi * time / 1.3 - 0.7)
    ends = (
        EndRecord("shore", "cage", 5.0 + 2.0 * wave),
        EndRecord("shore", "anchor", 4.0 + 1.5 * wave),
        EndRecord("offshore", "cage", np.maximum(0.0, 3.0 * wave)),
    )
    for period in (1.3, None):
        found, notices = measure_tensions(CageRecord("c", time, ends, period))
        one, two, slack = found
        assert (one.mean, one.least, one.peak) == (
            pytest.approx(5, abs=1e-3),
            pytest.approx(3, abs=1e-3),
            pytest.approx(7, abs=1e-3),
        )
        assert one.first == pytest.approx(2.0, rel=1e-3)
        assert one.first_phase == pytest.approx(0.7, abs=1e-2)
        assert (two.first, two.peak) == (pytest.approx(1.5, rel=1e-3), pytest.approx(5.5, abs=1e-3))
        # half-wave rectified: mean A/pi, first harmonic A/2, half of the time slack
        assert slack.mean == pytest.approx(3.0 / math.pi, rel=2e-3)
        assert slack.first == pytest.approx(1.5, rel=2e-3)
        assert slack.slack == pytest.approx(0.5, abs=0.02)
        assert one.periods == 30
        assert [item.code for item in notices] == ["cage-one-end"]


def test_peaks_too_sharp_for_the_sampling_are_reported():
    time = np.arange(0.0, 20.0, 0.05)
    snap = np.where((np.arange(400) % 20) == 7, 9.0, 0.01)
    _, notices = measure_tensions(CageRecord("c", time, (EndRecord("a", "b", snap),), 1.0))
    assert "cage-tension-sampling" in [item.code for item in notices]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"time": np.zeros(100)}, "does not rise"),
        ({"ends": ()}, "no tension"),
        ({"window": (0.0, 0.01)}, "samples in the window"),
        ({"period": 99.0}, "shorter than one period"),
    ],
)
def test_cage_records_that_cannot_be_used(change, words):
    time = np.arange(100) * 0.1
    values = {"name": "c", "time": time, "ends": (EndRecord("a", "b", np.cos(time)),), "period": 1.0, **change}
    with pytest.raises(InputError, match=words):
        measure_tensions(CageRecord(**values))


# --- bad input --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"time": np.arange(10) * 0.1}, "10 samples"),
        ({"force": np.zeros(50)}, "50 samples of force"),
        ({"kind": "tow"}, "'tow' is not a known word"),
        ({"speed": -1.0}, "speed is -1"),
        ({"speed": 0.0, "speed_record": None}, "speed of towing is missing"),
        ({"window": (5.0, 2.0)}, "lies outside"),
        ({"kind": "waves"}, "current meter or of a wave gauge"),
        ({"kind": "towing_waves", "elevation": np.zeros(200)}, "period of the waves at rest"),
    ],
)
def test_runs_that_cannot_be_used(change, words):
    values = {"name": "r", "net": "A", "kind": "still_water", "time": np.arange(200) * 0.1, "force": np.ones(200),
              "speed": 0.3, **change}  # fmt: skip
    with pytest.raises(InputError, match=words):
        NetRun(**values)
    bad = np.arange(200) * 0.1
    bad[60:] += 0.5
    with pytest.raises(InputError, match="evenly sampled"):
        NetRun("r", "A", "still_water", bad, np.ones(200), speed=0.3)
    force = np.ones(200)
    force[7] = np.nan
    with pytest.raises(InputError, match="sample 8"):
        NetRun("r", "A", "still_water", np.arange(200) * 0.1, force, speed=0.3)


def test_campaigns_that_cannot_be():
    run = towed_run(QUIET, TANK, None, 0.0, 0.3, name="f", rng=np.random.default_rng(1))
    with pytest.raises(InputError, match="two runs"):
        NetCampaign("t", TANK, (), (run, run))
    with pytest.raises(InputError, match="not listed"):
        NetCampaign("t", TANK, (specimen(),), (dataclasses.replace(run, net="B"),))
    with pytest.raises(InputError, match="no run of the bare frame"):
        NetCampaign("t", TANK, (specimen(),), (dataclasses.replace(run, net="A", frame="g"),))
    with pytest.raises(InputError, match="two nets"):
        NetCampaign("t", TANK, (specimen(), specimen()), (run,))
    with pytest.raises(InputError, match="no runs"):
        NetCampaign("t", TANK, (), ())
    with pytest.raises(InputError, match="cm2 or m2"):
        Specimen("A", Net(1e-3, 1e-2), 0.066, 150.7)
    with pytest.raises(InputError, match="above the bed"):
        Tank(1000.0, 1e-6, 9.81, 0.45, -0.6)
    with pytest.raises(InputError, match="viscosity"):
        Tank(1000.0, -1e-6, 9.81, 0.45, -0.2)


@pytest.mark.parametrize(("following", "distance"), [(False, 0.0), (False, 0.8), (True, -0.5)])
def test_records_made_by_hand(following, distance):
    """Force, surface and encounter written down here, dispersion by bisection: nothing of the product makes them."""
    rng = np.random.default_rng(61)
    net, depth, z, period, speed = specimen(), 0.6, -0.25, 1.15, 0.45
    omega, low, high = 2.0 * math.pi / period, 1e-3, 100.0
    for _ in range(200):
        k = 0.5 * (low + high)
        low, high = (k, high) if 9.81 * k * math.tanh(k * depth) < omega**2 else (low, k)
    time = np.arange(0.0, 24.0, 0.02)
    sense = -1.0 if following else 1.0
    # place of the panel along the waves; the gauge stands 'distance' before it
    place = -sense * speed * time
    angle, gauge = k * place - omega * time, k * (place - distance) - omega * time
    amplitude = 0.035 * omega * math.cosh(k * (z + depth)) / math.sinh(k * depth)
    u = speed + sense * amplitude * np.cos(angle)
    rate = sense * amplitude * omega * np.sin(angle)
    tank = Tank(1025.0, 1.2e-6, 9.81, depth, z)
    records = []
    for name, area, volume in (("n", 1.7 * net.projected_area + 3e-3, 1.8 * net.volume + 1e-5), ("f", 3e-3, 1e-5)):
        force = 0.5 * 1025.0 * area * u * np.abs(u) + 1025.0 * volume * rate + 1e-4 * rng.normal(size=time.size)
        records.append(
            NetRun(name, "A" if name == "n" else "", "towing_waves", time, force, speed=speed, distance=distance,
                   elevation=0.035 * np.cos(gauge), period=period, following=following)
        )  # fmt: skip
    found, notices = coefficients(*records, net, tank=tank)
    assert found.drag == pytest.approx(1.7, rel=1e-3)
    assert found.inertia == pytest.approx(1.8, rel=2e-2)
    assert found.velocity_amplitude == pytest.approx(amplitude, rel=1e-4)
    assert not [item for item in notices if item.code == "net-encounter-period"]


@pytest.mark.parametrize("meter", [True, False])
def test_irregular_waves(meter):
    """A sum of commensurate waves, by meter or by gauge, with noise and a carriage that shakes among them."""
    rng = np.random.default_rng(71)
    net, duration, depth, z = specimen(), 60.0, 0.45, -0.2
    time = np.arange(0.0, duration, 0.02)
    orders = np.arange(36, 66)
    omega = 2.0 * math.pi * orders / duration
    k = omega**2 / 9.81
    for _ in range(400):
        k = 0.5 * (k + omega**2 / (9.81 * np.tanh(k * depth)))
    amplitude = 0.035 * np.exp(-(((orders - 48) / 8.0) ** 2)) * np.sqrt(0.12)
    phase = rng.uniform(0.0, 2.0 * math.pi, orders.size)
    turn = np.cos(omega * time[:, None] - phase) * amplitude
    transfer = omega * np.cosh(k * (z + depth)) / np.sinh(k * depth)
    u = turn @ transfer * 3.0
    rate = -(np.sin(omega * time[:, None] - phase) * amplitude) @ (transfer * omega) * 3.0
    records = []
    for name, area, volume in (("n", 1.5 * net.projected_area + 3e-3, 1.9 * net.volume + 1e-5), ("f", 3e-3, 1e-5)):
        force = 500.0 * area * u * np.abs(u) + 1000.0 * volume * rate
        force = force + Rig(vibration_force=0.1).shaking(time.size, rng) + 0.005 * rng.normal(size=time.size)
        records.append(
            NetRun(name, "A" if name == "n" else "", "waves", time, force, regular=False,
                   velocity=u if meter else None, elevation=None if meter else 3.0 * turn.sum(axis=1))
        )  # fmt: skip
    found, _ = coefficients(*records, net, LINE)
    assert found.drag == pytest.approx(1.5, abs=found.drag_half_width)
    assert found.drag_half_width < 0.1
    assert found.inertia == pytest.approx(1.9, abs=found.inertia_half_width)
    # without taking the vibration out the interval is several times as wide
    assert coefficients(*records, net, None)[0].drag_half_width > 1.5 * found.drag_half_width


def test_noise_of_the_meter_does_not_bias():
    rng = np.random.default_rng(73)
    net = specimen()
    values = []
    for _ in range(6):
        pair = [
            wave_run(QUIET, TANK, item, 1.4, 2.0, name="w", height=0.08, period=1.25, rng=rng, meter_noise=0.03)
            for item in (net, None)
        ]
        values.append(coefficients(*pair, net)[0].drag)
    assert np.mean(values) == pytest.approx(1.4, rel=0.01)


def test_vibration_that_cannot_be_searched_is_reported():
    rng = np.random.default_rng(75)
    net, slow = specimen(), dataclasses.replace(QUIET, rate=2.0)
    runs = tuple(
        towed_run(slow, TANK, item, 1.3, 0.4, name=name, rng=rng, duration=60.0, ramp=4.0)
        for name, item in (("f", None), ("n", net))
    )
    found = measure_nets(NetCampaign("t", TANK, (net,), runs))
    assert "net-vibration-unknown" in [notice.code for notice in found.notices]
    assert found.towing[0].drag == pytest.approx(1.3, rel=2e-2)
    with pytest.raises(InputError, match="all runs are of the bare frame"):
        NetCampaign("t", TANK, (net,), runs[:1])


def test_ramps_of_a_run_through_waves_are_left_out():
    """The carriage starts and stops within the record; its speed, not a key, says when it is steady and how fast."""
    rng = np.random.default_rng(81)
    net = specimen()
    records = []
    for name, item in (("n", net), ("f", None)):
        run = wave_run(QUIET, TANK, item, 1.4, 2.0, name=name, height=0.08, period=1.25, rng=rng, speed=0.4)
        course = 0.4 * np.clip(np.minimum(run.time / 4.0, (30.0 - run.time) / 3.0), 0.0, 1.0)
        ramp = course < 0.399
        spoilt = np.where(ramp, 0.3 * run.force, run.force)
        slower = np.where(ramp, run.velocity - 0.4 + course, run.velocity)
        records.append(dataclasses.replace(run, force=spoilt, velocity=slower, speed_record=course, speed=0.0))
    found, notices = coefficients(*records, net)
    assert found.drag == pytest.approx(1.4, rel=1e-6)
    assert found.mean_velocity == pytest.approx(0.4, rel=0.02)
    assert not [item for item in notices if item.code == "net-encounter-period"]


def test_clipped_and_spiky_records_are_reported():
    rng = np.random.default_rng(83)
    net = specimen()
    run = wave_run(Rig(vibration_force=0.0), TANK, net, 1.4, 2.0, name="n", height=0.08, period=1.25, rng=rng)
    force = run.force.copy()
    force[400] += 5.0
    meter = np.clip(run.velocity, -9.0, 0.7 * run.velocity.max())
    spoilt = dataclasses.replace(run, force=force, velocity=meter)
    codes = [item.code for item in measure_nets(NetCampaign("t", TANK, (net,), (run,), vibration="none")).notices]
    assert not [code for code in codes if code.startswith("net-record")]
    found = measure_nets(NetCampaign("t", TANK, (net,), (spoilt,), vibration="none"))
    reported = {item.code: item for item in found.notices}
    assert "1 of 1500 samples of the force are spikes" in reported["net-record-spikes"].message
    assert "velocity" in reported["net-record-clipped"].message


def test_noise_of_the_reading_at_rest_widens_the_interval():
    """A short zero carries the slow noise of the gauge into the mean: intervals must still cover."""
    rng = np.random.default_rng(91)
    net, rig, hits, ratio = specimen(), Rig(vibration_force=0.0, zero=0.4, slow_noise=0.05), 0, []
    for _ in range(24):
        runs = [
            towed_run(rig, TANK, item, 1.3, 0.4, name=name, rng=rng, ramp=6.0)
            for name, item in (("f", None), ("n", net))
        ]
        runs = [dataclasses.replace(run, zero=(0.0, 0.3), window=(7.0, 18.0)) for run in runs]
        found = measure_nets(NetCampaign("t", TANK, (net,), tuple(runs), vibration="none")).towing[0]
        hits += abs(found.drag - 1.3) < found.drag_half_width
        plain = [dataclasses.replace(run, zero=None, force=run.force - 0.4) for run in runs]
        other = measure_nets(NetCampaign("t", TANK, (net,), tuple(plain), vibration="none")).towing[0]
        ratio.append(found.drag_error / other.drag_error)
    assert hits >= 20
    assert np.mean(ratio) > 1.5


def test_forces_against_the_water_are_refused():
    rng = np.random.default_rng(93)
    net = specimen()
    runs = [towed_run(QUIET, TANK, item, 1.3, 0.4, name=name, rng=rng) for name, item in (("f", None), ("n", net))]
    turned = tuple(dataclasses.replace(run, force=-run.force) for run in runs)
    found = measure_nets(NetCampaign("t", TANK, (net,), turned, vibration="none"))
    (notice,) = [item for item in found.notices if item.code == "net-drag-against"]
    assert notice.severity == "error"
    assert "reverse_force" in notice.remedy
