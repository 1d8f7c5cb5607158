"""What the gateway remembers of an axis, on the real program: whose values are shown as live, and what follows a name, a family, a removal and a roll back."""
import os
import signal

import harness
from harness import until

SITE = {
    "lines": [{"name": "can0", "uri": "twin", "family": "uim342", "bitrate": 1000000}, {"name": "com1", "uri": "twin", "family": "mcode"}],
    "drives": [{"name": "one", "line": "can0", "address": 5}, {"name": "two", "line": "can0", "address": 6}, {"name": "m", "line": "com1", "address": "!"}],
    "axes": [{"name": "x", "drive": "one", "number": 1}],
    "mappings": [],
}


def online(g, axis="x"):
    until(lambda: g.axis(axis)["online"], 10, f"{axis} is there")


def cached(g, parameter, axis="x"):
    return g.get(f"/axes/{axis}/parameters/{parameter}?cached=1")


def known(g, axis="x"):
    return {p["id"] for p in g.get(f"/axes/{axis}/parameters") if p["value"] is not None}


def write(g, value, parameter="AC", axis="x"):
    g.send("PUT", f"/axes/{axis}/parameters/{parameter}", {"value": value})


def test_what_the_drive_before_said_is_not_the_word_of_the_next(folder):
    with harness.Gateway(folder, SITE) as g:
        online(g)
        write(g, 23456)
        g.send("POST", "/axes/x/snapshots", {"name": "of drive one"}, 201)
        assert len(known(g)) > 60 and cached(g, "AC")["quality"] == "good"
        g.send("PATCH", "/axes/x", {"drive": "two"})
        now = cached(g, "AC")
        assert now["stored"] == 23456 and now["value"] != 23456, now
        assert (now["quality"] == "unknown") == (now["value"] is None), now  # the new drive may have told its own already
        online(g)
        assert cached(g, "PP%5B7%5D")["value"] in (None, 6), "what it says itself may be there already"
        changes = g.send("POST", "/axes/x/snapshots/1/restore", {"dry_run": True, "include_addressing": True})["changes"]
        assert {c["parameter"]: c["from"] for c in changes}["PP[7]"] in (None, 6), changes
        assert g.get("/axes/x/parameters/AC")["value"] != 23456
        assert g.get("/axes/x/parameters/PP%5B7%5D")["value"] == 6
        g.send("PATCH", "/axes/x", {"drive": "m"})
        online(g)
        assert cached(g, "A")["stored"] is None and not [p for p in g.get("/axes/x/parameters") if p["stored"] is not None]
        g.send("PATCH", "/axes/x", {"drive": "one"})
        assert cached(g, "AC")["stored"] == 23456, "the family is the same again"


def test_a_snapshot_of_another_family_is_neither_written_nor_compared(folder):
    with harness.Gateway(folder, SITE) as g:
        online(g)
        assert g.send("POST", "/axes/x/snapshots", {"name": "of a uim342"}, 201)["family"] == "uim342"
        g.send("PATCH", "/axes/x", {"drive": "m"})
        online(g)
        assert [s["family"] for s in g.get("/axes/x/snapshots")] == ["uim342"]
        for body in ({}, {"dry_run": True}):
            refused = g.send("POST", "/axes/x/snapshots/1/restore", body, 409)
            assert "uim342" in refused["detail"] and "mcode" in refused["detail"], refused
        g.send("POST", "/axes/x/snapshots", {"name": "of a mcode"}, 201)
        for other in ("device", "stored", "default", "axis:x", "snapshot:2", "axis:x:2"):
            refused = g.get(f"/axes/x/snapshots/1/diff?with={other}", 409)
            assert "uim342" in refused["detail"] and "mcode" in refused["detail"], (other, refused)
        rows = g.get("/axes/x/snapshots/1/diff?with=snapshot:1")["rows"]
        assert rows and all(r["name"] for r in rows), "its words are read by its own catalogue"


def everything(g, axis):
    return (cached(g, "AC", axis)["stored"], [h["new"] for h in g.get(f"/axes/{axis}/parameters/AC/history")], [s["name"] for s in g.get(f"/axes/{axis}/snapshots")])


def named(g, name):
    site = g.get("/site")
    return dict(site, axes=[dict(site["axes"][0], name=name)])


def test_everything_follows_the_name_also_back(folder):
    with harness.Gateway(folder, SITE) as g:
        online(g)
        write(g, 23456)
        g.send("POST", "/axes/x/snapshots", {"name": "kept", "from": "stored"}, 201)
        first = g.get("/site/history")[0]["revision"]
        whole = everything(g, "x")
        assert whole == (23456, [23456], ["kept"]), whole
        g.send("PATCH", "/axes/x", {"name": "y"})
        assert everything(g, "y") == whole
        g.send("POST", "/site/stage", named(g, "z"))
        g.send("POST", "/site/stage/apply", {"confirm_within_s": 600})
        assert everything(g, "z") == whole
        g.send("POST", "/site/stage/roll-back", None)
        assert everything(g, "y") == whole, "rolled back"
        g.send("POST", "/site/stage", named(g, "z"))
        g.send("POST", "/site/stage/apply", {"confirm_within_s": 600})
        os.kill(g.process.pid, signal.SIGKILL)
        g.process.wait()
    with harness.Gateway(folder, None) as g:
        assert everything(g, "y") == whole, "rolled back at the start"
        g.send("POST", f"/site/history/{first}/restore", None)
        g.send("POST", "/site/stage/apply", {"confirm_within_s": 0})
        assert everything(g, "x") == whole, "an older state"
        g.send("PATCH", "/drives/one", {"name": "uno"})
        online(g)
        assert g.get("/axes/x/parameters/AC")["value"] == 23456 and everything(g, "x") == whole, "the memory of the twin follows too"


def test_a_removed_axis_comes_back_with_what_was_stored_and_says_so(folder):
    with harness.Gateway(folder, SITE) as g:
        online(g)
        write(g, 23456)
        g.send("POST", "/axes/x/snapshots", {"name": "kept", "from": "stored"}, 201)
        whole = everything(g, "x")
        g.send("DELETE", "/axes/x", None, 204)
        g.send("POST", "/axes", {"name": "x", "drive": "m", "number": 1}, 201)
        assert not [p for p in g.get("/axes/x/parameters") if p["stored"] is not None], "of another family"
        assert g.send("POST", "/axes/x/snapshots/1/restore", {}, 409)
        g.send("DELETE", "/axes/x", None, 204)
        g.send("POST", "/axes", {"name": "x", "drive": "one", "number": 1}, 201)
        assert everything(g, "x") == whole
        until(lambda: sum("axis x was there before" in e["text"] for e in g.get("/events")) == 2, 5, "it is told")


def test_old_is_what_the_drive_said_last(folder):
    with harness.Gateway(folder, dict(SITE, axes=[{"name": "x", "drive": "m", "number": 1}])) as g:
        online(g)
        write(g, 777777, "A")
        g.send("POST", "/drives/m/native", {"send": "A=555555"})
        assert g.get("/axes/x/parameters/A")["value"] == 555555
        write(g, 200000, "A")
        write(g, 300000, "A")
        history = [(h["old"], h["new"]) for h in g.get("/axes/x/parameters/A/history")]
        assert history[:2] == [(200000, 300000), (555555, 200000)], history
        until(lambda: [(e["old"], e["new"]) for e in g.get("/events?kind=write")][-2:] == [("555555", "200000"), ("200000", "300000")], 5, "the journal says so too")


def test_values_of_a_silent_drive_are_stale(folder):
    site = dict(SITE, drives=[dict(d, presence="twin") for d in SITE["drives"]])
    with harness.Gateway(folder, site) as g:
        online(g)
        write(g, 23456)
        assert cached(g, "AC")["quality"] == "good"
        g.send("PATCH", "/drives/one/hand", {"silent": True})
        until(lambda: not g.axis("x")["online"], 20, "silent")
        now = cached(g, "AC")
        assert (now["value"], now["quality"]) == (23456, "stale"), now
        g.send("PUT", "/axes/x/parameters/AC", {"value": 34567}, 504)
        assert cached(g, "AC")["value"] == 23456, "what was not acknowledged is not shown"
        g.send("PATCH", "/drives/one/hand", {"silent": False})
        online(g)
        assert g.get("/axes/x/parameters/AC")["quality"] == "good"


def test_the_history_of_the_site_comes_in_pages(gateway):
    for i in range(4):
        gateway.send("PATCH", "/axes/feeder", {"unit": f"u{i}"})
    whole = gateway.get("/site/history")
    assert len(whole) >= 5 and all("document" not in r and "text" not in r for r in whole)
    assert gateway.get("/site/history?limit=2") == whole[:2]
    assert gateway.get(f"/site/history?limit=2&before={whole[1]['revision']}") == whole[2:4]
    gateway.get("/site/history?limit=0", 400)


def test_a_backup_that_waits_is_shown_and_can_be_taken_away(folder):
    with harness.Gateway(folder) as g:
        _, session, headers = g.request("POST", "/api/v1/session/first", {"code": g.code, "user": "anna", "password": "correct-horse-9"}, {"Content-Type": "application/json"})
        head = {"Cookie": headers["Set-Cookie"].split(";")[0], "X-CSRF-Token": session["csrf"]}
        bytes_head = dict(head, **{"Content-Type": "application/octet-stream"})
        _, data, _ = g.request("GET", "/api/v1/backup", None, head)
        pending = "/api/v1/backup/pending"
        assert g.request("GET", pending)[0] == 403
        assert g.request("GET", pending, None, head)[1]["waiting"] is False
        assert g.request("DELETE", pending, None, head)[0] == 404
        for wrong in (data[:8192], data[:100] + b"x" * 20000, b"SQLite format 3\0" + b"y" * 5000):
            status, answer, _ = g.request("PUT", "/api/v1/backup", wrong, bytes_head)
            assert status == 422 and str(folder) not in str(answer) and "restore-" not in str(answer) and "/data" not in str(answer), answer
        assert g.request("PUT", "/api/v1/backup", data, bytes_head)[0] == 202
        told = g.request("GET", pending, None, head)[1]
        revision = g.get("/site/history")[0]["revision"]
        assert told["waiting"] and "anna" in told["who"] and told["bytes"] == len(data) and told["site_revision"] == revision and told["version"] >= 2, told
        g.send("PATCH", "/axes/feeder", {"unit": "m"})
        assert g.request("DELETE", pending, None, head)[0] == 204
        assert g.request("GET", pending, None, head)[1] == {"waiting": False, "at": None, "who": None, "bytes": None, "version": None, "site_revision": None}
        until(lambda: any("taken away" in e["text"] for e in g.get("/events")), 5, "the event")
    with harness.Gateway(folder, None) as g:
        assert g.axis()["unit"] == "m", "the database as it was"
    _, _, err = harness.run("restore", "nofile", "--data", str(folder / "data"))
    assert "nofile" in err and "that  exists" not in err and "Name a backup" in err, err
