"""Make records of towed wire nets whose coefficients are known, to try ``moyai measure nets`` on.

    python examples/nets/make_records.py
    moyai measure nets examples/nets/nets.yaml -o out/nets

Five nets of a published table are towed in still water, one of them through waves and in waves alone, on a carriage
that shakes at 3 Hz; the bare frame is towed too. Their drag follows a law that depends on solidity; C_M is 2. A cage
with two lines gives tensions at both ends. Nothing of it was measured: the file exists to show what comes back.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from moyai.morison.net_law_names import Net
from moyai.records.nets.runs import NetRun, Specimen, Tank
from moyai.records.nets.synthesis import Rig, towed_run, wave_run
from moyai.tables.nets import matsubara_net

HERE = Path(__file__).parent
TANK = Tank(density=1000.0, viscosity=1.14e-6, gravity=9.81, water_depth=0.45, panel_z=-0.2)
PANEL = 0.066
SPEEDS = (0.1, 0.2, 0.35, 0.6, 0.9)
C_M = 2.0


def drag(reynolds: float, solidity: float) -> float:
    """The planted law: C_D = A Re^-B with A = 9.84 exp(0.8 (S - 0.3)), B = 0.36 - 0.1 (S - 0.3)."""
    return 9.84 * math.exp(0.8 * (solidity - 0.3)) * reynolds ** -(0.36 - 0.1 * (solidity - 0.3))


def specimen(name: str) -> Specimen:
    """One of the ten nets on a panel of 660 cm2."""
    row = matsubara_net(name)
    net = Net.from_aperture(row.twine_diameter, row.aperture, solidity_listed=row.solidity)
    return Specimen(name, net, PANEL, row.projected_area)


def write(run: NetRun, folder: Path) -> None:
    """Write a run as CSV, rounded as a logger would."""
    columns = {"time [s]": run.time, "force [N]": run.force, "lift [N]": run.lift}
    if run.kind != "waves":
        columns["speed [m/s]"] = run.speed_record if run.speed_record is not None else np.full(run.time.size, run.speed)
    if run.velocity is not None:
        columns["velocity [m/s]"] = run.velocity
    if run.elevation is not None:
        columns["elevation [cm]"] = 100.0 * run.elevation
    lines = [", ".join(columns)]
    table = np.column_stack([values for values in columns.values() if values is not None])
    lines += [", ".join(f"{value:.4f}" for value in row) for row in table]
    (folder / f"{run.name}.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def cage(folder: Path, rng: np.random.Generator) -> None:
    """Write tensions of two lines at both ends, slack in every trough."""
    time = np.arange(0.0, 33.0, 0.01)
    wave = np.cos(2.0 * math.pi * time / 1.1)
    columns = {"time [s]": time}
    for line, mean, amplitude in (("shore", 0.9, 2.2), ("offshore", 0.3, 0.35)):
        upper = np.maximum(0.0, mean + amplitude * wave)
        for end, factor in (("cage", 1.0), ("anchor", 0.96)):
            columns[f"{line}_{end} [N]"] = np.maximum(0.0, factor * upper + 0.01 * rng.normal(size=time.size))
    lines = [", ".join(columns)]
    lines += [", ".join(f"{value:.4f}" for value in row) for row in np.column_stack(list(columns.values()))]
    (folder / "cage.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def main(folder: Path = HERE / "records") -> None:
    """Write all records, by default next to the file that describes them."""
    folder.mkdir(exist_ok=True)
    rng = np.random.default_rng(4)
    rig = Rig()
    nets = {name: specimen(name) for name in "ACEFG"}
    for speed in SPEEDS:
        centimetres = round(100 * speed)
        write(towed_run(rig, TANK, None, 0.0, speed, name=f"frame-{centimetres}", rng=rng), folder)
        for name, net in nets.items():
            law = lambda number, net=net: drag(number, net.net.solidity)  # noqa: E731
            write(towed_run(rig, TANK, net, law, speed, name=f"{name}-{centimetres}", rng=rng), folder)
    for label, net in (("frame", None), ("A", nets["A"])):
        for period, height in ((1.1, 0.05), (1.25, 0.08), (1.5, 0.094)):
            name = f"{label}-waves-{round(100 * period)}"
            run = wave_run(rig, TANK, net, 1.6, C_M, name=name, height=height, period=period, rng=rng)
            write(run, folder)
        name = f"{label}-towed-waves"
        run = wave_run(rig, TANK, net, 1.1, C_M, name=name, height=0.08, period=1.25, rng=rng, speed=0.35, meter=False)
        write(run, folder)
    cage(folder, rng)
    print(f"wrote {len(list(folder.glob('*.csv')))} records to {folder}")


if __name__ == "__main__":
    main()
