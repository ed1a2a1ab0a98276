"""WAMIT number files: .1 added mass and damping, .3 exciting force, .hst hydrostatics, .8 and .9 mean drift.

Of N bodies mode 6 (n - 1) + i is mode i of body n. Modes are along the axes of each body, XBODY(4) turned about the
vertical; here they are turned back to the global axes. All phases refer to the global origin.

The files are non-dimensional: A = rho L^k, B = rho L^k omega, X = rho g A L^m, with k = 3, 4, 5 and m = 2, 3 for
translations, mixed terms and rotations; L is ULEN. WAMIT's time factor is exp(+i omega t): forces are conjugated.
In the first column a period of -1 stands for zero and 0 for infinite frequency; these rows have no damping.

HAMS writes the same layout, but its first column may be a wave number, and the meaning of 0 and -1 then is not the
same: it is taken from the user or refused.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Literal

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.foreign_files import reads
from moyai.core.options import checks_words
from moyai.interop.bodies import distinct, one_body, transformed, turn_about_z
from moyai.interop.coefficients import assemble, dof_names, require
from moyai.interop.textfiles import find_companion, leading_numbers, read_lines, read_table
from moyai.sea.dispersion import angular_frequency

FirstColumn = Literal["period", "angular_frequency", "wave_number"]

_ROTATION = np.array([0, 0, 0, 1, 1, 1])
#: Bodies of a file; beyond, the modes are taken for a mistake
MOST_BODIES = 60


@dataclass(frozen=True)
class _Surroundings:
    """What the input files next to the number files tell; ``None`` where they do not."""

    gravity: float | None = None
    length_scale: float | None = None
    water_depth: float | None = None
    bodies: tuple[_WamitBody, ...] = ()
    first_column: FirstColumn | None = None
    hams: bool = False


@dataclass(frozen=True)
class _WamitBody:
    """Name of the .gdf file, origin of the body axes [m] and their angle about the vertical [rad]."""

    name: str
    place: tuple[float, float, float]
    angle: float


@checks_words
@reads("a file of WAMIT", named="coefficients")
def read_wamit(
    path: str | Path,
    *,
    density: float,
    gravity: float | None = None,
    length_scale: float | None = None,
    water_depth: float | None = None,
    reference_point: Sequence[float] | Sequence[Sequence[float]] | None = None,
    first_column: FirstColumn | None = None,
    zero_frequency_code: float | None = None,
    infinite_frequency_code: float | None = None,
    body: int | str | None = None,
) -> xr.Dataset:
    """Read the WAMIT files of one or several bodies.

    Parameters
    ----------
    path : path
        The .1 file, or any file with the same stem; .3 must stand next to it, .hst, .8 and .9 are read where present.
    density : float
        Water density rho [kg/m3].
    gravity, length_scale : float, optional
        g [m/s2] and ULEN [m]; from the .gdf file when absent.
    water_depth : float, optional
        Depth [m], ``inf`` allowed; from the .pot file when absent.
    reference_point : sequence of three float, optional
        Origin of the body axes in the global ones, XBODY [m], one for each of several bodies; from the .pot file when
        absent.
    first_column : {"period", "angular_frequency", "wave_number"}, optional
        Meaning of the first column; period unless the .cfg file says otherwise. Must be given for HAMS.
    zero_frequency_code, infinite_frequency_code : float, optional
        Values of the first column that stand for the limits; -1 and 0 when the first column is WAMIT's period,
        to be given otherwise when such rows occur.
    body : int or str, optional
        One of several bodies, by number from 1 or by the name of its .gdf file; all of them when absent.

    Returns
    -------
    xarray.Dataset
        Added mass [kg, kg m, kg m2], damping, forces per unit wave amplitude [N/m, N m/m] about ``reference_point``;
        see :mod:`moyai.interop.coefficients`.

    Raises
    ------
    InputError
        Missing files or facts, incomplete tables, an ambiguous first column, no such body.

    Examples
    --------
    >>> from tempfile import mkdtemp
    >>> from moyai.interop import from_planar, read_wamit, write_coefficients
    >>> from moyai.potential import rigid_modes, shapes, solve
    >>> from moyai.sea import Water
    >>> section = shapes.rectangle(beam=4.0, height=2.0).immersed(draught=1.0)
    >>> found = solve(section, Water(10.0, 1025.0, 9.81), [0.5, 1.0], modes=rigid_modes((0.0, -0.2)))
    >>> unit = from_planar(found.dataset, length=20.0, centre_of_gravity=(0.0, -0.2))
    >>> files = write_coefficients("wamit", unit, mkdtemp())
    >>> again = read_wamit(files[0], density=1025.0)
    >>> again.radiating_dof.values.tolist()
    ['Surge', 'Sway', 'Heave', 'Roll', 'Pitch', 'Yaw']
    """
    file = Path(path)
    first = find_companion(file, ".1")
    third = find_companion(file, ".3")
    if first is None or third is None:
        raise InputError(f"no {file.stem}{'.1' if first is None else '.3'} in {file.parent}", path="coefficients")
    reported = _read_surroundings(first)
    column = first_column or reported.first_column
    if column is None:
        if reported.hams:
            raise InputError(
                f"{first.name} was written by HAMS: its first column may be a wave number, frequency or period",
                path="first_column",
                allowed="period, angular_frequency, wave_number",
                remedy="look up Output_frequency_type in ControlFile.in and give first_column",
            )
        column = "period"
    if column == "period" and not reported.hams:
        zero_frequency_code = -1.0 if zero_frequency_code is None else zero_frequency_code
        infinite_frequency_code = 0.0 if infinite_frequency_code is None else infinite_frequency_code
    gravity = reported.gravity if gravity is None else gravity
    length_scale = reported.length_scale if length_scale is None else length_scale
    water_depth = reported.water_depth if water_depth is None else water_depth
    if reference_point is None and reported.bodies:
        reference_point = [item.place for item in reported.bodies]
    require(
        first.name,
        gravity=gravity,
        length_scale=length_scale,
        water_depth=water_depth,
        reference_point=reference_point,
    )
    assert gravity is not None and length_scale is not None and water_depth is not None and reference_point is not None
    converter = _FirstColumn(column, zero_frequency_code, infinite_frequency_code, water_depth, gravity, first.name)
    omega, added_mass, damping, limits = _read_radiation(first, converter)
    count = added_mass.shape[1] // 6
    if reported.bodies and len(reported.bodies) != count:
        raise InputError(
            f"{first.name} holds modes of {count} bodies, its .pot file has {len(reported.bodies)}", path="coefficients"
        )
    directions, excitation = _read_forces(third, converter, omega, 6 * count)
    rotation = np.tile(_ROTATION, count)
    mass_scale = density * length_scale ** (3 + rotation[:, None] + rotation[None, :])
    force_scale = density * gravity * length_scale ** (2 + rotation)
    hydrostatics = find_companion(first, ".hst")
    stiffness = None
    if hydrostatics is not None:
        stiffness = (
            _read_stiffness(hydrostatics, 6 * count)
            * density
            * gravity
            * length_scale ** (2 + rotation[:, None] + rotation[None, :])
        )
    drift, of_all = _read_drift(first, converter, omega, directions, count)
    drift_scale = density * gravity * length_scale ** (1 + rotation)
    names = distinct([item.name for item in reported.bodies] or [""] * count) if count > 1 else ()
    dataset = assemble(
        program="HAMS" if reported.hams else "WAMIT",
        source=first.name,
        dofs=dof_names(names),
        omega=omega,
        added_mass=added_mass * mass_scale,
        radiation_damping=damping * mass_scale * omega[:, None, None],
        wave_direction=np.radians(directions),
        forces={"excitation_force": np.asarray(np.conj(excitation) * force_scale, dtype=complex)},
        density=density,
        gravity=gravity,
        water_depth=water_depth,
        reference_point=reference_point,
        limits={name: values * mass_scale for name, values in limits.items()},
        hydrostatic_stiffness=stiffness,
        mean_drift_force=None if drift is None else drift * drift_scale,
        mean_drift_of_all_bodies=None if of_all is None else of_all * drift_scale[[0, 1, 5]],
        bodies=names,
    )
    dataset = _in_global_axes(dataset, [item.angle for item in reported.bodies])
    return dataset if body is None else one_body(dataset, body)


def _in_global_axes(dataset: xr.Dataset, turned: list[float]) -> xr.Dataset:
    """Turn the motions of every body back by its XBODY(4); drift of single turned bodies is left out."""
    if not any(turned):
        return dataset
    motion = np.zeros((6 * len(turned), 6 * len(turned)))
    for number, angle in enumerate(turned):
        part = slice(6 * number, 6 * number + 6)
        motion[part, part] = turn_about_z(angle).T
    return transformed(dataset, motion)


@dataclass(frozen=True)
class _FirstColumn:
    """Turns the first column into angular frequency; the limits become 0 and infinity."""

    kind: FirstColumn
    zero_code: float | None
    infinite_code: float | None
    water_depth: float
    gravity: float
    source: str

    def __call__(self, values: Array) -> Array:
        omega = np.full(values.shape, np.nan)
        special = values <= 0.0
        if self.zero_code is not None:
            omega[values == self.zero_code] = 0.0
        if self.infinite_code is not None:
            omega[values == self.infinite_code] = np.inf
        undecided = special & np.isnan(omega)
        if np.any(undecided):
            raise InputError(
                f"{self.source}: {values[undecided][0]:g} in the first column ({self.kind}) may mean zero "
                "or infinite frequency",
                path="zero_frequency_code, infinite_frequency_code",
                remedy="state which by zero_frequency_code and infinite_frequency_code",
            )
        ordinary = np.isnan(omega)
        if self.kind == "period":
            omega[ordinary] = 2.0 * math.pi / values[ordinary]
        elif self.kind == "angular_frequency":
            omega[ordinary] = values[ordinary]
        elif self.kind == "wave_number":
            omega[ordinary] = angular_frequency(values[ordinary], self.water_depth, self.gravity)
        else:
            raise InputError(f"{self.kind!r}", path="first_column", allowed="period, angular_frequency, wave_number")
        return omega


def _read_radiation(path: Path, converter: _FirstColumn) -> tuple[Array, Array, Array, dict[str, Array]]:
    rows = read_table(path, (4, 5))
    keys = np.array([row[0] for row in rows])
    indices = np.array([row[1:3] for row in rows], dtype=int) - 1
    if indices.min() < 0 or indices.max() >= 6 * MOST_BODIES:
        raise InputError(
            f"{path.name}: mode {indices.max() + 1}", path="coefficients", allowed=f"1 to {6 * MOST_BODIES}"
        )
    modes = 6 * (int(indices.max()) // 6 + 1)
    values = np.array([row[3:] if len(row) == 5 else [row[3], np.nan] for row in rows])
    unique, inverse = np.unique(keys, return_inverse=True)
    omega = converter(unique)
    # Terms that WAMIT leaves out are zero by symmetry of the body
    added_mass = np.zeros((unique.size, modes, modes))
    damping = np.zeros((unique.size, modes, modes))
    # Row "i j" is the force in i for the motion j, so that j radiates
    added_mass[inverse, indices[:, 1], indices[:, 0]] = values[:, 0]
    damping[inverse, indices[:, 1], indices[:, 0]] = values[:, 1]
    ordinary = np.isfinite(omega) & (omega > 0.0)
    limits = {}
    for name, limit in (
        ("zero_frequency_added_mass", omega == 0.0),
        ("infinite_frequency_added_mass", np.isinf(omega)),
    ):
        if np.any(limit):
            limits[name] = added_mass[limit][0]
    return omega[ordinary], added_mass[ordinary], damping[ordinary], limits


def _read_forces(path: Path, converter: _FirstColumn, omega: Array, modes: int) -> tuple[Array, ComplexArray]:
    rows = np.array(read_table(path, (7,)))
    directions = np.unique(rows[:, 1])
    frequencies = converter(rows[:, 0])
    if not 1 <= rows[:, 2].min() <= rows[:, 2].max() <= modes:
        raise InputError(
            f"{path.name}: a force in mode {rows[:, 2].max():g}, the .1 file ends at mode {modes}", path="coefficients"
        )
    forces = np.zeros((omega.size, directions.size, modes), dtype=complex)
    found = np.zeros((omega.size, directions.size), dtype=bool)
    for row, frequency in zip(rows, frequencies):
        if frequency == 0.0 or not math.isfinite(frequency):
            continue
        i = _nearest(omega, frequency, path)
        j = int(np.searchsorted(directions, row[1]))
        forces[i, j, int(row[2]) - 1] = complex(row[5], row[6])
        found[i, j] = True
    if not found.all():
        raise InputError(
            f"{path.name}: {np.count_nonzero(~found)} pairs of frequency and heading have no exciting force",
            path="coefficients",
        )
    return directions, forces


def _nearest(omega: Array, frequency: float, path: Path) -> int:
    """Return the index of a frequency; the files print seven digits or fewer."""
    i = int(np.argmin(np.abs(omega - frequency)))
    if abs(omega[i] - frequency) > 2e-5 * frequency:
        raise InputError(f"{path.name}: frequency {frequency:.6g} rad/s is not in the .1 file", path="coefficients")
    return i


def _read_stiffness(path: Path, modes: int) -> NDArray[np.float64]:
    stiffness = np.zeros((modes, modes))
    for i, j, value in read_table(path, (3,)):
        if not (1 <= i <= modes and 1 <= j <= modes):
            raise InputError(f"{path.name}: modes {i:g} {j:g}, the .1 file ends at mode {modes}", path="coefficients")
        stiffness[int(i) - 1, int(j) - 1] = value
    return stiffness


def _read_drift(
    path: Path, converter: _FirstColumn, omega: Array, directions: Array, count: int
) -> tuple[Array | None, Array | None]:
    """Return the mean drift of long-crested waves on each body, and on several together.

    Of one body far-field momentum (.8) where it is there, else pressure (.9): momentum gives surge, sway and yaw and
    needs no velocities at the corners of the hull, where pressure integration is weakest. Of several bodies momentum
    gives their sum alone.
    """
    drift = np.full((omega.size, directions.size, 6 * count), np.nan)
    of_all = np.full((omega.size, directions.size, 6), np.nan)
    for suffix in (".8", ".9"):
        file = find_companion(path, suffix)
        if file is None:
            continue
        target = of_all if suffix == ".8" and count > 1 else drift
        for first, heading, second, mode, *_, real, _imaginary in read_table(file, (8,)):
            # Pairs of different headings belong to short-crested seas; negative modes repeat moments in body axes
            if heading != second or mode < 0:
                continue
            if mode > target.shape[2]:
                raise InputError(
                    f"{file.name}: drift in mode {mode:g}", path="coefficients", allowed=f"1 to {target.shape[2]}"
                )
            i = _nearest(omega, float(converter(np.array([first]))[0]), file)
            place = (i, int(np.argmin(np.abs(directions - heading))), int(mode) - 1)
            if np.isnan(target[place]):
                target[place] = real
    return (
        None if np.isnan(drift).all() else drift,
        None if np.isnan(of_all).all() else of_all[:, :, [0, 1, 5]],
    )


def _read_surroundings(path: Path) -> _Surroundings:
    gravity = length_scale = water_depth = None
    bodies: tuple[_WamitBody, ...] = ()
    column: FirstColumn | None = None
    potential = find_companion(path, ".pot")
    if potential is not None:
        water_depth, bodies = _read_potential_control(potential)
    own = find_companion(path, ".gdf")
    meshes = [] if own is None else [own]
    if own is None:
        meshes = [file for item in bodies if (file := find_companion(path.with_name(f"{item.name}.x"), ".gdf"))]
    scales = set()
    for mesh in meshes:
        numbers = leading_numbers(read_lines(mesh)[1])
        if len(numbers) >= 2:
            scales.add((numbers[0], numbers[1]))
    if len(scales) > 1:
        raise InputError(
            f"{path.name}: ULEN or GRAV differ between the .gdf files of the bodies",
            path="length_scale",
            remedy="run WAMIT with the same ULEN and GRAV in all of them",
        )
    if scales:
        length_scale, gravity = scales.pop()
    configuration = find_companion(path, ".cfg")
    if configuration is not None:
        for line in read_lines(configuration):
            key, _, value = line.partition("=")
            numbers = leading_numbers(value)
            if key.strip().upper() == "IPEROUT" and numbers and numbers[0] != 1:
                if numbers[0] != 2:
                    raise InputError(
                        f"{configuration.name}: IPEROUT = {numbers[0]:g}: the first column is a wave number",
                        path="first_column",
                        remedy="give first_column='wave_number' after dividing by ULEN, or run WAMIT with IPEROUT = 1",
                    )
                column = "angular_frequency"
    hams = any(entry.name.lower() == "controlfile.in" for entry in path.parent.iterdir())
    return _Surroundings(gravity, length_scale, water_depth, bodies, column, hams)


def _read_potential_control(path: Path) -> tuple[float | None, tuple[_WamitBody, ...]]:
    """Return depth and bodies of a .pot file in WAMIT's alternative form 2 (one number, HBOT, on its second line)."""
    lines = read_lines(path)
    if len(lines) < 2 or len(leading_numbers(lines[1])) != 1:
        return None, ()
    depth = leading_numbers(lines[1])[0]
    water_depth = depth if depth > 0.0 else math.inf
    bodies = []
    # The header may name files as well: meshes follow the depth
    for line, following in pairwise(lines[2:]):
        word = line.split()[0] if line.split() else ""
        numbers = leading_numbers(following)
        if word.lower().endswith(".gdf") and len(numbers) >= 4:
            stem = word.replace("\\", "/").split("/")[-1][:-4]
            bodies.append(_WamitBody(stem, (numbers[0], numbers[1], numbers[2]), math.radians(numbers[3])))
    return water_depth, tuple(bodies)
