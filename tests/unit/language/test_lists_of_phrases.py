"""A list of phrases of one form is a list in the other language too, and no phrase within a phrase."""

from __future__ import annotations

import re

import pytest

from moyai.language import said, spoken_in


def test_factors_of_safety_that_are_not_judged_stand_side_by_side() -> None:
    with spoken_in("ja"):
        found = said(
            "factor of safety of the cables, factor of safety of the sheet, factor of safety of the anchor lines: "
            "snaps in the seas of the case were not run, which needs 'waves' or 'dynamic' in 'analyses'"
        )
    names, _, reason = found.partition("：")
    assert names == "ケーブルの安全率、シートの安全率、係留索の安全率" and reason


@pytest.mark.parametrize(
    ("text", "japanese"),
    [
        ("Study of 4 cases: 2 length x 2 speed", "4 ケースの検討：長さ 2 × 速度 2"),
        ("converged: 4 of 4 cases run in 9.2 s", "収束：9.2 s で 4 ケース中 4 ケースを計算"),
        ("greater than 0 m or 'infinite'", "0 m より大きい値、または 'infinite'"),
        ("frequency", "周波数"),
    ],
)
def test_sentences_of_studies_and_ranges(text: str, japanese: str) -> None:
    with spoken_in("ja"):
        assert said(text) == japanese


def test_titles_of_maps_of_a_study_hold_no_english() -> None:
    with spoken_in("ja"):
        title = said("effective depth of the curtain, governing steady load (HWL, statics): over length and speed")
    assert title.endswith("：長さと速度に対する値") and not re.search("[a-z]{3}", title)
