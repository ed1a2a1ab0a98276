"""Columns that are compared share a display unit."""

from __future__ import annotations

from moyai.report.document import Column, Table, in_one_unit
from moyai.report.encoding import column_unit, table_csv
from moyai.report.html import column_texts


def test_forces_of_one_table_share_their_unit():
    columns = in_one_unit(
        (
            Column("Part", ["net", "buoy"]),
            Column("mean", [2.5e5, 3.0e3], "N"),
            Column("across", [0.04, -0.002], "N"),
            Column("least", [float("nan"), None], "N"),
            Column("length", [0.5, 2000.0], "m"),
        )
    )
    assert [column_unit(column).name for column in columns][1:3] == ["kN", "kN"]
    assert columns[4].like == 0.0
    assert column_texts(columns[1])[0] == "250"
    header, first, _ = table_csv(Table("t", "T", columns)).splitlines()
    assert "across [kN]" in header and "mean [kN]" in header
    assert first.split(",")[1:3] == ["250", "4e-05"]


def test_a_column_alone_keeps_its_own_unit():
    assert column_unit(Column("mean", [0.04, -0.002], "N")).name == "N"
    assert column_unit(Column("empty", [], "N")).name == "N"
