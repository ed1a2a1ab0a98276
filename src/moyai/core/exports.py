"""Names that a package hands out and imports only when they are asked for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any


def exports(package: str, names: Mapping[str, str]) -> tuple[Callable[[str], Any], Callable[[], list[str]], list[str]]:
    """Return ``__getattr__``, ``__dir__`` and ``__all__`` of a package whose names stand in its modules.

    Importing the package costs nothing: a module is imported when one of its names is first used.

    Parameters
    ----------
    package : str
        ``__name__`` of the package.
    names : mapping of str to str
        Names, separated by blanks, by the module below the package that holds them; the empty text stands for modules
        that are handed out as a whole. No name may be that of another module of the package: Python would give the
        module once it is imported.

    Returns
    -------
    tuple
        To be bound to the three names in the ``__init__`` of the package.
    """
    homes = {name: module for module, text in names.items() for name in text.split()}

    def find(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        home = homes[name]
        if not home:
            return import_module(f"{package}.{name}")
        return getattr(import_module(f"{package}.{home}"), name)

    shown = sorted(homes)
    return find, lambda: shown, shown
