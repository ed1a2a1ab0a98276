"""The first page: both badges, numbers before criteria before notices, one unit of forces, each notice once."""

from __future__ import annotations

import io
from dataclasses import replace

import openpyxl
import pytest
from small_results import pontoon, without

from moyai.core.headline import UNCONFIRMED, Band, Criterion, Headline, Verdict, judge
from moyai.core.results import Result
from moyai.core.validity import Notice
from moyai.report.document import KeyFigures, NoticeBlock, Paragraph, Table
from moyai.report.first_page import badges, criteria_table
from moyai.report.headlines import band_text, headline_figures
from moyai.report.html import least_width, render_html
from moyai.report.input_line import input_line
from moyai.report.notices import first_page_notices, grouped
from moyai.report.workbook import render_workbook
from moyai.report.writer import compose_document

FACTOR = Criterion(
    "line_safety_factor", "line_utilisation", 0.5, "at most", "case file", "factor of safety", as_factor=True
)
UPLIFT = Criterion(
    "greatest_uplift", "anchor_vertical_tension", 5e3, "at most", "case file", "uplift on the anchors", "N"
)


def plain_result() -> Result:
    """Return a result whose own numbers do not matter here."""
    return without(pontoon(), "/time")


def judged(*criteria: Criterion, **kwargs: object) -> Result:
    headlines = (
        Headline("line_tension", "Largest line tension", 1.766e6, "N", "HWL, storm"),
        Headline("line_utilisation", "Load over strength", 2.1, "1", "HWL, storm"),
        Headline("anchor_vertical_tension", "Uplift on an anchor", 3184.0, "N", "HWL, storm"),
    )
    result = plain_result()
    verdict = judge(headlines, criteria, computed=True)
    return replace(result, headlines=headlines, verdict=verdict, **kwargs)


def snap(place: str, value: float) -> Notice:
    return Notice("quasi-static-snap", f"{place}: line a reaches {value:g} times its mean tension", value, 5.0)


def test_an_overloaded_line_is_computed_well_and_does_not_hold() -> None:
    result = judged(FACTOR, UPLIFT)
    assert [(badge.label, badge.word) for badge in badges(result)] == [
        ("Computation", "Converged"),
        ("Design", "Does not hold"),
    ]
    page = render_html(compose_document(result))
    assert "Does not hold" in page and "Factor of safety 0.476 is below 2" in page


def test_outside_the_range_never_holds_even_if_it_is_reported_late() -> None:
    result = judged(UPLIFT)
    assert result.verdict.outcome == "holds"
    late = result.with_notices(Notice("range", "the wave breaks", severity="error"))
    assert (late.status, late.verdict.outcome) == ("outside_validity", "not judged")


def test_a_result_that_judges_nothing_has_one_badge() -> None:
    assert len(badges(replace(judged(), verdict=Verdict()))) == 1


def test_numbers_come_before_criteria_before_notices() -> None:
    result = judged(FACTOR, UPLIFT, notices=(snap("HWL, storm", 6.0),))
    blocks = compose_document(result).sections[0].blocks
    blocks = [block for block in blocks if not isinstance(block, Paragraph)]
    kinds = [type(block) for block in blocks]
    assert kinds[0] is KeyFigures and kinds[2] is NoticeBlock
    assert isinstance(blocks[1], Table) and blocks[1].key == "criteria"
    columns = {column.label: list(column.values) for column in blocks[1].columns}
    assert columns["Outcome"] == ["does not hold", "holds"]
    assert columns["Found"] == ["0.476", "3.18 kN"] and columns["Limit"] == ["at least 2.00", "at most 5.00 kN"]


@pytest.mark.slow
def test_the_workbook_has_the_numbers_of_page_and_criteria_as_numbers() -> None:
    book = openpyxl.load_workbook(io.BytesIO(render_workbook(compose_document(judged(FACTOR, UPLIFT)))))
    rows = {row[0]: row[1:4] for row in book["Summary"].iter_rows(values_only=True) if row[0]}
    assert rows["Largest line tension"] == (1766, "kN", None)
    assert rows["Load over strength"] == (2.1, None, None) and rows["Uplift on an anchor"] == (3.18, "kN", None)
    heads, *rest = book["Criteria"].iter_rows(values_only=True)
    found = [dict(zip(heads, row, strict=True)) for row in rest[:2]]
    assert [row["Limit"] for row in found] == [2, 5] and [row["Found"] for row in found] == [0.476, 3.18]
    assert [row["Limit: unit"] for row in found] == [row["Found: unit"] for row in found] == [None, "kN"]
    assert [row["Limit: bound"] for row in found] == ["at least", "at most"] and "Found: bound" not in heads


def test_forces_of_the_page_have_one_unit() -> None:
    figures = headline_figures(judged())
    assert figures is not None
    assert [item.text for item in figures.items] == ["1766 kN", "2.10", "3.18 kN"]


def test_a_number_that_is_not_shown_is_judged_at_its_sea_only() -> None:
    headlines = (
        Headline("transmission", "K_T", 0.4, "1", sea="storm"),
        Headline("transmission", "K_T", 0.9, "1", sea="swell", shown=False),
    )
    everywhere = Criterion("greatest_transmission", "transmission", 0.5, "at most", "case file")
    assert judge(headlines, [everywhere], computed=True).outcome == "holds"
    assert judge(headlines, [replace(everywhere, sea="swell")], computed=True).outcome == "does not hold"
    assert judge(headlines, [replace(everywhere, sea="calm")], computed=True).outcome == "not judged"


def test_notices_are_grouped_counted_and_the_most_severe_is_shown() -> None:
    mild = Notice("other", "something else", severity="warning")
    grave = Notice("range", "LWL, swell: the wave breaks", 1.2, 1.0, severity="error")
    groups = grouped([mild, snap("HWL, storm", 6.0), snap("LWL, storm", 9.0), snap("HWL, swell", 5.5), grave, mild])
    assert [(group.notice.code, group.count) for group in groups] == [
        ("range", 1),
        ("other", 1),
        ("quasi-static-snap", 3),
    ]
    assert groups[2].notice.value == 9.0
    assert groups[2].places == ("HWL, storm", "LWL, storm", "HWL, swell")
    assert groups[2].where.startswith("3 times: HWL, storm; LWL, storm; HWL, swell")
    assert groups[0].where == ""


def test_warnings_of_the_case_stay_apart_by_their_key() -> None:
    warnings = [Notice("case", f"odd value {n}", source=f"waves[{n}].height") for n in range(2)]
    assert len(grouped(warnings)) == 2


def test_a_notice_that_repeats_a_number_of_the_page_goes() -> None:
    over = Notice("line-breaks", "HWL: line a would bear 210 % of its breaking load", 2.1, 1.0)
    note = Notice("note", "for information", severity="information")
    result = judged(FACTOR, notices=(over, note, snap("HWL", 6.0)))
    assert [notice.code for notice in first_page_notices(result)] == ["quasi-static-snap"]
    assert first_page_notices(replace(result, headlines=()))[0] is over


def test_letters_of_a_drawing_keep_nine_pixels() -> None:
    svg = '<svg viewBox="0 0 980 300"><text font-size="12">a</text><text font-size="13">b</text></svg>'
    assert 12.0 * least_width(svg) / 980.0 >= 9.0
    assert least_width("<svg></svg>") == 0.0


def test_a_design_that_holds_says_on_what_word() -> None:
    numbers = (Headline("freeboard", "Freeboard", 1.0, "m"), Headline("offset", "Offset", 1.0, "m"))
    given = Criterion("greatest_offset", "offset", 2.0, "at most", "case file", unit="m")
    assumed = Criterion("least_freeboard", "freeboard", 0.0, "at least", "default of moyai", unit="m", assumed=True)
    code = replace(assumed, source=f"default of moyai: a code, {UNCONFIRMED}")
    assert judge(numbers, [given], computed=True).message == "the criterion holds"
    assert judge(numbers, [given, assumed], computed=True).message == "all 2 criteria hold, 1 of them defaults of moyai"
    assert judge(numbers, [code], computed=True).message == (
        "the criterion holds, a default of moyai; factors of a standard that were not confirmed against it"
    )


def test_the_conditions_stand_in_one_line_as_the_case_gives_them() -> None:
    text = """
site: {water_depth: 12 m, water_levels: {HWL: 3 m, LWL: 0}, return_period_years: 50}
waves:
  - {kind: regular, name: daily, height: 0.4, periods: [3, 4, 5, 6]}
  - {kind: jonswap, significant_height: 1.5 m, peak_period: 5 s, heading_deg: 30}
current: {speed: 0.8 m/s, heading_deg: 0}
"""
    result = plain_result()
    tree = result.tree.copy()
    tree.attrs |= {"case_text": text, "case_hash": "0123456789abcdef"}
    assert input_line(replace(result, tree=tree)) == (
        "Conditions: water depth 12 m, return period 50 years; levels HWL 3 m, LWL 0 m; daily: regular, height 0.4 m, "
        "periods 3 s to 6 s, 4 values; sea 2: jonswap, significant height 1.5 m, peak period 5 s, heading 30 degrees; "
        "current 0.8 m/s, heading 0 degrees. Case 01234567."
    )
    tree.attrs["case_text"] = "site: ["
    assert input_line(replace(result, tree=tree)) == ""


def test_what_is_bought_for_the_judged_end_prints_it_next_to_its_number() -> None:
    """49.4 kN, five realisations up to 55.0, judged at 76.2: piles bought for 55 would be too weak."""
    band = Band(38.5e3, 55.0e3, "5 realisations", decides=False, judged=(30e3, 76.2e3), realisations=5)
    pull = Headline("anchor_horizontal_tension", "Pull", 49.4e3, "N", "storm, line a", band=band)
    assert band_text(pull) == "38.5 kN to 76.2 kN, judged 76.2 kN (5 realisations)"
    # an end within the band is named, the number itself is not
    within = replace(pull, band=replace(band, judged=(45e3, 52e3)))
    assert band_text(within) == "38.5 kN to 55.0 kN, judged 52.0 kN (5 realisations)"
    plain = "38.5 kN to 55.0 kN (5 realisations)"
    assert band_text(replace(pull, band=replace(band, judged=(45e3, 49.4e3)))) == plain
    assert band_text(replace(pull, band=replace(band, decides=True, judged=None))) == plain
    result = plain_result()
    for limit, words in ((None, "judged 76.2 kN"), (60e3, "judged at 76.2 kN")):
        asked = [] if limit is None else [Criterion("pull", pull.name, limit, "at most", "case file", unit="N")]
        verdict = judge([pull], asked, computed=True)
        (figure,) = headline_figures(replace(result, headlines=(pull,), verdict=verdict)).items
        assert "38.5 kN to 76.2 kN" in figure.detail and figure.detail.count("judged") == 1 and words in figure.detail


def test_next_to_what_is_not_judged_stands_the_worst_that_is_known() -> None:
    """One sea is known as a bound alone, of the others the longest gives a factor of 2.14."""
    short = Headline("line_utilisation", "Use", 1 / 3.26, "1", "SWL, short", bound="at least")
    long = replace(short, value=1 / 2.14, where="SWL, long", bound="", shown=False)
    mild = replace(long, value=1 / 5.0, where="SWL, mild")
    numbers = (replace(short, shown=False), replace(long, shown=True), mild)
    result = plain_result()

    def tile(items: tuple[Headline, ...], *criteria: Criterion) -> str:
        verdict = judge(items, criteria, computed=True)
        (figure,) = headline_figures(replace(result, headlines=items, verdict=verdict)).items
        assert figure.judgement == "caution"
        return figure.detail

    open_one = "asked at least 2.00; not judged at SWL, short: factor of safety at most 3.26; worst known: "
    assert tile(numbers, FACTOR).endswith(open_one + "factor of safety 2.14")
    shown = (replace(mild, shown=True), replace(long, shown=False), numbers[0])
    assert tile(shown, FACTOR).endswith(open_one + "factor of safety 2.14 at SWL, long")
    # a code asks another factor of lines at rest: that one says its own
    moving, still = (replace(FACTOR, limit=limit, analysis=name) for limit, name in ((0.6, "dynamic"), (0.5, "static")))
    mixed = (replace(numbers[0], analysis="dynamic"), replace(long, shown=True, analysis="static"))
    assert tile(mixed, moving, still).endswith("worst known: factor of safety 2.14, asked at least 2.00")
    pull = [replace(item, name="anchor_vertical_tension", value=item.value * 1e4, unit="N") for item in numbers]
    assert tile(tuple(pull), UPLIFT).endswith("not judged at SWL, short: at least 3.07 kN; worst known: 4.67 kN")


def test_a_tile_that_is_not_judged_for_want_of_a_number_says_why() -> None:
    use = Headline("line_utilisation", "Use", 0.3, "1", "SWL, storm, rope")
    bare = replace(use, value=float("nan"), where="", text="breaking load not given of chain", shown=False)
    beyond = replace(bare, text="SWL, T = 7 s: not known, beyond its range; run the time domain")
    result = plain_result()
    said = []
    for items in ((use, bare), (use, beyond), (replace(bare, text="not known", detail="why", shown=True),)):
        verdict = judge(items, [FACTOR], computed=True)
        (figure,) = headline_figures(replace(result, headlines=items, verdict=verdict)).items
        assert figure.judgement == "caution"
        said.append(figure.detail.partition("asked ")[2])
    assert said == [
        "at least 2.00; not judged: breaking load not given of chain; worst known: factor of safety 3.33",
        "at least 2.00; not judged: SWL, T = 7 s: not known, beyond its range; worst known: factor of safety 3.33",
        "at least 2.00; not judged",
    ]


def test_the_tile_of_a_number_of_all_seas_carries_limits_at_named_ones() -> None:
    """0.48 of the storm on the tile; the squall, which is not shown, breaks its own limit and is named."""
    numbers = (
        Headline("transmission", "K_T", 0.48, "1", "HWL, storm"),
        Headline("transmission", "K_T", 0.48, "1", "HWL, storm", sea="storm", shown=False),
        Headline("transmission", "K_T", 0.38, "1", "LWL, squall", sea="squall", shown=False),
    )
    base = Criterion("greatest_transmission", "transmission", 0.5, "at most", "case file")
    for limit, judgement, words in (
        (0.3, "bad", "limit at most 0.300 in squall, judged at 0.380 (LWL, squall)"),
        (0.4, "good", ""),
    ):
        criteria = [replace(base, sea="storm"), replace(base, sea="squall", limit=limit)]
        verdict = judge(numbers, criteria, computed=True)
        (figure,) = headline_figures(replace(judged(), headlines=numbers, verdict=verdict)).items
        assert figure.judgement == judgement and words in figure.detail, figure.detail


def test_what_bounds_a_part_of_the_loads_proves_nothing_of_the_rest() -> None:
    """Seas that were not run add to a bound of the current as to a value, and to what a growth goes on to."""
    criterion = Criterion("cables", "cable_utilisation", 0.3, "at most", "case file")
    grown = Band(0.1, 0.1, "meshes", decides=False, judged=(0.1, 0.2), beyond_bound=True)
    plain = Headline("cable_utilisation", "Cables", 0.1, "1")
    for item in (plain, replace(plain, bound="at most"), replace(plain, bound="at least", band=grown)):
        assert judge([item], [criterion], computed=True).outcome == "holds"
        found = judge([item], [criterion], computed=True, left_out="seas were not run")
        assert found.outcome == "not judged" and "seas were not run" in found.message
    more = [replace(plain, value=0.4, bound=bound) for bound in ("", "at least")]
    assert all(judge([item], [criterion], computed=True, left_out="x").outcome == "does not hold" for item in more)


def test_no_tile_and_no_row_holds_of_a_computation_that_did_not_converge() -> None:
    """A snap that the mesh changes: three rows read "holds" in green under "not judged"."""
    light = Headline("line_utilisation", "Use", 0.1, "1", "rode, storm")
    depth = Headline("depth", "Depth", 5.0, "m", "calm", band=Band(4.5, 5.5, "drag"))
    pull = Headline("anchor_vertical_tension", "Pull", 9e3, "N", "anchor, storm", band=Band(8e3, 10e3, "mesh"))
    result = plain_result()
    least = Criterion("least_depth", "depth", 4.0, "at least", "case file", "depth", "m")
    verdict = judge([light, pull, depth], [FACTOR, UPLIFT, least], computed=False)
    found = replace(result, headlines=(light, pull, depth), verdict=verdict)
    first, second, third = headline_figures(found).items
    assert [one.judgement for one in (first, second, third)] == ["caution", "bad", "caution"]
    assert first.detail.endswith("factor of safety 10.0, asked at least 2.00; not judged: the computation did not "
                                 "converge inside its range")  # fmt: skip
    assert "not judged" not in second.detail
    assert "limit at least 4.00 m, against 4.50 m; not judged: the computation did not converge" in third.detail
    table = criteria_table(found)
    outcomes, places = (next(one.values for one in table.columns if one.label == name) for name in ("Outcome", "Where"))
    assert list(outcomes) == ["does not hold", "not judged", "not judged"]
    assert places[1] == "the computation did not converge inside its range; judged on rode, storm"
