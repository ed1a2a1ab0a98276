"""WAMIT number files of bodies: .1, .3, .hst, .8, .9, and the .gdf and .pot that tell length, depth and origins.

The conventions are those of :mod:`moyai.interop.wamit`: ULEN is 1 m, the time factor exp(+i omega t).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import numpy as np
import xarray as xr

from moyai.interop.bodies import bodies_of, file_names, modes_of
from moyai.interop.coefficients import dof_names

_STEM = "unit"
_LIMITS = ((-1.0, "zero_frequency_added_mass"), (0.0, "infinite_frequency_added_mass"))


def wamit_files(dataset: xr.Dataset) -> dict[str, bytes]:
    """Return the files by their names.

    Parameters
    ----------
    dataset : xarray.Dataset
        See :mod:`moyai.interop.coefficients`.
    """
    files = {".pot": _control(dataset), ".1": _radiation(dataset), ".3": _forces(dataset)}
    if "hydrostatic_stiffness" in dataset:
        files[".hst"] = _stiffness(dataset)
    if "mean_drift_force" in dataset:
        files[".9"] = _drift(dataset)
    if "mean_drift_of_all_bodies" in dataset:
        files[".8"] = _drift_of_all(dataset)
    named: dict[str, Iterable[str]] = {f"{name}.gdf": _geometry(dataset) for name in file_names(dataset, _STEM)}
    named |= {f"{_STEM}{ending}": lines for ending, lines in files.items()}
    return {name: ("\n".join(lines) + "\n").encode("ascii") for name, lines in named.items()}


def _row(*values: float) -> str:
    return " ".join(str(value) if isinstance(value, int) else f"{float(value):.17E}" for value in values)


def _geometry(dataset: xr.Dataset) -> list[str]:
    return ["coefficients written by moyai, no panels", _row(1.0, float(dataset["g"])), "0 0", "0"]


def _control(dataset: xr.Dataset) -> list[str]:
    depth = float(dataset["water_depth"])
    headings = np.degrees(dataset["wave_direction"].values)
    return [
        "coefficients written by moyai",
        _row(depth if math.isfinite(depth) else -1.0),
        "1 1",
        str(dataset.sizes["omega"]),
        *map(_row, dataset["period"].values),
        str(headings.size),
        *map(_row, headings),
        str(max(len(bodies_of(dataset)), 1)),
        *_bodies(dataset),
    ]


def _bodies(dataset: xr.Dataset) -> Iterator[str]:
    points, there = np.atleast_2d(dataset["reference_point"].values), set(dataset["radiating_dof"].values.tolist())
    names = dof_names(bodies_of(dataset))
    for number, (name, point) in enumerate(zip(file_names(dataset, _STEM), points)):
        yield f"{name}.gdf"
        yield _row(*point, 0.0)
        yield " ".join("1" if dof in there else "0" for dof in names[6 * number : 6 * number + 6])


def _radiation(dataset: xr.Dataset) -> Iterator[str]:
    modes, density = modes_of(dataset), float(dataset["rho"])
    for code, name in _LIMITS:
        if name in dataset:
            yield from (_row(code, i, j, value) for i, j, value in _terms(dataset[name].values / density, modes))
    for number, omega in enumerate(dataset["omega"].values):
        added_mass = dataset["added_mass"].values[number] / density
        damping = dataset["radiation_damping"].values[number] / (density * omega)
        period = float(dataset["period"].values[number])
        for (i, j, a), (_, _, b) in zip(_terms(added_mass, modes), _terms(damping, modes), strict=True):
            yield _row(period, i, j, a, b)


def _terms(matrix: np.ndarray, modes: list[int]) -> Iterator[tuple[int, int, float]]:
    """Yield force i, motion j and the term of a matrix (radiating, influenced)."""
    for column, i in enumerate(modes):
        for row, j in enumerate(modes):
            yield i, j, float(matrix[row, column])


def _forces(dataset: xr.Dataset) -> Iterator[str]:
    scale = float(dataset["rho"]) * float(dataset["g"])
    values = np.conj(dataset["excitation_force"].transpose("omega", "wave_direction", "influenced_dof").values) / scale
    for place in np.ndindex(values.shape):
        force = values[place]
        yield _row(*_heads(dataset, place), modes_of(dataset)[place[2]], abs(force), np.degrees(np.angle(force)),
                   force.real, force.imag)  # fmt: skip


def _heads(dataset: xr.Dataset, place: tuple[int, ...]) -> tuple[float, float]:
    heading = np.degrees(dataset["wave_direction"].values[place[1]])
    return float(dataset["period"].values[place[0]]), float(heading)


def _stiffness(dataset: xr.Dataset) -> Iterator[str]:
    scale = float(dataset["rho"]) * float(dataset["g"])
    matrix = dataset["hydrostatic_stiffness"].transpose("radiating_dof", "influenced_dof").values / scale
    yield from (_row(i, j, value) for i, j, value in _terms(matrix, modes_of(dataset)))


def _drift(dataset: xr.Dataset) -> Iterator[str]:
    values = dataset["mean_drift_force"].transpose("omega", "wave_direction", "influenced_dof").values
    return _drift_rows(dataset, values, modes_of(dataset))


def _drift_of_all(dataset: xr.Dataset) -> Iterator[str]:
    values = dataset["mean_drift_of_all_bodies"].transpose("omega", "wave_direction", "horizontal").values
    return _drift_rows(dataset, values, [1, 2, 6])


def _drift_rows(dataset: xr.Dataset, values: np.ndarray, modes: list[int]) -> Iterator[str]:
    scale = float(dataset["rho"]) * float(dataset["g"])
    for place in np.ndindex(values.shape):
        value = float(values[place]) / scale
        if math.isfinite(value):
            period, heading = _heads(dataset, place)
            phase = 180.0 if value < 0.0 else 0.0
            yield _row(period, heading, heading, modes[place[2]], abs(value), phase, value, 0.0)
