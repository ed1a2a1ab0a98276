"""Raw displacements of a Waverider against the buoy's own half-hourly results.

``python examples/records/waverider.py`` prints, for four half hours of 1 July 2005, heights and periods by zero
crossing (.hiw) and the spectral figures and directions (.his) next to ours.
"""

import csv
import math

import numpy as np
from shared_folder import shared_folder

from moyai.records.reading.quality import QualityOptions, check_record
from moyai.records.reading.reader import read_record
from moyai.records.reading.sensors import Sensor
from moyai.records.reading.sources import ColumnSource, LoggerSource, TimeSource
from moyai.records.survey.directional import directional_spectrum, fourier_directions
from moyai.sea.water import Water
from moyai.series.detrend import Detrend
from moyai.series.spectra import WelchOptions, cross_spectra
from moyai.series.zero_crossing import WaveOptions, find_waves

HOURS = ("00h00", "00h30", "12h00", "18h30")
RATE = 1.28
# The site's depth is not in the files; the buoy's displacements are those of the surface, and deep water is assumed
WATER = Water(depth=math.inf, density=1025.0, gravity=9.81)
BAND = (0.025, 0.58)


def read(hour):
    """Return heave, north and west [m] of a raw file; x points north, y west."""
    path = shared_folder() / "buoy_displacement" / f"buoy}}2005-07-01T{hour}Z.raw"
    columns = (
        ColumnSource(2, "heave", "cm"),
        ColumnSource(3, "north", "cm"),
        ColumnSource(4, "west", "cm"),
    )
    return read_record(LoggerSource("buoy", (path,), columns, TimeSource(rate=RATE), header_row=0))


def own_results(ending):
    """Return the rows of the buoy's .hiw or .his file by the start of their half hour."""
    path = shared_folder() / "buoy_displacement" / f"buoy}}2005-07.{ending}"
    with path.open() as stream:
        rows = [row for row in csv.reader(stream) if row and row[0].startswith("2005-07-01")]
    found = {}
    for row in rows:
        hours, minutes = int(row[0][11:13]), int(row[0][14:16])
        found[f"{hours:02d}h{30 if minutes >= 30 else 0:02d}"] = row
    return found


def analyse(hour):
    """Return our figures of one half hour: zero crossing, spectrum, directions, flagged samples."""
    record = read(hour)
    quality = check_record(record, QualityOptions())
    heave = record["heave"]
    waves = find_waves(record.time, heave, WaveOptions(detrend=Detrend("none"), crest="sample"))
    sensors = (Sensor("elevation"), Sensor("displacement_x"), Sensor("displacement_y"))
    matrix = cross_spectra(1.0 / RATE, record.values, WelchOptions(segment=200.0))
    spectrum = matrix.spectrum(0)
    moments = fourier_directions(matrix, sensors, WATER).figures(*BAND)
    entropy = directional_spectrum(matrix, sensors, WATER, lowest=BAND[0], highest=BAND[1])
    return {
        **waves.statistics(),
        **spectrum.figures(*BAND),
        "freedom": spectrum.degrees_of_freedom,
        "bearing": coming_from(moments["peak_heading"]),
        "entropy_bearing": coming_from(entropy.figures()["peak_heading"]),
        "spread": math.degrees(moments["peak_spread"]),
        "flagged": int(np.count_nonzero(quality.record.flags)),
    }


def coming_from(heading):
    """Return the bearing that waves come from; +x is north and +y is west, so headings run against bearings."""
    return (math.degrees(-heading) + 180.0) % 360.0


def main():
    crossing, spectral = own_results("hiw"), own_results("his")
    print("zero crossing: ours / the buoy's own")
    for hour in HOURS:
        ours, own = analyse(hour), [float(cell) for cell in crossing[hour][2:]]
        pairs = (
            ("Hmax m", ours["maximum_height"], own[0] / 100.0),
            ("H1/10 m", ours["tenth_height"], own[2] / 100.0),
            ("H1/3 m", ours["third_height"], own[4] / 100.0),
            ("T1/3 s", ours["third_period"], own[5]),
            ("Hmean m", ours["mean_height"], own[6] / 100.0),
            ("Tmean s", ours["mean_period"], own[7]),
            ("waves", ours["count"], own[9]),
        )
        print(f"  {hour}: " + ", ".join(f"{name} {mine:.4g} / {theirs:.4g}" for name, mine, theirs in pairs))
    print("spectrum and directions: ours / the buoy's own (Tp, direction and spread at the peak, Tz, Hm0)")
    for hour in HOURS:
        ours, own = analyse(hour), [float(cell) for cell in spectral[hour][1:6]]
        pairs = (
            ("Tp s", ours["peak_period"], own[0]),
            ("from deg", ours["bearing"], own[1]),
            ("spread deg", ours["spread"], own[2]),
            ("Tz s", ours["period_m02"], own[3]),
            ("Hm0 m", ours["spectral_height"], own[4] / 100.0),
        )
        reported = ", ".join(f"{name} {mine:.4g} / {theirs:.4g}" for name, mine, theirs in pairs)
        print(
            f"  {hour}: {reported}; entropy from {ours['entropy_bearing']:.0f} deg, {ours['flagged']} samples flagged"
        )


if __name__ == "__main__":
    main()
