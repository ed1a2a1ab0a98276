"""Process a survey: read the loggers by the chunk, process every block, gather what holds for the whole record."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.progress import Progress, silent
from moyai.core.results import Result, make_provenance
from moyai.core.validity import Notice
from moyai.records.reading.quality import find_drift, find_slips, quality_notices
from moyai.records.reading.reader import CHUNK_ROWS, RecordBlock, aligned, blocks, read_chunks
from moyai.records.reading.record import Record, instant_text
from moyai.records.survey.blocks import BlockResult, process_block
from moyai.records.survey.fits import fit_relations
from moyai.records.survey.model import Survey
from moyai.records.survey.variables import VOCABULARY
from moyai.series.spectra import FIGURES
from moyai.series.wave_statistics import fit_rayleigh, fit_weibull
from moyai.series.zero_crossing import STATISTICS

if TYPE_CHECKING:
    from collections.abc import Iterator

    import xarray as xr

MOST_FINDINGS = 5000
MOST_SLIPS = 10
"""Slips of a unit reported one by one; more are reported together and stand in the table."""


def run_survey(survey: Survey, progress: Progress = silent, *, rows: int = CHUNK_ROWS) -> Result:
    """Evaluate a survey in bounded memory.

    Parameters
    ----------
    survey : Survey
        As :func:`moyai.records.load_survey` reads it.
    progress : Progress
        Called after every block.
    rows : int
        Rows read at a time.

    Returns
    -------
    Result
        Groups ``blocks``, ``waves``, ``spectra``, ``directions``, ``current``, ``reflection``, ``tensions``,
        ``fits``, ``quality`` and ``whole``; those without content are absent.

    Raises
    ------
    InputError
        With file, row and column of what cannot be read.

    Examples
    --------
    >>> import math
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> from moyai.records import load_survey, run_survey
    >>> folder = Path(mkdtemp())
    >>> rows = [f"{0.5 * n},{math.sin(0.5 * n)}" for n in range(1200)]
    >>> _ = (folder / "gauge.csv").write_text("\\n".join(["t [s],level [m]", *rows]), encoding="utf-8")
    >>> text = "moyai: 1\\ntitle: Gauge\\nloggers:\\n- {name: gauge, file: gauge.csv, time: {column: t, unit: s},\\n"
    >>> text += "   channels: [{name: level, column: level, kind: elevation}]}\\n"
    >>> text += "blocks: {length: 5 min}\\nwaves: {channels: [level]}\\n"
    >>> _ = (folder / "survey.yaml").write_text(text, encoding="utf-8")
    >>> result = run_survey(load_survey(folder / "survey.yaml"))
    >>> result.tree["waves"]["third_height"].values.round(1).tolist()    # H1/3 of two blocks [m]
    [[2.0], [2.0]]
    """
    found: list[BlockResult] = []
    notices: list[Notice] = []
    status = "converged"
    message = ""
    readers: list[_Reader] = []
    try:
        first, dated = _first_instant(survey)
        origin = _origin(survey, first, dated)
        readers = [_Reader(read_chunks(logger, rows), notices) for logger in survey.loggers]
        streams: list[Iterator[RecordBlock]] = [blocks(iter(reader), origin, survey.block_length) for reader in readers]
        for number, (index, records) in enumerate(aligned(streams), 1):
            found.append(process_block(survey, index, origin, records))
            progress("blocks", number, number + 1)
    except KeyboardInterrupt:
        if not found:
            raise
        status, message = "interrupted", f"stopped after {len(found)} blocks"
    if not found:
        raise InputError("the files hold no sample", parameter="loggers")
    if len({reader.dated for reader in readers if reader.dated is not None}) > 1:
        raise InputError("one logger has dates and another only seconds", parameter="time", remedy="give 'start'")
    tree, further = _assemble(survey, found, dated)
    everything = tuple(dict.fromkeys([*notices, *further, *_summed_up(found)]))
    provenance = make_provenance(
        title=survey.title,
        case_hash=survey.case_hash,
        files=[str(path.name) for logger in survey.loggers for path in logger.files],
    )
    if not message:
        span = instant_text(found[0].start, dated), instant_text(found[-1].start + survey.block_length, dated)
        words = "1 block" if len(found) == 1 else f"{len(found)} blocks"
        message = f"{words} of {survey.block_length:g} s from {span[0]} to {span[1]}"
    return Result(tree, status, message, (), everything, provenance)  # type: ignore[arg-type]


class _Reader:
    """Passes chunks on, and keeps their notices."""

    def __init__(self, chunks: Iterator[Record], notices: list[Notice]) -> None:
        self.chunks, self.notices = chunks, notices
        self.dated: bool | None = None

    def __iter__(self) -> Iterator[Record]:
        for chunk in self.chunks:
            self.dated = chunk.dated
            self.notices.extend(chunk.notices)
            yield chunk


def _first_instant(survey: Survey) -> tuple[float, bool]:
    """Return the earliest first sample of all loggers, and whether it is a date."""
    starts = []
    dated = False
    for logger in survey.loggers:
        for chunk in read_chunks(logger, 64):
            starts.append(float(chunk.time[0]))
            dated = dated or chunk.dated
            break
    if not starts:
        raise InputError("the files hold no sample", parameter="loggers")
    return min(starts), dated


def _origin(survey: Survey, first: float, dated: bool) -> float:
    length = survey.block_length
    if math.isfinite(survey.block_start):
        return survey.block_start + math.floor((first - survey.block_start) / length) * length
    return math.floor(first / length) * length if dated else first


def _summed_up(found: Sequence[BlockResult]) -> list[Notice]:
    """Return notices of blocks, one for each code and wording, with how often it came."""
    counted: dict[str, list[Notice]] = {}
    for block in found:
        for notice in block.notices:
            counted.setdefault(notice.code, []).append(notice)
    out = []
    for entries in counted.values():
        first = entries[0]
        if len(entries) == 1:
            out.append(first)
            continue
        text = f"in {len(entries)} analyses of blocks, the first: {first.message}"
        out.append(Notice(first.code, text, first.value, first.limit, first.severity, first.remedy, first.source))
    return out


def _assemble(survey: Survey, found: Sequence[BlockResult], dated: bool) -> tuple[xr.DataTree, list[Notice]]:
    import xarray as xr

    start = np.array([block.start for block in found])
    words = "start of the block, since 1970-01-01 UTC" if dated else "start of the block"
    time = xr.Variable("block", start, {"units": "s", "long_name": words, "dated": int(dated)})
    groups: dict[str, xr.Dataset] = {}
    names = [channel.name for channel in survey.channels]
    symbols = _symbols(survey)
    groups["blocks"] = _channels(found, names, symbols, time)
    if survey.waves:
        groups["waves"] = _table(
            [
                {name: {**block.waves.get(name, {}), **_spectral(block, name)} for name in survey.waves}
                for block in found
            ],
            survey.waves,
            "gauge",
            (*STATISTICS, *FIGURES),
            time,
        )
        groups |= _spectra(survey, found, time)
    for key in ("directions", "current", "reflection"):
        rows = [getattr(block, key) for block in found]
        if any(rows):
            keys = tuple(dict.fromkeys(name for row in rows for name in row))
            groups[key] = _flat(rows, keys, time)
    if any(block.tensions for block in found):
        lines = tuple(entry.channel for entry in survey.tensions)
        keys = tuple(dict.fromkeys(name for block in found for row in block.tensions.values() for name in row))
        groups["tensions"] = _table([dict(block.tensions) for block in found], lines, "line", keys, time)
        groups["tensions"] = groups["tensions"].assign_coords(
            group=("line", np.array([entry.group for entry in survey.tensions], dtype=object))
        )
    if any(block.responses for block in found):
        groups["responses"] = _responses(survey, found, symbols, time)
    fits = fit_relations(survey, groups)
    if fits is not None:
        groups["fits"] = fits
    groups["quality"], notices = _quality(survey, found, names, dated)
    whole = _whole(survey, found)
    if whole is not None:
        groups["whole"] = whole
    described, undeclared = VOCABULARY.close({f"/{name}": dataset for name, dataset in groups.items()})
    tree = xr.DataTree.from_dict(described)
    tree.attrs = {
        "title": survey.title,
        "structure": "records",
        "case_hash": survey.case_hash,
        "case_text": survey.case_text,
        "block_length": survey.block_length,
        "dated": int(dated),
        "x_axis_bearing_deg": math.degrees(survey.x_axis_bearing),
    }
    return tree, [*notices, *undeclared]


def _symbols(survey: Survey) -> dict[str, str]:
    """Return the SI symbol of every channel, from the first chunk of its logger."""
    out: dict[str, str] = {}
    for logger in survey.loggers:
        chunk = next(iter(read_chunks(logger, 64)))
        out.update(zip(chunk.names, chunk.units))
    return out


def _channels(found: Sequence[BlockResult], names: Sequence[str], symbols: dict[str, str], time: Any) -> xr.Dataset:
    import xarray as xr

    labels = ("mean", "standard deviation", "smallest value", "largest value", "share of samples without a flag")
    data = {}
    for place, name in enumerate(names):
        table = np.array([block.channels.get(name, (math.nan,) * 5) for block in found])
        for column, (key, label) in enumerate(zip(("mean", "deviation", "smallest", "largest", "share"), labels)):
            unit = "1" if key == "share" else symbols.get(name, "")
            attributes = {"units": unit, "long_name": f"{label} of {name}", "channel": name}
            data[f"channel_{place}_{key}"] = ("block", table[:, column], attributes)
    dataset = xr.Dataset(data, {"time": time})
    dataset.attrs["channels"] = "\n".join(names)
    return dataset


def _spectral(block: BlockResult, name: str) -> dict[str, float]:
    return block.spectra[name][3] if name in block.spectra else {}


def _table(
    rows: Sequence[dict[str, dict[str, float]]], members: Sequence[str], dimension: str, keys: Sequence[str], time: Any
) -> xr.Dataset:
    import xarray as xr

    data = {}
    for key in keys:
        values = np.array([[row.get(member, {}).get(key, math.nan) for member in members] for row in rows])
        data[key] = (("block", dimension), values)
    return xr.Dataset(data, {"time": time, dimension: np.array(members, dtype=object)})


def _flat(rows: Sequence[dict[str, float]], keys: Sequence[str], time: Any) -> xr.Dataset:
    import xarray as xr

    data = {}
    for key in keys:
        values = np.array([row.get(key, math.nan) for row in rows])
        data[key] = ("block", values)
    return xr.Dataset(data, {"time": time})


def _spectra(survey: Survey, found: Sequence[BlockResult], time: Any) -> dict[str, xr.Dataset]:
    """Return the spectra of the blocks on the frequencies of the longest."""
    import xarray as xr

    grids = [block.spectra[name][0] for block in found for name in survey.waves if name in block.spectra]
    if not grids:
        return {}
    frequency = max(grids, key=len)
    density = np.full((len(found), len(survey.waves), frequency.size), np.nan)
    freedom = np.full((len(found), len(survey.waves)), np.nan)
    for row, block in enumerate(found):
        for column, name in enumerate(survey.waves):
            if name in block.spectra:
                own, values, degrees, _ = block.spectra[name]
                same = own.size == frequency.size and np.array_equal(own, frequency)
                density[row, column] = values if same else np.interp(frequency, own, values, right=np.nan)
                freedom[row, column] = degrees
    dataset = xr.Dataset(
        {
            "density": (("block", "gauge", "frequency"), density),
            "degrees_of_freedom": (("block", "gauge"), freedom),
        },
        {
            "time": time,
            "gauge": np.array(survey.waves, dtype=object),
            "frequency": ("frequency", frequency),
        },
    )
    return {"spectra": dataset}


def _responses(survey: Survey, found: Sequence[BlockResult], symbols: dict[str, str], time: Any) -> xr.Dataset:
    """Return modulus, phase, error and coherence of the responses."""
    import xarray as xr

    assert survey.responses is not None
    names = survey.responses.channels
    longest = max((entry for block in found for entry in block.responses.values()), key=lambda r: r.frequency.size)
    shape = (len(found), len(names), longest.frequency.size)
    tables = {key: np.full(shape, math.nan) for key in ("modulus", "phase", "error", "coherence")}
    for row, block in enumerate(found):
        for column, name in enumerate(names):
            entry = block.responses.get(name)
            if entry is None or entry.frequency.size != shape[2]:
                continue
            tables["modulus"][row, column] = entry.modulus
            tables["phase"][row, column] = np.angle(entry.response)
            tables["error"][row, column] = entry.error
            tables["coherence"][row, column] = entry.coherence
    wave = symbols.get(survey.responses.wave, "m")
    units = ", ".join(f"{name} {symbols.get(name, '')}/{wave}" for name in names)
    data: dict[str, Any] = {key: (("block", "motion", "frequency"), table) for key, table in tables.items()}
    data["error"] = (*data["error"], {"long_name": "standard error of the response amplitude"})
    coordinates = {
        "time": time,
        "motion": np.array(names, dtype=object),
        "frequency": ("frequency", longest.frequency),
    }
    return xr.Dataset(data, coordinates, {"units_of_modulus": units})


def _quality(
    survey: Survey, found: Sequence[BlockResult], names: Sequence[str], dated: bool
) -> tuple[xr.Dataset, list[Notice]]:
    """Return what was found about the samples, and the notices of gaps, flags, drift and unit slips."""
    import xarray as xr

    rows: list[tuple[str, str, float, float, int, str]] = []
    totals: dict[str, dict[str, int]] = {}
    gaps: list[tuple[float, float]] = []
    for block in found:
        gaps.extend(block.gaps)
        rows.extend((f.channel, f.kind, f.start, f.end, f.count, f.detail) for f in block.findings)
        for channel, kinds in block.counts.items():
            mine = totals.setdefault(channel, {})
            for kind, count in kinds.items():
                mine[kind] = mine.get(kind, 0) + count
    between = _silent_blocks(survey, found)
    gaps.extend(between)
    rows.extend(("(clock)", "gap", start, start + length, 0, f"{length:.6g} s") for start, length in gaps)
    samples = sum(block.samples for block in found)
    notices = list(quality_notices(totals, samples, gaps, dated))
    by_channel = {name: [block.moments[name] for block in found if name in block.moments] for name in names}
    for name, moments in by_channel.items():
        others = [by_channel[other] for other in names if other != name]
        slips = find_slips(moments, name, others=others) if survey.use_of(name).quality.unit_slips else ()
        if len(slips) > MOST_SLIPS:
            words = (
                f"{name}: {len(slips)} stretches of blocks differ from their neighbours by a factor near a unit's; "
                "that many are rather blocks too short to hold waves than wrong units"
            )
            notices.append(
                Notice("unit-slips", words, float(len(slips)), float(MOST_SLIPS), remedy="take longer blocks")
            )
        for slip in slips:
            first = next(block.start for block in found if block.index == slip.first)
            last = next(block.start for block in found if block.index == slip.last) + survey.block_length
            detail = f"scale {slip.factor:.3g} times that before and after, near a unit's factor {slip.unit_factor:.4g}"
            rows.append((name, "unit slip", first, last, 0, detail))
            words = f"{name}: from {instant_text(first, dated)} to {instant_text(last, dated)} {detail}"
            if len(slips) <= MOST_SLIPS:
                notices.append(Notice("unit-slip", words, slip.factor, 1.0, remedy="check the unit of these blocks"))
        share = survey.use_of(name).quality.drift_share
        drift = find_drift(moments, name)
        if drift is not None and drift.significant and drift.share > share:
            detail = f"trend of {drift.change:.4g} over the record, {drift.share:.2g} of its standard deviation"
            rows.append((name, "drift", found[0].start, found[-1].start + survey.block_length, 0, detail))
            notices.append(
                Notice("drift", f"{name}: {detail}", drift.share, share, remedy="check the zero, or take the tide off")
            )
    lost = len(rows) - MOST_FINDINGS
    if lost > 0:
        rows = rows[:MOST_FINDINGS]
        notices.append(Notice("findings-cut", f"{lost} further stretches are not listed; all are counted", float(lost)))
    columns: list[Any] = list(zip(*rows)) if rows else [[] for _ in range(6)]
    data = {
        "channel": ("finding", np.array(columns[0], dtype=object)),
        "kind": ("finding", np.array(columns[1], dtype=object), {"long_name": "what was found"}),
        "start": ("finding", np.array(columns[2], dtype=float)),
        "end": ("finding", np.array(columns[3], dtype=float), {"units": "s", "long_name": "last instant"}),
        "count": ("finding", np.array(columns[4], dtype=float), {"long_name": "samples"}),
        "detail": ("finding", np.array(columns[5], dtype=object)),
    }
    dataset = xr.Dataset(data)
    dataset.attrs["samples"] = samples
    return dataset, notices


def _silent_blocks(survey: Survey, found: Sequence[BlockResult]) -> list[tuple[float, float]]:
    """Return stretches of whole blocks without a sample of any logger."""
    out = []
    for before, after in itertools.pairwise(found):
        missing = after.index - before.index - 1
        if missing > 0:
            out.append((before.start + survey.block_length, missing * survey.block_length))
    return out


def _whole(survey: Survey, found: Sequence[BlockResult]) -> xr.Dataset | None:
    """Return the pooled heights of every gauge, each over its block's H1/3, with their fits."""
    import xarray as xr

    data: dict[str, Any] = {}
    kept = []
    for name in survey.waves:
        pooled: list[Array] = []
        for block in found:
            third = block.waves.get(name, {}).get("third_height", math.nan)
            if name in block.cut and len(block.cut[name]) >= 20 and third > 0.0:
                pooled.append(block.cut[name].height / third)
        if not pooled or np.unique(np.concatenate(pooled)).size < 6:
            continue
        heights = np.concatenate(pooled)
        heights = heights[heights > 0.0]
        weibull, rayleigh = fit_weibull(heights), fit_rayleigh(heights)
        levels = np.linspace(0.0, max(2.2, float(heights.max())), 89)
        exceeded = np.array([np.count_nonzero(heights > level) for level in levels]) / heights.size
        kept.append((name, levels, exceeded, weibull, rayleigh, heights.size))
    if not kept:
        return None
    levels = kept[0][1] if len(kept) == 1 else np.linspace(0.0, max(entry[1][-1] for entry in kept), 89)
    gauge = np.array([entry[0] for entry in kept], dtype=object)
    exceedance = [np.interp(levels, entry[1], entry[2], right=0.0) for entry in kept]
    data["exceedance"] = (("gauge", "ratio"), np.array(exceedance))
    for key, values in (
        ("weibull_scale", [entry[3].scale for entry in kept]),
        ("weibull_shape", [entry[3].shape for entry in kept]),
        ("weibull_shape_error", [entry[3].shape_error for entry in kept]),
        ("weibull_distance", [entry[3].distance for entry in kept]),
        ("rayleigh_scale", [entry[4].scale for entry in kept]),
        ("rayleigh_distance", [entry[4].distance for entry in kept]),
        ("wave_count", [float(entry[5]) for entry in kept]),
    ):
        data[key] = ("gauge", np.array(values))
    return xr.Dataset(data, {"gauge": gauge, "ratio": ("ratio", levels)})
