"""Flume runs as stated, and what was found in each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from moyai.core.options import checks_words
from moyai.core.validity import Notice
from moyai.structures.curtain.impact.cable import Impact, ImpactNumbers
from moyai.structures.curtain.impact.compare import Comparison
from moyai.structures.curtain.impact.skirt import Skirt
from moyai.structures.curtain.model import RecordedSnap

#: Whether records were measured or computed
Origin = Literal["measured", "generated"]


@dataclass(frozen=True)
class SnapRun:
    """One release.

    Parameters
    ----------
    name, cable : str
        Of the run, of the material of its cables.
    impact : Impact
        The span; its speed is that of the current.
    skirt : Skirt or None
    record : RecordedSnap
    """

    name: str
    cable: str
    impact: Impact
    skirt: Skirt | None
    record: RecordedSnap


@checks_words
@dataclass(frozen=True)
class SnapRuns:
    """A set of runs.

    Parameters
    ----------
    title : str
    origin : {"measured", "generated"}
    drag_coefficient : float or None
        Of the drift of the slack curtain.
    memory : bool
        Whether to run the model with memory.
    runs : tuple of SnapRun
    """

    title: str
    origin: Origin
    drag_coefficient: float | None
    memory: bool
    runs: tuple[SnapRun, ...]


@dataclass(frozen=True)
class SnapFinding:
    """What was found in one run.

    Parameters
    ----------
    run : SnapRun
    numbers : ImpactNumbers
        C_T of the measured impact (peak less drag level, both cables), C_E, Fr; all with the speed of the current.
    start_speed : float
        Speed of the models when the cables become taut [m/s].
    comparison : Comparison
        The models on this run.
    """

    run: SnapRun
    numbers: ImpactNumbers
    start_speed: float
    comparison: Comparison


@dataclass(frozen=True)
class Exponents:
    """C_T as a product of powers of the similarity numbers that vary among the runs [eq:snap-runs-powers].

    Parameters
    ----------
    of : str
        ``record``, or the name of a model.
    names : tuple of str
        ``froude``, ``span_ratio``, ``depth_ratio``, ``cauchy`` as far as they vary.
    values, low, high : tuple of float
        Exponents and their bounds of 95 %.
    scatter : float
        Standard deviation of the logarithm of C_T about the product.
    """

    of: str
    names: tuple[str, ...]
    values: tuple[float, ...]
    low: tuple[float, ...]
    high: tuple[float, ...]
    scatter: float


@dataclass(frozen=True)
class Agreement:
    """A model over the records of all runs.

    Parameters
    ----------
    model : str
    ratio, low, high : float
        Geometric mean of model over record, and its bounds of 95 %.
    scatter : float
        Standard deviation of the logarithm of that ratio.
    count : int
    """

    model: str
    ratio: float
    low: float
    high: float
    scatter: float
    count: int


@dataclass(frozen=True)
class SnapFindings:
    """All runs, and what they say together.

    Parameters
    ----------
    runs : SnapRuns
    found : tuple of SnapFinding
    agreements : tuple of Agreement
        One for each model that every run has.
    exponents : tuple of Exponents
        Of the records, then of each of these models.
    notices : tuple of Notice
    """

    runs: SnapRuns
    found: tuple[SnapFinding, ...]
    agreements: tuple[Agreement, ...]
    exponents: tuple[Exponents, ...]
    notices: tuple[Notice, ...]
