"""Whether the global heaps of an HDF5 file can be walked through: the HDF5 library does not come back from some.

A heap holds references and words of variable length: 16 bytes of head, then objects of 16 bytes of head and their
content, the last one, number 0, being the space that is left. The library takes its steps by the stated sizes: a size
of zero, or one so large that 64 bits carry it back to zero, keeps it in place forever. Format: The HDF Group, HDF5 File
Format Specification, level 1E.
"""

from __future__ import annotations

import mmap
import struct
from pathlib import Path

_MARK = b"GCOL\x01\x00\x00\x00"
_HEAD = 16


def stuck_heap(path: Path) -> int:
    """Return the place of a heap in which the library would stay forever, -1 where there is none.

    Parameters
    ----------
    path : Path
        HDF5 file, not empty; sizes of eight bytes, as all common programs write them.
    """
    with path.open("rb") as stream, mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ) as raw:
        place = raw.find(_MARK)
        while place >= 0:
            if _stuck(raw, place):
                return place
            place = raw.find(_MARK, place + len(_MARK))
    return -1


def _stuck(raw: mmap.mmap, place: int) -> bool:
    if place + _HEAD > len(raw):
        return False
    end = min(place + struct.unpack_from("<Q", raw, place + 8)[0], len(raw))
    at = place + _HEAD
    while at + _HEAD <= end:
        number, size = struct.unpack_from("<H6xQ", raw, at)
        # The space that is left counts its own head, an object does not and is padded to eight bytes
        step = size if number == 0 else _HEAD + (size + 7) // 8 * 8
        if step == 0 or at + step > end:
            return True
        at += step
    return False
