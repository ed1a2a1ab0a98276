"""Every statement of the five papers as the quick run of ``moyai reproduce`` judges it."""

from functools import cache

import pytest

from moyai.report.document import Figure
from moyai.reproduce import as_result, compose, papers, reproduce

#: Statements that differ from the paper or stay open; all others agree.
EXCEPTIONS = {
    "nakamura": {
        "differs": {"table", "squared", "sway-heave", "transmission", "reflection"},
        "open": {"fifteen", "heave-measured", "roll-closer", "transmission-measured", "reflection-measured"},
    },
    "tabata": {"differs": {"squared", "tenths", "factor"}, "open": {"flume", "wire"}},
    "arai": {"differs": {"rise", "contour"}, "open": {"vortex", "background"}},
    "sawaragi": {"differs": {"one-spike-steel", "iteration"}, "open": {"above", "model-b"}},
    "matsubara": {
        "differs": {"table", "weight", "circle", "higher", "third", "small"},
        "open": {"scatter", "parameters", "thirty", "eighty", "forty"},
    },
}


@cache
def found(key):
    return reproduce(key, quick=True)


@pytest.mark.slow
@pytest.mark.parametrize("paper", papers(), ids=lambda paper: paper.key)
def test_every_statement_is_judged_as_documented(paper):
    exceptions = EXCEPTIONS[paper.key]
    for row in found(paper.key).rows:
        wanted = next((word for word, keys in exceptions.items() if row.statement.key in keys), "agrees")
        assert row.finding.verdict == wanted, f"{row.statement.key}: {row.finding.found}"
        assert row.finding.verdict == "agrees" or row.finding.why


@pytest.mark.slow
@pytest.mark.parametrize("paper", papers(), ids=lambda paper: paper.key)
def test_the_page_holds_every_figure_and_its_numbers(paper):
    run = found(paper.key)
    assert tuple(one.number for one in run.figures if isinstance(one.drawn, Figure)) == paper.plotted
    assert all(one.drawn is not None or one.note for one in run.figures)
    result = as_result(run)
    document = compose(run, result)
    assert {f"figure_{number}" for number in paper.plotted} <= set(result.tree.children)
    assert len(document.sections) == 6 and run.filled
