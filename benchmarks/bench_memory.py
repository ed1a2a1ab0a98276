"""Memory of the 10 m x 3 m pontoon in 10 m of water: what frequencies, kernels and states cost.

    python benchmarks/bench_memory.py

CPU seconds, one thread, warm, compilation excluded. The limit for the quadrature is the trapezoidal rule with as many
points as it takes to be as accurate. Prints JSON lines and fails when an identity does not hold.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from moyai.potential.damping_tail import wall_sided_tails
from moyai.potential.memory import memory_functions, pair_measure
from moyai.potential.memory_plan import recommend_frequencies
from moyai.potential.rectangle import solve_rectangle
from moyai.potential.state_space import fit_memory
from moyai.sea.water import Water

BEAM, DRAUGHT, CENTRE_Z = 10.0, 3.0, -0.71


def cpu(work: Callable[[], Any], repeat: int = 5) -> tuple[float, Any]:
    """Return the least CPU time of several runs and the last result."""
    result = work()
    times = []
    for _ in range(repeat):
        start = time.process_time()
        result = work()
        times.append(time.process_time() - start)
    return min(times), result


def say(**record: Any) -> None:
    """Print one JSON line."""
    print(json.dumps(record))


def main() -> int:
    """Run all measurements."""
    water = Water(10.0, 1025.0, 9.81)
    plan = recommend_frequencies(water, breadth=BEAM, wall_height=DRAUGHT)
    spent, solution = cpu(lambda: solve_rectangle(BEAM, DRAUGHT, water, plan.omega, centre=(0.0, CENTRE_Z)), 3)
    worst = max(check.value for check in solution.checks)
    say(what="rectangle reference", frequencies=len(plan.omega), cpu_s=spent, worst_identity=worst)

    grid = np.linspace(0.0, 60.0, 1201)

    def memory() -> Any:
        return memory_functions(
            plan.omega,
            solution.radiation_damping,
            solution.infinite_frequency_added_mass,
            grid,
            start="even",
            tail_theory=wall_sided_tails(water, CENTRE_Z),
            added_mass=solution.added_mass,
        )

    spent, functions = cpu(memory)
    identities = {check.name: check.value for check in functions.checks}
    say(what="memory functions, both forms", times=len(grid), cpu_s=spent, **identities)

    # the plain way: trapezoidal rule over the same model, cut off at the last frequency and at five times that
    exact = functions.velocity_kernel
    for end in (1.0, 5.0):
        fine = np.linspace(0.0, end * plan.omega[-1], 4001)
        values = functions.model.damping(fine)
        plain, kernel = cpu(
            lambda fine=fine, values=values: (
                2.0 / np.pi * np.trapezoid(np.cos(grid[:, None] * fine)[:, :, None, None] * values, fine, axis=1)
            ),
            1,
        )
        error = float((np.abs(kernel - exact) / pair_measure(exact)).max())
        say(what="trapezoidal rule, 4001 points", cut_at_last_frequency_times=end, cpu_s=plain, error=error)

    for tolerance in (1e-2, 1e-3, 1e-4):
        spent, states = cpu(lambda tolerance=tolerance: fit_memory(functions, tolerance=tolerance, highest_order=40), 2)
        say(
            what="state space",
            tolerance=tolerance,
            states=states.order,
            fit_cpu_s=spent,
            response_error=states.error,
            least_damping=states.least_damping,
        )
    failed = worst > 1e-9 or identities["Kramers-Kronig"] > 1e-3
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
