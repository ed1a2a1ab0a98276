"""Hold the measured section of the flume against the computed one, run by run.

    python compare.py                              the runs of the records' folder that are known here
    python compare.py --records FOLDER 2082 3071_1 named runs, period by their two middle digits
    python compare.py --sensitivity                what the inputs that are least known would change

Records: folder ``flume_moored_section`` of the measured data (``MOYAI_SHARED_DATA`` or ../shared/data next to the
repository). Heights of the incident waves are taken from each record; nothing else of a record enters the computation.
"""

from __future__ import annotations

import argparse
import math
import os
import sys
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import yaml

import moyai
from moyai.records.survey.flume import FlumeLayout, RegularRun, analyse_regular_run, read_flume_record, wavemaker_start
from moyai.sea.dispersion import wave_number
from moyai.sea.water import Water

HERE = Path(__file__).resolve().parent
CASE = HERE / "section.yaml"

# Two middle digits of a run -> wave period [s], table of the source's set-up
PERIODS = {
    "01": 1.516,
    "02": 1.269,
    "03": 1.238,
    "04": 1.210,
    "05": 1.183,
    "06": 1.158,
    "07": 1.113,
    "08": 1.072,
    "09": 1.036,
    "10": 0.897,
    "11": 0.802,
    "12": 0.733,
    "13": 0.678,
    "14": 0.634,
}
LAYOUT = FlumeLayout(
    model=7.0,
    gauges={"WP_1": 3.0, "WP_2": 4.95, "WP_3": 5.20, "WP_4": 5.50, "WP_6": 8.50},
    front=("WP_2", "WP_3", "WP_4"),
    behind=("WP_6",),
)
RAMP_PERIODS = 5.0  # the source's linear ramp of the wavemaker


@dataclass(frozen=True)
class Row:
    """One measured figure next to its computed one.

    Parameters
    ----------
    run, quantity, unit : str
    measured, spread, computed : float
        ``spread`` is how much the measured figure moves within the useful window.
    absolute : bool
        Whether the error is a difference (coefficients between 0 and 1) and not a fraction.
    """

    run: str
    quantity: str
    unit: str
    measured: float
    spread: float
    computed: float
    absolute: bool = False

    @property
    def error(self) -> float:
        """Computed less measured, as a fraction of the measured figure unless ``absolute``."""
        difference = self.computed - self.measured
        return difference if self.absolute else difference / abs(self.measured)


def default_records() -> Path:
    """Return where the records lie by default."""
    shared = os.environ.get("MOYAI_SHARED_DATA", HERE.parents[2] / "shared" / "data")
    return Path(shared) / "flume_moored_section"


def read_run(folder: Path, name: str) -> RegularRun:
    """Read one record and analyse its useful window."""
    content = yaml.safe_load(CASE.read_text(encoding="utf-8"))["site"]
    water = Water(
        _number(content["water_depth"]), density=_number(content["density"]), gravity=_number(content["gravity"])
    )
    record = read_flume_record(folder / f"{name}.csv", units={"WM_Position": "m"})
    start = wavemaker_start(record.time, record.channel("WM_Position"), fraction=0.02)
    return analyse_regular_run(record, LAYOUT, water, PERIODS[name[1:3]], start=start, ramp_periods=RAMP_PERIODS)


def _number(text: Any) -> float:
    return float(str(text).split()[0])


def compute(content: dict[str, Any], runs: dict[str, RegularRun]) -> Any:
    """Run the case with one sea state for each measured run: its period, its incident height."""
    content = dict(content)
    content["waves"] = [
        {
            "name": f"run {name}",
            "kind": "regular",
            "height": f"{2.0 * run.incident_amplitude:.6f} m",
            "periods": [run.period],
            "heading_deg": 0,
        }
        for name, run in runs.items()
    ]
    content["analyses"] = ["statics", "frequency"]
    frequencies = {round(2.0 * math.pi / run.period, 6) for run in runs.values()}
    # The lowest ones are for the slow sway on its springs
    content["settings"] = {"frequencies": sorted({0.70, 0.78, 0.86, 1.0, 1.5, 2.5, 3.5} | frequencies)}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "case.yaml"
        path.write_text(yaml.safe_dump(content, sort_keys=False), encoding="utf-8")
        return moyai.run(moyai.load_case(path)).tree["SWL"]


def fixed_rows(name: str, run: RegularRun, level: Any) -> list[Row]:
    """Compare a run with the model held fixed."""
    hydrodynamics = level["hydrodynamics"]
    index = int(np.argmin(np.abs(hydrodynamics["omega"].values - 2.0 * math.pi / run.period)))
    amplitude = run.incident_amplitude
    length = float(level["statics"]["unit_length"])
    force = np.abs(hydrodynamics["excitation_force"].values[index, 0]) * amplitude * length
    reflection = float(np.abs(hydrodynamics["reflection_coefficient"].values[index, 0]))
    transmission = float(np.abs(hydrodynamics["transmission_coefficient"].values[index, 0]))
    return [
        Row(name, "reflection", "-", run.reflection, run.reflection_spread, reflection, True),
        Row(name, "transmission", "-", run.transmission, run.transmission_spread, transmission, True),
        Row(name, "horizontal force", "N", abs(run.amplitude("Fy")), run.spread("Fy"), float(force[0])),
        Row(name, "vertical force", "N", abs(run.amplitude("Fz")), run.spread("Fz"), float(force[1])),
        Row(
            name,
            "mean horizontal force",
            "N",
            run.mean("Fy"),
            float(run.mean_spread[run.names.index("Fy")]),
            drift(run, reflection, transmission, level, length),
        ),
    ]


def drift(run: RegularRun, reflection: float, transmission: float, level: Any, length: float) -> float:
    """Return the mean horizontal force by momentum (Maruo) from computed reflection and transmission [N]."""
    depth = float(level.attrs["water_depth"])
    hydrodynamics = level["hydrodynamics"]
    density, gravity = float(hydrodynamics.attrs.get("rho", 1000.0)), float(hydrodynamics.attrs.get("g", 9.81))
    k = float(wave_number(2.0 * math.pi / run.period, depth, gravity))
    ratio = 1.0 + 2.0 * k * depth / math.sinh(2.0 * k * depth)
    return (
        0.25 * density * gravity * run.incident_amplitude**2 * ratio * (1.0 + reflection**2 - transmission**2) * length
    )


def free_rows(name: str, run: RegularRun, level: Any) -> list[Row]:
    """Compare a run with the model free in sway, heave and roll on its springs."""
    sea = level[f"frequency/run {name}"]
    motion = sea["motion_amplitude"].values[0]
    reflection = float(np.abs(sea["reflection_coefficient"].values[0]))
    transmission = float(np.abs(sea["transmission_coefficient"].values[0]))
    spring = 0.5 * (abs(run.amplitude("Tension_SB")) + abs(run.amplitude("Tension_PS")))
    rows = [
        Row(name, "reflection", "-", run.reflection, run.reflection_spread, reflection, True),
        Row(name, "transmission", "-", run.transmission, run.transmission_spread, transmission, True),
    ]
    for channel, unit, value in zip(("Sway", "Heave", "Roll"), ("m", "m", "rad"), motion):
        rows.append(Row(name, channel.lower(), unit, abs(run.amplitude(channel)), run.spread(channel), float(value)))
    rows.append(
        Row(name, "spring force", "N", spring, run.spread("Tension_SB"), float(sea["tension_amplitude"].values[0, 0]))
    )
    mean = float(run.mean_spread[run.names.index("Sway")])
    rows.append(Row(name, "mean sway", "m", run.mean("Sway"), mean, float(sea["mean_offset"].values[0, 0])))
    # The gauge in the vertical rail measures what the rig does to the model: springs and friction of the guides
    held = -run.mean("Force_Sway")
    held_spread = float(run.mean_spread[run.names.index("Force_Sway")])
    rows.append(Row(name, "mean drift force", "N", held, held_spread, float(sea["mean_drift_force"].values[0])))
    return rows


def compare(folder: Path, names: Iterable[str], content: dict[str, Any] | None = None) -> list[Row]:
    """Return all rows of the named runs; ``content`` is the case, section.yaml when absent."""
    runs = {name: read_run(folder, name) for name in names}
    level = compute(content or yaml.safe_load(CASE.read_text(encoding="utf-8")), runs)
    rows: list[Row] = []
    for name, run in runs.items():
        rows += (fixed_rows if name.startswith("2") else free_rows)(name, run, level)
    return rows


def natural_periods(folder: Path, name: str) -> dict[str, float]:
    """Return the computed natural periods [s]."""
    level = compute(yaml.safe_load(CASE.read_text(encoding="utf-8")), {name: read_run(folder, name)})
    statics = level["statics"]
    return dict(zip(("sway", "heave", "roll"), map(float, statics["natural_period"].values)))


VARIATIONS: dict[str, dict[str, Any]] = {
    "as in section.yaml": {},
    "roll damping doubled": {"roll_damping": {"quadratic": "0.1262 N m s2", "linear": "0.0520 N m s"}},
    "no roll damping given: computed from the section, heave too": {"roll_damping": None},
    "centre of gravity as planned, 0.108 m": {"centre_of_gravity_above_keel": "0.108 m"},
    "guide friction 0.35 N in sway and heave, linearised at 0.1 m/s": {
        "additional_damping": {"sway": "13.2 N s/m", "heave": "13.2 N s/m"}
    },
    "section fills the flume, 0.600 m": {"length": "0.600 m"},
    "draught follows from the mass": {"draught": None},
}


def sensitivity(folder: Path, names: Sequence[str]) -> dict[str, list[Row]]:
    """Return the rows for each variation of an input."""
    found = {}
    for title, change in VARIATIONS.items():
        content = yaml.safe_load(CASE.read_text(encoding="utf-8"))
        for key, value in change.items():
            if value is None:
                del content["structure"][key]
            else:
                content["structure"][key] = value
        found[title] = compare(folder, names, content)
    return found


def show(rows: Iterable[Row]) -> None:
    """Print rows as a table."""
    print(f"{'run':8} {'quantity':22} {'measured':>10} {'+-':>9} {'computed':>10}  error")
    for row in rows:
        error = f"{row.error:+.3f}" if row.absolute else f"{100.0 * row.error:+.1f} %"
        print(
            f"{row.run:8} {row.quantity:22} {row.measured:10.4g} {row.spread:9.2g} {row.computed:10.4g}  {error} "
            f"({row.unit})"
        )


def main(arguments: Sequence[str] | None = None) -> int:
    """Compare the runs named on the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="*", help="runs such as 2041 or 3061_1; all of the folder when none is named")
    parser.add_argument("--records", type=Path, default=default_records(), help="folder of the records")
    parser.add_argument("--sensitivity", action="store_true", help="vary the inputs that are least known")
    given = parser.parse_args(arguments)
    names = given.runs or sorted(path.stem for path in given.records.glob("[23]*.csv"))
    if not names:
        print(f"no records in {given.records}: give --records FOLDER", file=sys.stderr)
        return 1
    if given.sensitivity:
        for title, rows in sensitivity(given.records, names).items():
            print(f"\n{title}")
            show(rows)
        return 0
    show(compare(given.records, names))
    free = next((name for name in names if name.startswith("3")), None)
    if free:
        measured = {"sway": 7.50, "heave": 1.17, "roll": 1.26}
        for mode, period in natural_periods(given.records, free).items():
            print(f"natural period of {mode}: measured {measured[mode]:.2f} s, computed {period:.3f} s")
    return 0


if __name__ == "__main__":
    sys.exit(main())
