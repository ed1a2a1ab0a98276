"""Whether the elements of a MATLAB 5 file are laid out soundly, found before a compiled reader follows their tags.

An element is a tag of type and length, then its content; a matrix holds elements, a compressed element one matrix.
Format: MathWorks, MAT-File Format, chapter 1. A compiled reader that meets a type that does not exist reads past the
end of its tables.
"""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

from moyai.core.errors import InputError
from moyai.core.foreign_files import LARGEST_COMPRESSION, REMEDY

_HEADER = 128
_MATRIX, _COMPRESSED = 14, 15
_TYPES = frozenset({1, 2, 3, 4, 5, 6, 7, 9, 12, 13, _MATRIX, _COMPRESSED, 16, 17, 18})
_DEEPEST = 50


def check_elements(path: Path) -> None:
    """Walk through the elements of a file of version 5; files of versions 4 and 7.3 are left to their readers.

    Parameters
    ----------
    path : Path

    Raises
    ------
    InputError
        At the first element of an unknown type or one longer than what holds it, with its place in the file.
    """
    raw = memoryview(path.read_bytes())
    order = {b"IM": "<", b"MI": ">"}.get(bytes(raw[126:128]))
    if (
        order is None
        or len(raw) < _HEADER
        or 0 in bytes(raw[:4])
        or bytes(raw[124:126]) not in (b"\x00\x01", b"\x01\x00")
    ):
        return
    _walk(raw[_HEADER:], order, path, _HEADER, 0)


def _walk(raw: memoryview, order: str, path: Path, start: int, depth: int) -> None:
    """Check a run of elements; ``start`` is its place in the file, for messages."""
    at = 0
    while at + 8 <= len(raw):
        kind, length = struct.unpack_from(order + "II", raw, at)
        first, small = at + 8, bool(kind >> 16)
        if small:
            # A small element: two bytes of length, two of type, at most four of content
            kind, length, first = kind & 0xFFFF, kind >> 16, at + 4
            if length > 4:
                raise _fault(path, start + at, f"a small element of {length} bytes")
        if kind not in _TYPES:
            raise _fault(path, start + at, f"an element of type {kind}, which does not exist")
        if first + length > len(raw):
            raise _fault(path, start + at, f"an element of {length} bytes where {len(raw) - first} are left")
        content = raw[first : first + length]
        if kind == _COMPRESSED:
            _walk(_inflated(content, path, start + at), order, path, start + at, depth + 1)
        elif kind == _MATRIX:
            if depth > _DEEPEST:
                raise _fault(path, start + at, f"matrices within matrices beyond {_DEEPEST} levels")
            _walk(content, order, path, start + first, depth + 1)
        # Ordinary elements are padded to eight bytes, compressed ones are not
        padding = 0 if kind == _COMPRESSED else (-length) % 8
        at = at + 8 if small else first + length + padding


def _inflated(content: memoryview, path: Path, place: int) -> memoryview:
    stream = zlib.decompressobj()
    try:
        return memoryview(stream.decompress(content, int(LARGEST_COMPRESSION * len(content)) + 1))
    except zlib.error as error:
        raise _fault(path, place, f"a compressed element that does not decompress ({error})") from None


def _fault(path: Path, place: int, what: str) -> InputError:
    return InputError(
        f"{path.name} cannot be read as a MATLAB file: byte {place} begins {what}", parameter="file", remedy=REMEDY
    )
