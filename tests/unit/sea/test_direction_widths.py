"""The part of the circle that each direction of a spectrum stands for."""

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.sea.direction_widths import direction_widths
from moyai.sea.spectrum_archives import read_archive


def test_whole_circles_and_sectors_in_any_order():
    assert np.allclose(direction_widths(np.arange(36) * 10.0 + 5.0), 10.0)
    sector = np.arange(-90.0, 91.0, 10.0)
    assert np.allclose(direction_widths(sector[::-1]), 10.0)
    # Uneven: 350 stands for half of 10 and half of 20, and so on; the whole is the circle
    uneven = np.array([0.0, 20.0, 50.0, 90.0, 130.0, 170.0, 210.0, 250.0, 290.0, 330.0, 350.0])
    widths = direction_widths(uneven)
    assert widths.sum() == pytest.approx(360.0) and widths[-1] == pytest.approx(15.0)
    with pytest.raises(InputError, match="twice"):
        direction_widths(np.array([0.0, 90.0, 360.0]))


def swan(folder, directions, table):
    lines = ["SWAN   1", "LOCATIONS", "1", "0.0 0.0", "AFREQ", "3", "0.1", "0.15", "0.2", "NDIR", str(directions.size)]
    lines += [f"{angle:g}" for angle in directions] + ["QUANT", "1", "VaDens", "m2/Hz/degr", "-99.0", "FACTOR", "1.0"]
    lines += [" ".join(f"{value:.8f}" for value in row) for row in table]
    (folder / "sector.spec").write_text("\n".join(lines) + "\n")
    return read_archive(folder / "sector.spec")


def test_a_sector_has_the_energy_of_the_same_sea_all_round(tmp_path):
    """A sea within 180 degrees, written with and without the empty half."""
    whole = np.arange(36) * 10.0
    spreading = np.cos(np.radians(whole)).clip(0.0) ** 4
    density = np.array([0.5, 2.0, 0.7])
    table = density[:, None] * spreading / (spreading.sum() * 10.0)
    inside = spreading > 1e-12
    heights = []
    for chosen in (np.full(36, True), inside):
        archive = swan(tmp_path, whole[chosen], table[:, chosen])
        heights.append(archive.significant_height()[0, 0])
        assert abs((archive.direction[0, 0] + 180.0) % 360.0 - 180.0) < 1e-6
    expected = 4.0 * np.sqrt(np.trapezoid(density, [0.1, 0.15, 0.2]))
    assert heights == pytest.approx([expected, expected], rel=1e-5)


def test_wavewatch_text_of_a_sector(tmp_path):
    """Eight directions 15 degrees apart, 1 m2/(Hz rad) each: the density is 8 times 15 degrees in radians."""
    angles = np.radians(np.arange(8) * 15.0)
    lines = ["'WAVEWATCH III SPECTRA' 2 8 1 'grid'", " 0.1 0.2", " ".join(f"{angle:.8f}" for angle in angles)]
    lines += ["20200101 000000", "'point' 34.0 135.0 20.0 0.0 0.0 0.0 0.0", " ".join(["1.0"] * 16)]
    (tmp_path / "a.spc").write_text("\n".join(lines))
    assert np.allclose(read_archive(tmp_path / "a.spc").density, np.radians(120.0), rtol=1e-6)


def test_a_meteorological_file_of_ndbc_is_refused_by_name(tmp_path):
    file = tmp_path / "46042h2020.txt"
    heading = "#YY  MM DD hh mm WDIR WSPD GST  WVHT   DPD\n#yr mo dy hr mn degT m/s m/s m sec\n"
    file.write_text(heading + "2020 1 1 0 0 10 5 6 2 9\n")
    with pytest.raises(InputError, match="meteorological observations of NDBC"):
        read_archive(file)
