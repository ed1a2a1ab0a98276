"""A regular wave in the theory that it needs: linear, or the stream function where linear waves are not enough."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from typing import Literal

import numpy as np

from moyai.core.options import checks_words
from moyai.core.validity import Notice
from moyai.sea.components import WaveComponents
from moyai.sea.nonlinear import nonlinear_wave
from moyai.sea.permanent_wave import NonlinearWave
from moyai.sea.regular import RegularWave
from moyai.sea.validity import check_wave, recommended_theory
from moyai.sea.water import Water

#: What a case may ask for; ``automatic`` is linear where its neglected harmonic is below one per cent of the first.
RegularTheory = Literal["automatic", "linear", "stream_function"]


@checks_words
def theory_of(
    theory: RegularTheory, height: float, period: float, water: Water, current_along_wave: float = 0.0
) -> Literal["linear", "stream_function"]:
    """Return the theory of one wave: what was asked for, chosen where that is ``automatic``.

    Parameters
    ----------
    theory : {"automatic", "linear", "stream_function"}
    height, period : float
        H [m] and T in the fixed frame [s].
    water : Water
    current_along_wave : float
        Uniform current along the heading [m/s].
    """
    if theory != "automatic":
        return theory
    lowest = recommended_theory(height, period, water, current_along_wave).theory
    return "linear" if lowest == "airy" else "stream_function"


@checks_words
def regular_wave(
    theory: RegularTheory, height: float, period: float, heading: float, water: Water, current_along_wave: float = 0.0
) -> tuple[WaveComponents, NonlinearWave | None]:
    """Return a regular wave with its crest at the origin at t = 0; the last waves are kept in memory.

    Returns
    -------
    components : WaveComponents
        The linear wave; in the stream function the harmonics of the elevation alone, all of one celerity.
    steep : NonlinearWave or None
        Motion of the water in the stream function; ``None`` for the linear wave.

    Raises
    ------
    ConvergenceError
        When the stream function finds no such wave.
    """
    return _regular_wave(theory, float(height), float(period), float(heading), water, float(current_along_wave))


@lru_cache(maxsize=256)
def _regular_wave(
    theory: RegularTheory, height: float, period: float, heading: float, water: Water, current_along_wave: float
) -> tuple[WaveComponents, NonlinearWave | None]:
    if theory_of(theory, height, period, water, current_along_wave) == "linear":
        return RegularWave(height, period, heading, water, current_along_wave).components(), None
    steep = nonlinear_wave(
        "stream_function", height=height, water=water, period=period, heading=heading,
        current_along_wave=current_along_wave,
    )  # fmt: skip
    return harmonics_of(steep), steep


def harmonics_of(wave: NonlinearWave) -> WaveComponents:
    """Return the elevation of a wave of permanent form as components; their orbital motion is not that of the wave."""
    order = np.arange(1.0, wave.elevation_harmonics.size + 1.0)
    amplitude = np.asarray(wave.elevation_harmonics)
    relative = wave.omega - wave.wave_number * wave.current_along_wave
    return WaveComponents(
        omega=order * wave.omega,
        amplitude=np.abs(amplitude),
        phase=np.where(amplitude < 0.0, math.pi, 0.0),
        heading=np.full(order.size, wave.heading),
        wave_number=order * wave.wave_number,
        water=wave.water,
        intrinsic_omega=order * relative,
    )


def linear_limit(name: str, wave: WaveComponents, remedy: str) -> list[Notice]:
    """Return an error where a single linear wave neglects harmonics beyond a tenth of the first.

    Parameters
    ----------
    name : str
        Of the wave, for the message.
    wave : WaveComponents
        One component, with its water; nothing is said of more.
    remedy : str
        What helps.
    """
    if len(wave) != 1 or wave.water is None:
        return []
    omega, number = float(wave.omega[0]), float(wave.wave_number[0])
    along = (omega - float(np.asarray(wave.intrinsic_omega)[0])) / number
    height, period = 2.0 * float(wave.amplitude[0]), 2.0 * math.pi / omega
    return [
        replace(notice, message=f"{name}: {notice.message}", severity="error", remedy=remedy)
        for notice in check_wave(height, period, wave.water, current_along_wave=along)
        if notice.code == "wave-theory" and notice.severity == "warning"
    ]
