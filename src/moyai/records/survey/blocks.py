"""One block of a survey: from the samples of the loggers to its statistics."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.records.reading.clocks import interpolate
from moyai.records.reading.quality import BlockMoments, DoubtfulStretch, check_record, moments_of
from moyai.records.reading.record import Record, nominal_step
from moyai.records.reading.sensors import Sensor, surface_elevation
from moyai.records.reading.short_gaps import fill_short_gaps
from moyai.records.survey.currents import block_means, components, heading_of_bearing
from moyai.records.survey.directional import directional_spectrum, fourier_directions
from moyai.records.survey.irregular_reflection import separate_irregular, transmission
from moyai.records.survey.model import ReflectionUse, Survey
from moyai.records.survey.motions import ResponseFunction, response_function
from moyai.records.survey.tensions import find_delay, split_tension, tension_statistics, wave_maxima
from moyai.series.spectra import WelchOptions, cross_spectra, spectrum_of
from moyai.series.zero_crossing import STATISTICS, Waves, find_waves

#: Part of the samples of a block that repeat the one before, beyond which a gauge stands still: calm water, or stuck
_STILL = 0.5


@dataclass(frozen=True, eq=False)
class BlockResult:
    """Statistics of a block."""

    index: int
    #: [s].
    start: float
    #: By channel, for drift and unit slips.
    moments: dict[str, BlockMoments]
    #: By channel: mean, deviation, smallest, largest, share of sound samples.
    channels: dict[str, tuple[float, ...]]
    #: Flagged samples by channel and kind.
    counts: dict[str, dict[str, int]]
    findings: tuple[DoubtfulStretch, ...]
    gaps: tuple[tuple[float, float], ...]
    #: Samples that gaps lack.
    lacking: int
    #: Samples there are, of the first logger.
    samples: int
    #: By channel: statistics of waves.
    waves: dict[str, dict[str, float]] = field(default_factory=dict)
    #: By channel: the waves themselves.
    cut: dict[str, Waves] = field(default_factory=dict)
    #: By channel: (frequency, density, degrees of freedom, statistics).
    spectra: dict[str, tuple[Array, Array, float, dict[str, float]]] = field(default_factory=dict)
    #: Values of the directions by name.
    directions: dict[str, float] = field(default_factory=dict)
    #: Values of the current by name.
    current: dict[str, float] = field(default_factory=dict)
    #: Values of the reflection by name.
    reflection: dict[str, float] = field(default_factory=dict)
    #: By channel: statistics by name.
    tensions: dict[str, dict[str, float]] = field(default_factory=dict)
    #: By channel: the response to the wave channel.
    responses: dict[str, ResponseFunction] = field(default_factory=dict)
    notices: tuple[Notice, ...] = ()


class _Samples:
    """Channels of one block, whichever logger they come from."""

    def __init__(self, records: Sequence[Record | None]) -> None:
        self.records = [record for record in records if record is not None and len(record)]
        self._found: dict[str, tuple[Array, Array]] = {}

    def record_of(self, name: str) -> Record | None:
        return next((record for record in self.records if name in record.names), None)

    def get(self, name: str) -> tuple[Array, Array] | None:
        """Return instants and sound values, ``None`` where the logger was silent."""
        record = self.record_of(name)
        if record is None:
            return None
        if name not in self._found:
            self._found[name] = (record.time, record.sound(name))
        return self._found[name]


def process_block(survey: Survey, index: int, origin: float, records: Sequence[Record | None]) -> BlockResult:
    """Return the statistics of one block.

    Parameters
    ----------
    survey : Survey
    index : int
        Number of the block.
    origin : float
        Start of block 0 [s].
    records : sequence of Record or None
        One a logger.
    """
    start = origin + index * survey.block_length
    checked: list[Record | None] = []
    counts: dict[str, dict[str, int]] = {}
    findings: list[DoubtfulStretch] = []
    gaps: list[tuple[float, float]] = []
    channels: dict[str, tuple[float, ...]] = {}
    moments: dict[str, BlockMoments] = {}
    lacking = samples = 0
    for place, record in enumerate(records):
        if record is None or len(record) == 0:
            checked.append(None)
            continue
        options = {name: survey.use_of(name).quality for name in record.names}
        quality = check_record(record, options)
        checked.append(quality.record)
        counts.update({name: dict(kinds) for name, kinds in quality.counts.items()})
        findings.extend(quality.findings)
        gaps.extend(quality.gaps)
        if place == 0:
            samples = len(record)
        lacking += quality.missing_samples
        for name in record.names:
            found = moments_of(index, quality.record, name)
            moments[name] = found
            values = quality.record.sound(name)
            known = bool(np.isfinite(values).any())
            low = float(np.nanmin(values)) if known else math.nan
            high = float(np.nanmax(values)) if known else math.nan
            channels[name] = (found.mean, found.deviation, low, high, quality.share(name))
    data = _Samples(checked)
    notices: list[Notice] = []
    cut, waves = _waves(survey, data, notices)
    return BlockResult(
        index,
        start,
        moments,
        channels,
        counts,
        tuple(findings),
        tuple(gaps),
        lacking,
        samples,
        waves,
        cut,
        _spectra(survey, data, notices),
        _directions(survey, data, notices),
        _current(survey, data, notices),
        _reflection(survey, data, notices),
        _tensions(survey, data, cut, notices),
        _responses(survey, data, notices),
        tuple(notices),
    )


def _surface(survey: Survey, data: _Samples, name: str, notices: list[Notice]) -> tuple[Array, Array] | None:
    """Return the elevation of a channel, through linear theory where it is a pressure or a vertical motion."""
    found = data.get(name)
    use = survey.use_of(name)
    if found is None or use.sensor is None or use.kind not in ("pressure", "velocity_z", "acceleration_z"):
        return found
    time, values = found
    if survey.water is None or survey.spectral is None:
        raise InputError(f"'{name}' needs 'site' and 'spectrum' to become a surface", parameter="waves.channels")
    if not np.isfinite(values).all():
        notices.append(Notice("surface-gaps", f"{name}: a block has gaps; its surface is not computed"))
        return time, np.full_like(values, np.nan)
    step = float(np.median(np.diff(time)))
    band = survey.spectral
    try:
        surface = surface_elevation(step, values, use.sensor, survey.water, lowest=band.lowest, highest=band.highest)
    except InputError as error:
        notices.append(Notice("surface-skipped", f"{name}: a block has no surface: {error.fault.message}"))
        return time, np.full_like(values, np.nan)
    notices.extend(surface.notices)
    return time, surface.elevation


def _waves(
    survey: Survey, data: _Samples, notices: list[Notice]
) -> tuple[dict[str, Waves], dict[str, dict[str, float]]]:
    cut: dict[str, Waves] = {}
    statistics: dict[str, dict[str, float]] = {}
    for name in survey.waves:
        found = _surface(survey, data, name, notices)
        number = 0 if found is None else int(np.count_nonzero(np.isfinite(found[1])))
        if found is None or number < 3:
            notices.append(Notice("waves-skipped", f"{name}: a block holds {number} sound samples: no waves"))
            statistics[name] = dict.fromkeys(STATISTICS, math.nan)
            continue
        try:
            waves = find_waves(*found, survey.wave_options)
        except InputError as error:
            notices.append(Notice("waves-skipped", f"{name}: {error.fault.message}"))
            statistics[name] = dict.fromkeys(STATISTICS, math.nan)
            continue
        cut[name], statistics[name] = waves, waves.statistics()
        notices.extend(waves.notices)
    return cut, statistics


def _even(time: Array, *values: Array) -> tuple[float, Array]:
    """Return the step, and the columns with NaN where the clock has a gap."""
    step = nominal_step(time)
    # Counted from sample to sample: an error of the step does not add up over the block
    place = np.concatenate([[0], np.cumsum(np.maximum(np.rint(np.diff(time) / step), 1.0))]).astype(np.int64)
    step = float(time[-1] - time[0]) / float(place[-1])
    if place[-1] == time.size - 1:
        return step, np.column_stack(values)
    out = np.full((int(place[-1]) + 1, len(values)), np.nan)
    out[place] = np.column_stack(values)
    return step, out


def _filled(step: float, columns: Array, what: str, notices: list[Notice]) -> tuple[float, Array]:
    """Return the step, and the columns with short gaps filled; a notice names the share and its effect."""
    filled = fill_short_gaps(columns)
    if filled.share > 0.0:
        notices.append(filled.notice(what))
    return step, filled.values


def _together(
    data: _Samples, names: Sequence[str], notices: list[Notice], code: str
) -> tuple[Array, list[Array]] | None:
    """Return channels on one clock, the coarsest of their loggers; ``None``, and a notice, where one is silent."""
    found = [data.get(name) for name in names]
    silent = [name for name, entry in zip(names, found) if entry is None or entry[0].size < 8]
    if silent:
        notices.append(Notice(f"{code}-skipped", f"{', '.join(silent)}: no samples in a block: no {code}"))
        return None
    known = [entry for entry in found if entry is not None]
    clock = max((time for time, _ in known), key=_step)
    if all(time.size == clock.size and np.array_equal(time, clock) for time, _ in known):
        return clock, [values for _, values in known]
    clock = clock[
        (clock >= max(float(time[0]) for time, _ in known)) & (clock <= min(float(time[-1]) for time, _ in known))
    ]
    if clock.size < 8:
        notices.append(Notice(f"{code}-skipped", f"{', '.join(names)} share no time in a block: no {code}"))
        return None
    words = f"{code}: channels of several loggers joined by straight lines at {_step(clock):.4g} s"
    notices.append(Notice(f"{code}-joined", words, severity="information"))
    return clock, [interpolate(*entry, clock, largest_gap=1.5 * _step(entry[0])) for entry in known]


def _fitting(options: WelchOptions, samples: int, step: float, notices: list[Notice], code: str) -> WelchOptions | None:
    """Return the options where a segment fits the block; ``None``, and a notice, where it does not."""
    if math.isinf(options.segment) or round(options.segment / step) <= samples:
        return options
    words = f"a block of {samples * step:.4g} s is shorter than a segment of {options.segment:g} s: no {code}"
    notices.append(Notice(f"{code}-skipped", words))
    return None


def _spectra(
    survey: Survey, data: _Samples, notices: list[Notice]
) -> dict[str, tuple[Array, Array, float, dict[str, float]]]:
    out: dict[str, tuple[Array, Array, float, dict[str, float]]] = {}
    if survey.spectral is None:
        return out
    for name in survey.waves:
        found = _surface(survey, data, name, notices)
        if found is None or found[0].size < 8:
            continue
        step, columns = _filled(*_even(*found), name, notices)
        options = _fitting(survey.spectral.options, columns.shape[0], step, notices, "spectrum")
        if options is None:
            continue
        try:
            spectrum = spectrum_of(step, columns[:, 0], options)
        except InputError as error:
            notices.append(Notice("spectrum-skipped", f"{name}: {error.fault.message}"))
            continue
        notices.extend(spectrum.notices)
        statistics = spectrum.figures(survey.spectral.lowest, survey.spectral.highest)
        chosen = spectrum.frequency <= survey.spectral.highest
        out[name] = spectrum.frequency[chosen], spectrum.density[chosen], spectrum.degrees_of_freedom, statistics
    return out


def _directions(survey: Survey, data: _Samples, notices: list[Notice]) -> dict[str, float]:
    if survey.directions is None or survey.spectral is None or survey.water is None:
        return {}
    names = survey.directions.channels
    shared = _together(data, names, notices, "directions")
    if shared is None:
        return {}
    sensors: list[Sensor] = []
    for name in names:
        sensor = survey.use_of(name).sensor
        if sensor is None:
            raise InputError(f"'{name}' is no quantity of waves", parameter="directions.channels")
        sensors.append(sensor)
    step, columns = _filled(*_even(shared[0], *shared[1]), "directions", notices)
    options = _fitting(survey.spectral.options, columns.shape[0], step, notices, "directions")
    if options is None:
        return {}
    try:
        matrix = cross_spectra(step, columns, options)
    except InputError as error:
        notices.append(Notice("directions-skipped", error.fault.message))
        return {}
    band = survey.spectral
    triplet = [sensor.powers for sensor in sensors] == [(0, 0), (1, 0), (0, 1)]
    if triplet and not survey.directions.entropy:
        return fourier_directions(matrix, sensors, survey.water).figures(band.lowest, band.highest)
    spectrum = directional_spectrum(matrix, sensors, survey.water, lowest=band.lowest, highest=band.highest)
    notices.extend(spectrum.notices)
    return {key: value for key, value in spectrum.figures().items() if key != "spectral_height"}


def _current(survey: Survey, data: _Samples, notices: list[Notice]) -> dict[str, float]:
    if survey.current is None:
        return {}
    use = survey.current
    shared = _together(data, (use.x, use.y), notices, "current")
    if shared is None:
        return {}
    time, (x, y) = shared
    if use.polar:
        if data.record_of(use.x) is not data.record_of(use.y):
            words = f"'{use.x}' and '{use.y}' come from two loggers: a direction cannot be interpolated"
            notices.append(Notice("current-skipped", words))
            return {}
        heading = heading_of_bearing(y, survey.x_axis_bearing, coming_from=False) if use.bearing else y
        x, y = components(x, heading)
    length = float(time[-1] - time[0]) + 1.0
    mean = block_means(time, x, y, length=2.0 * length)
    out = {
        "current_x": float(mean.x[0]),
        "current_y": float(mean.y[0]),
        "current_speed": float(mean.speed[0]),
        "current_heading": float(mean.heading[0]),
        "current_deviation": float(mean.deviation[0]),
    }
    if math.isfinite(use.normal_heading):
        out["current_normal"] = float(mean.normal(use.normal_heading)[0])
    return out


def _reflection(survey: Survey, data: _Samples, notices: list[Notice]) -> dict[str, float]:
    use: ReflectionUse | None = survey.reflection
    if use is None or survey.spectral is None or survey.water is None:
        return {}
    shared = _together(data, (*use.front, *use.rear), notices, "reflection")
    if shared is None:
        return {}
    step, columns = _filled(*_even(shared[0], *shared[1]), "reflection", notices)
    options = _fitting(survey.spectral.options, columns.shape[0], step, notices, "reflection")
    if options is None:
        return {}
    if not np.isfinite(columns).all():
        notices.append(Notice("reflection-skipped", "a block with missing samples has no reflection analysis"))
        return {}
    low, high = survey.spectral.lowest, survey.spectral.highest
    front = columns[:, : len(use.front)]
    try:
        found = separate_irregular(step, front, use.front_positions, survey.water, options, lowest=low, highest=high)
    except InputError as error:
        notices.append(Notice("reflection-skipped", f"a block has no reflection analysis: {error.fault.message}"))
        return {}
    still = float(np.mean(np.diff(front, axis=0) == 0.0, axis=0).max())
    if still > _STILL and math.isfinite(found.reflection):
        notices.append(Notice("reflection-skipped", "a block with a constant gauge has no reflection analysis"))
        return {}
    notices.extend(found.notices)
    out = {
        "reflection_coefficient": found.reflection,
        "reflection_error": found.reflection_error,
        "incident_height": found.incident_height,
        "reflected_height": found.reflected_height,
    }
    notices.extend(_above_one("reflection", found.reflection, found.reflection_error))
    if use.rear:
        rear = columns[:, len(use.front) :]
        places = use.rear_positions
        try:
            passed = transmission(step, found, rear, places, survey.water, options, lowest=low, highest=high)
        except InputError as error:
            notices.append(Notice("transmission-skipped", f"a block has no transmission: {error.fault.message}"))
            return out
        notices.extend(_above_one("transmission", passed.coefficient, passed.error))
        out |= {
            "transmission_coefficient": passed.coefficient,
            "transmission_error": passed.error,
            "transmitted_height": passed.height,
        }
    return out


def _above_one(name: str, coefficient: float, error: float) -> list[Notice]:
    """Say when more goes back or on than comes in, by more than the error of the coefficient."""
    if not coefficient - 2.0 * (error if math.isfinite(error) else 0.0) > 1.0:
        return []
    return [
        Notice(
            f"{name}-above-one", f"{name} coefficient of {coefficient:.3g}: more than the wave that comes in",
            coefficient, 1.0, "error",
            "check the places of the gauges (x grows from the wave maker on), their order, scale and zero",
        )
    ]  # fmt: skip


def _tensions(
    survey: Survey, data: _Samples, cut: dict[str, Waves], notices: list[Notice]
) -> dict[str, dict[str, float]]:
    """Return steady part, largest tensions of the waves and snaps of every line."""
    out: dict[str, dict[str, float]] = {}
    waves = cut.get(survey.wave_of_tensions)
    for use in survey.tensions:
        found = data.get(use.channel)
        if found is None or np.count_nonzero(np.isfinite(found[1])) < 20:
            continue
        time, values = found
        known = np.isfinite(values)
        if not known.all() and use.steady == "low_pass":
            notices.append(
                Notice(
                    "tension-gaps", f"{use.channel}: a low pass is not possible in a block with gaps, which is left out"
                )
            )
            continue
        time, values = time[known], values[known]
        rate = 1.0 / float(np.median(np.diff(time)))
        split = split_tension(time, values, use.steady, cutoff=use.cutoff)
        _sign_of_tension(use.channel, values, notices)
        of_waves = dict.fromkeys(("maximum", "tenth", "third", "mean", "waves", "lag"), math.nan)
        row = {"steady": split.level, "snap_count": math.nan} | of_waves
        if math.isfinite(use.snap_limit):
            above = split.fluctuating > use.snap_limit
            row["snap_count"] = float(np.count_nonzero(above[1:] & ~above[:-1]))
        if waves is None or not len(waves):
            words = f"{use.channel}: {survey.wave_of_tensions} shows no waves in a block: no tensions of waves"
            notices.append(Notice("tension-waves", words))
        else:
            lag = survey.tension_lag + _refined_lag(survey, data, found, split.fluctuating)
            statistics = tension_statistics(
                wave_maxima(time, split.fluctuating, waves.start, waves.period, delay=lag).maximum
            )
            row |= {
                "maximum": statistics.maximum,
                "tenth": statistics.tenth,
                "third": statistics.third,
                "mean": statistics.mean,
                "waves": float(statistics.count),
                "lag": lag,
            }
        if rate < SLOWEST_TENSION_RATE * (1.0 - 1e-6):
            message = f"{use.channel}: {rate:.3g} samples a second do not resolve snaps, which rise in 0.01 to 0.1 s"
            remedy = "read the largest tensions as lower bounds"
            notices.append(Notice("tension-sampling", message, rate, SLOWEST_TENSION_RATE, remedy=remedy))
        out[use.channel] = row
    return out


def _sign_of_tension(channel: str, values: Array, notices: list[Notice]) -> None:
    """Say when a line would push: its gauge is reversed, or its zero is wrong."""
    lowest, highest = float(values.min()), float(values.max())
    if lowest < -2.0 * max(highest, 0.0):
        words = (
            f"{channel}: tensions from {lowest:.4g} to {highest:.4g} N, but a line does not push: reverse the channel "
            "with 'scale: -1', or correct its zero with 'offset'"
        )
        notices.append(Notice("tension-sign", words, lowest, 0.0))


def _responses(survey: Survey, data: _Samples, notices: list[Notice]) -> dict[str, ResponseFunction]:
    """Return the response of every motion to the wave channel."""
    use = survey.responses
    if use is None or survey.spectral is None:
        return {}
    wave = data.get(use.wave)
    if wave is None or wave[0].size < 16:
        return {}
    step, columns = _even(*wave)
    clock = wave[0][0] + np.arange(columns.shape[0]) * step
    out = {}
    for name in use.channels:
        found = data.get(name)
        options = _fitting(survey.spectral.options, columns.shape[0], step, notices, "response")
        if found is None or options is None:
            continue
        same = found[0].size == wave[0].size and np.array_equal(found[0], wave[0])
        motion = _even(*found)[1][:, 0] if same else interpolate(*found, clock, largest_gap=1.5 * _step(found[0]))
        band = survey.spectral
        try:
            out[name] = response_function(
                step, columns[:, 0], motion, options, lowest=band.lowest, highest=band.highest,
                least_coherence=use.least_coherence,
            )  # fmt: skip
        except InputError as error:
            notices.append(Notice("response-skipped", f"{name}: {error.fault.message}"))
            continue
        notices.extend(out[name].notices)
    return out


SLOWEST_TENSION_RATE = 10.0
"""Rate below which even a snap that rises in a tenth of a second may fall between two samples [Hz]."""


def _refined_lag(survey: Survey, data: _Samples, tension: tuple[Array, Array], fluctuating: Array) -> float:
    """Return what correlation adds to the stated lag [s], 0 where it is not asked for or not to be had."""
    wave = data.get(survey.wave_of_tensions)
    if survey.largest_lag <= 0.0 or wave is None or not np.isfinite(tension[1]).all():
        return 0.0
    elevation = interpolate(wave[0] + survey.tension_lag, wave[1], tension[0], largest_gap=2.5 * _step(wave[0]))
    shared = np.isfinite(elevation)
    if np.count_nonzero(shared) < 0.9 * elevation.size:
        return 0.0
    try:
        return find_delay(tension[0], np.where(shared, elevation, 0.0), fluctuating, longest=survey.largest_lag)
    except InputError:
        return 0.0


def _step(time: Array) -> float:
    return nominal_step(time)
