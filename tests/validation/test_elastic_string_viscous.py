"""Strings with viscosity, strings of rope curves and both ends of a struck string, at random inputs.

Viscosity: the struck string with Kelvin-Voigt tension has a Laplace transform in closed form (mass M with speed V at
x = L, fixed at 0, displacement A sinh(kappa x), kappa = s / sqrt(1 + beta s) in units L = c = EA = 1), inverted here
along a vertical line. Rope curves: an end that is pulled away with a steady speed V sends a shock; mass and momentum
across it give T(e) e = m V^2, and (T2 - T1)(e2 - e1) = m V^2 behind the one that a fixed end throws back (Rankine and
Hugoniot; for curves that stiffen).
"""

import math

import numpy as np
import pytest
from test_elastic_string_impact import exact_peak

from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType, RopeCurve
from moyai.flexible.motion import Motion
from moyai.flexible.result import State
from moyai.flexible.simulation import simulate
from moyai.sea.water import Water

VOID = Water(math.inf, 1000.0, 1e-12)
DEEP = -500.0


def struck(ratio, segments, travels, *, span=50.0, stiffness=2e7, mass=3.0, speed=1.0, rows=1, **options):
    viscosity = options.pop("viscosity", 0.0)
    builder = NetworkBuilder(VOID)
    builder.fixed("wall", (0.0, 0.0, DEEP))
    builder.free("mass", (span, 0.0, DEEP), mass=ratio * mass * span)
    kind = BarType("string", mass, stiffness, 1e-9, viscosity=viscosity)
    builder.line("string", "wall", "mass", kind, length=span, segments=segments)
    network = builder.build()
    velocity = np.zeros((len(network.nodes), 3))
    velocity[network.point("mass"), 0] = speed
    travel = span / math.sqrt(stiffness / mass)
    start = State(0.0, np.array(network.nodes.position), velocity)
    return simulate(network, duration=travels * travel, output_step=travel / rows, start=start, **options), (
        speed * math.sqrt(stiffness * mass)
    )


def viscous_tension(ratio, beta, time):
    """Tension at the fixed end over T0 at times over L/c."""
    span = 2.0 * time[-1]
    shift, omega = 12.0 / span, np.arange(200_000) * math.pi / span
    s = shift + 1j * omega
    give = 1.0 + beta * s
    kappa = s / np.sqrt(give)
    echo = np.exp(-2.0 * kappa)
    amplitude = ratio / (0.5 * ratio * s * s * (1.0 - echo) + 0.5 * give * kappa * (1.0 + echo))
    image = give * kappa * amplitude * np.exp(-kappa)
    image[0] *= 0.5
    size = 2 ** math.ceil(math.log2(2 * image.size))
    values = np.fft.ifft(image, size).real * size
    grid = 2.0 * span * np.arange(size) / size
    return np.interp(time, grid, np.exp(shift * grid) / span * values)


@pytest.mark.parametrize("seed", range(5))
def test_peak_of_a_viscous_string(seed):
    rng = np.random.default_rng(seed)
    ratio, beta = 10.0 ** rng.uniform(math.log10(0.3), 1.2), 10.0 ** rng.uniform(-2.7, -1.3)
    span, stiffness, mass = rng.uniform(5.0, 500.0), 10.0 ** rng.uniform(4, 9), 10.0 ** rng.uniform(-1, 2)
    time = np.linspace(1e-3, exact_peak(ratio)[1] + 0.5, 4001)
    exact = viscous_tension(ratio, beta, time)
    # until it goes slack
    taut = int(np.argmax(exact < -1e-3)) or time.size
    time, exact = time[:taut], exact[:taut]
    assert time[-1] > 1.5
    history, unit = struck(
        ratio, 100, time[-1], span=span, stiffness=stiffness, mass=mass,
        viscosity=beta * span * math.sqrt(stiffness * mass),
    )  # fmt: skip
    # viscous fronts are resolved: no pace of the wave is needed
    assert history.tension_peak[:, 0].max() / unit == pytest.approx(exact.max(), rel=0.01)


@pytest.mark.parametrize("seed", range(6))
def test_both_ends_of_a_struck_string(seed):
    """At the mass the tension is s(t) + s(t - 2): one at first, its later maximum follows the reflected front."""
    rng = np.random.default_rng(100 + seed)
    ratio, segments = 10.0 ** rng.uniform(0.0, math.log10(20.0)), 2 * int(rng.integers(75, 150))
    exact, when = exact_peak(ratio)
    travels = round(2.0 * when + 1.0) / 2.0
    # by the method of characteristics on a fine grid, another way than the series
    count, k = 4000, 1.0 / ratio
    step = 1.0 / count
    leaving = np.zeros(int(travels * count) + 1)
    leaving[0] = 1.0
    for i in range(1, leaving.size):
        now, before = (leaving[j - 2 * count] if j >= 2 * count else 0.0 for j in (i, i - 1))
        # s' = r' - k (s + r), trapezoidal, with the jump of the reflected front
        jump = now - before
        leaving[i] = ((1.0 - 0.5 * k * step) * leaving[i - 1] + jump - 0.5 * k * step * (now + before)) / (
            1.0 + 0.5 * k * step
        )
    coming = np.concatenate([np.zeros(2 * count), leaving])[: leaving.size]
    at_mass = float(np.max(leaving + coming))
    assert 2.0 * leaving[: leaving.size - count].max() == pytest.approx(exact, rel=2e-3)
    history, unit = struck(ratio, segments, travels, safety=1.0, rows=2)
    assert history.tension_peak[:, 0].max() / unit == pytest.approx(exact, rel=0.012)
    assert history.tension_peak[:, -1].max() / unit == pytest.approx(at_mass, rel=0.012)


@pytest.mark.parametrize("seed", range(6))
def test_shock_in_a_rope_that_stiffens(seed):
    rng = np.random.default_rng(seed)
    stiffness, mass, span = 10.0 ** rng.uniform(4, 7), 10.0 ** rng.uniform(-1, 1), rng.uniform(5.0, 100.0)
    strain = np.cumsum([0.0, rng.uniform(0.002, 0.02), rng.uniform(0.002, 0.02), 0.2])
    slope = np.cumprod([1.0, rng.uniform(1.3, 3.0), rng.uniform(1.1, 3.0)])
    tension = np.concatenate([[0.0], np.cumsum(stiffness * slope * np.diff(strain))])

    def pull(at):
        return np.interp(at, strain, tension)

    first = rng.uniform(1.1 * strain[1], 1.3 * strain[2])
    speed = math.sqrt(pull(first) * first / mass)
    many = np.linspace(first, strain[-1], 400_001)
    second = many[np.argmax((pull(many) - pull(first)) * (many - first) >= mass * speed**2)]
    there, back = span * first / speed, span * (second - first) / speed

    builder = NetworkBuilder(VOID)
    builder.fixed("wall", (0.0, 0.0, DEEP))
    builder.driven("end", (span, 0.0, DEEP))
    viscosity = span / 200 * math.sqrt(stiffness * slope[-1] * mass)
    kind = BarType("nylon", mass, 1.0, 1e-9, viscosity=viscosity, curve=RopeCurve(strain, tension))
    builder.line("rope", "wall", "end", kind, length=span, segments=200, shape="straight")
    duration = there + 0.9 * back
    motion = Motion.from_table([0.0, 2.0 * duration], [[0.0, 0.0, 0.0], [2.0 * duration * speed, 0.0, 0.0]])
    history = simulate(builder.build(), {"end": motion}, duration=duration, output_step=duration / 1000)
    time = history.time
    behind = (time > 0.5 * there) & (time < 0.95 * there)
    reflected = (time > there + 0.4 * back) & (time < there + 0.85 * back)
    assert np.median(history.tension[behind, -1]) == pytest.approx(pull(first), rel=5e-3)
    assert np.median(history.tension[reflected, 0]) == pytest.approx(pull(second), rel=5e-3)
    assert [notice.code for notice in history.notices] == ["wave-front"]


@pytest.mark.parametrize("rows", [40, 1, 0.125])
def test_a_front_is_reported_whatever_the_rows(rows):
    history, _ = struck(3.0, 60, 8.0, rows=rows)
    assert [notice.code for notice in history.notices] == ["wave-front"]
    heavy, _ = struck(400.0, 60, 24.0, rows=rows)
    # half a sine of the mass on the spring lasts pi sqrt(400) travel times: the string only transmits
    assert not heavy.notices


def test_a_rope_beyond_its_curve_is_reported():
    history = {}
    for stretch in (0.04, 0.06):
        builder = NetworkBuilder(VOID)
        builder.fixed("a", (0.0, 0.0, DEEP))
        builder.fixed("b", (10.0 * (1.0 + stretch), 0.0, DEEP))
        kind = BarType("nylon", 2.0, 1.0, 1e-9, curve=RopeCurve([0.0, 0.02, 0.05], [0.0, 1e4, 7e4]))
        builder.line("line", "a", "b", kind, length=10.0, segments=4, shape="straight")
        history[stretch] = simulate(builder.build(), duration=0.1, output_step=0.05)
    assert not history[0.04].notices
    (notice,) = history[0.06].notices
    assert notice.code == "beyond-rope-curve"
    assert notice.value == pytest.approx(9e4, rel=1e-6) and notice.limit == 7e4
