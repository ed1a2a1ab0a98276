"""The border to files that others wrote: whatever a reader raises becomes one error with the file and its kind.

Libraries that read MATLAB, HDF5, NetCDF and Parquet files raise errors of every class on a damaged file, and take the
sizes that it states on trust. A reader here carries :func:`reads`, and asks :func:`require_plausible_size` before it
takes an array that the file only claims to hold.
"""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeVar, cast

from moyai.core.errors import InputError, MoyaiError
from moyai.core.hdf5_heaps import stuck_heap

if TYPE_CHECKING:
    import h5py
    import xarray as xr

LARGEST_COMPRESSION = 1100.0
"""Bytes in memory for a byte of the file: deflate reaches 1032 to 1 at most."""

ALWAYS_FITS = 64_000_000
"""Bytes that are taken without a question: a file of fill values may hold none of them."""

REMEDY = "the file is damaged, incomplete or of another kind: compare it with its original"

Reader = TypeVar("Reader", bound=Callable[..., Any])


@contextmanager
def reading(path: Path, kind: str, *, named: str = "file") -> Iterator[None]:
    """Turn every error of the block into one that names the file and its kind.

    Parameters
    ----------
    path : Path
        File that is read.
    kind : str
        What it is read as, for instance ``a MATLAB file``.
    named : str
        Entry or argument that names the file.

    Raises
    ------
    InputError
        In place of everything but errors raised on purpose.
    """
    try:
        yield
    except MoyaiError:
        raise
    except MemoryError:
        raise InputError(
            f"{path.name} cannot be read as {kind}: it states sizes that the memory does not hold",
            path=named,
            remedy=REMEDY,
        ) from None
    except OSError as error:
        words = error.strerror or _first_line(error)
        raise InputError(f"{path.name} cannot be read as {kind}: {words}", path=named, remedy=REMEDY) from error
    except Exception as error:
        words = f"{type(error).__name__}, {_first_line(error)}".rstrip(", ")
        raise InputError(f"{path.name} cannot be read as {kind}: {words}", path=named, remedy=REMEDY) from error


def reads(kind: str, *, named: str = "file") -> Callable[[Reader], Reader]:
    """Return a decorator for readers, functions or generators, whose first argument is the file.

    Parameters
    ----------
    kind, named : str
        See :func:`reading`.
    """

    def decorate(reader: Reader) -> Reader:
        signature = inspect.signature(reader)

        def place(arguments: tuple[Any, ...], options: dict[str, Any]) -> Path:
            try:
                bound = signature.bind(*arguments, **options)
            except TypeError:
                # Arguments that do not fit are a fault of the call, not of the file; Python words it
                reader(*arguments, **options)
                raise
            return Path(next(iter(bound.arguments.values())))

        if inspect.isgeneratorfunction(reader):

            @functools.wraps(reader)
            def generate(*arguments: Any, **options: Any) -> Iterator[Any]:
                with reading(place(arguments, options), kind, named=named):
                    yield from reader(*arguments, **options)

            return cast(Reader, generate)

        @functools.wraps(reader)
        def read(*arguments: Any, **options: Any) -> Any:
            file = place(arguments, options)
            with reading(file, kind, named=named):
                return reader(*arguments, **options)

        return cast(Reader, read)

    return decorate


def require_plausible_size(path: Path, claimed: float, what: str, *, named: str = "file") -> None:
    """Refuse an array that a file of this length cannot hold, before memory is taken for it.

    Parameters
    ----------
    path : Path
        File.
    claimed : float
        Bytes that the array would take.
    what : str
        Name of the array.
    named : str
        Entry or argument that names the file.

    Raises
    ------
    InputError
        With what is claimed and what the file has.
    """
    size = path.stat().st_size
    if claimed > max(ALWAYS_FITS, LARGEST_COMPRESSION * size):
        raise InputError(
            f"{path.name} states {claimed / 1e6:,.0f} MB of {what} and is {size / 1e6:.3g} MB long",
            path=named,
            allowed=f"at most {LARGEST_COMPRESSION:g} times its length, the most that compression reaches",
            remedy=REMEDY,
        )


def open_netcdf(path: Path, kind: str, *, named: str = "file", **options: Any) -> xr.Dataset:
    """Open a NetCDF file of either form, its container and the sizes of its variables checked.

    Parameters
    ----------
    path : Path
        NetCDF 3 or 4.
    kind, named : str
        See :func:`reading`.
    **options
        Of ``xarray.open_dataset``.

    Returns
    -------
    xarray.Dataset
        Not loaded; the caller closes it.

    Raises
    ------
    InputError
        When it is no NetCDF file, damaged, or states more than it can hold.
    """
    import xarray as xr

    with reading(path, kind, named=named):
        engine = netcdf_engine(path, kind, named=named)
        if engine == "h5netcdf":
            options["phony_dims"] = "access"
        dataset = xr.open_dataset(path, engine=engine, **options)
        for name, variable in dataset.variables.items():
            require_plausible_size(path, variable.nbytes, f"'{name}'", named=named)
        return dataset


def netcdf_engine(path: Path, kind: str, *, named: str = "file") -> Literal["h5netcdf", "scipy"]:
    """Return xarray's engine for a file by its first bytes, its container opened once.

    Raises
    ------
    InputError
        When neither form of NetCDF begins so, or the HDF5 library cannot open the file.
    """
    with reading(path, kind, named=named):
        with path.open("rb") as stream:
            head = stream.read(8)
        if head[:3] == b"CDF":
            return "scipy"
        # The HDF5 library speaks first: xarray's engine leaves a half-made object that complains when it is collected
        with open_hdf5(path) as stored:
            stored.attrs.get("_nc3_strict")
        return "h5netcdf"


@contextmanager
def open_hdf5(path: Path) -> Iterator[h5py.File]:
    """Open an HDF5 file to be read, after a look for what the library would not come back from.

    Raises
    ------
    OSError
        When it is no HDF5 file or damaged; :func:`reading` words it.
    """
    import h5py

    heap = stuck_heap(path) if path.stat().st_size else -1
    if heap >= 0:
        raise OSError(f"the heap at byte {heap} holds an object of an impossible size")
    with h5py.File(path, "r") as stored:
        yield stored


def _first_line(error: BaseException) -> str:
    lines = str(error).strip().splitlines()
    return lines[0][:160] if lines else ""
