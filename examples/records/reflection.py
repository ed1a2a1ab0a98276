"""Three probes in a flume: incident and reflected waves, and a faulty set for the quality control.

``python examples/records/reflection.py``
"""

import math

import numpy as np
from shared_folder import shared_folder

from moyai.records.reading.quality import QualityOptions, check_record
from moyai.records.reading.reader import read_record
from moyai.records.reading.sources import ColumnSource, LoggerSource, TimeSource
from moyai.records.survey.irregular_reflection import separate_irregular
from moyai.records.survey.reflection import separate_waves
from moyai.sea.dispersion import wave_number
from moyai.sea.water import Water
from moyai.series.detrend import Detrend
from moyai.series.harmonics import fit_harmonics
from moyai.series.spectra import WelchOptions
from moyai.series.zero_crossing import WaveOptions, find_waves

WATER = Water(depth=0.25, density=1000.0, gravity=9.81)
POSITIONS = (0.0, 0.6, 0.9)


def probes():
    """Return the three probes at 100 Hz [m]."""
    path = shared_folder() / "flume_reflection" / "wavelabx_wavedata.csv"
    columns = tuple(ColumnSource(f"Probe {i}", f"probe {i}", "m") for i in (1, 2, 3))
    return read_record(LoggerSource("flume", (path,), columns, TimeSource(rate=100.0)))


def analyse():
    """Return period, heights, and the reflection by three methods."""
    record = probes().between(20.0, 200.0)
    waves = [
        find_waves(record.time, record[name], WaveOptions(detrend=Detrend("mean"), dead_band=0.002))
        for name in record.names
    ]
    period = float(np.mean([entry.period.mean() for entry in waves]))
    omega = 2.0 * math.pi / period
    fit = fit_harmonics(record.time, record.values, omega, count=3)
    k = float(wave_number(omega, WATER.depth, WATER.gravity))
    separated = separate_waves(POSITIONS, fit.first, k)
    broad = separate_irregular(
        record.step, record.values, POSITIONS, WATER, WelchOptions(segment=40.0), lowest=0.5, highest=1.1
    )
    naive = separate_irregular(
        record.step, record.values, POSITIONS, WATER, WelchOptions(segment=40.0), lowest=0.5, highest=1.1,
        subtract_noise=False,
    )  # fmt: skip
    return {
        "period": period,
        "waves": len(waves[0]),
        "heights": [float(entry.height.mean()) for entry in waves],
        "amplitudes": np.abs(fit.first),
        "wavelength": 2.0 * math.pi / k,
        "reflection": float(np.abs(separated.reflection_coefficient[0])),
        "reflection_error": float(separated.reflection_error[0]),
        "residual": float(separated.residual[0] / np.abs(separated.incident[0])),
        "condition": float(separated.condition[0]),
        "broad": broad.reflection,
        "broad_error": broad.reflection_error,
        "naive": naive.reflection,
    }


def faulty():
    """Return what the quality control finds in the faulty set."""
    path = shared_folder() / "flume_reflection" / "mhkit_three_probes_faulty.csv"
    columns = tuple(ColumnSource(f"probe{i}", f"probe{i}", "mm") for i in (1, 2, 3))
    source = LoggerSource("flume", (path,), columns, TimeSource(columns=("Time",), order="drop"))
    return check_record(read_record(source), QualityOptions(lowest=-0.5, highest=0.5, flat_seconds=0.05))


def main():
    found = analyse()
    heights = ", ".join(f"{1000 * height:.1f}" for height in found["heights"])
    amplitudes = ", ".join(f"{1000 * amplitude:.2f}" for amplitude in found["amplitudes"])
    print(f"period {found['period']:.4f} s, {found['waves']} waves, mean heights {heights} mm")
    print(f"first harmonic {amplitudes} mm, wavelength {found['wavelength']:.3f} m, condition {found['condition']:.2f}")
    print(f"reflection at the first harmonic {found['reflection']:.3f} +- {found['reflection_error']:.3f}")
    print(f"  residual {100 * found['residual']:.1f} % of the incident wave")
    print(f"reflection over the band {found['broad']:.3f} +- {found['broad_error']:.3f}")
    print(f"  with the noise of the probes left in {found['naive']:.3f}")
    quality = faulty()
    for notice in quality.record.notices:
        print(f"  {notice.message}")
    for finding in quality.findings:
        print(f"  {finding.channel}: {finding.kind}, {finding.count} from {finding.start:.3f} s {finding.detail}")


if __name__ == "__main__":
    main()
