"""A synthetic campaign: records of waves and line tensions with planted relations, and the chain that reads them.

The record of the paper is not published. Every wave pulls once, by the energy model of the paper; direction, current,
steady tension and the type of the curtain are planted, so that the processing has something to find again. M and K are
those of the print: only their product acts, which is that of M = 9.2 and a rope of 890 kN for a strain of one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.records.survey.tension_blocks import Blocks, analyse_blocks
from moyai.sea.irregular import synthesise
from moyai.sea.spectra import jonswap
from moyai.sea.water import Water
from moyai.series.zero_crossing import split_waves
from moyai.structures.curtain.seas.anchor_energy import EnergyModel
from moyai.structures.curtain.seas.energy_by_wave import WaveCalibration, calibrate_by_wave
from moyai.structures.curtain.seas.squared_velocity import effective_height

WATER = Water(depth=20.0, density=1025.0, gravity=9.81)
CURTAIN_DEPTH, BLOCK, STEP = 5.0, 1200.0, 0.1
NEW = EnergyModel(
    energy_factor=0.2, float_mass=518.0, rope_stiffness=890e3, orbital_factor=2.0, line_factor=1.0, type_factor=0.7
)
CONVENTIONAL = EnergyModel(
    energy_factor=0.2, float_mass=518.0, rope_stiffness=890e3, orbital_factor=2.0, line_factor=1.0, type_factor=1.0
)


@dataclass(frozen=True, eq=False)
class FieldCampaign:
    """A record and what was put into it, block by block."""

    time: Array
    elevation: Array
    new: Array
    conventional: Array
    current: Array
    angle: Array
    steady: Array


def campaign(
    seed: int, blocks: int, *, pretension_in_model: float = 0.0, currents: float = 0.2, scatter: float = 0.15
) -> FieldCampaign:
    """Return a campaign of so many blocks; angles of the waves are spread over 0 to 75 degrees from the normal."""
    rng = np.random.default_rng(seed)
    size = round(BLOCK / STEP)
    time = np.asarray(STEP * np.arange(blocks * size), dtype=np.float64)
    elevation, new, conventional = np.empty(time.size), np.empty((2, time.size)), np.empty((2, time.size))
    current = np.zeros((time.size, 2))
    angle, steady = np.radians(rng.uniform(0.0, 75.0, blocks)), rng.uniform(4e3, 12e3, blocks)
    for k in range(blocks):
        part = slice(k * size, (k + 1) * size)
        height = rng.uniform(0.4, 3.0)
        flow = currents * np.sin(2.0 * np.pi * k / 18.0)
        sea = synthesise(
            jonswap(height, 3.86 * np.sqrt(height), 3.3), WATER, duration=BLOCK, seed=seed * 1000 + k, time_step=STEP,
            heading=angle[k], amplitudes="rayleigh",
        )  # fmt: skip
        local = np.asarray(STEP * np.arange(size), dtype=np.float64)
        elevation[part] = sea.elevation(local)
        current[part, 0] = flow
        for model, lines, more in ((NEW, new, 0.0), (CONVENTIONAL, conventional, 3e3)):
            pulls = _pulls(model, elevation[part], local, angle[k], flow, pretension_in_model, rng, scatter)
            for line in lines:
                line[part] = steady[k] + more + pulls * rng.uniform(0.95, 1.05) + 60.0 * rng.standard_normal(size)
    return FieldCampaign(time, elevation, new, conventional, current, angle, steady)


def _pulls(
    model: EnergyModel, elevation: Array, time: Array, angle: float, flow: float, pretension: float,
    rng: np.random.Generator, scatter: float,
) -> Array:  # fmt: skip
    """Return one short pull for every wave, at its crest."""
    waves = split_waves(time, elevation, parabolic=True)
    acting = effective_height(waves.height, np.full(len(waves), angle), "paper", 1.0)
    speed = model.float_speed(acting, np.maximum(waves.period, 1.0), flow, WATER)
    size = model.fluctuating_tension(speed, pretension) * np.maximum(
        1.0 + scatter * rng.standard_normal(len(waves)), 0.1
    )
    out = np.zeros(time.size)
    centres, widths = waves.start + 0.25 * waves.period, 0.05 * waves.period
    ends = (np.searchsorted(time, centres + 5.0 * side * widths) for side in (-1.0, 1.0))
    for centre, width, top, first, last in zip(centres, widths, size, *ends):
        near = slice(first, last)
        out[near] += top * np.exp(-0.5 * ((time[near] - centre) / width) ** 2)
    return out


def process(data: FieldCampaign, conventional: bool = False) -> Blocks:
    """Run the chain over one type of the campaign."""
    return analyse_blocks(
        data.time, data.elevation, data.conventional if conventional else data.new, block=BLOCK, rule="median",
        wave_heading=data.angle, current=data.current, normal_heading=0.0,
    )  # fmt: skip


def block_maxima(blocks: Blocks) -> tuple[Array, Array]:
    """Return largest tensions [N] and the float speeds of the highest waves, current along the normal [m/s]."""
    return blocks.averaged("maximum"), _speed(blocks, blocks.maximum_height)


def paper_maxima(blocks: Blocks) -> tuple[Array, Array]:
    """Return 1.7 T_1/10 [N] and the float speeds of 1.8 H_1/3, which the paper takes for the maxima [m/s]."""
    return 1.7 * blocks.averaged("tenth"), _speed(blocks, 1.8 * blocks.significant_height)


def _speed(blocks: Blocks, height: Array) -> Array:
    acting = effective_height(height, blocks.angle, "paper", 1.0)
    return CONVENTIONAL.float_speed(acting, blocks.significant_period, blocks.current_normal, WATER)


def wave_maxima(blocks: Blocks) -> tuple[Array, Array]:
    """Return the tension of every wave, mean of the anchors [N], and the float speed of its own height and period."""
    waves = blocks.waves
    acting = effective_height(waves.height, blocks.angle[waves.block], "paper", 1.0)
    speed = CONVENTIONAL.float_speed(acting, waves.period, blocks.current_normal[waves.block], WATER)
    return waves.top.mean(axis=1), speed


def by_wave(blocks: Blocks) -> WaveCalibration:
    """Return the energy model fitted to single waves."""
    return calibrate_by_wave(*wave_maxima(blocks), blocks.waves.block, blocks.noise.mean(axis=1), line_factor=1.0)
