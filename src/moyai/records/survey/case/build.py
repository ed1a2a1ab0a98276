"""From a file of ``moyai measure records`` to the survey that is processed: paths, dates, degrees end here."""

from __future__ import annotations

import hashlib
import math
import os
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from moyai.case.reader import read_block
from moyai.case.yaml_reader import CaseDocument, KeyPath, read_yaml
from moyai.core.arrays import Array
from moyai.core.errors import CaseError, Fault, InputError
from moyai.core.quantities import QuantityKind, check_unit
from moyai.core.units import parse_unit
from moyai.records.reading.quality import QualityOptions
from moyai.records.reading.sensors import QUANTITIES, Sensor
from moyai.records.reading.sources import FORMS, ClockCorrection, ColumnSource, LoggerSource, TimeSource, is_form
from moyai.records.survey.case.schema import ChannelEntry, LoggerKeys, QualityKeys, RecordsFile
from moyai.records.survey.model import (
    QUANTITIES_OF_KINDS,
    ChannelUse,
    CurrentUse,
    Directions,
    LoadMeasure,
    ReflectionUse,
    ResponseUse,
    Spectral,
    Survey,
    TensionUse,
)
from moyai.sea.water import Water
from moyai.series.detrend import Detrend
from moyai.series.spectra import WelchOptions
from moyai.series.zero_crossing import WaveOptions


def load_survey(path: str | os.PathLike[str]) -> Survey:
    """Read a file of ``moyai measure records``.

    Parameters
    ----------
    path : path-like
        YAML, UTF-8.

    Returns
    -------
    Survey
        What :func:`moyai.records.run_survey` takes.

    Raises
    ------
    CaseError
        With every error of the file at once, each with line and column.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> from moyai.records import load_survey
    >>> folder = Path(mkdtemp())
    >>> _ = (folder / "gauge.csv").write_text("t [s],level [m]\\n0.0,0.1\\n0.5,0.2\\n", encoding="utf-8")
    >>> text = "moyai: 1\\ntitle: Gauge\\nloggers:\\n- {name: gauge, file: gauge.csv, time: {column: t, unit: s},\\n"
    >>> text += "   channels: [{name: level, column: level, kind: elevation}]}\\n"
    >>> text += "blocks: {length: 5 min}\\nwaves: {channels: [level]}\\n"
    >>> _ = (folder / "survey.yaml").write_text(text, encoding="utf-8")
    >>> [logger.name for logger in load_survey(folder / "survey.yaml").loggers]
    ['gauge']
    """
    document = read_yaml(path)
    model: RecordsFile = read_block(document, RecordsFile)
    builder = _SurveyBuilder(model, document, Path(path).parent)
    survey = builder.build()
    if builder.faults:
        raise CaseError(sorted(builder.faults, key=lambda fault: (fault.line, fault.column)))
    assert survey is not None
    return survey


class _SurveyBuilder:
    def __init__(self, model: RecordsFile, document: CaseDocument, folder: Path) -> None:
        self.model, self.document, self.folder = model, document, folder
        self.faults: list[Fault] = []

    def fault(self, path: KeyPath, message: str, *, allowed: str = "", remedy: str = "") -> None:
        self.faults.append(self.document.fault(path, message, allowed=allowed, remedy=remedy))

    def build(self) -> Survey | None:
        model = self.model
        loggers = [self._logger(entry, place) for place, entry in enumerate(model.loggers)]
        channels = [
            self._channel(entry, ("loggers", place, "channels", number))
            for place, logger in enumerate(model.loggers)
            for number, entry in enumerate(logger.channels)
        ]
        names = [channel.name for channel in channels]
        for key, entries in self._mentions().items():
            for path, name in entries:
                if name not in names:
                    self.fault(path, f"there is no channel '{name}'", allowed=", ".join(names))
                    continue
                self._fitting_kind(key, path, next(channel for channel in channels if channel.name == name))
        normal = math.nan if model.structure_normal_deg is None else math.radians(model.structure_normal_deg)
        waves, spectrum, site = model.waves, model.spectrum, model.site
        if waves is not None and waves.detrend == "high_pass" and waves.cutoff is None:
            self.fault(("waves", "detrend"), "'high_pass' needs 'cutoff'", remedy="give the cut-off period")
        if spectrum is not None and spectrum.lowest >= spectrum.highest:
            self.fault(("spectrum", "lowest"), "the band is empty", allowed="'lowest' below 'highest'")
        if spectrum is not None and spectrum.segment is not None and spectrum.segment > model.blocks.length:
            self.fault(
                ("spectrum", "segment"),
                f"segments of {spectrum.segment:g} s do not fit into blocks of {model.blocks.length:g} s",
                remedy="take shorter segments or longer blocks",
            )
        bearing = site.x_axis_bearing_deg if site is not None else None
        if (
            model.current is not None
            and model.current.polar
            and model.current.direction == "bearing"
            and bearing is None
        ):
            self.fault(("current",), "a direction by the compass needs site.x_axis_bearing_deg")
        block_start = self._date(model.blocks.start, ("blocks", "start"))
        if self.faults:
            return None
        try:
            return Survey(
                title=model.title,
                loggers=tuple(logger for logger in loggers if logger is not None),
                channels=tuple(channels),
                block_length=model.blocks.length,
                block_start=block_start,
                water=None if site is None else Water(site.water_depth, site.density, site.gravity),
                x_axis_bearing=math.nan if bearing is None else math.radians(bearing),
                waves=waves.channels if waves is not None else (),
                wave_options=self._wave_options(),
                spectral=self._spectral(),
                directions=None
                if model.directions is None
                else Directions(model.directions.channels, model.directions.estimator == "entropy"),
                current=self._current(normal),
                tensions=self._tensions(),
                wave_of_tensions=model.tensions.waves if model.tensions is not None else "",
                tension_lag=model.tensions.lag if model.tensions is not None else 0.0,
                largest_lag=model.tensions.largest_lag if model.tensions is not None else 0.0,
                normal_heading=normal,
                reflection=self._reflection(),
                load_measure=self._load_measure(),
                responses=None
                if model.responses is None
                else ResponseUse(model.responses.wave, model.responses.channels, model.responses.least_coherence),
                case_text=self.document.text,
                case_hash=hashlib.sha256(self.document.text.encode("utf-8")).hexdigest(),
            )
        except InputError as error:
            fault = error.fault
            self.fault((), fault.message, allowed=fault.allowed, remedy=fault.remedy)
            return None

    def _mentions(self) -> dict[str, list[tuple[KeyPath, str]]]:
        """Return every channel that an analysis names, with its place in the file."""
        model = self.model
        out: dict[str, list[tuple[KeyPath, str]]] = {}
        if model.waves is not None:
            out["waves"] = [(("waves", "channels", i), name) for i, name in enumerate(model.waves.channels)]
        if model.directions is not None:
            out["directions"] = [(("directions", "channels", i), n) for i, n in enumerate(model.directions.channels)]
        if model.current is not None:
            key = "velocity" if model.current.velocity else "polar"
            pair = model.current.velocity or model.current.polar or ()
            out[key] = [(("current", key, i), name) for i, name in enumerate(pair)]
        if model.tensions is not None:
            out["tensions"] = [
                (("tensions", "lines", i, "channel"), e.channel) for i, e in enumerate(model.tensions.lines)
            ]
            out["waves of tensions"] = [(("tensions", "waves"), model.tensions.waves)]
            if model.waves is not None and model.tensions.waves not in model.waves.channels:
                self.fault(("tensions", "waves"), f"'{model.tensions.waves}' is not among waves.channels")
        if model.responses is not None:
            out["driving wave"] = [(("responses", "wave"), model.responses.wave)]
            out["responses"] = [(("responses", "channels", i), name) for i, name in enumerate(model.responses.channels)]
        if model.reflection is not None:
            for key in ("front", "behind"):
                entries = getattr(model.reflection, key)
                out[key] = [(("reflection", key, i, "channel"), entry.channel) for i, entry in enumerate(entries)]
        return out

    def _fitting_kind(self, key: str, path: KeyPath, channel: ChannelUse) -> None:
        allowed: dict[str, tuple[str, ...]] = {
            "waves": ("elevation", "pressure", "velocity_z", "acceleration_z"),
            "waves of tensions": ("elevation", "pressure", "velocity_z", "acceleration_z"),
            "directions": tuple(QUANTITIES),
            "front": ("elevation",),
            "behind": ("elevation",),
            "tensions": ("tension", "force"),
            "driving wave": ("elevation",),
            "responses": ("motion", "rotation", "tension", "force", "elevation", "acceleration_z", "other"),
        }
        pairs = {"velocity": ("velocity_x", "velocity_y"), "polar": ("speed", "direction")}
        if key in pairs:
            kinds: tuple[str, ...] = (pairs[key][int(path[-1])],)
        else:
            kinds = allowed[key]
        if channel.kind not in kinds:
            self.fault(path, f"'{channel.name}' is of kind '{channel.kind}'", allowed=", ".join(kinds))

    def _logger(self, entry: LoggerKeys, place: int) -> LoggerSource | None:
        path: KeyPath = ("loggers", place)
        files: list[Path] = []
        listed = entry.files if entry.files is not None else (entry.file,)
        for number, name in enumerate(listed):
            assert name is not None
            key: KeyPath = (*path, "files", number) if entry.files is not None else (*path, "file")
            found = sorted(self.folder.glob(name)) if any(sign in name for sign in "*?[") else [self.folder / name]
            # A name with brackets of its own is a file before it is a pattern
            if (self.folder / name).is_file():
                found = [self.folder / name]
            if not found:
                self.fault(key, f"no file fits the pattern '{name}'")
            for file in found:
                if not file.is_file():
                    self.fault(key, f"no such file: {file}")
            files.extend(found)
        time = entry.time
        columns: tuple[str | int, ...] = time.columns or ((time.column,) if time.column is not None else ())
        if time.columns is not None and time.format is None:
            self.fault((*path, "time"), "two columns of date and time need 'format'")
        if time.format is not None and not is_form(time.format):
            self.fault((*path, "time", "format"), f"'{time.format}' is not a known word", allowed=FORMS)
        start = self._date(time.start, (*path, "time", "start"))
        if time.start is not None and time.utc_offset != 0.0:
            self.fault(
                (*path, "time", "utc_offset"),
                "'utc_offset' belongs to stamps, not to seconds after 'start'",
                remedy="write the offset into 'start': 1999-09-23T00:00:00+09:00",
            )
        reference = self._date(entry.clock.reference, (*path, "clock", "reference"))
        delimiter = {"tab": "\t", "space": "whitespace", " ": "whitespace"}.get(entry.delimiter, entry.delimiter)
        if len(delimiter) > 1 and delimiter not in ("auto", "whitespace"):
            self.fault((*path, "delimiter"), f"'{entry.delimiter}' is no delimiter", allowed="one character")
        names = [channel.name for channel in entry.channels]
        for number, name in enumerate(names):
            if name in names[:number]:
                self.fault((*path, "channels", number, "name"), f"the name '{name}' is given twice")
        if self.faults:
            return None
        return LoggerSource(
            entry.name,
            tuple(files),
            tuple(
                ColumnSource(c.column, c.name, c.unit, c.scale, c.offset, c.missing, _quantities(c))
                for c in entry.channels
            ),
            TimeSource(
                columns,
                time.format or "number",
                time.unit or "",
                start,
                math.nan if time.rate is None else time.rate,
                time.utc_offset,
                time.order,
            ),
            ClockCorrection(entry.clock.offset, entry.clock.drift, reference),
            entry.format,
            entry.encoding,
            delimiter,
            entry.decimal,
            -1 if entry.header_row == "auto" else entry.header_row,
            entry.first_row,
            entry.comment,
        )

    def _date(self, text: str | None, path: KeyPath) -> float:
        if text is None:
            return math.nan
        try:
            found = datetime.fromisoformat(text.strip().replace("/", "-"))
        except ValueError:
            self.fault(path, f"'{text}' is no date", allowed="for instance 1999-09-23T00:00:00")
            return math.nan
        return (found if found.tzinfo else found.replace(tzinfo=UTC)).timestamp()

    def _channel(self, entry: ChannelEntry, path: KeyPath) -> ChannelUse:
        if entry.unit:
            try:
                unit = parse_unit(entry.unit) if entry.unit != "1" else parse_unit("%") ** 0
                check_unit(unit, _quantities(entry), f"channel '{entry.name}' of kind '{entry.kind}'", "")
            except InputError as error:
                self.fault((*path, "unit"), error.fault.message, allowed=error.fault.allowed, remedy=error.fault.remedy)
        lowest = -math.inf if entry.lowest is None else entry.lowest
        highest = math.inf if entry.highest is None else entry.highest
        if lowest >= highest:
            self.fault((*path, "lowest"), "the range of the instrument is empty", allowed="'lowest' below 'highest'")
            lowest, highest = -math.inf, math.inf
        sensor = Sensor(entry.kind, entry.x, entry.y, entry.z) if entry.kind in QUANTITIES else None  # type: ignore[arg-type]
        keys = entry.quality if entry.quality is not None else self.model.quality
        return ChannelUse(entry.name, entry.kind, sensor, _quality(keys, entry.kind, lowest, highest))

    def _wave_options(self) -> WaveOptions:
        keys = self.model.waves
        if keys is None:
            return WaveOptions()
        cutoff = math.nan if keys.cutoff is None else keys.cutoff
        return WaveOptions(
            keys.crossing,
            Detrend(keys.detrend, cutoff),
            keys.dead_band,
            keys.crest,
            keys.share,
            keys.shortest,
            math.inf if keys.longest is None else keys.longest,
        )

    def _spectral(self) -> Spectral | None:
        keys = self.model.spectrum
        if keys is None:
            return None
        segment = math.inf if keys.segment is None else keys.segment
        options = WelchOptions(segment, keys.overlap, keys.window, keys.detrend, keys.bands)
        # The schema counts frequencies in hertz
        return Spectral(options, keys.lowest, keys.highest)

    def _current(self, normal: float) -> CurrentUse | None:
        keys = self.model.current
        if keys is None:
            return None
        pair: Any = keys.velocity or keys.polar
        return CurrentUse(pair[0], pair[1], keys.polar is not None, keys.direction == "bearing", normal)

    def _tensions(self) -> tuple[TensionUse, ...]:
        keys = self.model.tensions
        if keys is None:
            return ()
        limit = math.inf if keys.snap_limit is None else keys.snap_limit
        return tuple(TensionUse(e.channel, e.group, keys.steady, keys.cutoff, limit) for e in keys.lines)

    def _load_measure(self) -> LoadMeasure | None:
        keys, site = self.model.tensions, self.model.site
        if keys is None or keys.curtain_depth is None:
            return None
        if site is None:
            self.fault(("tensions", "curtain_depth"), "'curtain_depth' needs 'site'", remedy="give the water")
            return None
        from moyai.structures.curtain.seas.squared_velocity import effective_height, squared_velocity

        water = Water(site.water_depth, site.density, site.gravity)
        depth, rule, ratio = keys.curtain_depth, keys.direction_rule, keys.height_ratio

        def measure(height: Array, period: Array, angle: Array, current: Array) -> Array:
            return squared_velocity(effective_height(height, angle, rule, ratio), period, current, depth, water)

        return measure

    def _reflection(self) -> ReflectionUse | None:
        keys = self.model.reflection
        if keys is None:
            return None
        return ReflectionUse(
            tuple(entry.channel for entry in keys.front),
            tuple(entry.x for entry in keys.front),
            tuple(entry.channel for entry in keys.behind),
            tuple(entry.x for entry in keys.behind),
        )


# Means of these stand still unless the instrument drifts; currents and lines follow tide and weather
_STEADY_KINDS = (
    "elevation",
    "slope_x",
    "slope_y",
    "displacement_x",
    "displacement_y",
    "acceleration_z",
    "motion",
    "rotation",
)


def _quantities(entry: ChannelEntry) -> tuple[QuantityKind, ...]:
    """Return what a channel may be by its unit, empty for anything."""
    kind = QUANTITIES_OF_KINDS.get(entry.kind)
    return () if kind is None else (kind,)


def _drift_share(given: float | None, kind: str) -> float:
    if given is not None:
        return given
    return 1.0 if kind in _STEADY_KINDS else math.inf


def _quality(keys: QualityKeys, kind: str, lowest: float, highest: float) -> QualityOptions:
    spikes = keys.spikes if keys.spikes is not None else kind not in ("tension", "force", "direction")
    return QualityOptions(
        gap_steps=keys.gap_steps,
        spike_scale=keys.spike_scale if spikes else math.inf,
        spike_samples=keys.spike_samples,
        clip_lowest=kind not in ("tension", "force"),
        flat_seconds=math.inf if keys.flat is None else keys.flat,
        clip_samples=keys.clip_samples,
        lowest=lowest,
        highest=highest,
        drift_share=_drift_share(keys.drift_share, kind),
        unit_slips=keys.unit_slips,
    )
