"""Who comes second is told so, and what is said twice is not guessed at: If-Match everywhere, JSON with one member two times, events of copies.

In: the real program, as an outsider. Out: judgements. The drive itself is asked whether something was sent to it.
"""
import json
import socket

from harness import DEMO, Gateway, run
from test_users import ask, first


def tag_of(gateway, path, headers=None):
    status, body, head = gateway.request("GET", "/api/v1" + path, None, headers)
    assert status == 200, (path, status, body)
    return head["ETag"]


def test_the_second_of_two_is_refused_with_what_is_there_now(gateway):
    anna = first(gateway)
    assert ask(gateway, "POST", "/users", {"name": "ben", "password": "a-long-sentence-1", "role": "viewer"}, anna)[0] == 201
    for path, change, other, now in (("/users/ben", {"role": "operator"}, {"enabled": False}, ("role", "operator")),
                                     ("/modbus", {"read_only": True}, {"read_only": False}, ("read_only", True))):
        tag = tag_of(gateway, path, anna)
        assert ask(gateway, "PATCH", path, change, {**anna, "If-Match": tag})[0] == 200
        status, body, head = gateway.request("PATCH", "/api/v1" + path, other, {**anna, "If-Match": tag})
        assert status == 412 and body["current"][now[0]] == now[1], (path, status, body)
        assert body["etag"] == head["ETag"] == tag_of(gateway, path, anna) != tag
        assert ask(gateway, "GET", path, headers=anna)[1][now[0]] == now[1]
    status, body = ask(gateway, "DELETE", "/users/ben", None, {**anna, "If-Match": '"x"'})
    assert status == 412 and body["current"]["name"] == "ben", body
    assert ask(gateway, "DELETE", "/users/ben", None, {**anna, "If-Match": tag_of(gateway, "/users/ben", anna)})[0] == 204


def test_a_parameter_that_was_written_since_is_not_written(gateway):
    path = "/axes/feeder/parameters/AC"
    read = tag_of(gateway, path)
    assert ask(gateway, "PUT", path, {"value": 31000}, {"If-Match": read})[0] == 200
    mine = tag_of(gateway, path)
    assert mine != read and tag_of(gateway, path + "?cached=1") == mine
    status, body = ask(gateway, "PUT", path, {"value": 32000}, {"If-Match": read})
    assert status == 412 and body["etag"] == mine, body
    assert body["current"]["value"] == 31000 and body["current"]["written_by"] and body["current"]["written_at"], body
    assert gateway.get(path)["value"] == 31000, "the drive has what the first one wrote"
    assert ask(gateway, "PUT", path, {"value": 31000}, {"If-Match": mine})[0] == 200
    assert tag_of(gateway, path) != mine, "the same value written again is another write"


def test_a_member_that_stands_twice_is_refused_at_every_door(gateway, folder):
    head = {"Content-Type": "application/json"}
    for method, path, text, pointer in (("POST", "/axes/feeder/commands", '{"command":"halt","command":"enable"}', "/command"),
                                        ("PUT", "/recipes/x", '{"steps":[{"message":"a"},{"message":"b","\\u006dessage":"c"}]}', "/steps/1/message"),
                                        ("PUT", "/site", '{"lines":[],"lines":[{"name":"can1","uri":"twin","family":"uim342"}]}', "/lines")):
        status, body, _ = gateway.request(method, "/api/v1" + path, text, head)
        assert status == 400 and body["reason"] == "bad_request" and body["faults"][0]["pointer"] == pointer, (path, status, body)
        assert pointer in body["detail"] and pointer.rsplit("/", 1)[1] in body["detail"], body
    assert gateway.axis()["state"] != "operation_enabled"
    host = f"{gateway.http[0]}:{gateway.http[1]}"
    with socket.create_connection((gateway.http[0], int(gateway.http[1])), timeout=10) as feed:
        feed.sendall((f"GET /api/v1/stream HTTP/1.1\r\nHost: {host}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                      "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
        text = b'{"subscribe":["events"],"subscribe":["axes/*"]}'
        feed.sendall(bytes([0x81, 0x80 | len(text), 0, 0, 0, 0]) + text)
        heard = b""
        while b"stands twice" not in heard:
            part = feed.recv(4096)
            assert part, heard
            heard += part
    site = folder / "twice.json"
    site.write_text(json.dumps(DEMO, indent=1).replace('"drive": "slide",', '"drive": "slide",\n   "drive": "feeder",'))
    code, _, err = run("check", "--site", str(site))
    assert code == 2 and "/axes/1/drive" in err and "stands twice" in err, err
    line = 1 + site.read_text()[:site.read_text().index('"drive": "feeder",\n', site.read_text().index('"drive": "slide"'))].count("\n")
    assert f"twice.json:{line}:" in err, (line, err)


def test_what_leaves_or_goes_is_told_in_the_events(gateway):
    anna = first(gateway)
    snapshot = ask(gateway, "POST", "/axes/feeder/snapshots", {"name": "before", "from": "stored"}, anna)
    assert snapshot[0] == 201, snapshot
    assert ask(gateway, "DELETE", "/axes/feeder/snapshots/1", None, anna)[0] == 204
    assert ask(gateway, "GET", "/backup", headers=anna)[0] == 200
    events = ask(gateway, "GET", "/events", headers=anna)[1]
    for words in ('snapshot 1 "before" taken', 'snapshot 1 "before" removed', "a backup was handed out: the whole database"):
        told = [e for e in events if e["text"].startswith(words)]
        assert len(told) == 1 and told[0]["who"].startswith("anna ") and told[0]["door"] == "http", (words, told)


def test_lists_of_the_command_line_are_written_as_in_the_file(folder):
    with Gateway(folder, DEMO, "--set", 'modbus.allow=["127.0.0.1", "127.0.0.2"]', "--set", "modbus.functions=[3,6,16]") as g:
        door = g.get("/modbus")
        assert door["allow"] == ["127.0.0.1", "127.0.0.2"] and door["functions"] == [3, 6, 16], door
        assert g.stop() == 0
    small = folder / "small"
    small.write_text("x")
    code, _, err = run("restore", str(small), "--data", str(folder / "data"))
    assert code != 0 and "is not a database" in err and "SQLite file" not in err, err
