"""Change formulas one at a time and see whether a test notices.

``python benchmarks/mutate_formulas.py --count 60 --seed 1`` copies the package, changes an operator, a constant or a
function in a formula that names its equation, runs the fast tests that import the changed module, and sets the formula
back. It prints a line for every change; the last line is the part that was noticed. Survivors are to be looked at: a
change may be without effect (a guard, a tolerance, a start value), or a test is missing.
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
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
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
    """One change of one formula."""

    #: File below the package.
    file: str
    line: int
    #: Name of the function that holds the formula.
    function: str
    start: int
    end: int
    #: Text in the file, and what stands there instead.
    old: str
    new: str


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
    found: dict[tuple[int, int], Change] = {}

    def note(function: ast.FunctionDef, line: int, start: int, end: int, new: str) -> None:
        old = raw[start:end].decode()
        change = Change(str(path.relative_to(package)), line, function.name, start, end, old, new)
        found.setdefault((start, end), change)

    for function in ast.walk(ast.parse(text)):
        if not isinstance(function, ast.FunctionDef) or "[eq:" not in (ast.get_docstring(function) or ""):
            continue
        for node in (inner for statement in function.body[1:] for inner in ast.walk(statement)):
            if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
                sign, other = OPERATORS[type(node.op)]
                left, right = node.left, node.right
                start = begin[(left.end_lineno or 1) - 1] + (left.end_col_offset or 0)
                end = begin[right.lineno - 1] + right.col_offset
                place = raw[start:end].decode().find(sign)
                if place >= 0:
                    note(function, node.lineno, start + place, start + place + 1, other)
            elif isinstance(node, ast.Constant) and isinstance(node.value, float) and node.value not in (0.0, 1.0):
                start = begin[node.lineno - 1] + node.col_offset
                end = begin[node.lineno - 1] + (node.end_col_offset or 0)
                if 1e-3 <= abs(node.value) <= 1e3:
                    note(function, node.lineno, start, end, repr(1.1 * node.value))
            elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in FUNCTIONS:
                end = begin[(node.func.end_lineno or 1) - 1] + (node.func.end_col_offset or 0)
                note(function, node.lineno, end - len(node.func.attr), end, FUNCTIONS[node.func.attr])
    return list(found.values())


def tests_of(file: str, most: int) -> list[str]:
    """Return the test files that import a module, else those of its package."""
    module = "moyai." + file.removesuffix(".py").replace("/", ".")
    stem = module.rsplit(".", 1)
    direct = re.compile(rf"{re.escape(module)}\b|from {re.escape(stem[0])} import [^\n]*\b{stem[1]}\b")
    tests = sorted((ROOT / "tests").rglob("test_*.py"))
    found = [path for path in tests if direct.search(path.read_text(encoding="utf-8"))]
    package = file.split("/")[1 if file.startswith("structures/") else 0]
    found += [path for path in tests if path.parent.name == package and path not in found]
    return [str(path.relative_to(ROOT)) for path in found[:most]]


def outcome(source: Path, tests: list[str], seconds: float) -> str:
    """Return what the tests say to the package as it stands in ``source``: noticed, TOO SLOW or SURVIVED."""
    environment = {**os.environ, "PYTHONPATH": str(source.parent), "OMP_NUM_THREADS": "1"}
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *tests]
    try:
        done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, timeout=seconds, check=False)
    except subprocess.TimeoutExpired:
        return "TOO SLOW"
    return "noticed" if done.returncode == 1 else "SURVIVED" if done.returncode == 0 else "NOT RUN"


def main() -> None:
    """Run the command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--most", type=int, default=12, help="test files run for a change, those that import it first")
    parser.add_argument("--seconds", type=float, default=900.0, help="after which a run is given up")
    parser.add_argument("--packages", nargs="*", default=PACKAGES)
    given = parser.parse_args()
    chosen = random.Random(given.seed)
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "moyai"
        shutil.copytree(ROOT / "src" / "moyai", source, ignore=shutil.ignore_patterns("__pycache__"))
        pools = []
        for package in given.packages:
            files = [path for path in sorted((source / package).rglob("*.py")) if not QUIET & set(path.parts)]
            pool = [change for path in files for change in changes_of(path, source)]
            chosen.shuffle(pool)
            pools.append(pool)
        changes = [pool[k] for k in range(given.count) for pool in pools if k < len(pool)][: given.count]
        killed = 0
        for change in changes:
            path = source / change.file
            raw = path.read_bytes()
            path.write_bytes(raw[: change.start] + change.new.encode() + raw[change.end :])
            words = outcome(source, tests_of(change.file, given.most), given.seconds)
            path.write_bytes(raw)
            killed += words == "noticed"
            place = f"{change.file}:{change.line} {change.function}"
            sys.stdout.write(f"{words:<8} {place}: {change.old} -> {change.new}\n")
            sys.stdout.flush()
        sys.stdout.write(f"{killed} of {len(changes)} noticed\n")


if __name__ == "__main__":
    main()
