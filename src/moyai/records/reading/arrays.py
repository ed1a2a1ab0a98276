"""Read columns of MATLAB, NetCDF and Parquet files by the chunk."""

from __future__ import annotations

import difflib
import functools
import math
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.errors import InputError
from moyai.core.foreign_files import open_hdf5, open_netcdf, reads, require_plausible_size
from moyai.records.reading.matlab_elements import check_elements
from moyai.records.reading.text import RawChunk, plain_name, split_heading

_ENTRY = re.compile(r"^(?P<name>.*?)\s*\[(?P<index>\s*-?\d+\s*(,\s*-?\d+\s*)*)\]\s*$")


def _missing(kind: str, file: Path, column: str, names: Sequence[str]) -> InputError:
    near = difflib.get_close_matches(column, names, n=1, cutoff=0.6)
    return InputError(
        f"{file.name} has no {kind} '{column}'",
        parameter="column",
        allowed=", ".join(names),
        remedy=f"did you mean '{near[0]}'?" if near else "",
    )


def _entry(column: str) -> tuple[str, tuple[int, ...]]:
    """Return ``vel[0,3]`` as ``("vel", (0, 3))``."""
    match = _ENTRY.match(column)
    if match is None:
        return column, ()
    return match["name"], tuple(int(part) for part in match["index"].split(","))


# ---------------------------------------------------------------------------------------------------- NetCDF


def _netcdf(path: Path) -> Any:
    return open_netcdf(path, "a NetCDF file", decode_times=False, cache=False)


@reads("a NetCDF file")
def read_netcdf(path: Path, wanted: Sequence[str], rows: int) -> Iterator[RawChunk]:
    """Yield chunks of NetCDF variables, with fill value, scale and offset applied.

    Time with CF units (``seconds since ...``) comes as seconds since 1970 UTC.
    """
    with _netcdf(path) as dataset:
        dimension, size = _time_dimension(dataset, path, wanted)
        for first in range(0, size, rows):
            window = slice(first, min(first + rows, size))
            columns: dict[str | int, NDArray[Any]] = {}
            for column in wanted:
                name, index = _entry(column)
                variable = dataset.variables[name]
                others = [other for other in variable.dims if other != dimension]
                if len(others) != len(index):
                    shape = ", ".join(f"{other}: {dataset.sizes[other]}" for other in others)
                    raise InputError(
                        f"{path.name}: '{name}' has the further dimensions {shape or 'none'}",
                        parameter="column",
                        remedy=f"write {name}[{', '.join('0' for _ in others)}]" if others else f"write {name}",
                    )
                for other, place in zip(others, index):
                    if not -dataset.sizes[other] <= place < dataset.sizes[other]:
                        raise InputError(
                            f"{path.name}: '{name}' has no entry {place} along {other}",
                            parameter="column",
                            allowed=f"0 to {dataset.sizes[other] - 1}",
                        )
                chosen = variable.isel({dimension: window, **dict(zip(others, index))})
                columns[column] = _epoch(np.asarray(chosen.values, dtype=np.float64), variable.attrs.get("units", ""))
            yield RawChunk(columns, first)


def _time_dimension(dataset: Any, path: Path, wanted: Sequence[str]) -> tuple[str, int]:
    names = [str(name) for name in dataset.variables]
    for column in wanted:
        if _entry(column)[0] not in dataset.variables:
            raise _missing("variable", path, _entry(column)[0], names)
    shared = set.intersection(*(set(dataset.variables[_entry(column)[0]].dims) for column in wanted))
    if not shared:
        raise InputError(f"{path.name}: the variables {', '.join(wanted)} share no dimension", parameter="column")
    order = [name for name in ("time", "t") if name in shared]
    dimension = order[0] if order else max(shared, key=lambda name: dataset.sizes[name])
    size = int(dataset.sizes[dimension])
    if size == 0:
        raise InputError(f"{path.name} has no samples", parameter="file")
    return str(dimension), size


def _epoch(values: NDArray[np.float64], units: str) -> NDArray[np.float64]:
    """Return CF time in seconds since 1970, other values unchanged."""
    match = re.match(r"^\s*(\w+)\s+since\s+(.+?)\s*$", units)
    if match is None:
        return values
    factors = {"day": 86400.0, "hour": 3600.0, "hr": 3600.0, "h": 3600.0, "minute": 60.0, "min": 60.0,
               "second": 1.0, "sec": 1.0, "s": 1.0, "millisecond": 1e-3, "ms": 1e-3, "microsecond": 1e-6,
               "nanosecond": 1e-9, "d": 86400.0}  # fmt: skip
    unit = match[1].lower()
    factor = factors.get(unit, factors.get(unit.rstrip("s")))
    start = _reference(match[2])
    if factor is None or start is None:
        raise InputError(
            f"the time unit '{units}' is not understood", parameter="time", allowed="seconds since 1970-01-01"
        )
    return values * factor + start


_REFERENCE = re.compile(
    r"^(\d{1,4})-(\d{1,2})-(\d{1,2})(?:[T\s]+(\d{1,2})(?::(\d{1,2}))?(?::(\d{1,2}(?:\.\d*)?))?)?"
    r"\s*(?:UTC|GMT|Z|([+-])(\d{1,2}):?(\d{2})?)?$"
)


def _reference(text: str) -> float | None:
    """Return the reference of a CF time in seconds since 1970; figures need no leading zeros there."""
    from datetime import UTC, datetime

    match = _REFERENCE.match(text.strip())
    if match is None:
        return None
    hours, minutes, seconds = int(match[4] or 0), int(match[5] or 0), float(match[6] or 0.0)
    try:
        day = datetime(int(match[1]), int(match[2]), int(match[3]), tzinfo=UTC)
    except ValueError:
        return None
    offset = 3600.0 * int(match[8] or 0) + 60.0 * int(match[9] or 0)
    zone = -offset if match[7] == "-" else offset
    return day.timestamp() + 3600.0 * hours + 60.0 * minutes + seconds - zone


@reads("a NetCDF file")
def netcdf_units(path: Path, columns: Sequence[str]) -> list[str]:
    """Return the unit attributes of variables, empty where there is none."""
    with _netcdf(path) as dataset:
        held, names = dataset.variables, [_entry(column)[0] for column in columns]
        return [str(held[name].attrs.get("units", "")) if name in held else "" for name in names]


# --------------------------------------------------------------------------------------------------- Parquet


def _parquet(path: Path) -> Any:
    try:
        import pyarrow.parquet as parquet
    except ImportError:
        raise InputError(
            f"{path.name}: reading Parquet needs pyarrow", parameter="file", remedy="pip install 'moyai[parquet]'"
        ) from None
    file = parquet.ParquetFile(path, pre_buffer=False, buffer_size=1 << 20)
    require_plausible_size(path, _parquet_bytes(file.metadata), "columns")
    return file


def _parquet_bytes(stated: Any) -> int:
    """Return the bytes of the largest group of rows, the part that is taken into memory at a time."""
    return max((stated.row_group(place).total_byte_size for place in range(stated.num_row_groups)), default=0)


@reads("a Parquet file")
def read_parquet(path: Path, wanted: Sequence[str], rows: int) -> Iterator[RawChunk]:
    """Yield chunks of Parquet columns; stamps come as seconds since 1970, in UTC where they know their zone."""
    import pyarrow as pa

    file = _parquet(path)
    names = file.schema_arrow.names
    real = {column: _parquet_name(path, column, names) for column in wanted}
    first = 0
    for batch in file.iter_batches(batch_size=rows, columns=list(dict.fromkeys(real.values())), use_threads=False):
        columns: dict[str | int, NDArray[Any]] = {}
        for column in wanted:
            array = batch.column(batch.schema.get_field_index(real[column]))
            kind = array.type
            if pa.types.is_timestamp(kind):
                whole = array.cast(pa.int64())
                scale = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}[kind.unit]
                columns[column] = whole.to_numpy(zero_copy_only=False).astype(np.float64) * scale
            elif pa.types.is_integer(kind) or pa.types.is_floating(kind) or pa.types.is_boolean(kind):
                columns[column] = array.to_numpy(zero_copy_only=False).astype(np.float64, copy=False)
            elif pa.types.is_decimal(kind):
                columns[column] = array.cast(pa.float64()).to_numpy(zero_copy_only=False)
            else:
                raise InputError(
                    f"{path.name}, column '{real[column]}' holds {kind}, not numbers", parameter=str(column)
                )
        yield RawChunk(columns, first)
        first += batch.num_rows
    if first == 0:
        raise InputError(f"{path.name} has no samples", parameter="file")


def _parquet_name(path: Path, column: str, names: Sequence[str]) -> str:
    for candidates in ([plain_name(name) for name in names], [split_heading(name)[0] for name in names]):
        if plain_name(column) in candidates:
            return names[candidates.index(plain_name(column))]
    raise _missing("column", path, column, names)


@reads("a Parquet file")
def parquet_unit(path: Path, column: str) -> str:
    """Return the unit that a column states in its name or metadata, empty where it states none."""
    file = _parquet(path)
    names = file.schema_arrow.names
    name = _parquet_name(path, column, names)
    stored = file.schema_arrow.field(name).metadata or {}
    for key in (b"units", b"unit"):
        if key in stored:
            return str(stored[key].decode("utf-8", "replace"))
    return split_heading(name)[1]


@reads("a Parquet file")
def parquet_stamps(path: Path, column: str) -> tuple[bool, str]:
    """Return whether a Parquet column holds time stamps, and the time zone they know (then stored in UTC)."""
    import pyarrow as pa

    schema = _parquet(path).schema_arrow
    kind = schema.field(_parquet_name(path, column, schema.names)).type
    return (True, str(kind.tz or "")) if pa.types.is_timestamp(kind) else (False, "")


# --------------------------------------------------------------------------------------------------- MATLAB


@reads("a MATLAB file")
def read_mat(path: Path, wanted: Sequence[str], rows: int) -> Iterator[RawChunk]:
    """Yield chunks of MATLAB variables (all versions); ``data[2]`` is the third column of a matrix, ``s.x`` a field."""
    arrays = {column: _mat_column(path, column) for column in wanted}
    sizes = {column: array.size for column, array in arrays.items()}
    if len(set(sizes.values())) > 1:
        reported = ", ".join(f"{column} {size}" for column, size in sizes.items())
        raise InputError(f"{path.name}: the variables have different lengths: {reported}", parameter="column")
    size = next(iter(sizes.values()))
    if size == 0:
        raise InputError(f"{path.name} has no samples", parameter="file")
    for first in range(0, size, rows):
        yield RawChunk({column: array[first : first + rows] for column, array in arrays.items()}, first)


@reads("a MATLAB file")
def check_mat(path: Path, column: str) -> None:
    """Say what is wrong where a MATLAB file has no such column of numbers."""
    _mat_column(path, column)


def _mat_column(path: Path, column: str) -> NDArray[np.float64]:
    name, index = _entry(column)
    array = np.asarray(_mat_variable(path, name))
    if array.dtype == object or array.dtype.kind not in "fiub":
        raise InputError(f"{path.name}: '{name}' holds no numbers", parameter="column")
    array = np.squeeze(array)
    if array.ndim == 2 and len(index) == 1:
        # Records stand in columns, unless the matrix is wider than tall
        array = array if array.shape[0] >= array.shape[1] else array.T
        if not -array.shape[1] <= index[0] < array.shape[1]:
            raise InputError(f"{path.name}: '{name}' has no column {index[0]}", parameter="column",
                             allowed=f"0 to {array.shape[1] - 1}")  # fmt: skip
        array = array[:, index[0]]
    if array.ndim == 0:
        array = array[None]
    if array.ndim != 1:
        raise InputError(
            f"{path.name}: '{name}' has the shape {array.shape}",
            parameter="column",
            remedy=f"write {name}[0] for a column",
        )
    return np.ascontiguousarray(array, dtype=np.float64)


@functools.lru_cache(maxsize=8)
def _check_once(path: Path, size: int, changed: int) -> None:
    """Walk through a file once for all its columns, as long as it stays as it is."""
    check_elements(path)


def _mat_variable(path: Path, name: str) -> Any:
    from scipy.io import loadmat, whosmat

    parts = name.split(".")
    _check_once(path, path.stat().st_size, path.stat().st_mtime_ns)
    try:
        held = {str(entry[0]): entry[1] for entry in whosmat(path)}
    except NotImplementedError:
        return _mat_hdf5(path, parts)
    if parts[0] not in held:
        raise _missing("variable", path, parts[0], list(held))
    # At least a byte an entry is stored, before compression
    require_plausible_size(path, math.prod(map(float, held[parts[0]])), f"'{parts[0]}'")
    found: Any = loadmat(path, variable_names=[parts[0]], squeeze_me=True, struct_as_record=False)[parts[0]]
    for part in parts[1:]:
        fields = getattr(found, "_fieldnames", [])
        if part not in fields:
            raise _missing("field", path, part, fields)
        found = getattr(found, part)
    return found


def _mat_hdf5(path: Path, parts: Sequence[str]) -> Any:
    """Read a variable of a version 7.3 file, which is HDF5 with its axes reversed."""
    import h5py

    with open_hdf5(path) as file:
        node: Any = file
        for part in parts:
            if not isinstance(node, h5py.Group) or part not in node:
                raise _missing("variable", path, part, [key for key in node if not str(key).startswith("#")])
            node = node[part]
        if not isinstance(node, h5py.Dataset):
            raise InputError(
                f"{path.name}: '{'.'.join(parts)}' is a structure", parameter="column", remedy="name a field"
            )
        require_plausible_size(path, node.nbytes, f"'{'.'.join(parts)}'")
        return np.asarray(node[()]).T
