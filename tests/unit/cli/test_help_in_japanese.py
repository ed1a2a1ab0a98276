"""``--help`` of every command in the language asked for: no English sentence left, lines within the screen."""

from __future__ import annotations

import re

import pytest
import typer
from typer.testing import CliRunner

from moyai.cli.help_pages import wrapped
from moyai.cli.main import app
from moyai.language.words import breadth

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
    assert max(breadth(line) for line in japanese.splitlines()) <= 82


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


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["report", "--nope"], "エラー: そのようなオプションはない：--nope"),
        (["report"], "エラー: 引数 'RESULTS' がない"),
        (["nope"], "エラー: そのようなコマンドはない：'nope'"),
        (["reprot"], "エラー: そのようなコマンドはない：'reprot'。'report', 'reproduce'か"),
        ([], "エラー: コマンドがない"),
        (["report", "a", "b"], "エラー: 余分な引数がある（b）"),
        (["report", "a", "--units"], "エラー: オプション '--units' には値が要る"),
        (["report", "a", "--pdf=3"], "エラー: オプション '--pdf' は値を取らない"),
        (["convert", "a", "--duration", "abc"], "'--duration'の値が正しくない：数値を与える。"),
        (["convert", "a", "--depth", "-3"], "'--depth'の値が正しくない：0.000001 以上の値を与える"),
    ],
)
def test_errors_of_options_are_japanese(words: list[str], message: str) -> None:
    found = CliRunner().invoke(app, ["--language", "ja", *words])
    assert found.exit_code == 2
    assert message in found.stderr
    assert "Error" not in found.stderr and "Try" not in found.stderr
    english = CliRunner().invoke(app, ["--language", "en", *words])
    assert english.exit_code == 2 and "Error: " in english.stderr


def test_exit_codes_are_those_of_the_command() -> None:
    assert CliRunner().invoke(app, ["--language", "ja", "--version"]).exit_code == 0
    assert CliRunner().invoke(app, ["--language", "ja", "check", "absent.yaml"]).exit_code == 2


def test_cases_of_validation_are_said_in_japanese() -> None:
    from moyai.cli.tables import outcome_line
    from moyai.core.validation import ValidationCase
    from moyai.language import spoken_in
    from moyai.validation import Outcome

    name = "mooring: inextensible line on the bed, H [N]"
    case = ValidationCase(name, "MoorPy test case", lambda: 1.0, 2.0, 0.01)
    with spoken_in("ja"):
        line = outcome_line(Outcome("mooring", case, 2.002))
    name, kind, source = line.split("  |  ")
    assert name == "ok      係留：着底する伸びない索、H [N]: 2.002（基準 2）、誤差 0.1 %（許容 1 %）"
    assert (kind, source) == ("他のプログラム", "MoorPy の試験例")
