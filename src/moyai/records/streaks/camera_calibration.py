"""From pixels to the plane of the light sheet: a homography from targets, and the exact rays through wall and water.

World coordinates are x, z in the light sheet. Pixel coordinates are column and row, counted from the centre of the
upper left pixel, rows downwards.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError


class CameraCalibration(Protocol):
    """What takes pixels to the light sheet and back."""

    @property
    def residual(self) -> float:
        """Root mean square distance of the targets in pixels."""

    def to_world(self, pixels: ArrayLike) -> Array:
        """Return x, z [m] of pixels, shape (n, 2)."""

    def to_pixels(self, world: ArrayLike) -> Array:
        """Return column and row of points x, z [m], shape (n, 2)."""


@dataclass(frozen=True)
class Refraction:
    """Flat wall and water between camera and light sheet, all parallel."""

    #: From the camera's centre of projection to the outside of the wall [m].
    camera_to_wall: float
    #: Thickness of the wall [m].
    wall_thickness: float
    #: Refractive index of the wall.
    wall_index: float
    #: From the inside of the wall to the light sheet [m].
    sheet_distance: float
    #: Refractive index of the water.
    water_index: float

    def __post_init__(self) -> None:
        for name in ("camera_to_wall", "sheet_distance"):
            if not getattr(self, name) > 0.0:
                raise InputError(f"{name} is {getattr(self, name):g} m", parameter=name, allowed="greater than 0 m")
        if not self.wall_thickness >= 0.0:
            raise InputError(
                f"a wall of {self.wall_thickness:g} m", parameter="refraction.wall_thickness", allowed="at least 0 m"
            )
        for name in ("wall_index", "water_index"):
            if not 1.0 <= getattr(self, name) <= 3.0:
                raise InputError(f"{name} is {getattr(self, name):g}", parameter=name, allowed="between 1 and 3")

    @property
    def distance(self) -> float:
        """From the camera to the light sheet [m]."""
        return self.camera_to_wall + self.wall_thickness + self.sheet_distance

    @property
    def magnification(self) -> float:
        """Size in water over size in the empty tank of something near the axis of view [eq:streaks-apparent-depth]."""
        apparent = self.camera_to_wall + self.wall_thickness / self.wall_index + self.sheet_distance / self.water_index
        return self.distance / apparent

    def reach(self, tangent: ArrayLike) -> Array:
        """Return how far from the axis a ray meets the sheet [m], by Snell's law [eq:streaks-snell].

        Parameters
        ----------
        tangent : array_like
            Tangent of the ray's angle to the normal of the wall, in air.
        """
        slope = np.asarray(tangent, dtype=float)
        sine = slope / np.sqrt(1.0 + slope**2)
        total = self.camera_to_wall * slope
        for thickness, index in ((self.wall_thickness, self.wall_index), (self.sheet_distance, self.water_index)):
            inner = sine / index
            total = total + thickness * inner / np.sqrt(1.0 - inner**2)
        return np.asarray(total)

    def tangent(self, reach: ArrayLike) -> Array:
        """Return the tangent in air of the ray that meets the sheet at ``reach`` [m]: Newton's method."""
        wanted = np.asarray(reach, dtype=float)
        apparent = self.distance / self.magnification
        slope = wanted / apparent
        for _ in range(50):
            step = 1e-6 * np.maximum(np.abs(slope), 1e-3)
            gradient = (self.reach(slope + step) - self.reach(slope - step)) / (2.0 * step)
            change = (self.reach(slope) - wanted) / gradient
            slope = slope - change
            if np.all(np.abs(change) <= 1e-14 + 1e-13 * np.abs(slope)):
                break
        return np.asarray(slope)


@dataclass(frozen=True, eq=False)
class Homography:
    """Projective map between two planes [eq:streaks-homography]."""

    #: From world (x, z, 1) to pixels (column, row, 1), up to a factor; shape (3, 3).
    matrix: Array
    #: Root mean square distance of the targets in pixels.
    residual: float = 0.0
    #: How much an error of the targets grows: ratio of the largest to the second smallest singular value.
    condition: float = 1.0

    def to_pixels(self, world: ArrayLike) -> Array:
        """Return column and row of points x, z [m], shape (n, 2)."""
        return _project(self.matrix, np.atleast_2d(np.asarray(world, dtype=float)))

    def to_world(self, pixels: ArrayLike) -> Array:
        """Return x, z [m] of pixels, shape (n, 2)."""
        return _project(
            np.asarray(np.linalg.inv(self.matrix), dtype=float), np.atleast_2d(np.asarray(pixels, dtype=float))
        )


def _project(matrix: Array, points: Array) -> Array:
    lifted = np.column_stack([points, np.ones(len(points))]) @ matrix.T
    return np.asarray(lifted[:, :2] / lifted[:, 2:])


def fit_homography(pixels: ArrayLike, world: ArrayLike) -> Homography:
    """Fit a homography to targets: direct linear transformation, then least squares of the pixel distances.

    Parameters
    ----------
    pixels, world : array_like, shape (n, 2)
        The same targets in the picture and in the light sheet [m]; at least four, no three of four on a line.

    Raises
    ------
    InputError
        Fewer than four targets, targets on one line, or two of a kind.
    """
    picture, sheet = _check_targets(pixels, world)
    from scipy.optimize import least_squares

    to_unit_picture, to_unit_sheet = _normalising(picture), _normalising(sheet)
    p, w = _project(to_unit_picture, picture), _project(to_unit_sheet, sheet)
    rows = []
    for (u, v), (x, z) in zip(p, w):
        rows += [[x, z, 1, 0, 0, 0, -u * x, -u * z, -u], [0, 0, 0, x, z, 1, -v * x, -v * z, -v]]
    _, singular, right = np.linalg.svd(np.array(rows, dtype=float))
    condition = float(singular[0] / max(singular[7], 1e-300))
    if condition > 1e6:
        raise InputError(
            "the targets lie on one line, or three of four do, so that the homography is not determined",
            parameter="targets",
            remedy="spread the targets over the field of view",
        )
    start = right[-1].reshape(3, 3)

    def misses(values: Array) -> Array:
        return np.asarray((_project(values.reshape(3, 3), w) - p).ravel())

    solved = least_squares(misses, start.ravel(), xtol=1e-15, ftol=1e-15)
    matrix = np.linalg.inv(to_unit_picture) @ solved.x.reshape(3, 3) @ to_unit_sheet
    matrix = matrix / np.linalg.norm(matrix)
    misfit = _project(matrix, sheet) - picture
    return Homography(matrix, math.sqrt(float((misfit**2).sum()) / len(picture)), condition)


def _check_targets(pixels: ArrayLike, world: ArrayLike) -> tuple[Array, Array]:
    picture, sheet = np.asarray(pixels, dtype=float), np.asarray(world, dtype=float)
    if picture.ndim != 2 or picture.shape[1:] != (2,) or sheet.shape != picture.shape:
        raise InputError("every target needs column, row, x and z", parameter="targets")
    if len(picture) < 4:
        raise InputError(f"{len(picture)} targets are too few", parameter="targets", allowed="at least 4")
    for values, what in ((picture, "pixel"), (sheet, "position")):
        if not np.isfinite(values).all():
            raise InputError(f"a target's {what} is not a finite number", parameter="targets")
        centred = values - values.mean(axis=0)
        extent = np.linalg.svd(centred, compute_uv=False)
        if extent[1] < 1e-6 * extent[0] or extent[0] == 0.0:
            raise InputError(
                "the targets lie on one line, so that the plane is not determined",
                parameter="targets",
                remedy="spread the targets over the field of view",
            )
        distance = np.hypot(*(values[:, None, :] - values[None, :, :]).transpose(2, 0, 1))
        np.fill_diagonal(distance, np.inf)
        if distance.min() < 1e-9 * extent[0]:
            raise InputError(f"two targets share one {what}", parameter="targets", remedy="remove one of them")
    return picture, sheet


def _normalising(points: Array) -> Array:
    centre = points.mean(axis=0)
    scale = math.sqrt(2.0) / float(np.hypot(*(points - centre).T).mean())
    return np.array([[scale, 0.0, -scale * centre[0]], [0.0, scale, -scale * centre[1]], [0.0, 0.0, 1.0]])


@dataclass(frozen=True, eq=False)
class RayCamera:
    """Pinhole camera that looks through a wall into water, with exact rays."""

    #: Foot x, z of the camera on the light sheet, along the normal of the wall [m]; shape (2,).
    foot: Array
    #: Rotation vector of the camera from looking straight at the wall [rad]; shape (3,).
    rotation: Array
    #: In pixels.
    focal_length: float
    #: Principal point, column and row; shape (2,).
    centre: Array
    refraction: Refraction
    #: Root mean square distance of the targets in pixels.
    residual: float = 0.0

    def to_pixels(self, world: ArrayLike) -> Array:
        """Return column and row of points x, z [m], shape (n, 2)."""
        offset = np.atleast_2d(np.asarray(world, dtype=float)) - self.foot
        reach = np.hypot(offset[:, 0], offset[:, 1])
        tangent = self.refraction.tangent(reach)
        share = np.where(reach > 0.0, tangent / np.where(reach > 0.0, reach, 1.0), 0.0)[:, None]
        # Camera axes: column along x, row along -z, depth into the tank
        rays = np.column_stack([offset[:, :1] * share, -offset[:, 1:] * share, np.ones(len(offset))])
        seen = rays @ _rotation_matrix(self.rotation)
        return np.asarray(self.centre + self.focal_length * seen[:, :2] / seen[:, 2:])

    def to_world(self, pixels: ArrayLike) -> Array:
        """Return x, z [m] of pixels, shape (n, 2)."""
        offset = (np.atleast_2d(np.asarray(pixels, dtype=float)) - self.centre) / self.focal_length
        rays = np.column_stack([offset, np.ones(len(offset))]) @ _rotation_matrix(self.rotation).T
        slope = rays[:, :2] / rays[:, 2:]
        tangent = np.hypot(slope[:, 0], slope[:, 1])
        share = np.where(tangent > 0.0, self.refraction.reach(tangent) / np.where(tangent > 0.0, tangent, 1.0), 0.0)
        return np.asarray(self.foot + slope * np.array([1.0, -1.0]) * share[:, None])


def _rotation_matrix(vector: Array) -> Array:
    from scipy.spatial.transform import Rotation

    return np.asarray(Rotation.from_rotvec(vector).as_matrix())


def fit_ray_camera(
    pixels: ArrayLike, world: ArrayLike, *, refraction: Refraction, shape: tuple[int, int], dry: bool = False
) -> RayCamera:
    """Fit the place, direction and focal length of a camera to targets in the light sheet.

    Parameters
    ----------
    pixels, world : array_like, shape (n, 2)
        Targets in the picture and in the sheet [m].
    refraction : Refraction
        Measured distances and indices.
    shape : tuple of int
        Rows and columns of the picture; its middle is taken as the principal point.
    dry : bool
        The targets were photographed in the empty tank: fitted without the water, used with it.

    Raises
    ------
    InputError
        As :func:`fit_homography`; at least six targets are needed.
    """
    from scipy.optimize import least_squares

    picture, sheet = _check_targets(pixels, world)
    if len(picture) < 6:
        raise InputError(
            f"{len(picture)} targets are too few for the ray model", parameter="targets", allowed="at least 6"
        )
    plane = fit_homography(picture, sheet)
    medium = refraction
    if dry:
        medium = Refraction(
            refraction.camera_to_wall,
            refraction.wall_thickness,
            refraction.wall_index,
            refraction.sheet_distance,
            1.0,
        )
    centre = np.array([0.5 * (shape[1] - 1), 0.5 * (shape[0] - 1)])
    middle = plane.to_world(centre)[0]
    size = 1e-3 * refraction.distance
    pixels_per_metre = np.linalg.norm(plane.to_pixels(middle + np.array([size, 0.0])) - plane.to_pixels(middle)) / size
    focal = float(pixels_per_metre) * medium.distance / medium.magnification
    spread = float(np.ptp(sheet, axis=0).max())

    def camera(x: Array) -> RayCamera:
        return RayCamera(middle + spread * x[:2], x[2:5], focal * math.exp(x[5]), centre, medium)

    def misses(x: Array) -> Array:
        return np.asarray((camera(x).to_pixels(sheet) - picture).ravel())

    solved = least_squares(misses, np.zeros(6), xtol=1e-14, ftol=1e-14, gtol=1e-14)
    found = camera(solved.x)
    residual = math.sqrt(float((solved.fun**2).sum()) / len(picture))
    return RayCamera(found.foot, found.rotation, found.focal_length, centre, refraction, residual)


def dry_to_wet(homography: Homography, refraction: Refraction, axis: ArrayLike) -> Homography:
    """Return a homography made in the empty tank as it holds with water, near the axis of view.

    Parameters
    ----------
    homography : Homography
        From targets in air at the place of the light sheet.
    refraction : Refraction
    axis : array_like
        Foot x, z of the camera on the sheet [m]: the point that does not move.
    """
    dry = Refraction(
        refraction.camera_to_wall, refraction.wall_thickness, refraction.wall_index, refraction.sheet_distance, 1.0
    )
    factor = refraction.magnification / dry.magnification
    foot = np.asarray(axis, dtype=float)
    grow = np.array([[factor, 0.0, foot[0] * (1.0 - factor)], [0.0, factor, foot[1] * (1.0 - factor)], [0.0, 0.0, 1.0]])
    return Homography(homography.matrix @ grow, homography.residual, homography.condition)
