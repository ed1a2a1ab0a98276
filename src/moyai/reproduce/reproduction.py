"""Run a paper, judge its statements, lay points over its figures."""

from __future__ import annotations

from dataclasses import dataclass, replace
from importlib import import_module
from typing import Any

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.progress import Progress, silent
from moyai.report.document import Figure
from moyai.reproduce.model import FilledInput, Finding, Paper, PaperFigure, Statement
from moyai.reproduce.points import Agreement, Points, agreements, laid_over, read_points

NAMES = ("nakamura", "tabata", "arai", "sawaragi", "matsubara")
"""Papers in the order in which they are listed."""


@dataclass(frozen=True)
class StatementRow:
    """A statement with what was found."""

    statement: Statement
    finding: Finding

    def as_dict(self) -> dict[str, str]:
        """Return the row as texts for machines."""
        return {
            "key": self.statement.key,
            "place": self.statement.place,
            "statement": self.statement.text,
            "found": self.finding.found,
            "verdict": self.finding.verdict,
            "why": self.finding.why,
        }


@checks_words
@dataclass(frozen=True)
class Reproduction:
    """A paper computed again."""

    paper: Paper
    quick: bool
    rows: tuple[StatementRow, ...]
    #: With the points on them.
    figures: tuple[PaperFigure, ...]
    filled: tuple[FilledInput, ...]
    laid: tuple[tuple[Points, tuple[Agreement, ...]], ...] = ()

    def count(self, verdict: str) -> int:
        """Return how many statements have a verdict.

        Parameters
        ----------
        verdict : str
            One of the verdicts of the findings.
        """
        return sum(row.finding.verdict == verdict for row in self.rows)


def paper(name: str) -> Paper:
    """Return a paper by its key.

    Parameters
    ----------
    name : str
        Key of the paper: ``nakamura``, ``tabata``, ``arai``, ``sawaragi`` or ``matsubara``.

    Returns
    -------
    Paper
        Title, equations, statements, and the functions that compute it.

    Raises
    ------
    InputError
        For another key; names the papers that exist.

    Examples
    --------
    >>> from moyai.reproduce import paper
    >>> paper("tabata").key
    'tabata'
    """
    if name not in NAMES:
        raise InputError(f"no paper '{name}'", path="PAPER", allowed=", ".join(NAMES))
    found: Paper = import_module(f"moyai.reproduce.{name}").PAPER
    return found


def papers() -> tuple[Paper, ...]:
    """Return all papers.

    Returns
    -------
    tuple of Paper
        In the order in which they are listed.

    Examples
    --------
    >>> from moyai.reproduce import papers
    >>> [paper.key for paper in papers()]
    ['nakamura', 'tabata', 'arai', 'sawaragi', 'matsubara']
    """
    return tuple(paper(name) for name in NAMES)


def rows_of(wanted: Paper, runs: Any) -> tuple[StatementRow, ...]:
    """Return every statement of a paper with what its runs say."""
    return tuple(StatementRow(statement, statement.judge(runs)) for statement in wanted.statements)


@checks_words
def reproduce(
    name: str, *, quick: bool = False, points: tuple[str, ...] = (), progress: Progress = silent
) -> Reproduction:
    """Compute everything of a paper.

    Parameters
    ----------
    name : str
        Key of the paper.
    quick : bool
        Fewer waves and coarser variations, in a fraction of the time.
    points : tuple of str
        ``FIG=file.csv`` each.
    progress : Progress
        Listener.

    Returns
    -------
    Reproduction
        Statements with what was found, figures, and what was filled in.

    Raises
    ------
    InputError
        For an unknown paper or figure, or a file of points that cannot be read.

    Examples
    --------
    >>> from moyai.reproduce import reproduce
    >>> found = reproduce("arai", quick=True)
    >>> len(found.rows), found.count("agrees")                           # statements of the paper
    (22, 16)
    """
    wanted = paper(name)
    laid_points = [read_points(option, wanted.plotted) for option in points]
    runs = wanted.run(quick, progress)
    figures = wanted.figures(runs)
    laid = []
    for each in laid_points:
        place = next(index for index, one in enumerate(figures) if one.number == each.figure)
        drawn = figures[place].drawn
        assert isinstance(drawn, Figure)
        laid.append((each, agreements(drawn, each)))
        over = replace(figures[place], drawn=laid_over(drawn, each))
        figures = (*figures[:place], over, *figures[place + 1 :])
    return Reproduction(wanted, quick, rows_of(wanted, runs), figures, wanted.filled(runs), tuple(laid))
