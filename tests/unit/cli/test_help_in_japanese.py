"""``--help`` of every command in the language asked for: no English sentence left, lines within the screen."""

from __future__ import annotations

import re

import pytest
import typer
from typer.testing import CliRunner

from moyai.cli.help_pages import width, wrapped
from moyai.cli.main import app

#: Words that no name of an option, a kind or a file has.
ENGLISH = ("the", "of", "and", "is", "for", "in", "with", "when", "default", "required", "or")
JAPANESE = re.compile("[\u3040-\u30ff\u4e00-\u9fff]")


def commands() -> list[tuple[str, ...]]:
    """Return the path of every command, that of the whole program first."""
    found: list[tuple[str, ...]] = [()]
    root = typer.main.get_command(app)
    for name, command in root.commands.items():  # type: ignore[attr-defined]
        found.append((name,))
        found += [(name, inner) for inner in getattr(command, "commands", {})]
    return found


def page(path: tuple[str, ...], *language: str) -> str:
    """Return the page of a command."""
    found = CliRunner().invoke(app, [*language, *path, "--help"])
    assert found.exit_code == 0, found.output
    return found.output


@pytest.mark.parametrize("path", commands(), ids=lambda path: " ".join(path) or "moyai")
def test_the_page_of_a_command(path: tuple[str, ...]) -> None:
    japanese = page(path, "--language", "ja")
    english = page(path)
    assert not JAPANESE.search(english)
    assert japanese.startswith("使い方: ")
    options = re.compile(r"^  (-.*?)(?:  |$)", re.MULTILINE)
    assert options.findall(english) == options.findall(japanese)
    assert not [word for word in ENGLISH if re.search(rf"\b{word}\b", japanese)]
    # the runner lays out 80 columns, a screen two less; a comma may hang over
    assert max(width(line) for line in japanese.splitlines()) <= 82


def test_the_locale_gives_the_language_of_help(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MOYAI_LANGUAGE", "ja")
    assert "オプション:" in page(("run",))
    assert "Options:" in page(("run",), "--language", "en")
    monkeypatch.setenv("MOYAI_LANGUAGE", "fr")
    assert "Options:" in page(("run",))


def test_lines_are_broken_between_letters() -> None:
    assert wrapped("浮防波堤の透過率、反射率 K_T and K_R を示す。", 16) == [
        "浮防波堤の透過率、",  # a comma hangs over the end rather than to begin a line
        "反射率 K_T and", "K_R を示す。",
    ]  # fmt: skip
    assert wrapped("あいう。", 6) == ["あいう。"]
    assert wrapped("ab（い", 4) == ["ab", "（い"]
    assert wrapped("", 10) == [""]
