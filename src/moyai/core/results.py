"""The result of a run: labelled data, status, identity checks, validity notices and provenance in one file."""

from __future__ import annotations

import json
import math
import os
import platform
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from datetime import UTC, datetime
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, Self

import numpy as np

from moyai.core.errors import InputError, MoyaiError
from moyai.core.files import partial_file
from moyai.core.foreign_files import netcdf_engine, reads, require_plausible_size
from moyai.core.groups import Groups
from moyai.core.headline import Headline, Verdict, without_computation
from moyai.core.options import checks_words
from moyai.core.validity import IdentityCheck, Notice
from moyai.core.version import VERSION

if TYPE_CHECKING:
    import xarray as xr

Status = Literal["converged", "outside_validity", "not_converged", "interrupted", "failed"]

TIME_CONVENTION = "Re(X exp(-i omega t))"
RESULT_FILES = ("results.nc", "study.nc", "fit.nc")
"""Names that the commands give to results; the first there is is taken from a folder."""
DIRECTION_CONVENTION = "heading 0 travels towards +x, 90 degrees towards +y; x, y, z right-handed, z up"


@checks_words
@dataclass(frozen=True)
class Result:
    """What a run hands back and what the file on disk holds."""

    #: Groups of labelled data; every variable carries ``units`` and ``long_name``. Of a run it is made when asked for.
    tree: xr.DataTree
    #: ``converged``, ``outside_validity``, ``not_converged``, ``interrupted`` or ``failed``.
    status: Status = "converged"
    #: One sentence behind the status.
    message: str = ""
    #: Identities of the run with their figures.
    checks: tuple[IdentityCheck, ...] = ()
    #: Validity notices.
    notices: tuple[Notice, ...] = ()
    #: Version, inputs, conventions, seed, time of the run.
    provenance: Mapping[str, Any] = field(default_factory=dict)
    #: The numbers of the first page, the governing one first.
    headlines: tuple[Headline, ...] = ()
    #: Whether the design keeps its criteria; apart from ``status``, which is for the computation.
    verdict: Verdict = field(default_factory=Verdict)

    def __post_init__(self) -> None:
        if isinstance(self.tree, Groups):
            object.__setattr__(self, "_groups", self.tree)
            object.__delattr__(self, "tree")

    def __getattr__(self, name: str) -> Any:
        if name != "tree" or "_groups" not in self.__dict__:
            raise AttributeError(f"a result has no attribute '{name}'")
        object.__setattr__(self, "tree", self.__dict__["_groups"].tree())
        return self.tree

    @property
    def held(self) -> Any:
        """The tree, or groups that are read like it as long as nobody asked for the tree."""
        return self.__dict__["tree"] if "tree" in self.__dict__ else self.__dict__["_groups"]

    def changed(self, **changes: Any) -> Self:
        """Return the result with other fields.

        Parameters
        ----------
        **changes : Any
            By the name of the field.
        """
        return replace(self, **{"tree": self.held, **changes})

    def with_notices(self, *notices: Notice) -> Result:
        """Return the same result with further notices; an ``error`` among them lowers the status.

        Parameters
        ----------
        *notices : Notice
            Added after those of the result.
        """
        status = self.status
        if status == "converged" and any(notice.severity == "error" for notice in notices):
            status = "outside_validity"
        verdict = self.verdict if status == self.status else without_computation(self.verdict)
        return self.changed(notices=(*self.notices, *notices), status=status, verdict=verdict)

    def write(self, path: str | os.PathLike[str]) -> Path:
        """Write NetCDF under ``path``; a file under the final name is always complete.

        Parameters
        ----------
        path : str or path-like
            Name of the file.

        Returns
        -------
        Path
            Of the file that was written.

        Raises
        ------
        InputError
            When the folder cannot be written.
        """
        return write_result(self, Path(path))


def make_provenance(**entries: Any) -> dict[str, Any]:
    """Collect version, packages, conventions and time of the run, with ``entries`` on top."""
    return {
        "moyai_version": VERSION,
        "python": platform.python_version(),
        "platform": f"{platform.system()} {platform.machine()}",
        "packages": dict(_packages()),
        "created": datetime.now(UTC).isoformat(timespec="seconds"),
        "command": " ".join([Path(sys.argv[0]).name, *sys.argv[1:]]) if sys.argv and sys.argv[0] else "",
        "time_convention": TIME_CONVENTION,
        "direction_convention": DIRECTION_CONVENTION,
        **entries,
    }


@cache
def _packages() -> tuple[tuple[str, str], ...]:
    """Return the packages that numbers rest on, with their versions."""
    found = []
    for name in ("numpy", "scipy", "numba", "xarray", "raschii"):
        try:
            found.append((name, metadata.version(name)))
        except metadata.PackageNotFoundError:
            found.append((name, "absent"))
    return tuple(found)


def split_complex(dataset: xr.Dataset) -> xr.Dataset:
    """Store complex variables along Capytaine's ``complex = re, im`` dimension, which every reader accepts."""
    import xarray as xr

    changed = {}
    for name, variable in dataset.variables.items():
        if np.iscomplexobj(variable.values):
            stacked = np.stack([variable.values.real, variable.values.imag])
            changed[name] = (("complex", *variable.dims), stacked, variable.attrs)
    if not changed:
        return dataset
    out = dataset.drop_vars(list(changed)).assign(changed)
    return out.assign_coords(complex=xr.Variable("complex", np.array(["re", "im"])))


def join_complex(dataset: xr.Dataset) -> xr.Dataset:
    """Undo :func:`split_complex`: give complex variables back as complex."""
    if "complex" not in dataset.dims:
        return dataset
    out = {}
    for name, variable in dataset.data_vars.items():
        if "complex" in variable.dims:
            joined = variable.sel(complex="re", drop=True) + 1j * variable.sel(complex="im", drop=True)
            joined.attrs = variable.attrs
            out[name] = joined
    return dataset.drop_vars([*out, "complex"]).assign(out)


def _map_tree(tree: xr.DataTree, change: Any) -> xr.DataTree:
    import xarray as xr

    return xr.DataTree.from_dict({node.path: change(node.to_dataset(inherit=False)) for node in tree.subtree})


def write_result(result: Result, path: Path) -> Path:
    """Write a result; see :meth:`Result.write`."""
    import xarray as xr

    from moyai.core.netcdf_writer import can_write, write_tree

    header = {
        "Conventions": "CF-1.10",
        "title": str(result.provenance.get("title", "moyai result")),
        "source": f"moyai {result.provenance.get('moyai_version', '')}".strip(),
        "history": f"{result.provenance.get('created', '')} {result.provenance.get('command', '')}".strip(),
        "status": result.status,
        "message": result.message,
        "time_convention": TIME_CONVENTION,
        "direction_convention": DIRECTION_CONVENTION,
        "checks": json.dumps([check.as_dict() for check in result.checks]),
        "notices": json.dumps([notice.as_dict() for notice in result.notices]),
        "provenance": json.dumps(dict(result.provenance), default=str),
        "headlines": json.dumps([headline.as_dict() for headline in result.headlines]),
        "verdict": json.dumps(result.verdict.as_dict()),
    }
    tree = _map_tree(result.tree, split_complex)
    root = tree.to_dataset(inherit=False)
    root.attrs.update(header)
    groups = {node.path: node.to_dataset(inherit=False) for node in tree.subtree}
    groups["/"] = root
    tree = xr.DataTree.from_dict(groups)
    with partial_file(path, size=sum(node.nbytes for node in tree.subtree)) as partial:
        if can_write(tree):
            write_tree(tree, partial)
        else:
            tree.to_netcdf(partial, engine="h5netcdf")
    return path


def _file_of_result(path: Path) -> Path:
    """Return the file of a result; of a folder the one that a command wrote there.

    Raises
    ------
    InputError
        When there is none, or the path names a case.
    """
    if path.is_dir():
        found = [path / name for name in RESULT_FILES if (path / name).is_file()]
        if not found:
            raise InputError(f"no {RESULT_FILES[0]} in the folder {path}", path="result")
        return found[0]
    if not path.exists():
        raise InputError(f"no such file: {path}", path="result")
    if path.suffix.lower() in (".yaml", ".yml"):
        raise InputError(
            f"{path.name} is a case file, no result", path="result", remedy=f"run it first: moyai run {path}"
        )
    return path


@reads("a result of moyai", named="result")
def read_result(path: str | os.PathLike[str]) -> Result:
    """Read a result written by :meth:`Result.write`.

    Parameters
    ----------
    path : path
        The file, or the folder of the run.

    Raises
    ------
    InputError
        When the file is absent or was not written by moyai.
    """
    import xarray as xr

    from moyai.core.netcdf_reader import read_tree

    file = _file_of_result(Path(path))
    if netcdf_engine(file, "a result of moyai", named="result") != "h5netcdf":
        raise InputError(f"{file} was not written by moyai: it is NetCDF 3", path="result")
    try:
        tree = read_tree(file, named="result")
    except (LookupError, OSError, TypeError, ValueError):
        # written by another program, or damaged: xarray reads it, or says what is wrong
        with xr.open_datatree(file, engine="h5netcdf") as stored:
            for node in stored.subtree:
                require_plausible_size(file, node.nbytes, f"group '{node.path}'", named="result")
            tree = stored.load()
    tree = _map_tree(tree, join_complex)
    attributes = tree.attrs
    if "status" not in attributes or "checks" not in attributes:
        raise InputError(f"{file} was not written by moyai (no status or checks in it)", path="result")

    def number(value: Any) -> float:
        return math.nan if value is None else float(value)

    checks = tuple(
        IdentityCheck(item["name"], number(item["value"]), number(item["tolerance"]), item.get("meaning", ""))
        for item in json.loads(attributes["checks"])
    )
    notices = tuple(
        Notice(**{**item, "value": number(item["value"]), "limit": number(item["limit"])})
        for item in json.loads(attributes["notices"])
    )
    return Result(
        tree=tree,
        status=attributes["status"],
        message=attributes.get("message", ""),
        checks=checks,
        notices=notices,
        provenance=json.loads(attributes.get("provenance", "{}")),
        headlines=tuple(Headline.from_dict(item) for item in json.loads(attributes.get("headlines", "[]"))),
        verdict=Verdict.from_dict(json.loads(attributes.get("verdict", "{}"))),
    )


__all__ = ["MoyaiError", "Result", "Status", "join_complex", "make_provenance", "read_result", "write_result"]
