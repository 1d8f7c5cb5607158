"""Users of the real program: the first sign-in, wrong passwords, lockout, the CSRF token, API tokens, and no local access.

In: the real program, as an outsider. Out: judgements. Nothing secret may be found in the log or in the events.
"""
import json
import time
import socket

from harness import DEMO, Gateway

FIRST = "correct-horse-9"


def first(gateway, status=200, **change):
    s, body, head = gateway.request("POST", "/api/v1/session/first", {"code": gateway.code, "user": "anna", "password": FIRST, **change})
    assert s == status, (s, body)
    return {"Cookie": head["Set-Cookie"].split(";")[0], "X-CSRF-Token": body["csrf"]} if s == 200 else body


def ask(gateway, method, path, body=None, headers=None):
    s, answer, _ = gateway.request(method, "/api/v1" + path, body, headers)
    return s, answer


def test_without_local_access_everything_begins_with_the_first_sign_in(folder):
    with Gateway(folder, DEMO, "--set", "users.local_role=none") as g:
        assert len(g.code) == 19, g.code
        for path in ("/axes", "/site", "/events", "/users"):
            assert ask(g, "GET", path)[0] == 401, path
        assert g.request("GET", "/healthz")[0] == 200 and g.request("GET", "/metrics")[0] == 401
        session = ask(g, "GET", "/session")[1]
        assert session["role"] is None and session["via"] == "none" and session["first_sign_in"] is True
        first(g, 401, code="0000-0000-0000-0000")
        first(g, 422, password="short")
        anna = first(g)
        first(g, 409)
        assert ask(g, "GET", "/axes", headers=anna)[0] == 200
        assert ask(g, "GET", "/session", headers=anna)[1]["first_sign_in"] is False
        # Over a cookie, a change needs the session's token.
        stop = {"command": "quick_stop"}
        s, body = ask(g, "POST", "/axes/feeder/commands", stop, {"Cookie": anna["Cookie"]})
        assert s == 403 and body["reason"] == "csrf", body
        assert ask(g, "POST", "/users", {"name": "ben", "password": "a-long-sentence-1", "role": "viewer"}, anna)[0] == 201
        short = ask(g, "POST", "/tokens", {"name": "short", "role": "viewer"}, anna)[1]
        with socket.create_connection((g.http[0], int(g.http[1])), timeout=20) as feed:
            feed.sendall((f"GET /api/v1/stream HTTP/1.1\r\nHost: {g.http[0]}:{g.http[1]}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                          f"Authorization: Bearer {short['token']}\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
            assert b" 101 " in feed.recv(4096)
            assert ask(g, "DELETE", f"/tokens/{short['id']}", headers=anna)[0] == 204
            feed.settimeout(10)  # the gateway looks every two seconds
            heard = b""
            while b"the token has expired or was removed" not in heard:
                part = feed.recv(4096)
                assert part, heard
                heard += part
        s, body = ask(g, "POST", "/tokens", {"name": "line3", "role": "operator"}, anna)
        assert s == 201
        token = {"Authorization": "Bearer " + body["token"]}
        assert ask(g, "GET", "/session", headers=token)[1]["role"] == "operator"
        assert ask(g, "PUT", "/axes/feeder/parameters/AC", {"value": 1}, token)[0] == 403
        events = ask(g, "GET", "/events", headers=anna)[1]
        assert {"access"} <= {e["kind"] for e in events}, events
        written = json.dumps(events) + g.errors()
        for secret in (FIRST, "a-long-sentence-1", g.code, body["token"], anna["Cookie"].split("=", 1)[1], anna["X-CSRF-Token"]):
            assert secret not in written, secret
        assert g.stop() == 0
    with Gateway(folder, None, "--set", "users.local_role=none") as g:
        assert g.code == "", "there are users: no code"
        assert ask(g, "GET", "/axes", headers=anna)[0] == 401, "sessions end with the program"
        assert ask(g, "GET", "/axes", headers=token)[0] == 200, "tokens do not"
        assert ask(g, "POST", "/session", {"user": "ben", "password": "a-long-sentence-1"})[0] == 200


def test_wrong_passwords_wait_longer_and_longer(gateway):
    first(gateway)
    for _ in range(3):
        begun = time.monotonic()
        assert ask(gateway, "POST", "/session", {"user": "anna", "password": "wrong"})[0] == 401
    # The pauses are 1, 2, 4 ... s from the last attempt on: one that is looked at again has waited for longer, on a machine that takes its time.
    wait, pause, last = 0, 1, begun
    for _ in range(6):
        begun = time.monotonic()
        s, body, head = gateway.request("POST", "/api/v1/session", {"user": "anna", "password": "wrong"})
        if s == 429:
            wait = int(head["Retry-After"])
            break
        assert s == 401 and time.monotonic() - last >= pause, (s, body, pause)
        pause, last = 2 * pause, begun
    assert wait >= 1, "never refused unseen"
    s, body, head = gateway.request("POST", "/api/v1/session", {"user": "anna", "password": FIRST})
    assert s == 429 and 1 <= int(head["Retry-After"]) <= wait, (s, body)
    assert ask(gateway, "GET", "/axes")[0] == 200, "local access goes on"


def test_the_code_is_shown_once_and_can_be_made_anew(folder):
    with Gateway(folder) as g:
        old = g.code
        g.stop()
    with Gateway(folder, None) as g:
        assert g.code == "" and old
        g.stop()
    with Gateway(folder, None, "--set", "users.new_code=true") as g:
        assert g.code and g.code != old
        first(g, 401, code=old)
        first(g)


def test_a_session_that_has_ended_is_not_this_machine(folder):
    with Gateway(folder) as g:
        anna = first(g)
        assert ask(g, "POST", "/users", {"name": "ben", "password": "a-long-sentence-1", "role": "viewer"}, anna)[0] == 201
        s, session, head = g.request("POST", "/api/v1/session", {"user": "ben", "password": "a-long-sentence-1"})
        ben = {"Cookie": head["Set-Cookie"].split(";")[0], "X-CSRF-Token": session["csrf"]}
        assert ask(g, "PATCH", "/axes/feeder", {"unit": "m"}, ben)[0] == 403
        assert ask(g, "DELETE", "/session", None, ben)[0] == 204
        s, body, head = g.request("PATCH", "/api/v1/axes/feeder", {"unit": "m"}, ben)
        assert s == 401 and body["type"].endswith("session_ended") and "Max-Age=0" in head["Set-Cookie"], (s, body, head)
        assert g.stop() == 0
    with Gateway(folder, None) as g:
        for headers in (anna, ben):
            s, body, head = g.request("GET", "/api/v1/axes", None, headers)
            assert s == 401 and body["type"].endswith("session_ended") and "Max-Age=0" in head["Set-Cookie"], "a restart is no way round"
            feed = {**headers, "Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13", "Sec-WebSocket-Key": "AAAAAAAAAAAAAAAAAAAAAA=="}
            assert g.request("GET", "/api/v1/stream", None, feed)[0] == 401
            s, session, head = g.request("GET", "/api/v1/session", None, headers)
            assert s == 200 and session["role"] is None and session["ended"] and "Max-Age=0" in head["Set-Cookie"], session
            assert g.request("GET", "/", None, headers)[0] == 200, "the page itself comes"
            assert ask(g, "POST", "/session", {"user": "ben", "password": "a-long-sentence-1"}, headers)[0] == 200
        assert ask(g, "GET", "/session")[1]["via"] == "local", "without a cookie: this machine"
