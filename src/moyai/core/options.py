"""Option words: a word that is none of those allowed is refused, wherever it is given."""

from __future__ import annotations

import dataclasses
import difflib
import functools
import inspect
import sys
import types
from collections.abc import Callable, Iterable
from typing import Any, Literal, TypeVar, Union, get_args, get_origin

from moyai.core.errors import InputError

Decorated = TypeVar("Decorated", bound=Callable[..., Any])


def check_word(word: object, allowed: Iterable[object], parameter: str) -> None:
    """Refuse a word that is not among those allowed.

    Parameters
    ----------
    word : object
        What was given.
    allowed : iterable
        The words.
    parameter : str
        Name of the argument.

    Raises
    ------
    InputError
        With the words that are allowed and the nearest of them.
    """
    words = tuple(allowed)
    if isinstance(word, (str, int, type(None))) and word in words:
        return
    texts = [str(item) for item in words if isinstance(item, str)]
    near = [text for text in texts if word and text.startswith(str(word))]
    near = near or difflib.get_close_matches(str(word), texts, n=1, cutoff=0.6)
    raise InputError(
        f"'{word}' is not a known word",
        path=parameter,
        allowed=", ".join(repr(item) if isinstance(item, str) else str(item) for item in words),
        remedy=f"did you mean '{near[0]}'?" if near else "",
    )


def checks_words(decorated: Decorated) -> Decorated:
    """Check every argument whose annotation is a ``Literal`` (or a tuple of them) before a function runs.

    On a dataclass the fields are checked when it is made, before its own ``__post_init__``. The annotations are the one
    list of words: what a type checker refuses is refused at run time too.

    Parameters
    ----------
    decorated : function or dataclass

    Returns
    -------
    function or dataclass
        A function keeps its signature and docstring; a class is changed in place.
    """
    if inspect.isclass(decorated):
        return _check_fields(decorated)  # type: ignore[return-value]
    kinds = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    by_place = [name for name, one in inspect.signature(decorated).parameters.items() if one.kind in kinds]
    rules: dict[str, tuple[bool, tuple[object, ...]]] | None = None

    @functools.wraps(decorated)
    def checked(*args: Any, **kwargs: Any) -> Any:
        nonlocal rules
        if rules is None:
            rules = _rules(decorated.__annotations__, decorated.__module__)
        _check({**dict(zip(by_place, args, strict=False)), **kwargs}, rules)
        return decorated(*args, **kwargs)

    return checked  # type: ignore[return-value]


def _check_fields(kind: type) -> type:
    rules: dict[str, tuple[bool, tuple[object, ...]]] | None = None
    if not dataclasses.is_dataclass(kind):
        raise TypeError(f"{kind.__name__} is no dataclass: put checks_words above its @dataclass")
    made = kind.__init__

    @functools.wraps(made)
    def init(self: Any, *args: Any, **kwargs: Any) -> None:
        nonlocal rules
        if rules is None:
            found: dict[str, Any] = {}
            for base in reversed(kind.__mro__):
                found |= _rules(inspect.get_annotations(base), base.__module__)
            rules = found
        names = [field.name for field in dataclasses.fields(kind) if field.init]
        _check({**dict(zip(names, args, strict=False)), **kwargs}, rules)
        made(self, *args, **kwargs)

    kind.__init__ = init  # type: ignore[method-assign]
    return kind


def _check(given: dict[str, Any], rules: dict[str, tuple[bool, tuple[object, ...]]]) -> None:
    for name, (many, words) in rules.items():
        if name not in given:
            continue
        value = given[name]
        if many and isinstance(value, (tuple, list)):
            for item in value:
                check_word(item, words, name)
        else:
            check_word(value, words, name)


def _rules(annotations: dict[str, Any], module: str) -> dict[str, tuple[bool, tuple[object, ...]]]:
    """Return, by name, whether several words are taken and which; annotations that are no words are left out."""
    space = vars(sys.modules[module])
    rules = {}
    for name, annotation in annotations.items():
        if name == "return":
            continue
        if isinstance(annotation, str):
            try:
                annotation = eval(annotation, dict(space))
            except (NameError, TypeError, AttributeError):
                continue  # names that only a type checker imports stand for no words
        found = _words(annotation)
        if found is not None:
            rules[name] = found
    return rules


def _words(annotation: Any) -> tuple[bool, tuple[object, ...]] | None:
    origin = get_origin(annotation)
    if origin is Literal:
        return False, get_args(annotation)
    if origin is tuple:
        parts = [part for part in get_args(annotation) if part is not Ellipsis]
        inner = _words(parts[0]) if len(set(parts)) == 1 else None
        return None if inner is None else (True, inner[1])
    if origin in (Union, types.UnionType):
        words: tuple[object, ...] = ()
        for part in get_args(annotation):
            if part is type(None):
                words += (None,)
                continue
            inner = _words(part)
            if inner is None or inner[0]:
                return None
            words += inner[1]
        return False, words
    return None
