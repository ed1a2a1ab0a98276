"""What makes the peaks of a run doubtful: fronts, ropes beyond their curves, long steps, energy balance error.

Runs of networks alone and of networks with bodies are reported by the same functions.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.validity import IdentityCheck, Notice
from moyai.flexible.explicit import ExplicitRun
from moyai.flexible.fronts import front_notices
from moyai.flexible.implicit import ImplicitRun
from moyai.flexible.network import Network

Run = ExplicitRun | ImplicitRun


def peak_notices(
    network: Network, run: Run, bars: NDArray[np.int64], peaks: Array, check: IdentityCheck, finished: bool
) -> tuple[Notice, ...]:
    """Return what is reported of the peaks of a run.

    Parameters
    ----------
    network : Network
        The network.
    run : ExplicitRun or ImplicitRun
        The run at its end.
    bars : ndarray of int, shape (b,)
        Kept bars.
    peaks : ndarray, shape (k, b)
        Their highest tensions between rows [N].
    check : IdentityCheck
        Energy balance error.
    finished : bool
        Whether the run came to its end; one that was stopped has said why.
    """
    return (
        *peak_front_notices(network, run),
        *_doubts(network, run, check, finished),
        *beyond_curves(network, bars, peaks),
    )


def peak_front_notices(network: Network, run: Run) -> tuple[Notice, ...]:
    """Return reports of wave fronts; at the pace of the wave they are exact but for nodes that land on a bed."""
    paced = _at_wave_pace(run)
    fronts = [one for one in run.watch.fronts(network) if one.fall > 0.0 or not paced]
    return front_notices(network, fronts, explicit=isinstance(run, ExplicitRun))


def beyond_curves(network: Network, bars: NDArray[np.int64], peaks: Array) -> tuple[Notice, ...]:
    """Tell of ropes that were pulled harder than their curves are tabulated: the last slope went on."""
    found = []
    for slot, kind in enumerate(network.bars.types):
        if kind.curve is None:
            continue
        highest = float(np.max(peaks[:, network.bars.kind[bars] == slot], initial=0.0))
        last = float(kind.curve.tension[-1])
        if highest > last * (1.0 + 1e-9):
            found.append(
                Notice(
                    "beyond-rope-curve",
                    f"{kind.name!r} carries up to {highest:.4g} N, its rope curve ends at {last:.4g} N: "
                    "its last slope is used beyond",
                    highest,
                    last,
                    "warning",
                    "tabulate the rope up to its breaking load",
                )
            )
    return tuple(found)


def _at_wave_pace(run: Run) -> bool:
    """Whether the steps were those of the elastic wave; rows that no whole number of them fills make them shorter."""
    return isinstance(run, ExplicitRun) and run.safety == 1.0 and run.step >= 0.99 * stable_step(run)


def _doubts(network: Network, run: Run, check: IdentityCheck, finished: bool) -> tuple[Notice, ...]:
    found = []
    overstep = getattr(run, "overstep", 0.0)
    if overstep > 1.0 + 1e-9:
        found.append(
            Notice(
                "step-not-stable",
                f"the step of {run.step:.4g} s is {overstep:.3g} times the stable step of the network: peaks may be "
                "wrong",
                overstep,
                1.0,
                "warning",
                "leave the step out, or give a shorter one",
            )
        )
    if finished and check.value > check.tolerance:
        found.append(
            Notice(
                "energy-from-nowhere",
                f"{100.0 * check.value:.3g} % of the energy is spurious (error of the energy balance); peaks may be "
                "too high",
                check.value,
                check.tolerance,
                "warning",
                "give a smaller safety or step, or an implicit method with a smaller tolerance" + advice(network),
            )
        )
    return tuple(found)


def advice(network: Network) -> str:
    """Return what helps where bars without viscosity go slack and taut: the energy of the mesh has nowhere to go."""
    bars = network.bars
    if not len(bars) or not np.any(bars.of_type("tension_only") > 0.0):
        return ""
    wanted = 0.05 * float(
        np.max(bars.length * np.sqrt(bars.of_type("axial_stiffness") * bars.of_type("mass_per_length")))
    )
    lacking = bars.of_type("viscosity") < 0.5 * wanted
    return f"; a viscosity of {wanted:.2g} N s calms bars that go slack on this mesh" if lacking.any() else ""


def stable_step(run: Run) -> float:
    """Return the largest stable step of a run now [s], NaN once its values are not finite."""
    return run.limit()[0] if np.isfinite(run.place).all() else np.nan
