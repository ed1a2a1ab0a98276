"""Measured spectra from tables and files: units, formats, and one clear message for every fault."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.sea import spectra

FREQUENCY = np.linspace(0.05, 0.5, 46)
DENSITY = 3.0 * np.exp(-(((FREQUENCY - 0.12) / 0.03) ** 2))


def test_units_of_a_table():
    spectrum = spectra.from_table(FREQUENCY, DENSITY)
    area = np.sum(0.5 * (DENSITY[1:] + DENSITY[:-1]) * np.diff(FREQUENCY))
    assert spectrum.significant_height == pytest.approx(4.0 * math.sqrt(area), rel=1e-12)
    assert spectrum.peak_period == pytest.approx(1.0 / 0.12, rel=1e-9)


@pytest.mark.parametrize(
    ("separator", "head"),
    [(",", "f,S\n"), (";", "# a buoy\nf;S\n"), ("\t", ""), (" ", "% comment\n\n"), (" , ", '"f","S"\n')],
)
def test_formats_of_a_file(tmp_path, separator, head):
    file = tmp_path / "spectrum.txt"
    file.write_text(head + "".join(f"{f!r}{separator}{s!r}\n" for f, s in zip(FREQUENCY.tolist(), DENSITY.tolist())))
    spectrum = spectra.from_file(file)
    np.testing.assert_allclose(spectrum.omega, 2.0 * math.pi * FREQUENCY, rtol=1e-15)
    np.testing.assert_allclose(spectrum.density, DENSITY / (2.0 * math.pi), rtol=1e-15)


def test_columns_by_name_and_number(tmp_path):
    file = tmp_path / "many.csv"
    rows = "".join(f"{i},{s!r},{f!r}\n" for i, (f, s) in enumerate(zip(FREQUENCY.tolist(), DENSITY.tolist())))
    file.write_text("bin,density,frequency\n" + rows)
    named = spectra.from_file(file, frequency_column="frequency", density_column="density")
    numbered = spectra.from_file(file, frequency_column=3, density_column=2)
    np.testing.assert_array_equal(named.omega, numbered.omega)
    with pytest.raises(InputError, match=r"no column 'hz'.*bin, density, frequency"):
        spectra.from_file(file, frequency_column="hz")
    with pytest.raises(InputError, match=r"no column 7.*1 to 3"):
        spectra.from_file(file, frequency_column=7)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "empty"),
        ("f,S\n", "empty"),
        ("0.1,1\n", "one row"),
        ("0.1,1\n0.3,2\n0.2,1\n", "row 3: frequency does not increase: 0.2"),
        ("0.1,1\n0.2,2\n0.2,1\n", "row 3: frequency does not increase"),
        ("f,S\n0.1,1\n0.2,-2\n0.3,1\n", "row 3: density is negative: -2"),
        ("-0.1,1\n0.2,2\n", "row 1: frequency is negative"),
        ("0.1,1\n0.2,nan\n0.3,1\n", "row 2: density is not a number"),
        ("0.1,1\n\n0.2,inf\n0.3,1\n", "row 3: density is not a number"),
        ("0.1,1\n0.2\n", "row 2: .* does not hold"),
        ("0.1,1\n0.2,x\n", "row 2: .* does not hold"),
        ("0,1\n0.2,1\n", "row 1: density at frequency 0"),
        ("0.1,0\n0.2,0\n", "no energy"),
        ("0.1,1\n0.3,-2\n0.2,nan\n", r"row 2: .*\(2 faulty rows in all\)"),
    ],
)
def test_every_fault_has_one_message_with_its_row(tmp_path, text, message):
    file = tmp_path / "bad.csv"
    file.write_text(text)
    with pytest.raises(InputError, match=message) as caught:
        spectra.from_file(file)
    assert str(file) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_unreadable_files(tmp_path):
    with pytest.raises(InputError, match="cannot read"):
        spectra.from_file(tmp_path / "absent.csv")
    with pytest.raises(InputError, match="cannot read"):
        spectra.from_file(tmp_path)
    binary = tmp_path / "binary.csv"
    binary.write_bytes(b"\xff\xfe\x00\x81")
    with pytest.raises(InputError, match="not a text file"):
        spectra.from_file(binary)


def test_columns_of_unequal_length():
    with pytest.raises(InputError, match="equal length"):
        spectra.from_table([0.1, 0.2, 0.3], [1.0, 2.0])
