"""Records of a wave flume: reading them, the window before waves come back, and results in regular waves."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.foreign_files import reads
from moyai.core.quantities import LENGTH, TIME, check_unit
from moyai.core.stand_ins import find_stand_ins
from moyai.core.validity import Notice
from moyai.records.reading.doubts import doubtful_samples, stand_in_notice
from moyai.records.reading.reader import known_unit, si_symbol
from moyai.records.reading.record import Record
from moyai.records.reading.text import SURPLUS_REMEDY
from moyai.records.survey.reflection import Separation, separate_waves
from moyai.sea.dispersion import group_velocity, wave_number
from moyai.sea.water import Water
from moyai.series.harmonics import Harmonics, sliding_fits

_HEADING = re.compile(r"^\s*(?P<name>.*?)\s*(?:\[(?P<unit>[^\]]*)\])?\s*$")


@dataclass(frozen=True, eq=False)
class FlumeRecord:
    """Channels sampled on one clock."""

    #: Instants of the record's own clock [s]; shape (samples,).
    time: Array
    #: Name of each channel.
    names: tuple[str, ...]
    #: SI unit of each channel; empty where the file states none, as stated where it is not understood.
    units: tuple[str, ...]
    #: In SI where the heading states a unit that is understood, else as stored; missing ones are NaN; shape (samples,
    #: channels).
    values: Array
    #: What was found odd while reading: missing units, missing values, uneven steps.
    notices: tuple[Notice, ...] = ()
    #: File name.
    source: str = ""

    @property
    def step(self) -> float:
        """Median time step [s]."""
        return float(np.median(np.diff(self.time)))

    def channel(self, name: str) -> Array:
        """Return one channel.

        Raises
        ------
        InputError
            When the record has no such channel.
        """
        if name not in self.names:
            raise InputError(
                f"{self.source} has no channel {name!r}", parameter="channel", allowed=", ".join(self.names)
            )
        return np.asarray(self.values[:, self.names.index(name)])


@dataclass(frozen=True)
class FlumeLayout:
    """Where things stand along the flume, positions from the wavemaker towards the beach [m]."""

    #: Centre of the model.
    model: float
    #: Wave gauges by channel name.
    gauges: Mapping[str, float]
    #: Gauges that separate incident and reflected waves.
    front: tuple[str, ...]
    #: Gauges of the transmitted wave.
    behind: tuple[str, ...]

    def __post_init__(self) -> None:
        unknown = [name for name in (*self.front, *self.behind) if name not in self.gauges]
        if unknown:
            raise InputError(
                f"no position for gauge {', '.join(unknown)}", parameter="gauges", allowed=", ".join(self.gauges)
            )
        if any(self.gauges[name] >= self.model for name in self.front):
            raise InputError("a gauge in front of the model must be between wavemaker and model", parameter="front")


@dataclass(frozen=True)
class RecordWindow:
    """Useful part of a record [s]."""

    start: float
    end: float


@dataclass(frozen=True, eq=False)
class RegularRun:
    """What one run in regular waves gives."""

    #: Wave period [s].
    period: float
    #: Wave number [rad/m].
    wave_number: float
    #: Useful part of the record.
    window: RecordWindow
    #: Mean and harmonics of every channel, phases referred to the record's clock.
    harmonics: Harmonics
    #: How much the mean of every channel moves while the whole periods slide in the window.
    mean_spread: Array
    #: How much the amplitudes of every channel move meanwhile.
    amplitude_spread: Array
    #: Incident and reflected wave; x = 0 at the centre of the model.
    separation: Separation
    #: Modulus of the reflected over the incident first harmonic [-].
    reflection: float
    #: Modulus of the transmitted over the incident first harmonic [-].
    transmission: float
    #: The same spread of the reflection coefficient.
    reflection_spread: float
    #: The same spread of the transmission coefficient.
    transmission_spread: float
    #: The same spread of the incident wave, in the unit of the gauges.
    incident_spread: float
    #: Channels in the order of the harmonics.
    names: tuple[str, ...]
    notices: tuple[Notice, ...] = field(default_factory=tuple)

    @property
    def incident_amplitude(self) -> float:
        """Amplitude of the incident wave, in the unit of the gauges."""
        return float(np.abs(self.separation.incident[0]))

    def amplitude(self, channel: str) -> complex:
        """Complex first-harmonic amplitude of a channel; its phase refers to the incident crest at the model."""
        value = self.harmonics.first[self._index(channel)]
        incident = self.separation.incident[0]
        return complex(value * np.abs(incident) / incident)

    def mean(self, channel: str) -> float:
        """Mean of a channel in the window."""
        return float(self.harmonics.mean[self._index(channel)])

    def spread(self, channel: str) -> float:
        """How much the first harmonic of a channel moves in the window."""
        return float(self.amplitude_spread[0, self._index(channel)])

    def _index(self, channel: str) -> int:
        if channel not in self.names:
            raise InputError(f"no channel {channel!r}", parameter="channel", allowed=", ".join(self.names))
        return self.names.index(channel)


@reads("a table of comma-separated columns", named="record")
def read_flume_record(path: str | Path, *, units: Mapping[str, str] | None = None) -> FlumeRecord:
    """Read a comma-separated record: one heading row ``name [unit]``, then numbers.

    Time is the column named ``Time``, else the first one, whose heading may be empty. A running row number without
    heading before the time is left out. A heading without unit is kept and reported. Empty and unreadable cells are NaN
    and are counted, never filled.

    Parameters
    ----------
    path : path
        File.
    units : mapping of str to str, optional
        Units of channels whose heading lacks one.

    Raises
    ------
    InputError
        When the file is absent, empty, ragged, or time does not increase; file, row and column are named.
    """
    file = Path(path)
    if not file.is_file():
        raise InputError(f"no such file: {file}", parameter="record")
    with file.open(newline="", encoding="utf-8-sig") as stream:
        delimiter = max(",;\t", key=stream.readline().count)
        stream.seek(0)
        rows = list(csv.reader(stream, delimiter=delimiter))
    if len(rows) < 3:
        raise InputError(
            f"{file.name} holds {max(len(rows) - 1, 0)} rows of data", parameter="record", allowed="two or more"
        )
    heading, body = rows[0], [row for row in rows[1:] if row]
    for number, row in enumerate(body, start=2):
        if len(row) != len(heading):
            raise InputError(
                f"{file.name}: row {number} has {len(row)} columns, the heading {len(heading)}",
                parameter="record",
                remedy=SURPLUS_REMEDY,
            )
    table, unreadable = _numbers(body)
    if not heading[0].strip() and len(heading) > 2 and heading[1].strip().lower().startswith("time"):
        heading, table = heading[1:], table[:, 1:]
        column = 2
    else:
        column = 1
    labels = [_HEADING.match(label) for label in heading]
    names = [label["name"] if label else "" for label in labels]
    stated = [(label["unit"] or "").strip() if label else "" for label in labels]
    given = {"": "", **(units or {})}
    stated = [unit or given.get(name, "") for name, unit in zip(names, stated)]
    doubts = _stand_ins(file.name, names, table)
    channel_units = _in_si(file.name, names, stated, table)
    time = table[:, 0]
    bad = np.flatnonzero(~np.isfinite(time))
    if bad.size:
        raise InputError(
            f"{file.name}: row {bad[0] + 2}, column {column}: time is missing or not a number",
            parameter="record",
            remedy="write numbers with a decimal point, dates as seconds",
        )
    back = np.flatnonzero(np.diff(time) <= 0.0)
    if back.size:
        raise InputError(f"{file.name}: row {back[0] + 3}, column {column}: time does not increase", parameter="record")
    notices = (*_reading_notices(file.name, time, names, channel_units, table[:, 1:], unreadable), *doubts)
    return FlumeRecord(time, tuple(names[1:]), channel_units, table[:, 1:], notices, file.name)


def _in_si(source: str, names: Sequence[str], stated: Sequence[str], table: Array) -> tuple[str, ...]:
    """Turn the columns of a table into SI units, and return those of the channels; unknown units stay as they are."""
    out = []
    for place, (name, text) in enumerate(zip(names, stated)):
        unit = known_unit(text) if text else None
        if place == 0 and text:
            where = f"{source}, column '{name}'"
            if unit is None:
                raise InputError(
                    f"{where} states the unit [{text}], which is not understood",
                    parameter="record",
                    allowed="s, ms, min",
                    remedy="correct the heading",
                )
            check_unit(unit, (TIME,), where, "record")
        if unit is not None:
            table[:, place] *= unit.to_si(Fraction(1))
        out.append(text if unit is None else si_symbol(unit))
    return tuple(out[1:])


def _stand_ins(source: str, names: Sequence[str], table: Array) -> tuple[Notice, ...]:
    """Return notices of numbers that seem to mean 'no value'."""
    return tuple(
        stand_in_notice(f"{source}, column '{name}'", sign, count, f"row {row + 2}", "empty these cells")
        for place, name in enumerate(names[1:], start=1)
        for sign, count, row in find_stand_ins(table[:, place])
    )


def _gauge_notices(record: FlumeRecord, layout: FlumeLayout, window: RecordWindow) -> tuple[Notice, ...]:
    """Refuse gauges that are none, and return notices of their doubtful samples in the window."""
    gauges = tuple(dict.fromkeys((*layout.front, *layout.behind)))
    absent = [name for name in gauges if name not in record.names]
    if absent:
        raise InputError(
            f"{record.source} has no gauge {', '.join(absent)}", parameter="gauges", allowed=", ".join(record.names)
        )
    units = [record.units[record.names.index(name)] for name in gauges]
    for name, unit in zip(gauges, units):
        other = next((one for one in units if one), unit)
        known = known_unit(unit) if unit else None
        if known is not None:
            check_unit(known, (LENGTH,), f"{record.source}, gauge '{name}'", "gauges")
        if unit not in ("", other):
            raise InputError(
                f"{record.source}, gauge '{name}' is in {unit}, gauge '{gauges[0]}' in {other}",
                parameter="gauges",
                allowed="one unit for all",
            )
    inside = np.flatnonzero((record.time >= window.start) & (record.time <= window.end))
    values = np.column_stack([record.channel(name)[inside] for name in gauges])
    if len(inside):
        dead = [name for name, column in zip(gauges, values.T) if not np.nanmax(column) > np.nanmin(column)]
        if dead:
            raise InputError(
                f"{record.source}: gauge {', '.join(dead)} does not change from {window.start:.4g} to "
                f"{window.end:.4g} s",
                parameter="gauges",
                remedy="leave the gauge out",
            )
    part = Record(record.time[inside], values, gauges, tuple(units), source=record.source)
    return doubtful_samples(part, lambda row: f"row {inside[row] + 2}")


def _numbers(body: Sequence[Sequence[str]]) -> tuple[Array, int]:
    try:
        return np.array(body, dtype=float), 0
    except ValueError:
        unreadable = 0
        table = np.empty((len(body), len(body[0])))
        for i, row in enumerate(body):
            for j, cell in enumerate(row):
                try:
                    table[i, j] = float(cell)
                except ValueError:
                    table[i, j] = math.nan
                    unreadable += bool(cell.strip())
        return table, unreadable


def _reading_notices(
    source: str, time: Array, names: list[str], units: tuple[str, ...], values: Array, unreadable: int
) -> tuple[Notice, ...]:
    notices = []
    if not names[0]:
        notices.append(
            Notice("record-heading", f"{source}: the first heading is empty, taken as time [s]", severity="information")
        )
    without = [name for name, unit in zip(names[1:], units) if not unit]
    if without:
        notices.append(
            Notice("record-unit", f"{source}: no unit stated for {', '.join(without)}", value=len(without), limit=0.0)
        )
    missing = int(np.count_nonzero(~np.isfinite(values)))
    if missing:
        notices.append(
            Notice(
                "record-gaps",
                f"{source}: {missing} cells are empty or not numbers ({unreadable} of them text)",
                value=missing,
                limit=0.0,
            )
        )
    steps = np.diff(time)
    uneven = float(np.max(np.abs(steps - np.median(steps))) / np.median(steps))
    if uneven > 0.01:
        notices.append(
            Notice("record-steps", f"{source}: time steps vary by {100 * uneven:.3g} %", value=uneven, limit=0.01)
        )
    return tuple(notices)


def wavemaker_start(time: Array, position: Array, *, fraction: float) -> float:
    """Return when the wavemaker first leaves its rest position by ``fraction`` of its largest excursion [s].

    The rest position is the median of the first twentieth of the record, in which it must not move yet.
    """
    rest = float(np.median(position[: max(position.size // 20, 1)]))
    excursion = np.abs(position - rest)
    moving = np.flatnonzero(excursion > fraction * excursion.max())
    if excursion.max() == 0.0 or moving[0] == 0:
        raise InputError(
            "the record does not show the start of the wavemaker", parameter="wavemaker", remedy="give the start"
        )
    return float(time[moving[0]])


def useful_window(
    layout: FlumeLayout, water: Water, period: float, *, start: float, ramp_periods: float
) -> RecordWindow:
    """Return the part of a run in which all gauges see steady waves that have not met the wavemaker again.

    Equation [eq:flume-window]. Energy travels with the group velocity c_g: the window opens when the wave reflected by
    the model has passed the farthest front gauge and ``ramp_periods`` have gone by, and closes when the wave that the
    model sent back returns from the wavemaker to that gauge.

    Parameters
    ----------
    layout : FlumeLayout
    water : Water
        Depth of the flume, gravity.
    period : float
        Wave period [s].
    start : float
        Start of the wavemaker on the record's clock [s].
    ramp_periods : float
        Periods until the waves are steady.

    Raises
    ------
    InputError
        When less than one whole period is left.
    """
    omega = 2.0 * math.pi / period
    speed = float(group_velocity(omega, water.depth, water.gravity))
    farthest = min(layout.gauges[name] for name in layout.front)
    opening = start + (2.0 * layout.model - farthest) / speed + ramp_periods * period
    closing = start + (2.0 * layout.model + farthest) / speed
    if closing - opening < period:
        raise InputError(
            f"the window from {opening:.4g} to {closing:.4g} s holds less than one period of {period:.4g} s",
            parameter="ramp_periods",
            remedy="accept a shorter ramp or use gauges nearer to the model",
        )
    return RecordWindow(opening, closing)


def analyse_regular_run(
    record: FlumeRecord,
    layout: FlumeLayout,
    water: Water,
    period: float,
    *,
    start: float,
    ramp_periods: float,
    harmonics: int = 2,
) -> RegularRun:
    """Analyse a run in regular waves: incident, reflected and transmitted wave, mean and harmonics of every channel.

    Parameters
    ----------
    record : FlumeRecord
    layout : FlumeLayout
    water : Water
    period : float
        Wave period [s].
    start : float
        Start of the wavemaker on the record's clock [s].
    ramp_periods : float
        Periods until the waves are steady.
    harmonics : int
        Harmonics fitted next to the mean.

    Returns
    -------
    RegularRun
    """
    omega = 2.0 * math.pi / period
    window = useful_window(layout, water, period, start=start, ramp_periods=ramp_periods)
    number = float(wave_number(omega, water.depth, water.gravity))
    doubts = _gauge_notices(record, layout, window)
    end = min(window.end, float(record.time[-1]) + record.step)
    fits = sliding_fits(record.time, record.values, omega, count=harmonics, start=window.start, end=end)
    waves = [_coefficients(record, layout, fit, number) for fit in fits]
    fit, (separation, reflection, transmission) = fits[len(fits) // 2], waves[len(fits) // 2]
    incident = float(np.abs(separation.incident[0]))
    return RegularRun(
        period=period,
        wave_number=number,
        window=window,
        harmonics=fit,
        mean_spread=np.max([np.abs(other.mean - fit.mean) for other in fits], axis=0),
        amplitude_spread=np.max([np.abs(other.amplitude - fit.amplitude) for other in fits], axis=0),
        separation=separation,
        reflection=reflection,
        transmission=transmission,
        reflection_spread=max(abs(wave[1] - reflection) for wave in waves),
        transmission_spread=max(abs(wave[2] - transmission) for wave in waves),
        incident_spread=max(abs(float(np.abs(wave[0].incident[0])) - incident) for wave in waves),
        names=record.names,
        notices=(*record.notices, *doubts, *separation.notices),
    )


def _coefficients(
    record: FlumeRecord, layout: FlumeLayout, fit: Harmonics, number: float
) -> tuple[Separation, float, float]:
    """Return the separation and the moduli of reflection and transmission."""
    first = dict(zip(record.names, fit.first))
    positions = [layout.gauges[name] - layout.model for name in layout.front]
    separation = separate_waves(positions, [first[name] for name in layout.front], number)
    incident = float(np.abs(separation.incident[0]))
    transmitted = float(np.mean([np.abs(first[name]) for name in layout.behind]))
    return separation, float(np.abs(separation.reflection_coefficient[0])), transmitted / incident
