"""What the water meets of a body: lumps of volume with their own buoyancy, drag, added mass and waterline."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError


@dataclass(frozen=True, eq=False)
class Lumps:
    """Parts of a body that the water sees one by one, in body axes [eq:coupled-lumps].

    Raises
    ------
    InputError
        For shapes that disagree and values that are negative or not finite.
    """

    #: Centres from the origin of the body [m]; shape (l, 3).
    place: Array
    #: Displaced volume when wholly wet [m3]; shape (l,).
    volume: Array
    #: Extent along the body's z axis [m]; the part under the surface counts. 0: always wet, wherever it is. Shape (l,).
    length: Array
    #: Drag coefficient times area for flow along each body axis [m2]; the force along an axis is rho/2 CdA u U, with
    #: the speed U that ``axis`` chooses; shape (l, 3).
    drag_area: Array
    #: When wholly wet, along each body axis [kg]; shape (l, 3).
    added_mass: Array
    #: -1: U is the whole relative speed (a compact part). 0, 1 or 2: the part is slender along that body axis, and U is
    #: the speed across it for the two forces across, the speed along it for the force along (cross-flow principle).
    #: Shape (l,).
    axis: NDArray[np.int64] | int = -1

    def __post_init__(self) -> None:
        size = len(np.atleast_2d(np.asarray(self.place, dtype=np.float64)))
        shapes = {"place": (size, 3), "volume": (size,), "length": (size,), "drag_area": (size, 3)}
        for name, shape in {**shapes, "added_mass": (size, 3)}.items():
            given = np.array(getattr(self, name), dtype=np.float64)
            values = np.array(np.broadcast_to(given, shape)) if given.ndim < len(shape) else given
            if values.shape != shape or not np.isfinite(values).all():
                raise InputError(
                    f"{name} of lumps has shape {given.shape} or is not finite",
                    parameter=f"lumps.{name}",
                    allowed=f"{shape}",
                )
            if name != "place" and np.any(values < 0.0):
                raise InputError(f"{name} of lumps is {values.min():g}", parameter=f"lumps.{name}", allowed="0 or more")
            values.setflags(write=False)
            object.__setattr__(self, name, values)
        axis = np.array(np.broadcast_to(np.asarray(self.axis), (size,)))
        if not np.isin(axis, (-1, 0, 1, 2)).all():
            raise InputError(f"axis of lumps is {self.axis}", parameter="lumps.axis", allowed="-1, 0, 1 or 2")
        axis = axis.astype(np.int64)
        axis.setflags(write=False)
        object.__setattr__(self, "axis", axis)

    def __len__(self) -> int:
        return int(self.volume.size)

    def __add__(self, other: Lumps) -> Lumps:
        """Join the lumps of two parts of one body."""
        names = ("place", "volume", "length", "drag_area", "added_mass", "axis")
        return Lumps(*(np.concatenate([getattr(self, name), getattr(other, name)]) for name in names))

    @property
    def breadth(self) -> Array:
        """Breadth of each lump across its axis [m], from volume and length; 0 for lumps that are always wet."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(
                self.length > 0.0, np.sqrt(self.volume / np.where(self.length > 0.0, self.length, 1.0)), 0.0
            )

    def arrays(self, centre: Array) -> tuple[Array, ...]:
        """Return what the kernel reads, places counted from ``centre`` [m].

        Parameters
        ----------
        centre : ndarray (3,)
            Centre of gravity in body axes [m].
        """
        return (
            np.ascontiguousarray(self.place - centre), self.volume.copy(), self.length.copy(), self.breadth.copy(),
            self.drag_area.copy(), self.added_mass.copy(), np.array(self.axis),
        )  # fmt: skip


def no_lumps() -> Lumps:
    """Return a hull that the water does not see."""
    return Lumps(np.zeros((0, 3)), np.zeros(0), np.zeros(0), np.zeros((0, 3)), np.zeros((0, 3)))


def volume_lump(
    place: ArrayLike,
    volume: float,
    *,
    drag_area: ArrayLike = (0.0, 0.0, 0.0),
    added_mass: ArrayLike = (0.0, 0.0, 0.0),
) -> Lumps:
    """Return one lump that is always wet (a submerged float, a frame member, a clump of known drag)."""
    return Lumps(
        np.asarray(place, dtype=float).reshape(1, 3), np.array([volume]), np.zeros(1),
        np.asarray(drag_area, dtype=float).reshape(1, 3), np.asarray(added_mass, dtype=float).reshape(1, 3),
    )  # fmt: skip


def _positive(values: dict[str, float]) -> None:
    for name, value in values.items():
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name} of the hull is {value:g}", parameter=f"hull.{name}", allowed="greater than 0")


def box_hull(
    size: ArrayLike,
    *,
    bottom: float,
    columns: tuple[int, int] = (4, 4),
    drag: ArrayLike = (0.0, 0.0, 0.0),
    added_mass: ArrayLike = (0.0, 0.0, 0.0),
    density: float = 0.0,
    layers: int = 1,
) -> Lumps:
    """Return a box as upright columns at Gauss points of its water plane [eq:coupled-lumps].

    With Gauss points two columns a side already give the exact water plane and metacentre of an upright box; more
    follow a large heel and the slope of a short wave.

    Parameters
    ----------
    size : array_like (3,)
        Along x, y, z of the body [m].
    bottom : float
        Height of its bottom over the body's origin [m]; the box is centred in x and y.
    columns : (int, int)
        Number along x and y.
    drag : array_like (3,)
        Drag coefficients of the faces across x, y (on what is wet) and z [-].
    added_mass : array_like (3,)
        Coefficients on the displaced mass along x, y, z [-].
    density : float
        Of the water, for the added mass [kg/m3].
    layers : int
        Cuts of each column over its height; one is exact for buoyancy, more follow the wave over the depth.

    Returns
    -------
    Lumps
        Places [m], volumes [m3], drag areas [m2] and added mass [kg] of the parts, in body axes.

    Raises
    ------
    InputError
        For sizes that are not positive, less than one column or layer, and added mass without a density.

    Examples
    --------
    >>> from moyai.coupled import box_hull
    >>> hull = box_hull((4.0, 3.0, 2.0), bottom=-1.0)
    >>> hull.place.shape, round(float(hull.volume.sum()), 6)             # 16 columns, 4 x 3 x 2 [m3]
    ((16, 3), 24.0)
    """
    length, width, height = (float(item) for item in np.asarray(size, dtype=float).reshape(3))
    _positive({"length": length, "width": width, "height": height})
    cd, ca = np.asarray(drag, dtype=float).reshape(3), np.asarray(added_mass, dtype=float).reshape(3)
    if np.any(ca != 0.0) and not density > 0.0:
        raise InputError(
            "added mass of a hull needs the density of the water", parameter="hull.density", allowed="above 0"
        )
    if min(*columns, layers) < 1:
        raise InputError(f"{columns} columns, {layers} layers", parameter="hull.columns", allowed="1 or more")
    (gx, wx), (gy, wy) = (np.polynomial.legendre.leggauss(count) for count in columns)
    x, y = np.meshgrid(0.5 * length * gx, 0.5 * width * gy, indexing="ij")
    share = np.outer(0.5 * wx, 0.5 * wy).ravel()
    part = height / layers
    centres = bottom + part * (np.arange(layers) + 0.5)
    place = np.array([(a, b, c) for a, b in zip(x.ravel(), y.ravel(), strict=True) for c in centres])
    weight = np.repeat(share, layers) / layers
    volume = weight * length * width * height
    drag_area = weight[:, None] * cd * np.array([width * height, length * height, 0.0])
    # the flat bottom is met by the lowest layer alone
    lowest = np.tile(np.arange(layers) == 0, share.size)
    drag_area[:, 2] = np.where(lowest, np.repeat(share, layers) * cd[2] * length * width, 0.0)
    return Lumps(place, volume, np.full(volume.size, part), drag_area, density * volume[:, None] * ca, 2)


def cylinder_hull(
    diameter: float,
    height: float,
    *,
    bottom: float,
    rings: int = 3,
    spokes: int = 8,
    drag: tuple[float, float] = (0.0, 0.0),
    added_mass: tuple[float, float] = (0.0, 0.0),
    density: float = 0.0,
    layers: int = 1,
) -> Lumps:
    """Return an upright cylinder as columns at Gauss points of its water plane [eq:coupled-lumps].

    Parameters
    ----------
    diameter, height : float
        [m].
    bottom : float
        Height of its bottom over the body's origin [m].
    rings, spokes : int
        Columns over the radius and around.
    drag, added_mass : (float, float)
        Coefficients across (on diameter times height, on the displaced mass) and along the axis (on the face, on the
        displaced mass) [-].
    density : float
        Of the water, for the added mass [kg/m3].
    layers : int
        Cuts of each column over the height.

    Returns
    -------
    Lumps
        Places [m], volumes [m3], drag areas [m2] and added mass [kg] of the parts, in body axes.

    Raises
    ------
    InputError
        For sizes that are not positive, less than one ring, three spokes or one layer, and added mass without a
        density.

    Examples
    --------
    >>> import math
    >>> from moyai.coupled import cylinder_hull
    >>> hull = cylinder_hull(2.0, 3.0, bottom=-1.5)
    >>> hull.place.shape, round(float(hull.volume.sum()) / math.pi, 6)   # 24 columns, 3 pi [m3]
    ((24, 3), 3.0)
    """
    _positive({"diameter": diameter, "height": height})
    if max(added_mass) > 0.0 and not density > 0.0:
        raise InputError(
            "added mass of a hull needs the density of the water", parameter="hull.density", allowed="above 0"
        )
    if rings < 1 or spokes < 3 or layers < 1:
        raise InputError(f"{rings} rings, {spokes} spokes", parameter="hull.rings", allowed="1 ring, 3 spokes or more")
    # in the square of the radius the area is uniform, and Gauss points integrate r^2 exactly
    g, w = np.polynomial.legendre.leggauss(rings)
    radius = 0.5 * diameter * np.sqrt(0.5 * (g + 1.0))
    turn = 2.0 * math.pi * (np.arange(spokes) + 0.5) / spokes
    part, area = height / layers, 0.25 * math.pi * diameter**2
    places, shares = [], []
    for r, share in zip(radius, 0.5 * w, strict=True):
        for angle in turn:
            places.append((r * math.cos(angle), r * math.sin(angle)))
            shares.append(share / spokes)
    centres = bottom + part * (np.arange(layers) + 0.5)
    place = np.array([(a, b, c) for a, b in places for c in centres])
    weight = np.repeat(shares, layers) / layers
    volume = weight * area * height
    lowest = np.tile(np.arange(layers) == 0, len(shares))
    drag_area = np.stack(
        [
            weight * drag[0] * diameter * height,
            weight * drag[0] * diameter * height,
            np.where(lowest, np.repeat(shares, layers) * drag[1] * area, 0.0),
        ],
        axis=1,
    )
    added = density * volume[:, None] * np.array([added_mass[0], added_mass[0], added_mass[1]])
    return Lumps(place, volume, np.full(volume.size, part), drag_area, added, 2)
