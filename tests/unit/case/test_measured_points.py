"""Measured points: names and units in the header, faults with row and column."""

import math

import pytest
from case_files import changed, faults, read

from moyai.case.builder import build
from moyai.case.measured import read_points
from moyai.core.errors import InputError


def points(tmp_path, text, columns=None, encoding="utf-8"):
    path = tmp_path / "points.csv"
    path.write_bytes(text.encode(encoding))
    return read_points(path, columns or {}, "measured.file")


def test_units_of_the_header_are_converted(tmp_path):
    found = points(
        tmp_path, "# source\nperiod [s], sway [mm], roll [deg], transmission_coefficient\n5, 10, 180, 0.3\n6,,90,0.4\n"
    )
    assert found["period"] == (5.0, 6.0)
    assert found["sway"][0] == 0.01
    assert math.isnan(found["sway"][1])
    assert found["roll"] == pytest.approx((math.pi, math.pi / 2.0))
    assert found["transmission_coefficient"] == (0.3, 0.4)


@pytest.mark.parametrize("mark", [";", "\t", ","])
def test_delimiters(tmp_path, mark):
    assert points(tmp_path, f"a{mark}b\n1{mark}2\n") == {"a": (1.0,), "b": (2.0,)}


def test_columns_are_renamed_and_chosen(tmp_path):
    found = points(tmp_path, "周期 [s],x,伝達率\n5,1,0.3\n", {"周期": "period", "伝達率": "transmission_coefficient"})
    assert found == {"period": (5.0,), "transmission_coefficient": (0.3,)}


@pytest.mark.parametrize(
    ("text", "columns", "words"),
    [
        ("", {}, "holds no table"),
        ("# only\n", {}, "holds no table"),
        ("a,b\n", {}, "a header and no rows"),
        ("a,b\n1,2\n3\n", {}, "line 3 has 1 cells, its header 2"),
        ("a,b\n1,x\n", {}, "line 2, column 'b': 'x' is not a number"),
        ("a,b\n1,nan\n", {}, "line 2, column 'b': nan is not a finite number"),
        ("a,a\n1,2\n", {}, "has the column 'a' twice"),
        ("a [mn],b\n1,2\n", {}, "column 'a': unknown unit 'mn'"),
        ("a,b\n1,2\n", {"c": "d"}, "has no column 'c'; allowed: a, b"),
        ("a b,c\n1,2\n", {}, "the column 'a b' cannot be named so"),
        ("a,,c\n1,2,3\n", {}, "a column has no name"),
    ],
)
def test_faults(tmp_path, text, columns, words):
    with pytest.raises(InputError) as caught:
        points(tmp_path, text, columns)
    assert words in str(caught.value)
    assert str(caught.value).startswith("measured.file: ")


def test_other_encodings(tmp_path):
    with pytest.raises(InputError, match="Shift-JIS"):
        points(tmp_path, "周期\n5\n", encoding="cp932")


def test_measured_points_in_a_case(tmp_path):
    text = changed(("analyses:", "measured: {file: points.csv}\nanalyses:"))
    (fault,) = faults(text, tmp_path)
    assert "measured.file: there is no file 'points.csv'" in fault
    (tmp_path / "points.csv").write_text("period [s],sway [cm]\n5,x\n")
    (fault,) = faults(text, tmp_path)
    assert fault.startswith("case.yaml:")
    assert "line 2, column 'sway': 'x' is not a number" in fault
    (tmp_path / "points.csv").write_text("period [s],sway [cm]\n5,2\n")
    measured = build(read(text, tmp_path)).measured
    assert measured.columns == {"period": (5.0,), "sway": (0.02,)}
