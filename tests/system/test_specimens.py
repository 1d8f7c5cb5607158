"""Specimens by the program itself: their words, twins of them on a line, and a recipe that is rehearsed against many."""
import json
import pathlib
import sys

import harness
from harness import Process, run


def test_every_family_tells_its_freedoms_and_its_specimens():
    for family in (f["name"] for f in json.loads(run("families", "--format", "json", check=0)[1])):
        told = json.loads(run("specimen", family, "--json", check=0)[1])
        assert told["family"] == family and told["named_specimens"] == ["slow", "sparse", "strict", "chatty", "weak", "old"], told
        freedoms = {f["name"]: f for f in told["freedoms"]}
        lines = run("specimen", family, check=0)[1].splitlines()
        assert lines[0].split()[0] == "freedom" and [line.split()[0] for line in lines[1:]] == list(freedoms), lines
        manual = json.loads(run("specimen", family, "0", "--json", check=0)[1])
        assert manual["values"] == {name: f["default"] for name, f in freedoms.items()} and manual["words"] == [], manual
        assert "as its manual shows it" in run("specimen", family, "0", check=0)[1]
        for specimen in ("17", "slow", "1000000000"):
            one = json.loads(run("specimen", family, specimen, "--json", check=0)[1])
            assert one == json.loads(run("specimen", family, specimen, "--json", check=0)[1]), "another drive at the second time"
            assert all(f["min"] <= one["values"][name] <= f["max"] for name, f in freedoms.items()), one
            differing = [name for name, f in freedoms.items() if one["values"][name] != f["default"]]
            assert [w.split()[0] for w in one["words"]] == differing, one
            assert len(run("specimen", family, specimen, check=0)[1].splitlines()) == 1 + len(differing)


def test_what_is_no_specimen_is_refused_with_what_would_be():
    for arguments in (("specimen", "uim342", "fast"), ("specimen", "uim342", "-1"), ("specimen", "uim342", "1000000001"), ("specimen", "nobody"),
                      ("twin", "uim342", "--line", "tcp-listen:127.0.0.1:0", "--specimen", "fast"),
                      ("twin", "uim342", "--line", "tcp-listen:127.0.0.1:0", "--specimen", "1", "--option", "specimen=2")):
        code, out, err = run(*arguments)
        assert code == 2 and err.strip() and not out.strip(), (arguments, code, out, err)
    assert "write a seed from 0" in run("specimen", "uim342", "fast")[2]


def test_a_twin_is_a_specimen():
    with Process("twin", "uim342", "--line", "tcp-listen:127.0.0.1:0", "--specimen", "17") as twin:
        assert twin.ready.startswith("ready uim342 addresses="), twin.ready
        assert twin.stop() == 0


def site_file(folder):
    path = pathlib.Path(folder) / "site.json"
    path.write_text(json.dumps(harness.DEMO))
    return str(path)


MOVES = {"parameters": {"way": {"type": "number", "default": 3}},
         "steps": [{"enable": {"axis": "feeder"}},
                   {"command": {"axis": "feeder", "command": "move_absolute", "position": "${way}", "velocity": 20, "wait_s": 30}},
                   {"check": {"axis": "feeder", "point": "position", "is": "${way}", "tolerance": 0.1}},
                   {"disable": {"axis": "feeder"}}]}


def test_a_recipe_is_rehearsed_against_specimens(folder):
    site, recipe = site_file(folder), pathlib.Path(folder) / "there.json"
    recipe.write_text(json.dumps(MOVES))
    order = ("rehearse", "--site", site, "--recipe", str(recipe))
    text = run(*order, "--specimens", "0", check=0)[1].splitlines()
    assert text[0].split()[:2] == ["specimen", "result"] and text[1].split()[:2] == ["0", "passed"] and text[-1] == "1 of 1 specimens passed", text
    code, out, err = run(*order, "--specimens", "0..5,slow", "--argument", "way=2", "--json")
    said = json.loads(out)
    assert [s["specimen"] for s in said["specimens"]] == ["0", "1", "2", "3", "4", "5", "slow"], said
    assert said["passed"] + said["failed"] == 7 and code == (1 if said["failed"] else 0), (code, err)
    assert all(s["passed"] or s["text"] for s in said["specimens"]), said
    again = json.loads(run(*order, "--specimens", "0..5,slow", "--argument", "way=2", "--json")[1])
    assert again == said, "virtual time depends on this computer"


def test_a_recipe_that_fails_names_the_step(folder):
    site, recipe = site_file(folder), pathlib.Path(folder) / "short.json"
    recipe.write_text(json.dumps({"steps": [{"enable": {"axis": "feeder"}},
                                            {"command": {"axis": "feeder", "command": "move_absolute", "position": 100, "velocity": 1, "wait_s": 1}}]}))
    code, out, _ = run("rehearse", "--site", site, "--recipe", str(recipe), "--specimens", "0,weak", "--family-specimen", "uim342=0", "--json")
    said = json.loads(out)
    assert code == 1 and said["failed"] == 2, said
    for one in said["specimens"]:
        assert one["pointer"] == "/steps/1" and one["step"].startswith("Step 2") and "not done within 1 s" in one["text"], one
    recipe.write_text(json.dumps({"steps": [{"enable": {"axis": "nobody"}}]}))
    code, out, err = run("rehearse", "--site", site, "--recipe", str(recipe))
    assert code == 2 and not out and "there is no axis nobody" in err and f"{recipe}:1" in err, (code, out, err)
    for more in (("--specimens", "3..1"), ("--family-specimen", "uim342"), ("--family-specimen", "nobody=1"), ("--argument", "x")):
        assert run("rehearse", "--site", site, "--recipe", str(recipe), *more)[0] == 2, more
    assert run("rehearse", "--site", site, "--recipe", str(pathlib.Path(folder) / "gone.json"))[0] == 2


def test_a_stored_recipe_is_rehearsed_while_the_gateway_runs(folder, gateway):
    gateway.send("PUT", "/recipes/there", MOVES, 201)
    data = str(folder / "data")
    out = run("rehearse", "--data", data, "--recipe", "there", "--specimens", "0", check=0)[1]
    assert "1 of 1 specimens passed" in out, out
    assert not gateway.axis()["moving"] and gateway.axis()["position"] == 0, "the rehearsal reached the gateway that runs"
    code, _, err = run("rehearse", "--data", data, "--recipe", "nobody")
    assert code == 2 and "no stored recipe nobody" in err, (code, err)
    assert gateway.get("/families/uim342/specimens/slow")["values"] == json.loads(run("specimen", "uim342", "slow", "--json", check=0)[1])["values"]


def rehearse_program(folder, command, *more):
    code, out, err = run("rehearse", "--site", site_file(folder), "--program", command, "--json", *more)
    assert out, (code, err)
    return code, json.loads(out)


def test_a_program_outside_is_told_its_door_and_its_specimen_and_tells_its_step(folder):
    code, told = rehearse_program(folder, 'echo step: first; echo "$AXISGATE_MODBUS $AXISGATE_ENIP $AXISGATE_TIME_SCALE $AXISGATE_SPECIMEN"; exit 3', "--specimens", "0,slow",
                                  "--time-scale", "50")
    assert code == 1 and told["passed"] == 0 and [s["specimen"] for s in told["specimens"]] == ["0", "slow"], told
    for s in told["specimens"]:
        modbus, enip, scale, specimen = s["text"].split()
        assert modbus != enip and all(door.startswith("127.0.0.1:") for door in (modbus, enip)) and float(scale) == 50 and specimen == s["specimen"] and s["step"] == "first", s
    code, told = rehearse_program(folder, "exit 3", "--specimens", "0")
    assert told["specimens"][0]["text"] == "the program ended with code 3 and said nothing", told
    code, told = rehearse_program(folder, "sleep 1000", "--specimens", "0", "--time-scale", "100", "--limit", "20")
    assert code == 1 and "not at its end after 20 s" in told["specimens"][0]["text"], told
    assert rehearse_program(folder, "true", "--specimens", "0..3")[0] == 0
    site = site_file(folder)
    for wrong in (("--program", "true", "--recipe", "x.json"), ("--program", "true", "--argument", "a=1"), ("--program", "true", "--time-scale", "0"), ("--time-scale", "5"),
                  ("--program", "true", "--family-specimen", "nobody=1"), ()):
        assert run("rehearse", "--site", site, *wrong)[0] == 2, wrong


READ_AND_MOVE = """
import os, socket, struct, sys, time
host, port = os.environ["AXISGATE_MODBUS"].rsplit(":", 1)
s = socket.create_connection((host, int(port)))
def ask(pdu):
    s.sendall(struct.pack(">HHHB", 1, 0, len(pdu) + 1, 1) + pdu)
    data = b""
    while len(data) < 6 or len(data) < 6 + struct.unpack(">H", data[4:6])[0]:
        data += s.recv(300)
    return data[7:]
def read():
    return struct.unpack(">10H", ask(struct.pack(">BHH", 3, 0, 10))[2:])
assert read()[9] & 1, "it is not online when the program begins"
begun = time.monotonic()
for word in (6, 7, 15):
    ask(struct.pack(">BHH", 6, 32, word))
    while read()[0] & 0x6F not in {6: (0x21, 0x23, 0x27), 7: (0x23, 0x27), 15: (0x27,)}[word]:
        pass
print("enabled", ask(struct.pack(">BHH", 6, 33, 3)).hex())
ask(struct.pack(">BHHBHH", 16, 38, 2, 4, 0, 32000))
ask(struct.pack(">BHHBHH", 16, 42, 2, 4, 0, 3200))
first, at = read()[2:4], time.monotonic()
while time.monotonic() - at < 0.4:
    last = read()[2:4]
way = ((last[0] << 16) + last[1] - (first[0] << 16) - first[1]) / 3200 / (time.monotonic() - at)
print("way per second of this computer:", round(way, 2))
sys.exit(0 if 5 < way < 11 else 1)
"""


def test_the_time_of_the_gateway_passes_by_the_scale(folder):
    program = pathlib.Path(folder) / "program.py"
    program.write_text(READ_AND_MOVE)
    code, told = rehearse_program(folder, f"{sys.executable} {program}", "--specimens", "0", "--time-scale", "10")
    assert code == 0, told


def test_the_plc_program_of_the_examples_copes_with_specimens_of_three_families(folder):
    program, site = harness.EXAMPLES / "plc_program.py", harness.EXAMPLES / "plc-site.json"
    code, out, err = run("rehearse", "--site", str(site), "--program", f"{sys.executable} {program}", "--specimens", "0,3,slow", "--time-scale", "10", "--json")
    told = json.loads(out)
    assert code == 0 and told["passed"] == 3, (told, err)
    # It does not pass with anything: with an axis that may not go to its positions it says which one, and at which step.
    document = json.loads(site.read_text())
    next(a for a in document["axes"] if a["name"] == "feeder").update({"position_min": -10, "position_max": 3})
    narrow = pathlib.Path(folder) / "narrow.json"
    narrow.write_text(json.dumps(document))
    code, out, err = run("rehearse", "--site", str(narrow), "--program", f"{sys.executable} {program} feeder", "--specimens", "0", "--time-scale", "20", "--json")
    row = json.loads(out)["specimens"][0]
    assert code == 1 and row["step"].startswith("feeder: move to 16000, attempt 8") and "refused" in row["text"], row
    code, out, err = run("rehearse", "--site", str(site), "--program", f"{sys.executable} {program} nobody", "--specimens", "0", "--json")
    assert code == 1 and json.loads(out)["specimens"][0]["text"].startswith("there is no axis nobody"), (out, err)


def test_the_enip_program_of_the_examples_copes_with_specimens_of_two_families(folder):
    program, site = harness.EXAMPLES / "enip_program.py", harness.EXAMPLES / "plc-site.json"

    def rehearsed(axes, specimens, which=site):
        code, out, err = run("rehearse", "--site", str(which), "--program", f"{sys.executable} {program} {axes}", "--specimens", specimens, "--time-scale", "20", "--json")
        return code, json.loads(out), err
    code, told, err = rehearsed("feeder lift", "0,3,weak")
    assert code == 0 and told["passed"] == 3, (told, err)
    document = json.loads(site.read_text())
    next(a for a in document["axes"] if a["name"] == "feeder").update({"position_min": -10, "position_max": 3})
    narrow = pathlib.Path(folder) / "narrow.json"
    narrow.write_text(json.dumps(document))
    code, told, err = rehearsed("feeder", "0", narrow)
    row = told["specimens"][0]
    assert code == 1 and row["step"].startswith("feeder: move to 16000, attempt 8") and "general status 09h, reason 1" in row["text"], row


# A class 1 connection of 100 ms that never sends: in 0.4 s of this computer it gets the images of 8 s, and is ended behind 12.8 s.
LISTENER = """
import os, socket, struct, sys, time
sys.path.insert(0, sys.argv[1])
from test_enip import Originator
host, port = os.environ["AXISGATE_ENIP"].rsplit(":", 1)
with Originator(host, int(port), 0) as o:
    assert o.open(151, 101, rpi_us=100000) == (0, ()), "the connection is refused"
    kind, size, family, io_port = struct.unpack("<HH", o.items_behind[:4]) + struct.unpack(">HH", o.items_behind[4:8])
    assert (kind, size, family) == (0x8000, 16, 2) and io_port != 0, o.items_behind
    begun, images, last = time.monotonic(), 0, 0.0
    o.udp.settimeout(0.3)
    try:
        while time.monotonic() < begun + 3:
            o.udp.recv(2048)
            last = time.monotonic() - begun
            images += last < 0.4
    except socket.timeout:
        pass
    print(images, "images, the last one after", round(last, 2), "s")
    sys.exit(0 if 25 < images < 90 and 0.3 < last < 2 else 1)
"""


def test_a_class_1_connection_runs_in_the_time_of_the_gateway(folder):
    program = pathlib.Path(folder) / "listener.py"
    program.write_text(LISTENER)
    code, told = rehearse_program(folder, f"{sys.executable} -B {program} {pathlib.Path(__file__).resolve().parent}", "--specimens", "0", "--time-scale", "20")
    assert code == 0, told


def test_a_recipe_is_rehearsed_over_http_while_its_axis_stands(gateway):
    gateway.send("PUT", "/recipes/there", MOVES, 201)
    before = gateway.axis()["position"]
    state = gateway.send("POST", "/recipes/there/rehearsal", {"specimens": "0..4,weak", "families": {"uim342": "0"}}, 202)
    assert state["state"] == "running" and state["total"] == 6, state
    done = harness.until(lambda: (s := gateway.get("/recipes/there/rehearsal"))["state"] == "done" and s, 60, "the rehearsal's end")
    assert done["passed"] == 6 and {s["seconds"] for s in done["specimens"]} == {done["specimens"][0]["seconds"]}, "one drive, named six times"
    assert gateway.axis()["position"] == before and not gateway.axis()["moving"]
    # One that takes long is ended in the middle of a specimen.
    gateway.send("PUT", "/recipes/long", {"steps": [{"enable": {"axis": "feeder"}}, {"wait_s": 86000}], "timeout_s": 86400}, 201)
    gateway.send("POST", "/recipes/long/rehearsal", {"specimens": "1..1000"}, 202)
    gateway.send("DELETE", "/recipes/long/rehearsal", None, 202)
    harness.until(lambda: gateway.get("/recipes/long/rehearsal")["state"] == "cancelled", 20, "its end")
    assert gateway.send("POST", "/recipes/there/rehearsal", {"specimens": "0"}, 202)["state"] == "running"
