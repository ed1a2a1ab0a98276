"""One run from pictures to drift velocities: detection, calibration, linking, drift; kept on disk as it goes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.progress import Progress, silent
from moyai.core.store import DatasetStore, key_of
from moyai.records.streaks.camera_calibration import CameraCalibration
from moyai.records.streaks.detection import DetectionSettings, Streaks, detect_streaks, read_picture
from moyai.records.streaks.drift_velocity import ParticleDrift, close_period_cubic, fit_drift_harmonics
from moyai.records.streaks.linking import LinkedChain, LinkingSettings, WorldStreaks, link_exposure, link_frames
from moyai.records.streaks.timing import PulseTrain

if TYPE_CHECKING:
    import xarray as xr

Closing = Literal["harmonics", "cubic"]

_VERSION = 2


@dataclass(frozen=True, eq=False)
class Recording:
    """Pictures taken in one go."""

    #: One per pulse in the order of time, or a single one that holds all pulses.
    pictures: tuple[Path, ...]
    train: PulseTrain
    #: Whether every pulse has its own picture.
    frames: bool
    #: Wave period [s].
    period: float

    def __post_init__(self) -> None:
        expected = self.train.count if self.frames else 1
        if len(self.pictures) != expected:
            raise InputError(f"a recording of {expected} picture(s) has {len(self.pictures)}", parameter="pictures")


@dataclass(frozen=True, eq=False)
class DriftCloud:
    """Drift velocities of one recording or of several."""

    #: Mean positions [m]; shape (particles, 2).
    position: Array
    #: Drift velocities [m/s]; shape (particles, 2).
    velocity: Array
    #: Standard error of a component of the velocity [m/s]; shape (particles,).
    deviation: Array
    #: Misfit of the ends [m]; shape (particles,).
    residual: Array
    #: Streaks found.
    streaks: int = 0
    #: Chains linked.
    chains: int = 0
    #: Chains too short or too rough for a drift.
    refused: int = 0
    #: Chains without direction.
    undecided: int = 0
    #: Regions that are no streaks.
    rejected: int = 0

    @property
    def count(self) -> int:
        """Number of particles."""
        return len(self.position)


@checks_words
@dataclass(frozen=True)
class RunSettings:
    """Settings of the way from pictures to drift."""

    detection: DetectionSettings = field(default_factory=DetectionSettings)
    linking: LinkingSettings = field(default_factory=LinkingSettings)
    #: How the period is closed; one of "harmonics", "cubic".
    closing: Closing = "harmonics"
    #: Shortest chain, in periods.
    least_span: float = 0.95
    #: Roughest chain: root mean square misfit of its ends [m].
    most_residual: float = 8e-4


def read_pictures(files: Sequence[Path]) -> list[Array]:
    """Read the pictures of a recording; all must be of one size.

    Raises
    ------
    InputError
        When one is absent, is no picture, or is of another size.
    """
    pictures = [read_picture(file) for file in files]
    for file, picture in zip(files, pictures):
        if picture.shape != pictures[0].shape:
            one, other = pictures[0].shape, picture.shape
            raise InputError(
                f"{file.name} has {other[1]} by {other[0]} pixels and {files[0].name} {one[1]} by {one[0]}: "
                "pictures of one recording share one size",
                parameter="pictures",
            )
    return pictures


def saturation_level(picture: Array) -> float:
    """Return the grey level from which a pixel counts as clipped (of 8 or 16 bits)."""
    top = float(picture.max())
    return 254.5 if top <= 255.0 else (65534.5 if top <= 65535.0 else math.inf)


def streaks_in_world(streaks: Streaks, calibration: CameraCalibration) -> WorldStreaks:
    """Take the ends and the tangents of streaks to the light sheet."""
    pixels = streaks.ends
    chord = pixels[:, 1] - pixels[:, 0]
    length = np.hypot(*chord.T)[:, None]
    along = chord / length
    aside = np.column_stack([-along[:, 1], along[:, 0]])
    slope = 4.0 * streaks.bow[:, None] / length
    # The arc leaves its chord by the slope of a parabola and comes back by the same
    tangents = np.stack([along + slope * aside, along - slope * aside], axis=1)
    ends = calibration.to_world(pixels.reshape(-1, 2)).reshape(-1, 2, 2)
    ahead = calibration.to_world((pixels + 0.25 * length[:, :, None] * tangents).reshape(-1, 2)).reshape(-1, 2, 2)
    way = ahead - ends
    return WorldStreaks(ends, way / np.linalg.norm(way, axis=2, keepdims=True), np.log(np.maximum(streaks.light, 1e-9)))


def drift_of_chains(
    chains: Sequence[LinkedChain], period: float, settings: RunSettings
) -> tuple[list[ParticleDrift], list[int]]:
    """Return the drift of every chain that is long and smooth enough, and which chains these are."""
    drifts, kept = [], []
    for index, linked in enumerate(chains):
        if linked.chain.span < settings.least_span * period:
            continue
        try:
            fit = fit_drift_harmonics(linked.chain, period)
            if fit.residual > settings.most_residual:
                continue
            if settings.closing == "cubic":
                cubic = close_period_cubic(linked.chain, period)
                fit = ParticleDrift(cubic.position, cubic.velocity, cubic.closure, fit.deviation, fit.residual)
        except InputError:
            continue
        drifts.append(fit)
        kept.append(index)
    return drifts, kept


def analyse_recording(
    recording: Recording,
    calibration: CameraCalibration,
    settings: RunSettings,
    *,
    mask_outline: Array | None = None,
    mask_margin: float = 0.0,
    store: DatasetStore | None = None,
    progress: Progress = silent,
) -> xr.Dataset:
    """Turn one recording into drift velocities.

    Parameters
    ----------
    recording : Recording
    calibration : Calibration
    settings : RunSettings
    mask_outline : ndarray, optional
        Outline of the model in the light sheet [m], where nothing is looked for.
    mask_margin : float
        Margin around it [m].
    store : DatasetStore, optional
        Keeps the outcome, so that an interrupted batch continues where it stopped.
    progress : Progress

    Returns
    -------
    xarray.Dataset
        ``position``, ``drift_velocity``, ``deviation``, ``residual`` per particle; ``streak_end``, ``streak_picture``
        (pixels) and ``streak_particle`` per streak; counts as attributes.

    Raises
    ------
    InputError
        Pictures that are absent, of different size, or without streaks.
    """
    key = _key(recording, calibration, settings, mask_outline, mask_margin)
    known = store.get(key) if store is not None else None
    if known is not None:
        return known
    grey = read_pictures(recording.pictures)
    mask = _mask(grey[0].shape, calibration, mask_outline, mask_margin)
    found: list[Streaks] = []
    for index, picture in enumerate(grey):
        progress("pictures", index, len(grey))
        found.append(
            detect_streaks(picture, settings=settings.detection, mask=mask, saturation=saturation_level(picture))
        )
    progress("pictures", len(grey), len(grey))
    _require_streaks(recording, found, settings.detection)
    world = [streaks_in_world(item, calibration) for item in found]
    undecided = 0
    if recording.frames:
        chains = link_frames(world, recording.train, settings.linking)
    else:
        chains, undecided = link_exposure(world[0], recording.train, settings.linking)
    dataset = _dataset(found, chains, recording.period, settings)
    dataset.attrs.update(undecided=undecided, rejected=sum(item.rejected for item in found))
    if store is not None:
        store.put(key, dataset)
    return dataset


def _require_streaks(recording: Recording, found: list[Streaks], settings: DetectionSettings) -> None:
    counts = [item.count for item in found]
    if sum(counts) >= 4 and (not recording.frames or np.median(counts) >= 1):
        return
    worst = int(np.argmin(counts))
    raise InputError(
        f"{recording.pictures[worst].name}: {counts[worst]} streaks exceed the noise of "
        f"{found[worst].noise:.2g} grey levels",
        parameter="pictures",
        allowed=f"pictures with streaks brighter than {settings.threshold:g} times the noise",
        remedy="check that the light was on and the file is the right one, or lower detection.threshold",
    )


def _mask(
    shape: tuple[int, ...], calibration: CameraCalibration, outline: Array | None, margin: float
) -> NDArray[np.bool_] | None:
    if outline is None:
        return None
    from skimage.draw import polygon

    centre = outline[:-1].mean(axis=0)
    offset = outline - centre
    # Every point moves outwards by the margin along both axes: a corner keeps its angle
    grown = centre + offset + margin * np.sign(offset) * np.minimum(1.0, np.abs(offset) / (0.2 * np.abs(offset).max()))
    pixels = calibration.to_pixels(grown)
    row, column = polygon(pixels[:, 1], pixels[:, 0], shape)
    mask = np.zeros(shape, dtype=bool)
    mask[row, column] = True
    return mask


def _key(
    recording: Recording,
    calibration: CameraCalibration,
    settings: RunSettings,
    outline: Array | None,
    margin: float,
) -> str:
    import hashlib

    contents = []
    for file in recording.pictures:
        try:
            contents.append(hashlib.sha256(file.read_bytes()).hexdigest())
        except OSError:
            raise InputError(f"no such picture: {file}", parameter="pictures") from None
    probe = calibration.to_world([[0.0, 0.0], [500.0, 0.0], [0.0, 500.0], [500.0, 500.0], [900.0, 300.0]])
    train = recording.train
    return key_of(
        "streaks",
        _VERSION,
        contents,
        probe,
        train.start,
        train.duration,
        train.power,
        recording.frames,
        recording.period,
        sorted(asdict(settings).items(), key=str),
        outline if outline is not None else "none",
        margin,
    )


def _dataset(found: list[Streaks], chains: list[LinkedChain], period: float, settings: RunSettings) -> xr.Dataset:
    import xarray as xr

    drifts, kept = drift_of_chains(chains, period, settings)
    first = np.concatenate([[0], np.cumsum([item.count for item in found])])
    owner = np.full(int(first[-1]), -1, dtype=np.int64)
    for number, index in enumerate(kept):
        chain = chains[index]
        owner[first[chain.picture] + chain.streak] = number
    ends = np.concatenate([item.ends for item in found]) if found else np.zeros((0, 2, 2))
    picture = np.repeat(np.arange(len(found)), [item.count for item in found])

    def variable(dims: tuple[str, ...], values: Any, units: str, name: str) -> tuple[Any, ...]:
        return dims, values, {"units": units, "long_name": name}

    count = len(drifts)
    return xr.Dataset(
        {
            "position": variable(
                ("particle", "axis"),
                np.array([item.position for item in drifts]).reshape(count, 2),
                "m",
                "mean position of the particle",
            ),
            "drift_velocity": variable(
                ("particle", "axis"),
                np.array([item.velocity for item in drifts]).reshape(count, 2),
                "m/s",
                "displacement in one period over the period",
            ),
            "deviation": variable(
                ("particle",),
                np.array([item.deviation for item in drifts]),
                "m/s",
                "standard error of a component of the drift velocity",
            ),
            "residual": variable(
                ("particle",), np.array([item.residual for item in drifts]), "m", "misfit of the ends of the streaks"
            ),
            "streak_end": variable(("streak", "end", "pixel"), ends, "1", "column and row of the ends of the streaks"),
            "streak_picture": variable(("streak",), picture, "1", "picture that the streak is in"),
            "streak_particle": variable(("streak",), owner, "1", "particle of the streak, -1 where it has none"),
        },
        coords={"axis": ["x", "z"]},
        attrs={
            "streaks": int(first[-1]),
            "chains": len(chains),
            "refused": len(chains) - count,
        },
    )


def gather(datasets: Sequence[xr.Dataset]) -> DriftCloud:
    """Put the particles of several recordings together."""
    sums = {
        name: int(sum(int(item.attrs.get(name, 0)) for item in datasets))
        for name in ("streaks", "chains", "refused", "undecided", "rejected")
    }
    return DriftCloud(
        np.concatenate([item["position"].values for item in datasets]),
        np.concatenate([item["drift_velocity"].values for item in datasets]),
        np.concatenate([item["deviation"].values for item in datasets]),
        np.concatenate([item["residual"].values for item in datasets]),
        **sums,
    )


@dataclass(frozen=True, eq=False)
class BackgroundDrift:
    """Drift without a model: settling and mass transport as a linear function of the level."""

    #: Drift x, z at z = 0 [m/s]; shape (2,).
    mean: Array
    #: Growth of the drift with z [1/s]; shape (2,).
    gradient: Array
    #: Particles that it was measured from; 0 when it was given.
    particles: int = 0

    def at(self, position: Array) -> Array:
        """Return the drift at positions [m/s]."""
        return np.asarray(self.mean + np.asarray(position)[:, 1:] * self.gradient)


def fit_background(cloud: DriftCloud) -> BackgroundDrift:
    """Fit the drift of a run without model, robustly.

    Raises
    ------
    InputError
        When it has fewer than six particles.
    """
    if cloud.count < 6:
        raise InputError(
            f"the run without model gives {cloud.count} drift velocities", parameter="no_model", allowed="at least 6"
        )
    basis = np.column_stack([np.ones(cloud.count), cloud.position[:, 1]])
    weight = np.ones(cloud.count)
    solution = np.zeros((2, 2))
    for _ in range(10):
        root = np.sqrt(weight)[:, None]
        solution = np.linalg.lstsq(basis * root, cloud.velocity * root, rcond=None)[0]
        size = np.hypot(*(cloud.velocity - basis @ solution).T)
        weight = np.minimum(1.0, 1.3 * float(np.median(size)) / np.maximum(size, 1e-300))
    return BackgroundDrift(solution[0], solution[1], cloud.count)
