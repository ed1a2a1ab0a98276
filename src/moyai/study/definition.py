"""A study as data, and what runs one of its cases."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from moyai.case.reader import Case
from moyai.case.yaml_reader import CaseDocument
from moyai.core.options import checks_words
from moyai.core.progress import Progress
from moyai.study import schema
from moyai.study.axes import Axis, Combination
from moyai.study.responses import Wanted

RunCase = Callable[[Case, Progress], Any]
"""What runs one case: it takes the case and a listener and returns a ``Result``."""


@checks_words
@dataclass(frozen=True)
class Study:
    """A study that was read and found sound."""

    #: Title of the study.
    title: str
    #: The base case as read.
    base: CaseDocument
    #: Its file.
    base_path: Path
    #: Along which it is varied.
    axes: tuple[Axis, ...]
    #: The product of the axes.
    cases: tuple[Combination, ...]
    #: Responses that were asked for.
    wanted: tuple[Wanted, ...]
    #: Variable that is shown on the way.
    watch: str
    #: Keep results.nc of every case.
    keep_results: bool
    #: Hash of everything that the results depend on.
    key: str
    #: What is searched for in every case.
    search: schema.LimitSearch | schema.Optimisation | None = None
    #: What is made of all cases together.
    assessment: schema.Assessment | None = None
    #: Number of governing cases that are run again with a report of their own.
    replays: int = 3
    #: Cases that the check refuses become rows with the reason, instead of stopping the study.
    skips_refused: bool = False
    #: Numbers of the cases that were refused, of those that were checked beforehand.
    refused: tuple[int, ...] = ()

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of points on every axis."""
        return tuple(len(axis.points) for axis in self.axes)
