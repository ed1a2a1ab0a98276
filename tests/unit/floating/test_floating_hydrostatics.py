"""Restoring, equilibrium and righting levers against closed forms and against exact forces of the displaced hull."""

from __future__ import annotations

import math

import numpy as np
import pytest

from moyai.core.errors import ConvergenceError, InputError
from moyai.floating.statics import (
    body_to_site,
    find_equilibrium,
    hydrostatics,
    inertia_matrix,
    righting_curve,
)
from moyai.potential import shapes

DENSITY, GRAVITY = 1025.0, 9.81


def _random_hull(rng: np.random.Generator) -> tuple[object, float]:
    """An off-centre quadrilateral hull and a draught between its knuckles."""
    bottom, top, height = rng.uniform(2.0, 6.0), rng.uniform(6.0, 9.0), rng.uniform(3.0, 5.0)
    shift = rng.uniform(-1.0, 1.0)
    points = [(-bottom / 2, 0.0), (bottom / 2, 0.0), (top / 2 + shift, height), (-top / 2 + shift, height)]
    return shapes.polygon(points), rng.uniform(0.4, 0.7) * height


@pytest.mark.parametrize("seed", range(8))
def test_restoring_is_the_tangent_of_the_exact_forces(seed: int) -> None:
    rng = np.random.default_rng(seed)
    hull, draught = _random_hull(rng)
    length, gravity_point = 7.0, (rng.uniform(-0.5, 0.5), rng.uniform(0.5, 3.0))
    section = hull.immersed(draught)
    x_g, z_g = body_to_site(gravity_point, draught, 0.0)
    result = hydrostatics(
        section, mass=1e4, centre_of_gravity=(x_g, z_g), length=length, density=DENSITY, gravity=GRAVITY
    )

    def force(motion: np.ndarray) -> np.ndarray:
        # Place the hull so that its centre of gravity has moved by sway and heave and the body has turned about it
        x, z, roll = motion
        lever_x = gravity_point[0] * math.cos(roll) + gravity_point[1] * math.sin(roll)
        lever_z = -gravity_point[0] * math.sin(roll) + gravity_point[1] * math.cos(roll)
        offset, keel = x_g + x - lever_x, -(z_g + z - lever_z)
        moved = hull.immersed(keel, roll)
        buoyancy = DENSITY * GRAVITY * moved.area * length
        return np.array([0.0, buoyancy, -buoyancy * (moved.centroid[0] + offset - (x_g + x))])

    step = 1e-4
    tangent = np.array([(force(step * e) - force(-step * e)) / (2 * step) for e in np.eye(3)]).T
    assert np.allclose(-tangent, result.stiffness, rtol=1e-5, atol=1e-6 * np.abs(result.stiffness).max())
    assert np.allclose(result.stiffness, result.stiffness.T)


def test_paper_model() -> None:
    section = shapes.rectangle(0.38, 0.17).immersed(0.113)
    result = hydrostatics(
        section, mass=41.6, centre_of_gravity=(0.0, -0.027), length=0.986, density=1000.0, gravity=9.81
    )
    assert result.stiffness[1, 1] == pytest.approx(3675.6, rel=1e-4)
    assert result.stiffness[2, 2] == pytest.approx(31.98, rel=2e-4)
    assert result.metacentric_height == pytest.approx(0.0770, abs=5e-5)
    # 0.74 kg of displacement are held down by six lines of 0.110 kg
    assert result.reserve / 9.81 == pytest.approx(0.74, abs=0.005)
    assert abs(result.imbalance(6 * 0.110 * 9.81, gravity=9.81)) < 0.2
    assert np.allclose(np.diag(inertia_matrix(41.6, 0.101)), [41.6, 41.6, 0.4244], rtol=1e-4)


@pytest.mark.parametrize("seed", range(6))
def test_equilibrium_balances_weight_buoyancy_and_lines(seed: int) -> None:
    rng = np.random.default_rng(50 + seed)
    hull, draught = _random_hull(rng)
    length = 7.0
    section = hull.immersed(draught)
    mass = DENSITY * section.area * length * rng.uniform(0.85, 0.97)
    gravity_point = (section.centroid[0] + rng.uniform(-0.1, 0.1), rng.uniform(0.3, 0.8))
    spring, pull = 3e4, rng.uniform(0.0, 5e4)

    def lines(x: float, z: float, heel: float) -> tuple[float, float, float]:
        return -spring * (x - 0.3), -pull, -2e5 * heel

    found = find_equilibrium(
        hull,
        mass=mass,
        centre_of_gravity=gravity_point,
        length=length,
        density=DENSITY,
        gravity=GRAVITY,
        draught_start=draught,
        line_pull=lines,
    )
    x, z = found.centre_of_gravity
    assert x == pytest.approx(0.3, abs=1e-7)
    buoyancy = DENSITY * GRAVITY * found.section.area * length
    assert buoyancy == pytest.approx(mass * GRAVITY + pull, rel=1e-8)
    lever = found.section.centroid[0] + found.offset - x
    assert -buoyancy * lever - 2e5 * found.heel == pytest.approx(0.0, abs=1e-7 * buoyancy)
    assert body_to_site(gravity_point, found.draught, found.heel, found.offset) == pytest.approx((x, z))


def test_a_body_heavier_than_its_hull_gets_one_clear_message() -> None:
    with pytest.raises(ConvergenceError, match="no position balances"):
        find_equilibrium(
            shapes.rectangle(4.0, 2.0),
            mass=20000.0,
            centre_of_gravity=(0.0, 0.5),
            length=2.0,
            density=1000.0,
            gravity=9.81,
            draught_start=1.0,
        )
    with pytest.raises(InputError):
        inertia_matrix(-1.0, 2.0)


@pytest.mark.parametrize(("beam", "draught", "height"), [(6.0, 1.5, 3.5), (4.0, 2.0, 4.0)])
def test_wall_sided_formula(beam: float, draught: float, height: float) -> None:
    gravity = 1.2
    heel = np.radians([-8.0, 2.0, 5.0, 10.0])
    curve = righting_curve(
        shapes.rectangle(beam, height),
        heel,
        area=beam * draught,
        centre_of_gravity=(0.0, gravity),
        draught_start=draught,
    )
    bm = beam**2 / (12.0 * draught)
    gm = draught / 2.0 + bm - gravity
    assert np.allclose(curve.lever, np.sin(heel) * (gm + 0.5 * bm * np.tan(heel) ** 2), atol=1e-9)
    assert np.allclose(curve.draught, draught * np.cos(heel), rtol=1e-9)


def test_a_spar_that_lies_down_floats_at_the_depth_of_its_area() -> None:
    """1 m by 10 m, 9 m deep: on its side nine tenths of its breadth are under water."""
    hull = shapes.rectangle(1.0, 10.0)
    curve = righting_curve(hull, np.array([0.5 * math.pi]), area=9.0, centre_of_gravity=(0.0, 4.0), draught_start=9.0)
    # the keel stands at the middle of the breadth, 0.4 m under still water; the buoyancy 1 m beyond the weight
    assert curve.draught[0] == pytest.approx(0.4, abs=1e-9)
    assert abs(curve.lever[0]) == pytest.approx(1.0, abs=1e-9)


def test_righting_lever_after_the_deck_is_under_water_is_that_of_the_box_upside_down() -> None:
    # Half immersed box: turned by 180 degrees it floats upside down, the lever is zero there and odd about it
    curve = righting_curve(
        shapes.rectangle(4.0, 2.0),
        np.pi + np.array([-0.05, 0.0, 0.05]),
        area=4.0,
        centre_of_gravity=(0.0, 1.0),
        draught_start=1.0,
    )
    assert curve.lever[1] == pytest.approx(0.0, abs=1e-9)
    assert curve.lever[0] == pytest.approx(-curve.lever[2], abs=1e-9)
    assert curve.lever[2] > 0.0


def test_area_that_cannot_be_displaced_gives_nan() -> None:
    curve = righting_curve(
        shapes.rectangle(4.0, 2.0), np.array([0.1]), area=8.5, centre_of_gravity=(0.0, 1.0), draught_start=1.0
    )
    assert np.isnan(curve.lever[0])
