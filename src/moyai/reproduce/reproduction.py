"""Run a paper, judge its statements, lay points over its figures, and keep all of it as one result."""

from __future__ import annotations

from dataclasses import dataclass, replace
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.errors import InputError
from moyai.core.progress import Progress, silent
from moyai.report.document import Figure
from moyai.report.encoding import slug
from moyai.reproduce.model import FilledInput, Finding, Paper, PaperFigure, Statement
from moyai.reproduce.points import Agreement, Points, agreements, laid_over, read_points

if TYPE_CHECKING:
    from moyai.core.results import Result

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
        """Return how many statements have a verdict."""
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


def as_result(found: Reproduction) -> Result:
    """Return the numbers behind the page as a result: one group a figure, one for the statements, one for the page.

    Parameters
    ----------
    found : Reproduction
        With one statement or more.

    Returns
    -------
    Result
        Groups ``statements``, ``figure_<number>`` with the curves in the units of the page, and the page itself.

    Examples
    --------
    >>> from moyai.reproduce import Reproduction, as_result, paper
    >>> from moyai.reproduce.model import Finding
    >>> from moyai.reproduce.reproduction import StatementRow
    >>> tabata = paper("tabata")
    >>> row = StatementRow(tabata.statements[0], Finding("as the paper says", "agrees"))
    >>> result = as_result(Reproduction(tabata, True, (row,), (), ()))
    >>> result.tree["statements"]["verdict"].values.tolist()
    ['agrees']
    """
    import xarray as xr

    from moyai.core.results import Result, make_provenance
    from moyai.reproduce.stored import GROUP, stored_page

    rows = [row.as_dict() for row in found.rows]
    columns = {name: ("row", np.array([row[name] for row in rows], dtype=object)) for name in rows[0]}
    groups: dict[str, xr.Dataset] = {"/statements": xr.Dataset(columns)}
    for one in found.figures:
        if isinstance(one.drawn, Figure):
            groups[f"/figure_{one.number}"] = _dataset(one.drawn)
    title = f"{found.paper.authors} ({found.paper.year})"
    groups[f"/{GROUP}"] = stored_page(found)
    groups["/"] = xr.Dataset(attrs={"structure": "reproduction", "title": title, "paper": found.paper.key})
    words = ", ".join(f"{found.count(verdict)} {word}" for verdict, word in _WORDS)
    return Result(
        xr.DataTree.from_dict(groups),
        message=f"{len(rows)} statements: {words}",
        provenance=make_provenance(title=title, quick=found.quick),
    )


_WORDS = (("agrees", "agree"), ("differs", "differ"), ("open", "open"))


def _dataset(figure: Figure) -> Any:
    """Return the curves of a figure, each along its own dimension."""
    import xarray as xr

    out: dict[str, Any] = {}
    for number, series in enumerate(figure.series):
        panel = figure.panels[series.panel]
        name = f"{slug(series.label).replace('-', '_').replace('.', '_')}_{number}"
        for axis in figure.abscissae:
            if axis.key in series.x:
                words = {"long_name": axis.label, "units": axis.unit or "1"}
                out[f"{name}_{axis.key}"] = (name + "_point", np.asarray(series.x[axis.key], dtype=float), words)
        words = {"long_name": f"{panel.label}: {series.label}", "units": panel.unit or "1"}
        out[name] = (name + "_point", np.asarray(series.y, dtype=float), words)
    return xr.Dataset(out, attrs={"title": figure.title})
