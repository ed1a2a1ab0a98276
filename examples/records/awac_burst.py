"""A burst of a Nortek AWAC: the surface from pressure against the acoustic distance, and directions from p, u, v.

``python examples/records/awac_burst.py``. Which columns are which, and the heights of pressure cell and current cell,
are readings of plausibility: the file carries no header.
"""

import math

import numpy as np
from shared_folder import shared_folder

from moyai.records.comparison.model import agreement
from moyai.records.reading.quality import QualityOptions, check_record
from moyai.records.reading.reader import read_record
from moyai.records.reading.sensors import Sensor, surface_elevation
from moyai.records.reading.sources import ColumnSource, LoggerSource, TimeSource
from moyai.records.survey.directional import directional_spectrum, fourier_directions
from moyai.sea.water import Water
from moyai.series.spectra import WelchOptions, cross_spectra, spectrum_of

DBAR = 1.0e4
BAND = (0.05, 0.20)
# Pressure sensor half a metre above the bed; wave velocities from a cell some 3 m below the surface
SENSOR_ABOVE_BED, CELL_DEPTH = 0.5, 3.0


def read():
    """Return pressure [Pa], two acoustic distances [m] and the velocities [m/s]."""
    path = shared_folder() / "buoy_displacement" / "awac_test_data.wad"
    columns = (
        ColumnSource(7, "pressure", "kPa", scale=10.0),
        ColumnSource(8, "distance 1", "m"),
        ColumnSource(9, "distance 2", "m"),
        ColumnSource(12, "u", "m/s"),
        ColumnSource(13, "v", "m/s"),
    )
    return read_record(
        LoggerSource("awac", (path,), columns, TimeSource(rate=1.0), delimiter="whitespace", header_row=0, format="csv")
    )


def analyse():
    """Return the figures of the burst."""
    record = read()
    quality = check_record(record.select(["distance 1", "distance 2"]), QualityOptions(spike_scale=6.0))
    pressure = record["pressure"]
    depth = float(pressure.mean()) / (1025.0 * 9.81) + SENSOR_ABOVE_BED
    water = Water(depth=depth, density=1025.0, gravity=9.81)
    cell = Sensor("pressure", z=-depth + SENSOR_ABOVE_BED)
    found = surface_elevation(1.0, pressure, cell, water, lowest=BAND[0], highest=BAND[1])
    options = WelchOptions(segment=128.0)
    heights = {"from pressure": 4.0 * math.sqrt(spectrum_of(1.0, found.elevation, options).moment(0, *BAND))}
    heights["pressure as head"] = 4.0 * math.sqrt(
        spectrum_of(1.0, pressure / (1025.0 * 9.81), options).moment(0, *BAND)
    )
    agreements = {}
    for name in ("distance 1", "distance 2"):
        distance = quality.record.sound(name)
        raw = record[name]
        heights[f"{name}, 4 std as recorded"] = 4.0 * float(raw.std())
        # Spikes are left out: what follows needs an even clock, so only these few are bridged, here and in the open
        known = np.isfinite(distance)
        bridged = np.interp(record.time, record.time[known], distance[known])
        heights[name] = 4.0 * math.sqrt(spectrum_of(1.0, bridged, options).moment(0, *BAND))
        frequency = np.fft.rfftfreq(bridged.size, 1.0)
        band = np.fft.rfft(bridged - bridged.mean())
        band[(frequency < BAND[0]) | (frequency > BAND[1])] = 0.0
        agreements[name] = agreement(found.elevation, np.fft.irfft(band, bridged.size))
    sensors = (cell, Sensor("velocity_x", z=-CELL_DEPTH), Sensor("velocity_y", z=-CELL_DEPTH))
    matrix = cross_spectra(1.0, record.select(["pressure", "u", "v"]).values, options)
    quick = fourier_directions(matrix, sensors, water)
    whole = directional_spectrum(matrix, sensors, water, lowest=BAND[0], highest=BAND[1])
    inside = (quick.frequency >= BAND[0]) & (quick.frequency <= BAND[1])
    return {
        "depth": depth,
        "heights": heights,
        "agreements": agreements,
        "spikes": {name: quality.counts[name].get("spike", 0) for name in quality.counts},
        "moments": quick.figures(*BAND),
        "entropy": whole.figures(),
        "check_ratio": float(np.median(quick.check_ratio[inside])),
    }


def main():
    found = analyse()
    print(f"depth {found['depth']:.2f} m; spikes flagged {found['spikes']}")
    for name, height in found["heights"].items():
        print(f"  4 sqrt(m0), {name}: {height:.3f} m")
    for name, entry in found["agreements"].items():
        print(
            f"  surface from pressure against {name}: correlation {entry.correlation:.3f}, slope {entry.slope:.3f}, "
            f"rms {entry.rms:.3f} m"
        )
    for name in ("moments", "entropy"):
        figures = found[name]
        print(
            f"  {name}: heading {math.degrees(figures['mean_heading']):.0f} deg (0 along u, 90 along v), spread "
            f"{math.degrees(figures['spread']):.0f} deg"
        )
    print(f"  horizontal velocity over what the pressure implies: {found['check_ratio']:.2f} (1 in linear theory)")


if __name__ == "__main__":
    main()
