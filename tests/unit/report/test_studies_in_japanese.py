"""Reports of studies in Japanese: every variable that a study may keep, in headings, tables and maps."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from japanese import compared_document
from typer.testing import CliRunner

from moyai.case.templates import template
from moyai.cli.main import app
from moyai.core.results import Result
from moyai.core.vocabulary import Variable
from moyai.core.vocabulary_page import vocabularies
from moyai.language import said, spoken_in
from moyai.language.catalogue import catalogue
from moyai.language.words import latin_words
from moyai.report.document import Table
from moyai.report.language import in_the_language
from moyai.report.writer import compose_document
from moyai.study.report.page import interesting
from moyai.study.report.reading import read_study

STRUCTURES = {
    "breakwater": "breakwater", "curtain": "curtain", "flexible cage": "cage", "member": "member",
    "network": "network", "rigid cage": "rigid_cage", "units": "units",
}  # fmt: skip
"""Vocabularies of structures, and the template of each."""
AXES = {
    "significant_height": (["0.5 m", "1 m"], [0.5, 1.0], "m"),
    "heading_deg": (["0", "15", "30"], [0.0, 15.0, 30.0], "1"),
    "lost_line": (["intact", "seaward"], None, ""),
}
SIX = 6  # responses of which a report draws figures


def variables(kind: str) -> list[Variable]:
    """Return what a study may keep of a kind, each wording once."""
    return list({one.long_name: one for one in vocabularies()[kind].variables.values()}.values())


def study(kind: str, kept: list[Variable]) -> Result:
    """Return the result of a study of a structure that kept some variables, their numbers made up."""
    shape = tuple(len(labels) for labels, _, _ in AXES.values())
    count = int(np.prod(shape))
    status = np.array(["converged"] * count, dtype=object).reshape(shape)
    message = np.array([""] * count, dtype=object).reshape(shape)
    status.flat[3], message.flat[3] = "failed", "lines: no equilibrium"
    root = xr.Dataset({"case_status": (tuple(AXES), status), "case_message": (tuple(AXES), message)})
    values = np.arange(1.0, count + 1.0).reshape(shape)
    group = xr.Dataset(
        {
            f"{one.name}_{n}": (tuple(AXES), values * (n + 1), {"units": one.units or "1", "long_name": one.long_name})
            for n, one in enumerate(kept)
        }
    )
    tree = xr.DataTree.from_dict({"/": root, "/SWL/waves/storm": group})
    axes = [{"name": name, "labels": labels, "values": v, "unit": unit} for name, (labels, v, unit) in AXES.items()]
    names = [f"SWL/waves/storm/{one.name}_{n}" for n, one in enumerate(kept)]
    tree.attrs |= {
        "structure": "study", "title": "Spacing of the member", "axes": json.dumps(axes), "watch": names[0],
        "governing": json.dumps([[name, 2, 1.5, "governing/case 2"] for name in names]), "governing_kind": "watch",
        "case_text": template(STRUCTURES[kind]),
    }  # fmt: skip
    return Result(tree, "converged", f"{count - 1} of {count} cases run")


def sixes(kind: str) -> Iterator[list[Variable]]:
    """Give the variables of a kind, as many at once as a report draws."""
    found = variables(kind)
    yield from (found[start : start + SIX] for start in range(0, len(found), SIX))


@pytest.mark.parametrize("kind", STRUCTURES)
def test_every_variable_of_a_structure_has_a_japanese_name(kind: str) -> None:
    known = {source.lower(): target for source, target in catalogue("ja").items()}
    missing = [one.long_name for one in variables(kind) if one.long_name.lower() not in known]
    assert len(variables(kind)) > 50
    assert missing == []
    assert [one for one in variables(kind) if latin_words(known[one.long_name.lower()])] == []


@pytest.mark.slow
@pytest.mark.parametrize("kind", STRUCTURES)
def test_a_study_of_each_structure(kind: str) -> None:
    texts = 0
    for kept in sixes(kind):
        left, count = compared_document(compose_document(study(kind, kept), language="ja"))
        assert not left, "\n".join(left)
        texts += count
    assert texts > 300


@pytest.mark.slow
@pytest.mark.parametrize("kind", STRUCTURES)
def test_names_stand_whole_in_headings(kind: str) -> None:
    """A name that is read word by word says something else: each end, the middle, by direction."""
    known = {source.lower(): target for source, target in catalogue("ja").items()}
    for kept in sixes(kind):
        with spoken_in("ja"):
            document = in_the_language(compose_document(study(kind, kept), language="ja"))
        titles = [str(getattr(block, "title", "")) for block in document.blocks()]
        for one in kept:
            name = f"{known[one.long_name.lower()]}（SWL、波、暴風時）"
            assert f"{name}：有義波高と進行方向に対する値" in titles, f"{name}\n{titles}"
        assert document.title == "Spacing of the member", "the title is the user's own"


def test_a_case_in_words() -> None:
    with spoken_in("ja"):
        assert said("at least 2.00") == "2.00 以上"
        assert said("diameter 0.7 m, water depth 15 m") == "直径 0.7 m、水深 15 m"
        assert (
            said("significant height 0.5 m, heading 15°, lost line seaward")
            == "有義波高 0.5 m、進行方向 15°、切れた索 沖側"
        )


@pytest.mark.slow
def test_the_title_of_a_study_is_printed_as_it_is(tmp_path: Path) -> None:
    """'of the member' in it was put into Japanese, the rest left."""
    base = template("member").replace("analyses: [sweep, forces, surface]", "analyses: [forces]")
    (tmp_path / "base.yaml").write_text(base, encoding="utf-8")
    text = "moyai: 1\nstudy:\n  title: Spacing of the member\n  base: base.yaml\n  variations:\n"
    (tmp_path / "s.yaml").write_text(text + "    - grid: {structure.section.diameter: [0.8 m]}\n", encoding="utf-8")
    run = CliRunner().invoke(
        app,
        ["--language", "ja", "study", str(tmp_path / "s.yaml"), "-o", str(tmp_path / "o"), "--no-report", "-w", "1"],
    )
    assert run.exit_code == 0, run.output
    assert "Spacing of the member: 1 ケース（直径：1）\n" in run.output and "1 ケース中 1 ケースを計算" in run.output


def test_what_is_rounding_alone_is_not_watched() -> None:
    """The moment about the middle of a member that is symmetric is 1e-11 N m, and varies by all of it."""
    moments = [one for one in variables("member") if one.units == "N m"][:3]
    result = study("member", moments)
    group = result.tree["/SWL/waves/storm"].to_dataset(inherit=False)
    names = list(group.data_vars)
    group[names[0]] = group[names[0]] * 1e-13
    result.tree["/SWL/waves/storm"] = xr.DataTree(group)
    result.tree.attrs["watch"] = ""
    assert f"SWL/waves/storm/{names[0]}" not in interesting(read_study(result))
    assert f"SWL/waves/storm/{names[1]}" in interesting(read_study(result))


def test_the_governing_value_is_in_the_units_of_the_reader() -> None:
    (force,) = [one for one in variables("member") if one.name == "maximum_total_force"]
    document = compose_document(study("member", [force]), language="ja", units="tf")
    (table,) = [block for block in document.blocks() if getattr(block, "key", "") == "governing"]
    assert isinstance(table, Table)
    value = next(column for column in table.columns if column.label == "Value")
    assert value.quantities and str(value.values[0]).endswith("kgf")
