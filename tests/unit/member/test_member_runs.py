"""Whole members in waves: closed forms, limits, symmetry, growth from calm, irregular against regular."""

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from moyai.core.errors import InputError
from moyai.morison import sections
from moyai.morison.circulation import CirculationLaw
from moyai.morison.coefficients import CoefficientRule
from moyai.morison.members import StraightMember
from moyai.sea import current as currents
from moyai.sea import spectra
from moyai.sea.dispersion import wave_number
from moyai.sea.environment import Environment
from moyai.sea.states import IrregularSea
from moyai.sea.water import Water
from moyai.structures.member.checks import require_in_water
from moyai.structures.member.march import _effective, march
from moyai.structures.member.model import HarmonicMotion, MemberProblem, MemberSettings, MemberWaves
from moyai.structures.member.run import run
from moyai.structures.member.surface import surface_effect
from moyai.structures.member.waves import waves_of

TANK = Water(0.5, 1000.0, 9.81)
PERIOD = 1.0 / 0.95


def horizontal(section, depth=0.093, length=0.79):
    return StraightMember((0.0, -0.5 * length, -depth), (0.0, 0.5 * length, -depth), section)


def problem(member, seas, water=TANK, **options):
    defaults = {
        "rule": CoefficientRule((0.0, 0.0)),
        "kinematic_viscosity": 1.14e-6,
        "settings": MemberSettings(("forces",), 6),
    }
    return MemberProblem("test", member, environment=Environment(water), seas=seas, **{**defaults, **options})


def forces(case, level=0.0):
    (wave,) = waves_of(case, case.seas[0], case.environment.water_at(level))
    return march(case, case.member_at(level), wave)


@pytest.mark.parametrize("seed", range(3))
def test_inertia_force_on_an_upright_pile_is_the_closed_form(seed):
    """C_M rho A omega^2 (H/2) / k up to still water: tanh kh of MacCamy's slender limit, small waves."""
    rng = np.random.default_rng(seed)
    water = Water(rng.uniform(5, 40), 1025.0, 9.81)
    period, height, diameter = rng.uniform(4, 12), 1e-4, rng.uniform(0.3, 2)
    member = StraightMember((0, 0, -water.depth), (0, 0, 0.0), sections.circle(diameter))
    case = problem(member, (MemberWaves("a", (height,), (period,)),), water, settings=MemberSettings(("forces",), 400))
    found = forces(case)
    number = float(wave_number(2 * math.pi / period, water.depth, water.gravity))
    omega = 2 * math.pi / period
    exact = 2.0 * water.density * math.pi / 4 * diameter**2 * omega**2 * 0.5 * height / number
    # the midpoint rule over 400 strips
    assert np.abs(found.force[0, :, 0]).max() == pytest.approx(exact, rel=2e-4)
    assert np.abs(found.force[0, :, 1]).max() < 1e-9 * exact


@pytest.mark.parametrize("seed", range(3))
def test_drag_force_on_an_upright_pile_is_the_closed_form(seed):
    """rho C_D D (u at the surface)^2 (sinh 2kh + 2kh) / (16 k sinh^2 kh) H^2 omega^2 / 2, small waves."""
    rng = np.random.default_rng(10 + seed)
    water = Water(rng.uniform(5, 30), 1025.0, 9.81)
    period, height, drag, diameter = rng.uniform(4, 12), 1e-4, rng.uniform(0.5, 2), 0.5
    member = StraightMember((0, 0, -water.depth), (0, 0, 0.0), sections.circle(diameter))
    case = problem(
        member,
        (MemberWaves("a", (height,), (period,)),),
        water,
        settings=MemberSettings(("forces",), 400),
        rule=CoefficientRule((drag, drag), (0.0, 0.0)),
    )
    found = forces(case)
    omega = 2 * math.pi / period
    k = float(wave_number(omega, water.depth, water.gravity))
    q = 2.0 * k * water.depth
    mean_square = (math.sinh(q) + q) / (4.0 * k * math.sinh(0.5 * q) ** 2)
    exact = 0.5 * water.density * drag * diameter * (0.5 * height * omega) ** 2 * mean_square
    assert np.abs(found.force[1, :, 0]).max() == pytest.approx(exact, rel=5e-4)


@pytest.mark.parametrize("seed", range(3))
def test_a_turned_site_turns_the_forces(seed):
    """Member, waves and current turned together about the vertical: the force turns with them."""
    rng = np.random.default_rng(seed)
    water = Water(20.0, 1025.0, 9.81)
    angle = rng.uniform(-3, 3)
    turn = np.array([[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1.0]])
    start, end = rng.uniform(-5, 5, 3) - [0, 0, 9.0], rng.uniform(-5, 5, 3) - [0, 0, 8.0]
    found = []
    for matrix, heading in ((np.eye(3), 0.4), (turn, 0.4 + angle)):
        member = StraightMember(tuple(matrix @ start), tuple(matrix @ end), sections.circle(0.8))
        current = currents.power_law(0.5, 1 / 7, heading + 0.3, water)
        case = replace(
            problem(member, (MemberWaves("a", (2.0,), (7.0,), heading),), water),
            environment=Environment(water, current=current),
            rule=CoefficientRule((1.0, 1.0)),
            form="vector",
            circulation=CirculationLaw(purpose="response"),
        )
        found.append(forces(case).force.sum(axis=0))
    assert found[1] == pytest.approx(found[0] @ turn.T, abs=1e-6 * np.abs(found[0]).max())


def test_strips_converge_with_second_order_on_an_inclined_member():
    water = Water(20.0, 1025.0, 9.81)
    member = StraightMember((-4, -2, -15), (3, 1, -2), sections.circle(0.7))
    seas = (MemberWaves("a", (3.0,), (7.0,), 0.5),)
    sums = {}
    for count in (5, 10, 20, 320):
        case = problem(
            member, seas, water, rule=CoefficientRule((1.0, 1.0)), settings=MemberSettings(("forces",), count)
        )
        sums[count] = forces(case).force.sum(axis=0)
    errors = [np.abs(sums[count] - sums[320]).max() for count in (5, 10, 20)]
    assert errors[0] / errors[1] > 3.5
    assert errors[1] / errors[2] > 3.5


@pytest.mark.parametrize(
    "section", [sections.circle(0.045), sections.rectangle(0.045, 0.045), sections.rectangle(0.045, 0.024)]
)
def test_effective_inertia_is_the_ideal_one_less_the_law(section):
    """From the computed forces, not from the formula: projection on the acceleration."""
    case = problem(
        horizontal(section),
        (MemberWaves("a", (0.015,), (PERIOD,), theory="linear"),),
        circulation=CirculationLaw(purpose="response"),
        settings=MemberSettings(("forces",), 6, stretching="constant"),
    )
    found = forces(case)
    first, second = found.strip["velocity_first"][0], found.strip["velocity_second"][0]
    gamma = 18.0e-4 / (0.95 * 0.045**2) * first * second * PERIOD
    fall = gamma / (2 * math.pi / PERIOD * section.area) * np.array([second / first, first / second])
    assert found.strip["effective_inertia"][0] == pytest.approx(np.diagonal(section.inertia.tensor) - fall, rel=1e-9)
    assert found.strip["circulation"][0] == pytest.approx(gamma, rel=1e-9)


def test_extreme_design_leaves_the_circulation_out_and_is_never_below_response():
    section = sections.circle(0.045)
    largest = {}
    for purpose in ("extreme", "response"):
        case = problem(
            horizontal(section), (MemberWaves("a", (0.03,), (PERIOD,)),), circulation=CirculationLaw(purpose=purpose)
        )
        found = forces(case)
        largest[purpose] = np.linalg.norm(found.force.sum(axis=0), axis=1).max()
        if purpose == "extreme":
            assert np.all(found.force[2] == 0.0)
            assert found.strip["settled_circulation"][0] > 0.0
    assert largest["response"] < largest["extreme"]


def test_force_tends_to_morison_as_the_wave_falls():
    """(F_response - F_extreme)/F_extreme falls like KC^2."""
    ratios = []
    for height in (0.02, 0.002, 0.0002):
        case = problem(horizontal(sections.circle(0.045)), (MemberWaves("a", (height,), (PERIOD,)),))
        plain = forces(case).force.sum(axis=0)
        with_it = forces(replace(case, circulation=CirculationLaw(purpose="response"))).force.sum(axis=0)
        ratios.append(np.abs(with_it - plain).max() / np.abs(plain).max())
    assert ratios[1] / ratios[0] == pytest.approx(0.01, rel=0.05)
    assert ratios[2] / ratios[1] == pytest.approx(0.01, rel=0.05)


def test_circulation_grows_from_calm_like_an_exponential():
    law = CirculationLaw(purpose="response", start="calm", relaxation_periods=3.0)
    case = problem(horizontal(sections.circle(0.045)), (MemberWaves("a", (0.01,), (PERIOD,)),), circulation=law)
    found = forces(case)
    settled = found.strip["settled_circulation"][found.governing]
    exact = settled * -np.expm1(-found.time / (3.0 * PERIOD))
    assert np.abs(found.circulation - exact).max() < 2e-3 * settled
    assert found.time[-1] > 20 * PERIOD


def test_waves_from_the_other_side_turn_the_circulation_round():
    case = problem(
        horizontal(sections.circle(0.045)),
        (MemberWaves("a", (0.01,), (PERIOD,)),),
        circulation=CirculationLaw(purpose="response"),
    )
    back = replace(case, seas=(MemberWaves("a", (0.01,), (PERIOD,), math.pi),))
    ahead, behind = forces(case), forces(back)
    assert behind.circulation[0] == pytest.approx(-ahead.circulation[0], rel=1e-6)
    assert np.abs(behind.force).max(axis=1) == pytest.approx(np.abs(ahead.force).max(axis=1), rel=1e-6, abs=1e-12)


def test_an_upright_pile_in_long_crests_has_no_circulation():
    """Its orbits are planar: u to and fro, nothing across."""
    water = Water(10.0, 1025.0, 9.81)
    member = StraightMember((0, 0, -9.0), (0, 0, -2.0), sections.circle(0.5))
    case = problem(member, (MemberWaves("a", (0.4,), (6.0,)),), water, circulation=CirculationLaw(purpose="response"))
    found = forces(case)
    assert np.abs(found.force[2]).max() < 1e-9 * np.abs(found.force[0]).max()


@pytest.mark.slow
def test_a_narrow_sea_behaves_like_its_regular_wave():
    """Irregular sea of a very narrow band: the same share of reduction as a regular wave of its rms height."""
    water, section = Water(40.0, 1025.0, 9.81), sections.circle(1.0)
    member = StraightMember((0, -5, -6), (0, 5, -6), section)
    omega = np.linspace(0.98, 1.02, 41) * 2 * math.pi / 6.0
    density = np.full(41, 0.2**2 / 16 / (omega[-1] - omega[0]))
    spectrum = spectra.from_table(omega / (2 * math.pi), density * 2 * math.pi)
    law = CirculationLaw(purpose="response")
    case = problem(member, (IrregularSea("s", spectrum, 0.0, None, 3600.0, 3),), water, circulation=law)
    found = forces(case)
    fall = 2.0 - found.strip["effective_inertia"][0]
    strength = found.strip["keulegan_carpenter"][0]
    # averaged with the weight of the acceleration: <a^4> = 2 <a^2>^2 of a Gaussian sea, less what the lag loses
    lower, upper = 1.0 * 0.936 * 2 / math.pi**2 * strength**2, 2.0 * 0.936 * 2 / math.pi**2 * strength**2
    assert lower < fall[0] < 1.05 * upper
    assert fall[0] == pytest.approx(fall[1], rel=0.02)


@pytest.mark.slow
def test_long_irregular_run_of_a_short_crested_sea_stays_finite_and_small():
    from moyai.sea import directional

    water = Water(20.0, 1025.0, 9.81)
    sea = IrregularSea("s", spectra.jonswap(1.0, 6.0, 3.3), 0.3, directional.CosineTwoS(10.0), 900.0, 5)
    member = StraightMember((-3, -8, -5), (3, 8, -3), sections.rectangle(0.8, 0.5), section_angle=0.4)
    case = problem(
        member, (sea,), water, rule=CoefficientRule((2.0, 1.8)), circulation=CirculationLaw(purpose="response")
    )
    result = run(case)
    assert result.status == "converged"
    data = result.tree["/SWL/waves/s"]
    share = data["circulation"].values / data["laminar_circulation"].values
    assert 0.0 < share[0] < 1.0
    assert np.isfinite(result.tree["/SWL/time/s/sea"]["force"].values).all()


def test_motion_with_the_water_leaves_the_froude_krylov_force():
    """A neutrally light member that follows the orbit at its axis: rho A a on a short member, no drag, no Magnus."""
    water = Water(math.inf, 1000.0, 9.81)
    member = StraightMember((0, -0.5, -3), (0, 0.5, -3), sections.circle(0.4))
    omega = 2 * math.pi / 5.0
    k = omega**2 / 9.81
    reach = 0.25 * math.exp(-3 * k)
    # eta = a cos(omega t): x follows reach sin(omega t), z follows reach cos(omega t)
    motion = HarmonicMotion((reach, 0.0, reach), (math.radians(90.0), 0.0, 0.0))
    case = problem(
        member,
        (MemberWaves("a", (0.5,), (5.0,), theory="linear"),),
        water,
        rule=CoefficientRule((1.0, 1.0)),
        motion=motion,
        circulation=CirculationLaw(purpose="response"),
        settings=MemberSettings(("forces",), 1, stretching="constant"),
    )
    found = forces(case)
    assert np.abs(found.force[1:]).max() < 1e-9 * np.abs(found.force[0]).max()
    exact = 1000.0 * math.pi * 0.04 * omega**2 * reach
    assert np.abs(found.force[0, :, 2]).max() == pytest.approx(exact, rel=1e-6)


def test_steady_current_alone_gives_the_drag_of_the_normal_component():
    """Tiny waves: F = rho C_D D U_n |U_n| l / 2 across an oblique level member."""
    water = Water(20.0, 1025.0, 9.81)
    angle = 0.7
    member = StraightMember((0, 0, -5), (10 * math.sin(angle), 10 * math.cos(angle), -5), sections.circle(0.5))
    case = replace(
        problem(member, (MemberWaves("a", (1e-6,), (6.0,)),), water, rule=CoefficientRule((1.2, 1.2))),
        environment=Environment(water, current=currents.uniform(0.9, 0.0)),
    )
    found = forces(case).force.sum(axis=0).mean(axis=0)
    normal = 0.9 * math.cos(angle)
    exact = 0.5 * 1025.0 * 1.2 * 0.5 * normal**2 * 10.0
    assert found[:2] == pytest.approx(exact * np.array([math.cos(angle), -math.sin(angle)]), rel=1e-4)


def test_finite_wave_tends_to_the_linear_one():
    water = Water(10.0, 1025.0, 9.81)
    member = StraightMember((0, -1, -3), (0, 1, -3), sections.circle(0.5))
    found = {}
    for theory in ("linear", "stokes", "stream_function"):
        case = problem(
            member, (MemberWaves("a", (0.01,), (6.0,), 0.0, theory),), water, rule=CoefficientRule((1.0, 1.0))
        )
        found[theory] = forces(case).force.sum(axis=0)
    for theory in ("stokes", "stream_function"):
        assert np.abs(found[theory] - found["linear"]).max() < 5e-3 * np.abs(found["linear"]).max()


def test_exposure_counts_only_what_is_wet():
    water = Water(10.0, 1025.0, 9.81)
    low = StraightMember((0, 0, -9), (0, 0, -0.5), sections.circle(0.5))
    high = StraightMember((0, 0, -9), (0, 0, 8.0), sections.circle(0.5))
    seas = (MemberWaves("a", (1.0,), (6.0,)),)
    rule = CoefficientRule((1.0, 1.0))
    settings = MemberSettings(("forces",), 340)
    wet = forces(problem(high, seas, water, rule=rule, settings=settings))
    deep = forces(problem(low, seas, water, rule=rule, settings=settings))
    assert wet.strip["wet"][-1] == 0.0
    assert np.abs(wet.force).max() > np.abs(deep.force).max()
    # at the crest the column reaches above still water, at the trough it ends below: the mean drag is onwards
    assert wet.force[1, :-1, 0].mean() > 0.0


def test_effective_inertia_of_a_regular_wave_is_that_of_one_period():
    """What is steady, or a harmonic of its own, shares nothing with the acceleration over one period."""
    time = np.linspace(0.0, 2.0, 41)
    acceleration = np.cos(math.pi * time)[:, None, None] * np.ones((1, 3, 2))
    wave = SimpleNamespace(time=time, regular=True)
    block = SimpleNamespace(acceleration=acceleration, body_acceleration=np.zeros((1, 1, 2)))
    problem = SimpleNamespace(environment=SimpleNamespace(water=Water(10.0, 1025.0, 9.81)))
    steady = (0.7 + np.sin(math.pi * time) + np.cos(2.0 * math.pi * time))[:, None, None] * np.ones((1, 3, 2))
    found = _effective(problem, 0.3, block, 1.6 * 1025.0 * 0.3 * acceleration, 200.0 * steady, wave)
    assert found == pytest.approx(np.full((3, 2), 1.6), rel=1e-12)


def test_effective_inertia_of_a_moving_member_counts_from_the_water_that_goes_past_it():
    """rho A (a_body + C (a - a_body)): the water's own push on what moves with it is no inertia of the coefficient."""
    rng = np.random.default_rng(12)
    time = np.linspace(0.0, 2.0, 41)
    acceleration, own = rng.normal(size=(41, 3, 2)), rng.normal(size=(41, 1, 2))
    wave = SimpleNamespace(time=time, regular=False)
    block = SimpleNamespace(acceleration=acceleration, body_acceleration=own)
    problem = SimpleNamespace(environment=SimpleNamespace(water=Water(10.0, 1025.0, 9.81)))
    force = 1025.0 * 0.3 * (own + 1.7 * (acceleration - own))
    found = _effective(problem, 0.3, block, force, np.zeros((41, 3, 2)), wave)
    assert found == pytest.approx(np.full((3, 2), 1.7), rel=1e-12)


def test_surface_effect_fades_with_depth():
    """Inertia under the surface tends to the ideal one, radiation to nothing, like the decay of the wave."""
    section = sections.rectangle(0.045, 0.024)
    water = Water(2.0, 1000.0, 9.81)
    period = 1.25
    near = surface_effect(section, 0.06, water, np.array([period]))
    far = surface_effect(section, 0.8, water, np.array([period]))
    assert np.abs(near.change).max() > 0.02
    assert np.abs(far.change).max() < 0.004
    # the waves that it makes fall like e^{-kd}, their energy like its square
    k = float(wave_number(2.0 * math.pi / period, 2.0, 9.81))
    assert far.radiation[0, 1] / near.radiation[0, 1] == pytest.approx(math.exp(-2.0 * k * 0.74), rel=0.3)


def test_run_warns_and_places_its_groups():
    case = problem(
        horizontal(sections.circle(0.045)),
        (MemberWaves("tank", (0.01, 0.05, 0.08), (PERIOD,)),),
        circulation=CirculationLaw(purpose="response"),
        settings=MemberSettings(("sweep", "forces", "surface"), 2),
    )
    result = run(case)
    codes = {notice.code for notice in result.notices}
    assert {"circulation-held", "circulation-beyond-law", "near-surface-inertia"} <= codes
    assert set(result.tree["/SWL"].children) == {"member", "sweep", "waves", "time", "surface"}
    data = result.tree["/SWL/sweep"]
    at = data.sel(keulegan_carpenter=1.0, method="nearest")
    assert float(at["chaplin_inertia_coefficient"][0]) == pytest.approx(2.0 - 0.21)
    beta = 0.045**2 / (PERIOD * 1.14e-6)
    assert float(at["planar_inertia_coefficient"][0]) == pytest.approx(2.0 + 4.0 / math.sqrt(math.pi * beta), rel=1e-5)
    assert all(check.passed for check in result.checks)


def test_current_with_circulation_warns():
    case = replace(
        problem(
            horizontal(sections.circle(0.045)),
            (MemberWaves("a", (0.01,), (PERIOD,)),),
            circulation=CirculationLaw(purpose="response"),
        ),
        environment=Environment(TANK, current=currents.uniform(0.05, 0.0)),
    )
    assert "circulation-with-current" in {notice.code for notice in run(case).notices}


@pytest.mark.parametrize(
    ("ends", "words"),
    [(((0, -1, 0.2), (0, 1, 0.2)), "above the still water"), (((0, -1, -0.1), (0, 1, -0.6)), "below the bed")],
)
def test_members_out_of_the_water_are_refused(ends, words):
    member = StraightMember(*ends, sections.circle(0.045))
    with pytest.raises(InputError, match=words):
        run(problem(member, (MemberWaves("a", (0.01,), (PERIOD,)),)))


def test_interrupt_hands_back_what_is_there():
    def listener(what, done, total):
        if what.startswith("forces") and done == 1:
            raise KeyboardInterrupt

    case = problem(horizontal(sections.circle(0.045)), (MemberWaves("a", (0.01, 0.02, 0.03), (PERIOD,)),))
    result = run(case, listener)
    assert result.status == "interrupted"
    # those that ended beside the first are kept too
    assert result.tree["/SWL/waves/a"].sizes["wave"] >= 1


@pytest.mark.parametrize("seed", range(3))
def test_forces_do_not_depend_on_where_the_outline_of_a_section_is_drawn(seed):
    """Moving the points of a polygon and the axis the other way leaves the body, and its loads, where they were."""
    rng = np.random.default_rng(700 + seed)
    points = rng.uniform(-0.5, 0.5, (3, 2))
    shift = rng.uniform(-1.0, 1.0, 2)
    ends = np.array([[-1.0, -4.0, -0.4], [2.0, 3.0, rng.uniform(-0.6, 0.1)]])
    plain = StraightMember(tuple(ends[0]), tuple(ends[1]), sections.polygon(points), rng.uniform(-1, 1))
    turn = plain.section_angle
    turned = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]]) @ shift
    moved = ends - (turned[:, None] * plain.axes[:2]).sum(axis=0)
    other = StraightMember(tuple(moved[0]), tuple(moved[1]), sections.polygon(points + shift), turn)
    seas = (MemberWaves("a", (0.5,), (4.0,), 0.3),)
    options = {"rule": CoefficientRule((1.1, 0.9)), "circulation": CirculationLaw(purpose="response")}
    first, second = (forces(problem(one, seas, Water(6.0, 1000.0, 9.81), **options)) for one in (plain, other))
    assert 0.0 < first.strip["wet"].min() < first.strip["wet"].max() <= 1.0
    assert second.strip["wet"] == pytest.approx(first.strip["wet"], abs=1e-12)
    assert np.abs(second.force - first.force).max() < 1e-6 * np.abs(first.force).max()
    assert other.highest == pytest.approx(plain.highest) and other.lowest == pytest.approx(plain.lowest)


def test_a_section_drawn_above_its_axis_reaches_the_surface():
    """A triangle of three metres on an axis two metres down stands a metre out of the water."""
    member = horizontal(sections.polygon([(-1, 0), (1, 0), (0, 3)]), depth=2.0)
    assert member.highest == pytest.approx(1.0) and member.lowest == pytest.approx(-2.0)
    assert member.strips(1).centres[0, 2] == pytest.approx(-1.0)
    assert member.strips(1).wet_share(np.array([[-2.0, 1.0, -0.5]]).T)[:, 0] == pytest.approx([0.0, 1.0, 0.5])
    arc = sections.polygon([(1, 0), (-1, 0)], [1.0, 0.0])
    assert arc.contour.centroid == pytest.approx((0.0, 4.0 / (3.0 * math.pi)))


def test_a_power_law_current_reaches_the_bed_at_every_water_level():
    """Above datum the profile stretches with the depth: its mean is U / (1 + exponent) at each level."""
    water = Water(12.0, 1025.0, 9.81)
    member = StraightMember((0, 0, -12.0), (0, 0, 3.0), sections.circle(1.0))
    case = problem(member, (MemberWaves("a", (1e-6,), (8.0,)),), water, rule=CoefficientRule((1.0, 1.0)))
    environment = Environment(water, (("HWL", 2.0), ("LWL", -1.0)), (), None, currents.power_law(0.8, 0.2, 0.0, water))
    case = replace(case, environment=environment, settings=MemberSettings(("forces",), 600))
    for level in (2.0, -1.0):
        depth = 12.0 + level
        exact = 0.5 * 1025.0 * 0.8**2 * depth / 1.4
        cut = replace(case, member=StraightMember((0, 0, -12.0), (0, 0, level), sections.circle(1.0)))
        found = forces(cut, level)
        # the midpoint rule near the bed, where the square of the current has a steep end
        assert found.force[1, 0, 0] == pytest.approx(exact, rel=2e-3)


def test_a_flat_orbit_is_reported_whatever_its_tilt():
    """Waves along a brace leaning at 45 degrees to them: both components equal, the orbit a line."""
    member = StraightMember((0, 0, -3.0), (0.4, 0.4, 0.2), sections.circle(0.1))
    case = problem(
        member,
        (MemberWaves("a", (0.05,), (2.0,), math.radians(60)),),
        Water(1.2e3, 1000.0, 9.81),
        circulation=CirculationLaw(purpose="response"),
    )
    found = forces(case)
    axes = member.axes[:2]
    # circular orbits in the vertical plane of the waves, projected: the ratio of the singular values
    plane = np.array([[math.cos(math.radians(60)), math.sin(math.radians(60)), 0.0], [0.0, 0.0, 1.0]])
    sizes = np.linalg.svd(axes @ plane.T, compute_uv=False)
    assert found.strip["orbit_ratio"][found.governing] == pytest.approx(sizes[1] / sizes[0], rel=1e-2)


def test_what_is_shown_without_circulation_is_what_the_inertia_force_shows():
    """Of a turned rectangle both axes are coupled: without circulation both coefficients agree, coupling included."""
    section = sections.rectangle(1.0, 0.3)
    member = StraightMember((0, -2.0, -3.0), (0, 2.0, -3.0), section, 0.6)
    seas = (MemberWaves("a", (0.3,), (4.0,)),)
    still = forces(problem(member, seas, Water(8.0, 1000.0, 9.81)))
    assert still.strip["effective_inertia"] == pytest.approx(still.strip["plain_inertia"], rel=1e-12)
    turned = problem(member, seas, Water(8.0, 1000.0, 9.81), circulation=CirculationLaw(purpose="response"))
    fall = forces(turned).strip["plain_inertia"] - forces(turned).strip["effective_inertia"]
    assert (fall > 0.0).all()


def test_a_reduction_larger_than_the_inertia_is_reported():
    """On a plate standing in the waves the law takes more than the coefficient of 1.1 along its thin side."""
    case = problem(
        StraightMember((0, -2.0, -3.0), (0, 2.0, -3.0), sections.rectangle(0.5, 0.04)),
        (MemberWaves("a", (0.4,), (4.0,)),),
        Water(30.0, 1000.0, 9.81),
        circulation=CirculationLaw(purpose="response"),
    )
    notices = {notice.code: notice for notice in run(case).notices}
    assert "first axis" in notices["circulation-exceeds-inertia"].message


def test_planar_flow_past_a_pile_is_not_beyond_a_law_of_orbits():
    member = StraightMember((0, 0, -8.0), (0, 0, 2.0), sections.circle(0.5))
    law = CirculationLaw(purpose="response")
    case = problem(member, (MemberWaves("a", (1.5,), (8.0,)),), Water(8.0, 1000.0, 9.81), circulation=law)
    found = run(case)
    assert not {"circulation-held", "circulation-beyond-law"} & {notice.code for notice in found.notices}
    assert float(found.tree["SWL/waves/a"]["circulation"].values[0]) == 0.0
    leaning = StraightMember((0, 0, -8.0), (0, 6.0, 2.0), sections.circle(0.5))
    assert "circulation-beyond-law" in {notice.code for notice in run(replace(case, member=leaning)).notices}


def test_leaning_members_may_stand_on_the_bed_and_level_ones_may_not_lie_in_it():
    water, section = Water(8.0, 1000.0, 9.81), sections.circle(0.5)
    require_in_water(StraightMember((0, 0, -8.0), (0, 6.0, 2.0), section), water, "SWL")
    require_in_water(StraightMember((0, 0, -7.75), (0, 6.0, -7.75), section), water, "SWL")
    for start, end in (((0, 0, -8.1), (0, 6.0, 2.0)), ((0, 0, -7.8), (0, 6.0, -7.8))):
        with pytest.raises(InputError, match="below the bed"):
            require_in_water(StraightMember(start, end, section), water, "SWL")


def test_reynolds_numbers_out_of_a_law_are_reported_once_with_their_range():
    from moyai.core.validity import Notice
    from moyai.structures.member.run import _one_reynolds

    notices = [Notice("other", "x")]
    notices += [Notice("drag-reynolds", f"{sea}: here Re = {value:.2g}", value, 1e6) for sea, value in
                (("calm", 5e4), ("storm", 3.7e5), ("swell", 9e4))]  # fmt: skip
    dry = (("wave", "strip"), [[1.0, 0.0]])
    sea = xr.Dataset({"strip_reynolds": (("wave", "strip"), [[6e5, 9e9]]), "wet_share": dry})
    calm = xr.Dataset({"strip_reynolds": (("wave", "strip"), [[4e4, 1.0]]), "wet_share": dry})
    kept = _one_reynolds(notices, {"/SWL/waves/storm": sea, "/SWL/waves/calm": calm})
    assert [notice.code for notice in kept] == ["other", "drag-reynolds"]
    # the farthest beyond the limit is kept; strips that are never wet do not count
    assert kept[1].message == "calm: here Re = 5e+04; over all waves and strips 4e+04 to 6e+05"
    assert kept[1].value == 5e4 and _one_reynolds(notices[:1], {}) == notices[:1]
