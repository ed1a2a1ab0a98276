"""docs/case_file.md holds the reference that the schemas give today."""

from moyai.case.reference import reference_markdown, renew
from moyai.core.kinds import structure_kinds


def test_the_page_is_up_to_date(request):
    page = (request.config.rootpath / "docs" / "case_file.md").read_text(encoding="utf-8")
    assert renew(page) == page, "run: python -m moyai.case.reference docs/case_file.md"


def test_every_kind_and_key_is_listed():
    text = reference_markdown()
    for kind in structure_kinds():
        assert f"## Case of a {kind}" in text
    for key in ("water_depth", "peak_enhancement", "bilge_radius", "bed_friction", "line_slacks", "from_bearing_deg"):
        assert f"| `{key}` |" in text
    assert "| `draught` |" in text
    assert "length [m], greater than 0 m or 'infinite' | **required** |" in text
