"""Fit values of a case file to observations through the model itself, and write the case that was found."""

from __future__ import annotations

import contextlib
import hashlib
import math
import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from moyai.case.paths import resolve, value_of
from moyai.case.reader import case_of, read_block
from moyai.case.yaml_reader import CaseDocument, KeyPath, read_yaml
from moyai.core.arrays import Array
from moyai.core.errors import CaseError, Fault, InputError
from moyai.core.progress import Progress, silent
from moyai.core.quantities import QuantityKind, check_unit, parse_quantity
from moyai.core.results import Result, make_provenance
from moyai.core.units import parse_unit
from moyai.core.version import VERSION
from moyai.core.wording import counted
from moyai.records.calibration import Calibration, Parameter, calibrate
from moyai.study import fit_schema
from moyai.study.axes import Combination, varied
from moyai.study.definition import RunCase
from moyai.study.responses import find_response, read_response
from moyai.study.rows_of_files import column_of, read_rows
from moyai.study.variations import common_unit


@dataclass(frozen=True)
class ObservationRow:
    """One observation."""

    #: What it sets in the case.
    changes: tuple[tuple[str, Any], ...]
    #: The observation.
    observed: float
    #: Its standard error; NaN where not given.
    error: float
    #: Storm or test.
    group: str


@dataclass(frozen=True)
class StudyFit:
    """A fit that was read and found sound."""

    title: str
    #: With the changes that all rows share.
    base: CaseDocument
    base_path: Path
    #: By path, each with the unit in which it is written.
    parameters: tuple[tuple[Parameter, str], ...]
    rows: tuple[ObservationRow, ...]
    response: str
    bootstrap: int
    seed: int
    step: float
    #: Name and hash of the file of observations.
    source: str
    #: Columns of the observation and of its error with the units of their headings, empty where there are none.
    stated: tuple[tuple[str, str], ...] = ()


def load_fit(path: str | os.PathLike[str]) -> StudyFit:
    """Read a fit file and check that its cases can be built.

    Parameters
    ----------
    path : path-like
        YAML file.

    Returns
    -------
    StudyFit
        What :func:`moyai.study.run_fit` takes.

    Raises
    ------
    CaseError
        With every error at once.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> import moyai
    >>> from moyai.study import load_fit
    >>> folder = Path(mkdtemp())
    >>> _ = (folder / "base.yaml").write_text(moyai.template("network"), encoding="utf-8")
    >>> _ = (folder / "observed.csv").write_text("V [m/s],T [N]\\n0.5,2000\\n1.0,2400\\n1.5,3100\\n", encoding="utf-8")
    >>> text = "moyai: 1\\nfit:\\n  base: base.yaml\\n  set: {analyses: [statics]}\\n"
    >>> text += "  parameters: {'structure.points.buoy.drag_coefficient': {from: 0.1, to: 2}}\\n"
    >>> text += "  observations: {file: observed.csv, columns: {V: current.speed}, observed: T,\\n"
    >>> text += "    response: 'SWL/statics/line_tension_maximum[line=mooring]'}\\n"
    >>> _ = (folder / "fit.yaml").write_text(text, encoding="utf-8")
    >>> len(load_fit(folder / "fit.yaml").rows)
    3
    """
    document = read_yaml(path)
    block: fit_schema.FitBlock = read_block(document, fit_schema.FitFile).fit
    folder = Path(path).parent
    base_path = folder / block.base
    if not base_path.exists():
        raise CaseError([document.fault(("fit", "base"), f"no such file: {base_path}")])
    faults: list[Fault] = []

    def tell(error: InputError, *place: str) -> None:
        fault = error.fault
        faults.append(document.fault(("fit", *place), fault.message, allowed=fault.allowed, remedy=fault.remedy))

    base = read_yaml(base_path)
    case_of(base, base_path)
    try:
        base = varied(base, Combination(-1, (), tuple(block.set.items())))
    except InputError as error:
        tell(error, "set")
    base = _one_level(base, block)
    parameters = []
    for name, unknown in block.parameters.items():
        try:
            parameters.append(_parameter(base.data, name, unknown))
        except InputError as error:
            tell(error, "parameters", name)
    rows: tuple[ObservationRow, ...] = ()
    try:
        rows = _rows(block.observations, base.data, folder, set(block.parameters))
    except InputError as error:
        tell(error, "observations")
    original = read_yaml(base_path)
    for name in block.parameters:
        try:
            for place in resolve(original.data, name):
                _replace(original.text.splitlines(), original, place, "0")
        except InputError as error:
            tell(error, "parameters", name)
    if faults:
        raise CaseError(faults)
    given = block.observations
    file = folder / given.file
    digest = hashlib.sha256(file.read_bytes()).hexdigest()[:12]
    fit = StudyFit(
        block.title, base, base_path, tuple(parameters), rows, given.response, block.bootstrap,
        block.seed, block.step, f"{file.name} (sha256 {digest})",
        tuple(column_of(read_rows(file), column, file) for column in (given.observed, given.error) if column),
    )  # fmt: skip
    for row in fit.rows[:: max(1, len(fit.rows) // 20)]:
        case_of(_document(fit, np.array([item.start for item, _ in fit.parameters]), row), fit.base_path)
    return fit


def run_fit(fit: StudyFit, run: RunCase, progress: Progress = silent) -> tuple[Result, Calibration]:
    """Fit and gather what was found.

    Parameters
    ----------
    fit : StudyFit
        As :func:`moyai.study.load_fit` reads it.
    run : callable
        ``run(case, progress)``.
    progress : Progress
        Called after every run.

    Returns
    -------
    result : Result
        Its group ``/fit`` holds parameters, covariance, observations and predictions.
    found : Calibration
        Values with their errors.

    Raises
    ------
    InputError
        When a case fails inside the bounds.
    ConvergenceError
        When the fit does not settle.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> import moyai
    >>> from moyai.study import load_fit, run_fit
    >>> folder = Path(mkdtemp())
    >>> _ = (folder / "base.yaml").write_text(moyai.template("network"), encoding="utf-8")
    >>> _ = (folder / "observed.csv").write_text("V [m/s],T [N]\\n0.5,2000\\n1.0,2400\\n1.5,3100\\n", encoding="utf-8")
    >>> text = "moyai: 1\\nfit:\\n  base: base.yaml\\n  set: {analyses: [statics]}\\n"
    >>> text += "  parameters: {'structure.points.buoy.drag_coefficient': {from: 0.1, to: 2}}\\n"
    >>> text += "  observations: {file: observed.csv, columns: {V: current.speed}, observed: T,\\n"
    >>> text += "    response: 'SWL/statics/line_tension_maximum[line=mooring]'}\\n"
    >>> _ = (folder / "fit.yaml").write_text(text, encoding="utf-8")
    >>> result, found = run_fit(load_fit(folder / "fit.yaml"), moyai.run)
    >>> found.values.round(2).tolist()                               # C_D of the buoy
    [1.27]
    """
    known: dict[tuple[float, ...], Array] = {}
    unit = ["1"]

    def model(values: Array) -> Array:
        key = tuple(map(float, values))
        if key not in known:
            out, stage = [], f"fit, trial {len(known) + 1}"
            for number, row in enumerate(fit.rows):
                progress(stage, number, len(fit.rows))
                value, unit[0] = _predict(fit, run, values, row)
                if not known and number == 0:
                    _check_units(fit, unit[0])
                out.append(value)
            progress(stage, len(fit.rows), len(fit.rows))
            if not known and len(set(out)) == 1 < len({row.changes for row in fit.rows}):
                raise InputError(
                    f"'{fit.response}' is {out[0]:.4g} for every row, whatever the columns set",
                    path="fit.observations.response",
                    remedy="name the sea, period or label that the columns change",
                )
            known[key] = np.array(out)
        return known[key]

    errors = np.array([row.error for row in fit.rows])
    groups = [row.group for row in fit.rows]
    found = calibrate(
        model,
        [row.observed for row in fit.rows],
        [item for item, _ in fit.parameters],
        error=errors if np.isfinite(errors).all() else None,
        groups=groups if len(set(groups)) > 1 else None,
        bootstrap=fit.bootstrap,
        seed=fit.seed,
        step=fit.step,
        progress=progress,
    )
    return _result(fit, found, unit[0]), found


def _check_units(fit: StudyFit, unit: str) -> None:
    """Refuse observations in units that the response cannot have."""
    wrong = None
    if "roll" in fit.response:  # an array of motions states metres, and roll stands in radians
        return
    with contextlib.suppress(InputError):  # a unit such as m/m is no product of units: nothing to compare
        dimension = parse_unit(unit).dimension
        response = QuantityKind(f"the response '{fit.response}'", unit, "", "")
        units = [(column, parse_unit(stated)) for column, stated in fit.stated if stated]
        wrong = next(((column, one) for column, one in units if one.dimension != dimension), None)
    if wrong is not None:
        place = f"{fit.source.rsplit(' (', 1)[0]}, column '{wrong[0]}'"
        check_unit(wrong[1], (response,), place, "fit.observations.observed")


def _predict(fit: StudyFit, run: RunCase, values: Array, row: ObservationRow) -> tuple[float, str]:
    """Return the response of a row with its unit."""
    try:
        result = run(case_of(_document(fit, values, row), fit.base_path), silent)
    except CaseError as error:
        reported = ", ".join(
            f"{item.name} = {value:g} {item.unit}".strip() for (item, _), value in zip(fit.parameters, values)
        )
        raise InputError(
            f"the case is refused at {reported}: {error.faults[0].message}", path="fit", remedy="narrow the bounds"
        ) from None
    if result.status == "interrupted":
        raise KeyboardInterrupt
    unit = str(find_response(result.tree, fit.response).attrs.get("units", "1"))
    return read_response(result.tree, fit.response), unit


def _one_level(base: CaseDocument, block: fit_schema.FitBlock) -> CaseDocument:
    """Return the base with the one water level that the response names: the others give nothing that is read."""
    site = base.data.get("site")
    levels = site.get("water_levels") if isinstance(site, dict) else None
    name = block.observations.response.split("/", 1)[0]
    paths = (*block.parameters, *block.observations.columns.values())
    if not isinstance(levels, dict) or name not in levels or any("water_levels" in path for path in paths):
        return base
    return varied(base, Combination(-1, (), (("site.water_levels", {name: levels[name]}),)))


def _document(fit: StudyFit, values: Array, row: ObservationRow) -> CaseDocument:
    changes = [(item.name, _written(float(value), unit)) for (item, unit), value in zip(fit.parameters, values)]
    return varied(fit.base, Combination(0, (), (*changes, *row.changes)))


def _written(value: float, unit: str) -> Any:
    return f"{value!r} {unit}" if unit else value


def _parameter(data: Any, name: str, unknown: fit_schema.Unknown) -> tuple[Parameter, str]:
    low, high, unit = common_unit(unknown.first, unknown.last, name)
    if not low < high:
        raise InputError(f"the range at '{name}' is empty", remedy="give the smaller value first")
    start = unknown.start if unknown.start is not None else value_of(data, resolve(data, name)[0])
    if start is None:
        guess = 0.5 * (low + high)
    elif isinstance(start, (int, float)) and not isinstance(start, bool):
        # A plain number in the case is in SI
        guess = parse_quantity(f"1 {unit}").unit.from_si(float(start)) if unit and unit != "deg" else float(start)
    else:
        _, guess, _ = common_unit(unknown.first, start, name)
    if not low <= guess <= high:
        raise InputError(
            f"the first guess {guess:g} {unit}".strip() + " is outside of the range",
            allowed=f"{low:g} to {high:g} {unit}".strip(),
        )
    return Parameter(name, guess, low, high, unit), unit


def _rows(given: fit_schema.Observations, data: Any, folder: Path, unknown: set[str]) -> tuple[ObservationRow, ...]:
    from moyai.case.yaml_reader import core_scalar

    file = folder / given.file
    table = read_rows(file)
    needed = [*given.columns, given.observed, *(word for word in (given.error, given.group) if word)]
    heads = {column: column_of(table, column, file) for column in needed}
    for path in given.columns.values():
        resolve(data, path)
        if path in unknown:
            raise InputError(f"'{path}' is both fitted and set by the observations", remedy="leave one out")
    rows = []
    for number, row in enumerate(table, start=2):
        changes = []
        for column, path in given.columns.items():
            heading, own = heads[column]
            text, unit = (row[heading] or "").strip(), given.units.get(column, own)
            if not text:
                raise InputError(f"{file.name}, row {number}: column '{column}' is empty")
            changes.append((path, f"{text} {unit}" if unit else core_scalar(text)))
        observed = _number(row, heads[given.observed], file, number)
        error = _number(row, heads[given.error], file, number) if given.error else math.nan
        if given.error and not error > 0.0:
            raise InputError(f"{file.name}, row {number}: the error {error:g} is not above zero")
        rows.append(
            ObservationRow(
                tuple(changes), observed, error, (row[heads[given.group][0]] or "").strip() if given.group else ""
            )
        )
    return tuple(rows)


def _number(row: dict[str, str], head: tuple[str, str], file: Path, number: int) -> float:
    """Return a number of a row, in SI where its heading has a unit."""
    text = row[head[0]]
    try:
        value = float((text or "").strip())
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(f"{file.name}, row {number}, column '{head[0]}': '{text}' is no number")
    return value * parse_quantity(f"1 {head[1]}").si if head[1] else value


def _result(fit: StudyFit, found: Calibration, unit: str) -> Result:
    import xarray as xr

    names = [item.name for item, _ in fit.parameters]
    units = ", ".join(f"{item.name} [{unit or '1'}]" for item, unit in fit.parameters)
    data: dict[str, Any] = {
        "value": (("parameter",), found.values, {"units": units, "long_name": "value found"}),
        "standard_error": (("parameter",), found.errors, {"units": units, "long_name": "standard error"}),
        "lower": (("parameter",), found.interval[:, 0], {"units": units, "long_name": "lower end of 95 %"}),
        "upper": (("parameter",), found.interval[:, 1], {"units": units, "long_name": "upper end of 95 %"}),
        "unit": (("parameter",), [unit for _, unit in fit.parameters]),
        "correlation": (
            ("parameter", "other_parameter"),
            _correlation(found.covariance),
            {"units": "1", "long_name": "correlation of the errors of two values"},
        ),
        "observed": (
            ("row",),
            [row.observed for row in fit.rows],
            {"units": unit, "long_name": f"observed {fit.response}"},
        ),
        "predicted": (("row",), found.prediction, {"units": unit, "long_name": f"predicted {fit.response}"}),
        "bias": ((), found.bias, {"units": unit, "long_name": "mean of prediction less observation"}),
        "rms": ((), found.rms, {"units": unit, "long_name": "root mean square of prediction less observation"}),
        "evaluations": ((), float(found.evaluations), {"units": "1", "long_name": "calls of the model"}),
    }
    coords: dict[str, Any] = {"parameter": names, "other_parameter": names, "row": np.arange(1, len(fit.rows) + 1)}
    tree = {"/": xr.Dataset(), "/fit": xr.Dataset(data, coords=coords)}
    if found.left_out:
        left = found.left_out
        tree["/left out"] = xr.Dataset(
            {
                "value_without": (("group", "parameter"), [one.values for one in left], {"units": units}),
                "bias_of_group": (("group",), [one.bias for one in left], {"units": unit}),
                "rms_of_group": (("group",), [one.rms for one in left], {"units": unit}),
            },
            coords={"group": [one.group for one in left], "parameter": names},
        )
    out = xr.DataTree.from_dict(tree)
    out.attrs.update({"structure": "fit", "title": fit.title, "case_text": fit.base.text})
    message = f"{counted(len(names), 'parameter')} from {counted(len(fit.rows), 'observation')}"
    provenance = make_provenance(title=fit.title, base=fit.base_path.name, observations=fit.source)
    return Result(out, message=message, provenance=provenance).with_notices(*found.notices)


def _correlation(covariance: Array) -> Array:
    """Return the correlations of a covariance; NaN where a value has no finite error."""
    spread = np.sqrt(np.diag(covariance))
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(covariance / np.outer(spread, spread))


def fitted_text(fit: StudyFit, found: Calibration) -> str:
    """Return the text of the case with the values that were found, comments and layout kept.

    Every value stands with as many digits as its standard error allows; the heading says where they come from.
    """
    original = read_yaml(fit.base_path)
    text = original.text
    lines = text.splitlines()
    heading = [f"# Fitted by moyai {VERSION} to {fit.source}, response {fit.response}:"]
    for number, (item, unit) in enumerate(fit.parameters):
        value, error = float(found.values[number]), float(found.errors[number])
        shown = _rounded(value, error)
        heading.append(f"#   {item.name} = {shown} {unit}".rstrip() + f", standard error {error:.2g}")
        for place in resolve(original.data, item.name):
            lines = _replace(lines, original, place, f"{shown} {unit}".strip())
    return "\n".join([*heading, *lines]) + "\n"


def _rounded(value: float, error: float) -> str:
    """Return the value with two digits beyond the first of its error."""
    if not (math.isfinite(error) and error > 0.0) or value == 0.0:
        return f"{value:.10g}"
    digits = max(2, math.ceil(math.log10(abs(value) / error)) + 3)
    return f"{value:.{min(digits, 15)}g}"


def _replace(lines: list[str], document: CaseDocument, place: KeyPath, new: str) -> list[str]:
    """Return the lines with the scalar at a place replaced; a key that is not there is set in a block of its parent."""
    if place not in document.values:
        raise InputError(
            f"'{place[-1]}' is not in the case file, so its value cannot be written there",
            path=str(place[-1]),
            remedy="write it into the case with any value first",
        )
    at = document.values[place]
    line = lines[at.line - 1]
    head, tail = line[: at.column - 1], line[at.column - 1 :]
    found = re.match(r"""'(?:[^']|'')*'|"(?:[^"\\]|\\.)*"|[^,}\]#]+?(?=\s*(?:[,}\]]|\s#|$))""", tail)
    if found is None:
        raise InputError(f"line {at.line} of the case cannot be rewritten", path=str(place[-1]))
    return [*lines[: at.line - 1], head + new + tail[found.end() :], *lines[at.line :]]
