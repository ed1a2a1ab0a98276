"""Capytaine's integrals of 1/r over panels."""

from __future__ import annotations

import logging
from functools import lru_cache
from typing import Any

from moyai.core.errors import InputError


@lru_cache(maxsize=1)
def green_function() -> Any:
    """Return Capytaine's Green function, of which the integrals of 1/r over panels are taken.

    Raises
    ------
    InputError
        When Capytaine 3 is not installed.
    """
    logging.getLogger("capytaine").setLevel(logging.ERROR)
    try:
        from capytaine.green_functions.delhommeau import Delhommeau
    except ImportError as error:
        raise InputError(
            "a row of units needs Capytaine 3, which is not installed",
            parameter="kind",
            remedy='pip install "moyai[bem3d]"',
        ) from error
    return Delhommeau()
