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

import numpy as np

from moyai.core.errors import InputError

#: Words that an argument may be, and words that a tuple given for it may hold.
Words = tuple[tuple[object, ...], tuple[object, ...]]
#: Name, place and words of every argument that is checked.
Rules = list[tuple[str, int, tuple[object, ...], tuple[object, ...]]]
Decorated = TypeVar("Decorated", bound=Callable[..., Any])


def check_word(word: object, allowed: Iterable[object], parameter: str) -> None:
    """Refuse a word that is not among those allowed.

    Parameters
    ----------
    word : object
        What was given.
    allowed : iterable
        The words; True and False among them stand for themselves, not for 1 and 0.
    parameter : str
        Name of the argument.

    Raises
    ------
    InputError
        With the words that are allowed and the nearest of them.
    """
    words = tuple(allowed)
    if isinstance(word, (str, int, np.bool_, type(None))):
        truth = isinstance(word, (bool, np.bool_))
        if any(word == item and truth == isinstance(item, bool) for item in words):
            return
    texts = [str(item) for item in words if isinstance(item, str)]
    if any(item is True for item in words) and not texts:
        raise InputError(
            f"'{word}' is neither true nor false",
            path=parameter,
            allowed="True or False or None" if None in words else "True or False",
            remedy="give the word without quotation marks" if str(word) in ("True", "False") else "",
        )
    near = [text for text in texts if word and text.startswith(str(word))]
    near = near or difflib.get_close_matches(str(word), texts, n=1, cutoff=0.6)
    raise InputError(
        f"'{word}' is not a known word",
        path=parameter,
        allowed=", ".join(repr(item) if isinstance(item, str) else str(item) for item in words),
        remedy=f"did you mean '{near[0]}'?" if near else "",
    )


def check_kind(given: object, kind: type | tuple[type, ...], parameter: str, remedy: str = "") -> None:
    """Refuse an object of another kind than the one that a call needs.

    Parameters
    ----------
    given : object
        What was given.
    kind : type or tuple of type
        A class, or a protocol that can be checked at run time (``SectionLike``, which a section fulfils); or several,
        any of which will do.
    parameter : str
        Name of the argument.
    remedy : str
        How to come to the object that is needed.

    Raises
    ------
    InputError
        With both kinds.
    """
    if not isinstance(given, kind):
        kinds = kind if isinstance(kind, tuple) else (kind,)
        names = [one.__name__.removesuffix("Like") for one in kinds]
        allowed = " or ".join(f"a {name}" for name in names)
        raise InputError(f"{type(given).__name__} is no {names[0]}", path=parameter, allowed=allowed, remedy=remedy)


def checks_words(decorated: Decorated) -> Decorated:
    """Check every argument whose annotation is a ``Literal`` or ``bool`` (or a tuple of them) before a function runs.

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
    rules: Rules | None = None

    @functools.wraps(decorated)
    def checked(*args: Any, **kwargs: Any) -> Any:
        nonlocal rules
        if rules is None:
            rules = _placed(_rules(decorated.__annotations__, decorated.__module__), by_place)
        _check(args, kwargs, rules)
        return decorated(*args, **kwargs)

    return checked  # type: ignore[return-value]


def _check_fields(kind: type) -> type:
    rules: Rules | None = None
    if not dataclasses.is_dataclass(kind):
        raise TypeError(f"{kind.__name__} is no dataclass: put checks_words above its @dataclass")
    made = kind.__init__

    @functools.wraps(made)
    def init(self: Any, *args: Any, **kwargs: Any) -> None:
        nonlocal rules
        if rules is None:
            found: dict[str, Words] = {}
            for base in reversed(kind.__mro__):
                found |= _rules(inspect.get_annotations(base), base.__module__)
            rules = _placed(found, [field.name for field in dataclasses.fields(kind) if field.init])
        _check(args, kwargs, rules)
        made(self, *args, **kwargs)

    kind.__init__ = init  # type: ignore[method-assign]
    return kind


def _placed(rules: dict[str, Words], by_place: list[str]) -> Rules:
    """Return the rules with the place of every argument; one that is given by name alone lies behind all places."""
    return [(name, by_place.index(name) if name in by_place else sys.maxsize, *rules[name]) for name in rules]


def _check(args: tuple[Any, ...], kwargs: dict[str, Any], rules: Rules) -> None:
    for name, place, words, items in rules:
        if place < len(args):
            value = args[place]
        elif name in kwargs:
            value = kwargs[name]
        else:
            continue
        for word in words:
            if value is word:  # nearly always, and the quickest comparison: hot calls do not feel the check
                break
        else:
            _check_value(value, words, items, name)


def _check_value(value: Any, words: tuple[object, ...], items: tuple[object, ...], name: str) -> None:
    if items and isinstance(value, (tuple, list, np.ndarray)):
        for item in value:
            check_word(item, items, name)
    else:
        check_word(value, (*words, *items), name)


def _rules(annotations: dict[str, Any], module: str) -> dict[str, Words]:
    """Return the words of every argument by its name; annotations that are no words are left out."""
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


def _words(annotation: Any) -> Words | None:
    """Return the words that may be given, and those that a tuple of them may hold."""
    if annotation is bool:
        return (True, False), ()
    if annotation is type(None):
        return (None,), ()
    origin = get_origin(annotation)
    if origin is Literal:
        return get_args(annotation), ()
    if origin is tuple:
        parts = [part for part in get_args(annotation) if part is not Ellipsis]
        inner = _words(parts[0]) if len(set(parts)) == 1 else None
        return ((), inner[0]) if inner and inner[0] else None
    if origin in (Union, types.UnionType):
        found = [_words(part) for part in get_args(annotation)]
        sure = [one for one in found if one is not None]
        if len(sure) == len(found):
            return sum((one[0] for one in sure), ()), sum((one[1] for one in sure), ())
    return None
