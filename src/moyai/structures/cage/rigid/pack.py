"""From the parts of a rigid cage to the flat arrays of its compiled mechanics."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from moyai.core.arrays import Array
from moyai.core.remembered import Remembered, key_of_objects
from moyai.morison.net_law_names import Net, NetLaw
from moyai.sea.components import WaveComponents
from moyai.sea.current import CurrentProfile
from moyai.sea.kinematics import stretching_code
from moyai.sea.water import Water
from moyai.structures.cage.rigid.lines import CageLine
from moyai.structures.cage.rigid.parts import RigidCage
from moyai.structures.cage.rigid.wake import shelter
from moyai.structures.cage.rigid.water_kernel import PackedCage

SPHERE_COLUMNS = ("r_x", "r_z", "radius", "count", "drag", "fluid_factor", "body_factor")
PATCH_COLUMNS = (
    "r_x",
    "r_z",
    "normal_x",
    "normal_z",
    "area",
    "volume",
    "half",
    "froude_krylov",
    "added_mass",
    "relative",
    "current_factor",
)
ROD_COLUMNS = (
    "r_x",
    "r_z",
    "axis_x",
    "axis_z",
    "length",
    "diameter",
    "volume",
    "drag",
    "added_mass",
    "relative",
    "froude_krylov",
    "count",
)
BLOCK_COLUMNS = ("r_x", "r_z", "volume", "fluid_factor", "body_factor", "area_x", "area_z")
LINE_COLUMNS = ("attachment_x", "attachment_z", "anchor_x", "anchor_z", "length", "stiffness", "damping", "sense")

#: Angles from normal to parallel flow, and speeds [m/s] by decade, of the table of a net law
TABLE_ANGLES = 65
TABLE_PER_DECADE = 40
TABLE_DECADES = (-4, 1.5)

#: Up to this number waves are summed at every part of the cage, beyond it into a series about it
FEW_WAVES = 4
#: Error of the series at its rim and of the cubic between its times, over the amplitude of the shortest wave
SERIES_ERROR = 1e-3
#: Most terms of the series, of a phase of 32 across it, where rounding comes to a hundredth of the shortest wave, a
#: component of hardly any height; beyond it waves are too short for the cage and are summed at every part
MOST_TERMS = 92
#: Times of the series that are kept
KEPT_TIMES = 16

#: Gauss points along a rod in the plane of motion
ROD_POINTS = 3


def law_tables(law: NetLaw, net: Net, kinematic_viscosity: float) -> tuple[Array, Array, Array]:
    """Return normal and tangential coefficients over angle and log10 of the speed, with start and step of the latter.

    A law answers with drag and lift; along normal and panel these are [eq:cage-net-components].
    """
    angle = np.linspace(0.0, 0.5 * math.pi, TABLE_ANGLES)
    low, high = TABLE_DECADES
    count = round((high - low) * TABLE_PER_DECADE) + 1
    exponent = np.linspace(low, high, count)
    turned, speed = np.meshgrid(angle, 10.0**exponent, indexing="ij")
    drag, lift = law.coefficients(turned, speed, net, kinematic_viscosity)
    normal = drag * np.cos(turned) + lift * np.sin(turned)
    along = drag * np.sin(turned) - lift * np.cos(turned)
    # by symmetry nothing acts along a panel across the flow, nor across a panel along it
    along[0], normal[-1] = 0.0, 0.0
    axis = np.array([low, (high - low) / (count - 1)])
    return np.ascontiguousarray(normal), np.ascontiguousarray(along), axis


def _merged(rows: Array, keys: tuple[int, ...], sums: tuple[int, ...]) -> Array:
    """Merge rows that agree in ``keys`` (parts that differ in y only), adding the columns ``sums``."""
    if len(rows) == 0:
        return rows
    scale = max(float(np.abs(rows[:, keys]).max()), 1e-300)
    rounded = np.round(rows[:, keys] / scale, 9) + 0.0
    _, first, inverse = np.unique(rounded, axis=0, return_index=True, return_inverse=True)
    out = rows[first].copy()
    out[:, sums] = 0.0
    for column in sums:
        np.add.at(out[:, column], inverse.reshape(-1), rows[:, column])
    return np.ascontiguousarray(out)


def sphere_rows(cage: RigidCage) -> Array:
    """Return the rows of floats and weights."""
    x, z = cage.centre
    floats = cage.floats
    rows = [
        (p[0] - x, p[2] - z, 0.5 * floats.diameter, 1.0, floats.drag, 1.0 + floats.added_mass, floats.added_mass)
        for p in floats.points
    ]
    for weight in cage.weights:
        if weight.volume > 0.0:
            radius = (0.75 * weight.volume / math.pi) ** (1.0 / 3.0)
            added = weight.added_mass
            rows.append((weight.point[0] - x, weight.point[2] - z, radius, 1.0, weight.drag, 1.0 + added, added))
    array = np.array(rows, dtype=float).reshape(-1, len(SPHERE_COLUMNS))
    return _merged(array, (0, 1, 2, 4, 5, 6), (3,))


def patch_rows(cage: RigidCage, wake: Array | None = None) -> Array:
    """Return the rows of the net; ``wake`` is the share of the current that each patch sees."""
    x, z = cage.centre
    p = cage.patches
    rows = np.zeros((len(p.areas), len(PATCH_COLUMNS)))
    rows[:, 0], rows[:, 1] = p.points[:, 0] - x, p.points[:, 2] - z
    # a normal and its opposite are one panel: the one that points along +x, or up
    sign = np.where(p.normals[:, 0] + 1e-9 * p.normals[:, 2] < 0.0, -1.0, 1.0)
    rows[:, 2], rows[:, 3] = sign * p.normals[:, 0], sign * p.normals[:, 2]
    rows[:, 4], rows[:, 5], rows[:, 6] = p.areas, cage.net_volume * p.areas, p.halves
    rows[:, 7], rows[:, 8], rows[:, 9] = 1.0, cage.net_added_mass, 1.0
    rows[:, 10] = 1.0 if wake is None else wake
    return _merged(rows, (0, 1, 2, 3, 6, 10), (4, 5))


@cache
def _gauss(count: int) -> tuple[Array, Array]:
    nodes, weights = np.polynomial.legendre.leggauss(count)
    return nodes, weights


def rod_rows(cage: RigidCage) -> Array:
    """Return the rows of the frame, every rod cut into pieces along the plane of motion."""
    x, z = cage.centre
    rows = []
    for rod in cage.rods:
        if rod.diameter <= 0.0:
            continue
        a, b = np.array(rod.start), np.array(rod.end)
        along = (b - a) / rod.length
        # a rod across the plane of motion moves as one
        # nor does a short piece of a ring need more than its middle
        whole = abs(along[1]) > 1.0 - 1e-9 or rod.length < 0.25 * max(cage.extent)
        nodes, weights = _gauss(1 if whole else ROD_POINTS)
        # one sense of the axis, so that mirror images merge
        sign = -1.0 if along[0] + 1e-9 * along[2] < 0.0 else 1.0
        for node, weight in zip(nodes, 0.5 * weights):
            middle = a + 0.5 * (1.0 + node) * (b - a)
            place = (middle[0] - x, middle[2] - z, sign * along[0], sign * along[2])
            size = (weight * rod.length, rod.diameter, weight * rod.volume)
            rows.append((*place, *size, cage.rod_drag, cage.rod_added_mass, 1.0, 1.0, 1.0))
    array = np.array(rows, dtype=float).reshape(-1, len(ROD_COLUMNS))
    return _merged(array, (0, 1, 2, 3, 5), (4, 6, 11))


def line_rows(lines: tuple[CageLine, ...], centre: tuple[float, float]) -> Array:
    """Return the rows of the lines."""
    rows = [
        (
            line.attachment[0] - centre[0],
            line.attachment[1] - centre[1],
            line.anchor[0],
            line.anchor[1],
            line.length,
            line.stiffness,
            line.damping,
            1.0,
        )
        for line in lines
    ]
    return np.array(rows, dtype=float).reshape(-1, len(LINE_COLUMNS))


def component_rows(waves: WaveComponents | None, depth: float) -> Array:
    """Return the waves as rows omega, intrinsic omega, amplitude, phase, wave number, e^{-2kh}, sense of travel."""
    if waves is None:
        return np.zeros((7, 0))
    sense = np.where(np.cos(waves.heading) >= 0.0, 1.0, -1.0)
    number = waves.wave_number
    return np.ascontiguousarray(
        np.stack(
            [
                waves.omega,
                np.asarray(waves.intrinsic_omega),
                waves.amplitude,
                waves.phase,
                number,
                np.exp(-2.0 * number * depth),
                sense,
            ]
        )
    )


def series_rows(waves: WaveComponents | None, reach: float, stretching: str) -> tuple[Array, ...]:
    """Return numbers and empty store of the series that stands for many waves [eq:cage-series-of-waves].

    Parameters
    ----------
    waves : WaveComponents or None
    reach : float
        Farthest part of the cage from its centre of gravity [m].
    stretching : str
        A stretched column looks up water beyond the parts of the cage, by up to the crest.

    Returns
    -------
    tuple of ndarray
        Reach of the series [m], step of its times [s] and how far the cage may leave its middle [m]; the middle; depth
        functions; times and coefficients, which the march fills; powers of the reach over factorials, of even and odd
        order. No terms for few waves.
    """
    margin = 0.3 * reach
    whole = reach + margin
    terms = 0
    count = 0 if waves is None else len(waves)
    step = 1.0
    if waves is not None and count > FEW_WAVES:
        if stretching != "constant":
            whole += 3.0 * math.sqrt(0.5 * float(np.sum(waves.amplitude**2)))
        # Hermite's cubic errs by (omega step)^4 / 384
        step = (384.0 * 0.1 * SERIES_ERROR) ** 0.25 / float(np.max(np.abs(waves.omega)))
        terms = _term_count(float(waves.wave_number.max()) * whole)
    return (
        np.array([whole, step, margin]),
        np.full(2, math.nan),
        np.zeros((2, count if terms else 0)),
        np.full(KEPT_TIMES, math.inf),
        np.zeros((KEPT_TIMES, 10, terms)),
        _powers(waves, whole, terms),
    )


def _powers(waves: WaveComponents | None, reach: float, terms: int) -> Array:
    """Return (s k r)^n / n! of every wave, even and odd orders apart, their sign changing with every second order."""
    if waves is None or terms == 0:
        return np.zeros((2, 0, 0))
    # whole registers of a processor
    half = 8 * math.ceil(terms / 16)
    sense = np.where(np.cos(waves.heading) >= 0.0, 1.0, -1.0)
    orders = np.arange(1.0, 2 * half)
    steps = (sense * waves.wave_number * reach)[:, None] / orders
    powers = np.cumprod(np.concatenate([np.ones((len(waves), 1)), steps], axis=1), axis=1)
    signs = np.where(np.arange(half) % 2 == 0, 1.0, -1.0)
    return np.ascontiguousarray(signs * np.stack([powers[:, 0::2], powers[:, 1::2]]))


def _term_count(phase: float) -> int:
    """Return how many terms of exp represent it at ``phase`` within :data:`SERIES_ERROR`; 0 beyond the most."""
    term = 1.0
    for count in range(1, MOST_TERMS + 1):
        term *= phase / count
        if count > phase and term / (1.0 - phase / (count + 1)) < SERIES_ERROR:
            return max(count, 6)
    return 0


def current_rows(current: CurrentProfile | None, depth: float) -> Array:
    """Return heights and current along x [m], [m/s]."""
    if current is None:
        return np.zeros((2, 1))
    deepest = depth if math.isfinite(depth) else 100.0
    heights = np.linspace(-deepest, 0.0, 101)
    speed = current.in_depth(depth).velocity(heights)[:, 0]
    if np.ptp(speed) < 1e-15:
        return np.array([[0.0], [float(speed[-1])]])
    return np.stack([heights, speed])


_TABLES: Remembered[tuple[Array, Array, Array]] = Remembered(4)
_RODS: Remembered[Array] = Remembered(4)


def pack(
    cage: RigidCage,
    lines: tuple[CageLine, ...],
    water: Water,
    kinematic_viscosity: float,
    *,
    waves: WaveComponents | None = None,
    current: CurrentProfile | None = None,
    ramp: float = 0.0,
    stretching: str = "constant",
    wake: Array | None = None,
    damping: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> PackedCage:
    """Return the arrays of a cage in its water.

    Parameters
    ----------
    cage : RigidCage
    lines : tuple of CageLine
    water : Water
    kinematic_viscosity : float
        [m2/s].
    waves : WaveComponents or None
        Along +x or -x.
    current : CurrentProfile or None
    ramp : float
        Time over which the waves grow [s].
    stretching : {"constant", "wheeler"}
    wake : ndarray or None
        Share of the current at every patch; by the law of the cage when absent.
    damping : tuple of float
        Linear damping of sway, heave and rotation, only for the search of rest.
    """
    given = (cage.law, cage.net, kinematic_viscosity)
    tables = _TABLES.of(key_of_objects(*given), lambda: law_tables(*given))
    if wake is None and current is not None:
        wake = shelter(cage, current, water, kinematic_viscosity)
    arm = max(math.hypot(*cage.extent), 2.0 * float(np.abs(cage.floats.points).max())) / 2.0
    series = series_rows(waves, arm + 0.5 * cage.floats.diameter + math.hypot(*cage.centre), stretching)
    body = np.array([cage.mass, cage.inertia, cage.mass * water.gravity, 0.0, 1.0, -1.0, *damping])
    return PackedCage(
        spheres=sphere_rows(cage),
        patches=patch_rows(cage, wake),
        rods=_RODS.of(key_of_objects(cage), lambda: rod_rows(cage)).copy(),
        blocks=np.zeros((0, len(BLOCK_COLUMNS))),
        lines=line_rows(lines, cage.centre),
        body=body,
        water=np.array([water.density, water.gravity, water.depth, ramp, float(stretching_code(stretching))]),
        current=current_rows(current, water.depth),
        components=component_rows(waves, water.depth),
        normal_table=tables[0],
        tangential_table=tables[1],
        table_axis=tables[2],
        series=series[0],
        centre=series[1],
        depth_parts=series[2],
        summed_at=series[3],
        summed=series[4],
        powers=series[5],
    )
