"""One declaration a concept: what is missed, what is described, and what earlier names are called."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from moyai.core.errors import InputError
from moyai.core.kinds import groups_of, kind_of_result, structure_kinds
from moyai.core.results import Result
from moyai.core.vocabulary import COMMON, FORMER, Vocabulary, VocabularyError, former
from moyai.core.vocabulary_page import page, vocabularies
from moyai.records.comparison.run import Pairing, compare_result
from moyai.study.responses import find_response

DOCS = Path(__file__).parents[3] / "docs"
KINDS = {"Force record": "force_record", "Streak pictures": "streaks", "Snap runs": "snap_runs"}
GROUPS = {"event", "realisation", "memory"}

TENSION = np.array([1.0e5, 2.0e5])


def plain(name: str = "line_tension_maximum", **attributes: str) -> xr.DataTree:
    """Return a result of a breakwater whose variable carries neither unit nor words."""
    held = xr.Dataset(
        {name: (("period", "line"), np.stack([TENSION, 2.0 * TENSION], axis=1))},
        {"period": [4.0, 5.0], "line": ["sea", "lee"]},
        attributes,
    )
    tree = xr.DataTree.from_dict({"/SWL/frequency/swell": held})
    tree.attrs["structure"] = "breakwater"
    return tree


def test_what_an_analysis_always_writes_is_missed() -> None:
    own = Vocabulary.of("test", {"a": ("m", "a")}, always={"/[^/]+/run": ("a", "line_tension_maximum")})
    full = xr.Dataset({"a": 1.0, "line_tension_maximum": ("line", [1.0])}, {"line": ["sea"]})
    assert own.absent("/SWL/run", full) == ()
    assert own.absent("/SWL/run", full.drop_vars(["a", "line_tension_maximum"]).assign(b=1.0)) == (
        "a",
        "line_tension_maximum",
    )
    # not run, run without lines, run that did not converge, another group
    assert own.absent("/SWL/run", xr.Dataset()) == ()
    assert own.absent("/SWL/run", xr.Dataset({"a": 1.0})) == ()
    assert own.absent("/SWL/run", xr.Dataset({"b": 1.0}, attrs={"status": "not_converged"})) == ()
    assert own.absent("/SWL/run/frames", xr.Dataset({"b": 1.0})) == ()
    with pytest.raises(VocabularyError, match="variable 'a' is absent"):
        own.close({"/SWL/run": xr.Dataset({"line_tension_maximum": ("line", [1.0])}, {"line": ["sea"]})})
    with pytest.raises(ValueError, match="b must always"):
        Vocabulary.of("test", {}, always={"/run": ("b",)})


def test_every_structure_says_what_it_always_writes() -> None:
    for name in structure_kinds():
        kind = kind_of_result(name)
        own = kind.vocabulary() if kind is not None else None
        assert own is None or own.always, name


def test_studies_and_comparisons_take_unit_and_words_from_the_vocabulary(tmp_path: Path) -> None:
    tree = plain()
    (found,) = [group for path, group in groups_of(tree).items() if path.endswith("swell")]
    assert found["line_tension_maximum"].attrs == {"units": "N", "long_name": "largest tension at the fairlead"}
    assert find_response(tree, "SWL/frequency/swell/line_tension_maximum[line=lee]").attrs["units"] == "N"
    record = tmp_path / "record.csv"
    record.write_text("period [s],pull [kN]\n4,100\n4.5,150\n5,200\n", encoding="utf-8")
    pairing = Pairing("line_tension_maximum", "pull")
    compared = compare_result(Result(tree), record, [pairing], coordinate="period", select={"line": "sea"})
    (group,) = compared.tree.children.values()
    assert group["model"].attrs["units"] == "N"
    np.testing.assert_allclose(group["model"], group["observed"], rtol=1e-12)


def test_a_name_of_earlier_versions_is_answered_by_what_it_is_called(tmp_path: Path) -> None:
    assert not set(FORMER) & set(COMMON)
    declared = set().union(*(own.variables for own in vocabularies().values()))
    assert not {name for called in FORMER.values() for name in called.split(" or ")} - declared
    assert former("steady_anchor_force_high").endswith("is called steady_anchor_horizontal_tension_high")
    assert former("worst_anchor_uplift").endswith("is called worst_anchor_vertical_tension")
    assert former("maximum_excursion_of_realisation").endswith("is called largest_offset_by_dof_of_realisation")
    assert not any(map(former, ("anchor_tension_low", "steady_offset", "worst_utilisation")))
    with pytest.raises(InputError) as caught:
        find_response(plain(), "SWL/frequency/swell/maximum_tension")
    assert "'maximum_tension' of earlier versions is called line_tension_maximum" in caught.value.fault.remedy
    record = tmp_path / "record.csv"
    record.write_text("period,pull\n4,100\n5,200\n", encoding="utf-8")
    with pytest.raises(InputError) as caught:
        compare_result(Result(plain()), record, [Pairing("maximum_tension", "pull")])
    assert "is called line_tension_maximum" in caught.value.fault.remedy


def test_every_declared_variable_is_documented() -> None:
    """The page is made from the vocabularies."""
    written = (DOCS / "result_variables.md").read_text(encoding="utf-8")
    assert page() == written, "run: python -m moyai.core.vocabulary_page docs/result_variables.md"


def test_every_documented_variable_is_declared() -> None:
    text, owners = (DOCS / "result_layout.md").read_text(encoding="utf-8"), vocabularies()
    sections = {part.partition("\n")[0]: part for part in re.split("(?m)^## ", text)[1:]}
    assert len(sections) > 9
    for title, section in sections.items():
        if title == "Every structure":
            continue
        named = {name for row in section.splitlines() if row.startswith("| ") for name in variables_of(row)}
        assert len(named) > 10, title
        own = owners[KINDS.get(title, title.lower())]
        assert not sorted(name for name in named - GROUPS if name not in own), title


def variables_of(row: str) -> list[str]:
    """Return the variables in the last cell of a row, without dimensions in parentheses and attributes."""
    cell = row.replace(r"\|", "").strip("| ").split("|")[-1]
    cell = re.sub(r"\([^()]*\)", "", re.sub(r"[^;`]*\battributes?\b.*", "", cell))
    return re.findall(r"`([a-z]\w*)`", cell)
