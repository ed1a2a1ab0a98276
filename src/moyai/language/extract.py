"""The texts of the package that a person reads, as templates: every string and f-string of the source that is one.

A string is taken for a text when it has two words or more or a capital letter, or when it is given to something whose
parts are shown (a column, a figure, an error); names, keys, docstrings and formulas are none. What is filled into an
f-string becomes a place ``{0}``; a text put together by ``+`` is found part by part, as it is translated.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from moyai.language.words import latin_words

#: What shows the texts it is given, by the name it is called by.
_SHOWN = frozenset((
    "Abscissa", "Animation", "Badge", "Choice", "Column", "Criterion", "Drawing", "Fault", "Figure", "Faces",
    "Headline", "IdentityCheck", "InputError", "KeyFigure", "Listing", "Mark", "Marker", "Notice", "Option",
    "Panel", "Paragraph", "Section", "Series", "Table", "column", "number", "said", "tell", "say", "Number",
    "Band", "ConvergenceError", "_column", "progress",
))  # fmt: skip
#: Arguments of such calls that are keys.
_KEYS = frozenset((
    "key", "name", "path", "code", "group", "belongs_to", "style", "dash", "tone", "severity", "structure",
    "unit",
    "parameter", "argument",
))  # fmt: skip
_TEXT = re.compile(r"[A-Za-z]{2,}[ ,:;.-]+(?:[a-z]|\{)|\{\d+\} [a-z]{2,}|^[A-Z][a-z]+$")
_NO_TEXT = re.compile(
    r"^[\w./*\\{}\[\]=\"'<>:-]*$|^<|^\s*[.#][\w-]+\{|[{};]\s*--|</|->|^(?:dash|solid|line\+points)$|^(?:%|r?/|\$)"
    r"|^https?:|^data:|::|^@|\(\?|\\[dwsb]|^pip install |^tag:|[a-z]=\"|^#set "
)
FOLDERS = {
    "case": "errors and checks of files", "cli": "command line", "report": "reports, common", "core": "common",
    "design": "codes", "language": "", "records": "records", "study": "studies", "reproduce": "papers",
    "validation": "", "app": "app", "interop": "files of other programs", "structures": "structures",
}  # fmt: skip
"""Folders of the package and the name of their group; those without a name are not counted."""


@dataclass(frozen=True)
class Text:
    """A text of the source."""

    template: str
    #: Part of the package that it belongs to.
    group: str
    #: File below the package, and line.
    place: str


def texts(package: Path) -> Iterator[Text]:
    """Give the texts of all modules below a package, schemas as a group of their own.

    Parameters
    ----------
    package : path
        Folder of the package.
    """
    for path in sorted(package.rglob("*.py")):
        parts = path.relative_to(package).parts
        group = FOLDERS.get(parts[0], "physics") if len(parts) > 1 else ""
        if not group:
            continue
        if path.name in ("variables.py", "vocabulary.py"):
            continue  # names of results.nc, which stays English
        if path.name.startswith("schema") or path.name == "settings.py":
            group = "schemas"
        elif group in ("structures", "records", "studies"):
            group += ": errors and checks of files" if "case" in parts else ": reports and notices"
        source = path.read_text(encoding="utf-8")
        for template, line in templates(source):
            yield Text(template, group, f"{'/'.join(parts)}:{line}")
        if parts[0] == "cli":
            for text, line in helps(source):
                yield Text(text, "help of the command line", f"{'/'.join(parts)}:{line}")


def helps(source: str) -> Iterator[tuple[str, int]]:
    """Give what ``--help`` says of the commands of a module and of their options, with lines.

    Parameters
    ----------
    source : str
    """
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.keyword) and node.arg == "help" and isinstance(node.value, ast.Constant):
            yield str(node.value.value), node.value.lineno
        elif isinstance(node, ast.FunctionDef) and any(
            isinstance(item.annotation, (ast.Subscript, ast.Name)) and "Annotated" in ast.dump(item.annotation)
            for item in node.args.args
        ):
            for part in re.split(r"\n\s*\n", ast.get_docstring(node) or ""):
                yield " ".join(part.split()), node.lineno


def templates(source: str) -> Iterator[tuple[str, int]]:
    """Give the templates of the texts in the source of a module, with their lines.

    Parameters
    ----------
    source : str
    """
    finder = _Finder()
    finder.visit(ast.parse(source))
    for template, line, shown in finder.found:
        text = template.strip()
        if _is_text(text, shown):
            yield text, line


def _is_text(text: str, shown: bool) -> bool:
    if not latin_words(text) or (_NO_TEXT.search(text) and not (shown and re.fullmatch(r"[A-Za-z][a-z-]+", text))):
        return False
    return shown or _TEXT.search(text) is not None


class _Finder(ast.NodeVisitor):
    """Collects strings with their line and whether they are given to something that shows them."""

    def __init__(self) -> None:
        self.found: list[tuple[str, int, bool]] = []
        self._shown = False

    def visit_Call(self, node: ast.Call) -> None:
        name = node.func.id if isinstance(node.func, ast.Name) else getattr(node.func, "attr", "")
        if name in ("compile", "exports"):
            return  # patterns, and names of modules with what they export
        before, shows = self._shown, name in _SHOWN
        self.visit(node.func)
        for number, value in enumerate(node.args):
            keyed = name in ("Figure", "Table", "Drawing", "Animation", "Section", "Headline", "Abscissa", "Notice")
            self._shown = shows and not (keyed and number == 0)
            self.visit(value)
        for keyword in node.keywords:
            self._shown = shows and keyword.arg not in _KEYS
            if keyword.arg not in _KEYS:
                self.visit(keyword.value)
        self._shown = before

    def visit_Constant(self, node: ast.Constant) -> None:
        if isinstance(node.value, str):
            self.found.append((node.value, node.lineno, self._shown))

    def visit_JoinedStr(self, node: ast.JoinedStr) -> None:
        parts, count = [], 0
        for value in node.values:
            if isinstance(value, ast.Constant):
                parts.append(str(value.value))
            elif isinstance(value, ast.FormattedValue):
                parts.append(f"{{{count}}}")
                count += 1
                self.visit(value.value)
        self.found.append(("".join(parts), node.lineno, self._shown))

    def visit_Expr(self, node: ast.Expr) -> None:
        if not (isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)):
            self.generic_visit(node)  # a string that stands alone is a docstring

    def visit_Compare(self, node: ast.Compare) -> None:
        pass  # what is compared is a name

    def visit_Subscript(self, node: ast.Subscript) -> None:
        self.visit(node.value)

    def visit_Assign(self, node: ast.Assign) -> None:
        if not any(isinstance(target, ast.Name) and target.id == "__all__" for target in node.targets):
            self.generic_visit(node)

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        if node.value is not None:
            self.visit(node.value)

    def visit_arg(self, node: ast.arg) -> None:
        pass

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        for statement in node.body:
            self.visit(statement)
