"""How a run is closed: what outranks what, and which notices stay."""

from __future__ import annotations

import itertools

import pytest

from moyai.core.collected import STOPPED, Collected, by_weight
from moyai.core.validity import IdentityCheck, Notice
from moyai.core.vocabulary import Vocabulary

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


def test_equal_notices_are_told_once_and_grave_ones_first() -> None:
    light = Notice("a", "mind the step", severity="information")
    plain = Notice("b", "mind the mesh")
    assert by_weight([light, plain, light, GRAVE, plain]) == (GRAVE, plain, light)
