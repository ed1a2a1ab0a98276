"""Units and long names on the variables of a result."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import xarray as xr


def with_labels(dataset: xr.Dataset, variables: Mapping[str, tuple[str, str]]) -> xr.Dataset:
    """Return the dataset with ``units`` and ``long_name`` on every variable that a room owns.

    Parameters
    ----------
    dataset : xarray.Dataset
    variables : mapping
        Unit and long name by the name of the variable; attributes that a variable has already stay.
    """
    out = dataset.copy()
    for name in list(out.variables):
        entry = variables.get(str(name))
        if entry is not None:
            out[name].attrs = {"units": entry[0], "long_name": entry[1], **out[name].attrs}
    return out
