"""A number known as a bound alone is judged next to a worse one that is known, and what varies more next to both."""

from dataclasses import replace

from moyai.core.headline import Band, Criterion, Headline, all_judged, governing, judge
from moyai.structures.cage.bands import TOO_SHORT
from moyai.structures.cage.headlines import judged_seas

LIMIT = Criterion("limit", "line_utilisation", 0.5, "at most", "case")
KNOWN = Headline("line_utilisation", "use", 0.30, "1", "regular wave")


def test_a_bound_behind_a_larger_number_leaves_the_limit_open():
    least = replace(KNOWN, value=0.20, where="short sea", bound="at least")
    assert judge([KNOWN], [LIMIT], computed=True).outcome == "holds"
    items = all_judged([KNOWN, least])
    assert judge(items, [LIMIT], computed=True).outcome == "not judged"
    assert [item.where for item in items if item.shown] == ["regular wave"]


def test_a_sea_of_one_short_seed_is_a_bound_before_it_is_ranked():
    short = replace(KNOWN, value=0.20, where="short sea", band=Band(0.15, 0.25, f"{TOO_SHORT} of 10 periods"))
    assert judge(judged_seas([KNOWN, short]), [LIMIT], computed=True).outcome == "not judged"
    # of a volume the other seeds leave less
    volume = Headline("volume_left", "volume", 0.80, "1", "long sea")
    less = replace(volume, value=0.85, where="short sea", band=Band(0.8, 0.9, f"{TOO_SHORT} of 10 periods"))
    kept = Criterion("limit", "volume_left", 0.6, "at least", "case")
    assert judge(judged_seas([volume, less], "at least"), [kept], computed=True).outcome == "not judged"


def test_a_smaller_value_of_a_smaller_mean_is_kept_for_codes_that_weigh_both():
    steady = replace(KNOWN, value=0.785, mean=0.55, where="rope")
    varying = replace(KNOWN, value=0.768, mean=0.20, where="chain")
    found = governing([steady, varying, replace(varying, value=0.7, mean=0.3, where="covered")])
    assert [(item.where, item.shown) for item in found] == [("rope", True), ("chain", False)]
