"""`axisgate compare` from outside: the traffic of a running gateway with a twin is equal to the twin, and a value that is changed by hand in the file is named.

In: a gateway with one simulated CANopen drive. Out: exit codes, words and JSON of the command.
"""
import json
import pathlib
import re

from harness import Gateway, Process, run, until

SITE = {"lines": [{"name": "can0", "uri": "twin", "family": "cia402"}], "drives": [{"name": "feeder", "line": "can0", "address": "5"}],
        "axes": [{"name": "feeder", "drive": "feeder", "number": 1, "unit": "mm", "increments_per_unit": 1000}], "mappings": []}


def test_a_recorded_line_is_compared_with_its_twin(folder):
    log = folder / "can0.log"
    with Gateway(folder, SITE) as g:
        until(lambda: g.get("/axes/feeder")["online"], 15, "the drive")
        for _ in range(3):
            assert g.get("/axes/feeder/parameters/1018h:01")["value"] is not None
        log.write_text(g.request("GET", "/api/v1/lines/can0/trace?format=candump&limit=4096")[1].decode())
    text = log.read_text()
    first = next(line for line in text.splitlines() if " 585#" in line)
    code, told, wrong = run("compare", "cia402", str(log), "--specimen", "0", "--json")
    assert code in (0, 1), (code, wrong)
    before = json.loads(told)
    assert before["addresses"] == ["5"] and before["answers"] > 20 and before["equal"] > 0.9 * before["answers"], before

    # The vendor's number, changed by hand in one answer.
    place = [m.start() for m in re.finditer(r" 585#43181001", text)]
    assert place, first
    at = place[0] + len(" 585#43181001")
    log.write_text(text[:at] + ("77" if text[at:at + 2] != "77" else "78") + text[at + 2:])
    code, told, wrong = run("compare", "cia402", str(log), "--seeds", "2", "--json")
    assert code == 1, (code, wrong)
    after = json.loads(told)
    known = {(d["kind"], d["at_s"]) for d in before["differences"]}
    new = [d for d in after["differences"] if (d["kind"], d["at_s"]) not in known]
    assert len(new) == 1 and new[0]["kind"] == "value" and "1018h:01" in new[0]["request"] and not new[0]["specimens_without"], new
    code, told, wrong = run("compare", "cia402", str(log), "--seeds", "2")
    assert code == 1 and "no specimen explains it" in told and "vendor_id" in told, (told, wrong)


def test_files_that_cannot_be_compared_are_named(folder):
    path = folder / "x.log"
    for text, family, words in (("(1.0) can0 605#4018100100000000\n(1.1) can0 585#43181001010000", "cia402", "cut in its last line"),
                                ("(1.0) can0 605#4018100100000000\n", "uim342", "another family"), ("can0 605#40\n", "cia402", "no time"), ("", "cia402", "no frames")):
        path.write_text(text)
        code, told, wrong = run("compare", family, str(path))
        assert code == 2 and words in wrong and not told, (text, code, told, wrong)
    for name in (pathlib.Path(__file__).parents[1] / "recordings").glob("*.axr"):
        path.write_bytes(name.read_bytes()[:-100])
        code, told, wrong = run("compare", "cia402", str(path))
        assert code == 2 and ("cut off" in wrong or "altered" in wrong), wrong
    assert run("compare", "cia402", str(folder / "nowhere"))[0] == 2
    assert run("compare", "cia402", str(path), "--specimen", "fast")[0] == 2


def far_end(twin):
    return "tcp:127.0.0.1:" + re.search(r"127\.0\.0\.1:(\d+)", twin.ready).group(1)


def compared(family, line, *more, code=None):
    """The comparison of a drive on a line: exit code and report. The machine of a test may be slow, so the reply times have room."""
    got, told, wrong = run("compare", family, "--line", line, "--tolerance-ms", "5000", "--json", *more)
    assert code is None or got == code, (got, told, wrong)
    return json.loads(told)


def test_a_drive_on_a_line_is_compared_and_its_twin_becomes_this_drive(folder):
    memory, adopted = folder / "drive.json", folder / "twin.json"
    with Process("twin", "uim342", "--line", "tcp-listen:127.0.0.1:0", "--state", str(memory)) as drive:
        report = compared("uim342", far_end(drive), code=0)
        assert report["read"] > 90 and report["equal"] == report["read"] and not report["fault"], report
        assert any(f["parameter"] == "MF2.AC" for f in report["left_out"]), report["left_out"]
        before = memory.read_text()
    kept = json.loads(before) or {"5": {}}
    kept.setdefault("5", {}).update({"AC": 4321, "SN": 777})
    memory.write_text(json.dumps(kept))
    with Process("twin", "uim342", "--line", "tcp-listen:127.0.0.1:0", "--state", str(memory)) as drive:
        report = compared("uim342", far_end(drive), "--adopt", str(adopted), code=1)
        rows = {r["parameter"]: r for r in report["rows"]}
        assert rows["AC"]["drive"] == 4321 and rows["AC"]["twin"] != 4321 and rows["AC"]["name"] and rows["AC"]["unit"], report["rows"]
        assert "AC" in report["adoption"]["adopted"] and "SN.serial" in report["adoption"]["adopted"], report["adoption"]
        assert json.loads(memory.read_text()) == kept, "comparing has written nothing"
        code, told, wrong = run("compare", "uim342", "--line", far_end(drive), "--tolerance-ms", "5000")
        assert code == 1 and "value     AC (acceleration): drive 4321" in told, (told, wrong)
        # The twin with the adopted memory is this drive.
        compared("uim342", far_end(drive), "--state", str(adopted), code=0)
    with Process("twin", "uim342", "--line", "tcp-listen:127.0.0.1:0", "--state", str(adopted)) as away:
        compared("uim342", far_end(away), "--state", str(memory), code=0)


def test_drives_that_cannot_be_compared_on_a_line_are_named():
    with Process("twin", "mcode", "--line", "tcp-listen:127.0.0.1:0") as drive:
        code, told, wrong = run("compare", "pacontrol", "--line", far_end(drive))
        assert code == 2 and "no pacontrol at address" in wrong and not told, (code, told, wrong)
    for arguments, words in ((("uim342", "--line", "twin"), "line of `serve`"), (("uim342", "--line", "dds"), "other gateways"), (("uim342",), "name a recording"),
                             (("mcode", "--line", "can:can0"), "do not have CAN"), (("uim342", "x.log", "--line", "tcp:127.0.0.1:1"), "not both"),
                             (("uim342", "--line", "tcp:127.0.0.1:1", "--channel", "2"), "at most 1"), (("uim342", "x.log", "--adopt", "y"), "--line")):
        code, told, wrong = run("compare", *arguments)
        assert code == 2 and words in wrong and not told, (arguments, code, told, wrong)


def test_a_late_drive_is_named_with_its_times():
    with Process("twin", "uim342", "--line", "tcp-listen:127.0.0.1:0", "--option", "reply_ms=45") as drive:
        code, told, _ = run("compare", "uim342", "--line", far_end(drive), "--json")
        outside = json.loads(told)["replies"]["outside"]
        assert code == 1 and len(outside) > 50 and all(d["kind"] == "late" and d["reply_ms"] > d["most_ms"] for d in outside), outside[:3]


def test_a_gateway_compares_the_drive_that_it_serves_and_its_twin_adopts_the_values(folder):
    memory = folder / "drive.json"
    memory.write_text(json.dumps({"5": {"AC": 4321}}))
    with Process("twin", "uim342", "--line", "tcp-listen:127.0.0.1:0", "--state", str(memory)) as drive:
        site = {"lines": [{"name": "bus", "uri": far_end(drive), "family": "uim342"}], "drives": [{"name": "feeder", "line": "bus", "address": "5", "presence": "auto"}],
                "axes": [{"name": "feeder", "drive": "feeder", "number": 1, "unit": "mm", "increments_per_unit": 1000}], "mappings": []}
        with Gateway(folder, site) as g:
            until(lambda: g.axis()["presence"] == "device" and g.axis()["online"], 15, "the drive")
            g.get("/axes/feeder/comparison", 404)
            kept = json.loads(memory.read_text())
            status, report, _ = g.request("POST", "/api/v1/axes/feeder/comparison")
            assert status in (200, 202), report
            report = until(lambda: g.request("GET", "/api/v1/axes/feeder/comparison")[1] if g.request("GET", "/api/v1/axes/feeder/comparison")[0] == 200 else None, 60, "the report")
            rows = {r["parameter"]: r for r in report["rows"]}
            assert rows["AC"]["kind"] == "value" and rows["AC"]["drive"] == 4321, report
            assert report["identity"] and report["read"] > 90, report
            assert json.loads(memory.read_text()) == kept, "comparing has written nothing"
            adoption = g.send("POST", "/axes/feeder/comparison/adopt", None)
            assert "AC" in adoption["adopted"], adoption
            kinds = {e["kind"] for e in g.get("/events?limit=50")}
            assert {"twin", "comparison"} <= kinds, kinds
            drive.stop()
            until(lambda: g.axis()["presence"] == "twin" and g.axis()["online"], 20, "the twin takes over")
            assert g.get("/axes/feeder/parameters/AC")["value"] == 4321, "the twin is this drive"
            assert g.request("POST", "/api/v1/axes/feeder/comparison")[0] == 409, "there is no real drive now"
            assert g.request("POST", "/api/v1/axes/feeder/comparison/adopt")[0] == 409
