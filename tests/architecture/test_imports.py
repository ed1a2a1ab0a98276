"""Imports run downward only, kinds of structure do not know each other, and only `report` draws."""

import pytest
from source_files import FILES, SOURCE, findings, findings_of_text

LEVELS = {
    "core": 0,
    "language": 1,
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
    "cli": 12,
    "app": 11,
}
PLOTTING = {"matplotlib", "plotly", "typst", "seaborn", "bokeh"}
# The facade of the package (moyai/__init__.py) hands out the calls of every package
FACADE = 13


def package_of(path):
    parts = path.relative_to(SOURCE).parts
    return parts[0] if len(parts) > 1 else ""


def imported_modules(path):
    return findings()[path].imports


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
            if path.name == "settings.py" and module == "moyai.case.schema_types":
                continue  # blocks that a case fills and analyses read as they are: units of fields, no paths
            own_role = names[1:2] and names[1] in KIND_PARTS and role in names
            if own_role or names[:2] == ["moyai", role]:
                wrong.append(f"{path.relative_to(SOURCE)}, line {line}: {module}")
    assert not wrong, "\n".join(wrong)


def test_every_package_has_a_level():
    packages = {path.name for path in SOURCE.iterdir() if path.is_dir() and (path / "__init__.py").exists()}
    assert packages <= set(LEVELS), f"no level for {sorted(packages - set(LEVELS))}"


def upward_imports(path, imports):
    own = package_of(path)
    level = LEVELS[own] if own else FACADE
    for module, line in imports:
        parts = module.split(".")
        if parts[0] != "moyai" or len(parts) < 2 or parts[1] not in LEVELS or parts[1] == own:
            continue
        if LEVELS[parts[1]] >= level:
            where = f"{path.relative_to(SOURCE)}, line {line}: {own or 'moyai'} (level {level})"
            yield f"{where} imports {module} (level {LEVELS[parts[1]]})"


def test_imports_run_downward():
    wrong = [fault for path in FILES for fault in upward_imports(path, imported_modules(path))]
    assert not wrong, "\n".join(wrong)


def test_the_check_sees_an_upward_import():
    imaginary = SOURCE / "sea" / "imaginary.py"
    assert len(list(upward_imports(imaginary, [("moyai.case.reader", 1), ("moyai.core.errors", 2)]))) == 1


def test_only_report_draws():
    wrong = [
        f"{path.relative_to(SOURCE)}, line {line}: {module}"
        for path in FILES
        if package_of(path) not in ("report", "app")
        for module, line in imported_modules(path)
        if module.split(".")[0] in PLOTTING
    ]
    assert not wrong, "\n".join(wrong)


def test_the_check_sees_imports_inside_functions():
    """The walker must not be blind to late, relative and computed imports."""
    text = (
        "def f():\n    from moyai.sea import water\n    from ..case import reader\n"
        "    import importlib\n    importlib.import_module('moyai.cli.main')\n    from moyai import report\n"
    )
    found = {module for module, _ in findings_of_text(text, ("core", "imaginary.py")).imports}
    assert {"moyai.sea", "moyai.case", "moyai.cli.main", "moyai.report"} <= found
