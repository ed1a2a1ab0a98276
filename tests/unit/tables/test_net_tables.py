"""Tables of nets: rows of the paper held against each other, materials, growth."""

from __future__ import annotations

import math

import pytest

from moyai.core.errors import InputError
from moyai.tables.nets import (
    available_net_materials,
    matsubara_net,
    matsubara_nets,
    net_fouling,
    net_material,
)
from moyai.tables.reader import read_table


def test_geometric_solidities_of_the_ten_nets():
    shares = [row.solidity_geometric for row in matsubara_nets()]
    assert shares == pytest.approx([0.208, 0.236, 0.257, 0.237, 0.290, 0.323, 0.355, 0.435, 0.459, 0.569], abs=6e-4)
    assert [row.name for row in matsubara_nets()] == list("ABCDEFGHIJ")


def test_two_rows_do_not_follow_their_columns():
    found = {row.name: {notice.code for notice in row.check()} for row in matsubara_nets()}
    assert {name for name, codes in found.items() if codes} == {"D", "J"}
    assert {row.name: row.flag for row in matsubara_nets() if row.flag} == {"D": "solidity", "J": "projected_area"}
    # with the believed value in place of the printed one the row follows the others
    assert matsubara_net("D").believed == pytest.approx(matsubara_net("D").solidity_doubled, abs=5e-4)
    area = matsubara_net("J").believed / matsubara_net("J").solidity
    assert 0.065 < area < 0.071
    assert all(math.isnan(row.believed) for row in matsubara_nets() if not row.flag)


def test_materials_and_growth():
    for name in available_net_materials():
        material = net_material(name)
        assert 0.0 < material.modulus[0] <= material.modulus[1]
        assert 0.0 < material.strength[0] <= material.strength[1]
        assert 900.0 <= material.density <= 8600.0
    for record in read_table("net_fouling.csv"):
        entry = net_fouling(record["name"])
        # one factor each, never both
        assert math.isnan(entry.diameter_factor) != math.isnan(entry.drag_factor)
    assert net_fouling("ns9415").diameter_factor == 1.5
    assert not net_fouling("ns9415").confirmed


def test_unknown_names_are_reported():
    with pytest.raises(InputError, match="A, B, C"):
        matsubara_net("K")
    with pytest.raises(InputError, match="did you mean 'nylon'"):
        net_material("nilon")
    with pytest.raises(InputError, match="ns9415"):
        net_fouling("ns")
