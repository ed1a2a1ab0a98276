"""Velocity of waves and current that a hanging curtain feels along its normal, over the whole of a sea."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.sea.components import WaveComponents
from moyai.sea.current import CurrentProfile
from moyai.sea.water import Water

SkirtVelocity = Literal["skirt_mean", "surface", "wheeler"]

# Depths between which the mean over a stretched skirt is interpolated
_LEVELS = 5
#: Samples of the longest series that is run
MOST_SAMPLES = 5_000_000


def check_samples(duration: float, time_step: float) -> None:
    """Refuse series that would not fit into the memory of a computer.

    Raises
    ------
    InputError
        For more than 5 million samples.
    """
    if duration > MOST_SAMPLES * time_step:
        raise InputError(
            f"a series of {duration:.4g} s in steps of {time_step:.3g} s has more than {MOST_SAMPLES // 10**6} million "
            "samples",
            parameter="time_step",
            allowed=f"at least {duration / MOST_SAMPLES:.3g} s",
            remedy="shorten the series, or take longer steps",
        )


@dataclass(frozen=True, eq=False)
class SkirtFlow:
    """Water along the normal of a curtain on a uniform grid of times."""

    #: [s], from 0.
    time: Array
    #: Of waves and current [m/s].
    speed: Array
    #: Of waves and current [m/s2].
    acceleration: Array
    #: Of the surface at the middle of the span [m].
    elevation: Array
    #: Part of the current in the speed [m/s].
    current: float

    @property
    def time_step(self) -> float:
        """Step of the grid [s]."""
        return float(self.time[1] - self.time[0])

    def in_current(self, current: float) -> SkirtFlow:
        """Return the same waves in another current along the normal [m/s]."""
        return replace(self, speed=self.speed + (current - self.current), current=current)

    @property
    def table(self) -> Array:
        """Speed and acceleration side by side, as the oscillator takes them."""
        return np.stack([self.speed, self.acceleration], axis=1)


def depth_mean_factor(wave_number: ArrayLike, depth: ArrayLike, water: Water) -> Array:
    """Return the mean of cosh k(z+h)/sinh kh over -depth <= z <= 0 [eq:curtain-skirt-mean].

    Parameters
    ----------
    wave_number : array_like
        k [1/m].
    depth : array_like
        Of the skirt [m], at most the water's.
    water : Water
        Depth h, may be infinite.
    """
    k, d = np.asarray(wave_number, dtype=np.float64), np.asarray(depth, dtype=np.float64)
    fall = -np.expm1(-k * d)
    if math.isinf(water.depth):
        return np.asarray(fall / (k * d))
    return np.asarray(fall * (1.0 + np.exp(-k * (2.0 * water.depth - d))) / (k * d * -np.expm1(-2.0 * k * water.depth)))


@checks_words
def flow_over_skirt(
    sea: WaveComponents,
    water: Water,
    *,
    draught: float,
    normal_heading: float,
    current: CurrentProfile | float,
    duration: float,
    time_step: float,
    velocity: SkirtVelocity,
    span: float = 0.0,
) -> SkirtFlow:
    """Return speed and acceleration of the water along the normal of a curtain.

    Parameters
    ----------
    sea : WaveComponents
        The waves; a sea made with ``method="fft"`` and this ``time_step`` is summed by one Fourier transform.
    water : Water
        Depth.
    draught : float
        Depth d of the skirt below its float [m].
    normal_heading : float
        Direction of the curtain's normal [rad], as headings of the waves are counted; waves and currents against it
        count negative.
    current : CurrentProfile or float
        Profile, of which the mean over the skirt along the normal is taken, or that mean itself [m/s].
    duration, time_step : float
        Of the series [s].
    velocity : {"skirt_mean", "surface", "wheeler"}
        Mean over the skirt below still water; that at still water; or the mean over a skirt whose float rides on the
        surface, with Wheeler's stretching (in infinite depth the same as ``skirt_mean``) [eq:curtain-skirt-mean].
    span : float
        Over which the waves are averaged along the curtain [m]; 0 takes them at its middle. It matters where crests
        run obliquely.

    Raises
    ------
    InputError
        When a number is out of range, or waves with Wheeler's stretching reach the bed.
    """
    for name, value in {"draught": draught, "duration": duration, "time_step": time_step}.items():
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name} is {value:g}", parameter=name, allowed="greater than 0")
    if draught > water.depth:
        raise InputError(
            f"draught is {draught:g} m in water {water.depth:g} m deep",
            parameter="draught",
            allowed=f"at most {water.depth:g} m",
        )
    if velocity not in get_args(SkirtVelocity):
        raise InputError(
            f"unknown velocity {velocity!r}", parameter="velocity", allowed=", ".join(get_args(SkirtVelocity))
        )
    if not (math.isfinite(span) and span >= 0.0 and math.isfinite(normal_heading)):
        raise InputError("span or normal_heading is out of range", parameter="span", allowed="0 or more, finite")
    check_samples(duration, time_step)
    time = time_step * np.arange(math.ceil(duration / time_step - 1e-9) + 1, dtype=np.float64)
    if len(time) < 4:
        raise InputError(
            "the series has fewer than four times", parameter="time_step", allowed=f"below {duration / 3:g} s"
        )
    sigma = np.asarray(sea.intrinsic_omega)
    across = np.sin(sea.heading - normal_heading) * sea.wave_number * 0.5 * span
    # waves at the middle, averaged along the span; sinc(x) = sin(pi x)/(pi x)
    toward = sigma * np.cos(sea.heading - normal_heading) * np.sinc(across / math.pi)
    elevation = sea.elevation(time)
    if velocity == "wheeler" and math.isfinite(water.depth):
        speed, acceleration = _stretched(sea, water, draught, toward, sigma, time, elevation)
    else:
        if velocity == "surface":
            factor = 1.0 / np.tanh(sea.wave_number * water.depth)
        else:
            factor = depth_mean_factor(sea.wave_number, draught, water)
        speed, acceleration = sea.respond(np.stack([factor * toward, -1j * sigma * factor * toward]), time).T
    steady = _steady(current, draught, normal_heading, velocity)
    return SkirtFlow(time, speed + steady, np.array(acceleration), elevation, steady)


def _steady(current: CurrentProfile | float, draught: float, normal_heading: float, velocity: SkirtVelocity) -> float:
    if isinstance(current, CurrentProfile):
        mean = current.velocity(0.0) if velocity == "surface" else current.depth_mean(-draught, 0.0)
        part = np.asarray(mean, dtype=np.float64).reshape(-1)
        return float(part[0] * math.cos(normal_heading) + part[1] * math.sin(normal_heading))
    if not math.isfinite(current):
        raise InputError(f"current is {current:g} m/s", parameter="current", allowed="a number or a profile")
    return float(current)


def _stretched(
    sea: WaveComponents, water: Water, draught: float, toward: Array, sigma: Array, time: Array, elevation: Array
) -> tuple[Array, Array]:
    """Means over a skirt from the surface down, its depths mapped onto the still column as d h/(h + eta)."""
    if float(elevation.min()) <= draught - water.depth:
        raise InputError(
            f"a trough of {elevation.min():.3g} m sets the skirt of {draught:g} m on the bed",
            parameter="draught",
            allowed=f"less than {water.depth + elevation.min():.4g} m",
            remedy="take skirt_mean, or a shorter skirt",
        )
    depth = draught * water.depth / (water.depth + elevation)
    low, high = float(depth.min()), float(depth.max())
    if high - low < 1e-9 * draught:
        factor = depth_mean_factor(sea.wave_number, draught, water)
        speed, acceleration = sea.respond(np.stack([factor * toward, -1j * sigma * factor * toward]), time).T
        return speed, acceleration
    nodes = -np.cos(math.pi * (np.arange(_LEVELS) + 0.5) / _LEVELS)
    levels = 0.5 * (low + high) + 0.5 * (high - low) * nodes
    factors = depth_mean_factor(sea.wave_number, levels[:, None], water) * toward
    place = (2.0 * depth - low - high) / (high - low)
    # Lagrange's polynomials at the place of every instant
    basis = np.ones((_LEVELS, len(time)))
    for i in range(_LEVELS):
        for j in range(_LEVELS):
            if j != i:
                basis[i] *= (place - nodes[j]) / (nodes[i] - nodes[j])
    series = sea.respond(np.concatenate([factors, -1j * sigma * factors]), time)
    return (
        np.einsum("it,ti->t", basis, series[:, :_LEVELS]),
        np.einsum("it,ti->t", basis, series[:, _LEVELS:]),
    )
