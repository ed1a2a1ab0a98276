"""Synthetic pictures of particle streaks: paths in a known flow, seen by a camera with the faults of a real one."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.records.streaks.camera_calibration import CameraCalibration
from moyai.records.streaks.flow import OrbitalFlow, track_particles
from moyai.records.streaks.timing import PulseTrain

Picture = NDArray[np.uint8] | NDArray[np.uint16]


@dataclass(frozen=True)
class Optics:
    """Tracer, light sheet and camera."""

    #: Particles within the light sheet per area of the plane [1/m2].
    density: float = 3000.0
    #: Range of diameters of the particles [m].
    diameter: tuple[float, float] = (0.3e-3, 0.5e-3)
    #: Grey levels per pixel of a typical streak of full power, above the background.
    brightness: float = 90.0
    #: Standard deviation of the logarithm of the particles' brightness.
    brightness_scatter: float = 0.3
    #: Distance from the middle of the sheet at which the light has fallen to 1/e^2 [m].
    sheet_thickness: float = 2.0e-3
    #: Standard deviation of the particles' speed across the sheet [m/s].
    out_of_plane_speed: float = 0.4e-3
    #: Relative fall of the light from the middle of the picture to its corners and along the sheet.
    unevenness: float = 0.4
    #: Standard deviation of the point spread [pixels].
    blur: float = 0.8
    #: Mean grey level without particles.
    background: float = 14.0
    #: Standard deviation of the sensor's noise [grey levels].
    read_noise: float = 1.5
    #: Photo-electrons per grey level: shot noise.
    photons_per_level: float = 6.0
    #: 8 or 16.
    bits: int = 8

    def __post_init__(self) -> None:
        if self.bits not in (8, 16):
            raise InputError(f"pictures of {self.bits} bits", parameter="bits", allowed="8 or 16")
        if not self.density > 0.0:
            raise InputError("the density of particles is not positive", parameter="density")


@dataclass(frozen=True, eq=False)
class Exposure:
    """Pictures and the truth behind them."""

    #: One per frame.
    pictures: tuple[Picture, ...]
    #: Position x, z at the start and end of every pulse [m]; shape (particles, pulses, 2, 2).
    position: Array = field(repr=False)
    #: Relative brightness of every streak (1: middle of the sheet, full power); shape (particles, pulses).
    lit: Array = field(repr=False)


def synthesise(
    flow: OrbitalFlow,
    calibration: CameraCalibration,
    shape: tuple[int, int],
    train: PulseTrain,
    *,
    optics: Optics,
    seed: int,
    frames: bool,
    phase: float = 0.0,
) -> Exposure:
    """Render pictures of streaks.

    Parameters
    ----------
    flow : OrbitalFlow
    calibration : Calibration
        The camera.
    shape : tuple of int
        Rows and columns.
    train : PulseTrain
    optics : Optics
    seed : int
    frames : bool
        One picture a pulse, or one picture of all pulses.
    phase : float
        Phase of the wave when the first pulse starts [rad].

    Returns
    -------
    Exposure
    """
    random = np.random.default_rng(seed)
    rows, columns = shape
    corners = calibration.to_world([[0, 0], [columns - 1, 0], [0, rows - 1], [columns - 1, rows - 1]])
    low, high = corners.min(axis=0) - 0.01, corners.max(axis=0) + 0.01
    start = random.uniform(low, high, (int(optics.density * np.prod(high - low)), 2))
    if flow.section is not None:
        start = start[~flow.section.contains(start[:, 0] + 1j * start[:, 1], 2e-4)]
    begin = phase / flow.angular_frequency
    pixel = 1.0 / float(
        np.linalg.norm(calibration.to_pixels([[0.01, 0.0]]) - calibration.to_pixels([[0.0, 0.0]])) / 0.01
    )
    fastest = 3.0 * max(flow.amplitude_x, flow.amplitude_z)
    samples = [max(math.ceil(fastest * item / (0.4 * pixel)), 4) for item in train.duration]
    instants = np.concatenate([np.linspace(a, b, n) for a, b, n in zip(train.start, train.end, samples)]) + begin
    path = track_particles(flow, start, instants)
    count = len(start)
    depth = random.uniform(-1.2, 1.2, count) * optics.sheet_thickness
    wander = random.normal(0.0, optics.out_of_plane_speed, count)
    strength = np.exp(random.normal(0.0, optics.brightness_scatter, count))
    size = random.uniform(*optics.diameter, count) / pixel
    across = depth[:, None] + wander[:, None] * (instants - instants[0])
    light = strength[:, None] * np.exp(-2.0 * (across / optics.sheet_thickness) ** 2)
    limits = np.concatenate([[0], np.cumsum(samples)])
    groups = [[k] for k in range(train.count)] if frames else [list(range(train.count))]
    sheet = _light_sheet(shape, optics.unevenness)
    pictures = []
    for group in groups:
        canvas = np.zeros(shape)
        for k in group:
            piece = slice(limits[k], limits[k + 1])
            speed = _speed(path[:, piece], instants[piece])
            # Light per length falls as a particle moves faster; the reference speed gives ``brightness``
            reference = 0.5 * (flow.amplitude_x + flow.amplitude_z)
            weight = light[:, piece] * train.power[k] * train.duration[k] / samples[k] * reference / pixel
            _deposit(canvas, calibration, path[:, piece], weight * optics.brightness, size, optics.blur, speed)
        pictures.append(_sensor(canvas * sheet, optics, sheet, flow, calibration, random))
    ends = np.stack([path[:, limits[:-1]], path[:, limits[1:] - 1]], axis=2)
    lit = np.stack([light[:, limits[k] : limits[k + 1]].mean(axis=1) * train.power[k] for k in range(train.count)], 1)
    return Exposure(tuple(pictures), ends, lit)


def _speed(path: Array, instants: Array) -> Array:
    return np.asarray(np.hypot(*(path[:, -1] - path[:, 0]).T) / (instants[-1] - instants[0]))


def _deposit(
    canvas: Array,
    calibration: CameraCalibration,
    path: Array,
    weight: Array,
    size: Array,
    blur: float,
    speed: Array,
) -> None:
    """Add the light of particles, size by size: points spread over four pixels, then a Gaussian for disc and lens."""
    from scipy.ndimage import gaussian_filter

    known = np.isfinite(speed)
    # A disc of diameter d has the variance d^2/16 along each axis
    spread = np.sqrt(blur**2 + (size / 4.0) ** 2)
    edges = np.quantile(spread, [0.0, 0.25, 0.5, 0.75, 1.0])
    rows, columns = canvas.shape
    for low, high in pairwise(edges):
        chosen = known & (spread >= low) & ((spread < high) if high < edges[-1] else (spread <= high))
        if not chosen.any():
            continue
        pixels = calibration.to_pixels(path[chosen].reshape(-1, 2))
        amount = weight[chosen].ravel()
        layer = np.zeros(canvas.shape)
        corner = np.floor(pixels).astype(int)
        part = pixels - corner
        for right in (0, 1):
            for down in (0, 1):
                column, row = corner[:, 0] + right, corner[:, 1] + down
                share = np.abs(1 - right - part[:, 0]) * np.abs(1 - down - part[:, 1]) * amount
                seen = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
                layer += np.bincount(
                    row[seen] * columns + column[seen], weights=share[seen], minlength=rows * columns
                ).reshape(rows, columns)
        sigma = float(spread[chosen].mean())
        # Normalised so that a typical streak peaks at the brightness asked for
        canvas += gaussian_filter(layer, sigma, truncate=4.0) * math.sqrt(2.0 * math.pi) * sigma


def _light_sheet(shape: tuple[int, int], unevenness: float) -> Array:
    rows, columns = shape
    row, column = np.mgrid[0:rows, 0:columns]
    x, z = 2.0 * column / columns - 1.0, 2.0 * row / rows - 1.0
    stripes = 0.06 * np.sin(23.0 * x + 0.4 * z) + 0.04 * np.sin(61.0 * x)
    return np.asarray(1.0 - unevenness * (0.45 * x**2 + 0.3 * z**2 + 0.25 * (0.5 + 0.5 * x)) + unevenness * stripes)


def _sensor(
    light: Array,
    optics: Optics,
    sheet: Array,
    flow: OrbitalFlow,
    calibration: CameraCalibration,
    random: np.random.Generator,
) -> Picture:
    from scipy.ndimage import gaussian_filter

    grey = light + optics.background * sheet
    if flow.section is not None:
        from skimage.draw import polygon

        outline = calibration.to_pixels(flow.section.outline)
        row, column = polygon(outline[:, 1], outline[:, 0], light.shape)
        body = np.zeros(light.shape)
        body[row, column] = 1.0
        edge = gaussian_filter(body, 1.0)
        # A matt model is darker than the water's glow, with a bright rim where the sheet strikes it
        rim = gaussian_filter(np.abs(np.gradient(edge)[0]) + np.abs(np.gradient(edge)[1]), 0.8)
        grey = grey * (1.0 - 0.6 * edge) + 2.5 * optics.background * rim
    factor = 1.0 if optics.bits == 8 else 256.0
    noisy = random.poisson(np.maximum(grey, 0.0) * optics.photons_per_level) / optics.photons_per_level
    noisy = noisy + random.normal(0.0, optics.read_noise, grey.shape)
    top = 255 if optics.bits == 8 else 65535
    rounded = np.clip(np.rint(noisy * factor), 0, top)
    return rounded.astype(np.uint8) if optics.bits == 8 else rounded.astype(np.uint16)
