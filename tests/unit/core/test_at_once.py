"""Parts of a run on all cores: their order, their interrupts, their failures; a run is the same with one core."""

from __future__ import annotations

import re
import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from small_results import CURTAIN, PONTOON

import moyai
from moyai.core.at_once import at_once, each_at_once, each_counted, one_after_the_other, threads
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
    together = threading.Barrier(2)

    def endless(name: str) -> Callable[[Collected, Progress], Iterator[None]]:
        def steps(own: Collected, heard: Progress) -> Iterator[None]:
            own.failures.append(name)
            together.wait(timeout=20.0)
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
    ended, together = [], threading.Barrier(3)

    def work(number: int, heard: Progress) -> None:
        together.wait(timeout=20.0)
        if number == 1:
            raise ConvergenceError("part 1")
        try:
            for _ in range(20 if number == 0 else 2000):
                time.sleep(0.01)
                heard("waits", 0, 1)
            ended.append((number, "whole"))
        except KeyboardInterrupt:
            ended.append((number, "stopped"))
            raise

    with pytest.raises(ConvergenceError, match="part 1"):
        at_once(work, 3, silent)
    assert sorted(ended) == [(0, "whole"), (2, "stopped")]


def test_parts_share_the_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    assert each_at_once(lambda item, _: (item, threads()), "abcd") == [(item, 3) for item in "abcd"]
    monkeypatch.setenv("MOYAI_THREADS", "7")
    assert each_at_once(lambda item, _: threads(), (1, 2)) == [7, 7]
    # other threads than these start none
    other: list[int] = []
    thread = threading.Thread(target=lambda: other.append(threads()))
    thread.start()
    thread.join()
    monkeypatch.delenv("MOYAI_THREADS")
    assert other == [1] and threads() >= 1


def test_parts_of_parts_use_the_cores_that_are_free_and_no_more(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MOYAI_THREADS", "2")
    guard, at_work, most = threading.Lock(), [0], {"short": 0, "long": 0}
    both = threading.Barrier(2, timeout=20.0)

    def inner(outer: str, number: int) -> None:
        with guard:
            at_work[0] += 1
            most[outer] = max(most[outer], at_work[0])
        if outer == "long" and number >= 8:
            # the short part has ended: its core serves the long one
            both.wait()
        time.sleep(0.01)
        with guard:
            at_work[0] -= 1

    def work(outer: str, _: Any) -> str:
        count = {"short": 2, "long": 10}[outer]
        each_at_once(lambda number, _: inner(outer, number), range(count))
        return outer

    assert each_at_once(work, ("short", "long")) == ["short", "long"]
    assert max(most.values()) == 2


@pytest.mark.slow
def test_events_and_realisations_of_one_level_are_those_on_one_core(monkeypatch: pytest.MonkeyPatch) -> None:
    text = PONTOON.replace(", water_levels: {HWL: 1.2 m, LWL: 0 m}", "").replace("realisations: 1", "realisations: 3")
    text = text.replace("mode: quasi_static", "mode: auto").replace("measured: {file: points.csv}", "")
    result = assert_same(monkeypatch, text)
    # more events than realisations: some were rerun in a second round
    assert float(result.tree["SWL/time/storm"]["events_in_motion"][0]) > 1.0
    assert_same(monkeypatch, CURTAIN.replace(", water_levels: {HWL: 1.2 m, LWL: 0 m}", ""))


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["network", "cage"])
def test_finer_runs_and_runs_under_other_laws_are_those_on_one_core(monkeypatch: pytest.MonkeyPatch, kind: str) -> None:
    changes = {
        "network": ((r"  # duration: 2 min", "  duration: 14 s"), (r"skip: 30 s", "skip: 6 s")),
        "cage": (
            (r"mesh: \{around: 32, down: 6, bottom: 4\}", "mesh: {around: 16, down: 2, bottom: 1}"),
            (r"^analyses: \[.*?\]", "analyses: [time]"),
        ),
    }
    text = moyai.template(kind)
    for old, new in changes[kind]:
        text, count = re.subn(old, new, text, flags=re.MULTILINE)
        assert count == 1
    result = assert_same(monkeypatch, text)
    assert kind == "network" or any("laws_in_waves" in node.path for node in result.tree.subtree)


def test_levels_on_three_cores_are_those_on_one(monkeypatch: pytest.MonkeyPatch) -> None:
    text = CURTAIN.replace("[statics, impact, waves, anchor_loads, limits]", "[statics]")
    assert text != CURTAIN
    assert_same(monkeypatch, text)


def assert_same(monkeypatch: pytest.MonkeyPatch, text: str) -> Any:
    """Run a case on one core and on three: every number to the last bit, every notice in its place."""

    def ran(cores: str) -> Any:
        monkeypatch.setenv("MOYAI_THREADS", cores)
        return moyai.run(text)

    one, three = ran("1"), ran("3")
    assert [node.path for node in one.tree.subtree] == [node.path for node in three.tree.subtree]
    for node in one.tree.subtree:
        for name, values in node.to_dataset(inherit=False).data_vars.items():
            np.testing.assert_array_equal(values.values, three.tree[node.path][name].values)
    assert (one.notices, one.checks, one.headlines) == (three.notices, three.checks, three.headlines)
    return three


@pytest.mark.parametrize("cores", ["1", "3"])
def test_what_is_done_is_counted(cores: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MOYAI_THREADS", cores)
    heard: list[tuple[str, float, float]] = []
    found = each_counted("parts", lambda item, _: 2 * item, [3, 1, 2], lambda *report: heard.append(report))
    assert found == [6, 2, 4]
    assert heard == [("parts", number, 3) for number in range(4)]


@pytest.mark.parametrize("cores", ["1", "2"])
def test_what_was_done_before_a_stop_is_kept(cores: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MOYAI_THREADS", cores)

    def listen(what: str, done: float, total: float) -> None:
        if done == 3:
            raise KeyboardInterrupt

    def work(item: int, heard: Progress) -> int:
        while item > 3:
            time.sleep(0.01)
            heard("waiting", 0, 1)
        return -item

    found = []
    with pytest.raises(KeyboardInterrupt):
        for value in one_after_the_other(work, range(7), "parts", listen):
            found.append(value)
    assert found in ([0, -1, -2], [0, -1, -2, -3])


def test_what_is_done_before_it_is_taken_is_bounded() -> None:
    begun: list[int] = []

    def work(item: int, _: Progress) -> int:
        begun.append(item)
        return item

    every = one_after_the_other(work, range(100), "parts")
    assert [next(every), next(every)] == [0, 1]
    assert len(begun) == 12
    assert list(every) == [*range(2, 100)]
