"""Every public call refuses an option word that it does not know, before anything is computed."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import pkgutil
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Literal

import pytest
import xarray as xr

import moyai
from moyai.case import root_schema
from moyai.core.errors import InputError
from moyai.core.options import _rules, check_word, checks_words
from moyai.design import design_code
from moyai.floating import Hydrodynamics


def calls_with_words() -> Iterator[tuple[str, Callable[..., Any], str]]:
    """Give every public function, method and dataclass that takes an option word, with the name of the argument."""
    for found in pkgutil.walk_packages(moyai.__path__, "moyai."):
        if found.name.endswith("__main__"):
            continue
        module = importlib.import_module(found.name)
        for name, item in sorted(vars(module).items()):
            if name.startswith("_") or getattr(item, "__module__", "") != module.__name__:
                continue
            for label, call, noted in calls_of(name, item):
                for argument in sorted(_rules(inspect.get_annotations(noted), module.__name__)):
                    yield f"{found.name}.{label}({argument})", call, argument


def calls_of(name: str, item: Any) -> Iterator[tuple[str, Callable[..., Any], Any]]:
    """Give a function, or a dataclass with its public methods: name, call, what carries the annotations."""
    if inspect.isfunction(item):
        yield name, item, inspect.unwrap(item)
    elif inspect.isclass(item):
        if dataclasses.is_dataclass(item):
            yield name, item, item
        for key, member in sorted(vars(item).items()):
            function = getattr(member, "__func__", member)
            if inspect.isfunction(function) and not key.startswith("_"):
                yield f"{name}.{key}", getattr(item, key), inspect.unwrap(function)


CALLS = list(calls_with_words())


def test_the_walk_finds_the_calls() -> None:
    assert len(CALLS) >= 150
    packages = {name.split(".")[1] for name, _, _ in CALLS}
    assert packages >= {"core", "design", "floating", "flexible", "morison", "potential", "records", "report", "sea"}
    assert packages >= {"series", "structures", "tables"}


@pytest.mark.parametrize(("call", "argument"), [item[1:] for item in CALLS], ids=[item[0] for item in CALLS])
def test_a_word_that_does_not_exist_is_refused(call: Callable[..., Any], argument: str) -> None:
    with pytest.raises(InputError, match=rf"{argument}: 'no such word' is not a known word; allowed: "):
        call(**{argument: "no such word"})


@checks_words
@dataclass(frozen=True)
class Options:
    """What an ordinary record of options looks like."""

    many: tuple[Literal["a", "b"], ...] = ("a",)
    one: Literal["up", "down"] | None = None
    number: float = 1.0


def test_lists_of_words_and_absent_ones() -> None:
    assert Options(("a", "b"), "up", 2.0) == Options(many=("a", "b"), one="up", number=2.0)
    assert Options().one is None
    with pytest.raises(InputError, match="many: 'c'"):
        Options(("a", "c"))  # type: ignore[arg-type]
    with pytest.raises(InputError, match="did you mean 'down'"):
        Options(one="dwon")  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        Options(nothing=1)  # type: ignore[call-arg]


def test_the_beginning_of_a_word_names_it() -> None:
    with pytest.raises(InputError, match="did you mean 'infinite'"):
        check_word("inf", ("infinite", "zero"), "frequency")


def test_words_that_stand_in_tables_and_data() -> None:
    """Words whose list is not known before the call."""
    for key, word in (("confirmed", ["nonsense"]), ("consequence", "hihg")):
        with pytest.raises(InputError, match=f"{key}: "):
            design_code("ISO 19901-7", analysis="dynamic", **{key: word})
    design_code("ISO 19901-7", analysis="dynamic", confirmed=["API RP 2SK"])  # one list may serve several codes
    with pytest.raises(InputError, match="did you mean 'cage'"):
        root_schema("cagge")
    data = xr.Dataset(coords={"omega": [1.0], "influenced_dof": ["sway"], "radiating_dof": ["sway"]})
    with pytest.raises(InputError, match="did you mean 'sway'"):
        Hydrodynamics.from_dataset(data, modes=("swya",))
