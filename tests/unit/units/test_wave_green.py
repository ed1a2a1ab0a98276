"""The exact Green function of waves: two representations, its differential equation and conditions, its tables."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import integrate, special

from moyai.sea.dispersion import wave_number
from moyai.sea.water import Water
from moyai.structures.units import wave_green
from moyai.structures.units.bem import panels_of
from moyai.structures.units.mesh import LID, PanelMesh
from moyai.structures.units.variation import log_terms
from moyai.structures.units.wave_green import WaveGreen
from moyai.structures.units.wave_green_kernel import deep_wave

GRAVITY = 9.81


def water(depth):
    return Water(depth=depth, density=1025.0, gravity=GRAVITY)


def frequency(kh, depth):
    return math.sqrt(GRAVITY * kh / depth * math.tanh(kh))


@pytest.mark.parametrize(("x", "y"), [(0.3, 0.5), (0.8, 0.4), (0.01, 0.7), (0.9, 0.9), (1.1, 0.3)])
def test_the_wave_of_deep_water_is_its_integral(x, y):
    def kernel(t):
        return math.exp(-t * y) * special.j0(t * x)

    around = integrate.quad(lambda t: (kernel(1.0 + t) - kernel(1.0 - t)) / t, 1e-12, 1.0, epsabs=1e-12)[0]
    beyond = integrate.quad(lambda t: kernel(t) / (t - 1.0), 2.0, 60.0 / y, limit=2000, epsabs=1e-12)[0]
    value, by_x, by_y = deep_wave(x, y)
    assert value == pytest.approx(around + beyond, abs=1e-8)
    step = 1e-5
    assert by_x == pytest.approx((deep_wave(x + step, y)[0] - deep_wave(x - step, y)[0]) / (2 * step), abs=1e-8)
    assert by_y == pytest.approx((deep_wave(x, y + step)[0] - deep_wave(x, y - step)[0]) / (2 * step), abs=1e-8)


@pytest.mark.parametrize("kh", [0.1, 0.3, 1.0, 1.816, 4.0, 12.0, 30.0])
@pytest.mark.parametrize("share", [0.2, 0.6, 0.95])
def test_integrals_round_the_poles_and_series_of_eigenfunctions_are_one(kh, share, monkeypatch):
    """Both are used on their own sides of half a depth; between 0.35 and 0.5 depths either serves."""
    depth = 10.0
    given = water(depth), frequency(kh, depth), 2.0 * depth, -share * depth
    own = WaveGreen.of(*given)
    monkeypatch.setattr(wave_green, "_SERIES_FROM", 0.35)
    monkeypatch.setattr(wave_green, "_SERIES", 60)
    other = WaveGreen.of(*given)
    first, growth = own.steps[1:]
    below = int(growth * math.log1p(share * depth / growth) / first) + 2
    # values and slopes of an influence of the order of one over the depth
    scale = depth ** np.array([1.0, 2.0, 2.0, 3.0])
    stretch = np.exp(first / growth * np.arange(own.near.shape[1]))[:, None]
    scale = scale / np.concatenate([np.ones((len(stretch), 2)), stretch, stretch], axis=1)
    assert (np.abs(own.near - other.near) * scale).max() < 1e-9
    assert (np.abs(own.bed - other.bed) * scale)[:, :below].max() < 1e-9


def green(given, source, points):
    """Return 4 pi G at points (n, 3), 1/r and its mirrors with it, by the layers of one small panel."""
    finite = math.isfinite(given.depth)
    size, normal = 1e-8, np.array([[0.0, 0.0, 1.0]])
    single, _ = given.layers(points, (source[None], normal, np.array([size])))
    apart = np.linalg.norm(points - source, axis=1)
    mirror = np.linalg.norm(points - source * np.array([1.0, 1.0, -1.0]), axis=1)
    total = 1.0 / apart + 1.0 / mirror
    total = total - 2.0 * given.surface_number * np.log(mirror - points[:, 2] - source[2])
    if finite:
        below = source * np.array([1.0, 1.0, -1.0]) - np.array([0.0, 0.0, 2.0 * given.depth])
        total = total + 1.0 / np.linalg.norm(points - below, axis=1)
    return total - 4.0 * math.pi * single[:, 0] / size


@pytest.mark.parametrize(("depth", "kh"), [(10.0, 0.6), (10.0, 2.5), (math.inf, 3.0)])
def test_it_is_harmonic_and_meets_the_conditions_of_surface_and_bed(depth, kh):
    reference = 10.0
    omega = frequency(kh, reference) if math.isfinite(depth) else math.sqrt(GRAVITY * kh / reference)
    given = WaveGreen.of(water(depth), omega, 30.0, -9.999)
    source, step = np.array([0.0, 0.0, -2.5]), 0.02
    rng = np.random.default_rng(3)
    plan = rng.uniform(2.0, 12.0, (20, 2))

    def at(z, shift=(0.0, 0.0, 0.0)):
        return green(given, source, np.column_stack([plan, z]) + np.array(shift))

    zero = np.zeros(20)
    slope = (3.0 * at(zero) - 4.0 * at(zero - step) + at(zero - 2.0 * step)) / (2.0 * step)
    assert np.abs(slope - given.surface_number * at(zero)).max() < 2e-4
    if math.isfinite(depth):
        bed = zero - depth
        slope = (-3.0 * at(bed) + 4.0 * at(bed + step) - at(bed + 2.0 * step)) / (2.0 * step)
        assert np.abs(slope).max() < 2e-4
    z, step = rng.uniform(-7.0, -1.0, 20), 0.4
    around = [at(z, sign * step * np.eye(3)[axis]) for axis in range(3) for sign in (1.0, -1.0)]
    laplace = (sum(around) - 6.0 * at(z)) / step**2
    bent = np.abs(around[0] + around[1] - 2.0 * at(z)).max() / step**2
    # of fourth order: what is left falls with the square of the step
    assert np.abs(laplace).max() < 0.05 * bent


@pytest.mark.parametrize(("depth", "kh"), [(10.0, 0.2), (10.0, 1.5), (10.0, 8.0), (math.inf, 3.0)])
def test_tables_are_far_closer_than_panels(depth, kh, monkeypatch):
    omega = frequency(kh, 10.0) if math.isfinite(depth) else math.sqrt(GRAVITY * kh / 10.0)
    given = water(depth), omega, 40.0, -6.0
    own = WaveGreen.of(*given)
    monkeypatch.setattr(wave_green, "_OF_WAVE", wave_green._OF_WAVE / 4.0)
    monkeypatch.setattr(wave_green, "_OF_DEPTH", wave_green._OF_DEPTH / 4.0)
    finer = WaveGreen.of(*given)
    rng = np.random.default_rng(5)
    points = np.column_stack([rng.uniform(0.0, 25.0, (400, 2)), rng.uniform(-6.0, 0.0, 400)])
    source, size = np.array([[0.3, 0.2, -1.0]]), 1e-8
    for normal in np.eye(3):
        panel = source, normal[None], np.array([size])
        one, two = own.layers(points, panel), finer.layers(points, panel)
        k = float(wave_number(omega, depth, GRAVITY))
        # over the wave of a source, K / 2 pi, and its slope
        assert np.abs(one[0] - two[0]).max() * 2.0 * math.pi / (size * own.surface_number) < 2e-6
        assert np.abs(one[1] - two[1]).max() * 2.0 * math.pi / (size * own.surface_number * max(k, 0.1)) < 2e-4


def test_a_panel_in_the_surface_rises_and_falls_with_its_potential():
    """There the derivative of G is K G, for a panel on itself and on its neighbours; Im G is that of its far waves."""
    side = np.array([-1.0, 1.0])
    corners = np.array([[[x - 1, y - 1, 0.0], [x - 1, y + 1, 0.0], [x + 1, y + 1, 0.0], [x + 1, y - 1, 0.0]]
                        for x in side for y in side])  # fmt: skip
    mesh = PanelMesh(corners, np.zeros(4, dtype=np.int64), np.full(4, LID))
    assert (mesh.normal[:, 2] == -1.0).all()
    panels = replace(panels_of(mesh, np.zeros((1, 3))), even=True)
    given = WaveGreen.of(water(10.0), 1.2, 10.0, -1.0)
    waves = given.layers(mesh.centre, panels.wave_panels)
    growing = log_terms(mesh, mesh.centre, panels.variation, panels.even_layers)
    steady = panels.even_rankine(mesh.centre, 10.0)
    single, double = (
        one + given.surface_number * two + three for one, two, three in zip(waves, growing, steady, strict=True)
    )
    assert single[0, 0].imag == pytest.approx(-0.5 * given.factor * 4.0, rel=1e-12)
    # the rest of a panel on itself is taken at one distance, that of a disc
    assert np.abs(double + given.surface_number * single).max() < 5e-3 * np.abs(given.surface_number * single).max()
