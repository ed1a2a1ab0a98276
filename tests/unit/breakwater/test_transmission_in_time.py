"""Transmission of an irregular sea in time: the waves that pass a body held fixed, and those that its motion makes."""

from types import SimpleNamespace

import numpy as np
import pytest

from moyai.floating import Hydrodynamics
from moyai.structures.breakwater.time.irregular import _transmission

OMEGA = np.linspace(0.3, 3.0, 28)


def test_waves_that_pass_and_waves_that_motions_make_add_at_their_frequency():
    """Two waves of known frequencies on a body whose coefficients are straight lines over frequency."""
    time = np.arange(0.0, 1200.0, 0.1)
    waves = ((0.8, 0.5), (1.4, 0.3))
    # sway at a quarter period behind each wave
    sway = {0.8: 0.2 + 0.1j, 1.4: -0.3j}
    elevation = sum(a * np.cos(w * time) for w, a in waves)
    position = np.zeros((len(time), 3))
    position[:, 0] = sum((a * sway[w] * np.exp(-1j * w * time)).real for w, a in waves)
    ones = np.ones(len(OMEGA))
    radiated = np.zeros((len(OMEGA), 3, 2), dtype=complex)
    radiated[:, 0] = np.array([-0.4, 0.4]) * OMEGA[:, None] ** 0
    hydro = Hydrodynamics(
        OMEGA, *[np.multiply.outer(ones, np.eye(3))] * 2, np.zeros((len(OMEGA), 1, 3), dtype=complex),
        np.zeros(1), ("sway", "heave", "roll"), reflection_coefficient=(0.3 * OMEGA - 0.1j)[:, None],
        transmission_coefficient=(1.0 - 0.3 * OMEGA + 0.2j)[:, None], radiated_wave=radiated,
    )  # fmt: skip
    run = SimpleNamespace(time=time, elevation=elevation, position=position)
    sea = SimpleNamespace(heading=0.0, spectrum=SimpleNamespace(quantile=lambda share: np.where(share < 0.5, 0.4, 2.5)))
    found = _transmission(SimpleNamespace(hydro=SimpleNamespace(whole=lambda heading: hydro)), run, sea, ramp=50.0)
    energy = sum(a**2 for _, a in waves)
    velocity = {w: -1j * w * sway[w] for w, _ in waves}
    passed = sum(abs(a * (1.0 - 0.3 * w + 0.2j + 0.4 * velocity[w])) ** 2 for w, a in waves)
    back = sum(abs(a * (0.3 * w - 0.1j - 0.4 * velocity[w])) ** 2 for w, a in waves)
    assert found["transmission_coefficient"][1] == pytest.approx(np.sqrt(passed / energy), rel=1e-3)
    assert found["reflection_coefficient"][1] == pytest.approx(np.sqrt(back / energy), rel=1e-3)
