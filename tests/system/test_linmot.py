"""LinMot from outside: the printed telegrams over a pseudo-terminal; the demo site's axis by HTTP and Modbus; a command table and a curve as texts.

In: the real program. Out: judgements on telegrams, registers, tables. Never sleeps longer than it waits.
"""
import json
import math
import pathlib
import struct
import urllib.parse

from harness import Gateway, Port, Process, run, until

TOP = pathlib.Path(__file__).resolve().parents[2]


def printed_cases():
    """(name, what is given, fields to compare or none, [(request, answer), ...]) of the file that the unit tests read."""
    cases = []
    for line in (TOP / "adapters/linmot/vectors.txt").read_text().splitlines():
        words = line.split("#")[0].split()
        if not words:
            continue
        if words[0] == "case":
            cases.append((words[1], [], [], []))
        elif words[0] == "given":
            cases[-1][1].extend(words[1:])
        elif words[0] == "compare":
            cases[-1][2].extend(words[1:])
        elif words[0] == ">":
            cases[-1][3].append([bytes.fromhex("".join(words[1:])), b""])
        elif words[0] == "<":
            cases[-1][3][-1][1] = bytes.fromhex("".join(words[1:]))
    return cases


def whole(got):
    return len(got) >= 4 and len(got) >= got[2] + 4


def telegram(sub, main, data=b""):
    return bytes([1, 17, len(data) + 3, 2, sub, main]) + data + b"\x04"


def field(answer, name):
    status, state = struct.unpack_from("<HH", answer, 7) if len(answer) >= 11 else (0, 0)
    return {"length": answer[2], "comm": answer[6], "status": status, "state": state >> 8, "sub": state & 0xFF, "count": state & 15}[name]


def curve_telegrams():
    """The sample curve of the pages, 21 points, as curve 1: added, its info block, its points."""
    info = bytearray(70)
    struct.pack_into("<I", info, 32, 50000)
    points = b"".join(struct.pack("<i", round(500000 * (1 - math.cos(math.pi * i / 20)))) for i in range(21))
    yield telegram(4, 4, struct.pack("<HHH", 1, len(info), len(points)))
    for sub, block in ((5, bytes(info)), (6, points)):
        for at in range(0, len(block), 4):
            yield telegram(sub, 4, struct.pack("<H", 1) + block[at:at + 4].ljust(4, b"\0"))


def test_the_printed_telegrams_over_a_pseudo_terminal(folder):
    cases = printed_cases()
    assert sum(len(c[3]) for c in cases) == 43, len(cases)
    for forced in (False, True):
        more = ["--option", "force=14"] if forced else []
        for name, given, compare, exchanges in cases:
            if ("forced" in given) != forced:
                continue
            with Process("twin", "linmot", "--line", f"pty:{folder / 'com1'}", "--address", "17", *more), Port(folder / "com1") as port:
                if "stopped" in given:
                    port.ask(telegram(3, 6), whole)
                if "curve" in given:
                    for t in curve_telegrams():
                        assert port.ask(t, whole)[6] in (0, 4), t
                if "enabled" in given:
                    for word in (0x3E, 0x3F):
                        port.ask(telegram(0, 1, struct.pack("<H", word)), whole)
                    until(lambda: field(port.ask(telegram(1, 0), whole), "state") == 8, 5, "operation enabled")
                for request, answer in exchanges:
                    got = port.ask(request, whole, 8)
                    if not compare:
                        assert got == answer, f"{name}: {request.hex(' ')} -> {got.hex(' ')}, printed {answer.hex(' ')}"
                    for f in compare:
                        assert field(got, f) == field(answer, f), f"{name}: {f} of {got.hex(' ')}, printed {answer.hex(' ')}"


def demo():
    return json.loads((TOP / "deploy/examples/demo-site.json").read_text())


def test_the_shuttle_homes_moves_and_is_read_in_tenths_of_a_micrometre(folder):
    with Gateway(folder, demo()) as g, g.modbus() as m:
        base = 7 * 64
        for body in ({"command": "enable"}, {"command": "home"}, {"command": "move_absolute", "position": 12.3456, "velocity": 50}):
            answer = g.command("shuttle", body, 40)
            assert answer["result"] == "done", answer
        until(lambda: m.read32(base + 2) == 123456, 5, "12.3456 mm as 123456 tenths of a micrometre")
        assert abs(g.axis("shuttle")["position"] - 12.3456) < 1e-9 and g.axis("shuttle")["referenced"]
        act = g.send("POST", "/axes/shuttle/actions?wait=20", {"name": "VAI Go To Pos", "arguments": {"position": 3, "velocity": 0.1, "acceleration": 1, "deceleration": 1}})
        assert act["result"] == "done", act
        until(lambda: m.read32(base + 2) == 30000, 5, "the motion command by name")
        wrong = g.send("POST", "/axes/shuttle/actions", {"name": "VAI Go To Pos", "arguments": {"position": 3, "speed": 1}}, 422)
        assert "speed" in json.dumps(wrong) and "velocity" in json.dumps(wrong), wrong


LOOP = ["Set Cmd Table Var 1 To: value=0; next=2; name=begin",
        "VAI Go To Pos: position=20 velocity=0.05 acceleration=1 deceleration=1; next=3",
        "Wait Until Motion Finished; next=4",
        "VAI Go To Pos: position=0 velocity=0.05 acceleration=1 deceleration=1; next=5",
        "Wait Until Motion Finished; next=6",
        "Add To Cmd Table Var 1: value=1; next=7",
        "IF Cmd Table Var 1 Less Than: value=3 entry_if_true=2 entry_if_false=8",
        "No Operation; name=end"]


def parameter(name):
    return f"/axes/shuttle/parameters/{urllib.parse.quote(name, safe='')}"


def test_a_command_table_and_a_curve_are_uploaded_run_kept_and_restored(folder):
    with Gateway(folder, demo()) as g, g.modbus() as m:
        assert g.command("shuttle", {"command": "enable"}, 20)["result"] == "done"
        for n, text in enumerate(LOOP, 1):
            assert g.send("PUT", parameter(f"table[{n}]"), {"value": text})["result"] == "done", text
            assert g.get(parameter(f"table[{n}]"))["value"] == text
        refused = g.send("PUT", parameter("table[9]"), {"value": "VAI Go To Pos: position=20"}, 422)
        assert "table[9]" in refused["detail"] and "velocity is missing" in refused["detail"], refused
        assert g.get(parameter("table[9]"))["value"] == ""
        started = g.send("POST", "/axes/shuttle/actions?wait=5", {"name": "Start Command Table Command", "arguments": {"entry": 1}})
        assert started["result"] in ("done", "accepted"), started
        until(lambda: g.get(parameter("1E72h"))["value"] == 3, 20, "three loops")
        # Strokes are counted in what the gateway kept: it has every poll, however late the reader comes.
        kept = g.get("/recorder/trends?axes=shuttle&points=position&columns=5000")["axes"][0]["points"]["position"]
        seen = [place for place in kept.get("values") or kept["high"] if place is not None]
        strokes, out = 0, False
        for place in seen:
            if place > 15 and not out:
                strokes, out = strokes + 1, True
            elif place < 5:
                out = False
        assert strokes == 3 and not out and max(seen) <= 20 and min(seen) >= 0, (strokes, min(seen), max(seen), len(seen))
        curve = "name=up; x=time; length=0.5; points=0 1 4 10"
        assert g.send("PUT", parameter("curve[3]"), {"value": curve})["result"] == "done"
        bad = g.send("PUT", parameter("curve[4]"), {"value": "length=1; points=0 1 up"}, 422)
        assert "point 3" in bad["detail"], bad
        played = g.send("POST", "/axes/shuttle/actions?wait=5", {"name": "Time Curve With Default Parameters", "arguments": {"curve": 3}})
        assert played["result"] in ("done", "accepted"), played
        until(lambda: m.read32(7 * 64 + 2) == 100000, 10, "the curve's end")
        # A recipe step is the same command in one text.
        recipe = {"steps": [{"action": {"axis": "shuttle", "name": "VAI Go To Pos", "argument": "position=2 velocity=0.1 acceleration=1 deceleration=1"}},
                            {"wait_for": {"axis": "shuttle", "point": "position", "is": 2, "tolerance": 0.001, "timeout_s": 10}}]}
        g.send("PUT", "/recipes/there", recipe, 201)
        g.send("POST", "/recipes/there/run", {}, 202)
        until(lambda: (r := g.get("/recipes/there/runs/1"))["state"] not in ("running", "stopping") and r, 20, "the recipe")
        assert g.get("/recipes/there/runs/1")["state"] == "done", g.get("/recipes/there/runs/1")
        # A snapshot has them, and brings them back.
        assert g.command("shuttle", {"command": "disable"}, 20)["result"] == "done"
        taken = g.send("POST", "/axes/shuttle/snapshots", {"name": "with its table"}, 201)
        values = {v["parameter"]: v["value"] for v in taken["parameters"]}
        assert values["table[2]"] == LOOP[1] and values["curve[3]"] == curve and values["table[200]"] == "", sorted(values)[:5]
        assert g.send("PUT", parameter("table[2]"), {"value": ""})["result"] == "done"
        restored = g.send("POST", f"/axes/shuttle/snapshots/{taken['n']}/restore", {"parameters": ["table[2]"]})
        assert g.get(parameter("table[2]"))["value"] == LOOP[1], restored


def test_a_backup_brings_command_table_and_curve_to_another_gateway(folder):
    copy, curve = folder / "copy.db", "name=up; x=time; length=0.5; points=0 1 4 10"
    with Gateway(folder, demo()) as g:
        for n, text in enumerate(LOOP[:2], 1):
            assert g.send("PUT", parameter(f"table[{n}]"), {"value": text})["result"] == "done", text
        assert g.send("PUT", parameter("curve[3]"), {"value": curve})["result"] == "done"
        n = g.send("POST", "/axes/shuttle/snapshots", {"name": "with its table"}, 201)["n"]
        run("backup", str(copy), "--data", str(folder / "data"), check=0)
    other = folder / "other"
    other.mkdir()
    run("restore", str(copy), "--data", str(other / "data"), check=0)
    with Gateway(other, None) as g:
        assert g.get(parameter("table[2]"))["stored"] == LOOP[1] and g.get(parameter("curve[3]"))["stored"] == curve
        # The drive itself is changed behind the gateway's back; what was kept goes down to it again.
        for name in ("table[2]", "curve[3]"):
            assert g.send("PUT", parameter(name), {"value": ""})["result"] == "done"
            assert g.get(parameter(name))["value"] == ""
        g.send("POST", f"/axes/shuttle/snapshots/{n}/restore", {"parameters": ["table[2]", "curve[3]"]})
        assert g.get(parameter("table[2]"))["value"] == LOOP[1] and g.get(parameter("curve[3]"))["value"] == curve
