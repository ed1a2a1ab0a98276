"""Rainflow cycles of the standard's own record."""

from moyai.series.rainflow import count_cycles


def test_the_textbook_record_of_the_standard_is_counted_as_printed():
    # ASTM E1049-85, figure of the rainflow method: ranges 3, 4, 6, 8, 9 with counts 0.5, 1.5, 0.5, 1, 0.5
    ranges, _, counts = count_cycles([-2, 1, -3, 5, -1, 3, -4, 4, -2])
    total = {size: counts[ranges == size].sum() for size in sorted(set(ranges))}
    assert total == {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5}
