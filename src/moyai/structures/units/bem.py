"""Radiation and diffraction of all units together, by panels and Green's identity.

Time factor e^{-i omega t}. The potential on the panels follows from its normal velocity [eq:units-green]: that of the
hull, none on lids inside of hulls; the surface in a gap may be damped [eq:units-gap-lid]. All motions of all units and
all headings are solved with one factorisation for each parity.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from moyai.core.arrays import Array, ComplexArray, IntArray
from moyai.core.errors import InputError
from moyai.sea.dispersion import wave_number
from moyai.sea.water import Water
from moyai.structures.units.mesh import GAP, HULL, PanelMesh
from moyai.structures.units.rankine_kernel import rankine_layers
from moyai.structures.units.symmetry import Symmetry, symmetry_of
from moyai.structures.units.variation import (
    Variation,
    even_variation,
    gauss_points,
    images_of,
    log_terms,
    rankine_terms,
    variation_of,
)
from moyai.structures.units.wave_green import WaveGreen, far_factor

#: Bytes of a complex number
_COMPLEX = 16
#: Least kh of the Green function in finite depth
LEAST_DEPTH = 0.1
#: Directions of the far field at least, and how far beyond their last order its waves fade: below 1e-8
FEWEST_DIRECTIONS, FADING = 180, 8.0
#: Points whose field is evaluated at once
_BATCH = 500
#: Points a direction on panels far from a source
_POINTS = 4


@dataclass(frozen=True, eq=False)
class MeshPanels:
    """A mesh with what a solution needs of it."""

    mesh: PanelMesh
    #: Normal displacement of every panel in every motion; zero on lids; shape (m, n).
    modes: Array
    symmetry: Symmetry
    #: epsilon of the lids in the gaps.
    gap_damping: float = 0.0
    #: Whether potentials are taken as even over a panel, as other programs do: for comparisons.
    even: bool = False

    @cached_property
    def variation(self) -> Variation:
        """How quantities vary over the panels."""
        return even_variation(self.mesh) if self.even else variation_of(self.mesh)

    @cached_property
    def _gauss(self) -> tuple[Array, Array, Array]:
        """Radii (n,) [m], points (n, p, 3) on the panels and their areas (n, p)."""
        radius = np.linalg.norm(self.mesh.corners - self.mesh.centre[:, None], axis=2).max(axis=1)
        return radius, *gauss_points(self.mesh.corners, _POINTS)

    @cached_property
    def wave_panels(self) -> tuple[Array, ...]:
        """The panels as :func:`moyai.structures.units.wave_green_kernel.wave_layers` takes them."""
        given = self.mesh.centre, self.mesh.normal, self.variation.areas
        return tuple(np.ascontiguousarray(item) for item in given)

    def reach(self, points: Array) -> float:
        """Return the largest distance in plan [m] of points (p, 2 or 3) from panels."""
        every = np.concatenate([points[:, :2], self.mesh.centre[:, :2], self.mesh.corners[:, :, :2].reshape(-1, 2)])
        return float(np.linalg.norm(np.ptp(every, axis=0)))

    @cached_property
    def middle(self) -> Array:
        """Middle of the hulls in plan (2,) [m], about which far waves are taken."""
        plan = self.mesh.centre[:, :2]
        return np.asarray(0.5 * (plan.min(axis=0) + plan.max(axis=0)))

    def direction_count(self, k: float) -> int:
        """Return how many directions hold the far waves of a wave number [1/m] [eq:units-directions].

        Their Fourier orders fade beyond k times the distance of the hulls from their middle.
        """
        across = k * float(np.linalg.norm(self.mesh.centre[:, :2] - self.middle, axis=1).max())
        return max(FEWEST_DIRECTIONS, 2 * int(np.ceil(across + FADING * across ** (1.0 / 3.0) + 10.0)))

    @property
    def lowest(self) -> float:
        """Level of the deepest corner [m]."""
        return float(self.mesh.corners[..., 2].min())

    def rankine(self, depth: float) -> tuple[Array, Array]:
        """Return single and double layer (q, n) of 1/r and its mirrors on the part, in water of a depth [m]."""
        kept: dict[float, tuple[Array, Array]] = self.__dict__.setdefault("_rankine", {})
        if depth not in kept:
            part = self.symmetry.part
            if self.even:
                kept[depth] = self.even_rankine(self.mesh.centre[part], depth)
            else:
                kept[depth] = rankine_terms(self.mesh, part, self.variation, depth, self.even_layers)
        return kept[depth]

    @cached_property
    def logarithm(self) -> tuple[Array, Array]:
        """Single and double layer (q, n), over K, of what grows like a logarithm near the surface, on the part."""
        return log_terms(self.mesh, self.mesh.centre[self.symmetry.part], self.variation, self.even_layers)

    def even_rankine(self, points: Array, depth: float) -> tuple[Array, Array]:
        """Return the same of even panels at any points (p, 3) in the water."""
        found = [self.even_layers(point) for point, _ in images_of(points, depth)]
        return sum(one for one, _ in found), sum(two for _, two in found)  # type: ignore[return-value]

    def even_layers(self, points: Array) -> tuple[Array, Array]:
        """Return single and double layer (p, n) of -1/(4 pi r) of even panels at points (p, 3)."""
        mesh = self.mesh
        given = tuple(np.ascontiguousarray(item) for item in (mesh.corners, mesh.centre, mesh.normal, *self._gauss))
        single, double = np.zeros((2, len(points), mesh.count))
        rankine_layers(np.ascontiguousarray(points), given, single, double)
        return single, double


def panels_of(mesh: PanelMesh, centres: Array, gap_damping: float = 0.0) -> MeshPanels:
    """Return the panels with six motions of every unit about its centre (u, 3) [m], in axes of the row."""
    normal, point = mesh.normal, mesh.centre
    modes = np.zeros((6 * len(centres), mesh.count))
    for number, centre in enumerate(centres):
        mine = (mesh.unit == number) & (mesh.part == HULL)
        modes[6 * number : 6 * number + 3, mine] = normal[mine].T
        modes[6 * number + 3 : 6 * number + 6, mine] = np.cross(point[mine] - centre, normal[mine]).T
    return MeshPanels(mesh, modes, symmetry_of(mesh), gap_damping)


def memory_needed(count: int, group: int = 1) -> float:
    """Return the memory [bytes] that one frequency takes with ``count`` panels and a group of mirrors."""
    part = count / group
    return _COMPLEX * part**2 * (4.0 * group + 4.0)


def memory_of_machine() -> float:
    """Return the memory that is free [bytes]; infinite where the system does not say."""
    try:
        with open("/proc/meminfo", encoding="ascii") as lines:
            for line in lines:
                if line.startswith("MemAvailable"):
                    return 1024.0 * float(line.split()[1])
    except OSError:
        pass
    return math.inf


def check_memory(panels: MeshPanels) -> None:
    """Refuse a mesh that the machine cannot hold, before the work starts.

    Raises
    ------
    InputError
    """
    needed, free = memory_needed(panels.mesh.count, len(panels.symmetry.mirrors)), memory_of_machine()
    if needed > free:
        raise InputError(
            f"{panels.mesh.count} panels need {needed / 2**30:.1f} GiB, {free / 2**30:.1f} GiB are free",
            parameter="settings.panel_size",
            remedy="give larger panels, fewer units, or a machine with more memory",
        )


@dataclass(frozen=True, eq=False)
class Solution:
    """Everything at one frequency."""

    #: Angular frequency [rad/s].
    omega: float
    #: Wave number [1/m].
    wave_number: float
    #: Added mass of all motions: force in row i by motion j; shape (m, m).
    added_mass: Array
    #: Damping of all motions: force in row i by motion j; shape (m, m).
    damping: Array
    #: Force of a wave of unit amplitude, phase at the origin of the row; shape (h, m).
    excitation: ComplexArray
    #: Potential on the panels per unit displacement; in gaps the sources of the damped surface; shape (n, m).
    radiation: ComplexArray
    #: Potential on the panels per unit wave amplitude, incident wave left out; in gaps as above; shape (n, h).
    diffraction: ComplexArray
    #: Amplitude A of the far waves A sqrt(2 / (pi k R)) e^{i (k R - pi/4)} per unit displacement, R from the middle of
    #: the hulls; shape (m, directions).
    radiated: ComplexArray
    #: Amplitude A of the same far waves per unit wave amplitude; shape (h, directions).
    scattered: ComplexArray
    #: Largest departure of the excitation from that of the radiation alone, a kind of motion; shape (6,).
    haskind: Array

    def among(self, columns: IntArray) -> Solution:
        """Return the solution in some of its headings."""
        return replace(
            self, excitation=self.excitation[columns], diffraction=self.diffraction[:, columns],
            scattered=self.scattered[columns],
        )  # fmt: skip


def directions(count: int) -> Array:
    """Return so many directions of the far field [rad]."""
    return np.arange(count) * 2.0 * math.pi / count


def in_directions(waves: ComplexArray, count: int) -> ComplexArray:
    """Return far waves (..., d) in so many directions, no fewer, by their Fourier series."""
    given = waves.shape[-1]
    if given == count:
        return waves
    series, half = np.fft.fft(waves), given // 2
    out = np.zeros((*waves.shape[:-1], count), dtype=complex)
    out[..., :half], out[..., half - given :] = series[..., :half], series[..., half:]
    return np.asarray(np.fft.ifft(out) * (count / given))


def solve_frequency(panels: MeshPanels, water: Water, omega: float, headings: Array) -> Solution:
    """Solve all motions and all headings at one frequency.

    Parameters
    ----------
    panels : Panels
    water : Water
    omega : float
        [rad/s].
    headings : ndarray (h,)
        Directions of travel [rad].

    Raises
    ------
    InputError
        For waves longer than 63 depths, which the Green function does not reach.
    """
    mesh = panels.mesh
    k = float(wave_number(omega, water.depth, water.gravity))
    check_longest(water, omega)
    incident, incident_normal = incident_on(mesh, water, omega, k, headings)
    given = given_flow(panels, water, omega, k, headings)
    surface = _solved(panels, water, omega, given, incident)
    count = len(panels.modes)
    wet = mesh.part != GAP
    areas = panels.variation.areas
    weights = panels.modes * areas
    force = -1j * omega * water.density * (weights[:, wet] @ surface[wet])
    on_motion = force[:, :count]
    froude_krylov = -1j * omega * water.density * (weights @ incident)
    excitation = (froude_krylov + force[:, count:]).T
    # the same from the radiation alone [eq:units-haskind]
    hull = mesh.part == HULL
    flow = (incident_normal[hull] * areas[hull, None]).T
    by_radiation = froude_krylov.T - water.density * flow @ surface[hull, :count]
    damped = (incident[~wet] * areas[~wet, None]).T
    by_radiation = by_radiation + water.density * damped @ surface[~wet, :count]
    angles = directions(panels.direction_count(k))
    far = far_amplitudes(panels, water, omega, k, surface, given, angles, panels.middle)
    return Solution(
        omega, k, on_motion.real / omega**2, on_motion.imag / omega, excitation, surface[:, :count],
        surface[:, count:], far[:count], far[count:], _departure(excitation, by_radiation),
    )  # fmt: skip


def given_flow(panels: MeshPanels, water: Water, omega: float, k: float, headings: Array) -> ComplexArray:
    """Return the normal velocities (n, r) of all unit motions and of all scattered waves; zero on lids."""
    incident_normal = incident_on(panels.mesh, water, omega, k, headings)[1]
    hull = (panels.mesh.part == HULL)[:, None]
    return np.concatenate([-1j * omega * panels.modes.T, np.where(hull, -incident_normal, 0.0)], axis=1)


def _departure(first: ComplexArray, second: ComplexArray) -> Array:
    return np.asarray(np.abs(first - second).reshape(len(first), -1, 6).max(axis=(0, 1)))


def check_longest(water: Water, omega: float) -> None:
    """Refuse waves that are too long for the depth.

    Raises
    ------
    InputError
    """
    relative = float(wave_number(omega, water.depth, water.gravity)) * water.depth
    if relative < LEAST_DEPTH:
        raise InputError(
            f"waves of {2.0 * math.pi / omega:.4g} s are {2.0 * math.pi / relative:.0f} depths long",
            parameter="waves",
            allowed=f"up to {2.0 * math.pi / LEAST_DEPTH:.0f} depths",
            remedy="leave such long waves out: they pass the row as if it were not there",
        )


def _depth_profile(z: Array, k: float, depth: float) -> Array:
    """Return cosh k(z + h) / cosh kh of [eq:units-far-field]."""
    if math.isinf(depth):
        return np.asarray(np.exp(k * z))
    return np.asarray((np.exp(k * z) + np.exp(-k * (z + 2.0 * depth))) / (1.0 + math.exp(-2.0 * k * depth)))


def incident_potential(point: Array, water: Water, omega: float, k: float, headings: Array) -> ComplexArray:
    """Return the potential of incident waves of unit amplitude at points (n, 3), shape (n, h)."""
    phase = np.exp(1j * k * (point[:, [0]] * np.cos(headings) + point[:, [1]] * np.sin(headings)))
    return np.asarray(-1j * water.gravity / omega * _depth_profile(point[:, 2], k, water.depth)[:, None] * phase)


def incident_on(
    mesh: PanelMesh, water: Water, omega: float, k: float, headings: Array
) -> tuple[ComplexArray, ComplexArray]:
    """Return the potential of incident waves of unit amplitude and its normal derivative at the panels (n, h)."""
    point, normal = mesh.centre, mesh.normal
    cosine, sine = np.cos(headings), np.sin(headings)
    slope = -1j * water.gravity / omega * k * np.exp(1j * k * (point[:, [0]] * cosine + point[:, [1]] * sine))
    across = (
        1j * (normal[:, [0]] * cosine + normal[:, [1]] * sine) * _depth_profile(point[:, 2], k, water.depth)[:, None]
    )
    upward = normal[:, [2]] * _sinh_profile(point[:, 2], k, water.depth)[:, None]
    return incident_potential(point, water, omega, k, headings), slope * (across + upward)


def _sinh_profile(z: Array, k: float, depth: float) -> Array:
    """Return sinh k(z + h) / cosh kh."""
    if math.isinf(depth):
        return np.asarray(np.exp(k * z))
    return np.asarray((np.exp(k * z) - np.exp(-k * (z + 2.0 * depth))) / (1.0 + math.exp(-2.0 * k * depth)))


def _layers_on_part(panels: MeshPanels, water: Water, omega: float) -> tuple[ComplexArray, ComplexArray]:
    """Return single and double layer (q, n) of all panels on the part, of values at the centres."""
    part = panels.symmetry.part
    centre = panels.mesh.centre
    green = WaveGreen.of(water, omega, panels.reach(centre), panels.lowest)
    single, double = green.layers(centre[part], panels.wave_panels)
    rankine, logarithm = panels.rankine(water.depth), panels.logarithm
    for layer, steady, growing in zip((single, double), rankine, logarithm):
        layer += steady
        layer += green.surface_number * growing
    # the jump of the double layer at its own panel, on both sides of a panel in the surface
    level = np.abs(centre[part, 2]) < 1e-9
    double[np.arange(len(part)), part] += np.where(level, 1.0, 0.5)
    return single, double


def _solved(
    panels: MeshPanels, water: Water, omega: float, given: ComplexArray, incident: ComplexArray
) -> ComplexArray:
    """Return the potentials (n, r) of given normal velocities; in gaps the sources of the damped surface.

    Parity by parity [eq:units-symmetry]: the double layer of the potential on hulls and lids equals the single layer of
    the normal velocity [eq:units-green], and the surface in a gap is a source of its own [eq:units-gap-lid].
    """
    mesh, group = panels.mesh, panels.symmetry
    layers = _layers_on_part(panels, water, omega)
    gap = mesh.part[group.part] == GAP
    rate = 1j * panels.gap_damping * omega**2 / water.gravity
    moved = np.zeros_like(given)
    moved[:, given.shape[1] - incident.shape[1] :] = incident
    flow, wave = group.split(given), group.split(moved)
    found = np.empty_like(flow)
    for number, parity in enumerate(group.parities):
        single, matrix = (sum(sign * layer[:, image] for sign, image in zip(parity, group.images)) for layer in layers)
        right = single @ flow[number]
        if gap.any():
            matrix[gap] *= -rate
            matrix[np.ix_(~gap, gap)] = -single[np.ix_(~gap, gap)]
            matrix[np.ix_(gap, gap)] = np.eye(int(gap.sum())) + rate * single[np.ix_(gap, gap)]
            right[gap] = -rate * (right[gap] + wave[number][gap])
        found[number] = np.linalg.solve(matrix, right)
    return group.joined(found)


def _layers(panels: MeshPanels, surface: ComplexArray, given: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
    """Return the densities of the single and of the double layer (n, r) of a solution."""
    gap = (panels.mesh.part == GAP)[:, None]
    return np.where(gap, surface, given), np.where(gap, 0.0, surface)


def far_amplitudes(
    panels: MeshPanels, water: Water, omega: float, k: float, surface: ComplexArray, given: ComplexArray,
    angles: Array, about: Array,
) -> ComplexArray:  # fmt: skip
    """Return the amplitudes (r, directions) of the far waves, about a point (2,), of solutions (n, r)
    [eq:units-far-field]."""
    mesh = panels.mesh
    centre, normal, area = mesh.centre, mesh.normal, panels.variation.areas[:, None]
    cosine, sine = np.cos(angles), np.sin(angles)
    apart = centre[:, :2] - about
    phase = np.exp(-1j * k * (apart[:, [0]] * cosine + apart[:, [1]] * sine))
    profile = _depth_profile(centre[:, 2], k, water.depth)[:, None]
    rate = _sinh_profile(centre[:, 2], k, water.depth)[:, None]
    across = normal[:, [0]] * cosine + normal[:, [1]] * sine
    single, double = _layers(panels, surface, given)
    slope = k * (normal[:, [2]] * rate - 1j * across * profile) * phase
    total = single.T @ (area * profile * phase) - double.T @ (area * slope)
    return np.asarray(0.5 * far_factor(omega**2 / water.gravity, k, water.depth) * omega / water.gravity * total)


def elevation_at(
    points: Array, panels: MeshPanels, water: Water, omega: float, surface: ComplexArray, given: ComplexArray,
    steady: ComplexArray | None = None,
) -> ComplexArray:  # fmt: skip
    """Return the surface elevation (p, r) [m] at points (p, 2) of the row that solutions (n, r) make.

    ``steady`` is what :func:`steady_potentials` gives for the frequency.
    """
    if steady is None:
        (steady,) = steady_potentials(points, panels, water, [(omega, surface, given)])
    single, double = _layers(panels, surface, given)
    green = WaveGreen.of(water, omega, panels.reach(points), panels.lowest)
    level, out = _in_surface(points), steady.copy()
    for start in range(0, len(points), _BATCH):
        some = slice(start, start + _BATCH)
        of_single, of_double = green.layers(level[some], panels.wave_panels)
        out[some] += of_single @ single - of_double @ double
    return np.asarray(1j * omega / water.gravity * out)


def steady_potentials(
    points: Array, panels: MeshPanels, water: Water, solutions: Sequence[tuple[float, ComplexArray, ComplexArray]]
) -> list[ComplexArray]:
    """Return the potential (p, r) of 1/r, its mirrors and the logarithm at points (p, 2) of the surface.

    Their layers are the same for all frequencies and too large to be kept: frequencies, solutions and given flows
    (n, r) come together.
    """
    share = (panels.variation.areas / panels.mesh.area)[:, None]
    layers = [_layers(panels, surface, given) for _, surface, given in solutions]
    level = _in_surface(points)
    out = [np.empty((len(points), surface.shape[1]), dtype=complex) for _, surface, _ in solutions]
    for start in range(0, len(points) if out else 0, _BATCH):
        some = slice(start, start + _BATCH)
        one, two = panels.even_rankine(level[some], water.depth)
        three, four = log_terms(panels.mesh, level[some], panels.variation, panels.even_layers)
        for (omega, _, _), (single, double), found in zip(solutions, layers, out, strict=True):
            found[some] = one @ (share * single) - two @ (share * double)
            found[some] += omega**2 / water.gravity * (three @ single - four @ double)
    return out


def _in_surface(points: Array) -> Array:
    return np.concatenate([points, np.zeros((len(points), 1))], axis=1)
