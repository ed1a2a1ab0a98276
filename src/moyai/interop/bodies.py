"""Files of several bodies: one of them, all in another order, all about other points and in other axes."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence

import numpy as np
import xarray as xr

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.interop.coefficients import DOFS, describe, dof_names
from moyai.sea.dispersion import wave_number

MATRICES = ("added_mass", "radiation_damping", "infinite_frequency_added_mass", "zero_frequency_added_mass")
FORCES = ("excitation_force", "Froude_Krylov_force", "diffraction_force")


def bodies_of(dataset: xr.Dataset) -> tuple[str, ...]:
    """Return the names of the bodies; empty for one body."""
    return tuple(str(name) for name in dataset["body"].values) if "body" in dataset.dims else ()


def distinct(names: Sequence[str]) -> tuple[str, ...]:
    """Return names of bodies, by number where they are empty or the same twice; no ``__`` in them."""
    plain = [name.strip().replace("__", "_") for name in names]
    if all(plain) and len(set(plain)) == len(plain):
        return tuple(plain)
    return tuple(str(number) for number in range(1, len(names) + 1))


def _index(bodies: Sequence[str], body: int | str, source: str) -> int:
    if str(body) in bodies:
        return bodies.index(str(body))
    if str(body).isdecimal() and 1 <= int(body) <= len(bodies):
        return int(body) - 1
    raise InputError(
        f"{source} has no body {str(body)!r}", path="body", allowed=f"{', '.join(bodies)}, or a number from 1"
    )


def one_body(dataset: xr.Dataset, body: int | str | None = None) -> xr.Dataset:
    """Return the coefficients of one body; the others stay as they are in the water, held.

    Parameters
    ----------
    dataset : xarray.Dataset
        Of one or several bodies.
    body : int or str, optional
        Name, or number from 1.

    Raises
    ------
    InputError
        Several bodies and none chosen, or none of that name; the bodies of the file are listed.
    """
    source, bodies = str(dataset.attrs.get("source", "the file")), bodies_of(dataset)
    if not bodies:
        if body is not None and str(body) not in ("1", str(dataset.attrs.get("body_name", "1"))):
            raise InputError(f"{source} has no body {str(body)!r}", path="body", allowed="1: it holds one body")
        return dataset
    if body is None:
        raise InputError(
            f"{source} holds the bodies {', '.join(bodies)}",
            path="body",
            remedy="name one, or give its number; the others are then held, their coupling is left out",
        )
    name = bodies[_index(bodies, body, source)]
    kept = [str(dof) for dof in dataset["radiating_dof"].values if str(dof).startswith(f"{name}__")]
    short = [dof.rsplit("__", 1)[1] for dof in kept]
    out = dataset.drop_vars("mean_drift_of_all_bodies", errors="ignore")
    out = out.sel(radiating_dof=kept, influenced_dof=kept).sel(body=name).drop_vars("body")
    return out.assign_coords(radiating_dof=short, influenced_dof=short).assign_attrs(body_name=name)


def modes_of(dataset: xr.Dataset) -> list[int]:
    """Return the numbers of the motions from 1, six a body."""
    names = dof_names(bodies_of(dataset))
    return [names.index(str(name)) + 1 for name in dataset["radiating_dof"].values]


def file_names(dataset: xr.Dataset, stem: str) -> list[str]:
    """Return a name for the files of each body: the stem of one body, those of several with nothing odd in them."""
    bodies = bodies_of(dataset)
    plain = [re.sub(r"[^A-Za-z0-9_-]", "_", name) for name in bodies]
    if len(set(plain)) < len(plain) or stem in plain:
        plain = [f"{stem}{number}" for number in range(1, len(bodies) + 1)]
    return plain or [stem]


def each_body(dataset: xr.Dataset) -> Iterator[tuple[str | None, xr.Dataset]]:
    """Yield every body with its name (None of one body), phases referred to x and y of its own reference point."""
    if not bodies_of(dataset):
        yield None, dataset
    for name in bodies_of(dataset):
        part = one_body(dataset, name)
        yield name, refer_phase(part, part["reference_point"].values[:2])


def in_order(dataset: xr.Dataset, order: Sequence[int | str]) -> xr.Dataset:
    """Return several bodies in another order, named or numbered from 1.

    Raises
    ------
    InputError
        When it does not name every body once.
    """
    bodies, source = bodies_of(dataset), str(dataset.attrs.get("source", "the file"))
    found = [_index(bodies, body, source) for body in order]
    if sorted(found) != list(range(len(bodies))):
        raise InputError(
            f"{', '.join(map(str, order))} does not name every body of {source} once",
            path="bodies",
            allowed=", ".join(bodies),
        )
    names = [bodies[index] for index in found]
    dofs = list(dof_names(names))
    return dataset.sel(body=names, radiating_dof=dofs, influenced_dof=dofs)


def turn_about_z(angle: float) -> Array:
    """Return the matrix (6, 6) from motions in axes turned by an angle [rad] about z to those of the axes at rest."""
    c, s = math.cos(angle), math.sin(angle)
    return np.asarray(np.kron(np.eye(2), np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])), dtype=float)


def moved_axes(dataset: xr.Dataset, origin: Sequence[float], angle: float) -> xr.Dataset:
    """Return coefficients in other axes about z: those of the file stand at ``origin``, turned by ``angle``.

    Equation [eq:interop-moved-axes].

    Parameters
    ----------
    dataset : xarray.Dataset
        All six motions of one or several bodies.
    origin : sequence of two float
        Origin of the axes of the file in the new ones [m].
    angle : float
        From the new x axis to that of the file [rad].
    """
    place = np.asarray(origin, dtype=float)
    if angle == 0.0 and not place.any():
        return dataset
    turn = turn_about_z(angle)
    out = transformed(dataset, np.asarray(np.kron(np.eye(max(len(bodies_of(dataset)), 1)), turn.T), dtype=float))
    out = out.assign_coords(
        wave_direction=out["wave_direction"].copy(data=np.mod(out["wave_direction"].values + angle, 2.0 * math.pi)),
        reference_point=out["reference_point"].copy(
            data=out["reference_point"].values @ turn[:3, :3].T + np.append(place, 0.0)
        ),
    )
    # the new origin lies at -place of the old one, in directions of the new axes
    out = refer_phase(out, -place)
    name = "mean_drift_of_all_bodies"
    if name in dataset:
        values = dataset[name].values
        force = values[..., :2] @ turn[:2, :2].T
        moment = values[..., 2] + place[0] * force[..., 1] - place[1] * force[..., 0]
        turned = np.concatenate([force, moment[..., None]], axis=-1)
        out = out.assign({name: (dataset[name].dims, turned, dataset[name].attrs)})
    return out.sortby("wave_direction")


def with_drift_of_all(dataset: xr.Dataset) -> xr.Dataset:
    """Return the dataset with the mean drift of all bodies together, from that of each where the file has it."""
    if "mean_drift_of_all_bodies" in dataset or "mean_drift_force" not in dataset:
        return dataset
    each = dataset["mean_drift_force"].transpose("omega", "wave_direction", "influenced_dof").values
    parts = each.reshape(*each.shape[:2], -1, 6)
    points = np.atleast_2d(dataset["reference_point"].values)
    force = parts[..., :2].sum(axis=2)
    turning = parts[..., 5] + points[:, 0] * parts[..., 1] - points[:, 1] * parts[..., 0]
    values = np.concatenate([force, turning.sum(axis=2)[..., None]], axis=-1)
    if not np.isfinite(values).all():
        return dataset
    attributes = describe("mean_drift_of_all_bodies")
    return dataset.assign(mean_drift_of_all_bodies=(("omega", "wave_direction", "horizontal"), values, attributes))


def about_points(dataset: xr.Dataset, points: Array) -> xr.Dataset:
    """Return coefficients with rotations and moments about other points (n, 3) [m], one a body [eq:reference-point].

    Raises
    ------
    InputError
        When a degree of freedom is missing, which the move would need.
    """
    bodies = bodies_of(dataset)
    wanted = dof_names(bodies)
    names = [str(name) for name in dataset["radiating_dof"].values]
    missing = ", ".join(name.replace("__", " ") for name in wanted if name not in names)
    if missing:
        raise InputError(
            f"the coefficients lack {missing}", path="coefficients", remedy="compute all six degrees of freedom"
        )
    dataset = dataset.sel(radiating_dof=list(wanted), influenced_dof=list(wanted))
    motion = np.zeros((len(wanted), len(wanted)))
    old = np.atleast_2d(dataset["reference_point"].values)
    for number, (dx, dy, dz) in enumerate(old - points):
        part = slice(6 * number, 6 * number + 6)
        motion[part, part] = np.eye(6)
        motion[6 * number : 6 * number + 3, 6 * number + 3 : 6 * number + 6] = np.array(
            [[0.0, dz, -dy], [-dz, 0.0, dx], [dy, -dx, 0.0]]
        )
    kept = points if bodies else points[0]
    moved = transformed(dataset, motion)
    return moved.assign_coords(reference_point=dataset["reference_point"].copy(data=np.array(kept)))


def transformed(dataset: xr.Dataset, motion: Array) -> xr.Dataset:
    """Apply A' = M^T A M to all matrices and F' = M^T F to all forces; degrees of freedom keep their order.

    Mean drift of single bodies is left out: its moment needs the motions.
    """
    out = dataset.drop_vars("mean_drift_force", errors="ignore").copy()
    for name in (*MATRICES, "hydrostatic_stiffness"):
        if name in out:
            out[name] = out[name].copy(data=motion.T @ out[name].values @ motion)
    for name in FORCES:
        if name in out:
            out[name] = out[name].copy(data=out[name].values @ motion)
    return out


def refer_phase(dataset: xr.Dataset, origin: Array) -> xr.Dataset:
    """Refer phases to another origin: a wave of phase zero there has the phase -k.origin at the old one."""
    if not np.any(origin):
        return dataset
    number = np.asarray(wave_number(dataset["omega"].values, float(dataset["water_depth"]), float(dataset["g"])))
    angle = dataset["wave_direction"].values
    travel = number[:, None] * (origin[0] * np.cos(angle) + origin[1] * np.sin(angle))
    out = dataset.copy()
    for name in FORCES:
        if name in out:
            out[name] = out[name].copy(data=out[name].values * np.exp(-1j * travel)[:, :, None])
    return out


__all__ = ["DOFS", "about_points", "bodies_of", "distinct", "each_body", "in_order", "moved_axes", "one_body"]
