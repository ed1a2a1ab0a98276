"""What a process of the product's own leaves out: searches for garbage, and imports that no command needs."""

from __future__ import annotations

import gc
import sys

_CHUNKED = "dask"


def be_frugal() -> None:
    """Look for garbage less often, and keep xarray from importing dask to look for arrays that no command makes.

    Imports and the compiler make a million objects that live on, a search among which costs a tenth of a start; dask,
    where it is installed, costs half a second of every process.
    """
    gc.set_threshold(100_000, 50, 50)
    sys.modules.setdefault(_CHUNKED, None)  # type: ignore[arg-type]


def allow_dask() -> None:
    """Let dask be imported again, for a study on a cluster."""
    if sys.modules.get(_CHUNKED, sys) is None:
        del sys.modules[_CHUNKED]
