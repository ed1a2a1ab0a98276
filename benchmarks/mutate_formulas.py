"""Change formulas one at a time and see whether a fast test notices.

``python benchmarks/mutate_formulas.py`` takes the hundred changes of ``formulas.txt`` one after the other: it copies
the package, changes a line, runs the fast tests that name the changed function or import its module, then, where these
see nothing, all others of its package, and sets the line back. It prints a line for every change and at the end a
table by package. Results are kept in ``--results``; what stands there is not run again. Survivors are to be looked at:
a change may be without effect (a guard, a tolerance, a start value), or a test is missing.

``--count 60 --seed 1`` draws other changes instead: an operator, a constant or a function in a formula that names its
equation.
"""

from __future__ import annotations

import argparse
import ast
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LIST = Path(__file__).with_name("formulas.txt")
PACKAGES = [
    "sea",
    "series",
    "potential",
    "morison",
    "mooring",
    "flexible",
    "floating",
    "coupled",
    "design",
    "structures/breakwater",
    "structures/curtain",
    "structures/cage",
    "structures/network",
    "structures/member",
    "structures/units",
    "records",
]
#: Parts of packages that hold no physics
QUIET = {"report", "case", "cli", "variables.py", "headlines.py", "run.py", "datasets.py", "kernels.txt"}
OPERATORS = {ast.Add: ("+", "-"), ast.Sub: ("-", "+"), ast.Mult: ("*", "/"), ast.Div: ("/", "*")}
FUNCTIONS = {"sin": "cos", "cos": "sin", "sinh": "cosh", "cosh": "sinh", "tanh": "sinh", "exp": "cosh", "sqrt": "abs"}


@dataclass(frozen=True)
class Change:
    """One change of one line."""

    #: File below the package.
    file: str
    #: Which of the lines that read alike, from 1.
    which: int
    #: The line without its indent, and what stands there instead.
    old: str
    new: str

    @property
    def package(self) -> str:
        parts = self.file.split("/")
        return "/".join(parts[: 2 if parts[0] == "structures" else 1])

    def __str__(self) -> str:
        """Return the change in one line, which is its key among the results."""
        return f"{self.file}: {self.old}  ->  {self.new}" + (f"  ({self.which})" if self.which > 1 else "")

    def applied(self, text: str) -> str:
        """Return the text of the file with the change."""
        lines, place = text.split("\n"), self.place(text)
        lines[place] = lines[place].replace(self.old, self.new)
        return "\n".join(lines)

    def place(self, text: str) -> int:
        """Return which line of the file is changed, from 0."""
        places = [number for number, line in enumerate(text.split("\n")) if line.strip() == self.old]
        if len(places) < self.which:
            raise LookupError(f"{self.file} no longer holds {self.old!r}: write the line of {LIST.name} again")
        return places[self.which - 1]

    def function(self, text: str) -> str:
        """Return the name of the innermost function that holds the line, empty outside of functions."""
        line = self.place(text) + 1
        around = [
            node
            for node in ast.walk(ast.parse(text))
            if isinstance(node, ast.FunctionDef) and node.lineno <= line <= (node.end_lineno or 0)
        ]
        return max(around, key=lambda node: node.lineno).name if around else ""


def listed(path: Path = LIST) -> list[Change]:
    """Return the changes of the list: file, which of lines that read alike or nothing, line, changed line; tabs."""
    rows = [line.split("\t") for line in path.read_text(encoding="utf-8").splitlines()]
    return [Change(file, int(which or 1), old, new) for file, which, old, new in rows]


def offsets(text: str) -> list[int]:
    """Return where each line begins, in bytes."""
    found = [0]
    for line in text.encode().split(b"\n"):
        found.append(found[-1] + len(line) + 1)
    return found


def changes_of(path: Path, package: Path) -> list[Change]:
    """Return every change of the formulas of a module that name an equation."""
    text = path.read_text(encoding="utf-8")
    raw, begin = text.encode(), offsets(text)
    lines = text.splitlines()
    found: dict[tuple[int, int], Change] = {}

    def note(start: int, end: int, new: str) -> None:
        number = raw[:start].count(b"\n")
        changed = (raw[:start] + new.encode() + raw[end:]).decode().splitlines()[number]
        old = lines[number].strip()
        which = sum(line.strip() == old for line in lines[: number + 1])
        found.setdefault((start, end), Change(str(path.relative_to(package)), which, old, changed.strip()))

    for function in ast.walk(ast.parse(text)):
        if not isinstance(function, ast.FunctionDef) or "[eq:" not in (ast.get_docstring(function) or ""):
            continue
        # what stands in a message is no formula
        words = {inner for node in ast.walk(function) if isinstance(node, ast.JoinedStr) for inner in ast.walk(node)}
        for node in (inner for statement in function.body[1:] for inner in ast.walk(statement)):
            if node in words:
                continue
            if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
                sign, other = OPERATORS[type(node.op)]
                left, right = node.left, node.right
                start = begin[(left.end_lineno or 1) - 1] + (left.end_col_offset or 0)
                end = begin[right.lineno - 1] + right.col_offset
                place = raw[start:end].decode().find(sign)
                if place >= 0:
                    note(start + place, start + place + 1, other)
            elif isinstance(node, ast.Constant) and isinstance(node.value, float) and node.value not in (0.0, 1.0):
                start = begin[node.lineno - 1] + node.col_offset
                end = begin[node.lineno - 1] + (node.end_col_offset or 0)
                if 1e-3 <= abs(node.value) <= 1e3:
                    note(start, end, repr(1.1 * node.value))
            elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in FUNCTIONS:
                end = begin[(node.func.end_lineno or 1) - 1] + (node.func.end_col_offset or 0)
                note(end - len(node.func.attr), end, FUNCTIONS[node.func.attr])
    return list(found.values())


def tests_of(file: str, function: str = "") -> list[str]:
    """Return test files for a changed function: named for its module, naming it, importing the module, and so on.

    After these come those of its package, those that import what imports it, and the designs of its structure; short
    files first within each.
    """

    def importers(name: str, paths: list[Path]) -> list[Path]:
        module = "moyai." + name.removesuffix(".py").replace("/", ".")
        package, last = module.rsplit(".", 1)
        direct = re.compile(rf"{re.escape(module)}\b|from {re.escape(package)} import [^\n]*\b{last}\b")
        return [path for path in paths if direct.search(path.read_text(encoding="utf-8"))]

    tests = sorted((ROOT / "tests").rglob("test_*.py"), key=lambda path: path.stat().st_size)
    sources = sorted((ROOT / "src" / "moyai").rglob("*.py"))
    package = file.split("/")[1 if file.startswith("structures/") else 0]
    named = re.compile(rf"\b{function}\b") if function else None
    stem = Path(file).stem
    found = [path for path in tests if stem in path.stem.split("test_", 1)[1]]
    found += [path for path in tests if named and named.search(path.read_text(encoding="utf-8"))]
    found += importers(file, tests)
    found += [path for path in tests if path.parent.name == package]
    for source in importers(file, sources):
        found += importers(source.relative_to(ROOT / "src" / "moyai").as_posix(), tests)
    found += [path for path in tests if path.parent.name == "design" and package in path.stem]
    return list(dict.fromkeys(str(path.relative_to(ROOT)) for path in found))


def outcome(source: Path, tests: list[str], seconds: float) -> str:
    """Return what the tests say to the package as it stands in ``source``: noticed, TOO SLOW or SURVIVED."""
    environment = {**os.environ, "PYTHONPATH": str(source.parent), "OMP_NUM_THREADS": "1"}
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *tests]
    try:
        done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, timeout=seconds, check=False)
    except subprocess.TimeoutExpired:
        return "TOO SLOW"
    return "noticed" if done.returncode == 1 else "SURVIVED" if done.returncode == 0 else "NOT RUN"


def drawn(source: Path, packages: list[str], count: int, seed: int) -> list[Change]:
    """Return changes drawn from the formulas of all packages in turn."""
    chosen, pools = random.Random(seed), []
    for package in packages:
        files = [path for path in sorted((source / package).rglob("*.py")) if not QUIET & set(path.parts)]
        pool = [change for path in files for change in changes_of(path, source)]
        chosen.shuffle(pool)
        pools.append(pool)
    return [pool[k] for k in range(count) for pool in pools if k < len(pool)][:count]


def table(results: dict[Change, str]) -> str:
    """Return how many changes of each package were tried and noticed."""
    tried = Counter(change.package for change in results)
    noticed = Counter(change.package for change, words in results.items() if words == "noticed")
    rows = [f"{name:<24} {tried[name]:>5} {noticed[name]:>8}" for name in sorted(tried)]
    head = f"{'package':<24} {'tried':>5} {'noticed':>8}"
    return "\n".join([head, *rows, f"{'all':<24} {len(results):>5} {sum(noticed.values()):>8}"])


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, help="draw as many changes instead of those of the list")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--most", type=int, default=12, help="test files run first for a change, those that import it")
    parser.add_argument("--seconds", type=float, default=900.0, help="after which a run is given up")
    parser.add_argument("--packages", nargs="*", help="of which changes are tried")
    parser.add_argument("--results", type=Path, default=Path("formulas_noticed.tsv"))
    given = parser.parse_args()
    kept = given.results.read_text(encoding="utf-8").splitlines() if given.results.exists() else []
    before = dict(line.split("\t", 1)[::-1] for line in kept)
    results: dict[Change, str] = {}
    with tempfile.TemporaryDirectory() as folder, given.results.open("a", encoding="utf-8") as file:
        source = Path(folder) / "moyai"
        # with the kernels that are compiled: what a change does not reach is not compiled again
        shutil.copytree(ROOT / "src" / "moyai", source)
        drawing = given.packages or PACKAGES
        changes = listed() if given.count is None else drawn(source, drawing, given.count, given.seed)
        for change in changes:
            if given.packages and change.package not in given.packages:
                continue
            if str(change) not in before:
                path = source / change.file
                text = path.read_text(encoding="utf-8")
                path.write_text(change.applied(text), encoding="utf-8")
                tests = tests_of(change.file, change.function(text))
                words = outcome(source, tests[: given.most], given.seconds)
                if words == "SURVIVED" and tests[given.most :]:
                    words = outcome(source, tests[given.most :], given.seconds)
                path.write_text(text, encoding="utf-8")
                before[str(change)] = words
                file.write(f"{words}\t{change}\n")
                file.flush()
            results[change] = before[str(change)]
            sys.stdout.write(f"{results[change]:<8} {change}\n")
            sys.stdout.flush()
    sys.stdout.write(table(results) + "\n")


if __name__ == "__main__":
    main()
