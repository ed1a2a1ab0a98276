"""Write text files so that a file under its final name is always complete."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from moyai.core.errors import InputError


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
    partial = ""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, partial = tempfile.mkstemp(prefix=path.name + ".", suffix=".partial", dir=path.parent)
        with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as stream:
            stream.write(text)
        mask = os.umask(0)
        os.umask(mask)
        os.chmod(partial, 0o666 & ~mask)
        os.replace(partial, path)
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror or error}", path="output") from None
    finally:
        if partial:
            Path(partial).unlink(missing_ok=True)
    return path


def decimal_sign(text: str) -> str:
    """Return the decimal sign of an option, or say which there are."""
    if text not in (".", ","):
        raise InputError(f"'{text}' is no decimal sign", path="--decimal", allowed="'.' or ','")
    return text
