"""Responses of a study by name, and the tensions that its lines are compared with."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.errors import InputError
from moyai.core.results import Result
from moyai.core.vocabulary import (
    ANCHOR_VERTICAL_TENSION_MAXIMUM,
    BREAKING_LOAD,
    LINE_TENSION_MAXIMUM,
    LINE_TENSION_MEAN,
    former,
)
from moyai.study import schema
from moyai.study.definition import Study
from moyai.study.responses import largest_tensions, selected, split_response

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Tensions:
    """Tensions of the lines in one group of the results, over the axes of the study and ``line``."""

    #: Where they stand in the results.
    group: str
    #: Largest tensions [N].
    maximum: xr.DataArray
    #: Mean tensions [N].
    mean: xr.DataArray
    #: Breaking loads [N].
    breaking: xr.DataArray
    #: Largest vertical pull at the anchor [N].
    uplift: xr.DataArray | None


def has(result: Result, group: str, name: str) -> bool:
    """Whether a group of a study's result holds a variable."""
    try:
        return name in result.tree[group].data_vars
    except KeyError:
        return False


def variable(result: Result, group: str, name: str) -> xr.DataArray:
    """Return a variable of a group."""
    held: Any = result.tree[group]
    found: xr.DataArray = held.to_dataset()[name]
    return found


def response(result: Result, text: str) -> xr.DataArray:
    """Return a response of a study: ``group/name``, or ``group/name[line=seaward]``.

    Raises
    ------
    InputError
        When the study has none of that name, or the label is not there.
    """
    group, name, labels = split_response(text)
    if not has(result, f"/{group}", name):
        same = sorted(
            f"{node.path.strip('/')}/{one}" for node in result.tree.subtree for one in node.data_vars if one == name
        )
        raise InputError(
            f"the study has no response '{text}'", path="assess", allowed=", ".join(same[:6]), remedy=former(name)
        )
    return selected(variable(result, f"/{group}", name), labels, text)


def tensions(study: Study, result: Result, named: Mapping[str, schema.TensionOfLine]) -> list[Tensions]:
    """Return the tensions of the lines: as the study file names them, or as the results give them.

    Raises
    ------
    InputError
        When there are none.
    """
    return [_named(study, result, named)] if named else _found_by_name(study, result)


def _named(study: Study, result: Result, named: Mapping[str, schema.TensionOfLine]) -> Tensions:
    import xarray as xr

    axes = [axis.name for axis in study.axes]
    lines = xr.IndexVariable("line", list(named))

    def stacked(texts: list[str]) -> xr.DataArray:
        return xr.concat([_largest(response(result, text), axes) if text else missing for text in texts], lines)

    missing = xr.DataArray(np.full(study.shape, math.nan), dims=axes)
    maximum = stacked([one.maximum for one in named.values()])
    mean = stacked([one.mean for one in named.values()])
    uplift = stacked([one.uplift for one in named.values()]) if any(one.uplift for one in named.values()) else None
    strength = xr.DataArray([one.breaking_load for one in named.values()], coords={"line": lines})
    return Tensions("as named", maximum, mean, xr.ones_like(maximum) * strength, uplift)


def _largest(found: xr.DataArray, axes: list[str]) -> xr.DataArray:
    """Return the largest entry of every case."""
    absent = [axis for axis in axes if axis not in found.dims]
    if absent:
        raise InputError(f"'{found.name}' is not given for every case", path="assess.tensions")
    rest = [dim for dim in found.dims if dim not in axes]
    return (found.max(rest) if rest else found).transpose(*axes).drop_vars(set(found.coords), errors="ignore")


def breaking_loads(result: Result, level: str) -> xr.DataArray | None:
    """Return the breaking loads of the lines at a water level, wherever the structure gives them."""
    groups = (node.path for node in result.tree.subtree if node.path.strip("/").split("/")[0] == level)
    where = next((path for path in groups if has(result, path, BREAKING_LOAD.name)), None)
    return None if where is None else variable(result, where, BREAKING_LOAD.name)


def _found_by_name(study: Study, result: Result) -> list[Tensions]:
    axes = [axis.name for axis in study.axes]
    found = []
    for node in result.tree.subtree:
        if node.path.startswith("/assessment"):
            continue
        tensions = largest_tensions(held := node.to_dataset(), axes)
        if LINE_TENSION_MEAN.name not in tensions or not set(axes).issubset(tensions[LINE_TENSION_MAXIMUM.name].dims):
            continue
        maximum, mean = tensions[LINE_TENSION_MAXIMUM.name], tensions[LINE_TENSION_MEAN.name]
        breaking = breaking_loads(result, node.path.strip("/").split("/")[0])
        uplift = held.get(ANCHOR_VERTICAL_TENSION_MAXIMUM.name)
        if uplift is not None:
            # of a cage it stands along its anchors and not along all its lines
            others = [dim for dim in uplift.dims if dim not in (*axes, "line")]
            uplift = uplift.max(others) if "line" in uplift.dims else None
        found.append(
            Tensions(node.path.strip("/"), maximum, mean, maximum * math.nan if breaking is None else breaking, uplift)
        )
    if not found:
        raise InputError(
            "no case gives tensions of lines",
            path="assess.lines",
            remedy="let the cases run 'frequency' or 'time', or name the responses under 'assess.tensions'",
        )
    return found
