"""Where the measured records are: in the folder MOYAI_SHARED_DATA, or ``../shared/data`` next to the repository."""

import os
from pathlib import Path


def shared_folder() -> Path:
    """Return the folder of the measured records.

    Raises
    ------
    SystemExit
        When it is not there.
    """
    sibling = Path(__file__).resolve().parents[3] / "shared" / "data"
    folder = Path(os.environ.get("MOYAI_SHARED_DATA", sibling))
    if not (folder / "README.md").is_file():
        raise SystemExit(f"the measured records are not at {folder}: set MOYAI_SHARED_DATA to their folder")
    return folder
