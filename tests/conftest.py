"""Fixtures for all tests."""

import gc
import os
import shutil
import sys
import tempfile
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import typer.testing

from moyai.core.processes import collect_rarely
from moyai.core.vocabulary import Strictness

# A name of a result that no vocabulary declares is an error in every test
Strictness.names = True
# Workers, runs and the processes that tests start share their bytecode: to compile it takes longer than most tests
sys.dont_write_bytecode = False
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
# To look for garbage as often as Python does takes a fifth of all time: what is imported and collected stays to the end
collect_rarely()
# The workers of the tests take all cores
os.environ.setdefault("MOYAI_COMPILE_PROCESSES", "0")
# Messages are held against English, whatever the locale
os.environ["MOYAI_LANGUAGE"] = "en"
# Results of examples that several tests read are kept for all workers; a name from outside is kept for longer
_OWN = None if "MOYAI_KEPT_RUNS" in os.environ else os.environ.setdefault("MOYAI_KEPT_RUNS", tempfile.mkdtemp())


def pytest_configure() -> None:
    """Build the command line once; let one worker compile a kernel and the others take it from the cache."""
    typer.testing._get_command = cache(typer.testing._get_command)  # type: ignore[attr-defined]
    try:
        import fcntl
    except ImportError:
        return
    from moyai.core import compiled

    locks, whole = Path(os.environ["MOYAI_KEPT_RUNS"]), compiled._Kernel.compile
    locks.mkdir(parents=True, exist_ok=True)

    def compile_alone(kernel: Any, signature: Any) -> Any:
        with (locks / f"{kernel.py_func.__module__}.{kernel.py_func.__name__}.lock").open("w") as stream:
            fcntl.flock(stream, fcntl.LOCK_EX)
            return whole(kernel, signature)

    compiled._Kernel.compile = compile_alone


def pytest_unconfigure() -> None:
    """Remove what this process keeps."""
    gc.freeze()  # pytest looks for garbage five times before it ends
    if _OWN is not None:
        shutil.rmtree(_OWN, ignore_errors=True)


def pytest_collection_finish() -> None:
    """Leave the tests themselves out of every later collection of garbage."""
    gc.freeze()


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Folder of measured records and files of other programs; tests that need it carry the marker ``shared_data``."""
    sibling = Path(__file__).resolve().parents[2] / "shared" / "data"
    folder = Path(os.environ.get("MOYAI_SHARED_DATA", sibling))
    if not (folder / "README.md").is_file():
        pytest.skip(f"measured records are not at {folder}: set MOYAI_SHARED_DATA to their folder")
    return folder
