"""From the findings of a campaign of nets to the result that is written and reported."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.results import Result, Status, make_provenance
from moyai.core.validity import IdentityCheck
from moyai.core.vocabulary import Vocabulary
from moyai.core.wording import counted
from moyai.records.nets.campaign import NetFindings
from moyai.records.nets.regression import TERMS

if TYPE_CHECKING:
    import xarray as xr

# name: (units, long name)
VARIABLES: dict[str, tuple[str, str]] = {
    "density": ("1", "spectral density of the force over its median"),
    "background": ("1", "smooth spectrum about each frequency"),
    "speed": ("m/s", "speed of towing"),
    "reynolds": ("1", "Reynolds number U d / nu"),
    "keulegan_carpenter": ("1", "Keulegan-Carpenter number u T / d"),
    "frame_force": ("N", "force on the bare frame, subtracted"),
    "drag": ("1", "drag coefficient on the area of the twines"),
    "drag_half_width": ("1", "half width of its interval"),
    "drag_error": ("1", "standard error of the drag coefficient"),
    "drag_known": ("1", "1 where the drag coefficient is determined"),
    "freedom": ("1", "effective degrees of freedom"),
    "lift": ("1", "lift coefficient on the area of the twines"),
    "lift_half_width": ("1", "half width of its interval"),
    "inertia": ("1", "inertia coefficient on the volume of the twines"),
    "inertia_half_width": ("1", "half width of its interval"),
    "inertia_error": ("1", "standard error of the inertia coefficient"),
    "inertia_known": ("1", "1 where the inertia coefficient is determined"),
    "correlation": ("1", "correlation between drag and inertia coefficient"),
    "velocity_amplitude": ("m/s", "amplitude of the wave's velocity"),
    "mean_velocity": ("m/s", "mean velocity past the panel"),
    "period": ("s", "period as met"),
    "frame_drag_area": ("m2", "C_D A of the frame, subtracted"),
    "frame_inertia_volume": ("m3", "C_M V of the frame, subtracted"),
    "explained": ("1", "share of the variance of the force that the fit explains"),
    "lift_amplitude": ("1", "lift coefficient by root mean squares"),
    "lift_share": ("1", "lift over drag force, root mean squares"),
    "twine_diameter": ("m", "twine diameter"),
    "mesh_pitch": ("m", "mesh pitch"),
    "solidity": ("1", "solidity, crossings counted once"),
    "solidity_listed": ("1", "solidity as listed"),
    "projected_area": ("m2", "area of the twines"),
    "factor": ("1", "A of C_D = A Re^-B"),
    "factor_low": ("1", "lower end of the interval of A"),
    "factor_high": ("1", "upper end of the interval of A"),
    "exponent": ("1", "B of C_D = A Re^-B"),
    "exponent_low": ("1", "lower end of the interval of B"),
    "exponent_high": ("1", "upper end of the interval of B"),
    "scatter": ("1", "scatter of ln C_D beyond the errors of the runs"),
    "joint_factor": ("1", "A by the law of all nets"),
    "joint_exponent": ("1", "B by the law of all nets"),
    "reynolds_low": ("1", "smallest Reynolds number of its runs"),
    "reynolds_high": ("1", "largest Reynolds number of its runs"),
    "coefficient": ("1", "coefficients of ln C_D = a0 + a1 ln Re + a2 S + a3 S ln Re + a4 ln d"),
    "covariance": ("1", "covariance of the coefficients"),
    "force": ("N", "force on the net, frame and vibration taken off"),
    "force_raw": ("N", "force as measured"),
    "force_clean": ("N", "force without the vibration"),
    "force_slow": ("N", "force, low-passed"),
    "force_fitted": ("N", "force by the fit"),
    "velocity": ("m/s", "velocity of the water past the panel"),
    "tension_mean": ("N", "mean tension"),
    "tension_least": ("N", "least tension"),
    "tension_peak": ("N", "highest tension"),
    "tension_mean_peak": ("N", "mean of the peaks of single periods"),
    "tension_peak_deviation": ("N", "standard deviation of the peaks of single periods"),
    "tension_first": ("N", "amplitude of the first harmonic of the tension"),
    "tension_first_phase": ("rad", "phase of the first harmonic of the tension"),
    "slack": ("1", "share of the time that the line is slack"),
}
VOCABULARY = Vocabulary.of(
    "nets",
    VARIABLES,
    labels={
        "line_end": "run, line and end of the line",
        "term": "term of the law",
        "other_term": "term of the law",
    },
    # Series of the ends of lines, in the order of the attribute "ends"
    patterns={r"tension_\d+": "N"},
)
_labelled = VOCABULARY.describe
_TOW = ("speed", "reynolds", "frame_force", "drag", "drag_half_width", "drag_error", "freedom", "lift")
_WAVE = (
    "reynolds",
    "keulegan_carpenter",
    "velocity_amplitude",
    "mean_velocity",
    "period",
    "drag",
    "inertia",
    "drag_half_width",
    "inertia_half_width",
    "drag_error",
    "inertia_error",
    "correlation",
    "drag_known",
    "inertia_known",
    "frame_drag_area",
    "frame_inertia_volume",
    "explained",
    "lift_amplitude",
    "lift_share",
)


def _rows(items: Sequence[Any], names: Sequence[str], dim: str, labels: dict[str, list[str]]) -> xr.Dataset:
    import xarray as xr

    data = {name: (dim, np.array([float(getattr(item, name)) for item in items])) for name in names}
    first = next(iter(labels))
    coords: dict[str, Any] = {
        first: (dim, labels[first]),
        **{key: (dim, labels[key]) for key in labels if key != first},
    }
    return _labelled(xr.Dataset(data, coords=coords))


def nets_result(found: NetFindings, *, text: str = "") -> Result:
    """Return the result that is written and reported.

    Parameters
    ----------
    found : NetFindings
    text : str
        Text of the configuration.
    """
    import xarray as xr

    campaign = found.campaign
    root = xr.Dataset(attrs={"structure": "nets", "title": campaign.title, "case_text": text})
    groups: dict[str, xr.Dataset] = {"/": root}
    if campaign.specimens:
        groups["/nets"] = _nets(found)
    if found.search is not None or found.vibration is not None:
        groups["/vibration"] = _vibration(found)
    if found.towing:
        groups["/towing"] = _rows(
            found.towing,
            (*_TOW, "lift_half_width"),
            "run",
            {"run": [item.run for item in found.towing], "net": [item.net for item in found.towing]},
        )
    if found.waves:
        groups["/waves"] = _rows(
            found.waves,
            _WAVE,
            "run",
            {
                "run": [item.run for item in found.waves],
                "net": [item.net for item in found.waves],
                "kind": [item.kind for item in found.waves],
            },
        )
    if found.joint is not None:
        groups["/law"] = _law(found)
    if found.tensions:
        groups["/tensions"] = _tensions(found)
    groups.update(_records(found))
    grave = [notice for notice in found.notices if notice.severity == "error"]
    status: Status = "outside_validity" if grave else "converged"
    count = len(found.towing) + len(found.waves) + len(found.tensions)
    described, undeclared = VOCABULARY.close(groups)
    return Result(
        tree=xr.DataTree.from_dict(described),
        status=status,
        message=grave[0].message if grave else f"evaluated: {counted(count, 'run')}",
        checks=_checks(found),
        notices=(*found.notices, *undeclared),
        provenance=make_provenance(title=campaign.title, structure="nets", seeds=[campaign.seed]),
    )


def _nets(found: NetFindings) -> xr.Dataset:
    import xarray as xr

    specimens, joint = found.campaign.specimens, found.joint
    laws = {law.net: law for law in found.laws}
    own = [laws.get(specimen.name) for specimen in specimens]

    def of(pick: Any) -> np.ndarray:
        return np.array([np.nan if law is None else float(pick(law)) for law in own])

    shares = [s.net.solidity if found.campaign.solidity == "geometric" else s.net.listed for s in specimens]
    columns = {
        "twine_diameter": [s.net.twine_diameter for s in specimens],
        "mesh_pitch": [s.net.mesh_pitch for s in specimens],
        "solidity": [s.net.solidity for s in specimens],
        "solidity_listed": [s.net.listed for s in specimens],
        "projected_area": [s.projected_area for s in specimens],
        "factor": of(lambda law: law.factor),
        "factor_low": of(lambda law: law.factor_interval[0]),
        "factor_high": of(lambda law: law.factor_interval[1]),
        "exponent": of(lambda law: law.exponent),
        "exponent_low": of(lambda law: law.exponent_interval[0]),
        "exponent_high": of(lambda law: law.exponent_interval[1]),
        "scatter": of(lambda law: law.scatter),
        "reynolds_low": of(lambda law: law.reynolds_range[0]),
        "reynolds_high": of(lambda law: law.reynolds_range[1]),
    }
    if joint is not None:
        columns["joint_factor"] = [joint.factor(share, s.net.twine_diameter) for share, s in zip(shares, specimens)]
        columns["joint_exponent"] = [joint.exponent(share) for share in shares]
    return _labelled(
        xr.Dataset(
            {name: ("net", np.asarray(values, dtype=float)) for name, values in columns.items()},
            coords={"net": [s.name for s in specimens]},
        )
    )


def _vibration(found: NetFindings) -> xr.Dataset:
    import xarray as xr

    data: dict[str, Any] = {}
    if found.search is not None:
        data = {
            "density": ("frequency", found.search.density),
            "background": ("frequency", found.search.background),
        }
    coords = {} if found.search is None else {"frequency": found.search.frequency}
    attrs: dict[str, Any] = {"found": int(found.vibration is not None)}
    if found.search is not None:
        attrs["limit"] = found.search.limit
    if found.vibration is not None:
        line = found.vibration
        attrs.update(line=line.frequency, low=line.low, high=line.high)
        attrs.update(amplitude=line.amplitude, prominence=line.prominence)
    return _labelled(xr.Dataset(data, coords=coords, attrs=attrs))


def _law(found: NetFindings) -> xr.Dataset:
    import xarray as xr

    law = found.joint
    assert law is not None
    return _labelled(
        xr.Dataset(
            {"coefficient": ("term", law.coefficients), "covariance": (("term", "other_term"), law.covariance)},
            coords={"term": list(TERMS), "other_term": list(TERMS)},
            attrs={
                "scatter": law.scatter,
                "between_nets": law.between,
                "prior": law.prior,
                "left_out_error": law.left_out_error,
                "pooled_error": law.pooled_error,
                "runs": law.count,
                "nets": law.nets,
                "solidity": found.campaign.solidity,
                "reynolds_range": list(law.reynolds_range),
                "solidity_range": list(law.solidity_range),
                "diameter_range": list(law.diameter_range),
            },
        )
    )


def _tensions(found: NetFindings) -> xr.Dataset:
    import xarray as xr

    rows = [(run, end) for run, ends in found.tensions for end in ends]
    names = {
        "tension_mean": "mean",
        "tension_least": "least",
        "tension_peak": "peak",
        "tension_mean_peak": "mean_peak",
        "tension_peak_deviation": "peak_deviation",
        "tension_first": "first",
        "tension_first_phase": "first_phase",
        "slack": "slack",
    }
    data = {name: ("line_end", np.array([float(getattr(end, key)) for _, end in rows])) for name, key in names.items()}
    coords = {
        "line_end": [f"{run}, {end.line}, {end.end}" for run, end in rows],
        "run": ("line_end", [run for run, _ in rows]),
        "line": ("line_end", [end.line for _, end in rows]),
        "end": ("line_end", [end.end for _, end in rows]),
    }
    return _labelled(xr.Dataset(data, coords=coords))


def _records(found: NetFindings) -> dict[str, xr.Dataset]:
    import xarray as xr

    groups = {}
    for tow in found.tows:
        groups[f"/records/{tow.run.name}"] = _labelled(
            xr.Dataset(
                {
                    "force_raw": ("time", tow.run.force),
                    "force_clean": ("time", tow.clean),
                    "force_slow": ("time", tow.slow),
                },
                coords={"time": tow.run.time},
                attrs={"kind": "still_water", "net": tow.run.net, "window": list(tow.window)},
            )
        )
    for item in found.waves:
        groups[f"/records/{item.run}"] = _labelled(
            xr.Dataset(
                {
                    "force_raw": ("time", item.raw),
                    "force": ("time", item.force),
                    "force_fitted": ("time", item.modelled),
                    "velocity": ("time", item.velocity),
                },
                coords={"time": item.time},
                attrs={"kind": item.kind, "net": item.net, "period": item.period},
            )
        )
    for cage in found.campaign.cages:
        groups[f"/records/{cage.name}"] = _labelled(
            xr.Dataset(
                {f"tension_{number}": ("time", end.tension) for number, end in enumerate(cage.ends)},
                coords={"time": np.asarray(cage.time, dtype=float)},
                attrs={"kind": "cage", "ends": [f"{end.line}, {end.end}" for end in cage.ends]},
            )
        )
    return groups


def _checks(found: NetFindings) -> tuple[IdentityCheck, ...]:
    """Hold the least-squares fits against their own condition: nothing of drag and inertia is left in the residual."""
    checks = []
    for whole in found.fits:
        u, a = whole.flow.velocity, whole.flow.acceleration
        residual = whole.fit.residual
        size = max(float(np.linalg.norm(whole.force)), 1e-300)
        left = max(
            abs(float(residual @ column)) / float(np.linalg.norm(column)) / size for column in (a, u * np.abs(u))
        )
        checks.append(
            IdentityCheck(f"{whole.run.name}: residual without drag and inertia", left, 1e-9, "least squares")
        )
    return tuple(checks)
