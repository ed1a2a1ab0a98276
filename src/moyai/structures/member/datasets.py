"""From forces to labelled data: geometry, numbers of every wave, time series."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from moyai.morison.circulation import LAMINAR_EDGE
from moyai.morison.members import StraightMember
from moyai.structures.member.checks import orbit_ratio
from moyai.structures.member.march import CAUSES, WaveForces
from moyai.structures.member.model import MemberProblem
from moyai.structures.member.supports import stations
from moyai.structures.member.variables import VOCABULARY, labelled
from moyai.structures.member.waves import MemberWave

if TYPE_CHECKING:
    import xarray as xr

COMPONENTS = ["x", "y", "z"]
AXES = ["first", "second"]
#: Numbers of an irregular sea that are means over its realisations
MEANS = (
    "maximum_force",
    "maximum_total_force",
    "maximum_moment",
    "maximum_end_force",
    "maximum_bending_moment",
    "maximum_bending_moment_along",
    "maximum_strip_force",
)
_OF_REALISATION = ("maximum_total_force", "maximum_end_force", "maximum_bending_moment")


def member_dataset(problem: MemberProblem, member: StraightMember) -> xr.Dataset:
    """Return geometry and ideal inertia coefficients."""
    import xarray as xr

    section = member.placed_section
    strips = member.strips(problem.settings.strips)
    line = section.contour.polyline()
    line = np.append(line, line[0])
    inertia = section.inertia
    width, height = section.extents
    numbers = {
        "area": section.area,
        "width": width,
        "height": height,
        "length": member.length,
        "inclination": member.inclination,
        "principal_angle": inertia.principal_angle,
        "inertia_error": inertia.error,
    }
    return labelled(
        xr.Dataset(
            {
                **numbers,
                "strip_x": ("strip", strips.centres[:, 0]),
                "strip_y": ("strip", strips.centres[:, 1]),
                "strip_z": ("strip", strips.centres[:, 2]),
                "outline_x": ("outline_point", line.real),
                "outline_z": ("outline_point", line.imag),
                "axis_direction": (("axis", "component"), member.axes[:2]),
                "ideal_inertia_coefficient": (("axis", "other_axis"), inertia.tensor),
                "principal_inertia_coefficient": ("principal", np.asarray(inertia.principal)),
            },
            coords={"strip": _along(member, problem), "axis": AXES, "other_axis": AXES, "component": COMPONENTS},
            attrs={"section": section.name},
        )
    )


def _along(member: StraightMember, problem: MemberProblem) -> np.ndarray:
    count = problem.settings.strips
    return (np.arange(count) + 0.5) * member.length / count


def sea_dataset(
    problem: MemberProblem, member: StraightMember, runs: list[tuple[MemberWave, WaveForces]]
) -> xr.Dataset:
    """Return numbers of every wave of a sea state; strips of the largest KC stand for the member."""
    waves = [wave for wave, _ in runs]

    def governing(name: str) -> np.ndarray:
        return np.array([found.strip[name][found.governing] for _, found in runs])

    def strips(name: str) -> np.ndarray:
        return np.array([found.strip[name] for _, found in runs])

    force = [_tail(wave, found.force.sum(axis=0)) for wave, found in runs]
    moment = [_tail(wave, found.moment) for wave, found in runs]
    held = np.array([np.linalg.norm(_tail(wave, found.held.sum(axis=0)), axis=2).max(axis=0) for wave, found in runs])
    speeds = np.stack([governing("velocity_first"), governing("velocity_second")], axis=1)
    period = 2.0 * math.pi / governing("frequency")
    data = {
        "wavelength": ("wave", np.array([2.0 * math.pi / wave.wave_number for wave in waves])),
        "keulegan_carpenter": ("wave", governing("keulegan_carpenter")),
        "coefficient_keulegan_carpenter": ("wave", governing("coefficient_keulegan_carpenter")),
        "reynolds": ("wave", governing("reynolds")),
        "beta": ("wave", governing("beta")),
        "orbit_ratio": ("wave", np.array([orbit_ratio(found) for _, found in runs])),
        "velocity_amplitude": (("wave", "axis"), speeds),
        "inertia_coefficient": (("wave", "axis"), governing("inertia")),
        "plain_inertia_coefficient": (("wave", "axis"), governing("plain_inertia")),
        "effective_inertia_coefficient": (("wave", "axis"), governing("effective_inertia")),
        "drag_coefficient": (("wave", "axis"), governing("drag")),
        "circulation": ("wave", _cleared(governing("circulation"), speeds, period)),
        "settled_circulation": ("wave", _cleared(governing("settled_circulation"), speeds, period)),
        "laminar_circulation": ("wave", LAMINAR_EDGE * speeds.prod(axis=1) * period),
        "maximum_force": (("wave", "component"), np.array([np.abs(item).max(axis=0) for item in force])),
        "mean_force": (("wave", "component"), np.array([_mean(item) for item in force])),
        "force_deviation": (("wave", "component"), np.array([item.std(axis=0) for item in force])),
        "maximum_total_force": ("wave", np.array([np.linalg.norm(item, axis=1).max() for item in force])),
        "maximum_moment": (("wave", "component"), np.array([np.abs(item).max(axis=0) for item in moment])),
        "maximum_end_force": (("wave", "end"), held[:, :2]),
        "maximum_bending_moment": ("wave", held[:, 2:].max(axis=1)),
        "maximum_bending_moment_along": (("wave", "station"), held[:, 2:]),
        "maximum_strip_force": (("wave", "strip", "axis"), strips("force")),
        "strip_keulegan_carpenter": (("wave", "strip"), strips("keulegan_carpenter")),
        "strip_reynolds": (("wave", "strip"), strips("reynolds")),
        "wet_share": (("wave", "strip"), strips("wet")),
    }
    out = VOCABULARY.dataset(
        data,
        {
            "wave": [wave.name for wave in waves],
            "wave_height": ("wave", np.array([wave.height for wave in waves])),
            "period": ("wave", np.array([wave.period for wave in waves])),
            "strip": _along(member, problem),
            "station": stations(problem.settings.strips, member.length),
            "axis": list(AXES),
            "component": list(COMPONENTS),
            "end": ["start", "end"],
        },
        {"kind": "regular" if waves[0].regular else "irregular", "status": "converged"},
    )
    words = {"units": "1", "long_name": "Keulegan-Carpenter number along the member"}
    out.variables["strip_keulegan_carpenter"].attrs = words
    return out


def gathered(members: list[xr.Dataset], seeds: list[int]) -> tuple[xr.Dataset, int]:
    """Return the numbers of an irregular sea and which realisation is kept: the one nearest to the mean.

    Largest values are means over the realisations, all other numbers those of the realisation that is kept.
    """
    largest = np.array([float(item["maximum_total_force"].values[0]) for item in members])
    kept = int(np.argmin(np.abs(largest - largest.mean())))
    means = {name: np.mean([item[name].values for item in members], axis=0) for name in MEANS}
    out = members[kept].assign({name: members[kept][name].copy(data=values) for name, values in means.items()})
    for name in _OF_REALISATION:
        each = np.array([np.max(item[name].values) for item in members])
        out[f"{name}_of_realisation"] = ("realisation", each)
    out["seed_of_realisation"] = ("realisation", np.array(seeds, dtype=np.int64))
    return labelled(out), kept


def _cleared(circulation: np.ndarray, speeds: np.ndarray, period: np.ndarray) -> np.ndarray:
    """Return circulations without what is only rounding of planar flow."""
    return np.where(np.abs(circulation) < 1e-12 * speeds.max(axis=1) ** 2 * period, 0.0, circulation)


def _mean(force: np.ndarray) -> np.ndarray:
    """Return the mean without what is only rounding of the largest force."""
    mean = force.mean(axis=0)
    return np.where(np.abs(mean) < 1e-12 * np.abs(force).max(), 0.0, mean)


def _tail(wave: MemberWave, values: np.ndarray) -> np.ndarray:
    """Return the last period of a regular wave without its repeated end, or the whole irregular record."""
    return values[-wave.time.size : -1] if wave.regular else values


def time_dataset(wave: MemberWave, found: WaveForces) -> xr.Dataset:
    """Return the time series of one wave."""
    # at the most loaded end, and where the moment is largest
    size = np.linalg.norm(_tail(wave, found.held.sum(axis=0)), axis=2).max(axis=0)
    end, station = int(np.argmax(size[:2])), 2 + int(np.argmax(size[2:]))
    parts = {}
    for index, name in enumerate(CAUSES):
        parts[f"{name}_force"] = (("time", "component"), found.force[index])
        # copies, so that the series of all other stations are let go
        parts[f"{name}_end_force"] = (("time", "axis"), found.held[index, :, end].copy())
        parts[f"{name}_bending_moment"] = (("time", "axis"), found.held[index, :, station].copy())
    return VOCABULARY.dataset(
        {
            "surface_elevation": ("time", found.elevation),
            "force": (("time", "component"), found.force.sum(axis=0)),
            **parts,
            "circulation": ("time", found.circulation),
        },
        {"time": found.time, "component": list(COMPONENTS), "axis": list(AXES)},
        {"wave_height": wave.height, "period": wave.period, "wave": wave.name, "theory": wave.theory},
    )
