"""What the packages hand out: every name is there, costs nothing until used, and is known to type checkers."""

import ast
import subprocess
import sys
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

import pytest

import moyai

SOURCE = Path(moyai.__file__).parent
PACKAGES = sorted(
    ".".join(("moyai", *path.relative_to(SOURCE).parts[:-1]))
    for path in SOURCE.rglob("__init__.py")
    if "exports(" in path.read_text(encoding="utf-8")
)


def test_the_front_door_has_five_calls():
    assert dir(moyai) == ["load_case", "read_result", "run", "template", "write_report"]
    assert all(callable(getattr(moyai, name)) for name in dir(moyai))


def test_every_package_but_the_commands_and_the_page_hands_out_its_names():
    silent = {package.name for package in iter_modules(moyai.__path__, "moyai.") if package.ispkg} - set(PACKAGES)
    assert silent == {"moyai.app", "moyai.cli"}


@pytest.mark.parametrize("name", PACKAGES)
def test_every_name_is_found_in_its_module(name):
    package = import_module(name)
    assert len(package.__all__) == len(set(package.__all__)) <= 25
    for exported in package.__all__:
        assert getattr(package, exported) is not None
    modules = {module.name for module in iter_modules(package.__path__)}
    whole = {exported for exported in package.__all__ if type(getattr(package, exported)) is type(sys)}
    # Python binds a module to its package when it is imported: a function of the same name would then be hidden
    assert modules & set(package.__all__) == whole


@pytest.mark.parametrize("name", PACKAGES)
def test_type_checkers_see_the_same_names(name):
    package = import_module(name)
    tree = ast.parse(Path(package.__file__).read_text(encoding="utf-8"))
    imported = {
        alias.asname: node.module
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
        if alias.asname
    }
    assert set(imported) == set(package.__all__)
    for exported, module in imported.items():
        assert getattr(import_module(module), exported) is getattr(package, exported)


def test_importing_the_packages_imports_no_numbers():
    code = f"import sys, {', '.join(PACKAGES)}; print([m for m in ('numpy', 'numba', 'pydantic') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match=r"'moyai\.potential' has no attribute 'solv'"):
        import_module("moyai.potential").solv  # noqa: B018
