"""Pages of ``--help`` in the language asked for: by ``--language`` at any place, else that of the locale.

Texts of commands and options stay English in the source and are put into the language where the page is laid out;
lines of Japanese are broken between letters, by their width on the screen.
"""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Sequence
from copy import copy
from typing import Any

from typer.core import TyperGroup

from moyai.core.errors import InputError
from moyai.language import language_of_the_locale, said, spoken_in, spoken_language
from moyai.language.catalogue import LANGUAGES
from moyai.language.words import breadth

_Context: Any = TyperGroup.context_class
_Formatter: Any = _Context.formatter_class

#: What no line begins with.
_NOT_FIRST = "、。；：，．）」』〕】％・～ーっょゃゅ)],.;:%"
#: What may stand beyond the end of a line.
_HANGING = "、。"
_NOT_LAST = "（「『〔【(["
_PIECES = re.compile(r"[!-~]+ ?|.", re.DOTALL)
#: Short sentences of click, by words that a message of the catalogue can be found by.
_WHOLE = (
    (r"^Missing (argument|option) ('.*')\.$", r"Missing, and has to be given: \1 \2"),
    (r"^No such command ('[^']*')\.$", r"There is no command of the name \1"),
    (r"^Option ('[^']*') requires an argument\.$", r"There is no value behind the option \1"),
    (r"^Option ('[^']*') does not take a value\.$", r"No value may follow the option \1"),
)
#: What click puts behind the help of an option: [required], [default: 3].
_EXTRA = re.compile(r"^(.*?)(\s\s\[[^\[\]]*\])$", re.DOTALL)


def wrapped(text: str, columns: int) -> list[str]:
    """Break a text of Japanese and Latin words into lines.

    Parameters
    ----------
    text : str
    columns : int
        Width of a line on the screen.
    """
    lines = [""]
    for piece in _PIECES.findall(" ".join(text.split())):
        last = lines[-1]
        over = breadth(last) + breadth(piece.rstrip()) - columns
        if over > 0 and last and not (piece in _HANGING and over <= breadth(piece) and last[-1] not in _NOT_FIRST):
            moved = last[-1] if last[-1] in _NOT_LAST or piece[0] in _NOT_FIRST else ""
            lines[-1] = last[: len(last) - len(moved)].rstrip()
            lines.append(moved)
        lines[-1] += piece
    return [line.rstrip() for line in lines]


class SpokenFormatter(_Formatter):  # type: ignore[misc]
    """Lays out the page of a command in the language in force."""

    def write_usage(self, prog: str, args: str = "", prefix: str | None = None) -> None:
        """Write the line of usage."""
        super().write_usage(prog, args, prefix if spoken_language() == "en" else f"{said('Usage')}: ")

    def write_heading(self, heading: str) -> None:
        """Write the heading of a list."""
        super().write_heading(said(heading))

    def write_text(self, text: str) -> None:
        """Write paragraphs."""
        if spoken_language() == "en":
            super().write_text(text)
            return
        paragraphs = re.split(r"\n\s*\n", text)
        indent = " " * self.current_indent
        pages = [
            "".join(f"{indent}{line}\n" for line in wrapped(said(" ".join(part.split())), self.width - len(indent)))
            for part in paragraphs
        ]
        self.write("\n".join(pages))

    def write_dl(self, rows: Sequence[tuple[str, str]], col_max: int = 30, col_spacing: int = 2) -> None:
        """Write a list of names and what they mean."""
        if spoken_language() == "en":
            super().write_dl(rows, col_max, col_spacing)
            return
        first = min(max(breadth(name) for name, _ in rows), col_max) + col_spacing
        indent = " " * self.current_indent
        for name, text in rows:
            lines = wrapped(_spoken_help(text), max(self.width - first - 2, 10))
            head = f"{indent}{name}"
            if breadth(name) > first - col_spacing:
                self.write(f"{head}\n")
                head = ""
            pad = " " * (first + len(indent))
            self.write(f"{head}{pad[breadth(head) :]}{lines[0]}\n")
            self.write("".join(f"{pad}{line}\n" for line in lines[1:]))


def _spoken_help(text: str) -> str:
    """Return the help of an option; what stands in brackets behind it word by word."""
    found = _EXTRA.match(text)
    if found is None:
        return said(text)
    parts = (part.partition(": ") for part in found[2].strip()[1:-1].split("; "))
    return f"{said(found[1].strip())} [{'; '.join(f'{said(head)}{colon}{value}' for head, colon, value in parts)}]"


class SpokenContext(_Context):  # type: ignore[misc]
    """A context whose pages are laid out in the language in force."""

    formatter_class = SpokenFormatter


class SpokenGroup(TyperGroup):
    """A group of commands whose pages are in the language asked for."""

    context_class = SpokenContext

    def main(self, args: Sequence[str] | None = None, *rest: Any, **named: Any) -> Any:
        """Run the command; the language of help is that of ``--language`` at any place, else of the locale."""
        with spoken_in(_language_of_help(sys.argv[1:] if args is None else args)):
            if spoken_language() == "en" or not named.get("standalone_mode", True):
                return super().main(args, *rest, **named)
            try:
                code = super().main(args, *rest, **{**named, "standalone_mode": False})
            except Exception as error:
                # errors of options: the classes differ between releases of the parser, what they can do does not
                if not hasattr(error, "format_message"):
                    raise
                _tell_of(error)
                code = error.exit_code  # type: ignore[attr-defined]
            sys.exit(code if isinstance(code, int) else 0)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        """Return a command, its page and its line in the list of commands in the language in force."""
        command = super().get_command(ctx, cmd_name)
        if command is not None:
            command = copy(command)
            command.context_class = SpokenContext
            if spoken_language() != "en" and command.help:
                first = re.split(r"\n\s*\n", inspect.cleandoc(command.help))[0]
                command.short_help = said(" ".join(first.split()))
        return command


def _tell_of(error: Any) -> None:
    """Print usage and what is wrong with the words of a command."""
    lines, context = [], getattr(error, "ctx", None)
    message = error.format_message()
    if context is not None and message == context.get_help():
        lines = [message]  # no command at all: its page
    else:
        if context is not None:
            lines = [context.get_usage(), said(f"Try '{context.command_path} --help' for help."), ""]
        for short, whole in _WHOLE:
            message = re.sub(short, whole, message)
        lines.append(f"{said('Error')}: {said(message)}")
    sys.stderr.write("\n".join(lines) + "\n")


def _language_of_help(arguments: Sequence[str]) -> str:
    for at, word in enumerate(arguments):
        name, _, value = word.partition("=")
        if name == "--language":
            asked = value or "".join(arguments[at + 1 : at + 2])
            return asked if asked in LANGUAGES else "en"
    try:
        return language_of_the_locale()
    except InputError:  # the command itself says so
        return "en"
