"""Every command that the README and the tutorials print is one that the program takes: words, options, arguments."""

import re
import shlex
from pathlib import Path

import click
import pytest
import typer

from moyai.cli.main import app

ROOT = Path(__file__).resolve().parents[3]
PAGES = (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")))
LINE = re.compile(r"^\s*(?:\$ )?(?:\S*/)?moyai (?P<words>[a-z].*)$")


def commands(page):
    """Return the commands of the fenced blocks of a page: two spaces, a redirection or a comma end one."""
    out, fenced = [], False
    for line in page.read_text(encoding="utf-8").splitlines():
        if line.lstrip().startswith("```"):
            fenced = not fenced
            continue
        match = LINE.match(line) if fenced else None
        if match:
            words = re.split(r"\s{2,}|\s#|,\smoyai", match["words"])[0]
            words = re.split(r"\s[>|](?=(?:[^']*'[^']*')*[^']*$)", words)[0]  # a redirection, not a mark in quotes
            out.append(words.rstrip("\\").strip())
    return out


DOCUMENTED = sorted({(page.name, words) for page in PAGES for words in commands(page)})


COMMAND = typer.main.get_command(app)


def parse(words):
    """Take the words of a command apart as the program does, without running it."""
    command, arguments, context = COMMAND, shlex.split(words), None
    while True:
        context = command.make_context(arguments[0] if arguments else "moyai", list(arguments), parent=context)
        if not hasattr(command, "commands"):
            return context
        rest = [*context._protected_args, *context.args]
        _, command, arguments = command.resolve_command(context, rest)


@pytest.mark.parametrize(("page", "words"), DOCUMENTED)
def test_a_documented_command_is_taken(page, words):
    try:
        parse(words)
    except click.exceptions.BadParameter as error:
        # a file that the reader makes on the way is not there yet; everything else is a fault of the page
        assert "does not exist" in error.format_message(), f"{page}: moyai {words}: {error.format_message()}"
    except click.exceptions.UsageError as error:
        pytest.fail(f"{page}: moyai {words}: {error.format_message()}")


def test_the_readme_names_all_measurements():
    assert {words.split()[1] for words in commands(ROOT / "README.md") if words.startswith("measure ")} >= {
        "records",
        "forces",
        "nets",
        "streaks",
    }
