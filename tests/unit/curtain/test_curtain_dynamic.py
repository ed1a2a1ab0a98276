"""The whole span through time: section masses, meshes, energy, waves."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.core.progress import silent
from moyai.flexible.flow import Flow
from moyai.sea.regular import RegularWave
from moyai.sea.water import Water
from moyai.structures.curtain.analyses import dynamic as analysis_dynamic
from moyai.structures.curtain.dynamic import peak_uncertainty
from moyai.structures.curtain.dynamic.assembly import build_span
from moyai.structures.curtain.dynamic.cable import dynamic_cable
from moyai.structures.curtain.dynamic.checks import run_checks, run_notices
from moyai.structures.curtain.dynamic.model import AnchoredSupport, CurtainNetwork, CurtainSpan, Mesh
from moyai.structures.curtain.dynamic.peak_uncertainty import PeakUncertainties, PeakUncertainty, span_uncertainty
from moyai.structures.curtain.dynamic.plans import Plan
from moyai.structures.curtain.dynamic.runs import DynamicRun, run_span
from moyai.structures.curtain.dynamic.section import section_mesh
from moyai.structures.curtain.impact.cable import Impact, peak_by_energy
from moyai.structures.curtain.statics.closed_forms import solve_cable

FLUME = Water(0.40, 1000.0, 9.81)
BASE = {
    "span": 0.7, "length": 0.8, "skirt_length": 0.15, "chord": 0.135, "upper_stiffness": 75.0, "lower_stiffness": 75.0,
    "upper_mass": 0.0625, "lower_mass": 0.0625, "sheet_stiffness": 2e4, "sheet_mass": 0.1,
}  # fmt: skip


def snap(span: CurtainSpan, mesh: Mesh, rises: float = 1.4, **more: object) -> DynamicRun:
    stiffness = span.upper_stiffness, max(span.lower_stiffness, 1e-6)
    rise = peak_by_energy(Impact(span.span, span.length, span.skirt_length, *stiffness, 0.3, FLUME)).time
    given = {"speed": 0.3, "weight": False, "deep": True, **more}
    return run_span(span, mesh, FLUME, duration=rises * rise, output_step=rise / 50.0, **given)  # type: ignore[arg-type]


def test_flat_section_has_the_plate_masses() -> None:
    """Linear shapes between the edges are exact on any mesh: pi/16, 1/3 - pi/16, 2/pi - 2/3 + pi/16 of rho d^2."""
    mesh = section_mesh(2.0, 2.0, 6, math.inf, 1000.0)
    mass, down = mesh.added_mass[:7, :7] / 4000.0, np.linspace(0.0, 1.0, 7)
    up = 1.0 - down
    assert down @ mass @ down == pytest.approx(math.pi / 16.0, rel=1e-5)
    assert up @ mass @ down == pytest.approx(1.0 / 3.0 - math.pi / 16.0, rel=1e-5)
    assert up @ mass @ up == pytest.approx(2.0 / math.pi - 2.0 / 3.0 + math.pi / 16.0, rel=1e-5)
    assert np.max(np.abs(mesh.added_mass[7:])) < 1e-9


def test_curved_section_pushes_downstream_and_down() -> None:
    """The published mass of an arc that moves as a whole; vertical motion of all nodes and the coupling are there."""
    # s/d = 0.5: M_xx over that of the flat chord is 1.080
    chord = 1.0
    length = 2.0 * math.sqrt(0.5) * math.atan(1.0)
    mesh = section_mesh(length, chord, 12, math.inf, 1000.0)
    assert mesh.rigid_mass / (2000.0 / math.pi) == pytest.approx(1.080, abs=0.002)
    assert np.allclose(mesh.added_mass, mesh.added_mass.T)
    assert np.linalg.eigvalsh(mesh.added_mass)[0] > -1e-9


@pytest.mark.parametrize("seed", range(3))
def test_dynamic_cable_keeps_its_energy_below_the_bound(seed: int) -> None:
    """Random spans: energy kept to 1 %, a start like the sag below the peak of an evenly stretched cable.

    A uniform start sends fronts along the cable that may double at the supports: it has no such bound.
    """
    rng = np.random.default_rng(seed)
    span = 10.0 ** rng.uniform(-0.5, 1.5)
    impact = Impact(
        span, span * rng.uniform(1.05, 1.5), 0.2 * span, *(1e4 * span**2 * 10.0 ** rng.uniform(-1.0, 1.0, 2)),
        0.5 * rng.uniform(0.3, 1.0), Water(span, 1025.0, 9.81),
    )  # fmt: skip
    for start in ("sag", "uniform"):
        found = dynamic_cable(impact, own_mass=0.005 * 1025.0 * span**2, start=start)  # type: ignore[arg-type]
        assert found.energy_drift < 0.01
        moved = impact.deep_mass + 0.005 * 1025.0 * span**2
        bound = impact.speed * math.sqrt(moved * impact.stiffness * impact.span_ratio)
        assert 0.85 * peak_by_energy(impact).tension < found.tension < (1.0 if start == "sag" else 2.0) * bound


@pytest.mark.slow
def test_peak_lies_between_the_models_and_the_bound() -> None:
    span = CurtainSpan(**{**BASE, "chord": 0.15, "edges": "held"})  # type: ignore[arg-type]
    model = Impact(0.7, 0.8, 0.15, 75.0, 75.0, 0.3, FLUME)
    run = snap(span, Mesh(16, 4), profile="sag")
    assert run.history.status == "converged"
    peak = run.peak("both")[0]
    assert 0.85 < peak / peak_by_energy(model).tension < 1.0
    total = run.history.kinetic_energy + run.history.elastic_energy
    assert np.max(run.history.energy_balance) < 1e-3 * total[0]
    assert np.min(run.history.energy_balance) > -0.01 * total[0]


@pytest.mark.parametrize("seed", range(3))
def test_energy_of_random_spans(seed: int) -> None:
    """No energy from nowhere, whatever the span: random sizes, stiffness and speed, risen or held toe."""
    rng = np.random.default_rng(seed)
    scale = 10.0 ** rng.uniform(-0.5, 1.5)
    span = CurtainSpan(
        span=scale, length=scale * rng.uniform(1.03, 1.4),
        skirt_length=0.3 * scale, chord=0.3 * scale * rng.uniform(0.9, 1.0),
        upper_stiffness=1e4 * scale**2 * 10.0 ** rng.uniform(-1.0, 1.0), lower_stiffness=1e4 * scale**2,
        upper_mass=1.0 * scale**2, lower_mass=2.0 * scale**2, sheet_stiffness=1e5 * scale, sheet_mass=0.5 * scale,
        edges=("held", "risen")[seed % 2],
    )  # fmt: skip
    water = Water(0.6 * scale, 1025.0, 9.81)
    speed = 0.5 * math.sqrt(scale) * rng.uniform(0.3, 1.0)
    rise = peak_by_energy(
        Impact(span.span, span.length, span.skirt_length, span.upper_stiffness, span.lower_stiffness, speed, water)
    ).time
    run = run_span(span, Mesh(12, 4), water, duration=2.0 * rise, output_step=rise / 40, speed=speed, weight=False)
    assert run.history.status == "converged"
    total = run.history.kinetic_energy + run.history.elastic_energy
    assert np.max(run.history.energy_balance) < 0.01 * total[0]


@pytest.mark.slow
def test_froude_scale_carries_the_peak() -> None:
    """Lengths times 10, EA times 1000: the peak grows by 1000, viscosity of the mesh included."""
    small = snap(CurtainSpan(**BASE), Mesh(12, 4), profile="sag")  # type: ignore[arg-type]
    ten = CurtainSpan(
        span=7.0, length=8.0, skirt_length=1.5, chord=1.35, upper_stiffness=75e3, lower_stiffness=75e3,
        upper_mass=6.25, lower_mass=6.25, sheet_stiffness=2e6, sheet_mass=1.0,
    )  # fmt: skip
    water = Water(4.0, 1000.0, 9.81)
    speed = 0.3 * math.sqrt(10.0)
    rise = peak_by_energy(Impact(7.0, 8.0, 1.5, 75e3, 75e3, speed, water)).time
    large = run_span(
        ten, Mesh(12, 4), water, duration=1.4 * rise, output_step=rise / 50, speed=speed, weight=False, deep=True,
        profile="sag",
    )  # fmt: skip
    assert large.peak("both")[0] / small.peak("both")[0] == pytest.approx(1000.0, rel=1e-3)


def test_slack_curtain_in_still_water_stays() -> None:
    """Floats and ballast are in balance at the start: nothing moves but the slack cables under their own weight."""
    span = CurtainSpan(
        span=15.0, length=16.0, skirt_length=4.0, chord=4.0, upper_stiffness=5e5, lower_stiffness=5e5, upper_mass=15.0,
        lower_mass=15.0, lower_volume=0.002, sheet_stiffness=3e5, sheet_mass=0.8, sheet_volume=0.0006,
        drag_coefficient=1.5, float_volume=0.1, float_height=0.35, edges="free",
    )  # fmt: skip
    run = run_span(span, Mesh(8, 4), Water(10.0, 1025.0, 9.81), duration=1.0, output_step=0.05)
    grid = run.built.grid[2:-2]
    moved = run.history.position[-1][grid] - run.history.position[0][grid]
    assert np.max(np.abs(moved)) < 0.02


@pytest.mark.slow
def test_anchored_span_in_a_current_ends_at_its_drag() -> None:
    """Anchor lines carry the drag of the whole span in the end: all four together, both halves of the neighbours."""
    water = Water(10.0, 1025.0, 9.81)
    span = CurtainSpan(
        span=15.0, length=16.5, skirt_length=3.0, chord=3.0, upper_stiffness=2e5, lower_stiffness=2e5, upper_mass=15.0,
        lower_mass=60.0, lower_volume=0.008, sheet_stiffness=3e5, sheet_mass=1.6, sheet_volume=0.0012,
        drag_coefficient=1.5, float_volume=0.2, float_height=0.5, edges="free",
        support=AnchoredSupport(30.0, math.asin(1.0 / 3.0), 1e6, 200.0, 500.0),
    )  # fmt: skip
    run = run_span(
        span, Mesh(12, 4), water, flow=Flow((0.3, 0.0, 0.0)), duration=90.0, output_step=0.25, from_time=80.0
    )
    assert run.history.status == "converged"
    late = run.history.time > 75.0
    up = sum(np.mean(run.tension(name)[late]) for name in run.built.lines if "upstream" in name)
    down = sum(np.mean(run.tension(name)[late]) for name in run.built.lines if "downstream" in name)
    grid, loads, slopes = run.built.grid, [], []
    for place in run.history.position[late][::5]:
        one, two = place[grid[1:, 1:]] - place[grid[:-1, :-1]], place[grid[1:, :-1]] - place[grid[:-1, 1:]]
        area = 0.5 * np.cross(one, two)
        # the upper edge hangs on floats that stand out of the water by a part of their height
        edge = 0.5 * (place[grid[1:], 2] + place[grid[:-1], 2])
        wet = np.clip(-edge[:, 1:] / (edge[:, :-1] - edge[:, 1:]), 0.0, 1.0)
        across = 0.3 * area[..., 0] / np.linalg.norm(area, axis=-1)
        loads.append(abs(0.5 * 1025.0 * 1.5 * float(np.sum(wet * across * np.abs(across) * area[..., 0]))))
        anchor = run.built.network.strand(run.built.lines[0]).nodes
        way = place[anchor[0]] - place[anchor[1]]
        slopes.append(way[0] / np.linalg.norm(way))
    drag, slope = float(np.mean(loads)), float(np.mean(slopes))
    assert 0.5 * (up - down) * slope == pytest.approx(drag, rel=0.01)


@pytest.mark.slow
def test_sensitivity_gives_the_uncertainty_of_the_peak() -> None:
    span, mesh = CurtainSpan(**BASE), Mesh(12, 6)  # type: ignore[arg-type]
    rise = peak_by_energy(Impact(0.7, 0.8, 0.15, 75.0, 75.0, 0.3, FLUME)).time
    given = {
        "water": FLUME, "duration": 1.2 * rise, "output_step": rise / 50.0, "speed": 0.3, "weight": False, "deep": True,
        "profile": "sag",
    }  # fmt: skip
    run = run_span(span, mesh, **given)  # type: ignore[arg-type]
    uncertainty = span_uncertainty(run, **given)
    assert set(uncertainty.of) == {"both", "upper cable", "lower cable"}
    for name, one in uncertainty.of.items():
        assert one.peak == run.peak(name)[0]
        assert one.half_step == pytest.approx(one.peak, rel=0.02)
        assert one.half_mesh == pytest.approx(one.peak, rel=0.06)
        assert one.double_viscosity < one.peak
    assert bool(uncertainty.notices("here", 1e-4)) and not uncertainty.notices("here", 0.5)


def test_half_the_step_takes_about_twice_the_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """Drag of a sudden current shortens the first steps: half of the smallest would take four times the steps."""
    given = {"water": FLUME, "flow": Flow((0.0, 3.0, 0.0)), "duration": 0.4, "output_step": 0.004}
    run = run_span(CurtainSpan(**{**BASE, "drag_coefficient": 1.4}), Mesh(6, 3), **given)  # type: ignore[arg-type]
    assert 0.4 / run.history.step > 1.6 * run.history.steps
    others: list[DynamicRun] = []

    def kept(*place: object, **more: object) -> DynamicRun:
        others.append(run_span(*place, **more))  # type: ignore[arg-type]
        return others[-1]

    monkeypatch.setattr(peak_uncertainty, "run_span", kept)
    span_uncertainty(run, **given)
    same = [one for one in others if one.built.mesh == run.built.mesh]
    assert [one.history.steps / run.history.steps for one in same] == [pytest.approx(2.0, rel=0.2)]


def test_sensitivity_tells_of_a_cable_that_the_sum_hides() -> None:
    good, poor = PeakUncertainty(10.0, 10.0, 10.1, 9.9), PeakUncertainty(2.4, 2.4, 5.0, 2.3)
    reported = PeakUncertainties({"both": good, "upper cable": good, "lower cable": poor}).notices("here")
    assert len(reported) == 1 and "lower cable by 108.3 %" in reported[0].message and "upper" not in reported[0].message
    assert not PeakUncertainties({"both": good, "upper cable": good}).notices("here")
    missing = PeakUncertainty(10.0, 10.0, math.nan, 9.9)
    assert [n.code for n in PeakUncertainties({"both": missing}, ("the run stopped",)).notices("here")] == [
        "dynamic-sensitivity"
    ]


@pytest.mark.slow
def test_waves_pull_the_span_taut_only_beyond_its_slack() -> None:
    """Without current, waves whose water goes less than the sag either way leave the cables slack; larger ones snap."""
    water = Water(0.40, 1000.0, 9.81)
    peaks = []
    for height in (0.01, 0.12):
        wave = RegularWave(height, 2.0, 0.0, water).components()
        span = CurtainSpan(
            **{**BASE, "chord": 0.15, "upper_mass": 0.1, "lower_mass": 0.5, "lower_volume": 6e-5, "edges": "free",
               "drag_coefficient": 1.2, "float_volume": 1.2e-3, "float_height": 0.04, "sheet_volume": 1e-4}
        )  # fmt: skip
        run = run_span(
            span, Mesh(8, 4), water, flow=Flow(waves=wave, ramp=2.0), duration=4.0, output_step=0.01, from_time=2.0
        )
        assert run.history.status == "converged"
        peaks.append(run.peak("both")[0])
    assert peaks[1] > 10.0 * peaks[0]


def test_faults_of_spans() -> None:
    for change, words in (
        ({"length": 0.6}, "not longer"),
        ({"chord": 0.2}, "chord"),
        ({"sheet_mass": 0.0}, "sheet_mass"),
        ({"upper_stiffness": math.inf}, "upper_stiffness"),
        ({"float_volume": 1.0}, "height"),
        ({"shear_stiffness": 1.0}, "span stiffness"),
    ):
        with pytest.raises(InputError, match=words):
            CurtainSpan(**{**BASE, **change})  # type: ignore[arg-type]
    with pytest.raises(InputError, match="cells"):
        Mesh(2, 2)
    with pytest.raises(InputError, match=r"water 0\.1 m deep"):
        build_span(CurtainSpan(**BASE), Mesh(8, 4), Water(0.1, 1000.0, 9.81))  # type: ignore[arg-type]
    floating = {**BASE, "chord": 0.15, "float_volume": 1e-6, "float_height": 0.01, "lower_volume": 1e-6}
    with pytest.raises(InputError, match="lift"):
        build_span(CurtainSpan(**floating), Mesh(8, 4), FLUME)  # type: ignore[arg-type]


def test_crumpling_fails_the_energy_check() -> None:
    run = run_span(
        CurtainSpan(**BASE),
        Mesh(8, 4),
        FLUME,
        duration=0.1,
        output_step=0.01,
        speed=0.3,
        weight=False,
        deep=True,  # type: ignore[arg-type]
    )
    assert all(check.passed for check in run_checks(run, "here"))
    history = run.history
    eaten = replace(run, history=replace(history, work=history.work + np.linspace(0.0, 10.0, history.work.size)))
    assert [check.passed for check in run_checks(eaten, "here")] == [True, False]


@pytest.mark.slow
def test_held_normals_of_a_flat_start_are_those_of_an_independent_program() -> None:
    """Threads for cloth and normals that never turn: a leapfrog of its own, current that grows over 5 s, no drag."""
    water = Water(10.0, 1025.0, 9.81)
    span = CurtainSpan(
        span=15.0, length=16.5, skirt_length=4.0, chord=4.0, upper_stiffness=2.5e6, lower_stiffness=4e5,
        upper_mass=15.3, lower_mass=15.0, lower_volume=15.0 / 7850.0, sheet_stiffness=3e5, sheet_mass=0.8,
        float_volume=0.0975, float_height=0.352, edges="risen",
    )  # fmt: skip
    mesh = Mesh(12, 4, turning=False)
    run = run_span(span, mesh, water, flow=Flow((0.2, 0.0, 0.0), ramp=5.0), duration=10.0, output_step=0.0125)
    found = threads_with_held_normals(run.built, 0.2, 5.0, 10.0)
    assert run.history.status == "converged"
    assert run.tension("upper cable").max() == pytest.approx(found[0], rel=0.02)
    assert run.tension("lower cable").max() == pytest.approx(found[1], rel=0.02)


def threads_with_held_normals(built: CurtainNetwork, speed: float, ramp: float, length: float) -> tuple[float, float]:
    """Return the peaks of both cables: threads between two strings of springs, held normals, no viscosity."""
    span, grid, water = built.span, built.grid, built.network.water
    place, rows = np.array(built.state.position[grid]), grid.shape[1]
    plan = place[:, 0, :2]
    cells = np.linalg.norm(np.diff(plan, axis=0), axis=1)
    share = 0.5 * (np.append(cells, 0.0) + np.append(0.0, cells))
    way = plan[2:] - plan[:-2]
    way /= np.linalg.norm(way, axis=1)[:, None]
    normal = np.stack([way[:, 1], -way[:, 0]], axis=1)
    thread = span.skirt_length / (rows - 1)
    own = np.full((len(plan), rows), span.sheet_mass * thread) * share[:, None]
    own[:, [0, -1]] *= 0.5
    weight = own * water.gravity
    own[:, 0] += span.upper_mass * share
    own[:, -1] += span.lower_mass * share
    weight[:, 0] += span.upper_mass * share * water.gravity
    weight[:, -1] += (span.lower_mass - water.density * span.lower_volume) * share * water.gravity
    both = np.concatenate([own, own], axis=1)
    added = built.section.added_mass
    inverse = np.array([np.linalg.inv(s * added + np.diag(m)) for s, m in zip(share[1:-1], both[1:-1], strict=True)])
    push = added[:, :rows].sum(axis=1)[None, :] * share[1:-1, None] * normal[:, :1]
    velocity, step = np.zeros_like(place), 6e-4
    highest = [0.0, 0.0]
    for number in range(round(length / step)):
        force = np.zeros_like(place)
        force[..., 2] -= weight
        wet = np.clip(0.5 - place[:, 0, 2] / span.float_height, 0.0, 1.0)
        force[:, 0, 2] += water.density * water.gravity * span.float_volume * share * wet
        down = np.diff(place, axis=1)
        size = np.linalg.norm(down, axis=2)
        pull = span.sheet_stiffness * share[:, None] * np.maximum(size / thread - 1.0, 0.0)
        one = (pull / size)[..., None] * down
        force[:, :-1] += one
        force[:, 1:] -= one
        for row, stiffness in ((0, span.upper_stiffness), (-1, span.lower_stiffness)):
            chord = np.diff(place[:, row], axis=0)
            size = np.linalg.norm(chord, axis=1)
            tension = stiffness * np.maximum(size / cells - 1.0, 0.0)
            highest[row] = max(highest[row], float(tension.max()))
            one = (tension / size)[:, None] * chord
            force[:-1, row] += one
            force[1:, row] -= one
        inner = force[1:-1]
        time = number * step
        pace = speed * 0.5 * math.pi / ramp * math.sin(math.pi * time / ramp) if time < ramp else 0.0
        across = inner[..., 0] * normal[:, :1] + inner[..., 1] * normal[:, 1:]
        local = np.concatenate([across, inner[..., 2]], axis=1) + pace * push
        kick = np.einsum("gij,gj->gi", inverse, local)
        along = (inner[..., 0] * way[:, :1] + inner[..., 1] * way[:, 1:]) / own[1:-1]
        velocity[1:-1, :, 0] += step * (kick[:, :rows] * normal[:, :1] + along * way[:, :1])
        velocity[1:-1, :, 1] += step * (kick[:, :rows] * normal[:, 1:] + along * way[:, 1:])
        velocity[1:-1, :, 2] += step * kick[:, rows:]
        place += step * velocity
    return highest[0], highest[1]


def test_runs_tell_what_they_did_not_reach() -> None:
    span, mesh = CurtainSpan(**BASE), Mesh(8, 4)  # type: ignore[arg-type]
    rise = peak_by_energy(Impact(0.7, 0.8, 0.15, 75.0, 75.0, 0.3, FLUME)).time
    short, whole = snap(span, mesh, 0.5), snap(span, mesh, 2.0)
    assert [n.code for n in run_notices(short, "here", rise, False)] == ["dynamic-short"]
    assert "shorter than the rise" in run_notices(short, "here", rise, False)[0].message
    assert not run_notices(whole, "here", rise, False)
    # the same short run where model A is quicker: the tension is highest at its end
    assert "second half" in run_notices(short, "here", 0.1 * rise, False)[0].message


@pytest.mark.slow
def test_a_skirt_stiff_along_the_span_starts_unstrained_only_when_flat() -> None:
    """Flat: the same peak on two meshes. Bulging: what its arc adds to the cables strains it, reported as an error."""
    stiff = {**BASE, "span_stiffness": 2e4, "shear_stiffness": 8e3}
    flat = CurtainSpan(**{**stiff, "chord": 0.15})  # type: ignore[arg-type]
    runs = [snap(flat, Mesh(*cells, cable_viscosity=0.0036, skirt_damping_time=1e-5)) for cells in ((12, 4), (24, 8))]
    assert runs[0].peak("both")[0] == pytest.approx(runs[1].peak("both")[0], rel=0.02)
    assert not [n for n in run_notices(runs[0], "here", 0.0, False) if n.code == "dynamic-strained-start"]
    bulging = snap(CurtainSpan(**stiff), Mesh(8, 4), 0.1)  # type: ignore[arg-type]
    assert [n.severity for n in run_notices(bulging, "here", 0.0, False) if n.code == "dynamic-strained-start"] == [
        "error"
    ]


@pytest.mark.slow
def test_a_snap_is_run_until_it_is_past_its_peak() -> None:
    """A plan that begins too short is doubled; one whose length was given is not."""
    span = CurtainSpan(**BASE)  # type: ignore[arg-type]
    rise = peak_by_energy(Impact(0.7, 0.8, 0.15, 75.0, 75.0, 0.3, FLUME)).time
    arguments = {
        "water": FLUME, "flow": Flow(), "duration": 0.4 * rise, "output_step": rise / 50.0, "speed": 0.3,
        "weight": False, "deep": True, "profile": "sag",
    }  # fmt: skip
    plan, run, reported = analysis_dynamic.through(
        span, Mesh(8, 4), Plan("snap", arguments, rise, open=True), silent, ""
    )
    assert plan.arguments["duration"] == pytest.approx(3.2 * rise) and not reported
    assert 0.5 * rise < run.peak("both")[1] < 1.5 * rise
    given = analysis_dynamic.through(span, Mesh(8, 4), Plan("snap", arguments, rise), silent, "")[1]
    assert given.history.time[-1] == pytest.approx(0.4 * rise)


@pytest.mark.slow
def test_a_peak_of_the_start_is_distinguished_from_those_of_the_sea() -> None:
    """A snap, then little: with the waves of a sea its first peak is one of the start; counted later it is not."""
    run = snap(CurtainSpan(**BASE), Mesh(8, 4), 4.0)  # type: ignore[arg-type]
    sea = replace(run, flow=Flow(waves=RegularWave(0.01, 2.0, 0.0, FLUME).components()))
    (reported,) = [n for n in run_notices(sea, "here", 1.0, False) if n.code == "dynamic-start"]
    late = run.both[run.history.time > 0.5 * run.history.time[-1]]
    assert reported.value == pytest.approx(run.peak("both")[0] / late.max(), rel=1e-3)
    # between two periods of a regular wave it is what has not settled
    assert "dynamic-unsettled" in [n.code for n in run_notices(sea, "here", 0.25 * run.history.time[-1], True)]
    later = replace(sea, from_time=0.6 * float(run.history.time[-1]))
    assert not [n for n in run_notices(later, "here", 1.0, False) if n.code == "dynamic-start"]


def test_a_span_let_go_slack_is_gathered_and_bears_nothing() -> None:
    span = CurtainSpan(**{**BASE, "chord": 0.15})  # type: ignore[arg-type]
    for release in (0.0, 0.5, 0.999):
        built = build_span(span, Mesh(12, 4), FLUME, weight=False, release=release)
        network = built.network
        place = built.state.position
        chord = np.linalg.norm(place[network.bars.end] - place[network.bars.start], axis=1)
        cables = np.concatenate([built.bars("upper cable"), built.bars("lower cable")])
        assert np.all(chord[cables] < network.bars.length[cables])
        assert np.sum(network.bars.length[built.bars("upper cable")]) == pytest.approx(0.8, rel=2e-3)
    line = build_span(span, Mesh(12, 4), FLUME, weight=False, release=0.0)
    assert np.max(np.abs(line.state.position[line.grid, 0])) < 1e-12
    with pytest.raises(InputError, match="release is 1"):
        build_span(span, Mesh(12, 4), FLUME, release=1.0)


@pytest.mark.slow
def test_a_released_span_comes_to_the_catenary_under_drag() -> None:
    """The sheet under normal drag q cos^2 hangs in a catenary of constant tension q a, longer by the cables' strain."""
    span = CurtainSpan(**{**BASE, "chord": 0.15, "drag_coefficient": 1.2})  # type: ignore[arg-type]
    run = run_span(
        span, Mesh(10, 3), FLUME, flow=Flow(velocity=(0.3, 0.0, 0.0)), duration=4.0, output_step=0.01, weight=False,
        deep=True, release=0.0,
    )  # fmt: skip
    assert run.history.status == "converged"
    time, tension = run.history.time, run.support_tension
    load = 0.5 * 1000.0 * 1.2 * 0.15 * 0.3**2
    steady = float(solve_cable(0.7, 0.8, load, 150.0).tension)
    assert tension[time > 3.5].mean() == pytest.approx(steady, rel=0.03)
    assert np.all(tension[time < 0.3] < 0.01 * steady)
    assert 1.5 * steady < tension.max() < 3.0 * steady
