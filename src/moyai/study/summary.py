"""The study as one table: a row a case, which any spreadsheet opens."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import Any

import numpy as np

from moyai.core.files import write_whole
from moyai.core.results import Result
from moyai.study.definition import Study


def table_rows(study: Study, result: Result) -> tuple[list[str], list[list[Any]]]:
    """Return header and rows: labels of the case, status, every response (one column a label of its own).

    Parameters
    ----------
    study : Study
    result : Result
        As gathered by :func:`moyai.study.table.study_result`.
    """
    axes = [axis.name for axis in study.axes]
    count = len(study.cases)
    header = ["case", *axes, "status", "message"]
    columns: list[list[Any]] = [[case.index for case in study.cases]]
    columns += [[case.labels[place] for case in study.cases] for place in range(len(axes))]
    root = result.tree.to_dataset()
    columns += [list(root[name].values.reshape(count)) for name in ("case_status", "case_message")]
    for node in result.tree.subtree:
        group = node.path.strip("/")
        for name, variable in node.data_vars.items():
            if variable.dtype.kind != "f" or tuple(variable.dims[: len(axes)]) != tuple(axes):
                continue
            rest = variable.dims[len(axes) :]
            if len(rest) > 1 or any(str(dim).endswith("_peak") for dim in rest):
                # Matrices and peaks of a case are in study.nc
                continue
            values = variable.values.reshape((count, *variable.shape[len(axes) :]))
            for place in np.ndindex(*values.shape[1:]):
                labels = [
                    str(variable.coords[dim].values[at]) if dim in variable.coords else str(at)
                    for dim, at in zip(rest, place)
                ]
                unit = variable.attrs.get("units", "1")
                word = "/".join(part for part in (group, str(name)) if part)
                header.append(word + (f" {' '.join(labels)}" if labels else "") + (f" [{unit}]" if unit != "1" else ""))
                columns.append([repr(float(value)) for value in values[(slice(None), *place)]])
    return header, [list(row) for row in zip(*columns)]


def write_table(study: Study, result: Result, path: Path) -> Path:
    """Write the table of a study as CSV (with byte-order mark, as spreadsheets want it).

    Raises
    ------
    InputError
        When the file cannot be written.
    """
    header, rows = table_rows(study, result)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\r\n")
    writer.writerow(header)
    writer.writerows(rows)
    return write_whole(path, text.getvalue().encode("utf-8-sig"))
