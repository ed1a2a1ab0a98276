"""What the notice on wave fronts says of size and sign, held against a bar whose end is pulled at once."""

from __future__ import annotations

import math

import numpy as np
import pytest

from moyai.flexible import BarType, Motion, NetworkBuilder, simulate
from moyai.flexible.result import History
from moyai.sea import Water

STIFFNESS, MASS, LENGTH, SPEED = 1e6, 1.0, 10.0, 1.0
TRAVEL = LENGTH / math.sqrt(STIFFNESS / MASS)


def pulled(segments: int, safety: float | None, bars: float) -> tuple[float, History]:
    """Return the peak over 2 v sqrt(EA m) and the run; the speed of the end grows over the wave along ``bars`` bars."""
    builder = NetworkBuilder(Water(10.0, 1025.0, 0.0))
    bar = BarType("bar", mass_per_length=MASS, axial_stiffness=STIFFNESS, diameter=1e-6)
    builder.fixed("wall", (0.0, 0.0, -5.0))
    builder.driven("end", (LENGTH, 0.0, -5.0), "pull")
    builder.line("line", "wall", "end", bar, length=LENGTH, segments=segments)
    time, grows = np.linspace(0.0, 1.6 * TRAVEL, 6001), bars * TRAVEL / segments
    way = SPEED * time if not bars else SPEED * np.where(time < grows, time**2 / (2.0 * grows), time - 0.5 * grows)
    motion = Motion.from_table(time, np.stack([way, 0.0 * time, 0.0 * time], axis=1))
    run = simulate(
        builder.build(), {"pull": motion}, duration=1.4 * TRAVEL, output_step=10.0 * TRAVEL / segments, safety=safety
    )
    peak = max(float(run.tension.max()), float(np.max(run.tension_peak)))
    return peak / (2.0 * SPEED * math.sqrt(STIFFNESS * MASS)), run


@pytest.mark.parametrize("segments", [10, 20, 50, 100])
@pytest.mark.parametrize("safety", [None, 0.95])
def test_a_sudden_jump_overshoots_as_the_notice_says(segments: int, safety: float | None) -> None:
    ratio, run = pulled(segments, safety, 0.0)
    assert 1.145 < ratio < 1.25
    (notice,) = run.notices
    assert (notice.code, notice.severity) == ("wave-front", "warning")
    assert "likely too high: 15 to 25 %" in notice.message


@pytest.mark.parametrize("safety", [None, 0.95])
@pytest.mark.parametrize("bars", [12.0, 20.0])
def test_a_slower_rise_overshoots_less(safety: float | None, bars: float) -> None:
    ratio, run = pulled(100, safety, bars)
    assert 1.0 < ratio < 1.05
    assert run.notices[0].severity == "warning"


def test_at_the_pace_of_the_wave_nothing_overshoots() -> None:
    ratio, run = pulled(100, 1.0, 0.0)
    assert ratio == pytest.approx(1.0, abs=1e-9)
    assert not run.notices
