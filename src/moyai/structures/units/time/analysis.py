"""The time domain of one water level: memory, runs of every sea, what they have to say."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.progress import Progress
from moyai.core.store import DatasetStore
from moyai.core.validity import IdentityCheck, Notice
from moyai.sea.states import IrregularSea, RegularSea
from moyai.structures.units.assembly import RowAtLevel
from moyai.structures.units.hydrodynamics import RowHydrodynamics
from moyai.structures.units.model import SNAP_RATIO, Settings
from moyai.structures.units.seas import SeaAnswer
from moyai.structures.units.time.band import wide_coefficients
from moyai.structures.units.time.datasets import (
    Kept,
    irregular_time_dataset,
    memory_dataset,
    regular_time_dataset,
    shown_run,
    status_of,
)
from moyai.structures.units.time.memory import RowMemory, fit_row_memory
from moyai.structures.units.time.seas import Water3D, irregular_run, regular_run

if TYPE_CHECKING:
    import xarray as xr

#: Peak periods in a record, below which its largest values say nothing of the sea state
LEAST_WAVES = 10.0
#: Error of the memory that is told, of the largest response
_TOLD = 0.02


@dataclass(frozen=True)
class SeaInTime:
    """What a sea gave.

    Parameters
    ----------
    groups : dict
        Datasets by the end of their path.
    notices : list of Notice
    status : str
    message : str
        Of the run that did not come to its end.
    """

    groups: dict[str, xr.Dataset]
    notices: list[Notice]
    status: str
    message: str = ""


def water_in_time(
    at: RowAtLevel, hydro: RowHydrodynamics, steady: Array, settings: Settings, *, store: DatasetStore | None,
    progress: Progress,
) -> tuple[Water3D, dict[str, xr.Dataset], list[IdentityCheck], list[Notice]]:  # fmt: skip
    """Solve the band of the memory and fit it; return also its dataset, identities and notices."""
    wide = wide_coefficients(hydro, settings.time.memory_frequencies, store=store, progress=progress)
    band = float(hydro.omega[0]), float(hydro.omega[-1])
    memory: RowMemory = fit_row_memory(wide.omega, wide.added_mass, wide.damping, band=band)
    checks = [replace(item, name=f"{at.name}: {item.name}") for item in memory.checks]
    notices = [
        Notice(
            "memory",
            f"{at.name}: {len(memory.poles)} poles carry the memory of the water; added mass and damping within "
            f"{100.0 * memory.error:.2g} % of the largest of their pair in the band of the waves, "
            f"{100.0 * memory.error_outside:.2g} % outside",
            value=memory.error, limit=_TOLD, severity="information" if memory.error <= _TOLD else "warning",
            remedy="give smaller panels or more settings.time.memory_frequencies",
        )
    ]  # fmt: skip
    data = {"memory": memory_dataset(at, memory, wide.omega)}
    return Water3D(at, wide, memory, steady, settings), data, checks, notices


def sea_in_time(
    water: Water3D, sea: RegularSea | IrregularSea, answers: list[SeaAnswer], progress: Progress
) -> SeaInTime:
    """Run all periods or all realisations of a sea."""
    runs: list[Kept] = []
    for kept in _runs(water, sea, answers, progress):
        runs.append(kept)
        if kept.status != "converged":
            break
    good = [item for item in runs if item.status == "converged"] or runs[:1]
    regular = isinstance(sea, RegularSea)
    if isinstance(sea, RegularSea):
        data = regular_time_dataset(water.at, sea, good)
        groups = {f"T{period:g}": item.series for period, item in zip(sea.periods, good)}
    else:
        data = irregular_time_dataset(water.at, sea, good)
        groups = {"realisation": good[shown_run(good)].series}
    data.attrs["status"] = status_of(runs)
    data.attrs["drift"] = "mean" if regular else ("newman" if water.settings.drift else "none")
    bad = [item.message for item in runs if item.status == "diverged"]
    return SeaInTime(
        {"": data} | {f"/{name}": item for name, item in groups.items()}, _notices(water, sea, data, good),
        status_of(runs), bad[0] if bad else "",
    )  # fmt: skip


def _runs(
    water: Water3D, sea: RegularSea | IrregularSea, answers: list[SeaAnswer], progress: Progress
) -> Iterator[Kept]:
    if isinstance(sea, RegularSea):
        for period, answer in zip(sea.periods, answers):
            yield Kept.of(regular_run(water, sea, period, answer, progress))
        return
    for number in range(water.time.realisations):
        progress(f"realisations, {water.at.name}, {sea.name}", number, water.time.realisations)
        yield Kept.of(irregular_run(water, sea, number, answers[0], progress))


def _notices(water: Water3D, sea: RegularSea | IrregularSea, data: xr.Dataset, runs: list[Kept]) -> list[Notice]:
    where = f"{water.at.name}, {sea.name}"
    out: list[Notice] = []
    if not all(item.contacts for item in runs):
        out.append(
            Notice(
                "contacts-not-resolved",
                f"{where}: a stiff connector comes tight within fewer than ten steps; its largest load is uncertain",
                remedy="give a shorter settings.time.time_step",
            )
        )
    if data.sizes["line"]:
        named = "line_tension_maximum_of_realisation"
        largest = data[named if named in data else "line_tension_maximum"].values
        mean = np.broadcast_to(data["line_tension_mean"].values, largest.shape)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.nan_to_num(largest / mean)
        if float(ratio.max()) > SNAP_RATIO:
            line = str(data["line"].values[int(np.unravel_index(ratio.argmax(), ratio.shape)[-1])])
            out.append(
                Notice(
                    "snaps",
                    f"{where}: line '{line}' is pulled to {float(ratio.max()):.3g} times its mean tension, beyond the "
                    "range of lines at rest at every instant: its largest tension is higher than what is shown",
                    value=float(ratio.max()), limit=SNAP_RATIO,
                    remedy="use longer or softer lines; a breakwater of one unit runs them in motion",
                )
            )  # fmt: skip
    if isinstance(sea, IrregularSea):
        waves = sea.duration * float(sea.spectrum.peak_omega) / (2.0 * np.pi)
        if waves < LEAST_WAVES:
            out.append(
                Notice(
                    "short-record",
                    f"{where}: the record of {sea.duration:g} s holds {waves:.3g} peak periods; its largest values are "
                    "none of the sea state",
                    value=waves, limit=LEAST_WAVES, severity="error", remedy="give a longer duration",
                )
            )  # fmt: skip
    return out
