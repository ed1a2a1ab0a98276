"""Every function that a package hands out says what it takes, gives and raises, and has an example that runs."""

import ast
import doctest
import functools
import inspect
import pkgutil
import re
import textwrap
from importlib import import_module
from pathlib import Path
from types import ModuleType

import pytest

import moyai

#: Not complete yet. The list may only become shorter: a name of it that is complete fails the test.
INCOMPLETE: set[str] = set()

SECTIONS = ("Parameters", "Returns", "Yields", "Raises", "Notes", "References", "Examples")


def handed_out():
    """Functions by their public name; those of a module that a package hands out as a whole among them."""
    found = {}
    for package in pkgutil.iter_modules(moyai.__path__, "moyai."):
        module = import_module(package.name)
        for name in getattr(module, "__all__", ()) if package.ispkg else ():
            thing = getattr(module, name)
            inside = isinstance(thing, ModuleType)
            members = {f"{name}.{key}": getattr(thing, key) for key in public_names(thing)} if inside else {name: thing}
            found |= {f"{package.name}.{key}": one for key, one in members.items() if inspect.isroutine(one)}
    return found


def public_names(module):
    """Names that a module defines itself."""
    own = [key for key, one in vars(module).items() if getattr(one, "__module__", "") == module.__name__]
    return [key for key in own if not key.startswith("_")]


def sections_of(text):
    """Text of every section by its title."""
    parts = re.split(rf"^({'|'.join(SECTIONS)})\n-+\n", text, flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2]))


def entries_of(sections, title):
    """Words below every entry of a section, by the line of the entry."""
    found = {}
    for line in sections.get(title, "").splitlines():
        if line and not line.startswith(" "):
            found[entry := line] = ""
        elif line:
            found[entry] += line.strip()
    return found


def raises_input_error(function):
    """Whether the body, or what it calls in its own module, raises an InputError."""
    tree = ast.parse(inspect.getsource(inspect.getmodule(function)))
    bodies = {node.name: [node] for node in tree.body if isinstance(node, ast.FunctionDef)}
    for record in (node for node in tree.body if isinstance(node, ast.ClassDef)):
        bodies[record.name] = [one for one in record.body if getattr(one, "name", "") in ("__init__", "__post_init__")]
    waiting, seen = [function.__name__], set()
    while waiting:
        name = waiting.pop()
        if name in seen or name not in bodies:
            continue
        seen.add(name)
        for node in (inner for body in bodies[name] for inner in ast.walk(body)):
            if isinstance(node, ast.Raise) and "InputError" in ast.dump(node):
                return True
            if isinstance(node, ast.Name) and node.id == "checks_words":  # the decorator refuses unknown words
                return True
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
                waiting.append(node.func.id)
    return False


def missing_from(function):
    """What the docstring of a function lacks."""
    text = inspect.getdoc(function) or ""
    sections = sections_of(text)
    signature = inspect.signature(function)
    lacks = [] if re.match(r"\S.*\.(?:\n\n|$)", text) else ["one line of what it does"]
    entries = entries_of(sections, "Parameters")
    named = {name.strip(" *") for entry in entries for name in entry.split(" : ")[0].split(",")}
    lacks += [f"parameter {name}" for name in signature.parameters if name not in named]
    for title in ("Parameters", "Returns", "Raises"):
        lacks += [f"words for {entry}" for entry, words in entries_of(sections, title).items() if not words]
    if signature.return_annotation not in ("None", None) and not {"Returns", "Yields"} & set(sections):
        lacks.append("Returns")
    # what takes nothing has nothing to refuse
    refuses = bool(signature.parameters) and raises_input_error(inspect.unwrap(function))
    if refuses and not re.search("InputError|CaseError", sections.get("Raises", "")):
        lacks.append("Raises")
    if not doctest.DocTestParser().get_examples(sections.get("Examples", "")):
        lacks.append("Examples")
    return lacks


CALLS = handed_out()


def test_the_packages_hand_out_their_functions():
    assert len(CALLS) > 120 and {"moyai.sea.wave_number", "moyai.potential.shapes.circle"} <= set(CALLS)
    assert set(CALLS) >= INCOMPLETE


def test_what_raises_is_found_through_calls():
    def of(name):
        return inspect.unwrap(CALLS[name])

    assert raises_input_error(of("moyai.potential.shapes.circle"))  # through _positive
    assert not raises_input_error(of("moyai.tables.available_codes"))


def test_a_docstring_without_its_parts_is_noticed():
    def drawn(width, height):
        """Draw it.

        Parameters
        ----------
        width : float
            [m].
        """
        return width * height

    assert missing_from(drawn) == ["parameter height", "Returns", "Examples"]


@pytest.mark.parametrize("name", CALLS)
def test_a_function_says_what_it_takes_gives_and_raises(name):
    lacks = missing_from(CALLS[name])
    if name in INCOMPLETE:
        assert lacks, f"{name} is complete: take it off the list"
    else:
        assert not lacks, f"{name} lacks {', '.join(lacks)}"


#: Examples that run a case several times.
LONG = {"moyai.study.run_fit", "moyai.reproduce.reproduce"}
COMPLETE = [
    pytest.param(name, marks=pytest.mark.slow if name in LONG else ()) for name in CALLS if name not in INCOMPLETE
]


@pytest.mark.parametrize("name", COMPLETE)
def test_the_example_of_a_function_runs(name):
    check_examples(name, CALLS[name])


def check_examples(name, thing):
    """Run the examples of a docstring; there is one at least."""
    examples = doctest.DocTestParser().get_doctest(textwrap.dedent(inspect.getdoc(thing) or ""), {}, name, None, 0)
    assert examples.examples
    assert doctest.DocTestRunner().run(examples).failed == 0


def classes_with_examples():
    """Classes of the package whose own docstring holds an example, by module and name."""
    found = {}
    names = [one.name for one in pkgutil.walk_packages(moyai.__path__, "moyai.") if not one.name.endswith("__main__")]
    for module in map(import_module, names):
        own = [one for one in vars(module).values() if inspect.isclass(one) and one.__module__ == module.__name__]
        found |= {f"{one.__module__}.{one.__qualname__}": one for one in own if ">>>" in (one.__doc__ or "")}
    return found


CLASSES = classes_with_examples()


def test_what_users_make_by_hand_has_an_example():
    names = {name.rsplit(".", 1)[1] for name in CLASSES}
    assert len(names) >= 50
    assert names >= {"Hull", "Section", "Water", "Line", "Segment", "BarType", "NetworkBuilder", "RigidCage", "Net"}
    assert names >= {"PlanarBody", "WaveLoads", "CumminsModel", "RegularForcing", "IrregularForcing", "Member"}
    assert names >= {"WaveComponents", "Spectrum", "DesignCode", "LineLoad", "RigidBody", "Hydrodynamics", "Flow"}


@pytest.mark.parametrize("name", CLASSES)
def test_the_example_of_a_class_runs(name):
    check_examples(name, CLASSES[name])


#: Methods that do not say yet what they take. The list may only become shorter.
METHODS_INCOMPLETE: set[str] = set()


def packages():
    """Packages, also inner ones, that hand out names."""
    source = Path(moyai.__file__).parent
    homes = [path.parent for path in source.rglob("__init__.py") if "exports(" in path.read_text(encoding="utf-8")]
    return [import_module(".".join(("moyai", *home.relative_to(source).parts))) for home in sorted(homes)]


def classes_handed_out():
    """Classes that packages hand out, alone or in a module, and those of the product that they inherit from."""
    things = [getattr(package, name) for package in packages() for name in package.__all__]
    for module in filter(inspect.ismodule, list(things)):
        things += [getattr(module, name) for name in public_names(module)]
    bases = [base for one in things if inspect.isclass(one) for base in one.__mro__]
    return [one for one in dict.fromkeys(bases) if one.__module__.startswith("moyai.")]


def methods_of(cls):
    """Public methods and properties that a class of the product defines itself: function and what it takes."""
    found = {}
    for key, one in vars(cls).items():
        is_property = isinstance(one, property | functools.cached_property)
        inner = next((getattr(one, at) for at in ("fget", "func", "__func__") if hasattr(one, at)), one)
        function = inspect.unwrap(inner) if callable(inner) else None
        # what libraries put into a class is not ours to describe
        if key.startswith("_") or not inspect.isfunction(function) or not function.__module__.startswith("moyai."):
            continue
        names = list(inspect.signature(function).parameters)
        found[key] = function, [] if is_property else names if isinstance(one, staticmethod) else names[1:]
    return found


METHODS = {
    f"{cls.__module__}.{cls.__qualname__}.{key}": found
    for cls in classes_handed_out()
    for key, found in methods_of(cls).items()
}


def missing_from_method(function, takes):
    """What the docstring of a method lacks: its line, words for what it takes, and the errors that its body raises."""
    text = inspect.getdoc(function) or ""
    sections = sections_of(text)
    lacks = [] if re.match(r"\S.*?\.(?:\n\n|$)", text, re.DOTALL) else ["a sentence of what it does"]
    entries = entries_of(sections, "Parameters")
    named = {name.strip(" *") for entry in entries for name in entry.split(" : ")[0].split(",")}
    lacks += [f"parameter {name}" for name in takes if name not in named]
    tree = ast.parse(textwrap.dedent(inspect.getsource(function)))
    raised = [ast.dump(node) for node in ast.walk(tree) if isinstance(node, ast.Raise)]
    if any(re.search("InputError|ConvergenceError", one) for one in raised) and "Raises" not in sections:
        lacks.append("Raises")
    return lacks


def test_the_classes_are_found():
    assert len(METHODS) > 450 and set(METHODS) >= METHODS_INCOMPLETE
    assert {"moyai.mooring.system.LineSystem.stiffness", "moyai.sea.spectrum.Spectrum.quantile"} <= set(METHODS)
    assert METHODS["moyai.sea.spectrum.Spectrum.quantile"][1] == ["fraction"]


def test_a_method_without_its_parts_is_noticed():
    def at(self, width):
        """Return it."""
        raise InputError(width)  # noqa: F821

    assert missing_from_method(at, ["width"]) == ["parameter width", "Raises"]


@pytest.mark.parametrize("name", METHODS)
def test_a_method_says_what_it_takes_and_raises(name):
    lacks = missing_from_method(*METHODS[name])
    if name in METHODS_INCOMPLETE:
        assert lacks, f"{name} is complete: take it off the list"
    else:
        assert not lacks, f"{name} lacks {', '.join(lacks)}"
