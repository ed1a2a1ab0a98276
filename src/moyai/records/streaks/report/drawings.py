"""Drawings of flow images: the picture with the streaks that were found, and the map of drift velocities."""

from __future__ import annotations

import base64
import math
import struct
import zlib
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.report.document import Drawing
from moyai.report.sketch import Sketch

# Bright on the dark of a picture, and apart for most colour-blind readers
TONES = ("#56b4e9", "#e69f00", "#5fd38d", "#f0e442", "#ff8ac4", "#ff7043", "#b39ddb", "#80deea")


def grey_png(grey: NDArray[np.uint8]) -> bytes:
    """Return a grey picture of 8 bits as PNG."""
    rows, columns = grey.shape

    def chunk(name: bytes, content: bytes) -> bytes:
        body = name + content
        return struct.pack(">I", len(content)) + body + struct.pack(">I", zlib.crc32(body))

    lines = np.zeros((rows, columns + 1), dtype=np.uint8)
    lines[:, 1:] = grey
    header = struct.pack(">IIBBBBB", columns, rows, 8, 0, 0, 0, 0)
    content = zlib.compress(lines.tobytes(), 9)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", content) + chunk(b"IEND", b"")


def overlay(key: str, title: str, grey: NDArray[np.uint8], ends: Array, particle: NDArray[np.int64]) -> Drawing:
    """Return the picture with every streak that was found, in one tone a particle.

    Parameters
    ----------
    key, title : str
    grey : ndarray of uint8
        Brightened picture.
    ends : ndarray, shape (streaks, 2, 2)
        Column and row of both ends.
    particle : ndarray of int, shape (streaks,)
        Particle of each streak, -1 where it belongs to none.
    """
    rows, columns = grey.shape
    data = base64.b64encode(grey_png(grey)).decode("ascii")
    parts = [f'<image href="data:image/png;base64,{data}" width="{columns}" height="{rows}"/>']
    groups: dict[str, list[str]] = {}
    for (first, last), owner in zip(ends, particle):
        tone = TONES[int(owner) % len(TONES)] if owner >= 0 else "#9aa4ae"
        # Next to the streak, so that the streak itself stays to be seen
        step = last - first
        length = max(float(np.hypot(*step)), 1e-9)
        aside = 2.2 * np.array([-step[1], step[0]]) / length
        a, b = first + aside + 0.5, last + aside + 0.5
        groups.setdefault(tone, []).append(f"M{a[0]:.1f},{a[1]:.1f}L{b[0]:.1f},{b[1]:.1f}")
    for tone, steps in groups.items():
        opacity = 0.55 if tone == "#9aa4ae" else 1.0
        parts.append(f'<path d="{"".join(steps)}" stroke="{tone}" stroke-width="1.3" opacity="{opacity}" fill="none"/>')
    svg = (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {columns} {rows}" role="img" '
        f'aria-label="{title}">{"".join(parts)}</svg>'
    )
    used = int((particle >= 0).sum())
    caption = (
        f"{len(ends)} streaks found, {used} of them in chains that give a drift velocity: one colour a particle, grey "
        "the others. Lines are drawn next to the streaks. "
        "With one picture a pulse the brightest of all frames is shown."
    )
    return Drawing(key, title, svg, svg, caption)


def drift_map(
    key: str,
    title: str,
    position: Array,
    velocity: Array,
    outline: Array,
    ratios: Sequence[float],
    period: float,
) -> Drawing:
    """Return arrows of the drift velocities around the section, to scale, with the contours.

    Parameters
    ----------
    key, title : str
    position, velocity : ndarray, shape (particles, 2)
        From the centre of the section [m], [m/s].
    outline : ndarray, shape (n, 2)
    ratios : sequence of float
        Sizes of the contours that have a circulation.
    period : float
        Wave period [s].
    """
    speed = np.hypot(velocity[:, 0], velocity[:, 1])
    typical = float(np.percentile(speed, 90.0)) if len(speed) else 1.0
    breadth = float(np.ptp(outline[:, 0]))
    # A fast particle's arrow is a third of the section long
    stretch = breadth / 3.0 / max(typical, 1e-12)
    heads = position + stretch * velocity
    corners = np.vstack([position, heads, outline])
    low, high = corners.min(axis=0) - 0.1 * breadth, corners.max(axis=0) + 0.1 * breadth
    sketch = Sketch((low[0], high[0], low[1], high[1]), width=900.0, margin=(10.0, 34.0, 10.0, 10.0), title=title)
    for ratio in ratios:
        sketch.path(ratio * outline, "dimension", closed=True)
    sketch.path(outline, "hull", closed=True)
    order = np.argsort(speed)
    for index in order:
        a, b = position[index], heads[index]
        sketch.arrow((sketch.px(a[0]), sketch.pz(a[1])), (sketch.px(b[0]), sketch.pz(b[1])), "axis")
    rounded = _round(typical)
    length = stretch * rounded * sketch.scale
    sketch.arrow((20.0, 18.0), (20.0 + length, 18.0), "axis")
    sketch.text(
        sketch.x0,
        high[1],
        f"{100.0 * rounded:g} cm/s, or {1000.0 * rounded * period:.2g} mm in a period",
        shift=(20.0 + length, -11.0),
        anchor="start",
    )
    caption = (
        f"{len(position)} particles at their mean positions, settling and mass transport taken off. Thin lines: "
        "contours similar to the section along which the circulation is taken."
    )
    return sketch.drawing(key, title, caption)


def _round(value: float) -> float:
    power = 10.0 ** math.floor(math.log10(max(value, 1e-9)))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= value * 1.0000001)
