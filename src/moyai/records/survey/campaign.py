"""A synthetic field campaign with known laws: waves, tide and tensions of two curtain types, to test a whole chain on.

Every constant is planted and stands in :class:`CampaignLaws`; a processing that is right finds them again. The shape
is that of the field observation of Tabata et al.: three campaigns, a typhoon, tidal current, two anchors a type.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.files import partial_file, write_whole
from moyai.core.progress import Progress, silent
from moyai.sea.dispersion import wave_number
from moyai.sea.spectra import jonswap
from moyai.sea.water import Water
from moyai.series.detrend import Detrend
from moyai.series.zero_crossing import WaveOptions, find_waves

CHANNELS = ("elevation", "u", "v", "J-0", "J-1", "J-2", "F-1", "F-2")
"""Channels of the records: elevation [m], velocities [m/s], tensions of wire, new and conventional anchors [N]."""


@dataclass(frozen=True)
class Storm:
    """One campaign."""

    name: str
    #: [s since 1970 UTC].
    start: float
    days: float
    #: Highest H1/3 [m].
    peak_height: float
    #: When H1/3 is highest [d after the start].
    peak_day: float
    #: H1/3 far from the peak [m].
    calm_height: float
    #: Standard deviation of the storm in time [d].
    duration: float
    #: First angle of the waves from the normal of the curtain [rad].
    angle_start: float
    #: Last angle of the waves from that normal [rad].
    angle_end: float


def _storms() -> tuple[Storm, ...]:
    degree = math.pi / 180.0
    return (
        Storm("typhoon", 938_044_800.0, 6.0, 3.06, 1.17, 0.35, 0.45, 70 * degree, 25 * degree),
        Storm("January", 949_071_600.0, 5.0, 1.11, 1.88, 0.30, 0.70, 55 * degree, 5 * degree),
        Storm("February", 949_676_400.0, 6.0, 2.32, 3.08, 0.30, 0.60, 0 * degree, 35 * degree),
    )


@dataclass(frozen=True)
class CampaignLaws:
    """What is planted."""

    storms: tuple[Storm, ...] = field(default_factory=_storms)
    water: Water = field(default_factory=lambda: Water(depth=20.0, density=1025.0, gravity=9.81))
    #: Length of a block over which the sea is stationary [s].
    block: float = 1200.0
    #: Sampling rate [Hz].
    rate: float = 10.0
    #: T1/3 = factor sqrt(H1/3) [s/m^0.5].
    period_factor: float = 3.86
    #: Of the spectrum [-].
    peak_enhancement: float = 2.0
    #: Half the angle between the two long-crested halves of the sea [rad].
    half_spread: float = math.radians(12.0)
    #: alpha of the energy model.
    orbital_factor: float = 2.0
    #: M m_B [kg].
    mass_product: float = 103.6
    #: K [N/m].
    rope_stiffness: float = 890e3
    #: Tension goes with the cosine of the angle to this power.
    angle_exponent: float = 2.0
    #: Tension of the new type over that of the conventional one [-].
    type_ratio: float = 0.7
    #: Tension of the tension wire over that of the anchor rope [-].
    wire_ratio: float = 0.6
    #: Speed that the slack of the rope takes up before it pulls [m/s].
    slack_speed: float = 0.35
    #: Wave tension while the current slackens the rope (U_x below 0) over that while it draws it taut.
    slack_ratio: float = 0.85
    #: Standard deviation of a wave's tension over its law.
    scatter: float = 0.15
    #: Duration of a pull [s].
    pulse: float = 0.8
    #: Delay of the pull behind the crest [s].
    lag: float = 1.1
    #: Mean pretension of the new type [N].
    steady_new: float = 8.0e3
    #: Mean pretension of the conventional type [N].
    steady_conventional: float = 11.0e3
    #: Standard deviation of its slow wander, over the mean.
    steady_scatter: float = 0.07
    #: Amplitude of the current along the normal [m/s].
    tide_speed: float = 0.18
    #: Period of that current [s].
    tide_period: float = 44714.0
    #: Current along the curtain over that along its normal, a quarter of a period later.
    cross_share: float = 0.5
    #: Standard deviations of the instruments [m].
    noise_elevation: float = 0.004
    #: Standard deviations of the instruments [m/s].
    noise_velocity: float = 0.01
    #: Standard deviations of the instruments [N].
    noise_tension: float = 20.0
    #: Depth of the current meter [m].
    gauge_depth: float = 4.0

    def height(self, storm: Storm, time: float) -> float:
        """Return H1/3 of the law [m] at an instant after the start of a campaign [s]."""
        distance = (time / 86400.0 - storm.peak_day) / storm.duration
        return storm.calm_height + (storm.peak_height - storm.calm_height) * math.exp(-0.5 * distance**2)

    def angle(self, storm: Storm, time: float) -> float:
        """Return the heading of the waves from the normal [rad]."""
        share = min(max(time / (86400.0 * storm.days), 0.0), 1.0)
        return storm.angle_start + share * (storm.angle_end - storm.angle_start)

    def current(self, storm: Storm, time: float) -> tuple[float, float]:
        """Return the current along and across the normal [m/s]."""
        phase = 2.0 * math.pi * (storm.start + time) / self.tide_period
        return self.tide_speed * math.cos(phase), self.cross_share * self.tide_speed * math.sin(phase)

    def pull(self, height: Array, period: Array, angle: float, current: float) -> Array:
        """Return the tension that a conventional anchor takes from waves, without scatter [N].

        ``sqrt(M m_B K) (alpha u_max + U - U_0)``, not below 0; ``u_max = (pi H/T) coth kh`` of the height times the
        cosine's power and the slack speed U_0.
        """
        omega = 2.0 * math.pi / period
        kh = np.asarray(wave_number(omega, self.water.depth, self.water.gravity)) * self.water.depth
        reduced = height * math.cos(angle) ** self.angle_exponent
        speed = self.orbital_factor * 0.5 * reduced * omega / np.tanh(kh) + current - self.slack_speed
        taut = 1.0 if current >= 0.0 else self.slack_ratio
        return np.asarray(taut * math.sqrt(self.mass_product * self.rope_stiffness) * np.maximum(speed, 0.0))


@dataclass(frozen=True, eq=False)
class CampaignBlock:
    """One block of a synthetic record: instants [s since 1970 UTC] and channels, and the laws' values in it."""

    time: Array
    values: Array
    height: float
    angle: float
    current: float


def generate(laws: CampaignLaws, storm: Storm, *, seed: int, every: int = 1) -> Iterator[CampaignBlock]:
    """Yield the blocks of a campaign.

    Parameters
    ----------
    laws : CampaignLaws
    storm : Storm
    seed : int
    every : int
        Only every so many blocks (the others are a gap in the record): a quick campaign of the same shape.

    Yields
    ------
    CampaignBlock
        Each with a sea of its own: waves do not run on from block to block.
    """
    if every < 1:
        raise InputError(f"every {every} blocks", parameter="every", allowed="1 or more")
    random = np.random.default_rng(seed)
    size = round(laws.block * laws.rate)
    wander = {"new": 0.0, "conventional": 0.0}
    for number in range(round(storm.days * 86400.0 / laws.block)):
        for name in wander:  # a pretension that forgets itself in some ten hours
            wander[name] = 0.965 * wander[name] + math.sqrt(1.0 - 0.965**2) * random.normal()
        if number % every:
            continue
        begin = number * laws.block
        middle = begin + 0.5 * laws.block
        height, angle = laws.height(storm, middle), laws.angle(storm, middle)
        along, across = laws.current(storm, middle)
        elevation, u, v = _sea(laws, height, angle, size, random)
        local = np.arange(size) / laws.rate
        waves = find_waves(local, elevation, WaveOptions(detrend=Detrend("mean"), crest="sample"))
        pulls = laws.pull(waves.height, waves.period, angle, along)
        crests = _crests(local, elevation, waves.start, waves.end)
        tensions = []
        for share, kind in (
            (laws.wire_ratio * laws.type_ratio, "new"),
            (laws.type_ratio, "new"),
            (laws.type_ratio, "new"),
            (1.0, "conventional"),
            (1.0, "conventional"),
        ):
            steady = laws.steady_new if kind == "new" else laws.steady_conventional
            level = steady * max(1.0 + laws.steady_scatter * wander[kind], 0.2)
            scatter = np.maximum(1.0 + laws.scatter * random.normal(size=pulls.size), 0.0)
            pulse = _pulses(laws, local, crests + laws.lag, share * pulls * scatter)
            tensions.append(level + pulse + laws.noise_tension * random.normal(size=size))
        columns = [
            elevation + laws.noise_elevation * random.normal(size=size),
            u + along + laws.noise_velocity * random.normal(size=size),
            v + across + laws.noise_velocity * random.normal(size=size),
            *tensions,
        ]
        yield CampaignBlock(storm.start + begin + local, np.column_stack(columns), height, angle, along)


def _sea(
    laws: CampaignLaws, height: float, angle: float, size: int, random: np.random.Generator
) -> tuple[Array, Array, Array]:
    """Return elevation and the orbital velocities at the current meter of two crossing halves of one sea."""
    # T1/3 is near 0.9 Tp for this spectrum
    spectrum = jonswap(height, laws.period_factor * math.sqrt(height) / 0.9, laws.peak_enhancement)
    omega = 2.0 * math.pi * np.fft.rfftfreq(size, 1.0 / laws.rate)
    density = np.where(omega > 0.0, spectrum.density_at(np.maximum(omega, 1e-6)), 0.0)
    density = np.where(omega < 12.0 * 2.0 * math.pi / (laws.period_factor * math.sqrt(height)), density, 0.0)
    moving = density > 0.0
    k = np.asarray(wave_number(omega[moving], laws.water.depth, laws.water.gravity), dtype=float)
    transfer = np.zeros(omega.size)
    h, z = laws.water.depth, -laws.gauge_depth
    transfer[moving] = omega[moving] * np.exp(k * z) * (1.0 + np.exp(-2.0 * k * (z + h))) / -np.expm1(-2.0 * k * h)
    amplitude = size * np.sqrt(0.25 * density * (omega[1] - omega[0]))
    out = [np.zeros(size), np.zeros(size), np.zeros(size)]
    for side in (-1.0, 1.0):
        # Rayleigh amplitudes: a sea, not a sum of fixed cosines
        wave = amplitude * math.sqrt(0.5) * (random.normal(size=omega.size) + 1j * random.normal(size=omega.size))
        heading = angle + side * laws.half_spread
        out[0] += np.fft.irfft(wave, size)
        speed = np.fft.irfft(wave * transfer, size)
        out[1] += math.cos(heading) * speed
        out[2] += math.sin(heading) * speed
    return out[0], out[1], out[2]


def _crests(time: Array, elevation: Array, start: Array, end: Array) -> Array:
    """Return the instant of the highest sample of each wave."""
    first, last = np.searchsorted(time, start), np.searchsorted(time, end)
    return np.array([time[a + int(np.argmax(elevation[a:b]))] for a, b in zip(first, last, strict=True)])


def _pulses(laws: CampaignLaws, time: Array, centre: Array, top: Array) -> Array:
    """Return half sines of the given tops; where two meet, the larger one counts."""
    out, half = np.zeros(time.size), 0.5 * laws.pulse
    first, last = np.searchsorted(time, centre - half), np.searchsorted(time, centre + half)
    place = first[:, None] + np.arange(int(np.max(last - first, initial=0)))
    wave, column = np.nonzero(place < last[:, None])
    place = place[wave, column]
    np.maximum.at(out, place, top[wave] * np.cos(0.5 * math.pi * (time[place] - centre[wave]) / half))
    return out


SURVEY = """moyai: 1
title: Synthetic campaign, {title}
site: {{water_depth: {depth} m, density: 1025, gravity: 9.81, x_axis_bearing_deg: 270}}
structure_normal_deg: 0
blocks: {{length: {block} s}}
loggers:
  - name: tower
    file: {file}
    time: {{column: time, unit: s, start: "1970-01-01"}}
    channels:
      - {{name: elevation, column: elevation, unit: m, kind: elevation}}
      - {{name: u, column: u, unit: m/s, kind: velocity_x, z: -{gauge} m, quality: {{spikes: false}}}}
      - {{name: v, column: v, unit: m/s, kind: velocity_y, z: -{gauge} m, quality: {{spikes: false}}}}
      - {{name: J-0, column: J-0, unit: N, kind: tension}}
      - {{name: J-1, column: J-1, unit: N, kind: tension}}
      - {{name: J-2, column: J-2, unit: N, kind: tension}}
      - {{name: F-1, column: F-1, unit: N, kind: tension}}
      - {{name: F-2, column: F-2, unit: N, kind: tension}}
waves: {{channels: [elevation], detrend: linear, dead_band: 2 cm, crest: parabola, share: nearest}}
spectrum: {{segment: 150 s, lowest: 0.05 Hz, highest: 0.6 Hz}}
directions: {{channels: [elevation, u, v]}}
current: {{velocity: [u, v]}}
tensions:
  waves: elevation
  steady: median
  lag: {lag} s
  largest_lag: 0.8 s
  curtain_depth: 5 m
  direction_rule: paper
  lines:
    - {{channel: F-1, group: conventional}}
    - {{channel: F-2, group: conventional}}
    - {{channel: J-1, group: new}}
    - {{channel: J-2, group: new}}
    - {{channel: J-0, group: wire}}
"""


def write_campaign(
    laws: CampaignLaws, storm: Storm, folder: Path, *, seed: int, every: int = 1, progress: Progress = silent
) -> Path:
    """Write one campaign as NetCDF with the file that ``moyai measure records`` takes.

    Parameters
    ----------
    laws, storm, seed, every
        See :func:`generate`.
    folder : Path
        Made when absent.
    progress : Progress

    Returns
    -------
    Path
        The YAML file.
    """
    import h5netcdf

    data = folder / f"{storm.name}.nc"
    total = round(storm.days * 86400.0 / laws.block)
    size = round(laws.block * laws.rate)
    with partial_file(data) as partial, h5netcdf.File(partial, "w") as file:
        file.dimensions = {"time": size * len(range(0, total, every))}
        for name in ("time", *CHANNELS):
            kind = np.float64 if name == "time" else np.float32
            file.create_variable(name, ("time",), kind, chunks=(min(131072, size),))
        for place, block in enumerate(generate(laws, storm, seed=seed, every=every)):
            part = slice(place * size, (place + 1) * size)
            file.variables["time"][part] = block.time
            for column, name in enumerate(CHANNELS):
                file.variables[name][part] = block.values[:, column]
            progress(f"campaign {storm.name}", place * every, total)
    text = SURVEY.format(
        title=storm.name,
        depth=laws.water.depth,
        block=laws.block,
        file=data.name,
        gauge=laws.gauge_depth,
        lag=laws.lag,
    )
    return write_whole(folder / f"{storm.name}.yaml", text.encode("utf-8"))
