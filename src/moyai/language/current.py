"""The language in force: set for a command or a page, and what a text says in it."""

from __future__ import annotations

import locale
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

from moyai.core.errors import InputError
from moyai.language.catalogue import LANGUAGES

_language: ContextVar[str] = ContextVar("language", default="en")


def require_language(name: str) -> str:
    """Return a name that is one of :data:`~moyai.language.catalogue.LANGUAGES`.

    Parameters
    ----------
    name : str
        "en" or "ja".

    Returns
    -------
    str
        The same name.

    Raises
    ------
    InputError
        For another name.

    Examples
    --------
    >>> from moyai.language import require_language
    >>> require_language("ja")
    'ja'
    """
    if name not in LANGUAGES:
        raise InputError(f"'{name}' is no language of reports", path="language", allowed=" or ".join(LANGUAGES))
    return name


@contextmanager
def spoken_in(language: str) -> Iterator[str]:
    """Let :func:`said` speak one of the languages inside; see :func:`require_language`.

    Parameters
    ----------
    language : str
        "en" or "ja".

    Yields
    ------
    str
        The same name.

    Raises
    ------
    InputError
        For another name.

    Examples
    --------
    >>> from moyai.language import spoken_in, spoken_language
    >>> with spoken_in("ja"):
    ...     print(spoken_language())
    ...
    ja
    """
    mark = _language.set(require_language(language))
    try:
        yield language
    finally:
        _language.reset(mark)


def speak(language: str) -> None:
    """Let :func:`said` speak a language until the :func:`spoken_in` around it ends.

    Parameters
    ----------
    language : str
        "en" or "ja".

    Raises
    ------
    InputError
        For another name.

    Examples
    --------
    >>> from moyai.language import speak, spoken_in, spoken_language
    >>> with spoken_in("en"):
    ...     speak("ja")
    ...     print(spoken_language())
    ...
    ja
    """
    _language.set(require_language(language))


def spoken_language() -> str:
    """Return the language in force.

    Returns
    -------
    str
        "en" or "ja".

    Examples
    --------
    >>> from moyai.language import spoken_in, spoken_language
    >>> with spoken_in("en"):
    ...     print(spoken_language())
    ...
    en
    """
    return _language.get()


def said(text: str) -> str:
    """Return an English text in the language in force; what no catalogue knows stays English.

    Parameters
    ----------
    text : str
        A sentence or word in English, with its numbers.

    Returns
    -------
    str
        In the language of :func:`spoken_language`.

    Examples
    --------
    >>> from moyai.language import said, spoken_in
    >>> with spoken_in("ja"):
    ...     print(said("water depth"))
    ...
    水深
    """
    language = _language.get()
    if language == "en" or not text:
        return text
    from moyai.language.translator import translator

    return translator(language).text(text)


def language_of_the_locale() -> str:
    """Return the language of the user: that of ``MOYAI_LANGUAGE``, else of the locale, English where neither is known.

    ``LC_ALL``, ``LC_MESSAGES`` and ``LANG`` are read in this order, on Windows the locale of the user.

    Returns
    -------
    str
        "en" or "ja".

    Raises
    ------
    InputError
        When ``MOYAI_LANGUAGE`` names no language.

    Examples
    --------
    >>> from moyai.language import language_of_the_locale
    >>> language_of_the_locale() in ("en", "ja")
    True
    """
    own = os.environ.get("MOYAI_LANGUAGE", "")
    if own:
        return require_language(own)
    name = next((os.environ[key] for key in ("LC_ALL", "LC_MESSAGES", "LANG") if os.environ.get(key)), "")
    if not name and sys.platform == "win32":
        name = locale.getlocale()[0] or ""
    return "ja" if name.lower().startswith(("ja", "japanese")) else "en"
