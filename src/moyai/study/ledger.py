"""The diary of a study: one line a finished case, written as soon as the case is finished.

Plain lines of JSON, appended and handed to the system one by one: whenever the program ends, by whatever means, at most
the line being written is damaged, and it is left out when the diary is read again. Numbers are written so that they
are read back to the last bit. Once a second the system is made to put them on the disk itself, so that a machine that
loses its power loses no more than that; asking for it line by line would cost more than short cases do.
"""

from __future__ import annotations

import contextlib
import json
import os
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

from moyai.core.errors import InputError

FORMAT = 1
NAME = "study.jsonl"
LOCK = ".study.lock"

_SYNC = 1.0
"""Seconds between two demands to put the diary on the disk."""


@dataclass(frozen=True)
class LedgerRecord:
    """What is known of one case."""

    #: Number of the case.
    index: int
    #: Status of its result, ``failed``, or ``refused`` where the check of the case refused it.
    status: str
    #: One sentence behind it.
    message: str
    #: Time it took [s].
    seconds: float
    #: What was kept (:func:`moyai.study.responses.kept`).
    values: dict[str, Any]
    #: Whether the design holds; empty where nothing was to be judged.
    verdict: str = ""

    def line(self) -> str:
        """Return the record as one line."""
        return json.dumps(
            {
                "index": self.index,
                "status": self.status,
                "message": self.message,
                "seconds": self.seconds,
                "values": self.values,
                "verdict": self.verdict,
            }
        )


class Ledger:
    """The diary in a folder, opened for one study.

    Parameters
    ----------
    folder : Path
        Folder of the study's results.
    key : str
        Hash of everything that the study's results depend on.
    title : str
        For whoever looks into the file.

    Raises
    ------
    InputError
        When the folder holds another study, another run is at work in it, or it cannot be written.
    """

    def __init__(self, folder: Path, key: str, title: str) -> None:
        self.path = folder / NAME
        self._file: IO[str] | None = None
        self._lock: IO[str] | None = None
        self._synced = -_SYNC
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._lock = _locked(folder)
            complete = self._repair(key)
            self._file = self.path.open("a", encoding="utf-8", newline="\n")
            if not complete:
                self._write(json.dumps({"moyai_study": FORMAT, "key": key, "title": title}))
        except OSError as error:
            raise InputError(
                f"cannot write {self.path}: {error.strerror or error}",
                path="output",
                remedy="choose a folder that can be written",
            ) from error
        except InputError:
            self._free()
            raise

    def _repair(self, key: str) -> bool:
        """Cut off a damaged last line; return whether the diary has its heading already."""
        if not self.path.exists():
            return False
        raw = self.path.read_bytes()
        whole = raw[: raw.rfind(b"\n") + 1]
        if len(whole) < len(raw):
            with self.path.open("r+b") as file:
                file.truncate(len(whole))
        if not whole:
            return False
        heading = read_heading(self.path)
        if heading["key"] != key:
            raise InputError(
                f"{self.path.parent} holds the results of another study ('{heading.get('title', '')}')",
                path="output",
                remedy="choose another folder, or remove this one if its results are not wanted any more",
            )
        return True

    def _write(self, line: str) -> None:
        assert self._file is not None
        self._file.write(line + "\n")
        self._file.flush()
        if time.monotonic() - self._synced >= _SYNC:
            os.fsync(self._file.fileno())
            self._synced = time.monotonic()

    def add(self, record: LedgerRecord) -> None:
        """Append a finished case.

        Raises
        ------
        InputError
            When the disk is full or gone; what was written before stays.
        """
        try:
            self._write(record.line())
        except OSError as error:
            raise self._full(error) from error

    def settle(self) -> None:
        """Have everything that was added on the disk.

        Raises
        ------
        InputError
            When the disk is full or gone.
        """
        if self._file is not None:
            try:
                os.fsync(self._file.fileno())
            except OSError as error:
                raise self._full(error) from error

    def _full(self, error: OSError) -> InputError:
        return InputError(
            f"cannot write {self.path}: {error.strerror or error}; the cases finished before are safe",
            path="output",
            remedy="make room and give the same command again",
        )

    def close(self) -> None:
        """Close the file."""
        if self._file is not None:
            # A full disk may refuse the last flush again; every record was flushed on its own
            with contextlib.suppress(OSError):
                self._file.close()
        self._free()

    def _free(self) -> None:
        """Let other runs into the folder."""
        if self._lock is not None:
            self._lock.close()
            self._lock = None

    def records(self) -> Iterator[LedgerRecord]:
        """Return what was recorded so far, the last word on every case."""
        latest: dict[int, LedgerRecord] = {}
        for record in read_records(self.path):
            latest[record.index] = record
        return iter([latest[index] for index in sorted(latest)])


def _locked(folder: Path) -> IO[str]:
    """Return a file that is locked as long as it is open; the system frees it however the process ends.

    Raises
    ------
    InputError
        When another process holds it.
    """
    file = (folder / LOCK).open("a", encoding="utf-8")
    try:
        if sys.platform == "win32":
            import msvcrt

            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (BlockingIOError, PermissionError):
        file.close()
        raise InputError(
            f"another run is at work in {folder}", path="output", remedy="wait for its end, or choose another folder"
        ) from None
    except OSError:
        # Some network file systems have no locks; the diary itself stands two writers, at the price of double work
        pass
    return file


def read_heading(path: Path) -> dict[str, Any]:
    """Return the first line of a diary.

    Raises
    ------
    InputError
        When the file is no diary of a study.
    """
    with path.open(encoding="utf-8") as file:
        first = file.readline()
    try:
        heading = json.loads(first)
        if heading["moyai_study"] == FORMAT and "key" in heading:
            return dict(heading)
    except (ValueError, KeyError, TypeError):
        pass
    raise InputError(f"{path} is no diary of a study", path="output", remedy="choose another folder")


def read_records(path: Path) -> Iterator[LedgerRecord]:
    """Yield every record of a diary, in the order of writing; damaged lines are left out."""
    with path.open(encoding="utf-8") as file:
        next(file, None)
        for line in file:
            try:
                item = json.loads(line)
                yield LedgerRecord(
                    int(item["index"]), item["status"], item["message"], float(item["seconds"]), item["values"],
                    item.get("verdict", ""),
                )  # fmt: skip
            except (ValueError, KeyError, TypeError):
                continue
