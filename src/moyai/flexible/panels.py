"""Net panels: pieces of net between the knots of a network, on which the water acts by a law of net forces.

Theory: docs/theory/cage_flexible.md. The mass, buoyancy, added mass and wave inertia of the twines belong to the bars
of grouped twines (:mod:`moyai.flexible.mesh_groups`); panels add drag and lift.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.core.errors import InputError
from moyai.flexible.numbers import frozen, require

#: Points of a table: cosines from 0 to 1, and speeds (10 a decade) from 1 mm/s to 10 m/s.
COSINES, SPEEDS = 129, 41


class Coefficients(Protocol):
    """Drag and lift coefficients on the outline area over angle [rad] and speed [m/s], as arrays."""

    def __call__(self, angle: Array, speed: Array) -> tuple[Array, Array]:
        """Return (drag, lift)."""


@dataclass(frozen=True, eq=False)
class PanelLaw:
    """A law of net forces as a table.

    Raises
    ------
    InputError
        For tables that are not finite or of unequal shapes.
    """

    #: For results.
    name: str
    #: Coefficient a along the flow of ``F = (a w + b n (n.w)) |w| rho A / 2`` [eq:cage-panel-force]; one row when the
    #: law has no Reynolds number; shape (speeds, cosines).
    along: Array
    #: Coefficient b along the normal of the same force; shape (speeds, cosines).
    normal: Array
    #: log10 of the first speed.
    first_decade: float = -3.0
    #: Speeds per decade.
    per_decade: float = 10.0

    def __post_init__(self) -> None:
        for key in ("along", "normal"):
            table = np.array(getattr(self, key), dtype=np.float64, ndmin=2)
            if not np.isfinite(table).all():
                raise InputError(f"the law {self.name!r} has a coefficient that is not finite", parameter=f"law.{key}")
            table.setflags(write=False)
            object.__setattr__(self, key, table)
        if self.along.shape != self.normal.shape or self.along.shape[1] < 2:
            raise InputError(
                f"tables of {self.along.shape} and {self.normal.shape}",
                parameter="law",
                allowed="equal, two columns or more",
            )
        if not (math.isfinite(self.first_decade) and math.isfinite(self.per_decade) and self.per_decade > 0.0):
            raise InputError(
                f"speeds of the law {self.name!r} start at decade {self.first_decade:g}, {self.per_decade:g} a decade",
                parameter="law.per_decade",
                allowed="a finite decade, more than 0 speeds in each",
            )
        drag = self.along + self.normal * np.linspace(0.0, 1.0, self.along.shape[1]) ** 2
        if np.any(drag < -1e-6 * np.max(np.abs(drag))):
            raise InputError(
                f"the law {self.name!r} has a drag below zero",
                parameter="law.along",
                allowed="drag of 0 or more at every angle and speed",
            )

    @classmethod
    def tabulate(cls, name: str, coefficients: Coefficients) -> PanelLaw:
        """Return the table of a function of drag and lift coefficients.

        Parameters
        ----------
        name : str
            For results.
        coefficients : callable
            ``(angle, speed) -> (drag, lift)`` on the outline area; angle between flow and normal, 0 to pi/2 [rad].
            The lift has to vanish at both ends of that range.
        """
        cosine = np.linspace(0.0, 1.0, COSINES)
        # b = lift / (sin cos) is 0/0 at the ends: take it just inside
        inside = np.clip(cosine, 1e-4, 1.0 - 1e-7)
        angle = np.arccos(inside)
        speed = np.logspace(-3.0, 1.0, SPEEDS)
        drag, lift = coefficients(angle[None, :], np.broadcast_to(speed[:, None], (SPEEDS, COSINES)))
        drag = np.broadcast_to(np.asarray(drag, dtype=np.float64), (SPEEDS, COSINES))
        lift = np.broadcast_to(np.asarray(lift, dtype=np.float64), (SPEEDS, COSINES))
        if np.any(np.abs(lift[:, [0, -1]]) > 0.02 * np.max(np.abs(lift), axis=1, keepdims=True)):
            raise InputError(
                f"the lift of the law {name!r} does not vanish along or across the flow",
                parameter="law.lift",
                allowed="0 at the angles 0 and pi/2",
            )
        normal = lift / (np.sin(angle) * inside)
        along = drag - normal * inside**2
        if np.allclose(along, along[:1], rtol=1e-12, atol=1e-14) and np.allclose(normal, normal[:1], 1e-12, 1e-14):
            along, normal = along[:1], normal[:1]
        return cls(name, along, normal)

    @classmethod
    def constant(cls, name: str, drag: float, lift: float = 0.0) -> PanelLaw:
        """Return the law of a drag coefficient at every angle and a lift coefficient times sin 2 theta."""
        return cls(name, np.full((1, 2), drag) - 2.0 * lift * np.array([[0.0, 1.0]]), np.full((1, 2), 2.0 * lift))


@dataclass(frozen=True, eq=False)
class NetPanels:
    """Net panels of a network.

    Raises
    ------
    InputError
        For negative areas, unknown laws or groups, corners that meet.
    """

    #: Nodes around each panel; the fourth is -1 for triangles; shape (p, 4).
    corners: IntArray
    #: The laws in use.
    laws: tuple[PanelLaw, ...]
    #: Which one each panel follows; shape (p,).
    law: IntArray = field(default_factory=lambda: np.zeros((), dtype=np.int64))
    #: Outline area that the coefficients refer to [m2]: that of the net at rest, since a net that shears keeps its
    #: twines; 0 takes the present outline; shape (p,).
    area: Array = field(default_factory=lambda: np.zeros(()))
    #: Factor on the velocity of the water; shape (p,).
    flow_factor: Array = field(default_factory=lambda: np.ones(()))
    #: Velocity taken from that of the water: what the current has lost upstream [m/s]; shape (p, 3).
    shadow: Array = field(default_factory=lambda: np.zeros(()))
    #: Number of the group that results are reported for; shape (p,).
    group: IntArray = field(default_factory=lambda: np.zeros((), dtype=np.int64))
    #: Their names.
    group_names: tuple[str, ...] = ("net",)

    def __post_init__(self) -> None:
        size = len(self.corners)
        require(size > 0, "net panels without corners", "panels.corners", "one panel or more")
        object.__setattr__(self, "corners", frozen(self.corners, np.int64, (size, 4), "panels.corners"))
        for name in ("law", "group"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.int64, (size,), f"panels.{name}"))
        for name in ("area", "flow_factor"):
            array = frozen(getattr(self, name), np.float64, (size,), f"panels.{name}")
            object.__setattr__(self, name, array)
            require(bool(np.all(array >= 0.0)), f"a panel has a negative {name}", f"panels.{name}", "0 or more")
        object.__setattr__(self, "shadow", frozen(self.shadow, np.float64, (size, 3), "panels.shadow"))
        for name, count in (("law", len(self.laws)), ("group", len(self.group_names))):
            array = getattr(self, name)
            require(
                bool(np.all((array >= 0) & (array < count))),
                f"a panel names an unknown {name}",
                f"panels.{name}",
                f"0 to {count - 1}",
            )
        allowed = "three or four different nodes; -1 for the fourth corner of a triangle"
        ordered = np.sort(self.corners, axis=1)
        require(
            not np.any(ordered[:, 1:] == ordered[:, :-1]),
            "two corners of a panel are the same node",
            "panels.corners",
            allowed,
        )
        require(
            bool(np.all(self.corners[:, :3] >= 0) and np.all(self.corners[:, 3] >= -1)),
            "a corner of a panel is negative",
            "panels.corners",
            allowed,
        )

    def __len__(self) -> int:
        return int(self.corners.shape[0])


@dataclass(frozen=True, eq=False)
class PanelArrays:
    """Panels for the kernels."""

    #: Nodes; shape (p, 4).
    corners: IntArray
    #: Area (0: the present one) [m2], flow factor, shadow (3) [m/s], law; shape (p, 6).
    rows: Array
    #: Coefficients a and b; shape (laws, speeds, cosines, 2).
    table: Array
    #: log10 of the first speed, speeds per decade; shape (laws, 2).
    grid: Array

    @property
    def system(self) -> tuple[IntArray, Array, Array, Array]:
        """What the kernels take."""
        return self.corners, self.rows, self.table, self.grid

    @classmethod
    def of(cls, panels: NetPanels | None) -> PanelArrays:
        """Flatten panels; none gives arrays of length zero."""
        if panels is None or len(panels) == 0:
            return cls(np.zeros((0, 4), np.int64), np.zeros((0, 6)), np.zeros((1, 1, 2, 2)), np.zeros((1, 2)))
        lines = max(law.along.shape[0] for law in panels.laws)
        columns = max(law.along.shape[1] for law in panels.laws)
        table = np.empty((len(panels.laws), lines, columns, 2))
        grid = np.empty((len(panels.laws), 2))
        cosine = np.linspace(0.0, 1.0, columns)
        for k, law in enumerate(panels.laws):
            old = np.linspace(0.0, 1.0, law.along.shape[1])
            for slot, values in enumerate((law.along, law.normal)):
                fine = np.stack([np.interp(cosine, old, line) for line in values])
                table[k, :, :, slot] = fine if len(fine) == lines else fine[:1]
                if 1 < len(fine) < lines:
                    table[k, : len(fine), :, slot], table[k, len(fine) :, :, slot] = fine, fine[-1]
            grid[k] = law.first_decade, law.per_decade
        rows = np.concatenate(
            [panels.area[:, None], panels.flow_factor[:, None], panels.shadow, panels.law[:, None].astype(np.float64)],
            axis=1,
        )
        # a copy: kernels compile anew for arrays that cannot be written
        return cls(panels.corners.copy(), np.ascontiguousarray(rows), table, grid)


def panel_areas(corners: IntArray, position: Array) -> tuple[Array, Array]:
    """Return outline area [m2] and unit normal (p, 3) of panels at given places of the nodes (n, 3)."""
    quad = corners[:, 3] >= 0
    points = position[np.where(corners >= 0, corners, 0)]
    one = np.where(quad[:, None], points[:, 2] - points[:, 0], points[:, 1] - points[:, 0])
    two = np.where(quad[:, None], points[:, 3] - points[:, 1], points[:, 2] - points[:, 0])
    normal = 0.5 * np.cross(one, two)
    area = np.linalg.norm(normal, axis=1)
    return area, normal / np.where(area > 0.0, area, 1.0)[:, None]


def forces_on_panels(
    panels: NetPanels, position: Array, velocity: Array, water: Array, density: float
) -> tuple[Array, Array]:
    """Return the force of the water on every node (n, 3) and on every panel (p, 3) [N].

    Parameters
    ----------
    panels : NetPanels
    position, velocity : ndarray, shape (n, 3)
        Of the nodes.
    water : ndarray, shape (7, n)
        Velocity, acceleration and elevation of the water at the nodes.
    density : float
        [kg/m3].
    """
    from moyai.flexible.panel_kernel import panel_forces

    if not (math.isfinite(density) and density > 0.0):
        raise InputError(f"density is {density:g} kg/m3", parameter="density", allowed="greater than 0")
    force, each = np.zeros_like(position), np.zeros((len(panels), 3))
    panel_forces(
        np.ascontiguousarray(position), np.ascontiguousarray(velocity), np.ascontiguousarray(water),
        PanelArrays.of(panels).system, 0.5 * density, force, each,
    )  # fmt: skip
    return force, each
