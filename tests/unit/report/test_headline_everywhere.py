"""From the template to the first page: one governing number of a structure, the same wherever it is shown."""

from __future__ import annotations

import html
import json
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
import xarray as xr
from renamed import unmissed
from tonnes_force import assert_same_numbers, left_in_si
from typer.testing import CliRunner

from moyai.case.templates import template
from moyai.cli.main import app
from moyai.core.errors import InputError
from moyai.core.headline import Headline
from moyai.core.results import Result, read_result
from moyai.report.first_page import largest_by_unit
from moyai.report.headlines import headline_text
from moyai.report.writer import compose_document

Tables = Mapping[str, xr.Dataset]


@dataclass(frozen=True)
class Journey:
    """A template made small, the headline that governs, and the place in the result that it claims to come from."""

    changes: tuple[tuple[str, str], ...]
    name: str
    source: Callable[[Tables], float]


def _breakwater(tables: Tables) -> float:
    """Return the largest tension of the frequency domain over all levels and periods."""
    return max(float(table["line_tension_maximum"].max()) for path, table in tables.items() if "/frequency/" in path)


def _curtain(tables: Tables) -> float:
    """Return the governing load of the anchor line over its breaking load, of the level that is judged worst."""
    rows = [table.sel(component="anchor line") for path, table in tables.items() if path.endswith("/loads")]
    worst = max(rows, key=lambda row: float(row["steady_high"] / row["capacity"]))
    return float(worst["governing_load"] / worst["capacity"])


def _cage(tables: Tables) -> float:
    """Return the least share of volume in the current of the site, not in the highest one of the sweep."""
    statics = tables["/SWL/statics"]
    (row,) = np.flatnonzero(statics["current_speed"].values == 0.5)
    assert row < statics.sizes["current"] - 1
    return float(statics["volume_share"].values[row].min())


def _rigid_cage(tables: Tables) -> float:
    """Return the highest tension of any line in any wave."""
    return float(tables["/SWL/waves/regular"]["line_tension_maximum"].max())


def _network(tables: Tables) -> float:
    """Return the highest peak of any line in any run."""
    return float(tables["/SWL/dynamic"]["line_tension_maximum"].max())


def _member(tables: Tables) -> float:
    """Return the largest sum over time of inertia, drag and lift."""
    causes = ("inertia_force", "drag_force", "magnus_force")
    runs = [table for path, table in tables.items() if path.startswith("/SWL/time/")]
    return max(float(np.linalg.norm(sum(run[cause].values for cause in causes), axis=1).max()) for run in runs)


def _between(start: str, end: str) -> str:
    return f"(?ms)^{start}.*?(?=^{end})"


JOURNEYS = {
    "breakwater": Journey(
        (
            (_between("  - name: storm", "wind:"), ""),
            (r"\{from: 3 s, to: 8 s, count: 11\}", "[4 s, 6 s]"),
            (r"^analyses: \[.*?\]", "analyses: [statics, mooring, frequency]"),
        ),
        "line_tension",
        _breakwater,
    ),
    "curtain": Journey(
        (
            (_between("  - name: winter", "structure:"), ""),
            (r"^analyses: \[.*?\]", "analyses: [statics]"),
        ),
        "anchor_line_utilisation",
        _curtain,
    ),
    "cage": Journey(
        (
            (r"mesh: \{around: 32, down: 6, bottom: 4\}", "mesh: {around: 16, down: 2, bottom: 1}"),
            (r"current_speeds: \[.*?\]", "current_speeds: [0.75 m/s]"),
            (r"^analyses: \[.*?\]", "analyses: [statics]"),
        ),
        "volume_left",
        _cage,
    ),
    "rigid_cage": Journey(
        (
            (r"periods: \[1.0, 1.2, 1.5\]", "periods: [1.2]"),
            (r"^analyses: \[.*?\]", "analyses: [statics, time]"),
            (
                r"^# settings:\n#   rigid: \{.*?\}",
                "settings:\n  rigid: {periods: 8, settled_periods: 3, tolerance: 1e-4}",
            ),
        ),
        "line_tension",
        _rigid_cage,
    ),
    "network": Journey(
        (
            (r"  # duration: 2 min", "  duration: 14 s"),
            (r"skip: 30 s", "skip: 6 s"),
            (r"^analyses: \[.*?\]", "analyses: [statics, dynamic]"),
        ),
        "line_tension",
        _network,
    ),
    "member": Journey(
        (
            (_between("  - name: storm", "(#|structure:)"), ""),
            (r"^analyses: \[.*?\]", "analyses: [forces]"),
        ),
        "peak_force",
        _member,
    ),
}


@dataclass(frozen=True)
class Journal:
    """What one run left behind: the terminal's record, the result and the report."""

    record: dict[str, Any]
    result: Result
    page: str

    @property
    def tables(self) -> dict[str, xr.Dataset]:
        """The groups of the result by their path."""
        return {node.path: node.to_dataset() for node in self.result.tree.subtree if node.has_data}


@pytest.fixture(scope="module", params=JOURNEYS)
def travelled(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Journey, Journal]:
    """Run the small template from the command line, as a user does."""
    kind = request.param
    journey, folder = JOURNEYS[kind], tmp_path_factory.mktemp(kind)
    text = template(kind)
    for pattern, new in journey.changes:
        text, count = re.subn(pattern, new, text, count=1, flags=re.MULTILINE)
        assert count == 1, pattern
    (folder / "case.yaml").write_text(text, encoding="utf-8")
    found = CliRunner().invoke(app, ["run", str(folder / "case.yaml"), "--output", str(folder / "out"), "--json"])
    assert found.exit_code == 0, found.output
    page = (folder / "out" / "report.html").read_text(encoding="utf-8")
    return journey, Journal(json.loads(found.stdout), read_result(folder / "out" / "results.nc"), page)


def headline_of(journey: Journey, result: Result) -> Headline:
    (found,) = [item for item in result.headlines if item.name == journey.name and item.shown]
    return found


def test_the_number_is_that_of_the_table_it_comes_from(travelled: tuple[Journey, Journal]) -> None:
    journey, journal = travelled
    value = headline_of(journey, journal.result).value
    assert value > 0.0
    assert value == pytest.approx(journey.source(journal.tables), rel=1e-12)


def test_the_terminal_says_the_same(travelled: tuple[Journey, Journal]) -> None:
    journey, journal = travelled
    headline = headline_of(journey, journal.result)
    named = [Headline.from_dict(item) for item in journal.record["headlines"] if item["name"] == journey.name]
    assert [item for item in named if item.shown] == [headline]
    shown = {item["label"]: item["text"] for item in journal.record["key_figures"]}
    assert shown[headline.label] == text_of(journal.result, headline)


def test_the_first_page_shows_it(travelled: tuple[Journey, Journal]) -> None:
    journey, journal = travelled
    headline = headline_of(journey, journal.result)
    cards = re.findall(
        r'class="key-figure[^"]*"><div class="label">(.*?)</div>\s*<div class="number">(.*?)</div>', journal.page
    )
    shown = {html.unescape(re.sub("<.*?>", "", label)): html.unescape(text) for label, text in cards}
    assert re.sub("<.*?>", "", shown[headline.label]) == text_of(journal.result, headline)


def test_the_number_shown_is_the_value_in_its_unit(travelled: tuple[Journey, Journal]) -> None:
    """The text is read back: 3.21 kN means 3210 N to the digits that are shown."""
    journey, journal = travelled
    headline = headline_of(journey, journal.result)
    number, _, unit = (
        text_of(journal.result, headline).removeprefix("at most ").removeprefix("at least ").partition(" ")
    )
    factor = {"": 1.0, "N": 1.0, "kN": 1e3, "MN": 1e6}[unit]
    assert float(number) * factor == pytest.approx(headline.value, rel=5e-3)


def test_what_governs_stands_first(travelled: tuple[Journey, Journal]) -> None:
    journey, journal = travelled
    assert journal.result.headlines[0].name == journey.name


def test_a_report_in_tonnes_force_holds_the_same_numbers(travelled: tuple[Journey, Journal]) -> None:
    """Tables, governing numbers and axes; texts of remarks stay in SI."""
    _, journal = travelled
    assert assert_same_numbers(journal.result) > 0
    assert left_in_si(compose_document(journal.result))
    assert left_in_si(compose_document(journal.result, "tf")) == []


def text_of(result: Result, headline: Headline) -> str:
    return headline_text(headline, largest_by_unit(result).get(headline.unit, 0.0))


GOVERNING = {
    "breakwater": ("frequency/operation", "line_tension_maximum"),
    "curtain": ("loads", "governing_load"),
    "cage": ("statics", "volume_share"),
    "rigid_cage": ("waves/regular", "line_tension_maximum"),
    "network": ("dynamic", "line_tension_maximum"),
    "member": ("waves/regular", "maximum_total_force"),
}


@pytest.mark.parametrize("change", ["dropped", "renamed"])
def test_a_result_without_its_governing_number_has_no_report(
    travelled: tuple[Journey, Journal], change: str, request: pytest.FixtureRequest
) -> None:
    """What was run and is absent is an error that names group and variable, never a blank page."""
    _, journal = travelled
    group, name = GOVERNING[request.node.callspec.params["travelled"]]
    path = next(path for path in journal.tables if path.endswith(f"/{group}"))
    groups = {node.path: node.to_dataset(inherit=False) for node in journal.result.tree.subtree}
    held = groups[path]
    groups[path] = held.drop_vars(name) if change == "dropped" else held.rename({name: f"{name}_of_old"})
    tree = xr.DataTree.from_dict(groups)
    with pytest.raises(InputError, match=f"'{path.strip('/')}' of the result lacks .*'{name}'"):
        compose_document(replace(journal.result, tree=tree))


#: What a run may hold and may lack, each on conditions of its own.
OPTIONAL: dict[str, set[str]] = {
    "breakwater": {"maximum_utilisation"},  # without lines there is none
    "curtain": set(),
    "cage": set(),
    "rigid_cage": set(),
    "network": {"line_tension_of_check", "still_place", "surface_elevation"},
    "member": set(),
}


def test_whatever_is_renamed_is_missed(travelled: tuple[Journey, Journal], request: pytest.FixtureRequest) -> None:
    """Every variable of a real run, not the governing one alone: a table that loses a column says so."""
    assert unmissed(travelled[1].result) == OPTIONAL[request.node.callspec.params["travelled"]]
