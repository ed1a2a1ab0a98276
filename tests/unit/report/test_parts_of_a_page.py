"""The inner part of a page, as the local page of drafts takes it."""

import pytest

from moyai.report.document import Chapter, Column, Document, Table
from moyai.report.html import render_html, render_parts


@pytest.mark.parametrize(("units", "shown", "other"), [("SI", "kN", "tf"), ("tf", "tf", "kN")])
def test_parts_are_in_the_units_of_their_document_as_the_whole_page_is(units, shown, other):
    table = Table("tensions", "Tensions", (Column("tension", [9.80665e3, 19.6133e3], "N"),))
    document = Document("Title", "", "converged", "", (Chapter("one", "One", (table,)),), units=units)
    html, data = render_parts(document)
    assert f"[{shown}]" in html or f">{shown}<" in html or f" {shown}" in html
    assert f"[{other}]" not in html and f" {other}" not in html
    assert html.split("<table", 1)[1].split("</table", 1)[0] in render_html(document)
    assert data["tables"]
