"""The time left of a stage follows from the rate since it began."""

from __future__ import annotations

import math

import pytest

from moyai.core.progress import Pace, duration_words


class Clock:
    now = 0.0

    def __call__(self) -> float:
        return self.now


def test_the_time_left_is_known_from_the_second_report_and_runs_down() -> None:
    clock = Clock()
    pace = Pace(clock)
    pace.tell("time domain", 0, 10)
    assert math.isnan(pace.left("time domain"))
    clock.now = 40.0
    pace.tell("time domain", 2, 10)
    assert pace.left("time domain") == pytest.approx(160.0)
    clock.now = 50.0
    assert pace.left("time domain") == pytest.approx(150.0)
    assert pace.line() == "time domain: 20 %, 2 min 30 s left (running for 50 s)"


def test_stages_in_each_other_are_reported_and_ended_ones_are_not() -> None:
    clock = Clock()
    pace = Pace(clock)
    assert pace.line() == ""
    pace.tell("water levels", 0, 2)
    pace.tell("time, storm", 0, 4)
    assert pace.line().startswith("water levels: 0 %; time, storm: 0 %")
    pace.tell("time, storm", 4, 4)
    assert "storm" not in pace.line()


def test_a_stage_that_begins_again_is_measured_anew() -> None:
    clock = Clock()
    pace = Pace(clock)
    pace.tell("time", 0, 2)
    clock.now = 100.0
    pace.tell("time", 2, 2)
    pace.tell("time", 0, 2)
    assert math.isnan(pace.left("time"))


def test_durations_in_words() -> None:
    assert [duration_words(one) for one in (40.2, 200.0, 7500.0)] == ["40 s", "3 min 20 s", "2 h 5 min"]


def test_work_that_is_not_done_takes_some_time():
    """Two quick steps of ten, then a slow one: the time left grows with it and is never 0."""
    clock = Clock()
    pace = Pace(clock)
    for done in (0, 1, 2):
        pace.tell("runs", done, 10)
        clock.now += 1.0
    assert pace.left("runs") == pytest.approx(8.0 * 1.0 - 1.0)
    clock.now += 29.0
    assert pace.left("runs") == pytest.approx(8.0 * 30.0 - 30.0)
    pace.tell("runs", 9, 10)
    clock.now += 100.0
    assert pace.left("runs") > 10.0


def test_rows_that_are_reported_in_thousands_wait_by_their_thousands():
    """A report of half of 4,000 rows after 20 s, then 10 s of silence: some 20 s are left, not hours."""
    clock = Clock()
    pace = Pace(clock)
    pace.tell("time", 0, 4000)
    clock.now = 20.0
    pace.tell("time", 2000, 4000)
    clock.now = 30.0
    assert pace.left("time") == pytest.approx(10.0)
    clock.now = 60.0
    assert 5.0 <= pace.left("time") <= 20.0
