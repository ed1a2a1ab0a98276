"""Infinite-frequency added mass where a file has none, and the water of the file against that of the site."""

from __future__ import annotations

import math

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.interop.coefficients import LONG_NAMES
from moyai.sea.dispersion import wave_number
from moyai.sea.water import Water

# Estimates are taken where both the low end and the cut-off of the band are far
_LOWEST, _HIGHEST = 0.15, 0.6
FEWEST_FREQUENCIES = 8


def complete_limits(dataset: xr.Dataset) -> xr.Dataset:
    """Return the dataset with the added mass at infinite frequency, from its own damping where the file has none.

    Equation [eq:interop-kramers-kronig]. Every frequency of the band gives an estimate; their median is taken, and half
    their range is stored as the attribute ``spread`` (largest term relative to the diagonal).

    Parameters
    ----------
    dataset : xarray.Dataset
        Coefficients of :mod:`moyai.interop.coefficients`.

    Raises
    ------
    InputError
        With fewer than ``FEWEST_FREQUENCIES`` frequencies, which cannot carry the integral.
    """
    if "infinite_frequency_added_mass" in dataset:
        return dataset
    omega = dataset["omega"].values
    if omega.size < FEWEST_FREQUENCIES:
        raise InputError(
            f"{dataset.attrs.get('source', 'the file')} holds {omega.size} frequencies and no infinite-frequency "
            "added mass",
            path="coefficients",
            remedy="compute more frequencies, or infinite frequency as well",
        )
    estimates = infinite_frequency_estimates(omega, dataset["added_mass"].values, dataset["radiation_damping"].values)
    middle = np.median(estimates, axis=0)
    half_range = 0.5 * (np.percentile(estimates, 90, axis=0) - np.percentile(estimates, 10, axis=0))
    diagonal = np.sqrt(np.abs(np.outer(np.diag(middle), np.diag(middle))))
    spread = float(np.max(half_range / np.maximum(diagonal, 1e-6 * diagonal.max())))
    long_name, units = LONG_NAMES["infinite_frequency_added_mass"]
    attributes = {"long_name": long_name, "units": units, "origin": "from the damping of the band", "spread": spread}
    variable = (("radiating_dof", "influenced_dof"), middle, attributes)
    return dataset.assign(infinite_frequency_added_mass=variable)


def infinite_frequency_estimates(omega: Array, added_mass: Array, radiation_damping: Array) -> NDArray[np.float64]:
    """Return one estimate of the infinite-frequency added mass for each frequency of the inner band.

    Equation [eq:interop-kramers-kronig]. The singular part is integrated in closed form; beyond the band the damping
    falls with the power that its last tenth shows.

    Parameters
    ----------
    omega : ndarray, shape (n,)
        Increasing angular frequencies [rad/s].
    added_mass, radiation_damping : ndarray, shape (n, m, m)

    Returns
    -------
    ndarray, shape (estimates, m, m)
    """
    grid = np.concatenate([[0.0], omega])
    damping = np.concatenate([np.zeros_like(radiation_damping[:1]), radiation_damping])
    slope = np.gradient(damping, grid, axis=0)
    cut = grid[-1]
    inner = np.flatnonzero((omega > _LOWEST * cut) & (omega < _HIGHEST * cut))
    tail = _tail(omega, radiation_damping)
    out = []
    for i in inner:
        w, here = omega[i], damping[i + 1]
        with np.errstate(divide="ignore", invalid="ignore"):
            regular = (damping - here) / (grid**2 - w**2)[:, None, None]
        regular[i + 1] = slope[i + 1] / (2.0 * w)
        integral = np.sum(0.5 * (regular[1:] + regular[:-1]) * np.diff(grid)[:, None, None], axis=0)
        singular = here / (2.0 * w) * math.log((cut - w) / (cut + w))
        out.append(added_mass[i] - 2.0 / math.pi * (integral + singular + tail))
    return np.array(out)


def _tail(omega: Array, damping: Array) -> Array:
    """Return the integral of B / sigma^2 beyond the band for a power law fitted to the last tenth of the band."""
    last = omega > 0.9 * omega[-1]
    end = damping[-1]
    begin = damping[last][0]
    if omega[last][0] == omega[-1]:
        return np.asarray(0.5 * end / omega[-1])
    # Terms that change sign or vanish in the tail fall with the first power, which is the slowest
    ratio = begin / np.where(end == 0.0, np.inf, end)
    power = np.log(np.where(ratio > 0.0, ratio, 1.0)) / math.log(omega[-1] / omega[last][0])
    return np.asarray(end / ((np.clip(power, 1.0, 8.0) + 1.0) * omega[-1]))


def match_site(dataset: xr.Dataset, water: Water) -> tuple[xr.Dataset, tuple[Notice, ...]]:
    """Return the coefficients for the density of the site, with a notice where depth or gravity differ.

    All coefficients are proportional to the density. Depth and gravity change them in ways that a file cannot undo: a
    file for another depth is accepted where both are deep for all its frequencies, reported where they are not.

    Raises
    ------
    InputError
        When the depth differs by more than a tenth and the waves feel it.
    """
    density = float(dataset["rho"])
    scaled = dataset.copy()
    for name in dataset.data_vars:
        scaled[name] = dataset[name].copy(data=dataset[name].values * (water.density / density))
        scaled[name].attrs = dict(dataset[name].attrs)
    scaled = scaled.assign_coords(rho=dataset["rho"].copy(data=water.density))
    notices = []
    gravity, depth = float(dataset["g"]), float(dataset["water_depth"])
    if abs(gravity - water.gravity) > 1e-3 * water.gravity:
        notices.append(
            Notice(
                "coefficients-gravity",
                f"the coefficients were computed with g = {gravity:g} m/s2, the site has {water.gravity:g} m/s2",
                value=gravity,
                limit=water.gravity,
                remedy="run the program with the gravity of the site",
            )
        )
    if depth != water.depth:
        lowest = float(dataset["omega"][0])
        own = float(wave_number(lowest, depth, gravity))
        site = float(wave_number(lowest, water.depth, gravity))
        if abs(own - site) > 1e-3 * site:
            shift = abs(min(depth, 1e9) - min(water.depth, 1e9)) / min(depth, water.depth)
            if shift > 0.1:
                raise InputError(
                    f"the coefficients hold for a depth of {depth:g} m, the water is {water.depth:g} m deep",
                    path="coefficients",
                    remedy="run the program at each water level, or leave the lowest frequencies out",
                )
            notices.append(
                Notice(
                    "coefficients-depth",
                    f"the coefficients hold for a depth of {depth:g} m, the water is {water.depth:g} m deep",
                    value=depth,
                    limit=water.depth,
                    remedy="run the program at this depth",
                )
            )
    return scaled, tuple(notices)
