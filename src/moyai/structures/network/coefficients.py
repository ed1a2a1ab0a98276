"""Coefficients of three-dimensional programs as loads of the bodies of a network."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import IdentityCheck, Notice
from moyai.coupled.wave_loads import WaveLoads
from moyai.sea.water import Water
from moyai.structures.network.body_plan import BodyPlan
from moyai.structures.network.model import NetworkProblem
from moyai.structures.network.runs import RunPlan

if TYPE_CHECKING:
    import xarray as xr


#: Depth of the water over that of the coefficients, apart from one, from which a run says so.
DEPTH_APART = 0.02
#: Breadth of a body over the length of the waves from which they are not those of an undisturbed sea (Morison's range).
SMALL_BODY = 0.2


def water_plane(plan: BodyPlan) -> tuple[float, float, float]:
    """Return area [m2] and second moments about x and y [m4] of the water plane of an upright box or cylinder."""
    length, width, _ = plan.size
    if plan.shape == "cylinder":
        moment = math.pi / 64.0 * length**4
        return 0.25 * math.pi * length**2, moment, moment
    return length * width, length * width**3 / 12.0, width * length**3 / 12.0


def hydrostatic_stiffness(plan: BodyPlan, draught: float, water: Water) -> Array:
    """Return the restoring of an upright box or cylinder about its centre of gravity [eq:coupled-hydrostatics]."""
    area, about_x, about_y = water_plane(plan)
    weight = water.density * water.gravity
    # the centre of buoyancy under the centre of gravity
    lever = area * draught * (0.5 * draught - 0.5 * plan.size[2] - plan.centre_of_gravity[2])
    stiffness = np.zeros((6, 6))
    stiffness[2, 2] = weight * area
    stiffness[3, 3], stiffness[4, 4] = weight * (about_x + lever), weight * (about_y + lever)
    return stiffness


def loads_of(plan: BodyPlan, dataset: xr.Dataset, water: Water) -> WaveLoads:
    """Return the loads of a body about its centre of gravity.

    Hydrostatics are those of its shape at the draught of the coefficients, whatever the file says of them.

    Raises
    ------
    InputError
        For coefficients that lack what a body in six degrees of freedom needs.
    """
    given = plan.coefficients
    assert given is not None
    area, _, _ = water_plane(plan)
    try:
        found = WaveLoads.from_dataset(
            dataset, displaced_volume=area * given.draught,
            equilibrium_position=(plan.position[0], plan.position[1], 0.5 * plan.size[2] - given.draught),
            equilibrium_yaw=plan.rotation[2],
            origin=given.origin, stiffness=np.zeros((6, 6)), memory=given.memory,
        )  # fmt: skip
    except InputError as error:
        raise error.at(f"bodies.{plan.name}.coefficients_file") from None
    about = found.about(np.array(plan.centre_of_gravity), np.array(plan.position))
    return replace(about, stiffness=hydrostatic_stiffness(plan, given.draught, water))


def with_coefficients(
    problem: NetworkProblem, datasets: Mapping[str, xr.Dataset]
) -> tuple[NetworkProblem, list[Notice], list[IdentityCheck]]:
    """Return the problem whose bodies carry the loads of their coefficients, with what there is to say of them.

    Parameters
    ----------
    problem : NetworkProblem
    datasets : mapping of str to xarray.Dataset
        Coefficients by body, in the names of Capytaine (:func:`moyai.interop.read.read_coefficients`).

    Raises
    ------
    InputError
        For a body whose coefficients are not there, or lack something.
    """
    from moyai.interop.checks import import_notices

    notices: list[Notice] = []
    checks: list[IdentityCheck] = []
    bodies: list[BodyPlan] = []
    for plan in problem.bodies:
        if plan.coefficients is None:
            bodies.append(plan)
            continue
        if plan.name not in datasets:
            raise InputError(
                f"the coefficients of body '{plan.name}' were not read",
                parameter=f"bodies.{plan.name}.coefficients_file", remedy="run the case with moyai.run",
            )  # fmt: skip
        dataset = datasets[plan.name]
        loads = loads_of(plan, dataset, problem.environment.water)
        bodies.append(replace(plan, loads=loads))
        notices += [replace(item, message=f"body '{plan.name}': {item.message}") for item in loads.notices]
        checks += [replace(item, name=f"body '{plan.name}': {item.name}") for item in loads.checks]
        notices += _other_water(problem, plan.name, dataset)
        notices += [replace(item, message=f"body '{plan.name}': {item.message}") for item in import_notices(dataset)]
    return replace(problem, bodies=tuple(bodies)), notices, checks


def _other_water(problem: NetworkProblem, name: str, dataset: xr.Dataset) -> list[Notice]:
    """Say when the coefficients were computed for another depth or density."""
    notices: list[Notice] = []
    depth, density = (float(dataset[key]) if key in dataset.coords else None for key in ("water_depth", "rho"))
    for level_name, level in problem.environment.water_levels:
        here = problem.environment.water_at(level).depth
        if depth is None or here == depth or abs(here / depth - 1.0) <= DEPTH_APART:
            continue
        notices.append(
            Notice(
                "coefficients-depth", f"the coefficients of body '{name}' are those of {depth:g} m of water, at "
                f"water level {level_name} there are {here:g} m", here, depth, "warning",
                "compute them for this depth",
            )
        )  # fmt: skip
    own = problem.environment.water.density
    if density is not None and abs(own / density - 1.0) > 1e-3:
        notices.append(
            Notice(
                "coefficients-density", f"the coefficients of body '{name}' are those of water of {density:g} "
                f"kg/m3, here it has {own:g} kg/m3", own, density, "warning", "compute them for this water",
            )
        )  # fmt: skip
    return notices


def loads_on_time(problem: NetworkProblem, plan: RunPlan) -> list[Notice]:
    """Compare the waves of a run with the range of the loads of the bodies.

    Raises
    ------
    InputError
        When the waves are outside the frequencies or headings of the coefficients.
    """
    notices: list[Notice] = []
    if plan.waves is None:
        return notices
    number = float(np.interp(2.0 * math.pi / plan.period, *_rising(plan)))
    for body in problem.bodies:
        if body.loads is not None:
            try:
                excitation = body.loads.excitation(plan.waves)
                if excitation is not None:
                    excitation.force(0.0, np.zeros(3), body.loads.equilibrium_yaw, 1.0)
            except InputError as error:
                raise InputError(
                    f"run '{plan.name}': {error.fault.message}",
                    parameter=f"bodies.{body.name}.coefficients_file",
                    allowed=error.fault.allowed,
                    remedy=error.fault.remedy,
                ) from None
            continue
        if body.shape == "assembly":
            continue
        share = max(body.size[:2]) * number / (2.0 * math.pi)
        if share > SMALL_BODY:
            notices.append(
                Notice(
                    "body-not-small", f"body '{body.name}' is {share:.2f} wave lengths long: its loads include "
                    "neither diffraction nor radiation", share, SMALL_BODY, "warning",
                    "give coefficients_file of a 3-D program in place of added_mass",
                )
            )  # fmt: skip
    return notices


def _rising(plan: RunPlan) -> tuple[Array, Array]:
    assert plan.waves is not None
    order = np.argsort(plan.waves.omega)
    return np.asarray(plan.waves.omega)[order], np.asarray(plan.waves.wave_number)[order]


def coefficients_of_bodies(problem: NetworkProblem) -> dict[str, xr.Dataset]:
    """Read the coefficients of the bodies whose loads come from a three-dimensional program.

    Raises
    ------
    InputError
        When a file cannot be read.
    """
    from moyai.interop.read import read_body

    found = {}
    for body in problem.bodies:
        given = body.coefficients
        if given is not None:
            try:
                found[body.name] = read_body(given.program, given.path, given.options)
            except InputError as error:
                raise error.at(f"bodies.{body.name}.coefficients_file") from None
    return found
