"""The measured section in a flume: waves as series, forces, motions and spring tensions of the twelve runs.

``python examples/records/moored_section.py``. Incident and reflected waves by harmonics over whole periods and, next to
them, as time series; tensions wave by wave.
"""

import numpy as np
from shared_folder import shared_folder

from moyai.records.survey.flume import FlumeLayout, analyse_regular_run, read_flume_record, wavemaker_start
from moyai.records.survey.irregular_reflection import wave_series
from moyai.records.survey.tensions import split_tension, tension_statistics, wave_maxima
from moyai.sea.water import Water
from moyai.series.detrend import Detrend
from moyai.series.zero_crossing import WaveOptions, find_waves

PERIODS = {"04": 1.210, "06": 1.158, "10": 0.897}
LAYOUT = FlumeLayout(
    model=7.0,
    gauges={"WP_1": 3.0, "WP_2": 4.95, "WP_3": 5.2, "WP_4": 5.5, "WP_6": 8.5},
    front=("WP_2", "WP_3", "WP_4"),
    behind=("WP_6",),
)
WATER = Water(1.0, density=1000.0, gravity=9.81)
RUNS = ("1041_1", "1061_1", "1101_1", "2041", "2062", "2101_2", "3041_2", "3061_1", "3101_3", "3102_1")


def analyse(run):
    """Return the figures of one run."""
    units = {"WM_Position": "m"}
    record = read_flume_record(shared_folder() / "flume_moored_section" / f"{run}.csv", units=units)
    period = PERIODS[run[1:3]]
    start = wavemaker_start(record.time, record.values[:, record.names.index("WM_Position")], fraction=0.02)
    found = analyse_regular_run(record, LAYOUT, WATER, period, start=start, ramp_periods=5.0)
    first = dict(zip(record.names, np.abs(found.harmonics.first), strict=True))
    inside = (record.time >= found.window.start) & (record.time < found.window.end)
    gauges = np.column_stack([record.values[:, record.names.index(name)] for name in LAYOUT.front])
    places = [LAYOUT.gauges[name] for name in LAYOUT.front]
    step = float(np.median(np.diff(record.time)))
    band = {"lowest": 0.7 / period, "highest": 1.35 / period}
    incident, reflected = wave_series(step, gauges, places, WATER, at=LAYOUT.model, **band)
    out = {
        "incident": float(np.abs(found.separation.incident[0])),
        "reflection": found.reflection,
        "transmission": found.transmission,
        "reflection of the series": float(reflected[inside].std() / incident[inside].std()),
        "first": first,
        "notices": len(found.notices),
    }
    if "Tension_SB" in record.names:
        waves = find_waves(record.time[inside], incident[inside], WaveOptions(detrend=Detrend("mean"), crest="sample"))
        for name in ("Tension_SB", "Tension_PS"):
            tension = record.values[inside, record.names.index(name)]
            split = split_tension(record.time[inside], tension, "median")
            maxima = wave_maxima(record.time[inside], split.fluctuating, waves.start, waves.period)
            out[name] = (split.level, tension_statistics(maxima.maximum))
    return out


def main():
    for run in RUNS:
        found = analyse(run)
        print(
            f"{run}: incident {1000 * found['incident']:.2f} mm, R {found['reflection']:.3f} (of the series "
            f"{found['reflection of the series']:.3f}), T {found['transmission']:.3f}"
        )
        named = [name for name in ("Fy", "Fz", "Sway", "Heave", "Roll") if name in found["first"]]
        if named:
            print("  " + ", ".join(f"{name} {found['first'][name]:.4g}" for name in named))
        for name in ("Tension_SB", "Tension_PS"):
            if name in found:
                level, figures = found[name]
                print(
                    f"  {name}: steady {level:+.3f} N, T_max {figures.maximum:.3f}, T_1/3 {figures.third:.3f}, mean of "
                    f"{figures.count} waves {figures.mean:.3f} N; first harmonic {found['first'][name]:.3f} N"
                )


if __name__ == "__main__":
    main()
