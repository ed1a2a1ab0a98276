"""Datasets that took long to compute, kept on disk under a key of everything that they depend on."""

from __future__ import annotations

import hashlib
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.errors import InputError
from moyai.core.files import partial_file
from moyai.core.results import join_complex, split_complex

if TYPE_CHECKING:
    import xarray as xr


def key_of(*parts: object) -> str:
    """Return a key of arrays, numbers and words: equal inputs, equal key, to the last bit.

    Parameters
    ----------
    *parts : ndarray, number, str or None
        Everything that the dataset depends on, versions included.
    """
    digest = hashlib.sha256()
    for part in parts:
        if isinstance(part, np.ndarray):
            digest.update(f"{part.dtype}{part.shape}".encode())
            digest.update(np.ascontiguousarray(part).tobytes())
        else:
            digest.update(repr(part).encode())
        digest.update(b"|")
    return digest.hexdigest()[:24]


@dataclass(frozen=True)
class DatasetStore:
    """A folder of datasets by key."""

    #: Made when the first dataset is put in.
    directory: Path

    def get(self, key: str) -> xr.Dataset | None:
        """Return the dataset of a key, ``None`` when it is not there or cannot be read."""
        import xarray as xr

        path = self.directory / f"{key}.nc"
        if not path.exists():
            return None
        try:
            with xr.open_dataset(path, engine="h5netcdf") as stored:
                return join_complex(stored.load())
        except (OSError, ValueError, KeyError):
            # A damaged file is as good as none: it is computed again and replaced
            return None

    def put(self, key: str, dataset: xr.Dataset) -> None:
        """Keep a dataset; a folder that cannot be written keeps nothing and harms nothing."""
        import xarray as xr

        from moyai.core.netcdf_writer import can_write, write_tree

        tree = xr.DataTree(split_complex(dataset))
        with suppress(InputError), partial_file(self.directory / f"{key}.nc", size=dataset.nbytes) as partial:
            if can_write(tree):
                write_tree(tree, partial)
            else:
                tree.to_netcdf(partial, engine="h5netcdf")
