"""Whole runs of small breakwaters against identities, exact limits and the mistakes that users make."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.core.results import read_result
from moyai.core.store import DatasetStore
from moyai.potential.shapes import circle, pi_type, rectangle, trapezoid, twin_pontoon
from moyai.sea.current import uniform
from moyai.sea.spectra import jonswap
from moyai.sea.water import Water
from moyai.structures.breakwater.assembly import assemble
from moyai.structures.breakwater.model import Damping, IrregularSea, MooringSpring, RegularSea, Wind
from moyai.structures.breakwater.run import run
from moyai.structures.breakwater.settings import LineDynamics, TimeSettings


def springs(stiffness: float) -> tuple[MooringSpring, ...]:
    """Two horizontal springs so long that they stay linear, at the height of the centre of gravity."""
    return tuple(
        MooringSpring(name, 1, (side * 0.19, 0.0, 0.086), (side * 60.0, 0.0, -0.027), stiffness, 2.0)
        for name, side in (("left", -1), ("right", 1))
    )


def changed(problem, *, breakwater=None, environment=None, settings=None, analyses=None):
    return replace(
        problem,
        analyses=analyses or problem.analyses,
        breakwater=replace(problem.breakwater, **(breakwater or {})),
        environment=replace(problem.environment, **(environment or {})),
        settings=problem.settings.changed(**(settings or {})),
    )


@pytest.mark.slow
def test_linear_mooring_in_time_gives_the_frequency_domain(pontoon_problem):
    # the mandatory test of the specification, motions, C_R and C_T within 1 %; waves so low that springs stay linear
    generator = np.random.default_rng(7)
    for _ in range(2):
        periods = tuple(generator.uniform(0.7, 1.3, 2))
        problem = changed(
            pontoon_problem,
            breakwater={
                "lines": springs(float(generator.uniform(50, 400))),
                "mass": None,
                "damping": Damping(float(generator.uniform(0.05, 0.2))),
            },
            environment={"sea_states": (RegularSea("waves", 0.003, periods),)},
        )
        tree = run(problem).tree
        time, frequency = (tree[f"SWL/{name}/waves"].to_dataset() for name in ("time", "frequency"))
        assert time.motion_amplitude.values == pytest.approx(frequency.motion_amplitude.values, rel=4e-3, abs=1e-7)
        for name in ("reflection_coefficient", "transmission_coefficient"):
            assert time[name].values == pytest.approx(frequency[name].values, abs=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_random_units_rest_in_balance(pontoon_problem, seed):
    generator = np.random.default_rng(seed)
    hull = [
        rectangle(0.4, 0.3),
        trapezoid(0.3, 0.5, 0.3),
        pi_type(0.5, 0.3, 0.08, 0.03),
        twin_pontoon(0.15, 0.3, 0.3, deck_thickness=0.05),
    ][seed]
    mass = float(generator.uniform(15, 25))
    offset = float(generator.uniform(-0.01, 0.01))
    problem = changed(
        pontoon_problem,
        breakwater={"hull": hull, "mass": mass, "draught": None, "centre_of_gravity": (offset, 0.12)},
        environment={"water_levels": (("low", 0.0), ("high", float(generator.uniform(0, 0.05))))},
    )
    for name, level in problem.environment.water_levels:
        unit = assemble(problem, name, level)
        section, weight = unit.section, mass * 9.81
        buoyancy = 1000.0 * 9.81 * section.area * 0.986
        force = unit.mooring.force(np.zeros(3))
        assert buoyancy + force[1] - weight == pytest.approx(0.0, abs=1e-7 * weight)
        assert force[0] == pytest.approx(0.0, abs=1e-7 * weight)
        moment = force[2] - buoyancy * (section.centroid[0] - unit.centre[0])
        assert moment == pytest.approx(0.0, abs=1e-7 * weight)
        assert unit.imbalance == 0.0


def test_long_waves_pass_and_carry_the_body(pontoon_problem):
    # without lines and damping a long wave moves the body with the water: |heave| = a, C_T = 1, no drift
    problem = changed(
        pontoon_problem,
        breakwater={"lines": (), "mass": None, "damping": Damping(0.0)},
        environment={"sea_states": (RegularSea("swell", 0.01, (8.0,)),)},
        analyses=("statics", "frequency"),
        settings={"drift": False},
    )
    data = run(problem).tree["SWL/frequency/swell"].to_dataset()
    assert float(data.motion_ratio.sel(dof="heave")[0]) == pytest.approx(1.0, abs=0.01)
    assert float(data.transmission_coefficient[0]) == pytest.approx(1.0, abs=1e-3)
    assert float(data.drift_coefficient[0]) == pytest.approx(0.0, abs=1e-3)


@pytest.mark.parametrize("heading", [0.0, pytest.param(-0.7, marks=pytest.mark.slow)])
def test_energy_of_the_moving_body_in_oblique_waves(pontoon_problem, heading):
    problem = changed(
        pontoon_problem,
        environment={"sea_states": (RegularSea("waves", 0.02, (0.9,), heading),)},
        analyses=("statics", "frequency"),
    )
    result = run(problem)
    checks = [check for check in result.checks if "moving body" in check.name]
    assert checks and all(check.passed for check in checks)
    assert result.status == "converged"


def test_irregular_sea_of_one_frequency_is_a_regular_sea(pontoon_problem):
    # a spectrum so narrow that it is one wave: K_T and mean drift are those of the regular wave of equal energy
    omega = 2.0 * math.pi / 0.95
    narrow = np.linspace(0.995, 1.005, 21) * omega
    height = 0.03
    density = np.full(21, (height / 4.0) ** 2 / (narrow[-1] - narrow[0]))
    from moyai.sea.spectra import Spectrum

    seas = (
        RegularSea("regular", height / math.sqrt(2.0), (0.95,)),
        IrregularSea("narrow", Spectrum(narrow, density, "narrow"), duration=60.0),
    )
    problem = changed(pontoon_problem, environment={"sea_states": seas}, analyses=("statics", "frequency"))
    tree = run(problem).tree
    regular, narrow_sea = (tree[f"SWL/frequency/{sea.name}"].to_dataset() for sea in seas)
    assert float(narrow_sea.transmission_coefficient) == pytest.approx(
        float(regular.transmission_coefficient[0]), rel=5e-3
    )
    assert float(narrow_sea.mean_drift_force) == pytest.approx(float(regular.mean_drift_force[0]), rel=1e-2)
    significant = 2.0 * math.sqrt(2.0) * regular.motion_amplitude.values[0]
    assert narrow_sea.significant_motion.values == pytest.approx(significant, rel=1e-2)


@pytest.mark.slow
def test_same_seed_same_sea_bit_for_bit(pontoon_problem):
    sea = IrregularSea("storm", jonswap(0.02, 1.0, 3.3), duration=40.0, seed=3)
    problem = changed(
        pontoon_problem,
        environment={"sea_states": (sea,)},
        settings={"time": TimeSettings(realisations=1, lines=LineDynamics(mode="quasi_static"))},
        analyses=("statics", "time"),
    )
    first, second = (run(problem).tree["SWL/time/storm/realisation"].to_dataset() for _ in range(2))
    assert np.array_equal(first.tension.values, second.tension.values)
    other = changed(problem, environment={"sea_states": (replace(sea, seed=4),)})
    third = run(other).tree["SWL/time/storm/realisation"].to_dataset()
    assert not np.array_equal(first.tension.values, third.tension.values)


def test_steady_wind_and_current_move_the_unit(pontoon_problem):
    still = run(changed(pontoon_problem, analyses=("statics",))).tree["SWL/statics"].to_dataset()
    assert np.all(still.steady_offset.values == 0.0)
    problem = changed(
        pontoon_problem,
        breakwater={"wind_drag_coefficient": 1.2, "current_drag_coefficient": 1.5},
        environment={"wind": Wind(10.0, 0.0, 1.225), "current": uniform(0.1, 0.0)},
        analyses=("statics",),
    )
    data = run(problem).tree["SWL/statics"].to_dataset()
    wind = 0.5 * 1.225 * 1.2 * 0.986 * 0.057 * 100.0
    current = 0.5 * 1000.0 * 1.5 * 0.986 * 0.113 * 0.01
    assert float(data.steady_force[0]) == pytest.approx(wind + current, rel=1e-12)
    # the offset is that of the exact lines under that force
    unit = assemble(problem, "SWL", 0.0)
    # wind at half the freeboard, current at half the draught, both about the centre of gravity
    centre = unit.centre[1]
    about = wind * (0.5 * 0.057 - centre) + current * (-0.5 * 0.113 - centre)
    assert float(data.steady_force[2]) == pytest.approx(about, rel=1e-9)
    at = unit.mooring.force(data.steady_offset.values) - unit.mooring.force(np.zeros(3))
    restoring = unit.statics.stiffness @ data.steady_offset.values
    assert at - restoring + data.steady_force.values == pytest.approx(np.zeros(3), abs=1e-6)


def test_wind_without_its_coefficient_is_refused(pontoon_problem):
    problem = changed(pontoon_problem, environment={"wind": Wind(10.0, 0.0, 1.225)})
    with pytest.raises(InputError, match="wind_drag_coefficient"):
        run(problem)


@pytest.mark.parametrize(
    ("breakwater", "environment", "message"),
    [
        ({"mass": 200.0, "draught": None}, {}, "it sinks"),
        ({"hull": rectangle(0.38, 0.6), "draught": 0.4, "mass": None}, {}, "reaches the bed"),
        ({}, {"water": Water(math.inf, 1000.0, 9.81)}, "infinite water depth"),
        ({}, {"water_levels": (("dry", -0.5),)}, "no water"),
    ],
)
def test_impossible_units_are_refused(pontoon_problem, breakwater, environment, message):
    with pytest.raises(InputError, match=message):
        run(changed(pontoon_problem, breakwater=breakwater, environment=environment))


@pytest.mark.parametrize("domain", ["frequency", pytest.param("time", marks=pytest.mark.slow)])
def test_infinite_depth_with_springs(pontoon_problem, domain):
    round_unit = {"hull": circle(0.2), "mass": None, "draught": 0.2, "centre_of_gravity": (0.0, 0.15)}
    problem = changed(
        pontoon_problem,
        breakwater=round_unit | {"lines": springs(100.0)},
        environment={
            "water": Water(math.inf, 1000.0, 9.81),
            "sea_states": (RegularSea("waves", 0.02, (0.9,)),),
        },
        settings={"time": TimeSettings(analysed_periods=5)},
        analyses=("statics", domain),
    )
    result = run(problem)
    assert result.status == "converged", result.message
    assert np.all(np.isfinite(result.tree[f"SWL/{domain}/waves"].to_dataset().motion_amplitude.values))


@pytest.mark.slow
def test_interrupt_keeps_what_was_done(pontoon_problem, tmp_path):
    def stop_in_time_domain(what, done, total):
        if what.startswith("time domain"):
            raise KeyboardInterrupt

    result = run(pontoon_problem, stop_in_time_domain)
    assert result.status == "interrupted"
    back = read_result(result.write(tmp_path / "results.nc"))
    assert back.status == "interrupted"
    assert "motion_amplitude" in back.tree["SWL/frequency/waves"]


@pytest.mark.slow
@pytest.mark.parametrize("lid", [0.0, pytest.param(0.05, marks=pytest.mark.slow)])
def test_gap_of_a_twin_pontoon_is_reported(pontoon_problem, lid):
    hull = twin_pontoon(0.15, 0.3, 0.2, deck_thickness=0.05)
    problem = changed(
        pontoon_problem,
        breakwater={"hull": hull, "mass": None, "draught": 0.12, "gap_damping_lid": lid},
        analyses=("statics", "frequency"),
    )
    result = run(problem)
    assert result.status == "converged", result.message
    reported = [notice for notice in result.notices if notice.code == "gap-resonance"]
    assert reported and reported[0].severity == ("warning" if lid == 0.0 else "information")


@pytest.mark.slow
def test_operators_in_slightly_oblique_waves_keep_their_energy(pontoon_problem):
    # Between the frequencies of the oblique solve stand splines; their error shows in the energy of the moving body
    problem = changed(
        pontoon_problem,
        environment={"sea_states": (RegularSea("waves", 0.02, (0.9,), 0.1),)},
        analyses=("frequency",),
    )
    result = run(problem)
    assert result.status == "converged", result.message
    energy = [check.value for check in result.checks if "energy of the moving body" in check.name]
    assert max(energy) < 1e-3


@pytest.mark.slow
def test_oblique_coefficients_are_kept_and_used_again(pontoon_problem, tmp_path, monkeypatch):
    problem = changed(
        pontoon_problem,
        environment={"sea_states": (RegularSea("waves", 0.02, (0.9,), 0.4),)},
        analyses=("statics", "frequency"),
    )
    store = DatasetStore(tmp_path)
    first = run(problem, store=store)
    calls = []
    from moyai.structures.breakwater import hydrodynamics
    from moyai.structures.breakwater import run as running

    solve = hydrodynamics.solve
    monkeypatch.setattr(hydrodynamics, "solve", lambda *a, **k: calls.append(k.get("heading")) or solve(*a, **k))
    second = run(problem, store=store)
    # The normal heading is still in memory
    assert calls == []
    hydrodynamics._SOLVED.clear()
    running._HYDRODYNAMICS.clear()
    second = run(problem, store=store)
    assert calls == [None]
    ours, theirs = (result.tree["SWL/frequency/waves"].to_dataset() for result in (first, second))
    assert np.array_equal(ours.motion_amplitude.values, theirs.motion_amplitude.values)
    assert [check.name for check in first.checks] == [check.name for check in second.checks]


def test_the_largest_tension_of_linear_springs_is_their_most_probable_one(pontoon_problem):
    """Mean and deviation make it up without a slow drift: the position of the largest tension has that tension."""
    sea = IrregularSea("storm", jonswap(0.01, 1.0, 3.3), duration=1500.0, seed=5)
    problem = changed(
        pontoon_problem,
        breakwater={"lines": springs(150.0), "mass": None, "damping": Damping(0.0, linear=(20.0, 60.0, 0.5))},
        environment={"sea_states": (sea,)},
        settings={"drift": False},
        analyses=("statics", "frequency"),
    )
    found = run(problem).tree["SWL/frequency/storm"].to_dataset()
    mean = found.line_tension_mean.values
    assert found.line_tension_maximum.values - mean == pytest.approx(
        found.most_probable_maximum_tension.values - mean, rel=0.01
    )


@pytest.mark.slow
def test_transmission_of_an_irregular_sea_in_time_is_that_of_frequency_with_springs(pontoon_problem):
    # linear lines, constant damping (a fraction of critical takes another added mass in time): the record's own
    # transmission must come to the spectral one within its sampling error
    sea = IrregularSea("storm", jonswap(0.01, 1.0, 3.3), duration=1500.0, seed=5)
    problem = changed(
        pontoon_problem,
        breakwater={
            "lines": springs(150.0),
            "mass": None,
            "damping": Damping(0.0, linear=(20.0, 60.0, 0.5)),
        },
        environment={"sea_states": (sea,)},
    )
    tree = run(problem).tree
    time, frequency = (tree[f"SWL/{name}/storm"].to_dataset() for name in ("time", "frequency"))
    for name in ("transmission_coefficient", "reflection_coefficient"):
        assert float(time[name]) == pytest.approx(float(frequency[name]), rel=0.03)
        assert float(time[name]) != float(frequency[name])


@pytest.mark.parametrize("count", [60, 200, 900])
def test_frequencies_of_a_spectrum_carry_its_energy(count):
    # points crowd at the peak; thinning them must leave no gap there
    from moyai.structures.breakwater.hydrodynamics import spectrum_band

    sea = IrregularSea("storm", jonswap(1.0, 5.0, 7.0))
    omega = spectrum_band(sea, count)
    energy = np.trapezoid(sea.spectrum.density_at(omega), omega)
    assert 4.0 * math.sqrt(energy) == pytest.approx(1.0, rel=6e-3)


@pytest.mark.parametrize("exponent", [2.0, 30.0, 400.0])
@pytest.mark.parametrize("heading", [0.0, -0.2, 0.7])
def test_spreading_keeps_the_energy_however_narrow(exponent, heading):
    from moyai.sea.directional import CosineTwoS
    from moyai.structures.breakwater.hydrodynamics import spread_headings

    spreading = CosineTwoS(exponent)
    sea = IrregularSea("spread", jonswap(1.0, 5.0, 3.3), heading=heading, spreading=spreading)
    headings, share = spread_headings(sea, np.array([1.0, 1.3]))
    limit = math.radians(75.0)
    inside = np.diff(spreading.cumulative(np.array([-limit - heading, limit - heading]), np.array([1.3])))[0]
    assert share.sum(axis=1) == pytest.approx(float(inside), abs=1.5e-3)
    assert np.all(share >= 0.0) and np.all(np.diff(headings) > 0.0)


@pytest.mark.slow
def test_mean_drift_of_a_spread_sea_is_the_sum_over_its_waves(pontoon_problem, monkeypatch):
    # springs, so that the offset changes nothing: the drift must be that of regular waves summed over the sea
    from moyai.sea.directional import CosineTwoS
    from moyai.structures.breakwater import hydrodynamics

    monkeypatch.setattr(hydrodynamics, "OBLIQUE_FREQUENCIES", 20)
    spreading = CosineTwoS(12.0)
    sea = IrregularSea("spread", jonswap(0.02, 1.0, 3.3), heading=-0.3, spreading=spreading)
    base = changed(
        pontoon_problem,
        breakwater={"lines": springs(150.0), "mass": None, "damping": Damping(0.0, linear=(20.0, 60.0, 0.5))},
        analyses=("statics", "frequency"),
    )
    spread = run(changed(base, environment={"sea_states": (sea,)})).tree["SWL/frequency/spread"].to_dataset()
    periods = tuple(2.0 * np.pi / np.concatenate([np.linspace(4.0, 12.0, 13), np.linspace(13.0, 33.0, 5)]))
    angles = np.linspace(-1.2, 1.2, 7)
    seas = tuple(RegularSea(f"h{index}", 0.002, periods, float(angle)) for index, angle in enumerate(angles))
    tree = run(changed(base, environment={"sea_states": seas})).tree
    total = 0.0
    omega = 2.0 * np.pi / tree["SWL/frequency/h0"].to_dataset().period.values
    order = np.argsort(omega)
    density = sea.spectrum.density_at(omega[order])
    for index, angle in enumerate(angles):
        force = tree[f"SWL/frequency/h{index}"].to_dataset().mean_drift_force.values[order] / 0.001**2
        directional = spreading.density(angle - sea.heading, omega[order])
        total += float(np.trapezoid(2.0 * density * directional * force, omega[order])) * (angles[1] - angles[0])
    assert float(spread.mean_drift_force) == pytest.approx(total, rel=0.03)


@pytest.mark.slow
def test_oblique_regular_waves_in_time_are_those_of_frequency_with_springs(pontoon_problem):
    sea = RegularSea("oblique", 0.003, (0.8, 1.1), -0.7)
    problem = changed(
        pontoon_problem, breakwater={"lines": springs(150.0), "mass": None}, environment={"sea_states": (sea,)}
    )
    tree = run(problem).tree
    time, frequency = (tree[f"SWL/{name}/oblique"].to_dataset() for name in ("time", "frequency"))
    assert time.motion_amplitude.values == pytest.approx(frequency.motion_amplitude.values, rel=4e-3, abs=1e-7)
    assert time.transmission_coefficient.values == pytest.approx(frequency.transmission_coefficient.values, abs=5e-3)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("hull", "draught"),
    [
        pytest.param(trapezoid(0.8, 0.4, 0.3), 0.2, marks=pytest.mark.slow),
        (circle(0.2), 0.26),
        pytest.param(circle(0.2), 0.33, marks=pytest.mark.slow),
    ],
)
def test_sections_that_narrow_upwards_have_a_memory(pontoon_problem, hull, draught):
    problem = changed(
        pontoon_problem,
        breakwater={"hull": hull, "mass": None, "draught": draught, "centre_of_gravity": (0.0, 0.1)},
        environment={"water": Water(0.8, 1000.0, 9.81), "sea_states": (RegularSea("waves", 0.002, (1.0,)),)},
    )
    problem = changed(problem, breakwater={"lines": springs(150.0)})
    result = run(problem)
    assert result.status in ("converged", "outside_validity"), result.message
    assert all(check.passed for check in result.checks), [check for check in result.checks if not check.passed]


def test_drag_of_a_taut_line_is_that_of_a_rod_hinged_at_its_foot(pontoon_problem):
    # velocity across grows evenly from the anchor: the integral of s^3 gives a quarter of the full drag
    from moyai.mooring.lines import LineType, Segment
    from moyai.structures.breakwater.lines.drag import line_drag_rows
    from moyai.structures.breakwater.model import MooringLine

    rope = LineType("rope", 1e-3, 5e3)
    line = MooringLine("tether", 3, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (Segment(rope, 0.26),), drag_width=0.02)
    problem = changed(pontoon_problem, breakwater={"lines": (line,), "mass": None})
    unit = assemble(problem, "SWL", 0.0)
    rows, coefficients = line_drag_rows(unit)
    length = 0.38 - 0.113
    whole = 0.5 * 1000.0 * 0.02 * 3 * length
    assert coefficients.sum() == pytest.approx(whole, rel=1e-3)
    assert float(np.sum(coefficients * np.abs(rows[:, 0]) ** 3)) == pytest.approx(whole / 4.0, rel=0.01)


@pytest.mark.slow
def test_line_drag_damps_in_both_domains(pontoon_problem):
    dragged = tuple(replace(line, drag_width=0.05) for line in pontoon_problem.breakwater.lines)
    bare, with_drag = (
        run(changed(pontoon_problem, breakwater={"lines": lines, "damping": Damping(0.02)})).tree
        for lines in (pontoon_problem.breakwater.lines, dragged)
    )
    for domain in ("frequency", "time"):
        before, after = (
            tree[f"SWL/{domain}/waves"].to_dataset().dissipation.sel(period=1.0) for tree in (bare, with_drag)
        )
        assert float(after) > float(before) * 1.02
