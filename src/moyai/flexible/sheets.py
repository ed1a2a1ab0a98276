"""Sheets in a network: triangles that wrinkle instead of bearing compression, with their mass and the water on them."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array, IntArray
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.flexible import sheet_kernel as kernel
from moyai.flexible.numbers import numbers_of, whole_numbers
from moyai.sea.water import Water

_POSITIVE_OR_ZERO = (
    "warp_stiffness", "weft_stiffness", "shear_stiffness", "mass_per_area", "volume_per_area", "drag_normal",
    "drag_tangential", "damping_time", "flow_factor", "added_mass_per_area",
)  # fmt: skip


@checks_words
@dataclass(frozen=True, eq=False)
class Sheets:
    """Triangles of an orthotropic membrane between nodes of a network.

    All values but the first two are given once or for every triangle. The strain is Green's, so that a strip
    of stiffness K pulls with K (e + 3 e^2 / 2 + ...) at the strain e [eq:flexible-sheet].

    Raises
    ------
    InputError
        For numbers out of range, corners in one line, and stiffnesses that give energy back.
    """

    #: Nodes; the normal follows the right hand around them; shape (t, 3).
    triangles: IntArray
    #: Unstretched places of the corners along warp and weft [m]; each triangle may count from its own origin; shape (t,
    #: 3, 2).
    rest: Array
    #: Young's modulus times thickness along the warp [N/m]; 0 for a sheet without threads that way.
    warp_stiffness: Array | float
    #: Young's modulus times thickness along the weft [N/m]; 0 for a sheet without threads that way.
    weft_stiffness: Array | float
    #: Shear modulus times thickness [N/m]; 0 lets the two families of threads work apart.
    shear_stiffness: Array | float = 0.0
    #: Contraction of the weft by a pull along the warp (Poisson's ratio) [-].
    contraction: Array | float = 0.0
    #: [kg/m2].
    mass_per_area: Array | float = 0.0
    #: Displaced volume per area, the thickness [m].
    volume_per_area: Array | float = 0.0
    #: Coefficient C of the force per area rho/2 C u|u| of the relative velocity across [-].
    drag_normal: Array | float = 0.0
    #: Coefficient C of the same force of the relative velocity along the sheet [-].
    drag_tangential: Array | float = 0.0
    #: Time by which the rate of strain is multiplied and added to the strain (internal damping) [s].
    damping_time: Array | float = 0.0
    #: Pressure difference that pushes along the normal, whatever the shape [Pa].
    pressure: Array | float = 0.0
    #: Factor on the water's velocity.
    flow_factor: Array | float = 1.0
    #: Whether the sheet wrinkles instead of bearing compression.
    tension_field: bool = True
    #: Water that the sheet takes along across its directions as built, where it is wet [kg/m2]: for a strip of depth d
    #: that swings as a whole, both sides wet, pi/4 rho d on average. For sections that turn, and whose nodes feel each
    #: other, see :class:`moyai.flexible.mass_blocks.MassBlocks`.
    added_mass_per_area: Array | float = 0.0

    def __post_init__(self) -> None:
        nodes = np.array(whole_numbers(self.triangles, "sheets.triangles"))
        if nodes.ndim != 2 or nodes.shape[1] != 3 or not len(nodes):
            raise InputError(
                f"triangles of shape {nodes.shape}", parameter="sheets.triangles", allowed="(1 or more, 3)"
            )
        if np.any(nodes < 0) or np.any(nodes == np.roll(nodes, 1, axis=1)):
            wrong = np.any((nodes < 0) | (nodes == np.roll(nodes, 1, axis=1)), axis=1)
            raise InputError(
                f"triangle {int(np.argmax(wrong))} names a node twice, or a negative one",
                parameter="sheets.triangles",
                allowed="three different nodes",
            )
        self._keep("triangles", nodes)
        rest = numbers_of(self.rest, "sheets.rest")
        if rest.shape != (len(nodes), 3, 2) or not np.isfinite(rest).all():
            raise InputError(
                f"unstretched corners of shape {rest.shape}",
                parameter="sheets.rest",
                allowed=f"({len(nodes)}, 3, 2), finite",
            )
        self._keep("rest", rest)
        for entry in fields(self):
            if entry.name in ("triangles", "rest", "tension_field"):
                continue
            given = numbers_of(getattr(self, entry.name), f"sheets.{entry.name}")
            if given.shape not in ((), (len(nodes),)):
                raise InputError(
                    f"{entry.name} has shape {given.shape}",
                    parameter=f"sheets.{entry.name}",
                    allowed=f"() or ({len(nodes)},)",
                )
            value = np.array(np.broadcast_to(given, (len(nodes),)))
            low = 0.0 if entry.name in _POSITIVE_OR_ZERO else -np.inf
            if not np.isfinite(value).all() or np.any(value < low):
                raise InputError(
                    f"{entry.name} of a sheet is {value[np.argmin(value)]:g}",
                    parameter=f"sheets.{entry.name}",
                    allowed="0 or more" if low == 0.0 else "finite",
                )
            self._keep(entry.name, value)
        if not isinstance(self.tension_field, bool | np.bool_):
            raise InputError(
                f"tension_field is {self.tension_field!r}", parameter="sheets.tension_field", allowed="True or False"
            )
        self._check_areas()
        self._check_law()

    def _keep(self, name: str, array: NDArray[Any]) -> None:
        kept = np.ascontiguousarray(array)
        kept.setflags(write=False)
        object.__setattr__(self, name, kept)

    def _check_areas(self) -> None:
        longest = np.max(np.linalg.norm(self.rest - np.roll(self.rest, 1, axis=1), axis=2), axis=1)
        flat = self.area <= 1e-9 * longest**2
        if flat.any():
            raise InputError(
                f"triangle {int(np.argmax(flat))} has no area, or its unstretched corners run clockwise",
                parameter="sheets.rest",
                allowed="corners counter-clockwise over (warp, weft)",
            )

    def _check_law(self) -> None:
        warp, weft, shear, ratio = (
            np.asarray(getattr(self, name))
            for name in ("warp_stiffness", "weft_stiffness", "shear_stiffness", "contraction")
        )
        bare = warp + weft == 0.0
        if np.any(bare):
            raise InputError(
                f"a sheet without stiffness: triangle {int(np.argmax(bare))}",
                parameter="sheets.warp_stiffness",
                allowed="greater than 0 along warp or weft",
            )
        threads = (warp == 0.0) | (weft == 0.0) | (shear == 0.0)
        if np.any(threads & (ratio != 0.0)):
            raise InputError(
                "a contraction of a sheet that lacks warp, weft or shear stiffness",
                parameter="sheets.contraction",
                allowed="0",
                remedy="give the three stiffnesses, or no contraction",
            )
        if np.any(threads & (shear > 0.0)):
            raise InputError(
                "a shear stiffness of a sheet that lacks warp or weft stiffness",
                parameter="sheets.shear_stiffness",
                allowed="0",
                remedy="give both stiffnesses: threads of one family alone cannot shear without wrinkling",
            )
        whole = ~threads
        if np.any(ratio[whole] ** 2 * weft[whole] >= warp[whole]):
            raise InputError(
                f"contraction {float(np.max(np.abs(ratio))):g} gives a sheet that yields energy when it is pulled",
                parameter="sheets.contraction",
                allowed="less than the root of warp over weft stiffness",
            )

    def __len__(self) -> int:
        return int(self.triangles.shape[0])

    @property
    def area(self) -> Array:
        """Unstretched areas [m2], negative for corners that run clockwise."""
        one, two = self.rest[:, 1] - self.rest[:, 0], self.rest[:, 2] - self.rest[:, 0]
        return np.asarray(0.5 * (one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]))

    @cached_property
    def bulk(self) -> tuple[Array, Array]:
        """Mass [kg] and displaced volume [m3] of every triangle."""
        return np.asarray(self.area * self.mass_per_area), np.asarray(self.area * self.volume_per_area)

    def node_share(self, values: Array, count: int) -> Array:
        """Return a third of a value per triangle summed at each of ``count`` nodes."""
        share = np.zeros(count)
        for corner in range(3):
            np.add.at(share, self.triangles[:, corner], values / 3.0)
        return share

    def constants(self, water: Water, place: Array | None = None) -> Array:
        """Return the columns that the kernels read, shape (t, 24).

        Parameters
        ----------
        water : Water
        place : ndarray, shape (n, 3), optional
            Nodes as built, across whose triangles the added mass acts; there is none without them.
        """
        table = np.zeros((len(self), kernel.COLUMNS))
        one, two = self.rest[:, 1] - self.rest[:, 0], self.rest[:, 2] - self.rest[:, 0]
        double = 2.0 * self.area
        table[:, kernel.E11], table[:, kernel.E12] = two[:, 1] / double, -two[:, 0] / double
        table[:, kernel.E21], table[:, kernel.E22] = -one[:, 1] / double, one[:, 0] / double
        table[:, kernel.AREA] = self.area
        warp, weft, shear, ratio = (
            np.asarray(getattr(self, name))
            for name in ("warp_stiffness", "weft_stiffness", "shear_stiffness", "contraction")
        )
        threads = (warp == 0.0) | (weft == 0.0) | (shear == 0.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            rest = np.where(threads, 1.0, 1.0 - ratio**2 * weft / warp)
            both = np.where(threads, 0.0, -ratio / warp)
            mixed = np.where(threads, 1.0, np.sqrt(warp * weft) * (both + 0.5 / shear))
        table[:, kernel.C11], table[:, kernel.C22] = warp / rest, weft / rest
        table[:, kernel.C12], table[:, kernel.C33] = np.where(threads, 0.0, ratio * weft / rest), shear
        # of a pull between warp and weft over that along them, in stretched axes [eq:flexible-wrinkle-direction]
        table[:, kernel.WARP], table[:, kernel.WEFT] = np.sqrt(warp), np.sqrt(weft)
        table[:, kernel.BEND] = 0.5 * (mixed - 1.0)
        law = np.where(threads, kernel.THREADS, kernel.FIELD) if self.tension_field else kernel.LINEAR
        table[:, kernel.LAW] = law
        volume = self.bulk[1]
        table[:, kernel.ADDED], table[:, kernel.DISPLACED] = self.added_mass_per_area, volume * water.density / 3.0
        table[:, kernel.LIFT] = volume * water.density * water.gravity / 3.0
        table[:, kernel.ACROSS] = 0.5 * water.density * np.asarray(self.drag_normal)
        table[:, kernel.SKIN] = 0.5 * water.density * np.asarray(self.drag_tangential)
        table[:, kernel.DAMPING], table[:, kernel.PRESSURE] = self.damping_time, self.pressure
        table[:, kernel.SHARE] = self.flow_factor
        if place is not None:
            one, two = (place[self.triangles[:, k]] - place[self.triangles[:, 0]] for k in (1, 2))
            across = np.cross(one, two)
            size = np.linalg.norm(across, axis=1)
            table[:, kernel.FACE : kernel.FACE + 3] = across / np.where(size > 0.0, size, 1.0)[:, None]
        return table


@dataclass(frozen=True, eq=False)
class SheetStress:
    """Stresses of the triangles at one shape [N/m]."""

    #: Component along the warp; shape (t,).
    warp: Array
    #: Component along the weft; shape (t,).
    weft: Array
    #: Shear component; shape (t,).
    shear: Array
    #: Higher principal stress; shape (t,).
    first: Array
    #: Lower principal stress; shape (t,).
    second: Array
    #: 0 slack, 1 wrinkled, 2 taut; shape (t,).
    state: IntArray


def sheet_stress(sheets: Sheets, position: ArrayLike) -> SheetStress:
    """Return the stresses of sheets whose nodes stand at ``position`` (n, 3) [m]."""
    out = np.empty((len(sheets), 6))
    place = np.ascontiguousarray(position, dtype=np.float64)
    kernel.stress_field(sheets.constants(Water(np.inf, 1.0, 1.0)), sheets.triangles, place, out)
    warp, weft, shear, first, second, state = (np.array(column) for column in out.T)
    return SheetStress(warp, weft, shear, first, second, state.astype(np.int64))


def sheet_grid(nodes: ArrayLike, warp: ArrayLike, weft: ArrayLike) -> tuple[IntArray, Array]:
    """Return triangles and unstretched corners of a rectangle of nodes.

    Every cell is cut in two, the diagonals alternate so that no direction is preferred.

    Parameters
    ----------
    nodes : array_like of int, shape (p, q)
        Node numbers, the first index along the warp, the second along the weft.
    warp, weft : array_like, shape (p,) and (q,)
        Unstretched places of the rows [m], rising.

    Returns
    -------
    triangles : ndarray of int, shape (2 (p - 1) (q - 1), 3)
    rest : ndarray, shape (2 (p - 1) (q - 1), 3, 2)

    Raises
    ------
    InputError
        For arrays that do not fit or do not rise.
    """
    grid, along, across = np.asarray(nodes), np.asarray(warp, dtype=float), np.asarray(weft, dtype=float)
    if grid.ndim != 2 or min(grid.shape) < 2 or grid.shape != (along.size, across.size):
        raise InputError(
            f"a sheet of {grid.shape} nodes over {along.size} and {across.size} rows",
            parameter="sheets",
            allowed="two rows or more each way, as many as given",
        )
    if not (np.all(np.diff(along) > 0.0) and np.all(np.diff(across) > 0.0)):
        raise InputError("unstretched places of a sheet do not rise", parameter="sheets", allowed="rising")
    cells = np.stack(np.meshgrid(np.arange(along.size - 1), np.arange(across.size - 1), indexing="ij"), -1).reshape(
        -1, 2
    )
    corners = cells[:, None, :] + np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    even = (cells.sum(axis=1) % 2 == 0)[:, None]
    first = np.where(even, [[0, 1, 2]], [[0, 1, 3]])
    second = np.where(even, [[0, 2, 3]], [[1, 2, 3]])
    chosen = np.stack([first, second], axis=1).reshape(-1, 3)
    owner = np.repeat(np.arange(len(cells)), 2)[:, None]
    place = corners[owner, chosen]
    rest = np.stack([along[place[..., 0]], across[place[..., 1]]], axis=-1)
    return grid[place[..., 0], place[..., 1]].astype(np.int64), rest


__all__ = ["SheetStress", "Sheets", "sheet_grid", "sheet_stress"]
