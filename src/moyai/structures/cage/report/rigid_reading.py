"""Read the result of a rigid cage: levels, seas, runs as arrays, the section of the cage at rest."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.report.encoding import slug
from moyai.report.reading import Group

MODES = ("sway", "heave", "roll")
ENDS = ("cage", "anchor")


@dataclass(frozen=True)
class CageLevel:
    """One water level: its group, name and depth [m]."""

    group: Group
    name: str
    depth: float

    def part(self, path: str) -> Group:
        """Return a group below."""
        return self.group.child(path)


def levels_of(root: Group) -> tuple[CageLevel, ...]:
    """Return the water levels of a result."""
    return tuple(
        CageLevel(child, child.name, float(child.attributes.get("water_depth", math.nan)))
        for child in root.children()
        if "water_depth" in child.attributes
    )


def key(level: CageLevel, *parts: str) -> str:
    """Return a unique key for a figure or table."""
    return slug(level.name, *parts)


@dataclass(frozen=True)
class RigidRecord:
    """A run as arrays."""

    run: Group
    #: [s].
    time: Array
    #: Sway, heave [m], roll [rad] of the centre of gravity from rest; shape (rows, 3).
    pose: Array
    #: At cage and anchor [N]; shape (rows, lines, 2).
    tension: Array
    #: Largest tension around the row [N]; shape (rows, lines).
    peak: Array
    lines: tuple[str, ...]
    #: [m].
    elevation: Array
    period: float
    height: float
    wavelength: float
    #: Part shown at first [s].
    window: tuple[float, float]
    #: Row of the largest tension, of the largest rotation without lines.
    at: int
    regular: bool

    @property
    def label(self) -> str:
        """Words of the wave."""
        return str(self.run.attributes.get("wave", self.run.name))

    @property
    def shown(self) -> slice:
        """Rows within the window."""
        first, last = np.searchsorted(self.time, self.window)
        return slice(int(first), int(last) + 1)


#: Wave periods of the window shown at first
WINDOW_PERIODS = 6.0


def read_record(run: Group) -> RigidRecord | None:
    """Return a run as arrays, ``None`` where it holds no motion."""
    time = run.real("time", "time")
    motion = [run.array(mode, "time") for mode in MODES]
    elevation = run.array("surface_elevation", "time")
    if time is None or elevation is None or time.size < 8 or any(item is None for item in motion):
        return None
    pose = np.column_stack([np.asarray(item, dtype=float) for item in motion if item is not None])
    tension = run.array("tension", "time", "line", "end")
    peak = run.array("line_tension_peak_since_row", "time", "line")
    if tension is None or peak is None:
        tension, peak = np.zeros((time.size, 0, 2)), np.zeros((time.size, 0))
    period = float(run.attributes.get("period", math.nan))
    regular = bool(run.attributes.get("regular", 1))
    half = time.size // 2
    if peak.shape[1] and float(peak[half:].max()) > 0.0:
        at = half + int(np.argmax(peak[half:].max(axis=1)))
    else:
        at = half + int(np.argmax(np.abs(pose[half:, 2])))
    length = WINDOW_PERIODS * period
    if regular:
        window = (max(float(time[0]), float(time[-1]) - length), float(time[-1]))
    else:
        start = min(max(float(time[at]) - 0.5 * length, float(time[0])), max(float(time[-1]) - length, float(time[0])))
        window = (start, start + length)
    return RigidRecord(
        run,
        time,
        pose,
        np.asarray(tension, dtype=float),
        np.asarray(peak, dtype=float),
        run.labels("line") if tension.shape[1] else (),
        np.asarray(elevation, dtype=float),
        period,
        float(run.attributes.get("wave_height", math.nan)),
        float(run.attributes.get("wavelength", math.nan)),
        window,
        at,
        regular,
    )


@dataclass(frozen=True)
class CageSection:
    """The section of the moored cage at rest, in site axes [m]."""

    #: Net from the upper left corner down and around; shape (4, 2).
    outline: Array
    #: Centres; shape (n, 2).
    floats: Array
    #: Of a float.
    diameter: float
    #: Centre of gravity.
    centre: tuple[float, float]
    #: Name, anchor and attachment.
    lines: tuple[tuple[str, Array], ...]
    #: Unstretched.
    lengths: tuple[float, ...]


def section_of(level: CageLevel) -> CageSection | None:
    """Return the cage at rest, ``None`` where it is not stored."""
    cage, statics = level.part("cage"), level.part("statics")
    x, z = cage.real("outline_x", "corner"), cage.array("outline_z", "corner")
    fx, fz = cage.array("float_x", "float"), cage.array("float_z", "float")
    x = cage.array("outline_x", "corner")
    if x is None or z is None or fx is None or fz is None:
        return None
    middle = [statics.array(name, situation="moored") for name in ("rest_x", "rest_z", "rest_roll")]
    if any(item is None for item in middle):
        return None
    mx, mz, turn = (float(item) for item in middle if item is not None)
    cosine, sine = math.cos(turn), math.sin(turn)

    def placed(px: Array, pz: Array) -> Array:
        return np.column_stack([mx + cosine * px + sine * pz, mz - sine * px + cosine * pz])

    centre = placed(np.array([_plain(cage, "centre_of_gravity_x")]), np.array([_plain(cage, "centre_of_gravity_z")]))[0]
    names = statics.labels("line")
    lines, lengths = [], []
    ax, az = statics.array("anchor_x", "line"), statics.array("anchor_z", "line")
    bx, bz = statics.array("attachment_x", "line"), statics.array("attachment_z", "line")
    length = statics.array("line_length", "line")
    if ax is not None and az is not None and bx is not None and bz is not None and length is not None:
        ends = placed(np.asarray(bx, dtype=float), np.asarray(bz, dtype=float))
        for n, name in enumerate(names):
            lines.append((name, np.array([[ax[n], az[n]], ends[n]])))
            lengths.append(float(length[n]))
    return CageSection(
        placed(np.asarray(x, dtype=float), np.asarray(z, dtype=float)),
        placed(np.asarray(fx, dtype=float), np.asarray(fz, dtype=float)),
        _plain(cage, "float_diameter"),
        (float(centre[0]), float(centre[1])),
        tuple(lines),
        tuple(lengths),
    )


def _plain(group: Group, name: str) -> float:
    found = group.array(name)
    return math.nan if found is None else float(found)


def line_path(anchor: Array, end: Array, length: float, count: int = 15) -> Array:
    """Return a line from its anchor to its moving end, hanging through where it is longer than the distance.

    Parameters
    ----------
    anchor : ndarray, shape (2,)
    end : ndarray, shape (frames, 2)
    length : float
        Unstretched [m].
    count : int
        Points.

    Returns
    -------
    ndarray, shape (frames, count, 2)
    """
    share = np.linspace(0.0, 1.0, count)
    path = anchor + share[None, :, None] * (end - anchor)[:, None, :]
    span = np.linalg.norm(end - anchor, axis=1)
    spare = np.maximum(length - span, 0.0)
    # shallow parabola of that length
    sag = np.minimum(np.sqrt(0.375 * span * spare), 0.5 * length)
    path[:, :, 1] -= 4.0 * (share * (1.0 - share))[None, :] * sag[:, None]
    # what hangs lower than the anchor lies on the bed
    path[:, :, 1] = np.maximum(path[:, :, 1], min(float(anchor[1]), float(end[:, 1].min())))
    return path
