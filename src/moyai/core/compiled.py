"""Compiled kernels: numba's ``njit`` with a cache that sees what a kernel calls.

The cache of numba looks at the file of a kernel alone. A kernel that calls one of another file would go on with the old
inner one after an edit or an upgrade; here the content of every file of the package that it imports, directly or not,
belongs to the key.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any, ClassVar

import numba
from numba.core import event
from numba.core.caching import CompileResultCacheImpl, FunctionCache

_PACKAGE = Path(__file__).parents[1]
_IMPORT = re.compile(r"^from (moyai[\w.]*) import (\([^)]*\)|[^\n]*)", re.MULTILINE)


@cache
def _source(path: Path) -> tuple[bytes, frozenset[Path]]:
    """Return the content of a file, and the files of the package that it imports."""
    content = path.read_bytes()
    found: set[Path] = set()
    for module, names in _IMPORT.findall(content.decode("utf-8")):
        place = _PACKAGE.parent.joinpath(*module.split("."))
        candidates = [place, *(place / name for name in re.findall(r"\w+", names))]
        found.update(file for item in candidates if (file := item.with_suffix(".py")).is_file())
    return content, frozenset(found)


@cache
def kernel_stamp(path: Path) -> bytes:
    """Return a digest of a file with every file of the package that it imports, directly or not."""
    known, open_ones = {path}, [path]
    while open_ones:
        fresh = _source(open_ones.pop())[1] - known
        known |= fresh
        open_ones += fresh
    digest = hashlib.sha256()
    for file in sorted(known):
        digest.update(hashlib.sha256(_source(file)[0]).digest())
    return digest.digest()


def _with_stamp(locator: Any) -> Any:
    """Return a place for the cache that takes the stamp from all files of a kernel."""

    class Locator(locator):  # type: ignore[misc]
        def get_source_stamp(self) -> Any:
            path = Path(getattr(self, "_py_file", ""))
            return kernel_stamp(path) if path.suffix == ".py" and path.is_file() else super().get_source_stamp()

    return Locator


class _CacheImpl(CompileResultCacheImpl):  # type: ignore[misc]
    _locator_classes: ClassVar = [_with_stamp(locator) for locator in CompileResultCacheImpl._locator_classes]


class _Cache(FunctionCache):  # type: ignore[misc]
    _impl_class = _CacheImpl


def njit(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Return numba's decorator of the same name; ``cache=True`` sees the kernels that a kernel calls."""
    cached = options.pop("cache", False)

    def compiled(function: Callable[..., Any]) -> Any:
        kernel = numba.njit(**options)(function)
        if cached and not numba.config.DISABLE_JIT:
            kernel._cache = _Cache(function)
        return kernel

    return compiled


@contextmanager
def when_compiling(call: Callable[[], None]) -> Iterator[None]:
    """Call once when the first kernel is compiled that no run before has left in the cache."""

    class Once(event.Listener):  # type: ignore[misc]
        called = False

        def on_start(self, event: Any) -> None:
            if not self.called:
                self.called = True
                call()

        def on_end(self, event: Any) -> None:
            pass

    with event.install_listener("numba:compile", Once()):
        yield
