"""Coefficients of all units together out of the file of another program, in place of a computation.

The file holds one body for each unit. Its numbers are taken at its own frequencies and between them by splines, as
those of a computation are; far waves are not in such files, so that mean drift is what the file says of it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.core.curves import Spline
from moyai.core.errors import InputError
from moyai.core.validity import IdentityCheck, Notice
from moyai.interop.bodies import about_points, bodies_of, in_order, moved_axes, with_drift_of_all
from moyai.interop.checks import import_notices
from moyai.interop.limits import match_site
from moyai.interop.read import read_coefficients
from moyai.sea.dispersion import wave_number
from moyai.structures.units.assembly import RowAtLevel
from moyai.structures.units.bem import Solution
from moyai.structures.units.hydrodynamics import SYMMETRY, RowHydrodynamics, asymmetry
from moyai.structures.units.model import RowCoefficients

if TYPE_CHECKING:
    import xarray as xr

WHERE = "coefficients_file"
#: Frequencies [1] and headings [rad] that are the same
_SAME, _SAME_HEADING = 1e-6, 1e-4
#: Headings of the file between which others are taken by splines
WIDEST = math.radians(15.0)
#: Heave stiffness of the file over that of the units, apart from one: reported, refused
STIFFNESS_REPORTED, STIFFNESS_REFUSED = 0.02, 0.1


@dataclass(frozen=True, eq=False)
class FileOfRow:
    """What a file says of the row at one level."""

    #: At the frequencies and headings of the seas.
    hydro: RowHydrodynamics
    notices: tuple[Notice, ...]


def read_row(given: RowCoefficients) -> xr.Dataset:
    """Read the file, in axes of the row, bodies in the order of the units.

    Raises
    ------
    InputError
    """
    try:
        dataset = with_drift_of_all(read_coefficients(given.program, given.path, given.options))
        if given.bodies:
            dataset = in_order(dataset, given.bodies)
        return moved_axes(dataset, given.origin, given.heading)
    except InputError as error:
        raise error.at(f"{WHERE}.{error.fault.path}" if error.fault.path == "bodies" else WHERE) from None


def row_from_file(dataset: xr.Dataset, at: RowAtLevel, omega: Array, headings: Array) -> FileOfRow:
    """Return the coefficients about the centres of gravity at the frequencies and headings of the seas.

    Parameters
    ----------
    dataset : xarray.Dataset
        From :func:`read_row`.
    at : RowAtLevel
    omega, headings : ndarray
        [rad/s], [rad].

    Raises
    ------
    InputError
        When the file is of another row, another water, or does not reach the seas.
    """
    try:
        _check_bodies(dataset, at)
        matched, notices = match_site(dataset, at.water)
        moved = about_points(matched, at.centres)
    except InputError as error:
        raise error.at(WHERE) from None
    said = [*notices, *import_notices(moved), *_stiffness_notices(moved, at)]
    whole, between = _of_headings(moved, at, headings)
    if between:
        names = ", ".join(f"{math.degrees(heading):.4g}" for heading in between)
        said.append(
            Notice(
                "coefficients-headings",
                f"the coefficients of the file are taken between its headings at {names} degrees",
                severity="information", remedy="run the program in the headings of the seas",
            )
        )  # fmt: skip
    if whole.drift is None:
        said.append(
            Notice(
                "coefficients-without-drift",
                "the file holds no mean drift of the whole row: drift does not move the row, offsets and tensions are "
                "too low by it",
                severity="warning", remedy="give files with mean drift (.8 or .9 of WAMIT, mean_drift of BEMIO)",
            )
        )  # fmt: skip
    else:
        said.append(
            Notice(
                "coefficients-drift",
                "mean drift is that of the file, of the motions that the program behind it computed",
                severity="information", remedy="compute it with the same connectors and lines",
            )
        )  # fmt: skip
    said += _solutions_apart(whole, omega)
    return FileOfRow(at_frequencies(whole, omega), tuple(said))


def _check_bodies(dataset: xr.Dataset, at: RowAtLevel) -> None:
    """Hold number and places of the bodies against the units."""
    bodies, row = bodies_of(dataset) or ("1",), at.row
    if len(bodies) != row.count:
        raise InputError(
            f"the file holds {len(bodies)} bodies ({', '.join(bodies)}), the row has {row.count} units",
            parameter=WHERE,
            allowed=f"{row.count} bodies",
        )
    points = np.atleast_2d(dataset["reference_point"].values)
    if row.count > 1 and np.ptp(points[:, :2], axis=0).max() == 0.0:
        # moments of all bodies about one point: forces alone tell where they are
        return
    inside = [[_within(at, point, unit) for unit in range(row.count)] for point in points]
    for number, (name, found) in enumerate(zip(bodies, inside)):
        if found[number]:
            continue
        place, point = row.placements[number], points[number]
        others = [unit + 1 for unit, there in enumerate(found) if there]
        where = f"in unit {others[0]}" if others else f"at x = {point[0]:.4g} m, y = {point[1]:.4g} m"
        order = [next((b for b, column in zip(bodies, inside) if column[unit]), "") for unit in range(row.count)]
        raise InputError(
            f"body '{name}' of the file is {where}, unit {number + 1} at x = {place.x:.4g} m, y = {place.y:.4g} m",
            parameter=WHERE,
            allowed="bodies in the order and at the places of the units",
            remedy=f"give bodies: [{', '.join(order)}]"
            if all(order)
            else "give origin and heading of the x axis of the file, or correct the places of the units",
        )


def _within(at: RowAtLevel, point: Array, unit: int) -> bool:
    place = at.row.placements[unit]
    away = place.rotation.T @ np.array([point[0] - place.x, point[1] - place.y, 0.0])
    return bool(
        abs(away[0]) <= 0.5 * at.row.hull.beam * (1.0 + 1e-9) and abs(away[1]) <= 0.5 * at.row.length * (1.0 + 1e-9)
    )


def _stiffness_notices(dataset: xr.Dataset, at: RowAtLevel) -> list[Notice]:
    """Compare the heave stiffness of the file with that of the units: another draught, section or unit of length."""
    if "hydrostatic_stiffness" not in dataset:
        return []
    found = np.diag(dataset["hydrostatic_stiffness"].values)[2::6]
    wanted = np.diag(at.hydrostatic)[2::6]
    apart = np.abs(found / wanted - 1.0)
    number = int(apart.argmax())
    if not found.any() or apart[number] <= STIFFNESS_REPORTED:
        return []
    if apart[number] > STIFFNESS_REFUSED:
        raise InputError(
            f"the heave stiffness of body {number + 1} of the file is {found[number]:.4g} N/m, that of a unit "
            f"{wanted[number]:.4g} N/m",
            parameter=WHERE,
            allowed=f"within {100.0 * STIFFNESS_REFUSED:g} %",
            remedy="check section, length and draught against the mesh of the file, and its length scale",
        )
    return [
        Notice(
            "coefficients-stiffness",
            f"the heave stiffness of body {number + 1} of the file is off by {100.0 * apart[number]:.2g} % from that "
            "of a unit",
            value=float(apart[number]), limit=STIFFNESS_REPORTED, severity="warning",
            remedy="check section, length and draught against the mesh of the file",
        )
    ]  # fmt: skip


def _of_headings(dataset: xr.Dataset, at: RowAtLevel, headings: Array) -> tuple[RowHydrodynamics, list[float]]:
    """Return all frequencies of the file in some headings, and those that the file has not itself."""
    omega = dataset["omega"].values
    k = np.array([float(wave_number(w, at.water.depth, at.water.gravity)) for w in omega])
    excitation = dataset["excitation_force"].transpose("omega", "wave_direction", "influenced_dof").values
    there = np.mod(dataset["wave_direction"].values, 2.0 * math.pi)
    order = np.argsort(there)
    there, excitation = there[order], excitation[:, order]
    drift = None
    if "mean_drift_of_all_bodies" in dataset:
        drift = dataset["mean_drift_of_all_bodies"].transpose("omega", "wave_direction", "horizontal").values[:, order]
        drift = None if np.isnan(drift).any() else drift
    apart = np.abs(np.angle(np.exp(1j * (headings[:, None] - there[None, :]))))
    near = apart.argmin(axis=1)
    between = [float(heading) for heading, column in zip(headings, apart) if column.min() > _SAME_HEADING]
    force, moved = excitation[:, near], None if drift is None else drift[:, near]
    if between:
        from scipy.interpolate import CubicSpline

        around = np.concatenate([there[-3:] - 2.0 * math.pi, there, there[:3] + 2.0 * math.pi])
        _check_headings(around, there, between)
        index = np.concatenate([np.arange(len(there))[-3:], np.arange(len(there)), np.arange(len(there))[:3]])
        around, first = np.unique(np.round(around, 9), return_index=True)
        steady = (excitation / _phase(at, k, there))[:, index[first]]
        every = np.mod(headings, 2.0 * math.pi)
        new = CubicSpline(around, steady, axis=1)(every) * _phase(at, k, headings)
        exact = apart.min(axis=1) <= _SAME_HEADING
        force = np.where(exact[None, :, None], force, new)
        if drift is not None and moved is not None:
            smooth = CubicSpline(around, drift[:, index[first]], axis=1)(every)
            moved = np.where(exact[None, :, None], moved, smooth)
    matrices = [
        dataset[name].transpose("omega", "influenced_dof", "radiating_dof").values
        for name in ("added_mass", "radiation_damping")
    ]
    solutions = tuple(
        _solution(float(w), float(number), added, damping, forces)
        for w, number, added, damping, forces in zip(omega, k, *matrices, force)
    )
    worst = max(
        asymmetry(getattr(item, name), solutions, name) for item in solutions for name in ("added_mass", "damping")
    )
    check = IdentityCheck("coefficients of the row are symmetric", worst, SYMMETRY, "A_ij = A_ji, B_ij = B_ji")
    source = f"{dataset.attrs['program']}, {dataset.attrs['source']}"
    return RowHydrodynamics(
        None, at.water, at.centres, headings, solutions, (check,), drift=moved, source=source
    ), between  # fmt: skip


def _phase(at: RowAtLevel, k: Array, headings: Array) -> ComplexArray:
    along = np.cos(headings)[:, None] * at.centres[:, 0] + np.sin(headings)[:, None] * at.centres[:, 1]
    return np.repeat(np.exp(1j * k[:, None, None] * along), 6, axis=2)


def _check_headings(around: Array, there: Array, wanted: list[float]) -> None:
    for heading in wanted:
        place = math.fmod(heading + 2.0 * math.pi, 2.0 * math.pi)
        right = int(np.searchsorted(around, place))
        if not 0 < right < len(around) or around[right] - around[right - 1] > WIDEST * (1.0 + 1e-9):
            raise InputError(
                f"the file holds no waves of {math.degrees(heading):.4g} degrees, nor of headings within "
                f"{math.degrees(WIDEST):g} degrees on both sides",
                parameter=WHERE,
                allowed="headings in the file, axes of the row: "
                + ", ".join(f"{math.degrees(angle):.4g}" for angle in there),
                remedy="run the program in the headings of the seas, or give other waves",
            )


def _solution(omega: float, k: float, added: Array, damping: Array, force: ComplexArray) -> Solution:
    count, headings = len(added), len(force)

    def none(*shape: int) -> ComplexArray:
        return np.zeros(shape, dtype=complex)

    return Solution(
        omega, k, added, damping, force, none(0, count), none(0, headings), none(count, 0), none(headings, 0),
        np.zeros(6),
    )  # fmt: skip


def at_frequencies(whole: RowHydrodynamics, omega: Array) -> RowHydrodynamics:
    """Return the coefficients of a file at the frequencies of the seas: its own where it has them.

    Raises
    ------
    InputError
        When the frequencies of the file do not reach as far.
    """
    own = whole.omega
    low, high = own[0] * (1.0 - _SAME), own[-1] * (1.0 + _SAME)
    if omega.min() < low or omega.max() > high:
        raise InputError(
            f"the seas need {omega.min():.4g} to {omega.max():.4g} rad/s, the file holds {own[0]:.4g} to "
            f"{own[-1]:.4g} rad/s",
            parameter=WHERE,
            remedy="run the program at more frequencies, or give frequencies within those of the file",
        )
    clipped = np.clip(omega, own[0], own[-1])
    k = np.array([float(wave_number(w, whole.water.depth, whole.water.gravity)) for w in clipped])
    added, damping, force = whole.at(clipped, k)
    drift = None if whole.drift is None else _smooth(own, whole.drift, clipped)
    solutions = []
    for index, frequency in enumerate(omega):
        near = int(np.abs(own - frequency).argmin())
        if abs(own[near] - frequency) <= _SAME * frequency:
            solutions.append(replace(whole.solutions[near], omega=float(frequency), wave_number=float(k[index])))
            if drift is not None and whole.drift is not None:
                drift[index] = whole.drift[near]
        else:
            solutions.append(_solution(float(frequency), float(k[index]), added[index], damping[index], force[index]))
    return replace(whole, solutions=tuple(solutions), drift=drift, band=whole)


def _smooth(own: Array, values: Array, omega: Array) -> Array:
    return np.array(np.tile(values, (len(omega), 1, 1)) if len(own) == 1 else Spline(own, values)(omega))


def _solutions_apart(whole: RowHydrodynamics, omega: Array) -> list[Notice]:
    """Say when the frequencies of the file are so wide that waves between the units turn too far from one to the next.

    Splines follow the coefficients of a pair once the wave from the one to the other is taken out; what two or more
    reflections add swings with twice that distance.
    """
    inside = whole.wave_number[(whole.omega >= omega.min() * 0.999) & (whole.omega <= omega.max() * 1.001)]
    longest = float(whole.reach.max())
    if len(inside) < 2 or longest == 0.0:
        return []
    turn = float(np.diff(inside).max()) * longest
    if turn <= math.pi:
        return []
    return [
        Notice(
            "coefficients-frequencies",
            f"from one frequency of the file to the next a wave along the row turns by up to {turn / math.pi:.2g} "
            "half periods: splines between them may miss the interaction of the units",
            value=turn, limit=math.pi, severity="warning", remedy="run the program at more frequencies",
        )
    ]  # fmt: skip
