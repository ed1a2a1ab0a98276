"""Findings of the papers in Japanese: lists of numbers stay together, and each with its place."""

from __future__ import annotations

import pytest

from moyai.language import said, spoken_in


@pytest.mark.parametrize(
    ("english", "japanese"),
    [
        ("F* = 0.83, 0.70, 0.58 at L/B = 1.5, 2.5, 3.5, 5, 7", "L/B = 1.5、2.5、3.5、5、7 で F* = 0.83, 0.70, 0.58"),
        ("C_T = 0.26, 0.67, 0.82 at L/B = 3, 5, 7 in the frequency domain",
         "周波数領域で L/B = 3、5、7 のとき C_T = 0.26, 0.67, 0.82"),
        ("3.7, 3.3 degrees to either side at T = 1.1, 1.2 s", "T = 1.1, 1.2 s で両側に 3.7, 3.3 度"),
        ("taut over slack 1.5, 1.4 at T = 1.1, 1.2 s", "T = 1.1, 1.2 s で緊張／弛緩 1.5, 1.4"),
        ("0.43 N on net F at H = 6.5 cm, T = 1.3 s", "H = 6.5 cm、T = 1.3 s で網 F に 0.43 N"),
        ("the iteration converges at omega dt = 2 and does not at omega dt = 0.02, 0.5",
         "反復は omega dt = 2 で収束し、0.02, 0.5 では収束しない"),
        ("cos to the power 2.03 (1.84 to 2.21); 2 planted in a synthetic campaign",
         "cos の 2.03 乗（1.84～2.21）；合成観測に与えた値は 2"),
        ("18 of all 31", "全 31 のうち 18"),
    ],
)  # fmt: skip
def test_numbers_stay_with_their_places(english: str, japanese: str) -> None:
    with spoken_in("ja"):
        assert said(english) == japanese
