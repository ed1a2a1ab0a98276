"""Headlines and verdicts: judged at the unfavourable end, bounds only where they prove something, kept on disk."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest
import xarray as xr

from moyai.core.collected import Collected
from moyai.core.headline import (
    SEAS_LEFT_OUT,
    Band,
    Criterion,
    Headline,
    Judgement,
    Verdict,
    all_judged,
    also_judged,
    governing,
    judge,
    left_open,
)
from moyai.core.results import read_result
from moyai.core.validity import Notice
from moyai.core.vocabulary import Vocabulary

MOST = Criterion("transmission", "transmission", 0.5, "at most", "case file")
LEAST = Criterion("least_effective_depth", "effective_depth", 4.0, "at least", "case file", unit="m")


def transmission(value: float, **kwargs: object) -> Headline:
    return Headline("transmission", "Wave transmission K_T", value, "1", **kwargs)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("headline", "outcome"),
    [
        (transmission(0.4), "holds"),
        (transmission(0.6), "does not hold"),
        (transmission(0.4, band=Band(0.3, 0.55, "damping")), "does not hold"),
        (transmission(0.4, band=Band(0.3, 0.55, "5 seeds", decides=False)), "holds"),
        (transmission(0.4, bound="at most"), "holds"),
        (transmission(0.6, bound="at most"), "not judged"),
        (transmission(0.4, bound="at least"), "not judged"),
        (transmission(0.6, bound="at least"), "does not hold"),
        (transmission(math.nan), "not judged"),
    ],
)
def test_a_limit_from_above(headline: Headline, outcome: str) -> None:
    assert judge([headline], [MOST], computed=True).outcome == outcome


def test_a_limit_from_below_that_is_missed_is_said_with_both_numbers() -> None:
    found = judge([Headline("effective_depth", "Effective depth", 1.99, "m")], [LEAST], computed=True)
    assert found.outcome == "does not hold"
    assert "1.99 m" in found.message and "4 m" in found.message


def test_what_was_not_run_and_what_did_not_converge_is_not_judged() -> None:
    assert judge([], [MOST], computed=True).outcome == "not judged"
    assert judge([transmission(0.4)], [MOST], computed=False).outcome == "not judged"
    assert judge([transmission(0.4)], [], computed=True).outcome == "not judged"
    assert judge([transmission(0.6)], [MOST], computed=False).outcome == "does not hold"


def test_what_a_criterion_is_judged_on_stands_in_the_verdict(tmp_path: Path) -> None:
    narrow = transmission(0.4, band=Band(0.3, 0.45, "damping"), judged_on="the band of damping alone")
    verdict = judge([narrow], [MOST], computed=True)
    assert verdict.message == "the criterion holds; transmission judged on the band of damping alone"
    assert Verdict.from_dict(verdict.as_dict()) == verdict


def test_headlines_and_verdict_survive_the_file(tmp_path: Path) -> None:
    headlines = (
        transmission(0.4, band=Band(0.3, math.inf, "damping")),
        Headline("uplift", "Uplift", math.nan, "N", text="none"),
    )
    collected = Collected()
    collected.groups["/a"] = xr.Dataset()
    result = collected.close(
        Vocabulary.of("s", {}),
        {"title": "t", "case_hash": "h", "structure": "s"},
        headlines=headlines,
        criteria=(MOST, LEAST),
    )
    again = read_result(result.write(tmp_path / "results.nc"))
    assert again.headlines[0] == headlines[0]
    assert math.isnan(again.headlines[1].value) and again.headlines[1].text == "none"
    assert again.verdict.outcome == result.verdict.outcome == "does not hold"
    assert [item.criterion for item in again.verdict.judgements] == [MOST, LEAST]


def test_the_mean_of_few_realisations_is_judged_at_the_end_of_its_interval() -> None:
    scatter = Band(0.3, 0.9, "5 realisations", decides=False, judged=(0.35, 0.55))
    assert judge([transmission(0.45, band=scatter)], [MOST], computed=True).outcome == "does not hold"
    least = Criterion("least", "transmission", 0.4, "at least", "case file")
    found = judge([transmission(0.45, band=scatter)], [least], computed=True)
    assert found.outcome == "does not hold" and found.judgements[0].value == 0.35
    assert Headline.from_dict(transmission(0.45, band=scatter).as_dict()).band == scatter


def test_a_number_at_a_named_sea_is_judged_by_the_criterion_of_that_sea_alone() -> None:
    numbers = (transmission(0.4), transmission(0.6, sea="design", shown=False))
    at_sea = Criterion("transmission", "transmission", 0.5, "at most", "case file", sea="design")
    assert judge(numbers, [MOST], computed=True).outcome == "holds"
    assert judge(numbers, [at_sea], computed=True).outcome == "does not hold"
    assert judge(numbers[:1], [at_sea], computed=True).outcome == "not judged"


def test_a_bound_of_a_load_turns_over_with_its_factor_of_safety() -> None:
    least = Criterion("anchor", "used", 1.0 / 1.5, "at most", "case file", as_factor=True)
    used = Headline("used", "Anchors", 1.5, "1", bound="at most")
    (found,) = judge([used], [least], computed=True).judgements
    assert (found.outcome, found.bound, found.shown_bound) == ("not judged", "at most", "at least")


def test_of_one_number_the_worst_end_is_judged_in_either_sense() -> None:
    shallow, deep = (
        Headline("effective_depth", "depth", value, "m", where, band=Band(low, 6.0, "drag"))
        for value, low, where in ((5.0, 4.6, "HWL"), (5.2, 3.9, "LWL"))
    )
    shown, behind = governing([shallow, deep], "at least")
    assert (shown.where, behind.where, behind.shown) == ("HWL", "LWL", False)
    assert judge([shallow], [LEAST], computed=True).outcome == "holds"
    verdict = judge([shown, behind], [LEAST], computed=True)
    assert verdict.outcome == "does not hold"
    assert governing([deep], "at least") == [deep]
    # scatter that does not decide is judged at its interval alone
    mean = transmission(0.4, band=Band(0.3, 0.9, "5 seeds", decides=False))
    assert governing([mean, transmission(0.45)]) == [transmission(0.45)]


def test_the_order_of_levels_changes_nothing_and_the_end_that_is_judged_is_named() -> None:
    high = Headline("load", "load", 2.0e3, "N", "HWL", band=Band(1.0e3, 4.0e3, "drag"))
    low = Headline("load", "load", 2.0e3, "N", "LWL", band=Band(1.0e3, 6.0e3, "drag"))
    assert governing([high, low]) == governing([low, high]) == [low]
    shown, judged = governing([replace(high, value=2.5e3), low])
    assert shown.where == "HWL" and shown.detail == "up to 6 kN at LWL"
    assert judged.where == "LWL" and not judged.shown
    shallow = [Headline("depth", "depth", value, "m", where, band=Band(low_end, 5.0, "drag"))
               for value, where, low_end in ((4.0, "HWL", 3.5), (4.2, "LWL", 3.0))]  # fmt: skip
    assert governing(shallow, "at least")[0].detail == "down to 3 m at LWL"


def test_what_was_left_out_proves_only_that_a_limit_is_broken() -> None:
    light = Headline("line_utilisation", "use", 0.1, "1")
    strength = Criterion("line_safety_factor", "line_utilisation", 0.5, "at most", "case file", as_factor=True)
    stable = Headline("metacentric_height", "GM", 1.0, "m", without_waves=True)
    height = Criterion("least_metacentric_height", "metacentric_height", 0.5, "at least", "case file")
    verdict = judge([light, stable], [strength, height], computed=True, left_out=SEAS_LEFT_OUT)
    assert [item.outcome for item in verdict.judgements] == ["not judged", "holds"]
    assert verdict.message == f"line safety factor: {SEAS_LEFT_OUT}"
    heavy = replace(light, value=0.6)
    assert judge([heavy], [strength], computed=True, left_out=SEAS_LEFT_OUT).outcome == "does not hold"
    shallow = Headline("effective_depth", "depth", 3.0, "m")
    assert judge([shallow], [LEAST], computed=True, left_out=SEAS_LEFT_OUT).outcome == "does not hold"
    assert judge([replace(shallow, value=5.0)], [LEAST], computed=True, left_out=SEAS_LEFT_OUT).outcome == "not judged"


def test_a_limit_between_a_mean_and_its_interval_names_the_realisations_that_may_prove_it():
    """Half the room asks for four times the realisations; a mean that breaks the limit itself asks for none."""
    band = Band(20.0, 40.0, "5 realisations", decides=False, judged=(26.0, 34.0), realisations=5, more="settings.many")
    found = Headline("pull", "Pull", 30.0, "N", band=band)
    limit = Criterion("greatest_pull", "pull", 32.0, "at most", "case file", unit="N")
    verdict = judge([found], [limit], computed=True)
    assert verdict.outcome == "does not hold"
    assert "the mean of 5 realisations keeps it: settings.many: 20 may prove it" in verdict.message
    (judged,) = verdict.judgements
    assert Judgement.from_dict(judged.as_dict()) == judged
    assert "settings.many" not in judge([found], [replace(limit, limit=29.0)], computed=True).message
    close = judge([found], [replace(limit, limit=30.1)], computed=True)
    assert "by too little to be proven" in close.message
    assert judge([found], [replace(limit, limit=35.0)], computed=True).judgements[0].remedy == ""
    assert Headline.from_dict(found.as_dict()) == found


def test_a_bound_from_below_with_an_end_beyond_it_holds_where_that_end_keeps_the_limit():
    band = Band(1.0, 2.0, "growth", decides=False, judged=(1.0, 8.0), beyond_bound=True)
    found = Headline("pull", "Pull", 2.0, "N", bound="at least", band=band)
    limit = Criterion("greatest_pull", "pull", 10.0, "at most", "case file", unit="N")
    (item,) = judge([found], [limit], computed=True).judgements
    assert (item.outcome, item.value) == ("holds", 8.0)
    # beyond the limit that end proves nothing; the bound proves that a limit below it is broken
    for least, outcome in ((5.0, "not judged"), (1.5, "does not hold")):
        (item,) = judge([found], [replace(limit, limit=least)], computed=True).judgements
        assert (item.outcome, item.value) == (outcome, 2.0)


def test_of_what_stands_behind_a_number_each_kind_is_judged_once() -> None:
    """A value by its end; a bound without an end always, with one where it passes; what is not known as it is."""
    shown = Headline("pull", "Pull", 30.0, "N", "storm", band=Band(20.0, 40.0, "seeds"))
    smaller = Headline("pull", "Pull", 25.0, "N", "swell", band=Band(20.0, 35.0, "seeds"))
    wider = replace(smaller, band=Band(20.0, 45.0, "seeds"))
    alone = Headline("pull", "Pull", 5.0, "N", "calm", bound="at least")
    grown = replace(alone, band=Band(5.0, 5.0, "meshes", decides=False, judged=(5.0, 38.0), beyond_bound=True))
    further = replace(grown, band=replace(grown.band, judged=(5.0, 42.0)))
    unknown = Headline("pull", "Pull", math.nan, "N", "LWL", text="not known")
    most = Headline("pull", "Pull", 39.0, "N", "plate", bound="at most")
    assert also_judged(shown, [smaller, grown, most]) == []
    for item in (wider, alone, further, unknown, replace(most, value=41.0)):
        found = also_judged(shown, [smaller, item, grown if item is wider else smaller])
        # not a number is equal to nothing
        assert repr(found) == repr([replace(item, shown=False)])
    # with a bound every value counts, and of bounds alike the worst alone
    assert also_judged(replace(alone, value=6.0), [smaller, alone]) == [replace(smaller, shown=False)]
    assert also_judged(unknown, [replace(unknown, text="not known at HWL")]) == []


def test_no_row_holds_of_a_computation_that_cannot_be_judged() -> None:
    """What is broken stays broken, with its doubt; what was kept is not judged, row by row."""
    numbers = [transmission(0.4, where="storm"), Headline("effective_depth", "depth", 3.0, "m")]
    verdict = judge(numbers, [MOST, LEAST], computed=False)
    kept, broken = verdict.judgements
    assert (kept.outcome, kept.value, kept.judged_on) == ("not judged", 0.4, "storm")
    assert "did not converge" in kept.reason and broken.outcome == "does not hold"
    assert [item.outcome for item in judge(numbers, [MOST, LEAST], computed=True).judgements] == [
        "holds", "does not hold",
    ]  # fmt: skip
    assert Verdict.from_dict(verdict.as_dict()) == verdict


def test_no_row_holds_of_what_turns_out_to_be_left_out_or_outside_its_range() -> None:
    for values, outcome in (((0.4, 5.0), "not judged"), ((0.4, 3.0), "does not hold")):
        numbers = [transmission(values[0]), Headline("effective_depth", "depth", values[1], "m")]
        held = judge(numbers, [MOST, LEAST], computed=True)
        verdict = left_open(held, "not run: water level LWL")
        assert verdict.outcome == outcome
        assert (verdict.judgements[0].outcome, verdict.judgements[0].reason) == (
            "not judged", "not run: water level LWL",
        )  # fmt: skip
    collected = Collected()
    result = collected.close(
        Vocabulary.of("s", {}), {"title": "t", "case_hash": "h", "structure": "s"}, headlines=[transmission(0.4)],
        criteria=[MOST],
    )  # fmt: skip
    assert [item.outcome for item in result.verdict.judgements] == ["holds"]
    beyond = result.with_notices(Notice("beyond", "outside of the range", severity="error"))
    assert [item.outcome for item in beyond.verdict.judgements] == ["not judged"]


def _use(line: str, sea: str, value: float, mean: float, **more: object) -> Headline:
    return Headline("use", "Use", value, "1", f"{line}, {sea}", mean=mean, part=line, **more)  # type: ignore[arg-type]


def test_what_only_a_code_with_a_factor_on_the_mean_needs_is_judged_by_such_a_code_alone() -> None:
    """The leash fails a factor of 3 in short waves behind the hoist: its light load in long waves is no answer."""
    uses = [_use("hoist", "short", 0.46, 0.10), _use("leash", "short", 0.41, 0.11), _use("leash", "long", 0.08, 0.05)]
    plain = Criterion("factor", "use", 1.0 / 3.0, "at most", "case", as_factor=True)
    found = all_judged(uses)
    assert [item.where for item in found] == ["hoist, short", "leash, long"] and found[1].role == "weighed"
    rows = judge(found, [plain], computed=True).judgements
    assert [(item.reason, item.outcome) for item in rows] == [("hoist, short", "does not hold")]
    weighed = replace(plain, mean_weight=0.5)
    assert {item.reason for item in judge(found, [weighed], computed=True).judgements} == {
        "hoist, short",
        "leash, long",
    }
    # one of which a bound alone is known stays open for every criterion, and stands once
    bounded = all_judged([uses[0], replace(uses[2], bound="at least")])
    assert [(item.where, item.role) for item in bounded] == [("hoist, short", ""), ("leash, long", "")]
    # a line that fails in one sea has no row that holds in another
    behind = replace(uses[1], shown=False, role="failing")
    for criterion in (plain, weighed):
        verdict = judge([*found, behind], [criterion], computed=True)
        rows = {item.reason: item.outcome for item in verdict.judgements}
        assert rows == {"hoist, short": "does not hold", "leash, short": "does not hold"}
        assert verdict.message.count("is below") == 1
    # one that is listed where it fails is no row where it holds
    light = replace(behind, value=0.2)
    assert [item.reason for item in judge([*found, light], [plain], computed=True).judgements] == ["hoist, short"]


def test_the_worst_of_the_lines_that_fail_have_rows() -> None:
    uses = [_use(f"line {k}", "storm", 0.5 + 0.01 * k, 0.1, role="failing", shown=False) for k in range(20)]
    shown = _use("line 20", "storm", 0.8, 0.1)
    limit = Criterion("factor", "use", 0.4, "at most", "case")
    rows = judge([shown, *uses], [limit], computed=True).judgements
    assert [item.reason for item in rows[:3]] == ["line 20, storm", "line 19, storm", "line 18, storm"]
    assert len(rows) == 9


def test_what_is_not_known_for_the_same_reason_has_one_row() -> None:
    unknown = [transmission(math.nan, text=text) for text in ("hulls meet", "hulls meet", "no sea", "hulls meet")]
    verdict = judge(unknown, [MOST], computed=True)
    assert [item.reason for item in verdict.judgements] == ["hulls meet", "no sea"]
