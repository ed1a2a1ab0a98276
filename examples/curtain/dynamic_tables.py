"""The whole span next to the models of the impact: the tables of the validation page.

    python examples/curtain/dynamic_tables.py cable     # dynamic cable over model A, and the energy that it keeps
    python examples/curtain/dynamic_tables.py span      # cables and skirt on several meshes
    python examples/curtain/dynamic_tables.py toe       # lower cable free to rise, with and without ballast
    python examples/curtain/dynamic_tables.py stiff     # skirt stiff along the span
    python examples/curtain/dynamic_tables.py waves     # regular waves: span, one-degree model, models A, A2, AB

A flume span of 0.7 m (the first four), the span of dynamic.yaml (the last).
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

import moyai
from moyai.sea.water import Water
from moyai.structures.curtain.dynamic.cable import dynamic_cable
from moyai.structures.curtain.dynamic.model import CurtainSpan, Mesh
from moyai.structures.curtain.dynamic.runs import run_span
from moyai.structures.curtain.impact.cable import Impact, peak_by_energy

WATER = Water(0.40, 1000.0, 9.81)
SOFT, STEEL = 75.0, 19500.0
VISCOSITY = {SOFT: 0.0036, STEEL: 0.058}


def model(stiffness: float, length: float = 0.8) -> Impact:
    """Return the flume span with two cables of one stiffness [N]."""
    return Impact(0.7, length, 0.15, stiffness, stiffness, 0.3, WATER)


def snap(stiffness: float, cells: tuple[int, int], profile: str, *, chord: float = 0.135, rises: float = 1.2,
         toe: float = 0.0625, **more: object) -> tuple[float, float, float]:  # fmt: skip
    """Return the peaks of both cables together, of the upper and of the lower one [N]."""
    span = CurtainSpan(0.7, 0.8, 0.15, chord, stiffness, stiffness, 0.0625, toe, 2e4, 0.1, **more)  # type: ignore[arg-type]
    rise = peak_by_energy(model(stiffness)).time
    mesh = Mesh(*cells, cable_viscosity=VISCOSITY[stiffness], skirt_damping_time=1e-5)
    run = run_span(
        span, mesh, WATER, duration=rises * rise, output_step=rise / 50.0, speed=0.3, profile=profile,  # type: ignore[arg-type]
        weight=False, deep=True,
    )  # fmt: skip
    return run.peak("both")[0], run.peak("upper cable")[0], run.peak("lower cable")[0]


def cable() -> None:
    """Print peaks over model A and the change of the energy, at 40, 80 and 160 segments."""
    for stiffness, length in ((SOFT, 0.8), (SOFT, 1.0), (SOFT, 0.72), (STEEL, 0.8)):
        impact = model(stiffness, length)
        for start in ("sag", "uniform"):
            for convective in (False, True):
                found = [
                    dynamic_cable(impact, own_mass=0.14, start=start, convective=convective, segments=n)  # type: ignore[arg-type]
                    for n in (40, 80, 160)
                ]
                print(
                    f"EA {2 * stiffness:g} N, l {length:g} m, {start}, {'all forces' if convective else 'mass alone'}:",
                    ", ".join(f"{one.tension / peak_by_energy(impact).tension:.4f}" for one in found),
                    "energy", ", ".join(f"{100.0 * one.energy_drift:.2f} %" for one in found),
                )  # fmt: skip


def span() -> None:
    """Print the peaks of the whole span on three meshes."""
    for stiffness in (SOFT, STEEL):
        for profile in ("sag", "uniform"):
            for cells in ((12, 4), (24, 8), (48, 16)):
                both, upper, lower = snap(stiffness, cells, profile)
                print(
                    f"EA {stiffness:g} N each, {profile}, {cells}: both {both:.2f}, upper {upper:.2f}, "
                    f"lower {lower:.2f} N"
                )


def toe() -> None:
    """Print the peaks with a lower cable that may rise."""
    for mass in (0.0625, 0.2625, 1.0625):
        for down in (8, 16, 32):
            both = snap(STEEL, (24, down), "uniform", rises=2.0, toe=mass, edges="risen")[0]
            print(f"lower cable {mass:g} kg/m, {down} cells over the depth: {both:.1f} N")


def stiff() -> None:
    """Print the peaks with a skirt as stiff along the span as along its depth, flat and bulging."""
    for chord in (0.15, 0.135):
        for cells in ((12, 4), (24, 8), (48, 16)):
            both = snap(SOFT, cells, "uniform", chord=chord, span_stiffness=2e4, shear_stiffness=2e4 / 2.6)[0]
            print(f"chord {chord:g} m, {cells}: {both:.2f} N")


def waves() -> None:
    """Print the highest tensions in regular waves by the span and by the models of the impact."""
    text = (Path(__file__).parent / "dynamic.yaml").read_text(encoding="utf-8")
    text = text.replace("cells_down: 8", "cells_down: 8\n    sensitivity: false")
    text = text.replace("settled_periods: 1", "settled_periods: 4").replace(
        "analysed_periods: 2", "analysed_periods: 4"
    )
    soft = (("catalogue: polyester, diameter: 24 mm", "axial_stiffness: 100 kN"), ("400 kN", "100 kN"))
    for ballast, buoyancy, changes in ((15, 980, ()), (120, 2400, ()), (600, 10700, ()), (600, 10700, soft)):
        case = text.replace("chain_mass: 15", f"chain_mass: {ballast}").replace(
            "buoyancy: 980", f"buoyancy: {buoyancy}"
        )
        for old, new in changes:
            case = case.replace(old, new)
        found = _run(case.replace("analyses: [dynamic]", "analyses: [waves, dynamic]"))
        swell = found["/SWL/waves/swell"].to_dataset()
        speed = float(np.max(swell["largest_contact_speed"]))
        whole = found["/SWL/dynamic/swell"].to_dataset()
        head = case[: case.index("analyses")]
        impact = _run(f"{head}analyses: [impact]\nsettings:\n  impact: {{start_speed: {speed:.4f} m/s}}\n")
        named = impact["/SWL/impact"].to_dataset()["both_cables_impact_tension"].to_series()
        tension = whole["both_cables_tension_peak_since_row"]
        late = tension.where(whole["time"] >= whole.attrs["counted_from"])
        print(
            f"ballast {ballast} kg/m{', EA 100 kN each' if changes else ''}: speed when taut {speed:.3f} m/s; span "
            f"{float(late.max()):.0f} N after five periods, {float(tension.max()):.0f} N in all; one degree of freedom "
            f"{float(np.max(swell['both_cables_tension_maximum'])):.0f} N; "
            + ", ".join(f"{name} {named[name]:.0f} N" for name in ("A", "A2", "AB") if name in named)
        )


def _run(text: str):  # type: ignore[no-untyped-def]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "case.yaml"
        path.write_text(text, encoding="utf-8")
        return moyai.run(moyai.load_case(path)).tree


PARTS = {"cable": cable, "span": span, "toe": toe, "stiff": stiff, "waves": waves}

if __name__ == "__main__":
    if not set(sys.argv[1:]) <= PARTS.keys() or len(sys.argv) < 2:
        sys.exit(f"give one or more of: {', '.join(PARTS)}")
    for part in sys.argv[1:]:
        PARTS[part]()
