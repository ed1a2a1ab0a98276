"""Infinite-frequency added mass by causality, and files computed for another water."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.interop.coefficients import assemble
from moyai.interop.limits import complete_limits, match_site
from moyai.sea.water import Water


def causal_dataset(rng, count=200, highest=12.0, depth=math.inf):
    """Two coupled motions whose memory is (1 - a t) exp(-a t): A and B are exact transforms, B(0) = 0 and B >= 0."""
    omega = np.linspace(highest / count, highest, count)
    mixing = rng.normal(size=(2, 2))
    infinite = mixing @ mixing.T + np.eye(2)
    added, damping = np.zeros((2, count, 2, 2))
    for _ in range(2):
        vector = rng.normal(size=2)
        shape = np.outer(vector, vector)
        a = rng.uniform(0.3, 1.5)
        transform = -1j * omega / (a - 1j * omega) ** 2
        damping += transform.real[:, None, None] * shape
        added -= (transform.imag / omega)[:, None, None] * shape
    added += infinite
    dataset = assemble(
        program="exact",
        source="exact",
        dofs=("Sway", "Heave"),
        omega=omega,
        added_mass=added,
        radiation_damping=damping,
        wave_direction=np.array([0.0]),
        forces={"excitation_force": np.ones((count, 1, 2), dtype=complex)},
        density=1000.0,
        gravity=9.81,
        water_depth=depth,
        reference_point=(0.0, 0.0, 0.0),
    )
    return dataset, infinite


@pytest.mark.parametrize("seed", range(5))
def test_infinite_frequency_of_a_causal_body(seed):
    dataset, infinite = causal_dataset(np.random.default_rng(seed))
    found = complete_limits(dataset)["infinite_frequency_added_mass"]
    scale = np.sqrt(np.outer(np.diag(infinite), np.diag(infinite)))
    # Trapezoidal rule with 200 frequencies
    assert np.max(np.abs(found.values - infinite) / scale) < 5e-3
    assert found.attrs["spread"] < 5e-3
    assert found.attrs["units"]


def test_too_few_frequencies_are_refused():
    dataset, _ = causal_dataset(np.random.default_rng(0))
    with pytest.raises(InputError, match="5 frequencies"):
        complete_limits(dataset.isel(omega=slice(5)))
    given = dataset.assign(infinite_frequency_added_mass=dataset["added_mass"].isel(omega=-1, drop=True))
    assert complete_limits(given) is given


def test_density_of_the_site_and_its_depth():
    dataset, _ = causal_dataset(np.random.default_rng(1), depth=20.0)
    sea, notices = match_site(dataset, Water(20.0, density=1025.0, gravity=9.81))
    assert notices == ()
    for name in ("added_mass", "radiation_damping", "excitation_force"):
        np.testing.assert_allclose(sea[name], 1.025 * dataset[name])
    assert float(sea["rho"]) == 1025.0
    _, notices = match_site(dataset, Water(21.0, density=1000.0, gravity=9.80))
    assert [notice.code for notice in notices] == ["coefficients-gravity", "coefficients-depth"]
    with pytest.raises(InputError, match="20 m"):
        match_site(dataset, Water(10.0, density=1000.0, gravity=9.81))
    # Only frequencies that do not feel either bottom
    _, notices = match_site(dataset.sel(omega=slice(3.0, None)), Water(10.0, density=1000.0, gravity=9.81))
    assert notices == ()
