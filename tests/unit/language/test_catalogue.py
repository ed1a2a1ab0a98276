"""The catalogue of Japanese: sound message files, places and digits as in English, terms as in the glossary."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest
from babel.messages.pofile import read_po

import moyai
from moyai.core.errors import InputError
from moyai.language import language_of_the_locale, require_language
from moyai.language.catalogue import catalogue, entries, page_catalogue
from moyai.language.missing import COMMENTS, all_texts, coverage, is_translated
from moyai.language.words import numbers

FILES = sorted((Path(moyai.__file__).parent / "language" / "ja").glob("*.po"))
PAGE = sorted((Path(moyai.__file__).parent / "language" / "ja" / "page").glob("*.po"))
GLOSSARY = Path(__file__).resolve().parents[3] / "docs" / "glossary.md"
JAPANESE = re.compile("[\u3040-\u30ff\u4e00-\u9fff]")


@pytest.mark.parametrize("path", [*FILES, *PAGE], ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_babel_reads_every_file_as_the_package_does(path: Path) -> None:
    with path.open("rb") as stream:
        found = {str(message.id): str(message.string) for message in read_po(stream, locale="ja") if message.id}
    text = path.read_text(encoding="utf-8")
    own = [pair for pair in entries(text) if pair[0]]
    assert dict(own) == found
    assert len(own) == len(found), "a message is given twice"


def test_no_message_stands_in_two_files() -> None:
    total = sum(1 for path in FILES for source, _ in entries(path.read_text(encoding="utf-8")) if source)
    assert total == len(catalogue("ja"))


def test_places_and_digits_are_those_of_the_english() -> None:
    places = re.compile(r"\{\d+\}")
    for source, target in (*catalogue("ja").items(), *page_catalogue("ja").items()):
        assert sorted(places.findall(source)) == sorted(places.findall(target)), source
        assert numbers(places.sub("", source)) == numbers(places.sub("", target)), source


def terms() -> list[tuple[str, list[str]]]:
    """Return the terms of the glossary with what they may be called in Japanese."""
    found = []
    for line in GLOSSARY.read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.split("|")]
        if len(cells) < 6 or cells[1] == "term" or not JAPANESE.search(cells[2]):
            continue
        names = [name.strip() for name in re.sub(r" \(.*\)", "", cells[1]).split(",")]
        words = [word for word in re.split("[（）、・]", cells[2]) if word]
        if cells[1] == "surge, sway":
            found += [("surge", words[:1]), ("sway", words[1:])]
        else:
            found += [(name, [*words, cells[2]]) for name in names]
    return found


def test_the_catalogue_takes_the_terms_of_the_glossary() -> None:
    known = {source.lower(): target for source, target in catalogue("ja").items()}
    wrong = [
        f"{name}: {known.get(name.lower())}, not {words}"
        for name, words in terms()
        if known.get(name.lower()) not in words
    ]
    assert len(terms()) > 80
    assert not wrong, "\n".join(wrong)


@pytest.mark.slow
def test_the_share_that_is_translated_does_not_fall() -> None:
    groups, missing = coverage(all_texts(), "ja")
    share = {group.group: group.translated / group.total for group in groups}
    assert len(missing) == sum(group.total - group.translated for group in groups)
    for name, least in LEAST.items():
        assert share[name] >= least, (
            f"{name}: {share[name]:.3f}; python -m moyai.language.missing lists what is missing"
        )


def test_marks_of_moving_drawings_are_translated() -> None:
    """Their words stand alone in the drawing, and only long runs show some of them."""
    labels = {
        node.args[1].value
        for path in Path(moyai.__file__).parent.rglob("report/*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "Marker"
        if isinstance(node.args[1], ast.Constant)
    }
    assert labels >= {"support", "anchor"}
    assert {label for label in labels if not is_translated(label, "ja")} == set()


LEAST = {
    "help of the command line": 1.0,
    COMMENTS: 0.95,
    "command line": 0.95,
    "app": 0.85,
    "codes": 0.85,
    "common": 0.85,
    "reports, common": 0.84,
    "errors and checks of files": 0.86,
    "structures: errors and checks of files": 0.93,
    "structures: reports and notices": 0.95,
    "studies: reports and notices": 0.95,
    "papers": 0.95,
    "records: reports and notices": 0.98,
    "records: errors and checks of files": 0.98,
    "schemas": 1.0,
    "physics": 0.95,
    "files of other programs": 0.8,
}
"""Least share of each group that has to be translated."""


@pytest.mark.parametrize(
    ("variables", "language"),
    [
        ({"LANG": "ja_JP.UTF-8"}, "ja"),
        ({"LANG": "C.UTF-8"}, "en"),
        ({"LC_ALL": "de_DE.UTF-8", "LANG": "ja_JP.UTF-8"}, "en"),
        ({"LC_MESSAGES": "ja_JP", "LANG": "en_US"}, "ja"),
        ({"LANG": "ja_JP.UTF-8", "MOYAI_LANGUAGE": "en"}, "en"),
        ({}, "en"),
    ],
)
def test_the_locale_gives_the_language(
    monkeypatch: pytest.MonkeyPatch, variables: dict[str, str], language: str
) -> None:
    for name in ("LC_ALL", "LC_MESSAGES", "LANG", "MOYAI_LANGUAGE"):
        monkeypatch.delenv(name, raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    assert language_of_the_locale() == language


def test_other_languages_are_refused() -> None:
    with pytest.raises(InputError, match="'fr' is no language of reports"):
        require_language("fr")
