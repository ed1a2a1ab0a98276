"""The validation pages of the documentation are made from what ``moyai validate --json`` prints."""

from __future__ import annotations

import itertools
import json
import math
import re
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from moyai import validation
from moyai.core.validation import ValidationCase

pytest.importorskip("sphinx")
DOCS = Path(__file__).resolve().parents[3] / "docs"
sys.path.insert(0, str(DOCS))
import held_by_tests  # noqa: E402 - stands next to the pages
import measured_speed  # noqa: E402
import validation_curves  # noqa: E402
import validation_results  # noqa: E402

SVG = "{http://www.w3.org/2000/svg}"


def record(name: str, value: float | None, error: float | None, tolerance: float = 1e-3, **more: Any) -> dict[str, Any]:
    return {
        "name": name, "source": "exact", "reference_kind": "exact", "value": value, "reference": 1.0, "error": error,
        "tolerance": tolerance, "passed": True, "topic": "sea", "relative": True, "note": "", "failure": "", **more,
    }  # fmt: skip


def test_every_topic_stands_on_one_page() -> None:
    found = []
    for page in sorted((DOCS / "validation").glob("*.md")):
        for names, choice in re.findall(r"^```\{validation\} (.*)\n(:cases:)?", page.read_text("utf-8"), re.M):
            found += [] if choice else names.split()
    assert sorted(found) == sorted(validation.topics())


def test_no_row_that_validate_computes_is_typed_by_hand() -> None:
    for page in sorted((DOCS / "validation").glob("*.md")):
        rows = [line for line in page.read_text("utf-8").splitlines() if line.startswith("|")]
        typed = [row for row in rows if re.search(r"`moyai validate|, validate\b", row.rsplit("|", 2)[-2])]
        assert not [row for row in typed if "test_commands" not in row], page.name


def test_the_records_are_computed_once_and_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    calls = []

    def count() -> float:
        calls.append(1)
        return 3.1416

    cases = [("sea", ValidationCase("circle: pi", "exact", count, math.pi, 1e-5)),
             ("sea", ValidationCase("circle: broken", "exact", lambda: math.nan, math.pi, 1e-5))]  # fmt: skip
    monkeypatch.setattr(validation, "choose", lambda only: cases)
    first = validation_results.computed(tmp_path, quick=False)
    assert validation_results.computed(tmp_path, quick=False) == first
    assert len(calls) == 1
    assert [one["value"] for one in first] == [3.1416, None]
    file = tmp_path / "given.json"
    file.write_text(json.dumps({"cases": first[:1]}), encoding="utf-8")
    monkeypatch.setenv("MOYAI_VALIDATION", str(file))
    assert validation_results.computed(tmp_path, quick=False) == first[:1]


def test_points_stand_at_the_share_of_what_is_allowed() -> None:
    """A decade is as far as any other, the limit is its own line, and what is larger lies beyond it."""
    shares = [1e-4, 1e-3, 1e-2, 1.0]
    found = [record(f"sea: {value}", 1.0, value * 1e-3) for value in shares]
    drawn = ElementTree.fromstring(validation_results.error_chart(found))
    x = [float(one.attrib["cx"]) for one in drawn.iter(f"{SVG}circle") if one.find(f"{SVG}title") is not None]
    assert x[1] - x[0] == pytest.approx(x[2] - x[1], abs=0.2)
    assert x[3] - x[2] == pytest.approx(2.0 * (x[2] - x[1]), abs=0.3)
    limit = next(one for one in drawn.iter(f"{SVG}path") if one.attrib.get("stroke") == "#c0392b")
    assert limit.attrib["d"].startswith(f"M{x[3]:.1f} ")
    assert validation_results.place(1.5) > x[3]
    assert validation_results.share(record("sea: none", None, None)) == math.inf
    assert validation_results.share(record("sea: nothing", 1.0, 0.0, 0.0)) == 0.0


def test_rows_hold_value_reference_kind_error_and_what_is_allowed() -> None:
    (row,) = re.findall(r"<tr><td>.*?</tr>", validation_results.rows([record("sea: <k>", 1.0002, 2e-4, note="digits")]))
    assert re.sub(r"<[^>]+>", "|", row).split("|") == [
        *["", "", "1", "", "&lt;k&gt;", "", "1.0002", "", "1", "", "exact", "", "exact", "", "", "0.02 %", ""],
        *["0.1 %", "", "digits", "", "", ""],
    ]


@pytest.mark.parametrize(
    ("value", "relative", "text"), [(0.0, True, "0"), (2.5e-3, True, "0.25 %"), (3e-15, False, "3e-15")]
)
def test_errors_as_text(value: float, relative: bool, text: str) -> None:
    assert validation_results.amount(value, relative) == text


def test_curves_hold_the_values_of_the_records() -> None:
    head = "flexible: string struck by its end mass, M/mL = "
    svg, _ = validation_curves.struck_string([record(f"{head}1", 2.2707, 0.0), record(f"{head}2", 2.0, 0.0)])
    circles = [one.attrib for one in ElementTree.fromstring(svg).iter(f"{SVG}circle")]
    assert float(circles[1]["cy"]) == pytest.approx(260 - 36)  # 2 is the foot of the axis
    assert float(circles[1]["cx"]) - 44 == pytest.approx(2.0 * (float(circles[0]["cx"]) - 44), abs=0.2)


def test_the_barrier_meets_its_closed_form() -> None:
    pytest.importorskip("scipy")
    svg, _ = validation_curves.barrier([])
    drawn = ElementTree.fromstring(svg)
    curves = [one.attrib["d"] for one in drawn.iter(f"{SVG}path") if one.attrib["d"].count("L") > 100]
    circles = [(float(one.attrib["cx"]), float(one.attrib["cy"])) for one in drawn.iter(f"{SVG}circle")]
    assert len(curves) == 2 and len(circles) == 25
    for number, curve in enumerate(curves):
        line = [tuple(map(float, pair.split())) for pair in curve[1:].split("L")]
        own = [one for one in circles if one[1] != 12.0][12 * number : 12 * (number + 1)]
        for x, y in own:
            assert min(math.hypot(x - a, y - b) for a, b in line) < 2.0


def held_rows() -> list[tuple[str, held_by_tests.Row]]:
    """Return the rows of claims that tests hold, with their pages."""
    found = []
    for page in sorted((DOCS / "validation").glob("*.md")):
        for block in re.findall(r"^```\{held-by-tests\}\n(.*?)^```$", page.read_text("utf-8"), re.M | re.S):
            found += [(page.stem, row) for row in held_by_tests.read_rows(block.splitlines())]
    return found


@pytest.mark.slow
def test_every_claim_names_tests_that_are_there() -> None:
    rows = held_rows()
    assert len(rows) > 800
    wrong = [f"{page}: {row.claim}: {command}" for page, row in rows for command in row.commands
             if not held_by_tests.chosen(command)]  # fmt: skip
    assert not wrong, "\n".join(wrong)


@pytest.mark.slow
def test_every_number_of_a_claim_stands_in_its_tests() -> None:
    """So that it cannot grow stale."""
    wrong = [f"{page}: {row.claim}: {missing}" for page, row in held_rows()
             if (missing := held_by_tests.numbers_that_no_test_has(row))]  # fmt: skip
    assert not wrong, "\n".join(wrong)


def test_no_error_is_typed_by_hand() -> None:
    for page in sorted((DOCS / "validation").glob("*.md")):
        lines = itertools.pairwise(page.read_text("utf-8").splitlines())
        heads = [line for line, rule in lines if re.fullmatch(r"\|[-| :]+\|", rule)]
        assert not [head for head in heads if re.search(r"\| *(error|command|allowed)\b", head.lower())], page.name


SOURCE = """
import pytest
LIMIT = 3e-3
def close(a, b):
    assert abs(a - b) < 1e-7
def test_first():
    close(1, 1)
    assert 1 == pytest.approx(1, rel=1e-3)
def test_second():
    assert 1 == pytest.approx(1, abs=2e-4)
    assert len([]) < 5
def test_refused():
    with pytest.raises(ValueError): raise ValueError
def test_ordered():
    assert 1 < LIMIT * 1000
def test_equal():
    assert 1 == 1
def test_spread():
    assert 1 == pytest.approx(1, abs=0.1 * LIMIT + 1e-9)
def test_by_default():
    np.testing.assert_allclose([1], [1])
def test_of_run():
    assert all(check.passed for check in [])
"""


def test_what_tests_allow_is_read_from_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(held_by_tests, "ROOT", tmp_path)
    (tmp_path / "test_it.py").write_text(SOURCE, encoding="utf-8")
    assert held_by_tests.allowed(held_by_tests.chosen("test_it.py -k first")) == "1e-7; rel 0.001"
    assert held_by_tests.allowed(held_by_tests.chosen('test_it.py -k "first or second"')) == (
        "1e-7; rel 0.001; abs 0.0002"
    )
    assert held_by_tests.allowed(held_by_tests.chosen("test_it.py -k refused")) == "refused"
    assert held_by_tests.allowed(held_by_tests.chosen("test_it.py -k ordered")) == "a bound in the test"
    assert held_by_tests.allowed(held_by_tests.chosen("test_it.py -k equal")) == "exact"
    assert held_by_tests.allowed(held_by_tests.chosen("test_it.py -k spread")) == "a bound in the test"
    assert held_by_tests.allowed(held_by_tests.chosen("test_it.py -k by_default")) == "rel 1e-7"
    assert held_by_tests.allowed(held_by_tests.chosen("test_it.py -k of_run")) == "the run's own checks"
    assert len(held_by_tests.chosen('test_it.py -k "not (first or second)"')) == 6
    assert held_by_tests.chosen("test_it.py -k third") == ()
    row = held_by_tests.read_rows(["within 77 of 0.003 | none | test_it.py -k first"])[0]
    assert held_by_tests.numbers_that_no_test_has(row) == ["77"]


def test_speed_is_drawn_from_its_records() -> None:
    rows = measured_speed.records()
    assert {row["state"] for row in rows} == set(measured_speed.COLOURS) and len(rows) > 8
    assert all(row["exit"] == 0 and row["seconds"] > 0.0 for row in rows)
    drawn = ElementTree.fromstring(measured_speed.bars(rows))
    widths = [float(one.get("width", "0")) for one in drawn.findall(f"{SVG}rect")[1 + len(measured_speed.COLOURS) :]]
    ratios = [row["ratio"] for row in rows]
    assert len(widths) == len(rows)
    assert widths.index(max(widths)) == ratios.index(max(ratios))
    assert measured_speed.table(rows).count("<tr>") == len(rows) + 1
