"""What the packages hand out: every name is there, costs nothing until used, and is known to type checkers."""

import ast
import inspect
import subprocess
import sys
import typing
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

import pytest
import xarray as xr

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
    assert len(package.__all__) == len(set(package.__all__)) <= 40
    assert sum(inspect.isroutine(getattr(package, exported)) for exported in package.__all__) <= 15
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


def handed_out():
    """Give what the packages hand out, by package and name; of a whole module what it defines."""
    for package in map(import_module, PACKAGES):
        for name in package.__all__:
            thing = getattr(package, name)
            if inspect.ismodule(thing):
                own = {key: one for key, one in vars(thing).items() if getattr(one, "__module__", "") == thing.__name__}
                yield from ((f"{package.__name__}.{name}.{key}", one) for key, one in own.items() if key[0] != "_")
            else:
                yield f"{package.__name__}.{name}", thing


HANDED_OUT = dict(handed_out())
HANDED_OUT_CLASSES = {name.rsplit(".", 1)[1]: one for name, one in HANDED_OUT.items() if inspect.isclass(one)}


def classes_of(hint):
    """Give the classes that a type hint is made of."""
    if inspect.isclass(hint) and typing.get_origin(hint) is None:
        yield hint
    for part in typing.get_args(hint):
        for one in part if isinstance(part, list) else (part,):
            yield from classes_of(one)


def hints_of(function):
    """Return the type hints of a function; names that only type checkers import must be handed out by a package."""
    plain = inspect.unwrap(function)
    return typing.get_type_hints(plain, globalns={"xr": xr, **HANDED_OUT_CLASSES, **plain.__globals__})


@pytest.mark.parametrize("name", [name for name, one in HANDED_OUT.items() if inspect.isfunction(one)])
def test_every_class_that_a_call_takes_or_gives_is_handed_out(name):
    used = {one for hint in hints_of(HANDED_OUT[name]).values() for one in classes_of(hint)}
    own = {one for one in used if one.__module__.startswith("moyai.")}
    assert not own - {one for one in HANDED_OUT.values() if inspect.isclass(one)}
