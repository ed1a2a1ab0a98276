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

from moyai.core.errors import InputError
from moyai.core.options import _rules, check_word, checks_words

PACKAGES = (
    *("sea", "series", "potential", "morison", "mooring", "flexible", "floating", "coupled", "design", "interop"),
    *("structures", "records"),
)
OUTCOMES = {"status"}  # words that the program writes itself
RECORDS = {"SnapFit", "Tail", "TheoryAdvice", "NonlinearWave", "SplitTension"}  # made by the program, never by a caller


def calls_with_words() -> Iterator[tuple[str, Callable[..., Any], str]]:
    """Give every public function and dataclass that takes an option word, with the name of the argument."""
    for package in PACKAGES:
        root = importlib.import_module(f"moyai.{package}")
        for found in pkgutil.walk_packages(root.__path__, f"{root.__name__}."):
            if {"case", "report"} & set(found.name.split(".")):
                continue
            module = importlib.import_module(found.name)
            for name, call in sorted(vars(module).items()):
                if name.startswith("_") or name in RECORDS or getattr(call, "__module__", "") != module.__name__:
                    continue
                if inspect.isfunction(call) or (inspect.isclass(call) and dataclasses.is_dataclass(call)):
                    notes = inspect.get_annotations(inspect.unwrap(call) if inspect.isfunction(call) else call)
                    for argument in sorted(_rules(notes, module.__name__)):
                        if argument not in OUTCOMES:
                            yield f"{found.name}.{name}({argument})", call, argument


CALLS = list(calls_with_words())


def test_the_walk_finds_the_calls() -> None:
    assert len(CALLS) >= 60


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
