"""The workbook and the Word document as LibreOffice opens them: every cell as it was written, a page of A4."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import openpyxl
import pytest
from small_results import pontoon, without

from moyai.report.writer import write_report

OFFICE = shutil.which("soffice")
pytestmark = [pytest.mark.slow, pytest.mark.skipif(OFFICE is None, reason="LibreOffice (soffice) is not installed")]


@pytest.fixture(scope="module", params=["en", "ja"])
def folder(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A report in one language."""
    place = tmp_path_factory.mktemp(request.param)
    write_report(without(pontoon(), "/time"), place, docx=True, language=request.param)
    return place


def _converted(file: Path, ending: str, profile: Path) -> Path:
    """Return what LibreOffice makes of a file; it says nothing where it opens one as it is."""
    out = profile / ending
    command = [str(OFFICE), f"-env:UserInstallation={(profile / 'profile').as_uri()}", "--headless"]
    done = subprocess.run(
        [*command, "--convert-to", ending, "--outdir", str(out), str(file)], capture_output=True, text=True, timeout=180
    )
    assert done.returncode == 0, done.stderr
    assert "rror" not in done.stdout + done.stderr.replace("javaldx", "")
    return out / f"{file.stem}.{ending}"


def test_every_cell_of_the_workbook_comes_back(folder: Path, tmp_path: Path) -> None:
    written = openpyxl.load_workbook(folder / "report.xlsx")
    read = openpyxl.load_workbook(_converted(folder / "report.xlsx", "xlsx", tmp_path))
    assert read.sheetnames == written.sheetnames
    numbers = 0
    for sheet in written.worksheets:
        for row in sheet.iter_rows():
            for cell in row:
                found = read[sheet.title][cell.coordinate].value
                if isinstance(cell.value, int | float):
                    numbers += 1
                    assert found == pytest.approx(cell.value, rel=1e-14), f"{sheet.title} {cell.coordinate}"
                else:
                    assert (found or "") == (cell.value or ""), f"{sheet.title} {cell.coordinate}"
    assert numbers > 500


def test_the_word_document_opens_on_a4_with_its_tables_and_captions(folder: Path, tmp_path: Path) -> None:
    pages = _converted(folder / "report.docx", "pdf", tmp_path).read_bytes()
    assert b"/MediaBox[0 0 595" in pages.replace(b"/MediaBox [", b"/MediaBox[")
    text = _converted(folder / "report.docx", "txt", tmp_path).read_text(encoding="utf-8-sig")
    japanese = "表 1" in text
    assert ("図 1" if japanese else "Figure 1") in text and ("要約" if japanese else "Summary") in text
    assert japanese == (folder.name.startswith("ja"))
