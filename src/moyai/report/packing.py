"""Pack the long arrays of a page in one compressed block that the browser unpacks itself."""

from __future__ import annotations

import base64
import zlib
from typing import Any

import numpy as np

CODES = {"f4": 4, "i2": 2, "i1": 1, "u1": 1}
"""Keys under which an array stands as base64 text, and bytes a number."""
_LEVEL = 3


def pack_arrays(data: Any) -> tuple[Any, str]:
    """Move the arrays of a page's data into one compressed block, without any loss.

    Neighbours in time differ little: each column holds the steps from row to row of its bit patterns, byte by byte of
    the same weight, which gzip halves where it can do nothing with the numbers as they are.

    Parameters
    ----------
    data : dict
        Figures and scenes; an array is ``{"f4": base64, ...}`` or one of the other :data:`CODES`, row by row, with
        ``columns`` and ``count`` (columns a row in all: their product, 1 where absent).

    Returns
    -------
    dict
        The same with ``[start, bytes, columns]`` of the block in place of the text.
    str
        The block, gzip in base64; empty where there are no arrays. ``MOYAI.unpack`` of ``report.js`` is the inverse.
    """
    parts: list[bytes] = []
    place = 0

    def moved(value: Any) -> Any:
        nonlocal place
        if isinstance(value, list):
            return [moved(item) for item in value] if value and isinstance(value[0], dict | list) else value
        if not isinstance(value, dict):
            return value
        code = next((key for key in CODES if isinstance(value.get(key), str)), None)
        if code is None:
            return {key: moved(item) for key, item in value.items()}
        columns = int(value.get("columns", 1)) * int(value.get("count", 1))
        parts.append(steps_by_weight(base64.b64decode(value[code]), CODES[code], columns))
        entry, place = [place, len(parts[-1]), columns], place + len(parts[-1])
        return {**value, code: entry}

    found = moved(data)
    if not parts:
        return found, ""
    packer = zlib.compressobj(_LEVEL, wbits=31)  # 31: with the head of gzip, without a date
    block = packer.compress(b"".join(parts)) + packer.flush()
    return found, base64.b64encode(block).decode("ascii")


def steps_by_weight(content: bytes, width: int, columns: int) -> bytes:
    """Return the steps from row to row of unsigned integers, column by column, all bytes of one weight together.

    Parameters
    ----------
    content : bytes
        Little-endian, row by row.
    width : int
        Bytes a number.
    columns : int
        Numbers a row.

    Returns
    -------
    bytes
        As many; steps are taken modulo the range of the integers.
    """
    words = np.frombuffer(content, f"<u{width}").reshape(-1, columns)
    steps = np.ascontiguousarray(np.diff(words, axis=0, prepend=words[:1] * 0).T)
    return steps.view(np.uint8).reshape(-1, width).T.tobytes()
