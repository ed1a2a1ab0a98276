"""The app in Japanese: its page, forms, sliders, errors and jobs have no English sentence left."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from importlib import resources
from pathlib import Path
from typing import Any

import pytest
from app_runs import MEMBER, run_slowly, words_of_files

from moyai.app.words import page_words, sentences
from moyai.core.kinds import structure_kind, structure_kinds
from moyai.language import said, spoken_in
from moyai.language.catalogue import page_catalogue
from moyai.language.words import latin_words

pytest.importorskip("starlette")
pytest.importorskip("httpx")

from starlette.testclient import TestClient

from moyai.app.folder import Folder
from moyai.app.security import Secrets
from moyai.app.server import create
from moyai.app.state import App
from moyai.case.sliders import COMMON

PORT = 8766
_TEXT = re.compile(r"""(?<!say\()(?<!=== )(["`])((?:(?!\1)[^\\\n]|\\.)*)\1""")
_WORDS = re.compile(r"^[A-Z][a-z]+$|[A-Za-z]{2,},? [a-z]{2,}")
_NO_WORDS = re.compile(r"^M[\d-]|allow-|^(?:quiet|editor|notices?) [a-z]+$|^[a-z]+\[|\.")  # shapes, classes, places


def scripts() -> list[tuple[str, str]]:
    files = (resources.files("moyai.app") / "assets").iterdir()
    return [
        (one.name, one.read_text(encoding="utf-8"))
        for one in files
        if one.name.endswith(".js") and one.name != "codemirror.js"
    ]


def test_every_sentence_of_the_page_has_japanese_words() -> None:
    assert len(sentences()) > 100
    assert set(page_catalogue("ja")) - {""} == set(sentences())
    with spoken_in("ja"):
        left = {text: words for text, words in page_words().items() if set(latin_words(words)) - {"Alt", "app"}}
    assert left == {}
    assert all(text == words for text, words in page_words().items()), "English stays as the scripts have it"


def test_scripts_show_no_words_but_through_say() -> None:
    found = []
    for name, text in scripts():
        for line in text.splitlines():
            code = re.sub(r"(^|\s)//.*", "", line)
            code = re.sub(r'^  "?[\w$ ]+"?: say|, "?[\w$ ]+"?: say', ": say", code)  # keys of the words of the editor
            found += [(name, m[2]) for m in _TEXT.finditer(code) if _WORDS.search(m[2]) and not _NO_WORDS.search(m[2])]
    assert found == []


def test_sliders_have_japanese_names() -> None:
    labels = {label for kind in structure_kinds() for _, label in (*structure_kind(kind).numbers, *COMMON)}
    with spoken_in("ja"):
        assert [label for label in sorted(labels) if latin_words(said(label)) or " " in said(label)] == []


@pytest.fixture
def page(tmp_path: Path) -> Iterator[Any]:
    (tmp_path / "pile.yaml").write_text(MEMBER)
    secrets, root = Secrets(), tmp_path.resolve()
    app = App(Folder(root, root / "out"), run_slowly, secrets, "pile.yaml", "ja")
    with TestClient(create(app, PORT), base_url=f"http://127.0.0.1:{PORT}") as client:
        client.get(f"/?token={secrets.address}")
        client.headers.update({"X-Moyai-Token": secrets.header, "Content-Type": "application/json"})
        yield client


def helps(entry: dict[str, Any]) -> Iterator[str]:
    yield entry["help"]
    for one in (*entry.get("entries", ()), *entry.get("absent", ())):
        yield from helps(one)


@pytest.mark.slow
def test_the_server_speaks_japanese(page: Any) -> None:
    html = page.get("/").text
    assert '<html lang="ja">' in html and "{{" not in html
    words = json.loads(re.findall(r'id="app-words">(.*?)</script>', html)[0])
    assert words["Undo"] == "元に戻す"

    found = page.get("/api/gallery").json()
    shown = [text for one in found["templates"] for text in (one["name"], one["title"])]
    assert [
        text for text in (*shown, *(one["line"] for one in found["papers"])) if set(latin_words(text)) - {"new", "cage"}
    ] == []

    kept = words_of_files()
    for template in ("breakwater", "curtain", "cage", "network", "member", "units"):
        record = page.post("/api/cases", content=json.dumps({"template": template})).json()
        form = page.get(f"/api/cases/{record['id']}/form").json()["form"]
        assert form["label"] == "ケース"
        reported = [text for text in helps(form) if text]
        assert len(reported) > 20
        assert [text for text in reported if set(latin_words(text)) - kept] == []

    key = page.post("/api/cases", content="{}").json()["id"]
    broken = json.dumps({"text": MEMBER.replace("diameter: 100 cm", "diameter: -1 m"), "sequence": 1})
    lines = page.post(f"/api/cases/{key}/draft", content=broken).text.splitlines()
    (fault,) = json.loads(lines[0])["faults"]
    assert fault["path"] == "structure.section.diameter"
    assert latin_words(fault["message"]) == latin_words(fault["allowed"]) == [] and fault["message"] != ""

    refused = page.post("/api/cases", content=json.dumps({"file": "../other.yaml"})).json()["faults"][0]
    assert "アプリのフォルダの外" in refused["message"] and set(latin_words(refused["remedy"])) == {"app"}
    assert page.get("/api/cases/none").json()["faults"][0]["message"] == "そのようなケース、ジョブ、ファイルはない"


@pytest.mark.slow
def test_a_draft_is_in_the_language_of_the_app_unless_the_case_names_one(page: Any) -> None:
    key = page.post("/api/cases", content="{}").json()["id"]
    for text, japanese in ((MEMBER, True), (MEMBER + "\ndisplay: {language: en}\n", False)):
        body = json.dumps({"text": text, "sequence": 1})
        drawn = json.loads(page.post(f"/api/cases/{key}/draft", content=body).text.splitlines()[-1])
        assert drawn["message"] == "drawn"
        assert bool(re.search("[\u3040-\u30ff]", drawn["html"])) is japanese
