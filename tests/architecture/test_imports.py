"""Imports run downward only, kinds of structure do not know each other, and only `report` draws."""

import ast
from pathlib import Path

import pytest

SOURCE = Path(__file__).resolve().parents[2] / "src" / "moyai"

LEVELS = {
    "core": 0,
    "sea": 1,
    "tables": 1,
    "series": 2,
    "potential": 2,
    "morison": 2,
    "mooring": 2,
    "flexible": 3,
    "floating": 3,
    "coupled": 4,
    "design": 5,
    "interop": 5,
    "case": 5,
    "report": 6,
    "structures": 7,
    "records": 8,
    "study": 9,
    "validation": 10,
    "reproduce": 10,
    "cli": 11,
    "app": 11,
}
PLOTTING = {"matplotlib", "plotly", "typst", "seaborn", "bokeh"}
# The facade of the package (moyai/__init__.py) hands out the calls of every room
FACADE = 12
FILES = sorted(SOURCE.rglob("*.py"))


def room(path):
    parts = path.relative_to(SOURCE).parts
    return parts[0] if len(parts) > 1 else ""


def imported_modules(path):
    """All modules that a file imports, wherever the statement stands, with their line."""
    package = ["moyai", *path.relative_to(SOURCE).parts[:-1]]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name, node.lineno
        elif isinstance(node, ast.ImportFrom):
            if node.level:
                base = package[: len(package) - node.level + 1]
                module = ".".join([*base, *([node.module] if node.module else [])])
            else:
                module = node.module or ""
            yield module, node.lineno
            if module == "moyai":
                for alias in node.names:
                    yield f"moyai.{alias.name}", node.lineno
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute | ast.Name):
            name = node.func.attr if isinstance(node.func, ast.Attribute) else node.func.id
            if name in ("import_module", "__import__") and node.args and isinstance(node.args[0], ast.Constant):
                yield str(node.args[0].value), node.lineno


KIND_PARTS = ("structures", "records")


def test_kinds_of_structure_do_not_know_each_other():
    """A kind is one folder; what two kinds share stands below both."""
    wrong = []
    for path in FILES:
        parts = path.relative_to(SOURCE).parts
        if parts[0] != "structures" or len(parts) < 3:
            continue
        for module, line in imported_modules(path):
            names = module.split(".")
            if names[:2] == ["moyai", "structures"] and len(names) > 2 and names[2] != parts[1]:
                wrong.append(f"{path.relative_to(SOURCE)}, line {line}: {module}")
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("role", ["case", "report"])
def test_only_the_kind_and_its_role_know_case_files_and_drawings(role):
    """Physics knows no keys and draws nothing: `case` and `report` of a kind are reached through its KIND object."""
    wrong = []
    for path in FILES:
        parts = path.relative_to(SOURCE).parts
        if parts[0] not in KIND_PARTS or role in parts or path.name == "__init__.py":
            continue
        for module, line in imported_modules(path):
            names = module.split(".")
            own_role = names[1:2] and names[1] in KIND_PARTS and role in names
            if own_role or names[:2] == ["moyai", role]:
                wrong.append(f"{path.relative_to(SOURCE)}, line {line}: {module}")
    assert not wrong, "\n".join(wrong)


def test_every_room_has_a_level():
    rooms = {path.name for path in SOURCE.iterdir() if path.is_dir() and (path / "__init__.py").exists()}
    assert rooms <= set(LEVELS), f"no level for {sorted(rooms - set(LEVELS))}"


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(SOURCE)))
def test_imports_run_downward(path):
    own = room(path)
    level = LEVELS[own] if own else FACADE
    wrong = []
    for module, line in imported_modules(path):
        parts = module.split(".")
        if parts[0] != "moyai" or len(parts) < 2 or parts[1] not in LEVELS or parts[1] == own:
            continue
        if LEVELS[parts[1]] >= level:
            wrong.append(f"line {line}: {own or 'moyai'} (level {level}) imports {module} (level {LEVELS[parts[1]]})")
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(SOURCE)))
def test_only_report_draws(path):
    if room(path) in ("report", "app"):
        return
    wrong = [f"line {line}: {module}" for module, line in imported_modules(path) if module.split(".")[0] in PLOTTING]
    assert not wrong, "\n".join(wrong)


def test_the_check_sees_imports_inside_functions(tmp_path):
    """The walker must not be blind to late, relative and computed imports."""
    file = SOURCE / "core" / "imaginary.py"
    text = (
        "def f():\n    from moyai.sea import water\n    from ..case import reader\n"
        "    import importlib\n    importlib.import_module('moyai.cli.main')\n    from moyai import report\n"
    )
    tree = ast.parse(text)
    assert tree

    class Fake:
        def relative_to(self, other):
            return file.relative_to(other)

        def read_text(self, encoding):
            return text

    found = {module for module, _ in imported_modules(Fake())}
    assert {"moyai.sea", "moyai.case", "moyai.cli.main", "moyai.report"} <= found
