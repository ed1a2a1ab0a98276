"""Lines of a breakwater in motion: quasi-static limit, effect of drag and inertia, snap, what is refused."""

import math
import textwrap
from pathlib import Path

import numpy as np
import pytest

import moyai
from moyai.core.errors import CaseError
from moyai.flexible.mooring_line import bars_of
from moyai.flexible.motion import Motion
from moyai.flexible.sea_table import sea_of_lines
from moyai.flexible.simulation import simulate
from moyai.sea.components import WaveComponents
from moyai.sea.dispersion import wave_number
from moyai.sea.water import Water
from moyai.structures.breakwater.assembly import assemble
from moyai.structures.breakwater.case.build import build_problem
from moyai.structures.breakwater.lines.network import line_network
from moyai.structures.breakwater.settings import LineDynamics

CASE = """
moyai: 1
title: box on chains in motion
site: {{water_depth: 38 cm, density: 1000 kg/m3, gravity: 9.81 m/s2}}
waves: {{kind: regular, name: one, height: {height}, periods: [{period}], heading_deg: 0}}
structure:
  kind: breakwater
  length: 98.6 cm
  section: {{shape: rectangle, beam: 38 cm, height: 17 cm}}
  draught: 11.3 cm
  centre_of_gravity_above_keel: 8.6 cm
  roll_gyradius: 10.1 cm
  damping: {{fraction_of_critical: 0.15, modes: [sway, heave, roll]}}
lines:
  - name: seaward
    count: 2
    dynamic: {dynamic}
    fairlead: {{x: -19 cm, above_keel: 0 m}}
    anchor: {{x: -211.5 cm}}
    segments: [{segment}]
  - name: shoreward
    count: 2
    dynamic: {dynamic}
    fairlead: {{x: 19 cm, above_keel: 0 m}}
    anchor: {{x: 211.5 cm}}
    segments: [{segment}]
analyses: [frequency, time]
settings:
  drift: {drift}
  time: {{lines: {{bars: {bars}}}, analysed_periods: 3, duration: {duration}, ramp: {ramp}}}
"""
SEGMENT = (
    "{length: 197.5 cm, submerged_mass: 0.1144 kg/m, mass: 0.1315 kg/m, axial_stiffness: 2.14e4 N, diameter: 2.6 mm, "
    "drag_normal: 2.4, drag_tangential: 1.15, added_mass_normal: 1.0}"
)


def text(**changes):
    values = {
        "height": "4 cm", "period": 1.2, "dynamic": "true", "segment": SEGMENT, "bars": 20, "duration": "14 s",
        "ramp": "4 s", "drift": "true",
    }  # fmt: skip
    return textwrap.dedent(CASE).format(**{**values, **changes})


def problem_of(tmp_path, **changes):
    path = tmp_path / "case.yaml"
    path.write_text(text(**changes))
    return build_problem(moyai.load_case(path).model, Path(tmp_path))


@pytest.fixture(scope="module")
def unit(tmp_path_factory):
    problem = problem_of(tmp_path_factory.mktemp("case"))
    return assemble(problem, *problem.environment.water_levels[0])


@pytest.mark.slow
@pytest.mark.parametrize("seed", [*range(1), *(pytest.param(s, marks=pytest.mark.slow) for s in range(1, 3))])
def test_slow_motion_of_the_fairlead_gives_the_tension_of_the_catenary(unit, seed) -> None:
    """A slow circle of random size about rest: a thousandth of the exact line, two at the worst instant."""
    random = np.random.default_rng(seed)
    lines = line_network(unit, LineDynamics(bars=100))
    reach = random.uniform(0.005, 0.02, size=2)
    # a quarter of the way out and back within two minutes: far slower than any wave of the chain
    motion = Motion.harmonic(
        (reach[0], 0.0, reach[1]), 60.0, duration=60.0, ramp=30.0, phase=(0.0, 0.0, random.uniform(0, 6))
    )
    start = motion.at(0.0)[0]
    assert np.allclose(start, 0.0)
    history = simulate(
        lines.network, dict.fromkeys(lines.names, motion), duration=60.0, output_step=0.5, start=lines.rest.state
    )
    moved = motion.at(history.time)[0]
    exact = unit.mooring.planar.tensions(np.column_stack([moved[:, 0], moved[:, 2], 0.0 * history.time]))
    for column, name in zip(lines.index, lines.names, strict=True):
        found = lines.end_tensions(name, history.position, history.tension)[0]
        assert np.max(np.abs(found - exact[:, column]) / exact[:, column]) < 2e-3
        assert np.sqrt(np.mean((found / exact[:, column] - 1.0) ** 2)) < 1e-3
        assert abs(found.max() / exact[:, column].max() - 1.0) < 1e-3


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    path = tmp_path_factory.mktemp("run") / "case.yaml"
    path.write_text(text())
    return moyai.run(moyai.load_case(path))


@pytest.mark.slow
def test_run_tells_both_kinds_of_line_and_its_steps(run) -> None:
    assert run.status == "converged"
    sea = run.tree["/SWL/time/one"].to_dataset()
    series = run.tree["/SWL/time/one/T1p2"].to_dataset()
    still, moving = sea.line_tension_maximum_lines_at_rest.values[0], sea.line_tension_maximum.values[0]
    assert np.all(np.isfinite(still)) and np.all(moving > 0.0)
    # at 1.2 s inertia and drag of this light chain matter, and lower its peak
    assert np.all(np.abs(moving / still - 1.0) > 0.02)
    assert series.line_tension_peak_since_row.shape == series.tension.shape
    assert np.all(series.line_tension_peak_since_row.values >= series.tension.values - 1e-12)
    assert series.sizes["line_node"] == 21
    assert series.attrs["network_passes"] < 4.0
    assert np.all(sea.anchor_vertical_tension_maximum_lines_in_motion.values <= 1e-2 * moving)
    assert np.all(sea.least_grounded_length.values < 1.9)
    named = [check.name for check in run.checks]
    assert any("lines in motion at rest" in name for name in named)
    assert any("impulse between bodies and network" in name for name in named)


@pytest.mark.slow
def test_report_shows_lines_in_motion_next_to_lines_at_rest(run, tmp_path) -> None:
    written = moyai.write_report(run, tmp_path)
    page = next(path for path in tmp_path.rglob("*.html")).read_text()
    assert "Lines in motion and lines at rest" in page
    assert "Lines in motion compared with lines at rest" in page
    assert written is not None


@pytest.mark.slow
def test_long_waves_of_small_height_need_no_lines_in_motion(tmp_path) -> None:
    """Slow waves on a nearly massless fast chain: the planar body moves alike on both kinds of line."""
    path = tmp_path / "case.yaml"
    path.write_text(text(height="5 mm", period=6.0, duration="60 s", ramp="12 s", bars=30, drift="false"))
    result = moyai.run(moyai.load_case(path))
    series = result.tree["/SWL/time/one/T6"].to_dataset()
    moving, still = series.position.values, series.position_lines_at_rest.values
    size = np.ptp(still, axis=0)
    assert np.all(np.max(np.abs(moving - still), axis=0) < 0.01 * size.max())
    tension = np.abs(series.tension.values - series.tension_lines_at_rest.values).max(axis=0)
    assert np.all(tension < 0.015 * series.tension_lines_at_rest.values.mean(axis=0))


def test_bars_are_shared_by_length_and_clumps_ride_between_them(tmp_path) -> None:
    half = SEGMENT.replace("197.5 cm", "120 cm")
    rest = SEGMENT.replace("197.5 cm", "77.5 cm")
    clump = "{clump: {mass: 0.1 kg, volume: 1e-5 m3}}"
    problem = problem_of(tmp_path, segment=f"{half}, {clump}, {rest}")
    unit = assemble(problem, *problem.environment.water_levels[0])
    lines = line_network(unit, LineDynamics(bars=30))
    assert bars_of(problem.breakwater.lines[0], 30) == [18, 12]
    node = lines.network.points["seaward joint 1"]
    assert math.isclose(lines.network.nodes.mass[node], 0.1)
    exact = unit.mooring.planar.tensions(np.zeros(3))
    assert np.allclose(lines.tension_at_rest(), exact[list(lines.index)], rtol=5e-3)


@pytest.mark.parametrize("merged", [False, True])
def test_a_tabulated_sea_is_the_sea_summed_at_the_nodes(merged) -> None:
    """Random components at random places: the table meets direct sums at its times, and half way nearly.

    The many components of a long record, with headings and intrinsic frequencies of their own, are merged for a short
    window of it.
    """
    random = np.random.default_rng(4)
    water = Water(depth=12.0, density=1025.0, gravity=9.81)
    repeat = 6000.0 if merged else 120.0
    base = 2.0 * math.pi / repeat
    omega = np.arange(0.42, 2.1, base) // base * base
    assert (omega.size > 1500) == merged
    spread = merged * random.uniform(-1.0, 1.0, omega.size)
    waves = WaveComponents(
        omega, random.uniform(0.0, 0.1, omega.size) * math.sqrt(120.0 / repeat), random.uniform(0, 6.28, omega.size),
        0.4 + spread, wave_number(omega, 12.0, 9.81), water, frequency_step=base,
        intrinsic_omega=omega * (1.0 + 0.1 * spread),
    )  # fmt: skip
    nodes = np.column_stack([random.uniform(-40, 40, 5), random.uniform(-10, 10, 5), random.uniform(-12, -1, 5)])
    step = 120.0 / 1500
    flow = sea_of_lines(waves, None, 0.0, nodes, 60.0, step)
    from moyai.flexible.flow import Flow

    direct = Flow(waves=waves, stretching="constant")
    for time in (0.0, step * 100, step * 333):
        assert np.allclose(flow.at(time, nodes.T.copy()), direct.at(time, nodes.T.copy()), atol=2e-6)
    late = step * 200.5
    assert np.allclose(flow.at(late, nodes.T.copy()), direct.at(late, nodes.T.copy()), atol=3e-3)


@pytest.mark.parametrize(
    ("changes", "reported"),
    [
        ({"segment": SEGMENT.replace(", mass: 0.1315 kg/m", "")}, "lacks mass"),
        ({"segment": SEGMENT.replace("drag_normal: 2.4, ", "")}, "lacks drag_normal"),
        ({"segment": SEGMENT.replace("2.14e4 N", "inextensible")}, "cannot stretch"),
        ({"segment": SEGMENT.replace("0.1315 kg/m", "0.05 kg/m")}, "more in air than in water"),
        ({"bars": 2}, "bars"),
        ({"bars": 20.5}, "bars"),
        ({"dynamic": "perhaps"}, "dynamic"),
    ],
)
def test_impossible_lines_in_motion_get_one_clear_message(tmp_path, changes, reported) -> None:
    path = tmp_path / "case.yaml"
    path.write_text(text(**changes))
    with pytest.raises(CaseError) as caught:
        moyai.load_case(path)
    assert reported in str(caught.value)


@pytest.fixture(scope="module")
def snapping(tmp_path_factory):
    """Short chains in high waves: slack and taut once a wave, with the sensitivity of the peak."""
    path = tmp_path_factory.mktemp("snap") / "case.yaml"
    words = text(
        height="9 cm", period=1.4, segment=SEGMENT.replace("197.5 cm", "195.5 cm"), duration="12 s", drift="false"
    )
    path.write_text(words.replace("bars: 20", "bars: 20, sensitivity: true, snap_fraction: 2"))
    return moyai.run(moyai.load_case(path))


@pytest.mark.slow
def test_snaps_are_found_counted_and_judged(snapping, tmp_path) -> None:
    sea = snapping.tree["/SWL/time/one"].to_dataset()
    contacts = snapping.tree["/SWL/time/one/T1p4/contacts"].to_dataset()
    assert float(sea.slack_time.sum()) > 0.0
    assert float(sea.contact_count.sum()) > 2.0
    assert contacts.sizes["contact"] >= float(sea.contact_count.sum())
    assert np.all(contacts.rise_time.values >= 0.0)
    assert np.all(contacts.contact_peak.values > 0.0)
    for name in ("twice_the_bars", "half_the_step", "twice_the_damping"):
        change = sea[f"peak_change_{name}"].values
        assert np.all(np.isfinite(change)) and np.all(np.abs(change) < 0.5)
    assert np.all(np.abs(sea.peak_change_half_the_step.values) < 0.02)
    moyai.write_report(snapping, tmp_path)
    page = next(path for path in tmp_path.rglob("*.html")).read_text()
    assert "Twice the bars" in page and "Largest snap" in page


def test_lines_in_motion_that_do_not_fit_the_rest_of_the_case_are_named(tmp_path) -> None:
    path = tmp_path / "case.yaml"
    words = text()
    for changed, reported in (
        (words.replace("analysed_periods: 3", "memory: convolution"), "as states"),
        (words.replace("anchor: {x: 211.5 cm}", "anchor: {x: 211.5 cm}\n    bed_friction: 0.4"), "bed friction of 0.4"),
    ):
        assert changed != words
        path.write_text(changed)
        with pytest.raises(CaseError) as caught:
            moyai.load_case(path)
        assert reported in str(caught.value)


def test_lines_are_carried_along_to_where_a_run_starts(tmp_path):
    """The network at rest with its fairleads moved pulls as the exact catenaries of the moved body do."""
    unit = assemble(problem_of(tmp_path), "SWL", 0.0)
    lines = line_network(unit, LineDynamics(bars=60))
    move, centre = np.array([0.01, 0.005, 0.0]), np.array([unit.centre[0], 0.0, unit.centre[1]])
    places = {line.name: np.asarray(line.fairlead) + centre + np.array([move[0], 0.0, move[1]]) for line in lines.lines}
    state = lines.carried_along(places)
    exact = unit.mooring.planar.tensions(move)
    for number, line in enumerate(lines.lines):
        strand = lines.strand(line.name)
        assert state.position[strand.nodes[-1]] == pytest.approx(places[line.name])
        ends = state.position[strand.nodes[1:]] - state.position[strand.nodes[:-1]]
        length = np.linalg.norm(ends, axis=1)[-1]
        bars = lines.network.bars
        stretch = length / bars.length[strand.bars[-1]] - 1.0
        tension = bars.types[bars.kind[strand.bars[-1]]].axial_stiffness * stretch
        # the last bar tells its middle: half a bar of weight lower; the cutting into bars costs two per cent
        assert tension == pytest.approx(exact[number], rel=0.05)
        assert exact[number] != pytest.approx(unit.mooring.planar.tensions(np.zeros(3))[number], rel=0.1)
    assert np.all(state.velocity == 0.0)
