"""Cost of the sea: dispersion, synthesis, elevation, kinematics, spectra, stream-function waves.

Prints one JSON line a measurement, each with a peer or a limit timed in the same run.

    OMP_NUM_THREADS=1 python benchmarks/bench_sea.py
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from moyai.core.errors import ConvergenceError
from moyai.sea import dispersion, spectra
from moyai.sea.breaking import highest_steady_wave
from moyai.sea.components import WaveComponents
from moyai.sea.irregular import synthesise
from moyai.sea.nonlinear import nonlinear_wave
from moyai.sea.water import Water

WATER = Water(20.0, 1025.0, 9.81)


def seconds(work: Callable[[], Any], repeats: int = 5) -> float:
    """Return the least time of several runs, after one that compiles."""
    work()
    best = math.inf
    for _ in range(repeats):
        start = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - start)
    return best


def say(name: str, own: float, peer: str, other: float, **more: Any) -> None:
    """Print one measurement."""
    record = {"name": name, "seconds": own, "peer": peer, "peer_seconds": other, "ratio": other / own, **more}
    print(json.dumps({key: round(item, 7) if isinstance(item, float) else item for key, item in record.items()}))


def bench_dispersion() -> None:
    """Wave numbers of a million frequencies against a fixed-count numpy Newton iteration."""
    y = np.geomspace(1e-3, 30.0, 1_000_000)
    omega = np.sqrt(y * np.tanh(y) * 9.81 / 20.0)

    def newton() -> np.ndarray:
        x = omega**2 * 20.0 / 9.81
        guess = x / np.sqrt(np.tanh(x))
        for _ in range(5):
            t = np.tanh(guess)
            guess = guess - (guess * t - x) / (t + guess * (1.0 - t * t))
        return guess / 20.0

    own = seconds(lambda: dispersion.wave_number(omega, 20.0, 9.81), 3)
    error = float(np.max(np.abs(dispersion.wave_number(omega, 20.0, 9.81) * 20.0 / y - 1.0)))
    peer_error = float(np.max(np.abs(newton() * 20.0 / y - 1.0)))
    say(
        "1e6 wave numbers",
        own,
        "numpy Newton, 5 steps",
        seconds(newton, 3),
        error=f"{error:.1e}",
        peer_error=f"{peer_error:.1e}",
    )
    own = seconds(lambda: dispersion.evanescent_wave_numbers(1.0, 20.0, 9.81, 100_000), 3)
    n = np.arange(1, 100_001)

    def one_arctangent() -> np.ndarray:
        return n * math.pi - np.arctan2(20.0 / 9.81, n * math.pi)

    say("1e5 evanescent wave numbers", own, "one numpy arctangent each (not the root)", seconds(one_arctangent))


def bench_elevation() -> None:
    """Three hours at 0.1 s: Fourier transform, recurrence, and the plain sum of cosines."""
    spectrum = spectra.jonswap(2.0, 8.0, 3.3)
    fourier = synthesise(spectrum, WATER, duration=10800.0, seed=1, time_step=0.1)
    equal = synthesise(spectrum, WATER, duration=10800.0, seed=1, method="equal_energy", count=500)
    on_grid = WaveComponents(
        *(item[:: len(fourier) // 500][:500] for item in (fourier.omega, fourier.amplitude, fourier.phase)),
        *(item[:: len(fourier) // 500][:500] for item in (fourier.heading, fourier.wave_number)),
        WATER,
        frequency_step=fourier.frequency_step,
    )
    grid = np.arange(108_000) * 0.1

    def plain() -> np.ndarray:
        out = np.zeros(grid.size)
        for omega, amplitude, phase in zip(equal.omega, equal.amplitude, equal.phase):
            out += amplitude * np.cos(omega * grid - phase)
        return out

    slow = seconds(plain, 1)
    say("3 h at 0.1 s, 500 components, Fourier", seconds(lambda: on_grid.elevation(grid)), "numpy sum of cosines", slow)
    say(
        "3 h at 0.1 s, 500 components, recurrence", seconds(lambda: equal.elevation(grid)), "numpy sum of cosines", slow
    )
    transform = np.zeros(54_001, dtype=complex)
    least = seconds(lambda: np.fft.irfft(transform))
    say(
        f"3 h at 0.1 s, all {len(fourier)} components, Fourier",
        seconds(lambda: fourier.elevation(grid)),
        "the bare inverse transform",
        least,
    )
    say(
        "synthesis of the 3 h sea",
        seconds(lambda: synthesise(spectrum, WATER, duration=10800.0, seed=1, time_step=0.1)),
        "the bare inverse transform",
        least,
    )


def bench_kinematics() -> None:
    """Velocity and acceleration of 500 components at 200 nodes at one time."""
    sea = synthesise(spectra.jonswap(2.0, 8.0, 3.3), WATER, duration=3600.0, seed=1, method="equal_energy", count=500)
    x, z = np.linspace(0.0, 100.0, 200), np.linspace(-19.0, 0.0, 200)

    def plain() -> tuple[np.ndarray, np.ndarray]:
        k = sea.wave_number
        angle = k * x[:, None] - sea.omega * 3.3 + sea.phase
        horizontal = np.cosh(k * (z[:, None] + 20.0)) / np.sinh(k * 20.0) * sea.amplitude * sea.omega
        vertical = np.sinh(k * (z[:, None] + 20.0)) / np.sinh(k * 20.0) * sea.amplitude * sea.omega
        velocity = np.stack([(horizontal * np.cos(angle)).sum(1), (vertical * np.sin(angle)).sum(1)])
        rate = np.stack(
            [(sea.omega * horizontal * np.sin(angle)).sum(1), (-sea.omega * vertical * np.cos(angle)).sum(1)]
        )
        return velocity, rate

    own = seconds(lambda: sea.kinematics(3.3, x, 0.0, z, "constant"))
    say("500 components at 200 moving nodes, one time", own, "numpy", seconds(plain))
    time_axis = np.arange(36_000) * 0.1
    own = seconds(lambda: sea.velocity(time_axis, 0.0, 0.0, -5.0), 2)
    say(
        "velocity at a fixed node, 1 h at 0.1 s",
        own,
        "500 components by the kernel of moving nodes, scaled",
        36_000 / 200 * seconds(plain),
    )


def bench_waves() -> None:
    """Stream-function waves of given length: own solver against raschii, on the same random waves."""
    rng = np.random.default_rng(5)
    own_time = peer_time = 0.0
    own_failed = peer_failed = wrong = 0
    count = 60
    for _ in range(count):
        depth = float(10.0 ** rng.uniform(0.0, 2.0))
        length = depth * float(2.0 * math.pi / 10.0 ** rng.uniform(math.log10(0.15), 1.0))
        height = float(rng.uniform(0.05, 0.9)) * highest_steady_wave(length, depth)
        water = Water(depth, 1025.0, 9.81)
        start = time.perf_counter()
        try:
            own = nonlinear_wave("stream_function", height=height, wavelength=length, water=water, order=20)
        except ConvergenceError:
            own_failed, own = own_failed + 1, None
        middle = time.perf_counter()
        try:
            peer = nonlinear_wave(
                "stream_function", height=height, wavelength=length, water=water, order=20, solver="raschii"
            )
        except ConvergenceError:
            peer_failed, peer = peer_failed + 1, None
        peer_time += time.perf_counter() - middle
        own_time += middle - start
        if own and peer and abs(own.celerity / peer.celerity - 1.0) > 1e-6:
            wrong += 1
    say(
        f"{count} random stream-function waves of 20 components",
        own_time,
        "raschii",
        peer_time,
        not_found=own_failed,
        peer_not_found=peer_failed,
        disagreements=wrong,
    )


def bench_spectra() -> None:
    """A JONSWAP moment to rounding against adaptive quadrature."""
    from scipy.integrate import quad

    spectrum = spectra.jonswap(2.0, 8.0, 3.3)

    def adaptive() -> float:
        parts = ((0.15, 0.785398), (0.785398, 3.0), (3.0, 300.0))
        return sum(quad(lambda w: w * float(spectrum.density_at(w)), a, b, epsrel=1e-10)[0] for a, b in parts)

    say("first moment of JONSWAP", seconds(lambda: spectrum.moment(1)), "scipy quad, 1e-10", seconds(adaptive, 2))


if __name__ == "__main__":
    bench_dispersion()
    bench_elevation()
    bench_kinematics()
    bench_waves()
    bench_spectra()
