"""PA-CONTROL from outside: the manual's frames over a pseudo-terminal, byte for byte; four axes of the demo site; decoding a recording."""
import http.client
import json
import pathlib
import termios
import time

from harness import Gateway, Port, Process, run, until

TOP = pathlib.Path(__file__).resolve().parents[2]


def printed_frames():
    """(request, reply) of the cases of chapter 3.4 that need no state but the registers set before them."""
    pairs, request, section = [], None, False
    for line in (TOP / "adapters/pacontrol/vectors.txt").read_text().splitlines():
        if line.startswith("# Frames that the manual prints byte for byte"):
            section = True
        elif section and line.startswith("# ---"):
            break
        words = line.split()
        if not section or not words:
            continue
        if words[0] == "case":
            name, state, request = words[1], False, None
        elif words[0] == "state":
            state = True
        elif words[0] == ">":
            side = "request"
        elif words[0] in ("<", "<~", "poll>"):
            side = "reply" if words[0] == "<" else "other"
        elif words[0] == "bytes":
            data = bytes.fromhex("".join(words[1:]))
            if side == "request":
                request = data
            elif side == "reply" and request and not state and request[2:4] in (b"09", b"19"):
                pairs.append((name, request, data))
                request = None
    return pairs


def whole(got):
    return got.endswith(b"\x04")


def framed(text):
    """A request with its check: the exclusive or of the text's bytes, decimal."""
    check = 0
    for b in text.encode():
        check ^= b
    return b"\x01\x02" + text.encode() + b"\x03" + str(check).encode() + b"\x04"


def text_of(reply):
    assert reply.startswith(b"\x01\x02") and reply.endswith(b"\x04"), reply
    text, check = reply[2:-1].split(b"\x03")
    value = 3
    for b in text:
        value ^= b
    assert int(check) == value, reply
    return text.decode()


def test_the_manuals_frames_over_a_pseudo_terminal(folder):
    pairs = printed_frames()
    assert len(pairs) >= 2, pairs
    with Process("twin", "pacontrol", "--line", f"pty:{folder / 'com1'}"):
        with Port(folder / "com1", termios.CS7) as port:
            for name, request, reply in pairs:
                assert port.ask(request, whole) == reply, name
            # the sequence of chapter 3.4: into ONLINE, move axis 2, poll until the end of processing
            assert text_of(port.ask(framed("0603;0;0;0"), whole)) == "0;1;31;0;0;0"
            first = text_of(port.ask(framed("0A87;2;1;552.0"), whole)).split(";")
            assert first[:5] == ["0", "0", "31", "0", "1"], first
            positions = [float(first[5])]
            for _ in range(200):
                answer = text_of(port.ask(b"\x04", whole)).split(";")
                positions.append(float(answer[5]))
                if answer[1] == "1":
                    break
                time.sleep(0.05)
            assert answer[1] == "1" and answer[5] == "552.0000", answer
            assert positions == sorted(positions) and len(set(positions)) > 5, positions
            assert text_of(port.ask(framed("1900;5;0;0").replace(b"\x036\x04", b"\x039\x04"), whole)).startswith("16;"), "a wrong check is told"
            assert text_of(port.ask(b"\x01\x02190" + framed("1906;5;0;0"), whole)) == "0;1;31;0;0;12345", "a frame inside a frame begins anew"


def test_four_axes_of_the_demo_site(folder):
    site = json.loads((TOP / "deploy/examples/demo-site.json").read_text())
    with Gateway(folder, site) as g:
        for axis in ("portal.x", "portal.y"):
            assert g.command(axis, {"command": "enable"})["result"] == "done"
        assert g.command("portal.x", {"command": "home"}, wait=40)["result"] == "done"
        for axis, target in (("portal.x", 30), ("portal.y", -20)):
            assert g.command(axis, {"command": "move_absolute", "position": target, "velocity": 20, "acceleration": 100, "deceleration": 100}, wait=0)["result"] == "accepted"
        until(lambda: g.axis("portal.x")["moving"] and g.axis("portal.y")["moving"], 5, "both move at once")
        until(lambda: g.axis("portal.x")["target_reached"] and g.axis("portal.y")["target_reached"], 15, "both are there")
        with g.modbus() as m:
            for number, position in ((2, 30000), (3, -20000), (4, 0), (5, 0)):
                base = (number - 1) * 64
                until(lambda: m.read32(base + 2) == position, 5, f"axis {number}")
                assert m.read(base + 9, 1)[0] & 0x07 == 3, "online and simulated"
                assert m.read(base + 15, 1)[0] == 3, "the family's number"
        for point, value in (("O[3]", True), ("R[1]", 640.5), ("N[17]", -7)):
            assert g.send("PUT", f"/axes/portal.x/parameters/{point.replace('[', '%5B').replace(']', '%5D')}", {"value": value})["result"] == "done"
            until(lambda: g.get(f"/axes/portal.z/parameters/{point.replace('[', '%5B').replace(']', '%5D')}")["value"] == value, 5, f"{point} is the drive's, not one axis'")
        refused = g.send("PUT", "/axes/portal.x/parameters/AP%5B1%5D", {"value": 100}, 409)
        assert "home position" in refused["detail"], refused
        # A program is started from home position. The axes of this control get power outside of ONLINE (enable mode 1), so the gateway does not give
        # it back by itself when the last one is off.
        for axis in ("portal.x", "portal.y"):
            assert g.command(axis, {"command": "disable"})["result"] == "done"
        status, answer, _ = g.request("POST", "/api/v1/axes/portal.x/actions?wait=10", {"name": "online.give_back"})
        assert status == 200, answer
        status, answer, _ = g.request("POST", "/api/v1/axes/portal.x/actions", {"name": "automatic.start"})
        assert status == 200, answer
        # the recording is readable
        recording = g.get("/lines/com1/trace?limit=200")
        code, out, err = run("decode", "pacontrol", "--format", "trace", stdin=json.dumps(recording))
        assert code == 0, err
        lines = out.splitlines()
        assert len(lines) > 20 and any("190C" in x for x in lines) and not any("unknown" in x for x in lines), out[:1000]


BYTE_S = 9 / 9600  # 7N1: start, seven, stop
PACE = "?baud=9600&format=7N1"


def crossed(*frames):
    """Least time that these take on the wire, one after the other."""
    return sum(map(len, frames)) * BYTE_S


def test_section_3_4_byte_for_byte_at_9600_baud(folder):
    """All three sequences of the manual, checks repaired; each exchange takes at least the time of its own bytes."""
    place = 1255.0
    memory = {"com1": {"axis2.position": place, "axis2.shaft": place}}
    (folder / "memory.json").write_text(json.dumps(memory))
    with Process("twin", "pacontrol", "--line", f"pty:{folder / 'com1'}{PACE}", "--state", str(folder / "memory.json"), "--time-scale", "10",
                 "--hand", "127.0.0.1:0") as twin:
        assert "9600 baud 7N1" in twin.ready, twin.ready
        with Port(folder / "com1", termios.CS7) as port:
            def exchange(request, reply):
                begun = time.monotonic()
                got = port.ask(request, whole)
                took = time.monotonic() - begun
                assert reply is None or got == reply, (request, got)
                assert took >= crossed(request, got), f"{request}: {took} s for {len(request)} + {len(got)} bytes"
                return got

            def fixed(text, reply):
                return exchange(framed(text), bytes.fromhex(reply))
            # 3.4.1: write N5
            fixed("0906;5;0;12345", "01 02 30 3B 31 3B 31 3B 30 3B 30 3B 31 32 33 34 35 03 35 37 04")
            # 3.4.2: input 5, N2, N3, R1
            fixed("0906;2;0;222", "01 02 30 3B 31 3B 31 3B 30 3B 30 3B 32 32 32 03 35 38 04")
            fixed("0907;1;1;640.0", "01 02 30 3B 31 3B 31 3B 30 3B 31 3B 36 34 30 2E 30 30 30 30 03 32 31 04")
            set_hand(twin, "inputs", 1 << 4)
            fixed("1900;5;0;0", "01 02 30 3B 31 3B 31 3B 30 3B 30 3B 31 03 35 37 04")
            fixed("1906;2;0;0", "01 02 30 3B 31 3B 31 3B 30 3B 30 3B 32 32 32 03 35 38 04")
            fixed("0906;3;0;333", "01 02 30 3B 31 3B 31 3B 30 3B 30 3B 33 33 33 03 35 39 04")
            fixed("1907;1;1;0", "01 02 30 3B 31 3B 31 3B 30 3B 31 3B 36 34 30 2E 30 30 30 30 03 32 31 04")
            # 3.4.3: ONLINE, move axis 2; what the polls say on the way depends on the moment, their form does not
            fixed("0603;0;0;0", "01 02 30 3B 31 3B 33 31 3B 30 3B 30 3B 30 03 31 31 04")
            fixed("0A87;2;1;5552.0", "01 02 30 3B 30 3B 33 31 3B 30 3B 31 3B 31 32 35 35 2E 30 30 30 03 33 38 04")
            positions = [place]
            for _ in range(400):
                got = exchange(b"\x04", None)
                fields = text_of(got).split(";")
                assert fields[0] == "0" and fields[2:5] == ["31", "0", "1"] and len(fields[5]) == 8, got
                positions.append(float(fields[5]))
                if fields[1] == "1":
                    break
                time.sleep(0.02)
            assert got == bytes.fromhex("01 02 30 3B 31 3B 33 31 3B 30 3B 31 3B 35 35 35 32 2E 30 30 30 03 33 35 04"), got
            assert positions == sorted(positions) and len(set(positions)) > 3, positions


def set_hand(twin, name, value):
    c = http.client.HTTPConnection(*twin.word("hand").rsplit(":", 1), timeout=5)
    c.request("PATCH", "/hand", body=json.dumps({name: value}), headers={"Content-Type": "application/json"})
    answer = c.getresponse()
    assert answer.status == 200, answer.read()
    c.close()


def test_gateway_and_twin_over_a_serial_line_of_9600_baud(folder):
    """The gateway on its serial port, the model at the other end of the cable: references, two axes at once, the three words, wire time."""
    site = json.loads((TOP / "deploy/examples/demo-site.json").read_text())
    site["lines"] = [{"name": "com1", "uri": f"serial:{folder / 'port'}{PACE}", "family": "pacontrol"}]
    site["drives"] = [{"name": "portal", "line": "com1", "address": "com1", "presence": "device"}]
    site["axes"] = [a for a in site["axes"] if a["drive"] == "portal"]
    site.pop("mappings", None)
    with Process("twin", "pacontrol", "--line", f"pty:{folder / 'port'}{PACE}"), Gateway(folder, site) as g:
        until(lambda: all(g.axis(x)["position"] is not None and not g.axis(x)["stale"] for x in ("portal.x", "portal.y")), 15, "the control is found")
        for axis in ("portal.x", "portal.y"):
            assert g.command(axis, {"command": "enable"})["result"] == "done"
            assert g.command(axis, {"command": "home"}, wait=60)["result"] == "done"
        for axis, target in (("portal.x", 25), ("portal.y", -15)):
            asked = {"command": "move_absolute", "position": target, "velocity": 10, "acceleration": 100, "deceleration": 100}
            assert g.command(axis, asked, wait=0)["result"] == "accepted"
        until(lambda: g.axis("portal.x")["moving"] and g.axis("portal.y")["moving"], 5, "both move at once")
        until(lambda: g.axis("portal.x")["target_reached"] and g.axis("portal.y")["target_reached"], 20, "both are there")
        assert abs(g.axis("portal.x")["position"] - 25) < 0.01 and abs(g.axis("portal.y")["position"] + 15) < 0.01
        begun = time.monotonic()
        for _ in range(5):
            answer = g.send("POST", "/drives/portal/native", {"send": "1900;5;0;0"})
        took = time.monotonic() - begun
        assert took >= 5 * crossed(framed("1900;5;0;0"), b"\x01\x020;1;31;0;0;0\x0359\x04"), took
        assert "0;1;31;0;0;0" in json.dumps(answer), answer
