"""The doors under people who mean no good, and under bad luck: kills in the middle of a revocation, half requests, names of other sites, a full disk.

In: the real program, as an outsider. Out: judgements. Every loop has a bound.
"""
import contextlib
import http.client
import json
import os
import pathlib
import resource
import signal
import socket
import stat
import subprocess
import threading
import time

import harness
from harness import DEMO, Gateway, Modbus, run, until

FIRST = "correct-horse-9"
KILLS = 25


def sign_in(g, user="anna", password=FIRST, path="/session", **more):
    s, body, head = g.request("POST", "/api/v1" + path, {"user": user, "password": password, **more})
    assert s == 200, (s, body)
    return {"Cookie": head["Set-Cookie"].split(";")[0], "X-CSRF-Token": body["csrf"]}


def ask(g, method, path, body=None, headers=None):
    s, answer, _ = g.request(method, "/api/v1" + path, body, headers)
    return s, answer


def raw(port, data, seconds=10.0, source=None):
    """What comes back for these bytes, up to the end of the connection."""
    with socket.create_connection(("127.0.0.1", port), timeout=seconds, source_address=source) as c:
        c.sendall(data)
        got = b""
        try:
            while part := c.recv(65536):
                got += part
        except (ConnectionResetError, socket.timeout):
            pass
        return got


# --- who may ---------------------------------------------------------------------------------------------------------

def test_a_name_that_is_not_listed_is_nobodys(folder):
    for bind in ("127.0.0.1:0", "0.0.0.0:0"):
        with Gateway(folder, DEMO, "--set", f"http.bind={bind}", "--set", "http.allowed_hosts=machine.example") as g:
            port = int(g.http[1])
            g.http = ["127.0.0.1", port]
            for host in ("evil.example", f"evil.example:{port}", "machine.example.evil.example"):
                s, body, _ = g.request("GET", "/api/v1/axes", headers={"Host": host})
                assert s == 421 and body["reason"] == "misdirected", (bind, host, s, body)
                s, body, _ = g.request("POST", "/api/v1/axes/feeder/commands", {"command": "enable"}, {"Host": host})
                assert s == 421, (bind, host, s, body)
            for host in ("localhost", f"127.0.0.1:{port}", "machine.example", f"MACHINE.example:{port}"):
                assert g.request("GET", "/api/v1/axes", headers={"Host": host})[0] == 200, (bind, host)
            assert g.request("GET", "/api/v1/axes", headers={"Host": "192.0.2.7"})[0] == 401, "an address that leads here through something else is not this machine"
            assert g.request("GET", "/api/v1/axes", headers={"X-Forwarded-For": "192.0.2.7"})[0] == 401
            assert g.stop() == 0


def test_check_warns_of_a_door_without_names():
    code, _, errors = run("check", "--set", "http.bind=0.0.0.0:8080")
    assert code == 0 and "warning: http.allowed_hosts" in errors, (code, errors)
    code, _, errors = run("check", "--set", "http.bind=0.0.0.0:8080", "--set", "http.allowed_hosts=machine.example")
    assert code == 0 and "http.allowed_hosts" not in errors and "http.tls_cert" in errors and "users.local_role" in errors, (code, errors)
    code, _, errors = run("check", "--set", "http.bind=0.0.0.0:8080", "--set", "http.allowed_hosts=machine.example", "--set", "http.tls=self_signed")
    assert code == 0 and errors == "", (code, errors)


def test_the_example_of_an_installed_gateway_is_good(folder):
    example = pathlib.Path(__file__).resolve().parents[2] / "deploy/examples/axisgate.toml"
    code, _, errors = run("check", "--config", str(example), "--set", "log.file=", "--set", f"data.dir={folder}")
    assert code == 0 and "axisgate: warning" not in errors, (code, errors)
    assert 'local_role = "none"' in example.read_text()


def test_a_lockout_is_of_one_address(folder):
    with Gateway(folder, None) as g:
        admin = sign_in(g, path="/session/first", code=g.code)
        assert ask(g, "POST", "/users", {"name": "ben", "password": FIRST, "role": "viewer"}, admin)[0] == 201
        text = json.dumps({"user": "anna", "password": "wrong"})
        wrong = (f"POST /api/v1/session HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\nContent-Type: application/json\r\nContent-Length: {len(text)}\r\n\r\n{text}").encode()
        # The pauses grow: 1, 2, 4 s. Where a password takes a second to be compared, the first of them are over before the next guess.
        answers = []
        while b"429" not in answers and len(answers) < 12:
            answers.append(raw(int(g.http[1]), wrong, source=("127.0.0.9", 0)).split()[1])
        assert answers[:3] == [b"401"] * 3 and answers[-1] == b"429", answers
        sign_in(g)
        for n in range(20):  # others behind her own address
            s, body = ask(g, "POST", "/session", {"user": f"guess{n}", "password": "wrong"})
            assert s in (401, 429), (s, body)
        assert ask(g, "POST", "/session", {"user": "ben", "password": FIRST})[0] == 429, "he was never let in from here"
        sign_in(g)
        g.stop()
    with Gateway(folder, None) as g:
        for n in range(20):
            ask(g, "POST", "/session", {"user": f"guess{n}", "password": "wrong"})
        assert ask(g, "POST", "/session", {"user": "ben", "password": FIRST})[0] == 429
        sign_in(g)


# --- what was revoked stays revoked ------------------------------------------------------------------------------------

def test_a_revocation_outlives_a_kill(folder):
    gateway = Gateway(folder, None)
    admin = sign_in(gateway, path="/session/first", code=gateway.code)
    for n in range(KILLS):
        with gateway as g:
            name = f"user{n}"
            assert ask(g, "POST", "/users", {"name": name, "password": FIRST, "role": "engineer"}, admin)[0] == 201
            tokens = [ask(g, "POST", "/tokens", {"name": f"t{n}-{i}", "role": "viewer"}, admin)[1]["token"] for i in range(3)]
            change = ({"enabled": False}, {"role": "viewer"}, None)[n % 3]
            begin = threading.Barrier(len(tokens) + 2)

            def use(token):
                begin.wait(20)
                with contextlib.suppress(OSError, http.client.HTTPException):  # killed in the middle
                    for _ in range(3):
                        ask(g, "GET", "/session", None, {"Authorization": "Bearer " + token})

            def come_in():
                begin.wait(20)
                with contextlib.suppress(OSError, http.client.HTTPException):
                    ask(g, "POST", "/session", {"user": name, "password": FIRST})

            threads = [threading.Thread(target=use, args=(t,)) for t in tokens] + [threading.Thread(target=come_in)]
            for t in threads:
                t.start()
            begin.wait(20)
            for t in tokens[:2]:
                assert ask(g, "DELETE", "/tokens/" + t.split(".")[0], None, admin)[0] == 204
            s, body = ask(g, "PATCH", "/users/" + name, change, admin) if change else ask(g, "DELETE", "/users/" + name, None, admin)
            assert s in (200, 204), (s, body)
            if n % 2:
                for t in threads:
                    t.join(20)
            g.process.send_signal(signal.SIGKILL)
            g.process.wait(10)
            for t in threads:
                t.join(20)
        gateway = Gateway(folder, None)
        admin = sign_in(gateway)
        for t in tokens[:2]:
            assert ask(gateway, "GET", "/axes", None, {"Authorization": "Bearer " + t})[0] == 401, f"kill {n}: a removed token is back"
        assert ask(gateway, "GET", "/axes", None, {"Authorization": "Bearer " + tokens[2]})[0] == 200, f"kill {n}"
        assert ask(gateway, "DELETE", "/tokens/" + tokens[2].split(".")[0], None, admin)[0] == 204
        users = {u["name"]: u for u in ask(gateway, "GET", "/users", None, admin)[1]}
        if change is None:
            assert name not in users, f"kill {n}: a removed user is back"
        else:
            assert all(users[name][k] == v for k, v in change.items()), f"kill {n}: {users[name]}"
            assert ask(gateway, "DELETE", "/users/" + name, None, admin)[0] == 204
    with gateway as g:
        assert g.stop() == 0


# --- who holds the door shut -------------------------------------------------------------------------------------------

def test_half_requests_do_not_shut_http(folder):
    with Gateway(folder, DEMO, "--set", "limits.http_connections=32") as g:
        port = int(g.http[1])
        path = socket.create_connection(("127.0.0.1", port), timeout=10)
        stop = b'{"command":"quick_stop"}'
        order = b"POST /api/v1/axes/feeder/commands HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: %d\r\n\r\n%s" % (len(stop), stop)
        path.sendall(order)
        assert path.recv(4096).startswith(b"HTTP/1.1 200")
        halves = []
        for n in range(200):
            c = socket.create_connection(("127.0.0.1", port), timeout=10)
            c.sendall((b"GET /healthz HTTP/1.1\r\nHost: lo", b"POST /api/v1/session HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 99\r\n\r\n{", b"")[n % 3])
            halves.append(c)
        assert g.request("GET", "/healthz")[0] == 200
        assert g.command("feeder", {"command": "quick_stop"}, wait=0)["result"] in ("accepted", "done")
        path.sendall(order)
        assert path.recv(4096).startswith(b"HTTP/1.1 200"), "the open path of a stop stays open"
        metrics = g.request("GET", "/metrics")[1].decode()
        assert "axisgate_http_connections_refused_total 0\n" in metrics
        for c in [path, *halves]:
            c.close()


def test_many_connections_do_not_shut_modbus(folder):
    with Gateway(folder, DEMO, "--set", "modbus.max_connections=64") as g:
        with g.modbus() as plc:
            plc.write1(32, 6)
            flood = []
            for n in range(200):
                c = socket.create_connection(("127.0.0.1", g.modbus_port), timeout=10, source_address=("127.0.0.9", 0))
                # a whole request and half of the next, half a request, or nothing
                c.sendall((b"\0\1\0\0\0\6\1\3\0\0\0\1\0\2\0", b"\0\1\0\0", b"")[n % 3])
                flood.append(c)
            time.sleep(0.2)  # longer than a client that has just asked is spared
            with Modbus(g.modbus_port) as another:
                assert another.read(15, 1)
            assert plc.read(15, 1), "who has commanded keeps its place"
        with Modbus(g.modbus_port) as plc:
            assert plc.read(15, 1), "and finds one when it comes back"
        for c in flood:
            c.close()


def test_a_fault_list_is_short(gateway):
    port = int(gateway.http[1])
    body = "{" + ",".join(f'"x{i}":1' for i in range(130_000)) + "}"
    head = "POST {} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n{}Content-Type: application/json\r\nContent-Length: {}\r\n\r\n"
    answer = raw(port, (head.format("/api/v1/session", "X-Forwarded-For: 192.0.2.1\r\n", len(body)) + body[:100]).encode())
    assert answer.startswith(b"HTTP/1.1 413"), answer[:200]
    body = "{" + ",".join(f'"x{i}":1' for i in range(500)) + "}"
    for path in ("/session", "/session/first", "/alarms/acknowledge", "/moves/start", "/site/stage/apply"):
        s, problem, _ = gateway.request("POST", "/api/v1" + path, body, {"Content-Type": "application/json"})
        assert s == 422, (path, s, problem)
        assert len(problem["faults"]) <= 20 and problem["more_faults"] >= 480, (path, len(problem["faults"]), problem["more_faults"])
    s, problem, _ = gateway.request("POST", "/api/v1/alarms/acknowledge", json.dumps({"x" * 500_000: 1}), {"Content-Type": "application/json"})
    assert s == 422 and len(json.dumps(problem)) < 20_000, (s, len(json.dumps(problem)))


def test_every_body_has_one_length(gateway):
    port = int(gateway.http[1])
    inner = "GET /api/v1/about HTTP/1.1\r\nHost: localhost\r\n\r\n"
    begin = "POST /api/v1/moves/start HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
    for fields, status in ((f"Transfer-Encoding: identity\r\nContent-Length: {len(inner)}\r\n", 400), (f"Content-Length: {len(inner)}\r\nTransfer-Encoding: identity\r\n", 400),
                           (f"Content-Length: {len(inner)}\r\nTransfer-Encoding: chunked\r\n", 400), ("Transfer-Encoding: xchunked\r\n", 501), ("Transfer-Encoding: gzip, chunked\r\n", 501),
                           ("Transfer-Encoding: chunked\r\nTransfer-Encoding: identity\r\n", 400), ("Transfer-Encoding:\r\n chunked\r\n", 400), ("Transfer-Encoding : chunked\r\n", 400),
                           (f"Content-Length: {len(inner)}\r\nContent-Length: {len(inner)}\r\n", 400)):
        answer = raw(port, (begin + fields + "\r\n" + inner).encode())
        assert answer.startswith(b"HTTP/1.1 %d " % status), (fields, answer[:80])
        assert answer.count(b"HTTP/1.1") == 1, ("a second request was read", fields, answer)


# --- the machine's files ---------------------------------------------------------------------------------------------

def test_a_line_of_a_site_replaces_no_link_of_others(folder):
    (folder / "precious").write_text("precious")
    os.symlink(folder / "precious", folder / "link")
    (folder / "lines").mkdir()
    with Gateway(folder, {"lines": [], "drives": [], "axes": [], "mappings": []}, "--set", f"lines.pty_dir={folder / 'lines'}") as g:
        for name, path in (("a", folder / "link"), ("b", folder / "else"), ("c", folder / "data" / "x"), ("d", "/etc/axisgate-test")):
            g.send("POST", "/lines", {"name": name, "uri": f"pty:{path}", "family": "mcode"}, 201)
        g.send("POST", "/lines", {"name": "e", "uri": f"pty:{folder / 'lines' / 'port'}", "family": "mcode"}, 201)
        until(lambda: (folder / "lines" / "port").is_symlink(), what="the link that is allowed")
        for name in "abcd":
            line = until(lambda n=name: (lambda x: x if x["status"]["state"] == "down" and x["status"]["text"] else None)(g.get("/lines/" + n)), what=f"line {name} says why it is down")
            assert "pty_dir" in line["status"]["text"] or "data directory" in line["status"]["text"], line
        assert os.readlink(folder / "link") == str(folder / "precious") and (folder / "precious").read_text() == "precious"
        assert not (folder / "else").is_symlink() and not pathlib.Path("/etc/axisgate-test").is_symlink()
        assert g.stop() == 0


def test_what_is_laid_down_is_for_the_gateway_alone(folder):
    with Gateway(folder, DEMO) as g:
        admin = sign_in(g, path="/session/first", code=g.code)
        s, backup, _ = g.request("GET", "/api/v1/backup", headers=admin)
        assert s == 200
        old = os.umask(0)
        try:
            s, body, _ = g.request("PUT", "/api/v1/backup", backup, {**admin, "Content-Type": "application/octet-stream"})
        finally:
            os.umask(old)
        assert s == 202, (s, body)
        for name in ("restore-at-start.db", "restore-at-start.json"):
            mode = stat.S_IMODE((folder / "data" / name).stat().st_mode)
            assert mode & 0o077 == 0, (name, oct(mode))
        assert g.request("DELETE", "/api/v1/backup/pending", headers=admin)[0] == 204
        g.process.kill()
        g.process.wait(10)
    data = folder / "data"
    left = [data / n for n in ("backup-for-download.tmp", "backup-for-download.tmp.77-1.part", "backup-for-download.tmp.77-1.part-journal", "restore-at-start.part")]
    for file in left:
        file.write_bytes(b"half a backup")
    (data / "restore-check").mkdir()
    (data / "restore-check" / "axisgate.db").write_bytes(b"half a backup")
    (data / "my-own-backup.db").write_bytes(b"kept")
    with Gateway(folder, None) as g:
        assert not [f for f in [*left, data / "restore-check"] if f.exists()]
        assert (data / "my-own-backup.db").exists()
        assert g.stop() == 0


def test_a_full_disk_is_507_everywhere(folder):
    site = json.loads(json.dumps(DEMO))
    with Gateway(folder, site) as g:
        admin = sign_in(g, path="/session/first", code=g.code)
        g.send("PUT", "/recipes/there", {"steps": [{"wait_s": 1}]}, 201)
        g.send("POST", "/axes/feeder/snapshots", {"name": "there", "from": "stored"}, 201)
        s, backup, _ = g.request("GET", "/api/v1/backup", headers=admin)
        staged = {**site, "mappings": []}
        pid = g.process.pid
        resource.prlimit(pid, resource.RLIMIT_FSIZE, (1024, resource.RLIM_INFINITY))  # no file may grow beyond 1 KiB
        octets, csv = {**admin, "Content-Type": "application/octet-stream"}, {**admin, "Content-Type": "text/csv"}
        entry = {"id": "m2", "unit": 3, "table": "holding_registers", "address": 0, "axis": "feeder", "point": "position", "type": "i32"}
        for method, path, body, headers in (
                ("PUT", "/site", staged, admin), ("POST", "/lines", {"name": "x", "uri": "twin", "family": "uim342"}, admin), ("PATCH", "/axes/feeder", {"unit": "cm"}, admin),
                ("DELETE", "/mappings/m1", None, admin), ("POST", "/mappings", entry, admin), ("PUT", "/mappings.csv", "id,unit,table,address,axis,point,type\n", csv),
                ("POST", "/users", {"name": "ben", "password": FIRST, "role": "viewer"}, admin),
                ("POST", "/tokens", {"name": "t", "role": "viewer"}, admin), ("PATCH", "/users/anna", {"password": FIRST + "0"}, admin),
                ("PUT", "/recipes/new", {"steps": [{"wait_s": 1}]}, admin), ("DELETE", "/recipes/there", None, admin), ("POST", "/axes/feeder/snapshots", {"name": "n", "from": "stored"}, admin),
                ("DELETE", "/axes/feeder/snapshots/1", None, admin), ("PUT", "/axes/feeder/parameters/AC", {"value": 20000}, admin), ("PATCH", "/modbus", {"read_only": True}, admin),
                ("PUT", "/backup", backup, octets), ("GET", "/backup", None, admin)):
            s, answer, _ = g.request(method, "/api/v1" + path, body, headers)
            assert s == 507, (method, path, s, answer if s != 200 else "...")
            assert answer["reason"] == "not_stored" and answer["detail"], (method, path, answer)
        assert ask(g, "POST", "/site/stage", staged, admin)[0] == 200
        for within in (60, 0):
            s, answer = ask(g, "POST", "/site/stage/apply", {"confirm_within_s": within}, admin)
            assert s == 507, ("apply", within, s, answer)
        assert g.get("/modbus")["read_only"] is False and g.get("/mappings/m1")["unit"] == 2, "what is not stored is not in force"
        resource.prlimit(pid, resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        assert ask(g, "PATCH", "/modbus", {"read_only": True}, admin)[0] == 200, "and all is well again when there is room"
        assert g.stop() == 0


# --- begin and end ---------------------------------------------------------------------------------------------------

def test_the_code_is_used_up_by_a_start_that_came_to_ready(folder):
    # A door that no waiting mends: without its certificates DDS is not opened. (A port that is taken is waited for: test_late_doors.)
    (folder / "no-certificates").mkdir()
    dds = ("--set", "dds.enabled=true", "--set", "dds.domain=77", "--set", f"dds.security={folder}/no-certificates")
    code, out, errors = run("serve", "--data", str(folder / "data"), "--set", "http.bind=127.0.0.1:0", "--set", "modbus.bind=127.0.0.1:0", *dds)
    assert code == 1 and "first sign-in" not in out and "identity-ca.pem" in errors, (code, out, errors)
    # Killed between the code and `ready`: a far end whose listen queue is full answers no connection, and holds `ready` back.
    mute = socket.create_server(("127.0.0.1", 0), backlog=0)
    queue = [socket.socket() for _ in range(4)]
    for s in queue:
        s.setblocking(False)
        s.connect_ex(mute.getsockname())
    time.sleep(0.1)
    site = {"lines": [{"name": "far", "uri": f"tcp:127.0.0.1:{mute.getsockname()[1]}", "family": "mcode"}], "drives": [{"name": "d", "line": "far", "address": "a", "presence": "device"}],
            "axes": [{"name": "x", "drive": "d", "channel": 1, "number": 1, "unit": "mm", "increments_per_unit": 1}], "mappings": []}
    (folder / "site.json").write_text(json.dumps(site))
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    p = subprocess.Popen([harness.PROGRAM, "serve", "--data", str(folder / "data"), "--site", str(folder / "site.json"), "--set", f"http.bind=127.0.0.1:{port}", "--set", "modbus.bind=off"],
                         stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
    try:
        os.set_blocking(p.stdout.fileno(), False)
        said = ""

        def answers():
            nonlocal said
            try:
                socket.create_connection(("127.0.0.1", port), timeout=1).close()
                return raw(port, b"GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n").startswith(b"HTTP/1.1 200")
            except OSError:
                return False
        until(answers, what="HTTP answers")
        said = p.stdout.read() or ""
        assert "first sign-in: code " in said, "printed before HTTP answers"
        lost = said.split("first sign-in: code ")[1].split()[0]
        assert "ready" not in said
    finally:
        p.kill()
        p.wait()
        p.stdout.close()
        for s in [*queue, mute]:
            s.close()
    with Gateway(folder, DEMO) as g:
        assert g.code and g.code != lost, "shown again: the start before never came to ready"
        code = g.code
        g.process.kill()
        g.process.wait(10)
    with Gateway(folder, None) as g:
        assert g.code == "", "used up"
        g.code = code
        sign_in(g, path="/session/first", code=code)


def test_sigterm_under_requests_ends_within_a_second(folder):
    with Gateway(folder, DEMO) as g:
        port = int(g.http[1])
        g.send("PATCH", "/drives/slide/hand", {"silent": True})  # whoever asks it something waits
        clients = []
        for method, path, body in (("POST", "/axes/slide/commands?wait=60", json.dumps({"command": "home"})),
                                   ("GET", "/axes/slide/parameters/AC", ""), ("POST", "/axes/slide/snapshots", json.dumps({"name": "n"}))):
            c = socket.create_connection(("127.0.0.1", port), timeout=10)
            c.sendall((f"{method} /api/v1{path} HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: {len(body)}\r\n\r\n{body}").encode())
            clients.append(c)
        for half in (b"GET /", b"POST /api/v1/moves/start HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 100\r\n\r\n{", b"GET /api/v1/openapi.yaml HTTP/1.1\r\nHost: localhost\r\n\r\n" * 50):  # noqa: E501
            c = socket.create_connection(("127.0.0.1", port), timeout=10)
            c.sendall(half)
            clients.append(c)
        feed = socket.create_connection(("127.0.0.1", port), timeout=10)
        feed.sendall(b"GET /api/v1/stream HTTP/1.1\r\nHost: localhost\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n")
        assert feed.recv(4096).startswith(b"HTTP/1.1 101")
        begun = time.monotonic()
        assert g.stop() == 0
        took = time.monotonic() - begun
        assert took < 1.0 + slowness(), f"{took:.2f} s"
        for c in [feed, *clients]:
            c.close()


def slowness():
    """What a busy machine may add: 20 times as long as a process takes here that does nothing (some milliseconds where nothing else runs)."""
    begun = time.monotonic()
    run("version", check=0)
    return 20 * max(0.0, time.monotonic() - begun - 0.02)


def test_a_second_confirmation_is_a_conflict(gateway):
    site = gateway.get("/site")
    site["axes"][0]["unit"] = "cm"
    gateway.send("POST", "/site/stage", site)
    gateway.send("POST", "/site/stage/apply", {"confirm_within_s": 60})
    port = int(gateway.http[1])
    one = b"POST /api/v1/site/stage/confirm HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n\r\n"
    answers = raw(port, one + one + one.replace(b"\r\n\r\n", b"\r\nConnection: close\r\n\r\n")).split(b"HTTP/1.1 ")[1:]
    assert [a[:3] for a in answers] == [b"200", b"409", b"409"], answers
    both = [None, None]
    gateway.send("POST", "/site/stage", {**site, "mappings": []})
    gateway.send("POST", "/site/stage/apply", {"confirm_within_s": 60})
    begin = threading.Barrier(2)

    def confirm(i):
        begin.wait(10)
        both[i] = gateway.request("POST", "/api/v1/site/stage/confirm")[0]
    threads = [threading.Thread(target=confirm, args=(i,)) for i in range(2)]
    for t in threads:
        t.start()
    for t in threads:
        t.join(20)
    assert sorted(both) == [200, 409], both


def test_a_snapshot_of_an_axis_that_was_removed_is_404(gateway):
    gateway.send("DELETE", "/mappings/m1", None, 204)
    answer = [None]

    def take():
        answer[0] = gateway.request("POST", "/api/v1/axes/feeder/snapshots", {"name": "late"})[:2]
    thread = threading.Thread(target=take)
    thread.start()
    until(lambda: gateway.get("/axes/feeder/snapshot-progress")["state"] == "running" or answer[0], what="the drive is read")
    gateway.send("DELETE", "/axes/feeder", None, 204)
    thread.join(30)
    assert answer[0] and answer[0][0] in (404, 201, 202), answer  # 202: read for longer than the request waits
    for path in ("", "/1", "/1/diff?with=device"):
        assert ask(gateway, "GET", "/axes/feeder/snapshots" + path)[0] == 404, path
    drives = gateway.get("/drives/feeder")
    gateway.send("POST", "/axes", {"name": "feeder", "drive": drives["name"], "channel": 1, "number": 1, "unit": "mm", "increments_per_unit": 3200}, 201)
    assert len(gateway.get("/axes/feeder/snapshots")) == (1 if answer[0][0] == 201 else 0), "none was kept that nobody was told of"
