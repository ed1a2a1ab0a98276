"""The page of calls: every example runs, and every call on it says what it takes, gives and raises."""

import doctest
import inspect
import re
from importlib import import_module
from pathlib import Path

import pytest

PAGE = Path(__file__).resolve().parents[3] / "docs" / "calls.md"
TEXT = PAGE.read_text(encoding="utf-8")


def named_calls():
    """Calls of the table, with the package of the first one of a row for those after it."""
    found = {}
    for row in re.findall(r"^\| \[.*?\| (.*) \|$", TEXT, re.MULTILINE):
        package = ""
        for name in re.findall(r"`([A-Za-z_.]+)`", row):
            if name.startswith("moyai."):
                package, name = name.rsplit(".", 1)
            found[f"{package}.{name}"] = getattr(import_module(package), name)
    return found


CALLS = named_calls()


def test_every_example_of_the_page_runs():
    failed, tried = doctest.testfile(str(PAGE), module_relative=False)
    assert tried > 60 and failed == 0


def test_every_call_of_the_table_is_used_in_an_example():
    examples = "\n".join(re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL))
    unused = [name for name in CALLS if not re.search(rf"\b{name.rsplit('.', 1)[1]}\b", examples)]
    assert len(CALLS) > 20 and not unused


@pytest.mark.parametrize("name", CALLS)
def test_a_call_says_what_it_takes_gives_and_shows_it(name):
    call = CALLS[name]
    text = inspect.getdoc(call)
    parts = ["Parameters", "Examples", "Returns"]
    if inspect.isclass(call):
        # the comments on its fields say what a record takes
        source = inspect.getsource(call)
        dumb = [field for field in call.__annotations__ if not re.search(rf"    #: .*\n    {field}:", source)]
        assert not dumb, f"fields of {name} without a comment: {dumb}"
        parts = ["Examples"]
    missing = [part for part in parts if f"{part}\n{'-' * len(part)}" not in text]
    assert not missing, f"{name} lacks {missing}"


@pytest.mark.parametrize("name", CALLS)
def test_the_example_of_a_call_runs(name):
    call = CALLS[name]
    examples = doctest.DocTestParser().get_doctest(inspect.getdoc(call), {}, name, None, 0)
    assert examples.examples
    assert doctest.DocTestRunner().run(examples).failed == 0
