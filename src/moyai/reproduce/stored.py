"""A reproduced paper in ``results.nc`` and back: what its page shows beyond the numbers of its curves."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.kinds import Kind
from moyai.report.document import Abscissa, Disc, Distance, Drawing, Figure, Mark, Panel, Series, Stroke, Words
from moyai.report.encoding import slug
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
_WORDS = (("agrees", "agree"), ("differs", "differ"), ("open", "open"))


def as_result(found: Reproduction) -> Result:
    """Return the numbers behind the page as a result: one group a figure, one for the statements, one for the page.

    Parameters
    ----------
    found : Reproduction
        With one statement or more.

    Returns
    -------
    Result
        Groups ``statements``, ``figure_<number>`` with the curves in the units of the page, and the page itself.

    Examples
    --------
    >>> from moyai.reproduce import Reproduction, as_result, paper
    >>> from moyai.reproduce.model import Finding
    >>> from moyai.reproduce.reproduction import StatementRow
    >>> tabata = paper("tabata")
    >>> row = StatementRow(tabata.statements[0], Finding("as the paper says", "agrees"))
    >>> result = as_result(Reproduction(tabata, True, (row,), (), ()))
    >>> result.tree["statements"]["verdict"].values.tolist()
    ['agrees']
    """
    import xarray as xr

    from moyai.core.results import Result, make_provenance

    rows = [row.as_dict() for row in found.rows]
    columns = {name: ("row", np.array([row[name] for row in rows], dtype=object)) for name in rows[0]}
    groups: dict[str, xr.Dataset] = {"/statements": xr.Dataset(columns)}
    for one in found.figures:
        if isinstance(one.drawn, Figure):
            groups[f"/figure_{one.number}"] = _dataset(one.drawn)
    title = f"{found.paper.authors} ({found.paper.year})"
    groups[f"/{GROUP}"] = stored_page(found)
    groups["/"] = xr.Dataset(attrs={"structure": "reproduction", "title": title, "paper": found.paper.key})
    words = ", ".join(f"{found.count(verdict)} {word}" for verdict, word in _WORDS)
    return Result(
        xr.DataTree.from_dict(groups),
        message=f"{len(rows)} statements: {words}",
        provenance=make_provenance(title=title, quick=found.quick),
    )


def _dataset(figure: Figure) -> Any:
    """Return the curves of a figure, each along its own dimension."""
    import xarray as xr

    out: dict[str, Any] = {}
    for number, series in enumerate(figure.series):
        panel = figure.panels[series.panel]
        name = f"{slug(series.label).replace('-', '_').replace('.', '_')}_{number}"
        for axis in figure.abscissae:
            if axis.key in series.x:
                words = {"long_name": axis.label, "units": axis.unit or "1"}
                out[f"{name}_{axis.key}"] = (name + "_point", np.asarray(series.x[axis.key], dtype=float), words)
        words = {"long_name": f"{panel.label}: {series.label}", "units": panel.unit or "1"}
        out[name] = (name + "_point", np.asarray(series.y, dtype=float), words)
    return xr.Dataset(out, attrs={"title": figure.title})


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
