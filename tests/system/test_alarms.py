"""Alarms on the real program: raised by a drive's fault, acknowledged, cleared; kept over a kill; shelved; events as files.

In: the real program with simulated drives. Out: judgements on /alarms, /events, and what is found after a kill.
"""
import datetime
import json
import os
import signal
import time

from harness import DEMO, Gateway, Process, until
from test_openapi import Client, check, operation


def alarms(g, **wanted):
    return [a for a in g.get("/alarms")["alarms"] if all(a[k] == v for k, v in wanted.items())]


def break_axis(g, axis="feeder"):
    """A stall while it moves: the drive itself reports its fault."""
    g.command(axis, {"command": "enable"})
    g.command(axis, {"command": "move_velocity", "velocity": 1, "acceleration": 20}, wait=0)
    g.send("PATCH", f"/drives/{axis}/hand", {"stall": True})
    until(lambda: g.axis(axis)["fault"], 10, "fault")
    return until(lambda: alarms(g, axis=axis, kind="fault"), 10, "alarm")[0]


def mend_axis(g, axis="feeder"):
    g.send("PATCH", f"/drives/{axis}/hand", {"stall": False})
    g.command(axis, {"command": "reset_fault"})
    until(lambda: not g.axis(axis)["fault"], 10, "no fault")


def post(g, path, body, wanted=200):
    o = {"acknowledge": "acknowledgeAlarm", "shelve": "shelveAlarm", "unshelve": "unshelveAlarm"}[path.split("/")[-1]] if path.count("/") > 2 else "acknowledgeAlarms"
    answer = Client(g, 10).request("POST", "/api/v1" + path, None if body is None else json.dumps(body).encode())
    assert check(operation(o), answer, path) == wanted, answer
    return json.loads(answer[2])


def test_an_alarm_is_raised_acknowledged_cleared(gateway):
    a = break_axis(gateway)
    assert a["state"] == "unacknowledged_active" and a["severity"] == "alarm" and a["drive"] == "feeder", a
    said = post(gateway, f"/alarms/{a['id']}/acknowledge", {"comment": "seen"})
    assert said["state"] == "acknowledged_active" and "127.0.0.1" in said["acknowledged_by"] and said["comment"] == "seen", said
    post(gateway, f"/alarms/{a['id']}/acknowledge", {}, 409)
    mend_axis(gateway)
    until(lambda: not alarms(gateway, id=a["id"]), 5, "off the list")
    until(lambda: any("acknowledged: seen" in e["text"] and "127.0.0.1" in e["who"] for e in gateway.get("/events?kind=alarm")), 5, "the event of the acknowledgement")
    # The other way round: cleared first.
    a = break_axis(gateway)
    mend_axis(gateway)
    until(lambda: alarms(gateway, id=a["id"], state="unacknowledged_cleared"), 5, "cleared")
    assert post(gateway, f"/alarms/{a['id']}/acknowledge", {})["state"] == "normal"
    post(gateway, "/alarms/acknowledge", {"all": True})
    assert gateway.get("/alarms")["unacknowledged"] == 0


def test_a_fault_by_the_hand_and_a_silent_drive_are_alarms(gateway):
    gateway.send("PATCH", "/drives/slide/hand", {"inject_error": 0x1D})
    a = until(lambda: alarms(gateway, axis="slide"), 10, "the alarm of the injected error")[0]
    assert a["severity"] == "alarm", a
    gateway.send("PATCH", "/drives/slide/hand", {"inject_error": 0, "silent": True})
    a = until(lambda: alarms(gateway, drive="slide", kind="drive"), 10, "silent")[0]
    assert a["state"] == "unacknowledged_active" and "silent" in a["text"], a
    gateway.send("PATCH", "/drives/slide/hand", {"silent": False})
    until(lambda: alarms(gateway, id=a["id"], state="unacknowledged_cleared"), 20, "it answers")


def test_acknowledged_and_shelved_survive_a_kill(folder):
    with Gateway(folder, DEMO) as g:
        one, two = break_axis(g), break_axis(g, "slide")
        post(g, f"/alarms/{one['id']}/acknowledge", {"comment": "seen"})
        post(g, f"/alarms/{two['id']}/shelve", {"for_s": 600, "reason": "sensor"})
        post(g, f"/alarms/{two['id']}/shelve", {"for_s": 1, "reason": "x"}, 422)
        os.kill(g.process.pid, signal.SIGKILL)
        g.process.wait()
    with Gateway(folder, None) as g:
        kept = {a["id"]: a for a in g.get("/alarms")["alarms"]}
        assert kept[one["id"]]["state"] == "acknowledged_active" and kept[one["id"]]["comment"] == "seen", kept
        assert kept[two["id"]]["state"] == "shelved" and kept[two["id"]]["reason"] == "sensor" and kept[two["id"]]["shelved_until"] > two["since"], kept
        # The fresh twin has no fault: what does not show again is over, and what was acknowledged leaves the list.
        until(lambda: not alarms(g, id=one["id"]), 15, "the fault that is no more")
        assert post(g, f"/alarms/{two['id']}/unshelve", None)["state"] == "unacknowledged_cleared"
        assert max(e["id"] for e in g.get("/events")) > two["id"]


def test_events_as_files(gateway):
    status, data, headers = gateway.request("GET", "/api/v1/events?format=csv&limit=5")
    text = data if isinstance(data, str) else data.decode()
    assert status == 200 and headers["Content-Type"].startswith("text/csv") and text.startswith("id,at,severity,kind"), (status, headers)
    ids = [e["id"] for e in gateway.get("/events?limit=1000")]
    assert [e["id"] for e in gateway.get(f"/events?before={ids[-1]}&limit=2")] == ids[-3:-1]
    assert {e["kind"] for e in gateway.get("/events?kind=presence")} == {"presence"}


def test_alarms_are_raised_and_kept_without_any_http(folder):
    site = {"lines": [{"name": "l", "uri": "tcp:127.0.0.1:9", "family": "uim342"}],
            "drives": [{"name": "d", "line": "l", "address": 5, "presence": "device"}],
            "axes": [{"name": "x", "drive": "d", "number": 1}], "mappings": []}
    (folder / "site.json").write_text(json.dumps(site))
    with Process("serve", "--data", str(folder / "data"), "--set", "http.bind=", "--set", "modbus.bind=127.0.0.1:0", "--site", str(folder / "site.json")) as p:
        assert "http=" not in p.ready and "modbus=" in p.ready, p.ready
        time.sleep(1.5)  # the line cannot be opened; what that raises is on the disk
        assert p.stop() == 0
    begun = time.time()
    with Gateway(folder, None) as g:
        kept = [a for a in g.get("/alarms")["alarms"] if datetime.datetime.fromisoformat(a["since"].replace("Z", "+00:00")).timestamp() < begun]
        assert kept and kept[0]["line"] == "l", g.get("/alarms")
