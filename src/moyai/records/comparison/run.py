"""Compare the variables of a result with the columns of a record, along time, period or any other coordinate."""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.kinds import groups_of
from moyai.core.results import Result, make_provenance
from moyai.core.units import parse_unit
from moyai.core.validity import Notice
from moyai.core.vocabulary import NO_UNIT, Vocabulary, former
from moyai.core.wording import counted
from moyai.records.comparison.model import ModelAgreement, agreement_by_state, overlay
from moyai.records.reading.reader import read_record
from moyai.records.reading.record import Record
from moyai.records.reading.sources import ColumnSource, LoggerSource, TimeSource
from moyai.records.reading.text import find_layout, split_heading

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class Pairing:
    """Which variable of the result belongs to which column of the record."""

    #: Path in the result, for instance ``/SWL/time/storm/sway``, or its name where only one group has it.
    variable: str
    #: Heading in the record without its unit.
    column: str


def pairing_of(text: str, result: Result) -> Pairing:
    """Return the pairing that ``variable=column`` names; where a name holds the sign too, the variable decides.

    Raises
    ------
    InputError
        Without the sign, or where no part before one is a variable of the result.
    """
    variables = _variables(result)
    places = [place for place, letter in enumerate(text) if letter == "="]
    pairs = [(text[:place].strip(), text[place + 1 :].strip()) for place in places]
    pairs = [pair for pair in pairs if all(pair)]
    if not pairs:
        raise InputError(f"'{text}' has no '='", parameter="--pair", allowed="variable=column")
    faults = []
    for variable, column in pairs:
        try:
            _find(variable, variables)
        except InputError as error:
            faults.append(error)
        else:
            return Pairing(variable, column)
    raise faults[0]


def compare_result(
    result: Result,
    path: Path,
    pairings: Sequence[Pairing] = (),
    *,
    coordinate: str = "",
    select: Mapping[str, str] | None = None,
    start: float = 0.0,
    largest_lag: float = 0.0,
    state: str = "",
    edges: Sequence[float] = (),
    decimal: str = ".",
) -> Result:
    """Compare a result with a record.

    Parameters
    ----------
    result : Result
        As ``moyai run`` or ``moyai measure records`` wrote it.
    path : Path
        Text file with headings; units in brackets, absent ones are those of the result.
    pairings : sequence of Pairing
        By default every column whose name a variable of the result has.
    coordinate : str
        Column along which both run; the first by default.
    select : mapping, optional
        Places along other dimensions: ``{"line": "J-1"}``.
    start : float
        Added to the record's coordinate.
    largest_lag : float
        How far the model may be moved to fit best, in units of the coordinate.
    state : str
        Column by whose classes the agreement is also reported, for instance H1/3.
    edges : sequence of float
        Borders of these classes, SI.
    decimal : str
        Decimal sign of the record, "." or ",".

    Returns
    -------
    Result
        One group a pairing with ``coordinate``, ``model``, ``observed``, and the measures of agreement.

    Raises
    ------
    InputError
        With the variables or columns there are.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> import xarray as xr
    >>> from moyai.core import Result
    >>> from moyai.records import compare_result
    >>> gauge = xr.Dataset({"elevation": ("time", [0.0, 0.5, 0.0], {"units": "m"})}, {"time": [0.0, 1.0, 2.0]})
    >>> file = Path(mkdtemp()) / "gauge.csv"
    >>> _ = file.write_text("time [s],elevation [cm]\\n0,0\\n1,40\\n2,0\\n", encoding="utf-8")
    >>> found = compare_result(Result(xr.DataTree.from_dict({"/gauge": gauge})), file)
    >>> next(iter(found.tree.children.values()))["observed"].values.tolist()
    [0.0, 0.4, 0.0]
    """
    import xarray as xr

    variables = _variables(result)
    # Other columns may hold remarks
    wanted = {pairing.column for pairing in pairings} or {key.rsplit("/", 1)[1] for key in variables}
    record, along = _read(path, coordinate, decimal, wanted | ({state} if state else set()))
    record = replace(record, time=record.time + start)
    chosen = list(pairings) or _by_name(record, variables, path)
    groups: dict[str, xr.Dataset] = {}
    notices: list[Notice] = []
    for pairing in chosen:
        name = _find(pairing.variable, variables)
        model, model_along, unit, axis = _values(variables[name], name, along, select or {}, result)
        observed = _column(record, pairing.column, unit, path, notices)
        found = overlay(model_along, model, record.time, observed, largest_lag=largest_lag)
        classes = None
        if state:
            inside = np.searchsorted(record.time, found.time)
            classes = record[state][inside], tuple(edges) or _edges(record[state])
        label = f"{name.strip('/').replace('/', ' ')} against {pairing.column}"
        groups[label.replace("/", " ")] = _group(found, unit, axis, label, classes, record, state)
    described, undeclared = VOCABULARY.close({f"/{name}": dataset for name, dataset in groups.items()})
    tree = xr.DataTree.from_dict(described)
    title = str(result.tree.attrs.get("title", "")) or "result"
    tree.attrs = {"title": f"{title} against {path.name}", "structure": "comparison", "case_text": "", "case_hash": ""}
    message = f"{counted(len(groups), 'variable')} compared with {path.name}"
    case_hash = str(result.tree.attrs.get("case_hash", ""))
    provenance = make_provenance(title=tree.attrs["title"], record=path.name, compared_case=case_hash)
    return Result(tree, "converged", message, (), (*notices, *undeclared), provenance)


def _read(path: Path, coordinate: str, decimal: str, wanted: Set[str]) -> tuple[Record, str]:
    """Return the wanted columns of the record, its coordinate as time, and the coordinate's name."""
    if not path.is_file():
        raise InputError(f"no such file: {path}", parameter="record")
    probe = LoggerSource("record", (path,), (ColumnSource(1, "x"),), TimeSource((1,)), format="csv", decimal=decimal)
    layout = find_layout(path, probe)
    headings = [split_heading(heading) for heading in layout.headings]
    names = [name for name, _ in headings]
    if not names or all(_is_number(name) for name in names):
        raise InputError(f"{path.name} has no headings", parameter="record", remedy="the first line names the columns")
    if coordinate and coordinate not in names:
        raise InputError(f"{path.name} has no column '{coordinate}'", parameter="coordinate", allowed=", ".join(names))
    place = names.index(coordinate) if coordinate else 0
    others = [i for i in range(len(names)) if i != place and names[i]]
    if not others:
        raise InputError(f"{path.name} has one column only", parameter="record")
    given = ", ".join(names[i] for i in others)
    others = [i for i in others if names[i] in wanted]
    if not others:
        plain = sorted(wanted)
        raise InputError(
            f"no column of {path.name} ({given}) has the name of one variable of the result"
            if len(plain) > 2
            else f"{path.name} has no column '{plain[0]}'",
            parameter="pair",
            allowed=", ".join(plain[:40]) if len(plain) > 2 else given,
            remedy="name pairs: --pair variable=column",
        )
    columns = tuple(
        ColumnSource(i + 1, names[i], "" if headings[i][1] and headings[i][1] not in ("-", "1") else "1")
        for i in others
    )
    # The coordinate may be a period or a number: units of time are turned to seconds here
    unit = headings[place][1]
    scale = 1.0
    if unit:
        try:
            scale = parse_unit(unit).to_si(1)  # type: ignore[arg-type]
        except InputError:
            scale = 1.0
    stated = names[place]
    try:
        number = TimeSource((place + 1,), unit="1")
        record = read_record(LoggerSource("record", (path,), columns, number, format="csv", decimal=decimal))
    except InputError:
        if unit:
            raise
        # A coordinate that is no number may be a date
        stamps = TimeSource((place + 1,), form="iso")
        try:
            return read_record(LoggerSource("record", (path,), columns, stamps, format="csv", decimal=decimal)), stated
        except InputError:
            pass
        raise
    return replace(record, time=record.time * scale), stated


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _variables(result: Result) -> dict[str, Any]:
    out = {}
    for path, group in groups_of(result.tree).items():
        for name, variable in group.data_vars.items():
            if variable.ndim >= 1 and variable.dtype.kind in "fiuc":
                out[f"{path.rstrip('/')}/{name}"] = (variable, group)
    return out


def _by_name(record: Record, variables: Mapping[str, Any], path: Path) -> list[Pairing]:
    out = []
    for name in record.names:
        fitting = [key for key in variables if key.rsplit("/", 1)[1] == name]
        if len(fitting) == 1:
            out.append(Pairing(fitting[0], name))
    if not out:
        plain = sorted({key.rsplit("/", 1)[1] for key in variables})
        raise InputError(
            f"no column of {path.name} ({', '.join(record.names)}) has the name of one variable of the result",
            parameter="pair",
            allowed=", ".join(plain[:40]),
            remedy="name pairs: --pair variable=column",
        )
    return out


def _find(wanted: str, variables: Mapping[str, Any]) -> str:
    if wanted in variables:
        return wanted
    if f"/{wanted.lstrip('/')}" in variables:
        return f"/{wanted.lstrip('/')}"
    fitting = [key for key in variables if key.rsplit("/", 1)[1] == wanted]
    if len(fitting) == 1:
        return fitting[0]
    if len(fitting) > 1:
        raise InputError(
            f"'{wanted}' is in {len(fitting)} groups", parameter="variable", allowed=", ".join(fitting[:20])
        )
    near = difflib.get_close_matches(wanted, list(variables), n=3, cutoff=0.4)
    renamed = former(wanted.rsplit("/", 1)[-1])
    raise InputError(
        f"the result has no variable '{wanted}'",
        parameter="variable",
        allowed=", ".join(list(variables)[:40]),
        remedy=renamed or (f"did you mean {' or '.join(near)}?" if near else ""),
    )


def _values(
    found: Any, name: str, along: str, select: Mapping[str, str], result: Result
) -> tuple[Array, Array, str, str]:
    """Return values, coordinate, unit of the values and a label of the coordinate."""
    variable, node = found
    array = variable
    for dimension, place in select.items():
        if dimension in array.dims:
            labels = [str(value) for value in array[dimension].values]
            if place in labels:
                array = array.isel({dimension: labels.index(place)})
            elif place.lstrip("-").isdigit() and abs(int(place)) < array.sizes[dimension]:
                array = array.isel({dimension: int(place)})
            else:
                raise InputError(
                    f"'{place}' is no entry of {dimension}", parameter="select", allowed=", ".join(labels[:40])
                )
    if array.ndim > 1:
        array = array.squeeze()
    if array.ndim != 1:
        raise InputError(
            f"'{name}' runs along {', '.join(map(str, array.dims))}",
            parameter="select",
            remedy=f"choose with --select {array.dims[-1]}=...",
        )
    dimension = str(array.dims[0])
    candidates = [
        key for key, coordinate in {**node.coords, **node.data_vars}.items() if coordinate.dims == (dimension,)
    ]
    order = [key for key in (along, dimension, "time", "period", "omega") if key in candidates]
    if not order:
        raise InputError(f"'{name}' has no coordinate along {dimension}", parameter="coordinate")
    stored = np.asarray(node[order[0]].values)
    dated = stored.dtype.kind == "M"
    coordinate = np.asarray(
        stored.astype("datetime64[ns]").astype(np.int64) * 1e-9 if dated else stored, dtype=np.float64
    )
    values = np.asarray(array.values)
    values = np.asarray(np.abs(values) if np.iscomplexobj(values) else values, dtype=np.float64)
    if coordinate.size > 1 and coordinate[0] > coordinate[-1]:
        coordinate, values = coordinate[::-1].copy(), values[::-1].copy()
    label = str(node[order[0]].attrs.get("long_name", order[0]))
    return values, coordinate, str(variable.attrs.get("units", "")), label


def _column(record: Record, name: str, unit: str, path: Path, notices: list[Notice]) -> Array:
    values = record[name]
    own = record.units[record.index(name)]
    plain = unit if unit not in ("1", "-") else ""
    if own == "" and plain not in ("",):
        notices.append(
            Notice(
                "unit-assumed", f"{path.name}, column '{name}' states no unit: taken as {plain}", severity="information"
            )
        )
        return values
    if own and plain:
        try:
            same = parse_unit(own).dimension.same_but_angle(parse_unit(plain).dimension)
        except InputError:
            same = True  # a unit such as m/m that is no product of units
        if not same:
            raise InputError(f"{path.name}, column '{name}' is in {own} and the variable in {plain}", parameter="unit")
    return values


def _edges(state: Array) -> tuple[float, ...]:
    """Return four classes with equal numbers."""
    known = state[np.isfinite(state)]
    if known.size < 8:
        raise InputError(
            f"{known.size} values of the sea state", parameter="by", allowed="8 or more, or give the edges"
        )
    borders = np.unique(np.quantile(known, [0.0, 0.25, 0.5, 0.75, 1.0]))
    borders[-1] = np.nextafter(borders[-1], math.inf)
    return tuple(float(border) for border in borders)


VOCABULARY = Vocabulary.of(
    "comparison",
    {
        "coordinate": (NO_UNIT, "coordinate"),
        "model": (NO_UNIT, "model"),
        "observed": (NO_UNIT, "record"),
        "agreement": (NO_UNIT, "agreement"),
        "by_state": (NO_UNIT, "agreement by class of the sea state"),
        "state_count": ("1", "pairs of the class"),
    },
    labels={"figure": "measure of the agreement", "state": "class of the sea state"},
)
FIGURES = (
    ("count", "pairs"),
    ("bias", "bias, model minus record"),
    ("rms", "root mean square difference"),
    ("scatter_index", "scatter index"),
    ("correlation", "correlation"),
    ("slope", "slope through the origin, model over record"),
    ("skill", "skill (Nash and Sutcliffe)"),
    ("index_of_agreement", "index of agreement (Willmott)"),
    ("paper_error", "mean of (model - record)/model (Tabata et al.)"),
    ("paper_error_spread", "its root mean square"),
)


def _row(agreement: ModelAgreement | None) -> list[float]:
    if agreement is None:
        return [math.nan] * len(FIGURES)
    return [float(getattr(agreement, key)) for key, _ in FIGURES]


def _group(
    found: Any,
    unit: str,
    axis: str,
    label: str,
    classes: tuple[Array, tuple[float, ...]] | None,
    record: Record,
    state: str,
) -> xr.Dataset:
    import xarray as xr

    data: dict[str, Any] = {
        "coordinate": ("place", found.time, {"long_name": axis}),
        "model": ("place", found.model, {"units": unit}),
        "observed": ("place", found.observed, {"units": unit}),
        "agreement": ("figure", np.array(_row(found.agreement))),
    }
    coordinates: dict[str, Any] = {"figure": np.array([words for _, words in FIGURES], dtype=object)}
    if classes is not None:
        rows = agreement_by_state(found.model, found.observed, *classes)
        data["by_state"] = (("state", "figure"), np.array([_row(entry.agreement) for entry in rows]))
        data["state_count"] = ("state", np.array([float(entry.count) for entry in rows]))
        unit_of_state = record.units[record.index(state)]
        coordinates["state"] = np.array([f"{entry.lower:.4g} to {entry.upper:.4g} {unit_of_state}" for entry in rows],
                                        dtype=object)  # fmt: skip
    dataset = xr.Dataset(data, coordinates)
    dataset.attrs = {"label": label, "lag": found.lag, "state": state, "axis": axis}
    return dataset
