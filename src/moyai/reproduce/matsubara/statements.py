"""The statements of the paper, each judged from the runs."""

from __future__ import annotations

import math

import numpy as np

from moyai.morison.net_law_names import Net, net_law
from moyai.morison.net_laws.matsubara import Matsubara
from moyai.reproduce.matsubara.runs import (
    DENSITY,
    DEPTH,
    GRAM,
    GRAVITY,
    NETS,
    OFFSHORE,
    SHORE,
    SLACK_PERIOD,
    TAUT_PERIOD,
    VISCOSITY,
    CageWave,
    MatsubaraRuns,
    net_in_wave,
)
from moyai.reproduce.model import Finding, Statement, judged, measured
from moyai.sea.dispersion import wave_number
from moyai.tables.nets import matsubara_net


def _taut(runs: MatsubaraRuns) -> CageWave:
    return runs.at(runs.taut, TAUT_PERIOD)


def _slack(runs: MatsubaraRuns) -> CageWave:
    return runs.at(runs.slack, SLACK_PERIOD)


def _table(_runs: MatsubaraRuns) -> Finding:
    panel = {name: 1e4 * matsubara_net(name).projected_area / matsubara_net(name).solidity for name in NETS}
    usual = float(np.median(list(panel.values())))
    odd = {name: area for name, area in panel.items() if abs(area / usual - 1.0) > 0.1}
    words = f"area over solidity is the panel, {usual:.0f} cm2 in the middle; apart: " + ", ".join(
        f"{name} {area:.0f}" for name, area in odd.items()
    )
    return judged(not odd, words, "the area of net J, 675.8 cm2, is a misprint; near 455 would fit")


def _weight(runs: MatsubaraRuns) -> Finding:
    cage = runs.case.cage
    floats = 1e3 * (cage.mass - cage.mass_without_floats)
    words = f"twelve floats weigh {floats:.1f} g, the cage without them {1e3 * cage.mass_without_floats:.1f} g"
    return judged(
        abs(1e3 * cage.mass - 72.5) < 1.0, words, "72.5 gf are the floats; table 2 has 291.05 gf for the cage",
    )  # fmt: skip


def _sizes(runs: MatsubaraRuns) -> Finding:
    side, opening = runs.case.cage.extent[0], matsubara_net("F").aperture
    words = (
        f"three floats of 4 cm are on a side of {100 * side:g} cm; net F of table 1, of the same twine, has openings "
        f"of {1e3 * opening:g} mm"
    )
    return judged(False, words, "the units are exchanged: the side is 20 cm, the opening 2.09 mm as in table 2")


def _floats(runs: MatsubaraRuns) -> Finding:
    diameter, count = 0.0401, 12
    lift = count * math.pi / 6.0 * diameter**3 * DENSITY
    weight = runs.case.cage.mass
    words = f"twelve spheres displace {1e3 * lift:.0f} g, the cage with its floats weighs {1e3 * weight:.0f} g in air"
    return judged(abs(1e3 * lift / 402.0 - 1.0) < 0.02, words)


def _lift(_runs: MatsubaraRuns) -> Finding:
    row = matsubara_net("G")
    net = Net.from_aperture(row.twine_diameter, row.aperture, solidity_listed=row.solidity)
    drag, lift = (float(item[0]) for item in net_law("matsubara").coefficients(np.zeros(1), 0.5, net, VISCOSITY))
    return judged(
        abs(lift) < 0.01 * drag, f"lift {abs(lift):.0e}, drag {drag:.2f} on the outline, perpendicular to the flow"
    )


def _falls(_runs: MatsubaraRuns) -> Finding:
    law = Matsubara()
    first, last = (float(law.twine_drag(number)) for number in (84.0, 1800.0))
    words = f"C_d = {first:.2f} at Re = 84, {last:.2f} at 1800, the largest that was towed"
    return judged(abs(first - 2.0) < 0.05 and 0.55 < last < 0.7, words)


def _scatter(_runs: MatsubaraRuns) -> Finding:
    row = matsubara_net("G")
    speed = 100.0 * VISCOSITY / row.twine_diameter
    force = 0.5 * DENSITY * row.projected_area * float(Matsubara().twine_drag(100.0)) * speed**2
    return measured(f"the force on net G is {1e3 * force:.0f} mN at Re = 100")


def _parameters(_runs: MatsubaraRuns) -> Finding:
    solidity = [matsubara_net(name).solidity for name in NETS]
    diameter = [1e3 * matsubara_net(name).twine_diameter for name in NETS]
    words = (
        f"ten nets, solidity {min(solidity):.2f} to {max(solidity):.2f}, twines {min(diameter):g} to "
        f"{max(diameter):g} mm, "
        f"correlated by {np.corrcoef(solidity, diameter)[0, 1]:.2f}"
    )
    return measured(words, "forces of the single nets are not printed; moyai measure nets fits A and B over both")


def _in_phase(_runs: MatsubaraRuns) -> Finding:
    _, _, drag, inertia = net_in_wave("F", 0.065, 1.3)
    share = float(np.abs(inertia).max() / np.abs(drag).max())
    lead = math.degrees(math.atan(share))
    words = (
        f"inertia is {100 * share:.0f} % of drag on net F at H = 6.5 cm, T = 1.3 s: the force leads the velocity by "
        f"about {lead:.0f} degrees"
    )
    return judged(share < 0.3, words)


def _numbers_apart(_runs: MatsubaraRuns) -> Finding:
    return measured("the law of the paper has no KC number in it", "coefficients in waves are not printed")


def _force_in_waves(_runs: MatsubaraRuns) -> Finding:
    _, _, drag, inertia = net_in_wave("F", 0.065, 1.3)
    return measured(f"{np.abs(drag + inertia).max():.2f} N on net F at H = 6.5 cm, T = 1.3 s")


def _phases(runs: MatsubaraRuns) -> Finding:
    taut, slack = _taut(runs), _slack(runs)
    return measured(
        f"sway follows heave by {math.degrees(taut.phase):.0f} degrees taut, {math.degrees(slack.phase):.0f} slack"
    )


def _ranges(runs: MatsubaraRuns) -> Finding:
    wave = _taut(runs)
    return measured(f"computed sway {wave.ratio('sway'):.2f} H, heave {wave.ratio('heave'):.2f} H")


def _tensions(runs: MatsubaraRuns) -> Finding:
    slack, taut = (max(wave.peak.values()) / GRAM for wave in (_slack(runs), _taut(runs)))
    return measured(f"largest tension {slack:.0f} gf slack, {taut:.0f} gf taut")


def _quarter(runs: MatsubaraRuns) -> Finding:
    wave = _taut(runs)
    words = f"sway {wave.ratio('sway'):.2f} H, heave {wave.ratio('heave'):.2f} H at T = {wave.period:g} s"
    return judged(all(0.15 <= wave.ratio(mode) <= 0.4 for mode in ("sway", "heave")), words)


def _circle(runs: MatsubaraRuns) -> Finding:
    wave = _taut(runs)
    words = f"sway follows heave by {math.degrees(wave.phase):.0f} degrees, a circle needs 90"
    return judged(
        abs(abs(math.degrees(wave.phase)) - 90.0) < 30.0, words,
        "two lines that hardly stretch leave the cage one path, on which sway, heave and rotation go together",
    )  # fmt: skip


def _higher(runs: MatsubaraRuns) -> Finding:
    ratio = [wave.ratio("heave") for wave in runs.higher]
    words = (
        f"heave {ratio[0]:.2f} to {ratio[-1]:.2f} H for H = {100 * runs.higher[0].height:g} to "
        f"{100 * runs.higher[-1].height:g} cm"
    )
    return judged(
        ratio[-1] < ratio[0], words,
        "with the same pull the lines go slack in the troughs of higher waves and hold less; a pull that grows "
        "with the wave "
        "is needed for the reverse, and none is printed",
    )  # fmt: skip


def _as_high(runs: MatsubaraRuns) -> Finding:
    wave = _slack(runs)
    words = f"sway {wave.ratio('sway'):.2f} H, heave {wave.ratio('heave'):.2f} H at T = {wave.period:g} s"
    return judged(all(0.8 <= wave.ratio(mode) <= 1.3 for mode in ("sway", "heave")), words)


def _thirty(runs: MatsubaraRuns) -> Finding:
    wave = _slack(runs)
    number = float(wave_number(2.0 * math.pi / wave.period, DEPTH, GRAVITY))
    return measured(
        f"computed sway {wave.ratio('sway'):.2f} H, heave {wave.ratio('heave'):.2f} H; the orbit of the water is "
        f"{1.0 / math.tanh(number * DEPTH):.2f} H wide",
        "the text says 30 %, the conclusions 50 %; the measured points are not published as numbers",
    )


def _six(runs: MatsubaraRuns) -> Finding:
    wave = _taut(runs)
    return judged(4.5 <= wave.turn <= 7.0, f"{wave.turn:.1f} degrees to either side at T = {wave.period:g} s")


def _two(runs: MatsubaraRuns) -> Finding:
    wave = min(runs.slack, key=lambda one: abs(one.turn - 2.0))
    turns, periods = (", ".join(each) for each in zip(*((f"{one.turn:.1f}", f"{one.period:g}") for one in runs.slack)))
    return judged(abs(wave.turn - 2.0) < 0.5, f"{turns} degrees to either side at T = {periods} s")


def _third(runs: MatsubaraRuns) -> Finding:
    pairs = [(one.period, one.turn / runs.at(runs.slack, one.period).turn) for one in runs.taut
             if abs(runs.at(runs.slack, one.period).period - one.period) < 1e-9]  # fmt: skip
    ratios, periods = (", ".join(each) for each in zip(*((f"{ratio:.1f}", f"{period:g}") for period, ratio in pairs)))
    words = f"taut over slack {ratios} at T = {periods} s"
    return judged(
        max(ratio for _, ratio in pairs) > 2.5, words,
        "slack rotation falls with the period; the paper's two records may be of different waves, whose periods "
        "are not "
        "printed",
    )  # fmt: skip


def _eighty(runs: MatsubaraRuns) -> Finding:
    return measured(f"computed {_taut(runs).turn:.1f} degrees taut, {_slack(runs).turn:.1f} slack")


def _shore(runs: MatsubaraRuns) -> Finding:
    wave = _taut(runs)
    swing = {side: float(np.ptp(wave.tension[side])) / GRAM for side in (SHORE, OFFSHORE)}
    words = f"tension swings by {swing[SHORE]:.0f} gf on the shore side, {swing[OFFSHORE]:.0f} gf offshore"
    return judged(swing[SHORE] > 1.5 * swing[OFFSHORE], words)


def _forty(runs: MatsubaraRuns) -> Finding:
    wave = _taut(runs)
    return measured(
        f"largest tension {wave.peak[OFFSHORE] / GRAM:.0f} gf offshore, {wave.peak[SHORE] / GRAM:.0f} gf on the "
        f"shore side",
        "the peak goes with the root of the stiffness of line and gauge, which is not printed: see what the "
        "paper leaves out",
    )


def _small(runs: MatsubaraRuns) -> Finding:
    slack, taut = _slack(runs), _taut(runs)
    most = max(slack.peak.values()) / GRAM
    words = f"largest tension slack {most:.1f} gf, taut {max(taut.peak.values()) / GRAM:.0f} gf"
    return judged(
        most < 0.2 * max(taut.peak.values()) / GRAM,
        words,
        "the waves carry the slack cage until the offshore line comes taut for an instant of each wave; the "
        "slack that was "
        "filled in, 4 cm, decides how hard, and none is printed",
    )


STATEMENTS = (
    Statement("table", "2.1, table 1", "Table 1 lists twine, aperture, area and solidity of ten nets.", _table),
    Statement("sizes", "3.1, table 2", "The cage measures 20 mm (table 2) and has meshes of 2.1 cm (text).", _sizes),
    Statement("floats", "3.1, table 2", "Twelve floats of 4 cm carry 402 gf.", _floats),
    Statement("lift", "2.2", "A net perpendicular to the flow has hardly any lift.", _lift),
    Statement("falls", "2.4, figure 4", "C_d falls with the Reynolds number from about 2 to about 0.6.", _falls),
    Statement(
        "scatter", "2.4, figures 3, 4", "Below Re = 100 the coefficients scatter, since the forces are small.", _scatter
    ),
    Statement("parameters", "2.4", "How the law depends on solidity and twine could not be found.", _parameters),
    Statement("numbers", "2.4", "The drag coefficient shows no clear relation to the KC number.", _numbers_apart),
    Statement("force", "2.4, 4 (2), figure 5", "Equation (2) gives the measured force in waves.", _force_in_waves),
    Statement("phase", "2.4, figure 5", "In waves the force is in phase with the velocity: drag governs.", _in_phase),
    Statement("weight", "3.1", "The cage weighs 72.5 gf.", _weight),
    Statement("quarter", "3.2, figure 9", "Taut, sway and heave are about a quarter of the wave height.", _quarter),
    Statement(
        "ranges", "3.2, figure 9", "Taut, computed and measured motions agree in their largest and least.", _ranges
    ),
    Statement("phases", "3.2, figures 9 to 12", "Computed and measured motions and rotations agree in phase.", _phases),
    Statement("circle", "3.2, figure 9", "Taut, the path is nearly a circle.", _circle),
    Statement("higher", "3.2", "Taut, heave is held more as the waves grow higher.", _higher),
    Statement("as-high", "3.2, figure 10", "Slack, sway and heave are about the wave height.", _as_high),
    Statement("thirty", "3.2, figure 10", "Slack, measured motions are 30 % larger than computed.", _thirty),
    Statement("six", "3.2, figure 11", "Taut, the cage turns by about 6 degrees to either side.", _six),
    Statement("two", "3.2, figure 12", "Slack, it turns by about 2 degrees.", _two),
    Statement("third", "3.2, figures 11, 12", "Slack rotation is about a third of taut rotation.", _third),
    Statement("eighty", "3.2, figures 11, 12", "Computed rotation is about 80 % of the measured one.", _eighty),
    Statement("shore", "3.2, figure 13", "Taut, the tension on the shore side varies more than that offshore.", _shore),
    Statement("forty", "3.2, figure 13", "Taut, the measured peak offshore is 40 % above the computed one.", _forty),
    Statement(
        "tensions", "3.2, 4 (4), figure 13", "Computed tensions are the measured ones slack, and not taut.", _tensions
    ),
    Statement("small", "3.2, figure 13", "Slack, tensions are alike and small.", _small),
)
