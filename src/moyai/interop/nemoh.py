"""NEMOH results (version 2 and 3): Nemoh.cal and the folder Results with CM, CA and the exciting force.

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
from moyai.interop.coefficients import DOFS, assemble
from moyai.interop.textfiles import leading_numbers, parse_number, read_lines

_HEADING = re.compile(r"beta\s*=\s*([-+\d.eEdD]+)", re.IGNORECASE)
_FREQUENCY = {1: "angular frequency", 2: "frequency", 3: "period"}


@dataclass(frozen=True)
class _Control:
    """What Nemoh.cal tells."""

    density: float
    gravity: float
    water_depth: float
    dofs: tuple[str, ...]
    reference_point: tuple[float, float, float]
    frequency_type: int


@reads("results of NEMOH", named="coefficients")
def read_nemoh(folder: str | Path) -> xr.Dataset:
    """Read the results of one body.

    Parameters
    ----------
    folder : path
        Folder that holds ``Nemoh.cal`` and ``Results``; or the folder ``Results`` itself, or a file in it.

    Returns
    -------
    xarray.Dataset
        See :mod:`moyai.interop.coefficients`.

    Raises
    ------
    InputError
        Missing files, several bodies, degrees of freedom that are not rigid motions about one point.
    """
    place = Path(folder)
    place = place.parent if place.is_file() else place
    root = place.parent if place.name.lower() == "results" else place
    control = _read_control(_find(root, "Nemoh.cal"))
    results = _find(root, "Results")
    count = len(control.dofs)
    omega, added_mass = _read_matrices(_find(results, "CM.dat"), count, control.frequency_type)
    other, damping = _read_matrices(_find(results, "CA.dat"), count, control.frequency_type)
    if omega.shape != other.shape or not np.allclose(omega, other, rtol=1e-6):
        raise InputError("CM.dat and CA.dat hold different frequencies", path="coefficients")
    directions, excitation = _read_force(results, ("ExcitationForce.tec", "Fe.dat"), omega, control)
    forces = {"excitation_force": excitation}
    for name, file in (("Froude_Krylov_force", "FKForce.tec"), ("diffraction_force", "DiffractionForce.tec")):
        if (results / file).is_file():
            same, values = _read_force(results, (file,), omega, control)
            if np.array_equal(same, directions):
                forces[name] = values
    return assemble(
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
        reference_point=control.reference_point,
        hydrostatic_stiffness=_read_stiffness(root, control),
    )


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
    if int(entries[4][0]) != 1:
        raise InputError(f"{path.name}: {int(entries[4][0])} bodies", path="coefficients", allowed="one body")
    cursor = 7
    count = int(entries[cursor][0])
    names, points = [], set()
    for entry in entries[cursor + 1 : cursor + 1 + count]:
        name, point = _degree_of_freedom(entry, path)
        names.append(name)
        if point is not None:
            points.add(point)
    if len(points) > 1:
        raise InputError(f"{path.name}: rotations about different points", path="coefficients", allowed="one point")
    cursor += count + 1
    forces = entries[cursor + 1 : cursor + 1 + int(entries[cursor][0])]
    if [_degree_of_freedom(entry, path) for entry in forces] != [
        _degree_of_freedom(entry, path) for entry in entries[8 : 8 + count]
    ]:
        raise InputError(f"{path.name}: generalised forces differ from the degrees of freedom", path="coefficients")
    # The first line after the bodies: (type,) number, least and largest frequency; version 2 has no type, always rad/s
    extra = int(entries[cursor + 1 + len(forces)][0])
    frequencies = entries[cursor + 2 + len(forces) + extra]
    frequency_type = _output_type(lines, int(frequencies[0]) if len(frequencies) == 4 else 1)
    point = points.pop() if points else (0.0, 0.0, 0.0)
    return _Control(density, gravity, depth if depth > 0.0 else math.inf, tuple(names), point, frequency_type)


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
    headings: list[float] = []
    zones: list[list[list[float]]] = []
    for line in read_lines(path):
        heading = _HEADING.search(line)
        if heading:
            headings.append(float(heading[1].replace("D", "E").replace("d", "e")))
            zones.append([])
        elif zones and line.strip():
            zones[-1].append([value for value in map(parse_number, line.split()) if value is not None])
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
    """Return the hydrostatic stiffness of Mesh/KH.dat, where it is there, for the degrees of freedom of the run."""
    for folder in (root / "Mesh", root / "mesh", root):
        path = folder / "KH.dat"
        if path.is_file():
            table = np.array([leading_numbers(line) for line in read_lines(path) if line.strip()])
            if table.shape == (6, 6):
                chosen = [DOFS.index(name) for name in control.dofs]
                return table[np.ix_(chosen, chosen)]
    return None
