"""Who is refused: foreign hosts, foreign pages, requests without the cookie or the token, bodies that are too large."""

from __future__ import annotations

import pytest

pytest.importorskip("starlette")
pytest.importorskip("httpx")

from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import PlainTextResponse
from starlette.routing import Route
from starlette.testclient import TestClient

from moyai.app.security import LARGEST_BODY, BodyTooLarge, Guard, Secrets

# Fixed: parallel processes of the tests must name their parameters alike
SECRETS = Secrets("secret-of-the-address", "secret-of-the-cookie", "secret-of-the-header")
BASE = "http://127.0.0.1:8765"
COOKIE = {"Cookie": f"moyai_8765={SECRETS.cookie}"}
TOKEN = {**COOKIE, "X-Moyai-Token": SECRETS.header, "Content-Type": "application/json"}


async def _echo(request: Request) -> PlainTextResponse:
    try:
        return PlainTextResponse(str(len(await request.body())))
    except BodyTooLarge:
        return PlainTextResponse("too large", 413)


@pytest.fixture
def client() -> TestClient:
    inner = Starlette(routes=[Route("/{rest:path}", _echo, methods=["GET", "POST"])])
    return TestClient(Guard(inner, SECRETS, 8765), base_url=BASE, follow_redirects=False)


def test_the_address_gives_a_cookie_and_a_clean_address(client: TestClient) -> None:
    answer = client.get(f"/?token={SECRETS.address}")
    assert answer.status_code == 303
    assert answer.headers["location"] == "/"
    cookie = answer.headers["set-cookie"]
    assert "HttpOnly" in cookie and "SameSite=Strict" in cookie
    assert SECRETS.address not in cookie
    assert client.get("/").status_code == 200


def test_answers_carry_the_policy_of_the_page(client: TestClient) -> None:
    headers = client.get("/", headers=COOKIE).headers
    assert headers["content-security-policy"].startswith("default-src 'self'")
    assert "unsafe-eval" not in headers["content-security-policy"]
    assert headers["x-content-type-options"] == "nosniff"
    assert headers["cache-control"] == "no-store"


@pytest.mark.parametrize("token", ["", "wrong", SECRETS.cookie, SECRETS.header, SECRETS.address[:-1]])
def test_another_token_in_the_address_is_refused(client: TestClient, token: str) -> None:
    answer = client.get("/", params={"token": token})
    assert answer.status_code == 403
    assert "set-cookie" not in answer.headers


@pytest.mark.parametrize(
    "host",
    ["evil.example", "evil.example:8765", "127.0.0.1", "127.0.0.1:80", "localhost.evil.example:8765", "[::1]:8765"],
)
def test_a_foreign_host_is_refused(client: TestClient, host: str) -> None:
    assert client.get("/", headers={**COOKIE, "Host": host}).status_code == 421
    assert client.get(f"/?token={SECRETS.address}", headers={"Host": host}).status_code == 421


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "https://127.0.0.1:8765", "http://127.0.0.1:9999"])
def test_a_foreign_origin_is_refused(client: TestClient, origin: str) -> None:
    assert client.get("/", headers={**COOKIE, "Origin": origin}).status_code == 403
    assert client.post("/x", content="{}", headers={**TOKEN, "Origin": origin}).status_code == 403


def test_another_site_is_refused_by_its_fetch_metadata(client: TestClient) -> None:
    for site in ("cross-site", "same-site"):
        assert client.get("/", headers={**COOKIE, "Sec-Fetch-Site": site}).status_code == 403


def test_the_own_origin_is_answered(client: TestClient) -> None:
    answer = client.post("/x", content="{}", headers={**TOKEN, "Origin": BASE, "Sec-Fetch-Site": "same-origin"})
    assert (answer.status_code, answer.text) == (200, "2")


@pytest.mark.parametrize("cookie", [{}, {"Cookie": "moyai_8765=wrong"}, {"Cookie": f"moyai_1={SECRETS.cookie}"}])
def test_without_the_cookie_nothing_is_answered(client: TestClient, cookie: dict[str, str]) -> None:
    assert client.get("/", headers=cookie).status_code == 403
    assert client.post("/x", content="{}", headers={**TOKEN, "Cookie": cookie.get("Cookie", "")}).status_code == 403


@pytest.mark.parametrize("token", ["", "wrong", SECRETS.address, SECRETS.cookie])
def test_changing_requests_need_the_token(client: TestClient, token: str) -> None:
    assert client.post("/x", content="{}", headers={**TOKEN, "X-Moyai-Token": token}).status_code == 403


def test_forms_and_other_methods_are_refused(client: TestClient) -> None:
    form = {**TOKEN, "Content-Type": "application/x-www-form-urlencoded"}
    assert client.post("/x", content="a=b", headers=form).status_code == 415
    for method in ("PUT", "DELETE", "OPTIONS", "TRACE"):
        assert client.request(method, "/x", headers=TOKEN).status_code == 405


def test_a_body_over_the_limit_is_refused_by_its_header(client: TestClient) -> None:
    for length in (str(LARGEST_BODY + 1), "-1", "many"):
        assert client.post("/x", content=b"", headers={**TOKEN, "Content-Length": length}).status_code == 413


def test_a_body_over_the_limit_is_refused_while_it_comes(client: TestClient) -> None:
    """Without a length in the header the bytes are counted."""
    chunk = b" " * 1_000_000
    answer = client.post("/x", content=(chunk for _ in range(21)), headers=TOKEN)
    assert (answer.status_code, answer.text) == (413, "too large")
    answer = client.post("/x", content=(chunk for _ in range(20)), headers=TOKEN)
    assert (answer.status_code, answer.text) == (200, "20000000")
