"""Seeds of a sea side by side: each the same to the last bit as by itself, whatever the others do."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from moyai.floating import time
from moyai.floating.damping import QuadraticDamping
from moyai.floating.forcing import IrregularForcing
from moyai.floating.lines import PlanarMooring
from moyai.floating.memory import ConvolutionMemory, StateSpaceMemory
from moyai.floating.time import CumminsModel, Simulation, simulate
from moyai.floating.together import simulate_together
from moyai.mooring.lines import Line, LineType, Segment, SpringLine
from moyai.mooring.system import LineSystem

OMEGA = np.linspace(0.5, 2.2, 12)


def mooring() -> PlanarMooring:
    chain = LineType("chain", submerged_weight=600.0, axial_stiffness=1e8)
    lines = [
        Line(f"line {k}", (side * 45.0, 0.0, -12.0), (side * 4.0, 0.0, 0.0), (Segment(chain, 47.0),))
        for k, side in enumerate((-1.0, 1.0))
    ]
    spring = SpringLine("spring", (-30.0, 0.0, -2.0), (-4.0, 0.0, 0.5), stiffness=2e4, pretension=5e4)
    system = LineSystem((*lines, spring), 12.0)
    return PlanarMooring.of(system, rest=(0.0, 0.0, 0.0), centre=(0.0, 0.0), motion_range=(0.4, 0.4, 0.1))


def model(seed: int, lines: bool) -> CumminsModel:
    rng = np.random.default_rng(seed)
    poles = np.concatenate([-rng.uniform(0.2, 2.0, 3) + 1j * rng.uniform(0.3, 2.0, 3), -rng.uniform(0.5, 3.0, 2) + 0j])
    inputs = np.eye(3)[rng.integers(0, 3, 5)].astype(complex)
    outputs = 1e4 * rng.normal(size=(3, 5)) * np.exp(1j * rng.uniform(0.0, 1.0, (3, 5)))
    memory = StateSpaceMemory(poles, inputs, outputs, np.zeros((3, 3)))
    drag = QuadraticDamping(directions=rng.normal(size=(2, 3)), coefficients=np.array([3e3, 8e3]))
    stiffness = np.diag([2e4 if lines else 8e4, 9e5, 4e6])
    return CumminsModel(
        np.diag([2e5, 3e5, 2e6]), stiffness, np.diag([3e4, 5e4, 2e5]), memory, mooring() if lines else None, drag
    )


def sea(seed: int, size: float = 1.0) -> IrregularForcing:
    rng = np.random.default_rng(100 + seed)
    amplitude = size * 0.08 * rng.rayleigh(size=12) * np.exp(1j * rng.uniform(0.0, 6.3, 12))
    excitation = np.tile(np.array([3e5, 5e5, 9e5], dtype=complex), (12, 1))
    drift = np.tile(np.array([4e3, 0.0, 0.0]), (12, 1))
    return IrregularForcing(
        omega=OMEGA, amplitude=amplitude, excitation_force=excitation, drift=drift, steady=np.array([2e3, 0.0, 0.0]),
        drift_law="newman", ramp=5.0,
    )  # fmt: skip


def assert_same(one: Simulation, other: Simulation) -> None:
    assert (one.status, one.message, one.time_step) == (other.status, other.message, other.time_step)
    for name in ("time", "position", "velocity", "mooring_force", "tension", "elevation"):
        assert np.array_equal(getattr(one, name), getattr(other, name)), name


@pytest.mark.parametrize("lines", [True, False])
def test_each_is_the_same_to_the_last_bit_as_by_itself(lines: bool) -> None:
    """In tables and beyond them, with drag and drift; more of them than there are lanes."""
    body = model(3, lines)
    given: dict[str, Any] = {"duration": 40.0, "expected_motion": np.array([0.3, 0.3, 0.05])}
    seas = [sea(number, 1.0 + 0.3 * number) for number in range(10)]
    found = simulate_together(body, seas, **given)
    assert len(found) == 10
    for one, forcing in zip(found, seas, strict=True):
        assert_same(one, simulate(body, forcing, **given))
        assert np.abs(one.position).max() > 1e-3
    assert not np.array_equal(found[0].position, found[1].position)


def test_one_that_is_lost_leaves_the_others_as_they_are() -> None:
    body = model(5, True)
    seas = [sea(0), sea(1, 1e8), sea(2)]
    found = simulate_together(body, seas, duration=30.0, time_step=0.05)
    assert [one.status for one in found] == ["converged", "diverged", "converged"]
    for one, forcing in zip(found, seas, strict=True):
        assert_same(one, simulate(body, forcing, duration=30.0, time_step=0.05))


def test_an_interrupt_keeps_what_was_computed_of_all() -> None:
    body, seas = model(3, False), [sea(0), sea(1)]

    def stop(_what: str, done: float, _total: float) -> None:
        if done > 5.0:
            raise KeyboardInterrupt

    found = simulate_together(body, seas, duration=4000.0, time_step=0.05, progress=stop)
    for one, forcing in zip(found, seas, strict=True):
        assert one.status == "interrupted" and 5.0 < one.time[-1] < 4000.0
        whole = simulate(body, forcing, duration=4000.0, time_step=0.05)
        assert np.array_equal(one.position, whole.position[: len(one.time)])


@pytest.mark.parametrize("convolution", [False, True])
def test_a_run_does_not_depend_on_how_it_is_cut(monkeypatch: pytest.MonkeyPatch, convolution: bool) -> None:
    """Calls of one, two and seven steps, between rows that are kept, against calls of many."""
    body = model(3, lines=True)
    if convolution:
        times = np.linspace(0.0, 10.0, 101)
        kernel = 2e4 * np.exp(-times)[:, None, None] * np.eye(3)
        body = replace(body, memory=ConvolutionMemory(times, kernel, np.zeros((3, 3))))
    given = {"duration": 60.0, "time_step": 0.1, "save_interval": 0.4}
    whole = simulate(body, sea(1), **given)

    def cut(advance, steps, step, progress):
        done, sizes = 0, itertools.cycle([1, 3, 1, 1, 2, 7])
        while done < steps:
            done += advance(done, min(next(sizes), steps - done))[1]
        return done, "converged", ""

    monkeypatch.setattr(time, "_drive", cut)
    assert_same(whole, simulate(body, sea(1), **given))
