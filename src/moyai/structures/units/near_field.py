"""Mean drift of every unit from the pressure on its own hull, which far waves do not tell apart [eq:units-near-field].

Time factor e^{-i omega t}; per square of the amplitude. The velocity along the hull is that of the parabolas through
neighbouring panels, the elevation at the waterline theirs as well. Towards a sharp edge the potential goes with the
powers of the distance that belong to a right angle, and the velocity without bound [eq:units-edge]. What is left of the
sum by the far field is shared [eq:units-shared-drift].
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from moyai.core.arrays import Array, ComplexArray, IntArray
from moyai.structures.units.assembly import RowAtLevel
from moyai.structures.units.bem import Panels, Solution, incident_on
from moyai.structures.units.mesh import HULL
from moyai.structures.units.variation import neighbours

#: Power of the distance from the edge of a right angle that the potential goes with
_POWER = 2.0 / 3.0


@dataclass(frozen=True, eq=False)
class Waterline:
    """Sides of hull panels in the still water surface.

    Parameters
    ----------
    panel : ndarray (w,) of int
        Panel of each side.
    middle : ndarray (w, 3)
        [m].
    normal : ndarray (w, 2)
        Level unit normal into the water.
    length : ndarray (w,)
        [m].
    """

    panel: IntArray
    middle: Array
    normal: Array
    length: Array


def waterline_of(panels: Panels) -> Waterline:
    """Return the waterline of all hulls."""
    mesh = panels.mesh
    corners = mesh.corners
    after = np.roll(corners, -1, axis=1)
    level = 1e-9 * max(1.0, float(np.abs(corners).max()))
    wet = (mesh.part == HULL)[:, None]
    length = np.linalg.norm(after - corners, axis=2)
    found = wet & (np.abs(corners[:, :, 2]) < level) & (np.abs(after[:, :, 2]) < level) & (length > level)
    panel, side = np.nonzero(found)
    normal = mesh.normal[panel, :2]
    return Waterline(
        panel, 0.5 * (corners + after)[panel, side], normal / np.linalg.norm(normal, axis=1)[:, None],
        length[panel, side],
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Edges:
    """Panels at sharp edges and those next to them, with the powers of the distance through three centres.

    Parameters
    ----------
    panel : ndarray (e,) of int
    axis : ndarray (e,) of int
        Direction of the panel that runs to the edge.
    sign : ndarray (e,)
        1 where the distance from the edge grows along the axis, else -1.
    place, inward : ndarray (e, 3)
        Middle of the edge [m] and unit vector from it over the hull.
    near, far : ndarray (e,)
        Distance of its sides from the edge [m].
    centres : ndarray (e, 3) of int
        Panels through whose centres the powers are drawn.
    reach : ndarray (e, 3)
        Distance of the centres from the edge [m].
    factors : ndarray (e, 2, 3)
        Of the powers 2/3 and 4/3, from the values there.
    """

    panel: IntArray
    axis: IntArray
    sign: Array
    place: Array
    inward: Array
    near: Array
    far: Array
    centres: IntArray
    reach: Array
    factors: Array

    def velocities(self, potential: ComplexArray, carried: ComplexArray) -> tuple[ComplexArray, Array]:
        """Return the mean velocity along the axis and the mean of its square (e, h) over each panel.

        Parameters
        ----------
        potential : ndarray (n, h)
            On all panels.
        carried : ndarray (e, h)
            Velocity of the edge itself along ``inward``: water in the corner goes with it.
        """
        values = potential[self.centres] - self.reach[:, :, None] * carried[:, None, :]
        one, two = np.einsum("eks,esh->keh", self.factors, values)
        near, far = self.near[:, None], self.far[:, None]
        width = far - near
        mean = (one * (far**_POWER - near**_POWER) + two * (far ** (2 * _POWER) - near ** (2 * _POWER))) / width

        def grown(power: float) -> Array:
            values: Array = (far**power - near**power) / power
            return values

        square = _POWER**2 * (
            np.abs(one) ** 2 * grown(2 * _POWER - 1) + 4.0 * np.real(one * two.conj()) * grown(3 * _POWER - 1)
            + 4.0 * np.abs(two) ** 2 * grown(4 * _POWER - 1)
        )  # fmt: skip
        both = np.abs(carried) ** 2 + 2.0 * np.real(carried.conj() * mean) + square / width
        return self.sign[:, None] * (carried + mean), np.asarray(both)


def edges_of(panels: Panels) -> Edges:
    """Return the panels of the hulls at and next to sharp edges, those of the waterline left out [eq:units-edge]."""
    mesh = panels.mesh
    beyond, corners, centre = neighbours(mesh), mesh.corners, mesh.centre
    side = 0.5 * (corners + np.roll(corners, -1, axis=1))
    level = 1e-6 * max(1.0, float(np.abs(corners).max()))
    rows: list[tuple[Any, ...]] = []
    sign: float
    for axis, (front, back) in enumerate(((1, 3), (2, 0))):
        for edge, other, sign in ((back, front, 1.0), (front, back, -1.0)):
            lone = (mesh.part == HULL) & (beyond[:, edge] < 0) & (side[:, edge, 2] < -level)
            for first in np.flatnonzero(lone):
                chain, out = [int(first)], int(beyond[first, other])
                while out >= 0 and len(chain) < 3:
                    chain.append(out // 4)
                    out = int(beyond[out // 4, (out % 4 + 2) % 4])
                if len(chain) < 3:
                    continue
                arm = centre[first] - side[first, edge]
                start = float(np.linalg.norm(arm))
                steps = np.linalg.norm(np.diff(centre[chain], axis=0), axis=1)
                reach = start + np.concatenate([[0.0], np.cumsum(steps)])
                powers = np.stack([np.ones(3), reach**_POWER, reach ** (2.0 * _POWER)], axis=1)
                alike = (axis, sign, side[first, edge], arm / start, chain, reach, np.linalg.inv(powers)[1:])
                rows.append((int(first), 0.0, 2.0 * start, *alike))
                # the next one as well, unless another edge is as near
                if beyond[chain[1], edge] >= 0 and beyond[chain[1], other] >= 0:
                    rows.append((chain[1], 2.0 * start, 2.0 * (reach[1] - start), *alike))
    shapes: tuple[tuple[int, ...], ...] = ((), (), (), (), (), (3,), (3,), (3,), (3,), (2, 3))
    columns = zip(*rows) if rows else (np.zeros((0, *shape)) for shape in shapes)
    panel, near, far, way, direction, place, inward, centres, reach, factors = (np.array(column) for column in columns)
    return Edges(
        panel.astype(int), way.astype(int), direction, place, inward, near, far, centres.astype(int), reach, factors
    )


@dataclass(frozen=True, eq=False)
class NearField:
    """The hulls of a row with what pressures on them need.

    Parameters
    ----------
    at : RowAtLevel
    panels : Panels
    """

    at: RowAtLevel
    panels: Panels

    @cached_property
    def line(self) -> Waterline:
        """Where the hulls pierce the surface."""
        found: Waterline | None = self.panels.__dict__.get("_waterline")
        return found or self.panels.__dict__.setdefault("_waterline", waterline_of(self.panels))

    @cached_property
    def edges(self) -> Edges:
        """Where velocities grow without bound."""
        found: Edges | None = self.panels.__dict__.get("_edges")
        return found or self.panels.__dict__.setdefault("_edges", edges_of(self.panels))

    @cached_property
    def hull(self) -> IntArray:
        """Numbers of the hull panels."""
        return np.flatnonzero(self.panels.mesh.part == HULL)

    @cached_property
    def normal(self) -> Array:
        """Of the hull panels (p, 3)."""
        return self.panels.mesh.normal[self.hull]

    @cached_property
    def centre(self) -> Array:
        """Of all panels (n, 3) [m]."""
        return self.panels.mesh.centre

    def displacement(self, motion: ComplexArray, unit: IntArray, point: Array) -> ComplexArray:
        """Return the displacement (h, p, 3) of points (p, 3) of units (p,) with motions (h, m)."""
        own = motion.reshape(len(motion), -1, 6)[:, unit]
        arm = point - self.at.centres[unit]
        return np.asarray(own[..., :3] + np.cross(own[..., 3:], np.broadcast_to(arm, (len(motion), *arm.shape))))

    def drift(self, solution: Solution, headings: Array, motion: ComplexArray) -> Array:
        """Return the force along x, y [N/m2] and the moment about the vertical [N m/m2] of every unit (h, u, 3).

        The moment is about the centre at rest.

        Parameters
        ----------
        solution : Solution
        headings : ndarray (h,)
            [rad].
        motion : ndarray (h, m)
            Per unit amplitude.
        """
        mesh, water, omega = self.panels.mesh, self.at.water, solution.omega
        count, hull, line = self.at.row.count, self.hull, self.line
        normal, centre = self.normal, self.centre
        incident, _ = incident_on(mesh, water, omega, solution.wave_number, headings)
        potential = incident + solution.diffraction + solution.radiation @ motion.T
        slopes, frame = self.panels.variation.slopes, self.panels.variation.frame
        # velocity on the hull: along it from the parabolas, across it that of the hull
        moved = self.displacement(motion, mesh.unit[hull], centre[hull])
        across = -1j * omega * np.einsum("hpc,pc->hp", moved, normal)
        along = np.array([np.asarray(slopes[axis] @ potential) for axis in range(2)])
        edges = self.edges
        carried = -1j * omega * self.displacement(motion, mesh.unit[edges.panel], edges.place)
        mean, own_square = edges.velocities(potential, np.einsum("hec,ec->eh", carried, edges.inward))
        along[edges.axis, edges.panel] = mean
        more = np.zeros((2, *potential.shape))
        more[edges.axis, edges.panel] = own_square - np.abs(mean) ** 2
        velocity = across[..., None] * normal
        velocity = velocity + sum(item[hull].T[..., None] * frame[hull, axis] for axis, item in enumerate(along))
        square = 0.5 * (np.sum(np.abs(velocity) ** 2, axis=2) + more.sum(axis=0)[hull].T)
        shifted = np.real(np.sum(moved.conj() * (-1j * omega * velocity), axis=2))
        weight = 0.5 * water.density * (square + shifted) * self.panels.variation.areas[hull]
        out = np.zeros((len(headings), count, 3))
        self._add(out, weight, normal[:, :2], mesh.unit[hull], centre[hull])
        # water that stands higher at the waterline than still water, or lower
        place = np.einsum("wac,wc->wa", frame[line.panel], line.middle - centre[line.panel])
        surface = potential[line.panel].astype(complex)
        for power in (1, 2):
            for axis in range(2):
                slope = np.asarray(slopes[axis + 2 * (power - 1)] @ potential)[line.panel]
                surface = surface + slope * (place[:, axis] ** power)[:, None]
        lifted = self.displacement(motion, mesh.unit[line.panel], line.middle)[..., 2]
        relative = (1j * omega / water.gravity * surface).T - lifted
        weight = -0.25 * water.density * water.gravity * np.abs(relative) ** 2 * line.length
        self._add(out, weight, line.normal, mesh.unit[line.panel], line.middle)
        return out + self._turned(solution, motion)

    def _add(self, out: Array, weight: Array, normal: Array, unit: IntArray, point: Array) -> None:
        """Add level forces (h, p) along normals (p, 2) to their units, with their moment."""
        arm = point[:, :2] - self.at.centres[unit, :2]
        turn = arm[:, 0] * normal[:, 1] - arm[:, 1] * normal[:, 0]
        for part, factor in enumerate((normal[:, 0], normal[:, 1], turn)):
            for number in range(self.at.row.count):
                mine = unit == number
                out[:, number, part] += weight[:, mine] @ factor[mine]

    def _turned(self, solution: Solution, motion: ComplexArray) -> Array:
        """Return what the first-order load of the water adds as it turns and moves with the hull."""
        omega = solution.omega
        water = solution.excitation + motion @ (omega**2 * solution.added_mass + 1j * omega * solution.damping).T
        load = (water - motion @ self.at.hydrostatic.T).reshape(len(motion), -1, 6)
        moved, turn = (motion.reshape(len(motion), -1, 6)[..., part].conj() for part in (slice(3), slice(3, 6)))
        force = np.cross(turn, load[..., :3])
        # about the axis at rest
        moment = np.cross(turn, load[..., 3:]) + np.cross(moved, load[..., :3])
        return 0.5 * np.real(np.stack([force[..., 0], force[..., 1], moment[..., 2]], axis=-1))
