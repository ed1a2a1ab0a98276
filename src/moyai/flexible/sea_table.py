"""The sea around lines in motion: a regular wave at their nodes, an irregular sea at their places at rest."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.remembered import Remembered, key_of_objects
from moyai.flexible.flow import Flow
from moyai.flexible.sea_table_kernel import COLUMNS, spread_kinematics
from moyai.sea.components import WaveComponents
from moyai.sea.short_window import ShortWindow, frequency_spacing
from moyai.sea.time_sum import sum_rows_over_time

if TYPE_CHECKING:
    from moyai.flexible.flow import Current


#: Components up to which the water is summed at the present place of every node.
FEW_COMPONENTS = 8
#: Frequencies of a short window over components, up to which these are merged.
LEAST_MERGED = 0.25
#: Numbers of a tabulated sea.
MOST_NUMBERS = 4e8
_WINDOWS: Remembered[ShortWindow] = Remembered(4)


@checks_words
@dataclass(frozen=True, eq=False)
class TabulatedFlow(Flow):
    """A sea summed beforehand at the places of the nodes at rest, joined linearly between its times.

    The lines of a breakwater move by metres where the waves are tens of metres long: k times the motion is the error of
    the phase.
    """

    #: Velocity, acceleration and elevation of the waves; shape (7, nodes, times).
    table: NDArray[np.float32] | None = None
    #: [s].
    table_step: float = 1.0

    @property
    def steady(self) -> bool:
        """A sea is never steady."""
        return False

    @property
    def update_interval(self) -> float:
        """Time between two evaluations [s]."""
        return self.table_step

    @property
    def summed(self) -> tuple[NDArray[np.float32], float]:
        """The table and its step [s]."""
        return super().summed if self.table is None else (self.table, self.table_step)

    def at(self, time: float, position: Array) -> Array:
        """Return velocity, acceleration and elevation at the nodes, shape (7, n)."""
        out = super().at(time, position)
        if self.table is None or position.shape[1] != self.table.shape[1]:
            return out
        place = min(max(time / self.table_step, 0.0), self.table.shape[2] - 1.0)
        row = min(int(place), self.table.shape[2] - 2)
        part = place - row
        grown, rate = self.growth(time)
        wave = (1.0 - part) * self.table[:, :, row] + part * self.table[:, :, row + 1]
        out[:3] += grown * wave[:3]
        out[3:6] += grown * wave[3:6] + rate * wave[:3]
        out[6] += grown * wave[6]
        return out


def sea_of_lines(
    waves: WaveComponents | None,
    current: Current | None,
    ramp: float,
    nodes: Array,
    duration: float,
    step: float,
) -> Flow:
    """Return the water around the lines.

    Parameters
    ----------
    waves : WaveComponents or None
        With their water.
    current : profile or None
    ramp : float
        [s].
    nodes : ndarray (n, 3)
        Places at rest [m].
    duration, step : float
        Length and step of the table of an irregular sea [s]; the step divides the period in which the sea repeats.

    Raises
    ------
    InputError
        For a sea too long to be tabulated.
    """
    if waves is None or not np.any(waves.amplitude):
        return Flow(current=current, ramp=ramp)
    if len(waves) <= FEW_COMPONENTS:
        return Flow(current=current, ramp=ramp, waves=waves)
    count = math.ceil(duration / step) + 2
    if 7.0 * count * len(nodes) > MOST_NUMBERS:
        raise InputError(
            f"a sea of {duration:g} s at {len(nodes)} nodes of lines in motion is too long to be summed beforehand",
            parameter="waves.duration",
            allowed=f"up to {MOST_NUMBERS / 7.0 / len(nodes) * step:.4g} s",
            remedy="shorten the sea or use fewer bars",
        )
    return TabulatedFlow(current=current, ramp=ramp, table=_table(waves, nodes, count, step), table_step=step)


def _table(waves: WaveComponents, nodes: Array, count: int, step: float) -> NDArray[np.float32]:
    """Sum the linear kinematics of all components at every node; above still water as at still water."""
    water = waves.water
    assert water is not None
    out = np.zeros((7, len(nodes), count), dtype=np.float32)
    time, level = step * np.arange(count, dtype=np.float64), np.minimum(nodes[:, 2], 0.0)
    if np.ptp(waves.omega) < LEAST_MERGED * len(waves) * frequency_spacing(time):
        # events of a sea differ in their phases
        window = _WINDOWS.of(key_of_objects(waves.omega, time), lambda: ShortWindow.of(waves.omega, time))
        parts = (
            waves.amplitude, waves.phase - waves.omega * window.middle, waves.intrinsic_omega, waves.wave_number,
            np.cos(waves.heading), np.sin(waves.heading),
        )  # fmt: skip
        sea = tuple(np.array(part, dtype=np.float64) for part in parts)
        spread = np.zeros((window.count, len(nodes) * COLUMNS))
        spread_kinematics(np.array(nodes), level, sea, float(water.depth), window.first, window.shares, spread)
        rows = spread.reshape(window.count, len(nodes), 7, 2).transpose(2, 1, 0, 3).reshape(7 * len(nodes), -1)
        out[:] = (rows @ window.waves).reshape(out.shape)
        return out
    k, depth = waves.wave_number, water.depth
    intrinsic = np.asarray(waves.intrinsic_omega)
    amplitude = waves.amplitude * np.exp(1j * waves.phase)
    cosine, sine = np.cos(waves.heading), np.sin(waves.heading)
    whole = -np.expm1(-2.0 * k * depth)
    for number, (x, y, _) in enumerate(nodes):
        turn = amplitude * np.exp(1j * k * (x * cosine + y * sine))
        fall = np.exp(k * level[number])
        back = np.exp(-2.0 * k * (level[number] + depth)) if math.isfinite(depth) else 0.0 * k
        along, up = fall * (1.0 + back) / whole, fall * (1.0 - back) / whole
        flow = intrinsic * turn * along
        velocity = np.stack([flow * cosine, flow * sine, -1j * intrinsic * turn * up])
        whole_sea: ComplexArray = np.concatenate([velocity, -1j * intrinsic * velocity, turn[None]])
        out[:, number] = sum_rows_over_time(waves.omega, whole_sea, time, waves.frequency_step)
    return out
