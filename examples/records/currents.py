"""Eighteen months of a tidal current with gaps, and short records of acoustic profilers.

``python examples/records/currents.py``: tidal ellipses and ebb and flood of the NOAA station s08010 (Southampton
Shoal), mean profiles of two profilers.
"""

import json
import math

import numpy as np
from shared_folder import shared_folder

from moyai.records.reading.arrays import read_netcdf
from moyai.records.reading.quality import find_gaps
from moyai.records.survey.currents import block_means, components, heading_of_bearing, mean_profile, principal_axis
from moyai.records.survey.tides import fit_tide


def station():
    """Return instants [s] and velocities [m/s], +x east and +y north."""
    content = json.loads((shared_folder() / "currents" / "s08010.json").read_text())
    stamps = sorted(content["s"], key=int)
    time = np.array([int(stamp) / 1000.0 for stamp in stamps])
    speed = np.array([content["s"][stamp] for stamp in stamps]) / 100.0
    bearing = np.radians([content["d"][stamp] for stamp in stamps])
    heading = heading_of_bearing(bearing, math.pi / 2.0, coming_from=False)
    return time, *components(speed, heading)


def analyse_station():
    """Return the figures of the station."""
    time, x, y = station()
    gaps, _ = find_gaps(time, float(np.median(np.diff(time))), 3.0)
    axis = principal_axis(x, y)
    fit = fit_tide(time, x, y)
    hours = block_means(time, x, y, length=3600.0)
    along = hours.normal(axis.heading)
    # Half of the record predicts the other half
    middle = time < 0.5 * (time[0] + time[-1])
    first = fit_tide(time[middle], x[middle], y[middle])
    px, py = first.predict(time[~middle])
    rest = np.var(x[~middle] - px) + np.var(y[~middle] - py)
    return {
        "count": time.size,
        "mean_speed": float(np.hypot(x, y).mean()),
        "largest_speed": float(np.hypot(x, y).max()),
        "longest_gap_days": max(length for _, length in gaps) / 86400.0,
        "gaps": len(gaps),
        "axis_bearing": (90.0 - math.degrees(axis.heading)) % 180.0,
        "axis": axis,
        "fit": fit,
        "hours": int(np.count_nonzero(np.isfinite(along))),
        "flood": float(np.nanmean(along[along > 0.0])),
        "ebb": float(np.nanmean(along[along < 0.0])),
        "explained_elsewhere": 1.0 - float(rest / (np.var(x[~middle]) + np.var(y[~middle]))),
    }


def profile(name, surface):
    """Return the mean profile of a profiler in earth coordinates; bins above ``surface`` [m] are left out."""
    path = shared_folder() / "currents" / name
    chunk = next(read_netcdf(path, ["pressure", "vel[0,0]"], 10_000))
    pressure = np.asarray(chunk.columns["pressure"])
    import h5py

    with h5py.File(path) as file:
        heights = np.asarray(file["range"][:], dtype=float)
    both = []
    for component in (0, 1):
        names = [f"vel[{component},{place}]" for place in range(heights.size)]
        part = next(read_netcdf(path, names, 10_000))
        both.append(np.array([part.columns[entry] for entry in names]))
    top = float(np.nanmean(pressure)) if surface is None else surface
    return mean_profile(heights, both[0], both[1], top=0.95 * top), top


def main():
    found = analyse_station()
    print(
        f"s08010: {found['count']} values, mean {found['mean_speed']:.3f}, largest {found['largest_speed']:.3f} m/s, "
        f"{found['gaps']} gaps, the longest {found['longest_gap_days']:.1f} days"
    )
    print(
        f"  axis towards {found['axis_bearing']:.0f} deg, {found['axis'].major:.3f} and {found['axis'].minor:.3f} m/s; "
        f"mean flood and ebb along it {found['flood']:.2f}, {found['ebb']:.2f} m/s"
    )
    fit = found["fit"]
    print(
        f"  {len(fit.ellipses)} constituents explain {100 * fit.explained:.1f} % (those of the first half explain "
        f"{100 * found['explained_elsewhere']:.1f} % of the second); residual {fit.mean[0]:.3f}, {fit.mean[1]:.3f} m/s"
    )
    for ellipse in sorted(fit.ellipses, key=lambda entry: -entry.major)[:6]:
        print(
            f"    {ellipse.name}: {ellipse.major:.3f} +- {ellipse.error:.3f} m/s, minor {ellipse.minor:.3f}, "
            f"towards {(90 - math.degrees(ellipse.heading)) % 180:.0f} deg, {ellipse.period / 3600:.3f} h"
        )
    for name in ("Sig1000_tidal.nc", "AWAC_test01.nc"):
        mean, top = profile(name, None)
        speed, bins = math.hypot(*mean.depth_mean), np.isfinite(mean.x).sum()
        print(
            f"{name}: surface {top:.1f} m over the instrument, {bins} of {mean.z.size} bins, depth mean {speed:.3f} m/s"
        )
        print(f"  power law {mean.exponent:.3f} +- {mean.exponent_error:.3f}")


if __name__ == "__main__":
    main()
