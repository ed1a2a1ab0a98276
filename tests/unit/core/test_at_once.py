"""Parts of a run on all cores: their order, their interrupts, their failures; a run is the same with one core."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from small_results import CURTAIN

import moyai
from moyai.core.at_once import at_once, threads
from moyai.core.collected import Collected
from moyai.core.errors import ConvergenceError
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice


@pytest.fixture(autouse=True)
def _three_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MOYAI_THREADS", "3")


def part(name: str, together: threading.Barrier) -> Callable[[Collected, Progress], Iterator[None]]:
    def steps(own: Collected, heard: Progress) -> Iterator[None]:
        together.wait(timeout=20.0)
        for step in range(3):
            own.notices.append(Notice(name, f"{name}, step {step}"))
            heard(f"work of {name}", step + 1, 3)
            yield
        own.failures.append(f"{name} did not settle")

    return steps


def test_parts_run_at_the_same_time_and_stand_in_their_order() -> None:
    collected, together, said = Collected(), threading.Barrier(3), []
    here = threading.current_thread()

    def listen(what: str, done: float, total: float) -> None:
        assert threading.current_thread() is here
        said.append((what, done, total))

    collected.take(collected.take_together([part(name, together) for name in "abc"], listen, "levels"))
    assert [one.message for one in collected.notices] == [f"{name}, step {step}" for name in "abc" for step in range(3)]
    assert collected.failures == [f"{name} did not settle" for name in "abc"]
    assert said[0] == ("levels", 0, 3) and said[-1] == ("levels", 3, 3)
    assert {(f"work of {name}", 3, 3) for name in "abc"} <= set(said)


def test_an_interrupt_stops_every_part_and_keeps_what_each_has() -> None:
    def endless(name: str) -> Callable[[Collected, Progress], Iterator[None]]:
        def steps(own: Collected, heard: Progress) -> Iterator[None]:
            own.failures.append(name)
            yield
            while True:
                time.sleep(0.01)
                heard(name, 0, 1)

        return steps

    def stop_at_b(what: str, done: float, total: float) -> None:
        if what == "b":
            raise KeyboardInterrupt

    collected, before = Collected(), threading.active_count()
    collected.take(collected.take_together([endless("a"), endless("b")], stop_at_b, "levels"), "stopped")
    assert collected.interrupted == "stopped" and collected.failures == ["a", "b"]
    assert threading.active_count() == before


def test_the_first_of_the_failures_is_raised_and_stops_what_stands_behind_it() -> None:
    ended = []

    def work(number: int, heard: Progress) -> None:
        if number == 1:
            raise ConvergenceError("part 1")
        try:
            for _ in range(2000 if number == 2 else 20):
                time.sleep(0.01)
                heard("waits", 0, 1)
        finally:
            ended.append(number)

    began = time.monotonic()
    with pytest.raises(ConvergenceError, match="part 1"):
        at_once(work, 3, silent)
    assert sorted(ended) == [0, 2] and time.monotonic() - began < 15.0


def test_a_thread_starts_no_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    found: list[int] = []
    at_once(lambda number, heard: found.append(threads()), 2, silent)
    assert found == [1, 1] and threads() == 3
    monkeypatch.delenv("MOYAI_THREADS")
    assert threads() >= 1


def test_levels_on_three_cores_are_those_on_one(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every number to the last bit, every notice in its place."""
    text = CURTAIN.replace("[statics, impact, waves, anchor_loads, limits]", "[statics, waves]")
    assert text != CURTAIN

    def ran(cores: str) -> Any:
        monkeypatch.setenv("MOYAI_THREADS", cores)
        return moyai.run(text)

    one, three = ran("1"), ran("3")
    assert [node.path for node in one.tree.subtree] == [node.path for node in three.tree.subtree]
    for node in one.tree.subtree:
        for name, values in node.to_dataset(inherit=False).data_vars.items():
            np.testing.assert_array_equal(values.values, three.tree[node.path][name].values)
    assert (one.notices, one.checks, one.headlines) == (three.notices, three.checks, three.headlines)
