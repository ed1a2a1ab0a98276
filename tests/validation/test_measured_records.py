"""Measured records worked off by the examples, against what their sources say.

Sources: Datawell Waverider of July 2005 with the buoy's own results; Nortek AWAC burst of 2008; NOAA PORTS s08010;
flume probes of the WaveLabX and MHKiT repositories; free decay of the IEA OES Task 10 sphere in six programs
(simulated). Reference figures are those of the shared data's README unless said.
"""

import importlib.util
import math
import sys
from pathlib import Path

import numpy as np
import pytest

pytestmark = pytest.mark.shared_data
EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "records"


@pytest.fixture
def example(shared_data, monkeypatch):
    """Import an example by its name, reading the shared folder."""
    monkeypatch.setenv("MOYAI_SHARED_DATA", str(shared_data))
    monkeypatch.setattr(sys, "path", [str(EXAMPLES), *sys.path])

    def load(name):
        spec = importlib.util.spec_from_file_location(f"records_{name}", EXAMPLES / f"{name}.py")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module

    return load


@pytest.mark.slow
@pytest.mark.parametrize("hour", ["00h00", "00h30", "12h00", "18h30"])
def test_waverider(example, hour):
    """Zero crossing within the buoy's own dropping of a few waves; its direction within 30 degrees.

    The spectral file is stamped 18 minutes into the half hour and does not cover the same samples: heights within 7 %.
    """
    module = example("waverider")
    ours = module.analyse(hour)
    crossing = [float(cell) for cell in module.own_results("hiw")[hour][2:]]
    spectral = [float(cell) for cell in module.own_results("his")[hour][1:6]]
    assert ours["maximum_height"] == pytest.approx(crossing[0] / 100.0, abs=1e-9)
    assert ours["tenth_height"] == pytest.approx(crossing[2] / 100.0, rel=2.5e-3)
    assert ours["third_height"] == pytest.approx(crossing[4] / 100.0, rel=1e-2)
    assert ours["third_period"] == pytest.approx(crossing[5], rel=1e-2)
    assert abs(ours["count"] - crossing[9]) <= 4
    assert ours["spectral_height"] == pytest.approx(spectral[4] / 100.0, rel=0.07)
    assert ours["period_m02"] == pytest.approx(spectral[3], rel=0.04)
    assert abs((ours["bearing"] - spectral[1] + 180.0) % 360.0 - 180.0) < 30.0
    assert abs((ours["entropy_bearing"] - ours["bearing"] + 180.0) % 360.0 - 180.0) < 12.0
    assert ours["spread"] == pytest.approx(spectral[2], abs=7.0)
    assert ours["flagged"] == 0


def test_awac_burst(example):
    """The surface from the pressure, wave by wave, against the acoustic distance: two instruments in one."""
    found = example("awac_burst").analyse()
    assert found["agreements"]["distance 1"].correlation > 0.975
    assert found["agreements"]["distance 1"].slope == pytest.approx(1.0, abs=0.06)
    assert found["heights"]["distance 1, 4 std as recorded"] == pytest.approx(1.57, abs=0.01)
    assert found["heights"]["pressure as head"] < 0.75 * found["heights"]["from pressure"]
    assert found["heights"]["from pressure"] == pytest.approx(found["heights"]["distance 1"], rel=0.05)
    turn = math.remainder(found["moments"]["mean_heading"] - found["entropy"]["mean_heading"], 2.0 * math.pi)
    assert abs(turn) < math.radians(8.0)


def test_eighteen_months_of_current(example):
    found = example("currents").analyse_station()
    assert found["count"] == 18890
    assert found["mean_speed"] == pytest.approx(0.478, abs=5e-4)
    assert found["largest_speed"] == pytest.approx(1.325)
    assert found["longest_gap_days"] == pytest.approx(49.0, abs=0.5)
    ellipses = {ellipse.name: ellipse for ellipse in found["fit"].ellipses}
    # San Francisco Bay is a mixed tide: M2 leads, K1 about a third of it
    assert ellipses["M2"].major == max(ellipse.major for ellipse in ellipses.values())
    assert 0.25 < ellipses["K1"].major / ellipses["M2"].major < 0.4
    assert abs(ellipses["M2"].minor) < 0.1 * ellipses["M2"].major
    assert found["fit"].explained > 0.9
    assert found["explained_elsewhere"] > 0.88
    assert found["flood"] > 0.0 > found["ebb"]


@pytest.mark.slow
def test_profilers(example):
    module = example("currents")
    mean, top = module.profile("Sig1000_tidal.nc", None)
    assert math.hypot(*mean.depth_mean) == pytest.approx(0.34, abs=0.02)
    assert np.isnan(mean.x[mean.z > top]).all()
    assert 0.05 < mean.exponent < 0.25
    other, _ = module.profile("AWAC_test01.nc", None)
    assert math.hypot(*other.depth_mean) == pytest.approx(0.71, abs=0.08)


def test_flume_probes(example):
    found = example("reflection").analyse()
    assert found["period"] == pytest.approx(1.333, abs=1e-3)
    assert found["waves"] == 134
    assert found["amplitudes"] * 1000.0 == pytest.approx([12.0, 12.4, 12.1], abs=0.06)
    assert found["reflection"] == pytest.approx(0.03, abs=0.005)
    assert found["residual"] == pytest.approx(0.04, abs=0.006)
    # The noise of the probes hides so little reflection: with it taken off nothing is left
    assert found["broad"] < found["reflection_error"]


def test_faulty_probes(example):
    quality = example("reflection").faulty()
    kinds = {(finding.channel, finding.kind) for finding in quality.findings}
    assert {("probe1", "out of range"), ("probe3", "out of range"), ("probe3", "missing")} <= kinds
    assert quality.counts["probe3"]["missing"] == 11
    assert quality.record.notices[0].code == "time-order"
    values = quality.record["probe1"]
    assert np.nanmin(values) == pytest.approx(-0.999)  # flagged, not removed


@pytest.mark.slow
def test_decay_in_six_programs(example):
    """Periods within 1.5 % of the README's (which used other extremes); second peaks to its last digit."""
    found = example("decay").analyse()
    periods = [4.29, 4.39, 4.40, 4.37, 4.31, 4.34]
    peaks = [0.651, 0.631, 0.632, 0.637, 0.641, 0.636]
    for fit, period, peak in zip(found.values(), periods, peaks, strict=True):
        assert fit.decay.period == pytest.approx(period, rel=0.012)
        extremes = fit.decay.extremes
        second = extremes[1] if extremes[0] < 0.99 else extremes[2]
        assert second == pytest.approx(peak, abs=6e-4)
        assert 0.07 < fit.decay.damping_ratio < 0.1
