"""Files of SWAN, WAVEWATCH III and NDBC against what their own tables say, and small files written by hand."""

import os
from pathlib import Path

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.sea.spectrum_archives import read_archive

DATA = Path(os.environ.get("MOYAI_SHARED_DATA", Path(__file__).parents[3].parent / "shared" / "data")) / "spectra"
needs_data = pytest.mark.skipif(not DATA.is_dir(), reason="the folder of measured records is absent")


@needs_data
@pytest.mark.shared_data
def test_swan_agrees_with_the_table_of_the_same_run():
    archive = read_archive(DATA / "swanfile.spec")
    rows = [line.split() for line in (DATA / "swanfile.tab").read_text().splitlines() if line[:2] == "20"]
    assert archive.time[0] == "2016-10-11T00:00" and len(archive.time) == len(rows) == 5
    # The table holds the high-frequency tail that the file leaves out
    assert np.allclose(archive.significant_height()[:, 0], [float(row[1]) for row in rows], rtol=4e-3)
    assert np.allclose(archive.direction[:, 0], [float(row[2]) for row in rows], atol=0.2)


@needs_data
@pytest.mark.shared_data
@pytest.mark.parametrize(
    ("name", "times", "places", "heights", "tolerance"),
    [
        ("44004w2000.txt", 3, 1, [1.29, 1.75, 1.73], 6e-3),
        ("ww3file.nc", 9, 2, [0.76, 0.84, 0.76], 3e-2),
    ],
)
def test_heights_are_those_stated_for_the_files(name, times, places, heights, tolerance):
    archive = read_archive(DATA / name)
    assert (len(archive.time), len(archive.place)) == (times, places)
    assert np.allclose(archive.significant_height()[:3, 0], heights, rtol=tolerance)


@needs_data
@pytest.mark.shared_data
def test_the_buoys_week_has_its_range_and_is_sorted_in_time():
    archive = read_archive(DATA / "41010.data_spec")
    height = archive.significant_height()[:, 0]
    assert len(archive.time) == 149 and list(archive.time) == sorted(archive.time)
    assert round(float(height.min()), 2) == 0.75 and round(float(height.max()), 2) == 2.99
    assert np.isfinite(archive.direction).all()


SWAN = """SWAN   1
$ a comment
LONLAT
     1
  135.2  34.4
AFREQ
    3
  0.1
  0.2
  0.3
{kind}
    4
    0.
   90.
  180.
  270.
QUANT
     1
VaDens
m2/Hz/degr
  -99.0
FACTOR
  0.5
{rows}
"""


def swan(tmp_path, kind="NDIR", rows="0 0 0 0\n0 8 0 0\n0 0 0 0"):
    path = tmp_path / "a.spec"
    path.write_text(SWAN.format(kind=kind, rows=rows), encoding="utf-8")
    return read_archive(path)


def test_the_factor_the_step_and_the_convention_of_directions_of_swan(tmp_path):
    archive = swan(tmp_path)
    assert archive.density[0, 0].tolist() == [0.0, 0.5 * 8 * 90.0, 0.0]
    assert archive.direction[0, 0] == pytest.approx(90.0)
    # Cartesian: towards 90 degrees from east is towards north, so the waves come from the south
    assert swan(tmp_path, kind="CDIR").direction[0, 0] == pytest.approx(180.0)


def test_spectra_keep_their_energy(tmp_path):
    spectrum = swan(tmp_path).spectrum(0)
    assert spectrum.significant_height == pytest.approx(4.0 * np.sqrt(360.0 * 0.1), rel=1e-9)


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("SWAN 1\nAFREQ\n 3\n 0.1\n 0.2\n", "too early"),
        ("SWAN 1\nAFREQ\n x\n", "whole number"),
        ("SWAN 1\nODD\n", "unknown key 'ODD'"),
        ("a,b\n1,2\n", "no file of spectra"),
        ("#YY MM DD hh mm Sep\n2020 01 01 00 00 9 0.1 (0.1) 0.2 (0.2)\n2020 01 01 01 00 9 0.1 (0.1)\n", "line 3"),
    ],
)
def test_damaged_files_are_reported_by_line(tmp_path, text, word):
    path = tmp_path / "x.spec"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=word.replace("(", r"\(")):
        read_archive(path)


def test_missing_records_are_reported(tmp_path):
    archive = swan(tmp_path, rows="0 0 0 0\n0 0 0 0\n0 0 0 0")
    with pytest.raises(InputError, match="no energy"):
        archive.spectrum(0)
    with pytest.raises(InputError, match="0 to 0"):
        archive.spectrum(3)
    with pytest.raises(InputError, match="no such file"):
        read_archive(tmp_path / "none")
