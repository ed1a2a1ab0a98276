"""Files that are complete under their final name: written under a partial one and renamed."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from moyai.core.errors import InputError

_REMEDY = "choose a folder that can be written"


def require_space(folder: Path, size: int) -> None:
    """Refuse to start a file that the disk has no room for: the HDF5 library does not survive a disk that fills up.

    Parameters
    ----------
    folder : Path
        Where the file will stand.
    size : int
        Bytes of the data.

    Raises
    ------
    InputError
        With what is needed and what is free.
    """
    needed = 1.2 * size + 2_000_000
    free = shutil.disk_usage(folder).free
    if free < needed:
        raise InputError(
            f"{folder} has {free / 1e6:.1f} MB free and the results need about {needed / 1e6:.1f} MB",
            path="output",
            remedy="free some space or choose another folder",
        )


@contextmanager
def partial_file(path: Path, *, size: int = 0, remedy: str = _REMEDY, named: str = "output") -> Iterator[Path]:
    """Give the name of a new empty file, which takes the final name when the block ends without an exception.

    Parameters
    ----------
    path : Path
        Final name; its folder is made when absent, a file that exists is replaced.
    size : int
        Bytes of the data where the disk is to be asked first; see :func:`require_space`.
    remedy, named : str
        What the error advises, and the entry or option that it names.

    Raises
    ------
    InputError
        When the file cannot be written.
    """
    partial: Path | None = None
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        if size:
            require_space(path.parent, size)
        handle, name = tempfile.mkstemp(prefix=path.name + ".", suffix=".partial", dir=path.parent)
        os.close(handle)
        partial = Path(name)
        yield partial
        partial.chmod(0o666 & ~_umask())
        os.replace(partial, path)
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror or error}", path=named, remedy=remedy) from error
    finally:
        if partial is not None:
            partial.unlink(missing_ok=True)


def write_whole(path: Path, content: bytes, *, named: str = "output") -> Path:
    """Write a file so that it is complete under its final name, and return the name.

    Raises
    ------
    InputError
        When the file cannot be written.
    """
    with partial_file(path, named=named) as partial:
        partial.write_bytes(content)
    return path


def _umask() -> int:
    """Return the process's file mode mask, which can only be read by setting it."""
    mask = os.umask(0)
    os.umask(mask)
    return mask
