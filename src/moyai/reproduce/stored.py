"""A reproduced paper in ``results.nc`` and back: what its page shows beyond the numbers of its curves."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.kinds import Kind
from moyai.report.document import Abscissa, Disc, Distance, Drawing, Figure, Mark, Panel, Series, Stroke, Words
from moyai.reproduce.model import FilledInput, Finding, PaperFigure, Statement
from moyai.reproduce.points import Agreement, Points
from moyai.reproduce.reproduction import Reproduction, StatementRow, paper

if TYPE_CHECKING:
    import xarray as xr

    from moyai.core.results import Result

GROUP = "page"
_CLASSES: dict[str, type] = {
    one.__name__: one
    for one in (
        Abscissa, Agreement, Disc, Distance, Drawing, Figure, FilledInput, Finding, Mark, Panel, PaperFigure, Points,
        Series, Stroke, Words,
    )
}  # fmt: skip


def stored_page(found: Reproduction) -> xr.Dataset:
    """Return what :func:`read_page` needs as a dataset: one text, and the arrays of all figures in a row.

    Parameters
    ----------
    found : Reproduction
    """
    import xarray as xr

    arrays: list[Any] = []
    content = {
        "rows": [[row.statement.key, row.statement.place, row.statement.text, row.finding] for row in found.rows],
        "figures": found.figures,
        "filled": found.filled,
        "laid": found.laid,
    }
    text = json.dumps(_written(content, arrays))
    numbers = np.concatenate([np.ravel(array) for array in arrays]) if arrays else np.empty(0)
    return xr.Dataset({"content": ((), np.array(text, dtype=object)), "numbers": ("number", numbers)})


def read_page(result: Result) -> Reproduction:
    """Return the reproduction that a result was made from; texts of equations and the case files are those of today.

    Parameters
    ----------
    result : Result
        With the group ``/page``.
    """
    group = result.tree[GROUP]
    content = _read(json.loads(str(group["content"].item())), np.asarray(group["numbers"], dtype=float))

    def row(key: str, place: str, text: str, finding: Finding) -> StatementRow:
        return StatementRow(Statement(key, place, text, lambda _: finding), finding)

    return Reproduction(
        paper(str(result.tree.attrs["paper"])),
        bool(result.provenance.get("quick", False)),
        tuple(row(*entry) for entry in content["rows"]),
        content["figures"],
        content["filled"],
        content["laid"],
    )


def _written(value: Any, arrays: list[Any]) -> Any:
    """Return a value as JSON takes it; arrays are moved into a list."""
    if is_dataclass(value) and not isinstance(value, type):
        parts = {one.name: _written(getattr(value, one.name), arrays) for one in fields(value)}
        return {"class": type(value).__name__, "parts": parts}
    if isinstance(value, np.ndarray):
        arrays.append(value.astype(float))
        return {"array": [sum(array.size for array in arrays[:-1]), *value.shape]}
    if isinstance(value, Mapping):
        return {"parts": {str(key): _written(item, arrays) for key, item in value.items()}}
    if isinstance(value, list | tuple):
        return [_written(item, arrays) for item in value]
    return value.item() if isinstance(value, np.generic) else value


def _read(value: Any, numbers: Any) -> Any:
    if isinstance(value, list):
        return tuple(_read(item, numbers) for item in value)
    if not isinstance(value, dict):
        return value
    if "array" in value:
        start, *shape = value["array"]
        return numbers[start : start + int(np.prod(shape))].reshape(shape)
    if "parts" not in value:
        return {key: _read(item, numbers) for key, item in value.items()}
    parts = {key: _read(item, numbers) for key, item in value["parts"].items()}
    return _CLASSES[value["class"]](**parts) if "class" in value else parts


class ReproductionKind(Kind):
    """Results of ``moyai reproduce``."""

    name = "reproduction"
    package = "moyai.reproduce"

    def compose(self, result: Result) -> Any:
        if GROUP in result.tree.children:
            from moyai.reproduce.page import compose

            return compose(read_page(result), result)
        from moyai.report.general_page import compose as compose_listing

        return compose_listing(result)


KIND = ReproductionKind()
