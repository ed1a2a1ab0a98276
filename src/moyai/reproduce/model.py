"""What a paper consists of here: equations, figures, statements and the inputs that it leaves out, each frozen.

A module of this package describes one paper. Its runs compute everything; a statement is judged from those runs, so
that what the page says is found anew each time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from moyai.core.options import checks_words
from moyai.core.progress import Progress
from moyai.report.document import Drawing, Figure

Verdict = Literal["agrees", "differs", "open"]


@dataclass(frozen=True)
class Equation:
    """A numbered equation."""

    #: As in the paper.
    number: str
    #: What it gives, in words.
    subject: str
    #: Dotted names of the code that computes it.
    places: tuple[str, ...]
    #: Misprints and how the code reads them; empty where the print is sound.
    note: str = ""


@checks_words
@dataclass(frozen=True)
class Finding:
    """What the runs say about a statement."""

    #: The numbers that were computed, in words.
    found: str
    #: ``open`` where it cannot be decided, as with measured points that are not published as numbers; one of "agrees",
    #: "differs", "open".
    verdict: Verdict
    #: The reason for a difference, or what stays open.
    why: str = ""


@dataclass(frozen=True)
class Statement:
    """One statement of the text of a paper."""

    #: Unique within the paper.
    key: str
    #: Section and figure of the paper.
    place: str
    #: What it says, in words of our own.
    text: str
    #: Takes the runs of the paper, returns a :class:`Finding`.
    judge: Callable[[Any], Finding]


@dataclass(frozen=True)
class PaperFigure:
    """A figure of the paper, drawn again."""

    #: As in the paper, with the letter of its part: ``5c``.
    number: str
    #: ``None`` where it is not drawn; the note says why.
    drawn: Figure | Drawing | None
    note: str = ""


@dataclass(frozen=True)
class FilledInput:
    """An input that the paper leaves out, and how far the answer moves with it."""

    #: What it is.
    name: str
    #: What was taken.
    value: str
    #: Other values that were tried.
    varied: str
    #: What they do to a number of the paper; computed.
    effect: str


@dataclass(frozen=True)
class Paper:
    """One paper."""

    #: Name on the command line.
    key: str
    authors: str
    year: str
    title: str
    journal: str
    #: What is reproduced, in one line.
    line: str
    equations: tuple[Equation, ...]
    statements: tuple[Statement, ...]
    #: Numbers of the figures that are curves, over which points can be laid.
    plotted: tuple[str, ...]
    #: ``run(quick, progress)`` computes everything and returns the runs.
    run: Callable[[bool, Progress], Any]
    #: Takes the runs, returns the figures.
    figures: Callable[[Any], tuple[PaperFigure, ...]]
    #: Takes the runs, returns the inputs that were filled in.
    filled: Callable[[Any], tuple[FilledInput, ...]]


def judged(condition: bool, found: str, otherwise: str = "the run does not show it") -> Finding:
    """Return the finding of a statement that a condition decides.

    Parameters
    ----------
    condition : bool
    found : str
        The numbers behind it.
    otherwise : str
        The reason where it does not hold.
    """
    return Finding(found, "agrees") if condition else Finding(found, "differs", otherwise)


MEASURED = "the measured points are not published as numbers; lay your own over the figure with --points"


def measured(found: str, why: str = MEASURED) -> Finding:
    """Return the finding of a statement on measurements that only figures show."""
    return Finding(found, "open", why)
