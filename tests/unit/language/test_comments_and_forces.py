"""Keys behind the # of a new file stay as they are; sentences with forces read alike in kN, tf and kgf."""

from __future__ import annotations

import re

import pytest

from moyai.case.templates import template
from moyai.language import spoken_in
from moyai.language.comments import with_comments
from moyai.language.translator import translator

KINDS = ("breakwater", "cage", "curtain", "member", "network", "units", "rigid_cage", "study")


@pytest.mark.parametrize("kind", KINDS)
def test_keys_that_are_commented_out_are_copied(kind: str) -> None:
    """What would be a key without its # is the same in both languages."""
    source = template(kind)
    with spoken_in("ja"):
        found = with_comments(source)
    key = re.compile(r"^\s*#\s*(?:- )?(?:\{|[a-z_]\w*: [\[{\w])[^#]*")
    pairs = list(zip(source.splitlines(), found.splitlines(), strict=True))
    kept = [(key.match(one), key.match(other)) for one, other in pairs if "{" in one.split("  #")[0] and key.match(one)]
    assert all(other is not None and one.group() == other.group() for one, other in kept if one is not None)
    assert found != source and re.search("[\u3040-\u30ff]", found)


def test_a_sentence_with_a_force_reads_in_tonnes_as_in_kilonewtons() -> None:
    text = translator("ja").text
    for unit in ("kN", "tf", "kgf"):
        said = text(f"upwards 0.428 {unit}, the largest of all anchors in this run, without a band")
        assert said == f"上向き力 0.428 {unit}（この計算での全アンカーの最大、幅なし）"


def test_what_stands_behind_a_colon_is_read_by_itself() -> None:
    text = translator("ja").text
    said = text("LWL: blockage d/h = 0.472 is not in the drag coefficient")
    assert said == f"LWL：{text('blockage d/h = 0.472 is not in the drag coefficient')}"
    holds = "the criterion holds, a default of moyai"
    assert text(f"holds: {holds}") == f"満足する：{text(holds)}"


@pytest.mark.parametrize("kind", KINDS)
def test_remarks_behind_keys_that_are_commented_out_are_translated(kind: str) -> None:
    """What stands behind such keys after a gap is a remark too, and needs a # of its own to be seen as one."""
    gap = re.compile(r"^\s*#\s+\S*[\[{].*[\]}]\s{3,}(?!#)\S")
    assert [line for line in template(kind).splitlines() if gap.match(line)] == []
    remarks = [line.rpartition("  # ")[2] for line in template(kind).splitlines() if line.lstrip().startswith("#")]
    left = {remark: translator("ja").left(remark) for remark in remarks if not re.search("[#{:=]", remark)}
    assert {remark for remark, words in left.items() if words} == set()
