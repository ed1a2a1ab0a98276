"""From the diary of a study to one labelled dataset over its axes."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.results import Result, Status, make_provenance
from moyai.core.wording import counted
from moyai.study.axes import Axis
from moyai.study.definition import Study
from moyai.study.ledger import LedgerRecord

if TYPE_CHECKING:
    import xarray as xr


def study_result(study: Study, records: Iterable[LedgerRecord], *, interrupted: bool = False) -> Result:
    """Gather the records of a study.

    Parameters
    ----------
    study : Study
    records : iterable of Record
        In any order; cases without one count as not run.
    interrupted : bool
        The study was stopped before its end.

    Returns
    -------
    Result
        Its tree has the groups of a case's result, every variable with the axes of the study in front; the root holds
        ``case_status``, ``case_message``, ``case_verdict`` and, where points have weights, ``probability``.
    """
    import xarray as xr

    known = {record.index: record for record in records}
    groups: dict[str, xr.Dataset] = {"/": _root(study, known)}
    for path, dataset in _groups(study, known).items():
        groups[path] = dataset if path != "/" else groups["/"].merge(dataset)
    tree = xr.DataTree.from_dict(groups)
    tree.attrs.update(
        {
            "structure": "study",
            "title": study.title,
            "case_text": study.base.text,
            "watch": study.watch,
            "axes": json.dumps([_axis(axis) for axis in study.axes]),
        }
    )
    status, message = _status(study, known, interrupted)
    provenance = make_provenance(title=study.title, base=study.base_path.name, study=study.key)
    return Result(tree, status, message, provenance=provenance)


def _axis(axis: Axis) -> dict[str, Any]:
    varied = axis.coordinates()
    values, unit = next(iter(varied.values())) if len(varied) == 1 else ([], "")
    numbers = values if values and not any(isinstance(value, str) for value in values) else None
    return {"name": axis.name, "labels": [point.label for point in axis.points], "values": numbers, "unit": unit}


def _status(study: Study, known: dict[int, LedgerRecord], interrupted: bool) -> tuple[Status, str]:
    failed = sum(record.status == "failed" for record in known.values())
    refused = sum(record.status == "refused" for record in known.values())
    doubtful = sum(record.status not in ("converged", "failed", "refused") for record in known.values())
    parts = [f"{len(known)} of {counted(len(study.cases), 'case')} run"]
    if failed:
        parts.append(f"{failed} failed")
    if refused:
        parts.append(f"{refused} refused by the check")
    if doubtful:
        parts.append(f"{doubtful} ran with doubts")
    message = ", ".join(parts)
    if interrupted or len(known) < len(study.cases):
        return "interrupted", message
    if failed + refused == len(study.cases):
        return "failed", message
    # Refused cases are what the study file asked for where it says 'on_refused: skip'
    spoilt = failed or doubtful or (refused and not study.skips_refused)
    return ("outside_validity" if spoilt else "converged"), message


def _root(study: Study, known: dict[int, LedgerRecord]) -> xr.Dataset:
    import xarray as xr

    dims = tuple(axis.name for axis in study.axes)
    status = np.full(len(study.cases), "not run", dtype=object)
    message = np.full(len(study.cases), "", dtype=object)
    verdict = np.full(len(study.cases), "", dtype=object)
    for index, record in known.items():
        status[index], message[index], verdict[index] = record.status, record.message, record.verdict
    data: dict[str, Any] = {
        "case_status": (dims, status.reshape(study.shape), {"units": "1", "long_name": "status of the case"}),
        "case_message": (dims, message.reshape(study.shape), {"units": "1", "long_name": "what the case said"}),
        "case_verdict": (dims, verdict.reshape(study.shape), {"units": "1", "long_name": "whether the design holds"}),
    }
    weights = [np.array([point.probability for point in axis.points]) for axis in study.axes]
    weighted = [index for index, weight in enumerate(weights) if np.isfinite(weight).all()]
    if weighted:
        total = np.ones(study.shape)
        for index, weight in enumerate(weights):
            share = weight if index in weighted else np.full(len(weight), 1.0 / len(weight))
            total = total * share.reshape([-1 if place == index else 1 for place in range(len(weights))])
        attributes = {
            "units": "1",
            "long_name": "share of the time (axes without probabilities count evenly)",
        }
        data["probability"] = (dims, total, attributes)
    return xr.Dataset(data, coords=_coordinates(study))


def _coordinates(study: Study) -> dict[str, Any]:
    coordinates: dict[str, Any] = {}
    for axis in study.axes:
        varied = axis.coordinates()
        labels = np.array([point.label for point in axis.points], dtype=object)
        single = next(iter(varied.items())) if len(varied) == 1 else None
        if single is not None and not any(isinstance(value, str) for value in single[1][0]):
            path, (values, unit) = single
            attributes = {"units": unit or "1", "long_name": path}
            coordinates[axis.name] = (axis.name, np.asarray(values), attributes)
            continue
        coordinates[axis.name] = (axis.name, labels, {"long_name": axis.name})
        for path, (values, unit) in varied.items():
            name = f"{axis.name}_{re.sub(r'[^0-9A-Za-z]+', '_', path).strip('_')}"
            kept: Any = np.array(values, dtype=object) if any(isinstance(value, str) for value in values) else values
            coordinates[name] = (axis.name, kept, {"units": unit or "1", "long_name": path})
    return coordinates


def _groups(study: Study, known: dict[int, LedgerRecord]) -> dict[str, xr.Dataset]:
    """Return the datasets by group; a label that some cases lack is NaN there."""
    import xarray as xr

    axes = tuple(axis.name for axis in study.axes)
    first: dict[str, dict[str, Any]] = {}
    labels: dict[tuple[str, str], list[Any]] = {}
    for record in known.values():
        for name, item in record.values.items():
            first.setdefault(name, item)
            for dim, given in item["labels"].items():
                mine = labels.setdefault((_group(name), dim), [])
                if given != mine:
                    mine.extend(label for label in given if label not in mine)
    gathered: dict[str, dict[str, Any]] = {}
    coordinates: dict[str, dict[str, Any]] = {}
    for name, item in first.items():
        group = _group(name)
        variable = name.rpartition("/")[2]
        # xarray would take a variable of a dimension's name for a coordinate
        variable = f"{variable}_response" if variable in axes else variable
        own = [labels.get((group, dim)) if dim in item["labels"] else None for dim in item["dims"]]
        sizes = [_length(known, name, place) if one is None else len(one) for place, one in enumerate(own)]
        values = np.full((len(study.cases), *sizes), math.nan)
        for index, record in known.items():
            if name in record.values:
                _place(values, index, record.values[name], own)
        dims = [_dimension(dim, variable, axes, one is not None) for dim, one in zip(item["dims"], own)]
        attributes = {"units": item["units"] or "1", "long_name": item["long_name"]}
        shaped = values.reshape((*study.shape, *sizes))
        gathered.setdefault("/" + group, {})[variable] = ((*axes, *dims), shaped, attributes)
        for dim, one in zip(dims, own):
            if one is not None:
                text = any(isinstance(label, str) for label in one)
                coordinates.setdefault("/" + group, {})[dim] = (dim, np.array(one, dtype=object if text else float))
    return {path: xr.Dataset(held, coords=coordinates.get(path, {})) for path, held in gathered.items()}


def _group(name: str) -> str:
    return name.rpartition("/")[0]


def _dimension(dim: str, variable: str, axes: tuple[str, ...], labelled: bool) -> str:
    if dim in axes:
        return f"case_{dim}"
    return dim if labelled else f"{variable}_{dim}"


def _length(known: dict[int, LedgerRecord], name: str, place: int) -> int:
    lengths = [0]
    for record in known.values():
        if name in record.values:
            lengths.append(np.asarray(record.values[name]["values"]).shape[place])
    return max(lengths)


def _place(target: np.ndarray, index: int, item: dict[str, Any], labels: list[list[Any] | None]) -> None:
    """Put a case's values where their labels stand."""
    values = np.asarray(item["values"], dtype=float)
    same = all(known is None or item["labels"].get(dim) == known for dim, known in zip(item["dims"], labels))
    if values.ndim == 0 or (same and values.shape == target.shape[1:]):
        target[index] = values
        return
    rows = []
    for place, (dim, known) in enumerate(zip(item["dims"], labels)):
        given = item["labels"].get(dim)
        rows.append(list(range(values.shape[place])) if known is None else [known.index(label) for label in given])
    target[index][np.ix_(*rows)] = values
