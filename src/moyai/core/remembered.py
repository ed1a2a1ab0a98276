"""Answers that a process keeps in memory by all that they depend on: cases of a study often share most of them."""

from __future__ import annotations

import hashlib
import pickle
import threading
from collections import OrderedDict
from collections.abc import Callable
from typing import Any, Generic, TypeVar

Answer = TypeVar("Answer")


class Remembered(Generic[Answer]):
    """The last few answers of one kind.

    Parameters
    ----------
    most : int
        How many are kept; the one that was not asked for longest goes first.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        self._known: OrderedDict[str, Answer] = OrderedDict()
        self._guard = threading.Lock()

    def of(self, key: str | None, make: Callable[[], Answer]) -> Answer:
        """Return the answer of a key, made where it is not known; what raises and what has no key is not kept."""
        if key is None:
            return make()
        with self._guard:
            if key in self._known:
                self._known.move_to_end(key)
                return self._known[key]
        found = make()
        with self._guard:
            self._known[key] = found
            while len(self._known) > self._most:
                self._known.popitem(last=False)
        return found

    def clear(self) -> None:
        """Forget all."""
        self._known.clear()


def key_of_objects(*parts: Any) -> str:
    """Return a key of frozen objects by their content: equal keys mean equal content, to the last bit.

    The converse does not hold: equal objects made in other ways may have two keys, which costs time and nothing else.
    """
    return hashlib.blake2b(pickle.dumps(parts, protocol=5), digest_size=24).hexdigest()
