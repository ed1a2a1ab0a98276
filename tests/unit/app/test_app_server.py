"""The addresses of the app in order: open, draft, undo, pin, save, run, take away; what is not there is refused."""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

pytest.importorskip("starlette")
pytest.importorskip("httpx")

from app_runs import MEMBER, run_slowly
from starlette.testclient import TestClient

from moyai.app.folder import Folder
from moyai.app.security import REPORT_POLICY, Secrets
from moyai.app.server import create
from moyai.app.state import App

PORT = 8766


@dataclass
class Page:
    """What the page of the browser does."""

    client: TestClient
    secrets: Secrets
    folder: Path

    def get(self, address: str, status: int = 200) -> Any:
        answer = self.client.get(address)
        assert answer.status_code == status, answer.text[:300]
        return answer

    def post(self, address: str, body: Any = None, status: int = 200) -> Any:
        headers = {"X-Moyai-Token": self.secrets.header, "Content-Type": "application/json"}
        answer = self.client.post(address, content=json.dumps({} if body is None else body), headers=headers)
        assert answer.status_code == status, answer.text[:300]
        return answer.json() if answer.headers["content-type"] == "application/json" else answer

    def draft(self, key: str, **body: Any) -> list[dict[str, Any]]:
        return [json.loads(line) for line in self.post(f"/api/cases/{key}/draft", body).text.splitlines()]


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Page]:
    root = tmp_path_factory.mktemp("cases")
    (root / "pile.yaml").write_text(MEMBER)
    (root / "secret.txt").write_text("secret")
    secrets = Secrets()
    app = App(Folder(root.resolve(), root.resolve() / "out"), run_slowly, secrets, "pile.yaml")
    with TestClient(create(app, PORT), base_url=f"http://127.0.0.1:{PORT}") as client:
        client.get(f"/?token={secrets.address}")
        yield Page(client, secrets, root)


def test_the_page_and_its_parts(page: Page) -> None:
    text = page.get("/").text
    assert page.secrets.header in text
    assert page.secrets.cookie not in text and page.secrets.address not in text
    for part in ("page.js", "case.js", "app.css", "report.css", "figures.js"):
        assert f"/assets/{part}" in text or part == "case.js"
        page.get(f"/assets/{part}")
    for name in ("server.py", "..%2fserver.py", "%2e%2e/server.py", "index.html/../../server.py", "nothing.js"):
        assert page.client.get(f"/assets/{name}").status_code == 404


def test_the_gallery_has_files_templates_and_papers(page: Page) -> None:
    found = page.get("/api/gallery").json()
    assert found["version"] == 1
    assert {"file": "pile.yaml", "kind": "member", "title": "Quick member"} in found["files"]
    assert {one["template"] for one in found["templates"]} >= {"breakwater", "curtain", "cage", "network", "member"}
    assert len(found["papers"]) == 5


@pytest.mark.slow
def test_a_case_from_opening_to_saving(page: Page) -> None:
    record = page.post("/api/cases", {"file": "pile.yaml"})
    key, text = record["id"], record["text"]
    assert (text, record["unsaved"]) == (MEMBER, False)
    checked, drawn = page.draft(key, sequence=1, text=text)
    assert (checked["sequence"], checked["message"], drawn["message"]) == (1, "checked", "drawn")
    before = drawn["headlines"][0]["value"]

    (pin,) = page.post(f"/api/cases/{key}/pin", {"name": "as built"})["pins"]
    moves = {"structure.section.diameter": "90"}
    checked, drawn = page.draft(key, sequence=2, text=text, edits=moves, gesture="slider")
    assert checked["text"] == MEMBER.replace("100 cm", "90 cm")
    assert drawn["headlines"][0]["value"] < before
    assert "(as built)" in json.dumps(drawn["data"])
    first, second = page.post(f"/api/cases/{key}/pin", {"name": "as  built"})["pins"]
    assert (first["name"], second["name"]) == ("as built", "as built #2")
    assert page.post(f"/api/cases/{key}/pin", {"id": first["id"], "name": "wide"})["pins"][0]["name"] == "wide"
    assert page.get(f"/api/cases/{key}").json()["pins"][1] == second, "a reload finds the pins"
    assert page.post(f"/api/cases/{key}/pin", {"id": pin["id"]})["pins"] == [second]
    page.post(f"/api/cases/{key}/pin", {"id": "none"}, status=404)
    assert page.get(f"/api/cases/{key}").json()["text"] == checked["text"], "a reload finds the text of now"

    page.post(f"/api/cases/{key}/save")
    assert (page.folder / "pile.yaml").read_text() == checked["text"]
    undone = page.post(f"/api/cases/{key}/undo")
    assert (undone["text"], undone["unsaved"]) == (MEMBER, True)
    assert page.post("/api/cases", {"file": "./pile.yaml"})["id"] == key, "the same file is the same case"
    answer = page.get(f"/api/cases/{key}/case.yaml")
    assert answer.text == MEMBER and "attachment" in answer.headers["content-disposition"]


def test_the_form_changes_the_text_in_place(page: Page) -> None:
    record = page.post("/api/cases", {"template": "member"})
    key, text = record["id"], record["text"]
    form = page.get(f"/api/cases/{key}/form").json()["form"]
    assert any(entry["dotted"] == "structure" for entry in form["entries"])
    wish = {"text": text, "change": "set", "path": ["title"], "value": "A: pile", "quoted": True}
    record = page.post(f"/api/cases/{key}/change", wish)
    assert record["text"] == text.replace("title: Submerged member", "title: 'A: pile'") and record["can_undo"]
    assert page.post(f"/api/cases/{key}/undo")["text"] == text
    refused = page.post(f"/api/cases/{key}/change", {"text": text, "change": "remove", "path": ["nothing"]}, 422)
    assert "not written" in refused["faults"][0]["message"]
    for odd in ({"change": "set", "path": []}, {"change": "x", "path": ["a"]}, {"change": "set", "path": [True]}):
        page.post(f"/api/cases/{key}/change", {"text": text, **odd}, 400)
    assert page.get(f"/api/cases/{key}").json()["text"] == text
    page.draft(key, sequence=9, text="structure: {kind: nothing}")
    assert "kind" in page.get(f"/api/cases/{key}/form", 422).json()["faults"][0]["message"]


def test_errors_come_with_their_lines(page: Page) -> None:
    key = page.post("/api/cases", {"template": "member"})["id"]
    (checked,) = page.draft(key, sequence=1, text="moyai: 1\nstructure: {kind: membr}\n")
    assert checked["faults"][0]["line"] == 2
    assert "member" in checked["faults"][0]["remedy"]
    (checked,) = page.draft(key, sequence=2, text="a: [1\n")
    assert checked["faults"] and checked["faults"][0]["line"] >= 1


@pytest.mark.parametrize("name", ["../x.yaml", "/etc/passwd", "secret.txt", "absent.yaml", "", ".", "out\u0000.yaml"])
def test_only_case_files_of_the_folder_are_opened_or_written(page: Page, name: str) -> None:
    if name:
        page.post("/api/cases", {"file": name}, status=422)
    key = page.post("/api/cases", {"template": "member"})["id"]
    if name and name != "absent.yaml":
        page.post(f"/api/cases/{key}/save", {"name": name}, status=422)
    assert (page.folder / "secret.txt").read_text() == "secret"
    assert sorted(one.name for one in page.folder.parent.glob("*.yaml")) == []


def test_a_case_does_not_replace_another_file(page: Page) -> None:
    key = page.post("/api/cases", {"template": "member"})["id"]
    page.post(f"/api/cases/{key}/save", {"name": "pile.yaml"}, status=422)
    assert page.post(f"/api/cases/{key}/save", {"name": "sub/new.yaml"})["name"] == "sub/new.yaml"
    (page.folder / "sub" / "new.yaml").write_text("changed: elsewhere\n")
    page.post(f"/api/cases/{key}/save", status=422)


@pytest.mark.parametrize(
    ("mark", "coding", "ends"),
    [
        (b"", "utf-8", "\n"), (b"", "utf-8", "\r\n"), (b"\xef\xbb\xbf", "utf-8", "\r\n"),
        (b"\xff\xfe", "utf-16-le", "\r\n"), (b"\xfe\xff", "utf-16-be", "\n"),
    ],
)  # fmt: skip
def test_a_file_keeps_its_encoding_and_line_ends(page: Page, mark: bytes, coding: str, ends: str) -> None:
    def written(diameter: str) -> bytes:
        return mark + MEMBER.replace("100 cm", diameter).replace("\n", ends).replace("Quick", "柱").encode(coding)

    file = page.folder / f"{coding}{len(mark)}{len(ends)}.yaml"
    file.write_bytes(written("100 cm"))
    key = page.post("/api/cases", {"file": file.name})["id"]
    page.draft(key, sequence=1, edits={"structure.section.diameter": "90"})
    assert page.post(f"/api/cases/{key}/save")["unsaved"] is False
    assert file.read_bytes() == written("90 cm")


def test_numbers_go_into_the_text_of_now(page: Page) -> None:
    """A page that sends no text of its own cannot take back what another page has changed."""
    (page.folder / "two.yaml").write_text(MEMBER)
    key = page.post("/api/cases", {"file": "two.yaml"})["id"]
    page.draft(key, tab="a", gesture="slider a", edits={"structure.section.diameter": "90"})
    checked, _ = page.draft(key, tab="b", gesture="slider b", edits={"site.water_depth": "22"})
    assert checked["text"] == MEMBER.replace("100 cm", "90 cm").replace("20 m", "22 m")
    assert checked["unsaved"] and checked["can_undo"]
    assert page.post(f"/api/cases/{key}/undo")["text"] == MEMBER.replace("100 cm", "90 cm")


def test_a_file_that_another_program_writes_is_followed(page: Page) -> None:
    file = page.folder / "followed.yaml"
    file.write_text("")
    key = page.post("/api/cases", {"file": file.name})["id"]
    page.draft(key, text=MEMBER, gesture="typing")
    assert page.post(f"/api/cases/{key}/save")["unsaved"] is False, "a file that was empty is its own"
    file.write_text(MEMBER.replace("20 m", "30 m"))
    record = page.get(f"/api/cases/{key}").json()
    assert (record["text"], record["unsaved"]) == (MEMBER.replace("20 m", "30 m"), False)

    page.draft(key, text=MEMBER.replace("20 m", "40 m"), gesture="typing")
    file.write_text(MEMBER.replace("20 m", "50 m"))
    record = page.get(f"/api/cases/{key}").json()
    assert (record["file"], record["text"]) == ("changed", MEMBER.replace("20 m", "40 m"))
    page.post(f"/api/cases/{key}/save", status=422)
    record = page.post(f"/api/cases/{key}/file", {"take": True})
    assert (record["text"], record["file"]) == (MEMBER.replace("20 m", "50 m"), "same")
    assert "40 m" in page.post(f"/api/cases/{key}/undo")["text"]

    file.write_bytes(b"\xff\xff no text")
    assert page.get(f"/api/cases/{key}").json()["file"] == "gone"
    page.post(f"/api/cases/{key}/save", status=422)
    assert file.read_bytes() == b"\xff\xff no text"
    file.unlink()
    assert page.get(f"/api/cases/{key}").json()["unsaved"]
    page.post(f"/api/cases/{key}/save")
    assert "40 m" in file.read_text()


def test_a_file_that_cannot_be_read_hides_no_other(page: Page, monkeypatch: pytest.MonkeyPatch) -> None:
    (page.folder / "locked.yaml").write_text(MEMBER)
    read, read_bytes = Path.read_text, Path.read_bytes

    def refuse(path: Path, given: Any, *arguments: Any, **options: Any) -> Any:
        if path.name == "locked.yaml":
            raise PermissionError(13, "Permission denied", str(path))
        return given(path, *arguments, **options)

    monkeypatch.setattr(Path, "read_text", lambda path, *more, **options: refuse(path, read, *more, **options))
    monkeypatch.setattr(Path, "read_bytes", lambda path: refuse(path, read_bytes))
    files = [one["file"] for one in page.get("/api/gallery").json()["files"]]
    assert "pile.yaml" in files and "locked.yaml" not in files
    (fault,) = page.post("/api/cases", {"file": "locked.yaml"}, status=422)["faults"]
    assert fault["message"].endswith("locked.yaml: Permission denied")


def test_a_case_is_taken_away_under_its_name(page: Page) -> None:
    (page.folder / "浮 'a'.yaml").write_text(MEMBER)
    key = page.post("/api/cases", {"file": "浮 'a'.yaml"})["id"]
    said = page.get(f"/api/cases/{key}/case.yaml").headers["content-disposition"]
    assert said == "attachment; filename*=utf-8''%E6%B5%AE%20%27a%27.yaml"


@pytest.mark.parametrize(
    "body",
    [
        [],
        "text",
        {"text": 1},
        {"edits": []},
        {"edits": {"a": 1}},
        {"sequence": "1}"},
        {"text": "a", "edits": None},
        {"text": "\ud800"},
        {"tab": 1},
    ],
)
def test_odd_requests_are_refused(page: Page, body: Any) -> None:
    key = page.post("/api/cases", {"template": "member"})["id"]
    page.post(f"/api/cases/{key}/draft", body, status=400)
    page.post("/api/cases/nothing/draft", {}, status=404)
    page.post("/api/jobs", {"case": "nothing"}, status=404)
    page.post("/api/jobs/job99/cancel", status=404)


@pytest.mark.slow
def test_a_full_run_with_its_files(page: Page) -> None:
    key = page.post("/api/cases", {"file": "pile.yaml"})["id"]
    text = MEMBER + "# not saved\n"
    page.draft(key, sequence=9, text=text)
    job = page.post("/api/jobs", {"case": key})
    end = time.monotonic() + 60.0
    while job["state"] in ("waiting", "running"):
        assert time.monotonic() < end
        time.sleep(0.1)
        job = next(one for one in page.get("/api/jobs").json()["jobs"] if one["id"] == job["id"])
    assert job["state"] == "done", job
    assert job["files"][:4] == ["report.html", "results.nc", "report.xlsx", "case.yaml"]
    assert job["files"][4:] == ["report.pdf", "report.docx", "tables.zip"], "made when they are asked for"
    assert page.get(f"/results/{job['id']}/tables.zip?download").content.startswith(b"PK")
    assert job["command"] == "moyai run out/pile/case.yaml --output out/pile", "the text was not saved"
    report = page.get(f"/results/{job['id']}/report.html")
    assert report.headers["content-security-policy"] == REPORT_POLICY
    assert page.get(f"/results/{job['id']}/case.yaml?download").text == text
    for name in ("coefficients", "..%2f..%2fsecret.txt", "report_tables", ".run.lock"):
        assert page.client.get(f"/results/{job['id']}/{name}").status_code == 404
    (page.folder / "out" / "pile" / "report.xlsx").unlink()
    (page.folder / "out" / "pile" / "report.xlsx").symlink_to(page.folder / "secret.txt")
    page.get(f"/results/{job['id']}/report.xlsx", status=422)
