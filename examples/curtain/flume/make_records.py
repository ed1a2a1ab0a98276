"""Make a set of flume runs whose impact tensions are known, to try ``moyai measure snaps`` on.

    python examples/curtain/flume/make_records.py
    moyai measure snaps examples/curtain/flume/snaps.yaml -o out/snaps

A curtain of 0.7 m is let go in sixteen runs: six currents, three depths, four lengths, fishing line and steel wire. The
spikes are those of model A with drag, times 0.9 with 5 % scatter. Nothing of it was measured: the set shows what comes
back. ``records/planted.csv`` holds the impact tensions that were planted.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from synthetic_snaps import SnapLogger, made_record

from moyai.case.reader import read_block
from moyai.case.yaml_reader import read_yaml
from moyai.records.snaps.case.schema import SnapRunsFile
from moyai.sea.water import Water
from moyai.structures.curtain.impact.cable import Impact

HERE = Path(__file__).parent
FACTOR, SCATTER = 0.9, 0.05
LOGGERS = {
    "fishing line": SnapLogger(rate=200.0, noise=0.03, drift=0.3),
    "steel wire": SnapLogger(rate=1000.0, noise=0.3, drift=2.0),
}


def make(folder: Path = HERE / "records") -> None:
    """Write the record of every run of ``snaps.yaml``."""
    folder.mkdir(parents=True, exist_ok=True)
    model: SnapRunsFile = read_block(read_yaml(HERE / "snaps.yaml"), SnapRunsFile)
    rng = np.random.default_rng(11)
    water = Water(model.water_depth, model.density, model.gravity)
    planted = ["run,impact [N]"]
    for run in model.runs:
        pair = next(item for item in model.cables if item.name == run.cable)
        impact = Impact(model.span, run.length, run.draught, pair.upper, pair.lower, run.current, water)
        made = made_record(
            impact, drag_coefficient=model.drag_coefficient or 0.0, logger=LOGGERS[run.cable], rng=rng,
            spike_factor=FACTOR * (1.0 + SCATTER * rng.standard_normal()),
        )  # fmt: skip
        table = np.column_stack([made.time, *made.tension])
        header = "time [s], upper [N], lower [N]"
        np.savetxt(folder / Path(run.file).name, table, delimiter=",", header=header, comments="", fmt="%.4f")
        planted.append(f"{run.name},{made.impact:.4f}")
    (folder / "planted.csv").write_text("\n".join(planted) + "\n", encoding="utf-8")


if __name__ == "__main__":
    make(*(Path(argument) for argument in sys.argv[1:2]))
