"""``moyai validate``: the record of every case, and the exit code."""

import json
import math

import pytest
from typer.testing import CliRunner

from moyai import validation
from moyai.cli.main import app
from moyai.cli.tables import outcome_line
from moyai.core.errors import InputError
from moyai.core.validation import ValidationCase
from moyai.language import said, spoken_in
from moyai.language.words import latin_words, numbers
from moyai.validation import choose, compute, topics

runner = CliRunner()


def broken():
    raise RuntimeError("no such file")


GOOD = ValidationCase("circle: pi", "exact", lambda: 3.1416, math.pi, 1e-5)
ABSOLUTE = ValidationCase("zero: nothing", "identity", lambda: 1e-12, 0.0, 1e-10, relative=False)
WRONG = ValidationCase("circle: wrong", "exact", lambda: 3.0, math.pi, 1e-5)
BROKEN = ValidationCase("circle: broken", "exact", broken, math.pi, 1e-5)
UNKNOWN = ValidationCase("circle: nan", "exact", lambda: math.nan, math.pi, 1e9)


@pytest.fixture
def cases(monkeypatch):
    def use(*chosen):
        monkeypatch.setattr(validation, "choose", lambda only: [("circle", case) for case in chosen])

    return use


def test_records_have_the_agreed_keys(cases):
    cases(GOOD, ABSOLUTE)
    found = runner.invoke(app, ["validate", "--json"])
    assert found.exit_code == 0
    first, second = json.loads(found.stdout)["cases"]
    assert first == {
        "name": "circle: pi",
        "source": "exact",
        "reference_kind": "exact",
        "value": 3.1416,
        "reference": math.pi,
        "error": abs(3.1416 - math.pi) / math.pi,
        "tolerance": 1e-5,
        "passed": True,
        "topic": "circle",
        "relative": True,
        "note": GOOD.note,
        "failure": "",
    }
    assert second["error"] == 1e-12


@pytest.mark.parametrize("bad", [WRONG, BROKEN, UNKNOWN])
def test_one_failure_ends_with_one_and_hides_nothing(cases, bad):
    cases(GOOD, bad, ABSOLUTE)
    found = runner.invoke(app, ["validate", "--json"])
    assert found.exit_code == 1
    assert [record["passed"] for record in json.loads(found.stdout)["cases"]] == [True, False, True]
    table = runner.invoke(app, ["validate"])
    assert table.exit_code == 1
    assert "2 of 3 cases passed" in table.stdout
    assert bad.name in table.stdout
    quiet = runner.invoke(app, ["validate", "--quiet"])
    assert GOOD.name not in quiet.stdout
    assert bad.name in quiet.stdout
    if bad is BROKEN:
        assert "RuntimeError: no such file" in table.stdout


def test_values_that_are_not_numbers_are_null_in_json(cases):
    cases(UNKNOWN)
    record = json.loads(runner.invoke(app, ["validate", "--json"]).stdout)["cases"][0]
    assert record["value"] is None
    assert record["error"] is None
    assert record["passed"] is False


@pytest.mark.parametrize(
    ("source", "kind"),
    [
        ("identity", "exact"),
        ("planted, 15 % scatter", "exact"),
        ("Ursell (1947), closed form; largest error over Kd 0.1 to 4", "published"),
        ("Arai et al., horizontal cylinders in regular waves at low KC, eq. (8)", "published"),
        ("Wieselsberger's measurements, as in textbooks", "measured"),
        (
            "MoorDyn-C 2.7.2, RK2 and RK4, converged over mesh and step; an independent prototype agrees",
            "other program",
        ),
        ("Nakamura, Ohmori and Ide, recomputed by a second program (independent prototype)", "own second"),
        ("Tabata et al., equations (1) to (5), computed independently", "own second"),
    ],
)
def test_a_row_says_where_its_reference_is_from(cases, source, kind):
    cases(ValidationCase("circle: pi", source, lambda: 3.1416, math.pi, 1e-5))
    row = runner.invoke(app, ["validate"]).stdout.splitlines()[0]
    assert row.endswith(f"|  {kind}  |  {source}")


def test_a_row_comes_as_its_case_ends():
    seen = []

    def second():
        assert [outcome.case.name for outcome in seen] == [GOOD.name]
        return 0.0

    later = ValidationCase("zero: later", "identity", second, 0.0, 1e-9, relative=False)
    outcomes = compute([("circle", GOOD), ("circle", later)], ended=seen.append)
    assert [outcome.passed for outcome in outcomes] == [True, True]


def test_progress_is_reported():
    reported = []
    compute([("circle", GOOD), ("circle", WRONG)], lambda what, done, total: reported.append((done, total)))
    assert reported == [(0, 2), (1, 2), (2, 2)]


def test_topics_are_the_modules_and_their_names_are_unique():
    assert topics()
    names = [case.name for _, case in choose(())]
    assert len(names) == len(set(names))
    for topic in topics():
        assert all(found == topic for found, _ in choose([topic]))


def test_an_unknown_topic_is_refused():
    with pytest.raises(InputError, match="unknown topic 'flotaing'"):
        choose(["flotaing"])
    found = runner.invoke(app, ["validate", "--only", "flotaing"])
    assert found.exit_code == 2
    assert "allowed: " in found.stderr


def test_claims_and_sources_in_japanese():
    """Names of programs and of authors stay as they are; every number stands in both languages."""
    cases = [case for _, case in validation.choose(())]
    assert len(cases) > 300
    with spoken_in("ja"):
        for text in {text for case in cases for text in (case.name, case.source)}:
            shown = said(text)
            assert not latin_words(shown), f"{text} -> {shown}"
            assert numbers(text) == numbers(shown), f"{text} -> {shown}"
            assert shown != text or not latin_words(text)


def test_a_line_in_japanese():
    case = next(case for _, case in validation.choose(["mooring"]) if "grounded length" in case.name)
    with spoken_in("ja"):
        line = outcome_line(validation.Outcome("mooring", case, case.reference))
    assert "係留：着底する伸びない索、着底長さ [m]" in line and line.endswith("MoorPy の試験例")
