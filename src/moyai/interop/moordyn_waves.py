"""Waves of the files next to a MoorDyn deck, as a sum of linear waves at the nodes.

MoorDyn 2.7.2 takes the amplitudes of ``wave_frequencies.txt`` as Re(A e^{i omega t}) with WaveKin 2 and as
Im(A e^{i omega t}) with WaveKin 7: both are read as MoorDyn takes them. Its grid (``water_grid.txt``) is not needed:
every node has the sum of all waves.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from moyai.core.errors import Fault, InputError
from moyai.interop.moordyn_records import ELEVATION_FILE, FREQUENCY_FILE, DeckOption, DeckWaves
from moyai.interop.moordyn_rows import Faults
from moyai.interop.textfiles import parse_number, read_lines
from moyai.sea.components import WaveComponents
from moyai.sea.dispersion import wave_number
from moyai.sea.elevation_record import components_of_record
from moyai.sea.water import Water

#: Most frequencies that WaveKin 2 may be filled up to.
MOST_FREQUENCIES = 20_000


def read_waves(
    option: DeckOption, time_step: float | None, folder: Path, faults: Faults, notes: list[str]
) -> DeckWaves | None:
    """Return the waves that the option WaveKin of a deck requires.

    Parameters
    ----------
    option : DeckOption
        WaveKin 2, 3 or 7.
    time_step : float or None
        The option dtWave [s].
    folder : Path
        Of the deck.
    faults : Faults
    notes : list of str
        What a user should know and is no error.
    """
    recorded = option.value == 3.0
    if option.value == 2.0 and not (folder / FREQUENCY_FILE).is_file() and (folder / ELEVATION_FILE).is_file():
        recorded = True
        notes.append(
            f"line {option.line}: WaveKin 2 without {FREQUENCY_FILE}: {ELEVATION_FILE} is read, as with WaveKin 3 "
            "(MoorDyn 2.7.2 itself stops here)"
        )
    name = ELEVATION_FILE if recorded else FREQUENCY_FILE
    if not (folder / name).is_file():
        faults.add(option.line, f"WaveKin is {option.value:g}, but there is no {name} next to the deck", path="WaveKin")
        return None
    rows = _rows(folder / name, (2,) if recorded else (3, 4), faults)
    if rows is None:
        return None
    if recorded:
        return _of_record(rows, name, time_step, faults, notes)
    return _of_frequencies(rows, name, option.value == 2.0, faults, notes)


def read_elevation(place: Path, time_step: float | None, faults: Faults, notes: list[str]) -> DeckWaves | None:
    """Return the waves of a record of the elevation at the origin: rows of time [s] and elevation [m]."""
    rows = _rows(place, (2,), faults)
    return None if rows is None else _of_record(rows, place.name, time_step, faults, notes)


def _rows(file: Path, widths: tuple[int, ...], faults: Faults) -> list[list[float]] | None:
    """Return the rows of numbers of a file."""
    rows: list[list[float]] = []
    for number, text in enumerate(read_lines(file), start=1):
        words = text.replace(",", " ").split()
        if not words:
            continue
        values = [parse_number(word) for word in words]
        row = [value for value in values if value is not None and math.isfinite(value)]
        if not rows and not row:
            continue  # a heading
        if len(row) != len(values) or len(row) not in widths:
            what = "time and elevation" if widths == (2,) else "frequency, real and imaginary part, maybe a direction"
            faults.found.append(Fault(f"a row is not {what}", "WaveKin", "", "", file.name, number, 1))
            return None
        rows.append(row)
    if not rows:
        faults.found.append(Fault("the file holds no rows", "WaveKin", "", "", file.name, 0, 0))
        return None
    return rows


def _of_record(
    rows: list[list[float]], name: str, time_step: float | None, faults: Faults, notes: list[str]
) -> DeckWaves | None:
    table = np.array(rows)
    try:
        found = components_of_record(table[:, 0], table[:, 1], step=time_step)
    except InputError as error:
        fault = error.fault
        faults.found.append(Fault(fault.message, "WaveKin", fault.allowed, fault.remedy, name, 0, 0))
        return None
    if abs(found.mean) > 1e-3 * float(np.max(found.amplitude)):
        notes.append(f"{name}: the mean elevation of {found.mean:.3g} m is no wave and is left out")
    real, imaginary = found.amplitude * np.sin(found.phase), found.amplitude * np.cos(found.phase)
    omega, sines, cosines = (tuple(map(float, column)) for column in (found.omega, real, imaginary))
    return DeckWaves(omega, sines, cosines, (0.0,) * len(omega), name, time_step, found.period)


def _of_frequencies(
    rows: list[list[float]], name: str, filled: bool, faults: Faults, notes: list[str]
) -> DeckWaves | None:
    def refuse(message: str, allowed: str = "") -> None:
        faults.found.append(Fault(message, "WaveKin", allowed, "", name, 0, 0))

    table = np.array([[*row, 0.0][:4] for row in rows])
    if table[:, 0].min() < 0.0:
        refuse(f"a frequency is {table[:, 0].min():g} rad/s", "0 or more")
        return None
    if filled:
        gaps = np.diff(table[:, 0])
        if len(table) < 2 or table[0, 0] != 0.0 or not (gaps > 0.0).all():
            refuse("frequencies of WaveKin 2 do not rise from 0", "two rows or more, the first with 0 rad/s")
            return None
        count = round(table[-1, 0] / float(gaps.min())) + 1
        if count > MOST_FREQUENCIES:
            refuse(f"WaveKin 2 would fill {count} frequencies", f"{MOST_FREQUENCIES} or fewer")
            return None
        # as MoorDyn does: straight lines between the rows
        even = np.linspace(0.0, table[-1, 0], count)
        table = np.column_stack([even, *(np.interp(even, table[:, 0], table[:, k]) for k in (1, 2, 3))])
        # Re(A e^{iwt}) is Im(i A e^{iwt})
        table[:, 1], table[:, 2] = -table[:, 2].copy(), table[:, 1].copy()
    size = np.hypot(table[:, 1], table[:, 2])
    if np.any((table[:, 0] == 0.0) & (size > 0.0)):
        notes.append(f"{name}: the elevation at 0 rad/s is no wave and is left out")
    table = table[(table[:, 0] > 0.0) & (size > 0.0)]
    if not len(table):
        refuse("no frequency has an amplitude", "one or more")
        return None
    omega, real, imaginary, direction = (tuple(map(float, column)) for column in table.T)
    return DeckWaves(omega, real, imaginary, direction)


def amplitude_and_phase(waves: DeckWaves) -> tuple[np.ndarray, np.ndarray]:
    """Return amplitudes [m] and phases [rad] of waves a cos(k x - omega t + phase)."""
    real, imaginary = np.array(waves.real), np.array(waves.imaginary)
    # real sin(wt) + imaginary cos(wt) is a cos(wt - phase)
    return np.hypot(real, imaginary), np.arctan2(real, imaginary)


def wave_components(waves: DeckWaves, water: Water) -> WaveComponents:
    """Return the waves of a deck in its water, without the current that MoorDyn does not let them ride on."""
    amplitude, phase = amplitude_and_phase(waves)
    omega = np.array(waves.omega)
    number = np.atleast_1d(wave_number(omega, water.depth, water.gravity))
    return WaveComponents(omega, amplitude, phase, np.array(waves.direction), number, water)
