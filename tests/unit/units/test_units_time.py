"""The row in time: memory, steps, connectors that come tight, lines, against programs and sums of their own."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from moyai.core.progress import silent
from moyai.flexible import BarType
from moyai.mooring import LineType, Segment, SpringLine
from moyai.sea.components import WaveComponents
from moyai.sea.environment import Environment
from moyai.sea.states import RegularSea
from moyai.structures.units.assembly import assemble
from moyai.structures.units.bem import panels_of
from moyai.structures.units.datasets import regular_dataset, with_damping_band
from moyai.structures.units.drift import share_drift
from moyai.structures.units.headlines import _with_opening
from moyai.structures.units.hydrodynamics import solve_row
from moyai.structures.units.largest import each_of
from moyai.structures.units.mesh import row_mesh
from moyai.structures.units.model import Connector, Curve, UnitLine, UnitSettings, UnitTimeSettings
from moyai.structures.units.response import RowModel, respond
from moyai.structures.units.seas import regular_answer
from moyai.structures.units.time import damping as damping_in_time
from moyai.structures.units.time import seas as seas_in_time
from moyai.structures.units.time.analysis import SeaInTime, sea_in_time
from moyai.structures.units.time.damping import curves_matter, with_ends_in_time
from moyai.structures.units.time.datasets import run_numbers
from moyai.structures.units.time.kernel import joint_force
from moyai.structures.units.time.lines import Carried, events_of, moving_line, rerun, rerun_events
from moyai.structures.units.time.memory import _Basis, _passive, _residues, fit_row_memory
from moyai.structures.units.time.model import RowInTime, step_weights
from moyai.structures.units.time.seas import (
    REPEATING,
    SeaRun,
    Water3D,
    _change,
    _growth,
    _repetition,
    regular_run,
    repeating_run,
)  # fmt: skip
from moyai.validation.units import WATER, row

HINGE = Connector("h", "hinge", ((0, 1),), 0.0, 3.0, (1.0, 0.0, 0.0))
BAND = (0.6, 1.9)
OMEGA = np.concatenate([np.linspace(0.3, 2.2, 20), np.linspace(2.4, 3.0, 3)])


def at_rest(*connectors, lines=()):
    return assemble(replace(row(connectors), lines=tuple(lines)), Environment(WATER), "SWL", 0.0)


@pytest.fixture(scope="module")
def hydro():
    at = at_rest()
    mesh = row_mesh(at.section, at.row.length, at.row.placements, 3.5, lid=True, gap_lid=False)
    return solve_row(panels_of(mesh, at.centres), WATER, at.centres, OMEGA, np.radians([0.0, 40.0]))


@pytest.fixture(scope="module")
def memory(hydro):
    return fit_row_memory(hydro.omega, hydro.added_mass, hydro.damping, band=BAND)


def own_memory(generator, size, count, dashpot=0.0):
    """Return poles and residues of a passive memory: dampers behind springs, each on one direction."""
    poles, residues = [], []
    for _ in range(count):
        along = generator.normal(size=size)
        frequency, fraction = generator.uniform(0.5, 2.0), generator.uniform(0.1, 0.6)
        pole = frequency * (-fraction + 1j * np.sqrt(1.0 - fraction**2))
        # s / (s^2 + 2 zeta w s + w^2): zero at rest and far away, real part never negative
        residues.append(2.0 * pole / (2j * pole.imag) * np.outer(along, along))
        poles.append(pole)
    return np.array(poles), np.array(residues)


def response_of(poles, residues, omega):
    s = -1j * omega[:, None]
    first = np.einsum("tk,kij->tij", 0.5 / (s - poles), residues)
    return first + np.einsum("tk,kij->tij", 0.5 / (s - poles.conj()), residues.conj())


def test_a_memory_of_few_poles_is_found_again():
    generator = np.random.default_rng(3)
    poles, residues = own_memory(generator, 5, 4)
    omega = np.linspace(0.2, 3.0, 30)
    values = response_of(poles, residues, omega)
    infinite = np.diag(generator.uniform(1.0, 2.0, 5))
    added = infinite - values.imag / omega[:, None, None]
    found = fit_row_memory(omega, added, values.real, goal=1e-8)
    assert found.error < 1e-6
    assert np.allclose(found.infinite_added_mass, infinite, atol=1e-6)
    elsewhere = np.linspace(0.01, 20.0, 200)
    assert np.allclose(found.coefficients(elsewhere)[1], response_of(poles, residues, elsewhere).real, atol=1e-5)


def test_the_memory_of_data_with_negative_damping_is_passive():
    generator = np.random.default_rng(4)
    poles, residues = own_memory(generator, 4, 3)
    omega = np.linspace(0.2, 3.0, 25)
    values = response_of(poles, residues, omega).real
    error = generator.normal(size=values.shape) * 0.03 * np.abs(values).max()
    given = values + 0.5 * (error + error.transpose(0, 2, 1))
    assert np.linalg.eigvalsh(given).min() < 0.0
    added = 2.0 * np.eye(4) - response_of(poles, residues, omega).imag / omega[:, None, None]
    found = fit_row_memory(omega, added, given, most=10)
    everywhere = np.concatenate([np.linspace(0.001, 6.0, 4001), np.geomspace(6.0, 500.0, 200)])
    damping = found.coefficients(everywhere)[1]
    assert np.linalg.eigvalsh(damping).min() > -1e-5 * np.abs(damping).max()
    assert np.abs(found.coefficients(omega)[1] - values).max() < 0.15 * np.abs(values).max()


def test_residues_are_made_passive_alike_in_any_unit_of_force():
    """A power of two changes no digit."""
    generator = np.random.default_rng(4)
    poles, residues = own_memory(generator, 3, 2)
    basis, omega = _Basis.of(poles), np.linspace(0.2, 3.0, 25)
    s, weight = -1j * omega, np.ones(25)
    error = generator.normal(size=(25, 3, 3)) * 0.2
    given = response_of(poles, residues, omega) - 0.3 * np.eye(3) + error + error.swapaxes(1, 2) + 0j
    found, slope = _residues(basis, s, weight, given)
    now, steep, least = _passive(basis, s, weight, found, slope)
    assert least >= 0.0 and not np.allclose(now, found, rtol=1e-2)
    small = 2.0**-40
    other, other_steep, other_least = _passive(basis, s, weight, small * found, small * slope)
    assert np.allclose(other / small, now, rtol=1e-9, atol=1e-12)
    assert np.allclose(other_steep / small, steep, rtol=1e-9, atol=1e-12)
    assert other_least == pytest.approx(least, rel=1e-6, abs=1e-12)


@pytest.mark.slow
def test_ogilvie_holds_between_the_memory_and_the_panels(hydro, memory):
    """A_inf = A + (1/omega) int K sin(omega t) dt with A of the panels, K of the memory by quadrature."""
    assert memory.error < 0.02
    time = np.linspace(0.0, 400.0, 40001)
    kernel = memory.kernel(time)
    weight = np.full(time.size, time[1])
    weight[[0, -1]] *= 0.5
    scale = np.abs(hydro.added_mass).max(axis=0).diagonal()
    scale = np.sqrt(np.outer(scale, scale))
    for omega, added in zip(hydro.omega, hydro.added_mass):
        if BAND[0] < omega < BAND[1]:
            part = np.tensordot(weight * np.sin(omega * time), kernel, axes=1) / omega
            assert np.abs(added + part - memory.infinite_added_mass).max() < 0.02 * scale.max()
            assert (np.abs(added + part - memory.infinite_added_mass) / scale).max() < 0.02


def test_shared_drift_has_the_resultant_and_the_moment_of_the_row():
    at = at_rest()
    drift = np.array([3e3, -2e3, 5e4])
    at = replace(at, centres=at.centres + np.array([7.0, -4.0, 0.0]))
    force = share_drift(at, drift).reshape(-1, 6)
    assert force[:, :2].sum(axis=0) == pytest.approx(drift[:2], rel=1e-12)
    moment = at.centres[:, 0] * force[:, 1] - at.centres[:, 1] * force[:, 0]
    assert moment.sum() + force[:, 5].sum() == pytest.approx(drift[2], rel=1e-12)


def test_factors_of_a_step_integrate_a_straight_velocity():
    poles = np.array([-0.3 + 2.0j, -1e-6 + 0.0j, -5.0 + 0.0j])
    decay, before, after = step_weights(poles, 0.2)
    time = np.linspace(0.0, 0.2, 20001)
    for number, pole in enumerate(poles):
        faded = np.exp(pole * (0.2 - time))
        assert np.trapezoid(faded * (1.0 - time / 0.2), time) == pytest.approx(before[number], rel=1e-7)
        assert np.trapezoid(faded * time / 0.2, time) == pytest.approx(after[number], rel=1e-7)
    assert np.allclose(decay, np.exp(0.2 * poles))


@pytest.mark.slow
@pytest.mark.parametrize("heading", [0, 1])
def test_regular_waves_move_the_row_as_in_the_frequency_domain(hydro, memory, heading):
    """Coefficients of the memory itself in both: what differs is the step; those of the panels: the fit as well."""
    at, omega = at_rest(HINGE), 1.1
    k = np.array([hydro.wave_number[np.argmin(np.abs(hydro.omega - omega))]])
    frequency = np.array([omega])
    own = replace(hydro, solutions=tuple(_with(item, memory) for item in hydro.solutions))
    period = 2.0 * np.pi / omega
    step, count = period / 80, 80 * 60
    time = step * np.arange(count)
    excitation = hydro.at(frequency, k)[2][0, heading]
    shape = 0.5 * (1.0 - np.cos(np.pi * np.minimum(time / (15.0 * period), 1.0)))
    load = shape[:, None] * np.real(excitation * np.exp(-1j * omega * time)[:, None])
    run = RowInTime(at, memory, np.zeros(at.size), omega).run(load, step)
    last = slice(count - 800, count)
    turn = np.exp(1j * omega * time[last])[:, None]
    moved = 2.0 * np.mean(run.position[last] * turn, axis=0)
    loads = 2.0 * np.mean(run.joint_loads[last, 0] * turn, axis=0)
    for coefficients, allowed in ((own, 4e-3), (hydro, 0.03)):
        model = RowModel(at, coefficients, np.zeros(at.size))
        answer = respond(model, frequency, np.zeros(1))
        expected, force = answer.motion[0, heading], answer.load[0, heading, 0]
        assert np.abs(moved - expected).max() < allowed * np.abs(expected).max()
        if heading == 1:
            assert np.abs(loads - force)[:3].max() < allowed * np.abs(force[:3]).max()
            assert np.abs(loads - force)[3:].max() < allowed * np.abs(force[3:]).max()


@pytest.mark.slow
def test_eddies_in_regular_waves_are_those_of_equal_work_in_the_frequency_domain(hydro, memory):
    """Near the resonance of roll, where they decide: first harmonics of the quadratic drag as it is."""
    given = replace(row(), viscous_factor=1.0, damping_fraction=np.zeros(6))
    at = assemble(given, Environment(WATER), "SWL", 0.0)
    omega, height = 1.1, 1.0
    own = replace(hydro, solutions=tuple(_with(item, memory) for item in hydro.solutions))
    sea = RegularSea("w", height, (2.0 * np.pi / omega,), np.radians(40.0))
    (answer,) = regular_answer(at, own, sea, np.zeros(12), UnitSettings(2.0, drift=False))
    assert answer.converged
    settings = UnitSettings(2.0, drift=False, time=UnitTimeSettings(duration=300.0))
    kept = regular_run(Water3D(at, own, memory, np.zeros(12), settings), sea, sea.periods[0], answer)
    run = kept.run
    # units without connectors have numbers as well
    assert {values.shape[0] for dims, values in run_numbers(kept).values() if dims[:1] == ("connector",)} == {0}
    last = run.time > 200.0 - 1e-9
    count = int(last.sum() // round(sea.periods[0] / run.time_step)) * round(sea.periods[0] / run.time_step)
    position, time = run.position[-count:], run.time[-count:]
    moved = 2.0 * np.mean(position * np.exp(1j * omega * time)[:, None], axis=0)
    expected = 0.5 * height * answer.fine.motion[0, 0]
    assert np.abs(moved - expected).max() < 0.02 * np.abs(expected).max()
    assert abs(moved[4] - expected[4]) < 0.04 * abs(expected[4])
    # they matter here
    (without,) = regular_answer(
        replace(at, row=replace(given, viscous_factor=0.0)), own, sea, np.zeros(12), UnitSettings(2.0, drift=False)
    )
    assert abs(0.5 * height * without.fine.motion[0, 0, 4]) > 1.1 * abs(expected[4])


@pytest.mark.slow
def test_units_that_nothing_joins_have_their_numbers(hydro, memory):
    """One pontoon, or several on lines alone: a table of connectors without rows."""
    at, sea = at_rest(), RegularSea("w", 1.0, (6.0,), 0.0)
    settings = UnitSettings(2.0, drift=False, time=UnitTimeSettings(duration=60.0))
    (answer,) = regular_answer(at, hydro, sea, np.zeros(12), settings)
    found = run_numbers(regular_run(Water3D(at, hydro, memory, np.zeros(12), settings), sea, 6.0, answer))
    assert found["relative_motion_largest"][1].shape == (0, 3) and found["connector_resultant_largest"][1].shape == (0,)
    assert (found["maximum_motion"][1][:, 2] > 0.1).all()


@pytest.mark.slow
def test_ends_of_the_damping_in_time_are_those_of_the_frequency_domain_where_it_is_linear(hydro, memory):
    """Damping linear in the speed, near the resonance of roll."""
    given = replace(row(), viscous_factor=0.0, damping_fraction=np.array([0.05, 0.05, 0.0, 0.0, 0.08, 0.05]))
    at = assemble(given, Environment(WATER), "SWL", 0.0)
    own = replace(hydro, solutions=tuple(_with(item, memory) for item in hydro.solutions))
    sea = RegularSea("w", 1.0, (2.0 * np.pi / 1.1,), np.radians(40.0))
    settings = UnitSettings(2.0, drift=False, time=UnitTimeSettings(duration=300.0))
    others = []
    for factor in given.damping_band:
        damped = replace(at, row=given.damped(factor))
        others.append((damped, regular_answer(damped, own, sea, np.zeros(12), settings)))
    answers = regular_answer(at, own, sea, np.zeros(12), settings)
    water = Water3D(at, own, memory, np.zeros(12), settings)
    found = sea_in_time(water, sea, answers, silent)
    timed = with_ends_in_time(water, sea, found, others, silent).groups[""]
    frequency = with_damping_band(
        regular_dataset(at, sea, answers, own), [regular_dataset(there, sea, one, own) for there, one in others]
    )
    assert not curves_matter(at, frequency, timed)
    own_roll = frequency["motion_amplitude"].values[0, :, 4]
    for end in ("low", "high"):
        expected = frequency[f"motion_amplitude_{end}"].values[0, :, 4] / own_roll
        ratio = timed[f"motion_amplitude_{end}"].values[0, :, 4] / timed["motion_amplitude"].values[0, :, 4]
        assert ratio == pytest.approx(expected, rel=0.01)
    # the damping matters here
    assert (frequency["motion_amplitude_high"].values[0, :, 4] > 1.05 * own_roll).all()


def test_a_connector_with_a_curve_or_a_tight_line_has_its_damping_run_in_time():
    def lines(tension):
        data = {"line_tension_maximum": ("line", [tension]), "line_tension_mean": ("line", [10.0])}
        return xr.Dataset(data, coords={"line": ["a"]})

    chain = Connector("c", "chain", ((0, 1),), 0.0, 3.0, curve=Curve((-1.0, 0.1, 1.1), (0.0, 0.0, 4e6)))
    assert curves_matter(at_rest(chain), lines(20.0), lines(20.0))
    assert not curves_matter(at_rest(HINGE), lines(20.0), lines(20.0))
    assert curves_matter(at_rest(HINGE), lines(51.0), lines(20.0)) and curves_matter(
        at_rest(HINGE), lines(9.0), lines(51.0)
    )


def test_lines_in_motion_keep_the_change_of_lines_at_rest(monkeypatch):
    """An end that does not come to its end leaves what there is."""
    dims = ("line",)
    data = xr.Dataset(
        {
            "line_tension_maximum": (dims, [90.0, 20.0]),
            "line_tension_maximum_lines_at_rest": (dims, [60.0, 20.0]),
            "line_tension_mean": (dims, [8.0, 8.0]),
        },
        coords={"line": ["a", "b"]},
    )
    found = SeaInTime({"": data, "/T4": data}, [], "converged")
    ends = {0.5: [72.0, 15.0], 2.0: [54.0, 18.0]}
    monkeypatch.setattr(
        damping_in_time, "runs_of",
        lambda water, sea, answers, take, progress: (
            [SimpleNamespace(status=run) for run in answers], "interrupted" in answers
        ),
    )  # fmt: skip
    monkeypatch.setattr(
        damping_in_time, "numbers_of",
        lambda row, sea, runs: xr.Dataset({"line_tension_maximum": (dims, ends[row])}, coords=data.coords),
    )  # fmt: skip
    water = Water3D(None, None, None, None, None)
    both = [(factor, ["converged"]) for factor in ends]
    ranged = with_ends_in_time(water, None, found, both, silent).groups
    assert ranged[""]["line_tension_maximum_low"].values == pytest.approx([90.0 * 54 / 60, 15.0])
    assert ranged[""]["line_tension_maximum_high"].values == pytest.approx([90.0 * 72 / 60, 20.0])
    assert ranged["/T4"] is data
    both[1] = (2.0, ["diverged"])
    assert with_ends_in_time(water, None, found, both, silent) is found
    # a user who has enough ends the run, and keeps what there is
    both[1] = (2.0, ["interrupted"])
    ended = with_ends_in_time(water, None, found, both, silent)
    assert ended.status == "interrupted" and ended.groups is found.groups


def _with(item, memory):
    added, damping = memory.coefficients(np.array([item.omega]))
    return replace(item, added_mass=added[0], damping=damping[0])


def plain_newmark(at, memory, load, step, chain):
    """Two bodies with a hinge as Lagrange multipliers, the memory as a sum over the past, the chain explicit."""
    count, m = load.shape
    omega = np.linspace(0.0, 30.0, 12001)[1:]
    # kernel by the cosine transform of the damping, not by the poles
    damping = memory.coefficients(omega)[1]
    length = round(40.0 / step)
    kernel = np.empty((length, m, m))
    weighted = (omega[1] - omega[0]) * damping.reshape(len(omega), -1)
    weighted[[0, -1]] *= 0.5
    for part in np.array_split(np.arange(length), 8):
        kernel[part] = 2.0 / np.pi * (np.cos(np.outer(step * part, omega)) @ weighted).reshape(-1, m, m)
    kernel[0] *= 0.5
    flat = kernel.transpose(1, 0, 2).reshape(m, -1)
    g = at.constraint
    mass = at.inertia + memory.infinite_added_mass
    model = RowInTime(at, memory, np.zeros(m), 1.1)
    own, stiffness = model.damping, at.hydrostatic
    matrix = mass + 0.5 * step * (own + step * kernel[0]) + 0.25 * step**2 * stiffness
    whole = np.block([[matrix, g.T], [g, np.zeros((len(g), len(g)))]])
    inverse = np.linalg.inv(whole)
    # the latest velocity first; that of the step itself is not known yet
    past = np.zeros((count + length, m))
    q, v, a = np.zeros(m), np.zeros(m), np.zeros(m)
    positions, held, pulls = np.zeros((count, m)), np.zeros((count, len(g))), np.zeros(count)
    for number in range(1, count):
        ahead, speed = q + step * v + 0.25 * step**2 * a, v + 0.5 * step * a
        now = count - number
        memory_force = step * flat @ past[now : now + length].reshape(-1)
        pull = 0.0
        for _ in range(30):
            right = load[number] - (own + step * kernel[0]) @ speed - memory_force - stiffness @ ahead
            right = right - pull * chain.along
            solved = inverse @ np.concatenate([right, np.zeros(len(g))])
            after = max(0.0, float(chain.connector.curve.at(chain.along @ (ahead + 0.25 * step**2 * solved[:m]))))
            if abs(after - pull) < 1e-6 * (abs(pull) + 1.0):
                break
            pull = after
        q, v, a = ahead + 0.25 * step**2 * solved[:m], speed + 0.5 * step * solved[:m], solved[:m]
        past[now] = v
        positions[number], held[number], pulls[number] = q, solved[m:], pull
    return positions, held, pulls


@pytest.mark.slow
def test_two_hinged_bodies_with_a_slack_chain_against_a_plain_program(hydro, memory):
    curve = Curve((-1.0, 0.02, 1.0), (0.0, 0.0, 0.98 * 4e6))
    chain = Connector("c", "chain", ((0, 1),), 0.0, 0.5, (0.0, 1.0, 0.0), curve=curve)
    at, omega, step, count = at_rest(HINGE, chain), 1.1, 0.02, 2500
    time = step * np.arange(count)
    k = np.array([hydro.wave_number[np.argmin(np.abs(hydro.omega - omega))]])
    excitation = hydro.at(np.array([omega]), k)[2][0, 1]
    load = np.minimum(time / 10.0, 1.0)[:, None] * np.real(0.6 * excitation * np.exp(-1j * omega * time)[:, None])
    run = RowInTime(at, memory, np.zeros(at.size), omega).run(load, step)
    position, held, pull = plain_newmark(at, memory, load, step, at.joints[1])
    assert pull.max() > 1e5
    assert (pull == 0.0).mean() > 0.3
    assert np.abs(run.position - position).max() < 0.01 * np.abs(position).max()
    assert np.abs(run.link_force[:, 0] - pull).max() < 0.02 * pull.max()
    # the largest loads: the records differ by the time of an impact
    assert np.abs(np.abs(run.held).max(axis=0) - np.abs(held).max(axis=0)).max() < 0.01 * np.abs(held).max()
    assert run.link_force.max() == pytest.approx(pull.max(), rel=0.01)


@pytest.mark.slow
def test_a_row_that_is_let_go_never_has_more_energy_than_at_first(memory):
    fender = Connector(
        "f", "fender", ((0, 1),), 0.0, 3.0, (0.0, 1.0, 0.0), curve=Curve((-1.0, -0.01, 1.0), (-9.9e6, 0.0, 0.0))
    )
    spring = SpringLine("s", (-40.0, 0.0, 0.0), (-5.0, 0.0, 0.0), 1e5, 0.0)
    lines = [UnitLine("s", 1, (0, 1), (-5.0, 0.0, 0.7), (-40.0, 0.0, 0.7 - 3.0), stiffness=spring.stiffness)]
    at = at_rest(fender, lines=lines)
    start = np.zeros(at.size)
    start[[0, 1, 2, 7, 10]] = 0.3, 0.4, 0.5, -0.5, 0.05
    model = RowInTime(at, memory, np.zeros(at.size), 1.1)
    run = model.run(np.zeros((4000, at.size)), 0.02, start=start)
    curve = at.joints[0].connector.curve
    elongation = at.links[0].elongation(run.position)
    stored = np.where(elongation < -0.01, 0.5 * 1e7 * (elongation + 0.01) ** 2, 0.0)
    assert np.allclose(run.link_force[:, 0], np.minimum(curve.at(elongation), 0.0), atol=1.0)
    pull = [system.tensions(run.position[:, 6 * n : 6 * n + 6])[:, 0] for n, system in enumerate(at.systems)]
    stored = stored + sum(0.5 * one**2 / 1e5 for one in pull)
    kinetic = 0.5 * np.einsum("ti,ij,tj->t", run.velocity, model.mass, run.velocity)
    total = kinetic + 0.5 * np.einsum("ti,ij,tj->t", run.position, at.hydrostatic, run.position) + stored
    assert run.link_force.min() < -1e4
    assert total.max() <= total[0] * (1.0 + 1e-3)
    assert total[-1] < 0.5 * total[0]


@pytest.mark.parametrize(
    ("elongation", "rate", "side", "expected"),
    [(0.5, 0.0, 1.0, 2.0), (0.5, -1.0, 1.0, 0.0), (0.2, 3.0, 1.0, 0.0), (0.2, 3.0, 0.0, 9.0), (0.5, 1.0, 0.0, 5.0)],
)
def test_a_chain_pulls_only_and_its_dashpot_only_when_tight(elongation, rate, side, expected):
    x, f = np.array([-1.0, 0.3, 1.0]), np.array([0.0, 0.0, 7.0])
    assert joint_force(elongation, rate, x, f, 3.0, side)[0] == pytest.approx(expected)


CHAIN = LineType("chain", submerged_weight=280.0, axial_stiffness=3e7, breaking_load=1e6)
BAR = BarType(
    "chain", 32.0, 3e7, 0.04, drag_normal=1.2, drag_tangential=0.3, added_mass_normal=1.0,
    volume_per_length=(32.0 - 280.0 / 9.81) / 1025.0,
)  # fmt: skip


def moored():
    lines = [
        UnitLine(name, 1, (0, 1), (x, 0.0, 0.7), (10.0 * x, 0.0, 0.0), (Segment(CHAIN, 46.9),), bar_types=(BAR,))
        for name, x in (("west", -5.0), ("east", 5.0))
    ]
    return at_rest(HINGE, lines=lines)


def swaying(at, period, amplitude):
    time = 0.05 * np.arange(round(14.0 * period / 0.05))
    position, velocity = np.zeros((len(time), at.size)), np.zeros((len(time), at.size))
    for unit in (0, 6):
        position[:, unit] = amplitude * np.sin(2.0 * np.pi * time / period)
        velocity[:, unit] = amplitude * 2.0 * np.pi / period * np.cos(2.0 * np.pi * time / period)
    tension = np.concatenate([system.tensions(position[:, :6]) for system in at.systems], axis=1)
    still = WaveComponents(*(np.array([value]) for value in (1.0, 0.0, 0.0, 0.0, 0.12)), WATER)
    return Carried(time, position, velocity, np.eye(at.size), tension, still, 6.0 * period, period)


def test_a_line_moved_slowly_has_the_tension_of_the_line_at_rest():
    at = moored()
    given = swaying(at, 40.0, 1.0)
    moving = moving_line(at, 0)
    event, expected = events_of(given, 0)[0]
    assert rerun(at, moving, given, event) == pytest.approx(expected, rel=0.04)


def test_events_of_a_snapping_line_are_rerun_and_the_largest_is_kept():
    at = moored()
    given = swaying(at, 6.0, 1.7)
    mean, largest = given.tension.mean(axis=0), given.tension.max(axis=0)
    assert (largest > 5.0 * mean).all()
    found = rerun_events(at, [given], lambda *_: None, "")
    assert found is not None
    first = int(np.argmax(largest))
    assert np.isfinite(found.tension[0, first])
    # the inertia of the chain is in it, in either direction
    assert 0.5 * largest[first] < found.tension[0, first] < 3.0 * largest[first]
    assert found.bound[0, first] >= found.tension[0, first]
    assert rerun_events(at, [swaying(at, 40.0, 0.1)], lambda *_: None, "") is None


def test_a_motion_that_grows_does_not_repeat():
    """The share by which a growing oscillation changes in a period is known; turns count by themselves."""
    per_period, growth = 50, 0.02
    turns = np.arange(40 * per_period) / per_period
    wave = np.sin(2.0 * np.pi * turns)
    position = np.zeros((len(turns), 12))
    position[:, 0], position[:, 9] = 3.0 * wave + 100.0, 0.01 * wave
    assert _change(position, per_period, 10) < 1e-12
    position[:, 9] *= np.exp(growth * turns)
    assert _change(position, per_period, 10) == pytest.approx(1.0 - np.exp(-growth), rel=0.01)
    assert _change(position[: 10 * per_period], per_period, 10) == 0.0


def test_a_resonance_that_grows_from_little_does_not_repeat_yet():
    """One of another period under the motion of the waves: its change is small, its growth is known."""
    per_period, turns = 50, np.arange(40 * 50) / 50
    position = np.zeros((len(turns), 12))
    for rate, expected in ((0.03, 0.03), (-0.03, 0.0)):
        position[:, 0] = np.sin(2.0 * np.pi * turns) + 1e-4 * np.exp(rate * turns) * np.sin(np.pi * turns)
        change = _change(position, per_period, 10)
        assert change < 2e-3
        assert _growth(position, per_period, 10) == pytest.approx(expected, abs=1e-3)
    # a motion that never repeats, whose change goes up and down
    generator, long = np.random.default_rng(2), np.arange(300 * 50) / 50
    tops = np.repeat(generator.uniform(0.8, 1.2, 300), 50)
    wild = np.zeros((len(long), 12))
    wild[:, 0] = tops * np.sin(2.0 * np.pi * long)
    assert _change(wild, per_period, 10) > REPEATING and _growth(wild, per_period, 10) == 0.0
    # what rounding leaves
    position[:, 0] = np.sin(2.0 * np.pi * turns) + 1e-9 * np.exp(0.03 * turns) * np.sin(np.pi * turns)
    assert _growth(position, per_period, 10) == 0.0


@pytest.mark.parametrize(
    ("runs", "count"),
    [
        ([(0.01, 0.0)], 1),
        ([(0.01, 0.02), (0.01, 0.0)], 2),
        ([(0.2, 0.0), (0.2, 0.0)], 2),
        ([(0.2, 0.01), (0.3, 0.01), (0.9, 0.0)], 3),
        ([(0.01, 0.01), (0.02, 0.01), (0.03, 0.01)], 3),
    ],
)
def test_a_row_is_run_until_it_repeats_and_grows_no_more(monkeypatch, runs, count):
    asked = []

    def run(water, sea, period, answer, least, progress):
        asked.append(least)
        change, growth = runs[len(asked) - 1]
        return SimpleNamespace(change=change, growth=growth, complete=True)

    monkeypatch.setattr(seas_in_time, "regular_run", run)
    water = SimpleNamespace(time=UnitTimeSettings())
    repeating_run(water, None, 4.0, None)
    assert len(asked) == count and asked == [50.0, 300.0, 1000.0][:count]
    asked.clear()
    repeating_run(SimpleNamespace(time=UnitTimeSettings(duration=60.0)), None, 4.0, None)
    assert len(asked) == 1


def test_parts_of_a_record_are_whole_periods_at_its_end():
    period, step = 4.0, 0.1
    time = step * np.arange(round(300 * period / step) + 1)
    run = SeaRun(SimpleNamespace(time=time), None, time, 40.0, 1160.0, 2.0 * np.pi / period, change=0.3)
    ends = np.array([(part.begin, part.end) for part in run.parts])
    assert np.allclose(ends[1:, 0], ends[:-1, 1]) and ends[-1, 1] == pytest.approx(time[-1])
    assert np.allclose(np.diff(ends, axis=1), 40 * period)
    assert all(part.kept.stop - part.kept.start == round(40 * period / step) + 1 for part in run.parts)
    assert len(replace(run, change=0.01).parts) == 1


@pytest.mark.parametrize("every", [1, 2, 13, 0])
def test_a_motion_that_repeats_after_several_periods_repeats(every: int) -> None:
    """Lines that come taut every thirteenth wave make one long period; noise from period to period makes none."""
    per_period, count = 24, 200
    period = np.arange(count * per_period) / per_period
    number = np.floor(period).astype(int)
    generator = np.random.default_rng(3)
    size = 1.0 + 0.6 * (generator.random(count)[number] if every == 0 else np.cos(2.0 * np.pi * number / every))
    wave = np.sin(2.0 * np.pi * period) * size
    position = wave[:, None] * np.linspace(1.0, 2.0, 12)
    found, change = _repetition(position, per_period, 10)
    assert found == max(every, 1)
    assert (change > REPEATING) == (every == 0)


def test_an_opening_has_the_band_of_the_damping() -> None:
    data = xr.Dataset(
        {f"relative_motion_largest{end}": (("connector", "component"), [[0.0, value, 0.0]])
         for end, value in (("", 0.2), ("_low", 0.15), ("_high", 0.3))},
        coords={"connector": ["f"], "component": list("xyz")},
    )  # fmt: skip
    (opened,) = each_of([("/SWL/frequency/storm", _with_opening(data))], "opened")
    assert opened is not None and (opened.band.low, opened.band.high) == (0.15, 0.3)
