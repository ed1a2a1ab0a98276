"""Numbers for no value, gauges that stand still, reversed gauges and plateaus: reported in surveys and nets."""

import dataclasses

import numpy as np
import pytest

from moyai.case.measured import read_points
from moyai.core import quantities
from moyai.core.errors import InputError
from moyai.core.stand_ins import find_stand_ins
from moyai.morison.nets import Net
from moyai.records import load_survey, run_survey
from moyai.records.nets.campaign import NetCampaign, measure_nets
from moyai.records.nets.runs import Specimen, Tank
from moyai.records.nets.synthesis import Rig, wave_run
from moyai.report.writer import write_report
from moyai.series.plateaus import find_plateaus

SURVEY = """
moyai: 1
title: t
loggers:
- name: a
  file: a.csv
  time: {column: t}
  channels:
  - {name: eta, column: eta, kind: elevation}
  - {name: F, column: F, kind: tension}
blocks: {length: 5 min}
waves: {channels: [eta]}
tensions: {waves: eta, lines: [{channel: F}]}
"""
TIME = np.arange(0.0, 900.0, 0.1)


def surveyed(folder, elevation, tension):
    table = np.column_stack([TIME, elevation, tension])
    np.savetxt(folder / "a.csv", table, "%.4f", ",", header="t [s],eta [m],F [kN]", comments="")
    (folder / "s.yaml").write_text(SURVEY, encoding="utf-8")
    return run_survey(load_survey(folder / "s.yaml"))


@pytest.fixture
def sea():
    rng = np.random.default_rng(7)
    frequency = rng.uniform(0.1, 0.2, 40)
    elevation = 0.15 * np.cos(2.0 * np.pi * np.outer(TIME, frequency) + rng.uniform(0.0, 6.28, 40)).sum(axis=1)
    return elevation, 20.0 + 8.0 * np.maximum(elevation, 0.0) + 0.2 * rng.standard_normal(TIME.size)


def codes(result):
    return {notice.code: notice.message for notice in result.notices}


def test_numbers_for_no_value_are_named_with_their_rows(tmp_path, sea):
    elevation, tension = sea
    assert not {"record-stand-in", "tension-sign"} & set(codes(surveyed(tmp_path, elevation, tension)))
    tension[500:540] = -99.0
    message = codes(surveyed(tmp_path, elevation, tension))["record-stand-in"]
    assert message == (
        "a.csv, column 'F' holds 40 values of -99 far outside of all others, the first in line 502; if it means "
        "'no value', name it under 'missing'"
    )


def test_numbers_that_only_look_like_no_value_are_kept():
    assert find_stand_ins(np.arange(0.0, 120.0)) == []
    assert find_stand_ins(np.array([98.0, 99.0, 100.0, 101.0])) == []
    assert find_stand_ins(np.array([1.0, 2.0, 9999.0, np.nan, 9999.0, -99.9])) == [(-99.9, 1, 5), (9999.0, 2, 2)]


def test_numbers_for_no_value_in_tests_of_members_nets_and_snaps_are_refused(tmp_path):
    time = np.arange(0.0, 10.0, 0.1)
    force = np.sin(time)
    columns, kinds = {"t": "time", "f": "force"}, {"t": quantities.TIME, "f": quantities.FORCE}
    for sign, unit in ((-99.0, "N"), (9999.0, "kgf"), (-99.9, "kN")):
        force[40] = sign
        path = tmp_path / "a.csv"
        np.savetxt(path, np.column_stack([time, force]), "%.4f", ",", header=f"t [s],f [{unit}]", comments="")
        with pytest.raises(InputError, match=rf"column 'f' holds 1 value of {sign:g} far outside of all others"):
            read_points(path, columns, "record", kinds)
        assert len(read_points(path, columns, "record")["force"]) == 100


@pytest.mark.parametrize("zeroed", [False, True])
def test_a_reversed_tension_gauge_is_reported(tmp_path, sea, zeroed):
    elevation, tension = sea
    result = surveyed(tmp_path, elevation, -(tension - 20.0 * zeroed))
    assert "a line does not push: reverse the channel with 'scale: -1'" in codes(result)["tension-sign"]
    assert "tension-sign" not in codes(surveyed(tmp_path, elevation, tension - 20.0 * zeroed))


def test_a_dead_gauge_leaves_the_tensions_without_waves(tmp_path, sea):
    result = surveyed(tmp_path, np.ones(TIME.size), sea[1])
    assert result.status == "converged"
    assert "eta shows no waves in a block: no tensions of waves" in codes(result)["tension-waves"]
    tensions = result.tree["tensions"]
    np.testing.assert_allclose(tensions["steady"], 20e3, rtol=0.1)
    assert np.isnan(tensions["maximum"]).all()
    assert write_report(result, tmp_path)


def net_waves(**changes):
    tank, net = Tank(1000.0, 1.14e-6, 9.81, 0.45, -0.2), Net.from_solidity(1.4e-3, 0.22)
    specimen, rng = Specimen("A", net, 0.066, 0.066 * net.listed), np.random.default_rng(83)
    rig = Rig(vibration_force=0.0)
    run = wave_run(rig, tank, specimen, 1.4, 2.0, name="n", height=0.08, period=1.25, rng=rng)
    spoilt = dataclasses.replace(run, **{name: factor * getattr(run, name) for name, factor in changes.items()})
    return codes(measure_nets(NetCampaign("t", tank, (specimen,), (spoilt,), vibration="none")))


def test_reversed_gauges_and_wrong_units_of_nets_in_waves_are_reported():
    assert not {"net-coefficient-negative", "net-velocity"} & set(net_waves())
    assert "C_D of net A is -" in net_waves(force=-1.0)["net-coefficient-negative"]
    message = net_waves(velocity=100.0)["net-velocity"]
    # deep water: the crest moves at g T / 2 pi = 1.95 m/s
    assert "is faster than the wave, whose crest moves at 1.95 m/s at most" in message


def test_plateaus_are_what_rounding_does_not_make():
    time = np.arange(0.0, 60.0, 0.02)
    wave = np.sin(2.0 * np.pi * time / 3.0)
    for steps in (10, 40, 1000):
        assert find_plateaus(np.round(wave * steps) / steps) == []
    tops = find_plateaus(np.minimum(np.round(wave, 3), 0.8))
    # above 0.8 for (pi - 2 asin 0.8) / 2 pi of 3 s
    assert [(one.word, one.level, one.count) for one in tops] == [("top", 0.8, 20)]
    assert tops[0].longest == pytest.approx((np.pi - 2.0 * np.arcsin(0.8)) / (2.0 * np.pi) * 150.0, abs=2.0)
    assert find_plateaus(np.ones(50)) == [] and find_plateaus(np.full(5, np.nan)) == []
