"""Numbers and units of the report."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from moyai.report.formatting import (
    column_decimals,
    display_unit,
    format_fixed,
    format_number,
    format_quantity,
    plain_number,
    pretty_unit,
    trimmed,
)

_SUPERSCRIPT = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻−", "0123456789--")


def parse(text: str) -> float:
    """Read a formatted number back."""
    mantissa, _, exponent = text.partition("×10")
    return float(mantissa.translate(_SUPERSCRIPT)) * 10.0 ** int(exponent.translate(_SUPERSCRIPT) or 0)


def test_random_numbers_keep_their_significant_digits() -> None:
    random = np.random.default_rng(12)
    for _ in range(2000):
        value = float(random.choice([-1, 1]) * 10.0 ** random.uniform(-12, 12))
        digits = int(random.integers(2, 7))
        text = format_number(value, digits)
        assert abs(parse(text) - value) <= 0.5000001 * 10.0 ** (math.floor(math.log10(abs(value))) - digits + 1), text
        assert "-" not in text  # a true minus, not a hyphen


@pytest.mark.parametrize(
    ("value", "text"),
    [(math.nan, "–"), (math.inf, "∞"), (-math.inf, "−∞"), (0.0, "0"), (-0.0, "0"), (0.9996, "1.00"), (9.996, "10.0"),
     (99999.6, "100000"), (0.00123, "0.00123"), (-5.0, "−5.00")],
)  # fmt: skip
def test_edges(value: float, text: str) -> None:
    assert format_number(value) == text


def test_columns_keep_one_number_of_decimals() -> None:
    random = np.random.default_rng(5)
    for _ in range(200):
        values = 10.0 ** random.uniform(-2, 5) * random.normal(size=6)
        decimals = column_decimals(values, 3)
        if decimals is None:
            continue
        texts = [format_fixed(value, decimals) for value in values]
        assert len({len(text.partition(".")[2]) for text in texts}) == 1
        largest = max(texts, key=lambda text: abs(parse(text)))
        assert len(re.sub(r"[^\d]", "", largest).lstrip("0")) >= 3
    assert format_fixed(-0.0001, 2) == "0.00"
    assert column_decimals([math.nan, math.nan], 3) is None
    assert column_decimals([2.0, 4.0, math.nan], 3) == 0


def test_units_follow_the_magnitude_and_keep_the_value() -> None:
    random = np.random.default_rng(8)
    for unit in ("N", "N/m", "N m", "Pa", "kg", "rad", "m", "N s/m"):
        for magnitude in (1e-3, 1.0, 2e4, 3e8):
            values = magnitude * random.uniform(0.2, 1.0, 5)
            shown = display_unit(unit, values)
            assert shown.factor > 0.0
            if shown.name.startswith("k") and unit != "kg":
                assert shown.factor == 1e-3
    assert display_unit("rad", [0.1]).factor == pytest.approx(180.0 / math.pi)
    assert format_quantity(15230.0, "N") == "15.2 kN"
    assert format_quantity(math.nan, "N") == "–"
    assert format_quantity(math.radians(5.0), "rad") == "5.00°"


def test_units_are_written_for_the_eye() -> None:
    assert pretty_unit("kg/m3") == "kg/m³"
    assert pretty_unit("kN m/rad") == "kN·m/rad"
    assert pretty_unit("m2 s/rad") == "m²·s/rad"
    assert pretty_unit("kN m per m") == "kN·m per m"
    assert pretty_unit("deg2 s/rad") == "°²·s/rad"
    assert pretty_unit("1") == ""


def test_plain_numbers_read_back() -> None:
    random = np.random.default_rng(2)
    for value in random.normal(size=300) * 10.0 ** random.uniform(-20, 20, 300):
        assert float(plain_number(value)) == pytest.approx(value, rel=1e-6)
    assert plain_number(math.nan) == ""
    assert trimmed("4.500") == "4.5" and trimmed("100") == "100" and trimmed("2.00") == "2"
