"""Keeps xarray from importing dask, where it is installed, to look for arrays of it: half a second of every process."""

from __future__ import annotations

import contextlib
import sys
from functools import cache
from typing import Any


@cache
def look_for_imported_dask() -> None:
    """Let xarray take an array for one of dask's only where dask has been imported: no other can be one.

    Where xarray keeps its modules in another way than it does today it continues by itself.
    """
    from xarray.namedarray import pycompat

    absent = pycompat.DuckArrayModule("moyai.no_module")  # type: ignore[arg-type]

    class OnceImported(pycompat.DuckArrayModule):
        def __init__(self) -> None:
            """Import nothing."""

        def __getattr__(self, name: str) -> Any:
            return getattr(pycompat.DuckArrayModule("dask") if "dask.array" in sys.modules else absent, name)

    with contextlib.suppress(AttributeError):
        pycompat._cached_duck_array_modules.setdefault("dask", OnceImported())
