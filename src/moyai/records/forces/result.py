"""From an identification to a result: coefficients with their uncertainty, fits and residuals, bootstrap samples."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.results import Result, Status, make_provenance
from moyai.core.validity import IdentityCheck
from moyai.core.vocabulary import Vocabulary
from moyai.records.forces.fit import COEFFICIENTS
from moyai.records.forces.identification import Coefficient, Identification

if TYPE_CHECKING:
    import xarray as xr

# name: (units, long name)
VARIABLES: dict[str, tuple[str, str]] = {
    "force": ("N/m", "force per length"),
    "velocity": ("m/s", "velocity of the water"),
    "acceleration": ("m/s2", "acceleration of the water"),
    "fitted_force": ("N/m", "force by the fit"),
    "residual": ("N/m", "force less fit"),
    "value": ("1", "coefficient"),
    "low": ("1", "lower end of the interval"),
    "high": ("1", "upper end of the interval"),
    "statistical_half_width": ("1", "half width by the bootstrap"),
    "phase_half_width": ("1", "half width by the phase error"),
    "phase_sensitivity": ("1/rad", "change per radian of phase error"),
    "known": ("1", "1 where the coefficient is determined"),
    "correlation": ("1", "correlation between C_M and C_D"),
    "condition": ("1", "condition number of the scaled equations"),
    "explained": ("1", "share of the variance explained"),
    "drag_share": ("1", "amplitude of drag over inertia force"),
    "sample": ("1", "bootstrap samples of the coefficients"),
    "keulegan_carpenter": ("1", "Keulegan-Carpenter number u T / b"),
    "inertia_reduction": ("1", "ideal less found inertia coefficient"),
    "equivalent_gamma": ("1", "gamma of the circulation equivalent to the reduction"),
    "equivalent_gamma_half_width": ("1", "half width of that gamma, from that of C_M"),
    "residual_deviation": ("N/m", "standard deviation of the residual"),
    "component": ("1", "number of the component"),
}
VOCABULARY = Vocabulary.of(
    "force_record", VARIABLES, labels={"fit_method": "method of the fit", "coefficient": "coefficient"}
)
_labelled = VOCABULARY.describe


def identification_dataset(found: Identification) -> xr.Dataset:
    """Return coefficients by method, component and coefficient."""
    import xarray as xr

    methods, components = found.setup.methods, found.record.components
    shape = (len(methods), components, len(COEFFICIENTS))
    dims = ("fit_method", "component", "coefficient")
    names = ("value", "low", "high", "statistical_half_width", "phase_half_width", "phase_sensitivity", "known")
    arrays = {name: np.full(shape, np.nan) for name in names}
    scalars = {
        name: np.full(shape[:2], np.nan)
        for name in ("correlation", "condition", "explained", "drag_share", "residual_deviation")
    }
    samples = np.full((*shape, found.setup.bootstrap), np.nan)
    for i, method in enumerate(methods):
        for c in range(components):
            fit = found.fit(method, c)
            for k, coefficient in enumerate((fit.inertia, fit.drag)):
                for name, number in zip(names, _numbers(coefficient)):
                    arrays[name][i, c, k] = number
            for name in ("correlation", "condition", "explained", "drag_share"):
                scalars[name][i, c] = getattr(fit, name)
            scalars["residual_deviation"][i, c] = float(fit.residual.std())
            samples[i, c] = fit.samples.T
    data = {
        **{name: (dims, values) for name, values in arrays.items()},
        **{name: (dims[:2], values) for name, values in scalars.items()},
        "sample": ((*dims, "draw"), samples),
        "keulegan_carpenter": ("component", np.asarray(found.keulegan_carpenter)),
        **_reduction(found, arrays["value"][:, :, 0], (arrays["high"] - arrays["value"])[:, :, 0]),
    }
    dataset = xr.Dataset(
        data,
        coords={
            "fit_method": list(methods),
            "component": np.arange(1, components + 1),
            "coefficient": list(COEFFICIENTS),
        },
        attrs={"period": found.period, "blocks": found.blocks, "form": found.setup.form},
    )
    return _labelled(dataset)


def _numbers(item: Coefficient) -> tuple[float, ...]:
    spread = item.uncertainty
    return (
        item.value,
        item.value - spread,
        item.value + spread,
        item.half_width,
        item.phase_half_width,
        item.phase_sensitivity,
        float(item.known),
    )


def _reduction(
    found: Identification, inertia: np.ndarray, spread: np.ndarray
) -> dict[str, tuple[tuple[str, ...], np.ndarray]]:
    """Return the fall of C_M and the gamma that it stands for [eq:identification-gamma]."""
    ideal = found.setup.ideal_inertia
    if ideal is None:
        return {}
    fall = np.asarray(ideal)[None, :] - inertia
    out: dict[str, tuple[tuple[str, ...], np.ndarray]] = {"inertia_reduction": (("fit_method", "component"), fall)}
    if found.record.components == 2 and found.setup.regular:
        speed = found.velocity_amplitude
        other = speed[::-1] / speed
        # Gamma = omega A fall v_own / v_other, and Gamma = gamma v_x v_y T
        scale = 2.0 * math.pi / found.period * found.setup.area / other / (speed.prod() * found.period)
        out["equivalent_gamma"] = (("fit_method", "component"), fall * scale)
        # gamma falls with C_M in proportion: the same uncertainty, scaled
        out["equivalent_gamma_half_width"] = (("fit_method", "component"), spread * scale)
    return out


def record_dataset(found: Identification) -> xr.Dataset:
    """Return the record with every fit and its residual."""
    import xarray as xr

    shape = (len(found.setup.methods), found.record.components)
    fitted = np.array([[found.fit(m, c).force for c in range(shape[1])] for m in found.setup.methods])
    left = np.array([[found.fit(m, c).residual for c in range(shape[1])] for m in found.setup.methods])
    dims = ("fit_method", "component", "time")
    return _labelled(
        xr.Dataset(
            {
                "force": (("time", "component"), found.record.force),
                "velocity": (("time", "component"), found.record.velocity),
                "acceleration": (("time", "component"), found.acceleration),
                "fitted_force": (dims, fitted),
                "residual": (dims, left),
            },
            coords={
                "time": found.record.time,
                "component": np.arange(1, shape[1] + 1),
                "fit_method": list(found.setup.methods),
            },
        )
    )


def identification_result(found: Identification, *, title: str, text: str = "", source: str = "") -> Result:
    """Return the result that is written and reported.

    Parameters
    ----------
    found : Identification
    title : str
        Of the report.
    text : str
        Text of the configuration.
    source : str
        Name of the record.
    """
    import xarray as xr

    root = xr.Dataset(attrs={"structure": "force_record", "title": title, "case_text": text, "record": source})
    checks = []
    for fit in found.fits:
        scale = float(np.abs(found.record.force[:, fit.component]).max()) or 1.0
        gap = float(np.abs(fit.force + fit.residual - found.record.force[:, fit.component]).max()) / scale
        checks.append(
            IdentityCheck(f"{fit.method}, component {fit.component + 1}: fit and residual", gap, 1e-10, "sum to force")
        )
    grave = [notice for notice in found.notices if notice.severity == "error"]
    status: Status = "outside_validity" if grave else "converged"
    groups, undeclared = VOCABULARY.close(
        {"/": root, "/coefficients": identification_dataset(found), "/record": record_dataset(found)}
    )
    return Result(
        tree=xr.DataTree.from_dict(groups),
        status=status,
        message=grave[0].message if grave else "all fits were made",
        checks=tuple(checks),
        notices=(*found.notices, *undeclared),
        provenance=make_provenance(title=title, structure="force_record", seeds=[found.setup.seed]),
    )
