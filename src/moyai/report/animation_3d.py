"""A scene as a block of the report: the player, and a still for paper."""

from __future__ import annotations

from functools import partial

from moyai.report.document import Animation
from moyai.report.scene_3d import Scene3D, scene_3d
from moyai.report.still_3d import still_3d


def animation_3d(key: str, title: str, scene: Scene3D, caption: str = "") -> Animation:
    """Return the block of a report: the animation, and its governing moment as a picture for paper.

    Parameters
    ----------
    key, title, caption : str
    scene : Scene3D

    Returns
    -------
    Animation
    """
    return Animation(key, title, scene_3d(scene), caption, partial(still_3d, scene), scene)
