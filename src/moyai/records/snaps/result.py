"""From the findings of flume runs to a result: tensions, numbers, models, agreement, powers, curves."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from moyai.core.results import Result, Status, make_provenance
from moyai.core.vocabulary import Vocabulary
from moyai.records.snaps.curves import model_curves
from moyai.records.snaps.model import SnapFinding, SnapFindings
from moyai.records.snaps.run import NUMBERS, similarity
from moyai.structures.curtain.impact.cable import impact_numbers
from moyai.structures.curtain.impact.compare import ModelTension

if TYPE_CHECKING:
    import xarray as xr

# name: (units, long name)
VARIABLES: dict[str, tuple[str, str]] = {
    "current_speed": ("m/s", "speed of the current"),
    "start_speed": ("m/s", "speed of the curtain when it becomes taut, of the models"),
    "draught": ("m", "depth of the skirt d"),
    "length": ("m", "unstretched length l along the span"),
    "froude": ("1", "Froude number U/sqrt(gh)"),
    "span_ratio": ("1", "span ratio B/l"),
    "depth_ratio": ("1", "depth of the skirt over that of the water, d/h"),
    "cauchy": ("1", "stiffness number C_E = sqrt(EA/rho)/(h sqrt(gh))"),
    "cable_peak_tension": ("N", "largest tension of the cable"),
    "cable_plateau_tension": ("N", "drag level of the cable"),
    "cable_impact_tension": ("N", "peak of the cable less its drag level"),
    "cable_noise": ("N", "standard deviation of the noise of the cable"),
    "rise_time": ("s", "from taut to peak"),
    "peak_missed": ("1", "largest share of the peak that sampling may have missed"),
    "tension_coefficient": ("1", "C_T of the record, impact over rho U^2 B d/2"),
    "model_tension": ("N", "impact tension of the model, both cables"),
    "model_upper_tension": ("N", "impact tension of the model, upper cable"),
    "model_lower_tension": ("N", "impact tension of the model, lower cable"),
    "model_tension_coefficient": ("1", "C_T of the model"),
    "ratio": ("1", "model over record, geometric mean of the runs"),
    "ratio_low": ("1", "lower bound of 95 % of that mean"),
    "ratio_high": ("1", "upper bound of 95 % of that mean"),
    "scatter": ("1", "standard deviation of the logarithm of model over record"),
    "exponent": ("1", "power of the number in C_T"),
    "exponent_low": ("1", "lower bound of 95 % of that power"),
    "exponent_high": ("1", "upper bound of 95 % of that power"),
    "product_scatter": ("1", "standard deviation of the logarithm of C_T about the product of powers"),
    "curve_number": ("1", "number along the curve"),
    "curve_coefficient": ("1", "C_T of model A along the curve"),
}
VOCABULARY = Vocabulary.of(
    "snap_runs",
    VARIABLES,
    labels={
        "cable_material": "material of the cables",
        "cable": "cable",
        "impact_model": "impact model",
        "number": "similarity number",
        "fit_of": "record or model whose C_T is fitted",
        "curve": "curve",
        "curve_of": "number that varies along the curve",
        "curve_cable": "material whose runs give the other numbers",
        "record_file": "file of the record",
    },
    always={
        "/runs": ("both_cables_impact_tension", "tension_coefficient", "froude", "span_ratio", "depth_ratio", "cauchy")
    },
)


def _runs(findings: SnapFindings) -> xr.Dataset:
    import xarray as xr

    found = findings.found
    models = [item.model for item in findings.agreements]
    cables = [cable.name for cable in found[0].run.record.cables]
    numbers = np.array([similarity(item.run.impact) for item in found])
    tension = np.array([[item.comparison.tension(model) for model in models] for item in found])
    each = {
        "current_speed": [item.run.impact.speed for item in found],
        "start_speed": [item.start_speed for item in found],
        "draught": [item.run.impact.draught for item in found],
        "length": [item.run.impact.length for item in found],
        "both_cables_peak_tension": [item.run.record.total.peak for item in found],
        "both_cables_plateau_tension": [item.run.record.total.plateau for item in found],
        "both_cables_impact_tension": [item.run.record.total.impact for item in found],
        "rise_time": [item.run.record.rise_time for item in found],
        "peak_missed": [item.run.record.peak_missed for item in found],
        "tension_coefficient": [item.numbers.tension_coefficient for item in found],
        **dict(zip(NUMBERS, numbers.T, strict=True)),
    }
    by_cable = {
        f"cable_{name}": (
            ("run", "cable"),
            [[_of_cable(item, cable, attribute) for cable in cables] for item in found],
        )
        for name, attribute in (
            ("peak_tension", "peak"),
            ("plateau_tension", "plateau"),
            ("impact_tension", "impact"),
            ("noise", "noise"),
        )
    }
    by_model = {
        "model_tension": tension,
        "model_upper_tension": [[_line(item, model).upper_tension for model in models] for item in found],
        "model_lower_tension": [[_line(item, model).lower_tension for model in models] for item in found],
        "model_tension_coefficient": [
            [impact_numbers(item.run.impact, float(value)).tension_coefficient for value in row]
            for item, row in zip(found, tension, strict=True)
        ],
    }
    return xr.Dataset(
        {
            **{name: ("run", values) for name, values in each.items()},
            **by_cable,
            **{name: (("run", "impact_model"), values) for name, values in by_model.items()},
        },
        coords={
            "run": [item.run.name for item in found],
            "cable_material": ("run", [item.run.cable for item in found]),
            "record_file": ("run", [item.run.record.file for item in found]),
            "cable": cables,
            "impact_model": models,
        },
    )


def _of_cable(item: SnapFinding, name: str, attribute: str) -> float:
    found = {cable.name: cable for cable in item.run.record.cables}
    return float(getattr(found[name], attribute)) if name in found else float("nan")


def _line(item: SnapFinding, model: str) -> ModelTension:
    return next(line for line in item.comparison.models if line.model == model)


def _agreement(findings: SnapFindings) -> xr.Dataset:
    import xarray as xr

    rows = findings.agreements
    data = {
        "ratio": [row.ratio for row in rows],
        "ratio_low": [row.low for row in rows],
        "ratio_high": [row.high for row in rows],
        "scatter": [row.scatter for row in rows],
    }
    return xr.Dataset(
        {name: ("impact_model", values) for name, values in data.items()},
        coords={"impact_model": [row.model for row in rows]},
    )


def _powers(findings: SnapFindings) -> xr.Dataset:
    import xarray as xr

    rows = findings.exponents
    dims = ("fit_of", "number")
    return xr.Dataset(
        {
            "exponent": (dims, [row.values for row in rows]),
            "exponent_low": (dims, [row.low for row in rows]),
            "exponent_high": (dims, [row.high for row in rows]),
            "product_scatter": ("fit_of", [row.scatter for row in rows]),
        },
        coords={"fit_of": [row.of for row in rows], "number": list(rows[0].names)},
    )


def _curves(findings: SnapFindings) -> xr.Dataset:
    import xarray as xr

    curves = model_curves(findings.found)
    return xr.Dataset(
        {
            "curve_number": (("curve", "point"), [curve.x for curve in curves]),
            "curve_coefficient": (("curve", "point"), [curve.coefficient for curve in curves]),
        },
        coords={
            "curve": np.arange(1, len(curves) + 1),
            "curve_of": ("curve", [curve.number for curve in curves]),
            "curve_cable": ("curve", [curve.cable for curve in curves]),
        },
    )


def snap_runs_result(findings: SnapFindings, *, text: str = "") -> Result:
    """Return the result that is written and reported.

    Parameters
    ----------
    findings : SnapFindings
    text : str
        Text of the file.
    """
    import xarray as xr

    title = findings.runs.title
    root = xr.Dataset(
        attrs={"structure": "snap_runs", "title": title, "case_text": text, "origin": findings.runs.origin}
    )
    groups = {
        "/": root,
        "/runs": _runs(findings),
        "/agreement": _agreement(findings),
        "/powers": _powers(findings),
        "/curves": _curves(findings),
    }
    grave = [notice for notice in findings.notices if notice.severity == "error"]
    status: Status = "outside_validity" if grave else "converged"
    described, undeclared = VOCABULARY.close(groups)
    return Result(
        tree=xr.DataTree.from_dict(described),
        status=status,
        message=grave[0].message if grave else f"{len(findings.found)} {findings.runs.origin} runs were read",
        notices=(*findings.notices, *undeclared),
        provenance=make_provenance(title=title, structure="snap_runs", seeds=[]),
    )
