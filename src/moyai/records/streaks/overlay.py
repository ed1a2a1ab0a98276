"""The picture of a run for its report: brightened, reduced, with the streaks that were found."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.records.streaks.detection import background_level, read_picture

if TYPE_CHECKING:
    import xarray as xr


MOST_COLUMNS = 1000


def overlay_picture(files: Sequence[Path], dataset: xr.Dataset) -> dict[str, Any]:
    """Return variables of a run's dataset: the brightest of all frames in 8 bits, and the streaks on it.

    Parameters
    ----------
    files : sequence of Path
        Pictures of one recording.
    dataset : xarray.Dataset
        What :func:`moyai.records.streaks.run.analyse_recording` made of them.
    """
    whole: Array | None = None
    for file in files:
        picture = read_picture(file)
        level = background_level(picture, 64, np.zeros(picture.shape, dtype=bool))
        whole = picture - level if whole is None else np.maximum(whole, picture - level)
    assert whole is not None
    factor = max(-(-whole.shape[1] // MOST_COLUMNS), 1)
    rows, columns = whole.shape[0] // factor * factor, whole.shape[1] // factor * factor
    # The brightest pixel of a block keeps thin streaks visible
    middle, low = np.percentile(whole, [50.0, 15.87])
    whole = whole - middle - 3.0 * (middle - low)
    small = whole[:rows, :columns].reshape(rows // factor, factor, columns // factor, factor).max(axis=(1, 3))
    top = max(float(np.percentile(small, 99.5)), 1.0)
    grey = (255.0 * np.sqrt(np.clip(small / top, 0.0, 1.0))).astype(np.uint8)
    ends = dataset["streak_end"].values
    return {
        "picture": (("row", "column"), grey, {"units": "1", "long_name": "brightened picture"}),
        "streak_end": (
            ("streak", "end", "pixel"),
            (ends + 0.5) / factor - 0.5,
            {"units": "1", "long_name": "column and row of the ends of the streaks in the brightened picture"},
        ),
        "streak_particle": (
            ("streak",),
            dataset["streak_particle"].values,
            {"units": "1", "long_name": "particle of the streak, -1 where it has none"},
        ),
    }
