"""Coefficients of a file are brought to the density of the site; a file for another depth is refused."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.sea.water import Water
from moyai.structures.breakwater.coefficients_file import planar_coefficients


def of_water(file, water: Water):
    """Return the planar coefficients of the ellipsoid in a water, and what speaks against them."""
    given = SimpleNamespace(
        program="capytaine",
        path=file,
        options={"sea": "head", "origin": (0.0, 0.0), "reference_point": (0.0, 0.0, 0.0)},
    )
    problem = SimpleNamespace(
        breakwater=SimpleNamespace(length=10.0, coefficients_file=given),
        environment=SimpleNamespace(water_levels=(("SWL", 0.0),), water_at=lambda level: water),
    )
    of_unit, notices = planar_coefficients(problem)
    return of_unit(SimpleNamespace(water=water, centre=np.zeros(2))), notices


@pytest.mark.shared_data
def test_coefficients_follow_the_density_of_the_site(shared_data):
    import xarray as xr

    file = shared_data / "bem" / "ellipsoid_capytaine" / "ellipsoid_hydrodynamics.nc"

    with xr.open_dataset(file) as stored:
        depth, gravity = float(stored["water_depth"]), float(stored["g"])
    light, _ = of_water(file, Water(depth, 1000.0, gravity))
    heavy, _ = of_water(file, Water(depth, 1025.0, gravity))
    for name in ("added_mass", "radiation_damping"):
        assert heavy[name].values == pytest.approx(1.025 * light[name].values, rel=1e-12, abs=1e-9)
    with pytest.raises(InputError, match="the coefficients hold for a depth of"):
        of_water(file, Water(5.0, 1025.0, gravity))
