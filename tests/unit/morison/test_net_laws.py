"""Laws of net forces: exact values, limits and symmetries, ranges, bad input."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.morison.net_law_names import Net, NetLaw, available_net_laws, known_net_law, net_law, panel_force
from moyai.morison.net_laws.kristiansen_faltinsen import KristiansenFaltinsen, cylinder_drag
from moyai.morison.net_laws.matsubara import Matsubara
from moyai.morison.net_laws.twines import TwineLaw

VISCOSITY = 1.1e-6
NAMES = available_net_laws()


def random_net(rng: np.random.Generator, low: float = 0.1, high: float = 0.45) -> Net:
    return Net.from_solidity(rng.uniform(2e-4, 4e-3), rng.uniform(low, high))


def ahead(law: NetLaw, net: Net, speed: float = 0.5) -> float:
    return float(law.coefficients(0.0, speed, net, VISCOSITY)[0])


# --- exact values --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("solidity", "aarsnes", "loland"),
    [(0.15, 0.1683, 0.1802), (0.2, 0.2600, 0.2886), (0.25, 0.3866, 0.4150), (0.3, 0.5583, 0.5558)],
)
def test_polynomials_of_the_solidity(solidity, aarsnes, loland):
    net = Net.from_solidity(2e-3, solidity)
    assert ahead(net_law("aarsnes"), net) == pytest.approx(aarsnes, abs=6e-5)
    assert ahead(net_law("loland"), net) == pytest.approx(loland, abs=6e-5)


@pytest.mark.parametrize(
    ("law", "solidity", "lift"),
    # by hand from the polynomials as Aarsnes et al. (1990) and Loland (1991) are quoted, times sin 2t at 30 degrees
    [("aarsnes", 0.2, 0.0532), ("aarsnes", 0.3, 0.1251), ("loland", 0.2, 0.06792), ("loland", 0.3, 0.14448)],
)
def test_lift_polynomials_of_the_solidity(law, solidity, lift):
    net = Net.from_solidity(2e-3, solidity)
    found = float(net_law(law).coefficients(math.radians(30.0), 0.5, net, VISCOSITY)[1])
    assert found == pytest.approx(lift * math.sin(math.radians(60.0)), abs=6e-5)


@pytest.mark.parametrize(("reynolds", "drag"), [(100.0, 0.5292), (1000.0, 0.3909), (1e4, 0.4245)])
def test_screen_model_at_a_quarter(reynolds, drag):
    net = Net.from_solidity(2e-3, 0.25)
    speed = reynolds * VISCOSITY * 0.75 / 2e-3
    assert ahead(net_law("kristiansen_faltinsen"), net, speed) == pytest.approx(drag, abs=6e-5)


def test_drag_of_the_cylinder_follows_measured_cylinders():
    # Wieselsberger's curve as tabled in textbooks: read to about 5 %
    for reynolds, drag in ((40.0, 1.62), (100.0, 1.40), (300.0, 1.22), (1000.0, 1.0), (3000.0, 0.95), (1e4, 1.10)):
        assert float(cylinder_drag(reynolds)) == pytest.approx(drag, rel=0.06)
    assert float(cylinder_drag(100.0)) == pytest.approx(1.36, abs=5e-3)
    assert float(cylinder_drag(1000.0)) == pytest.approx(1.01, abs=6e-3)
    assert float(cylinder_drag(1e6)) == float(cylinder_drag(1e4))


def test_lift_of_the_screen_model_by_hand():
    net = Net.from_solidity(1.5e-3, 0.28)
    drag, lift = net_law("kristiansen_faltinsen").coefficients([0.0, math.pi / 4.0], 0.4, net, VISCOSITY)
    normal = 0.5 * drag[0]
    tangential = math.pi / 4.0 * 4.0 * normal / (8.0 + normal)
    assert lift[1] == pytest.approx((normal - tangential) / math.sqrt(2.0), rel=1e-12)
    other = net_law("kristiansen_faltinsen", normal_at_45="solidity").coefficients(math.pi / 4, 0.4, net, VISCOSITY)[1]
    assert 0.85 < float(other) / float(lift[1]) < 0.95


def test_power_law_of_the_wire_nets():
    law = Matsubara()
    assert float(law.twine_drag(84.0)) == pytest.approx(2.0, abs=5e-3)
    assert pytest.approx(0.6, abs=2e-3) == 9.84 * 2370.0**-0.36
    for reynolds, drag in ((100.0, 1.87), (500.0, 1.05), (1000.0, 0.82)):
        assert float(law.twine_drag(reynolds)) == pytest.approx(drag, abs=6e-3)
    assert float(law.twine_drag(2370.0)) == float(law.twine_drag(1800.0)) > 0.6
    assert float(law.twine_drag(0.0)) == float(law.twine_drag(11.0)) == 3.0
    assert float(Matsubara(cap=1.5).twine_drag(84.0)) == 1.5
    # continuous where the cap ends
    edge = (9.84 / 3.0) ** (1.0 / 0.36)
    assert float(law.twine_drag(edge * (1.0 + 1e-9))) == pytest.approx(3.0, rel=1e-8)


def test_listed_and_geometric_solidity_are_kept_apart():
    net = Net.from_aperture(1.4e-3, 11.3e-3, solidity_listed=0.22)
    assert net.solidity == pytest.approx(0.208, abs=5e-4)
    speed = 0.3
    level = float(Matsubara().twine_drag(speed * net.twine_diameter / VISCOSITY))
    assert ahead(net_law("matsubara"), net, speed) == pytest.approx(0.22 * level)
    assert ahead(net_law("matsubara", solidity="geometric"), net, speed) == pytest.approx(net.solidity * level)
    # the listed one changes no modern law, the measured one does not change the paper's
    other = dataclasses.replace(net, solidity_listed=0.5)
    measured = dataclasses.replace(net, solidity_measured=0.26)
    for name in NAMES:
        law = net_law(name)
        if name != "matsubara":
            assert ahead(law, other, speed) == ahead(law, net, speed)
    assert ahead(net_law("matsubara"), measured, speed) == ahead(net_law("matsubara"), net, speed)
    plain = Net.from_solidity(1e-3, 0.26)
    assert ahead(net_law("loland"), measured, speed) == pytest.approx(ahead(net_law("loland"), plain, speed))


def test_balash_uses_the_cube_of_the_cosine():
    net = Net.from_solidity(2e-3, 0.2)
    drag, lift = net_law("balash").coefficients([0.0, math.pi / 3.0], 0.5, net, VISCOSITY)
    assert drag[1] == pytest.approx(drag[0] / 8.0)
    assert (lift == 0.0).all()
    reynolds = 0.5 * 2e-3 / VISCOSITY
    assert drag[0] == pytest.approx((1.0 + 10.0 * reynolds ** (-2.0 / 3.0)) * (0.12 - 0.148 + 8.03 * 0.04))


def test_angles_of_bi():
    drag, lift = net_law("bi").coefficients(np.radians([0.0, 45.0, 90.0]), 1.0, Net(2e-3, 2e-2), VISCOSITY)
    assert drag == pytest.approx([0.7194, 0.04 + 0.4921 * math.sqrt(0.5) + 0.1873 * 0.5, 0.04])
    assert lift == pytest.approx([0.0, 0.2469, 0.0])


@pytest.mark.parametrize(
    ("name", "reynolds", "value"),
    [
        ("takagi", 100.0, 10.0**0.7 * 100.0**-0.3),
        ("takagi", 500.0, 1.2),
        ("choo_casarella", 10.0, 1.45 + 8.55 * 10.0**-0.9),
        ("choo_casarella", 100.0, 1.5),
        ("bessonneau", 700.0, 1.2),
        ("wan", 700.0, 1.3),
    ],
)
def test_twines_square_to_the_flow(name, reynolds, value):
    net = Net.from_solidity(1.7e-3, 0.21)
    assert ahead(net_law(name), net, reynolds * VISCOSITY / 1.7e-3) == pytest.approx(value * 0.21)


def test_milne_by_its_meshes():
    ratio = 0.1
    for knotted, value in ((False, 1.0 + 2.73 * ratio + 3.12 * ratio**2), (True, 1 + 3.77 * ratio + 9.37 * ratio**2)):
        net = Net(2e-3, 2e-2, knotted=knotted)
        assert ahead(net_law("milne"), net) == pytest.approx(value * net.solidity)


def test_creeping_branch_meets_the_next():
    law = net_law("choo_casarella")
    assert isinstance(law, TwineLaw)
    net = Net(1e-3, 1e-2)
    for corner in (1.0, 30.0):
        low, high = (float(law.normal_drag(corner * factor, net)) for factor in (1.0 - 1e-9, 1.0 + 1e-9))
        assert high == pytest.approx(low, rel=0.02)


# --- limits and symmetries -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", NAMES)
def test_lift_vanishes_along_and_across(name):
    rng = np.random.default_rng(3)
    for _ in range(5):
        drag, lift = net_law(name).coefficients(
            [0.0, math.pi / 2.0, math.pi, -math.pi / 2.0], rng.uniform(0.1, 2.0), random_net(rng), VISCOSITY
        )
        assert (lift == 0.0).all()
        assert drag[0] == pytest.approx(drag[2], rel=1e-12)
        assert drag[1] == pytest.approx(drag[3], rel=1e-12)
        assert drag[0] > drag[1] >= 0.0


@pytest.mark.parametrize("name", NAMES)
def test_reversed_current_reverses_the_force(name):
    rng = np.random.default_rng(5)
    law = net_law(name)
    for _ in range(6):
        net, normal, flow = random_net(rng), rng.normal(size=3), rng.normal(size=(4, 3))
        kw = {"area": 2.0, "density": 1025.0, "viscosity": VISCOSITY}
        force = panel_force(law, net, normal, flow, **kw)
        assert panel_force(law, net, normal, -flow, **kw) == pytest.approx(-force, rel=1e-12, abs=1e-12)
        assert panel_force(law, net, -3.0 * normal, flow, **kw) == pytest.approx(force, rel=1e-12, abs=1e-12)
        # nothing out of the plane of flow and normal, power never delivered by the net
        out = np.cross(flow, normal)
        assert np.abs(np.sum(force * out, axis=1)).max() < 1e-9 * np.abs(force).max()
        assert (np.sum(force * flow, axis=1) >= 0.0).all()
        # the panel is pushed downstream along its normal
        assert (np.sign(force @ normal) == np.sign(flow @ normal)).all()


@pytest.mark.parametrize("name", NAMES)
def test_no_solidity_leaves_the_stated_skin(name):
    law = net_law(name)
    net = Net(1e-3, 1e3)
    drag = law.coefficients([0.0, math.pi / 2.0], 0.5, net, VISCOSITY)[0]
    reynolds = 0.5 * 1e-3 / VISCOSITY
    if name in ("loland", "aarsnes"):
        assert drag == pytest.approx([0.0, 0.04], abs=1e-5)
    elif name == "bi":
        assert drag == pytest.approx([0.7194, 0.04])
    elif name == "balash":
        assert drag == pytest.approx([0.12 * (1.0 + 10.0 * reynolds ** (-2.0 / 3.0)), 0.0], rel=1e-4)
    else:
        assert np.abs(drag).max() < 1e-5


def test_panel_force_is_the_sum_of_its_twines():
    """Random flows on two crossed twines, each by cross flow, in three dimensions."""
    rng = np.random.default_rng(11)
    for _ in range(20):
        net = random_net(rng)
        azimuth = float(rng.choice([0.0, math.pi / 4.0]))
        law = net_law("bessonneau", azimuth=azimuth)
        angle, speed = rng.uniform(0.01, 1.5), rng.uniform(0.1, 2.0)
        flow = speed * np.array([math.cos(angle), math.sin(angle), 0.0])
        force = np.zeros(3)
        for turn in (azimuth, azimuth + math.pi / 2.0):
            twine = np.array([0.0, math.cos(turn), math.sin(turn)])
            along = (flow @ twine) * twine
            across = flow - along
            force += 0.5 * net.solidity * 1.2 * np.linalg.norm(across) * across
            force += 0.5 * net.solidity * 0.1 * np.linalg.norm(along) * along
        got = panel_force(law, net, [1.0, 0.0, 0.0], flow, area=1.0, density=2.0, viscosity=VISCOSITY)
        assert got == pytest.approx(force, rel=1e-9, abs=1e-9)


def test_friction_along_a_twine_is_proportional_to_the_speed():
    """Choo and Casarella's friction pi mu (0.55 Re^1/2 + 0.084 Re^2/3) u_t per length, by hand at 45 degrees."""
    net, speed = Net.from_solidity(2e-3, 0.2), 0.6
    law = net_law("choo_casarella")
    across = along = speed * math.sqrt(0.5)
    reynolds = across * 2e-3 / VISCOSITY
    friction = math.pi * VISCOSITY * 1000.0 * (0.55 * reynolds**0.5 + 0.084 * reynolds ** (2 / 3)) * along
    pressure = 0.5 * 1000.0 * 2e-3 * across**2 * (1.1 + 4.0 * reynolds**-0.5)
    level = 0.5 * 1000.0 * 2e-3 * speed**2 * (1.1 + 4.0 * (speed * 2e-3 / VISCOSITY) ** -0.5)
    drag = 0.1 / 2e-3 * ((friction + pressure) * math.sqrt(0.5) + level)
    got = float(law.coefficients(math.pi / 4.0, speed, net, VISCOSITY)[0]) * 0.5 * 1000.0 * speed**2
    assert got == pytest.approx(drag, rel=1e-12)


@pytest.mark.parametrize("name", NAMES)
def test_coefficients_are_finite_at_rest_and_broadcast(name):
    drag, lift = net_law(name).coefficients(
        np.linspace(0.0, math.pi, 7)[:, None], np.array([0.0, 1e-9, 0.3, 50.0]), Net(1e-3, 8e-3), VISCOSITY
    )
    assert drag.shape == lift.shape == (7, 4)
    assert np.isfinite(drag).all()
    assert np.isfinite(lift).all()
    assert (drag >= 0.0).all()


# --- range and bad input -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", NAMES)
def test_check_names_number_and_limit(name):
    law = net_law(name)
    low, high = law.reynolds_range
    net = Net.from_solidity(1e-3, 0.25 if law.solidity_range[1] > 0.25 else 0.2)
    scale = VISCOSITY / 1e-3 * ((1.0 - net.solidity) if name == "kristiansen_faltinsen" else 1.0)
    inside = (max(low, 1.0) * 1.01 * scale, min(high, 1e6) * 0.99 * scale)
    assert law.check(net, inside, VISCOSITY) == ()
    if low > 0.0:
        (notice,) = law.check(net, (0.5 * low * scale, inside[1]), VISCOSITY)
        assert notice.value == pytest.approx(0.5 * low)
        assert notice.limit == low
        assert f"{0.5 * low:.4g}" in notice.message
    if math.isfinite(high):
        (notice,) = law.check(net, (inside[0], 2.0 * high * scale), VISCOSITY)
        assert notice.value == pytest.approx(2.0 * high)
    dense = Net.from_solidity(1e-3, 0.85)
    found = [notice for notice in law.check(dense, inside, VISCOSITY) if notice.code == "net-solidity-range"]
    assert len(found) == 1
    assert found[0].limit == law.solidity_range[1]


@pytest.mark.parametrize("solidity", [-0.1, 0.0, 1.0, 22.0, math.nan])
def test_solidity_outside_zero_to_one_is_refused(solidity):
    with pytest.raises(InputError, match="between 0 and 1"):
        Net(1e-3, 1e-2, solidity_listed=solidity)
    with pytest.raises(InputError, match="between 0 and 1"):
        Net(1e-3, 1e-2, solidity_measured=solidity)
    with pytest.raises(InputError, match="between 0 and 1"):
        Net.from_solidity(1e-3, solidity)


def test_percentages_and_closed_meshes_are_explained():
    with pytest.raises(InputError, match=r"0\.22"):
        Net(1e-3, 1e-2, solidity_listed=22.0)
    with pytest.raises(InputError, match="bar length"):
        Net(5e-3, 4e-3)
    with pytest.raises(InputError, match="knots"):
        Net(5e-3, 9e-3, knotted=True)
    with pytest.raises(InputError, match="twine_diameter"):
        Net(-1e-3, 4e-3)


def test_unknown_names_and_options():
    with pytest.raises(InputError, match="did you mean 'loland'"):
        net_law("lolland")
    with pytest.raises(InputError, match="no option 'cap'"):
        net_law("loland", cap=2.0)
    for options in ({"cap": 0.0}, {"tangential_share": 1.5}, {"solidity": "true"}):
        with pytest.raises(InputError):
            net_law("matsubara", **options)
    with pytest.raises(InputError, match="normal_at_45"):
        KristiansenFaltinsen(normal_at_45="half")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="azimuth"):
        net_law("wan", azimuth=math.nan)
    with pytest.raises(InputError, match="kinematic_viscosity"):
        net_law("wan").coefficients(0.0, 1.0, Net(1e-3, 1e-2), 0.0)
    with pytest.raises(InputError, match="finite"):
        net_law("wan").coefficients(math.nan, 1.0, Net(1e-3, 1e-2), 1e-6)
    with pytest.raises(InputError, match="normal"):
        panel_force(net_law("wan"), Net(1e-3, 1e-2), [0, 0, 0], [1, 0, 0], area=1.0, density=1e3, viscosity=1e-6)


@pytest.mark.parametrize("name", NAMES)
def test_every_law_states_its_source_and_ranges(name):
    law = net_law(name)
    assert law.source
    assert law.skin
    assert law.outside
    assert law.reynolds_range[0] < law.reynolds_range[1]
    assert 0.0 <= law.solidity_range[0] < law.solidity_range[1] <= 1.0


def test_solidity_formulas():
    rng = np.random.default_rng(8)
    for _ in range(10):
        ratio, pitch = rng.uniform(0.01, 0.9), rng.uniform(1e-3, 5e-2)
        net = Net(ratio * pitch, pitch)
        # shaded share = 1 - open share
        assert net.solidity == pytest.approx(1.0 - (net.aperture / pitch) ** 2)
        assert Net.from_solidity(net.twine_diameter, net.solidity).mesh_pitch == pytest.approx(pitch)
        assert net.solidity_doubled - net.solidity == pytest.approx(ratio**2)


def test_power_law_of_ones_own():
    """The law that an identification gives goes into a case as it is printed."""
    net = Net.from_aperture(1.4e-3, 11.3e-3, solidity_listed=0.22)
    written = net_law("9.84 Re^-0.36 from 84 to 1800")
    angles, speeds = np.linspace(0.0, math.pi, 9)[:, None], np.array([0.0, 0.01, 0.3, 2.0])
    for got, want in zip(
        written.coefficients(angles, speeds, net, VISCOSITY),
        net_law("matsubara").coefficients(angles, speeds, net, VISCOSITY),
    ):
        assert got == pytest.approx(want, rel=1e-12)
    low, high = written.check(net, (0.01, 5.0), VISCOSITY)
    assert (low.limit, high.limit) == (84.0, 1800.0)
    plain = net_law("11.4Re^-0.40", cap=9.0, solidity="geometric", tangential_share=0.0)
    assert plain.check(net, (1e-3, 5.0), VISCOSITY) == ()
    assert ahead(plain, net, 0.5) == pytest.approx(11.4 * (0.5 * 1.4e-3 / VISCOSITY) ** -0.40 * net.solidity)
    assert ahead(net_law("1.2 Re^-0"), net) == pytest.approx(1.2 * 0.22)
    assert known_net_law("11.4 Re^-0.4")
    assert not known_net_law("11.4 Re^0.4")
    for text, words in (("0 Re^-0.4", "factor"), ("5 Re^-1.4", "exponent"), ("5 Re^-0.4 from 90 to 20", "rises")):
        with pytest.raises(InputError, match=words):
            net_law(text)
    with pytest.raises(InputError, match="such as"):
        net_law("11.4 Re-0.4")


@pytest.mark.parametrize(("knotted", "shaded"), [(False, 0.19), (True, 0.205)])
def test_solidity_of_the_geometry_is_what_twines_and_knots_shade(knotted: bool, shaded: float) -> None:
    """d/p = 0.1: two twines less where they cross, 0.2 - 0.01; a knot shades half a d^2 more, 0.2 + 0.005."""
    assert Net(2e-3, 2e-2, knotted=knotted).solidity_geometric == pytest.approx(shaded, rel=1e-12)
