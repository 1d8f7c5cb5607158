"""The audit: each operation of the description that changes something leaves an event with who did it; so do refusals, within a rate, at every door.

In: the real program, one administrator and strangers. Out: events. A new operation that is in no row of the table fails.
"""
import json
import random
import socket
import struct
import time

from harness import DEMO, Folder, Gateway, ModbusException, until
from test_enip import Originator
from test_openapi import API, EDS, RECIPE, Client, operation, quoted

LINE = {"name": "spare", "uri": "twin", "family": "uim342", "bitrate": 500000}
DRIVE = {"name": "spare", "line": "spare", "address": 9, "presence": "twin"}
AXIS = {"name": "spare", "drive": "spare", "number": 9, "unit": "deg", "increments_per_unit": 10}
MOVE = {"command": "move_absolute", "position": 2, "velocity": 20, "acceleration": 50, "deceleration": 50}
PASSWORD = "a-long-sentence-1"
# What is asked, in this order: operation, names of its path, body, the answer, the event's kind and words of its text or its other members.
# A body that is a function gets what the steps before have left: `number` of an alarm or a token, `site`, `backup`, `connection`.
TABLE = [
    ("addLine", {}, LINE, 201, "site", "spare"),
    ("addDrive", {}, DRIVE, 201, "site", "spare"),
    ("addAxis", {}, AXIS, 201, "site", "spare"),
    ("changeLine", {"line": "spare"}, {"bitrate": 250000}, 200, "site", "spare"),
    ("replaceLine", {"line": "spare"}, LINE, 200, "site", "spare"),
    ("changeDrive", {"drive": "spare"}, {"options": {"model": "342S"}}, 200, "site", "spare"),
    ("replaceDrive", {"drive": "spare"}, DRIVE, 200, "site", "spare"),
    ("changeAxis", {"axis": "spare"}, {"unit": "mm"}, 200, "site", "spare"),
    ("replaceAxis", {"axis": "spare"}, AXIS, 200, "site", "spare"),
    ("removeAxis", {"axis": "spare"}, None, 204, "site", "spare"),
    ("removeDrive", {"drive": "spare"}, None, 204, "site", "spare"),
    ("removeLine", {"line": "spare"}, None, 204, "site", "spare"),
    ("startScan", {"line": "can0"}, {"from": 5, "to": 9, "limit_s": 30}, 202, "scan", "searched"),
    ("cancelScan", {"line": "can0"}, None, 200, "scan", "ended"),
    ("exchangeNative", {"drive": "feeder"}, {"send": "MS[1]"}, 200, "command", "MS[1]"),
    ("setHand", {"drive": "feeder"}, {"inputs": 1}, 200, "hand", "inputs"),
    ("changeHand", {"drive": "feeder"}, {"inputs": 0}, 200, "hand", "inputs"),
    ("takeAuthority", {"axis": "slide"}, {"ttl_s": 50}, 200, "authority", ""),
    ("handOverAuthority", {"axis": "slide"}, {"to": "http anna"}, 200, "authority", ""),
    ("releaseAuthority", {"axis": "slide"}, None, 204, "authority", ""),
    ("commandAxis", {"axis": "feeder"}, {"command": "enable"}, 200, "command", "enable"),
    ("commandAxis", {"axis": "feeder"}, {**MOVE, "prepare": True}, 200, "command", "move_absolute"),
    ("startMoves", {}, {"axes": ["feeder"]}, 200, "command", "start"),
    ("commandAxis", {"axis": "feeder"}, {"command": "quick_stop"}, 200, "command", "quick_stop"),
    ("commandAxis", {"axis": "feeder"}, {"command": "disable"}, 200, "command", "disable"),
    ("actOnAxis", {"axis": "feeder"}, "action", 200, "command", "action"),
    ("writeParameter", {"axis": "feeder", "parameter": "AC"}, {"value": 20000}, 200, "write", "AC"),
    ("importParameters", {"axis": "feeder"}, "parameter,value\nAC,21000\n", 200, "write", "21000"),
    ("takeSnapshot", {"axis": "feeder"}, {"name": "one", "from": "stored"}, 201, "snapshot", "one"),
    ("writeParameter", {"axis": "feeder", "parameter": "AC"}, {"value": 22000}, 200, "write", "22000"),
    ("restoreSnapshot", {"axis": "feeder", "snapshot": "1"}, {}, 200, "write", "21000"),
    ("removeSnapshot", {"axis": "feeder", "snapshot": "1"}, None, 204, "snapshot", "removed"),
    ("changeModbus", {}, {"read_only": True}, 200, "modbus", "read-only"),
    ("changeModbus", {}, {"read_only": False}, 200, "modbus", "writes again"),
    ("closeConnection", {"connection": "connection"}, None, 204, "connection", ""),
    ("addDescription", {}, {"name": "plain.eds", "text": EDS}, 201, "site", "plain.eds added"),
    ("removeDescription", {"description": "plain.eds"}, None, 204, "site", "plain.eds deleted"),
    ("putAxisFailSafe", {"axis": "slide"}, {"line_lost": "disable"}, 200, "site", ""),
    ("rehearseFailSafe", {}, {"axes": ["slide"]}, 202, "rehearsal", ""),
    ("addMapping", {}, {"id": "new", "unit": 2, "address": 20, "axis": "feeder", "point": "AC", "type": "u32"}, 201, "site", ""),
    ("replaceMapping", {"mapping": "new"}, {"unit": 2, "address": 30, "axis": "feeder", "point": "AC", "type": "f64", "scale": 0.5}, 200, "site", ""),
    ("removeMapping", {"mapping": "new"}, None, 204, "site", ""),
    ("addMappings", {}, "unit,address,axis,point\n3,0,feeder,position\n3,2,slide,position\n", 200, "site", ""),
    ("replaceMappings", {}, "unit;address;axis;point\r\n3;0;feeder;velocity\r\n", 200, "site", ""),
    ("changeMappingUnit", {"unit": "3"}, {"gaps": "refuse"}, 200, "site", ""),
    ("addMappingTemplate", {}, {"template": "standard_map", "axis": "feeder", "unit": 5, "address": 0}, 201, "site", ""),
    ("removeMappings", {"": "?unit=5"}, None, 200, "site", ""),
    ("putProfile", {"unit": "40"}, {"language": "lexium", "axes": [{"axis": "feeder"}]}, 200, "site", ""),
    ("putAssembly", {"instance": "300"}, {"direction": "input", "unit": 40, "registers": 20}, 200, "site", ""),
    ("addAssemblies", {}, "instance,direction,unit,registers\n301,input,40,20\n", 200, "site", ""),
    ("replaceAssemblies", {}, "instance;direction;unit;registers\r\n300;input;40;10\r\n", 200, "site", ""),
    ("removeAssembly", {"instance": "300"}, None, 204, "site", ""),
    ("removeProfile", {"unit": "40"}, None, 204, "site", ""),
    ("replaceSite", {}, "site", 200, "site", ""),
    ("putRecipe", {"recipe": "warm-up"}, RECIPE, 201, "recipe", "made"),
    ("runRecipe", {"recipe": "warm-up"}, {"arguments": {"pause": 30}}, 202, "recipe", "started"),
    ("cancelRecipeRun", {"recipe": "warm-up", "run": "1"}, None, 202, "recipe", "the end of recipe warm-up run 1"),
    ("rehearseRecipe", {"recipe": "warm-up"}, {"specimens": "1..1000"}, 202, "rehearsal", "recipe warm-up is rehearsed against 1000 specimens"),
    ("cancelRecipeRehearsal", {"recipe": "warm-up"}, None, 202, "rehearsal", "the rehearsal of recipe warm-up was ended"),
    ("removeRecipe", {"recipe": "warm-up"}, None, 204, "recipe", "deleted"),
    ("armCapture", {}, {"name": "wave", "axes": ["feeder"], "trigger": {"kind": "state", "state": "warning"}}, 201, "capture", "armed"),
    ("renameCapture", {"capture": "wave"}, {"name": "other"}, 200, "capture", "wave was renamed to other"),
    ("removeCapture", {"capture": "other"}, None, 204, "capture", "other was deleted"),
    ("makeRecording", {}, {"name": "crash", "why": "test"}, 201, "recording", "made"),
    ("renameRecording", {"recording": "crash"}, {"name": "other"}, 200, "recording", "crash was renamed to other"),
    ("removeRecording", {"recording": "other"}, None, 204, "recording", "other was deleted"),
    ("stageSite", {}, "site", 200, "site", "staged"),
    ("discardStage", {}, None, 204, "site", "discarded"),
    ("restoreSiteRevision", {"revision": "1"}, None, 200, "site", "revision 1 of the site was staged"),
    ("applyStage", {}, {"confirm_within_s": 60}, 200, "site", ""),
    ("confirmStage", {}, None, 200, "site", "confirmed"),
    ("stageSite", {}, "site", 200, "site", "staged"),
    ("applyStage", {}, {"confirm_within_s": 60}, 200, "site", ""),
    ("rollBackStage", {}, None, 200, "site", "rolled back"),
    ("putBackup", {}, "backup", 202, "site", "laid down"),
    ("cancelPendingBackup", {}, None, 204, "site", ""),
    ("shelveAlarm", {"alarm": "number"}, {"for_s": 60, "reason": "test"}, 200, "alarm", "shelved"),
    ("unshelveAlarm", {"alarm": "number"}, None, 200, "alarm", "taken back"),
    ("acknowledgeAlarm", {"alarm": "number"}, {"comment": "seen"}, 200, "alarm", "seen"),
    ("acknowledgeAlarms", {}, {"all": True, "comment": "all of them"}, 200, "alarm", "all of them"),
    ("commandFleetAxis", {"gateway": "hall", "axis": "slide"}, {"command": "halt"}, 200, "fleet", "halt was given to hall/slide"),
    ("addUser", {}, {"name": "ben", "password": PASSWORD, "role": "viewer"}, 201, "access", "ben"),
    ("changeUser", {"user": "ben"}, {"role": "operator"}, 200, "access", "ben"),
    ("removeUser", {"user": "ben"}, None, 204, "access", "ben"),
    ("addToken", {}, {"name": "line3", "role": "viewer", "expires_in_s": 60}, 201, "access", "line3"),
    ("removeToken", {"token": "token"}, None, 204, "access", ""),
    ("changePassword", {"user": "anna"}, {"old": "correct-horse-9", "new": "a-long-sentence-2"}, 204, "access", "anna"),
    ("signIn", {}, {"user": "anna", "password": "a-long-sentence-2"}, 200, "access", "anna"),
    ("signOut", {}, None, 204, "access", "anna"),
]
FIRST = "firstSignIn"  # of it the test's own sign-in is the proof
# Nothing changes by these: there is nothing to write down. A new one is named here with its reason, or has a row above.
CHANGE_NOTHING = {}
# These need a real drive: test_compare asserts their events.
WITH_A_REAL_DRIVE = {"compareWithTwin", "adoptComparison"}


def events(g, since, headers):
    s, body, _ = g.request("GET", f"/api/v1/events?since={since}&limit=1000&order=oldest", None, headers)
    assert s == 200, body
    return body


def last_event(g, headers):
    s, body, _ = g.request("GET", "/api/v1/events?limit=1", None, headers)
    return body[0]["id"] if body else 0


def words_in(event, words):
    return all(w in json.dumps(event) for w in words.split("|"))


def test_every_operation_that_changes_something_has_a_row():
    changing = {o.id for o in API.operations if o.method not in ("GET", "HEAD", "OPTIONS")}
    known = {row[0] for row in TABLE} | {FIRST} | set(CHANGE_NOTHING) | WITH_A_REAL_DRIVE
    assert changing == known, f"without a row: {changing - known}; rows without an operation: {known - changing}"


def make_an_alarm(client, g):
    """A fault that is made and mended: its alarm is cleared and waits to be acknowledged."""
    def send(path, body, method="POST"):
        status, _, data = client.request(method, "/api/v1" + path, json.dumps(body).encode())
        assert status == 200, (path, data)
    if g.axis("feeder")["fault"]:
        send("/axes/feeder/commands?wait=20", {"command": "reset_fault"})
    send("/axes/feeder/commands?wait=20", {"command": "enable"})
    send("/axes/feeder/commands", {"command": "move_velocity", "velocity": 1, "acceleration": 20})
    send("/drives/feeder/hand", {"stall": True}, "PATCH")
    until(lambda: g.axis("feeder")["fault"], 10, "fault")
    send("/drives/feeder/hand", {"stall": False}, "PATCH")
    return until(lambda: [a["id"] for a in g.get("/alarms")["alarms"] if a["kind"] == "fault" and a["state"].startswith("unacknowledged")], 10, "an alarm")[0]


def test_each_of_them_leaves_an_event_with_who_did_it(folder):
    with Gateway(folder, DEMO, "--set", "dds.enabled=true", "--set", f"dds.domain={random.randint(100, 200)}", "--set", "dds.name=hall") as g:
        client = Client(g, 40).sign_in(g)
        assert until(lambda: [e for e in events(g, 0, None) if e["kind"] == "access" and "anna" in json.dumps(e)], 5, "of the first sign-in")
        left = {"site": None, "backup": client.request("GET", "/api/v1/backup")[2]}
        without = []
        for name, names, body, status, kind, words in TABLE:
            o = operation(name)
            if ("number" in names.values() and "number" not in left) or name == "acknowledgeAlarms":
                left["number"] = str(make_an_alarm(client, g))
            if body == "action":
                body = {"name": next(c["id"] for c in g.get("/families/uim342/commands") if not c.get("arguments") and not c.get("motion", False))}
            if name == "closeConnection":
                host, port = g.word("enip").rsplit(":", 1)
                plc = socket.create_connection((host, int(port)), timeout=5)
                plc.sendall(struct.pack("<HHIIQIHH", 0x65, 4, 0, 0, 0, 0, 1, 0))
                plc.recv(100)
                left["connection"] = until(lambda: [c["id"] for c in g.get("/connections") if c["kind"] == "session"], 5, "a session")[0]
            if name == "removeToken":
                left["token"] = json.loads(client.request("GET", "/api/v1/tokens")[2])[0]["id"]
            if body == "site":
                site = json.loads(client.request("GET", "/api/v1/site")[2])
                site["axes"][1]["position_max"] = 51 if site["axes"][1]["position_max"] != 51 else 50
                body = site
            if body == "backup":
                body = left["backup"]
            target = o.path
            for k, v in names.items():
                target = target.replace("{" + k + "}", quoted(left.get(v, v))) if k else target + v
            if name in ("commandAxis", "startMoves") and not (isinstance(body, dict) and body.get("prepare")):
                target += "?wait=20"
            since = last_event(g, None)
            kinds = {bytes: "application/octet-stream", str: "text/csv"}

            def ask():
                if type(body) in kinds:
                    return client.request(o.method, target, body if isinstance(body, bytes) else body.encode(), {"Content-Type": kinds[type(body)]})
                return client.request(o.method, target, None if body is None else json.dumps(body).encode())
            answer = ask()
            if name in ("removeRecipe", "restoreSnapshot"):  # what was before needs a moment to end
                end = time.monotonic() + 10
                while answer[0] != status and time.monotonic() < end:
                    time.sleep(0.1)
                    answer = ask()
            assert answer[0] == status, f"{name} {names} {body}: {answer[0]} {answer[2][:300]!r}"
            if name == "signIn":
                client.more = {"Cookie": answer[1]["Set-Cookie"].split(";")[0], "X-CSRF-Token": json.loads(answer[2])["csrf"]}
            wanted = body["name"] if words == "action" else words
            try:
                until(lambda: [e for e in events(g, since, None) if e["kind"] == kind and e["who"].startswith("anna ")
                               and "127.0.0.1" in e["who"] and words_in(e, wanted)], 40 if kind == "rehearsal" else 8)
            except AssertionError:
                without.append((name, kind, wanted, [(e["kind"], e["who"], e["text"]) for e in events(g, since, None)]))
        assert not without, "\n".join(map(str, without))


def test_refusals_over_http_are_counted_and_written_down_within_a_rate(folder):
    with Gateway(folder, DEMO, "--set", "users.local_role=none") as g:
        client = Client(g).sign_in(g)
        headers = dict(client.more)
        stranger = {"X-Forwarded-For": "192.0.2.9"}
        for i in range(300):
            assert g.request("POST", f"/api/v1/axes/axis{i}/commands", {"command": "enable"}, stranger)[0] == 401
        assert client.request("POST", "/api/v1/site/stage/apply", b"{}")[0] == 409
        told = until(lambda: [e for e in events(g, 0, headers) if e["kind"] == "refused" and "409" in e["text"]], 5, "the conflict") and [e for e in events(g, 0, headers) if e["kind"] == "refused"]
        assert [e for e in told if "(409 conflict)" in e["text"] and "POST /api/v1/site/stage/apply" in e["text"] and e["who"].startswith("anna ")], told
        strangers = [e for e in told if "401" in e["text"]]
        assert 1 <= len(strangers) <= 3 and strangers[0]["who"].startswith("127.0.0.1:") and strangers[0]["door"] == "http", strangers
        assert "POST /api/v1/axes/axis0/commands" in strangers[0]["text"], strangers
        metrics = client.request("GET", "/metrics")[2].decode()
        assert 'axisgate_http_requests_total{route="/api/v1/axes/{axis}/commands",method="POST",status="401"} 300' in metrics
        assert "axisgate_http_refusals_counted_only_total 299" in metrics, [x for x in metrics.splitlines() if "refusals" in x]
        # A member without the role, by name.
        assert client.request("POST", "/api/v1/users", json.dumps({"name": "ben", "password": PASSWORD, "role": "viewer"}).encode())[0] == 201
        ben = Client(g)
        _, head, body = ben.request("POST", "/api/v1/session", json.dumps({"user": "ben", "password": PASSWORD}).encode())
        ben.more = {"Cookie": head["Set-Cookie"].split(";")[0], "X-CSRF-Token": json.loads(body)["csrf"]}
        assert ben.request("POST", "/api/v1/axes/feeder/commands", b'{"command":"enable"}')[0] == 403
        assert until(lambda: [e for e in events(g, 0, headers) if e["kind"] == "refused" and e["who"].startswith("ben ") and "(403 role)" in e["text"]], 5, "ben's refusal")


def test_writes_over_ethernet_ip_objects_are_written_down(folder):
    with Gateway(folder) as g:
        host, port = g.word("enip").rsplit(":", 1)
        with Originator(host, int(port), 0) as o:
            assert o.ask(0x10, bytes([0x20, 0x48, 0x24, 1, 0x30, 4]), b"\x10")[0] == 0, "QoS, a mark"
            assert o.ask(0x10, bytes([0x20, 0xF5, 0x24, 1, 0x30, 13]), b"\x3c\x00")[0] == 0, "TCP/IP interface, inactivity"
            told = until(lambda: [e for e in g.get("/events?limit=100") if e["kind"] == "ethernet_ip" and "was written" in e["text"]] or None, 5, "the writes")
            until(lambda: {"class 48h instance 1 attribute 4 was written", "class F5h instance 1 attribute 13 was written"} <= {e["text"] for e in g.get("/events?limit=100")}, 5, "both")
            assert all(e["who"].startswith("127.0.0.1:") and e["door"] == "ethernet_ip" for e in told), told
            # A parameter object, by one more than its greatest value.
            for i in range(1, 200):
                size, most = o.get(0x0F, i, 6)[0], int.from_bytes(o.get(0x0F, i, 11), "little", signed=True)
                if not o.get(0x0F, i, 4)[0] & 0x10 and size == 4 and 0 < most < 2 ** 30:
                    break
            assert o.ask(0x10, bytes([0x20, 0x0F, 0x24, i, 0x30, 1]), struct.pack("<i", most + 1))[0] == 0x09, (i, most)
            refused = until(lambda: [e for e in g.get("/events?limit=100") if e["kind"] == "refused" and f"parameter object {i}," in e["text"]], 5, "the refused parameter")
            assert refused[0]["who"].startswith("127.0.0.1:") and refused[0]["door"] == "ethernet_ip" and refused[0]["axis"] == "feeder", refused


def test_a_member_of_the_domain_is_named_with_the_place_that_it_writes_from(folder):
    domain = random.randint(100, 200)
    more = ("--set", "dds.enabled=true", "--set", f"dds.domain={domain}")
    with Folder() as other, Gateway(folder, DEMO, *more, "--set", "dds.name=hall-1") as a, Gateway(other, DEMO, *more, "--set", "dds.name=hall-2") as b:
        until(lambda: len(a.get("/fleet")["gateways"]) == 2, 15, "both")
        assert a.send("POST", "/fleet/hall-2/axes/feeder/commands?wait=10", {"command": "enable"})["result"] == "done"
        told = until(lambda: [e for e in b.get("/events?kind=command&limit=50") if e["door"] == "dds"], 5, "the command")[0]
        assert told["who"].startswith("hall-1 ") and "127.0.0.1" in told["who"] and f"process {a.process.pid}" in told["who"], told
        a.send("POST", "/fleet/hall-2/axes/feeder/commands?wait=10", {"command": "set_position", "position": 10 ** 15}, 422)


def test_a_refused_request_over_modbus_is_written_down(gateway):
    with gateway.modbus() as m:
        try:
            m.write(33, [77])
        except ModbusException:
            pass
    until(lambda: [e for e in gateway.get("/events?kind=refused&limit=10") if e["door"] == "modbus"], 5, "the refusal")
