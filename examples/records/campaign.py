"""A synthetic field campaign, generated from stated laws and worked off to every statement of the field paper.

``python examples/records/campaign.py [folder] [every]``: three campaigns of 6, 5 and 6 days at 10 Hz (with ``every``
above 1 only every so many blocks), each with its page, then the planted constants next to what was found.
"""

import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from moyai.records.calibration import Parameter, calibrate
from moyai.records.reading.reader import blocks, read_chunks
from moyai.records.survey.campaign import CampaignLaws, write_campaign
from moyai.records.survey.case.build import load_survey
from moyai.records.survey.run import run_survey
from moyai.records.survey.tensions import split_tension, wave_maxima
from moyai.report.writer import write_report
from moyai.sea.dispersion import wave_number
from moyai.series.regressions import correlation, fit_by_direction, fit_line, type_ratio
from moyai.series.zero_crossing import find_waves
from moyai.structures.curtain.seas.anchor_energy import error_against_product

LEAST_HEIGHT = 0.5


def gather(results):
    """Return the figures of all blocks of all campaigns, lines averaged over the two anchors of a type."""
    columns = {}

    def add(name, values):
        columns.setdefault(name, []).append(np.asarray(values, dtype=float))

    for number, result in enumerate(results):
        tree = result.tree
        for name in ("third_height", "third_period", "maximum_height"):
            add(name, tree["waves"][name].values[:, 0])
        add("heading", tree["directions"]["mean_heading"].values)
        add("current", tree["current"]["current_normal"].values)
        add("campaign", np.full(tree["waves"].sizes["block"], number))
        lines = [str(line) for line in tree["tensions"]["line"].values]
        for key in ("steady", "maximum", "tenth"):
            table = tree["tensions"][key].values
            for group, members in (("conventional", ("F-1", "F-2")), ("new", ("J-1", "J-2")), ("wire", ("J-0",))):
                add(f"{group} {key}", np.mean([table[:, lines.index(line)] for line in members], axis=0))
    return {name: np.concatenate(parts) for name, parts in columns.items()}


def surface_speed(height, period, laws):
    """Return (pi H/T) coth kh [m/s]."""
    omega = 2.0 * math.pi / period
    kh = wave_number(omega, laws.water.depth, laws.water.gravity) * laws.water.depth
    return 0.5 * height * omega / np.tanh(kh)


def wave_pairs(survey, result, storm):
    """Return height, period, angle, current and the mean conventional tension of every wave of strong blocks."""
    tree = result.tree
    starts = tree["blocks"]["time"].values
    third = tree["waves"]["third_height"].values[:, 0]
    heading, current = tree["directions"]["mean_heading"].values, tree["current"]["current_normal"].values
    source = survey.loggers[0]
    wanted = [column for column in source.columns if column.name in ("elevation", "F-1", "F-2")]
    source = replace(source, columns=tuple(wanted))
    rows = []
    for block in blocks(read_chunks(source), float(starts[0]), survey.block_length):
        place = int(np.argmin(np.abs(starts - (starts[0] + block.index * survey.block_length))))
        if not third[place] > LEAST_HEIGHT:
            continue
        record = block.record
        waves = find_waves(record.time, record["elevation"], survey.wave_options)
        maxima = []
        for name in ("F-1", "F-2"):
            split = split_tension(record.time, record[name], "median")
            found = wave_maxima(record.time, split.fluctuating, waves.start, waves.period, delay=survey.tension_lag)
            maxima.append(found.maximum)
        angle = math.acos(min(abs(math.cos(heading[place])), 1.0))
        same = np.ones(len(waves))
        columns = (
            waves.height,
            waves.period,
            angle * same,
            current[place] * same,
            np.mean(maxima, axis=0),
            storm * same,
        )
        rows.append(np.column_stack(columns))
    return np.vstack(rows)


def fit_energy(pairs, laws):
    """Return the calibration of M m_B, the cosine's exponent and the slack speed from single waves on a taut rope."""
    height, period, angle, current, tension, storm = pairs.T
    rough = laws.orbital_factor * surface_speed(height, period, laws) * np.cos(angle) ** 2 + current
    chosen = (current > 0.02) & (rough > 0.8) & (angle < math.radians(65)) & np.isfinite(tension)
    # A few thousand waves are plenty; every k-th keeps all storms in
    chosen = np.flatnonzero(chosen)[:: max(int(np.count_nonzero(chosen)) // 6000, 1)]
    speed = laws.orbital_factor * surface_speed(height[chosen], period[chosen], laws)
    cosine, along = np.cos(angle[chosen]), current[chosen]

    def model(p):
        return np.sqrt(p[0] * laws.rope_stiffness) * np.maximum(speed * cosine ** p[1] + along - p[2], 0.0)

    return calibrate(
        model,
        tension[chosen],
        [
            Parameter("M m_B", 50.0, 1.0, 5000.0, "kg"),
            Parameter("exponent", 1.0, 0.0, 6.0),
            Parameter("slack speed", 0.1, 0.0, 1.0, "m/s"),
        ],
        error=150.0 + 0.15 * np.sqrt(60.0 * laws.rope_stiffness) * np.maximum(rough[chosen] - 0.3, 0.1),
        groups=[laws.storms[int(number)].name for number in storm[chosen]],
        bootstrap=40,
    )


def slack_ratio(pairs, fitted, laws):
    """Return the tension while the current slackens the rope over what the fit on a taut rope says."""
    height, period, angle, current, tension, _ = pairs.T
    product, exponent, slack = fitted.values
    speed = laws.orbital_factor * surface_speed(height, period, laws) * np.cos(angle) ** exponent + current - slack
    chosen = (current < -0.02) & (speed > 0.4) & np.isfinite(tension)
    return float(tension[chosen].sum() / (math.sqrt(product * laws.rope_stiffness) * speed[chosen].sum()))


def statements(data, pairs, laws):
    """Return what the processing says of every statement: name, found, its error, planted (or the paper's figure)."""
    angle = np.arccos(np.minimum(np.abs(np.cos(data["heading"])), 1.0))
    high = data["third_height"] > LEAST_HEIGHT
    tenth, third = data["conventional tenth"], data["third_height"]
    rows = []
    near = high & (angle < math.radians(60)) & (data["current"] > 0.02)
    line = fit_line(third[near], (tenth / np.cos(angle) ** 2)[near])
    rows.append(("1  T1/10 over cos^2 linear in H1/3: R^2", line.determination, math.nan, math.nan))
    steady = correlation(data["current"], data["new steady"])
    rows.append(("2  steady tension with U_x: r", steady.value, steady.error, 0.0))
    fitted = fit_energy(pairs, laws)
    rows.append(("3  exponent of the cosine", fitted.values[1], fitted.errors[1], laws.angle_exponent))
    law = laws.orbital_factor * surface_speed(1.8 * third * np.cos(angle) ** 2, data["third_period"], laws)
    squared = fit_line((law + data["current"])[high] ** 2, data["conventional maximum"][high], through_origin=True)
    rows.append(("4  Tmax in proportion to u2: R^2", squared.determination, math.nan, math.nan))
    _, types = type_ratio(data["conventional tenth"][high], data["new tenth"][high])
    rows.append(("5  new over conventional type", types.value, types.error, laws.type_ratio))
    rows.append(("6  M m_B [kg]", fitted.values[0], fitted.errors[0], laws.mass_product))
    rows.append(("6  slack speed [m/s]", fitted.values[2], fitted.errors[2], laws.slack_speed))
    _, wire = type_ratio(data["new tenth"][high], data["wire tenth"][high])
    rows.append(("7  wire over rope", wire.value, wire.error, laws.wire_ratio))
    heights = fit_line(third[high], data["maximum_height"][high], through_origin=True).parameters["slope"]
    rows.append(("8  Hmax over H1/3", heights.value, heights.error, 1.8))
    tops = fit_line(tenth[high], data["conventional maximum"][high], through_origin=True).parameters["slope"]
    rows.append(("8  Tmax over T1/10", tops.value, tops.error, 1.7))
    rows.append(("9  wave tension on a slack rope", slack_ratio(pairs, fitted, laws), math.nan, laws.slack_ratio))
    _, classes = fit_by_direction(third[high], tenth[high], angle[high], np.radians([0, 20, 40, 60, 80]))
    for entry in classes:
        if entry.departure is not None:
            name = f"10 {math.degrees(entry.low):.0f} to {math.degrees(entry.high):.0f} deg off the common line, share"
            rows.append((name, entry.departure.value, entry.departure.error, math.nan))
    above = np.mean(data["conventional steady"] > data["new steady"])
    rows.append(("11 share of blocks with the higher steady tension", float(above), math.nan, 1.0))
    return rows, fitted


def process(folder, every=1, seed=1, laws=None, report=True):
    """Generate and process the campaigns; return the figures of blocks and of waves, the results and the laws."""
    laws = laws or CampaignLaws()
    results, pairs = [], []
    for number, storm in enumerate(laws.storms):
        survey = load_survey(write_campaign(laws, storm, Path(folder), seed=seed + number, every=every))
        result = run_survey(survey)
        pairs.append(wave_pairs(survey, result, number))
        if report:
            write_report(result, Path(folder) / storm.name)
        results.append(result)
    return gather(results), np.vstack(pairs), results, laws


def main():
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path("out") / "campaign"
    every = int(sys.argv[2]) if len(sys.argv) > 2 else 1
    data, pairs, results, laws = process(folder, every)
    for result, storm in zip(results, laws.storms, strict=True):
        peak = float(np.nanmax(result.tree["waves"]["third_height"].values))
        print(f"{storm.name}: {result.message}; largest H1/3 {peak:.2f} m (law {storm.peak_height:.2f} m)")
    rows, fitted = statements(data, pairs, laws)
    for name, found, error, planted in rows:
        reported = f" +- {error:.3f}" if math.isfinite(error) else ""
        print(
            f"  {name}: {found:.3f}{reported}" + (f" (planted or stated {planted:g})" if math.isfinite(planted) else "")
        )
    for left in fitted.left_out:
        found = ", ".join(f"{value:.3g}" for value in left.values)
        print(
            f"    without {left.group}: {found}; rms of its prediction {left.rms / 1000:.2f} kN of {left.count} waves"
        )
    print("  error (calc - obs)/calc against M m_B: mean, root mean square")
    height, period, angle, current, tension, _ = pairs.T
    speed = laws.orbital_factor * surface_speed(height, period, laws) * np.cos(angle) ** 2 + current - laws.slack_speed
    chosen = (current > 0.02) & (speed > 0.4) & (angle < math.radians(65)) & np.isfinite(tension)
    products = laws.mass_product * np.array([0.5, 0.8, 0.9, 1.0, 1.1, 1.25, 2.0])
    mean, spread = error_against_product(tension[chosen], speed[chosen], products * laws.rope_stiffness)
    for product, one, two in zip(products, mean, spread, strict=True):
        print(f"    {product:.1f} kg: {one:+.3f}, {two:.3f}")


if __name__ == "__main__":
    main()
