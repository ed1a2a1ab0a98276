"""Networks as structures: assembly from parts, gathered twines, runs, interruption and going on, failures."""

import math
from dataclasses import replace

import numpy as np
import pytest

from moyai.case.builder import build
from moyai.case.reader import load_case
from moyai.core.errors import CaseError, InputError
from moyai.core.results import read_result
from moyai.flexible.elements import BarType
from moyai.flexible.statics import solve_equilibrium
from moyai.sea import nonlinear_wave
from moyai.structures.network.assembly import assemble, mesh_bars
from moyai.structures.network.resume import last_good_state
from moyai.structures.network.run import run
from moyai.structures.network.runs import run_plans, theory_limit

SITE = "moyai: 1\ntitle: Test\nsite: {water_depth: 30 m, density: 1025 kg/m3, gravity: 9.81 m/s2}\n"
ROPE = (
    "{diameter: 40 mm, mass: 9 kg/m, axial_stiffness: 20 MN, viscosity: 20 kN s, drag_normal: 1.2, "
    "drag_tangential: 0.06, added_mass_normal: 1}"
)


def problem_of(text, folder):
    path = folder / "case.yaml"
    path.write_text(text, encoding="utf-8")
    return build(load_case(path))


def line_case(**changes):
    values = {"length": "46 m", "segments": 12, "analyses": "[statics]", "settings": "{}", "more": "", "position": ""}
    values |= changes
    return (
        SITE
        + f"""{values["more"]}
structure:
  kind: network
  line_types: {{rope: {ROPE}}}
  motions: {{surge: {{kind: harmonic, amplitude: [1 m, 0, 0], period: 4 s, ramp: 4 s}}}}
  points:
    anchor: {{kind: fixed, position: [0, 0, -12 m]}}
    fairlead: {{kind: driven, position: [43.9425 m, 0, -2 m], motion: surge{values["position"]}}}
  lines:
    rope: {{start: anchor, end: fairlead, type: rope, length: {values["length"]}, segments: {values["segments"]}}}
analyses: {values["analyses"]}
settings: {values["settings"]}
"""
    )


def test_gathered_twines_keep_what_a_strip_of_netting_has():
    rng = np.random.default_rng(3)
    for _ in range(20):
        diameter, pitch, spacing = rng.uniform(1e-3, 5e-3), rng.uniform(0.01, 0.05), rng.uniform(0.2, 1.5)
        twine = BarType("twine", rng.uniform(1e-3, 0.05), rng.uniform(1e2, 1e4), diameter, viscosity=rng.uniform(0, 5))
        bar, edge = mesh_bars(twine, pitch, spacing, "net")
        count = spacing / pitch
        for key in ("mass_per_length", "axial_stiffness", "diameter", "volume_per_length", "viscosity"):
            assert getattr(bar, key) == pytest.approx(count * getattr(twine, key), rel=1e-12)
            assert getattr(edge, key) == pytest.approx(0.5 * getattr(bar, key), rel=1e-12)
        assert bar.wave_speed == pytest.approx(twine.wave_speed, rel=1e-12)


@pytest.mark.parametrize("ratio", [1.0, 0.8])
def test_a_net_keeps_the_area_and_mass_of_its_netting(tmp_path, ratio):
    text = (
        SITE
        + f"""
structure:
  kind: network
  nets:
    net:
      corners: [[0, 0, -1], [0, 6, -1], [0, 6, -5], [0, 0, -5]]
      rows: 9
      columns: 13
      hanging_ratio: {ratio}
      twine: {{diameter: 3 mm, mesh_pitch: 40 mm, density: 1140 kg/m3, modulus: 1 GPa, damping_ratio: 0.1,
               drag_normal: 1.2, drag_tangential: 0.02}}
      first_row: fixed
analyses: [statics]
"""
    )
    network = assemble(problem_of(text, tmp_path), 0.0).network
    area = float(np.sum(network.bars.length * network.bars.of_type("diameter")))
    # twine length per stretched area: two families at the pitch
    wide, high = 6.0 / ratio, 4.0 / ratio
    assert area == pytest.approx(2.0 * wide * high / 0.04 * 0.003, rel=1e-9)
    mass = 2.0 * wide * high / 0.04 * 1140.0 * math.pi / 4.0 * 0.003**2
    assert float(network.node_mass.sum()) == pytest.approx(mass, rel=1e-9)


def test_a_line_of_parts_starts_where_it_comes_to_rest(tmp_path):
    text = (
        SITE
        + f"""
structure:
  kind: network
  bed: {{stiffness: 3e5, damping: 3e4, friction: 0}}
  line_types: {{rope: {ROPE}, heavy: {{diameter: 60 mm, mass: 60 kg/m, axial_stiffness: 100 MN, damping_ratio: 0.5,
               drag_normal: 1.2, drag_tangential: 0.1, added_mass_normal: 1}}}}
  points:
    anchor: {{kind: fixed, position: [0, 0, bed]}}
    top: {{kind: driven, position: [60 m, 10 m, 0]}}
  lines:
    line:
      start: anchor
      end: top
      parts:
        - {{type: heavy, length: 35 m, segments: 14}}
        - clump: {{mass: 400 kg, volume: 0.05 m3}}
        - {{type: rope, length: 38 m, segments: 16}}
analyses: [statics]
"""
    )
    assembly = assemble(problem_of(text, tmp_path), 0.0)
    network = assembly.network
    rest = solve_equilibrium(network)
    moved = np.linalg.norm(rest.state.position - network.nodes.position, axis=1).max()
    assert moved < 0.25  # bars instead of a smooth curve, and a soft bed
    assert assembly.lines["line"].bars.size == 30
    joint = network.points["line joint 1"]
    assert network.nodes.mass[joint] == 400.0


def test_rows_of_floats_keep_their_sum_and_stand_evenly(tmp_path):
    more = line_case().replace("segments: 12}", "segments: 23, along: [{count: 5, mass: 3 kg, volume: 0.02 m3}]}")
    network = assemble(problem_of(more, tmp_path), 0.0).network
    carrying = np.flatnonzero(network.nodes.mass > 0.0)
    assert network.nodes.mass.sum() == pytest.approx(15.0)
    assert carrying.size == 5
    assert np.ptp(np.diff(carrying)) <= 1


def test_water_levels_move_what_floats_and_leave_what_stands(tmp_path):
    text = line_case(position=", z_from: still_water").replace(
        "gravity: 9.81 m/s2}", "gravity: 9.81 m/s2, water_levels: {high: 2 m, low: -1 m}}"
    )
    problem = problem_of(text, tmp_path)
    for level in (2.0, -1.0):
        network = assemble(problem, level).network
        assert network.nodes.position[network.points["anchor"], 2] == pytest.approx(-12.0 - level)
        assert network.nodes.position[network.points["fairlead"], 2] == pytest.approx(-2.0)
        assert network.water.depth == pytest.approx(30.0 + level)


def test_stiffness_at_a_driven_point_is_the_slope_of_its_pull(tmp_path):
    result = run(problem_of(line_case(), tmp_path))
    assert result.status == "converged"
    stiffness = result.tree["SWL/statics"]["stiffness"].values[0]
    assert np.allclose(stiffness, stiffness.T, rtol=1e-3, atol=1e-3 * np.abs(stiffness).max())
    pull = {}
    for shift in (-0.02, 0.02):
        text = line_case().replace("43.9425 m", f"{43.9425 + shift} m")
        load = run(problem_of(text, tmp_path)).tree["SWL/statics"]["point_load"]
        pull[shift] = load.sel(point="fairlead").values[0]
    slope = -(pull[0.02] - pull[-0.02]) / 0.04
    assert np.allclose(slope, stiffness[:, 0], rtol=0.02, atol=0.01 * abs(stiffness[0, 0]))


@pytest.mark.slow
def test_modes_of_a_taut_weightless_line_are_those_of_a_string(tmp_path):
    # as heavy as the water that it displaces: no weight at any gravity
    string = (
        f"{{diameter: 50 mm, mass: 2 kg/m, volume: {2.0 / 1025.0} m3/m, axial_stiffness: 1 MN, viscosity: 0, "
        "drag_normal: 0, drag_tangential: 0, added_mass_normal: 0}"
    )
    text = line_case(length="45 m", segments=40, analyses="[statics, modes]").replace(ROPE, string)
    text = text.replace("[43.9425 m, 0, -2 m]", "[45.9 m, 0, -12 m]")
    result = run(problem_of(text, tmp_path))
    tension = 1e6 * (45.9 / 45.0 - 1.0)
    # the mass of the stretched metre
    first = 2.0 * 45.9 / math.sqrt(tension / (2.0 * 45.0 / 45.9))
    assert result.tree["SWL/modes"]["mode_period"].values[0] == pytest.approx(first, rel=1e-3)
    # lumps of four bars: 2 sin(pi/8) in place of pi/4, 2.6 % too long; the band of the first page holds the string's
    coarse = run(problem_of(text.replace("segments: 40", "segments: 4"), tmp_path))
    (found,) = [item for item in coarse.headlines if item.name == "natural_period"]
    assert found.value == pytest.approx(first * (math.pi / 4) / (2.0 * math.sin(math.pi / 8)), rel=2e-3)
    assert found.band.low <= first <= found.band.high == found.value


DYNAMIC = {"analyses": "[dynamic]", "settings": "{duration: 12 s, output_step: 20 ms, skip: 4 s}"}


@pytest.mark.slow
def test_an_interrupted_run_goes_on_from_its_last_state(tmp_path):
    problem = problem_of(line_case(**DYNAMIC), tmp_path)
    whole = run(problem)

    def stop(what, done, total):
        if what == "still water" and done > 6.0:
            raise KeyboardInterrupt

    part = run(problem, stop)
    assert part.status == "interrupted"
    assert "'resume' continues" in part.message
    reached = part.tree["SWL/time/still water"]["time"].values[-1]
    assert 5.0 < reached < 12.0
    part.write(tmp_path / "results.nc")
    rest = run(replace(problem, settings=replace(problem.settings, resume=tmp_path / "results.nc")))
    assert rest.status == "converged"
    one, two = (r.tree["SWL/time/still water"].to_dataset() for r in (whole, rest))
    assert np.allclose(one["time"].values, two["time"].values, atol=1e-9)
    peak = float(one["end_tension"].max())
    apart = np.abs(one["end_tension"].values - two["end_tension"].values)[:, 0]
    # central differences begin anew from a place and a speed: a slack rope feels it, and forgets it
    assert apart.max() < 0.02 * peak
    assert apart[-150:].max() < 1e-3 * peak
    assert float(two["line_tension_peak_since_row"].max()) == pytest.approx(
        float(one["line_tension_peak_since_row"].max()), rel=1e-6
    )
    with pytest.raises(InputError, match="complete"):
        rest.write(tmp_path / "done.nc")
        run(replace(problem, settings=replace(problem.settings, resume=tmp_path / "done.nc")))
    with pytest.raises(InputError, match="no such file"):
        run(replace(problem, settings=replace(problem.settings, resume=tmp_path / "absent.nc")))


def test_a_run_that_blows_up_says_so_and_keeps_its_last_good_state(tmp_path):
    settings = "{duration: 12 s, output_step: 20 ms, step: 20 ms}"
    problem = problem_of(line_case(analyses="[dynamic]", settings=settings), tmp_path)
    result = run(problem)
    assert result.status == "not_converged"
    assert "t = " in result.message
    assert "node" in result.message
    result.write(tmp_path / "results.nc")
    frames = read_result(tmp_path / "results.nc").tree["SWL/time/still water/frames"]
    assert np.isfinite(frames["final_position"].values).all()
    # what came after the last good state is no peak: the rope bears 41 kN in this motion when its step is stable
    summary = result.tree["SWL/dynamic"].to_dataset(inherit=False)
    assert float(summary["line_tension_maximum"].max()) < 1e5
    assert float(summary["point_load_maximum"].max()) < 1e5


def test_nothing_to_rest_on_is_reported_and_nothing_is_run(tmp_path):
    text = (
        SITE
        + f"""
structure:
  kind: network
  line_types: {{rope: {ROPE}}}
  points:
    a: {{kind: free, position: [0, 0, -5], mass: 10 kg}}
    b: {{kind: free, position: [10, 0, -5], mass: 10 kg}}
  lines: {{rope: {{start: a, end: b, type: rope, length: 12 m, segments: 4}}}}
analyses: [statics, dynamic]
settings: {{duration: 5 s}}
"""
    )
    result = run(problem_of(text, tmp_path))
    assert result.status == "not_converged"
    assert "at rest in still water" in result.message
    assert "the start 'as_built'" in result.message


def test_runs_follow_seas_periods_and_currents(tmp_path):
    more = (
        "waves:\n  - {kind: regular, name: swell, height: 1 m, periods: [6, 9], heading_deg: 30, theory: linear}\n"
        "  - {kind: jonswap, name: storm, significant_height: 1 m, peak_period: 5 s, peak_enhancement: 3.3, "
        "heading_deg: 0, duration: 60 s, seed: 2}\ncurrent: {speed: 0.5 m/s, heading_deg: 30}\n"
    )
    problem = problem_of(line_case(more=more, analyses="[dynamic]"), tmp_path)
    plans = run_plans(problem, problem.environment.water_at(0.0))
    assert [plan.name for plan in plans] == ["swell 6 s", "swell 9 s", "storm"]
    assert [plan.duration for plan in plans] == [120.0, 180.0, 60.0]
    for plan, period in zip(plans[:2], (6.0, 9.0), strict=True):
        omega, number = 2.0 * math.pi / period, plan.waves.wave_number[0]
        intrinsic = omega - number * 0.5
        assert plan.waves.intrinsic_omega[0] == pytest.approx(intrinsic)
        assert intrinsic**2 == pytest.approx(9.81 * number * math.tanh(30.0 * number), rel=1e-9)
        velocity = plan.flow.at(1e4, np.array([[0.0], [0.0], [-31.0]]))[:3, 0]
        assert np.isfinite(velocity).all()  # a node that sank into the bed still knows its current


STEEP = "waves: {{kind: regular, name: swell, height: 2 m, period: 9 s, heading_deg: 0{}}}\n"


@pytest.mark.parametrize(
    ("asked", "theory", "severity"), [("", "stream function", ""), (", theory: linear", "linear waves", "error")]
)
def test_steep_waves_are_run_in_the_stream_function_unless_the_case_says_linear(tmp_path, asked, theory, severity):
    text = line_case(more=STEEP.format(asked), analyses="[dynamic]").replace("water_depth: 30 m", "water_depth: 9 m")
    problem = problem_of(text.replace("-12 m", "-8 m"), tmp_path)
    water = problem.environment.water_at(0.0)
    assert water.depth == 9.0
    (plan,) = run_plans(problem, water)
    assert plan.theory == theory
    assert [notice.severity for notice in theory_limit(problem, plan)] == ([severity] if severity else [])
    at_crest = plan.flow.at(1e3 * 9.0, np.array([[0.0], [0.0], [0.0]]))
    exact = nonlinear_wave("stream_function", height=2.0, water=water, period=9.0)
    same = np.allclose(at_crest[6], exact.crest, rtol=1e-9) and np.allclose(
        at_crest[:3, 0], exact.velocity(0.0, 0.0, 0.0, 0.0), atol=1e-9
    )
    assert same == (theory == "stream function")


def test_the_last_good_state_of_a_sound_run_is_its_end(tmp_path):
    problem = problem_of(line_case(analyses="[dynamic]", settings="{duration: 2 s, output_step: 50 ms}"), tmp_path)
    from moyai.structures.network import dynamics

    assembly = assemble(problem, 0.0)
    plan = run_plans(problem, problem.environment.water_at(0.0))[0]
    item = dynamics.run(problem, assembly, plan, solve_equilibrium(assembly.network).state)
    assert last_good_state(item.history) is item.history.final
    bad = replace(
        item.history, final=replace(item.history.final, position=np.full_like(item.history.final.position, np.nan))
    )
    kept = last_good_state(bad)
    assert np.allclose(kept.position, item.history.position[-1])
    assert kept.time == pytest.approx(2.0)


@pytest.mark.slow
def test_a_box_on_slack_chains_floats_at_its_draught(tmp_path):
    text = (
        SITE
        + f"""
structure:
  kind: network
  bed: {{stiffness: 3e5, damping: 3e4, friction: 0}}
  line_types: {{rope: {ROPE}}}
  bodies:
    box: {{shape: box, size: [4 m, 6 m, 2 m], mass: 20 t, gyration_radii: [1.8 m, 1.3 m, 2.1 m],
           centre_of_gravity: [0, 0, -0.3 m], position: [0, 0, 0.2 m], drag: [1, 1, 1], added_mass: [0.5, 0.5, 1],
           points: {{west: [-2 m, 0, -0.5 m], east: [2 m, 0, -0.5 m]}}}}
  points: {{a: {{kind: fixed, position: [-45, 0, bed]}}, b: {{kind: fixed, position: [45, 0, bed]}}}}
  lines:
    west: {{start: a, end: west, type: rope, length: 56 m, segments: 14}}
    east: {{start: b, end: east, type: rope, length: 56 m, segments: 14}}
analyses: [statics]
"""
    )
    rest = run(problem_of(text, tmp_path)).tree["SWL/statics"].to_dataset().sel(condition="still water")
    place = rest["solid_position"].sel(solid="box").values
    assert np.abs(place[:2]).max() < 1e-3
    assert np.abs(rest["solid_angle"].values).max() < 1e-4
    # weight, pulls and half a bar at each point against the displaced water of the wet part
    pull = float(rest["point_load"].sel(axis="z", point=["west", "east"]).sum())
    half_bars = 2.0 * 0.5 * 4.0 * (9.0 - 1025.0 * math.pi / 4.0 * 0.04**2) * 9.81
    draught = 1.0 - place[2]
    assert 20e3 * 9.81 - pull + half_bars == pytest.approx(1025.0 * 9.81 * 24.0 * draught, rel=1e-4)


def test_a_sheet_hangs_down_by_its_length(tmp_path):
    text = (
        SITE
        + """
structure:
  kind: network
  sheets:
    skirt: {corners: [[0, 0, -1], [0, 4, -1], [0, 4, -3], [0, 0, -3]], rows: 7, columns: 13, warp_stiffness: 50 kN/m,
            weft_stiffness: 50 kN/m, shear_stiffness: 2 kN/m, mass: 4 kg/m2, thickness: 2 mm, drag_normal: 1.2,
            drag_tangential: 0.02, fullness: 1.1, first_row: fixed}
analyses: [statics]
"""
    )
    problem = problem_of(text, tmp_path)
    network = assemble(problem, 0.0).network
    assert network.node_mass.sum() == pytest.approx(4.0 * 4.4 * 2.2, rel=1e-9)
    result = run(problem)
    assert result.status == "converged"
    place = result.tree["SWL/statics"]["position"].values[0]
    middle = network.points["skirt[6,6]"]
    # the top row stands closer than the cloth is wide, so that it falls in folds: never longer than its threads
    assert -1.0 - 2.2 * 1.001 < place[middle, 2] < -1.0 - 2.0


def test_loads_on_points_hold_what_a_snap_pulls_between_two_rows(tmp_path):
    """Rows ten times as far apart must not lose the peak at the ends of the line, nor the pull on the anchor."""
    found = {}
    for rows in ("20 ms", "0.2 s"):
        settings = f"{{duration: 12 s, skip: 8 s, output_step: {rows}}}"
        result = run(problem_of(line_case(analyses="[dynamic]", settings=settings), tmp_path))
        summary = result.tree["SWL/dynamic"].to_dataset(inherit=False).isel(run=0)
        found[rows] = summary
        assert float(summary["point_load_maximum"].sel(point="anchor")) == pytest.approx(
            float(summary["start_peak"][0]), 1e-9
        )
        assert float(summary["line_tension_maximum"][0]) >= float(summary["end_peak"][0])
    fine, coarse = found["20 ms"], found["0.2 s"]
    for key in (
        "line_tension_maximum",
        "start_peak",
        "end_peak",
        "point_load_maximum",
        "point_horizontal_load_maximum",
    ):
        np.testing.assert_allclose(coarse[key], fine[key], rtol=2e-2, err_msg=key)
    assert any(notice.code == "rows-too-far-apart" for notice in result.notices)


@pytest.mark.slow
def test_a_peak_inside_a_line_is_distinguished_from_its_ends(tmp_path):
    """Chain that a small buoy lifts and drops on the bed: what its nodes bear there is no load of anchor or buoy."""
    text = """moyai: 1
title: Chain on a bed
site: {water_depth: 12 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
waves: {kind: regular, name: waves, height: 2 m, period: 6 s, heading_deg: 0}
structure:
  kind: network
  bed: {stiffness: 3e5 Pa/m, damping: 3e4 Pa s/m, friction: 0.5}
  line_types:
    chain: {catalogue: studless_chain_U3, diameter: 20 mm, damping_ratio: 0.3}
    rope: {diameter: 24 mm, mass: 0.45 kg/m, axial_stiffness: 200 kN, viscosity: 1 kN s, drag_normal: 1.2,
           drag_tangential: 0.06, added_mass_normal: 1}
  points:
    anchor: {kind: fixed, position: [0, 0, bed]}
    buoy: {kind: sphere, position: [6 m, 0, 0], diameter: 0.9 m, mass: 120 kg, drag_coefficient: 0.5,
           added_mass_coefficient: 0.5}
  lines:
    line:
      start: anchor
      end: buoy
      parts: [{type: chain, length: 4 m, segments: 8}, {type: rope, length: 12 m, segments: 12}]
analyses: [dynamic]
settings: {duration: 20 s, skip: 8 s}
"""
    result = run(problem_of(text, tmp_path))
    summary = result.tree["SWL/dynamic"].to_dataset(inherit=False).isel(run=0, line=0)
    ends = max(float(summary["start_peak"]), float(summary["end_peak"]))
    assert float(summary["line_tension_maximum"]) > 1.2 * ends
    notice = next(notice for notice in result.notices if notice.code == "peak-inside")
    assert notice.value == pytest.approx(float(summary["line_tension_maximum"]))
    assert float(notice.message.split(" m from")[0].split()[-1]) < 4.0  # within the chain


BED = "bed: {stiffness: 1 MPa/m, damping: 0 Pa s/m, "


@pytest.mark.parametrize("form", ["slope", "depths", "seafloor"])
def test_a_line_rests_on_a_bed_that_rises_however_it_is_given(form, tmp_path):
    bed = BED + "grid: {file: bed.txt, form: " + form + "}}"
    if form == "slope":
        bed = BED + "slope: {rise: 0.1, towards_deg: 180}}"
    elif form == "depths":
        rows = "".join(f"{x} {y} {30 + 0.1 * x}\n" for y in (-50, 50) for x in (100, -100))
        (tmp_path / "bed.txt").write_text("x y depth\n" + rows)
    else:
        rows = "".join(f"{x} {y} {-30 - 0.1 * x}\n" for x in (-100, 100) for y in (-50, 50))
        (tmp_path / "bed.txt").write_text("2 2\n-100 100\n-50 50\n" + rows)
    text = line_case(length="60 m", segments=40).replace("structure:\n", f"structure:\n  {bed}\n")
    text = text.replace("position: [0, 0, -12 m]", "position: [0, 0, bed]")
    assembly = assemble(problem_of(text, tmp_path), 0.0)
    network = assembly.network
    assert network.nodes.position[network.points["anchor"]].tolist() == pytest.approx([0.0, 0.0, -30.0])
    rest = solve_equilibrium(network)
    place = rest.state.position
    lies = place[:, 2] < network.bed.level_at(place)
    np.testing.assert_allclose(network.bed.level_at(place), -30.0 - 0.1 * place[:, 0], rtol=1e-12)
    assert 3 < lies.sum() < 30


def test_a_line_starts_on_a_bed_that_rises_between_its_ends(tmp_path):
    (tmp_path / "bed.txt").write_text(
        "".join(f"{x} {y} {z}\n" for x, z in ((0, 12), (20, 8), (50, 30)) for y in (-5, 5))
    )
    text = line_case(length="50 m", segments=40).replace(
        "structure:\n", "structure:\n  " + BED + "grid: {file: bed.txt}}\n"
    )
    network = assemble(problem_of(text, tmp_path), 0.0).network
    # the anchor is on the corner of the grid, from which the bed is rounded
    inner = network.nodes.position[1:]
    assert (inner[:, 2] >= network.bed.level_at(inner) - 1e-9).all()
    rest = solve_equilibrium(network)
    assert rest.state.position[np.argmin(np.abs(rest.state.position[:, 0] - 20.0)), 2] == pytest.approx(-8.0, abs=0.1)


def test_a_bed_that_varies_is_checked(tmp_path):
    (tmp_path / "bed.txt").write_text("0 -5 30\n0 5 30\n20 -5 34\n20 5 34\n")
    text = line_case().replace("structure:\n", "structure:\n  " + BED + "grid: {file: bed.txt}}\n")
    (tmp_path / "case.yaml").write_text(text)
    said = "\n".join(item.message for item in load_case(tmp_path / "case.yaml").warnings)
    assert "some of 'fairlead' among them, are beyond the grid of the bed" in said
    assert "down to 34 m below still water" in said
    (tmp_path / "bed.txt").write_text("0 -5 10\n0 5 10\n20 -5 34\n20 5 34\n")
    with pytest.raises(CaseError, match="z = -12 m lies under the bed, which is 10"):
        problem_of(text, tmp_path)
    (tmp_path / "bed.txt").write_text("0 -5 10\n0 5 10\n20 -5 34\n")
    with pytest.raises(CaseError, match="is given nowhere in a grid of 2 by 2 lines"):
        problem_of(text, tmp_path)
