"""Flume runs as stated, and what was found in each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from moyai.core.options import checks_words
from moyai.core.validity import Notice
from moyai.structures.curtain.impact.cable import Impact, ImpactNumbers
from moyai.structures.curtain.impact.compare import Comparison
from moyai.structures.curtain.impact.skirt import BulgedSkirt
from moyai.structures.curtain.model import RecordedSnap

#: Whether records were measured or computed
Origin = Literal["measured", "generated"]


@dataclass(frozen=True)
class SnapRun:
    """One release."""

    #: Of the run.
    name: str
    #: Material of its cables.
    cable: str
    #: The span; its speed is that of the current.
    impact: Impact
    skirt: BulgedSkirt | None
    record: RecordedSnap


@checks_words
@dataclass(frozen=True)
class SnapRuns:
    """A set of runs."""

    title: str
    #: One of "measured", "generated".
    origin: Origin
    #: Of the drift of the slack curtain.
    drag_coefficient: float | None
    #: Whether to run the model with memory.
    memory: bool
    runs: tuple[SnapRun, ...]


@dataclass(frozen=True)
class SnapFinding:
    """What was found in one run."""

    run: SnapRun
    #: C_T of the measured impact (peak less drag level, both cables), C_E, Fr; all with the speed of the current.
    numbers: ImpactNumbers
    #: Speed of the models when the cables become taut [m/s].
    start_speed: float
    #: The models on this run.
    comparison: Comparison


@dataclass(frozen=True)
class Exponents:
    """C_T as a product of powers of the similarity numbers that vary among the runs [eq:snap-runs-powers]."""

    #: ``record``, or the name of a model.
    of: str
    #: ``froude``, ``span_ratio``, ``depth_ratio``, ``cauchy`` as far as they vary.
    names: tuple[str, ...]
    #: Exponents.
    values: tuple[float, ...]
    #: Lower bounds of 95 %.
    low: tuple[float, ...]
    #: Upper bounds of 95 %.
    high: tuple[float, ...]
    #: Standard deviation of the logarithm of C_T about the product.
    scatter: float


@dataclass(frozen=True)
class SnapAgreement:
    """A model over the records of all runs."""

    model: str
    #: Geometric mean of model over record [-].
    ratio: float
    #: Its lower bound of 95 % [-].
    low: float
    #: Its upper bound of 95 % [-].
    high: float
    #: Standard deviation of the logarithm of that ratio.
    scatter: float
    count: int


@dataclass(frozen=True)
class SnapFindings:
    """All runs, and what they say together."""

    runs: SnapRuns
    found: tuple[SnapFinding, ...]
    #: One for each model that every run has.
    agreements: tuple[SnapAgreement, ...]
    #: Of the records, then of each of these models.
    exponents: tuple[Exponents, ...]
    notices: tuple[Notice, ...]
