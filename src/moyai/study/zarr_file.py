"""Results of a study as zarr: a folder of chunks that a cluster or a cloud store reads in parallel."""

from __future__ import annotations

import json
import os
import shutil
from pathlib import Path
from typing import TYPE_CHECKING

from moyai.core.errors import InputError
from moyai.core.results import Result, split_complex

if TYPE_CHECKING:
    import xarray as xr


def require_zarr() -> None:
    """Require the library zarr.

    Raises
    ------
    InputError
        With the extra to install.
    """
    try:
        import zarr  # noqa: F401
    except ImportError:
        raise InputError("zarr is not installed", path="--zarr", remedy='pip install "moyai[zarr]"') from None


def write_zarr(result: Result, path: Path) -> Path:
    """Write a result as a zarr store; the one that stood there before is replaced when the new one is complete.

    Parameters
    ----------
    result : Result
    path : Path

    Raises
    ------
    InputError
        When zarr is absent, or the folder cannot be written.
    """
    import warnings

    import xarray as xr

    require_zarr()
    groups = {}
    for node in result.tree.subtree:
        held = split_complex(node.to_dataset(inherit=False))
        for name in (*held.data_vars, *held.coords):
            if held[name].dtype.kind == "O":
                held[name] = held[name].astype(str)
        groups[node.path] = held
    groups["/"].attrs.update(
        {
            "status": result.status,
            "message": result.message,
            "checks": json.dumps([check.as_dict() for check in result.checks]),
            "notices": json.dumps([notice.as_dict() for notice in result.notices]),
            "provenance": json.dumps(dict(result.provenance), default=str),
        }
    )
    partial = path.with_name(path.name + ".partial")
    try:
        shutil.rmtree(partial, ignore_errors=True)
        with warnings.catch_warnings():
            # Text of fixed length has no specification in zarr 3 yet, and is read back as it was
            warnings.simplefilter("ignore")
            xr.DataTree.from_dict(groups).to_zarr(partial, mode="w")
        shutil.rmtree(path, ignore_errors=True)
        os.replace(partial, path)
    except OSError as error:
        shutil.rmtree(partial, ignore_errors=True)
        raise InputError(f"cannot write {path}: {error.strerror or error}", path="output") from error
    return path


def read_zarr(path: Path) -> xr.DataTree:
    """Return the groups of a zarr store written by :func:`write_zarr`.

    Raises
    ------
    InputError
        When zarr is absent, or there is no such store.
    """
    import warnings

    import xarray as xr

    require_zarr()
    if not (path / "zarr.json").exists() and not (path / ".zgroup").exists():
        raise InputError(f"{path} is no zarr store", path="results")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return xr.open_datatree(path, engine="zarr").load()
    except (OSError, ValueError, KeyError) as error:
        raise InputError(f"{path} cannot be read: {error}", path="results") from error
