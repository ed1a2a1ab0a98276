"""Is a calibration believable: targets that miss, views that are mirrored or turned, sections outside the picture."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.records.streaks.camera_calibration import CameraCalibration, fit_homography

#: Misfit of the targets over their extent in the picture above which no lens explains it
_LARGEST_MISFIT = 0.02
#: Misfit in pixels above which a run says so
_TOLD_MISFIT = 1.0


def require_fitting_targets(calibration: CameraCalibration, pixels: ArrayLike, world: ArrayLike) -> None:
    """Refuse targets that do not fit one plane, and name the one that is likely to be wrong.

    Parameters
    ----------
    calibration : Calibration
        Fitted to the targets.
    pixels, world : array_like, shape (n, 2)
        Column, row; x, z [m].

    Raises
    ------
    InputError
        When the root mean square misfit exceeds two per cent of the extent of the targets in the picture.
    """
    picture, sheet = np.asarray(pixels, dtype=float), np.asarray(world, dtype=float)
    extent = float(np.ptp(picture, axis=0).max())
    if calibration.residual <= _LARGEST_MISFIT * extent:
        return
    raise InputError(
        f"the targets miss a plane picture by {calibration.residual:.3g} pixels{_culprit(picture, sheet)}",
        parameter="targets",
        allowed=f"at most {_LARGEST_MISFIT * extent:.3g} pixels",
        remedy="check columns, rows and positions of the targets",
    )


def _culprit(picture: Array, sheet: Array) -> str:
    """Return which single target spoils the fit, empty where none does."""
    count = len(picture)
    if not 6 <= count <= 200:
        return ""
    left = np.array([_misfit_without(picture, sheet, index) for index in range(count)])
    worst = int(np.argmin(left))
    return f"; without target {worst + 1} by {left[worst]:.2g}" if left[worst] < 0.2 * np.median(left) else ""


def _misfit_without(picture: Array, sheet: Array, index: int) -> float:
    keep = np.arange(len(picture)) != index
    try:
        return fit_homography(picture[keep], sheet[keep]).residual
    except InputError:
        return math.inf


def view_notices(calibration: CameraCalibration, centre: ArrayLike) -> tuple[Notice, ...]:
    """Tell of targets that miss, and of views that are mirrored or turned: they change the sign of a circulation.

    Parameters
    ----------
    calibration : Calibration
    centre : array_like, shape (2,)
        A point x, z of the light sheet within the picture [m].
    """
    notices = []
    if calibration.residual > _TOLD_MISFIT:
        notices.append(
            Notice(
                "targets-miss",
                f"the targets miss the calibration by {calibration.residual:.2g} pixels",
                value=calibration.residual,
                limit=_TOLD_MISFIT,
                remedy="check the targets; a lens with distortion needs pictures that are corrected before",
            )
        )
    at = np.asarray(centre, dtype=float)
    step = 1e-4
    here, along, up = calibration.to_pixels(at + step * np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]))
    # columns count to the right, rows downwards
    first = (along - here) * [1.0, -1.0]
    second = (up - here) * [1.0, -1.0]
    mirrored = first[0] * second[1] - first[1] * second[0] < 0.0
    turn = math.atan2(-second[0], second[1])
    if mirrored:
        notices.append(
            Notice(
                "view-mirrored",
                "the targets show the light sheet mirrored: with z upwards x runs to the left of the pictures, and "
                "clockwise in them is anticlockwise",
                remedy="right for a camera on the other side of the tank; else columns and rows, or a sign of x or z, "
                "were exchanged",
            )
        )
    if abs(turn) > 0.25 * math.pi:
        notices.append(
            Notice(
                "view-turned",
                f"the upward direction of the targets is turned by {math.degrees(turn):.0f} degrees in the pictures",
                value=abs(turn),
                limit=0.25 * math.pi,
                remedy="right for a camera that was turned; else columns and rows, or x and z, were exchanged",
                unit="rad",
            )
        )
    return tuple(notices)


def inside_picture(calibration: CameraCalibration, point: ArrayLike, shape: tuple[int, int]) -> bool:
    """Return whether a point x, z [m] of the light sheet lies within a picture of (rows, columns)."""
    column, row = calibration.to_pixels(np.asarray(point, dtype=float)[None, :])[0]
    return bool(-0.5 <= column <= shape[1] - 0.5 and -0.5 <= row <= shape[0] - 0.5)
