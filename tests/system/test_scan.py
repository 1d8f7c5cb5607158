"""Looking for drives on a line: a drive that nobody has configured is found, at its address, by what it says of itself.

In: the real program, a drive model of its own on a TCP port. Out: judgements on reports, the trace and the axis that goes on meanwhile.
"""
import socket

import harness
from harness import until


def scanned(g, line, body, seconds=40):
    g.send("POST", f"/lines/{line}/scan", body, 202)
    return until(lambda: (r := g.get(f"/lines/{line}/scan"))["state"] != "running" and r, seconds, "the end of the scan")


def test_an_unknown_drive_is_found_on_its_line(folder):
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{s.getsockname()[1]}"
    with harness.Process("twin", "uim342", "--line", f"tcp-listen:{address}", "--address", "9"):
        site = {"lines": [{"name": "bus", "uri": f"tcp:{address}", "family": "uim342"}], "drives": [], "axes": [], "mappings": []}
        with harness.Gateway(folder, site) as g:
            until(lambda: g.get("/lines/bus")["status"]["state"] == "up", 10, "the line")
            r = scanned(g, "bus", {"from": 7, "to": 11})
            assert r["state"] == "done" and r["asked"] == r["of"] == 5 and r["progress"] == 1, r
            assert [(f["address"], f["family"], f["known_as"]) for f in r["found"]] == [("9", "uim342", None)] and "UIM342" in r["found"][0]["text"], r
            g.send("POST", "/drives", {"name": "found", "line": "bus", "address": 9, "presence": "device"}, 201)
            g.send("POST", "/axes", {"name": "found", "drive": "found", "number": 1}, 201)
            until(lambda: g.axis("found")["online"], 10, "the drive")
            r = scanned(g, "bus", {"from": 9, "to": 10})
            assert r["of"] == 1 and [(f["address"], f["known_as"]) for f in r["found"]] == [("9", "found")], r


def test_an_axis_goes_on_while_its_line_is_searched(gateway):
    gateway.command("feeder", {"command": "enable"})
    gateway.command("feeder", {"command": "move_velocity", "velocity": 2, "acceleration": 100}, wait=0)
    gateway.send("POST", "/lines/can0/scan", {}, 202)
    gateway.send("POST", "/lines/can0/scan", {}, 409)
    ages = []

    def over():
        ages.append(gateway.axis()["age_ms"])
        return gateway.get("/lines/can0/scan")["state"] != "running"
    until(over, 60, "the end of the scan")
    r = gateway.get("/lines/can0/scan")
    assert r["state"] == "done" and r["of"] == 120 and {f["known_as"] for f in r["found"]} == {"feeder", "slide"}, r
    assert max(ages) < 1000 and gateway.axis()["moving"], max(ages)
    assert any(e["kind"] == "scan" and e["line"] == "can0" for e in gateway.get("/events?limit=50"))


def test_a_scan_is_cancelled_and_ends_when_the_site_changes(gateway):
    gateway.send("POST", "/lines/can0/scan", {}, 202)
    r = gateway.send("DELETE", "/lines/can0/scan", None)
    assert r["state"] == "cancelled" and r["asked"] < r["of"], r
    gateway.send("POST", "/lines/can0/scan", {}, 202)
    gateway.send("PATCH", "/axes/slide", {"unit": "cm"})
    r = gateway.get("/lines/can0/scan")
    assert r["state"] == "cancelled" and "site" in r["text"], r
    for wrong in ({"from": 4}, {"to": 127}, {"from": "x"}, {"from": 9, "to": 8}):
        gateway.send("POST", "/lines/can0/scan", wrong, 409)


def test_the_other_families_have_their_own_way(folder):
    site = {"lines": [{"name": "rs485", "uri": "twin", "family": "mcode", "bitrate": 115200}, {"name": "com1", "uri": "twin", "family": "pacontrol"}],
            "drives": [{"name": "lift", "line": "rs485", "address": "a", "presence": "twin"}, {"name": "portal", "line": "com1", "address": "com1", "presence": "twin"}],
            "axes": [{"name": "lift", "drive": "lift", "number": 1}, {"name": "x", "drive": "portal", "number": 2}], "mappings": []}
    with harness.Gateway(folder, site) as g:
        until(lambda: g.axis("lift")["online"] and g.axis("x")["online"], 15, "the drives")
        r = scanned(g, "rs485", {"from": "a", "to": "c"})
        assert r["of"] == 2 and [f["known_as"] for f in r["found"]] == ["lift"] and r["state"] == "done", r
        r = scanned(g, "com1", {})
        assert r["of"] == 0 and [f["known_as"] for f in r["found"]] == ["portal"] and r["state"] == "done", r
