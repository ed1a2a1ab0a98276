"""Mean drift of every unit from the pressure on its own hull, which far waves do not separate [eq:units-near-field].

Time factor e^{-i omega t}; per square of the amplitude. The velocity along the hull is that of the parabolas through
neighbouring panels, the elevation at the waterline theirs as well. Towards a sharp edge the potential goes with the
powers of the distance that belong to a right angle, and the velocity without bound [eq:units-edge]. What is left of the
sum by the far field is shared [eq:units-shared-drift].
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from moyai.core.arrays import Array, ComplexArray, IntArray
from moyai.structures.units.assembly import RowAtLevel
from moyai.structures.units.bem import MeshPanels, Solution, incident_potential
from moyai.structures.units.mesh import HULL
from moyai.structures.units.variation import neighbours

#: Times that a wave is asked for, over the number of motions, from which all their pairs cost less
OFTEN = 1.5
#: Memory for the sums over all pairs of motions [bytes]
MOST_KEPT = 2e8
#: Power of the distance from the edge of a right angle that the potential goes with
_POWER = 2.0 / 3.0


@dataclass(frozen=True, eq=False)
class Waterline:
    """Sides of hull panels in the still water surface."""

    #: Panel of each side; shape (w,).
    panel: IntArray
    #: [m]; shape (w, 3).
    middle: Array
    #: Level unit normal into the water; shape (w, 2).
    normal: Array
    #: [m]; shape (w,).
    length: Array


def waterline_of(panels: MeshPanels) -> Waterline:
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
class SharpEdges:
    """Panels at sharp edges and those next to them, with the powers of the distance through three centres."""

    #: Shape (e,).
    panel: IntArray
    #: Direction of the panel that runs to the edge; shape (e,).
    axis: IntArray
    #: 1 where the distance from the edge grows along the axis, else -1; shape (e,).
    sign: Array
    #: Middle of the edge [m]; shape (e, 3).
    place: Array
    #: Unit vector from the edge over the hull; shape (e, 3).
    inward: Array
    #: Distance of the near side of the panel from the edge [m]; shape (e,).
    near: Array
    #: Distance of the far side of the panel from the edge [m]; shape (e,).
    far: Array
    #: Panels through whose centres the powers are drawn; shape (e, 3).
    centres: IntArray
    #: Distance of the centres from the edge [m]; shape (e, 3).
    reach: Array
    #: Of the powers 2/3 and 4/3, from the values there; shape (e, 2, 3).
    factors: Array

    def powers(self, potential: ComplexArray, carried: ComplexArray) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        """Return the factors (e, c) of both powers and the mean velocity along the axis that they make over each panel.

        Parameters
        ----------
        potential : ndarray (n, c)
            On all panels.
        carried : ndarray (e, c)
            Velocity of the edge itself along ``inward``: water in the corner goes with it.
        """
        values = potential[self.centres] - self.reach[:, :, None] * carried[:, None, :]
        one, two = np.einsum("eks,esc->kec", self.factors, values)
        near, far = self.near[:, None], self.far[:, None]
        mean = one * (far**_POWER - near**_POWER) + two * (far ** (2 * _POWER) - near ** (2 * _POWER))
        return one, two, mean / (far - near)

    @cached_property
    def squares(self) -> Array:
        """Mean of the square of the velocity of the powers over a panel: by |1|^2, by Re 1 2*, by |2|^2 (3, e)."""

        def grown(power: float) -> Array:
            values: Array = (self.far**power - self.near**power) / (power * (self.far - self.near))
            return values

        factors = zip((1.0, 4.0, 4.0), (2 * _POWER - 1, 3 * _POWER - 1, 4 * _POWER - 1))
        return _POWER**2 * np.array([factor * grown(power) for factor, power in factors])


def edges_of(panels: MeshPanels) -> SharpEdges:
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
    # a panel as near to two edges along one axis counts once
    rows = list({(row[0], row[3]): row for row in rows}.values())
    shapes: tuple[tuple[int, ...], ...] = ((), (), (), (), (), (3,), (3,), (3,), (3,), (2, 3))
    columns = zip(*rows) if rows else (np.zeros((0, *shape)) for shape in shapes)
    panel, near, far, way, direction, place, inward, centres, reach, factors = (np.array(column) for column in columns)
    return SharpEdges(
        panel.astype(int), way.astype(int), direction, place, inward, near, far, centres.astype(int), reach, factors
    )


@dataclass(frozen=True, eq=False)
class NearField:
    """The hulls of a row with what pressures on them need.

    The drift is a sum over products of linear quantities: velocity by velocity and displacement by velocity on every
    hull panel, powers by powers at the edges, elevation by elevation along the waterline. It is summed for the motions
    asked for; of a wave that was asked for often, every pair of motions is summed once and the drift follows from them.
    """

    at: RowAtLevel
    panels: MeshPanels
    #: Frequency and heading to how often the drift was asked for, and to the sums over all pairs.
    _asked: Counter[tuple[float, float]] = field(default_factory=Counter, repr=False)
    _pairs: dict[tuple[float, float], ComplexArray] = field(default_factory=dict, repr=False)

    @classmethod
    def of(cls, at: RowAtLevel, panels: MeshPanels) -> NearField:
        """Return the one that belongs to the panels; rows that differ in their damping alone share it."""
        found: NearField | None = panels.__dict__.get("_near_field")
        if found is None or not found._serves(at):
            found = panels.__dict__["_near_field"] = cls(at, panels)
        return found

    def _serves(self, at: RowAtLevel) -> bool:
        own = self.at
        pairs = ((own.centres, at.centres), (own.hydrostatic, at.hydrostatic), (own.free, at.free))
        return own is at or (own.water == at.water and all(np.array_equal(*pair) for pair in pairs))

    @cached_property
    def line(self) -> Waterline:
        """Where the hulls pierce the surface."""
        return waterline_of(self.panels)

    @cached_property
    def edges(self) -> SharpEdges:
        """Where velocities grow without bound."""
        return edges_of(self.panels)

    @cached_property
    def hull(self) -> IntArray:
        """Numbers of the hull panels."""
        return np.flatnonzero(self.panels.mesh.part == HULL)

    @cached_property
    def _weights(self) -> tuple[Array, IntArray]:
        """Factors of the products (3, q), for force along x, y and the moment, and the unit of each (q,)."""
        mesh, water, hull, line, edges = self.panels.mesh, self.at.water, self.hull, self.line, self.edges
        half = 0.5 * water.density * self.panels.variation.areas
        at_hull = self._factors(mesh.normal[hull, :2], mesh.unit[hull], mesh.centre[hull]) * half[hull]
        at_edges = self._factors(mesh.normal[edges.panel, :2], mesh.unit[edges.panel], mesh.centre[edges.panel])
        at_edges = at_edges * half[edges.panel]
        at_line = self._factors(line.normal, mesh.unit[line.panel], line.middle)
        at_line = -0.25 * water.density * water.gravity * at_line * line.length
        weights = [np.tile(0.5 * at_hull, 3), np.tile(at_hull, 3)]
        weights += [0.5 * at_edges * factor for factor in (*edges.squares, -1.0)]
        owners = [np.tile(mesh.unit[hull], 6), np.tile(mesh.unit[edges.panel], 4), mesh.unit[line.panel]]
        return np.concatenate([*weights, at_line], axis=1), np.concatenate(owners)

    def _factors(self, normal: Array, unit: IntArray, point: Array) -> Array:
        """Return level unit normals (p, 2) and their moment about the centre of their unit, (3, p)."""
        arm = point[:, :2] - self.at.centres[unit, :2]
        return np.stack([normal[:, 0], normal[:, 1], arm[:, 0] * normal[:, 1] - arm[:, 1] * normal[:, 0]])

    @cached_property
    def _summed(self) -> Array:
        """Factors of the products by unit (3 u, q)."""
        weights, owner = self._weights
        mine = owner[None, :] == np.arange(self.at.row.count)[:, None]
        return np.asarray((mine[:, None, :] * weights).reshape(-1, owner.size))

    def displacement(self, motion: ComplexArray, unit: IntArray, point: Array) -> ComplexArray:
        """Return the displacement (3, c, p) of points (p, 3) of units (p,) with motions (c, m)."""
        own = np.moveaxis(motion.reshape(len(motion), -1, 6), 2, 0)[:, :, unit]
        x, y, z = (point - self.at.centres[unit]).T
        return np.stack(
            [own[0] + own[4] * z - own[5] * y, own[1] + own[5] * x - own[3] * z, own[2] + own[3] * y - own[4] * x]
        )

    def _products(self, omega: float, potential: ComplexArray, motion: ComplexArray) -> tuple[ComplexArray, ...]:
        """Return both sides (c, q) of the products, of potentials (n, c) and motions (c, m)."""
        mesh, water, hull, line, edges = self.panels.mesh, self.at.water, self.hull, self.line, self.edges
        slopes, frame = self.panels.variation.slopes, self.panels.variation.frame
        rate = -1j * omega
        # velocity on the hull: along it from the parabolas, across it that of the hull
        shifted = self.displacement(motion, mesh.unit[hull], mesh.centre[hull])
        across = rate * np.einsum("kcp,pk->cp", shifted, mesh.normal[hull])
        along = np.array([np.asarray(slopes[axis] @ potential) for axis in range(2)])
        carried = rate * np.einsum(
            "kce,ek->ec", self.displacement(motion, mesh.unit[edges.panel], edges.place), edges.inward
        )
        one, two, mean = edges.powers(potential, carried)
        along[edges.axis, edges.panel] = edges.sign[:, None] * (carried + mean)
        velocity = across * mesh.normal[hull].T[:, None]
        for axis in range(2):
            velocity = velocity + along[axis][hull].T * frame[hull, axis].T[:, None]
        # water that stands higher at the waterline than still water, or lower
        place = np.einsum("wac,wc->wa", frame[line.panel], line.middle - mesh.centre[line.panel])
        surface = potential[line.panel].astype(complex)
        for power in (1, 2):
            for axis in range(2):
                slope = np.asarray(slopes[axis + 2 * (power - 1)] @ potential)[line.panel]
                surface = surface + slope * (place[:, axis] ** power)[:, None]
        lifted = self.displacement(motion, mesh.unit[line.panel], line.middle)[2]
        relative = (-rate / water.gravity * surface).T - lifted
        left = [*velocity, *shifted, one.T, one.T, two.T, mean.T, relative]
        right = [*velocity, *(rate * velocity), one.T, two.T, two.T, mean.T, relative]
        return np.concatenate(left, axis=1), np.concatenate(right, axis=1)

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
        free = self.at.free
        keys = [(solution.omega, float(heading)) for heading in headings]
        self._asked.update(keys)
        often = all(self._asked[key] > OFTEN * free.shape[1] for key in keys)
        if often and self._pairs_fit(len(headings)):
            for column, key in enumerate(keys):
                if key not in self._pairs:
                    self._pairs[key] = self._all_pairs(solution.among(np.array([column])), headings[[column]])
            # what is not left free does not move: the basis is orthonormal
            known = np.concatenate([np.ones((len(motion), 1)), motion @ free], axis=1)
            return np.array([
                np.real(np.einsum("a,uvab,b->uv", one.conj(), self._pairs[key], one, optimize=True))
                for one, key in zip(known, keys, strict=True)
            ])  # fmt: skip
        waves = incident_potential(
            self.panels.mesh.centre, self.at.water, solution.omega, solution.wave_number, headings
        )
        potential = waves + solution.diffraction + solution.radiation @ motion.T
        left, right = self._products(solution.omega, potential, motion)
        out = np.real(left.conj() * right) @ self._summed.T
        turned = self._turned(motion, self._load(solution, motion, 1.0))
        return np.asarray(out.reshape(len(headings), -1, 3) + np.real(turned))

    def _pairs_fit(self, more: int) -> bool:
        """Whether sums over all pairs of motions, those of some more waves included, stay in the memory for them."""
        each = 48 * self.at.row.count * (self.at.free.shape[1] + 1) ** 2
        return bool(each * (len(self._pairs) + more) < MOST_KEPT)

    def _all_pairs(self, solution: Solution, heading: Array) -> ComplexArray:
        """Return the drift (u, 3, r + 1, r + 1) of every pair among the wave on the row held and its free motions."""
        mesh, free = self.panels.mesh, self.at.free
        waves = incident_potential(mesh.centre, self.at.water, solution.omega, solution.wave_number, heading)
        potential = np.concatenate([waves + solution.diffraction, solution.radiation @ free], axis=1)
        motion = np.concatenate([np.zeros((1, self.at.size)), free.T]).astype(complex)
        left, right = self._products(solution.omega, potential, motion)
        weights, owner = self._weights
        out = []
        for unit in range(self.at.row.count):
            mine = owner == unit
            before, after = left[:, mine].conj(), right[:, mine].T
            out.append([(before * factor[mine]) @ after for factor in weights])
        wave = np.zeros(len(motion))
        wave[0] = 1.0
        load = self._load(solution, motion, wave[:, None])
        return np.asarray(np.array(out) + self._turned(motion[:, None], load[None, :]).transpose(2, 3, 0, 1))

    def _load(self, solution: Solution, motion: ComplexArray, wave: Array | float) -> ComplexArray:
        """Return the first-order load of the water (c, m), moved with the hull."""
        omega = solution.omega
        water = wave * solution.excitation + motion @ (omega**2 * solution.added_mass + 1j * omega * solution.damping).T
        return np.asarray(water - motion @ self.at.hydrostatic.T)

    def _turned(self, motion: ComplexArray, load: ComplexArray) -> Any:
        """Return what first-order loads (..., m) add as they turn and move with the hull, (..., u, 3)."""
        motion, load = (item.reshape(*item.shape[:-1], -1, 6) for item in (motion.conj(), load))
        shift, turn, force, moment = motion[..., :3], motion[..., 3:], load[..., :3], load[..., 3:]
        # about the axis at rest
        found = (
            turn[..., 1] * force[..., 2] - turn[..., 2] * force[..., 1],
            turn[..., 2] * force[..., 0] - turn[..., 0] * force[..., 2],
            turn[..., 0] * moment[..., 1] - turn[..., 1] * moment[..., 0]
            + shift[..., 0] * force[..., 1] - shift[..., 1] * force[..., 0],
        )  # fmt: skip
        return 0.5 * np.stack(found, axis=-1)
