"""The validation pages of the documentation are made from what ``moyai validate --json`` prints."""

from __future__ import annotations

import json
import math
import re
import sys
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from moyai.cli import validation
from moyai.core.validation import ValidationCase

pytest.importorskip("sphinx")
DOCS = Path(__file__).resolve().parents[3] / "docs"
sys.path.insert(0, str(DOCS))
import validation_curves  # noqa: E402 - stands beside the pages
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
