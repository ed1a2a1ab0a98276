"""The band of a cage's numbers in the sea: chance of the seed, then the laws; and each limit of a law reported once."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from kept_runs import kept_run

from moyai.case.builder import build
from moyai.case.reader import case_of
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import ConvergenceError
from moyai.core.headline import Band, Criterion, Headline, judge
from moyai.series.block_maxima import maximum_of
from moyai.structures.cage.bands import TOO_SHORT, LevelState, alone, band_in_sea, chance
from moyai.structures.cage.flexible.sensitivity import COARSER, STRESS, VOLUME_IN_CURRENT, tension_of
from moyai.structures.cage.headlines import _mesh_factors, _tension, _with_mesh
from moyai.structures.cage.run import run


def run_of(regular: bool, duration: float = 600.0) -> tuple[xr.Dataset, np.ndarray]:
    time = np.arange(0.0, duration, 0.1)
    series = 100.0 + 20.0 * np.random.default_rng(4).gumbel(size=time.size)
    attrs = {"regular": int(regular), "ramp": 10.0, "period": 6.0}
    return xr.Dataset(coords={"time": time}, attrs=attrs), series


def test_one_seed_carries_the_scatter_of_its_maximum():
    run, series = run_of(regular=False)
    value = float(series[run["time"].values >= 10.0].max())
    band = band_in_sea(None, "collar_stress", run, value, series)
    assert band.low <= value <= band.high and band.high - band.low > 10.0
    assert band.of.startswith("90 of 100 seeds, estimated from")


def test_the_band_of_one_seed_holds_nine_of_ten_others():
    """Peaks that know nothing of each other: the largest of a record is as it is drawn."""
    rng, time = np.random.default_rng(9), np.arange(0.0, 600.0, 1.0)
    records = 100.0 + 20.0 * rng.gumbel(size=(300, time.size))
    ranges = [maximum_of(time, record, 6.0).range for record in records]
    inside = np.mean([np.mean((low <= records.max(axis=1)) & (records.max(axis=1) <= high)) for low, high in ranges])
    assert inside == pytest.approx(0.9, abs=0.05)


def test_regular_waves_have_no_chance_and_short_records_say_so():
    run, _ = run_of(regular=True)
    series = np.sin(2.0 * np.pi * run["time"].values / 6.0)
    assert band_in_sea(None, "largest_offset", run, 1.0, series) is None
    run, series = run_of(regular=False, duration=30.0)
    assert chance(run, 1.0, series) == (1.0, 1.0, "one seed, too short to show the scatter of its maximum")


@pytest.mark.slow  # a cage in waves
def test_a_law_out_of_its_range_is_reported_once():
    result = kept_run(template("rigid_cage"))
    said = [notice for notice in result.notices if notice.severity == "warning"]
    assert [notice.code for notice in said] == ["net-law-choice"]
    assert "the power law is extrapolated up to the cap" in said[0].message


def test_a_coarser_mesh_widens_the_band_both_ways():
    values = [[100.0, 6.0e6, 0.60], [95.0, 4.8e6, 0.63]]
    group = xr.Dataset(
        {"value": (("variant", "quantity"), values)},
        coords={"variant": ["as given", COARSER], "quantity": [tension_of("bridle"), STRESS, VOLUME_IN_CURRENT]},
    )
    factors = _mesh_factors({"/SWL/sensitivity/sea": group, "/SWL/time/sea/wave 1": xr.Dataset()})
    assert factors[STRESS] == pytest.approx((0.8, 1.2)) and factors[VOLUME_IN_CURRENT] == pytest.approx((0.95, 1.05))
    stress = _with_mesh(Headline("collar_stress", "stress", 6e6, "Pa", band=Band(5e6, 7e6, "laws")), factors)
    assert (stress.band.low, stress.band.high) == pytest.approx((4e6, 8.4e6))
    assert stress.band.of == "laws; mesh ±20 %, the change of a coarser one"
    tension = _with_mesh(Headline("line_tension", "tension", 100.0, "N", "bridle 3b, sea"), factors)
    assert (tension.band.low, tension.band.high) == pytest.approx((95.0, 105.0))
    # nothing was run for frame ropes: the number stays as it is
    assert _with_mesh(Headline("line_tension", "tension", 100.0, "N", "frame 1, sea"), factors).band is None


@pytest.mark.slow  # a cage in waves on three meshes
def test_the_band_holds_the_answer_of_a_finer_mesh(monkeypatch):
    """The template with twice the mesh: every number with a band of the mesh lies inside the band of the coarse one."""
    text = template("cage").replace("mesh: {around: 32, down: 6, bottom: 4}", "mesh: {MESH}")
    text = text.replace("current_speeds: [0.25 m/s, 0.75 m/s], ", "")

    def no_mesh(*_):
        raise ConvergenceError("not run")

    numbers = []
    for mesh in ("around: 24, down: 5, bottom: 3", "around: 48, down: 10, bottom: 6"):
        problem = build(case_of(parse_yaml(text.replace("MESH", mesh), "c.yaml"), Path("c.yaml")))
        if numbers:
            # the finer one needs no band
            problem = replace(problem, settings=replace(problem.settings, other_laws=False))
            monkeypatch.setattr("moyai.structures.cage.flexible.run.mesh_dataset", no_mesh)
        result = run(problem)
        numbers.append({item.name: item for item in result.headlines})
        assert result.status == "converged" and "not_judged" in numbers[-1]
    coarse, fine = numbers
    for name in ("volume_left", "drag", "line_tension", "collar_stress", "anchor_tension", "offset"):
        assert "mesh" in coarse[name].band.of, name
        assert coarse[name].band.low <= fine[name].value <= coarse[name].band.high, name
    # the pull on an anchor is reported in its two parts
    assert coarse["anchor_tension"].detail.startswith("upwards ")


def test_each_line_carries_the_band_of_its_own_tension():
    """Two lines under two laws: the one nearest to its breaking load is not the one that pulls hardest."""
    statics = xr.Dataset(
        {
            "line_tension_maximum": (("current_speed", "line"), [[5.0e3, 11.0e3]]),
            "utilisation": (("current_speed", "line"), [[0.05, 0.04]]),
        },
        coords={"current_speed": [0.5], "line": ["bridle", "anchor"]},
    )
    laws = xr.Dataset(
        {
            "law_line_tension": (("law", "line"), [[5.0e3, 11.0e3], [4.0e3, 15.0e3]]),
            "law_line_tension_maximum": ("law", [11.0e3, 15.0e3]),
        },
        coords={"law": ["own", "other"], "line": ["bridle", "anchor"]},
    )
    state = LevelState("SWL", 0.5, 0, xr.Dataset(), statics, laws)
    tensions, used = _tension([state], [])
    assert (tensions[0].value, tensions[0].band.low, tensions[0].band.high) == (5.0e3, 4.0e3, 5.0e3)
    assert (used[0].value, used[0].band.low, used[0].band.high) == pytest.approx((0.05, 0.04, 0.05))
    # under the other law the anchor line comes nearest to its breaking load: it is judged too
    judged = [item for item in used if not item.shown]
    assert [item.where.split(",")[0] for item in judged] == ["anchor"]
    assert judged[0].band.high == pytest.approx(0.04 * 15.0 / 11.0)
    assert state.moved("line_tension_maximum", 6.0e3, 6.0e3, 1)[:2] == (6.0e3, 10.0e3)


def test_a_seed_too_short_for_its_scatter_proves_no_limit():
    """Of a pull more is possible, of a volume less: neither keeps its limit."""
    band = Band(38e3, 40e3, f"{TOO_SHORT}; laws")
    pull = alone(Headline("anchor_tension", "pull", 39e3, "N", band=band))
    volume = alone(Headline("volume_left", "volume", 0.7, "1", band=Band(0.6, 0.7, TOO_SHORT)))
    assert (pull.bound, volume.bound) == ("at least", "at most")
    limits = (
        Criterion("greatest_anchor_load", "anchor_tension", 41e3, "at most", "case file"),
        Criterion("least_volume_left", "volume_left", 0.5, "at least", "case file"),
    )
    assert [item.outcome for item in judge((pull, volume), limits, computed=True).judgements] == ["not judged"] * 2
    long = Headline("anchor_tension", "pull", 39e3, "N", band=Band(38e3, 40e3, "90 of 100 seeds; laws"))
    assert alone(long) is long
