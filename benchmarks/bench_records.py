"""A week of ten channels at 10 Hz: seconds and peak memory of reading, quality control, waves and spectra.

``python benchmarks/bench_records.py [days] [csv]`` prints JSON lines: one for each format, with the time of a bare read
of the same file by the library below as the peer. Every run has its own process, so that its peak memory is its own.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

RATE, CHANNELS = 10.0, 10

SURVEY = """
moyai: 1
title: Week
loggers:
  - name: tower
    file: {name}
    time: {{column: time}}
    channels:
{channels}
blocks: {{length: 20 min}}
waves: {{channels: [c0]}}
spectrum: {{segment: 200 s, lowest: 0.04 Hz, highest: 0.5 Hz}}
"""


def make(folder: Path, days: float, formats: list[str]) -> None:
    """Write the same sea to every format, in pieces of a day."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    random = np.random.default_rng(1)
    piece = int(86400 * RATE)
    total = int(days * piece)
    names = [f"c{i}" for i in range(CHANNELS)]
    schema = pa.schema([("time", pa.float64())] + [(name, pa.float32()) for name in names])
    writer = pq.ParquetWriter(folder / "week.parquet", schema)
    import h5netcdf

    file = h5netcdf.File(folder / "week.nc", "w")
    file.dimensions = {"time": total}
    for name in ("time", *names):
        file.create_variable(name, ("time",), np.float64 if name == "time" else np.float32, chunks=(131072,))
    stream = (folder / "week.csv").open("w") if "csv" in formats else None
    if stream:
        stream.write("time," + ",".join(names) + "\n")
    for first in range(0, total, piece):
        size = min(piece, total - first)
        t = (first + np.arange(size)) / RATE
        noise = np.fft.rfft(random.normal(size=size))
        f = np.fft.rfftfreq(size, 1.0 / RATE)
        sea = np.fft.irfft(noise * np.exp(-(((f - 0.14) / 0.04) ** 2)), size)
        sea = (sea / sea.std()).astype(np.float32)
        gains = [1.0 + 0.1 * i for i in range(CHANNELS)]
        columns = [(sea * gain + 0.01 * random.normal(size=size)).astype(np.float32) for gain in gains]
        writer.write_table(pa.table([t, *columns], schema=writer.schema))
        file.variables["time"][first : first + size] = t
        for name, column in zip(names, columns):
            file.variables[name][first : first + size] = column
        if stream:
            np.savetxt(stream, np.column_stack([t, *columns]), fmt="%.1f" + ",%.4f" * CHANNELS)
    writer.close()
    file.close()
    if stream:
        stream.close()


def run(folder: Path, form: str) -> None:
    """Work the survey off and print what it took."""
    name = {"parquet": "week.parquet", "netcdf": "week.nc", "csv": "week.csv"}[form]
    channels = "\n".join(f"      - {{name: c{i}, column: c{i}, kind: elevation, unit: m}}" for i in range(CHANNELS))
    (folder / f"{form}.yaml").write_text(SURVEY.format(name=name, channels=channels))
    from moyai.records.survey.case.build import load_survey
    from moyai.records.survey.run import run_survey

    survey = load_survey(folder / f"{form}.yaml")
    start = time.perf_counter()
    result = run_survey(survey)
    seconds = time.perf_counter() - start
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0
    start = time.perf_counter()
    _bare(folder / name, form)
    bare = time.perf_counter() - start
    print(
        json.dumps(
            {
                "benchmark": f"records, {form}",
                "blocks": int(result.tree["blocks"].sizes["block"]),
                "seconds": round(seconds, 2),
                "processor_seconds": round(time.process_time(), 2),
                "bare_read_seconds": round(bare, 2),
                "ratio_to_bare_read": round(seconds / bare, 2),
                "peak_memory_MB": round(memory),
            }
        )
    )


def _bare(path: Path, form: str) -> None:
    """Read every value once, by the chunk, and do nothing."""
    if form == "parquet":
        import pyarrow.parquet as pq

        for batch in pq.ParquetFile(path).iter_batches(131072, use_threads=False):
            assert batch.num_rows
    elif form == "netcdf":
        import h5py

        with h5py.File(path) as file:
            for name in file:
                for first in range(0, file[name].size, 131072):
                    file[name][first : first + 131072]
    else:
        import pandas as pd

        for _ in pd.read_csv(path, chunksize=131072):
            pass


if __name__ == "__main__":
    if len(sys.argv) > 3 and sys.argv[1] == "--one":
        run(Path(sys.argv[2]), sys.argv[3])
    else:
        days = float(sys.argv[1]) if len(sys.argv) > 1 else 7.0
        formats = ["parquet", "netcdf", *(["csv"] if "csv" in sys.argv else [])]
        with tempfile.TemporaryDirectory() as place:
            make(Path(place), days, formats)
            for form in formats:
                subprocess.run([sys.executable, __file__, "--one", place, form], check=True)
