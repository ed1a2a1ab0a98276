"""Hulls of common shape, in the body frame: x from the centre, z upwards from the keel. Lengths in metres."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.errors import InputError
from moyai.potential.sections import Hull, Outline


def _positive(**lengths: float) -> None:
    for name, value in lengths.items():
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name} is {value:g} m", parameter=name, allowed="greater than 0 m")


def rectangle(beam: float, height: float) -> Hull:
    """Return a box.

    Parameters
    ----------
    beam, height : float
        [m].

    Returns
    -------
    Hull
        One outline in the body frame, x = 0 in the middle, z = 0 at the keel [m].

    Raises
    ------
    InputError
        For a size that is not positive.

    Examples
    --------
    >>> from moyai.potential import shapes
    >>> section = shapes.rectangle(beam=4.0, height=2.0).immersed(draught=1.0)
    >>> round(section.area, 3), [round(z, 3) for z in section.centroid]  # [m2], centre of buoyancy [m]
    (4.0, [0.0, -0.5])
    """
    _positive(beam=beam, height=height)
    return _rectangle(float(beam), float(height))


@lru_cache(maxsize=64)
def _rectangle(beam: float, height: float) -> Hull:
    half = 0.5 * beam
    return Hull((Outline(np.array([(-half, 0.0), (half, 0.0), (half, height), (-half, height)])),), name="rectangle")


def rounded_rectangle(beam: float, height: float, bilge_radius: float) -> Hull:
    """Return a box whose two lower corners are quarter circles of ``bilge_radius``.

    Parameters
    ----------
    beam, height : float
        Of the box [m].
    bilge_radius : float
        [m].

    Returns
    -------
    Hull
        One outline in the body frame, z = 0 at the keel [m].

    Raises
    ------
    InputError
        When a size is not positive, or the radius exceeds half the beam or the height.

    Examples
    --------
    >>> from moyai.potential import shapes
    >>> section = shapes.rounded_rectangle(beam=4.0, height=2.0, bilge_radius=0.5).immersed(draught=1.0)
    >>> round(section.area, 4)                                           # 4 - 2 (1 - pi / 4) 0.5^2 [m2]
    3.8927
    """
    _positive(beam=beam, height=height, bilge_radius=bilge_radius)
    half = 0.5 * beam
    limit = min(half, height)
    if bilge_radius > limit:
        raise InputError(
            f"bilge_radius is {bilge_radius:g} m", parameter="bilge_radius", allowed=f"at most {limit:g} m"
        )
    quarter = math.tan(math.pi / 8.0)
    r = bilge_radius
    corners: list[tuple[float, float, float]] = [(-half, r, quarter), (-half + r, 0.0, 0.0)]
    if r < half:
        corners.append((half - r, 0.0, quarter))
    else:
        corners[-1] = (0.0, 0.0, quarter)
    corners.append((half, r, 0.0))
    if r < height:
        corners += [(half, height, 0.0), (-half, height, 0.0)]
    table = np.array(corners)
    return Hull((Outline(table[:, :2], table[:, 2]),), name="rounded rectangle")


def circle(radius: float) -> Hull:
    """Return a circular cylinder; its axis lies one radius above the keel.

    Parameters
    ----------
    radius : float
        [m].

    Returns
    -------
    Hull
        One outline in the body frame, z = 0 at the keel [m].

    Raises
    ------
    InputError
        For a radius that is not positive.

    Examples
    --------
    >>> from moyai.potential import shapes
    >>> section = shapes.circle(radius=1.0).immersed(draught=1.0)
    >>> round(section.area, 4)                                           # pi / 2 [m2]
    1.5708
    """
    _positive(radius=radius)
    return Hull((Outline(np.array([(-radius, radius), (radius, radius)]), np.array([1.0, 1.0])),), name="circle")


def trapezoid(bottom_beam: float, top_beam: float, height: float) -> Hull:
    """Return a symmetric trapezoid.

    Parameters
    ----------
    bottom_beam, top_beam : float
        Breadth at the keel and at the deck [m].
    height : float
        [m].

    Returns
    -------
    Hull
        One outline in the body frame, z = 0 at the keel [m].

    Raises
    ------
    InputError
        For a size that is not positive.

    Examples
    --------
    >>> from moyai.potential import shapes
    >>> section = shapes.trapezoid(bottom_beam=4.0, top_beam=6.0, height=2.0).immersed(draught=1.0)
    >>> round(section.area, 3)                                           # (4 + 5) / 2 [m2]
    4.5
    """
    _positive(bottom_beam=bottom_beam, top_beam=top_beam, height=height)
    b, t = 0.5 * bottom_beam, 0.5 * top_beam
    return Hull((Outline(np.array([(-b, 0.0), (b, 0.0), (t, height), (-t, height)])),), name="trapezoid")


def pi_type(beam: float, height: float, plate_depth: float, plate_thickness: float) -> Hull:
    """Return a box of ``beam`` x ``height`` with a plate hanging ``plate_depth`` under each of its two sides.

    The keel (z = 0) is at the tips of the plates; their outer faces continue the sides of the box.

    Parameters
    ----------
    beam, height : float
        Of the box [m].
    plate_depth : float
        How far the plates reach below the box [m].
    plate_thickness : float
        [m].

    Returns
    -------
    Hull
        One outline in the body frame [m].

    Raises
    ------
    InputError
        When a size is not positive, or the plates meet.

    Examples
    --------
    >>> from moyai.potential import shapes
    >>> hull = shapes.pi_type(beam=4.0, height=2.0, plate_depth=1.0, plate_thickness=0.2)
    >>> round(hull.immersed(draught=2.0).area, 3)                        # 4 x 1 + 2 x 0.2 x 1 [m2]
    4.4
    """
    _positive(beam=beam, height=height, plate_depth=plate_depth, plate_thickness=plate_thickness)
    half, inner, top = 0.5 * beam, 0.5 * beam - plate_thickness, plate_depth + height
    if inner <= 0.0:
        raise InputError(
            f"plate_thickness is {plate_thickness:g} m", parameter="plate_thickness", allowed=f"less than {half:g} m"
        )
    right = [(inner, plate_depth), (inner, 0.0), (half, 0.0), (half, top)]
    left = [(-x, z) for x, z in reversed(right)]
    return Hull((Outline(np.array(right + left)),), name="pi type")


def twin_pontoon(pontoon_beam: float, height: float, gap: float, *, deck_thickness: float = 0.0) -> Hull:
    """Return two boxes of ``pontoon_beam`` x ``height``, ``gap`` apart.

    Parameters
    ----------
    pontoon_beam, height : float
        Of each box [m]; the height includes the deck.
    gap : float
        Clear width between the boxes [m].
    deck_thickness : float
        Thickness [m] of a deck that joins them at the top; 0 draws two separate outlines (one body all the same).

    Returns
    -------
    Hull
        Two outlines, or one with a deck, in the body frame; z = 0 at the keel, x = 0 in the middle of the gap [m].

    Raises
    ------
    InputError
        When a size is not positive, or the deck is thicker than the height.

    Examples
    --------
    >>> from moyai.potential import shapes
    >>> section = shapes.twin_pontoon(pontoon_beam=2.0, height=2.0, gap=3.0).immersed(draught=1.0)
    >>> len(section.outlines), round(section.area, 3)                    # [m2]
    (2, 4.0)
    """
    _positive(pontoon_beam=pontoon_beam, height=height, gap=gap)
    inner, outer = 0.5 * gap, 0.5 * gap + pontoon_beam
    if deck_thickness == 0.0:
        box = np.array([(inner, 0.0), (outer, 0.0), (outer, height), (inner, height)])
        return Hull((Outline(box * np.array([-1.0, 1.0])), Outline(box)), name="twin pontoon")
    if not 0.0 < deck_thickness < height:
        raise InputError(
            f"deck_thickness is {deck_thickness:g} m", parameter="deck_thickness", allowed=f"0 to {height:g} m"
        )
    right = [(inner, height - deck_thickness), (inner, 0.0), (outer, 0.0), (outer, height)]
    left = [(-x, z) for x, z in reversed(right)]
    return Hull((Outline(np.array(right + left)),), name="twin pontoon")


def polygon(points: ArrayLike, *, bulges: Any = None, name: str = "polygon") -> Hull:
    """Return a hull of one closed outline through ``points`` (n, 2), with arcs where ``bulges`` say so.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Corners (x, z) [m]; z is measured from the keel (where it does not, ``draught`` is the depth of its z = 0).
    bulges : array_like, shape (n,), optional
        tan(sweep / 4) of the edge that leaves each corner.
    name : str
        For messages and plots.

    Returns
    -------
    Hull
        One outline in the body frame [m].

    Raises
    ------
    InputError
        For points that are no closed outline: NaN, fewer than three corners (two with arcs), repeated corners, no area,
        or edges that cross.

    Examples
    --------
    >>> from moyai.potential import shapes
    >>> hull = shapes.polygon([(-2.0, 0.0), (2.0, 0.0), (3.0, 2.0), (-3.0, 2.0)], name="barge")
    >>> round(hull.immersed(draught=1.0).area, 3)                        # (4 + 5) / 2 [m2]
    4.5
    """
    return Hull((Outline(np.asarray(points, dtype=float), bulges),), name=name)
