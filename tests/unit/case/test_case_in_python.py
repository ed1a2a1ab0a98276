"""Cases made and changed in Python: the same as the file that says so."""

from html import escape

import numpy as np
import pytest

import moyai
from moyai.case.reader import derived_numbers
from moyai.core.errors import CaseError, InputError

TEXT = moyai.template("breakwater")


def test_text_mapping_and_file_are_one_case(tmp_path):
    path = tmp_path / "case.yaml"
    path.write_text(TEXT, encoding="utf-8")
    from_file, from_text = moyai.load_case(path), moyai.load_case(TEXT)
    assert from_file.case_hash == from_text.case_hash == moyai.load_case(from_text.document.data).case_hash
    assert from_file.replace({}).case_hash == from_file.case_hash


def test_changed_values_are_those_of_a_file_that_says_so():
    case = moyai.load_case(TEXT)
    changed = case.replace({"structure.draught": "3.2 m", "waves[storm].significant_height": np.float64(1.1)})
    written = TEXT.replace("draught: 3 m ", "draught: 3.2 m ").replace(
        "significant_height: 1.2 m", "significant_height: 1.1 m"
    )
    assert written != TEXT
    assert changed.case_hash == moyai.load_case(written).case_hash
    assert moyai.load_case(changed.text).case_hash == changed.case_hash
    assert case.model.structure.draught == 3.0 and changed.folder == case.folder


@pytest.mark.parametrize(
    ("path", "value", "error", "words"),
    [
        ("structure.draught", "-1 m", CaseError, "structure.draught"),
        ("structure.draugt", "3 m", CaseError, "unknown key 'draugt'"),
        ("structur.draught", "3 m", InputError, "did you mean 'structure'"),
        ("lines[9].count", 2, InputError, "lines"),
        ("structure.draught", object(), InputError, "cannot be written into a case file"),
    ],
)
def test_faults_of_a_change_are_named(path, value, error, words):
    with pytest.raises(error, match=words.replace("[", r"\[")):
        moyai.load_case(TEXT).replace(path, value)


def test_a_notebook_shows_what_follows_from_a_case():
    case = moyai.load_case(moyai.template("breakwater")).replace("title", "Pier <3>")
    page = case._repr_html_()
    assert "Pier &lt;3&gt;" in page and "<3>" not in page
    for number in derived_numbers(case)[:5]:
        assert f"<td>{number.label}</td>" in page and f"<td>{number.text}</td>" in page
    assert "<script" not in page and "src=" not in page and "&lt;3&gt;</pre>" not in page
    assert escape(case.text) in page
    assert repr(case).startswith("<case of kind breakwater: 'Pier <3>'") and len(repr(case)) < 300
