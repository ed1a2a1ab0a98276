"""Damaged files of every kind that is read end in a sound result or in one error of moyai's, never in a traceback.

The seeds are fixed; ``MOYAI_FUZZ_SEED`` sets another, ``MOYAI_FUZZ_COUNT`` the number of files a kind. A failure names
kind and seed: ``python tests/robustness/mutation.py KIND SEED 1`` makes it again.
"""

from __future__ import annotations

import os
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

from mutation import try_damaged  # noqa: E402
from sample_files import KINDS  # noqa: E402

from moyai.core.errors import InputError  # noqa: E402

SEED = int(os.environ.get("MOYAI_FUZZ_SEED", "1000"))
COUNT = os.environ.get("MOYAI_FUZZ_COUNT", "40")
PARTS = 2


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_damage_ends_in_an_error_of_moyai(kind):
    print(f"seed {SEED}")
    assert try_damaged(kind, SEED, 25) == []


@pytest.mark.slow
@pytest.mark.parametrize("part", range(PARTS))
def test_much_damage_ends_in_an_error_of_moyai(part):
    """Several kinds share a process, whose start takes longer than the files of one."""
    kinds = list(KINDS)[part::PARTS]
    print(f"seed {SEED + 10_000}")
    ended = subprocess.run(
        [sys.executable, HERE / "mutation.py", ",".join(kinds), str(SEED + 10_000), COUNT],
        capture_output=True, text=True, check=False, timeout=1200,
    )  # fmt: skip
    sound = [line for kind in kinds for line in (f"begun: {kind}", f"ended: {kind}")]
    assert (ended.returncode, ended.stdout.splitlines(), ended.stderr) == (0, sound, "")


# Failures that were found once, each made here -------------------------------------------------------------


def test_a_matlab_variable_that_states_a_thousand_million_samples(tmp_path):
    """2 kB that state 8 GB."""
    import zlib

    from scipy.io import savemat

    from moyai.records.reading.arrays import read_mat

    file = tmp_path / "a.mat"
    savemat(file, {"level": np.zeros(400)})
    raw = bytearray(file.read_bytes())
    place = raw.index(np.array([1, 400], dtype="<i4").tobytes())
    raw[place : place + 8] = np.array([1, 10**9], dtype="<i4").tobytes()
    # The same claim within a compressed element
    element = zlib.compress(bytes(raw[128:]))
    compressed = bytes(raw[:128]) + np.array([15, len(element)], dtype="<u4").tobytes() + element
    for content in (bytes(raw), compressed):
        file.write_bytes(content)
        with pytest.raises(InputError, match=r"a\.mat states 1,000 MB of 'level'"):
            list(read_mat(file, ["level"], 1000))


def test_a_matlab_element_of_a_type_that_does_not_exist(tmp_path):
    """A compiled reader follows the type past the end of its tables and takes the interpreter down."""
    (file,) = KINDS["matlab_5"].write(tmp_path)
    raw = bytearray(file.read_bytes())
    place = raw.index(np.array([9, 3200], dtype="<u4").tobytes())
    raw[place + 1] = 2
    file.write_bytes(bytes(raw))
    with pytest.raises(InputError, match=f"byte {place} begins an element of type 521, which does not exist"):
        KINDS["matlab_5"].read(tmp_path)


@pytest.mark.parametrize("kind", ["matlab_7_3", "netcdf_4", "bemio"])
def test_an_hdf5_dataset_of_fill_values_that_states_a_thousand_million_samples(tmp_path, kind):
    import h5py

    (file,) = KINDS[kind].write(tmp_path)
    with h5py.File(file, "r+") as stored:
        for name in ("t", "level", "force", "simulation_parameters/w"):
            if name in stored:
                del stored[name]
                shape = (1, 10**9) if kind == "matlab_7_3" else (10**9,)
                stored.create_dataset(name, shape=shape, dtype="f8", chunks=True)
    with pytest.raises(InputError, match=r"states [\d,]+ MB of"):
        KINDS[kind].read(tmp_path)


@pytest.mark.parametrize("size", [0, 2**64 - 16, 2**64 - 1])
@pytest.mark.parametrize("kind", ["netcdf_4", "result", "capytaine"])
def test_a_heap_of_hdf5_that_the_library_does_not_come_back_from(tmp_path, kind, size):
    (file,) = KINDS[kind].write(tmp_path)
    raw = bytearray(file.read_bytes())
    place = raw.index(b"GCOL")
    raw[place + 16 : place + 32] = struct.pack("<QQ", 1 if size else 0, size)
    file.write_bytes(bytes(raw))
    with pytest.raises(InputError, match=f"the heap at byte {place} holds an object of an impossible size"):
        KINDS[kind].read(tmp_path)


def test_an_attribute_of_a_result_whose_type_is_damaged(tmp_path):
    """A word that is neither text nor sequence takes the HDF5 library down, where no checksum stands before it."""
    (file,) = KINDS["result"].write(tmp_path)
    raw = file.read_bytes()
    place = raw.index(b"verdict") + len("verdict")
    begins = place + raw[place : place + 8].index(0x19)  # class 9, variable length, version 1
    file.write_bytes(raw[: begins + 1] + bytes([raw[begins + 1] | 8]) + raw[begins + 2 :])
    with pytest.raises(InputError, match="cannot be read as a result"):
        KINDS["result"].read(tmp_path)


def test_a_line_longer_than_the_csv_module_takes(tmp_path):
    for kind in ("flume", "measured_points", "scatter", "study_rows", "csv"):
        (file,) = KINDS[kind].write(tmp_path)
        lines = file.read_text().splitlines()
        file.write_text("\n".join([*lines[:4], '"' + "1" * 140_000, *lines[4:]]))
        with pytest.raises(InputError, match=r"a\.csv"):
            KINDS[kind].read(tmp_path)


def test_a_file_of_a_buoy_with_a_word_for_a_number_names_its_line(tmp_path):
    (file,) = KINDS["ndbc"].write(tmp_path)
    file.write_text(file.read_text().replace("2.20", "2.2x"))
    with pytest.raises(InputError, match=r"a\.txt, line 3: '2\.2x' is not a number"):
        KINDS["ndbc"].read(tmp_path)


@pytest.mark.parametrize("kind", ["capytaine", "capytaine_3", "result", "bemio"])
def test_files_of_size_zero(tmp_path, kind):
    (file,) = KINDS[kind].write(tmp_path)
    file.write_bytes(b"")
    with pytest.raises(InputError, match=file.name.replace(".", r"\.")):
        KINDS[kind].read(tmp_path)
