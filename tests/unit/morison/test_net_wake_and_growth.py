"""Shelter behind nets, growth on them, and meshes grouped into bars."""

from __future__ import annotations

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.morison.net_fouling import check_fouling, diameter_for_drag, foul, foul_by_name
from moyai.morison.net_law_names import Net, available_net_laws, net_law
from moyai.morison.net_wake import WAKE_LAWS, speed_through, wake_factor

VISCOSITY = 1.1e-6


def test_shelter_by_the_formulas():
    net = Net.from_solidity(2e-3, 0.25)
    law = net_law("loland")
    assert float(wake_factor("loland", law, net, speed=0.5, viscosity=VISCOSITY)) == pytest.approx(1 - 0.46 * 0.4150)
    turned = wake_factor("cheng", law, net, [0.0, math.pi / 3.0, math.pi / 2.0], speed=0.5, viscosity=VISCOSITY)
    assert turned == pytest.approx([(1.05 - 0.095) / 1.05, (0.55 - 0.095) / 0.55, 0.0])
    assert (wake_factor("none", law, net, [0.0, 1.0], speed=0.5, viscosity=VISCOSITY) == 1.0).all()
    with pytest.raises(InputError, match="loland, cheng, none"):
        wake_factor("blevins", law, net, speed=0.5, viscosity=VISCOSITY)


@pytest.mark.parametrize("name", WAKE_LAWS)
def test_shelter_lies_between_zero_and_one_and_ends_with_the_net(name):
    rng = np.random.default_rng(4)
    for _ in range(10):
        net = Net.from_solidity(1e-3, rng.uniform(0.05, 0.9))
        for law in available_net_laws():
            factor = wake_factor(
                name, net_law(law), net, rng.uniform(0, 7, 5), speed=rng.uniform(0.1, 1, 5), viscosity=1e-6
            )
            assert factor.shape == (5,)
            assert ((factor >= 0.0) & (factor <= 1.0)).all()
    bare = Net(1e-3, 1e3)
    assert float(wake_factor(name, net_law("loland"), bare, speed=0.5, viscosity=1e-6)) == pytest.approx(1, abs=1e-5)


def test_nets_in_a_row_shelter_one_another():
    net, law = Net.from_solidity(2e-3, 0.2), net_law("aarsnes")
    speeds = speed_through("loland", law, [net] * 3, [0.0] * 3, speed=0.8, viscosity=VISCOSITY)
    assert speeds == pytest.approx([0.8 * (1.0 - 0.46 * 0.26) ** k for k in range(4)], rel=1e-4)
    with pytest.raises(InputError, match="one each"):
        speed_through("loland", law, [net], [0.0, 0.0], speed=0.8, viscosity=VISCOSITY)


def test_growth_raises_solidity_mass_and_drag():
    net = Net(2e-3, 2e-2, solidity_listed=0.2)
    grown = foul(net, 1.5, 1100.0)
    assert grown.net.twine_diameter == pytest.approx(3e-3)
    assert grown.net.solidity == pytest.approx(0.3 - 0.0225)
    assert grown.net.listed == pytest.approx(0.2 * 0.2775 / 0.19)
    ring = math.pi / 4.0 * (9e-6 - 4e-6) * 100.0
    assert grown.added_mass_per_area == pytest.approx(1100.0 * ring)
    assert grown.added_weight_per_area(1025.0, 9.81) == pytest.approx(75.0 * 9.81 * ring)
    for law in available_net_laws():
        ratio = grown.drag_ratio(net_law(law), 0.0, 0.5, VISCOSITY)
        if law == "bi":
            assert ratio == 1.0
        else:
            assert ratio > 1.0
    assert foul(net, 1.0, 1100.0).added_mass_per_area == 0.0
    assert foul(net, 1.0, 1100.0).net == net


def test_growth_of_the_table():
    net = Net(2e-3, 2e-2)
    assert foul_by_name(net, "ns9415").net.twine_diameter == pytest.approx(3e-3)
    assert check_fouling("ns9415")[0].code == "net-fouling-unconfirmed"
    with pytest.raises(InputError, match="factor on drag"):
        foul_by_name(net, "swift_heavy")
    with pytest.raises(InputError, match="ns9415"):
        foul_by_name(net, "ns9451")


def test_diameter_for_a_drag_is_its_inverse():
    rng = np.random.default_rng(6)
    for _ in range(5):
        net, law = Net.from_solidity(rng.uniform(1e-3, 4e-3), rng.uniform(0.1, 0.25)), net_law("loland")
        asked = rng.uniform(1.1, 3.0)
        factor = diameter_for_drag(law, net, asked, speed=0.5, viscosity=VISCOSITY)
        assert foul(net, factor, 1.0).drag_ratio(law, 0.0, 0.5, VISCOSITY) == pytest.approx(asked, rel=1e-9)
    with pytest.raises(InputError, match="before the meshes close"):
        diameter_for_drag(net_law("bi"), net, 2.0, speed=0.5, viscosity=VISCOSITY)


@pytest.mark.parametrize(
    ("factor", "density", "words"),
    [(0.9, 1100.0, "at least 1"), (11.0, 1100.0, "closes the meshes"), (1.5, 0.0, "density"), (math.nan, 1.0, "least")],
)
def test_growth_that_cannot_be(factor, density, words):
    with pytest.raises(InputError, match=words):
        foul(Net(2e-3, 2e-2), factor, density)
    with pytest.raises(InputError, match="between 0 and 1"):
        foul(Net(2e-3, 2e-2, solidity_listed=0.5), 2.5, 1100.0)
