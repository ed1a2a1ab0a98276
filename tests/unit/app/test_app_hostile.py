"""The app as a process of its own under load and abuse: requests are served or refused, and the server lives."""

from __future__ import annotations

import contextlib
import http.client
import json
import os
import random
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from app_runs import MEMBER

from moyai.app.draft import Drafts
from moyai.app.messages import Wish
from moyai.app.stages import stages_of
from moyai.case.reader import case_of
from moyai.case.sliders import sliders_of
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.cli.runner import run
from moyai.core.progress import silent

pytest.importorskip("starlette")
pytest.importorskip("uvicorn")
pytestmark = pytest.mark.slow


@dataclass
class Server:
    port: int
    cookie: str
    token: str

    def ask(self, method: str, path: str, body: Any = None, **headers: str) -> tuple[int, bytes]:
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=120)
        given = {"Cookie": self.cookie, "X-Moyai-Token": self.token, "Content-Type": "application/json", **headers}
        raw = body if isinstance(body, bytes | type(None)) else json.dumps(body).encode()
        try:
            connection.request(method, path, raw, given)
            answer = connection.getresponse()
            return answer.status, answer.read()
        finally:
            connection.close()

    def lives(self) -> bool:
        return self.ask("GET", "/api/gallery")[0] == 200


def start(root: Path) -> tuple[subprocess.Popen[str], Server]:
    command = [sys.executable, "-m", "moyai", "app", str(root), "--no-browser"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=os.environ)
    assert process.stdout is not None
    found = re.search(r"http://127\.0\.0\.1:(\d+)/\?token=(\S+)", process.stdout.readline())
    assert found is not None
    server = Server(int(found[1]), "", "")
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=60)
    connection.request("GET", f"/?token={found[2]}")
    answer = connection.getresponse()
    server.cookie = answer.headers["set-cookie"].split(";")[0]
    connection.close()
    page = server.ask("GET", "/")[1].decode()
    token = re.search(r'name="moyai-token" content="([^"]+)"', page)
    assert token is not None
    server.token = token[1]
    return process, server


@contextlib.contextmanager
def serving(folder: Path) -> Iterator[Server]:
    (folder / "pile.yaml").write_text(MEMBER)
    process, found = start(folder)
    yield found
    assert process.poll() is None, "the server has ended"
    process.send_signal(signal.SIGINT)
    assert process.wait(20) == 0


@pytest.fixture
def server(tmp_path: Path) -> Iterator[Server]:
    with serving(tmp_path) as found:
        yield found


@pytest.fixture(scope="module")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Server]:
    """One server for requests that it has to outlive, each of which is followed by one that it has to answer."""
    with serving(tmp_path_factory.mktemp("shared")) as found:
        yield found


def test_a_thousand_requests_at_once(server: Server) -> None:
    key = json.loads(server.ask("POST", "/api/cases", {"file": "pile.yaml"})[1])["id"]
    paths = ["/api/gallery", "/api/jobs", f"/api/cases/{key}", f"/api/cases/{key}/form", "/assets/case.js", "/nothing"]

    def one(number: int) -> int:
        try:
            if number % 50 == 7:
                wish = {"text": MEMBER, "sequence": number, "edits": {"structure.section.diameter": str(number)}}
                return server.ask("POST", f"/api/cases/{key}/draft", wish)[0]
            return server.ask("GET", paths[number % len(paths)])[0]
        except OSError:
            return 0

    with ThreadPoolExecutor(100) as pool:
        found = list(pool.map(one, range(1000)))
    assert set(found) <= {0, 200, 404, 503}
    assert found.count(200) > 700
    assert server.lives()


def test_bodies_beyond_the_limit(shared: Server) -> None:
    connection = socket.create_connection(("127.0.0.1", shared.port), timeout=60)
    head = (
        f"POST /api/cases HTTP/1.1\r\nHost: 127.0.0.1:{shared.port}\r\nCookie: {shared.cookie}\r\n"
        f"X-Moyai-Token: {shared.token}\r\nContent-Type: application/json\r\n"
    )
    connection.sendall((head + "Content-Length: 100000000\r\n\r\n").encode())
    assert b" 413 " in connection.recv(200)
    connection.close()

    # without a length: in pieces, until the shared has enough
    connection = socket.create_connection(("127.0.0.1", shared.port), timeout=60)
    connection.sendall((head + "Transfer-Encoding: chunked\r\n\r\n").encode())
    piece = b"100000\r\n" + b"x" * 0x100000 + b"\r\n"
    answer = b""
    try:
        for _ in range(100):
            connection.sendall(piece)
        answer = connection.recv(200)
    except OSError:
        pass
    connection.close()
    assert answer == b"" or b" 413 " in answer or b" 400 " in answer
    assert shared.lives()


BOMBS = {
    "aliases": "a: &a [x, x, x, x, x, x, x, x, x]\n"
    + "".join(f"{chr(98 + k)}: &{chr(98 + k)} [{', '.join([f'*{chr(97 + k)}'] * 9)}]\n" for k in range(10)),
    "depth": "a: " + "[" * 5000 + "]" * 5000,
    "itself": "a: &a [*a]\n",
    "keys": "{" * 2000,
    "tag": "a: !!python/object/apply:os.system ['true']\n",
    "long": "a: '" + "x" * 3_000_000 + "'",
    "digits": "a: " + "9" * 100_000 + "\n",
    "merges": "a: &a {x: 1}\n" + "".join(f"b{k}: &b{k} {{<<: [*a, *a]}}\n" for k in range(2000)),
}


@pytest.mark.parametrize("name", BOMBS)
def test_texts_that_would_burst_a_reader(shared: Server, name: str) -> None:
    key = json.loads(shared.ask("POST", "/api/cases", {"file": "pile.yaml"})[1])["id"]
    status, answer = shared.ask("POST", f"/api/cases/{key}/draft", {"text": BOMBS[name], "sequence": 1})
    assert status == 200
    said = json.loads(answer.splitlines()[0])
    assert said["message"] == "checked" and said["faults"]
    assert shared.ask("GET", f"/api/cases/{key}/form")[0] in (400, 422)
    wish = {"text": BOMBS[name], "change": "set", "path": ["a"], "value": "1"}
    assert shared.ask("POST", f"/api/cases/{key}/change", wish)[0] in (200, 400, 422)
    assert shared.lives()


CLIMBING = (
    "/assets/../server.py",
    "/assets/%2e%2e%2fserver.py",
    "/results/job1/..%2f..%2fpile.yaml",
    "/api/jobs/%00/study",
    "//etc/passwd",
)


@pytest.mark.parametrize("path", CLIMBING)
def test_paths_that_climb(shared: Server, path: str) -> None:
    assert shared.ask("GET", path)[0] in (400, 404)
    for name in ("../pile.yaml", "/etc/passwd", "pile.yaml/../../x.yaml", "\x00"):
        assert shared.ask("POST", "/api/jobs", {"file": name})[0] in (400, 422)
    assert shared.lives()


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({"Host": "evil.example"}, 421),
        ({"Host": "localhost.evil.example:80"}, 421),
        ({"Origin": "http://evil.example"}, 403),
        ({"Origin": "null"}, 403),
        ({"Sec-Fetch-Site": "cross-site"}, 403),
        ({"X-Moyai-Token": ""}, 403),
        ({"Cookie": ""}, 403),
        ({"Content-Type": "text/plain"}, 415),
    ],
)
def test_other_pages_and_machines_are_refused(shared: Server, headers: dict[str, str], status: int) -> None:
    assert shared.ask("POST", "/api/jobs", {"paper": "tabata"}, **headers)[0] == status
    assert json.loads(shared.ask("GET", "/api/jobs")[1])["jobs"] == []


def _jobs(server: Server) -> list[dict[str, Any]]:
    return list(json.loads(server.ask("GET", "/api/jobs")[1])["jobs"])


def _until(server: Server, state: str, seconds: float = 60.0) -> dict[str, Any]:
    end = time.monotonic() + seconds
    while (found := _jobs(server)[0])["state"] != state:
        assert time.monotonic() < end, found
        time.sleep(0.05)
    return found


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="no SIGKILL here")
@pytest.mark.parametrize("how", ["SIGKILL", "SIGINT"])
def test_jobs_after_the_app_was_ended(tmp_path: Path, how: str) -> None:
    """The job ends with its app, the next app tells so, and the job is started again and cancelled within 2 s."""
    (tmp_path / "breakwater.yaml").write_text(template("breakwater"))
    process, server = start(tmp_path)
    key = json.loads(server.ask("POST", "/api/cases", {"file": "breakwater.yaml"})[1])["id"]
    server.ask("POST", "/api/jobs", {"case": key})
    job = _until(server, "running")
    process.send_signal(getattr(signal, how))
    process.wait(20)
    end = time.monotonic() + 10.0
    while Path(f"/proc/{job['process']}").exists() and time.monotonic() < end:
        time.sleep(0.05)
    assert not Path(f"/proc/{job['process']}").exists(), "the job outlives its app"
    process, server = start(tmp_path)
    try:
        (found,) = _jobs(server)
        assert found["state"] == "lost" and "the app ended" in found["words"]
        assert (found["name"], found["folder"]) == (job["name"], job["folder"])
        server.ask("POST", f"/api/jobs/{found['id']}/again", {})
        _until(server, "running")
        time.sleep(1.0)
        begun = time.monotonic()
        server.ask("POST", f"/api/jobs/{found['id']}/cancel", {})
        _until(server, "cancelled")
        assert time.monotonic() - begun < 3.0
    finally:
        process.send_signal(signal.SIGINT)
        assert process.wait(20) == 0


@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="no SIGHUP here")
@pytest.mark.parametrize("how", ["SIGINT", "SIGTERM", "SIGHUP"])
def test_nothing_is_left_when_the_terminal_ends_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, how: str) -> None:
    """In the middle of a draft: the processes end, and so does the folder of coefficients."""
    cases, kept = tmp_path / "cases", tmp_path / "kept"
    for folder in (cases, kept):
        folder.mkdir()
    (cases / "breakwater.yaml").write_text(template("breakwater"))
    monkeypatch.setenv("TMPDIR", str(kept))
    process, server = start(cases)
    key = json.loads(server.ask("POST", "/api/cases", {"file": "breakwater.yaml"})[1])["id"]

    def draft() -> None:
        with contextlib.suppress(OSError, http.client.HTTPException):
            server.ask("POST", f"/api/cases/{key}/draft", {"sequence": 1})

    asking = threading.Thread(target=draft)
    asking.start()
    time.sleep(2.0)
    assert len(list(kept.iterdir())) == 1
    process.send_signal(getattr(signal, how))
    assert process.wait(20) == 0
    asking.join(20)
    assert list(kept.iterdir()) == []


def test_two_apps_side_by_side(tmp_path: Path) -> None:
    (tmp_path / "pile.yaml").write_text(MEMBER)
    first, one = start(tmp_path)
    second, other = start(tmp_path)
    try:
        assert one.port != other.port and one.cookie.split("=")[0] != other.cookie.split("=")[0]
        both = f"{one.cookie}; {other.cookie}"
        assert one.ask("GET", "/api/gallery", Cookie=both)[0] == other.ask("GET", "/api/gallery", Cookie=both)[0] == 200
        assert one.ask("GET", "/api/gallery", Cookie=other.cookie)[0] == 403
        assert one.ask("POST", "/api/cases", {"file": "pile.yaml"}, **{"X-Moyai-Token": other.token})[0] == 403
    finally:
        for process in (first, second):
            process.send_signal(signal.SIGINT)
            assert process.wait(20) == 0


def test_random_moves_of_a_rigid_cage_equal_fresh_runs(tmp_path: Path) -> None:
    """Members and networks are moved so in test_app_drafts."""
    kind, moves, text = "cage", 75, template("rigid_cage")
    drafts, chance, compared = Drafts(run, tmp_path / "kept"), random.Random(kind), 0
    for _ in range(moves):
        slider = chance.choice(sliders_of(parse_yaml(text), kind))
        steps = round((slider["high"] - slider["low"]) / slider["step"])
        value = slider["low"] + slider["step"] * chance.randint(steps // 4, 3 * steps // 4)
        wish = Wish(text, tmp_path / "case.yaml", tmp_path, {slider["path"]: f"{value:.{slider['decimals']}f}"})
        checked, *drawn = drafts.answer(wish, silent)
        if checked["faults"] or drawn[-1]["message"] != "drawn":
            continue  # the number went too far: the text before it stays
        text = checked["text"]
        fresh = run(case_of(stages_of(parse_yaml(text), kind)[-1], tmp_path / "case.yaml"))
        found = {item["name"]: item["value"] for item in drawn[-1]["headlines"]}
        for headline in fresh.headlines:
            wanted = headline.as_dict()["value"]
            if isinstance(wanted, float):
                assert found[headline.name] == pytest.approx(wanted, rel=1e-12, abs=0.0), headline.name
            else:
                assert found[headline.name] == wanted
        compared += 1
    assert compared > 0.8 * moves
