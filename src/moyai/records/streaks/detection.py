"""Find particle streaks in a picture: background, threshold, connected regions, ends to a fraction of a pixel."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array, IntArray
from moyai.core.errors import InputError
from moyai.records.streaks.fit import PARAMETERS, fit_streaks, gather_pixels, streak_grey


@dataclass(frozen=True)
class DetectionSettings:
    """How streaks are distinguished from noise."""

    #: A region needs a pixel so many standard deviations of the noise above the background, in the smoothed picture.
    threshold: float = 7.0
    #: The region reaches out to so many standard deviations above the background.
    edge_threshold: float = 3.5
    #: Standard deviation of that smoothing [pixels].
    smoothing: float = 1.0
    #: Shortest streak [pixels].
    least_length: float = 4.0
    #: Size of the blocks whose median is the background [pixels].
    background_block: int = 32
    #: Most streaks that one region is taken apart into.
    most_overlap: int = 3
    #: Share of a region's light that the fitted streaks may miss.
    unexplained: float = 0.16

    def __post_init__(self) -> None:
        if not 0.0 < self.edge_threshold <= self.threshold:
            raise InputError(
                "the threshold of the edge must be positive and no larger than the threshold",
                parameter="edge_threshold",
            )


@dataclass(frozen=True, eq=False)
class Streaks:
    """Streaks of one picture; which end came first is not known yet."""

    #: Column and row of both ends [pixels]; shape (streaks, 2, 2).
    ends: Array
    #: Height of the arc over the chord, to the right of going from the first to the second end with rows downwards
    #: [pixels]; shape (streaks,).
    bow: Array
    #: Sum of grey levels of the streak; shape (streaks,).
    light: Array
    #: Standard deviation of the profile across [pixels]; shape (streaks,).
    blur: Array
    #: Whether it shares its region with others; shape (streaks,).
    overlapping: NDArray[np.bool_]
    #: Standard deviation of the picture's noise [grey levels].
    noise: float
    #: Median grey level.
    background: float
    #: Regions that could not be explained by streaks.
    rejected: int
    #: Rows and columns of the picture.
    shape: tuple[int, int]

    @property
    def count(self) -> int:
        """Number of streaks."""
        return len(self.light)

    @property
    def length(self) -> Array:
        """Distance between the ends [pixels]."""
        return np.asarray(np.hypot(*(self.ends[:, 1] - self.ends[:, 0]).T))


def read_picture(path: Any) -> Array:
    """Read a picture as grey levels.

    Parameters
    ----------
    path : path-like
        PNG, TIFF, BMP, JPEG ...; colours are averaged.

    Raises
    ------
    InputError
        When the file is absent, is no picture, or the packages to read pictures are not installed.
    """
    from pathlib import Path

    file = Path(path)
    if not file.is_file():
        raise InputError(f"no such picture: {file}", parameter="file")
    try:
        import imageio.v3 as imageio
    except ImportError:
        raise InputError(
            "reading pictures needs imageio and scikit-image", remedy="install them: pip install 'moyai[image]'"
        ) from None
    try:
        grey = np.asarray(imageio.imread(file))
    except Exception as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise InputError(f"{file} cannot be read as a picture: {reason[:120]}", parameter="file") from None
    if grey.ndim == 3 and grey.shape[2] in (2, 4):
        grey = grey[..., :-1]
    if grey.ndim == 3:
        grey = grey.mean(axis=2)
    if grey.ndim != 2 or min(grey.shape) < 32:
        raise InputError(
            f"{file} is no single picture of at least 32 by 32 pixels (its shape is {grey.shape})", parameter="file"
        )
    return grey.astype(float)


def detect_streaks(
    picture: ArrayLike,
    *,
    settings: DetectionSettings | None = None,
    mask: NDArray[np.bool_] | None = None,
    saturation: float = math.inf,
) -> Streaks:
    """Find the streaks of a picture.

    Parameters
    ----------
    picture : array_like, shape (rows, columns)
        Grey levels.
    settings : DetectionSettings, optional
    mask : ndarray of bool, optional
        True where nothing is looked for: the model and its reflections.
    saturation : float
        Grey level from which a pixel is clipped; such pixels do not take part in fits.

    Returns
    -------
    Streaks
    """
    chosen = settings if settings is not None else DetectionSettings()
    grey = np.asarray(picture, dtype=float)
    if grey.ndim != 2:
        raise InputError(f"a picture has two dimensions, not {grey.ndim}", parameter="picture")
    from scipy.ndimage import gaussian_filter

    hidden = np.zeros(grey.shape, dtype=bool) if mask is None else mask
    level = background_level(grey, chosen.background_block, hidden)
    rest = grey - level
    rest[hidden] = 0.0
    noise = _noise(rest[~hidden])
    smooth = gaussian_filter(rest, chosen.smoothing)
    smooth_noise = _noise(smooth[~hidden])
    labels, boxes = _regions(smooth, hidden, chosen, smooth_noise)
    found: list[Array] = []
    shared: list[bool] = []
    rejected = 0
    for number, box in enumerate(boxes, start=1):
        pieces = _fit_region(rest, grey, labels, number, box, chosen, noise, saturation)
        if pieces is None:
            rejected += 1
            continue
        for piece in pieces:
            found.append(piece)
            shared.append(len(pieces) > 1)
    table = np.array(found).reshape(-1, PARAMETERS)
    blur = np.exp(table[:, 6])
    length = np.hypot(table[:, 2] - table[:, 0], table[:, 3] - table[:, 1])
    keep = length >= chosen.least_length
    rejected += int((~keep).sum())
    light = table[:, 5] * length * math.sqrt(2.0 * math.pi) * blur
    return Streaks(
        table[keep, :4].reshape(-1, 2, 2),
        table[keep, 4],
        light[keep],
        blur[keep],
        np.array(shared, dtype=bool)[keep],
        noise,
        float(np.median(level)),
        rejected,
        (grey.shape[0], grey.shape[1]),
    )


def background_level(grey: Array, block: int, hidden: NDArray[np.bool_]) -> Array:
    """Return the slowly varying background: medians of blocks, joined smoothly, model left out."""
    from scipy.ndimage import gaussian_filter, map_coordinates

    rows, columns = grey.shape
    down, right = max(rows // block, 1), max(columns // block, 1)
    row_edges = np.linspace(0, rows, down + 1).astype(int)
    column_edges = np.linspace(0, columns, right + 1).astype(int)
    medians = np.full((down, right), np.nan)
    for i in range(down):
        for j in range(right):
            piece = slice(row_edges[i], row_edges[i + 1]), slice(column_edges[j], column_edges[j + 1])
            seen = grey[piece][~hidden[piece]]
            if seen.size > 0.2 * hidden[piece].size:
                # Streaks only ever add light: the mean below the median gives the level between whole grey levels
                middle = np.median(seen)
                medians[i, j] = seen[
                    np.abs(seen - middle) <= 3.0 * max(1.4826 * np.median(np.abs(seen - middle)), 1.0)
                ].mean()
    if np.isnan(medians).all():
        medians[:] = float(np.median(grey))
    weight = np.isfinite(medians).astype(float)
    filled = gaussian_filter(np.nan_to_num(medians), 1.0) / np.maximum(gaussian_filter(weight, 1.0), 1e-9)
    filled = np.where(weight > 0.0, np.nan_to_num(medians), filled)
    # A row and column more on every side, by the slope of the last two, reach to the edges of the picture
    for axis, size in ((0, down), (1, right)):
        width = [(1, 1) if side == axis else (0, 0) for side in (0, 1)]
        if size > 1:
            filled = np.pad(filled, width, mode="reflect", reflect_type="odd")
        else:
            filled = np.pad(filled, width, mode="edge")
    i = (np.arange(rows) + 0.5) * down / rows + 0.5
    j = (np.arange(columns) + 0.5) * right / columns + 0.5
    return np.asarray(map_coordinates(filled, np.meshgrid(i, j, indexing="ij"), order=1, mode="nearest"))


def _noise(values: Array) -> float:
    if values.size == 0:
        return 0.5
    # Streaks brighten few pixels: the lower half of the distribution is noise alone
    low, middle = np.percentile(values, [15.87, 50.0])
    return max(float(middle - low), 0.05)


def _regions(
    smooth: Array, hidden: NDArray[np.bool_], chosen: DetectionSettings, noise: float
) -> tuple[IntArray, list[tuple[slice, slice]]]:
    """Return labelled regions that hold a bright pixel, and their boxes; regions at the mask or edge are left out."""
    try:
        from skimage.filters import apply_hysteresis_threshold
        from skimage.measure import label, regionprops
    except ImportError:
        raise InputError(
            "finding streaks needs scikit-image", remedy="install it: pip install 'moyai[image]'"
        ) from None
    bright = apply_hysteresis_threshold(smooth, chosen.edge_threshold * noise, chosen.threshold * noise) & ~hidden
    labels = label(bright, connectivity=2)
    keep = [region for region in regionprops(labels) if region.area >= 2.0 * chosen.least_length]
    table = np.zeros(labels.max() + 1, dtype=np.int64)
    boxes = []
    rows, columns = smooth.shape
    for region in keep:
        top, left, bottom, right = region.bbox
        if top == 0 or left == 0 or bottom == rows or right == columns:
            # Cut off by the edge of the picture: one end is unknown
            continue
        boxes.append((slice(top, bottom), slice(left, right)))
        table[region.label] = len(boxes)
    return table[labels], boxes


def _fit_region(
    rest: Array,
    grey: Array,
    labels: IntArray,
    number: int,
    box: tuple[slice, slice],
    chosen: DetectionSettings,
    noise: float,
    saturation: float,
) -> list[Array] | None:
    """Return the streaks of one region, taken apart into as few as explain its light, or ``None``."""
    from scipy.ndimage import binary_dilation

    rows, columns = rest.shape
    margin = 4
    patch = (
        slice(max(box[0].start - margin, 0), min(box[0].stop + margin, rows)),
        slice(max(box[1].start - margin, 0), min(box[1].stop + margin, columns)),
    )
    own = labels[patch] == number
    others = (labels[patch] > 0) & ~own
    near = binary_dilation(own, iterations=3)
    used = near & (grey[patch] < saturation)
    if others.any():
        used &= ~binary_dilation(others, iterations=2)
    if used.sum() < 3 * PARAMETERS:
        return None
    row, column = np.nonzero(used)
    values = rest[patch][used]
    own_row, own_column = np.nonzero(own)
    weight = np.maximum(rest[patch][own], 0.0)
    place = np.column_stack([own_column, own_row]).astype(float)
    total = float(np.abs(values).sum())
    floor = noise * math.sqrt(2.0 / math.pi) * used.sum()
    offset = np.array([patch[1].start, patch[0].start], dtype=float)
    best: tuple[float, Array] | None = None
    for count in range(1, chosen.most_overlap + 1):
        if count > 1 and len(place) < count * 3 * chosen.least_length:
            break
        start = _first_guess(place, weight, count)
        if start is None:
            break
        solved, _ = fit_streaks(column.astype(float), row.astype(float), values, start, 60)
        if not np.isfinite(solved).all():
            continue
        misfit = np.zeros(used.shape)
        misfit[used] = values - streak_grey(column.astype(float), row.astype(float), solved)
        share = _unexplained(misfit, used) * used.sum() / max(total - floor, noise * used.sum())
        if best is None or share < 0.7 * best[0]:
            best = (share, solved)
        if share < chosen.unexplained:
            break
    if best is None or best[0] > chosen.unexplained:
        return None
    streaks = best[1][:-1].reshape(-1, PARAMETERS).copy()
    # A faint partner of a bright streak may run away from its region in the fit
    limit = np.array([own.shape[1], own.shape[0]] * 2) - 1.0 + margin
    if np.any(streaks[:, :4] < -margin) or np.any(streaks[:, :4] > limit):
        return None
    streaks[:, :2] += offset
    streaks[:, 2:4] += offset
    return list(streaks)


def _unexplained(misfit: Array, used: NDArray[np.bool_]) -> float:
    """Return the root mean square of what neighbouring pixels miss together: noise, shot noise too, drops out."""
    total, count = 0.0, 0
    for first, second in (((slice(1, None), slice(None)), (slice(None, -1), slice(None))),
                          ((slice(None), slice(1, None)), (slice(None), slice(None, -1)))):  # fmt: skip
        both = used[first] & used[second]
        total += float((misfit[first] * misfit[second])[both].sum())
        count += int(both.sum())
    return math.sqrt(max(total / max(count, 1), 0.0))


def _first_guess(place: Array, weight: Array, count: int) -> Array | None:
    """Return first parameters of ``count`` streaks: pixels gathered around as many lines."""
    groups = np.zeros(len(place), dtype=np.int64) if count == 1 else _gather(place, weight, count)
    parts = []
    for k in range(count):
        chosen = groups == k
        if chosen.sum() < 6:
            return None
        points, light = place[chosen], weight[chosen] + 1e-9
        centre, axis = _principal(points, light)
        along = (points - centre) @ axis
        across = (points - centre) @ np.array([-axis[1], axis[0]])
        low, high = np.percentile(along, [3.0, 97.0])
        middle = 0.5 * (low + high)
        arm = 0.5 * (high - low) + 1e-6
        # Curvature of the ridge, by a weighted parabola
        bow = -float(np.polyfit((along - middle) / arm, across, 2, w=np.sqrt(light))[0])
        spread = max(math.sqrt(float(np.average(across**2, weights=light))), 0.6)
        first, last = centre + axis * (low + 1.0), centre + axis * (high - 1.0)
        height = float(np.percentile(light, 85.0))
        parts.append([*first, *last, float(np.clip(bow, -0.2 * arm, 0.2 * arm)), height, math.log(min(spread, 2.5))])
    return np.array([value for part in parts for value in part] + [0.0])


def _principal(points: Array, light: Array) -> tuple[Array, Array]:
    centre = np.average(points, axis=0, weights=light)
    moments = np.cov((points - centre).T, aweights=light)
    return centre, np.linalg.eigh(moments)[1][:, 1]


def _gather(place: Array, weight: Array, count: int) -> IntArray:
    """Return for every pixel which of ``count`` line segments it belongs to."""
    random = np.random.default_rng(len(place))
    light = weight + 1e-9
    share = np.cumsum(light) / light.sum()
    starts = np.searchsorted(share, random.random((12, count, 2))).clip(0, len(place) - 1)
    return np.asarray(gather_pixels(place, light, starts, 8))
