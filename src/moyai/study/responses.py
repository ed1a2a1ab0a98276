"""What is kept of a case's result: everything small and labelled by itself, the rest as asked for."""

from __future__ import annotations

import re
from collections.abc import Collection, Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.errors import InputError
from moyai.core.groups import Groups
from moyai.core.kinds import groups_of
from moyai.core.vocabulary import LINE_TENSION_MAXIMUM, LINE_TENSION_MEAN, former

if TYPE_CHECKING:
    import xarray as xr

_LARGEST = 400


@dataclass(frozen=True)
class Wanted:
    """A value that was asked for."""

    #: Group and name: ``SWL/rao/mean_drift_force``.
    variable: str
    #: ``maximum``, ``minimum``, ``mean``, ``last``, ``all``, ``rainflow``, ``peaks``, ``snap_peaks``, ``other_peaks``
    #: or ``mean_in_time``.
    reduce: str
    #: Dimensions; all whose coordinate is no label when empty.
    over: tuple[str, ...] = ()
    #: Of the endurance curve, for ``rainflow``.
    exponent: float = 0.0

    @property
    def name(self) -> str:
        """Name under which it is kept."""
        if self.reduce == "all":
            return self.variable
        return f"{self.variable}_{self.reduce}" + (f"_{self.exponent:g}" if self.reduce == "rainflow" else "")


def kept(tree: xr.DataTree | Groups, wanted: Sequence[Wanted] = ()) -> dict[str, Any]:
    """Return the values of a result that a study keeps.

    Real and complex scalars, and arrays over labelled dimensions (lines, degrees of freedom, components), are kept by
    themselves; a complex value is kept by its modulus. The largest tension of every line over whatever has no labels
    (periods, currents) is kept too, with the mean tension that goes with it. Arrays over anything else only as
    ``wanted`` says. Unit and words are those of the vocabulary of the result's kind.

    Parameters
    ----------
    tree : xarray.DataTree or Groups
        Of the result.
    wanted : sequence of Wanted

    Returns
    -------
    dict
        By ``group/name``: ``{"dims", "labels", "values", "units", "long_name"}``, plain lists and numbers.

    Raises
    ------
    InputError
        When a wanted variable or dimension is not in the result.
    """
    groups = (
        {node.path: _labelled_group(node) for node in tree.subtree} if isinstance(tree, Groups) else groups_of(tree)
    )
    found: dict[str, Any] = {}
    for path, held in groups.items():
        tensions = largest_tensions(held) if LINE_TENSION_MAXIMUM.name in held.variables else {}
        for name in [*held.data_vars.keys(), *(name for name in tensions if name not in held.variables)]:
            variable = tensions[name].variable if name in tensions else held.variables[name]
            if variable.dtype.kind in "fiubc" and variable.size <= _LARGEST:
                labels = {dim: held.variables[dim] for dim in variable.dims if _labels(held.variables.get(dim))}
                if len(labels) == len(variable.dims):
                    found[_key(path, str(name))] = _record(variable, labels)
    for item in wanted:
        found[item.name] = _reduced(groups, item)
    return found


def _labelled_group(node: Groups) -> xr.Dataset:
    """Return the dataset of a group with the labels that it has from the groups above."""
    above = {name: one for name, one in node.variables.items() if name not in node.dataset.variables}
    return node.dataset.assign_coords(above) if above else node.dataset


def largest_tensions(held: xr.Dataset, keep: Collection[str] | None = None) -> dict[str, xr.DataArray]:
    """Return the largest tension of every line in a group, and the mean tension of the wave or run that it is from.

    Parameters
    ----------
    held : Dataset
        Group of a result, or of a study.
    keep : collection of str, optional
        Dimensions that stay next to ``line``; those with labels when None.

    Returns
    -------
    dict
        By the common names; empty where the group gives no tensions of lines.
    """
    largest = held.get(LINE_TENSION_MAXIMUM.name)
    if largest is None or "line" not in largest.dims:
        return {}
    mean = held.get(LINE_TENSION_MEAN.name)

    def over(variable: xr.DataArray) -> list[str]:
        stays = [dim for dim in variable.dims if _has_labels(variable, dim)] if keep is None else keep
        return [str(dim) for dim in variable.dims if dim != "line" and dim not in stays]

    if mean is None:
        return {LINE_TENSION_MAXIMUM.name: largest.max(over(largest)).assign_attrs(largest.attrs)}
    # what only one of both runs along: the least mean leaves most to the dynamic part, which codes weigh more
    largest = largest.max([dim for dim in over(largest) if dim not in mean.dims]).assign_attrs(largest.attrs)
    mean = mean.min([dim for dim in over(mean) if dim not in largest.dims]).assign_attrs(mean.attrs)
    if shared := over(largest):
        place = largest.fillna(-np.inf).argmax(shared)
        largest, mean = (
            one.isel(place).drop_vars(set(one.coords) - set(one.dims) | set(shared), errors="ignore")
            for one in (largest, mean)
        )
    return {LINE_TENSION_MAXIMUM.name: largest, LINE_TENSION_MEAN.name: mean}


def _counted(variable: xr.DataArray, item: Wanted) -> xr.DataArray:
    """Return the sum of rainflow ranges to the power of the exponent, a second, of every series along time."""
    from moyai.series.rainflow import count_cycles

    if "time" not in variable.dims or "time" not in variable.coords:
        raise InputError(f"'{item.variable}' is no series along 'time'", path="responses")
    seconds = float(np.ptp(variable.coords["time"].values.astype(float)))
    if not seconds > 0.0:
        raise InputError(f"'{item.variable}' has no length along 'time'", path="responses")
    moved = variable.transpose(..., "time")
    values = moved.values.reshape(-1, moved.sizes["time"])
    sums = np.empty(len(values))
    for number, series in enumerate(values):
        ranges, _, counts = count_cycles(series)
        sums[number] = np.sum(counts * ranges**item.exponent) / seconds
    out: xr.DataArray = moved.isel(time=0, drop=True).copy(data=sums.reshape(moved.shape[:-1]))
    return out.assign_attrs(units=f"{variable.attrs.get('units', '1')}^{item.exponent:g}/s", long_name="damage sum")


def _peaked(variable: xr.DataArray, item: Wanted) -> xr.DataArray:
    """Return the peaks of every series along time, in their order, the shorter ones filled with NaN."""
    import xarray as xr

    from moyai.series.peaks import peaks_of

    if "time" not in variable.dims:
        raise InputError(f"'{item.variable}' is no series along 'time'", path="responses")
    moved = variable.transpose(..., "time")
    found = []
    for series in moved.values.reshape(-1, moved.sizes["time"]):
        peaks, after_slack = peaks_of(series)
        if item.reduce != "peaks":
            peaks = peaks[after_slack if item.reduce == "snap_peaks" else ~after_slack]
        found.append(peaks)
    table = np.full((len(found), max(peaks.size for peaks in found)), np.nan)
    for row, peaks in zip(table, found):
        row[: peaks.size] = peaks
    dims = moved.dims[:-1]
    coords = {dim: moved.coords[dim] for dim in dims if dim in moved.coords}
    shaped = table.reshape((*moved.shape[:-1], -1)) if table.size else np.empty((*moved.shape[:-1], 0))
    return xr.DataArray(shaped, dims=(*dims, "peak"), coords=coords, name=variable.name, attrs=variable.attrs)


#: The motion whose unit differs from that of the others, and how the words of a variable state it.
_TURNING, _UNIT_OF_TURNING = "roll", re.compile(r"\s*\(roll: ([^)]*)\)")


def read_response(tree: xr.DataTree, name: str, sign: int = 1) -> float:
    """Return one number of a result.

    Parameters
    ----------
    tree : xarray.DataTree
    name : str
        Group and name, perhaps with labels: ``SWL/frequency/waves/motion_ratio[dof=roll]``.
    sign : int
        1 for the largest entry of what is left, -1 for the smallest.

    Raises
    ------
    InputError
        When there is no such variable, dimension or label, or it is NaN.
    """
    variable = find_response(tree, name)
    values = np.asarray(in_stated_unit(variable).values)
    values = np.abs(values) if np.iscomplexobj(values) else values.astype(float)
    if np.isnan(values).all():
        raise InputError(f"the response '{name}' is not known in this case (NaN)", path="response")
    return float(np.nanmax(values) if sign > 0 else np.nanmin(values))


def find_response(tree: xr.DataTree, name: str) -> xr.DataArray:
    """Return a response of a case, at the labels that stand in its name.

    Raises
    ------
    InputError
        When there is no such variable, dimension or label.
    """
    group, last, labels = split_response(name)
    return selected(_variable(groups_of(tree), group, last), labels, name)


def split_response(text: str) -> tuple[str, str, tuple[tuple[str, str], ...]]:
    """Return group, name and labels of a response such as ``SWL/frequency/waves/motion_ratio[dof=roll]``.

    Raises
    ------
    InputError
        When the text is no response.
    """
    found = re.fullmatch(r"(?P<name>[^\[\]]+?)\s*(?:\[(?P<labels>.*)\])?", text.strip())
    if found is None:
        raise InputError(f"'{text}' is no response", path="response", allowed="group/name or group/name[line=seaward]")
    group, _, last = found["name"].rpartition("/")
    # a label may have a comma in it: wave=H 1.5 m, T 6 s
    parts = re.split(r",\s*(?=\w+\s*=)", found["labels"] or "")
    pairs = [part.partition("=") for part in parts if part.strip()]
    return group, last, tuple((dim.strip(), label.strip()) for dim, _, label in pairs)


def selected(variable: xr.DataArray, labels: Sequence[tuple[str, str]], text: str) -> xr.DataArray:
    """Return a variable at labels of its dimensions.

    Raises
    ------
    InputError
        When it has no such dimension or label.
    """
    for dim, label in labels:
        if dim not in variable.dims:
            raise InputError(f"'{text}' has no '{dim}'", path="response", allowed=", ".join(map(str, variable.dims)))
        known = [str(item) for item in variable.coords[dim].values] if dim in variable.coords else []
        if label not in known:
            raise InputError(f"'{text}' has no {dim} '{label}'", path="response", allowed=", ".join(known[:12]))
        variable = variable.isel({dim: known.index(label)}, drop=True)
        words = str(variable.attrs.get("long_name", ""))
        if label == _TURNING and (unit := _UNIT_OF_TURNING.search(words)) is not None:
            plain = words[: unit.start()] + words[unit.end() :]
            variable = variable.assign_attrs(units=unit[1], long_name=plain)
    return variable


def in_stated_unit(variable: xr.DataArray) -> xr.DataArray:
    """Return a variable without the entries that have another unit than it states: those of roll among motions.

    An array of motions holds metres and, in roll, radians. Its largest entry is one of metres; roll is asked for by its
    label, ``significant_motion[dof=roll]``.
    """
    if _TURNING not in str(variable.attrs.get("long_name", "")):
        return variable
    for dim in variable.dims:
        labels = variable.coords[dim].values if str(dim).endswith("dof") and dim in variable.coords else ()
        if len(labels) > 1 and _TURNING in labels:
            variable = variable.isel({dim: [at for at, label in enumerate(labels) if label != _TURNING]})
    return variable


def _variable(groups: Mapping[str, xr.Dataset], group: str, name: str) -> xr.DataArray:
    """Return a variable, or say which there are."""
    held = groups.get(f"/{group.strip('/')}")
    if held is None or name not in held.data_vars:
        near = sorted(_key(path, str(one)) for path, other in groups.items() for one in other.data_vars)
        same = [entry for entry in near if entry.rsplit("/", 1)[-1] == name][:6]
        raise InputError(
            f"the result has no variable '{_key(group, name)}'",
            path="responses",
            allowed=", ".join(same) if same else f"one of {len(near)} variables, such as {', '.join(near[:4])}",
            remedy=former(name),
        )
    found: xr.DataArray = held[name]
    return found


def _key(path: str, name: str) -> str:
    group = path.strip("/")
    return f"{group}/{name}" if group else name


def _has_labels(variable: xr.DataArray, dim: Hashable) -> bool:
    return dim in variable.coords and variable.coords[dim].dtype.kind in "OU"


def _labels(coordinate: xr.Variable | None) -> bool:
    return coordinate is not None and coordinate.dtype.kind in "OU"


def _record(variable: xr.Variable, coordinates: Mapping[Hashable, xr.Variable]) -> dict[str, Any]:
    values = np.asarray(variable.values)
    if np.iscomplexobj(values):
        values = np.abs(values)
    return {
        "dims": [str(dim) for dim in variable.dims],
        "labels": {str(dim): coordinates[dim].values.tolist() for dim in variable.dims if dim in coordinates},
        "values": np.asarray(values, dtype=float).tolist(),
        "units": str(variable.attrs.get("units", "")),
        "long_name": str(variable.attrs.get("long_name", "")),
    }


def _record_of(variable: xr.DataArray) -> dict[str, Any]:
    return _record(variable.variable, {dim: one.variable for dim, one in variable.coords.items()})


def _reduced(groups: Mapping[str, xr.Dataset], item: Wanted) -> dict[str, Any]:
    group, _, name = item.variable.rpartition("/")
    variable = _variable(groups, group, name)
    if np.iscomplexobj(variable.values):
        variable = abs(variable).assign_attrs(variable.attrs)
    if item.reduce == "all":
        return _record_of(variable)
    if item.reduce == "rainflow":
        return _record_of(_counted(variable, item))
    if item.reduce in ("peaks", "snap_peaks", "other_peaks"):
        return _record_of(_peaked(variable, item))
    if item.reduce == "mean_in_time":
        if "time" not in variable.dims:
            raise InputError(f"'{item.variable}' is no series along 'time'", path="responses")
        return _record_of(variable.mean("time").assign_attrs(variable.attrs))
    over = item.over or tuple(
        str(dim) for dim in variable.dims if variable.coords.get(dim, variable).dtype.kind not in "OU"
    )
    for dim in over:
        if dim not in variable.dims:
            known = ", ".join(map(str, variable.dims)) or "none"
            raise InputError(f"'{item.variable}' has no dimension '{dim}'", path="responses", allowed=known)
    if not over:
        return _record_of(variable)
    if item.reduce == "last":
        out = variable.isel(dict.fromkeys(over, -1))
    else:
        out = getattr(variable, {"maximum": "max", "minimum": "min", "mean": "mean"}[item.reduce])(list(over))
    out = out.drop_vars([name for name in out.coords if name not in out.dims]).assign_attrs(variable.attrs)
    return _record_of(out)
