"""Which events are rerun with lines in motion, and what is left open, with tensions given by hand."""

from types import SimpleNamespace

import numpy as np
import pytest

from moyai.floating.time import Simulation
from moyai.structures.breakwater.lines import search as line_search
from moyai.structures.breakwater.lines.search import MOST_EVENTS, events_in_motion, events_in_order


def record(peaks, spacing=100.0):
    """A record with one triangular event of each height, ``spacing`` seconds apart."""
    time = np.arange(0.0, spacing * (len(peaks) + 1), 0.5)
    tension = np.full(time.size, 1.0)
    for number, peak in enumerate(peaks):
        tension = np.maximum(tension, peak * (1.0 - np.abs(time - spacing * (number + 1)) / 5.0))
    blank = np.zeros((time.size, 3))
    return Simulation(time, blank, blank, blank, tension[:, None], time, 0.5, "converged", "")


def search(monkeypatch, realisations, in_motion, floor=0.0):
    """Search with reruns whose tension is a function of the tension with lines at rest."""
    called = []

    def rerun(given, forcing, around, simulation, line, event, progress):
        still = float(np.interp(event, simulation.time, simulation.tension[:, 0]))
        called.append(still)
        return SimpleNamespace(simulation=SimpleNamespace(status="converged"), tension=in_motion(still))

    monkeypatch.setattr(line_search, "run_event", rerun)
    monkeypatch.setattr(
        line_search, "event_numbers", lambda model, run: {"line_tension_maximum": np.array([run.tension])}
    )
    monkeypatch.setattr(line_search, "event_offsets", lambda run: np.full((2, 3), run.tension))
    members = [
        SimpleNamespace(run=SimpleNamespace(simulation=record(peaks)), forcing=None,
                        around=SimpleNamespace(begin=0.0))
        for peaks in realisations
    ]  # fmt: skip
    model = SimpleNamespace(unit=SimpleNamespace(name="SWL"))
    given = SimpleNamespace(peak_period=5.0, model=model, moving=model)
    return events_in_motion(given, members, 0, floor), called


def test_events_come_in_order_and_apart():
    run = record([100.0, 300.0, 200.0])
    found = events_in_order(run, 0, 0.0, 20.0)
    assert [peak for _, peak in found] == pytest.approx([300.0, 200.0, 100.0])
    assert [time for time, _ in found] == pytest.approx([200.0, 300.0, 100.0])
    # one event within the window of a higher one is part of it; one before the begin does not count
    assert len(events_in_order(run, 0, 0.0, 150.0)) == 1
    assert len(events_in_order(run, 0, 150.0, 20.0)) == 2


def test_the_largest_in_motion_is_found_behind_a_larger_one_at_rest(monkeypatch):
    # the highest event at rest loses its shock to drag, the second gains
    (found,), called = search(monkeypatch, [[800.0, 600.0, 100.0]], {800.0: 400.0, 600.0: 660.0, 100.0: 90.0}.get)
    assert found.numbers["line_tension_maximum"][0] == 660.0
    # 100 times 1.1 cannot pass 660: not rerun, and nothing is left open
    assert called == [800.0, 600.0] and found.count == 2 and found.bound == 660.0


def test_a_ratio_of_one_realisation_holds_for_all(monkeypatch):
    # 500 alone would stay under 510; the other realisation tells of half as much again
    tensions = {600.0: 510.0, 500.0: 480.0, 200.0: 300.0, 90.0: 80.0}
    found, called = search(monkeypatch, [[600.0, 500.0], [200.0, 90.0]], tensions.get)
    assert 500.0 in called and 90.0 not in called
    assert [item.numbers["line_tension_maximum"][0] for item in found] == [510.0, 300.0]
    assert [item.offsets[:, 0, 0].tolist() for item in found] == [[510.0, 480.0], [300.0]]


def test_what_the_limit_on_events_leaves_open_is_a_bound(monkeypatch):
    peaks = [900.0 - number for number in range(MOST_EVENTS + 4)]
    (found,), called = search(monkeypatch, [peaks], lambda still: 0.5 * still)
    assert len(called) == MOST_EVENTS
    assert found.bound == pytest.approx(900.0 - MOST_EVENTS)
    assert found.numbers["line_tension_maximum"][0] == 450.0


def test_a_line_that_cannot_govern_is_rerun_once(monkeypatch):
    (found,), called = search(monkeypatch, [[300.0, 290.0, 280.0]], lambda still: 0.5 * still, floor=1000.0)
    assert called == [300.0] and found.numbers["line_tension_maximum"][0] == 150.0
