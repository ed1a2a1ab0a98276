"""Random lines: no failure, residual at rounding, exact stiffness, energy gradient, symmetries."""

from __future__ import annotations

import numpy as np
import pytest

from moyai.mooring import kernels
from moyai.mooring.catenary import CatenarySolution, solve_catenary

GOOD = (
    kernels.GROUNDED,
    kernels.SUSPENDED,
    kernels.STRETCHED,
    kernels.SLACK_ON_BED,
    kernels.ALONG_BED,
    kernels.SLACK_VERTICAL,
    kernels.TAUT_VERTICAL,
)


def random_lines(count: int, seed: int, span: tuple[float, float] = (0.5, 3.0)) -> dict[str, np.ndarray]:
    """Lines of ``span`` chords, EA/wL from 1 to 1e7, slopes to the vertical, a share nearly or wholly so, or flat."""
    rng = np.random.default_rng(seed)
    chord = 10.0 ** rng.uniform(-2, 4, count)
    angle = np.arcsin(rng.uniform(0.0, 1.0, count))
    angle = np.where(rng.random(count) < 0.1, np.pi / 2 - 10.0 ** rng.uniform(-12, -1, count), angle)
    angle = np.where(rng.random(count) < 0.05, 10.0 ** rng.uniform(-12, -1, count), angle)
    length = chord * rng.uniform(*span, count)
    weight = 10.0 ** rng.uniform(-3, 4, count)
    horizontal = np.where(rng.random(count) < 0.02, 0.0, chord * np.cos(angle))
    return {
        "horizontal_distance": horizontal,
        "vertical_distance": chord * np.sin(angle),
        "unstretched_length": length,
        "axial_stiffness": weight * length * 10.0 ** rng.uniform(0, 7, count),
        "submerged_weight": weight,
    }


def assert_solved(solution: CatenarySolution) -> None:
    assert np.all(np.isin(solution.regime, GOOD))
    assert solution.residual.max() < 1e-10
    for name in ("horizontal_tension", "vertical_tension_fairlead", "vertical_tension_anchor", "grounded_length"):
        assert np.all(np.isfinite(getattr(solution, name))), name
    assert np.all(np.isfinite(solution.stiffness))
    assert np.all(solution.horizontal_tension >= 0.0)


VARIANTS = {
    "bed": lambda lines, rng: solve_catenary(**lines),
    "friction": lambda lines, rng: solve_catenary(
        **lines, bed_friction=rng.uniform(0, 1.5, len(lines["unstretched_length"]))
    ),
    "no bed": lambda lines, rng: solve_catenary(**lines, bed=False),
    "buoyant": lambda lines, rng: solve_catenary(
        **{**lines, "submerged_weight": -lines["submerged_weight"]}, bed=False
    ),
    "fairlead below": lambda lines, rng: solve_catenary(
        **{**lines, "vertical_distance": -lines["vertical_distance"]}, bed=False
    ),
    "raised anchor": lambda lines, rng: solve_catenary(
        **lines,
        bed_clearance=lines["unstretched_length"] * 10.0 ** rng.uniform(-6, 0, len(lines["unstretched_length"])),
    ),
}


@pytest.mark.parametrize("variant", VARIANTS)
def test_hundred_thousand_random_lines(variant: str) -> None:
    assert_solved(VARIANTS[variant](random_lines(100_000, 5), np.random.default_rng(6)))


@pytest.mark.slow
@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("seed", [1, 2])
def test_a_million_random_lines(variant: str, seed: int) -> None:
    assert_solved(VARIANTS[variant](random_lines(1_000_000, seed), np.random.default_rng(seed)))


@pytest.mark.parametrize("bed", [True, False])
def test_lines_about_as_long_as_their_chord(bed: bool) -> None:
    rng = np.random.default_rng(11)
    lines = random_lines(100_000, 12)
    chord = np.hypot(lines["horizontal_distance"], lines["vertical_distance"])
    offset = rng.choice([-1.0, 1.0], chord.size) * 10.0 ** rng.uniform(-14, -1, chord.size)
    assert_solved(solve_catenary(**{**lines, "unstretched_length": chord * (1.0 + offset)}, bed=bed))


@pytest.mark.parametrize("variant", ["bed", "friction", "no bed", "buoyant", "raised anchor"])
def test_stiffness_is_the_derivative_of_the_forces(variant: str) -> None:
    lines = random_lines(4000, 21)
    keep = lines["horizontal_distance"] > 1e-3 * lines["unstretched_length"]
    keep &= lines["vertical_distance"] > 1e-3 * lines["unstretched_length"]
    lines = {key: value[keep] for key, value in lines.items()}
    here = VARIANTS[variant](lines, np.random.default_rng(6))
    # the strain sets the scale on which forces change
    step = (
        1e-5 * lines["unstretched_length"] * np.minimum(1.0, np.hypot(*_forces(here)) / lines["axial_stiffness"] + 1e-3)
    )
    numeric = np.empty_like(here.stiffness)
    for j, key in enumerate(("horizontal_distance", "vertical_distance")):
        ends = [
            _forces(VARIANTS[variant]({**lines, key: lines[key] + sign * step}, np.random.default_rng(6)))
            for sign in (1, -1)
        ]
        numeric[:, :, j] = ((ends[0] - ends[1]) / (2.0 * step)).T
    error = np.abs(numeric - here.stiffness).max(axis=(1, 2)) / np.abs(here.stiffness).max(axis=(1, 2))
    # a few lines change regime (jump of curvature) or are nearly straight within the step
    assert np.quantile(error, 0.98) < 1e-5
    assert np.median(error) < 1e-7


def _forces(solution: CatenarySolution) -> np.ndarray:
    return np.array([solution.horizontal_tension, solution.vertical_tension_fairlead])


def test_stiffness_is_symmetric_without_friction_and_not_with_it() -> None:
    lines = random_lines(20_000, 31)
    free = solve_catenary(**lines).stiffness
    assert np.array_equal(free[:, 0, 1], free[:, 1, 0])
    held = solve_catenary(**lines, bed_friction=1.0)
    gap = np.abs(held.stiffness[:, 0, 1] - held.stiffness[:, 1, 0])
    resting = (held.regime == kernels.GROUNDED) & (held.grounded_length > 0.1 * lines["unstretched_length"])
    assert np.all(gap[resting] > 0.0)


def test_stiffness_is_positive_definite_where_the_line_pulls() -> None:
    lines = random_lines(50_000, 32)
    solution = solve_catenary(**lines, bed=False)
    pulls = solution.horizontal_tension > 0.0
    eigenvalues = np.linalg.eigvalsh(solution.stiffness[pulls])
    assert np.all(eigenvalues[:, 0] > 0.0)


def test_mirror_of_a_buoyant_line() -> None:
    lines = random_lines(5000, 41)
    heavy = solve_catenary(**lines, bed=False)
    light = solve_catenary(
        **{**lines, "vertical_distance": -lines["vertical_distance"], "submerged_weight": -lines["submerged_weight"]},
        bed=False,
    )
    assert np.array_equal(heavy.horizontal_tension, light.horizontal_tension)
    assert np.array_equal(heavy.vertical_tension_fairlead, -light.vertical_tension_fairlead)
    assert np.array_equal(heavy.stiffness[:, 0, 1], -light.stiffness[:, 0, 1])


def test_exchange_of_the_ends() -> None:
    lines = random_lines(5000, 42)
    up = solve_catenary(**lines, bed=False)
    down = solve_catenary(**{**lines, "vertical_distance": -lines["vertical_distance"]}, bed=False)
    scale = up.tension_fairlead
    assert np.allclose(up.vertical_tension_anchor / scale, -down.vertical_tension_fairlead / scale, atol=1e-11)
    assert np.allclose(up.horizontal_tension / scale, down.horizontal_tension / scale, atol=1e-11)


def test_scale_does_not_matter() -> None:
    lines = random_lines(5000, 43)
    base = solve_catenary(**lines)
    scaled = solve_catenary(
        horizontal_distance=8.0 * lines["horizontal_distance"],
        vertical_distance=8.0 * lines["vertical_distance"],
        unstretched_length=8.0 * lines["unstretched_length"],
        axial_stiffness=32.0 * lines["axial_stiffness"],
        submerged_weight=4.0 * lines["submerged_weight"],
    )
    assert np.allclose(scaled.horizontal_tension, 32.0 * base.horizontal_tension, rtol=1e-14)
    assert np.allclose(scaled.stiffness, 4.0 * base.stiffness, rtol=1e-12)


def test_a_wrong_first_guess_changes_nothing() -> None:
    rng = np.random.default_rng(51)
    lines = random_lines(2000, 52)
    exact = solve_catenary(**lines)
    for i in range(2000):
        values = [float(value[i]) for value in lines.values()]
        start = float(values[4] * values[2] * 10.0 ** rng.uniform(-9, 9))
        h, v, *_, residual, regime = kernels.solve_single(*values, 0.0, 0.0, start)
        assert residual < 1e-12 and regime == exact.regime[i]
        scale = exact.tension_fairlead[i]
        assert abs(h - exact.horizontal_tension[i]) < 1e-8 * scale
        assert abs(v - exact.vertical_tension_fairlead[i]) < 1e-8 * scale
