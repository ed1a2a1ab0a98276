"""Uncertainty of the peaks of a run: each cable and line with another step, mesh, viscosity, and with held normals."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from moyai.core.at_once import each_at_once
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice
from moyai.structures.curtain.dynamic.checks import plain
from moyai.structures.curtain.dynamic.model import Mesh
from moyai.structures.curtain.dynamic.runs import DynamicRun, run_span

#: Change of a peak with step and mesh beyond which it is reported, and the share of the highest peak that matters.
LIMIT, _MATTERS = 0.05, 0.05
#: Change of the peak with held normals beyond which folds of cloth are suspected.
_APART = 0.3
#: Cables and lines named in one notice.
_NAMED = 3
#: Change from half the cells beyond which nothing is extrapolated.
_POINTING = 0.2
#: The sum of both cables, next to the names of the lines.
BOTH = "both"


@dataclass(frozen=True)
class PeakUncertainty:
    """The peak of one cable or line, and what it is in other runs [N]; NaN for a run that was not made or stopped."""

    #: Of the run itself.
    peak: float
    #: With half the step.
    half_step: float = math.nan
    #: With half as many cells both ways.
    half_mesh: float = math.nan
    #: With twice the viscosity of cables and skirt.
    double_viscosity: float = math.nan
    #: In waves: with sections of added mass that keep the normals of the just-taut span.
    held_normals: float = math.nan

    @property
    def extrapolated(self) -> float:
        """Value that the two meshes point to when the error falls with the size of the cells [N].

        NaN where they are more than a fifth apart: the cells are then too large for an error that falls with them.
        """
        return 2.0 * self.peak - self.half_mesh if self.mesh_error <= _POINTING else math.nan

    @property
    def mesh_error(self) -> float:
        """Change from half the cells to those used, over the peak [-]; NaN without the coarser mesh."""
        return abs(self.half_mesh / self.peak - 1.0) if self.peak > 0.0 else math.nan

    @property
    def error(self) -> float:
        """Larger change with mesh or step, over the peak [-]; NaN without either."""
        step = abs(self.half_step / self.peak - 1.0) if self.peak > 0.0 else math.nan
        known = [value for value in (self.mesh_error, step) if math.isfinite(value)]
        return max(known, default=math.nan)


@dataclass(frozen=True)
class PeakUncertainties:
    """Uncertainty of every peak of a run."""

    #: By the names of the cables and lines, and ``both``.
    of: dict[str, PeakUncertainty]
    #: What is to be said of runs that had to stop.
    stopped: tuple[str, ...] = ()

    def notices(self, place: str, limit: float = LIMIT) -> tuple[Notice, ...]:
        """Report peaks that mesh, step or viscosity change, for each cable and line, and the runs that are missing."""
        found = [
            Notice("dynamic-sensitivity", f"{place}: {words}", math.nan, math.nan, "warning", "", "guard on energy")
            for words in self.stopped
        ]
        highest = max(one.peak for one in self.of.values())
        poor = {
            name: one
            for name, one in self.of.items()
            if one.error > limit and max(one.peak, one.half_mesh) > _MATTERS * highest
        }
        if poor:
            said = "; ".join(
                f"{'both cables' if name == BOTH else name} by {100.0 * one.error:.1f} % "
                f"({plain(one.peak)} N, half the cells {plain(one.half_mesh)} N, half the step "
                f"{plain(one.half_step)} N)"
                for name, one in sorted(poor.items(), key=lambda item: -item[1].error)[:_NAMED]
            )
            if len(poor) > _NAMED:
                said += f"; {len(poor) - _NAMED} more by less"
            worst = max(one.error for one in poor.values())
            found.append(
                Notice("dynamic-peak-mesh", f"{place}: peaks move with step and mesh: {said}", worst, limit, "warning",
                       "take more cells along and down the skirt",
                       "runs with half the step and with half as many cells")
            )  # fmt: skip
        both = self.of[BOTH]
        turn = abs(both.held_normals / both.peak - 1.0) if both.peak > 0.0 else math.nan
        if turn > limit:
            found.append(
                Notice("dynamic-normals", f"{place}: with sections of added mass that keep their normals the peak of "
                       f"both cables is {plain(both.held_normals)} N, not {plain(both.peak)} N: the effect of the "
                       "turn of the curtain, and of folded cloth with it", turn, limit,
                       "warning" if turn > _APART else "information", "",
                       "a run with held normals")
            )  # fmt: skip
        return tuple(found)


def span_uncertainty(run: DynamicRun, *, progress: Progress = silent, **arguments: object) -> PeakUncertainties:
    """Run a span again with half the step, half the cells and twice the viscosity; in waves also with held normals.

    Parameters
    ----------
    run : DynamicRun
        The run itself.
    progress : Progress
    **arguments
        ``water`` and the further arguments of :func:`run_span` with which it was made.

    Raises
    ------
    KeyboardInterrupt
        When the user stopped one.
    """
    built = run.built
    mesh, sheets = built.mesh, built.network.sheets
    cable = built.network.bars.types[0].viscosity
    assert sheets is not None
    skirt = float(np.max(sheets.damping_time))
    # the same viscosity on every mesh: it belongs to the material, not to the cells
    same = replace(mesh, cable_viscosity=cable, skirt_damping_time=skirt)
    names = (BOTH, *run.names)
    coarse = replace(same, along=max(4, mesh.along // 2), down=max(2, mesh.down // 2))
    trials: dict[str, tuple[str, Mesh, float]] = {
        "half_step": ("half the step", mesh, 0.5),
        "half_mesh": ("half the cells", coarse, 1.0),
        "double_viscosity": (
            "twice the viscosity",
            replace(mesh, cable_viscosity=2.0 * cable, skirt_damping_time=2.0 * skirt),
            1.0,
        ),
    }
    if run.flow.waves is not None and mesh.turning:
        trials["held_normals"] = ("held normals", replace(same, turning=False), 1.0)

    def made(trial: tuple[str, Mesh, float], heard: Progress) -> DynamicRun:
        words, other, shorter = trial

        def told(_: str, done: float, total: float) -> None:
            heard(words, done, total)

        found = run_span(built.span, other, **{**arguments, "shorter": shorter, "progress": told})  # type: ignore[arg-type]
        if found.history.status == "interrupted":
            raise KeyboardInterrupt
        return found

    peaks: dict[str, dict[str, float]] = {name: {"peak": run.peak(name)[0]} for name in names}
    stopped = []
    for (key, (words, *_)), found in zip(
        trials.items(), each_at_once(made, list(trials.values()), progress), strict=True
    ):
        if found.history.status != "converged":
            stopped.append(f"the run with {words} stopped: {found.history.message}")
            continue
        for name in names:
            peaks[name][key] = found.peak(name)[0]
    return PeakUncertainties({name: PeakUncertainty(**values) for name, values in peaks.items()}, tuple(stopped))


__all__ = ["BOTH", "LIMIT", "PeakUncertainties", "PeakUncertainty", "span_uncertainty"]
