"""Lines of a row in time, from tables and exactly, and coefficients between their frequencies."""

import numpy as np
import pytest
from test_units_links import memory_of
from test_units_time import HINGE, at_rest, moored

from moyai.mooring import Line, LineSystem, LineType, Segment, SpringLine
from moyai.mooring.rotations import roll_pitch_yaw, rotation_from_vector
from moyai.mooring.space_kernel import space_line_force
from moyai.mooring.table import compile_lines
from moyai.structures.units.bem import panels_of
from moyai.structures.units.hydrodynamics import solve_row
from moyai.structures.units.mesh import row_mesh
from moyai.structures.units.model import UnitLine
from moyai.structures.units.time import kernel
from moyai.structures.units.time import model as model_in_time
from moyai.structures.units.time.model import RowInTime
from moyai.validation.units import WATER


def by_angles(position):
    """The turn of a position as angles one after the other, from its vector."""
    return np.concatenate([position[:3], roll_pitch_yaw(rotation_from_vector(position[3:]))])


def test_lines_in_space_pull_alike_in_turned_axes():
    """A large roll and pitch seen along other axes are the same motion."""
    turn = rotation_from_vector((0.0, 0.0, 0.7))
    chain = LineType("chain", submerged_weight=900.0, axial_stiffness=3e7)
    ends = np.array([(-50.0, 12.0, -10.0), (-5.0, 8.0, -1.0)])
    found = []
    for frame in (np.eye(3), turn):
        anchor, fairlead = ends @ frame.T
        line = Line("one", tuple(anchor), tuple(fairlead), (Segment(chain, 48.0),))
        packed = compile_lines(LineSystem((line,), 10.0))
        position = np.concatenate([frame @ (0.5, -0.3, 0.2), frame @ (0.35, -0.25, 0.1)])
        force, tension = np.zeros(6), np.zeros(1)
        space_line_force(position, np.zeros(1, dtype=np.int64), *packed.arguments, np.zeros(1), force, tension)
        found.append((tension[0], frame.T @ force[:3], frame.T @ force[3:]))
    (one, pull, moment), (other, turned, turned_moment) = found
    assert other == pytest.approx(one, rel=1e-9)
    assert np.allclose(turned, pull, rtol=1e-9) and np.allclose(turned_moment, moment, rtol=1e-8)


def test_compiled_lines_in_space_are_the_lines():
    generator = np.random.default_rng(8)
    chain = LineType("chain", submerged_weight=900.0, axial_stiffness=3e7)
    rope = LineType("rope", submerged_weight=20.0, axial_stiffness=5e6)
    lines = (
        Line("one", (-50.0, 12.0, -10.0), (-5.0, 8.0, -1.0), (Segment(chain, 48.0),), count=2),
        Line("two", (30.0, 45.0, -10.0), (5.0, 9.0, 0.5), (Segment(chain, 40.0), Segment(rope, 15.0))),
        SpringLine("three", (20.0, -3.0, 2.0), (4.0, -9.0, 1.0), 2e4, 1e3),
    )
    system = LineSystem(lines, 10.0)
    packed = compile_lines(system)
    body, last = np.array([1, 1, 1]), np.zeros(3)
    for _ in range(20):
        position = np.zeros(12)
        position[6:] = generator.normal(size=6) * np.array([1.0, 1.0, 0.5, 0.05, 0.1, 0.1])
        force, tension = np.zeros(12), np.zeros(3)
        space_line_force(position, body, *packed.arguments, last, force, tension)
        exact = system.forces(by_angles(position[6:]))
        assert np.all(force[:6] == 0.0)
        assert np.allclose(force[6:], exact, rtol=1e-6, atol=1e-6 * np.abs(exact).max())
        assert np.allclose(tension, system.tensions(by_angles(position[6:])), rtol=1e-6)


def test_tables_of_lines_in_space_hold_their_tolerance_and_beyond_them_lines_are_exact():
    generator = np.random.default_rng(9)
    chain = LineType("chain", submerged_weight=900.0, axial_stiffness=3e7)
    ends = ((-50.0, 12.0, -10.0), (-5.0, 8.0, -1.0)), ((50.0, -14.0, -10.0), (5.0, -8.0, -1.0))
    lines = (
        *(Line(f"chain {n}", *end, (Segment(chain, 48.0),)) for n, end in enumerate(ends)),
        SpringLine("spring", (20.0, -3.0, 2.0), (4.0, -9.0, 1.0), 2e4, 1e3),
    )
    system = LineSystem(lines, 10.0)
    reach = np.array([[[43.0, 46.0], [8.2, 9.8]], [[42.5, 46.0], [8.2, 9.8]], [[0.0, 0.0], [0.0, 0.0]]])
    packed = compile_lines(system, tolerance=1e-4, reach=reach)
    # lines that are alike share a table
    assert packed.tables[0] is packed.tables[1] is not None and packed.tables[2] is None
    assert packed.nodes.size < 1.5 * packed.tables[0].nodes.size
    body, last, within = np.zeros(3, dtype=np.int64), np.zeros(3), []
    for width in (0.3, 2.0):
        for _ in range(100):
            position = width * generator.normal(size=6) * np.array([1.0, 1.0, 0.5, 0.03, 0.05, 0.05])
            force, tension = np.zeros(6), np.zeros(3)
            space_line_force(position, body, *packed.arguments, last, force, tension)
            exact, pulls = system.forces(by_angles(position)), system.tensions(by_angles(position))
            assert np.all(np.abs(tension - pulls) <= 1.5e-4 * np.abs(pulls))
            assert np.all(np.abs(force[:3] - exact[:3]) <= 1.5e-4 * np.abs(pulls).sum())
            within.append(np.max(np.abs(tension - pulls) / np.abs(pulls)) > 1e-9)
    # both ways were taken
    assert 0 < sum(within) < 200


def test_a_run_on_tables_is_that_on_exact_lines(monkeypatch):
    at = moored()
    memory = memory_of(at.size)
    step = 0.1
    time = step * np.arange(2500)
    load = np.zeros((len(time), at.size))
    load[:, [0, 6]] = 1.5e6 * np.sin(1.1 * time)[:, None] * np.minimum(time / 20.0, 1.0)[:, None]
    runs = {}
    for begin in (300, len(time)):
        monkeypatch.setattr(model_in_time, "STEPS_BEFORE_TABLES", begin)
        runs[begin] = RowInTime(at, memory, np.zeros(at.size), 1.1).run(load, step)
    tables, exact = runs.values()
    assert exact.tension.max() > 3.0 * exact.tension.mean()
    assert 0.0 < np.abs(tables.tension - exact.tension).max() < 1e-3 * exact.tension.max()
    # a force wrong by 1e-4 of the tension moves the row by a few times that near resonance
    assert np.abs(tables.position - exact.position).max() < 5e-4 * np.abs(exact.position).max()


@pytest.mark.parametrize(
    ("weight", "axial_stiffness", "length", "step", "amplitude"),
    [
        (900.0, 3e7, 46.9, 0.1, 1.5e6),
        (0.0043, 6.8e8, 47.5, 0.3, 5e6),
        (0.1, 5e8, 46.5, 0.2, 3e6),
        (1.0, 8e8, 46.5, 0.2, 3e6),
    ],
)  # fmt: skip
def test_a_pass_that_is_left_out_would_have_changed_nothing(
    monkeypatch, weight, axial_stiffness, length, step, amplitude
):
    """Chains that come taut, lines without weight that are struck at once: each step from one state, both ways."""
    line = LineType("line", submerged_weight=weight, axial_stiffness=axial_stiffness)
    lines = [
        UnitLine(name, 1, (0, 1), (x, 0.0, 0.7), (10.0 * x, 0.0, 0.0), (Segment(line, length),))
        for name, x in (("west", -5.0), ("east", 5.0))
    ]
    at = at_rest(HINGE, lines=lines)
    count = 800
    load = np.zeros((count, at.size))
    load[:, [0, 6]] = amplitude * np.sin(1.1 * step * np.arange(count))[:, None]
    march, off, left_out = kernel.march, [], 0

    def both_ways(y, v, a, z, first, steps, h, load, body, memory, held, lines, joints, drag, limit, saved):
        nonlocal left_out
        for number in range(first, first + steps):
            state = [item.copy() for item in (y, v, a, z)]
            looked = *lines[:-3], lines[-3].copy(), lines[-2].copy(), np.zeros(3)
            march(*state, number, 1, h, load, body, memory, held, looked, joints, drag, limit, saved)
            slow = saved[5][number + 1].copy()
            left_out += int(lines[-1][1] > 0.0)
            code, good = march(y, v, a, z, number, 1, h, load, body, memory, held, lines, joints, drag, limit, saved)
            if code:
                return code, number - first + good
            off.append(np.abs(saved[5][number + 1] - slow).max())
        return 0, steps

    monkeypatch.setattr(kernel, "march", both_ways)
    run = RowInTime(at, memory_of(at.size), np.zeros(at.size), 1.1).run(load, step)
    assert run.tension.max() > 3.0 * run.tension.mean()
    assert len(off) > 20 and left_out > 10
    assert max(off) < 1e-7 * run.tension.max()


def test_coefficients_at_some_of_their_frequencies_are_those():
    at = at_rest()
    mesh = row_mesh(at.section, at.row.length, at.row.placements, 9.0, lid=True, gap_lid=False)
    omega = np.array([0.8, 1.0, 1.3])
    hydro = solve_row(panels_of(mesh, at.centres), WATER, at.centres, omega, np.zeros(1))
    found = hydro.at(hydro.omega[1:3], hydro.wave_number[1:3])
    for values, own in zip(found, (hydro.added_mass, hydro.damping, hydro.excitation), strict=True):
        assert np.allclose(values, own[1:3], rtol=1e-9, atol=1e-9 * np.abs(own).max())
