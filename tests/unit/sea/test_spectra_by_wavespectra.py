"""Readers of other programs' spectra: the library wavespectra as optional reader, and as peer of our own readers."""

import os
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.sea.spectrum_archives import read_archive

DATA = Path(os.environ.get("MOYAI_SHARED_DATA", Path(__file__).parents[3].parent / "shared" / "data")) / "spectra"
needs_data = pytest.mark.skipif(not DATA.is_dir(), reason="the folder of measured records is absent")


def peer():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return pytest.importorskip("wavespectra", reason="the extra wavespectra is not installed")


@pytest.mark.slow
@needs_data
@pytest.mark.shared_data
@pytest.mark.peer
@pytest.mark.parametrize(
    ("name", "reader", "turned"),
    [
        ("swanfile.spec", "swan", True),
        ("ww3file.nc", "ww3", True),
        ("ww3station.spec", "ww3_station", True),
        ("44004w2000.txt", "ndbc_ascii", False),
        ("41010.data_spec", "ndbc_ascii", False),
    ],
)
def test_our_readers_agree_with_wavespectra(name, reader, turned):
    library = peer()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        other = getattr(library, f"read_{reader}")(str(DATA / name))
        # Of a file with directions: their sum times the width of one [degrees]
        dense = other.efth.sum("dir") * (360.0 / other.sizes["dir"]) if turned else other.efth.squeeze("dir", drop=True)
        bearing = other.spec.dm().values if turned else None
    ours = read_archive(DATA / name)
    theirs = np.sort(np.asarray(dense.values, dtype=float).reshape(-1, ours.frequency.size), axis=0)
    mine = np.sort(ours.density.reshape(-1, ours.frequency.size), axis=0)
    assert np.allclose(ours.frequency, other.freq.values, rtol=1e-6)
    # Some readers keep single precision
    assert np.allclose(mine, theirs, rtol=3e-5, atol=1e-7 * theirs.max())
    if bearing is not None:
        away = (ours.direction.ravel() - np.asarray(bearing).ravel() + 180.0) % 360.0 - 180.0
        assert np.abs(away).max() < 0.35


@needs_data
@pytest.mark.shared_data
@pytest.mark.parametrize(
    ("name", "kind", "heights", "bearings"),
    [
        # Stated by the buoy itself, in the same file
        (
            "spotter_20180214.json",
            "spotter",
            [1.62, 1.67, 1.60, 2.43, 2.39, 2.20, 2.28, 2.32],
            [349.21, 355.16, 6.85, 295.79, 285.60, 287.57, 285.67, 287.82],
        ),
        ("buoy}2024-09-09T01h15Z.spt", "datawell", [0.85], None),
    ],
)
def test_buoys_that_only_wavespectra_knows_have_the_heights_that_they_state(name, kind, heights, bearings):
    peer()
    archive = read_archive(DATA / name)
    assert archive.format == kind
    assert np.allclose(archive.significant_height()[:, 0], heights, rtol=4e-3)
    if bearings is not None:
        assert np.allclose(archive.direction[:, 0], bearings, atol=0.1)
    assert archive.spectrum(0).significant_height == pytest.approx(heights[0], rel=6e-3)


@needs_data
@pytest.mark.shared_data
def test_directional_and_plain_records_of_one_buoy_agree():
    peer()
    turned, plain = (read_archive(DATA / f"triaxys.{name}") for name in ("DIRSPEC", "NONDIRSPEC"))
    assert turned.format == plain.format == "triaxys"
    assert turned.significant_height()[0, 0] == pytest.approx(plain.significant_height()[0, 0], rel=0.01)
    assert np.isfinite(turned.direction).all() and np.isnan(plain.direction).all()


@pytest.mark.parametrize("head", ["TRIAXYS BUOY DATA REPORT\n", "nothing of the kind\n1 2 3\n"])
def test_without_the_library_one_message_names_the_extra(tmp_path, monkeypatch, head):
    file = tmp_path / "buoy.txt"
    file.write_text(head, encoding="utf-8")
    monkeypatch.setitem(sys.modules, "wavespectra", None)
    with pytest.raises(InputError, match="wavespectra") as caught:
        read_archive(file)
    assert 'pip install "moyai[wavespectra]"' in str(caught.value)


@pytest.mark.parametrize(
    "text", ["", "nothing\n1 2\n", '{"data": 3}', "TRIAXYS\n1 2 3\n", '{"spotterId": 1}', "\x00\x01\x02"]
)
def test_files_without_spectra_are_refused_in_one_sentence(tmp_path, text):
    peer()
    for name in ("file.txt", "file.spt"):
        (tmp_path / name).write_text(text, encoding="utf-8")
        with pytest.raises(InputError, match=r"file\.(txt|spt)"):
            read_archive(tmp_path / name)
