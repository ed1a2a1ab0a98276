"""Tracked files are whole and small, pins are names and versions, and every test can fail."""

import ast
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]

TEXT = {
    "",
    ".py",
    ".md",
    ".toml",
    ".txt",
    ".yaml",
    ".yml",
    ".cff",
    ".csv",
    ".js",
    ".css",
    ".html",
    ".typ",
    ".cfg",
    ".json",
}
MARKERS = re.compile(r"^(<{7} |>{7} |={7}$)", re.MULTILINE)


@pytest.fixture(scope="module")
def tracked():
    git = shutil.which("git")
    if git is None or not (ROOT / ".git").exists():
        pytest.skip("not a git work tree: tracked files are unknown")
    listing = subprocess.run([git, "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True).stdout.decode()
    return [ROOT / name for name in listing.split("\0") if name]


def texts(tracked):
    for path in tracked:
        if path.suffix in TEXT and path.is_file():
            yield path, path.read_text(encoding="utf-8")


def test_no_conflict_markers_and_no_large_files(tracked):
    wrong = [str(path.relative_to(ROOT)) for path, text in texts(tracked) if MARKERS.search(text)]
    assert not wrong
    large = [str(path.relative_to(ROOT)) for path in tracked if path.is_file() and path.stat().st_size > 500_000]
    assert not large, f"over 500 kB: {large}"


def test_constraints_are_names_and_versions_only():
    lines = (ROOT / "constraints.txt").read_text(encoding="utf-8").splitlines()
    pins = [line for line in lines if line.strip() and not line.startswith("#")]
    assert pins
    wrong = [line for line in pins if not re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9._-]*==[A-Za-z0-9.!+_-]+", line)]
    assert not wrong, wrong


def test_unique_test_file_names(tracked):
    seen, twice = {}, []
    for path in tracked:
        if "tests" in path.relative_to(ROOT).parts and path.name.startswith("test_"):
            if path.name in seen:
                twice.append(f"{path.relative_to(ROOT)} and {seen[path.name].relative_to(ROOT)}")
            seen[path.name] = path
    assert not twice
    assert not [path for path in tracked if "tests" in path.relative_to(ROOT).parts and path.name == "__init__.py"]


@pytest.mark.slow
def test_every_test_has_an_assertion(tracked):
    """A test that cannot fail proves nothing."""
    wrong = []
    for path in tracked:
        if not ("tests" in path.relative_to(ROOT).parts and path.name.startswith("test_")):
            continue
        functions = _functions(ast.parse(path.read_text(encoding="utf-8")))
        called = {function.name: _called(function) for function in functions}
        proving, before = {name for name, calls in called.items() if any(map(_proves, calls))}, set()
        while proving != before:
            before = proving
            proving = before | {name for name, calls in called.items() if before & calls}
        wrong += [
            f"{path.relative_to(ROOT)}: {name}" for name in called if name.startswith("test_") and name not in proving
        ]
    assert not wrong, "\n".join(wrong)


def _functions(tree):
    return [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]


def _called(function):
    """Names of all that a function calls, and ``assert`` where it asserts."""
    calls = set()
    for node in ast.walk(function):
        if isinstance(node, ast.Assert):
            calls.add("assert")
        elif isinstance(node, ast.Call):
            calls.add(node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", ""))
    return calls


def _proves(name):
    return name.startswith(("assert", "raises", "warns", "fail"))
