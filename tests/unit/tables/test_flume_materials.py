"""Materials of curtain models against the stiffness named for the flume tests."""

from __future__ import annotations

import pytest

from moyai.core.errors import InputError
from moyai.tables.flume_materials import available_flume_materials, flume_material


def test_stiffness_named_for_the_flume() -> None:
    """Steel wire of 0.5 mm 39 kN; film of 0.1 mm 2e4 to 1e5 N/m; nylon of 1 mm 1.6 kN, two of 0.2 mm 150 N together."""
    steel, nylon = flume_material("steel_wire"), flume_material("nylon_monofilament")
    film = flume_material("polyethylene_film")
    assert steel.line_stiffness(0.5e-3)[0] == pytest.approx(39e3, rel=0.01)
    assert film.sheet_stiffness(1e-4) == pytest.approx((2e4, 1e5))
    assert nylon.line_stiffness(1e-3)[0] == pytest.approx(1.6e3, rel=0.02)
    low, high = nylon.line_stiffness(0.2e-3)
    assert low < 75.0 < high
    assert film.sheet_submerged_weight(1e-4, 1000.0, 9.81) < 0.0
    assert steel.line_mass(0.5e-3) == pytest.approx(1.541e-3, rel=1e-3)


def test_every_material_is_ordered_and_says_where_it_comes_from() -> None:
    for name in available_flume_materials():
        entry = flume_material(name)
        assert 0.0 < entry.modulus[0] <= entry.modulus[1]
        assert 0.0 < entry.strength[0] <= entry.strength[1]
        assert entry.source
        assert not entry.confirmed
    with pytest.raises(InputError, match="did you mean 'nylon_monofilament'"):
        flume_material("nylon")
    with pytest.raises(InputError, match="diameter"):
        flume_material("steel_wire").line_stiffness(0.0)
