"""Runs of towed nets: what was recorded, and the frame that carried the net."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.morison.nets import Net

RunKind = Literal["still_water", "towing_waves", "waves"]
KINDS: tuple[RunKind, ...] = ("still_water", "towing_waves", "waves")

_STEP_TOLERANCE = 0.02


@dataclass(frozen=True)
class Specimen:
    """A net as it was towed."""

    name: str
    net: Net
    #: Outline of the panel [m2].
    panel_area: float
    #: Area of its twines that C_D refers to [m2].
    projected_area: float

    def __post_init__(self) -> None:
        for name in ("panel_area", "projected_area"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(
                    f"{name} of net {self.name} is {value:g} m2", parameter=name, allowed="greater than 0 m2"
                )
        if self.net.mesh_pitch**2 > self.panel_area:
            raise InputError(
                f"meshes of {self.net.mesh_pitch:.4g} m do not fit net {self.name}'s panel of {self.panel_area:.4g} m2",
                parameter="mesh_pitch",
                remedy="check the units: mm or m, cm2 or m2",
            )
        if not 0.25 * self.net.listed < self.projected_area / self.panel_area < 2.0:
            raise InputError(
                f"the twines of net {self.name} shade {self.projected_area:.4g} m2 of a panel of {self.panel_area:.4g}",
                parameter="projected_area",
                allowed=f"about {self.net.listed:.3g} of the outline, the solidity of the net",
                remedy="check the units: cm2 or m2",
            )

    @property
    def volume(self) -> float:
        """Volume of the twines, which C_M refers to [m3]."""
        return self.net.volume_per_area * self.panel_area


@dataclass(frozen=True)
class Tank:
    """Water and geometry that all runs share."""

    #: [kg/m3].
    density: float
    #: Kinematic [m2/s].
    viscosity: float
    #: [m/s2].
    gravity: float
    #: [m], may be infinite.
    water_depth: float
    #: Height of the centre of the panel above still water, negative [m].
    panel_z: float

    def __post_init__(self) -> None:
        for name in ("density", "viscosity", "gravity", "water_depth"):
            value = getattr(self, name)
            if not value > 0.0 or (name != "water_depth" and not math.isfinite(value)):
                raise InputError(f"{name} is {value:g}", parameter=name, allowed="greater than 0")
        if not -self.water_depth < self.panel_z < 0.0:
            raise InputError(
                f"the centre of the panel is at z = {self.panel_z:g} m",
                parameter="panel_z",
                allowed=f"above the bed at {-self.water_depth:g} m and below 0 m",
            )


@checks_words
@dataclass(frozen=True, eq=False)
class NetRun:
    """One record.

    Raises
    ------
    InputError
        For gaps, uneven steps, channels of unequal length, or a run that lacks what its kind needs.
    """

    name: str
    #: Name of the specimen; empty for a run of the bare frame.
    net: str
    #: One of "still_water", "towing_waves", "waves".
    kind: RunKind
    #: [s]; shape (samples,).
    time: Array
    #: Along the water's motion past the panel [N]; shape (samples,).
    force: Array
    #: Across it [N].
    lift: Array | None = None
    #: Speed of towing, so of the water past the panel [m/s]; 0 in waves alone.
    speed: float = 0.0
    #: Measured speed of the carriage [m/s].
    speed_record: Array | None = None
    #: Of the water past the panel, by a meter on the carriage [m/s].
    velocity: Array | None = None
    #: Surface at a gauge that moves with the carriage [m].
    elevation: Array | None = None
    #: From that gauge to the panel in the direction of the waves [m].
    distance: float = 0.0
    #: Of the carriage [m/s2].
    acceleration: Array | None = None
    #: Of regular waves as at rest [s].
    period: float | None = None
    #: Whether the waves are regular.
    regular: bool = True
    #: Waves run with the carriage: against the water's motion past the panel.
    following: bool = False
    #: Part of the record to use [s].
    window: tuple[float, float] | None = None
    #: Part in which the force is nothing: its mean is taken off [s].
    zero: tuple[float, float] | None = None
    #: Run of the bare frame to subtract; empty lets the conditions choose.
    frame: str = ""

    def __post_init__(self) -> None:
        time = np.asarray(self.time, dtype=float)
        object.__setattr__(self, "time", time)
        if time.ndim != 1 or time.size < 32:
            raise InputError(f"run {self.name} holds {time.size} samples", parameter="time", allowed="at least 32")
        for name in ("force", "lift", "speed_record", "velocity", "elevation", "acceleration"):
            given = getattr(self, name)
            if given is None:
                continue
            values = np.asarray(given, dtype=float)
            if values.shape != time.shape:
                raise InputError(
                    f"run {self.name}: {values.size} samples of {name}, {time.size} of time",
                    parameter=name,
                    allowed="equal",
                )
            object.__setattr__(self, name, values)
        self._refuse_gaps()
        self._refuse_lacks()
        for name in ("window", "zero"):
            part = getattr(self, name)
            if part is not None and not (part[0] < part[1] and part[0] < time[-1] and part[1] > time[0]):
                raise InputError(
                    f"run {self.name}: {name} from {part[0]:g} to {part[1]:g} s lies outside the record",
                    parameter=name,
                    allowed=f"within {time[0]:g} to {time[-1]:g} s",
                )

    def _refuse_gaps(self) -> None:
        for name in ("time", "force", "lift", "speed_record", "velocity", "elevation", "acceleration"):
            values = getattr(self, name)
            if values is not None and not np.isfinite(values).all():
                row = int(np.argmin(np.isfinite(values))) + 1
                raise InputError(
                    f"run {self.name}: {name} is not a number in sample {row}",
                    parameter=name,
                    remedy="fill short gaps or cut the record",
                )
        steps = np.diff(self.time)
        even = float(np.median(steps))
        if even <= 0.0 or np.abs(steps - even).max() > _STEP_TOLERANCE * even:
            row = int(np.argmax(np.abs(steps - even))) + 2
            raise InputError(
                f"run {self.name} is not evenly sampled: the step to sample {row} is {steps[row - 2]:.6g} s, most are "
                f"{even:.6g} s",
                parameter="time",
                remedy="interpolate it to an even step, or choose a part without dropped samples",
            )

    def _refuse_lacks(self) -> None:
        if not (math.isfinite(self.speed) and self.speed >= 0.0):
            raise InputError(
                f"run {self.name}: speed is {self.speed:g} m/s", parameter="speed", allowed="at least 0 m/s"
            )
        if self.kind != "waves" and self.speed == 0.0 and self.speed_record is None:
            raise InputError(f"run {self.name}: the speed of towing is missing", parameter="speed")
        if self.kind == "still_water":
            return
        if self.velocity is None and self.elevation is None:
            raise InputError(
                f"run {self.name}: waves need the record of a current meter or of a wave gauge",
                parameter="columns",
                allowed="velocity or elevation",
            )
        if self.kind == "towing_waves" and self.velocity is None and self.period is None:
            raise InputError(
                f"run {self.name}: velocity by theory needs the period of the waves at rest",
                parameter="period",
                remedy="give the period of the wave maker",
            )

    @property
    def step(self) -> float:
        """Time step [s]."""
        return float((self.time[-1] - self.time[0]) / (self.time.size - 1))

    def part(self, window: tuple[float, float] | None) -> NDArray[np.bool_]:
        """Return which samples lie in a window; all without one."""
        if window is None:
            return np.ones(self.time.size, dtype=bool)
        return np.asarray((self.time >= window[0]) & (self.time <= window[1]))

    def zeroed(self) -> Array:
        """Return the force with its reading at rest taken off [N]."""
        if self.zero is None:
            return self.force
        return np.asarray(self.force - self.force[self.part(self.zero)].mean())
