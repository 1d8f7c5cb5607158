"""What is refused before a body is read: every operation of the description that takes one, for everybody who may not.

In: the real program, users of each role. Out: how soon the refusal came, and how much the gateway took in before it. Sends few bytes where
it announces many; ends each connection after a bounded time.
"""
import json
import socket
import time

from test_openapi import API, Client, quoted

NAMES = {"specimen": "17", "line": "can0", "drive": "feeder", "axis": "feeder", "parameter": "AC", "mapping": "m1", "recipe": "x", "run": "1",
         "snapshot": "1", "revision": "1", "user": "anna", "token": "x", "alarm": "1", "unit": "2", "description": "a.eds",
         "gateway": "hall-1", "recording": "x", "capture": "x", "connection": "enip-0", "instance": "300"}
ROLES = ["none", "viewer", "operator", "engineer", "administrator"]
SOON_S = 3.0


def role_of(o):
    role = o.node.get("x-role")
    assert role in ROLES, f"{o.id} states no role: {role}"
    return role


def clients(gateway):
    """One client of each role, by a token of a user; `none` comes as from behind a proxy."""
    admin = Client(gateway).sign_in(gateway)
    out = {"none": {"X-Forwarded-For": "192.0.2.9"}, "administrator": dict(admin.more)}
    for role in ROLES[1:4]:
        status, _, body = admin.request("POST", "/api/v1/users", json.dumps({"name": role, "password": "a-long-sentence-1", "role": role}).encode())
        assert status == 201, body
        one = Client(gateway)
        status, headers, body = one.request("POST", "/api/v1/session", json.dumps({"user": role, "password": "a-long-sentence-1"}).encode())
        assert status == 200, body
        out[role] = {"Cookie": headers["Set-Cookie"].split(";")[0], "X-CSRF-Token": json.loads(body)["csrf"]}
    return out


def target_of(o):
    target = o.path
    for name in o.names():
        target = target.replace("{" + name + "}", quoted(NAMES[name]))
    return target


def announce(gateway, o, headers, length=None, more=""):
    """Sends the head alone and says what came: (status, headers, body, seconds, whether the connection was ended)."""
    head = {"Host": "127.0.0.1", "Content-Type": o.request_media[0], **headers}
    head.update({"Transfer-Encoding": "chunked"} if length is None else {"Content-Length": str(length)})
    text = f"{o.method} {target_of(o)} HTTP/1.1\r\n" + "".join(f"{k}: {v}\r\n" for k, v in head.items()) + more + "\r\n"
    with socket.create_connection((gateway.http[0], int(gateway.http[1])), timeout=SOON_S + 5) as s:
        begun = time.monotonic()
        s.sendall(text.encode())
        said = b""
        ended = False
        while time.monotonic() - begun < SOON_S + 5:
            try:
                part = s.recv(65536)
            except TimeoutError:
                break
            if not part:
                ended = True
                break
            said += part
            if said.startswith(b"HTTP/1.1 100"):
                break  # go on: now the body would be sent
        took = time.monotonic() - begun
    if not said:
        return None, {}, b"", took, ended
    lines, _, body = said.partition(b"\r\n\r\n")
    first, *rest = lines.decode().split("\r\n")
    return int(first.split()[1]), dict(line.split(": ", 1) for line in rest), body, took, ended


def test_who_may_not_is_refused_before_his_body_is_sent(gateway):
    who = clients(gateway)
    asked, refused = 0, set()
    for o in API.operations:
        if not o.request_media:
            continue
        for role in ("none", "viewer", "operator", "engineer"):
            if ROLES.index(role) >= ROLES.index(role_of(o)):
                continue
            lengths = (900_000, None) if role in ("none", "viewer") else (900_000,)
            for length in lengths:
                status, headers, body, took, ended = announce(gateway, o, who[role], length)
                what = f"{o.id} as {role}, {length} bytes announced: {status} {body[:200]!r} after {took:.1f} s"
                assert status == (401 if role == "none" else 403), what
                assert took < SOON_S and ended and headers["Connection"] == "close", what
                assert headers["Content-Type"] == "application/problem+json" and json.loads(body)["reason"] == ("sign_in" if role == "none" else "role"), what
                asked += 1
                refused.add((o.id, role))
    takers = [o for o in API.operations if o.request_media]
    assert len(takers) > 40 and asked > 100, (len(takers), asked)
    assert {o.id for o in takers if role_of(o) != "none"} == {name for name, role in refused if role == "none"}, "every operation with a body but the sign-in refuses who is nobody"
    assert ("putBackup", "engineer") in refused and ("putBackup", "viewer") in refused


def test_too_much_is_refused_before_it_is_sent(gateway):
    admin = clients(gateway)["administrator"]
    for o in API.operations:
        if not o.request_media:
            continue
        most = 64 * 1024 * 1024 if o.id == "putBackup" else 1024 * 1024
        status, headers, body, took, ended = announce(gateway, o, admin, most + 1)
        assert status == 413 and took < SOON_S and ended, f"{o.id}: {status} {body[:200]!r} after {took:.1f} s"
        assert str(most) in json.loads(body)["detail"], body


def test_who_asks_first_is_told_no_instead_of_go_on(gateway):
    who = clients(gateway)
    o = next(x for x in API.operations if x.id == "putBackup")
    status, _, _, took, ended = announce(gateway, o, who["engineer"], 30, "Expect: 100-continue\r\n")
    assert status == 403 and took < SOON_S and ended, "small as it is: he asks, so he is told"
    status, _, _, _, _ = announce(gateway, o, who["administrator"], 30, "Expect: 100-continue\r\n")
    assert status == 100


def test_a_small_refused_body_keeps_the_connection(gateway):
    client = Client(gateway)
    client.more = clients(gateway)["viewer"]
    port = None
    for _ in range(3):
        status, _, body = client.request("PUT", "/api/v1/site", b'{"lines":[]}' + b" " * 5000)
        assert status == 403, body
        assert client.socket is not None, "the connection was closed"
        port = port or client.socket.getsockname()
        assert client.socket.getsockname() == port, "it was another connection"


def test_a_flood_of_a_viewer_ends_soon(gateway):
    """He does not wait for the answer but goes on sending: the gateway takes a bounded part of it, and the others are served meanwhile."""
    viewer = clients(gateway)["viewer"]
    head = {"Host": "127.0.0.1", "Content-Type": "application/octet-stream", "Content-Length": str(64 * 1024 * 1024), **viewer}
    sent, begun = 0, time.monotonic()
    with socket.create_connection((gateway.http[0], int(gateway.http[1])), timeout=10) as s:
        s.sendall(("PUT /api/v1/backup HTTP/1.1\r\n" + "".join(f"{k}: {v}\r\n" for k, v in head.items()) + "\r\n").encode())
        try:
            while sent < 64 * 1024 * 1024:
                s.sendall(b"x" * 65536)
                sent += 65536
        except OSError:
            pass
    assert sent < 32 * 1024 * 1024 and time.monotonic() - begun < 10, (sent, time.monotonic() - begun)
    assert gateway.request("GET", "/healthz")[0] == 200


# What the body or whose it is decides beyond the role stands in tests of its own (tests/unit/http/roles_test.cpp).
REFINED = {"commandAxis", "commandFleetAxis", "changePassword", "addToken", "removeToken", "signIn", "firstSignIn"}


def test_each_role_against_each_operation(gateway):
    """The description's roles are the program's: who is below is refused with the word for it, who is not is let in."""
    who = clients(gateway)
    checked = 0
    operations = sorted(API.operations, key=lambda o: o.id == "signOut")
    for o in operations:
        needed = ROLES.index(role_of(o))
        target = o.path
        for name in o.names():
            target = target.replace("{" + name + "}", "nothing-of-this-name")
        for level, role in enumerate(ROLES):
            client = Client(gateway, 20)
            client.more = who[role]
            headers = {"Content-Type": o.request_media[0]} if o.request_media else {}
            status, _, body = client.request(o.method, target, b"{}" if o.request_media else None, headers)
            client.close()
            what = f"{o.id} as {role}: {status} {body[:200]!r}"
            checked += 1
            if level < needed:
                assert status == (401 if role == "none" else 403), what
                said = json.loads(body)
                assert said["reason"] == ("sign_in" if role == "none" else "role") and ROLES[needed] in said["detail"], what
            elif o.id not in REFINED:
                assert status not in (401, 403), what
    assert checked == len(ROLES) * len(API.operations) > 500
