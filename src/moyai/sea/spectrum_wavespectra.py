"""Spectra of further programs and buoys, read by the library wavespectra (extra ``wavespectra``).

SWAN, WAVEWATCH III and NDBC have readers of their own in :mod:`moyai.sea.spectrum_archives`; this module is asked for
whatever else there is: TRIAXYS, Spotter, Datawell, AWAC, Octopus, ERA5, WWM, FUNWAVE, XWaves, Obscape.
"""

from __future__ import annotations

import math
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from moyai.core.errors import InputError
from moyai.sea.direction_widths import direction_widths
from moyai.sea.spectrum_archive import SpectrumArchive, mean_direction

_TEXT = ("octopus", "awac", "funwave", "obscape", "xwaves", "datawell", "triaxys", "spotter", "json")
#: Variables of NetCDF files of other programs, and the reader of each. Readers of wavespectra take each other's files
#: without an error, with wrong units.
NETCDF_KINDS = {"d2fd": "era5", "density": "ncswan", "AC": "wwm"}


def kind_of(path: str | Path) -> str:
    """Return the reader of wavespectra that a file is surely for, empty where its beginning does not show it.

    Parameters
    ----------
    path : path-like
    """
    file = Path(path)
    try:
        head = file.read_bytes()[:4000].lstrip()
    except OSError:
        return ""
    if head.startswith(b"TRIAXYS"):
        return "triaxys"
    if file.suffix.lower() == ".spt":
        return "datawell"
    if head.startswith(b"{") and b"spotter" in head.lower():
        return "spotter"
    return ""


def read_with_wavespectra(path: str | Path, kind: str = "") -> SpectrumArchive:
    """Read a file of spectra with wavespectra.

    Parameters
    ----------
    path : path-like
    kind : str
        Reader of wavespectra, where the file gives it; found from its beginning when empty, else tried in turn.

    Returns
    -------
    SpectrumArchive
        Its ``format`` is the name of the reader.

    Raises
    ------
    InputError
        When wavespectra is absent, or none of its readers makes sense of the file.
    """
    file = Path(path)
    kind = kind or kind_of(file)
    try:
        import wavespectra
    except ImportError:
        what = f"{file.name} is a file of the kind '{kind}'; reading it" if kind else f"reading {file.name}"
        raise InputError(
            f"{what} needs the library wavespectra",
            parameter="file",
            allowed="SWAN, WAVEWATCH III and NDBC without it",
            remedy='pip install "moyai[wavespectra]"',
        ) from None
    refused = ""
    for name in (kind,) if kind else _TEXT:
        reader = getattr(wavespectra, f"read_{name}", None)
        if reader is None:
            continue
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                archive = archive_of(reader(str(file)), name)
        except Exception as error:
            # Readers of other kinds fail on a file in every way there is
            refused = refused or f"{name}: {type(error).__name__}: {error}"
            continue
        return archive
    reported = f" ({refused[:160]})" if kind else f" (tried {', '.join(_TEXT)})"
    raise InputError(f"wavespectra finds no spectra in {file.name}{reported}", parameter="file")


def archive_of(data: Any, name: str) -> SpectrumArchive:
    """Return a dataset in the form of wavespectra as an archive.

    Raises
    ------
    InputError
        Where it holds no sensible spectra.
    """

    spread = data["efth"]
    turned = "dir" in spread.dims and spread.sizes["dir"] > 1
    if "dir" in spread.dims and not turned:
        spread = spread.isel(dir=0, drop=True)
    if "time" not in spread.dims:
        spread = spread.expand_dims("time")
    tail = ("freq", "dir") if turned else ("freq",)
    apart = [str(dim) for dim in spread.dims if dim not in ("time", *tail)]
    spread = spread.transpose("time", *apart, *tail)
    frequency = np.asarray(data["freq"].values, dtype=float)
    table = np.asarray(spread.values, dtype=float)
    table = table.reshape(table.shape[0], -1, *table.shape[1 + len(apart) :])
    rising = np.argsort(frequency)
    frequency, table = frequency[rising], np.take(table, rising, axis=2)
    known = table[np.isfinite(table)]
    if frequency.size < 2 or np.any(np.diff(frequency) <= 0.0) or not known.any() or np.any(known < 0.0):
        raise InputError("no rising frequencies with densities of 0 or more", parameter="file")
    mean = np.full(table.shape[:2], math.nan)
    if turned:
        directions = np.asarray(data["dir"].values, dtype=float)
        # A circle that is closed twice (0 and 360 degrees) counts once
        _, once = np.unique(np.mod(directions, 360.0), return_index=True)
        widths = direction_widths(directions[once])
        whole = np.nan_to_num(table[..., once]) * widths
        for place in np.ndindex(*mean.shape):
            mean[place] = mean_direction(whole[place], directions[once], frequency)
        if "rad" in str(spread.attrs.get("units", "")):
            whole = np.radians(whole)
        density = np.where(np.isfinite(table).any(axis=-1), whole.sum(axis=-1), math.nan)
        by_direction = {"directions": directions[once], "energy": whole}
    else:
        density, by_direction = table, {}
    if "time" in spread.coords:
        times = tuple(str(value)[:16] for value in spread["time"].values)
    else:
        times = ("stationary",)
    return SpectrumArchive(name, times, _places(spread, apart), frequency, density, mean, **by_direction)


def _places(spread: Any, apart: list[str]) -> tuple[str, ...]:
    sizes = [spread.sizes[dim] for dim in apart]
    words = []
    for place in np.ndindex(*sizes):
        parts = [f"{dim} {spread[dim].values[at] if dim in spread.coords else at}" for dim, at in zip(apart, place)]
        words.append(", ".join(parts) or "point")
    return tuple(words)
