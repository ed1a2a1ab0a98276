"""A hundred seeds of the first example's storm side by side: processor time a seed over that of one by itself.

    OMP_NUM_THREADS=1 python benchmarks/bench_seeds.py [--seeds 100]

The march alone, with the forces and lines of the run; the forces of the seeds are those of one with other amplitudes.
"""

from __future__ import annotations

import argparse
import json
import time
from collections.abc import Callable
from typing import Any

from moyai.case.reader import load_case
from moyai.case.templates import template
from moyai.cli.runner import run
from moyai.floating import simulate, simulate_together
from moyai.structures.breakwater.time import model as time_model


def best(work: Callable[[], object], times: int = 3) -> float:
    """Return the shortest processor time of some runs [s]."""
    found = []
    for _ in range(times):
        clock = time.process_time()
        work()
        found.append(time.process_time() - clock)
    return min(found)


def main() -> None:
    """Print one line of JSON."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--seeds", type=int, default=100)
    seeds = parser.parse_args().seeds
    taken: list[tuple[Any, Any, dict[str, Any]]] = []

    def listening(model: Any, forcings: Any, **given: Any) -> Any:
        taken.append((model, forcings, given))
        return simulate_together(model, forcings, **given)

    time_model.simulate_together = listening
    run(load_case(template("breakwater")))
    model, forcings, given = taken[0]
    given = {key: value for key, value in given.items() if key != "progress"}
    many = [forcings[number % len(forcings)] for number in range(seeds)]
    alone = best(lambda: simulate(model, forcings[0], **given))
    clock = time.process_time()
    for first in range(0, seeds, 8):
        simulate_together(model, many[first : first + 8], **given)
    together = (time.process_time() - clock) / seeds
    print(json.dumps({
        "seeds": seeds, "duration": given["duration"], "seconds_alone": alone, "seconds_a_seed": together,
        "times_as_fast": alone / together, "seconds_in_all": together * seeds,
    }))  # fmt: skip


if __name__ == "__main__":
    main()
