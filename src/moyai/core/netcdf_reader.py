"""Read a tree of datasets that :mod:`~moyai.core.netcdf_writer` wrote straight through HDF5, as xarray reads it.

A result has hundreds of small variables; h5netcdf looks every one of them up dozens of times. Here each is opened once,
and xarray decodes it.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5py
import numpy as np

from moyai.core.foreign_files import open_hdf5, require_plausible_size
from moyai.core.netcdf_writer import NO_VARIABLE

if TYPE_CHECKING:
    import xarray as xr

#: What the format keeps next to the attributes of a variable.
_OWN = frozenset(
    ("CLASS", "NAME", "DIMENSION_LIST", "REFERENCE_LIST", "_Netcdf4Dimid", "_Netcdf4Coordinates", "_NCProperties")
)


def read_tree(path: Path, *, named: str = "file") -> xr.DataTree:
    """Return the tree of a file of :func:`~moyai.core.netcdf_writer.write_tree`, in memory.

    Parameters
    ----------
    path : Path
    named : str
        Entry or argument that names the file.

    Raises
    ------
    InputError
        When a group states more than a file of its length can hold.
    LookupError, OSError, TypeError, ValueError
        When the file was written by something else, or is damaged.
    """
    import xarray as xr

    groups: dict[str, xr.Dataset] = {}
    with open_hdf5(path) as file:
        names: dict[int, str] = {}

        def visit(place: str, group: h5py.Group) -> None:
            items = {name: group[name] for name in group}
            held = {name: item for name, item in items.items() if isinstance(item, h5py.Dataset)}
            claimed = sum(item.size * item.dtype.itemsize for item in held.values())
            require_plausible_size(path, claimed, f"group '{place}'", named=named)
            kept = {name: _attributes(item) for name, item in held.items()}
            names.update(
                (int(own["_Netcdf4Dimid"]), name) for name, own in kept.items() if own.get("CLASS") == "DIMENSION_SCALE"
            )
            variables = {
                name: _variable(item, kept[name], names)
                for name, item in held.items()
                if not str(kept[name].get("NAME", "")).startswith(NO_VARIABLE)
            }
            groups[place] = xr.decode_cf(xr.Dataset(variables, attrs=_without_own(_attributes(group))))
            for name, item in items.items():
                if isinstance(item, h5py.Group):
                    visit(f"{place.rstrip('/')}/{name}", item)

        visit("/", file)
    return xr.DataTree.from_dict(groups)


def _attributes(item: Any) -> dict[str, Any]:
    """Return the attributes of a group or dataset without its references; a list of one is a single value."""
    found = {}
    for name, value in item.attrs.items():
        if name not in ("DIMENSION_LIST", "REFERENCE_LIST"):
            single = isinstance(value, np.ndarray) and value.shape == (1,)
            value = value[0] if single else value
            found[name] = value.decode() if isinstance(value, bytes) else value
    return found


def _without_own(attributes: dict[str, Any]) -> dict[str, Any]:
    return {
        name: list(value) if isinstance(value, np.ndarray) and value.dtype.kind == "O" else value
        for name, value in attributes.items()
        if name not in _OWN
    }


def _variable(item: h5py.Dataset, attributes: dict[str, Any], names: dict[int, str]) -> xr.Variable:
    import xarray as xr

    if not item.shape:
        dims: tuple[str, ...] = ()
    else:
        dims = tuple(names[int(number)] for number in np.atleast_1d(attributes["_Netcdf4Coordinates"]))
    values = np.asarray(item.asstr()[()], dtype=str) if h5py.check_string_dtype(item.dtype) else item[()]
    return xr.Variable(dims, values, _without_own(attributes))


__all__ = ["read_tree"]
