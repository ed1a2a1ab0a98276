"""The statements of the paper, each judged from the runs, and what was filled in."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from moyai.morison.circulation import magnus_force
from moyai.reproduce.arai.figures import lost_force
from moyai.reproduce.arai.runs import BREADTH, CONTOURS, FREQUENCY, OMEGA, PERIOD, PRINTED, SECTIONS, AraiRuns, speed
from moyai.reproduce.inputs import run_problem
from moyai.reproduce.model import FilledInput, Finding, Statement, judged, measured
from moyai.sea.dispersion import wave_number
from moyai.sea.kinematics import depth_functions


def _at(runs: AraiRuns, section: str, name: str, number: float, axis: int = 0) -> float:
    data = runs.sweep(section)
    values = data[name].values
    return float(np.interp(number, data.keulegan_carpenter.values, values[:, axis] if values.ndim > 1 else values))


def _falls_early(runs: AraiRuns) -> Finding:
    ideal = runs.ideal("circle")[0]
    share = [1.0 - _at(runs, "circle", "inertia_coefficient", number) / ideal for number in (0.5, 1.0)]
    planar = np.ptp(runs.sweep("circle").planar_inertia_coefficient.values[:, 0])
    words = (
        f"C_M of the circle falls by {100 * share[0]:.1f} % at KC 0.5 and {100 * share[1]:.1f} % at 1; "
        f"planar flow by {planar:.0f}"
    )
    return judged(share[1] > 0.05 and planar == 0.0, words)


def _ideal(runs: AraiRuns) -> Finding:
    miss = max(abs(_at(runs, name, "inertia_coefficient", 0.025, axis) / runs.ideal(name)[axis] - 1.0)
               for name in SECTIONS for axis in (0, 1))  # fmt: skip
    values = ", ".join(f"{name} {runs.ideal(name)[0]:.3f} and {runs.ideal(name)[1]:.3f}" for name in SECTIONS)
    return judged(miss < 1e-3, f"ideal values {values}; at KC 0.025 within {miss:.0e}")


def _directions(runs: AraiRuns) -> Finding:
    ratios = {name: runs.ideal(name)[1] / runs.ideal(name)[0] for name in SECTIONS}
    words = ", ".join(f"{name} {ratio:.2f}" for name, ratio in ratios.items())
    same = all(abs(ratios[name] - 1.0) < 1e-3 for name in ("circle", "square"))
    return judged(same and 1.6 < ratios["rectangle"] < 2.4, f"vertical over horizontal: {words}")


def _rises_again(runs: AraiRuns) -> Finding:
    data = runs.sweep("circle")
    known = data.inertia_coefficient.values[:, 0]
    last = float(data.keulegan_carpenter.values[np.isfinite(known)].max())
    words = f"the fall is held beyond KC 2 and the curve ends at {last:g}"
    return judged(
        bool(known[np.isfinite(known)][-1] > np.nanmin(known) + 1e-6), words,
        "the rise is the work of a vortex of the size of the section, which no model here sheds; beyond 2 the "
        "run warns and a "
        "measured table can be given",
    )  # fmt: skip


def _coefficients(runs: AraiRuns) -> Finding:
    fall = {name: runs.ideal(name)[0] - _at(runs, name, "inertia_coefficient", 1.0) for name in SECTIONS}
    words = "at KC = 1: " + ", ".join(f"{name} {value:.4f} (printed {PRINTED[name]})" for name, value in fall.items())
    return judged(all(abs(value - PRINTED[name]) < 0.005 for name, value in fall.items()), words)


def _both_ways(runs: AraiRuns) -> Finding:
    ideal = runs.ideal("rectangle")
    falls = [ideal[axis] - _at(runs, "rectangle", "inertia_coefficient", 2.0, axis) for axis in (0, 1)]
    waves = runs.waves("rectangle")
    tank = (ideal[None, :] - waves.effective_inertia_coefficient.values)[-1]
    words = (
        f"{falls[0]:.3f} and {falls[1]:.3f} at KC = 2 in circular orbits; in the tank, whose orbits are "
        f"{float(waves.orbit_ratio[-1]):.2f} as high as wide, the vertical fall is {tank[1] / tank[0]:.2f} of "
        f"the horizontal"
    )
    return judged(abs(falls[1] / falls[0] - 1.0) < 0.01, words)


def _same_circulation(runs: AraiRuns) -> Finding:
    found = [1e4 * _at(runs, name, "circulation", number) for number in (1.0, 2.0) for name in SECTIONS]
    words = f"{found[0]:.1f} cm2/s at KC = 1, {found[3]:.1f} at 2, alike for the three sections by the law"
    return judged(
        np.ptp(found[:3]) < 1e-9 and abs(found[3] / found[0] - 4.0) < 1e-6 and abs(found[0] - 18.0) < 0.05, words
    )


def _otsuka(runs: AraiRuns) -> Finding:
    found = [1e4 * _at(runs, "circle", f"{name}_circulation", 1.0) for name in ("arai", "otsuka", "chaplin")]
    words = f"{found[0]:.1f}, {found[1]:.1f} and {found[2]:.1f} cm2/s at KC = 1 by Arai, Otsuka and Ikeda, Chaplin"
    return judged(max(found) / min(found) < 1.15, words)


def _opposes(runs: AraiRuns) -> Finding:
    angle = np.linspace(0.0, 2.0 * math.pi, 73)
    flow = np.column_stack([np.cos(angle), -np.sin(angle)])
    rate = np.column_stack([-np.sin(angle), -np.cos(angle)])
    along = np.sum(magnus_force(1.0, 1.0, flow) * rate, axis=1)
    words = f"lift along the acceleration is {along.min():.3f} to {along.max():.3f} of itself over the period"
    return judged(bool(np.all(along < -0.999)), words)


def _same_force(runs: AraiRuns) -> Finding:
    worst = 0.0
    for number in (0.5, 1.0, 1.5, 2.0):
        losses = [each for name in SECTIONS for each in lost_force(runs, name, number)]
        lift = _at(runs, "circle", "magnus_force_per_length", number) * 0.79
        worst = max(worst, max(abs(loss / lift - 1.0) for loss in losses))
    one = lost_force(runs, "circle", 1.0)[0]
    words = f"{1e3 * one:.1f} mN at KC = 1 on 79 cm; sections and lift within {100 * worst:.2f} % up to KC = 2"
    return judged(worst < 0.01, words)


def _inertia_rules(runs: AraiRuns) -> Finding:
    waves = runs.waves("circle")
    ratio = (
        math.pi**2
        * waves.effective_inertia_coefficient.values[:, 0]
        / (waves.drag_coefficient.values[:, 0] * waves.keulegan_carpenter.values)
    )
    words = (
        f"inertia over drag amplitude {ratio.min():.1f} to {ratio.max():.0f} over the waves, C_D = "
        f"{float(waves.drag_coefficient[0, 0]):g} filled in"
    )
    return judged(ratio.min() > 3.0, words)


def _beta(runs: AraiRuns) -> Finding:
    beta = runs.waves("circle").beta.values
    return judged(bool(np.ptp(beta) < 1.0 and 1670 <= beta[0] <= 1720), f"beta = {beta[0]:.0f} (quoted 1670 to 1720)")


def _surface(runs: AraiRuns) -> Finding:
    change = max(
        float(np.abs(runs.members[name].tree["SWL/surface/regular"].to_dataset().near_surface_change.values).max())
        for name in SECTIONS
    )
    return judged(change < 0.10, f"the surface changes C_M by at most {100 * change:.1f} % by potential theory")


def _turns(runs: AraiRuns) -> Finding:
    data = runs.sweep("circle")
    angle = np.degrees(data.surface_angle.values)
    place = {
        str(phase): float(angle[int(np.argmax(data.surface_speed_ratio.sel(phase=phase).values))])
        for phase in data.phase.values
    }
    turned = [place["crest"], place["falling surface"], place["trough"], place["rising surface"]]
    steps = np.mod(np.diff([*turned, turned[0]]) + 180.0, 360.0) - 180.0
    words = (
        "fastest at " + ", ".join(f"{value:.0f}" for value in turned) + " degrees at crest, zero-down, trough, zero-up"
    )
    return judged(bool(np.all(np.abs(np.abs(steps) - 90.0) < 6.0)) and abs(turned[2] + 90.0) < 6.0, words)


def _drifts(runs: AraiRuns) -> Finding:
    found = {name: [1e4 * runs.contour(number, 1.6, name) for number in (1.0, 1.5)] for name in SECTIONS}
    parts = ", ".join(f"{name} {first:.0f} and {second:.0f}" for name, (first, second) in found.items())
    words = f"circulation of the drift, clockwise, on 1.6 times the breadth at KC = 1 and 1.5: {parts} cm2/s"
    return judged(all(0.0 < first < second for first, second in found.values()), words)


def _paths(runs: AraiRuns) -> Finding:
    _, paths = runs.paths(1.5, 2.2, 8)
    moved = np.linalg.norm(paths[:, -1] - paths[:, 0], axis=1)
    around = paths[:, 0, 0] * paths[:, -1, 1] - paths[:, 0, 1] * paths[:, -1, 0]
    words = (
        f"{int(np.sum(around < 0.0))} of {len(paths)} particles on 2.2 times the circle are clockwise of their place "
        f"after a period, by {1e3 * moved.min():.1f} to {1e3 * moved.max():.1f} mm"
    )
    return judged(bool(np.all(around < 0.0)) and moved.min() > 0.0, words)


def _vortex_path(_runs: AraiRuns) -> Finding:
    return measured("no model here sheds vortices", "where a vortex is at each phase only pictures show")


def _square_less_orderly(_runs: AraiRuns) -> Finding:
    return measured(
        "the law gives the square the circulation of the others", "the order of arrows and points only pictures show"
    )


def _contour(runs: AraiRuns) -> Finding:
    values = 1e4 * runs.contours[1.0]
    words = (
        f"{values[0]:.1f} to {values[-1]:.1f} cm2/s from B_c/B = {CONTOURS[0]} to {CONTOURS[-1]:g} without "
        f"any vortex; planted 18.0, found {1e4 * runs.extrapolated(1.0):.1f}"
    )
    return judged(
        values[0] / values[-1] < 1.05, words,
        "the dependence needs no vortices: particles show the Stokes drift as well, which falls with the fourth "
        "power of the "
        "distance; the fit that takes it apart finds the circulation at the wall",
    )  # fmt: skip


def _interpolates(runs: AraiRuns) -> Finding:
    miss = 1e3 * runs.interpolation_error
    words = f"median miss of the place after a period {miss[0]:.2f} mm at KC = 1, {miss[1]:.2f} mm at 1.5"
    return judged(miss.max() < 1.0, words)


def _background(runs: AraiRuns) -> Finding:
    k = float(wave_number(OMEGA, 0.5, 9.81))
    v = speed(1.0)
    return measured(f"mass transport of waves of KC = 1 is {1e3 * v**2 * k / OMEGA:.1f} mm/s at the depth of the model",
                    "settling and drift of the beads are measured in each campaign")  # fmt: skip


def _vortex(_runs: AraiRuns) -> Finding:
    return measured("a circulation alone gives the fall", "whether vortices are seen only pictures show")


STATEMENTS = (
    Statement(
        "early",
        "2, figure 2",
        "In circular orbits C_M falls from KC below 1; in planar flow it does not.",
        _falls_early,
    ),
    Statement("ideal", "2, figure 2", "At small KC the coefficients tend to those of ideal fluid.", _ideal),
    Statement(
        "directions",
        "2, figure 2",
        "C_M is alike both ways for circle and square; vertical about twice horizontal for the rectangle.",
        _directions,
    ),
    Statement("rise", "2, figure 2", "Beyond KC about 3 C_M rises again.", _rises_again),
    Statement("inertia", "2", "Inertia outweighs drag in the tests.", _inertia_rules),
    Statement("beta", "2", "The frequency parameter is nearly constant.", _beta),
    Statement("surface", "2", "The surface hardly acts on the model at its depth.", _surface),
    Statement(
        "both-ways", "2, figure 3", "The rectangle loses the same coefficient both ways up to KC about 2.", _both_ways
    ),
    Statement(
        "turns", "3, figure 6", "A fast region turns clockwise with the wave, below the body at the trough.", _turns
    ),
    Statement(
        "vortex",
        "3, figures 5, 6",
        "Where C_M falls no vortices are seen, where it rises there are large ones.",
        _vortex,
    ),
    Statement(
        "vortex-path",
        "3, figure 5",
        "The large vortex is born on top at the crest, goes round clockwise and is below to the right at the trough.",
        _vortex_path,
    ),
    Statement("paths", "3, figure 7", "Particles move clockwise and do not come back to their place.", _paths),
    Statement(
        "interpolation",
        "3, figure 8",
        "Interpolation between flashes gives the place after a period well.",
        _interpolates,
    ),
    Statement("background", "3, figure 9", "Without a model the drift is settling and mass transport.", _background),
    Statement("drift", "3, figure 10", "Particles drift clockwise around the sections, faster at larger KC.", _drifts),
    Statement(
        "square",
        "3, 4, figures 10, 13",
        "The flow about the square is less orderly, and one of its points leaves the law.",
        _square_less_orderly,
    ),
    Statement(
        "contour", "4, figure 12", "Circulation depends on the contour, since unseen vortices are shed.", _contour
    ),
    Statement("law", "4, figure 13", "Circulation is 18 KC^2 cm2/s for all sections.", _same_circulation),
    Statement("otsuka", "4, figure 13", "The circulation that Otsuka and Ikeda imply is close to it.", _otsuka),
    Statement("opposes", "4, figure 11", "The lift reduces the inertia force at all phases.", _opposes),
    Statement(
        "force",
        "4, figure 14",
        "The loss of force is the same for all sections up to KC 2, and is the lift.",
        _same_force,
    ),
    Statement("coefficients", "4, figure 3", "The lift gives falls of 0.19, 0.15 and 0.28 KC^2.", _coefficients),
)


def filled(runs: AraiRuns) -> tuple[FilledInput, ...]:
    """Return the inputs that were filled in."""

    def at_depth(depth: float) -> tuple[float, float]:
        k = float(wave_number(OMEGA, depth, 9.81))
        across, up = (float(item) for item in depth_functions(k, depth, -0.093)[:2])
        return up / across, 2.0 * BREADTH * FREQUENCY / (OMEGA * across)

    shapes = {depth: at_depth(depth) for depth in (0.4, 0.5, 0.7)}
    waves = runs.waves("circle")
    number, last = float(waves.keulegan_carpenter[-1]), waves.sizes["wave"] - 1
    taken = float(waves.effective_inertia_coefficient[last, 0])
    other = replace(runs.cases["circle"], circulation=replace(runs.cases["circle"].circulation, strength="chaplin"))
    changed = run_problem("member", other).tree["SWL/waves/regular"].to_dataset()
    return (
        FilledInput(
            "water depth", "0.5 m", "0.4; 0.7 m",
            "; ".join(f"orbit {ratio:.3f} as high as wide and {100 * height:.2f} cm of wave a KC at {depth} m"
                      for depth, (ratio, height) in shapes.items()),
        ),
        FilledInput("drag coefficient", f"{float(waves.drag_coefficient[0, 0]):g}", "none",
                    "none on C_M, which the first harmonic separates from drag"),
        FilledInput(
            "strength of the circulation in elliptic orbits", "0.936 of v_x v_y T", "1.036, Chaplin",
            f"C_M of the circle at KC = {number:.2f}: {taken:.3f} and "
            f"{float(changed.effective_inertia_coefficient[last, 0]):.3f}",
        ),
        FilledInput("kinematic viscosity", "1.14e-6 m2/s, 15 degrees", "1.118e-6; 1.152e-6 m2/s",
                    f"beta {BREADTH**2 / PERIOD / 1.118e-6:.0f} and {BREADTH**2 / PERIOD / 1.152e-6:.0f}; none on C_M"),
    )  # fmt: skip
