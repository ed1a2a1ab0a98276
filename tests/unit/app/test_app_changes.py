"""Changes that a form makes: one value, one key; everything else of the text stays as it was."""

from __future__ import annotations

import random
from typing import Any

import pytest

from moyai.case.templates import template
from moyai.case.text_changes import flow, with_key, with_scalar, without_key
from moyai.case.yaml_reader import parse_yaml
from moyai.core.errors import InputError

TEMPLATES = ("breakwater", "curtain", "cage", "rigid_cage", "network", "member")


@pytest.mark.parametrize(
    ("text", "words", "changed"),
    [
        ("a: 3 m   # c\nb: 1\n", "4 m", "a: 4 m   # c\nb: 1\n"),
        ("a: '3 m'\n", "4 m", "a: '4 m'\n"),
        ('a: "x"\n', "y: z", 'a: "y: z"\n'),
        ("a: x\n", "y: z", "a: 'y: z'\n"),
        ("a: x # c\r\nb: 1\r\n", "y # z", "a: 'y # z' # c\r\nb: 1\r\n"),
        ("a: true\n", "false", "a: false\n"),
        ("a: '3 m'\n", "4", "a: 4\n"),
        ("a: auto\n", "4.0", "a: 4.0\n"),
        ("b: 1\na: 浮体\n", "it's", "b: 1\na: it's\n"),
    ],
)
def test_a_scalar_is_set_in_place(text: str, words: str, changed: str) -> None:
    assert with_scalar(parse_yaml(text), ("a",), words).text == changed


def test_text_that_looks_like_a_number_is_quoted() -> None:
    assert with_scalar(parse_yaml("a: x"), ("a",), "12", as_text=True).text == "a: '12'"
    assert with_scalar(parse_yaml("l: {a: x}"), ("l", "a"), "b, c").text == "l: {a: 'b, c'}"
    assert with_scalar(parse_yaml("l:\n  - 1\n  - 2 # two\n"), ("l", 1), "3").text == "l:\n  - 1\n  - 3 # two\n"


@pytest.mark.parametrize(
    ("text", "path"),
    [("a: [1]", ("a",)), ("a: |\n  x\n", ("a",)), ("b: 1", ("a",)), ("b: &x {a: 1}\nc: *x\n", ("b", "a"))],
)
def test_what_cannot_be_set_alone_is_refused(text: str, path: Any) -> None:
    with pytest.raises(InputError):
        with_scalar(parse_yaml(text), path, "2")


def test_no_value_is_set_to_nothing() -> None:
    for words in ("", "null", "~", "1\nb: 2"):
        with pytest.raises(InputError):
            with_scalar(parse_yaml("a: 1\n"), ("a",), words)


@pytest.mark.parametrize(
    ("text", "path", "changed"),
    [
        ("a: 1 # one\nb: 2 # two\n# end\n", ("a",), "b: 2 # two\n# end\n"),
        ("a: 1\nb:\n  c: 2\n  # in b\n  d: [1,\n    2]\n\n# of e\ne: 3\n", ("b",), "a: 1\n\n# of e\ne: 3\n"),
        ("a: {b: 1, c: 2}\n", ("a", "b"), "a: {c: 2}\n"),
        ("a: {b: 1, c: 2}\n", ("a", "c"), "a: {b: 1}\n"),
        ("l:\n  - n: 1\n    m: 2\n  - n: 3\n", ("l", 0, "n"), "l:\n  - m: 2\n  - n: 3\n"),
        ("l:\n  - n: 1\n    m: 2\n  - n: 3\n", ("l", 0), "l:\n  - n: 3\n"),
        ("l:\n  - n: 1\n    m: 2\n", ("l", 0, "m"), "l:\n  - n: 1\n"),
        ("l: [1, 2, 3]\n", ("l", 1), "l: [1, 3]\n"),
        ("a: 1\nb: 2", ("b",), "a: 1\n"),
        ("b: &x {a: 1}\nc: *x\nd: 1\n", ("c",), "b: &x {a: 1}\nd: 1\n"),
    ],
)
def test_a_key_is_taken_out(text: str, path: Any, changed: str) -> None:
    assert without_key(parse_yaml(text), path).text == changed


@pytest.mark.parametrize(
    ("text", "path"),
    [
        ("a: {b: 1}", ("a", "b")),
        ("b: 1", ("a",)),
        ("b: &x 1\nc: *x\n", ("b",)),
        ("l:\n  - n: 1\n    # c\n    m: 2\n", ("l", 0, "n")),
    ],
)
def test_what_cannot_be_taken_out_alone_is_refused(text: str, path: Any) -> None:
    with pytest.raises(InputError):
        without_key(parse_yaml(text), path)


@pytest.mark.parametrize(
    ("text", "path", "value", "after", "changed"),
    [
        ("a: 1 # one\n# end\n", ("b",), "2 m", "", "a: 1 # one\nb: 2 m\n# end\n"),
        ("a: 1", ("b",), [1, "x"], "", "a: 1\nb: [1, x]\n"),
        ("a: 1\r\nc: 2\r\n", ("b",), True, "a", "a: 1\r\nb: true\r\nc: 2\r\n"),
        ("a:\n  b: 1\n\nd: 2\n", ("a", "c"), {"x": 1, "y": "2 m"}, "", "a:\n  b: 1\n  c: {x: 1, y: 2 m}\n\nd: 2\n"),
        ("a: {b: 1}\n", ("a", "c"), "x", "", "a: {b: 1, c: x}\n"),
        ("a: {}\n", ("a", "c"), "x, y", "", "a: {c: 'x, y'}\n"),
        ("l:\n  - n: 1\n  - n: 2\n", ("l", 0, "m"), 3, "", "l:\n  - n: 1\n    m: 3\n  - n: 2\n"),
    ],
)
def test_a_key_is_added(text: str, path: Any, value: Any, after: str, changed: str) -> None:
    assert with_key(parse_yaml(text), path, value, after=after).text == changed


def test_keys_are_not_added_twice_nor_to_what_is_no_block() -> None:
    for text, path in (("a: 1", ("a",)), ("a: 1", ("a", "b")), ("b: &x {a: 1}\nc: *x\n", ("c", "d"))):
        with pytest.raises(InputError):
            with_key(parse_yaml(text), path, 1)


@pytest.mark.parametrize("value", ["", "1", "true", "a: b", "x # y", "[", "it's", '"', "浮", "- a", "1e3", "null"])
def test_text_is_text_again(value: str) -> None:
    assert parse_yaml(f"a: {flow({'b': value})}").data == {"a": {"b": value}}


@pytest.mark.slow
@pytest.mark.parametrize("name", TEMPLATES)
def test_every_scalar_and_key_of_a_template_is_changed_alone_or_refused(name: str) -> None:
    """Random changes: the text differs where it should, and setting the old value brings the old text back."""
    document = parse_yaml(template(name))
    picked = random.Random(7).sample(sorted(document.values, key=str), 40)
    kept = 0
    for path in (path for path in picked if path):
        place = document.values[path]
        try:
            changed = with_scalar(document, path, "7.25")
        except InputError:
            continue
        kept += 1
        differing = [
            number
            for number, pair in enumerate(zip(document.text.splitlines(), changed.text.splitlines(), strict=True), 1)
            if pair[0] != pair[1]
        ]
        assert differing == [place.line]
    assert kept > 15
    taken = 0
    for path in (path for path in picked if path):
        try:
            shorter = without_key(document, path)
        except InputError:
            continue
        taken += 1
        comments = [line for line in document.text.splitlines() if line.lstrip().startswith("#")]
        left = [line for line in shorter.text.splitlines() if line.lstrip().startswith("#")]
        assert set(left) <= set(comments) and len(shorter.text) < len(document.text)
    assert taken > 10
