"""What a paper consists of here: equations, figures, statements and the inputs that it leaves out, each frozen.

A module of this package describes one paper. Its runs compute everything; a statement is judged from those runs, so
that what the page says is found anew each time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from moyai.core.progress import Progress
from moyai.report.document import Drawing, Figure

Verdict = Literal["agrees", "differs", "open"]


@dataclass(frozen=True)
class Equation:
    """A numbered equation.

    Parameters
    ----------
    number : str
        As in the paper.
    subject : str
        What it gives, in words.
    places : tuple of str
        Dotted names of the code that computes it.
    note : str
        Misprints and how the code reads them; empty where the print is sound.
    """

    number: str
    subject: str
    places: tuple[str, ...]
    note: str = ""


@dataclass(frozen=True)
class Finding:
    """What the runs say about a statement.

    Parameters
    ----------
    found : str
        The numbers that were computed, in words.
    verdict : {"agrees", "differs", "open"}
        ``open`` where it cannot be decided, as with measured points that are not published as numbers.
    why : str
        The reason for a difference, or what stays open.
    """

    found: str
    verdict: Verdict
    why: str = ""


@dataclass(frozen=True)
class Statement:
    """One statement of the text of a paper.

    Parameters
    ----------
    key : str
        Unique within the paper.
    place : str
        Section and figure of the paper.
    text : str
        What it says, in words of our own.
    judge : callable
        Takes the runs of the paper, returns a :class:`Finding`.
    """

    key: str
    place: str
    text: str
    judge: Callable[[Any], Finding]


@dataclass(frozen=True)
class PaperFigure:
    """A figure of the paper, drawn again.

    Parameters
    ----------
    number : str
        As in the paper, with the letter of its part: ``5c``.
    drawn : Figure, Drawing or None
        ``None`` where it is not drawn; the note says why.
    note : str
    """

    number: str
    drawn: Figure | Drawing | None
    note: str = ""


@dataclass(frozen=True)
class FilledInput:
    """An input that the paper leaves out, and how far the answer moves with it.

    Parameters
    ----------
    name, value : str
        What it is and what was taken.
    varied : str
        Other values that were tried.
    effect : str
        What they do to a number of the paper; computed.
    """

    name: str
    value: str
    varied: str
    effect: str


@dataclass(frozen=True)
class Paper:
    """One paper.

    Parameters
    ----------
    key : str
        Name on the command line.
    authors, year, title, journal : str
    line : str
        What is reproduced, in one line.
    equations : tuple of Equation
    statements : tuple of Statement
    plotted : tuple of str
        Numbers of the figures that are curves, over which points can be laid.
    run : callable
        ``run(quick, progress)`` computes everything and returns the runs.
    figures, filled : callable
        Take the runs; return the figures and the inputs that were filled in.
    """

    key: str
    authors: str
    year: str
    title: str
    journal: str
    line: str
    equations: tuple[Equation, ...]
    statements: tuple[Statement, ...]
    plotted: tuple[str, ...]
    run: Callable[[bool, Progress], Any]
    figures: Callable[[Any], tuple[PaperFigure, ...]]
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
