"""The statements of the paper, each judged from the runs."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.floating.energy import ENERGY_TOLERANCE, SHOWN_LOSS, unexplained_share
from moyai.reproduce.model import Finding, Statement, judged, measured
from moyai.reproduce.nakamura.figures import chain, restoring_curves
from moyai.reproduce.nakamura.runs import LEVEL, NakamuraRuns, abscissae, at, paired, peak, values

RESONANCE = 3.5
NEAR = (3.0, 4.2)  # L/B around the resonance of roll
SMALL = 0.05  # a change that the paper calls not significant
DOMAINS = 0.10  # difference of both domains that is little
JUMP = (
    "the long waves, where the spring of chains at rest hardens so much that the motion jumps to a second state, in "
    "which the first harmonic does not keep the energy of the wave; with chains in motion the jump is gone"
)


def _near(ratio: Array) -> NDArray[np.bool_]:
    return (ratio > NEAR[0]) & (ratio < NEAR[1])


def _steep(runs: NakamuraRuns) -> Finding:
    offsets, elastic, _, _ = restoring_curves(runs)
    tension = [float(np.interp(place, offsets, elastic)) for place in (-0.02, 0.0, 0.02)]
    last = float(elastic[-1])
    words = (
        f"{tension[0]:.2f}, {tension[1]:.2f}, {tension[2]:.2f} N at -2, 0, +2 cm and {last:.1f} N at "
        f"{100 * offsets[-1]:.2f} cm"
    )
    return judged(last > 4.0 * tension[1] and tension[2] - tension[1] > 2.0 * (tension[1] - tension[0]), words)


def _catenary(runs: NakamuraRuns) -> Finding:
    offsets, elastic, stiff, by_shoji = restoring_curves(runs)
    laid = np.isfinite(by_shoji)
    apart = np.abs(stiff / elastic - 1.0)
    between = float(apart[laid].max())
    shoji = float(np.max(np.abs(by_shoji[laid] / elastic[laid] - 1.0)))
    words = (
        f"while chain lies on the bed (to {100 * offsets[laid].max():+.1f} cm) the inextensible chain is within "
        f"{100 * between:.0f} % of the elastic one, {100 * float(np.interp(0.0, offsets, apart)):.1f} % at rest, "
        f"and Shoji's form within {shoji:.0e}"
    )
    return measured(words)


def _resonance(runs: NakamuraRuns) -> Finding:
    plain, damped = peak(runs.undamped), peak(runs.damped)
    words = f"peak of roll at L/B = {plain[1]:.2f} without and {damped[1]:.2f} with damping; near: within a tenth"
    return judged(all(abs(place / RESONANCE - 1.0) < 0.1 for _, place in (plain, damped)), words)


def _overshoot(runs: NakamuraRuns) -> Finding:
    plain, damped = peak(runs.undamped), peak(runs.damped)
    words = f"peak of theta B/H {plain[0]:.1f} without damping, {damped[0]:.2f} with 15 %"
    return judged(plain[0] > 3.0 * damped[0], words)


def _waves_damp(runs: NakamuraRuns) -> Finding:
    """Hold wave damping over critical damping of each mode at the resonance of roll."""
    water = runs.damped.tree[f"{LEVEL}/hydrodynamics"].to_dataset().sortby("period")
    statics = runs.damped.tree[f"{LEVEL}/statics"].to_dataset()
    length = float(statics.unit_length)
    along = abscissae(runs.damped, "frequency")
    period = float(np.interp(peak(runs.damped)[1], along["ratio"], along["period"]))
    share = []
    for mode in range(3):
        added, damping = (
            length * float(np.interp(period, water.period.values, water[name].values[:, mode, mode]))
            for name in ("added_mass", "radiation_damping")
        )
        mass = float(statics.inertia_matrix.values[mode, mode]) + added
        stiffness = float(
            statics.hydrostatic_stiffness.values[mode, mode] + statics.mooring_stiffness.values[mode, mode]
        )
        share.append(damping / (2.0 * np.sqrt(mass * stiffness)))
    sizes = f"{100 * share[0]:.0f}, {100 * share[1]:.0f} and {100 * share[2]:.1f} %"
    words = f"wave damping is {sizes} of critical in sway, heave, roll"
    return judged(min(share[:2]) > 4.0 * share[2], words)


def _prototype(runs: NakamuraRuns) -> Finding:
    """Compare the prototype column of table 1 with the column of the model."""
    body = runs.case.breakwater
    scale = 10.0 / 0.38
    assert body.draught is not None and body.centre_of_gravity is not None and body.roll_gyradius is not None
    low = scale * (body.draught - body.centre_of_gravity[1])
    turned = 618.6 * (scale * body.roll_gyradius) ** 2
    words = (
        f"the column of the model gives {low:.2f} m below still water at prototype scale, weight and gyradius "
        f"{turned:.2g} t m2"
    )
    return judged(
        abs(low - 0.17) < 0.05 and abs(turned / 4.41e7 - 1.0) < 0.1, words,
        "two misprints: the digits of 0.71 m are exchanged, and the power of ten is 3; the case follows the column of "
        "the model",
    )  # fmt: skip


def _drift_small(runs: NakamuraRuns) -> Finding:
    """Hold the drift force over the amplitude of the first-order force along the waves."""
    drift = values(runs.drifted, "frequency", "mean_drift_force")
    water = runs.drifted.tree[f"{LEVEL}/hydrodynamics"].to_dataset().sortby("period")
    along = water["excitation_force"].isel(wave_direction=0).sel(influenced_dof="sway")
    half = 0.5 * runs.case.environment.sea_states[0].height  # type: ignore[union-attr]
    length = float(runs.drifted.tree[f"{LEVEL}/statics"].to_dataset().unit_length)
    period = abscissae(runs.drifted, "frequency")["period"]
    wave = half * length * np.interp(period, water.period.values, np.abs(along.values))
    share = drift / wave
    words = (
        f"{100 * share.min():.1f} to {100 * share.max():.0f} % of the first-order force in sway, H = {200 * half:g} cm"
    )
    return judged(share.max() < 0.2, words)


def _fifteen(runs: NakamuraRuns) -> Finding:
    return measured(
        f"15 % lowers the peak of theta B/H from {peak(runs.undamped)[0]:.1f} to {peak(runs.damped)[0]:.2f}; which "
        "value fits best the measured points decide"
    )


def _drift_matters(runs: NakamuraRuns) -> Finding:
    sway, roll = (float(np.abs(_stiffness_change(runs, mode)).max()) for mode in ("sway", "roll"))
    words = f"drift changes K11 by up to {100 * sway:.1f} % and K33 by up to {100 * roll:.1f} %"
    return judged(max(sway, roll) > SMALL, words)


def _hardens(runs: NakamuraRuns) -> Finding:
    """Hold the slope of a chain's tension to seaward of the fairlead's place over that to shoreward."""
    ratio, swayed = (
        abscissae(runs.damped, "frequency")["ratio"],
        values(runs.damped, "frequency", "motion_amplitude", "sway"),
    )
    reach = float(np.interp(peak(runs.damped)[1], ratio, swayed))
    offsets, elastic, _, _ = restoring_curves(runs)
    slack, rest, taut = (float(np.interp(place, offsets, elastic)) for place in (-reach, 0.0, reach))
    words = (
        f"where roll resounds the unit sways by {100 * reach:.1f} cm: a chain takes {taut - rest:.2f} N more and "
        f"{rest - slack:.2f} N less than at rest"
    )
    return judged((taut - rest) > 1.5 * (rest - slack), words)


def _combined(runs: NakamuraRuns) -> Finding:
    """Hold the loss of the far field that the motion in time gives over the work of damping and chains."""
    result = runs.moving_time
    share = unexplained_share(values(result, "time", "dissipation"), values(result, "time", "damping_work"), SHOWN_LOSS)
    words = (
        "with the operators of the frequency domain and the motion in time, chains in motion, the far field loses what "
        f"damping takes within {100 * float(share.max()):.1f} % of the loss"
    )
    return judged(float(share.max()) < ENERGY_TOLERANCE, words)


def _roll_nearer(runs: NakamuraRuns) -> Finding:
    ratio = abscissae(runs.drifted_time, "time")["ratio"]
    short = ratio < 4.0
    in_time = (
        values(runs.drifted_time, "time", "motion_ratio", "roll")
        / values(runs.damped_time, "time", "motion_ratio", "roll")
        - 1.0
    )[short]
    return measured(f"drift changes roll in time by {100 * in_time.min():+.1f} to {100 * in_time.max():+.1f} %")


def _squared(runs: NakamuraRuns) -> Finding:
    drift = values(runs.drifted, "frequency", "drift_coefficient")
    ratio = abscissae(runs.drifted, "frequency")["ratio"]
    share = values(runs.drifted, "frequency", "reflection_coefficient") ** 2 / drift
    words = (
        f"C_R^2 is {100 * np.interp(1.5, ratio, share):.0f} % of F* at L/B = 1.5 and "
        f"{100 * np.interp(RESONANCE, ratio, share):.0f} % at 3.5"
    )
    return judged(
        float(share.min()) > 0.9, words,
        "by the paper's own equation (4) energy lost to damping adds E_L/2; C_R^2 alone holds without losses",
    )  # fmt: skip


def _short_waves_push(runs: NakamuraRuns) -> Finding:
    found = [at(runs.drifted, "frequency", "drift_coefficient", place) for place in (1.5, 2.5, RESONANCE, 5.0, 7.0)]
    words = "F* = " + ", ".join(f"{value:.2f}" for value in found) + " at L/B = 1.5, 2.5, 3.5, 5, 7"
    return judged(all(np.diff(found) < 0.0) and found[0] > 4.0 * found[-1], words)


def _stiffness_change(runs: NakamuraRuns, mode: str) -> Array:
    rest = values(runs.damped, "frequency", "mooring_stiffness", mode)
    return values(runs.drifted, "frequency", "mooring_stiffness", mode) / rest - 1.0


def _stiffness_follows(runs: NakamuraRuns) -> Finding:
    ratio, drift = abscissae(runs.drifted, "frequency")["ratio"], values(runs.drifted, "frequency", "drift_coefficient")
    short = ratio < RESONANCE
    sway, roll = _stiffness_change(runs, "sway"), _stiffness_change(runs, "roll")
    order = np.argsort(drift[short])
    follows = all(np.all(np.diff(each[short][order]) > -2e-3) for each in (sway, roll))
    words = (
        f"K11 {100 * sway[short].min():+.1f} to {100 * sway[short].max():+.1f} %, K33 {100 * roll[short].min():+.1f} "
        f"to {100 * roll[short].max():+.1f} % of that without drift, rising with F*"
    )
    return judged(bool(follows) and sway[short].min() > 0.0 and roll[short].min() > 0.0, words)


def _heave_stiffness(runs: NakamuraRuns) -> Finding:
    heave, sway = (float(np.abs(_stiffness_change(runs, mode)).max()) for mode in ("heave", "sway"))
    words = f"K22 changes by at most {100 * heave:.1f} %, K11 by {100 * sway:.1f} %"
    return judged(heave < 0.02 and heave < 0.3 * sway, words)


def _sway_in_time(runs: NakamuraRuns) -> Finding:
    ratio, drifted = (
        abscissae(runs.drifted_time, "time")["ratio"],
        values(runs.drifted_time, "time", "motion_ratio", "sway"),
    )
    plain = values(runs.damped_time, "time", "motion_ratio", "sway")
    change = (drifted / plain - 1.0)[ratio < 4.0]
    words = f"drift changes sway in time by {100 * change.min():+.1f} to {100 * change.max():+.1f} % for L/B < 4"
    return judged(change.max() > 0.0 and np.abs(change).max() < SMALL, words)


def _heave_unchanged(runs: NakamuraRuns) -> Finding:
    change = values(runs.drifted, "frequency", "motion_ratio", "heave") / values(
        runs.damped, "frequency", "motion_ratio", "heave"
    )
    _, moved, still = paired(runs, runs.drifted_time, "motion_ratio", "heave")
    words = (
        f"drift changes heave by at most {100 * np.abs(change - 1.0).max():.1f} %, the domains differ by at most "
        f"{100 * np.abs(moved / still - 1.0).max():.1f} %"
    )
    return judged(np.abs(change - 1.0).max() < 0.02 and np.abs(moved / still - 1.0).max() < 0.02, words)


def _roll_falls(runs: NakamuraRuns) -> Finding:
    ratio = abscissae(runs.drifted, "frequency")["ratio"]
    change = values(runs.drifted, "frequency", "motion_ratio", "roll") / values(
        runs.damped, "frequency", "motion_ratio", "roll"
    )
    around = change[(ratio > NEAR[0]) & (ratio < 4.0)] - 1.0
    words = f"drift changes roll by {100 * around.min():+.1f} to {100 * around.max():+.1f} % for L/B from 3 to 4"
    return judged(around.max() < 0.0, words)


def _roll_in_time(runs: NakamuraRuns) -> Finding:
    ratio, moved, still = paired(runs, runs.drifted_time, "motion_ratio", "roll")
    near = _near(ratio)
    shares, places = (", ".join(f"{value:.2f}" for value in each) for each in ((moved / still)[near], ratio[near]))
    words = f"roll in time over that of the frequency domain: {shares} at L/B = {places}"
    return judged(bool(np.all(moved[near] < still[near])), words)


def _roll_difference(runs: NakamuraRuns) -> Finding:
    ratio, moved, still = paired(runs, runs.drifted_time, "motion_ratio", "roll")
    near = _near(ratio)
    worst = float(np.abs(moved / still - 1.0)[near].max())
    found = values(runs.moving_time, "time", "motion_amplitude", "roll")
    led, tangent = (
        np.abs(found / values(runs.moving_time, "frequency", name, "roll") - 1.0)
        for name in ("motion_amplitude", "motion_amplitude_with_tangent")
    )
    longest = float(abscissae(runs.moving_time, "time")["period"][tangent.argmax()])
    statics = runs.drifted.tree[f"{LEVEL}/statics"].to_dataset()
    water, lines = (float(statics[name].values[2, 2]) for name in ("hydrostatic_stiffness", "mooring_stiffness"))
    words = (
        f"at most {100 * worst:.0f} % near resonance; restoring of the water {water:.1f} N m, of the chains "
        f"{lines:.2f} N m; over all periods, chains in motion, {100 * tangent.max():.0f} % at T = {longest:.3g} s with "
        f"their tangent in frequency and at most {100 * led.max():.1f} % with the first harmonic of their force: "
        "chains harden, of third order in the height"
    )
    return judged(worst < 0.2 and water > 5.0 * lines and led.max() < DOMAINS, words)


def _sway_heave_domains(runs: NakamuraRuns) -> Finding:
    worst, at_rest = 0.0, 0.0
    for mode in ("sway", "heave"):
        _, moved, still = paired(runs, runs.moving_time, "motion_ratio", mode)
        worst = max(worst, float(np.abs(moved / still - 1.0).max()))
        _, moved, still = paired(runs, runs.drifted_time, "motion_ratio", mode)
        at_rest = max(at_rest, float(np.abs(moved / still - 1.0).max()))
    words = (
        f"the domains differ by at most {100 * worst:.1f} % with chains in motion, by {100 * at_rest:.0f} % with "
        "chains at rest at every instant"
    )
    return judged(max(worst, at_rest) < DOMAINS, words, f"{JUMP}; the paper's own model was of chains at rest")


def _far_field(runs: NakamuraRuns, name: str) -> Finding:
    _, moved, still = paired(runs, runs.moving_time, name)
    other, at_rest, linear = paired(runs, runs.drifted_time, name)
    worst = float(np.abs(moved - still).max())
    usual = other < 6.5
    short = float(np.abs(at_rest - linear)[usual].max())
    long = float(np.abs(at_rest - linear).max())
    words = (
        f"the domains differ by at most {worst:.3f} with chains in motion; with chains at rest by {short:.3f} up to "
        f"L/B = {other[usual].max():.1f} and {long:.3f} beyond"
    )
    return judged(max(worst, long) < DOMAINS, words, JUMP)


def _transmission(runs: NakamuraRuns) -> Finding:
    return _far_field(runs, "transmission_coefficient")


def _reflection(runs: NakamuraRuns) -> Finding:
    return _far_field(runs, "reflection_coefficient")


def _measured_transmission(runs: NakamuraRuns) -> Finding:
    found = [at(runs.drifted, "frequency", "transmission_coefficient", place) for place in (3.0, 5.0, 7.0)]
    return measured(
        "C_T = " + ", ".join(f"{value:.2f}" for value in found) + " at L/B = 3, 5, 7 in the frequency domain"
    )


def _measured_reflection(runs: NakamuraRuns) -> Finding:
    found = [at(runs.drifted, "frequency", "reflection_coefficient", place) for place in (2.0, 3.0, 5.0)]
    return measured(
        "C_R = " + ", ".join(f"{value:.2f}" for value in found) + " at L/B = 2, 3, 5 in the frequency domain"
    )


def _measured_motion(runs: NakamuraRuns) -> Finding:
    _, moved, still = paired(runs, runs.drifted_time, "motion_ratio", "heave")
    return measured(f"heave of both domains within {100 * float(np.abs(moved / still - 1.0).max()):.1f} %")


def _roll_closer(runs: NakamuraRuns) -> Finding:
    top = peak(runs.drifted)
    in_time = values(runs.drifted_time, "time", "motion_ratio", "roll")
    ratio = abscissae(runs.drifted_time, "time")["ratio"]
    return measured(
        f"largest theta B/H near resonance {top[0]:.2f} in frequency, {float(in_time[_near(ratio)].max()):.2f} in time"
    )


def _damping_needed(runs: NakamuraRuns) -> Finding:
    # the largest motion, since without damping the motion may never repeat and has no first harmonic
    near = _near(abscissae(runs.undamped_time, "time")["ratio"])
    plain = values(runs.undamped_time, "time", "maximum_motion", "roll")[near]
    damped = values(runs.damped_time, "time", "maximum_motion", "roll")[near]
    change = float(np.abs(plain / damped - 1.0).max())
    words = (
        f"damping changes the largest roll in time by up to {100 * change:.0f} % near resonance, in frequency the "
        f"amplitude by a factor {peak(runs.undamped)[0] / peak(runs.damped)[0]:.0f}"
    )
    return judged(change > 0.2, words)


def _resonance_inside(runs: NakamuraRuns) -> Finding:
    place = peak(runs.damped)[1]
    stopped = abscissae(runs.drifted, "frequency")["ratio"][
        values(runs.drifted, "frequency", "transmission_coefficient") < 0.5
    ]
    words = f"C_T is below 0.5 for L/B from {stopped.min():.1f} to {stopped.max():.1f}; roll resounds at {place:.2f}"
    return judged(bool(stopped.min() < place < stopped.max()), words)


def _weight(runs: NakamuraRuns) -> Finding:
    statics = runs.drifted.tree[f"{LEVEL}/statics"].to_dataset()
    reach, height, length, _, _ = chain(runs)
    left = float(statics.displaced_mass) - float(statics.body_mass)
    pull = float(statics.line_vertical_pull) / runs.case.environment.water.gravity
    words = (
        f"displacement less weight {left:.2f} kg, pull of four chains {pull:.2f} kg; chord of a chain "
        f"{float(np.hypot(reach, height)):.3f} m under its {length:.3f} m"
    )
    return judged(
        abs(left - pull) < 0.1, words,
        f"{left - pull:.2f} kg remain ({float(statics.imbalance):.2f} % of the displacement); six to eight chains "
        "would close it, and the number is not printed",
    )  # fmt: skip


STATEMENTS = (
    Statement("table", "table 1", "Table 1 lists weight, draught and chains of the model.", _weight),
    Statement(
        "prototype",
        "table 1",
        "At prototype scale the centre of gravity lies 0.17 m below still water and the inertia is 4.41e7 t m2.",
        _prototype,
    ),
    Statement("drift-small", "2.3", "The mean drift force is small against the first-order force.", _drift_small),
    Statement(
        "steep", "4.1, figure 4", "The horizontal tension rises steeply and non-linearly with the offset.", _steep
    ),
    Statement("catenary", "4.1, figure 4", "Catenary theory nearly gives the measured tension.", _catenary),
    Statement("resonance", "4.2, figure 5", "Roll is resonant near L/B = 3.5.", _resonance),
    Statement(
        "overshoot", "4.2, figure 5", "Without further damping the computed roll overshoots near resonance.", _overshoot
    ),
    Statement("wave-damping", "4.2", "Wave damping governs sway and heave; roll needs more than that.", _waves_damp),
    Statement("fifteen", "4.2, figure 6", "15 % of critical damping fits the measured motions best.", _fifteen),
    Statement("squared", "2.3, 4.3", "The drift force goes with the square of the reflection coefficient.", _squared),
    Statement("drift", "4.3, figure 7", "The drift is large for L/B below 3.5 and falls beyond.", _short_waves_push),
    Statement("stiffness", "4.3, figure 8", "K11 and K33 grow with the drift for L/B below 3.5.", _stiffness_follows),
    Statement("heave-stiffness", "4.3, figure 8", "K22 hardly changes with drift.", _heave_stiffness),
    Statement(
        "sway-time",
        "4.3, figure 9",
        "With drift sway in time is a little larger for L/B below 4, not significantly.",
        _sway_in_time,
    ),
    Statement("heave", "4.3, figure 9", "Heave does not change with drift, and both domains agree.", _heave_unchanged),
    Statement("heave-measured", "4.3, figure 9", "Measured heave agrees with both domains.", _measured_motion),
    Statement("roll-drift", "4.3, figure 9", "In frequency roll with drift is smaller for L/B below 4.", _roll_falls),
    Statement("roll-time", "4.3, figure 9", "Near resonance roll in time is below that in frequency.", _roll_in_time),
    Statement(
        "roll-closer",
        "4.3, figure 9",
        "Roll in time is closer to the measured one than roll in frequency.",
        _roll_closer,
    ),
    Statement(
        "roll-difference",
        "4.3, figure 9",
        "That difference is not large, since the water's restoring of roll outweighs that of the chains.",
        _roll_difference,
    ),
    Statement(
        "sway-heave",
        "4.3, figure 9",
        "Sway and heave do not differ significantly between the domains.",
        _sway_heave_domains,
    ),
    Statement(
        "roll-nearer",
        "4.3, figure 9",
        "With drift roll comes nearer to the measured one for L/B below 4.",
        _roll_nearer,
    ),
    Statement("transmission", "4.4, figure 10", "C_T of the two domains hardly differs.", _transmission),
    Statement(
        "transmission-measured",
        "4.4, figure 10",
        "Measured C_T agrees for L/B below 4 and lies below beyond.",
        _measured_transmission,
    ),
    Statement("reflection", "4.4, figure 10", "C_R of the two domains hardly differs.", _reflection),
    Statement(
        "reflection-measured",
        "4.4, figure 10",
        "Measured C_R lies below for L/B below 4 and agrees beyond.",
        _measured_reflection,
    ),
    Statement(
        "combined",
        "4.4",
        "Operators of the frequency domain with motions of the time domain give transmission and reflection.",
        _combined,
    ),
    Statement("damping", "5 (1)", "Near the resonance of roll damping is needed in both domains.", _damping_needed),
    Statement("drift-matters", "5 (1)", "Drift changes the reaction of the mooring significantly.", _drift_matters),
    Statement("hardens", "5 (2)", "At the resonance of roll the mooring answers non-linearly.", _hardens),
    Statement(
        "range",
        "5 (2)",
        "The resonance of roll lies among the waves that the breakwater is to stop.",
        _resonance_inside,
    ),
)
