"""What a number is held against is said in Japanese as a whole, with its source: no label is put together of words."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import moyai
from moyai.core.quantities import QuantityKind
from moyai.language.catalogue import catalogue
from moyai.language.translator import translator
from moyai.language.words import latin_words
from moyai.tables.plausible_ranges import all_ranges, kind_bounds, range_sources

LABELS = sorted({row.what for row in all_ranges() if row.structure != "kind"})
NAMES = {"TEOS", "WGS", "Munk", "ITTC", "DNV-RP-C205", "DNV", "RP", "lines", "csv", "data", "Miche", "GPa", "NS", "SDR"}
NAMES |= {"curtain", "classes", "ISO"}


def test_every_label_stands_in_the_catalogue() -> None:
    """Put together of its words, a gap between pontoons was a gap in a record and an end the front of a member."""
    known = {source[:1].lower() + source[1:] for source in catalogue("ja")}
    assert len(LABELS) > 300
    assert [label for label in LABELS if label[:1].lower() + label[1:] not in known] == []


@pytest.mark.parametrize("verdict", ["which is unusual", "which is impossible"])
def test_the_message_keeps_the_label(verdict: str) -> None:
    text = translator("ja").text
    for label in LABELS:
        said = text(f"the {label} is 0.7, {verdict}")
        assert said.startswith(text(label)), f"{label}: {said}"


def test_the_sources_are_said_in_japanese() -> None:
    text = translator("ja").text
    for source in range_sources().values():
        said = text(f"1 to 5, usually 2 to 3 (source: {source})")
        assert set(latin_words(said)) <= NAMES, said


def test_every_kind_of_quantity_is_said_in_japanese() -> None:
    """What is said of a value that is no quantity of its kind, or one that nothing in water has."""
    sources = [path.read_text("utf-8") for path in Path(moyai.__file__).parent.rglob("*.py")]
    calls = [
        node for text in sources if "Kind(" in text for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Call) and ast.unparse(node.func).split(".")[-1] == "QuantityKind"
        and len(node.args) >= 4 and all(isinstance(argument, ast.Constant) for argument in node.args[:4])
    ]  # fmt: skip
    kinds = [QuantityKind(*(argument.value for argument in node.args[:4])) for node in calls]
    assert {"a length", "a damping of the bed"} <= {kind.name for kind in kinds}
    texts = [kind.expectation() for kind in kinds]
    texts += [f"9 is no {name.split(' ', 1)[1]} that a structure in water can have" for name in kind_bounds()]
    assert {text for text in texts if translator("ja").left(text)} == set()
