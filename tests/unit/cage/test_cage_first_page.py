"""The band of a cage's numbers in the sea: chance of the seed, then the laws; and each limit of a law reported once."""

import numpy as np
import pytest
import xarray as xr

import moyai
from moyai.case.templates import template
from moyai.structures.cage.headlines import _band_in_sea, _chance


def run_of(regular: bool, duration: float = 600.0) -> tuple[xr.Dataset, np.ndarray]:
    time = np.arange(0.0, duration, 0.1)
    series = 100.0 + 20.0 * np.random.default_rng(4).gumbel(size=time.size)
    attrs = {"regular": int(regular), "ramp": 10.0, "period": 6.0}
    return xr.Dataset(coords={"time": time}, attrs=attrs), series


def test_one_seed_carries_the_scatter_of_its_maximum():
    run, series = run_of(regular=False)
    value = float(series[run["time"].values >= 10.0].max())
    band = _band_in_sea(None, "collar_stress", run, value, series)
    assert band.low <= value <= band.high and band.high - band.low > 10.0
    assert band.of.startswith("one seed, scatter of its maximum estimated from")
    # Gumbel's law: the largest of many scatters as one does, 20 pi / sqrt(6) = 25.7; from ten blocks to a third
    assert band.high - band.low <= 3.0 * 20.0 * np.pi / np.sqrt(6.0)


def test_regular_waves_have_no_chance_and_short_records_say_so():
    run, series = run_of(regular=True)
    assert _band_in_sea(None, "offset", run, 1.0, series) is None
    run, series = run_of(regular=False, duration=30.0)
    assert _chance(run, 1.0, series) == (1.0, 1.0, "one seed, too short to tell the scatter of its maximum")


@pytest.mark.slow  # a cage in waves
def test_a_law_out_of_its_range_is_reported_once(tmp_path):
    (tmp_path / "c.yaml").write_text(template("rigid_cage"), encoding="utf-8")
    result = moyai.run(moyai.load_case(tmp_path / "c.yaml"))
    said = [notice for notice in result.notices if notice.severity == "warning"]
    assert [notice.code for notice in said] == ["net-law-choice"]
    assert "the power goes on up to the cap" in said[0].message
