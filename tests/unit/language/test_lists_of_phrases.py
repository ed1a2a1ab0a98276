"""A list of phrases of one form is a list in the other language too, and no phrase within a phrase."""

from __future__ import annotations

from moyai.language import said, spoken_in


def test_factors_of_safety_that_are_not_judged_stand_side_by_side() -> None:
    with spoken_in("ja"):
        found = said(
            "factor of safety of the cables, factor of safety of the sheet, factor of safety of the anchor lines: "
            "neither the impact nor the whole span in the seas of the case was run"
        )
    names, _, reason = found.partition("：")
    assert names == "ケーブルの安全率、シートの安全率、係留索の安全率" and reason
