"""Results of cases and of papers, computed once for all who ask: pages of the documentation and tests.

MOYAI_KEPT_RUNS names the folder where they are kept, under all that they depend on: the package and the case with the
files that it names. Without it each is computed.
"""

from __future__ import annotations

import hashlib
import os
import pickle
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

FOLDER = "MOYAI_KEPT_RUNS"


def kept_run(case: Any) -> Any:
    """Return the result of a case (or of the file or text of one), run where nobody has run it before.

    What was kept is read from its file, as ``moyai report`` does.
    """
    import moyai

    if not hasattr(case, "case_hash"):
        case = moyai.load_case(case)
    folder = os.environ.get(FOLDER)
    if not folder:
        return moyai.run(case)
    with _alone_at(Path(folder), ".nc", case.kind, case.case_hash, case.path.name, case.text) as kept:
        if not kept.exists():
            moyai.run(case).write(kept)
    return moyai.read_result(kept)


def kept_paper(name: str, *, quick: bool) -> Any:
    """Return a paper computed again, computed where nobody has done so before."""
    from moyai.reproduce import reproduce

    folder = os.environ.get(FOLDER)
    if not folder:
        return reproduce(name, quick=quick)
    with _alone_at(Path(folder), ".pickle", name, str(quick)) as kept:
        if not kept.exists():
            kept.write_bytes(pickle.dumps(reproduce(name, quick=quick)))
    return pickle.loads(kept.read_bytes())


def kept_value(name: str, compute: Callable[[], Any]) -> Any:
    """Return what a function computes out of the package alone, computed where nobody has done so before.

    The name says all that it depends on besides the package.
    """
    folder = os.environ.get(FOLDER)
    if not folder:
        return compute()
    with _alone_at(Path(folder), ".pickle", "value", name) as kept:
        if not kept.exists():
            kept.write_bytes(pickle.dumps(compute()))
    return pickle.loads(kept.read_bytes())


@cache
def package_stamp() -> str:
    """Return a digest of the sources and tables of the package."""
    import moyai

    folder, digest = Path(moyai.__file__).parent, hashlib.sha256()
    for path in sorted(path for kind in ("*.py", "*.csv", "*.yaml") for path in folder.rglob(kind)):
        digest.update(f"{path.relative_to(folder)}\n".encode() + path.read_bytes())
    return digest.hexdigest()


@contextmanager
def _alone_at(folder: Path, suffix: str, *depends: str) -> Iterator[Path]:
    """Wait until no other process works on what depends on these, and give its file.

    Where there are no such locks, each process works for itself.
    """
    key = hashlib.sha256("\n".join((package_stamp(), *depends)).encode())
    kept = folder / f"{key.hexdigest()[:24]}{suffix}"
    folder.mkdir(parents=True, exist_ok=True)
    try:
        import fcntl
    except ImportError:
        yield kept
        return
    with kept.with_suffix(".lock").open("w") as stream:
        fcntl.flock(stream, fcntl.LOCK_EX)
        yield kept
