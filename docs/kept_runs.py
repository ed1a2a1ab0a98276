"""Results of cases, run once for all who ask: pages of the documentation and tests.

MOYAI_KEPT_RUNS names the folder where they are kept, under all that they depend on: the package and the case with the
files that it names. Without it every case is run.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator
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
    key = hashlib.sha256("\n".join((package_stamp(), case.kind, case.case_hash, case.path.name, case.text)).encode())
    kept = Path(folder) / f"{key.hexdigest()[:24]}.nc"
    with alone(kept.with_suffix(".lock")):
        if not kept.exists():
            moyai.run(case).write(kept)
    return moyai.read_result(kept)


@cache
def package_stamp() -> str:
    """Return a digest of the sources and tables of the package."""
    import moyai

    folder, digest = Path(moyai.__file__).parent, hashlib.sha256()
    for path in sorted(path for kind in ("*.py", "*.csv", "*.yaml") for path in folder.rglob(kind)):
        digest.update(f"{path.relative_to(folder)}\n".encode() + path.read_bytes())
    return digest.hexdigest()


@contextmanager
def alone(lock: Path) -> Iterator[None]:
    """Wait until no other process holds a file; where there are no such locks, each runs for itself."""
    lock.parent.mkdir(parents=True, exist_ok=True)
    try:
        import fcntl
    except ImportError:
        yield
        return
    with lock.open("w") as stream:
        fcntl.flock(stream, fcntl.LOCK_EX)
        yield
