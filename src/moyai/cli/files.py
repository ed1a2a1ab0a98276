"""Write text files so that a file under its final name is always complete."""

from __future__ import annotations

from pathlib import Path

from moyai.core.errors import InputError
from moyai.core.files import write_whole


def write_text(path: Path, text: str, *, replace: bool) -> Path:
    """Write UTF-8 text under a partial name and rename it.

    Parameters
    ----------
    path : Path
        Final name; its folder is made when absent.
    text : str
    replace : bool
        Whether a file that exists may be replaced.

    Raises
    ------
    InputError
        When the file exists and may not be replaced, or cannot be written.
    """
    if path.is_dir():
        raise InputError(f"{path} is a folder", path="output", remedy="name a file")
    if path.exists() and not replace:
        raise InputError(f"{path} exists", path="output", remedy="choose another name, or add --force")
    return write_whole(path, text.encode("utf-8"))


def decimal_sign(text: str) -> str:
    """Return the decimal sign of an option, or say which there are."""
    if text not in (".", ","):
        raise InputError(f"'{text}' is no decimal sign", path="--decimal", allowed="'.' or ','")
    return text
