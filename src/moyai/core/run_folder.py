"""A folder of results that holds one run: alone at work in it, all its outputs put in place together at the end.

Files are written into a hidden folder inside. When all are complete, what an earlier run left is removed and they are
renamed into place, the report last: wherever the process ends, results and report are never of different runs.
"""

from __future__ import annotations

import os
import re
import shutil
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from moyai.core.errors import InputError
from moyai.core.interrupts import held_back

STAGED = ".run.partial"
RESULTS = "results.nc"
_LEFT_BEHIND = re.compile(r".+\.[a-z0-9_]{8}\.partial")
_OUTPUTS = ("report.html", "report.pdf", "report.xlsx", "report_tables", RESULTS)
"""What a run writes, in the order in which an earlier one's is removed; it is put in place the other way round."""


def prepare_output(directory: Path) -> Path:
    """Make the folder of a run and prove that it can be written, before any work starts.

    Raises
    ------
    InputError
        When it cannot be made or written, or a file stands in its place.
    """
    if directory.exists() and not directory.is_dir():
        raise InputError(f"{directory} is a file", path="output", remedy="name a folder with --output")
    try:
        directory.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=directory) as probe:
            probe.write(b"moyai")
    except OSError as error:
        raise InputError(
            f"cannot write to {directory}: {error.strerror or error}",
            path="output",
            remedy="choose a folder that can be written with --output",
        ) from None
    return directory


@contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Lock a folder against other runs; the system frees it however the process ends.

    Raises
    ------
    InputError
        When another run is at work in it.
    """
    handle = _lock(folder)
    try:
        yield
    finally:
        if handle is not None:
            os.close(handle)


def _lock(folder: Path) -> int | None:
    """Return the handle that holds the lock, ``None`` on file systems that have no locks."""
    handle: int | None = None
    try:
        if sys.platform == "win32":
            import msvcrt

            handle = os.open(folder / ".run.lock", os.O_RDWR | os.O_CREAT)
            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            handle = os.open(folder, os.O_RDONLY)
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (BlockingIOError, PermissionError):
        if handle is not None:
            os.close(handle)
        raise InputError(
            f"another run is at work in {folder}", path="output", remedy="wait for its end, or choose another folder"
        ) from None
    except OSError:
        pass
    return handle


@contextmanager
def staged_outputs(folder: Path) -> Iterator[Path]:
    """Give a hidden folder for the outputs of a run, after removing what ended runs left; gone when the block ends.

    Parameters
    ----------
    folder : Path
        Held by :func:`alone_in`.
    """
    staged = folder / STAGED
    _remove(staged)
    for left in folder.rglob("*.partial"):
        if _LEFT_BEHIND.fullmatch(left.name) and left.is_file():
            left.unlink(missing_ok=True)
    try:
        staged.mkdir()
        yield staged
    except OSError as error:
        raise InputError(
            f"cannot write to {folder}: {error.strerror or error}",
            path="output",
            remedy="choose a folder that can be written with --output",
        ) from error
    finally:
        with suppress(OSError):
            _remove(staged)


def put_in_place(staged: Path, folder: Path, files: Sequence[Path]) -> list[Path]:
    """Replace the outputs of an earlier run by those of this one, and return their final names.

    Parameters
    ----------
    staged : Path
        From :func:`staged_outputs`; everything in it is complete.
    folder : Path
    files : sequence of Path
        Files in ``staged``.
    """
    with held_back():
        for name in _OUTPUTS[:-1]:
            _remove(folder / name)
        for name in reversed(_OUTPUTS):
            if (staged / name).exists():
                os.replace(staged / name, folder / name)
    return [folder / path.relative_to(staged) for path in files]


@contextmanager
def keeping_results(staged: Path, folder: Path) -> Iterator[None]:
    """Put results in place alone where the block that writes them and their report does not come to its end.

    Parameters
    ----------
    staged : Path
        From :func:`staged_outputs`.
    folder : Path
    """
    try:
        yield
    except BaseException:
        # a second Ctrl-C waits
        with held_back():
            if (staged / RESULTS).exists():
                for name in _OUTPUTS[:-1]:
                    _remove(staged / name)
                put_in_place(staged, folder, ())
        raise


def _remove(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)
