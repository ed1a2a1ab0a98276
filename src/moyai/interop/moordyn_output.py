"""Output files of MoorDyn: a row of channel names, a row of units, then numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.foreign_files import reads
from moyai.interop.textfiles import parse_number, read_lines

#: Factors to SI of the units that MoorDyn prints.
_TO_SI = {
    "s": 1.0, "m": 1.0, "m/s": 1.0, "m/s2": 1.0, "n": 1.0, "kn": 1e3, "nm": 1.0, "deg": math.pi / 180.0,
    "deg/s": math.pi / 180.0, "frac": 1.0, "(frac)": 1.0, "-": 1.0, "": 1.0,
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class MoorDynOutput:
    """Channels over time."""

    #: [s]; shape (k,).
    time: Array
    #: Channels in SI units (forces in N, angles in rad), by the names of the file.
    channels: Mapping[str, Array]
    #: Units that the file states, empty where it states none.
    units: Mapping[str, str]

    def channel(self, name: str) -> Array:
        """Return one channel in SI units, its name in any case of letters.

        Parameters
        ----------
        name : str
            As in the header of the file.

        Raises
        ------
        InputError
            When the file has none of that name.
        """
        for known, values in self.channels.items():
            if known.lower() == name.lower():
                return values
        raise InputError(f"no channel {name!r}", path="channel", allowed=", ".join(self.channels))


@reads("an output file of MoorDyn", named="output")
def read_output(path: str | Path) -> MoorDynOutput:
    """Read an output file (``.out``) of MoorDyn, by itself or within OpenFAST.

    Parameters
    ----------
    path : path
        File.

    Returns
    -------
    MoorDynOutput
        Time [s], shape (k,), and channels in SI units and radians.

    Raises
    ------
    InputError
        A file that is absent or empty, without a time column, with rows of another length or with words among the
        numbers (file and line are named).

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> from moyai.interop import read_output
    >>> file = Path(mkdtemp(), "lines.out")
    >>> _ = file.write_text("Time FairTen1\\n(s) (kN)\\n0.0 12.5\\n0.1 12.75\\n")
    >>> read_output(file).channels["FairTen1"].tolist()
    [12500.0, 12750.0]
    """
    place = Path(path)
    lines = read_lines(place)
    # OpenFAST writes remarks above the names
    first = next(
        (i for i, line in enumerate(lines) if line.split() and line.split()[0].lower().startswith("time")), None
    )
    if first is None:
        raise InputError(f"{place.name}: no row of channel names that starts with Time", path="output")
    names = lines[first].replace(",", " ").split()
    repeated = sorted({name for name in names if names.count(name) > 1})
    if repeated:
        raise InputError(f"{place.name}:{first + 1}: channel {repeated[0]!r} is given twice", path="output")
    units: list[str] = [""] * len(names)
    rows: list[list[float]] = []
    for index in range(first + 1, len(lines)):
        tokens = lines[index].replace(",", " ").split()
        if not tokens:
            continue
        values = [parse_number(token) for token in tokens]
        if not rows and index == first + 1 and values[0] is None:
            units = [token.strip("()") for token in tokens] if len(tokens) == len(names) else units
            continue
        numbers = [value for value in values if value is not None]
        if len(tokens) != len(names) or len(numbers) != len(tokens):
            raise InputError(
                f"{place.name}:{index + 1}: {len(tokens)} columns, {len(numbers)} of them numbers",
                path="output",
                allowed=f"{len(names)} numbers",
            )
        rows.append(numbers)
    if not rows:
        raise InputError(f"{place.name} holds no rows of numbers", path="output")
    table = np.array(rows)
    for column, (name, unit) in enumerate(zip(names, units, strict=True)):
        key = unit.lower().replace("^", "").replace("-m", "m").replace("*", "")
        if key not in _TO_SI:
            raise InputError(
                f"{place.name}:{first + 2}: unit {unit!r} of {name!r} is unknown",
                path="output",
                allowed=", ".join(_TO_SI),
            )
        table[:, column] *= _TO_SI[key]
    table.setflags(write=False)
    return MoorDynOutput(
        table[:, 0],
        {name: table[:, i] for i, name in enumerate(names) if i > 0},
        dict(zip(names, units, strict=True)),
    )
