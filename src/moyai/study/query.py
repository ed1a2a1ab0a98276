"""Questions to the results of a study: which cases, the worst of them, a table of one response over two axes."""

from __future__ import annotations

import json
import math
import operator
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from moyai.case.faults import did_you_mean
from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.quantities import parse_quantity
from moyai.core.vocabulary import former
from moyai.study.responses import in_stated_unit, selected, split_response

if TYPE_CHECKING:
    import xarray as xr


_COMPARE: dict[str, Callable[[Any, Any], Any]] = {
    "<=": operator.le,
    ">=": operator.ge,
    "!=": operator.ne,
    "<": operator.lt,
    ">": operator.gt,
    "=": operator.eq,
}


_WORDS = ("status", "message", "verdict")
"""Columns that are words of each case."""


@dataclass(frozen=True)
class QueryColumn:
    """One column of the table of cases."""

    #: As asked for.
    name: str
    #: SI; ``1`` where there is none.
    unit: str
    #: Number of every case, ``None`` for text.
    values: Array | None
    #: What to show of every case.
    texts: tuple[str, ...]


class StudyTable:
    """The results of a study as a table with a row a case.

    Parameters
    ----------
    tree : xarray.DataTree
        As :func:`read_study_results` gives it.

    Raises
    ------
    InputError
        When these are no results of a study.
    """

    def __init__(self, tree: xr.DataTree) -> None:
        if tree.attrs.get("structure") != "study" or "axes" not in tree.attrs:
            raise InputError(
                "these are not the results of a study", path="results", remedy="name the folder of a study, or study.nc"
            )
        self.tree = tree
        self.title = str(tree.attrs.get("title", ""))
        self.watch = str(tree.attrs.get("watch", ""))
        self.axes: list[dict[str, Any]] = json.loads(tree.attrs["axes"])
        self.shape = tuple(len(axis["labels"]) for axis in self.axes)
        self.count = math.prod(self.shape)
        root: Any = tree.to_dataset(inherit=False)
        self.status = [str(one) for one in root["case_status"].values.reshape(self.count)]
        self.message = [str(one) for one in root["case_message"].values.reshape(self.count)]
        # Studies of before the verdict have none
        judged = root["case_verdict"].values.reshape(self.count) if "case_verdict" in root else [""] * self.count
        self.verdict = [str(one) for one in judged]

    @property
    def names(self) -> list[str]:
        """Names of the axes."""
        return [str(axis["name"]) for axis in self.axes]

    def responses(self) -> dict[str, xr.DataArray]:
        """Return every response by group and name."""
        found = {}
        dims = set(self.names)
        for node in self.tree.subtree:
            for name, variable in node.to_dataset().data_vars.items():
                if variable.dtype.kind == "f" and dims <= set(map(str, variable.dims)):
                    found["/".join(part for part in (node.path.strip("/"), str(name)) if part)] = variable
        return found

    def column(self, text: str) -> QueryColumn:
        """Return a column by name: an axis, ``case``, ``status``, ``message``, ``verdict``, or a response.

        A response may be named by the end of its name, where that is only one, and by labels:
        ``line_tension_maximum[line=seaward]``; the largest entry of what is left counts.

        Parameters
        ----------
        text : str
            Name, with labels in brackets where needed.

        Raises
        ------
        InputError
            When there is none, or several, of that name.
        """
        text = text.strip()
        place = np.unravel_index(np.arange(self.count), self.shape) if self.shape else ()
        if text in self.names:
            number = self.names.index(text)
            axis = self.axes[number]
            labels = tuple(str(axis["labels"][at]) for at in place[number])
            values = None
            if axis["values"] is not None:
                values = np.asarray(axis["values"], dtype=float)[place[number]]
            return QueryColumn(text, str(axis["unit"] or "1"), values, labels)
        if text == "case":
            return QueryColumn(text, "1", np.arange(self.count, dtype=float), tuple(map(str, range(self.count))))
        if text in _WORDS:
            return QueryColumn(text, "", None, tuple(getattr(self, text)))
        name, variable = self._response(text)
        variable = in_stated_unit(variable)
        dims = [dim for dim in self.names if dim in variable.dims]
        table = np.asarray(variable.transpose(*dims, ...).values, dtype=float).reshape(self.count, -1)
        known = np.isfinite(table).any(axis=1) if table.size else np.zeros(self.count, dtype=bool)
        largest = np.full(self.count, math.nan)
        largest[known] = np.nanmax(np.where(np.isfinite(table[known]), table[known], -math.inf), axis=1)
        texts = tuple(f"{value:.6g}" if math.isfinite(value) else "" for value in largest)
        return QueryColumn(name, str(variable.attrs.get("units", "1")), largest, texts)

    def _response(self, text: str) -> tuple[str, xr.DataArray]:
        group, last, labels = split_response(text)
        wanted = f"{group}/{last}" if group else last
        everything = self.responses()
        near = [name for name in everything if name == wanted] or [
            name for name in everything if name.endswith("/" + wanted)
        ]
        if not near:
            known = [*self.names, "case", *_WORDS, *everything]
            ends = [name.rpartition("/")[2] for name in everything]
            raise InputError(
                f"there is no axis and no response '{wanted}'",
                path="query",
                allowed=", ".join(known[:12]) + (", ..." if len(known) > 12 else ""),
                remedy=former(last)
                or did_you_mean(wanted, [*known, *ends])
                or "moyai query without further options lists them all",
            )
        if len(near) > 1:
            raise InputError(f"'{wanted}' is the name of {len(near)} responses", path="query", allowed=", ".join(near))
        written = near[0] + (f"[{','.join(f'{dim}={label}' for dim, label in labels)}]" if labels else "")
        return written, selected(everything[near[0]], labels, text)

    def where(self, text: str) -> NDArray[np.bool_]:
        """Return which cases a condition holds for: ``significant_height > 0.6 m``, ``lost_line = intact``.

        Parameters
        ----------
        text : str
            Name, comparison, and value with a unit.

        Returns
        -------
        ndarray of bool (cases,)
            True where it holds.

        Raises
        ------
        InputError
            When the condition cannot be read.
        """
        # Brackets hold labels, whose '=' is no comparison
        bare = re.sub(r"\[[^\]]*\]", lambda found: "_" * len(found[0]), text)
        found = re.search(r"<=|>=|!=|==|=|<|>|~", bare)
        left = text[: found.start()].strip() if found else ""
        right = text[found.end() :].strip().strip("'\"") if found else ""
        if found is None or not left or not right:
            raise InputError(
                f"'{text}' is no condition",
                path="--where",
                allowed="NAME = VALUE with =, !=, <, <=, >, >= or ~ (contains)",
                remedy="for instance --where 'significant_height > 0.6 m' --where 'status = failed'",
            )
        sign = "=" if found[0] == "==" else found[0]
        column = self.column(left)
        texts = np.array(column.texts)
        if sign == "~":
            return np.array([right.lower() in one.lower() for one in texts], dtype=bool)
        labelled = column.name in self.names and right in texts
        if sign in ("=", "!=") and (column.values is None or labelled):
            if column.name in self.names and not labelled:
                axis = self.axes[self.names.index(column.name)]["labels"]
                raise InputError(f"'{left}' is never '{right}'", path="--where", allowed=", ".join(map(str, axis[:12])))
            return np.asarray(_COMPARE[sign](texts, right), dtype=bool)
        if column.values is None:
            raise InputError(f"'{left}' is text: it has no order", path="--where", allowed="=, != or ~")
        value = _number(right, left, column.unit)
        if sign in ("=", "!="):
            same = np.isclose(column.values, value, rtol=1e-9, atol=0.0)
            return same if sign == "=" else ~same
        with np.errstate(invalid="ignore"):
            return np.asarray(_COMPARE[sign](column.values, value), dtype=bool)

    @checks_words
    def chosen(self, conditions: Sequence[str], by: str | None, top: int | None, smallest: bool) -> NDArray[np.intp]:
        """Return the numbers of the cases that all conditions hold for, the largest of a response first.

        Parameters
        ----------
        conditions : sequence of str
            As for :meth:`where`.
        by : str or None
            Response that the cases are ordered by; cases without its value are left out. None keeps their order.
        top : int or None
            How many are returned; all for None.
        smallest : bool
            Whether the smallest comes first.

        Raises
        ------
        InputError
            For a condition or response that is not there.
        """
        kept = np.ones(self.count, dtype=bool)
        for text in conditions:
            kept &= self.where(text)
        index = np.flatnonzero(kept)
        if by is not None:
            column = self.column(by)
            if column.values is None:
                raise InputError(f"'{by}' is text: it has no largest", path="--by", remedy="name a response")
            values = column.values[index]
            index = index[np.isfinite(values)]
            order = np.argsort(column.values[index] * (1.0 if smallest else -1.0), kind="stable")
            index = index[order]
        return index[:top] if top is not None else index

    def varying(self, most: int = 4) -> list[str]:
        """Return the watched response, or those that vary most from case to case.

        Parameters
        ----------
        most : int
            How many names at most.
        """
        if self.watch:
            try:
                return [self.column(self.watch).name]
            except InputError:
                pass
        spread = []
        for name in self.responses():
            values = self.column(name).values
            known = values[np.isfinite(values)] if values is not None else np.empty(0)
            if known.size and not name.endswith("probability") and not name.endswith("_peaks"):
                spread.append((-float(np.ptp(known) / (np.abs(known).max() or 1.0)), name))
        return [name for _, name in sorted(spread)[:most]]

    @checks_words
    def pivot(self, rows: str, columns: str, by: str, index: NDArray[np.intp], smallest: bool) -> Array:
        """Return the largest (or smallest) value of a response over two axes; NaN where no case is left.

        Parameters
        ----------
        rows, columns : str
            Two axes of the study.
        by : str
            Response.
        index : ndarray of int (cases,)
            Numbers of the cases that count.
        smallest : bool
            Whether the smallest value is taken.

        Returns
        -------
        ndarray (rows, columns)
            In the unit of the response.

        Raises
        ------
        InputError
            When one of both is no axis.
        """
        for name in (rows, columns):
            if name not in self.names:
                raise InputError(f"the study has no axis '{name}'", path="--pivot", allowed=", ".join(self.names))
        if rows == columns:
            raise InputError(f"'{rows}' twice", path="--pivot", allowed="two axes: ROWS,COLUMNS")
        i, j = self.names.index(rows), self.names.index(columns)
        out = np.full((self.shape[i], self.shape[j]), math.nan)
        values = self.column(by).values
        if values is None:
            raise InputError(f"'{by}' is text", path="--by", remedy="name a response")
        place = np.unravel_index(index, self.shape)
        keep = np.fmin if smallest else np.fmax
        keep.at(out, (place[i], place[j]), values[index])
        return out


def _number(text: str, name: str, unit: str) -> float:
    try:
        quantity = parse_quantity(text)
    except InputError as error:
        raise InputError(
            f"'{text}' is no value of '{name}'", path="--where", remedy=error.fault.remedy or "a number with its unit"
        ) from None
    plain = quantity.unit.symbol == ""
    if not plain and unit not in ("1", ""):
        from moyai.study.axes import si_symbol

        own = si_symbol(quantity.unit.dimension)
        if own != unit:
            raise InputError(f"'{name}' is in {unit}, not in {quantity.unit.symbol}", path="--where", allowed=unit)
    return float(quantity.si)


def read_study_results(path: Path) -> StudyTable:
    """Read the results of a study: its folder, ``study.nc`` or ``study.zarr``.

    Parameters
    ----------
    path : Path
        Of the folder or the file.

    Returns
    -------
    StudyTable
        With a row a case.

    Raises
    ------
    InputError
        When there is nothing of the kind.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> import moyai
    >>> from moyai.study import load_study, read_study_results, run_study
    >>> folder = Path(mkdtemp())
    >>> _ = (folder / "base.yaml").write_text(moyai.template("network"), encoding="utf-8")
    >>> text = "{base: base.yaml, set: {analyses: [statics]}, variations: [{grid: {current.speed: [0.5, 1.0]}}]}"
    >>> _ = (folder / "study.yaml").write_text(f"moyai: 1\\nstudy: {text}\\n", encoding="utf-8")
    >>> result = run_study(load_study(folder / "study.yaml"), folder / "out", moyai.run, workers=1)
    >>> _ = result.write(folder / "out" / "study.nc")
    >>> read_study_results(folder / "out").names
    ['speed']
    """
    from moyai.core.results import read_result
    from moyai.study.zarr_file import read_zarr

    if path.is_dir() and path.suffix != ".zarr" and not (path / "zarr.json").exists():
        inside = [path / "study.nc", path / "study.zarr"]
        found = next((one for one in inside if one.exists()), None)
        if found is None:
            begun = (path / "study.jsonl").exists()
            remedy = "no case was gathered yet: run the study on" if begun else "run 'moyai study FILE' first"
            raise InputError(f"{path} holds no results of a study (study.nc)", path="results", remedy=remedy)
        path = found
    if path.is_dir():
        return StudyTable(read_zarr(path))
    if path.suffix.lower() in (".yaml", ".yml"):
        folder = Path("out") / path.stem
        raise InputError(f"{path} is a study, not its results", path="results", remedy=f"moyai query {folder}")
    return StudyTable(read_result(path).tree)
