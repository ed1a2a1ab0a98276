"""How a run is closed: what outranks what, and which notices stay."""

from __future__ import annotations

import itertools

import pytest
import xarray as xr

from moyai.core.collected import STOPPED, Collected, by_weight
from moyai.core.validity import IdentityCheck, Notice
from moyai.core.vocabulary import Strictness, Vocabulary, VocabularyError
from moyai.language.translator import translator

ATTRIBUTES = {"title": "a case", "structure": "curtain", "case_hash": "0", "case_text": "", "model": "B"}
BROKEN = IdentityCheck("energy", 0.2, 0.01, "in equals out")
GRAVE = Notice("depth", "too deep", severity="error")


@pytest.mark.parametrize(("broken", "grave", "failed", "stopped"), list(itertools.product([False, True], repeat=4)))
def test_graver_states_outrank_lighter_ones(broken: bool, grave: bool, failed: bool, stopped: bool) -> None:
    collected = Collected()
    collected.checks.extend([BROKEN] if broken else [])
    collected.notices.extend([GRAVE] if grave else [])
    collected.failures.extend(["sea 1: no end"] if failed else [])
    collected.interrupted = STOPPED if stopped else ""
    result = collected.close(Vocabulary.of("curtain", {}), ATTRIBUTES, [3], fulfilled="all is well")
    if stopped:
        assert (result.status, result.message) == ("interrupted", STOPPED)
    elif failed or broken:
        assert result.status == "not_converged"
        assert ("sea 1: no end" in result.message) == failed
        assert ("identity fails: energy" in result.message) == broken
    elif grave:
        assert (result.status, result.message) == ("outside_validity", "too deep")
    else:
        assert (result.status, result.message) == ("converged", "all is well")
    assert result.tree.attrs["model"] == "B"
    assert result.provenance["seeds"] == [3]
    assert result.provenance["structure"] == "curtain"


def test_equal_notices_are_reported_once_and_grave_ones_first() -> None:
    light = Notice("a", "mind the step", severity="information")
    plain = Notice("b", "mind the mesh")
    assert by_weight([light, plain, light, GRAVE, plain]) == (GRAVE, plain, light)


def test_an_undeclared_variable_is_kept_with_a_warning_and_refused_where_names_are_strict(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    own = Vocabulary.of("curtain", {"depth": ("m", "depth of the toe"), "sag": ("m", "sag")}, always={"/run": ("sag",)})
    held = {"depth": ((), 2.0, {"units": "cm"}), "odd_one": ((), 3.0), "line_tension_maximum": ((), 4.0)}
    collected = Collected()
    collected.groups["/run"] = xr.Dataset(held)
    with pytest.raises(VocabularyError, match="'odd_one' is not declared"):
        collected.close(own, ATTRIBUTES)
    monkeypatch.setattr(Strictness, "names", False)
    result = collected.close(own, ATTRIBUTES)
    assert result.status == "converged"
    assert float(result.tree["/run/odd_one"]) == 3.0
    assert {notice.severity for notice in result.notices} == {"warning"}
    assert [notice.message for notice in result.notices] == [
        "/run: variable 'depth' has the unit 'cm', declared is 'm'",
        "/run: variable 'odd_one' is not declared",
        "/run: variable 'line_tension_maximum' has no dimension line",
        "/run: variable 'sag' is absent",
    ]
    japanese = translator("ja")
    assert all(japanese.left(text) == 0 for notice in result.notices for text in (notice.message, notice.remedy))
