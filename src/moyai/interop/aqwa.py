"""ANSYS AQWA's .AH1 file: coefficients of one structure, SI, about its centre of gravity.

AQWA's time factor is exp(-i omega t), like ours: the heave force of a floating body leads the crest, its phase is
negative. Phases refer to the wave at the centre of gravity; a centre of gravity off x = y = 0 would need a shift that
could not be tested, and is refused.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import xarray as xr

from moyai.core.errors import InputError
from moyai.core.foreign_files import reads
from moyai.interop.coefficients import DOFS, assemble
from moyai.interop.textfiles import parse_number, read_lines

Sections = dict[str, list[list[float]]]


@reads("a file of AQWA", named="coefficients")
def read_aqwa(path: str | Path) -> xr.Dataset:
    """Read one structure from an .AH1 file.

    Parameters
    ----------
    path : path
        File.

    Returns
    -------
    xarray.Dataset
        See :mod:`moyai.interop.coefficients`.

    Raises
    ------
    InputError
        Not such a file, several structures, a centre of gravity off the origin.
    """
    file = Path(path)
    sections = _read_sections(file)
    for name in ("", "GENERAL", "COG", "ADDEDMASS", "DAMPING", "FORCERAO"):
        if name not in sections:
            raise InputError(f"{file.name} has no section {name or 'of frequencies'}", path="coefficients")
    header = [value for row in sections[""] for value in row]
    structures, headings, count = (int(value) for value in header[:3])
    if structures != 1:
        raise InputError(f"{file.name}: {structures} structures", path="coefficients", allowed="one")
    directions = np.array(header[3 : 3 + headings])
    omega = np.array(header[3 + headings : 3 + headings + count])
    depth, density, gravity = sections["GENERAL"][0][1:4]
    centre = sections["COG"][0][1:4]
    if abs(centre[0]) > 1e-9 or abs(centre[1]) > 1e-9:
        raise InputError(
            f"{file.name}: centre of gravity at x = {centre[0]:g}, y = {centre[1]:g} m",
            path="coefficients",
            allowed="x = y = 0",
            remedy="run AQWA with the body centred, and place it with origin of to_planar",
        )
    added_mass = _matrices(sections["ADDEDMASS"], count, file)
    damping = _matrices(sections["DAMPING"], count, file)
    force_rows = np.array([row[-6:] for row in sections["FORCERAO"]]).reshape(headings, count, 2, 6)
    excitation = np.moveaxis(force_rows[:, :, 0] * np.exp(1j * np.radians(force_rows[:, :, 1])), 0, 1)
    limits = {}
    for name, key in (("zero_frequency_added_mass", "ADDEDMASS_LF"), ("infinite_frequency_added_mass", "ADDEDMASS_HF")):
        if key in sections:
            limits[name] = np.array([row[-6:] for row in sections[key]]).reshape(6, 6).T
    # -180 and 180 degrees are the same wave
    _, kept = np.unique(np.round(np.mod(directions, 360.0), 6), return_index=True)
    stiffness = np.array([row[-6:] for row in sections["HYDSTIFFNESS"]]) if "HYDSTIFFNESS" in sections else None
    return assemble(
        program="AQWA",
        source=file.name,
        dofs=DOFS,
        omega=omega,
        added_mass=added_mass,
        radiation_damping=damping,
        wave_direction=np.radians(directions[kept]),
        forces={"excitation_force": excitation[:, kept]},
        density=density,
        gravity=gravity,
        water_depth=depth if depth > 0.0 else math.inf,
        reference_point=centre,
        limits=limits,
        hydrostatic_stiffness=stiffness,
    )


def _read_sections(path: Path) -> Sections:
    """Return the rows of numbers under each section title; the rows before the first title under an empty one."""
    sections: Sections = {"": []}
    title = ""
    for number, line in enumerate(read_lines(path), start=1):
        if line.startswith("*") or not line.strip():
            continue
        tokens = line.split()
        values = [parse_number(token) for token in tokens]
        row = [value for value in values if value is not None]
        if len(row) == len(tokens):
            sections[title].append(row)
        elif not row and len(tokens) == 1:
            title = tokens[0]
            sections.setdefault(title, [])
        else:
            raise InputError(f"{path.name}:{number}: neither numbers nor the title of a section", path="coefficients")
    return sections


def _matrices(rows: list[list[float]], count: int, path: Path) -> np.ndarray:
    """Return (frequency, radiating, influenced): six rows a frequency, row i the force in i."""
    if len(rows) != 6 * count:
        raise InputError(f"{path.name}: {len(rows)} rows of a 6 x 6 matrix at {count} frequencies", path="coefficients")
    return np.array([row[-6:] for row in rows]).reshape(count, 6, 6).transpose(0, 2, 1)
