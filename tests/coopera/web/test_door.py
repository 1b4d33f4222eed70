from __future__ import annotations

import socket
import urllib.request
from collections.abc import Callable
from pathlib import Path

import pytest
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route
from starlette.testclient import TestClient

from coopera.core.errors import ConfigError
from coopera.web.common import Door, Pages, fields, make_app, served

PAGES = Pages(Path(__file__).parent)
HERE = "http://127.0.0.1:8765"


async def _said(request: Request) -> Response:
    return JSONResponse(await fields(request))


async def _told(request: Request) -> Response:
    return PAGES.render(request, "problem.html.j2", what="<script>alert(1)</script>", sentence="\u202e<b>\x1b[2J")


async def _fails(request: Request) -> Response:
    raise ConfigError("my.yaml, line 3: <i>expected a number</i>.")


def _app(door: Door) -> Starlette:
    routes = [Route("/said", _said, methods=["POST"]), Route("/", _told), Route("/fails", _fails)]
    return make_app(routes, door=door, pages=PAGES)


def _client(door: Door | None = None, base: str = HERE) -> TestClient:
    return TestClient(_app(door or Door()), base_url=base, follow_redirects=False)


def test_a_page_may_load_and_send_nothing_elsewhere() -> None:
    answer = _client().get("/")
    policy = answer.headers["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "http" not in policy
    assert "unsafe-inline" not in policy.replace("style-src-attr 'unsafe-inline'", "")
    assert answer.headers["x-content-type-options"] == "nosniff"


def test_hostile_text_stays_text() -> None:
    page = _client().get("/").text
    assert "<script>alert" not in page
    assert "&lt;script&gt;alert(1)" in page
    assert "<b>" not in page


def test_what_is_wrong_is_told_in_its_sentence() -> None:
    client = _client()
    answer = client.get("/fails")
    assert (answer.status_code, "expected a number" in answer.text, "<i>" in answer.text) == (400, True, False)
    assert client.get("/fails", headers={"accept": "application/json"}).json()["problem"].startswith("my.yaml, line 3")
    assert client.get("/nowhere").status_code == 404


def test_a_file_has_its_hash_in_its_address_and_is_kept_for_good() -> None:
    client = _client()
    address = PAGES.static("look.css")
    answer = client.get(address)
    assert (answer.status_code, answer.headers["content-type"]) == (200, "text/css; charset=utf-8")
    assert "immutable" in answer.headers["cache-control"]
    assert address in client.get("/").text
    assert client.get("/static/look.css").status_code == 404
    assert client.get("/favicon.ico").headers["content-type"] == "image/svg+xml"


@pytest.mark.parametrize(
    "name", ["evil.example", "127.0.0.1.evil.example", "192.168.1.4", "", "[::1", "localhost.evil.de"]
)
def test_a_foreign_name_for_this_machine_is_refused(name: str) -> None:
    assert _client().get("/", headers={"host": name}).status_code == 421


@pytest.mark.parametrize("name", ["127.0.0.1:8765", "localhost", "LOCALHOST:9", "[::1]:80"])
def test_this_machine_may_be_called_by_its_own_names(name: str) -> None:
    assert _client().get("/", headers={"host": name}).status_code == 200


def test_a_post_needs_the_form_token_of_our_own_page() -> None:
    door = Door()
    client = _client(door)
    given = {"x-form-token": door.form_token}
    assert client.post("/said", json={"a": 1}, headers=given).json() == {"a": 1}
    assert client.post("/said", data={"a": "1", "form_token": door.form_token}).json()["a"] == "1"
    for headers in ({}, {"x-form-token": "guessed"}, {"x-form-token": ""}):
        assert client.post("/said", json={"a": 1}, headers=headers).status_code == 403


@pytest.mark.parametrize(
    "headers",
    [
        {"origin": "http://evil.example"},
        {"origin": "null"},
        {"origin": "http://127.0.0.1:9999"},
        {"sec-fetch-site": "cross-site"},
        {"sec-fetch-site": "same-site"},
    ],
)
def test_a_page_from_another_origin_cannot_post_even_with_the_form_token(headers: dict[str, str]) -> None:
    door = Door()
    answer = _client(door).post("/said", json={}, headers={"x-form-token": door.form_token, **headers})
    assert answer.status_code == 403
    assert "Only a page of this server" in answer.text


def test_a_page_of_a_server_that_was_started_anew_is_told_so_and_can_fetch_the_new_token() -> None:
    door = Door()
    client = _client(door)
    answer = client.post("/said", json={}, headers={"x-form-token": "that of the server before"})
    assert (answer.status_code, answer.headers["x-stale"]) == (403, "1")
    assert client.get("/form-token").json() == {"form_token": door.form_token}


def test_what_is_no_form_or_too_long_is_refused() -> None:
    door = Door()
    client, headers = _client(door), {"x-form-token": door.form_token, "content-type": "application/json"}
    assert client.post("/said", content="[" * 100_000, headers=headers).status_code == 400
    assert client.post("/said", content="[1]", headers=headers).status_code == 400
    assert client.post("/said", content="a" * (1 << 21), headers=headers).status_code == 413


def test_on_this_machine_no_token_is_needed_and_elsewhere_one_is() -> None:
    assert Door.opened("127.0.0.1").token == ""
    door = Door.opened("0.0.0.0")
    assert len(door.token) > 20
    assert door.token in door.address()
    assert door.token != Door.opened("0.0.0.0").token


def test_behind_a_proxy_the_pages_go_by_its_name_and_need_a_token() -> None:
    door = Door.opened("127.0.0.1", 8765, ("study.example.org",))
    assert door.address("/x").startswith("https://study.example.org/x?token=")
    client = _client(door, "http://study.example.org")
    assert client.get("/").status_code == 403
    assert client.get("/", params={"token": door.token}).status_code == 200
    assert client.get("/").status_code == 200
    signed = {"x-form-token": door.form_token, "origin": "https://study.example.org"}
    assert client.post("/said", json={}, headers=signed).status_code == 200


def test_the_token_lets_in_and_is_then_a_cookie_that_no_script_and_no_foreign_page_gets() -> None:
    door = Door.opened("0.0.0.0")
    client = _client(door, "http://192.168.1.4:8765")
    assert client.get("/").status_code == 403
    assert client.get("/", params={"token": "guessed"}).status_code == 403
    assert client.post("/said", json={}, headers={"x-form-token": door.form_token}).status_code == 403
    welcome = client.get("/fails", params={"token": door.token, "a": "b"})
    assert (welcome.status_code, "url=/fails?a=b" in welcome.text) == (200, True)
    cookie = welcome.headers["set-cookie"].lower()
    assert "httponly" in cookie
    assert "samesite=strict" in cookie
    assert client.get("/").status_code == 200
    assert client.post("/said", json={}, headers={"x-form-token": door.form_token}).status_code == 200
    assert client.get("/", headers={"host": "evil.example"}).status_code == 421


def test_the_way_in_leads_to_no_other_machine() -> None:
    door = Door.opened("0.0.0.0")
    client = _client(door, "http://192.168.1.4:8765")
    for path in ("//evil.example/x", "/\\evil.example", "/%2F/evil.example"):
        page = client.get(HERE.replace("127.0.0.1", "192.168.1.4") + path, params={"token": door.token}).text
        assert "url=//" not in page
        assert "url=/\\" not in page


def test_a_server_beside_other_work_answers_and_ends() -> None:
    with served(_app, Door(port=0)) as server:
        with urllib.request.urlopen(server.address, timeout=20) as answer:
            assert answer.status == 200
        address = server.address
    with pytest.raises(OSError, match="refused"):
        urllib.request.urlopen(address, timeout=20)


def test_a_port_in_use_is_told_in_one_sentence() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        door = Door(port=taken.getsockname()[1])
        with pytest.raises(ConfigError, match="in use; name another"):
            _serve_shortly(door)


@pytest.mark.parametrize(
    ("door", "sentence"),
    [
        (Door(port=70000), "70000 is no port"),
        (Door(host="203.0.113.7", port=0), "no address of this machine"),
        (Door(host="no such name", port=0), "no address of this machine"),
    ],
)
def test_an_address_that_cannot_be_had_is_told_in_one_sentence(door: Door, sentence: str) -> None:
    with pytest.raises(ConfigError, match=sentence):
        _serve_shortly(door)


def _serve_shortly(door: Door, make: Callable[[Door], Starlette] = _app) -> None:
    with served(make, door):
        pass
