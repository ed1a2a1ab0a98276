"""ANSYS AQWA's .AH1 file: coefficients of one or several structures, SI, each about its centre of gravity.

AQWA's time factor is exp(-i omega t), like ours: the heave force of a floating body leads the crest, its phase is
negative. Where a centre of gravity lies off x = y = 0 the file does not say whether phases refer to it or to the
origin: this is taken from the user or refused.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Literal

import numpy as np
import xarray as xr

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.foreign_files import reads
from moyai.core.options import checks_words
from moyai.interop.bodies import one_body, refer_phase
from moyai.interop.coefficients import assemble, dof_names
from moyai.interop.textfiles import parse_number, read_lines

#: Structures of a file; beyond, the number is taken for a mistake
MOST_BODIES = 60
Sections = dict[str, list[list[float]]]


@checks_words
@reads("a file of AQWA", named="coefficients")
def read_aqwa(
    path: str | Path,
    *,
    phase_at: Literal["centre_of_gravity", "origin"] | None = None,
    body: int | str | None = None,
) -> xr.Dataset:
    """Read the structures of an .AH1 file.

    Parameters
    ----------
    path : path
        File.
    phase_at : {"centre_of_gravity", "origin"}, optional
        Where the crest of the wave is that phases refer to; needed when a centre of gravity lies off x = y = 0.
    body : int or str, optional
        Number of one of several structures, from 1; all of them when absent.

    Returns
    -------
    xarray.Dataset
        Added mass [kg, kg m, kg m2], damping, forces per unit wave amplitude [N/m, N m/m] about ``reference_point``;
        see :mod:`moyai.interop.coefficients`.

    Raises
    ------
    InputError
        Not such a file, no such structure, a centre of gravity off the origin without ``phase_at``.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> import numpy as np
    >>> from moyai.interop import read_aqwa
    >>> def rows(diagonal):
    ...     text = [" ".join(map(str, row)) for row in np.diag(diagonal)]
    ...     return [f"1 1 1 {text[0]}", *text[1:]]
    ...
    >>> lines = ["* one structure, one heading, one frequency", "1 1 1 0.0", "1.0"]
    >>> lines += ["GENERAL", "1 30.0 1025.0 9.81 0 0", "COG", "1 0.0 0.0 -0.5"]
    >>> lines += ["ADDEDMASS", *rows([9e4, 9e4, 1e5, 2e5, 2e5, 2e5]), "DAMPING", *rows([1e3] * 6)]
    >>> lines += ["FORCERAO", "1 1 1 1e5 0 2e5 0 1e4 0", "0 0 0 0 0 0"]
    >>> file = Path(mkdtemp()) / "barge.AH1"
    >>> np.savetxt(file, lines, fmt="%s")
    >>> barge = read_aqwa(file)
    >>> float(barge.added_mass.sel(omega=1.0, influenced_dof="Heave", radiating_dof="Heave"))   # [kg]
    100000.0
    """
    file = Path(path)
    sections = _read_sections(file)
    for name in ("", "GENERAL", "COG", "ADDEDMASS", "DAMPING", "FORCERAO"):
        if name not in sections:
            raise InputError(f"{file.name} has no section {name or 'of frequencies'}", path="coefficients")
    header = [value for row in sections[""] for value in row]
    structures, headings, count = (int(value) for value in header[:3])
    if not 1 <= structures <= MOST_BODIES:
        raise InputError(f"{file.name}: {structures} structures", path="coefficients", allowed=f"1 to {MOST_BODIES}")
    directions = np.array(header[3 : 3 + headings])
    omega = np.array(header[3 + headings : 3 + headings + count])
    depth, density, gravity = sections["GENERAL"][0][1:4]
    centres = np.array([row[-3:] for row in sections["COG"]])
    if centres.shape != (structures, 3):
        raise InputError(
            f"{file.name}: {len(centres)} centres of gravity", path="coefficients", allowed=f"{structures}"
        )
    off = np.flatnonzero(np.abs(centres[:, :2]).max(axis=1) > 1e-9)
    if off.size and phase_at is None:
        x, y = centres[off[0], :2]
        raise InputError(
            f"{file.name}: centre of gravity at x = {x:g}, y = {y:g} m: do phases refer to it?",
            path="phase_at",
            allowed="centre_of_gravity, origin",
            remedy="look up the wave phase of the run of AQWA and give phase_at",
        )
    names = tuple(str(number) for number in range(1, structures + 1)) if structures > 1 else ()
    size = 6 * structures
    force_rows = np.array([row[-6:] for row in sections["FORCERAO"]])
    if len(force_rows) != 2 * structures * headings * count:
        raise InputError(
            f"{file.name}: {len(force_rows)} rows of forces of {structures} structures in {headings} directions at "
            f"{count} frequencies",
            path="coefficients",
        )
    force_rows = force_rows.reshape(structures, headings, count, 2, 6)
    each = force_rows[:, :, :, 0] * np.exp(1j * np.radians(force_rows[:, :, :, 1]))
    excitation = each.transpose(2, 1, 0, 3).reshape(count, headings, size)
    limits = {}
    for name, key in (("zero_frequency_added_mass", "ADDEDMASS_LF"), ("infinite_frequency_added_mass", "ADDEDMASS_HF")):
        if key in sections:
            limits[name] = _matrices(sections[key], 1, structures, file)[0]
    # -180 and 180 degrees are the same wave
    _, kept = np.unique(np.round(np.mod(directions, 360.0), 6), return_index=True)
    stiffness = None
    if "HYDSTIFFNESS" in sections:
        rows = np.array([row[-6:] for row in sections["HYDSTIFFNESS"]]).reshape(structures, 6, 6)
        from scipy.linalg import block_diag

        stiffness = block_diag(*rows)
    dataset = assemble(
        program="AQWA",
        source=file.name,
        dofs=dof_names(names),
        omega=omega,
        added_mass=_matrices(sections["ADDEDMASS"], count, structures, file),
        radiation_damping=_matrices(sections["DAMPING"], count, structures, file),
        wave_direction=np.radians(directions[kept]),
        forces={"excitation_force": excitation[:, kept]},
        density=density,
        gravity=gravity,
        water_depth=depth if depth > 0.0 else math.inf,
        reference_point=centres,
        limits=limits,
        hydrostatic_stiffness=stiffness,
        bodies=names,
    )
    if phase_at == "centre_of_gravity":
        dataset = _from_centres(dataset, centres)
    return dataset if body is None else one_body(dataset, body)


def _from_centres(dataset: xr.Dataset, centres: Array) -> xr.Dataset:
    """Refer phases that refer to each centre of gravity to x = y = 0."""
    shifted = [refer_phase(dataset, -centre[:2])["excitation_force"].values for centre in centres]
    parts = [values[:, :, 6 * number : 6 * number + 6] for number, values in enumerate(shifted)]
    return dataset.assign(excitation_force=dataset["excitation_force"].copy(data=np.concatenate(parts, axis=2)))


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


def _matrices(rows: list[list[float]], count: int, structures: int, path: Path) -> Array:
    """Return (frequency, radiating, influenced): of each pair of structures six rows a frequency, row i the force."""
    if len(rows) != 6 * count * structures**2:
        raise InputError(
            f"{path.name}: {len(rows)} rows of 6 x 6 matrices of {structures} structures at {count} frequencies",
            path="coefficients",
        )
    blocks = np.array([row[-6:] for row in rows]).reshape(structures, structures, count, 6, 6)
    size = 6 * structures
    return np.asarray(blocks.transpose(2, 1, 4, 0, 3).reshape(count, size, size))
