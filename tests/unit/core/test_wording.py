"""Numbers in sentences."""

from __future__ import annotations

import pytest

from moyai.core.wording import spoken


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (49210.0, "49.21 kN"),
        (-49210.0, "-49.21 kN"),
        (999.96, "1 kN"),
        (999.4, "999.4 N"),
        (0.0, "0 N"),
        (0.02, "0.02 N"),
        (2.5e6, "2.5 MN"),
        (999999.0, "1 MN"),
        (3e12, "3000 GN"),
        (float("nan"), "nan N"),
        (float("inf"), "inf N"),
    ],
)
def test_numbers_are_said_as_engineers_write_them(value: float, said: str) -> None:
    assert spoken(value, "N") == said


def test_numbers_of_a_sentence_share_a_prefix() -> None:
    assert [spoken(value, "N", like=1200.0) for value in (1200.0, 980.0, 35.0)] == ["1.2 kN", "0.98 kN", "0.035 kN"]
