"""NEMOH results (version 2 and 3): Nemoh.cal and the folder Results with CM, CA and the exciting force.

Of several bodies the motions of all follow one another in the rows and columns. Phases refer to the wave measurement
point (XEFF, YEFF) of Nemoh.cal; here they are referred to x = y = 0. Version 2 has RadiationCoefficients.tec in place
of CM and CA.

SI units. NEMOH's time factor is exp(-i omega t), like ours: the heave force of a floating body leads the crest, since
radiation damping follows the velocity, and its phase is negative. A depth of 0 stands for infinite depth. Row i,
column j of CM and CA is the force j for the motion i.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import xarray as xr

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.foreign_files import reads
from moyai.interop.bodies import distinct, one_body, refer_phase
from moyai.interop.coefficients import DOFS, assemble, dof_names
from moyai.interop.textfiles import leading_numbers, parse_number, read_lines

_HEADING = re.compile(r"beta\s*=\s*([-+\d.eEdD]+)", re.IGNORECASE)
_MOTION = re.compile(r"(Motion of body.*)", re.IGNORECASE)
_FREQUENCY = {1: "angular frequency", 2: "frequency", 3: "period"}


@dataclass(frozen=True)
class _Control:
    """What Nemoh.cal gives."""

    density: float
    gravity: float
    water_depth: float
    dofs: tuple[str, ...]
    bodies: tuple[str, ...]
    reference_points: tuple[tuple[float, float, float], ...]
    wave_point: tuple[float, float]
    frequency_type: int


@reads("results of NEMOH", named="coefficients")
def read_nemoh(folder: str | Path, *, body: int | str | None = None) -> xr.Dataset:
    """Read the results of one or several bodies.

    Parameters
    ----------
    folder : path
        Folder that holds ``Nemoh.cal`` and ``Results``; or the folder ``Results`` itself, or a file in it.
    body : int or str, optional
        One of several bodies, by number from 1 or by the name of its mesh; all of them when absent.

    Returns
    -------
    xarray.Dataset
        Added mass [kg, kg m, kg m2], damping, forces per unit wave amplitude [N/m, N m/m] about ``reference_point``;
        see :mod:`moyai.interop.coefficients`.

    Raises
    ------
    InputError
        Missing files, no such body, degrees of freedom that are not rigid motions about one point of each body.

    Examples
    --------
    >>> from tempfile import mkdtemp
    >>> from moyai.interop import from_planar, read_nemoh, write_coefficients
    >>> from moyai.potential import rigid_modes, shapes, solve
    >>> from moyai.sea import Water
    >>> section = shapes.rectangle(beam=4.0, height=2.0).immersed(draught=1.0)
    >>> found = solve(section, Water(10.0, 1025.0, 9.81), [0.5, 1.0], modes=rigid_modes((0.0, -0.2)))
    >>> unit = from_planar(found.dataset, length=20.0, centre_of_gravity=(0.0, -0.2))
    >>> folder = mkdtemp()
    >>> _ = write_coefficients("nemoh", unit, folder)
    >>> float(abs(read_nemoh(folder).added_mass - unit.added_mass).max()) < 1.0   # [kg]
    True
    """
    place = Path(folder)
    place = place.parent if place.is_file() else place
    root = place.parent if place.name.lower() == "results" else place
    control = _read_control(_find(root, "Nemoh.cal"))
    results = _find(root, "Results")
    count = len(control.dofs)
    omega, added_mass, damping = _read_radiation(results, count, control.frequency_type)
    directions, excitation = _read_force(results, ("ExcitationForce.tec", "Fe.dat"), omega, control)
    forces = {"excitation_force": excitation}
    for name, file in (("Froude_Krylov_force", "FKForce.tec"), ("diffraction_force", "DiffractionForce.tec")):
        if (results / file).is_file():
            same, values = _read_force(results, (file,), omega, control)
            if np.array_equal(same, directions):
                forces[name] = values
    dataset = assemble(
        program="NEMOH",
        source=root.name,
        dofs=control.dofs,
        omega=omega,
        added_mass=added_mass,
        radiation_damping=damping,
        wave_direction=np.radians(directions),
        forces=forces,
        density=control.density,
        gravity=control.gravity,
        water_depth=control.water_depth,
        reference_point=control.reference_points,
        hydrostatic_stiffness=_read_stiffness(root, control),
        bodies=control.bodies,
    )
    # The wave has its crest over the measurement point: the origin lies at minus that point from there
    dataset = refer_phase(dataset, -np.array(control.wave_point))
    return dataset if body is None else one_body(dataset, body)


def _find(folder: Path, name: str) -> Path:
    """Return an entry of a folder in any case of letters."""
    if folder.is_dir():
        for entry in sorted(folder.iterdir()):
            if entry.name.lower() == name.lower():
                return entry
    raise InputError(f"no {name} in {folder}", path="coefficients")


def _read_control(path: Path) -> _Control:
    # Section titles start with dashes; the rest is one entry a line, in a fixed order
    lines = [line for line in read_lines(path) if line.strip() and not line.lstrip().startswith("--")]
    entries = [leading_numbers(line) for line in lines]
    density, gravity, depth = entries[0][0], entries[1][0], entries[2][0]
    wave_point = (entries[3][0], entries[3][1]) if len(entries[3]) > 1 else (0.0, 0.0)
    count = int(entries[4][0])
    names, dofs, points = [], [], []
    cursor = 5
    for _ in range(count):
        # mesh, size of the mesh, motions, forces, additional lines
        names.append(lines[cursor].split()[0].replace("\\", "/").split("/")[-1].rsplit(".", 1)[0])
        motions, cursor = _block(entries, cursor + 2)
        forces, cursor = _block(entries, cursor)
        cursor += int(entries[cursor][0]) + 1
        found = [_degree_of_freedom(entry, path) for entry in motions]
        if [_degree_of_freedom(entry, path) for entry in forces] != found:
            raise InputError(f"{path.name}: generalised forces differ from the degrees of freedom", path="coefficients")
        about = {point for _, point in found if point is not None}
        if len(about) > 1:
            raise InputError(f"{path.name}: rotations about different points", path="coefficients", allowed="one point")
        dofs.append([name for name, _ in found])
        points.append(about.pop() if about else (0.0, 0.0, 0.0))
    bodies = distinct(names) if count > 1 else ()
    named = [f"{body}__{name}" for body, own in zip(bodies, dofs) for name in own] if bodies else dofs[0]
    # The first line after the bodies: (type,) number, least and largest frequency; version 2 has no type, always rad/s
    frequencies = entries[cursor]
    frequency_type = _output_type(lines, int(frequencies[0]) if len(frequencies) == 4 else 1)
    return _Control(
        density, gravity, depth if depth > 0.0 else math.inf, tuple(named), bodies, tuple(points), wave_point,
        frequency_type,
    )  # fmt: skip


def _block(entries: list[list[float]], cursor: int) -> tuple[list[list[float]], int]:
    """Return the lines that a line with their number announces, and where the next one stands."""
    end = cursor + 1 + int(entries[cursor][0])
    return entries[cursor + 1 : end], end


def _output_type(lines: list[str], stated: int) -> int:
    """Return the unit of the frequencies in the results: version 3 states it, older ones repeat that of the input."""
    for line in lines:
        if "output freq type" in line.lower():
            return int(leading_numbers(line)[0])
    return stated


def _degree_of_freedom(entry: list[float], path: Path) -> tuple[str, tuple[float, float, float] | None]:
    if len(entry) < 4 or int(entry[0]) not in (1, 2):
        raise InputError(f"{path.name}: degree of freedom {entry} is not a rigid motion", path="coefficients")
    axis = np.array(entry[1:4])
    if np.count_nonzero(axis) != 1 or axis.sum() != 1.0:
        raise InputError(f"{path.name}: degree of freedom {entry} is not along or about an axis", path="coefficients")
    number = int(np.argmax(axis)) + (3 if int(entry[0]) == 2 else 0)
    point = (entry[4], entry[5], entry[6]) if int(entry[0]) == 2 and len(entry) >= 7 else None
    return DOFS[number], point


def _to_omega(values: Array, frequency_type: int) -> Array:
    if frequency_type == 1:
        return values
    if frequency_type == 2:
        return 2.0 * math.pi * values
    if frequency_type == 3:
        return 2.0 * math.pi / values
    raise InputError(f"frequency type {frequency_type}", path="coefficients", allowed=str(_FREQUENCY))


def _read_radiation(results: Path, count: int, frequency_type: int) -> tuple[Array, Array, Array]:
    """Return frequencies, added mass and damping (frequency, radiating, influenced)."""
    if (
        not any((results / name).is_file() for name in ("CM.dat", "cm.dat"))
        and (old := results / "RadiationCoefficients.tec").is_file()
    ):
        zones = [np.array(zone) for _, zone in _zones(old, _MOTION)]
        if len(zones) != count or any(zone.shape != (len(zones[0]), 1 + 2 * count) for zone in zones):
            raise InputError(
                f"{old.name}: expected {count} zones of rows of {1 + 2 * count} numbers", path="coefficients"
            )
        table = np.array(zones).swapaxes(0, 1)
        return _to_omega(table[:, 0, 0], frequency_type), table[:, :, 1::2], table[:, :, 2::2]
    omega, added_mass = _read_matrices(_find(results, "CM.dat"), count, frequency_type)
    other, damping = _read_matrices(_find(results, "CA.dat"), count, frequency_type)
    if omega.shape != other.shape or not np.allclose(omega, other, rtol=1e-6):
        raise InputError("CM.dat and CA.dat hold different frequencies", path="coefficients")
    # Row i, column j is the force j for the motion i
    return omega, added_mass, damping


def _zones(path: Path, title: re.Pattern[str]) -> list[tuple[str, list[list[float]]]]:
    """Return what the title of each zone holds, with its rows of numbers."""
    zones: list[tuple[str, list[list[float]]]] = []
    for line in read_lines(path):
        found = title.search(line)
        if found:
            zones.append((found[1], []))
        elif zones and line.strip():
            zones[-1][1].append([value for value in map(parse_number, line.split()) if value is not None])
    return zones


def _read_matrices(path: Path, count: int, frequency_type: int) -> tuple[Array, Array]:
    numbers = [parse_number(token) for line in read_lines(path)[1:] for token in line.split()]
    block = 1 + count * count
    if any(number is None for number in numbers) or not numbers or len(numbers) % block:
        raise InputError(
            f"{path.name}: {len(numbers)} numbers are not blocks of a frequency and {count} x {count} terms",
            path="coefficients",
        )
    table = np.array(numbers, dtype=float).reshape(-1, block)
    return _to_omega(table[:, 0], frequency_type), table[:, 1:].reshape(-1, count, count)


def _read_force(results: Path, names: tuple[str, ...], omega: Array, control: _Control) -> tuple[Array, ComplexArray]:
    """Read the first file that exists; one zone a heading, modulus and phase of every force."""
    path = next((results / name for name in names if (results / name).is_file()), None)
    if path is None:
        raise InputError(f"no {' or '.join(names)} in {results}", path="coefficients")
    count = len(control.dofs)
    found = _zones(path, _HEADING)
    headings = [float(heading.replace("D", "E").replace("d", "e")) for heading, _ in found]
    zones = [zone for _, zone in found]
    if not zones or any(len(zone) != omega.size or any(len(row) != 1 + 2 * count for row in zone) for zone in zones):
        raise InputError(
            f"{path.name}: expected a zone of {omega.size} rows of {1 + 2 * count} numbers for every heading",
            path="coefficients",
        )
    table = np.array(zones)
    frequencies = _to_omega(table[0, :, 0], control.frequency_type)
    # Fe.dat prints four decimals of the frequency
    if not np.allclose(frequencies, omega, rtol=1e-5, atol=6e-5):
        raise InputError(f"{path.name}: other frequencies than in CM.dat", path="coefficients")
    if path.suffix.lower() == ".tec":
        modulus, phase = table[:, :, 1::2], table[:, :, 2::2]
    else:
        modulus, phase = table[:, :, 1 : 1 + count], np.radians(table[:, :, 1 + count :])
    return np.array(headings), np.swapaxes(modulus * np.exp(1j * phase), 0, 1)


def _read_stiffness(root: Path, control: _Control) -> Array | None:
    """Return the hydrostatic stiffness of KH.dat (KH_0.dat ... of several bodies) for the degrees of freedom."""
    names = [f"KH_{number}.dat" for number in range(len(control.bodies))] or ["KH.dat"]
    for folder in (root / "Mesh", root / "mesh", root):
        if not all((folder / name).is_file() for name in names):
            continue
        tables = [
            np.array([leading_numbers(line) for line in read_lines(folder / name) if line.strip()]) for name in names
        ]
        if all(table.shape == (6, 6) for table in tables):
            chosen = [dof_names(control.bodies).index(name) for name in control.dofs]
            from scipy.linalg import block_diag

            return np.asarray(block_diag(*tables)[np.ix_(chosen, chosen)])
    return None
