"""The march of the explicit scheme: central differences in leapfrog form [eq:flexible-leapfrog], whole rows a call."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.core.compiled import njit
from moyai.flexible.explicit_energy import elastic_energy, kinetic_energy, load_power, load_work, node_force
from moyai.flexible.explicit_forces import bending_forces, rib_forces, spine_forces
from moyai.flexible.explicit_loads import extrapolate, loads, rate_of_drag
from moyai.flexible.explicit_motion import (
    drive,
    kick_and_drift,
    kick_contact_and_drift,
    kick_on_ground_and_drift,
    kick_with_friction_and_drift,
)
from moyai.flexible.explicit_parts import (
    add_ring_forces,
    add_sheet_forces,
    elastic_energy_of_sheets,
    first_push,
    has_further_forces,
    kick_sections,
    pressure_work,
    ring_energy,
    room_for_speeds,
    screen_forces,
    screen_work,
    screens,
    section_energy,
    section_loads,
)
from moyai.flexible.explicit_rows import (
    BX,
    FAST,
    FREE_X,
    FREE_Y,
    FREE_Z,
    IXX,
    LEDGER,
    PEAK,
    PULL,
    PX,
    QX,
    RATE,
    RIB,
    ROW,
    TX,
    WU,
    U,
    V,
    W,
    X,
    Y,
    Z,
)
from moyai.flexible.explicit_types import Blocks, Driving, Parts, Saved, Timing, Watch, Waves
from moyai.flexible.ground_kernel import FLAT, ground

#: Steps for which the loads of net panels are held where those of the bars are taken more often, at most, and no longer
#: than the time in which they damp any node.
PANEL_STEPS = 4


@njit(cache=True, error_model="numpy")
def _touching(A: Array, count: int, bed: Array, ahead: float) -> bool:
    """Whether a free node can reach the bed within ``ahead`` seconds at twice the greatest speed towards it."""
    fastest, lowest, level = 0.0, math.inf, bed[0]
    if bed.size > FLAT:
        # heights over the bed, which comes towards a node that moves level
        for i in range(count):
            fastest = max(fastest, abs(A[W + i]) + bed[6] * math.sqrt(A[U + i] ** 2 + A[V + i] ** 2))
            height = A[Z + i] - ground(bed, A[X + i], A[Y + i])[0]
            lowest = min(lowest, height if A[FREE_X + i] + A[FREE_Y + i] + A[FREE_Z + i] > 0.0 else math.inf)
        return lowest - 2.0 * ahead * fastest < 1e-3
    for i in range(count):
        fastest = max(fastest, abs(A[W + i]))
        lowest = min(lowest, A[Z + i] if A[FREE_Z + i] > 0.0 else math.inf)
    return lowest - 2.0 * ahead * fastest < level + 1e-3


@njit(cache=True, error_model="numpy")
def survey(
    A: Array, count: int, arrays: tuple[Array, Array], start: IntArray, end: IntArray, place: IntArray, water: Array,
    gauge: float, drive: float, lift: float, reach: float, ahead: float, inverse: Array,
) -> tuple[float, bool]:  # fmt: skip
    """Return the rate that bounds the load interval and whether a bar may cross the surface; write inverse masses.

    The rate is the fastest at which drag damps or floats bob, thrice weighted, anywhere [1/s]; ``drive`` is the
    greatest speed of what drives the network, which the bars may not have yet, ``lift`` density times gravity. The
    surface is near when a node may reach it within ``ahead`` seconds, 5 m/s faster than twice the present speed.
    ``inverse`` (6, n) becomes the inverse mass blocks, without added mass for what may fall dry.
    """
    nodes, bars = arrays
    rate, top, low, fastest, thickest = gauge, -math.inf, math.inf, drive, 0.0
    for i in range(count):
        top = max(top, A[Z + i])
        low = min(low, water[6, i])
        fastest = max(fastest, abs(A[W + i]))
        u, v, w = water[0, i] - A[U + i], water[1, i] - A[V + i], water[2, i] - A[W + i]
        speed = math.sqrt(u * u + v * v + w * w)
        rate = max(rate, 2.0 * nodes[3, i] * speed / (nodes[0, i] + nodes[4, i]))
        if nodes[7, i] > 0.0:
            rate = max(rate, 3.0 * math.sqrt(1.5 * lift * nodes[2, i] / nodes[7, i] / nodes[0, i]))
    for k in range(start.size):
        thickest = max(thickest, bars[10, k])
    near = top + thickest > low - reach - ahead * (2.0 * fastest + 5.0)
    bobs = top + thickest > low - reach
    for k in range(start.size):
        rate = max(rate, A[RATE + place[k]], drive * 2.0 * bars[4, k] * bars[11, k])
        za, zb = A[Z + start[k]], A[Z + end[k]]
        if bobs and max(za, zb) > low - 1.0:
            # a bar that crosses the surface steeply bobs over its height, a floating one over its diameter
            flat = bars[10, k] / (bars[10, k] + 0.5 * abs(za - zb))
            rate = max(rate, 3.0 * math.sqrt(bars[8, k] / bars[10, k] * bars[11, k] * flat))
    for i in range(count):
        dry = A[Z + i] > low - reach
        for row in range(6):
            inverse[row, i] = 0.0 if dry else A[IXX + row * ROW + i]
        if dry:
            inverse[0, i], inverse[3, i] = nodes[9, i] / nodes[0, i], nodes[10, i] / nodes[0, i]
            inverse[5, i] = nodes[11, i] / nodes[0, i]
    return rate, near


@njit(cache=True, error_model="numpy")
def read_gauges(A: Array, bars: IntArray, gauges: Array) -> None:
    """Keep the highest rise of the tension of some bars within two blocks of steps, and their highest tension.

    A gauge holds: lowest tension in the block before, in this block, steps of this block, steps of a block, highest
    rise, highest tension.
    """
    for g in range(bars.size):
        pull = A[PULL + bars[g]]
        gauges[g, 1] = min(gauges[g, 1], pull)
        gauges[g, 4] = max(gauges[g, 4], pull - min(gauges[g, 0], gauges[g, 1]))
        gauges[g, 5] = max(gauges[g, 5], pull)
        gauges[g, 2] += 1.0
        if gauges[g, 2] >= gauges[g, 3]:
            gauges[g, 0], gauges[g, 1], gauges[g, 2] = gauges[g, 1], pull, 0.0


@njit(cache=True, error_model="numpy")
def note_landings(A: Array, bed: Array, falls: Array) -> None:
    """Keep the highest speed with which each node came down on the bed [eq:flexible-landing].

    ``falls`` (2, n) holds the speed down of what is over the bed, and the highest at a landing.
    """
    for i in range(falls.shape[1]):
        level, nx, ny, nz = bed[0], 0.0, 0.0, 1.0
        if bed.size > FLAT:
            level, nx, ny, nz = ground(bed, A[X + i], A[Y + i])
        if A[Z + i] > level:
            falls[0, i] = -(nx * A[U + i] + ny * A[V + i] + nz * A[W + i])
        elif falls[0, i] > 0.0:
            falls[1, i] = max(falls[1, i], falls[0, i])
            falls[0, i] = 0.0


@njit(cache=True, error_model="numpy")
def water_at(A: Array, waves: Waves, now: float) -> None:
    """Write the water at the nodes, on its straight way from the start of the call."""
    moving, _, water, rate, begin = waves
    if moving:
        for r in range(7):
            for i in range(water.shape[1]):
                A[WU + r * ROW + i] = water[r, i] + (now - begin) * rate[r, i]


@njit(cache=True, error_model="numpy")
def bar_forces(
    A: Array, sizes: IntArray, runs: IntArray, curves: Array, hinges: IntArray, bending: Array, parts: Parts
) -> None:
    """Write the forces of all that is elastic and of net panels at the present state."""
    panels, rings, sheets, _ = parts
    if runs.shape[0] > 0 or hinges.shape[0] > 0 or has_further_forces(panels, rings, sheets):
        for axis in range(3):
            for i in range(sizes[0]):
                A[TX + axis * ROW + i] = A[PX + axis * ROW + i]
        rib_forces(A, runs, curves)
        bending_forces(A, hinges, bending)
        screen_forces(A, panels)
        add_sheet_forces(A, sheets)
        add_ring_forces(A, rings)
    spine_forces(A, sizes[1])


@njit(cache=True, error_model="numpy")
def book_driven(
    A: Array, ledger: Array, driven: IntArray, moved: Array, drawn: Array, push: float, share: float, gone: float
) -> None:
    """Book work and impulse at driven points.

    Work against the bars goes by the trapezoidal rule over the path ``moved``, which then begins anew; ``drawn`` is the
    pull at its start. The impulse is that of the loads over ``push`` seconds and of the bars over ``share`` seconds,
    with its moment about the start of the call, ``gone`` seconds ago.
    """
    for d in range(driven.shape[0]):
        node = driven[d, 0]
        for axis in range(3):
            pull, load = -node_force(A, node, axis), A[PX + axis * ROW + node]
            ledger[1] += 0.5 * (pull + drawn[d, axis]) * moved[d, axis]
            drawn[d, axis], moved[d, axis] = pull, 0.0
            ledger[LEDGER + 6 * d + axis] += push * load - share * pull
            ledger[LEDGER + 6 * d + 3 + axis] += push * (gone + 0.5 * push) * load - share * gone * pull


@njit(cache=True, error_model="numpy")
def path_of_driven(A: Array, driven: IntArray, moved: Array) -> None:
    """Turn zeros into the places of driven points, and those into the way since."""
    for d in range(driven.shape[0]):
        for axis in range(3):
            moved[d, axis] = A[X + axis * ROW + driven[d, 0]] - moved[d, axis]


@njit(cache=True, error_model="numpy")
def kinetic_energy_now(A: Array, count: int, blocks: Blocks) -> float:
    """Return the kinetic energy of nodes and dense blocks [J]."""
    return kinetic_energy(A, count) + section_energy(A, blocks)


@njit(cache=True, error_model="numpy")
def kinetic_energy_of_row(A: Array, count: int, blocks: Blocks, step: float, keep: Array) -> float:
    """Return the kinetic energy by the product of the velocities half a step before and after [J].

    With it leapfrog keeps the energy of linear motion exactly, at any step [eq:flexible-discrete-energy].
    """
    for axis in range(3):
        for i in range(count):
            keep[axis, i] = A[U + axis * ROW + i]
    kick_sections(A, blocks, 0.5 * step, -1e300)
    kick_and_drift(A, count, 0.5 * step, 0.0)
    kinetic = kinetic_energy_now(A, count, blocks)
    for axis in range(3):
        for i in range(count):
            A[U + axis * ROW + i] -= keep[axis, i]
    kinetic -= kinetic_energy_now(A, count, blocks)
    for axis in range(3):
        for i in range(count):
            A[U + axis * ROW + i] = keep[axis, i]
    return kinetic


@njit(cache=True, error_model="numpy")
def save_row(A: Array, out: int, saved: Saved, spine: int, runs: IntArray) -> None:
    """Write places and tensions of a row and begin the highest tensions anew."""
    places, pulls, peaks, _, keep_nodes, keep_bars = saved
    for j in range(keep_nodes.size):
        for axis in range(3):
            places[out, j, axis] = A[X + axis * ROW + keep_nodes[j]]
    for j in range(keep_bars.size):
        pulls[out, j] = A[PULL + keep_bars[j]]
        peaks[out, j] = A[PEAK + keep_bars[j]]
    for i in range(spine):
        A[PEAK + i] = A[PULL + i]
    for r in range(runs.shape[0]):
        for i in range(runs[r, 3]):
            k = RIB + runs[r, 2] + i
            A[PEAK + k] = A[PULL + k]


@njit(cache=True, error_model="numpy", fastmath=FAST, pointer=True)
def march(
    A: Array, sizes: IntArray, runs: IntArray, curves: Array, hinges: IntArray, bending: Array, attached: IntArray,
    fluid: Array, waves: Waves, driving: Driving, bed: Array, timing: Timing, ledger: Array, saved: Saved, parts: Parts,
    watch: Watch,
) -> int:  # fmt: skip
    """Advance by whole rows of the result; the array ``A`` and the ledger change in place.

    The tuples are those of :mod:`moyai.flexible.explicit_types`. ``ledger`` holds 0 work of the loads, 1 work at driven
    points, 2 turn of the added mass, 3 the last load interval, 4 whether loads are known, 5 whether the velocities
    stand half a step behind, and from ``LEDGER`` on the impulses on driven points. Returns the number of good rows,
    fewer than asked for when values are no longer finite, and negative when drag has outrun the step, which has to be
    chosen anew before the march continues: at the end of that row, or within it, which then does not count as good.

    With no row to do it evaluates the loads of the present state and no more, with one row less than none it writes the
    row of the start: what is called once a run is then compiled but once, as a part of the march.

    Load intervals shrink by themselves while drag is faster than at the start: loads that are held while nodes move to
    and fro would give them energy.
    """
    count, spine = sizes[0], sizes[1]
    driven, rest, tables, table_start, table_step = driving
    level, friction, has_bed = bed[0], bed[1], bed[3] > 0.0
    floor = level if has_bed else -1e300
    moving, surface = waves[0], waves[1]
    start, step, per_load, per_row, rows, first_row, before = timing
    panels, rings, sheets, blocks = parts
    gauge_bars, gauges, falls, broken, most, bear = watch
    broken[0] = -1
    if rows <= 0:
        if rows == 0:
            loads(A, sizes, runs, attached, fluid[0], fluid[1], surface, moving, 0.0, sheets)
            section_loads(A, blocks, moving)
        else:
            rib_forces(A, runs, curves)
            spine_forces(A, spine)
            save_row(A, first_row, saved, spine, runs)
            energy, pulls, peaks = saved[3], saved[1], saved[2]
            for j in range(pulls.shape[1]):
                peaks[first_row, j] = pulls[first_row, j]
            energy[first_row, 0] = kinetic_energy_now(A, count, blocks)
            elastic = elastic_energy(A, sizes, runs, curves, hinges, bending, bed)
            energy[first_row, 1] = elastic + elastic_energy_of_sheets(A, sheets) + ring_energy(A, rings)
            energy[first_row, 2] = 0.0
        return 0
    push_of_pressure = first_push(A, count, sheets)
    # without room for their impulses no work of driven points is booked
    booked = driven[: (ledger.size - LEDGER) // 6]
    moved, drawn, keep = np.zeros((booked.shape[0], 3)), np.zeros((booked.shape[0], 3)), np.empty((3, count))
    total = per_row * per_load
    rate = rate_of_drag(A, spine, runs, attached, sheets)
    speeds, panels_last, panels_next, held, damped = room_for_speeds(panels), -1, 0, 1, 0.0
    for row in range(rows):
        done = 0
        while done < total:
            # one step at first, then at most twice the interval before: what is let go soon flies fast
            size = min(per_load, total - done, max(1, int(2.0 * ledger[3] / step + 0.5)))
            if rate * step * size > most:
                size = max(1, int(most / (rate * step)))
            index = row * total + done
            # the velocities stand half a step behind but in the first step of all; the forces of dense blocks exchange
            # energy with their turning frames, which is booked at these velocities
            back = 0.5 * step if blocks is None and ledger[5] > 0.0 else 0.0
            ledger[0] -= back * load_power(A, count)
            water_at(A, waves, start + index * step)
            turning = kinetic_energy_now(A, count, blocks)
            loads(A, sizes, runs, attached, fluid[0], fluid[1], surface, moving, size * step, sheets)
            # loads of panels are found for several steps, where they damp nodes slowly at the speed to which the last
            # two times lead in their middle; velocities stand half a step behind
            due, held = index >= panels_next, max(size, held - held % size)
            calm = panels_last >= 0 and damped * step * held <= 1.0
            onward = 0.5 * (held + 1) / (index - panels_last) if calm else 0.0
            found = screens(A, count, panels, 0.5 * fluid[0], held * step, step, due, speeds, onward)
            if due:
                panels_last, panels_next, damped = index, index + held, found
                held = min(PANEL_STEPS, max(1, int(1.0 / (damped * step + 1e-9))))
            rate = rate_of_drag(A, spine, runs, attached, sheets)
            if rate * step * size > 1.5 * most:
                size = max(1, int(most / (rate * step)))
            section_loads(A, blocks, moving)
            if ledger[4] == 0.0:
                for axis in range(3):
                    for i in range(count):
                        A[BX + axis * ROW + i] = A[QX + axis * ROW + i]
                ledger[3], ledger[4] = size * step, 1.0
            else:
                ledger[2] += kinetic_energy_now(A, count, blocks) - turning
            # beyond that the values are on their way to infinity: the end of the row says so
            if bear < rate * step < 1e4:
                broken[0] = done
                break
            extrapolate(A, count, min(0.5 * size * step / ledger[3], 1.0))
            ledger[3] = size * step
            ledger[0] += back * load_power(A, count) - load_work(A, count)
            touching = has_bed and _touching(A, count, bed, size * step)
            if touching:
                note_landings(A, bed, falls)
            for inner in range(size):
                bar_forces(A, sizes, runs, curves, hinges, bending, parts)
                read_gauges(A, gauge_bars, gauges)
                # half a step of the bars at both ends of a row
                share = (0.5 if done + inner == 0 else 1.0) * step
                book_driven(A, ledger, booked, moved, drawn, step, share, before + (index + inner) * step)
                path_of_driven(A, booked, moved)
                push = step
                if ledger[5] == 0.0:
                    push = 0.5 * step
                    ledger[5] = 1.0
                kick_sections(A, blocks, push, floor)
                if touching and bed.size > FLAT:
                    kick_on_ground_and_drift(A, count, bed, friction, push, step)
                elif touching and friction > 0.0:
                    kick_with_friction_and_drift(A, count, level, friction, push, step)
                elif touching:
                    kick_contact_and_drift(A, count, level, push, step)
                else:
                    kick_and_drift(A, count, push, step)
                drive(A, driven, rest, tables, table_start, table_step, start + (index + inner + 1) * step, step)
                path_of_driven(A, booked, moved)
                ledger[0] += screen_work(A, panels, push)
            ledger[0] += load_work(A, count) + pressure_work(A, count, sheets, push_of_pressure)
            done += size
        if broken[0] == 0:
            return -(row + 1)
        # the state at the time of the row: forces here, half a kick
        bar_forces(A, sizes, runs, curves, hinges, bending, parts)
        book_driven(A, ledger, booked, moved, drawn, 0.0, 0.5 * step, before + (row * total + done) * step)
        if broken[0] > 0:
            return -(row + 1)
        out, energy = first_row + row, saved[3]
        energy[out, 0] = kinetic_energy_of_row(A, count, blocks, step, keep)
        elastic = elastic_energy(A, sizes, runs, curves, hinges, bending, bed)
        energy[out, 1] = elastic + elastic_energy_of_sheets(A, sheets) + ring_energy(A, rings)
        energy[out, 2] = ledger[0] + ledger[1] + ledger[2]
        save_row(A, out, saved, spine, runs)
        if not (energy[out, 0] + energy[out, 1] < np.inf):
            return row
        if rate * step > most and row + 1 < rows:
            return -(row + 1)
    return rows
