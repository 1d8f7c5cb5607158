"""What is kept and staged, on the real program: snapshots, a trial that takes itself back (also after a kill -9), registers as the HMI sees them, backups."""
import copy
import json
import os
import pathlib
import signal
import time

import harness
from harness import DEMO, until

TOP = pathlib.Path(__file__).resolve().parents[2]


def changed_site():
    site = copy.deepcopy(DEMO)
    site["axes"][0]["unit"] = "deg"
    site["drives"] = site["drives"][:1]
    site["axes"] = site["axes"][:1]
    return site


def unit(gateway):
    return gateway.axis()["unit"]


def test_a_snapshot_is_read_from_the_drive_compared_and_restored(gateway):
    gateway.send("PUT", "/axes/feeder/parameters/AC", {"value": 23456})
    taken = gateway.send("POST", "/axes/feeder/snapshots", {"name": "before"}, 201)
    assert taken["values"] > 60 and {p["parameter"]: p["value"] for p in taken["parameters"]}["AC"] == 23456
    gateway.send("PUT", "/axes/feeder/parameters/AC", {"value": 34567})
    rows = gateway.get("/axes/feeder/snapshots/1/diff?with=device")["rows"]
    assert next(r for r in rows if r["parameter"] == "AC")["other"] == 34567
    told = gateway.send("POST", "/axes/feeder/snapshots/1/restore", {"parameters": ["AC"], "dry_run": True})
    assert told["changes"] == [{"parameter": "AC", "from": 34567, "to": 23456}], told
    done = gateway.send("POST", "/axes/feeder/snapshots/1/restore", {"parameters": ["AC"]})
    assert done["changed"] == [{"parameter": "AC", "value": 23456}] and not done["failed"], done
    assert gateway.get("/axes/feeder/parameters/AC")["value"] == 23456
    assert [h["new"] for h in gateway.get("/axes/feeder/parameters/AC/history?limit=3")] == [23456, 34567, 23456]
    gateway.send("PATCH", "/drives/feeder/hand", {"silent": True})
    refused = gateway.send("POST", "/axes/feeder/snapshots", {"name": "silent"}, 504)
    assert "no snapshot was stored" in refused["detail"] and len(gateway.get("/axes/feeder/snapshots")) == 1


def facts():
    """What the manual says of each family that the program has, a second time: adapters/FAMILY/tests/facts.json.

    reached_by: the parameters that a drive is reached by; acts_at_once: those that act instead of configuring (what can only be written is in no
    snapshot); acts_when_disabled: of those, what a snapshot taken while enabled would write to a disabled drive; a_move_changes_no_setting: nor
    does the order for one; homed_first: it moves by positions only after homing; move: a motion that a new drive takes; line: what its line
    needs beside the URI "twin". velocity_mode, prepared_moves, set_position: what the conformance laws may not hear refused.
    """
    _, out, _ = harness.run("families", "--format", "json", check=0)
    names = [f["name"] for f in json.loads(out)]
    assert names
    all_facts = {}
    for name in names:
        path = TOP / "adapters" / name / "tests" / "facts.json"
        assert path.is_file(), f"a new family says what its drives are reached by, and what acts at once: {path.relative_to(TOP)}"
        all_facts[name] = json.loads(path.read_text())
    return all_facts


def test_every_family_says_what_its_drives_are_reached_by(gateway):
    wanted = facts()
    assert {f["name"] for f in gateway.get("/families")} == set(wanted)
    for family, fact in wanted.items():
        parameters = gateway.get(f"/families/{family}/parameters")
        assert {p["id"] for p in parameters if p["addressing"]} == set(fact["reached_by"]), family
        assert all(p["access"] == "RW" for p in parameters if p["addressing"]), family


def test_a_restore_leaves_the_address_of_the_drive_alone(gateway):
    taken = gateway.send("POST", "/axes/feeder/snapshots", {"name": "of another drive"}, 201)
    node = {p["parameter"]: p["value"] for p in taken["parameters"]}["PP[7]"]
    for parameter, value in (("PP%5B7%5D", 21), ("PP%5B5%5D", 3), ("AC", 34567)):
        gateway.send("PUT", f"/axes/feeder/parameters/{parameter}", {"value": value})
    told = gateway.send("POST", "/axes/feeder/snapshots/1/restore", {"dry_run": True})
    changes = {c["parameter"] for c in told["changes"]}
    assert "AC" in changes and not changes & set(facts()["uim342"]["reached_by"]), changes
    left_out = {s["parameter"]: s["why"] for s in told["skipped"]}
    assert "include_addressing" in left_out["PP[7]"] and "node_id" in left_out["PP[7]"] and "include_addressing" in left_out["PP[5]"], left_out
    done = gateway.send("POST", "/axes/feeder/snapshots/1/restore", {"parameters": ["PP[7]", "AC"]})
    assert [c["parameter"] for c in done["changed"]] == ["AC"] and [s["parameter"] for s in done["skipped"]] == ["PP[7]"], done
    assert gateway.get("/axes/feeder/parameters/PP%5B7%5D")["value"] == 21
    table = f"parameter,value\nPP[7],{node}\nAC,45678\n".encode()
    for query, written in (("?dry_run=1", None), ("", ["AC"]), ("?include_addressing=1", ["PP[7]"])):
        status, report, _ = gateway.request("PUT", "/api/v1/axes/feeder/parameters.csv" + query, table, {"Content-Type": "text/csv"})
        assert status == 200, report
        if written is None:
            assert [c["parameter"] for c in report["changes"]] == ["AC"] and "include_addressing" in report["skipped"][0]["why"], report
        else:
            assert [c["parameter"] for c in report["changed"]] == written, report
    assert gateway.get("/axes/feeder/parameters/PP%5B7%5D")["value"] == node
    done = gateway.send("POST", "/axes/feeder/snapshots/1/restore", {"parameters": ["PP[5]"], "include_addressing": True})
    assert [c["parameter"] for c in done["changed"]] == ["PP[5]"], done


def test_every_family_says_what_acts_at_once(gateway):
    for family, fact in facts().items():
        wanted = set(fact["acts_at_once"])
        assert {p["id"] for p in gateway.get(f"/families/{family}/parameters") if p["live"]} == wanted, family
        _, out, _ = harness.run("catalogue", family, "parameters", "--format", "json", check=0)
        assert {p["id"] for p in json.loads(out) if p["live"]} == wanted, family


def site_of_every_family():
    """A line with one embedded drive at its factory address for each family."""
    site = {"lines": [], "drives": [], "axes": [], "mappings": []}
    for number, (family, fact) in enumerate(facts().items(), 1):
        catalogue = json.loads((TOP / "schema" / "families" / f"{family}.json").read_text())
        site["lines"].append({"name": f"line{number}", "uri": "twin", "family": family, **fact["line"]})
        site["drives"].append({"name": family, "line": f"line{number}", "address": catalogue["address"]["default"]})
        site["axes"].append({"name": family, "drive": family, "number": number})
    return site


def test_a_restore_neither_enables_nor_moves_the_origin(folder):
    with harness.Gateway(folder, site_of_every_family()) as g:
        for family, fact in facts().items():
            until(lambda: g.axis(family)["online"], 10, f"{family} is there")
            g.command(family, {"command": "enable"})
            if fact["homed_first"]:
                g.command(family, {"command": "home"}, wait=60)
            g.send("POST", f"/axes/{family}/snapshots", {"name": "while enabled"}, 201)
            g.command(family, {"command": "move_relative", **fact["move"]})
            acts = f"/axes/{family}/snapshots/1/restore"
            changes = g.send("POST", acts, {"dry_run": True})["changes"]
            assert changes == [], (family, changes)
            assert g.send("POST", acts, {}).get("changed") == [], family
            g.command(family, {"command": "disable"})
            before = g.axis(family)
            assert before["state"] != "operation_enabled", (family, before)
            report = g.send("POST", acts, {})
            assert report["changed"] == [] and report["failed"] == [], (family, report)
            would = set(fact["acts_when_disabled"])
            for parameter in would:
                g.get(f"/axes/{family}/parameters/{parameter}")  # what the drive says now
            changes = g.send("POST", acts, {"dry_run": True, "include_live": True})["changes"]
            assert would <= {c["parameter"] for c in changes}, ("it is these that would be written", changes)
            assert g.send("POST", acts, {"dry_run": True})["changes"] == [], family
            if fact["a_move_changes_no_setting"]:
                with_device = g.get(f"/axes/{family}/snapshots/1/diff?with=device")
                assert not [r for r in with_device["rows"] if r["writable"] and not r["same"]], with_device["rows"]
                assert not would or would & {r["parameter"] for r in with_device["live"] if not r["same"]}, with_device["live"]
            time.sleep(1)
            after = g.axis(family)
            assert (after["state"], after["position_increments"]) == (before["state"], before["position_increments"]), (family, before, after)


def test_a_moving_axis_takes_no_restore(gateway):
    gateway.send("POST", "/axes/feeder/snapshots", {"name": "before"}, 201)
    was = gateway.get("/axes/feeder/parameters/AC")["value"]
    gateway.send("PUT", "/axes/feeder/parameters/AC", {"value": was + 1})
    gateway.command("feeder", {"command": "enable"})
    gateway.command("feeder", {"command": "move_velocity", "velocity": 3}, wait=0)
    until(lambda: gateway.axis()["moving"], 5, "moving")
    refused = gateway.send("POST", "/axes/feeder/snapshots/1/restore", {}, 409)
    assert "moves" in refused["detail"] and "stop" in refused["detail"], refused
    table = f"parameter,value\nAC,{was}\n".encode()
    assert gateway.request("PUT", "/api/v1/axes/feeder/parameters.csv", table, {"Content-Type": "text/csv"})[0] == 409
    gateway.command("feeder", {"command": "halt"})
    until(lambda: not gateway.axis()["moving"], 5, "at rest")
    done = gateway.send("POST", "/axes/feeder/snapshots/1/restore", {})
    assert [c["parameter"] for c in done["changed"]] == ["AC"], done


def test_an_unconfirmed_site_rolls_back_by_itself(gateway):
    before = gateway.get("/site")
    staged = gateway.send("POST", "/site/stage", changed_site())
    assert staged["disturbs"] == ["slide"] and gateway.get("/site") == before
    applied = gateway.send("POST", "/site/stage/apply", {"confirm_within_s": 5})
    assert applied["state"] == "applied" and unit(gateway) == "deg"
    gateway.send("PATCH", "/axes/feeder", {"unit": "m"}, 409)
    until(lambda: gateway.get("/site/stage")["state"] == "none", 10, "rolled back")
    assert gateway.get("/site") == before
    until(lambda: any("not confirmed in time" in e["text"] for e in gateway.get("/events")), 5, "the event")


def test_a_confirmed_site_stays_and_an_older_one_can_be_restored(gateway):
    before = gateway.get("/site")
    first = gateway.get("/site/history")[0]["revision"]
    gateway.send("POST", "/site/stage", changed_site())
    gateway.send("POST", "/site/stage/apply", {"confirm_within_s": 5})
    assert gateway.send("POST", "/site/stage/confirm", None)["state"] == "none"
    time.sleep(6)
    assert unit(gateway) == "deg"
    assert gateway.get(f"/site/history/{first}") == before
    assert gateway.send("POST", f"/site/history/{first}/restore", None)["state"] == "staged"
    gateway.send("POST", "/site/stage/apply", {"confirm_within_s": 0})
    assert gateway.get("/site") == before and gateway.get("/site/stage")["state"] == "none"


def test_what_was_written_to_a_removed_axis_comes_back_with_it(gateway):
    def written():
        return gateway.get("/axes/slide/parameters/AC?cached=1")["written_at"]
    gateway.send("PUT", "/axes/slide/parameters/AC", {"value": 23456})
    before = written()
    assert before
    site = gateway.get("/site")
    without = dict(site, axes=[a for a in site["axes"] if a["name"] != "slide"], drives=[d for d in site["drives"] if d["name"] != "slide"])
    gateway.send("POST", "/site/stage", without)
    gateway.send("POST", "/site/stage/apply", {"confirm_within_s": 600})
    assert len(gateway.get("/axes")) == 1
    gateway.send("POST", "/site/stage/roll-back", None)
    assert written() == before
    harness.until(lambda: gateway.get("/axes/slide")["online"], 10, "slide is back")
    assert gateway.get("/axes/slide/parameters/AC")["value"] == 23456, "the twin's memory came back too"
    gateway.send("POST", "/site/stage", without)
    gateway.send("POST", "/site/stage/apply", {"confirm_within_s": 600})
    gateway.send("POST", "/site/stage/confirm", None)
    gateway.send("PUT", "/site", site)
    assert written() == before, "also after its removal was confirmed"
    until(lambda: any("axis slide was there before" in e["text"] for e in gateway.get("/events")), 5, "but not in silence")


def test_what_one_client_staged_another_neither_replaces_nor_applies_nor_confirms_in_silence(gateway):
    def ask(who, path, body, status=200):
        s, answer, _ = gateway.request("POST", "/api/v1" + path, body, {"X-Client": who, "Content-Type": "application/json"})
        assert s == status, (s, answer)
        return answer
    first = ask("anna", "/site/stage", changed_site())
    assert gateway.get("/site/stage")["id"] == first["id"] and first["client"].endswith(" anna"), first
    taken = ask("bert", "/site/stage", changed_site(), 409)
    assert taken["type"].endswith("stage_taken") and "anna" in taken["detail"], taken
    second = ask("bert", "/site/stage?replace=true", changed_site())
    replaced = ask("anna", "/site/stage/apply", {"stage": first["id"], "confirm_within_s": 60}, 409)
    assert replaced["type"].endswith("stage_replaced") and "bert" in replaced["detail"] and unit(gateway) == "mm", replaced
    ask("bert", "/site/stage/apply", {"stage": second["id"], "confirm_within_s": 60})
    assert unit(gateway) == "deg"
    assert "bert" in ask("anna", "/site/stage/confirm", None, 409)["detail"]
    assert ask("bert", "/site/stage/confirm", None)["state"] == "none"


def killed(gateway):
    os.kill(gateway.process.pid, signal.SIGKILL)
    gateway.process.wait()


def test_a_kill_between_apply_and_confirm_rolls_back_at_the_next_start(folder):
    with harness.Gateway(folder) as g:
        before = g.get("/site")
        g.send("POST", "/site/stage", changed_site())
        g.send("POST", "/site/stage/apply", {"confirm_within_s": 600})
        assert unit(g) == "deg"
        killed(g)
    with harness.Gateway(folder, None) as g:
        assert g.get("/site") == before
        assert any("rolled back" in e["text"] for e in g.get("/events"))
        g.send("POST", "/site/stage", changed_site())
        g.send("POST", "/site/stage/apply", {"confirm_within_s": 600})
        g.send("POST", "/site/stage/confirm", None)
        killed(g)
    with harness.Gateway(folder, None) as g:
        assert unit(g) == "deg", "confirmed: it stays"


def test_registers_are_what_the_hmi_sees(gateway):
    with gateway.modbus() as m:
        seen = gateway.get("/registers?unit=1&address=15&count=1")
        assert seen["words"] == m.read(15, 1) and seen["exception"] is None
        assert gateway.get("/registers?unit=9&address=0&count=1")["exception"]["code"] == 0x0A
        revision = m.read32(18, signed=False)
    own = gateway.get("/registers?unit=2&address=0&count=2")
    assert own["decoded"][0]["mapping"] == "m1" and own["decoded"][0]["value"] == gateway.axis()["position_increments"]
    for form in ("csv", "html", "st"):
        _, body, headers = gateway.request("GET", f"/api/v1/mappings/list?format={form}")
        assert headers["Mapping-Revision"] == f"{revision:08x}" and headers["Mapping-Revision"].encode() in body, form


def test_a_backup_comes_back_at_the_next_start(folder):
    head = {"Content-Type": "application/octet-stream"}
    with harness.Gateway(folder) as g:
        before = g.get("/site")
        assert g.request("GET", "/api/v1/backup")[0] == 403, "a copy of everything, names and digests too, is for administrators"
        status, session, headers = g.request("POST", "/api/v1/session/first", {"code": g.code, "user": "anna", "password": "correct-horse-9"}, {"Content-Type": "application/json"})
        assert status == 200, session
        signed = {"Cookie": headers["Set-Cookie"].split(";")[0], "X-CSRF-Token": session["csrf"]}
        head.update(signed)
        status, data, _ = g.request("GET", "/api/v1/backup", None, signed)
        assert status == 200 and data[:11] == b"backup.json"
        g.send("PATCH", "/axes/feeder", {"unit": "m"})
        assert g.request("PUT", "/api/v1/backup", b"nothing", head)[0] == 422
        assert g.request("PUT", "/api/v1/backup", data[:100] + b"x" * 20000, head)[0] == 422
        status, answer, _ = g.request("PUT", "/api/v1/backup", data, head)
        assert status == 202 and answer["restart_needed"], answer
        assert unit(g) == "m"
    with harness.Gateway(folder, None) as g:
        assert g.get("/site") == before
