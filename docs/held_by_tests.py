"""Sphinx extension: what tests hold, with the tolerances that stand in them.

A row of ``{held-by-tests}`` is ``claim | independent source | tests``. The tests are written as pytest takes them,
``FILE -k WORDS``, several parted by ``;``. Their number and what they allow are read from their source. A row that
names no test is an error of the build, and a number in a claim has to stand in its tests.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from docutils import nodes
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

ROOT = Path(__file__).resolve().parents[1]
_NUMBER = re.compile(r"(?<![\w.^/§-])\d+(?:\.\d+)?(?:e-?\d+)?(?![\w.]*[A-Za-z_]\w*\.py)")
_KINDS = {"rel": "rel ", "rtol": "rel ", "rel_tol": "rel ", "abs": "abs ", "atol": "abs ", "abs_tol": "abs "}
_WIDEST = 0.3  # a bound that is no tolerance any more
#: What functions that compare allow where nothing is said, relative; none where it differs between libraries.
_DEFAULTS = {"approx": 1e-6, "assert_allclose": 1e-7, "allclose": 1e-5, "isclose": None}


@dataclass(frozen=True)
class Test:
    """One test function."""

    file: Path
    name: str
    #: Its syntax tree, those of the functions of its module that it calls, and values for its arguments.
    parts: tuple[ast.AST, ...]
    source: str


@dataclass(frozen=True)
class Row:
    """One claim and the tests that hold it."""

    claim: str
    reference: str
    commands: tuple[str, ...]

    @property
    def tests(self) -> tuple[Test, ...]:
        """What the commands choose."""
        return tuple(dict.fromkeys(test for command in self.commands for test in chosen(command)))


def read_rows(lines: list[str]) -> list[Row]:
    """Return the rows that the lines of a directive hold.

    Raises
    ------
    ValueError
        When a line has not three parts.
    """
    found = []
    for line in lines:
        if line.strip():
            claim, reference, tests = (part.strip() for part in re.split(r"(?<!\\) \| ", line))
            found.append(Row(claim, reference, tuple(part.strip() for part in tests.split(";"))))
    return found


@cache
def chosen(command: str) -> tuple[Test, ...]:
    """Return the tests that ``FILE -k WORDS`` or ``FOLDER`` chooses."""
    place, _, words = command.partition(" -k ")
    path = ROOT / place.strip()
    files = sorted(path.rglob("test_*.py")) if path.is_dir() else [path] if path.exists() else []
    words = words.strip().strip('"')
    return tuple(test for file in files for test in tests_of(file) if not words or _named(words, test))


def _named(words: str, test: Test) -> bool:
    """Whether the words of ``-k`` fit a test: names joined by and, or, not."""
    name = f"{test.file.name}::{test.name}".lower()
    terms = re.sub(r"[^\s()]+", lambda word: word[0] if word[0] in ("and", "or", "not")
                   else str(word[0].lower() in name), words)  # fmt: skip
    return bool(eval(terms, {"__builtins__": {}}))


@cache
def tests_of(file: Path) -> tuple[Test, ...]:
    """Return the test functions of a file."""
    text = file.read_text(encoding="utf-8")
    tree = ast.parse(text)
    functions = {node.name: node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}
    return tuple(
        Test(file, name, tuple(_with_helpers(node, functions)), text)
        for name, node in functions.items()
        if name.startswith("test_")
    )


def _with_helpers(node: ast.FunctionDef, functions: dict[str, ast.FunctionDef]) -> Iterator[ast.AST]:
    """Give a function and those of its module that it calls, each once."""
    waiting, seen = [node], {node.name}
    while waiting:
        current = waiting.pop()
        yield current
        for call in ast.walk(current):
            name = call.func.id if isinstance(call, ast.Call) and isinstance(call.func, ast.Name) else ""
            if name in functions and name not in seen:
                seen.add(name)
                waiting.append(functions[name])


def allowed(tests: tuple[Test, ...]) -> str:
    """Return what the assertions of tests allow: the tightest and the widest; exact where they state nothing."""
    found: dict[str, set[float]] = {"": set(), "rel ": set(), "abs ": set()}
    raises = bounded = checked = False
    for test in tests:
        for part in test.parts:
            for node in ast.walk(part):
                for kind, value in _bounds(node):
                    found[kind].add(value)
                raises = raises or (isinstance(node, ast.Attribute) and node.attr in ("raises", "warns"))
                bounded = bounded or _called(node) in _DEFAULTS
                checked = checked or (isinstance(node, ast.Attribute) and node.attr == "passed")
                bounded = bounded or (isinstance(node, ast.Assert) and any(map(_is_order, ast.walk(node))))
    texts = []
    for kind, values in found.items():
        if values:
            least, most = min(values), max(values)
            texts.append(f"{kind}{_text(least)}" + (f" to {_text(most)}" if most > least else ""))
    other = {"a bound in the test": bounded, "the run's own checks": checked, "refused": raises, "exact": True}
    return "; ".join(texts) or next(words for words, holds in other.items() if holds)


def _is_order(node: ast.AST) -> bool:
    """Whether a node compares sizes."""
    return isinstance(node, ast.Compare) and any(
        isinstance(one, ast.Lt | ast.LtE | ast.Gt | ast.GtE) for one in node.ops
    )


def _text(value: float) -> str:
    return re.sub(r"e([+-])0*", r"e\1", f"{value:.3g}").replace("e+", "e")


def _called(node: ast.AST) -> str:
    """Return the last name of the function that a node calls, empty for other nodes."""
    function = node.func if isinstance(node, ast.Call) else None
    return function.id if isinstance(function, ast.Name) else getattr(function, "attr", "")


def _bounds(node: ast.AST) -> Iterator[tuple[str, float]]:
    """Give the tolerances that a node states, with their kind."""
    if isinstance(node, ast.Call):
        name = _called(node)
        if name in _DEFAULTS:
            stated = False
            for keyword in node.keywords:
                kind = _KINDS.get(keyword.arg or "")
                if kind:
                    stated = True
                    value = _value(keyword.value)
                    if value:
                        yield kind, value
            default = _DEFAULTS[name]
            if not stated and default is not None:
                yield "rel ", default
    elif isinstance(node, ast.Compare) and len(node.ops) == 1 and isinstance(node.ops[0], ast.Lt | ast.LtE):
        value = _value(node.comparators[0])
        measured = any(
            getattr(one.func, "id", getattr(one.func, "attr", "")) in ("abs", "max", "norm", "hypot", "amax", "nanmax")
            for one in ast.walk(node.left) if isinstance(one, ast.Call)
        )  # fmt: skip
        if value and value < _WIDEST and (measured or value < 1e-2):
            yield "", value


def _value(node: ast.AST) -> float | None:
    """Return a number that stands in the source, or none."""
    try:
        return float(eval(compile(ast.Expression(node), "", "eval"), {"__builtins__": {}}))  # type: ignore[arg-type]
    except (NameError, TypeError, ValueError, AttributeError, ZeroDivisionError, KeyError):
        return None


def numbers_that_no_test_has(row: Row) -> list[str]:
    """Return the numbers of a claim that do not stand in its tests."""
    text = "\n".join({test.source for test in row.tests})
    held = {_plain(found) for found in re.findall(r"\d[\d_]*(?:\.\d*)?(?:e-?\d+)?|\.\d+", text)}
    bare = re.sub(r"`[^`]*`|\{[a-z]+\}`[^`]*`", " ", row.claim)
    return [found for found in _NUMBER.findall(bare) if _plain(found) not in held and float(found) > 2]


def _plain(text: str) -> float:
    return float(text.replace("_", ""))


class HeldByTests(SphinxDirective):
    """Table of claims with the tests that hold them."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        """Return the table; its cells are Markdown."""
        try:
            found = read_rows(list(self.content))
        except ValueError:
            raise self.error("a row is: claim | independent source | tests") from None
        lines = ["| claim | independent source | allowed | tests |", "|---|---|---|---|"]
        for row in found:
            tests = row.tests
            if not tests:
                raise self.error(f"no test is chosen by: {'; '.join(row.commands)}")
            commands = ", ".join(f"`pytest {command}`" for command in row.commands)
            lines.append(f"| {row.claim} | {row.reference} | {allowed(tests)} | {len(tests)}: {commands} |")
        self.env.note_dependency(__file__)
        held: Any = nodes.container(classes=["held-by-tests"])
        self.state.nested_parse(StringList(lines, source=str(self.env.docname)), self.content_offset, held)
        return [held]


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("held-by-tests", HeldByTests)
    return {"parallel_read_safe": True}
