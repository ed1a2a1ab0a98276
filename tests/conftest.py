"""Fixtures for all tests."""

import gc
import os
import sys
from pathlib import Path

import pytest

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


def pytest_collection_finish() -> None:
    """Leave the tests themselves out of every later collection of garbage."""
    gc.freeze()


@pytest.fixture(scope="session")
def shared_data() -> Path:
    """Folder of measured records and files of other programs; tests that need it carry the marker ``shared_data``."""
    beside = Path(__file__).resolve().parents[2] / "shared" / "data"
    folder = Path(os.environ.get("MOYAI_SHARED_DATA", beside))
    if not (folder / "README.md").is_file():
        pytest.skip(f"measured records are not at {folder}: set MOYAI_SHARED_DATA to their folder")
    return folder
