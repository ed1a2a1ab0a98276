"""From the cage schema to the problem of its model."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from moyai.case.cage_models import part
from moyai.case.schema_cage import CageCase


def build_problem(model: CageCase, folder: Path, *, case_text: str = "", case_hash: str = "") -> Any:
    """Return the problem of a cage case, of the type that its ``structure.model`` asks for.

    Parameters
    ----------
    model : CageCase
        Validated content.
    folder : Path
        Folder that the file names in it refer to.
    case_text, case_hash : str
        Kept with the result.

    Raises
    ------
    InputError
        For what the schema alone cannot see.
    """
    return part(model.structure.model, "build")(model, folder, case_text=case_text, case_hash=case_hash)
