"""A single value comes back as a float, not as a scalar or an empty array of numpy."""

import numpy as np
import pytest

from moyai.core.single import plain
from moyai.core.validity import IdentityCheck
from moyai.mooring import solve_catenary
from moyai.sea import current
from moyai.series import fit


@pytest.mark.parametrize("value", [2.0, np.float64(2.0), np.array(2.0), np.int64(2)])
def test_plain(value):
    assert type(plain(value)) is float and plain(value) == 2.0
    assert plain([value]).shape == (1,)


def test_a_line_gives_floats_and_many_lines_arrays():
    names = ["horizontal_tension", "vertical_tension_fairlead", "vertical_tension_anchor", "grounded_length"]
    names += ["horizontal_tension_anchor", "residual", "tension_fairlead", "tension_anchor", "anchor_uplift_angle"]
    one, many = (solve_catenary(x, 10.0, 55.0, 5e8, 1000.0) for x in (50.0, [50.0]))
    for name in names:
        assert type(getattr(one, name)) is float
        assert getattr(many, name).shape == (1,) and getattr(many, name)[0] == getattr(one, name)


def test_other_numbers_are_floats():
    profile = current.uniform(0.5, 0.0)
    assert type(profile.speed(-1.0)) is float and type(profile.component(-1.0, 0.3)) is float
    assert profile.speed([-1.0, -2.0]).shape == (2,)
    assert type(IdentityCheck("any", np.float64(1.0), 1.0).value) is float
    fitted = fit(np.random.default_rng(1).gumbel(100.0, 10.0, 50), "gumbel")
    assert {type(getattr(fitted, name)) for name in ("location", "scale", "shape", "log_likelihood")} == {float}
