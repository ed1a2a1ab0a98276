"""Spreading of two-dimensional spectra: kept on reading, the same energy in every sector, seas drawn from it."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.sea.measured_spreading import MeasuredSpreading
from moyai.sea.spectrum_archives import read_archive

FREQUENCY = np.array([0.08, 0.1, 0.13, 0.2])


def spread_of(directions, mean, rng):
    return MeasuredSpreading.of(FREQUENCY, directions, rng.uniform(0.0, 1.0, (4, len(directions))), mean)


@pytest.mark.slow
@pytest.mark.parametrize("directions", [np.arange(0.0, 360.0, 15.0), np.arange(100.0, 220.0, 10.0)])
def test_it_is_a_distribution(directions):
    """One in all, its inverse, its slope, its first moment: on the whole circle and on a sector."""
    rng = np.random.default_rng(3)
    spreading = spread_of(directions, 170.0, rng)
    omega = 2.0 * math.pi * np.array([0.05, 0.08, 0.115, 0.2, 0.4])[:, None]
    grid = np.linspace(-math.pi, math.pi, 72_001)
    middle = 0.5 * (grid[1:] + grid[:-1])
    density = spreading.density(middle, omega)
    step = grid[1] - grid[0]
    assert np.allclose(density.sum(axis=1) * step, 1.0, atol=1e-3)
    assert np.allclose((density * np.cos(middle)).sum(axis=1) * step, spreading.resultant(omega[:, 0]), atol=1e-3)
    assert np.allclose(np.cumsum(density, axis=1) * step, spreading.cumulative(grid[1:], omega), atol=1e-3)
    fraction = rng.uniform(0.001, 0.999, (5, 40))
    assert np.allclose(spreading.cumulative(spreading.quantile(fraction, omega), omega), fraction, atol=1e-12)


def test_energy_stands_where_the_file_has_it():
    """Waves from 300 where the mean is from 310 travel 10 degrees to the left of it."""
    directions = np.arange(0.0, 360.0, 10.0)
    energy = np.zeros((4, 36))
    energy[0, 30], energy[1, 30], energy[1, 33], energy[3, 13] = 1.0, 3.0, 1.0, 2.0
    spreading = MeasuredSpreading.of(FREQUENCY, directions, energy, 310.0)
    omega = 2.0 * math.pi * FREQUENCY
    edges = np.radians([5.0, 15.0, -25.0, -15.0])
    left, all_left, right, all_right = (spreading.cumulative(edge, omega) for edge in edges)
    assert np.allclose((all_left - left)[:2], [1.0, 0.75])
    assert np.allclose((all_right - right)[:2], [0.0, 0.25])
    # on both sides of the back: from 130 degrees, against the mean
    assert np.allclose(spreading.cumulative(np.radians([-175.1, 174.9]), omega[3]), [0.49, 0.5], atol=0.012)
    # where a frequency holds nothing, as the whole sea
    assert np.isclose(all_left[2] - left[2], 4.0 / 7.0)
    with pytest.raises(InputError, match="no energy by directions"):
        MeasuredSpreading.of(FREQUENCY, directions, 0.0 * energy, 310.0)


def test_netcdf_files_are_read_by_what_they_hold(tmp_path):
    """wavespectra's own files are in degrees; its reader of WAVEWATCH III takes them, 7.6 times too low in height."""
    import xarray as xr

    rng = np.random.default_rng(4)
    values = rng.uniform(0.0, 1.0, (2, 3, 4, 12))
    data = xr.Dataset(
        {"efth": (("time", "site", "freq", "dir"), values)},
        {"time": np.array(["2024-01-01", "2024-01-02"], "datetime64[ns]"), "site": [1, 2, 3], "freq": FREQUENCY,
         "dir": np.arange(0.0, 360.0, 30.0)},
    )  # fmt: skip
    data.to_netcdf(tmp_path / "native.nc", engine="h5netcdf")
    archive = read_archive(tmp_path / "native.nc")
    assert archive.format == "wavespectra"
    assert np.allclose(archive.density, values.sum(axis=-1) * 30.0)
    data.rename(efth="height").to_netcdf(tmp_path / "other.nc", engine="h5netcdf")
    with pytest.raises(InputError, match=r"other\.nc holds no spectra that are known here.*it holds .*height"):
        read_archive(tmp_path / "other.nc")


@pytest.mark.parametrize(
    ("heading", "what"),
    [
        ("#YY  MM DD hh mm alpha1_1 (freq_1) alpha1_2 (freq_2) ... >", "mean directions"),
        ("#YY  MM DD hh mm r2_1 (freq_1) r2_2 (freq_2) ... >", "moments of the directions"),
        ("YYYY MM DD hh mm    DIR    SPD    GDR    GSP    GMN", "meteorological observations"),
        ("#YY  MM DD hh mm WDIR WSPD GST  WVHT   DPD   APD MWD   PRES", "meteorological observations"),
    ],
)
def test_other_files_of_ndbc_are_refused_by_name(tmp_path, heading, what):
    (tmp_path / "41010.txt").write_text(f"{heading}\n2020 06 08 03 50 999.0 (0.033) 36.0 (0.038)\n")
    with pytest.raises(InputError, match=rf"41010\.txt holds {what} of NDBC, no spectra"):
        read_archive(tmp_path / "41010.txt")
