"""The demo site as a newcomer meets it: every axis is homed, moved and jogged; native bytes; parameters by the numbers that are served.

In: the site that deploy/run starts. Out: what each of its axes does, through HTTP and Modbus alone.
"""
import json
import pathlib
import re
import time
import urllib.parse

from harness import Gateway, Process, until
from test_openapi import WebSocket

TOP = pathlib.Path(__file__).resolve().parents[2]


def demo():
    return json.loads((TOP / "deploy/examples/demo-site.json").read_text())


def test_every_demo_axis_is_homed_moved_jogged_and_stopped(folder):
    site = demo()
    with Gateway(folder, site) as g:
        for axis in [a["name"] for a in site["axes"]]:
            def does(body, wait=40):
                answer = g.command(axis, body, wait)
                assert answer["result"] == "done", f"{axis}: {answer}"
            does({"command": "enable"})
            does({"command": "home"})
            now = g.axis(axis)
            assert now["referenced"] and now["position"] == 0 and not now["moving"], now
            does({"command": "move_absolute", "position": 4, "velocity": 20})
            assert abs(g.axis(axis)["position"] - 4) < 0.01, axis
            for velocity in (3, -3):  # slowly, as one who tries it
                before = g.axis(axis)["position"]
                does({"command": "move_velocity", "velocity": velocity})
                assert g.axis(axis)["moving"], axis
                until(lambda: (g.axis(axis)["position"] - before) * velocity > 0.5, 5, f"{axis} jogs at {velocity}")
                does({"command": "halt"})
                assert not g.axis(axis)["moving"], axis
            does({"command": "quick_stop"})
            does({"command": "disable"})
            assert g.axis(axis)["error"]["code"] == 0 or not g.axis(axis)["error"], g.axis(axis)["error"]
        events = g.get("/events?severity=alarm")
        assert events == [], f"nothing that a newcomer does is an alarm: {events}"


def test_the_feeders_bus_carries_a_controller_in_gear_and_a_drive_by_its_makers_file(folder):
    """What a newcomer finds on one CAN line: commissioned by HTTP, read over Modbus, one of them led by a stream of set-points."""
    with Gateway(folder, demo()) as g, g.modbus() as m:
        places = {a["name"]: 64 * (a["number"] - 1) for a in demo()["axes"]}

        def done(axis, body):
            answer = g.command(axis, body)
            assert answer["result"] == "done", f"{axis}: {answer}"

        assert g.get("/descriptions/example-servo.eds")["name"] == "example-servo.eds", "it lay beside the site"
        assert g.get("/drives/spindle")["description"] == "example-servo.eds"
        for axis in ("feeder", "spindle", "macs.master", "macs.slave"):
            done(axis, {"command": "enable"})
        # Electronic gear: the slave turns three ways for two of the master's.
        for name, value in (("SYNCFACTM", 2), ("SYNCFACTS", 3)):
            g.send("PUT", f"/axes/macs.slave/parameters/{name}", {"value": value})
        g.send("PATCH", "/drives/macs/hand", {"gear": "position"})
        done("macs.master", {"command": "move_absolute", "position": 10, "velocity": 20})
        until(lambda: abs(g.axis("macs.slave")["position"] - 15) < 0.05, 5, "the slave is where its gear has it")
        # What a PLC reads of all four: increments, in registers 2 and 3 of each block.
        until(lambda: m.read32(places["macs.slave"] + 2) == 7500, 5, "the slave's increments")
        assert m.read32(places["macs.master"] + 2) == 5000
        # Cyclic synchronous position: a stream leads the drive that its maker's file describes, while its neighbours go on.
        done("feeder", {"command": "move_absolute", "position": 5, "velocity": 20})
        assert 8 in g.axis("spindle")["modes"], g.axis("spindle")["modes"]
        stream = WebSocket(g, "/api/v1/stream")
        try:
            for step in range(100):
                stream.send({"set_point": {"axis": "spindle", "mode": "position", "value": 0.1 * step}})
                time.sleep(0.01)
            until(lambda: g.axis("spindle")["position"] > 5, 5, "the stream leads it")
            assert g.axis("spindle")["mode_number"] == 8
        finally:
            stream.close()
        until(lambda: not g.axis("spindle")["moving"], 5, "who leads it is gone: it stands")
        assert m.read32(places["spindle"] + 2) > 5000
        assert m.read32(places["feeder"] + 2) == 16000
        line = g.get("/lines/can0")
        assert 0 < line["status"]["load"] < 0.8, line["status"]  # the bus tells its load


def framed_1900():
    """The control's question for its inputs, as one frame: its check is the exclusive or of the text's bytes."""
    text = b"1900;5;0;0"
    check = 0
    for b in text:
        check ^= b
    return (b"\x01\x02" + text + b"\x03" + str(check).encode() + b"\x04").hex()


def test_native_bytes_in_each_familys_form(folder):
    with Gateway(folder, demo()) as g:
        def ask(drive, bytes_, status=200):
            return g.send("POST", f"/drives/{drive}/native", {"send_hex": bytes_}, status)
        text = g.send("POST", "/drives/lift/native", {"send": "PR VM"})
        assert text["reply"] == "768000", text
        for end in ("", "0d", "0a", "0d0a"):
            assert ask("lift", b"PR VM".hex() + end)["reply"] == "768000", end
        for drive, good in (("feeder", "95 00"), ("feeder", "95 00 95 00"), ("portal", framed_1900()), ("portal", "04")):
            assert ask(drive, good)["reply_hex"], (drive, good)
        for drive, bad, says in (("lift", "505200", "character 3 is 0x00"), ("lift", "4d4120310d4d412032", "character 5 is 0x0D"), ("lift", "0d0a", "empty"),
                                 ("feeder", "95", "byte 1 (0x95)"), ("feeder", "9500 9509", "byte 4 is 0x09"), ("feeder", "950201", "byte 2 announces 2"),
                                 ("portal", "0506", "one frame"), ("portal", framed_1900()[:-2], "one frame"), ("portal", framed_1900() * 2, "one frame")):
            fault = ask(drive, bad, 422)
            assert says in fault["detail"], fault


def one_axis_of_each_family(site):
    lines = {line["name"]: line["family"] for line in site["lines"]}
    drives = {d["name"]: lines[d["line"]] for d in site["drives"]}
    return list({drives[a["drive"]]: a["name"] for a in reversed(site["axes"])}.items())


def test_the_selector_that_is_served_reads_that_parameter(folder):
    site = demo()
    with Gateway(folder, site) as g, g.modbus() as m:
        for family, axis in one_axis_of_each_family(site):
            base = (next(a["number"] for a in site["axes"] if a["name"] == axis) - 1) * 64
            shown = {p["id"]: p for p in g.get(f"/axes/{axis}/parameters")}
            read = carried = texts = 0
            for p in g.get(f"/families/{family}/parameters"):
                if p["selector"] is None:
                    assert p["type"] in ("text", "bytes"), p
                    texts += 1
                    continue
                assert p["type"] not in ("text", "bytes"), p
                places = [(p["id"], p["selector"])]
                if p["count"]:
                    last = p["first"] + p["count"] - 1
                    places = [(f"{p['id']}[{p['first']}]", p["selector"]), (f"{p['id']}[{last}]", p["selector"] + (p["count"] - 1) * 65536)]
                for name, selector in places:
                    assert name not in shown or shown[name]["selector"] == selector, shown[name]
                    if p["access"] == "W":
                        continue
                    read += 1
                    # A clock or a temperature may change between the two readings: then they are alike the next time, or it changes all the time.
                    seen = []
                    for _ in range(3):
                        m.write(base + 48, [selector >> 16, selector & 0xFFFF, 1])
                        until(lambda: m.read(base + 51, 1)[0] != 1, 5, f"{family} {name}")
                        state, high, low, _ = m.read(base + 51, 4)
                        status, one, _ = g.request("GET", f"/api/v1/axes/{axis}/parameters/{urllib.parse.quote(name, safe='')}")
                        if state != 2 or status != 200:
                            break
                        assert one["selector"] == selector and one["id"] == name, one
                        value = high << 16 | low
                        signed = value - (1 << 32) if value >> 31 and p["type"] != "u32" else value
                        seen.append((signed, one["value"]))
                        if int(one["value"]) == signed:
                            break
                    if state != 2 or status != 200:
                        # Both doors ask the same drive: what one of them reads the other reads, unless it does not fit into the channel.
                        assert state != 2, f"{family} {name}: the channel reads it, and HTTP says {status} {one}"
                        number = float(one["value"]) if status == 200 and re.fullmatch(r"-?\d+(\.\d+)?", str(one["value"])) else None
                        assert number is None or number != int(number) or not -(1 << 31) <= number < 1 << 32, f"{family} {name}: {one}, and the channel's state is {state}"
                        continue
                    registers, values = zip(*seen)
                    assert registers[-1] == int(values[-1]) or len(set(values)) == len(values) > 1, f"{family} {name}: {seen}"
                    carried += 1
            assert carried > 20 and carried * 2 > read, f"{family}: {carried} of {read} carried"


def test_an_auto_drive_whose_far_end_is_killed_is_told_offline_and_let_go(folder):
    with Process("twin", "mcode", "--line", "tcp-listen:127.0.0.1:0") as far:
        port = int(re.search(r"127\.0\.0\.1:(\d+)", far.ready).group(1))
        site = {"lines": [{"name": "a", "uri": f"tcp:127.0.0.1:{port}", "family": "mcode"}],
                "drives": [{"name": "a", "line": "a", "address": "!", "presence": "auto"}],
                "axes": [{"name": "a", "drive": "a", "number": 1, "unit": "mm", "increments_per_unit": 1000}], "mappings": []}
        with Gateway(folder, site) as g:
            until(lambda: g.axis("a")["presence"] == "device" and g.axis("a")["online"], 10, "the real one serves")
            assert g.command("a", {"command": "enable"})["result"] == "done"
            far.process.kill()
            far.process.wait()
            until(lambda: not g.axis("a")["online"], 10, "it is missed")
            time.sleep(0.5)
            axis, drive = g.axis("a"), g.get("/drives/a")["status"]
            assert (axis["presence"], axis["online"], axis["simulated"]) == ("offline", False, False), axis
            assert (drive["presence"], drive["online"], drive["simulated"]) == ("offline", False, False), drive
            assert "disable the axis to let the twin take over" in drive["text"], drive
            for body in ({"command": "enable"}, {"command": "quick_stop"}):
                g.command("a", body, status=503)
            assert g.axis("a")["presence"] == "offline", "a stop that nobody heard lets nothing go"
            answer = g.command("a", {"command": "disable"})
            assert answer["result"] == "accepted", answer
            for part in ("nobody answers", "taken as disabled", "its twin takes over", "not known"):
                assert part in answer["text"], answer
            until(lambda: g.axis("a")["presence"] == "twin" and g.axis("a")["online"], 3, "the twin takes over")
            until(lambda: g.get("/drives/a")["status"]["presence"] == "twin", 3, "so says the drive")
