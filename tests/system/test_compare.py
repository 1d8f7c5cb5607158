"""`axisgate compare` from outside: the traffic of a running gateway with a twin is equal to the twin, and a value that is changed by hand in the file is named.

In: a gateway with one simulated CANopen drive. Out: exit codes, words and JSON of the command.
"""
import json
import pathlib
import re

from harness import Gateway, run, until

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
