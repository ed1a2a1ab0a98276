"""Froude scaling with the Cauchy number kept: whole solvers give the same answer in both sizes, to rounding."""

from __future__ import annotations

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.design.similarity import (
    Scale,
    cauchy_number,
    check_model,
    mass_to_add,
    match_stretch,
    scale_quantities,
    scale_water,
)
from moyai.mooring.catenary import solve_catenary
from moyai.potential import shapes
from moyai.sea import dispersion
from moyai.sea.current import power_law
from moyai.sea.water import Water
from moyai.structures.curtain.scaling import scale_curtain
from moyai.structures.curtain.seas.anchor_energy import EnergyModel
from moyai.structures.curtain.seas.squared_velocity import squared_velocity
from moyai.structures.curtain.statics.drag import constant_drag
from moyai.structures.curtain.statics.hanging import FloatLine, HangingCurtain, solve_statics
from moyai.structures.curtain.statics.section import Skirt

SEA = Water(12.0, 1025.0, 9.81)


@pytest.mark.parametrize(
    ("unit", "power"),
    [("N", 3), ("N/m", 2), ("m", 1), ("s", 0.5), ("kg", 3), ("kg/m", 2), ("Pa", 1), ("N m2", 5), ("kg m2", 5),
     ("m/s", 0.5), ("m/s2", 0), ("rad/s", -0.5), ("N s/m", 2.5), ("", 0), ("rad", 0), ("kg/m3", 0)],
)  # fmt: skip
def test_powers_of_the_length_ratio(unit: str, power: float) -> None:
    rng = np.random.default_rng(3)
    for ratio in 10.0 ** rng.uniform(-3, 3, 20):
        scale = Scale(float(ratio), 1.0, 1.0)
        assert scale.ratio(unit) == pytest.approx(ratio**power, rel=1e-14)
        assert scale.to_prototype(scale.to_model(7.3, unit), unit) == pytest.approx(7.3, rel=1e-15)


@pytest.mark.parametrize(
    ("unit", "ratio"),
    [
        ("m", lambda s: s.length), ("s", lambda s: math.sqrt(s.length / s.gravity)),
        ("m/s", lambda s: math.sqrt(s.length * s.gravity)), ("m/s2", lambda s: s.gravity),
        ("kg", lambda s: s.density * s.length**3), ("N", lambda s: s.density * s.gravity * s.length**3),
        ("N/m", lambda s: s.density * s.gravity * s.length**2), ("Pa", lambda s: s.density * s.gravity * s.length),
        ("kg m2", lambda s: s.density * s.length**5), ("", lambda s: 1.0),
    ],
)  # fmt: skip
def test_ratios_are_those_by_hand(unit, ratio) -> None:
    """Froude: speeds go with sqrt(g L), forces with rho g L^3, in a gravity of its own as well."""
    scale = Scale(7.3, 1.025, 1.31)
    assert scale.ratio(unit) == pytest.approx(ratio(scale), rel=1e-12)


@pytest.mark.parametrize("length", [10.0, 25.0, 50.0])
@pytest.mark.parametrize(("density", "gravity"), [(1.0, 1.0), (1.025, 1.0), (1.025, 0.05)])
@pytest.mark.parametrize("toe", ["free", "held"])
def test_curtain_statics_scale_to_rounding(length: float, density: float, gravity: float, toe: str) -> None:
    scale = Scale(length, density, gravity)
    curtain = HangingCurtain(
        20.0, 23.0, Skirt(6.0, 5.0, 200.0, 1e5), FloatLine(980.0, 100.0, 100.0), 3e6, 2e6, toe, 0.3,
        constant_drag(1.4, (1.0, 1.0), "test"), "normal_velocity",
    )  # fmt: skip
    small_sea = scale_water(SEA, scale)
    large = solve_statics(curtain, power_law(0.3, 1 / 7, 0.2, SEA), 0.2, 0.0, SEA, passing_fraction=1.0)
    current = power_law(scale.to_model(0.3, "m/s"), 1 / 7, 0.2, small_sea)
    small = solve_statics(scale_curtain(curtain, scale), current, 0.2, 0.0, small_sea, passing_fraction=1.0)
    for name, unit in (
        ("anchor_horizontal_tension", "N"),
        ("upper_tension", "N"),
        ("float_reserve", "N/m"),
        ("toe_gap", "m"),
        ("toe_speed", "m/s"),
    ):
        assert scale.to_prototype(getattr(small, name), unit) == pytest.approx(getattr(large, name), rel=1e-9), name
    assert small.plan.strain == pytest.approx(large.plan.strain, rel=1e-9)


def test_closed_form_of_the_waves_scales_to_rounding() -> None:
    """Energy model and squared velocity at random sizes: S^3 on the tension to 1e-13."""
    rng = np.random.default_rng(5)
    for _ in range(50):
        scale = Scale(10.0 ** rng.uniform(0.3, 2), rng.uniform(0.9, 1.1), 1.0)
        height, period, speed = rng.uniform(0.5, 3), rng.uniform(4, 9), rng.uniform(0, 0.3)
        model = EnergyModel(0.2, 500.0, 9e5, 2.0, 1.0, 1.0)
        small = EnergyModel(0.2, scale.to_model(500.0, "kg"), scale.to_model(9e5, "N/m"), 2.0, 1.0, 1.0)
        flume = scale_water(SEA, scale)
        h, t, u = (scale.to_model(v, unit) for v, unit in ((height, "m"), (period, "s"), (speed, "m/s")))
        large_tension = model.tension(model.float_speed(height, period, speed, SEA), 5e3)
        small_tension = small.tension(small.float_speed(h, t, u, flume), scale.to_model(5e3, "N"))
        assert scale.to_prototype(float(small_tension), "N") == pytest.approx(float(large_tension), rel=1e-12)
        large_square = squared_velocity(height, period, speed, 5.0, SEA)
        small_square = squared_velocity(h, t, u, scale.to_model(5.0, "m"), flume)
        assert scale.to_prototype(float(small_square), "m2/s2") == pytest.approx(float(large_square), rel=1e-12)


def test_mooring_and_breakwater_scale() -> None:
    """Chain of a breakwater, its displacement, and the wave that excites it."""
    scale = Scale(26.0, 1.025, 1.0)
    line = {"x": (60.0, "m"), "z": (8.0, "m"), "l": (62.0, "m"), "EA": (3e7, "N"), "w": (500.0, "N/m")}
    rows = {row.name: row for row in scale_quantities(line, scale)}
    large = solve_catenary(*(row.prototype for row in rows.values()))
    small = solve_catenary(*(row.model for row in rows.values()))
    assert scale.to_prototype(float(small.horizontal_tension), "N") == pytest.approx(
        float(large.horizontal_tension), rel=1e-9
    )
    area = shapes.rectangle(10.0, 4.0).immersed(2.9).area
    assert scale.to_model(area, "m2") == pytest.approx(shapes.rectangle(10 / 26, 4 / 26).immersed(2.9 / 26).area)
    flume = scale_water(SEA, scale)
    number = dispersion.wave_number(scale.to_model(1.1, "rad/s"), flume.depth, flume.gravity)
    assert float(number) / 26.0 == pytest.approx(float(dispersion.wave_number(1.1, 12.0, 9.81)), rel=1e-13)


def test_there_and_back() -> None:
    scale = Scale(40.0, 1.025, 1.0)
    cage = {"twine": (2.5e-3, "m"), "weight": (400.0, "N"), "inertia": (3e4, "kg m2"), "solidity": (0.2, "")}
    model = {row.name: (row.model, row.unit) for row in scale_quantities(cage, scale)}
    for row in scale_quantities(model, scale, from_model=True):
        assert row.prototype == pytest.approx(cage[row.name][0], rel=1e-14)


def test_spring_in_series_keeps_the_cauchy_number() -> None:
    scale = Scale(20.0, 1.025, 1.0)
    flume = scale_water(SEA, scale)
    wanted = scale.to_model(4e7, "N")
    assert cauchy_number(wanted, flume) == pytest.approx(cauchy_number(4e7, SEA), rel=1e-14)
    match = match_stretch(4e7, 4.0 * wanted, 2.3, scale)
    together = 1.0 / (2.3 / (4.0 * wanted) + 1.0 / match.series_spring) * 2.3
    assert together == pytest.approx(wanted, rel=1e-13)
    assert match.distortion == pytest.approx(4.0)
    assert math.isnan(match_stretch(4e7, 0.5 * wanted, 2.3, scale).series_spring)
    assert match_stretch(4e7, wanted, 2.3, scale).series_spring == math.inf
    assert mass_to_add(8.0, 0.01, scale, "kg/m") == pytest.approx(8.0 / 400.0 / 1.025 - 0.01)


def test_models_that_are_too_small_are_reported() -> None:
    scale = Scale(25.0, 1.0, 1.0)
    codes = {note.code for note in check_model(scale, period=1.5, water_depth=0.4, reynolds=200.0)}
    assert codes == {"similarity-period", "similarity-depth", "similarity-reynolds"}
    assert check_model(scale, period=6.0, water_depth=12.0, reynolds=2e3) == ()


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: Scale(0.0, 1.0, 1.0), "length ratio"),
        (lambda: Scale(10.0, 1.0, 1.0).ratio("furlong"), "furlong"),
        (lambda: match_stretch(0.0, 1.0, 1.0, Scale(10.0, 1.0, 1.0)), "prototype_stiffness"),
        (lambda: match_stretch(1.0, 1.0, 0.0, Scale(10.0, 1.0, 1.0)), "model length"),
    ],
)
def test_refusals_of_scaling(call, words) -> None:
    with pytest.raises(InputError, match=words):
        call()
